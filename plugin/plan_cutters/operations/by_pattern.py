"""Plans of a part that is a pattern, or nearly one: one copy is planned, and repeated.

Samples of one sector alone are compared, each counted as often as there are copies. The plan that comes of it is tested at all
samples, like any other (`docs/operations_proof.md`, lemmas P3 and P4).
"""

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from cad_io.part.motion import Motion
from cad_io.part.equal_faces import Motion
from plan_cutters.domain.columns import Columns
from plan_cutters.domain.figures import count, duration
from plan_cutters.domain.operations import Columns
from plan_cutters.operations.at_once import few_enough, fewer, recommended
from plan_cutters.operations.canonical import canonical
from plan_cutters.operations.entries import Timed
from plan_cutters.operations.fastest import against_bound, bounded, cheap
from plan_cutters.operations.plans import plan_with, worth_their_turn
from plan_cutters.operations.repeated import Copied, repeated, symmetric
from plan_cutters.operations.rest_areas import Worth, by_size, largest_first, worths
from plan_cutters.operations.symmetry import Symmetry
from plan_cutters.operations.task import Task
from plan_cutters.operations.thinned import thinned
from plan_cutters.outcome import OperationPlan
from plan_cutters.scene.copied import keeps
from plan_cutters.scene.threads import Progress, part_of

Rows = NDArray[np.int64]
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

    Attributes
    ----------
    task, one : Task
        With their symmetry: of all samples, and of some of those of one copy, by which choices are compared.
    choices : tuple of (Columns, float)
        Fewer and fewer columns, each with its images, and about the seconds that they take.
    copied : Copied
        What they were chosen from.
    exact : bool
        Whether what is known of one copy holds for all: the part is a pattern, and nothing about it breaks that.
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

    Parameters
    ----------
    task : Task
    candidates : callable
        Gives the columns that are compared.
    stored : callable
        Gives columns for samples that none of these serves: their own postures.
    tell : callable
        Told the progress.
    """
    own = symmetric(task)
    if own is None or own.symmetry is None:
        return None
    symmetry, samples = own.symmetry, task.ready.samples
    sector = task.rows[symmetry.sector(samples.point[task.rows] - symmetry.place)]
    one = replace(own, rows=sector, copies=symmetry.order) if len(sector) else own
    exact = symmetry.exact and _unbroken(task, symmetry)
    # What is no exact pattern is looked at everywhere.
    copied = repeated(one if exact else own, candidates(task), stored, part_of(tell, 0, 2))
    if copied is None:
        return None
    one = thinned(one, _OF_ONE)
    columns = worth_their_turn(one, copied.chosen)
    columns = worth_their_turn(one, canonical(one, columns, progress=part_of(tell, 1, 2)))
    return Repeated(own, one, tuple(fewer(one, columns)), copied, exact)


def _unbroken(task: Task, symmetry: Symmetry) -> bool:
    """Whether machine, fixtures, and all else that verdicts depend on are the same for each copy, and no face is clamped."""
    ready = task.ready
    if any(ready.there(s).clamped.any() for s in range(len(ready.setups))):
        return False
    turn = Motion.turn(symmetry.place, symmetry.direction, 2.0 * math.pi / symmetry.order)
    return all(keeps(ready, each, turn, ready.patterns) for each in ready.setups)


def planned_by_pattern(task: Task, offer: Repeated) -> PlansTimed | None:
    """The fastest plan that follows from one copy, with what it is compared with; None where others have to be looked for.

    Orientations are repeated, unless setting each once takes much less time, or leaves much less to simultaneous motion. Others
    are looked for where one copy does not stand for all, or the plan leaves much to simultaneous motion.
    """
    if not offer.exact:
        return None
    copied, alone = offer.copied, cheap(offer.copied.apart)
    single = plan_with(task, "fastest", worth_their_turn(task, canonical(task, _single(task, offer, alone))))
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
    bound = bounded(copied.apart, alone).bound
    timed = against_bound(plan.total, bound, copied.at_best, *copied.apart.cost.shape), copied.area
    words = [
        "Orientations were chosen by the samples of one copy of the part; --operations both looks for the fewest orientations as "
        "well, by all samples."
    ]
    if plan is not single and known(single) < known(plan) and np.isfinite(single.total):
        words.append(_without_repeats(single))
    return [plan], timed, worths(task, compared), tuple(words)


def _single(task: Task, offer: Repeated, alone: Rows) -> Columns:
    """Orientations of which each is set once, no more than are recommended."""
    images = offer.task.images(offer.copied.base).of(alone)
    single = worth_their_turn(task, images.of(images.first))
    return recommended(task, single)


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
