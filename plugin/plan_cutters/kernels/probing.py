"""What searches of all kinds share: intervals of tilt that are left, what is taken out of them, what a body is stopped by."""

from typing import Any, NamedTuple

import numpy as np

from plan_cutters.kernels.arcs import axis_arcs, local_gouge, point_arc
from plan_cutters.kernels.hit import BODY, HIGH, OFFSET, A, P, X, dot, lean_frame, scratch, stand, tree_hit
from plan_cutters.kernels.jit import entry, kernel
from plan_cutters.kernels.material import outside, winding
from plan_cutters.kernels.rows import Scratch

# As in `plan_cutters.domain.verdicts`, which must not load the compiler; a test holds them together.
AXIS_LIMIT, LOCAL_GOUGE, REAR_GOUGE, COLLISION, BURIED, ATTRIBUTES = 0, 1, 2, 3, 4, 5

#: A posture stands for the tilts that are so near, rad: no machine holds a tilt to 0.01 deg.
NARROWEST = 1.7e-4
#: Intervals that one rotation may fall into; widest first, a search has not been seen to need ten.
_ROOM = 256
#: By how much a posture within a body is turned to find the others there, at first, rad.
_TURN = 0.2


@kernel
def remove(intervals, count, first, last, narrowest):  # type: ignore[no-untyped-def]
    """Take [first, last] out of sorted intervals in place, drop what is narrower than `narrowest`; the new count."""
    kept = 0
    for row in range(count):
        low, high = intervals[row, 0], intervals[row, 1]
        if last <= low or first >= high:
            intervals[kept, 0], intervals[kept, 1] = low, high
            kept += 1
            continue
        below, above = first - low >= narrowest, high - last >= narrowest
        if below and above and kept == row:
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
            intervals[kept, 0], intervals[kept, 1] = low, first
            kept += 1
        if above:
            intervals[kept, 0], intervals[kept, 1] = last, high
            kept += 1
    return kept


@kernel
def forbid(intervals, count, first, last, narrowest, attribute, tally):  # type: ignore[no-untyped-def]
    """Take an arc out and book what it takes on an attribute; the new count."""
    before = 0.0
    for i in range(count):
        before += intervals[i, 1] - intervals[i, 0]
    count = remove(intervals, count, first, last, narrowest)
    for i in range(count):
        before -= intervals[i, 1] - intervals[i, 0]
    tally[attribute] += before
    return count


@kernel
def _attribute(x, y, z, radius):  # type: ignore[no-untyped-def]
    """What an obstacle point that far from the contact is in the way of."""
    return REAR_GOUGE if x * x + y * y + z * z <= 4.0 * radius * radius else COLLISION


@kernel
def inner_height(radius, length):  # type: ignore[no-untyped-def]
    """Height of the point of the cutter's axis that is asked for whether the cutter lies within a body.

    As near to the spindle as it can be while no other point of the cutter is farther from its outside.
    """
    return max(0.5 * length, length - radius)


@kernel
def inside(body, height, solids, stack):  # type: ignore[no-untyped-def]
    """Winding number of the bodies about the point of a body's axis at a height over the contact.

    The end of the axis is asked first: where that is surely outside, all of it is.
    """
    high = body[HIGH]
    x = body[P] + high * body[A] - body[OFFSET] * body[X]
    y = body[P + 1] + high * body[A + 1] - body[OFFSET] * body[X + 1]
    z = body[P + 2] + high * body[A + 2] - body[OFFSET] * body[X + 2]
    if outside(x, y, z, solids):
        return 0.0
    x = body[P] + height * body[A] - body[OFFSET] * body[X]
    y = body[P + 1] + height * body[A + 1] - body[OFFSET] * body[X + 1]
    z = body[P + 2] + height * body[A + 2] - body[OFFSET] * body[X + 2]
    return winding(x, y, z, solids, stack)


@kernel
def turned(frame, tilt, tool, tree, body, scratch):  # type: ignore[no-untyped-def]
    """How far a posture that touches nothing can be tilted either way and still surely touch nothing, rad."""
    half = _TURN
    while half > 0.5 * NARROWEST:
        stand(body, frame, np.cos(tilt), np.sin(tilt), tool.radius, tool.shrunk, tool.low, tool.high)
        hit, _, _, _ = tree_hit(tree, body, half, -1, scratch)
        if hit < 0:
            return half
        half *= 0.5
    # No narrower: what is left is the probe's own neighbourhood, as for every other obstacle.
    return 0.5 * NARROWEST


class Room(NamedTuple):
    """Room to work in: intervals (k, 2), lean direction f and t = n x f, e2 = n x direction_max, a body, a tally by attribute."""

    intervals: Any
    f: Any
    t: Any
    e2: Any
    body: Any
    tally: Any
    scratch: Scratch


@entry
def room_to_search():  # type: ignore[no-untyped-def]
    """Room for searches."""
    return Room(
        np.empty((_ROOM, 2)), np.empty(3), np.empty(3), np.empty(3), np.empty(BODY), np.empty(ATTRIBUTES), scratch()
    )


@kernel
def allowed(contacts, row, ranges, rotation, radius, room):  # type: ignore[no-untyped-def]
    """Write the tilts of a rotation that axis limit and local gouging leave, and its frame; how many intervals they are.

    What each of the two leaves is booked on it.
    """
    n, intervals, tally = contacts.normal[row], room.intervals, room.tally
    cosine, sine = ranges.rotation_cos[rotation], ranges.rotation_sin[rotation]
    lean_frame(contacts.direction_max[row], room.e2, cosine, sine, room.f, room.t)
    count = axis_arcs(
        dot(ranges.setup, n), dot(ranges.setup, room.f), ranges.limit_cos, ranges.tilt_low, ranges.tilt_high, intervals
    )
    for i in range(count):
        tally[AXIS_LIMIT] += intervals[i, 1] - intervals[i, 0] + NARROWEST
    least = local_gouge(contacts.curvature[row, 0], contacts.curvature[row, 1], cosine, sine, radius)
    if np.isnan(least):
        return 0
    if least > 0.0:
        count = remove(intervals, count, -1.0, least, 0.0)
    for i in range(count):
        tally[LOCAL_GOUGE] += intervals[i, 1] - intervals[i, 0] + NARROWEST
    return count


@kernel
def forbid_point(x, y, z, tool, narrowest, intervals, count, tally):  # type: ignore[no-untyped-def]
    """Take out the tilts at which an obstacle point, along f, t and n from the contact, is in the cutter; the new count."""
    first, last = point_arc(z, x + tool.radius, y, 0.0, tool.radius, tool.shrunk, tool.low, tool.high)
    if first > last:
        return count
    return forbid(intervals, count, first, last, narrowest, _attribute(x, y, z, tool.radius), tally)


@kernel
def forbid_probed(height, px, py, tilt, tool, narrowest, intervals, count, tally):  # type: ignore[no-untyped-def]
    """The same of a point that a probe at a tilt has met, in the tool's frame; (the new count, the point along f, t, n)."""
    first, last = point_arc(height, px, py, tilt, tool.radius, tool.shrunk, tool.low, tool.high)
    # At the edge of the body the arc may be no wider than rounding: take the probe's own neighbourhood too.
    first, last = min(first, tilt - 0.5 * narrowest), max(last, tilt + 0.5 * narrowest)
    back, cosine, sine = px - tool.radius, np.cos(tilt), np.sin(tilt)
    x, z = cosine * back + sine * height, cosine * height - sine * back
    return forbid(intervals, count, first, last, narrowest, _attribute(x, py, z, tool.radius), tally), x, py, z


@kernel
def next_tilt(intervals, count, wish):  # type: ignore[no-untyped-def]
    """The tilt to probe next: the one wished for where it is left, or the middle of the widest interval."""
    widest, tilt = -1.0, 0.0
    for i in range(count):
        if intervals[i, 0] <= wish <= intervals[i, 1]:
            widest, tilt = 10.0, wish
        elif intervals[i, 1] - intervals[i, 0] > widest:
            widest = intervals[i, 1] - intervals[i, 0]
            tilt = 0.5 * (intervals[i, 0] + intervals[i, 1])
    return tilt
