"""Which cells of a grid may triangles pass through?"""

import numpy as np

from plan_cutters.kernels.jit import entry, kernel


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
def _mark(v, grow, origin, size, cell, low, high):
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
        _mark(vertex[t], grow, origin, size, cell, low, high)


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
            _mark(v, grow, origin, size, cell, low, high)
