"""Labels of samples: never an operation that does not serve, never worse than the best of each, least on small graphs."""

from itertools import product

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from plan_cutters.operations.labels import joined, labelled, pieces


def grid(nx, ny):
    number = np.arange(nx * ny).reshape(nx, ny)
    return np.concatenate(
        [np.stack([number[1:].ravel(), number[:-1].ravel()], 1), np.stack([number[:, 1:].ravel(), number[:, :-1].ravel()], 1)]
    )


def energy(cost, edge, border, label):
    served = label >= 0
    apart = (label[edge[:, 0]] != label[edge[:, 1]]) & served[edge].all(axis=1)
    return cost[served, label[served]].sum() + border[apart].sum()


@given(st.integers(0, 2**31), st.integers(1, 7), st.integers(1, 7), st.integers(1, 5), st.floats(0.0, 5.0))
@settings(max_examples=80)
def test_no_sample_goes_with_an_operation_that_does_not_serve_it(seed, nx, ny, k, weight):
    rng = np.random.default_rng(seed)
    cost = np.where(rng.random((nx * ny, k)) < 0.5, rng.random((nx * ny, k)), np.inf)
    edge = grid(nx, ny)
    border = weight * rng.random(len(edge))
    label = labelled(cost, edge, border)
    served = np.isfinite(cost).any(axis=1)
    assert ((label >= 0) == served).all()
    assert np.isfinite(cost[served, label[served]]).all()
    best = np.where(served, cost.argmin(axis=1), -1)
    assert energy(cost, edge, border, label) <= energy(cost, edge, border, best) + 1e-6
    after = joined(label, np.isfinite(cost), edge, np.ones(len(cost)), 3.0)
    assert ((after >= 0) == served).all()
    assert np.isfinite(cost[served, after[served]]).all()
    assert pieces(after, edge).max(initial=-1) <= pieces(label, edge).max(initial=-1)


@given(st.integers(0, 2**31))
@settings(max_examples=30)
def test_two_operations_are_parted_by_the_least_cut_of_all(seed):
    """One expansion over two labels is exact: every labelling of nine samples is tried."""
    rng = np.random.default_rng(seed)
    cost = np.where(rng.random((9, 2)) < 0.8, rng.random((9, 2)), np.inf)
    cost[np.isinf(cost).all(axis=1)] = 0.5
    edge = grid(3, 3)
    border = rng.random(len(edge))
    least = min(energy(cost, edge, border, np.array(each)) for each in product(range(2), repeat=9))
    assert abs(energy(cost, edge, border, labelled(cost, edge, border)) - least) <= 1e-6


def test_a_dear_border_makes_one_piece_and_a_free_one_the_best_of_each():
    edge = grid(1, 10)
    cost = np.column_stack([np.ones(10), np.where(np.arange(10) % 2, 0.9, 1.1)])
    assert len(np.unique(labelled(cost, edge, np.full(9, 10.0)))) == 1
    assert (labelled(cost, edge, np.zeros(9)) == cost.argmin(axis=1)).all()


def joined_slowly(label, serves, edge, area, least):
    """As `joined`, with all pieces counted anew after each that went over."""
    label = label.copy()
    while True:
        number = pieces(label, edge)
        size = np.bincount(number[number >= 0], area[number >= 0])
        for piece in np.argsort(size, kind="stable").tolist():
            if size[piece] >= least:
                return label
            rows = np.flatnonzero(number == piece)
            touching = edge[(number[edge] == piece).sum(axis=1) == 1]
            adjacent = label[touching[number[touching] != piece]]
            able, times = np.unique(adjacent[adjacent >= 0], return_counts=True)
            good = serves[np.ix_(rows, able)].all(axis=0)
            if good.any():
                label[rows] = able[good][times[good].argmax()]
                break
        else:
            return label


@given(st.integers(0, 2**31), st.integers(1, 9), st.integers(1, 9), st.integers(1, 4), st.floats(0.0, 9.0))
@settings(max_examples=150)
def test_pieces_go_over_as_if_all_were_counted_anew_each_time(seed, nx, ny, k, least):
    """Areas differ, so that one piece is the smallest."""
    rng = np.random.default_rng(seed)
    serves = rng.random((nx * ny, k)) < 0.7
    label = np.where(serves.any(axis=1), np.where(serves, rng.random(serves.shape), -1.0).argmax(axis=1), -1).astype(np.int32)
    area = rng.uniform(0.5, 2.0, nx * ny)
    after = joined(label, serves, grid(nx, ny), area, least)
    assert (after == joined_slowly(label, serves, grid(nx, ny), area, least)).all()
