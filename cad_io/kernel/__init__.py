"""The kernel's manners: its calls and their errors, its maps and numbers, compounds, places of products, time limits.

May use: arrays and errors. Kernel exceptions are not all subclasses of `Standard_Failure` and may have an empty text, so they are
told by the module that they come from. Values are taken out as arrays at once; `.Coord()` into one list is the quickest way out.
"""

import re
from collections.abc import Iterator
from contextlib import contextmanager
from types import TracebackType
from typing import Any

import numpy as np
from OCP.BRepAdaptor import BRepAdaptor_Surface
from OCP.Geom import Geom_BSplineCurve
from OCP.Geom2d import Geom2d_BSplineCurve
from OCP.GeomAbs import GeomAbs_Line
from OCP.gp import gp_Pnt, gp_Pnt2d, gp_Vec, gp_Vec2d
from OCP.Message import Message
from OCP.TColgp import TColgp_Array1OfPnt, TColgp_Array1OfPnt2d
from OCP.TColStd import TColStd_Array1OfInteger, TColStd_Array1OfReal
from OCP.TopAbs import TopAbs_EDGE, TopAbs_FACE, TopAbs_FORWARD, TopAbs_REVERSED
from OCP.TopExp import TopExp, TopExp_Explorer
from OCP.TopoDS import TopoDS, TopoDS_Edge, TopoDS_Face, TopoDS_Shape
from OCP.TopTools import TopTools_IndexedMapOfShape

from cad_io.arrays import Floats
from cad_io.errors import CadIoError

#: Where in memory the kernel had an object: another place in each run.
_ADDRESS = re.compile(r"0x[0-9a-f]+ : ")


def is_kernel_error(error: BaseException) -> bool:
    """True if the exception was thrown by the kernel."""
    return type(error).__module__.split(".")[0] == "OCP"


class may_refuse:
    """Go on behind the block where the kernel throws in it; other errors pass."""

    def __enter__(self) -> None: ...

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None) -> bool:
        return error is not None and is_kernel_error(error)


@contextmanager
def translated(
    doing: str, *, error: type[CadIoError] = CadIoError, file: str | None = None, face: str | None = None
) -> Iterator[None]:
    """Turn any kernel exception inside the block into `error`, a class of CadIoError; errors that are not the kernel's pass
    unchanged.

    `doing` says what was being done, as in "reading the file"; `file` and `face` where it happened.
    """
    try:
        yield
    except Exception as thrown:
        if not is_kernel_error(thrown):
            raise
        text = _ADDRESS.sub("", " ".join(str(thrown).split()))
        name = type(thrown).__name__
        cause = f"the CAD kernel failed while {doing} ({name}{': ' + text if text else ''})"
        raise error(cause, file=file, face=face) from thrown


def silence() -> None:
    """Stop the kernel from printing to standard output, where a plan may be written."""
    messenger = Message.DefaultMessenger_s()
    for printer in list(messenger.Printers()):
        messenger.RemovePrinter(printer)


def shape_map(shape: TopoDS_Shape, kind: Any) -> TopTools_IndexedMapOfShape:
    """The kernel's map of the sub-shapes of one kind; `FindKey(i)` and `FindIndex(s)` count from 1."""
    result = TopTools_IndexedMapOfShape()
    TopExp.MapShapes_s(shape, kind, result)
    return result


def faces(shape: TopoDS_Shape) -> list[TopoDS_Face]:
    """Faces in the order of the kernel's map: face number i is `faces(shape)[i - 1]`."""
    result = shape_map(shape, TopAbs_FACE)
    return [TopoDS.Face_s(result.FindKey(i)) for i in range(1, result.Extent() + 1)]


def explore(shape: TopoDS_Shape, kind: Any, avoid: Any = None) -> Iterator[TopoDS_Shape]:
    """Every occurrence of a kind of sub-shape, oriented as in `shape`; those inside a shape of kind `avoid` not."""
    explorer = TopExp_Explorer(shape, kind) if avoid is None else TopExp_Explorer(shape, kind, avoid)
    while explorer.More():
        yield explorer.Current()
        explorer.Next()


def edges_of(face: TopoDS_Face) -> list[TopoDS_Edge]:
    """Edge uses of a face; a seam occurs twice."""
    return [TopoDS.Edge_s(edge) for edge in explore(face, TopAbs_EDGE)]


def bounding(face: TopoDS_Face) -> tuple[TopoDS_Face, list[tuple[TopoDS_Edge, int]]]:
    """A face turned FORWARD, and the edges that bound it, each with +1 or -1 for its direction there; a seam occurs twice."""
    forward, ways = TopoDS.Face_s(face.Oriented(TopAbs_FORWARD)), {TopAbs_FORWARD: 1, TopAbs_REVERSED: -1}
    return forward, [(edge, ways[way]) for edge in edges_of(forward) if (way := edge.Orientation()) in ways]


def values(adaptor: BRepAdaptor_Surface, u: Floats, v: Floats) -> Floats:
    """Surface points, (n, 3) mm, at parameters u, v of shape (n,); NaN where the kernel refuses."""
    return _derivatives(adaptor.D0, u, v, 0)[:, 0]


def first_derivatives(adaptor: BRepAdaptor_Surface, u: Floats, v: Floats) -> Floats:
    """S, Su, Sv as (n, 3, 3) at parameters u, v of shape (n,); NaN rows where the kernel refuses."""
    return _derivatives(adaptor.D1, u, v, 2)


def second_derivatives(adaptor: BRepAdaptor_Surface, u: Floats, v: Floats) -> Floats:
    """S, Su, Sv, Suu, Svv, Suv as (n, 6, 3) at parameters u, v of shape (n,); NaN rows where the kernel refuses."""
    return _derivatives(adaptor.D2, u, v, 5)


def _derivatives(evaluate: Any, u: Floats, v: Floats, count: int) -> Floats:
    outs = (gp_Pnt(), *(gp_Vec() for _ in range(count)))
    flat: list[float] = []
    for a, b in zip(u.tolist(), v.tolist(), strict=True):
        row = [np.nan] * (3 * (count + 1))
        with may_refuse():
            evaluate(a, b, *outs)
            row = [x for out in outs for x in out.Coord()]
        flat.extend(row)
    return np.array(flat, dtype=float).reshape(-1, count + 1, 3)


def points_on(curve: Any, t: Floats) -> Floats:
    """Points (n, 2) of a curve in a parameter plane at parameters (n,)."""
    if curve.GetType() == GeomAbs_Line:
        return _on_line(curve, t)[0]
    return np.array([curve.Value(x).Coord() for x in t.tolist()])


def _on_line(curve: Any, t: Floats) -> tuple[Floats, Floats]:
    """Points (n, 2) of a line in a parameter plane, and its direction (2,): in closed form as the kernel has it, to the bit."""
    line = curve.Line()
    direction = np.array(line.Direction().Coord())
    return t[:, None] * direction + np.array(line.Location().Coord()), direction


def along(curve: Any, t: Floats, dimension: int = 2) -> Floats:
    """Points and derivatives of a curve at parameters (n,), in a parameter plane or in space: (n, 2, dimension)."""
    if dimension == 2 and curve.GetType() == GeomAbs_Line:
        points, direction = _on_line(curve, t)
        return np.stack([points, np.broadcast_to(direction, points.shape)], axis=1)
    point, tangent = (gp_Pnt2d(), gp_Vec2d()) if dimension == 2 else (gp_Pnt(), gp_Vec())
    evaluate, rows = curve.D1, []
    for x in t.tolist():
        evaluate(x, point, tangent)
        rows.append((point.Coord(), tangent.Coord()))
    return np.array(rows, dtype=float).reshape(-1, 2, dimension)


def domain(adaptor: BRepAdaptor_Surface) -> tuple[float, float, float, float]:
    """Ends of a surface's own parameters: u least, u most, v least, v most."""
    return adaptor.FirstUParameter(), adaptor.LastUParameter(), adaptor.FirstVParameter(), adaptor.LastVParameter()


def kind_of(adaptor: Any) -> str:
    """Name a surface or a curve as the kernel does: `Plane`, `BSplineSurface`, `Line`."""
    return str(adaptor.GetType().name).removeprefix("GeomAbs_")


def periods(surface: Any) -> tuple[float, float]:
    """Periods of a surface's parameters u and v, 0 where there is none."""
    return surface.UPeriod() if surface.IsUPeriodic() else 0.0, surface.VPeriod() if surface.IsVPeriodic() else 0.0


def interval_ends(count: int, intervals: Any, continuity: Any) -> Floats:
    """Ends (count + 1,) of the intervals in which a curve or surface is that smooth, by its own `...Intervals`."""
    ends = TColStd_Array1OfReal(1, count + 1)
    intervals(ends, continuity)
    return np.array([ends.Value(i) for i in range(1, count + 2)])


def cubic(knots: Floats, poles: Floats) -> Geom_BSplineCurve | Geom2d_BSplineCurve:
    """The curve with clamped knots (m + 4,) and poles (m, 2) in a parameter plane, or (m, 3) in space."""
    flat = poles.shape[1] == 2
    array = (TColgp_Array1OfPnt2d if flat else TColgp_Array1OfPnt)(1, len(poles))
    for i, pole in enumerate(poles.tolist(), 1):
        array.SetValue(i, (gp_Pnt2d if flat else gp_Pnt)(*pole))
    value, count = np.unique(knots, return_counts=True)
    distinct, times = TColStd_Array1OfReal(1, len(value)), TColStd_Array1OfInteger(1, len(value))
    for i, (x, m) in enumerate(zip(value.tolist(), count.tolist(), strict=True), 1):
        distinct.SetValue(i, x)
        times.SetValue(i, m)
    return (Geom2d_BSplineCurve if flat else Geom_BSplineCurve)(array, distinct, times, 3)
