"""Parts and label fields for the tests of splitting and writing."""

from collections.abc import Callable
from typing import Any

import numpy as np
from OCP.BRepAdaptor import BRepAdaptor_Surface
from OCP.BRepAlgoAPI import BRepAlgoAPI_Cut
from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeFace
from OCP.BRepPrimAPI import BRepPrimAPI_MakeCylinder, BRepPrimAPI_MakePrism
from OCP.GeomAbs import GeomAbs_C2
from OCP.GeomAPI import GeomAPI_PointsToBSplineSurface
from OCP.gp import gp_Ax2, gp_Dir, gp_Pnt, gp_Vec
from OCP.TColgp import TColgp_Array2OfPnt

from cad_io.arrays import FaceLabels
from cad_io.kernel import faces
from cad_io.part import Part

RED, GREEN, GREY = (0.9, 0.1, 0.1), (0.1, 0.7, 0.2), (0.75, 0.75, 0.78)

Field = Callable[[Any, Any], Any]


def patch() -> Any:
    """A wavy B-spline face over 0..110 x 0..90 mm."""
    points = TColgp_Array2OfPnt(1, 12, 1, 10)
    height = np.random.default_rng(1).normal(size=(12, 10)) * 2
    for i in range(12):
        for j in range(10):
            points.SetValue(i + 1, j + 1, gp_Pnt(10.0 * i, 10.0 * j, float(height[i, j])))
    return BRepBuilderAPI_MakeFace(GeomAPI_PointsToBSplineSurface(points, 3, 3, GeomAbs_C2, 1e-3).Surface(), 1e-6).Face()


def block(holes: int = 3) -> Any:
    """A solid below the patch, with holes drilled through it."""
    solid = BRepPrimAPI_MakePrism(patch(), gp_Vec(0, 0, -60)).Shape()
    for k in range(holes):
        axis = gp_Ax2(gp_Pnt(25.0 + 30 * k, 30.0 + 12 * k, -100), gp_Dir(0, 0, 1))
        solid = BRepAlgoAPI_Cut(solid, BRepPrimAPI_MakeCylinder(axis, 8.0, 200.0).Shape()).Shape()
    return solid


def labels(part: Part, number: int, field: Field, n: int = 61, closed: tuple[bool, bool] = (False, False)) -> FaceLabels:
    """Labels field(x, y) on n x n nodes, x and y from 0 to 1 over the face's box of parameters; a seam once."""
    a = BRepAdaptor_Surface(part.face(number))
    u = np.linspace(a.FirstUParameter(), a.LastUParameter(), n + closed[0])[:n]
    v = np.linspace(a.FirstVParameter(), a.LastVParameter(), n + closed[1])[:n]
    x = np.linspace(0, 1, n + closed[0])[:n]
    y = np.linspace(0, 1, n + closed[1])[:n]
    return FaceLabels(number, u, v, np.asarray(field(*np.meshgrid(x, y, indexing="ij")), np.int32))


def waves(seed: int, levels: tuple[float, ...] = (-1.0, 1.0)) -> Field:
    """Labels 0, 1, 2 of a random field with period 1."""
    rng = np.random.default_rng(seed)
    terms = [(rng.normal(), a, b, rng.uniform(0, 6)) for a in range(4) for b in range(4)]
    return lambda x, y: np.digitize(sum(w * np.cos(2 * np.pi * (a * x + b * y) + p) for w, a, b, p in terms), levels)


def largest_bspline(part: Part) -> int:
    """Number of the largest B-spline face."""
    return max((f for f in part.faces if f.surface == "bspline"), key=lambda f: f.area).number


def face_count(shape: Any) -> int:
    return len(faces(shape))
