"""What would make it feasible: for a cutter that does not finish a part, the least change of one thing, found and then judged."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from plan_cutters.answers.other_cutter import corner_radius, radius, stick_out
from plan_cutters.answers.other_place import faces, setup, tolerance
from plan_cutters.answers.other_range import tilt_limit, tilt_range
from plan_cutters.answers.outcome import none
from plan_cutters.answers.trial import Case, Trials, samples
from plan_cutters.domain.change import THINGS, Change, Mend, Thing, Value
from plan_cutters.domain.cutter import Cutter
from plan_cutters.domain.verdicts import Reach
from plan_cutters.scene.prepared import Prepared

#: The order of work: what one finds spares another.
_WORK: tuple[Thing, ...] = (
    "faces", "stick_out", "tilt_range", "tilt_limit", "setup", "corner_radius", "radius", "tolerance"
)  # fmt: skip


def mend(
    ready: Prepared, cutter: Cutter, reach: Reach, *, progress: Callable[[int, int], None] | None = None
) -> Mend:  # fmt: skip
    """Find for each thing that could be changed alone the change that asks least and lets a cutter finish the part.

    Values are tried on the samples that are lost now; one that serves there is judged on all samples (`judge`), and so is the
    value a step before it, which must fail. Nothing is told to help that was not judged so.

    Parameters
    ----------
    ready : Prepared
    cutter : Cutter
        One that was judged.
    reach : Reach
        What it reaches, of all samples.
    progress : callable, optional
        Told how many of the things are done, of how many.

    Returns
    -------
    Mend
        Without changes where no sample is lost.

    Examples
    --------
    >>> from plan_cutters.options import Options
    >>> from plan_cutters.pipeline import prepare
    >>> from plan_cutters.stages.judge import judge
    >>> cutter = Cutter.parse("R6L80")
    >>> ready = prepare("samples/v_groove.step", Options(cutters=cutter, grid=9, machine="tilt:10"))
    >>> found = mend(ready, cutter, judge(ready, cutter))
    >>> [(change.thing, change.asked) for change in found.changes if change.helps][1:]
    [('radius', 1.145), ('tilt_limit', 26.8)]
    """
    tell = progress or (lambda done, total: None)
    trials = Trials.of(reach)
    around = ready.conditions.around
    within = int((ready.buried[trials.lost] >= 0).sum())
    if not len(trials.lost):
        why = "no sample is lost, but faces are missing from what is in the way: no change of the cutter mends that" \
              if around.doubtful else ""  # fmt: skip
        return Mend(cutter.id, 0, 0, (), why)
    case = Case(ready, cutter)
    found: dict[Thing, Change] = {}
    for done, thing in enumerate(_WORK):
        tell(done, len(_WORK))
        if within and thing != "faces":
            found[thing] = none(thing, present(case, thing), len(trials.lost), f"{samples(within)} within a body")
        else:
            found[thing] = _change(thing, case, trials, reach, found)
    tell(len(_WORK), len(_WORK))
    if around.doubtful:
        found = {thing: _doubted(change) for thing, change in found.items()}
    rank = {True: 0, None: 1, False: 2}
    changes = sorted(found.values(), key=lambda change: (rank[change.helps], THINGS.index(change.thing)))
    why = ""
    if within:
        why = f"{samples(within)} within a body, out of reach of every cutter: nothing but leaving out faces can help"
    elif not any(change.helps for change in changes):
        why = "no change of one thing is known to help"
    return Mend(cutter.id, len(trials.lost), within, tuple(changes), why)


def _change(thing: Thing, case: Case, trials: Trials, reach: Reach, found: dict[Thing, Change]) -> Change:
    if thing == "setup":
        return setup(case, trials, found["tilt_limit"])
    if thing == "tolerance":
        return tolerance(case, trials, reach)
    each: dict[Thing, Callable[[Case, Trials], Change]] = {
        "faces": faces, "stick_out": stick_out, "tilt_range": tilt_range, "tilt_limit": tilt_limit,
        "corner_radius": corner_radius, "radius": radius,
    }  # fmt: skip
    return each[thing](case, trials)


def present(case: Case, thing: Thing) -> Value:
    """The value of a thing now."""
    conditions, scene, cutter = case.ready.conditions, case.ready.scene, case.cutter
    limit = conditions.machine.tilt_limit
    low, high = (round(float(np.degrees(tilt)), 6) for tilt in conditions.postures.tilt)
    values: dict[Thing, Value] = {
        "tolerance": scene.asked, "tilt_range": (low, high), "stick_out": cutter.length, "setup": scene.setup,
        "corner_radius": cutter.corner_radius, "radius": cutter.radius,
        "tilt_limit": None if limit is None else round(float(np.degrees(limit)), 6),
    }  # fmt: skip
    return values.get(thing)


def _doubted(change: Change) -> Change:
    """Where faces are missing from what is in the way, nothing is sure to help."""
    if not change.helps:
        return change
    return replace(
        change, helps=None, why=f"{change.why}, unless a face is in the way that is missing from the obstacles"
    )
