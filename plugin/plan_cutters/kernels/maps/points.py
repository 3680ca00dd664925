"""The closed forms at one rotation, for callers that are not compiled."""

import numpy as np

from cad_io.arrays import Floats
from plan_cutters.kernels.limits import held_tilts
from plan_cutters.kernels.rows import Ranges
from plan_cutters.kernels.tool.arcs import local_gouge


def local_gouge_range(kappa_max: float, kappa_min: float, rotation: float, offset: float, radius: float) -> tuple[float, float]:
    """Least and largest tilt without local gouging, rad; nan if there is none. Curvatures 1/mm; the others as in
    `arcs.local_gouge`.
    """
    least, most = local_gouge(kappa_max, kappa_min, np.cos(rotation), np.sin(rotation), offset, radius)
    return float(least), float(most)


def axis_intervals(normal: Floats, tilt_direction: Floats, ranges: Ranges) -> Floats:
    """Tilts (k, 2) within those asked for that a machine's limits leave at a normal and a tilt direction (3,)."""
    out = np.empty((64, 2))
    return out[: held_tilts(normal, tilt_direction, ranges, ranges.tilt_low, ranges.tilt_high, out)].copy()
