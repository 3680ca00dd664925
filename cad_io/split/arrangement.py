"""Curves drawn on a face, cut where they meet its border and each other: a planar arrangement, and its regions.

Half-edges are walked into loops, loops nested, regions labelled and slivers joined.
"""

import itertools
from collections import Counter, defaultdict
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from OCP.gp import gp_Pnt2d, gp_Vec2d
from scipy.ndimage import maximum_filter, minimum_filter

from cad_io.arrays import Floats, Ints
from cad_io.face.trim import inside, interior_point, nearest, nodes_inside
from cad_io.split.border import Border, CannotSplit, Side, bearing, chain, crossings, enclosed, left_of
from cad_io.split.contour import LabelGrid, Spline

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
    """Curves (`splines`) that divide a face: where they cross its border and each other.

    free: node within the face -> its place (2,). met: how often curves cross each other. followed: stretches as curves in space,
    for the next attempt. sound: where edges of the border were cut when the pieces were found to tile the face.
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
        """The place (2,) of a crossing."""
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


_Pair = tuple[float, float]


def _refined(at: Callable[[float], tuple[Floats, Floats]], side: Side, scale: Floats, start: _Pair, reach: _Pair) -> _Pair:
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


#: Share of the nodes off the boundary that may end up in a piece of another label.
_ASTRAY = 0.01
#: Known nodes that a sliver has at most; and its area, cells.
_FEW, _SMALL = 3, 1.0
#: Directions at a node are looked at so far from it at most, cells.
_FEWEST_STEPS = 0.05


@dataclass(frozen=True, slots=True)
class Half:
    """A directed side of a region, which lies left of it."""

    #: Nodes.
    start: int
    stop: int
    #: (n, 2).
    xy: Floats
    #: Number of the border's side, and the parameters between which it runs along it.
    side: tuple[int, float, float] | None = None
    #: Number of the stretch of a drawn curve, and 1 along it or -1 against it.
    stretch: tuple[int, int] | None = None


@dataclass(frozen=True, slots=True)
class Region:
    """A part of a face."""

    #: The outer one, then the holes.
    loops: list[list[Half]]
    #: (n, 2, 2); all of them as one even-odd region, scaled.
    ring: Floats

    @property
    def area(self) -> float:
        (x0, y0), (x1, y1) = self.ring[:, 0].T, self.ring[:, 1].T
        return 0.5 * abs(float((x0 * y1 - y0 * x1).sum()))


@dataclass(frozen=True, slots=True)
class Judged:
    """A region with its label and, of its known nodes, how many have which label."""

    region: Region
    label: int
    counts: dict[int, int]


def regions_of(arrangement: Arrangement) -> list[Region]:
    """Regions into which the stretches of drawn curves cut a face."""
    halves = _halves(arrangement)
    twin = {i: i ^ 1 for i, half in enumerate(halves) if half.stretch}
    leaving: dict[int, list[int]] = defaultdict(list)
    arriving: dict[int, list[int]] = defaultdict(list)
    for i, half in enumerate(halves):
        leaving[half.start].append(i)
        arriving[half.stop].append(i)
    following = [-1] * len(halves)
    for node, come in arriving.items():
        for i, next_half in _turns(halves, twin, come, leaving[node], _FEWEST_STEPS * arrangement.border.size):
            following[i] = next_half
    loops: list[list[int]] = []
    used = [False] * len(halves)
    for start in range(len(halves)):
        if used[start]:
            continue
        loop, at = [], start
        while not used[at]:
            used[at] = True
            loop.append(at)
            at = following[at]
        if at != start:
            raise CannotSplit("its regions do not close")
        loops.append(loop)
    return _nested([[halves[i] for i in loop] for loop in loops], arrangement.border.size)


def judged(regions: list[Region], scale: Floats, grid: LabelGrid, known: Ints) -> list[Judged]:
    """Label regions: by the nodes in them, or by the nearest node (in cells) where none is in.

    Raises CannotSplit where too many nodes off the boundary lie in a region of another label: a curve did not cut.
    """
    modes = ["wrap" if closed else "nearest" for closed in grid.closed]
    calm = (known >= 0) & (maximum_filter(grid.field, 3, mode=modes) == minimum_filter(grid.field, 3, mode=modes))
    astray = 0
    out = []
    for region in regions:
        rows, columns = _inside(region, scale, grid)
        ranks = grid.field[rows, columns][calm[rows, columns]]
        astray += len(ranks) - int(np.bincount(ranks, minlength=1).max())
        labels = known[rows, columns]
        counts = {int(k): int(n) for k, n in zip(*np.unique(labels[labels >= 0], return_counts=True), strict=True)}
        label = max(counts, key=lambda k: counts[k]) if counts else _nearest_label(region, scale, grid, known)
        out.append(Judged(region, label, counts))
    if astray > _ASTRAY * calm.sum():
        raise CannotSplit(f"{astray} of {calm.sum()} nodes end up in a piece of another label")
    return out


def _longest_border(r: int, group: dict[int, int], borders: Iterable[tuple[tuple[int, int], float]]) -> int:
    """The group with which region `r` has the longest common border, itself where it has none.

    A border is the two regions that it parts, and its length.
    """
    shared: dict[int, float] = defaultdict(float)
    for (a, b), length in borders:
        if group[a] != group[b] and r in (group[a], group[b]):
            shared[group[b] if group[a] == r else group[a]] += length
    return max(shared, key=lambda k: (shared[k], -k), default=r)


def slivers(arrangement: Arrangement, parts: list[Judged], worst: int) -> tuple[list[int], dict[int, int], int]:
    """Tell which slivers are to join what is around them.

    A sliver has some nodes at most and less area than a cell. It joins the neighbour with the longest common border if that one
    has nodes and a worse (higher) label, up to `worst`. With `worst` -1 any label will do, for slivers without nodes alone.

    Returns numbers of the stretches that still part two regions; number of a region -> that of the region that it is part of; how
    many joined.
    """
    cell = arrangement.border.size**2 * _SMALL
    owner: dict[tuple[int, int], int] = {
        half.stretch: r for r, part in enumerate(parts) for loop in part.region.loops for half in loop if half.stretch
    }
    neighbours = [(owner[i, 1], owner[i, -1]) for i in range(len(arrangement.stretches))]
    lengths = [float(np.linalg.norm(np.diff(s.xy, axis=0), axis=1).sum()) for s in arrangement.stretches]
    area, group = [part.region.area for part in parts], {r: r for r in range(len(parts))}
    for r in sorted(group, key=lambda r: (area[r], r)):
        if area[r] >= cell or sum(parts[r].counts.values()) > _FEW or group[r] != r:
            continue
        enclosing = _longest_border(r, group, zip(neighbours, lengths, strict=True))
        worse = parts[r].label < parts[enclosing].label <= worst
        if parts[enclosing].counts and (worse or (worst < 0 and not parts[r].counts)):
            group = {k: enclosing if g == r else g for k, g in group.items()}
            area[enclosing] += area[r]
    separate = [i for i, (a, b) in enumerate(neighbours) if group[a] != group[b]]
    return separate, group, sum(g != r for r, g in group.items())


def joined(parts: list[Judged], group: dict[int, int], again: list[Region]) -> list[Judged]:
    """Regions walked again without the stretches between slivers and what they joined, with their labels and nodes."""
    ends = {_mark(half): r for r, part in enumerate(parts) for loop in part.region.loops for half in loop}
    counts: dict[int, Counter[int]] = defaultdict(Counter)
    for r, part in enumerate(parts):
        counts[group[r]].update(part.counts)
    out = []
    for region in again:
        r = group[next(ends[mark] for loop in region.loops for half in loop if (mark := _mark(half)) in ends)]
        out.append(Judged(region, parts[r].label, dict(counts[r])))
    return out


def _mark(half: Half) -> tuple[float, ...]:
    """Return the first two points of a half as a key: they stay the same when stretches are left out."""
    return (*half.xy[0].tolist(), *half.xy[1].tolist())


def _halves(arrangement: Arrangement) -> list[Half]:
    """Both halves of each stretch (2 i and 2 i + 1), then those along the border."""
    halves = []
    for i, stretch in enumerate(arrangement.stretches):
        halves.append(Half(*stretch.nodes, stretch.xy, stretch=(i, 1)))
        halves.append(Half(*stretch.nodes[::-1], stretch.xy[::-1], stretch=(i, -1)))
    cuts: dict[int, list[tuple[float, int]]] = defaultdict(list)
    for c in arrangement.used():
        crossing = arrangement.crossings[c]
        if crossing.end is None:
            cuts[crossing.side].append((crossing.s, crossing.node))
    for i, side in enumerate(arrangement.border.sides):
        stops = [(float(side.t[0]), side.node[0]), *sorted(cuts[i]), (float(side.t[-1]), side.node[1])]
        for (a, start), (b, stop) in itertools.pairwise(stops):
            among = (side.t > a) & (side.t < b)
            xy = np.vstack([side.at(a, arrangement.border.scale), side.xy[among], side.at(b, arrangement.border.scale)])
            if side.sign < 0:
                start, stop, xy = stop, start, xy[::-1]
            halves.append(Half(start, stop, xy, side=(i, a, b)))
    return halves


def _turns(halves: list[Half], twin: dict[int, int], come: list[int], leave: list[int], span: float) -> list[tuple[int, int]]:
    """For each half that arrives at a node, the next one around the region on its left."""
    if not leave:
        raise CannotSplit("the border of a region ends")
    outgoing = [i for i in leave if i in twin]
    out = []
    directions: dict[int, float] = {}
    for i in come:
        choice = [k for k in leave if k != twin.get(i)] or leave
        if len(choice) == 2 and len(outgoing) == 1 and i not in twin:
            choice = outgoing  # the one curve that leaves the border here lies left of it
        if len(choice) > 1:
            if not directions:
                paths = {k: halves[k].xy for k in leave} | {~k: halves[k].xy[::-1] for k in come}
                radius = min(0.3 * min(float(np.linalg.norm(p - p[0], axis=1).max()) for p in paths.values()), span)
                directions = {k: bearing(path, radius) for k, path in paths.items()}
            back = directions[~i]
            choice = [min(choice, key=lambda k: ((back - directions[k]) % (2 * np.pi) or 2 * np.pi, k))]
        out.append((i, choice[0]))
    return out


def _nested(loops: list[list[Half]], size: float) -> list[Region]:
    """Regions: an outer loop, and the holes in it."""
    paths = [np.concatenate([half.xy[:-1] for half in loop]) for loop in loops]
    areas = [enclosed(path) for path in paths]
    holes: dict[int, list[int]] = {i: [] for i, area in enumerate(areas) if area > 0}
    if not holes:
        raise CannotSplit("its border runs the wrong way round")
    rings = [chain(np.vstack([path, path[:1]])) for path in paths]
    for i in range(len(loops)):
        if i in holes:
            continue
        probe = left_of(paths[i], 1e-3 * size)
        # The box is looked at first.
        boxed = [o for o in holes if (paths[o].min(axis=0) <= probe).all() and (probe <= paths[o].max(axis=0)).all()]
        enclosing = [o for o in boxed if inside(rings[o], probe[None])[0]]
        if not enclosing:
            raise CannotSplit("a hole lies in none of its regions")
        holes[min(enclosing, key=lambda o: areas[o])].append(i)
    return [
        Region([loops[k] for k in (o, *inner)], np.concatenate([rings[k] for k in (o, *inner)])) for o, inner in holes.items()
    ]


def _inside(region: Region, scale: Floats, grid: LabelGrid) -> tuple[Ints, Ints]:
    """Rows and columns of the nodes in a region."""
    ring = region.ring / scale
    low, high = ring.min(axis=(0, 1)), ring.max(axis=(0, 1))
    shape = grid.field.shape
    first = [max(int(np.searchsorted(line, low[a])) - 1, 0) for a, line in enumerate(grid.lines)]
    last = [min(int(np.searchsorted(line, high[a])) + 1, shape[a]) for a, line in enumerate(grid.lines)]
    u, v = (line[a:b] for line, a, b in zip(grid.lines, first, last, strict=True))
    if not (len(u) and len(v)):
        return np.empty(0, np.int32), np.empty(0, np.int32)
    rows, columns = np.nonzero(nodes_inside(ring, u, v))
    return np.asarray(rows + first[0], np.int32), np.asarray(columns + first[1], np.int32)


def _nearest_label(region: Region, scale: Floats, grid: LabelGrid, known: Ints) -> int:
    """The label of the known node that is nearest to a place inside, in cells."""
    place = zip(interior_point(region.ring / scale), grid.lines, strict=True)
    at = [float(np.interp(x, line, np.arange(len(line)))) for x, line in place]
    i, j = np.nonzero(known >= 0)
    k = int(np.argmin(np.hypot(i - at[0], j - at[1])))
    return int(known[i[k], j[k]])
