"""Is there a posture? Probe a tilt; whatever is in the way forbids a whole arc; probe what is left.

A found posture is safe: no possible obstacle reaches into the outer tool (`docs/at_a_sample.md`, lemma S2). Where none is found,
the same search with the inner tool and the certain obstacles decides whether the sample is inaccessible (they forbid everything)
or undecided. What is forbidden to the inner tool is so to the outer one: after a sample without a posture the inner tool is asked
first, and one answer is all that an inaccessible sample takes. A cutter that touches nothing may still lie within a body: then
so does every posture that it can be turned to without touching a skin.

Curvature at the contact only tells where to look first: a posture that it forbids is one as well if the triangles prove that
no point of the surface is too deep.

Of a row of tools, each within the next, the largest that finds a posture is searched from the answer at the sample before: up or
down by 1, 2, 4 ... tools until the answer lies between two of them, then what is between is halved. A tool is asked for a posture
at the rotation found last; where that has none, what is surely in the way is asked next, for it answers for all rotations and
mostly ends the search: an inaccessible tool costs one search without success, not two (`docs/proofs.md`, lemma N4).
"""

from collections import namedtuple
from typing import Any, NamedTuple

import numpy as np

from plan_cutters.kernels import codes
from plan_cutters.kernels.codes import AWAY, BALL, OFFSET_OF, RISE
from plan_cutters.kernels.jit import entry, kernel
from plan_cutters.kernels.limits import turn_of
from plan_cutters.kernels.linear.vectors import cross, dot, perpendicular, tilt_frame
from plan_cutters.kernels.material import MAYBE_INSIDE, SURELY_INSIDE, Solids, outside, touches
from plan_cutters.kernels.rows import Frame, Tool
from plan_cutters.kernels.search import place
from plan_cutters.kernels.search.place import Proof
from plan_cutters.kernels.search.sweep import NONE, UNFINISHED, WITHOUT_END, Side, both, sweep, sweep_both
from plan_cutters.kernels.tool.apart import BODY
from plan_cutters.kernels.tool.hit import scratch, stand, tree_hit

#: Between arcs of what is certainly in the way, intervals narrower than this are none: no machine holds a tilt to 0.01 deg. rad.
_NO_INTERVAL = 1.7e-4
#: A posture is searched in intervals down to this, rad: it may stand where arcs leave more than they seem to.
_FINEST = 1e-5
#: Boxes after which a brief search gives up: several times what most samples take.
_BRIEF = 20_000
#: Where searches begin, among the tilts that curvature allows and among the others: rotation, and the tilt tried first.
_ANYWHERE = (0, -1.0)
START = (_ANYWHERE, _ANYWHERE)
_FIRST = np.zeros(1, np.int64)
#: Distances of a `Proof` that tries none.
_NOWHERE = np.zeros(0)


@kernel
def _reason(tally, bent):
    """Return the reason why no posture is left, from the tilts that each reason has taken.

    `tally` counts those among the tilts that curvature allows, `bent` those among the tilts that it forbids. The reason is the
    one that alone leaves no tilt, or else the one that took most. Where curvature forbids all tilts, a rear gouge counts as the
    local gouge.
    """
    if tally[codes.AXIS_LIMIT] == 0.0:
        return codes.AXIS_LIMIT
    reason, most = codes.REAR_GOUGE, tally
    if tally[codes.LOCAL_GOUGE] == 0.0:
        reason, most = codes.LOCAL_GOUGE, bent
    least = most[codes.REAR_GOUGE]
    for attribute in (codes.COLLISION, codes.INSIDE, codes.BY_NECK, codes.BY_SHANK, codes.BY_HOLDER):
        if most[attribute] > least:
            reason, least = attribute, most[attribute]
    return reason


@kernel
def shut_in(contacts, row, deep, solids, scratch):
    """Whether every posture of a contact may be blocked by a body that perhaps encloses it (lemma F3 of `docs/proofs.md`)."""
    p, n = contacts.point[row], contacts.normal[row]
    x, y, z = p[0] + AWAY * deep * n[0], p[1] + AWAY * deep * n[1], p[2] + AWAY * deep * n[2]
    # A posture that a body blocks, beside it or within, is none: with no depth nothing is known.
    if not deep > 0.0 or outside(x, y, z, solids) or touches(x, y, z, BALL * deep, solids, scratch.stack):
        return False
    return place.lies_within(x, y, z, solids, MAYBE_INSIDE, scratch)


@kernel
def _write(results, row, contacts, ranges, rotation, tilt):
    n, e1 = contacts.normal[row], contacts.direction_max[row]
    turn_cos, turn_sin = turn_of(n, e1, ranges, rotation)
    cosine, sine = np.cos(tilt), np.sin(tilt)
    results.tilt[row], results.rotation[row] = tilt, rotation
    for k in range(3):
        i, j = (k + 1) % 3, (k + 2) % 3
        results.tilt_direction[row, k] = turn_cos * e1[k] + turn_sin * (n[i] * e1[j] - n[j] * e1[i])
        results.axis[row, k] = cosine * n[k] + sine * results.tilt_direction[row, k]


class Mode(NamedTuple):
    """This record holds how samples are searched."""

    at: int  #: The place of the first one.
    start: tuple[int, float]  #: Rotation and tilt tried first.
    turns: int  #: How many rotations.
    narrowest: float  #: Intervals of tilt narrower than this are passed over, rad.
    most: int  #: Boxes after which a sweep is given up.
    decides: bool  #: Whether the inner tool says what is inaccessible, and why.
    stops: bool  #: Whether the first sample without a posture is the last one.
    deep: float  #: A body so deep in the tool forbids a posture, mm; 0: postures alone tell whether a contact lies in a body.


@entry
def search_rows(rows, contacts, ranges, tools, solids, mode, proof, results):
    """Look for postures of the samples `rows`, one after the other, each starting from the posture of the one before.

    All searches are this one: compiled for each of its uses, they took three times as long on the first run.

    `rows` (m,) int64: samples, neighbours in sequence.
    `tools` (Tool, Tool): the outer and the inner tool.
    `solids` (Solids, Solids): the possible and the certain obstacles.
    `mode` (Mode): unless it decides, nothing is asked of the inner tool and the certain obstacles.
    `results` (VerdictArrays), written.
    Returns where it ended in `rows`, and how many boxes were looked at, and what else takes as long (`sweep.ROTATION`).
    """
    rotations, (outer_tool, inner_tool), (possible, certain) = len(ranges.rotation_cos), tools, solids
    # What is only perhaps in the way must not count as surely in it: each side has obstacle caches of its own.
    pasts, workspaces = both(rotations, len(outer_tool.mode))
    met, _ = both(rotations if mode.decides else 0, len(inner_tool.mode))
    outer = Side(outer_tool, possible, MAYBE_INSIDE, mode.narrowest, mode.most, proof)
    inner = Side(inner_tool, certain, SURELY_INSIDE, _NO_INTERVAL, mode.most, proof)
    start, at = (mode.start, mode.start), mode.at
    last, freed, missed, tilt = start, start, False, 0.0
    while at < len(rows) and not (mode.stops and missed):
        row, sure = rows[at], False
        at += 1
        # The sides in turn: the inner one first where the sample before has no posture.
        for of_inner in (missed, not missed):
            if of_inner and not mode.decides:
                continue
            if of_inner:
                rotation, _, freed = sweep_both(contacts, row, ranges, inner, met, freed, mode.turns, workspaces)
                sure = rotation == NONE
            elif missed and shut_in(contacts, row, mode.deep, possible, workspaces[0].scratch):
                # As its neighbour was: a search would put the tool down in the body again and again.
                results.reason[row] = codes.INSIDE
                continue
            else:
                rotation, tilt, last = sweep_both(contacts, row, ranges, outer, pasts, last, mode.turns, workspaces)
                missed = rotation < 0
            if rotation < 0 and mode.decides:
                results.reason[row] = _reason(workspaces[0].tally, workspaces[1].tally)
            if sure or not missed or (rotation == UNFINISHED and not of_inner):
                break
        if missed:
            results.verdict[row] = codes.INACCESSIBLE if sure else codes.UNDECIDED
        else:
            results.verdict[row] = codes.ACCESSIBLE
            _write(results, row, contacts, ranges, rotation, tilt)
    return at, workspaces[0].scratch.looked[0] + workspaces[1].scratch.looked[0]


def search(
    rows, contacts, ranges, outer_tool, inner_tool, possible, certain, results, *, deep=0.0, brief=False, distance=_NOWHERE
):  # fmt: skip
    """Decide the samples `rows`, one after the other; how many boxes were looked at.

    The possible obstacles are there to call a posture safe, the certain ones to call a sample inaccessible; the rest is as for
    `search_rows`. A `brief` search gives up what takes long, and leaves it undecided. `deep` as for `Mode`, `distance`
    as for `Proof`: at none, no look proves that a contact lies in a body.
    """
    mode = Mode(0, _ANYWHERE, len(ranges.rotation_cos), _FINEST, _BRIEF if brief else WITHOUT_END, True, False, deep)
    proof = Proof(distance, BALL * deep, certain)
    return search_rows(rows, contacts, ranges, (outer_tool, inner_tool), (possible, certain), mode, proof, results)[1]


def until_not_reached(rows, at, contacts, ranges, tool, solids, results):
    """Look for postures of the samples `rows` from the `at`-th on, at which a tool is in nothing's way; where it ended.

    That is behind the first sample that has none; it is written as UNDECIDED, for nothing was asked about why. Intervals that
    `search` takes for none are passed over, so that it finds a posture where this does.
    """
    mode = Mode(at, _ANYWHERE, len(ranges.rotation_cos), _NO_INTERVAL, WITHOUT_END, False, True, 0.0)
    proof = Proof(_NOWHERE, 0.0, solids)
    return search_rows(rows, contacts, ranges, (tool, tool), (solids, solids), mode, proof, results)[0]


def posture(contacts, ranges, tool, narrowest, start, turns, solids, results, *, brief=False):
    """Look for a posture of the first contact at which a tool is in nothing's way; whether there is one, and boxes looked at.

    `narrowest`, `start` and `turns` as of a `Mode`; `solids`: all that may be in the way; `results` (VerdictArrays), written. A
    `brief` search gives up what takes long: there is none then.
    """
    mode = Mode(0, start, turns, narrowest, _BRIEF if brief else WITHOUT_END, False, False, 0.0)
    proof = Proof(_NOWHERE, 0.0, solids)
    looked = search_rows(_FIRST, contacts, ranges, (tool, tool), (solids, solids), mode, proof, results)[1]
    return bool(results.verdict[0] == codes.ACCESSIBLE), int(looked)


@entry
def first_reason(rows, contacts, ranges, inner_tool, certain, reason):
    """Write the reason (n,) of samples that no posture serves, where axis limit or curvature alone leave none; not others."""
    rotations, modes = len(ranges.rotation_cos), len(inner_tool.mode)
    intervals = np.empty((64, 2))
    f, t, e2 = np.empty(3), np.empty(3), np.empty(3)
    pasts, (other, workspace) = both(rotations, modes)
    side = Side(inner_tool, certain, SURELY_INSIDE, _NO_INTERVAL, WITHOUT_END, Proof(_NOWHERE, 0.0, certain))
    for row in rows:
        n, e1 = contacts.normal[row], contacts.direction_max[row]
        cross(n, e1, e2)
        axis_remains, curvature_remains = False, False
        for rotation in range(rotations):
            cosine, sine = turn_of(n, e1, ranges, rotation)
            tilt_frame(e1, e2, cosine, sine, f, t)
            for mode in range(modes):
                _, count = place.permitted(contacts, row, ranges, inner_tool, mode, f, intervals)
                axis_remains = axis_remains or count > 0
                least, most = place.straight(contacts, row, cosine, sine, inner_tool, mode)
                count = place.clip_straight(least, most, intervals, count)
                curvature_remains = curvature_remains or count > 0
            if curvature_remains:
                break
        if not axis_remains:
            reason[row] = codes.AXIS_LIMIT
        elif not curvature_remains:
            # As `search` would have told it.
            sweep(contacts, row, ranges, side, START[1], rotations, pasts[1], workspace)
            other.tally[:] = 0.0
            other.tally[codes.AXIS_LIMIT] = 1.0
            reason[row] = _reason(other.tally, workspace.tally)


@entry
def free(rows, point, normal, axis, tilt_direction, tool, solids, stands):
    """Test given postures.

    `rows` (m,) int64: contacts to test, neighbours in sequence: a triangle in the way at one of them is tried first at the next.
    `point`, `normal`, `axis`, `tilt_direction` (n, 3) float64: contact, unit normal, unit tool axis, tilt direction: a unit
      vector, or shorter with the contact under the flat.
    `tool`: smaller by what does not matter.
    `solids`: all that may be in the way.
    `stands` (n,) bool, written: False also at a tilt at which the tool does not touch.
    Returns how many boxes were looked at.
    """
    body, f, t, workspace, hint = np.empty(BODY), np.empty(3), np.empty(3), scratch(), -1
    for row in rows:
        stands[row] = False
        mode = _stand_as_given(row, point, normal, axis, tilt_direction, tool, body, f, t)
        if mode >= 0:
            stands[row], hint = place.is_free(body, mode, tool, solids, workspace, hint)
    return workspace.looked[0]


@kernel
def _stand_as_given(row, point, normal, axis, tilt_direction, tool, body, f, t):
    """Put a tool down in a posture that is given; the mode in which it touches, -1 for none."""
    n, share = normal[row], place.straightened(tilt_direction[row], f)
    cross(n, f, t)
    cosine, sine = dot(axis[row], n), dot(axis[row], f)
    mode = place.mode_at(tool, np.arctan2(sine, cosine))
    if mode >= 0:
        stand(body, Frame(point[row], n, f, t), cosine, sine, share * tool.mode[mode, OFFSET_OF], tool.mode[mode, RISE])
    return mode


@entry
def probe(rows, point, normal, axis, tilt_direction, tool, tree, triangle, which):
    """Test given postures: the triangle that reaches into the tool at posture i and the piece that it reaches into, or -1.

    `rows` (m,) int64: rows to test. `point`, `normal`, `axis`, `tilt_direction` (n, 3) float64: contact, unit normal, unit tool
    axis, tilt direction: a unit vector, or shorter with the contact under the flat. `tool`: without what does not matter.
    `triangle`, `which` (n,) int32, written: at a tilt at which the tool does not touch: -2.
    """
    body, f, t, workspace, hint = np.empty(BODY), np.empty(3), np.empty(3), scratch(), -1
    for row in rows:
        mode = _stand_as_given(row, point, normal, axis, tilt_direction, tool, body, f, t)
        if mode < 0:
            triangle[row], which[row] = -2, -2
            continue
        triangle[row], which[row], _, _, _ = tree_hit(tree, body, tool.piece[mode], 0.0, hint, workspace)
        if triangle[row] >= 0:
            hint = triangle[row]


@entry
def dummy_clear(rows, contacts, dummy, tool, solids, clear):
    """Test the dummy tool, which holds the tool at tilt 0 in every rotation, its axis along the normal.

    `rows` (m,) int64. `dummy` (k, COLUMNS) float64: `Assembly.dummy`, without what does not matter. `solids`: all that may be in
    the way. `clear` (n,) bool, written: True where nothing reaches into the dummy, and the dummy lies in no body. Returns how
    many boxes were looked at.
    """
    body, f, t, workspace, hint = np.empty(BODY), np.empty(3), np.empty(3), scratch(), -1
    for row in rows:
        n = contacts.normal[row]
        perpendicular(n, f)
        cross(n, f, t)
        stand(body, Frame(contacts.point[row], n, f, t), 1.0, 0.0, 0.0, tool.mode[0, RISE])
        triangle, _, _, _, _ = tree_hit(solids.tree, body, dummy, 0.0, hint, workspace)
        clear[row] = triangle < 0 and not place.inside(body, tool, 0, solids, MAYBE_INSIDE, workspace)
        if triangle >= 0:
            hint = triangle
    return workspace.looked[0]


#: Tools from the smallest up: piece (tools, m, k, COLUMNS), mode (tools, m, 5), reach, inner and end (tools,), each as in `Tool`.
Ladder = namedtuple("Ladder", "piece mode reach inner end")


class _Sides(NamedTuple):
    """This record is a `Side` of many tools: the tools; `piece` and `mode`, a workspace for one of them; the rest as there.

    pasts: the obstacle caches, one for each kind of sweep.
    """

    tools: Any
    piece: Any
    mode: Any
    solids: Solids
    within: float
    narrowest: float
    pasts: Any
    proof: Any


@kernel
def _look(contacts, row, ranges, side, level, starts, turns, workspaces):
    """Search as `sweep_both` with one tool of a row."""
    tools, piece, mode = side.tools, side.piece, side.mode
    for m in range(len(mode)):
        for column in range(mode.shape[1]):
            mode[m, column] = tools.mode[level, m, column]
        for k in range(piece.shape[1]):
            for column in range(piece.shape[2]):
                piece[m, k, column] = tools.piece[level, m, k, column]
    tool = Tool(piece, mode, tools.reach[level], tools.inner[level], tools.end[level])
    one = Side(tool, side.solids, side.within, side.narrowest, WITHOUT_END, side.proof)
    return sweep_both(contacts, row, ranges, one, side.pasts, starts, turns, workspaces)


@kernel
def _largest(contacts, row, ranges, outer, inner, guess, last, freed, workspaces, results):
    """The largest tool that finds a posture, -1 for none, the verdict on the next, and where the searches of both sides ended."""
    count, turns = len(outer.tools.reach), len(ranges.rotation_cos)
    # Reached, not reached; not known to be inaccessible, known to be so.
    low, high, free, beyond = -1, count, -1, count
    level, stride = guess, 1
    while high - low > 1:
        rotation, tilt, last = _look(contacts, row, ranges, outer, level, last, 1, workspaces)
        if rotation < 0 and level > free:
            turn, _, freed = _look(contacts, row, ranges, inner, level, freed, turns, workspaces)
            if turn < 0:
                beyond = level
                results.reason[row] = _reason(workspaces[0].tally, workspaces[1].tally)
            else:
                free = level
        if rotation < 0 and level < beyond:
            rotation, tilt, last = _look(contacts, row, ranges, outer, level, last, turns, workspaces)
            if rotation < 0:
                results.reason[row] = _reason(workspaces[0].tally, workspaces[1].tally)
        if rotation < 0:
            high = level
        else:
            low = level
            _write(results, row, contacts, ranges, rotation, tilt)
        if low < 0:
            level = max(high - stride, 0)
        elif high == count:
            level = min(low + stride, count - 1)
        else:
            level = (low + high) // 2
        stride *= 2
    return low, codes.INACCESSIBLE if beyond == high else codes.UNDECIDED, last, freed


@entry
def largest(rows, contacts, ranges, outer_tool, inner_tool, possible, certain, results, level, beyond):
    """Find the largest tool that reaches each sample.

    `rows` (m,) int64: samples, neighbours in sequence.
    `outer_tool`, `inner_tool` (Ladder): the outer and the inner tools; each lies within the next.
    `possible`, `certain` (Solids): as `search.search` takes them.
    `results` (Found), written: the posture of the largest tool that has one, and the reason why the next one has none.
    `level` (n,) int64, written: the number of the largest tool that has a posture, -1 where none has.
    `beyond` (n,) uint8, written: INACCESSIBLE or UNDECIDED for the tool after it; as it was where there is none.
    """
    rotations = len(ranges.rotation_cos)
    pasts, workspaces = both(rotations, outer_tool.mode.shape[1])
    met, _ = both(rotations, inner_tool.mode.shape[1])
    proof, (piece, mode), (held, ways) = Proof(np.zeros(0), 0.0, certain), outer_tool[:2], inner_tool[:2]
    outer = _Sides(outer_tool, piece[0].copy(), mode[0].copy(), possible, MAYBE_INSIDE, _FINEST, pasts, proof)
    inner = _Sides(inner_tool, held[0].copy(), ways[0].copy(), certain, SURELY_INSIDE, _NO_INTERVAL, met, proof)
    guess, last, freed = len(outer_tool.reach) // 2, START, START
    for row in rows:
        low, verdict, last, freed = _largest(contacts, row, ranges, outer, inner, guess, last, freed, workspaces, results)
        level[row], guess = low, max(low, 0)
        if low + 1 < len(outer_tool.reach):
            beyond[row] = verdict
