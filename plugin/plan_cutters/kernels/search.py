"""Is there a posture? Probe a tilt; whatever is in the way forbids a whole arc; probe what is left.

A found posture is safe: no triangle reaches deeper into the cutter than `safe`. Where none is found, the same search
at the depth `blocked` decides whether the sample is inaccessible (everything is forbidden by what certainly lies too
deep) or undecided. A cutter that touches nothing may still lie within a body: then so does every posture that it can be
turned to without touching a skin.
"""

from typing import Any, NamedTuple

import numpy as np

from plan_cutters.kernels.arcs import axis_arcs, local_gouge
from plan_cutters.kernels.hit import BODY, cross, dot, lean_frame, perpendicular, scratch, stand, tree_hit
from plan_cutters.kernels.jit import entry, kernel
from plan_cutters.kernels.material import MAYBE_INSIDE, SURELY_INSIDE
from plan_cutters.kernels.nowhere import memory, nowhere
from plan_cutters.kernels.probing import (
    AXIS_LIMIT,
    BURIED,
    COLLISION,
    LOCAL_GOUGE,
    NARROWEST,
    REAR_GOUGE,
    allowed,
    forbid,
    forbid_point,
    forbid_probed,
    inner_height,
    inside,
    next_tilt,
    remove,
    room_to_search,
    turned,
)
from plan_cutters.kernels.rows import Frame, Tool

# As in `plan_cutters.domain.verdicts`, which must not load the compiler; a test holds them together.
INACCESSIBLE, ACCESSIBLE, INTERFERENCE_FREE, UNDECIDED, UNJUDGED = 0, 1, 2, 3, 255

#: Obstacle points remembered from probe to probe.
_KNOWN = 16
#: Rotations without a posture after which a proof that there is none is tried.
_PATIENCE = 1


class _Start(NamedTuple):
    """Where a search begins: the posture of the sample before, the triangle and the points (k, 3) that were last in the way,
    and how many of these there were in all."""

    rotation: int
    tilt: float
    hint: int
    known: Any
    known_count: int


@kernel
def _sweep(contacts, row, ranges, begin, end, tool, length, solids, start, room):  # type: ignore[no-untyped-def]
    """Search rotations of one sample; (index or -1, tilt, last triangle in the way, how many points were in it).

    Of the rotations, nearest to that of the start first, those from place `begin` to before `end`.
    A posture that may lie within a body is not taken.
    """
    p, n, e1 = contacts.point[row], contacts.normal[row], contacts.direction_max[row]
    intervals, f, t, body, tally = room.intervals, room.f, room.t, room.body, room.tally
    hint, known, known_count = start.hint, start.known, start.known_count
    cross(n, e1, room.e2)
    frame, rotations = Frame(p, n, f, t), len(ranges.rotation_cos)
    tally[:] = 0.0
    for turn in range(begin, min(rotations, end)):
        step = (turn + 1) // 2 if turn % 2 else -(turn // 2)
        rotation = (start.rotation + step) % rotations
        count = allowed(contacts, row, ranges, rotation, tool.radius, room)
        # What was in the way before, at other rotations and at the neighbours, is most likely so again.
        for i in range(min(known_count, len(known))):
            if count == 0:
                break
            x, y, z = 0.0, 0.0, 0.0
            for k in range(3):
                x += (known[i, k] - p[k]) * f[k]
                y += (known[i, k] - p[k]) * t[k]
                z += (known[i, k] - p[k]) * n[k]
            count = forbid_point(x, y, z, tool, NARROWEST, intervals, count, tally)
        wish = start.tilt
        while count > 0:
            tilt, wish = next_tilt(intervals, count, wish), -1.0
            stand(body, frame, np.cos(tilt), np.sin(tilt), tool.radius, tool.shrunk, tool.low, tool.high)
            triangle, height, px, py = tree_hit(solids.tree, body, 0.0, hint, room.scratch)
            if triangle < 0:
                if inside(body, inner_height(tool.radius, length), solids, room.scratch.stack) < MAYBE_INSIDE:
                    return rotation, tilt, hint, known_count
                half = turned(frame, tilt, tool, solids.tree, body, room.scratch)
                count = forbid(intervals, count, tilt - half, tilt + half, NARROWEST, BURIED, tally)
                continue
            hint = triangle
            count, x, y, z = forbid_probed(height, px, py, tilt, tool, NARROWEST, intervals, count, tally)
            for k in range(3):
                known[known_count % len(known), k] = p[k] + x * f[k] + y * t[k] + z * n[k]
            known_count += 1
    return -1, 0.0, hint, known_count


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
    room, patience, rotations = room_to_search(), _PATIENCE, len(ranges.rotation_cos)
    tally = room.tally
    light = Tool(radius, radius - safe, safe, length - safe)
    heavy = Tool(radius, radius - blocked, blocked, length - blocked)
    light_past, heavy_past = memory(rotations), memory(rotations)
    known, known_count = np.empty((_KNOWN, 3)), 0
    last_rotation, last_tilt, hint, heavy_start = 0, -1.0, -1, 0
    for row in rows:
        rotation, sure = -1, False
        if patience > 0:
            rotation, tilt, hint, known_count = _sweep(
                contacts, row, ranges, 0, patience, light, length, may_be,
                _Start(last_rotation, last_tilt, hint, known, known_count), room,
            )  # fmt: skip
        if rotation < 0:
            freed, _ = nowhere(
                contacts, row, ranges, heavy, length, surely, SURELY_INSIDE, (heavy_start, -1.0), heavy_past, room
            )
            sure = freed < 0
            if not sure:
                heavy_start = freed
                rotation, tilt = nowhere(
                    contacts, row, ranges, light, length, may_be, MAYBE_INSIDE, (last_rotation, last_tilt), light_past, room
                )
        # Where the sample before has no posture, this one most likely has none either.
        patience = _PATIENCE if rotation >= 0 else 0
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
            found.verdict[row] = INACCESSIBLE if sure else UNDECIDED
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
