"""How much of the area one, two, three ... orientations serve, and the most that so many can: against all choices."""

from itertools import combinations
from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from plan_cutters.domain.columns import columns_of
from plan_cutters.operations import curve as module
from plan_cutters.operations.curve import curve


def columns(numbers):
    numbers = np.asarray(numbers)
    return columns_of(np.zeros((len(numbers), 3)), np.column_stack([numbers, np.zeros(len(numbers))]).astype(float))


class Table:
    """Probes that look into a table (samples, columns), whose columns are known by their first angle."""

    def __init__(self, table):
        self.whole = table

    def table(self, rows, chosen, progress=None):
        if progress is not None:
            progress(1, 1)
        return self.whole[np.ix_(rows, np.rint(chosen.angle[:, 0]).astype(int))]

    kept = table


def problem(seed, n=9, m=6):
    rng = np.random.default_rng(seed)
    table = rng.random((n, m)) < 0.4
    table[np.arange(n), rng.integers(0, m, n)] = True
    chosen = [0]
    while not table[:, chosen].any(axis=1).all():
        chosen.append(len(chosen))
    return table, rng.uniform(0.5, 30.0, n), np.array(chosen)


def of(steps):
    return [(each.orientations, each.share, each.at_most) for each in steps]


def best(table, area, k):
    return max(float(area[table[:, list(some)].any(axis=1)].sum()) for some in combinations(range(table.shape[1]), k))


@settings(max_examples=30, deadline=None)
@given(st.integers(0, 2**31), st.floats(1.0, 2.0))
def test_shares_lie_under_the_best_of_all_choices_and_that_under_the_bound(seed, more):
    """Of an area that is as large as that of the samples, or larger."""
    table, area, chosen = problem(seed)
    n, m = table.shape
    rows, whole, told = np.arange(n), more * float(area.sum()), []
    fewest = SimpleNamespace(chosen=chosen, columns=columns(range(m)))
    steps = of(curve(Table(table), fewest, rows, area, whole, None, progress=lambda done, total: told.append(done / total)))
    assert [each[0] for each in steps] == list(range(1, len(chosen) + 1))
    for k, share, bound in steps:
        most = best(table, area, k) / whole
        assert share <= most + 1e-9
        assert bound >= min(1.0, most) - 1e-9
        assert bound <= min(1.0, k * best(table, area, 1) / whole * (1.0 + 2e-5))
        assert share >= (1.0 - (1.0 - 1.0 / k) ** k) * most - 1e-6, "the greedy choice is as good as that"
    # The cover itself serves all.
    assert steps[-1][1] == pytest.approx(1.0 / more)
    assert told == sorted(told)
    assert told[-1] <= 1.0


@settings(max_examples=30, deadline=None)
@given(st.integers(0, 2**31))
def test_of_a_large_table_some_samples_choose_and_all_are_measured(seed):
    table, area, chosen = problem(seed)
    n, m = table.shape
    some, told = np.arange(0, n, 2), []
    fewest = SimpleNamespace(chosen=chosen, columns=columns(range(m)))

    def few(progress):
        progress(1, 2)
        return columns(range(m)), np.arange(m), table[some], area[some]

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(module, "_TESTS", 1)
        steps = of(curve(Table(table), fewest, np.arange(n), area, float(area.sum()), few,
                         progress=lambda done, total: told.append(done / total)))  # fmt: skip
    assert all(bound is None for _, _, bound in steps)
    assert all(share <= best(table, area, k) / area.sum() + 1e-9 for k, share, _ in steps)
    assert steps[-1][1] == pytest.approx(1.0)
    assert told == sorted(told)


def test_nothing_that_is_reached_or_chosen_has_no_steps():
    table, area, chosen = problem(1)
    none = np.zeros(0, np.int64)
    for which, rows in ((none, np.arange(9)), (chosen, none)):
        fewest = SimpleNamespace(chosen=which, columns=columns(range(6)))
        assert curve(Table(table), fewest, rows, area, 1.0, None) == ()
