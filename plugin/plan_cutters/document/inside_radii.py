"""Faces that bend inwards more than a cutter become entries of the plan file here."""

import numpy as np
from numpy.typing import NDArray

from cad_io.face.curvature import curvature
from plan_cutters.domain.cutter import Cutter
from plan_cutters.domain.fillet import largest_fitting, least_radius
from plan_cutters.domain.verdicts import LOCAL_GOUGE, REAR_GOUGE, Verdicts
from plan_cutters.plan_file.inside_radii import InsideRadiusEntry
from plan_cutters.scene.preparation import Prepared


def inside_radius_entries(ready: Prepared, cutter: Cutter, verdicts: Verdicts) -> list[InsideRadiusEntry]:
    """List the faces on which gouging stops a cutter, and whose smallest inside radius is below its own; smallest first."""
    samples, radius = ready.samples, least_radius(cutter)
    gouged = verdicts.not_reached & np.isin(verdicts.reason, (LOCAL_GOUGE, REAR_GOUGE)) & ready.finished
    if radius is None or not gouged.any():
        return []
    entries = []
    for number, rows in samples.by_face().items():
        if not gouged[rows].any():
            continue
        smallest = _smallest_inside_radius(ready, number, rows)
        if smallest < radius * (1.0 - 1e-6):
            entries.append(
                InsideRadiusEntry(
                    face=f"F{number}",
                    radius_mm=smallest,
                    cutter_radius_mm=radius,
                    area_mm2=float(np.nansum(samples.area[rows[gouged[rows]]])),
                    fits_mm=largest_fitting(smallest, cutter.allowance or 0.0),
                )
            )
    return sorted(entries, key=lambda each: (each.radius_mm, each.face))


def _smallest_inside_radius(ready: Prepared, number: int, rows: NDArray[np.int64]) -> float:
    """Smallest inside radius of a face, mm, by the kernel's curvature at its samples and border; infinite where it has none."""
    part, most = ready.scene.part, ready.samples.curvature[rows, 0]
    trim = part.trim(number)
    if trim is not None:
        u, v = trim.segments[:, 0].T
        sign = float(ready.scene.orientation.sign[number - 1])
        border = curvature(part.surface(number).second(u.copy(), v.copy()), sign, float(np.linalg.norm(part.size)))
        most = np.concatenate([most, border.curvature[:, 0]])
    most = most[np.isfinite(most)]
    return 1.0 / float(most.max()) if len(most) and most.max() > 0.0 else float("inf")
