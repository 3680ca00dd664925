"""The operations that take the least time together, and how far from the best they are at most.

It is a facility location: each sample is cut by one chosen operation that serves it, each operation costs an index of the rotary
axes, each cutter a change and each setup a clamping. A choice is made greedily and made better by leaving out and by exchanging
operations. The bound is Lagrange's: any prices of samples give one, over all candidates at once (`docs/operations.md`, lemma 8).
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from cad_io.arrays import Floats, Ints

Which = NDArray[np.int64]
#: Rounds of leaving out and exchanging, and of the linear program whose prices bound the time; columns that enter it at once.
_ROUNDS, _PRICED, _ENTER = 12, 8, 40
#: Seconds that count as nothing.
_NOTHING = 1e-9


@dataclass(frozen=True, slots=True)
class Costs:
    """What an operation, a cutter and a setup cost whatever they cut, in the unit of the samples' costs."""

    operation: float
    cutter: float
    setup: float


@dataclass(frozen=True, slots=True, eq=False)
class Location:
    """A choice of operations.

    Attributes
    ----------
    chosen : (k,) int64
        Ascending.
    cost : float
        Of all samples, each with the best of the chosen, and of operations, cutters and setups.
    bound : float
        No choice costs less.
    """

    chosen: Which
    cost: float
    bound: float


class Problem:
    """Samples and candidates, with what each costs.

    Parameters
    ----------
    cost : (n, m) float
        Of each sample with each candidate; infinite where the candidate does not serve it. Each row has a finite one.
    cutter, setup : (m,) int
    costs : Costs
    """

    def __init__(self, cost: Floats, cutter: Ints, setup: Ints, costs: Costs) -> None:
        self.cost, self.cutter, self.setup, self.costs = cost, cutter, setup, costs
        finite = cost[np.isfinite(cost)]
        #: Costs more than any choice.
        self.dear = float(cost.min(axis=1).sum() + finite.max(initial=0.0) * len(cost)) + 10.0 * sum(
            (costs.operation, costs.cutter, costs.setup)
        )

    def total(self, chosen: Which) -> float:
        """What a choice costs; infinite where it leaves a sample."""
        if not len(chosen):
            return 0.0 if not len(self.cost) else np.inf
        each = self.costs
        return float(
            self.cost[:, chosen].min(axis=1).sum() + each.operation * len(chosen)
            + each.cutter * len(np.unique(self.cutter[chosen])) + each.setup * len(np.unique(self.setup[chosen]))
        )  # fmt: skip

    def added(self, chosen: Which, now: Floats) -> tuple[int, float]:
        """The candidate that saves most beside a choice, and how much: `now` (n,) is what the samples cost with it."""
        gain = np.maximum(0.0, now[:, None] - self.cost).sum(axis=0) - self.costs.operation
        gain -= self.costs.cutter * ~np.isin(self.cutter, self.cutter[chosen])
        gain -= self.costs.setup * ~np.isin(self.setup, self.setup[chosen])
        best = int(gain.argmax())
        return best, float(gain[best])


def fastest(problem: Problem, start: Which | None = None) -> Location:
    """Choose operations of little cost, from a choice that serves all or from nothing, and bound what the best costs."""
    found = [_improved(problem, _grown(problem, np.zeros(0, np.int64)))]
    if start is not None:
        found.append(_improved(problem, _grown(problem, start)))
    best = min(found, key=problem.total)
    bound = _bound(problem, best)
    return Location(np.sort(best), problem.total(best), min(bound, problem.total(best)))


def _now(problem: Problem, chosen: Which) -> Floats:
    """What each sample costs with a choice; dear where nothing serves it."""
    if not len(chosen):
        return np.full(len(problem.cost), problem.dear)
    return np.minimum(problem.dear, problem.cost[:, chosen].min(axis=1))


def _grown(problem: Problem, chosen: Which) -> Which:
    """A choice with candidates added as long as one saves something."""
    while True:
        best, gain = problem.added(chosen, _now(problem, chosen))
        if gain <= _NOTHING:
            return chosen
        chosen = np.append(chosen, best)


def _improved(problem: Problem, chosen: Which) -> Which:
    """A choice of which leaving out or exchanging one candidate saves nothing more."""
    cost = problem.total(chosen)
    for _ in range(_ROUNDS):
        before = cost
        for candidate in chosen.tolist():
            rest = chosen[chosen != candidate]
            if problem.total(rest) < cost - _NOTHING:
                chosen, cost = rest, problem.total(rest)
                continue
            other, _ = problem.added(rest, _now(problem, rest))
            swapped = np.append(rest, other)
            if problem.total(swapped) < cost - _NOTHING:
                chosen, cost = swapped, problem.total(swapped)
        if cost >= before - _NOTHING:
            break
    return chosen


def lagrange(problem: Problem, price: Floats) -> tuple[float, Floats]:
    """Bound what any choice costs, by prices (n,) of samples; and the reduced costs (m,) of candidates.

    Whatever the prices, a choice pays for each sample its price, less what its candidates, cutters and setups gain on that: what
    they can gain at most leaves the bound. At least one cutter, and one setup, is paid for.
    """
    reduced = problem.costs.operation + np.minimum(0.0, problem.cost - price[:, None]).sum(axis=0)
    gain, costs = np.minimum(0.0, reduced), problem.costs
    by_cutter = np.minimum(0.0, costs.cutter + np.bincount(problem.cutter, gain)).sum() + costs.setup
    by_setup = np.minimum(0.0, costs.setup + np.bincount(problem.setup, gain)).sum() + costs.cutter
    return float(price.sum() + max(by_cutter, by_setup, gain.sum() + costs.cutter + costs.setup)), reduced


def _bound(problem: Problem, chosen: Which) -> float:
    """The best bound by prices of a linear program on few candidates, to which others are added as the prices ask for them."""
    from scipy.optimize import linprog
    from scipy.sparse import coo_array

    n, m = problem.cost.shape
    best = -np.inf
    often = np.bincount(problem.cost.argmin(axis=1), minlength=m)
    some = np.union1d(chosen, np.argsort(-often, kind="stable")[:_ENTER])
    for _ in range(_PRICED):
        row, column = np.nonzero(np.isfinite(problem.cost[:, some]))
        pairs, each = len(row), len(some)
        cost = np.concatenate(
            [problem.cost[:, some][row, column], np.full(each, problem.costs.operation), np.full(n, problem.dear)]
        )
        served = coo_array(
            (np.ones(pairs + n), (np.r_[row, np.arange(n)], np.r_[np.arange(pairs), pairs + each + np.arange(n)])),
            shape=(n, pairs + each + n),
        ).tocsr()
        opened = coo_array(
            (
                np.r_[np.ones(pairs), -np.ones(pairs)],
                (np.r_[np.arange(pairs), np.arange(pairs)], np.r_[np.arange(pairs), pairs + column]),
            ),
            shape=(pairs, pairs + each + n),
        ).tocsr()
        found = linprog(
            cost, A_ub=opened, b_ub=np.zeros(pairs), A_eq=served, b_eq=np.ones(n), bounds=(0.0, None), method="highs"
        )
        if found.x is None:
            break
        bound, reduced = lagrange(problem, found.eqlin.marginals)
        best = max(best, bound)
        new = np.setdiff1d(np.argsort(reduced, kind="stable")[:_ENTER], some)
        new = new[reduced[new] < -1e-7]
        if not len(new):
            break
        some = np.union1d(some, new)
    return float(best)
