"""Which faces that stand in no solid belong together? Edges that coincide are joined on a ladder of tolerances.

Each rung goes on from the one before, so what fits closely is joined closely, and a rung counts only if it leaves less
open. The first that leaves nothing open is the last. The part itself is not changed: the joined faces lie on the same
surfaces, and only say who is whose neighbour.

A copy of the process joins, rung by rung. One that takes longer than its edges explain, or crashes, ends the ladder: the
faces stay as the rungs before it left them.
"""

import io
import math
from collections import defaultdict
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import NamedTuple

from OCP.BinTools import BinTools
from OCP.BRep import BRep_Tool
from OCP.BRepAdaptor import BRepAdaptor_Curve
from OCP.BRepBuilderAPI import BRepBuilderAPI_Sewing
from OCP.GCPnts import GCPnts_AbscissaPoint
from OCP.TopAbs import TopAbs_EDGE, TopAbs_FACE, TopAbs_FORWARD, TopAbs_REVERSED, TopAbs_SOLID
from OCP.TopoDS import TopoDS, TopoDS_Edge, TopoDS_Face, TopoDS_Shape
from OCP.TopTools import TopTools_IndexedMapOfShape

from cad_io.kernel import edges_of, explore, is_kernel_error, shape_map
from cad_io.kernel.components import children, compound
from cad_io.kernel.limited import ChildDied, TimeLimit, limited

#: Tolerances to try, as shares of the part's diagonal; in mm none below the kernel's precision nor above the most.
RUNGS = (1e-6, 1e-5, 1e-4, 1e-3)
LEAST, MOST = 1e-6, 0.1
#: A rung that takes less than this share of the open length has joined nothing.
_GAIN = 1e-3
#: Processor seconds that a rung may take, and more for each open edge: 2 to 5 ms each are usual.
SECONDS, _AN_EDGE = 20.0, 0.02


@dataclass(frozen=True, slots=True)
class Sewn:
    """Faces that stand in no solid, joined where their edges coincide.

    Attributes
    ----------
    faces : dict
        By number; faces that touch share their edges. Empty where all faces stand in solids.
    tolerance : float, optional
        Of the rung that was kept, mm; None where no rung joined anything.
    tried : float, optional
        Of the last rung, mm; None where there was nothing to join.
    open_edges : int
        Edges that still belong to one face alone.
    open_length : float
        Their length, mm.
    stopped : str, optional
        Why the ladder ended before its time; None where it did not.
    """

    faces: dict[int, TopoDS_Face]
    tolerance: float | None
    tried: float | None
    open_edges: int
    open_length: float
    stopped: str | None = None


def sew(shape: TopoDS_Shape, faces: Sequence[TopoDS_Face], diagonal: float) -> Sewn:
    """Join the faces of a shape that stand in no solid.

    Parameters
    ----------
    shape : TopoDS_Shape
    faces : sequence of TopoDS_Face
        Its faces, by number from 1.
    diagonal : float
        Of its box, mm.
    """
    numbers = _outside_solids(shape)
    found = join([faces[number - 1] for number in numbers], diagonal)
    open_edges, length = len(found.left), float(sum(found.left))
    return Sewn(
        dict(zip(numbers, found.faces, strict=True)), found.kept, found.tried, open_edges, length, found.stopped
    )


class Join(NamedTuple):
    """Faces that share edges; `kept`, `tried` and `stopped` as in `Sewn`; `left`: the length of each open edge, mm."""

    faces: list[TopoDS_Face]
    kept: float | None
    tried: float | None
    left: list[float]
    stopped: str | None


def join(shapes: Sequence[TopoDS_Face], diagonal: float) -> Join:
    """Join faces on the ladder of tolerances for a part of a diagonal, mm."""
    now = list(shapes)
    left, kept, tried, stopped = _open(now), None, None, None
    for tolerance in _ladder(diagonal):
        if not left or len(now) < 2:
            break
        tried = tolerance
        try:
            joined = _bounded(now, tolerance, SECONDS + _AN_EDGE * len(left), sum(left))
        except TimeLimit:
            stopped = f"the CAD kernel does not come to an end of joining edges within {tolerance:.3g} mm"
        except ChildDied as died:
            stopped = f"the CAD kernel fails to join edges within {tolerance:.3g} mm ({died})"
        if stopped:
            break
        if joined is not None:
            kept, now, left = tolerance, joined, _open(joined)
    return Join(now, kept, tried, left, stopped)


def _bounded(
    shapes: Sequence[TopoDS_Face], tolerance: float, seconds: float, before: float
) -> list[TopoDS_Face] | None:
    """`_joined` in a copy of the process; None where it leaves about as much open as `before`, mm."""

    def work() -> bytes:
        joined = _joined(shapes, tolerance)
        if not sum(_open(joined)) < (1 - _GAIN) * before:
            return b""
        stream = io.BytesIO()
        BinTools.Write_s(compound(joined), stream)
        return stream.getvalue()

    data = limited(work, seconds, processor=True)
    if not data:
        return None
    whole = TopoDS_Shape()
    BinTools.Read_s(whole, io.BytesIO(data))
    return [TopoDS.Face_s(face) for face in children(whole)]


def edge_uses(shapes: Sequence[TopoDS_Face]) -> list[tuple[TopoDS_Edge, list[tuple[int, int]]]]:
    """Every edge that is not degenerated with its uses: place of the face in `shapes`, and +1 or -1 for the direction.

    Directions are those of the face seen with its surface's own normal. A seam is used twice by one face.
    """
    edges = TopTools_IndexedMapOfShape()
    uses: dict[int, list[tuple[int, int]]] = defaultdict(list)
    for i, face in enumerate(shapes):
        for edge in edges_of(TopoDS.Face_s(face.Oriented(TopAbs_FORWARD))):
            if edge.Orientation() in (TopAbs_FORWARD, TopAbs_REVERSED) and not BRep_Tool.Degenerated_s(edge):
                uses[edges.Add(edge)].append((i, 1 if edge.Orientation() == TopAbs_FORWARD else -1))
    return [(TopoDS.Edge_s(edges.FindKey(index)), users) for index, users in uses.items()]


def _outside_solids(shape: TopoDS_Shape) -> list[int]:
    numbers = shape_map(shape, TopAbs_FACE)
    loose = {numbers.FindIndex(face) for face in explore(shape, TopAbs_FACE, TopAbs_SOLID)}
    solid = {numbers.FindIndex(face) for whole in explore(shape, TopAbs_SOLID) for face in explore(whole, TopAbs_FACE)}
    return sorted(loose - solid)


def _ladder(diagonal: float) -> Iterator[float]:
    last = 0.0
    for share in RUNGS:
        tolerance = min(max(share * diagonal, LEAST), MOST)
        if tolerance > last:
            yield tolerance
        last = tolerance


def _joined(shapes: Sequence[TopoDS_Face], tolerance: float) -> list[TopoDS_Face]:
    """The faces after joining edges that coincide; a face that sewing drops stays as it was."""
    # More than two faces may share an edge: where two bodies touch, pairing them off would join one with the other.
    sewing = BRepBuilderAPI_Sewing(tolerance, True, True, True, True)
    for face in shapes:
        sewing.Add(face)
    sewing.Perform()
    result = []
    for face in shapes:
        joined = sewing.ModifiedSubShape(face) if sewing.IsModifiedSubShape(face) else face
        whole = not joined.IsNull() and joined.ShapeType() == TopAbs_FACE and any(explore(joined, TopAbs_EDGE))
        result.append(TopoDS.Face_s(joined) if whole else face)
    return result


def _open(shapes: Sequence[TopoDS_Face]) -> list[float]:
    """Length of each edge that belongs to one face alone, mm."""
    return [_length(edge) for edge, users in edge_uses(shapes) if len(users) == 1]


def _length(edge: TopoDS_Edge) -> float:
    try:
        length = float(GCPnts_AbscissaPoint.Length_s(BRepAdaptor_Curve(edge)))
        # A damaged curve: the face lives by the one in its parameter plane.
        return length if math.isfinite(length) else 0.0
    except Exception as thrown:
        if not is_kernel_error(thrown):
            raise
        return 0.0
