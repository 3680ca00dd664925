"""Make the tables and lists that the page shows without JavaScript, in the form that the template takes."""

import math
import re
from typing import Any, NamedTuple

from plan_cutters.domain import figures as numbers
from plan_cutters.plan_file.model import CutterEntry, FaceEntry, Plan
from plan_cutters.plan_file.palette import label
from plan_cutters.plan_file.reasons import REASONS
from plan_cutters.plan_file.shares import VERDICTS, reached
from plan_cutters.plan_file.words import answers, cutters, headline
from plan_cutters.plan_file.words.chip import CHIPS, chip
from plan_cutters.plan_file.words.doubts import repeated_warnings
from plan_cutters.plan_file.words.names import named
from plan_cutters.plan_file.words.next_steps import step_text
from plan_cutters.plan_file.words.story import Story, story_of
from plan_cutters.report.page import operations
from plan_cutters.report.page.facts import Spot
from plan_cutters.report.protocol import Judged

#: Faces that are listed, the worst first; cutters whose worst faces and spots are.
_FACES, _CUTTERS = 1000, 40
#: Where a sentence ends and another begins, and an option of the command.
_SENTENCE, _OPTION = re.compile(r"(?<=[.!?])\s+(?=[A-Z]|--)"), re.compile(r"(?<!\S)\(?--[a-z]")


class Drawing(NamedTuple):
    """How the part is drawn: chord error that was requested, mm, and numbers of faces that are not."""

    chord: float
    missing: tuple[int, ...]


#: What verdicts say of a sample.
_VERDICTS = {
    "interference_free": "The tool can stand along the surface normal, in every rotation.",
    "accessible": "A posture (tilt and rotation) was found that neither gouges nor collides.",
    "undecided": "Neither a safe posture was found nor a proof that there is none.",
    "inaccessible": "None of the postures that were searched is safe.",
    "unjudged": "The surface could not be sampled, or it has no normal there.",
}


def of(result: Judged, spots: list[Spot], more: dict[str, int], drawing: Drawing, omitted: list[str]) -> dict[str, Any]:
    """Everything that the template shows; `more`: spots by cutter that are not listed; `omitted`: what the data has not."""
    plan, story = result.plan, story_of(result.plan)
    shown = next(c for c in plan.cutters if c.id == story.shown)
    rows = zip(story.cutters, plan.cutters, strict=True)
    first = sorted(story.cutters, key=lambda c: c.id != story.shown)
    faces = _faces(plan, shown)
    reasons = {word for c in plan.cutters for word in c.area_share.lost_by}
    header, commands = _apart(_header(plan, story, shown))
    return {
        "w": numbers,
        "plan": plan,
        "story": story,
        "header": header,
        "commands": commands,
        "names": story.names,
        "named": lambda text: named(plan, text),
        "step_told": step_text,
        "limit": answers.limit,
        "narrowest": answers.narrowest,
        "called": cutters.called,
        "chip": chip(plan, story),
        "chips": CHIPS,
        "feasible": cutters.FEASIBLE,
        "order": {True: 0, None: 1, False: 2},
        "cutters": [(c, entry, _bars(plan, entry)) for c, entry in sorted(rows, key=lambda each: each[1] is not shown)],
        "label": label,
        "failing": [c for c in first if c.failing][:_CUTTERS],
        "verdicts": _VERDICTS,
        "reasons": [REASONS[word] for word in plan.reasons if word in reasons and word in REASONS],
        "spots": [
            (c, witnesses)
            for c in first
            if (witnesses := [(k, s.witness, cutters.spot(s.witness)) for k, s in enumerate(spots) if s.cutter == c.id])
        ],
        "more": more,
        "faces": faces[:_FACES],
        "unlisted": len(faces[_FACES:]),
        "warnings": [text for text in plan.part.warnings if not plan.process or text not in repeated_warnings(plan)],
        "doubts": [line for each in story.doubts.values() for line in each],
        "asked": bool(plan.largest_radius) or any(c.least_stick_out or c.mend for c in plan.cutters),
        "effective": _effective(plan),
        "drawing": drawing,
        "left": omitted,
        "empty": headline.not_sampled(plan),
        "operations": operations.tables(plan, story),
    }


def _header(plan: Plan, story: Story, shown: CutterEntry) -> list[str]:
    """The texts below the title."""
    p = story.process
    process = [p.more, *p.own, *p.remaining, *p.next, p.clearance] if p else []
    return [*process, _why(plan, story, shown), " ".join((*story.proposal, *story.in_short))]


def _apart(texts: list[str]) -> tuple[list[str], list[str]]:
    """Texts without their sentences that name options of the command, and those sentences.

    Reviewers do not have the command at hand.

    >>> _apart(["All is reached. --spacing 3 looks more closely.", "Take it."])
    (['All is reached.', 'Take it.'], ['--spacing 3 looks more closely.'])
    """
    split = [_SENTENCE.split(text) for text in texts if text]
    plain = [" ".join(each for each in sentences if not _OPTION.search(each)) for sentences in split]
    return [text for text in plain if text], [each for sentences in split for each in sentences if _OPTION.search(each)]


def _why(plan: Plan, story: Story, shown: CutterEntry) -> str:
    """Write the sentences below the title."""
    _, _, about, why = story.headline
    taken = next((c for c in plan.cutters if c.id == story.taken), shown)
    least = taken.least_stick_out.least_mm if taken.least_stick_out else None
    held = ""
    if least is not None:
        short = taken.length - least < answers.SAME
        held = "It cannot be held shorter." if short else f"It can be held as short as {numbers.up(least)}."
    return " ".join(filter(None, (about, why, *story.scope, held, story.cutter(taken.id).next if taken.not_reached else "")))


def _bars(plan: Plan, entry: CutterEntry) -> list[tuple[str, float, float, str]]:
    """Shares as bars (word, from, width, colour) of 100 in all."""
    bars, at = [], 0.0
    for word in VERDICTS:
        wide = 100.0 * getattr(entry.area_share, word)
        if wide:
            bars.append((word, round(at, 2), round(wide, 2), plan.legend[word]))
        at += wide
    return bars


def _faces(plan: Plan, shown: CutterEntry) -> list[tuple[FaceEntry, str, str]]:
    """Faces with the share that is reached of them and the main reason: those that lose the most area first."""
    shares = {face.id: shown.faces[face.id].area_share for face in plan.faces if face.id in shown.faces}

    def rank(face: FaceEntry) -> tuple[bool, float]:
        share = shares.get(face.id)
        area = face.area_mm2 if math.isfinite(face.area_mm2) else 0.0
        return not face.target, -area * share.not_reached if share else 0.0

    return [
        (face, reached(shown.faces[face.id], shares[face.id]), cutters.reason(cutters.main_reason(shares[face.id])))
        if face.id in shares
        else (face, "", "")
        for face in sorted(plan.faces, key=rank)
    ]


def _effective(plan: Plan) -> list[tuple[str, str]]:
    """Options that have a value, as texts."""
    return [
        (name.replace("_", " "), _value(name, value))
        for name, value in plan.effective.model_dump(mode="json").items()
        if value not in (None, [], "")
    ]


def _value(name: str, value: Any) -> str:
    """A value of an option as people write it."""
    match value:
        case bool():
            return "yes" if value else "no"
        case float():
            return numbers.plainly(value, 9)
        case list() if name == "target_faces":
            return numbers.ranges(int(each[1:]) for each in value)
        case list():
            return ", ".join(_value(name, each) for each in value)
        case dict():
            return ", ".join(f"{key.replace('_', ' ')} {_value(key, each)}" for key, each in value.items())
    return str(value)
