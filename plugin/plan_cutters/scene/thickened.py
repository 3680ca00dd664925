"""Proxy geometry for triangles that are not close to their surface: all places in which the surface may be."""

import math

import numpy as np

from cad_io.arrays import Floats

#: Cells along the longest side, about.
_CELLS = 64
#: Corners of the side of a cell that looks along +x, +y or +z, counter-clockwise seen from there; and its two triangles.
_SIDES = (
    np.array([(1, 0, 0), (1, 1, 0), (1, 1, 1), (1, 0, 1)]),
    np.array([(0, 1, 0), (0, 1, 1), (1, 1, 1), (1, 1, 0)]),
    np.array([(0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)]),
)
_HALVES = np.array([(0, 1, 2), (0, 2, 3)])


def thickened(vertex: Floats, error: float) -> Floats:
    """A closed skin around all that is within a distance of triangles.

    It runs along the sides of cells whose size is a power of two, on a grid that is the same for all: the skin for an error
    encloses that of each smaller one.

    Parameters
    ----------
    vertex : (n, 3, 3) float
        mm.
    error : float
        mm, not negative.

    Returns
    -------
    (t, 3, 3) float
        Triangles, counter-clockwise seen from outside; none where there are none.
    """
    from plan_cutters.kernels.material import mark_skin

    if not len(vertex):
        return np.zeros((0, 3, 3))
    low, high = vertex.min(axis=(0, 1)) - error, vertex.max(axis=(0, 1)) + error
    extent = max(float((high - low).max()), 1e-9 * float(np.abs([low, high]).max()), np.finfo(float).tiny)
    size = 2.0 ** math.ceil(math.log2(max(error, extent / _CELLS)))
    # Two cells of air around it: each cell of the skin has a neighbour.
    first = np.floor(low / size) - 2.0
    cell = np.zeros(tuple((np.floor(high / size) + 3.0 - first).astype(int)), np.uint8)
    rounding = 1e-12 * float(np.abs([low, high]).max())
    mark_skin(np.ascontiguousarray(vertex), error + rounding, first * size, size, cell)
    found = []
    for axis, side in enumerate(_SIDES):
        step = np.diff(cell.astype(np.int8), axis=axis)
        # A side looks along the axis where a cell ends, against it where one begins.
        for sign, corners in ((-1, side), (1, side[::-1])):
            at = np.argwhere(step == sign)
            quad = (first + at[:, None, :] + corners) * size
            found.append(quad[:, _HALVES].reshape(-1, 3, 3))
    return np.concatenate(found)
