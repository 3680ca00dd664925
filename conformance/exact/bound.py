"""Branch and bound of margins over the cells of a shape.

The signed distance of a convex piece is a convex function, so over the hull of a cell's corners it is at least its value at the middle plus the
gradient there times the way to each corner; a cell's thickness is taken off. Points of whole cells bound the margin from above. What neither settles is halved.
Nothing here knows closed forms or triangles: it is the second, independent proof, and the only one for real parts.
"""

from dataclasses import dataclass
from functools import cached_property

import numba
import numpy as np
from numpy.typing import NDArray

from conformance.exact.cells import Cells
from conformance.tool import Floats, Tool

#: Cells smaller than this (mm) are not split further; bounds nearer than TIGHT (mm) are settled; more boxes than this give up.
SMALL, TIGHT, MOST = 2e-3, 5e-4, 400_000
#: Cells of a leaf of the tree.
_LEAF = 8


@dataclass(frozen=True, eq=False)
class Tree:
    """Cells in the order of a tree of spheres: `nodes (m, 4)` centre and radius, `child (m, 2)`, `span (m, 2)` rows of the cells of a leaf."""

    cells: Cells
    nodes: Floats
    child: NDArray[np.int32]
    span: NDArray[np.int32]

    @cached_property
    def no_face(self) -> NDArray[np.bool_]:
        """No face is exempt, as `least` takes it."""
        return np.zeros(int(self.cells.face.max()) + 1, bool)


def tree(cells: Cells) -> Tree:
    """Return the tree of cells."""
    middle = cells.corners.mean(axis=1)
    order = np.arange(len(middle), dtype=np.int32)
    nodes, child, span = _grown(middle, cells.corners, cells.delta, order)
    return Tree(Cells(cells.corners[order].copy(), cells.delta[order], cells.face[order], cells.whole[order]), nodes, child, span)


@numba.njit(cache=True)
def _grown(middle, corners, delta, order):  # type: ignore[no-untyped-def]
    most = 4 * (len(order) // _LEAF + 2)
    nodes, child, span = np.zeros((most, 4)), np.full((most, 2), -1, np.int32), np.zeros((most, 2), np.int32)
    stack = [(0, 0, len(order))]
    count = 1
    while len(stack) > 0:
        node, a, b = stack.pop()
        low, high = np.full(3, np.inf), np.full(3, -np.inf)
        for k in range(a, b):
            for i in range(4):
                for j in range(3):
                    x = corners[order[k], i, j]
                    low[j], high[j] = min(low[j], x), max(high[j], x)
        c = 0.5 * (low + high)
        radius = 0.0
        for k in range(a, b):
            for i in range(4):
                d = corners[order[k], i] - c
                radius = max(radius, np.sqrt(d[0] ** 2 + d[1] ** 2 + d[2] ** 2) + delta[order[k]])
        nodes[node, :3], nodes[node, 3] = c, radius
        span[node, 0], span[node, 1] = a, b
        if b - a > _LEAF:
            axis = np.argmax(high - low)
            part = order[a:b][np.argsort(middle[order[a:b], axis])]
            order[a:b] = part
            half = (a + b) // 2
            child[node, 0], child[node, 1] = count, count + 1
            stack.append((count, a, half))
            stack.append((count + 1, half, b))
            count += 2
    return nodes[:count], child[:count], span[:count]


@numba.njit(cache=True, inline="always")
def _signed(piece, r, h):  # type: ignore[no-untyped-def]
    """Signed distance of (r, h), and its gradient (gr, gh)."""
    h0, r0, h1, r1, rho = piece[0], piece[1], piece[2], piece[3], piece[4]
    ar, ah = r1 - r0, h1 - h0
    l2 = ar * ar + ah * ah
    t = 0.0
    if l2 > 0:
        t = min(1.0, max(0.0, ((r - r0) * ar + (h - h0) * ah) / l2))
    dr, dh = r - r0 - t * ar, h - h0 - t * ah
    best = np.sqrt(dr * dr + dh * dh)
    vr, vh = dr, dh
    inside = h > h0 and h < h1 and (r - r0) * ah < (h - h0) * ar
    nr, nh = ah, -ar
    er, eh = max(r - r0, 0.0), h - h0
    d = np.sqrt(er * er + eh * eh)
    if d < best:
        best, vr, vh, nr, nh = d, er, eh, 0.0, -1.0
    er, eh = max(r - r1, 0.0), h - h1
    d = np.sqrt(er * er + eh * eh)
    if d < best:
        best, vr, vh, nr, nh = d, er, eh, 0.0, 1.0
    if best > 1e-12:
        sign = -1.0 if inside else 1.0
        return sign * best - rho, sign * vr / best, sign * vh / best
    n = np.sqrt(nr * nr + nh * nh)
    if n == 0:
        return -rho, 1.0, 0.0
    return -rho, nr / n, nh / n


@numba.njit(cache=True)
def _bounds(pieces, tip, axis, corners, delta, whole, on):  # type: ignore[no-untyped-def]
    """Lower and upper bound of the least signed distance over a cell; the upper one is inf where the cell is not whole."""
    c = np.zeros(3)
    for i in range(4):
        c += 0.25 * corners[i]
    d = c - tip
    h = d[0] * axis[0] + d[1] * axis[1] + d[2] * axis[2]
    e = d - h * axis
    r = np.sqrt(e[0] ** 2 + e[1] ** 2 + e[2] ** 2)
    reach = 0.0
    for i in range(4):
        w = corners[i] - c
        reach = max(reach, np.sqrt(w[0] ** 2 + w[1] ** 2 + w[2] ** 2))
    low, high = np.inf, np.inf
    for k in range(len(pieces)):
        if not on[k]:
            continue
        value, gr, gh = _signed(pieces[k], r, h)
        least = np.inf
        for i in range(4):
            w = corners[i] - c
            up = w[0] * axis[0] + w[1] * axis[1] + w[2] * axis[2]
            out = (w[0] * e[0] + w[1] * e[1] + w[2] * e[2]) / r if r > 1e-12 else 0.0
            least = min(least, gr * out + gh * up)
        if r <= 1e-12 and gr != 0.0:
            least = -reach
        low = min(low, value + max(least, -reach) - delta)
        high = min(high, value + delta)
    return low, (high if whole else np.inf), reach


@numba.njit(cache=True)
def _least(nodes, child, span, corners, delta, face, whole, pieces, tip, axis, exempt, enough, deep, work):  # type: ignore[no-untyped-def]
    """Bounds (low, high) of the least signed distance over the cells of faces that are not exempt, and how many boxes it took.

    Distances above `enough` stand for "far". It ends as soon as the upper bound is below `deep`: how deep exactly is then not asked,
    and the lower bound is -inf.
    """
    high, low = np.inf, enough
    on = np.ones(len(pieces), np.bool_)
    boxes = 0
    nstack = [(np.float64(0.0), 0)]
    nstack.pop()
    nstack.append((-np.inf, 0))
    while len(nstack) > 0:
        _, node = nstack.pop()
        d = nodes[node, :3] - tip
        h = d[0] * axis[0] + d[1] * axis[1] + d[2] * axis[2]
        e = d - h * axis
        r = np.sqrt(e[0] ** 2 + e[1] ** 2 + e[2] ** 2)
        near = np.inf
        for k in range(len(pieces)):
            near = min(near, _signed(pieces[k], r, h)[0])
        if near - nodes[node, 3] >= min(high - TIGHT, enough):
            low = min(low, near - nodes[node, 3])
            continue
        if child[node, 0] >= 0:
            a, b = child[node, 0], child[node, 1]
            wa, wb = nodes[a, :3] - tip, nodes[b, :3] - tip
            # The nearer child is looked at first: it comes last on the stack.
            if _far(pieces, wa, axis) < _far(pieces, wb, axis):
                a, b = b, a
            nstack.append((0.0, a))
            nstack.append((0.0, b))
            continue
        for row in range(span[node, 0], span[node, 1]):
            if exempt[face[row]]:
                continue
            depth = 0
            work[0] = corners[row]
            depth = 1
            while depth > 0:
                depth -= 1
                cell = work[depth].copy()
                boxes += 1
                lo, hi, reach = _bounds(pieces, tip, axis, cell, delta[row], whole[row], on)
                if hi < high:
                    high = hi
                    if high < deep:
                        return -np.inf, high, boxes
                # A cell cannot be told closer than its thickness on both sides.
                if lo >= min(high - TIGHT - 2 * delta[row], enough) or reach < SMALL or boxes > MOST or depth + 2 > len(work):
                    low = min(low, lo)
                    continue
                u = cell[1] - cell[0] + cell[2] - cell[3]
                v = cell[3] - cell[0] + cell[2] - cell[1]
                if u[0] ** 2 + u[1] ** 2 + u[2] ** 2 >= v[0] ** 2 + v[1] ** 2 + v[2] ** 2:
                    e0, e1 = 0.5 * (cell[0] + cell[1]), 0.5 * (cell[3] + cell[2])
                    work[depth, 0], work[depth, 1], work[depth, 2], work[depth, 3] = cell[0], e0, e1, cell[3]
                    work[depth + 1, 0], work[depth + 1, 1], work[depth + 1, 2], work[depth + 1, 3] = e0, cell[1], cell[2], e1
                else:
                    e0, e1 = 0.5 * (cell[0] + cell[3]), 0.5 * (cell[1] + cell[2])
                    work[depth, 0], work[depth, 1], work[depth, 2], work[depth, 3] = cell[0], cell[1], e1, e0
                    work[depth + 1, 0], work[depth + 1, 1], work[depth + 1, 2], work[depth + 1, 3] = e0, e1, cell[2], cell[3]
                depth += 2
    return min(low, high), high, boxes


@numba.njit(cache=True, inline="always")
def _far(pieces, d, axis):  # type: ignore[no-untyped-def]
    h = d[0] * axis[0] + d[1] * axis[1] + d[2] * axis[2]
    e = d - h * axis
    r = np.sqrt(e[0] ** 2 + e[1] ** 2 + e[2] ** 2)
    near = np.inf
    for k in range(len(pieces)):
        near = min(near, _signed(pieces[k], r, h)[0])
    return near


def numbers(tool: Tool) -> Floats:
    """Return the pieces of a tool as rows `h0, r0, h1, r1, rho`."""
    return np.array([[p.h0, p.r0, p.h1, p.r1, p.rho] for p in tool.pieces], float)


def least(
    shape: Tree, pieces: Floats, tip: Floats, axis: Floats, exempt: NDArray[np.bool_] | None = None, enough: float = 5.0, deep: float = -np.inf
) -> tuple[float, float, int]:
    """Return bounds of the least signed distance (mm) of one posture's tool from all faces that are not exempt.

    `pieces (k, 5)` as `numbers` gives them; `exempt (faces,)`, by default none. Distances beyond `enough` are not told apart: the lower bound is then `enough`.
    Depths beyond `-deep` are not either: the lower bound is then -inf.
    """
    c = shape.cells
    work = np.empty((256, 4, 3))
    exempt = shape.no_face if exempt is None else exempt
    low, high, boxes = _least(shape.nodes, shape.child, shape.span, c.corners, c.delta, c.face, c.whole, pieces, tip, axis, exempt, enough, deep, work)
    return float(low), float(high), int(boxes)


def deepest(shape: Tree, pieces: Floats, tip: Floats, axis: Floats, deep: float = -np.inf) -> int:
    """Return the number of the piece that the shape surely reaches deepest; depths beyond `-deep` are not told apart."""
    return int(np.argmin([least(shape, pieces[k : k + 1], tip, axis, enough=0.0, deep=deep)[1] for k in range(len(pieces))]))
