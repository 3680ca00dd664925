"""Stages around a body of revolution: cylinders and cones, one on the other, of which none is smaller than what it encloses."""

from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from cad_io.arrays import Floats
from plan_cutters.domain.holder import Segment
from plan_cutters.errors import CutterError

#: Heights and radii this close to each other, mm, are the same.
_SAME = 1e-9
#: Slices into which what is no line of its own is cut.
_SLICES = 400
#: A stage is nowhere thinner, mm.
_THINNEST = 1e-3
#: Times by which stages may get coarser until there are few enough, each time twice.
_ROUNDS = 24

#: Height from, height to, radius there and there: enclosing lines, end to end.
Line = tuple[float, float, float, float]


def enclosing_segments(
    line: Floats, exact: NDArray[np.bool_], foot: float, *, tolerance: float, most: int
) -> tuple[tuple[Segment, ...], float]:
    """Stages that enclose lines of a half-plane.

    Parameters
    ----------
    line : (n, 4) float
        Radius and height of both ends, the lower one first, mm.
    exact : (n,) bool
        Lines that become stages as they are where they are the outermost ones.
    foot : float
        Height from which on stages are wanted, mm.
    tolerance : float
        How much farther from the axis than the others stages may be, mm; twice as much, and so on, until there are few enough.
    most : int
        Stages, at most.

    Returns
    -------
    stages : tuple of Segment
        From the lowest up.
    tolerance : float
        The one that was kept.

    Raises
    ------
    CutterError
        The lines span no height, or leave a gap.
    """
    low, high = foot, float(line[:, 3].max())
    if high - low <= _SAME:
        raise CutterError("a holder's outline spans no height along its axis: is it modelled about another axis?")
    top = _envelope(line, exact, low, high)
    keep, allowed = True, tolerance
    lines = _merged(top, allowed, keep=keep)
    for _ in range(_ROUNDS):
        if len(lines) <= most:
            break
        # Too many cylinders and cones of their own: they are joined, too.
        keep = keep and len(_merged([each for each in top if each[1]], 0.0, keep=True)) < most - 1
        allowed *= 2.0
        lines = _merged(top, allowed, keep=keep)
    stages = [Segment(max(r, _THINNEST), to - z, max(s, _THINNEST)) for z, to, r, s in lines if to - z > _SAME]
    return tuple(stages), allowed


def _envelope(line: Floats, exact: NDArray[np.bool_], low: float, high: float) -> list[tuple[Line, bool]]:
    """The outermost of all lines, end to end from the lowest up, and whether it is one of the exact ones."""
    long = line[:, 3] - line[:, 1] > _SAME
    own, others = line[exact & long], line[~exact]
    cuts = [own[:, 1], own[:, 3], _crossings(own), np.array([low, high])]
    if 0 < len(others) <= _SLICES:
        cuts += [others[:, 1], others[:, 3]]
    elif len(others):
        cuts.append(np.linspace(others[:, 1].min(), others[:, 3].max(), _SLICES))
    heights = np.unique(np.concatenate(cuts).clip(low, high))
    heights = heights[np.append(True, np.diff(heights) > _SAME)]
    pieces: list[tuple[Line, bool]] = []
    for z, to in pairwise(heights.tolist()):
        mine = own[(own[:, 1] <= z + _SAME) & (own[:, 3] >= to - _SAME)]
        near = others[(others[:, 1] < to) & (others[:, 3] > z)]
        across = (near[:, 1] <= z + _SAME) & (near[:, 3] >= to - _SAME)
        # What ends within the slice counts all over it with the largest radius that it has there.
        part = near[~across]
        level = max(float(_at(part, np.clip(end, part[:, 1], part[:, 3])).max(initial=-1.0)) for end in (z, to))
        ends = [
            _at(lines, height).max(initial=least) for lines, least in ((mine, -1.0), (near[across], level)) for height in (z, to)
        ]
        first, last = max(ends[0], ends[2]), max(ends[1], ends[3])
        if first < 0.0:
            raise CutterError(f"a holder's outline has a gap between the heights {z:.3g} and {to:.3g} mm: give one body")
        pieces.append(((z, to, float(first), float(last)), ends[0] >= ends[2] and ends[1] >= ends[3]))
    all_round = np.array([(first, z, last, to) for (z, to, first, last), _ in pieces])
    for height, radius in line[exact & ~long][:, [1, 2]].tolist():
        adjacent = all_round[(all_round[:, 1] <= height + _SAME) & (all_round[:, 3] >= height - _SAME)]
        if height >= low and _at(adjacent, np.array(height)).max(initial=0.0) < radius - 1e-6:
            raise CutterError(f"a holder's outline ends in a disk without thickness at the height {height:.3g} mm: close it")
    return pieces


def _at(lines: Floats, height: Floats) -> Floats:
    """Radii of lines at heights; of a line that is level, the larger one."""
    rise = lines[:, 3] - lines[:, 1]
    share = np.divide(height - lines[:, 1], rise, out=np.zeros(len(lines)), where=rise > _SAME)
    radius = lines[:, 0] + share * (lines[:, 2] - lines[:, 0])
    return np.where(rise > _SAME, radius, np.maximum(lines[:, 0], lines[:, 2]))


def _crossings(lines: Floats) -> Floats:
    """Heights at which two lines cross."""
    if len(lines) < 2:
        return np.zeros(0)
    slope = (lines[:, 2] - lines[:, 0]) / (lines[:, 3] - lines[:, 1])
    foot = lines[:, 0] - slope * lines[:, 1]
    i, j = np.triu_indices(len(lines), 1)
    apart = slope[i] - slope[j]
    i, j, apart = i[np.abs(apart) > _SAME], j[np.abs(apart) > _SAME], apart[np.abs(apart) > _SAME]
    height = (foot[j] - foot[i]) / apart
    inside = (height > np.maximum(lines[i, 1], lines[j, 1])) & (height < np.minimum(lines[i, 3], lines[j, 3]))
    return np.asarray(height[inside])


def _merged(top: list[tuple[Line, bool]], tolerance: float, *, keep: bool) -> list[Line]:
    """Lines joined as long as one around them is nowhere farther out than the tolerance; `keep` exact ones as they are."""
    merged: list[Line] = []
    at = 0
    while at < len(top):
        own = top[at][1] and keep
        allowed = _SAME if own else tolerance
        few, many = 1, 1
        run = next((i for i in range(at, len(top)) if (top[i][1] and keep) != own), len(top)) - at
        best = _enclosing([top[at][0]])[0]
        while few < run:
            # Twice as many while that goes well, then halves in between.
            many = min(run, 2 * few)
            line, off = _enclosing([each for each, _ in top[at : at + many]])
            if off > allowed:
                break
            best, few = line, many
        while many - few > 1:
            middle = (few + many) // 2
            line, off = _enclosing([each for each, _ in top[at : at + middle]])
            if off > allowed:
                many = middle
            else:
                best, few = line, middle
        merged.append(best)
        at += few
    return merged


def _enclosing(lines: list[Line]) -> tuple[Line, float]:
    """The line from the first height to the last, nowhere nearer to the axis than those given, that is farther out by least."""
    z = np.array([height for low, high, _, _ in lines for height in (low, high)])
    y = np.array([radius for _, _, first, last in lines for radius in (first, last)])
    if len(lines) == 1:
        return lines[0], 0.0
    # The narrowest strip around points has a side of their hull on one of its borders.
    slopes = [0.0, *_hull_slopes(z, y), *(-slope for slope in _hull_slopes(z, -y))]
    best: tuple[float, float, float] | None = None
    for slope in slopes:
        foot = float((y - slope * z).max())
        off = float((slope * z + foot - y).max())
        if best is None or off < best[0] - _SAME:
            best = off, slope, foot
    assert best is not None
    off, slope, foot = best
    return (float(z[0]), float(z[-1]), slope * float(z[0]) + foot, slope * float(z[-1]) + foot), off


def _hull_slopes(z: Floats, y: Floats) -> list[float]:
    """Slopes of the upper side of the hull of points, which are in the order of z."""
    hull: list[tuple[float, float]] = []
    for point in sorted(zip(z.tolist(), y.tolist(), strict=True)):
        if hull and point[0] - hull[-1][0] <= _SAME:
            point = (hull[-1][0], max(point[1], hull.pop()[1]))
        while len(hull) > 1 and (hull[-1][1] - hull[-2][1]) * (point[0] - hull[-2][0]) <= (point[1] - hull[-2][1]) * (
            hull[-1][0] - hull[-2][0]
        ):
            hull.pop()
        hull.append(point)
    return [(b[1] - a[1]) / (b[0] - a[0]) for a, b in pairwise(hull)]
