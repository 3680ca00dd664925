"""Faces on common edges: the kernel's faces, made anew on their own surfaces, so that faces that touch share edges.

Nothing is moved. A common edge runs along the curve of the first face; in the parameter plane of another it has a line of its
own, fitted to what that face's own edge has at the same points. Vertices are left out: nobody asks for them.
"""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from OCP.BRep import BRep_Builder, BRep_Tool
from OCP.BRepAdaptor import BRepAdaptor_Curve2d
from OCP.Geom2d import Geom2d_BSplineCurve
from OCP.TopAbs import TopAbs_FORWARD, TopAbs_REVERSED
from OCP.TopoDS import TopoDS, TopoDS_Edge, TopoDS_Face
from OCP.TopTools import TopTools_IndexedMapOfShape

from cad_io.arrays import Floats
from cad_io.kernel import along, may_refuse
from cad_io.kernel.components import children
from cad_io.kernel.splines import cubic
from cad_io.part.coincide import Group, Piece
from cad_io.part.curves import Curves

#: An edge with its uses: see `edge_uses`. A part of one: where it begins, the common edge, and whether it runs as that does.
Use = tuple[TopoDS_Edge, list[tuple[int, int]]]
Part = tuple[float, TopoDS_Edge, int]

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

    Parameters
    ----------
    shapes : sequence of TopoDS_Face
    sources : sequence of (edge, uses)
        Their edges, as `edge_uses` gives them.
    curves : Curves
        Of these edges.
    groups : sequence of Group
        All of them.
    gone : sequence of Piece
        What is left out of its face.
    tolerance : float
        How far the pieces of one group may be apart, mm.
    """
    parts: dict[int, list[Part]] = {}
    changed_groups = [group for group in groups if len(group.pieces) > 1 or _cut(curves, group)]
    fits = iter(_fits(curves, changed_groups))
    for group in changed_groups:
        edge = _common(sources[group.pieces[0].edge][0], group.pieces[0], tolerance)
        for number, (piece, way) in enumerate(zip(group.pieces, group.way, strict=True)):
            parts.setdefault(piece.edge, []).append((piece.low, edge, way))
            if number:
                source, uses = sources[piece.edge]
                fit = next(fits)
                for face, _ in uses:
                    _lie_on(edge, shapes[face], fit, source)
    for piece in gone:
        parts.setdefault(piece.edge, [])
    index = TopTools_IndexedMapOfShape()
    instead = {index.Add(sources[place][0]): sorted(edges, key=lambda x: x[0]) for place, edges in parts.items()}
    changed = {face for place in parts for face, _ in sources[place][1]}
    return [_rebuilt(shape, index, instead) if i in changed else shape for i, shape in enumerate(shapes)]


def _cut(curves: Curves, group: Group) -> bool:
    """Whether a group is a part of an edge."""
    edge, low, high = group.pieces[0]
    return bool(curves.drawn[edge] and (low > curves.low[edge] or high < curves.high[edge]))


def _common(source: TopoDS_Edge, piece: Piece, tolerance: float) -> TopoDS_Edge:
    """An edge along a piece of another."""
    builder, edge = BRep_Builder(), TopoDS.Edge_s(source.EmptyCopied().Oriented(TopAbs_FORWARD))
    builder.Range(edge, piece.low, piece.high)
    builder.UpdateEdge(edge, max(tolerance, BRep_Tool.Tolerance_s(edge)))
    return edge


def _lie_on(edge: TopoDS_Edge, face: TopoDS_Face, fit: "_Fit", source: TopoDS_Edge) -> None:
    """Give an edge a line in the parameter plane of a face, that of the face's own edge."""
    low, high = BRep_Tool.Range_s(edge)
    # Where two faces of a group lie on one surface, the line of the first holds: it runs through the same points.
    if BRep_Tool.CurveOnSurface_s(edge, face, low, high) is not None:
        return
    line = fit.on(source, face)
    if line is not None:
        builder = BRep_Builder()
        builder.UpdateEdge(edge, line, face, BRep_Tool.Tolerance_s(edge))
        builder.Range(edge, face, low, high)


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

    def on(self, edge: TopoDS_Edge, face: TopoDS_Face) -> Geom2d_BSplineCurve | None:
        """The other edge's line in the parameter plane of a face, by the common parameter; None where it has none."""
        with may_refuse():
            p, d = np.moveaxis(along(BRepAdaptor_Curve2d(edge, face), self.there), 1, 0)
            return _hermite(self.t, p, d * self.speed[:, None])
        return None


def _hermite(t: Floats, p: Floats, d: Floats) -> Geom2d_BSplineCurve:
    """The cubic spline with points and derivatives (k, 2) at parameters (k,)."""
    third = (np.diff(t) / 3)[:, None]
    after, before = p[:-1] + third * d[:-1], p[1:] - third * d[1:]
    poles = np.concatenate([p[:1], np.stack([after, before], axis=1).reshape(-1, 2), p[-1:]])
    return cubic(np.concatenate([t[:1], t[:1], np.repeat(t, 2), t[-1:], t[-1:]]), poles)


def _rebuilt(face: TopoDS_Face, index: TopTools_IndexedMapOfShape, instead: dict[int, list[Part]]) -> TopoDS_Face:
    """The face with other edges on its borders."""
    builder, forward = BRep_Builder(), face.Oriented(TopAbs_FORWARD)
    made = forward.EmptyCopied()
    for border in children(forward):
        oriented = border.Oriented(TopAbs_FORWARD)
        fresh = oriented.EmptyCopied()
        for edge in children(oriented):
            # Internal edges are nobody's border.
            way = {TopAbs_FORWARD: 1, TopAbs_REVERSED: -1}.get(edge.Orientation(), 0)
            parts = instead.get(index.FindIndex(edge)) if way else None
            for _, common, same in parts or ():
                builder.Add(fresh, common.Oriented(TopAbs_FORWARD if same * way > 0 else TopAbs_REVERSED))
            if parts is None:
                builder.Add(fresh, edge)
        builder.Add(made, fresh.Oriented(border.Orientation()))
    return TopoDS.Face_s(made.Oriented(face.Orientation()))
