"""Which fillet does a cutter leave beside a sharp inside edge, and which cutters fit into one?"""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from cad_io.arrays import Floats
from plan_cutters.domain.cutter import Cutter
from plan_cutters.domain.standard_tools import METRIC

#: What the kernel's curvature is off by, as a share.
_ROUNDING = 1e-6


class Fit(NamedTuple):
    """A cutter of a usual size reaches this share of an area, 0 to 1."""

    cutter: Cutter
    share: float


#: Which usual sizes in place of a cutter reach some samples (m,), by the areas of all samples (n,); None where that is not known.
Fitting = Callable[[Cutter, NDArray[np.int64], Floats], tuple[Fit, ...] | None]


def largest_fitting(radius: float, allowance: float = 0.0) -> float | None:
    """Largest usual diameter of a cutter that fits into an inside radius and leaves an allowance, mm; None where none does.

    >>> largest_fitting(1.916), largest_fitting(3.0), largest_fitting(0.2)
    (3.0, 6.0, None)
    """
    sizes = (tool.diameter for tool in METRIC)
    return max((size for size in sizes if 0.5 * size + allowance <= radius * (1.0 + _ROUNDING)), default=None)


def least_radius(cutter: Cutter) -> float | None:
    """Least radius of the fillet that a cutter leaves beside an edge, mm, its allowance included; None for shapes without one.

    It is the corner radius, or of a flat end the radius, with which it goes along an edge.

    >>> least_radius(Cutter.parse("R6L80")), least_radius(Cutter.parse("R6L80rc1")), least_radius(Cutter.parse("R6L80rc6"))
    (6.0, 1.0, 6.0)
    """
    if cutter.shape == "lollipop":
        return cutter.radius + (cutter.allowance or 0.0)
    if cutter.shape != "end":
        return None
    return (cutter.corner_radius or cutter.radius) + (cutter.allowance or 0.0)
