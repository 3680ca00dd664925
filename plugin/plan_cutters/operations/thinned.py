"""Fewer samples that stand for all: choices are compared at these, and the choice that is made is tested at all."""

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from plan_cutters.operations.probes import Probes
from plan_cutters.operations.task import Task
from plan_cutters.operations.timing import Problems, nearest, shared_area

#: Samples at which choices are compared, at most about.
SOME = 2500


def thinned(task: Task, most: int = SOME) -> Task:
    """The same task for some of its samples, evenly taken, each with the area of those that it stands for.

    Parameters
    ----------
    task : Task
    most : int
        About how many samples; where the task has no more, it is the task itself.

    Returns
    -------
    Task
        Its plans reckon what the plans of all samples take; where it is served, others need not be.
    """
    every = len(task.rows) // most
    return task if every < 2 else at_some(task, task.rows[::every])


def at_some(task: Task, rows: NDArray[np.int64]) -> Task:
    """The same task for some of its samples (r,), each with the area of those that it stands for."""
    ready = task.ready
    area = np.zeros(len(ready.samples))
    area[rows] = shared_area(ready.samples, task.rows, rows)
    samples, stands_for = replace(ready.samples, area=area), np.full(len(area), -1, np.int64)
    stands_for[task.rows] = rows[nearest(ready.samples, task.rows, rows)] if len(rows) else -1
    probes = Probes(samples, task.cutters, ready.setups, task.probes.outside, task.probes.barred)
    walls = task.walls.of_probes(probes)
    return replace(
        task, ready=replace(ready, samples=samples), rows=rows, probes=probes, walls=walls, seams=task.seams.among(stands_for),
        problems=Problems(samples, task.cutters, task.paths, task.indexing, walls),
    )  # fmt: skip
