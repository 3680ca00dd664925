"""How far a cutter keeps from what is around it, and how deep something lies in it: closed forms, and laws over setups."""

import math
from dataclasses import replace

import numpy as np
import pytest
from OCP.BRepPrimAPI import BRepPrimAPI_MakeCylinder
from OCP.gp import gp_Ax2, gp_Dir, gp_Pnt

from cad_io import read_part
from cad_io.tessellate import tessellate
from plan_cutters import Cutter, Options
from plan_cutters.domain.assembly import FINEST, SHARE
from plan_cutters.domain.verdicts import ACCESSIBLE, blank
from plan_cutters.kernels.codes import HOLDER
from plan_cutters.pipeline import prepare
from plan_cutters.scene.distances import clearances, clearances_over, deepest, deepest_of, deepest_on, least_clearance
from plan_cutters.scene.obstacles import Obstacles
from tests.support import shapes
from tests.support.cad_parts import ball, box, compound
from tests.support.two_setups import two


def upright(count, verdict=ACCESSIBLE):
    """Postures along z, the axis on the far side of x."""
    made = blank(count)
    made.verdict[:] = verdict
    made.axis[:], made.tilt_direction[:], made.tilt[:] = (0.0, 0.0, 1.0), (1.0, 0.0, 0.0), 0.0
    return made.freeze()


@pytest.mark.parametrize("gap", [0.0, 0.4, 3.0, 7.0])
def test_a_holder_beside_a_wall_keeps_what_is_between_them(gap):
    """A holder of radius 15 over a cutter of radius 4 whose axis stands 4 mm beside the contact; a wall that is a fixture."""
    wall = 11.0 + gap
    asked = {"cutters": "R4L30HR15L50", "faces": "all", "grid": 3, "area_budget": 0, "fixtures": f"box:9,200,90@{wall},-100,-3"}
    ready = prepare(shapes.shell(shapes.plane((-5, 5), (-5, 5))), Options.of(asked))
    [cutter] = ready.cutters
    row = int(np.linalg.norm(ready.samples.point, axis=1).argmin())
    postures = upright(len(ready.samples))
    mine = replace(postures, verdict=np.where(np.arange(len(ready.samples)) == row, ACCESSIBLE, 0).astype(np.uint8))
    found = clearances(ready.samples, cutter, mine, ready.conditions)
    assert found.distance[row] <= gap
    assert found.distance[row] >= min(gap - FINEST - 1e-3, gap / (1.0 + SHARE) - 1e-3)
    assert (found.face[row], found.part[row]) == (-1, HOLDER)
    others = np.arange(len(ready.samples)) != row
    assert np.isnan(found.distance[others]).all()
    assert (found.face[others] == 0).all()
    assert (found.part[others] == -1).all()
    # The least over all postures is the least of them, with fewer looks.
    every = clearances(ready.samples, cutter, postures, ready.conditions)
    assert least_clearance(ready.samples, cutter, postures, ready.conditions) == every.distance.min()
    assert least_clearance(ready.samples, cutter, mine, ready.conditions) == found.distance[row]


@pytest.mark.parametrize("turn", [0.0, 0.37, 1.9, 4.4])
@pytest.mark.parametrize("gap", [0.7, 2.3])
def test_a_holder_beside_a_ball_keeps_no_more_than_what_is_between_them(gap, turn):
    """Triangles lie within a ball, by up to their chord error: the clearance is that of the ball, not that of its triangles."""
    radius = 11.0
    away = 15.0 + gap + radius
    floor = shapes.plane((-5, 5), (-5, 5))
    round_ = ball(radius, (-4.0 + away * math.cos(turn), away * math.sin(turn), 60.0))
    asked = {"cutters": "R4L30HR15L50", "faces": "1", "grid": 3, "area_budget": 0, "tolerance": 0.9}
    ready = prepare(compound(floor, round_), Options.of(asked))
    [cutter] = ready.cutters
    row = int(np.linalg.norm(ready.samples.point, axis=1).argmin())
    assert np.linalg.norm(ready.samples.point[row]) < 1e-9
    assert ready.conditions.obstacles.triangles.chord_error > 0.05
    made = upright(len(ready.samples))
    mine = replace(made, verdict=np.where(np.arange(len(ready.samples)) == row, ACCESSIBLE, 0).astype(np.uint8))
    found = clearances(ready.samples, cutter, mine, ready.conditions)
    assert 0.0 < found.distance[row] <= gap
    assert found.part[row] == HOLDER


def test_of_nothing_that_is_reached_no_clearance_is_known():
    ready = prepare(box(), Options.of({"cutters": "R4L30HR15L50", "faces": "all", "grid": 3, "area_budget": 0}))
    [cutter], n = ready.cutters, len(ready.samples)
    none = blank(n).freeze()
    assert np.isnan(clearances(ready.samples, cutter, none, ready.conditions).distance).all()
    assert math.isnan(least_clearance(ready.samples, cutter, none, ready.conditions))
    # Nor of a bare cutter that is no longer than it is wide.
    short = Cutter.flat(radius=4.0, length=8.0)
    assert math.isnan(least_clearance(ready.samples, short, upright(n), ready.conditions))


def test_each_posture_keeps_clear_of_what_stands_in_its_own_setup():
    """A fixture of the first setup has its number; one of another setup has none."""
    both = two(box(), cutters="R2L20HR4L30", grid=4)
    (name,) = both.reaches
    cutter, served = both.judged(name), both.served_in[name]
    setups = both.ready.setups
    whole = clearances_over(both.samples, cutter, both.reaches[name], setups, served)
    assert {0, 1} <= set(served.tolist())
    met = []
    for k, conditions in enumerate(setups):
        mine = served == k
        alone = clearances(both.samples, cutter, both.reaches[name], conditions)
        assert np.array_equal(whole.distance[mine], alone.distance[mine], equal_nan=True)
        assert np.array_equal(whole.part[mine], alone.part[mine])
        assert np.array_equal(whole.face[mine], alone.face[mine] if k == 0 else np.maximum(alone.face[mine], 0))
        met.append((alone.face[mine] < 0).any())
    assert all(met), "a fixture is what is nearest in both setups"
    assert np.isnan(whole.distance[served < 0]).all()
    # Where all setups have the same obstacles they count as one.
    one = clearances_over(both.samples, cutter, both.reaches[name], (setups[0], setups[0]), served)
    assert np.array_equal(one.face, clearances(both.samples, cutter, both.reaches[name], setups[0]).face)
    none = clearances_over(both.samples, cutter, both.reaches[name], setups, None)
    assert np.array_equal(none.face, one.face)


CONTACT, NORMAL = np.zeros(3), np.array([0.0, 0.0, 1.0])


@pytest.mark.parametrize("depth", [0.02, 0.5, 2.0])
@pytest.mark.parametrize("share", [0.3, 1.0, 4.0, 11.0])
def test_a_wall_lies_as_deep_in_a_flat_end_as_it_is_beyond_its_side(depth, share):
    """The axis stands at x = -4, the rim comes to 0: a block from x = -8 on the other side of it, up to there."""
    block = read_part(box(20, 40, 30, at=(-8 - 20 + depth, -20, 2)))
    around = Obstacles(tessellate(block, 0.01))
    found = deepest(block, around, Cutter.parse("R4L60"), CONTACT, NORMAL, upright(1), share * depth)
    assert found.depth == pytest.approx(depth, abs=2e-3)
    assert found.point[0] == pytest.approx(-8 + depth, abs=1e-6)
    assert np.hypot(found.point[0] + 4.0, found.point[1]) == pytest.approx(4.0 - depth, abs=2e-3)
    bare = deepest(None, around, Cutter.parse("R4L60"), CONTACT, NORMAL, upright(1), share * depth)
    assert bare.depth == pytest.approx(depth, abs=2e-3)


@pytest.mark.parametrize("chord", [0.01, 0.2])
def test_a_round_face_lies_as_deep_as_itself_not_as_its_triangles(chord):
    """A rod along y whose side comes to x = -8 + 1, behind a flat end as above: what is told is the point of the cylinder."""
    rod = read_part(BRepPrimAPI_MakeCylinder(gp_Ax2(gp_Pnt(-17.0, -15.0, 20.0), gp_Dir(0.0, 1.0, 0.0)), 10.0, 30.0).Shape())
    around = Obstacles(tessellate(rod, chord))
    found = deepest(rod, around, Cutter.parse("R4L60"), CONTACT, NORMAL, upright(1), 0.3)
    assert found.depth == pytest.approx(1.0, abs=5e-3)
    assert np.hypot(found.point[0] + 17.0, found.point[2] - 20.0) == pytest.approx(10.0, abs=1e-6)


def test_what_is_not_in_a_tool_has_no_depth():
    away = Obstacles(tessellate(read_part(box(20, 40, 30, at=(-30, -20, 2))), 0.01))
    assert deepest(None, away, Cutter.parse("R4L60"), CONTACT, NORMAL, upright(1), 1.0) is None


def test_nothing_can_lie_deeper_than_half_of_what_a_tool_is_thick():
    assert deepest_of(Cutter.parse("R4L60")) == pytest.approx(4.0)
    assert deepest_of(Cutter.parse("R4L6")) == pytest.approx(3.0)
    assert deepest_of(Cutter.parse("R4L30HR15L50")) == pytest.approx(15.0)
    assert deepest_of(Cutter.parse("R4L30HR15L20")) == pytest.approx(10.0)


def test_the_deepest_point_of_a_triangle_is_where_a_linear_or_round_depth_is_largest():
    rng = np.random.default_rng(3)
    for _ in range(20):
        triangle, way = rng.uniform(-5, 5, (3, 3)), rng.normal(size=3)
        found = deepest_on(triangle, lambda points, way=way: points @ way)
        assert found @ way == pytest.approx((triangle @ way).max(), abs=1e-6)
        share = rng.dirichlet(np.ones(3))
        foot = share @ triangle
        inside = deepest_on(triangle, lambda points, foot=foot: -np.linalg.norm(points - foot, axis=1))
        assert inside == pytest.approx(foot, abs=1e-2)
