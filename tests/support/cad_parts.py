"""Parts for the tests of `cad_io`: solids and patches made with the kernel, real files, and what independent code says."""

import math

import numpy as np
from OCP.BRep import BRep_Builder, BRep_Tool
from OCP.BRepAlgoAPI import BRepAlgoAPI_Cut
from OCP.BRepBuilderAPI import (
    BRepBuilderAPI_MakeEdge,
    BRepBuilderAPI_MakeFace,
    BRepBuilderAPI_NurbsConvert,
    BRepBuilderAPI_Transform,
)
from OCP.BRepMesh import BRepMesh_IncrementalMesh
from OCP.BRepPrimAPI import (
    BRepPrimAPI_MakeBox,
    BRepPrimAPI_MakeCone,
    BRepPrimAPI_MakeCylinder,
    BRepPrimAPI_MakePrism,
    BRepPrimAPI_MakeRevol,
    BRepPrimAPI_MakeSphere,
    BRepPrimAPI_MakeTorus,
)
from OCP.Geom import Geom_BezierCurve, Geom_BSplineSurface
from OCP.GeomAPI import GeomAPI_PointsToBSplineSurface
from OCP.gp import gp_Ax1, gp_Ax2, gp_Dir, gp_Pnt, gp_Trsf, gp_Vec
from OCP.STEPControl import STEPControl_AsIs, STEPControl_Writer
from OCP.TColgp import TColgp_Array1OfPnt, TColgp_Array2OfPnt
from OCP.TColStd import TColStd_Array1OfInteger, TColStd_Array1OfReal, TColStd_Array2OfReal
from OCP.TopLoc import TopLoc_Location
from OCP.TopoDS import TopoDS_Compound, TopoDS_Face, TopoDS_Shell

from cad_io.kernel import faces
from tests.support.places import DATA

CAD = DATA / "cad"


def real(*names):
    """Paths of real files; tests on those that are not at hand are skipped (`conftest.py`)."""
    return [CAD / name for name in names]


def ax(point=(0, 0, 0), z=(0, 0, 1)):
    return gp_Ax2(gp_Pnt(*map(float, point)), gp_Dir(*map(float, z)))


def ball(r=10.0, at=(0, 0, 0)):
    return BRepPrimAPI_MakeSphere(ax(at), r).Solid()


def box(x=10.0, y=10.0, z=10.0, at=(0, 0, 0)):
    return BRepPrimAPI_MakeBox(gp_Pnt(*map(float, at)), x, y, z).Solid()


def rod(r=5.0, h=20.0, at=(0, 0, 0)):
    return BRepPrimAPI_MakeCylinder(ax(at), r, h).Solid()


def cone(r0=8.0, r1=0.0, h=10.0):
    return BRepPrimAPI_MakeCone(ax(), r0, r1, h).Solid()


def ring(r=20.0, tube=5.0):
    return BRepPrimAPI_MakeTorus(ax(), r, tube).Solid()


def cut(whole, tool):
    return BRepAlgoAPI_Cut(whole, tool).Shape()


def drilled(r=3.0):
    """A box with a hole through it."""
    return cut(box(20, 20, 10), rod(r, 30, (10, 10, -5)))


def pocketed(r=5.0):
    """A box with a round pocket in its top."""
    return cut(box(20, 20, 10), ball(r, (10, 10, 10)))


def as_nurbs(shape):
    return BRepBuilderAPI_NurbsConvert(shape, True).Shape()


def _bezier(points):
    pole = TColgp_Array1OfPnt(1, len(points))
    for i, p in enumerate(points, 1):
        pole.SetValue(i, gp_Pnt(*p))
    return BRepBuilderAPI_MakeEdge(Geom_BezierCurve(pole)).Edge()


def extruded_arc():
    """A face that an arc of a cubic Bezier curve leaves behind along a line."""
    return BRepPrimAPI_MakePrism(_bezier([(0, 0, 0), (5, 8, 0), (12, -6, 1), (20, 3, 0)]), gp_Vec(1, 2, 9)).Shape()


def revolved_wave():
    """A face that a cubic Bezier curve leaves behind round an axis."""
    return BRepPrimAPI_MakeRevol(
        _bezier([(6, 0, 0), (9, 0, 5), (3, 0, 8), (7, 0, 14)]), gp_Ax1(gp_Pnt(0, 0, 0), gp_Dir(0, 0, 1))
    ).Shape()


def compound(*shapes):
    result, builder = TopoDS_Compound(), BRep_Builder()
    builder.MakeCompound(result)
    for shape in shapes:
        builder.Add(result, shape)
    return result


def loose(shape, gap=0.0):
    """Its faces with edges of their own, every second one moved so far off along z."""
    return compound(
        *(BRepBuilderAPI_Transform(face, moved(0, by=(0, 0, gap * (i % 2))), True).Shape() for i, face in enumerate(faces(shape)))
    )


def moved(angle=0.7, axis=(1, 2, 3), by=(5, -7, 11)):
    turn, shift = gp_Trsf(), gp_Trsf()
    turn.SetRotation(gp_Ax1(gp_Pnt(0, 0, 0), gp_Dir(*map(float, axis))), float(angle))
    shift.SetTranslation(gp_Vec(*map(float, by)))
    return shift.Multiplied(turn)


def mirror():
    """Mirror in the plane x = 0."""
    result = gp_Trsf()
    result.SetMirror(gp_Ax2(gp_Pnt(0, 0, 0), gp_Dir(1, 0, 0)))
    return result


def patch(seed=1, count=9, width=84.0, height=15.0):
    """An untrimmed bicubic B-spline patch of random bumps over a square."""
    rng = np.random.default_rng(seed)
    centre, high = rng.uniform(-width / 3, width / 3, (5, 2)), rng.uniform(-height, height, 5)
    line = np.linspace(-width / 2, width / 2, count)
    points = TColgp_Array2OfPnt(1, count, 1, count)
    for i, x in enumerate(line.tolist()):
        for j, y in enumerate(line.tolist()):
            z = high @ np.exp(-((x - centre[:, 0]) ** 2 + (y - centre[:, 1]) ** 2) / (width / 4) ** 2)
            points.SetValue(i + 1, j + 1, gp_Pnt(x, y, float(z)))
    made = GeomAPI_PointsToBSplineSurface()
    made.Interpolate(points)
    return BRepBuilderAPI_MakeFace(made.Surface(), 1e-6).Face()


def holed_patch(seed=1):
    """The patch with two round holes and a corner cut off, by rods along z."""
    shape = patch(seed)
    for r, x, y in ((12, 0, 5), (7, 25, -20), (20, 42, 42)):
        shape = cut(shape, rod(r, 200, (x, y, -100)))
    return shape


def spring(turns=6, radius=10.0, wire=1.5, pitch=5.0, count=99):
    """A tube along a helix without its ends: rational, 9 poles around, cubic along."""
    half = math.sqrt(0.5)
    around = [(1, 0, 1), (1, 1, half), (0, 1, 1), (-1, 1, half), (-1, 0, 1), (-1, -1, half), (0, -1, 1), (1, -1, half), (1, 0, 1)]
    poles, weights = TColgp_Array2OfPnt(1, 9, 1, count), TColStd_Array2OfReal(1, 9, 1, count)
    for j, angle in enumerate(np.linspace(0, 2 * np.pi * turns, count).tolist()):
        out = np.array([math.cos(angle), math.sin(angle), 0.0])
        rise = pitch / (2 * math.pi)
        along = np.array([-radius * out[1], radius * out[0], rise]) / math.hypot(radius, rise)
        across = np.cross(along, out)
        middle = radius * out + [0, 0, rise * angle]
        for i, (x, y, weight) in enumerate(around):
            poles.SetValue(i + 1, j + 1, gp_Pnt(*(middle + wire * (x * out + y * across)).tolist()))
            weights.SetValue(i + 1, j + 1, float(weight))
    (knots_u, times_u), (knots_v, times_v) = _knots(4, 3, 2), _knots(count - 3, 4, 1)
    surface = Geom_BSplineSurface(poles, weights, knots_u, knots_v, times_u, times_v, 2, 3)
    return BRepBuilderAPI_MakeFace(surface, 1e-6).Face()


def _knots(spans, at_ends, between):
    knots, times = TColStd_Array1OfReal(1, spans + 1), TColStd_Array1OfInteger(1, spans + 1)
    for k in range(spans + 1):
        knots.SetValue(k + 1, k / spans)
        times.SetValue(k + 1, at_ends if k in (0, spans) else between)
    return knots, times


SHAPES = {
    "ball": lambda: ball(10), "ring": lambda: ring(20, 5), "cone": lambda: cone(8, 0, 10), "patch": patch,
    "holed": holed_patch, "pocketed": pocketed, "ball as B-spline": lambda: as_nurbs(ball(10)),
    "ring as B-spline": lambda: as_nurbs(ring(20, 5)), "cut ring": lambda: cut(ring(), box(50, 50, 50)),
    "mirrored": lambda: pocketed().Moved(TopLoc_Location(mirror())),
    "moved": lambda: holed_patch().Moved(TopLoc_Location(moved())),
}  # fmt: skip


def triangulated(shape):
    """A shell of the shape's faces with their triangles alone."""
    BRepMesh_IncrementalMesh(shape, 0.1, False, 0.3, False)
    builder, shell = BRep_Builder(), TopoDS_Shell()
    builder.MakeShell(shell)
    for face in faces(shape):
        only = TopoDS_Face()
        builder.MakeFace(only, BRep_Tool.Triangulation_s(face, TopLoc_Location()))
        builder.Add(shell, only)
    return shell


def write_step(shape, file):
    writer = STEPControl_Writer()
    writer.Transfer(shape, STEPControl_AsIs)
    writer.Write(str(file))
    return file
