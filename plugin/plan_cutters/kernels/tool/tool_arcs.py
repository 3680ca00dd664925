"""Ranges of tilt that one obstacle point forbids, piece by piece, in closed form where there is one.

Turning the tool about the line through its centre along y_T keeps a point's distance d from that line and shifts its angle
`alpha`, counted from the direction centre -> axis towards the spindle. The point then stands `offset - d cos(alpha)` from the
axis along x_T and at the height `d sin(alpha)`. Arcs may be too short, never too long: "inaccessible" rests on them.
"""

import numpy as np

from plan_cutters.kernels.codes import ARC, BOTTOM, CONE, CYLINDER, HIGH, KIND, LOW, RADIUS, ROUND, SLOPE, TOP, WIDE
from plan_cutters.kernels.jit import kernel
from plan_cutters.kernels.tool.arcs import point_arc
from plan_cutters.kernels.tool.pieces import inset

#: Most arcs of one piece.
ARCS = 16
#: Steps either way in which an arc without a closed form is found, and the least step, rad.
_STEPS, _LEAST = 24, 1e-6


@kernel
def _put(out, count, first, last):
    """Enter tilts, and those a turn away, as far as a tilt can be requested."""
    for turn in range(-1, 2):
        low, high = first + 2.0 * np.pi * turn, last + 2.0 * np.pi * turn
        if high >= 0.0 and low <= np.pi and count < len(out):
            out[count, 0], out[count, 1] = low, high
            count += 1
    return count


@kernel
def _half(out, count, zero, low, high, d, floor, ceiling, up):
    """Enter the tilts of cosines of alpha between two bounds and heights between two, on one half turn; `zero` the tilt of alpha
    0.
    """
    least, most = (floor / d, ceiling / d) if up > 0.0 else (-ceiling / d, -floor / d)
    least, most = max(least, 0.0), min(most, 1.0)
    if least >= most:
        return count
    wide, narrow = np.sqrt(1.0 - least * least), np.sqrt(max(0.0, 1.0 - most * most))
    for part in range(2):
        if narrow > 0.0:
            first, last = (max(low, -wide), min(high, -narrow)) if part == 0 else (max(low, narrow), min(high, wide))
        elif part == 0:
            first, last = max(low, -wide), min(high, wide)
        else:
            break
        first, last = max(first, -1.0), min(last, 1.0)
        if last <= first:
            continue
        small, large = np.arccos(last), np.arccos(first)
        count = _put(out, count, zero - up * (large if up > 0.0 else small), zero - up * (small if up > 0.0 else large))
    return count


@kernel
def _cylinder(out, count, zero, d, y, offset, radius, floor, ceiling):
    """Write the arcs of tilts that a cylinder about the axis forbids, of any radius and between any heights; the new count."""
    square = radius * radius - y * y
    if square <= 0.0 or radius <= 0.0 or floor >= ceiling:
        return count
    r = np.sqrt(square)
    for up in (1.0, -1.0):
        count = _half(out, count, zero, (offset - r) / d, (offset + r) / d, d, floor, ceiling, up)
    return count


@kernel
def _own_arc(out, count, zero, d, y, radius, ring_radius, floor, ceiling):
    """Write the tilts that a revolved arc forbids, whose circle of centres goes through the centre of tilting; the new count.

    `radius` may have any sign.
    """
    for up in (1.0, -1.0):
        if radius == 0.0:
            if d * d + y * y < ring_radius * ring_radius:
                count = _half(out, count, zero, -1.0, 1.0, d, floor, ceiling, up)
            continue
        level = (d * d + y * y - ring_radius * ring_radius) / (2.0 * radius)
        if radius < 0.0:
            if level > 0.0:
                last = (radius - (y * y - level * level) / (2.0 * level)) / d
                count = _half(out, count, zero, -1.0, last, d, floor, ceiling, up)
            continue
        first = -1.0 if level <= 0.0 else (radius - (y * y - level * level) / (2.0 * level)) / d
        count = _half(out, count, zero, first, 1.0, d, floor, ceiling, up)
        square = radius * radius - y * y
        if square > 0.0 and first > -1.0:
            # Within the disk only its thickness counts.
            r = np.sqrt(square)
            low, high = (radius - r) / d, min((radius + r) / d, first)
            side = np.sqrt(max(0.0, 1.0 - (ring_radius / d) ** 2)) if d > ring_radius else 0.0
            if side == 0.0:
                count = _half(out, count, zero, low, high, d, floor, ceiling, up)
            else:
                count = _half(out, count, zero, max(low, side), high, d, floor, ceiling, up)
                count = _half(out, count, zero, low, min(high, -side), d, floor, ceiling, up)
    return count


@kernel
def forbidden(height, px, py, tilt, offset, piece, k, out):
    """Write tilts at which a point is in piece k, the rotation held; how many arcs.

    Parameters
    ----------
    height, px, py : float
        The point at `tilt`, in the tool's frame: height over the centre, x and y from the axis, mm.
    tilt : float
        rad.
    offset : float
        Distance of the centre from the axis, mm.
    piece : (k, COLUMNS) float64
    out : (ARCS, 2) float64, written
        First and last tilts of arcs, rad; what lies beyond 0 to pi may be missing.
    """
    kind, radius, low, high = piece[k, KIND], piece[k, RADIUS], piece[k, LOW], piece[k, HIGH]
    if kind == CYLINDER and low >= 0.0 and radius <= offset:
        out[0, 0], out[0, 1] = point_arc(height, px, py, tilt, offset, radius, low, high)
        return 1 if out[0, 0] <= out[0, 1] else 0
    back = offset - px
    d = np.sqrt(back * back + height * height)
    if d == 0.0:
        return 0
    # What turns no nearer to the piece than this is out of reach at every tilt.
    if d <= piece[k, BOTTOM] or d <= -piece[k, TOP]:
        return 0
    zero = tilt + np.arctan2(height, back)
    if kind == CYLINDER:
        return _cylinder(out, 0, zero, d, py, offset, radius, low, high)
    if kind == CONE:
        # The cylinder within it.
        return _cylinder(out, 0, zero, d, py, offset, min(radius, piece[k, WIDE]), low, high)
    centre, ring_radius = piece[k, SLOPE], piece[k, ROUND]
    if centre == 0.0 and radius == offset:
        return _own_arc(out, 0, zero, d, py, radius, ring_radius, low, high)
    if radius > 0.0:
        return _cylinder(out, 0, zero, d, py, offset, radius, piece[k, BOTTOM], piece[k, TOP])
    return 0


@kernel
def arc_about(height, px, py, tilt, offset, piece, k):
    """First and last of the tilts about one at which a point is in piece k, by steps no longer than its depth allows."""
    back = offset - px
    d = np.sqrt(back * back + height * height)
    if d == 0.0:
        return 0.0, np.pi
    alpha = np.arctan2(height, back)
    ends = (tilt, tilt)
    for way in (-1.0, 1.0):
        turned = 0.0
        for _ in range(_STEPS):
            angle = alpha - way * turned
            x = offset - d * np.cos(angle)
            step = inset(piece, k, d * np.sin(angle), x * x + py * py) / d
            if not step > _LEAST or turned > 2.0 * np.pi:
                break
            turned += step * (1.0 - 1e-12)
        ends = (tilt - turned, ends[1]) if way < 0.0 else (ends[0], tilt + turned)
    return ends


@kernel
def closed(offset, piece, k):
    """Whether `forbidden` has the exact arcs of a piece."""
    kind = piece[k, KIND]
    return kind == CYLINDER or (kind == ARC and piece[k, SLOPE] == 0.0 and piece[k, RADIUS] == offset)
