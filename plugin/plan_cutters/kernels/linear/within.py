"""Which triangles, or points of them, lie in a box or cylinder, and through which cells of a grid may triangles pass?"""

from collections import namedtuple

import numpy as np

from plan_cutters.kernels.codes import CENTRE, DIAGONAL, HALVES, SIDES
from plan_cutters.kernels.jit import entry, kernel
from plan_cutters.kernels.linear.tree import half

#: The inside of a box or cylinder: its frame's origin (3,) and axes (3, 3), as columns; corners (3,) of the box in it, and about
#: z the radius of the cylinder, infinite for a box; mm.
Space = namedtuple("Space", "origin axes low high radius")


@kernel
def _misses(box, node, space):
    """Whether a box of a tree lies wholly beside a space; what rounding may do is on the side of not."""
    for k in range(3):
        at, half, size = 0.0, 1e-9 * box[node, DIAGONAL], 0.0
        for j in range(3):
            at += (box[node, CENTRE + j] - space.origin[j]) * space.axes[j, k]
            size += abs(box[node, CENTRE + j]) + abs(space.origin[j])
            along = 0.0
            for i in range(3):
                along += box[node, SIDES + 3 * j + i] * space.axes[i, k]
            half += box[node, HALVES + j] * abs(along)
        half += 1e-12 * size
        if at + half < space.low[k] or at - half > space.high[k]:
            return True
    return False


@kernel
def _holds(x, y, z, space, local):
    """Whether a point lies in a space; scratch: local (3,)."""
    x, y, z = x - space.origin[0], y - space.origin[1], z - space.origin[2]
    for k in range(3):
        local[k] = x * space.axes[0, k] + y * space.axes[1, k] + z * space.axes[2, k]
        if not (local[k] > space.low[k] and local[k] < space.high[k]):
            return False
    return np.hypot(local[0], local[1]) < space.radius


@kernel
def _next_leaf(vertex, box, depth, space, stack, top):
    """Walk on, with `top` nodes on the stack, to the next leaf near a space: its triangles from, to, nodes left; -1: none."""
    n, inner = len(vertex), (1 << depth) - 1
    while top > 0:
        top -= 1
        node = stack[top]
        if _misses(box, node, space):
            continue
        if node >= inner:
            leaf = node - inner
            return (n * leaf) >> depth, (n * (leaf + 1)) >> depth, top
        stack[top], stack[top + 1] = 2 * node + 2, 2 * node + 1
        top += 2
    return 0, 0, -1


@kernel
def _any(tree, faces, space, stack, local):
    """As `any_within`; scratch: stack (64,) int64, local (3,)."""
    for k in range(2):
        vertex, box, depth, begin = half(tree, k)
        stack[0], top = 0, 1 if len(vertex) else 0
        while top >= 0:
            first, last, top = _next_leaf(vertex, box, depth, space, stack, top)
            for t in range(first, last):
                if faces[begin + t] <= 0:
                    continue
                a, b, c = vertex[t, 0], vertex[t, 1], vertex[t, 2]
                if _holds((a[0] + b[0] + c[0]) / 3.0, (a[1] + b[1] + c[1]) / 3.0, (a[2] + b[2] + c[2]) / 3.0, space, local):
                    return True
                for i in range(3):
                    p, q = vertex[t, i], vertex[t, i + 1 if i < 2 else 0]
                    if _holds(p[0], p[1], p[2], space, local):
                        return True
                    if _holds(0.5 * (p[0] + q[0]), 0.5 * (p[1] + q[1]), 0.5 * (p[2] + q[2]), space, local):
                        return True
    return False


@entry
def any_within(tree, faces, space):
    """Whether a corner, the middle of a side or the middle of any triangle of a face lies in a space.

    `faces` (n,) int32: face numbers in tree order: triangles with 0 or less are of no face of the part and do not count.
    """
    return _any(tree, faces, space, np.empty(64, np.int64), np.empty(3))


@kernel
def _mark(tree, space, stack, marked):
    """As `in_box`; scratch: stack (64,) int64."""
    for k in range(2):
        vertex, box, depth, begin = half(tree, k)
        stack[0], top = 0, 1 if len(vertex) else 0
        while top >= 0:
            first, last, top = _next_leaf(vertex, box, depth, space, stack, top)
            for t in range(first, last):
                v, meets = vertex[t], True
                for j in range(3):
                    low, high = min(v[0, j], min(v[1, j], v[2, j])), max(v[0, j], max(v[1, j], v[2, j]))
                    meets = meets and high >= space.low[j] and low <= space.high[j]
                marked[begin + t] = meets


@entry
def in_box(tree, space, marked):
    """Write for triangles (n,) in tree order whether the box around each, along x, y and z, meets a box along them.

    `space`: the box, in the frame of the triangles. `marked` (n,) bool, written where it is true.
    """
    _mark(tree, space, np.empty(64, np.int64), marked)


@kernel
def _apart(v, cx, cy, cz, half):
    """True only if a triangle misses the cube of half side `half` (separating axes: the plane, the cube's, the edges')."""
    ax, ay, az = v[0, 0] - cx, v[0, 1] - cy, v[0, 2] - cz
    bx, by, bz = v[1, 0] - cx, v[1, 1] - cy, v[1, 2] - cz
    qx, qy, qz = v[2, 0] - cx, v[2, 1] - cy, v[2, 2] - cz
    ux, uy, uz, wx, wy, wz = bx - ax, by - ay, bz - az, qx - bx, qy - by, qz - bz
    nx, ny, nz = uy * wz - uz * wy, uz * wx - ux * wz, ux * wy - uy * wx
    if abs(nx * ax + ny * ay + nz * az) > half * (abs(nx) + abs(ny) + abs(nz)):
        return True
    for ex, ey, ez in ((ux, uy, uz), (wx, wy, wz), (ax - qx, ay - qy, az - qz)):
        for x, y, z in ((0.0, ez, -ey), (-ez, 0.0, ex), (ey, -ex, 0.0)):
            a, b, c = x * ax + y * ay + z * az, x * bx + y * by + z * bz, x * qx + y * qy + z * qz
            extent = half * (abs(x) + abs(y) + abs(z))
            if min(a, min(b, c)) > extent or max(a, max(b, c)) < -extent:
                return True
    return False


@kernel
def _mark_cells(v, grow, origin, size, cell, low, high):
    """Set the cells that a triangle, made thicker by `grow`, may pass through; scratch: low, high (3,) int64."""
    spans = 0
    for k in range(3):
        least = min(v[0, k], min(v[1, k], v[2, k])) - grow - origin[k]
        most = max(v[0, k], max(v[1, k], v[2, k])) + grow - origin[k]
        low[k] = max(0, int(least / size))
        high[k] = min(cell.shape[k] - 1, int(most / size))
        spans += high[k] > low[k]
    for i in range(low[0], high[0] + 1):
        for j in range(low[1], high[1] + 1):
            for k in range(low[2], high[2] + 1):
                if cell[i, j, k] == 1:
                    continue
                x, y, z = origin[0] + (i + 0.5) * size, origin[1] + (j + 0.5) * size, origin[2] + (k + 0.5) * size
                if spans < 2 or not _apart(v, x, y, z, 0.5 * size + grow):
                    cell[i, j, k] = 1


@entry
def mark_shell(vertex, grow, origin, size, cell):
    """Set the cells (i, j, k) to 1 that triangles, made thicker by `grow`, may pass through."""
    low, high = np.empty(3, np.int64), np.empty(3, np.int64)
    for t in range(len(vertex)):
        _mark_cells(vertex[t], grow, origin, size, cell, low, high)


@entry
def mark_small(vertex, ends, longest, grow, origin, size, cell, large):
    """As `mark_shell`, but for triangles whose box misses a box between two `ends` (3,), and those with a side that is longer
    than asked, mm: they are left out, and of these it is written into `large` (n,)."""
    low, high = np.empty(3, np.int64), np.empty(3, np.int64)
    for t in range(len(vertex)):
        v, square, meets = vertex[t], 0.0, True
        for i in range(3):
            j, side = i + 1 if i < 2 else 0, 0.0
            least, most = min(v[0, i], min(v[1, i], v[2, i])), max(v[0, i], max(v[1, i], v[2, i]))
            meets = meets and most >= ends[0][i] and least <= ends[1][i]
            for k in range(3):
                side += (v[i, k] - v[j, k]) ** 2
            square = max(square, side)
        if not meets:
            continue
        if square > longest * longest:
            large[t] = True
        else:
            _mark_cells(v, grow, origin, size, cell, low, high)
