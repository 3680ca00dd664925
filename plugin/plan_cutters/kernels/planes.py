"""Does a convex piece of a tool stay clear of boxes or triangles at all tilts of a gap? Eight at a time, parted by planes.

Two lemmas carry all of it; `docs/tools.md` proves them. Points count from the centre about which the tool tilts. *One plane at
both ends*: a plane that is fixed to the tool and touches the piece parts it from a point at both ends of a gap; then it does so
in between, if the tilts at which it does not could not all lie between the ends. *A plane fixed in the part*: along a direction
of the part the piece goes no farther, at any tilt of a gap, than a closed form says.
"""

from typing import Any, NamedTuple

import numpy as np

from plan_cutters.kernels.jit import entry, kernel
from plan_cutters.kernels.lanes import LANES
from plan_cutters.kernels.pieces import (
    ARC, BOTTOM, COLUMNS, CYLINDER, HIGH, KIND, LOW, RADIUS, ROUND, SLOPE, TOP, WIDE,
)  # fmt: skip

#: A bound of a piece: two rims, each a radius and a height, and by how much what lies between them is grown all round; the slope
#: of its side; whether there is such a bound; whether its rims, seen along a direction, are farthest at an end of a range.
IS_ARC, Q0, F0, Q1, F1, GROWN, SIDE, THERE, JOINT, BOUNDS = 0, 1, 2, 3, 4, 5, 6, 7, 8, 9
#: What is known of a piece: nothing nearer to the line of turning or farther from it is ever in it, nothing so far beside it along
#: that line, nothing as low over the centre's tangent plane.
NEAR, FAR, BESIDE, FLOOR, KNOWN = 0, 1, 2, 3, 4
#: Rows of ends: cosine and sine of the first tilt, of the last, of the middle, cosine of half the gap.
CA, SA, CB, SB, CM, SM, CH, ENDS = 0, 1, 2, 3, 4, 5, 6, 7
#: Rows of boxes turned into a rotation's frame: centre, three half sides along f, along t, along n, extent along t, least and
#: largest distance from the line of turning.
AT, ALONG_F, ALONG_T, ALONG_N, EXTENT, NEAREST, FARTHEST, BOXES = 0, 3, 6, 9, 12, 13, 14, 15
#: A plane must part by more than this, mm: rounding is far less.
_HAIR = 1e-9
#: Parts that the tilts of a mode are cut into to know how low a piece can come.
_PARTS = 16
#: The direction to a point is taken no nearer to the rim's side than this.
_STEEP = 0.98


class Turning(NamedTuple):
    """A tool that tilts about the centre of one mode, for posture maps.

    offset : distance of the centre from the axis, mm; piece (k, COLUMNS); bound (2 k, BOUNDS), two for each piece, of which one
    may be missing; known (k, KNOWN); eight : the mask of the pieces for which the eight sides of `lanes` do.
    """

    offset: float
    piece: Any
    bound: Any
    known: Any
    eight: int


@kernel
def _span(p, q, ca, sa, cb, sb):  # type: ignore[no-untyped-def]
    """Least and most of p cos T + q sin T over a gap shorter than 180 deg."""
    u, v, du, dv = p * ca + q * sa, p * cb + q * sb, q * ca - p * sa, q * cb - p * sb
    size = np.sqrt(p * p + q * q)
    least = -size if (du < 0.0) & (dv > 0.0) else min(u, v)
    return least, size if (du > 0.0) & (dv < 0.0) else max(u, v)


@kernel
def _edge(bound, j):  # type: ignore[no-untyped-def]
    """A bound as numbers: what lanes have in common must not be read again in each."""
    return (
        bound[j, Q0], bound[j, F0], bound[j, Q1], bound[j, F1], bound[j, GROWN], bound[j, SIDE], bound[j, JOINT] > 0.0
    )  # fmt: skip


@kernel
def _swept(edge, offset, gx, gy, gz, ca, sa, cb, sb):  # type: ignore[no-untyped-def]
    """How far a bound goes at most, at any tilt of a gap, along a direction of the part, from the centre."""
    q0, f0, q1, f1, grown, _, joint = edge
    xl, xh = _span(gx, -gz, ca, sa, cb, sb)
    wl, wh = _span(gz, gx, ca, sa, cb, sb)
    low, high = xl * xl, xh * xh
    # A negative radius that is not the offset: each part by itself.
    least = 0.0 if xl * xh <= 0.0 else min(low, high)
    low, high = low if joint else least, high if joint else least
    rl, rh = np.sqrt(low + gy * gy), np.sqrt(high + gy * gy)
    first = max(q0 * rl - offset * xl, q0 * rh - offset * xh) + max(f0 * wl, f0 * wh)
    second = max(q1 * rl - offset * xl, q1 * rh - offset * xh) + max(f1 * wl, f1 * wh)
    return max(first, second) + grown * np.sqrt(gx * gx + gy * gy + gz * gz)


@kernel
def _towards(edge, x, y, height):  # type: ignore[no-untyped-def]
    """The direction (x, y, w), of length 1 or 0, in which a point lies farthest beyond a bound, its part across the axis, and how far
    about.
    """
    q0, f0, q1, f1, _, slope, _ = edge
    q = np.sqrt(x * x + y * y)
    share = 1.0 / max(q, 1e-200)
    below, above = f0 - height, height - f1
    inner, outer = max(0.0, q - q0), max(0.0, q - q1)
    # Below or above: from the rim. Else the side's own direction. An arc is all rim.
    lower, upper = (below > 0.0) & (inner * slope <= below), (above > 0.0) & (-outer * slope <= above)
    out = inner if lower else (outer if upper else 1.0)
    up = -below if lower else (above if upper else -slope)
    away = np.sqrt(out * out + up * up)
    size = 1.0 / max(away, 1e-200)
    away = away if lower | upper else (q - q0 + slope * below) * size
    out, up = out * size, up * size
    return out * x * share, out * y * share, up, out, away


@kernel
def _support(edge, offset, mx, mw, across):  # type: ignore[no-untyped-def]
    """How far a bound goes along a unit direction of the tool, from the centre."""
    q0, f0, q1, f1, grown, _, _ = edge
    return max(q0 * across + f0 * mw, q1 * across + f1 * mw) + grown - offset * mx


@kernel
def _between(least, reach, my, y_most, nearest, farthest, cosine):  # type: ignore[no-untyped-def]
    """Whether what lies beyond a plane by `least` at both ends of a gap does so in between: (the three reasons of the lemma).

    y_most is the largest of `my y`; `cosine` that of half the gap.
    """
    level, arm = reach - y_most, np.sqrt(max(0.0, 1.0 - my * my))
    return (least > reach + _HAIR) & (
        (level >= 0.0)
        | (-level + _HAIR <= arm * nearest * cosine)
        | (least >= reach + _HAIR + arm * farthest * (1.0 - cosine))
    )


@kernel
def _lean(edge, y, wide, sine):  # type: ignore[no-untyped-def]
    """How much a plane under a rim leans along the line of turning where something stands beside the contact."""
    radius = max(edge[0], _HAIR)
    y = y - max(-0.5 * wide, min(0.5 * wide, y))
    y = max(-_STEEP * radius, min(_STEEP * radius, y))
    return sine * y / np.sqrt(radius * radius - y * y)


@kernel
def _away(edge, offset, gx, gy, gz, x, y, z, cm, sm):  # type: ignore[no-untyped-def]
    """1 or -1: which way along a direction of the part something lies from a bound at the middle of a gap."""
    q0, f0, q1, f1, _, _, _ = edge
    up = 0.5 * (f0 + min(f1, f0 + 20.0 * max(q0, q1)))
    return 1.0 if gx * (x + offset * cm - up * sm) + gy * y + gz * (z - offset * sm - up * cm) >= 0.0 else -1.0


@kernel
def _boxes_apart(box, end, bound, j, offset, which, clear):  # type: ignore[no-untyped-def]
    """Mark boxes that a plane, as at one end of their gap or its middle (row `which` of `end` and the next), parts from a bound all
    over the gap, turning with the tool or not.
    """
    edge = _edge(bound, j)
    for lane in range(len(clear)):
        x, y, z, wide = box[0, lane], box[1, lane], box[2, lane], box[EXTENT, lane]
        f0, f1, f2 = box[3, lane], box[4, lane], box[5, lane]
        t0, t1, t2 = box[6, lane], box[7, lane], box[8, lane]
        z0, z1, z2 = box[9, lane], box[10, lane], box[11, lane]
        c, s = end[which, lane], end[which + 1, lane]
        mx, my, mw, across, _ = _towards(edge, offset + c * x - s * z, y, s * x + c * z)
        reach = _support(edge, offset, mx, mw, across)
        gx, gz = mx * c + mw * s, mw * c - mx * s
        over = gx * x + my * y + gz * z - abs(gx * f0 + my * t0 + gz * z0)
        over -= abs(gx * f1 + my * t1 + gz * z1) + abs(gx * f2 + my * t2 + gz * z2)
        fixed = over - _swept(
            edge, offset, gx, my, gz, end[CA, lane], end[SA, lane], end[CB, lane], end[SB, lane]
        )
        c, s = end[CA, lane], end[SA, lane]
        gx, gz = mx * c + mw * s, mw * c - mx * s
        first = gx * x + my * y + gz * z - abs(gx * f0 + my * t0 + gz * z0)
        first -= abs(gx * f1 + my * t1 + gz * z1) + abs(gx * f2 + my * t2 + gz * z2)
        c, s = end[CB, lane], end[SB, lane]
        gx, gz = mx * c + mw * s, mw * c - mx * s
        last = gx * x + my * y + gz * z - abs(gx * f0 + my * t0 + gz * z0)
        last -= abs(gx * f1 + my * t1 + gz * z1) + abs(gx * f2 + my * t2 + gz * z2)
        good = _between(
            min(first, last), reach, my, my * y + abs(my) * wide, box[NEAREST, lane], box[FARTHEST, lane], end[CH, lane]
        )
        clear[lane] = 1.0 if good | (fixed > _HAIR) else clear[lane]


@kernel
def _boxes_under(box, end, bound, j, offset, clear):  # type: ignore[no-untyped-def]
    """Mark boxes that lie under a bound all over their gap, as seen along the normal, straight or leaning along the rim."""
    edge = _edge(bound, j)
    for lane in range(len(clear)):
        y, z, t0, t1, t2 = box[1, lane], box[2, lane], box[6, lane], box[7, lane], box[8, lane]
        z0, z1, z2 = box[9, lane], box[10, lane], box[11, lane]
        ca, sa, cb, sb = end[CA, lane], end[SA, lane], end[CB, lane], end[SB, lane]
        straight = _swept(edge, offset, 0.0, 0.0, -1.0, ca, sa, cb, sb) + z + abs(z0) + abs(z1) + abs(z2)
        d = _lean(edge, y, box[EXTENT, lane], sa)
        over = d * y - z - abs(d * t0 - z0) - abs(d * t1 - z1) - abs(d * t2 - z2)
        leaning = _swept(edge, offset, 0.0, d, -1.0, ca, sa, cb, sb) - over
        clear[lane] = 1.0 if min(straight, leaning) < -_HAIR else clear[lane]


@kernel
def _boxes_across(box, end, bound, j, offset, clear):  # type: ignore[no-untyped-def]
    """Mark boxes that a plane across their thin side parts from a bound all over their gap."""
    edge = _edge(bound, j)
    for lane in range(len(clear)):
        x, y, z = box[0, lane], box[1, lane], box[2, lane]
        f0, f1, f2 = box[3, lane], box[4, lane], box[5, lane]
        t0, t1, t2 = box[6, lane], box[7, lane], box[8, lane]
        z0, z1, z2 = box[9, lane], box[10, lane], box[11, lane]
        gx, gy, gz = t0 * z1 - z0 * t1, z0 * f1 - f0 * z1, f0 * t1 - t0 * f1
        share = 1.0 / max(np.sqrt(gx * gx + gy * gy + gz * gz), 1e-200)
        share *= _away(edge, offset, gx, gy, gz, x, y, z, end[CM, lane], end[SM, lane])
        gx, gy, gz = share * gx, share * gy, share * gz
        over = gx * x + gy * y + gz * z - abs(gx * f0 + gy * t0 + gz * z0)
        over -= abs(gx * f1 + gy * t1 + gz * z1) + abs(gx * f2 + gy * t2 + gz * z2)
        beyond = over - _swept(
            edge, offset, gx, gy, gz, end[CA, lane], end[SA, lane], end[CB, lane], end[SB, lane]
        )
        clear[lane] = 1.0 if beyond > _HAIR else clear[lane]


@kernel
def _all(clear):  # type: ignore[no-untyped-def]
    """Whether all lanes are marked."""
    least = 1.0
    for lane in range(LANES):
        least = min(least, clear[lane])
    return least > 0.0


@kernel
def boxes_clear(box, end, turning, k, clear):  # type: ignore[no-untyped-def]
    """Mark the boxes, as `turn_boxes` gives them, no point of which is in piece k at any tilt of their gap; whether all are."""
    known, bound, offset = turning.known, turning.bound, turning.offset
    for lane in range(len(clear)):
        out = max(abs(box[1, lane]) - box[EXTENT, lane] - known[k, BESIDE], box[NEAREST, lane] - known[k, FAR])
        clear[lane] = 1.0 if max(out, known[k, NEAR] - box[FARTHEST, lane]) > _HAIR else 0.0
    for j in range(2 * k, 2 * k + 2):
        if bound[j, THERE] > 0.0 and not _all(clear):
            _boxes_under(box, end, bound, j, offset, clear)
            for which in (CB, CA, CM):
                if not _all(clear):
                    _boxes_apart(box, end, bound, j, offset, which, clear)
            if not _all(clear):
                _boxes_across(box, end, bound, j, offset, clear)
    return _all(clear)


@kernel
def turn_boxes(view, block, cosine, sine, box):  # type: ignore[no-untyped-def]
    """Turn a block of boxes, as `lanes._see` gives them, into the frame of a rotation."""
    for lane in range(LANES):
        x, y, square = view[block, 0, lane], view[block, 1, lane], 0.0
        box[0, lane], box[1, lane], box[2, lane] = cosine * x + sine * y, cosine * y - sine * x, view[block, 2, lane]
        wide = 0.0
        for k in range(3):
            f, t, z = view[block, 3 + k, lane], view[block, 6 + k, lane], view[block, 9 + k, lane]
            square += f * f + t * t + z * z
            box[3 + k, lane], box[6 + k, lane], box[9 + k, lane] = cosine * f + sine * t, cosine * t - sine * f, z
            wide += abs(cosine * t - sine * f)
        away, half = np.sqrt(box[0, lane] * box[0, lane] + box[2, lane] * box[2, lane]), np.sqrt(square)
        box[EXTENT, lane], box[NEAREST, lane], box[FARTHEST, lane] = wide, max(0.0, away - half), away + half


@kernel
def _triangles_apart(seen, end, bound, j, offset, which, clear):  # type: ignore[no-untyped-def]
    """`_boxes_apart` for triangles."""
    edge = _edge(bound, j)
    for lane in range(len(clear)):
        x0, y0, z0 = seen[0, lane], seen[1, lane], seen[2, lane]
        x1, y1, z1 = seen[3, lane], seen[4, lane], seen[5, lane]
        x2, y2, z2 = seen[6, lane], seen[7, lane], seen[8, lane]
        c, s = end[which, lane], end[which + 1, lane]
        # Where a gap ends, a corner touches the piece: the plane must be the one there.
        mx, my, mw, across, away = _towards(edge, offset + c * x0 - s * z0, y0, s * x0 + c * z0)
        nx, ny, nw, part, other = _towards(edge, offset + c * x1 - s * z1, y1, s * x1 + c * z1)
        near = other < away
        mx, my, mw = nx if near else mx, ny if near else my, nw if near else mw
        across, away = part if near else across, min(other, away)
        nx, ny, nw, part, other = _towards(edge, offset + c * x2 - s * z2, y2, s * x2 + c * z2)
        near = other < away
        mx, my, mw = nx if near else mx, ny if near else my, nw if near else mw
        across = part if near else across
        reach = _support(edge, offset, mx, mw, across)
        gx, gz, d0, d1, d2 = mx * c + mw * s, mw * c - mx * s, my * y0, my * y1, my * y2
        over = min(gx * x0 + gz * z0 + d0, min(gx * x1 + gz * z1 + d1, gx * x2 + gz * z2 + d2))
        fixed = over - _swept(
            edge, offset, gx, my, gz, end[CA, lane], end[SA, lane], end[CB, lane], end[SB, lane]
        )
        c, s = end[CA, lane], end[SA, lane]
        gx, gz = mx * c + mw * s, mw * c - mx * s
        first = min(gx * x0 + gz * z0 + d0, min(gx * x1 + gz * z1 + d1, gx * x2 + gz * z2 + d2))
        c, s = end[CB, lane], end[SB, lane]
        gx, gz = mx * c + mw * s, mw * c - mx * s
        last = min(gx * x0 + gz * z0 + d0, min(gx * x1 + gz * z1 + d1, gx * x2 + gz * z2 + d2))
        good = _between(
            min(first, last), reach, my, max(d0, max(d1, d2)), seen[9, lane], seen[10, lane], end[CH, lane]
        )
        clear[lane] = 1.0 if good | (fixed > _HAIR) else clear[lane]


@kernel
def _triangles_fixed(seen, end, bound, j, offset, clear):  # type: ignore[no-untyped-def]
    """`_boxes_under` and `_boxes_across` for triangles."""
    edge = _edge(bound, j)
    for lane in range(len(clear)):
        x0, y0, z0 = seen[0, lane], seen[1, lane], seen[2, lane]
        x1, y1, z1 = seen[3, lane], seen[4, lane], seen[5, lane]
        x2, y2, z2 = seen[6, lane], seen[7, lane], seen[8, lane]
        ca, sa, cb, sb = end[CA, lane], end[SA, lane], end[CB, lane], end[SB, lane]
        straight = max(z0, max(z1, z2)) + _swept(edge, offset, 0.0, 0.0, -1.0, ca, sa, cb, sb)
        d = _lean(edge, (y0 + y1 + y2) / 3.0, 0.0, sa)
        over = min(d * y0 - z0, min(d * y1 - z1, d * y2 - z2))
        leaning = _swept(edge, offset, 0.0, d, -1.0, ca, sa, cb, sb) - over
        ux, uy, uz, vx, vy, vz = x1 - x0, y1 - y0, z1 - z0, x2 - x0, y2 - y0, z2 - z0
        gx, gy, gz = uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx
        share = 1.0 / max(np.sqrt(gx * gx + gy * gy + gz * gz), 1e-200)
        share *= _away(edge, offset, gx, gy, gz, x0, y0, z0, end[CM, lane], end[SM, lane])
        gx, gy, gz = share * gx, share * gy, share * gz
        over = min(gx * x0 + gy * y0 + gz * z0, min(gx * x1 + gy * y1 + gz * z1, gx * x2 + gy * y2 + gz * z2))
        own = _swept(edge, offset, gx, gy, gz, ca, sa, cb, sb) - over
        clear[lane] = 1.0 if min(own, min(straight, leaning)) < -_HAIR else clear[lane]


@kernel
def triangles_clear(seen, end, turning, k, clear):  # type: ignore[no-untyped-def]
    """`boxes_clear` for triangles as `turn_triangles` gives them."""
    known, bound, offset = turning.known, turning.bound, turning.offset
    for lane in range(len(clear)):
        y0, y1, y2 = seen[1, lane], seen[4, lane], seen[7, lane]
        out = max(min(y0, min(y1, y2)), -max(y0, max(y1, y2))) - known[k, BESIDE]
        out = max(out, seen[9, lane] - known[k, FAR])
        clear[lane] = 1.0 if max(out, known[k, NEAR] - seen[10, lane]) > _HAIR else 0.0
    for j in range(2 * k, 2 * k + 2):
        if bound[j, THERE] > 0.0 and not _all(clear):
            _triangles_fixed(seen, end, bound, j, offset, clear)
            for which in (CB, CA, CM):
                if not _all(clear):
                    _triangles_apart(seen, end, bound, j, offset, which, clear)
    return _all(clear)


@kernel
def distances(seen):  # type: ignore[no-untyped-def]
    """Write the least and the largest distance of triangles from the line of turning, or bounds, into rows 9 and 10."""
    for lane in range(LANES):
        x0, z0, x1, z1 = seen[0, lane], seen[2, lane], seen[3, lane], seen[5, lane]
        x2, z2 = seen[6, lane], seen[8, lane]
        x, z = (x0 + x1 + x2) / 3.0, (z0 + z1 + z2) / 3.0
        first, second = (x0 - x) * (x0 - x) + (z0 - z) * (z0 - z), (x1 - x) * (x1 - x) + (z1 - z) * (z1 - z)
        half = np.sqrt(max(first, max(second, (x2 - x) * (x2 - x) + (z2 - z) * (z2 - z))))
        away = np.sqrt(x * x + z * z)
        seen[9, lane], seen[10, lane] = max(0.0, away - half), away + half


@kernel
def turn_triangles(leaf, cosine, sine, seen):  # type: ignore[no-untyped-def]
    """Turn the triangles of a leaf, as `lanes._see_leaf` gives them, into the frame of a rotation."""
    for k in range(0, 9, 3):
        for lane in range(LANES):
            x, y = leaf[k, lane], leaf[k + 1, lane]
            seen[k, lane], seen[k + 1, lane] = cosine * x + sine * y, cosine * y - sine * x
            seen[k + 2, lane] = leaf[k + 2, lane]
    distances(seen)


@kernel
def put_ends(end, lane, ca, sa, cb, sb):  # type: ignore[no-untyped-def]
    """Write a gap shorter than 180 deg into a lane."""
    half = np.sqrt(max(0.0, 0.5 + 0.5 * (ca * cb + sa * sb)))
    share = 0.5 / max(half, 1e-9)
    end[CA, lane], end[SA, lane], end[CB, lane], end[SB, lane] = ca, sa, cb, sb
    end[CM, lane], end[SM, lane], end[CH, lane] = share * (ca + cb), share * (sa + sb), half


@kernel
def all_ends(end, ca, sa, cb, sb):  # type: ignore[no-untyped-def]
    """Write a gap into all lanes."""
    put_ends(end, 0, ca, sa, cb, sb)
    for k in range(ENDS):
        for lane in range(1, LANES):
            end[k, lane] = end[k, 0]


@kernel
def _bounds_of(piece, k, offset, bound):  # type: ignore[no-untyped-def]
    """Write the bounds of piece k."""
    first, second = 2 * k, 2 * k + 1
    bound[first, THERE], bound[second, THERE] = 1.0, 0.0
    if piece[k, KIND] != ARC:
        q0, q1 = max(0.0, piece[k, RADIUS]), max(0.0, piece[k, WIDE])
        row = (0.0, q0, piece[k, LOW], q1, piece[k, HIGH], 0.0, piece[k, SLOPE] if piece[k, KIND] != CYLINDER else 0.0)
        for i in range(7):
            bound[first, i] = row[i]
        bound[first, JOINT] = 1.0
        return
    q, centre = piece[k, RADIUS], piece[k, SLOPE]
    row = (1.0, q, centre, q, centre, piece[k, ROUND], 0.0)
    for i in range(7):
        bound[first, i] = row[i]
    # Where the radius is the offset, q (hypot(x, y) - x) falls or rises with x all along, whatever its sign.
    bound[first, JOINT] = 1.0 if q >= 0.0 or q == offset else 0.0
    whole = piece[k, BOTTOM] == centre - piece[k, ROUND] and piece[k, TOP] == centre + piece[k, ROUND]
    if whole and q >= 0.0:
        return
    row = (0.0, piece[k, WIDE], piece[k, BOTTOM], piece[k, WIDE], piece[k, TOP], 0.0, 0.0)
    for i in range(7):
        bound[second, i] = row[i]
    bound[second, JOINT], bound[second, THERE] = 1.0, 1.0


@entry
def turning_of(piece, offset, low, high):  # type: ignore[no-untyped-def]
    """What posture maps need to know of a tool in one mode.

    Parameters
    ----------
    piece : (k, COLUMNS) float64
    offset : float
        mm.
    low, high : float
        Tilts that may be asked for, rad.

    Returns
    -------
    bound, known, eight
        As in `Turning`.
    """
    count, eight = len(piece), 0
    bound, known = np.zeros((2 * count, BOUNDS)), np.zeros((count, KNOWN))
    for k in range(count):
        _bounds_of(piece, k, offset, bound)
        radius, floor = piece[k, RADIUS], piece[k, LOW]
        bottom, top = piece[k, BOTTOM], piece[k, TOP]
        known[k, NEAR] = max(0.0, max(bottom, -top))
        known[k, BESIDE] = max(piece[k, WIDE], radius)
        known[k, FAR] = np.hypot(max(abs(bottom), abs(top)), abs(offset) + known[k, BESIDE])
        # The eight sides want a cutter that touches with its rim, and tilts up to 90 deg.
        if piece[k, KIND] == CYLINDER and 0.0 <= floor <= offset - radius + 1e-12 and high <= 0.5 * np.pi + 1e-9:
            eight |= 1 << k
            known[k, FLOOR] = floor
            continue
        deepest = -np.inf
        for part in range(_PARTS):
            a, b = low + (high - low) * part / _PARTS, low + (high - low) * (part + 1) / _PARTS
            reach = np.inf
            for j in range(2 * k, 2 * k + 2):
                if bound[j, THERE] > 0.0:
                    reach = min(
                        reach, _swept(_edge(bound, j), offset, 0.0, 0.0, -1.0, np.cos(a), np.sin(a), np.cos(b), np.sin(b))
                    )
            deepest = max(deepest, reach)
        known[k, FLOOR] = -deepest - _HAIR
    return bound, known, eight
