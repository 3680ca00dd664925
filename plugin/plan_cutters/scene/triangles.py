"""Triangles that are added to others, so that those of a part are there once however it stands; and triangles that are halved."""

from typing import Any

import numpy as np

from cad_io.arrays import Floats, Ints, Triangles


class AddedTriangles(Triangles):
    """Triangles, of which the first ones are shared and the others are added. `vertex` is put together where it is asked for.

    Parameters
    ----------
    shared, added : (n, 3, 3), (m, 3, 3) float
        mm.
    face : (n + m,) int32
    chord_error, missing, measured, loose, errors
        As of `Triangles`.
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
