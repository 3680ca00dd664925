"""Which part of its surface does a face use? Its border in (u, v), whether points lie inside, and how much of small rectangles.

The border is read off the parameter curves of the edges as a polygon, whose chord error is measured. Inside is decided
by the even-odd rule, so the order of the edges does not matter, and neither do seams (which occur twice) nor
degenerated edges (which have a parameter curve too). Points nearer to the border than the chord error are asked of the
kernel, which is right but a thousand times slower. On the border counts as inside.

Rectangles are tiles between the lines of a grid. The border is cut along these lines; each piece then adds to its own
tile and, all of their widths, to the tiles at smaller u on its row: areas and middles are exact for the trim's polygon.

A face is also a region of its surface's parameter plane, read off the exact curves that bound it there: outline, area, nodes in
it.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from math import hypot
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray
from OCP.BRep import BRep_Tool
from OCP.BRepAdaptor import BRepAdaptor_Curve2d
from OCP.BRepTools import BRepTools
from OCP.BRepTopAdaptor import BRepTopAdaptor_FClass2d
from OCP.GeomAbs import GeomAbs_BezierCurve, GeomAbs_BSplineCurve, GeomAbs_C2, GeomAbs_CN, GeomAbs_Line
from OCP.gp import gp_Pnt2d
from OCP.TopAbs import TopAbs_IN, TopAbs_ON
from OCP.TopoDS import TopoDS_Face
from OCP.TopTools import TopTools_IndexedMapOfShape

from cad_io.arrays import Floats, Record
from cad_io.kernel import along, bounding, interval_ends
from cad_io.surface import Surface

Bools = NDArray[np.bool_]

#: Chord error of the border polygon as a share of the face's size.
DEFLECTION = 1e-5
#: Distances from the border that count as on it, mm: the edge's own tolerance within these limits.
ON_LEAST, ON_MOST = 1e-7, 1e-3
_CHORDS = 4  # that each span of a parameter curve starts with
_HALVINGS = 12
_AT_ONCE = 128  # points that are looked at in one grid


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Trim(Record):
    """The border of a face in its parameter plane."""

    face: TopoDS_Face
    #: (n, 2, 2); (u, v) of start and end, the face on the left if its surface is seen with `dS/du x dS/dv` towards the eye.
    segments: Floats
    #: (n,); segments that are the border itself, not chords of it.
    exact: Bools
    #: u least, u most, v least, v most; tight.
    box: tuple[float, float, float, float]
    #: (2,); typical mm per unit of u and of v.
    scale: Floats
    #: Largest measured distance of the polygon from the border, mm.
    deflection: float
    #: Distance from the border that counts as on it, mm.
    tolerance: float
    #: False where the parameter curves do not close; then the kernel decides about every point.
    closed: bool
    #: The face uses the whole of `box`.
    rectangular: bool

    @property
    def uv_area(self) -> float:
        """Area of what the border encloses in the parameter plane."""
        p, q = self.segments[:, 0], self.segments[:, 1]
        return abs(0.5 * float((p[:, 0] * q[:, 1] - p[:, 1] * q[:, 0]).sum()))

    def inside_grid(self, u: Floats, v: Floats, *, border: bool = True) -> Bools:
        """Which nodes of the grid of increasing lines u (nu,) and v (nv,) lie in the face: (nu, nv).

        Without `border`, the polygon alone decides, also about nodes nearer to it than its chord error.
        """
        on_u, on_v = self.tolerance / self.scale
        u0, u1, v0, v1 = self.box
        boxed = np.outer((u >= u0 - on_u) & (u <= u1 + on_u), (v >= v0 - on_v) & (v <= v1 + on_v))
        if self.rectangular:
            return boxed
        if not self.closed:
            i, j = np.nonzero(boxed)
            boxed[i, j] = self._asked(u[i], v[j])
            return boxed
        inside = even_odd(self.segments, u, v)
        if not border:
            return inside
        i, j, near_exact, near = self._band(u, v)
        inside[i[near_exact], j[near_exact]] = True
        rest = near & ~near_exact
        if rest.any():
            i, j = np.unique(np.stack([i[rest], j[rest]]), axis=1)
            inside[i, j] = self._asked(u[i], v[j])
        return inside

    def inside(self, u: Floats, v: Floats) -> Bools:
        """Which of the points (n,), (n,) lie in the face."""
        # The diagonal of a grid is wasteful: a few points at a time.
        result = np.empty(len(u), bool)
        for some in (slice(start, start + _AT_ONCE) for start in range(0, len(u), _AT_ONCE)):
            order_u, order_v = np.argsort(u[some]), np.argsort(v[some])
            grid = self.inside_grid(u[some][order_u], v[some][order_v])
            result[some] = grid[np.argsort(order_u), np.argsort(order_v)]
        return result

    def at(self, segment: Any, share: Floats) -> Floats:
        """Parameters (k, 2) on segments (k,), at shares (k,) of them."""
        start = self.segments[segment, 0]
        return np.asarray(start + share[:, None] * (self.segments[segment, 1] - start))

    def along(self, exact: int, chord: int, first: float) -> tuple[Any, Floats]:
        """Places along the border: segments (k,), and shares (k,) of them.

        exact, chord: into how many pieces to part a segment that is the border itself, and one that is a chord of it; a place in
        each piece, behind its start by the share `first` of it.
        """
        pieces = np.where(self.exact, exact, chord)
        segment = np.repeat(np.arange(len(pieces)), pieces)
        nth = np.arange(len(segment)) - np.repeat(np.cumsum(pieces) - pieces, pieces)
        return segment, (nth + first) / pieces[segment]

    def _asked(self, u: Floats, v: Floats) -> Bools:
        classifier = BRepTopAdaptor_FClass2d(self.face, float(self.tolerance / self.scale.max()))
        states = [classifier.Perform(gp_Pnt2d(a, b)) for a, b in zip(u.tolist(), v.tolist(), strict=True)]
        return np.array([state in (TopAbs_IN, TopAbs_ON) for state in states], dtype=bool)

    def _band(self, u: Floats, v: Floats) -> tuple[NDArray[np.intp], NDArray[np.intp], Bools, Bools]:
        """Grid nodes beside segments: i, j, whether on an exact segment, whether too near to any to be sure."""
        reach = self.tolerance + 2 * self.deflection
        low, high = self.segments.min(axis=1), self.segments.max(axis=1)
        low, high = low - reach / self.scale, high + reach / self.scale
        i0, i1 = np.searchsorted(u, low[:, 0], "left"), np.searchsorted(u, high[:, 0], "right")
        j0, j1 = np.searchsorted(v, low[:, 1], "left"), np.searchsorted(v, high[:, 1], "right")
        count = (i1 - i0) * (j1 - j0)
        which = np.repeat(np.arange(len(count)), count)
        nth = np.arange(len(which)) - np.repeat(np.cumsum(count) - count, count)
        width = (j1 - j0)[which]
        i, j = i0[which] + nth // np.maximum(width, 1), j0[which] + nth % np.maximum(width, 1)
        start = self.segments[which, 0] * self.scale
        along = self.segments[which, 1] * self.scale - start
        offset = np.stack([u[i], v[j]], axis=1) * self.scale - start
        length = np.maximum((along**2).sum(axis=1), 1e-300)
        share = np.clip((offset * along).sum(axis=1) / length, 0, 1)
        distance = np.linalg.norm(offset - share[:, None] * along, axis=1)
        return i, j, self.exact[which] & (distance <= self.tolerance), ~self.exact[which] & (distance <= reach)


def trim_of(face: TopoDS_Face, surface: Surface) -> Trim | None:
    """Border of a face on its whole surface, None if it has no edge with a finite parameter curve."""
    forward, edges = bounding(face)
    scale, size = _scale(forward, surface)
    if scale is None:
        return None
    pieces, exact, tolerance, deflection = [], [], ON_LEAST, 0.0
    for edge, way in edges:
        curve = BRepAdaptor_Curve2d(edge, forward)
        points, deviation = _polyline(curve, scale, DEFLECTION * size)
        if not np.isfinite(points).all():
            return None
        pieces.append(points[::way])
        exact.append(len(points) == 2 and deviation == 0)
        tolerance, deflection = max(tolerance, BRep_Tool.Tolerance_s(edge)), max(deflection, deviation)
    if not pieces:
        return None
    tolerance = min(tolerance, ON_MOST, 1e-4 * size)
    between, gap = joins(pieces, scale)
    segments = np.concatenate([np.stack([p[:-1], p[1:]], axis=1) for p in pieces] + [between])
    straight = np.concatenate([np.full(len(p) - 1, e) for p, e in zip(pieces, exact, strict=True)])
    straight = np.append(straight, np.ones(len(between), bool))
    low, high = segments.min(axis=(0, 1)), segments.max(axis=(0, 1))
    box = (float(low[0]), float(high[0]), float(low[1]), float(high[1]))
    closed = gap < max(10 * tolerance, 1e-3 * size)
    return Trim(
        face, segments, straight, box, scale, deflection, tolerance, closed,
        rectangular=closed and _is_rectangle(segments, low, high, scale, tolerance),
    )  # fmt: skip


def _scale(face: TopoDS_Face, surface: Surface) -> tuple[Floats, float] | tuple[None, float]:
    """Typical mm per unit of u and v, and the face's size in mm, from the kernel's (padded) bounds."""
    u0, u1, v0, v1 = BRepTools.UVBounds_s(face)
    if not (np.isfinite([u0, u1, v0, v1]).all() and u0 < u1 and v0 < v1 and max(-u0, u1, -v0, v1) < 1e50):
        return None, 0.0
    share = np.array([0.2, 0.5, 0.8])
    u, v = (grid.ravel() for grid in np.meshgrid(u0 + share * (u1 - u0), v0 + share * (v1 - v0)))
    speed = np.linalg.norm(surface.first(u, v)[:, 1:], axis=2)
    scale = np.nanmean(speed, axis=0) if np.isfinite(speed).any() else np.zeros(2)
    if not (np.isfinite(scale).all() and (scale > 0).all()):
        return None, 0.0
    return scale, float(np.hypot(*(scale * (u1 - u0, v1 - v0))))


def _polyline(curve: BRepAdaptor_Curve2d, scale: Floats, deflection: float) -> tuple[Floats, float]:
    """Points (n, 2) of a parameter curve with chords within `deflection` (mm), and the largest distance left."""
    ends = np.array([curve.FirstParameter(), curve.LastParameter()])
    if curve.GetType() == GeomAbs_Line:
        return np.array([curve.Value(t).Coord() for t in ends.tolist()]), 0.0
    spans = curve.NbIntervals(GeomAbs_C2)
    knot = interval_ends(spans, curve.Intervals, GeomAbs_C2)
    t = np.interp(np.arange(spans * _CHORDS + 1) / _CHORDS, np.arange(spans + 1), knot).tolist()
    (per_u, per_v), value, worst = scale.tolist(), curve.Value, 0.0
    # Plain numbers: a few dozen points a curve are too few for arrays to pay.
    start = (t[0], *value(t[0]).Coord())
    points = [start[1:]]
    for last in t[1:]:
        far = [((last, *value(last).Coord()), 0)]  # ends of chords yet to be measured, the next one last
        while far:
            end, halvings = far[-1]
            middle = 0.5 * (start[0] + end[0])
            u, v = value(middle).Coord()
            off = hypot((u - 0.5 * (start[1] + end[1])) * per_u, (v - 0.5 * (start[2] + end[2])) * per_v)
            if off > deflection and halvings < _HALVINGS:
                far[-1] = end, halvings + 1
                far.append(((middle, u, v), halvings + 1))
            else:
                worst = max(worst, off)
                points.append(end[1:])
                start = far.pop()[0]
    return np.array(points), worst


def joins(pieces: list[Floats], scale: Floats) -> tuple[Floats, float]:
    """Segments that lead from each piece's end to the start that continues it, and the longest of them in mm."""
    start, end = np.array([p[0] for p in pieces]), np.array([p[-1] for p in pieces])
    following = continuing(start, end, scale)
    joins = np.stack([end, start[following]], axis=1)
    gap = np.linalg.norm((end - start[following]) * scale, axis=1)
    return joins[gap > 0], float(gap.max())


def nearest(segments: Floats, point: Floats) -> tuple[int, float, float]:
    """The segment of (n, 2, 2) that is nearest to a point (2,): its number, the share of its length, the distance."""
    start, step = segments[:, 0], segments[:, 1] - segments[:, 0]
    share = np.clip(((point - start) * step).sum(axis=1) / np.maximum((step * step).sum(axis=1), 1e-300), 0, 1)
    away = np.linalg.norm(start + share[:, None] * step - point, axis=1)
    k = int(away.argmin())
    return k, float(share[k]), float(away[k])


def continuing(start: Floats, end: Floats, scale: Floats) -> NDArray[np.intp]:
    """Which piece's start (n, 2) continues each piece's end (n, 2), each only once, nearest in mm."""
    distance = np.linalg.norm((end[:, None] - start[None]) * scale, axis=2)
    following = distance.argmin(axis=1)
    if len(np.unique(following)) < len(following):
        from scipy.optimize import linear_sum_assignment  # takes a quarter of a second to load

        following = linear_sum_assignment(distance)[1]
    return np.asarray(following)


def _is_rectangle(segments: Floats, low: Floats, high: Floats, scale: Floats, tolerance: float) -> bool:
    """True if all of the border lies on the border of its box and encloses the box."""
    points = np.concatenate([segments[:, 0], segments.mean(axis=1)])
    off = np.minimum(points - low, high - points) * scale
    if (off.min(axis=1) > tolerance).any():
        return False
    a, b = segments[:, 0] - low, segments[:, 1] - low
    return bool(abs(0.5 * (a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]).sum()) > 0.999 * (high - low).prod())


def even_odd(segments: Floats, u: Floats, v: Floats) -> Bools:
    """Nodes (nu, nv) with an odd number of border crossings at smaller u on their row."""
    p, q = segments[:, 0], segments[:, 1]
    first = np.searchsorted(v, np.minimum(p[:, 1], q[:, 1]))
    rows = np.searchsorted(v, np.maximum(p[:, 1], q[:, 1])) - first
    which = np.repeat(np.arange(len(p)), rows)
    row = np.arange(len(which)) - np.repeat(np.cumsum(rows) - rows, rows) + first[which]
    p, q = p[which], q[which]
    crossing = p[:, 0] + (v[row] - p[:, 1]) / (q[:, 1] - p[:, 1]) * (q[:, 0] - p[:, 0])
    toggles = np.zeros((len(u) + 1, len(v)), np.int64)
    np.add.at(toggles, (np.searchsorted(u, crossing), row), 1)
    return toggles[:-1].cumsum(axis=0) % 2 == 1


Indices = NDArray[np.int64]

#: Shares of a tile that count as nothing, or as missing nothing.
_NOTHING = 1e-9
_NUDGE = 1e-6  # of a tile
_AT_ONCE = 1 << 22  # points times segments compared at once


class Clipped(NamedTuple):
    """The parts of n tiles that lie in a trim, in parameters; where the area is zero, the rest has no meaning.

    middle (n, 2): centre of gravity, or a point on the border where that lies outside. low, high (n, 2): a box around it.
    whole (n,): the tile lies in the trim altogether.
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
    """Clip tiles (n, 2) of the parameter plane to a trim, which increasing grid lines u (nu + 1,) and v (nv + 1,) enclose.

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


_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(6)  # exact for polynomial curves up to degree 6
_OFF = 1e-7  # of the grid, that rows are moved by
_ARCS = 8  # intervals that a curve without knots (conic) is cut into


def outline(face: Any) -> Floats:
    """Segments (n, 2, 2) between (u, v) points of the face's boundary, in no order; empty for an unbounded face.

    Curves do not meet exactly at their vertex: what is between their ends are segments, too, or rows would slip through.
    """
    pieces = []
    for curve, ends, sign in boundary(face):
        t = ends
        if len(ends) > 2 or curve.GetType() != GeomAbs_Line:
            t = np.append((ends[:-1, None] + np.diff(ends)[:, None] * np.arange(_CHORDS) / _CHORDS).ravel(), ends[-1])
        uv = np.array([curve.Value(x).Coord() for x in t.tolist()])
        pieces.append(uv if sign > 0 else uv[::-1])
    if not pieces:
        return np.empty((0, 2, 2))
    extent = np.ptp(np.concatenate(pieces), axis=0)
    between, _ = joins(pieces, 1 / np.maximum(extent, 1e-300))
    return np.concatenate([*(np.stack([uv[:-1], uv[1:]], axis=1) for uv in pieces), between])


def uv_areas(faces: Sequence[Any]) -> list[float]:
    """Areas of faces of one surface in (u, v), exact for polynomial boundaries: the integrals of u dv around them.

    What bounds two of them is integrated once.
    """
    known = TopTools_IndexedMapOfShape()
    integrals: dict[tuple[int, Any], float] = {}
    areas = []
    for face in faces:
        total = 0.0
        forward, edges = bounding(face)
        for edge, way in edges:
            # A seam has two curves, by its orientation.
            mark = known.Add(edge), way if BRep_Tool.IsClosed_s(edge, forward) else None
            if mark not in integrals:
                integrals[mark] = _integral(BRepAdaptor_Curve2d(edge, forward))
            total += way * integrals[mark]
        areas.append(total)
    return areas


def _integral(curve: Any) -> float:
    """The integral of u dv along a curve."""
    kind, ends = curve.GetType(), _ends(curve)
    if kind == GeomAbs_Line:
        (u, v), (to_u, to_v) = (curve.Value(float(t)).Coord() for t in (ends[0], ends[-1]))
        return 0.5 * float((u + to_u) * (to_v - v))
    smooth = kind in (GeomAbs_BSplineCurve, GeomAbs_BezierCurve) and curve.NbIntervals(GeomAbs_CN) == 1
    if smooth and not curve.IsRational() and curve.Degree() <= len(_NODES):
        ends = ends[[0, -1]]
    half = 0.5 * np.diff(ends)
    t = ((0.5 * (ends[1:] + ends[:-1]))[:, None] + half[:, None] * _NODES).ravel()
    place, slope = np.moveaxis(along(curve, t), 1, 0)
    return float(((half[:, None] * _WEIGHTS).ravel() * place[:, 0] * slope[:, 1]).sum())


def nodes_inside(segments: Floats, u: Floats, v: Floats) -> NDArray[np.bool_]:
    """Which nodes of the grid u (nu,) x v (nv,), both increasing, lie in an outline: (nu, nv), by even-odd rows."""
    # Borders like to run along grid lines, where rounding decides what a row crosses: rows are taken a little off.
    v = v + _OFF * (v[-1] - v[0])
    return even_odd(segments, u, v)


def interior_point(segments: Floats) -> tuple[float, float]:
    """A point well inside an outline: the middle of the longest of several chords along u."""
    low, high = segments[..., 1].min(), segments[..., 1].max()
    best, middle = -1.0, (float(segments[0, :, 0].mean()), float(segments[0, :, 1].mean()))
    for share in (0.5, 0.31, 0.69, 0.17, 0.83, 0.07, 0.93):
        v = low + share * (high - low)
        p, q = segments[:, 0], segments[:, 1]
        hit = (p[:, 1] <= v) != (q[:, 1] <= v)
        p, q = p[hit], q[hit]
        u = np.sort(p[:, 0] + (v - p[:, 1]) / (q[:, 1] - p[:, 1]) * (q[:, 0] - p[:, 0]))
        for a, b in zip(u[:-1:2].tolist(), u[1::2].tolist(), strict=True):
            if b - a > best:
                best, middle = b - a, (0.5 * (a + b), float(v))
    return middle


def boundary(face: Any) -> list[tuple[Any, Floats, float]]:
    """Boundary curves in (u, v), the ends (k + 1,) of their smooth intervals, +1 or -1 for their direction."""
    forward, edges = bounding(face)
    return [(curve := BRepAdaptor_Curve2d(edge, forward), _ends(curve), float(way)) for edge, way in edges]


def _ends(curve: Any) -> Floats:
    """Ends (k + 1,) of the smooth intervals of a curve; one interval that is not straight is cut into arcs."""
    count = curve.NbIntervals(GeomAbs_CN)
    t = interval_ends(count, curve.Intervals, GeomAbs_CN)
    return np.linspace(t[0], t[1], _ARCS + 1) if count == 1 and curve.GetType() != GeomAbs_Line else t
