"""All rotations of one sample in turn: a posture, or that there is none.

At each rotation the points that forbade tilts there at the sample before are asked first: a neighbour's obstacles stand
nearly where its own do, and an arc costs a hundredth of a walk of the tree. A tilt that they leave is shown to the points
last met at any rotation, and only then to the tree. What nothing forbids is a posture.
"""

from typing import Any, NamedTuple

import numpy as np

from plan_cutters.kernels.hit import cross, deep_hit, stand
from plan_cutters.kernels.jit import entry, kernel
from plan_cutters.kernels.probing import (
    BURIED,
    COLLISION,
    REAR_GOUGE,
    allowed,
    forbid,
    forbid_point,
    forbid_probed,
    inner_height,
    inside,
    next_tilt,
    turned,
)
from plan_cutters.kernels.rows import Frame

#: Points remembered for each rotation, and of those that the tree gave last.
_KEPT, _POOL = 64, 128


class Memory(NamedTuple):
    """What the sweeps before have met: points (rotations, k, 3) that forbade tilts of each, and how many (rotations,); the
    last points (3, m) that the tree gave, and the same as seen from the contact, along direction_max, e2 and the normal;
    how deep each is in the cutter (m,); how many the tree gave in all (1,).
    """

    point: Any
    count: Any
    pool: Any
    seen: Any
    depth: Any
    given: Any


@entry
def memory(rotations):  # type: ignore[no-untyped-def]
    """Nothing remembered yet."""
    return Memory(
        np.empty((rotations, _KEPT, 3)), np.zeros(rotations, np.int64), np.full((3, _POOL), np.inf),
        np.empty((3, _POOL)), np.empty(_POOL), np.zeros(1, np.int64),
    )  # fmt: skip


@kernel
def _see(past, slot, p, e1, e2, n):  # type: ignore[no-untyped-def]
    """Write a point of the pool as seen from the contact."""
    x, y, z = past.pool[0, slot] - p[0], past.pool[1, slot] - p[1], past.pool[2, slot] - p[2]
    past.seen[0, slot] = x * e1[0] + y * e1[1] + z * e1[2]
    past.seen[1, slot] = x * e2[0] + y * e2[1] + z * e2[2]
    past.seen[2, slot] = x * n[0] + y * n[1] + z * n[2]


@kernel
def _deepest(past, count, turn, tilt, tool):  # type: ignore[no-untyped-def]
    """The point of the pool that is deepest in the cutter at a posture, in the tool's frame; nan if none is in it."""
    seen, depth, (cosine, sine) = past.seen, past.depth, turn
    up, out, radius = np.cos(tilt), np.sin(tilt), tool.radius
    for i in range(count):
        x = cosine * seen[0, i] + sine * seen[1, i]
        y = cosine * seen[1, i] - sine * seen[0, i]
        height = up * seen[2, i] + out * x
        px = radius + up * x - out * seen[2, i]
        depth[i] = min(min(height - tool.low, tool.high - height), tool.shrunk - np.sqrt(px * px + y * y))
    best, found = 0.0, -1
    for i in range(count):
        if depth[i] > best:
            best, found = depth[i], i
    if found < 0:
        return np.nan, np.nan, np.nan
    x = cosine * seen[0, found] + sine * seen[1, found]
    y = cosine * seen[1, found] - sine * seen[0, found]
    return up * seen[2, found] + out * x, radius + up * x - out * seen[2, found], y


@kernel
def sweep(contacts, row, ranges, tool, length, solids, within, narrowest, start, turns, past, room):  # type: ignore[no-untyped-def]
    """Look for a posture of one sample at all rotations, those next to the first looked at first.

    Parameters
    ----------
    contacts : Contacts
    row : int
        The sample.
    ranges : Ranges
    tool : Tool
        The cutter, shrunk by the depth that does not matter.
    length : float
        Of the cutter itself, mm.
    solids : Solids
        What is in the way.
    within : float
        Winding number from which a posture lies within a body.
    narrowest : float
        Intervals of tilt narrower than this are passed over, rad.
    start : (int, float)
        Rotation to begin with, and the tilt that is tried first at each.
    turns : int
        How many rotations to look at.
    past : Memory, read and written
    room : Room
        Tilts are booked on what forbids them.

    Returns
    -------
    rotation : int
        -1 if there is no posture.
    tilt : float
        rad.
    """
    p, n, e1, e2 = contacts.point[row], contacts.normal[row], contacts.direction_max[row], room.e2
    intervals, f, t, body, tally = room.intervals, room.f, room.t, room.body, room.tally
    cross(n, e1, e2)
    frame, rotations = Frame(p, n, f, t), len(ranges.rotation_cos)
    tally[:] = 0.0
    pooled = -1
    for step in range(turns):
        side = (step + 1) // 2 if step % 2 else -(step // 2)
        rotation = (start[0] + side) % rotations
        turn = ranges.rotation_cos[rotation], ranges.rotation_sin[rotation]
        count = allowed(contacts, row, ranges, rotation, tool.radius, room)
        known, kept = past.count[rotation], 0
        for i in range(known):
            if count == 0:
                break
            x, y, z = 0.0, 0.0, 0.0
            for k in range(3):
                offset = past.point[rotation, i, k] - p[k]
                x += offset * f[k]
                y += offset * t[k]
                z += offset * n[k]
            before = tally[REAR_GOUGE] + tally[COLLISION]
            count = forbid_point(x, y, z, tool, narrowest, intervals, count, tally)
            if tally[REAR_GOUGE] + tally[COLLISION] > before:
                for k in range(3):
                    past.point[rotation, kept, k] = past.point[rotation, i, k]
                kept += 1
        wish = start[1]
        while count > 0:
            tilt, wish = next_tilt(intervals, count, wish), -1.0
            # Mostly the first posture of all is free, as it was at the sample before: then the pool is not looked at.
            new = pooled < 0
            if not new:
                height, px, py = _deepest(past, pooled, turn, tilt, tool)
                new = np.isnan(height)
            if new:
                stand(body, frame, np.cos(tilt), np.sin(tilt), tool.radius, tool.shrunk, tool.low, tool.high)
                triangle, height, px, py = deep_hit(solids.tree, body, room.scratch)
                if triangle < 0:
                    if inside(body, inner_height(tool.radius, length), solids, room.scratch.stack) < within:
                        past.count[rotation] = kept
                        return rotation, tilt
                    half = max(turned(frame, tilt, tool, solids.tree, body, room.scratch), 0.5 * narrowest)
                    count = forbid(intervals, count, tilt - half, tilt + half, narrowest, BURIED, tally)
                    continue
            count, x, y, z = forbid_probed(height, px, py, tilt, tool, narrowest, intervals, count, tally)
            if kept < _KEPT:
                for k in range(3):
                    past.point[rotation, kept, k] = p[k] + x * f[k] + y * t[k] + z * n[k]
                kept += 1
            if new:
                slot = past.given[0] % _POOL
                for k in range(3):
                    past.pool[k, slot] = p[k] + x * f[k] + y * t[k] + z * n[k]
                past.given[0] += 1
                if pooled < 0:
                    for i in range(min(past.given[0], _POOL)):
                        _see(past, i, p, e1, e2, n)
                else:
                    _see(past, slot, p, e1, e2, n)
                pooled = min(past.given[0], _POOL)
        past.count[rotation] = kept
    return -1, 0.0
