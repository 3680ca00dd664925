"""Edges of a part, each cut once at all places where curves of any of its faces meet it, and drawn anew in parameter planes;
edges made from curves there; faces, shells and solids put together again.

Some files (and the kernel, where a file has none) give an edge a curve in a face's parameter plane that leaves the edge here
and there, or runs along it at another speed. The kernel does not see that while its few places of looking are not there.
Once the edge is cut they are, and the piece is not valid. So each place of the edge is sought on the surface.
"""

import itertools
from collections import defaultdict
from collections.abc import Callable, Iterable
from typing import Any, NamedTuple

import numpy as np
from OCP.BRep import BRep_Builder, BRep_Tool
from OCP.BRepAdaptor import BRepAdaptor_Curve
from OCP.BRepCheck import BRepCheck_Analyzer
from OCP.gp import gp_Pnt
from OCP.TopAbs import TopAbs_EDGE, TopAbs_FACE, TopAbs_FORWARD, TopAbs_REVERSED, TopAbs_SHELL, TopAbs_VERTEX
from OCP.TopExp import TopExp
from OCP.TopLoc import TopLoc_Location
from OCP.TopoDS import TopoDS, TopoDS_Edge, TopoDS_Vertex, TopoDS_Wire

from cad_io.arrays import Floats
from cad_io.kernel import cubic, domain, edges_of, shape_map
from cad_io.kernel.shapes import children, with_edges
from cad_io.split.arrangement import MERGE, Arrangement, Half, Region
from cad_io.split.border import CannotSplit, parameter_curve
from cad_io.split.contour import Spline
from cad_io.surface import Surface

#: Places where an edge is compared with its faces; the kernel's check takes 23 of them.
_LOOKS = 45
#: Most that the tolerance of an edge may grow by, mm.
LOOSER = 0.1


#: Number of an edge and where its parts end -> how far each part is off its curves in parameter planes, mm.
Off = dict[tuple[int, tuple[float, ...]], list[float]]


class Cut(NamedTuple):
    """An edge in parts: the parameters of its ends and of the cuts between, its vertices there, the parts between."""

    stops: list[float]
    vertices: list[Any]
    parts: list[Any]


class Edge(NamedTuple):
    """An edge, FORWARD; whether it is a point; its range; its curve."""

    edge: Any
    point: bool
    first: float
    last: float
    curve: Any


class Net:
    """Edges, vertices and faces of a shape: maps of the kernel, which count from 1.

    cuts: number of an edge -> Cut. off: how far parts of edges are off, as measured here or with a copy. loose: number of an edge
    that was cut -> how far it is off a face at the same parameter, mm, where that is too far.
    """

    def __init__(self, shape: Any, surface_of: Callable[[int], Surface], off: Off | None = None) -> None:
        """Look at a shape; `surface_of` gives a face's surface by its number here, `off` what another copy of it has measured."""
        self.edges, self.vertices, self.faces = (shape_map(shape, kind) for kind in (TopAbs_EDGE, TopAbs_VERTEX, TopAbs_FACE))
        self.cuts: dict[int, Cut] = {}
        self.loose: dict[int, float] = {}
        self._known: dict[int, Edge] = {}
        self._surface_of = surface_of
        self.off: Off = {} if off is None else off
        self._builder = BRep_Builder()
        self._users: dict[int, list[tuple[Any, Any]]] = defaultdict(list)
        for i in range(1, self.faces.Extent() + 1):
            plain = TopoDS.Face_s(self.faces.FindKey(i).Oriented(TopAbs_FORWARD))
            for edge in edges_of(plain):
                self._users[self.edges.FindIndex(edge)].append((plain, edge))

    def at_end(self, key: int, s: float) -> int | None:
        """0 or 1 if a parameter of an edge is at that end, else None."""
        known = self.edge(key)
        span = known.last - known.first
        e = int(s > known.first + 0.5 * span)
        # By the curve's own ends: vertices of loose files lie off them.
        return e if self._same(known, s, known.last if e else known.first, 1e-7 * span) else None

    def cut(self, places: Iterable[tuple[int, float]]) -> None:
        """Cut edges: (number of the edge, parameter). Places nearer than MERGE are one."""
        cuts: dict[int, list[float]] = defaultdict(list)
        for key, s in places:
            cuts[key].append(s)
        for key in sorted(cuts):
            edge, point, first, last, curve = known = self.edge(key)
            groups: list[list[float]] = []
            for s in sorted(cuts[key]):
                if groups and self._same(known, groups[-1][0], s, 1e-9 * (last - first)):
                    groups[-1].append(s)
                else:
                    groups.append([s])
            start, stop = TopExp.FirstVertex_s(edge), TopExp.LastVertex_s(edge)
            stops = [first, *(group[len(group) // 2] for group in groups), last]
            vertices = [start, *(start if point else self._vertex(edge, curve, s) for s in stops[1:-1]), stop]
            parts = [self._part(edge, *vertices[i : i + 2], *stops[i : i + 2]) for i in range(len(stops) - 1)]
            self.cuts[key] = Cut(stops, vertices, parts)
            if not point:
                self._loosen(key, known)

    def forget(self, key: int) -> None:
        """Forget what was measured of an edge, which has changed; also for all copies."""
        for mark in [mark for mark in self.off if mark[0] == key]:
            del self.off[mark]

    def stop(self, key: int, s: float) -> int:
        """Which of the stops of a cut edge a place on it became."""
        return 1 + int(np.argmin(np.abs(np.array(self.cuts[key].stops[1:-1]) - s)))

    def parts(self, key: int) -> list[Any]:
        """Parts of an edge, FORWARD, by parameter; the edge itself if it is not cut."""
        return self.cuts[key].parts if key in self.cuts else [self.edge(key).edge]

    def users(self, key: int) -> list[tuple[Any, Any]]:
        """Faces that use an edge, FORWARD, each with the edge as it stands there; a seam twice."""
        return self._users.get(key, [])

    def edge(self, key: int) -> Edge:
        """An edge by its number."""
        if key not in self._known:
            edge = TopoDS.Edge_s(self.edges.FindKey(key).Oriented(TopAbs_FORWARD))
            point = BRep_Tool.Degenerated_s(edge)
            first, last = BRep_Tool.Range_s(edge)
            self._known[key] = Edge(edge, point, first, last, None if point else BRepAdaptor_Curve(edge))
        return self._known[key]

    def surface(self, face: Any) -> Surface:
        """Of a face."""
        return self._surface_of(self.faces.FindIndex(face))

    def _same(self, known: Edge, a: float, b: float, near: float) -> bool:
        """Whether two parameters are one place; of an edge that is a point, if they are so near."""
        return abs(b - a) < near if known.point else known.curve.Value(a).Distance(known.curve.Value(b)) < MERGE

    def _vertex(self, edge: Any, curve: Any, s: float) -> Any:
        vertex = TopoDS_Vertex()
        self._builder.MakeVertex(vertex, curve.Value(s), max(BRep_Tool.Tolerance_s(edge), 1e-7))
        return vertex

    def _part(self, edge: Any, start: Any, stop: Any, a: float, b: float) -> Any:
        """The edge between two of its parameters, with all its curves."""
        part = TopoDS.Edge_s(edge.EmptyCopied())
        self._builder.Add(part, start.Oriented(TopAbs_FORWARD))
        self._builder.Add(part, stop.Oriented(TopAbs_REVERSED))
        self._builder.Range(part, a, b)
        return part

    def _loosen(self, key: int, known: Edge) -> None:
        """Give parts the tolerance that they need: they are looked at in more places than the edge was."""
        stops, _, parts = self.cuts[key]
        mark = key, tuple(stops)
        if mark not in self.off:
            self.off[mark] = self._measured(key, known, stops)
        for part, far in zip(parts, self.off[mark], strict=True):
            old, new = BRep_Tool.Tolerance_s(part), 1.05 * far + 1e-7
            if new > old + LOOSER:
                self.loose[key] = max(far, self.loose.get(key, 0.0))
            elif new > old:
                self._builder.UpdateEdge(part, new)
                for vertex in (TopExp.FirstVertex_s(part), TopExp.LastVertex_s(part)):
                    self._builder.UpdateVertex(vertex, new)

    def _measured(self, key: int, known: Edge, stops: list[float]) -> list[float]:
        """How far each part of an edge is off its curves in parameter planes, mm."""
        shares = np.linspace(0, 1, _LOOKS)
        t = np.concatenate([a + (b - a) * shares for a, b in itertools.pairwise(stops)])
        space, off = along(known.curve, t), np.zeros(len(t))
        for face, edge in self.users(key):
            plane, _, _ = parameter_curve(edge, face)
            if plane is not None:
                off = np.fmax(off, distance(space, plane, self.surface(face), t))
        return [float(far) for far in off.reshape(-1, _LOOKS).max(axis=1)]


def along(curve: Any, t: Floats) -> Floats:
    """Places (n, 3) of a curve in space at its parameters (n,)."""
    return np.array([curve.Value(x).Coord() for x in t.tolist()])


def distance(space: Floats, plane: Any, surface: Surface, t: Floats) -> Floats:
    """How far (n,) places in space (n, 3) are off those of a curve in a surface's parameter plane at its parameters (n,), mm."""
    uv = np.array([plane.Value(x).Coord() for x in t.tolist()])
    return np.asarray(np.linalg.norm(surface.values(*uv.T) - space, axis=1))


#: Most that an edge's curve in space may leave its curve on the surface, mm.
DEVIATION = 1e-4
_POINTS, _MOST_POINTS = 257, 5000
_STEPS = 20
#: What the curve may leave its nearest places by, mm: some times what a drawn curve may.
_OFF = 10 * DEVIATION


def valid(shape: Any) -> bool:
    """Return whether the kernel's own check finds the shape valid."""
    return bool(BRepCheck_Analyzer(shape).IsValid())


def repair(net: Net, key: int) -> None:
    """Draw the parameter curves of an edge, by its number, anew where they do not follow it, in place; seams are left. `net` is
    of a copy.
    """
    users = net.users(key)
    edge = net.edge(key)
    for face, used in users:
        if edge.point or sum(face.IsSame(other) for other, _ in users) > 1:
            continue
        old, first, last = parameter_curve(used, face)
        if old is None or (first, last) != (edge.first, edge.last):
            continue
        surface, places = net.surface(face), np.linspace(first, last, 4 * _POINTS)
        allowed = BRep_Tool.Tolerance_s(edge.edge)
        if distance(along(edge.curve, places), old, surface, places).max() <= allowed + _OFF:
            continue
        spline = _followed(edge.curve, old, surface, first, last)
        if spline is None:
            continue
        new, sound = cubic(spline.knots, spline.poles), valid(face)
        off = float(distance(along(edge.curve, places), new, surface, places).max())
        if off > allowed + LOOSER:
            continue  # the edge itself is off the surface
        _put(edge.edge, face, new, off)
        if sound and not valid(face):
            _put(edge.edge, face, old, 0.0)


def _put(edge: Any, face: Any, curve: Any, off: float) -> None:
    """Give an edge a curve on a face, from which it is so far off, mm."""
    builder, location = BRep_Builder(), TopLoc_Location()
    basis = BRep_Tool.Surface_s(face, location)
    tolerance = 1.05 * off + 1e-7
    builder.UpdateEdge(edge, curve, basis, location, tolerance)
    for vertex in (TopExp.FirstVertex_s(edge), TopExp.LastVertex_s(edge)):
        builder.UpdateVertex(vertex, tolerance)


def _followed(curve: Any, old: Any, surface: Surface, first: float, last: float) -> Spline | None:
    """Cubic in the parameter plane that follows a curve in space, with the ends of the old one; None if there is none."""
    from scipy.interpolate import make_interp_spline  # half a second to load

    t = np.linspace(first, last, _POINTS)
    while len(t) < _MOST_POINTS:
        uv = _nearest(curve, old, surface, t)
        if not np.isfinite(uv).all():
            return None
        uv[0], uv[-1] = old.Value(first).Coord(), old.Value(last).Coord()
        spline = make_interp_spline(t, uv, k=3)
        middle = 0.5 * (t[1:] + t[:-1])
        here, best = (surface.values(*at.T) for at in (spline(middle), _nearest(curve, old, surface, middle)))
        off = np.linalg.norm(here - best, axis=1) > _OFF
        if not off.any():
            return Spline(spline.t, spline.c, False)
        t = np.union1d(t, middle[off])
    return None


def _nearest(curve: Any, old: Any, surface: Surface, t: Floats) -> Floats:
    """Parameters (n, 2) of the places of a surface nearest to those of a curve, by Gauss and Newton from an old curve."""
    space = np.array([curve.Value(x).Coord() for x in t.tolist()])
    uv = np.array([old.Value(x).Coord() for x in t.tolist()])
    adaptor, (low_u, high_u, low_v, high_v) = surface.adaptor, domain(surface.adaptor)
    ranges = ((adaptor.IsUPeriodic(), low_u, high_u), (adaptor.IsVPeriodic(), low_v, high_v))
    for _ in range(_STEPS):
        nearest = surface.first(*uv.T)
        gap, slopes = space - nearest[:, 0], nearest[:, 1:]
        matrix = slopes @ slopes.transpose(0, 2, 1)
        size = matrix[:, 0, 0] * matrix[:, 1, 1] - matrix[:, 0, 1] ** 2
        pull = (slopes @ gap[:, :, None])[:, :, 0]
        with np.errstate(divide="ignore", invalid="ignore"):
            step = np.stack([matrix[:, 1, 1] * pull[:, 0] - matrix[:, 0, 1] * pull[:, 1],
                             matrix[:, 0, 0] * pull[:, 1] - matrix[:, 0, 1] * pull[:, 0]], axis=1) / size[:, None]  # fmt: skip
        uv = uv + step
        for axis, (periodic, low, high) in enumerate(ranges):
            if not periodic:
                uv[:, axis] = np.clip(uv[:, axis], low, high)
    return uv


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
