"""Rest areas: what larger cutters leave for smaller ones, what a shop's habit costs, and what each cutter is worth."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from plan_cutters.domain.columns import Columns
from plan_cutters.domain.operations import Worth
from plan_cutters.operations.fastest import Problem, cheap
from plan_cutters.operations.plans import Task

Rows = NDArray[np.int64]


def by_size(task: Task) -> list[int]:
    """Numbers of the cutters, the largest first; of equal radii the one with the larger corner, which leaves wider strips."""
    return sorted(
        range(len(task.cutters)), key=lambda c: (-task.cutters[c].radius, -task.cutters[c].corner_radius, task.cutters[c].id)
    )  # fmt: skip


def largest_first(problem: Problem, order: Sequence[int]) -> Rows:
    """Choose by the habit of a shop: each cutter, the largest first, takes what it serves of what is left, as far as that pays.

    An orientation of a cutter pays if it serves what no smaller one does, or if it cuts all that it serves of what is left so
    much faster than the smaller cutters would by themselves that this makes up for the orientation. Changes of cutters are not
    looked at: that is what makes it a habit.

    Parameters
    ----------
    problem : Problem
    order : sequence of int
        Numbers of the cutters, the largest first.

    Returns
    -------
    (k,) int64
        Candidates, ascending, that serve all samples.
    """
    left, found = np.ones(len(problem.cost), bool), list[int]()
    for place, cutter in enumerate(order):
        own = np.flatnonzero(problem.cutter == cutter)
        later = np.flatnonzero(np.isin(problem.cutter, order[place + 1 :]))
        serves = np.isfinite(problem.cost[:, own])
        alone = left & serves.any(axis=1) & ~np.isfinite(problem.cost[:, later]).any(axis=1)
        chosen = cheap(problem.of(own, alone)) if alone.any() else np.zeros(0, np.int64)
        left &= ~serves[:, chosen].any(axis=1)
        for one in _paying(problem, own, later, left & serves.any(axis=1)):
            chosen = np.append(chosen, one)
            left &= ~serves[:, one]
        found += own[chosen].tolist()
    return np.sort(np.array(found, np.int64))


def _paying(problem: Problem, own: Rows, later: Rows, left: NDArray[np.bool_]) -> list[int]:
    """Which of a cutter's candidates pay against those of smaller cutters, one after the other, for samples that both serve."""
    found = list[int]()
    if not left.any():
        return found
    smaller = problem.of(later, left)
    then = smaller.cost[:, cheap(smaller)].min(axis=1)
    cost = problem.cost[np.ix_(left, own)]
    serves = np.isfinite(cost)
    gain = np.where(serves, then[:, None] - cost, 0.0)
    while True:
        saved = gain.sum(axis=0) - problem.costs.operation
        best = int(saved.argmax())
        if saved[best] <= 0.0:
            return found
        found.append(best)
        gain[serves[:, best]] = 0.0


def _reached(task: Task, cutter: int) -> NDArray[np.bool_]:
    """Samples (n,) that a cutter reaches in one of the setups."""
    return np.asarray(np.logical_or.reduce([verdicts[task.cutters[cutter]].reached for verdicts in task.everywhere]))


def allowed(task: Task, columns: Columns, serves: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Which columns (n, k) a sample may go with by the habit: those of the largest cutter that serves it."""
    rank = np.empty(len(task.cutters), np.int64)
    rank[by_size(task)] = np.arange(len(task.cutters))
    place = np.where(serves, rank[columns.cutter], len(task.cutters))
    return np.asarray(serves & (place == place.min(axis=1, initial=len(task.cutters))[:, None]))


def worths(task: Task, problem: Problem, chosen: Rows) -> tuple[Worth, ...]:
    """Compare the best choices that are found with each cutter and without it; none for a single cutter."""
    if len(task.cutters) < 2:
        return ()
    cutters = task.cutters
    reached = [_reached(task, c)[task.rows] for c in range(len(cutters))]
    found = []
    for c in by_size(task):
        others = np.logical_or.reduce([reached[k] for k in range(len(cutters)) if k != c])
        saves, change = _saves(problem, chosen, c)
        found.append(Worth(cutters[c], task.rows[reached[c] & ~others], saves, change))
    return tuple(found)


def _saves(problem: Problem, chosen: Rows, cutter: int) -> tuple[float | None, float]:
    """Seconds that a cutter saves before its change, and what that costs."""
    others = np.flatnonzero(problem.cutter != cutter)
    if not np.isfinite(problem.cost[:, others]).any(axis=1).all():
        return None, problem.costs.cutter if len(others) else 0.0
    without = problem.of(others)
    start = np.flatnonzero(np.isin(others, chosen))
    least = without.total(cheap(without, start))
    used = np.flatnonzero(problem.cutter[chosen] == cutter)
    # Where the best choice has none of it, all its orientations are tried beside that choice.
    best = chosen if len(used) else _with(problem, chosen, cutter)
    change = problem.costs.cutter if len(np.unique(problem.cutter[best])) > 1 else 0.0
    return max(0.0, least - problem.total(best) + change), change


def _with(problem: Problem, chosen: Rows, cutter: int) -> Rows:
    """A choice with the orientations of a cutter that save most, though its change may cost more."""
    own = np.flatnonzero(problem.cutter == cutter)
    while len(own):
        now = problem.cost[:, chosen].min(axis=1)
        gain = np.maximum(0.0, now[:, None] - problem.cost[:, own]).sum(axis=0) - problem.costs.operation
        if gain.max() <= 0.0:
            break
        chosen = np.append(chosen, own[int(gain.argmax())])
    for each in chosen[problem.cutter[chosen] != cutter].tolist():
        rest = chosen[chosen != each]
        if problem.total(rest) < problem.total(chosen):
            chosen = rest
    return chosen
