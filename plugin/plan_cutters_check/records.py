"""All that plan.json must say, record by record, as far as it follows from its files, the part and the command."""

import math
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from plan_cutters_check import drilling
from plan_cutters_check.control import orientation
from plan_cutters_check.findings import Exactly, Such, about, merged_trees
from plan_cutters_check.question import FREE
from plan_cutters_check.reckoned import NOT_REACHED, WALL, WORDS, Planned, Reckoned, Rows, Weights, evenly

#: Words for how samples are cut, and the share of an operation's area from which on one of them is that of all of it.
_STRATEGIES, _NEARLY_ALL = ("point", "floor", "wall"), 0.95
#: Entries of `assumed` that repeat what was asked for in `effective`, and of a step those of its first operation.
_ASSUMED = {"scallop_mm": "scallop_mm", "stepover": "stepover", "overlap_mm": "overlap_mm", "change_s": "change_time_s",
            "setup_s": "setup_time_s", "link_s": "link_time_s"}  # fmt: skip
_OF_FIRST = ("setup", "mode", "angles_deg", "axis", "cutter", "strategy", "g68_2", "g53_1", "rotary_words")
#: Which plan of operations is the process: the first of these that there is. How its steps of one cutter cut, in their order.
_PREFERRED, _ORDER = ("process", "fastest", "fewest"), ("floor", "mixed", "wall", "point")
#: What the seconds of the process are made of.
_PARTS = ("cutting_seconds", "link_seconds", "index_seconds", "change_seconds", "setup_seconds")
#: Share of its radius by which faces of one wall may differ.
_WALL = 2e-3
#: Sums of areas are written to so much, as a share.
_SUM = 1e-6


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
        },
        "machine": {
            "tilt_limit_deg": None if machine.tilt_limit >= math.pi else math.degrees(machine.tilt_limit),
            "rotary": [
                {"name": name, "limits_deg": None if np.isinf(limits).any() else np.degrees(limits).tolist()}
                for name, limits in zip(machine.names, machine.limits, strict=True)
            ] if machine.names != FREE else None,
        },
        "process": _process(reckoned),
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
        "part": {"faces": len(question.part.faces), "size_mm": about([*question.part.size], 1e-6)},
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
    seconds = next((plan["seconds"] for plan in written["plans"] if plan["name"] == "fastest"), None)
    return {
        "asked": effective["operations"],
        "rotary": list(question.machine.names),
        "plans": plans,
        "fastest": {"seconds": seconds} if "fastest" in names else None,
        "assumed": {name: effective[option] for name, option in _ASSUMED.items()},
    }


def _sizes(document: Mapping[str, Any]) -> dict[str, tuple[Any, ...]]:
    """What cutters are sorted by within a setup."""
    return {
        each["id"]: (each.get("group") == "last", -each["radius"], each["corner_radius"], each["length"], k)
        for k, each in enumerate(document["cutters"])
    }


def _plan(reckoned: Reckoned, plan: Planned) -> dict[str, Any]:
    label, written, cutting = plan.label, plan.operations, float(plan["seconds"][plan.label >= 0].sum())
    made = [_operation(reckoned, plan, i, each) for i, each in enumerate(written)]
    size = _sizes(reckoned.question.document)
    in_turn = sorted(written, key=lambda each: (each.get("step") is None, each.get("step") or 0, size[each["cutter"]]))
    rest = np.flatnonzero(reckoned.finished & (label < 0))
    links = sum(each["link_seconds"] for each in made)
    return {
        "name": plan.entry["name"],
        "orientations": sum(each["mode"] == "fixed" for each in made),
        "cut_length_mm": sum(each["cut_length_mm"] or 0.0 for each in made),
        "seconds": cutting + links + plan.entry["other_seconds"] if math.isfinite(cutting) else None,
        "link_seconds": links,
        "cutting_seconds": cutting if math.isfinite(cutting) else None,
        "changes": drilling.changes((each["setup"], each["cutter"]) for each in in_turn),
        "pieces": sum(len(each["regions"]) for each in made),
        "operations": made,
        "rest": reckoned.judged.of(rest, "samples", "area_mm2", "share"),
    }


def _operation(reckoned: Reckoned, plan: Planned, i: int, each: Mapping[str, Any]) -> dict[str, Any]:
    rows, assumed = plan.rows(i), reckoned.question.document["operations"]["assumed"]
    length, seconds, link, alone, how = (plan[name][rows] for name in ("path_mm", "seconds", "link_s", "exclusive", "strategy"))
    area, timed = reckoned.area[rows], np.isfinite(seconds).all()
    # How most of its samples are cut.
    size = np.bincount(np.minimum(how, WALL), area, len(_STRATEGIES))
    most = not len(rows) or size.max() >= _NEARLY_ALL * size.sum()
    entry: dict[str, Any] = {
        "id": f"op{i + 1}",
        "step": _step(reckoned, each),
        "mode": "simultaneous" if each["axis"] is None else "fixed",
        "strategy": _STRATEGIES[int(size.argmax())] if most else "mixed",
        "cutter": each["cutter"] if each["cutter"] in reckoned.ids else "one of the cutters",
        "setup": each["setup"] if each["setup"] in range(len(reckoned.question.setups)) else "one of the setups",
        **reckoned.judged.of(rows, "samples", "area_mm2", "share"),
        "exclusive_mm2": float(area[alone].sum()),
        "cut_length_mm": float(length.sum()) if np.isfinite(length).all() else None,
        "seconds": float(seconds.sum()) if timed else None,
        "link_seconds": float(link.sum()) + len(each["regions"]) * assumed["link_s"] if timed else 0.0,
        "faces": reckoned.judged.by_face(rows, each["faces"]),
        "regions": _regions(reckoned, each, rows),
    }
    if each["axis"] is None:
        names = ("axis", "angles_deg", "other_angles_deg", "frame", "g68_2", "g53_1", "rotary_words")
        return entry | dict.fromkeys(names)
    return entry | orientation(reckoned.question, each, 0.0) if entry["setup"] == each["setup"] else entry


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


def _regions(reckoned: Reckoned, each: Mapping[str, Any], rows: Rows) -> Any:
    """The regions of an operation: their samples are those that are written, if together they are the operation's."""
    seen = [np.concatenate([np.arange(first, last + 1) for first, last in one["rows"]]) for one in each["regions"]]
    if not np.array_equal(np.sort(np.concatenate([np.zeros(0, np.int64), *seen])), rows):
        return f"regions with the {len(rows)} samples that operations.npz gives it"
    return [reckoned.judged.of(mine, "samples", "area_mm2") for mine in seen]


def _process(reckoned: Reckoned) -> dict[str, Any]:
    """Reckon `process`, as far as it follows from the operations, the samples and the labels."""
    question, written = reckoned.question, reckoned.question.document["process"]
    plan = min(reckoned.plans, key=lambda plan: _PREFERRED.index(plan.entry["name"]))
    done, whole, parts = (plan.label >= 0) & reckoned.finished, reckoned.required.whole, [written[name] for name in _PARTS]
    finished = float(reckoned.required.area[done].sum())
    share = min(max(finished / max(1e-300, whole), math.ulp(0.0)), math.nextafter(1.0, 0.0))
    missing = bool((reckoned.finished & ~done).any() or reckoned.unjudged.any() or reckoned.empty)
    exempt = np.flatnonzero(reckoned.exempt)
    edges = Weights(question.samples, np.where(question.samples["inside_bodies"], 0.0, reckoned.sampled), whole)
    drilled = drilling.entries(question)
    return {
        "setups": [{"number": k, "up": list(each.z)} for k, each in enumerate(question.setups, 1)],
        "steps": _steps(reckoned, plan), "plan": plan.entry["name"], "finished_mm2": finished, "asked_mm2": whole,
        "left": _remaining(written["left"], whole, whole - finished, missing),
        "finished_share": 1.0 if not missing else share if done.any() else 0.0,
        "seconds": None if None in parts else sum(parts),
        "exempt": {"cause": "sharp_edge", **edges.of(exempt, "area_mm2", "share", "samples")} if len(exempt) else None,
        **({"drilling": drilled} if drilled else {}),
    }  # fmt: skip


def _remaining(written: Sequence[Mapping[str, Any]], whole: float, rest: float, missing: bool) -> Any:
    """What no step finishes: areas that together are the rest; why each is left is not looked at."""
    areas = [each["area_mm2"] for each in written]
    if missing != bool(areas) or not math.isclose(math.fsum(areas), rest, rel_tol=_SUM, abs_tol=_SUM * whole):
        return f"areas of {rest:.6g} mm2 together" if missing else []
    return [{"area_mm2": area, "share": min(1.0, area / max(1e-300, whole))} for area in areas]


def _steps(reckoned: Reckoned, plan: Planned) -> list[dict[str, Any]]:
    """Those of the planner's own first, then by setup, by cutter, the largest first, by how they cut, and by area."""
    operations, own = plan.operations, reckoned.own or []
    size = _sizes(reckoned.question.document)

    def rank(each: Mapping[str, Any]) -> tuple[Any, ...]:
        kind = _ORDER.index(each["strategy"]) if each["mode"] == "fixed" else len(_ORDER)
        return each["setup"], size[each["cutter"]], kind, -each["area_mm2"]

    def turned(k: int) -> list[float]:
        return [angle % 360.0 for angle in (operations[k]["angles_deg"] or {}).values()]

    groups: dict[Any, list[int]] = {}
    for k in sorted((k for k, each in enumerate(operations) if each.get("step") is None), key=lambda k: rank(operations[k])):
        orbit = operations[k].get("orbit")
        groups.setdefault(operations[k]["id"] if orbit is None else orbit, []).append(k)
    steps = []
    for number, step in enumerate(own, 1):
        mine = [k for k, each in enumerate(operations) if each.get("step") == number]
        # One that serves nothing has no operation.
        none = {"setup": step["setup"] - 1, "area_mm2": 0.0, "share": 0.0, "operation": "", "faces": []}
        steps.append(_made_of(reckoned, plan, mine) if mine else {"mode": step["mode"], "cutter": step["cutter"], **none})
    return steps + sorted((_made_of(reckoned, plan, sorted(same, key=turned)) for same in groups.values()), key=rank)


def _made_of(reckoned: Reckoned, plan: Planned, same: Sequence[int]) -> dict[str, Any]:
    """A step of some operations, the first one first."""
    each, first = [plan.operations[k] for k in same], plan.operations[same[0]]
    rows, alone = np.flatnonzero(np.isin(plan.label, same)), len(same) == 1
    clearances, seconds, faces = [e["clearance_mm"] for e in each], [e["seconds"] for e in each], reckoned.required.faces(rows)
    step: dict[str, Any] = {
        **{name: first[name] for name in _OF_FIRST if name in first},
        **reckoned.required.of(rows, "area_mm2", "share"), "operation": first["id"],
        "faces": Such(", ".join(faces), lambda written: sorted(written) == sorted(faces)),
        "link_seconds": sum(e["link_seconds"] for e in each),
        "seconds": None if None in seconds else sum(seconds), "clearance_mm": None if None in clearances else min(clearances),
    }  # fmt: skip
    if alone and first.get("step") is None:
        step["alone_mm2"] = first["exclusive_mm2"]
    if first["mode"] == "fixed":
        even = Such("what its angles turn by", lambda by: by is None or evenly(by, [e["angles_deg"] for e in each]))
        step |= {"repeat": len(same), "repeat_deg": None if alone else even}
    return step


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
    }  # fmt: skip
    if len(question.setups) > 1:
        entry["lost_in_all"] = int((reckoned.finished & np.isin(reckoned.verdict[name], NOT_REACHED)).sum())
    verdict, reason, face = reckoned.verdict[name], samples[f"reason_{name}"], samples["face"]
    for field, code in (("by_reason", 0), ("undecided_by_reason", 3)):
        counts = np.bincount(reason[verdict == code], minlength=256)
        entry[field] = Exactly({word: int(counts[k]) for k, word in enumerate(document["reasons"])})
    faces = Exactly({f"F{n}": _face(reckoned, verdict, reason, face == n) for n in np.unique(face).tolist()})
    every = np.ones(len(verdict), bool)
    entry |= {**_counts(reckoned, verdict, every), "faces": faces}
    entry["area_share"] = _shares(reckoned, verdict, reason, every, reckoned.not_sampled)
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
        "diameter_mm": about(diameter, _WALL * diameter),
        "axis": about(axis, _WALL),
        "place_mm": about(on_axis.tolist(), _WALL * diameter),
    }


def _face(reckoned: Reckoned, verdict: NDArray[Any], reason: NDArray[Any], mine: NDArray[np.bool_]) -> dict[str, Any]:
    """The verdicts on a face whose samples are these (n,)."""
    area, inside = reckoned.sampled[mine], reckoned.question.samples["inside_bodies"]
    excluded = {"inside_share": inside, "exempt_share": reckoned.exempt, "drilled_share": reckoned.drilled}
    shares = {name: float(area[each[mine]].sum() / area.sum()) for name, each in excluded.items()}
    if not shares["drilled_share"]:
        del shares["drilled_share"]
    return {**_counts(reckoned, verdict, mine), "area_share": _shares(reckoned, verdict, reason, mine), **shares}


def _shares(
    reckoned: Reckoned, verdict: NDArray[Any], reason: NDArray[Any], mine: NDArray[np.bool_], missing: float = 0.0
) -> dict[str, Any]:
    """Shares of the area that samples (n,) stand for, by verdicts and by reasons; `missing`: that of faces without any, mm2."""
    area, words = reckoned.required.area, reckoned.question.document["reasons"]
    whole = max(float(area[mine].sum()) + missing, 1e-300)
    excluded = reckoned.question.samples["inside_bodies"] | reckoned.exempt | reckoned.drilled
    missed = mine & ~excluded & np.isin(verdict, NOT_REACHED)
    shares = {word: float(area[mine & (verdict == code)].sum()) / whole for word, code in WORDS.items()}
    shares["unjudged"] += missing / whole
    codes = [code for code in np.unique(reason[missed]).tolist() if code < len(words)]
    return {**shares, "lost_by": Exactly({words[c]: float(area[missed & (reason == c)].sum()) / whole for c in codes})}


def _chosen(document: Mapping[str, Any], entries: list[dict[str, Any]]) -> dict[str, Any]:
    """Which cutters must be named as those that finish; not where several setups hide the verdicts of the first one."""
    over = [each["id"] for each in entries if each.get("lost_in_all") == 0]
    named: dict[str, Any] = {"selected_over_setups": over[0] if over and not document["missing"] else None}
    feasible = [each["id"] for each in entries if each["feasible"]]
    named["selected"] = document["selected"] if document["selected"] in [None, *feasible[:1]] else "a cutter that finishes"
    stood = any(each["by_reason"].get("another_setup") for each in entries)
    if feasible and named["selected"] is None and not stood:
        named["selected"] = feasible[0]
    return named
