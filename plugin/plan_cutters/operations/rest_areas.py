"""Tell what each cutter of a plan is worth, and choose by a shop's habit, from which the fastest plan is looked for, too."""

from collections.abc import Iterator, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from plan_cutters.domain.cutter import Cutter
from plan_cutters.domain.preference import by_radius
from plan_cutters.operations.fastest import cheap
from plan_cutters.operations.problem import Problem
from plan_cutters.operations.task import Task
from plan_cutters.outcome import OperationPlan

Rows = NDArray[np.int64]


class Worth(NamedTuple):
    """A cutter is worth this beside the others that were compared.

    Attributes
    ----------
    cutter : Cutter
    only : (n,) int64
        Samples that none of the others reaches.
    saves : float, optional
        Seconds by which the fastest plan found with it is below the fastest one without it, before its own change; None where
        no plan without it was found.
    change : float
        Seconds that its change costs: 0 where it is the only one then.
    """

    cutter: Cutter
    only: Rows
    saves: float | None
    change: float


def by_size(task: Task) -> list[int]:
    """Numbers of the cutters, the largest first."""
    return [task.cutters.index(cutter) for cutter in by_radius(task.cutters)]


def largest_first(problem: Problem, order: Sequence[int]) -> Rows:
    """Choose by the habit of a shop: each cutter, the largest first, takes all that it serves of what is left, but for crumbs.

    Crumbs are what a cutter cuts in one orientation in less time than that takes to turn to, if a smaller cutter serves it:
    nobody turns a large cutter there.

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
    open_columns, picked = np.ones(len(problem.cost), bool), list[int]()
    for place, cutter in enumerate(order):
        own = np.flatnonzero(problem.cutter == cutter)
        later = np.flatnonzero(np.isin(problem.cutter, order[place + 1 :]))
        mine = open_columns & np.isfinite(problem.cost[:, own]).any(axis=1)
        if not mine.any():
            continue
        part = problem.of(own, mine)
        again = np.asarray(np.isfinite(problem.cost[np.ix_(mine, later)]).any(axis=1))
        chosen = own[_without_minor_areas(part, cheap(part), again)]
        open_columns &= ~np.isfinite(problem.cost[:, chosen]).any(axis=1)
        picked += chosen.tolist()
    return np.sort(np.array(picked, np.int64))


def _without_minor_areas(problem: Problem, chosen: Rows, again: NDArray[np.bool_]) -> Rows:
    """A choice without candidates that cut less than they cost: `again` (n,) are samples that something else serves later."""
    while len(chosen):
        cost = problem.cost[:, chosen]
        serves = np.isfinite(cost)
        there = serves.any(axis=1)
        cuts = np.bincount(cost.argmin(axis=1)[there], cost[there].min(axis=1), len(chosen))
        needed = serves[(serves.sum(axis=1) == 1) & ~again].any(axis=0)
        minor = np.flatnonzero((cuts < problem.costs.operation) & ~needed)
        if not len(minor):
            break
        chosen = np.delete(chosen, minor[cuts[minor].argmin()])
    return chosen


def _reached(task: Task, cutter: int) -> NDArray[np.bool_]:
    """Samples (n,) that a cutter reaches in one of the setups."""
    return np.asarray(np.logical_or.reduce([verdicts[task.cutters[cutter]].reached for verdicts in task.everywhere]))


def worths(task: Task, plans: Sequence[OperationPlan]) -> tuple[Worth, ...]:
    """Compare the fastest of some plans with each cutter and without it; none for a single cutter, or where no time is known."""
    plans = [plan for plan in plans if np.isfinite(plan.total)]
    if len(task.cutters) < 2 or not plans:
        return ()
    reached = [_reached(task, c)[task.rows] for c in range(len(task.cutters))]
    result = []
    for c in by_size(task):
        others = np.logical_or.reduce([mine for k, mine in enumerate(reached) if k != c])
        saves, change = _saves(plans, task.cutters[c], task.ready.options.change_time)
        result.append(Worth(task.cutters[c], task.rows[reached[c] & ~others], saves, change))
    return tuple(result)


def _saves(plans: Sequence[OperationPlan], cutter: Cutter, change: float) -> tuple[float | None, float]:
    """Seconds that a cutter saves before its change, and what that costs."""
    used = [(plan.total, {each.cutter for each in plan.operations}) for plan in plans]
    with_it = [(seconds, len(cutters)) for seconds, cutters in used if cutter in cutters]
    without = [seconds for seconds, cutters in used if cutter not in cutters]
    if not with_it:
        return 0.0, change
    best, cutters = min(with_it)
    # The first cutter is there anyway.
    change = change if cutters > 1 else 0.0
    return (max(0.0, min(without) - best + change) if without else None), change


def with_and_without(problem: Problem, chosen: Rows) -> Iterator[Rows]:
    """Choices to compare a choice with: for each cutter of it the best of the others, for each other one the best with it."""
    for cutter in np.unique(problem.cutter).tolist() if len(chosen) else []:
        others = np.flatnonzero(problem.cutter != cutter)
        if not (problem.cutter[chosen] == cutter).any():
            yield _with(problem, chosen, cutter)
        elif len(others) and np.isfinite(problem.cost[:, others]).any(axis=1).all():
            yield others[cheap(problem.of(others), np.flatnonzero(np.isin(others, chosen)))]


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
