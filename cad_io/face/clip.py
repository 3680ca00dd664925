"""How much of small rectangles in a face's parameter plane lies in its trim, and where in them?

Rectangles are tiles between the lines of a grid. The border is cut along these lines; each piece then adds to its own
tile and, all of their widths, to the tiles at smaller u on its row: areas and middles are exact for the trim's polygon.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from cad_io.arrays import Floats
from cad_io.face.trim import Trim

Indices = NDArray[np.int64]
Bools = NDArray[np.bool_]

#: Shares of a tile that count as nothing, or as missing nothing.
_NOTHING = 1e-9
_NUDGE = 1e-6  # of a tile
_AT_ONCE = 1 << 22  # points times segments compared at once


class Clipped(NamedTuple):
    """This record describes the parts of n tiles that lie in a trim, in parameters.

    area : (n,) float; middle : (n, 2) float, centre of gravity, or a point on the border where that lies outside;
    low, high : (n, 2) float, a box around it; whole : (n,) bool, the tile lies in the trim altogether. Where the area is
    zero, the rest has no meaning.
    """

    area: Floats
    middle: Floats
    low: Floats
    high: Floats
    whole: Bools

    def at(self, rows: Indices | Bools) -> "Clipped":
        """Some of the tiles."""
        return Clipped(self.area[rows], self.middle[rows], self.low[rows], self.high[rows], self.whole[rows])


def clipped(trim: Trim, u: Floats, v: Floats, tile: Indices) -> Clipped:
    """Clip tiles of the parameter plane to a trim.

    Parameters
    ----------
    trim : Trim
    u, v : (nu + 1,), (nv + 1,) float
        Increasing grid lines, which enclose the trim.
    tile : (n, 2) int
        Tile (i, j) lies between the lines i and i + 1 of u, and j and j + 1 of v.
    """
    low = np.stack([u[tile[:, 0]], v[tile[:, 1]]], axis=1)
    high = np.stack([u[tile[:, 0] + 1], v[tile[:, 1] + 1]], axis=1)
    full = (high - low).prod(axis=1)
    if trim.rectangular:
        u0, u1, v0, v1 = trim.box
        inner_low, inner_high = np.maximum(low, (u0, v0)), np.minimum(high, (u1, v1))
        area = np.maximum(inner_high - inner_low, 0.0).prod(axis=1)
        area[area <= _NOTHING * full] = 0.0
        middle = 0.5 * (inner_low + inner_high)
        return Clipped(area, middle, inner_low, inner_high, area >= (1 - _NOTHING) * full)
    pieces = _Pieces(trim.segments, u, v)
    first, last, beyond = pieces.of(tile)
    size = high - low
    area = pieces.sums(first, last, 0) + size[:, 0] * pieces.sums(last, beyond, 3)
    moment = np.stack(
        [
            pieces.sums(first, last, 1) + 0.5 * size[:, 0] ** 2 * pieces.sums(last, beyond, 3),
            pieces.sums(first, last, 2) + size[:, 0] * pieces.sums(last, beyond, 4),
        ],
        axis=1,
    )
    area = np.where(area <= _NOTHING * full, 0.0, area)
    whole = area >= (1 - _NOTHING) * full
    with np.errstate(all="ignore"):
        middle = np.where(whole[:, None], 0.5 * (low + high), low + moment / area[:, None])
    area = np.minimum(area, full)
    parts = np.flatnonzero((area > 0) & ~whole)
    box_low, box_high, longest = pieces.extent(first[parts], last[parts])
    for share in ((0, 0), (0, 1), (1, 0), (1, 1)):
        # Seen from within the tile: the corner itself may lie on the border.
        at = low[parts] + np.clip(share, _NUDGE, 1 - _NUDGE) * size[parts]
        corner = np.where(inside(trim.segments, at)[:, None], low[parts] + np.array(share) * size[parts], np.nan)
        box_low, box_high = np.fmin(box_low, corner), np.fmax(box_high, corner)
    # Rounding must not make a box of nothing: what has no piece is as good as whole.
    low[parts] = np.where(np.isfinite(box_low), np.maximum(box_low, low[parts]), low[parts])
    high[parts] = np.where(np.isfinite(box_high), np.minimum(box_high, high[parts]), high[parts])
    middle[parts] = np.clip(middle[parts], low[parts], high[parts])
    out = ~inside(trim.segments, middle[parts]) & np.isfinite(longest).all(axis=1)
    middle[parts[out]] = longest[out]
    return Clipped(area, middle, low, high, whole)


def inside(segments: Floats, uv: Floats) -> Bools:
    """Which of scattered points (n, 2) lie within the polygon of segments (m, 2, 2), by the even-odd rule."""
    (pu, pv), (qu, qv) = segments[:, 0].T, segments[:, 1].T
    slope = np.divide(qu - pu, qv - pv, out=np.zeros(len(pu)), where=qv != pv)
    result = np.zeros(len(uv), bool)
    step = max(1, _AT_ONCE // max(1, len(segments)))
    for start in range(0, len(uv), step):
        u, v = uv[start : start + step, :1], uv[start : start + step, 1:]
        crosses = ((pv <= v) != (qv <= v)) & (pu + (v - pv) * slope < u)
        result[start : start + step] = crosses.sum(axis=1) % 2 == 1
    return result


class _Pieces:
    """The border cut along grid lines, in the order of rows and of tiles on them."""

    def __init__(self, segments: Floats, u: Floats, v: Floats) -> None:
        start, end = _cut(segments, u, v)
        middle = 0.5 * (start + end)
        column = np.searchsorted(u, middle[:, 0], "right") - 1
        row = np.searchsorted(v, middle[:, 1], "right") - 1
        self.width = len(u) + 1
        key = row * self.width + column + 1
        order = np.argsort(key, kind="stable")
        order = order[(row[order] >= 0) & (row[order] < len(v) - 1)]
        self.key, self.start, self.end = key[order], start[order], end[order]
        # What lies at larger u than all tiles reaches over their whole widths, what lies at smaller u not at all.
        corner = np.stack([u[np.clip(column[order], 0, len(u) - 2)], v[row[order]]], axis=1)
        (x0, y0), (x1, y1) = (self.start - corner).T, (self.end - corner).T
        step = y1 - y0
        sums = np.stack(
            [
                0.5 * (x0 + x1) * step,
                (x0 * x0 + x0 * x1 + x1 * x1) * step / 6,
                (2 * x0 * y0 + 2 * x1 * y1 + x0 * y1 + x1 * y0) * step / 6,
                step,
                0.5 * (y0 + y1) * step,
            ]
        )
        # A border that runs the wrong way round makes all of it negative.
        p, q = segments[:, 0], segments[:, 1]
        turn = np.sign((p[:, 0] * q[:, 1] - p[:, 1] * q[:, 0]).sum()) or 1.0
        self.total = np.concatenate([np.zeros((5, 1)), np.cumsum(turn * sums, axis=1)], axis=1)

    def of(self, tile: Indices) -> tuple[Indices, Indices, Indices]:
        """First piece in each tile, first one after these, and first one after the tile's row."""
        key = tile[:, 1] * self.width + tile[:, 0] + 1
        ends = (key, key + 1, (tile[:, 1] + 1) * self.width)
        first, last, beyond = (np.searchsorted(self.key, end) for end in ends)
        return first, last, beyond

    def sums(self, first: Indices, last: Indices, which: int) -> Floats:
        return np.asarray(self.total[which, last] - self.total[which, first])

    def extent(self, first: Indices, last: Indices) -> tuple[Floats, Floats, Floats]:
        """Box (n, 2) twice around the pieces of tiles, and the middle (n, 2) of the longest; nan where there is none."""
        low, high, longest = (np.full((len(first), 2), np.nan) for _ in range(3))
        some = np.flatnonzero(last > first)
        if len(some):
            which = np.repeat(np.arange(len(some)), (last - first)[some])
            begin = np.concatenate([[0], np.cumsum((last - first)[some])[:-1]])
            index = first[some][which] + np.arange(len(which)) - begin[which]
            a, b = self.start[index], self.end[index]
            low[some] = np.minimum.reduceat(np.minimum(a, b), begin)
            high[some] = np.maximum.reduceat(np.maximum(a, b), begin)
            order = np.lexsort([np.abs(b - a).sum(axis=1), which])
            at = order[np.append(begin[1:], len(which)) - 1]
            longest[some] = 0.5 * (a + b)[at]
        return low, high, longest


def _cut(segments: Floats, u: Floats, v: Floats) -> tuple[Floats, Floats]:
    """Starts and ends (k, 2) of segments cut where they cross lines."""
    p, along = segments[:, 0], segments[:, 1] - segments[:, 0]
    owner, share = [np.arange(len(p)), np.arange(len(p))], [np.zeros(len(p)), np.ones(len(p))]
    for axis, lines in ((0, u), (1, v)):
        a, b = np.sort(segments[:, :, axis], axis=1).T
        first = np.searchsorted(lines, a, "right")
        count = np.maximum(np.searchsorted(lines, b, "left") - first, 0)
        which = np.repeat(np.arange(len(p)), count)
        line = lines[first[which] + np.arange(len(which)) - np.repeat(np.cumsum(count) - count, count)]
        owner.append(which)
        share.append(np.clip((line - p[which, axis]) / along[which, axis], 0.0, 1.0))
    who, at = np.concatenate(owner), np.concatenate(share)
    order = np.lexsort([at, who])
    who, at = who[order], at[order]
    point = np.where((at == 1.0)[:, None], segments[who, 1], p[who] + at[:, None] * along[who])
    same = who[1:] == who[:-1]
    return point[:-1][same], point[1:][same]
