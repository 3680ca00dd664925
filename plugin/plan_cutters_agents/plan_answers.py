"""Answers made of a plan: which cutters finish, how they differ, and why one does not reach a face."""

import math
from collections.abc import Iterator, Mapping
from typing import Any

from plan_cutters.plan_file.answers import MendEntry
from plan_cutters.plan_file.model import CutterEntry, Plan, WitnessEntry
from plan_cutters.plan_file.nearest import leaves
from plan_cutters.plan_file.reasons import REASONS
from plan_cutters.plan_file.shares import FaceVerdicts, by_share
from plan_cutters.plan_file.words.cutters import main_reason, reason
from plan_cutters.plan_file.words.face import face_text, helping, in_the_way, posture_text, sample_text
from plan_cutters.plan_file.words.names import named
from plan_cutters.plan_file.words.needs import first_tries
from plan_cutters.plan_file.words.story import shown
from plan_cutters.plan_file.words.text import text_of
from plan_cutters_agents.answers import (
    About,
    Comparison,
    CutterAnswer,
    Explanation,
    FaceRow,
    Help,
    InTheWay,
    LeastSet,
    Lost,
    Missing,
    Note,
    Picture,
    PlanAnswer,
    Postures,
    Reason,
    Sample,
    Samples,
    Vector,
    Witness,
    first,
)
from plan_cutters_agents.limits import CallError
from plan_cutters_agents.step_answers import stepped

#: Shares that differ by less are equal.
_SAME = 1e-9


def planned(plan: Plan, code: int, most: int, files: Mapping[str, str]) -> PlanAnswer:
    """Which cutters finish, and what the others lose."""
    codes = [*plan.note_codes, *[""] * len(plan.notes)]
    every = [*zip(codes, plan.notes, strict=False), *(("warning", text) for text in plan.part.warnings)]
    notes, more = first([Note(code=c, text=t) for c, t in every], most)
    return PlanAnswer(
        **_of_plan(plan, code, most), **stepped(plan, most), notes=notes, more_notes=more, files=dict(files),
        not_written=plan.not_written,
    )  # fmt: skip


def compared(plan: Plan, code: int, most: int) -> Comparison:
    """On which faces cutters differ, and which of them do it together."""
    rows = []
    for face in plan.faces:
        shares = {c.id: c.faces[face.id].area_share.reached for c in plan.cutters if face.id in c.faces}
        if shares and max(shares.values()) - min(shares.values()) > _SAME:
            rows.append(FaceRow(face=face.id, reached=shares))
    rows.sort(key=lambda row: min(row.reached.values()) - max(row.reached.values()))
    ids = {c.id for c in ranked(plan)[:most]}
    differ, more = first(
        [row.model_copy(update={"reached": {i: s for i, s in row.reached.items() if i in ids}}) for row in rows], most
    )
    together = None if plan.least_set is None else LeastSet.model_validate(plan.least_set)
    return Comparison(**_of_plan(plan, code, most), differ=differ, more_differ=more, together=together)


def pictured(plan: Plan, code: int, most: int) -> Picture:
    """Describe a picture: whose verdicts it shows, and its colours."""
    legend = {colour: plan.legend_words.get(word, word) for word, colour in plan.legend.items()}
    return Picture(**_of_plan(plan, code, most), shown=shown(plan).id, legend=legend)


def ranked(plan: Plan) -> list[CutterEntry]:
    """The selected cutter first, then those that leave least."""
    return sorted(plan.cutters, key=lambda c: (c.id != plan.selected, leaves(c)))


def _of_plan(plan: Plan, code: int, most: int) -> dict[str, Any]:
    cutters, more = first(ranked(plan), most)
    unjudged = [Note(code=f.id, text=f.unjudged) for f in plan.faces if f.target and f.unjudged]
    left, more_left = first(unjudged, most)
    missing, more_missing = first(_missing(plan), most)
    text = plan.text or text_of(plan)
    return {
        "part": plan.part.file or "", "told": "\n".join([text.headline, *text.lines]), "exit_code": code,
        "samples": _samples(plan), "selected": plan.selected or plan.selected_over_setups,
        "cutters": [_cutter(plan, c, text.cutters[c.id], most) for c in cutters], "more_cutters": more, "not_judged": left,
        "more_not_judged": more_left, "missing": missing, "more_missing": more_missing,
    }  # fmt: skip


def _samples(plan: Plan) -> Samples:
    sampling = {"spacing_mm": plan.effective.spacing_mm, "sampled_by": plan.effective.sampled_by}
    return Samples.model_validate(plan.samples).model_copy(update=sampling)


def _missing(plan: Plan) -> list[Missing]:
    return [Missing.model_validate(each) for each in plan.missing]


def _cutter(plan: Plan, c: CutterEntry, text: str, most: int) -> CutterAnswer:
    by_face = sorted((-v.area_share.not_reached, name) for name, v in c.faces.items() if v.not_reached)
    faces, more = first(
        [Lost(face=name, share=-share, reason=main_reason(c.faces[name].area_share) or None) for share, name in by_face], most
    )
    steps = helps(plan, c)
    share = c.area_share
    return CutterAnswer(
        id=c.id, name=c.name, text=text, feasible=c.feasible, seen=c.seen, reached=share.reached,
        inaccessible=share.inaccessible, undecided=share.undecided, lost_by=dict(by_share(share.lost_by)), faces=faces,
        more_faces=more, next=steps[0] if steps else None,
    )  # fmt: skip


def helps(plan: Plan, c: CutterEntry) -> list[Help]:
    """The steps that gain something."""
    mend = c.mend
    if mend is None:
        return []
    return [
        Help(what=named(plan, each.why), things=[move.thing for move in each.changes],
             finishes=None if mend.unsure and not each.left else not each.left,
             lost_before=each.lost_before, lost_after=each.lost_after, gained_samples=each.gained, option=each.option)
        for each in helping(mend)
    ]  # fmt: skip


def explained(
    plan: Plan, cutter: CutterEntry, face: str, most: int, *, point: Vector | None = None, postures: Postures | None = None,
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
        raise CallError("was not judged in this plan, it is an obstacle only: ask with `part`", file=plan.part.file, face=face)
    counts = cutter.faces.get(face, FaceVerdicts())
    mine = _witnesses(cutter, face, point)
    unsure = bool(counts.undecided or counts.unjudged or entry.unjudged or plan.missing or not counts.reached)
    changes, about, unhelped = _helping(
        plan, cutter, alone=[f.id for f in plan.faces if f.target] == [face], lost=bool(counts.not_reached)
    )
    texts = [*_of_point(postures, sample), face_text(plan, cutter, entry, unhelped)]
    lists: dict[str, list[Any]] = {
        "in_the_way": [InTheWay(**each._asdict()) for each in in_the_way(mine)],
        "witnesses": [Witness.model_validate(each) for each in mine],
        "would_help": changes,
        "missing": _missing(plan),
    }
    cut: dict[str, Any] = {}
    for name, entries in lists.items():
        cut[name], cut[f"more_{name}"] = first(entries, most)
    return Explanation(
        part=plan.part.file or "", told=" ".join(texts), cutter=cutter.id, face=face,
        reached=False if counts.blocked else None if unsure else True, lost_share=counts.area_share.not_reached,
        counts={"reached": counts.reached, "inaccessible": counts.blocked, "undecided": counts.undecided,
                "unjudged": counts.unjudged, "inside_bodies": counts.inside_bodies},
        reasons=[_reason(code, part, cutter.mend) for code, part in by_share(counts.area_share.lost_by)], help_is_about=about,
        no_help=unhelped, postures=postures, sample=sample, **cut,
    )  # fmt: skip


def _witnesses(cutter: CutterEntry, face: str, point: Vector | None) -> list[WitnessEntry]:
    """Witnesses of a face: the nearest to a point first, or the deepest."""
    mine = [w for w in cutter.witnesses if w.face == face and not w.inside_bodies]
    return sorted(mine, key=lambda w: -(w.depth_mm or 0.0) if point is None else math.dist(w.point, point))


def _of_point(postures: Postures | None, sample: Sample | None) -> Iterator[str]:
    """What is said of one point: of its sample, and of its postures."""
    if sample is not None:
        yield sample_text(sample.distance_mm, sample.verdict, sample.reason)
    if postures is not None:
        free = postures.free_share or float(any(row.free for row in postures.rotations))
        yield posture_text(
            postures.face, free, postures.undecided_share, by_share(postures.forbidden), certified=postures.certified
        )


def _reason(code: str, share: float, advice: MendEntry | None = None) -> Reason:
    known = REASONS.get(code)
    return Reason(
        code=code, name=reason(code), meaning=known.sentence if known else "", try_first=first_tries(code, advice), share=share
    )


def _helping(plan: Plan, cutter: CutterEntry, *, alone: bool, lost: bool) -> tuple[list[Help], About, str]:
    """Give the changes that would help, the faces that they are about, and why there are none."""
    if cutter.mend is not None:
        found = helps(plan, cutter)
        why = "" if found else cutter.mend.why or "no change that was tried gains anything"
        return found, "this face" if alone else "all faces of the plan", why
    if not lost:
        return [], "nothing", "nothing is lost"
    if "mend" in plan.effective.answers:
        return [], "nothing", "it was not asked about this cutter, for others come nearer: ask with `part`"
    return [], "nothing", "the plan was made without --answers mend: ask with `part`"
