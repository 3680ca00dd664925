"""Which drill of the libraries makes each hole: along the hole's axis it must stand free down to the end of the hole."""

from collections.abc import Iterator, Sequence

import numpy as np

from cad_io.arrays import Floats
from cad_io.part.holes import Hole
from plan_cutters.domain.drill import Drill, Drilled
from plan_cutters.kernels.rows import Contacts
from plan_cutters.scene.conditions import Conditions, Context, free_in_posture
from plan_cutters.scene.preparation import Prepared

#: Share of a flat's radius that is none.
_NO_WAY = 1e-12


def drills_of(ready: Prepared) -> list[Drill]:
    """The tools for holes of all libraries, each once, in their order."""
    return [*{each.id: each for library in ready.options.libraries for each in library.drills}.values()]


def drilled(ready: Prepared) -> list[Drilled | None]:
    """Find of each hole the drill that makes it: the nearest in diameter, of equal ones the shortest; None: none does."""
    clearance = ready.options.holder_clearance
    drills = sorted(drills_of(ready), key=lambda each: each.body.length)
    return [_made_by(ready, hole, drills, clearance) for hole in ready.holes]


def _made_by(ready: Prepared, hole: Hole, drills: Sequence[Drill], clearance: float) -> Drilled | None:
    fitting = [each for each in drills if each.fits(hole.diameter, hole.bottom, hole.cone)]
    for drill in sorted(fitting, key=lambda each: round(abs(each.diameter - hole.diameter), 6)):
        # Through a hole the point goes on until all of its width is.
        deep = drill.depth_in(hole.depth, through=hole.through)
        body = drill.in_hole(hole.diameter)
        if body is None or drill.reach < deep:
            continue
        body = body.asked(0.0, clearance, None)
        for setup, conditions in enumerate(ready.setups):
            for axis, mouth in _ways(hole):
                if _free(Context.of(body, conditions), conditions, mouth - deep * axis, axis):
                    return Drilled(drill, setup, axis)
    return None


def _ways(hole: Hole) -> Iterator[tuple[Floats, Floats]]:
    """Axes of a tool in a hole, each with the point of the axis at its mouth."""
    yield hole.axis, hole.place
    if hole.through:
        yield -hole.axis, hole.place - hole.depth * hole.axis


def _free(context: Context, conditions: Conditions, tip: Floats, axis: Floats) -> bool:
    """Whether a tool stands free with the middle of its flat tip at a point; an axis that the machine cannot hold is no way."""
    if not context.judges or conditions.surroundings.doubtful or not conditions.allows(axis[None])[0]:
        return False
    point, normal = np.ascontiguousarray(tip[None]), np.ascontiguousarray(axis[None])
    across = np.linalg.svd(normal)[2][1:2]
    contacts = Contacts(point, normal, across, np.zeros((1, 2)))
    # The contact lies under the middle of the flat: of the tilt direction that has no length, the way alone counts.
    return bool(free_in_posture(contacts, np.zeros(1, np.int64), normal, _NO_WAY * across, context)[0])
