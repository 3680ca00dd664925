"""Plans of a part that is a pattern, or nearly one: one copy is planned, and its orientations are repeated about the axis.

Orientations are chosen by what samples of one sector cost with the best image, each counted as often as there are copies. The
plan that comes of it has ordinary operations and is tested at all samples, like any other (`docs/operations_proof.md`, lemmas P3,
P4).
"""

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from cad_io.part.equal_faces import Motion
from plan_cutters.domain.figures import count, duration
from plan_cutters.domain.operations import Columns
from plan_cutters.operations.canonical import canonical
from plan_cutters.operations.choices import Worth, by_size, largest_first, worths
from plan_cutters.operations.entries import Timed
from plan_cutters.operations.fastest import Problem, against_bound, bounded, cheap
from plan_cutters.operations.fewest import spread
from plan_cutters.operations.motion import few_enough, fewer, recommended
from plan_cutters.operations.plans import plan_with, worth_their_turn
from plan_cutters.operations.symmetry import Symmetry, symmetry_of
from plan_cutters.operations.task import SOME, Task, costs_of, shared_area, thinned
from plan_cutters.outcome import OperationPlan
from plan_cutters.scene.copied import keeps
from plan_cutters.scene.work import Progress, evenly, part_of

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

    `base`: all that were compared, each with its images.
    `chosen`: of these; `Task.images` are what is set.
    `problem`: what samples of one copy that are served cost, counted as often as there are copies.
    `apart`: the same of all copies, each image a candidate of its own: what would be chosen if nothing were repeated.
    `area`: that these stand for, mm2.
    `not_served`: share of the area that no compared column serves.
    """

    base: Columns
    chosen: Columns
    problem: Problem
    apart: Problem
    area: float
    not_served: float


def repeated(task: Task, candidates: Columns, stored: Callable[[Rows], Columns], tell: Progress) -> Copied | None:
    """Choose orientations that take little time with their images, each counted as often as it is set.

    `task`: with its symmetry; of an exact pattern the samples may be those of one copy. `candidates`: those in the first sector
    are compared. `stored`: gives columns for samples that no candidate serves: their own postures. None where nothing serves.
    """
    symmetry = task.symmetry
    assert symmetry is not None
    samples, wanted = task.ready.samples, task.rows
    area = np.nan_to_num(samples.area)
    base = candidates.of(evenly(symmetry.sector(candidates.axis), _MOST_COLUMNS // symmetry.order))
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


def _costs(task: Task, rows: Rows, columns: Columns) -> NDArray[np.float64]:
    """Seconds, or mm of path without a feed, of samples (r,) with columns (r, k): infinite where one does not serve it."""
    table, area = task.probes.table(rows, columns), np.nan_to_num(task.ready.samples.area[rows])
    return costs_of(columns, task.paces(columns, rows, table), table, area, task.cutters, task.paths)


def _apart(task: Task, images: Columns, problem: Problem, cost: NDArray[np.float64]) -> Problem:
    """What samples (r,) of one copy and their images cost with columns and their images (r, k), each by itself.

    A turn that carries a sample onto its image carries what serves it: no tool is put down for that (lemma P4).
    """
    own = cost.reshape(len(cost), -1, task.times)
    turned = [np.roll(own, turn, axis=2).reshape(cost.shape) for turn in range(task.times)]
    each = replace(problem.costs, operation=problem.costs.operation / task.times)
    return Problem(np.concatenate(turned), images.cutter, images.setup, each, task.indexing.turning(images))


def _problem(task: Task, symmetry: Symmetry, base: Columns, cost: NDArray[np.float64]) -> Problem:
    """What samples cost with orientations and their images, each of which is set `order` times."""
    indexing = task.indexing
    step = indexing.constant if indexing.rate is None else indexing.together(symmetry.images(base.of(np.zeros(1, np.int64))))
    turns = symmetry.order * step if indexing.rate is None else step
    return Problem(cost, base.cutter, base.setup, task.costs(turns))


#: A plan of repeated steps may take so much more time, as a share: equal copies are cut alike, and are set up once.
_DEARER = 0.25
#: What a choice is reckoned to take is not quite what its plan does: by about so much, as a share.
_NEAR = 0.02
#: Share of the area that a plan of repeated steps may leave to simultaneous motion beyond what another plan leaves, and beyond
#: what must go with it.
_MOVING, _MOST_MOVING = 0.05, 0.1
#: Samples by which orientations of one copy are compared, at most about: each is looked at with all images of an orientation.
_OF_ONE = 1000
#: What a plan of some samples may be off in time and share, about.
_ROUGH = 0.1

PlansTimed = tuple[list[OperationPlan], Timed | None, tuple[Worth, ...], tuple[str, ...]]


@dataclass(frozen=True, eq=False)
class Repeated:
    """Orientations that may be repeated.

    `task`, `one`: with their symmetry: of all samples, and of some of those of one copy, by which choices are compared. `choices`
    (tuple of (Columns, float)): fewer and fewer columns, each with its images, and about the seconds that they take. `copied`:
    what they were chosen from. `exact`: whether what is known of one copy holds for all: the part is a pattern, and nothing about
    it breaks that.
    """

    task: Task
    one: Task
    choices: tuple[tuple[Columns, float], ...]
    copied: Copied
    exact: bool

    def plan(self, columns: Columns) -> OperationPlan | None:
        """The plan of some columns and their images; None where nothing of it is repeated."""
        plan = plan_with(self.task, "fastest", columns)
        return plan if any(each.orbit >= 0 for each in plan.operations) else None

    def may_take(self, columns: Columns, most: float, share: float) -> bool:
        """Whether a plan may take no more seconds and leave no more to simultaneous motion, by some samples."""
        if self._some is self.task:
            return True
        rough = plan_with(self._some, "fastest", columns, times=True)
        return known(rough) <= (1.0 + _ROUGH) * most and moving_share(self._some, rough) <= share + _ROUGH

    @cached_property
    def _some(self) -> Task:
        return thinned(self.task)

    @property
    def recommended(self) -> Iterator[tuple[Columns, float]]:
        """The choices of no more steps than are recommended."""
        most = self.task.ready.options.max_orientations
        return ((columns, seconds) for columns, seconds in self.choices if len(columns) <= most)


def repeated_orientations(
    task: Task, candidates: Callable[[Task], Columns], stored: Callable[[Rows], Columns], tell: Progress
) -> Repeated | None:
    """Choose orientations for one copy of a part; None where it is no pattern, or one copy is not served.

    `candidates`: gives the columns that are compared. `stored`: gives columns for samples that none of these serves: their own
    postures.
    """
    own = symmetric(task)
    if own is None or own.symmetry is None:
        return None
    symmetry, samples = own.symmetry, task.ready.samples
    sector = task.rows[symmetry.sector(samples.point[task.rows] - symmetry.place)]
    one = replace(own, rows=sector, copies=symmetry.order) if len(sector) else own
    ready, turn = task.ready, Motion.turn(symmetry.place, symmetry.direction, 2.0 * math.pi / symmetry.order)
    # Machine, fixtures, and all else that verdicts depend on have to be the same for each copy, and no face clamped.
    exact = symmetry.exact and not any(ready.there(s).clamped.any() for s in range(len(ready.setups)))
    exact = exact and all(keeps(ready, each, turn, ready.patterns) for each in ready.setups)
    # What is no exact pattern is looked at everywhere.
    copied = repeated(one if exact else own, candidates(task), stored, part_of(tell, 0, 2))
    if copied is None:
        return None
    one = thinned(one, _OF_ONE)
    columns = worth_their_turn(one, copied.chosen)
    columns = worth_their_turn(one, canonical(one, columns, progress=part_of(tell, 1, 2)))
    return Repeated(own, one, tuple(fewer(one, columns)), copied, exact)


def planned_by_pattern(task: Task, offer: Repeated) -> PlansTimed | None:
    """The fastest plan that follows from one copy, with what it is compared with; None where others have to be looked for.

    Orientations are repeated, unless setting each once takes much less time, or leaves much less to simultaneous motion. Others
    are looked for where one copy does not stand for all, or the plan leaves much to simultaneous motion.
    """
    if not offer.exact:
        return None
    copied, alone = offer.copied, cheap(offer.copied.apart)
    images = offer.task.images(copied.base).of(alone)
    each_once = recommended(task, worth_their_turn(task, images.of(images.first)))
    single = plan_with(task, "fastest", worth_their_turn(task, canonical(task, each_once)))
    # The first choice leaves least to simultaneous motion.
    again = next((offer.plan(columns) for columns, _ in offer.recommended), None)
    plan = single if again is None or _better(task, single, again) else again
    if moving_share(task, plan) > copied.not_served + _MOST_MOVING:
        return None
    compared = [plan]
    if len(task.cutters) > 1:
        columns = worth_their_turn(offer.one, copied.base.of(largest_first(copied.problem, by_size(task))))
        compared.append(plan_with(offer.task, "fastest", columns))
        plan = min([plan, *(each for each in compared if few_enough(task, each))], key=known)
    bound = bounded(copied.apart, alone)
    at_best = float(copied.problem.cost.min(axis=1, initial=np.inf).sum())
    timed = against_bound(plan.total, bound, at_best, *copied.apart.cost.shape), copied.area
    words = [
        "Orientations were chosen by the samples of one copy of the part; `--operations both` looks for the fewest "
        "orientations as well, by all samples."
    ]
    if plan is not single and known(single) < known(plan) and np.isfinite(single.total):
        words.append(_without_repeats(single))
    return [plan], timed, worths(task, compared), tuple(words)


def _better(task: Task, plan: OperationPlan, repeated_plan: OperationPlan) -> bool:
    """Whether a plan takes much less time than one of repeated steps, with hardly more simultaneous motion, or has much less."""
    more = moving_share(task, plan) - moving_share(task, repeated_plan)
    return (abs(more) <= _MOVING and (1.0 + _DEARER) * known(plan) < known(repeated_plan)) or more < -_MOVING


def as_quick(
    task: Task, offer: Repeated | None, plain: tuple[OperationPlan, tuple[str, ...]], printed: list[OperationPlan]
) -> tuple[OperationPlan, tuple[str, ...]]:
    """The plan that is recommended, and what must be said of it: one of repeated steps, unless that takes a quarter more time.

    Of those that take no more than that, nor more than those that are printed beside it, that which leaves least to simultaneous
    motion is taken, if that is hardly more than in the plan that was found; else that plan. Where a time is not known, it must be
    that of no more area.
    """
    if offer is None:
        return plain
    other, _ = plain
    most = min((1.0 + _DEARER) * known(other), *map(known, printed), np.inf)
    share = moving_share(task, other) + _MOVING
    for columns, seconds in offer.recommended:
        likely = seconds <= (1.0 + _NEAR) * most and offer.may_take(columns, most, share)
        plan = offer.plan(columns) if likely else None
        if plan is None or known(plan) > most or _untimed(task, plan) > _untimed(task, other):
            continue
        if moving_share(task, plan) > share:
            continue
        if known(plan) <= known(other) or not np.isfinite(other.total):
            return plan, ()
        return plan, (_without_repeats(other),)
    return plain


def _without_repeats(plan: OperationPlan) -> str:
    """Say what a plan takes that was compared with one of repeated steps."""
    moving = " and simultaneous motion" if plan.moves else ""
    return f"Without repeated steps {count(plan.orientations, 'orientation')}{moving} would take {duration(plan.total)}."


def known(plan: OperationPlan) -> float:
    """Seconds of a plan without those of the samples at which they are not known."""
    seconds = plan.seconds[plan.label >= 0]
    return float(seconds[np.isfinite(seconds)].sum()) + plan.other


def _untimed(task: Task, plan: OperationPlan) -> float:
    """The area of the samples of a plan whose seconds are not known, mm2."""
    return float(np.nansum(task.ready.samples.area[(plan.label >= 0) & ~np.isfinite(plan.seconds)]))


def moving_share(task: Task, plan: OperationPlan) -> float:
    """The share of the area that a plan leaves to simultaneous motion."""
    area = np.nan_to_num(task.ready.samples.area)
    rows = [each.rows for each in plan.operations if each.mode == "simultaneous"]
    return sum(float(area[mine].sum()) for mine in rows) / max(1e-300, float(area[task.rows].sum()))
