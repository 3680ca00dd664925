"""Which faces that stand in no solid belong together? Edges that coincide are joined on a ladder of tolerances.

Each rung goes on from the one before, so what fits closely is joined closely, and a rung counts only if it leaves less
open. The first that leaves nothing open is the last. The part itself is not changed: the joined faces lie on the same
surfaces, and only say who is whose neighbour.
"""

import math
from collections import defaultdict
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from OCP.BRep import BRep_Tool
from OCP.BRepAdaptor import BRepAdaptor_Curve
from OCP.GCPnts import GCPnts_AbscissaPoint
from OCP.TopAbs import TopAbs_FACE, TopAbs_SOLID
from OCP.TopoDS import TopoDS, TopoDS_Edge, TopoDS_Face, TopoDS_Shape
from OCP.TopTools import TopTools_IndexedMapOfShape

from cad_io.kernel import bounding, explore, may_refuse, shape_map
from cad_io.part.coincide import Group, Piece, TooMany, coinciding, points
from cad_io.part.common_edges import on_common_edges
from cad_io.part.curves import Curves
from cad_io.part.packing import packed_faces, unpacked_faces

#: Tolerances to try, as shares of the part's diagonal; in mm none below the kernel's precision nor above the most.
RUNGS = (1e-6, 1e-5, 1e-4, 1e-3)
LEAST, MOST = 1e-6, 0.1
#: A rung that takes less than this share of the open length has joined nothing.
_GAIN = 1e-3
#: Share of the first tolerance by which curves may be drawn beside themselves.
_CHORD = 0.05


@dataclass(frozen=True, slots=True)
class Sewn:
    """Faces that stand in no solid, joined where their edges coincide."""

    #: By number; faces that touch share their edges. Empty where all faces stand in solids.
    faces: dict[int, TopoDS_Face]
    #: Of the rung that was kept, mm; None where no rung joined anything.
    tolerance: float | None
    #: Of the last rung, mm; None where there was nothing to join.
    tried: float | None
    #: Edges that still belong to one face alone.
    open_edges: int
    #: Their length, mm.
    open_length: float
    #: Why the ladder ended before its time; None where it did not.
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
    shell = join([faces[number - 1] for number in numbers], diagonal)
    open_edges, length = len(shell.left), float(sum(shell.left))
    return Sewn(dict(zip(numbers, shell.faces, strict=True)), shell.kept, shell.tried, open_edges, length, shell.stopped)


class SewnForm(NamedTuple):
    """A `Sewn` without anything of the kernel's: the numbers of its faces, the faces as bytes, and the rest as it stands."""

    numbers: tuple[int, ...]
    faces: bytes
    tolerance: float | None
    tried: float | None
    open_edges: int
    open_length: float
    stopped: str | None

    @classmethod
    def of(cls, sewn: Sewn) -> "SewnForm":
        faces = packed_faces(list(sewn.faces.values())) if sewn.faces else b""
        return cls(tuple(sewn.faces), faces, sewn.tolerance, sewn.tried, sewn.open_edges, sewn.open_length, sewn.stopped)

    def sewn(self) -> Sewn:
        faces = unpacked_faces(self.faces) if self.numbers else []
        by_number = dict(zip(self.numbers, faces, strict=True))
        return Sewn(by_number, self.tolerance, self.tried, self.open_edges, self.open_length, self.stopped)


class Join(NamedTuple):
    """Faces that share edges; `kept`, `tried` and `stopped` as in `Sewn`; `left`: the length of each open edge, mm."""

    faces: list[TopoDS_Face]
    kept: float | None
    tried: float | None
    left: list[float]
    stopped: str | None


def join(shapes: Sequence[TopoDS_Face], diagonal: float) -> Join:
    """Join faces on the ladder of tolerances for a part of a diagonal, mm."""
    sources = edge_uses(shapes)
    if len(shapes) < 2 or all(len(users) > 1 for _, users in sources):
        return Join(list(shapes), None, None, _open(sources), None)
    faces = [tuple(face for face, _ in users) for _, users in sources]
    curves = Curves([edge for edge, _ in sources], _CHORD * next(_ladder(diagonal)))
    groups = [Group((Piece(i, float(curves.low[i]), float(curves.high[i])),), (1,)) for i in range(len(sources))]
    blank = sum(not polyline and len(users) == 1 for polyline, users in zip(curves.drawn.tolist(), faces, strict=True))
    stopped = f"the curves of {blank} open edges cannot be followed" if blank else None
    open_edges, best, tried, gone = _open_length(curves, faces, groups), None, None, list[Piece]()
    for tolerance in _ladder(diagonal):
        if not _alone(faces, groups):
            break
        tried = tolerance
        try:
            pairs = coinciding(curves, faces, groups, tolerance)
            no_more = set(points(curves, faces, pairs, tolerance))
        except TooMany:
            stopped = f"more ends of edges lie within {tolerance:.3g} mm of each other than can be compared"
            break
        pairs = [group for group in pairs if group not in no_more]
        after = _open_length(curves, faces, pairs)
        if after < (1 - _GAIN) * open_edges:
            best, groups, open_edges = tolerance, pairs, after
            gone += [group.pieces[0] for group in no_more]
    now = list(shapes) if best is None else on_common_edges(shapes, sources, curves, groups, gone, best)
    return Join(now, best, tried, _open(edge_uses(now)), stopped)


def _alone(faces: Sequence[tuple[int, ...]], groups: Sequence[Group]) -> list[Piece]:
    """The pieces that one face has alone."""
    return [g.pieces[0] for g in groups if len(g.pieces) == 1 and len(faces[g.pieces[0].edge]) == 1]


def _open_length(curves: Curves, faces: Sequence[tuple[int, ...]], groups: Sequence[Group]) -> float:
    """Open length, mm, as far as it could be drawn."""
    alone = [piece for piece in _alone(faces, groups) if curves.drawn[piece.edge]]
    edge = np.array([piece.edge for piece in alone], np.intp)
    low, high = (np.array([piece[k] for piece in alone], float) for k in (1, 2))
    return float((curves.length(edge, high) - curves.length(edge, low)).sum())


def edge_uses(shapes: Sequence[TopoDS_Face]) -> list[tuple[TopoDS_Edge, list[tuple[int, int]]]]:
    """Every edge that is not degenerated with its uses: place of the face in `shapes`, and +1 or -1 for the direction.

    Directions are those of the face seen with its surface's own normal. A seam is used twice by one face.
    """
    edges = TopTools_IndexedMapOfShape()
    uses: dict[int, list[tuple[int, int]]] = defaultdict(list)
    for i, face in enumerate(shapes):
        for edge, way in bounding(face)[1]:
            if not BRep_Tool.Degenerated_s(edge):
                uses[edges.Add(edge)].append((i, way))
    return [(TopoDS.Edge_s(edges.FindKey(index)), users) for index, users in uses.items()]


def neighbours(shapes: Sequence[TopoDS_Face]) -> tuple[tuple[int, ...], ...]:
    """Numbers from 1 of the faces that share an edge with each face, ascending, without itself."""
    across: list[set[int]] = [set() for _ in shapes]
    for _, users in edge_uses(shapes):
        on = {i for i, _ in users}
        for i in on:
            across[i] |= on
    return tuple(tuple(sorted(j + 1 for j in each if j != i)) for i, each in enumerate(across))


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


def _open(uses: Sequence[tuple[TopoDS_Edge, list[tuple[int, int]]]]) -> list[float]:
    """Length of each edge that belongs to one face alone, mm."""
    return [_length(edge) for edge, users in uses if len(users) == 1]


def _length(edge: TopoDS_Edge) -> float:
    with may_refuse():
        length = float(GCPnts_AbscissaPoint.Length_s(BRepAdaptor_Curve(edge)))
        if math.isfinite(length):
            return length
    # A damaged curve: the face lives by the one in its parameter plane.
    return 0.0
