"""All answers that the options of a plan ask for, one after the other: stick-outs and radii over several setups, and what to do
next with cutters that do not finish the part, or why no change is sought.
"""

from collections.abc import Callable, Sequence
from contextlib import AbstractContextManager
from dataclasses import replace
from typing import Any, Literal

import numpy as np

from cad_io.arrays import Ints
from plan_cutters.answers.areas import Finished
from plan_cutters.answers.largest_radius import largest_radius
from plan_cutters.answers.state import Everywhere
from plan_cutters.answers.steps import steps, worth
from plan_cutters.answers.stick_out import least_stick_out
from plan_cutters.domain.answers import RadiusMap, Shape
from plan_cutters.domain.cutter import Cutter
from plan_cutters.domain.figures import mm, reporting
from plan_cutters.domain.stick_out import StickOut
from plan_cutters.domain.verdicts import INACCESSIBLE, UNDECIDED, UNJUDGED, Verdicts, over_setups
from plan_cutters.option_table import EFFORT
from plan_cutters.outcome import Advice, Answers, LeastSet
from plan_cutters.plan_file.answers import MendEntry
from plan_cutters.plan_file.words.answers import samples
from plan_cutters.scene.preparation import Prepared
from plan_cutters.scene.work import Budget, Progress, part_of


def stick_out_in_each(
    ready: Prepared, cutter: Cutter, verdicts: Sequence[Verdicts], which: Ints, *, progress: Progress
) -> StickOut:
    """The least stick-out with which each setup still reaches all samples that it serves.

    `verdicts`: in each setup. `which` (n,) int32: the setup that serves each sample, -1 for none. The result is that of the setup
    that needs most: with another division of the samples among the setups, less might do.
    """
    if len(verdicts) == 1:
        return least_stick_out(ready, cutter, verdicts[0], progress=progress)
    results = list[StickOut]()
    for k, there in enumerate(verdicts):
        mine = replace(there, verdict=np.where(there.reached & (which != k), UNJUDGED, there.verdict).astype(np.uint8))
        part = part_of(progress, k, len(verdicts))
        results.append(replace(least_stick_out(ready.alone(k), cutter, mine, progress=part), setup=k))
    # A setup that serves nothing asks for nothing.
    most = max(results, key=lambda each: -np.inf if np.isnan(each.least) else each.least)
    return replace(most, served=sum(each.served for each in results))


def radius_in_any(ready: Prepared, shape: Shape, *, ratio: float, tell: Progress) -> RadiusMap:
    """Find the largest radius that reaches each sample in one setup or another, as `largest_radius` does in one."""
    number = len(ready.setups)
    best, *others = [largest_radius(ready.alone(k), shape, ratio=ratio, progress=part_of(tell, k, number)) for k in range(number)]
    for other in others:
        larger = other.radius > best.radius
        taken: dict[str, Any] = {
            name: np.where(larger if column.ndim == 1 else larger[:, None], getattr(other, name), column)
            for name in ("radius", "beyond", "reason", "axis", "tilt_direction", "tilt", "rotation")
            if isinstance(column := getattr(best, name), np.ndarray)
        }
        # What is undecided in either setup may serve there.
        unsure = (taken["beyond"] == INACCESSIBLE) & ((best.beyond == UNDECIDED) | (other.beyond == UNDECIDED))
        source = np.where(best.beyond == UNDECIDED, best.reason, other.reason)
        taken["beyond"] = np.where(unsure, UNDECIDED, taken["beyond"]).astype(np.uint8)
        taken["reason"] = np.where(unsure, source, taken["reason"]).astype(np.uint8)
        best = replace(best, **taken)
    return best


#: A tolerance that is larger than asked by more than rounding was raised.
_RAISED = 1.001


def undecidable(ready: Prepared, cutter: Cutter, verdicts: Verdicts) -> str:
    """Say why no change is sought; empty where a sample is inaccessible for sure, or a finer tolerance might decide.

    `verdicts`: of all samples.
    """
    not_reached = verdicts.not_reached & ready.finished
    if not not_reached.any() or (verdicts.verdict[not_reached] != UNDECIDED).any():
        return ""
    conditions, number = ready.conditions, int(np.count_nonzero(not_reached))
    raised = conditions.tolerance > _RAISED * ready.scene.asked
    if raised and not conditions.judges(cutter):
        cause = f"the tolerance that can be kept, {mm(conditions.tolerance)}, is too coarse for the cutter"
    elif set(faces := np.unique(ready.samples.face[not_reached]).tolist()) <= set(conditions.surroundings.loose):
        cause = f"they lie on {', '.join(f'F{face}' for face in faces)}, which triangles follow too loosely"
    else:
        return ""
    what = "the only sample that it leaves is" if number == 1 else f"all {number:,} samples that it leaves are"
    return f"it was not asked, because {what} undecided: {cause}; rebuild the model there in CAD"


def mend(
    ready: Prepared, cutter: Cutter, everywhere: Everywhere, *, progress: Progress | None = None, budget: Budget | None = None
) -> Advice:
    """Find what to do next with one cutter.

    It has no steps where none was looked for: `why` says why.

    `cutter`: one of those given. `everywhere`: what each of them reaches in each setup, the first one first. `budget`: as for
    `steps`.
    """
    over = over_setups([there[cutter] for there in everywhere])[0]
    finished, missed = Finished.of(ready), over.not_reached
    unfinished = np.flatnonzero(missed & ready.finished)
    within, share = int((ready.inside_bodies & missed).sum()), finished.of_rows(unfinished)
    why = undecidable(ready, cutter, over) if len(unfinished) else _why_nothing(ready, within)
    if not why and len(unfinished) and not worth(finished, share):
        why = "what it leaves is too little for advice: less than 0.1 % of the area, or than 1 mm²"
    found = Advice(MendEntry(lost=len(unfinished) + within, buried=within, why=why, lost_share=share))
    if why or not len(unfinished):
        return found
    return steps(ready, found, cutter, everywhere, progress=progress, budget=budget)


def _why_nothing(ready: Prepared, within: int) -> str:
    """What is to be said where no sample of the finished surface is lost; `within`: samples within other bodies."""
    inside = f"{samples(within)} within another body, which is no surface of the finished part" if within else ""
    missing = (
        f"no {'other ' * bool(within)}sample is lost, but faces are missing from what is in the way: no change of the cutter "
        "mends that"
    )
    rest = missing if ready.conditions.surroundings.doubtful else inside and "nothing else is lost"
    return "; ".join(filter(None, (inside, rest)))


_ENDS: tuple[Literal["flat", "ball"], ...] = ("flat", "ball")
#: Cutters that are mended: those that come nearest.
NEAREST = 3
#: The work of advice: so many boxes in any case, and this share of those that the searches for verdicts took.
_WORK_LEAST, _WORK_SHARE = 1e7, 0.15


@reporting(lambda ready: ready.options.reported_unit)
def ask(
    ready: Prepared, everywhere: Everywhere, stage: Callable[[str], AbstractContextManager[Progress]], *, searched: int = 0,
    least: LeastSet | None = None, answered: Callable[[Answers, Sequence[str]], None] = lambda answers, unanswered: None,
) -> Answers:  # fmt: skip
    """Answer what is asked.

    `everywhere`: what each cutter reaches in each setup, the first one first.
    `stage`: opens a stage of work by its name; what it gives is told how much of how much is done.
    `searched`: boxes that the searches for verdicts looked at: the work of advice is bounded by a share of them.
    `least`: the fewest runs, as they are known already: one of the answers.
    `answered`: called with the answers so far and the words of those that are missing, whenever one is found.
    """
    requested = unanswered = tuple(ready.options.answers)
    stick_outs, mends, radius_maps = dict[str, StickOut](), dict[str, Advice](), list[RadiusMap]()
    near, failing = list[Cutter](), list[Cutter]()

    def so_far(*done: str) -> Answers:
        nonlocal unanswered
        unanswered = tuple(word for word in unanswered if word not in done)
        rest = tuple(cutter.id for cutter in failing if cutter not in near)
        answers = Answers(dict(stick_outs), tuple(radius_maps), dict(mends), rest, least)
        answered(answers, unanswered)
        return answers

    if "stick-out" in requested:
        with stage("stick-out") as tell:
            for k, cutter in enumerate(ready.cutters):
                verdicts, mine = [there[cutter] for there in everywhere], part_of(tell, k, len(ready.cutters))
                stick_outs[cutter.id] = stick_out_in_each(ready, cutter, verdicts, over_setups(verdicts)[1], progress=mine)
                so_far()
        so_far("stick-out")
    if "radius" in requested:
        with stage("radius") as tell:
            ratio = ready.options.length_over_radius
            radius_maps = [radius_in_any(ready, shape, ratio=ratio, tell=part_of(tell, k, 2)) for k, shape in enumerate(_ENDS)]
        so_far("radius")
    if "mend" in requested:
        failing = nearest(ready, everywhere)
        near = failing[:NEAREST]
        with stage("mend") as tell:
            whole = Budget(EFFORT[ready.options.effort] * (_WORK_LEAST + _WORK_SHARE * searched))
            for k, cutter in enumerate(near):
                mine, budget = part_of(tell, k, len(near)), Budget(whole.left / (len(near) - k))
                mends[cutter.id] = mend(ready, cutter, everywhere, progress=mine, budget=budget)
                so_far()
    return so_far(*unanswered)


def nearest(ready: Prepared, everywhere: Everywhere) -> list[Cutter]:
    """Cutters that do not finish the part in all setups together, the one that leaves least first, then by rank."""
    finished, missing = Finished.of(ready), ready.conditions.surroundings.doubtful
    unreached = {}
    for cutter in ready.cutters:
        not_reached = np.logical_and.reduce([there[cutter].not_reached for there in everywhere]) & finished.wanted
        if not_reached.any() or missing:
            unreached[cutter] = finished.of_rows(np.flatnonzero(not_reached))
    return sorted(unreached, key=lambda cutter: round(unreached[cutter], 9))
