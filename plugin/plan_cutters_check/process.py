"""Reckon anew the process that a plan of operations makes: its steps, what they finish, and what is left."""

import math
from collections.abc import Mapping, Sequence
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

from cad_io.arrays import Floats
from plan_cutters_check.expected import Reckoned
from plan_cutters_check.leaves import Between, Loose
from plan_cutters_check.question import axes_of, frame_of

Rows = NDArray[np.int64]
#: Which plan of operations is the process: the first of these that there is.
_PREFERRED = ("process", "fastest", "fewest")
#: Verdicts that say that a sample is not reached, and a reason that is none.
_NOT_REACHED, _NO_REASON = (0, 3), 255
#: Cosine from the setup axis under which a tool comes from below; areas that differ by a smaller share are the same.
_BELOW, _SAME_AREA = -0.01, 1e-9
#: Angles that were written may be rounded by so much, deg.
_ROUNDED = 1.5e-3


class Process:
    """Reckon what `process` in plan.json must be.

    Attributes
    ----------
    area : (n,) float
        That each required sample stands for, mm2, so that those of a face have its area together; 0 of others.
    requested : float
        All area to machine, mm2.
    """

    def __init__(self, reckoned: Reckoned) -> None:
        self.reckoned, self.question = reckoned, reckoned.question
        document, samples = self.question.document, self.question.samples
        plans = document["operations"]["plans"]
        self.k = min(range(len(plans)), key=lambda k: _PREFERRED.index(plans[k]["name"]))
        self.plan, self.label = plans[self.k], reckoned.array(self.k, "operation")
        self.sampled, self.not_sampled = _sampled_areas(reckoned)
        self.exempt = samples.get("exempt", np.zeros(len(self.label), bool))
        self.area: Floats = np.where(self.exempt | samples["inside_bodies"], 0.0, self.sampled)
        self.requested = float(self.area.sum()) + self.not_sampled
        self.done = (self.label >= 0) & reckoned.finished
        self.written: Mapping[str, Any] = document["process"] or {}

    def entry(self) -> dict[str, Any]:
        """Reckon it, as far as it follows from the operations, the samples and the labels."""
        steps, clamping = self._steps(), self.question.document["operations"]["assumed"]["setup_s"]
        clamping *= max(0, len({step["setup"] for step in steps}) - 1)
        seconds, finished, left = self.plan["seconds"], float(self.area[self.done].sum()), self._by_cause(steps)
        share = min(max(finished / max(1e-300, self.requested), math.ulp(0.0)), math.nextafter(1.0, 0.0))
        return {
            "steps": steps,
            "plan": self.plan["name"],
            "finished_share": 1.0 if not left else share if self.done.any() else 0.0,
            "finished_mm2": finished,
            "asked_mm2": self.requested,
            "left": left,
            "seconds": None if seconds is None else seconds - clamping,
            "setup_seconds": None if seconds is None else clamping,
            "exempt": self._exempt(),
        }

    def _exempt(self) -> dict[str, Any] | None:
        written = self.written.get("exempt")
        rows = np.flatnonzero(self.exempt)
        area = np.where(self.question.samples["inside_bodies"], 0.0, self.sampled)
        return self._remaining("sharp_edge", rows, area, written or {}) if len(rows) else None

    def _steps(self) -> list[dict[str, Any]]:
        """Those of the planner's own first, then by setup, fixed ones first, by cutter and by area."""
        operations, own = self.plan["operations"], self.reckoned.own or []
        by_cutter: dict[tuple[int, str], float] = {}
        for each in operations:
            key = each["setup"], each["cutter"]
            by_cutter[key] = by_cutter.get(key, 0.0) + each["area_mm2"]
        planned = [k for k, each in enumerate(operations) if each.get("step") is None]

        def rank(each: Mapping[str, Any]) -> tuple[Any, ...]:
            moving, most = each["mode"] != "fixed", by_cutter[each["setup"], each["cutter"]]
            return each["setup"], moving, -most, each["cutter"], -each["area_mm2"]

        groups: dict[Any, list[int]] = {}
        for k in sorted(planned, key=lambda k: (*rank(operations[k]), k)):
            orbit = operations[k].get("orbit")
            groups.setdefault(operations[k]["id"] if orbit is None else orbit, []).append(k)
        ordered = [sorted(same, key=lambda k: _turned(operations[k])) for same in groups.values()]
        steps = sorted((self._step(same) for same in ordered), key=rank)
        first = [self._own(step, number) for number, step in enumerate(own, 1)]
        written = self.written.get("steps", [])
        return [
            step | {"faces": self._faces(step.pop("rows"), self.area, each.get("faces", []))}
            for step, each in zip([*first, *steps], [*written, *[{}] * len(operations)], strict=False)
        ]

    def _own(self, step: Mapping[str, Any], number: int) -> dict[str, Any]:
        """A step of the planner's own: what its operation, if it has one, says of it."""
        mine = [k for k, each in enumerate(self.plan["operations"]) if each.get("step") == number]
        if mine:
            made = self._step(mine)
            return {name: made[name] for name in made if name not in ("alone_mm2", "take", "own", "below_mm2")}
        return self._turned_to(step, number) | {
            "setup": step["setup"] - 1, "mode": step["mode"], "cutter": step["cutter"], "strategy": "point", "repeat": 1,
            "repeat_deg": None, "area_mm2": 0.0, "share": 0.0, "below_mm2": 0.0, "seconds": 0.0, "clearance_mm": None,
            "operation": "", "rows": np.zeros(0, np.int64),
        }  # fmt: skip

    def _turned_to(self, step: Mapping[str, Any], number: int) -> dict[str, Any]:
        """Angles and axis of a step that a person wrote with angles, where the plan has them: a machine may not hold them."""
        steps, machine, setup = self.written.get("steps", []), self.question.machine, step["setup"] - 1
        if "angles" not in step or len(steps) < number or steps[number - 1]["angles_deg"] is None:
            return {}
        degrees = [step["angles"][name] for name in machine.names]
        axis = axes_of(machine, self.question.setups[setup], np.array([degrees], float))[0].tolist()
        return {
            "angles_deg": {n: Between(a - _ROUNDED, a + _ROUNDED) for n, a in zip(machine.names, degrees, strict=True)},
            "axis": [Between(x - _ROUNDED, x + _ROUNDED) for x in axis],
        }

    def _step(self, same: Sequence[int]) -> dict[str, Any]:
        """A step of some operations, the first one first."""
        each, first = [self.plan["operations"][k] for k in same], self.plan["operations"][same[0]]
        rows = np.flatnonzero(np.isin(self.label, same))
        size, clearances, seconds = float(self.area[rows].sum()), [e["clearance_mm"] for e in each], [e["seconds"] for e in each]
        step: dict[str, Any] = {
            "setup": first["setup"], "mode": first["mode"], "angles_deg": first["angles_deg"], "axis": first["axis"],
            "cutter": first["cutter"], "strategy": first["strategy"], "area_mm2": size,
            "share": min(1.0, size / max(1e-300, self.requested)), "seconds": None if None in seconds else sum(seconds),
            "clearance_mm": None if None in clearances else min(clearances), "operation": first["id"], "take": "share",
            "alone_mm2": first["exclusive_mm2"] if len(same) == 1 else Loose(0.0, size), "own": None, "rows": rows,
            "below_mm2": self._below(first, rows, size),
        }  # fmt: skip
        if first["mode"] == "fixed":
            step["repeat"] = len(same)
            if len(same) == 1:
                step["repeat_deg"] = None
        return step

    def _below(self, first: Mapping[str, Any], rows: Rows, size: float) -> Any:
        """Area of a step whose axis points under the plane across the setup axis."""
        samples, up = self.question.samples, frame_of(self.question.setups[first["setup"]])[2]
        if first["axis"] is not None:
            return size if float(np.dot(first["axis"], up)) < _BELOW else 0.0
        if len(self.question.setups) > 1:
            return Loose(0.0, size)
        return float(self.area[rows][samples[f"axis_{first['cutter']}"][rows] @ up < _BELOW].sum())

    def _by_cause(self, steps: Sequence[Mapping[str, Any]]) -> list[dict[str, Any]]:
        """What no step finishes by its cause: that of the finest cutter of the process, else of any."""
        document, used = self.question.document, {step["cutter"] for step in steps}
        cutters = sorted(document["cutters"], key=lambda c: (c["id"] not in used, c["radius"], c["corner_radius"]))
        open_ = self.reckoned.finished & ~self.done
        reason = np.full(len(self.label), _NO_REASON)
        for cutter in cutters:
            name = cutter["id"]
            mine = open_ & (reason == _NO_REASON) & np.isin(self.reckoned.verdict[name], _NOT_REACHED)
            reason[mine] = self.question.samples[f"reason_{name}"][mine]
        causes = {
            "not_planned" if code == _NO_REASON else document["reasons"][code]: np.flatnonzero(open_ & (reason == code))
            for code in np.unique(reason[open_]).tolist()
        }
        unjudged = np.logical_and.reduce([each == _NO_REASON for each in self.reckoned.verdict.values()])
        if unjudged.any() or self.not_sampled > 0.0 or _empty(self.question):
            causes["unjudged"] = np.flatnonzero(unjudged)
        written = {each["cause"]: each for each in self.written.get("left", [])}
        entries = [self._remaining(cause, rows, self.area, written.get(cause, {})) for cause, rows in causes.items()]
        return sorted(entries, key=lambda each: (-each["area_mm2"], each["cause"]))

    def _remaining(self, cause: str, rows: Rows, area: Floats, written: Mapping[str, Any]) -> dict[str, Any]:
        """An area that is left; of several samples in the middle of it, the one that is written."""
        samples, size = self.question.samples, float(area[rows].sum())
        faces, place = self._faces(rows, area, written.get("faces", [])), None
        if faces:
            mine = samples["point"][rows[samples["face"][rows] == int(faces[0][1:])]]
            away = np.linalg.norm(mine - mine.mean(axis=0), axis=1)
            near = mine[away <= away.min() + 1e-9]
            stated = np.array(written.get("place_mm") or [np.inf] * 3, float)
            place = near[np.abs(near - stated).max(axis=1).argmin()].tolist() if stated.shape == (3,) else near[0].tolist()
        if cause == "unjudged":
            size += self.not_sampled
            faces = list(dict.fromkeys([*faces, *_empty(self.question)]))
        share = min(1.0, size / max(1e-300, self.requested))
        return {"cause": cause, "area_mm2": size, "share": share, "samples": len(rows), "faces": faces, "place_mm": place}

    def _faces(self, rows: Rows, area: Floats, written: Sequence[str]) -> list[str]:
        """Faces of samples, the one with the most of their area first; of equal ones, as they are written."""
        face = self.question.samples["face"][rows]
        size = np.bincount(face, area[rows], 1)
        ordered = [f"F{n}" for n in sorted(np.unique(face).tolist(), key=lambda n: (-size[n], n))]
        sizes = [float(size[int(name[1:])]) for name in written] if sorted(written) == sorted(ordered) else []
        falls = all(a >= b * (1.0 - _SAME_AREA) for a, b in pairwise(sizes))
        return list(written) if sizes and falls else ordered


def _turned(operation: Mapping[str, Any]) -> list[float]:
    return [angle % 360.0 for angle in (operation["angles_deg"] or {}).values()]


def _empty(question: Any) -> list[str]:
    """Target faces without samples."""
    sampled = {f"F{n}" for n in np.unique(question.samples["face"]).tolist()}
    return [name for name in question.document["effective"]["target_faces"] if name not in sampled]


def weighed(area: Floats) -> Floats:
    """Areas as weights: one that is not known weighs nothing; where none is known each weighs as much."""
    known = np.where(np.isfinite(area) & (area > 0.0), area, 0.0)
    return known if known.sum() > 0.0 else np.ones(len(area))


def face_areas(question: Any) -> dict[str, float]:
    """Areas of the target faces by their ids, mm2; 1 each where none is known."""
    names = [f"F{n}" for n in np.unique(question.samples["face"]).tolist()] + _empty(question)
    areas = weighed(np.array([question.part.faces[int(name[1:]) - 1].area for name in names], float))
    return dict(zip(names, areas.tolist(), strict=True))


def _sampled_areas(reckoned: Reckoned) -> tuple[Floats, float]:
    """The area that each sample (n,) stands for, and that of target faces without samples, mm2."""
    question, areas = reckoned.question, face_areas(reckoned.question)
    face, area = question.samples["face"], np.zeros(len(question.samples["face"]))
    for number in np.unique(face).tolist():
        mine = face == number
        weight = weighed(question.samples["area"][mine])
        area[mine] = areas[f"F{number}"] * weight / weight.sum()
    return area, float(sum(areas[name] for name in _empty(question)))
