"""How far a face goes on through a point, along a plane across it: the length of a pass, and how much there is across one."""

import math
from typing import Any, NamedTuple

import numpy as np

from plan_cutters.kernels.jit import entry, kernel
from plan_cutters.kernels.linear.vectors import cross

#: Distances from the plane below which a corner lies in it, mm.
_IN_PLANE = 1e-9


class _Pieces(NamedTuple):
    """Pieces of a section, (t, 4) as the ends' places along and over the face, and which of them have been counted (t,)."""

    ends: Any
    counted: Any


@kernel
def _crossing(triangle, point, frame, ends):
    """Write the piece of a triangle in the plane of two of a frame (3, 3): along, over, across; whether there is one."""
    found = 0
    for i in range(3):
        j = (i + 1) % 3
        s, t = 0.0, 0.0
        for k in range(3):
            s += (triangle[i, k] - point[k]) * frame[2, k]
            t += (triangle[j, k] - point[k]) * frame[2, k]
        if abs(s) <= _IN_PLANE:
            share = 0.0
        elif s * t < 0.0 and abs(t) > _IN_PLANE:
            share = s / (s - t)
        else:
            continue
        along, over = 0.0, 0.0
        for k in range(3):
            x = triangle[i, k] + share * (triangle[j, k] - triangle[i, k]) - point[k]
            along += x * frame[0, k]
            over += x * frame[1, k]
        if found < 2:
            ends[2 * found], ends[2 * found + 1] = along, over
        found += 1
    return found >= 2 and math.hypot(ends[2] - ends[0], ends[3] - ends[1]) > _IN_PLANE


@kernel
def _away(ends):
    """The distance of a piece from the point."""
    x, y = ends[2] - ends[0], ends[3] - ends[1]
    share = -(ends[0] * x + ends[1] * y) / (x * x + y * y)
    share = min(1.0, max(0.0, share))
    return math.hypot(ends[0] + share * x, ends[1] + share * y)


@kernel
def _count(pieces, many, which):
    """Count a piece, with others that are the same; its length."""
    ends, counted = pieces
    for i in range(many):
        same = True
        for k in range(4):
            same = same and abs(ends[i, k] - ends[which, k]) <= 1e-7
        turned = True
        for k in range(4):
            turned = turned and abs(ends[i, k] - ends[which, (k + 2) % 4]) <= 1e-7
        if same or turned:
            counted[i] = True
    return math.hypot(ends[which, 2] - ends[which, 0], ends[which, 3] - ends[which, 1])


@kernel
def _onwards(pieces, many, x, y, gap):
    """The length of what goes on from a place, piece by piece."""
    ends, counted = pieces
    length = 0.0
    while True:
        best, nearest, end = -1, gap, 0
        for i in range(many):
            if counted[i]:
                continue
            for k in (0, 2):
                away = math.hypot(ends[i, k] - x, ends[i, k + 1] - y)
                if away <= nearest:
                    best, nearest, end = i, away, k
        if best < 0:
            return length
        length += _count(pieces, many, best)
        x, y = ends[best, 2 - end], ends[best, 3 - end]


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
        ends = pieces.ends
        length = _count(pieces, many, first)
        length += _onwards(pieces, many, ends[first, 0], ends[first, 1], gap)
        length += _onwards(pieces, many, ends[first, 2], ends[first, 3], gap)
        connected[i] = length
        for k in range(many):
            if not pieces.counted[k]:
                length += _count(pieces, many, k)
        whole[i] = length
