"""Slow and obvious twins of the kernels. They share no code with them."""

import numpy as np


def depth_in_cutter(points, contact, normal, axis, tilt_direction, radius, length):
    """How deep points lie in a flat-end cutter: distance to its nearest side, positive inside.

    The cutter touches `contact` with its bottom edge; its bottom centre lies on the other side of the lean.
    """
    x_t = (axis @ normal) * tilt_direction - (axis @ tilt_direction) * normal
    offset = np.asarray(points) - (contact - radius * x_t)
    height = offset @ axis
    radial = np.linalg.norm(offset - height[..., None] * axis, axis=-1)
    return np.minimum(np.minimum(height, length - height), radius - radial)


def posture(normal, direction_max, tilt, rotation):
    """Tool axis and tilt direction of a posture."""
    e2 = np.cross(normal, direction_max)
    tilt_direction = np.cos(rotation) * direction_max + np.sin(rotation) * e2
    return np.cos(tilt) * normal + np.sin(tilt) * tilt_direction, tilt_direction


def triangle_points(triangle, n):
    """Points of a triangle on a barycentric grid, corners and sides included."""
    i, j = np.meshgrid(np.arange(n + 1), np.arange(n + 1), indexing="ij")
    keep = i + j <= n
    a, b = i[keep] / n, j[keep] / n
    return a[:, None] * triangle[0] + b[:, None] * triangle[1] + (1 - a - b)[:, None] * triangle[2]


def random_frame(rng):
    """Orthonormal normal and direction."""
    q, _ = np.linalg.qr(rng.standard_normal((3, 3)))
    return q[0].copy(), q[1].copy()


def depth_while_tilting(point, tilts, radius, length):
    """How deep a point (along lean, lean's left and normal, from the contact) lies in the cutter at each tilt."""
    along, left, up = point
    tilts = np.asarray(tilts)
    axis = np.stack([np.sin(tilts), 0 * tilts, np.cos(tilts)], -1)
    centre = -radius * np.stack([np.cos(tilts), 0 * tilts, -np.sin(tilts)], -1)
    offset = np.array([along, left, up]) - centre
    height = (offset * axis).sum(-1)
    radial = np.linalg.norm(offset - height[:, None] * axis, axis=-1)
    return np.minimum(np.minimum(height, length - height), radius - radial)


def _best(function, steps=45):
    """Largest value of a concave function on [0, 1], by golden section: (value, place)."""
    share = (5**0.5 - 1) / 2
    low, high = 0.0, 1.0
    a, b = high - share, low + share
    at_a, at_b = function(a), function(b)
    best = max((function(0.0), 0.0), (function(1.0), 1.0), (at_a, a), (at_b, b))
    for _ in range(steps):
        if at_a < at_b:
            low, a, at_a = a, b, at_b
            b = low + share * (high - low)
            at_b = function(b)
            best = max(best, (at_b, b))
        else:
            high, b, at_b = b, a, at_a
            a = high - share * (high - low)
            at_a = function(a)
            best = max(best, (at_a, a))
    return best


def deepest_in_cylinder(triangle, radius, low, high):
    """Depth of the deepest point of a triangle in a cylinder about the z axis, negative outside.

    Depth is the least of linear functions and of minus a distance, so concave: two searches, one within the other.
    """
    (ax, ay, az), (bx, by, bz), (cx, cy, cz) = np.asarray(triangle).tolist()

    def depth(w, s):
        a, b = (1 - w) * (1 - s), (1 - w) * s
        x, y, z = a * ax + b * bx + w * cx, a * ay + b * by + w * cy, a * az + b * bz + w * cz
        return min(z - low, high - z, radius - (x * x + y * y) ** 0.5)

    return _best(lambda w: _best(lambda s: depth(w, s))[0])[0]


def distance_to_triangle(point, triangle):
    """How far a point lies from a triangle, one without area included."""
    distances = []
    for i in range(3):
        edge, to = triangle[(i + 1) % 3] - triangle[i], point - triangle[i]
        along = np.clip((edge @ to) / max(edge @ edge, 1e-300), 0, 1)
        distances.append(np.linalg.norm(to - along * edge))
    edges = np.stack([triangle[1] - triangle[0], triangle[2] - triangle[0]], 1)
    shares = np.linalg.lstsq(edges, point - triangle[0], rcond=1e-14)[0]
    if shares.min() >= 0 and shares.sum() <= 1:
        distances.append(np.linalg.norm(edges @ shares - (point - triangle[0])))
    return min(distances)


def curvature(derivatives, sign, size, parallel, umbilic):
    """Normals, curvatures and directions of all points at once: the formulas of `cad_io.face.curvature` without the compiler."""
    su, sv = derivatives[:, 1], derivatives[:, 2]
    with np.errstate(all="ignore"):
        cross = np.cross(su, sv)
        area = np.linalg.norm(cross, axis=1)
        length_u, length_v = np.linalg.norm(su, axis=1), np.linalg.norm(sv, axis=1)
        bad = ~(np.isfinite(derivatives).all(axis=(1, 2)) & (area > parallel * length_u * length_v) & (area > 1e-200))
        geometric = cross / area[:, None]
        normal = sign * geometric
        a = su / length_u[:, None]
        b = np.cross(geometric, a)
        # S(u, v) in arc lengths along a and b: d/da = (1/|Su|) d/du, d/db = (d/dv - (Sv.a) d/da) / (Sv.b).
        skew, height = (sv * a).sum(axis=1), (sv * b).sum(axis=1)
        uu, vv, uv = ((derivatives[:, k] * normal).sum(axis=1) for k in (3, 4, 5))
        aa = uu / length_u**2
        ab = (uv / length_u - skew * aa) / height
        bb = (vv - 2 * skew * uv / length_u + skew**2 * aa) / height**2
        mean, half = 0.5 * (aa + bb), 0.5 * (aa - bb)
        radius = np.hypot(half, ab)
        # The eigenvalue farther from zero is a sum of equal signs; the other follows from the determinant.
        far = mean + np.where(mean >= 0, radius, -radius)
        other = (aa * bb - ab * ab) / np.where(far == 0, 1.0, far)
        top, low = np.maximum(far, other), np.minimum(far, other)
        # Eigenvector of the larger eigenvalue at half the angle of (half, ab), which is undefined at an umbilic only.
        angle = 0.5 * np.arctan2(ab, half)
        umbilic = top - low <= umbilic * np.maximum(np.maximum(np.abs(top), np.abs(low)), 1.0 / size)
        angle = np.where(umbilic, 0.0, angle)
        direction = np.cos(angle)[:, None] * a + np.sin(angle)[:, None] * b
        direction /= np.linalg.norm(direction, axis=1)[:, None]
    result = np.stack([top, low], axis=1)
    bad |= ~np.isfinite(result).all(axis=1)
    normal[bad] = result[bad] = direction[bad] = np.nan
    return normal, result, direction, bad
