"""Look for the one orientation more that saves most: the fewest are sought without a look at time."""

import numpy as np

from plan_cutters.domain.operations import Columns
from plan_cutters.operations.fewest import Search
from plan_cutters.operations.plans import costs_with, plan_with
from plan_cutters.operations.problem import Costs
from plan_cutters.operations.task import Task
from plan_cutters.operations.thinned import at_some
from plan_cutters.outcome import OperationPlan
from plan_cutters.plan_file.operations import OneMoreEntry

#: Less is not worth a word, s and share of the plan's time; candidates that are planned with, at most.
_SECONDS, _SHARE, _TRIED = 60.0, 0.1, 5


def one_more(task: Task, some: Task, search: Search, plan: OperationPlan, columns: Columns) -> OneMoreEntry | None:
    """The orientation that saves most beside those of a plan, by plans with it and without it.

    Parameters
    ----------
    task, some : Task
        Of all samples, and of some, by which candidates are compared.
    search : Search
        Its candidates that are known whole are tried.
    plan : OperationPlan
    columns : Columns
        Those of its fixed operations.

    Returns
    -------
    OneMoreEntry or None
        None where it would save no more than a minute, or a tenth of the time, or times are not known, or
        a number of orientations was requested.
    """
    least = max(_SECONDS, _SHARE * plan.total)
    options = task.ready.options
    if task.paths.feed is None or options.most_operations is not None or not plan.total > least or not len(columns):
        return None
    few, (active, table) = at_some(task, search.rows), search.whole
    area, now = costs_with(few, columns)
    costs = Costs(task.indexing.constant if task.indexing.rate is None else 0.0, options.change_time, options.setup_time)
    problem = task.problems.of(search.columns.of(active), active, table, search.rows, area, costs)
    cheapest = now.min(axis=1)
    served = np.flatnonzero(np.isfinite(cheapest))
    saved = problem.gains(np.where(np.isfinite(cheapest), cheapest, 0.0), served) - costs.operation
    saved -= costs.cutter * ~np.isin(problem.cutter, columns.cutter) + costs.setup * ~np.isin(problem.setup, columns.setup)
    best, seconds = None, plan_with(some, plan.name, columns, times=True).total
    for k in np.argsort(-saved, kind="stable")[:_TRIED].tolist():
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
