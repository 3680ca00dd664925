"""What the page says without JavaScript: its tables and lists, as the template takes them."""

from typing import Any

from plan_cutters.domain.verdicts import Reach
from plan_cutters.report.page import words
from plan_cutters.report.page.facts import WORDS, Spot, main_reason, reached_of, shares, worst_faces

#: Faces that are listed; of the others the data still knows.
_LISTED = 1500


def of(result: Any, spots: list[Spot], more: dict[str, int]) -> dict[str, Any]:
    """Everything that the template shows."""
    plan = result.plan
    names = {c.id: c.name or c.id for c in plan.cutters}
    each = {c.id: shares(result, result.reaches[c.id]) for c in plan.cutters}
    title, why = words.headline(plan, names, each, result.shown)
    rows = [_cutter(result, c, each[c.id]) for c in plan.cutters]
    by_cutter = [(c, [(k, s) for k, s in enumerate(spots) if s.cutter == c.id]) for c in plan.cutters]
    faces, unlisted = _faces(result)
    return {
        "w": words,
        "plan": plan,
        "title": title,
        "why": why,
        "names": names,
        "shown": result.shown,
        "cutters": rows,
        "spots": sorted(by_cutter, key=lambda x: x[0].id != result.shown),
        "more": more,
        "faces": faces,
        "unlisted": unlisted,
        "asked": any(c.least_stick_out or c.mend for c in plan.cutters) or plan.largest_radius,
        "effective": {key: value for key, value in plan.effective.model_dump(mode="json").items() if value not in (None, [], "")},
    }  # fmt: skip


def _cutter(result: Any, entry: Any, share: dict[str, float]) -> dict[str, Any]:
    reach: Reach = result.reaches[entry.id]
    reason = main_reason(result, reach)
    bar, at = [], 0.0
    for word in WORDS.values():
        bar.append((word, round(at, 3), round(100 * share[word], 3), result.plan.legend[word]))
        at += 100 * share[word]
    return {
        "entry": entry,
        "share": share,
        "reached": share["interference_free"] + share["accessible"],
        "bar": bar,
        "reason": reason,
        "worst": worst_faces(result, entry),
        "helping": [change.why for change in entry.mend.changes if change.helps] if entry.mend else [],
    }


def _faces(result: Any) -> tuple[list[tuple[Any, float | None, float | None]], int]:
    reached = reached_of(result, result.reaches[result.shown])
    faces = sorted(result.plan.faces, key=lambda f: not f.target)
    rows = [(f, *reached.get(int(f.id[1:]), (None, None))) for f in faces]
    return rows[:_LISTED], max(0, len(rows) - _LISTED)
