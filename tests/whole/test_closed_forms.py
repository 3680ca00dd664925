"""Surfaces whose free tilts are known by a formula, with the nominal answer (`tolerance=0`)."""

import math

import numpy as np
import pytest

from cad_io import read_part
from plan_cutters import Cutter, Machine, plan, posture_map
from tests.support import shapes
from tests.support.closed_forms import assert_intervals, free
from tests.support.places import SAMPLES

#: METHOD section 2: rotation -> local gouging from, free from, free to.
V_GROOVE = {
    0: (0.0, 27.6005, 61.395),
    10: (2.7654, 29.8026, 61.705),
    20: (10.7874, 36.2251, 62.647),
    30: (23.5782, 46.5763, 64.260),
    40: (41.3824, 61.2418, 66.603),
}


#: Rotations that are the same but for a mirror or half a turn.
IMAGES = (lambda t: t, lambda t: -t, lambda t: 180 - t, lambda t: 180 + t)


@pytest.fixture(scope="module", params=[1, 4], ids=["one image", "all images"])
def groove(request):
    """Of each rotation one of its images, or all."""
    base = [*V_GROOVE, 50, 52.2, 52.3, 70, 90]
    turns = sorted({IMAGES[(k + i) % 4](b) % 360 for k, b in enumerate(base) for i in range(request.param)})
    part = read_part(SAMPLES / "v_groove.step")
    found, intervals = free(part, Cutter.flat(radius=8, length=90), turns)
    return found, dict(zip(turns, intervals, strict=True))


@pytest.mark.slow("maps four times the rotations", only=("all",))
def test_v_groove_table(groove):
    found, intervals = groove
    assert found.settled
    assert not found.certified
    assert found.curvature == pytest.approx([0.2, 0.0], abs=1e-9)
    assert abs(found.direction_max @ [1, 0, 0]) == pytest.approx(1)
    for turn, interval in intervals.items():
        least = min(turn % 180, 180 - turn % 180)
        i = int(np.flatnonzero(np.isclose(np.degrees(found.rotations), turn))[0])
        if least in V_GROOVE:
            local, first, last = V_GROOVE[least]
            assert np.degrees(found.local_gouge[i]) == pytest.approx(local, abs=1e-3)
            assert_intervals(interval, (first, last))
        else:
            assert_intervals(interval)
        assert math.isnan(found.local_gouge[i]) == (least > 52.2388)


@pytest.mark.slow("maps four times the rotations", only=("all",))
def test_v_groove_attributes_together_leave_what_is_free(groove):
    found, intervals = groove
    tilts = np.radians(np.linspace(0, 90, 3601))
    for i, interval in enumerate(intervals.values()):
        if math.isnan(found.local_gouge[i]):
            continue
        left = tilts >= found.local_gouge[i]
        for forbidden in (found.rear_gouge[i], found.collision[i], found.axis_limit[i]):
            for first, last in forbidden:
                left &= ~((tilts > first) & (tilts < last))
        inside = np.zeros(len(tilts), bool)
        for first, last in np.radians(interval):
            inside |= (tilts >= first) & (tilts <= last)
        assert (left != inside).sum() <= 4


def test_plane_alone_is_free_at_every_posture():
    part = shapes.shell(shapes.plane((-200, 200), (-200, 200)))
    found, intervals = free(part, Cutter.flat(radius=5, length=50), [0, 33, 90, 200])
    for interval in intervals:
        assert_intervals(interval, (0, 90))
    assert found.local_gouge == pytest.approx(0)


@pytest.mark.parametrize(("a", "radius", "length"), [(6.0, 5.0, 50.0), (2.0, 5.0, 50.0), (9.0, 5.0, 12.0), (20.0, 5.0, 50.0)])
def test_plane_with_a_wall(a, radius, length):
    """A wall x = a, higher than the cutter is long. Leaning to it, the generator through the contact reaches x = L sin(tilt);
    leaning from it, the far rim is at 2R cos(tilt); leaning along it, the cutter is R wide."""
    part = shapes.shell(
        shapes.plane((-100, a), (-100, 100)), shapes.plane((0, 100), (-100, 100), (a, 0, 0), (-1, 0, 0), (0, 0, 1))
    )
    cutter = Cutter.flat(radius=radius, length=length)
    found, (towards, away, along) = free(part, cutter, [0, 180, 90])
    assert found.direction_max == pytest.approx([1, 0, 0])
    assert_intervals(towards, (0, math.degrees(math.asin(min(1, a / length)))))
    assert_intervals(away, (math.degrees(math.acos(min(1, a / (2 * radius)))), 90))
    assert_intervals(along, *([(0, 90)] if radius <= a else []))


@pytest.mark.slow("searches long", only=("20",))
@pytest.mark.parametrize(("rho", "radius"), [(20.0, 6.0), (10.0, 8.0)])
def test_cylinder_trough(rho, radius):
    """Half a cylinder, contact on its bottom line: sin(tilt) >= R / rho across and along; leaning across, the generator
    through the contact meets the trough's edge at 45 deg."""
    part = shapes.shell(shapes.trough(rho, 60))
    found, (across, along) = free(part, Cutter.flat(radius=radius, length=45), [0, 90])
    least = math.degrees(math.asin(radius / rho))
    assert found.curvature == pytest.approx([1 / rho, 0], abs=1e-9)
    assert_intervals(across, *([(least, 45)] if least < 45 else []))
    assert_intervals(along, (least, 90))


def test_cylinder_ridge():
    part = shapes.shell(shapes.ridge(15, 100))
    found, intervals = free(part, Cutter.flat(radius=6, length=60), [0, 45, 90])
    assert found.curvature == pytest.approx([0, -1 / 15], abs=1e-9)
    for interval in intervals:
        assert_intervals(interval, (0, 90))


def test_sphere_bowl():
    """sin(tilt) >= R / rho by local and rear gouging alike; the bowl's edge at 45 deg ends it."""
    part = shapes.shell(shapes.bowl(20.0))
    found, intervals = free(part, Cutter.flat(radius=6, length=90), [0, 77, 180, 301], point=(0, 0, 0))
    assert found.normal == pytest.approx([0, 0, 1], abs=1e-6)
    for interval in intervals:
        assert_intervals(interval, (math.degrees(math.asin(6 / 20)), 45))


def test_sphere_dome():
    part = shapes.shell(shapes.dome(20.0))
    found, intervals = free(part, Cutter.flat(radius=6, length=90), [0, 77, 180])
    assert found.curvature == pytest.approx([-1 / 20, -1 / 20], abs=1e-9)
    for interval in intervals:
        assert_intervals(interval, (0, 90))


def test_torus_local_gouging():
    """On the inner equator the tube is convex (-1/b) and the ring concave (1/(A - b))."""
    major, minor, radius = 30.0, 8.0, 5.0
    turns = np.radians([0, 30, 60, 90])
    found = posture_map(shapes.shell(shapes.torus(major, minor)), point=(major - minor, 0, 0),
                        cutter=Cutter.flat(radius=radius, length=40), rotations=turns)  # fmt: skip
    inner, tube = 1 / (major - minor), -1 / minor
    assert found.curvature == pytest.approx([inner, tube], abs=1e-9)
    bound = radius * (inner * np.sin(turns) ** 2 + tube * np.cos(turns) ** 2)
    assert found.local_gouge == pytest.approx(np.arcsin(np.clip(bound, 0, 1)), abs=1e-9)


def test_axis_limit_cuts_the_plane():
    part = shapes.shell(shapes.plane((-200, 200), (-200, 200)))
    found, intervals = free(part, Cutter.flat(radius=5, length=50), [0, 120], machine=Machine.parse("tilt:25"))
    for i, interval in enumerate(intervals):
        assert_intervals(interval, (0, 25))
        assert np.degrees(found.axis_limit[i]) == pytest.approx(np.array([[25.0, 90.0]]))
    # The setup axis leant by 40 deg towards x: along x, tilts from 15 to 65 deg.
    setup = (math.sin(math.radians(40)), 0.0, math.cos(math.radians(40)))
    _, (along, against) = free(part, Cutter.flat(radius=5, length=50), [0, 180], machine=Machine.parse("tilt:25"), setup=setup)
    assert_intervals(along, (15, 65))
    assert_intervals(against)


def test_axis_of_a_posture():
    part = shapes.shell(shapes.plane((-50, 50), (-50, 50)))
    found, _ = free(part, Cutter.flat(radius=5, length=50), [0, 90])
    assert found.axis(0, 0.3) == pytest.approx([math.sin(0.3), 0, math.cos(0.3)])
    assert found.axis(1, 0.3) == pytest.approx([0, math.sin(0.3), math.cos(0.3)])


def test_flat_and_convex_faces_are_interference_free():
    for face in (shapes.plane((-50, 50), (-50, 50)), shapes.dome(40.0), shapes.ridge(30.0, 60)):
        result = plan(shapes.shell(face), cutters=[Cutter.flat(radius=4, length=40)], grid=15, area_budget=0)
        entry = result.cutters[0]
        assert entry.feasible
        assert entry.interference_free == result.plan.samples.count
        assert entry.march_differs == 0


def test_a_hole_narrower_than_the_cutter_is_out_of_reach():
    """A trough of radius 5 that closes over its bottom: R 6 cannot touch the bottom line, R 2 can."""
    part = shapes.shell(shapes.trough(5.0, 60, span=4.2))
    small, large = (plan(part, cutters=[Cutter.flat(radius=r, length=60)], grid=15, area_budget=0, drill_below=0).cutters[0]
                    for r in (2, 6))  # fmt: skip
    assert small.feasible
    assert large.feasible is False
    assert large.by_reason["local_gouge"] + large.by_reason["rear_gouge"] > 0
    assert large.witnesses
    for witness in large.witnesses:
        assert witness.depth_mm is not None
        assert witness.depth_mm > 0.01
        assert witness.obstacle_face == "F1"
        x, y, z = witness.obstacle_point
        point = np.array([x, y, z])
        axis = np.array(witness.best_posture.axis)
        assert np.linalg.norm(point - np.array(witness.point)) < math.hypot(12, 60)
        assert (point - np.array(witness.point)) @ axis > -1e-6, "below the cutter's bottom"


def test_the_axis_limit_is_a_reason():
    wall = shapes.shell(shapes.plane((-20, 20), (-20, 20), z=(1, 0, 0), x=(0, 1, 0)))
    entry = plan(wall, cutters=[Cutter.flat(radius=4, length=40)], grid=5, area_budget=0, tilt=(0, math.radians(30)),
                 machine=Machine.parse("tilt:20")).cutters[0]  # fmt: skip
    assert entry.by_reason["axis_limit"] == entry.inaccessible == 25
    assert entry.witnesses[0].best_posture is None


def test_without_tilt_0_nothing_is_interference_free():
    part = shapes.shell(shapes.plane((-50, 50), (-50, 50)))
    entry = plan(part, cutters=[Cutter.flat(radius=4, length=40)], grid=7, area_budget=0, tilt=(0.1, 1.0)).cutters[0]
    assert entry.interference_free == 0
    assert entry.accessible == 49
