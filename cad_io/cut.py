"""One cut of a shape by edges that lie on its faces, and whether the result can be trusted."""

import io
import pickle
from dataclasses import dataclass
from functools import partial
from typing import Any

from OCP.BinTools import BinTools
from OCP.BRep import BRep_Builder, BRep_Tool
from OCP.BRepAlgoAPI import BRepAlgoAPI_Splitter
from OCP.BRepCheck import BRepCheck_Analyzer
from OCP.BRepTools import BRepTools
from OCP.TopAbs import TopAbs_COMPOUND, TopAbs_FACE, TopAbs_SHELL, TopAbs_SOLID
from OCP.TopoDS import TopoDS, TopoDS_Compound, TopoDS_Iterator, TopoDS_Shape
from OCP.TopTools import TopTools_ListOfShape

from cad_io.kernel import explore, shape_map
from cad_io.limited import ChildDied, TimeLimit, limited
from cad_io.uv_region import uv_area

#: Points closer than this are one, mm: what the kernel's splitter was tried with.
FUZZY = 1e-4
#: Relative error of a face's parameter area that is still the same area.
_SAME_AREA = 1e-5


@dataclass(frozen=True, slots=True)
class Cut:
    """A shape after the cut, and which of its faces each original face became (number -> TopoDS_Face list)."""

    shape: Any
    pieces: dict[int, list[Any]]


def cut(shape: Any, faces: dict[int, Any], edges: dict[int, list[Any]], seconds: float) -> Cut | str:
    """Cut a shape by edges on its faces, in a process of its own with a time limit.

    Parameters
    ----------
    shape : TopoDS_Shape
        Left as it is.
    faces : dict
        Number -> TopoDS_Face, all faces of the shape.
    edges : dict
        Number of a face -> edges on it.
    seconds : float

    Returns
    -------
    Cut or str
        A copy of the shape, cut; or why the cut is no good: the kernel fails, hangs or crashes, the result is invalid
        where the shape was valid, solids, shells or their closedness differ, a face is lost, or the pieces of a face
        do not have its area. Areas are those of the region in the parameter plane, integrated exactly along its
        boundary: pieces that tile the region there tile the face, and the kernel's own areas in mm2 are off by up to
        9 % on some surfaces.
    """
    try:
        answer = limited(partial(_cut, shape, faces, edges), seconds)
    except TimeLimit:
        return "splitting it takes too long"
    except ChildDied as error:
        return f"splitting it fails: {error}"
    reason, data = pickle.loads(answer)
    if reason:
        return str(reason)
    whole = TopoDS_Shape()
    BinTools.Read_s(whole, io.BytesIO(data))
    result, *groups = _children(whole)
    pieces = [[TopoDS.Face_s(f) for f in _children(group)] for group in groups]
    return Cut(result, dict(zip(faces, pieces, strict=True)))


def _cut(shape: Any, faces: dict[int, Any], edges: dict[int, list[Any]]) -> bytes:
    """Pickled (reason, data): data is a compound of the cut shape and, for every face, the compound of its pieces."""
    tools, arguments = TopTools_ListOfShape(), TopTools_ListOfShape()
    arguments.Append(shape)
    for drawn in edges.values():
        for edge in drawn:
            tools.Append(edge)
    splitter = BRepAlgoAPI_Splitter()
    splitter.SetArguments(arguments)
    splitter.SetTools(tools)
    splitter.SetFuzzyValue(FUZZY)
    splitter.SetNonDestructive(True)
    splitter.Build()
    if not splitter.IsDone():
        return pickle.dumps(("the kernel cannot split it", b""))
    result = splitter.Shape()
    # Ends of curves past the trim would stay as loose edges inside solids and faces.
    BRepTools.RemoveInternals_s(result, False)
    if result.ShapeType() == TopAbs_COMPOUND != shape.ShapeType() and len(inner := _children(result)) == 1:
        result = inner[0]

    known = shape_map(result, TopAbs_FACE)
    pieces: dict[int, list[Any]] = {}
    for number, face in faces.items():
        images = list(splitter.Modified(face)) or [face]
        if splitter.IsDeleted(face) or not all(known.Contains(f) for f in images):
            return pickle.dumps((f"splitting loses a piece of F{number}", b""))
        # From the map: with the orientation that the face has in the result.
        pieces[number] = [known.FindKey(known.FindIndex(f)) for f in images]
    reason = _wrong(shape, result, faces, pieces)
    if reason:
        return pickle.dumps((reason, b""))
    stream = io.BytesIO()
    BinTools.Write_s(_compound([result, *(_compound(p) for p in pieces.values())]), stream)
    return pickle.dumps(("", stream.getvalue()))


def _wrong(shape: Any, result: Any, faces: dict[int, Any], pieces: dict[int, list[Any]]) -> str:
    """Why a result is not to be trusted; empty if it is."""
    if _shells(shape) != _shells(result):
        return "splitting changes solids or shells"
    for number, face in faces.items():
        if len(pieces[number]) == 1 and pieces[number][0].IsSame(face):
            continue
        before, after = uv_area(face), sum(uv_area(TopoDS.Face_s(p)) for p in pieces[number])
        if abs(after - before) > _SAME_AREA * abs(before):
            return f"the pieces of F{number} do not have its area (off by {after / before - 1:.1e})"
    if not BRepCheck_Analyzer(result).IsValid() and BRepCheck_Analyzer(shape).IsValid():
        return "splitting makes the shape invalid"
    return ""


def _shells(shape: Any) -> tuple[int, list[bool]]:
    """Number of solids; closedness of all shells, sorted."""
    closed = [bool(BRep_Tool.IsClosed_s(shell)) for shell in explore(shape, TopAbs_SHELL)]
    return shape_map(shape, TopAbs_SOLID).Extent(), sorted(closed)


def _compound(shapes: list[Any]) -> Any:
    builder, compound = BRep_Builder(), TopoDS_Compound()
    builder.MakeCompound(compound)
    for shape in shapes:
        builder.Add(compound, shape)
    return compound


def _children(shape: Any) -> list[Any]:
    out = []
    children = TopoDS_Iterator(shape)
    while children.More():
        out.append(children.Value())
        children.Next()
    return out
