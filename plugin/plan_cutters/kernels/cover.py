"""Does the posture of a sample, its axis kept, also serve the surface around it? The argument is in `docs/between_samples.md`.

Obstacles are shared out by distance from the contact. Within `extent` of it the surface that the contact lies on is
held below a paraboloid by its curvature and a bound on the change of curvature, and the cutter above it: nothing to
test. Everything else is tested against the cutter moved along with the contact: a stadium instead of a disk across
the axis, for the directions in which the contact wanders and the cutter turns about its axis.
"""

from typing import Any, NamedTuple

import numpy as np

from plan_cutters.kernels import hit
from plan_cutters.kernels.hit import BODY, HALF, HIGH, LOW, OFFSET, RADIUS, A, P, X, Y
from plan_cutters.kernels.jit import entry, kernel
from plan_cutters.kernels.rows import Frame, Scratch
from plan_cutters.kernels.zone import (
    EXTENTS,
    begin,
    distance_of,
    held_below,
    look_round,
    near_by,
    seen,
)

#: Largest angle (rad) between normals within `extent`: up to it, the surface is a graph over its tangent planes.
_MOST_TURN = 0.5
#: Outlooks of a contact that is not known to serve its patch: most halvings that are told apart; none will do.
MOST_HALVINGS, NEVER = 3, 255
#: Row of a distance within which a sixth of the nodes lie.
_HALF_WAY = 8
#: Bodies of a patch: the whole, and pieces of it along the lean, 2, 6 and 18.
_BODIES = 27


class Patches(NamedTuple):
    """Contacts on one face, each with the patch about it that its axis may serve.

    point, normal, axis (n, 3). tensor (n, 3, 3): second fundamental form in part coordinates, 1/mm, concave positive.
    flat (n,) bool: interference-free, the axis is the normal and any lean counts. patch (n,): its radius, mm; nan: not decided.
    home (n, 2) int32: the grid node in whose cell the contact lies.
    """

    point: Any
    normal: Any
    tensor: Any
    axis: Any
    flat: Any
    patch: Any
    home: Any


class _Room(NamedTuple):
    """Where a contact is worked out: directions along and across the lean, bodies, bounds of curvature, what counts as near."""

    f: Any
    t: Any
    body: Any
    bodies: Any
    near: Any
    seen: Any
    scratch: Scratch


@kernel
def _to_segment(px, py, half):  # type: ignore[no-untyped-def]
    """Squared distance of a point from the segment (0, -half) (0, half)."""
    py -= min(half, max(-half, py))
    return px * px + py * py


@kernel
def _shadow_distance(polygon, count, half):  # type: ignore[no-untyped-def]
    """Squared distance between the shadow of a convex polygon and the segment (0, -half) (0, half)."""
    area = 0.0
    for i in range(count):
        j = i + 1 if i + 1 < count else 0
        area += polygon[i, 1] * polygon[j, 2] - polygon[j, 1] * polygon[i, 2]
    inside = abs(area) > 0.0
    best = np.inf
    for i in range(count):
        j = i + 1 if i + 1 < count else 0
        xi, yi = polygon[i, 1], polygon[i, 2]
        ex, ey = polygon[j, 1] - xi, polygon[j, 2] - yi
        best = min(best, _to_segment(xi, yi, half))
        # The segment's ends against the side, and whether one of them (the lower) lies within the polygon.
        square = ex * ex + ey * ey
        for end in (-half, half):
            part = 0.0
            if square > 0.0:
                part = min(1.0, max(0.0, (-xi * ex + (end - yi) * ey) / square))
            x, y = xi + part * ex, yi + part * ey - end
            best = min(best, x * x + y * y)
        if (xi * ey - (yi + half) * ex) * area < 0.0:
            inside = False
        # The side crosses the segment.
        if (xi < 0.0) != (xi + ex < 0.0) and abs(yi - xi / ex * ey) <= half:
            return 0.0
    return 0.0 if inside else best


@kernel
def _stadium_hit(vertex, i, body, polygon, spare):  # type: ignore[no-untyped-def]
    """Whether triangle i reaches into the stadium body."""
    low, high = body[LOW], body[HIGH]
    least, most, total = np.inf, -np.inf, 0.0
    for corner in range(3):
        dx = vertex[i, corner, 0] - body[0]
        dy = vertex[i, corner, 1] - body[1]
        dz = vertex[i, corner, 2] - body[2]
        height = dx * body[3] + dy * body[4] + dz * body[5]
        polygon[corner, 0] = height
        polygon[corner, 1] = dx * body[6] + dy * body[7] + dz * body[8] + body[OFFSET]
        polygon[corner, 2] = dx * body[9] + dy * body[10] + dz * body[11]
        least, most = min(least, height), max(most, height)
        total += height + polygon[corner, 1] + polygon[corner, 2]
    # What is no number is in the way.
    total += low + high
    if total - total != 0.0:
        return True
    if most <= low or least >= high:
        return False
    source, count = polygon, 3
    if least < low:
        count = hit._cut(source, count, spare, low, 1.0)
        source = spare
    if most > high:
        target = polygon if least < low else spare
        count = hit._cut(source, count, target, high, -1.0)
        source = target
    return count > 0 and not _shadow_distance(source, count, body[HALF]) >= body[RADIUS] * body[RADIUS]


@kernel
def _pieces(body, frame, h, pose, slides, bodies, finest):  # type: ignore[no-untyped-def]
    """Write the bodies of a contact that wanders by no more than h: the whole, then in 2, 6 and 18 pieces along the lean.

    Each piece holds those that it is cut into. `pose` is (sine, cosine) of the tilt, `slides` what a step along the lean
    shifts the body aside, what a step across it does, and what else may; `body` is that of no wandering.
    """
    sine, cosine = pose
    slide, across, beside = slides
    at = 0
    for count in (1, 2, 6, 18):
        if count > finest:
            return
        wide = h / count
        for step in range(count):
            shift = (2 * step + 1 - count) * wide
            for k in range(BODY):
                bodies[at, k] = body[k]
            for k in range(3):
                bodies[at, P + k] += shift * (frame.f[k] - slide * frame.t[k])
            bodies[at, RADIUS] += wide * cosine
            bodies[at, LOW] -= wide * sine
            bodies[at, HIGH] += wide * sine
            bodies[at, HALF] = h * across + wide * abs(slide) + beside
            at += 1


@kernel
def _reaches(vertex, i, bodies, polygon, spare):  # type: ignore[no-untyped-def]
    """Whether triangle i, which reaches into the whole, reaches into one of its finest pieces."""
    for half in range(2):
        if not _stadium_hit(vertex, i, bodies[1 + half], polygon, spare):
            continue
        for sixth in range(3 * half, 3 * half + 3):
            if not _stadium_hit(vertex, i, bodies[3 + sixth], polygon, spare):
                continue
            for last in range(3 * sixth, 3 * sixth + 3):
                if _stadium_hit(vertex, i, bodies[9 + last], polygon, spare):
                    return True
    return False


@kernel
def _blocks(i, bodies, flat, frame, face, near, tree, triangle_face, scratch):  # type: ignore[no-untyped-def]
    """Whether triangle i is not near and reaches into the moved cutter."""
    vertex, polygon, spare = tree.vertex, scratch.polygon, scratch.spare
    return (
        _stadium_hit(vertex, i, bodies[0], polygon, spare)
        and not near_by(vertex, triangle_face, i, frame, face, near)
        and (flat or _reaches(vertex, i, bodies, polygon, spare))
    )


@kernel
def _first(hint, bodies, flat, frame, face, near, tree, triangle_face, scratch):  # type: ignore[no-untyped-def]
    """First triangle found that is not near and reaches into the moved cutter, `hint` (-1: none) before others."""
    vertex, box, depth = tree
    stack, count, first, top = scratch.stack, len(vertex), (1 << depth) - 1, 1
    if hint >= 0 and _blocks(hint, bodies, flat, frame, face, near, tree, triangle_face, scratch):
        return hint
    stack[0] = 0
    while top > 0:
        top -= 1
        node = stack[top]
        if hit._box_apart(box, node, bodies[0], 0.0):
            continue
        if node < first:
            stack[top] = 2 * node + 2
            stack[top + 1] = 2 * node + 1
            top += 2
            continue
        leaf = node - first
        for i in range((count * leaf) >> depth, (count * (leaf + 1)) >> depth):
            if _blocks(i, bodies, flat, frame, face, near, tree, triangle_face, scratch):
                return i
    return -1


@kernel
def _motion(row, patches, nodes, frame, sine, h, turn, flat):  # type: ignore[no-untyped-def]
    """How a contact's cutter turns about its axis as the contact wanders.

    Returns the surface's curvature across the lean and its mixed term, and the turn within the patch, in all (psi) and beside
    what follows from the curvature at the contact.
    """
    if flat:
        return 0.0, 0.0, 0.0, 0.0
    k_tt, k_ft, home = 0.0, 0.0, patches.home[row]
    for k in range(3):
        for m in range(3):
            k_ft += patches.tensor[row, k, m] * frame.f[k] * frame.t[m]
            k_tt += patches.tensor[row, k, m] * frame.t[k] * frame.t[m]
    wobble = nodes.about[nodes.index[home[0], home[1]], 12]
    beside = (2.0 * wobble * h + 0.5 * turn * turn + turn * turn / (sine - turn)) / (sine - turn)
    psi = min(turn / (sine - turn), (abs(k_tt) + abs(k_ft)) * h / sine + beside)
    return k_tt, k_ft, psi, beside


@kernel
def _extent(most, last, full, h, pose, flat, psi, turn, radius, safe, chord, near):  # type: ignore[no-untyped-def]
    """The largest of the distances up to row `last` within which curvature alone keeps surface and cutter apart.

    Returns its row, -1 if there is none. Writes what `near_by` takes.
    """
    sine, cosine = pose
    ff, tt, ft, whole, spread, angle, cell = -np.inf, -np.inf, 0.0, 0.0, 0.0, 0.0, 0.0
    held = -1
    for row in range(last + 1):
        distance = h * distance_of(row)
        ff, tt, ft = max(ff, most[row, 0]), max(tt, most[row, 1]), max(ft, most[row, 2])
        whole, spread, angle = max(whole, most[row, 3]), max(spread, most[row, 4]), max(angle, most[row, 5])
        cell = max(cell, most[row, 6])
        if distance > full:
            break
        # Between nodes and between contacts normals turn some more than from node to node.
        more = 1.05 * whole * (h + cell)
        steep = 1.05 * np.sqrt(angle) + more
        if not steep <= _MOST_TURN:
            break
        tangent = np.tan(steep)
        extra = 1.3 * whole * more * (3.5 * tangent + 2.0 * more)
        if flat:
            top = 0.5 * (ff + tt) + 0.5 * spread + extra
            if not 0.5 * max(0.0, top) * distance * distance <= safe:
                break
            near[2], near[3], near[4] = top, top, 0.0
        else:
            extra += 1.05 * spread * (psi + turn * turn)
            if not held_below(sine, cosine, turn, ff + extra, ft, tt + extra, distance, radius):
                break
            near[2], near[3], near[4] = ff + extra, tt + extra, ft
        near[0], near[1] = distance - h - chord, 0.6 * whole * distance * distance + chord
        held = row
    near[5] = chord + 1e-9
    return held


@kernel
def _halvings(most, h, pose, flat, radius, safe, chord, near):  # type: ignore[no-untyped-def]
    """How often a patch must be halved until curvature holds right at its contact, as far as the nodes about it now tell."""
    halved = h
    for count in range(1, MOST_HALVINGS):
        halved *= 0.5
        turn = 1.05 * most[0, 3] * halved
        steep = not flat and (pose[0] <= 2.0 * turn or pose[1] <= 2.0 * turn)
        if turn <= 0.2 and not steep:
            psi = 0.0 if flat else turn / (pose[0] - turn)
            if _extent(most, 0, np.inf, halved, pose, flat, psi, turn, radius, safe, chord, near) == 0:
                return count
    return MOST_HALVINGS


@kernel
def _outlook(row, patches, nodes, face, lengths, tree, triangle_face, blocker, room):  # type: ignore[no-untyped-def]
    """What `cover` writes for a contact, and the triangle in the way, -1 if there is none; `blocker` is looked at first."""
    radius, length, safe, chord = lengths
    f, t, body, near = room.f, room.t, room.body, room.near
    p, n, a = patches.point[row], patches.normal[row], patches.axis[row]
    h, flat, home = patches.patch[row], patches.flat[row], patches.home[row]
    if not h > 0.0:
        return 1, -1
    cosine = hit.dot(a, n)
    for k in range(3):
        f[k] = a[k] - cosine * n[k]
    sine = np.sqrt(hit.dot(f, f))
    if flat or sine < 1e-6:
        sine, cosine = 0.0, 1.0
        hit.perpendicular(n, f)
    else:
        for k in range(3):
            f[k] /= sine
    hit.cross(n, f, t)
    frame, pose, most = Frame(p, n, f, t), (sine, cosine), room.seen.most
    if not begin(frame, h, home, nodes, room.seen):
        return NEVER, -1
    # In the smallest patch there remain the home node's own curvature and what it may differ in its cell.
    if not flat and not held_below(sine, cosine, 0.0, most[0, 0], most[0, 2], most[0, 1], 0.0, radius):
        return NEVER, -1
    full, turn, lift, k_tt, k_ft, psi, beside = np.inf, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    # Bounds do not get smaller with distance: what does not hold nearby needs no look farther out.
    for last in (0, _HALF_WAY, EXTENTS - 1):
        if full == np.inf:
            full = look_round(frame, h, home, nodes, room.seen, h * distance_of(last))
        if full < 0.0:
            return 1, -1
        # How far the normal turns within the patch, and how far the surface leaves the tangent plane.
        turn, lift = 1.05 * most[0, 3] * h, 0.55 * most[0, 3] * h * h
        if not turn <= 0.2 or (not flat and (sine <= 2.0 * turn or cosine <= 2.0 * turn)):
            return _halvings(most, h, pose, flat, radius, safe, chord, near), -1
        k_tt, k_ft, psi, beside = _motion(row, patches, nodes, frame, sine, h, turn, flat)
        held = _extent(most, last, full, h, pose, flat, psi, turn, radius, safe, chord, near)
        if held < 0:
            return _halvings(most, h, pose, flat, radius, safe, chord, near), -1
        if held < last:
            break
    if not near[0] > 0.0:
        return NEVER, -1
    for k in range(3):
        body[P + k] = p[k]
        body[A + k] = a[k]
        body[X + k] = cosine * f[k] - sine * n[k]
        body[Y + k] = t[k]
    if flat:
        body[OFFSET], body[RADIUS], body[HALF] = 0.0, 2.0 * radius + h - safe, 0.0
        body[LOW], body[HIGH] = safe - lift, length - safe + lift
        _pieces(body, frame, 0.0, pose, (0.0, 0.0, 0.0), room.bodies, 1)
    else:
        grow = 0.5 * radius * psi * psi + lift
        body[OFFSET], body[RADIUS], body[HALF] = radius, radius - safe + grow, 0.0
        body[LOW], body[HIGH] = safe - grow, length - safe + grow
        slides = (radius * k_ft / sine, abs(1.0 - radius * k_tt / sine), radius * beside)
        _pieces(body, frame, h, pose, slides, room.bodies, 18)
    found = _first(blocker, room.bodies, flat, frame, face, near, tree, triangle_face, room.scratch)
    return 0 if found < 0 else 1, found


@entry
def cover(  # type: ignore[no-untyped-def]
    rows, patches, nodes, face, radius, length, safe, chord, tree, triangle_face, outlook
):
    """Decide for contacts on one face whether their axis serves every contact within a patch about them.

    Parameters
    ----------
    rows : (m,) int64
    patches : Patches
    nodes : Nodes
    face : int
        Number of the face.
    radius, length, safe, chord : float
        Cutter, the depth up to which a triangle does not matter, and the chord error, mm.
    tree : Tree
    triangle_face : (t,) int32
        Face numbers of its triangles.
    outlook : (n,) uint8, written
        0: it does. 1 to MOST_HALVINGS: not known; how often the patch must be halved until it may, a guess that tells what to
        try first. NEVER: it serves no smaller patch, either, as far as the nodes tell of the surface.
    """
    room = _Room(np.empty(3), np.empty(3), np.empty(BODY), np.empty((_BODIES, BODY)), np.empty(6), seen(),
                 hit.scratch())  # fmt: skip
    lengths, blocker = (radius, length, safe, chord), -1
    for row in rows:
        outlook[row], found = _outlook(row, patches, nodes, face, lengths, tree, triangle_face, blocker, room)
        # What was in the way of one contact is likely in the way of the next.
        if found >= 0:
            blocker = found
