"""Tools: an outline (radius over height) and the convex pieces that it is made of.

Heights are measured from the tip along the axis, in mm. The outline of a tool is a list of vertices `(height, radius)` from the
tip upwards; a third number makes the way to that vertex a corner arc of that radius, tangent to the bottom. A piece is a frustum (core) thickened by a ball:
a cylinder, a cone, a ball end or a rounded disk. All signs and distances of the benchmark are defined on pieces.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

Floats = NDArray[np.float64]

#: Halvings of a bisection: 36 leave less than a nanometre of any tool.
_HALVINGS = 36


@dataclass(frozen=True)
class Piece:
    """A convex revolved body: the frustum of radius `r0` at height `h0` to `r1` at `h1`, thickened by a ball of radius `rho`.

    The numbers may be arrays of one shape, one piece a posture: so an inset by a different depth each is one object.
    """

    h0: Any
    r0: Any
    h1: Any
    r1: Any
    rho: Any = 0.0
    part: str = "cutter"

    def signed(self, r: ArrayLike, h: ArrayLike) -> Floats:
        """Return the signed distance (mm) of points at radius `r`, height `h`: negative inside, exact on both sides."""
        r, h = np.asarray(r, float), np.asarray(h, float)
        h0, r0, h1, r1 = (np.asarray(x, float) for x in (self.h0, self.r0, self.h1, self.r1))
        along_r, along_h = r1 - r0, h1 - h0
        length2 = along_r**2 + along_h**2
        safe = np.where(length2 > 0, length2, 1.0)
        t = np.clip(((r - r0) * along_r + (h - h0) * along_h) / safe, 0.0, 1.0)
        side = np.hypot(r - r0 - t * along_r, h - h0 - t * along_h)
        bottom = np.hypot(np.maximum(r - r0, 0.0), h - h0)
        top = np.hypot(np.maximum(r - r1, 0.0), h - h1)
        within = (h > h0) & (h < h1) & ((r - r0) * along_h < (h - h0) * along_r)
        return np.where(within, -1.0, 1.0) * np.minimum(np.minimum(bottom, top), side) - self.rho

    def at(self, points: Floats, tip: Floats, axis: Floats) -> Floats:
        """Return the signed distance of `points (..., 3)` from the piece of a tool at `tip`, `axis (..., 3)`."""
        r, h = local(points, tip, axis)
        return self.signed(r, h)

    def support(self, u: Floats, tip: Floats, axis: Floats) -> Floats:
        """Return the largest `u . x` over the piece: `u (..., 3)` unit vectors, `tip` and `axis (..., 3)`."""
        up = np.einsum("...i,...i->...", u, axis)
        out = np.sqrt(np.maximum(1.0 - up**2, 0.0))
        rim = np.maximum(self.r0 * out + self.h0 * up, self.r1 * out + self.h1 * up)
        return np.einsum("...i,...i->...", u, tip) + rim + self.rho

    def inset(self, s: ArrayLike) -> tuple["Piece", NDArray[np.bool_]]:
        """Return the piece of all points deeper than `s` in it, and where nothing is that deep."""
        s = np.asarray(s, float)
        cut = np.maximum(s - self.rho, 0.0)
        h0, r0, h1, r1 = (np.asarray(x, float) + 0.0 * cut for x in (self.h0, self.r0, self.h1, self.r1))
        tall = np.where(h1 > h0, h1 - h0, 1.0)
        slope = np.where(h1 > h0, (r1 - r0) / tall, 0.0)
        shift = cut * np.sqrt(1.0 + slope**2)
        lo, hi = h0 + cut, h1 - cut
        a, b = r0 + slope * cut - shift, r1 - slope * cut - shift
        # A cone that comes to a point inside: its apex takes the place of the disk that is gone.
        steep = np.where(slope == 0, 1.0, slope)
        lo, a = np.where((a < 0) & (b >= 0), lo - a / steep, lo), np.maximum(a, np.where(b >= 0, 0.0, a))
        hi, b = np.where((b < 0) & (a >= 0), hi - b / steep, hi), np.maximum(b, np.where(a >= 0, 0.0, b))
        gone = (cut > 0) & ((lo > hi) | (a < 0) | (b < 0))
        keep = lambda new, old: np.where(gone, old, new)
        return replace(self, h0=keep(lo, h0), r0=keep(a, r0), h1=keep(hi, h1), r1=keep(b, r1), rho=np.maximum(self.rho - s, 0.0)), gone

    @property
    def deepest(self) -> float:
        """A depth (mm) that no point of the piece exceeds."""
        return float(np.max(self.rho) + np.max(np.maximum(self.r0, self.r1)))


def local(points: Floats, tip: Floats, axis: Floats) -> tuple[Floats, Floats]:
    """Return radius and height of points in the frame of a tool."""
    d = points - tip
    h = np.einsum("...i,...i->...", d, axis)
    return np.linalg.norm(d - h[..., None] * axis, axis=-1), h


def margin(gap: Callable[[Piece], Floats], piece: Piece) -> Floats:
    """Return the signed margin (mm): the distance where `gap` is positive, else minus the depth.

    `gap(piece)` is the distance of the piece from the material, below zero where they meet. The depth is the largest inset of the piece that
    still meets the material, so a bisection on the sign of `gap` gives it.
    """
    first = gap(piece)
    meets = first < 0
    if not meets.any():
        return first
    low, high = np.zeros_like(first), np.full_like(first, piece.deepest)
    for _ in range(_HALVINGS):
        middle = 0.5 * (low + high)
        smaller, gone = piece.inset(middle)
        inside = ~gone & (gap(smaller) < 0)
        low, high = np.where(inside, middle, low), np.where(inside, high, middle)
    return np.where(meets, -low, first)


Vertex = tuple[float, ...]


@dataclass(frozen=True)
class Tool:
    """A revolved tool: what cuts or follows it, and the holder above. Both outlines have heights from the tip.

    `cutting` is the height to which the cutter cuts; above it is the shank.
    """

    name: str
    cutter: tuple[Vertex, ...]
    holder: tuple[Vertex, ...] = ()
    cutting: float | None = None

    @classmethod
    def flat(
        cls,
        diameter: float,
        length: float,
        *,
        holder: tuple[Vertex, ...] = (),
        flutes: float | None = None,
        shank: float | None = None,
        corner: float = 0.0,
        name: str | None = None,
    ) -> "Tool":
        """Return a flat end, a bull nose (`corner`) or a ball end (`corner` = half the diameter), with a shank above the flutes."""
        radius, top = 0.5 * diameter, length if flutes is None else flutes
        low = [(0.0, radius)] if corner == 0 else [(0.0, radius - corner), (corner, radius, corner)]
        high = [(top, radius)] if shank is None else [(top, radius), (top, 0.5 * shank), (length, 0.5 * shank)]
        kind = "flat" if corner == 0 else "ball" if corner == radius else f"bull{corner:g}"
        return cls(name or f"{kind}_D{diameter:g}L{length:g}", tuple(low + high), tuple(holder), flutes)

    @classmethod
    def ball(cls, diameter: float, length: float, **more: Any) -> "Tool":
        """Return a ball end."""
        return cls.flat(diameter, length, corner=0.5 * diameter, **more)

    @property
    def corner(self) -> float:
        """The corner radius, mm: 0 of a flat end, half the diameter of a ball end."""
        return float(self.cutter[1][2]) if len(self.cutter[1]) > 2 else 0.0

    @property
    def flat_radius(self) -> float:
        """The radius of the flat under the tool, mm."""
        return float(self.cutter[0][1])

    @property
    def length(self) -> float:
        """The height of the highest point, mm."""
        return float(max(v[0] for v in (*self.cutter, *self.holder)))

    @property
    def pieces(self) -> tuple[Piece, ...]:
        """The convex pieces, from the tip upwards, named cutter, shank or holder."""
        return (*_pieces(self.cutter, "cutter", self.cutting), *_pieces(self.holder, "holder", None))

    def stands(self, contact: Floats, normal: Floats, axis: Floats, lean: Floats | None = None) -> Floats:
        """Return the tip of the tool that touches `contact (n, 3)` with `axis (n, 3)`; `normal (n, 3)` points out of the material.

        Where axis and normal agree, the tool's flat lies on the surface, and `lean (n, 3)` is the direction from its axis to the contact,
        reversed: the tool's centre lies towards `-lean`.
        """
        tilt = np.einsum("ij,ij->i", normal, axis)
        across = tilt[:, None] * axis - normal
        width = np.linalg.norm(across, axis=1)
        flat = width < 1e-9
        if flat.any() and self.flat_radius > 0:
            if lean is None:
                raise ValueError("a flat on the surface has its contact where its lean says: give lean")
            across[flat], width[flat] = lean[flat], 1.0
        out = across / np.where(width == 0, 1.0, width)[:, None]
        centre = contact + self.corner * normal
        return centre - self.flat_radius * out - self.corner * axis

    def signed(self, points: Floats, tip: Floats, axis: Floats) -> Floats:
        """Return the least signed distance of points `(..., 3)` over the pieces."""
        r, h = local(points, tip, axis)
        return np.min([piece.signed(r, h) for piece in self.pieces], axis=0)


def _pieces(vertices: tuple[Vertex, ...], part: str, cutting: float | None) -> list[Piece]:
    """Return the pieces of one outline."""
    made: list[Piece] = []
    for (h0, r0, *_), (h1, r1, *arc) in pairwise(vertices):
        name = "shank" if part == "cutter" and cutting is not None and h0 >= cutting else part
        if arc and arc[0] > 0:
            made.append(Piece(h0 + arc[0], r0, h0 + arc[0], r0, arc[0], name))
        elif h1 > h0:
            last = made[-1] if made else None
            if last is not None and last.rho == 0 and last.part == name and _one_line(last, h1, r0, r1):
                made[-1] = replace(last, h1=h1, r1=r1)
            elif last is not None and last.rho > 0 and r0 == r1 == last.r0 + last.rho and last.h0 == last.h1 and h1 > last.h0 + last.rho:
                # The corner goes on inside the cylinder above it: no seam where a thin wall could stand unseen.
                made[-1] = replace(last, h1=h1 - last.rho)
                made.append(Piece(h0, r0, h1, r1, 0.0, name))
            else:
                made.append(Piece(h0, r0, h1, r1, 0.0, name))
    return made


def _one_line(last: Piece, h1: float, r0: float, r1: float) -> bool:
    """Whether the frustum goes on in the same line as the last one."""
    return last.r1 == r0 and abs((last.r1 - last.r0) * (h1 - last.h1) - (r1 - r0) * (last.h1 - last.h0)) < 1e-12
