"""The one place that knows the kernel's manners: its exceptions, its printers, its maps and its way to give numbers.

Kernel exceptions are not all subclasses of `Standard_Failure` and may have an empty text, so they are told by the
module that they come from. Values are taken out as arrays at once; `.Coord()` into one list is the quickest way out.
"""

import re
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import numpy as np
from OCP.BRepAdaptor import BRepAdaptor_Surface
from OCP.gp import gp_Pnt, gp_Vec
from OCP.Message import Message
from OCP.TColStd import TColStd_Array1OfReal
from OCP.TopAbs import TopAbs_EDGE, TopAbs_FACE
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


@contextmanager
def translated(
    doing: str, *, error: type[CadIoError] = CadIoError, file: str | None = None, face: str | None = None
) -> Iterator[None]:
    """Turn any kernel exception inside the block into `error`.

    Parameters
    ----------
    doing : str
        What was being done, as in "reading the file".
    error : type
        The CadIoError subclass to raise.
    file, face : str, optional
        Where it happened.

    Raises
    ------
    CadIoError
        Of the class asked for; errors that are not the kernel's pass unchanged.
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
    found = TopTools_IndexedMapOfShape()
    TopExp.MapShapes_s(shape, kind, found)
    return found


def faces(shape: TopoDS_Shape) -> list[TopoDS_Face]:
    """Faces in the order of the kernel's map: face number i is `faces(shape)[i - 1]`."""
    found = shape_map(shape, TopAbs_FACE)
    return [TopoDS.Face_s(found.FindKey(i)) for i in range(1, found.Extent() + 1)]


def explore(shape: TopoDS_Shape, kind: Any, avoid: Any = None) -> Iterator[TopoDS_Shape]:
    """Every occurrence of a kind of sub-shape, oriented as in `shape`; those inside a shape of kind `avoid` not."""
    explorer = TopExp_Explorer(shape, kind) if avoid is None else TopExp_Explorer(shape, kind, avoid)
    while explorer.More():
        yield explorer.Current()
        explorer.Next()


def edges_of(face: TopoDS_Face) -> list[TopoDS_Edge]:
    """Edge uses of a face; a seam occurs twice."""
    return [TopoDS.Edge_s(edge) for edge in explore(face, TopAbs_EDGE)]


def values(adaptor: BRepAdaptor_Surface, u: Floats, v: Floats) -> Floats:
    """Surface points, (n, 3) mm, at parameters u, v of shape (n,); NaN where the kernel refuses."""
    value = adaptor.Value
    try:
        rows = [value(a, b).Coord() for a, b in zip(u.tolist(), v.tolist(), strict=True)]
    except Exception as thrown:
        if not is_kernel_error(thrown):
            raise
        rows = [_value_or_nan(adaptor, a, b) for a, b in zip(u.tolist(), v.tolist(), strict=True)]
    return np.array(rows, dtype=float).reshape(-1, 3)


def _value_or_nan(adaptor: BRepAdaptor_Surface, u: float, v: float) -> tuple[float, float, float]:
    try:
        return adaptor.Value(u, v).Coord()
    except Exception as thrown:
        if not is_kernel_error(thrown):
            raise
        return (np.nan, np.nan, np.nan)


def first_derivatives(adaptor: BRepAdaptor_Surface, u: Floats, v: Floats) -> Floats:
    """S, Su, Sv as (n, 3, 3) at parameters u, v of shape (n,); NaN rows where the kernel refuses."""
    return _derivatives(adaptor.D1, u, v, 2)


def second_derivatives(adaptor: BRepAdaptor_Surface, u: Floats, v: Floats) -> Floats:
    """S, Su, Sv, Suu, Svv, Suv as (n, 6, 3) at parameters u, v of shape (n,); NaN rows where the kernel refuses."""
    return _derivatives(adaptor.D2, u, v, 5)


def _derivatives(evaluate: Any, u: Floats, v: Floats, count: int) -> Floats:
    point = gp_Pnt()
    vectors = [gp_Vec() for _ in range(count)]
    outs = (point, *vectors)
    flat: list[float] = []
    for a, b in zip(u.tolist(), v.tolist(), strict=True):
        try:
            evaluate(a, b, *outs)
        except Exception as thrown:
            if not is_kernel_error(thrown):
                raise
            flat.extend([np.nan] * (3 * (count + 1)))
            continue
        for out in outs:
            flat.extend(out.Coord())
    return np.array(flat, dtype=float).reshape(-1, count + 1, 3)


def interval_ends(count: int, intervals: Any, continuity: Any) -> Floats:
    """Ends (count + 1,) of the intervals in which a curve or surface is that smooth, by its own `...Intervals`."""
    ends = TColStd_Array1OfReal(1, count + 1)
    intervals(ends, continuity)
    return np.array([ends.Value(i) for i in range(1, count + 2)])
