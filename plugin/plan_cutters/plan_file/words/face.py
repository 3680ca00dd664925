"""Why a cutter does not reach a face, what is in the way there, and what would help."""

from collections import Counter
from collections.abc import Sequence
from typing import NamedTuple

from plan_cutters.domain.figures import count, mm, percent
from plan_cutters.plan_file.answers import MendEntry, StepEntry
from plan_cutters.plan_file.model import CutterEntry, FaceEntry, Plan, WitnessEntry
from plan_cutters.plan_file.shares import FaceVerdicts, by_share, part_of, unreached
from plan_cutters.plan_file.words.cutters import called, reason
from plan_cutters.plan_file.words.names import named
from plan_cutters.plan_file.words.next_steps import effect, is_excluded


class InTheWay(NamedTuple):
    """A face, or `fixture:NAME`, that is in the way at the best postures, and how deep in the tool (mm; None: not known)."""

    face: str
    reason: str
    depth_mm: float | None
    places: int


def in_the_way(witnesses: Sequence[WitnessEntry]) -> list[InTheWay]:
    """Obstacles that some witnesses name, the one that most of them name first."""
    places = Counter((w.obstacle_face, w.reason) for w in witnesses if w.obstacle_face)
    depths: dict[tuple[str, str], float] = {}
    for w in witnesses:
        if w.obstacle_face and w.depth_mm is not None:
            key = w.obstacle_face, w.reason
            depths[key] = max(w.depth_mm, depths.get(key, w.depth_mm))
    places_hit = [InTheWay(face or "", code, depths.get((face or "", code)), n) for (face, code), n in places.items()]
    return sorted(places_hit, key=lambda each: (-each.places, -(each.depth_mm or 0.0), each.face))


def helping(advice: MendEntry) -> list[StepEntry]:
    """The steps that gain something."""
    return [step for step in advice.steps if not is_excluded(step) and step.gained]


def face_text(plan: Plan, cutter: CutterEntry, face: FaceEntry, unhelped: str) -> str:
    """Say how much of a face a cutter does not reach, why, what is in the way, and what would help.

    Parameters
    ----------
    plan : Plan
    cutter : CutterEntry
        Of the plan.
    face : FaceEntry
        A target of the plan.
    unhelped : str
        Why no change is known that helps; a clause.

    Returns
    -------
    str
        Sentences, with cutters called as everywhere.
    """
    verdicts = cutter.faces.get(face.id, FaceVerdicts())
    if not verdicts.reached and not verdicts.not_reached:
        inside = "all of it lies inside other bodies of the part" if verdicts.inside_bodies else face.unjudged
        return f"{face.id} could not be judged: {inside or 'it has no sample'}."
    doubt = f" Of {face.id} could not be judged: {face.unjudged}." if face.unjudged else ""
    if not verdicts.not_reached:
        return named(plan, f"{cutter.id} reaches every judged sample of {face.id} ({verdicts.reached:,}).{doubt}")
    text = _loss(cutter, face, verdicts)
    mine = [w for w in cutter.witnesses if w.face == face.id and not w.inside_bodies]
    if way := in_the_way(mine):
        deep = f", up to {mm(way[0].depth_mm)} deep in the tool" if way[0].depth_mm is not None else ""
        text += f" At the best posture {called(way[0].face)} is in the way{deep}."
    changes = helping(cutter.mend) if cutter.mend else []
    text += f" What would help: {_gain(changes[0])}." if changes else f" What would help is not known: {unhelped}."
    return named(plan, text + doubt)


def _loss(cutter: CutterEntry, face: FaceEntry, verdicts: FaceVerdicts) -> str:
    share = verdicts.area_share
    why = ", ".join(f"{reason(code)} {percent(part, some=True, whole=False)}" for code, part in by_share(share.lost_by))
    text = (
        f"{cutter.id} does not reach {unreached(verdicts, share)} of {face.id} ({count(verdicts.not_reached, 'sample')}): "
        f"{why or 'no reason is known'}."
    )
    if verdicts.undecided:
        much = part_of(verdicts, share, ["undecided"])
        text += f" {much} of it is undecided ({verdicts.undecided:,} samples): neither proved safe nor proved blocked."
    return text


def _gain(step: StepEntry) -> str:
    option = f" [{step.option}]" if step.option else ""
    return f"{step.why}: {effect(step)}{option}"


def posture_text(face: str, free: float, undecided: float, forbidden: Sequence[tuple[str, float]], *, certified: bool) -> str:
    """Say how many of the postures at a point are free, or what forbids the most of them; shares are 0 to 1."""
    place = f"At the point, on {face}, "
    if free > 0.0:
        sure = "" if certified else ", provided that no missing obstacle is in the way,"
        return f"{place}{percent(free)} of the postures{sure} are free."
    if undecided > 0.0:
        return f"{place}no posture is surely free; {percent(undecided)} are undecided."
    why = ", ".join(f"{reason(code)} {percent(share)}" for code, share in forbidden[:3])
    return f"{place}no posture that was searched is free ({why or 'no contact'})."


def sample_text(distance_mm: float, verdict: str, code: str | None) -> str:
    """Say what is known of the sample that is nearest to a point."""
    why = f", {reason(code)}" if code else ""
    return f"The nearest sample, {mm(distance_mm)} off, is {verdict.replace('_', '-')}{why}."
