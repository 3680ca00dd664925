"""How far a face goes through a point: along lines on it, where a wall ends, and in a plane across it, the length of a pass."""

import math
from collections import namedtuple

import numpy as np

from plan_cutters.kernels.codes import CENTRE, DIAGONAL, HALVES, SIDES
from plan_cutters.kernels.jit import entry, kernel
from plan_cutters.kernels.linear.tree import half
from plan_cutters.kernels.linear.vectors import cross, dot

#: Distances from the plane of a line below which a corner lies in it, mm.
IN_PLANE = 1e-9


@kernel
def crossing(s, t):
    """Where on an edge a plane lies, from 0 to 1, by the distances of its ends from it; -1 where it does not cross the edge."""
    if abs(s) <= IN_PLANE:
        return 0.0
    return s / (s - t) if s * t < 0.0 and abs(t) > IN_PLANE else -1.0


@kernel
def place_on(triangle, i, share, point, ruling, normal):
    """Give a place on the edge from corner i, as (along, over) a line through a point."""
    j, along, over = (i + 1) % 3, 0.0, 0.0
    for k in range(3):
        x = triangle[i, k] + share * (triangle[j, k] - triangle[i, k]) - point[k]
        along += x * ruling[k]
        over += x * normal[k]
    return along, over


@kernel
def _piece(triangle, point, ruling, normal, side, ends):
    """Write where the plane through a line along a normal crosses a triangle, (along, over) the line; whether it does."""
    crosses = False
    for i in range(3):
        j = (i + 1) % 3
        s, t = 0.0, 0.0
        for k in range(3):
            s += (triangle[i, k] - point[k]) * side[k]
            t += (triangle[j, k] - point[k]) * side[k]
        share = crossing(s, t)
        if share < 0.0:
            continue
        along, over = place_on(triangle, i, share, point, ruling, normal)
        if not crosses or along < ends[0, 0]:
            ends[0, 0], ends[0, 1] = along, over
        if not crosses or along > ends[1, 0]:
            ends[1, 0], ends[1, 1] = along, over
        crosses = True
    return crosses


@kernel
def _clipped(ends, band, limit):
    """Leave of a piece what lies within the band; where it leaves the band, that limits the line. Whether anything is left."""
    (a, over_a), (b, over_b) = ends
    if min(over_a, over_b) > band or max(over_a, over_b) < -band:
        return False
    if abs(over_a) > band or abs(over_b) > band:
        for edge in (-band, band):
            if (over_a - edge) * (over_b - edge) < 0.0:
                crossing = a + (edge - over_a) / (over_b - over_a) * (b - a)
                if crossing < 0.0:
                    limit[0] = max(limit[0], crossing)
                else:
                    limit[1] = min(limit[1], crossing)
    return True


@kernel
def _apart(box, node, along, offset, most):
    """Whether a box lies wholly farther than `most` from a plane with the unit normal `along`, on one side of it.

    `offset`: of the plane along its normal. What rounding may do is on the side of not being apart.
    """
    at, half, size = -offset, 2.0 * IN_PLANE + 1e-9 * box[node, DIAGONAL] + most, abs(offset)
    for k in range(3):
        at += along[k] * box[node, CENTRE + k]
        size += abs(box[node, CENTRE + k])
        side = 0.0
        for j in range(3):
            side += along[j] * box[node, SIDES + 3 * k + j]
        half += box[node, HALVES + k] * abs(side)
    return abs(at) > half + 1e-12 * size


#: The triangles of one face among others: their tree, the face numbers (n,) in tree order, and the number of the one.
OneFace = namedtuple("OneFace", "tree faces number")

#: A workspace: side (3,), ends (2, 2), limit (2,), stack (64,) int64.
_Workspace = namedtuple("_Workspace", "side ends limit stack")


@kernel
def _among(point, ruling, normal, own, band, workspace):
    """The least and the largest place along a line at which a face is met; where it leaves the line is written as its limit."""
    side, ends, limit, stack = workspace
    limit[0], limit[1] = -np.inf, np.inf
    first, last = np.inf, -np.inf
    through, over = dot(side, point), dot(normal, point)
    for k in range(2):
        vertex, box, depth, begin = half(own.tree, k)
        n, inner, top = len(vertex), (1 << depth) - 1, 1 if len(vertex) else 0
        stack[0] = 0
        while top > 0:
            top -= 1
            node = stack[top]
            # What the plane through the line does not cross within the band changes nothing.
            if _apart(box, node, side, through, 0.0) or _apart(box, node, normal, over, band):
                continue
            if node < inner:
                stack[top], stack[top + 1] = 2 * node + 2, 2 * node + 1
                top += 2
                continue
            leaf = node - inner
            for t in range((n * leaf) >> depth, (n * (leaf + 1)) >> depth):
                if own.faces[begin + t] != own.number:
                    continue
                if _piece(vertex[t], point, ruling, normal, side, ends) and _clipped(ends, band, limit):
                    first, last = min(first, ends[0, 0]), max(last, ends[1, 0])
    return first, last


@entry
def extents(point, ruling, normal, own, band, low, high):
    """Find how far a face goes along lines that lie on it.

    Gaps in the face, such as holes, count as the face itself; where it leaves the line by more than the band, it ends.

    `point` (p, 3) float64: on the face, mm.
    `ruling`, `normal` (p, 3) float64: unit directions of the line and of the face there, at right angles.
    `own` (OneFace): the face.
    `band` (float): how far the face may be off the line along the normal, mm.
    `low`, `high` (p,) float64, written: ends of the face from the point along the line, mm: 0 or less and 0 or more; nan where no
      triangle is near the line.
    """
    workspace = _Workspace(np.empty(3), np.empty((2, 2)), np.empty(2), np.empty(64, np.int64))
    for i in range(len(point)):
        cross(ruling[i], normal[i], workspace.side)
        low[i] = high[i] = np.nan
        if not dot(workspace.side, workspace.side) > 0.5:
            continue
        first, last = _among(point[i], ruling[i], normal[i], own, band, workspace)
        if first <= last:
            low[i], high[i] = min(0.0, max(first, workspace.limit[0])), max(0.0, min(last, workspace.limit[1]))


#: Ends of pieces are the same within this, mm.
_SAME = 1e-7


#: Pieces of a section, (t, 4) as the ends' places along and over the face, and which of them have been counted (t,).
_Pieces = namedtuple("_Pieces", "ends counted")


@kernel
def _crossing(triangle, point, frame, ends):
    """Write the piece of a triangle in the plane of two of a frame (3, 3): along, over, across; whether there is one."""
    many, through = 0, 0.0
    for k in range(3):
        through += point[k] * frame[2, k]
    first = triangle[0, 0] * frame[2, 0] + triangle[0, 1] * frame[2, 1] + triangle[0, 2] * frame[2, 2] - through
    second = triangle[1, 0] * frame[2, 0] + triangle[1, 1] * frame[2, 1] + triangle[1, 2] * frame[2, 2] - through
    third = triangle[2, 0] * frame[2, 0] + triangle[2, 1] * frame[2, 1] + triangle[2, 2] * frame[2, 2] - through
    if min(first, second, third) > IN_PLANE or max(first, second, third) < -IN_PLANE:
        return False
    off = (first, second, third)
    for i in range(3):
        share = crossing(off[i], off[(i + 1) % 3])
        if share < 0.0:
            continue
        if many < 2:
            ends[2 * many], ends[2 * many + 1] = place_on(triangle, i, share, point, frame[0], frame[1])
        many += 1
    return many >= 2 and math.hypot(ends[2] - ends[0], ends[3] - ends[1]) > IN_PLANE


@kernel
def _away(ends):
    """The distance of a piece from the point."""
    x, y = ends[2] - ends[0], ends[3] - ends[1]
    share = -(ends[0] * x + ends[1] * y) / (x * x + y * y)
    share = min(1.0, max(0.0, share))
    return math.hypot(ends[0] + share * x, ends[1] + share * y)


@kernel
def _long(ends):
    return math.hypot(ends[2] - ends[0], ends[3] - ends[1])


@kernel
def _onwards(pieces, many, which, end, gap):
    """The length of what goes on from an end, 0 or 2, of a piece. Pieces that are there twice are counted once."""
    ends, counted = pieces
    length = 0.0
    while True:
        x, y, back_x, back_y = ends[which, end], ends[which, end + 1], ends[which, 2 - end], ends[which, 3 - end]
        best, nearest, begin = -1, gap * gap, 0
        for i in range(many):
            if counted[i]:
                continue
            for k in (0, 2):
                off_x, off_y = ends[i, k] - x, ends[i, k + 1] - y
                away = off_x * off_x + off_y * off_y
                if away <= nearest:
                    if abs(ends[i, 2 - k] - back_x) + abs(ends[i, 3 - k] - back_y) <= _SAME and away <= _SAME * _SAME:
                        counted[i] = True
                        break
                    best, nearest, begin = i, away, k
        if best < 0:
            return length
        counted[best] = True
        length += _long(ends[best])
        which, end = best, 2 - begin


@kernel
def _through(pieces, many, which, gap):
    """The length of what goes on both ways from a piece, among the first so many."""
    pieces.counted[:many] = False
    pieces.counted[which] = True
    length = _long(pieces.ends[which])
    for end in (0, 2):
        length += _onwards(pieces, many, which, end, gap)
    return length


@entry
def sections(point, along, normal, vertex, unit, own, least, near, gap, connected, beyond, whole):
    """Measure a face in planes through points on it: what goes on from the point, in it and beyond it, and all that is cut.

    `point` (p, 3) float64: mm.
    `along`, `normal` (p, 3) float64: unit directions that span the plane, in the face and along its normal, at right angles.
    `vertex` (t, 3, 3) float64: corners of the triangles of the face, mm, and behind them of those faces onto which it goes on
      smoothly.
    `unit` (t, 3) float64: their unit normals, either way.
    `own` (int): how many are those of the face.
    `least` (float): cosine of the angle by which others lean at most from the normal at the point, for a pass to go on over them.
    `near`, `gap` (float): how far the point may be off the triangles, and what ends of neighbours may be apart, mm.
    `connected`, `beyond`, `whole` (p,) float64, written: lengths along the face, along it and what it goes on onto, and of all of
      the face in the plane, mm; nan where no triangle is near the point.
    """
    frame = np.empty((3, 3))
    pieces = _Pieces(np.empty((len(vertex) + 1, 4)), np.zeros(len(vertex) + 1, np.bool_))
    for i in range(len(point)):
        frame[0], frame[1] = along[i], normal[i]
        cross(along[i], normal[i], frame[2])
        connected[i] = beyond[i] = whole[i] = np.nan
        many, mine, first, nearest = 0, 0, -1, near
        for t in range(len(vertex)):
            if t >= own and abs(dot(unit[t], normal[i])) < least:
                continue
            if not _crossing(vertex[t], point[i], frame, pieces.ends[many]):
                continue
            if t < own:
                away = _away(pieces.ends[many])
                if away <= nearest:
                    first, nearest = many, away
                mine += 1
            many += 1
        if first < 0:
            continue
        beyond[i] = _through(pieces, many, first, gap)
        length = beyond[i] if mine == many else _through(pieces, mine, first, gap)
        connected[i] = length
        for k in range(mine):
            if not pieces.counted[k]:
                length += _long(pieces.ends[k])
        whole[i] = length
