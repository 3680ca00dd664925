"""A machine laid over free tilts that are known: what it holds of them."""

import numpy as np

from plan_cutters.kernels.jit import entry
from plan_cutters.kernels.limits import held_tilts
from plan_cutters.kernels.linear.vectors import cross, tilt_frame


@entry
def held_free(rows, normal, direction_max, ranges, offset, free, place, held_intervals):
    """Keep the free tilts that the machine can hold, at every rotation of the maps: count the intervals, or write
    them to `held_intervals`.

    Parameters
    ----------
    rows : (m,) int64
    normal, direction_max : (n, 3) float64
    ranges : Ranges
        Of as many rotations as the maps have.
    offset, free
        As in `PostureMaps`.
    place : (n * k,) int64
        How many intervals each sample has at each rotation, written; where they begin in `held_intervals`, read if that has rows.
    held_intervals : (m, 2) float64, written
        Without rows: nothing but `place` is written.
    """
    intervals, e2, f, t = np.empty((64, 2)), np.empty(3), np.empty(3), np.empty(3)
    count = len(ranges.rotation_cos)
    for row in rows:
        n, e1 = normal[row], direction_max[row]
        cross(n, e1, e2)
        for rotation in range(count):
            cell = row * count + rotation
            at = place[cell]
            if len(held_intervals) == 0:
                place[cell] = at = 0
            if offset[cell] == offset[cell + 1]:
                continue
            tilt_frame(e1, e2, ranges.rotation_cos[rotation], ranges.rotation_sin[rotation], f, t)
            held = held_tilts(n, f, ranges, ranges.tilt_low, ranges.tilt_high, intervals)
            for i in range(offset[cell], offset[cell + 1]):
                for k in range(held):
                    low, high = max(free[i, 0], intervals[k, 0]), min(free[i, 1], intervals[k, 1])
                    if low > high:
                        continue
                    if len(held_intervals) == 0:
                        place[cell] += 1
                    else:
                        held_intervals[at, 0], held_intervals[at, 1] = low, high
                        at += 1
