"""Free tilts of samples at all rotations, with certified ends, in one walk of the tree a rotation.

A gap of tilts is taken through the tree and only shrinks. Boxes are kept as seen from the contact: what rises nowhere above
the tangent plane is out of reach at every posture and left out for all rotations. A box in the way is first asked for one
of its points, whose arc is known in closed form: so gaps are nearly what they will be before any triangle is looked at.
"""

from typing import Any, NamedTuple

import numpy as np

from plan_cutters.kernels.arcs import axis_arcs, local_gouge, point_arc
from plan_cutters.kernels.gaps import COLUMNS, FIRST, GAPS, LAST, UF, UL, Room, _begin, _cut_gaps, _cuts, _end, _take
from plan_cutters.kernels.hit import BODY, scratch
from plan_cutters.kernels.jit import entry, kernel
from plan_cutters.kernels.lanes import LANES, _boxes_pass, _see, _see_leaf, _see_triangle, _triangles_pass, _turn
from plan_cutters.kernels.probing import remove
from plan_cutters.kernels.rows import Frame
from plan_cutters.kernels.vectors import cross, dot, lean_frame

#: Blocks of boxes kept as seen from one contact, and blocks that may wait to be looked at.
_SEEN, _QUEUE = 1 << 11, 1 << 13
#: Leaves of triangles kept so; one more for others, two for the triangles that are tried first.
_LEAVES = 1 << 11
#: What is known of the boxes in a block below another: not looked at yet, none rises above the tangent plane.
_UNSEEN, _NONE = -1, -2


@kernel
def _forget(below, home, block, lane):  # type: ignore[no-untyped-def]
    """Leave a box out for this contact, and those above it in which nothing else is left."""
    while block < _SEEN:
        below[block, lane] = _NONE
        for other in range(LANES):
            if below[block, other] != _NONE:
                return
        if home[block, 0] < 0:
            return
        block, lane = home[block, 0], home[block, 1]


@kernel
def _rising(view, below, block, lanes, low):  # type: ignore[no-untyped-def]
    """Mark the boxes of a block just seen that rise above the tangent plane; whether there are any."""
    some = False
    for lane in range(LANES):
        rises = lane < lanes and view[block, 12, lane] > low
        below[block, lane] = _UNSEEN if rises else _NONE
        some = some or rises
    return some


@kernel
def _leaf(seen, which, vertex, frame, turn, gap, count, tool, narrowest, margin, room):  # type: ignore[no-untyped-def]
    """Take what the triangles of a leaf forbid out of the gaps; (gaps, the lane that cut last or -1)."""
    cosine, sine = turn
    _triangles_pass(seen, cosine, sine, gap, count, tool, margin)
    last = -1
    for lane in range(LANES):
        if margin[lane] >= 0.0 or count == 0:
            continue
        _turn(seen, lane, cosine, sine, room.corner)
        count, cut = _cut_gaps(vertex, which[lane], frame, gap, count, narrowest, tool, room)
        if cut:
            last = lane
    return count, last


class _View(NamedTuple):
    """What is kept of the tree as seen from one contact, for all rotations: boxes and leaves, what lies below each box, which
    box each block hangs below, and tallies: blocks and leaves kept, place of the next triangle that is tried first.

    known (rotations + 1, LANES): triangles that cut gaps of each rotation last, of this sample or the one before, the last row
    those of any; place (rotations,) of the next of a rotation. What is `reach` away from the contact is out of reach.
    """

    boxes: Any
    leaves: Any
    below: Any
    home: Any
    tally: Any
    known: Any
    place: Any
    queue: Any
    ahead: Any
    margin: Any
    inside: Any
    which: Any
    reach: float


@kernel
def _rotation(frame, e1, e2, turn, rotation, gap, count, tool, narrowest, wide, seen, room):  # type: ignore[no-untyped-def]
    """Take the gaps of one rotation, its cosine and sine `turn`, through the tree, level by level; how many are left."""
    p, n = frame.p, frame.n
    radius, shrunk, low, high, _ = tool
    cosine, sine = turn
    vertex, blocks, offset, bottom = wide
    view, leaves, below, home, tally = seen.boxes, seen.leaves, seen.below, seen.home, seen.tally
    known, queue, ahead = seen.known, seen.queue, seen.ahead
    place = seen.place
    margin, inside, which = seen.margin, seen.inside, seen.which
    triangles, levels = len(vertex), len(offset) - 1
    for k in range(LANES):
        _see_triangle(leaves[_LEAVES + 2], k, vertex, known[rotation, k], p, e1, e2, n)
    count, _ = _leaf(
        leaves[_LEAVES + 2], known[rotation], vertex, frame, turn, gap, count, tool, narrowest, inside, room
    )
    count, _ = _leaf(leaves[_LEAVES + 1], known[-1], vertex, frame, turn, gap, count, tool, narrowest, inside, room)
    queue[0, 0], queue[0, 1] = 0, 0
    waiting = 1
    for level in range(levels):
        coming = 0
        for w in range(waiting):
            if count == 0:
                return 0
            slot, block = queue[w, 0], queue[w, 1]
            if slot < 0:
                slot = _SEEN
                _see(view, slot, blocks, offset[level] + block, p, e1, e2, n, seen.reach)
                _rising(view, below, slot, LANES, low)
            _boxes_pass(view, slot, cosine, sine, gap, count, tool, margin)
            for lane in range(LANES):
                inner = below[slot, lane]
                if margin[lane] >= 0.0 or inner == _NONE or count == 0:
                    continue
                box = 8 * block + lane
                if level == levels - 1:
                    begin, end = (triangles * box) >> bottom, (triangles * (box + 1)) >> bottom
                    if inner == _UNSEEN:
                        inner = min(tally[1], _LEAVES)
                        if _see_leaf(leaves[inner], vertex, begin, end, p, e1, e2, n) <= low:
                            _forget(below, home, slot, lane)
                            continue
                        if inner < _LEAVES:
                            tally[1] += 1
                            below[slot, lane] = inner
                    for k in range(LANES):
                        which[k] = begin + k
                    count, cut = _leaf(
                        leaves[inner], which, vertex, frame, turn, gap, count, tool, narrowest, inside, room
                    )
                    if cut >= 0:
                        known[-1, tally[2]] = begin + cut
                        for k in range(9):
                            leaves[_LEAVES + 1, k, tally[2]] = leaves[inner, k, cut]
                        tally[2] = (tally[2] + 1) % LANES
                        known[rotation, place[rotation]] = begin + cut
                        place[rotation] = (place[rotation] + 1) % LANES
                    continue
                x, y, z = view[slot, 13, lane], view[slot, 14, lane], view[slot, 15, lane]
                x, y = cosine * x + sine * y, cosine * y - sine * x
                if _cuts(x, y, z, gap, count, tool):
                    left, right = point_arc(z, x + radius, y, 0.0, radius, shrunk, low, high)
                    count = _take(gap, count, left, right)
                if inner == _UNSEEN and tally[0] < _SEEN:
                    inner = tally[0]
                    _see(view, inner, blocks, offset[level + 1] + box, p, e1, e2, n, seen.reach)
                    if not _rising(view, below, inner, LANES, low):
                        _forget(below, home, slot, lane)
                        continue
                    below[slot, lane], home[inner, 0], home[inner, 1] = inner, slot, lane
                    tally[0] += 1
                if coming == _QUEUE:
                    # Too much in the way to be told apart: nothing here is called free.
                    for g in range(count):
                        gap[GAPS, UF] += gap[g, LAST] - gap[g, FIRST] + gap[g, UF] + gap[g, UL]
                    return 0
                ahead[coming, 0], ahead[coming, 1] = inner, box
                coming += 1
        queue, ahead = ahead, queue
        waiting = coming
    return count


@kernel
def _write(gap, count, room, part):  # type: ignore[no-untyped-def]
    """Write the gaps as intervals, ascending; (how many, width of what is undecided at their ends and beyond `room`)."""
    written, unsure = 0, gap[GAPS, UF] + gap[GAPS, UL]
    for g in range(count):
        unsure += gap[g, UF] + gap[g, UL]
        if gap[g, LAST] <= gap[g, FIRST]:
            continue
        if written == room:
            unsure += gap[g, LAST] - gap[g, FIRST]
            continue
        at = written
        while at > 0 and part[at - 1, 0] > gap[g, FIRST]:
            part[at, 0], part[at, 1] = part[at - 1, 0], part[at - 1, 1]
            at -= 1
        part[at, 0], part[at, 1] = gap[g, FIRST], gap[g, LAST]
        written += 1
    return written, unsure


@entry
def free_map(  # type: ignore[no-untyped-def]
    rows, contacts, ranges, tool, narrowest, wide, room, part, count_out, undecided
):
    """Free tilts of samples at all rotations, in one walk of the tree each, with certified ends.

    Parameters
    ----------
    rows : (m,) int64
    contacts : Contacts
    ranges : Ranges
    tool : Cylinder
        The cutter, smaller by the depth that does not matter.
    narrowest : float
        Ends are found to this, rad; a passing tilt is kept.
    wide : WideTree
    room : int
        Most intervals of one rotation.
    part : (m, k, room, 2) float64, written
        Free intervals, ascending, by place in `rows`.
    count_out : (m, k) int32, written
    undecided : (m, k) float64, written
        Width of the bands at the ends that are neither free nor known to be forbidden, rad in all.
    """
    t, f, e2 = np.empty(3), np.empty(3), np.empty(3)
    gap, arcs = np.empty((GAPS + 1, COLUMNS)), np.empty((8, 2))
    work = Room(
        np.empty((3, 3)), np.empty((8, 3)), np.empty((8, 3)), np.empty(BODY), np.empty((64, 2)),
        scratch(),
    )  # fmt: skip
    view = _View(
        np.empty((_SEEN + 1, 16, LANES)), np.empty((_LEAVES + 3, 9, LANES)), np.empty((_SEEN + 1, LANES), np.int64),
        np.empty((_SEEN, 2), np.int64), np.zeros(3, np.int64), np.zeros((len(ranges.rotation_cos) + 1, LANES), np.int64),
        np.zeros(len(ranges.rotation_cos), np.int64),
        np.empty((_QUEUE, 2), np.int64), np.empty((_QUEUE, 2), np.int64), np.empty(LANES), np.empty(LANES),
        np.empty(LANES, np.int64), np.hypot(tool.high, tool.radius + tool.shrunk),
    )  # fmt: skip
    for place in range(len(rows)):
        row = rows[place]
        p, n, e1 = contacts.point[row], contacts.normal[row], contacts.direction_max[row]
        cross(n, e1, e2)
        frame = Frame(p, n, f, t)
        view.home[0, 0], view.tally[0], view.tally[1] = -1, 1, 0
        _see(view.boxes, 0, wide.blocks, 0, p, e1, e2, n, view.reach)
        some = _rising(view.boxes, view.below, 0, 1 << (wide.bottom % 3), tool.low)
        for lane in range(LANES):
            _see_triangle(view.leaves[_LEAVES + 1], lane, wide.vertex, view.known[-1, lane], p, e1, e2, n)
        for rotation in range(len(ranges.rotation_cos)):
            cosine, sine = ranges.rotation_cos[rotation], ranges.rotation_sin[rotation]
            lean_frame(e1, e2, cosine, sine, f, t)
            count_out[place, rotation], undecided[place, rotation] = 0, 0.0
            least, _ = local_gouge(
                contacts.curvature[row, 0], contacts.curvature[row, 1], cosine, sine, tool.radius, 0.0
            )
            if np.isnan(least):
                continue
            count = axis_arcs(
                dot(ranges.setup, n),
                dot(ranges.setup, f),
                ranges.limit_cos,
                ranges.tilt_low,
                min(0.5 * np.pi, ranges.tilt_high),
                arcs,
            )
            if least > 0.0:
                count = remove(arcs, count, -1.0, least, 0.0)
            gap[GAPS, UF], gap[GAPS, UL] = 0.0, 0.0
            for g in range(count):
                _begin(gap, g, arcs[g, 0], 0.0)
                _end(gap, g, arcs[g, 1], 0.0)
            if some and count > 0:
                count = _rotation(
                    frame, e1, e2, (cosine, sine), rotation, gap, count, tool, narrowest, wide, view, work
                )
            count_out[place, rotation], undecided[place, rotation] = _write(gap, count, room, part[place, rotation])
