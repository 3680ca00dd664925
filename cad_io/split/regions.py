"""The regions of an arrangement: half-edges walked into loops, loops nested, regions labelled and slivers joined."""

import itertools
from collections import Counter, defaultdict
from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from scipy.ndimage import maximum_filter, minimum_filter

from cad_io.arrays import Floats, Ints
from cad_io.face.trim import inside as holds
from cad_io.face.uv_region import inside, interior_point
from cad_io.split.arrangement import Arrangement
from cad_io.split.border import CannotSplit, bearing, chain, enclosed, extent, left_of
from cad_io.split.contour import LabelGrid

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

    Raises
    ------
    CannotSplit
        Too many nodes off the boundary lie in a region of another label: a curve did not cut.
    """
    modes = ["wrap" if closed else "nearest" for closed in (grid.closed_u, grid.closed_v)]
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


def _joins(part: Judged, other: Judged, worst: int) -> bool:
    """Whether a sliver is to join a region, as `slivers` says."""
    worse = part.label < other.label <= worst
    return bool(other.counts) and (worse or (worst < 0 and not part.counts))


def slivers(arrangement: Arrangement, parts: list[Judged], worst: int) -> tuple[list[int], dict[int, int], int]:
    """Tell which slivers are to join what is around them.

    A sliver has some nodes at most and less area than a cell. It joins the neighbour with the longest common border if that
    one has nodes and a worse (higher) label, up to `worst`. With `worst` -1 any label will do, for slivers without nodes alone.

    Returns
    -------
    kept : list of int
        Numbers of the stretches that still part two regions.
    group : dict
        Number of a region -> that of the region that it is part of.
    count : int
        Slivers that joined.
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
        if _joins(parts[r], parts[enclosing], worst):
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
                radius = min(0.3 * min(extent(path) for path in paths.values()), span)
                directions = {k: bearing(path, radius) for k, path in paths.items()}
            back = directions[~i]
            choice = [min(choice, key=lambda k: ((back - directions[k]) % (2 * np.pi) or 2 * np.pi, k))]
        out.append((i, choice[0]))
    return out


def _lies_in(point: Floats, path: Floats, ring: Floats) -> bool:
    """Whether a point (2,) lies in a loop, whose box is looked at first."""
    return bool((path.min(axis=0) <= point).all() and (point <= path.max(axis=0)).all() and holds(ring, point[None])[0])


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
        enclosing = [o for o in holes if _lies_in(probe, paths[o], rings[o])]
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
    first = [max(int(np.searchsorted(line, low[a])) - 1, 0) for a, line in enumerate((grid.u, grid.v))]
    last = [min(int(np.searchsorted(line, high[a])) + 1, shape[a]) for a, line in enumerate((grid.u, grid.v))]
    u, v = grid.u[first[0] : last[0]], grid.v[first[1] : last[1]]
    if not (len(u) and len(v)):
        return np.empty(0, np.int32), np.empty(0, np.int32)
    rows, columns = np.nonzero(inside(ring, u, v))
    return np.asarray(rows + first[0], np.int32), np.asarray(columns + first[1], np.int32)


def _nearest_label(region: Region, scale: Floats, grid: LabelGrid, known: Ints) -> int:
    """The label of the known node that is nearest to a place inside, in cells."""
    at = [
        float(np.interp(x, line, np.arange(len(line))))
        for x, line in zip(interior_point(region.ring / scale), (grid.u, grid.v), strict=True)
    ]
    i, j = np.nonzero(known >= 0)
    nearest = int(np.argmin(np.hypot(i - at[0], j - at[1])))
    return int(known[i[nearest], j[nearest]])
