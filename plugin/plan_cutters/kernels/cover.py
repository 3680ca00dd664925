"""Does the posture of a sample, its axis kept, also serve the surface around it? The argument is in `docs/between_samples.md`.

Obstacles are shared out by distance from the contact. Within `reach` of it the surface that the contact lies on is
held below a paraboloid by its curvature and a bound on the change of curvature, and the cutter above it: nothing to
test. Everything else is tested against the cutter moved along with the contact: a stadium instead of a disk across
the axis, for the directions in which the contact wanders and the cutter turns about its axis.
"""

import numpy as np

from plan_cutters.kernels import hit
from plan_cutters.kernels.hit import BODY, HALF, HIGH, LOW, OFFSET, RADIUS, A, P, X, Y
from plan_cutters.kernels.jit import entry, kernel

#: Largest angle (rad) between normals within `reach`: up to it, the surface is a graph over its tangent planes.
_MOST_TURN = 0.5
#: Distances tried for `reach`, and the largest of them in patch radii.
_REACHES, REACH = 17, 10.0
#: Rings of grid nodes looked at around a contact.
_RINGS = 40
#: Steps along the lean that the patch is cut into: finer ones where fewer do not do.
_STEPS = (2, 6, 18)


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
def _near(vertex, triangle_face, i, p, n, f, t, face, near):  # type: ignore[no-untyped-def]
    """Whether triangle i is part of the surface that the contact lies on, and bent no more than was believed.

    `near` holds the distance up to which, the largest height over the tangent plane, the bounds of curvature along f,
    along t and mixed, and the chord error.
    """
    if triangle_face[i] != face:
        return False
    for corner in range(3):
        dx, dy, dz = vertex[i, corner, 0] - p[0], vertex[i, corner, 1] - p[1], vertex[i, corner, 2] - p[2]
        height = dx * n[0] + dy * n[1] + dz * n[2]
        if not (dx * dx + dy * dy + dz * dz <= near[0] * near[0] and abs(height) <= near[1]):
            return False
        x, y = dx * f[0] + dy * f[1] + dz * f[2], dx * t[0] + dy * t[1] + dz * t[2]
        if not height <= 0.5 * (near[2] * x * x + near[3] * y * y) + near[4] * abs(x * y) + near[5]:
            return False
    v = vertex[i]
    ax, ay, az = v[1, 0] - v[0, 0], v[1, 1] - v[0, 1], v[1, 2] - v[0, 2]
    bx, by, bz = v[2, 0] - v[0, 0], v[2, 1] - v[0, 1], v[2, 2] - v[0, 2]
    x, y, z = ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx
    up = x * n[0] + y * n[1] + z * n[2]
    return up * up >= 0.25 * (x * x + y * y + z * z)


@kernel
def _free_of_far(  # type: ignore[no-untyped-def]
    body, p, n, f, t, face, near, vertex, triangle_face, box, depth, stack, polygon, spare
):  # fmt: skip
    """True if no triangle that is not near reaches into the stadium body."""
    count, first, top = len(vertex), (1 << depth) - 1, 1
    stack[0] = 0
    while top > 0:
        top -= 1
        node = stack[top]
        if hit._box_apart(box, node, body, 0.0):
            continue
        if node < first:
            stack[top] = 2 * node + 2
            stack[top + 1] = 2 * node + 1
            top += 2
            continue
        leaf = node - first
        for i in range((count * leaf) >> depth, (count * (leaf + 1)) >> depth):
            if _stadium_hit(vertex, i, body, polygon, spare) and not _near(
                vertex, triangle_face, i, p, n, f, t, face, near
            ):
                return False
    return True


@kernel
def _held(sine, cosine, turn, k_ff, k_ft, k_tt, reach, radius):  # type: ignore[no-untyped-def]
    """Whether the paraboloid with these curvatures stays below the flat end within `reach` of the contact.

    At every tilt within `turn` of the one given by its sine and cosine.
    """
    least = sine - turn
    margin = least / radius - k_tt
    if margin <= 0.0:
        return False
    for share in (0.5, 0.25, 0.75, 0.1):
        mix = share * margin
        curve = max(0.0, k_ff + k_ft * k_ft / mix)
        left = least - radius * max(0.0, k_tt + mix)
        if left >= 0.5 * curve * reach * (cosine + turn) and cosine - turn >= 0.5 * curve * reach * (sine + turn):
            return True
    return False


@kernel
def _zone(  # type: ignore[no-untyped-def]
    p, n, f, t, h, home, index, closed, node_point, node_normal, node_tensor, node_wobble, node_radius, most
):  # fmt: skip
    """Bounds of curvature over the nodes around a contact, into rows of `most` for growing distances.

    Row k holds, over all nodes whose cells come within distance k of any contact of the patch: the largest normal
    curvature along f and t, the largest mixed term, the largest curvature and spread of curvatures, the largest
    distance between the nodes' normals and n, and the largest radius of a cell. Returns the distance up to which all
    nodes were looked at; -1 if one within the first distance has no curvature, or there is none.
    """
    for k in range(_REACHES):
        most[k, 0], most[k, 1] = -np.inf, -np.inf
        for c in range(2, 7):
            most[k, c] = 0.0
    rows, columns = index.shape
    last = _REACHES - 1
    # Square rings of nodes about the home node, until a whole ring is too far.
    ring, full = 0, np.inf
    while True:
        nearest = np.inf
        for i in range(home[0] - ring, home[0] + ring + 1):
            edge = i == home[0] - ring or i == home[0] + ring
            for j in range(home[1] - ring, home[1] + ring + 1, 1 if edge else max(1, 2 * ring)):
                a, b = i, j
                if closed[0]:
                    a = i % rows
                if closed[1]:
                    b = j % columns
                if a < 0 or a >= rows or b < 0 or b >= columns or index[a, b] < 0:
                    continue
                node = index[a, b]
                square, angle = 0.0, 0.0
                for k in range(3):
                    square += (node_point[node, k] - p[k]) ** 2
                    angle += (node_normal[node, k] - n[k]) ** 2
                distance = np.sqrt(square)
                # The node's cell against a disk about any contact of the patch.
                away = distance - h - node_radius[node] if node_radius[node] >= 0.0 else distance - h
                nearest = min(nearest, away)
                x = (away / h - 2.0) / (REACH - 2.0)
                if x > 1.0:
                    continue
                row = 0 if x <= 0.0 else min(last, int(np.ceil(np.sqrt(x) * last)))
                if np.isnan(node_wobble[node]) or np.isnan(node_radius[node]):
                    if row == 0:
                        return -1.0
                    most[row, 3] = np.inf
                    continue
                # Second derivatives there of the surface as a graph over the tangent plane at the contact: f and t are
                # lifted to the node's own tangent plane.
                upright, lift_f, lift_t = 0.0, 0.0, 0.0
                for k in range(3):
                    upright += node_normal[node, k] * n[k]
                    lift_f -= node_normal[node, k] * f[k]
                    lift_t -= node_normal[node, k] * t[k]
                if upright < 0.5:
                    if row == 0:
                        return -1.0
                    most[row, 3] = np.inf
                    continue
                lift_f /= upright
                lift_t /= upright
                ff, ft, tt, trace, square = 0.0, 0.0, 0.0, 0.0, 0.0
                for k in range(3):
                    trace += node_tensor[node, k, k]
                    for m in range(3):
                        value = node_tensor[node, k, m]
                        ff += value * (f[k] + lift_f * n[k]) * (f[m] + lift_f * n[m])
                        ft += value * (f[k] + lift_f * n[k]) * (t[m] + lift_t * n[m])
                        tt += value * (t[k] + lift_t * n[k]) * (t[m] + lift_t * n[m])
                        square += value * value
                ff, ft, tt = ff / upright, ft / upright, tt / upright
                wobble = node_wobble[node]
                spread = np.sqrt(max(0.0, 2.0 * square - trace * trace))
                most[row, 0] = max(most[row, 0], ff + wobble)
                most[row, 1] = max(most[row, 1], tt + wobble)
                most[row, 2] = max(most[row, 2], abs(ft))
                most[row, 3] = max(most[row, 3], 0.5 * (abs(trace) + spread) + wobble)
                most[row, 4] = max(most[row, 4], spread + 2.0 * wobble)
                most[row, 5] = max(most[row, 5], np.sqrt(angle))
                most[row, 6] = max(most[row, 6], node_radius[node])
        ring += 1
        if nearest > REACH * h:
            break
        if ring > _RINGS:
            full = nearest
            break
    for k in range(1, _REACHES):
        for c in range(7):
            most[k, c] = max(most[k, c], most[k - 1, c])
    return full if most[0, 6] > 0.0 else -1.0


@entry
def cover(  # type: ignore[no-untyped-def]
    rows, point, normal, tensor, axis, free, patch, home, index, closed,
    node_point, node_normal, node_tensor, node_wobble, node_radius, face,
    radius, length, safe, chord, vertex, triangle_face, box, depth, covered,
):  # fmt: skip
    """Decide for contacts on one face whether their axis serves every contact within a patch about them.

    Parameters
    ----------
    rows : (m,) int64
    point, normal, axis : (n, 3) float64
    tensor : (n, 3, 3) float64
        Second fundamental form in part coordinates, 1/mm, concave positive.
    free : (n,) bool
        Interference-free: the axis is the normal, and any lean counts.
    patch : (n,) float64
        Radius about each contact, mm; nan: not decided.
    home : (n, 2) int32
        The grid node in whose cell the contact lies.
    index : (nu, nv) int32
        The face's grid: rows of the node arrays, -1 outside the trim.
    closed : (2,) bool
    node_point, node_normal : (k, 3) float64
    node_tensor : (k, 3, 3) float64
    node_wobble : (k,) float64
        How far the tensor may differ in the node's cell, 1/mm; nan where it is not known.
    node_radius : (k,) float64
        Of the node's cell, mm; nan where it is not known.
    face : int
        Number of the face.
    radius, length, safe, chord : float
        Cutter, the depth up to which a triangle does not matter, and the chord error, mm.
    vertex, triangle_face, box, depth
        Triangles in tree order, their faces, and the tree.
    covered : (n,) bool, written
    """
    body, f, t = np.empty(BODY), np.empty(3), np.empty(3)
    stack = np.empty(64, np.int64)
    polygon, spare = np.empty((8, 3)), np.empty((8, 3))
    most, near = np.empty((_REACHES, 7)), np.empty(6)
    for row in rows:
        covered[row] = False
        p, n, a, h, flat = point[row], normal[row], axis[row], patch[row], free[row]
        if not h > 0.0:
            continue
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
        full = _zone(p, n, f, t, h, home[row], index, closed, node_point, node_normal, node_tensor, node_wobble,
                     node_radius, most)  # fmt: skip
        if full < 0.0:
            continue
        # How far the normal turns within the patch, and how far the surface leaves the tangent plane.
        turn, lift = 1.05 * most[0, 3] * h, 0.55 * most[0, 3] * h * h
        if not turn <= 0.2 or (not flat and (sine <= 2.0 * turn or cosine <= 2.0 * turn)):
            continue
        # How far the cutter turns about its axis within the patch, in all and beside what follows from the curvature
        # at the contact.
        psi, k_tt, k_ft, beside = 0.0, 0.0, 0.0, 0.0
        if not flat:
            for k in range(3):
                for m in range(3):
                    k_ft += tensor[row, k, m] * f[k] * t[m]
                    k_tt += tensor[row, k, m] * t[k] * t[m]
            wobble = node_wobble[index[home[row, 0], home[row, 1]]]
            beside = (2.0 * wobble * h + 0.5 * turn * turn + turn * turn / (sine - turn)) / (sine - turn)
            psi = min(turn / (sine - turn), (abs(k_tt) + abs(k_ft)) * h / sine + beside)
        # The largest distance up to which curvature alone keeps surface and cutter apart.
        reach = 0.0
        for step in range(_REACHES):
            distance = h * (2.0 + (REACH - 2.0) * (step / (_REACHES - 1)) ** 2)
            whole = most[step, 3]
            if distance > full:
                break
            # Between nodes and between contacts normals turn some more than from node to node.
            more = 1.05 * whole * (h + most[step, 6])
            steep = 1.05 * most[step, 5] + more
            if not steep <= _MOST_TURN:
                break
            tangent = np.tan(steep)
            extra = 1.3 * whole * more * (3.5 * tangent + 2.0 * more)
            if flat:
                top = 0.5 * (most[step, 0] + most[step, 1]) + 0.5 * most[step, 4] + extra
                if not 0.5 * max(0.0, top) * distance * distance <= safe:
                    break
                near[2], near[3], near[4] = top, top, 0.0
            else:
                extra += 1.05 * most[step, 4] * (psi + turn * turn)
                if not _held(sine, cosine, turn, most[step, 0] + extra, most[step, 2], most[step, 1] + extra,
                             distance, radius):  # fmt: skip
                    break
                near[2], near[3], near[4] = most[step, 0] + extra, most[step, 1] + extra, most[step, 2]
            reach = distance
            near[1] = 0.6 * whole * distance * distance + chord
        near[0], near[5] = reach - h - chord, chord + 1e-9
        if not near[0] > 0.0:
            continue
        for k in range(3):
            body[A + k] = a[k]
            body[X + k] = cosine * f[k] - sine * n[k]
            body[Y + k] = t[k]
        if flat:
            for k in range(3):
                body[P + k] = p[k]
            body[OFFSET], body[RADIUS], body[HALF] = 0.0, 2.0 * radius + h - safe, 0.0
            body[LOW], body[HIGH] = safe - lift, length - safe + lift
            covered[row] = _free_of_far(body, p, n, f, t, face, near, vertex, triangle_face, box, depth, stack,
                                        polygon, spare)  # fmt: skip
            continue
        grow = 0.5 * radius * psi * psi + lift
        slide = radius * k_ft / sine
        for steps in _STEPS:
            wide = h / steps
            body[HALF] = h * abs(1.0 - radius * k_tt / sine) + wide * abs(slide) + radius * beside
            good = True
            for step in range(steps):
                shift = (2 * step + 1 - steps) * wide
                for k in range(3):
                    body[P + k] = p[k] + shift * (f[k] - slide * t[k])
                body[OFFSET] = radius
                body[RADIUS] = radius - safe + grow + wide * cosine
                body[LOW] = safe - grow - wide * sine
                body[HIGH] = length - safe + grow + wide * sine
                if not _free_of_far(body, p, n, f, t, face, near, vertex, triangle_face, box, depth, stack,
                                    polygon, spare):  # fmt: skip
                    good = False
                    break
            if good:
                covered[row] = True
                break
