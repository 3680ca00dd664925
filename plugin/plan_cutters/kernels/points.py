"""The closed forms at one rotation, for callers that are not compiled."""

import numpy as np

from plan_cutters.kernels.arcs import axis_arcs, local_gouge


def local_gouge_range(
    kappa_max: float, kappa_min: float, rotation: float, offset: float, radius: float
) -> tuple[float, float]:
    """Least and largest tilt without local gouging, rad; nan if there is none. Curvatures 1/mm; the others as in
    `arcs.local_gouge`.
    """
    least, most = local_gouge(kappa_max, kappa_min, np.cos(rotation), np.sin(rotation), offset, radius)
    return float(least), float(most)


def axis_intervals(along_n: float, along_f: float, limit_cos: float, low: float, high: float) -> np.ndarray:
    """Tilts (k, 2) within [low, high] that an axis limit allows; arguments as in `arcs.axis_arcs`."""
    out = np.empty((3, 2))
    return out[: axis_arcs(along_n, along_f, limit_cos, low, high, out)].copy()
