"""The fewest columns of a table, against all choices of columns, and the weights that prove it, by code of their own."""

from itertools import combinations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from plan_cutters.operations.fewest import UNIT, fewest, relax, whole_weights

TABLES = st.tuples(st.integers(1, 14), st.integers(1, 9)).flatmap(lambda size: arrays(bool, size, elements=st.booleans()))


def brute(table):
    """The size of the smallest cover, by trying all."""
    for k in range(1, table.shape[1] + 1):
        if any(table[:, list(some)].any(axis=1).all() for some in combinations(range(table.shape[1]), k)):
            return k
    raise AssertionError


def proves(table, weight):
    """How many columns every cover has at least, by the weights alone: no code in common with the program."""
    most = 0
    for column in range(len(table[0])):
        load = sum(int(w) for row, w in zip(table, weight, strict=True) if row[column])
        most = max(most, load)
    assert most <= 1_000_000
    return -(-sum(int(w) for w in weight) // 1_000_000)


@given(TABLES)
@settings(max_examples=120)
def test_it_is_as_small_as_the_smallest_of_all_choices(table):
    table = table[table.any(axis=1)]
    if not len(table):
        return
    found = fewest(table)
    assert table[:, found.chosen].any(axis=1).all()
    assert len(found.chosen) == found.at_least == brute(table)
    assert proves(table, found.weight) <= len(found.chosen)


@given(TABLES, st.randoms(use_true_random=False))
@settings(max_examples=60)
def test_repeated_rows_and_columns_and_their_order_change_nothing(table, random):
    table = table[table.any(axis=1)]
    if not len(table):
        return
    rows, columns = list(range(len(table))) * 2, list(range(table.shape[1])) * 2
    random.shuffle(rows)
    random.shuffle(columns)
    assert len(fewest(table[rows][:, columns]).chosen) == len(fewest(table).chosen)


@given(TABLES, st.integers(0, 2**31))
@settings(max_examples=60)
def test_whole_weights_load_no_column_too_much_whatever_is_given(table, seed):
    weight = np.random.default_rng(seed).random(len(table)) * 3.0
    whole = whole_weights(table, weight)
    assert (whole @ table.astype(np.int64) <= UNIT).all()
    assert (whole >= 0).all()


def test_an_early_end_says_no_more_than_it_knows():
    """The points of a projective plane of order 2, each pair of lines through one: weights prove 7/3, three lines are needed."""
    lines = [(0, 1, 2), (0, 3, 4), (0, 5, 6), (1, 3, 5), (1, 4, 6), (2, 3, 6), (2, 4, 5)]
    table = np.array([[point in line for line in lines] for point in range(7)])
    assert relax(table).bound == pytest.approx(7 / 3, abs=1e-4)
    assert fewest(table).at_least == brute(table) == 3


def test_of_no_rows_nothing_is_needed():
    found = fewest(np.zeros((0, 4), bool))
    assert len(found.chosen) == found.at_least == 0
    assert found.closed
