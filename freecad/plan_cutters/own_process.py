"""The steps of a plan as people edit them: texts of rows, and the process that is judged again."""

from __future__ import annotations

import json
import re
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

from . import model
from .words import tr

_NUMBER = r"[+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?"
_SIMULTANEOUS = ("simultaneous", "any")


@dataclass(frozen=True)
class Step:
    """A step as it is edited, in the words of the file that `plan-cutters --process` reads.

    Parameters
    ----------
    setup : int
        From 1.
    turned : str
        `C 0 A 90`, `axis 0 0 1`, or `simultaneous`.
    cutter : str
        Its id, or another word that the program knows it by.
    faces : str
        `F3 F6`, or `left`: all that no step before it finishes.
    take : str
        `share`: it divides its faces with others that share them, by time; else `first`: all that no such step before it takes.
    area : float, optional
        mm2 that it finishes, as it was judged; None where it was not.
    alone : float, optional
        mm2 that no other step serves; None where that is not known.
    fault : str
        What is wrong with it, one line.
    """

    setup: int
    turned: str
    cutter: str
    faces: str
    take: str = "first"
    area: float | None = None
    alone: float | None = None
    fault: str = ""


def steps_of(plan: dict[str, Any]) -> list[Step]:
    """The steps of a plan, in their order; none where an older program made it."""
    process = plan.get("process") or {}
    return [_step(each, plan) for each in process.get("steps", ())]


def _step(entry: dict[str, Any], plan: dict[str, Any]) -> Step:
    turned = "simultaneous"
    if entry["angles_deg"]:
        turned = " ".join(f"{name} {value:.10g}" for name, value in entry["angles_deg"].items())
    elif entry["mode"] == "fixed":
        turned = "axis " + " ".join(f"{value:.12g}" for value in entry["axis"])
    own = entry.get("own") or {}
    faces = " ".join(entry["faces"])
    if not faces:
        # One of the planner's own that does nothing keeps what was written.
        asked = ((plan.get("effective") or {}).get("process") or {}).get("step", ())
        place = own.get("number", 0) - 1
        written = asked[place]["faces"] if 0 <= place < len(asked) else "left"
        faces = written if isinstance(written, str) else " ".join(written)
    return Step(
        entry["setup"] + 1, turned, _called(entry["cutter"], plan), faces, entry.get("take", "first"), entry["area_mm2"],
        entry.get("alone_mm2"), own.get("text", ""),
    )  # fmt: skip


def _called(cutter: str, plan: dict[str, Any]) -> str:
    """The name of a cutter, as it was typed or its library has it; its id where others have that name, too, or it has none."""
    names = {each["id"]: each.get("name", "") for each in plan.get("cutters", ())}
    name = names.get(cutter, "")
    return name if name and [*names.values()].count(name) == 1 and name not in names else cutter


def axes_of(plan: dict[str, Any]) -> list[str]:
    """Names of the rotary axes that angles of steps have; empty where the plan does not say."""
    return list((plan.get("operations") or {}).get("rotary") or ())


def process_of(steps: Sequence[Step], plan: dict[str, Any], rest: bool) -> str:
    """The steps as the JSON that the program reads; `rest`: what they leave is planned behind them.

    Raises
    ------
    Refused
        A row cannot be read; the line names its step.
    """
    names = axes_of(plan)
    entries = [_entry(each, tr("step {number}").format(number=number), names) for number, each in enumerate(steps, 1)]
    if not entries:
        raise model.Refused(tr("there is no step to judge"))
    before = (plan.get("effective") or {}).get("process") or {}
    return json.dumps({"rest": "plan" if rest else "leave", "step": entries, "forbid": before.get("forbid", [])})


def _entry(step: Step, where: str, names: Sequence[str]) -> dict[str, Any]:
    if not step.cutter.strip():
        raise model.Refused(tr("{where}: the cutter is missing").format(where=where))
    faces = re.split(r"[\s,;]+", step.faces.strip())
    wrong = next((each for each in faces if each != "left" and not re.fullmatch(r"F[1-9]\d*", each)), None)
    if wrong is not None or ("left" in faces and len(faces) > 1):
        raise model.Refused(tr("{where}: faces: write F3 F6, or left, not “{faces}”").format(where=where, faces=step.faces))
    entry = {"setup": step.setup, **turned_of(step.turned, where, names), "cutter": step.cutter.strip(), "take": step.take}
    return {**entry, "faces": "left" if faces == ["left"] else faces}


def turned_of(text: str, where: str, names: Sequence[str]) -> dict[str, Any]:
    """The orientation of a step from its text.

    Raises
    ------
    Refused
        It says none.
    """
    words = text.strip()
    if words.lower() in _SIMULTANEOUS:
        return {"mode": "simultaneous"}
    axis = re.fullmatch(rf"axis\s+({_NUMBER})[\s,]+({_NUMBER})[\s,]+({_NUMBER})", words)
    if axis:
        return {"axis": [float(each) for each in axis.groups()]}
    known = "|".join(map(re.escape, names)) or r"[A-Za-z]\w*?"
    angle = rf"({known})\s*=?\s*({_NUMBER})"
    found = re.findall(angle, words)
    if not found or re.sub(angle, "", words).strip(" ,;°\t") or len({name for name, _ in found}) < len(found):
        example = " ".join(f"{name} 0" for name in names) or "C 0 A 90"
        raise model.Refused(
            tr("{where}: “{text}” is no orientation: write {example}, or simultaneous").format(
                where=where, text=text, example=example
            )
        )
    return {"angles": {name: float(value) for name, value in found}}


def moved(steps: Sequence[Step], place: int, by: int) -> list[Step]:
    """The steps with one moved up (-1) or down (1); as they are where it has no room."""
    to, changed = place + by, list(steps)
    if 0 <= place < len(changed) and 0 <= to < len(changed):
        changed.insert(to, changed.pop(place))
    return changed


def without(steps: Sequence[Step], place: int) -> list[Step]:
    """The steps without one."""
    return [each for k, each in enumerate(steps) if k != place]


def edited(step: Step, column: str, text: str) -> Step:
    """A step with another text in a column: what was judged of it is no longer known."""
    if getattr(step, column) == text:
        return step
    changed: dict[str, Any] = {column: text, "area": None, "alone": None, "fault": ""}
    return replace(step, **changed)
