"""Rest areas: what larger cutters leave for smaller ones, what a shop's habit costs, and what each cutter is worth."""

import numpy as np
from numpy.typing import NDArray

from plan_cutters.domain.columns import Columns
from plan_cutters.domain.operations import Worth
from plan_cutters.operations.cover import fewest
from plan_cutters.operations.fastest import Problem, cheap
from plan_cutters.operations.fewest import Search
from plan_cutters.operations.plans import Task

Rows = NDArray[np.int64]
#: Rounds in which samples that a cutter's orientations leave join the table, and samples that join it at once.
_ROUNDS, _MORE = 6, 120


def by_size(task: Task) -> list[int]:
    """Numbers of the cutters, the largest first; of equal radii the one with the larger corner, which leaves wider strips."""
    return sorted(
        range(len(task.cutters)), key=lambda c: (-task.cutters[c].radius, -task.cutters[c].corner_radius, task.cutters[c].id)
    )  # fmt: skip


def largest_first(task: Task, search: Search, fewest_columns: Columns) -> Columns:
    """The columns of a shop's habit: each cutter, the largest first, takes all that it serves of what is left.

    It does so with few orientations. What no cutter's candidates serve in its turn goes with the columns of the fewest plan.
    """
    left = np.setdiff1d(task.rows, search.alone)
    found = fewest_columns.of(np.zeros(0, np.int64))
    for c in by_size(task):
        own, left = _own(task, search, c, left)
        found = found.and_(own)
    while len(left):
        serves = task.probes.table(left, fewest_columns)
        best = int(serves.sum(axis=0).argmax())
        if not serves[:, best].any():
            break
        found, left = found.and_(fewest_columns.of(np.array([best]))), left[~serves[:, best]]
    return found


def _reached(task: Task, cutter: int) -> NDArray[np.bool_]:
    """Samples (n,) that a cutter reaches in one of the setups."""
    return np.asarray(np.logical_or.reduce([verdicts[task.cutters[cutter]].reached for verdicts in task.everywhere]))


def _own(task: Task, search: Search, cutter: int, left: Rows) -> tuple[Columns, Rows]:
    """Few columns of one cutter for what is left, and what is left then."""
    reached = _reached(task, cutter)
    for _ in range(_ROUNDS):
        active, table = search.whole
        mine = search.columns.cutter[active] == cutter
        columns = search.columns.of(active[mine])
        some = table[np.isin(search.rows, left)][:, mine]
        some = some[some.any(axis=1)]
        chosen = columns.of(fewest(some, prove=False).chosen)
        served = np.asarray(task.probes.table(left, chosen).any(axis=1))
        missed = left[~served & reached[left] & ~np.isin(left, search.rows)]
        if not len(missed):
            break
        search.require(missed[:: max(1, len(missed) // _MORE)])
    return chosen, left[~served]


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
