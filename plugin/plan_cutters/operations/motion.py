"""Where simultaneous motion takes the area of fixed orientations: which stay where there are many, and which sculptured faces it
takes as a whole for less than fixed orientations and their borders cost.

A machinist sets few orientations. Where a plan has more than the most that are recommended, those stay without which the rest
takes the most time; where simultaneous motion cuts faster than a fixed axis by more than it costs, orientations go as well.
"""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from cad_io.arrays import Floats
from plan_cutters.domain.operations import Columns
from plan_cutters.operations.choices import Choice
from plan_cutters.operations.fastest import cheap
from plan_cutters.operations.plans import costs_with, moving_over, plan_with, worth_their_turn
from plan_cutters.operations.task import Task
from plan_cutters.outcome import OperationPlan

Rows = NDArray[np.int64]
#: Simultaneous motion is taken for less than what is recommended where it saves this share of the time: what it costs to turn
#: while cutting is not known.
WORTH = 0.02
#: Columns that are left out in turn to find the one without which a plan takes least, at most.
_TRIED = 12


@dataclass(frozen=True, slots=True, eq=False)
class _Times:
    """What samples of a task (r,) take with columns and with simultaneous motion.

    `cost` (r, k) float: s, or mm without a feed; infinite where a column does not serve. `moving` (r,) float: the same with
    simultaneous motion. `cutter` (r,) int: of that motion, counted as in the task. `setup` (r,) int.
    """

    task: Task
    columns: Columns
    cost: Floats
    moving: Floats
    cutter: Rows
    setup: Rows

    @classmethod
    def of(cls, task: Task, columns: Columns) -> "_Times":
        area, cost = costs_with(task, columns)
        motion = moving_over(task, task.rows)
        moving = motion.costs(task, area)
        # Where its time is not known, motion is taken to be as slow as the slowest column: it must not look quick.
        slowest = np.where(np.isfinite(cost), cost, 0.0).max(axis=1, initial=0.0)
        return cls(task, columns, cost, np.where(np.isfinite(moving), moving, slowest), motion.cutter, motion.setup)

    def total(self, some: Sequence[int]) -> tuple[float, float]:
        """The time of some columns, numbers, with simultaneous motion for what they leave; and that of cutting alone."""
        return self._with(some, self.cost[:, some].min(axis=1, initial=np.inf))

    def without_one(self, some: list[int]) -> list[tuple[list[int], tuple[float, float]]]:
        """Some columns without one of them, and the `total` of the others: of each of those without which cutting takes least."""
        cost, rows = self.cost[:, some], np.arange(len(self.cost))
        quickest = cost.argmin(axis=1)
        least = cost[rows, quickest]
        cost[rows, quickest] = np.inf
        # Each sample goes to the column that is quickest there, or to the next one where that is gone.
        following = cost.min(axis=1)
        taken, instead = (np.where(np.isfinite(each), each, self.moving) for each in (least, following))
        longer = np.bincount(quickest, instead - taken, len(some))
        result = []
        for k in np.sort(np.argsort(longer, kind="stable")[:_TRIED]).tolist():
            others = some[:k] + some[k + 1 :]
            result.append((others, self._with(others, np.where(quickest == k, following, least))))
        return result

    def _with(self, some: Sequence[int], own: Floats) -> tuple[float, float]:
        """The `total` of columns that take so long at each sample (r,), infinite where none serves."""
        left = ~np.isfinite(own)
        cutting = float(np.where(left, self.moving, own).sum())
        columns = self.columns.of(np.array(some, np.int64))
        motions = {*zip(self.setup[left].tolist(), self.cutter[left].tolist(), strict=True)}
        turns = self.task.together(columns) + self.task.indexing.constant * len(motions)
        uses = motions.union(zip(columns.setup.tolist(), columns.cutter.tolist(), strict=True))
        return cutting + turns + self.task.costs().between(uses), cutting


def recommended(task: Task, columns: Columns) -> Columns:
    """The columns of a plan that stay where simultaneous motion takes the area of the others.

    Returns all of them where they are few enough, simultaneous motion saves nothing, the machine's axes lock or there are none,
    or the most orientations were requested otherwise.
    """
    options = task.ready.options
    if not len(columns) or not task.may_move:
        return columns
    times, stay = _Times.of(task, columns), list(range(len(columns)))
    (now, cutting), whole = times.total(stay), len(columns)
    while stay:
        others, (total, cut) = min(times.without_one(stay), key=lambda each: each[1][0])
        # Turns alone are no reason: what the axes take on the way is in no time of simultaneous motion.
        worth = total < (1.0 - WORTH) * now and cut < cutting
        if len(stay) <= options.max_orientations and not worth:
            break
        stay, now, cutting = others, total, cut
    return columns if len(stay) == whole else columns.of(np.array(stay, np.int64))


def fewer(task: Task, columns: Columns) -> list[tuple[Columns, float]]:
    """Choices of fewer and fewer of some columns, with the time of each: simultaneous motion takes the area of the others.

    All of them come first; then always that one is left out without which the rest takes the least time.
    """
    times, stay = _Times.of(task, columns), list(range(len(columns)))
    choices = list[tuple[Columns, float]]()
    while stay:
        choices.append((columns.of(np.array(stay, np.int64)), times.total(stay)[0]))
        stay, _ = min(times.without_one(stay), key=lambda each: each[1][0])
    return choices


def few_enough(task: Task, plan: OperationPlan) -> bool:
    """Whether a plan has no more fixed orientations than are recommended."""
    return not task.may_move or plan.orientations <= task.ready.options.max_orientations


def with_moved(task: Task, faces: Sequence[int]) -> Task:
    """The same task with some faces for simultaneous motion alone."""
    return replace(task, moved=np.isin(task.ready.samples.face, faces))


def flowing(task: Task, others: Callable[[Task], Columns], plan: OperationPlan) -> tuple[list[int], OperationPlan] | None:
    """The faces that simultaneous motion takes as a whole, and the plan that follows; None where no such plan costs less.

    `others`: gives fixed orientations for the samples that are not moved in a task. `plan`: the best one without.
    """
    if task.paths.feed is None or not task.may_move:
        return None
    made = []
    for faces in _faces_tried(task, plan):
        own = with_moved(task, faces)
        columns = recommended(own, worth_their_turn(own, others(own)))
        made.append((faces, plan_with(own, "fastest", columns, times=True)))
    best = min(made, key=lambda each: each[1].price, default=None)
    return best if best is not None and best[1].price < (1.0 - WORTH) * plan.price else None


def chosen_for_others(task: Task, choice: Choice) -> Columns:
    """Columns among those of a choice that cost little for the samples that are not moved."""
    assert task.moved is not None
    rest = ~task.moved[choice.rows]
    if not rest.any():
        return choice.columns.of(np.zeros(0, np.int64))
    return choice.columns.of(cheap(choice.problem.of(np.arange(len(choice.columns)), rest)))


def _faces_tried(task: Task, plan: OperationPlan) -> Iterator[list[int]]:
    """Faces that motion may take together: all of free form or round a rotary axis, and those that it cuts for less than a plan.

    Other rounds and spheres are none: nobody turns while cutting for a fillet.
    """
    samples, faces = task.ready.samples, task.flowing
    rows = task.rows[np.isin(samples.face[task.rows], faces)]
    if not len(rows):
        return
    seconds = moving_over(task, rows).costs(task, samples.area[rows])
    known = [face for face in faces.tolist() if np.isfinite(seconds[samples.face[rows] == face]).all()]
    if known:
        yield known
    less = []
    for face in known:
        # The plan's seconds for the face, with what its borders count.
        own = np.where(samples.face == face, plan.label, -1)
        cost = float(np.nansum(plan.seconds[own >= 0])) + task.ready.options.border_cost * task.seams.marks(own)
        less += [face] if seconds[samples.face[rows] == face].sum() < cost else []
    if less and less != known:
        yield less
