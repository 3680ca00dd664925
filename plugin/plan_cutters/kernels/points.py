"""The closed forms at one rotation, for callers that are not compiled."""

import numpy as np

from plan_cutters.kernels.arcs import axis_arcs, local_gouge


def local_gouge_bound(kappa_max: float, kappa_min: float, rotation: float, radius: float) -> float:
    """Least tilt without local gouging, rad; nan if none. Curvatures 1/mm, radius mm."""
    return float(local_gouge(kappa_max, kappa_min, np.cos(rotation), np.sin(rotation), radius))


def axis_intervals(along_n: float, along_f: float, limit_cos: float, low: float, high: float) -> np.ndarray:
    """Tilts (k, 2) within [low, high] that an axis limit allows; arguments as in `arcs.axis_arcs`."""
    out = np.empty((3, 2))
    return out[: axis_arcs(along_n, along_f, limit_cos, low, high, out)].copy()
