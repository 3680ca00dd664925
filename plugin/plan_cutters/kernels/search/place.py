"""Place a tool at a contact, find the tilts that are left there and the reasons that forbid others, for all searches."""

from collections import namedtuple
from typing import Any, NamedTuple

import numpy as np

from plan_cutters.kernels import codes, material
from plan_cutters.kernels.codes import BALL, FLUTES, NECK, OFFSET_OF, OVER_TIP, PART, RISE, TILT_FROM, TILT_TO
from plan_cutters.kernels.jit import kernel, maker
from plan_cutters.kernels.limits import held_tilts, turn_of
from plan_cutters.kernels.linear.vectors import dot, tilt_frame
from plan_cutters.kernels.material import SURELY_INSIDE
from plan_cutters.kernels.tool.apart import BODY, OFFSET, A, P, X
from plan_cutters.kernels.tool.arcs import ARCS, arc_about, closed, forbidden, local_gouge, remove
from plan_cutters.kernels.tool.hit import scratch, stand, tree_hit

#: A posture stands for the tilts that are so near, rad: no machine holds a tilt to 0.01 deg.
NARROWEST = 1.7e-4
#: Intervals that one rotation may fall into; widest first, a search has not been seen to need ten.
_INTERVALS = 256
#: A point of a tool's axis is surely among the cells, and mostly past those of the skin at its tip, so many of them up.
_LOW = 8.0
#: By how much a posture within a body is turned to find the others there, at first, rad.
_TURN = 0.2
#: Tilts this close to the end of a tool's range are in it, rad.
_ROUNDING = 1e-9
#: Lengths of unit vectors are 1 within this.
_UNIT = 1e-9


@kernel
def forbid(intervals, count, first, last, narrowest, attribute, tally):
    """Take an arc out and book what it takes on an attribute; the new count."""
    before = 0.0
    for i in range(count):
        before += intervals[i, 1] - intervals[i, 0]
    count = remove(intervals, count, first, last, narrowest)
    for i in range(count):
        before -= intervals[i, 1] - intervals[i, 0]
    tally[attribute] += before
    return count


@kernel
def attribute_of(x, y, z, tool, mode, k):
    """Return the reason that an obstacle point gives, which lies in piece k and at (x, y, z) from the contact.

    In the flutes it is a rear gouge within the rear-gouge radius and a collision beyond it; in other pieces it is their part.
    """
    part = int(tool.piece[mode, k, PART])
    if part != FLUTES:
        return codes.BY_NECK + part - NECK
    return codes.REAR_GOUGE if x * x + y * y + z * z <= tool.reach * tool.reach else codes.COLLISION


@kernel
def lies_within(x, y, z, solids, within, scratch):
    """Whether the winding number of the bodies about a point is `within` or more; where one is, others near it need no sum."""
    if material.in_known_ball(x, y, z, solids, within, scratch.balls, scratch.stored):
        return True
    if material.plainly_outside(x, y, z, solids, scratch.stack):
        return False
    number = material.winding(x, y, z, solids, scratch.stack)
    if number < within:
        return False
    material.keep_ball(x, y, z, number, solids, scratch.balls, scratch.stored, scratch.stack)
    return True


@kernel
def _on_axis(body, height):
    back = body[OFFSET]
    x, y = body[P] + height * body[A] - back * body[X], body[P + 1] + height * body[A + 1] - back * body[X + 1]
    return x, y, body[P + 2] + height * body[A + 2] - back * body[X + 2]


@kernel
def inside(body, tool, mode, solids, within, scratch):
    """Whether a tool that touches no skin lies in bodies: their winding number about a point of its axis is `within` or more.

    The end of the axis is asked first: where that is surely outside, or a way leads out from there, all of it is.
    """
    x, y, z = _on_axis(body, tool.end - tool.mode[mode, OVER_TIP])
    if material.outside(x, y, z, solids):
        return False
    if not solids.whole:
        # Above the cells: a point that is low enough to be among them.
        x, y, z = _on_axis(body, min(tool.inner, _LOW * solids.size) - tool.mode[mode, OVER_TIP])
        if material.outside(x, y, z, solids):
            return False
    if material.way_out(x, y, z, body[A], body[A + 1], body[A + 2], solids, scratch.stack):
        return False
    x, y, z = _on_axis(body, tool.inner - tool.mode[mode, OVER_TIP])
    return lies_within(x, y, z, solids, within, scratch)


@kernel
def is_free(body, mode, tool, solids, workspace, hint):
    """Return whether a tool that was put down is free, and the triangle that was in its way last."""
    triangle, _, _, _, _ = tree_hit(solids.tree, body, tool.piece[mode], 0.0, hint, workspace)
    if triangle >= 0:
        return False, triangle
    return not inside(body, tool, mode, solids, material.MAYBE_INSIDE, workspace), hint


@kernel
def mode_at(tool, tilt):
    """The mode in which a tool touches at a tilt, -1 for none."""
    for mode in range(len(tool.mode)):
        if tool.mode[mode, TILT_FROM] - _ROUNDING <= tilt <= tool.mode[mode, TILT_TO] + _ROUNDING:
            return mode
    return -1


@kernel
def straightened(tilt_direction, f):
    """Write a tilt direction as a unit vector; its length, at most 1: that of a contact under a flat is less (`upright`)."""
    size = np.sqrt(dot(tilt_direction, tilt_direction))
    if abs(size - 1.0) <= _UNIT:
        size = 1.0
    for k in range(3):
        f[k] = tilt_direction[k] / size if size != 1.0 else tilt_direction[k]
    return min(1.0, size)


@kernel
def put(body, frame, tilt, tool, mode):
    """Stand a tool at a tilt, touching in a mode."""
    stand(body, frame, np.cos(tilt), np.sin(tilt), tool.mode[mode, OFFSET_OF], tool.mode[mode, RISE])


@kernel
def turned(frame, tilt, tool, mode, tree, body, scratch):
    """Return how far a posture that touches nothing can be tilted either way and touch nothing, rad (lemma S5)."""
    half = _TURN
    while half > 0.5 * NARROWEST:
        put(body, frame, tilt, tool, mode)
        hit, _, _, _, _ = tree_hit(tree, body, tool.piece[mode], half, -1, scratch)
        if hit < 0:
            return half
        half *= 0.5
    # No narrower: what is left is the probe's own neighbourhood, as for every other obstacle.
    return 0.5 * NARROWEST


class Proof(NamedTuple):
    """This record holds how one look proves that all postures of a contact are blocked (lemma F3 of `docs/proofs.md`).

    At every tilt the tool holds a part of a ball about a point over the contact, deeper than what blocks.
    """

    distance: Any  #: (k,): of such points along the normal, mm, those that are tried.
    radius: float  #: Of the balls, mm.
    solids: Any  #: What certainly encloses.


@kernel
def enclosed(contacts, row, proof, scratch):
    """Whether a ball over a contact lies in a body, so that every posture is blocked. Only closed bodies tell."""
    p, n, solids = contacts.point[row], contacts.normal[row], proof.solids
    if not solids.grow >= 0.0:
        return False
    # What keeps so far off every triangle goes past every skin: the ball does, and what the tool holds of it.
    wider = (1.0 + BALL) * solids.grow
    for d in proof.distance:
        x, y, z = p[0] + d * n[0], p[1] + d * n[1], p[2] + d * n[2]
        if material.outside(x, y, z, solids) or material.touches(x, y, z, proof.radius + wider, solids, scratch.stack):
            continue
        if lies_within(x, y, z, solids, SURELY_INSIDE, scratch):
            return True
    return False


#: A workspace: intervals (k, 2), arcs (ARCS, 2), tilt direction f and t = n x f, e2 = n x direction_max, a body, a tally by
#: attribute; `proved` (1,) int64, whether the sample was looked at as `enclosed` does, and is.
Workspace = namedtuple("Workspace", "intervals arcs f t e2 body tally scratch proved")


@maker
def search_workspace():
    """Make a workspace for searches."""
    return Workspace(
        np.empty((_INTERVALS, 2)), np.empty((ARCS, 2)), np.empty(3), np.empty(3), np.empty(3), np.empty(BODY),
        np.empty(codes.FIXTURE), scratch(), np.zeros(1, np.int64),
    )  # fmt: skip


@kernel
def permitted(contacts, row, ranges, tool, mode, f, intervals):
    """Write the tilts of a direction f that axis limit, range and tool leave; their width, and how many intervals they are."""
    low, high = max(ranges.tilt_low, tool.mode[mode, TILT_FROM]), min(ranges.tilt_high, tool.mode[mode, TILT_TO])
    if low > high:
        return 0.0, 0
    count = held_tilts(contacts.normal[row], f, ranges, low, high, intervals)
    width = 0.0
    for i in range(count):
        width += intervals[i, 1] - intervals[i, 0]
    return width, count


@kernel
def straight(contacts, row, cosine, sine, tool, mode):
    """Tilts from, to, at a rotation, at which curvature keeps surface and tool apart next to the contact; nan for none."""
    return local_gouge(
        contacts.curvature[row, 0], contacts.curvature[row, 1], cosine, sine, tool.mode[mode, OFFSET_OF], tool.mode[mode, RISE]
    )


@kernel
def clip_straight(least, most, intervals, count):
    """Leave of intervals what `straight` gives; the new count."""
    if np.isnan(least):
        return 0
    if least > 0.0:
        count = remove(intervals, count, -1.0, least, 0.0)
    return remove(intervals, count, most, 4.0, 0.0)


@kernel
def allowed(contacts, row, ranges, rotation, tool, mode, bent, workspace):
    """Write the tilts of a rotation that the axis limit leaves and curvature allows, or, if `bent`, forbids, and its frame; how
    many intervals they are.

    Those that it forbids gouge, but maybe no deeper than is allowed: the triangles tell (`docs/verdicts.md`). What each of the
    two leaves is booked on it.
    """
    intervals, tally = workspace.intervals, workspace.tally
    cosine, sine = turn_of(contacts.normal[row], contacts.direction_max[row], ranges, rotation)
    least, most = straight(contacts, row, cosine, sine, tool, mode)
    if bent and least <= 0.0 and most >= np.pi:
        return 0
    tilt_frame(contacts.direction_max[row], workspace.e2, cosine, sine, workspace.f, workspace.t)
    width, before = permitted(contacts, row, ranges, tool, mode, workspace.f, intervals)
    tally[codes.AXIS_LIMIT] += width + before * NARROWEST
    if not bent:
        count = clip_straight(least, most, intervals, before)
    elif np.isnan(least):
        count = before
    else:
        count = remove(intervals, before, least if least > 0.0 else -1.0, most, NARROWEST)
    for i in range(count):
        tally[codes.LOCAL_GOUGE] += intervals[i, 1] - intervals[i, 0] + NARROWEST
    return count


@kernel
def book_inside(tally):
    """Book on bodies that a contact lies within all tilts that limits and curvature leave."""
    tally[:] = 0.0
    tally[codes.AXIS_LIMIT], tally[codes.LOCAL_GOUGE], tally[codes.INSIDE] = 1.0, 1.0, 1.0


@kernel
def booked(tally):
    """Tilts that obstacles have taken."""
    cutting = tally[codes.REAR_GOUGE] + tally[codes.COLLISION]
    return cutting + tally[codes.BY_NECK] + tally[codes.BY_SHANK] + tally[codes.BY_HOLDER]


@kernel
def forbid_point(x, y, z, tool, mode, narrowest, intervals, count, workspace):
    """Take out the tilts at which an obstacle point, along f, t and n from the contact, is in the tool; the new count."""
    offset, height = tool.mode[mode, OFFSET_OF], z - tool.mode[mode, RISE]
    piece, arcs = tool.piece[mode], workspace.arcs
    for k in range(len(piece)):
        for i in range(forbidden(height, x + offset, y, 0.0, offset, piece, k, arcs)):
            attribute = attribute_of(x, y, z, tool, mode, k)
            count = forbid(intervals, count, arcs[i, 0], arcs[i, 1], narrowest, attribute, workspace.tally)
    return count


@kernel
def arc_of(k, height, px, py, tilt, offset, piece, half, arcs):
    """First and last of the tilts about one, at least `half` to either side, at which a point is in piece k."""
    first, last = tilt - half, tilt + half
    if closed(offset, piece, k):
        for i in range(forbidden(height, px, py, tilt, offset, piece, k, arcs)):
            if arcs[i, 0] <= last and arcs[i, 1] >= first:
                first, last = min(first, arcs[i, 0]), max(last, arcs[i, 1])
        return first, last
    low, high = arc_about(height, px, py, tilt, offset, piece, k)
    return min(first, low), max(last, high)


@kernel
def forbid_probed(k, height, px, py, tilt, tool, mode, narrowest, intervals, count, workspace):
    """The same of a point, in the tool's frame, that a probe has met in piece k; (the new count, the point along f, t, n)."""
    offset, piece = tool.mode[mode, OFFSET_OF], tool.piece[mode]
    back, cosine, sine = px - offset, np.cos(tilt), np.sin(tilt)
    x, z = cosine * back + sine * height, cosine * height - sine * back + tool.mode[mode, RISE]
    attribute = attribute_of(x, py, z, tool, mode, k)
    # At the edge of the tool the arc may be no wider than rounding: take the probe's own neighbourhood too.
    first, last = arc_of(k, height, px, py, tilt, offset, piece, 0.5 * narrowest, workspace.arcs)
    return forbid(intervals, count, first, last, narrowest, attribute, workspace.tally), x, py, z


@kernel
def next_tilt(intervals, count, wish):
    """The tilt to probe next: the one wished for where it is left, or the middle of the widest interval."""
    widest, tilt = -1.0, 0.0
    for i in range(count):
        if intervals[i, 0] <= wish <= intervals[i, 1]:
            widest, tilt = 10.0, wish
        elif intervals[i, 1] - intervals[i, 0] > widest:
            widest = intervals[i, 1] - intervals[i, 0]
            tilt = 0.5 * (intervals[i, 0] + intervals[i, 1])
    return tilt
