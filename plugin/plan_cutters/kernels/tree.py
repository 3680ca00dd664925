"""A bounding tree of oriented boxes over triangles, as a heap: node i has the children 2i + 1 and 2i + 2.

Boxes lie flat on the surface: next to a contact, where cutter and surface are nearly tangent, only their thickness
counts, and it shrinks with the square of their size.

The tree is complete: node j of level k covers the triangles `[n j >> k, n (j + 1) >> k)` of the ordered list, so
no pointers are kept. Splitting is at the median of the triangles' centres along the longest side of their box.
"""

import numpy as np

from plan_cutters.kernels.jit import entry, kernel

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


@entry
def _bound(vertex, order, lo, hi, box):  # type: ignore[no-untyped-def]
    """Bound `order[lo:hi]` by a box whose third side is along the mean normal."""
    mean, first, normal = np.zeros(3), np.zeros(3), np.zeros(3)
    for i in range(lo, hi):
        v = vertex[order[i]]
        ax, ay, az = v[1, 0] - v[0, 0], v[1, 1] - v[0, 1], v[1, 2] - v[0, 2]
        bx, by, bz = v[2, 0] - v[0, 0], v[2, 1] - v[0, 1], v[2, 2] - v[0, 2]
        normal[0], normal[1], normal[2] = ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx
        if i == lo:
            first[0], first[1], first[2] = normal[0], normal[1], normal[2]
        # Faces may be turned either way: count each normal to the side of the first.
        side = 1.0 if normal[0] * first[0] + normal[1] * first[1] + normal[2] * first[2] >= 0.0 else -1.0
        for k in range(3):
            mean[k] += side * normal[k]
    size = np.sqrt(mean[0] ** 2 + mean[1] ** 2 + mean[2] ** 2)
    if size < 1e-100 and hi - lo > 2:
        # Points have no normals: the plane through them, then.
        o = vertex[order[lo], 0]
        for i in range(lo + 1, hi - 1):
            v, w = vertex[order[i], 0], vertex[order[i + 1], 0]
            ax, ay, az = v[0] - o[0], v[1] - o[1], v[2] - o[2]
            bx, by, bz = w[0] - o[0], w[1] - o[1], w[2] - o[2]
            normal[0], normal[1], normal[2] = ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx
            side = 1.0 if normal[0] * mean[0] + normal[1] * mean[1] + normal[2] * mean[2] >= 0.0 else -1.0
            for k in range(3):
                mean[k] += side * normal[k]
        size = np.sqrt(mean[0] ** 2 + mean[1] ** 2 + mean[2] ** 2)
    if size < 1e-100:
        mean[0], mean[1], mean[2] = 0.0, 0.0, 1.0
    else:
        for k in range(3):
            mean[k] /= size
    # The other sides: across the mean normal, the first along the longest side of the node that allows it.
    low, high = np.full(3, np.inf), np.full(3, -np.inf)
    for i in range(lo, hi):
        for corner in range(3):
            for k in range(3):
                low[k] = min(low[k], vertex[order[i], corner, k])
                high[k] = max(high[k], vertex[order[i], corner, k])
    along, best = 0, -1.0
    for k in range(3):
        extent = (high[k] - low[k] + 1e-300) * np.sqrt(max(0.0, 1.0 - mean[k] ** 2))
        if extent > best:
            along, best = k, extent
    axes = np.zeros((3, 3))
    axes[0, along] = 1.0
    for k in range(3):
        axes[0, k] -= mean[along] * mean[k]
    size = np.sqrt(axes[0, 0] ** 2 + axes[0, 1] ** 2 + axes[0, 2] ** 2)
    for k in range(3):
        axes[0, k] /= size
        axes[2, k] = mean[k]
    axes[1, 0] = mean[1] * axes[0, 2] - mean[2] * axes[0, 1]
    axes[1, 1] = mean[2] * axes[0, 0] - mean[0] * axes[0, 2]
    axes[1, 2] = mean[0] * axes[0, 1] - mean[1] * axes[0, 0]
    # Extents from the box's middle, so that far from the origin nothing is lost to rounding.
    middle = np.empty(3)
    for k in range(3):
        middle[k] = 0.5 * (low[k] + high[k])
        low[k], high[k] = np.inf, -np.inf
    for i in range(lo, hi):
        for corner in range(3):
            v = vertex[order[i], corner]
            for k in range(3):
                c = (v[0] - middle[0]) * axes[k, 0] + (v[1] - middle[1]) * axes[k, 1] + (v[2] - middle[2]) * axes[k, 2]
                low[k], high[k] = min(low[k], c), max(high[k], c)
    square, scale = 0.0, abs(middle[0]) + abs(middle[1]) + abs(middle[2])
    for k in range(3):
        box[k] = middle[k]
        box[3 + k], box[6 + k], box[9 + k] = axes[0, k], axes[1, k], axes[2, k]
    for k in range(3):
        # A hair wider, so that rounding cannot leave a corner outside.
        half = 0.5 * (high[k] - low[k]) * (1 + 1e-12) + 1e-14 * scale
        centre = 0.5 * (high[k] + low[k])
        for i in range(3):
            box[i] += centre * axes[k, i]
        box[12 + k] = half
        square += half * half
    box[15] = np.sqrt(square) * (1 + 1e-12)


@entry
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
    box : (nodes, 16) float64
        Of each node: centre, three unit sides (the last along the mean normal), three half sides, half diagonal.
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
    box = np.empty((nodes, 16))
    for node in range(nodes):
        level = 0
        while (2 << level) - 1 <= node:
            level += 1
        j = node - ((1 << level) - 1)
        _bound(vertex, order, (n * j) >> level, (n * (j + 1)) >> level, box[node])
    return order, box, depth
