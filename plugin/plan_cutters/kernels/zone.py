"""How the surface around a contact is held below a paraboloid: bounds of curvature over the nodes of its face's grid."""

from typing import Any, NamedTuple

import numpy as np

from plan_cutters.kernels.jit import kernel

#: Distances tried for `extent`, and the largest of them in patch radii.
_EXTENTS, FARTHEST = 17, 10.0
#: Rings of grid nodes looked at around a contact.
_RINGS = 40


class Nodes(NamedTuple):
    """A face's grid: index (nu, nv) int32 into the rows of the other arrays, -1 outside the trim; closed (2,) bool.

    point, normal (k, 3), tensor (k, 3, 3). wobble (k,): how far the tensor may differ in the node's cell, 1/mm; radius (k,) of
    that cell, mm; nan where these are not known.
    """

    index: Any
    closed: Any
    point: Any
    normal: Any
    tensor: Any
    wobble: Any
    radius: Any


@kernel
def _near(vertex, triangle_face, i, frame, face, near):  # type: ignore[no-untyped-def]
    """Whether triangle i is part of the surface that the contact lies on, and bent no more than was believed.

    `near` holds the distance up to which, the largest height over the tangent plane, the bounds of curvature along f,
    along t and mixed, and the chord error.
    """
    p, n, f, t = frame
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
def _held(sine, cosine, turn, k_ff, k_ft, k_tt, extent, radius):  # type: ignore[no-untyped-def]
    """Whether the paraboloid with these curvatures stays below the flat end within `extent` of the contact.

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
        if left >= 0.5 * curve * extent * (cosine + turn) and cosine - turn >= 0.5 * curve * extent * (sine + turn):
            return True
    return False


@kernel
def _zone(frame, h, home, nodes, most):  # type: ignore[no-untyped-def]
    """Bounds of curvature over the nodes around a contact, into rows of `most` for growing distances.

    Row k holds, over all nodes whose cells come within distance k of any contact of the patch: the largest normal
    curvature along f and t, the largest mixed term, the largest curvature and spread of curvatures, the largest
    distance between the nodes' normals and n, and the largest radius of a cell. Returns the distance up to which all
    nodes were looked at; -1 if one within the first distance has no curvature, or there is none.
    """
    p, n, f, t = frame
    index, closed = nodes.index, nodes.closed
    for k in range(_EXTENTS):
        most[k, 0], most[k, 1] = -np.inf, -np.inf
        for c in range(2, 7):
            most[k, c] = 0.0
    rows, columns = index.shape
    last = _EXTENTS - 1
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
                    square += (nodes.point[node, k] - p[k]) ** 2
                    angle += (nodes.normal[node, k] - n[k]) ** 2
                distance = np.sqrt(square)
                # The node's cell against a disk about any contact of the patch.
                away = distance - h - nodes.radius[node] if nodes.radius[node] >= 0.0 else distance - h
                nearest = min(nearest, away)
                x = (away / h - 2.0) / (FARTHEST - 2.0)
                if x > 1.0:
                    continue
                row = 0 if x <= 0.0 else min(last, int(np.ceil(np.sqrt(x) * last)))
                if np.isnan(nodes.wobble[node]) or np.isnan(nodes.radius[node]):
                    if row == 0:
                        return -1.0
                    most[row, 3] = np.inf
                    continue
                # Second derivatives there of the surface as a graph over the tangent plane at the contact: f and t are
                # lifted to the node's own tangent plane.
                upright, lift_f, lift_t = 0.0, 0.0, 0.0
                for k in range(3):
                    upright += nodes.normal[node, k] * n[k]
                    lift_f -= nodes.normal[node, k] * f[k]
                    lift_t -= nodes.normal[node, k] * t[k]
                if upright < 0.5:
                    if row == 0:
                        return -1.0
                    most[row, 3] = np.inf
                    continue
                lift_f /= upright
                lift_t /= upright
                ff, ft, tt, trace, square = 0.0, 0.0, 0.0, 0.0, 0.0
                for k in range(3):
                    trace += nodes.tensor[node, k, k]
                    for m in range(3):
                        value = nodes.tensor[node, k, m]
                        ff += value * (f[k] + lift_f * n[k]) * (f[m] + lift_f * n[m])
                        ft += value * (f[k] + lift_f * n[k]) * (t[m] + lift_t * n[m])
                        tt += value * (t[k] + lift_t * n[k]) * (t[m] + lift_t * n[m])
                        square += value * value
                ff, ft, tt = ff / upright, ft / upright, tt / upright
                wobble = nodes.wobble[node]
                spread = np.sqrt(max(0.0, 2.0 * square - trace * trace))
                most[row, 0] = max(most[row, 0], ff + wobble)
                most[row, 1] = max(most[row, 1], tt + wobble)
                most[row, 2] = max(most[row, 2], abs(ft))
                most[row, 3] = max(most[row, 3], 0.5 * (abs(trace) + spread) + wobble)
                most[row, 4] = max(most[row, 4], spread + 2.0 * wobble)
                most[row, 5] = max(most[row, 5], np.sqrt(angle))
                most[row, 6] = max(most[row, 6], nodes.radius[node])
        ring += 1
        if nearest > FARTHEST * h:
            break
        if ring > _RINGS:
            full = nearest
            break
    for k in range(1, _EXTENTS):
        for c in range(7):
            most[k, c] = max(most[k, c], most[k - 1, c])
    return full if most[0, 6] > 0.0 else -1.0
