"""Machine code made ahead: on the first run of all, a second process compiles while this one reads and meshes the part."""

import sys
import time
from collections.abc import Callable

from plan_cutters_base.workers.child import compiler, follow_parent

#: The longest that is waited for it, s: what is not there by then is compiled here.
_PATIENCE = 120.0
#: How often it is looked whether an entry is there, s.
_LOOK = 0.05


def begin(maps: bool) -> Callable[[str], None] | None:
    """Start the second process where there is no machine code yet; what waits for an entry of it, None where it is not needed.

    An entry, `module.function`, is waited for until it is there or the process has ended. `maps`: posture maps will be requested.
    """
    from plan_cutters.kernels.jit import at_hand

    if at_hand("search.search.search_rows") is not False:
        return None
    try:
        other = compiler(maps)
    except OSError:
        return None  # it would only have saved time

    ends = time.monotonic() + _PATIENCE

    def wait(entry: str) -> None:
        while other.ended(0.0) is None and not at_hand(entry):
            if time.monotonic() > ends:
                other.end()
            time.sleep(_LOOK)

    return wait


def compile_all(maps: bool) -> None:
    """Compile what every plan needs: the search at once, with nothing to search, then a plan of a small corner."""
    import numpy as np

    from cad_io.arrays import Triangles
    from cad_io.kernel.shapes import corner
    from plan_cutters import Cutter, plan
    from plan_cutters.domain.machine import Machine
    from plan_cutters.domain.posture import PostureRange
    from plan_cutters.kernels.rows import Contacts
    from plan_cutters.scene.conditions import Conditions, Context, warm
    from plan_cutters.scene.obstacles import Obstacles
    from plan_cutters.scene.surroundings import Surroundings

    cutter, none = Cutter.flat(radius=1, length=9), np.zeros((0, 3))
    one = Obstacles(Triangles(np.eye(3)[None], np.ones(1, np.int32), 1e-3, ()))
    conditions = Conditions(Machine(), np.array([0.0, 0.0, 1.0]), PostureRange(), Surroundings.sheet(one), 0.01, 1)
    warm(Contacts(none, none, none, none[:, :2].copy()), Context.of(cutter, conditions))
    # What reading and meshing need is compiled by the first process meanwhile, and only loaded here.
    plan(corner(20.0, 0.2), faces=[1], cutters=[cutter], grid=9, jobs=1, posture_maps=maps)


if __name__ == "__main__":
    follow_parent()
    compile_all("maps" in sys.argv[1:])
