"""A flat end that stands upright on a floor beside walls: it may touch with any side of its bottom."""

import cadquery as cq
import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from plan_cutters import plan
from plan_cutters.kernels.search.fixed_axis import DIRECTIONS
from plan_cutters.scene.clearance import least_clearance
from plan_cutters.scene.conditions import Context
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
    rows = np.flatnonzero(np.abs(place[:, 2] - (10.0 - DEEP)) < 1e-6)
    rows = rows[(np.abs(place[rows, :2]) < (0.5 * LONG, 0.5 * WIDE)).all(axis=1)]
    assert len(rows) > 100
    off = (0.0, 0.0, 0.0) if request.param == "straight" else (3e-5, -1e-5, 0.0)
    axis = turn.apply(np.array([0.0, 0.0, 1.0]) + off)
    return result, rows, place[rows, :2], axis / np.linalg.norm(axis), turn


def room(place):
    """The most that a disk with a point of the floor (n, 2) on its rim keeps from the walls."""
    turn = np.arange(7200) * (2.0 * np.pi / 7200)
    middle = place[:, None] - RADIUS * np.column_stack([np.cos(turn), np.sin(turn)])
    return (np.array([0.5 * LONG, 0.5 * WIDE]) - np.abs(middle)).min(axis=2).max(axis=1) - RADIUS


def test_a_floor_is_served_wherever_the_end_finds_room(pocket):
    result, rows, place, axis, _ = pocket
    cutter = result.plan.cutters[0].id
    free = served_by(rows, axis[None], result.samples, Context.of(result.judged(cutter), result.conditions))[0][0]
    at_best = room(place)
    # From the best side the nearest that is tried is half a step away at most.
    loss = RADIUS * (np.pi / DIRECTIONS) * 1.01
    assert not free[at_best < -0.02].any()
    assert free[at_best > loss].all()
    assert (at_best > loss).sum() > 60
    assert (at_best < -0.02).any()


def test_postures_of_a_floor_keep_the_tool_from_the_walls(pocket):
    """Where each stands is written: its disk lies in the pocket."""
    result, rows, place, axis, turn = pocket
    cutter, samples = result.judged(result.plan.cutters[0].id), result.samples
    free = served_by(rows, axis[None], samples, Context.of(cutter, result.conditions))[0][0]
    number = np.full(len(samples), -1, np.int32)
    number[rows[free]] = 0
    held = held_at(axis[None], number, samples, Context.of(cutter, result.conditions))
    lean = turn.inv().apply(held.tilt_direction[rows[free]])
    assert np.allclose(np.linalg.norm(lean, axis=1), 1.0)
    middle = place[free] - RADIUS * lean[:, :2]
    assert (np.abs(middle) + RADIUS <= np.array([0.5 * LONG, 0.5 * WIDE]) + 0.02).all()
    assert least_clearance(at_fixed_axis(samples, held), cutter, held, result.conditions) >= 0.0


def test_rotations_that_are_limited_leave_one_side(pocket):
    result, rows, _, axis, _ = pocket
    cutter = result.judged(result.plan.cutters[0].id)
    limited = plan(result.part, cutters="R7L40", faces="all", grid=15, area_budget=0, rotation=(0.0, 1.0)).conditions
    few = served_by(rows, axis[None], result.samples, Context.of(cutter, limited))[0][0]
    many = served_by(rows, axis[None], result.samples, Context.of(cutter, result.conditions))[0][0]
    assert not (few & ~many).any()
    assert few.sum() < many.sum()
