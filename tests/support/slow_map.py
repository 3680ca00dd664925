"""Slow twin of posture maps: free tilts of samples at all rotations, range by range, as at one point.

Each range is tested as a whole: nothing is handed on from one to the next, and no plane parts anything.
"""

import numba
import numpy as np

from plan_cutters.kernels.linear.vectors import cross, tilt_frame
from plan_cutters.kernels.maps.free_tilts import OPEN, UNSURE, free_tilts
from plan_cutters.kernels.search.place import permitted

#: Parts that the tilts of one rotation may fall into.
_PARTS = 400


@numba.njit(error_model="numpy")
def _enter(first, last, count, part):
    """Enter a free interval among those (room, 2), ascending, joined with what it touches; (how many, what found no room)."""
    for i in range(count):
        if part[i, 1] == first:
            part[i, 1] = last
            return count, 0.0
        if part[i, 0] == last:
            part[i, 0] = first
            return count, 0.0
    if count == len(part):
        return count, last - first
    part[count, 0], part[count, 1] = first, last
    return count + 1, 0.0


@numba.njit(error_model="numpy")
def _ordered(count, part):
    """Put free intervals in ascending order and join those that touch; how many are left."""
    for i in range(1, count):
        first, last, at = part[i, 0], part[i, 1], i
        while at > 0 and part[at - 1, 0] > first:
            part[at, 0], part[at, 1] = part[at - 1, 0], part[at - 1, 1]
            at -= 1
        part[at, 0], part[at, 1] = first, last
    kept = min(count, 1)
    for i in range(1, count):
        if part[i, 0] <= part[kept - 1, 1]:
            part[kept - 1, 1] = max(part[kept - 1, 1], part[i, 1])
        else:
            part[kept, 0], part[kept, 1] = part[i, 0], part[i, 1]
            kept += 1
    return kept


@numba.njit(error_model="numpy")
def tool_map(rows, contacts, ranges, tool, narrowest, tree, part, count_out, undecided):
    """Free tilts of samples at all rotations; parameters as for `free_map.free_map`.

    Parameters
    ----------
    rows : (m,) int64
    contacts : Contacts
    ranges : Ranges
    tool : Tool
        Without what does not matter.
    narrowest : float
        rad.
    tree : Tree
    part : (m, k, room, 2) float64, written
    count_out : (m, k) int32, written
    undecided : (m, k) float64, written
    """
    f, t, e2, intervals = np.empty(3), np.empty(3), np.empty(3), np.empty((8, 2))
    for place in range(len(rows)):
        row = rows[place]
        p, n, e1 = contacts.point[row], contacts.normal[row], contacts.direction_max[row]
        cross(n, e1, e2)
        for rotation in range(len(ranges.rotation_cos)):
            tilt_frame(e1, e2, ranges.rotation_cos[rotation], ranges.rotation_sin[rotation], f, t)
            count, unsure, mine = 0, 0.0, part[place, rotation]
            for mode in range(len(tool.mode)):
                _, left = permitted(contacts, row, ranges, tool, mode, f, intervals)
                for i in range(left):
                    low, high = intervals[i, 0], intervals[i, 1]
                    for first, last, kind in free_tilts(p, n, f, low, high, tool, mode, narrowest, tree, _PARTS):
                        if kind == UNSURE:
                            unsure += last - first
                        elif kind == OPEN:
                            count, lost = _enter(first, last, count, mine)
                            unsure += lost
            count_out[place, rotation], undecided[place, rotation] = _ordered(count, mine), unsure
