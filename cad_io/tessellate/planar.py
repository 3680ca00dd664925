"""Triangles of a region in the plane: cells of a grid where they fit, a constrained Delaunay triangulation around them.

Edges of a triangulation are flipped until it is Delaunay's (Lawson, 1977). GEOS cuts ears off a region and then flips edges in
a fixed number of rounds: in a long strip the ears are as long as the strip, and the rounds end before they are gone. A triangle
from one end of a strip to the other is cut into thousands before it is near a surface.
"""

import numpy as np
import shapely
from numpy.typing import NDArray

from cad_io.arrays import Floats, Ints
from plan_cutters_base.jit import entry, kernel

#: A corner is in the circle of another triangle if it is so far in it, and a corner bends if it bends so much: shares of the
#: terms that cancel where points lie on one circle or on one line.
_CLEAR = 1e-9


def delaunay(point: Floats, corner: Ints) -> Ints:
    """The triangles after flips of their inner edges: they cover the same region and have the same outer edges.

    point (n, 2). corner (t, 3): rows of `point`, counter-clockwise; an edge belongs to two of them at most.
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


#: How far from the border cells stay, in cells: triangles between are not to be slivers.
_AWAY = 0.3
#: What areas of one region may differ by, found in two ways.
_SAME = 1e-9
#: Corners of a cell's two triangles.
_HALVES = np.array([[0, 1, 2], [0, 2, 3]])

Bools = NDArray[np.bool_]
Indices = NDArray[np.int64]


def triangulated(uv: Floats, chords: Ints, lines: tuple[Floats, Floats], metric: Floats) -> tuple[Floats, Ints] | None:
    """Triangles that fill the region that chords enclose, and no other place; None where chords enclose none, or cross.

    uv (n, 2): nodes, each place once. chords (k, 2): rows of `uv`; what is run along twice bounds nothing. lines (nu,) and (nv,):
    of the grid. metric (2,): triangles are well shaped where u and v are multiplied by it. Returns nodes (n + m, 2), those given
    first, and triangles (t, 3), counter-clockwise.
    """
    # A power of two takes no digit.
    factor = np.exp2(np.round(np.log2(metric)))
    border = odd(chords)
    region = _region(uv[border] * factor)
    if region is None:
        return None
    u, v = lines[0] * factor[0], lines[1] * factor[1]
    whole = _whole_cells(region, u, v)
    filled, corner = cells(whole)
    node = np.stack([grid.ravel() for grid in np.meshgrid(lines[0], lines[1], indexing="ij")], axis=1)
    used, filled = np.unique(filled, return_inverse=True)
    corner = filled.ravel()[corner] + len(uv)
    points = np.concatenate([uv, node[used]])
    if whole.any():
        i, j = np.nonzero(whole)
        region = shapely.difference(region, shapely.coverage_union_all(shapely.box(u[i], v[j], u[i + 1], v[j + 1])))
    outer = _corners(region, points * factor)
    if outer is None:
        return None
    corners = upright(points, np.concatenate([corner, outer]).astype(np.int32))
    return (points, corners) if bounded_by(corners, border) else None


def cells(whole: Bools) -> tuple[Indices, Indices]:
    """Of cells (nu, nv) of a grid: numbers of their nodes, u first, and two triangles each, rows of these."""
    i, j = np.nonzero(whole)
    wide = whole.shape[1] + 1
    node = np.stack([i * wide + j, (i + 1) * wide + j, (i + 1) * wide + j + 1, i * wide + j + 1], axis=1)
    return node.ravel(), (4 * np.arange(len(i))[:, None, None] + _HALVES).reshape(-1, 3)


def odd(chords: Ints) -> Ints:
    """Chords (k, 2) that are run along an odd number of times, once each."""
    each, count = _edges(chords)
    return each[count % 2 == 1]


def _edges(ends: Ints) -> tuple[Ints, Indices]:
    """Edges (k, 2) between nodes in order, each once, the smaller number first, and how often each is there."""
    low, high = np.min(ends, axis=1).astype(np.int64), np.max(ends, axis=1).astype(np.int64)
    wide = int(high.max(initial=0)) + 1
    # Numbers are sorted much faster than pairs.
    key, count = np.unique(low * wide + high, return_counts=True)
    return np.stack([key // wide, key % wide], axis=1).astype(np.int32), count


def bounded_by(corner: Ints, border: Ints) -> bool:
    """Whether triangles (t, 3) have these edges (k, 2), once each in order, for a border, and all others in common by two.

    Then a point within the border is covered by an odd number of them: by one at least.
    """
    each, count = _edges(np.stack([corner, np.roll(corner, -1, axis=1)], axis=2).reshape(-1, 2))
    return bool((count <= 2).all()) and np.array_equal(each[count == 1], border)


def places(uv: Floats) -> tuple[Indices, Indices]:
    """Rows of points (n, 2) that stand for each place, and the number of the place of each (n,)."""
    # Complex numbers are sorted by both parts, and faster than pairs; zeros of both signs are one.
    _, first, place = np.unique(np.ascontiguousarray(uv + 0.0).view(complex).ravel(), return_index=True, return_inverse=True)
    return first, place.ravel()


def _region(segments: Floats) -> shapely.Geometry | None:
    """Return the region that segments (k, 2, 2) enclose by the even-odd rule; None where they cross, or do not close."""
    if len(segments) < 3:
        return None
    lines = shapely.multilinestrings(shapely.linestrings(segments))
    if not shapely.is_simple(lines):
        return None
    region = shapely.build_area(lines)
    if shapely.is_empty(region) or not shapely.is_valid(region):
        return None
    return region if shapely.count_coordinates(shapely.boundary(region)) >= len(segments) else None


def _whole_cells(region: shapely.Geometry, u: Floats, v: Floats) -> Bools:
    """Cells (nu - 1, nv - 1) that lie in a region and not next to its border."""
    none = np.zeros((len(u) - 1, len(v) - 1), bool)
    if min(none.shape) < 2:
        return none
    du, dv = _AWAY * np.diff(u), _AWAY * np.diff(v)
    low_u, high_u = (np.broadcast_to((u[:-1] - du)[:, None], none.shape), np.broadcast_to((u[1:] + du)[:, None], none.shape))
    low_v, high_v = np.broadcast_to(v[:-1] - dv, none.shape), np.broadcast_to(v[1:] + dv, none.shape)
    shapely.prepare(region)
    return np.asarray(shapely.contains_properly(region, shapely.box(low_u, low_v, high_u, high_v)))


def _corners(region: shapely.Geometry, points: Floats) -> Ints | None:
    """Rows (t, 3) of points, each place once, at the corners of a region's triangles; None where a corner is at none of them."""
    triangles = shapely.constrained_delaunay_triangles(region)
    place = shapely.get_coordinates(triangles).reshape(-1, 4, 2)[:, :3].reshape(-1, 2)
    first, row = places(np.concatenate([points, place]))
    corner = first[row[len(points) :]]
    if (corner >= len(points)).any():
        return None
    return delaunay(points, upright(points, corner.reshape(-1, 3).astype(np.int32)))


def upright(uv: Floats, corner: Ints) -> Ints:
    """Triangles (t, 3), each turned so that its area in the parameter plane is not negative."""
    return np.where(folded(uv[corner])[:, None], corner[:, [0, 2, 1]], corner)


def folded(corners: Floats) -> NDArray[np.bool_]:
    """Which triangles (t, 3, 2) in the parameter plane run clockwise."""
    (a, b) = (corners[:, k] - corners[:, 0] for k in (1, 2))
    return np.asarray(a[:, 0] * b[:, 1] < a[:, 1] * b[:, 0])
