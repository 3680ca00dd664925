"""A flat end that stands upright on a floor beside walls: it cuts what lies under the flat of its tip."""

import cadquery as cq
import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from plan_cutters import plan
from plan_cutters.domain.verdicts import INACCESSIBLE, UNDECIDED
from plan_cutters.scene.conditions import Context
from plan_cutters.scene.distances import least_clearance
from plan_cutters.scene.fixed_axis import at_fixed_axis, held_at, served_by

LONG, WIDE, DEEP, RADIUS = 40.0, 16.0, 8.0, 7.0
#: A turn of the part by which none of its axes stays, and that leaves its floor a normal of many digits.
TURN = Rotation.from_rotvec(np.radians(33.3) * np.array([1.0, 2.0, 0.5]) / np.linalg.norm([1.0, 2.0, 0.5]))


@pytest.fixture(scope="module", params=["straight", "turned"])
def pocket(request):
    """The result, and the places (n, 2) of its samples on the floor; the axis is 3e-5 rad off its normal where it is turned."""
    shape = cq.Workplane("XY").box(60, 40, 20).faces(">Z").workplane().rect(LONG, WIDE).cutBlind(-DEEP).val()
    turn = Rotation.identity()
    if request.param == "turned":
        turn, vector = TURN, TURN.as_rotvec()
        shape = shape.rotate((0, 0, 0), tuple(vector), float(np.degrees(np.linalg.norm(vector))))
    result = plan(shape, cutters="R7L40", faces="all", grid=15, area_budget=0)
    place = turn.inv().apply(result.samples.point)
    rows = np.flatnonzero((np.abs(place[:, 2] - (10.0 - DEEP)) < 1e-6) & (turn.inv().apply(result.samples.normal)[:, 2] > 0.9))
    rows = rows[(np.abs(place[rows, :2]) < (0.5 * LONG, 0.5 * WIDE)).all(axis=1)]
    assert len(rows) > 100
    off = (0.0, 0.0, 0.0) if request.param == "straight" else (3e-5, -1e-5, 0.0)
    axis = turn.apply(np.array([0.0, 0.0, 1.0]) + off)
    return result, rows, place[rows, :2], axis / np.linalg.norm(axis), turn


def missing(place):
    """How far the nearest place that the walls leave for the middle of the disk is beyond its rim, from points (n, 2)."""
    left = np.array([0.5 * LONG, 0.5 * WIDE]) - RADIUS
    return np.linalg.norm(np.maximum(np.abs(place) - left, 0.0), axis=1) - RADIUS


def test_a_floor_is_served_wherever_the_end_finds_room(pocket):
    """Up to the corners that its disk leaves, and no farther: the floor of a pocket with sharp corners."""
    result, rows, place, axis, _ = pocket
    cutter = result.plan.cutters[0].id
    free = served_by(rows, axis[None], result.samples, Context.of(result.judged(cutter), result.conditions))[0][0]
    beyond = missing(place)
    assert not free[beyond > 0.02].any()
    assert free[beyond < 0.0].all()
    assert (beyond < 0.0).sum() > 60
    assert (beyond > 0.02).any()


def test_postures_of_a_floor_keep_the_tool_from_the_walls(pocket):
    """Where each stands is written: its disk lies in the pocket, and the sample under it."""
    result, rows, place, axis, turn = pocket
    cutter, samples = result.judged(result.plan.cutters[0].id), result.samples
    free = served_by(rows, axis[None], samples, Context.of(cutter, result.conditions))[0][0]
    number = np.full(len(samples), -1, np.int32)
    number[rows[free]] = 0
    held = held_at(axis[None], number, samples, Context.of(cutter, result.conditions))
    lean = turn.inv().apply(held.tilt_direction[rows[free]])
    assert (np.linalg.norm(lean, axis=1) <= 1.0 + 1e-9).all()
    assert (np.linalg.norm(lean, axis=1) > 0.0).all()
    middle = place[free] - RADIUS * lean[:, :2]
    assert (np.abs(middle) + RADIUS <= np.array([0.5 * LONG, 0.5 * WIDE]) + 0.02).all()
    tolerance = result.conditions.tolerance
    assert least_clearance(at_fixed_axis(samples, held, tolerance), cutter, held, result.conditions) >= 0.0


@pytest.mark.slow("another frame of the same law", only=("straight",))
def test_rotations_that_are_limited_leave_one_side(pocket):
    result, rows, _, axis, _ = pocket
    cutter = result.judged(result.plan.cutters[0].id)
    limited = plan(result.part, cutters="R7L40", faces="all", grid=15, area_budget=0, rotation=(0.0, 1.0)).conditions
    few = served_by(rows, axis[None], result.samples, Context.of(cutter, limited))[0][0]
    many = served_by(rows, axis[None], result.samples, Context.of(cutter, result.conditions))[0][0]
    assert not (few & ~many).any()
    assert few.sum() < many.sum()


def floor_of(samples):
    """Samples of the floor of a bore, 8 mm under the top."""
    return np.flatnonzero((np.abs(samples.point[:, 2] - 2.0) < 1e-6) & (samples.normal[:, 2] > 0.9))


@pytest.fixture(scope="module")
def bore():
    """A bore of diameter 16 with a flat floor: the edge of a flat end D12 passes its middle at no place."""
    return cq.Workplane("XY").box(40, 40, 20).faces(">Z").workplane().hole(16.0, 8.0).val()


@pytest.mark.parametrize("machine", ["3-axis", "unlimited"])
def test_the_floor_of_a_bore_is_cut_to_its_middle(bore, machine):
    result = plan(bore, cutters="D12L40", faces="all", grid=15, area_budget=0, machine=machine)
    samples, verdicts = result.samples, result.reaches[result.plan.cutters[0].id]
    floor = floor_of(samples)
    away = np.linalg.norm(samples.point[floor, :2], axis=1)
    assert (away < 1.0).any()
    assert verdicts.reached[floor].all()
    # Its middle lies deeper within the flat than the rim: the axis is 2 mm from that of the bore at most.
    inner = floor[away < 3.9]
    inner = inner[verdicts.tilt[inner] == 0.0]
    assert len(inner) or machine == "unlimited"
    middle = samples.point[inner] - 6.0 * verdicts.tilt_direction[inner]
    assert (np.linalg.norm(middle[:, :2], axis=1) <= 2.0 + 0.011).all()


def test_a_bore_as_wide_as_the_cutter_leaves_one_place():
    shape = cq.Workplane("XY").box(40, 40, 20).faces(">Z").workplane().hole(12.0, 8.0).val()
    result = plan(shape, cutters="D12L40", faces="all", grid=15, area_budget=0, machine="3-axis", drill_below=0)
    samples, verdicts = result.samples, result.reaches[result.plan.cutters[0].id]
    floor = floor_of(samples)
    assert verdicts.reached[floor].all()
    middle = samples.point[floor] - 6.0 * verdicts.tilt_direction[floor]
    assert (np.linalg.norm(middle[:, :2], axis=1) <= 0.01).all()


def test_a_cutter_that_is_too_wide_for_a_bore_is_proved_to_be():
    """Nothing is called undecided: the walls of the bore leave its axis no place."""
    shape = cq.Workplane("XY").box(40, 40, 20).faces(">Z").workplane().hole(11.9, 8.0).val()
    result = plan(shape, cutters="D12L40", faces="all", grid=15, area_budget=0, machine="3-axis", drill_below=0)
    samples, verdicts = result.samples, result.reaches[result.plan.cutters[0].id]
    floor = floor_of(samples)
    assert (verdicts.verdict[floor] == INACCESSIBLE).all()
    assert len(floor) > 100


def test_where_the_triangles_do_not_tell_whether_there_is_a_place_nothing_is_proved():
    """The bore is 0.017 mm narrower than the cutter: its wall lies 0.0085 mm deep all around, and its chords nearly 0.01 mm."""
    shape = cq.Workplane("XY").box(40, 40, 20).faces(">Z").workplane().hole(11.983, 8.0).val()
    how = {"area_budget": 0, "machine": "3-axis", "tolerance": 0.01, "drill_below": 0}
    result = plan(shape, cutters="D12L40", faces="all", grid=9, **how)
    samples, verdicts = result.samples, result.reaches[result.plan.cutters[0].id]
    floor = floor_of(samples)
    assert len(floor) > 20
    assert (verdicts.verdict[floor] == UNDECIDED).all()


def test_a_rounded_corner_cuts_only_with_what_is_flat(bore):
    """A bull nose D12 rc 2 has a flat of radius 4: on the floor of the bore it comes to 6 mm from its axis, and no farther."""
    result = plan(bore, cutters="D12L40rc2", faces="all", grid=15, area_budget=0, machine="3-axis", drill_below=0)
    samples, verdicts = result.samples, result.reaches[result.plan.cutters[0].id]
    floor = floor_of(samples)
    away = np.linalg.norm(samples.point[floor, :2], axis=1)
    assert verdicts.reached[floor[away < 6.0]].all()
    assert not verdicts.reached[floor[away > 6.3]].any()
