"""All free tilts at one rotation, with certified ends.

A range of tilts is free if the body, widened by half the range times the distance from the contact, is missed at the
middle. Where the middle itself is blocked, the point in the way forbids an arc; where only the widened body is, the
range is halved. Ranges narrower than `narrowest` stay undecided.
"""

import numpy as np

from plan_cutters.kernels.arcs import axis_arcs, local_gouge, point_arc
from plan_cutters.kernels.hit import BODY, stand, tree_hit
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


#: Obstacle points remembered from rotation to rotation.
_KNOWN = 24
#: Windows grow by this factor from the ends of a gap inwards: there, clearance grows with the distance from the end.
_GROWTH = 2.5
#: Gaps and parts that one rotation may fall into.
_GAPS, _PARTS = 64, 256


@kernel
def _blocked(p, n, f, t, tilt, half, radius, low, high, tree, hint, scratch, known, arc):  # type: ignore[no-untyped-def]
    """What is in the way at a tilt, widened by half a window: (triangle or -1, whether an arc was found).

    With `half` 0 the obstacle's arc is written to `arc` and its point to `known`.
    """
    vertex, box, depth = tree
    body, stack, polygon, spare, pieces = scratch
    cosine, sine = np.cos(tilt), np.sin(tilt)
    stand(body, p, n, f, t, cosine, sine, radius, radius - low, low, high)
    triangle, height, px, py = tree_hit(vertex, box, depth, body, half, hint, stack, polygon, spare, pieces)
    if triangle >= 0 and half == 0.0:
        first, last = point_arc(height, px, py, tilt, radius, radius - low, low, high)
        arc[0], arc[1] = min(first, tilt), max(last, tilt)
        back = px - radius
        for k in range(3):
            known[k] = p[k] + back * body[6 + k] + py * t[k] + height * body[3 + k]
    return triangle


@kernel
def _settle(  # type: ignore[no-untyped-def]
    near, far, sign, p, n, f, t, radius, low, high, narrowest, tree, hint, scratch, known, known_count, arc, fresh, gap,
    count,
):  # fmt: skip
    """Move one end of a gap inwards until the tilt next to it is free: by growing strides, then by halving.

    Ends and strides are counted in `sign` times the tilt. Tilts jumped over that no arc covers become gaps of their
    own. Returns the end, the hint, and the counts of known points and gaps.
    """
    stride, free = 0.5 * narrowest, far
    settled = False
    while not settled and near < far:
        at = min(near + stride, 0.5 * (near + far)) if free == far else 0.5 * (near + free)
        triangle = _blocked(p, n, f, t, sign * at, 0.0, radius, low, high, tree, hint, scratch, fresh, arc)
        if triangle < 0:
            free = at
            settled = free - near <= narrowest
            continue
        hint = triangle
        for k in range(3):
            known[known_count % _KNOWN, k] = fresh[k]
        known_count += 1
        first, last = (arc[0], arc[1]) if sign > 0.0 else (-arc[1], -arc[0])
        if first > near and count < _GAPS:
            gap[count, 0], gap[count, 1] = (near, first) if sign > 0.0 else (-first, -near)
            count += 1
        near = max(last, at)
        if free < far:
            free = max(free, near)
            settled = free - near <= narrowest
        stride *= 2.0
    return near, hint, known_count, count


@kernel
def free_map(  # type: ignore[no-untyped-def]
    rows, point, normal, direction_max, curvature, rotation_cos, rotation_sin, tilt_low, tilt_high, setup, limit_cos,
    radius, length, depth_allowed, narrowest, vertex, box, depth, room, part, count_out, undecided,
):  # fmt: skip
    """Free tilts of samples at all rotations, with certified ends.

    From the ends of a gap that obstacle points leave, windows that grow inwards are shown to be free; what blocks one
    forbids its arc. Obstacles of the last rotations and samples are tried first.

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
        Windows no wider than this (rad) that are neither free nor blocked in the middle stay undecided.
    vertex, box, depth
        Triangles in tree order and the tree.
    room : int
        Most intervals of one rotation.
    part : (m, k, room, 2) float64, written
        Free intervals, ascending, by place in `rows`.
    count_out : (m, k) int32, written
    undecided : (m, k) float64, written
        Tilts that are neither free nor forbidden, rad in all.
    """
    t, f, e2, arc, fresh = np.empty(3), np.empty(3), np.empty(3), np.empty(2), np.empty(3)
    scratch = (np.empty(BODY), np.empty(64, np.int64), np.empty((8, 3)), np.empty((8, 3)), np.empty((64, 3, 3)))
    tree = (vertex, box, depth)
    gap, piece = np.empty((_GAPS, 2)), np.empty((_PARTS, 2))
    known, known_count, hint = np.empty((_KNOWN, 3)), 0, -1
    low, high = depth_allowed, length - depth_allowed
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
            count = axis_arcs(along_n, along_f, limit_cos, tilt_low, tilt_high, gap)
            if least > 0.0:
                count = remove(gap, count, -1.0, least, 0.0)
            for i in range(min(known_count, _KNOWN)):
                x, y, z = 0.0, 0.0, 0.0
                for k in range(3):
                    x += (known[i, k] - p[k]) * f[k]
                    y += (known[i, k] - p[k]) * t[k]
                    z += (known[i, k] - p[k]) * n[k]
                first, last = point_arc(z, x + radius, y, 0.0, radius, radius - low, low, high)
                if first <= last:
                    count = remove(gap, count, first, last, 0.0)
            pieces, unsure = 0, 0.0
            while count > 0:
                count -= 1
                first, last = gap[count, 0], gap[count, 1]
                width_left, width_right = narrowest, narrowest
                found = False
                # What is left over between arcs and is this narrow is not searched.
                if last - first <= 2.0 * narrowest:
                    unsure += last - first
                    continue
                first, hint, known_count, count = _settle(
                    first, last, 1.0, p, n, f, t, radius, low, high, narrowest, tree, hint, scratch, known, known_count,
                    arc, fresh, gap, count,
                )  # fmt: skip
                if first < last:
                    last, hint, known_count, count = _settle(
                        -last, -first, -1.0, p, n, f, t, radius, low, high, narrowest, tree, hint, scratch, known,
                        known_count, arc, fresh, gap, count,
                    )  # fmt: skip
                    last = -last
                if first >= last:
                    continue
                start, end = first, last
                # Free is what lies from `start` to `first` and from `last` to `end`.
                while not found and first < last:
                    left = width_left <= width_right
                    width = min(width_left if left else width_right, last - first)
                    tilt = first + 0.5 * width if left else last - 0.5 * width
                    # A hair more than half, so that a free window holds at its very ends.
                    hint_now = _blocked(p, n, f, t, tilt, 0.5 * width + 1e-12, radius, low, high, tree, hint, scratch,
                                        fresh, arc)  # fmt: skip
                    if hint_now < 0:
                        if left:
                            first, width_left = first + width, _GROWTH * width_left
                        else:
                            last, width_right = last - width, _GROWTH * width_right
                        continue
                    hint = hint_now
                    hint_now = _blocked(p, n, f, t, tilt, 0.0, radius, low, high, tree, hint, scratch, fresh, arc)
                    if hint_now >= 0:
                        hint, found = hint_now, True
                    elif width > 1.5 * narrowest:
                        if left:
                            width_left = max(narrowest, 0.4 * width)
                        else:
                            width_right = max(narrowest, 0.4 * width)
                    else:
                        # Neither: left out, and what is certified so far ends here.
                        unsure += width
                        if left:
                            if first > start and pieces < _PARTS:
                                piece[pieces, 0], piece[pieces, 1] = start, first
                                pieces += 1
                            first += width
                            start, width_left = first, narrowest
                        else:
                            if end > last and pieces < _PARTS:
                                piece[pieces, 0], piece[pieces, 1] = last, end
                                pieces += 1
                            last -= width
                            end, width_right = last, narrowest
                if not found:
                    # The windows have met: `first` and `last` are one.
                    if end > start and pieces < _PARTS:
                        piece[pieces, 0], piece[pieces, 1] = start, end
                        pieces += 1
                    continue
                for k in range(3):
                    known[known_count % _KNOWN, k] = fresh[k]
                known_count += 1
                if first > start and pieces < _PARTS:
                    piece[pieces, 0], piece[pieces, 1] = start, first
                    pieces += 1
                if end > last and pieces < _PARTS:
                    piece[pieces, 0], piece[pieces, 1] = last, end
                    pieces += 1
                below, above = min(arc[0], last), max(arc[1], first)
                if count + 2 > _GAPS:
                    unsure += max(0.0, below - first) + max(0.0, last - above)
                    continue
                if below > first:
                    gap[count, 0], gap[count, 1] = first, below
                    count += 1
                if above < last:
                    gap[count, 0], gap[count, 1] = above, last
                    count += 1
            # Sort and join what touches.
            for i in range(1, pieces):
                a, b = piece[i, 0], piece[i, 1]
                j = i - 1
                while j >= 0 and piece[j, 0] > a:
                    piece[j + 1, 0], piece[j + 1, 1] = piece[j, 0], piece[j, 1]
                    j -= 1
                piece[j + 1, 0], piece[j + 1, 1] = a, b
            written = 0
            for i in range(pieces):
                if written > 0 and piece[i, 0] <= part[place, rotation, written - 1, 1]:
                    part[place, rotation, written - 1, 1] = piece[i, 1]
                elif written < room:
                    part[place, rotation, written, 0] = piece[i, 0]
                    part[place, rotation, written, 1] = piece[i, 1]
                    written += 1
                else:
                    unsure += piece[i, 1] - piece[i, 0]
            count_out[place, rotation], undecided[place, rotation] = written, unsure
