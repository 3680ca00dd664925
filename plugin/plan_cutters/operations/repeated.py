"""A plan of repeated steps: a few orientations and their images about an axis, chosen by what samples cost with the best image.

Every image is tested at the samples, and the plan that comes of it has ordinary operations: it is chosen for one sector, and
proved for all (`docs/operations_proof.md`, lemma P3).
"""

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from plan_cutters.domain.operations import Columns
from plan_cutters.operations.fastest import cheap
from plan_cutters.operations.fewest import spread
from plan_cutters.operations.problem import Costs, Problem
from plan_cutters.operations.symmetry import Symmetry, symmetry_of
from plan_cutters.operations.task import Task
from plan_cutters.operations.thinned import SOME
from plan_cutters.operations.timing import costs_of, paces, shared_area
from plan_cutters.scene.threads import Progress, part_of

Rows = NDArray[np.int64]
#: Columns and images that are compared; samples at first, of one copy at least so many, and those that join them; rounds until a
#: choice serves all.
_MOST_COLUMNS, _FIRST, _LEAST, _MORE, _ROUNDS = 4000, 400, 80, 60, 6
#: What a choice may leave, as a share of the area.
_LEAVES = 0.001


def symmetric(task: Task) -> Task | None:
    """The task with a symmetry under which its orientations may be repeated; None where there is none, or it is not to be used.

    Where axes lock at whole multiples of an angle, and where a number of operations was requested, nothing is repeated.
    """
    options = task.ready.options
    if not options.patterns or options.index_step is not None or options.most_operations is not None or not len(task.rows):
        return None
    symmetry = symmetry_of(task.ready.samples, task.ready.patterns, task.orientations, task.ready.somewhere)
    return None if symmetry is None else replace(task, symmetry=symmetry)


@dataclass(frozen=True, slots=True, eq=False)
class Copied:
    """One copy: columns that were compared for it, and those that were chosen.

    Attributes
    ----------
    base : Columns
        All that were compared, each with its images.
    chosen : Columns
        Of these; `Task.images` are what is set.
    problem : Problem
        What samples of one copy that are served cost, counted as often as there are copies.
    apart : Problem
        The same of all copies, each image a candidate of its own: what would be chosen if nothing were repeated.
    area : float
        That these stand for, mm2.
    not_served : float
        Share of the area that no compared column serves.
    """

    base: Columns
    chosen: Columns
    problem: Problem
    apart: Problem
    area: float
    not_served: float

    @property
    def at_best(self) -> float:
        """Seconds of cutting alone, each sample with its best column."""
        return float(self.problem.cost.min(axis=1, initial=np.inf).sum())


def repeated(task: Task, candidates: Columns, stored: Callable[[Rows], Columns], tell: Progress) -> Copied | None:
    """Choose orientations that take little time with their images, each counted as often as it is set.

    Parameters
    ----------
    task : Task
        With its symmetry; of an exact pattern the samples may be those of one copy.
    candidates : Columns
        Those in the first sector are compared.
    stored : callable
        Gives columns for samples that no candidate serves: their own postures.
    tell : callable
        Told the progress.

    Returns
    -------
    Copied or None
        None where nothing serves.
    """
    symmetry = task.symmetry
    assert symmetry is not None
    samples, wanted = task.ready.samples, task.rows
    area = np.nan_to_num(samples.area)
    base = _thinned(candidates.of(symmetry.sector(candidates.axis)), _MOST_COLUMNS // symmetry.order)
    # One copy tells what all of them cost; where the part is no exact pattern, what is left elsewhere joins them.
    copy = wanted[symmetry.sector(samples.point[wanted] - symmetry.place)]
    copy = copy if len(copy) else wanted
    tested = wanted[:: max(1, len(wanted) // SOME)]
    rows, every = copy[:: max(1, len(copy) // max(_LEAST, _FIRST // symmetry.order))], symmetry.images(base)
    cost = _costs(task, rows, every)
    for turn in range(_ROUNDS):
        part = part_of(tell, turn, _ROUNDS)
        own = _of_images(cost, task.times)
        bare = np.flatnonzero(~np.isfinite(own).any(axis=1))
        if len(bare):
            new = stored(rows[spread(bare, samples.point[rows], _MORE)])
            new = new.of(np.flatnonzero(~np.isin(new.key, base.key)))
            base, every = base.and_(new), every.and_(symmetry.images(new))
            cost = np.concatenate([cost, _costs(task, rows, symmetry.images(new))], axis=1)
            own = _of_images(cost, task.times)
        if not len(base):
            return None
        open_ = np.isfinite(own).any(axis=1)
        share = symmetry.order * shared_area(samples, np.union1d(copy, rows), rows)
        scale = (share / np.maximum(area[rows], 1e-300))[open_, None]
        problem = _problem(task, symmetry, base, own[open_] * scale)
        chosen = base.of(cheap(problem))
        part(1, 2)
        served = task.probes.kept(tested, symmetry.images(chosen)).any(axis=1)
        left = tested[~served]
        more = np.setdiff1d(left, rows)
        if area[left].sum() <= _LEAVES * area[tested].sum() or turn == _ROUNDS - 1 or not len(more):
            break
        more = spread(more, samples.point, _MORE)
        rows = np.concatenate([rows, more])
        cost = np.concatenate([cost, _costs(task, more, every)])
    if not len(chosen):
        return None
    apart = _apart(task, symmetry.images(base), problem, cost[open_] * (scale / task.times))
    return Copied(base, chosen, problem, apart, float(share[open_].sum()), float(share[~open_].sum() / max(1e-300, share.sum())))


def _of_images(cost: NDArray[np.float64], times: int) -> NDArray[np.float64]:
    """What samples cost with the best of the images of each column."""
    return np.asarray(cost.reshape(len(cost), cost.shape[1] // times, times).min(axis=2))


def _thinned(columns: Columns, most: int) -> Columns:
    """At most so many of some columns, evenly taken."""
    return columns if len(columns) <= most else columns.of(np.linspace(0, len(columns) - 1, most).astype(np.int64))


def _costs(task: Task, rows: Rows, columns: Columns) -> NDArray[np.float64]:
    """Seconds, or mm of path without a feed, of samples (r,) with columns (r, k): infinite where one does not serve it."""
    samples = task.ready.samples
    table = task.probes.table(rows, columns)
    pace = paces(columns, rows, samples, task.cutters, task.paths, table)
    pace = np.fmax(pace, task.walls.paces(columns, rows, table))
    return costs_of(columns, pace, table, np.nan_to_num(samples.area[rows]), task.cutters, task.paths)


def _apart(task: Task, images: Columns, problem: Problem, cost: NDArray[np.float64]) -> Problem:
    """What samples (r,) of one copy and their images cost with columns and their images (r, k), each by itself.

    A turn that carries a sample onto its image carries what serves it: no tool is put down for that (lemma P4).
    """
    own = cost.reshape(len(cost), -1, task.times)
    turned = [np.roll(own, turn, axis=2).reshape(cost.shape) for turn in range(task.times)]
    each = Costs(problem.costs.operation / task.times, problem.costs.cutter, problem.costs.setup)
    return Problem(np.concatenate(turned), images.cutter, images.setup, each, task.indexing.turning(images))


def _problem(task: Task, symmetry: Symmetry, base: Columns, cost: NDArray[np.float64]) -> Problem:
    """What samples cost with orientations and their images, each of which is set `order` times."""
    options, indexing = task.ready.options, task.indexing
    step = indexing.constant if indexing.rate is None else indexing.together(symmetry.images(base.of(np.zeros(1, np.int64))))
    turns = symmetry.order * step if indexing.rate is None else step
    return Problem(cost, base.cutter, base.setup, Costs(turns, options.change_time, options.setup_time))
