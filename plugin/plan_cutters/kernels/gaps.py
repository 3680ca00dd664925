"""Gaps of tilts at a rotation, and what a point or a triangle takes out of them.

A gap is a row: the tilts between which it lies, their cosines and sines, and how far its ends may be off. What passes a
gap passes all that is left of it; `docs/between_samples.md` has the argument.
"""

import numpy as np

from plan_cutters.kernels.arcs import point_arc
from plan_cutters.kernels.hit import _nearest, _swept_hit, stand, triangle_hit
from plan_cutters.kernels.jit import kernel

#: Gaps that one rotation may fall into. The row after the last counts what stays undecided and belongs to none.
GAPS = 16
#: Columns of a gap.
FIRST, LAST, CF, SF, CL, SL, UF, UL, COLUMNS = 0, 1, 2, 3, 4, 5, 6, 7, 8
#: By which an arc is widened, so that its ends are out of it, rad.
_HAIR = 1e-9
#: Triangles that reach no farther along the line of turning, in radii, see the rim as one line.
_FLAT = 0.03
#: Slabs that what lies next to the contact is cut into.
_SLABS = 8


@kernel
def _clip(source, count, target, a, b, level):  # type: ignore[no-untyped-def]
    """Keep the part of a polygon of rows (x, z, y) with `a x + b z >= level`."""
    kept = 0
    for i in range(count):
        j = i + 1 if i + 1 < count else 0
        here = a * source[i, 0] + b * source[i, 1] - level
        there = a * source[j, 0] + b * source[j, 1] - level
        if here >= 0.0:
            for k in range(3):
                target[kept, k] = source[i, k]
            kept += 1
        if (here > 0.0 and there < 0.0) or (here < 0.0 and there > 0.0):
            part = here / (here - there)
            for k in range(3):
                target[kept, k] = source[i, k] + part * (source[j, k] - source[i, k])
            kept += 1
    return kept


@kernel
def _side(polygon, count, cosine, sine, radius, shrunk, turned):  # type: ignore[no-untyped-def]
    """On which side of the cylinder at a tilt the shadow of a polygon of rows (x, z, y) lies: 1 front, -1 back, 0 neither.

    The front is where the contact is. 2: beside it, out of reach at every tilt. `turned` is scratch.
    """
    least, most = np.inf, -np.inf
    for i in range(count):
        x, z, y = polygon[i, 0], polygon[i, 1], polygon[i, 2]
        turned[i, 0], turned[i, 1], turned[i, 2] = cosine * z + sine * x, cosine * x - sine * z + radius, y
        least, most = min(least, y), max(most, y)
    if least >= shrunk or most <= -shrunk:
        return 2
    _, px, _, square = _nearest(turned, count)
    if square < shrunk * shrunk:
        return 0
    return 1 if px >= 0.0 else -1


@kernel
def _rim(y, radius, shrunk):  # type: ignore[no-untyped-def]
    """Tangent at y to the rim's distance from the line of turning, as (slope, value at 0): elsewhere the rim is farther."""
    y = max(-0.98 * shrunk, min(0.98 * shrunk, y))
    q = np.sqrt(shrunk * shrunk - y * y)
    slope = y / q
    return slope, radius - q - slope * y


@kernel
def _never(polygon, count, radius, shrunk):  # type: ignore[no-untyped-def]
    """Whether a polygon of rows (x, z, y) is out of reach at every tilt.

    So near the line of turning that the disk, which touches that line at the contact, has curved away. The room grows with
    the square of y: its tangent bounds it from below, and what is left of it is least at a corner.
    """
    low, high, middle = np.inf, -np.inf, 0.0
    for i in range(count):
        x, z, y = polygon[i, 0], polygon[i, 1], polygon[i, 2]
        low, high, middle = min(low, y), max(high, y), middle + y / count
        square = shrunk * shrunk - y * y
        if square > 0.0:
            room = radius - np.sqrt(square)
            if x * x + z * z > room * room:
                return False
    pieces = 1 if high - low < 0.1 * shrunk else _SLABS
    wide = (high - low) / pieces
    for piece in range(pieces):
        at = low + piece * wide
        slope, room = _rim(middle if pieces == 1 else at + 0.5 * wide, radius, shrunk)
        for i in range(count):
            j = i + 1 if i + 1 < count else 0
            yi, yj = polygon[i, 2], polygon[j, 2]
            if max(yi, yj) < at or min(yi, yj) > at + wide:
                continue
            first, last = 0.0, 1.0
            if pieces > 1 and yi != yj:
                u, v = (at - yi) / (yj - yi), (at + wide - yi) / (yj - yi)
                first, last = max(0.0, min(u, v)), min(1.0, max(u, v))
            for part in (first, last):
                x = polygon[i, 0] + part * (polygon[j, 0] - polygon[i, 0])
                z = polygon[i, 1] + part * (polygon[j, 1] - polygon[i, 1])
                gone = slope * (yi + part * (yj - yi)) + room
                if gone < 0.0 or x * x + z * z > gone * gone:
                    return False
    return True


@kernel
def _parts_pass(polygon, count, ca, sa, cb, sb, radius, shrunk, low, high):  # type: ignore[no-untyped-def]
    """`_boxes_pass` for a polygon, in two parts where need be: what the bottom sweeps over, and what it stays below."""
    middle = 0.0
    for k in range(count):
        middle += polygon[k, 2]
    slope, room = _rim(middle / count, radius, shrunk)
    upper, lower, under, never, behind, top = -np.inf, -np.inf, -np.inf, True, np.inf, True
    k = count - 1
    x, z, y = polygon[k, 0], polygon[k, 1], polygon[k, 2]
    last, last_front = cb * z + sb * x, sb * z - cb * x - slope * y - room
    for k in range(count):
        before_x, before_z, before_y = x, z, y
        x, z, y = polygon[k, 0], polygon[k, 1], polygon[k, 2]
        height, front = cb * z + sb * x, sb * z - cb * x - slope * y - room
        below = max(z - sa * (slope * y + room) - ca * low, z - sb * (slope * y + room) - cb * low)
        behind = min(behind, sa * z - ca * x + slope * y)
        top = top and height >= high
        if height >= 0.0:
            upper = max(upper, front)
        if height <= 0.0:
            lower = max(lower, below)
            gone = slope * y + room
            never = never and gone >= 0.0 and x * x + z * z <= gone * gone
        if (height > 0.0 and last < 0.0) or (height < 0.0 and last > 0.0):
            # Where the side of the polygon crosses from one part to the other.
            part = last / (last - height)
            cx, cz = before_x + part * (x - before_x), before_z + part * (z - before_z)
            cy = before_y + part * (y - before_y)
            upper = max(upper, last_front + part * (front - last_front))
            gone = slope * cy + room
            lower = max(lower, max(cz - sa * gone - ca * low, cz - sb * gone - cb * low))
            never = never and gone >= 0.0 and cx * cx + cz * cz <= gone * gone
        under = max(under, below)
        last, last_front = height, front
    if top or under <= 0.0 or behind >= 2.0 * radius - room:
        return True
    return upper <= 0.0 and (lower <= 0.0 or never)


@kernel
def _passes(corner, cf, sf, cl, sl, radius, shrunk, low, high, first, second):  # type: ignore[no-untyped-def]
    """Whether a triangle, rows (x, z, y) from the contact, stays out of the body at all tilts of a gap.

    With growing tilt a point of the part turns about the contact down and back in the tool's frame. So one that is
    below the bottom or behind the body where the gap begins stays so; one that is in front of it, and no lower than the
    contact, or above its top where the gap ends was so before. Each point must be one of these; the rest of the triangle
    is cut off in turn.
    """
    count = _clip(corner, 3, first, sf, cf, low * min(1.0, cf * min(cf + sf, cl + sl)))
    if count == 0 or _parts_pass(first, count, cf, sf, cl, sl, radius, shrunk, low, high):
        return True
    least, most = np.inf, -np.inf
    for k in range(count):
        least, most = min(least, first[k, 2]), max(most, first[k, 2])
    if most - least < _FLAT * radius:
        return False
    # Too large for one tangent to the rim.
    lower = _clip(first, count, second, -sl, -cl, 0.0)
    if lower == 0 or _never(second, lower, radius, shrunk):
        upper = _clip(first, count, second, sl, cl, 0.0)
        upper = _clip(second, upper, first, -sl, -cl, -high)
        return upper == 0 or _side(first, upper, cl, sl, radius, shrunk, second) > 0
    side = _side(first, count, cf, sf, radius, shrunk, second)
    return side == -1 or side == 2


@kernel
def _cuts(x, y, z, gap, count, radius, shrunk, low, high):  # type: ignore[no-untyped-def]
    """Whether a point is in the body at some tilt of some gap."""
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
def _first_in_the_way(vertex, i, p, n, f, t, a, b, sign, narrowest, radius, shrunk, low, high, scratch):  # type: ignore[no-untyped-def]
    """The first tilt, from a up or from b down (`sign`), at which a triangle is not shown to be clear; nan if none.

    A range is clear if the triangle misses the body, widened by what tilting within it can do. Others are halved.
    """
    body, polygon, spare, pieces, ranges = scratch
    ranges[0, 0], ranges[0, 1] = a, b
    top = 1
    while top > 0:
        top -= 1
        first, last = ranges[top, 0], ranges[top, 1]
        middle, half = 0.5 * (first + last), 0.5 * (last - first)
        stand(body, p, n, f, t, np.cos(middle), np.sin(middle), radius, shrunk, low, high)
        hit, _, _, _ = triangle_hit(vertex, i, body, half + 1e-12, polygon, spare)
        if not hit or not _swept_hit(vertex, i, body, half + 1e-12, polygon, spare, pieces):
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
def _in_the_way(vertex, i, p, n, f, t, tilt, radius, shrunk, low, high, scratch):  # type: ignore[no-untyped-def]
    """Whether a triangle reaches into the body at a tilt."""
    body, polygon, spare, _, _ = scratch
    stand(body, p, n, f, t, np.cos(tilt), np.sin(tilt), radius, shrunk, low, high)
    return triangle_hit(vertex, i, body, 0.0, polygon, spare)[0]


@kernel
def _shrink(corner, gap, g, sign, narrowest, radius, shrunk, low, high, first, second):  # type: ignore[no-untyped-def]
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
            good = _passes(corner, c, s, cb, sb, radius, shrunk, low, high, first, second)
        else:
            good = _passes(corner, ca, sa, c, s, radius, shrunk, low, high, first, second)
        if good:
            passed = move
        else:
            failed = move
    return passed, failed


@kernel
def _cut_gaps(  # type: ignore[no-untyped-def]
    vertex, i, p, n, f, t, corner, gap, count, narrowest, radius, shrunk, low, high, first, second, scratch
):  # fmt: skip
    """Take the tilts at which a triangle is in the way out of the gaps; (count of gaps, whether any was cut)."""
    cut = False
    # What its corners alone forbid is known in closed form, and mostly all that it does.
    for k in range(3):
        x, z, y = corner[k, 0], corner[k, 1], corner[k, 2]
        if _cuts(x, y, z, gap, count, radius, shrunk, low, high):
            left, right = point_arc(z, x + radius, y, 0.0, radius, shrunk, low, high)
            count = _take(gap, count, left, right)
            cut = True
    g = 0
    while g < count:
        a, b, ca, sa, cb, sb = gap[g, FIRST], gap[g, LAST], gap[g, CF], gap[g, SF], gap[g, CL], gap[g, SL]
        if _passes(corner, ca, sa, cb, sb, radius, shrunk, low, high, first, second):
            g += 1
            continue
        # A side or the middle of the triangle sticks out further than its corners: mostly by a little, at one end.
        # What was undecided at its ends no longer is where this triangle is in the way.
        for column, tilt, off in ((UF, a, -gap[g, UF]), (UL, b, gap[g, UL])):
            if (
                off != 0.0
                and _in_the_way(vertex, i, p, n, f, t, tilt, radius, shrunk, low, high, scratch)
                and _in_the_way(vertex, i, p, n, f, t, tilt + off, radius, shrunk, low, high, scratch)
            ):
                gap[g, column] = 0.0
        up, up_failed = _shrink(corner, gap, g, 1.0, narrowest, radius, shrunk, low, high, first, second)
        if up <= 2.0 * narrowest and gap[g, UF] + up <= 3.0 * narrowest:
            _begin(gap, g, a + up, gap[g, UF] + up)
            cut = True
            continue
        down, down_failed = _shrink(corner, gap, g, -1.0, narrowest, radius, shrunk, low, high, first, second)
        if down <= 2.0 * narrowest and gap[g, UL] + down <= 3.0 * narrowest:
            _end(gap, g, b - down, gap[g, UL] + down)
            cut = True
            continue
        left, right, unsure = max(a, b - down), min(b, a + up), narrowest
        if left > right or not (
            _in_the_way(vertex, i, p, n, f, t, max(a, b - down_failed), radius, shrunk, low, high, scratch)
            and _in_the_way(vertex, i, p, n, f, t, min(b, a + up_failed), radius, shrunk, low, high, scratch)
        ):
            # Not known to be in the way right up to there: looked at closely.
            start, end = (left, right) if left <= right else (a, b)
            unsure = 2.0 * narrowest
            left = _first_in_the_way(
                vertex, i, p, n, f, t, start, end, 1.0, narrowest, radius, shrunk, low, high, scratch
            )
            if np.isnan(left):
                g += 1
                continue
            right = _first_in_the_way(
                vertex, i, p, n, f, t, left, end, -1.0, narrowest, radius, shrunk, low, high, scratch
            )
            right = left if np.isnan(right) else right
        cut = True
        before = count
        count = _part(gap, g, count, left, right, unsure)
        if count >= before:
            g += 1
    return count, cut
