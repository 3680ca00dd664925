"""Free tilts of samples at all rotations, with certified ends, in one walk of the tree a rotation.

A gap of tilts is taken through the tree and only shrinks: what passes it passes all that is left of it. Boxes and
triangles are looked at eight at a time without a branch, so that the compiler uses the lanes of the processor, and as seen
from the contact: what rises nowhere above the tangent plane is out of reach at every posture and left out for all
rotations. A box in the way is first asked for one of its points, whose arc is known in closed form: so gaps are nearly what
they will be before any triangle is looked at. `docs/between_samples.md` has the argument.
"""

import numpy as np

from plan_cutters.kernels.arcs import axis_arcs, local_gouge, point_arc
from plan_cutters.kernels.hit import BODY, _nearest, _swept_hit, cross, dot, lean_frame, stand, triangle_hit
from plan_cutters.kernels.jit import entry, kernel
from plan_cutters.kernels.search import remove

#: Boxes and triangles looked at together.
LANES = 8
#: Blocks of boxes kept as seen from one contact, and blocks that may wait to be looked at.
_SEEN, _QUEUE = 1 << 11, 1 << 13
#: Leaves of triangles kept so; one more for others, one for the triangles that cut gaps last and are tried first.
_LEAVES = 1 << 11
#: What is known of the boxes in a block below another: not looked at yet, none rises above the tangent plane.
_UNSEEN, _NONE = -1, -2
#: Gaps that one rotation may fall into.
_GAPS = 16
#: By which an arc is widened, so that its ends are out of it, rad.
_HAIR = 1e-9
#: Triangles that reach no farther along the line of turning, in radii, see the rim as one line.
_FLAT = 0.03
#: Slabs that what lies next to the contact is cut into.
_SLABS = 8
#: Columns of a gap: the tilts between which it lies, their cosines and sines, and how far its ends may be off.
_FIRST, _LAST, _CF, _SF, _CL, _SL, _UF, _UL, _COLUMNS = 0, 1, 2, 3, 4, 5, 6, 7, 8


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
        top = gap[g, _CF] * z + gap[g, _SF] * x
        if top <= 0.0 or (top <= low and gap[g, _CF] * x <= gap[g, _SF] * z):
            continue
        if gap[g, _SF] * z - gap[g, _CF] * x >= far:
            continue
        bottom = gap[g, _CL] * z + gap[g, _SL] * x
        if bottom >= high or (bottom >= 0.0 and gap[g, _SL] * z - gap[g, _CL] * x <= room):
            continue
        return True
    return False


@entry
def wide_tree(vertex, box, depth):  # type: ignore[no-untyped-def]
    """Arrange every third level of a tree for looking at eight boxes at a time.

    Parameters
    ----------
    vertex, box, depth
        Triangles in tree order and the tree.

    Returns
    -------
    blocks : (k, 15, LANES) float64
        Of the boxes of a block, one a lane: centre, three half sides, a corner of a triangle in it. Level by level; a
        block holds the boxes three levels below one, the first block those of the first level, lanes left over far below.
    offset : (levels + 1,) int64
        First block of each level.
    bottom : int
        Level of the tree that the last blocks hold: no box there has more than LANES triangles.
    """
    bottom = depth
    while bottom > 0 and (len(vertex) + (1 << (bottom - 1)) - 1) >> (bottom - 1) <= LANES:
        bottom -= 1
    levels = bottom // 3 + 1
    offset = np.zeros(levels + 1, np.int64)
    for i in range(levels):
        offset[i + 1] = offset[i] + (1 if i == 0 else 1 << (bottom % 3 + 3 * (i - 1)))
    blocks = np.zeros((offset[levels], 15, LANES))
    for i in range(levels):
        level = bottom % 3 + 3 * i
        for j in range(1 << level):
            block, lane, node = offset[i] + (j >> 3 if i > 0 else 0), j & 7, (1 << level) - 1 + j
            point = (len(vertex) * (2 * j + 1)) >> (level + 1)
            for k in range(3):
                blocks[block, k, lane] = box[node, k]
                blocks[block, 12 + k, lane] = vertex[point, 0, k]
                for side in range(3):
                    blocks[block, 3 + 3 * side + k, lane] = box[node, 12 + side] * box[node, 3 + 3 * side + k]
    return blocks, offset, bottom


@kernel
def _see(view, slot, blocks, block, p, e1, e2, n, margin):  # type: ignore[no-untyped-def]
    """Write a block of boxes into a slot of the view, as seen from the contact.

    Rows: centre along e1, e2, n; half sides along e1, along e2, along n; how far up the box goes; the point.
    """
    for lane in range(len(margin)):
        x, y, z = blocks[block, 0, lane] - p[0], blocks[block, 1, lane] - p[1], blocks[block, 2, lane] - p[2]
        view[slot, 0, lane] = x * e1[0] + y * e1[1] + z * e1[2]
        view[slot, 1, lane] = x * e2[0] + y * e2[1] + z * e2[2]
        height = x * n[0] + y * n[1] + z * n[2]
        view[slot, 2, lane] = height
        for k in range(3):
            x, y, z = blocks[block, 3 + 3 * k, lane], blocks[block, 4 + 3 * k, lane], blocks[block, 5 + 3 * k, lane]
            view[slot, 3 + k, lane] = x * e1[0] + y * e1[1] + z * e1[2]
            view[slot, 6 + k, lane] = x * e2[0] + y * e2[1] + z * e2[2]
            up = x * n[0] + y * n[1] + z * n[2]
            view[slot, 9 + k, lane] = up
            height += abs(up)
        view[slot, 12, lane] = height
        x, y, z = blocks[block, 12, lane] - p[0], blocks[block, 13, lane] - p[1], blocks[block, 14, lane] - p[2]
        view[slot, 13, lane] = x * e1[0] + y * e1[1] + z * e1[2]
        view[slot, 14, lane] = x * e2[0] + y * e2[1] + z * e2[2]
        view[slot, 15, lane] = x * n[0] + y * n[1] + z * n[2]


@kernel
def _boxes_pass(view, block, cosine, sine, gap, count, radius, shrunk, low, high, margin):  # type: ignore[no-untyped-def]
    """Write a margin for each box of a block: 0 or more only if none of its points enters the body in any gap.

    What parts a box from the body is, as for a point: beside the cylinder; below its bottom where the gap begins; in front
    of the rim where it ends; below the rim at both; above the top where it ends; behind where it begins; out of reach.
    """
    for lane in range(len(margin)):
        margin[lane] = np.inf
    for g in range(count):
        ca, sa, cb, sb = gap[g, _CF], gap[g, _SF], gap[g, _CL], gap[g, _SL]
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
            slope, room = _rim(y, radius, shrunk)
            room += slope * y
            top = ca * z + sa * x + abs(ca * z0 + sa * f0) + abs(ca * z1 + sa * f1) + abs(ca * z2 + sa * f2)
            bottom = cb * z + sb * x - abs(cb * z0 + sb * f0) - abs(cb * z1 + sb * f1) - abs(cb * z2 + sb * f2)
            front = sb * z - cb * x + abs(sb * z0 - cb * f0 - slope * t0)
            front += abs(sb * z1 - cb * f1 - slope * t1) + abs(sb * z2 - cb * f2 - slope * t2)
            behind = sa * z - ca * x - abs(sa * z0 - ca * f0 + slope * t0)
            behind -= abs(sa * z1 - ca * f1 + slope * t1) + abs(sa * z2 - ca * f2 + slope * t2)
            d = sa * slope
            under = ca * low + sa * room - z - abs(z0 - d * t0) - abs(z1 - d * t1) - abs(z2 - d * t2)
            d = sb * slope
            under = min(under, cb * low + sb * room - z - abs(z0 - d * t0) - abs(z1 - d * t1) - abs(z2 - d * t2))
            ahead = x - abs(f0) - abs(f1) - abs(f2)
            beside = abs(y) - abs(t0) - abs(t1) - abs(t2)
            best = max(beside - shrunk, low - view[block, 12, lane])
            best = max(best, level - top)
            best = max(best, min(room - front, max(ahead, max(low - top, bottom))))
            best = max(best, under)
            best = max(best, bottom - high)
            best = max(best, behind - 2.0 * radius + room)
            away = np.sqrt(x * x + z * z) + 1e-300
            ux, uz = x / away, z / away
            away -= abs(ux * f0 + uz * z0) + abs(ux * f1 + uz * z1) + abs(ux * f2 + uz * z2)
            far = radius + np.sqrt(max(0.0, shrunk * shrunk - max(0.0, beside) ** 2))
            best = max(best, away - np.sqrt(high * high + far * far))
            margin[lane] = min(margin[lane], best)


@kernel
def _see_triangle(seen, lane, vertex, i, p, e1, e2, n):  # type: ignore[no-untyped-def]
    """Write a triangle into a lane of a leaf, as seen from the contact; how far up it goes."""
    top = -np.inf
    for k in range(3):
        x, y, z = vertex[i, k, 0] - p[0], vertex[i, k, 1] - p[1], vertex[i, k, 2] - p[2]
        seen[3 * k, lane] = x * e1[0] + y * e1[1] + z * e1[2]
        seen[3 * k + 1, lane] = x * e2[0] + y * e2[1] + z * e2[2]
        up = x * n[0] + y * n[1] + z * n[2]
        seen[3 * k + 2, lane] = up
        top = max(top, up)
    return top


@kernel
def _see_leaf(seen, vertex, begin, end, p, e1, e2, n):  # type: ignore[no-untyped-def]
    """Write triangles into a leaf; how far up they go. A lane without one holds a point far below."""
    top = -np.inf
    for lane in range(LANES):
        if begin + lane < end:
            top = max(top, _see_triangle(seen, lane, vertex, begin + lane, p, e1, e2, n))
        else:
            for k in range(3):
                seen[3 * k, lane], seen[3 * k + 1, lane], seen[3 * k + 2, lane] = 0.0, 0.0, -1.0
    return top


@kernel
def _triangles_pass(seen, cosine, sine, gap, count, radius, shrunk, low, high, margin):  # type: ignore[no-untyped-def]
    """`_boxes_pass` for the triangles of a leaf."""
    for lane in range(len(margin)):
        margin[lane] = np.inf
    for g in range(count):
        ca, sa, cb, sb = gap[g, _CF], gap[g, _SF], gap[g, _CL], gap[g, _SL]
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
            slope, room = _rim((y0 + y1 + y2) / 3.0, radius, shrunk)
            highest = max(z0, max(z1, z2))
            top = max(ca * z0 + sa * x0, max(ca * z1 + sa * x1, ca * z2 + sa * x2))
            bottom = min(cb * z0 + sb * x0, min(cb * z1 + sb * x1, cb * z2 + sb * x2))
            front = max(sb * z0 - cb * x0 - slope * y0,
                        max(sb * z1 - cb * x1 - slope * y1, sb * z2 - cb * x2 - slope * y2))  # fmt: skip
            behind = min(sa * z0 - ca * x0 + slope * y0,
                         min(sa * z1 - ca * x1 + slope * y1, sa * z2 - ca * x2 + slope * y2))  # fmt: skip
            d = sa * slope
            under = ca * low + sa * room - max(z0 - d * y0, max(z1 - d * y1, z2 - d * y2))
            d = sb * slope
            under = min(under, cb * low + sb * room - max(z0 - d * y0, max(z1 - d * y1, z2 - d * y2)))
            beside = max(min(y0, min(y1, y2)), -max(y0, max(y1, y2)))
            best = max(beside - shrunk, low - highest)
            best = max(best, level - top)
            best = max(best, min(room - front, max(min(x0, min(x1, x2)), max(low - top, bottom))))
            best = max(best, under)
            best = max(best, bottom - high)
            best = max(best, behind - 2.0 * radius + room)
            ux, uz = x0 + x1 + x2, z0 + z1 + z2
            away = np.sqrt(ux * ux + uz * uz) + 1e-300
            away = min(ux * x0 + uz * z0, min(ux * x1 + uz * z1, ux * x2 + uz * z2)) / away
            far = radius + np.sqrt(max(0.0, shrunk * shrunk - max(0.0, beside) ** 2))
            best = max(best, away - np.sqrt(high * high + far * far))
            margin[lane] = min(margin[lane], best)


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
    gap[g, _FIRST], gap[g, _CF], gap[g, _SF], gap[g, _UF] = tilt, np.cos(tilt), np.sin(tilt), unsure


@kernel
def _end(gap, g, tilt, unsure):  # type: ignore[no-untyped-def]
    gap[g, _LAST], gap[g, _CL], gap[g, _SL], gap[g, _UL] = tilt, np.cos(tilt), np.sin(tilt), unsure


@kernel
def _drop(gap, g, count):  # type: ignore[no-untyped-def]
    """Take a gap out, its bands with it; the new count."""
    for k in range(_COLUMNS):
        gap[g, k] = gap[count - 1, k]
    return count - 1


@kernel
def _part(gap, g, count, left, right, unsure):  # type: ignore[no-untyped-def]
    """Take the tilts between `left` and `right`, within a gap, out of it; the new count.

    Its new ends get the band `unsure`. Bands that are cut off stay undecided, as does the narrower part if there is no room
    for both: they are counted in the row after the last gap.
    """
    a, b = gap[g, _FIRST], gap[g, _LAST]
    if left > a and right < b and count == _GAPS:
        if left - a >= b - right:
            gap[_GAPS, _UL] += b - right
            right = b
        else:
            gap[_GAPS, _UF] += left - a
            left = a
    if left > a and right < b:
        for k in range(_COLUMNS):
            gap[count, k] = gap[g, k]
        _begin(gap, count, right, unsure)
        _end(gap, g, left, unsure)
        return count + 1
    if right < b:
        gap[_GAPS, _UF] += gap[g, _UF]
        _begin(gap, g, right, unsure)
    elif left > a:
        gap[_GAPS, _UL] += gap[g, _UL]
        _end(gap, g, left, unsure)
    else:
        gap[_GAPS, _UF] += gap[g, _UF] + gap[g, _UL] + min(b - a, unsure)
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
        a, b = gap[g, _FIRST], gap[g, _LAST]
        if right <= a or left >= b:
            g += 1
            continue
        # What the arc covers is no longer undecided.
        if left <= a - gap[g, _UF]:
            gap[g, _UF] = 0.0
        if right >= b + gap[g, _UL]:
            gap[g, _UL] = 0.0
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
    ca, sa, cb, sb = gap[g, _CF], gap[g, _SF], gap[g, _CL], gap[g, _SL]
    width = gap[g, _LAST] - gap[g, _FIRST]
    passed, failed, move = np.inf, 0.0, narrowest
    while passed - failed > narrowest:
        if passed < np.inf:
            move = 0.5 * (passed + failed)
        elif failed > 0.0:
            move = min(2.0 * failed, width - narrowest)
        if move <= failed or move >= width:
            return np.inf, width
        end = gap[g, _FIRST] + move if sign > 0.0 else gap[g, _LAST] - move
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
        a, b, ca, sa, cb, sb = gap[g, _FIRST], gap[g, _LAST], gap[g, _CF], gap[g, _SF], gap[g, _CL], gap[g, _SL]
        if _passes(corner, ca, sa, cb, sb, radius, shrunk, low, high, first, second):
            g += 1
            continue
        # A side or the middle of the triangle sticks out further than its corners: mostly by a little, at one end.
        # What was undecided at its ends no longer is where this triangle is in the way.
        for column, tilt, off in ((_UF, a, -gap[g, _UF]), (_UL, b, gap[g, _UL])):
            if (
                off != 0.0
                and _in_the_way(vertex, i, p, n, f, t, tilt, radius, shrunk, low, high, scratch)
                and _in_the_way(vertex, i, p, n, f, t, tilt + off, radius, shrunk, low, high, scratch)
            ):
                gap[g, column] = 0.0
        up, up_failed = _shrink(corner, gap, g, 1.0, narrowest, radius, shrunk, low, high, first, second)
        if up <= 2.0 * narrowest and gap[g, _UF] + up <= 3.0 * narrowest:
            _begin(gap, g, a + up, gap[g, _UF] + up)
            cut = True
            continue
        down, down_failed = _shrink(corner, gap, g, -1.0, narrowest, radius, shrunk, low, high, first, second)
        if down <= 2.0 * narrowest and gap[g, _UL] + down <= 3.0 * narrowest:
            _end(gap, g, b - down, gap[g, _UL] + down)
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


@kernel
def _turn(seen, lane, cosine, sine, corner):  # type: ignore[no-untyped-def]
    """Write a triangle of a leaf as rows (x, z, y) at a rotation."""
    for k in range(3):
        x, y = seen[3 * k, lane], seen[3 * k + 1, lane]
        corner[k, 0], corner[k, 1], corner[k, 2] = cosine * x + sine * y, seen[3 * k + 2, lane], cosine * y - sine * x


@kernel
def _forget(below, home, block, lane):  # type: ignore[no-untyped-def]
    """Leave a box out for this contact, and those above it in which nothing else is left."""
    while block < _SEEN:
        below[block, lane] = _NONE
        for other in range(LANES):
            if below[block, other] != _NONE:
                return
        if home[block, 0] < 0:
            return
        block, lane = home[block, 0], home[block, 1]


@kernel
def _rising(view, below, block, lanes, low):  # type: ignore[no-untyped-def]
    """Mark the boxes of a block just seen that rise above the tangent plane; whether there are any."""
    some = False
    for lane in range(LANES):
        rises = lane < lanes and view[block, 12, lane] > low
        below[block, lane] = _UNSEEN if rises else _NONE
        some = some or rises
    return some


@kernel
def _leaf(  # type: ignore[no-untyped-def]
    seen, which, vertex, p, n, f, t, cosine, sine, gap, count, radius, shrunk, low, high, narrowest, margin, corner, first,
    second, scratch,
):  # fmt: skip
    """Take what the triangles of a leaf forbid out of the gaps; (gaps, the lane that cut last or -1)."""
    _triangles_pass(seen, cosine, sine, gap, count, radius, shrunk, low, high, margin)
    last = -1
    for lane in range(LANES):
        if margin[lane] >= 0.0 or count == 0:
            continue
        _turn(seen, lane, cosine, sine, corner)
        count, cut = _cut_gaps(vertex, which[lane], p, n, f, t, corner, gap, count, narrowest, radius, shrunk, low, high,
                               first, second, scratch)  # fmt: skip
        if cut:
            last = lane
    return count, last


@kernel
def _rotation(  # type: ignore[no-untyped-def]
    p, e1, e2, n, f, t, cosine, sine, gap, count, radius, shrunk, low, high, narrowest, vertex, blocks, offset, bottom,
    tally, known, view, leaves, below, home, queue, ahead, margin, inside, which, corner, first, second, scratch,
):  # fmt: skip
    """Take the gaps of one rotation through the tree, level by level; how many are left."""
    triangles, levels = len(vertex), len(offset) - 1
    count, _ = _leaf(leaves[_LEAVES + 1], known, vertex, p, n, f, t, cosine, sine, gap, count, radius, shrunk, low, high,
                     narrowest, inside, corner, first, second, scratch)  # fmt: skip
    queue[0, 0], queue[0, 1] = 0, 0
    waiting = 1
    for level in range(levels):
        coming = 0
        for w in range(waiting):
            if count == 0:
                return 0
            slot, block = queue[w, 0], queue[w, 1]
            if slot < 0:
                slot = _SEEN
                _see(view, slot, blocks, offset[level] + block, p, e1, e2, n, margin)
                _rising(view, below, slot, LANES, low)
            _boxes_pass(view, slot, cosine, sine, gap, count, radius, shrunk, low, high, margin)
            for lane in range(LANES):
                inner = below[slot, lane]
                if margin[lane] >= 0.0 or inner == _NONE or count == 0:
                    continue
                box = 8 * block + lane
                if level == levels - 1:
                    begin, end = (triangles * box) >> bottom, (triangles * (box + 1)) >> bottom
                    if inner == _UNSEEN:
                        inner = min(tally[1], _LEAVES)
                        if _see_leaf(leaves[inner], vertex, begin, end, p, e1, e2, n) <= low:
                            _forget(below, home, slot, lane)
                            continue
                        if inner < _LEAVES:
                            tally[1] += 1
                            below[slot, lane] = inner
                    for k in range(LANES):
                        which[k] = begin + k
                    count, cut = _leaf(leaves[inner], which, vertex, p, n, f, t, cosine, sine, gap, count, radius, shrunk,
                                       low, high, narrowest, inside, corner, first, second, scratch)  # fmt: skip
                    if cut >= 0:
                        known[tally[2]] = begin + cut
                        for k in range(9):
                            leaves[_LEAVES + 1, k, tally[2]] = leaves[inner, k, cut]
                        tally[2] = (tally[2] + 1) % LANES
                    continue
                x, y, z = view[slot, 13, lane], view[slot, 14, lane], view[slot, 15, lane]
                x, y = cosine * x + sine * y, cosine * y - sine * x
                if _cuts(x, y, z, gap, count, radius, shrunk, low, high):
                    left, right = point_arc(z, x + radius, y, 0.0, radius, shrunk, low, high)
                    count = _take(gap, count, left, right)
                if inner == _UNSEEN and tally[0] < _SEEN:
                    inner = tally[0]
                    _see(view, inner, blocks, offset[level + 1] + box, p, e1, e2, n, inside)
                    if not _rising(view, below, inner, LANES, low):
                        _forget(below, home, slot, lane)
                        continue
                    below[slot, lane], home[inner, 0], home[inner, 1] = inner, slot, lane
                    tally[0] += 1
                if coming == _QUEUE:
                    # Too much in the way to be told apart: nothing here is called free.
                    for g in range(count):
                        gap[_GAPS, _UF] += gap[g, _LAST] - gap[g, _FIRST] + gap[g, _UF] + gap[g, _UL]
                    return 0
                ahead[coming, 0], ahead[coming, 1] = inner, box
                coming += 1
        queue, ahead = ahead, queue
        waiting = coming
    return count


@kernel
def _write(gap, count, room, part):  # type: ignore[no-untyped-def]
    """Write the gaps as intervals, ascending; (how many, width of what is undecided at their ends and beyond `room`)."""
    written, unsure = 0, gap[_GAPS, _UF] + gap[_GAPS, _UL]
    for g in range(count):
        unsure += gap[g, _UF] + gap[g, _UL]
        if gap[g, _LAST] <= gap[g, _FIRST]:
            continue
        if written == room:
            unsure += gap[g, _LAST] - gap[g, _FIRST]
            continue
        at = written
        while at > 0 and part[at - 1, 0] > gap[g, _FIRST]:
            part[at, 0], part[at, 1] = part[at - 1, 0], part[at - 1, 1]
            at -= 1
        part[at, 0], part[at, 1] = gap[g, _FIRST], gap[g, _LAST]
        written += 1
    return written, unsure


@entry
def free_map(  # type: ignore[no-untyped-def]
    rows, point, normal, direction_max, curvature, rotation_cos, rotation_sin, tilt_low, tilt_high, setup, limit_cos,
    radius, length, depth_allowed, narrowest, vertex, blocks, offset, bottom, room, part, count_out, undecided,
):  # fmt: skip
    """Free tilts of samples at all rotations, in one walk of the tree each, with certified ends.

    Parameters
    ----------
    rows : (m,) int64
    point, normal, direction_max : (n, 3) float64
    curvature : (n, 2) float64
    rotation_cos, rotation_sin : (k,) float64
    tilt_low, tilt_high : float
        rad.
    setup, limit_cos
        Unit setup axis, and the cosine of the axis limit about it, -2 for none.
    radius, length, depth_allowed : float
        Cutter, and the depth up to which a triangle does not matter, mm.
    narrowest : float
        Ends are found to this, rad; a passing tilt is kept.
    vertex : (triangles, 3, 3) float64
        Triangles in tree order.
    blocks, offset, bottom
        As `wide_tree` gives them.
    room : int
        Most intervals of one rotation.
    part : (m, k, room, 2) float64, written
        Free intervals, ascending, by place in `rows`.
    count_out : (m, k) int32, written
    undecided : (m, k) float64, written
        Width of the bands at the ends that are neither free nor known to be forbidden, rad in all.
    """
    t, f, e2 = np.empty(3), np.empty(3), np.empty(3)
    corner, first, second = np.empty((3, 3)), np.empty((8, 3)), np.empty((8, 3))
    gap, arcs = np.empty((_GAPS + 1, _COLUMNS)), np.empty((8, 2))
    margin, inside, which, known = (
        np.empty(LANES),
        np.empty(LANES),
        np.empty(LANES, np.int64),
        np.zeros(LANES, np.int64),
    )
    scratch = (np.empty(BODY), np.empty((8, 3)), np.empty((8, 3)), np.empty((64, 3, 3)), np.empty((64, 2)))
    view, leaves = np.empty((_SEEN + 1, 16, LANES)), np.empty((_LEAVES + 2, 9, LANES))
    below, home = np.empty((_SEEN + 1, LANES), np.int64), np.empty((_SEEN, 2), np.int64)
    tally = np.zeros(3, np.int64)
    queue, ahead = np.empty((_QUEUE, 2), np.int64), np.empty((_QUEUE, 2), np.int64)
    low, high, shrunk = depth_allowed, length - depth_allowed, radius - depth_allowed
    for place in range(len(rows)):
        row = rows[place]
        p, n, e1 = point[row], normal[row], direction_max[row]
        cross(n, e1, e2)
        home[0, 0], tally[0], tally[1] = -1, 1, 0
        _see(view, 0, blocks, 0, p, e1, e2, n, margin)
        some = _rising(view, below, 0, 1 << (bottom % 3), low)
        for lane in range(LANES):
            _see_triangle(leaves[_LEAVES + 1], lane, vertex, known[lane], p, e1, e2, n)
        for rotation in range(len(rotation_cos)):
            cosine, sine = rotation_cos[rotation], rotation_sin[rotation]
            lean_frame(e1, e2, cosine, sine, f, t)
            count_out[place, rotation], undecided[place, rotation] = 0, 0.0
            least = local_gouge(curvature[row, 0], curvature[row, 1], cosine, sine, radius)
            if np.isnan(least):
                continue
            count = axis_arcs(dot(setup, n), dot(setup, f), limit_cos, tilt_low, tilt_high, arcs)
            if least > 0.0:
                count = remove(arcs, count, -1.0, least, 0.0)
            gap[_GAPS, _UF], gap[_GAPS, _UL] = 0.0, 0.0
            for g in range(count):
                _begin(gap, g, arcs[g, 0], 0.0)
                _end(gap, g, arcs[g, 1], 0.0)
            if some and count > 0:
                count = _rotation(
                    p, e1, e2, n, f, t, cosine, sine, gap, count, radius, shrunk, low, high, narrowest, vertex,
                    blocks, offset, bottom, tally, known, view, leaves, below, home, queue, ahead, margin, inside, which,
                    corner, first, second, scratch,
                )  # fmt: skip
            count_out[place, rotation], undecided[place, rotation] = _write(gap, count, room, part[place, rotation])
