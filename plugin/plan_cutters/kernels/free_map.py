"""Free tilts of samples at all rotations, with certified ends, in one walk of the tree a rotation.

A gap of tilts is taken through the tree and only shrinks. Boxes are kept as seen from the contact: what rises nowhere above
the tangent plane is out of reach at every posture and left out for all rotations. A box in the way is first asked for one
of its points, whose arc is known in closed form: so gaps are nearly what they will be before any triangle is looked at.
"""

import numpy as np

from plan_cutters.kernels.arcs import axis_arcs, local_gouge, point_arc
from plan_cutters.kernels.gaps import COLUMNS, FIRST, GAPS, LAST, UF, UL, _begin, _cut_gaps, _cuts, _end, _take
from plan_cutters.kernels.hit import BODY, cross, dot, lean_frame
from plan_cutters.kernels.jit import entry, kernel
from plan_cutters.kernels.lanes import LANES, _boxes_pass, _see, _see_leaf, _see_triangle, _triangles_pass, _turn
from plan_cutters.kernels.search import remove

#: Blocks of boxes kept as seen from one contact, and blocks that may wait to be looked at.
_SEEN, _QUEUE = 1 << 11, 1 << 13
#: Leaves of triangles kept so; one more for others, one for the triangles that cut gaps last and are tried first.
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
def _leaf(  # type: ignore[no-untyped-def]
    seen, which, vertex, p, n, f, t, cosine, sine, gap, count, radius, shrunk, low, high, narrowest, margin, corner, first,
    second, scratch,
):  # fmt: skip
    """Take what the triangles of a leaf forbid out of the gaps; (gaps, the lane that cut last or -1)."""
    _triangles_pass(seen, cosine, sine, gap, count, radius, shrunk, low, high, margin)
    last = -1
    for lane in range(LANES):
        if margin[lane] >= 0.0 or count == 0:
            continue
        _turn(seen, lane, cosine, sine, corner)
        count, cut = _cut_gaps(vertex, which[lane], p, n, f, t, corner, gap, count, narrowest, radius, shrunk, low, high,
                               first, second, scratch)  # fmt: skip
        if cut:
            last = lane
    return count, last


@kernel
def _rotation(  # type: ignore[no-untyped-def]
    p, e1, e2, n, f, t, cosine, sine, gap, count, radius, shrunk, low, high, narrowest, vertex, blocks, offset, bottom,
    tally, known, view, leaves, below, home, queue, ahead, margin, inside, which, corner, first, second, scratch,
):  # fmt: skip
    """Take the gaps of one rotation through the tree, level by level; how many are left."""
    triangles, levels = len(vertex), len(offset) - 1
    count, _ = _leaf(leaves[_LEAVES + 1], known, vertex, p, n, f, t, cosine, sine, gap, count, radius, shrunk, low, high,
                     narrowest, inside, corner, first, second, scratch)  # fmt: skip
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
                _see(view, slot, blocks, offset[level] + block, p, e1, e2, n, margin)
                _rising(view, below, slot, LANES, low)
            _boxes_pass(view, slot, cosine, sine, gap, count, radius, shrunk, low, high, margin)
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
                    count, cut = _leaf(leaves[inner], which, vertex, p, n, f, t, cosine, sine, gap, count, radius, shrunk,
                                       low, high, narrowest, inside, corner, first, second, scratch)  # fmt: skip
                    if cut >= 0:
                        known[tally[2]] = begin + cut
                        for k in range(9):
                            leaves[_LEAVES + 1, k, tally[2]] = leaves[inner, k, cut]
                        tally[2] = (tally[2] + 1) % LANES
                    continue
                x, y, z = view[slot, 13, lane], view[slot, 14, lane], view[slot, 15, lane]
                x, y = cosine * x + sine * y, cosine * y - sine * x
                if _cuts(x, y, z, gap, count, radius, shrunk, low, high):
                    left, right = point_arc(z, x + radius, y, 0.0, radius, shrunk, low, high)
                    count = _take(gap, count, left, right)
                if inner == _UNSEEN and tally[0] < _SEEN:
                    inner = tally[0]
                    _see(view, inner, blocks, offset[level + 1] + box, p, e1, e2, n, inside)
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
    rows, point, normal, direction_max, curvature, rotation_cos, rotation_sin, tilt_low, tilt_high, setup, limit_cos,
    radius, length, depth_allowed, narrowest, vertex, blocks, offset, bottom, room, part, count_out, undecided,
):  # fmt: skip
    """Free tilts of samples at all rotations, in one walk of the tree each, with certified ends.

    Parameters
    ----------
    rows : (m,) int64
    point, normal, direction_max : (n, 3) float64
    curvature : (n, 2) float64
    rotation_cos, rotation_sin : (k,) float64
    tilt_low, tilt_high : float
        rad.
    setup, limit_cos
        Unit setup axis, and the cosine of the axis limit about it, -2 for none.
    radius, length, depth_allowed : float
        Cutter, and the depth up to which a triangle does not matter, mm.
    narrowest : float
        Ends are found to this, rad; a passing tilt is kept.
    vertex : (triangles, 3, 3) float64
        Triangles in tree order.
    blocks, offset, bottom
        As `wide_tree` gives them.
    room : int
        Most intervals of one rotation.
    part : (m, k, room, 2) float64, written
        Free intervals, ascending, by place in `rows`.
    count_out : (m, k) int32, written
    undecided : (m, k) float64, written
        Width of the bands at the ends that are neither free nor known to be forbidden, rad in all.
    """
    t, f, e2 = np.empty(3), np.empty(3), np.empty(3)
    corner, first, second = np.empty((3, 3)), np.empty((8, 3)), np.empty((8, 3))
    gap, arcs = np.empty((GAPS + 1, COLUMNS)), np.empty((8, 2))
    margin, inside, which, known = (
        np.empty(LANES),
        np.empty(LANES),
        np.empty(LANES, np.int64),
        np.zeros(LANES, np.int64),
    )
    scratch = (np.empty(BODY), np.empty((8, 3)), np.empty((8, 3)), np.empty((64, 3, 3)), np.empty((64, 2)))
    view, leaves = np.empty((_SEEN + 1, 16, LANES)), np.empty((_LEAVES + 2, 9, LANES))
    below, home = np.empty((_SEEN + 1, LANES), np.int64), np.empty((_SEEN, 2), np.int64)
    tally = np.zeros(3, np.int64)
    queue, ahead = np.empty((_QUEUE, 2), np.int64), np.empty((_QUEUE, 2), np.int64)
    low, high, shrunk = depth_allowed, length - depth_allowed, radius - depth_allowed
    for place in range(len(rows)):
        row = rows[place]
        p, n, e1 = point[row], normal[row], direction_max[row]
        cross(n, e1, e2)
        home[0, 0], tally[0], tally[1] = -1, 1, 0
        _see(view, 0, blocks, 0, p, e1, e2, n, margin)
        some = _rising(view, below, 0, 1 << (bottom % 3), low)
        for lane in range(LANES):
            _see_triangle(leaves[_LEAVES + 1], lane, vertex, known[lane], p, e1, e2, n)
        for rotation in range(len(rotation_cos)):
            cosine, sine = rotation_cos[rotation], rotation_sin[rotation]
            lean_frame(e1, e2, cosine, sine, f, t)
            count_out[place, rotation], undecided[place, rotation] = 0, 0.0
            least = local_gouge(curvature[row, 0], curvature[row, 1], cosine, sine, radius)
            if np.isnan(least):
                continue
            count = axis_arcs(dot(setup, n), dot(setup, f), limit_cos, tilt_low, tilt_high, arcs)
            if least > 0.0:
                count = remove(arcs, count, -1.0, least, 0.0)
            gap[GAPS, UF], gap[GAPS, UL] = 0.0, 0.0
            for g in range(count):
                _begin(gap, g, arcs[g, 0], 0.0)
                _end(gap, g, arcs[g, 1], 0.0)
            if some and count > 0:
                count = _rotation(
                    p, e1, e2, n, f, t, cosine, sine, gap, count, radius, shrunk, low, high, narrowest, vertex,
                    blocks, offset, bottom, tally, known, view, leaves, below, home, queue, ahead, margin, inside, which,
                    corner, first, second, scratch,
                )  # fmt: skip
            count_out[place, rotation], undecided[place, rotation] = _write(gap, count, room, part[place, rotation])
