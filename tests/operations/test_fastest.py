"""The choice of least cost, against all choices, and its bound."""

from itertools import combinations, permutations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from plan_cutters.operations.fastest import Costs, Problem, Turning, cheap, exchanged, lagrange, promising
from tests.support.located import located


def best(problem):
    """A choice of little cost, with its bound."""
    return located(problem, cheap(problem))


def problem_of(seed, n, m, cutters=3, setups=2):
    rng = np.random.default_rng(seed)
    cost = np.where(rng.random((n, m)) < 0.6, 10.0 * rng.random((n, m)), np.inf)
    cost = cost[np.isfinite(cost).any(axis=1)]
    costs = Costs(*(10.0 * rng.random(3)))
    return Problem(cost, rng.integers(0, cutters, m).astype(np.int32), rng.integers(0, setups, m).astype(np.int32), costs)


def brute(problem):
    m = problem.cost.shape[1]
    return min(problem.total(np.array(some)) for k in range(1, m + 1) for some in combinations(range(m), k))


@given(st.integers(0, 2**31), st.integers(1, 9), st.integers(1, 7), st.sampled_from([(3, 2), (1, 1), (6, 5)]))
@settings(max_examples=120, deadline=None)
def test_what_is_chosen_serves_all_and_the_least_lies_between_it_and_its_bound(seed, n, m, kinds):
    """Of up to 7 cutters and setups each set has a bound of its own; of more one bound stands for all."""
    problem = problem_of(seed, n, m, *kinds)
    if not len(problem.cost):
        return
    found = best(problem)
    least = brute(problem)
    assert np.isfinite(problem.cost[:, found.chosen]).any(axis=1).all()
    assert found.cost == problem.total(found.chosen)
    assert found.bound <= least * (1.0 + 1e-9) + 1e-9
    assert found.cost >= least - 1e-9


@given(st.integers(0, 2**31))
@settings(max_examples=60, deadline=None)
def test_any_prices_bound_the_cost_of_any_choice(seed):
    problem = problem_of(seed, 6, 5)
    if not len(problem.cost):
        return
    price = np.random.default_rng(seed).normal(5.0, 10.0, len(problem.cost))
    assert lagrange(problem.cost.T, problem.costs.operation, price)[0] <= brute(problem) + 1e-9


def test_without_costs_of_operations_each_sample_takes_its_best_and_the_bound_is_that():
    rng = np.random.default_rng(3)
    problem = Problem(rng.random((20, 6)), np.zeros(6, np.int32), np.zeros(6, np.int32), Costs(0.0, 0.0, 0.0))
    found = best(problem)
    assert np.isclose(found.cost, problem.cost.min(axis=1).sum())
    assert np.isclose(found.bound, found.cost)


def test_dear_operations_leave_one_if_one_serves_all():
    cost = np.array([[1.0, 0.5, np.inf], [1.0, np.inf, 0.5]])
    found = best(Problem(cost, np.zeros(3, np.int32), np.zeros(3, np.int32), Costs(100.0, 0.0, 0.0)))
    assert found.chosen.tolist() == [0]
    assert found.cost == 102.0


@given(st.integers(0, 2**31), st.integers(2, 9), st.integers(2, 7))
@settings(max_examples=40, deadline=None)
def test_exchanging_keeps_the_number_and_that_all_are_served_and_is_never_dearer(seed, n, m):
    problem = problem_of(seed, n, m)
    if not len(problem.cost):
        return
    start = best(problem).chosen
    found = exchanged(problem, start)
    assert len(found) == len(set(found.tolist())) == len(start)
    assert np.isfinite(problem.cost[:, found]).any(axis=1).all()
    assert problem.cutting(found) <= problem.cutting(start) + 1e-9


def test_of_two_that_serve_all_the_faster_is_taken():
    problem = Problem(np.array([[3.0, 1.0], [3.0, 2.0]]), np.zeros(2, np.int32), np.zeros(2, np.int32), Costs(0.0, 0.0, 0.0))
    assert exchanged(problem, np.array([0])).tolist() == [1]


def turning(seed, n, m):
    """Candidates on a line: those of one cutter and setup are visited from 0, each group by itself, in the best order."""
    problem, place = problem_of(seed, n, m), 20.0 * np.random.default_rng(seed + 1).uniform(-1.0, 1.0, m)

    def together(chosen):
        groups = {}
        for each in chosen.tolist():
            groups.setdefault((problem.cutter[each], problem.setup[each]), []).append(place[each])
        ways = [[np.abs(np.diff([0.0, *order])).sum() for order in permutations(mine)] for mine in groups.values()]
        return float(sum(map(min, ways)))

    return Problem(problem.cost, problem.cutter, problem.setup, problem.costs, Turning(together, np.abs(place)))


@given(st.integers(0, 2**31), st.integers(1, 8), st.integers(1, 6))
@settings(max_examples=80, deadline=None)
def test_turning_axes_leave_the_least_between_the_choice_and_its_bound(seed, n, m):
    problem = turning(seed, n, m)
    if not len(problem.cost):
        return
    every = [np.array(some) for k in range(1, m + 1) for some in combinations(range(m), k)]
    least = min(problem.turned(some) for some in every)
    found = best(problem)
    assert found.cost == problem.turned(found.chosen)
    assert found.bound <= least * (1.0 + 1e-9) + 1e-9
    assert found.cost >= least - 1e-9


def test_one_candidate_far_away_is_bounded_by_its_turn():
    cost = np.array([[1.0, 2.0], [1.0, np.inf]])
    problem = Problem(cost, np.zeros(2, np.int32), np.zeros(2, np.int32), Costs(5.0, 0.0, 0.0),
                      Turning(lambda chosen: 30.0 if 0 in chosen else 10.0, np.array([30.0, 10.0])))  # fmt: skip
    found = located(problem, np.array([0]))
    assert (found.cost, found.bound) == (32.0, pytest.approx(32.0))


@given(st.integers(0, 2**31), st.integers(20, 60))
@settings(max_examples=20, deadline=None)
def test_promising_candidates_have_the_best_of_each_sample_and_a_choice_that_costs_little_more(seed, m):
    """By prices of the samples: of a few hundred candidates that lie about as axes do, a few dozen hold a choice as good."""
    rng = np.random.default_rng(seed)
    place, axis = rng.random((150, 2)), rng.random((8 * m, 2))
    away = np.linalg.norm(place[:, None] - axis, axis=2)
    cost = np.where(away < 0.35, 0.5 + away + 0.3 * rng.random(away.shape), np.inf)
    cost = cost[np.isfinite(cost).any(axis=1)]
    problem = Problem(cost, rng.integers(0, 3, 8 * m).astype(np.int32), np.zeros(8 * m, np.int32), Costs(3.0, 5.0, 0.0))
    chosen = cheap(problem)
    some = promising(problem, chosen)
    assert np.isin(chosen, some).all()
    assert np.isin(cost.argmin(axis=1), some).all()
    assert (np.diff(some) > 0).all()
    part = problem.of(some)
    assert part.total(cheap(part)) <= 1.03 * problem.total(chosen)


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize("left", [0, 1, 150])
def test_samples_that_the_choice_leaves_have_no_price(left):
    rng = np.random.default_rng(left)
    cost = rng.random((150, 80)) + 1.0
    cost[:left, :3] = np.inf
    problem = Problem(cost, np.zeros(80, np.int32), np.zeros(80, np.int32), Costs(3.0, 5.0, 0.0))
    some = promising(problem, np.arange(3))
    assert np.isin(cost.argmin(axis=1), some).all()
    if left < 150:
        paying = problem.of(np.arange(80), np.arange(150) >= left)
        assert np.isin(promising(paying, np.arange(3)), some).all()
