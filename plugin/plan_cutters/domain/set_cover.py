"""Rows of a table that matter to whoever covers all of them with columns."""

import numpy as np
from numpy.typing import NDArray

#: Rows that are compared with each other, at most.
_COMPARED = 3000


def essential_rows(table: NDArray[np.bool_]) -> NDArray[np.int64]:
    """Rows (k,), ascending, such that whatever covers these covers all rows of a table (n, m).

    A row that holds all columns of another one is covered with it; of equal rows the first stands for all.

    >>> essential_rows(np.array([[1, 0], [1, 1], [1, 0]], bool)).tolist()
    [0]
    """
    packed = np.packbits(table, axis=1)
    first = np.unique(packed, axis=0, return_index=True)[1]
    if len(first) <= _COMPARED:
        some = table[first].astype(np.float32)
        size = some.sum(axis=1)
        both = some @ some.T
        holds = both >= size[None, :] - 0.5
        np.fill_diagonal(holds, False)
        first = first[~holds.any(axis=1)]
    return np.sort(first)
