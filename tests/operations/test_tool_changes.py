"""Laws of how often another tool is put in: by the tool in the spindle, step for step."""

import numpy as np
import pytest

from plan_cutters.domain.operations import tool_changes
from plan_cutters.operations.fastest import Costs, Problem


def put_in(uses, order):
    """Work through setups with the tools that each needs, in an order; returns how often the spindle is empty of the next."""
    changes, spindle = 0, None
    for setup in range(5):
        for tool in order:
            if (setup, tool) in uses and tool != spindle:
                changes, spindle = changes + (spindle is not None), tool
    return changes


@pytest.mark.parametrize("seed", range(40))
def test_costs_of_uses_are_those_of_the_spindle(seed):
    rng = np.random.default_rng(seed)
    kinds = [(s, c) for s in range(4) for c in range(4)]
    uses = {kinds[k] for k in rng.choice(16, rng.integers(1, 12), replace=False)}
    place = rng.permutation(4)
    changes = Costs(0.0, 1.0, 0.0, tuple(place.tolist())).between([*uses, *uses])
    assert changes == put_in(uses, np.argsort(place).tolist())
    # Each tool but the first at least once, each use but the first at most once.
    assert len({c for _, c in uses}) - 1 <= changes <= len(uses) - 1
    assert Costs(0.0, 0.0, 7.0).between(uses) == 7.0 * (len({s for s, _ in uses}) - 1)


def test_a_setup_begins_with_the_tool_that_is_there_and_one_that_comes_back_is_put_in_again():
    assert tool_changes([(0, "D12"), (0, "drill"), (1, "drill"), (1, "D12"), (2, "D12")]) == 2
    assert tool_changes([(1, "D12"), (0, "D12"), (0, "D6"), (1, "D6")]) == 3


@pytest.mark.parametrize("seed", range(10))
def test_what_a_candidate_costs_beside_a_choice_is_what_the_choice_with_it_costs_more(seed):
    rng = np.random.default_rng(seed)
    cutter, setup = rng.integers(0, 3, 20).astype(np.int32), rng.integers(0, 3, 20).astype(np.int32)
    problem = Problem(np.zeros((1, 20)), cutter, setup, Costs(0.0, 20.0, 300.0, (2, 0, 1)))
    chosen = rng.choice(20, 4, replace=False)
    more = problem.further(frozenset(zip(setup[chosen].tolist(), cutter[chosen].tolist(), strict=True)))
    assert more.tolist() == [problem.total(np.append(chosen, k)) - problem.total(chosen) for k in range(20)]
