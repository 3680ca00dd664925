"""Cells that a skin passes through: all that hold a point of it, and none that is far from it."""

import numpy as np
import pytest

from plan_cutters.kernels.material import mark_shell
from tests.support.distances import closest


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
