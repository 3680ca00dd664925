"""A surface of waves by formula alone: an input for the kernels that no other program has a part in."""

import numpy as np
from scipy.spatial import ConvexHull

from plan_cutters import Cutter
from plan_cutters.domain.assembly import assembly
from plan_cutters.kernels.linear import tree
from plan_cutters.kernels.linear import tree as lanes
from plan_cutters.kernels.maps import free_map
from plan_cutters.kernels.rows import Contacts, Cylinder, Ranges, Tree
from plan_cutters.scene.conditions import rotary_of, tool_of

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


def hull_of(points, *, inside_out):
    """A body without a dent: its triangles (m, 3, 3), how each counts (m,), and the planes (m, 4) of its faces."""
    hull = ConvexHull(points)
    corner = hull.points[hull.simplices]
    normal = np.cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0])
    outward = np.einsum("ij,ij->i", normal, hull.equations[:, :3]) > 0
    turn = outward if inside_out else ~outward
    corner[turn] = corner[turn][:, ::-1]
    return corner, np.full(len(corner), -1 if inside_out else 1, np.int8), hull.equations


def tree_of(vertex):
    """Triangles (n, 3, 3) as a tree."""
    order, box, depth = tree.build(np.ascontiguousarray(vertex))
    return Tree(np.ascontiguousarray(vertex[order]), box, depth)


def mapped(rows, contacts, ranges, tool, built, most=8):
    """Posture maps of contacts `rows` to 0.1 deg, `most` intervals a rotation: (intervals, how many, undecided)."""
    shape = len(rows), len(ranges.rotation_cos)
    part, count, unsure = np.zeros((*shape, most, 2)), np.zeros(shape, np.int32), np.zeros(shape)
    wide = lanes.WideTree(*lanes.wide_tree(built))
    free_map.free_map(rows, contacts, ranges, tool, np.radians(0.1), built, wide, most, part, count, unsure)
    return part, count, unsure


def ranges(rotations, limit_cos=-2.0, tilt=(0.0, np.pi / 2)):
    """Postures at rotations (k,), rad, with an axis limit about z."""
    return Ranges(np.cos(rotations), np.sin(rotations), *tilt, np.array([0, 0, 1.0]), limit_cos, rotary_of(None))


def flat(radius, length, depth):
    """A flat end without stages, smaller by a depth all round."""
    return tool_of(assembly(Cutter.flat(radius=radius, length=length), depth, depth))


def cylinder(radius, length, depth):
    """The same as the eight sides of posture maps take it."""
    piece = flat(radius, length, depth).piece[0]
    return Cylinder(radius, piece[0, 3], piece[0, 1], piece[0, 2])


#: Walls of the comb: how many, how far apart, how thick at the bottom and how much less at the top, how high, how long; mm.
WALLS, PITCH, THICK, TAPER, HIGH, LONG = 4, 4.0, 1.4, 0.8, 14.0, 24.0


def _wall(u, v, k, side):
    """Points of one side of bent wall k at shares u of its length and v of its height, their slopes along x and z."""
    x, z = LONG * (u - 0.5), HIGH * v
    along, up = 0.008 * x + 0.0651 * np.cos(0.21 * x + 0.1), np.full_like(x, 0.05 - 0.5 * side * TAPER / HIGH)
    y = PITCH * k + 0.004 * x**2 + 0.31 * np.sin(0.21 * x + 0.1) + 0.5 * side * THICK + up * z
    return np.stack([x, y, z], -1), along, up


def comb_samples(n):
    """2 n * n contacts on both sides of a wall in the middle of a comb of bent walls, from the bottom up."""
    u, v = (c.ravel() for c in np.meshgrid(np.linspace(0.07, 0.95, n), np.linspace(0.21, 0.97, n), indexing="ij"))
    found = []
    for side in (-1.0, 1.0):
        point, along, up = _wall(u, v, 1, side)
        size = np.sqrt(1 + along**2 + up**2)
        normal = side * np.stack([-along, np.ones_like(up), -up], -1) / size[:, None]
        # Ruled along its height: the one curvature that is not zero is across that.
        straight = np.stack([np.zeros_like(up), up, np.ones_like(up)], -1) / np.sqrt(1 + up**2)[:, None]
        bend = side * (0.008 - 0.013671 * np.sin(0.21 * point[:, 0] + 0.1)) * (1 + up**2) / size**3
        direction = np.where(bend[:, None] > 0, np.cross(straight, normal), straight)
        found.append((point, normal, direction, np.stack([np.maximum(bend, 0.0), np.minimum(bend, 0.0)], 1)))
    return Contacts(*(np.ascontiguousarray(np.concatenate(each)) for each in zip(*found, strict=True)))


def comb_triangles(n):
    """Walls and floor of the comb, (m, 3, 3)."""
    found = []
    u, v = np.meshgrid(np.linspace(0, 1, n), np.linspace(0, 1, n), indexing="ij")
    grids = [_wall(u, v, k, side)[0] for k in range(WALLS) for side in (-1.0, 1.0)]
    grids.append(np.stack([LONG * (u - 0.5), PITCH * WALLS * v - PITCH, np.zeros_like(u)], -1))
    for p in grids:
        a, b, c, d = p[:-1, :-1], p[1:, :-1], p[1:, 1:], p[:-1, 1:]
        found.append(np.stack([np.stack([a, b, c], 2), np.stack([a, c, d], 2)], 2).reshape(-1, 3, 3))
    return np.ascontiguousarray(np.concatenate(found))
