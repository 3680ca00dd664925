"""Edges of a triangulation are flipped until it is Delaunay's (Lawson, 1977).

GEOS cuts ears off a region and then flips edges in a fixed number of rounds: in a long strip the ears are as long as the strip,
and the rounds end before they are gone. A triangle from one end of a strip to the other is cut into thousands before it is
near a surface.
"""

import numpy as np

from cad_io.arrays import Floats, Ints
from plan_cutters_base.jit import entry, kernel

#: A corner is in the circle of another triangle if it is so far in it, and a corner bends if it bends so much: shares of the
#: terms that cancel where points lie on one circle or on one line.
_CLEAR = 1e-9


def delaunay(point: Floats, corner: Ints) -> Ints:
    """The triangles after flips of their inner edges.

    Parameters
    ----------
    point : (n, 2) float
    corner : (t, 3) int
        Rows of `point`, counter-clockwise; an edge belongs to two of them at most.

    Returns
    -------
    (t, 3) int
        They cover the same region and have the same outer edges.
    """
    corners, twin = corner.astype(np.int64), _twins(corner)
    # Lawson's flips end, at the latest when each pair of points was an edge once; with rounding, a number ends them.
    _flip(np.ascontiguousarray(point), corners.ravel(), twin, min(len(corner) ** 2 // 2, 50_000_000))
    return corners.astype(corner.dtype)


def _twins(corner: Ints) -> Ints:
    """Number (3 t,) of the half edge that runs the other way, -1 for none; half edge 3 i + k begins at corner k of triangle i."""
    start = corner.ravel().astype(np.int64)
    end = np.roll(corner, -1, axis=1).ravel().astype(np.int64)
    wide = int(start.max(initial=0)) + 1
    order = np.argsort(start * wide + end, kind="stable")
    key, wanted = (start * wide + end)[order], end * wide + start
    at = np.minimum(np.searchsorted(key, wanted), len(key) - 1)
    return np.where(key[at] == wanted, order[at], -1)


@kernel
def _turn(point, a, b, c):
    """Twice the area of a triangle, and the size that rounding is a share of."""
    ux, uy = point[b, 0] - point[a, 0], point[b, 1] - point[a, 1]
    vx, vy = point[c, 0] - point[a, 0], point[c, 1] - point[a, 1]
    return ux * vy - uy * vx, abs(ux * vy) + abs(uy * vx)


@kernel
def _within(point, a, b, c, d):
    """Whether d is clearly in the circle through the corners of a counter-clockwise triangle."""
    ax, ay = point[a, 0] - point[d, 0], point[a, 1] - point[d, 1]
    bx, by = point[b, 0] - point[d, 0], point[b, 1] - point[d, 1]
    cx, cy = point[c, 0] - point[d, 0], point[c, 1] - point[d, 1]
    aa, bb, cc = ax * ax + ay * ay, bx * bx + by * by, cx * cx + cy * cy
    determinant = aa * (bx * cy - by * cx) + bb * (cx * ay - cy * ax) + cc * (ax * by - ay * bx)
    size = aa * (abs(bx * cy) + abs(by * cx)) + bb * (abs(cx * ay) + abs(cy * ax)) + cc * (abs(ax * by) + abs(ay * bx))
    return determinant > _CLEAR * size


@kernel
def _next(h):
    return h + 1 if h % 3 < 2 else h - 2


@kernel
def _join(twin, h, other):
    twin[h] = other
    if other >= 0:
        twin[other] = h


@entry
def _flip(point, corner, twin, most):
    """Flip edges, `most` times at the most, in `corner` and `twin` (3 t,)."""
    open_edges = np.empty(len(corner), np.int64)
    waiting = np.ones(len(corner), np.bool_)
    top = len(corner)
    for h in range(top):
        open_edges[h] = top - 1 - h
    flips = 0
    while top > 0 and flips < most:
        top -= 1
        h = open_edges[top]
        waiting[h] = False
        g = twin[h]
        if g < 0:
            continue
        hn, gn = _next(h), _next(g)
        hp, gp = _next(hn), _next(gn)
        a, b, c, d = corner[h], corner[g], corner[hp], corner[gp]
        if not _within(point, a, b, c, d):
            continue
        one, size_one = _turn(point, c, a, d)
        two, size_two = _turn(point, d, b, c)
        if not (one > _CLEAR * size_one and two > _CLEAR * size_two):
            continue
        to_b, to_a, from_a, from_b = twin[hn], twin[hp], twin[gn], twin[gp]
        corner[h], corner[hn], corner[hp] = c, a, d
        corner[g], corner[gn], corner[gp] = d, b, c
        _join(twin, h, to_a)
        _join(twin, hn, from_a)
        _join(twin, g, from_b)
        _join(twin, gn, to_b)
        _join(twin, hp, gp)
        flips += 1
        for each in (h, hn, g, gn):
            if not waiting[each]:
                waiting[each] = True
                open_edges[top] = each
                top += 1
