"""Where the part stands, and the linear travel that a cutter needs there, as the plan file has them."""

import numpy as np

from cad_io import SurfaceSamples
from plan_cutters.domain.machine import Machine
from plan_cutters.domain.placement import Placement
from plan_cutters.domain.travel import Travel
from plan_cutters.domain.verdicts import Verdicts
from plan_cutters.plan_file.frozen import vector
from plan_cutters.plan_file.model import LinearEntry
from plan_cutters.plan_file.travel import AxisTravel, BeyondTravel, PlacementEntry, TravelEntry
from plan_cutters.scene.preparation import Prepared


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
