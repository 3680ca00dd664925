"""Answers made of a plan file: which cutters finish, how they differ, and why one does not reach a face."""

import math
from collections import Counter
from collections.abc import Mapping
from typing import Any

from plan_cutters.agents.answers import (
    About,
    Comparison,
    CutterAnswer,
    Explanation,
    FaceRow,
    Help,
    InTheWay,
    Lost,
    Note,
    Picture,
    PlanAnswer,
    Postures,
    Reason,
    Sample,
    Vector,
    Witness,
    first,
)
from plan_cutters.agents.limits import CallError
from plan_cutters.agents.plan_file import Counts, Cutter, Mend, PlanFile
from plan_cutters.plan_file.nearest import leaves
from plan_cutters.plan_file.numbers import percent
from plan_cutters.plan_file.reasons import REASONS

#: Shares that differ by less are said as one.
_SAME = 1e-9


def planned(plan: PlanFile, code: int, most: int, files: Mapping[str, str]) -> PlanAnswer:
    """Which cutters finish, and what the others lose."""
    notes, more = first([Note(code=c, text=t) for c, t in _notes(plan)], most)
    return PlanAnswer(
        **_of_plan(plan, code, most), notes=notes, more_notes=more, files=dict(files), not_written=plan.not_written
    )


def compared(plan: PlanFile, code: int, most: int) -> Comparison:
    """On which faces cutters differ, and which of them do it together."""
    rows = []
    for face in plan.faces:
        shares = {c.id: c.faces[face.id].area_share.reached for c in plan.cutters if face.id in c.faces}
        if shares and max(shares.values()) - min(shares.values()) > _SAME:
            rows.append(FaceRow(face=face.id, reached=shares))
    rows.sort(key=lambda row: min(row.reached.values()) - max(row.reached.values()))
    ids = {c.id for c in ranked(plan)[:most]}
    differ, more = first([row.model_copy(update={"reached": {i: s for i, s in row.reached.items() if i in ids}}) for row in rows],
                         most)  # fmt: skip
    return Comparison(**_of_plan(plan, code, most), differ=differ, more_differ=more, together=plan.least_set)


def pictured(plan: PlanFile, code: int, most: int) -> Picture:
    """Describe a picture: whose verdicts it shows, and its colours."""
    legend = {colour: plan.legend_words.get(word, word) for word, colour in plan.legend.items()}
    return Picture(**_of_plan(plan, code, most), shown=plan.shown, legend=legend)


def ranked(plan: PlanFile) -> list[Cutter]:
    """The selected cutter first, then those that leave least."""
    return sorted(plan.cutters, key=lambda c: (c.id != plan.selected, leaves(c)))


def _of_plan(plan: PlanFile, code: int, most: int) -> dict[str, Any]:
    cutters, more = first(ranked(plan), most)
    unjudged = [Note(code=f.id, text=f.unjudged) for f in plan.faces if f.target and f.unjudged]
    left, more_left = first(unjudged, most)
    missing, more_missing = first(plan.missing, most)
    return {
        "part": plan.part.file, "told": plan.worded(_told(plan)), "exit_code": code, "samples": plan.samples,
        "selected": plan.selected or plan.selected_over_setups, "cutters": [_cutter(plan, c, most) for c in cutters],
        "more_cutters": more, "not_judged": left, "more_not_judged": more_left, "missing": missing,
        "more_missing": more_missing,
    }  # fmt: skip


def _told(plan: PlanFile) -> str:
    if plan.selected:
        said = f"Take {plan.selected}: it reaches every sample that could be judged ({plan.selection.why})."
    elif plan.selected_over_setups:
        said = f"Take {plan.selected_over_setups}: over the setups it reaches every sample that could be judged."
    elif plan.selected_for_setup:
        said = f"{plan.selected_for_setup} leaves only what the axis limit keeps from every cutter: that needs another setup."
    else:
        best = ranked(plan)[0]
        why = ", ".join(f"{_reason(code)} {_lost_by(share)}" for code, share in _by_share(best.area_share.lost_by))
        lost = _lost(best)
        said = f"No cutter finishes for sure. {best.id} comes nearest and leaves {lost} of the area{f': {why}' if why else ''}."
    if plan.samples.unjudged:
        said += f" {plan.samples.unjudged} of {plan.samples.count} samples could not be judged."
    if plan.samples.inside_bodies:
        said += (
            f" {plan.samples.inside_bodies} samples lie inside other bodies: they are no surface of the finished part."
        )
    if plan.missing:
        said += f" {len(plan.missing)} obstacles are missing or guessed, so nothing is beyond doubt."
    if unseen := [c.id for c in plan.cutters if c.id == plan.selected and not c.seen]:
        said += f" Samples are farther apart than the radius of {unseen[0]}: what lies between was not seen."
    return said


def _notes(plan: PlanFile) -> list[tuple[str, str]]:
    codes = [*plan.note_codes, *[""] * len(plan.notes)]
    return [*zip(codes, plan.notes, strict=False), *(("warning", text) for text in plan.part.warnings)]


def _reason(code: str) -> str:
    return REASONS[code].name if code in REASONS else code.replace("_", " ")


def _by_share(lost_by: Mapping[str, float]) -> list[tuple[str, float]]:
    return sorted(lost_by.items(), key=lambda item: (-item[1], item[0]))


def _cutter(plan: PlanFile, c: Cutter, most: int) -> CutterAnswer:
    lost = sorted((-v.area_share.not_reached, name) for name, v in c.faces.items() if v.not_reached)
    faces, more = first([Lost(face=name, share=-share, reason=_main(c.faces[name])) for share, name in lost], most)
    steps = helps(plan, c.mend) if c.mend else []
    share = c.area_share
    return CutterAnswer(
        id=c.id, name=c.name, feasible=c.feasible, seen=c.seen, reached=share.reached, inaccessible=share.inaccessible,
        undecided=share.undecided, lost_by=dict(_by_share(share.lost_by)), faces=faces, more_faces=more,
        next=steps[0] if steps else None,
    )  # fmt: skip


def _lost(counts: Counts) -> str:
    """How much of the area is not reached, in percent."""
    whole = not counts.reached and not counts.unjudged
    return percent(counts.area_share.not_reached, some=bool(counts.not_reached), whole=whole)


def _lost_by(share: float) -> str:
    """A share that a reason takes of the area: samples may stand for no area."""
    return percent(share, some=True, whole=False)


def _main(counts: Counts) -> str | None:
    return next((code for code, _ in _by_share(counts.area_share.lost_by)), None)


def helps(plan: PlanFile, mend: Mend) -> list[Help]:
    """Changes that gain something: steps, then changes of one thing that no step says."""
    steps = [s for s in mend.steps if all(move.thing != "area" for move in s.changes) and s.gained]
    found = [
        Help(what=plan.worded(s.why), things=[m.thing for m in s.changes],
             finishes=None if mend.unsure and not s.left else not s.left,
             lost_before=s.lost_before, lost_after=s.lost_after, gained_samples=s.gained, option=s.option)
        for s in steps
    ]  # fmt: skip
    said = {step.why for step in steps}
    found += [
        Help(
            what=plan.worded(c.why),
            things=[c.thing],
            finishes=c.helps,
            lost_before=c.lost_before,
            lost_after=c.lost_after,
            option=c.option,
        )
        for c in mend.changes
        if (c.helps or c.doubted) and c.asked is not None and c.why not in said
    ]
    return found


def explained(
    plan: PlanFile, cutter: Cutter, face: str, most: int, *, point: Vector | None = None, postures: Postures | None = None,
    sample: Sample | None = None,
) -> Explanation:  # fmt: skip
    """Why a cutter does not reach a face, and what would help.

    Raises
    ------
    CallError
        The plan says nothing about the face.
    """
    entry = next((f for f in plan.faces if f.id == face), None)
    if entry is None:
        raise CallError(f"there is no such face; the part has {len(plan.faces)}", file=plan.part.file, face=face)
    if not entry.target:
        raise CallError(
            "was not judged in this plan, it is an obstacle only: ask with `part`", file=plan.part.file, face=face
        )
    counts = cutter.faces.get(face, Counts())
    mine = [w for w in cutter.witnesses if w.face == face and not w.inside_bodies]
    mine.sort(key=(lambda w: math.dist(w.point, point)) if point is not None else (lambda w: -(w.depth_mm or 0.0)))
    share = counts.area_share
    blocked = counts.inaccessible - counts.inside_bodies
    unsure = bool(counts.undecided or counts.unjudged or entry.unjudged or plan.missing or not counts.reached)
    reached = False if blocked else None if unsure else True
    reasons = [_told_reason(code, part) for code, part in _by_share(share.lost_by)]
    helping, about, none = _helping(
        plan, cutter, [f.id for f in plan.faces if f.target] == [face], bool(counts.not_reached)
    )
    way = _in_the_way(mine)
    told = _why(cutter, face, counts, entry.unjudged, reasons, way, helping, about, none)
    if postures is not None:
        told = f"{_at_point(postures)} {told}"
    if sample is not None:
        why = f", {_reason(sample.reason)}" if sample.reason else ""
        told = (
            f"The nearest sample, {sample.distance_mm:.3g} mm off, is {sample.verdict.replace('_', '-')}{why}. {told}"
        )
    lists: dict[str, list[Any]] = {"in_the_way": way, "witnesses": mine, "would_help": helping, "missing": plan.missing}
    cut: dict[str, Any] = {}
    for name, entries in lists.items():
        cut[name], cut[f"more_{name}"] = first(entries, most)
    return Explanation(
        part=plan.part.file, told=plan.worded(told), cutter=cutter.id, face=face, reached=reached, lost_share=share.not_reached,
        counts={"reached": counts.reached, "inaccessible": blocked, "undecided": counts.undecided, "unjudged": counts.unjudged,
                "inside_bodies": counts.inside_bodies},
        reasons=reasons, help_is_about=about, no_help=none, postures=postures, sample=sample,
        **cut,
    )  # fmt: skip


def _told_reason(code: str, share: float) -> Reason:
    known = REASONS.get(code)
    return Reason(code=code, name=_reason(code), meaning=known.sentence if known else "", try_first=known.hint if known else "",
                  share=share)  # fmt: skip


def _helping(plan: PlanFile, cutter: Cutter, alone: bool, lost: bool) -> tuple[list[Help], About, str]:
    """Give the changes that would help, the faces that they are about, and why there are none."""
    if cutter.mend is not None:
        found = helps(plan, cutter.mend)
        why = "" if found else cutter.mend.why or "no change that was tried gains anything"
        return found, "this face" if alone else "all faces of the plan", why
    if not lost:
        return [], "nothing", "nothing is lost"
    asked = {"mend", "mend-all"} & {*plan.effective.answers}
    if asked:
        return [], "nothing", "it was not asked about this cutter, for others come nearer: ask with `part`"
    return [], "nothing", "the plan was made without --answers mend: ask with `part`"


def _in_the_way(witnesses: list[Witness]) -> list[InTheWay]:
    named = [w for w in witnesses if w.obstacle_face]
    places = Counter((str(w.obstacle_face), w.reason) for w in named)
    depths = {
        key: [w.depth_mm for w in named if (w.obstacle_face, w.reason) == key and w.depth_mm is not None]
        for key in places
    }
    deepest = {key: max(each, default=None) for key, each in depths.items()}
    found = [
        InTheWay(face=face, reason=code, depth_mm=deepest[face, code], places=n) for (face, code), n in places.items()
    ]
    return sorted(found, key=lambda each: (-each.places, -(each.depth_mm or 0.0), each.face))


def _why(
    cutter: Cutter, face: str, counts: Counts, unjudged: str | None, reasons: list[Reason], way: list[InTheWay],
    helping: list[Help], about: str, none: str,
) -> str:  # fmt: skip
    if not counts.reached and not counts.not_reached:
        inside = (
            "all of it lies inside other bodies of the part" if counts.inside_bodies else unjudged or "it has no sample"
        )
        return f"{face} could not be judged: {inside}."
    doubt = f" Of {face} could not be judged: {unjudged}." if unjudged else ""
    if not counts.not_reached:
        return f"{cutter.id} reaches every judged sample of {face} ({counts.reached}).{doubt}"
    lost = _lost(counts)
    why = ", ".join(f"{each.name} {_lost_by(each.share)}" for each in reasons) or "no reason is known"
    said = f"{cutter.id} does not reach {lost} of {face} ({counts.not_reached} samples): {why}."
    if counts.undecided:
        said += f" {counts.undecided} of them are undecided: neither proved safe nor proved blocked."
    if way:
        deep = f", up to {way[0].depth_mm:.3g} mm deep in the tool" if way[0].depth_mm is not None else ""
        said += f" At the best posture {way[0].face.replace('fixture:', 'fixture ')} is in the way{deep}."
    if helping:
        best = helping[0]
        whose = "the face" if about == "this face" else "all faces"
        gain = ""
        if best.lost_before is not None and best.lost_after is not None:
            gain = f" (lost {percent(best.lost_before)} to {percent(best.lost_after)} of {whose})"
        option = f" [{best.option}]" if best.option else ""
        said += f" What would help: {best.what}{gain}{option}."
    else:
        said += f" What would help is not known: {none}."
    return said + doubt


def _at_point(found: Postures) -> str:
    at = f"At the point, on {found.face}, "
    if found.free_share > 0.0 or any(row.free for row in found.rotations):
        sure = "" if found.certified else ", if nothing is in the way that is missing from the obstacles,"
        return f"{at}{percent(found.free_share)} of the postures{sure} are free."
    if found.undecided_share > 0.0:
        return f"{at}no posture is surely free; {percent(found.undecided_share)} are undecided."
    why = ", ".join(f"{_reason(code)} {percent(share)}" for code, share in _by_share(found.forbidden)[:3])
    return f"{at}no posture that was searched is free ({why or 'no contact'})."
