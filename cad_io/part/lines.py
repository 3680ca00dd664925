"""Where lines go through triangles."""

import numpy as np
from numpy.typing import NDArray

from cad_io.arrays import Floats

#: A triangle of less than this share of its longest side, squared, has no area.
_NO_AREA = 1e-9


def square_to(direction: Floats) -> Floats:
    """Two unit directions (3, 2) square to another, which they turn about to the left."""
    one, other = np.linalg.svd(direction[None])[2][1:]
    return np.stack([one, other if np.cross(one, other) @ direction > 0.0 else -other], axis=1)


def met(vertex: Floats, place: Floats, direction: Floats, least: float = 0.0) -> tuple[NDArray[np.int64], Floats, Floats]:
    """Triangles (n, 3, 3) that a line through a place (3,) along a unit direction (3,) meets, at their edges too.

    Returns their rows (k,), how far along the line from the place each is met (k,), mm, and twice their areas seen along the line
    (k,), positive where their corners run to the left about it. Those that are no longer than `least` seen so, mm, are not met.

    >>> square = np.array([[[0.0, 0, 2], [4, 0, 2], [0, 4, 2]], [[9, 0, 5], [9, 0, 6], [9, 1, 5]]])
    >>> met(square, np.array([1.0, 1.0, 0.5]), np.array([0.0, 0.0, 1.0]))[1]
    array([1.5])
    """
    own = vertex - place
    flat, after = own @ square_to(direction), [1, 2, 0]
    sides = flat[:, :, 0] * flat[:, after, 1] - flat[:, :, 1] * flat[:, after, 0]
    # Seen from the side, or all in one point, a triangle has no side that faces the line.
    whole = sides.sum(axis=1)
    large = np.linalg.norm(np.roll(flat, -1, axis=1) - flat, axis=2).max(axis=1, initial=0.0)
    on = ((sides >= 0.0).all(axis=1) | (sides <= 0.0).all(axis=1)) & (np.abs(whole) > _NO_AREA * large**2) & (large > least)
    # The part of a side belongs to the corner across.
    weight = sides[on][:, after] / whole[on, None]
    return np.flatnonzero(on), (weight * (own[on] @ direction)).sum(axis=1), whole[on]
