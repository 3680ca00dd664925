"""Other cutters at orientations that a plan has anyway: a part that stands there already is not turned for them.

The fewest orientations are sought without a look at time: one ball may stand for all cutters, and mill a floor in passes of half
a millimetre. Where feeds are known, another cutter that saves more than its change goes there, too.
"""

import numpy as np

from plan_cutters.domain.operations import Columns, columns_of
from plan_cutters.operations.plans import costs_with, worth_their_turn
from plan_cutters.operations.task import Task


def accompanied(task: Task, columns: Columns) -> Columns:
    """Columns with those of other cutters at the same orientations that save more time than they take.

    What is not worth its turn any more is left out. Without feeds, or with a most number of operations, all stays.

    Parameters
    ----------
    task : Task
    columns : Columns
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


def _others(task: Task, columns: Columns) -> Columns:
    """The columns of all cutters at orientations of a choice that are not among it."""
    others, there = columns.of(np.zeros(0, np.int64)), {*columns.key.tolist()}
    for k in range(len(columns)):
        for c in range(len(task.cutters)):
            one = columns_of(columns.axis[[k]], columns.angle[[k]], c, int(columns.setup[k]))
            if one.key[0] not in there:
                there.add(one.key[0])
                others = others.and_(one)
    return others


def _turn(task: Task, every: Columns, chosen: list[int], k: int) -> float:
    """Seconds that a further column of some takes besides cutting: turning the part, and changing to a cutter that is new."""
    before, after = (every.of(np.array(each, np.int64)) for each in (chosen, [*chosen, k]))
    new = every.cutter[k] not in every.cutter[chosen]
    turn = task.indexing.together(after) - task.indexing.together(before)
    return turn + (task.ready.options.change_time if new else 0.0)
