"""Faces, shells and solids put together again from cut edges."""

from typing import Any

import numpy as np
from OCP.BRep import BRep_Builder, BRep_Tool
from OCP.gp import gp_Pnt
from OCP.TopAbs import TopAbs_FACE, TopAbs_FORWARD, TopAbs_REVERSED, TopAbs_SHELL
from OCP.TopLoc import TopLoc_Location
from OCP.TopoDS import TopoDS, TopoDS_Vertex, TopoDS_Wire

from cad_io.arrays import Floats
from cad_io.kernel import edges_of
from cad_io.kernel.components import children
from cad_io.split.arrangement import Arrangement
from cad_io.split.border import CannotSplit
from cad_io.split.net import Net
from cad_io.split.regions import Half, Region
from cad_io.split.surface_edge import followed, surface_edge, trimmed
from cad_io.surface import Surface


def pieces(net: Net, face: Any, surface: Surface, arrangement: Arrangement, regions: list[Region]) -> list[Any]:
    """Faces of the regions of a face, in its FORWARD orientation.

    Parameters
    ----------
    net : Net
        Its edges are cut.
    face : TopoDS_Face
        Of that net.
    surface : Surface
        The face's own.
    arrangement : Arrangement
        Of the face.
    regions : list of Region

    Raises
    ------
    CannotSplit
        The border of a piece does not close in space.
    ValueError
        A curve cannot be followed in space.
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
    builder, plain = BRep_Builder(), face.Oriented(TopAbs_FORWARD)
    new = TopoDS.Face_s(plain.EmptyCopied())
    for wire in children(plain):
        along = wire.Oriented(TopAbs_FORWARD)
        fresh = along.EmptyCopied()
        for edge in children(along):
            cut = net.cuts.get(net.edges.FindIndex(edge))
            mine = [part.Oriented(edge.Orientation()) for part in cut.parts] if cut else [edge]
            for part in mine if edge.Orientation() == TopAbs_FORWARD else mine[::-1]:
                builder.Add(fresh, part)
        fresh.Closed(wire.Closed())
        builder.Add(new, fresh.Oriented(wire.Orientation()))
    builder.NaturalRestriction(new, BRep_Tool.NaturalRestriction_s(face))
    return TopoDS.Face_s(new.Oriented(face.Orientation()))


class Placed:
    """A shape put together again, with other faces in place of some.

    Attributes
    ----------
    shapes : list of TopoDS_Shape
        What it became: one shape, or the pieces of a loose face.
    faces : dict
        Number of a face -> TopoDS_Face list, as they stand there.
    """

    def __init__(self, shape: Any, numbers: dict[int, int], known: Any, changed: dict[int, list[Any]]) -> None:
        """`known` is the map of faces, `numbers` tells their own numbers, `changed` what replaces a face, FORWARD."""
        self._numbers, self._known, self._changed = numbers, known, changed
        self._builder = BRep_Builder()
        self.faces: dict[int, list[Any]] = {}
        self.shapes = self._again(shape)

    def _again(self, shape: Any) -> list[Any]:
        if shape.ShapeType() == TopAbs_FACE:
            number = self._numbers[self._known.FindIndex(shape)]
            new = self._changed.get(number)
            placed = [TopoDS.Face_s(f.Oriented(shape.Orientation())) for f in new] if new else [TopoDS.Face_s(shape)]
            self.faces[number] = placed
            return placed
        plain = shape.Oriented(TopAbs_FORWARD)
        new = plain.EmptyCopied()
        new.Location(TopLoc_Location())  # which the children have already
        for child in children(plain):
            for each in self._again(child):
                self._builder.Add(new, each)
        if new.ShapeType() == TopAbs_SHELL:
            new.Closed(BRep_Tool.IsClosed_s(new))
        return [new.Oriented(shape.Orientation())]


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
