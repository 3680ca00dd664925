"""A bounding tree of oriented boxes over triangles, as a heap: node i has the children 2i + 1 and 2i + 2.

Boxes lie flat on the surface: next to a contact, where cutter and surface are nearly tangent, only their thickness
counts, and it shrinks with the square of their size.

The tree is complete: node j of level k covers the triangles `[n j >> k, n (j + 1) >> k)` of the ordered list, so
no pointers are kept. Splitting is at the median of the triangles' centres along the longest side of their box.

Data that are used together lie together: centres move with their triangles, and the nodes below a node are done before the
next node of its level, so that all but the uppermost levels run in the processor's cache. Corners lie coordinate by
coordinate, so that several can be processed at a time.

There are two trees, one of what is shared and one of what is added: kernels walk one after the other (`half`). Eight boxes or
triangles of a tree, side by side in the lanes of the processor, are seen from a contact at a time (`wide_tree`).
"""

from collections import namedtuple

import numpy as np

from plan_cutters.kernels.codes import BOX, CENTRE, DIAGONAL, HALVES, SIDES
from plan_cutters.kernels.jit import entry, kernel

LEAF = 4
#: Boxes and triangles looked at together.
LANES = 8


@kernel
def _select(order, centre, axis, lo, hi, nth):
    """Partially sort `order[lo:hi]`, and their centres with it, so that the nth is in place (Hoare's selection)."""
    hi -= 1
    while lo < hi:
        pivot = centre[axis, (lo + hi) >> 1]
        i, j = lo, hi
        while i <= j:
            while centre[axis, i] < pivot:
                i += 1
            while centre[axis, j] > pivot:
                j -= 1
            if i <= j:
                order[i], order[j] = order[j], order[i]
                for k in range(3):
                    centre[k, i], centre[k, j] = centre[k, j], centre[k, i]
                i += 1
                j -= 1
        if nth <= j:
            hi = j
        elif nth >= i:
            lo = i
        else:
            return


@kernel
def _extent(row, lo, hi, lows, highs):
    """Least and largest of `row[lo:hi]`, several at a time; scratch: lows, highs (LANES,)."""
    low, high = row[lo], row[lo]
    whole = lo + (hi - lo) // LANES * LANES
    if whole > lo:
        for lane in range(len(lows)):
            lows[lane], highs[lane] = row[lo + lane], row[lo + lane]
        for i in range(lo + LANES, whole, LANES):
            for lane in range(len(lows)):
                lows[lane], highs[lane] = min(lows[lane], row[i + lane]), max(highs[lane], row[i + lane])
        for lane in range(len(lows)):
            low, high = min(low, lows[lane]), max(high, highs[lane])
    for i in range(whole, hi):
        low, high = min(low, row[i]), max(high, row[i])
    return low, high


@kernel
def _normals(corner, normal):
    """Write the normals (3, n) of triangles, as long as twice their area."""
    for i in range(corner.shape[1]):
        ax, ay, az = corner[3, i] - corner[0, i], corner[4, i] - corner[1, i], corner[5, i] - corner[2, i]
        bx, by, bz = corner[6, i] - corner[0, i], corner[7, i] - corner[1, i], corner[8, i] - corner[2, i]
        normal[0, i], normal[1, i], normal[2, i] = ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx


@kernel
def _mean_normal(corner, normal, lo, hi):
    """Unit mean normal of triangles `lo` to `hi`, area counted; along z if they have none."""
    x, y, z = 0.0, 0.0, 0.0
    fx, fy, fz = normal[0, lo], normal[1, lo], normal[2, lo]
    for i in range(lo, hi):
        nx, ny, nz = normal[0, i], normal[1, i], normal[2, i]
        # Faces may be turned either way: count each normal to the side of the first.
        side = 1.0 if nx * fx + ny * fy + nz * fz >= 0.0 else -1.0
        x, y, z = x + side * nx, y + side * ny, z + side * nz
    size = np.sqrt(x**2 + y**2 + z**2)
    if size < 1e-100 and hi - lo > 2:
        # Points have no normals: the plane through them, then.
        for i in range(lo + 1, hi - 1):
            j = i + 1
            ax, ay, az = corner[0, i] - corner[0, lo], corner[1, i] - corner[1, lo], corner[2, i] - corner[2, lo]
            bx, by, bz = corner[0, j] - corner[0, lo], corner[1, j] - corner[1, lo], corner[2, j] - corner[2, lo]
            nx, ny, nz = ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx
            side = 1.0 if nx * x + ny * y + nz * z >= 0.0 else -1.0
            x, y, z = x + side * nx, y + side * ny, z + side * nz
        size = np.sqrt(x**2 + y**2 + z**2)
    if size < 1e-100:
        return 0.0, 0.0, 1.0
    return x / size, y / size, z / size


@kernel
def _reach(corner, lo, hi, middle, axes, workspace):
    """Write into `workspace.least` and `.most` (3,) how far triangles `lo` to `hi` reach along axes (3, 3) from a point."""
    lows, highs, least, most = workspace.lows, workspace.highs, workspace.least, workspace.most
    mx, my, mz = middle[0], middle[1], middle[2]
    whole = lo + (hi - lo) // LANES * LANES
    for k in range(3):
        x, y, z, low, high = axes[k, 0], axes[k, 1], axes[k, 2], np.inf, -np.inf
        for i in range(whole, hi):
            for c in range(0, 9, 3):
                at = (corner[c, i] - mx) * x + (corner[c + 1, i] - my) * y + (corner[c + 2, i] - mz) * z
                low, high = min(low, at), max(high, at)
        least[k], most[k] = low, high
    if whole == lo:
        return
    for k in range(3):
        for lane in range(lows.shape[1]):
            lows[k, lane], highs[k, lane] = np.inf, -np.inf
    for i in range(lo, whole, LANES):
        for c in range(0, 9, 3):
            for k in range(3):
                x, y, z = axes[k, 0], axes[k, 1], axes[k, 2]
                for lane in range(lows.shape[1]):
                    j = i + lane
                    at = (corner[c, j] - mx) * x + (corner[c + 1, j] - my) * y + (corner[c + 2, j] - mz) * z
                    lows[k, lane], highs[k, lane] = min(lows[k, lane], at), max(highs[k, lane], at)
    for k in range(3):
        for lane in range(lows.shape[1]):
            least[k], most[k] = min(least[k], lows[k, lane]), max(most[k], highs[k, lane])


#: A workspace for bounding a node: low, high (levels, 2, 3), the boxes along x, y and z of a node's two children by its level;
#: middle (3,), axes (3, 3), least, most (3,), and lows, highs (3, LANES).
_Workspace = namedtuple("_Workspace", "low high middle axes least most lows highs")


@kernel
def _bound(corner, normal, lo, hi, low, high, box, node, workspace):
    """Bound triangles `lo` to `hi`, which lie between low and high (3,), by a box whose third side is along the mean normal."""
    middle, axes = workspace.middle, workspace.axes
    mean = _mean_normal(corner, normal, lo, hi)
    # The other sides: across the mean normal, the first along the longest side of the node that allows it.
    along, best = 0, -1.0
    for k in range(3):
        middle[k] = 0.5 * (low[k] + high[k])
        extent = (high[k] - low[k] + 1e-300) * np.sqrt(max(0.0, 1.0 - mean[k] ** 2))
        if extent > best:
            along, best = k, extent
    for k in range(3):
        axes[0, k] = (1.0 if k == along else 0.0) - mean[along] * mean[k]
        axes[2, k] = mean[k]
    size = np.sqrt(axes[0, 0] ** 2 + axes[0, 1] ** 2 + axes[0, 2] ** 2)
    for k in range(3):
        axes[0, k] /= size
    axes[1, 0] = mean[1] * axes[0, 2] - mean[2] * axes[0, 1]
    axes[1, 1] = mean[2] * axes[0, 0] - mean[0] * axes[0, 2]
    axes[1, 2] = mean[0] * axes[0, 1] - mean[1] * axes[0, 0]
    # Extents from the box's middle, so that far from the origin rounding takes nothing away.
    _reach(corner, lo, hi, middle, axes, workspace)
    square, scale = 0.0, abs(middle[0]) + abs(middle[1]) + abs(middle[2])
    for k in range(3):
        box[node, CENTRE + k] = middle[k]
    for k in range(3):
        # A hair wider, so that rounding cannot leave a corner outside.
        half = 0.5 * (workspace.most[k] - workspace.least[k]) * (1 + 1e-12) + 1e-14 * scale
        centre = 0.5 * (workspace.most[k] + workspace.least[k])
        for i in range(3):
            box[node, CENTRE + i] += centre * axes[k, i]
            box[node, SIDES + 3 * k + i] = axes[k, i]
        box[node, HALVES + k] = half
        square += half * half
    box[node, DIAGONAL] = np.sqrt(square) * (1 + 1e-12)


@kernel
def _sort(order, centre, depth, lows, highs):
    """Bring triangles into the order of the tree's leaves, each node with all below it before the next."""
    n, level, j = len(order), 0, 0
    while depth > 0:
        lo, hi = (n * j) >> level, (n * (j + 1)) >> level
        axis, longest = 0, -1.0
        for k in range(3):
            low, high = _extent(centre[k], lo, hi, lows, highs)
            if high - low > longest:
                axis, longest = k, high - low
        _select(order, centre, axis, lo, hi, (n * (2 * j + 1)) >> (level + 1))
        if level + 1 < depth:
            level, j = level + 1, 2 * j
            continue
        # The next node that was not below one done: up past those that were second, then beside.
        j += 1
        while j & 1 == 0 and level > 0:
            level, j = level - 1, j >> 1
        if level == 0:
            return


@kernel
def _bounds(corner, normal, depth, box, workspace):
    """Bound every node, after the two below it."""
    n = corner.shape[1]
    for leaf in range(1 << depth):
        lo, hi = (n * leaf) >> depth, (n * (leaf + 1)) >> depth
        low, high = workspace.low[depth, leaf & 1], workspace.high[depth, leaf & 1]
        for k in range(3):
            low[k], high[k] = np.inf, -np.inf
            for i in range(lo, hi):
                low[k] = min(low[k], min(corner[k, i], min(corner[3 + k, i], corner[6 + k, i])))
                high[k] = max(high[k], max(corner[k, i], max(corner[3 + k, i], corner[6 + k, i])))
        level, j = depth, leaf
        _bound(corner, normal, lo, hi, low, high, box, (1 << level) - 1 + j, workspace)
        while j & 1:
            # Both children are done: then so can be what is above them.
            level, j = level - 1, j >> 1
            low, high = workspace.low[level, j & 1], workspace.high[level, j & 1]
            for k in range(3):
                low[k] = min(workspace.low[level + 1, 0, k], workspace.low[level + 1, 1, k])
                high[k] = max(workspace.high[level + 1, 0, k], workspace.high[level + 1, 1, k])
            lo, hi = (n * j) >> level, (n * (j + 1)) >> level
            _bound(corner, normal, lo, hi, low, high, box, (1 << level) - 1 + j, workspace)


@kernel
def _middles(vertex, centre):
    """Write the middles (3, n) of the boxes around triangles."""
    for i in range(len(vertex)):
        for k in range(3):
            low = min(vertex[i, 0, k], vertex[i, 1, k], vertex[i, 2, k])
            high = max(vertex[i, 0, k], vertex[i, 1, k], vertex[i, 2, k])
            centre[k, i] = 0.5 * (low + high)


@kernel
def _corners(vertex, order, corner):
    """Write the corners' coordinates (9, n) in order."""
    for i in range(len(order)):
        for c in range(3):
            for k in range(3):
                corner[3 * c + k, i] = vertex[order[i], c, k]


@entry
def build_apart(vertex, own, away):
    """As `build`, but triangles from the row `own` on are kept apart from those before it as far as halving lets: they are put in
    order as if they stood `away`, mm, farther along x."""
    n = len(vertex)
    depth = 0
    while (n >> depth) > LEAF:
        depth += 1
    lows, highs = np.empty(LANES), np.empty(LANES)
    order = np.arange(n).astype(np.int32)
    centre = np.empty((3, n))
    _middles(vertex, centre)
    for i in range(own, n):
        centre[0, i] += away
    _sort(order, centre, depth, lows, highs)
    corner = np.empty((9, n))
    _corners(vertex, order, corner)
    # The centres have served: the normals take their array.
    normal = centre
    _normals(corner, normal)
    box = np.empty(((2 << depth) - 1, BOX))
    workspace = _Workspace(
        np.empty((depth + 1, 2, 3)), np.empty((depth + 1, 2, 3)), np.empty(3), np.empty((3, 3)), np.empty(3), np.empty(3),
        np.empty((3, LANES)), np.empty((3, LANES)),
    )  # fmt: skip
    _bounds(corner, normal, depth, box, workspace)
    return order, box, depth


@entry
def build(vertex):
    """Order triangles and bound them.

    `vertex` (n, 3, 3) float64: corners, mm; n >= 1. Returns `order` (n,) int32: triangles in the order of the tree's leaves.
    `box` (nodes, 16) float64: of each node: centre, three unit sides (the last along the mean normal), three half sides, half
    diagonal. `depth` (int): level of the leaves; there are 2 ** depth of them.
    """
    return build_apart(vertex, len(vertex), 0.0)


@kernel
def half(tree, which):
    """Triangles, boxes and depth of the first (0) or the second tree (1), and the number of its first triangle."""
    if which == 0:
        return tree.vertex, tree.box, tree.depth, 0
    return tree.more_vertex, tree.more_box, tree.more_depth, len(tree.vertex)


@kernel
def half_of(tree, triangle):
    """The triangles of the tree that a triangle is in, and its row there."""
    first = len(tree.vertex)
    if triangle < first:
        return tree.vertex, triangle
    return tree.more_vertex, triangle - first


#: A tree as `wide_tree` arranges it.
WideTree = namedtuple("WideTree", "vertex blocks offset bottom")


@entry
def wide_tree(tree):
    """Arrange every third level of a tree for looking at eight boxes at a time.

    `tree`: with all triangles in the first of its two. Returns `vertex` (n, 3, 3) float64: as in the tree. `blocks` (k, 15,
    LANES) float64: of the boxes of a block, one a lane: centre, three half sides, a corner of a triangle in it. Level by level; a
    block holds the boxes three levels below one, the first block those of the first level, lanes left over far below. `offset`
    (levels + 1,) int64: first block of each level. `bottom` (int): level of the tree that the last blocks hold: no box there has
    more than LANES triangles.
    """
    vertex, box, depth = tree.vertex, tree.box, tree.depth
    bottom = depth
    while bottom > 0 and (len(vertex) + (1 << (bottom - 1)) - 1) >> (bottom - 1) <= LANES:
        bottom -= 1
    levels = bottom // 3 + 1
    offset = np.zeros(levels + 1, np.int64)
    for i in range(levels):
        offset[i + 1] = offset[i] + (1 if i == 0 else 1 << (bottom % 3 + 3 * (i - 1)))
    blocks = np.zeros((offset[levels], 15, LANES))
    for i in range(levels):
        level = bottom % 3 + 3 * i
        for j in range(1 << level):
            block, lane, node = offset[i] + (j >> 3 if i > 0 else 0), j & 7, (1 << level) - 1 + j
            point = (len(vertex) * (2 * j + 1)) >> (level + 1)
            for k in range(3):
                blocks[block, k, lane] = box[node, CENTRE + k]
                blocks[block, 12 + k, lane] = vertex[point, 0, k]
                for side in range(3):
                    blocks[block, 3 + 3 * side + k, lane] = box[node, HALVES + side] * box[node, SIDES + 3 * side + k]
    return vertex, blocks, offset, bottom


@kernel
def _see(view, slot, blocks, block, p, e1, e2, n, reach):
    """Write a block of boxes into a slot of the view, as seen from the contact.

    Rows: centre along e1, e2, n; half sides along e1, along e2, along n; how far up the box goes, if any of it is within reach
    of the contact; the point.
    """
    for lane in range(LANES):
        x, y, z = blocks[block, 0, lane] - p[0], blocks[block, 1, lane] - p[1], blocks[block, 2, lane] - p[2]
        view[slot, 0, lane] = x * e1[0] + y * e1[1] + z * e1[2]
        view[slot, 1, lane] = x * e2[0] + y * e2[1] + z * e2[2]
        height = x * n[0] + y * n[1] + z * n[2]
        view[slot, 2, lane] = height
        square, away = x * x + y * y + z * z, 0.0
        for k in range(3):
            x, y, z = blocks[block, 3 + 3 * k, lane], blocks[block, 4 + 3 * k, lane], blocks[block, 5 + 3 * k, lane]
            view[slot, 3 + k, lane] = x * e1[0] + y * e1[1] + z * e1[2]
            view[slot, 6 + k, lane] = x * e2[0] + y * e2[1] + z * e2[2]
            up = x * n[0] + y * n[1] + z * n[2]
            view[slot, 9 + k, lane] = up
            height += abs(up)
            away += abs(
                view[slot, 3 + k, lane] * view[slot, 0, lane]
                + view[slot, 6 + k, lane] * view[slot, 1, lane]
                + up * view[slot, 2, lane]
            )
        view[slot, 12, lane] = -np.inf if square - away > reach * np.sqrt(square) else height
        x, y, z = blocks[block, 12, lane] - p[0], blocks[block, 13, lane] - p[1], blocks[block, 14, lane] - p[2]
        view[slot, 13, lane] = x * e1[0] + y * e1[1] + z * e1[2]
        view[slot, 14, lane] = x * e2[0] + y * e2[1] + z * e2[2]
        view[slot, 15, lane] = x * n[0] + y * n[1] + z * n[2]


@kernel
def _see_triangle(seen, lane, vertex, i, p, e1, e2, n):
    """Write a triangle into a lane of a leaf, as seen from the contact; how far up it goes."""
    top = -np.inf
    for k in range(3):
        x, y, z = vertex[i, k, 0] - p[0], vertex[i, k, 1] - p[1], vertex[i, k, 2] - p[2]
        seen[3 * k, lane] = x * e1[0] + y * e1[1] + z * e1[2]
        seen[3 * k + 1, lane] = x * e2[0] + y * e2[1] + z * e2[2]
        up = x * n[0] + y * n[1] + z * n[2]
        seen[3 * k + 2, lane] = up
        top = max(top, up)
    return top


@kernel
def _see_leaf(seen, vertex, begin, end, p, e1, e2, n):
    """Write triangles into a leaf; how far up they go. A lane without one holds a point far below."""
    top = -np.inf
    for lane in range(LANES):
        if begin + lane < end:
            top = max(top, _see_triangle(seen, lane, vertex, begin + lane, p, e1, e2, n))
        else:
            for k in range(3):
                seen[3 * k, lane], seen[3 * k + 1, lane], seen[3 * k + 2, lane] = 0.0, 0.0, -1e9
    return top


@kernel
def _turn(seen, lane, cosine, sine, corner):
    """Write a triangle of a leaf as rows (x, y, z) at a rotation."""
    for k in range(3):
        x, y = seen[3 * k, lane], seen[3 * k + 1, lane]
        corner[k, 0], corner[k, 1], corner[k, 2] = cosine * x + sine * y, cosine * y - sine * x, seen[3 * k + 2, lane]
