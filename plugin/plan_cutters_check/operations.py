"""Reckon anew what `operations` in plan.json must say, as far as it follows from samples and labels."""

import math
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from plan_cutters_check.leaves import Between, Exactly, Loose
from plan_cutters_check.question import axes_of, carried, degrees_of, frame_of, other_angles
from plan_cutters_check.reckoned import NO_REASON, WALL, Reckoned, Rows, falling

#: Words for how samples are cut, and the share of an operation's area from which on one of them is that of all of it.
_STRATEGIES, _NEARLY_ALL = ("point", "floor", "wall"), 0.95
#: Seconds of an orientation that nothing tells; by how much angles may be off that are rounded for a control, deg; a weight of 1.
_INDEX_TIME, _ROUNDED, _UNIT = 5.0, 0.0015, 1_000_000
#: Entries of `assumed` that repeat what was asked for in `effective`.
_REPEATED = {"scallop_mm": "scallop_mm", "stepover": "stepover", "overlap_mm": "overlap_mm", "change_s": "change_time_s",
             "setup_s": "setup_time_s", "link_s": "link_time_s"}  # fmt: skip
_ANY = Loose(0.0, math.inf)


def operations(reckoned: Reckoned) -> dict[str, Any]:
    """Reckon it."""
    question, written = reckoned.question, reckoned.question.document["operations"]
    effective = question.document["effective"]
    names = {"fewest": ["fewest"], "fastest": ["fastest"], "both": ["fewest", "fastest"]}[effective["operations"]]
    names = names if reckoned.own is None else ["process"]
    same = [plan["name"] for plan in written["plans"]] == names
    plans = [_plan(reckoned, k, plan) for k, plan in enumerate(written["plans"])] if same else [{"name": n} for n in names]
    stated, source = effective["index_time_s"], written["assumed"]["index_from"]
    rates = source != "given" and question.machine.rates
    feed, known = effective["feed_mm_min"], written["assumed"]["feed_mm_min"]
    # By library: each of the cutters has a feed, or none has.
    feeds = feed if feed is not None else None if known is None else _ANY
    timed = "fastest" in names and any(plan.get("seconds") is not None for plan in plans)
    return {
        "asked": effective["operations"],
        "rotary": list(question.machine.names),
        "plans": plans,
        "fewest": None if reckoned.without_fewest else _fewest(reckoned, written["fewest"]),
        "fastest": _fastest(reckoned, written) if "fastest" in names else None,
        "cutters": _cutters(reckoned, written) if len(reckoned.considered) > 1 and timed else [],
        "assumed": {
            "feed_mm_min": None if feeds is None else Exactly.fromkeys(reckoned.considered, feeds),
            "index_s": _INDEX_TIME if stated is None else stated,
            "index_from": "rates" if rates else source if source in ("given", "assumed") else "assumed",
            **{name: effective[option] for name, option in _REPEATED.items()},
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
        "lp": Loose(total / 1e6 - 1e-6, count), "samples": int(reached.sum()),
        "candidates": len(reckoned.question.operations["candidate_cutter"]),
        # A choice that serves all bounds it from above.
        "at_least": proved if exact else Loose(proved, count),
    }  # fmt: skip


def _cutters(reckoned: Reckoned, written: Mapping[str, Any]) -> list[dict[str, Any]]:
    uses = written["cutters"]
    if sorted(use["id"] for use in uses) != sorted(reckoned.considered):
        return [{"id": name} for name in reckoned.considered]
    entries = []
    for use in uses:
        name, area = use["id"], reckoned.area
        takes = Exactly({
            plan["name"]: sum(
                float(area[reckoned.array(k, "operation") == i].sum())
                for i, each in enumerate(plan["operations"]) if each["cutter"] == name
            )
            for k, plan in enumerate(written["plans"])
        })  # fmt: skip
        others = np.logical_or.reduce([each for other, each in reckoned.reached_by.items() if other != name])
        entry = {"id": name, "takes_mm2": takes, "only_mm2": float(area[reckoned.reached_by[name] & ~others].sum()),
                 "change_seconds": Loose(0.0, written["assumed"]["change_s"])}  # fmt: skip
        entries.append(entry if use["saves_seconds"] is None else entry | {"saves_seconds": _ANY})
    return entries


def _fastest(reckoned: Reckoned, written: Mapping[str, Any]) -> dict[str, Any]:
    seconds = next((plan["seconds"] for plan in written["plans"] if plan["name"] == "fastest"), None)
    timed = written["fastest"] or {}
    best, bound = timed.get("at_best_seconds"), timed.get("bound_seconds")
    # Where it has more candidates than the fewest are chosen from, these are not written.
    fastest = {"seconds": seconds, "bound_seconds": _ANY, "at_best_seconds": _ANY, "candidates": _ANY, "gap": None,
               "samples": Loose(0, len(reckoned.area))}  # fmt: skip
    if seconds is None or not isinstance(bound, float | int):
        return fastest
    fastest["bound_seconds"] = Loose(best if isinstance(best, float | int) else 0.0, seconds * (1 + 1e-9))
    return fastest | {"gap": max(0.0, seconds / bound - 1.0) if bound > 0.0 else 0.0}


def _plan(reckoned: Reckoned, k: int, plan: Mapping[str, Any]) -> dict[str, Any]:
    document, label, written = reckoned.question.document, reckoned.array(k, "operation"), plan["operations"]
    assumed, cutting = document["operations"]["assumed"], float(reckoned.array(k, "seconds")[label >= 0].sum())
    made = [_operation(reckoned, k, i, each) for i, each in enumerate(written)]
    fixed = [each for each in made if each["mode"] == "fixed"]
    other = sum(float((assumed if each["axis"] is None else each)["index_s"]) for each in written)
    for name, seconds in (("cutter", "change_s"), ("setup", "setup_s")):
        other += assumed[seconds] * max(0, len({each[name] for each in written}) - 1)
    # What no operation takes, and why by the first cutter.
    rest, words = np.flatnonzero(reckoned.finished & (label < 0)), document["reasons"]
    first = reckoned.question.samples[f"reason_{reckoned.considered[0]}"][rest]
    known = [c for c in np.unique(first).tolist() if c != NO_REASON and c < len(words)]
    links = sum(each["link_seconds"] for each in made)
    entry: dict[str, Any] = {
        "name": plan["name"],
        "orientations": len(fixed),
        "cut_length_mm": sum(each["cut_length_mm"] or 0.0 for each in made),
        "seconds": cutting + links + other if math.isfinite(cutting) else None,
        "link_seconds": links,
        "cutting_seconds": cutting if math.isfinite(cutting) else None,
        "other_seconds": other,
        "changes": max(0, len({each["cutter"] for each in written}) - 1),
        "pieces": sum(len(each["regions"]) for each in made),
        "operations": made,
        "rest": reckoned.judged.of(rest, "samples", "area_mm2", "share")
        | {"short": int(reckoned.reached[rest].sum()) if reckoned.all_planned else Loose(0, len(rest))}
        | {"reason_counts": Exactly({words[c]: int((first == c).sum()) for c in known})},
        **_proved([each for each in written if each["proved_share"] is not None]),
    }
    return entry if plan["ratio_at_most"] is None else entry | {"ratio_at_most": _ratio(document, fixed)}


def _proved(looked_at: Sequence[Mapping[str, Any]]) -> dict[str, Any]:
    """What is proved of a plan, by what is of its operations."""
    size = sum(each["area_mm2"] for each in looked_at)
    share = sum(each["area_mm2"] * each["proved_share"] for each in looked_at) / size if size > 0.0 else 0.0
    approaches = sum(each["approaches_proved"] or 0 for each in looked_at)
    return {
        "proved_share": Loose(share, share, 1e-6) if looked_at and size > 0.0 else None,
        "approaches_proved": Loose(approaches, approaches) if looked_at else None,
    }


def _ratio(document: Mapping[str, Any], fixed: Sequence[Mapping[str, Any]]) -> Any:
    timed = document["operations"]["fastest"]
    if timed is None or not timed["at_best_seconds"] > 0.0 or any(each["seconds"] is None for each in fixed):
        return None
    ratio = max(1.0, sum(each["seconds"] + each["link_seconds"] for each in fixed) / timed["at_best_seconds"])
    return Loose(ratio, ratio, 1e-6 * ratio)


def _operation(reckoned: Reckoned, k: int, i: int, each: Mapping[str, Any]) -> dict[str, Any]:
    rows = np.flatnonzero(reckoned.array(k, "operation") == i)
    strip, length, seconds, link, alone, how = (
        reckoned.array(k, name)[rows] for name in ("strip_mm", "path_mm", "seconds", "link_s", "exclusive", "strategy")
    )
    area, known = reckoned.area[rows], np.isfinite(strip) & (strip > 0.0)
    widths = np.percentile(strip[known], (10, 50, 90)).tolist() if known.any() else None
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
        "seconds": float(seconds.sum()) if np.isfinite(seconds).all() else None,
        "link_seconds": 0.0
        if not np.isfinite(seconds).all()
        else float(link.sum()) + len(each["regions"]) * reckoned.question.document["operations"]["assumed"]["link_s"],
        "faces": reckoned.judged.by_face(rows, each["faces"]),
        "regions": _regions(reckoned, k, i, each, rows),
    }
    if each["proved_share"] is not None:
        entry |= {"proved_share": Loose(0.0, 1.0), "approaches_proved": _ANY}
    if each["axis"] is None:
        return entry | dict.fromkeys(("axis", "angles_deg", "other_angles_deg", "frame", "index_s", "index_from"))
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
    setup, machine = question.setups[each["setup"]], question.machine
    degrees, frame = degrees_of(question, each), frame_of(setup)
    axis = axes_of(machine, setup, degrees)[0]
    x = carried(machine, setup, frame[0] @ frame.T, degrees)[0]
    x = x - (x @ axis) * axis
    others, stated = other_angles(question, each["setup"], degrees[0]), each["other_angles_deg"] or {}
    other = None
    if others:
        # Of those that are as large any may be written.
        near = min(others, key=lambda one: math.dist(one, [float(stated.get(name, 0.0)) for name in machine.names]))
        other = Exactly({name: Between(a - _ROUNDED, a + _ROUNDED) for name, a in zip(machine.names, near, strict=True)})
    return {
        "axis": axis.tolist(),
        "angles_deg": Exactly(zip(machine.names, degrees[0].tolist(), strict=True)),
        "other_angles_deg": other,
        "frame": {
            "origin": list(setup.origin or (0.0, 0.0, 0.0)),
            "z": axis.tolist(),
            "x": (x / np.linalg.norm(x)).tolist() if np.linalg.norm(x) > 1e-6 else [Loose(-1.0, 1.0)] * 3,
        },
        "index_from": assumed["index_from"],
        "index_s": _ANY if assumed["index_from"] == "rates" else assumed["index_s"],
    }


def _regions(reckoned: Reckoned, k: int, i: int, each: Mapping[str, Any], rows: Rows) -> Any:
    """The regions of an operation: their samples are those that are written, if together they are the operation's."""
    before = sum(len(one["regions"]) for one in reckoned.question.document["operations"]["plans"][k]["operations"][:i])
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
