"""Does a convex piece of a tool stay clear of boxes or triangles at all tilts of an interval? Eight at a time, parted by planes.

Two lemmas carry all of it, M5 and M6 of `docs/proofs.md`. Points count from the centre about which the tool tilts.
*One plane at both ends* (M5): a plane that is fixed to the tool and touches the piece parts it from a point at both ends of an
interval; then it does so in between, if the tilts at which it does not could not all lie between the ends. *A plane fixed in the
part* (M6): along a direction of the part the piece goes no farther, at any tilt of an interval, than a closed form says.

Loops run over `len(clear)`: where they are known to be short, the compiler does not take lanes together.
"""

from typing import Any, NamedTuple

import numpy as np

from plan_cutters.kernels.codes import ARC, BOTTOM, CONE, CYLINDER, HIGH, KIND, LOW, RADIUS, ROUND, SLOPE, TOP, WIDE
from plan_cutters.kernels.jit import kernel, maker
from plan_cutters.kernels.linear.tree import LANES
from plan_cutters.kernels.rows import Cylinder

#: A bound of a piece: two rims, each a radius and a height, and by how much what lies between them is grown all round; the slope
#: of its side; whether there is such a bound.
Q0, F0, Q1, F1, GROWN, SIDE, THERE, BOUNDS = 0, 1, 2, 3, 4, 5, 6, 7
#: What is known of a piece (lemma M4): nothing nearer to the line of turning or farther from it is ever in it, nothing so far
#: beside it along that line, nothing as low over the centre's tangent plane; its radius at height 0, were it to go on, and its
#: slope if it widens.
NEAR, FAR, LATERAL, FLOOR, AXIS, WIDENS, KNOWN = 0, 1, 2, 3, 4, 5, 6
#: A plane must part by more than this, mm: rounding is far less.
HAIR = 1e-9
#: Parts that the tilts of a mode are cut into to know how low a piece can come.
_PARTS = 16


class Turning(NamedTuple):
    """A tool that tilts about the centre of one mode, for posture maps."""

    offset: float  #: Distance of the centre from the axis, mm.
    piece: Any  #: (k, COLUMNS)
    bound: Any  #: (2 k, BOUNDS), two for each piece, of which one may be missing.
    known: Any  #: (k, KNOWN)
    eight: int  #: The mask of the pieces for which the eight sides of `passes` do.


@kernel
def _span(p, q, ca, sa, cb, sb):
    """Return the least and the most of p cos T + q sin T over an interval shorter than 180 deg."""
    u, v, du, dv = p * ca + q * sa, p * cb + q * sb, q * ca - p * sa, q * cb - p * sb
    size = np.sqrt(p * p + q * q)
    least = -size if (du < 0.0) & (dv > 0.0) else min(u, v)
    return least, size if (du > 0.0) & (dv < 0.0) else max(u, v)


@kernel
def most(p, q, ca, sa, cb, sb):
    """Return the most of p cos T + q sin T over an interval shorter than 180 deg."""
    within = (q * ca - p * sa > 0.0) & (q * cb - p * sb < 0.0)
    return np.sqrt(p * p + q * q) if within else max(p * ca + q * sa, p * cb + q * sb)


@kernel
def edge_of(bound, j):
    """A bound as numbers: what lanes have in common must not be read again in each."""
    loose = 1.0 if bound[j, Q0] < 0.0 else 0.0
    return bound[j, Q0], bound[j, F0], bound[j, Q1], bound[j, F1], bound[j, GROWN], bound[j, SIDE], loose


@kernel
def rim_line(edge, gx, gy, gz, ca, sa, cb, sb):
    """Return a line (slope, value at 0) that bounds how far a rim of radius 1 goes along a direction of the part over an
    interval.

    It goes hypot(x, g_y), x what the direction has along x_T: convex in x, so below its chord. Where the radius is negative the
    bound is from below: a tangent.
    """
    loose = edge[6]
    low, high = _span(gx, -gz, ca, sa, cb, sb)
    rl, rh, middle = np.sqrt(low * low + gy * gy), np.sqrt(high * high + gy * gy), 0.5 * (low + high)
    slope = (rh - rl) / max(high - low, 1e-12)
    base = max(rl - slope * low, rh - slope * high)
    share = 1.0 / max(np.sqrt(middle * middle + gy * gy), 1e-200)
    return slope + loose * (middle * share - slope), base + loose * (gy * gy * share - base)


@kernel
def swept(edge, offset, line, gx, gz, ca, sa, cb, sb):
    """Return how far a bound goes at most, at any tilt of an interval, along a unit direction of the part, from the centre.

    Lemma M6; `line` as `rim_line` gives it. In one function with it, the two would be too long for the compiler to put into
    loops, which then run one lane at a time.
    """
    q0, f0, q1, f1, grown, _, _ = edge
    slope, base = line
    first, second = q0 * slope - offset, q1 * slope - offset
    first = q0 * base + most(first * gx + f0 * gz, f0 * gx - first * gz, ca, sa, cb, sb)
    second = q1 * base + most(second * gx + f1 * gz, f1 * gx - second * gz, ca, sa, cb, sb)
    return max(first, second) + grown


@kernel
def _put_bound(bound, j, q0, f0, q1, f1, grown, slope):
    bound[j, Q0], bound[j, F0], bound[j, Q1], bound[j, F1] = q0, f0, q1, f1
    bound[j, GROWN], bound[j, SIDE], bound[j, THERE] = grown, slope, 1.0


@kernel
def _bounds_of(piece, k, bound):
    """Write the bounds of piece k."""
    radius, slope, wide = piece[k, RADIUS], piece[k, SLOPE], piece[k, WIDE]
    if piece[k, KIND] != ARC:
        slope = slope if piece[k, KIND] != CYLINDER else 0.0
        _put_bound(bound, 2 * k, max(0.0, radius), piece[k, LOW], max(0.0, wide), piece[k, HIGH], 0.0, slope)
        return
    _put_bound(bound, 2 * k, radius, slope, radius, slope, piece[k, ROUND], 0.0)
    if radius < 0.0 or piece[k, BOTTOM] > slope - piece[k, ROUND] or piece[k, TOP] < slope + piece[k, ROUND]:
        _put_bound(bound, 2 * k + 1, wide, piece[k, BOTTOM], wide, piece[k, TOP], 0.0, 0.0)


@kernel
def flutes(turning, k):
    """Piece k as the eight sides take it."""
    piece = turning.piece
    return Cylinder(turning.offset, piece[k, RADIUS], piece[k, LOW], piece[k, HIGH])


@maker
def turning_of(piece, offset, low, high):
    """Compute the bounds of a tool's pieces in one mode, which posture maps need.

    `piece` (k, COLUMNS) float64. `offset` (float): mm. `low`, `high` (float): tilts that may be requested, rad. Returns as in
    `Turning`.
    """
    count, eight = len(piece), 0
    bound, known = np.zeros((2 * count, BOUNDS)), np.zeros((count, KNOWN))
    for k in range(count):
        _bounds_of(piece, k, bound)
        radius, floor = piece[k, RADIUS], piece[k, LOW]
        bottom, top = piece[k, BOTTOM], piece[k, TOP]
        known[k, NEAR] = max(0.0, max(bottom, -top))
        known[k, LATERAL] = max(piece[k, WIDE], radius)
        known[k, AXIS], known[k, WIDENS] = known[k, LATERAL], 0.0
        if piece[k, KIND] == CONE and piece[k, SLOPE] > 0.0:
            known[k, AXIS], known[k, WIDENS] = radius - piece[k, SLOPE] * floor, piece[k, SLOPE]
        known[k, FAR] = np.hypot(max(abs(bottom), abs(top)), abs(offset) + known[k, LATERAL])
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
                    edge, ca, sa, cb, sb = edge_of(bound, j), np.cos(a), np.sin(a), np.cos(b), np.sin(b)
                    line = rim_line(edge, 0.0, 0.0, -1.0, ca, sa, cb, sb)
                    reach = min(reach, swept(edge, offset, line, 0.0, -1.0, ca, sa, cb, sb))
            deepest = max(deepest, reach)
        known[k, FLOOR] = -deepest - HAIR
    return bound, known, eight


#: Rows of ends: cosine and sine of the first tilt, of the last, of the middle, cosine of half the interval.
CA, SA, CB, SB, CM, SM, CH, ENDS = 0, 1, 2, 3, 4, 5, 6, 7
#: Rows of boxes turned into a rotation's frame: centre, three half sides along f, along t, along n, extent along t, least and
#: largest distance from the line of turning.
AT, ALONG_F, ALONG_T, ALONG_N, EXTENT, NEAREST, FARTHEST, BOXES = 0, 3, 6, 9, 12, 13, 14, 15
#: The direction to a point is taken no nearer to the rim's side than this.
_STEEP = 0.98


@kernel
def _towards(edge, x, y, height):
    """The unit direction (x, y, w), or 0, of a point farthest beyond a bound; its part across the axis; about how far."""
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
def _support(edge, offset, mx, mw, across):
    """Return how far a bound goes along a unit direction of the tool, from the centre."""
    q0, f0, q1, f1, grown, _, _ = edge
    return max(q0 * across + f0 * mw, q1 * across + f1 * mw) + grown - offset * mx


@kernel
def _between(least, reach, my, y_most, nearest, farthest, cosine):
    """Tell whether what lies beyond a plane by `least` at both ends of an interval does so in between (lemma M5, its three
    reasons).

    y_most is the largest of `my y`; `cosine` that of half the interval.
    """
    level, arm = reach - y_most, np.sqrt(max(0.0, 1.0 - my * my))
    return (least > reach + HAIR) & (
        (level >= 0.0) | (-level + HAIR <= arm * nearest * cosine) | (least >= reach + HAIR + arm * farthest * (1.0 - cosine))
    )


@kernel
def _under_rim(edge, y, wide, sine):
    """Return the direction (y, z), of length 1, of a plane under a rim where something stands beside the contact."""
    radius = max(edge[0], HAIR)
    y = y - max(-0.5 * wide, min(0.5 * wide, y))
    y = max(-_STEEP * radius, min(_STEEP * radius, y))
    slope = sine * y / np.sqrt(radius * radius - y * y)
    share = 1.0 / np.sqrt(1.0 + slope * slope)
    return share * slope, -share


@kernel
def _least_of_box(gx, gy, gz, box, lane):
    """Return the least that any point of a box has along a direction of the part."""
    least = gx * box[AT, lane] + gy * box[AT + 1, lane] + gz * box[AT + 2, lane]
    least -= abs(gx * box[ALONG_F, lane] + gy * box[ALONG_T, lane] + gz * box[ALONG_N, lane])
    other = abs(gx * box[ALONG_F + 1, lane] + gy * box[ALONG_T + 1, lane] + gz * box[ALONG_N + 1, lane])
    return least - (other + abs(gx * box[ALONG_F + 2, lane] + gy * box[ALONG_T + 2, lane] + gz * box[ALONG_N + 2, lane]))


@kernel
def _least_of_triangle(gx, gy, gz, seen, lane):
    """Return the least that any point of a triangle has along a direction of the part."""
    first = gx * seen[0, lane] + gy * seen[1, lane] + gz * seen[2, lane]
    other = gx * seen[3, lane] + gy * seen[4, lane] + gz * seen[5, lane]
    return min(first, min(other, gx * seen[6, lane] + gy * seen[7, lane] + gz * seen[8, lane]))


@kernel
def _under(shape, boxes, end, bound, j, offset, clear):
    """Mark boxes, or triangles, under a bound all over their interval, seen along the normal tilted like the rim (lemma M6)."""
    edge = edge_of(bound, j)
    for lane in range(len(clear)):
        ca, sa, cb, sb = end[CA, lane], end[SA, lane], end[CB, lane], end[SB, lane]
        if boxes:
            gy, gz = _under_rim(edge, shape[1, lane], shape[EXTENT, lane], sa)
            least = _least_of_box(0.0, gy, gz, shape, lane)
        else:
            gy, gz = _under_rim(edge, (shape[1, lane] + shape[4, lane] + shape[7, lane]) / 3.0, 0.0, sa)
            least = _least_of_triangle(0.0, gy, gz, shape, lane)
        line = rim_line(edge, 0.0, gy, gz, ca, sa, cb, sb)
        beyond = least - swept(edge, offset, line, 0.0, gz, ca, sa, cb, sb)
        clear[lane] = 1.0 if beyond > HAIR else clear[lane]


@kernel
def _across(shape, boxes, end, bound, j, offset, clear):
    """Mark boxes that a plane across their thin side, or else triangles that their own plane, parts from a bound. Lemma M6."""
    edge = edge_of(bound, j)
    q0, f0, q1, f1, _, _, _ = edge
    up = 0.5 * (f0 + min(f1, f0 + 20.0 * max(q0, q1)))
    for lane in range(len(clear)):
        ca, sa, cb, sb = end[CA, lane], end[SA, lane], end[CB, lane], end[SB, lane]
        cm, sm = end[CM, lane], end[SM, lane]
        x, y, z = shape[0, lane], shape[1, lane], shape[2, lane]
        if boxes:
            ux, uy, uz = shape[ALONG_F, lane], shape[ALONG_T, lane], shape[ALONG_N, lane]
            vx, vy, vz = shape[ALONG_F + 1, lane], shape[ALONG_T + 1, lane], shape[ALONG_N + 1, lane]
        else:
            ux, uy, uz = shape[3, lane] - x, shape[4, lane] - y, shape[5, lane] - z
            vx, vy, vz = shape[6, lane] - x, shape[7, lane] - y, shape[8, lane] - z
        gx, gy, gz = uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx
        # Away from the bound as it stands at the middle of the interval.
        away = gx * (x + offset * cm - up * sm) + gy * y + gz * (z - offset * sm - up * cm)
        share = (1.0 if away >= 0.0 else -1.0) / max(np.sqrt(gx * gx + gy * gy + gz * gz), 1e-200)
        gx, gy, gz = share * gx, share * gy, share * gz
        least = _least_of_box(gx, gy, gz, shape, lane) if boxes else _least_of_triangle(gx, gy, gz, shape, lane)
        line = rim_line(edge, gx, gy, gz, ca, sa, cb, sb)
        beyond = least - swept(edge, offset, line, gx, gz, ca, sa, cb, sb)
        clear[lane] = 1.0 if beyond > HAIR else clear[lane]


@kernel
def _boxes_apart(box, end, bound, j, offset, which, clear):
    """Mark boxes that a plane, as it stands at one end of their interval (row `which` of `end` and the next), parts from a bound.

    All over the interval, turning with the tool (lemma M5) or not (M6).
    """
    edge = edge_of(bound, j)
    for lane in range(len(clear)):
        x, y, z, wide = box[AT, lane], box[AT + 1, lane], box[AT + 2, lane], box[EXTENT, lane]
        c, s = end[which, lane], end[which + 1, lane]
        mx, my, mw, across, _ = _towards(edge, offset + c * x - s * z, y, s * x + c * z)
        reach = _support(edge, offset, mx, mw, across)
        ca, sa, cb, sb = end[CA, lane], end[SA, lane], end[CB, lane], end[SB, lane]
        gx, gz = mx * c + mw * s, mw * c - mx * s
        line = rim_line(edge, gx, my, gz, ca, sa, cb, sb)
        fixed = _least_of_box(gx, my, gz, box, lane) - swept(edge, offset, line, gx, gz, ca, sa, cb, sb)
        first = _least_of_box(mx * ca + mw * sa, my, mw * ca - mx * sa, box, lane)
        last = _least_of_box(mx * cb + mw * sb, my, mw * cb - mx * sb, box, lane)
        good = _between(
            min(first, last), reach, my, my * y + abs(my) * wide, box[NEAREST, lane], box[FARTHEST, lane], end[CH, lane]
        )
        clear[lane] = 1.0 if good | (fixed > HAIR) else clear[lane]


@kernel
def _all(clear):
    least = 1.0
    for lane in range(LANES):
        least = min(least, clear[lane])
    return least > 0.0


@kernel
def boxes_clear(box, end, turning, k, clear):
    """Mark boxes (`turn_boxes`) no point of which is in piece k at any tilt of their interval; whether all are so."""
    known, bound, offset = turning.known, turning.bound, turning.offset
    lateral, base, slope, near, far = known[k, LATERAL], known[k, AXIS], known[k, WIDENS], known[k, NEAR], known[k, FAR]
    for lane in range(len(clear)):
        # No point is higher over the centre than far from the line of turning.
        sideways = min(lateral, base + slope * box[FARTHEST, lane])
        out = max(abs(box[AT + 1, lane]) - box[EXTENT, lane] - sideways, box[NEAREST, lane] - far)
        clear[lane] = 1.0 if max(out, near - box[FARTHEST, lane]) > HAIR else 0.0
    for j in range(2 * k, 2 * k + 2):
        if bound[j, THERE] > 0.0 and not _all(clear):
            _under(box, True, end, bound, j, offset, clear)
            for which in (CB, CA):
                if not _all(clear):
                    _boxes_apart(box, end, bound, j, offset, which, clear)
            if not _all(clear):
                _across(box, True, end, bound, j, offset, clear)
    return _all(clear)


@kernel
def turn_boxes(view, block, cosine, sine, box):
    """Turn a block of boxes, as `tree._see` gives them, into the frame of a rotation."""
    for lane in range(LANES):
        x, y, square = view[block, 0, lane], view[block, 1, lane], 0.0
        box[AT, lane], box[AT + 1, lane], box[AT + 2, lane] = (cosine * x + sine * y, cosine * y - sine * x, view[block, 2, lane])
        wide = 0.0
        for k in range(3):
            f, t, z = view[block, 3 + k, lane], view[block, 6 + k, lane], view[block, 9 + k, lane]
            square += f * f + t * t + z * z
            box[ALONG_F + k, lane], box[ALONG_T + k, lane] = cosine * f + sine * t, cosine * t - sine * f
            box[ALONG_N + k, lane] = z
            wide += abs(cosine * t - sine * f)
        away, half = np.sqrt(box[AT, lane] * box[AT, lane] + box[AT + 2, lane] * box[AT + 2, lane]), np.sqrt(square)
        box[EXTENT, lane], box[NEAREST, lane], box[FARTHEST, lane] = wide, max(0.0, away - half), away + half


@kernel
def _triangles_apart(seen, end, bound, j, offset, which, clear):
    """`_boxes_apart` for triangles, whose corners go along a plane's direction as sums of sine and cosine."""
    edge = edge_of(bound, j)
    for lane in range(len(clear)):
        x0, y0, z0 = seen[0, lane], seen[1, lane], seen[2, lane]
        x1, y1, z1 = seen[3, lane], seen[4, lane], seen[5, lane]
        x2, y2, z2 = seen[6, lane], seen[7, lane], seen[8, lane]
        c, s = end[which, lane], end[which + 1, lane]
        # Where an interval ends, a corner touches the piece: the plane must be the one there.
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
        ca, sa, cb, sb = end[CA, lane], end[SA, lane], end[CB, lane], end[SB, lane]
        line = rim_line(edge, gx, my, gz, ca, sa, cb, sb)
        fixed = over - swept(edge, offset, line, gx, gz, ca, sa, cb, sb)
        p, q = mx * x0 + mw * z0, mw * x0 - mx * z0
        least = d0 - most(-p, -q, ca, sa, cb, sb)
        p, q = mx * x1 + mw * z1, mw * x1 - mx * z1
        least = min(least, d1 - most(-p, -q, ca, sa, cb, sb))
        p, q = mx * x2 + mw * z2, mw * x2 - mx * z2
        least = min(least, d2 - most(-p, -q, ca, sa, cb, sb))
        clear[lane] = 1.0 if max(least - reach, fixed) > HAIR else clear[lane]


@kernel
def triangles_clear(seen, end, turning, k, clear):
    """`boxes_clear` for triangles as `turn_triangles` gives them."""
    known, bound, offset = turning.known, turning.bound, turning.offset
    lateral, base, slope, near, far = known[k, LATERAL], known[k, AXIS], known[k, WIDENS], known[k, NEAR], known[k, FAR]
    for lane in range(len(clear)):
        y0, y1, y2 = seen[1, lane], seen[4, lane], seen[7, lane]
        sideways = min(lateral, base + slope * seen[10, lane])
        out = max(min(y0, min(y1, y2)), -max(y0, max(y1, y2))) - sideways
        out = max(out, seen[9, lane] - far)
        clear[lane] = 1.0 if max(out, near - seen[10, lane]) > HAIR else 0.0
    for j in range(2 * k, 2 * k + 2):
        if bound[j, THERE] > 0.0 and not _all(clear):
            _across(seen, False, end, bound, j, offset, clear)
            for which in (CB, CA):
                if not _all(clear):
                    _triangles_apart(seen, end, bound, j, offset, which, clear)
            if not _all(clear):
                _under(seen, False, end, bound, j, offset, clear)
    return _all(clear)


@kernel
def distances(seen):
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
def turn_triangles(leaf, cosine, sine, seen):
    """Turn the triangles of a leaf, as `tree._see_leaf` gives them, into the frame of a rotation."""
    for k in range(0, 9, 3):
        for lane in range(LANES):
            x, y = leaf[k, lane], leaf[k + 1, lane]
            seen[k, lane], seen[k + 1, lane] = cosine * x + sine * y, cosine * y - sine * x
            seen[k + 2, lane] = leaf[k + 2, lane]
    distances(seen)


@kernel
def put_ends(end, lane, ca, sa, cb, sb):
    """Write an interval shorter than 180 deg into a lane."""
    half = np.sqrt(max(0.0, 0.5 + 0.5 * (ca * cb + sa * sb)))
    share = 0.5 / max(half, 1e-9)
    end[CA, lane], end[SA, lane], end[CB, lane], end[SB, lane] = ca, sa, cb, sb
    end[CM, lane], end[SM, lane], end[CH, lane] = share * (ca + cb), share * (sa + sb), half


@kernel
def all_ends(end, ca, sa, cb, sb):
    """Write an interval into all lanes."""
    put_ends(end, 0, ca, sa, cb, sb)
    for k in range(ENDS):
        for lane in range(1, LANES):
            end[k, lane] = end[k, 0]
