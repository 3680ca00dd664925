"""Choices of columns: made by some samples, tested at more of them, and made again by what they leave."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from plan_cutters.domain.operations import Columns
from plan_cutters.operations.candidates import STEP
from plan_cutters.operations.fastest import cheap, exchanged, promising
from plan_cutters.operations.fewest import Search
from plan_cutters.operations.plans import MINOR_AREA
from plan_cutters.operations.problem import Costs, Problem
from plan_cutters.operations.rest_areas import by_size, largest_first
from plan_cutters.operations.task import Task
from plan_cutters.operations.timing import shared_area
from plan_cutters.scene.threads import Progress

Rows = NDArray[np.int64]
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

    Attributes
    ----------
    columns : Columns
        All that were compared.
    problem : Problem
        What samples cost with them.
    rows : (n,) int64
        These samples.
    area : float
        That they stand for, mm2.
    chosen, known : (k,) int64
        The choice, and a choice that was known before: of the columns.
    whole : bool
        Whether the choice serves all samples that it was tested at.
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


def _timed(task: Task, search: Search, fewest: Columns) -> tuple[Columns, Problem, float]:
    """As `_problem`, with samples all over the part."""
    wanted = np.setdiff1d(task.rows, search.alone)
    most = _EVEN if task.ready.options.operations == "fewest" else _TIMED
    search.require(wanted[:: max(1, len(wanted) // most)])
    return _problem(task, search, fewest)


def _problem(task: Task, search: Search, fewest: Columns) -> tuple[Columns, Problem, float]:
    """The candidates that are known whole, what the samples of a search cost with each, and the area that these stand for.

    Where the rotary axes have rates, an orientation counts in the choice what it takes in the mean of the fewest.
    """
    options, indexing = task.ready.options, task.indexing
    wanted = np.setdiff1d(task.rows, search.alone)
    active, table = search.whole
    columns, area = search.columns.of(active), shared_area(task.ready.samples, wanted, search.rows)
    mean = indexing.constant if indexing.rate is None else indexing.together(fewest) / max(1, len(fewest))
    costs = Costs(mean, options.change_time, options.setup_time)
    problem = task.problems.of(columns, active, table, search.rows, area, costs)
    return columns, problem, float(area.sum())


def _tested(
    task: Task, search: Search, fewest: Columns, choose: Callable[[Problem, Rows], Rows], rounds: int, *, minor: bool = False
) -> Choice:
    """Choose columns by samples that candidates are known at, and test them at those of a task.

    What they leave joins these samples, and it is chosen again; with `minor`, they may leave a minor part of the area.
    """
    while True:
        columns, problem, area = _timed(task, search, fewest)
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
    """Some of the samples, evenly taken."""
    return rows[:: max(1, len(rows) // _MORE)]
