"""One rule everywhere: a posture is safe if no point of the true surface is deeper in the tool than the tolerance.

Where the surface bends more than the cutter's edge, curvature says no at every depth; here the depth counts, and is known.
"""

import math

import numpy as np
import pytest
from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeFace
from OCP.gp import gp_Cylinder

from cad_io import read_part
from plan_cutters import Cutter, PostureRange, plan, posture_map
from plan_cutters.answers.largest_radius import largest_radius
from plan_cutters.domain.holder import Holder, Segment
from plan_cutters.domain.verdicts import ACCESSIBLE, INACCESSIBLE, REASONS, UNDECIDED
from plan_cutters.judging.judge import judge
from plan_cutters.options import Options
from plan_cutters.pipeline import prepare
from plan_cutters.scene.conditions import Context
from tests.support import shapes
from tests.support.serving import serves
from tests.support.tool_reference import Reference

TOLERANCE = 0.01
BALL = Cutter.ball(radius=0.5, length=20)


def fillet(radius, half=5.0, size=8.0):
    """A floor, z = 0, and a wall, x = 0, joined by a fillet along Y; material below and behind."""
    frame = shapes.axes((-radius, -half, radius), (0, 1, 0), (0, 0, -1))
    bend = BRepBuilderAPI_MakeFace(gp_Cylinder(frame, radius), -math.pi / 2, 0.0, 0.0, 2 * half).Face().Reversed()
    floor = shapes.plane((-size, -radius), (-half, half))
    wall = shapes.plane((radius, size), (-half, half), (0, 0, 0), (-1, 0, 0), (0, 0, 1))
    return shapes.shell(bend, floor, wall)


def in_fillet(radius, rng, count, half=5.0, size=8.0):
    """Points of that surface by formula."""
    turn, y = rng.uniform(0, math.pi / 2, count), rng.uniform(-half, half, count)
    bend = np.stack([-radius + radius * np.sin(turn), y, radius - radius * np.cos(turn)], axis=1)
    away = rng.uniform(radius, size, count)
    floor, wall = np.stack([-away, y, 0 * y], axis=1), np.stack([0 * y, y, away], axis=1)
    return np.concatenate([bend, floor, wall])


def depths(cutter, samples, reach, row, points):
    """How deep points lie in the true tool at the posture found, mm."""
    reference = Reference(cutter)
    tip, (_, _, axis) = reference.frame(
        samples.point[row], samples.normal[row], reach.tilt_direction[row], float(reach.tilt[row])
    )
    from_tip = points - tip
    height = from_tip @ axis
    return reference.whole.depth(np.linalg.norm(from_tip - height[:, None] * axis, axis=1), height)


def asked(part, cutter, **options):
    result = plan(part, cutters=[cutter], **{"tolerance": TOLERANCE, "grid": 9, "area_budget": 0, **options})
    (reach,) = result.reaches.values()
    return result, reach


def reasons(reach):
    return {REASONS[k] for k in reach.reason[reach.not_reached]}


def too_deep(radius, ball=0.5):
    """How deep floor and wall come into a ball that touches a fillet in its middle: its centre lies `ball - radius` behind the
    fillet's axis.
    """
    return (ball - radius) * (1 - math.cos(math.pi / 4))


@pytest.mark.parametrize("radius", [0.4999, 0.5])
def test_a_ball_reaches_a_fillet_of_its_own_radius(radius):
    _, reach = asked(fillet(radius), BALL)
    assert reach.reached.all()


def test_a_ball_does_not_reach_a_fillet_too_small_for_it():
    assert too_deep(0.40) > 2 * TOLERANCE
    result, reach = asked(fillet(0.40), BALL, faces="1")
    assert (reach.verdict == INACCESSIBLE).all()
    assert reasons(reach) == {"local_gouge"}
    (cutter,) = result.plan.cutters
    told = [(np.array(w.point), w.depth_mm) for w in cutter.witnesses]
    assert told
    for point, depth in told:
        # No posture of a ball is better than another: its tip is the same body at all of them.
        turn, away = np.linspace(0, math.pi / 2, 2001), np.linspace(0.4, 3, 2001)
        x = np.concatenate([-0.4 + 0.4 * np.sin(turn), -away, 0 * away])
        z = np.concatenate([0.4 - 0.4 * np.cos(turn), 0 * away, away])
        middle = point + 0.5 / 0.4 * (np.array([-0.4, point[1], 0.4]) - point)
        exact = 0.5 - np.hypot(x - middle[0], z - middle[2]).min()
        assert exact - 1e-6 <= depth <= 1.03 * exact


def test_what_neither_proof_decides_is_undecided():
    """A gouge as deep as the tolerance, within the chord error: it is told as a depth, not as the floor of a search."""
    radius = 0.5 - TOLERANCE / (1 - math.cos(math.pi / 4))
    assert too_deep(radius) == pytest.approx(TOLERANCE, abs=1e-6)
    result, reach = asked(fillet(radius), BALL, faces="1")
    middle = np.abs(result.samples.point[:, 0] + result.samples.point[:, 2]).argmin()
    assert reach.verdict[middle] == UNDECIDED
    witnesses = [w for w in result.plan.cutters[0].witnesses if w.depth_mm is not None]
    assert witnesses
    rng = np.random.default_rng(0)
    for witness in witnesses:
        points = in_fillet(radius, rng, 40_000, size=1.5)
        point = np.array(witness.point)
        normal = result.samples.normal[np.linalg.norm(result.samples.point - point, axis=1).argmin()]
        tip, (_, _, axis) = Reference(BALL).frame(point, normal, *leaning(normal, np.array(witness.best_posture.axis)))
        height = (points - tip) @ axis
        deep = Reference(BALL).whole.depth(np.linalg.norm(points - tip - height[:, None] * axis, axis=1), height)
        assert witness.depth_mm == pytest.approx(deep.max(), abs=2e-4)


def leaning(normal, axis):
    """Lean direction and tilt of a tool axis."""
    across = axis - (axis @ normal) * normal
    return across / np.linalg.norm(across), math.atan2(float(np.linalg.norm(across)), float(axis @ normal))


def test_a_bull_nose_reaches_the_corner_of_its_own_radius():
    cutter = Cutter.bull(radius=3, corner_radius=1, length=20)
    _, reach = asked(fillet(0.999), cutter, faces="1")
    assert (reach.verdict == ACCESSIBLE).all()
    _, reach = asked(fillet(0.9), cutter, faces="1")
    assert (reach.verdict == INACCESSIBLE).all()
    assert reasons(reach) == {"local_gouge"}


@pytest.mark.parametrize("share", [0.9, 1.1])
def test_a_flat_end_in_a_slot_beside_rises_of_so_many_tolerances(share):
    """Upright, in a slot narrower than it is wide between two rises: flat faces have no chord error, so the tolerance decides."""
    rise, half, out = share * TOLERANCE, 3.0, 12.0
    slot = shapes.plane((-half, half), (-20, 20))
    sides = [shapes.plane((half, out), (-20, 20), (0, 0, rise)), shapes.plane((-out, -half), (-20, 20), (0, 0, rise))]
    walls = [shapes.plane((0, rise), (-20, 20), (x, 0, 0), (-x, 0, 0), (0, 0, 1)) for x in (half, -half)]
    part = shapes.shell(slot, *sides, *walls)
    result, reach = asked(part, Cutter.flat(radius=5, length=30), tilt=(0.0, 0.0), faces="1,2,3", spacing=0.5, grid=None)
    # At the slot's open ends the cutter stands beside it.
    within = np.abs(result.samples.point[:, 1]) < 20 - 10
    inside = within & (result.samples.face == 1)
    assert reach.reached[within & ~inside].all()
    assert (reach.reached[inside] if share < 1 else reach.verdict[inside] == INACCESSIBLE).all()
    # By arc length across the slot.
    expected, area = 1.0 if share < 1 else (out - half) / out, result.samples.area
    assert area[reach.reached & within].sum() / area[within].sum() == pytest.approx(expected, abs=1e-6)


@pytest.mark.slow("plans with five tolerances for each radius", but=("0.4935",))
@pytest.mark.parametrize("radius", [0.47, 0.485, 0.4935, 0.4999])
def test_a_coarser_tolerance_reaches_no_less(radius):
    before = None
    for tolerance in (0.0025, 0.005, 0.01, 0.02, 0.04):
        _, reach = asked(fillet(radius), BALL, tolerance=tolerance)
        assert before is None or (reach.reached | ~before).all()
        before = reach.reached


CASES = [(0.49, BALL), (0.4935, BALL), (0.4999, Cutter.ball(radius=0.5, length=20, taper=0.05)),
         (0.985, Cutter.bull(radius=3, corner_radius=1, length=20)), (2.0, Cutter.flat(radius=1, length=20)),
         (0.4999, Cutter.ball(radius=0.5, length=5, holder=Holder((Segment(4.0, 20),))))]  # fmt: skip


def deepest_of_found(radius, cutter, grid, count):
    result, reach = asked(fillet(radius), cutter, grid=grid)
    rng, deepest = np.random.default_rng(1), -np.inf
    for row in rng.choice(np.flatnonzero(reach.reached), count):
        points = np.concatenate([in_fillet(radius, rng, 6000), result.samples.point[row : row + 1]])
        deepest = max(deepest, float(depths(cutter, result.samples, reach, row, points).max()))
    return deepest


@pytest.mark.parametrize(("radius", "cutter"), CASES, ids=lambda c: getattr(c, "id", c))
def test_no_posture_found_lets_the_true_surface_come_too_deep(radius, cutter):
    assert -1e-6 < deepest_of_found(radius, cutter, 21, 60) <= TOLERANCE


@pytest.mark.slow("looks at ten thousand postures")
@pytest.mark.parametrize(("radius", "cutter"), CASES, ids=lambda c: getattr(c, "id", c))
def test_no_posture_of_ten_thousand_lets_the_true_surface_come_too_deep(radius, cutter):
    deepest = deepest_of_found(radius, cutter, 61, 10_000)
    print(f"deepest {deepest:.6f} mm")
    assert -1e-6 < deepest <= TOLERANCE


@pytest.mark.slow("plans parts whole")
def test_posture_maps_and_the_map_of_a_point_follow_the_same_rule():
    part = read_part(fillet(0.4999))
    result = plan(part, cutters=[BALL], tolerance=TOLERANCE, grid=3, area_budget=0, posture_maps=True, faces="1")
    (reach,) = result.reaches.values()
    turns = len(result.maps.rotations)
    count = np.diff(result.maps.offset).reshape(-1, turns)
    assert reach.reached.all()
    assert (count.sum(axis=1) > 0).all()
    row = len(count) // 2
    point = result.samples.point[row].tolist()
    loose = posture_map(part, point=point, cutter=BALL, rotations=result.maps.rotations, tolerance=TOLERANCE)
    strict = posture_map(part, point=point, cutter=BALL, rotations=[0.0, 2.0], tolerance=0)
    assert np.isnan(loose.local_gouge).all()
    assert np.isnan(strict.local_gouge).all()
    assert not any(len(free) for free in strict.free)
    for turn in range(turns):
        one = result.maps.free[result.maps.offset[row * turns + turn] : result.maps.offset[row * turns + turn + 1]]
        wide = loose.free[turn][loose.free[turn][:, 1] - loose.free[turn][:, 0] > 0.01]
        assert len(one) == len(wide)
        assert one == pytest.approx(wide, abs=math.radians(0.3))
    tilt, turn = float(reach.tilt[row]), int(reach.rotation[row])
    assert any(low <= tilt <= high for low, high in loose.free[turn])


def test_largest_radius_a_fixed_axis_and_nesting_follow_the_same_rule():
    part = read_part(fillet(0.5))
    small, same, large = (Cutter.ball(radius=r, length=20) for r in (0.45, 0.5005, 0.6))
    options = Options.of({"cutters": [small, same, large], "tolerance": TOLERANCE, "grid": 7, "faces": "1"})
    ready = prepare(part, options)
    found = largest_radius(ready, "ball", ratio=40.0, step=0.002, least=0.45, most=0.6)
    # The ball that gouges just as deep as is allowed, at the ends of the fillet.
    for row, largest in enumerate(found.radius):
        assert largest > 0.5 * 1.002, row
    reach = judge(ready, same)
    assert reach.reached.all()
    axis = ready.samples.normal[0]
    assert serves(np.array([0]), axis, ready.samples, Context.of(same, ready.conditions)).all()
    result = plan(part, cutters=[small, same, large], tolerance=TOLERANCE, grid=7, faces="1", area_budget=0)
    for cutter in (small, same, large):
        alone = judge(ready, cutter)
        assert (result.reaches[cutter.id].verdict == alone.verdict).all()
        assert (result.reaches[cutter.id].reason == alone.reason).all()
    assert reasons(result.reaches[large.id]) == {"local_gouge"}


def test_the_reason_is_the_holder_where_the_fillet_itself_would_let_the_ball():
    """Curvature forbids every tilt by a hair, the holder does by much: a smaller ball would not help."""
    cutter = Cutter.ball(radius=0.5, length=1.2, holder=Holder((Segment(30.0, 20),)))
    result, reach = asked(fillet(0.4999, half=50.0, size=50.0), cutter, faces="1", spacing=5.0, grid=None)
    within = np.abs(result.samples.point[:, 1]) < 20
    assert (reach.verdict[within] == INACCESSIBLE).all()
    assert reasons(reach) == {"holder"}


def test_the_area_between_samples_is_served_where_the_tolerance_lets_it():
    """A flat end in a trough, at tilts a little less than curvature asks for: near the contact the surface rises into the cutter
    by what the tolerance leaves."""
    part, least = shapes.shell(shapes.trough(10.0, 6.0, 0.6)), math.asin(2.0 / 10.0)
    result = plan(part, cutters=[Cutter.flat(radius=2, length=30)], tolerance=TOLERANCE, spacing=0.3, area_budget=20_000,
                  tilt=(least - math.radians(0.3), least - math.radians(0.1)))  # fmt: skip
    (cutter,) = result.plan.cutters
    assert cutter.accessible == len(result.samples)
    assert cutter.area.share > 0.5


def test_upright_postures_alone():
    """The rule holds in ranges of postures, too."""
    assert PostureRange(tilt=(0.0, 0.0)).upright
    part = shapes.shell(shapes.trough(400.0, 30.0, 0.2))
    # A flat end across a wide trough: its rim is R^2 / (2 * 400) deep.
    for radius, verdict in ((1.0, ACCESSIBLE), (2.0, INACCESSIBLE)):
        deep = (2 * radius) ** 2 / (2 * 400)
        result, reach = asked(part, Cutter.flat(radius=radius, length=30), tilt=(0.0, 0.0), rotation=(0.0, 0.01))
        middle = np.abs(result.samples.point[:, 0]) < 20
        assert (reach.verdict[middle] == verdict).all(), deep
