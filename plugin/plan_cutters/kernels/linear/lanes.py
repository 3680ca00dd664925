"""Eight boxes or triangles of a tree at a time, as seen from a contact, side by side in the lanes of the processor."""

from typing import Any, NamedTuple

import numpy as np

from plan_cutters.kernels.codes import CENTRE, HALVES, SIDES
from plan_cutters.kernels.jit import entry, kernel

#: Boxes and triangles looked at together.
LANES = 8


class WideTree(NamedTuple):
    """A tree as `wide_tree` arranges it."""

    vertex: Any
    blocks: Any
    offset: Any
    bottom: int


@entry
def wide_tree(tree):
    """Arrange every third level of a tree for looking at eight boxes at a time.

    Parameters
    ----------
    tree : Tree
        With all triangles in the first of its two.

    Returns
    -------
    vertex : (n, 3, 3) float64
        As in the tree.
    blocks : (k, 15, LANES) float64
        Of the boxes of a block, one a lane: centre, three half sides, a corner of a triangle in it. Level by level; a
        block holds the boxes three levels below one, the first block those of the first level, lanes left over far below.
    offset : (levels + 1,) int64
        First block of each level.
    bottom : int
        Level of the tree that the last blocks hold: no box there has more than LANES triangles.
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
