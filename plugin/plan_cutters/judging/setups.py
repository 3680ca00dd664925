"""Find the samples within the axis limits of one setup or another: there no cutter at all can reach the other samples."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from cad_io.arrays import SurfaceSamples
from plan_cutters.domain.cutter import Cutter
from plan_cutters.domain.shapes import modes
from plan_cutters.scene.conditions import Conditions
from plan_cutters.scene.threads import in_chunks

#: Setup axes that are compared: both ways along the part's own.
AXES = ((1.0, 0.0, 0.0), (-1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, -1.0, 0.0), (0.0, 0.0, 1.0), (0.0, 0.0, -1.0))


def within_limits(
    samples: SurfaceSamples,
    cutters: Sequence[Cutter],
    conditions: Conditions,
    setup: tuple[float, float, float] | None = None,
    rows: NDArray[np.int64] | None = None,
) -> NDArray[np.bool_]:
    """Judged samples (n,) at which the machine can hold some tool axis at which any of the cutters touches.

    Parameters
    ----------
    samples : SurfaceSamples
    cutters, conditions
    setup : (float, float, float), optional
        Another setup axis than that of the conditions, a unit direction.
    rows : (m,) int64, optional
        The samples to look at, all by default.
    """
    if setup is not None:
        conditions = replace(conditions, setup=np.array(setup), x=None)
    ranges, held = conditions.ranges, np.zeros(len(samples), bool)
    rows = np.arange(len(samples)) if rows is None else rows
    rows = rows[samples.unjudged[rows] < 0]
    touching = [mode for cutter in cutters for mode in modes(cutter)]
    low = max(ranges.tilt_low, min(mode.low for mode in touching))
    high = min(ranges.tilt_high, max(mode.high for mode in touching))
    if low > high:
        return held
    if not conditions.machine.limited:
        held[rows] = True
        return held
    from plan_cutters.kernels.limits import any_axis

    in_chunks(
        lambda piece: any_axis(piece, samples.normal, samples.direction_max, ranges, low, high, held), rows, conditions.jobs
    )
    return held
