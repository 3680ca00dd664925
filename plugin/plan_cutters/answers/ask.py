"""All answers that the options of a plan ask for, one after the other."""

from collections.abc import Callable, Mapping, Sequence
from contextlib import AbstractContextManager
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from plan_cutters.answers.areas import Finished
from plan_cutters.answers.in_setups import radius_in_any, stick_out_in_each
from plan_cutters.answers.mend import mend
from plan_cutters.domain.change import Advice
from plan_cutters.domain.cutter import Cutter
from plan_cutters.domain.least_set import LeastSet
from plan_cutters.domain.lengths import reporting
from plan_cutters.domain.over_setups import over_setups
from plan_cutters.domain.radius_map import RadiusMap
from plan_cutters.domain.stick_out import StickOut
from plan_cutters.domain.verdicts import Verdicts
from plan_cutters.option_table import EFFORT
from plan_cutters.outcome import Answers
from plan_cutters.scene.preparation import Prepared
from plan_cutters.scene.threads import Progress, part_of
from plan_cutters.scene.work import Budget

Axis = tuple[float, float, float]
OtherSetups = Sequence[tuple[Axis, Mapping[str, Verdicts]]]

_ENDS: tuple[Literal["flat", "ball"], ...] = ("flat", "ball")
#: Cutters that are mended: those that come nearest.
NEAREST = 3
#: The work of advice: so many boxes in any case, and this share of those that the searches for verdicts took.
_WORK_LEAST, _WORK_SHARE = 1e7, 0.15


@reporting(lambda ready: ready.options.reported_unit)
def ask(
    ready: Prepared,
    reaches: Mapping[Cutter, Verdicts],
    stage: Callable[[str], AbstractContextManager[Progress]],
    other_setups: OtherSetups = (),
    *,
    searched: int = 0,
    least: LeastSet | None = None,
    answered: Callable[[Answers, Sequence[str]], None] = lambda answers, unanswered: None,
) -> Answers:
    """Answer what is asked.

    Parameters
    ----------
    ready : Prepared
    reaches : mapping
        What each cutter reaches.
    stage : callable
        Opens a stage of work by its name; what it gives is told how much of how much is done.
    other_setups : sequence
        Of each other setup its axis, and what each cutter reaches there by its id.
    searched : int
        Boxes that the searches for verdicts looked at: the work of advice is bounded by a share of them.
    least : LeastSet, optional
        The fewest runs, as they are known already: one of the answers.
    answered : callable, optional
        Called with the answers so far and the words of those that are missing, whenever one is found.
    """
    requested = ready.options.answers
    setups = {c: [reaches[c], *(there[c.id] for _, there in other_setups)] for c in reaches}
    together = {cutter: over_setups(each) for cutter, each in setups.items()}
    stick_outs, mends = dict[str, StickOut](), dict[str, Advice]()
    radius_maps: list[RadiusMap] = []
    near: list[Cutter] = []
    failing: list[Cutter] = []
    unanswered = tuple(requested)

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
                mine = part_of(tell, k, len(ready.cutters))
                stick_outs[cutter.id] = stick_out_in_each(ready, cutter, setups[cutter], together[cutter][1], progress=mine)
                so_far()
        so_far("stick-out")
    if "radius" in requested:
        with stage("radius") as tell:
            ratio = ready.options.length_over_radius
            radius_maps = [
                radius_in_any(ready, shape, ratio=ratio, progress=part_of(tell, k, 2)) for k, shape in enumerate(_ENDS)
            ]
        so_far("radius")
    if "mend" in requested:
        failing = nearest(ready, reaches, other_setups)
        near = failing[:NEAREST]
        with stage("mend") as tell:
            whole = Budget(EFFORT[ready.options.effort] * (_WORK_LEAST + _WORK_SHARE * searched))
            for k, cutter in enumerate(near):
                mends[cutter.id] = mend(
                    ready, cutter, together[cutter][0], reaches, other_setups, progress=part_of(tell, k, len(near)),
                    budget=Budget(whole.left / (len(near) - k)),
                )  # fmt: skip
                so_far()
    return so_far(*unanswered)


def _missed(reaches: Mapping[Cutter, Verdicts], other_setups: OtherSetups, cutter: Cutter) -> NDArray[np.bool_]:
    """Samples (n,) that a cutter does not reach in any setup."""
    each = [reaches[cutter], *(found[cutter.id] for _, found in other_setups)]
    return np.logical_and.reduce([verdicts.not_reached for verdicts in each])


def nearest(ready: Prepared, reaches: Mapping[Cutter, Verdicts], other_setups: OtherSetups) -> list[Cutter]:
    """Cutters that do not finish the part in all setups together, the one that leaves least first, then by rank."""
    finished, missing = Finished.of(ready), ready.conditions.surroundings.doubtful
    unreached = {}
    for cutter in ready.cutters:
        not_reached = _missed(reaches, other_setups, cutter) & finished.wanted
        if not_reached.any() or missing:
            unreached[cutter] = finished.of_rows(np.flatnonzero(not_reached))
    return sorted(unreached, key=lambda cutter: round(unreached[cutter], 9))
