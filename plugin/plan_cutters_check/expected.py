"""Reckon anew, from samples and labels, what plan.json must say of a plan's operations."""

import math
from collections.abc import Mapping, Sequence
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

from cad_io.arrays import Floats
from plan_cutters_check.compared import compared
from plan_cutters_check.leaves import Between, Loose
from plan_cutters_check.question import Question, axes_of, carried, frame_of, other_angles
from plan_cutters_check.reading import suffix

Rows = NDArray[np.int64]
#: Verdicts of samples.npz that say that a sample is reached, that it was not judged, and a reason that is none.
_REACHED, _UNJUDGED, _NO_REASON = (1, 2), 255, 255
#: How a sample is cut, in operations.npz, and the words for it; one that takes so much of an operation is that of all of it.
FLOOR, WALL, _STRATEGIES, _NEARLY_ALL = 1, 2, ("point", "floor", "wall"), 0.95
#: Areas that differ by less, as a share, are the same.
_SAME_AREA = 1e-9
#: Seconds of an orientation that nothing tells; by how much angles may be off that are rounded for a control, deg.
_INDEX_TIME, _ROUNDED = 5.0, 0.0015


class Reckoned:
    """Sets of samples, and entries of plan.json that follow from them.

    Attributes
    ----------
    area : (n,) float
        Of the finished samples, mm2, 0 of others.
    finished, reached : (n,) bool
        Judged samples of the finished part; those that a cutter that was compared reaches.
    considered : list of str
        Ids of the cutters that were compared.
    """

    def __init__(self, question: Question) -> None:
        self.question = question
        document, samples = question.document, question.samples
        self.ids: list[str] = [each["id"] for each in document["cutters"]]
        self.verdict = {name: samples[f"verdict_{name}"] for name in self.ids}
        unjudged = np.logical_and.reduce([each == _UNJUDGED for each in self.verdict.values()])
        self.finished = ~unjudged & ~samples["inside_bodies"] & ~samples.get("exempt", np.zeros(len(unjudged), bool))
        process = document["effective"].get("process")
        self.own = None if process is None else process["step"]
        fastest_alone = document["effective"]["operations"] == "fastest" and document["operations"]["fewest"] is None
        self.without_fewest = self.own is not None or fastest_alone
        #: Whether each sample that is reached must go with an operation.
        self.all_planned = process is None or (process["rest"] == "plan" and not process["forbid"])
        reached = {name: self.finished & np.isin(self.verdict[name], _REACHED) for name in self.ids}
        index = question.operations.get("candidate_cutter", np.zeros(0, int))
        tried = {name for k, name in enumerate(self.ids) if (index == k).any()}
        self.considered = compared(document, self.ids, reached, None if self.without_fewest else tried)
        self.reached_by = {name: reached[name] for name in self.considered}
        self.reached = np.logical_or.reduce([*self.reached_by.values()])
        self.area: Floats = np.where(self.finished, np.nan_to_num(samples["area"]), 0.0)
        self.whole = float(self.area.sum())

    def array(self, k: int, name: str) -> NDArray[Any]:
        """An array of operations.npz of plan k."""
        plan = self.question.document["operations"]["plans"][k]["name"]
        return self.question.operations[f"{name}{suffix(k, plan)}"]

    def entry(self) -> dict[str, Any]:
        """Reckon what `operations` must hold, as far as it follows from samples and labels."""
        question = self.question
        document, written = question.document, question.document["operations"]
        effective = document["effective"]
        plans = [self._plan(k, plan) for k, plan in enumerate(written["plans"])]
        many = len(self.considered) > 1
        names = {"fewest": ["fewest"], "fastest": ["fastest"], "both": ["fewest", "fastest"]}[effective["operations"]]
        names = names if self.own is None else ["process"]
        if [plan["name"] for plan in written["plans"]] != names:
            plans = [{"name": name} for name in names]
        timed_ = any(plan["seconds"] is not None for plan in plans if "seconds" in plan)
        stated = effective["index_time_s"]
        count = len(question.operations["chosen"])
        return {
            "asked": effective["operations"],
            "rotary": list(question.machine.names),
            "plans": plans,
            "fewest": None if self.without_fewest else self._fewest(written["fewest"], count),
            "fastest": self._fastest(written) if "fastest" in names else None,
            "cutters": self._cutters(written) if many and "fastest" in names and timed_ else [],
            "assumed": {
                "feed_mm_min": self._feeds(written, effective), "scallop_mm": effective["scallop_mm"],
                "stepover": effective["stepover"], "overlap_mm": effective["overlap_mm"],
                "index_s": _INDEX_TIME if stated is None else stated,
                "index_from": self._index_from(written["assumed"]["index_from"]),
                "change_s": effective["change_time_s"], "setup_s": effective["setup_time_s"],
            },
        }  # fmt: skip

    def _fewest(self, few: Mapping[str, Any], count: int) -> dict[str, Any]:
        total = sum(weight for _, weight in few["weights"])
        return {
            "found": count, "proof": self._proof(few), "weights": self._weights(few), "bound": total / 1e6,
            "lp": Loose(total / 1e6 - 1e-6, count), "samples": int(self.reached.sum()),
            "candidates": len(self.question.operations["candidate_cutter"]), "at_least": self._at_least(few, total, count),
        }  # fmt: skip

    def _feeds(self, written: Mapping[str, Any], effective: Mapping[str, Any]) -> Any:
        feed = effective["feed_mm_min"]
        if feed is not None:
            return dict.fromkeys(self.considered, feed)
        known = written["assumed"]["feed_mm_min"]
        # By library: each of the cutters has one, or none has.
        return None if known is None else dict.fromkeys(self.considered, Loose(0.0, math.inf))

    def _proof(self, few: Mapping[str, Any]) -> str:
        total = -(-sum(weight for _, weight in few["weights"]) // 1_000_000)
        if few["at_least"] < few["found"]:
            return "not closed"
        return "weights" if total >= few["at_least"] else "branch and bound"

    def _at_least(self, few: Mapping[str, Any], total: int, count: int) -> Any:
        proved = -(-total // 1_000_000)
        if few["proof"] == "weights":
            return proved
        # A choice that serves all bounds it from above.
        return proved if few["at_least"] == proved else Loose(proved, count)

    def _weights(self, few: Mapping[str, Any]) -> Any:
        """The weights as they are, if they can be any: whole numbers on samples that are reached, once on each."""
        rows = [row for row, _ in few["weights"]]
        good = all(type(x) is int for pair in few["weights"] for x in pair) and len({*rows}) == len(rows)
        good = good and all(0 <= row < len(self.reached) and self.reached[row] for row in rows)
        good = good and all(0 < weight <= 1_000_000 for _, weight in few["weights"])
        return [list(pair) for pair in few["weights"]] if good else "whole numbers on reached samples, one for each"

    def _cutters(self, written: Mapping[str, Any]) -> list[dict[str, Any]]:
        entries = []
        for use in written["cutters"]:
            name = use["id"]
            if name not in self.considered:
                entries.append({"id": "one of the cutters that were compared"})
                continue
            takes = {
                plan["name"]: sum(
                    float(self.area[self.array(k, "operation") == i].sum())
                    for i, each in enumerate(plan["operations"])
                    if each["cutter"] == name
                )
                for k, plan in enumerate(written["plans"])
            }
            others = np.logical_or.reduce([each for other, each in self.reached_by.items() if other != name])
            only = float(self.area[self.reached_by[name] & ~others].sum())
            entry = {
                "id": name,
                "takes_mm2": takes,
                "only_mm2": only,
                "change_seconds": Loose(0.0, written["assumed"]["change_s"]),
            }
            if use["saves_seconds"] is not None:
                entry["saves_seconds"] = Loose(0.0, math.inf)
            entries.append(entry)
        if len(entries) != len(self.considered) or len({use["id"] for use in written["cutters"]}) != len(entries):
            return [{"id": name} for name in self.considered]
        return entries

    def _fastest(self, written: Mapping[str, Any]) -> dict[str, Any]:
        own = next((plan for plan in written["plans"] if plan["name"] == "fastest"), None)
        seconds = None if own is None else own["seconds"]
        timed = written["fastest"] or {}
        best, bound = timed.get("at_best_seconds"), timed.get("bound_seconds")
        fastest: dict[str, Any] = {
            "seconds": seconds,
            "bound_seconds": Loose(0.0, math.inf),
            "at_best_seconds": Loose(0.0, math.inf),
            "samples": Loose(0, len(self.area)),
            # Where it has more than the fewest are chosen from, these are not written.
            "candidates": Loose(0, math.inf),
        }
        if seconds is None or not isinstance(bound, float | int):
            return fastest | {"gap": None}
        fastest["bound_seconds"] = Loose(best if isinstance(best, float | int) else 0.0, seconds * (1 + 1e-9))
        return fastest | {"gap": max(0.0, seconds / bound - 1.0) if bound > 0.0 else 0.0}

    def _index_from(self, source: str) -> str:
        rates = source != "given" and self.question.machine.rates
        return "rates" if rates else source if source in ("given", "assumed") else "assumed"

    def _plan(self, k: int, plan: Mapping[str, Any]) -> dict[str, Any]:
        question, label, seconds = self.question, self.array(k, "operation"), self.array(k, "seconds")
        operations = [self._operation(k, i, each) for i, each in enumerate(plan["operations"])]
        fixed = [each for each in operations if each["mode"] == "fixed"]
        assumed = question.document["operations"]["assumed"]
        cutting = float(seconds[label >= 0].sum())
        known = math.isfinite(cutting)
        turns = sum(
            float(each["index_s"] if one["mode"] == "fixed" else assumed["index_s"])
            for one, each in zip(operations, plan["operations"], strict=True)
        )
        cutters, setups = ({each[name] for each in plan["operations"]} for name in ("cutter", "setup"))
        other = turns + assumed["change_s"] * max(0, len(cutters) - 1) + assumed["setup_s"] * max(0, len(setups) - 1)
        entry: dict[str, Any] = {
            "name": plan["name"],
            "orientations": len(fixed),
            "cut_length_mm": sum(each["cut_length_mm"] or 0.0 for each in operations),
            "seconds": cutting + other if known else None,
            "cutting_seconds": cutting if known else None,
            "other_seconds": other,
            "changes": max(0, len(cutters) - 1),
            "pieces": sum(len(each["regions"]) for each in operations),
            "operations": operations,
            "rest": self._rest(self.finished & (label < 0)),
            **_proved([each for each in plan["operations"] if each["proved_share"] is not None]),
        }
        if plan["ratio_at_most"] is not None:
            entry["ratio_at_most"] = self._ratio(fixed)
        return entry

    def _rest(self, rest: NDArray[np.bool_]) -> dict[str, Any]:
        """What no operation takes (n,)."""
        area = float(self.area[rest].sum())
        first = self.question.samples[f"reason_{self.considered[0]}"][rest]
        words = self.question.document["reasons"]
        known = [c for c in np.unique(first).tolist() if c != _NO_REASON and c < len(words)]
        counts = {words[c]: int((first == c).sum()) for c in known}
        return {
            "samples": int(rest.sum()),
            "area_mm2": area,
            "share": area / self.whole if self.whole > 0.0 else 0.0,
            "reason_counts": counts,
        }

    def _ratio(self, fixed: Sequence[Mapping[str, Any]]) -> Any:
        timed = self.question.document["operations"]["fastest"]
        if timed is None or not timed["at_best_seconds"] > 0.0 or any(each["seconds"] is None for each in fixed):
            return None
        ratio = max(1.0, sum(each["seconds"] for each in fixed) / timed["at_best_seconds"])
        return Loose(ratio, ratio, 1e-6 * ratio)

    def _operation(self, k: int, i: int, each: Mapping[str, Any]) -> dict[str, Any]:
        question, strip = self.question, self.array(k, "strip_mm")
        rows = np.flatnonzero(self.array(k, "operation") == i)
        strip, seconds, mine = strip[rows], self.array(k, "seconds")[rows], self.area[rows]
        known = np.isfinite(strip) & (strip > 0.0)
        alone = self.array(k, "exclusive")[rows]
        mode = "simultaneous" if each["axis"] is None else "fixed"
        area = float(mine.sum())
        widths = np.percentile(strip[known], (10, 50, 90)).tolist() if known.any() else None
        entry: dict[str, Any] = {
            "id": f"op{i + 1}",
            "step": self._step(each),
            "mode": mode,
            "strategy": self._strategy(k, rows),
            "cutter": each["cutter"] if each["cutter"] in self.considered else "one of the cutters that were compared",
            "setup": each["setup"] if each["setup"] in range(len(question.setups)) else "one of the setups",
            "samples": len(rows),
            "area_mm2": area,
            "share": min(1.0, area / self.whole) if self.whole > 0.0 else 0.0,
            "exclusive_mm2": float(mine[alone].sum()),
            "strip_mm": None if widths is None else [Loose(w, w, 1e-6 * w) for w in widths],
            "cut_length_mm": float((mine[known] / strip[known]).sum()) if known.all() else None,
            "seconds": float(seconds.sum()) if np.isfinite(seconds).all() else None,
            "faces": self._faces(rows, each["faces"]),
            "regions": self._regions(k, i, each, rows),
        }
        if each["proved_share"] is not None:
            entry["proved_share"] = Loose(0.0, 1.0)
            entry["approaches_proved"] = Loose(0, math.inf)
        if mode == "simultaneous":
            return entry | dict.fromkeys(("axis", "angles_deg", "other_angles_deg", "frame", "index_s", "index_from"))
        if entry["setup"] != each["setup"]:
            return entry
        return entry | self._orientation(each)

    def _step(self, each: Mapping[str, Any]) -> Any:
        """The number of an operation's step, if that is about the same cutter, setup and mode."""
        number = each.get("step")
        if number is None:
            return None
        if self.own is None or not (type(number) is int and 1 <= number <= len(self.own)):
            return "one of the steps that were requested"
        step = self.own[number - 1]
        mode = "simultaneous" if each["axis"] is None else "fixed"
        same = (step["cutter"], step["setup"] - 1, step["mode"]) == (each["cutter"], each["setup"], mode)
        same = same and (step["faces"] == "left" or {one["face"] for one in each["faces"]} <= {*step["faces"]})
        return number if same else "a step with this cutter, setup and mode, on these faces"

    def _strategy(self, k: int, rows: Rows) -> str:
        """How most of the samples of an operation are cut."""
        number, area = np.minimum(self.array(k, "strategy")[rows], WALL), self.area[rows]
        size = np.bincount(number, area, len(_STRATEGIES))
        if not len(rows):
            return _STRATEGIES[0]
        return _STRATEGIES[int(size.argmax())] if size.max() >= _NEARLY_ALL * size.sum() else "mixed"

    def _orientation(self, each: Mapping[str, Any]) -> dict[str, Any]:
        question = self.question
        setup, machine = question.setups[each["setup"]], question.machine
        names, written = machine.names, question.document["operations"]
        degrees = np.array([[float(each["angles_deg"][name]) for name in names]])
        axis = axes_of(machine, setup, degrees)[0]
        x = carried(machine, setup, frame_of(setup)[0] @ frame_of(setup).T, degrees)[0]
        x = x - (x @ axis) * axis
        entry: dict[str, Any] = {
            "axis": axis.tolist(),
            "angles_deg": {name: float(each["angles_deg"][name]) for name in names},
            "frame": {
                "origin": list(setup.origin or (0.0, 0.0, 0.0)),
                "z": axis.tolist(),
                "x": (x / np.linalg.norm(x)).tolist() if np.linalg.norm(x) > 1e-6 else [Loose(-1.0, 1.0)] * 3,
            },
            "index_from": written["assumed"]["index_from"],
        }
        if written["assumed"]["index_from"] != "rates":
            entry["index_s"] = written["assumed"]["index_s"]
        else:
            entry["index_s"] = Loose(0.0, math.inf)
        others, stated = other_angles(question, each["setup"], degrees[0]), each["other_angles_deg"] or {}
        entry["other_angles_deg"] = None
        if others:
            # Of those that are as large any may be written.
            other = min(others, key=lambda angles: math.dist(angles, [float(stated.get(name, 0.0)) for name in names]))
            near = {name: Between(angle - _ROUNDED, angle + _ROUNDED) for name, angle in zip(names, other, strict=True)}
            entry["other_angles_deg"] = near
        return entry

    def _faces(self, rows: Rows, written: Sequence[Mapping[str, Any]]) -> list[dict[str, Any]]:
        """The faces of samples, the one with the most area first; of equal ones, as they are written."""
        face = self.question.samples["face"][rows]
        entries: list[dict[str, Any]] = [
            {"face": f"F{f}", "samples": int((face == f).sum()), "area_mm2": float(self.area[rows][face == f].sum())}
            for f in np.unique(face).tolist()
        ]
        place = {each["face"]: k for k, each in enumerate(written)}
        as_written = sorted(entries, key=lambda each: place.get(each["face"], len(place)))
        if all(a["area_mm2"] >= b["area_mm2"] * (1.0 - _SAME_AREA) for a, b in pairwise(as_written)):
            return as_written
        return sorted(entries, key=lambda each: -each["area_mm2"])

    def _regions(self, k: int, i: int, each: Mapping[str, Any], rows: Rows) -> Any:
        """The regions of an operation: their samples are those that are written, if together they are the operation's."""
        before = sum(len(one["regions"]) for one in self.question.document["operations"]["plans"][k]["operations"][:i])
        regions, seen = [], []
        for number, region in enumerate(each["regions"], before):
            runs = [(int(first), int(last)) for first, last in region["rows"]]
            if not all(0 <= first <= last < len(self.area) for first, last in runs):
                return "regions of samples that there are"
            mine = np.concatenate([np.arange(first, last + 1) for first, last in runs] or [np.zeros(0, np.int64)])
            seen.append(mine)
            point = self.question.samples["point"][mine]
            regions.append(
                {
                    "id": number,
                    "samples": len(mine),
                    "area_mm2": float(self.area[mine].sum()),
                    "faces": self._faces(mine, region["faces"]),
                    "low": point.min(axis=0, initial=np.inf).tolist(),
                    "high": point.max(axis=0, initial=-np.inf).tolist(),
                    "rows": _runs(mine),
                }
            )
        if not np.array_equal(np.sort(np.concatenate([*seen, np.zeros(0, np.int64)])), rows):
            return f"regions with the {len(rows)} samples that operations.npz gives it"
        sizes = [one["area_mm2"] for one in regions]
        return regions if all(a >= b * (1.0 - _SAME_AREA) for a, b in pairwise(sizes)) else "the largest region first"


def _runs(rows: Rows) -> list[list[int]]:
    """First and last of runs of consecutive numbers."""
    ends = np.flatnonzero(np.diff(rows) != 1)
    first, last = rows[np.append(0, ends + 1)[: len(rows)]], rows[np.append(ends, len(rows) - 1)[: len(rows)]]
    return np.column_stack([first, last]).tolist()


def _proved(held: Sequence[Mapping[str, Any]]) -> dict[str, Any]:
    """What is proved of a plan, by what is of its operations."""
    size = sum(each["area_mm2"] for each in held)
    shares = sum(each["area_mm2"] * each["proved_share"] for each in held) / size if size > 0.0 else 0.0
    approaches = sum(each["approaches_proved"] or 0 for each in held)
    return {
        "proved_share": Loose(shares, shares, 1e-6) if held and size > 0.0 else None,
        "approaches_proved": Loose(approaches, approaches) if held else None,
    }
