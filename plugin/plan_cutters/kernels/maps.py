"""All free tilts at a rotation, with certified ends: at one point by ranges (`free_tilts`), at all samples in one walk each.

A range of tilts is free if the body, widened by half the range times the distance from the contact, is missed at the
middle. Where the middle itself is blocked, the point in the way forbids an arc; where only the widened body is, the
range is halved. Ranges narrower than `narrowest` stay undecided.
"""

import numpy as np

from plan_cutters.kernels.arcs import axis_arcs, local_gouge, point_arc
from plan_cutters.kernels.hit import BODY, _half_width, _swept_hit, stand, tree_hit, triangle_hit
from plan_cutters.kernels.jit import kernel
from plan_cutters.kernels.search import remove

OPEN, FORBIDDEN, UNSURE = 0, 1, 2


@kernel
def free_tilts(p, n, f, low, high, radius, length, depth_allowed, narrowest, vertex, box, depth, room):  # type: ignore[no-untyped-def]
    """Split a range of tilts into free, forbidden and undecided parts.

    Parameters
    ----------
    p, n, f : (3,) float64
        Contact, normal, lean direction.
    low, high : float
        rad.
    radius, length, depth_allowed : float
        Cutter, and the depth up to which a triangle does not matter, mm.
    narrowest : float
        rad.
    vertex, box, depth
        Triangles in tree order and the tree.
    room : int
        Most parts that can be told apart.

    Returns
    -------
    parts : (k, 3) float64
        first, last, kind (OPEN, FORBIDDEN, UNSURE); together the range asked for, in no order.
    """
    t = np.empty(3)
    t[0], t[1], t[2] = n[1] * f[2] - n[2] * f[1], n[2] * f[0] - n[0] * f[2], n[0] * f[1] - n[1] * f[0]
    body = np.empty(BODY)
    stack = np.empty(64, np.int64)
    polygon, spare, pieces = np.empty((8, 3)), np.empty((8, 3)), np.empty((64, 3, 3))
    parts = np.empty((room + 4, 3))
    pending = np.empty((room + 4, 2))
    pending[0, 0], pending[0, 1] = low, high
    top, done, hint = 1, 0, -1
    shrunk, bottom, ceiling = radius - depth_allowed, depth_allowed, length - depth_allowed
    while top > 0:
        top -= 1
        first, last = pending[top, 0], pending[top, 1]
        tilt, half = 0.5 * (first + last), 0.5 * (last - first)
        stand(body, p, n, f, t, np.cos(tilt), np.sin(tilt), radius, shrunk, bottom, ceiling)
        # A hair more than half, so that a free range holds at its very ends.
        triangle, height, px, py = tree_hit(vertex, box, depth, body, half + 1e-12, hint, stack, polygon, spare, pieces)
        kind, cut_first, cut_last = OPEN, first, last
        if triangle >= 0:
            hint = triangle
            kind, cut_first, cut_last = UNSURE, tilt, tilt
            triangle, height, px, py = tree_hit(vertex, box, depth, body, 0.0, hint, stack, polygon, spare, pieces)
            if triangle >= 0:
                hint = triangle
                arc_first, arc_last = point_arc(height, px, py, tilt, radius, shrunk, bottom, ceiling)
                kind = FORBIDDEN
                cut_first, cut_last = max(first, min(arc_first, tilt)), min(last, max(arc_last, tilt))
            if last - first <= narrowest or top + done + 3 > room:
                kind, cut_first, cut_last = UNSURE, first, last
        # What is cut out is settled; the rest, at most half on either side or narrower, is not.
        parts[done, 0], parts[done, 1], parts[done, 2] = cut_first, cut_last, kind
        if cut_last > cut_first:
            done += 1
        if cut_last < last:
            pending[top, 0], pending[top, 1] = cut_last, last
            top += 1
        if cut_first > first:
            pending[top, 0], pending[top, 1] = first, cut_first
            top += 1
    return parts[:done]


#: Triangles that cut a gap at the last rotations, tried first.
_KNOWN = 12
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
def _passes(corner, cf, sf, cl, sl, radius, shrunk, low, high, first, second):  # type: ignore[no-untyped-def]
    """Whether a triangle, rows (x, z, y) from the contact, stays out of the body at all tilts of a gap.

    With growing tilt a point of the part turns about the contact down and back in the tool's frame. So one that is
    below the bottom or behind the body where the gap begins stays so; one that is in front of it, and no lower than the
    contact, or above its top where the gap ends was so before. Each point must be one of these; the rest of the triangle
    is cut off in turn. Next to the contact, where no such side is to be had, its plane decides.
    """
    level = low
    for i in range(3):
        # Ahead of the contact, what is below the bottom may yet rise in front of it.
        if cf * corner[i, 0] - sf * corner[i, 1] > 0.0:
            level = 0.0
    count = _clip(corner, 3, first, sf, cf, level)
    if count == 0:
        return True
    side = _side(first, count, cf, sf, radius, shrunk)
    if side == -1 or side == 2:
        return True
    if _plane_passes(corner, cf, sf, cl, sl, radius, shrunk):
        return True
    lower = _clip(first, count, second, -sl, -cl, 0.0)
    if lower > 0 and not _never(second, lower, radius, shrunk):
        return False
    count = _clip(first, count, second, sl, cl, 0.0)
    if count == 0:
        return True
    count = _clip(second, count, first, -sl, -cl, -high)
    return count == 0 or _side(first, count, cl, sl, radius, shrunk) > 0


@kernel
def _box_passes(box, i, p, n, f, t, gap, count, radius, shrunk, low, high):  # type: ignore[no-untyped-def]
    """True only if no point of box i enters the body at any tilt of any gap, by one side for each gap."""
    dx, dy, dz = box[i, 0] - p[0], box[i, 1] - p[1], box[i, 2] - p[2]
    x = dx * f[0] + dy * f[1] + dz * f[2]
    y = dx * t[0] + dy * t[1] + dz * t[2]
    z = dx * n[0] + dy * n[1] + dz * n[2]
    diagonal = box[i, 15]
    if abs(y) >= shrunk + diagonal:
        return True
    if abs(y) > shrunk and abs(y) - _half_width(box, i, t[0], t[1], t[2]) >= shrunk:
        return True
    mx, my, mz = box[i, 9], box[i, 10], box[i, 11]
    mf = mx * f[0] + my * f[1] + mz * f[2]
    mt = mx * t[0] + my * t[1] + mz * t[2]
    mn = mx * n[0] + my * n[1] + mz * n[2]
    if mn < 0.0:
        mf, mt, mn = -mf, -mt, -mn
    top_plane = mf * x + mt * y + mn * z + box[i, 14]
    for g in range(count):
        c, s = gap[g, _CF], gap[g, _SF]
        height = c * z + s * x
        if height + diagonal <= 0.0:
            continue
        if _above(mf, mt, mn, top_plane, c, s, gap[g, _CL], gap[g, _SL], radius, shrunk):
            continue
        ax, ay, az = c * n[0] + s * f[0], c * n[1] + s * f[1], c * n[2] + s * f[2]
        top = height + _half_width(box, i, ax, ay, az) if height <= low else np.inf
        if top <= 0.0:
            continue
        bx, by, bz = c * f[0] - s * n[0], c * f[1] - s * n[1], c * f[2] - s * n[2]
        across = c * x - s * z
        if top <= low and across + _half_width(box, i, bx, by, bz) <= 0.0:
            continue
        across += radius
        if across < 0.0:
            distance = np.sqrt(across * across + y * y)
            if distance >= shrunk:
                if distance - diagonal >= shrunk:
                    continue
                ux, uy = across / distance, y / distance
                if (
                    distance - _half_width(box, i, ux * bx + uy * t[0], ux * by + uy * t[1], ux * bz + uy * t[2])
                    >= shrunk
                ):
                    continue
        c, s = gap[g, _CL], gap[g, _SL]
        height = c * z + s * x
        if height - diagonal >= high:
            continue
        if height < diagonal and (height < 0.0 or height < _half_width(
            box, i, c * n[0] + s * f[0], c * n[1] + s * f[1], c * n[2] + s * f[2]
        )):  # fmt: skip
            return False
        across = c * x - s * z + radius
        if across > 0.0:
            distance = np.sqrt(across * across + y * y)
            if distance >= shrunk:
                if distance - diagonal >= shrunk:
                    continue
                bx, by, bz = c * f[0] - s * n[0], c * f[1] - s * n[1], c * f[2] - s * n[2]
                ux, uy = across / distance, y / distance
                if (
                    distance - _half_width(box, i, ux * bx + uy * t[0], ux * by + uy * t[1], ux * bz + uy * t[2])
                    >= shrunk
                ):
                    continue
        return False
    return True


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
def _cut_gaps(  # type: ignore[no-untyped-def]
    vertex, i, p, n, f, t, corner, gap, count, narrowest, radius, shrunk, low, high, first, second, scratch
):  # fmt: skip
    """Take the tilts at which a triangle is in the way out of the gaps; (count of gaps, whether any was cut)."""
    cut = False
    g, corners = 0, 0
    while g < count:
        a, b, ca, sa, cb, sb = gap[g, 0], gap[g, 1], gap[g, 2], gap[g, 3], gap[g, 4], gap[g, 5]
        if _passes(corner, ca, sa, cb, sb, radius, shrunk, low, high, first, second):
            g += 1
            corners = 0
            continue
        if corners < 3:
            # What its corners alone forbid is known in closed form, and mostly all that it does.
            x, z, y = corner[corners, 0], corner[corners, 1], corner[corners, 2]
            left, right = point_arc(z, x + radius, y, 0.0, radius, shrunk, low, high)
            corners += 1
            left, right = left - _HAIR, right + _HAIR
            if right - left <= 2.0 * _HAIR or right <= a or left >= b:
                continue
            cut = True
            if left <= a and right >= b:
                count -= 1
                for k in range(_COLUMNS):
                    gap[g, k] = gap[count, k]
                corners = 0
            elif left <= a:
                gap[g, 0], gap[g, 2], gap[g, 3], gap[g, _UF] = right, np.cos(right), np.sin(right), 0.0
            elif right >= b:
                gap[g, 1], gap[g, 4], gap[g, 5], gap[g, _UL] = left, np.cos(left), np.sin(left), 0.0
            elif count < _GAPS:
                for k in range(_COLUMNS):
                    gap[count, k] = gap[g, k]
                gap[count, 0], gap[count, 2], gap[count, 3], gap[count, _UF] = right, np.cos(right), np.sin(right), 0.0
                gap[g, 1], gap[g, 4], gap[g, 5], gap[g, _UL] = left, np.cos(left), np.sin(left), 0.0
                count += 1
            continue
        corners = 0
        # A side or the middle of the triangle sticks out a little further than its corners.
        shift, trimmed = narrowest, False
        while shift <= 2.0 * narrowest and not trimmed:
            c, s = np.cos(a + shift), np.sin(a + shift)
            if (
                gap[g, _UF] + shift <= 3.0 * narrowest
                and a + shift < b
                and _passes(corner, c, s, cb, sb, radius, shrunk, low, high, first, second)
            ):
                gap[g, 0], gap[g, 2], gap[g, 3], gap[g, _UF] = a + shift, c, s, gap[g, _UF] + shift
                trimmed = True
                continue
            c, s = np.cos(b - shift), np.sin(b - shift)
            if (
                gap[g, _UL] + shift <= 3.0 * narrowest
                and b - shift > a
                and _passes(corner, ca, sa, c, s, radius, shrunk, low, high, first, second)
            ):
                gap[g, 1], gap[g, 4], gap[g, 5], gap[g, _UL] = b - shift, c, s, gap[g, _UL] + shift
                trimmed = True
                continue
            shift *= 2.0
        if trimmed:
            cut = True
            g += 1
            continue
        left = _first_in_the_way(vertex, i, p, n, f, t, a, b, 1.0, narrowest, radius, shrunk, low, high, scratch)
        if np.isnan(left):
            g += 1
            continue
        right = _first_in_the_way(vertex, i, p, n, f, t, left, b, -1.0, narrowest, radius, shrunk, low, high, scratch)
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
def free_map(  # type: ignore[no-untyped-def]
    rows, point, normal, direction_max, curvature, rotation_cos, rotation_sin, tilt_low, tilt_high, setup, limit_cos,
    radius, length, depth_allowed, narrowest, vertex, box, depth, room, part, count_out, undecided,
):  # fmt: skip
    """Free tilts of samples at all rotations, in one walk of the tree each, with certified ends.

    Gaps only shrink in the walk, and what passes a gap passes what is left of it: no box is looked at twice. Triangles
    that cut a gap at the last rotations and samples are tried first.

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
    gap, arcs, stack = np.empty((_GAPS, _COLUMNS)), np.empty((8, 2)), np.empty(64, np.int64)
    scratch = (np.empty(BODY), np.empty((8, 3)), np.empty((8, 3)), np.empty((64, 3, 3)), np.empty((64, 2)))
    known, known_count = np.full(_KNOWN, -1), 0
    low, high, shrunk = depth_allowed, length - depth_allowed, radius - depth_allowed
    triangles, first_leaf = len(vertex), (1 << depth) - 1
    for place in range(len(rows)):
        row = rows[place]
        p, n, e1 = point[row], normal[row], direction_max[row]
        e2[0] = n[1] * e1[2] - n[2] * e1[1]
        e2[1] = n[2] * e1[0] - n[0] * e1[2]
        e2[2] = n[0] * e1[1] - n[1] * e1[0]
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
                gap[g, 0], gap[g, 1], gap[g, _UF], gap[g, _UL] = a, b, 0.0, 0.0
                gap[g, 2], gap[g, 3], gap[g, 4], gap[g, 5] = np.cos(a), np.sin(a), np.cos(b), np.sin(b)
            top = 0 if count == 0 else 1
            stack[0] = 0
            trying = min(known_count, _KNOWN)
            while count > 0 and (trying > 0 or top > 0):
                if trying > 0:
                    trying -= 1
                    begin = known[(known_count - 1 - trying) % _KNOWN]
                    end = begin + 1
                else:
                    top -= 1
                    node = stack[top]
                    if _box_passes(box, node, p, n, f, t, gap, count, radius, shrunk, low, high):
                        continue
                    if node < first_leaf:
                        stack[top] = 2 * node + 2
                        stack[top + 1] = 2 * node + 1
                        top += 2
                        continue
                    leaf = node - first_leaf
                    begin, end = (triangles * leaf) >> depth, (triangles * (leaf + 1)) >> depth
                for i in range(begin, end):
                    for c in range(3):
                        x, y, z = 0.0, 0.0, 0.0
                        for k in range(3):
                            away = vertex[i, c, k] - p[k]
                            x += away * f[k]
                            y += away * t[k]
                            z += away * n[k]
                        corner[c, 0], corner[c, 1], corner[c, 2] = x, z, y
                    count, cut = _cut_gaps(vertex, i, p, n, f, t, corner, gap, count, narrowest, radius, shrunk, low,
                                           high, first, second, scratch)  # fmt: skip
                    if cut and end - begin > 1:
                        known[known_count % _KNOWN] = i
                        known_count += 1
            written, unsure = 0, 0.0
            for g in range(count):
                unsure += gap[g, _UF] + gap[g, _UL]
                if gap[g, 1] <= gap[g, 0]:
                    continue
                if written == room:
                    unsure += gap[g, 1] - gap[g, 0]
                    continue
                at = written
                while at > 0 and part[place, rotation, at - 1, 0] > gap[g, 0]:
                    part[place, rotation, at, 0] = part[place, rotation, at - 1, 0]
                    part[place, rotation, at, 1] = part[place, rotation, at - 1, 1]
                    at -= 1
                part[place, rotation, at, 0], part[place, rotation, at, 1] = gap[g, 0], gap[g, 1]
                written += 1
            count_out[place, rotation], undecided[place, rotation] = written, unsure
