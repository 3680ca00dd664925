"""Is there a posture? Probe a tilt; whatever is in the way forbids a whole arc; probe what is left.

A found posture is safe: no triangle reaches deeper into the cutter than `safe`. Where none is found, the same search
at the depth `blocked` decides whether the sample is inaccessible (everything is forbidden by what certainly lies too
deep) or undecided. What is forbidden at `blocked` is so at `safe`: after a sample without a posture that is asked first,
and one answer is all that an inaccessible sample takes. A cutter that touches nothing may still lie within a body: then
so does every posture that it can be turned to without touching a skin.
"""

import numpy as np

from plan_cutters.kernels.hit import BODY, scratch, stand, tree_hit
from plan_cutters.kernels.jit import entry, kernel
from plan_cutters.kernels.limits import turn_of
from plan_cutters.kernels.material import MAYBE_INSIDE, SURELY_INSIDE
from plan_cutters.kernels.probing import (
    AXIS_LIMIT,
    BURIED,
    COLLISION,
    HOLDER,
    LOCAL_GOUGE,
    NECK,
    OFFSET_OF,
    REAR_GOUGE,
    RISE,
    SHANK,
    TILT_FROM,
    TILT_TO,
    inside,
    permitted,
    room_to_search,
)
from plan_cutters.kernels.rows import Frame
from plan_cutters.kernels.sweep import memory, sweep
from plan_cutters.kernels.vectors import cross, dot, lean_frame, perpendicular

# As in `plan_cutters.domain.verdicts`, which must not load the compiler; a test holds them together.
INACCESSIBLE, ACCESSIBLE, INTERFERENCE_FREE, UNDECIDED, UNJUDGED = 0, 1, 2, 3, 255

#: Between arcs of what is certainly in the way, gaps narrower than this are none: no machine holds a tilt to 0.01 deg. rad.
_NO_GAP = 1.7e-4
#: A posture is searched in gaps down to this, rad: it may stand where arcs leave more than they seem to.
_FINEST = 1e-5
#: Tilts this close to the end of a tool's range are in it, rad.
_ROUNDING = 1e-9


@kernel
def _reason(tally):  # type: ignore[no-untyped-def]
    """What leaves no posture: the attribute that leaves none alone, or the one that most tilts are booked on."""
    if tally[AXIS_LIMIT] == 0.0:
        return AXIS_LIMIT
    if tally[LOCAL_GOUGE] == 0.0:
        return LOCAL_GOUGE
    reason = REAR_GOUGE
    for attribute in (COLLISION, BURIED, NECK, SHANK, HOLDER):
        if tally[attribute] > tally[reason]:
            reason = attribute
    return reason


@kernel
def _write(found, row, contacts, ranges, rotation, tilt):  # type: ignore[no-untyped-def]
    """Write a posture."""
    n, e1 = contacts.normal[row], contacts.direction_max[row]
    turn_cos, turn_sin = turn_of(n, e1, ranges, rotation)
    cosine, sine = np.cos(tilt), np.sin(tilt)
    found.tilt[row], found.rotation[row] = tilt, rotation
    for k in range(3):
        i, j = (k + 1) % 3, (k + 2) % 3
        found.lean[row, k] = turn_cos * e1[k] + turn_sin * (n[i] * e1[j] - n[j] * e1[i])
        found.axis[row, k] = cosine * n[k] + sine * found.lean[row, k]


@kernel
def _surely_none(contacts, row, ranges, tool, solids, start, past, room):  # type: ignore[no-untyped-def]
    """Whether what is surely in the way leaves a sample no posture; the last one that it left to any, and that."""
    rotation, tilt = sweep(
        contacts, row, ranges, tool, solids, SURELY_INSIDE, _NO_GAP, start, len(ranges.rotation_cos), past, room
    )
    if rotation < 0:
        return start, True
    return (rotation, tilt), False


@entry
def search(rows, contacts, ranges, light, heavy, may_be, surely, found):  # type: ignore[no-untyped-def]
    """Decide the samples `rows`, one after the other, each starting from the posture of the one before.

    Parameters
    ----------
    rows : (m,) int64
        Samples to decide, neighbours in sequence.
    contacts : Contacts
    ranges : Ranges
    light, heavy : Tool
        The tool without what does not matter, and what of it is certainly in the way.
    may_be, surely : Solids
        All that may be in the way, for calling a posture safe; what certainly is, for calling it blocked.
    found : Found, written
    """
    rotations, room = len(ranges.rotation_cos), room_to_search()
    # What is only perhaps in the way must not count as surely in it: the two are remembered apart.
    light_past, heavy_past = memory(rotations, len(light.mode)), memory(rotations, len(heavy.mode))
    last, freed, lost = (0, -1.0), (0, -1.0), False
    for row in rows:
        asked, sure = lost, False
        if asked:
            freed, sure = _surely_none(contacts, row, ranges, heavy, surely, freed, heavy_past, room)
        if not sure:
            rotation, tilt = sweep(
                contacts, row, ranges, light, may_be, MAYBE_INSIDE, _FINEST, last, rotations, light_past, room
            )
            lost = rotation < 0
            if not lost:
                last = rotation, tilt
                found.verdict[row] = ACCESSIBLE
                _write(found, row, contacts, ranges, rotation, tilt)
                continue
        found.reason[row] = _reason(room.tally)
        if not asked:
            freed, sure = _surely_none(contacts, row, ranges, heavy, surely, freed, heavy_past, room)
            if sure:
                found.reason[row] = _reason(room.tally)
        found.verdict[row] = INACCESSIBLE if sure else UNDECIDED


@entry
def until_lost(rows, at, contacts, ranges, tool, solids, patient, found):  # type: ignore[no-untyped-def]
    """Look for postures of the samples `rows` from the `at`-th on, at which a tool is in nothing's way; where it ended.

    Unless it is `patient`, behind the first sample that has none; such samples are written as UNDECIDED, for nothing was asked
    about why. Intervals that `search` takes for none are passed over, so that it finds a posture where this does. The other
    parameters are those of `posture`.
    """
    rotations, room = len(ranges.rotation_cos), room_to_search()
    past, last = memory(rotations, len(tool.mode)), (0, -1.0)
    while at < len(rows):
        row = rows[at]
        at += 1
        rotation, tilt = sweep(contacts, row, ranges, tool, solids, MAYBE_INSIDE, _NO_GAP, last, rotations, past, room)
        if rotation >= 0:
            last = rotation, tilt
            found.verdict[row] = ACCESSIBLE
            _write(found, row, contacts, ranges, rotation, tilt)
        else:
            found.verdict[row] = UNDECIDED
            if not patient:
                return at
    return at


@entry
def posture(contacts, ranges, tool, narrowest, start, turns, solids, found):  # type: ignore[no-untyped-def]
    """Look for a posture of the first contact at which a tool is in nothing's way; whether there is one.

    Parameters
    ----------
    contacts : Contacts
    ranges : Ranges
    tool : Tool
    narrowest : float
        Intervals of tilt narrower than this are passed over, rad.
    start : (int, float)
        Rotation to begin with, and the tilt that is tried first at each.
    turns : int
        How many rotations to look at.
    solids : Solids
        All that may be in the way.
    found : Found, written
        The posture.
    """
    past, room = memory(len(ranges.rotation_cos), len(tool.mode)), room_to_search()
    rotation, tilt = sweep(contacts, 0, ranges, tool, solids, MAYBE_INSIDE, narrowest, start, turns, past, room)
    if rotation >= 0:
        _write(found, 0, contacts, ranges, rotation, tilt)
    return rotation >= 0


@entry
def first_reason(rows, contacts, ranges, tool, reason):  # type: ignore[no-untyped-def]
    """Write AXIS_LIMIT or LOCAL_GOUGE as the reason (n,) of samples to which these alone leave no posture.

    The other parameters are those of `search`; other reasons stay as they are.
    """
    intervals = np.empty((64, 2))
    f, t, e2 = np.empty(3), np.empty(3), np.empty(3)
    for row in rows:
        n, e1 = contacts.normal[row], contacts.direction_max[row]
        cross(n, e1, e2)
        axis_left, gouge_left = False, False
        for rotation in range(len(ranges.rotation_cos)):
            cosine, sine = turn_of(n, e1, ranges, rotation)
            lean_frame(e1, e2, cosine, sine, f, t)
            for mode in range(len(tool.mode)):
                _, before, left = permitted(contacts, row, ranges, rotation, tool, mode, f, intervals)
                axis_left, gouge_left = axis_left or before > 0, gouge_left or left > 0
            if gouge_left:
                break
        if not axis_left:
            reason[row] = AXIS_LIMIT
        elif not gouge_left:
            reason[row] = LOCAL_GOUGE


@entry
def dummy_clear(rows, contacts, dummy, tool, solids, clear):  # type: ignore[no-untyped-def]
    """Test the dummy tool, which holds the tool at tilt 0 in every rotation, its axis along the normal.

    Parameters
    ----------
    rows : (m,) int64
    contacts : Contacts
    dummy : (k, COLUMNS) float64
        `Assembly.dummy`, without what does not matter.
    tool : Tool
    solids : Solids
        All that may be in the way.
    clear : (n,) bool, written
        True where nothing reaches into the dummy, and the dummy lies in no body.
    """
    body, f, t = np.empty(BODY), np.empty(3), np.empty(3)
    room = scratch()
    hint = -1
    for row in rows:
        n = contacts.normal[row]
        perpendicular(n, f)
        cross(n, f, t)
        stand(body, Frame(contacts.point[row], n, f, t), 1.0, 0.0, 0.0, tool.mode[0, RISE])
        triangle, _, _, _, _ = tree_hit(solids.tree, body, dummy, 0.0, hint, room)
        clear[row] = triangle < 0 and inside(body, tool, 0, solids, room.stack) < MAYBE_INSIDE
        if triangle >= 0:
            hint = triangle


@kernel
def mode_at(tool, tilt):  # type: ignore[no-untyped-def]
    """The mode in which a tool touches at a tilt, -1 for none."""
    for mode in range(len(tool.mode)):
        if tool.mode[mode, TILT_FROM] - _ROUNDING <= tilt <= tool.mode[mode, TILT_TO] + _ROUNDING:
            return mode
    return -1


@entry
def probe(rows, point, normal, axis, lean, tool, tree, triangle, which):  # type: ignore[no-untyped-def]
    """Test given postures: the triangle that reaches into the tool at posture i and the piece that it reaches into, or -1.

    Parameters
    ----------
    rows : (m,) int64
        Rows to test.
    point, normal, axis, lean : (n, 3) float64
        Contact, unit normal, unit tool axis, unit lean direction.
    tool : Tool
        Without what does not matter.
    tree : Tree
    triangle, which : (n,) int32, written
        At a tilt at which the tool does not touch: -2.
    """
    body, t = np.empty(BODY), np.empty(3)
    room = scratch()
    hint = -1
    for row in rows:
        n, f = normal[row], lean[row]
        cross(n, f, t)
        cosine, sine = dot(axis[row], n), dot(axis[row], f)
        mode = mode_at(tool, np.arctan2(sine, cosine))
        if mode < 0:
            triangle[row], which[row] = -2, -2
            continue
        stand(body, Frame(point[row], n, f, t), cosine, sine, tool.mode[mode, OFFSET_OF], tool.mode[mode, RISE])
        triangle[row], which[row], _, _, _ = tree_hit(tree, body, tool.piece[mode], 0.0, hint, room)
        if triangle[row] >= 0:
            hint = triangle[row]
