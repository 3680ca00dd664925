"""A bounding tree of boxes over triangles, as a heap: node i has the children 2i + 1 and 2i + 2.

The tree is complete: node j of level k covers the triangles `[n j >> k, n (j + 1) >> k)` of the ordered list, so
no pointers are kept. Splitting is at the median of the triangles' centres along the longest side of their box.
"""

import numpy as np

from plan_cutters.kernels.jit import kernel

LEAF = 4


@kernel
def _select(order, key, lo, hi, nth):  # type: ignore[no-untyped-def]
    """Partially sort `order[lo:hi]` so that the nth entry is in place (Hoare's selection)."""
    hi -= 1
    while lo < hi:
        pivot = key[order[(lo + hi) >> 1]]
        i, j = lo, hi
        while i <= j:
            while key[order[i]] < pivot:
                i += 1
            while key[order[j]] > pivot:
                j -= 1
            if i <= j:
                order[i], order[j] = order[j], order[i]
                i += 1
                j -= 1
        if nth <= j:
            hi = j
        elif nth >= i:
            lo = i
        else:
            return


@kernel
def build(vertex):  # type: ignore[no-untyped-def]
    """Order triangles and bound them.

    Parameters
    ----------
    vertex : (n, 3, 3) float64
        Corners, mm; n >= 1.

    Returns
    -------
    order : (n,) int32
        Triangles in the order of the tree's leaves.
    box : (nodes, 7) float64
        Centre, half sides and half diagonal of each node.
    depth : int
        Level of the leaves; there are 2 ** depth of them.
    """
    n = len(vertex)
    depth = 0
    while (n >> depth) > LEAF:
        depth += 1
    centre = np.empty((3, n))
    for i in range(n):
        for k in range(3):
            low = min(vertex[i, 0, k], vertex[i, 1, k], vertex[i, 2, k])
            high = max(vertex[i, 0, k], vertex[i, 1, k], vertex[i, 2, k])
            centre[k, i] = 0.5 * (low + high)
    order = np.arange(n).astype(np.int32)
    for level in range(depth):
        for j in range(1 << level):
            lo, hi = (n * j) >> level, (n * (j + 1)) >> level
            axis, longest = 0, -1.0
            for k in range(3):
                low, high = np.inf, -np.inf
                for i in range(lo, hi):
                    c = centre[k, order[i]]
                    low, high = min(low, c), max(high, c)
                if high - low > longest:
                    axis, longest = k, high - low
            _select(order, centre[axis], lo, hi, (n * (2 * j + 1)) >> (level + 1))
    nodes = (2 << depth) - 1
    low_high = np.empty((nodes, 6))
    first = (1 << depth) - 1
    for j in range(1 << depth):
        node = first + j
        low_high[node, :3], low_high[node, 3:] = np.inf, -np.inf
        for i in range((n * j) >> depth, (n * (j + 1)) >> depth):
            for corner in range(3):
                for k in range(3):
                    c = vertex[order[i], corner, k]
                    low_high[node, k] = min(low_high[node, k], c)
                    low_high[node, 3 + k] = max(low_high[node, 3 + k], c)
    for node in range(first - 1, -1, -1):
        for k in range(3):
            low_high[node, k] = min(low_high[2 * node + 1, k], low_high[2 * node + 2, k])
            low_high[node, 3 + k] = max(low_high[2 * node + 1, 3 + k], low_high[2 * node + 2, 3 + k])
    box = np.empty((nodes, 7))
    for node in range(nodes):
        square = 0.0
        for k in range(3):
            box[node, k] = 0.5 * (low_high[node, k] + low_high[node, 3 + k])
            # A hair wider, so that rounding the centre cannot leave a corner outside.
            half = 0.5 * (low_high[node, 3 + k] - low_high[node, k]) * (1 + 1e-14) + 1e-14 * abs(box[node, k])
            box[node, 3 + k] = half
            square += half * half
        box[node, 6] = np.sqrt(square) * (1 + 1e-14)
    return order, box, depth
