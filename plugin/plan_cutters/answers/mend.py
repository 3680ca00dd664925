"""Find what-if answers: if a cutter does not finish a part, find the least change of one thing, and then judge it."""

from collections.abc import Callable
from dataclasses import replace

from plan_cutters.answers.areas import Finished
from plan_cutters.answers.option import option
from plan_cutters.answers.trial import Case, Trials
from plan_cutters.answers.what_if import WhatIf, search
from plan_cutters.answers.what_if_cutter import corner_radius, radius, stick_out
from plan_cutters.answers.what_if_place import faces, setup, tolerance
from plan_cutters.answers.what_if_tilt import tilt_limit, tilt_range
from plan_cutters.domain.change import THINGS, Change, Thing, WhatIfAnswer
from plan_cutters.domain.cutter import Cutter
from plan_cutters.domain.verdicts import Verdicts
from plan_cutters.plan_file.words.change_text import samples
from plan_cutters.scene.preparation import Prepared

#: What if one thing were another, in the order of work: what one finds spares another.
_WHAT_IFS: dict[Thing, Callable[[Case, Trials], WhatIf | Change]] = {
    "faces": faces, "stick_out": stick_out, "tilt_range": tilt_range, "tilt_limit": tilt_limit, "setup": setup,
    "corner_radius": corner_radius, "radius": radius, "tolerance": tolerance,
}  # fmt: skip


def mend(
    ready: Prepared, cutter: Cutter, verdicts: Verdicts, *, progress: Callable[[int, int], None] | None = None
) -> WhatIfAnswer:
    """Find for each thing that could be changed alone the change that asks least and lets a cutter finish the part.

    Of several setups one sample after the other is asked in each: the part is finished where they reach all of it together.

    Values are tried on the samples that are not reached now; one that serves there is judged on all samples (`judge`), and so is
    the value a step before it, which must fail. Nothing is told to help that was not judged so.

    Parameters
    ----------
    ready : Prepared
    cutter : Cutter
        One that was judged.
    verdicts : Verdicts
        What it reaches, of all samples, in one setup or another.
    progress : callable, optional
        Called with the number of things done, and the number of all.

    Returns
    -------
    Mend
        Without changes where no sample of the finished surface is lost.

    Examples
    --------
    >>> from plan_cutters.options import Options
    >>> from plan_cutters.pipeline import prepare
    >>> from plan_cutters.stages.judge import judge
    >>> cutter = Cutter.parse("R6L80")
    >>> ready = prepare("samples/v_groove.step", Options(cutters=cutter, grid=9, machine="tilt:10"))
    >>> found = mend(ready, cutter, judge(ready, cutter))
    >>> [(change.thing, change.asked) for change in found.changes if change.helps][1:]
    [('radius', 1.0), ('tilt_limit', 26.8)]
    """
    tell = progress or (lambda done, total: None)
    trials = Trials.of(verdicts, ready.finished)
    surroundings = ready.conditions.surroundings
    within = int((ready.inside_bodies & verdicts.not_reached).sum())
    if not len(trials.not_reached):
        inside = f"{samples(within)} within another body, which is no surface of the finished part" if within else ""
        missing = (
            f"no {'other ' * bool(within)}sample is lost, but faces are missing from what is in the way: no change of the cutter "
            "mends that"
        )
        why = "; ".join(filter(None, (inside, missing if surroundings.doubtful else inside and "nothing else is lost")))
        return WhatIfAnswer(cutter.id, within, within, (), why)
    case = Case(ready, cutter)
    share = Finished.of(ready).of_rows(trials.not_reached)
    for done, (thing, what_if) in enumerate(_WHAT_IFS.items()):
        tell(done, len(_WHAT_IFS))
        what = what_if(case, trials)
        trials.found[thing] = what if isinstance(what, Change) else search(thing, what, trials)
    tell(len(_WHAT_IFS), len(_WHAT_IFS))
    answers = [_with_option(case, change, share) for change in trials.found.values()]
    if surroundings.doubtful:
        answers = [_doubted(change) for change in answers]
    rank = {True: 0, None: 1, False: 2}
    changes = sorted(answers, key=lambda change: (rank[change.helps], THINGS.index(change.thing)))
    why = "" if any(change.helps for change in changes) else "no change of one thing is known to help"
    return WhatIfAnswer(cutter.id, len(trials.not_reached) + within, within, tuple(changes), why)


def _with_option(case: Case, change: Change, share: float) -> Change:
    """With the share of the finished area that is not reached now and with it, and how it is said on the command line."""
    if not change.helps:
        return replace(change, before=share)
    words = dict(change.options)
    faces = str(words.get("faces", ""))
    conditions = case.ready.conditions
    conditions = replace(conditions, machine=words.get("machine", conditions.machine))
    if "tilt" in words:
        conditions = replace(conditions, postures=replace(conditions.postures, tilt=words["tilt"]))
    answer = option(
        case.ready,
        case.cutter,
        cutters=words.get("cutters", (case.cutter,)),
        conditions=conditions,
        setups=(words["setup"], *case.ready.options.other_setups) if "setup" in words else None,
        flip=words.get("flip"),
        tolerance=words.get("tolerance"),
        faces=[int(each[1:]) for each in faces.split(",")] if faces else None,
    )
    return replace(change, before=share, after=0.0, option=answer)


def _doubted(change: Change) -> Change:
    """Where faces are missing from what is in the way, nothing is sure to help."""
    if not change.helps:
        return change
    why = f"{change.why}, unless a missing obstacle is in the way"
    return replace(change, helps=None, doubted=True, why=why)
