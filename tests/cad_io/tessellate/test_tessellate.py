"""Triangles near the surface: the promised distance, checked from the surface and from the triangles, by other means."""

import numpy as np
import pytest
from OCP.BRep import BRep_Builder, BRep_Tool
from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeEdge, BRepBuilderAPI_MakeFace, BRepBuilderAPI_MakeWire
from OCP.BRepLib import BRepLib
from OCP.BRepMesh import BRepMesh_IncrementalMesh
from OCP.Geom import Geom_BezierSurface, Geom_BSplineSurface
from OCP.Geom2d import Geom2d_Circle
from OCP.gp import gp_Ax22d, gp_Dir2d, gp_Pnt, gp_Pnt2d
from OCP.TColgp import TColgp_Array2OfPnt
from OCP.TColStd import TColStd_Array1OfInteger, TColStd_Array1OfReal
from OCP.TopLoc import TopLoc_Location
from OCP.TopoDS import TopoDS_Face

from cad_io import read_part
from cad_io.tessellate import tessellate
from cad_io.tessellate import triangles as module
from tests.support.cad_parts import SHAPES, as_nurbs, ball, box, compound, drilled, holed_patch, patch, pocketed, real, ring, rod
from tests.support.distances import ROUNDING, farthest, farthest_from


def triangle_points(triangles, count=4000, seed=0):
    rng = np.random.default_rng(seed)
    weight = rng.dirichlet((1, 1, 1), count)
    return np.einsum("ic,icx->ix", weight, triangles.vertex[rng.integers(0, len(triangles), count)])


def area(triangles):
    v = triangles.vertex
    return 0.5 * np.linalg.norm(np.cross(v[:, 1] - v[:, 0], v[:, 2] - v[:, 0]), axis=1).sum()


@pytest.mark.slow("reads or samples a large real file", but=("cut", "ring "))
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


@pytest.mark.slow("reads or samples a large real file", only=("asitus", "occt_linkrods"))
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


@pytest.mark.slow("another place of the same law", only=("at1",))
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
    monkeypatch.setattr(module, "_LARGEST", 100)
    assert tessellate(read_part(ring()), 0.02) == kept


@pytest.mark.parametrize("spoilt", [
    lambda laid: laid._replace(off=np.inf), lambda laid: laid._replace(off=np.nan),
    lambda laid: laid._replace(point=np.where(np.arange(len(laid.point))[:, None] == 0, np.nan, laid.point)),
], ids=["endless", "unknown", "no place"])  # fmt: skip
def test_a_face_of_which_a_place_or_the_distance_is_not_known_is_missing(spoilt, monkeypatch):
    laid = module.Patch.laid
    monkeypatch.setattr(module.Patch, "laid", lambda self, *_: spoilt(laid(self, *_)) if self.number == 2 else laid(self, *_))
    triangles = tessellate(read_part(box()), 0.1)
    assert triangles.missing == ((2, "its surface cannot be evaluated everywhere"),)
    assert set(dict(triangles.errors)) == {1, 3, 4, 5, 6}
    assert triangles.chord_error < 1e-12
    assert np.isfinite(triangles.vertex).all()


@pytest.mark.parametrize("along", [0, 1])
def test_a_round_border_is_near_where_a_step_along_one_parameter_is_much_longer(along, monkeypatch):
    """A circle of the parameter plane that is a narrow ellipse on the surface: however coarse its chords are to begin with."""
    monkeypatch.setattr(module, "_COARSER", 1e5)
    long = np.roll([400.0, 4.0], along)
    poles = TColgp_Array2OfPnt(1, 2, 1, 2)
    for i in range(2):
        for j in range(2):
            poles.SetValue(i + 1, j + 1, gp_Pnt(i * long[0], j * long[1], 0.0))
    surface = Geom_BezierSurface(poles)
    circle = BRepBuilderAPI_MakeEdge(Geom2d_Circle(gp_Ax22d(gp_Pnt2d(0.5, 0.5), gp_Dir2d(1, 0), gp_Dir2d(0, 1)), 0.5), surface)
    face = BRepBuilderAPI_MakeFace(surface, BRepBuilderAPI_MakeWire(circle.Edge()).Wire(), True).Face()
    BRepLib.BuildCurves3d_s(face)
    triangles = tessellate(read_part(face), 0.1)
    assert not triangles.missing
    assert triangles.chord_error <= 0.1
    angle = np.linspace(0.0, 2 * np.pi, 999)
    border = np.column_stack([0.5 * long[0] * (1 + np.cos(angle)), 0.5 * long[1] * (1 + np.sin(angle)), np.zeros(999)])
    assert farthest_from(border, triangles.vertex, 0.1) <= 0.1
