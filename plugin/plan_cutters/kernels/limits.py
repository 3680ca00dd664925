"""Tilts at which a machine's rotary axes hold the tool axis: arcs between the circles at which that changes.

At one rotation the tool axis runs along a great circle, a(tilt) = cos(tilt) n + sin(tilt) f. It crosses each circle of
`domain.kinematics.Kinematics.circles` twice at most; between two crossings the machine holds all of it or nothing, which the
angles at the middle tell.
"""

import numpy as np

from plan_cutters.kernels.codes import ON_LIMIT, PARALLEL
from plan_cutters.kernels.jit import entry, kernel
from plan_cutters.kernels.linear.vectors import cross, dot, tilt_frame
from plan_cutters.kernels.tool.arcs import axis_arcs

#: Crossings that are kept, at the end of the array of intervals: two for each of at most six circles, and the ends.
CROSSINGS = 16
_TURN = 2.0 * np.pi


@kernel
def turn_of(n, e1, ranges, rotation):
    """Cosine and sine of a rotation, counted from direction_max e1 about the normal n."""
    aim = ranges.rotary.aim
    if len(aim) == 0:
        return ranges.rotation_cos[rotation], ranges.rotation_sin[rotation]
    a = aim[rotation]
    x = a[0] * e1[0] + a[1] * e1[1] + a[2] * e1[2]
    y = a[0] * (n[1] * e1[2] - n[2] * e1[1]) + a[1] * (n[2] * e1[0] - n[0] * e1[2]) + a[2] * (n[0] * e1[1] - n[1] * e1[0])
    size = np.hypot(x, y)
    # An axis along the normal is reached at tilt 0, whatever the rotation.
    return (x / size, y / size) if size > 1e-12 else (1.0, 0.0)


@kernel
def limited(rotary):
    """Whether there is a machine with rotary axes, or with none that could turn the tool."""
    return rotary.tool[0] != 0.0 or rotary.tool[1] != 0.0 or rotary.tool[2] != 0.0


@kernel
def _turns_within(angle, low, high):
    """Whether an angle lies between two limits, by whole turns."""
    if high - low >= _TURN:
        return True
    least = np.ceil((low - ON_LIMIT - angle) / _TURN)
    return angle + _TURN * least <= high + ON_LIMIT


@kernel
def _about(d, sx, sy, sz, x, y, z):
    """Angle by which a vector s turns about a unit direction into another; and the squared length of what turns."""
    cx, cy, cz = sy * z - sz * y, sz * x - sx * z, sx * y - sy * x
    along, other = d[0] * sx + d[1] * sy + d[2] * sz, d[0] * x + d[1] * y + d[2] * z
    cross, inner = d[0] * cx + d[1] * cy + d[2] * cz, sx * x + sy * y + sz * z - along * other
    return np.arctan2(cross, inner), cross * cross + inner * inner


@kernel
def holds(x, y, z, rotary):
    """Whether the machine holds a unit tool axis."""
    t, direction = rotary.tool, rotary.direction
    axes = len(direction)
    if axes == 0:
        cx, cy, cz = y * t[2] - z * t[1], z * t[0] - x * t[2], x * t[1] - y * t[0]
        return cx * cx + cy * cy + cz * cz <= PARALLEL * PARALLEL and x * t[0] + y * t[1] + z * t[2] > 0.0
    first = direction[0]
    along = first[0] * x + first[1] * y + first[2] * z
    if axes == 1:
        if abs(along - dot(first, t)) > PARALLEL:
            return False
        angle, _ = _about(first, t[0], t[1], t[2], x, y, z)
        return _turns_within(angle, rotary.limit[0, 0], rotary.limit[0, 1])
    second, (start, most, base) = direction[1], rotary.swing
    share = (along - base) / most
    if abs(share) > 1.0 + 1e-12:
        return False
    swing = np.arccos(min(1.0, max(-1.0, share)))
    inner = dot(second, t)
    for side in range(2):
        angle = start + swing if side == 0 else start - swing
        if not _turns_within(angle, rotary.limit[1, 0], rotary.limit[1, 1]):
            continue
        c, s = np.cos(angle), np.sin(angle)
        vx = inner * second[0] + c * (t[0] - inner * second[0]) + s * (second[1] * t[2] - second[2] * t[1])
        vy = inner * second[1] + c * (t[1] - inner * second[1]) + s * (second[2] * t[0] - second[0] * t[2])
        vz = inner * second[2] + c * (t[2] - inner * second[2]) + s * (second[0] * t[1] - second[1] * t[0])
        turn, size = _about(first, vx, vy, vz, x, y, z)
        # Along the first axis any angle of it serves.
        if size <= PARALLEL**4 or _turns_within(turn, rotary.limit[0, 0], rotary.limit[0, 1]):
            return True
    return False


@kernel
def _held_at(n, f, tilt, rotary):
    c, s = np.cos(tilt), np.sin(tilt)
    return holds(c * n[0] + s * f[0], c * n[1] + s * f[1], c * n[2] + s * f[2], rotary)


@kernel
def _crossings(n, f, low, high, rotary, intervals):
    """Write the tilts between `low` and `high` at which what the machine holds may change, ascending; how many."""
    base, count = len(intervals) - CROSSINGS, 0
    for i in range(len(rotary.circle)):
        circle = rotary.circle[i]
        along_n = circle[0] * n[0] + circle[1] * n[1] + circle[2] * n[2]
        along_f = circle[0] * f[0] + circle[1] * f[1] + circle[2] * f[2]
        size = np.hypot(along_n, along_f)
        if size == 0.0 or abs(circle[3]) > size * (1.0 + 1e-12):
            continue
        middle, half = np.arctan2(along_f, along_n), np.arccos(min(1.0, max(-1.0, circle[3] / size)))
        for side in range(2):
            tilt = middle + half if side == 0 else middle - half
            tilt -= _TURN * np.floor((tilt - low) / _TURN)
            if low < tilt < high and count < CROSSINGS:
                at = base + count
                while at > base and intervals[at - 1, 0] > tilt:
                    intervals[at, 0] = intervals[at - 1, 0]
                    at -= 1
                intervals[at, 0] = tilt
                count += 1
    return count


@kernel
def hold(n, f, rotary, intervals, count):
    """Leave of sorted intervals of tilt what the machine holds; the new count.

    `n`, `f` (3,) float64: normal and tilt direction. `intervals` (m, 2) float64, read and written: with spare rows at the end:
    `CROSSINGS`, and three for each crossing and interval.
    """
    written, base = 0, len(intervals) - CROSSINGS
    # Those to come are put aside, for one may become several.
    margin = base - count
    for i in range(count - 1, -1, -1):
        intervals[margin + i, 0], intervals[margin + i, 1] = intervals[i, 0], intervals[i, 1]
    for i in range(count):
        low, high = intervals[margin + i, 0], intervals[margin + i, 1]
        crossing = _crossings(n, f, low, high, rotary, intervals)
        # `open`: the last interval kept ends at `last`, and goes on if what follows is held.
        last, going = low, False
        for k in range(crossing + 1):
            end = high if k == crossing else intervals[base + k, 0]
            if _held_at(n, f, 0.5 * (last + end), rotary):
                if going:
                    intervals[written - 1, 1] = end
                else:
                    intervals[written, 0], intervals[written, 1] = last, end
                    written += 1
                going = True
            else:
                # A single tilt is held where limits meet, or where fewer than two axes turn the tool.
                if not going and _held_at(n, f, last, rotary):
                    intervals[written, 0], intervals[written, 1] = last, last
                    written += 1
                going = False
            last = end
        if not going and _held_at(n, f, high, rotary) and high > low:
            intervals[written, 0], intervals[written, 1] = high, high
            written += 1
    return written


@kernel
def held_tilts(n, f, ranges, low, high, intervals):
    """Write the tilts between two, rad, at which the machine holds the axis, by its plain limit and its rotary axes; how many
    intervals.

    `n`, `f` and `intervals` as for `hold`.
    """
    count = axis_arcs(dot(ranges.setup, n), dot(ranges.setup, f), ranges.limit_cos, low, high, intervals)
    return hold(n, f, ranges.rotary, intervals, count) if limited(ranges.rotary) else count


@entry
def any_axis(rows, normal, direction_max, ranges, low, high, held):
    """Write whether the axis limits leave any tilt between two, rad, at any rotation: held (n,) of the samples `rows`."""
    intervals, e2, f, t = np.empty((64, 2)), np.empty(3), np.empty(3), np.empty(3)
    for row in rows:
        n, e1 = normal[row], direction_max[row]
        cross(n, e1, e2)
        held[row] = False
        for rotation in range(len(ranges.rotation_cos)):
            cosine, sine = turn_of(n, e1, ranges, rotation)
            tilt_frame(e1, e2, cosine, sine, f, t)
            if held_tilts(n, f, ranges, low, high, intervals) > 0:
                held[row] = True
                break
