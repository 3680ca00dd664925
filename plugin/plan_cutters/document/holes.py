"""Entries of holes that are for drills."""

import numpy as np

from cad_io.part.holes import Hole
from plan_cutters.plan_file.frozen import vector
from plan_cutters.plan_file.holes import CounterboreEntry, CountersinkEntry, HoleEntry
from plan_cutters.scene.holes import groups
from plan_cutters.scene.preparation import Prepared


def hole_entries(ready: Prepared) -> list[HoleEntry]:
    """The holes for drills of a part, those of the first group first."""
    entries = [_entry(hole, group) for hole, group in zip(ready.holes, groups(ready.holes), strict=True)]
    return sorted(entries, key=lambda each: each.group)


#: Decimals of lengths and angles: behind them there is noise alone.
_DIGITS = 6


def _entry(hole: Hole, group: int) -> HoleEntry:
    sink, bore = hole.countersink, hole.counterbore
    return HoleEntry(
        faces=[f"F{number}" for number in hole.faces],
        diameter_mm=round(hole.diameter, _DIGITS),
        depth_mm=round(hole.depth, _DIGITS),
        through=hole.through,
        bottom=hole.bottom,
        cone_deg=None if hole.cone is None else _degrees(hole.cone),
        countersink=None if sink is None else CountersinkEntry(diameter_mm=round(sink[0], _DIGITS), angle_deg=_degrees(sink[1])),
        counterbore=None
        if bore is None
        else CounterboreEntry(diameter_mm=round(bore[0], _DIGITS), depth_mm=round(bore[1], _DIGITS)),
        axis=vector(hole.axis),
        place_mm=vector(hole.place),
        group=group,
        drilled=False,
        tool=None,
    )


def _degrees(angle: float) -> float:
    return round(float(np.degrees(angle)), _DIGITS)
