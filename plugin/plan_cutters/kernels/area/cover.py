"""Does the posture of a sample, its axis kept, also serve the surface around it? The argument is in `docs/between_samples.md`.

Obstacles are shared out by distance from the contact. Within `extent` of it the surface that the contact lies on is
held below a paraboloid by its curvature and a bound on the change of curvature, and the cutter above one that is lower by no
more than is allowed: nothing to test. Everything else is tested against the cutter moved along with the contact: each of its
pieces larger, and drawn out across the axis, for the directions in which the contact wanders and the cutter turns about its
axis.
"""

from typing import Any, NamedTuple

import numpy as np

from plan_cutters.kernels.area.moved_cutter import BODIES, Workspace, extruded, first_in_the_way, grown
from plan_cutters.kernels.area.near import LIFT, MOST_TURN, STRETCH, extent, halvings, spared, too_steep
from plan_cutters.kernels.area.zone import EXTENTS, Nose, begin, distance_of, held_below, look_round, seen
from plan_cutters.kernels.codes import BOTTOM, COLUMNS, NEVER, TOP, WIDE
from plan_cutters.kernels.jit import entry, kernel
from plan_cutters.kernels.linear.vectors import cross, dot, perpendicular
from plan_cutters.kernels.rows import Frame
from plan_cutters.kernels.search.place import mode_at
from plan_cutters.kernels.tool import hit
from plan_cutters.kernels.tool.hit import BODY, HALF, OFFSET, A, P, X, Y

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


class Patches(NamedTuple):
    """Contacts on one face, each with the patch about it that its axis may serve.

    point, normal, axis (n, 3). tensor (n, 3, 3): second fundamental form in part coordinates, 1/mm, concave positive.
    flat (n,) bool: interference-free, the axis is the normal in any tilt direction. side (n, 3): unit tilt direction where the
    axis is the normal all over the patch. patch (n,): its radius, mm; nan: not decided.
    home (n, 2) int32: the grid node in whose cell the contact lies.
    """

    point: Any
    normal: Any
    tensor: Any
    axis: Any
    flat: Any
    side: Any
    patch: Any
    home: Any


class Sweeping(NamedTuple):
    """A tool as this asks for it.

    tool : Tool, the outer one; dummy (k, COLUMNS), as `search.dummy_clear` takes it; nose (m,) int64: of each mode a mask of the
    pieces that lie in the volume that its nose sweeps when it goes on along the axis, widening by `widening` (m,), rad; flutes, a
    mask of the pieces that cut; depth, chord: the depth up to which a triangle does not matter, and the chord error, mm.
    """

    tool: Any
    dummy: Any
    nose: Any
    widening: Any
    flutes: int
    depth: float
    chord: float


@kernel
def _motion(row, patches, nodes, frame, sine, h, turn, offset, rise):
    """How a contact's cutter moves and turns about its axis as the contact wanders.

    Returns the surface's curvature along the tilt direction, across it and mixed; the turn about the axis within the patch, in
    all (psi), and the part of it that does not follow from the curvature at the contact; that part of the normal's change.
    """
    k_ff, k_tt, k_ft, home = 0.0, 0.0, 0.0, patches.home[row]
    for k in range(3):
        for m in range(3):
            k_ff += patches.tensor[row, k, m] * frame.f[k] * frame.f[m]
            k_ft += patches.tensor[row, k, m] * frame.f[k] * frame.t[m]
            k_tt += patches.tensor[row, k, m] * frame.t[k] * frame.t[m]
    variation = nodes.about[nodes.index[home[0], home[1]], 12]
    rest = 2.0 * variation * h + turn * turn
    if offset == 0.0:
        return k_ff, k_tt, k_ft, 0.0, 0.0, rest
    lateral = (2.0 * variation * h + 0.5 * turn * turn + turn * turn / (sine - turn)) / (sine - turn)
    psi = min(turn / (sine - turn), (abs(k_tt) + abs(k_ft)) * h / sine + lateral)
    return k_ff, k_tt, k_ft, psi, lateral, rest


@kernel
def _cell_status(row, patches, nodes, face, sweeping, tree, triangle_face, blocker, body, workspace):
    """Return the `status` of `cover` for a contact, and the triangle in the way, -1 if none; `blocker` is tested first.

    An axis near the normal that does not serve with a lean of a known side may serve about itself (lemma B11), and on a plane
    across it all on one side (B12). On a plane along the axis it shifts (B15).
    """
    first = _ABOUT if patches.flat[row] else _LEANING
    best, result = _by(first, row, patches, nodes, face, sweeping, tree, triangle_face, blocker, body, workspace)
    if first == _LEANING:
        for rule in (_ABOUT, _LEVEL):
            if best == 0:
                break
            if rule == _ABOUT and not sweeping.tool.mode[0, 0] > 0.0:
                continue
            status, met = _by(rule, row, patches, nodes, face, sweeping, tree, triangle_face, result, body, workspace)
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
def _by(rule, row, patches, nodes, face, sweeping, tree, triangle_face, blocker, body, workspace):
    """`_outlook` by one rule."""
    tool, depth, chord = sweeping.tool, sweeping.depth, sweeping.chord
    f, t, near = workspace.f, workspace.t, workspace.near
    p, n, a = patches.point[row], patches.normal[row], patches.axis[row]
    h, flat, home = patches.patch[row], patches.flat[row], patches.home[row]
    if not h > 0.0:
        return 1, -1
    cosine = dot(a, n)
    for k in range(3):
        f[k] = a[k] - cosine * n[k]
    steepness = np.sqrt(dot(f, f))
    sine = steepness
    upright, along = rule != _LEANING, rule == _LEVEL and abs(cosine) <= _ALONG
    if rule == _LEVEL and not along:
        side = patches.side[row]
        length = np.sqrt(dot(side, side))
        # A side that is not known, or does not lie in the plane, is none.
        if not (steepness <= _ALONG and cosine > 0.0 and abs(length - 1.0) <= 1e-6 and abs(dot(side, n)) <= 1e-6):
            return NEVER, -1
        for k in range(3):
            f[k] = side[k]
        sine, cosine = 0.0, 1.0
    elif flat or sine < 1e-6:
        sine, cosine = 0.0, 1.0
        perpendicular(n, f)
    else:
        for k in range(3):
            f[k] /= sine
    cross(n, f, t)
    tilt = np.arctan2(sine, cosine)
    mode = 0 if flat else mode_at(tool, tilt)
    if mode < 0:
        return NEVER, -1
    offset, rise, low, high, _ = tool.mode[mode]
    if (
        upright
        and not flat
        and not along
        and not (
            mode == 0 and low <= 0.0 and cosine > 0.0 and steepness <= _NEAR * MOST_TURN and len(sweeping.dummy) > 0
        )
    ):
        return NEVER, -1
    nose = Nose(offset, rise, np.cos(sweeping.widening[mode]), np.sin(sweeping.widening[mode]), low, high)
    if flat and len(tool.mode) > 1 and high < 0.25:
        return NEVER, -1
    frame, pose, most = Frame(p, n, f, t), (sine, cosine), workspace.seen.most
    if not begin(frame, h, home, nodes, workspace.seen):
        return NEVER, -1
    if rule == _LEVEL and not STRETCH * most[0, 3] * _SMALLEST * h <= _ALONG:
        return NEVER, -1
    # In the smallest patch there remain the home node's own curvature and what it may differ in its cell.
    least = spared(chord + distance_of(0) * _SMALLEST * h, depth, chord)
    if not upright and not held_below(pose, 0.0, most[0, 0] - least, most[0, 2], most[0, 1] - least, 0.0, nose):
        return NEVER, -1
    if rule == _LEVEL:
        # What a cutter that stands exactly enters of a plane that leans this little.
        depth -= (_longest(tool.piece[mode]) if along else 2.0 * offset) * (2.0 * _ALONG)
    full, turn, lift, k_ff, k_tt, k_ft, psi, lateral, rest = np.inf, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    # Bounds do not get smaller with distance: what does not hold nearby needs no look farther out.
    for last in (0, _HALF_WAY, EXTENTS - 1):
        if full == np.inf:
            full = look_round(frame, h, home, nodes, workspace.seen, h * distance_of(last))
        if full < 0.0:
            return 1, -1
        # How far the normal turns within the patch, and how far the surface leaves the tangent plane.
        turn, lift = STRETCH * most[0, 3] * h, LIFT * most[0, 3] * h * h
        if upright and not flat:
            # In a smaller patch normals turn less: there the lean is no nearer to them.
            if rule == _ABOUT and not steepness <= _NEAR * turn + _ALONG:
                return NEVER, -1
            if rule == _LEVEL and not turn <= _ALONG:
                return 1, -1
            if len(tool.mode) > 1 and not along and not tilt + turn <= high:
                return 1, -1
        if not turn <= MOST_TURN or too_steep(pose, turn, upright, nose):
            return halvings(most, h, pose, upright, nose, depth, chord, near), -1
        if not upright:
            k_ff, k_tt, k_ft, psi, lateral, rest = _motion(row, patches, nodes, frame, sine, h, turn, offset, rise)
        held = extent(most, last, full, h, pose, upright, psi, turn, nose, depth, chord, near)
        if held < 0:
            return halvings(most, h, pose, upright, nose, depth, chord, near), -1
        if held < last:
            break
    if not near[0] > 0.0:
        return NEVER, -1
    for k in range(3):
        body[P + k] = p[k] + rise * n[k]
        body[A + k] = a[k]
        body[X + k] = cosine * f[k] - sine * n[k]
        body[Y + k] = t[k]
    body[HALF] = 0.0
    if rule == _ABOUT:
        body[OFFSET] = 0.0
        for k in range(BODY):
            workspace.bodies[0, k] = body[k]
        # What the contact and the centre of curvature move across the axis, and along it.
        grown(
            sweeping.dummy,
            workspace.pieces[0],
            h + rise * turn,
            lift + h * steepness + rise * turn * (steepness + turn),
        )
    elif rule == _LEVEL:
        body[OFFSET] = offset
        grow = lift + (h + rise + 2.0 * offset) * 2.0 * _ALONG
        extruded(body, tool.piece[mode], frame, h, pose, (1.0, 0.0, 0.0, 1.0, 0.0), grow, workspace, 18)
    else:
        body[OFFSET] = offset
        grow = 0.5 * abs(offset) * psi * psi + lift + rise * rest
        # The centre of curvature wanders less than the contact on a concave surface, and turns with the normal.
        lever = rise + (offset / sine if sine > 0.0 else 0.0)
        slides = (1.0 - rise * k_ff, rise * abs(k_ft), lever * k_ft, abs(1.0 - lever * k_tt), abs(offset) * lateral)
        extruded(body, tool.piece[mode], frame, h, pose, slides, grow, workspace, 18)
    exempt = sweeping.flutes if upright else sweeping.nose[mode]
    near[6], near[7], near[8] = turn, lift, depth
    hit = first_in_the_way(
        blocker, exempt, sweeping.flutes, rule == _ABOUT, frame, face, tree, triangle_face, workspace
    )
    return 0 if hit < 0 else 1, hit


@entry
def cover(rows, patches, nodes, face, sweeping, tree, triangle_face, status):
    """Decide for contacts on one face whether their axis serves every contact within a patch about them.

    Parameters
    ----------
    rows : (m,) int64
    patches : Patches
    nodes : Nodes
    face : int
        Number of the face.
    sweeping : Sweeping
    tree : Tree
    triangle_face : (t,) int32
        Face numbers of its triangles.
    status : (n,) uint8, written
        0: it does. 1 to MOST_HALVINGS: not known; how often the patch must be halved until it may, a guess that tells what to
        try first. NEVER: it serves no smaller patch, either, down to a quarter of its size, as far as the nodes tell.

    Returns
    -------
    int
        How many boxes were looked at, and what else takes as long: triangles and nodes.
    """
    count = sweeping.tool.piece.shape[1]
    workspace = Workspace(np.empty(3), np.empty(3), np.empty((BODIES, BODY)), np.empty((BODIES, count, COLUMNS)), np.empty(9),
                           seen(), hit.scratch())  # fmt: skip
    body, blocker = np.empty(BODY), -1
    for row in rows:
        status[row], blocking = _cell_status(
            row, patches, nodes, face, sweeping, tree, triangle_face, blocker, body, workspace
        )
        # What was in the way of one contact is likely in the way of the next.
        blocker = blocking if blocking >= 0 else blocker
    return workspace.scratch.looked[0] + workspace.seen.looked[0] // _NODES
