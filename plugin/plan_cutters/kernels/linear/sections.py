"""How far a face goes on through a point, along a plane across it: the length of a pass, and how much there is across one."""

import math
from typing import Any, NamedTuple

import numpy as np

from plan_cutters.kernels.jit import entry, kernel
from plan_cutters.kernels.linear.rulings import IN_PLANE, crossing, place_on
from plan_cutters.kernels.linear.vectors import cross

#: Ends of pieces are the same within this, mm.
_SAME = 1e-7


class _Pieces(NamedTuple):
    """Pieces of a section, (t, 4) as the ends' places along and over the face, and which of them have been counted (t,)."""

    ends: Any
    counted: Any


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


@entry
def sections(point, along, normal, vertex, near, gap, connected, whole):
    """Measure a face in planes through points on it: the part that goes on from the point, and all that the plane cuts.

    Parameters
    ----------
    point : (p, 3) float64
        mm.
    along, normal : (p, 3) float64
        Unit directions that span the plane, in the face and along its normal, at right angles.
    vertex : (t, 3, 3) float64
        Corners of the triangles of the face, mm.
    near, gap : float
        How far the point may be off the triangles, and what ends of neighbours may be apart, mm.
    connected, whole : (p,) float64, written
        Lengths along the face, mm; nan where no triangle is near the point.
    """
    frame = np.empty((3, 3))
    pieces = _Pieces(np.empty((len(vertex) + 1, 4)), np.zeros(len(vertex) + 1, np.bool_))
    for i in range(len(point)):
        frame[0], frame[1] = along[i], normal[i]
        cross(along[i], normal[i], frame[2])
        connected[i] = whole[i] = np.nan
        many, first, least = 0, -1, near
        for t in range(len(vertex)):
            if not _crossing(vertex[t], point[i], frame, pieces.ends[many]):
                continue
            away = _away(pieces.ends[many])
            if away <= least:
                first, least = many, away
            many += 1
        if first < 0:
            continue
        pieces.counted[:many] = False
        pieces.counted[first] = True
        length = _long(pieces.ends[first])
        for end in (0, 2):
            length += _onwards(pieces, many, first, end, gap)
        connected[i] = length
        for k in range(many):
            if not pieces.counted[k]:
                length += _long(pieces.ends[k])
        whole[i] = length
