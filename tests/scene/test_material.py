"""Material counts, not only its skin: bodies, voids and what is nearly closed let no cutter in."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from OCP.BRep import BRep_Builder, BRep_Tool
from OCP.BRepAlgoAPI import BRepAlgoAPI_Fuse
from OCP.BRepBuilderAPI import BRepBuilderAPI_Copy
from OCP.BRepPrimAPI import BRepPrimAPI_MakeTorus
from OCP.gp import gp_Ax2, gp_Dir, gp_Pnt, gp_Trsf, gp_Vec
from OCP.TopLoc import TopLoc_Location
from OCP.TopoDS import TopoDS_Shell, TopoDS_Solid
from scipy.ndimage import binary_erosion

from cad_io import read_part
from cad_io.arrays import Triangles
from cad_io.kernel import edges_of
from cad_io.kernel import faces as faces_of
from cad_io.part.bodies import bodies
from plan_cutters import Cutter, plan, posture_map
from plan_cutters.domain.verdicts import REASONS
from plan_cutters.kernels.material import far_inside, in_known_ball, keep_ball, outside, way_out, windings
from plan_cutters.scene.obstacles import Obstacles
from plan_cutters.scene.surroundings import surroundings
from tests.support import shapes
from tests.support.bodies import SMALL, judged, reached, stacked, within
from tests.support.cad_parts import ball, box, compound, cut


@settings(max_examples=60, deadline=None)
@given(face=st.lists(st.integers(-2, 5), min_size=1, max_size=30), numbers=st.sets(st.integers(-3, 7)))
def test_triangles_of_faces_are_found_as_by_looking_at_each(face, numbers):
    mine = np.array(face, np.int32)
    vertex = np.zeros((len(face), 3, 3))
    assert (
        Obstacles(Triangles(vertex, mine, 0.0, ())).rows_of(numbers).tolist()
        == np.flatnonzero(np.isin(mine, sorted(numbers))).tolist()
    )


def wavy(size=60.0):
    x, y = np.meshgrid(np.linspace(0, size, 8), np.linspace(0, size, 8), indexing="ij")
    z = 20 + 0.8 * np.sin(x / 9) * np.cos(y / 11)
    return shapes.Patch(np.stack([x, y, z], -1)).face()


def wavy_block(size=60.0):
    """A block whose top is a B-spline surface."""
    from OCP.BRepPrimAPI import BRepPrimAPI_MakePrism

    return BRepPrimAPI_MakePrism(wavy(size), gp_Vec(0, 0, -15)).Shape()


def test_nothing_is_reached_under_a_block_that_stands_on_another():
    result = judged(stacked(), grid=9)
    at, hit = result.samples.point, reached(result)
    top = (result.samples.face == 6) & (np.abs(at[:, 2] - 20) < 1e-6)
    under = top & (np.abs(at[:, :2] - 20) < 10 - 1e-6).all(axis=1)
    assert under.sum() == 9
    assert not hit[under].any()
    clear = top & ~(np.abs(at[:, :2] - 20) <= 10 + 1e-6).all(axis=1)
    assert hit[clear].all()
    # The bottom of the upper block lies on the lower one.
    assert not hit[result.samples.face == 11].any()
    entry = result.cutters[0]
    # Neither is surface of the finished part: the cutter reaches all of that.
    assert entry.feasible is True
    assert entry.inside_bodies == entry.by_reason["buried"] == 9 + 81
    witness = next(w for w in entry.witnesses if w.face == "F6" and w.reason == "buried")
    assert (witness.obstacle_face, witness.obstacle_point[2]) == ("F12", pytest.approx(80.0))


@pytest.mark.parametrize("radius", [0.5, 2.0, 20.0])
def test_no_cutter_reaches_the_wall_of_a_void(radius):
    hollow = cut(box(100, 100, 100), box(80, 80, 80, at=(10, 10, 10)))
    cutter = Cutter.flat(radius=radius, length=30)
    result = judged(hollow, cutter=cutter)
    inner = np.abs(result.samples.point - 50).max(axis=1) < 45
    assert inner.sum() == 6 * 25
    assert not reached(result)[inner].any()
    assert reached(result)[~inner].any()
    assert (result.reaches[cutter.id].reason[inner] == REASONS.index("buried")).all()


def test_a_clamp_on_a_wavy_top_covers_what_is_under_it():
    clamp = box(20, 20, 40, at=(20, 20, 15))
    result = plan(compound(wavy_block(), clamp), cutters=[SMALL], spacing=1.5, area_budget=0)
    at = result.samples.point
    top = at[:, 2] > 15
    under = top & (np.abs(at[:, :2] - 30) < 9.95).all(axis=1)
    assert under.sum() > 150
    assert not reached(result)[under].any()
    away = top & (np.abs(at[:, :2] - 30) > 15).any(axis=1)
    assert reached(result)[away].mean() > 0.5
    inside = result.plan.inside_other_bodies
    assert under.sum() <= inside.samples == result.inside_bodies.sum()
    # It stands with its foot in the wavy top.
    assert [(each.faces, each.how) for each in inside.bodies if not each.largest] == [(["F5"], "overlaps")]


def test_touching_overlapping_and_repeated_bodies():
    apart = judged(box(40, 40, 20))
    for shape in (compound(box(40, 40, 20), box(40, 40, 20)), compound(box(40, 40, 20), box(40, 20, 10, at=(0, 10, 5)))):
        result = judged(shape)
        mine = result.samples.face <= 6
        # The same body twice, and one within it, cover nothing of its outside.
        assert (reached(result)[mine] == reached(apart)).all()
    inner = judged(compound(box(40, 40, 20), box(30, 30, 10, at=(5, 5, 5))))
    assert not reached(inner)[inner.samples.face > 6].any()
    # Side by side: the wall between is not reached from either side, but for its rim.
    beside = judged(compound(box(40, 40, 20), box(40, 40, 20, at=(40, 0, 0))))
    wall = (np.abs(beside.samples.point[:, 0] - 40) < 1e-9) & (np.abs(beside.samples.point[:, 1:] - (20, 10)) < (19, 9)).all(
        axis=1
    )
    assert wall.sum() == 18
    assert not reached(beside)[wall].any()
    # Fused, there is no such wall.
    fused = BRepAlgoAPI_Fuse(box(40, 40, 20), box(40, 40, 20, at=(40, 0, 0))).Shape()
    assert reached(judged(fused)).all()


def test_nested_shells_are_all_closed_off():
    """A block with a void in which another block with a void floats."""
    outer = cut(box(100, 100, 100), box(80, 80, 80, at=(10, 10, 10)))
    inner = cut(box(40, 40, 40, at=(30, 30, 30)), box(20, 20, 20, at=(40, 40, 40)))
    part = read_part(compound(outer, inner))
    assert sorted(len(b.faces) for b in bodies(part)) == [6, 6, 6, 6]
    result = judged(part, cutter=Cutter.flat(radius=0.5, length=5))
    outside = (np.abs(result.samples.point - 50) > 49.9).any(axis=1)
    assert reached(result)[outside].all()
    assert not reached(result)[~outside].any()
    assert (~outside).sum() == 3 * 150


def test_a_block_that_is_turned_inside_out_or_mirrored_still_covers():
    mirror = gp_Trsf()
    mirror.SetScaleFactor(-1.0)
    for upper in (box(20, 20, 60, at=(10, 10, 20)).Reversed(),
                  box(20, 20, 60, at=(-30, -30, -80)).Moved(TopLoc_Location(mirror), False)):  # fmt: skip
        result = judged(compound(box(40, 40, 20), upper), grid=9)
        at = result.samples.point
        under = (np.abs(at[:, 2] - 20) < 1e-6) & (np.abs(at[:, :2] - 20) < 9).all(axis=1) & (result.samples.face == 6)
        assert under.any()
        assert not reached(result)[under].any()


def test_maps_leave_bodies_out():
    result = judged(stacked(), grid=9, posture_maps=True, rotation_step=math.pi / 6)
    k = len(result.maps.rotations)
    found = np.add.reduceat(np.append(np.diff(result.maps.offset), 0), np.arange(0, k * len(result.samples), k))
    not_reached = result.reaches[SMALL.id].verdict == 0
    assert not_reached.any()
    assert (found[not_reached] == 0).all()
    assert (found[reached(result)] > 0).all()
    part = read_part(stacked())
    turns = np.radians([0.0, 40.0, 200.0])
    # 15 mm deep under the upper block, which the cutter does not leave anywhere.
    inside = posture_map(part, point=(20, 20, 20), cutter=Cutter.flat(radius=2, length=8), rotations=turns)
    outside = posture_map(part, point=(5, 5, 20), cutter=Cutter.flat(radius=2, length=8), rotations=turns)
    assert all(len(tilts) == 0 for tilts in inside.free)
    assert all(len(tilts) for tilts in outside.free)
    assert any(len(tilts) for tilts in inside.buried)
    assert not any(len(tilts) for tilts in outside.buried)


def test_at_the_foot_of_a_wall_only_postures_outside_it_count():
    """At the foot of the upper block's side, a cutter small enough lies wholly within the block at some postures."""
    part = read_part(compound(box(80, 80, 20), box(40, 40, 60, at=(20, 20, 20))))
    cutter = Cutter.flat(radius=2, length=12)
    # Contact on the edge between the two, in the middle of the side at x = 20; the wall is towards +x.
    found = posture_map(part, point=(20, 40, 20), cutter=cutter, rotations=np.arange(24) * math.pi / 12)
    points = np.array([1.0, 3.0, 6.0, 11.0])
    seen = 0
    for i in range(24):
        for tilt in np.concatenate([np.linspace(*ends, 7) for ends in found.free[i]] or [[]]):
            axis = found.axis(i, tilt)
            tilt_direction = found.axis(i, math.pi / 2)
            middle = found.point - 2 * (math.cos(tilt) * tilt_direction - math.sin(tilt) * found.normal) + points[:, None] * axis
            # Not one point of the cutter's axis is in the wall by more than the tolerance.
            assert not ((middle[:, 0] > 20.011) & (middle[:, 2] > 20.011)).any()
            seen += 1
    assert seen > 10
    assert sum(len(tilts) for tilts in found.buried) > 0


def test_loose_surfaces_are_said_to_enclose_nothing():
    lid = shapes.plane((0, 40), (0, 40), origin=(0, 0, 60))
    result = judged(compound(box(40, 40, 20), lid))
    assert any("F7 encloses no material" in note for note in result.plan.notes)
    assert bodies(read_part(lid)) == ()


def test_surfaces_that_lie_on_a_solid_are_named():
    on_top = shapes.plane((5, 30), (5, 30), origin=(0, 0, 20))
    above = shapes.plane((5, 30), (5, 30), origin=(0, 0, 21))
    result = judged(compound(box(40, 40, 20), on_top, above))
    (warning,) = [w for w in result.plan.part.warnings if "construction geometry" in w]
    assert warning.startswith("F7 ")
    assert "--ignore" in warning
    # It hides nothing: both sides of it are seen as before.
    alone = judged(compound(box(40, 40, 20), above))
    assert (reached(result)[result.samples.face <= 6] == reached(alone)[alone.samples.face <= 6]).all()


def test_a_solid_with_a_hole_in_its_skin_encloses_perhaps():
    """A body that lost a face is no longer closed: what may lie within it is undecided, never reached."""
    upper, builder, open_shell = box(20, 20, 60, at=(10, 10, 20)), BRep_Builder(), TopoDS_Shell()
    builder.MakeShell(open_shell)
    for face in faces_of(upper)[:5]:  # without its top
        builder.Add(open_shell, face)
    solid = TopoDS_Solid()
    builder.MakeSolid(solid)
    builder.Add(solid, open_shell)
    result = judged(compound(box(40, 40, 20), solid), grid=9, cutter=Cutter.flat(radius=2, length=10))
    at = result.samples.point
    under = (np.abs(at[:, 2] - 20) < 1e-6) & (np.abs(at[:, :2] - 20) < 9).all(axis=1) & (result.samples.face == 6)
    assert under.any()
    assert not reached(result)[under].any()
    assert [b.closed for b in bodies(result.part)].count(False) == 1


def loose(*solids):
    """Faces of solids, each by itself: what IGES and surface models hold."""
    return compound(*(BRepBuilderAPI_Copy(face).Shape() for solid in solids for face in faces_of(solid)))


def solid_of(some):
    """A solid of just these faces."""
    builder, shell, solid = BRep_Builder(), TopoDS_Shell(), TopoDS_Solid()
    builder.MakeShell(shell)
    for face in some:
        builder.Add(shell, face)
    builder.MakeSolid(solid)
    builder.Add(solid, shell)
    return solid


BASE, CLAMP = ((0, 0, 0), (80, 80, 20)), ((30, 0, 20), (50, 80, 60))


@pytest.mark.slow("searches long", only=("same", "side"))
@pytest.mark.parametrize(
    ("low", "size"),
    [((30, 0, 20), (20, 80, 40)), ((0, 0, 20), (20, 20, 60)), ((0, 0, 20), (80, 80, 40)), ((80, 0, 0), (40, 80, 20))],
    ids=["across, flush on both sides", "flush with a corner", "same footprint", "side by side"],
)
def test_bodies_of_loose_faces_that_touch_are_told_apart(low, size):
    """Joining faces edge to edge must not turn one body inside out because the edges of another lie there."""
    high = np.add(low, size)
    result = judged(loose(box(80, 80, 20), box(*size, at=low)), grid=5, cutter=Cutter.flat(radius=2, length=12))
    assert reached(result).sum() > 80
    assert within(result, *BASE) == []
    assert within(result, low, high) == []


def test_the_same_loose_block_twice_encloses_once():
    twice = loose(box(40, 40, 20, at=(0, 0, 20)), box(40, 40, 20, at=(0, 0, 20)))
    sheet = shapes.plane((0, 60), (0, 60), origin=(0, 0, 20))
    result = judged(compound(sheet, twice), faces="1", grid=9, cutter=Cutter.flat(radius=2, length=12))
    assert within(result, (0, 0, 20), (40, 40, 40)) == []
    assert reached(result).any()


@pytest.mark.parametrize("missing", range(6))
@pytest.mark.parametrize("at", [(10, 10, 100), (40, 10, 100)], ids=["on the part", "beside its middle"])
def test_a_solid_that_lacks_a_face_lets_no_cutter_in(missing, at):
    """Wherever the part's middle is, and also where the cutter leans out of the hole."""
    kept = [face for i, face in enumerate(faces_of(box(20, 20, 30, at=at))) if i != missing]
    whole = compound(box(80, 40, 100), solid_of(kept))
    result = judged(whole, faces="6", grid=9, cutter=Cutter.flat(radius=2, length=40))
    assert within(result, at, np.add(at, (20, 20, 30))) == []
    assert result.cutters[0].feasible is not True
    assert reached(result).any()


def test_a_solid_whose_faces_share_no_edges_encloses():
    block = solid_of([BRepBuilderAPI_Copy(face).Shape() for face in faces_of(box(20, 20, 30, at=(10, 10, 20)))])
    result = judged(compound(box(60, 60, 20), block), faces="6", grid=13, cutter=Cutter.flat(radius=2, length=12))
    assert within(result, (10, 10, 20), (30, 30, 50)) == []
    assert reached(result).any()


def test_an_ignored_face_of_a_solid_is_no_way_in():
    part = compound(box(60, 60, 20), box(20, 20, 60, at=(10, 10, 20)))
    result = judged(part, faces="6", ignore="7", grid=13, cutter=Cutter.flat(radius=2, length=30))
    assert within(result, (10, 10, 20), (30, 30, 80)) == []
    gone = judged(part, faces="6", ignore="7-12", grid=13, cutter=Cutter.flat(radius=2, length=30))
    assert reached(gone).all()


@pytest.mark.parametrize("gap", [0.9, 1.5])
def test_a_gap_that_edges_are_loose_enough_for_is_no_way_in(gap):
    """The top's plane lies above its border; its edges say so."""
    clamp = box(20, 20, 40, at=(10, 10, 10))
    top, builder = faces_of(clamp)[5], BRep_Builder()
    up = gp_Trsf()
    up.SetTranslation(gp_Vec(0, 0, gap))
    builder.UpdateFace(top, BRep_Tool.Surface_s(top).Transformed(up), TopLoc_Location(), 1e-7)
    for edge in edges_of(top):
        builder.UpdateEdge(edge, 1.01 * gap)
    result = judged(compound(box(40, 40, 10), clamp), faces="6", grid=9, cutter=Cutter.flat(radius=3, length=8))
    assert within(result, (10, 10, 10), (30, 30, 50)) == []
    assert reached(result).any()


# --- the numbers behind it ------------------------------------------------------------------------------------------------


def solids_of(shape, chord=0.05):
    return surroundings(read_part(shape), chord)


def exact_winding(points, triangles, weight):
    """Sum of solid angles over 4 pi, triangle by triangle, by another formula (Oosterom by complex numbers)."""
    total = np.zeros(len(points))
    for v, w in zip(triangles, weight, strict=True):
        a, b, c = (v[k] - points for k in range(3))
        la, lb, lc = (np.linalg.norm(x, axis=1) for x in (a, b, c))
        top = np.einsum("ij,ij->i", a, np.cross(b, c))
        low = la * lb * lc + (a * b).sum(1) * lc + (b * c).sum(1) * la + (c * a).sum(1) * lb
        total += w * np.angle(low + 1j * top) * 2
    return total / (4 * np.pi)


def test_winding_numbers_are_those_of_the_sum():
    around = solids_of(
        compound(ball(10), box(8, 8, 30, at=(3, -4, -5)), cut(box(60, 60, 20, at=(-30, -30, -30)), ball(5, at=(0, 0, -20))))
    )
    assert around.possible is around.certain
    rng = np.random.default_rng(5)
    points = rng.uniform(-35, 35, (400, 3))
    found = np.empty(400)
    windings(points, around.certain.solids, found)
    exact = exact_winding(points, around.certain.triangles.vertex, around.certain.weight)
    known = np.round(exact)
    assert np.abs(exact - known).max() < 0.02
    assert {0, 1, 2} <= set(known.astype(int).tolist())
    assert np.abs(found - known).max() < 0.1
    # What the cells say for sure is so.
    cells_off = around.certain.solids._replace(cell=np.zeros_like(around.certain.solids.cell))
    without = np.empty(400)
    windings(points, cells_off, without)
    assert np.abs(without - known).max() < 0.1
    assert (found == 0).sum() > (without == 0).sum()


def test_a_way_out_leads_from_no_body():
    """Beside, in and between bodies: only from where the exact sum is 0, and where cells do not tell, too."""
    around = solids_of(
        compound(ball(10), box(8, 8, 30, at=(3, -4, -5)), cut(box(60, 60, 20, at=(-30, -30, -30)), ball(5, at=(0, 0, -10))))
    )
    solids, rng = around.certain.solids, np.random.default_rng(7)
    # As about a part of some metres: what is near a skin is in no cell that is outside.
    solids = solids._replace(cell=binary_erosion(solids.cell, iterations=5, border_value=1).astype(np.uint8))
    points = np.concatenate([rng.uniform(-35, 35, (600, 3)), rng.normal((0, 0, -12), 1.5, (200, 3))])
    way = rng.normal(size=(800, 3))
    way /= np.linalg.norm(way, axis=1)[:, None]
    stack, exact = np.empty(64, np.int64), exact_winding(points, around.certain.triangles.vertex, around.certain.weight)
    leads = np.array([way_out(*p, *d, solids, stack) for p, d in zip(points, way, strict=True)])
    told = np.array([outside(*p, solids) for p in points])
    assert (np.abs(exact[leads]) < 0.05).all()
    assert (leads & ~told).sum() > 20
    assert (~leads & (np.abs(exact) < 0.05)).any()
    # Skins that are not closed let nothing out, and neither do those that may be off by more than there is room.
    for other in (np.nan, 20.0):
        assert not any(way_out(*p, *d, solids._replace(grow=other), stack) for p, d in zip(points[600:], way[600:], strict=True))


@pytest.mark.parametrize("lacking", [None, 0, 3, 5])
def test_points_near_one_that_lies_in_a_body_do(lacking):
    """In a closed box, and in one that lacks a face, up to its opening and beyond it."""
    kept = [face for i, face in enumerate(faces_of(box(20, 20, 30))) if i != lacking]
    around = solids_of(box(20, 20, 30) if lacking is None else solid_of(kept))
    obstacles, rng = around.possible, np.random.default_rng(3)
    solids = obstacles.solids
    assert np.isfinite(solids.grow) == (lacking is None)
    points = rng.uniform((-8, -8, -8), (28, 28, 38), (400, 3))
    exact = np.abs(exact_winding(points, obstacles.triangles.vertex, obstacles.weight))
    stack, told = np.empty(64, np.int64), 0
    for least in (0.25, 0.75):
        for i in np.flatnonzero(exact >= least)[:60].tolist():
            balls, stored = np.empty((4, 5)), np.zeros(2, np.int64)
            keep_ball(*points[i], exact[i], solids, balls, stored, stack)
            near = points[i] + rng.normal(size=(60, 3)) * rng.uniform(0.0, 2.0, (60, 1))
            flagged = np.array([in_known_ball(*p, solids, least, balls, stored) for p in near])
            told += flagged.sum()
            assert (np.abs(exact_winding(near[flagged], obstacles.triangles.vertex, obstacles.weight)) >= least).all()
            assert not any(in_known_ball(*p, solids._replace(key=-1), least, balls, stored) for p in near)
    assert told > 100


def test_void_and_material_count_alike():
    hollow = solids_of(cut(box(100, 100, 100), box(80, 80, 80, at=(10, 10, 10))))
    found = np.empty(3)
    windings(np.array([[50.0, 50, 50], [5, 50, 50], [-5, 50, 50]]), hollow.certain.solids, found)
    assert found == pytest.approx([2, 1, 0], abs=0.05)


@given(st.integers(0, 10_000))
@settings(max_examples=30, deadline=None)
def test_a_ball_far_inside_is_inside(seed):
    """Against the distance from a sphere's and a box's skin in closed form."""
    rng = np.random.default_rng(seed)
    points = rng.uniform(-12, 12, (60, 3))
    around = _ball_solids()
    clear = float(rng.uniform(0.2, 4))
    found = np.zeros(60, bool)
    far_inside(points, clear, around.certain.solids, found)
    depth = 10 - np.linalg.norm(points, axis=1)
    error = around.certain.triangles.chord_error
    sure = np.abs(depth - clear) > error + 1e-9
    assert (found == (depth > clear))[sure].all()


def _ball_solids(cache=[]):  # noqa: B006 (made once)
    if not cache:
        cache.append(solids_of(ball(10)))
    return cache[0]


def test_no_cutter_floats_where_a_shell_crosses_itself():
    """Two tori whose faces make one shell: what lies within the other is no surface, however short the cutter is."""
    first = BRepPrimAPI_MakeTorus(gp_Ax2(gp_Pnt(0, 0, 0), gp_Dir(0, 0, 1)), 20, 6).Shape()
    second = BRepPrimAPI_MakeTorus(gp_Ax2(gp_Pnt(4, 0, 0), gp_Dir(0, 1, 0)), 20, 5).Shape()
    builder, shell, solid = BRep_Builder(), TopoDS_Shell(), TopoDS_Solid()
    builder.MakeShell(shell)
    builder.MakeSolid(solid)
    for face in (*faces_of(first), *faces_of(second)):
        builder.Add(shell, face)
    builder.Add(solid, shell)
    result = judged(solid, cutter=Cutter.flat(radius=1, length=2), grid=16)
    x, y, z = result.samples.point.T
    in_first = np.hypot(np.hypot(x, y) - 20, z) < 6 - 0.1
    in_second = np.hypot(np.hypot(x - 4, z) - 20, y) < 5 - 0.1
    assert (in_first | in_second).sum() > 5
    assert not reached(result)[in_first | in_second].any()
