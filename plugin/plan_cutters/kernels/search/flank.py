"""A tool whose straight flank lies along a surface: where along the flank may the contact be?

What curvature and corners search touches with one point of the outline. Along a straight flank every point may touch: the tool
slides by its length, and the contact stays. A point that is in a piece of the tool is in it over one interval of the slide, for a
piece is convex; what is left is probed, as a search probes tilts.
"""

import numpy as np

from plan_cutters.kernels.codes import (
    ARC,
    BY_NECK,
    COLLISION,
    FLUTES,
    HIGH,
    INSIDE,
    KIND,
    LOW,
    NECK,
    NO_REASON,
    OFFSET_OF,
    PART,
    RADIUS,
    REAR_GOUGE,
    RISE,
    ROUND,
    SLOPE,
)
from plan_cutters.kernels.halves import half_of
from plan_cutters.kernels.intervals import remove
from plan_cutters.kernels.jit import entry, kernel
from plan_cutters.kernels.linear.vectors import cross, dot
from plan_cutters.kernels.rows import Frame
from plan_cutters.kernels.search.place import inside, next_tilt
from plan_cutters.kernels.tool.apart import BODY, P
from plan_cutters.kernels.tool.hit import deep_hit, everything, scratch, stand, triangle_hit

#: Places of a slide that are nearer together are one, mm: no machine holds them apart.
_NO_PLACE = 1e-3
#: Share of the slide that a place within a body stands for.
_IN_BODY = 0.02
#: Places that are tried at most: each takes a part of the slide away.
_PROBES = 200
#: What a place is: one where the tool stands free, none for a reason that was met, or not known.
FREE, NONE, UNKNOWN = 1, 0, 2
#: How often an end of what a point forbids is halved: to a millionth of the slide.
_HALVINGS = 20


@kernel
def _holds(piece, k, height, x, y):
    """Whether a point in the tool's frame lies in piece k."""
    if not piece[k, LOW] < height < piece[k, HIGH]:
        return False
    q = np.sqrt(x * x + y * y)
    if piece[k, KIND] == ARC:
        away = max(0.0, q - piece[k, RADIUS])
        return away * away + (height - piece[k, SLOPE]) ** 2 < piece[k, ROUND] ** 2
    return q < piece[k, RADIUS] + piece[k, SLOPE] * (height - piece[k, LOW])


@kernel
def _end(piece, k, point, step, length):
    """How far the tool may slide, up to `length`, and surely still hold a point of piece k, which goes `step` for each mm."""
    if _holds(piece, k, point[0] + length * step[0], point[1] + length * step[1], point[2]):
        return length
    held, free = 0.0, length
    for _ in range(_HALVINGS):
        middle = 0.5 * (held + free)
        if _holds(piece, k, point[0] + middle * step[0], point[1] + middle * step[1], point[2]):
            held = middle
        else:
            free = middle
    return held


@kernel
def _slid(frame, turn, length, tool, mode, solids, within, hint, body, intervals, scratch):
    """Look for a place along a flank: (FREE, NONE or UNKNOWN, how far the tool has slid, why the first one is none, and the
    triangle that took away most of the slide, or -1). A triangle that is a hint is tried before all others.
    """
    cosine, sine = turn
    offset, rise, piece = tool.mode[mode, OFFSET_OF], tool.mode[mode, RISE], tool.piece[mode]
    intervals[0, 0], intervals[0, 1] = 0.0, length
    count, wish, reason, sure = 1, 0.0, NO_REASON, True
    widest, most = -1.0, -1
    for _ in range(_PROBES):
        if count == 0:
            break
        slide = next_tilt(intervals, count, wish)
        stand(body, frame, cosine, sine, offset, rise)
        for k in range(3):
            body[P + k] -= slide * frame.f[k]
        triangle, which, height, x, y = hint, -1, 0.0, 0.0, 0.0
        if hint >= 0:
            vertex, row = half_of(solids.tree, hint)
            which, height, x, y = triangle_hit(vertex, row, body, piece, everything(piece), 0.0, scratch)
        if which < 0:
            hint = -1
            triangle, which, height, x, y = deep_hit(solids.tree, body, piece, scratch)
        if triangle < 0:
            if not inside(body, tool, mode, solids, within, scratch):
                return FREE, slide, NO_REASON, most
            # It touches no skin, and lies in a body: how far it may slide there is not looked for.
            reason, sure = INSIDE if reason == NO_REASON else reason, False
            count = remove(intervals, count, slide - _IN_BODY * length, slide + _IN_BODY * length, _NO_PLACE)
            if length <= 0.0:
                return NONE, 0.0, reason, most
            continue
        if reason == NO_REASON:
            part = int(piece[which, PART])
            near = (height * cosine + rise) ** 2 + (x - offset) ** 2 + y * y <= tool.reach * tool.reach
            reason = BY_NECK + part - NECK if part != FLUTES else REAR_GOUGE if near else COLLISION
        if length <= 0.0:
            return NONE, 0.0, reason, triangle
        # The tool slides against the tilt direction: in its frame a point goes with it.
        point = (height, x, y)
        first = slide - _end(piece, which, point, (-sine, -cosine), slide)
        last = slide + _end(piece, which, point, (sine, cosine), length - slide)
        count = remove(intervals, count, min(first, slide - 0.5 * _NO_PLACE), max(last, slide + 0.5 * _NO_PLACE), _NO_PLACE)
        if last - first > widest:
            widest, most = last - first, triangle
        wish = length if wish == 0.0 else -1.0
    return NONE if sure and count == 0 else UNKNOWN, 0.0, reason, most


@entry
def along_flank(rows, axis, contacts, flank, away, tool, solids, within, state, shift, reason, hint):
    """Lay the flank of a tool along surfaces, with its axis as it is given.

    Parameters
    ----------
    rows : (m,) int64
        Contacts.
    axis : (m, 3) float64
        Unit tool axis at each, nowhere along the normal.
    contacts : Contacts
    flank : (int, float)
        The mode in which the lower end of the flank touches, and by how much the tool may slide with the contact still on its
        flank, mm.
    away : (k,) float64
        Distances from the contact, mm, that are tried one after the other, across the axis.
    tool : Tool
    solids : Solids
    within : float
        Winding number from which a place lies within a body.
    state : (m,) int8, written
        FREE at one of the distances; NONE: at each something is in the way, wherever along the flank; or UNKNOWN.
    shift : (m, 3) float64, written
        Where it is free: from the contact to the point at which the lower end of the flank is put down, mm.
    reason : (m,) uint8, written
        Where it is not: what is in the way of the first place; with a hint, of the first that was looked at.
    hint : (m,) int64, read and written
        A triangle that may well be in the way, or -1: where another axis was tried, that which took away most of the slide. A
        place is none for the same proof with one, and one that is free is looked for without it.

    Returns
    -------
    int
        How many boxes were looked at.
    """
    mode, length = flank
    body, f, t, point, intervals, workspace = np.empty(BODY), np.empty(3), np.empty(3), np.empty(3), np.empty((64, 2)), scratch()
    for i in range(len(rows)):
        p, n, a = contacts.point[rows[i]], contacts.normal[rows[i]], axis[i]
        cosine = dot(a, n)
        for k in range(3):
            f[k] = a[k] - cosine * n[k]
        sine = np.sqrt(dot(f, f))
        for k in range(3):
            f[k] /= sine
        cross(n, f, t)
        state[i] = NONE
        for j in range(len(away)):
            for k in range(3):
                # Across the axis, out of the material.
                point[k] = p[k] + away[j] * (sine * n[k] - cosine * f[k])
            frame, turn = Frame(point, n, f, t), (cosine, sine)
            here, slide, why, most = _slid(frame, turn, length, tool, mode, solids, within, hint[i], body, intervals, workspace)
            if here != NONE and hint[i] >= 0:
                here, slide, why, most = _slid(frame, turn, length, tool, mode, solids, within, -1, body, intervals, workspace)
            hint[i] = most
            if j == 0:
                reason[i] = why
            if here == UNKNOWN:
                state[i] = UNKNOWN
            if here == FREE:
                state[i] = FREE
                for k in range(3):
                    shift[i, k] = point[k] - slide * f[k] - p[k]
                break
    return workspace.looked[0]
