"""Plans of operations on machines of no and of one rotary axis, and of two of which one or both stand still."""

import math
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from plan_cutters import Axis, Cutter, Machine, plan
from plan_cutters.domain.cutter import Segment
from plan_cutters.domain.machine import builtin_machines
from plan_cutters.errors import OptionError
from plan_cutters.machines import read_machine, to_toml
from plan_cutters.operations.labels import flowing_faces
from plan_cutters.operations.orientations import Indexing, Orientations, candidates
from plan_cutters.report.process_file import process_toml
from plan_cutters_check.check import check
from tests.support.cad_parts import ball, box
from tests.support.grooves import tee
from tests.support.written_plan import Written

FLAT, BALL = "D12L60F26", "D6L60rc3F16"
OPTIONS = {"faces": "all", "area_budget": 0, "feed": 1000.0, "operations": "both"}
X, Z = (1.0, 0.0, 0.0), (0.0, 0.0, 1.0)
#: A trunnion whose axes cannot move, and one whose table alone stands still.
STILL = Machine("still", axes=(Axis.rotary("C", "part", Z, limits_deg=(0, 0)), Axis.rotary("A", "part", X, limits_deg=(0, 0))))
ONE = Machine("one", axes=(Axis.rotary("C", "part", Z, limits_deg=(0, 0)), Axis.rotary("A", "part", X)))


def channel():
    """A block with a groove along X whose walls lean outward by 20 deg, and a pocket from above."""
    import cadquery as cq

    outline = [(-20, 0), (20, 0), (20, 15), (12, 15), (8, 4), (-8, 4), (-12, 15), (-20, 15)]
    return cq.Workplane("YZ").polyline(outline).close().extrude(30).val()


def planned(part, machine, **more):
    return plan(part, **{**OPTIONS, "machine": machine, "cutters": [FLAT, BALL], "grid": 7, **more})


def of_each(result, name):
    """The label of each sample in a plan, with what was said of its operations."""
    made = next(each for each in result.answers.operations.plans if each.name == name)
    return made, next(each for each in result.plan.operations.plans if each.name == name)


@pytest.fixture(scope="module")
def results():
    part = channel()
    return {m if isinstance(m, str) else m.name: planned(part, m) for m in ("3-axis", "4-axis-a", "trunnion-ac", STILL, ONE)}


@pytest.mark.parametrize("name", ["fewest", "fastest"])
def test_three_axes_plan_as_five_that_cannot_move(results, name):
    """The same steps over the same samples at the same seconds of cutting; only the angles have names there."""
    (three, entry), (still, other) = (of_each(results[machine], name) for machine in ("3-axis", "still"))
    assert np.array_equal(three.label, still.label)
    assert np.array_equal(three.seconds, still.seconds, equal_nan=True)
    assert [each.axis for each in entry.operations] == [each.axis for each in other.operations]
    assert {tuple(each.angles_deg.items()) for each in entry.operations} == {()}
    assert {tuple(each.angles_deg.items()) for each in other.operations} == {(("C", 0.0), ("A", 0.0))}
    # Nothing turns on three axes: the seconds of orientations are those of axes that there are.
    assert [each.index_s for each in entry.operations] == [0.0] * len(entry.operations)


def test_one_axis_plans_as_two_of_which_the_other_stands_still(results):
    four, one = (results[machine].plan.operations for machine in ("4-axis-a", "one"))
    for mine, other in zip(four.plans, one.plans, strict=True):
        assert mine.rest.samples == other.rest.samples
        assert [each.axis for each in mine.operations] == [each.axis for each in other.operations]
        for a, b in zip(mine.operations, other.operations, strict=True):
            assert b.angles_deg is None if a.angles_deg is None else b.angles_deg == {"C": 0.0, **a.angles_deg}


def test_each_axis_more_serves_at_least_what_fewer_serve(results):
    served = [of_each(results[machine], "fewest")[0].label >= 0 for machine in ("3-axis", "4-axis-a", "trunnion-ac")]
    for fewer, more in pairwise(served):
        assert (more | ~fewer).all()
    assert served[0].sum() < served[1].sum()


@pytest.mark.parametrize("machine", ["3-axis", "4-axis-a", "still", "one"])
def test_a_plan_serves_all_that_its_cutters_reach(results, machine):
    result = results[machine]
    reached = np.logical_or.reduce([result.reaches[each.id].reached for each in result.cutters])
    for name in ("fewest", "fastest"):
        made, entry = of_each(results[machine], name)
        assert np.array_equal(made.label >= 0, reached)
        assert set(entry.operations[0].angles_deg) == {axis.name for axis in result.conditions.machine.rotary}


@pytest.mark.parametrize("machine", ["3-axis", "still"])
def test_nothing_is_simultaneous_where_no_axis_can_move(results, machine):
    assert all(each.mode == "fixed" for each in results[machine].plan.operations.plans[0].operations)
    own = {"step": [{"cutter": FLAT, "mode": "simultaneous"}]}
    with pytest.raises(OptionError, match="step 1: it is simultaneous, and on this machine no axis turns the tool"):
        planned(box(), results[machine].conditions.machine, operations=None, process=own)


def test_nothing_is_simultaneous_where_axes_stand_still_while_the_machine_cuts(tmp_path):
    """On the built-in 3+2 and on a trunnion that is stated so; what motion alone would take is left by name."""
    indexed = replace(builtin_machines()["trunnion-ac"], indexed=True)
    file = tmp_path / "mill.toml"
    file.write_text(to_toml(indexed))
    assert read_machine(file) == indexed
    for machine in ("3+2", indexed):
        dome = planned(ball(), machine, most_operations=1, operations="fastest")
        (made, entry) = of_each(dome, "fastest")
        assert all(each.mode == "fixed" for each in entry.operations)
        assert (made.label[dome.ready.finished] >= 0).sum() + entry.rest.samples == dome.ready.finished.sum()
        with pytest.raises(OptionError, match="on this machine no axis turns the tool while it cuts"):
            planned(box(), machine, operations=None, process={"step": [{"cutter": FLAT, "mode": "simultaneous"}]})
    moving = planned(ball(), "trunnion-ac", most_operations=1, operations="fastest")
    assert any(each.mode == "simultaneous" for each in of_each(moving, "fastest")[1].operations)


@pytest.mark.parametrize("machine", sorted(builtin_machines()))
def test_a_process_file_gives_the_same_process_on_each_machine(machine, tmp_path):
    """Steps with the angles of all axes that there are; judged again, each takes what it took."""
    part = box(30.0, 20.0, 10.0)
    first = planned(part, machine, grid=3, operations="fewest", other_setups=[(0.0, 0.0, -1.0)])
    assert first.plan.process.finished_share == 1.0
    file = tmp_path / "process.toml"
    file.write_text(process_toml(first.plan))
    again = planned(part, machine, grid=3, operations=None, process=file, other_setups=[(0.0, 0.0, -1.0)])
    assert again.plan.process.finished_share == 1.0
    names = {axis.name for axis in builtin_machines()[machine].rotary}
    for one, other in zip(first.plan.process.steps, again.plan.process.steps, strict=True):
        assert (one.angles_deg, one.axis, one.faces) == (other.angles_deg, other.axis, other.faces)
        assert set(one.angles_deg) == names


def test_a_step_of_three_axes_may_be_written_without_angles():
    part = box(30.0, 20.0, 10.0)
    made = planned(part, "3-axis", operations=None, process={"step": [{"cutter": FLAT, "mode": "fixed", "faces": ["F6"]}]})
    assert made.plan.process.steps[0].share > 0.0
    with pytest.raises(OptionError, match="step 1: angles: none; the rotary axis is A"):
        planned(part, "4-axis-a", operations=None, process={"step": [{"cutter": FLAT, "mode": "fixed"}]})
    with pytest.raises(OptionError, match="step 1: angles: A; the machine has no rotary axis"):
        planned(part, "3-axis", operations=None, process={"step": [{"cutter": FLAT, "angles": {"A": 0.0}}]})


def test_orientations_of_a_circle_are_the_spacing_apart_all_round(results):
    result = results["4-axis-a"]
    where = Orientations.of(result.conditions)
    angle, axis = candidates(where, result.samples, None)
    assert angle.shape[1] == 1
    turn = np.sort(np.degrees(np.arctan2(axis[:, 1], axis[:, 2])))
    assert np.abs(axis[:, 0]).max() < 1e-12
    assert np.diff(turn).max() <= 5.0 + 1e-6


@given(st.floats(-math.pi, math.pi), st.floats(0.001, 0.5))
def test_axes_about_one_lie_on_the_circle_at_both_sides(results, turn, spacing):
    for machine, count in (("3-axis", 0), ("still", 0), ("4-axis-a", 2), ("one", 2), ("trunnion-ac", 6)):
        where = Orientations.of(results[machine].conditions)
        axis = np.array([[0.0, math.sin(turn), math.cos(turn)]])
        near = where.about(axis, spacing)
        assert near.shape == (count, 3)
        assert np.allclose(near @ axis[0], math.cos(spacing), atol=1e-12)
        assert count == 6 or where.kinematics.allows(near).all()


def test_a_single_axis_takes_the_time_of_its_rate():
    """90 deg at 10 deg/s from zero, then 90 deg on: 18 s for both; with limits that part them it goes back through zero."""
    part = box(30.0, 20.0, 10.0)
    machine = Machine("a", axes=(Axis.rotary("A", "part", X, rate_deg=10.0),))
    made = planned(part, machine, grid=3, operations="fewest", cutters=[FLAT])
    where = Orientations.of(made.conditions)
    times = Indexing((where,), None).times(0, [[np.array([90.0])], [np.array([180.0])]])
    assert times.tolist() == pytest.approx([9.0, 9.0])
    limited = Machine("a", axes=(Axis.rotary("A", "part", X, rate_deg=10.0, limits_deg=(-100.0, 100.0)),))
    where = Orientations.of(planned(part, limited, grid=3, operations="fewest", cutters=[FLAT]).conditions)
    assert Indexing((where,), None).times(0, [[np.array([90.0])], [np.array([-90.0])]]).sum() == pytest.approx(27.0)
    assert Indexing((where,), 4.0).times(0, [[np.array([90.0])]]).tolist() == [4.0]


#: A T-slot cutter: flutes of 16 x 4 below a neck of 6.
SLOT = Cutter(8.0, 50.0, 0.0, shape="form", outline=((0, 0), (8, 0), (8, 4), (3, 4)), neck=Segment(3.0, 30.0), shank_radius=4.0)


def mushroom():
    """A stem of 16 on a plate, with a cap of 24 whose underside is 10 over the plate."""
    import cadquery as cq

    plate = cq.Workplane().box(80, 80, 6, centered=(True, True, False)).faces(">Z").workplane()
    return plate.circle(8).extrude(10).faces(">Z").workplane().circle(12).extrude(5).val()


@pytest.mark.slow("another part of the same law", but=("tee",))
@pytest.mark.parametrize("part", [tee, mushroom])
def test_what_is_undercut_is_finished_upright_by_a_t_slot_cutter(part, tmp_path):
    """All but the underside of the part; by fixed steps, and by the checker, which puts each tool down where it slid to."""
    words = {"machine": "3-axis", "cutters": ["D10L60F40", SLOT], "spacing": 4.0, "faces": "all"}
    made = part()
    result = plan(made, **words, area_budget=0, feed=1000.0, operations="fewest")
    below = (result.samples.normal[:, 2] < -0.99) & (result.samples.point[:, 2] < 1e-6)
    (plan_made,) = result.answers.operations.plans
    assert (plan_made.label[~below] >= 0).all()
    assert SLOT.id in {step.cutter for step in result.plan.process.steps}
    slid = (plan_made.strategy == 0) & np.isfinite(plan_made.contact).all(axis=1)
    assert slid.any()
    result.write(tmp_path, ["json", "npz"])
    answer = check(Written(tmp_path, made, words).asked(), seconds=20.0)
    assert answer.holds, "\n".join(answer.lines)


def test_what_is_reached_and_no_step_is_worth_is_left_by_name():
    """Two samples of a bracket at a lug that the ball alone reaches: no axis moves there to take the rest."""
    import cadquery as cq

    outline = [(0, 0), (80, 0), (80, 10), (10, 10), (10, 60), (0, 60)]
    angle = cq.Workplane("XZ").polyline(outline).close().extrude(50).edges("|Y").fillet(2)
    part = angle.union(cq.Workplane().box(10, 10, 10).translate((85, -25, 5))).val()
    setups = (0, -1, 0), (0, 1, 0), (0, 0, 1)
    how = {"cutters": ["D16L60", "D6L40rc3"], "holder": "er32", "grid": 9, "setup": setups[0], "other_setups": setups[1:]}
    result = planned(part, "3-axis", **{**how, "operations": "fastest"})
    made, entry = of_each(result, "fastest")
    reached = np.logical_or.reduce([each.reached for each in result.reaches.values()]) & result.ready.finished
    missed = int((reached & (made.label < 0)).sum())
    assert missed > 0
    assert entry.rest.short == missed
    assert "short_step" in [each.cause for each in result.plan.process.left]


def stepped(along=(1, 0, 0)):
    """A turned part: 40 wide, then a cone, then 24 wide with a boss on its end that no axis goes through, 90 long."""
    import cadquery as cq

    profile = [(0, 0), (0, 20), (40, 20), (55, 12), (80, 12), (80, 0)]
    turned = cq.Workplane("XY").polyline(profile).close().revolve(360, (0, 0, 0), (1, 0, 0))
    part = turned.faces(">X").workplane().center(5, 0).circle(4).extrude(10)
    return part.val() if along == (1, 0, 0) else part.rotate((0, 0, 0), (0, 1, 0), -90).val()


@pytest.mark.parametrize(("machine", "along"), [("4-axis-a", X), ("4-axis-a", Z), ("3-axis", X), ("trunnion-ac", X)])
def test_faces_that_go_round_the_one_axis_that_turns_the_tool_may_be_cut_while_it_turns(machine, along):
    part = stepped(along)
    ready = plan(part, cutters=[FLAT], machine=machine, faces="all", grid=9, area_budget=0).ready
    shapes = {ready.scene.part.faces[k - 1].shape for k in flowing_faces(ready).tolist()}
    sizes = sorted(ready.scene.part.faces[k - 1].area for k in flowing_faces(ready).tolist())
    if (machine, along) != ("4-axis-a", X):
        assert not shapes
        return
    assert shapes == {"cylinder", "cone"}
    slant = math.hypot(15.0, 8.0)
    every = [math.pi * 40.0 * 40.0, math.pi * 32.0 * slant, math.pi * 24.0 * 25.0, math.pi * 8.0 * 10.0]
    assert sizes == pytest.approx(sorted(every), rel=1e-6), "each is of revolution about a line along the axis"


def test_a_turned_part_is_cut_round_in_one_step_on_a_fourth_axis(tmp_path):
    """As a shop does, in less time than by orientations: the checker puts each posture down."""
    words = {
        "machine": "4-axis-a",
        "cutters": [FLAT],
        "spacing": 6.0,
        "faces": "all",
        "operations": "fastest",
        "feed": 1000.0,
        "area_budget": 0,
    }
    part = stepped()
    result = plan(part, **words)
    made, _ = of_each(result, "fastest")
    area = np.nan_to_num(result.samples.area)
    round_ = np.isin(result.samples.face, flowing_faces(result.ready)) & (made.label >= 0)
    (moving,) = [k for k, each in enumerate(made.operations) if each.axis is None]
    assert area[round_ & (made.label == moving)].sum() > 0.95 * area[round_].sum()
    still = plan(part, **words, most_operations=99)
    assert made.total < 0.8 * of_each(still, "fastest")[0].total
    result.write(tmp_path, ["json", "npz"])
    answer = check(Written(tmp_path, part, words).asked(), seconds=5.0)
    assert answer.holds, "\n".join(answer.lines)
