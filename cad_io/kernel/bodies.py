"""Bodies that are made: a profile turned about an axis or swept along it, triangles as faces, a shape put in its place."""

from collections.abc import Iterable, Sequence
from typing import Any, NamedTuple

import numpy as np
from OCP.BRep import BRep_Builder
from OCP.BRepBuilderAPI import (
    BRepBuilderAPI_MakeEdge,
    BRepBuilderAPI_MakeFace,
    BRepBuilderAPI_MakePolygon,
    BRepBuilderAPI_MakeWire,
)
from OCP.BRepPrimAPI import BRepPrimAPI_MakePrism, BRepPrimAPI_MakeRevol
from OCP.GC import GC_MakeArcOfCircle
from OCP.gp import gp_Ax1, gp_Dir, gp_Pnt, gp_Trsf, gp_Vec
from OCP.Poly import Poly_Array1OfTriangle, Poly_Triangle, Poly_Triangulation
from OCP.TColgp import TColgp_Array1OfPnt
from OCP.TopLoc import TopLoc_Location
from OCP.TopoDS import TopoDS_Face

from cad_io.arrays import Floats
from cad_io.kernel.calls import translated
from cad_io.kernel.components import compound


class Side(NamedTuple):
    """A side of a profile: from where the last one ended to `end`, straight, or as an arc through `middle`. Points are distances
    from the axis and heights along it."""

    end: tuple[float, float]
    middle: tuple[float, float] | None = None


def revolved(start: tuple[float, float], sides: Iterable[Side]) -> Any:
    """The solid that a closed profile makes when it is turned about the z axis.

    Parameters
    ----------
    start : (float, float)
    sides : iterable of Side
        The last one ends at `start`.

    Raises
    ------
    CadIoError
        The kernel makes no solid of it.
    """
    with translated("turning a profile"):
        wire, at = BRepBuilderAPI_MakeWire(), start
        for side in sides:
            if side.middle is None:
                edge = BRepBuilderAPI_MakeEdge(_point(at), _point(side.end)).Edge()
            else:
                arc = GC_MakeArcOfCircle(_point(at), _point(side.middle), _point(side.end)).Value()
                edge = BRepBuilderAPI_MakeEdge(arc).Edge()
            wire.Add(edge)
            at = side.end
        return turned(BRepBuilderAPI_MakeFace(wire.Wire()).Face(), (0.0, 0.0, 0.0), (0.0, 0.0, 1.0))


def turned(shape: Any, origin: Sequence[float], direction: Sequence[float]) -> Any:
    """Revolve a face, a wire or an edge by a full turn about an axis."""
    with translated("turning a profile"):
        made = BRepPrimAPI_MakeRevol(shape, gp_Ax1(gp_Pnt(*origin), gp_Dir(*direction)))
        return made.Shape()


def prism(outline: Sequence[tuple[float, float]], low: float, high: float) -> Any:
    """The solid over a polygon of x and y, from a height along the z axis to another.

    Raises
    ------
    CadIoError
        The kernel makes no solid of it.
    """
    with translated("sweeping a profile"):
        wire = BRepBuilderAPI_MakePolygon()
        for x, y in outline:
            wire.Add(gp_Pnt(x, y, low))
        wire.Close()
        return BRepPrimAPI_MakePrism(BRepBuilderAPI_MakeFace(wire.Wire()).Face(), gp_Vec(0.0, 0.0, high - low)).Shape()


def of_triangles(vertex: Floats) -> Any:
    """A compound of a face that is made of triangles (n, 3, 3) alone: it is to be looked at, and has no surface."""
    points, index = np.unique(vertex.reshape(-1, 3), axis=0, return_inverse=True)
    nodes = TColgp_Array1OfPnt(1, len(points))
    for i, point in enumerate(points.tolist(), 1):
        nodes.SetValue(i, gp_Pnt(*point))
    triangles = Poly_Array1OfTriangle(1, len(vertex))
    for i, corner in enumerate((index.reshape(-1, 3) + 1).tolist(), 1):
        triangles.SetValue(i, Poly_Triangle(*corner))
    face = TopoDS_Face()
    BRep_Builder().MakeFace(face, Poly_Triangulation(nodes, triangles))
    return compound([face])


def placed(shape: Any, place: Floats) -> Any:
    """A shape put in its place (3, 4): a rotation and a shift, mm."""
    move = gp_Trsf()
    move.SetValues(*(float(value) for value in place.ravel()))
    return shape.Moved(TopLoc_Location(move))


def _point(at: tuple[float, float]) -> gp_Pnt:
    return gp_Pnt(at[0], 0.0, at[1])
