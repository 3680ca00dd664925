"""Slow and obvious twins of the kernels. They share no code with them."""

import numpy as np


def depth_in_cutter(points, contact, normal, axis, lean, radius, length):
    """How deep points lie in a flat-end cutter: distance to its nearest side, positive inside.

    The cutter touches `contact` with its bottom edge; its bottom centre lies on the other side of the lean.
    """
    x_t = (axis @ normal) * lean - (axis @ lean) * normal
    offset = np.asarray(points) - (contact - radius * x_t)
    height = offset @ axis
    radial = np.linalg.norm(offset - height[..., None] * axis, axis=-1)
    return np.minimum(np.minimum(height, length - height), radius - radial)


def posture(normal, direction_max, tilt, rotation):
    """Tool axis and lean direction of a posture."""
    e2 = np.cross(normal, direction_max)
    lean = np.cos(rotation) * direction_max + np.sin(rotation) * e2
    return np.cos(tilt) * normal + np.sin(tilt) * lean, lean


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
