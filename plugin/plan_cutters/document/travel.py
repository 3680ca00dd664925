"""Where the part stands, and the linear travel that a cutter needs there, as the plan file has them."""

import numpy as np

from cad_io import SurfaceSamples
from plan_cutters.domain.machine import Machine
from plan_cutters.domain.placement import Placement
from plan_cutters.domain.travel import Travel
from plan_cutters.domain.verdicts import Verdicts
from plan_cutters.plan_file.frozen import vector
from plan_cutters.plan_file.travel import AxisTravel, BeyondTravel, PlacementEntry, TravelEntry


def placement_entry(placement: Placement | None) -> PlacementEntry | None:
    """How a part stands."""
    if placement is None:
        return None
    return PlacementEntry(file=placement.file or None, x=placement.x, origin_mm=placement.origin, clamped=list(placement.clamped))


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
