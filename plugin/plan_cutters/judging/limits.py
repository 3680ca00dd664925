"""Limits of a machine: samples that any cutter can reach within those of its rotary axes; where its linear axes stand."""

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from cad_io.arrays import SurfaceSamples
from plan_cutters.domain.cutter import Cutter
from plan_cutters.domain.shapes import modes
from plan_cutters.domain.travel import Travel, tips, travel, unjudged
from plan_cutters.domain.verdicts import Verdicts
from plan_cutters.options import Options
from plan_cutters.scene.conditions import Conditions
from plan_cutters.scene.work import in_chunks

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

    `setup` (float, float, float): another setup axis than that of the conditions, a unit direction. `rows` (m,) int64: the
    samples to look at, all by default.
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


def travels(options: Options, samples: SurfaceSamples, reaches: Mapping[Cutter, Verdicts]) -> dict[str, Travel]:
    """By the id of a cutter where the linear axes stand; empty where that is not judged."""
    placement = options.placement
    if placement is None or unjudged(options.machine, placement) is not None:
        return {}
    tip = {cutter: tips(cutter, samples.point, samples.normal, reach) for cutter, reach in reaches.items()}
    return {c.id: travel(options.machine, placement, tip[c], reach.axis, c.length) for c, reach in reaches.items()}
