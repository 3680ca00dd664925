"""Sculptured faces that simultaneous motion takes as a whole: where that costs less than fixed orientations and their borders."""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from plan_cutters.domain.operations import Columns
from plan_cutters.operations.at_once import WORTH, recommended
from plan_cutters.operations.choices import Choice
from plan_cutters.operations.fastest import cheap
from plan_cutters.operations.plans import moving_over, plan_with, worth_their_turn
from plan_cutters.operations.task import Task
from plan_cutters.outcome import OperationPlan

Rows = NDArray[np.int64]


def with_moved(task: Task, faces: Sequence[int]) -> Task:
    """The same task with some faces for simultaneous motion alone."""
    return replace(task, moved=np.isin(task.ready.samples.face, faces))


def flowing(task: Task, others: Callable[[Task], Columns], plan: OperationPlan) -> tuple[list[int], OperationPlan] | None:
    """The faces that simultaneous motion takes as a whole, and the plan that follows; None where no such plan costs less.

    Parameters
    ----------
    task : Task
    others : callable
        Gives fixed orientations for the samples that are not moved in a task.
    plan : OperationPlan
        The best one without.
    """
    options = task.ready.options
    if options.most_operations is not None or options.index_step is not None or task.paths.feed is None:
        return None
    made = []
    for faces in _tried(task, plan):
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


def _tried(task: Task, plan: OperationPlan) -> Iterator[list[int]]:
    """Faces that motion may take together: all that are sculptured, and those that it cuts for less than a plan.

    Rounds and spheres are none: nobody turns while cutting for a fillet.
    """
    shapes, samples = [each.shape for each in task.ready.scene.part.faces], task.ready.samples
    faces = np.array([face for face in np.unique(samples.face).tolist() if shapes[face - 1] == "sculptured"], np.int64)
    rows = task.rows[np.isin(samples.face[task.rows], faces)]
    if not len(rows):
        return
    seconds = moving_over(task, rows).costs(task, samples.area[rows])
    known = [face for face in faces.tolist() if np.isfinite(seconds[samples.face[rows] == face]).all()]
    if known:
        yield known
    less = [face for face in known if seconds[samples.face[rows] == face].sum() < _cost(task, plan, face)]
    if less and less != known:
        yield less


def _cost(task: Task, plan: OperationPlan, face: int) -> float:
    """Seconds that a plan takes for a face, with what its borders count."""
    own = np.where(task.ready.samples.face == face, plan.label, -1)
    return float(np.nansum(plan.seconds[own >= 0])) + task.ready.options.border_cost * task.seams.marks(own)
