"""Skins of bodies: the cells that they pass through, what lies within them, and how far they are away.

The reference is bodies without a dent, which are known by the planes of their faces.
"""

import numpy as np
import pytest

from plan_cutters.kernels.linear import tree
from plan_cutters.kernels.linear.within import mark_shell
from plan_cutters.kernels.material import Solids, far_inside, moments, near_shell, windings
from plan_cutters.kernels.rows import Tree
from tests.support.distances import closest
from tests.support.waves import hull_of


def bodies(rng, count, corners):
    """Bodies without a dent, of which every second one is inside out: triangles, how each counts, and a test of points."""
    vertex, weight, hulls = [], [], []
    for i in range(count):
        each = hull_of(rng.normal(0, 3, 3) + rng.normal(0, 3, (corners, 3)), inside_out=i % 2 == 1)
        for many, one in zip((vertex, weight, hulls), each, strict=True):
            many.append(one)

    def beyond(points):
        """How far points (n, 3) are beyond the planes of each body (count, n), mm; negative within."""
        return np.array([(points @ each[:, :3].T + each[:, 3]).max(axis=1) for each in hulls])

    return np.concatenate(vertex), np.concatenate(weight), beyond


def solids_of(vertex, weight):
    """As obstacles without a cell that is known to be outside."""
    order, box, depth = tree.build(np.ascontiguousarray(vertex))
    vertex, weight = np.ascontiguousarray(vertex[order]), weight[order]
    low, high = vertex.min(axis=(0, 1)) - 20.0, vertex.max(axis=(0, 1)) + 20.0
    cell = np.zeros((1, 1, 1), np.uint8)
    return Solids(Tree(vertex, box, depth), weight, moments(vertex, weight, depth), cell, low, float((high - low).max()), True,
                  np.array([low, high]), 0.0, 0)  # fmt: skip


@pytest.mark.parametrize(("count", "corners"), [(1, 4), (2, 12), (3, 200)])
def test_a_point_lies_in_as_many_bodies_as_go_round_it(count, corners):
    rng = np.random.default_rng(corners)
    vertex, weight, beyond = bodies(rng, count, corners)
    points = rng.normal(0, 6, (3000, 3))
    points[:1000] = vertex.mean(axis=1)[rng.integers(0, len(vertex), 1000)] + rng.normal(0, 0.1, (1000, 3))
    far = beyond(points)
    points, far = points[(np.abs(far) > 1e-9).all(axis=0)], far[:, (np.abs(far) > 1e-9).all(axis=0)]
    solids, found = solids_of(vertex, weight), np.empty(len(points))
    windings(points, solids, found)
    assert found == pytest.approx((far < 0).sum(axis=0), abs=0.05)
    # What counts for nothing encloses nothing.
    windings(points, solids_of(vertex, np.zeros_like(weight)), found)
    assert (found == 0).all()


def test_skins_are_as_far_away_as_their_nearest_triangle():
    rng = np.random.default_rng(8)
    vertex, weight, beyond = bodies(rng, 2, 30)
    solids, clear = solids_of(vertex, weight), 0.6
    points = rng.normal(0, 5, (1500, 3))
    away = np.array([closest(np.broadcast_to(each, (len(vertex), 3)), vertex).min() for each in points])
    near, inside = np.zeros(len(points), bool), np.zeros(len(points), bool)
    near_shell(points, clear, solids, near)
    assert (near == (away <= clear)).all()
    assert 0.05 < near.mean() < 0.95
    far_inside(points, clear, solids, inside)
    assert (inside == ((beyond(points) < 0).any(axis=0) & (away > clear))).all()
    assert inside.any()


@pytest.mark.parametrize("grow", [0.0, 0.4])
def test_cells_of_a_skin_are_those_that_it_passes_through(grow):
    rng = np.random.default_rng(5)
    origin, size, count, left_out = np.array([-6.0, -5.0, -4.0]), 0.7, (17, 15, 12), 0
    low, high = origin, origin + size * np.array(count)
    centre = origin + size * (np.stack(np.meshgrid(*map(np.arange, count), indexing="ij"), -1).reshape(-1, 3) + 0.5)
    for _ in range(40):
        corner = rng.uniform(low - 2.0, high + 2.0, (3, 3)) * rng.choice([1.0, 0.2])
        cell = np.zeros(count, np.uint8)
        mark_shell(corner[None], grow, origin, size, cell)
        beside = rng.standard_normal((4000, 3))
        beside *= grow * rng.random((4000, 1)) / np.linalg.norm(beside, axis=1)[:, None]
        points = rng.dirichlet((1, 1, 1), 4000) @ corner + beside
        row = np.floor((points[((points > low) & (points < high)).all(axis=1)] - origin) / size).astype(int)
        assert cell[tuple(row.T)].all()
        away = closest(centre, np.broadcast_to(corner, (len(centre), 3, 3)))
        # From a cube of this half side to its corner.
        far = away > np.sqrt(3.0) * (0.5 * size + grow) + 1e-9
        marked = cell.ravel() == 1
        spans = np.ptp(np.clip(np.floor((np.array([corner.min(0) - grow, corner.max(0) + grow]) - origin) / size), 0, 99), axis=0)
        if (spans > 0).sum() > 1:
            assert not (marked & far).any()
        left_out += int(far.sum())
    assert left_out > 10_000
