"""Steps that drill holes: what they must say, and whether their tools stand free where they cut.

A tool for holes is put down as wide as the hole that it leaves, from above its point up; one that cuts with a cone as this.
"""

import math
import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from cad_io.arrays import Floats, SizeNote
from plan_cutters_check.bench import Bench
from plan_cutters_check.control import orientation
from plan_cutters_check.findings import Between, Finding, about
from plan_cutters_check.question import FREE, DrillSizes, Question, allowed, degrees_of, held
from plan_cutters_check.surface import FREE as STANDS_FREE
from plan_cutters_check.surface import MET, OPEN, Clock, met
from plan_cutters_check.tool import Tool, tool_of

_INCH = 25.4
#: Tools that cut with a cone; the way of a tool at its feed in depths of the hole.
_CONES, _WAY = ("centre drill", "countersink"), 1.3
#: How much wider or narrower than its hole a tool may be, mm, and as a share; by how much the angle of its cone may be off, deg.
_WIDE, _SHARE, _POINT, _SINK = 0.05, 0.01, 3.0, 1.0
#: What a reamer takes off: at least, mm, and at most besides as a share of its diameter.
_ALLOWANCE, _MORE = 0.1, 0.03
#: How much narrower than its thread the drill before a tap is, in pitches; how far a tap may go through a hole; and by how much
#: its diameter and pitch may be off, as a share of the pitch, and mm.
_CORE, _LEAD, _THREAD, _TAP = (0.75, 1.15), 3.0, 0.02, 0.02
#: Lengths that are rounded when they are written, mm; parts of unit axes.
_ROUNDED, _AXIS = 2e-5, 1e-5
#: A tool that goes on by so much, mm, or so many tolerances, is too deep where it reaches a bottom.
_ON, _TIMES = 0.05, 4.0


def entries(question: Question) -> list[Any]:
    """Reckon `process.drilling`, as far as it follows from the libraries, the holes and the command."""
    document = question.document
    written: Sequence[Mapping[str, Any]] = document["process"].get("drilling", [])
    steps = list[Any]()
    for step in written:
        drill = question.drills.get(step["tool"])
        if drill is None:
            steps.append("a step with a tool of the libraries")
            continue
        deep = float(step["depth_mm"])
        feed = document["effective"]["feed_mm_min"] if drill.feed is None else drill.feed
        first_way = np.array(step["holes"][0]["mouth_mm"], float) - np.array(step["holes"][0]["tip_mm"], float)
        tip = (np.array([each["mouth_mm"] for each in step["holes"]]) - (deep + drill.beyond) * np.array(step["axis"])).tolist()
        steps.append({
            "kind": drill.kind, "tool": drill.sizes.id, "name": drill.name, "setup": step["setup"],
            "holes": [
                {"hole": each["hole"], "mouth_mm": about(_on_axis(document, each), _ROUNDED),
                 "tip_mm": about(point, _ROUNDED)}
                for each, point in zip(step["holes"], tip, strict=True)
            ],
            **_turned(question, step), "diameter_mm": _diameter(drill, step["diameter_mm"]),
            "depth_mm": about(float(np.linalg.norm(first_way)) - drill.beyond, _ROUNDED),
            **({} if drill.pitch is None else {"pitch_mm": drill.pitch}), **_threaded(document, drill, step),
            **({} if feed is None else {"feed_mm_min": feed}),
            "seconds": None if feed is None
            else len(step["holes"]) * _WAY * deep / feed * 60.0 * (2.0 if drill.kind == "tap" else 1.0),
        })  # fmt: skip
    return steps


def _threaded(document: Mapping[str, Any], drill: DrillSizes, step: Mapping[str, Any]) -> dict[str, str]:
    """The thread that a tap cuts, as the holes of its step have it."""
    names = {(document["holes"][each["hole"]].get("thread") or {"name": ""})["name"] for each in step["holes"]}
    return {"thread": names.pop() if len(names) == 1 else "one thread"} if drill.kind == "tap" else {}


def _on_axis(document: Mapping[str, Any], stroke: Mapping[str, Any]) -> list[float]:
    """Where the mouth of a stroke would be on the axis of its hole."""
    hole = document["holes"][stroke["hole"]]
    place, axis, mouth = (np.array(each, float) for each in (hole["place_mm"], hole["axis"], stroke["mouth_mm"]))
    on: list[float] = (place + ((mouth - place) @ axis) * axis).tolist()
    return on


def _diameter(drill: DrillSizes, wide: float) -> Any:
    """The diameter that a tool leaves: its own, of a cone any that is no wider."""
    own = 2.0 * drill.sizes.radius
    off = max(_WIDE, _SHARE * wide)
    return Between(0.0, own + off) if drill.kind in _CONES else about(own, off)


def _turned(question: Question, step: Mapping[str, Any]) -> dict[str, Any]:
    """The axis of the angles of a step; where it has none, one that the machine holds."""
    machine, setup = question.machine, question.setups[step["setup"]]
    if step["angles_deg"] is None:
        able = bool(held(machine, setup, np.array([step["axis"]], float))[0])
        return {"angles_deg": None, "axis": step["axis"] if able and machine.names == FREE else "an axis that the machine holds"}
    degrees = degrees_of(question, step)
    if not allowed(machine, setup, degrees)[0]:
        return {"angles_deg": "angles within the limits"}
    made = orientation(question, step, _AXIS)
    del made["other_angles_deg"]
    # What the machine has no word for is not written.
    return {name: value for name, value in made.items() if value is not None or step.get(name) is not None}


def changes(uses: Iterable[tuple[int, str]]) -> int:
    """Count the tools that are put in for uses, each a setup and a tool, after the first, setup by setup."""
    count, there = 0, None
    for _, tool in sorted(uses, key=lambda each: each[0]):
        count += there not in (None, tool)
        there = tool
    return count


def hole(question: Question, number: int) -> dict[str, Any]:
    """Reckon which tool `holes` must name for one, by the steps that drill it; its thread and tolerance, by the part's file."""
    document = question.document
    written, tools = document["holes"][number], list[str]()
    for step in document["process"].get("drilling", []):
        alike = abs(step["diameter_mm"] - written["diameter_mm"]) <= _ROUNDED or _is_core(written, step["diameter_mm"])
        through = alike and step["kind"] in ("drill", "reamer")
        tools += [step["tool"]] if through and any(each["hole"] == number for each in step["holes"]) else []
    return {"tool": tools[-1] if tools else None, "drilled": bool(tools), **_stated(question.part.sizes, written)}


def _stated(sizes: Sequence[SizeNote], written: Mapping[str, Any]) -> dict[str, Any]:
    """What the part's file states on the faces of a hole; whether a note is left out is not looked at."""
    mine, result = [each for each in sizes if {f"F{n}" for n in each.faces}.intersection(written["faces"])], dict[str, Any]()
    if (tolerance := written.get("tolerance")) is not None:
        rows = [(each.nominal, each.lower, each.upper, each.fit) for each in mine]
        known = tuple(tolerance[name] for name in ("nominal_mm", "lower_mm", "upper_mm", "fit")) in rows
        result["tolerance"] = tolerance if known else "a tolerance that the part's file states"
    if (thread := written.get("thread")) is not None:
        notes = [re.sub(r"[\s#]", "", note).replace(",", ".") for each in mine for note in each.notes]
        name, turns = re.sub(r"[\s#]", "", thread["name"]), re.search(r"-(\d+)\s*UN", thread["name"])
        metric, pitch = re.match(r"M([\d.]+)(?:x([\d.]+))?", thread["name"]), thread["pitch_mm"]
        if turns is not None:
            known = abs(_INCH / int(turns[1]) - pitch) <= _ROUNDED
        else:
            known = metric is not None and (float(metric[1]), float(metric[2] or pitch)) == (thread["diameter_mm"], pitch)
        known = known and any(name in note and thread["fit"] in note and ("LH" in note) == thread["left"] for note in notes)
        result["thread"] = thread if known else "a thread that the part's file states"
    return result


def _is_core(of: Mapping[str, Any], wide: float) -> bool:
    """Whether a hole is tapped behind a drill of a diameter, mm."""
    thread = of.get("thread")
    return thread is not None and _CORE[0] <= (thread["diameter_mm"] - wide) / thread["pitch_mm"] <= _CORE[1]


@dataclass(frozen=True)
class _Stroke:
    """A tool at the end of its way in a hole: how it is called, its setup, tip, axis, and how it must end."""

    words: str
    setup: int
    tool: Tool
    tip: Floats
    axis: Floats
    ends: bool


def findings(question: Question, bench: Bench, clock: Clock) -> Iterator[Finding]:
    """Put down the tools of all steps that drill, and look whether holes come out as they are."""
    document = question.document
    steps = document["process"].get("drilling", [])
    if not steps:
        return
    wrong, strokes = [*_sizes(question)], [each for step in steps for each in _strokes(question, step)]
    undecided = 0
    for stroke in strokes:
        free = _stands(bench, stroke, 0.0, clock)
        undecided += free == OPEN
        if free == MET:
            wrong.append(f"{stroke.words} does not stand free")
        elif stroke.ends and _stands(bench, stroke, max(_ON, _TIMES * question.tolerance), clock) == STANDS_FREE:
            wrong.append(f"{stroke.words} does not reach the bottom")
    text = f": {'; '.join(wrong[:3])}" if wrong else ""
    words = f"{len(strokes)} tools were put down in holes, from {len(steps)} steps that drill; {len(wrong)} are wrong{text}."
    yield Finding(False if wrong else None if undecided else True, words)


def _stands(bench: Bench, stroke: _Stroke, deeper: float, clock: Clock) -> int:
    tip, tool = (stroke.tip - deeper * stroke.axis)[None], stroke.tool
    limits = bench.question.tolerance, -tool.clearance
    verdict = int(met(bench.cells, bench.root[stroke.setup], tool, tip, stroke.axis[None], limits, bench.grain, clock).verdict[0])
    within = any(each.holds(tip + tool.high * stroke.axis)[0] for each in bench.standing[stroke.setup])
    return MET if within else verdict


def _strokes(question: Question, step: Mapping[str, Any]) -> Iterator[_Stroke]:
    drill, axis = question.drills[step["tool"]], np.array(step["axis"], float)
    angle = None
    for each in step["holes"]:
        of = question.document["holes"][each["hole"]]
        if drill.kind == "countersink":
            angle = min((two for _, two in _cones(question, of)), key=lambda two: abs(two - drill.angle), default=None)
        # A tap, and the drill before it, are no wider than the model has the hole.
        wide = min(step["diameter_mm"], of["diameter_mm"]) if of.get("thread") else step["diameter_mm"]
        tool = _body(drill, wide, drill.angle if angle is None else angle)
        words = f"{drill.kind} D{step['diameter_mm']:.4g} in hole {each['hole'] + 1}"
        if tool is None:
            continue
        core = abs(step["diameter_mm"] - of["diameter_mm"]) <= _ROUNDED or _is_core(of, step["diameter_mm"])
        main = drill.kind == "reamer" or (drill.kind == "drill" and core)
        ends = drill.kind in ("countersink", "counterbore") or (main and of["bottom"] == "cone")
        up = 0.0 if drill.kind in _CONES else drill.beyond
        yield _Stroke(words, step["setup"], tool, np.array(each["tip_mm"], float) + up * axis, axis, ends)


def _body(drill: DrillSizes, diameter: float, angle: float) -> Tool | None:
    """A tool above its point, as wide as what it leaves; one that cuts with a cone as this. None: its flutes are too short."""
    sizes, radius = drill.sizes, drill.sizes.radius
    if drill.kind in _CONES:
        high = radius / math.tan(0.5 * angle)
        if high > sizes.flutes + 1e-6:
            return None
        outline = [(0.0, 0.0), (radius, high), *([(radius, sizes.flutes)] if sizes.flutes > high + 1e-6 else [])]
        return tool_of(replace(sizes, shape="form", outline=tuple(outline), corner_radius=0.0))
    off = drill.beyond
    sections = tuple(replace(each, low=each.low - off) for each in sizes.sections)
    return tool_of(replace(sizes, radius=0.5 * diameter, flutes=sizes.flutes - off, sections=sections))


def _sizes(question: Question) -> Iterator[str]:
    """What is wrong with diameters, depths, points and flutes of steps."""
    document = question.document
    for step in document["process"]["drilling"]:
        drill, wide, deep = question.drills[step["tool"]], step["diameter_mm"], step["depth_mm"]
        for each in step["holes"]:
            of = document["holes"][each["hole"]]
            words = f"{drill.kind} D{wide:.4g} in hole {each['hole'] + 1}"
            along = float(np.dot(step["axis"], of["axis"]))
            if abs(abs(along) - 1.0) > _AXIS:
                yield f"{words} is not along its axis"
            if drill.kind not in (*_CONES, "tap") and deep > drill.sizes.flutes - drill.beyond + _ROUNDED:
                yield f"{words} has flutes that are too short"
            yield from (f"{words} {fault}" for fault in _faults(question, drill, step, of, along))


def _faults(
    question: Question, drill: DrillSizes, step: Mapping[str, Any], of: Mapping[str, Any], along: float
) -> Iterator[str]:  # fmt: skip
    """What is wrong with a tool for a hole; `along`: 1 from its mouth, -1 from the far end."""
    wide, deep, bottom, core = step["diameter_mm"], step["depth_mm"], of["bottom"], _is_core(of, step["diameter_mm"])
    if drill.kind == "tap":
        yield from _unfit(question, drill, step, of)
    elif drill.kind in ("drill", "reamer") and (wide <= of["diameter_mm"] + _ROUNDED or core):
        main = abs(wide - of["diameter_mm"]) <= _ROUNDED or core
        if of.get("thread") and not core:
            yield "leaves another hole than its tap needs"
        off = of["diameter_mm"] - wide
        if not main and not _ALLOWANCE - _ROUNDED <= off <= _ALLOWANCE + _MORE * of["diameter_mm"] + max(_WIDE, _SHARE * wide):
            yield "is no drill before a reamer"
        if along < 0.0 and not of["through"]:
            yield "comes from its bottom"
        floor = drill.beyond if bottom in ("flat", "round") else 0.0
        if deep + floor < of["depth_mm"] - _ROUNDED:
            yield "is not as deep"
        if bottom == "cone" and drill.kind == "drill" and abs(math.degrees(drill.angle) - (of["cone_deg"] or 0.0)) > _POINT:
            yield "has another point"
        if bottom in ("flat", "round") and deep + drill.beyond > of["depth_mm"] + _ROUNDED:
            yield "cuts into its bottom"
    elif drill.kind in ("counterbore", "drill"):
        if not any(abs(2.0 * radius - wide) <= _ROUNDED for radius in _cylinders(question, of)):
            yield "has no cylinder of its diameter"
    elif drill.kind == "countersink" and not any(
        abs(math.degrees(two - drill.angle)) <= _SINK for _, two in _cones(question, of)
    ):
        yield "has no cone of its angle"


def _unfit(question: Question, drill: DrillSizes, step: Mapping[str, Any], of: Mapping[str, Any]) -> Iterator[str]:
    """What is wrong with a tap for a hole."""
    thread, deep = of.get("thread"), step["depth_mm"]
    if thread is None:
        yield "has no thread"
        return
    pitch = thread["pitch_mm"]
    off = abs(2.0 * drill.sizes.radius - thread["diameter_mm"]) > _TAP + _THREAD * pitch
    if off or drill.pitch is None or abs(drill.pitch - pitch) > _THREAD * pitch or drill.left != thread["left"]:
        yield "cuts another thread"
    if deep > of["depth_mm"] + of["through"] * _LEAD * pitch + _ROUNDED:
        yield "goes too deep"
    # Where the thread alone is as wide, it ends there.
    wider = any(2.0 * radius > of["diameter_mm"] + _ROUNDED for radius in _cylinders(question, of))
    if deep < of["depth_mm"] - _ROUNDED and not wider:
        yield "is not as deep"


def _cylinders(question: Question, of: Mapping[str, Any]) -> list[float]:
    """Radii of the cylinders of a hole."""
    carriers = [question.part.faces[int(name[1:]) - 1].carrier for name in of["faces"]]
    return [each.radius for each in carriers if each and each.radius and each.half_angle is None and each.direction is not None]


def _cones(question: Question, of: Mapping[str, Any]) -> list[tuple[str, float]]:
    """Names and whole angles, rad, of the cones of a hole."""
    carriers = [(name, question.part.faces[int(name[1:]) - 1].carrier) for name in of["faces"]]
    return [(name, 2.0 * abs(each.half_angle)) for name, each in carriers if each and each.half_angle is not None]
