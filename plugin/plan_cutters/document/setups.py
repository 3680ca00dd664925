"""Entries on setups: the verdicts over all of them, how much is reached in each, and where the part stands."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from cad_io.arrays import Ints, SurfaceSamples
from plan_cutters.domain.machine import Machine
from plan_cutters.domain.placement import Placement
from plan_cutters.domain.travel import Travel
from plan_cutters.domain.verdicts import Verdicts
from plan_cutters.judging.limits import AXES, within_limits
from plan_cutters.plan_file.frozen import Vector, vector
from plan_cutters.plan_file.model import LinearEntry
from plan_cutters.plan_file.setups import AxisTravel, BeyondTravel, PlacementEntry, SetupEntry, TravelEntry
from plan_cutters.scene.preparation import Prepared

#: A setup axis, and what each cutter reaches there by its id.
OtherSetup = tuple[Vector, Mapping[str, Verdicts]]


@dataclass(frozen=True, slots=True)
class OverSetups:
    """The verdicts of each cutter over all setups and in each of them, by its id."""

    #: In one setup or another.
    reaches: dict[str, Verdicts]
    #: In the first one.
    here: dict[str, Verdicts]
    #: The setup that serves each sample, (n,) int32.
    served_in: dict[str, Ints]
    #: (float, float, float); its axis.
    first: Vector
    #: In each other setup.
    elsewhere: tuple[tuple[Vector, dict[str, Verdicts]], ...] = ()

    def each(self) -> tuple[OtherSetup, ...]:
        """Every setup with what is reached there, the first one first."""
        return ((self.first, self.here), *self.elsewhere)


def setup_table(ready: Prepared, within: Sequence[NDArray[np.bool_]], over: OverSetups) -> list[SetupEntry]:
    """Tell how much is within the axis limits and is reached in each setup asked for, `within` (n,) each, and how much would be
    within them in each along the part's own axes.
    """
    if not ready.conditions.machine.limited:
        return []
    finished = ready.finished
    whole = float(ready.samples.area[finished].sum())

    def share(mine: NDArray[np.bool_]) -> float:
        return min(1.0, float(ready.samples.area[mine].sum()) / whole) if whole > 0.0 else 0.0

    entries: dict[Vector, SetupEntry] = {}
    for k, (axis, each) in enumerate(over.each()):
        mine = finished & np.logical_or.reduce([verdicts.reached for verdicts in each.values()])
        entries.setdefault(
            axis,
            SetupEntry(
                axis=axis, within=int(within[k].sum()), share=share(within[k]), reached=int(mine.sum()), reached_share=share(mine)
            ),
        )
    for axis in AXES:
        if axis not in entries:
            mine = finished & within_limits(ready.samples, ready.cutters, ready.conditions, axis)
            entries[axis] = SetupEntry(axis=axis, within=int(mine.sum()), share=share(mine))
    return list(entries.values())


def placement_entry(placement: Placement | None) -> PlacementEntry | None:
    """How a part stands."""
    if placement is None:
        return None
    file = None if placement.proposed else placement.file or None
    return PlacementEntry(file=file, x=placement.x, origin_mm=placement.origin, clamped=list(placement.clamped))


def linear_entries(ready: Prepared) -> list[LinearEntry]:
    """The linear axes of the machine in the part's frame of the first setup, and how far the target samples reach along each."""
    entries = []
    for axis in ready.options.machine.linear:
        direction = np.array(axis.direction) @ ready.conditions.frame
        along = ready.samples.point[ready.finished] @ direction
        low, high = axis.limits or (-np.inf, np.inf)
        entries.append(
            LinearEntry(
                name=axis.name,
                carries=axis.carries,
                direction=vector(direction),
                limits_mm=(float(low) if np.isfinite(low) else None, float(high) if np.isfinite(high) else None),
                extent_mm=float(np.ptp(along)) if len(along) else 0.0,
            )
        )
    return entries


def travel_entry(machine: Machine, travel: Travel, reach: Verdicts, samples: SurfaceSamples) -> TravelEntry:
    """Give the travel of the linear axes that a cutter needs."""
    known = reach.reached & np.isfinite(travel.position).all(axis=1)
    axes, worst = [], []
    for k, axis in enumerate(machine.linear):
        position, beyond = travel.position[known, k], np.where(known, travel.beyond[:, k], 0.0)
        low, high = (end if np.isfinite(end) else None for end in axis.limits or (np.inf, np.inf))
        least, most = (float(position.min()), float(position.max())) if len(position) else (None, None)
        axes.append(
            AxisTravel(name=axis.name, limits_mm=(low, high), least_mm=least, most_mm=most, outside=int((beyond > 0.0).sum()))
        )
        if len(beyond) and beyond.max() > 0.0:
            at = int(beyond.argmax())
            worst.append(
                BeyondTravel(
                    point=vector(samples.point[at]), face=f"F{samples.face[at]}", axis=axis.name, beyond_mm=float(beyond[at])
                )
            )
    return TravelEntry(
        judged=int(known.sum()),
        unknown=int((reach.reached & ~known).sum()),
        outside=int((travel.outside & known).sum()),
        axes=axes,
        worst=sorted(worst, key=lambda each: -each.beyond_mm),
    )
