"""Gaps of tilts at a rotation, and what a point or a triangle takes out of them.

A gap is a row: the tilts between which it lies, their cosines and sines, and how far its ends may be off. What passes a
gap passes all that is left of it; `docs/between_samples.md` has the argument.
"""

from typing import Any, NamedTuple

import numpy as np

from plan_cutters.kernels.arcs import point_arc
from plan_cutters.kernels.hit import _swept_hit, stand, triangle_hit
from plan_cutters.kernels.jit import kernel
from plan_cutters.kernels.passes import _passes
from plan_cutters.kernels.rows import Scratch

#: Gaps that one rotation may fall into. The row after the last counts what stays undecided and belongs to none.
GAPS = 16
#: Columns of a gap.
FIRST, LAST, CF, SF, CL, SL, UF, UL, COLUMNS = 0, 1, 2, 3, 4, 5, 6, 7, 8
#: By which an arc is widened, so that its ends are out of it, rad.
_HAIR = 1e-9


class Room(NamedTuple):
    """Room to work in: corner (3, 3), first and second (8, 3) polygons, a body, ranges (64, 2) of tilts."""

    corner: Any
    first: Any
    second: Any
    body: Any
    ranges: Any
    scratch: Scratch


@kernel
def _cuts(x, y, z, gap, count, tool):  # type: ignore[no-untyped-def]
    """Whether a point is in the body at some tilt of some gap."""
    radius, shrunk, low, high, _ = tool
    square = shrunk * shrunk - y * y
    if square <= 0.0 or z <= low:
        return False
    half = np.sqrt(square)
    room, far, away = radius - half, radius + half, x * x + z * z
    if away <= room * room + low * low or away >= far * far + high * high:
        return False
    for g in range(count):
        top = gap[g, CF] * z + gap[g, SF] * x
        if top <= 0.0 or (top <= low and gap[g, CF] * x <= gap[g, SF] * z):
            continue
        if gap[g, SF] * z - gap[g, CF] * x >= far:
            continue
        bottom = gap[g, CL] * z + gap[g, SL] * x
        if bottom >= high or (bottom >= 0.0 and gap[g, SL] * z - gap[g, CL] * x <= room):
            continue
        return True
    return False


@kernel
def _first_in_the_way(vertex, i, frame, a, b, sign, narrowest, tool, room):  # type: ignore[no-untyped-def]
    """The first tilt, from a up or from b down (`sign`), at which a triangle is not shown to be clear; nan if none.

    A range is clear if the triangle misses the body, widened by what tilting within it can do. Others are halved.
    """
    body, ranges, scratch = room.body, room.ranges, room.scratch
    ranges[0, 0], ranges[0, 1] = a, b
    top = 1
    while top > 0:
        top -= 1
        first, last = ranges[top, 0], ranges[top, 1]
        middle, half = 0.5 * (first + last), 0.5 * (last - first)
        stand(body, frame, np.cos(middle), np.sin(middle), tool.radius, 0.0)
        which, _, _, _ = triangle_hit(vertex, i, body, tool.piece, 1, half + 1e-12, scratch)
        if which < 0 or not _swept_hit(vertex, i, body, tool.piece, 1, half + 1e-12, scratch):
            continue
        if last - first <= narrowest or top + 2 > len(ranges):
            return first if sign > 0.0 else last
        near, far = (top + 1, top) if sign > 0.0 else (top, top + 1)
        ranges[near, 0], ranges[near, 1] = first, middle
        ranges[far, 0], ranges[far, 1] = middle, last
        top += 2
    return np.nan


@kernel
def _begin(gap, g, tilt, unsure):  # type: ignore[no-untyped-def]
    gap[g, FIRST], gap[g, CF], gap[g, SF], gap[g, UF] = tilt, np.cos(tilt), np.sin(tilt), unsure


@kernel
def _end(gap, g, tilt, unsure):  # type: ignore[no-untyped-def]
    gap[g, LAST], gap[g, CL], gap[g, SL], gap[g, UL] = tilt, np.cos(tilt), np.sin(tilt), unsure


@kernel
def _drop(gap, g, count):  # type: ignore[no-untyped-def]
    """Take a gap out, its bands with it; the new count."""
    for k in range(COLUMNS):
        gap[g, k] = gap[count - 1, k]
    return count - 1


@kernel
def _part(gap, g, count, left, right, unsure):  # type: ignore[no-untyped-def]
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
def _take(gap, count, left, right):  # type: ignore[no-untyped-def]
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


@kernel
def _in_the_way(vertex, i, frame, tilt, tool, room):  # type: ignore[no-untyped-def]
    """Whether a triangle reaches into the body at a tilt."""
    stand(room.body, frame, np.cos(tilt), np.sin(tilt), tool.radius, 0.0)
    return triangle_hit(vertex, i, room.body, tool.piece, 1, 0.0, room.scratch)[0] >= 0


@kernel
def _shrink(corner, gap, g, sign, narrowest, tool, first, second):  # type: ignore[no-untyped-def]
    """By how much a gap must shrink from its first tilt up (`sign` 1) or its last down for a triangle to pass.

    To `narrowest`; (by how much, a little less by which it did not pass); infinity if nothing wider is left.
    """
    ca, sa, cb, sb = gap[g, CF], gap[g, SF], gap[g, CL], gap[g, SL]
    width = gap[g, LAST] - gap[g, FIRST]
    passed, failed, move = np.inf, 0.0, narrowest
    while passed - failed > narrowest:
        if passed < np.inf:
            move = 0.5 * (passed + failed)
        elif failed > 0.0:
            move = min(2.0 * failed, width - narrowest)
        if move <= failed or move >= width:
            return np.inf, width
        end = gap[g, FIRST] + move if sign > 0.0 else gap[g, LAST] - move
        c, s = np.cos(end), np.sin(end)
        if sign > 0.0:
            good = _passes(corner, c, s, cb, sb, tool, first, second)
        else:
            good = _passes(corner, ca, sa, c, s, tool, first, second)
        if good:
            passed = move
        else:
            failed = move
    return passed, failed


@kernel
def _cut_gaps(vertex, i, frame, gap, count, narrowest, tool, room):  # type: ignore[no-untyped-def]
    """Take the tilts at which a triangle is in the way out of the gaps; (count of gaps, whether any was cut).

    The triangle is in `room.corner` too, as rows (x, z, y) from the contact.
    """
    radius, shrunk, low, high, _ = tool
    corner, first, second, cut = room.corner, room.first, room.second, False
    # What its corners alone forbid is known in closed form, and mostly all that it does.
    for k in range(3):
        x, z, y = corner[k, 0], corner[k, 1], corner[k, 2]
        if _cuts(x, y, z, gap, count, tool):
            left, right = point_arc(z, x + radius, y, 0.0, radius, shrunk, low, high)
            count = _take(gap, count, left, right)
            cut = True
    g = 0
    while g < count:
        a, b, ca, sa, cb, sb = gap[g, FIRST], gap[g, LAST], gap[g, CF], gap[g, SF], gap[g, CL], gap[g, SL]
        if _passes(corner, ca, sa, cb, sb, tool, first, second):
            g += 1
            continue
        # A side or the middle of the triangle sticks out further than its corners: mostly by a little, at one end.
        at_first, at_last = _in_the_way(vertex, i, frame, a, tool, room), _in_the_way(vertex, i, frame, b, tool, room)
        # What was undecided at its ends no longer is where this triangle is in the way.
        if at_first and gap[g, UF] > 0.0 and _in_the_way(vertex, i, frame, a - gap[g, UF], tool, room):
            gap[g, UF] = 0.0
        if at_last and gap[g, UL] > 0.0 and _in_the_way(vertex, i, frame, b + gap[g, UL], tool, room):
            gap[g, UL] = 0.0
        # From an end at which it is not in the way nothing is gained if it is at the other.
        up, up_failed, down, down_failed = np.inf, b - a, np.inf, b - a
        if not at_last:
            up, up_failed = _shrink(corner, gap, g, 1.0, narrowest, tool, first, second)
        if up <= 2.0 * narrowest and gap[g, UF] + up <= 3.0 * narrowest:
            _begin(gap, g, a + up, gap[g, UF] + up)
            cut = True
            continue
        if not at_first:
            down, down_failed = _shrink(corner, gap, g, -1.0, narrowest, tool, first, second)
        if down <= 2.0 * narrowest and gap[g, UL] + down <= 3.0 * narrowest:
            _end(gap, g, b - down, gap[g, UL] + down)
            cut = True
            continue
        left, right, unsure = max(a, b - down), min(b, a + up), narrowest
        if left > right or not (
            _in_the_way(vertex, i, frame, max(a, b - down_failed), tool, room)
            and _in_the_way(vertex, i, frame, min(b, a + up_failed), tool, room)
        ):
            # Not known to be in the way right up to there: looked at closely.
            start, end = (left, right) if left <= right else (a, b)
            unsure = 2.0 * narrowest
            left = _first_in_the_way(vertex, i, frame, start, end, 1.0, narrowest, tool, room)
            if np.isnan(left):
                g += 1
                continue
            right = _first_in_the_way(vertex, i, frame, left, end, -1.0, narrowest, tool, room)
            right = left if np.isnan(right) else right
        cut = True
        before = count
        count = _part(gap, g, count, left, right, unsure)
        if count >= before:
            g += 1
    return count, cut
