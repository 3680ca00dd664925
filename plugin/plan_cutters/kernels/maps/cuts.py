"""Take the tilts that a point or a triangle forbids out of the intervals of a rotation, piece by piece of the tool."""

from collections import namedtuple

import numpy as np

from plan_cutters.kernels.codes import HIGH, LOW, RADIUS
from plan_cutters.kernels.jit import kernel, maker
from plan_cutters.kernels.linear.tree import LANES
from plan_cutters.kernels.maps import passes, planes
from plan_cutters.kernels.maps.passes import CF, CL, FIRST, INTERVALS, LAST, SF, SL, UF, UL
from plan_cutters.kernels.maps.planes import BOXES, ENDS, FAR, FLOOR, LATERAL, NEAR
from plan_cutters.kernels.tool.apart import BODY
from plan_cutters.kernels.tool.arcs import ARCS, arc_about, closed, forbidden, point_arc
from plan_cutters.kernels.tool.hit import _swept_hit, scratch, stand, triangle_hit
from plan_cutters.kernels.tool.pieces import inset

#: How often a triangle is cut into four to be shown clear.
_QUARTERED = 4


#: A workspace: corner (3, 3), first and second (8, 3) polygons, a body, ranges (64, 2) of tilts, arcs (ARCS, 2).
#: In lanes, as in `planes`: a triangle, boxes or triangles turned, ends, what is clear, by how much ends move. Parts (64, 3, 3)
#: of a triangle, and how often each was cut. `spent` (1,) counts how often a triangle was looked at: the work that it took.
Workspace = namedtuple("Workspace", "corner first second body ranges arcs seen turned end clear moves parts times spent scratch")


@maker
def cut_workspace():
    """Make a workspace for cutting intervals."""
    return Workspace(
        np.empty((3, 3)), np.empty((8, 3)), np.empty((8, 3)), np.empty(BODY), np.empty((64, 2)), np.empty((ARCS, 2)),
        np.empty((11, LANES)), np.empty((BOXES, LANES)), np.empty((ENDS, LANES)), np.empty(LANES), np.empty(LANES),
        np.empty((64, 3, 3)), np.empty(64, np.int64), np.zeros(1, np.int64), scratch(),
    )  # fmt: skip


@kernel
def _meets(interval, count, first, last):
    """Whether an arc has tilts of any interval."""
    meets = False
    for g in range(count):
        meets = meets or (first < interval[g, LAST] and last > interval[g, FIRST])
    return meets


@kernel
def take_point(x, y, z, interval, count, turning, k, arcs):
    """Take the tilts at which a point, along f, t and n from the centre, is in piece k out of the intervals, or some of them.

    Lemma M4 tells which points never are. (The count of intervals, whether any was cut.)
    """
    offset, piece, known = turning.offset, turning.piece, turning.known
    if (turning.eight >> k) & 1:
        if not passes._cuts(x, y, z, interval, count, planes.flutes(turning, k)):
            return count, False
        left, right = point_arc(z, x + offset, y, 0.0, offset, piece[k, RADIUS], piece[k, LOW], piece[k, HIGH])
        return passes._take(interval, count, left, right), True
    away = x * x + z * z
    if abs(y) >= known[k, LATERAL] or z <= known[k, FLOOR] or away >= known[k, FAR] ** 2 or away <= known[k, NEAR] ** 2:
        return count, False
    cut = False
    for i in range(forbidden(z, x + offset, y, 0.0, offset, piece, k, arcs)):
        if _meets(interval, count, arcs[i, 0], arcs[i, 1]):
            count, cut = passes._take(interval, count, arcs[i, 0], arcs[i, 1]), True
    if closed(offset, piece, k):
        return count, cut
    g = 0
    while g < count:
        a, b, before = interval[g, FIRST], interval[g, LAST], count
        for tilt in (a, b, 0.5 * (a + b)):
            c, s = np.cos(tilt), np.sin(tilt)
            height, px = s * x + c * z, offset + c * x - s * z
            if inset(piece, k, height, px * px + y * y) > 0.0:
                left, right = arc_about(height, px, y, tilt, offset, piece, k)
                if right > left and _meets(interval, count, left, right):
                    count, cut = passes._take(interval, count, left, right), True
                    break
        if count >= before:
            g += 1
    return count, cut


@kernel
def _fill(seen, corner):
    """Write a triangle of rows (x, y, z) into all lanes."""
    for k in range(3):
        for lane in range(LANES):
            seen[3 * k, lane], seen[3 * k + 1, lane], seen[3 * k + 2, lane] = corner[k, 0], corner[k, 1], corner[k, 2]
    planes.distances(seen)


@kernel
def _out(corner, ca, sa, cb, sb, turning, k, workspace):
    """Whether a triangle, rows (x, y, z) from the centre, is shown to stay out of piece k at all tilts of an interval."""
    workspace.spent[0] += 1
    if (turning.eight >> k) & 1:
        return passes._passes(corner, ca, sa, cb, sb, planes.flutes(turning, k), workspace.first, workspace.second)
    _fill(workspace.seen, corner)
    planes.all_ends(workspace.end, ca, sa, cb, sb)
    return planes.triangles_clear(workspace.seen, workspace.end, turning, k, workspace.clear)


@kernel
def _quarters(part, seen):
    """Write the four quarters of a triangle (3, 3), rows (x, y, z), into lanes, the rest again."""
    for lane in range(LANES):
        for k in range(3):
            other = (k + 1) % 3
            for row in range(3):
                here = part[k, row]
                # The middle one has the middles of the sides, the others a corner each and the middles next to it.
                to = other if lane % 4 == 3 else lane % 4
                seen[3 * k + row, lane] = 0.5 * (here + part[to, row])
    planes.distances(seen)


@kernel
def _out_in_parts(corner, ca, sa, cb, sb, turning, k, workspace):
    """`_out` for a triangle that is cut into four again and again."""
    parts, times, seen, piece, offset = workspace.parts, workspace.times, workspace.seen, turning.piece, turning.offset
    for column in range(3):
        for row in range(3):
            parts[0, row, column] = corner[row, column]
    times[0], top = 0, 1
    planes.all_ends(workspace.end, ca, sa, cb, sb)
    while top > 0:
        top -= 1
        workspace.spent[0] += 1
        cut = times[top] + 1
        _quarters(parts[top], seen)
        if planes.triangles_clear(seen, workspace.end, turning, k, workspace.clear):
            continue
        for lane in range(4):
            if workspace.clear[lane] > 0.0:
                continue
            x, y, z = seen[0, lane] + seen[3, lane] + seen[6, lane], seen[1, lane] + seen[4, lane] + seen[7, lane], 0.0
            x, y, z = x / 3.0, y / 3.0, (seen[2, lane] + seen[5, lane] + seen[8, lane]) / 3.0
            for c, s in ((ca, sa), (cb, sb)):
                across = offset + c * x - s * z
                if inset(piece, k, s * x + c * z, across * across + y * y) > 0.0:
                    return False
            if cut == _QUARTERED or top == len(parts):
                return False
            for corner_of in range(3):
                for row in range(3):
                    parts[top, corner_of, row] = seen[3 * corner_of + row, lane]
            times[top] = cut
            top += 1
    return True


#: It holds triangle `i` of some, and piece `k` of the tool that it may be in the way of.
Met = namedtuple("Met", "vertex i frame turning k")


@kernel
def _in_the_way(met, tilt, workspace):
    """Whether a triangle reaches into a piece at a tilt."""
    workspace.spent[0] += 1
    stand(workspace.body, met.frame, np.cos(tilt), np.sin(tilt), met.turning.offset, 0.0)
    return triangle_hit(met.vertex, met.i, workspace.body, met.turning.piece, 1 << met.k, 0.0, workspace.scratch)[0] >= 0


@kernel
def _first_in_the_way(met, a, b, sign, narrowest, workspace):
    """The first tilt, from a up or from b down (`sign`), at which a triangle is not shown to be clear of a piece; nan if none.

    A range is clear if planes part the triangle from the piece, or if it misses the piece widened by what tilting within the
    range can do (lemma S5). Others are halved.
    """
    vertex, i, frame, turning, k = met
    body, ranges, scratch, eight = workspace.body, workspace.ranges, workspace.scratch, (turning.eight >> k) & 1
    ranges[0, 0], ranges[0, 1] = a, b
    top = 1
    while top > 0:
        top -= 1
        workspace.spent[0] += 1
        first, last = ranges[top, 0], ranges[top, 1]
        if not eight and _in_the_way(met, first if sign > 0.0 else last, workspace):
            return first if sign > 0.0 else last
        middle, half = 0.5 * (first + last), 0.5 * (last - first)
        stand(body, frame, np.cos(middle), np.sin(middle), turning.offset, 0.0)
        which, _, _, _ = triangle_hit(vertex, i, body, turning.piece, 1 << k, half + 1e-12, scratch)
        if which < 0 or not _swept_hit(vertex, i, body, turning.piece, 1 << k, half + 1e-12, scratch):
            continue
        if not eight and _out_in_parts(
            workspace.corner, np.cos(first), np.sin(first), np.cos(last), np.sin(last), turning, k, workspace
        ):
            continue
        if last - first <= narrowest or top + 2 > len(ranges):
            return first if sign > 0.0 else last
        near, far = (top + 1, top) if sign > 0.0 else (top, top + 1)
        ranges[near, 0], ranges[near, 1] = first, middle
        ranges[far, 0], ranges[far, 1] = middle, last
        top += 2
    return np.nan


@kernel
def _shrink_in_lanes(corner, interval, g, sign, narrowest, turning, k, workspace):
    """`_shrink`, eight ends at a time: first farther and farther, then evenly between the last failure and the first pass."""
    ca, sa, cb, sb = interval[g, CF], interval[g, SF], interval[g, CL], interval[g, SL]
    width, passed, failed, step = interval[g, LAST] - interval[g, FIRST], np.inf, 0.0, narrowest
    _fill(workspace.seen, corner)
    while passed - failed > narrowest:
        if passed == np.inf and failed >= width - narrowest:
            return np.inf, width
        workspace.spent[0] += 1
        low, high = failed, passed
        for lane in range(LANES):
            if passed < np.inf:
                move = low + (high - low) * (lane + 1) / (LANES + 1)
            else:
                move = min(failed + step * 2.0**lane, width - narrowest)
            workspace.moves[lane] = move
            c, s = np.cos(interval[g, FIRST] + move), np.sin(interval[g, FIRST] + move)
            if sign < 0.0:
                c, s = np.cos(interval[g, LAST] - move), np.sin(interval[g, LAST] - move)
                planes.put_ends(workspace.end, lane, ca, sa, c, s)
            else:
                planes.put_ends(workspace.end, lane, c, s, cb, sb)
        planes.triangles_clear(workspace.seen, workspace.end, turning, k, workspace.clear)
        for lane in range(LANES):
            if workspace.clear[lane] > 0.0 and workspace.moves[lane] > 0.0:
                passed = workspace.moves[lane]
                break
            failed = workspace.moves[lane]
        step *= 2.0**LANES
    return passed, failed


@kernel
def _shrink(corner, interval, g, sign, narrowest, turning, k, workspace):
    """By how much an interval must shrink from its first tilt up (`sign` 1) or its last down for a triangle to pass.

    To `narrowest`; (by how much, a little less by which it did not pass); infinity if nothing wider is left.
    """
    if not (turning.eight >> k) & 1:
        return _shrink_in_lanes(corner, interval, g, sign, narrowest, turning, k, workspace)
    tool, first, second = planes.flutes(turning, k), workspace.first, workspace.second
    ca, sa, cb, sb = interval[g, CF], interval[g, SF], interval[g, CL], interval[g, SL]
    width = interval[g, LAST] - interval[g, FIRST]
    passed, failed, move = np.inf, 0.0, narrowest
    while passed - failed > narrowest:
        if passed < np.inf:
            move = 0.5 * (passed + failed)
        elif failed > 0.0:
            move = min(2.0 * failed, width - narrowest)
        if move <= failed or move >= width:
            return np.inf, width
        workspace.spent[0] += 1
        end = interval[g, FIRST] + move if sign > 0.0 else interval[g, LAST] - move
        c, s = np.cos(end), np.sin(end)
        if sign > 0.0:
            good = passes._passes(corner, c, s, cb, sb, tool, first, second)
        else:
            good = passes._passes(corner, ca, sa, c, s, tool, first, second)
        if good:
            passed = move
        else:
            failed = move
    return passed, failed


@kernel
def _ends_in_the_way(met, interval, g, workspace):
    """Whether a triangle is in the way at either end of an interval: what was undecided there no longer is."""
    a, b, unsure_first, unsure_last = interval[g, FIRST], interval[g, LAST], interval[g, UF], interval[g, UL]
    at_first, at_last = _in_the_way(met, a, workspace), _in_the_way(met, b, workspace)
    if at_first and unsure_first > 0.0 and _in_the_way(met, a - unsure_first, workspace):
        interval[g, UF] = 0.0
    if at_last and unsure_last > 0.0 and _in_the_way(met, b + unsure_last, workspace):
        interval[g, UL] = 0.0
    return at_first, at_last


@kernel
def _closely(met, start, end, narrowest, workspace):
    """The first and last tilt of a range at which a triangle is not shown to be clear, nan if none; whether it is in the way."""
    unsure = 2.0 * narrowest
    left = _first_in_the_way(met, start, end, 1.0, narrowest, workspace)
    if np.isnan(left):
        return left, left, False
    right = _first_in_the_way(met, left, end, -1.0, narrowest, workspace)
    right = left if np.isnan(right) else right
    if (met.turning.eight >> met.k) & 1:
        return left, right, True
    middle = 0.5 * (left + right)
    near, far = min(left + unsure, middle), max(right - unsure, middle)
    shown = _in_the_way(met, near, workspace) and _in_the_way(met, middle, workspace)
    return left, right, shown and _in_the_way(met, far, workspace)


@kernel
def cut_intervals(vertex, i, frame, interval, count, narrowest, turning, k, workspace):
    """Take the tilts at which a triangle is in the way of piece k out of the intervals; (their count, whether any was cut).

    The triangle is in `workspace.corner` too, as rows (x, y, z) from the centre.
    """
    corner, cut, met = workspace.corner, False, Met(vertex, i, frame, turning, k)
    # What its corners alone forbid is known in closed form, and mostly all that it does.
    for j in range(3):
        count, took = take_point(corner[j, 0], corner[j, 1], corner[j, 2], interval, count, turning, k, workspace.arcs)
        cut = cut or took
    g = 0
    while g < count:
        a, b = interval[g, FIRST], interval[g, LAST]
        if _out(corner, interval[g, CF], interval[g, SF], interval[g, CL], interval[g, SL], turning, k, workspace):
            g += 1
            continue
        # A side or the middle of the triangle sticks out further than its corners: mostly by a little, at one end.
        at_first, at_last = _ends_in_the_way(met, interval, g, workspace)
        # From an end at which it is not in the way nothing is gained if it is at the other.
        up, up_failed, down, down_failed = np.inf, b - a, np.inf, b - a
        if not at_last:
            up, up_failed = _shrink(corner, interval, g, 1.0, narrowest, turning, k, workspace)
        if up <= 2.0 * narrowest and interval[g, UF] + up <= 3.0 * narrowest:
            passes._begin(interval, g, a + up, interval[g, UF] + up)
            cut = True
            continue
        if not at_first:
            down, down_failed = _shrink(corner, interval, g, -1.0, narrowest, turning, k, workspace)
        if down <= 2.0 * narrowest and interval[g, UL] + down <= 3.0 * narrowest:
            passes._end(interval, g, b - down, interval[g, UL] + down)
            cut = True
            continue
        left, right, unsure = max(a, b - down), min(b, a + up), narrowest
        if left > right or not (
            _in_the_way(met, max(a, b - down_failed), workspace) and _in_the_way(met, min(b, a + up_failed), workspace)
        ):
            # Not known to be in the way right up to there: looked at closely.
            start, end = (left, right) if left <= right else (a, b)
            unsure = 2.0 * narrowest
            left, right, shown = _closely(met, start, end, narrowest, workspace)
            if np.isnan(left):
                g += 1
                continue
            if not shown:
                # Where nothing shows the triangle clear it need not be in the way.
                interval[INTERVALS, UF] += right - left
        cut = True
        before = count
        count = passes._part(interval, g, count, left, right, unsure)
        if count >= before:
            g += 1
    return count, cut
