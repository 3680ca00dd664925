"""What triangles of a face begin with: of our own, which never hang; the kernel's mesher second, which may, and is ended."""

import math
import time
from itertools import pairwise

import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st
from OCP.BRep import BRep_Builder, BRep_Tool
from OCP.BRepBuilderAPI import (
    BRepBuilderAPI_MakeEdge,
    BRepBuilderAPI_MakeFace,
    BRepBuilderAPI_MakePolygon,
    BRepBuilderAPI_MakeWire,
)
from OCP.BRepLib import BRepLib
from OCP.GCE2d import GCE2d_MakeSegment
from OCP.Geom import Geom_BSplineSurface
from OCP.Geom2d import Geom2d_Circle
from OCP.gp import gp_Ax22d, gp_Dir2d, gp_Pln, gp_Pnt, gp_Pnt2d
from OCP.IGESControl import IGESControl_Writer
from OCP.TColgp import TColgp_Array2OfPnt
from OCP.TColStd import TColStd_Array1OfInteger, TColStd_Array1OfReal
from OCP.TopLoc import TopLoc_Location
from OCP.TopoDS import TopoDS

from cad_io import read_part
from cad_io.kernel import faces, values
from cad_io.tessellate import mesh, start, tessellate
from cad_io.tessellate.planar import bounded_by, odd, triangulated
from tests.support.cad_parts import SHAPES, as_nurbs, ball, box, compound, patch, pocketed, real, ring, spring
from tests.support.distances import ROUNDING, farthest, farthest_from
from tests.support.splines import array


def never(*_):
    while True:
        pass


def no_kernel(*_):
    raise AssertionError("left to the kernel's mesher")


# --- in the plane -----------------------------------------------------------------------------------------------------------


def loop(*points):
    """Nodes and chords of closed lines of points."""
    starts = np.cumsum([0, *map(len, points)])
    chords = [
        np.stack([np.arange(n), np.roll(np.arange(n), -1)], axis=1) + s
        for n, s in zip(map(len, points), starts[:-1], strict=True)
    ]
    return np.concatenate(points).astype(float), np.concatenate(chords).astype(np.int32)


def star(rng, count, centre=(0.0, 0.0), least=0.6, most=1.0):
    """A line around a centre that sees all of it."""
    angle = 2 * np.pi * (np.arange(count) + 0.9 * rng.random(count)) / count
    radius = rng.uniform(least, most, count)
    return np.array(centre) + radius[:, None] * np.stack([np.cos(angle), np.sin(angle)], axis=1)


def shoelace(points):
    x, y = points.T
    return 0.5 * abs((x * np.roll(y, -1) - y * np.roll(x, -1)).sum())


def areas(uv, corner):
    a, b = (uv[corner[:, k]] - uv[corner[:, 0]] for k in (1, 2))
    return 0.5 * (a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0])


@settings(max_examples=40, deadline=None)
@given(st.integers(0, 10**6), st.integers(3, 40), st.integers(0, 3), st.integers(1, 30), st.integers(1, 30))
def test_triangles_fill_a_region_and_nothing_else(seed, count, holes, wide, high):
    rng = np.random.default_rng(seed)
    outer = star(rng, count)
    if count < 6:
        holes = 0
    places = [(0.25 * np.cos(a), 0.25 * np.sin(a)) for a in (0.0, 2.1, 4.2)]
    inner = [star(rng, 9, place, 0.03, 0.12)[:: rng.choice([-1, 1])] for place in places[:holes]]
    uv, chords = loop(outer, *inner)
    lines = tuple(np.linspace(uv[:, k].min(), uv[:, k].max(), n + 1) for k, n in ((0, wide), (1, high)))
    found = triangulated(uv, chords, lines, np.array([1.0, rng.choice([0.01, 1.0, 300.0])]))
    whole = shoelace(outer) - sum(map(shoelace, inner))
    assert found is not None
    assert (areas(*found) >= 0).all()
    assert areas(*found).sum() == pytest.approx(whole, rel=1e-9)
    assert (found[0][: len(uv)] == uv).all()


BOW = np.array([(0, 0), (1, 1), (1, 0), (0, 1)])
SQUARE = np.array([(0, 0), (1, 0), (1, 1), (0, 1)])


@pytest.mark.parametrize("points", [BOW, SQUARE[[0, 1]], np.array([(0, 0), (1, 0), (0.5, 0)])], ids=["crosses", "line", "flat"])
def test_what_encloses_nothing_or_crosses_is_refused(points):
    assert triangulated(*loop(points), (np.array([0.0, 1.0]),) * 2, np.ones(2)) is None


def test_a_border_that_is_open_is_refused():
    uv, chords = loop(SQUARE)
    assert triangulated(uv, chords[:3], (np.array([0.0, 1.0]),) * 2, np.ones(2)) is None


def test_loops_that_cross_each_other_are_refused():
    assert triangulated(*loop(SQUARE, SQUARE + 0.5), (np.array([0.0, 1.0]),) * 2, np.ones(2)) is None


def test_a_triangle_missing_or_twice_is_seen():
    uv, chords = loop(star(np.random.default_rng(3), 20))
    _, corner = triangulated(uv, chords, (np.array([-1.0, 1.0]),) * 2, np.ones(2))
    assert bounded_by(corner, odd(chords))
    for k in range(len(corner)):
        assert not bounded_by(np.delete(corner, k, axis=0), odd(chords))
        assert not bounded_by(np.append(corner, corner[k : k + 1], axis=0), odd(chords))


def test_a_cut_into_the_region_bounds_nothing():
    """As the two sides of a seam that lie on each other."""
    uv = np.array([(0, 0), (1, 0), (1, 1), (0, 1), (0.5, 0.5)], float)
    chords = np.array([(0, 4), (4, 0), (0, 1), (1, 2), (2, 3), (3, 0)], np.int32)
    found = triangulated(uv, chords, (np.array([0.0, 1.0]),) * 2, np.ones(2))
    assert found is not None
    assert areas(*found).sum() == pytest.approx(1.0)


@pytest.mark.parametrize("wide", [(0.1, 0.01), (0.01, 0.1)])
@pytest.mark.parametrize("beside", [0.25, 0.35])
def test_cells_stay_three_tenths_of_their_width_away_from_the_border(wide, beside):
    uv, chords = loop(SQUARE)
    lines = tuple(np.arange(beside * width, 1.0 - 0.05 * width, width) for width in wide)
    found, _ = triangulated(uv, chords, lines, np.ones(2))
    # At the far end it is the rest of a cell that they stay away.
    near = [line if beside > 0.3 else line[1:] for line in lines]
    near = [line[line < 1.0 - 0.3 * width] for line, width in zip(near, wide, strict=True)]
    grid = np.stack([each.ravel() for each in np.meshgrid(*near, indexing="ij")], axis=1)
    assert len(grid) > 100
    assert found[len(uv) :] == pytest.approx(grid)


# --- faces ------------------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("make", SHAPES.values(), ids=SHAPES.keys())
def test_the_usual_needs_no_mesher(make, monkeypatch):
    monkeypatch.setattr(start, "kernel_start", no_kernel)
    part = read_part(make())
    assert not tessellate(part, 0.1).missing


@pytest.mark.slow("another file of the same law", but=("asitus",))
@pytest.mark.parametrize(
    "path", real("asitus_control_arm.step", "occt_linkrods.step", "axom_boxed_sphere.step"), ids=lambda p: p.name
)
def test_real_files_need_no_mesher(path, monkeypatch):
    monkeypatch.setattr(start, "kernel_start", no_kernel)
    part = read_part(path)
    assert not tessellate(part, 1e-3 * float(np.linalg.norm(part.size))).missing


#: Circles in the unit square of parameters: centre and radius.
circles = st.lists(st.tuples(st.floats(0.05, 0.95), st.floats(0.05, 0.95), st.floats(0.004, 0.3)), max_size=4)


def lies_apart(found, gap=1e-5):
    """Those that neither leave the square nor come nearer than a gap to others."""
    kept = []
    for x, y, r in found:
        inside = min(x, y, 1 - x, 1 - y) > r + gap
        if inside and all(math.hypot(x - a, y - b) > r + s + gap for a, b, s in kept):
            kept.append((x, y, r))
    return kept


def trimmed(surface, outer, holes):
    """A face within a polygon of shares of the parameters, with round holes there."""
    u0, u1, v0, v1 = surface.Bounds()
    wide = u1 - u0

    def wire(curves):
        made = BRepBuilderAPI_MakeWire()
        for curve in curves:
            made.Add(BRepBuilderAPI_MakeEdge(curve, surface).Edge())
        return made.Wire()

    at = [gp_Pnt2d(u0 + x * wide, v0 + y * (v1 - v0)) for x, y in outer]
    sides = [GCE2d_MakeSegment(a, b).Value() for a, b in pairwise([*at, at[0]])]
    face = BRepBuilderAPI_MakeFace(surface, wire(sides), True)
    for x, y, r in holes:
        axes = gp_Ax22d(gp_Pnt2d(u0 + x * wide, v0 + y * (v1 - v0)), gp_Dir2d(1, 0), gp_Dir2d(0, -1))
        face.Add(wire([Geom2d_Circle(axes, r * wide)]))
    BRepLib.BuildCurves3d_s(face.Face())
    return face.Face()


SKEW = ((0.0, 0.0), (1.0, 0.1), (0.9, 1.0), (0.55, 0.5), (0.1, 0.95))


def within(polygon, x, y):
    """By the even-odd rule."""
    inside = np.zeros(len(x), bool)
    for (a, b), (c, d) in pairwise([*polygon, polygon[0]]):
        if b != d:
            inside ^= ((b > y) != (d > y)) & (x < a + (y - b) / (d - b) * (c - a))
    return inside


@settings(max_examples=12, deadline=None)
@given(circles, st.integers(1, 5), st.sampled_from([((0, 0), (1, 0), (1, 1), (0, 1)), SKEW]))
def test_trimmed_surfaces_are_covered(holes, seed, outer):
    surface = BRep_Tool.Surface_s(patch(seed))
    holes = [
        h
        for h in lies_apart(holes)
        if outer is not SKEW or (h[1] + h[2] < 0.45 and 0.1 < h[0] - h[2] < h[0] + h[2] < 0.9 and h[1] - h[2] > 0.1)
    ]
    part = read_part(trimmed(surface, outer, holes))
    found = start.own_start(part, 1, 0.5)
    assert found is not None, "a valid border needs no mesher"
    triangles = tessellate(part, 0.03)
    assert not triangles.missing
    rng = np.random.default_rng(0)
    # Half of the points stand right beside holes, where a hole in the cover would be.
    x, y = rng.random((2, 600))
    for a, b, r in holes:
        angle = 2 * np.pi * rng.random(60)
        x, y = np.append(x, a + 1.0001 * r * np.cos(angle)), np.append(y, b + 1.0001 * r * np.sin(angle))
    inside = within(outer, x, y)
    for a, b, r in holes:
        inside &= np.hypot(x - a, y - b) > r
    u0, u1, v0, v1 = surface.Bounds()
    points = values(part.adaptor(1), u0 + x[inside] * (u1 - u0), v0 + y[inside] * (v1 - v0))
    assert farthest_from(points, triangles.vertex, triangles.chord_error + ROUNDING) <= triangles.chord_error + ROUNDING


def bent_in_places(along):
    """A patch over a rectangle of parameters that is straight one way, and the other way flat but for its last part."""
    pole = np.zeros((8, 2, 3))
    pole[..., 0], pole[..., 1] = np.array([6, 7, 9, 12, 15, 18, 20, 21])[:, None] / 3, np.array([0.0, 5.0])
    pole[:, :, 2] = np.array([0, 0, 0, 0, 0, 3, -3, 3.0])[:, None]
    knots, times = [[2.0, 3.0, 4.0, 5.0, 6.0, 7.0], [-9.0, -7.0]], [[4, 1, 1, 1, 1, 4], [2, 2]]
    way = (0, 1) if along == 0 else (1, 0)
    more = [array(kind, each[k]) for kind, each in ((TColStd_Array1OfReal, knots), (TColStd_Array1OfInteger, times)) for k in way]
    surface = Geom_BSplineSurface(array(TColgp_Array2OfPnt, pole.swapaxes(0, along), 3), *more, *((3, 1)[k] for k in way))
    return BRepBuilderAPI_MakeFace(surface, 1e-6).Face()


def test_lines_are_near_to_each_other_where_the_surface_bends():
    """Whichever way the surface is bent, along u or along v."""
    one, other = (start.own_start(read_part(bent_in_places(along)), 1, 0.02).uv for along in (0, 1))
    lines = np.unique(one[:, 0])
    assert lines == pytest.approx(np.unique(other[:, 1]))
    assert set(one[:, 1]) == set(other[:, 0]) == {-9.0, -7.0}
    # It is flat as far as 4: its first five poles lie in a line.
    assert (lines < 4.0).sum() < 0.1 * (lines > 4.0).sum()


@pytest.mark.parametrize("corner", [(-5.0, -5.0), (3.0, -8.0)])
@pytest.mark.parametrize("pieces", [1, 3, 40])
def test_a_rectangle_has_its_border_at_its_sides(corner, pieces):
    """Also where a side is of more edges than there are lines of a grid: then it takes no grid."""
    (u, v), size = corner, 10.0
    sides = [(u + k * size / pieces, v) for k in range(pieces)] + [(u + size, v), (u + size, v + size), (u, v + size)]
    wire = BRepBuilderAPI_MakePolygon()
    for x, y in sides:
        wire.Add(gp_Pnt(x, y, 0))
    wire.Close()
    mesh = start.own_start(read_part(BRepBuilderAPI_MakeFace(gp_Pln(), wire.Wire()).Face()), 1, 0.1)
    assert {tuple(each) for each in np.round(mesh.uv, 9)} >= {tuple(each) for each in np.round(sides, 9)}
    for border in mesh.border:
        on = [border.curve.Value(t).Coord() for t in border.parameter.tolist()]
        assert mesh.uv[border.nodes] == pytest.approx(np.array(on), abs=1e-9)
    assert (areas(mesh.uv, mesh.corner) > 0).all()
    assert areas(mesh.uv, mesh.corner).sum() == pytest.approx(size * size)
    if pieces < 40:
        # Nodes of a grid alone.
        assert len(mesh.uv) == len(np.unique(mesh.uv[:, 0])) * len(np.unique(mesh.uv[:, 1]))


def test_holes_that_nearly_touch_are_seen_apart():
    """Their chords cross each other at first."""
    holes = [(0.3, 0.5, 0.1), (0.3 + 0.2 + 1e-6, 0.5, 0.1), (0.3, 0.7 + 1e-6, 0.1)]
    part = read_part(trimmed(BRep_Tool.Surface_s(patch()), ((0, 0), (1, 0), (1, 1), (0, 1)), holes))
    found = start.own_start(part, 1, 2.0)
    assert found is not None
    trim = part.trim(1)
    whole = (trim.box[1] - trim.box[0]) * (trim.box[3] - trim.box[2]) * (1 - 3 * math.pi * 0.1**2)
    assert areas(found.uv, found.corner).sum() == pytest.approx(whole, rel=2e-2)


# --- the kernel's mesher ----------------------------------------------------------------------------------------------------


@pytest.mark.slow("another shape of the same law", but=("ring",))
@pytest.mark.parametrize("make", [ring, pocketed, lambda: as_nurbs(ball(10))], ids=["ring", "pocketed", "ball as B-spline"])
def test_the_second_way_keeps_the_promise_too(make, monkeypatch):
    monkeypatch.setattr(start, "own_start", lambda *_: None)
    part = read_part(make())
    triangles = tessellate(part, 0.1)
    assert not triangles.missing
    assert farthest(part, triangles) <= triangles.chord_error + ROUNDING
    assert all(BRep_Tool.Triangulation_s(face, TopLoc_Location()) is None for face in faces(part.shape))


@pytest.mark.slow("works on many faces")
def test_what_never_meshes_costs_its_own_faces_only(monkeypatch):
    own = start.own_start
    monkeypatch.setattr(start, "own_start", lambda part, n, chord: None if n < 5 else own(part, n, chord))
    monkeypatch.setattr(mesh, "BRepMesh_IncrementalMesh", never)
    monkeypatch.setattr(start, "_SECONDS", 0.3)
    monkeypatch.setattr(start, "_TOTAL", 0.6)
    began = time.process_time()
    triangles = tessellate(read_part(box()), 0.1)
    assert time.process_time() - began < 10
    assert {number for number, _ in triangles.missing} == {1, 2, 3, 4}
    assert ["does not end" in why for _, why in triangles.missing] == [True, True, False, False]
    assert all("has spent its time on others" in why for _, why in triangles.missing[2:])
    assert set(triangles.face) == {5, 6}


def test_what_crashes_the_mesher_is_missing(monkeypatch):
    import os

    monkeypatch.setattr(start, "own_start", lambda *_: None)
    monkeypatch.setattr(mesh, "BRepMesh_IncrementalMesh", lambda *_: os.abort())
    triangles = tessellate(read_part(box()), 0.1)
    assert [why for _, why in triangles.missing] == ["the kernel's mesher fails on it"] * 6


def test_what_the_mesher_failed_on_is_not_tried_again_to_be_drawn(monkeypatch):
    asked = []
    monkeypatch.setattr(start, "own_start", lambda *_: None)
    monkeypatch.setattr(start, "kernel_start", lambda _, number, *__: (asked.append(number), (None, 0.1))[1])
    part = read_part(box())
    _, why = start.starts(part, [1, 2], 0.1)
    assert asked == [1, 1, 2, 2]
    assert start.starts(part, [1, 2], 0.01, again=True) == ({}, why)
    assert len(asked) == 4
    start.starts(part, [1], 0.01)
    assert asked[4:] == [1, 1]


def test_a_face_that_never_meshes_is_not_drawn_and_others_are(monkeypatch):
    shape = compound(ring(), box())
    bad = faces(shape)[0]
    kernel = mesh.BRepMesh_IncrementalMesh

    def asked(given, *more):
        while given.IsSame(bad):
            pass
        return kernel(given, *more)

    monkeypatch.setattr(mesh, "BRepMesh_IncrementalMesh", asked)
    monkeypatch.setattr(mesh, "FACE", 0.4)
    began = time.monotonic()
    drawn = [found is not None for found in mesh.meshed(faces(shape), 0.1, 0.3)]
    assert drawn == [False] + [True] * 6
    assert time.monotonic() - began < 20


@pytest.mark.slow("works on many faces")
def test_many_faces_that_never_mesh_end_in_time(monkeypatch):
    monkeypatch.setattr(mesh, "BRepMesh_IncrementalMesh", never)
    monkeypatch.setattr(mesh, "HANGS", 2)
    monkeypatch.setattr(mesh, "FACE", 0.4)
    began = time.monotonic()
    assert list(mesh.meshed(faces(compound(*[box()] * 20)), 0.1, 0.3)) == [None] * 6
    assert time.monotonic() - began < 20


# --- a spring ---------------------------------------------------------------------------------------------------------------


def test_a_spring_is_meshed_in_seconds(tmp_path, monkeypatch):
    """A tube of 9 x 99 poles along a helix, from IGES: the kernel's mesher took minutes for one, or did not come back."""
    monkeypatch.setattr(start, "kernel_start", no_kernel)
    writer = IGESControl_Writer()
    writer.AddShape(spring())
    writer.ComputeModel()
    assert writer.Write(str(tmp_path / "spring.igs"))
    part = read_part(tmp_path / "spring.igs")
    began = time.process_time()
    triangles = tessellate(part, 0.02)
    assert time.process_time() - began < 20
    assert not triangles.missing
    assert triangles.chord_error <= 0.02
    assert farthest(part, triangles) <= triangles.chord_error + ROUNDING


def test_a_face_without_a_border_has_that_of_its_surface():
    bare = TopoDS.Face_s(patch().EmptyCopied())
    BRep_Builder().NaturalRestriction(bare, False)
    part = read_part(compound(box(), bare))
    assert start.own_start(part, 7, 0.1) is not None


@pytest.mark.parametrize("corners", [
    [(0, 0), (10, 10), (10, 0), (0, 10)],  # crosses itself
    [(0, 0), (10, 0), (10, 10), (5, 10), (5, 15), (5, 10), (0, 10)],  # runs out and back along itself
    [(0, 0), (10, 0), (10, 10), (6, 10), (5, 0), (4, 10), (0, 10)],  # touches itself with a corner
])  # fmt: skip
def test_a_border_that_crosses_or_touches_itself_is_filled_by_the_even_odd_rule(corners):
    wire = BRepBuilderAPI_MakePolygon()
    for x, y in corners:
        wire.Add(gp_Pnt(x, y, 0))
    wire.Close()
    part = read_part(BRepBuilderAPI_MakeFace(gp_Pln(), wire.Wire()).Face())
    found = start.own_start(part, 1, 0.1)
    assert found is not None
    ring = np.array([*corners, corners[0]], float)
    enclosed = shapely.build_area(shapely.node(shapely.linestrings(ring)))
    covered = shapely.union_all(shapely.polygons(found.uv[found.corner]))
    assert covered.symmetric_difference(enclosed).area == pytest.approx(0.0, abs=1e-9)
    assert shapely.area(shapely.polygons(found.uv[found.corner])).sum() == pytest.approx(enclosed.area)
