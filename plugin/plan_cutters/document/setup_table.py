"""The plan's table of setups: how much is within the axis limits and is reached in each."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from plan_cutters.document.over_setups import OverSetups
from plan_cutters.judging.setups import AXES, within_limits
from plan_cutters.plan_file.frozen import Vector
from plan_cutters.plan_file.setups import SetupEntry
from plan_cutters.scene.preparation import Prepared


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
