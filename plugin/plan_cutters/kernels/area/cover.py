"""Does the posture of a sample, its axis kept, also serve the surface around it? The argument is in `docs/between_samples.md`.

Obstacles are shared out by distance from the contact. Within `extent` of it the surface that the contact lies on is
held below a paraboloid by its curvature and a bound on the change of curvature, and the cutter above one that is lower by no
more than is allowed: nothing to test. Everything else is tested against the cutter moved along with the contact: each of its
pieces larger, and drawn out across the axis, for the directions in which the contact wanders and the cutter turns about its axis
(lemmas B10, B13 and B16).
"""

from collections import namedtuple
from typing import Any, NamedTuple

import numpy as np

from plan_cutters.kernels.area import zone
from plan_cutters.kernels.area.zone import EXTENTS, LIFT, MOST_TURN, STRETCH, Nose
from plan_cutters.kernels.codes import ARC, BOTTOM, COLUMNS, CONE, HIGH, KIND, LOW, NEVER, RADIUS, ROUND, SCALE, SLOPE, TOP, WIDE
from plan_cutters.kernels.jit import entry, kernel
from plan_cutters.kernels.linear.tree import half, half_of
from plan_cutters.kernels.linear.vectors import cross, dot, perpendicular
from plan_cutters.kernels.rows import Frame
from plan_cutters.kernels.search.place import mode_at
from plan_cutters.kernels.tool import hit
from plan_cutters.kernels.tool.apart import BODY, HALF, OFFSET, A, P, X, Y, alive
from plan_cutters.kernels.tool.hit import extruded_hit

#: Bodies of a patch: the whole, and pieces of it along the tilt direction, 2, 6 and 18.
BODIES = 27
#: Boxes in whose time a triangle is looked at, about.
_TRIANGLE = 2


#: A workspace for a contact: tilt direction f and t = n x f, bodies and their pieces, those of a tool whose axis turns, bounds of
#: curvature, what counts as near.
Workspace = namedtuple("Workspace", "f t bodies pieces swung near seen scratch")


@kernel
def _grow(out, k, radial, axial):
    """Let piece k hold itself moved by no more than `radial` across the axis and `axial` along it."""
    out[k, LOW] -= axial
    out[k, HIGH] += axial
    if out[k, KIND] == ARC:
        both = np.sqrt(radial * radial + axial * axial)
        out[k, ROUND] += both
        out[k, BOTTOM] = max(out[k, LOW], out[k, SLOPE] - out[k, ROUND])
        out[k, TOP] = min(out[k, HIGH], out[k, SLOPE] + out[k, ROUND])
        out[k, WIDE] += both
    else:
        slope = out[k, SLOPE]
        out[k, RADIUS] += radial + (abs(slope) - slope) * axial
        out[k, WIDE] += radial + (abs(slope) + slope) * axial
        out[k, BOTTOM], out[k, TOP] = out[k, LOW], out[k, HIGH]


@kernel
def grown(piece, out, radial, axial):
    """Write pieces that hold these, moved by no more than `radial` across the axis and `axial` along it."""
    for k in range(len(piece)):
        for c in range(COLUMNS):
            out[k, c] = piece[k, c]
        _grow(out, k, radial, axial)


@kernel
def swung(piece, out, swing, sway, offset):
    """Write pieces that hold these, their axis turned by no more than `swing` about the centre of curvature (lemma B16).

    `sway` is how far the side on which the tool stands turns about the axis then, rad.
    """
    for k in range(len(piece)):
        for c in range(COLUMNS):
            out[k, c] = piece[k, c]
        if swing == 0.0:
            continue
        low, far = abs(out[k, BOTTOM]), max(abs(out[k, BOTTOM]), abs(out[k, TOP]))
        wide = max(0.0, max(out[k, RADIUS], out[k, WIDE]))
        across = abs(offset) * (sway + swing) + 0.5 * swing * swing * wide
        along = (abs(offset) + wide) * swing + 0.5 * swing * swing * far
        if out[k, KIND] == ARC:
            _grow(out, k, across + swing * far, along)
            continue
        # What is farther along the axis moves farther: the piece widens.
        out[k, KIND], out[k, SLOPE] = CONE, out[k, SLOPE] + swing
        out[k, SCALE] = 1.0 / np.sqrt(1.0 + out[k, SLOPE] ** 2)
        out[k, RADIUS] += across + swing * low
        out[k, WIDE] += across + swing * (low + out[k, HIGH] - out[k, LOW])
        _grow(out, k, 0.0, along)


@kernel
def extruded(body, piece, frame, h, pose, slides, grow, workspace, finest):
    """Write the bodies of a contact that wanders by no more than h: the whole, then 2, 6 and 18 parts along f.

    Each holds all moved cutters of its part (lemma B10).
    Each holds those that it is cut into. `pose` is (sine, cosine) of the tilt. `slides` says how far the tool
    moves along the tilt direction for a step along it and for a step across it; then the same across that direction; then how
    much farther it may move across it. `grow` is the bound of any other motion. `body` is the body without wandering.
    """
    sine, cosine = pose
    forth, back, slide, across, sideways = slides
    at = 0
    for count in (1, 2, 6, 18):
        if count > finest:
            return
        wide = h / count
        for step in range(count):
            shift = (2 * step + 1 - count) * wide
            for k in range(BODY):
                workspace.bodies[at, k] = body[k]
            for k in range(3):
                workspace.bodies[at, P + k] += shift * (forth * frame.f[k] - slide * frame.t[k])
            workspace.bodies[at, HALF] = h * across + wide * abs(slide) + sideways
            along = wide * abs(forth) + h * back
            grown(piece, workspace.pieces[at], along * abs(cosine) + grow, along * sine + grow)
            at += 1


@kernel
def _reaches(vertex, i, mask, workspace):
    """Whether triangle i, which reaches into the whole, reaches into one of its finest parts."""
    bodies, pieces, scratch = workspace.bodies, workspace.pieces, workspace.scratch
    for one in range(2):
        scratch.looked[0] += _TRIANGLE
        if not extruded_hit(vertex, i, bodies[1 + one], pieces[1 + one], mask, scratch):
            continue
        for sixth in range(3 * one, 3 * one + 3):
            scratch.looked[0] += _TRIANGLE
            if not extruded_hit(vertex, i, bodies[3 + sixth], pieces[3 + sixth], mask, scratch):
                continue
            for last in range(3 * sixth, 3 * sixth + 3):
                scratch.looked[0] += _TRIANGLE
                if extruded_hit(vertex, i, bodies[9 + last], pieces[9 + last], mask, scratch):
                    return True
    return False


@kernel
def _below(vertex, i, frame, near):
    """Whether triangle i is no deeper in flutes than allowed, for it is no higher over the tangent planes of the patch (B13)."""
    p, n, _, _ = frame
    for corner in range(3):
        dx, dy, dz = vertex[i, corner, 0] - p[0], vertex[i, corner, 1] - p[1], vertex[i, corner, 2] - p[2]
        height, away = dx * n[0] + dy * n[1] + dz * n[2], np.sqrt(dx * dx + dy * dy + dz * dz)
        if not height + away * near[6] + near[7] <= near[8]:
            return False
    return True


@kernel
def _blocks(i, mask, nose, flutes, whole, frame, face, vertex, triangle_face, workspace):
    """Whether triangle i reaches into a piece of the moved cutter; into its nose only if it is not near."""
    workspace.scratch.looked[0] += _TRIANGLE
    hit = extruded_hit(vertex, i, workspace.bodies[0], workspace.pieces[0], mask, workspace.scratch)
    if hit & nose and zone.near_by(vertex, triangle_face, i, frame, face, workspace.near):
        hit &= ~nose
    if hit & flutes and _below(vertex, i, frame, workspace.near):
        hit &= ~flutes
    return hit != 0 and (whole or _reaches(vertex, i, hit, workspace))


@kernel
def first_in_the_way(hint, nose, flutes, whole, frame, face, tree, triangle_face, workspace):
    """First triangle found that is in the way of the moved cutter, `hint` (-1: none) before others."""
    stack, masks = workspace.scratch.stack, workspace.scratch.masks
    every = hit.everything(workspace.pieces[0])
    if hint >= 0:
        vertex, row = half_of(tree, hint)
        if _blocks(row, every, nose, flutes, whole, frame, face, vertex, triangle_face[hint - row :], workspace):
            return hint
    for k in range(2):
        vertex, box, depth, begin = half(tree, k)
        count, first, top = len(vertex), (1 << depth) - 1, 1 if len(vertex) else 0
        faces = triangle_face[begin:]
        stack[0], masks[0] = 0, every
        while top > 0:
            top -= 1
            node = stack[top]
            workspace.scratch.looked[0] += 1
            mask = alive(box, node, workspace.bodies[0], workspace.pieces[0], masks[top], 0.0)
            if mask == 0:
                continue
            if node < first:
                stack[top], masks[top] = 2 * node + 2, mask
                stack[top + 1], masks[top + 1] = 2 * node + 1, mask
                top += 2
                continue
            leaf = node - first
            for i in range((count * leaf) >> depth, (count * (leaf + 1)) >> depth):
                if _blocks(i, mask, nose, flutes, whole, frame, face, vertex, faces, workspace):
                    return begin + i
    return -1


#: The smallest patch that is thought of, as a share of the one at hand.
_SMALLEST = 1.0 / 4.0
#: Row of a distance within which a sixth of the nodes lie.
_HALF_WAY = 8
#: Nodes looked at in the time of a box, about.
_NODES = 6
#: How a patch is served: by a lean of a known side; in the dummy about the axis, whatever the side; as a plane across the axis,
#: all on one side, or along the axis.
_LEANING, _ABOUT, _LEVEL = 0, 1, 2
#: An axis is near the normal up to so many turns of the normal in the patch, and along it where both are no larger, rad.
_NEAR, _ALONG = 4.0, 1e-9


#: Contacts on one face, each with the patch about it that its axis may serve.
#: point, normal, axis (n, 3). tensor (n, 3, 3): second fundamental form in part coordinates, 1/mm, concave positive. flat (n,)
#: bool: interference-free, the axis is the normal in any tilt direction. side (n, 3): unit tilt direction where the axis is the
#: normal all over the patch. patch (n,): its radius, mm; nan: not decided. home (n, 2) int32: the grid node in whose cell the
#: contact lies.
Patches = namedtuple("Patches", "point normal tensor axis flat side patch home swing")


class Sweeping(NamedTuple):
    """A tool as this asks for it."""

    tool: Any  #: The outer one.
    dummy: Any  #: (k, COLUMNS), as `search.dummy_clear` takes it.
    nose: Any  #: (m,) int64: of each mode a mask of the pieces that lie in what its nose sweeps when it goes on along the axis.
    widening: Any  #: (m,): by which angle that widens, rad.
    flutes: int  #: A mask of the pieces that cut.
    depth: float  #: Up to which a triangle does not matter, mm.
    chord: float  #: The chord error, mm.


class Stance(NamedTuple):
    """This record holds how one rule takes a contact's cutter."""

    rule: int
    upright: bool  #: The tilt direction is not known, or there is none.
    along: bool  #: The axis lies along a plane.
    sine: float  #: Of the tilt.
    cosine: float
    steepness: float  #: What the axis has across the normal, whatever the rule takes it for.
    mode: int  #: In which the cutter touches.


class Wander(NamedTuple):
    """This record holds how a cutter moves and turns about its axis as the contact wanders in its patch."""

    status: int  #: As of `cover` where bounds alone decide, -1 where they do not.
    turn: float  #: Of the normal, rad.
    lift: float  #: Of the surface off the tangent plane, mm.
    k_ff: float  #: Curvature along the tilt direction, 1/mm.
    k_tt: float  #: Across it.
    k_ft: float  #: Mixed.
    psi: float  #: The turn about the axis in all, rad.
    lateral: float  #: The part of it that does not follow from the curvature at the contact, rad.
    rest: float  #: That part of the normal's change.
    sway: float  #: The turn about the axis by what the axis itself turns, rad.


@kernel
def _decided(status):
    """What wanders where bounds alone decide."""
    return Wander(status, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)


@kernel
def _wander(row, patches, nodes, frame, sine, offset, turn, lift):
    """How a contact's cutter that changes to a known side moves as the contact wanders."""
    k_ff, k_tt, k_ft, home, h = 0.0, 0.0, 0.0, patches.home[row], patches.patch[row]
    for k in range(3):
        for m in range(3):
            k_ff += patches.tensor[row, k, m] * frame.f[k] * frame.f[m]
            k_ft += patches.tensor[row, k, m] * frame.f[k] * frame.t[m]
            k_tt += patches.tensor[row, k, m] * frame.t[k] * frame.t[m]
    variation = nodes.about[nodes.index[home[0], home[1]], 12]
    rest = 2.0 * variation * h + turn * turn
    if offset == 0.0:
        return Wander(-1, turn, lift, k_ff, k_tt, k_ft, 0.0, 0.0, rest, 0.0)
    lateral = (2.0 * variation * h + 0.5 * turn * turn + turn * turn / (sine - turn)) / (sine - turn)
    psi = min(turn / (sine - turn), (abs(k_tt) + abs(k_ft)) * h / sine + lateral)
    swing = patches.swing[row]
    return Wander(-1, turn, lift, k_ff, k_tt, k_ft, psi, lateral, rest, swing / (sine - turn - swing))


#: It holds a tree and the face numbers of its triangles, the face of the contact, and the triangle tested first.
Obstacles = namedtuple("Obstacles", "tree triangle_face face hint")


@kernel
def _cell_status(row, patches, nodes, face, sweeping, tree, triangle_face, blocker, body, workspace):
    """Return the `status` of `cover` for a contact, and the triangle in the way, -1 if none; `blocker` is tested first.

    An axis near the normal that does not serve with a lean of a known side may serve about itself (lemma B11), and on a plane
    across it all on one side (B12). On a plane along the axis it shifts (B15).
    """
    first = _ABOUT if patches.flat[row] else _LEANING
    obstacles = Obstacles(tree, triangle_face, face, blocker)
    best, result = _status_by(first, row, patches, nodes, sweeping, obstacles, body, workspace)
    if first == _LEANING:
        for rule in (_ABOUT, _LEVEL):
            if best == 0:
                break
            if rule == _ABOUT and not sweeping.tool.mode[0, 0] > 0.0:
                continue
            obstacles = Obstacles(tree, triangle_face, face, result)
            status, met = _status_by(rule, row, patches, nodes, sweeping, obstacles, body, workspace)
            best, result = min(best, status), met if met >= 0 else result
    return best, result


@kernel
def _longest(piece):
    """Return a bound of the distance between any two points of a tool."""
    low, high, wide = np.inf, -np.inf, 0.0
    for k in range(len(piece)):
        low, high, wide = min(low, piece[k, BOTTOM]), max(high, piece[k, TOP]), max(wide, piece[k, WIDE])
    return high - low + 2.0 * wide


@kernel
def _leaning(rule, row, patches, f):
    """Write the tilt direction `f` that a rule takes; whether there is one, and the stance, of which only the mode is open."""
    n, a = patches.normal[row], patches.axis[row]
    cosine = dot(a, n)
    for k in range(3):
        f[k] = a[k] - cosine * n[k]
    steepness = np.sqrt(dot(f, f))
    upright, along = rule != _LEANING, rule == _LEVEL and abs(cosine) <= _ALONG
    if rule == _LEVEL and not along:
        side = patches.side[row]
        length = np.sqrt(dot(side, side))
        for k in range(3):
            f[k] = side[k]
        # A side that is not known, or does not lie in the plane, is none.
        known = steepness <= _ALONG and cosine > 0.0 and abs(length - 1.0) <= 1e-6 and abs(dot(side, n)) <= 1e-6
        return known, Stance(rule, upright, along, 0.0, 1.0, steepness, -1)
    if patches.flat[row] or steepness < 1e-6:
        perpendicular(n, f)
        return True, Stance(rule, upright, along, 0.0, 1.0, steepness, -1)
    for k in range(3):
        f[k] /= steepness
    return True, Stance(rule, upright, along, steepness, cosine, steepness, -1)


@kernel
def _touches(stance, flat, sweeping):
    """Whether a cutter touches in the mode of its stance so that the rule holds."""
    if stance.mode < 0:
        return False
    _, _, low, high, _ = sweeping.tool.mode[stance.mode]
    if flat:
        return not (len(sweeping.tool.mode) > 1 and high < 0.25)
    if not stance.upright or stance.along:
        return True
    near = stance.steepness <= _NEAR * MOST_TURN
    return stance.mode == 0 and low <= 0.0 and stance.cosine > 0.0 and near and len(sweeping.dummy) > 0


@kernel
def _settled(stance, turn, tilt, high, modes):
    """The `status` of `cover` where the normal's turn alone says that a rule does not hold all over the patch, else -1."""
    # In a smaller patch normals turn less: there the lean is no nearer to them.
    if stance.rule == _ABOUT and not stance.steepness <= _NEAR * turn + _ALONG:
        return NEVER
    if stance.rule == _LEVEL and not turn <= _ALONG:
        return 1
    if modes > 1 and not stance.along and not tilt + turn <= high:
        return 1
    return -1


@kernel
def _bounded(stance, row, patches, nodes, frame, sweeping, depth, workspace):
    """How the cutter moves within its patch, and whether bounds of curvature decide; writes `near`: what needs no test."""
    tool, chord, near, flat = sweeping.tool, sweeping.chord, workspace.near, patches.flat[row]
    h, home, upright, pose = patches.patch[row], patches.home[row], stance.upright, (stance.sine, stance.cosine)
    offset, rise, low, high, _ = tool.mode[stance.mode]
    widening = sweeping.widening[stance.mode]
    nose = Nose(offset, rise, np.cos(widening), np.sin(widening), low, high)
    tilt = np.arctan2(stance.sine, stance.cosine)
    most, full, wander = workspace.seen.most, np.inf, _decided(-1)
    # In the smallest patch there remain the home node's own curvature and what it may differ in its cell.
    least = zone.spared(chord + zone.distance_of(0) * _SMALLEST * h, sweeping.depth, chord)
    if not upright and not zone.held_below(pose, 0.0, most[0, 0] - least, most[0, 2], most[0, 1] - least, 0.0, nose):
        return _decided(NEVER)
    # Bounds do not get smaller with distance: what does not hold nearby needs no look farther out.
    for last in (0, _HALF_WAY, EXTENTS - 1):
        if full == np.inf:
            full = zone.look_round(frame, h, home, nodes, workspace.seen, h * zone.distance_of(last))
        if full < 0.0:
            return _decided(1)
        # How far the normal turns within the patch, and how far the surface leaves the tangent plane; the lean changes by what
        # the axis turns, too.
        turn, lift = STRETCH * most[0, 3] * h, LIFT * most[0, 3] * h * h
        changes = turn + patches.swing[row]
        settled = _settled(stance, changes, tilt, high, len(tool.mode)) if upright and not flat else -1
        if settled >= 0:
            return _decided(settled)
        if not turn <= MOST_TURN or zone.too_steep(pose, changes, upright, nose):
            return _decided(zone.halvings(most, h, pose, upright, nose, depth, chord, near))
        wander = Wander(-1, turn, lift, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
        if not upright:
            wander = _wander(row, patches, nodes, frame, stance.sine, offset, turn, lift)
        held = zone.extent(most, last, full, h, pose, upright, wander.psi + wander.sway, changes, nose, depth, chord, near)
        if held < 0:
            return _decided(zone.halvings(most, h, pose, upright, nose, depth, chord, near))
        if held < last:
            break
    return wander if near[0] > 0.0 else _decided(NEVER)


@kernel
def _move(stance, wander, row, patches, frame, sweeping, body, workspace):
    """Write the bodies and pieces that hold the cutter wherever it moves with its contact in the patch."""
    sine, cosine, h, swing = stance.sine, stance.cosine, patches.patch[row], patches.swing[row]
    offset, rise, _, _, _ = sweeping.tool.mode[stance.mode]
    turn, lift, steepness = wander.turn, wander.lift, stance.steepness
    for k in range(3):
        body[P + k] = frame.p[k] + rise * frame.n[k]
        body[A + k] = patches.axis[row, k]
        body[X + k] = cosine * frame.f[k] - sine * frame.n[k]
        body[Y + k] = frame.t[k]
    body[HALF] = 0.0
    body[OFFSET] = 0.0 if stance.rule == _ABOUT else offset
    if stance.rule == _ABOUT:
        for k in range(BODY):
            workspace.bodies[0, k] = body[k]
        # What the contact and the centre of curvature move across the axis, and along it.
        along = lift + h * steepness + rise * turn * (steepness + turn)
        swung(sweeping.dummy, workspace.swung, swing, 0.0, 0.0)
        grown(workspace.swung[: len(sweeping.dummy)], workspace.pieces[0], h + rise * turn, along)
        return
    if stance.rule == _LEVEL:
        grow, slides = lift + (h + rise + 2.0 * offset) * 2.0 * _ALONG, (1.0, 0.0, 0.0, 1.0, 0.0)
    else:
        grow = 0.5 * abs(offset) * wander.psi * wander.psi + lift + rise * wander.rest
        # The centre of curvature wanders less than the contact on a concave surface, and turns with the normal.
        lever = rise + (offset / sine if sine > 0.0 else 0.0)
        across, mixed = abs(1.0 - lever * wander.k_tt), lever * wander.k_ft
        slides = (1.0 - rise * wander.k_ff, rise * abs(wander.k_ft), mixed, across, abs(offset) * wander.lateral)
    swung(sweeping.tool.piece[stance.mode], workspace.swung, swing, wander.sway, offset)
    extruded(body, workspace.swung, frame, h, (sine, cosine), slides, grow, workspace, 18)


@kernel
def _status_by(rule, row, patches, nodes, sweeping, obstacles, body, workspace):
    """`_cell_status` by one rule."""
    f, t, near, flat, depth = workspace.f, workspace.t, workspace.near, patches.flat[row], sweeping.depth
    if not patches.patch[row] > 0.0:
        return 1, -1
    if patches.swing[row] > 0.0 and (flat or rule == _LEVEL):
        # What stands exactly is off a plane as soon as the axis turns.
        return NEVER, -1
    known, stance = _leaning(rule, row, patches, f)
    if not known:
        return NEVER, -1
    n = patches.normal[row]
    cross(n, f, t)
    mode = 0 if flat else mode_at(sweeping.tool, np.arctan2(stance.sine, stance.cosine))
    stance = Stance(rule, stance.upright, stance.along, stance.sine, stance.cosine, stance.steepness, mode)
    frame, seen_nodes = Frame(patches.point[row], n, f, t), workspace.seen
    if not _touches(stance, flat, sweeping) or not zone.begin(frame, patches.patch[row], patches.home[row], nodes, seen_nodes):
        return NEVER, -1
    if rule == _LEVEL:
        if not STRETCH * seen_nodes.most[0, 3] * _SMALLEST * patches.patch[row] <= _ALONG:
            return NEVER, -1
        # What a cutter that stands exactly enters of a plane that changes this little.
        wide = _longest(sweeping.tool.piece[mode]) if stance.along else 2.0 * sweeping.tool.mode[mode, 0]
        depth -= wide * (2.0 * _ALONG)
    wander = _bounded(stance, row, patches, nodes, frame, sweeping, depth, workspace)
    if wander.status >= 0:
        return wander.status, -1
    _move(stance, wander, row, patches, frame, sweeping, body, workspace)
    exempt = sweeping.flutes if stance.upright else sweeping.nose[mode]
    near[6], near[7], near[8] = wander.turn, wander.lift, depth
    hit = first_in_the_way(
        obstacles.hint, exempt, sweeping.flutes, rule == _ABOUT, frame, obstacles.face, obstacles.tree,
        obstacles.triangle_face, workspace,
    )  # fmt: skip
    return 0 if hit < 0 else 1, hit


@entry
def cover(rows, patches, nodes, face, sweeping, tree, triangle_face, status):
    """Decide for contacts on one face whether their axis serves every contact within a patch about them.

    `rows` (m,) int64. `face` (int): number of the face. `triangle_face` (t,) int32: face numbers of its triangles. `status` (n,)
    uint8, written: 0: it does. 1 to MOST_HALVINGS: not known; how often the patch must be halved until it may, a guess that tells
    what to try first. NEVER: it serves no smaller patch, either, down to a quarter of its size, as far as the nodes tell. Returns
    how many boxes were looked at, and what else takes as long: triangles and nodes.
    """
    count = sweeping.tool.piece.shape[1]
    workspace = Workspace(
        np.empty(3), np.empty(3), np.empty((BODIES, BODY)), np.empty((BODIES, count, COLUMNS)), np.empty((count, COLUMNS)),
        np.empty(9), zone.seen(), hit.scratch(),
    )  # fmt: skip
    body, blocker = np.empty(BODY), -1
    for row in rows:
        status[row], blocking = _cell_status(row, patches, nodes, face, sweeping, tree, triangle_face, blocker, body, workspace)
        # What was in the way of one contact is likely in the way of the next.
        blocker = blocking if blocking >= 0 else blocker
    return workspace.scratch.looked[0] + workspace.seen.looked[0] // _NODES
