"""Sorted intervals of tilt, rows (first, last) of an array with spare ones at its end: what is taken out, put in and joined.

`domain.intervals` does the same with arrays of their own; a test holds the two against each other. Intervals whose ends are
known only to a band are in `maps.intervals`.
"""

from plan_cutters.kernels.jit import kernel


@kernel
def remove(intervals, count, first, last, narrowest):
    """Take [first, last] out of sorted intervals in place, drop what is narrower than `narrowest`; the new count."""
    written = 0
    for row in range(count):
        low, high = intervals[row, 0], intervals[row, 1]
        if last <= low or first >= high:
            intervals[written, 0], intervals[written, 1] = low, high
            written += 1
            continue
        below, above = first - low >= narrowest, high - last >= narrowest
        if below and above and written == row:
            # One interval becomes two: those after it, all above `last`, move up.
            if count == len(intervals):
                below = first - low > high - last
                above = not below
            else:
                for k in range(count, row, -1):
                    intervals[k, 0], intervals[k, 1] = intervals[k - 1, 0], intervals[k - 1, 1]
                intervals[row, 1] = first
                intervals[row + 1, 0] = last
                return count + 1
        if below:
            intervals[written, 0], intervals[written, 1] = low, first
            written += 1
        if above:
            intervals[written, 0], intervals[written, 1] = last, high
            written += 1
    return written


@kernel
def insert(intervals, count, first, last):
    """Put [first, last] among sorted intervals, which may overlap; the new count."""
    at = count
    while at > 0 and intervals[at - 1, 0] > first:
        intervals[at, 0], intervals[at, 1] = intervals[at - 1, 0], intervals[at - 1, 1]
        at -= 1
    intervals[at, 0], intervals[at, 1] = first, last
    return count + 1


@kernel
def join(intervals, count):
    """Join intervals, ascending, that touch; how many are left."""
    written = min(count, 1)
    for i in range(1, count):
        if intervals[i, 0] <= intervals[written - 1, 1]:
            intervals[written - 1, 1] = max(intervals[written - 1, 1], intervals[i, 1])
        else:
            intervals[written, 0], intervals[written, 1] = intervals[i, 0], intervals[i, 1]
            written += 1
    return written
