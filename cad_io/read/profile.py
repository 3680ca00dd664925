"""A body of revolution from an object of a host: a body as it is, a profile turned about an axis."""

from collections.abc import Sequence
from typing import Any

from OCP.BRepAdaptor import BRepAdaptor_Surface
from OCP.GeomAbs import GeomAbs_Plane
from OCP.gp import gp_Ax1, gp_Dir, gp_Pnt

from cad_io.errors import CadIoError, ReadError
from cad_io.kernel import faces, translated
from cad_io.kernel.bodies import turned
from cad_io.kernel.components import as_one
from cad_io.part import Part
from cad_io.read.host_objects import each_of, shapes_of

#: Angle, rad, and distance, mm, up to which a profile's plane holds the axis.
_FLAT, _ON = 1e-6, 1e-4


def turned_part(source: Any, origin: Sequence[float], direction: Sequence[float]) -> Part:
    """The part that an object stands for: solids and shells as they are; planar faces, wires and edges turned about an axis.

    Parameters
    ----------
    source : object
        A kernel shape, a CadQuery or build123d object, or a list of such.
    origin, direction : (3,) float
        The axis, mm.

    Raises
    ------
    ReadError
        It holds no shape, or a profile that lies in no plane through the axis, or is not joined.
    """
    if isinstance(source, Part):
        return source
    if any(getattr(getattr(each, "ctx", None), "pendingEdges", ()) for each in each_of(source)):
        raise ReadError("the lines of the Workplane are not joined to a profile: close() it, or wire()")
    with translated("reading a body of revolution", error=ReadError):
        axis = gp_Ax1(gp_Pnt(*origin), gp_Dir(*direction))
        profiles = [_turned(shape, axis, origin, direction) for each in each_of(source) for shape in shapes_of(each)]
    if not profiles:
        raise ReadError(f"the {type(source).__name__} holds no shape")
    return Part(as_one(profiles))


def _turned(shape: Any, axis: gp_Ax1, origin: Sequence[float], direction: Sequence[float]) -> Any:
    mine = faces(shape)
    flat = [adaptor.Plane() for face in mine if (adaptor := BRepAdaptor_Surface(face)).GetType() == GeomAbs_Plane]
    profile = not mine or (len(flat) == len(mine) and all(_coplanar(flat[0], plane) for plane in flat))
    if not profile:
        return shape
    for plane in flat[:1]:
        across = abs(plane.Axis().Direction().Dot(axis.Direction()))
        if across > _FLAT or plane.Distance(axis.Location()) > _ON:
            raise ReadError("the profile lies in no plane through the axis: draw it there, or give the axis that it turns about")
    try:
        return turned(shape, origin, direction)
    except CadIoError:
        raise ReadError("the profile cannot be turned about the axis: draw its one half, on one side of the axis") from None


def _coplanar(one: Any, other: Any) -> bool:
    return bool(one.Axis().IsParallel(other.Axis(), _FLAT)) and float(one.Distance(other.Location())) <= _ON
