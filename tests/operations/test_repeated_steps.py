"""Orientations are repeated about the axis of a part, and each image is an operation like any other."""

import json
from dataclasses import replace
from functools import cache, partial

import numpy as np
import pytest

from cad_io import read_part
from cad_io.part.equal_faces import Motion
from plan_cutters import plan
from plan_cutters.domain.operations import columns_of
from plan_cutters.judging.judge import judge
from plan_cutters.operations import planning
from plan_cutters.operations.by_pattern import planned_by_pattern, repeated, symmetric
from plan_cutters.operations.plans import plan_with
from plan_cutters.operations.task import Task
from plan_cutters.options import Options
from plan_cutters.pipeline import prepare
from plan_cutters.result import Result
from plan_cutters_check.asking import question_of
from plan_cutters_check.check import check
from tests.support.patterns import impeller

WORDS = {"cutters": ["D4L30rc2F16S4"], "holder": "er16", "faces": "all", "spacing": 6.0, "jobs": 2, "machine": "trunnion-ac",
         "operations": "fastest", "feed": 1500.0}  # fmt: skip


@cache
def task(off: float = 0.0, **options) -> Task:
    ready = prepare(read_part(impeller(6, off=off, fillet=1.5)), Options.of({**WORDS, **options}))
    return planning._task(ready, [{c: judge(ready, c) for c in ready.cutters}], None)


def test_the_axis_is_that_of_the_pattern():
    found = symmetric(task()).symmetry
    assert (found.order, found.exact) == (6, True)


@pytest.mark.slow("plans operations")
def test_a_part_that_nearly_is_a_pattern_is_told_by_its_samples():
    found = symmetric(task(0.02)).symmetry
    assert (found.order, found.exact) == (6, False)
    assert abs(found.direction[2]) == pytest.approx(1.0, abs=1e-6)
    assert np.hypot(*found.place[:2]) < 1e-3


@pytest.mark.slow("plans a part of repeated steps")
def test_nothing_is_repeated_where_axes_lock_or_it_was_refused():
    assert symmetric(task(index_step_deg=15.0)) is None
    assert symmetric(task(patterns=False)) is None
    assert symmetric(task(most_operations=3)) is None


@pytest.mark.slow("plans operations")
def test_nothing_is_repeated_about_an_axis_that_is_not_the_machines():
    # Each image would have other angles of both axes: no planner calls these one step.
    assert symmetric(task(setup="x")) is None


@pytest.mark.parametrize("angle", [(10.0, 40.0), (0.0, 0.0), (-170.0, -20.0)])
def test_images_are_the_axes_turned_by_one_rotary_axis(angle):
    own = symmetric(task())
    where = own.orientations[0]
    shown, axis = where.set_to(np.array([angle]))
    images = own.images(columns_of(axis, shown))
    assert len(images) == 6
    assert np.ptp(images.angle[:, 1]) == 0.0
    for k in range(6):
        turned = Motion.turn(own.symmetry.place, own.symmetry.direction, np.pi / 3 * k).directions(axis)[0]
        assert np.linalg.norm(images.axis[k] - turned) < 1e-9
    assert where.conditions.allows(images.axis).all()


def test_costs_are_those_of_the_best_image():
    from plan_cutters.operations.plans import costs_with

    own = symmetric(task())
    shown, axis = own.orientations[0].set_to(np.array([(10.0, 90.0), (40.0, 45.0)]))
    columns = columns_of(axis, shown)
    _, cost = costs_with(own, columns)
    _, every = costs_with(task(), own.images(columns))
    assert np.array_equal(cost, every.reshape(len(cost), 2, 6).min(axis=2))
    assert np.isfinite(cost).any()


@pytest.mark.slow("plans operations")
def test_a_plan_of_repeated_steps_has_ordinary_operations():
    own = symmetric(task())
    columns = repeated(own, planning._first(task()), partial(planning._stored, task()), lambda done, total: None).chosen
    made = plan_with(own, "fastest", columns)
    fixed = [each for each in made.operations if each.mode == "fixed"]
    assert made.orientations == len({each.orbit if each.orbit >= 0 else each.name for each in fixed})
    assert made.orientations <= len(columns) < len(fixed)
    for each in fixed:
        one = columns_of(each.axis[None], each.angle[None], own.cutters.index(each.cutter), each.setup)
        # As it is tested without any symmetry.
        assert task().probes.table(each.rows, one).all()
    reached = task().rows
    assert (made.label[reached] >= 0).all()


@pytest.mark.slow("plans operations")
def test_what_samples_cost_apart_is_what_putting_tools_down_at_all_copies_says():
    own = symmetric(task())
    sector = own.rows[own.symmetry.sector(own.ready.samples.point[own.rows] - own.symmetry.place)]
    one = replace(own, rows=sector, copies=own.symmetry.order)
    copied = repeated(one, planning._first(task()), partial(planning._stored, task()), lambda done, total: None)
    n, rows = own.symmetry.order, len(copied.problem.cost)
    # The first rows are those of the copy itself, with all images as they were tested; the best of these is what a step costs.
    apart = copied.apart.cost
    assert apart.shape == (n * rows, n * len(copied.base))
    assert np.allclose(n * apart[:rows].reshape(rows, -1, n).min(axis=2), copied.problem.cost, equal_nan=True)
    # A turn of a sample is a turn of what serves it.
    for turn in range(1, n):
        mine = apart[turn * rows : (turn + 1) * rows].reshape(rows, -1, n)
        assert np.array_equal(mine[:, :, turn], apart[:rows].reshape(rows, -1, n)[:, :, 0])
    # A choice of all images costs what the steps do.
    chosen = np.arange(len(copied.base))
    every = np.arange(n * len(copied.base))
    assert copied.apart.cutting(every) == pytest.approx(copied.problem.cutting(chosen))


@pytest.mark.slow("plans a part of repeated steps", only=("changes1", "changes2"))
@pytest.mark.parametrize("changes", [{}, {"off": 0.02}, {"fixtures": "box:5,5,5@60,0,0"}])
def test_one_copy_stands_for_all_where_the_part_and_what_is_about_it_are_a_pattern(changes):
    offer = planning._offer(task(**changes), lambda done, total: None)
    assert offer.exact == (not changes)
    assert (planned_by_pattern(task(**changes), offer) is not None) <= offer.exact


@pytest.mark.slow("plans a part of repeated steps")
@pytest.mark.parametrize(("blades", "index_time", "again"), [(4, 0.2, True), (8, 30.0, True)])
def test_one_copy_is_planned_and_the_fewest_are_not_looked_for(blades, index_time, again):
    entry = found(blades, index_time).plan.operations
    assert entry.fewest is None
    assert entry.fastest.bound_seconds <= entry.fastest.seconds
    assert any("by the samples of one copy" in note for note in entry.notes)
    # Where a turn takes long, orientations that serve several blades at once take less than the same for each blade.
    assert any(each.orbit is not None for each in entry.plans[0].operations if each.mode == "fixed") == again


@cache
def found(blades: int = 4, index_time: float = 0.2, *, patterns: bool = True) -> Result:
    part = read_part(impeller(blades))
    return plan(part, **{**WORDS, "area_budget": 0, "index_time": index_time, "patterns": patterns})


@pytest.mark.slow("plans a part of repeated steps")
def test_the_process_has_each_step_once():
    process = found().plan.process
    step = next(each for each in process.steps if each.repeat > 1)
    assert (step.repeat, step.repeat_deg) == (4, {"C": 90.0})
    entry = found().plan.operations.plans[0]
    orbit = next(each.orbit for each in entry.operations if each.id == step.operation)
    same = [each for each in entry.operations if each.orbit == orbit]
    assert len(same) == 4
    assert step.area_mm2 == pytest.approx(sum(each.area_mm2 for each in same))
    assert step.seconds == pytest.approx(sum(each.seconds for each in same))
    assert step.clearance_mm == min(each.clearance_mm for each in same)
    assert sum(each.area_mm2 for each in process.steps) == pytest.approx(process.finished_mm2)
    assert entry.orientations == sum(each.mode == "fixed" for each in entry.operations)
    assert any(line.lstrip()[1:].lstrip().startswith("4 x, C") and "+ 90" in line for line in found().plan.text.lines)


@pytest.mark.slow("plans a part of repeated steps")
@pytest.mark.parametrize(("blades", "index_time", "again"), [(4, 0.2, True), (6, 2.0, True), (8, 5.0, True)])
def test_it_takes_at_most_a_quarter_more_time_than_without_them(blades, index_time, again):
    plain = found(blades, index_time, patterns=False)
    seconds, before = (each.plan.operations.plans[0].seconds for each in (found(blades, index_time), plain))
    assert seconds <= 1.25 * before
    if again:
        assert len(found(blades, index_time).plan.process.steps) < len(plain.plan.process.steps)
    assert not any(each.repeat > 1 for each in plain.plan.process.steps)


@pytest.mark.slow("plans a part of repeated steps")
def test_operations_are_checked_as_any_others(tmp_path):
    found().write(tmp_path, ["json", "npz"])
    document = json.loads((tmp_path / "plan.json").read_text())
    arrays = {}
    for name in ("operations.npz", "samples.npz"):
        with np.load(tmp_path / name) as archive:
            arrays[name] = {each: archive[each] for each in archive.files}
    options = Options.of({word: value for word, value in WORDS.items() if word not in ("operations", "feed", "jobs")})
    checked = check(question_of(read_part(impeller(4)), options, document, arrays))
    assert checked.holds, checked.lines
    # An image that is not in its place is found.
    forged = next(each for each in document["operations"]["plans"][0]["operations"] if each["orbit"] is not None)
    forged["angles_deg"]["C"] += 22.5
    checked = check(question_of(read_part(impeller(4)), options, document, arrays))
    assert not checked.holds
