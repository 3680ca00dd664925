"""Describe each cutter: its kind, how much it reaches, where it fails, and why."""

import math
from collections.abc import Sequence
from dataclasses import dataclass

from plan_cutters.domain.figures import angle, capital, figure, listed, mm, percent, place, reported, unit
from plan_cutters.plan_file.model import CutterEntry, FaceEntry, Plan, WitnessEntry
from plan_cutters.plan_file.reasons import REASONS, Reason
from plan_cutters.plan_file.shares import VERDICTS, AreaShare, part_of, reached, unreached
from plan_cutters.plan_file.words.headline import area, between, every
from plan_cutters.plan_file.words.names import described, named
from plan_cutters.plan_file.words.next_steps import first_step, first_tries, step_text

#: Faces that are named on which a cutter leaves something.
_FACES = 3
FEASIBLE = {True: "yes", False: "no", None: "undecided"}


@dataclass(frozen=True, slots=True)
class WorstFace:
    """A face on which a cutter loses samples: how much of it (mm2, percent), by which reason mostly, and how much too deep (mm)
    the deepest witness there is in what; both may be empty."""

    id: str
    name: str
    area: str
    share: str
    reason: str
    depth: str
    obstacle: str


@dataclass(frozen=True, slots=True)
class CutterStory:
    """A cutter's story has these texts; a text is empty where there is nothing to say.

    Attributes
    ----------
    name, tool : str
        Its name in all texts; its kind, and how far it stands out of which holder.
    reached, shares : str, dict
        Of the area, in percent: in all, and by verdict.
    reason, hint, besides : str
        The reason of most of the area that is not reached, the thing to try first against it, and other reasons within the axis
        limit.
    sentence, next, left, between : str
        Sentences: how much it reaches, or what it leaves; the next step, or a change that would help; how much is not reached,
        why and where; how much is known between its samples.
    faces, failing : tuple of WorstFace, int
        The worst faces, and how many there are in all.
    """

    id: str
    name: str
    tool: str
    feasible: bool | None
    reached: str
    shares: dict[str, str]
    reason: str
    hint: str
    sentence: str
    next: str
    left: str
    between: str
    faces: tuple[WorstFace, ...]
    failing: int


def cutter_story(plan: Plan, c: CutterEntry, name: str) -> CutterStory:
    """All that is told of a cutter."""
    main = REASONS.get(main_reason(c.area_share))
    faces, failing = worst_faces(plan, c)
    loss = capital(named(plan, remaining_text(plan, c))) if c.not_reached else ""
    return CutterStory(
        id=c.id,
        name=name,
        tool=described(c, name),
        feasible=c.feasible,
        reached=reached(c, c.area_share),
        shares={word: part_of(c, c.area_share, [word]) for word in VERDICTS},
        reason=main.name if main else "",
        hint=_hint(plan, c, main) if main else "",
        sentence=loss or _reaches(plan, c, name),
        next=_next(plan, c),
        left=loss,
        between=between(plan, c),
        faces=tuple(faces),
        failing=failing,
    )


def _hint(plan: Plan, c: CutterEntry, main: Reason) -> str:
    """The thing to try first; nothing where all that lies inside material is the wall of a closed void."""
    enclosed = {face for face, each in c.faces.items() if each.area_share.lost_by.get("buried")}
    return "" if main.code == "buried" and enclosed <= set(plan.part.void_faces) else first_tries(main.code, c.mend)


def main_reason(share: AreaShare) -> str:
    """By which reason the most is not reached; empty where all is reached."""
    return max(share.lost_by, key=lambda name: share.lost_by[name], default="")


def reason(code: str) -> str:
    """Give the name of a reason: it is empty where there is none, and the code where a newer plan has an unknown reason."""
    return REASONS[code].name if code in REASONS else code.replace("_", " ")


def _reaches(plan: Plan, c: CutterEntry, name: str) -> str:
    """Say that a cutter reaches all that could be judged, and what makes that unsure."""
    unsure = "" if c.feasible else ", but obstacles are missing that may be in its way"
    return f"{capital(name)} reaches {every(plan)}{unsure}."


def _besides(c: CutterEntry) -> str:
    """List the reasons that take part in the axis limit, by samples, the most of them first."""
    ranked = sorted(c.axis_limit_with.items(), key=lambda item: (-item[1], item[0]))
    each = ", ".join(f"{reason(word)} at {count:,}" for word, count in ranked)
    return f"{each} sample{'' if ranked[-1][1] == 1 else 's'}" if each else ""


def _next(plan: Plan, c: CutterEntry) -> str:
    """Say in a sentence the next step, or why there is none."""
    if c.mend is None:
        return ""
    if (step := first_step(c)) is not None:
        return f"Next: {named(plan, step_text(step))}."
    return "No step was found that frees any of it." if c.mend.steps else f"Nothing sure would make it finish: {c.mend.why}."


def reasons(c: CutterEntry) -> list[str]:
    """Why a cutter loses what it loses, with shares of the area: the reason with the largest one first."""
    lines = []
    for code, share in sorted(c.area_share.lost_by.items(), key=lambda item: -item[1]):
        besides = f" (with {_besides(c)})" if code == "axis_limit" and c.axis_limit_with else ""
        lines.append(f"{reason(code)} {percent(share, some=True, whole=False)}{besides}")
    return lines


def remaining_text(plan: Plan, c: CutterEntry) -> str:
    """Say how much a cutter does not reach, why, on which faces, and the worst place."""
    why = ", ".join(reasons(c))
    if c.undecided:
        why += f"; of it {percent(c.area_share.undecided, some=True, whole=False)} is undecided"
    failing = _by_remaining_area(plan, c)
    deep = [w for w in c.witnesses if w.depth_mm is not None and not w.inside_bodies]
    where = ""
    if deep:
        worst = max(deep, key=lambda w: w.depth_mm or 0.0)
        sure = "may be" if worst.verdict == "undecided" else "is"
        where = (
            f"; the worst is on {worst.face} at ({place(worst.point)}), "
            f"where the best posture {sure} {mm(worst.depth_mm)} too deep"
        )
    return (
        f"{c.id} does not reach {unreached(c, c.area_share)} of {area(plan)} ({c.not_reached:,} of {plan.samples.finished:,} "
        "samples): "
        f"{why or 'no reason'}. They lie on {listed(failing, _FACES)}{where}."
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
    seen: set[tuple[str, str]] = set()
    first: list[WitnessEntry] = []
    rest: list[WitnessEntry] = []
    for w in sorted((w for w in witnesses if not w.inside_bodies), key=lambda w: -(w.depth_mm or 0.0)):
        (rest if (w.face, w.reason) in seen else first).append(w)
        seen.add((w.face, w.reason))
    return first + rest


def worst_faces(plan: Plan, c: CutterEntry, most: int = 5) -> tuple[list[WorstFace], int]:
    """The faces of which a cutter loses the largest area, and how many there are in all."""
    faces, ranked = {face.id: face for face in plan.faces}, _by_remaining_area(plan, c)
    return [_worst(faces[name], c, _remaining_area(faces[name], c)) for name in ranked[:most]], len(ranked)


def worst_face_text(face: WorstFace) -> str:
    """A face on which a cutter fails, in a line."""
    deep = f", {face.depth} {unit()} too deep" if face.depth else ""
    way = f", {called(face.obstacle)} in the way" if face.obstacle else ""
    return f"{face.id}: {face.area} {unit()}² lost, {face.share} of the face, mainly {face.reason}{deep}{way}"


def _by_remaining_area(plan: Plan, c: CutterEntry) -> list[str]:
    """Ids of the faces on which a cutter leaves something, the one with the largest area of it first."""

    def rank(face: FaceEntry) -> tuple[float, float]:
        area = _remaining_area(face, c)
        return -area if math.isfinite(area) else 0.0, -c.faces[face.id].area_share.not_reached

    failing = [face for face in plan.faces if face.id in c.faces and c.faces[face.id].not_reached]
    return [face.id for face in sorted(failing, key=rank)]


def _remaining_area(face: FaceEntry, c: CutterEntry) -> float:
    """Area of a face that a cutter leaves, mm2; not a number where the face's is not known."""
    face_entry = c.faces[face.id]
    return face_entry.area_share.not_reached * (1.0 - face_entry.inside_share) * face.area_mm2


def _worst(face: FaceEntry, c: CutterEntry, lot: float) -> WorstFace:
    mine = [w for w in c.witnesses if w.face == face.id and not w.inside_bodies]
    share = c.faces[face.id].area_share
    main = reason(main_reason(share) or (mine[0].reason if mine else ""))
    unsure = share.undecided > share.inaccessible
    verdict = "undecided" if unsure else "inaccessible"
    deepest = max(mine, key=lambda w: (w.verdict == verdict, w.depth_mm or 0.0), default=None)
    depth = "" if deepest is None or deepest.depth_mm is None else figure(reported(deepest.depth_mm))
    size = figure(reported(reported(lot)))
    return WorstFace(
        face.id, face.name, size, unreached(c.faces[face.id], share), f"{'undecided: ' * unsure}{main or '?'}", depth,
        "" if deepest is None else deepest.obstacle_face or "",
    )  # fmt: skip
