"""Simultaneous motion at its best axes: what it takes beside the bound of the plan, and what borders on free-form faces count."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from plan_cutters import plan
from plan_cutters.operations import planning
from plan_cutters.operations.fastest import against_bound
from plan_cutters.operations.labels import Seams
from plan_cutters.operations.motion import with_moved
from plan_cutters.operations.moving_axes import _AS_WIDE
from plan_cutters.operations.plans import plan_with
from tests.support.cad_parts import patch
from tests.support.shapes import bowl, dome, trough

SEEDS = st.integers(0, 2**32 - 1)
WORDS = {"cutters": ["R3L60rc1"], "operations": "fastest", "feed": 1200.0, "area_budget": 0, "grid": 13}


@pytest.fixture
def seen(monkeypatch):
    """Tasks of plans."""
    tasks, real = [], planning._task

    def made(*words):
        tasks.append(real(*words))
        return tasks[-1]

    monkeypatch.setattr(planning, "_task", made)
    return tasks


def seconds(task, pace):
    return float((task.ready.samples.area[task.rows] / pace).sum() / (WORDS["feed"] / 60.0))


@pytest.mark.parametrize("shape", [dome(20.0), patch(3)], ids=["dome", "patch"])
def test_where_nothing_is_in_the_way_motion_takes_hardly_more_than_the_bound_of_the_plan(shape, seen):
    result = plan(shape, **WORDS)
    (task,) = seen
    best = result.plan.operations.fastest.at_best_seconds
    pace = task.moving._test(0, 0).pace(task.rows, task.moving.smooth(0, 0, task.rows)[task.rows])
    assert 0.6 * best <= seconds(task, pace) <= 1.5 * best
    found = task.moving._test(0, 0).pace(task.rows, task.everywhere[0][task.cutters[0]].axis[task.rows])
    assert seconds(task, pace) <= seconds(task, found) / _AS_WIDE**2


@pytest.mark.parametrize("shape", [dome(20.0), bowl(14.0), trough(9.0, 10.0)], ids=["dome", "bowl", "trough"])
def test_no_pass_is_narrower_than_that_of_the_posture_that_was_found(shape, seen):
    plan(shape, **WORDS)
    (task,) = seen
    rows, test = task.rows, task.moving._test(0, 0)
    found = task.everywhere[0][task.cutters[0]].axis[rows]
    axis, widest = task.moving.widest(0, 0, rows)
    assert (widest >= _AS_WIDE * test.pace(rows, found) * (1.0 - 1e-9)).all()
    smooth = task.moving.smooth(0, 0, rows)
    pace = test.pace(rows, smooth[rows])
    assert (pace >= _AS_WIDE * widest * (1.0 - 1e-9)).all()
    # What is none of the postures found was tested at its sample.
    for each in (axis, smooth[rows]):
        new = (each != found).any(axis=1)
        assert test.free(rows[new], each[new]).all()
        assert np.linalg.norm(each, axis=1) == pytest.approx(1.0)


def test_a_ball_keeps_its_postures_for_its_pass_is_as_wide_at_any(seen):
    plan(dome(20.0), **{**WORDS, "cutters": ["R3L60rc3"]})
    (task,) = seen
    found = task.everywhere[0][task.cutters[0]].axis[task.rows]
    assert np.array_equal(task.moving.widest(0, 0, task.rows)[0], found)


def test_a_face_that_is_moved_goes_with_simultaneous_motion_as_a_whole(seen):
    result = plan(patch(3), **WORDS)
    (task,) = seen
    made = result.answers.operations.plans[0]
    task = unjoined(task)
    columns = planning._columns_of(task, plan_with(task, "fastest", planning._first(task, 0.6)))
    assert len(columns)
    whole = plan_with(with_moved(task, np.unique(task.ready.samples.face)), "fastest", columns)
    assert {each.mode for each in whole.operations} == {"simultaneous"}
    assert (whole.label[task.rows] >= 0).all()
    assert whole.marks == 0.0
    # The fixed orientations serve as before: what they serve is not said to go with motion alone.
    fixed = plan_with(task, "fastest", columns)
    served = task.probes.table(task.rows, columns).any(axis=1)
    assert (fixed.label[task.rows[served]] >= 0).all()
    assert made.price <= min(whole.price, fixed.price) * 1.02


@pytest.fixture(scope="module")
def bumps():
    """The task of a free-form patch."""
    tasks, real = [], planning._task
    with pytest.MonkeyPatch.context() as patched:
        patched.setattr(planning, "_task", lambda *words: tasks.append(real(*words)) or tasks[-1])
        plan(patch(3), **WORDS, most_operations=1)
    return tasks[0]


def unjoined(task, **options):
    """The task with other options, whose plans keep the orientations that they are made of."""
    options = replace(task.ready.options, most_operations=99, **options)
    return replace(task, ready=replace(task.ready, options=options))


def at_cost(task, cost, overlap=2.0):
    """A plan of the patch by a coarse grid of orientations, where borders cost so much."""
    own = unjoined(task, border_cost=cost, overlap=overlap)
    return plan_with(own, "fastest", planning._first(own, 0.5), times=True)


@pytest.mark.parametrize("cost", [0.0, 0.02, 0.2, 2.0])
def test_borders_count_by_their_length(cost, bumps):
    made = at_cost(bumps, cost)
    assert made.marks == pytest.approx(cost * bumps.seams.marks(made.label))
    assert made.price == pytest.approx(made.total + made.marks)


def test_the_dearer_borders_are_the_fewer_there_are(bumps):
    made = [at_cost(bumps, cost, 0.0) for cost in (0.0, 0.02, 0.5, 10.0)]
    lengths, cutting = [bumps.seams.marks(each.label) for each in made], [each.cutting for each in made]
    assert lengths[0] > lengths[-1]
    assert lengths == sorted(lengths, reverse=True)
    assert cutting == sorted(cutting)


def test_motion_takes_the_place_of_a_plan_of_a_pattern_where_it_costs_less(bumps):
    task = replace(bumps, ready=replace(bumps.ready, options=replace(bumps.ready.options, most_operations=None)))
    fixed = plan_with(unjoined(task), "fastest", planning._first(task, 0.5))
    timed = against_bound(fixed.total, 0.9 * fixed.total, 1.0, 10, 20), 5.0
    (made,), (entry, area), worth, words = planning._in_motion(task, ([fixed], timed, (), ("One copy.",)))
    assert made.price < 0.98 * fixed.price
    assert "simultaneous" in {each.mode for each in made.operations}
    assert entry.seconds == pytest.approx(made.total)
    assert entry.bound_seconds <= made.total + 1e-9
    assert (area, worth, words[0]) == (5.0, (), "One copy.")
    assert "F1: simultaneous motion cuts it as a whole" in words[1]
    # With motion that is slow the plan stays.
    slow = replace(task, moving=SlowMotion(task.moving))
    quick = [fixed], timed, (), ("One copy.",)
    assert planning._in_motion(slow, quick) is quick


class SlowMotion:
    """Axes whose passes are a hundredth as wide."""

    def __init__(self, moving):
        self.moving = moving

    def widest(self, cutter, setup, rows):
        axis, pace = self.moving.widest(cutter, setup, rows)
        return axis, 0.01 * pace


def chessboard(side):
    """The pairs of neighbours of a board of unit squares."""
    number = np.arange(side * side).reshape(side, side)
    pairs = [number[:, :-1].ravel(), number[:-1].ravel()], [number[:, 1:].ravel(), number[1:].ravel()]
    edge = np.column_stack([np.concatenate(each) for each in pairs])
    return Seams(edge, np.ones(len(edge)), np.ones(len(edge), bool))


@given(st.integers(2, 9), st.integers(1, 8))
def test_a_straight_border_is_as_long_as_the_board(side, column):
    label = np.broadcast_to(np.arange(side) >= column, (side, side)).ravel().astype(np.int32)
    assert chessboard(side).marks(label) == (side if column < side else 0)


@given(SEEDS, st.integers(2, 8))
@settings(max_examples=60, deadline=None)
def test_borders_of_some_samples_are_as_long_as_those_of_all(seed, side):
    rng = np.random.default_rng(seed)
    whole = chessboard(side)
    whole = Seams(whole.edge, rng.random(len(whole.edge)), rng.random(len(whole.edge)) < 0.7)
    # Some samples stand for others, or for none; what they go with, those go with.
    some = rng.choice(side * side, size=int(rng.integers(1, side * side + 1)), replace=False)
    stands_for = np.where(rng.random(side * side) < 0.1, -1, rng.choice(some, side * side))
    label = np.full(side * side, -1, np.int32)
    label[some] = rng.integers(-1, 3, len(some))
    spread = np.where(stands_for >= 0, label[stands_for], -1)
    assert whole.among(stands_for).marks(label) == pytest.approx(whole.marks(spread))
