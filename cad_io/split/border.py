"""The border of a face in its parameter plane: its edges as curves there, sampled and joined; segments and loops in a plane.

Coordinates of the plane are scaled: u and v times the mean speeds of the surface, so that a length is about a mm.
"""

from collections import defaultdict
from dataclasses import dataclass, field
from typing import Any, NamedTuple

import numpy as np
import shapely
from numpy.typing import NDArray
from OCP.BRep import BRep_Tool
from OCP.BRepAdaptor import BRepAdaptor_Curve2d
from OCP.GeomAbs import GeomAbs_CN, GeomAbs_Line
from OCP.TopAbs import TopAbs_FORWARD, TopAbs_REVERSED
from OCP.TopExp import TopExp
from OCP.TopoDS import TopoDS

from cad_io.arrays import Floats
from cad_io.face.trim import continuing
from cad_io.kernel import edges_of, interval_ends
from cad_io.split.contour import LabelGrid
from cad_io.surface import Surface


class Crossings(NamedTuple):
    """Pairs of segments that cross: numbers i and j, and the shares of their lengths at which they do."""

    i: NDArray[np.intp]
    j: NDArray[np.intp]
    at_i: Floats
    at_j: Floats


def crossings(p: Floats, q: Floats) -> Crossings:
    """Tell where segments p (n, 2, 2) cross segments q (m, 2, 2).

    Of each segment one end counts and the other does not, so that a chain is crossed once where two of its segments meet.
    """
    # Of the pairs whose boxes touch.
    i, j = shapely.STRtree(shapely.linestrings(q)).query(shapely.linestrings(p))
    order = np.lexsort((j, i))
    i, j = i[order], j[order]
    a, b, c, d = p[i, 0], p[i, 1], q[j, 0], q[j, 1]
    of_c, of_d, of_a, of_b = _turning(a, b, c), _turning(a, b, d), _turning(c, d, a), _turning(c, d, b)
    hit = ((of_c >= 0) != (of_d >= 0)) & ((of_a >= 0) != (of_b >= 0))
    i, j, of_a, of_b, of_c, of_d = (x[hit] for x in (i, j, of_a, of_b, of_c, of_d))
    return Crossings(i, j, of_a / (of_a - of_b), of_c / (of_c - of_d))


def _turning(a: Floats, b: Floats, p: Floats) -> Floats:
    """Positive where p lies left of the line from a to b."""
    return np.asarray((b[:, 0] - a[:, 0]) * (p[:, 1] - a[:, 1]) - (b[:, 1] - a[:, 1]) * (p[:, 0] - a[:, 0]))


def chain(path: Floats) -> Floats:
    """Segments (n - 1, 2, 2) of a path (n, 2)."""
    return np.stack([path[:-1], path[1:]], axis=1)


def enclosed(path: Floats) -> float:
    """Area that a closed path (n, 2) encloses, positive if it runs counter-clockwise."""
    x, y = (path - path[0]).T
    return 0.5 * float(np.dot(x, np.roll(y, -1)) - np.dot(np.roll(x, -1), y))


def bearing(path: Floats, radius: float) -> float:
    """Direction, rad, in which a path (n, 2) first leaves a circle around its start; of its farthest point if it does not."""
    away = np.linalg.norm(path - path[0], axis=1)
    k = max(1, int(np.argmax(away >= radius)) if (away >= radius).any() else int(away.argmax()))
    share = (radius - away[k - 1]) / (away[k] - away[k - 1]) if away[k] > away[k - 1] else 1.0
    x, y = path[k - 1] + min(max(share, 0.0), 1.0) * (path[k] - path[k - 1]) - path[0]
    return float(np.arctan2(y, x))


def left_of(path: Floats, reach: float) -> Floats:
    """A point (2,) close to the left of the longest step of a closed path (n, 2), at most `reach` away."""
    step = np.roll(path, -1, axis=0) - path
    length = np.linalg.norm(step, axis=1)
    k = int(length.argmax())
    normal = np.array([-step[k, 1], step[k, 0]]) / max(length[k], 1e-300)
    return np.asarray(path[k] + 0.5 * step[k] + normal * min(1e-3 * float(length[k]), reach))


#: Chord error of the sampled border, cells.
_CHORD = 2e-3
#: Chords that a curve starts with, and how often they are halved.
_CHORDS, _HALVINGS = 16, 6
#: Gap between two curves at their vertex that is still a border that closes, share of the face.
_GAP = 0.02


class CannotSplit(Exception):
    """Why a face is not split, in words."""


@dataclass(slots=True)
class Side:
    """An edge as a face uses it."""

    #: As it stands in the face.
    edge: Any
    #: Number of the edge in the part.
    key: int
    #: 1 if the face's border runs along it in the direction of its parameter, else -1.
    sign: int
    #: In surface parameters.
    curve: Any
    #: (n,); places along the curve; the ends of `xy` are moved to the nodes.
    t: Floats
    xy: Floats
    #: Numbers of its vertices in the part, by parameter.
    vertex: tuple[int, int]
    #: Numbers of its ends in the plane, by parameter.
    node: list[int] = field(default_factory=lambda: [-1, -1])

    def at(self, s: float, scale: Floats) -> Floats:
        """Place (2,) of a parameter, scaled; of its ends, where the nodes are."""
        if s == self.t[0]:
            return np.asarray(self.xy[0])
        if s == self.t[-1]:
            return np.asarray(self.xy[-1])
        return np.array(self.curve.Value(s).Coord()) * scale


class Border:
    """A face's border: what is cut by the curves drawn on it.

    face: FORWARD. scale (2,): mm per unit of u and v. size: a cell of the label grid, mm, the smaller way. segments (n, 2, 2):
    the border as one even-odd region; side_of (n,), parameters (n, 2): the side of each segment, and its parameters there. nodes:
    how many there are.
    """

    def __init__(self, face: Any, surface: Surface, grid: LabelGrid, edges: Any, vertices: Any) -> None:
        """Read the border of a face; `edges` and `vertices` are the part's maps of them."""
        self.face = TopoDS.Face_s(face.Oriented(TopAbs_FORWARD))
        cell = np.array([(g[-1] - g[0]) / (len(g) - 1) for g in grid.lines])
        self.scale = _speeds(surface, grid)
        self.size = float((cell * self.scale).min())
        self.sides = [self._side(edge, edges, vertices) for edge in edges_of(self.face)]
        if not self.sides:
            raise CannotSplit("it has no border")
        self.nodes = self._joined()
        self.segments = np.concatenate([chain(side.xy) for side in self.sides])
        self.side_of = np.repeat(np.arange(len(self.sides)), [len(side.t) - 1 for side in self.sides])
        self.parameters = np.concatenate([np.stack([side.t[:-1], side.t[1:]], axis=1) for side in self.sides])

    def _side(self, edge: Any, edges: Any, vertices: Any) -> Side:
        if edge.Orientation() not in (TopAbs_FORWARD, TopAbs_REVERSED):
            raise CannotSplit("it has edges that do not bound it")
        whole = BRep_Tool.Range_s(edge)
        curve, first, last = parameter_curve(edge, self.face)
        if curve is None:
            raise CannotSplit("an edge has no curve in its parameter plane")
        if max(abs(first - whole[0]), abs(last - whole[1])) > 1e-9 * (1 + abs(last - first)):
            raise CannotSplit("an edge has another range in space than in its parameter plane")
        plain = TopoDS.Edge_s(edge.Oriented(TopAbs_FORWARD))
        ends = [vertices.FindIndex(of(plain)) for of in (TopExp.FirstVertex_s, TopExp.LastVertex_s)]
        if 0 in ends:
            raise CannotSplit("an edge has no end")
        sign = 1 if edge.Orientation() == TopAbs_FORWARD else -1
        t, xy = self._sampled(BRepAdaptor_Curve2d(edge, self.face), curve, first, last)
        return Side(edge, edges.FindIndex(edge), sign, curve, t, xy, (ends[0], ends[1]))

    def _sampled(self, adaptor: Any, curve: Any, first: float, last: float) -> tuple[Floats, Floats]:
        """Parameters and places along a curve, with chords close to it."""
        count = adaptor.NbIntervals(GeomAbs_CN)
        t = interval_ends(count, adaptor.Intervals, GeomAbs_CN)
        t[0], t[-1] = first, last
        straight = count == 1 and adaptor.GetType() == GeomAbs_Line
        if not straight:
            parts = max(4, -(-_CHORDS // count))
            t = np.append((t[:-1, None] + np.diff(t)[:, None] * np.arange(parts) / parts).ravel(), last)
        xy = self._places(curve, t)
        for _ in range(0 if straight else _HALVINGS):
            middle = 0.5 * (t[1:] + t[:-1])
            at = self._places(curve, middle)
            off = np.linalg.norm(at - 0.5 * (xy[1:] + xy[:-1]), axis=1) > _CHORD * self.size
            if not off.any():
                break
            where = np.flatnonzero(off) + 1
            t, xy = np.insert(t, where, middle[off]), np.insert(xy, where, at[off], axis=0)
        if not np.isfinite(xy).all():
            raise CannotSplit("an edge has no place in its parameter plane")
        return t, xy

    def _places(self, curve: Any, t: Floats) -> Floats:
        return np.array([curve.Value(x).Coord() for x in t.tolist()]) * self.scale

    def _joined(self) -> int:
        """Number the nodes: ends of one vertex at one place of the plane. Parameter curves do not meet exactly; now they do."""
        ends = defaultdict(list)
        for i, side in enumerate(self.sides):
            for e in (0, 1):
                ends[side.vertex[e]].append((i, e))
        diagonal = float(np.linalg.norm(np.ptp(np.concatenate([side.xy for side in self.sides]), axis=0)))
        near = max(1e-6 * diagonal, 1e-3 * self.size)
        node = 0
        for mine in ends.values():
            place = {end: self.sides[end[0]].xy[-end[1]].copy() for end in mine}
            groups: list[set[tuple[int, int]]] = []
            for group in self._pairs(mine, place, diagonal):
                close = [g for g in groups if any(np.linalg.norm(place[a] - place[b]) < near for a in g for b in group)]
                groups = [g for g in groups if g not in close]
                groups.append(group.union(*close))
            for group in groups:
                middle = np.mean([place[end] for end in sorted(group)], axis=0)
                for i, e in group:
                    self.sides[i].node[e] = node
                    self.sides[i].xy[-e] = middle
                node += 1
        return node

    def _pairs(
        self, ends: list[tuple[int, int]], place: dict[tuple[int, int], Floats], size: float
    ) -> list[set[tuple[int, int]]]:
        """Of the ends at one vertex, each that arrives with the one that leaves where it arrives."""
        leaves = [(e == 0) == (self.sides[i].sign > 0) for i, e in ends]
        away = [end for end, leaving in zip(ends, leaves, strict=True) if leaving]
        here = [end for end, leaving in zip(ends, leaves, strict=True) if not leaving]
        if len(away) != len(here):
            raise CannotSplit("its border does not close")
        leaving_at, arriving_at = (np.array([place[end] for end in group]) for group in (away, here))
        following = continuing(leaving_at, arriving_at, np.ones(2))
        if np.linalg.norm(arriving_at - leaving_at[following], axis=1).max() > _GAP * size:
            raise CannotSplit("its border does not close in its parameter plane")
        return [{end, away[k]} for end, k in zip(here, following.tolist(), strict=True)]


def parameter_curve(edge: Any, face: Any) -> tuple[Any, float, float]:
    """An edge's curve in a face's parameters (None if there is none) and its range."""
    first, last = BRep_Tool.Range_s(edge, face)
    return BRep_Tool.CurveOnSurface_s(edge, face, first, last), first, last


def _speeds(surface: Surface, grid: LabelGrid) -> Floats:
    """Mean mm per unit of u and v."""
    u, v = (np.linspace(g[0], g[-1], 7)[1:-1] for g in grid.lines)
    first = surface.first(*(x.ravel() for x in np.meshgrid(u, v, indexing="ij")))
    speed = np.linalg.norm(first[:, 1:], axis=2)
    speed = speed[np.isfinite(speed).all(axis=1)].mean(axis=0) if np.isfinite(speed).all(axis=1).any() else np.zeros(2)
    if not (np.isfinite(speed).all() and (speed > 0).all()):
        raise CannotSplit("its surface has no slopes")
    return np.asarray(speed)
