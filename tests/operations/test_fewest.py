"""The fewest orientations with rows and candidates that are made only when they are requested, against the whole table."""

from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from plan_cutters.domain.operations import columns_of
from plan_cutters.operations.fewest import Cover, Search, fewest, search_fewest, spread

UNIT = 1_000_000


class Table:
    """Probes that look into a table: a candidate is known by its first angle, its number."""

    def __init__(self, table):
        self.whole, self.made = table, 0
        self.samples = SimpleNamespace(point=np.column_stack([np.arange(len(table)), *np.zeros((2, len(table)))]))

    def table(self, rows, columns, progress=None):
        self.made += len(rows) * len(columns)
        return self.whole[np.ix_(rows, np.rint(columns.angle[:, 0]).astype(int))]

    def one(self, rows, columns, which):
        return self.table(rows, columns.of(np.array([which])))[:, 0]


def columns(numbers):
    numbers = np.asarray(numbers)
    return columns_of(np.zeros((len(numbers), 3)), np.column_stack([numbers, np.zeros(len(numbers))]).astype(float))


def caps(seed, n, m, reach):
    """Which of m directions lie near which of n: tables as parts have them."""
    rng = np.random.default_rng(seed)
    a, b = (rng.normal(size=(k, 3)) for k in (n, m))
    a, b = (each / np.linalg.norm(each, axis=1)[:, None] for each in (a, b))
    return a @ b.T > np.cos(reach)


@pytest.mark.slow("plans operations")
@given(st.integers(0, 2**31), st.floats(0.5, 1.2))
@settings(max_examples=8, deadline=None)
def test_few_rows_give_what_the_whole_table_gives(seed, reach):
    table = caps(seed, 500, 60, reach)
    wanted = np.flatnonzero(table.any(axis=1))
    probes = Table(table)
    search = Search(probes, columns(range(60)), wanted, lambda bare: columns([]))
    found, whole = search.solve(), fewest(table[wanted])
    assert table[np.ix_(wanted, found.chosen)].any(axis=1).all()
    assert len(found.chosen) == found.at_least == len(whole.chosen) == whole.at_least
    load = found.weight @ table[search.rows]
    assert load.max() <= UNIT


@pytest.mark.slow("searches long")
@given(st.integers(0, 2**31))
@settings(max_examples=10, deadline=None)
def test_candidates_that_wait_change_neither_the_minimum_nor_what_the_weights_prove(seed):
    table = caps(seed, 500, 60, 0.9)
    wanted = np.flatnonzero(table[:, :25].any(axis=1))
    search = Search(Table(table), columns(range(25)), wanted, lambda bare: columns([]))
    search.solve(prove=False)
    search._add_columns(columns(range(25, 60)))
    found = search.solve()
    whole = fewest(table[wanted])
    assert len(found.chosen) == len(whole.chosen)
    assert found.at_least == whole.at_least
    every = table[search.rows][:, np.rint(search.columns.angle[:, 0]).astype(int)]
    assert (found.weight @ every).max() <= UNIT


def test_few_of_all_tests_are_made():
    """Of 400 candidates five serve a fifth each, and all others less of it."""
    rng = np.random.default_rng(3)
    fifth = np.arange(20_000) % 5
    table = (fifth[:, None] == np.arange(400) % 5) & (rng.random((20_000, 400)) < 0.7)
    table[:, :5] = fifth[:, None] == np.arange(5)
    probes = Table(table)
    found = Search(probes, columns(range(400)), np.arange(20_000), lambda bare: columns([])).solve()
    assert found.closed
    assert len(found.chosen) == 5
    assert probes.made < 0.1 * table.size


def test_a_sample_that_no_candidate_serves_brings_its_own_posture_or_is_told():
    table = np.zeros((6, 5), bool)
    table[:4, 0] = True
    table[4, 3] = True
    asked = []

    def stored(bare):
        asked.extend(bare.tolist())
        return columns([3])

    search = Search(Table(table), columns([0, 1]), np.arange(6), stored)
    found = search.solve()
    assert sorted(asked) == [4, 5]
    assert search.alone.tolist() == [5]
    assert np.rint(search.columns.angle[found.chosen, 0]).tolist() == [0, 3]


def test_nothing_to_serve_needs_nothing():
    search = Search(Table(np.zeros((3, 2), bool)), columns([0, 1]), np.zeros(0, np.int64), lambda bare: columns([]))
    found = search.solve()
    assert len(found.chosen) == found.at_least == 0


@given(st.integers(0, 2**31), st.integers(1, 40), st.integers(1, 40))
@settings(max_examples=40, deadline=None)
def test_samples_that_are_spread_are_each_as_far_as_can_be_from_those_before(seed, count, most):
    rng = np.random.default_rng(seed)
    point, rows = rng.uniform(-1.0, 1.0, (60, 3)), np.sort(rng.choice(60, count, replace=False))
    some = spread(rows, point, most)
    assert len(some) == min(count, most)
    assert set(some.tolist()) <= set(rows.tolist())
    assert (np.diff(some) > 0).all()
    if count <= most:
        return
    assert rows[0] in some
    if most == 1:
        return
    # All others are no farther from those taken than these are from each other.
    away = np.linalg.norm(point[rows][:, None] - point[some], axis=2).min(axis=1)
    among = np.linalg.norm(point[some][:, None] - point[some], axis=2) + 9.0 * np.eye(len(some))
    assert away.max() <= among.min() + 1e-12


def test_of_samples_at_one_place_one_is_enough():
    point = np.repeat([[1.0, 2.0, 3.0], [5.0, 2.0, 3.0]], 5, axis=0)
    assert spread(np.arange(10), point, 4).tolist() == [0, 5]


class Levels:
    """A stand-in for a search that notes what it is asked, and has a cover of so many candidates."""

    def __init__(self, chosen):
        self.columns, self.rows, self.alone, self.wanted = columns(range(9)), np.arange(4), np.zeros(0, np.int64), 4
        self.cover = Cover(np.arange(chosen), 1, np.zeros(4, np.int64), 1.0, 1.0)
        self.proved, self.spacings, self.known = [], [], []

    def solve(self, known=None, *, prove=True):
        self.proved.append(prove)
        self.known.append(known)
        return self.cover

    def refine(self, cover, spacing, orientations):
        assert cover is self.cover
        self.spacings.append(spacing)


@pytest.mark.parametrize(("spacing", "finest"), [(0.16, 0.02), (0.1, 0.07), (0.3, 0.3), (0.35, 0.01)])
def test_candidates_are_laid_down_to_the_finest_spacing_in_equal_shares_and_the_last_cover_is_proved(spacing, finest):
    search, told = Levels(3), []
    found = search_fewest(search, (), spacing, finest, lambda done, of: told.append((done, of)))
    levels = len(search.spacings)
    assert [spacing, *search.spacings] == pytest.approx(np.geomspace(spacing, finest, levels + 1) if levels else [spacing])
    # Each halving is a level, the last ones joined.
    assert 2.0**-0.5 <= 2.0**levels * finest / spacing <= 2.0**0.5 or levels == 0
    assert search.proved == [False] * levels + [True]
    assert found.spacing == pytest.approx(finest if levels else spacing)
    assert told == [(k, levels) for k in range(levels)]
    assert search.known[0] is None
    assert all(each is search.cover.chosen for each in search.known[1:])


def test_one_candidate_for_all_needs_no_finer_ones():
    search = Levels(1)
    assert search_fewest(search, (), 0.16, 0.02, lambda done, of: None).spacing == 0.16
    assert search.spacings == []


@given(st.integers(0, 2**31))
@settings(max_examples=5, deadline=None)
def test_where_the_rounds_do_not_do_the_cover_serves_all_the_same(seed):
    table = caps(seed, 400, 50, 0.9)
    wanted = np.flatnonzero(table.any(axis=1))
    search = Search(Table(table), columns(range(50)), wanted, lambda bare: columns([]))
    found = search._patched()
    assert table[np.ix_(wanted, found.chosen)].any(axis=1).all()


@given(st.integers(0, 2**31))
@settings(max_examples=5, deadline=None)
def test_candidates_that_wait_enter_where_they_could_make_a_cover_smaller(seed):
    """Few serve little, and one that waits serves all."""
    table = np.concatenate([caps(seed, 60, 20, 0.4), np.ones((60, 1), bool)], axis=1)
    table[:, 0] |= ~table[:, :20].any(axis=1)
    search = Search(Table(table), columns(range(20)), np.arange(60), lambda bare: columns([]))
    assert len(search.solve(prove=False).chosen) > 1
    search._add_columns(columns([20]))
    found = search.solve()
    assert np.rint(search.columns.angle[found.chosen, 0]).tolist() == [20]
    assert found.at_least == 1


@given(st.integers(0, 2**31))
@settings(max_examples=20, deadline=None)
def test_dropped_candidates_come_back_where_nothing_else_serves_and_are_not_tested_elsewhere(seed):
    table = caps(seed, 600, 80, 0.7)
    wanted = np.flatnonzero(table.any(axis=1))
    probes = Table(table)
    search = Search(probes, columns(range(80)), wanted, lambda bare: columns([]), first=60)
    first = search.begin()
    numbers = np.rint(first.angle[:, 0]).astype(int)
    assert table[np.ix_(search.rows, numbers)].any(axis=1).all()
    search.narrow(first)
    before, stays = probes.made, len(first)
    few = search.columns.of(search.solve(prove=False).chosen)
    assert table[np.ix_(wanted, np.rint(few.angle[:, 0]).astype(int))].any(axis=1).all()
    assert not len(search.alone)
    active, whole = search.whole
    assert (whole == table[np.ix_(search.rows, np.rint(search.columns.angle[active, 0]).astype(int))]).all()
    # Those that stay are tested at the samples that came later, and each of the others at what these leave.
    assert len(active) >= stays
    assert probes.made - before < 80 * len(wanted)
