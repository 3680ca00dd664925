"""Free tilts of samples at all rotations, with certified ends, in one walk of the tree a rotation.

An interval of tilts is taken through the tree and only shrinks. Boxes are kept as seen from the contact: what rises nowhere above
the tangent plane is out of reach at every posture and left out for all rotations. A box in the way is first asked for one
of its points, whose arc is known in closed form: so intervals are nearly what they will be before any triangle is looked at.
"""

from collections import namedtuple

import numpy as np

from plan_cutters.kernels import codes
from plan_cutters.kernels.codes import COLUMNS as PIECE
from plan_cutters.kernels.jit import entry, kernel
from plan_cutters.kernels.limits import turn_of
from plan_cutters.kernels.linear.tree import LANES, _see, _see_leaf, _see_triangle, _turn
from plan_cutters.kernels.linear.vectors import cross, tilt_frame
from plan_cutters.kernels.maps import passes, planes
from plan_cutters.kernels.maps.cuts import cut_intervals, cut_workspace, take_point
from plan_cutters.kernels.maps.passes import CF, CL, COLUMNS, FIRST, INTERVALS, LAST, SF, SL, UF, UL
from plan_cutters.kernels.maps.planes import FAR, FLOOR, NEAR
from plan_cutters.kernels.rows import Frame
from plan_cutters.kernels.search.place import permitted
from plan_cutters.kernels.tool.arcs import insert, join
from plan_cutters.kernels.tool.hit import stand, tree_hit

#: Blocks of boxes kept as seen from one contact, and blocks that may wait to be looked at.
_SEEN, _QUEUE = 1 << 11, 1 << 13
#: Leaves of triangles kept so; one more for others, two for the triangles that are tried first.
_LEAVES = 1 << 11
#: What is known of the boxes in a block below another: not looked at yet, none rises above the tangent plane.
_UNSEEN, _NONE = -1, -2


@kernel
def _forget(below, home, block, lane):
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
def _rising(view, below, block, lanes, low):
    """Mark the boxes of a block just seen that rise above the tangent plane; whether there are any."""
    some = False
    for lane in range(LANES):
        rises = lane < lanes and view[block, 12, lane] > low
        below[block, lane] = _UNSEEN if rises else _NONE
        some = some or rises
    return some


@kernel
def _leaf(leaf, which, vertex, frame, turn, interval, count, turning, mask, narrowest, margin, workspace):
    """Take what triangles of a leaf forbid to pieces of a mask out of the intervals; (their count, the last lane that cut)."""
    cosine, sine = turn
    last = -1
    for k in range(len(turning.piece)):
        if not (mask >> k) & 1 or count == 0:
            continue
        if (turning.eight >> k) & 1:
            passes._triangles_pass(leaf, cosine, sine, interval, count, planes.flutes(turning, k), margin)
        else:
            planes.turn_triangles(leaf, cosine, sine, workspace.turned)
            for lane in range(LANES):
                margin[lane] = 1.0
            for g in range(count):
                planes.all_ends(workspace.end, interval[g, CF], interval[g, SF], interval[g, CL], interval[g, SL])
                planes.triangles_clear(workspace.turned, workspace.end, turning, k, workspace.clear)
                for lane in range(LANES):
                    margin[lane] = min(margin[lane], workspace.clear[lane] - 0.5)
        for lane in range(LANES):
            if margin[lane] >= 0.0 or count == 0:
                continue
            _turn(leaf, lane, cosine, sine, workspace.corner)
            count, cut = cut_intervals(vertex, which[lane], frame, interval, count, narrowest, turning, k, workspace)
            if cut:
                last = lane
    return count, last


@kernel
def _reaching(view, block, cosine, sine, interval, count, turning, mask, margin, remaining, workspace):
    """Write for each box of a block the pieces of a mask that it may reach into in some interval."""
    for lane in range(LANES):
        remaining[lane] = 0
    turned = False
    for k in range(len(turning.piece)):
        if not (mask >> k) & 1:
            continue
        if (turning.eight >> k) & 1:
            passes._boxes_pass(view, block, cosine, sine, interval, count, planes.flutes(turning, k), margin)
            for lane in range(LANES):
                remaining[lane] |= 0 if margin[lane] >= 0.0 else 1 << k
            continue
        if not turned:
            planes.turn_boxes(view, block, cosine, sine, workspace.turned)
            turned = True
        for g in range(count):
            planes.all_ends(workspace.end, interval[g, CF], interval[g, SF], interval[g, CL], interval[g, SL])
            if not planes.boxes_clear(workspace.turned, workspace.end, turning, k, workspace.clear):
                for lane in range(LANES):
                    remaining[lane] |= 0 if workspace.clear[lane] > 0.0 else 1 << k


#: It caches the part of the tree that was visited, as seen from one contact, for all rotations.
#: boxes, leaves: the blocks of boxes and of triangles. below: the block below each box. home: the box above each block. tally:
#: blocks kept, leaves kept, the place of the next triangle that is tried first, and blocks visited in all.
#: known (rotations + 1, LANES): triangles that cut intervals of each rotation last, of this sample or the one before, the last
#: row those of any; place (rotations,) of the next of a rotation. Obstacles beyond `reach` of the contact cannot be hit.
_View = namedtuple("_View", "boxes leaves below home tally known place queue following margin inside which remaining reach")


@kernel
def _remember(seen, rotation, inner, lane, triangle):
    """Let a triangle that cut, in a lane of a cached leaf, be tried first: at all rotations, and at this one."""
    leaves, known, tally, place = seen.leaves, seen.known, seen.tally, seen.place
    known[-1, tally[2]] = triangle
    for k in range(9):
        leaves[_LEAVES + 1, k, tally[2]] = leaves[inner, k, lane]
    tally[2] = (tally[2] + 1) % LANES
    known[rotation, place[rotation]] = triangle
    place[rotation] = (place[rotation] + 1) % LANES


@kernel
def _take_box(view, slot, lane, turn, interval, count, turning, mask, arcs):
    """Take what the point of its triangles that a box names forbids to the pieces of a mask; how many intervals are left."""
    cosine, sine = turn
    x, y, z = view[slot, 13, lane], view[slot, 14, lane], view[slot, 15, lane]
    x, y = cosine * x + sine * y, cosine * y - sine * x
    for k in range(len(turning.piece)):
        if (mask >> k) & 1:
            count, _ = take_point(x, y, z, interval, count, turning, k, arcs)
    return count


@kernel
def _rotation(frame, e1, e2, turn, rotation, interval, count, turning, whole, low, narrowest, wide, seen, workspace):
    """Take the intervals of one rotation, its cosine and sine `turn`, through the tree, level by level; how many are left.

    `whole` is the mask of the pieces that anything can reach from this contact, `low` what is out of reach of them all.
    """
    p, n, (cosine, sine) = frame.p, frame.n, turn
    vertex, blocks, offset, bottom = wide
    view, leaves, below, home, tally = seen.boxes, seen.leaves, seen.below, seen.home, seen.tally
    known, queue, following = seen.known, seen.queue, seen.following
    margin, inside, which, remaining = seen.margin, seen.inside, seen.which, seen.remaining
    triangles, levels = len(vertex), len(offset) - 1
    for k in range(LANES):
        _see_triangle(leaves[_LEAVES + 2], k, vertex, known[rotation, k], p, e1, e2, n)
    count, _ = _leaf(
        leaves[_LEAVES + 2], known[rotation], vertex, frame, turn, interval, count, turning, whole, narrowest, inside, workspace
    )
    count, _ = _leaf(
        leaves[_LEAVES + 1], known[-1], vertex, frame, turn, interval, count, turning, whole, narrowest, inside, workspace
    )
    queue[0, 0], queue[0, 1], queue[0, 2] = 0, 0, whole
    waiting = 1
    for level in range(levels):
        coming = 0
        for w in range(waiting):
            if count == 0:
                return 0
            slot, block, mask = queue[w, 0], queue[w, 1], queue[w, 2]
            tally[3] += 1
            if slot < 0:
                slot = _SEEN
                _see(view, slot, blocks, offset[level] + block, p, e1, e2, n, seen.reach)
                _rising(view, below, slot, LANES, low)
            _reaching(view, slot, cosine, sine, interval, count, turning, mask, margin, remaining, workspace)
            for lane in range(LANES):
                inner = below[slot, lane]
                if remaining[lane] == 0 or inner == _NONE or count == 0:
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
                        leaves[inner], which, vertex, frame, turn, interval, count, turning, remaining[lane], narrowest, inside,
                        workspace,
                    )  # fmt: skip
                    if cut >= 0:
                        _remember(seen, rotation, inner, cut, begin + cut)
                    continue
                count = _take_box(view, slot, lane, turn, interval, count, turning, remaining[lane], workspace.arcs)
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
                        interval[INTERVALS, UF] += interval[g, LAST] - interval[g, FIRST] + interval[g, UF] + interval[g, UL]
                    return 0
                following[coming, 0], following[coming, 1], following[coming, 2] = inner, box, remaining[lane]
                coming += 1
        queue, following = following, queue
        waiting = coming
    return count


@kernel
def _write(interval, count, written, most, part):
    """Write the intervals among others, ascending; (how many, how much is undecided at their ends and beyond `most`)."""
    unsure = interval[INTERVALS, UF] + interval[INTERVALS, UL]
    for g in range(count):
        unsure += interval[g, UF] + interval[g, UL]
        if interval[g, LAST] <= interval[g, FIRST]:
            continue
        if written == most:
            unsure += interval[g, LAST] - interval[g, FIRST]
            continue
        written = insert(part, written, interval[g, FIRST], interval[g, LAST])
    return written, unsure


@kernel
def _ball(turning):
    """The piece that is the same body at all tilts, -1 if there is none: a ball about the centre."""
    piece = turning.piece
    for k in range(len(piece)):
        if piece[k, codes.KIND] == codes.ARC and piece[k, codes.RADIUS] == piece[k, codes.SLOPE] == turning.offset == 0.0:
            return k
    return -1


@kernel
def _reachable(view, lanes, turning):
    """The mask of the pieces that boxes of the first block may reach into at any posture, by their heights and distances."""
    mask, known = 0, turning.known
    for k in range(len(turning.piece)):
        for lane in range(lanes):
            square, half = 0.0, 0.0
            for i in range(3):
                square += view[0, i, lane] ** 2
                half += np.sqrt(view[0, 3 + i, lane] ** 2 + view[0, 6 + i, lane] ** 2 + view[0, 9 + i, lane] ** 2)
            away = np.sqrt(square)
            if view[0, 12, lane] > known[k, FLOOR] and away - half < known[k, FAR] and away + half > known[k, NEAR]:
                mask |= 1 << k
    return mask


@entry
def free_map(rows, contacts, ranges, tool, narrowest, tree, wide, most, part, count_out, undecided):
    """Free tilts of samples at all rotations, in one walk of the tree each, with certified ends.

    `rows` (m,) int64.
    `ranges`: of no machine: rotary axes may leave more intervals of tilt than there is room for.
    `tool`: without what does not matter.
    `narrowest` (float): ends are found to this, rad; a passing tilt is kept.
    `wide` (WideTree): the same.
    `most` (int): most intervals of one rotation.
    `part` (m, k, most, 2) float64, written: free intervals, ascending, by place in `rows`.
    `count_out` (m, k) int32, written.
    `undecided` (m, k) float64, written: width of the bands at the ends that are neither free nor known to be forbidden, rad in
      all.
    Returns blocks of the tree and triangles that were looked at: the same for the same rows, whatever the machine's speed.
    """
    turns, looked, work = len(ranges.rotation_cos), 0, cut_workspace()
    c, t, f, e2 = np.empty(3), np.empty(3), np.empty(3), np.empty(3)
    interval, arcs, alone = np.empty((INTERVALS + 1, COLUMNS)), np.empty((8, 2)), np.empty((1, PIECE))
    count_out[:, :], undecided[:, :] = 0, 0.0
    for mode in range(len(tool.mode)):
        offset, rise, piece = tool.mode[mode, codes.OFFSET_OF], tool.mode[mode, codes.RISE], tool.piece[mode]
        low = max(ranges.tilt_low, tool.mode[mode, codes.TILT_FROM])
        high = min(ranges.tilt_high, tool.mode[mode, codes.TILT_TO])
        if low > high:
            continue
        bound, facts, eight = planes.turning_of(piece, offset, low, high)
        turning = planes.Turning(offset, piece, bound, facts, eight)
        view = _View(
            np.empty((_SEEN + 1, 16, LANES)), np.empty((_LEAVES + 3, 9, LANES)), np.empty((_SEEN + 1, LANES), np.int64),
            np.empty((_SEEN, 2), np.int64), np.zeros(4, np.int64), np.zeros((turns + 1, LANES), np.int64),
            np.zeros(turns, np.int64), np.empty((_QUEUE, 3), np.int64), np.empty((_QUEUE, 3), np.int64), np.empty(LANES),
            np.empty(LANES), np.empty(LANES, np.int64), np.empty(LANES, np.int64), facts[:, FAR].max(),
        )  # fmt: skip
        ball = _ball(turning)
        if ball >= 0:
            for i in range(PIECE):
                alone[0, i] = piece[ball, i]
            alone[0, codes.LOW], alone[0, codes.HIGH] = -np.inf, np.inf
            alone[0, codes.BOTTOM], alone[0, codes.TOP] = -alone[0, codes.ROUND], alone[0, codes.ROUND]
        for place in range(len(rows)):
            row = rows[place]
            p, n, e1 = contacts.point[row], contacts.normal[row], contacts.direction_max[row]
            cross(n, e1, e2)
            for i in range(3):
                c[i] = p[i] + rise * n[i]
            frame = Frame(c, n, f, t)
            view.home[0, 0], view.tally[0], view.tally[1] = -1, 1, 0
            _see(view.boxes, 0, wide.blocks, 0, c, e1, e2, n, view.reach)
            whole = _reachable(view.boxes, 1 << (wide.bottom % 3), turning)
            if ball >= 0 and (whole >> ball) & 1:
                stand(work.body, Frame(c, n, e1, e2), 1.0, 0.0, 0.0, 0.0)
                if tree_hit(tree, work.body, alone, 0.0, -1, work.scratch)[0] < 0:
                    whole ^= 1 << ball
                elif piece[ball, codes.BOTTOM] == alone[0, codes.BOTTOM] and piece[ball, codes.TOP] == alone[0, codes.TOP]:
                    # In the way at every posture.
                    continue
            floor = np.inf
            for k in range(len(piece)):
                if (whole >> k) & 1:
                    floor = min(floor, facts[k, FLOOR])
            some = _rising(view.boxes, view.below, 0, 1 << (wide.bottom % 3), floor)
            for lane in range(LANES):
                _see_triangle(view.leaves[_LEAVES + 1], lane, wide.vertex, view.known[-1, lane], c, e1, e2, n)
            for rotation in range(turns):
                cosine, sine = turn_of(n, e1, ranges, rotation)
                tilt_frame(e1, e2, cosine, sine, f, t)
                _, count = permitted(contacts, row, ranges, tool, mode, f, arcs)
                if count == 0:
                    continue
                interval[INTERVALS, UF], interval[INTERVALS, UL] = 0.0, 0.0
                for g in range(count):
                    passes._begin(interval, g, arcs[g, 0], 0.0)
                    passes._end(interval, g, arcs[g, 1], 0.0)
                if some:
                    count = _rotation(
                        frame, e1, e2, (cosine, sine), rotation, interval, count, turning, whole, floor, narrowest, wide, view,
                        work,
                    )  # fmt: skip
                count, unsure = _write(interval, count, count_out[place, rotation], most, part[place, rotation])
                count_out[place, rotation] = join(part[place, rotation], count)
                undecided[place, rotation] += unsure
        looked += view.tally[3]
    return looked + work.spent[0]
