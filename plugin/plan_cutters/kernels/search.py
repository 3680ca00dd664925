"""Is there a posture? Probe a tilt; whatever is in the way forbids a whole arc; probe what is left.

A found posture is safe: no triangle reaches deeper into the cutter than `safe`. Where none is found, the same search
at the depth `blocked` decides whether the sample is inaccessible (everything is forbidden by what certainly lies too
deep) or undecided. A cutter that touches nothing may still lie within a body: then so does every posture that it can be
turned to without touching a skin.
"""

import numpy as np

from plan_cutters.kernels.arcs import axis_arcs, local_gouge, point_arc
from plan_cutters.kernels.hit import BODY, HIGH, OFFSET, A, P, X, cross, dot, lean_frame, perpendicular, stand, tree_hit
from plan_cutters.kernels.jit import entry, kernel
from plan_cutters.kernels.material import MAYBE_INSIDE, SURELY_INSIDE, outside, winding

# As in `plan_cutters.domain.verdicts`, which must not load the compiler; a test holds them together.
INACCESSIBLE, ACCESSIBLE, FREE, UNDECIDED, UNJUDGED = 0, 1, 2, 3, 255
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
def _turned(p, n, f, t, tilt, radius, shrunk, low, high, solids, body, stack, polygon, spare, pieces):  # type: ignore[no-untyped-def]
    """How far a posture that touches nothing can be tilted either way and still surely touch nothing, rad."""
    half = _TURN
    while half > 0.5 * NARROWEST:
        stand(body, p, n, f, t, np.cos(tilt), np.sin(tilt), radius, shrunk, low, high)
        hit, _, _, _ = tree_hit(solids.vertex, solids.box, solids.depth, body, half, -1, stack, polygon, spare, pieces)
        if hit < 0:
            return half
        half *= 0.5
    # No narrower: what is left is the probe's own neighbourhood, as for every other obstacle.
    return 0.5 * NARROWEST


@kernel
def _sweep(  # type: ignore[no-untyped-def]
    p, n, e1, e2, kappa_max, kappa_min,
    rotation_cos, rotation_sin, tilt_low, tilt_high, setup, limit_cos,
    radius, length, depth_allowed, solids, inside,
    first_rotation, first_tilt, hint, known, known_count,
    intervals, f, t, body, stack, polygon, spare, pieces, tally,
):  # fmt: skip
    """Search all rotations of one sample; (rotation index or -1, tilt, last triangle in the way, count of known points).

    A posture with a winding number of `inside` or more, or none, is not taken.
    """
    vertex, box, depth = solids.vertex, solids.box, solids.depth
    rotations = len(rotation_cos)
    tally[:] = 0.0
    low, high, shrunk = depth_allowed, length - depth_allowed, radius - depth_allowed
    for turn in range(rotations):
        step = (turn + 1) // 2 if turn % 2 else -(turn // 2)
        rotation = (first_rotation + step) % rotations
        cosine, sine = rotation_cos[rotation], rotation_sin[rotation]
        lean_frame(e1, e2, cosine, sine, f, t)
        count = axis_arcs(dot(setup, n), dot(setup, f), limit_cos, tilt_low, tilt_high, intervals)
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
        wish = first_tilt
        while count > 0:
            widest, tilt = -1.0, 0.0
            for i in range(count):
                if intervals[i, 0] <= wish <= intervals[i, 1]:
                    widest, tilt = 10.0, wish
                elif intervals[i, 1] - intervals[i, 0] > widest:
                    widest = intervals[i, 1] - intervals[i, 0]
                    tilt = 0.5 * (intervals[i, 0] + intervals[i, 1])
            wish = -1.0
            stand(body, p, n, f, t, np.cos(tilt), np.sin(tilt), radius, shrunk, low, high)
            triangle, height, px, py = tree_hit(vertex, box, depth, body, 0.0, hint, stack, polygon, spare, pieces)
            if triangle < 0:
                if _inside(body, inner_height(radius, length), solids, stack) < inside:
                    return rotation, tilt, hint, known_count
                half = _turned(p, n, f, t, tilt, radius, shrunk, low, high, solids, body, stack, polygon, spare, pieces)
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


@entry
def search(  # type: ignore[no-untyped-def]
    rows, point, normal, direction_max, curvature,
    rotation_cos, rotation_sin, tilt_low, tilt_high, setup, limit_cos,
    radius, length, safe, blocked, may_be, surely,
    verdict, axis, lean, tilt_out, rotation_out, reason,
):  # fmt: skip
    """Decide the samples `rows`, one after the other, each starting from the posture of the one before.

    Parameters
    ----------
    rows : (m,) int64
        Samples to decide, neighbours in sequence.
    point, normal, direction_max : (n, 3) float64
    curvature : (n, 2) float64
        kappa_max, kappa_min, 1/mm, concave positive.
    rotation_cos, rotation_sin : (k,) float64
    tilt_low, tilt_high : float
        rad.
    setup : (3,) float64
        Unit setup axis.
    limit_cos : float
        Cosine of the axis limit about it, -2 for none.
    radius, length : float
        Flat-end cutter, mm.
    safe, blocked : float
        Depths (mm) up to which a triangle does not matter, and beyond which it certainly does.
    may_be, surely : Solids
        All that may be in the way, for calling a posture safe; what certainly is, for calling it blocked.
    verdict, reason : (n,) uint8, written
    axis, lean : (n, 3) float64, written
    tilt_out, rotation_out : (n,) float64, int32, written
    """
    intervals = np.empty((_ROOM, 2))
    f, t, e2 = np.empty(3), np.empty(3), np.empty(3)
    body = np.empty(BODY)
    stack = np.empty(64, np.int64)
    polygon, spare, pieces = np.empty((8, 3)), np.empty((8, 3)), np.empty((64, 3, 3))
    tally = np.empty(ATTRIBUTES)
    known, known_count = np.empty((_KNOWN, 3)), 0
    last_rotation, last_tilt, hint = 0, -1.0, -1
    # What is only perhaps in the way must not count as surely in it: then the two are remembered apart.
    shared = len(may_be.vertex) == len(surely.vertex)
    sure_known, sure_count, sure_hint = np.empty((_KNOWN, 3)), 0, -1
    for row in rows:
        p, n, e1 = point[row], normal[row], direction_max[row]
        cross(n, e1, e2)
        rotation, tilt, hint, known_count = _sweep(
            p, n, e1, e2, curvature[row, 0], curvature[row, 1],
            rotation_cos, rotation_sin, tilt_low, tilt_high, setup, limit_cos,
            radius, length, safe, may_be, MAYBE_INSIDE, last_rotation, last_tilt, hint, known, known_count,
            intervals, f, t, body, stack, polygon, spare, pieces, tally,
        )  # fmt: skip
        if rotation >= 0:
            verdict[row] = ACCESSIBLE
            last_rotation, last_tilt = rotation, tilt
            tilt_out[row], rotation_out[row] = tilt, rotation
            cosine, sine = np.cos(tilt), np.sin(tilt)
            for k in range(3):
                lean[row, k] = rotation_cos[rotation] * e1[k] + rotation_sin[rotation] * e2[k]
                axis[row, k] = cosine * n[k] + sine * lean[row, k]
        else:
            if shared:
                sure_known[:], sure_count, sure_hint = known, known_count, hint
            rotation, tilt, sure_hint, sure_count = _sweep(
                p, n, e1, e2, curvature[row, 0], curvature[row, 1],
                rotation_cos, rotation_sin, tilt_low, tilt_high, setup, limit_cos,
                radius, length, blocked, surely, SURELY_INSIDE, last_rotation, last_tilt, sure_hint, sure_known, sure_count,
                intervals, f, t, body, stack, polygon, spare, pieces, tally,
            )  # fmt: skip
            if shared:
                known[:], known_count, hint = sure_known, sure_count, sure_hint
            verdict[row] = UNDECIDED if rotation >= 0 else INACCESSIBLE
            if tally[AXIS_LIMIT] == 0.0:
                reason[row] = AXIS_LIMIT
            elif tally[LOCAL_GOUGE] == 0.0:
                reason[row] = LOCAL_GOUGE
            else:
                reason[row] = REAR_GOUGE
                for attribute in (COLLISION, BURIED):
                    if tally[attribute] > tally[reason[row]]:
                        reason[row] = attribute


@entry
def first_reason(  # type: ignore[no-untyped-def]
    rows, normal, direction_max, curvature, rotation_cos, rotation_sin, tilt_low, tilt_high, setup, limit_cos, radius,
    reason,
):  # fmt: skip
    """Write AXIS_LIMIT or LOCAL_GOUGE as the reason of samples to which these alone leave no posture.

    Parameters are those of `search`; other reasons stay as they are.
    """
    intervals = np.empty((8, 2))
    f, t, e2 = np.empty(3), np.empty(3), np.empty(3)
    for row in rows:
        n, e1 = normal[row], direction_max[row]
        cross(n, e1, e2)
        axis_left, gouge_left = False, False
        for rotation in range(len(rotation_cos)):
            cosine, sine = rotation_cos[rotation], rotation_sin[rotation]
            lean_frame(e1, e2, cosine, sine, f, t)
            count = axis_arcs(dot(setup, n), dot(setup, f), limit_cos, tilt_low, tilt_high, intervals)
            axis_left = axis_left or count > 0
            least = local_gouge(curvature[row, 0], curvature[row, 1], cosine, sine, radius)
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
def dummy_free(rows, point, normal, radius, length, safe, solids, free):  # type: ignore[no-untyped-def]
    """Test the dummy cutter `(2 radius, length)`, bottom centre on the sample, axis along the normal.

    Parameters
    ----------
    rows : (m,) int64
    point, normal : (n, 3) float64
    radius, length, safe : float
        The flat-end cutter, mm, and the depth up to which a triangle does not matter.
    solids : Solids
        All that may be in the way.
    free : (n,) bool, written
        True where nothing reaches deeper than `safe` into the dummy, and the dummy lies in no body.
    """
    vertex, box, depth = solids.vertex, solids.box, solids.depth
    body = np.empty(BODY)
    f, t = np.empty(3), np.empty(3)
    stack = np.empty(64, np.int64)
    polygon, spare, pieces = np.empty((8, 3)), np.empty((8, 3)), np.empty((64, 3, 3))
    hint = -1
    for row in rows:
        n = normal[row]
        perpendicular(n, f)
        cross(n, f, t)
        stand(body, point[row], n, f, t, 1.0, 0.0, 0.0, 2.0 * radius - safe, safe, length - safe)
        triangle, _, _, _ = tree_hit(vertex, box, depth, body, 0.0, hint, stack, polygon, spare, pieces)
        free[row] = triangle < 0 and _inside(body, inner_height(radius, length), solids, stack) < MAYBE_INSIDE
        if triangle >= 0:
            hint = triangle


@entry
def probe(rows, point, normal, axis, lean, radius, length, depths, vertex, box, depth, triangle):  # type: ignore[no-untyped-def]
    """Test given postures: the triangle that reaches deeper than `depths[i]` into the cutter of posture i, or -1.

    Parameters
    ----------
    rows : (m,) int64
        Rows to test.
    point, normal, axis, lean : (n, 3) float64
        Contact, unit normal, unit tool axis, unit lean direction.
    radius, length : float
    depths : (n,) float64
    vertex, box, depth
        Triangles in tree order and the tree.
    triangle : (n,) int32, written
    """
    body, t = np.empty(BODY), np.empty(3)
    stack = np.empty(64, np.int64)
    polygon, spare, pieces = np.empty((8, 3)), np.empty((8, 3)), np.empty((64, 3, 3))
    hint = -1
    for row in rows:
        n, f, s = normal[row], lean[row], depths[row]
        cross(n, f, t)
        stand(body, point[row], n, f, t, dot(axis[row], n), dot(axis[row], f), radius, radius - s, s, length - s)
        triangle[row], _, _, _ = tree_hit(vertex, box, depth, body, 0.0, hint, stack, polygon, spare, pieces)
        if triangle[row] >= 0:
            hint = triangle[row]
