"""The operations that take the least time together, and how far from the best they are at most.

It is a facility location: each sample is cut by one chosen operation that serves it, each operation costs an index of the rotary
axes, each change of cutters is paid for, and each setup after the first. A choice is made greedily and made better by leaving out
and by exchanging operations. The bound is Lagrange's: any prices of samples give one for each set of cutters and of
setups, and the least of these bounds every choice (`docs/operations_proof.md`, lemma O8; lemma O9 where rotary axes have rates).
Prices are made better by steps along the mean of what samples are served too often or not at all; candidates that no better
choice can have are left out on the way.
"""

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from itertools import combinations, pairwise, product

import numpy as np
from numpy.typing import NDArray

from cad_io.arrays import Floats, Ints
from plan_cutters.domain.operations import tool_changes
from plan_cutters.plan_file.operations import FastestEntry

Which = NDArray[np.int64]


@dataclass(frozen=True, slots=True)
class Costs:
    """Each operation, each change of cutters, and each setup after the first costs this whatever it cuts, in the samples' unit.

    Where candidates turn, the cost of an operation only leads the choice. `order`: of each cutter its place within a setup;
    empty: they come by their numbers.
    """

    operation: float
    cutter: float
    setup: float
    order: tuple[int, ...] = ()

    def between(self, uses: Iterable[tuple[int, int]]) -> float:
        """Price the changes and further setups of uses, each a setup and the number of a cutter, in any order."""
        known = sorted({(setup, self.order[cutter] if self.order else cutter) for setup, cutter in uses})
        return self.cutter * tool_changes(known) + self.setup * max(0, len({setup for setup, _ in known}) - 1)


@dataclass(frozen=True, slots=True, eq=False)
class Turning:
    """Operations of a choice cost what the rotary axes take from one to the next.

    `together`: what the operations (k,) of a choice cost together. `reach` (m,) float: whatever else is chosen, those of the same
    cutter and setup cost at least this together with a candidate.
    """

    together: Callable[[Which], float]
    reach: Floats


class Problem:
    """Samples and candidates, with what each costs.

    `cost` (n, m) float: of each sample with each candidate; infinite where the candidate does not serve it. Each row has a finite
    one. `cutter`, `setup` (m,) int. Without `turning` each operation costs the same.
    """

    def __init__(self, cost: Floats, cutter: Ints, setup: Ints, costs: Costs, turning: Turning | None = None) -> None:
        self.cost, self.cutter, self.setup, self.costs, self.turning = cost, cutter, setup, costs, turning
        #: Of some uses, each a setup and a cutter, what each other one costs beside them.
        self._more = dict[frozenset[tuple[int, int]], Floats]()
        finite = cost[np.isfinite(cost)]
        #: Costs more than any choice.
        self.dear = float(cost.min(axis=1, initial=np.inf).sum() + finite.max(initial=0.0) * len(cost)) + 10.0 * sum(
            (costs.operation, costs.cutter, costs.setup)
        )

    def total(self, chosen: Which) -> float:
        """Sum up the costs of a choice; infinite where it leaves a sample."""
        if not len(chosen):
            return 0.0 if not len(self.cost) else np.inf
        return self.priced(chosen, self.cost[:, chosen].min(axis=1, initial=np.inf))

    def priced(self, chosen: Which, samples: Floats) -> float:
        """As `total`, for a choice with which the samples (n,) are known to cost so much."""
        if not len(chosen):
            return self.total(chosen)
        return float(samples.sum()) + self.costs.operation * len(chosen) + self.costs.between(self._uses(chosen))

    def turned(self, chosen: Which) -> float:
        """As `total`, but with what the rotary axes take in truth."""
        if self.turning is None or not len(chosen):
            return self.total(chosen)
        return self.cutting(chosen) + self.turning.together(chosen) + self.costs.between(self._uses(chosen))

    def _uses(self, chosen: Which) -> frozenset[tuple[int, int]]:
        return frozenset(zip(self.setup[chosen].tolist(), self.cutter[chosen].tolist(), strict=True))

    def further(self, uses: frozenset[tuple[int, int]]) -> Floats:
        """Price what each candidate (m,) adds in changes of cutters and in setups to some uses, each a setup and a cutter."""
        if uses not in self._more:
            now, shape = self.costs.between(uses), (int(self.setup.max()) + 1, int(self.cutter.max()) + 1)
            self._more[uses] = np.array([self.costs.between(uses | {use}) - now for use in np.ndindex(shape)]).reshape(shape)
        return np.asarray(self._more[uses][self.setup, self.cutter])

    def cutting(self, chosen: Which) -> float:
        """Sum up the costs of the samples, each with the best of a choice."""
        return float(self.cost[:, chosen].min(axis=1, initial=np.inf).sum())

    def gains(self, now: Floats, rows: Which | None = None) -> Floats:
        """Sum up what each candidate (m,) saves on samples that cost so much now (n,), on some rows or all."""
        cost = self.cost if rows is None else self.cost[rows]
        saved = np.subtract((now if rows is None else now[rows])[:, None], cost)
        return np.asarray(np.maximum(0.0, saved, out=saved).sum(axis=0))

    def regained(self, gains: Floats, before: Floats, now: Floats) -> Floats:
        """Find gains for costs of now from those of before: only samples whose costs differ are looked at."""
        rows = np.flatnonzero(before != now)
        return gains + self.gains(now, rows) - self.gains(before, rows)

    def added(self, chosen: Which, gains: Floats) -> tuple[int, float]:
        """The candidate that saves most beside a choice, with its own costs, and how much."""
        gain = gains - self.costs.operation
        if len(chosen):
            gain -= self.further(self._uses(chosen))
        best = int(gain.argmax())
        return best, float(gain[best])

    def of(self, which: Which, rows: NDArray[np.bool_] | None = None) -> "Problem":
        """Some of the candidates, each of which costs the same, with the samples or some (n,) of them."""
        cost = self.cost[:, which] if rows is None else self.cost[np.ix_(rows, which)]
        return Problem(cost, self.cutter[which], self.setup[which], self.costs)


#: Rounds of leaving out and exchanging.
_ROUNDS = 12
#: Costs looked at for the bound, at most, and a gap at which it is good enough, as a share.
_WORK, _CLOSE = 10**9, 0.01
#: Steps of prices for all cutters and setups; cutters and setups whose sets are told apart, together.
_FIRST, _KINDS = 80, 7
#: Part of the newest direction in the mean; what counts as a gain, as a share; steps without one until they are made shorter, and
#: by how much, down to what; a share of candidates left for which the others are dropped.
_NEWEST, _GAIN, _PATIENT, _SHORTER, _SHORTEST, _FEWER = 0.2, 2e-4, 8, 0.7, 1e-3, 0.8
#: Steps of prices by which candidates are compared, and so many of each cutter that stay, beside the best of each sample.
_PRICED, _PROMISING = 40, 60
#: Seconds that count as nothing.
_NOTHING = 1e-9


def against_bound(seconds: float, bound: float, at_best: float, samples: int, candidates: int) -> FastestEntry:
    """How good the fastest plan is, by some samples; seconds are nan where a width is not known.

    No plan that is printed takes less than the best of the candidates: its seconds bound that from above. Simultaneous motion,
    which is no candidate, may bring a plan below: then the gap is 0.
    """
    known, bound = bool(np.isfinite(seconds)), float(min(bound, np.nan_to_num(seconds, nan=np.inf)))
    gap = max(0.0, seconds / bound - 1.0) if bound > 0.0 else 0.0
    return FastestEntry(seconds=seconds if known else None, bound_seconds=bound, at_best_seconds=min(at_best, bound),
                        gap=gap if known else None, samples=samples, candidates=candidates)  # fmt: skip


def cheap(problem: Problem, start: Which | None = None) -> Which:
    """Choose operations of little cost, from a choice that serves all or from nothing."""
    covers = [_improved(problem, _grown(problem, np.zeros(0, np.int64)))]
    if start is not None and len(start):
        covers.append(_improved(problem, _grown(problem, start)))
    for cutter in np.unique(problem.cutter).tolist():
        # Another cutter may not be worth its change, though the first steps take it.
        own = np.flatnonzero(problem.cutter == cutter)
        if len(own) < len(problem.cutter) and np.isfinite(problem.cost[:, own]).any(axis=1).all():
            part = problem.of(own)
            covers.append(own[_improved(part, _grown(part, np.zeros(0, np.int64)))])
    return np.sort(min(covers, key=problem.total))


def promising(problem: Problem, chosen: Which) -> Which:
    """The candidates that a good choice may have, ascending, by prices of the samples: those `chosen` are among them.

    These are the best of each sample, and of each cutter those that gain most where each sample pays its price. A sample that the
    choice leaves has none.
    """
    pays = np.isfinite(problem.cost[:, chosen].min(axis=1, initial=np.inf))
    paying = problem if pays.all() else problem.of(np.arange(len(problem.cutter)), pays)
    table, operation, most = np.ascontiguousarray(paying.cost.T), problem.costs.operation, paying.total(chosen)
    nothing, same = np.zeros(len(table)), np.zeros(len(table), np.int64)
    ascent = _Ascent(table, operation, 0.0, _shares(paying, chosen), nothing, same)
    for _ in range(_PRICED):
        if ascent.over:
            break
        ascent.step(most)
    reduced, picked = lagrange(paying.cost.T, operation, ascent.price)[1], [chosen, problem.cost.argmin(axis=1)]
    for cutter in np.unique(problem.cutter).tolist():
        own = np.flatnonzero(problem.cutter == cutter)
        picked.append(own[np.argsort(reduced[own], kind="stable")[:_PROMISING]])
    return np.unique(np.concatenate(picked))


def _shares(problem: Problem, chosen: Which) -> Floats:
    """What each sample costs with a choice, with its share of the operation that cuts it: prices to begin with."""
    which, now = problem.cost[:, chosen].argmin(axis=1), problem.cost[:, chosen].min(axis=1)
    return np.asarray(now + problem.costs.operation / np.bincount(which, minlength=len(chosen))[which])


def _now(problem: Problem, chosen: Which) -> Floats:
    """What each sample costs with a choice; dear where nothing serves it."""
    if not len(chosen):
        return np.full(len(problem.cost), problem.dear)
    return np.minimum(problem.dear, problem.cost[:, chosen].min(axis=1))


def _grown(problem: Problem, chosen: Which) -> Which:
    """A choice with candidates added as long as one saves something."""
    now = _now(problem, chosen)
    gains = problem.gains(now)
    while True:
        best, gain = problem.added(chosen, gains)
        if gain <= _NOTHING or best in chosen:
            return chosen
        chosen = np.append(chosen, best)
        before, now = now, np.minimum(now, problem.cost[:, best])
        gains = problem.regained(gains, before, now)


def _improved(problem: Problem, chosen: Which) -> Which:
    """A choice of which leaving out or exchanging one candidate saves nothing more."""
    cost, now = problem.total(chosen), _now(problem, chosen)
    gains, without = problem.gains(now), _Without.of(problem, chosen)
    for _ in range(_ROUNDS):
        before = cost
        for candidate in chosen.tolist():
            rest = chosen[chosen != candidate]
            samples = without.cost(candidate)
            total, other, samples_then = problem.priced(rest, samples), rest, samples
            if not total < cost - _NOTHING:
                best, _gain = problem.added(rest, problem.regained(gains, now, np.minimum(problem.dear, samples)))
                other, samples_then = np.append(rest, best), np.minimum(samples, problem.cost[:, best])
                total = problem.priced(other, samples_then)
            if total < cost - _NOTHING:
                chosen, cost, without = other, total, _Without.of(problem, other)
                last, now = now, np.minimum(problem.dear, samples_then)
                gains = problem.regained(gains, last, now)
        if cost >= before - _NOTHING:
            break
    return chosen


@dataclass(frozen=True, slots=True, eq=False)
class _Without:
    """What samples (n,) cost without one of a choice.

    `best` (n,) int64: the candidate of the choice that is the best for each. `first`, `second` (n,) float: what it costs, and the
    next best one; infinite where there is none.
    """

    best: Which
    first: Floats
    second: Floats

    @classmethod
    def of(cls, problem: Problem, chosen: Which) -> "_Without":
        own = problem.cost[:, chosen]
        if not len(chosen):
            nothing = np.full(len(own), np.inf)
            return cls(np.full(len(own), -1, np.int64), nothing, nothing)
        best = own.argmin(axis=1)
        first = own[np.arange(len(own)), best]
        own[np.arange(len(own)), best] = np.inf
        return cls(chosen[best], first, own.min(axis=1))

    def cost(self, candidate: int) -> Floats:
        """That of all samples without a candidate."""
        return np.where(self.best == candidate, self.second, self.first)


def exchanged(problem: Problem, chosen: Which) -> Which:
    """A choice of as many candidates that serves all as well, of which exchanging one saves nothing more."""
    cost = problem.cutting(chosen)
    for _ in range(_ROUNDS):
        before = cost
        for candidate in chosen.tolist():
            rest = chosen[chosen != candidate]
            now = problem.cost[:, rest].min(axis=1, initial=np.inf)
            total = np.minimum(now[:, None], problem.cost).sum(axis=0)
            other = int(total.argmin())
            if total[other] < cost - _NOTHING:
                chosen, cost = np.append(rest, other), float(total[other])
        if cost >= before - _NOTHING:
            break
    return np.sort(chosen)


@dataclass(frozen=True, slots=True, eq=False)
class Reach:
    """The operations of one cutter in one setup cost at least as much together as the candidate that costs most.

    `least` (m,) float: by candidate, ascending in each group. `first` (g,) int64: of each group, its first candidate.
    """

    least: Floats
    first: Which

    @classmethod
    def of(cls, least: Floats, group: Which) -> "Reach":
        """That of candidates in the order of their groups."""
        return cls(least, np.flatnonzero(np.diff(group, prepend=-1)))

    def gained(self, reduced: Floats) -> tuple[float, NDArray[np.bool_]]:
        """Sum up what candidates gain together at most, 0 or less, and say which (m,) do, by their reduced costs (m,)."""
        value, taken = 0.0, np.zeros(len(reduced), bool)
        for low, high in pairwise([*self.first.tolist(), len(reduced)]):
            gain = np.cumsum(np.minimum(0.0, reduced[low:high])) + self.least[low:high]
            last = int(gain.argmin())
            if gain[last] < 0.0:
                value += float(gain[last])
                taken[low : low + last + 1] = reduced[low : low + last + 1] < 0.0
        return value, taken


def lagrange(cost: Floats, operation: float, price: Floats, reach: Reach | None = None) -> tuple[float, Floats, Floats]:
    """Bound what any choice costs that pays for its samples and operations alone, by prices (n,) of samples.

    Whatever the prices, a choice pays for each sample its price, less what its candidates gain on that: what they can gain at
    most leaves the bound.

    Returns the bound; (m,) float: reduced costs of the candidates: those below 0 gain something; (n,) float: how much more often
    than once the candidates that gain serve each sample, below 0 where none does.

    `cost` (m, n) float: of each sample with each candidate. `operation`: what each candidate costs beside. `price` (n,) float.
    `reach`: what some candidates cost together at least, beside.
    """
    gain = np.subtract(cost, price)
    np.minimum(gain, 0.0, out=gain)
    reduced = operation + gain.sum(axis=1)
    if reach is None:
        value, taken = float(np.minimum(0.0, reduced).sum()), reduced < 0.0
    else:
        value, taken = reach.gained(reduced)
    # Large prices of both signs cancel: what the sums may be wrong by leaves the bound, too.
    wrong = np.finfo(float).eps * (len(price) + len(reduced)) * float(np.abs(price).sum() + np.abs(reduced).sum())
    return float(price.sum()) + value - wrong, reduced, (gain[taken] < 0.0).sum(axis=0) - 1.0


class _Ascent:
    """Prices of samples that are made better step by step, for choices of some cutters and some setups.

    Each step raises prices of samples that the candidates taken do not serve, and lowers those that several of them serve; its
    length follows from how far the bound is from a choice that is known.

    `bound`: of choices with all these cutters and setups. `work`: costs looked at.
    """

    def __init__(self, cost: Floats, operation: float, base: float, price: Floats, reach: Floats, group: Which) -> None:
        self._cost, self._operation, self._base, self.price = cost, operation, base, price
        self._least, self._group, self._reach = reach, group, Reach.of(reach, group)
        self._mean, self._length, self._waited = np.zeros(len(price)), 1.0, 0
        self.bound, self.work, self.over = -np.inf, 0, not len(cost)

    def step(self, most: float) -> None:
        """Make the prices better, below a cost that a choice has."""
        price = self.price
        if np.isfinite(self.bound):
            far = most - self.bound + 2e-3 * abs(most)
            price = price + self._length * far / max(1e-300, float(self._mean @ self._mean)) * self._mean
        value, reduced, often = lagrange(self._cost, self._operation, price, self._reach)
        value += self._base
        direction = -often
        self._mean = _NEWEST * direction + (1.0 - _NEWEST) * self._mean if np.isfinite(self.bound) else direction
        self._waited = 0 if value > self.bound + _GAIN * abs(most) else self._waited + 1
        if value > self.bound:
            self.bound, self.price = value, price
        if self._waited >= _PATIENT:
            self._length, self._waited = _SHORTER * self._length, 0
        self.work += self._cost.size
        self.over = self._length < _SHORTEST or not self._mean.any()
        # With one of the others any choice costs more than that: they are in no better choice.
        some = value + np.maximum(0.0, reduced) <= most + _NOTHING
        if 0.0 < some.mean() < _FEWER:
            self._cost, self._least, self._group = self._cost[some], self._least[some], self._group[some]
            self._reach = Reach.of(self._least, self._group)


def bounded(problem: Problem, chosen: Which) -> float:
    """Bound what any choice costs by one: the least over all sets of cutters and setups of what choices with these cost.

    The set whose bound is the least is worked on until it is near to the choice.
    """
    if not len(problem.cost):
        return min(0.0, problem.turned(chosen))
    most, costs, turning = problem.turned(chosen), problem.costs, problem.turning
    first = _shares(problem, chosen)
    reach = np.zeros(len(problem.cutter)) if turning is None else turning.reach
    operation = costs.operation if turning is None else 0.0
    group = np.unique(np.column_stack([problem.cutter, problem.setup]), axis=0, return_inverse=True)[1].reshape(-1)
    order = np.lexsort((reach, group))
    table, reach, group = np.ascontiguousarray(problem.cost.T[order]), reach[order], group[order]
    whole = _Ascent(table, operation, 0.0, first, reach, group)
    for _ in range(_FIRST):
        if whole.over or whole.bound >= most * (1.0 - _CLOSE):
            break
        whole.step(most)
    open_ = list[_Ascent]()
    for base, inside in _sets(problem):
        selected = inside[order]
        served = np.isfinite(table[selected]).any(axis=0).all()
        if served and base + whole.bound < most:
            open_.append(_Ascent(table[selected], operation, base, whole.price, reach[selected], group[selected]))
            open_[-1].step(most)
    work = 0
    while open_:
        least = min(open_, key=lambda each: each.bound)
        if least.over or least.bound >= most * (1.0 - _CLOSE) or work > _WORK:
            return min(most, max(whole.bound, least.bound))
        before = least.work
        least.step(most)
        work += least.work - before
    return most


def _sets(problem: Problem) -> Iterator[tuple[float, NDArray[np.bool_]]]:
    """Of each set of cutters and setups what those after the first cost at least, and which candidates (m,) it has.

    Where there are too many sets, one stands for all: that with all candidates, for which nothing is paid.
    """
    kinds = [np.unique(problem.cutter), np.unique(problem.setup)]
    if sum(len(each) for each in kinds) > _KINDS:
        yield 0.0, np.ones(len(problem.cutter), bool)
        return
    some = [[set_ for k in range(1, len(each) + 1) for set_ in combinations(each.tolist(), k)] for each in kinds]
    for cutters, setups in product(*some):
        base = problem.costs.cutter * (len(cutters) - 1) + problem.costs.setup * (len(setups) - 1)
        yield base, np.isin(problem.cutter, cutters) & np.isin(problem.setup, setups)
