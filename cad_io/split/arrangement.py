"""Curves drawn on a face, cut where they meet its border and each other: a planar arrangement."""

import itertools
from collections import defaultdict
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from OCP.gp import gp_Pnt2d, gp_Vec2d

from cad_io.arrays import Floats
from cad_io.face.trim import inside
from cad_io.split.border import Border, CannotSplit, Side, chain, crossings, nearest
from cad_io.split.contour import Spline

if TYPE_CHECKING:
    from scipy.interpolate import BSpline

#: Places on an edge nearer to each other than this are one vertex, and nearer than this to its end they are that end, mm. The
#: ends of the curves are moved there, so that no tolerance grows.
MERGE = 1e-3
#: Chords of a span of a drawn curve.
_CHORDS = 8
#: A curve that ends on the border, as at a seam, may meet it just before or behind its end: it is prolonged by so many cells,
#: and so near to its end it meets the border there. A curve that runs along the border goes to the nearest place this near.
_OVER, _AT_END, _SNAP = 0.1, 1e-4, 0.02
_STEPS = 12  # of Newton's


@dataclass(frozen=True, slots=True)
class Crossing:
    """Where a drawn curve leaves the face: side, parameter there, node; `end`: 0 or 1 at an end of the side, else None."""

    side: int
    s: float
    end: int | None
    node: int


@dataclass(frozen=True, slots=True)
class Stretch:
    """A part of a drawn curve within the face."""

    #: Number of the curve.
    curve: int
    #: (n,); parameters and places along it, both ends included.
    t: Floats
    xy: Floats
    #: Numbers of the crossings where it starts and ends; None within the face.
    crossing: tuple[int | None, int | None]
    nodes: tuple[int, int]


class Arrangement:
    """An arrangement divides a face by curves.

    Attributes
    ----------
    border : Border
    splines : sequence of Spline
        The curves.
    crossings : list of Crossing
    stretches : list of Stretch
    free : dict
        Node within the face -> its place (2,).
    met : int
        How often curves cross each other.
    followed : dict
        Stretches as curves in space, kept for the next attempt.
    sound : set
        Where edges of the border were cut when the pieces were found to tile the face.
    """

    def __init__(self, border: Border, splines: Sequence[Spline], at_end: Callable[[int, float], int | None]) -> None:
        """Cut the curves; `at_end` tells whether a parameter of an edge, by its key, is at its end 0 or 1."""
        self.border, self.splines, self._at_end = border, splines, at_end
        self.crossings: list[Crossing] = []
        self.stretches: list[Stretch] = []
        self.free: dict[int, Floats] = {}
        self.followed: dict[tuple[Any, ...], Any] = {}
        self.sound: set[tuple[tuple[float, ...], ...]] = set()
        self._nodes = border.nodes
        for i, spline in enumerate(splines):
            self._cut(i, spline)
        self.met = self._meet()

    def used(self) -> list[int]:
        """Numbers of the crossings at which stretches end."""
        return sorted({c for stretch in self.stretches for c in stretch.crossing if c is not None})

    def keep(self, wanted: Sequence[int]) -> None:
        """Forget all other stretches."""
        self.stretches = [self.stretches[i] for i in wanted]

    def place(self, number: int) -> Floats:
        """Where a crossing is."""
        crossing = self.crossings[number]
        side = self.border.sides[crossing.side]
        return side.at(crossing.s if crossing.end is None else float(side.t[-crossing.end]), self.border.scale)

    def _node(self) -> int:
        self._nodes += 1
        return self._nodes - 1

    def _cut(self, number: int, spline: Spline) -> None:
        """Add the stretches of a curve."""
        from scipy.interpolate import BSpline  # half a second to load

        scale, curve = self.border.scale, BSpline(spline.knots, spline.poles, 3)
        knots = np.unique(spline.knots)
        t = np.append((knots[:-1, None] + np.diff(knots)[:, None] * np.arange(_CHORDS) / _CHORDS).ravel(), knots[-1])
        xy = curve(t) * scale
        bounds = self._bounds(spline, curve, t, xy)
        own = -1  # node of the start of a closed curve
        nodes: dict[int, int] = {}
        for k in range(len(bounds) - 1):
            a, b = bounds[k][0], bounds[k + 1][0]
            # Where it is longest from both ends; several points vote.
            probes = curve(a + (b - a) * np.array([0.5, 0.35, 0.65])) * scale
            if b <= a or inside(self.border.segments, probes).sum() < 2:
                continue
            ends: list[tuple[int | None, int, Floats]] = []
            for at in (k, k + 1):
                where = bounds[at][1]
                if where is None:
                    if not spline.closed:
                        raise CannotSplit("a boundary of its labels ends inside it")
                    if own < 0:
                        own = self._node()
                        self.free[own] = xy[0]
                    ends.append((None, own, xy[0]))
                    continue
                if at not in nodes:
                    nodes[at] = self._crossing(*where)
                ends.append((nodes[at], self.crossings[nodes[at]].node, self.place(nodes[at])))
            (ca, na, start), (cb, nb, stop) = ends
            among = (t > a) & (t < b)
            path = np.vstack([start, xy[among], stop])
            if na == nb and np.ptp(path, axis=0).max() < 10 * MERGE:
                continue  # touches a vertex
            self.stretches.append(Stretch(number, np.concatenate([[a], t[among], [b]]), path, (ca, cb), (na, nb)))

    def _bounds(self, spline: Spline, curve: "BSpline", t: Floats, xy: Floats) -> list[tuple[float, tuple[int, float] | None]]:
        """Parameters between which a curve is all inside or all outside, each with the side it meets there and where."""
        size, slope, first, last = self.border.size, curve.derivative(), float(t[0]), float(t[-1])

        def at(x: float) -> tuple[Floats, Floats]:
            inner = min(max(x, first), last)
            d = slope(inner)
            return (curve(inner) + d * (x - inner)) * self.border.scale, d * self.border.scale

        line_t, line, near = t, xy, (0.0, 0.0)
        if not spline.closed:
            speed = [float(np.linalg.norm(at(x)[1])) for x in (first, last)]
            if min(speed) == 0:
                raise CannotSplit("a boundary of its labels has a cusp")
            over = [_OVER * size / s for s in speed]
            near = _AT_END * size / speed[0], _AT_END * size / speed[1]
            line_t = np.concatenate([[first - over[0]], t, [last + over[1]]])
            line = np.vstack([at(line_t[0])[0], xy, at(line_t[-1])[0]])
        hits = crossings(chain(line), self.border.segments)
        bounds = []
        for i, j, at_i, at_j in zip(*(x.tolist() for x in hits), strict=True):
            span = self.border.parameters[j]
            x, s = line_t[i] + at_i * (line_t[i + 1] - line_t[i]), span[0] + at_j * (span[1] - span[0])
            reach = (2 * float(line_t[i + 1] - line_t[i]), 2 * abs(float(span[1] - span[0])))
            side = int(self.border.side_of[j])
            x, s = _refined(at, self.border.sides[side], self.border.scale, (float(x), float(s)), reach)
            bounds.append((x, s, side))
        bounds.sort()
        if spline.closed:
            return [(first, None), *((min(max(x, first), last), (side, s)) for x, s, side in bounds), (last, None)]
        before = [f for f in bounds if f[0] < first + near[0]][-1:] or self._snapped(xy[0], first)
        after = [f for f in bounds if f[0] > last - near[1]][:1] or self._snapped(xy[-1], last)
        inner = [f for f in bounds if first + near[0] <= f[0] <= last - near[1]]
        stops = [(min(max(x, first), last), (side, s)) for x, s, side in before + inner + after]
        return [*([] if before else [(first, None)]), *stops, *([] if after else [(last, None)])]

    def _snapped(self, end: Floats, t: float) -> list[tuple[float, float, int]]:
        """Where a curve's end lies on the border but for a small gap."""
        k, share, away = nearest(self.border.segments, end)
        if away > _SNAP * self.border.size:
            return []
        a, b = self.border.parameters[k].tolist()
        return [(t, a + share * (b - a), int(self.border.side_of[k]))]

    def _crossing(self, number: int, s: float) -> int:
        side = self.border.sides[number]
        end = self._at_end(side.key, s)
        self.crossings.append(Crossing(number, s, end, self._node() if end is None else side.node[end]))
        return len(self.crossings) - 1

    def _meet(self) -> int:
        """Cut stretches where they cross others, and say how often.

        The lines do not cross, but their fits may where two of them run a third of a cell apart.
        """
        if not self.stretches:
            return 0
        low, high = (np.array([of(s.xy, axis=0) for s in self.stretches]) for of in (np.min, np.max))
        overlapping = ((low[:, None] <= high) & (low <= high[:, None])).all(axis=2)
        cuts: dict[int, list[tuple[float, int]]] = defaultdict(list)
        count = 0
        for i, j in np.argwhere(np.tril(overlapping, -1)).tolist():
            pair = self.stretches[i], self.stretches[j]
            ends = np.array([s.xy[e] for s in pair for e in (0, -1)])
            for k, l, *shares in zip(*(x.tolist() for x in crossings(*(chain(s.xy) for s in pair))), strict=True):
                here = pair[0].xy[k] + shares[0] * (pair[0].xy[k + 1] - pair[0].xy[k])
                if np.linalg.norm(ends - here, axis=1).min() < 10 * MERGE:
                    continue  # they end in one node
                node = self._node()
                self.free[node] = here
                count += 1
                for x, stretch, at, share in ((i, pair[0], k, shares[0]), (j, pair[1], l, shares[1])):
                    cuts[x].append((float(stretch.t[at] + share * (stretch.t[at + 1] - stretch.t[at])), node))
        if cuts:
            self.stretches = [part for i, s in enumerate(self.stretches) for part in self._parted(s, sorted(cuts[i]))]
        return count

    def _parted(self, whole: Stretch, cuts: list[tuple[float, int]]) -> list[Stretch]:
        """Parts of a stretch between nodes within the face."""
        stops = [(float(whole.t[0]), whole.nodes[0], whole.crossing[0], whole.xy[0])]
        stops += [(t, node, None, self.free[node]) for t, node in cuts]
        stops += [(float(whole.t[-1]), whole.nodes[1], whole.crossing[1], whole.xy[-1])]
        parts = []
        for (ta, na, a, start), (tb, nb, b, stop) in itertools.pairwise(stops):
            among = (whole.t > ta) & (whole.t < tb)
            t, xy = np.concatenate([[ta], whole.t[among], [tb]]), np.vstack([start, whole.xy[among], stop])
            parts.append(Stretch(whole.curve, t, xy, (a, b), (na, nb)))
        return parts


def _refined(
    at: Callable[[float], tuple[Floats, Floats]],
    side: Side,
    scale: Floats,
    start: tuple[float, float],
    reach: tuple[float, float],
) -> tuple[float, float]:
    """Parameters on a curve and a side where they cross, by Newton's steps; those of the chords where these lead away."""
    point, tangent = gp_Pnt2d(), gp_Vec2d()
    x, s = start
    per_u, per_v = scale.tolist()
    for _ in range(_STEPS):
        here, d = at(x)
        side.curve.D1(s, point, tangent)
        (du, dv), (eu, ev) = d.tolist(), (tangent.X() * per_u, tangent.Y() * per_v)
        gap_u, gap_v = point.X() * per_u - float(here[0]), point.Y() * per_v - float(here[1])
        across = eu * dv - du * ev
        if abs(across) < 1e-12 * np.hypot(du, dv) * np.hypot(eu, ev) or across == 0:
            break
        dx, ds = (eu * gap_v - ev * gap_u) / across, (du * gap_v - dv * gap_u) / across
        x, s = x + dx, min(max(s + ds, float(side.t[0])), float(side.t[-1]))
        if abs(x - start[0]) > reach[0] or abs(s - start[1]) > reach[1]:
            return start
        if abs(dx) < 1e-12 * (1 + abs(x)) and abs(ds) < 1e-12 * (1 + abs(s)):
            break
    return x, s
