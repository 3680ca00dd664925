"""Is there a posture? Probe a tilt; whatever is in the way forbids a whole arc; probe what is left.

A found posture is safe: no triangle reaches deeper into the cutter than `safe`. Where none is found, the same search
at the depth `blocked` decides whether the sample is inaccessible (everything is forbidden by what certainly lies too
deep) or undecided. A cutter that touches nothing may still lie within a body: then so does every posture that it can be
turned to without touching a skin.
"""

from typing import Any, NamedTuple

import numpy as np

from plan_cutters.kernels.arcs import axis_arcs, local_gouge, point_arc
from plan_cutters.kernels.hit import (
    BODY,
    HIGH,
    OFFSET,
    A,
    P,
    X,
    cross,
    dot,
    lean_frame,
    perpendicular,
    scratch,
    stand,
    tree_hit,
)
from plan_cutters.kernels.jit import entry, kernel
from plan_cutters.kernels.material import MAYBE_INSIDE, SURELY_INSIDE, outside, winding
from plan_cutters.kernels.rows import Frame, Scratch, Tool

# As in `plan_cutters.domain.verdicts`, which must not load the compiler; a test holds them together.
INACCESSIBLE, ACCESSIBLE, INTERFERENCE_FREE, UNDECIDED, UNJUDGED = 0, 1, 2, 3, 255
AXIS_LIMIT, LOCAL_GOUGE, REAR_GOUGE, COLLISION, BURIED, ATTRIBUTES = 0, 1, 2, 3, 4, 5

#: Gaps narrower than this are not searched: no machine holds a tilt to 0.01 deg. rad.
NARROWEST = 1.7e-4
#: Intervals that one rotation may fall into; widest first, a search has not been seen to need ten.
_ROOM = 256
#: Obstacle points remembered from probe to probe.
_KNOWN = 16
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
def _forbid(intervals, count, first, last, attribute, tally):  # type: ignore[no-untyped-def]
    """Take an arc out and book what it takes on an attribute; the new count."""
    before = 0.0
    for i in range(count):
        before += intervals[i, 1] - intervals[i, 0]
    count = remove(intervals, count, first, last, NARROWEST)
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
def _inside(body, height, solids, stack):  # type: ignore[no-untyped-def]
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
def _turned(frame, tilt, tool, tree, body, scratch):  # type: ignore[no-untyped-def]
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


class _Start(NamedTuple):
    """Where a search begins: the posture of the sample before, the triangle and the points (k, 3) that were last in the way,
    and how many of these there were in all."""

    rotation: int
    tilt: float
    hint: int
    known: Any
    known_count: int


class _Room(NamedTuple):
    """Room to work in: intervals (k, 2), lean direction f and t = n x f, e2 = n x direction_max, a body, a tally by attribute."""

    intervals: Any
    f: Any
    t: Any
    e2: Any
    body: Any
    tally: Any
    scratch: Scratch


@kernel
def _sweep(contacts, row, ranges, radius, length, depth_allowed, solids, inside, start, room):  # type: ignore[no-untyped-def]
    """Search all rotations of one sample; (rotation index or -1, tilt, last triangle in the way, count of known points).

    A posture with a winding number of `inside` or more, or none, is not taken.
    """
    p, n, e1 = contacts.point[row], contacts.normal[row], contacts.direction_max[row]
    kappa_max, kappa_min = contacts.curvature[row, 0], contacts.curvature[row, 1]
    intervals, f, t, body, tally = room.intervals, room.f, room.t, room.body, room.tally
    hint, known, known_count = start.hint, start.known, start.known_count
    cross(n, e1, room.e2)
    frame, rotations = Frame(p, n, f, t), len(ranges.rotation_cos)
    tally[:] = 0.0
    low, high, shrunk = depth_allowed, length - depth_allowed, radius - depth_allowed
    tool = Tool(radius, shrunk, low, high)
    for turn in range(rotations):
        step = (turn + 1) // 2 if turn % 2 else -(turn // 2)
        rotation = (start.rotation + step) % rotations
        cosine, sine = ranges.rotation_cos[rotation], ranges.rotation_sin[rotation]
        lean_frame(e1, room.e2, cosine, sine, f, t)
        count = axis_arcs(
            dot(ranges.setup, n), dot(ranges.setup, f), ranges.limit_cos, ranges.tilt_low, ranges.tilt_high, intervals
        )
        for i in range(count):
            tally[AXIS_LIMIT] += intervals[i, 1] - intervals[i, 0] + NARROWEST
        least = local_gouge(kappa_max, kappa_min, cosine, sine, radius)
        if np.isnan(least):
            continue
        if least > 0.0:
            count = remove(intervals, count, -1.0, least, 0.0)
        for i in range(count):
            tally[LOCAL_GOUGE] += intervals[i, 1] - intervals[i, 0] + NARROWEST
        # What was in the way before, at other rotations and at the neighbours, is most likely so again.
        for i in range(min(known_count, len(known))):
            x, y, z = 0.0, 0.0, 0.0
            for k in range(3):
                x += (known[i, k] - p[k]) * f[k]
                y += (known[i, k] - p[k]) * t[k]
                z += (known[i, k] - p[k]) * n[k]
            first, last = point_arc(z, x + radius, y, 0.0, radius, shrunk, low, high)
            if first <= last:
                count = _forbid(intervals, count, first, last, _attribute(x, y, z, radius), tally)
                if count == 0:
                    break
        wish = start.tilt
        while count > 0:
            widest, tilt = -1.0, 0.0
            for i in range(count):
                if intervals[i, 0] <= wish <= intervals[i, 1]:
                    widest, tilt = 10.0, wish
                elif intervals[i, 1] - intervals[i, 0] > widest:
                    widest = intervals[i, 1] - intervals[i, 0]
                    tilt = 0.5 * (intervals[i, 0] + intervals[i, 1])
            wish = -1.0
            stand(body, frame, np.cos(tilt), np.sin(tilt), radius, shrunk, low, high)
            triangle, height, px, py = tree_hit(solids.tree, body, 0.0, hint, room.scratch)
            if triangle < 0:
                if _inside(body, inner_height(radius, length), solids, room.scratch.stack) < inside:
                    return rotation, tilt, hint, known_count
                half = _turned(frame, tilt, tool, solids.tree, body, room.scratch)
                count = _forbid(intervals, count, tilt - half, tilt + half, BURIED, tally)
                continue
            hint = triangle
            first, last = point_arc(height, px, py, tilt, radius, shrunk, low, high)
            # At the edge of the body the arc may be no wider than rounding: take the probe's own neighbourhood too.
            first, last = min(first, tilt - 0.5 * NARROWEST), max(last, tilt + 0.5 * NARROWEST)
            back, cosine_tilt, sine_tilt = px - radius, np.cos(tilt), np.sin(tilt)
            x, z = cosine_tilt * back + sine_tilt * height, cosine_tilt * height - sine_tilt * back
            count = _forbid(intervals, count, first, last, _attribute(x, py, z, radius), tally)
            for k in range(3):
                known[known_count % len(known), k] = p[k] + x * f[k] + py * t[k] + z * n[k]
            known_count += 1
    return -1, 0.0, hint, known_count


@kernel
def _copy(source, target):  # type: ignore[no-untyped-def]
    """Copy a table; to assign it whole takes the compiler seconds, for the texts of errors that cannot be."""
    for i in range(source.size):
        target.flat[i] = source.flat[i]


@entry
def search(rows, contacts, ranges, radius, length, safe, blocked, may_be, surely, found):  # type: ignore[no-untyped-def]
    """Decide the samples `rows`, one after the other, each starting from the posture of the one before.

    Parameters
    ----------
    rows : (m,) int64
        Samples to decide, neighbours in sequence.
    contacts : Contacts
    ranges : Ranges
    radius, length : float
        Flat-end cutter, mm.
    safe, blocked : float
        Depths (mm) up to which a triangle does not matter, and beyond which it certainly does.
    may_be, surely : Solids
        All that may be in the way, for calling a posture safe; what certainly is, for calling it blocked.
    found : Found, written
    """
    room = _Room(
        np.empty((_ROOM, 2)), np.empty(3), np.empty(3), np.empty(3), np.empty(BODY), np.empty(ATTRIBUTES),
        scratch(),
    )  # fmt: skip
    tally = room.tally
    known, known_count = np.empty((_KNOWN, 3)), 0
    last_rotation, last_tilt, hint = 0, -1.0, -1
    # What is only perhaps in the way must not count as surely in it: then the two are remembered apart.
    shared = len(may_be.tree.vertex) == len(surely.tree.vertex)
    sure_known, sure_count, sure_hint = np.empty((_KNOWN, 3)), 0, -1
    for row in rows:
        rotation, tilt, hint, known_count = _sweep(
            contacts, row, ranges, radius, length, safe, may_be, MAYBE_INSIDE,
            _Start(last_rotation, last_tilt, hint, known, known_count), room,
        )  # fmt: skip
        if rotation >= 0:
            found.verdict[row] = ACCESSIBLE
            last_rotation, last_tilt = rotation, tilt
            found.tilt[row], found.rotation[row] = tilt, rotation
            cosine, sine = np.cos(tilt), np.sin(tilt)
            for k in range(3):
                found.lean[row, k] = (
                    ranges.rotation_cos[rotation] * contacts.direction_max[row, k]
                    + ranges.rotation_sin[rotation] * room.e2[k]
                )
                found.axis[row, k] = cosine * contacts.normal[row, k] + sine * found.lean[row, k]
        else:
            if shared:
                _copy(known, sure_known)
                sure_count, sure_hint = known_count, hint
            rotation, tilt, sure_hint, sure_count = _sweep(
                contacts, row, ranges, radius, length, blocked, surely, SURELY_INSIDE,
                _Start(last_rotation, last_tilt, sure_hint, sure_known, sure_count), room,
            )  # fmt: skip
            if shared:
                _copy(sure_known, known)
                known_count, hint = sure_count, sure_hint
            found.verdict[row] = UNDECIDED if rotation >= 0 else INACCESSIBLE
            if tally[AXIS_LIMIT] == 0.0:
                found.reason[row] = AXIS_LIMIT
            elif tally[LOCAL_GOUGE] == 0.0:
                found.reason[row] = LOCAL_GOUGE
            else:
                reason = REAR_GOUGE
                for attribute in (COLLISION, BURIED):
                    if tally[attribute] > tally[reason]:
                        reason = attribute
                found.reason[row] = reason


@entry
def first_reason(rows, contacts, ranges, radius, reason):  # type: ignore[no-untyped-def]
    """Write AXIS_LIMIT or LOCAL_GOUGE as the reason (n,) of samples to which these alone leave no posture.

    The other parameters are those of `search`; other reasons stay as they are.
    """
    intervals = np.empty((8, 2))
    f, t, e2 = np.empty(3), np.empty(3), np.empty(3)
    for row in rows:
        n, e1 = contacts.normal[row], contacts.direction_max[row]
        cross(n, e1, e2)
        axis_left, gouge_left = False, False
        for rotation in range(len(ranges.rotation_cos)):
            cosine, sine = ranges.rotation_cos[rotation], ranges.rotation_sin[rotation]
            lean_frame(e1, e2, cosine, sine, f, t)
            count = axis_arcs(
                dot(ranges.setup, n),
                dot(ranges.setup, f),
                ranges.limit_cos,
                ranges.tilt_low,
                ranges.tilt_high,
                intervals,
            )
            axis_left = axis_left or count > 0
            least = local_gouge(contacts.curvature[row, 0], contacts.curvature[row, 1], cosine, sine, radius)
            if not np.isnan(least) and least > 0.0:
                count = remove(intervals, count, -1.0, least, 0.0)
            if not np.isnan(least) and count > 0:
                gouge_left = True
                break
        if not axis_left:
            reason[row] = AXIS_LIMIT
        elif not gouge_left:
            reason[row] = LOCAL_GOUGE


@entry
def dummy_clear(rows, contacts, radius, length, safe, solids, clear):  # type: ignore[no-untyped-def]
    """Test the dummy cutter `(2 radius, length)`, bottom centre on the sample, axis along the normal.

    Parameters
    ----------
    rows : (m,) int64
    contacts : Contacts
    radius, length, safe : float
        The flat-end cutter, mm, and the depth up to which a triangle does not matter.
    solids : Solids
        All that may be in the way.
    clear : (n,) bool, written
        True where nothing reaches deeper than `safe` into the dummy, and the dummy lies in no body.
    """
    body, f, t = np.empty(BODY), np.empty(3), np.empty(3)
    room = scratch()
    hint = -1
    for row in rows:
        n = contacts.normal[row]
        perpendicular(n, f)
        cross(n, f, t)
        stand(body, Frame(contacts.point[row], n, f, t), 1.0, 0.0, 0.0, 2.0 * radius - safe, safe, length - safe)
        triangle, _, _, _ = tree_hit(solids.tree, body, 0.0, hint, room)
        clear[row] = triangle < 0 and _inside(body, inner_height(radius, length), solids, room.stack) < MAYBE_INSIDE
        if triangle >= 0:
            hint = triangle


@entry
def probe(rows, point, normal, axis, lean, radius, length, depths, tree, triangle):  # type: ignore[no-untyped-def]
    """Test given postures: the triangle that reaches deeper than `depths[i]` into the cutter of posture i, or -1.

    Parameters
    ----------
    rows : (m,) int64
        Rows to test.
    point, normal, axis, lean : (n, 3) float64
        Contact, unit normal, unit tool axis, unit lean direction.
    radius, length : float
    depths : (n,) float64
    tree : Tree
    triangle : (n,) int32, written
    """
    body, t = np.empty(BODY), np.empty(3)
    room = scratch()
    hint = -1
    for row in rows:
        n, f, s = normal[row], lean[row], depths[row]
        cross(n, f, t)
        stand(body, Frame(point[row], n, f, t), dot(axis[row], n), dot(axis[row], f), radius, radius - s, s, length - s)
        triangle[row], _, _, _ = tree_hit(tree, body, 0.0, hint, room)
        if triangle[row] >= 0:
            hint = triangle[row]
