"""Triangles near the surface: the promised distance, checked from the surface and from the triangles, by other means."""

import numpy as np
import pytest
from cad_parts import (
    as_nurbs,
    ball,
    box,
    compound,
    cone,
    cut,
    drilled,
    holed_patch,
    mirror,
    moved,
    patch,
    pocketed,
    real,
    ring,
    rod,
)
from OCP.BRep import BRep_Builder, BRep_Tool
from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeFace
from OCP.BRepMesh import BRepMesh_IncrementalMesh
from OCP.Geom import Geom_BSplineSurface
from OCP.gp import gp_Pnt
from OCP.TColgp import TColgp_Array2OfPnt
from OCP.TColStd import TColStd_Array1OfInteger, TColStd_Array1OfReal
from OCP.TopLoc import TopLoc_Location
from OCP.TopoDS import TopoDS_Face
from scipy.spatial import cKDTree

from cad_io import read_part
from cad_io.kernel import values
from cad_io.tessellate import tessellate
from cad_io.tessellate import triangles as module

ROUNDING = 1e-9


def farthest(part, triangles, count=1500):
    """Largest distance of random surface points, each from the triangles of its face."""
    promise = triangles.chord_error + ROUNDING
    rng = np.random.default_rng(0)
    worst = 0.0
    for face in part.faces:
        points = surface_points(part, face.number, max(25, count // len(part.faces)), rng)
        mine = triangles.vertex[triangles.face == face.number]
        worst = max(worst, farthest_from(points, mine, promise))
    return worst


def farthest_from(points, triangles, promise, candidates=24, large=100):
    """Largest distance of points from a soup. What is beyond the promise is measured against every triangle.

    Shares nothing with the program: see `closest`.
    """
    middle = triangles.mean(axis=1)
    radius = np.linalg.norm(triangles - middle[:, None], axis=2).max(axis=1)
    # Large triangles have far middles: they are compared with every point, the small ones by their middles.
    order = np.argsort(-radius)
    best = np.full(len(points), np.inf)
    for row in order[:large].tolist():
        near = np.flatnonzero(best > promise)
        best[near] = np.minimum(best[near], closest(points[near], np.broadcast_to(triangles[row], (len(near), 3, 3))))
    small = triangles[order[large:]]
    if len(small):
        _, index = cKDTree(middle[order[large:]]).query(points, k=min(candidates, len(small)))
        for column in index.reshape(len(points), -1).T:
            left = np.flatnonzero(best > promise)
            best[left] = np.minimum(best[left], closest(points[left], small[column[left]]))
    for row in np.flatnonzero(best > promise).tolist():
        best[row] = closest(np.broadcast_to(points[row], (len(triangles), 3)), triangles).min()
    return best.max(initial=0.0)


def closest(point, triangle):
    a, b, c = triangle[:, 0], triangle[:, 1], triangle[:, 2]
    best = np.full(len(point), np.inf)
    for p, q in ((a, b), (b, c), (c, a)):
        t = np.clip(((point - p) * (q - p)).sum(1) / np.maximum(((q - p) ** 2).sum(1), 1e-300), 0, 1)
        best = np.minimum(best, np.linalg.norm(point - p - t[:, None] * (q - p), axis=1))
    gram = np.stack([np.stack([((b - a) ** 2).sum(1), ((b - a) * (c - a)).sum(1)], 1),
                     np.stack([((b - a) * (c - a)).sum(1), ((c - a) ** 2).sum(1)], 1)], 1)  # fmt: skip
    right = np.stack([((point - a) * (b - a)).sum(1), ((point - a) * (c - a)).sum(1)], 1)
    flat = np.linalg.det(gram) <= 1e-12 * gram[:, 0, 0] * gram[:, 1, 1]
    gram[flat] = np.eye(2)
    st = np.linalg.solve(gram, right[..., None])[..., 0]
    over = ~flat & (st >= 0).all(1) & (st.sum(1) <= 1)
    foot = a + st[:, :1] * (b - a) + st[:, 1:] * (c - a)
    return np.where(over, np.minimum(best, np.linalg.norm(point - foot, axis=1)), best)


def surface_points(part, number, count, rng):
    """Random points of a face, inside its trim."""
    trim = part.trim(number)
    u = rng.uniform(trim.box[0], trim.box[1], 3 * count)
    v = rng.uniform(trim.box[2], trim.box[3], 3 * count)
    keep = np.flatnonzero(trim.inside(u, v))[:count]
    return values(part.adaptor(number), u[keep], v[keep])


def triangle_points(triangles, count=4000, seed=0):
    rng = np.random.default_rng(seed)
    weight = rng.dirichlet((1, 1, 1), count)
    return np.einsum("ic,icx->ix", weight, triangles.vertex[rng.integers(0, len(triangles), count)])


def area(triangles):
    v = triangles.vertex
    return 0.5 * np.linalg.norm(np.cross(v[:, 1] - v[:, 0], v[:, 2] - v[:, 0]), axis=1).sum()


SHAPES = {
    "ball": lambda: ball(10), "ring": lambda: ring(20, 5), "cone": lambda: cone(8, 0, 10), "patch": patch,
    "holed": holed_patch, "pocketed": pocketed, "ball as B-spline": lambda: as_nurbs(ball(10)),
    "ring as B-spline": lambda: as_nurbs(ring(20, 5)), "cut ring": lambda: cut(ring(), box(50, 50, 50)),
    "mirrored": lambda: pocketed().Moved(TopLoc_Location(mirror())),
    "moved": lambda: holed_patch().Moved(TopLoc_Location(moved())),
}  # fmt: skip


@pytest.mark.parametrize("chord", [0.2, 0.01])
@pytest.mark.parametrize("make", SHAPES.values(), ids=SHAPES.keys())
def test_surface_points_are_within_the_promise(make, chord):
    part = read_part(make())
    triangles = tessellate(part, chord)
    assert not triangles.missing
    assert triangles.chord_error <= chord * (1 + 1e-12)
    assert farthest(part, triangles) <= triangles.chord_error + ROUNDING
    assert set(triangles.face) == {f.number for f in part.faces}


REAL = ("asitus_control_arm.step", "tigl_nacelle.stp", "bladex_upper.iges", "occt_linkrods.step")


@pytest.mark.parametrize("path", real(*REAL), ids=lambda p: p.name)
def test_real_surfaces_are_within_the_promise(path):
    part = read_part(path)
    chord = 2e-4 * float(np.linalg.norm(part.size))
    triangles = tessellate(part, chord)
    assert not triangles.missing
    assert triangles.chord_error <= chord * (1 + 1e-12)
    assert farthest(part, triangles) <= triangles.chord_error + ROUNDING
    assert area(triangles) == pytest.approx(sum(f.area for f in part.faces), rel=0.005)


@pytest.mark.parametrize("chord", [0.2, 0.01])
def test_triangles_are_near_the_surface_too(chord):
    points = triangle_points(tessellate(read_part(ball(10)), chord))
    assert np.abs(np.linalg.norm(points, axis=1) - 10).max() <= chord
    points = triangle_points(tessellate(read_part(ring(20, 5)), chord))
    off = np.hypot(np.hypot(points[:, 0], points[:, 1]) - 20, points[:, 2]) - 5
    assert np.abs(off).max() <= chord
    # Borders neither cut off nor added to: a round hole and its rim.
    triangles = tessellate(read_part(drilled(3)), chord)
    points = triangle_points(triangles, 20_000)
    radius = np.hypot(points[:, 0] - 10, points[:, 1] - 10)
    assert radius.min() >= 3 - chord
    # Vertices lie on the surface itself.
    vertex = tessellate(read_part(ball(10)), chord).vertex.reshape(-1, 3)
    assert np.linalg.norm(vertex, axis=1) == pytest.approx(10, abs=1e-9)


def test_planes_need_few_triangles_and_have_no_error():
    triangles = tessellate(read_part(box()), 1e-6)
    assert len(triangles) == 12
    assert triangles.chord_error < 1e-12
    assert area(triangles) == pytest.approx(600)


def test_long_cylinders_are_not_cut_across():
    triangles = tessellate(read_part(rod(5, 500)), 0.01, faces=[1])
    assert triangles.chord_error <= 0.01
    # A chord error of 0.01 mm at radius 5 needs 50 strips.
    assert len(triangles) < 400


def test_finer_is_nearer_and_the_area_converges():
    part = read_part(holed_patch())
    errors, areas = [], []
    for chord in (1.0, 0.1, 0.01):
        triangles = tessellate(part, chord)
        errors.append(triangles.chord_error)
        areas.append(abs(area(triangles) / part.faces[0].area - 1))
    assert errors == sorted(errors, reverse=True)
    assert areas[-1] < 1e-3


def test_faces_may_be_chosen():
    part = read_part(drilled())
    triangles = tessellate(part, 0.01, faces=[3, 7])
    assert set(triangles.face) == {3, 7}


@pytest.mark.parametrize("budget", [3000, 20_000])
def test_the_budget_binds_and_the_error_says_so(budget):
    part = read_part(patch())
    triangles = tessellate(part, 1e-4, budget=budget)
    assert len(triangles) <= budget
    assert len(triangles) > 0.5 * budget
    assert triangles.chord_error > 1e-4
    assert farthest(part, triangles) <= triangles.chord_error + ROUNDING


def test_the_shape_is_left_without_a_mesh():
    shape = drilled()
    BRepMesh_IncrementalMesh(shape, 0.1)
    part = read_part(shape)
    one = tessellate(part, 0.05)
    assert all(BRep_Tool.Triangulation_s(part.face(f.number), TopLoc_Location()) is None for f in part.faces)
    again = tessellate(part, 0.05)
    assert (one.vertex == again.vertex).all()


def test_faces_without_triangles_are_listed():
    bare = TopoDS_Face()
    BRep_Builder().MakeFace(bare)
    triangles = tessellate(read_part(compound(box(), bare)), 0.1)
    assert [number for number, _ in triangles.missing] == [7]
    assert len(triangles) == 12
    nothing = tessellate(read_part(compound(box(), bare)), 0.1, faces=[7])
    assert len(nothing) == 0
    assert nothing.chord_error == 0


def test_chord_must_be_positive():
    with pytest.raises(ValueError, match="positive"):
        tessellate(read_part(box()), 0.0)


@pytest.mark.parametrize("at", [(3, 4), (17, 9)])
def test_a_small_bump_on_a_large_flat_patch_is_seen(at):
    # One pole of 30 x 30 is raised: the bump is a few pieces wide, the kernel's start may be two triangles.
    count, width = 30, 90.0
    poles = TColgp_Array2OfPnt(1, count, 1, count)
    for i in range(count):
        for j in range(count):
            poles.SetValue(i + 1, j + 1, gp_Pnt(i * width / count, j * width / count, 2.0 * ((i, j) == at)))
    spans = count - 3
    knots, turns = TColStd_Array1OfReal(1, spans + 1), TColStd_Array1OfInteger(1, spans + 1)
    for k in range(spans + 1):
        knots.SetValue(k + 1, float(k))
        turns.SetValue(k + 1, 4 if k in (0, spans) else 1)
    part = read_part(BRepBuilderAPI_MakeFace(Geom_BSplineSurface(poles, knots, knots, turns, turns, 3, 3), 1e-6).Face())
    triangles = tessellate(part, 0.01)
    assert triangles.chord_error <= 0.01
    assert triangles.vertex[..., 2].max() > 0.5
    assert farthest(part, triangles, 1000) <= triangles.chord_error + ROUNDING


@pytest.mark.parametrize("budget", [2_000_000, 3000])
def test_triangles_do_not_depend_on_the_number_of_threads(budget):
    part = compound(as_nurbs(pocketed()), ring(), ball(at=(400.0, 0, 0)))
    one, two = (tessellate(read_part(part), 0.02, budget=budget, jobs=jobs) for jobs in (1, 2))
    assert (one.chord_error > 0.02) == (budget < 10_000)
    assert one == two


def test_a_face_without_room_is_laid_in_a_second_pass(monkeypatch):
    """The same triangles, whether they were kept as they were counted or not."""
    kept = tessellate(read_part(ring()), 0.02)
    monkeypatch.setattr(module, "_ROOM", 100)
    assert tessellate(read_part(ring()), 0.02) == kept
