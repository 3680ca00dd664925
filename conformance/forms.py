"""Closed forms: the signed margin of a convex piece of a tool from a piece of material.

Each form is a body of material. `gap(piece, tip, axis)` is its distance (mm) from the piece, below zero where they meet; the depth follows from
the insets of the piece (`tool.margin`). The derivations:

*Separating planes.* Two convex bodies T and K are apart by the largest distance of two parallel planes between them:
`gap = max over unit m of (min over T of m.x - max over K of m.x) = max over m of (-support_T(-m) - support_K(m))`. Only directions m that are outer
normals of K somewhere count. A half-space has one such m; a wedge the arc between the normals of its two planes; a prism the arcs at each
of its edges; a polyhedron the normals of its faces, the arcs at its edges, and at each corner the direction to the piece.

*Bore.* Material outside a round hole: the tool has to stay inside. The farthest point of a frustum from the hole's line lies on one of its two circles, and one
angle finds it there: `gap = radius - far - rho`.

*Surface.* Material behind a parametrised surface: `gap = min over (u, v) of signed(S(u, v))`, by a grid and a local search that ends at 1e-9 mm.
It is the definition of the margin itself, for a tool that does not lie in the material as a whole.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache
from typing import Protocol

import numpy as np

from conformance.tool import Floats, Piece, margin

#: How often a grid of angles shrinks to a quarter about its best.
_ZOOMS = 11
#: A search on a surface: where it starts, its rounds, and the grid.
_STARTS, _ROUNDS = 5, 44
_GRID = np.array([(a, b) for a in np.linspace(-1.5, 1.5, 9) for b in np.linspace(-1.5, 1.5, 9)])


class Material(Protocol):
    """A body of material."""

    name: str

    def gap(self, piece: Piece, tip: Floats, axis: Floats) -> Floats:
        """Return a number (n,) below zero where a piece at `tip`, `axis (n, 3)` meets the material, else the distance (mm)."""

    def margin(self, piece: Piece, tip: Floats, axis: Floats) -> Floats:
        """Return the signed margin (n,), mm: the distance, or minus the depth."""

    def height(self, points: Floats) -> Floats:
        """Return how far `points (n, 3)` lie outside, mm: 0 on the skin."""


class _Gapped:
    """What a margin and a height make of a gap."""

    def gap(self, piece: Piece, tip: Floats, axis: Floats) -> Floats:
        raise NotImplementedError

    def margin(self, piece: Piece, tip: Floats, axis: Floats) -> Floats:
        """Return the signed margin (n,): only what meets the material is bisected."""
        out = np.asarray(self.gap(piece, tip, axis), float)
        hit = np.flatnonzero(out < 0)
        if len(hit):
            out[hit] = margin(lambda smaller: self.gap(smaller, tip[hit], axis[hit]), piece)
        return out

    def height(self, points: Floats) -> Floats:
        """Return how far points lie outside: they are pieces without extent."""
        up = np.broadcast_to(np.array([0.0, 0.0, 1.0]), points.shape)
        return self.gap(Piece(0.0, 0.0, 0.0, 0.0), points, up)


@dataclass(frozen=True)
class Prism(_Gapped):
    """A convex prism along `direction` without end, rounded by `radius`; its outer normals go from angle `start` to `end` (rad).

    `vertices (k, 3)` are points of its edges. Angles are in the plane across: 0 is `zero`, and they grow about `direction`. A half-space has one
    vertex and `start == end`; a wedge one vertex and an arc; a slab two; a rod one, a radius and all angles.
    """

    name: str
    vertices: tuple[tuple[float, float, float], ...]
    direction: tuple[float, float, float]
    zero: tuple[float, float, float]
    start: float = 0.0
    end: float = 0.0
    radius: float = 0.0

    def gap(self, piece: Piece, tip: Floats, axis: Floats) -> Floats:
        """Return the largest distance between parallel planes over the normals."""
        d, x = np.array(self.direction, float), np.array(self.zero, float)
        d, x = d / np.linalg.norm(d), x / np.linalg.norm(x)
        y = np.cross(d, x)
        corners = np.array(self.vertices, float)

        def apart(angle: Floats) -> Floats:
            m = np.cos(angle)[..., None] * x + np.sin(angle)[..., None] * y
            return -_support(piece, -m, tip, axis) - np.max(m @ corners.T, axis=-1) - self.radius

        return _most(apart, self.start, self.end, len(tip))


def _support(piece: Piece, u: Floats, tip: Floats, axis: Floats) -> Floats:
    """Return the support (n, k) of a piece in k directions `u (n, k, 3)` for each posture."""
    return _wide(piece).support(u, tip[:, None], axis[:, None])


def _wide(piece: Piece) -> Piece:
    """Return the piece with a second axis in its numbers."""
    wide = {name: np.asarray(getattr(piece, name), float) for name in ("h0", "r0", "h1", "r1", "rho")}
    return Piece(**{name: value[:, None] if value.ndim else value for name, value in wide.items()})


def half_space(name: str, point: tuple[float, float, float], normal: tuple[float, float, float]) -> Prism:
    """Return the material behind the plane through `point` with the outer `normal`."""
    n = np.array(normal, float)
    side = np.cross(n, np.eye(3)[np.argmin(np.abs(n))])
    return Prism(name, (point,), tuple(side), tuple(n))


def wedge(name: str, point: tuple[float, float, float], first: tuple[float, float, float], second: tuple[float, float, float]) -> Prism:
    """Return the convex wedge of material whose edge goes through `point`, between planes with these outer normals."""
    a, b = (np.array(v, float) / np.linalg.norm(v) for v in (first, second))
    along = np.cross(a, b)
    angle = np.arctan2(np.linalg.norm(along), a @ b)
    return Prism(name, (point,), tuple(along / np.linalg.norm(along)), tuple(a), 0.0, float(angle))


def section(name: str, *points: tuple[float, float], radius: float = 0.0) -> Prism:
    """Return a convex polygon of the x z plane, without end along y, its corners in any order."""
    return Prism(name, tuple((x, 0.0, z) for x, z in points), (0.0, 1.0, 0.0), (1.0, 0.0, 0.0), 0.0, 2.0 * np.pi, radius)


def _most(of: Callable[[Floats], Floats], start: float, end: float, count: int) -> Floats:
    """Return the largest value (n,) over an interval: `of(angles (n, k))` on a grid, then on ever smaller grids about its best."""
    if end <= start:
        return of(np.full((count, 1), start))[:, 0]
    grid = np.linspace(start, end, max(9, int(np.ceil((end - start) / 0.05)) + 1))
    angles = np.tile(grid, (count, 1))
    width = grid[1] - grid[0]
    best = np.full(count, -np.inf)
    for _ in range(_ZOOMS):
        values = of(angles)
        pick = np.argmax(values, axis=1)[:, None]
        best = np.maximum(best, np.take_along_axis(values, pick, 1)[:, 0])
        angles = np.take_along_axis(angles, pick, 1) + width * np.linspace(-1, 1, 9)
        # A full turn has no ends: the best may lie across the seam.
        angles = angles if end - start > 2 * np.pi - 1e-9 else np.clip(angles, start, end)
        width = 0.25 * width
    return best


@dataclass(frozen=True)
class Hull(_Gapped):
    """The convex hull of `vertices (k, 3)`, rounded by `radius`: a box, a tetrahedron, a ball (one vertex)."""

    name: str
    vertices: tuple[tuple[float, float, float], ...]
    radius: float = 0.0

    def gap(self, piece: Piece, tip: Floats, axis: Floats) -> Floats:
        """Return the largest distance between parallel planes over the normals of faces, edges and corners."""
        corners = np.array(self.vertices, float)
        if len(corners) == 1:
            return piece.at(np.broadcast_to(corners[0], tip.shape), tip, axis) - self.radius

        def apart(m: Floats) -> Floats:
            return -_support(piece, -m, tip, axis) - np.max(m @ corners.T, axis=-1) - self.radius

        faces, first, second = _normals(self.vertices)
        best = np.max(apart(np.broadcast_to(faces, (len(tip), *faces.shape))), axis=1)
        slant = np.linalg.norm(first + second, axis=1, keepdims=True)
        middle, across = (first + second) / slant, (second - first) / np.linalg.norm(second - first, axis=1, keepdims=True)
        angle = np.arccos(np.clip(0.5 * slant, -1.0, 1.0))
        centre, width = np.zeros((len(tip), len(first), 1)), 1.0
        for _ in range(_ZOOMS):
            share = np.clip(centre + width * np.linspace(-1, 1, 9), -1.0, 1.0)
            turn = share * angle
            m = np.cos(turn)[..., None] * middle[:, None] + np.sin(turn)[..., None] * across[:, None]
            values = apart(m.reshape(len(tip), -1, 3)).reshape(share.shape)
            centre = np.take_along_axis(share, np.argmax(values, axis=2)[..., None], 2)
            best, width = np.maximum(best, np.max(values, axis=(1, 2))), 0.25 * width
        # Of the directions about a corner, the one from the corner to the piece: the slope of the piece's distance.
        steps = 1e-6 * np.eye(3)
        at = lambda p: piece_at(piece, p, tip, axis)
        m = np.stack([at(corners + e) - at(corners - e) for e in steps], axis=-1)
        length = np.linalg.norm(m, axis=-1, keepdims=True)
        m = np.where(length > 0, -m / np.where(length > 0, length, 1.0), faces[0])
        return np.maximum(best, np.max(apart(m), axis=1))


def piece_at(piece: Piece, points: Floats, tip: Floats, axis: Floats) -> Floats:
    """Return the signed distance (n, k) of points (k, 3) from the piece of each posture."""
    return _wide(piece).at(points, tip[:, None], axis[:, None])


@lru_cache(maxsize=512)
def _normals(vertices: tuple[tuple[float, float, float], ...]) -> tuple[Floats, Floats, Floats]:
    """Return the outer normals of a polyhedron's faces, and for each of its edges the normals of the two faces."""
    from scipy.spatial import ConvexHull

    hull = ConvexHull(np.array(vertices, float))
    n = hull.equations[:, :3]
    pairs = np.array([(i, j) for i, row in enumerate(hull.neighbors) for j in row if i < j and n[i] @ n[j] < 1 - 1e-12])
    return np.unique(np.round(n, 15), axis=0), n[pairs[:, 0]], n[pairs[:, 1]]


def box(name: str, low: tuple[float, float, float], high: tuple[float, float, float]) -> Hull:
    """Return an axis-parallel box."""
    (x0, y0, z0), (x1, y1, z1) = low, high
    return Hull(name, tuple((x, y, z) for x in (x0, x1) for y in (y0, y1) for z in (z0, z1)))


def ball(name: str, centre: tuple[float, float, float], radius: float) -> Hull:
    """Return a ball of material."""
    return Hull(name, (centre,), radius)


@dataclass(frozen=True)
class Bore(_Gapped):
    """The material outside a round hole without end about the line through `point` along `direction`."""

    name: str
    point: tuple[float, float, float]
    direction: tuple[float, float, float]
    radius: float

    def gap(self, piece: Piece, tip: Floats, axis: Floats) -> Floats:
        """Return the radius less the largest distance of the two circles from the line."""
        d = np.array(self.direction, float) / np.linalg.norm(self.direction)
        e1 = np.cross(axis, d)
        width = np.linalg.norm(e1, axis=1)[:, None]
        spare = np.cross(axis, np.where(np.abs(axis[:, :1]) < 0.7, [[1.0, 0, 0]], [[0, 1.0, 0]]))
        e1 = np.where(width > 1e-9, e1 / np.where(width > 1e-9, width, 1), spare / np.linalg.norm(spare, axis=1)[:, None])
        e2 = np.cross(axis, e1)

        def far(h: Floats, r: Floats) -> Floats:
            def off(angle: Floats) -> Floats:
                centre = tip + np.asarray(h)[..., None] * axis - np.array(self.point, float)
                around = np.cos(angle)[..., None] * e1[:, None] + np.sin(angle)[..., None] * e2[:, None]
                p = centre[:, None] + np.broadcast_to(np.asarray(r, float), (len(tip),))[:, None, None] * around
                return np.linalg.norm(p - (p @ d)[..., None] * d, axis=-1)

            return _most(off, 0.0, 2 * np.pi, len(tip))

        return self.radius - np.maximum(far(piece.h0, piece.r0), far(piece.h1, piece.r1)) - piece.rho


@dataclass(frozen=True)
class Surface:
    """Material behind a parametrised surface `at(u, v) -> (..., 3)` over `u` and `v` ranges; `across` (mm) is the pitch of the grid.

    The tool must not lie in the material as a whole, for only the skin is looked at.
    """

    name: str
    at: Callable[[Floats, Floats], Floats]
    u: tuple[float, float]
    v: tuple[float, float]
    grid: tuple[int, int] = (121, 121)

    def margin(self, piece: Piece, tip: Floats, axis: Floats) -> Floats:
        """Return the least signed distance over the surface."""
        # Blocks keep the arrays within some ten megabytes.
        step = max(1, 300_000 // (self.grid[0] * self.grid[1]))
        blocks = [self._least(piece, tip[i : i + step], axis[i : i + step]) for i in range(0, len(tip), step)]
        return np.concatenate(blocks) if blocks else np.zeros(0)

    def _least(self, piece: Piece, tip: Floats, axis: Floats) -> Floats:
        u, v = (x.ravel() for x in np.meshgrid(np.linspace(*self.u, self.grid[0]), np.linspace(*self.v, self.grid[1]), indexing="ij"))
        tip, axis = tip[:, None], axis[:, None]
        values = piece.at(self.at(u, v)[None], tip, axis)
        # A shrinking pattern from the best few points of the grid that no neighbour is below: along a crease there are many.
        square = np.pad(values.reshape(-1, *self.grid), ((0, 0), (1, 1), (1, 1)), constant_values=np.inf)
        (a, b), lowest = self.grid, np.ones((len(values), *self.grid), bool)
        for k, (i, j) in enumerate(((0, 1), (1, 0), (0, 0), (0, 2), (1, 2), (2, 1), (2, 0), (2, 2))):
            # Of equal neighbours, as at the apex of a cone, one is enough.
            other = square[:, i : i + a, j : j + b]
            lowest &= square[:, 1:-1, 1:-1] < other if k < 4 else square[:, 1:-1, 1:-1] <= other
        start = np.argpartition(np.where(lowest.reshape(len(values), -1), values, values + 1e3), _STARTS, axis=1)[:, :_STARTS]
        bu, bv, best = u[start], v[start], np.take_along_axis(values, start, axis=1)
        du, dv = (self.u[1] - self.u[0]) / (self.grid[0] - 1), (self.v[1] - self.v[0]) / (self.grid[1] - 1)
        size = np.ones_like(best)
        for _ in range(_ROUNDS):
            tu = np.clip(bu[..., None] + du * size[..., None] * _GRID[:, 0], *self.u)
            tv = np.clip(bv[..., None] + dv * size[..., None] * _GRID[:, 1], *self.v)
            new = piece.at(self.at(tu, tv), tip[..., None, :], axis[..., None, :])
            pick = np.argmin(new, axis=2)[..., None]
            better = np.take_along_axis(new, pick, 2)[..., 0]
            gains = better < best - 1e-12
            bu = np.where(gains, np.take_along_axis(tu, pick, 2)[..., 0], bu)
            bv = np.where(gains, np.take_along_axis(tv, pick, 2)[..., 0], bv)
            # A narrow valley across the parameters is walked along: the grid shrinks fast only where it has stopped to gain.
            size = size * np.where(gains, 0.8, 0.4)
            best = np.minimum(best, better)
        return np.min(best, axis=1)

    def gap(self, piece: Piece, tip: Floats, axis: Floats) -> Floats:
        """Return what the margin is: its sign costs no less."""
        return self.margin(piece, tip, axis)

    def height(self, points: Floats) -> Floats:
        """Return the distance of points from the surface."""
        up = np.broadcast_to(np.array([0.0, 0.0, 1.0]), points.shape)
        return self.margin(Piece(0.0, 0.0, 0.0, 0.0), points, up)
