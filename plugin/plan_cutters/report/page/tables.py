"""All that the page has beside arrays: its `meta` object, its plan of operations, and its tables without JavaScript."""

import math
from itertools import accumulate
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from cad_io.arrays import Floats
from plan_cutters.document.build import counts, degrees, fixtures_in
from plan_cutters.domain import figures as numbers
from plan_cutters.domain.cutter import Cutter
from plan_cutters.domain.kinematics import Kinematics
from plan_cutters.domain.outline import Outline, outline, points
from plan_cutters.domain.shapes import modes
from plan_cutters.domain.verdicts import WORDS
from plan_cutters.outcome import OperationPlan
from plan_cutters.plan_file.frozen import Posture
from plan_cutters.plan_file.model import CutterEntry, FaceEntry, Plan
from plan_cutters.plan_file.operations import OperationPlanEntry
from plan_cutters.plan_file.reasons import MEANING, NO_CONTACT, PALETTE, REASONS, label
from plan_cutters.plan_file.shares import VERDICTS, reached
from plan_cutters.plan_file.words import answers, cutters, headline
from plan_cutters.plan_file.words.answers import step_text
from plan_cutters.plan_file.words.cutters import spot as sentence
from plan_cutters.plan_file.words.names import as_fields, named, short_names
from plan_cutters.plan_file.words.notes import repeated_warnings
from plan_cutters.plan_file.words.operations import OperationText, operation_names, operation_text, stepped
from plan_cutters.plan_file.words.text import CHIPS, Story, before_approval, chip, story_of
from plan_cutters.report.page.arrays import Arrays, Atlas, Spot, Stored, Surface, shares, turned_by
from plan_cutters.report.page.steps import colour, middle, process_of, process_tables
from plan_cutters.report.protocol import Judged


def key(plan: OperationPlan | OperationPlanEntry) -> str:
    """The name of a plan in names of arrays."""
    return plan.name.replace(" ", "_")


def operation_arrays(result: Judged) -> Arrays:
    """For each plan the operation of each sample, counted from 1, 0 is none; and where its tool leans."""
    operations, arrays = result.answers.operations, Arrays()
    for plan in operations.plans if operations else ():
        arrays[f"operation.{key(plan)}"] = Stored.of(
            (plan.label + 1).astype(np.uint8 if len(plan.operations) < 255 else np.uint16)
        )
        arrays[f"operation_lean.{key(plan)}"] = Stored.of(turned_by(result.samples, plan.lean))
        if (share := shares(plan.lean)) is not None:
            arrays[f"operation_share.{key(plan)}"] = Stored.of(share)
    return arrays


def operations_of(result: Judged) -> dict[str, Any] | None:
    """Collect what the script needs of the operations beside the tables; None where they were not requested."""
    operations, entry = result.answers.operations, result.plan.operations
    if operations is None or entry is None:
        return None
    plans = []
    for mine, each in zip(operations.plans, entry.plans, strict=True):
        made = [_operation(result.plan, each, k, middle(result, mine.label == k)) for k in range(len(each.operations))]
        name = key(mine)
        plans.append({"key": name, "name": each.name, "array": f"operation.{name}", "lean": f"operation_lean.{name}",
                      "operations": made})  # fmt: skip
    return {"plans": plans}


def _operation(plan: Plan, of: OperationPlanEntry, number: int, row: int | None) -> dict[str, Any]:
    entry = of.operations[number]
    words, called = operation_text(plan, of, entry), stepped(plan, of, entry.id)
    step = int(called.split()[1].partition(".")[0]) if called != entry.id else number + 1
    return {
        "cutter": entry.cutter, "setup": entry.setup, "axis": entry.axis, **colour(step),
        "label": called, "turned": words.turned, "text": words.sentence, "sample": row,
        "words": [each for each in (entry.g68_2, entry.g53_1, entry.rotary_words) if each],
    }  # fmt: skip


def _in_order(plan: Plan, of: OperationPlanEntry, texts: list[OperationText]) -> list[tuple[int, OperationText]]:
    """Rows with their places in the plan: those of the process in the order of its steps."""
    number = {name: tuple(map(int, step.split("."))) for name, step in operation_names(plan).items()}
    rows = list(enumerate(texts))
    return sorted(rows, key=lambda row: number.get(row[1].entry.id, (0,))) if of.name == plan.process.plan else rows


def tables(plan: Plan, story: Story) -> dict[str, Any] | None:
    """Sentences, and of each plan its entry, its key, the rows of its table and whether it is timed; None without operations."""
    if plan.operations is None:
        return None
    plans = [
        (each, key(each), _in_order(plan, each, [operation_text(plan, each, one) for one in each.operations]),
         all(one.seconds is not None for one in each.operations))
        for each in plan.operations.plans
    ]  # fmt: skip
    return {"lines": [line for line in story.operations if line.text not in story.in_short], "plans": plans}


FORMAT = 1
#: Chord of the outlines of tools, mm.
_CHORD = 0.005


def meta_of(
    result: Judged, surface: Surface, atlas: Atlas, box: tuple[Floats, Floats], spots: list[Spot], number: NDArray[np.uint16]
) -> dict[str, Any]:
    """All of it but the arrays, and what was left out of them; `number` (n,): of the step that finishes each sample."""
    plan, effective, names = result.plan, result.plan.effective, short_names(result.plan)
    low, high = box
    return {
        "format": FORMAT,
        "part": {**_of(plan.part, "file", "sha256", "size_mm"), "low": low.tolist(), "high": high.tolist()},
        "setup": {"z": effective.setup, "x": effective.placement and effective.placement.x},
        "machine": plan.machine.name, "tolerance_mm": effective.tolerance_mm, "shown": result.shown, "selected": plan.selected,
        "reasons": plan.reasons,
        "verdicts": {str(code): word for code, word in WORDS.items()},
        "words": {word: {"name": label(word), "colour": PALETTE[word]} for word in MEANING},
        "causes": {each.code: _of(each, "name", "sentence", "colour", "pattern") for each in (*REASONS.values(), NO_CONTACT)},
        "rotation_deg": np.degrees(result.postures.rotations).round(6).tolist(),
        "tilt_deg": list(degrees(result.postures.tilt)),
        "tilt_limit_deg": plan.machine.tilt_limit_deg,
        "rotary": plan.machine.rotary is not None,
        "axes": [axis.name for axis in result.conditions.machine.rotary or ()],
        "kinematics": result.kinematics and _kinematics(result.kinematics),
        "setups": [
            {"z": each.setup.tolist(), "kinematics": each.kinematics and _kinematics(each.kinematics)}
            for each in (result.ready.setups if result.served_in else ())
        ],
        "atlas": [atlas.index.shape[1], atlas.index.shape[0]],
        "faces": [_face(entry, surface) for entry in plan.faces],
        "fixtures": [
            {"name": fixture.name, "start": surface.fixtures[i][0], "count": surface.fixtures[i][1], "setups": setups}
            for i, (fixture, setups) in enumerate(fixtures_in(result.ready))
        ],
        "cutters": [
            _cutter(names[entry.id], entry, result.judged(entry.id), counts(result.reaches[entry.id].verdict))
            for entry in plan.cutters
        ],
        "spots": [
            {
                **_of(each, "cutter", "sample"),
                **_of(each.witness, "face", "reason", "point", "obstacle_face", "obstacle_point", "depth_mm"),
                **_posture(each.witness.best_posture),
                "text": sentence(each.witness),
            }
            for each in spots
        ],
        "operations": operations_of(result),
        "process": process_of(result, story_of(plan), number),
    }  # fmt: skip


def _posture(best: Posture | None) -> dict[str, Any]:
    words = {"tilt_deg": "tilt", "lean_deg": "rotation", "axis": "axis"}
    return {word: getattr(best, name, None) for word, name in words.items()}


def _kinematics(axes: Kinematics) -> dict[str, Any]:
    """Describe the rotary axes: the page finds with them which tool axes the machine holds; None: no limit that way."""
    ends = [[end if math.isfinite(end) else None for end in pair] for pair in np.degrees(axes.limit).tolist()]
    return {"direction": axes.direction.tolist(), "limit_deg": ends, "tool": axes.tool.tolist()}


def _face(entry: Any, surface: Surface) -> dict[str, Any]:
    number = int(entry.id[1:])
    start, count = surface.faces.get(number, (0, 0))
    words = ("id", "name", "component", "surface", "target", "ignored", "area_mm2")
    return {"number": number, **_of(entry, *words), "start": start, "count": count}


def _of(record: Any, *words: str) -> dict[str, Any]:
    return {word: getattr(record, word) for word in words}


def _cutter(name: str, entry: CutterEntry, cutter: Cutter, data: dict[str, Any]) -> dict[str, Any]:
    """A cutter, with the polyline of each of its parts, from the tip up."""
    whole, parts = outline(cutter), []
    for part in whole.parts:
        segments = whole.of(part)
        line = points(Outline(segments), _CHORD)
        line[0] = segments[0].start
        parts.append({"part": part, "points": line.round(4).tolist()})
    ends = [(mode, degrees((mode.low, mode.high))) for mode in modes(cutter)]
    return {
        "name": name,
        **_of(entry, "id", "feasible", "radius", "corner_radius", "allowance_mm", "clearance_mm", "touches_deg"),
        "modes": [
            {**_of(m, "offset", "radius", "height"), "tilt_low_deg": low, "tilt_high_deg": high} for m, (low, high) in ends
        ],
        "outline": parts,
        "shares": {word: getattr(entry.area_share, word) for word in VERDICTS},
        "counts": data,
        "by_reason": {name: n for name, n in entry.by_reason.items() if n},
        "undecided_by_reason": {name: n for name, n in entry.undecided_by_reason.items() if n},
    }


#: Faces that are listed, the worst first; cutters whose worst faces and spots are.
_FACES, _CUTTERS = 1000, 40


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
    "drilled": "It is in a hole for a drill, which no mill has to reach.",
}


def of(result: Judged, spots: list[Spot], more: dict[str, int], drawing: Drawing, omitted: list[str]) -> dict[str, Any]:
    """Everything that the template shows; `more`: spots by cutter that are not listed; `omitted`: what the data has not."""
    plan, story = result.plan, story_of(result.plan)
    shown = headline.shown_cutter(plan)
    rows = zip(story.cutters, plan.cutters, strict=True)
    first = sorted(story.cutters, key=lambda c: c.id != story.shown)
    warnings = [text for text in plan.part.warnings if text not in repeated_warnings(plan)]
    faces, bars = _faces(plan, shown), dict[str, list[tuple[str, float, float, str]]]()
    for c in plan.cutters:
        # Shares as bars (word, from, width, colour) of 100 in all.
        wide = [100.0 * getattr(c.area_share, word) for word in VERDICTS]
        row = zip(VERDICTS, accumulate(wide, initial=0.0), wide, strict=False)
        bars[c.id] = [(word, round(at, 2), round(width, 2), plan.legend[word]) for word, at, width in row if width]
    reasons = {word for c in plan.cutters for word in c.area_share.lost_by}
    return {
        "w": numbers, "plan": plan, "story": story, "plain": as_fields, "names": story.names,
        "header": [*story.process.own, _why(plan, story, shown), " ".join((*story.proposal, *story.in_short))],
        "size": numbers.size(plan.part.size_mm), "stands": story.process.stands,
        "check": as_fields(" ".join(before_approval(story))),
        **process_tables(plan, story),
        "named": lambda text: named(plan, text), "step_told": step_text, "limit": answers.limit,
        "narrowest": answers.narrowest, "called": cutters.called, "label": label,
        "chip": chip(plan, story), "chips": CHIPS, "feasible": cutters.FEASIBLE, "order": {True: 0, None: 1, False: 2},
        "cutters": [(c, entry, bars[c.id]) for c, entry in sorted(rows, key=lambda each: each[1] is not shown)],
        "failing": [c for c in first if c.failing][:_CUTTERS], "verdicts": _VERDICTS,
        "reasons": [REASONS[word] for word in plan.reasons if word in reasons and word in REASONS],
        "spots": [
            (c, witnesses)
            for c in first
            if (witnesses := [(k, s.witness, cutters.spot(s.witness)) for k, s in enumerate(spots) if s.cutter == c.id])
        ],
        "more": more, "faces": faces[:_FACES], "unlisted": len(faces[_FACES:]), "warnings": warnings,
        "doubts": [line for each in story.doubts.values() for line in each],
        "asked": bool(plan.largest_radius) or any(c.least_stick_out or c.mend for c in plan.cutters),
        "effective": [
            (name.replace("_", " "), _value(name, value))
            for name, value in plan.effective.model_dump(mode="json").items()
            if value not in (None, [], {}, "")
        ],
        "drawing": drawing, "left": omitted, "empty": headline.not_sampled(plan), "operations": tables(plan, story),
        "stepped": lambda of, name: stepped(plan, of, name),
    }  # fmt: skip


def _why(plan: Plan, story: Story, shown: CutterEntry) -> str:
    _, _, about, why = story.headline
    taken = next((c for c in plan.cutters if c.id == story.taken), shown)
    least = taken.least_stick_out.least_mm if taken.least_stick_out else None
    held = ""
    if least is not None:
        short = taken.length - least < answers.SAME
        held = "It cannot be held shorter." if short else f"It can be held as short as {numbers.up(least)}."
    return " ".join(filter(None, (about, why, *story.scope, held, story.cutter(taken.id).next if taken.not_reached else "")))


def _faces(plan: Plan, shown: CutterEntry) -> list[tuple[FaceEntry, str, str]]:
    """Faces with the share that is reached of them and the main reason: those that lose the most area first."""
    shares = {face.id: shown.faces[face.id].area_share for face in plan.faces if face.id in shown.faces}

    def rank(face: FaceEntry) -> tuple[bool, float]:
        share = shares.get(face.id)
        area = face.area_mm2 if math.isfinite(face.area_mm2) else 0.0
        return not face.target, -area * share.not_reached if share else 0.0

    def row(face: FaceEntry) -> tuple[FaceEntry, str, str]:
        if (share := shares.get(face.id)) is None:
            return face, "", ""
        return face, reached(shown.faces[face.id], share), cutters.reason(cutters.main_reason(share))

    return [row(face) for face in sorted(plan.faces, key=rank)]


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
