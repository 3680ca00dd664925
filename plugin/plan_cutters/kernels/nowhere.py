"""Is there surely no posture? A proof, mostly from what was in the way at the sample before.

At each rotation the points that forbade all its tilts at the sample before are asked first: a neighbour's obstacles stand
nearly where its own do, and an arc costs a hundredth of a walk of the tree. A tilt that they leave is shown to the points
last found at all rotations, and only then to the tree. The proof fails at the first tilt that nothing forbids.
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
_NARROWEST = 1e-5


class Memory(NamedTuple):
    """What the proofs before have found: points (rotations, k, 3) that forbade all tilts of each, and how many (rotations,);
    the last points (3, m) that the tree gave, and the same as seen from the contact, along direction_max, e2 and the
    normal; how deep each is in the cutter (m,); tallies: points the tree gave, rotation at which a proof failed last.
    """

    point: Any
    count: Any
    pool: Any
    seen: Any
    depth: Any
    tally: Any


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
def nowhere(contacts, row, ranges, tool, length, solids, within, start, past, room):  # type: ignore[no-untyped-def]
    """Whether it is proved that a sample has no posture at any rotation.

    Parameters
    ----------
    contacts : Contacts
    row : int
        The sample.
    ranges : Ranges
    tool : Tool
        The cutter, shrunk by the depth that certainly matters.
    length : float
        Of the cutter itself, mm.
    solids : Solids
        What is surely in the way.
    within : float
        Winding number from which a posture lies within a body.
    past : Memory
    room : Room
        Tilts are booked on what forbids them, as the searches do.
    """
    p, n, e1, e2 = contacts.point[row], contacts.normal[row], contacts.direction_max[row], room.e2
    intervals, f, t, body, tally = room.intervals, room.f, room.t, room.body, room.tally
    cross(n, e1, e2)
    frame, rotations = Frame(p, n, f, t), len(ranges.rotation_cos)
    tally[:] = 0.0
    pooled = min(past.tally[0], _POOL)
    for i in range(pooled):
        _see(past, i, p, e1, e2, n)
    for step in range(rotations):
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
            count = forbid_point(x, y, z, tool, _NARROWEST, intervals, count, tally)
            if tally[REAR_GOUGE] + tally[COLLISION] > before:
                for k in range(3):
                    past.point[rotation, kept, k] = past.point[rotation, i, k]
                kept += 1
        wish = start[1]
        while count > 0:
            tilt, wish = next_tilt(intervals, count, wish), -1.0
            height, px, py = _deepest(past, pooled, turn, tilt, tool)
            new = np.isnan(height)
            if new:
                stand(body, frame, np.cos(tilt), np.sin(tilt), tool.radius, tool.shrunk, tool.low, tool.high)
                triangle, height, px, py = deep_hit(solids.tree, body, room.scratch)
                if triangle < 0:
                    if inside(body, inner_height(tool.radius, length), solids, room.scratch.stack) < within:
                        past.count[rotation] = kept
                        return rotation, tilt
                    half = turned(frame, tilt, tool, solids.tree, body, room.scratch)
                    count = forbid(intervals, count, tilt - half, tilt + half, _NARROWEST, BURIED, tally)
                    continue
            count, x, y, z = forbid_probed(height, px, py, tilt, tool, _NARROWEST, intervals, count, tally)
            if kept < _KEPT:
                for k in range(3):
                    past.point[rotation, kept, k] = p[k] + x * f[k] + y * t[k] + z * n[k]
                kept += 1
            if new:
                slot = past.tally[0] % _POOL
                for k in range(3):
                    past.pool[k, slot] = p[k] + x * f[k] + y * t[k] + z * n[k]
                _see(past, slot, p, e1, e2, n)
                past.tally[0] += 1
                pooled = min(past.tally[0], _POOL)
        past.count[rotation] = kept
    return -1, 0.0
