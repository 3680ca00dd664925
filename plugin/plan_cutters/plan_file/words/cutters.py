"""Describe cutters and faces: how much is reached, where a cutter fails and why, what is in the way there."""

import itertools
import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

from plan_cutters.domain.figures import angle, capital, count, direction, figure, listed, mm, percent, place, reported, size, unit
from plan_cutters.plan_file.answers import MendEntry, StepEntry
from plan_cutters.plan_file.model import CutterEntry, FaceEntry, Plan, WitnessEntry
from plan_cutters.plan_file.reasons import REASONS, reason
from plan_cutters.plan_file.shares import VERDICTS, AreaShare, FaceVerdicts, by_share, part_of, reached, unreached
from plan_cutters.plan_file.words.answers import effect, first_step, first_tries, is_excluded, step_text
from plan_cutters.plan_file.words.headline import area, between, every
from plan_cutters.plan_file.words.names import described, named
from plan_cutters.plan_file.words.notes import machine

#: Faces that are named on which a cutter leaves something, and those of its story.
_FACES, _WORST = 3, 5
FEASIBLE = {True: "yes", False: "no", None: "undecided"}


@dataclass(frozen=True, slots=True)
class WorstFace:
    """A face on which a cutter loses samples."""

    id: str
    name: str
    area: str  #: How much of it, mm2.
    share: str  #: The same in percent.
    reason: str  #: By which mostly.
    depth: str  #: How much too deep the deepest witness there is, mm; may be empty.
    obstacle: str  #: In what; may be empty.


@dataclass(frozen=True, slots=True)
class CutterStory:
    """A cutter's story has these texts; a text is empty where there is nothing to say."""

    id: str
    name: str  #: That of all texts.
    tool: str  #: Its kind, and how far it stands out of which holder.
    feasible: bool | None
    reached: str  #: Percent of the area.
    shares: dict[str, str]  #: The same by verdict.
    reason: str  #: That of most of what is not reached.
    hint: str  #: The thing to try first against it.
    sentence: str  #: How much it reaches, or `left`.
    next: str  #: The next step.
    left: str  #: What it leaves.
    between: str  #: How much is known between its samples.
    faces: tuple[WorstFace, ...]  #: The worst ones.
    failing: int  #: How many there are in all.


def cutter_story(plan: Plan, c: CutterEntry, name: str) -> CutterStory:
    """All that is told of a cutter."""
    main, hint = REASONS.get(main_reason(c.area_share)), ""
    # No hint where all that lies inside material is the wall of a closed void.
    enclosed = {face for face, each in c.faces.items() if each.area_share.lost_by.get("buried")}
    if main and not (main.code == "buried" and enclosed <= set(plan.part.void_faces)):
        hint = first_tries(main.code, c.mend)
    loss = capital(named(plan, remaining_text(plan, c))) if c.not_reached else ""
    unsure = "" if c.feasible else ", but obstacles are missing that may be in its way"
    failing = _by_remaining_area(plan, c)
    return CutterStory(
        id=c.id, name=name, tool=described(c, name), feasible=c.feasible, reached=reached(c, c.area_share),
        shares={word: part_of(c, c.area_share, [word]) for word in VERDICTS}, reason=main.name if main else "", hint=hint,
        sentence=loss or f"{capital(name)} reaches {every(plan)}{unsure}.", next=_next(plan, c), left=loss,
        between=between(plan, c), faces=tuple(_worst(face, c) for face in failing[:_WORST]), failing=len(failing),
    )  # fmt: skip


def main_reason(share: AreaShare) -> str:
    """By which reason the most is not reached; empty where all is reached."""
    return max(share.lost_by, key=lambda name: share.lost_by[name], default="")


def _next(plan: Plan, c: CutterEntry) -> str:
    """Say in a sentence the next step, or why there is none."""
    if c.mend is None:
        return ""
    if (step := first_step(c)) is not None:
        return f"Next: {named(plan, step_text(step))}."
    return "No step was found that frees any of it." if c.mend.steps else f"Nothing sure would make it finish: {c.mend.why}."


def reasons(c: CutterEntry) -> list[str]:
    """Why a cutter loses what it loses, with shares of the area: the reason with the largest one first.

    The axis limit says what takes part in it, by samples, the most of them first.
    """
    lines = []
    for code, share in sorted(c.area_share.lost_by.items(), key=lambda item: -item[1]):
        besides = ""
        if code == "axis_limit" and c.axis_limit_with:
            ranked = sorted(c.axis_limit_with.items(), key=lambda item: (-item[1], item[0]))
            each = ", ".join(f"{reason(word)} at {count:,}" for word, count in ranked)
            besides = f" (with {each} sample{'' if ranked[-1][1] == 1 else 's'})"
        lines.append(f"{reason(code)} {percent(share, some=True, whole=False)}{besides}")
    return lines


def remaining_text(plan: Plan, c: CutterEntry) -> str:
    """Say how much a cutter does not reach, why, on which faces, and the worst place."""
    why = ", ".join(reasons(c))
    if c.undecided:
        why += f"; of it {percent(c.area_share.undecided, some=True, whole=False)} is undecided"
    failing = [face.id for face in _by_remaining_area(plan, c)]
    deep = [w for w in c.witnesses if w.depth_mm is not None and not w.inside_bodies]
    where = ""
    if deep:
        worst = max(deep, key=lambda w: w.depth_mm or 0.0)
        sure = "may be" if worst.verdict == "undecided" else "is"
        deep_there = f"where the best posture {sure} {mm(worst.depth_mm)} too deep"
        where = f"; the worst is on {worst.face} at ({place(worst.point)}), {deep_there}"
    return (
        f"{c.id} does not reach {unreached(c, c.area_share)} of {area(plan)} ({c.not_reached:,} of {plan.samples.finished:,} "
        f"samples): {why or 'no reason'}. They lie on {listed(failing, _FACES)}{where}."
    )


def called(obstacle: str | None) -> str:
    """Give the name of an obstacle for a text.

    >>> called("fixture:table"), called("F12"), called(None)
    ('fixture table', 'F12', '')
    """
    return (obstacle or "").replace("fixture:", "fixture ", 1)


def spot(witness: WitnessEntry) -> str:
    """A witness in a sentence."""
    if witness.reason == "tolerance":
        return "The tolerance is too coarse to say anything about this cutter."
    text, best, obstacle = capital(reason(witness.reason)), witness.best_posture, called(witness.obstacle_face)
    unsure = witness.verdict == "undecided"
    text += ", undecided" * unsure
    if witness.depth_mm is not None and best is not None:
        there = f"tilt {angle(best.tilt)}, rotation {angle(best.rotation)}"
        if unsure:
            what = obstacle or "the part"
            return f"{text}. At the best posture found ({there}) {what} may reach {mm(witness.depth_mm)} into the tool."
        where = f" in {obstacle}" if obstacle else ""
        if witness.reason != "fixture" and (witness.obstacle_face or "").startswith("fixture:"):
            text += ", without the fixtures too"
        return f"{text}. The best posture found ({there}) is still {mm(witness.depth_mm)} too deep{where}."
    if obstacle:
        return f"{text}. {capital(obstacle)} {'may be' if unsure else 'is'} in the way."
    return f"{text}. No posture is {'sure' if unsure else 'left'}."


def ranked_spots(witnesses: Sequence[WitnessEntry]) -> list[WitnessEntry]:
    """The deepest of each face and reason first, then the others; the deepest first in both."""
    seen, first, rest = set[tuple[str, str]](), list[WitnessEntry](), list[WitnessEntry]()
    for w in sorted((w for w in witnesses if not w.inside_bodies), key=lambda w: -(w.depth_mm or 0.0)):
        (rest if (w.face, w.reason) in seen else first).append(w)
        seen.add((w.face, w.reason))
    return first + rest


def worst_face_text(face: WorstFace) -> str:
    """A face on which a cutter fails, in a line."""
    deep = f", {face.depth} {unit()} too deep" if face.depth else ""
    way = f", {called(face.obstacle)} in the way" if face.obstacle else ""
    return f"{face.id}: {face.area} {unit()}² lost, {face.share} of the face, mainly {face.reason}{deep}{way}"


def _by_remaining_area(plan: Plan, c: CutterEntry) -> list[FaceEntry]:
    """Faces on which a cutter leaves something, the one with the largest area of it first."""

    def rank(face: FaceEntry) -> tuple[float, float]:
        area = _remaining_area(face, c)
        return -area if math.isfinite(area) else 0.0, -c.faces[face.id].area_share.not_reached

    return sorted((face for face in plan.faces if face.id in c.faces and c.faces[face.id].not_reached), key=rank)


def _remaining_area(face: FaceEntry, c: CutterEntry) -> float:
    """Area of a face that a cutter leaves, mm2; not a number where the face's is not known."""
    face_entry = c.faces[face.id]
    return face_entry.area_share.not_reached * (1.0 - face_entry.inside_share - face_entry.drilled_share) * face.area_mm2


def _worst(face: FaceEntry, c: CutterEntry) -> WorstFace:
    mine = [w for w in c.witnesses if w.face == face.id and not w.inside_bodies]
    share = c.faces[face.id].area_share
    main = reason(main_reason(share) or (mine[0].reason if mine else ""))
    unsure = share.undecided > share.inaccessible
    verdict = "undecided" if unsure else "inaccessible"
    deepest = max(mine, key=lambda w: (w.verdict == verdict, w.depth_mm or 0.0), default=None)
    depth = "" if deepest is None or deepest.depth_mm is None else figure(reported(deepest.depth_mm))
    size = figure(reported(reported(_remaining_area(face, c))))
    return WorstFace(
        face.id, face.name, size, unreached(c.faces[face.id], share), f"{'undecided: ' * unsure}{main or '?'}", depth,
        "" if deepest is None else deepest.obstacle_face or "",
    )  # fmt: skip


def scene(plan: Plan) -> str:
    """Give the faces to machine, the samples and the machine in a sentence or two."""
    targets, ignored = len(plan.effective.target_faces), sum(f.ignored for f in plan.faces)
    also = f", {ignored} ignored" if ignored else ""
    return (
        f"The part has {count(plan.part.faces, 'face')}: {targets} to machine{also}, with "
        f"{count(plan.samples.count, 'sample')}, at most {mm(plan.samples.max_gap_mm)} apart. {machine(plan)}"
    )


def rendered(plan: Plan) -> str:
    """Say whose verdicts a drawing of the part shows, and under which conditions they were found."""
    taken = "is selected" if plan.selected else "is shown because it leaves the least area; none is selected"
    return (
        f"This cutter {taken}. Part {size(plan.part.size_mm)}. Machine {plan.effective.machine}, setup axis "
        f"({direction(plan.effective.setup)}), gouge tolerance {mm(plan.effective.tolerance_mm)}, "
        f"{count(plan.samples.count, 'sample')}."
    )


def unjudged_share(plan: Plan) -> str:
    """Say how much of the area could not be judged for any cutter; empty where all could."""
    share = plan.cutters[0].area_share.unjudged
    if not share and not plan.samples.unjudged:
        return ""
    return f"Besides, {percent(share, some=True, whole=False)} of the area could not be judged, for any cutter."


def others(plan: Plan) -> list[str]:
    """Say how much each cutter before the one to take does not reach, and why."""
    before = itertools.takewhile(lambda c: c.id != plan.selected, plan.cutters)
    return [capital(named(plan, remaining_text(plan, c))) for c in before if c.not_reached]


class InTheWay(NamedTuple):
    """A face, or `fixture:NAME`, that is in the way at the best postures, and how deep in the tool (mm; None: not known)."""

    face: str
    reason: str
    depth_mm: float | None
    places: int


def in_the_way(witnesses: Sequence[WitnessEntry]) -> list[InTheWay]:
    """Obstacles that some witnesses name, the one that most of them name first."""
    places: dict[tuple[str, str], list[float | None]] = {}
    for w in witnesses:
        if w.obstacle_face:
            places.setdefault((w.obstacle_face, w.reason), []).append(w.depth_mm)
    each = [
        InTheWay(face, code, max((depth for depth in depths if depth is not None), default=None), len(depths))
        for (face, code), depths in places.items()
    ]
    return sorted(each, key=lambda each: (-each.places, -(each.depth_mm or 0.0), each.face))


def helping(advice: MendEntry) -> list[StepEntry]:
    """The steps that gain something."""
    return [step for step in advice.steps if not is_excluded(step) and step.gained]


def face_text(plan: Plan, cutter: CutterEntry, face: FaceEntry, unhelped: str) -> str:
    """Say how much of a target face a cutter does not reach, why, what is in the way, and what would help.

    `unhelped`: why no change is known that helps, a clause. Cutters are called as everywhere.
    """
    verdicts = cutter.faces.get(face.id, FaceVerdicts())
    if verdicts.drilled and not verdicts.reached and not verdicts.not_reached and not verdicts.unjudged:
        return f"{face.id} is in a hole for a drill: no mill has to reach it (`--drill-below`)."
    if not verdicts.reached and not verdicts.not_reached:
        inside = "all of it lies inside other bodies of the part" if verdicts.inside_bodies else face.unjudged
        return f"{face.id} could not be judged: {inside or 'it has no sample'}."
    doubt = f" Of {face.id} could not be judged: {face.unjudged}." if face.unjudged else ""
    if not verdicts.not_reached:
        return named(plan, f"{cutter.id} reaches every judged sample of {face.id} ({verdicts.reached:,}).{doubt}")
    share = verdicts.area_share
    why = ", ".join(f"{reason(code)} {percent(part, some=True, whole=False)}" for code, part in by_share(share.lost_by))
    text = (
        f"{cutter.id} does not reach {unreached(verdicts, share)} of {face.id} ({count(verdicts.not_reached, 'sample')}): "
        f"{why or 'no reason is known'}."
    )
    if verdicts.undecided:
        much = part_of(verdicts, share, ["undecided"])
        text += f" {much} of it is undecided ({verdicts.undecided:,} samples): neither proved safe nor proved blocked."
    mine = [w for w in cutter.witnesses if w.face == face.id and not w.inside_bodies]
    if way := in_the_way(mine):
        deep = f", up to {mm(way[0].depth_mm)} deep in the tool" if way[0].depth_mm is not None else ""
        text += f" At the best posture {called(way[0].face)} is in the way{deep}."
    if cutter.mend and (changes := helping(cutter.mend)):
        option = f" [`{changes[0].option}`]" if changes[0].option else ""
        text += f" What would help: {changes[0].why}: {effect(changes[0])}{option}."
    else:
        text += f" What would help is not known: {unhelped}."
    return named(plan, text + doubt)


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
