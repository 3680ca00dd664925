"""Entries of holes that are for drills, and of the steps that drill them."""

from collections.abc import Sequence

import numpy as np

from cad_io.part.holes import Hole
from plan_cutters.domain.drill import Drilled, time_of_hole
from plan_cutters.plan_file.frozen import vector
from plan_cutters.plan_file.holes import CounterboreEntry, CountersinkEntry, DrillingEntry, HoleEntry
from plan_cutters.scene.holes import groups
from plan_cutters.scene.preparation import Prepared

#: Decimals of lengths and angles: behind them there is noise alone.
_DIGITS = 6


def hole_entries(ready: Prepared, made: Sequence[Drilled | None]) -> list[HoleEntry]:
    """The holes for drills of a part, those of the first group first; `made`: what drills each of them."""
    rows = zip(ready.holes, groups(ready.holes), made, strict=True)
    return sorted((_entry(hole, group, by) for hole, group, by in rows), key=lambda each: each.group)


def drilling_entries(ready: Prepared, made: Sequence[Drilled | None]) -> list[DrillingEntry]:
    """The steps that drill holes, in the order of setups, and of tools by diameter."""
    options = ready.options
    entries_of = [entry for library in options.libraries for entry in library.entries if entry.drill is not None]
    feeds = {entry.drill.id: entry.feed for entry in reversed(entries_of) if entry.drill is not None and entry.feed is not None}
    steps: dict[tuple[int, str, int, bytes], list[tuple[Hole, Drilled]]] = {}
    for hole, group, by in zip(ready.holes, groups(ready.holes), made, strict=True):
        if by is not None:
            steps.setdefault((by.setup, by.drill.id, group, np.round(by.axis, _DIGITS).tobytes()), []).append((hole, by))
    entries = []
    for (setup, tool, group, _), each in steps.items():
        hole, by = each[0]
        deep, feed = by.drill.depth_in(hole.depth, through=hole.through), feeds.get(tool, options.feed)
        entries.append(
            DrillingEntry(
                tool=tool, name=by.drill.body.name, group=group, holes=len(each), setup=setup, axis=vector(by.axis + 0.0),
                angles_deg=_angles(ready, setup, by.axis), depth_mm=round(deep, _DIGITS),
                seconds=None if feed is None else len(each) * (time_of_hole(deep, feed) + options.link_time),
            )
        )  # fmt: skip
    diameter = {by.drill.id: by.drill.diameter for by in made if by is not None}
    return sorted(entries, key=lambda step: (step.setup, diameter[step.tool], step.tool, step.group))


def _angles(ready: Prepared, setup: int, axis: np.ndarray) -> dict[str, float] | None:
    """Angles of the rotary axes that hold a tool axis, deg; None where no axes are known."""
    kinematics = ready.setups[setup].kinematics
    if kinematics is None:
        return None
    both, taken, _ = kinematics.positions(axis[None])
    angles = np.round(np.degrees(both[0, int(taken[0])]), 3) + 0.0
    return dict(zip((each.name for each in ready.options.machine.rotary or ()), angles.tolist(), strict=True))


def _entry(hole: Hole, group: int, by: Drilled | None) -> HoleEntry:
    sink, bore = hole.countersink, hole.counterbore
    return HoleEntry(
        faces=[f"F{number}" for number in hole.faces],
        diameter_mm=round(hole.diameter, _DIGITS),
        depth_mm=round(hole.depth, _DIGITS),
        through=hole.through,
        bottom=hole.bottom,
        cone_deg=None if hole.cone is None else _degrees(hole.cone),
        countersink=None if sink is None else CountersinkEntry(diameter_mm=round(sink[0], _DIGITS), angle_deg=_degrees(sink[1])),
        counterbore=None if bore is None else CounterboreEntry(**dict(zip(_BORE, np.round(bore, _DIGITS).tolist(), strict=True))),
        axis=vector(hole.axis + 0.0),
        place_mm=vector(np.round(hole.place, _DIGITS) + 0.0),
        group=group,
        drilled=by is not None,
        tool=None if by is None else by.drill.id,
    )


_BORE = ("diameter_mm", "depth_mm")


def _degrees(angle: float) -> float:
    return round(float(np.degrees(angle)), _DIGITS)
