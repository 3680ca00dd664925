"""Infer the surface about the nodes of a face's grid: how far their cells extend, and how curvature changes there."""

import numpy as np
from numpy.typing import NDArray

from cad_io.arrays import FaceGrid, Floats

#: The patch about a node is at least half the way to its diagonal neighbours; some more, for cells that are bent.
WIDER = 1.1
#: In a cell, the curvature tensor may differ from its node's this many times as much as half way to the next nodes.
WILDER = 2.0


def tensors(normal: Floats, direction_max: Floats, curvature: Floats) -> Floats:
    """Second fundamental form (n, 3, 3) in part coordinates, 1/mm, concave positive."""
    across = np.cross(normal, direction_max)
    high, low = curvature[:, 0, None, None], curvature[:, 1, None, None]
    e1, e2 = direction_max[:, :, None], across[:, :, None]
    return np.asarray(high * e1 * e1.transpose(0, 2, 1) + low * e2 * e2.transpose(0, 2, 1))


def steepest(tensor: Floats, variation: Floats) -> tuple[Floats, Floats]:
    """Most that a principal curvature (n,) and the difference of two (n,) may be where tensors differ by a wobble, 1/mm."""
    trace = np.einsum("nii->n", tensor)
    spread = np.sqrt(np.maximum(0.0, 2.0 * np.einsum("nij,nij->n", tensor, tensor) - trace * trace))
    return 0.5 * (np.abs(trace) + spread) + variation, spread + 2.0 * variation


def from_neighbours(point: Floats, tensor: Floats, grid: FaceGrid, index: NDArray[np.integer]) -> tuple[Floats, Floats]:
    """How far curvature may differ in each sample's cell, 1/mm, and how far the cell reaches, mm.

    Parameters
    ----------
    point, tensor : (n, 3), (n, 3, 3) float
        The samples of the face.
    grid : FaceGrid
    index : (nu, nv) int
        Row of the sample at each node, negative where there is none.

    Returns
    -------
    wobble, radius : (n,) float
        nan where no neighbour tells them.
    """
    on = index >= 0
    at = np.where(on[..., None], point[index], np.nan)
    bend = tensor[index].reshape(*on.shape, 9)
    differs_by = np.zeros(on.shape)
    for axis, closed in ((0, grid.closed_u), (1, grid.closed_v)):
        differs = np.linalg.norm(_next(bend, axis, closed) - bend, axis=2)
        differs[~(on & (_next(on.astype(float), axis, closed) == 1))] = 0.0
        differs_by += np.maximum(differs, np.roll(differs, 1, axis))
    variation, radius = np.full(len(point), np.nan), np.full(len(point), np.nan)
    variation[index[on]], radius[index[on]] = 0.5 * WILDER * differs_by[on], _radius(at, grid)[on]
    return variation, radius


def _next(field: Floats, axis: int, closed: bool) -> Floats:
    """Each node's next one along an axis; nan past the end of a grid that is not closed."""
    moved = np.roll(field, -1, axis)
    if not closed:
        moved[(-1,) if axis == 0 else (slice(None), -1)] = np.nan
    return moved


def _radius(point: Floats, grid: FaceGrid) -> Floats:
    """Half the largest distance to the diagonal neighbours; beyond an end of the face, as on this side of it."""
    next_u, next_v = _next(point, 0, grid.closed_u), _next(point, 1, grid.closed_v)
    sides = []
    for axis, following in ((0, next_u), (1, next_v)):
        gap = np.linalg.norm(following - point, axis=2)
        sides.append(np.fmax(gap, np.roll(gap, 1, axis)))
    straight = np.hypot(*sides)
    both = _next(next_u, 1, grid.closed_v)
    down = np.linalg.norm(both - point, axis=2)
    up = np.linalg.norm(next_u - next_v, axis=2)
    corners = [down, np.roll(down, (1, 1), (0, 1)), np.roll(up, 1, 0), np.roll(up, 1, 1)]
    longest = np.fmax(straight, np.fmax.reduce(corners))
    return np.asarray(0.5 * WIDER * np.where(np.isfinite(straight), longest, np.nan))
