"""Which faces that stand in no solid belong together? Edges that coincide are joined on a ladder of tolerances.

Each rung goes on from the one before, so what fits closely is joined closely, and a rung counts only if it leaves less
open. The first that leaves nothing open is the last. The part itself is not changed: the joined faces lie on the same
surfaces, and only say who is whose neighbour.

Faces on common edges are made anew on their own surfaces, and nothing is moved. A common edge runs along the curve of the first
face; in the parameter plane of another it has a line of its own, fitted to what that face's own edge has at the same points.
Vertices are left out: nobody asks for them.
"""

import math
from collections import defaultdict
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
from OCP.BRep import BRep_Builder, BRep_Tool
from OCP.BRepAdaptor import BRepAdaptor_Curve, BRepAdaptor_Curve2d
from OCP.GCPnts import GCPnts_AbscissaPoint
from OCP.TopAbs import TopAbs_FACE, TopAbs_FORWARD, TopAbs_REVERSED, TopAbs_SOLID
from OCP.TopoDS import TopoDS, TopoDS_Edge, TopoDS_Face, TopoDS_Shape
from OCP.TopTools import TopTools_IndexedMapOfShape

from cad_io.arrays import Floats
from cad_io.kernel import along, bounding, cubic, explore, may_refuse, shape_map
from cad_io.kernel.shapes import as_bytes, children, compound, of_bytes, with_edges
from cad_io.part.coincide import Curves, Group, Piece, TooMany, coinciding, points

#: An edge with its uses: see `edge_uses`. A part of one: where it begins, the common edge, and whether it runs as that does.
Use = tuple[TopoDS_Edge, list[tuple[int, int]]]
EdgePart = tuple[float, TopoDS_Edge, int]
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
    """Join the faces of a shape (by number from 1) that stand in no solid; `diagonal`: of its box, mm."""
    known = shape_map(shape, TopAbs_FACE)
    loose = {known.FindIndex(face) for face in explore(shape, TopAbs_FACE, TopAbs_SOLID)}
    solid = {known.FindIndex(face) for whole in explore(shape, TopAbs_SOLID) for face in explore(whole, TopAbs_FACE)}
    numbers = sorted(loose - solid)
    return join({number: faces[number - 1] for number in numbers}, diagonal)


class SewnForm(NamedTuple):
    """A `Sewn` without anything of the kernel's: the numbers of its faces, the faces as bytes, and the rest as it stands."""

    numbers: tuple[int, ...]
    faces: bytes
    rest: Sewn

    @classmethod
    def of(cls, sewn: Sewn) -> "SewnForm":
        faces = as_bytes(compound(list(sewn.faces.values()))) if sewn.faces else b""
        return cls(tuple(sewn.faces), faces, replace(sewn, faces={}))

    def sewn(self) -> Sewn:
        faces = map(TopoDS.Face_s, children(of_bytes(self.faces))) if self.numbers else ()
        return replace(self.rest, faces=dict(zip(self.numbers, faces, strict=True)))


def join(numbered: Mapping[int, TopoDS_Face], diagonal: float) -> Sewn:
    """Join faces, by their numbers, on the ladder of tolerances for a part of a diagonal, mm."""
    shapes = [*numbered.values()]
    sources = edge_uses(shapes)
    if len(shapes) < 2 or all(len(users) > 1 for _, users in sources):
        return Sewn(dict(numbered), None, None, *_open(sources))
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
    return Sewn(dict(zip(numbered, now, strict=True)), best, tried, *_open(edge_uses(now)), stopped)


def _alone(faces: Sequence[tuple[int, ...]], groups: Sequence[Group]) -> list[Piece]:
    """The pieces that one face has alone."""
    return [g.pieces[0] for g in groups if len(g.pieces) == 1 and len(faces[g.pieces[0].edge]) == 1]


def _open_length(curves: Curves, faces: Sequence[tuple[int, ...]], groups: Sequence[Group]) -> float:
    """Open length, mm, as far as it could be drawn."""
    alone = [piece for piece in _alone(faces, groups) if curves.drawn[piece.edge]]
    edge = np.array([piece.edge for piece in alone], np.intp)
    low, high = (np.array([piece[k] for piece in alone], float) for k in (1, 2))
    return float((curves.length(edge, high) - curves.length(edge, low)).sum())


def edge_uses(shapes: Sequence[TopoDS_Face]) -> list[Use]:
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


def _ladder(diagonal: float) -> Iterator[float]:
    last = 0.0
    for share in RUNGS:
        tolerance = min(max(share * diagonal, LEAST), MOST)
        if tolerance > last:
            yield tolerance
        last = tolerance


def _open(uses: Sequence[Use]) -> tuple[int, float]:
    """How many edges belong to one face alone, and their length, mm."""
    alone, lengths = [edge for edge, users in uses if len(users) == 1], list[float]()
    for edge in alone:
        with may_refuse():
            lengths.append(float(GCPnts_AbscissaPoint.Length_s(BRepAdaptor_Curve(edge))))
    # Of a damaged curve there is none: the face lives by the one in its parameter plane.
    return len(alone), float(sum(filter(math.isfinite, lengths)))


#: A common edge has at least so many points in a parameter plane.
_LEAST = 9
#: Of the ends of a curve's pieces, every so many is a point there.
_EVERY = 4


def on_common_edges(
    shapes: Sequence[TopoDS_Face],
    sources: Sequence[Use],
    curves: Curves,
    groups: Sequence[Group],
    gone: Sequence[Piece],
    tolerance: float,
) -> list[TopoDS_Face]:
    """Faces that use one edge for each group of pieces.

    sources: their edges, as `edge_uses` gives them, and `curves` of these. groups: all of them. gone: what is left out of its
    face. tolerance: how far the pieces of one group may be apart, mm.
    """
    parts: dict[int, list[EdgePart]] = {}
    changed_groups = [group for group in groups if len(group.pieces) > 1 or curves.is_cut(group.pieces[0])]
    fits = iter(_fits(curves, changed_groups))
    for group in changed_groups:
        piece, builder = group.pieces[0], BRep_Builder()
        edge = TopoDS.Edge_s(sources[piece.edge][0].EmptyCopied().Oriented(TopAbs_FORWARD))
        builder.Range(edge, piece.low, piece.high)
        builder.UpdateEdge(edge, max(tolerance, BRep_Tool.Tolerance_s(edge)))
        for number, (piece, way) in enumerate(zip(group.pieces, group.way, strict=True)):
            parts.setdefault(piece.edge, []).append((piece.low, edge, way))
            if number:
                source, uses = sources[piece.edge]
                fit = next(fits)
                for face, _ in uses:
                    fit.lay(edge, shapes[face], source)
    for piece in gone:
        parts.setdefault(piece.edge, [])
    index = TopTools_IndexedMapOfShape()
    instead = {index.Add(sources[place][0]): sorted(edges, key=lambda x: x[0]) for place, edges in parts.items()}
    changed = {face for place in parts for face, _ in sources[place][1]}

    def common_edges(edge: TopoDS_Shape) -> list[TopoDS_Shape]:
        # Internal edges are nobody's border.
        way = {TopAbs_FORWARD: 1, TopAbs_REVERSED: -1}.get(edge.Orientation(), 0)
        new = instead.get(index.FindIndex(edge)) if way else None
        if new is None:
            return [edge]
        return [common.Oriented(TopAbs_FORWARD if same * way > 0 else TopAbs_REVERSED) for _, common, same in new]

    return [with_edges(shape, common_edges) if i in changed else shape for i, shape in enumerate(shapes)]


def _fits(curves: Curves, groups: Sequence[Group]) -> "list[_Fit]":
    """How each piece but the first of each group runs along that first one."""
    rows = [(group.pieces[0], piece, way) for group in groups for piece, way in zip(group.pieces[1:], group.way[1:], strict=True)]
    if not rows:
        return []
    spans = [curves.breaks(*first) for first, _, _ in rows]
    # Pieces of curves are far finer than what is asked of a parameter plane.
    spans = [np.append(t[:-1:_EVERY], t[-1]) for t in spans]
    spans = [t if len(t) >= _LEAST else np.linspace(t[0], t[-1], _LEAST) for t in spans]
    counts = [len(t) for t in spans]
    starts = np.cumsum([0, *counts])
    t = np.concatenate(spans)

    def each(values: list[float]) -> Floats:
        return np.repeat(np.array(values, float), counts)

    here = np.repeat(np.array([first.edge for first, _, _ in rows], np.intp), counts)
    there = np.repeat(np.array([piece.edge for _, piece, _ in rows], np.intp), counts)
    low, high = each([piece.low for _, piece, _ in rows]), each([piece.high for _, piece, _ in rows])
    forward = each([way for _, _, way in rows]) > 0
    point, along = curves.at(here, t)
    length = curves.length(here, t)
    begin, end = np.repeat(length[starts[:-1]], counts), np.repeat(length[starts[1:] - 1], counts)
    share = (length - begin) / (end - begin)
    share = np.where(forward, share, 1 - share)
    begin, end = curves.length(there, low), curves.length(there, high)
    guess = curves.at_length(there, begin + share * (end - begin)).clip(low, high)
    s, _ = curves.near(there, guess, low, high, point)
    ends = np.concatenate([starts[:-1], starts[1:] - 1])
    s[ends] = np.where(share < 0.5, low, high)[ends]
    tangent = curves.at(there, s)[1]
    with np.errstate(all="ignore"):
        speed = (along * tangent).sum(axis=1) / (tangent * tangent).sum(axis=1)
    return [_Fit.of(t[a:b], s[a:b], speed[a:b], way) for a, b, (_, _, way) in zip(starts[:-1], starts[1:], rows, strict=True)]


class _Fit(NamedTuple):
    """Parameters (k,) of a common edge, those (k,) of another edge at the same points, and how fast these run there."""

    t: Floats
    there: Floats
    speed: Floats

    @classmethod
    def of(cls, t: Floats, s: Floats, speed: Floats, way: int) -> "_Fit":
        s = np.maximum.accumulate(s) if way > 0 else np.minimum.accumulate(s)
        return cls(t, s, speed if np.isfinite(speed).all() else np.gradient(s, t))

    def lay(self, common: TopoDS_Edge, face: TopoDS_Face, edge: TopoDS_Edge) -> None:
        """Give the common edge the other edge's line in the parameter plane of a face, where it has one."""
        low, high = BRep_Tool.Range_s(common)
        # Where two faces of a group lie on one surface, the line of the first holds: it runs through the same points.
        if BRep_Tool.CurveOnSurface_s(common, face, low, high) is not None:
            return
        with may_refuse():
            p, d = np.moveaxis(along(BRepAdaptor_Curve2d(edge, face), self.there), 1, 0)
            t, d = self.t, d * self.speed[:, None]
            # The cubic spline with these points and derivatives (k, 2).
            third = (np.diff(t) / 3)[:, None]
            after, before = p[:-1] + third * d[:-1], p[1:] - third * d[1:]
            poles = np.concatenate([p[:1], np.stack([after, before], axis=1).reshape(-1, 2), p[-1:]])
            line = cubic(np.concatenate([t[:1], t[:1], np.repeat(t, 2), t[-1:], t[-1:]]), poles)
            builder = BRep_Builder()
            builder.UpdateEdge(common, line, face, BRep_Tool.Tolerance_s(common))
            builder.Range(common, face, low, high)
