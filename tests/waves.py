"""A surface of waves by formula alone: an input for the kernels that no other program has a part in."""

import numpy as np

from plan_cutters.kernels import tree
from plan_cutters.kernels.rows import Contacts, Ranges, Tree

SIZE, WAVES, HEIGHT = 40.0, (0.27, 0.23), 6.0


def samples(n):
    """n x n contacts.

    Nothing is alike in x and y, nor from one line to the next: ties would be decided by the last digit of a machine.
    """
    u, v = (c.ravel() for c in np.meshgrid(*[np.linspace(0, 1, n)] * 2, indexing="ij"))
    x, y = SIZE * (u * (0.9 + 0.1 * u) + 0.031 * v * v), SIZE * (v * (1.07 - 0.07 * v) - 0.023 * u)
    (k, l), a, b = WAVES, WAVES[0] * x + 0.3, WAVES[1] * y + 0.1
    z = HEIGHT * np.sin(a) * np.cos(b)
    zx, zy = HEIGHT * k * np.cos(a) * np.cos(b), -HEIGHT * l * np.sin(a) * np.sin(b)
    zxx, zyy, zxy = -k * k * z, -l * l * z, -HEIGHT * k * l * np.cos(a) * np.sin(b)
    size = np.sqrt(1 + zx * zx + zy * zy)
    normal = np.stack([-zx, -zy, np.ones_like(zx)], 1) / size[:, None]
    curvature, direction = np.empty((n * n, 2)), np.empty((n * n, 3))
    for i in range(n * n):
        tangents = np.array([[1, 0, zx[i]], [0, 1, zy[i]]])
        shape = np.linalg.solve(tangents @ tangents.T, np.array([[zxx[i], zxy[i]], [zxy[i], zyy[i]]]) / size[i])
        values, vectors = np.linalg.eig(shape)
        order = np.argsort(-values.real)
        curvature[i] = values.real[order]
        along = vectors.real[:, order[0]] @ tangents
        direction[i] = along / np.linalg.norm(along)
    return Contacts(np.stack([x, y, z], 1), normal, direction, curvature)


def triangles(n):
    """The surface as 2 (n - 1)^2 triangles, (m, 3, 3)."""
    point = samples(n).point.reshape(n, n, 3)
    a, b, c, d = point[:-1, :-1], point[1:, :-1], point[1:, 1:], point[:-1, 1:]
    return np.ascontiguousarray(np.stack([np.stack([a, b, c], 2), np.stack([a, c, d], 2)], 2).reshape(-1, 3, 3))


def tree_of(vertex):
    """Triangles (n, 3, 3) as a tree."""
    order, box, depth = tree.build(np.ascontiguousarray(vertex))
    return Tree(np.ascontiguousarray(vertex[order]), box, depth)


def ranges(rotations, limit_cos=-2.0, tilt=(0.0, np.pi / 2)):
    """Postures at rotations (k,), rad, with an axis limit about z."""
    return Ranges(np.cos(rotations), np.sin(rotations), *tilt, np.array([0, 0, 1.0]), limit_cos)
