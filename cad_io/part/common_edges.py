"""Faces on common edges: the kernel's faces, made anew on their own surfaces, so that faces that touch share edges.

Nothing is moved. A common edge runs along the curve of the first face; in the parameter plane of another it has a line of its own,
fitted to what that face's own edge has at the same points. Vertices are left out: nobody asks for them.
"""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from OCP.BRep import BRep_Builder, BRep_Tool
from OCP.BRepAdaptor import BRepAdaptor_Curve2d
from OCP.Geom2d import Geom2d_BSplineCurve
from OCP.gp import gp_Pnt2d, gp_Vec2d
from OCP.TColgp import TColgp_Array1OfPnt2d
from OCP.TColStd import TColStd_Array1OfInteger, TColStd_Array1OfReal
from OCP.TopAbs import TopAbs_FORWARD, TopAbs_REVERSED
from OCP.TopoDS import TopoDS, TopoDS_Edge, TopoDS_Face
from OCP.TopTools import TopTools_IndexedMapOfShape

from cad_io.arrays import Floats
from cad_io.kernel import is_kernel_error
from cad_io.kernel.components import children
from cad_io.part.coincide import Group, Piece
from cad_io.part.curves import Curves

#: An edge with its uses: see `edge_uses`. A part of one: where it begins, the common edge, and whether it runs as that does.
Use = tuple[TopoDS_Edge, list[tuple[int, int]]]
Part = tuple[float, TopoDS_Edge, int]

#: A common edge has at least so many points in a parameter plane.
_LEAST = 9


def on_common_edges(
    shapes: Sequence[TopoDS_Face], sources: Sequence[Use], curves: Curves, groups: Sequence[Group], tolerance: float
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
    tolerance : float
        How far the pieces of one group may be apart, mm.
    """
    parts: dict[int, list[Part]] = {}
    for group in groups:
        first = group.pieces[0]
        drawn, low, high = curves.drawn[first.edge], curves.low[first.edge], curves.high[first.edge]
        if len(group.pieces) > 1 or (drawn and (first.low > low or first.high < high)):
            edge = _common(shapes, sources, curves, group, tolerance)
            for piece, way in zip(group.pieces, group.way, strict=True):
                parts.setdefault(piece.edge, []).append((piece.low, edge, way))
    index = TopTools_IndexedMapOfShape()
    instead = {index.Add(sources[place][0]): sorted(found, key=lambda x: x[0]) for place, found in parts.items()}
    changed = {face for place in parts for face, _ in sources[place][1]}
    return [_rebuilt(shape, index, instead) if i in changed else shape for i, shape in enumerate(shapes)]


def _common(
    shapes: Sequence[TopoDS_Face], sources: Sequence[Use], curves: Curves, group: Group, tolerance: float
) -> TopoDS_Edge:
    """One edge for all pieces of a group, with a line in the parameter plane of each face."""
    builder, first = BRep_Builder(), group.pieces[0]
    edge = TopoDS.Edge_s(sources[first.edge][0].EmptyCopied().Oriented(TopAbs_FORWARD))
    builder.Range(edge, first.low, first.high)
    loose = max(tolerance, BRep_Tool.Tolerance_s(edge))
    builder.UpdateEdge(edge, loose)
    for piece, way in zip(group.pieces[1:], group.way[1:], strict=True):
        line = _Fit.of(curves, first, piece, way)
        source, uses = sources[piece.edge]
        for face, _ in uses:
            fitted = line.on(source, shapes[face])
            if fitted is not None:
                _set(builder, edge, fitted, shapes[face], loose)
    return edge


def _set(builder: BRep_Builder, edge: TopoDS_Edge, line: Geom2d_BSplineCurve, face: TopoDS_Face, loose: float) -> None:
    low, high = BRep_Tool.Range_s(edge)
    # Where two faces of a group lie on one surface, the line of the first holds: it runs through the same points.
    if BRep_Tool.CurveOnSurface_s(edge, face, low, high) is None:
        builder.UpdateEdge(edge, line, face, loose)
        builder.Range(edge, face, low, high)


class _Fit(NamedTuple):
    """Parameters (k,) of a common edge, those (k,) of another edge at the same points, and how fast these run there."""

    t: Floats
    there: Floats
    speed: Floats

    @classmethod
    def of(cls, curves: Curves, first: Piece, piece: Piece, way: int) -> "_Fit":
        t = curves.breaks(first.edge, first.low, first.high)
        if len(t) < _LEAST:
            t = np.linspace(first.low, first.high, _LEAST)
        here, there = np.full(len(t), first.edge), np.full(len(t), piece.edge)
        point, along = curves.at(here, t)
        length = curves.length(here, t)
        share = (length - length[0]) / (length[-1] - length[0])
        ends = curves.length(there[:2], np.array([piece.low, piece.high]))
        share = share if way > 0 else 1 - share
        guess = curves.at_length(there, ends[0] + share * (ends[1] - ends[0])).clip(piece.low, piece.high)
        low, high = np.full(len(t), piece.low), np.full(len(t), piece.high)
        s, _ = curves.near(there, guess, low, high, point)
        s[[0, -1]] = (piece.low, piece.high) if way > 0 else (piece.high, piece.low)
        s = np.maximum.accumulate(s) if way > 0 else np.minimum.accumulate(s)
        beside = curves.at(there, s)[1]
        with np.errstate(all="ignore"):
            speed = (along * beside).sum(axis=1) / (beside * beside).sum(axis=1)
        return cls(t, s, np.where(np.isfinite(speed), speed, np.gradient(s, t)))

    def on(self, edge: TopoDS_Edge, face: TopoDS_Face) -> Geom2d_BSplineCurve | None:
        """The other edge's line in the parameter plane of a face, by the common parameter; None where it has none."""
        at, to, flat = gp_Pnt2d(), gp_Vec2d(), []
        try:
            line = BRepAdaptor_Curve2d(edge, face)
            for x in self.there.tolist():
                line.D1(x, at, to)
                flat.append((at.Coord(), to.Coord()))
            p, d = np.moveaxis(np.array(flat), 1, 0)
            return _hermite(self.t, p, d * self.speed[:, None])
        except Exception as thrown:
            if not is_kernel_error(thrown):
                raise
            return None


def _hermite(t: Floats, p: Floats, d: Floats) -> Geom2d_BSplineCurve:
    """The cubic spline with points and derivatives (k, 2) at parameters (k,)."""
    third = (np.diff(t) / 3)[:, None]
    after, before = p[:-1] + third * d[:-1], p[1:] - third * d[1:]
    rows = np.concatenate([p[:1], np.stack([after, before], axis=1).reshape(-1, 2), p[-1:]]).tolist()
    poles = TColgp_Array1OfPnt2d(1, len(rows))
    for i, (u, v) in enumerate(rows, 1):
        poles.SetValue(i, gp_Pnt2d(u, v))
    knots, times = TColStd_Array1OfReal(1, len(t)), TColStd_Array1OfInteger(1, len(t))
    for i, x in enumerate(t.tolist(), 1):
        knots.SetValue(i, x)
        times.SetValue(i, 4 if i in (1, len(t)) else 2)
    return Geom2d_BSplineCurve(poles, knots, times, 3)


def _rebuilt(face: TopoDS_Face, index: TopTools_IndexedMapOfShape, instead: dict[int, list[Part]]) -> TopoDS_Face:
    """The face with other edges on its borders."""
    builder, forward = BRep_Builder(), face.Oriented(TopAbs_FORWARD)
    made = forward.EmptyCopied()
    for border in children(forward):
        ahead = border.Oriented(TopAbs_FORWARD)
        fresh = ahead.EmptyCopied()
        for edge in children(ahead):
            # Internal edges are nobody's border.
            way = {TopAbs_FORWARD: 1, TopAbs_REVERSED: -1}.get(edge.Orientation(), 0)
            parts = instead.get(index.FindIndex(edge), ()) if way else ()
            for _, common, same in parts:
                builder.Add(fresh, common.Oriented(TopAbs_FORWARD if same * way > 0 else TopAbs_REVERSED))
            if not parts:
                builder.Add(fresh, edge)
        builder.Add(made, fresh.Oriented(border.Orientation()))
    return TopoDS.Face_s(made.Oriented(face.Orientation()))
