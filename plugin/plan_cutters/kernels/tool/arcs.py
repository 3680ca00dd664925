"""Compute ranges of tilt in closed form: those that an obstacle point forbids, and that a local gouge or an axis limit leaves.

Turning the tool about the line through its centre along y_T keeps a point's distance d from that line and shifts its angle
`alpha`, counted from the direction centre -> axis towards the spindle. The point then stands `offset - d cos(alpha)` from the
axis along x_T and at the height `d sin(alpha)`. Arcs may be too short, never too long: "inaccessible" rests on them.

Sorted intervals of tilt are rows (first, last) of an array with spare ones at its end; `domain.posture` does the same with arrays
of their own, a test holds the two against each other. Those whose ends are known only to a band are in `maps.passes`.
"""

import numpy as np

from plan_cutters.kernels.codes import ARC, BOTTOM, CONE, CYLINDER, HIGH, KIND, LOW, RADIUS, ROUND, SLOPE, TOP, WIDE
from plan_cutters.kernels.jit import kernel
from plan_cutters.kernels.tool.pieces import inset

#: A bound this close to zero is zero: planes and ridges are free at tilt 0.
ROUNDING = 1e-9

#: No arc: empty, and beyond every tilt both ways, so that widening it about a tilt gives that tilt's neighbourhood.
NOTHING = (9.0, -9.0)

#: Cosines this close to an axis limit are on it: a limit of 0 deg leaves the setup axis itself, which rounding moves.
#: 1e-6 rad at that limit, less at any other.
ON_LIMIT = 5e-13


@kernel
def point_arc(height, px, py, tilt, radius_offset, radius, low, high):
    """Tilts at which an obstacle point lies in the cylinder, the rotation held.

    Turning the tool about the line through P along y_T keeps the point's distance d from P across that line and
    shifts its polar angle `alpha` about P, counted from the direction P -> bottom centre towards the spindle. The
    point is inside while `|d cos(alpha) - offset| < sqrt(radius^2 - py^2)` and `low < d sin(alpha) < high`.

    `height`, `px`, `py` (float): the point at `tilt`: height along the axis from P, x and y from the cylinder's axis, mm. `tilt`
    (float): rad. `radius_offset`, `radius`, `low`, `high` (float): distance of the axis from P, radius, solid heights; `low >=
    0`, `radius <= radius_offset`, mm. A body without volume (`radius <= 0` or `low >= high`) forbids nothing. Returns `first`,
    `last` (float): the forbidden tilts, rad; `NOTHING` if there are none. One arc suffices: with the radius no larger than the
    offset, alpha stays within 0 to 90 deg, where the top cuts off one end only.
    """
    square = radius * radius - py * py
    if square <= 0.0 or radius <= 0.0 or low >= high:
        return NOTHING
    r = np.sqrt(square)
    back = radius_offset - px
    d = np.sqrt(back * back + height * height)
    if d <= low or d <= radius_offset - r:
        return NOTHING
    alpha = np.arctan2(height, back)
    least = np.arcsin(low / d)
    most = np.arccos((radius_offset - r) / d)
    if d > radius_offset + r:
        least = max(least, np.arccos((radius_offset + r) / d))
    if d > high:
        most = min(most, np.arcsin(high / d))
    if least > most:
        return NOTHING
    return tilt + alpha - most, tilt + alpha - least


@kernel
def local_gouge(kappa_max, kappa_min, cosine, sine, offset, radius):
    """Tilts without local gouging at a rotation, from and to, rad; nan if there are none.

    A tool that touches with a centre of curvature `offset` from its axis and a radius of curvature there, mm, curves by 1 /
    radius along the tilt direction and by sin(tilt) / (offset + radius sin(tilt)) across it; the surface may nowhere curve more.
    With a negative offset, a barrel, that is an upper bound of the tilt; the tilts beyond 90 deg that it would leave again are
    not given.
    """
    across = kappa_max * sine * sine + kappa_min * cosine * cosine
    if radius > 0.0:
        along = kappa_max * cosine * cosine + kappa_min * sine * sine
        if offset == 0.0:
            return (0.0, np.pi) if radius * kappa_max <= 1.0 + ROUNDING else (np.nan, np.nan)
        mixed = (kappa_max - kappa_min) * sine * cosine
        margin = 1.0 - radius * along
        if margin <= 0.0:
            return np.nan, np.nan
        across += mixed * mixed * radius / margin
        remainder = 1.0 - radius * across
        if offset < 0.0:
            if remainder >= 0.0:
                return 0.0, np.pi
            bound = offset * across / remainder
            return 0.0, np.arcsin(bound) if bound < 1.0 else np.pi
        if remainder <= 0.0:
            return (0.0, np.pi) if across <= 0.0 else (np.nan, np.nan)
        across /= remainder
    bound = offset * across
    if bound <= ROUNDING:
        return 0.0, np.pi
    if bound > 1.0:
        return np.nan, np.nan
    return np.arcsin(bound), np.pi - np.arcsin(bound)


@kernel
def axis_arcs(along_n, along_f, limit_cos, low, high, out):
    """Tilts within [low, high] whose axis stays within a cone about the setup axis m.

    `along_n`, `along_f` (float): m . n and m . f. `limit_cos` (float): cosine of the cone's half angle; -1 or less: no limit.
    Kept to `ON_LIMIT`. `low`, `high` (float): range asked for, rad, within 0 to pi/2. `out` (3, 2) float64: written: the
    intervals, ascending.
    """
    if limit_cos <= -1.0:
        out[0, 0], out[0, 1] = low, high
        return 1
    limit_cos -= ON_LIMIT
    amplitude = np.hypot(along_n, along_f)
    if amplitude <= abs(limit_cos):
        # m is nearly across the great circle: all of it within the cone or none.
        if limit_cos <= 0.0:
            out[0, 0], out[0, 1] = low, high
            return 1
        return 0
    middle = np.arctan2(along_f, along_n)
    half = np.arccos(limit_cos / amplitude)
    count = 0
    for turn in range(-1, 2):
        first = max(low, middle + 2.0 * np.pi * turn - half)
        last = min(high, middle + 2.0 * np.pi * turn + half)
        if first <= last:
            out[count, 0], out[count, 1] = first, last
            count += 1
    return count


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
    """Enter tilts, on one half turn, of cosines of alpha and heights between two each; `zero`: the tilt of alpha 0."""
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
    """Write the tilts that a revolved arc forbids whose centres go through that of tilting, of any radius; the new count."""
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

    `height`, `px`, `py` (float): the point at `tilt`, in the tool's frame: height over the centre, x and y from the axis, mm.
    `tilt` (float): rad.
    `offset` (float): distance of the centre from the axis, mm.
    `piece` (k, COLUMNS) float64.
    `out` (ARCS, 2) float64, written: first and last tilts of arcs, rad; what lies beyond 0 to pi may be missing.
    """
    kind, radius, low, high = piece[k, KIND], piece[k, RADIUS], piece[k, LOW], piece[k, HIGH]
    back, wide, far = offset - px, max(radius, piece[k, WIDE]), max(abs(piece[k, BOTTOM]), abs(piece[k, TOP]))
    square = back * back + height * height
    # What turns past the piece beside it, or farther out than all of it, is out of reach at every tilt.
    if abs(py) >= wide or square > (abs(offset) + wide) * (abs(offset) + wide) + far * far:
        return 0
    if kind == CYLINDER and low >= 0.0 and radius <= offset:
        out[0, 0], out[0, 1] = point_arc(height, px, py, tilt, offset, radius, low, high)
        return 1 if out[0, 0] <= out[0, 1] else 0
    d = np.sqrt(square)
    # What turns no nearer to the piece than this is so, too.
    if d == 0.0 or d <= piece[k, BOTTOM] or d <= -piece[k, TOP]:
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


@kernel
def remove(intervals, count, first, last, narrowest):
    """Take [first, last] out of sorted intervals in place, drop what is narrower than `narrowest`; the new count."""
    written = 0
    for row in range(count):
        low, high = intervals[row, 0], intervals[row, 1]
        if last <= low or first >= high:
            intervals[written, 0], intervals[written, 1] = low, high
            written += 1
            continue
        below, above = first - low >= narrowest, high - last >= narrowest
        if below and above and written == row:
            # One interval becomes two: those after it, all above `last`, move up.
            if count == len(intervals):
                below = first - low > high - last
                above = not below
            else:
                for k in range(count, row, -1):
                    intervals[k, 0], intervals[k, 1] = intervals[k - 1, 0], intervals[k - 1, 1]
                intervals[row, 1] = first
                intervals[row + 1, 0] = last
                return count + 1
        if below:
            intervals[written, 0], intervals[written, 1] = low, first
            written += 1
        if above:
            intervals[written, 0], intervals[written, 1] = last, high
            written += 1
    return written


@kernel
def insert(intervals, count, first, last):
    """Put [first, last] among sorted intervals, which may overlap; the new count."""
    at = count
    while at > 0 and intervals[at - 1, 0] > first:
        intervals[at, 0], intervals[at, 1] = intervals[at - 1, 0], intervals[at - 1, 1]
        at -= 1
    intervals[at, 0], intervals[at, 1] = first, last
    return count + 1


@kernel
def join(intervals, count):
    """Join intervals, ascending, that touch; how many are left."""
    written = min(count, 1)
    for i in range(1, count):
        if intervals[i, 0] <= intervals[written - 1, 1]:
            intervals[written - 1, 1] = max(intervals[written - 1, 1], intervals[i, 1])
        else:
            intervals[written, 0], intervals[written, 1] = intervals[i, 0], intervals[i, 1]
            written += 1
    return written
