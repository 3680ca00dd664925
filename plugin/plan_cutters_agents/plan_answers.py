"""Answers made of plans: which cutters finish and in which steps, how they differ, why a face is not reached, what changed."""

import math
import re
from collections.abc import Mapping
from typing import Any

from plan_cutters.domain.figures import listed
from plan_cutters.plan_file.model import CutterEntry, Plan, leaves
from plan_cutters.plan_file.operations import OwnStepEntry
from plan_cutters.plan_file.reasons import REASONS, reason
from plan_cutters.plan_file.shares import FaceVerdicts, by_share
from plan_cutters.plan_file.words.answers import first_tries
from plan_cutters.plan_file.words.cutters import face_text, helping, in_the_way, main_reason, posture_text, sample_text
from plan_cutters.plan_file.words.names import named
from plan_cutters.plan_file.words.text import shown, text_of
from plan_cutters_agents import answers
from plan_cutters_agents.access import CallError
from plan_cutters_agents.answers import Note, Vector
from plan_cutters_ci.plans import compare
from plan_cutters_ci.wording import called, cutter_rows, face_rows, headline, mark, remarks

#: Shares that differ by less are equal.
_SAME = 1e-9
#: A cutter by its radius or diameter, and its length.
_PLAIN = re.compile(r"[rd][\d.]+(l[\d.]+)?")


def planned(plan: Plan, code: int, files: Mapping[str, str]) -> answers.PlanAnswer:
    """Which cutters finish, in which steps, and what the others lose."""
    codes = [*plan.note_codes, *[""] * len(plan.notes)]
    every = [*zip(codes, plan.notes, strict=False), *(("warning", text) for text in plan.part.warnings)]
    notes = [Note(code=c, text=t) for c, t in every]
    more: dict[str, Any] = {}
    if (process := plan.process) is not None:
        steps = [
            answers.StepAnswer(
                setup=step.setup + 1, mode=step.mode, angles=step.angles_deg, axis=step.axis if step.angles_deg is None else None,
                cutter=step.cutter, faces=step.faces, take=step.take, area_mm2=step.area_mm2, share=step.share,
                alone_mm2=step.alone_mm2, seconds=step.seconds, clearance_mm=step.clearance_mm,
                own=None if step.own is None else _own(step.own),
            )
            for step in process.steps
        ]  # fmt: skip
        more = {"asked_mm2": process.asked_mm2, "finished_share": process.finished_share, "seconds": process.seconds,
                "steps": steps, "left": [answers.Remaining.model_validate(each) for each in process.left]}  # fmt: skip
    return answers.PlanAnswer(**_of_plan(plan, code), **more, notes=notes, files=dict(files), not_written=plan.not_written)


def _own(own: OwnStepEntry) -> answers.OwnStepAnswer:
    near = own.nearest
    return answers.OwnStepAnswer(
        number=own.number, text=own.text, asked_mm2=own.asked_mm2, wrong=own.wrong,
        leaves=[answers.Remaining.model_validate(each) for each in own.leaves],
        nearest=None if near is None else
        answers.NearestOrientation(angles=near.angles_deg, axis=near.axis, area_mm2=near.area_mm2),
    )  # fmt: skip


def compared(plan: Plan, code: int) -> answers.Comparison:
    """On which faces cutters differ, and which of them do it together."""
    rows = []
    for face in plan.faces:
        shares = {c.id: c.faces[face.id].area_share.reached for c in plan.cutters if face.id in c.faces}
        if shares and max(shares.values()) - min(shares.values()) > _SAME:
            rows.append(answers.FaceRow(face=face.id, reached=shares))
    rows.sort(key=lambda row: min(row.reached.values()) - max(row.reached.values()))
    together = None if plan.least_set is None else answers.LeastSet.model_validate(plan.least_set)
    return answers.Comparison(**_of_plan(plan, code), differ=rows, together=together)


def pictured(plan: Plan, code: int) -> answers.Picture:
    """Describe a picture: whose verdicts it shows, and its colours."""
    legend = {colour: plan.legend_words.get(word, word) for word, colour in plan.legend.items()}
    return answers.Picture(**_of_plan(plan, code), shown=shown(plan).id, legend=legend)


def ranked(plan: Plan) -> list[CutterEntry]:
    """The selected cutter first, then those that leave least."""
    return sorted(plan.cutters, key=lambda c: (c.id != plan.selected, leaves(c)))


def _of_plan(plan: Plan, code: int) -> dict[str, Any]:
    text = plan.text or text_of(plan)
    sampling = {"spacing_mm": plan.effective.spacing_mm, "sampled_by": plan.effective.sampled_by}
    return {
        "part": plan.part.file or "", "told": "\n".join([text.headline, *text.lines]), "exit_code": code,
        "samples": answers.Samples.model_validate(plan.samples).model_copy(update=sampling),
        "selected": plan.selected or plan.selected_over_setups,
        "cutters": [_cutter(plan, c, text.cutters[c.id]) for c in ranked(plan)],
        "not_judged": [Note(code=f.id, text=f.unjudged) for f in plan.faces if f.target and f.unjudged],
        "missing": [answers.Missing.model_validate(each) for each in plan.missing],
    }  # fmt: skip


def _cutter(plan: Plan, c: CutterEntry, text: str) -> answers.CutterAnswer:
    by_face = sorted((-v.area_share.not_reached, name) for name, v in c.faces.items() if v.not_reached)
    faces = [
        answers.Lost(face=name, share=-share, reason=main_reason(c.faces[name].area_share) or None) for share, name in by_face
    ]
    share = c.area_share
    return answers.CutterAnswer(
        id=c.id, name=c.name, text=text, feasible=c.feasible, seen=c.seen, reached=share.reached,
        inaccessible=share.inaccessible, undecided=share.undecided, lost_by=dict(by_share(share.lost_by)), faces=faces,
        next=next(iter(_helps(plan, c)), None),
    )  # fmt: skip


def _helps(plan: Plan, c: CutterEntry) -> list[answers.Help]:
    """The steps that gain something."""
    mend = c.mend
    return [] if mend is None else [
        answers.Help(what=named(plan, each.why), things=[move.thing for move in each.changes],
                     finishes=None if mend.unsure and not each.left else not each.left,
                     lost_before=each.lost_before, lost_after=each.lost_after, gained_samples=each.gained, option=each.option)
        for each in helping(mend)
    ]  # fmt: skip


def explained(
    plan: Plan, cutter: CutterEntry, face: str, *, point: Vector | None = None, postures: answers.Postures | None = None,
    sample: answers.Sample | None = None,
) -> answers.Explanation:  # fmt: skip
    """Why a cutter does not reach a face, and what would help; a CallError where the plan says nothing about the face."""
    entry = next((f for f in plan.faces if f.id == face), None)
    if entry is None:
        raise CallError(f"there is no such face; the part has {len(plan.faces)}", file=plan.part.file, face=face)
    if not entry.target:
        raise CallError("was not judged in this plan, it is an obstacle only: ask with `part`", file=plan.part.file, face=face)
    counts = cutter.faces.get(face, FaceVerdicts())
    # The nearest to a point first, or the deepest.
    mine = sorted(
        (w for w in cutter.witnesses if w.face == face and not w.inside_bodies),
        key=lambda w: -(w.depth_mm or 0.0) if point is None else math.dist(w.point, point),
    )
    unsure = bool(counts.undecided or counts.unjudged or entry.unjudged or plan.missing or not counts.reached)
    changes, about, unhelped = _helping(
        plan, cutter, alone=[f.id for f in plan.faces if f.target] == [face], lost=bool(counts.not_reached)
    )
    texts = [] if sample is None else [sample_text(sample.distance_mm, sample.verdict, sample.reason)]
    if postures is not None:
        free = postures.free_share or float(any(row.free for row in postures.rotations))
        causes = by_share(postures.forbidden)
        texts.append(posture_text(postures.face, free, postures.undecided_share, causes, certified=postures.certified))
    texts.append(face_text(plan, cutter, entry, unhelped))
    return answers.Explanation(
        part=plan.part.file or "", told=" ".join(texts), cutter=cutter.id, face=face,
        reached=False if counts.blocked else None if unsure else True, lost_share=counts.area_share.not_reached,
        counts={"reached": counts.reached, "inaccessible": counts.blocked, "undecided": counts.undecided,
                "unjudged": counts.unjudged, "inside_bodies": counts.inside_bodies},
        reasons=[
            answers.Reason(code=code, name=reason(code), meaning=REASONS[code].sentence if code in REASONS else "",
                           try_first=first_tries(code, cutter.mend), share=part)
            for code, part in by_share(counts.area_share.lost_by)
        ],
        in_the_way=[answers.InTheWay(**each._asdict()) for each in in_the_way(mine)],
        witnesses=[answers.Witness.model_validate(each) for each in mine], would_help=changes, help_is_about=about,
        no_help=unhelped, postures=postures, sample=sample,
        missing=[answers.Missing.model_validate(each) for each in plan.missing],
    )  # fmt: skip


def _helping(plan: Plan, cutter: CutterEntry, *, alone: bool, lost: bool) -> tuple[list[answers.Help], answers.About, str]:
    """Give the changes that would help, the faces that they are about, and why there are none."""
    if cutter.mend is not None:
        found = _helps(plan, cutter)
        why = "" if found else cutter.mend.why or "no change that was tried gains anything"
        return found, "this face" if alone else "all faces of the plan", why
    if not lost:
        return [], "nothing", "nothing is lost"
    if "mend" in plan.effective.answers:
        return [], "nothing", "it was not asked about this cutter, for others come nearer: ask with `part`"
    return [], "nothing", "the plan was made without --answers mend: ask with `part`"


def difference(old: Plan, new: Plan) -> answers.PlanDifferenceAnswer:
    """Say what became of the faces and cutters; of plans that are not comparable the reasons alone."""
    result = compare(old, new, name=new.part.file or "part")
    faces = [
        answers.ChangedRow(name=called(each.old, each.new), what=mark(each), was=row[-2], now=row[-1])
        for each, row in zip(result.faces, face_rows(result), strict=False)
    ]
    cutters = [
        answers.ChangedRow(name=row[1], what=mark(each), was=row[2], now=row[3], changed=row[-1])
        for each, row in zip(result.cutters, cutter_rows(result), strict=False)
    ]
    return answers.PlanDifferenceAnswer(
        part=new.part.file or "", told="\n".join([headline(result), *result.why_not, *remarks(result)]),
        comparable=result.comparable, why_not=result.why_not, lost=result.lost if result.comparable else None,
        won=result.won if result.comparable else None, selected=[*result.selected], faces=faces, cutters=cutters,
        unreachable=result.unreachable if result.comparable else [],
    )  # fmt: skip


def cutter_of(plan: Plan, name: str) -> CutterEntry:
    """The cutter of a plan by its id, its name, or the beginning of one; a CallError where none is meant, or several are."""
    mine = chosen(name, [(c.id, c.name) for c in plan.cutters])
    return next(c for c in plan.cutters if c.id == mine)


def chosen(name: str, known: list[tuple[str, str]]) -> str:
    """The one id that is meant, of (id, name); a beginning ends where no number goes on.

    >>> chosen("R6", [("R6L80", ""), ("R60L80", ""), ("R2L40", "finisher")]), chosen("finisher", [("R2L40", "finisher")])
    ('R6L80', 'R2L40')
    >>> chosen("R3", [("R6L80", "")])
    Traceback (most recent call last):
    plan_cutters_agents.access.CallError: no cutter is called 'R3'; there is R6L80
    """
    text = name.strip().lower()

    def begins(word: str) -> bool:
        rest = word.lower()[len(text) :]
        return word.lower().startswith(text) and not (rest[:1].isdigit() or rest[:1] == ".")

    for test in (
        lambda id, label: id == name,
        lambda id, label: text in (id.lower(), label.lower()),
        lambda id, label: begins(id) or begins(label),
    ):
        matches = [id for id, label in known if test(id, label)]
        if len(matches) > 1 and _PLAIN.fullmatch(text):
            # R6 says no corner radius, as R6L80 does.
            matches = [id for id in matches if "rc" not in id] or matches
        if len(matches) == 1:
            return matches[0]
        if matches:
            raise CallError(f"{len(matches)} cutters may be meant by {name!r}: {', '.join(matches[:8])}; give the whole id")
    raise CallError(f"no cutter is called {name!r}; there is {listed([id for id, _ in known])}")
