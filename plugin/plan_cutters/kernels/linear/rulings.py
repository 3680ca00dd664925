"""How far a face goes along straight lines on it: where a wall ends."""

import numpy as np

from plan_cutters.kernels.jit import entry, kernel
from plan_cutters.kernels.linear.vectors import cross, dot

#: Distances from the plane of a line below which a corner lies in it, mm.
_IN_PLANE = 1e-9


@kernel
def _piece(triangle, point, ruling, normal, side, ends):
    """Write where the plane through a line along a normal crosses a triangle: the two ends as (along, over) the line.

    Returns whether it crosses it.
    """
    crosses = False
    for i in range(3):
        j = (i + 1) % 3
        s, t = 0.0, 0.0
        for k in range(3):
            s += (triangle[i, k] - point[k]) * side[k]
            t += (triangle[j, k] - point[k]) * side[k]
        if abs(s) <= _IN_PLANE:
            share = 0.0
        elif s * t < 0.0 and abs(t) > _IN_PLANE:
            share = s / (s - t)
        else:
            continue
        along, over = 0.0, 0.0
        for k in range(3):
            x = triangle[i, k] + share * (triangle[j, k] - triangle[i, k]) - point[k]
            along += x * ruling[k]
            over += x * normal[k]
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
def _balls(vertex, centre, reach):
    """Write balls about triangles (t, 3, 3), mm: centres (t, 3), and radii (t,) with what rounding may do."""
    for t in range(len(vertex)):
        size = 0.0
        for k in range(3):
            centre[t, k] = (vertex[t, 0, k] + vertex[t, 1, k] + vertex[t, 2, k]) / 3.0
            size += abs(centre[t, k])
        square = 0.0
        for i in range(3):
            far = 0.0
            for k in range(3):
                far += (vertex[t, i, k] - centre[t, k]) ** 2
            square = max(square, far)
        reach[t] = np.sqrt(square) * (1.0 + 1e-9) + 2.0 * _IN_PLANE + 1e-12 * size


@entry
def extents(point, ruling, normal, vertex, band, low, high):
    """Find how far a face goes along lines that lie on it.

    Gaps in the face, such as holes, count as the face itself; where it leaves the line by more than the band, it ends.

    Parameters
    ----------
    point : (p, 3) float64
        On the face, mm.
    ruling, normal : (p, 3) float64
        Unit directions of the line and of the face there, at right angles.
    vertex : (t, 3, 3) float64
        Triangles of the face, mm.
    band : float
        How far the face may be off the line along the normal, mm.
    low, high : (p,) float64, written
        Ends of the face from the point along the line, mm: 0 or less and 0 or more; nan where no triangle is near the line.
    """
    side, ends, limit = np.empty(3), np.empty((2, 2)), np.empty(2)
    centre, reach = np.empty((len(vertex), 3)), np.empty(len(vertex))
    _balls(vertex, centre, reach)
    for i in range(len(point)):
        cross(ruling[i], normal[i], side)
        limit[0], limit[1] = -np.inf, np.inf
        first, last = np.inf, -np.inf
        through = dot(side, point[i])
        for t in range(len(vertex)):
            # Most triangles lie on one side of the plane as a whole.
            if abs(dot(side, centre[t]) - through) > reach[t]:
                continue
            if _piece(vertex[t], point[i], ruling[i], normal[i], side, ends) and _clipped(ends, band, limit):
                first, last = min(first, ends[0, 0]), max(last, ends[1, 0])
        low[i] = high[i] = np.nan
        if first <= last and dot(side, side) > 0.5:
            low[i], high[i] = min(0.0, max(first, limit[0])), max(0.0, min(last, limit[1]))
