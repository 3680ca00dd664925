"""How much is undecided for the cutter of the headline, on which faces, why, and what would decide it."""

import math
from collections.abc import Iterator, Mapping

from plan_cutters.domain.figures import capital, count, listed, mm, percent
from plan_cutters.plan_file.model import CutterEntry, Plan
from plan_cutters.plan_file.shares import part_of
from plan_cutters.plan_file.words.scope import headline_cutter

#: Faces that are named one by one.
_FACES = 3
#: A tolerance that is finer by this is the next to try.
_FINER = 2.0


def undecided(plan: Plan, names: Mapping[str, str]) -> list[str]:
    """Two sentences, how much and where, and why with what would decide it; none where no sample is undecided."""
    entry = headline_cutter(plan)
    if not entry.undecided:
        return []
    share = part_of(entry, entry.area_share, ["undecided"])
    where = (
        f"{capital(names[entry.id])} leaves {share} of the area undecided ({count(entry.undecided, 'sample')}): "
        f"{_where(plan, entry)}."
    )
    return [where, " ".join(_causes(plan, entry))]


def _where(plan: Plan, entry: CutterEntry) -> str:
    """Faces with their own undecided shares, the largest undecided area first."""

    def area(name: str) -> float:
        face_entry = entry.faces[name]
        mm2 = face_entry.area_share.undecided * (1.0 - face_entry.inside_share) * sizes[name]
        return mm2 if math.isfinite(mm2) else 0.0

    sizes = {face.id: face.area_mm2 for face in plan.faces}
    faces = sorted((name for name, face_entry in entry.faces.items() if face_entry.undecided), key=lambda name: -area(name))
    each = [f"{part_of(entry.faces[f], entry.faces[f].area_share, ['undecided'])} of {f}" for f in faces]
    return listed(each, _FACES)


def _causes(plan: Plan, entry: CutterEntry) -> Iterator[str]:
    """Say each cause that there may be. Which of several left a sample undecided is known only for the tolerance."""
    tolerance, raised = plan.effective.tolerance_mm, "tolerance_raised" in plan.note_codes
    # Of a cutter that is too small, all samples; else those on faces that triangles do not follow.
    coarse = entry.undecided_by_reason.get("tolerance", 0)
    if coarse and coarse >= plan.samples.judged:
        way = (
            "No smaller --tolerance can be kept: rebuild in CAD what triangles cannot follow, or judge a larger cutter"
            if raised
            else "A smaller --tolerance decides it"
        )
        yield f"The tolerance, {mm(tolerance)}, is too coarse for this cutter. {way}."
        return
    loose, missing = plan.effective.local_tolerance, plan.missing
    if loose:
        names, it = listed([each.face for each in loose], _FACES), "it" if len(loose) == 1 else "they"
        share = sum(each.share for each in loose)
        of = f", {percent(share)} of the area to be machined" if share > 0.0 else ""
        yield (
            f"Triangles follow {names} only within {mm(loose[0].chord_error_mm)}{of}: what only {it} may forbid stays "
            "undecided until the model is rebuilt there in CAD."
        )
    if missing:
        unread = list(dict.fromkeys(each.face or each.name or "a face" for each in missing))
        yield (
            f"Obstacles are missing or only guessed ({listed(unread, _FACES)}): what they may forbid stays undecided until "
            "the file is repaired."
        )
    if coarse == entry.undecided:
        return
    finer = f"--tolerance {tolerance / _FINER:.3g}"
    if raised:
        yield f"The tolerance had to be raised to {mm(tolerance)}: what is this narrow stays undecided."
    elif loose or missing:
        yield f"What is left is too narrow for the tolerance; {finer} looks more closely."
    else:
        yield (
            f"The cutter is so near to an obstacle there that the tolerance, {mm(tolerance)}, does not decide; {finer} looks "
            "more closely."
        )
