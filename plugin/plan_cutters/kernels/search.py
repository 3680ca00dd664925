"""Is there a posture? Probe a tilt; whatever is in the way forbids a whole arc; probe what is left.

A found posture is safe: no triangle reaches deeper into the cutter than `safe`. Where none is found, the same search
at the depth `blocked` decides whether the sample is inaccessible (everything is forbidden by what certainly lies too
deep) or undecided. What is forbidden at `blocked` is so at `safe`: after a sample without a posture that is asked first,
and one answer is all that an inaccessible sample takes. A cutter that touches nothing may still lie within a body: then
so does every posture that it can be turned to without touching a skin.
"""

import numpy as np

from plan_cutters.kernels.arcs import axis_arcs, local_gouge
from plan_cutters.kernels.hit import BODY, cross, dot, lean_frame, perpendicular, scratch, stand, tree_hit
from plan_cutters.kernels.jit import entry, kernel
from plan_cutters.kernels.material import MAYBE_INSIDE, SURELY_INSIDE
from plan_cutters.kernels.probing import (
    AXIS_LIMIT,
    BURIED,
    COLLISION,
    LOCAL_GOUGE,
    REAR_GOUGE,
    inner_height,
    inside,
    remove,
    room_to_search,
)
from plan_cutters.kernels.rows import Frame, Tool
from plan_cutters.kernels.sweep import memory, sweep

# As in `plan_cutters.domain.verdicts`, which must not load the compiler; a test holds them together.
INACCESSIBLE, ACCESSIBLE, INTERFERENCE_FREE, UNDECIDED, UNJUDGED = 0, 1, 2, 3, 255

#: Between arcs of what is certainly in the way, gaps narrower than this are none: no machine holds a tilt to 0.01 deg. rad.
_NO_GAP = 1.7e-4
#: A posture is searched in gaps down to this, rad: it may stand where arcs leave more than they seem to.
_FINEST = 1e-5
#: How far apart tilts are among which the one of least depth is looked for at first, rad.
_COARSE = 0.05


@kernel
def _reason(tally):  # type: ignore[no-untyped-def]
    """What leaves no posture: the attribute that leaves none alone, or the one that most tilts are booked on."""
    if tally[AXIS_LIMIT] == 0.0:
        return AXIS_LIMIT
    if tally[LOCAL_GOUGE] == 0.0:
        return LOCAL_GOUGE
    reason = REAR_GOUGE
    for attribute in (COLLISION, BURIED):
        if tally[attribute] > tally[reason]:
            reason = attribute
    return reason


@kernel
def _write(found, row, contacts, ranges, rotation, tilt):  # type: ignore[no-untyped-def]
    """Write a posture."""
    n, e1 = contacts.normal[row], contacts.direction_max[row]
    turn_cos, turn_sin = ranges.rotation_cos[rotation], ranges.rotation_sin[rotation]
    cosine, sine = np.cos(tilt), np.sin(tilt)
    found.tilt[row], found.rotation[row] = tilt, rotation
    for k in range(3):
        i, j = (k + 1) % 3, (k + 2) % 3
        found.lean[row, k] = turn_cos * e1[k] + turn_sin * (n[i] * e1[j] - n[j] * e1[i])
        found.axis[row, k] = cosine * n[k] + sine * found.lean[row, k]


@kernel
def _surely_none(contacts, row, ranges, tool, length, solids, start, past, room):  # type: ignore[no-untyped-def]
    """Whether what is surely in the way leaves a sample no posture; the last one that it left to any, and that."""
    rotation, tilt = sweep(
        contacts, row, ranges, tool, length, solids, SURELY_INSIDE, _NO_GAP, start, len(ranges.rotation_cos), past, room
    )
    if rotation < 0:
        return start, True
    return (rotation, tilt), False


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
    rotations, room = len(ranges.rotation_cos), room_to_search()
    light = Tool(radius, radius - safe, safe, length - safe)
    heavy = Tool(radius, radius - blocked, blocked, length - blocked)
    # What is only perhaps in the way must not count as surely in it: the two are remembered apart.
    light_past, heavy_past = memory(rotations), memory(rotations)
    last, freed, lost = (0, -1.0), (0, -1.0), False
    for row in rows:
        asked, sure = lost, False
        if asked:
            freed, sure = _surely_none(contacts, row, ranges, heavy, length, surely, freed, heavy_past, room)
        if not sure:
            rotation, tilt = sweep(
                contacts, row, ranges, light, length, may_be, MAYBE_INSIDE, _FINEST, last, rotations, light_past, room
            )
            lost = rotation < 0
            if not lost:
                last = rotation, tilt
                found.verdict[row] = ACCESSIBLE
                _write(found, row, contacts, ranges, rotation, tilt)
                continue
        found.reason[row] = _reason(room.tally)
        if not asked:
            freed, sure = _surely_none(contacts, row, ranges, heavy, length, surely, freed, heavy_past, room)
            if sure:
                found.reason[row] = _reason(room.tally)
        found.verdict[row] = INACCESSIBLE if sure else UNDECIDED


@entry
def least_depth(contacts, ranges, radius, length, least, most, share, solids, found):  # type: ignore[no-untyped-def]
    """The posture of the first contact at which the least depth reaches into the cutter, by halving in ratio.

    At first among tilts that are `_COARSE` apart at all rotations, then among all tilts at the rotation found.

    Parameters
    ----------
    contacts : Contacts
    ranges : Ranges
    radius, length : float
        Flat-end cutter, mm.
    least, most : float
        Depths (mm) to look between: that at which nothing was found, and the largest that is tried.
    share : float
        Of itself to which the depth is found.
    solids : Solids
        All that may be in the way.
    found : Found, written
        The posture.

    Returns
    -------
    low, high : float
        A depth at which no posture was found at that rotation, and that of the posture; nan where there is none at `most`.
    """
    rotations = len(ranges.rotation_cos)
    past, room = memory(rotations), room_to_search()
    low, high, last = least, np.nan, (0, -1.0)
    for narrowest, near in ((_COARSE, 5.0 * share), (_NO_GAP, share)):
        low, depth, turns = least, most, 1 if high == high else rotations
        # Where nothing was found, a cutter that is all but a line is stopped again and again: not every tilt is tried.
        narrowest = narrowest if turns == 1 else max(narrowest, 0.1 * _COARSE)
        while not high - low <= near * high:
            if high == high:
                depth = np.sqrt(low * high)
            tool = Tool(radius, radius - depth, depth, length - depth)
            rotation, tilt = sweep(
                contacts, 0, ranges, tool, length, solids, MAYBE_INSIDE, narrowest, last, turns, past, room
            )
            if rotation >= 0:
                last, high = (rotation, tilt), depth
                _write(found, 0, contacts, ranges, rotation, tilt)
            elif high == high:
                low = depth
            else:
                break
    return low, high


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
        clear[row] = triangle < 0 and inside(body, inner_height(radius, length), solids, room.stack) < MAYBE_INSIDE
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
