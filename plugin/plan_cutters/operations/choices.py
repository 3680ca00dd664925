"""Choices of columns: made by some samples, tested at more of them, made again by what they leave, and compared with others: by a
shop's habit, without each cutter, with other cutters at the same orientations, with one orientation more.
"""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from plan_cutters.domain.cutter import Cutter
from plan_cutters.domain.operations import Columns
from plan_cutters.domain.preference import by_radius
from plan_cutters.operations.fastest import Problem, cheap, exchanged, promising
from plan_cutters.operations.fewest import Search
from plan_cutters.operations.labels import LEAST_SHARE, MINOR_SHARE
from plan_cutters.operations.orientations import STEP
from plan_cutters.operations.plans import MINOR_AREA, changes_of, costs_with, moving_over, plan_with, worth_their_turn
from plan_cutters.operations.task import Task, at_some, shared_area
from plan_cutters.outcome import OperationPlan
from plan_cutters.plan_file.operations import OneMoreEntry
from plan_cutters.scene.work import Progress

Rows = NDArray[np.int64]


#: Samples at which orientations in place of motion are compared, at most about; one with this share of what the best takes is
#: as good.
_ALIKE, _NEARLY = 200, 0.9


class Worth(NamedTuple):
    """A cutter is worth this beside the others that were compared.

    `only` (n,) int64: samples that none of the others reaches. `saves`: seconds by which the fastest plan found with it is below
    the fastest one without it, before its own changes; None where no plan without it was found. `change`: seconds that its
    changes cost: 0 where it is the only one then.
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

    `order`: numbers of the cutters, the largest first. Returns (k,) int64: candidates, ascending, that serve all samples.
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


def worths(task: Task, plans: Sequence[OperationPlan]) -> tuple[Worth, ...]:
    """Compare the fastest of some plans with each cutter and without it; none for a single cutter, or where no time is known."""
    plans = [plan for plan in plans if np.isfinite(plan.total)]
    if len(task.cutters) < 2 or not plans:
        return ()
    reached = [np.logical_or.reduce([its[cutter].reached for its in task.everywhere])[task.rows] for cutter in task.cutters]
    result = []
    for c in by_size(task):
        others = np.logical_or.reduce([mine for k, mine in enumerate(reached) if k != c])
        saves, change = _saves(task, plans, task.cutters[c])
        result.append(Worth(task.cutters[c], task.rows[reached[c] & ~others], saves, change))
    return tuple(result)


def _saves(task: Task, plans: Sequence[OperationPlan], cutter: Cutter) -> tuple[float | None, float]:
    """Seconds that a cutter saves before its changes, and what these cost."""
    change = task.ready.options.change_time
    with_it = [plan for plan in plans if any(each.cutter == cutter for each in plan.operations)]
    without = [plan.total for plan in plans if all(each.cutter != cutter for each in plan.operations)]
    if not with_it:
        return 0.0, change
    best = min(with_it, key=lambda plan: plan.total)
    others = [each for each in best.operations if each.cutter != cutter]
    change *= changes_of(task, best.operations) - changes_of(task, others)
    return (max(0.0, min(without) - best.total + change) if without else None), change


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


#: Samples all over the part by which plans are compared, and more by which the fastest is found; rounds until it serves all.
_EVEN, _TIMED, _ROUNDS = 250, 600, 12
#: Samples that a choice leaves that are taken into the next one, at most.
_MORE = 120
#: Spacing of the first candidates for the fastest, and spacings of those that are laid about a choice then, rad.
COARSE, _FINER = 2.0 * STEP, (STEP, 0.5 * STEP)
#: Tries to exchange the fewest for as many that cut faster.
_TRIES = 4


@dataclass(frozen=True, slots=True, eq=False)
class Choice:
    """Columns that were chosen among others.

    `columns`: all that were compared.
    `problem`: what samples cost with them.
    `rows` (n,) int64: these samples.
    `area`: that they stand for, mm2.
    `chosen`, `known` (k,) int64: the choice, and a choice that was known before: of the columns.
    `whole`: whether the choice serves all samples that it was tested at.
    """

    columns: Columns
    problem: Problem
    rows: Rows
    area: float
    chosen: Rows
    known: Rows
    whole: bool

    @property
    def safe(self) -> Rows:
        """The choice, with what was known before where it leaves samples."""
        return self.chosen if self.whole else np.union1d(self.chosen, self.known)


def quicker(task: Task, search: Search, fewest: Columns) -> Columns:
    """As many columns that cut faster, if they serve all samples as well; else the same."""

    def choose(problem: Problem, known: Rows) -> Rows:
        priced = np.isfinite(problem.cost[:, known]).any(axis=1).all()
        return exchanged(problem, known) if priced else known

    tested = _tested(task, search, fewest, choose, _TRIES)
    return tested.columns.of(tested.chosen) if tested.whole else fewest


def served(task: Task, search: Search) -> Columns:
    """Few columns that serve all samples of a task; candidates that no good choice has by the first samples are dropped."""
    first = search.begin()
    columns, problem, _ = _problem(task, search, first)
    search.narrow(columns.of(promising(problem, np.flatnonzero(np.isin(columns.key, first.key)))))
    few = search.solve(prove=False)
    return search.columns.of(few.chosen)


def fastest_choice(task: Task, some: Task, search: Search, fewest: Columns, tell: Progress) -> Choice:
    """A choice of columns of least time; candidates are laid about what is chosen.

    It is tested at some samples of a task, and in the end at all of them if it is one of few columns. The progress is told.
    """
    minor, levels = some is not task, _FINER if task.ready.options.index_step is None else ()
    choice = _tested(some, search, fewest, cheap, _ROUNDS, minor=minor)
    for done, spacing in enumerate(levels, 1):
        tell(done, len(levels) + 2)
        search.surround(choice.columns.of(choice.safe), spacing, task.orientations)
        choice = _tested(some, search, choice.columns.of(choice.safe), cheap, _ROUNDS, minor=minor)
    tell(len(levels) + 1, len(levels) + 2)
    # Of more orientations than are recommended some go, and what they serve: what they leave beside that does not matter.
    few = len(choice.safe) <= task.ready.options.max_orientations
    if minor and few and len(rest := _remaining(task, choice.columns.of(choice.safe), search, minor=True)):
        search.require(_few(rest))
        choice = _tested(some, search, choice.columns.of(choice.safe), cheap, _ROUNDS, minor=True)
    return choice


def largest_first_choice(task: Task, search: Search, fewest: Columns, *, minor: bool) -> Columns:
    """Columns of the habit to let the largest cutter go first; what they leave goes with the fewest.

    `minor`: what they leave may be a minor part of the area.
    """
    order = by_size(task)
    tested = _tested(task, search, fewest, lambda p, _: largest_first(p, order), _TRIES, minor=minor)
    return tested.columns.of(tested.safe)


def _problem(task: Task, search: Search, fewest: Columns) -> tuple[Columns, Problem, float]:
    """The candidates that are known whole, what the samples of a search cost with each, and the area that these stand for.

    Where the rotary axes have rates, an orientation counts in the choice what it takes in the mean of the fewest.
    """
    indexing = task.indexing
    wanted = np.setdiff1d(task.rows, search.alone)
    active, table = search.whole
    columns, area = search.columns.of(active), shared_area(task.ready.samples, wanted, search.rows)
    mean = indexing.constant if indexing.rate is None else indexing.together(fewest) / max(1, len(fewest))
    problem = task.problem(columns, active, table, search.rows, area, task.costs(mean))
    return columns, problem, float(area.sum())


def _tested(
    task: Task, search: Search, fewest: Columns, choose: Callable[[Problem, Rows], Rows], rounds: int, *, minor: bool = False
) -> Choice:
    """Choose columns by samples that candidates are known at, and test them at those of a task.

    What they leave joins these samples, and it is chosen again; with `minor`, they may leave a minor part of the area.
    """
    most = _EVEN if task.ready.options.operations == "fewest" else _TIMED
    while True:
        # Samples all over the part.
        wanted = np.setdiff1d(task.rows, search.alone)
        search.require(wanted[:: max(1, len(wanted) // most)])
        columns, problem, area = _problem(task, search, fewest)
        known = np.flatnonzero(np.isin(columns.key, fewest.key))
        chosen, rounds = choose(problem, known), rounds - 1
        rest = _remaining(task, columns.of(chosen), search, minor=minor)
        if not len(rest) or not rounds:
            return Choice(columns, problem, search.rows, area, chosen, known, not len(rest))
        search.require(_few(rest))


def _remaining(task: Task, columns: Columns, search: Search, *, minor: bool) -> Rows:
    """Samples of a task that columns leave and other candidates do not; none where they are a `minor` part of the area."""
    rest = np.setdiff1d(task.rows[~task.probes.kept(task.rows, columns).any(axis=1)], search.alone)
    area = np.nan_to_num(task.ready.samples.area)
    return rest[:0] if minor and area[rest].sum() <= MINOR_AREA * area[task.rows].sum() else rest


def _few(rows: Rows) -> Rows:
    return rows[:: max(1, len(rows) // _MORE)]


def accompanied(task: Task, columns: Columns) -> Columns:
    """Columns with those of other cutters at the same orientations that save more time than they take.

    What is not worth its turn any more is left out. Without feeds, or with a most number of operations, all stays.
    """
    options = task.ready.options
    if task.paths.feed is None or options.most_operations is not None:
        return columns
    every = columns.and_(_others(task, columns))
    _, cost = costs_with(task, every)
    chosen, open_ = list(range(len(columns))), list(range(len(columns), len(every)))
    while open_:
        own = cost[:, chosen].min(axis=1, initial=np.inf)
        served = np.isfinite(own)
        saved = np.maximum(0.0, own[served, None] - cost[np.ix_(served, open_)]).sum(axis=0)
        spent = np.array([_turn(task, every, chosen, k) for k in open_])
        best = int((saved - spent).argmax())
        if saved[best] <= spent[best]:
            break
        chosen.append(open_.pop(best))
    return columns if len(chosen) == len(columns) else worth_their_turn(task, every.of(np.array(chosen, np.int64)))


def instead_of_motion(task: Task, columns: Columns, offered: Callable[[Rows], Columns]) -> Columns:
    """Columns with those of the plan's cutters and setups that take what minor steps of simultaneous motion would.

    Nobody programs all axes at once for a hundredth of the area, where a few orientations have it, each worth its turn, or one
    has all that is left. `offered`: candidates for some samples, those that one prefers first.
    """
    area = np.nan_to_num(task.ready.samples.area)
    if not task.may_move or not len(columns):
        return columns
    open_ = ~task.probes.kept(task.rows, task.images(columns)).any(axis=1)
    rest = task.rows[open_ if task.moved is None else open_ & ~task.moved[task.rows]]
    whole, motion = float(area[task.rows].sum()), moving_over(task, rest)
    kind = motion.setup * len(task.cutters) + motion.cutter
    size = np.bincount(kind, area[rest], len(task.everywhere) * len(task.cutters))
    rest, kind = (each[size[kind] < MINOR_SHARE * whole] for each in (rest, kind))
    # What is too little for a step is left where the plan is not finished anyway.
    least = LEAST_SHARE * whole if len(task.rows) < np.count_nonzero(task.ready.finished) else 0.0
    if area[rest].sum() <= least:
        return columns
    some = rest[:: 1 + len(rest) // _ALIKE]
    every, pairs = offered(some), columns.setup * len(task.cutters) + columns.cutter
    pair = every.setup * len(task.cutters) + every.cutter
    first = np.flatnonzero(np.isin(pair, pairs))
    every = every.of(np.append(first, np.flatnonzero(np.isin(pair, kind) & ~np.isin(pair, pairs))))
    serves, stands_for = task.table(some, every), area[some] * (area[rest].sum() / area[some].sum())
    while len(every) and stands_for.sum() > least:
        gain = stands_for @ serves
        if gain.max() < min(MINOR_AREA * whole, (1.0 - 1e-9) * stands_for.sum()):
            break
        best = int(np.argmax(gain >= (_NEARLY if gain.max() < stands_for.sum() else 1.0 - 1e-9) * gain.max()))
        columns, stands_for = columns.and_(every.of(np.array([best]))), np.where(serves[:, best], 0.0, stands_for)
    return columns


def _others(task: Task, columns: Columns) -> Columns:
    """The columns of all cutters at orientations of a choice that are not among it."""
    m, n = len(columns), len(task.cutters)
    every = replace(columns.of(np.repeat(np.arange(m), n)), cutter=np.tile(np.arange(n, dtype=np.int32), m))
    every = every.of(every.first)
    return every.of(np.flatnonzero(~np.isin(every.key, columns.key)))


def _turn(task: Task, every: Columns, chosen: list[int], k: int) -> float:
    """Seconds that a further column of some takes besides cutting: turning the part, and changing cutters."""
    before, after = (every.of(np.array(each, np.int64)) for each in (chosen, [*chosen, k]))
    turn, costs = task.indexing.together(after) - task.indexing.together(before), task.costs()
    now, then = (costs.between(zip(each.setup.tolist(), each.cutter.tolist(), strict=True)) for each in (before, after))
    return turn + then - now


#: Less is not worth a word, s and share of the plan's time; candidates that are planned with, at most.
_SECONDS, _SHARE, _TRIED_MORE = 60.0, 0.1, 5


def one_more(task: Task, some: Task, search: Search, plan: OperationPlan, columns: Columns) -> OneMoreEntry | None:
    """The orientation that saves most beside those of a plan, by plans with it and without it.

    `task`, `some`: of all samples, and of some, by which candidates are compared. `search`: its candidates that are known whole
    are tried. `columns`: those of its fixed operations. None where it would save no more than a minute, or a tenth of the time,
    or times are not known, or a number of orientations was requested.
    """
    least = max(_SECONDS, _SHARE * plan.total)
    options = task.ready.options
    if task.paths.feed is None or options.most_operations is not None or not plan.total > least or not len(columns):
        return None
    few, (active, table) = at_some(task, search.rows), search.whole
    area, now = costs_with(few, columns)
    costs = task.costs(task.indexing.constant if task.indexing.rate is None else 0.0)
    problem = task.problem(search.columns.of(active), active, table, search.rows, area, costs)
    cheapest = now.min(axis=1)
    served = np.flatnonzero(np.isfinite(cheapest))
    saved = problem.gains(np.where(np.isfinite(cheapest), cheapest, 0.0), served) - costs.operation
    saved -= problem.further(frozenset(zip(columns.setup.tolist(), columns.cutter.tolist(), strict=True)))
    best, seconds = None, plan_with(some, plan.name, columns, times=True).total
    for k in np.argsort(-saved, kind="stable")[:_TRIED_MORE].tolist():
        with_it = columns.and_(search.columns.of(active[[k]]))
        total = plan_with(some, plan.name, with_it, times=True).total if saved[k] > 0.0 else np.inf
        if total < seconds:
            best, seconds = with_it, total
    if best is None:
        return None
    saves = plan.total - plan_with(task, plan.name, best, times=True).total
    if not saves > least:
        return None
    new = len(columns)
    names, angles = task.orientations[0].names, best.angle[new].tolist()
    return OneMoreEntry(
        saves_seconds=saves, cutter=task.cutters[best.cutter[new]].id, setup=int(best.setup[new]),
        angles_deg=dict(zip(names, angles, strict=True)),
    )  # fmt: skip
