"""Eight boxes or triangles at a time, as seen from a contact, against gaps of tilts.

Without a branch, so that the compiler uses the lanes of the processor.
"""

from typing import Any, NamedTuple

import numpy as np

from plan_cutters.kernels.maps.gaps import CF, CL, SF, SL
from plan_cutters.kernels.jit import entry, kernel
from plan_cutters.kernels.maps.passes import _facing, _from_plane, _rim

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
    vertex, box, depth = tree
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
                blocks[block, k, lane] = box[node, k]
                blocks[block, 12 + k, lane] = vertex[point, 0, k]
                for side in range(3):
                    blocks[block, 3 + 3 * side + k, lane] = box[node, 12 + side] * box[node, 3 + 3 * side + k]
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
def _boxes_pass(view, block, cosine, sine, gap, count, tool, margin):
    """Write a margin for each box of a block: 0 or more only if none of its points enters the body in any gap.

    What parts a box from the body is, as for a point: beside the cylinder; below its bottom where the gap begins; in front
    of the rim where it ends; below the rim at both, seen along the normal or across the box's thin side; above the top where
    it ends; behind where it begins. The rim is seen as a line, its tangent half way from the box's middle to its side next to
    the axis.
    """
    radius, shrunk, low, high, _ = tool
    for lane in range(len(margin)):
        margin[lane] = np.inf
    for g in range(count):
        ca, sa, cb, sb = gap[g, CF], gap[g, SF], gap[g, CL], gap[g, SL]
        level = low * min(1.0, ca * min(ca + sa, cb + sb))
        for lane in range(len(margin)):
            x = cosine * view[block, 0, lane] + sine * view[block, 1, lane]
            y = cosine * view[block, 1, lane] - sine * view[block, 0, lane]
            z = view[block, 2, lane]
            f0 = cosine * view[block, 3, lane] + sine * view[block, 6, lane]
            f1 = cosine * view[block, 4, lane] + sine * view[block, 7, lane]
            f2 = cosine * view[block, 5, lane] + sine * view[block, 8, lane]
            t0 = cosine * view[block, 6, lane] - sine * view[block, 3, lane]
            t1 = cosine * view[block, 7, lane] - sine * view[block, 4, lane]
            t2 = cosine * view[block, 8, lane] - sine * view[block, 5, lane]
            z0, z1, z2 = view[block, 9, lane], view[block, 10, lane], view[block, 11, lane]
            wide = abs(t0) + abs(t1) + abs(t2)
            slope, room = _rim(y - max(-0.5 * wide, min(0.5 * wide, y)), radius, shrunk)
            room += slope * y
            top = ca * z + sa * x + abs(ca * z0 + sa * f0) + abs(ca * z1 + sa * f1) + abs(ca * z2 + sa * f2)
            bottom = cb * z + sb * x - abs(cb * z0 + sb * f0) - abs(cb * z1 + sb * f1) - abs(cb * z2 + sb * f2)
            front = sb * z - cb * x + abs(sb * z0 - cb * f0 - slope * t0)
            front += abs(sb * z1 - cb * f1 - slope * t1) + abs(sb * z2 - cb * f2 - slope * t2)
            behind = sa * z - ca * x - abs(sa * z0 - ca * f0 + slope * t0)
            behind -= abs(sa * z1 - ca * f1 + slope * t1) + abs(sa * z2 - ca * f2 + slope * t2)
            d = sa * slope
            under = ca * low + sa * room - z - abs(z0 - d * t0) - abs(z1 - d * t1) - abs(z2 - d * t2)
            d = sb * slope
            under = min(under, cb * low + sb * room - z - abs(z0 - d * t0) - abs(z1 - d * t1) - abs(z2 - d * t2))
            nx, nz = _facing(t0 * z1 - z0 * t1, f0 * t1 - t0 * f1, ca, sa, cb, sb)
            over = nx * x + nz * z
            begins, share = _from_plane(nx, nz, ca, sa, tool)
            d = share * slope
            own = begins + share * room - over - abs(nx * f0 + nz * z0 - d * t0)
            own -= abs(nx * f1 + nz * z1 - d * t1) + abs(nx * f2 + nz * z2 - d * t2)
            begins, share = _from_plane(nx, nz, cb, sb, tool)
            d = share * slope
            other = begins + share * room - over - abs(nx * f0 + nz * z0 - d * t0)
            other -= abs(nx * f1 + nz * z1 - d * t1) + abs(nx * f2 + nz * z2 - d * t2)
            under = max(under, min(own, other))
            ahead = x - abs(f0) - abs(f1) - abs(f2)
            beside = abs(y) - wide
            best = max(beside - shrunk, level - top)
            best = max(best, min(room - front, max(ahead, max(low - top, bottom))))
            best = max(best, under)
            best = max(best, bottom - high)
            best = max(best, behind - 2.0 * radius + room)
            margin[lane] = min(margin[lane], best)


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
def _triangles_pass(seen, cosine, sine, gap, count, tool, margin):
    """`_boxes_pass` for the triangles of a leaf."""
    radius, shrunk, low, high, _ = tool
    for lane in range(len(margin)):
        margin[lane] = np.inf
    for g in range(count):
        ca, sa, cb, sb = gap[g, CF], gap[g, SF], gap[g, CL], gap[g, SL]
        level = low * min(1.0, ca * min(ca + sa, cb + sb))
        for lane in range(len(margin)):
            x0 = cosine * seen[0, lane] + sine * seen[1, lane]
            y0 = cosine * seen[1, lane] - sine * seen[0, lane]
            z0 = seen[2, lane]
            x1 = cosine * seen[3, lane] + sine * seen[4, lane]
            y1 = cosine * seen[4, lane] - sine * seen[3, lane]
            z1 = seen[5, lane]
            x2 = cosine * seen[6, lane] + sine * seen[7, lane]
            y2 = cosine * seen[7, lane] - sine * seen[6, lane]
            z2 = seen[8, lane]
            slope, room = _rim((y0 + y1 + y2) / 3.0, radius, shrunk)
            highest = max(z0, max(z1, z2))
            top = max(ca * z0 + sa * x0, max(ca * z1 + sa * x1, ca * z2 + sa * x2))
            bottom = min(cb * z0 + sb * x0, min(cb * z1 + sb * x1, cb * z2 + sb * x2))
            front = max(sb * z0 - cb * x0 - slope * y0,
                        max(sb * z1 - cb * x1 - slope * y1, sb * z2 - cb * x2 - slope * y2))  # fmt: skip
            behind = min(sa * z0 - ca * x0 + slope * y0,
                         min(sa * z1 - ca * x1 + slope * y1, sa * z2 - ca * x2 + slope * y2))  # fmt: skip
            d = sa * slope
            under = ca * low + sa * room - max(z0 - d * y0, max(z1 - d * y1, z2 - d * y2))
            d = sb * slope
            under = min(under, cb * low + sb * room - max(z0 - d * y0, max(z1 - d * y1, z2 - d * y2)))
            nx, nz = (y1 - y0) * (z2 - z0) - (z1 - z0) * (y2 - y0), (x1 - x0) * (y2 - y0) - (y1 - y0) * (x2 - x0)
            nx, nz = _facing(nx, nz, ca, sa, cb, sb)
            h0, h1, h2 = nx * x0 + nz * z0, nx * x1 + nz * z1, nx * x2 + nz * z2
            begins, share = _from_plane(nx, nz, ca, sa, tool)
            d = share * slope
            own = begins + share * room - max(h0 - d * y0, max(h1 - d * y1, h2 - d * y2))
            begins, share = _from_plane(nx, nz, cb, sb, tool)
            d = share * slope
            own = min(own, begins + share * room - max(h0 - d * y0, max(h1 - d * y1, h2 - d * y2)))
            under = max(under, own)
            beside = max(min(y0, min(y1, y2)), -max(y0, max(y1, y2)))
            best = max(beside - shrunk, low - highest)
            best = max(best, level - top)
            best = max(best, min(room - front, max(min(x0, min(x1, x2)), max(low - top, bottom))))
            best = max(best, under)
            best = max(best, bottom - high)
            best = max(best, behind - 2.0 * radius + room)
            margin[lane] = min(margin[lane], best)


@kernel
def _turn(seen, lane, cosine, sine, corner):
    """Write a triangle of a leaf as rows (x, z, y) at a rotation."""
    for k in range(3):
        x, y = seen[3 * k, lane], seen[3 * k + 1, lane]
        corner[k, 0], corner[k, 1], corner[k, 2] = cosine * x + sine * y, seen[3 * k + 2, lane], cosine * y - sine * x
