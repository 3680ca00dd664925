"""Pieces of served cells: inside one that keeps a single axis every path is safe (lemma B14 of `docs/between_samples.md`)."""

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from plan_cutters.judging.cells import CellContacts, Field

Indices = NDArray[np.int64]

#: Times that a cell is cut into four, at most; room for that in the numbers of tiles.
_MOST_LEVELS = 10
#: An axis with a smaller sine to the normal is along it, and sides with a smaller difference are one.
_ALONG, _ONE = 1e-9, 1e-9


def connected(field: Field, cells: CellContacts, level: Indices, *, turning: bool = False) -> Indices:
    """Number the pieces of served cells of a face, from 0.

    Cells that lie in the trim altogether are joined across a common side if they have the same axis, and where that is the normal
    in both, the same side. One that the border cuts may fall apart: it goes with one whole neighbour and joins no others.

    Parameters
    ----------
    field : Field
    cells : CellContacts
        Served, none of them within another.
    level : (m,) int64
        How often each was cut into four.
    turning : bool
        Both sides of a common side have the axes of one field.

    Returns
    -------
    (m,) int64
    """
    m = len(cells)
    tiles, which = np.array(field.index.shape) << _MOST_LEVELS, np.arange(m)
    key = _key(level, cells.tile, tiles)
    order = np.argsort(key, kind="stable")
    known, pairs = key[order], [np.zeros((0, 2), np.int64)]
    for step in ((1, 0), (-1, 0), (0, 1), (0, -1)):
        beyond, count = cells.tile + step, np.array(field.index.shape) << level[:, None]
        beyond = np.where(field.closed, np.remainder(beyond, count), beyond)
        on = ((beyond >= 0) & (beyond < count)).all(axis=1)
        for up in range(int(level.max(initial=0)) + 1):
            # The neighbour is as large, or larger: the smaller of two finds the other one.
            mine = np.flatnonzero(on & (level >= up))
            wanted = _key(level[mine] - up, beyond[mine] >> up, tiles)
            at = np.minimum(np.searchsorted(known, wanted), m - 1)
            there = known[at] == wanted
            pairs.append(np.column_stack([which[mine[there]], order[at[there]]]))
    pair = np.concatenate(pairs)
    a, b = (pair if turning else pair[_alike(cells, pair)]).T
    both, one = cells.whole[a] & cells.whole[b], cells.whole[a] != cells.whole[b]
    # Of a cell that is cut, the first whole neighbour.
    cut, neighbours = np.where(cells.whole[a[one]], b[one], a[one]), np.where(cells.whole[a[one]], a[one], b[one])
    cut, first = np.unique(cut, return_index=True)
    tail, head = np.concatenate([a[both], cut]), np.concatenate([b[both], neighbours[first]])
    graph = coo_array((np.ones(len(tail), np.int8), (tail, head)), shape=(m, m))
    return np.asarray(connected_components(graph, directed=False)[1], np.int64)


def _key(level: Indices, tile: Indices, tiles: Indices) -> Indices:
    """One number for each tile of each level."""
    return np.asarray((level * tiles[0] + tile[:, 0]) * tiles[1] + tile[:, 1])


def _alike(cells: CellContacts, pair: Indices) -> NDArray[np.bool_]:
    """Pairs whose cutters are the same at a common contact."""
    a, b = pair.T
    same = (cells.axis[a] == cells.axis[b]).all(axis=1)
    across = np.linalg.norm(np.cross(cells.axis, cells.normal), axis=1)
    along = across <= _ALONG
    apart = np.linalg.norm(cells.side[a] - cells.side[b], axis=1)
    return np.asarray(same & (~(along[a] & along[b]) | (apart <= _ONE)))
