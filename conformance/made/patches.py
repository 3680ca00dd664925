"""Patches of exact surfaces for the form Surface, the boxes round a pocket, and a B-spline with its poles."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from conformance.forms import Material, Surface, box
from conformance.made.planar import unit
from conformance.tool import Floats, Piece

#: A full turn with some overlap (rad), so that no least distance lies at the seam.
TURN = (-np.pi - 0.1, np.pi + 0.1)

Flat = tuple[float, float]
Point = tuple[float, float, float]


#: A clearance (mm) that says nothing.
_NONE = 1000.0


@dataclass(frozen=True)
class Inner:
    """Material behind the skins of others: what is deep in it counts, and the way to it does not, for a skin is nearer."""

    body: Material

    @property
    def name(self) -> str:
        """The name of the body."""
        return self.body.name

    def gap(self, piece: Piece, tip: Floats, axis: Floats) -> Floats:
        """Return a number below zero where they meet, else 1000."""
        gap = self.body.gap(piece, tip, axis)
        return np.where(gap < 0, gap, _NONE)

    def margin(self, piece: Piece, tip: Floats, axis: Floats) -> Floats:
        """Return minus the depth, else 1000."""
        depth = self.body.margin(piece, tip, axis)
        return np.where(depth < 0, depth, _NONE)

    def height(self, points: Floats) -> Floats:
        """Return 1000: nothing lies on a skin of it."""
        return np.full(len(points), _NONE)


def revolved_line(name: str, start: Flat, end: Flat, grid: tuple[int, int], turn: Flat = TURN) -> Surface:
    """Return the surface of a line (radius, z) revolved about z: a cone, a cylinder, a ring."""

    def at(u: Floats, v: Floats) -> Floats:
        r, z = start[0] + u * (end[0] - start[0]), start[1] + u * (end[1] - start[1])
        return np.stack([r * np.cos(v), r * np.sin(v), z], axis=-1)

    return Surface(name, at, (0.0, 1.0), turn, grid)


def revolved_arc(name: str, centre: Flat, radius: float, arc: Flat, grid: tuple[int, int]) -> Surface:
    """Return the surface of an arc revolved about z; angles (rad) in the (radius, z) plane from the r direction: a sphere or a torus."""

    def at(u: Floats, v: Floats) -> Floats:
        r, z = centre[0] + radius * np.cos(u), centre[1] + radius * np.sin(u)
        return np.stack([r * np.cos(v), r * np.sin(v), z], axis=-1)

    return Surface(name, at, arc, TURN, grid)


def tile(name: str, corner: Point, first: Point, second: Point, grid: tuple[int, int]) -> Surface:
    """Return a parallelogram from a corner along two edges."""
    c, a, b = (np.array(x, float) for x in (corner, first, second))

    def at(u: Floats, v: Floats) -> Floats:
        return c + u[..., None] * a + v[..., None] * b

    return Surface(name, at, (0.0, 1.0), (0.0, 1.0), grid)


def boxes_round(half: Flat, size: Flat, z: Flat) -> tuple[Inner, ...]:
    """Return, as inner bodies, the four boxes between a rectangle of `half` extents and a block of half extents `size`, from `z[0]` to `z[1]`."""
    (a, b), (x, y), (low, high) = half, size, z
    return (
        inner("block at +x", (a, -y, low), (x, y, high)),
        inner("block at -x", (-x, -y, low), (-a, y, high)),
        inner("block at +y", (-a, b, low), (a, y, high)),
        inner("block at -y", (-a, -y, low), (a, -b, high)),
    )


def inner(name: str, low: Point, high: Point) -> Inner:
    """Return a box behind the skins of others."""
    return Inner(box(name, low, high))


def polygon(radius: float, z: float, count: int = 12, scale: float = 1.0) -> tuple[Point, ...]:
    """Return the corners of a regular polygon about z; `scale` is that of y."""
    turn = 2 * np.pi * np.arange(count) / count
    return tuple((float(radius * np.cos(t)), float(scale * radius * np.sin(t)), z) for t in turn)


def descent(height: float, radius: float, length: float) -> float:
    """Return the angle (deg) by which a ball end's axis may point towards a plane that its ball's centre is `height` away from.

    The lowest point is on the rim of the flat top, `length - radius` from the centre: `(L - r) sin b + r cos b = height`.
    """
    span = np.hypot(length - radius, radius)
    return float(np.degrees(np.arcsin(min(1.0, height / span)) - np.arctan2(radius, length - radius)))


def past_edge(across: float, up: float, radius: float) -> float:
    """Return the angle (deg) from `up` at which the side of a cylinder of this radius meets an edge across its plane.

    The edge is `across` and `up` from a point of the tool's axis: `across cos b - up sin b = radius`.
    """
    return float(np.degrees(np.arccos(radius / np.hypot(across, up)) - np.arctan2(up, across)))


def placed(contact: Sequence[float], normal: Sequence[float], lean: Sequence[float] | None = None, **more: Any) -> dict[str, Any]:
    """Return where an answer holds: contact (mm), unit normal and the direction that the axis tilts to."""
    out = {"contact": [float(x) for x in contact], "normal": unit(normal), **more}
    return out if lean is None else {**out, "lean": unit(lean)}


@dataclass(frozen=True, eq=False)
class Spline:
    """A non-rational B-spline surface: `poles (nu, nv, 3)`, degrees, and clamped uniform knots 0, 1, 2 ... in both directions."""

    poles: Floats
    degree: tuple[int, int]

    def knots(self, side: int) -> Floats:
        """Return the knots with their multiplicity."""
        p, n = self.degree[side], self.poles.shape[side]
        return np.concatenate([np.zeros(p), np.arange(n - p + 1.0), np.full(p, n - p)])

    def span(self, side: int) -> Flat:
        """Return the range of the parameter."""
        return 0.0, float(self.poles.shape[side] - self.degree[side])

    def at(self, u: Floats, v: Floats) -> Floats:
        """Return points `(..., 3)` by the basis functions."""
        (i, bu), (j, bv) = self._basis(u, 0), self._basis(v, 1)
        out = np.zeros((*np.shape(u), 3))
        for a, wu in enumerate(bu):
            for b, wv in enumerate(bv):
                out += (wu * wv)[..., None] * self.poles[i + a, j + b]
        return out

    def _basis(self, t: Floats, side: int) -> tuple[NDArray[np.int_], list[Floats]]:
        """Return the first pole's index and the weights that are not zero, by Cox and de Boor."""
        p, k = self.degree[side], self.knots(side)
        first = np.clip(np.floor(t).astype(int), 0, self.poles.shape[side] - p - 1)
        at = first + p
        weights = [np.ones_like(t)]
        for d in range(1, p + 1):
            new = [np.zeros_like(t) for _ in range(d + 1)]
            for a, w in enumerate(weights):
                low, high = k[at - d + 1 + a], k[at + 1 + a]
                share = (t - low) / (high - low)
                new[a] += (1 - share) * w
                new[a + 1] += share * w
            weights = new
        return first, weights

    def surface(self, name: str, grid: tuple[int, int]) -> Surface:
        """Return the form of the material under it."""
        return Surface(name, self.at, self.span(0), self.span(1), grid)

    def bodies(self, name: str, grid: tuple[int, int], depth: float) -> tuple[Surface, ...]:
        """Return the skin of `solid`: the surface, its copy below, and the four sides."""
        (u0, u1), (v0, v1) = self.span(0), self.span(1)
        down = np.array([0.0, 0.0, -depth])

        def side(u: float | None, v: float | None) -> Surface:
            def at(t: Floats, s: Floats) -> Floats:
                on = self.at(t if u is None else np.full_like(t, u), t if v is None else np.full_like(t, v))
                return on + s[..., None] * down

            return Surface(f"side {'v' if u is None else 'u'}", at, self.span(0 if u is None else 1), (0.0, 1.0), (grid[0 if u is None else 1], 13))

        def below(u: Floats, v: Floats) -> Floats:
            return self.at(u, v) + down

        return (self.surface(name, grid), Surface("below", below, (u0, u1), (v0, v1), (25, 25)), side(u0, None), side(u1, None), side(None, v0), side(None, v1))

    def solid(self, depth: float) -> Any:
        """Return the solid from the surface down to its copy `depth` below."""
        import cadquery as cq
        from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeFace
        from OCP.BRepPrimAPI import BRepPrimAPI_MakePrism
        from OCP.Geom import Geom_BSplineSurface
        from OCP.gp import gp_Pnt, gp_Vec
        from OCP.TColgp import TColgp_Array2OfPnt
        from OCP.TColStd import TColStd_Array1OfInteger, TColStd_Array1OfReal

        nu, nv = self.poles.shape[:2]
        poles = TColgp_Array2OfPnt(1, nu, 1, nv)
        for i in range(nu):
            for j in range(nv):
                poles.SetValue(i + 1, j + 1, gp_Pnt(*(float(x) for x in self.poles[i, j])))
        flat = []
        for side in (0, 1):
            values, counts = np.unique(self.knots(side), return_counts=True)
            knots, times = TColStd_Array1OfReal(1, len(values)), TColStd_Array1OfInteger(1, len(values))
            for i, (value, count) in enumerate(zip(values, counts, strict=True)):
                knots.SetValue(i + 1, float(value))
                times.SetValue(i + 1, int(count))
            flat.append((knots, times))
        surface = Geom_BSplineSurface(poles, flat[0][0], flat[1][0], flat[0][1], flat[1][1], *self.degree)
        face = BRepBuilderAPI_MakeFace(surface, 1e-7).Face()
        return cq.Workplane(obj=cq.Shape.cast(BRepPrimAPI_MakePrism(face, gp_Vec(0, 0, -depth)).Shape()))
