"""Find what to do next with a cutter that does not finish a part: steps and their gain, or why none is looked for."""

from collections.abc import Mapping, Sequence

import numpy as np

from plan_cutters.answers.areas import Finished
from plan_cutters.answers.option import Axis
from plan_cutters.answers.steps import steps, worth
from plan_cutters.answers.undecidable import undecidable
from plan_cutters.domain.change import Advice
from plan_cutters.domain.cutter import Cutter
from plan_cutters.domain.verdicts import Verdicts
from plan_cutters.plan_file.words.answers import samples
from plan_cutters.scene.preparation import Prepared
from plan_cutters.scene.threads import Progress
from plan_cutters.scene.work import Budget


def mend(
    ready: Prepared,
    cutter: Cutter,
    over: Verdicts,
    reaches: Mapping[Cutter, Verdicts],
    other_setups: Sequence[tuple[Axis, Mapping[str, Verdicts]]] = (),
    *,
    progress: Progress | None = None,
    budget: Budget | None = None,
) -> Advice:
    """Find what to do next with one cutter.

    Parameters
    ----------
    ready : Prepared
    cutter : Cutter
        One of `reaches`.
    over : Verdicts
        What it reaches, of all samples, in all setups together.
    reaches : mapping
        What each given cutter reaches in the plan's first setup.
    other_setups : sequence
        Of each other setup its axis, and what each cutter reaches there by its id.
    progress : callable, optional
        Called with the number of cases judged, and the largest number there can be.
    budget : Budget, optional
        As for `steps`.

    Returns
    -------
    Advice
        Without steps where none was looked for: `why` says why.
    """
    finished, missed = Finished.of(ready), over.not_reached
    unfinished = np.flatnonzero(missed & ready.finished)
    within, share = int((ready.inside_bodies & missed).sum()), finished.of_rows(unfinished)
    why = undecidable(ready, cutter, over) if len(unfinished) else _why_nothing(ready, within)
    if not why and len(unfinished) and not worth(finished, share):
        why = "what it leaves is too little for advice: less than 0.1 % of the area, or than 1 mm²"
    found = Advice(cutter.id, len(unfinished) + within, within, why, share)
    if why or not len(unfinished):
        return found
    return steps(ready, found, cutter, reaches, other_setups, progress=progress, budget=budget)


def _why_nothing(ready: Prepared, within: int) -> str:
    """What is to be said where no sample of the finished surface is lost; `within`: samples within other bodies."""
    inside = f"{samples(within)} within another body, which is no surface of the finished part" if within else ""
    missing = (
        f"no {'other ' * bool(within)}sample is lost, but faces are missing from what is in the way: no change of the cutter "
        "mends that"
    )
    rest = missing if ready.conditions.surroundings.doubtful else inside and "nothing else is lost"
    return "; ".join(filter(None, (inside, rest)))
