"""Entries of holes that are for drills, and of the steps of the process that drill them."""

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from cad_io.arrays import Floats
from cad_io.part.holes import Hole
from plan_cutters.domain.drill import Bored, Drilled, Kind, Missing, time_of_hole
from plan_cutters.domain.operations import INDEX_TIME, tool_changes
from plan_cutters.domain.thread import thread_in, tolerance_in
from plan_cutters.plan_file import holes as schema
from plan_cutters.plan_file.frozen import filled, vector
from plan_cutters.plan_file.operations import ProcessEntry
from plan_cutters.scene.fixed_axis import tilted_plane
from plan_cutters.scene.holes import groups, slope_of
from plan_cutters.scene.preparation import Prepared, places
from plan_cutters.setups.workpiece import PartMesh

#: Decimals of lengths and angles: behind them there is noise alone.
_DIGITS = 6
#: Angles that differ by less are one, deg.
_SAME = 0.01
#: A drill wanders where what it enters is steeper than this, deg.
_STEEP = 7.0
#: Times, s, in which rotary axes come to each of some positions: solutions of each (s, k), limits (k, 2), rates (k,), in rad.
IndexTimes = Callable[[Sequence[Floats], Floats, Floats], Floats]
#: Tools in the order in which they come in a setup.
_IN_TURN: tuple[Kind, ...] = ("centre drill", "drill", "reamer", "counterbore", "countersink", "tap")


def hole_entries(ready: Prepared, made: Sequence[Bored]) -> list[schema.HoleEntry]:
    """The holes for drills of a part, those of the first group first; `made`: by what tools."""
    number = groups(ready.holes)
    return [_entry(ready.holes[k], number[k], made[k]) for k in np.argsort(number, kind="stable").tolist()]


def with_drilling(process: ProcessEntry, ready: Prepared, made: Sequence[Bored], index_times: IndexTimes) -> ProcessEntry:
    """The process with the steps that drill holes, and their seconds in its own where these are known."""
    drilling = _steps(ready, made, index_times, timed=process.seconds is not None)
    if not drilling:
        return process
    options, seconds = ready.options, [step.seconds for step in drilling]
    if process.seconds is None or None in seconds:
        names = ("seconds", "cutting_seconds", "link_seconds", "index_seconds", "change_seconds", "setup_seconds")
        return process.model_copy(update={"drilling": drilling, **dict.fromkeys(names)})
    uses = [*((s.setup, s.cutter) for s in process.steps if s.operation), *((s.setup, s.tool) for s in drilling)]
    setups = len({*(step.setup for step in drilling), *(step.setup for step in process.steps)})
    times: dict[str, Any] = {
        "cutting_seconds": (process.cutting_seconds or 0.0) + sum(each or 0.0 for each in seconds),
        "link_seconds": (process.link_seconds or 0.0) + sum(step.link_seconds for step in drilling),
        "index_seconds": (process.index_seconds or 0.0) + sum(step.index_seconds for step in drilling),
        "change_seconds": options.change_time * tool_changes(uses),
        "setup_seconds": options.setup_time * (setups - 1),
    }  # fmt: skip
    return process.model_copy(update={"drilling": drilling, "seconds": sum(times.values()), **times})


def _steps(ready: Prepared, made: Sequence[Bored], index_times: IndexTimes, *, timed: bool) -> list[schema.DrillingStep]:
    """The steps that drill holes: by setup, kind and diameter; those of one tool follow each other."""
    options, in_order = ready.options, np.argsort(groups(ready.holes), kind="stable").tolist()
    entries_of = [entry for library in options.libraries for entry in library.entries if entry.drill is not None]
    feeds = {entry.drill.id: entry.feed for entry in reversed(entries_of) if entry.drill is not None and entry.feed is not None}
    same: dict[tuple[Any, ...], list[tuple[int, Drilled]]] = {}
    for place, k in enumerate(in_order):
        for use in made[k].uses:
            size = round(use.diameter, _DIGITS), round(use.depth, _DIGITS)
            key = use.setup, _IN_TURN.index(use.drill.kind), use.drill.diameter, use.drill.id, _rounded(use.axis), size
            same.setdefault(key, []).append((place, use))
    threads = [thread_in(hole.sizes, hole.diameter) for hole in ready.holes]
    surroundings = ready.conditions.surroundings
    mesh = ready.scene.mesh((surroundings.alone or surroundings).certain.triangles)
    steps, turned = list[schema.DrillingStep](), dict[tuple[int, str], list[tuple[float, ...]]]()
    for key in sorted(same):
        use, feed = same[key][0][1], feeds.get(same[key][0][1].drill.id, options.feed)
        axis, deep = _rounded(use.axis), round(use.depth, _DIGITS)
        thread = threads[in_order[same[key][0][0]]] if use.drill.kind == "tap" else None
        begins = axis not in (before := turned.setdefault((use.setup, use.drill.id), []))
        before += [axis] * begins
        strokes = [
            schema.StrokeEntry(
                hole=k, mouth_mm=_rounded(each.mouth), tip_mm=_rounded(each.tip),
                slope_deg=_slope(mesh, ready.holes[in_order[k]], each.axis) if each is made[in_order[k]].uses[0] else None,
            ) for k, each in same[key]
        ]  # fmt: skip
        steps.append(
            schema.DrillingStep(
                kind=use.drill.kind, tool=use.drill.id, name=use.drill.body.name,
                holes=strokes,
                setup=use.setup, axis=vector(use.axis + 0.0), **_turned(ready, use.setup, use.axis),
                diameter_mm=round(use.diameter, _DIGITS), depth_mm=deep,
                thread="" if thread is None else thread.name, pitch_mm=use.drill.pitch,
                feed_mm_min=feed, seconds=None if feed is None else len(same[key]) * time_of_hole(deep, feed, use.drill.kind),
                link_seconds=len(same[key]) * options.link_time, index_seconds=1.0 if begins and timed else 0.0,
            )
        )  # fmt: skip
    together: dict[tuple[int, str], list[schema.DrillingStep]] = {}
    for step in steps:
        together.setdefault((step.setup, step.tool), []).append(step)
    return [step for group in together.values() for step in _indexed(ready, group, index_times)]


def _slope(mesh: PartMesh, hole: Hole, axis: Floats) -> float | None:
    steepness = _degrees(slope_of(mesh, hole, axis))
    return steepness if steepness > _STEEP else None


def _indexed(ready: Prepared, steps: Sequence[schema.DrillingStep], index_times: IndexTimes) -> list[schema.DrillingStep]:
    """The steps of one tool in one setup with the seconds of turns: as those of mills they begin with the axes at zero."""
    kinematics, options = ready.setups[steps[0].setup].kinematics, ready.options
    turns = [k for k, step in enumerate(steps) if step.index_seconds]
    rates = [axis.rate for axis in options.machine.rotary or ()]
    times = np.full(len(turns), INDEX_TIME if options.index_time is None else options.index_time)
    if kinematics is not None and all(rates) and options.index_time is None:
        both = [kinematics.positions(np.array([steps[k].axis]))[0][0] for k in turns]
        known = [each[np.isfinite(each).all(axis=1)] for each in both]
        times = index_times(known, kinematics.limit, np.array(rates, float)) if rates else np.zeros(len(turns))
    seconds = dict(zip(turns, times.tolist(), strict=True))
    return [step.model_copy(update={"index_seconds": seconds.get(k, 0.0)}) for k, step in enumerate(steps)]


def _rounded(point: Floats) -> tuple[float, float, float]:
    return vector(np.round(point, _DIGITS) + 0.0)


def _turned(ready: Prepared, setup: int, axis: Floats) -> dict[str, Any]:
    """Angles of the rotary axes that hold a tool axis, deg, with the plane and its words; None where no axes are known."""
    conditions = ready.setups[setup]
    if conditions.kinematics is None:
        return {"angles_deg": None}
    both, taken, _ = conditions.kinematics.positions(axis[None])
    names, shown = [each.name for each in ready.options.machine.rotary or ()], np.round(np.degrees(both[0]), 3) + 0.0
    own, other = (dict(zip(names, shown[k].tolist(), strict=True)) for k in (int(taken[0]), 1 - int(taken[0])))
    # Another solution is one that differs on the machine.
    apart = np.abs(np.remainder(np.subtract([*other.values()], [*own.values()]) + 180.0, 360.0) - 180.0)
    second = other if apart.max(initial=0.0) > _SAME else None
    place, angle = places(ready.options)[setup], both[0, int(taken[0])]
    origin, x, words = tilted_plane(conditions, place, conditions.kinematics, axis, angle, own, second)
    frame = schema.WorkplaneEntry(origin=vector(origin), x=vector(x), z=vector(axis))
    return {"angles_deg": own, "frame": frame, "g68_2": words.g68_2, "g53_1": words.g53_1, "rotary_words": words.rotary}


def _entry(hole: Hole, group: int, made: Bored) -> schema.HoleEntry:
    by, sink, bore = made.by, hole.countersink, hole.counterbore
    thread, tolerance = thread_in(hole.sizes, hole.diameter), tolerance_in(hole.sizes, hole.diameter)
    missing = [
        filled(schema.MissingEntry, each, **_size(each), angle_deg=each.angle and _degrees(each.angle)) for each in made.missing
    ]
    return filled(
        schema.HoleEntry, hole, faces=[f"F{number}" for number in hole.faces], **_size(hole),
        floor=[f"F{number}" for number in hole.floor if number not in hole.faces],
        cone_deg=hole.cone and _degrees(hole.cone), axis=vector(hole.axis + 0.0), place_mm=_rounded(hole.place), group=group,
        countersink=sink and schema.CountersinkEntry(diameter_mm=round(sink[0], _DIGITS), angle_deg=_degrees(sink[1])),
        counterbore=bore and schema.CounterboreEntry(diameter_mm=round(bore[0], _DIGITS), depth_mm=round(bore[1], _DIGITS)),
        drilled=by is not None, tool=None if by is None else by.id, missing=missing,
        thread=thread and filled(schema.ThreadEntry, thread), tolerance=tolerance and filled(schema.ToleranceEntry, tolerance),
    )  # fmt: skip


def _size(of: Hole | Missing) -> dict[str, float | None]:
    return {"diameter_mm": round(of.diameter, _DIGITS), "depth_mm": None if of.depth is None else round(of.depth, _DIGITS)}


def _degrees(angle: float) -> float:
    return round(float(np.degrees(angle)), _DIGITS)
