"""Triangles: added to others, so that those of a part are there once however it stands; halved; and thickened to proxy geometry,
all places in which a surface may be that they are not close to.
"""

from typing import Any

import numpy as np

from cad_io.arrays import Floats, Ints, Triangles
from cad_io.tessellate.proxies import boxed


class AddedTriangles(Triangles):
    """Triangles, of which the first ones are shared and the others are added. `vertex` is put together where it is asked for.

    `shared`, `added` (n, 3, 3), (m, 3, 3) float: mm. `face` (n + m,) int32. `chord_error`, `missing`, `measured`, `loose`,
    `errors`: as of `Triangles`.
    """

    __slots__ = ("added", "shared")

    shared: Floats
    added: Floats

    def __init__(self, shared: Floats, added: Floats, face: Ints, **rest: Any) -> None:
        for name, value in {"shared": shared, "added": added, "face": face, **rest}.items():
            object.__setattr__(self, name, value)

    @property
    def vertex(self) -> Floats:
        """All of them (n + m, 3, 3)."""
        return np.concatenate([self.shared, self.added])

    def __len__(self) -> int:
        return len(self.face)

    def __reduce__(self) -> tuple[Any, ...]:
        rest = self.chord_error, self.missing, self.measured, self.loose, self.errors
        return Triangles, (self.vertex, self.face, *rest)


def pieces(triangles: Triangles, first: int | None = None) -> list[Floats]:
    """The corners of triangles, without a copy: those before a row, by itself those that are shared, and the others."""
    if isinstance(triangles, AddedTriangles):
        return [triangles.shared, triangles.added]
    return [triangles.vertex[:first], triangles.vertex[len(triangles) if first is None else first :]]


def divided(vertex: Floats, low: Floats, high: Floats, longest: float, most: int | None = None) -> Floats:
    """Triangles (n, 3, 3) halved until no side is longer than asked, mm, without those whose box misses a box.

    Where there are already more than `most`, they stay as they are.
    """
    done = []
    while len(vertex):
        vertex = vertex[((vertex.max(axis=1) >= low) & (vertex.min(axis=1) <= high)).all(axis=1)]
        side = np.linalg.norm(vertex - np.roll(vertex, -1, axis=1), axis=2)
        small = side.max(axis=1) <= longest
        if most is not None and len(vertex) > most:
            small[:] = True
        done.append(vertex[small])
        vertex = halved(vertex[~small], side[~small])
    return np.ascontiguousarray(np.concatenate([np.zeros((0, 3, 3)), *done]))


def halved(vertex: Floats, side: Floats) -> Floats:
    """Halve triangles (n, 3, 3) at the middle of the longest of their sides (n, 3): long thin ones come out compact.

    All first halves come before all second ones. A side goes from the corner of its number to the next one.
    """
    a, b, c = (vertex[np.arange(len(vertex)), (side.argmax(axis=1) + k) % 3] for k in range(3))
    middle = 0.5 * (a + b)
    return np.concatenate([np.stack([a, middle, c], axis=1), np.stack([middle, b, c], axis=1)])


#: Triangles of a prism with six sides, outward, by the numbers of its corners: those below, then those above, counter-clockwise.
_CAPS = [(0, k + 1, k) for k in range(1, 5)] + [(6, k + 6, k + 7) for k in range(1, 5)]
_SIDES = [each for k in range(6) for each in ((k, (k + 1) % 6, k + 6), ((k + 1) % 6, (k + 1) % 6 + 6, k + 6))]
_PRISM = np.array(_CAPS + _SIDES)
#: A triangle whose height is a smaller share of its longest side has no normal that is known well enough.
_THIN = 1e-6


def thickened(vertex: Floats, error: float) -> Floats:
    """Closed skins around all that is within a distance of triangles.

    Around each triangle stands a prism: above and below at that distance, its sides along the triangle's sides and across its
    corners. That for an error encloses those for smaller ones. A needle has the box around it.

    `vertex` (n, 3, 3) float: mm. `error`: mm, not negative. Returns (t, 3, 3) float: triangles, counter-clockwise seen from
    outside; none where there are none.
    """
    # What rounding takes from a skin is given back.
    error += 1e-12 * float(np.abs(vertex).max(initial=0.0)) + np.finfo(float).tiny
    side = np.roll(vertex, -1, axis=1) - vertex
    length = np.linalg.norm(side, axis=2)
    normal = np.cross(side[:, 0], side[:, 1])
    twice = np.linalg.norm(normal, axis=1)
    flat = (twice > _THIN * length.max(axis=1, initial=0.0) ** 2) & (length.min(axis=1, initial=np.inf) > 0.0)
    needles = vertex[~flat]
    boxes = [boxed(low - error, high + error) for low, high in zip(needles.min(axis=1), needles.max(axis=1), strict=True)]
    return np.concatenate([_prisms(vertex[flat], error), *boxes])


def _prisms(vertex: Floats, error: float) -> Floats:
    side = np.roll(vertex, -1, axis=1) - vertex
    normal = np.cross(side[:, 0], side[:, 1])
    normal /= np.linalg.norm(normal, axis=1)[:, None]
    outward = np.cross(side, normal[:, None])
    outward /= np.linalg.norm(outward, axis=2)[:, :, None]
    # At a corner the prism is cut off at the distance, across the middle between the sides before and behind it.
    before = np.roll(outward, 1, axis=1)
    across = before + outward
    across = across / np.linalg.norm(across, axis=-1, keepdims=True)
    # Two lines at distance 1 from a point, with unit normals, meet at twice their sum over its square.
    meets = (2.0 * (one + across) / ((one + across) ** 2).sum(axis=2, keepdims=True) for one in (before, outward))
    corner = [vertex + error * each for each in meets]
    ring = np.stack(corner, axis=2).reshape(-1, 6, 3)
    high = error * normal[:, None]
    return np.asarray(np.concatenate([ring - high, ring + high], axis=1)[:, _PRISM].reshape(-1, 3, 3))
