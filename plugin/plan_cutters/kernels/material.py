"""Is a point inside a body? A cutter that touches no skin may lie wholly within one.

Two looks: a grid of cells, some of which are surely outside because a way leads from them past every triangle to where
there is nothing (whatever is open, turned or doubled); and for points elsewhere the winding number of the bodies' skins,
summed over the tree. A straight way out, or a point near by that is known to be inside, saves the sum. Bodies may touch,
overlap, repeat each other or hold voids: each skin counts as enclosing all that is within it, so a void is as little to
be got into as material. Lemmas F1, F5 and F6 of `docs/proofs.md`.

Source of the hierarchical sum: Barill, Dickson, Schmidt, Levin, Jacobson, *Fast winding numbers for soups and clouds* (2018).
"""

from typing import Any, NamedTuple

import numpy as np

from plan_cutters.kernels.codes import CENTRE, HALVES, SIDES
from plan_cutters.kernels.jit import entry, kernel
from plan_cutters.kernels.linear.tree import half
from plan_cutters.kernels.rows import Tree

#: Winding numbers from which a point is not called outside, and from which it is called inside. For closed skins they are
#: whole numbers, but for what is left out in the sum: in between lies only what is not quite closed.
MAYBE_INSIDE, SURELY_INSIDE = 0.25, 0.75
#: Cells that a way out is long at most, and the shortest step on it, as a share.
_STEPS, _SHORT = 8, 1e-3
#: In this part of a ball that touches nothing the winding number keeps this share at least, with what sums leave out.
_PART, _REMAINS = 0.2, 0.5
#: A node so many of its radii away counts by its area vector: a hundredth of a turn is what this has been seen to cost.
_FAR = 3.0
#: The same for a rough sum, seen to be off by 0.14 at most; and what it has to be below for no doubt that the other is below
#: `MAYBE_INSIDE`: most points are far from all that encloses, and take half of the time.
_NEARER, _NO_DOUBT = 2.0, 0.1
#: Columns of a node's moments: centroid, radius about it, area vector, area.
_RADIUS, _VECTOR, _AREA, MOMENTS = 3, 4, 7, 8


class Solids(NamedTuple):
    """Obstacles as the searches take them."""

    tree: Tree
    weight: Any  #: (n,) int8: how often a triangle counts in the winding number, negative where its corners run the other way.
    moment: Any  #: (nodes, 8): of the triangles below a node.
    cell: Any  #: (i, j, k) uint8, 1 where a cell is surely outside; none where nothing encloses anything.
    origin: Any  #: (3,): of the cells, mm.
    size: float  #: Of a cell, mm.
    whole: bool  #: The cells hold all that encloses.
    end: Any  #: (2, 3): corners of a box that does.
    #: What keeps so far off every triangle, mm, goes past every skin; nan where skins are not closed, or nothing encloses.
    grow: float
    key: int  #: Of no others, in one process.
    more_weight: Any = np.zeros(0, np.int8)  #: Of the second tree.
    more_moment: Any = np.zeros((1, MOMENTS))


def sheet(tree: Tree) -> Solids:
    """Triangles that enclose nothing."""
    none = np.zeros((0, 0, 0), np.uint8)
    return Solids(
        tree, np.zeros(len(tree.vertex), np.int8), np.zeros((0, MOMENTS)), none, np.zeros(3), 1.0, True, np.zeros((2, 3)),
        np.nan, 0, np.zeros(len(tree.more_vertex), np.int8), np.zeros((0, MOMENTS)),
    )  # fmt: skip


@kernel
def _counted(solids, which):
    """Weights and moments of the triangles of the first (0) or second tree (1)."""
    if which == 0:
        return solids.weight, solids.moment
    return solids.more_weight, solids.more_moment


@entry
def moments(vertex, weight, depth):
    """Moments (nodes, 8) of weighted triangles in tree order: what a far point sees of them."""
    n, first = len(vertex), (1 << depth) - 1
    out = np.zeros(((2 << depth) - 1, MOMENTS))
    for node in range(len(out) - 1, -1, -1):
        if node < first:
            for child in (2 * node + 1, 2 * node + 2):
                area = out[child, _AREA]
                out[node, _AREA] += area
                for k in range(3):
                    out[node, k] += area * out[child, k]
                    out[node, _VECTOR + k] += out[child, _VECTOR + k]
        else:
            leaf = node - first
            for i in range((n * leaf) >> depth, (n * (leaf + 1)) >> depth):
                if weight[i] == 0:
                    continue
                v = vertex[i]
                ax, ay, az = v[1, 0] - v[0, 0], v[1, 1] - v[0, 1], v[1, 2] - v[0, 2]
                bx, by, bz = v[2, 0] - v[0, 0], v[2, 1] - v[0, 1], v[2, 2] - v[0, 2]
                x, y, z = 0.5 * (ay * bz - az * by), 0.5 * (az * bx - ax * bz), 0.5 * (ax * by - ay * bx)
                # A triangle without area has a place, too: nodes must not lose it in their radius.
                area = max(np.sqrt(x * x + y * y + z * z), 1e-100)
                out[node, _AREA] += area
                out[node, _VECTOR] += weight[i] * x
                out[node, _VECTOR + 1] += weight[i] * y
                out[node, _VECTOR + 2] += weight[i] * z
                for k in range(3):
                    out[node, k] += area * (v[0, k] + v[1, k] + v[2, k]) / 3.0
        if out[node, _AREA] > 0.0:
            for k in range(3):
                out[node, k] /= out[node, _AREA]
        if node < first:
            for child in (2 * node + 1, 2 * node + 2):
                if out[child, _AREA] > 0.0:
                    square = 0.0
                    for k in range(3):
                        square += (out[child, k] - out[node, k]) ** 2
                    out[node, _RADIUS] = max(out[node, _RADIUS], np.sqrt(square) + out[child, _RADIUS])
        else:
            leaf = node - first
            for i in range((n * leaf) >> depth, (n * (leaf + 1)) >> depth):
                for corner in range(3):
                    square = 0.0
                    for k in range(3):
                        square += (vertex[i, corner, k] - out[node, k]) ** 2
                    if weight[i] != 0:
                        out[node, _RADIUS] = max(out[node, _RADIUS], np.sqrt(square))
    return out


@kernel
def _solid_angle(v, x, y, z):
    """Solid angle of a triangle seen from a point, positive from behind (van Oosterom and Strackee)."""
    ax, ay, az = v[0, 0] - x, v[0, 1] - y, v[0, 2] - z
    bx, by, bz = v[1, 0] - x, v[1, 1] - y, v[1, 2] - z
    cx, cy, cz = v[2, 0] - x, v[2, 1] - y, v[2, 2] - z
    a, b, c = (np.sqrt(ax * ax + ay * ay + az * az), np.sqrt(bx * bx + by * by + bz * bz), np.sqrt(cx * cx + cy * cy + cz * cz))
    det = ax * (by * cz - bz * cy) + ay * (bz * cx - bx * cz) + az * (bx * cy - by * cx)
    rest = a * b * c + (ax * bx + ay * by + az * bz) * c
    rest += (bx * cx + by * cy + bz * cz) * a + (cx * ax + cy * ay + cz * az) * b
    return 2.0 * np.arctan2(det, rest)


@kernel
def outside(x, y, z, solids):
    """Whether a point is surely in no body; one that is none is not."""
    nx, ny, nz = solids.cell.shape
    if nx == 0:
        return True
    i, j, k = x - solids.origin[0], y - solids.origin[1], z - solids.origin[2]
    if i < 0.0 or j < 0.0 or k < 0.0 or i >= nx * solids.size or j >= ny * solids.size or k >= nz * solids.size:
        low, high = solids.end[0], solids.end[1]
        if x < low[0] or y < low[1] or z < low[2] or x > high[0] or y > high[1] or z > high[2]:
            return True
        return solids.whole
    if not (i == i and j == j and k == k):
        return False
    row, column, layer = int(i / solids.size), int(j / solids.size), int(k / solids.size)
    return solids.cell[min(row, nx - 1), min(column, ny - 1), min(layer, nz - 1)] == 1


@kernel
def _wound(x, y, z, far, solids, stack):
    """How many bodies a point lies in; 0 as soon as that is sure, nan for a point that is none.

    A node so many of its radii away as `far` says counts by its area vector.
    """
    if outside(x, y, z, solids):
        return 0.0
    total = 0.0
    for which in range(2):
        vertex, _, depth, _ = half(solids.tree, which)
        weight, moment = _counted(solids, which)
        n, first, top = len(vertex), (1 << depth) - 1, 1 if len(vertex) else 0
        stack[0] = 0
        while top > 0:
            top -= 1
            node = stack[top]
            if moment[node, _AREA] <= 0.0:
                continue
            dx, dy, dz = moment[node, 0] - x, moment[node, 1] - y, moment[node, 2] - z
            square, radius = dx * dx + dy * dy + dz * dz, far * moment[node, _RADIUS]
            if square > radius * radius:
                along = dx * moment[node, _VECTOR] + dy * moment[node, _VECTOR + 1] + dz * moment[node, _VECTOR + 2]
                total += along / (square * np.sqrt(square))
                continue
            if node < first:
                stack[top] = 2 * node + 2
                stack[top + 1] = 2 * node + 1
                top += 2
                continue
            leaf = node - first
            for t in range((n * leaf) >> depth, (n * (leaf + 1)) >> depth):
                if weight[t] != 0:
                    total += weight[t] * _solid_angle(vertex[t], x, y, z)
    # A skin whose sense could not be told encloses all the same.
    return abs(total) / (4.0 * np.pi)


@kernel
def winding(x, y, z, solids, stack):
    """How many bodies a point lies in; 0 as soon as that is sure, nan for a point that is none."""
    return _wound(x, y, z, _FAR, solids, stack)


@kernel
def plainly_outside(x, y, z, solids, stack):
    """Whether a rough sum leaves no doubt that a point lies in no body, of what is not quite closed neither."""
    return _wound(x, y, z, _NEARER, solids, stack) < _NO_DOUBT


@entry
def windings(points, solids, out):
    """Write the winding numbers (n,) of points (n, 3), 0 where they are surely outside."""
    stack = np.empty(64, np.int64)
    for i in range(len(points)):
        out[i] = winding(points[i, 0], points[i, 1], points[i, 2], solids, stack)


@kernel
def _square_to_triangle(v, x, y, z):
    """Squared distance of a point from a triangle, one without area included."""
    best = np.inf
    ax, ay, az = v[1, 0] - v[0, 0], v[1, 1] - v[0, 1], v[1, 2] - v[0, 2]
    bx, by, bz = v[2, 0] - v[0, 0], v[2, 1] - v[0, 1], v[2, 2] - v[0, 2]
    nx, ny, nz = ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx
    inside = nx * nx + ny * ny + nz * nz > 0.0
    for i in range(3):
        j = i + 1 if i < 2 else 0
        ex, ey, ez = v[j, 0] - v[i, 0], v[j, 1] - v[i, 1], v[j, 2] - v[i, 2]
        px, py, pz = x - v[i, 0], y - v[i, 1], z - v[i, 2]
        square = ex * ex + ey * ey + ez * ez
        part = 0.0
        if square > 0.0:
            part = min(1.0, max(0.0, (px * ex + py * ey + pz * ez) / square))
        qx, qy, qz = px - part * ex, py - part * ey, pz - part * ez
        best = min(best, qx * qx + qy * qy + qz * qz)
        # On the inner side of this edge, seen along the normal.
        if (ey * pz - ez * py) * nx + (ez * px - ex * pz) * ny + (ex * py - ey * px) * nz < 0.0:
            inside = False
    if inside:
        height = (x - v[0, 0]) * nx + (y - v[0, 1]) * ny + (z - v[0, 2]) * nz
        best = min(best, height * height / (nx * nx + ny * ny + nz * nz))
    return best


@kernel
def _nearest(x, y, z, most, enough, solids, stack):
    """The distance of a point from the nearest skin that encloses something, mm; more than `most` if all are farther.

    What is not more than `enough` need not be the least. Of what is no point it is nan.
    """
    best, enough, met = most * most, enough * enough, False
    for which in range(2):
        vertex, box, depth, _ = half(solids.tree, which)
        weight, moment = _counted(solids, which)
        n, first, top = len(vertex), (1 << depth) - 1, 1 if len(vertex) else 0
        stack[0] = 0
        while top > 0:
            top -= 1
            node = stack[top]
            if moment[node, _AREA] <= 0.0:
                continue
            # Distance from the node's oriented box.
            dx, dy, dz = x - box[node, CENTRE], y - box[node, CENTRE + 1], z - box[node, CENTRE + 2]
            square = 0.0
            for k in range(3):
                side = SIDES + 3 * k
                along = dx * box[node, side] + dy * box[node, side + 1] + dz * box[node, side + 2]
                square += max(0.0, abs(along) - box[node, HALVES + k]) ** 2
            if square > best:
                continue
            if node < first:
                stack[top] = 2 * node + 2
                stack[top + 1] = 2 * node + 1
                top += 2
                continue
            leaf = node - first
            for t in range((n * leaf) >> depth, (n * (leaf + 1)) >> depth):
                if weight[t] != 0:
                    square = _square_to_triangle(vertex[t], x, y, z)
                    if not square > best:
                        best, met = square, True
                        if not best > enough:
                            return np.sqrt(best)
    return np.sqrt(best) if met else np.inf


@kernel
def touches(x, y, z, clear, solids, stack):
    """Whether a skin that encloses something comes within `clear` of a point; so does what is no number."""
    return not _nearest(x, y, z, clear, clear, solids, stack) > clear


@kernel
def way_out(x, y, z, dx, dy, dz, solids, stack):
    """Whether a straight way leads from a point along a unit vector past every skin to where it is surely outside.

    Lemma F5 of `docs/proofs.md`, along a line in place of cells: from place to place it goes as far as no triangle is
    near, but for what skins may be off and open.
    """
    length = 0.0
    for step in range(1, _STEPS + 1):
        far = step * solids.size
        if outside(x + far * dx, y + far * dy, z + far * dz, solids):
            length = far
            break
    # Not closed: no way tells.
    if length == 0.0 or not solids.grow >= 0.0:
        return False
    along = 0.0
    while True:
        most = length - along + solids.grow
        near = _nearest(x + along * dx, y + along * dy, z + along * dz, most, 0.0, solids, stack)
        if near > most:
            return True
        if not near - solids.grow > _SHORT * length:
            return False
        along += near - solids.grow


@kernel
def in_known_ball(x, y, z, solids, within, balls, stored):
    """Whether a point is so near to another one that lies in a body (`keep_ball`) that it surely does, too, with no sum."""
    if stored[0] != solids.key:
        return False
    for i in range(min(stored[1], len(balls))):
        dx, dy, dz = x - balls[i, 0], y - balls[i, 1], z - balls[i, 2]
        if balls[i, 4] >= within and dx * dx + dy * dy + dz * dz <= balls[i, 3] * balls[i, 3]:
            return True
    return False


@kernel
def keep_ball(x, y, z, number, solids, balls, stored, stack):
    """Keep a point that lies in a body, with the radius of a ball about it and the least winding number there.

    Lemma F6 of `docs/proofs.md`: past no skin the winding number of closed ones stays; that of others, harmonic and not
    below 0, keeps half of itself in a ball of a fifth of the radius of one that touches nothing.
    """
    if stored[0] != solids.key:
        stored[0], stored[1] = solids.key, 0
    radius, row = _nearest(x, y, z, solids.size, 0.0, solids, stack), balls[stored[1] % len(balls)]
    radius, closed = min(radius, solids.size), solids.grow >= 0.0
    row[0], row[1], row[2] = x, y, z
    row[3], row[4] = (max(0.0, radius - solids.grow), number) if closed else (radius * _PART, number * _REMAINS)
    stored[1] += 1


@entry
def near_shell(points, clear, solids, near):
    """Write for points (n, 3) whether a skin that encloses something comes within `clear`, mm."""
    stack = np.empty(64, np.int64)
    for row in range(len(points)):
        near[row] = touches(points[row, 0], points[row, 1], points[row, 2], clear, solids, stack)


@entry
def far_inside(points, clear, solids, inside):
    """Write for points (n, 3) whether a ball of radius `clear`, mm, lies wholly inside bodies, other surfaces aside."""
    stack = np.empty(64, np.int64)
    for row in range(len(points)):
        x, y, z = points[row, 0], points[row, 1], points[row, 2]
        # The quicker answers first.
        inside[row] = not outside(x, y, z, solids) and not touches(x, y, z, clear, solids, stack)
        inside[row] = inside[row] and winding(x, y, z, solids, stack) >= SURELY_INSIDE
