"""Edges of a part, each cut once at all places where curves of any of its faces meet it; and drawn anew in parameter planes.

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
from OCP.TopAbs import TopAbs_EDGE, TopAbs_FACE, TopAbs_FORWARD, TopAbs_REVERSED, TopAbs_VERTEX
from OCP.TopExp import TopExp
from OCP.TopLoc import TopLoc_Location
from OCP.TopoDS import TopoDS, TopoDS_Vertex

from cad_io.arrays import Floats
from cad_io.kernel import cubic, domain, edges_of, shape_map
from cad_io.split.arrangement import MERGE
from cad_io.split.border import parameter_curve
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
