"""Put into words what would help against a cause: what was judged to help, else what to try first."""

import math
import re

from plan_cutters.domain.figures import listed, percent, reported
from plan_cutters.plan_file.answers import MendEntry
from plan_cutters.plan_file.model import Plan
from plan_cutters.plan_file.process import UNJUDGED_CAUSE, FitEntry, HelpEntry, RemainingEntry
from plan_cutters.plan_file.reasons import CLOSED_VOID, REASONS
from plan_cutters.plan_file.words.scope import shown_cutter

#: Faces that are named; shares of an area from which on points are named, and from which on they are most of it.
_FACES, _NAMED, _POINTS, _MAINLY = 2, 3, 0.05, 0.5
#: A step that does less of an area is no answer to it; what does so much leaves hardly any; a size that fits less does not fit.
_HELPS, _NEARLY, _SOME = 0.1, 0.9, 0.01
#: Shares that differ by less are alike.
_ALIKE = 0.05


def needs(plan: Plan, entry: RemainingEntry) -> str:
    """Say what would help against a cause, in a clause; empty where nothing is known."""
    if entry.cause == "sharp_edge" and plan.sharp_edges:
        return f"the model has no fillet there, and the cutter leaves one of R{reported(plan.sharp_edges[0].radius_mm):.4g}"
    if entry.cause == UNJUDGED_CAUSE:
        faces = set(entry.faces)
        return next((face.unjudged for face in plan.faces if face.id in faces and face.unjudged), "") or ""
    if entry.cause not in REASONS:
        return ""
    if entry.cause == "buried" and (shut := [face for face in entry.faces if face in plan.part.void_faces]):
        if len(shut) == len(entry.faces):
            return CLOSED_VOID
        return f"{CLOSED_VOID} at {listed(shut, _NAMED)}; for the rest {REASONS[entry.cause].hint}"
    advice = shown_cutter(plan).mend
    hint = first_tries(entry.cause, advice)
    if advice is not None and (best := _best(entry, advice)) is not None:
        what = re.sub(r" \([^()]*\)|,? for the rest$", "", advice.steps[best.step].why)
        first, share = f"{what} {'may finish' if advice.unsure else 'finishes'} {_share(best.share)} of it", best.share
    elif hint and entry.fits is not None:
        # What was judged says more than a hint; a size that reaches next to nothing is none that fits.
        first = _sizes(entry.fits)
        share = entry.fits[-1].share if first else 0.0
    else:
        first, share = hint or "no change that was tried helps", 0.0
    points = _points(entry, share)
    return "; ".join(filter(None, (first or ("" if points else "no usual size fits"), points)))


def _best(entry: RemainingEntry, advice: MendEntry) -> HelpEntry | None:
    """The step that does most of an area; where others do hardly less, one on the same machine, of fewer changes."""
    known = [each for each in entry.helped if each.step < len(advice.steps) and each.share >= _HELPS]

    def effort(each: HelpEntry) -> tuple[bool, int, float, int]:
        things = [change.thing for change in advice.steps[each.step].changes]
        return "tilt_limit" in things, len(things), -each.share, each.step

    return min((each for each in known if each.share >= known[0].share - _ALIKE), key=effort, default=None)


def first_tries(cause: str, advice: MendEntry | None) -> str:
    """Say what to try first against a cause, but for what an answer found to be of no use; empty where that is all of it."""
    if cause not in REASONS:
        return ""
    return ", or ".join(words for words, means in REASONS[cause].tries if not (means and all(_refuted(advice, m) for m in means)))


def _refuted(advice: MendEntry | None, means: str) -> bool:
    """Whether steps were looked for, and none of them is such a change."""
    return (
        advice is not None
        and bool(advice.steps)
        and all(change.thing != means for step in advice.steps for change in step.changes)
    )


def _sizes(fits: list[FitEntry]) -> str:
    """Which sizes reach how much; empty where they reach less than a hundredth.

    >>> fits = [("R1.5L40", "D3", 3.0, 0.749), ("R1L40", "D2", 2.0, 0.9)]
    >>> _sizes([FitEntry(cutter=spec, kind="flat end", size=d, diameter_mm=mm, share=s) for spec, d, mm, s in fits])
    'flat end D3 fits 74 % of it, D2 90 %'
    """
    if not fits or fits[0].share < _SOME:
        return ""
    first, *more = fits
    smaller = [f"{each.size} {_share(each.share)}" for each in more]
    return ", ".join([f"{first.kind} {first.size} fits {_share(first.share)} of it", *smaller])


def _share(share: float) -> str:
    """A share in whole percents, no more than it is.

    >>> _share(0.749), _share(1.0), _share(0.004)
    ('74 %', '100 %', '<0.1 %')
    """
    return percent(math.floor(100.0 * share + 1e-9) / 100.0, some=True)


def _points(entry: RemainingEntry, share: float) -> str:
    """Say that no end fits the points of cones: where they are most of an area, or much of one of which a share leaves a part."""
    points = entry.points
    if points is None or points.share < (_MAINLY if share >= _NEARLY else _POINTS):
        return ""
    which = "" if share else f" ({listed(points.faces, _FACES)})"
    return f"no end fits a cone's point{which}: left for a drill or by hand"
