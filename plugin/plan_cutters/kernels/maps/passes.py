"""Does a triangle, or do eight boxes or triangles, stay out of the body of a plain cylinder at all tilts of an interval?

The sides are those of lemmas M1 to M3 of `docs/proofs.md`. A triangle's polygon has rows (x, y, z) from the contact.
Eight at a time go without a branch, so that the compiler uses the lanes of the processor.

An interval of tilts at a rotation is a row: the tilts between which it lies, their cosines and sines, and how far its ends may
be off. What passes an interval passes all that is left of it.
"""

import numpy as np

from plan_cutters.kernels.jit import kernel
from plan_cutters.kernels.tool.pieces import nearest

#: Intervals that one rotation may fall into. The row after the last counts what stays undecided and belongs to none.
INTERVALS = 16
#: Columns of an interval: its tilts, their cosines and sines, how far each may be off.
FIRST, LAST, CF, SF, CL, SL, UF, UL, COLUMNS = 0, 1, 2, 3, 4, 5, 6, 7, 8
#: By which an arc is widened, so that its ends are out of it, rad.
_HAIR = 1e-9


@kernel
def _cuts(x, y, z, interval, count, tool):
    """Tell whether a point is in the body at some tilt of some interval: none of the sides of lemma M1 parts them."""
    radius, shrunk, low, high = tool
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
        # The interval goes, its bands with it.
        for k in range(COLUMNS):
            interval[g, k] = interval[count - 1, k]
        return count - 1
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


#: Triangles that reach no farther along the line of turning, in radii, see the rim as one line.
_FLAT = 0.03
#: Slabs that what lies next to the contact is cut into.
_SLABS = 8


@kernel
def _clip(source, count, target, a, b, level):
    """Keep the part of a polygon of rows (x, y, z) with `a x + b z >= level`."""
    written = 0
    for i in range(count):
        j = i + 1 if i + 1 < count else 0
        here = a * source[i, 0] + b * source[i, 2] - level
        there = a * source[j, 0] + b * source[j, 2] - level
        if here >= 0.0:
            for k in range(3):
                target[written, k] = source[i, k]
            written += 1
        if (here > 0.0 and there < 0.0) or (here < 0.0 and there > 0.0):
            part = here / (here - there)
            for k in range(3):
                target[written, k] = source[i, k] + part * (source[j, k] - source[i, k])
            written += 1
    return written


@kernel
def _side(polygon, count, cosine, sine, radius, shrunk, turned):
    """On which side of the cylinder at a tilt the shadow of a polygon of rows (x, y, z) lies: 1 front, -1 back, 0 neither.

    The front is where the contact is. 2: beside it, out of reach at every tilt. `turned` is scratch.
    """
    least, most = np.inf, -np.inf
    for i in range(count):
        x, y, z = polygon[i, 0], polygon[i, 1], polygon[i, 2]
        turned[i, 0], turned[i, 1], turned[i, 2] = cosine * z + sine * x, cosine * x - sine * z + radius, y
        least, most = min(least, y), max(most, y)
    if least >= shrunk or most <= -shrunk:
        return 2
    _, px, _, square = nearest(turned, count)
    if square < shrunk * shrunk:
        return 0
    return 1 if px >= 0.0 else -1


@kernel
def _rim(y, radius, shrunk):
    """Tangent at y to the rim's distance from the line of turning, as (slope, value at 0): elsewhere the rim is farther."""
    y = max(-0.98 * shrunk, min(0.98 * shrunk, y))
    q = np.sqrt(shrunk * shrunk - y * y)
    slope = y / q
    return slope, radius - q - slope * y


@kernel
def _facing(nx, nz, ca, sa, cb, sb):
    """A direction (x, z), up or down as it may be, turned to where the body is at all tilts of an interval.

    It then leans from the axis to the front or to the back by no more than 90 deg at any of them.
    """
    if sa * nx + ca * nz < 0.0:
        nx, nz = -nx, -nz
    if sa * nx + ca * nz <= 0.0:
        nx, nz = ca, -sa
    if sb * nx + cb * nz <= 0.0:
        nx, nz = -cb, sb
    return nx, nz


@kernel
def _from_plane(nx, nz, c, s, tool):
    """How far along a direction (x, z) the body begins at a tilt: (distance, and what each mm of the rim's distance adds)."""
    up, out = nx * s + nz * c, nz * s - nx * c
    return tool.low * up + 2.0 * tool.radius * min(0.0, out), abs(out)


@kernel
def _plane_passes(corner, ca, sa, cb, sb, tool):
    """Tell whether a plane, nearly that of a triangle, parts it from the body at all tilts of an interval (lemma M1.5)."""
    x0, y0, z0 = corner[0, 0], corner[0, 1], corner[0, 2]
    x1, y1, z1 = corner[1, 0], corner[1, 1], corner[1, 2]
    x2, y2, z2 = corner[2, 0], corner[2, 1], corner[2, 2]
    slope, rim = _rim((y0 + y1 + y2) / 3.0, tool.radius, tool.shrunk)
    nx, nz = (y1 - y0) * (z2 - z0) - (z1 - z0) * (y2 - y0), (x1 - x0) * (y2 - y0) - (y1 - y0) * (x2 - x0)
    nx, nz = _facing(nx, nz, ca, sa, cb, sb)
    h0, h1, h2 = nx * x0 + nz * z0, nx * x1 + nz * z1, nx * x2 + nz * z2
    for c, s in ((ca, sa), (cb, sb)):
        begins, share = _from_plane(nx, nz, c, s, tool)
        d = share * slope
        if max(h0 - d * y0, max(h1 - d * y1, h2 - d * y2)) > begins + share * rim:
            return False
    return True


@kernel
def _never(polygon, count, radius, shrunk):
    """Tell whether a polygon of rows (x, y, z) is out of reach at every tilt (lemma M1.8).

    So near the line of turning that the disk, which touches that line at the contact, has curved away. Its distance grows with
    the square of y: its tangent bounds it from below, and what is left of it is least at a corner.
    """
    low, high, middle = np.inf, -np.inf, 0.0
    for i in range(count):
        x, y, z = polygon[i, 0], polygon[i, 1], polygon[i, 2]
        low, high, middle = min(low, y), max(high, y), middle + y / count
        square = shrunk * shrunk - y * y
        if square > 0.0:
            rim = radius - np.sqrt(square)
            if x * x + z * z > rim * rim:
                return False
    pieces = 1 if high - low < 0.1 * shrunk else _SLABS
    wide = (high - low) / pieces
    for piece in range(pieces):
        at = low + piece * wide
        slope, rim = _rim(middle if pieces == 1 else at + 0.5 * wide, radius, shrunk)
        for i in range(count):
            j = i + 1 if i + 1 < count else 0
            yi, yj = polygon[i, 1], polygon[j, 1]
            if max(yi, yj) < at or min(yi, yj) > at + wide:
                continue
            first, last = 0.0, 1.0
            if pieces > 1 and yi != yj:
                u, v = (at - yi) / (yj - yi), (at + wide - yi) / (yj - yi)
                first, last = max(0.0, min(u, v)), min(1.0, max(u, v))
            for part in (first, last):
                x = polygon[i, 0] + part * (polygon[j, 0] - polygon[i, 0])
                z = polygon[i, 2] + part * (polygon[j, 2] - polygon[i, 2])
                gone = slope * (yi + part * (yj - yi)) + rim
                if gone < 0.0 or x * x + z * z > gone * gone:
                    return False
    return True


@kernel
def _parts_pass(polygon, count, ca, sa, cb, sb, tool):
    """Test a polygon like `_boxes_pass`, if necessary in two parts: what the bottom sweeps over, and the rest (lemma M3)."""
    radius, shrunk, low, high = tool
    middle = 0.0
    for k in range(count):
        middle += polygon[k, 1]
    slope, rim = _rim(middle / count, radius, shrunk)
    upper, lower, under, never, behind, top = -np.inf, -np.inf, -np.inf, True, np.inf, True
    k = count - 1
    x, y, z = polygon[k, 0], polygon[k, 1], polygon[k, 2]
    last, last_front = cb * z + sb * x, sb * z - cb * x - slope * y - rim
    for k in range(count):
        before_x, before_y, before_z = x, y, z
        x, y, z = polygon[k, 0], polygon[k, 1], polygon[k, 2]
        height, front = cb * z + sb * x, sb * z - cb * x - slope * y - rim
        below = max(z - sa * (slope * y + rim) - ca * low, z - sb * (slope * y + rim) - cb * low)
        behind = min(behind, sa * z - ca * x + slope * y)
        top = top and height >= high
        if height >= 0.0:
            upper = max(upper, front)
        if height <= 0.0:
            lower = max(lower, below)
            gone = slope * y + rim
            never = never and gone >= 0.0 and x * x + z * z <= gone * gone
        if (height > 0.0 and last < 0.0) or (height < 0.0 and last > 0.0):
            # Where the side of the polygon crosses from one part to the other.
            part = last / (last - height)
            cx, cz = before_x + part * (x - before_x), before_z + part * (z - before_z)
            cy = before_y + part * (y - before_y)
            upper = max(upper, last_front + part * (front - last_front))
            gone = slope * cy + rim
            lower = max(lower, max(cz - sa * gone - ca * low, cz - sb * gone - cb * low))
            never = never and gone >= 0.0 and cx * cx + cz * cz <= gone * gone
        under = max(under, below)
        last, last_front = height, front
    if top or under <= 0.0 or behind >= 2.0 * radius - rim:
        return True
    return upper <= 0.0 and (lower <= 0.0 or never)


@kernel
def _passes(corner, cf, sf, cl, sl, tool, first, second):
    """Whether a triangle, rows (x, y, z) from the contact, stays out of the body at all tilts of an interval.

    With growing tilt a point of the part turns about the contact down and back in the tool's frame. So one that is
    below the bottom or behind the body where the interval begins stays so; one that is in front of it, and no lower than the
    contact, or above its top where the interval ends was so before. Each point must be one of these; the rest of the triangle
    is cut off in turn.
    """
    radius, shrunk, low, high = tool
    if _plane_passes(corner, cf, sf, cl, sl, tool):
        return True
    count = _clip(corner, 3, first, sf, cf, low * min(1.0, cf * min(cf + sf, cl + sl)))
    if count == 0 or _parts_pass(first, count, cf, sf, cl, sl, tool):
        return True
    least, most = np.inf, -np.inf
    for k in range(count):
        least, most = min(least, first[k, 1]), max(most, first[k, 1])
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
def _boxes_pass(view, block, cosine, sine, interval, count, tool, margin):
    """Write a margin for each box of a block: 0 or more only if none of its points enters the body in any interval.

    What parts a box from the body is, as for a point (lemmas M1 and M2): beside the cylinder; below its bottom where the interval
    begins; in front of the rim where it ends; below the rim at both, seen along the normal or across the box's thin side; above
    the top where it ends; behind where it begins. The rim is seen as a line, its tangent half way from the box's middle to its
    side next to the axis.
    """
    radius, shrunk, low, high = tool
    for lane in range(len(margin)):
        margin[lane] = np.inf
    for g in range(count):
        ca, sa, cb, sb = interval[g, CF], interval[g, SF], interval[g, CL], interval[g, SL]
        level = low * min(1.0, ca * min(ca + sa, cb + sb))
        for lane in range(len(margin)):
            x = cosine * view[block, 0, lane] + sine * view[block, 1, lane]
            y = cosine * view[block, 1, lane] - sine * view[block, 0, lane]
            z = view[block, 2, lane]
            f0 = cosine * view[block, 3, lane] + sine * view[block, 6, lane]
            f1 = cosine * view[block, 4, lane] + sine * view[block, 7, lane]
            f2 = cosine * view[block, 5, lane] + sine * view[block, 8, lane]
            t0 = cosine * view[block, 6, lane] - sine * view[block, 3, lane]
            t1 = cosine * view[block, 7, lane] - sine * view[block, 4, lane]
            t2 = cosine * view[block, 8, lane] - sine * view[block, 5, lane]
            z0, z1, z2 = view[block, 9, lane], view[block, 10, lane], view[block, 11, lane]
            wide = abs(t0) + abs(t1) + abs(t2)
            slope, rim = _rim(y - max(-0.5 * wide, min(0.5 * wide, y)), radius, shrunk)
            rim += slope * y
            top = ca * z + sa * x + abs(ca * z0 + sa * f0) + abs(ca * z1 + sa * f1) + abs(ca * z2 + sa * f2)
            bottom = cb * z + sb * x - abs(cb * z0 + sb * f0) - abs(cb * z1 + sb * f1) - abs(cb * z2 + sb * f2)
            front = sb * z - cb * x + abs(sb * z0 - cb * f0 - slope * t0)
            front += abs(sb * z1 - cb * f1 - slope * t1) + abs(sb * z2 - cb * f2 - slope * t2)
            behind = sa * z - ca * x - abs(sa * z0 - ca * f0 + slope * t0)
            behind -= abs(sa * z1 - ca * f1 + slope * t1) + abs(sa * z2 - ca * f2 + slope * t2)
            d = sa * slope
            under = ca * low + sa * rim - z - abs(z0 - d * t0) - abs(z1 - d * t1) - abs(z2 - d * t2)
            d = sb * slope
            under = min(under, cb * low + sb * rim - z - abs(z0 - d * t0) - abs(z1 - d * t1) - abs(z2 - d * t2))
            nx, nz = _facing(t0 * z1 - z0 * t1, f0 * t1 - t0 * f1, ca, sa, cb, sb)
            over = nx * x + nz * z
            begins, share = _from_plane(nx, nz, ca, sa, tool)
            d = share * slope
            own = begins + share * rim - over - abs(nx * f0 + nz * z0 - d * t0)
            own -= abs(nx * f1 + nz * z1 - d * t1) + abs(nx * f2 + nz * z2 - d * t2)
            begins, share = _from_plane(nx, nz, cb, sb, tool)
            d = share * slope
            other = begins + share * rim - over - abs(nx * f0 + nz * z0 - d * t0)
            other -= abs(nx * f1 + nz * z1 - d * t1) + abs(nx * f2 + nz * z2 - d * t2)
            under = max(under, min(own, other))
            start = x - abs(f0) - abs(f1) - abs(f2)
            lateral = abs(y) - wide
            best = max(lateral - shrunk, level - top)
            best = max(best, min(rim - front, max(start, max(low - top, bottom))))
            best = max(best, under)
            best = max(best, bottom - high)
            best = max(best, behind - 2.0 * radius + rim)
            margin[lane] = min(margin[lane], best)


@kernel
def _triangles_pass(seen, cosine, sine, interval, count, tool, margin):
    """`_boxes_pass` for the triangles of a leaf."""
    radius, shrunk, low, high = tool
    for lane in range(len(margin)):
        margin[lane] = np.inf
    for g in range(count):
        ca, sa, cb, sb = interval[g, CF], interval[g, SF], interval[g, CL], interval[g, SL]
        level = low * min(1.0, ca * min(ca + sa, cb + sb))
        for lane in range(len(margin)):
            x0 = cosine * seen[0, lane] + sine * seen[1, lane]
            y0 = cosine * seen[1, lane] - sine * seen[0, lane]
            z0 = seen[2, lane]
            x1 = cosine * seen[3, lane] + sine * seen[4, lane]
            y1 = cosine * seen[4, lane] - sine * seen[3, lane]
            z1 = seen[5, lane]
            x2 = cosine * seen[6, lane] + sine * seen[7, lane]
            y2 = cosine * seen[7, lane] - sine * seen[6, lane]
            z2 = seen[8, lane]
            slope, rim = _rim((y0 + y1 + y2) / 3.0, radius, shrunk)
            highest = max(z0, max(z1, z2))
            top = max(ca * z0 + sa * x0, max(ca * z1 + sa * x1, ca * z2 + sa * x2))
            bottom = min(cb * z0 + sb * x0, min(cb * z1 + sb * x1, cb * z2 + sb * x2))
            front = max(sb * z0 - cb * x0 - slope * y0, max(sb * z1 - cb * x1 - slope * y1, sb * z2 - cb * x2 - slope * y2))
            behind = min(sa * z0 - ca * x0 + slope * y0, min(sa * z1 - ca * x1 + slope * y1, sa * z2 - ca * x2 + slope * y2))
            d = sa * slope
            under = ca * low + sa * rim - max(z0 - d * y0, max(z1 - d * y1, z2 - d * y2))
            d = sb * slope
            under = min(under, cb * low + sb * rim - max(z0 - d * y0, max(z1 - d * y1, z2 - d * y2)))
            nx, nz = (y1 - y0) * (z2 - z0) - (z1 - z0) * (y2 - y0), (x1 - x0) * (y2 - y0) - (y1 - y0) * (x2 - x0)
            nx, nz = _facing(nx, nz, ca, sa, cb, sb)
            h0, h1, h2 = nx * x0 + nz * z0, nx * x1 + nz * z1, nx * x2 + nz * z2
            begins, share = _from_plane(nx, nz, ca, sa, tool)
            d = share * slope
            own = begins + share * rim - max(h0 - d * y0, max(h1 - d * y1, h2 - d * y2))
            begins, share = _from_plane(nx, nz, cb, sb, tool)
            d = share * slope
            own = min(own, begins + share * rim - max(h0 - d * y0, max(h1 - d * y1, h2 - d * y2)))
            under = max(under, own)
            lateral = max(min(y0, min(y1, y2)), -max(y0, max(y1, y2)))
            best = max(lateral - shrunk, low - highest)
            best = max(best, level - top)
            best = max(best, min(rim - front, max(min(x0, min(x1, x2)), max(low - top, bottom))))
            best = max(best, under)
            best = max(best, bottom - high)
            best = max(best, behind - 2.0 * radius + rim)
            margin[lane] = min(margin[lane], best)
