"""The tilted planes of operations."""

from collections.abc import Sequence

import numpy as np

from plan_cutters.domain.placement import frame_of
from plan_cutters.operations.indexing import Indexing
from plan_cutters.outcome import Operation
from plan_cutters.plan_file.frozen import vector
from plan_cutters.plan_file.operations import WorkplaneEntry
from plan_cutters.scene.preparation import Prepared


def workplanes(operations: Sequence[Operation], ready: Prepared, indexing: Indexing) -> list[Operation]:
    """Operations with the tilted plane of each one with a fixed axis: the plane that a control turns to, and what that takes.

    Operations of one cutter in one setup follow each other, in the order in which the rotary axes need least time; the first one
    starts with these at zero.
    """
    options = ready.options
    placements = (options.placement, *(options.other_placements or (None,) * len(options.other_setups)))
    planned = list(operations)
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
            frame = WorkplaneEntry(origin=vector(origin), x=vector(x), z=vector(axis))
            planned[i] = operations[i].with_fields(frame=frame, index_s=seconds, index_from=indexing.source)
    return planned
