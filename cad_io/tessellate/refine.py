"""Triangles in a face's parameter plane, cut in two until each is near enough to the surface.

Each is cut alone, at the edge that bends most (or at the border curve that strays most), so neighbours may be cut differently:
the result is a soup. Nothing is evaluated for it but border curves: what bounds a triangle is its place in the plane.
"""

from typing import Any, NamedTuple

import numpy as np

from cad_io.tessellate.bounds import TORN, bend, most_inside, twist_share, window
from cad_io.tessellate.curves import point, strays, workspace
from plan_cutters_base.jit import entry, kernel

#: No triangle is cut more often.
_DEEPEST = 60


class Start(NamedTuple):
    """Triangles to begin with: uv (n, 2), corner (t, 3), and for the edge from each corner to the next the border curve that
    it is a chord of, curve (t, 3), -1 for none, and its parameters there, ends (t, 3, 2)."""

    uv: Any
    corner: Any
    curve: Any
    ends: Any


class Stack(NamedTuple):
    """Triangles still to be looked at."""

    uv: Any
    corner: Any
    curve: Any
    ends: Any
    age: Any


class RefinedMesh(NamedTuple):
    """Where finished triangles go: uv (n, 2) of nodes, corner (t, 3)."""

    uv: Any
    corner: Any


class _Look(NamedTuple):
    """How far a triangle may be from the surface, mm, and at which edge to cut it if need be: at a share of it, or where
    u (axis 0) or v (1) has a value. Of the distance, `strayed` is what its border curves may be from its edges."""

    off: float
    strayed: float
    edge: int
    axis: int
    at: float


@kernel
def _jumps(lines, low, high):
    """How far jumps of the first derivative may take the surface from a triangle between two values of a parameter, mm, and
    the number of the line that does so most, -1 for none."""
    first, last = 0, len(lines)
    while first < last:
        middle = (first + last) // 2
        if lines[middle, 0] <= low:
            first = middle + 1
        else:
            last = middle
    total, most, where = 0.0, 0.0, -1
    while first < len(lines) and lines[first, 0] < high:
        # Of a ramp that begins at the line.
        off = lines[first, 1] * ((high - lines[first, 0]) * (lines[first, 0] - low) / (high - low))
        if lines[first, 1] >= TORN:
            off = max(off, TORN)
        total += off
        if off > most:
            most, where = off, first
        first += 1
    return total, where


@kernel
def _crossing(stack, k, line, axis):
    """An edge that a line crosses, one within the face if there is one."""
    edge = -1
    for c in range(3):
        a, b = stack.uv[k, c, axis], stack.uv[k, (c + 1) % 3, axis]
        if min(a, b) < line < max(a, b) and (edge < 0 or stack.curve[k, c] < 0):
            edge = c
    return max(edge, 0)


@kernel
def _border(stack, k, table, curves, box):
    """How far the border curves of a triangle may be from its edges, mm, and at which edge most."""
    worst, edge = 0.0, -1
    for c in range(3):
        i = stack.curve[k, c]
        if i < 0:
            continue
        du, dv = strays(curves, i, stack.ends[k, c, 0], stack.ends[k, c, 1])
        if du == 0.0 and dv == 0.0:
            continue
        row = table.node[window(table, box[0] - du, box[1] + du, box[2] - dv, box[3] + dv)]
        off = row[12] * du + row[13] * dv
        if not off <= worst:
            worst, edge = off, c
    return worst, edge


@kernel
def _look(stack, k, table, curves, chord):
    uv = stack.uv[k]
    box = (
        min(uv[0, 0], min(uv[1, 0], uv[2, 0])),
        max(uv[0, 0], max(uv[1, 0], uv[2, 0])),
        min(uv[0, 1], min(uv[1, 1], uv[2, 1])),
        max(uv[0, 1], max(uv[1, 1], uv[2, 1])),
    )
    row = table.node[window(table, box[0], box[1], box[2], box[3])]
    strayed, border = 0.0, -1
    if stack.curve[k, 0] >= 0 or stack.curve[k, 1] >= 0 or stack.curve[k, 2] >= 0:
        strayed, border = _border(stack, k, table, curves, box)
    share = twist_share(box[1] - box[0], box[3] - box[2])
    a = bend(row, share, uv[1, 0] - uv[0, 0], uv[1, 1] - uv[0, 1])
    b = bend(row, share, uv[2, 0] - uv[1, 0], uv[2, 1] - uv[1, 1])
    c = bend(row, share, uv[0, 0] - uv[2, 0], uv[0, 1] - uv[2, 1])
    inside = most_inside(a, b, c)
    jump_u, line_u = _jumps(table.kink_u, box[0], box[1])
    jump_v, line_v = _jumps(table.kink_v, box[2], box[3])
    jump = jump_u + jump_v
    # No two points of a piece are farther apart than lines through it are long: however it bends within, if it is not torn.
    off = min(inside + jump, row[14] + row[15]) + strayed if jump < TORN else jump
    if jump > inside and jump > strayed:
        axis = 0 if jump_u >= jump_v else 1
        line = table.kink_u[line_u, 0] if axis == 0 else table.kink_v[line_v, 0]
        return _Look(off, strayed, _crossing(stack, k, line, axis), axis, line)
    if strayed > inside:
        return _Look(off, strayed, border, -1, 0.5)
    # Where an edge takes an odd number of pieces, halves would be cut once too often.
    pieces = np.ceil(np.sqrt(0.125 * max(a, max(b, c)) / chord))
    at = 0.5 if pieces < 3.0 or pieces > 99.0 else np.floor(0.5 * pieces) / pieces
    return _Look(off, strayed, 0 if a >= b and a >= c else 1 if b >= c else 2, -1, at)


@kernel
def _cut(stack, k, look, curves, number, spare):
    """Cut a triangle in two, from a point of an edge, node `number`, to the corner across: in its own place and the next."""
    edge, next_ = look.edge, (look.edge + 1) % 3
    i = stack.curve[k, edge]
    t = 0.0
    share = look.at
    if i >= 0:
        share = share if look.axis < 0 else 0.5
        t = (1.0 - share) * stack.ends[k, edge, 0] + share * stack.ends[k, edge, 1]
        u, v = point(curves, i, t, spare)
    else:
        # An edge may end a rounding beside the line that it is to be cut at.
        if look.axis >= 0:
            share = (share - stack.uv[k, edge, look.axis]) / (stack.uv[k, next_, look.axis] - stack.uv[k, edge, look.axis])
        u = (1.0 - share) * stack.uv[k, edge, 0] + share * stack.uv[k, next_, 0]
        v = (1.0 - share) * stack.uv[k, edge, 1] + share * stack.uv[k, next_, 1]
        # On the line, not beside it by a rounding.
        u, v = look.at if look.axis == 0 else u, look.at if look.axis == 1 else v
    new = k + 1
    # The next: middle, second corner, across.
    for at in range(1, 3):
        old = (edge + at) % 3
        stack.uv[new, at, 0], stack.uv[new, at, 1] = stack.uv[k, old, 0], stack.uv[k, old, 1]
        stack.corner[new, at], stack.curve[new, at] = stack.corner[k, old], stack.curve[k, old]
        stack.ends[new, at, 0], stack.ends[new, at, 1] = stack.ends[k, old, 0], stack.ends[k, old, 1]
    stack.uv[new, 0, 0], stack.uv[new, 0, 1], stack.corner[new, 0] = u, v, number
    stack.curve[new, 0], stack.ends[new, 0, 0], stack.ends[new, 0, 1] = i, t, stack.ends[k, edge, 1]
    stack.curve[new, 2] = -1
    # Its own place: first corner, middle, across.
    stack.ends[k, edge, 1] = t
    stack.uv[k, next_, 0], stack.uv[k, next_, 1], stack.corner[k, next_] = u, v, number
    stack.curve[k, next_] = -1
    stack.age[k] += 1
    stack.age[new] = stack.age[k]
    return u, v


@kernel
def _twice_area(stack, k):
    """Of a triangle in the parameter plane; negative if it runs clockwise."""
    uv = stack.uv[k]
    return (uv[1, 0] - uv[0, 0]) * (uv[2, 1] - uv[0, 1]) - (uv[1, 1] - uv[0, 1]) * (uv[2, 0] - uv[0, 0])


@kernel
def _refined(start, table, curves, chord, most, stack, spare, result):
    nodes, leaves, worst, strayed, area = np.int64(len(start.uv)), np.int64(0), 0.0, 0.0, 0.0
    uv_count, corner_count = len(result.uv), len(result.corner)
    for node in range(min(nodes, uv_count)):
        result.uv[node, 0], result.uv[node, 1] = start.uv[node, 0], start.uv[node, 1]
    for first in range(len(start.corner)):
        for c in range(3):
            node = start.corner[first, c]
            stack.uv[0, c, 0], stack.uv[0, c, 1] = start.uv[node, 0], start.uv[node, 1]
            stack.corner[0, c], stack.curve[0, c] = node, start.curve[first, c]
            stack.ends[0, c, 0], stack.ends[0, c, 1] = start.ends[first, c, 0], start.ends[first, c, 1]
        stack.age[0] = 0
        top = np.int64(0)
        while top >= 0:
            look = _look(stack, top, table, curves, chord)
            if look.off > chord and look.off < np.inf and stack.age[top] < _DEEPEST:
                u, v = _cut(stack, top, look, curves, nodes, spare)
                if nodes < uv_count:
                    result.uv[nodes, 0], result.uv[nodes, 1] = u, v
                nodes += 1
                top += 1
                continue
            # What is not a number is no bound.
            worst = max(worst, look.off) if look.off == look.off else np.inf
            strayed = max(strayed, look.strayed) if look.strayed == look.strayed else np.inf
            twice = _twice_area(stack, top)
            area += 0.5 * abs(twice)
            if leaves < corner_count:
                # A middle on a bent border may lie beyond the opposite corner: such a child is folded over.
                turn = 1 if twice < 0.0 else 0
                result.corner[leaves, 0] = stack.corner[top, 0]
                result.corner[leaves, 1], result.corner[leaves, 2] = (stack.corner[top, 1 + turn], stack.corner[top, 2 - turn])
            leaves += 1
            top -= 1
            if leaves > most:
                return leaves, nodes, worst, strayed, area
    return leaves, nodes, worst, strayed, area


@entry
def refined(start, table, curves, chord, most, result):
    """Cut triangles until each is within a distance (`chord`, mm) of the surface; where there are more than `most`, it ends: they
    are too many.

    They are written into `result` as far as there is room: with none, triangles are only counted. Returns numbers of triangles
    and of nodes, however many there was room for; the largest bound of a triangle's distance and the part that the border curves
    have in it at most, mm; the triangles' area in the parameter plane.
    """
    high = _DEEPEST + 2
    stack = Stack(
        np.empty((high, 3, 2)),
        np.empty((high, 3), np.int64),
        np.empty((high, 3), np.int64),
        np.empty((high, 3, 2)),
        np.empty(high, np.int64),
    )
    return _refined(start, table, curves, chord, most, stack, workspace(), result)
