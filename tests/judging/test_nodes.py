"""What is inferred of a surface about the nodes of a grid: no smaller than what lies there, by closed forms and brute force."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from cad_io.arrays import FaceGrid
from plan_cutters.judging.cells import WIDER, WILDER, from_neighbours, steepest, tensors

SEEDS = st.integers(0, 2**32 - 1)


def frames(rng, n):
    """Unit normals and directions square to them."""
    normal = rng.normal(size=(n, 3))
    normal /= np.linalg.norm(normal, axis=1)[:, None]
    direction = np.cross(normal, rng.normal(size=(n, 3)))
    return normal, direction / np.linalg.norm(direction, axis=1)[:, None]


@given(SEEDS)
@settings(max_examples=20, deadline=None)
def test_a_tensor_bends_each_direction_by_its_curvature(seed):
    rng = np.random.default_rng(seed)
    normal, direction = frames(rng, 8)
    curvature = rng.normal(size=(8, 2))
    made = tensors(normal, direction, curvature)
    across = np.cross(normal, direction)
    for way, wanted in ((direction, curvature[:, :1] * direction), (across, curvature[:, 1:] * across), (normal, 0.0 * normal)):
        assert np.einsum("nij,nj->ni", made, way) == pytest.approx(wanted, abs=1e-12)


@given(SEEDS, st.floats(0.0, 2.0))
@settings(max_examples=40, deadline=None)
def test_no_tensor_that_differs_by_so_much_has_a_larger_curvature_than_is_said(seed, variation):
    """Principal curvatures of tensors of the same plane, within the variation by their norm."""
    rng = np.random.default_rng(seed)
    normal, direction = frames(rng, 6)
    curvature = rng.normal(size=(6, 2))
    most, apart = steepest(tensors(normal, direction, curvature), np.full(6, variation))
    assert most - variation == pytest.approx(np.abs(curvature).max(axis=1), abs=1e-9)
    assert apart - 2.0 * variation == pytest.approx(np.abs(curvature[:, 0] - curvature[:, 1]), abs=1e-9)
    for _ in range(20):
        off = rng.normal(size=(6, 2, 2))
        off += off.transpose(0, 2, 1)
        off *= variation / np.maximum(1e-12, np.linalg.norm(off, axis=(1, 2)))[:, None, None]
        values = np.linalg.eigvalsh(off + np.einsum("ni,ij->nij", curvature, np.eye(2)))
        assert (np.abs(values).max(axis=1) <= most + 1e-9).all()
        assert (values[:, 1] - values[:, 0] <= apart + 1e-9).all()


def grid_of(nu, nv, *, closed_u=False, closed_v=False):
    u, v = np.linspace(0.0, 1.0, nu), np.linspace(0.0, 1.0, nv)
    return FaceGrid(1, u, v, np.arange(nu * nv).reshape(nu, nv), closed_u, closed_v, (0.0, 1.0, 0.0, 1.0))


@given(SEEDS, st.integers(2, 5), st.integers(2, 5), st.booleans())
@settings(max_examples=25, deadline=None)
def test_a_cell_reaches_no_farther_than_is_said_and_curvature_changes_twice_as_much_as_half_way(seed, nu, nv, closed):
    """Nodes of a plane anywhere: a cell is bounded by the middles between its node and the eight around it."""
    rng = np.random.default_rng(seed)
    grid = grid_of(nu, nv, closed_v=closed)
    at = np.stack([*np.meshgrid(np.cumsum(rng.uniform(0.5, 2.0, nu)), np.cumsum(rng.uniform(0.5, 2.0, nv)), indexing="ij"),
                   np.zeros((nu, nv))], axis=-1) + rng.uniform(-0.1, 0.1, (nu, nv, 3))  # fmt: skip
    bend = rng.normal(size=(nu * nv, 3, 3))
    variation, radius = from_neighbours(at.reshape(-1, 3), bend, grid, grid.index)
    bend = bend.reshape(nu, nv, 9)
    for i in range(nu):
        for j in range(nv):
            own, row = at[i, j], grid.index[i, j]
            steps = [(a, b) for a in (-1, 0, 1) for b in (-1, 0, 1) if (a, b) != (0, 0)]
            near = [(i + a, (j + b) % nv if closed else j + b) for a, b in steps]
            near = [(a, b) for a, b in near if 0 <= a < nu and 0 <= b < nv]
            far = max(np.linalg.norm(at[a, b] - own) for a, b in near)
            assert radius[row] >= 0.5 * WIDER * far - 1e-9
            u = max((np.linalg.norm(at[a, j] - own) for a in (i - 1, i + 1) if 0 <= a < nu), default=0.0)
            sides = [(j + b) % nv if closed else j + b for b in (-1, 1)]
            v = max((np.linalg.norm(at[i, b] - own) for b in sides if 0 <= b < nv), default=0.0)
            assert radius[row] <= 0.5 * WIDER * max(far, float(np.hypot(u, v))) + 1e-9
            along = max((np.linalg.norm(bend[a, j] - bend[i, j]) for a in (i - 1, i + 1) if 0 <= a < nu), default=0.0)
            across = max((np.linalg.norm(bend[i, b] - bend[i, j]) for b in sides if 0 <= b < nv), default=0.0)
            # Half way to the next nodes it differs by half of that.
            assert variation[row] == pytest.approx(2.0 * 0.5 * (along + across))
    assert (WIDER, WILDER) == (1.1, 2.0)


def test_a_node_without_neighbours_on_both_axes_tells_nothing_and_missing_ones_are_no_neighbours():
    grid = grid_of(3, 3)
    at = np.stack([*np.meshgrid(np.arange(3.0), np.arange(3.0), indexing="ij"), np.zeros((3, 3))], axis=-1)
    index = grid.index.copy()
    index[2, :] = -1
    index[0:2, 2] = -1
    index[1, 1] = -1
    bend = np.random.default_rng(1).normal(size=(9, 3, 3))
    variation, radius = from_neighbours(at.reshape(-1, 3), bend, grid, index)
    # Three nodes are left: the corner has both neighbours, the others one each.
    assert radius[0] == pytest.approx(0.5 * WIDER * np.sqrt(2.0))
    assert np.isnan(radius[[1, 3]]).all()
    assert variation[0] == pytest.approx(np.linalg.norm(bend[1] - bend[0]) + np.linalg.norm(bend[3] - bend[0]))
    assert np.isnan(variation[[2, 4, 5, 6, 7, 8]]).all()
