"""The tilted planes of operations."""

from collections.abc import Sequence

import numpy as np

from plan_cutters.domain.operations import Operation, Workplane
from plan_cutters.domain.placement import frame_of
from plan_cutters.operations.indexing import Indexing
from plan_cutters.scene.preparation import Prepared


def workplanes(operations: Sequence[Operation], ready: Prepared, indexing: Indexing) -> tuple[Workplane | None, ...]:
    """The plane of each operation with a fixed axis, None for others.

    Operations of one cutter in one setup follow each other, in the order in which the rotary axes need least time; the first one
    starts with these at zero.
    """
    options = ready.options
    placements = (options.placement, *(options.other_placements or (None,) * len(options.other_setups)))
    planes: list[Workplane | None] = [None] * len(operations)
    groups: dict[tuple[int, str], list[int]] = {}
    for i, each in enumerate(operations):
        if each.axis is not None:
            groups.setdefault((each.setup, each.cutter.id), []).append(i)
    for (s, _), mine in groups.items():
        where = indexing.orientations[s]
        conditions, moved = where.conditions, where.kinematics
        known = [[each for each in (operations[i].angle, operations[i].other_angle) if each is not None] for i in mine]
        origin = np.zeros(3) if (place := placements[s]) is None or place.origin is None else np.array(place.origin, float)
        across = conditions.frame[0]
        for i, seconds in zip(mine, indexing.times(s, known).tolist(), strict=True):
            axis, angle = operations[i].axis, operations[i].angle
            assert axis is not None, "a group holds fixed axes"
            assert angle is not None, "a fixed axis has angles"
            x = frame_of(axis, moved.carried(across, np.radians(angle)[None])[0])[0]
            planes[i] = Workplane(origin, x, axis, seconds)
    return tuple(planes)
