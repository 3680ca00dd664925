"""Tools of each kind on surfaces where their free tilts are known by a formula: sections across grooves, walls and rims."""

import math

import numpy as np
import pytest
from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeFace
from OCP.gp import gp_Cylinder, gp_Sphere

from plan_cutters import Cutter, plan, posture_map
from plan_cutters.domain.verdicts import INACCESSIBLE, REASONS
from tests.support import cad_parts, shapes
from tests.support.closed_forms import WIDE, assert_intervals, floor, free, wall

PI = math.pi


def rotation(part, tilt_direction, point):
    """The rotation, rad, of a tilt direction: from the curvature there, for which any small cutter will do."""
    found = posture_map(part, point=point, cutter=Cutter.flat(radius=0.1, length=1), rotations=[0.0], tolerance=0.01)
    e1, n = found.direction_max, found.normal
    return math.atan2(np.dot(tilt_direction, np.cross(n, e1)), np.dot(tilt_direction, e1)) % (2 * PI)


def towards(part, cutter, tilt_direction, point=(0, 0, 0), **options):
    """Free tilts, deg, when leaning in the direction given, and the map."""
    found, (intervals,) = free(part, cutter, [math.degrees(rotation(part, tilt_direction, point))], point, **options)
    return intervals, found


def kept(part, cutter, tilt_direction, expected, point=(0, 0, 0)):
    """To a tolerance: what is free holds in all of the range expected and beyond it by no more than that leaves."""
    turn = rotation(part, tilt_direction, point)
    found = posture_map(part, point=point, cutter=cutter, rotations=[turn], tolerance=0.01, tilt=(0.0, 0.5 * PI))
    (intervals,) = np.degrees(found.free)
    intervals = intervals[intervals[:, 1] - intervals[:, 0] > 0.02]
    assert intervals.shape == (1, 2), intervals
    assert intervals[0, 0] == pytest.approx(expected[0], abs=0.3)
    assert intervals[0, 1] == pytest.approx(expected[1], abs=0.3)
    assert intervals[0, 0] <= expected[0] + 0.02
    assert intervals[0, 1] >= expected[1] - 0.02
    return found


def before(along, across, least):
    """The tilt, deg, from which a point (along, across) over the pivot, in the plane of the lean, comes nearer than `least`."""
    return math.degrees(math.acos(least / math.hypot(along, across)) - math.atan2(across, along))


def hollow(radius):
    """Of the lower half of a sphere through the origin a broad strip up to its rim in +Y; material outside."""
    frame = shapes.axes((0, 0, radius), (1, 0, 0), (0, 0, -1))
    return BRepBuilderAPI_MakeFace(gp_Sphere(frame, radius), -0.4, PI / 2, -0.5, 0.5).Face().Reversed()


def test_a_ball_in_a_bowl_is_stopped_by_its_rim():
    part = shapes.shell(hollow(10.0))
    intervals, found = towards(part, Cutter.ball(radius=3, length=60), (0, 1, 0))
    assert_intervals(intervals, (0, before(10.0, 7.0, 3.0)))
    assert found.local_gouge == pytest.approx(0)
    # A ball that is larger than the bowl touches nowhere else than at its rim.
    intervals, found = towards(part, Cutter.ball(radius=10.1, length=60), (0, 1, 0))
    assert_intervals(intervals)
    assert np.isnan(found.local_gouge).all()


@pytest.mark.slow("judges with a fine map of postures")
def test_a_ball_in_a_fillet_of_its_radius_lies_down_along_it_and_not_across():
    part, cutter = shapes.shell(shapes.trough(3.0, 100.0)), Cutter.ball(radius=3, length=40)
    along, _ = towards(part, cutter, (0, 1, 0))
    assert_intervals(along, (0, 90))
    across, _ = towards(part, cutter, (1, 0, 0))
    # Upright it fits; a hair more than that is what the nominal answer lets pass.
    assert across.max(initial=0.0) < 3.0
    none, found = towards(part, Cutter.ball(radius=3.01, length=40), (0, 1, 0))
    assert_intervals(none)
    assert np.isnan(found.local_gouge).all()


@pytest.mark.parametrize("corner", [1.0, 1.5])
def test_a_bull_in_a_fillet_touches_floor_and_wall(corner):
    """A quarter of a cylinder of radius 2 between floor and wall, contact at 45 deg: at that tilt the tool stands upright."""
    rho, high, radius, beta = 2.0, 12.0, 6.0, PI / 4
    quarter = BRepBuilderAPI_MakeFace(
        gp_Cylinder(shapes.axes((0, -200, rho), (0, 1, 0), (0, 0, -1)), rho), -PI / 2, 0.0, 0.0, 400.0
    ).Face()
    part = shapes.shell(floor(-200.0, 0.0), quarter.Reversed(), wall(rho, rho, high, -1))
    s, c = math.sin(beta), math.cos(beta)
    contact, tilt_direction = (rho * s, 0, rho - rho * c), (c, 0, s)
    x, z = (rho - corner) * s, rho - (rho - corner) * c
    first = math.degrees(beta - math.asin((z - corner) / (2 * (radius - corner))))
    last = math.degrees(beta) + before(rho - x, high - z, corner)
    kept(part, Cutter.bull(radius=radius, corner_radius=corner, length=60), tilt_direction, (first, last), contact)
    large = Cutter.bull(radius=radius, corner_radius=2.5, length=60)
    found = posture_map(part, point=contact, cutter=large, rotations=[0.0], tolerance=0.01)
    assert np.isnan(found.local_gouge).all()


def test_a_taper_ball_between_walls():
    half, high, radius, b = 6.0, 25.0, 2.0, math.radians(5)
    part = shapes.shell(floor(-half, half), wall(half, 0, high, -1), wall(-half, 0, high, 1))
    intervals, _ = towards(part, Cutter.ball(radius=radius, length=80, taper=b), (1, 0, 0))
    assert_intervals(intervals, (0, before(half, high - radius, radius) - 5))
    # The same without a taper leans as much farther.
    intervals, _ = towards(part, Cutter.ball(radius=radius, length=80), (1, 0, 0))
    assert_intervals(intervals, (0, before(half, high - radius, radius)))


def test_a_cone_in_a_slot():
    """A tapered flat end: the one flank comes nearer to the wall it leans to, the other flank stands off the other one."""
    right, left, high, radius, b = 12.0, 9.0, 30.0, 2.0, math.radians(10)
    part = shapes.shell(floor(-left, right), wall(right, 0, high, -1), wall(-left, 0, high, 1))
    intervals, found = towards(part, Cutter.flat(radius=radius, length=80, taper=b), (1, 0, 0))

    def clear(t):
        # Of the left rim from the left flank.
        x, z = left - 2 * radius * math.cos(t), high - 2 * radius * math.sin(t)
        return x * math.cos(t - b) + z * math.sin(t - b)

    low, top = 0.0, b
    for _ in range(60):
        middle = 0.5 * (low + top)
        low, top = (middle, top) if clear(middle) < 0 else (low, middle)
    assert clear(0.0) < 0 < clear(b)
    assert_intervals(intervals, (math.degrees(low), math.degrees(math.atan2(right, high) - b)))
    assert len(found.no_contact[0]) == 1
    assert np.degrees(found.no_contact[0][0]) == pytest.approx([80, 90])


@pytest.mark.parametrize("edge", [3.0, 8.0])
def test_a_lollipop_under_an_overhang_leans_beyond_a_right_angle(edge):
    """Contact on the underside of a plate, up to whose edge the neck may rise."""
    radius, neck = 4.0, 2.0
    part = shapes.shell(shapes.plane((-edge, 200), WIDE, (0, 0, 0), (0, 0, -1), (-1, 0, 0)))
    cutter = Cutter.lollipop(radius=radius, neck_radius=neck, length=60)
    intervals, found = towards(part, cutter, (1, 0, 0), tilt=(0.0, PI))
    last = math.degrees(math.atan2(radius, edge) + math.acos(neck / math.hypot(edge, radius)))
    assert 90 < last < 150
    # Its stage alone is what comes near: the ball touches at every tilt.
    assert_intervals(intervals, (0, last))
    assert np.degrees(found.no_contact[0]) == pytest.approx(np.array([[150.0, 180.0]]))
    # But for where its neck begins, which is where the slack of a lollipop lies.
    assert len(found.rear_gouge[0]) == 0
    assert (found.collision[0] > math.radians(149.5)).all()
    assert np.degrees(found.neck[0]) == pytest.approx(np.array([[last, 150.0]]), abs=0.05)
    # A ball end touches there no more.
    intervals, _ = towards(part, Cutter.ball(radius=radius, length=60), (1, 0, 0), tilt=(0.0, PI))
    assert intervals.max() <= 90 + 1e-6


def step(at, high):
    """A floor, a wall at x and the plane on top of it."""
    return shapes.shell(floor(-200.0, at), wall(at, 0, high, -1), shapes.plane((at, 200), WIDE, (0, 0, high)))


def test_a_holder_over_a_wall():
    """The holder's nose, 20 mm over the tip, passes over a wall of 18 mm until it leans down to it."""
    at, high, radius, length, wide = 6.0, 18.0, 3.0, 20.0, 10.0
    bare = Cutter.flat(radius=radius, length=60)
    held = Cutter.flat(radius=radius, length=length, holder="R10L30")
    # L cos T - (wide - radius) sin T = high.
    last = before(length, wide - radius, high)
    intervals, found = towards(step(at, high), held, (1, 0, 0))
    assert_intervals(intervals, (0, last))
    assert np.degrees(found.holder[0][0, 0]) == pytest.approx(last, abs=0.05)
    beside = math.degrees(math.atan2(at, high))
    assert last < beside
    assert_intervals(towards(step(at, high), bare, (1, 0, 0))[0], (0, beside))
    # As much less as it is to keep clear: its nose comes down by that, and its edge goes round.
    kept = Cutter.flat(radius=radius, length=length, holder="R10L30", clearance=1.0)
    assert_intervals(towards(step(at, high), kept, (1, 0, 0))[0], (0, before(length, wide - radius, high + 1.0)))


def test_a_holder_beside_a_wall():
    at, high, radius, length, wide = 9.0, 30.0, 3.0, 20.0, 10.0
    held = Cutter.flat(radius=radius, length=length, holder="R10L60")
    last = before(at, high, wide - radius)
    intervals, found = towards(step(at, high), held, (1, 0, 0))
    assert_intervals(intervals, (0, last))
    assert np.degrees(found.holder[0][0, 0]) == pytest.approx(last, abs=0.05)
    kept = Cutter.flat(radius=radius, length=length, holder="R10L60", clearance=0.5)
    assert_intervals(towards(step(at, high), kept, (1, 0, 0))[0], (0, before(at, high, wide - radius + 0.5)))


def test_stock_left_lifts_the_tool_off():
    """With an allowance the tool stands that much away from all the surface, as one that is larger all round."""
    half, high, radius, left = 6.0, 25.0, 2.0, 0.5
    part = shapes.shell(floor(-half, half), wall(half, 0, high, -1), wall(-half, 0, high, 1))
    intervals, _ = towards(part, Cutter.ball(radius=radius, length=80, allowance=left), (1, 0, 0))
    assert_intervals(intervals, (0, before(half, high - radius - left, radius + left)))


@pytest.mark.slow("plans parts whole")
def test_a_barrel_on_a_cylinder():
    """On a ridge it is free wherever its flank touches; in a trough narrower than itself only where it leans enough."""
    cutter = Cutter.barrel(radius=12, flank_radius=60, length=60, height=20, flutes=35)
    first, last = math.degrees(math.acos(20 / 60)), 90.0
    ridge = shapes.shell(shapes.ridge(10.0, 120.0))
    for tilt_direction in ((0, 1, 0), (1, 0, 0), (1, 1, 0)):
        found = kept(ridge, cutter, tilt_direction, (first, last))
        assert np.degrees(found.no_contact[0]) == pytest.approx(np.array([[0.0, first]]))
    found = posture_map(
        shapes.shell(shapes.trough(10.0, 120.0)), point=(0, 0, 0), cutter=cutter, rotations=[PI / 2], tolerance=0.01
    )
    assert np.degrees(found.local_gouge_most[0]) == pytest.approx(math.degrees(math.asin(4.8 / 5)), abs=1e-6)
    found = posture_map(
        shapes.shell(shapes.trough(12.5, 120.0)), point=(0, 0, 0), cutter=cutter, rotations=[PI / 2], tolerance=0.01
    )
    assert np.degrees(found.local_gouge_most[0]) == pytest.approx(math.degrees(math.acos(-15 / 60)))


def test_a_pocket_is_finished_by_the_balls_that_are_no_larger():
    part = cad_parts.pocketed(5.0)
    how = {"spacing": 1.0, "area_budget": 0}
    small, large = Cutter.ball(radius=4, length=60), Cutter.ball(radius=5.2, length=60)
    flat = Cutter.flat(radius=2, length=60)
    result = plan(part, cutters=[small, large, flat], **how)
    round_ = result.samples.curvature[:, 1] > 0.1
    assert round_.sum() > 30
    assert result.reaches[small.id].reached[round_].all()
    not_reached = result.reaches[large.id]
    assert (not_reached.verdict[round_] == INACCESSIBLE).all()
    assert {REASONS[r] for r in not_reached.reason[round_]} == {"local_gouge"}
    # A flat end leans with its edge; it need not stand upright.
    assert result.reaches[flat.id].reached[round_].mean() > 0.5


def test_a_pointed_form_touches_with_its_tip():
    """On a floor it leans from its tip to its corner, at 45 deg, and from there on it."""
    pointed = Cutter.form([(0, 0), (3, 3), (3, 10)], length=30)
    found = posture_map(floor(), point=(0, 0, 0), cutter=pointed, rotations=[0.0], tolerance=0.01)
    assert_intervals(np.degrees(found.free[0]), (0, 90))
