"""What the page says without JavaScript: its tables and lists, as the template takes them."""

import math
from typing import Any, NamedTuple

from plan_cutters.document import told
from plan_cutters.document.model import CutterEntry, FaceEntry, Plan
from plan_cutters.document.names import named, short_names
from plan_cutters.document.next_steps import cures, first_step, step_told
from plan_cutters.document.told import VERDICTS, main_reason, part_of, reached, worst_faces
from plan_cutters.report.page import words
from plan_cutters.report.page.facts import Spot

#: Faces that are listed, the worst first; cutters whose worst faces and spots are.
_FACES, _CUTTERS = 1000, 40


class Drawing(NamedTuple):
    """How the part is drawn: chord error that was asked for, mm, and numbers of faces that are not."""

    chord: float
    missing: tuple[int, ...]


def of(result: Any, spots: list[Spot], more: dict[str, int], drawing: Drawing, left: list[str]) -> dict[str, Any]:
    """Everything that the template shows; `more`: spots by cutter that are not listed; `left`: what the data has not."""
    plan: Plan = result.plan
    names = short_names(plan)
    shown = next(c for c in plan.cutters if c.id == result.shown)
    title, why = words.headline(plan, names, shown)
    first = sorted(plan.cutters, key=lambda c: c.id != shown.id)
    faces = _faces(plan, shown)
    return {
        "w": words,
        "plan": plan,
        "title": title,
        "why": why,
        "inside": [named(plan, line) for line in told.inside(plan)],
        "names": names,
        "named": lambda text: named(plan, text),
        "shown": shown,
        "cutters": [_cutter(plan, c) for c in plan.cutters],
        "failing": [(c, *worst_faces(plan, c)) for c in first if c.lost][:_CUTTERS],
        "reasons": [word for word in plan.reasons if any(word in c.area_share.lost_by for c in plan.cutters)],
        "spots": [
            (c, found) for c in first if (found := [(k, s.witness) for k, s in enumerate(spots) if s.cutter == c.id])
        ],
        "more": more,
        "faces": faces[:_FACES],
        "unlisted": len(faces[_FACES:]),
        "unjudged": [f for f in plan.faces if f.target and f.unjudged],
        "asked": bool(plan.largest_radius) or any(c.least_stick_out or c.mend for c in plan.cutters),
        "effective": _effective(plan),
        "drawing": drawing,
        "left": left,
    }


def _cutter(plan: Plan, entry: CutterEntry) -> dict[str, Any]:
    """A row of the table of cutters: shares as text and as bars (word, from, width, colour) of 100 in all."""
    bars, at = [], 0.0
    for word in VERDICTS:
        wide = 100.0 * getattr(entry.area_share, word)
        if wide:
            bars.append((word, round(at, 2), round(wide, 2), plan.legend[word]))
        at += wide
    each = [(words.VERDICTS[word][0], part_of(entry, entry.area_share, [word])) for word in VERDICTS]
    return {
        "entry": entry,
        "reached": reached(entry, entry.area_share),
        "bars": bars,
        "shares": [(said, share) for said, share in each if share != "0 %"],
        "reason": main_reason(entry.area_share),
        "besides": _besides(entry),
        "next": named(plan, step_told(step)) if (step := first_step(entry)) else "",
        "helping": [named(plan, change.why) for change in cures(entry.mend) if change.helps] if entry.mend else [],
    }


def _besides(entry: CutterEntry) -> str:
    """What takes part in the axis limit, by samples, the most of them first."""
    ranked = sorted(entry.axis_limit_with.items(), key=lambda item: (-item[1], item[0]))
    return ", ".join(f"{words.reason(word)} at {count:,}" for word, count in ranked)


def _faces(plan: Plan, shown: CutterEntry) -> list[tuple[FaceEntry, str, str]]:
    """Faces with the share that is reached of them and the main reason: those that lose the most area first."""
    shares = {face.id: shown.faces[face.id].area_share for face in plan.faces if face.id in shown.faces}

    def rank(face: FaceEntry) -> tuple[bool, float]:
        share = shares.get(face.id)
        area = face.area_mm2 if math.isfinite(face.area_mm2) else 0.0
        return not face.target, -area * (share.inaccessible + share.undecided) if share else 0.0

    return [
        (face, reached(shown.faces[face.id], shares[face.id]), main_reason(shares[face.id]))
        if face.id in shares
        else (face, "", "")
        for face in sorted(plan.faces, key=rank)
    ]


def _effective(plan: Plan) -> list[tuple[str, str]]:
    """Options that have a value, as texts."""
    found = []
    for name, value in plan.effective.model_dump(mode="json").items():
        if value in (None, [], ""):
            continue
        text = ", ".join(str(each) for each in value) if isinstance(value, list) else str(value)
        found.append((name.replace("_", " "), text))
    return found
