"""Gaps of tilts at a rotation, and what an arc takes out of them.

A gap is a row: the tilts between which it lies, their cosines and sines, and how far its ends may be off. What passes a
gap passes all that is left of it; `docs/between_samples.md` has the argument.
"""

import numpy as np

from plan_cutters.kernels.jit import kernel

#: Gaps that one rotation may fall into. The row after the last counts what stays undecided and belongs to none.
GAPS = 16
#: Columns of a gap.
FIRST, LAST, CF, SF, CL, SL, UF, UL, COLUMNS = 0, 1, 2, 3, 4, 5, 6, 7, 8
#: By which an arc is widened, so that its ends are out of it, rad.
_HAIR = 1e-9


@kernel
def _cuts(x, y, z, gap, count, tool):
    """Whether a point is in the body at some tilt of some gap."""
    radius, shrunk, low, high, _ = tool
    square = shrunk * shrunk - y * y
    if square <= 0.0 or z <= low:
        return False
    half = np.sqrt(square)
    workspace, far, away = radius - half, radius + half, x * x + z * z
    if away <= workspace * workspace + low * low or away >= far * far + high * high:
        return False
    for g in range(count):
        top = gap[g, CF] * z + gap[g, SF] * x
        if top <= 0.0 or (top <= low and gap[g, CF] * x <= gap[g, SF] * z):
            continue
        if gap[g, SF] * z - gap[g, CF] * x >= far:
            continue
        bottom = gap[g, CL] * z + gap[g, SL] * x
        if bottom >= high or (bottom >= 0.0 and gap[g, SL] * z - gap[g, CL] * x <= workspace):
            continue
        return True
    return False


@kernel
def _begin(gap, g, tilt, unsure):
    gap[g, FIRST], gap[g, CF], gap[g, SF], gap[g, UF] = tilt, np.cos(tilt), np.sin(tilt), unsure


@kernel
def _end(gap, g, tilt, unsure):
    gap[g, LAST], gap[g, CL], gap[g, SL], gap[g, UL] = tilt, np.cos(tilt), np.sin(tilt), unsure


@kernel
def _drop(gap, g, count):
    """Take a gap out, its bands with it; the new count."""
    for k in range(COLUMNS):
        gap[g, k] = gap[count - 1, k]
    return count - 1


@kernel
def _part(gap, g, count, left, right, unsure):
    """Take the tilts between `left` and `right`, within a gap, out of it; the new count.

    Its new ends get the band `unsure`. Bands that are cut off stay undecided, as does the narrower part if there is no room
    for both: they are counted in the row after the last gap.
    """
    a, b = gap[g, FIRST], gap[g, LAST]
    if left > a and right < b and count == GAPS:
        if left - a >= b - right:
            gap[GAPS, UL] += b - right
            right = b
        else:
            gap[GAPS, UF] += left - a
            left = a
    if left > a and right < b:
        for k in range(COLUMNS):
            gap[count, k] = gap[g, k]
        _begin(gap, count, right, unsure)
        _end(gap, g, left, unsure)
        return count + 1
    if right < b:
        gap[GAPS, UF] += gap[g, UF]
        _begin(gap, g, right, unsure)
    elif left > a:
        gap[GAPS, UL] += gap[g, UL]
        _end(gap, g, left, unsure)
    else:
        gap[GAPS, UF] += gap[g, UF] + gap[g, UL] + min(b - a, unsure)
        return _drop(gap, g, count)
    return count


@kernel
def _take(gap, count, left, right):
    """Take an arc that a point forbids out of the gaps; the new count."""
    left, right = left - _HAIR, right + _HAIR
    if right - left <= 2.0 * _HAIR:
        return count
    g = 0
    while g < count:
        a, b = gap[g, FIRST], gap[g, LAST]
        if right <= a or left >= b:
            g += 1
            continue
        # What the arc covers is no longer undecided.
        if left <= a - gap[g, UF]:
            gap[g, UF] = 0.0
        if right >= b + gap[g, UL]:
            gap[g, UL] = 0.0
        before = count
        count = _part(gap, g, count, max(a, left), min(b, right), 0.0)
        if count >= before:
            g += 1
    return count
