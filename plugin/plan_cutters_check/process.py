"""Reckon anew what `process` in plan.json must say: its steps, what they finish, and what is left."""

import math
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from plan_cutters_check.leaves import Between, Exactly, Loose
from plan_cutters_check.question import axes_of, frame_of
from plan_cutters_check.reckoned import NO_REASON, NOT_REACHED, Reckoned, Rows, Weights, empty

#: Which plan of operations is the process: the first of these that there is.
_PREFERRED = ("process", "fastest", "fewest")
#: Cosine from the setup axis under which a tool comes from below; angles that were written may be rounded by so much, deg.
_BELOW, _ROUNDED = -0.01, 1.5e-3
#: By how much each of some angles may be off, deg, that are written to three digits.
_WRITTEN = 0.0021
#: A number of a reason that is none: a step for it would be hardly any.
_SHORT = 1000
#: How steps of one cutter cut, in their order; those that move come last.
_STRATEGIES = ("floor", "mixed", "wall", "point")
#: Entries of a step that repeat those of its first operation.
_REPEATED = ("setup", "mode", "angles_deg", "axis", "cutter", "strategy")


class Process:
    """Reckon what `process` must be.

    Parameters
    ----------
    reckoned : Reckoned
    """

    def __init__(self, reckoned: Reckoned) -> None:
        self.reckoned, self.question = reckoned, reckoned.question
        plans = self.question.document["operations"]["plans"]
        k = min(range(len(plans)), key=lambda k: _PREFERRED.index(plans[k]["name"]))
        self.plan, self.label = plans[k], reckoned.array(k, "operation")
        self.done = (self.label >= 0) & reckoned.finished
        self.written: Mapping[str, Any] = self.question.document["process"] or {}

    def entry(self) -> dict[str, Any]:
        """Reckon it, as far as it follows from the operations, the samples and the labels."""
        steps, clamping = self._steps(), self.question.document["operations"]["assumed"]["setup_s"]
        clamping *= max(0, len({step["setup"] for step in steps}) - 1)
        seconds, requested, left = self.plan["seconds"], self.reckoned.required.whole, self._by_cause(steps)
        finished = float(self.reckoned.required.area[self.done].sum())
        share = min(max(finished / max(1e-300, requested), math.ulp(0.0)), math.nextafter(1.0, 0.0))
        exempt = np.flatnonzero(self.reckoned.exempt)
        strips = np.where(self.question.samples["inside_bodies"], 0.0, self.reckoned.sampled)
        edges = Weights(self.question.samples, strips, requested)
        return {
            "steps": steps, "plan": self.plan["name"], "left": left, "finished_mm2": finished, "asked_mm2": requested,
            "finished_share": 1.0 if not left else share if self.done.any() else 0.0,
            "seconds": None if seconds is None else seconds - clamping,
            "setup_seconds": None if seconds is None else clamping,
            "exempt": self._remaining("sharp_edge", exempt, edges, self.written.get("exempt")) if len(exempt) else None,
        }  # fmt: skip

    def _steps(self) -> list[dict[str, Any]]:
        """Those of the planner's own first, then by setup, by cutter, the largest first, by how they cut, and by area."""
        operations, own = self.plan["operations"], self.reckoned.own or []
        size = {
            each["id"]: (each.get("group") == "last", -each["radius"], each["corner_radius"], each["length"], k)
            for k, each in enumerate(self.question.document["cutters"])
        }

        def rank(each: Mapping[str, Any]) -> tuple[Any, ...]:
            kind = _STRATEGIES.index(each["strategy"]) if each["mode"] == "fixed" else len(_STRATEGIES)
            return each["setup"], size[each["cutter"]], kind, -each["area_mm2"]

        groups: dict[Any, list[int]] = {}
        for k in sorted((k for k, each in enumerate(operations) if each.get("step") is None), key=lambda k: rank(operations[k])):
            orbit = operations[k].get("orbit")
            groups.setdefault(operations[k]["id"] if orbit is None else orbit, []).append(k)
        steps = [self._own(step, number) for number, step in enumerate(own, 1)]
        steps += sorted((self._step(sorted(same, key=lambda k: _turned(operations[k]))) for same in groups.values()), key=rank)
        written = [*self.written.get("steps", []), *[{}] * len(steps)]
        for step, each in zip(steps, written, strict=False):
            step["faces"] = self.reckoned.required.faces(step.pop("rows"), each.get("faces", []))
            if step.get("repeat", 1) > 1 and each.get("repeat_deg") is not None:
                step["repeat_deg"] = evenly(each["repeat_deg"], [operations[k]["angles_deg"] for k in step["same"]])
            del step["same"]
        return steps

    def _own(self, step: Mapping[str, Any], number: int) -> dict[str, Any]:
        """A step of the planner's own: what its operation, if it has one, says of it."""
        mine = [k for k, each in enumerate(self.plan["operations"]) if each.get("step") == number]
        if mine:
            made = self._step(mine)
            return {name: made[name] for name in made if name not in ("alone_mm2", "take", "own", "below_mm2")}
        return self._turned_to(step, number) | {
            "setup": step["setup"] - 1, "mode": step["mode"], "cutter": step["cutter"], "strategy": "point", "repeat": 1,
            "repeat_deg": None,
            "area_mm2": 0.0, "share": 0.0, "below_mm2": 0.0, "seconds": 0.0, "link_seconds": 0.0, "clearance_mm": None,
            "operation": "", "rows": np.zeros(0, np.int64), "same": (),
        }  # fmt: skip

    def _turned_to(self, step: Mapping[str, Any], number: int) -> dict[str, Any]:
        """Angles and axis of a step that a person wrote with angles, where the plan has them: a machine may not hold them."""
        steps, machine, setup = self.written.get("steps", []), self.question.machine, step["setup"] - 1
        if "angles" not in step or len(steps) < number or steps[number - 1]["angles_deg"] is None:
            return {}
        degrees = [step["angles"][name] for name in machine.names]
        axis = axes_of(machine, self.question.setups[setup], np.array([degrees], float))[0].tolist()
        near = [Between(x - _ROUNDED, x + _ROUNDED) for x in (*degrees, *axis)]
        return {"angles_deg": Exactly(zip(machine.names, near, strict=False)), "axis": near[-3:]}

    def _step(self, same: Sequence[int]) -> dict[str, Any]:
        """A step of some operations, the first one first."""
        each, first = [self.plan["operations"][k] for k in same], self.plan["operations"][same[0]]
        rows, alone = np.flatnonzero(np.isin(self.label, same)), len(same) == 1
        clearances, seconds = [e["clearance_mm"] for e in each], [e["seconds"] for e in each]
        size = self.reckoned.required.of(rows, "area_mm2", "share")
        step: dict[str, Any] = {
            **{name: first[name] for name in _REPEATED}, **size, "operation": first["id"], "take": "share", "own": None,
            "rows": rows, "same": same,
            "link_seconds": sum(e["link_seconds"] for e in each),
            "seconds": None if None in seconds else sum(seconds), "clearance_mm": None if None in clearances else min(clearances),
            "alone_mm2": first["exclusive_mm2"] if alone else Loose(0.0, size["area_mm2"]),
            "below_mm2": self._below(first, rows, size["area_mm2"]),
        }  # fmt: skip
        if first["mode"] == "fixed":
            step |= {"repeat": len(same)} | ({"repeat_deg": None} if alone else {})
        return step

    def _below(self, first: Mapping[str, Any], rows: Rows, size: float) -> Any:
        """Area of a step whose axis points under the plane across the setup axis."""
        samples, up = self.question.samples, frame_of(self.question.setups[first["setup"]])[2]
        if first["axis"] is not None:
            return size if float(np.dot(first["axis"], up)) < _BELOW else 0.0
        if len(self.question.setups) > 1:
            return Loose(0.0, size)
        return float(self.reckoned.required.area[rows][samples[f"axis_{first['cutter']}"][rows] @ up < _BELOW].sum())

    def _by_cause(self, steps: Sequence[Mapping[str, Any]]) -> list[dict[str, Any]]:
        """What no step finishes by its cause: that of the finest cutter of the process, else of any."""
        document, used = self.question.document, {step["cutter"] for step in steps}
        cutters = sorted(document["cutters"], key=lambda c: (c["id"] not in used, c["radius"], c["corner_radius"]))
        left, reason = self.reckoned.finished & ~self.done, np.full(len(self.label), NO_REASON)
        for name in (cutter["id"] for cutter in cutters):
            mine = left & (reason == NO_REASON) & np.isin(self.reckoned.verdict[name], NOT_REACHED)
            reason[mine] = self.question.samples[f"reason_{name}"][mine]
        if self.reckoned.all_planned:
            reason[left & self.reckoned.reached] = _SHORT
        words = {_SHORT: "short_step", NO_REASON: "not_planned"}
        causes = {
            words.get(code) or document["reasons"][code]: np.flatnonzero(left & (reason == code))
            for code in np.unique(reason[left]).tolist()
        }
        if self.reckoned.unjudged.any() or self.reckoned.not_sampled > 0.0 or empty(self.question):
            causes["unjudged"] = np.flatnonzero(self.reckoned.unjudged)
        written = {each["cause"]: each for each in self.written.get("left", [])}
        entries = [self._remaining(cause, rows, self.reckoned.required, written.get(cause)) for cause, rows in causes.items()]
        return sorted(entries, key=lambda each: (-each["area_mm2"], each["cause"]))

    def _remaining(self, cause: str, rows: Rows, by: Weights, written: Mapping[str, Any] | None) -> dict[str, Any]:
        """An area that is left; of several samples in the middle of it, the one that is written."""
        written = written or {}
        entry, faces, place = by.of(rows, "area_mm2", "share", "samples"), by.faces(rows, written.get("faces", [])), None
        if faces:
            mine = by.samples["point"][rows[by.samples["face"][rows] == int(faces[0][1:])]]
            away = np.linalg.norm(mine - mine.mean(axis=0), axis=1)
            near = mine[away <= away.min() + 1e-9]
            stated = np.array(written.get("place_mm") or [np.inf] * 3, float)
            place = near[np.abs(near - stated).max(axis=1).argmin()].tolist() if stated.shape == (3,) else near[0].tolist()
        if cause == "unjudged":
            entry["area_mm2"] += self.reckoned.not_sampled
            entry["share"] = min(1.0, entry["area_mm2"] / max(1e-300, by.whole))
            faces = list(dict.fromkeys([*faces, *empty(self.question)]))
        return {"cause": cause, **entry, "faces": faces, "place_mm": place}


def _turned(operation: Mapping[str, Any]) -> list[float]:
    return [angle % 360.0 for angle in (operation["angles_deg"] or {}).values()]


def evenly(by: Mapping[str, float], every: Sequence[Mapping[str, float]]) -> Any:
    """Give the angle, deg, by which a rotary axis turns from one image to the next, if the angles of all images say so."""
    if len(by) != 1 or not every or not {*by} <= {*every[0]}:
        return "what one rotary axis turns by"
    for name, first in every[0].items():
        away, turn = np.array([each[name] - first for each in every]), by.get(name)
        near = away if not turn else away - turn * np.rint(away / turn)
        if np.abs((near + 180.0) % 360.0 - 180.0).max() > _WRITTEN * len(every):
            return "what the angles of its operations turn by"
        # It is a whole part of the turn.
        if turn is not None and not (
            turn > 0.0 and abs(360.0 / turn - round(360.0 / turn)) < 1e-2 and len({*away}) == len(every)
        ):
            return "a whole part of the turn"
    return dict(by)
