"""Passes at contacts: how wide a strip is, how far the tool's centre runs for it, and how many passes a face takes.

The formulas, and where they come from: `operations/passes.py` and `docs/operations_proof.md`, lemmas O6 and O11.
"""

import math
from collections import namedtuple

import numpy as np

from plan_cutters.kernels.codes import OFFSET_OF, RISE, TILT_FROM, TILT_TO
from plan_cutters.kernels.jit import entry, kernel, maker
from plan_cutters.kernels.linear.vectors import cross, dot

#: Widths beyond this part of the radius are those of a section; curvatures of a plane at most, 1/mm.
_WIDE, PLANE = 0.25, 1e-9
#: Lengths that count as nothing, mm.
NOTHING = 1e-6
#: Halvings by which a section is found.
_HALVINGS = 40
#: Tilts are within a mode up to this, rad; sines below it are that of an axis along the normal.
_HAIR = 1e-9
#: A gap is round within this share, and the centre runs no more than so many times as far as the contact.
_ROUND, _MOST = 1e-6, 50.0

#: How passes are laid, mm: height of the cusps, widest distance; radius and flat of the tool, distance of its passes on a floor;
#: path that takes as long as a link; the feed, mm/s. And whether the tool turns with the surface.
Laid = namedtuple("Laid", "scallop most radius flat flat_apart link speed turning")
#: A contact: normal, direction of the larger curvature, and across both (3,); the curvatures; the tool axis (3,).
Contact = namedtuple("Contact", "normal direction second high low axis")
#: Of the part of a tip that touches: how far its centre of curvature is off the axis, and its radius, mm; sine of the tilt.
Touch = namedtuple("Touch", "offset radius sine")
#: A workspace of vectors (3,).
_Work = namedtuple("_Work", "f t feed across second dn path arm")


@kernel
def _height(turn, offset, sine, radius):
    """How far aside, and how high over the plane, the line parallel to the ellipse is at an angle of it."""
    tall = offset * sine
    along, up = tall * math.sin(turn), offset * math.cos(turn)
    size = max(math.hypot(along, up), 1e-300)
    return offset * math.sin(turn) + radius * along / size, radius + tall * (1.0 - math.cos(turn)) - radius * up / size


@kernel
def _parallel(touch, scallop):
    """Width of a bull nose on a plane, fed along its tilt: by the line parallel to its circle's ellipse at the corner radius."""
    low, high = 0.0, 0.5 * math.pi
    for _ in range(_HALVINGS):
        turn = 0.5 * (low + high)
        if _height(turn, touch.offset, touch.sine, touch.radius)[1] < scallop:
            low = turn
        else:
            high = turn
    return 2.0 * _height(low, touch.offset, touch.sine, touch.radius)[0]


@kernel
def _circle(radius, curvature, scallop):
    """Width of the part of a circle or line that a ball leaves within the scallop height, along the surface."""
    if abs(curvature) * radius < 1e-4:
        return 2.0 * radius if scallop >= radius else 2.0 * math.sqrt(max(0.0, 2.0 * radius * scallop - scallop**2))
    c = -1.0 / curvature
    # By the sine of a quarter of the arc: the cosine of half of it loses its digits where the circle is nearly flat.
    square = scallop * (2.0 * radius - scallop) / (4.0 * (c + radius) * (c + scallop))
    return 4.0 * abs(c) * math.asin(math.sqrt(min(1.0, max(0.0, square))))


@kernel
def _width(free, first, other, touch, laid):
    """Width of a pass by the radius of a ball that leaves the same gap; where it is wide for the tool, by its section."""
    width = 2.0 * math.sqrt(2.0 * laid.scallop * max(0.0, free))
    if math.isinf(width) or not (width > _WIDE * laid.radius or touch.offset == 0.0):
        return min(laid.most, width)
    if touch.offset == 0.0:
        width = _circle(touch.radius, first, laid.scallop)
    elif touch.offset > 0.0 and touch.radius > 0.0 and max(abs(first), abs(other)) <= PLANE:
        width = _parallel(touch, laid.scallop)
    else:
        # The ellipse of the largest half width: w^2 = w2^2 - (w2 / 2)^4 / a^2, until its sides are reached.
        half = max(abs(touch.radius + touch.offset), touch.radius)
        flat = width >= math.sqrt(8.0) * half
        width = 2.0 * half if flat else width * math.sqrt(max(0.0, 1.0 - (0.25 * width / half) ** 2))
    return min(laid.most, width)


@kernel
def touch_at(at, mode, work):
    """Find what of a tip touches at a contact, nan where nothing does; the unit direction in which the tool leans is written."""
    cosine = min(1.0, max(-1.0, dot(at.normal, at.axis)))
    for k in range(3):
        work.f[k] = at.axis[k] - cosine * at.normal[k]
    sine = math.sqrt(dot(work.f, work.f))
    tilt = math.atan2(sine, cosine)
    for k in range(3):
        work.f[k] = work.f[k] / sine if sine > _HAIR else at.direction[k]
    for k in range(len(mode)):
        if mode[k, TILT_FROM] - _HAIR <= tilt <= mode[k, TILT_TO] + _HAIR:
            return Touch(mode[k, OFFSET_OF], mode[k, RISE], sine)
    return Touch(np.nan, np.nan, sine)


@kernel
def strip_at(at, touch, laid, work):
    """The widest strip at a contact where the tool touches; its feed direction is written.

    Returns its width, and that of the strip fed at right angles, mm; the radius of a ball that leaves the same gap, infinite
    where curvatures match; whether it is as wide in all feed directions.
    """
    f, t, feed, offset, radius = work.f, work.t, work.feed, touch.offset, touch.radius
    cross(at.normal, f, t)
    wide = radius if offset == 0.0 else radius + offset / touch.sine
    wide = 1e12 if math.isinf(wide) else wide
    # The second fundamental form in the frame of f and n x f, concave positive.
    c, s = dot(f, at.direction), dot(at.second, f)
    form, side, over = at.high * c**2 + at.low * s**2, (at.low - at.high) * s * c, at.high * s**2 + at.low * c**2
    # D, and the inverse of it, made symmetric; with no negative zero, which would turn the feed round.
    a, b, d, e = 1.0 - radius * form, -(radius * side), -(wide * side), 1.0 - wide * over
    det, trace = a * e - b * d, a + e
    first, both, last = e * radius / det, 0.5 * (-b * wide / det - d * radius / det) + 0.0, a * wide / det
    known = math.isfinite(first) and math.isfinite(both) and math.isfinite(last)
    middle, half, both = (0.5 * (first + last), 0.5 * (first - last), both) if known else (0.0, 0.0, 0.0)
    apart = math.hypot(half, both)
    largest = middle + apart
    # The eigenvector of the largest lies at half the angle of (half, both).
    turn = 0.5 * math.atan2(both, half)
    c, s = math.cos(turn), math.sin(turn)
    for k in range(3):
        feed[k] = c * t[k] - s * f[k]
    # Where D is not positive the curvatures match within the tolerance: the strip is as wide as is allowed.
    matched = not (det > 0.0 and largest > 0.0 and trace > 0.0)
    free, other = (np.inf, largest) if matched else (largest, max(0.0, first + last - largest))
    width, narrow = _width(free, at.high, at.low, touch, laid), _width(other, at.low, at.high, touch, laid)
    return width, narrow, free, apart <= _ROUND * abs(largest)


@kernel
def _run(at, feed, touch, turning, work):
    """How far the centre of a tool runs for each mm that its contact runs along a feed direction; 0 where it stands still.

    A contact p with the normal n is cut by a circle of the corner: its centre is p + r n, and the axis is o farther along h, the
    unit part of n across the axis. So the centre runs by t + r dn + o dh where the contact runs by t. At a fixed axis h turns
    with n; where the tool turns with the surface, both turn by n x dn, and with them the way from the centre of the tip to the
    contact.
    """
    h, dn, path, arm = work.across, work.dn, work.path, work.arm
    cosine = dot(at.normal, at.axis)
    for k in range(3):
        h[k] = at.normal[k] - cosine * at.axis[k]
    sine = math.sqrt(dot(h, h))
    o, r, upright = touch.offset, touch.radius, sine <= _HAIR
    one, two = dot(feed, at.direction), dot(feed, at.second)
    for k in range(3):
        h[k] /= max(sine, 1e-300)
        dn[k] = -(at.high * one * at.direction[k] + at.low * two * at.second[k])
    if turning:
        for k in range(3):
            arm[k] = r * at.normal[k] + (0.0 if upright else o * h[k]) - (0.0 if o == 0.0 else r * at.axis[k])
        cross(at.normal, dn, path)
        cross(path, arm, dn)
        for k in range(3):
            path[k] = feed[k] + dn[k]
        return min(math.sqrt(dot(path, path)), _MOST)
    # Under the flat of a tip any of its points may touch.
    if upright and o != 0.0:
        return min(math.sqrt(dot(feed, feed)), _MOST)
    lifted = dot(dn, at.axis)
    for k in range(3):
        arm[k] = dn[k] - lifted * at.axis[k]
    out = dot(arm, h)
    for k in range(3):
        path[k] = feed[k] + r * dn[k] + (0.0 if upright else o * ((arm[k] - out * h[k]) / max(sine, _HAIR)))
    return min(math.sqrt(dot(path, path)), _MOST)


@kernel
def _sector(at, way, many):
    """Find the nearest to one of the directions in which faces are measured, so many over half a turn."""
    turn = math.atan2(dot(way, at.second), dot(way, at.direction))
    return int(np.rint(turn * (many / math.pi))) % many if math.isfinite(turn) else 0


@kernel
def _passes(at, feed, sectors, apart, floor, touch, laid, length, turns, work):
    """Find what passes in a feed direction take: the strip, the path, links, by how much the feed is to be divided so that rotary
    axes follow, and what a mm of path cuts.

    `sectors`: of the directions in which faces are measured, that of the feed and that across it. `turns`: as in `cuts`.
    """
    kind, (which, across) = 0 if floor else 1, sectors
    breadth, long = length[kind, across], length[kind, which]
    # On a floor the outer passes cut all of the flat.
    count = math.ceil((breadth - (laid.flat if floor else apart)) / apart - NOTHING) + 1.0
    share = breadth / max(1.0, count)
    strip = share if math.isfinite(share) and apart > 0.0 else apart
    run, needed = 1.0 if floor else _run(at, feed, touch, laid.turning, work), 0.0
    path = run / strip
    links = 1.0 / (strip * long) if math.isfinite(long) else 0.0
    for k in range(len(turns)):
        needed = max(needed, abs(dot(turns[k], feed)))
    slower = max(1.0, needed * laid.speed / max(run, NOTHING))
    return strip, path, links, slower, 1.0 / (path * slower + laid.link * links)


@maker
def workspace():
    """Make room for vectors."""
    each = np.empty((8, 3))
    return _Work(each[0], each[1], each[2], each[3], each[4], each[5], each[6], each[7])


@entry
def centre_paths(axis, feed, contacts, offset, radius, turning, path):
    """Find how far the centre runs for each mm that the contact does.

    `axis`, `feed` (n, 3) float64: unit tool axes at contacts (n,), and feed directions in the surface.
    `offset`, `radius` (n,) float64: of the part of the tip that touches, mm. `turning`: simultaneous motion.
    `path` (n,) float64, written.
    """
    work = workspace()
    for i in range(len(axis)):
        normal, direction, bend = contacts.normal[i], contacts.direction_max[i], contacts.curvature[i]
        cross(normal, direction, work.second)
        at = Contact(normal, direction, work.second, bend[0], bend[1], axis[i])
        path[i] = _run(at, feed[i], Touch(offset[i], radius[i], 0.0), turning, work)


@entry
def cuts(rows, axis, contacts, mode, laid, length, floor, turns, strip, path, links, slower):
    """Find what passes by the tip take.

    `rows` (m,) int64: contacts, and `axis` (m, 3) float64: the tool axis at each, unit or nan.
    `mode` (k, 5) float64: the parts of the tip that touch. `laid` (Laid).
    `length` (3, n, d) float64: of the faces at contacts, mm: what goes on, that with what it goes on onto, and all of it, in
      directions over half a turn; nan: not known.
    `floor` (m,) bool: where the flat of the tip lies on a floor.
    `turns` (m, k, 3) float64: times a unit feed direction the seconds that each of k rotary axes needs for a mm of the contact's
      path; no axis: none is too slow.
    `strip`, `path`, `links`, `slower` (m,) float64, written: width that a pass cuts, mm; length of the centre's path for each
      mm2, 1/mm; passes for each mm2, 1/mm2; by how much the feed is to be divided; nan where the tool does not touch.
    """
    work, many = workspace(), length.shape[2]
    before, was = -1, Touch(np.nan, np.nan, 0.0)
    for i in range(len(rows)):
        row = rows[i]
        normal, direction, bend, own = contacts.normal[row], contacts.direction_max[row], contacts.curvature[row], length[:, row]
        cross(normal, direction, work.second)
        at = Contact(normal, direction, work.second, bend[0], bend[1], axis[i])
        touch = touch_at(at, mode, work)
        # A ball cuts the same however it leans; axes for simultaneous motion are many at each contact.
        alike = row == before and touch.offset == 0.0 and was.offset == 0.0 and touch.radius == was.radius
        if laid.turning and alike and not turns.shape[1]:
            strip[i], path[i], links[i], slower[i] = strip[i - 1], path[i - 1], links[i - 1], slower[i - 1]
            continue
        before, was = row, touch
        if math.isnan(touch.radius):
            strip[i] = path[i] = links[i] = slower[i] = np.nan
            continue
        width, narrow, _, round_gap = strip_at(at, touch, laid, work)
        either, which, longest = floor[i] or round_gap, 0, 0.0
        if either:
            # Passes go on farthest then.
            for k in range(many):
                if own[1, k] > longest:
                    which, longest = k, own[1, k]
            turn = which * (math.pi / many)
            for k in range(3):
                work.feed[k] = math.cos(turn) * direction[k] + math.sin(turn) * work.second[k]
        cross(normal, work.feed, work.t)
        sectors = _sector(at, work.feed, many), _sector(at, work.t, many)
        apart = laid.flat_apart if floor[i] else width
        wide = _passes(at, work.feed, sectors, apart, floor[i], touch, laid, own, turns[i], work)
        strip[i], path[i], links[i], slower[i] = wide[:4]
        # The centre may run less far in narrower strips: along a round edge and not across it.
        if not either and narrow > 0.0:
            cross(normal, work.t, work.f)
            sectors = sectors[1], _sector(at, work.f, many)
            other = _passes(at, work.t, sectors, narrow, False, touch, laid, own, turns[i], work)
            if other[4] > wide[4]:
                strip[i], path[i], links[i], slower[i] = other[:4]
