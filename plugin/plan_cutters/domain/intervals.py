"""Intervals of numbers as arrays (k, 2) of their ends, first and last: joined, intersected, taken from each other.

The kernels do the same in place (`kernels.intervals`).
"""

import numpy as np

from cad_io.arrays import Floats


def _rows(intervals: list[tuple[float, float]]) -> Floats:
    return np.array(intervals, float).reshape(-1, 2)


def join(intervals: Floats) -> Floats:
    """Join intervals, in any order, where they overlap or touch; ascending.

    >>> join(np.array([[2.0, 3.0], [0.0, 1.0], [1.0, 1.5]])).tolist()
    [[0.0, 1.5], [2.0, 3.0]]
    """
    joined: list[tuple[float, float]] = []
    for first, last in intervals[np.argsort(intervals[:, 0], kind="stable")].tolist():
        if joined and first <= joined[-1][1]:
            joined[-1] = (joined[-1][0], max(joined[-1][1], last))
        else:
            joined.append((first, last))
    return _rows(joined)


def common(a: Floats, b: Floats) -> Floats:
    """The common parts of each two intervals, of which single numbers count.

    >>> common(np.array([[0.0, 2.0], [3.0, 4.0]]), np.array([[1.0, 3.0]])).tolist()
    [[1.0, 2.0], [3.0, 3.0]]
    """
    pairs = [(max(x, u), min(y, v)) for x, y in a.tolist() for u, v in b.tolist()]
    return _rows([(low, high) for low, high in pairs if low <= high])


def without(intervals: Floats, others: Floats) -> Floats:
    """The parts of sorted intervals that none of the others, sorted, covers; single numbers do not count.

    >>> without(np.array([[0.0, 4.0]]), np.array([[1.0, 2.0], [3.0, 9.0]])).tolist()
    [[0.0, 1.0], [2.0, 3.0]]
    >>> without(np.zeros((0, 2)), np.array([[1.0, 2.0]])).tolist()
    []
    """
    remaining = []
    for low, high in intervals.tolist():
        for first, last in others.tolist():
            if last <= low or first >= high:
                continue
            if first > low:
                remaining.append((low, first))
            low = max(low, last)
        if high > low:
            remaining.append((low, high))
    return _rows(remaining)


def complement(intervals: Floats, low: float, high: float) -> Floats:
    """The parts of [low, high] that no interval, sorted, covers."""
    return without(np.array([[low, high]]), intervals)
