"""Rows of samples as the files have them."""

import numpy as np
from numpy.typing import NDArray

Runs = list[tuple[int, int]]


def runs(rows: NDArray[np.int64]) -> Runs:
    """First and last of runs of consecutive numbers.

    >>> runs(np.array([3, 4, 5, 9]))
    [(3, 5), (9, 9)]
    """
    if not len(rows):
        return []
    ends = np.flatnonzero(np.diff(rows) > 1)
    first, last = rows[np.concatenate([[0], ends + 1])], rows[np.concatenate([ends, [len(rows) - 1]])]
    return list(zip(first.tolist(), last.tolist(), strict=True))
