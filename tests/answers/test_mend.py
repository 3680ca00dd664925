"""What to do next with one cutter: closed forms of each kind of step, and why none is looked for."""

import math

import numpy as np
import pytest

from cad_io import read_part
from plan_cutters import Cutter, Options, Scene, plan
from plan_cutters.answers.areas import Finished
from plan_cutters.answers.ask import mend
from plan_cutters.answers.means import _directions, tolerance
from plan_cutters.answers.state import Case, Judgements, Scan, State
from plan_cutters.domain.standard_tools import METRIC, USUAL, smaller
from plan_cutters.judging.judge import judge
from plan_cutters.pipeline import prepare
from plan_cutters.scene.work import Budget
from tests.support import shapes
from tests.support.advice import strip, wall
from tests.support.bodies import lidded, stacked
from tests.support.cad_parts import box, compound, cut
from tests.support.serving import not_reached

UPRIGHT = {"tilt": (0.0, 0.0)}


def asked(part, cutter, **options):
    """What next for a cutter, its steps of one change by their thing, and the prepared part."""
    options = {"cutters": (Cutter.of(cutter),), "grid": 5, "area_budget": 0} | options
    ready = prepare(part, Options(**options))
    (cutter,) = ready.cutters
    reach = judge(ready, cutter)
    found = mend(ready, cutter, [{cutter: reach}])
    return found, {each.entry.changes[0].thing: each for each in found.steps[::-1] if len(each.entry.changes) == 1}, ready


def inclined(degrees):
    """A square, its normal leaning from z to x by an angle."""
    sine, cosine = math.sin(math.radians(degrees)), math.cos(math.radians(degrees))
    return shapes.shell(shapes.plane((-10, 10), (-10, 10), (0, 0, 0), (sine, 0, cosine), (cosine, 0, -sine)))


# --- closed forms ---------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("holder", "length"),
    # A cylinder has to clear the wall; a cone is as wide as its distance, 8 + 3, at 12 over its nose. Steps are of 5 mm.
    [("R15L200", 40.0), ("R5:15L20+R15L200", 30.0)],
)
def test_the_holder_is_lifted_over_the_wall_beside_the_contact(holder, length):
    part = shapes.shell(strip(0, 10), wall(-8, 40, 1))
    cutter = Cutter.flat(radius=3, length=25, flutes=10.0, shank_radius=3.0, holder=holder)
    step = asked(part, cutter, faces="F1", **UPRIGHT)[1]["stick_out"]
    (made,) = step.cutters
    assert (step.entry.changes[0].now, step.entry.changes[0].asked, step.entry.lost_after) == (25.0, length, 0.0)
    assert (made.flutes, made.length) == (10.0, length)


def test_a_cutter_that_cuts_all_along_does_not_cut_higher_when_it_stands_out_further():
    part = shapes.shell(strip(0, 10), wall(-8, 40, 1))
    step = asked(part, Cutter.flat(radius=3, length=25, holder="R15L200"), faces="F1", **UPRIGHT)[1]["stick_out"]
    assert (step.cutters[0].flutes, step.cutters[0].length) == (25.0, 40.0)


def test_the_largest_ball_between_two_walls_does_the_rest():
    """Where it stands nearest to one wall, 4.5 mm, a ball goes no wider: of sold diameters the next is 8 mm."""
    part = shapes.shell(strip(4.5, 5.5), wall(0, 60, 1), wall(10, 60, -1))
    step = asked(part, Cutter.ball(radius=6, length=60), faces="F1", **UPRIGHT)[1]["radius"]
    thin = step.cutters[-1]
    assert thin.radius == thin.corner_radius == max(0.5 * each.diameter for each in METRIC if 0.5 * each.diameter <= 4.5)
    assert (thin.length, step.entry.lost_after) == (5.0 * 2.0 * thin.radius, 0.0)


def test_the_least_limit_is_the_next_step_above_the_angle_of_the_face():
    steps = asked(inclined(40.05), "R3L40", machine="tilt:30", **UPRIGHT)[1]
    (limit,), left = steps["tilt_limit"].entry.changes, steps["tilt_limit"].entry.lost_after
    assert (limit.now, limit.asked, left) == (30.0, 45.0, 0.0)
    # Another axis does it as well: of the directions tried each that serves is within 30 deg of the normal.
    normal = (math.sin(math.radians(40.05)), 0.0, math.cos(math.radians(40.05)))
    assert np.dot(steps["second_setup"].entry.changes[0].asked, normal) > math.cos(math.radians(30.0))


def test_tilts_of_the_search_are_widened_as_far_as_the_cutter_touches():
    step = asked(inclined(40.05), "R3L40", machine="tilt:30", **UPRIGHT)[1]["tilt_range"]
    assert step.entry.changes[0].now == (0.0, 0.0)
    assert (step.entry.changes[0].asked[0], step.entry.lost_after) == (0.0, 0.0)
    assert step.entry.changes[0].asked[1] >= 10.1


def beside_a_post(away):
    """A strip, and beside it the part of a round post of radius 40 that faces it, `away` from a holder of radius 15 there."""
    from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeFace
    from OCP.gp import gp_Cylinder

    frame = shapes.axes((-40 - 15 - away, 0, 20), (0, 0, 1), (1, 0, 0))
    return shapes.shell(
        shapes.plane((0, 0.1), (-0.05, 0.05)), BRepBuilderAPI_MakeFace(gp_Cylinder(frame, 40.0), -1.5, 1.5, 0.0, 60.0).Face()
    )


def test_a_finer_tolerance_decides_what_the_triangles_leave_open():
    cutter = Cutter.ball(radius=3, length=25, holder="R15L20")
    options = {"faces": "F1", "tolerance": 0.5, "grid": 2} | UPRIGHT
    error = Scene.of(beside_a_post(5.0), tolerance=0.5).surround().certain.triangles.chord_error
    finer = Scene.of(beside_a_post(5.0), tolerance=0.25).surround().certain.triangles.chord_error
    assert finer < 0.7 * error
    (found,) = finely(beside_a_post(0.5 * (error + finer)), cutter, options)
    assert (found.moves[0].now, found.moves[0].asked, found.estimate) == (0.5, 0.25, 0.0)
    # What touches for certain is not mended so.
    assert finely(beside_a_post(-1.0), cutter, options) == []


def finely(part, cutter, options):
    """Steps of a finer tolerance alone: of a face that is too small for advice."""
    ready = prepare(part, Options(cutters=(cutter,), area_budget=0, **options))
    (cutter,) = ready.cutters
    reaches = {cutter: judge(ready, cutter)}
    state, known, rows = State.of(ready, cutter), Judgements.of(ready, [reaches]), np.flatnonzero(ready.finished)
    left = known.left(state, rows)
    assert len(left)
    return [*tolerance(Scan.of(state, left, Finished.of(ready), known, (cutter,)))]


def test_open_faces_keep_their_side_when_the_setup_turns():
    """Seen from the other side an open face would be worked on there: no setup that does so is a step instead of this one."""
    part = compound(
        shapes.plane((-10, 10), (-10, 10), (0, 0, 0), (math.sin(1.7), 0, math.cos(1.7)), (0, 1, 0)), box(1, 1, 1, at=(90, 90, 0))
    )
    _, steps, ready = asked(part, "R3L40", machine="tilt:3", faces="F1", **UPRIGHT)
    rows = np.arange(len(ready.samples))
    turned = [axis for axis in _directions(ready, rows, rows[:0]) if not ready.scene.same_sides(axis)]
    assert turned
    assert "setup" not in steps or steps["setup"].entry.changes[0].asked not in turned


def test_a_thinner_cutter_of_the_table_is_judged_as_a_plan_judges_it():
    part = shapes.shell(shapes.Patch.random(np.random.default_rng(1), height=6.0).face())
    _, steps, ready = asked(
        part, Cutter.flat(radius=8, length=60), grid=13, tolerance=0.05, rotation_step=0.35, machine="tilt:35"
    )
    (cutter,) = ready.cutters
    for each in (step for step in steps.values() if step.entry.changes[0].thing == "radius"):
        assert each.cutters[1] in smaller(cutter, USUAL)
        both = np.intersect1d(*(not_reached(Case(ready, one)) for one in each.cutters))
        assert each.entry.left == len(both)


# --- why nothing is looked for --------------------------------------------------------------------------------------------


@pytest.mark.slow("plans parts whole")
def test_nothing_is_asked_about_what_lies_inside_another_body():
    """It is no surface of the finished part: the rest is mended as if it were not there."""
    found, steps, _ = asked(stacked(), "R2L30", faces="6,7,11", grid=9)
    assert (found.entry.lost, found.entry.buried) == (90, 90)
    assert not steps
    assert found.entry.why == "90 samples are within another body, which is no surface of the finished part; nothing else is lost"
    found, steps, _ = asked(stacked(), "R2L30", faces="6,7,11", grid=9, machine="tilt:60", setup=(1, 0, 0))
    assert 0 < found.entry.buried < found.entry.lost
    assert steps["tilt_limit"].entry.lost_after == 0.0


def test_missing_obstacles_leave_it_open():
    found, steps, _ = asked(lidded(), Cutter.flat(radius=2, length=30), faces="1,6", grid=4, machine="tilt:90")
    assert found.entry.unsure
    assert found.entry.lost
    found, steps, _ = asked(lidded(gap=500.0), "R2L30", faces="6", grid=4)
    assert (found.entry.lost, steps) == (0, {})
    assert "missing" in found.entry.why


def test_a_cutter_that_finishes_has_nothing_to_mend():
    found, steps, _ = asked(inclined(10.0), "R3L40")
    assert (found.entry.lost, found.entry.buried, steps, found.entry.why) == (0, 0, {}, "")


def test_where_no_step_helps_the_area_is_left():
    """Nothing that could be judged goes into a slit of 0.02 mm."""
    part = read_part(cut(box(16, 40, 10), box(0.02, 60, 5, at=(7.99, -10, 5))))
    samples = plan(part, cutters="R3L40", faces="all", grid=2, area_budget=0).samples
    (bottom,) = {int(n) for n in samples.face[(samples.normal[:, 2] > 0.5) & (samples.point[:, 2] < 7)]}
    found, steps, _ = asked(part, Cutter.flat(radius=3, length=40), faces=[bottom])
    assert found.entry.lost == 15 or "too little for advice" in found.entry.why
    assert set(steps) <= {"area"}


def test_a_budget_that_is_spent_leaves_what_promises_most():
    part = shapes.shell(strip(0, 10), wall(-8, 40, 1))
    cutter = Cutter.flat(radius=3, length=25, flutes=10.0, shank_radius=3.0, holder="R15L200")
    ready = prepare(part, Options(cutters=(cutter,), grid=5, area_budget=0, faces="F1", **UPRIGHT))
    (cutter,) = ready.cutters
    reach = judge(ready, cutter)
    every, none, some = (mend(ready, cutter, [{cutter: reach}], budget=each) for each in (None, Budget(0.0), Budget(1e12)))
    changes = [step for step in every.steps if len(step.entry.changes) == 1 and step.entry.changes[0].thing != "area"]
    assert len(changes) > 1
    assert (every.entry.uncompared, some.entry.uncompared) == (0, 0)
    assert [step.entry.changes for step in some.steps] == [step.entry.changes for step in every.steps]
    (kept, area) = none.steps
    assert area.entry.changes[0].thing == "area"
    # Every sample was judged of what is told, and what was not compared is counted.
    assert (kept.entry.changes, kept.entry.lost_after) in [(step.entry.changes, step.entry.lost_after) for step in changes]
    assert none.entry.uncompared >= len(changes) - 1
    assert none.entry.lost_areas == every.entry.lost_areas


def test_it_tells_how_far_it_is_and_can_be_interrupted():
    ready = prepare(inclined(40.05), Options(cutters=("R3L40",), grid=5, area_budget=0, machine="tilt:30", **UPRIGHT))
    (cutter,) = ready.cutters
    reach, told = judge(ready, cutter), []
    mend(ready, cutter, [{cutter: reach}], progress=lambda done, total: told.append((done, total)))
    assert told
    assert told == sorted(told)
    assert all(done <= total for done, total in told)

    def stop(done, total):
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        mend(ready, cutter, [{cutter: reach}], progress=stop)
