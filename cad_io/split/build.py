"""Edges made from curves in a face's parameter plane; faces, shells and solids put together again from cut edges."""

from typing import Any, NamedTuple

import numpy as np
from OCP.BRep import BRep_Builder, BRep_Tool
from OCP.gp import gp_Pnt
from OCP.TopAbs import TopAbs_FACE, TopAbs_FORWARD, TopAbs_REVERSED, TopAbs_SHELL
from OCP.TopLoc import TopLoc_Location
from OCP.TopoDS import TopoDS, TopoDS_Edge, TopoDS_Vertex, TopoDS_Wire

from cad_io.arrays import Floats
from cad_io.kernel import cubic, edges_of
from cad_io.kernel.shapes import children, with_edges
from cad_io.split.arrangement import Arrangement, Half, Region
from cad_io.split.border import CannotSplit
from cad_io.split.contour import Spline
from cad_io.split.net import DEVIATION, Net
from cad_io.surface import Surface

_MOST_POINTS = 5000


class Followed(NamedTuple):
    """A curve on a surface: in space and in the parameter plane, range, ends in space, deviation in mm."""

    space: Any
    plane: Any
    first: float
    last: float
    ends: tuple[Any, Any]
    tolerance: float


def trimmed(spline: Spline, a: float, b: float) -> Spline:
    """The same cubic between two of its parameters."""
    from scipy.interpolate import BSpline, make_interp_spline  # half a second to load

    near = 1e-6 * (b - a)
    inner = spline.knots[(spline.knots > a + near) & (spline.knots < b - near)]
    knots = np.concatenate([[a] * 4, inner, [b] * 4])
    # By rounding, means of equal knots lie beyond them.
    averages = np.clip(np.convolve(knots[1:-1], np.ones(3) / 3, mode="valid"), a, b)
    poles = make_interp_spline(averages, BSpline(spline.knots, spline.poles, 3)(averages), k=3, t=knots).c
    return Spline(knots, np.array(poles), False)


def followed(surface: Surface, spline: Spline) -> Followed:
    """Find the cubic curve in space of the same parameter as a parameter curve of a surface; ValueError where DEVIATION cannot be
    reached.

    The kernel's own builder of curves in space stops silently up to 1 mm off (OCCT 7.9); here the surface is interpolated and
    sites are added where the error, measured between the sites, is above DEVIATION.
    """
    from scipy.interpolate import BSpline, make_interp_spline

    curve = BSpline(spline.knots, spline.poles, 3)

    def at(t: Floats) -> Floats:
        return surface.values(*curve(t).T)

    knots = np.unique(spline.knots)
    averages = np.linspace(knots[0], knots[-1], 9) if len(knots) < 5 else np.union1d(knots, 0.5 * (knots[1:] + knots[:-1]))
    while True:
        space = make_interp_spline(averages, at(averages), k=3)
        gap = np.diff(averages)
        between = np.stack([averages[:-1] + share * gap for share in (0.25, 0.5, 0.75)])
        error = np.linalg.norm(space(between.ravel()) - at(between.ravel()), axis=1).reshape(between.shape).max(axis=0)
        worst = float(error.max())
        if worst < DEVIATION:
            break
        if len(averages) > _MOST_POINTS or not np.isfinite(worst):
            raise ValueError(f"a curve on the surface stays {worst:.1e} mm off its curve in space")
        averages = np.union1d(averages, between[1][error >= DEVIATION])

    ends = gp_Pnt(*space(averages[0]).tolist()), gp_Pnt(*space(averages[-1]).tolist())
    plane = cubic(spline.knots, spline.poles)
    return Followed(cubic(space.t, space.c), plane, float(averages[0]), float(averages[-1]), ends, max(1.2 * worst, 1e-7))


def surface_edge(face: Any, curve: Followed, start: Any, stop: Any) -> Any:
    """Edge along a curve on a face's surface, in part coordinates; its tolerance is the measured deviation.

    The tolerance of the vertices at its ends grows where they are farther off.
    """
    builder, edge, location = BRep_Builder(), TopoDS_Edge(), TopLoc_Location()
    basis = BRep_Tool.Surface_s(face, location)
    builder.MakeEdge(edge, curve.space, curve.tolerance)
    builder.UpdateEdge(edge, curve.plane, basis, location, curve.tolerance)
    for vertex, orientation, end in zip((start, stop), (TopAbs_FORWARD, TopAbs_REVERSED), curve.ends, strict=True):
        off = BRep_Tool.Pnt_s(vertex).Distance(end)
        builder.UpdateVertex(vertex, max(curve.tolerance, 1.01 * off + 1e-9))
        builder.Add(edge, vertex.Oriented(orientation))
    builder.Range(edge, curve.first, curve.last)
    builder.SameRange(edge, True)
    builder.SameParameter(edge, True)
    return edge


def pieces(net: Net, face: Any, surface: Surface, arrangement: Arrangement, regions: list[Region]) -> list[Any]:
    """Faces of the regions of a face of a net whose edges are cut, in its FORWARD orientation; `surface` is the face's own.

    Raises CannotSplit where the border of a piece does not close in space, ValueError where a curve cannot be followed in space.
    """
    builder, plain = BRep_Builder(), TopoDS.Face_s(face.Oriented(TopAbs_FORWARD))
    drawing = _edges(net, plain, surface, arrangement)
    out = []
    for region in regions:
        piece = TopoDS.Face_s(plain.EmptyCopied())
        builder.NaturalRestriction(piece, False)
        for loop in region.loops:
            edges = [edge for half in loop for edge in _along(net, arrangement, half, drawing)]
            if not edges:
                raise CannotSplit("a piece of it vanishes")
            wire = TopoDS_Wire()
            builder.MakeWire(wire)
            for edge in edges:
                builder.Add(wire, edge)
            if not BRep_Tool.IsClosed_s(wire):
                raise CannotSplit("the border of a piece does not close in space")
            wire.Closed(True)
            builder.Add(piece, wire)
        out.append(piece)
    return out


def rewired(net: Net, face: Any) -> Any:
    """A face that is not split, with its cut edges; itself if none is cut."""
    if not any(net.edges.FindIndex(edge) in net.cuts for edge in edges_of(face)):
        return face

    def parts(edge: Any) -> list[Any]:
        cut = net.cuts.get(net.edges.FindIndex(edge))
        mine = [part.Oriented(edge.Orientation()) for part in cut.parts] if cut else [edge]
        return mine if edge.Orientation() == TopAbs_FORWARD else mine[::-1]

    new = with_edges(face, parts)
    BRep_Builder().NaturalRestriction(new, BRep_Tool.NaturalRestriction_s(face))
    return new


def placed(
    shape: Any, numbers: dict[int, int], known: Any, changed: dict[int, list[Any]]
) -> tuple[list[Any], dict[int, list[Any]]]:
    """A shape put together again, with other faces in place of some: one shape, or the pieces of a loose face; and by number of a
    face a TopoDS_Face list, as they stand there.

    `known` is the map of faces, `numbers` tells their own numbers, `changed` what replaces a face, FORWARD.
    """
    builder, faces = BRep_Builder(), dict[int, list[Any]]()

    def again(shape: Any) -> list[Any]:
        if shape.ShapeType() == TopAbs_FACE:
            number = numbers[known.FindIndex(shape)]
            new = changed.get(number)
            faces[number] = [TopoDS.Face_s(f.Oriented(shape.Orientation())) for f in new] if new else [TopoDS.Face_s(shape)]
            return faces[number]
        plain = shape.Oriented(TopAbs_FORWARD)
        new = plain.EmptyCopied()
        new.Location(TopLoc_Location())  # which the children have already
        for child in children(plain):
            for each in again(child):
                builder.Add(new, each)
        if new.ShapeType() == TopAbs_SHELL:
            new.Closed(BRep_Tool.IsClosed_s(new))
        return [new.Oriented(shape.Orientation())]

    return again(shape), faces


def _edges(net: Net, face: Any, surface: Surface, arrangement: Arrangement) -> list[Any]:
    """Edges of all stretches, FORWARD; their ends are moved to where the border's edges are cut."""
    free: dict[int, Any] = {}
    edges = []
    for stretch in arrangement.stretches:
        ends = [
            _inner(free, node, surface, arrangement) if c is None else _crossed(net, arrangement, c)
            for c, node in zip(stretch.crossing, stretch.nodes, strict=True)
        ]
        first, last = float(stretch.t[0]), float(stretch.t[-1])
        mark = stretch.curve, first, last, *ends[0][1].tolist(), *ends[1][1].tolist()
        if mark not in arrangement.followed:
            spline = trimmed(arrangement.splines[stretch.curve], first, last)
            spline.poles[0], spline.poles[-1] = ends[0][1], ends[1][1]
            arrangement.followed[mark] = followed(surface, spline)
        edges.append(surface_edge(face, arrangement.followed[mark], ends[0][0], ends[1][0]))
    return edges


def _inner(free: dict[int, Any], node: int, surface: Surface, arrangement: Arrangement) -> tuple[Any, Floats]:
    """Vertex of a node within the face, and its surface parameters."""
    uv = arrangement.free[node] / arrangement.border.scale
    if node not in free:
        free[node] = TopoDS_Vertex()
        BRep_Builder().MakeVertex(free[node], gp_Pnt(*surface.values(uv[:1], uv[1:])[0].tolist()), 1e-7)
    return free[node], uv


def _crossed(net: Net, arrangement: Arrangement, number: int) -> tuple[Any, Floats]:
    """Vertex of a crossing, and the surface parameters there of the border's edge."""
    crossing = arrangement.crossings[number]
    side = arrangement.border.sides[crossing.side]
    if crossing.end is None:
        at = net.stop(side.key, crossing.s)
        cut = net.cuts[side.key]
        return cut.vertices[at], np.array(side.curve.Value(cut.stops[at]).Coord())
    vertex = TopoDS.Vertex_s(net.vertices.FindKey(side.vertex[crossing.end]))
    return vertex, np.array(side.curve.Value(float(side.t[-crossing.end])).Coord())


def _along(net: Net, arrangement: Arrangement, half: Half, edges: list[Any]) -> list[Any]:
    """Edges of a half, as they stand in the border of the piece on its left."""
    if half.stretch:
        number, way = half.stretch
        return [edges[number].Oriented(TopAbs_FORWARD if way > 0 else TopAbs_REVERSED)]
    assert half.side is not None
    number, a, b = half.side
    side = arrangement.border.sides[number]
    parts = net.parts(side.key)
    low = 0 if a == side.t[0] else net.stop(side.key, a)
    high = len(parts) if b == side.t[-1] else net.stop(side.key, b)
    mine = [part.Oriented(side.edge.Orientation()) for part in parts[low:high]]
    return mine if side.sign > 0 else mine[::-1]
