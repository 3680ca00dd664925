"""Free tilts of samples at all rotations, with certified ends, in one walk of the tree a rotation.

A gap of tilts is taken through the tree and only shrinks: what passes it passes all that is left of it. Boxes and
triangles are looked at eight at a time without a branch, so that the compiler uses the lanes of the processor, and as seen
from the contact: what rises nowhere above the tangent plane is out of reach at every posture and left out for all
rotations. A box in the way is first asked for one of its points, whose arc is known in closed form: so gaps are nearly what
they will be before any triangle is looked at. `docs/between_samples.md` has the argument.
"""

import numpy as np

from plan_cutters.kernels.arcs import axis_arcs, local_gouge, point_arc
from plan_cutters.kernels.hit import BODY, _swept_hit, stand, triangle_hit
from plan_cutters.kernels.jit import entry, kernel
from plan_cutters.kernels.search import remove

#: Boxes and triangles looked at together.
LANES = 8
#: Blocks of boxes kept as seen from one contact, and blocks that may wait to be looked at.
_SEEN, _QUEUE = 1 << 11, 1 << 13
#: What is known of the boxes in a block below another: not looked at yet, none rises above the tangent plane.
_UNSEEN, _NONE = -1, -2
#: Triangles that cut a gap at the last rotations, tried first.
_KNOWN = 8
#: Gaps that one rotation may fall into.
_GAPS = 16
#: By which an arc is widened, so that its ends are out of it, rad.
_HAIR = 1e-9
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
def _side(polygon, count, cosine, sine, radius, shrunk):  # type: ignore[no-untyped-def]
    """On which side of the cylinder at a tilt the shadow of a polygon of rows (x, z, y) lies: 1 front, -1 back, 0 neither.

    The front is where the contact is. 2: beside it, out of reach at every tilt.
    """
    least, most, area = np.inf, -np.inf, 0.0
    for i in range(count):
        least, most = min(least, polygon[i, 2]), max(most, polygon[i, 2])
    if least >= shrunk or most <= -shrunk:
        return 2
    best, px = np.inf, 0.0
    x0 = cosine * polygon[0, 0] - sine * polygon[0, 1] + radius
    xi = x0
    for i in range(count):
        j = i + 1 if i + 1 < count else 0
        xj = cosine * polygon[j, 0] - sine * polygon[j, 1] + radius if j else x0
        yi, yj = polygon[i, 2], polygon[j, 2]
        ex, ey = xj - xi, yj - yi
        square = ex * ex + ey * ey
        part = 0.0
        if square > 0.0:
            part = min(1.0, max(0.0, -(xi * ex + yi * ey) / square))
        x, y = xi + part * ex, yi + part * ey
        distance = x * x + y * y
        if distance < best:
            best, px = distance, x
        area += xi * yj - xj * yi
        xi = xj
    if best < shrunk * shrunk:
        return 0
    # Far from every side, the axis may still go through the polygon.
    if abs(area) > 0.0:
        inside, xi = True, x0
        for i in range(count):
            j = i + 1 if i + 1 < count else 0
            xj = cosine * polygon[j, 0] - sine * polygon[j, 1] + radius if j else x0
            if (xi * (polygon[j, 2] - polygon[i, 2]) - polygon[i, 2] * (xj - xi)) * area < 0.0:
                inside = False
                break
            xi = xj
        if inside:
            return 0
    return 1 if px >= 0.0 else -1


@kernel
def _never(polygon, count, radius, shrunk):  # type: ignore[no-untyped-def]
    """Whether a polygon of rows (x, z, y) is out of reach at every tilt.

    So near the line of turning that the disk, which touches that line at the contact, has curved away. Looked at in
    slabs, for the room grows with the square of y; the distance from the line is largest on a side.
    """
    low, high = np.inf, -np.inf
    for i in range(count):
        low, high = min(low, polygon[i, 2]), max(high, polygon[i, 2])
    wide = (high - low) / _SLABS
    for slab in range(_SLABS):
        at = low + slab * wide
        nearest = 0.0 if at <= 0.0 <= at + wide else min(abs(at), abs(at + wide))
        if nearest >= shrunk:
            continue
        room = radius - np.sqrt(shrunk * shrunk - nearest * nearest)
        for i in range(count):
            j = i + 1 if i + 1 < count else 0
            yi, yj = polygon[i, 2], polygon[j, 2]
            if max(yi, yj) < at or min(yi, yj) > at + wide:
                continue
            first, last = 0.0, 1.0
            if yi != yj:
                u, v = (at - yi) / (yj - yi), (at + wide - yi) / (yj - yi)
                first, last = max(0.0, min(u, v)), min(1.0, max(u, v))
            for part in (first, last):
                x = polygon[i, 0] + part * (polygon[j, 0] - polygon[i, 0])
                z = polygon[i, 1] + part * (polygon[j, 1] - polygon[i, 1])
                if x * x + z * z > room * room:
                    return False
    return True


@kernel
def _above(mf, mt, mn, top, cf, sf, cl, sl, radius, shrunk):  # type: ignore[no-untyped-def]
    """Whether the body stays above a plane `m . q = top` (q from the contact, m in the directions f, t, n) in a gap.

    The lowest point of the bottom disk along m is at `R u + r sqrt(u^2 + m_t^2)` below the contact, u = m . x_T. Where
    u is negative that falls as u does, and u falls with growing tilt: what holds where the gap begins holds all over.
    """
    if mn < 0.0:
        return False
    u = cf * mf - sf * mn
    if u > 0.0 or cf * mn + sf * mf < 0.0 or cl * mn + sl * mf < 0.0:
        return False
    return top < -(radius * u + shrunk * np.sqrt(u * u + mt * mt)) - 1e-9


@kernel
def _plane_passes(corner, cf, sf, cl, sl, radius, shrunk):  # type: ignore[no-untyped-def]
    """`_above` for the plane of a triangle, rows (x, z, y)."""
    ax, az, ay = corner[1, 0] - corner[0, 0], corner[1, 1] - corner[0, 1], corner[1, 2] - corner[0, 2]
    bx, bz, by = corner[2, 0] - corner[0, 0], corner[2, 1] - corner[0, 1], corner[2, 2] - corner[0, 2]
    mx, my, mz = ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx
    size = np.sqrt(mx * mx + my * my + mz * mz)
    if size == 0.0:
        return False
    if mz < 0.0:
        size = -size
    mx, my, mz = mx / size, my / size, mz / size
    top = max(mx * corner[0, 0] + my * corner[0, 2] + mz * corner[0, 1],
              mx * corner[1, 0] + my * corner[1, 2] + mz * corner[1, 1],
              mx * corner[2, 0] + my * corner[2, 2] + mz * corner[2, 1])  # fmt: skip
    return _above(mx, my, mz, top, cf, sf, cl, sl, radius, shrunk)


@kernel
def _surely_passes(corner, count, ca, sa, cb, sb, radius, shrunk, low, high):  # type: ignore[no-untyped-def]
    """`_box_passes` for a polygon of rows (x, z, y) and one gap."""
    y = 0.0
    for k in range(count):
        y += corner[k, 2]
    y0 = max(-0.98 * shrunk, min(0.98 * shrunk, y / count))
    q = np.sqrt(shrunk * shrunk - y0 * y0)
    slope = y0 / q
    room = radius - q - slope * y0
    top, front, rim_a, rim_b, bottom, behind = -np.inf, -np.inf, -np.inf, -np.inf, np.inf, np.inf
    least, most, x_least = np.inf, -np.inf, np.inf
    for k in range(count):
        x, z, y = corner[k, 0], corner[k, 1], corner[k, 2]
        top = max(top, ca * z + sa * x)
        front = max(front, sb * z - cb * x - slope * y)
        rim_a = max(rim_a, z - sa * slope * y)
        rim_b = max(rim_b, z - sb * slope * y)
        bottom = min(bottom, cb * z + sb * x)
        behind = min(behind, sa * z - ca * x + slope * y)
        least, most = min(least, y), max(most, y)
        x_least = min(x_least, x)
    if least >= shrunk or most <= -shrunk or bottom >= high:
        return True
    if top <= low * min(1.0, ca * min(ca + sa, cb + sb)):
        return True
    if front <= room and (x_least >= 0.0 or top <= low or bottom >= 0.0):
        return True
    if rim_a <= ca * low + sa * room and rim_b <= cb * low + sb * room:
        return True
    return behind >= 2.0 * radius - room


@kernel
def _passes(corner, cf, sf, cl, sl, radius, shrunk, low, high, first, second):  # type: ignore[no-untyped-def]
    """Whether a triangle, rows (x, z, y) from the contact, stays out of the body at all tilts of a gap.

    With growing tilt a point of the part turns about the contact down and back in the tool's frame. So one that is
    below the bottom or behind the body where the gap begins stays so; one that is in front of it, and no lower than the
    contact, or above its top where the gap ends was so before. Each point must be one of these; the rest of the triangle
    is cut off in turn. Next to the contact, where no such side is to be had, its plane decides.
    """
    if _surely_passes(corner, 3, cf, sf, cl, sl, radius, shrunk, low, high):
        return True
    count = _clip(corner, 3, first, sf, cf, low * min(1.0, cf * min(cf + sf, cl + sl)))
    if count == 0:
        return True
    if _surely_passes(first, count, cf, sf, cl, sl, radius, shrunk, low, high):
        return True
    lower = _clip(first, count, second, -sl, -cl, 0.0)
    good = lower == 0 or _surely_passes(second, lower, cf, sf, cl, sl, radius, shrunk, low, high)
    if not good:
        good = _never(second, lower, radius, shrunk)
    if good:
        upper = _clip(first, count, second, sl, cl, 0.0)
        if upper == 0 or _surely_passes(second, upper, cf, sf, cl, sl, radius, shrunk, low, high):
            return True
        if _side(second, upper, cl, sl, radius, shrunk) > 0:
            return True
    side = _side(first, count, cf, sf, radius, shrunk)
    return side == -1 or side == 2 or _plane_passes(corner, cf, sf, cl, sl, radius, shrunk)


@kernel
def _cuts(x, y, z, gap, count, radius, shrunk, low, high):  # type: ignore[no-untyped-def]
    """Whether a point is in the body at some tilt of some gap."""
    square = shrunk * shrunk - y * y
    if square <= 0.0 or z <= low:
        return False
    room = radius - np.sqrt(square)
    if x * x + z * z <= room * room + low * low:
        return False
    for g in range(count):
        top = gap[g, _CF] * z + gap[g, _SF] * x
        if top <= 0.0 or (top <= low and gap[g, _CF] * x <= gap[g, _SF] * z):
            continue
        bottom = gap[g, _CL] * z + gap[g, _SL] * x
        if bottom >= high or (bottom >= 0.0 and gap[g, _SL] * z - gap[g, _CL] * x <= room):
            continue
        return True
    return False


@kernel
def _see(view, block, box, vertex, first, lanes, p, e1, e2, n):  # type: ignore[no-untyped-def]
    """Write the boxes from node `first` on into a block of the view, as seen from the contact, and a point of each.

    Rows: centre along e1, e2, n; half sides along e1, along e2, along n; how far up the box goes; the point.
    """
    level, row = 0, 0
    while 2 * row + 1 <= first:
        level, row = level + 1, 2 * row + 1
    for lane in range(LANES):
        if lane >= lanes:
            for k in range(16):
                view[block, k, lane] = 0.0
            continue
        node = first + lane
        x, y, z = box[node, 0] - p[0], box[node, 1] - p[1], box[node, 2] - p[2]
        top = x * n[0] + y * n[1] + z * n[2]
        view[block, 0, lane] = x * e1[0] + y * e1[1] + z * e1[2]
        view[block, 1, lane] = x * e2[0] + y * e2[1] + z * e2[2]
        view[block, 2, lane] = top
        for k in range(3):
            half = box[node, 12 + k]
            ux, uy, uz = half * box[node, 3 + 3 * k], half * box[node, 4 + 3 * k], half * box[node, 5 + 3 * k]
            view[block, 3 + k, lane] = ux * e1[0] + uy * e1[1] + uz * e1[2]
            view[block, 6 + k, lane] = ux * e2[0] + uy * e2[1] + uz * e2[2]
            up = ux * n[0] + uy * n[1] + uz * n[2]
            view[block, 9 + k, lane] = up
            top += abs(up)
        view[block, 12, lane] = top
        i = (len(vertex) * (2 * (node - row) + 1)) >> (level + 1)
        x, y, z = vertex[i, 0, 0] - p[0], vertex[i, 0, 1] - p[1], vertex[i, 0, 2] - p[2]
        view[block, 13, lane] = x * e1[0] + y * e1[1] + z * e1[2]
        view[block, 14, lane] = x * e2[0] + y * e2[1] + z * e2[2]
        view[block, 15, lane] = x * n[0] + y * n[1] + z * n[2]


@kernel
def _boxes_pass(view, block, cosine, sine, gap, count, radius, shrunk, low, high, margin):  # type: ignore[no-untyped-def]
    """Write a margin for each box of a block: 0 or more only if none of its points enters the body in any gap.

    What parts a box from the body is, as for a point: beside the cylinder; below its bottom where the gap begins; in front
    of the rim where it ends; below the rim at both; above the top where it ends; behind where it begins.
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
            # The rim's distance from the line of turning grows with |y|; its tangent at y0 bounds it from below.
            y0 = max(-0.98 * shrunk, min(0.98 * shrunk, y))
            q = np.sqrt(shrunk * shrunk - y0 * y0)
            slope = y0 / q
            room = radius - q + slope * (y - y0)
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
            best = abs(y) - abs(t0) - abs(t1) - abs(t2) - shrunk
            best = max(best, low - view[block, 12, lane])
            best = max(best, level - top)
            best = max(best, min(room - front, max(ahead, max(low - top, bottom))))
            best = max(best, under)
            best = max(best, bottom - high)
            best = max(best, behind - 2.0 * radius + room)
            margin[lane] = min(margin[lane], best)


@kernel
def _triangles_pass(lanes, begin, p, f, t, n, gap, count, radius, shrunk, low, high, margin, up):  # type: ignore[no-untyped-def]
    """`_boxes_pass` for the triangles from `begin` on; and how far up each goes."""
    for lane in range(len(margin)):
        margin[lane] = np.inf
    for g in range(count):
        ca, sa, cb, sb = gap[g, _CF], gap[g, _SF], gap[g, _CL], gap[g, _SL]
        level = low * min(1.0, ca * min(ca + sa, cb + sb))
        for lane in range(len(margin)):
            i = begin + lane
            dx, dy, dz = lanes[0, i] - p[0], lanes[1, i] - p[1], lanes[2, i] - p[2]
            x0 = dx * f[0] + dy * f[1] + dz * f[2]
            y0 = dx * t[0] + dy * t[1] + dz * t[2]
            z0 = dx * n[0] + dy * n[1] + dz * n[2]
            dx, dy, dz = lanes[3, i] - p[0], lanes[4, i] - p[1], lanes[5, i] - p[2]
            x1 = dx * f[0] + dy * f[1] + dz * f[2]
            y1 = dx * t[0] + dy * t[1] + dz * t[2]
            z1 = dx * n[0] + dy * n[1] + dz * n[2]
            dx, dy, dz = lanes[6, i] - p[0], lanes[7, i] - p[1], lanes[8, i] - p[2]
            x2 = dx * f[0] + dy * f[1] + dz * f[2]
            y2 = dx * t[0] + dy * t[1] + dz * t[2]
            z2 = dx * n[0] + dy * n[1] + dz * n[2]
            y = max(-0.98 * shrunk, min(0.98 * shrunk, (y0 + y1 + y2) / 3.0))
            q = np.sqrt(shrunk * shrunk - y * y)
            slope = y / q
            room = radius - q - slope * y
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
            best = max(min(y0, min(y1, y2)), -max(y0, max(y1, y2))) - shrunk
            best = max(best, low - highest)
            best = max(best, level - top)
            best = max(best, min(room - front, max(min(x0, min(x1, x2)), max(low - top, bottom))))
            best = max(best, under)
            best = max(best, bottom - high)
            best = max(best, behind - 2.0 * radius + room)
            margin[lane] = min(margin[lane], best)
            up[lane] = highest


@kernel
def _first_in_the_way(vertex, i, p, n, f, t, a, b, sign, narrowest, radius, shrunk, low, high, scratch):  # type: ignore[no-untyped-def]
    """The first tilt, from a up or from b down (`sign`), at which a triangle is not shown to be clear; nan if none.

    A range is clear if the triangle misses the body, widened by what tilting within it can do. Others are halved.
    """
    body, polygon, spare, pieces, ranges, _ = scratch
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
def _take(gap, count, left, right):  # type: ignore[no-untyped-def]
    """Take an arc that a point forbids out of the gaps; (count of gaps, whether any was cut)."""
    left, right = left - _HAIR, right + _HAIR
    g, cut = 0, False
    if right - left <= 2.0 * _HAIR:
        return count, cut
    while g < count:
        a, b = gap[g, _FIRST], gap[g, _LAST]
        if right <= a or left >= b:
            g += 1
            continue
        cut = True
        if left <= a and right >= b:
            count -= 1
            for k in range(_COLUMNS):
                gap[g, k] = gap[count, k]
            continue
        if left > a and right < b:
            if count == _GAPS:
                # No room for both sides: the wider one stays, the other counts as undecided.
                if left - a >= b - right:
                    gap[g, _UL] += b - right
                    right = b
                else:
                    gap[g, _UF] += left - a
                    left = a
                continue
            for k in range(_COLUMNS):
                gap[count, k] = gap[g, k]
            gap[count, _FIRST], gap[count, _CF], gap[count, _SF], gap[count, _UF] = right, np.cos(right), np.sin(right), 0.0
            gap[g, _LAST], gap[g, _CL], gap[g, _SL], gap[g, _UL] = left, np.cos(left), np.sin(left), 0.0
            count += 1
        elif left <= a:
            gap[g, _FIRST], gap[g, _CF], gap[g, _SF], gap[g, _UF] = right, np.cos(right), np.sin(right), 0.0
        else:
            gap[g, _LAST], gap[g, _CL], gap[g, _SL], gap[g, _UL] = left, np.cos(left), np.sin(left), 0.0
        g += 1
    return count, cut


@kernel
def _in_the_way(vertex, i, p, n, f, t, tilt, radius, shrunk, low, high, scratch):  # type: ignore[no-untyped-def]
    """Whether a triangle reaches into the body at a tilt."""
    body, polygon, spare, _, _, _ = scratch
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
    g = 0
    while g < count:
        if not _passes(corner, gap[g, _CF], gap[g, _SF], gap[g, _CL], gap[g, _SL], radius, shrunk, low, high, first, second):
            break
        g += 1
    if g == count:
        return count, False
    # What its corners alone forbid is known in closed form, and mostly all that it does.
    for k in range(3):
        left, right = point_arc(corner[k, 1], corner[k, 0] + radius, corner[k, 2], 0.0, radius, shrunk, low, high)
        count, taken = _take(gap, count, left, right)
        cut = cut or taken
    if not cut:
        g = max(g, 0)
    else:
        g = 0
    while g < count:
        a, b, ca, sa, cb, sb = gap[g, 0], gap[g, 1], gap[g, 2], gap[g, 3], gap[g, 4], gap[g, 5]
        if _passes(corner, ca, sa, cb, sb, radius, shrunk, low, high, first, second):
            g += 1
            continue
        # A side or the middle of the triangle sticks out further than its corners: mostly by a little, at one end.
        up, up_failed = _shrink(corner, gap, g, 1.0, narrowest, radius, shrunk, low, high, first, second)
        if up <= 2.0 * narrowest and gap[g, _UF] + up <= 3.0 * narrowest:
            gap[g, _FIRST], gap[g, _CF], gap[g, _SF], gap[g, _UF] = a + up, np.cos(a + up), np.sin(a + up), gap[g, _UF] + up
            cut = True
            g += 1
            continue
        down, down_failed = _shrink(corner, gap, g, -1.0, narrowest, radius, shrunk, low, high, first, second)
        if down <= 2.0 * narrowest and gap[g, _UL] + down <= 3.0 * narrowest:
            gap[g, _LAST], gap[g, _CL], gap[g, _SL], gap[g, _UL] = b - down, np.cos(b - down), np.sin(b - down), gap[g, _UL] + down
            cut = True
            g += 1
            continue
        left, right = max(a, b - down), min(b, a + up)
        if left > right or not (
            _in_the_way(vertex, i, p, n, f, t, max(a, b - down_failed), radius, shrunk, low, high, scratch)
            and _in_the_way(vertex, i, p, n, f, t, min(b, a + up_failed), radius, shrunk, low, high, scratch)
        ):
            # Not known to be in the way right up to there: looked at closely.
            if left > right:
                left, right = a, b
            start, end = left, right
            left = _first_in_the_way(vertex, i, p, n, f, t, start, end, 1.0, narrowest, radius, shrunk, low, high, scratch)
            if np.isnan(left):
                g += 1
                continue
            right = _first_in_the_way(vertex, i, p, n, f, t, left, end, -1.0, narrowest, radius, shrunk, low, high, scratch)
            right = left if np.isnan(right) else right
        cut = True
        keep_left, keep_right = left > a, right < b
        off_left = min(narrowest, right - left)
        off_right = min(narrowest, right - left - off_left) if keep_left else off_left
        if keep_left and keep_right and count == _GAPS:
            keep_left = left - a >= b - right
            keep_right = not keep_left
        if keep_right:
            # What lies beyond the obstacle: in place if nothing is left before it, else a gap of its own.
            at = g
            if keep_left:
                at = count
                count += 1
            gap[at, 0], gap[at, 1], gap[at, _UL] = right, b, gap[g, _UL]
            gap[at, 2], gap[at, 3], gap[at, 4], gap[at, 5] = np.cos(right), np.sin(right), cb, sb
        if keep_left:
            gap[g, 1], gap[g, 4], gap[g, 5], gap[g, _UL] = left, np.cos(left), np.sin(left), off_left
            if keep_right:
                gap[count - 1, _UF] = off_right
        elif keep_right:
            gap[g, _UF] = off_right
        else:
            count -= 1
            for k in range(_COLUMNS):
                gap[g, k] = gap[count, k]
            continue
        g += 1
    return count, cut


@kernel
def _place(vertex, i, p, f, t, n, corner):  # type: ignore[no-untyped-def]
    for c in range(3):
        x, y, z = 0.0, 0.0, 0.0
        for k in range(3):
            away = vertex[i, c, k] - p[k]
            x += away * f[k]
            y += away * t[k]
            z += away * n[k]
        corner[c, 0], corner[c, 1], corner[c, 2] = x, z, y


@kernel
def _forget(below, home, block, lane):  # type: ignore[no-untyped-def]
    """Leave a box out for this contact, and those above it in which nothing else is left."""
    while True:
        below[block, lane] = _NONE
        for other in range(LANES):
            if below[block, other] != _NONE:
                return
        if home[block, 0] < 0:
            return
        block, lane = home[block, 0], home[block, 1]


@kernel
def _new_block(view, below, home, block, first, lanes, low):  # type: ignore[no-untyped-def]
    """Register a block just seen; whether a box in it rises above the tangent plane."""
    some = False
    for lane in range(LANES):
        rises = lane < lanes and view[block, 12, lane] > low
        below[block, lane] = _UNSEEN if rises else _NONE
        some = some or rises
    return some


@kernel
def _rotation(  # type: ignore[no-untyped-def]
    p, e1, e2, n, f, t, cosine, sine, gap, count, radius, shrunk, low, high, narrowest, vertex, lanes, box, bottom_level,
    seen, known, known_count, view, below, home, node, queue, ahead, margin, up, corner, first, second, scratch,
):  # fmt: skip
    """Take the gaps of one rotation through the tree; (gaps, blocks seen, count of known triangles)."""
    triangles, leaf = len(vertex), (1 << bottom_level) - 1
    for turn in range(min(known_count, _KNOWN)):
        if count == 0:
            break
        i = known[(known_count - 1 - turn) % _KNOWN]
        _place(vertex, i, p, f, t, n, corner)
        count, _ = _cut_gaps(vertex, i, p, n, f, t, corner, gap, count, narrowest, radius, shrunk, low, high, first,
                             second, scratch)  # fmt: skip
    queue[0, 0], queue[0, 1] = 0, node[0]
    waiting = 1
    while count > 0 and waiting > 0:
        coming = 0
        for w in range(waiting):
            if count == 0:
                break
            block, at = queue[w, 0], queue[w, 1]
            if block < 0:
                block = _SEEN
                _see(view, block, box, vertex, at, LANES, p, e1, e2, n)
            _boxes_pass(view, block, cosine, sine, gap, count, radius, shrunk, low, high, margin)
            if at >= leaf:
                for lane in range(LANES):
                    if margin[lane] >= 0.0:
                        continue
                    begin = (triangles * (at + lane - leaf)) >> bottom_level
                    end = (triangles * (at + lane - leaf + 1)) >> bottom_level
                    count, known_count, rises = _leaf(
                        vertex, lanes, begin, end, p, n, f, t, corner, gap, count, narrowest, radius, shrunk, low, high,
                        known, known_count, up, first, second, scratch)  # fmt: skip
                    if not rises and block < _SEEN:
                        _forget(below, home, block, lane)
                    if count == 0:
                        break
                continue
            for lane in range(LANES):
                if margin[lane] >= 0.0 or (block < _SEEN and below[block, lane] == _NONE):
                    continue
                x, y, z = view[block, 13, lane], view[block, 14, lane], view[block, 15, lane]
                x, y = cosine * x + sine * y, cosine * y - sine * x
                if _cuts(x, y, z, gap, count, radius, shrunk, low, high):
                    left, right = point_arc(z, x + radius, y, 0.0, radius, shrunk, low, high)
                    count, _ = _take(gap, count, left, right)
                next_block, next_node = _UNSEEN, 8 * (at + lane) + 7
                if block < _SEEN:
                    next_block = below[block, lane]
                    if next_block == _UNSEEN and seen < _SEEN:
                        _see(view, seen, box, vertex, next_node, LANES, p, e1, e2, n)
                        if not _new_block(view, below, home, seen, next_node, LANES, low):
                            _forget(below, home, block, lane)
                            continue
                        next_block = seen
                        below[block, lane], home[seen, 0], home[seen, 1], node[seen] = seen, block, lane, next_node
                        seen += 1
                ahead[coming, 0], ahead[coming, 1] = next_block, next_node
                coming += 1
        queue, ahead = ahead, queue
        waiting = coming
    return count, seen, known_count


@kernel
def _leaf(  # type: ignore[no-untyped-def]
    vertex, lanes, begin, end, p, n, f, t, corner, gap, count, narrowest, radius, shrunk, low, high, known, known_count,
    up, first, second, scratch,
):  # fmt: skip
    """Take what the triangles from `begin` to `end` forbid out of the gaps; whether one rises above the tangent plane."""
    passed = scratch[5]
    _triangles_pass(lanes, begin, p, f, t, n, gap, count, radius, shrunk, low, high, passed, up)
    rises = False
    for lane in range(end - begin):
        rises = rises or up[lane] > low
        if passed[lane] >= 0.0 or count == 0:
            continue
        _place(vertex, begin + lane, p, f, t, n, corner)
        count, cut = _cut_gaps(vertex, begin + lane, p, n, f, t, corner, gap, count, narrowest, radius, shrunk, low, high,
                               first, second, scratch)  # fmt: skip
        if cut:
            known[known_count % _KNOWN] = begin + lane
            known_count += 1
    return count, known_count, rises


@kernel
def _write(gap, count, room, part):  # type: ignore[no-untyped-def]
    """Write the gaps as intervals, ascending; (how many, width of what is undecided at their ends and beyond `room`)."""
    written, unsure = 0, 0.0
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
    radius, length, depth_allowed, narrowest, vertex, box, depth, lanes, room, part, count_out, undecided,
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
    vertex, box, depth
        Triangles in tree order and the tree.
    lanes : (9, triangles + LANES) float64
        The triangles once more, corner by corner, coordinate by coordinate; what is behind the last counts for nothing.
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
    gap, arcs, margin, up = np.empty((_GAPS, _COLUMNS)), np.empty((8, 2)), np.empty(LANES), np.empty(LANES)
    scratch = (np.empty(BODY), np.empty((8, 3)), np.empty((8, 3)), np.empty((64, 3, 3)), np.empty((64, 2)), np.empty(LANES))
    known, known_count = np.full(_KNOWN, -1), 0
    view = np.empty((_SEEN + 1, 16, LANES))
    below, home, node = np.empty((_SEEN, LANES), np.int64), np.empty((_SEEN, 2), np.int64), np.empty(_SEEN, np.int64)
    queue, ahead = np.empty((_QUEUE, 2), np.int64), np.empty((_QUEUE, 2), np.int64)
    low, high, shrunk = depth_allowed, length - depth_allowed, radius - depth_allowed
    # The leaves looked at: as many triangles as there are lanes, or half of it.
    bottom_level = depth
    while bottom_level > 0 and (len(vertex) + (1 << (bottom_level - 1)) - 1) >> (bottom_level - 1) <= LANES:
        bottom_level -= 1
    start = bottom_level % 3
    for place in range(len(rows)):
        row = rows[place]
        p, n, e1 = point[row], normal[row], direction_max[row]
        for k in range(3):
            a, b = (k + 1) % 3, (k + 2) % 3
            e2[k] = n[a] * e1[b] - n[b] * e1[a]
        node[0], home[0, 0], seen = (1 << start) - 1, -1, 1
        _see(view, 0, box, vertex, node[0], 1 << start, p, e1, e2, n)
        some = _new_block(view, below, home, 0, node[0], 1 << start, low)
        for rotation in range(len(rotation_cos)):
            cosine, sine = rotation_cos[rotation], rotation_sin[rotation]
            along_n, along_f = 0.0, 0.0
            for k in range(3):
                f[k] = cosine * e1[k] + sine * e2[k]
                t[k] = cosine * e2[k] - sine * e1[k]
                along_n += setup[k] * n[k]
                along_f += setup[k] * f[k]
            count_out[place, rotation], undecided[place, rotation] = 0, 0.0
            least = local_gouge(curvature[row, 0], curvature[row, 1], cosine, sine, radius)
            if np.isnan(least):
                continue
            count = axis_arcs(along_n, along_f, limit_cos, tilt_low, tilt_high, arcs)
            if least > 0.0:
                count = remove(arcs, count, -1.0, least, 0.0)
            for g in range(count):
                a, b = arcs[g, 0], arcs[g, 1]
                gap[g, _FIRST], gap[g, _LAST], gap[g, _UF], gap[g, _UL] = a, b, 0.0, 0.0
                gap[g, _CF], gap[g, _SF], gap[g, _CL], gap[g, _SL] = np.cos(a), np.sin(a), np.cos(b), np.sin(b)
            if some and count > 0:
                count, seen, known_count = _rotation(
                    p, e1, e2, n, f, t, cosine, sine, gap, count, radius, shrunk, low, high, narrowest, vertex, lanes, box,
                    bottom_level, seen, known, known_count, view, below, home, node, queue, ahead, margin, up, corner,
                    first, second, scratch,
                )  # fmt: skip
            count_out[place, rotation], undecided[place, rotation] = _write(gap, count, room, part[place, rotation])
