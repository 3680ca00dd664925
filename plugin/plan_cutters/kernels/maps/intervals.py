"""Intervals of tilts at a rotation, and what an arc takes out of them.

An interval is a row: the tilts between which it lies, their cosines and sines, and how far its ends may be off. What passes a
interval passes all that is left of it; `docs/posture_map_proof.md` has the argument.
"""

import numpy as np

from plan_cutters.kernels.jit import kernel

#: Intervals that one rotation may fall into. The row after the last counts what stays undecided and belongs to none.
INTERVALS = 16
#: Columns of an interval: its tilts, their cosines and sines, how far each may be off.
FIRST, LAST, CF, SF, CL, SL, UF, UL, COLUMNS = 0, 1, 2, 3, 4, 5, 6, 7, 8
#: By which an arc is widened, so that its ends are out of it, rad.
_HAIR = 1e-9


@kernel
def _cuts(x, y, z, interval, count, tool):
    """Tell whether a point is in the body at some tilt of some interval: none of the sides of lemma M1 parts them."""
    radius, shrunk, low, high, _ = tool
    square = shrunk * shrunk - y * y
    if square <= 0.0 or z <= low:
        return False
    half = np.sqrt(square)
    rim, far, away = radius - half, radius + half, x * x + z * z
    if away <= rim * rim + low * low or away >= far * far + high * high:
        return False
    for g in range(count):
        top = interval[g, CF] * z + interval[g, SF] * x
        if top <= 0.0 or (top <= low and interval[g, CF] * x <= interval[g, SF] * z):
            continue
        if interval[g, SF] * z - interval[g, CF] * x >= far:
            continue
        bottom = interval[g, CL] * z + interval[g, SL] * x
        if bottom >= high or (bottom >= 0.0 and interval[g, SL] * z - interval[g, CL] * x <= rim):
            continue
        return True
    return False


@kernel
def _begin(interval, g, tilt, unsure):
    interval[g, FIRST], interval[g, CF], interval[g, SF], interval[g, UF] = tilt, np.cos(tilt), np.sin(tilt), unsure


@kernel
def _end(interval, g, tilt, unsure):
    interval[g, LAST], interval[g, CL], interval[g, SL], interval[g, UL] = tilt, np.cos(tilt), np.sin(tilt), unsure


@kernel
def _drop(interval, g, count):
    """Take an interval out, its bands with it; the new count."""
    for k in range(COLUMNS):
        interval[g, k] = interval[count - 1, k]
    return count - 1


@kernel
def _part(interval, g, count, left, right, unsure):
    """Take the tilts between `left` and `right`, within an interval, out of it; the new count.

    Its new ends get the band `unsure`. Bands that are cut off stay undecided, as does the narrower part if there is no row
    for both: they are counted in the row after the last interval.
    """
    a, b = interval[g, FIRST], interval[g, LAST]
    if left > a and right < b and count == INTERVALS:
        if left - a >= b - right:
            interval[INTERVALS, UL] += b - right
            right = b
        else:
            interval[INTERVALS, UF] += left - a
            left = a
    if left > a and right < b:
        for k in range(COLUMNS):
            interval[count, k] = interval[g, k]
        _begin(interval, count, right, unsure)
        _end(interval, g, left, unsure)
        return count + 1
    if right < b:
        interval[INTERVALS, UF] += interval[g, UF]
        _begin(interval, g, right, unsure)
    elif left > a:
        interval[INTERVALS, UL] += interval[g, UL]
        _end(interval, g, left, unsure)
    else:
        interval[INTERVALS, UF] += interval[g, UF] + interval[g, UL] + min(b - a, unsure)
        return _drop(interval, g, count)
    return count


@kernel
def _take(interval, count, left, right):
    """Take an arc that a point forbids out of the intervals; the new count."""
    left, right = left - _HAIR, right + _HAIR
    if right - left <= 2.0 * _HAIR:
        return count
    g = 0
    while g < count:
        a, b = interval[g, FIRST], interval[g, LAST]
        if right <= a or left >= b:
            g += 1
            continue
        # What the arc covers is no longer undecided.
        if left <= a - interval[g, UF]:
            interval[g, UF] = 0.0
        if right >= b + interval[g, UL]:
            interval[g, UL] = 0.0
        before = count
        count = _part(interval, g, count, max(a, left), min(b, right), 0.0)
        if count >= before:
            g += 1
    return count
