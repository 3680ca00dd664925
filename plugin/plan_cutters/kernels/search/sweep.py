"""All rotations of one sample in turn: a posture, or that there is none.

First among the tilts that curvature allows at the contact, then among the others: there the triangles alone decide.

At each rotation the points that forbade tilts there at the sample before are asked first: a neighbour's obstacles stand
nearly where its own do, and an arc costs a hundredth of a walk of the tree. A tilt that they leave is shown to the points
last met at any rotation, and only then to the tree. What nothing forbids is a posture.
"""

from collections import namedtuple
from typing import Any, NamedTuple

import numpy as np

from plan_cutters.kernels.codes import ARC, HIGH, INSIDE, KIND, LOW, OFFSET_OF, RADIUS, RISE, ROUND, SCALE, SLOPE
from plan_cutters.kernels.jit import kernel, maker
from plan_cutters.kernels.limits import turn_of
from plan_cutters.kernels.linear.vectors import cross
from plan_cutters.kernels.rows import Frame
from plan_cutters.kernels.search import place
from plan_cutters.kernels.tool.hit import tree_hit

#: Points remembered for each rotation, and of those that the tree gave last.
_CACHED, _POOL = 64, 128
#: Boxes in whose time a rotation is gone through, of a tool that touches in one way, about.
ROTATION = 16
#: What a sweep says in place of a rotation: there is no posture; it was given up before it knew.
NONE, UNFINISHED = -1, -2
#: Whether a sample was looked at as `enclosed` does: not yet, in vain, and with the proof.
_NEVER, _TRIED, _PROVED = 0, 1, 2
#: Boxes that are never reached: a sweep with it is never given up.
WITHOUT_END = 1 << 60


#: It is the obstacle cache: it holds the points that earlier sweeps have met.
#: point (rotations x modes, k, 3), count: points that forbade tilts of each rotation and mode, and how many of each. pool (3, m):
#: the last points that the tree gave; seen (3, m): the same from the contact, along direction_max, e2 and the normal; depth (m,),
#: which (m,): how deep each is in the tool, and in which piece. given (1,): how many points the tree gave in all. bent: whether
#: the sweeps are among the tilts that curvature forbids.
Memory = namedtuple("Memory", "point count pool seen depth which given bent")


class Side(NamedTuple):
    """This record is one side of a search: the outer tool with the possible obstacles, or the inner with the certain ones."""

    tool: Any
    solids: Any
    within: float  #: Winding number from which a posture lies within a body.
    narrowest: float  #: The angular resolution, rad: narrower intervals of tilts are passed over.
    most: int  #: Boxes looked at after which the rotations that are left are not looked at.
    proof: Any  #: How one look proves that there is no posture (`place.Proof`).


@maker
def memory(rotations, modes, bent):
    """Make an empty obstacle cache."""
    return Memory(
        np.empty((rotations * modes, _CACHED, 3)), np.zeros(rotations * modes, np.int64), np.full((3, _POOL), np.inf),
        np.empty((3, _POOL)), np.empty(_POOL), np.empty(_POOL, np.int64), np.zeros(1, np.int64), bent,
    )  # fmt: skip


@kernel
def _see(obstacle_cache, slot, p, e1, e2, n):
    """Write a point of the pool as seen from the contact."""
    x, y, z = (obstacle_cache.pool[0, slot] - p[0], obstacle_cache.pool[1, slot] - p[1], obstacle_cache.pool[2, slot] - p[2])
    obstacle_cache.seen[0, slot] = x * e1[0] + y * e1[1] + z * e1[2]
    obstacle_cache.seen[1, slot] = x * e2[0] + y * e2[1] + z * e2[2]
    obstacle_cache.seen[2, slot] = x * n[0] + y * n[1] + z * n[2]


@kernel
def _deepest(obstacle_cache, count, turn, tilt, tool, mode):
    """The piece and the point of the pool that is deepest in the tool at a posture, in the tool's frame; -1 if none is in it.

    Piece by piece and without a branch among points, so that the compiler uses the lanes of the processor.
    """
    seen, depth, which, (cosine, sine) = obstacle_cache.seen, obstacle_cache.depth, obstacle_cache.which, turn
    up, out, offset, rise = np.cos(tilt), np.sin(tilt), tool.mode[mode, OFFSET_OF], tool.mode[mode, RISE]
    for i in range(count):
        depth[i] = 0.0
    for k in range(tool.piece.shape[1]):
        low, high, radius = tool.piece[mode, k, LOW], tool.piece[mode, k, HIGH], tool.piece[mode, k, RADIUS]
        slope, ring_radius, scale = tool.piece[mode, k, SLOPE], tool.piece[mode, k, ROUND], tool.piece[mode, k, SCALE]
        if tool.piece[mode, k, KIND] == ARC:
            for i in range(count):
                x, z = cosine * seen[0, i] + sine * seen[1, i], seen[2, i] - rise
                y = cosine * seen[1, i] - sine * seen[0, i]
                height, px = up * z + out * x, offset + up * x - out * z
                r = max(0.0, np.sqrt(px * px + y * y) - radius)
                deep = ring_radius - np.sqrt(r * r + (height - slope) * (height - slope))
                deep = min(min(height - low, high - height), deep)
                which[i] = k if deep > depth[i] else which[i]
                depth[i] = max(depth[i], deep)
        else:
            for i in range(count):
                x, z = cosine * seen[0, i] + sine * seen[1, i], seen[2, i] - rise
                y = cosine * seen[1, i] - sine * seen[0, i]
                height, px = up * z + out * x, offset + up * x - out * z
                deep = (radius + slope * (height - low) - np.sqrt(px * px + y * y)) * scale
                deep = min(min(height - low, high - height), deep)
                which[i] = k if deep > depth[i] else which[i]
                depth[i] = max(depth[i], deep)
    best, deepest = 0.0, -1
    for i in range(count):
        if depth[i] > best:
            best, deepest = depth[i], i
    if deepest < 0:
        return -1, 0.0, 0.0, 0.0
    x, z = cosine * seen[0, deepest] + sine * seen[1, deepest], seen[2, deepest] - rise
    y = cosine * seen[1, deepest] - sine * seen[0, deepest]
    return which[deepest], up * z + out * x, offset + up * x - out * z, y


@kernel
def _rotation(contacts, row, ranges, rotation, mode, side, last, wish, frame, obstacle_cache, pooled, workspace):
    """`sweep` at one rotation and mode: (a tilt, -1 for none; how many points of the pool are seen from this contact).

    Tilts that are left when the boxes looked at, in all, are more than `last` are not looked at. The first posture that lies
    within a body has the sample looked at as `enclosed` does, once: where that proves it, no tilt is left at all.
    """
    tool, solids, within, narrowest = side.tool, side.solids, side.within, side.narrowest
    p, n, e1, e2, f, t = frame.p, frame.n, contacts.direction_max[row], workspace.e2, workspace.f, workspace.t
    intervals, body, tally = workspace.intervals, workspace.body, workspace.tally
    turn, slots = turn_of(n, e1, ranges, rotation), rotation * len(tool.mode) + mode
    count = place.allowed(contacts, row, ranges, rotation, tool, mode, obstacle_cache.bent, workspace)
    known, written = obstacle_cache.count[slots], 0
    for i in range(known):
        if count == 0:
            break
        x, y, z = 0.0, 0.0, 0.0
        for k in range(3):
            offset = obstacle_cache.point[slots, i, k] - p[k]
            x += offset * f[k]
            y += offset * t[k]
            z += offset * n[k]
        before = place.booked(tally)
        count = place.forbid_point(x, y, z, tool, mode, narrowest, intervals, count, workspace)
        if place.booked(tally) > before:
            for k in range(3):
                obstacle_cache.point[slots, written, k] = obstacle_cache.point[slots, i, k]
            written += 1
    while count > 0 and workspace.scratch.looked[0] <= last:
        tilt, wish = place.next_tilt(intervals, count, wish), -1.0
        # Mostly the first posture of all is free, as it was at the sample before: then the pool is not looked at.
        which = -1
        if pooled >= 0:
            which, height, px, py = _deepest(obstacle_cache, pooled, turn, tilt, tool, mode)
        new = which < 0
        if new:
            place.put(body, frame, tilt, tool, mode)
            triangle, which, height, px, py = tree_hit(solids.tree, body, tool.piece[mode], 0.0, -1, workspace.scratch, True)
            if triangle < 0:
                if not place.inside(body, tool, mode, solids, within, workspace.scratch):
                    obstacle_cache.count[slots] = written
                    return tilt, pooled
                if workspace.proved[0] == _NEVER:
                    workspace.proved[0] = _PROVED if place.enclosed(contacts, row, side.proof, workspace.scratch) else _TRIED
                if workspace.proved[0] == _PROVED:
                    return -1.0, pooled
                half = max(place.turned(frame, tilt, tool, mode, solids.tree, body, workspace.scratch), 0.5 * narrowest)
                count = place.forbid(intervals, count, tilt - half, tilt + half, narrowest, INSIDE, tally)
                continue
        count, x, y, z = place.forbid_probed(which, height, px, py, tilt, tool, mode, narrowest, intervals, count, workspace)
        if written < _CACHED:
            for k in range(3):
                obstacle_cache.point[slots, written, k] = p[k] + x * f[k] + y * t[k] + z * n[k]
            written += 1
        if new:
            slot = obstacle_cache.given[0] % _POOL
            for k in range(3):
                obstacle_cache.pool[k, slot] = p[k] + x * f[k] + y * t[k] + z * n[k]
            obstacle_cache.given[0] += 1
            if pooled < 0:
                for i in range(min(obstacle_cache.given[0], _POOL)):
                    _see(obstacle_cache, i, p, e1, e2, n)
            else:
                _see(obstacle_cache, slot, p, e1, e2, n)
            pooled = min(obstacle_cache.given[0], _POOL)
    obstacle_cache.count[slots] = written
    return -1.0, pooled


@kernel
def sweep(contacts, row, ranges, side, start, turns, obstacle_cache, workspace):
    """Look for a posture of one sample at all rotations, those next to the first looked at first.

    It looks among the tilts that `obstacle_cache` is about, which it reads and writes.

    `row`: the sample.
    `side` (Side): tool and obstacles, both possible or both certain.
    `start` (int, float): rotation to begin with, and the tilt that is tried first at each.
    `turns` (int): how many rotations to look at.
    `workspace`: forbidden tilts are booked in its tally, by reason.
    Returns the rotation, `NONE` if there is no posture, `UNFINISHED` if none was found among the rotations looked at; the tilt,
      rad.
    """
    p, n, e1, e2 = contacts.point[row], contacts.normal[row], contacts.direction_max[row], workspace.e2
    f, t, tally = workspace.f, workspace.t, workspace.tally
    cross(n, e1, e2)
    frame, rotations, modes = Frame(p, n, f, t), len(ranges.rotation_cos), len(side.tool.mode)
    tally[:], workspace.proved[0] = 0.0, _NEVER
    pooled, last = -1, workspace.scratch.looked[0] + side.most
    for step in range(turns):
        off = (step + 1) // 2 if step % 2 else -(step // 2)
        rotation = (start[0] + off) % rotations
        workspace.scratch.looked[0] += ROTATION * modes
        for mode in range(modes):
            tilt, pooled = _rotation(
                contacts, row, ranges, rotation, mode, side, last, start[1], frame, obstacle_cache, pooled, workspace
            )
            if tilt >= 0.0:
                return rotation, tilt
            if workspace.proved[0] == _PROVED:
                place.book_inside(tally)
                return NONE, 0.0
            if workspace.scratch.looked[0] > last:
                return UNFINISHED, 0.0
    return NONE, 0.0


@maker
def both(rotations, modes):
    """Make empty obstacle caches for both kinds of sweep, and a workspace for each."""
    return (memory(rotations, modes, False), memory(rotations, modes, True)), (place.search_workspace(), place.search_workspace())


@kernel
def sweep_both(contacts, row, ranges, side, pasts, starts, turns, workspaces):
    """Search as `sweep` among the tilts that curvature allows at the contact, and, where these hold no posture, among the others.

    `pasts`, `starts` and `workspaces` are one for each kind of sweep, as `sweep` takes them. The two remember nothing of each
    other, so that a sample that needs the others moves no posture of the samples after it. Returns rotation and tilt, and the
    starts for the next sample.
    """
    rotation, tilt = sweep(contacts, row, ranges, side, starts[0], turns, pasts[0], workspaces[0])
    if rotation >= 0:
        return rotation, tilt, ((rotation, tilt), starts[1])
    if ranges.strict or rotation == UNFINISHED or workspaces[0].proved[0] == _PROVED:
        workspaces[1].tally[:] = 0.0
        return rotation, 0.0, starts
    rotation, tilt = sweep(contacts, row, ranges, side, starts[1], turns, pasts[1], workspaces[1])
    if rotation >= 0:
        return rotation, tilt, (starts[0], (rotation, tilt))
    if workspaces[1].proved[0] == _PROVED:
        place.book_inside(workspaces[0].tally)
    return rotation, 0.0, starts
