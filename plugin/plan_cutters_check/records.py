"""All that plan.json must say, record by record: what its files give, what the command says, and what the words are made of."""

import math
from collections import Counter
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from plan_cutters_check import drilling
from plan_cutters_check.control import words_of
from plan_cutters_check.findings import Between, Exactly, Loose, merged_trees
from plan_cutters_check.question import FREE, axes_of, degrees_of, frame_of, other_angles, tool_frame
from plan_cutters_check.reckoned import (
    NO_REASON,
    NOT_REACHED,
    WALL,
    WORDS,
    Planned,
    Reckoned,
    Rows,
    Weights,
    evenly,
    falling,
    weighed,
)

#: Words for how samples are cut, and the share of an operation's area from which on one of them is that of all of it.
_STRATEGIES, _NEARLY_ALL = ("point", "floor", "wall"), 0.95
#: Seconds of an orientation that nothing tells; by how much angles may be off that are rounded for a control, deg; a weight of 1.
_INDEX_TIME, _ROUNDED, _UNIT = 5.0, 0.0015, 1_000_000
#: Entries of `assumed` that repeat what was asked for in `effective`, and of a step those of its first operation.
_ASSUMED = {"scallop_mm": "scallop_mm", "stepover": "stepover", "overlap_mm": "overlap_mm", "change_s": "change_time_s",
            "setup_s": "setup_time_s", "link_s": "link_time_s"}  # fmt: skip
_OF_FIRST = ("setup", "mode", "angles_deg", "axis", "cutter", "strategy", "g68_2", "g53_1", "rotary_words")
#: Which plan of operations is the process: the first of these that there is. How its steps of one cutter cut, in their order.
_PREFERRED, _ORDER = ("process", "fastest", "fewest"), ("floor", "mixed", "wall", "point")
#: Cosine from the setup axis under which a tool comes from below.
_BELOW = -0.01
#: Share of its radius by which faces of one wall may differ.
_WALL = 2e-3
#: A number of a reason that is none: a step for it would be hardly any.
_SHORT = 1000
_ANY = Loose(0.0, math.inf)


def document_of(reckoned: Reckoned) -> dict[str, Any]:
    """Reckon plan.json, as far as it follows from the files, the part and the command."""
    question = reckoned.question
    document, samples, machine, face = question.document, question.samples, question.machine, question.samples["face"]
    made, targets = [_cutter(reckoned, name) for name in reckoned.ids], {*document["effective"]["target_faces"]}
    inside = {*np.unique(face).tolist()} - {int(name[1:]) for name in targets}
    sets = {
        "judged": [f for f in document["faces"] if f["target"]],
        "not_judged": [f for f in document["faces"] if not f["target"] and not f["ignored"]],
    }
    mine = {
        "operations": _operations(reckoned),
        "scope": {
            **{name: len(some) for name, some in sets.items()},
            **{f"{name}_mm2": math.fsum(f["area_mm2"] or 0.0 for f in some) for name, some in sets.items()},
            **{f"{name}_by_kind": Exactly(Counter(f["kind"] for f in some)) for name, some in sets.items()},
        },
        "machine": {
            "tilt_limit_deg": None if machine.tilt_limit >= math.pi else math.degrees(machine.tilt_limit),
            "rotary": [
                {"name": name, "limits_deg": None if np.isinf(limits).any() else np.degrees(limits).tolist()}
                for name, limits in zip(machine.names, machine.limits, strict=True)
            ] if machine.names != FREE else None,
        },
        "process": _Process(reckoned).entry(),
        "cutters": made,
        **_chosen(document, made),
        "samples": {
            "count": len(face), "unjudged": int(reckoned.unjudged.sum()), "inside_bodies": int(samples["inside_bodies"].sum()),
            "exempt": int(reckoned.exempt.sum()), **_drilled(reckoned.drilled),
        },
        "holes": [
            {**_hole(reckoned, each), **drilling.hole(question, k)} for k, each in enumerate(document.get("holes", []))
        ],
        "faces": [
            {
                "id": each.id, "name": each.name, "surface": each.surface, "shape": each.shape, "target": each.id in targets,
                "ignored": each.number in question.ignored, "samples": int((face == each.number).sum()),
                "area_mm2": each.area if np.isfinite(each.area) else None,
            }
            for each in question.part.faces
        ] if not inside else "faces whose samples were judged are targets",
        "part": {"faces": len(question.part.faces), "size_mm": [Between(s - 1e-6, s + 1e-6) for s in question.part.size]},
    }  # fmt: skip
    merged: dict[str, Any] = merged_trees(mine, question.stated)
    return merged


def _operations(reckoned: Reckoned) -> dict[str, Any]:
    """Reckon `operations`."""
    question, written = reckoned.question, reckoned.question.document["operations"]
    effective = question.document["effective"]
    names = {"fewest": ["fewest"], "fastest": ["fastest"], "both": ["fewest", "fastest"]}[effective["operations"]]
    names = names if reckoned.own is None else ["process"]
    same = [plan["name"] for plan in written["plans"]] == names
    plans = [_plan(reckoned, plan) for plan in reckoned.plans] if same else [{"name": n} for n in names]
    stated, source = effective["index_time_s"], written["assumed"]["index_from"]
    rates = question.machine.rates and (source != "given" or not question.machine.names)
    feed, known = effective["feed_mm_min"], written["assumed"]["feed_mm_min"]
    # By library: each of the cutters has a feed, or none has.
    feeds = feed if feed is not None else None if known is None else _ANY
    timed = "fastest" in names and any(plan.get("seconds") is not None for plan in plans)
    seconds = next((plan["seconds"] for plan in written["plans"] if plan["name"] == "fastest"), None)
    return {
        "asked": effective["operations"],
        "rotary": list(question.machine.names),
        "plans": plans,
        "fewest": None if reckoned.without_fewest else _fewest(reckoned, written["fewest"]),
        "fastest": {"seconds": seconds} if "fastest" in names else None,
        "cutters": _uses(reckoned, written) if len(reckoned.considered) > 1 and timed else [],
        "assumed": {
            "feed_mm_min": None if feeds is None else Exactly.fromkeys(reckoned.considered, feeds),
            "index_s": _INDEX_TIME if stated is None else stated,
            "index_from": "rates" if rates else source if source in ("given", "assumed") else "assumed",
            **{name: effective[option] for name, option in _ASSUMED.items()},
        },
    }  # fmt: skip


def _fewest(reckoned: Reckoned, few: Mapping[str, Any]) -> dict[str, Any]:
    pairs, count, reached = few["weights"], len(reckoned.question.operations["chosen"]), reckoned.reached
    total = sum(weight for _, weight in pairs)
    proved = -(-total // _UNIT)
    good = all(type(x) is int for pair in pairs for x in pair) and len({row for row, _ in pairs}) == len(pairs)
    good = good and all(0 <= row < len(reached) and reached[row] and 0 < weight <= _UNIT for row, weight in pairs)
    exact = few["proof"] == "weights" or few["at_least"] == proved
    proof = "weights" if proved >= few["at_least"] else "branch and bound"
    return {
        "found": count, "proof": "not closed" if few["at_least"] < few["found"] else proof, "bound": total / 1e6,
        "weights": [list(pair) for pair in pairs] if good else "whole numbers on reached samples, one for each",
        "samples": int(reached.sum()),
        "candidates": len(reckoned.question.operations["candidate_cutter"]),
        # A choice that serves all bounds it from above.
        "at_least": proved if exact else Loose(proved, count),
    }  # fmt: skip


def _uses(reckoned: Reckoned, written: Mapping[str, Any]) -> list[dict[str, Any]]:
    """What each cutter that was compared takes."""
    if sorted(use["id"] for use in written["cutters"]) != sorted(reckoned.considered):
        return [{"id": name} for name in reckoned.considered]
    entries, area = [], reckoned.area
    for use in written["cutters"]:
        name, takes = use["id"], Exactly()
        for plan in reckoned.plans:
            mine = (i for i, each in enumerate(plan.operations) if each["cutter"] == name)
            takes[plan.entry["name"]] = sum(float(area[plan.label == i].sum()) for i in mine)
        others = np.logical_or.reduce([each for other, each in reckoned.reached_by.items() if other != name])
        only = float(area[reckoned.reached_by[name] & ~others].sum())
        entries.append({"id": name, "takes_mm2": takes, "only_mm2": only})
    return entries


def _sizes(document: Mapping[str, Any]) -> dict[str, tuple[Any, ...]]:
    """What cutters are sorted by within a setup."""
    return {
        each["id"]: (each.get("group") == "last", -each["radius"], each["corner_radius"], each["length"], k)
        for k, each in enumerate(document["cutters"])
    }


def _plan(reckoned: Reckoned, plan: Planned) -> dict[str, Any]:
    document, label, written = reckoned.question.document, plan.label, plan.operations
    assumed, cutting = document["operations"]["assumed"], float(plan["seconds"][label >= 0].sum())
    made = [_operation(reckoned, plan, i, each) for i, each in enumerate(written)]
    fixed = [each for each in made if each["mode"] == "fixed"]
    other = sum(float((assumed if each["axis"] is None else each)["index_s"]) for each in written)
    size = _sizes(document)
    in_turn = sorted(written, key=lambda each: (each.get("step") is None, each.get("step") or 0, size[each["cutter"]]))
    changes = drilling.changes((each["setup"], each["cutter"]) for each in in_turn)
    other += assumed["change_s"] * changes + assumed["setup_s"] * max(0, len({each["setup"] for each in written}) - 1)
    # What no operation takes, and why by the first cutter.
    rest, words = np.flatnonzero(reckoned.finished & (label < 0)), document["reasons"]
    first = reckoned.question.samples[f"reason_{reckoned.considered[0]}"][rest]
    known = [c for c in np.unique(first).tolist() if c != NO_REASON and c < len(words)]
    links = sum(each["link_seconds"] for each in made)
    # What is proved of the plan, by what is of its operations.
    looked_at = [each for each in written if each["proved_share"] is not None]
    proved = sum(each["area_mm2"] for each in looked_at)
    share = sum(each["area_mm2"] * each["proved_share"] for each in looked_at) / proved if proved > 0.0 else 0.0
    approaches = sum(each["approaches_proved"] or 0 for each in looked_at)
    entry: dict[str, Any] = {
        "name": plan.entry["name"],
        "orientations": len(fixed),
        "cut_length_mm": sum(each["cut_length_mm"] or 0.0 for each in made),
        "seconds": cutting + links + other if math.isfinite(cutting) else None,
        "link_seconds": links,
        "cutting_seconds": cutting if math.isfinite(cutting) else None,
        "other_seconds": other,
        "changes": changes,
        "pieces": sum(len(each["regions"]) for each in made),
        "operations": made,
        "rest": reckoned.judged.of(rest, "samples", "area_mm2", "share")
        | {"short": int(reckoned.reached[rest].sum()) if reckoned.all_planned else Loose(0, len(rest))}
        | {"reason_counts": Exactly({words[c]: int((first == c).sum()) for c in known})},
        "proved_share": Loose(share, share, 1e-6) if looked_at and proved > 0.0 else None,
        "approaches_proved": Loose(approaches, approaches) if looked_at else None,
    }
    return entry


def _operation(reckoned: Reckoned, plan: Planned, i: int, each: Mapping[str, Any]) -> dict[str, Any]:
    rows, assumed = plan.rows(i), reckoned.question.document["operations"]["assumed"]
    strip, length, seconds, link, alone, how = (
        plan[name][rows] for name in ("strip_mm", "path_mm", "seconds", "link_s", "exclusive", "strategy")
    )
    area, known = reckoned.area[rows], np.isfinite(strip) & (strip > 0.0)
    widths, timed = np.percentile(strip[known], (10, 50, 90)).tolist() if known.any() else None, np.isfinite(seconds).all()
    # How most of its samples are cut.
    size = np.bincount(np.minimum(how, WALL), area, len(_STRATEGIES))
    most = not len(rows) or size.max() >= _NEARLY_ALL * size.sum()
    entry: dict[str, Any] = {
        "id": f"op{i + 1}",
        "step": _step(reckoned, each),
        "mode": "simultaneous" if each["axis"] is None else "fixed",
        "strategy": _STRATEGIES[int(size.argmax())] if most else "mixed",
        "cutter": each["cutter"] if each["cutter"] in reckoned.considered else "one of the cutters that were compared",
        "setup": each["setup"] if each["setup"] in range(len(reckoned.question.setups)) else "one of the setups",
        **reckoned.judged.of(rows, "samples", "area_mm2", "share"),
        "exclusive_mm2": float(area[alone].sum()),
        "strip_mm": None if widths is None else [Loose(w, w, 1e-6 * w) for w in widths],
        "cut_length_mm": float(length.sum()) if np.isfinite(length).all() else None,
        "seconds": float(seconds.sum()) if timed else None,
        "link_seconds": float(link.sum()) + len(each["regions"]) * assumed["link_s"] if timed else 0.0,
        "faces": reckoned.judged.by_face(rows, each["faces"]),
        "regions": _regions(reckoned, plan, i, each, rows),
    }
    if each["axis"] is None:
        return entry | dict.fromkeys(
            ("axis", "angles_deg", "other_angles_deg", "frame", "index_s", "index_from", "g68_2", "g53_1", "rotary_words")
        )
    return entry | _orientation(reckoned, each) if entry["setup"] == each["setup"] else entry


def _step(reckoned: Reckoned, each: Mapping[str, Any]) -> Any:
    """The number of an operation's step, if that is about the same cutter, setup and mode."""
    number, own = each.get("step"), reckoned.own
    if number is None:
        return None
    if own is None or not (type(number) is int and 1 <= number <= len(own)):
        return "one of the steps that were requested"
    step, mode = own[number - 1], "simultaneous" if each["axis"] is None else "fixed"
    same = (step["cutter"], step["setup"] - 1, step["mode"]) == (each["cutter"], each["setup"], mode)
    same = same and (step["faces"] == "left" or {one["face"] for one in each["faces"]} <= {*step["faces"]})
    return number if same else "a step with this cutter, setup and mode, on these faces"


def _orientation(reckoned: Reckoned, each: Mapping[str, Any]) -> dict[str, Any]:
    question, assumed = reckoned.question, reckoned.question.document["operations"]["assumed"]
    setup, machine, degrees = question.setups[each["setup"]], question.machine, degrees_of(question, each)
    axis, x, plane = tool_frame(question, each["setup"], degrees)
    others, stated = other_angles(question, each["setup"], degrees[0]), each["other_angles_deg"] or {}
    other = None
    if others:
        # Of those that are as large any may be written.
        near = min(others, key=lambda one: math.dist(one, [float(stated.get(name, 0.0)) for name in machine.names]))
        other = Exactly({name: Between(a - _ROUNDED, a + _ROUNDED) for name, a in zip(machine.names, near, strict=True)})
    across = x.tolist() if np.isfinite(x).all() else [Loose(-1.0, 1.0)] * 3
    return {
        "axis": axis.tolist(),
        "angles_deg": Exactly(zip(machine.names, degrees[0].tolist(), strict=True)),
        "other_angles_deg": other,
        "frame": {"origin": list(setup.origin or (0.0, 0.0, 0.0)), "z": axis.tolist(), "x": across},
        **words_of(machine, each, plane, each["other_angles_deg"]),
        "index_from": assumed["index_from"],
        "index_s": _ANY if assumed["index_from"] == "rates" else assumed["index_s"],
    }


def _regions(reckoned: Reckoned, plan: Planned, i: int, each: Mapping[str, Any], rows: Rows) -> Any:
    """The regions of an operation: their samples are those that are written, if together they are the operation's."""
    before = sum(len(one["regions"]) for one in plan.operations[:i])
    regions, seen = [], [np.zeros(0, np.int64)]
    for number, region in enumerate(each["regions"], before):
        runs = [(int(first), int(last)) for first, last in region["rows"]]
        if not all(0 <= first <= last < len(reckoned.area) for first, last in runs):
            return "regions of samples that there are"
        mine = np.concatenate([seen[0], *(np.arange(first, last + 1) for first, last in runs)])
        seen.append(mine)
        same = reckoned.judged.of(mine, "samples", "area_mm2", "low", "high", "rows")
        regions.append({"id": number, **same, "faces": reckoned.judged.by_face(mine, region["faces"])})
    if not np.array_equal(np.sort(np.concatenate(seen)), rows):
        return f"regions with the {len(rows)} samples that operations.npz gives it"
    return regions if falling([one["area_mm2"] for one in regions]) else "the largest region first"


class _Process:
    """Reckon what `process` must be: its steps, what they finish, and what is left."""

    def __init__(self, reckoned: Reckoned) -> None:
        self.reckoned, self.question = reckoned, reckoned.question
        self.plan = min(reckoned.plans, key=lambda plan: _PREFERRED.index(plan.entry["name"]))
        self.done = (self.plan.label >= 0) & reckoned.finished
        self.written: Mapping[str, Any] = self.question.document["process"] or {}

    def entry(self) -> dict[str, Any]:
        """Reckon it, as far as it follows from the operations, the samples and the labels."""
        steps, clamping = self._steps(), self.question.document["operations"]["assumed"]["setup_s"]
        clamping *= max(0, len({step["setup"] for step in steps}) - 1)
        seconds, requested, left = self.plan.entry["seconds"], self.reckoned.required.whole, self._by_cause(steps)
        finished = float(self.reckoned.required.area[self.done].sum())
        share = min(max(finished / max(1e-300, requested), math.ulp(0.0)), math.nextafter(1.0, 0.0))
        exempt = np.flatnonzero(self.reckoned.exempt)
        strips = np.where(self.question.samples["inside_bodies"], 0.0, self.reckoned.sampled)
        edges = Weights(self.question.samples, strips, requested)
        entry = {
            "setups": [self._stand(k, each.z) for k, each in enumerate(self.question.setups)],
            "steps": steps, "plan": self.plan.entry["name"], "left": left, "finished_mm2": finished, "asked_mm2": requested,
            "finished_share": 1.0 if not left else share if self.done.any() else 0.0,
            "seconds": seconds, **self._times(clamping),
            "exempt": self._remaining("sharp_edge", exempt, edges, self.written.get("exempt")) if len(exempt) else None,
        }  # fmt: skip
        return entry | drilling.times(self.question, entry, steps)

    def _times(self, clamping: float) -> dict[str, float | None]:
        """What its seconds are made of, from the plan of operations."""
        plan, assumed = self.plan.entry, self.question.document["operations"]["assumed"]
        change = assumed["change_s"] * plan["changes"]
        times = {
            "cutting_seconds": plan["cutting_seconds"], "link_seconds": plan["link_seconds"], "change_seconds": change,
            "setup_seconds": clamping, "index_seconds": max(0.0, plan["other_seconds"] - change - clamping),
        }  # fmt: skip
        return dict.fromkeys(times) if plan["seconds"] is None else times

    def _stand(self, setup: int, up: tuple[float, float, float]) -> dict[str, Any]:
        """How the part stands in a setup, as far as the fixtures say it: whether jaws are there is looked at by itself."""
        stand: dict[str, Any] = {"number": setup + 1, "up": list(up)}
        jaws = [each for each in self.question.document["fixtures"] if each["clamping"] and setup in each["setups"]]
        if jaws:
            stand |= {"held": jaws[0]["clamping"].partition(":")[0], "clamping": jaws[0]["clamping"]}
            stand |= {"grips": jaws[0]["grips"]} if jaws[0]["grips"] else {}
        return stand

    def _steps(self) -> list[dict[str, Any]]:
        """Those of the planner's own first, then by setup, by cutter, the largest first, by how they cut, and by area."""
        operations, own = self.plan.operations, self.reckoned.own or []
        size = _sizes(self.question.document)

        def rank(each: Mapping[str, Any]) -> tuple[Any, ...]:
            kind = _ORDER.index(each["strategy"]) if each["mode"] == "fixed" else len(_ORDER)
            return each["setup"], size[each["cutter"]], kind, -each["area_mm2"]

        def turned(k: int) -> list[float]:
            return [angle % 360.0 for angle in (operations[k]["angles_deg"] or {}).values()]

        groups: dict[Any, list[int]] = {}
        for k in sorted((k for k, each in enumerate(operations) if each.get("step") is None), key=lambda k: rank(operations[k])):
            orbit = operations[k].get("orbit")
            groups.setdefault(operations[k]["id"] if orbit is None else orbit, []).append(k)
        steps = [self._own(step, number) for number, step in enumerate(own, 1)]
        steps += sorted((self._step(sorted(same, key=turned)) for same in groups.values()), key=rank)
        written = [*self.written.get("steps", []), *[{}] * len(steps)]
        for step, each in zip(steps, written, strict=False):
            step["faces"] = self.reckoned.required.faces(step.pop("rows"), each.get("faces", []))
            same = step.pop("same")
            if step.get("repeat", 1) > 1 and each.get("repeat_deg") is not None:
                step["repeat_deg"] = evenly(each["repeat_deg"], [operations[k]["angles_deg"] for k in same])
        return steps

    def _own(self, step: Mapping[str, Any], number: int) -> dict[str, Any]:
        """A step of the planner's own: what its operation, if it has one, says of it."""
        mine = [k for k, each in enumerate(self.plan.operations) if each.get("step") == number]
        if mine:
            made = self._step(mine)
            return {name: made[name] for name in made if name not in ("alone_mm2", "take", "own", "below_mm2")}
        steps, machine, turned = self.written.get("steps", []), self.question.machine, dict[str, Any]()
        # Angles and axis where the plan has them: a machine may not hold those that a person wrote.
        if "angles" in step and len(steps) >= number and steps[number - 1]["angles_deg"] is not None:
            degrees = [step["angles"][name] for name in machine.names]
            axis = axes_of(machine, self.question.setups[step["setup"] - 1], np.array([degrees], float))[0].tolist()
            near = [Between(x - _ROUNDED, x + _ROUNDED) for x in (*degrees, *axis)]
            turned = {"angles_deg": Exactly(zip(machine.names, near, strict=False)), "axis": near[-3:]}
        return turned | {
            "setup": step["setup"] - 1, "mode": step["mode"], "cutter": step["cutter"], "strategy": "point", "repeat": 1,
            "repeat_deg": None,
            "area_mm2": 0.0, "share": 0.0, "below_mm2": 0.0, "seconds": 0.0, "link_seconds": 0.0, "clearance_mm": None,
            "operation": "", "rows": np.zeros(0, np.int64), "same": (),
        }  # fmt: skip

    def _step(self, same: Sequence[int]) -> dict[str, Any]:
        """A step of some operations, the first one first."""
        each, first = [self.plan.operations[k] for k in same], self.plan.operations[same[0]]
        rows, alone = np.flatnonzero(np.isin(self.plan.label, same)), len(same) == 1
        clearances, seconds = [e["clearance_mm"] for e in each], [e["seconds"] for e in each]
        size = self.reckoned.required.of(rows, "area_mm2", "share")
        step: dict[str, Any] = {
            **{name: first[name] for name in _OF_FIRST if name in first},
            **size, "operation": first["id"], "take": "share", "own": None,
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
        reckoned, document, used = self.reckoned, self.question.document, {step["cutter"] for step in steps}
        cutters = sorted(document["cutters"], key=lambda c: (c["id"] not in used, c["radius"], c["corner_radius"]))
        left, reason = reckoned.finished & ~self.done, np.full(len(self.done), NO_REASON)
        for name in (cutter["id"] for cutter in cutters):
            mine = left & (reason == NO_REASON) & np.isin(reckoned.verdict[name], NOT_REACHED)
            reason[mine] = self.question.samples[f"reason_{name}"][mine]
        if reckoned.all_planned:
            reason[left & reckoned.reached] = _SHORT
        words = {_SHORT: "short_step", NO_REASON: "not_planned"}
        causes = {
            words.get(code) or document["reasons"][code]: np.flatnonzero(left & (reason == code))
            for code in np.unique(reason[left]).tolist()
        }
        if reckoned.unjudged.any() or reckoned.not_sampled > 0.0 or reckoned.empty:
            causes["unjudged"] = np.flatnonzero(reckoned.unjudged)
        written = {each["cause"]: each for each in self.written.get("left", [])}
        entries = [self._remaining(cause, rows, reckoned.required, written.get(cause)) for cause, rows in causes.items()]
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
            faces = list(dict.fromkeys([*faces, *self.reckoned.empty]))
        return {"cause": cause, **entry, "faces": faces, "place_mm": place}


def _cutter(reckoned: Reckoned, name: str) -> dict[str, Any]:
    """Reckon what `cutters` must hold of one, as far as it follows from the tool, the samples and its verdicts."""
    question = reckoned.question
    sizes, samples, document = question.tools[name], question.samples, question.document
    holder = next((each.low for each in sizes.sections if each.part == "holder"), None)
    end = sizes.sections[-1].low + sizes.sections[-1].length if sizes.sections else sizes.flutes
    entry: dict[str, Any] = {
        "id": name, "radius": sizes.radius, "corner_radius": sizes.corner_radius, "shape": sizes.shape,
        "length": end if holder is None else holder, "taper_deg": math.degrees(sizes.taper),
        "allowance_mm": sizes.allowance, "clearance_mm": sizes.clearance,
        "stages": [
            {"part": s.part, "low_mm": s.low, "length_mm": s.length, "radius_mm": s.radius, "upper_radius_mm": s.upper_radius}
            for s in sizes.sections
        ],
        **(dict(zip(("name", "holder"), question.names[name], strict=True)) if question.names else {}),
    }  # fmt: skip
    if len(question.setups) > 1:
        entry["lost_in_all"] = int((reckoned.finished & np.isin(reckoned.verdict[name], NOT_REACHED)).sum())
    verdict, reason, face = reckoned.verdict[name], samples[f"reason_{name}"], samples["face"]
    for field, code in (("by_reason", 0), ("undecided_by_reason", 3)):
        counts = np.bincount(reason[verdict == code], minlength=256)
        entry[field] = Exactly({word: int(counts[k]) for k, word in enumerate(document["reasons"])})
    faces = Exactly({f"F{n}": _face(reckoned, verdict, reason, face == n) for n in np.unique(face).tolist()})
    entry |= {**_counts(reckoned, verdict, np.ones(len(verdict), bool)), "faces": faces, "area_share": _over(reckoned, faces)}
    # Whether it finishes; null where something is undecided, stands on a proposed table, or is missing.
    another = entry["by_reason"].get("another_setup", 0)
    blocked = entry["inaccessible"] - entry["inside_bodies"] - entry["exempt"]
    doubtful = entry["undecided"] or another or document["missing"]
    return entry | {"feasible": False if blocked > another else None if doubtful else True}


def _counts(reckoned: Reckoned, verdict: NDArray[Any], mine: NDArray[np.bool_]) -> dict[str, int]:
    counts = {word: int((verdict[mine] == code).sum()) for word, code in WORDS.items()}
    inside = reckoned.question.samples["inside_bodies"]
    counts |= {"inside_bodies": int(inside[mine].sum()), "exempt": int(reckoned.exempt[mine].sum())}
    return {**counts, **_drilled(reckoned.drilled[mine])}


def _drilled(mine: NDArray[np.bool_]) -> dict[str, int]:
    """How many of some samples are in holes for drills: written where there are any."""
    return {"drilled": int(mine.sum())} if mine.any() else {}


def _hole(reckoned: Reckoned, written: Mapping[str, Any]) -> dict[str, Any]:
    """Reckon what `holes` must hold of one: its narrowest cylinder."""
    faces = reckoned.question.part.faces
    carriers = [faces[int(name[1:]) - 1].carrier for name in written["faces"] if 1 <= int(name[1:]) <= len(faces)]
    walls = [
        each for each in carriers
        if each and each.radius and each.direction is not None and each.minor_radius is None and each.half_angle is None
    ]  # fmt: skip
    if not walls:
        return {"faces": "a cylinder among them"}
    wall = min(walls, key=lambda each: each.radius or 0.0)
    direction, diameter = np.array(wall.direction), 2.0 * (wall.radius or 0.0)
    axis = (direction if direction @ np.array(written["axis"]) > 0.0 else -direction).tolist()
    on_axis = np.array(wall.point) + ((np.array(written["place_mm"]) - np.array(wall.point)) @ direction) * direction
    return {
        "diameter_mm": Between(diameter * (1.0 - _WALL), diameter * (1.0 + _WALL)),
        "axis": [Between(x - _WALL, x + _WALL) for x in axis],
        "place_mm": [Between(x - _WALL * diameter, x + _WALL * diameter) for x in on_axis.tolist()],
    }


def _face(reckoned: Reckoned, verdict: NDArray[Any], reason: NDArray[Any], mine: NDArray[np.bool_]) -> dict[str, Any]:
    """The verdicts on a face whose samples are these (n,)."""
    samples, words = reckoned.question.samples, reckoned.question.document["reasons"]
    inside, exempt, area = samples["inside_bodies"][mine], reckoned.exempt[mine], weighed(samples["area"][mine])
    drilled = reckoned.drilled[mine]
    seen = ~inside & ~exempt & ~drilled
    within = 1.0 if inside.all() else min(1.0, float(area[inside].sum() / area.sum()))
    bored = float(area[drilled].sum() / area.sum()) if (~inside & ~drilled).any() else 1.0 - within if drilled.any() else 0.0
    bored = min(1.0 - within, bored)
    edges = min(1.0 - within - bored, float(area[exempt].sum() / area.sum())) if seen.any() else 1.0 - within - bored
    counts = _counts(reckoned, verdict, mine)
    verdict, reason, area = verdict[mine][seen], reason[mine][seen], weighed(samples["area"][mine][seen])
    missed, whole = np.isin(verdict, NOT_REACHED), max(float(area.sum()), 1e-300)
    codes = [c for c in np.unique(reason[missed]).tolist() if c < len(words)]
    by = Exactly({words[c]: float(area[missed & (reason == c)].sum() / whole) for c in codes})
    shares = {word: float(area[verdict == code].sum() / whole) for word, code in WORDS.items()}
    entry = {**counts, "area_share": {**shares, "lost_by": by}, "inside_share": within, "exempt_share": edges}
    return {**entry, **({"drilled_share": bored} if bored else {})}


def _over(reckoned: Reckoned, faces: Mapping[str, Mapping[str, Any]]) -> dict[str, Any]:
    """Shares of all target faces, by their areas; those without samples are not judged."""
    unseen = {"area_share": {"unjudged": 1.0, "lost_by": {}}, "inside_share": 0, "exempt_share": 0}
    each = [(size, faces.get(name, unseen)) for name, size in reckoned.face_area.items()]
    sizes = [size * (1.0 - one["inside_share"] - one["exempt_share"] - one.get("drilled_share", 0.0)) for size, one in each]
    whole, shares = max(sum(sizes), 1e-300), [one["area_share"] for _, one in each]

    def over(of: list[Mapping[str, float]], word: str) -> float:
        return sum(size * share.get(word, 0.0) for size, share in zip(sizes, of, strict=True)) / whole

    by = {word: over([share["lost_by"] for share in shares], word) for word in reckoned.question.document["reasons"]}
    every = {word: over(shares, word) for word in WORDS}
    return {**every, "lost_by": Exactly({reason: share for reason, share in by.items() if share > 0.0})}


def _chosen(document: Mapping[str, Any], entries: list[dict[str, Any]]) -> dict[str, Any]:
    """Which cutters must be named as those that finish; not where several setups hide the verdicts of the first one."""
    over = [each["id"] for each in entries if each.get("lost_in_all") == 0]
    named: dict[str, Any] = {"selected_over_setups": over[0] if over and not document["missing"] else None}
    if any("feasible" not in each for each in entries):
        return named
    feasible = [each["id"] for each in entries if each["feasible"]]
    named["selected"] = document["selected"] if document["selected"] in [None, *feasible[:1]] else "a cutter that finishes"
    stood = any(each["by_reason"].get("another_setup") for each in entries)
    if feasible and named["selected"] is None and not stood:
        named["selected"] = feasible[0]

    def leaves(entry: Mapping[str, Any]) -> tuple[float, int]:
        """A cutter leaves a share of the area, and samples: all but what stands on a proposed table."""
        share, another = entry["area_share"], entry["by_reason"].get("another_setup", 0)
        left = share["inaccessible"] + share["undecided"] - share["lost_by"].get("another_setup", 0.0)
        samples = entry["inaccessible"] - entry["inside_bodies"] - entry["exempt"] + entry["undecided"] - another
        return round(left, 9) + 0.0, samples

    return named | {"shown": named["selected"] or min(entries, key=leaves)["id"]}
