"""Pieces of cells with one axis, against a slow twin that compares all boxes."""

from types import SimpleNamespace

import numpy as np
import pytest

from plan_cutters.judging.between import connected
from plan_cutters.judging.cells import CellContacts

AXES = np.array([[0.0, 0.0, 1.0], [0.6, 0.0, 0.8]])


def random_cells(rng, shape):
    """Leaves of tiles cut into four at random, some of them missing: level, tile, axis of each."""
    leaves = []

    def cut(level, i, j):
        if level < 3 and rng.random() < 0.45:
            for a in (0, 1):
                for b in (0, 1):
                    cut(level + 1, 2 * i + a, 2 * j + b)
        elif rng.random() < 0.75:
            leaves.append((level, i, j, int(rng.random() < 0.25)))

    for i in range(shape[0]):
        for j in range(shape[1]):
            cut(0, i, j)
    return np.array(leaves)


def slow(leaves, shape, closed):
    """The pieces as sets, box by box: two are joined that share a stretch of a side and have one axis."""
    size = 2.0 ** -leaves[:, 0]
    low = leaves[:, 1:3] * size[:, None]
    high = low + size[:, None]
    piece = list(range(len(leaves)))
    shifts = [(a, b) for a in ((-1, 0, 1) if closed[0] else (0,)) for b in ((-1, 0, 1) if closed[1] else (0,))]
    for i in range(len(leaves)):
        for j in range(i):
            for shift in shifts:
                off = np.array(shift) * shape
                over = np.minimum(high[i], high[j] + off) - np.maximum(low[i], low[j] + off)
                if over.min() == 0.0 and over.max() > 0.0 and leaves[i, 3] == leaves[j, 3]:
                    piece = [piece[j] if each == piece[i] else each for each in piece]
    return piece


@pytest.mark.parametrize("seed", range(6))
@pytest.mark.parametrize("closed", [(False, False), (True, False), (True, True)])
def test_pieces_are_those_of_a_slow_twin(seed, closed):
    rng, shape = np.random.default_rng(seed), (3, 4)
    leaves = random_cells(rng, shape)
    m = len(leaves)
    bare, wide = np.zeros(m), np.zeros((m, 3))
    normal = np.tile([0.0, 0.6, 0.8], (m, 1))
    cells = CellContacts(wide, normal, wide, wide[:, :2], AXES[leaves[:, 3]], bare > 0, bare, leaves[:, 1:3], leaves[:, 1:3],
                         wide[:, :2], wide[:, :2], bare == 0, bare, bare, bare > 0, wide, leaves[:, 0])  # fmt: skip
    field = SimpleNamespace(index=np.zeros(shape), closed=np.array(closed))
    found, twin = connected(field, cells, leaves[:, 0]), slow(leaves, shape, closed)
    pairs = {(a, b) for a, b in zip(found.tolist(), twin, strict=True)}
    assert len(pairs) == len(set(found.tolist())) == len(set(twin))
