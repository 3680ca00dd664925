"""All answers that the options of a plan ask for, one after the other."""

from collections.abc import Callable, Mapping
from contextlib import AbstractContextManager

from plan_cutters.answers.largest_radius import largest_radius
from plan_cutters.answers.mend import mend
from plan_cutters.answers.stick_out import least_stick_out
from plan_cutters.domain.answers import Answers
from plan_cutters.domain.cutter import Cutter
from plan_cutters.domain.verdicts import Reach
from plan_cutters.scene.prepared import Prepared
from plan_cutters.scene.threads import Progress

#: Of every sample the least stick-out is found to this, mm.
STEP = 0.5


def ask(
    ready: Prepared, reaches: Mapping[Cutter, Reach], stage: Callable[[str], AbstractContextManager[Progress]]
) -> Answers:
    """Answer what is asked.

    Parameters
    ----------
    ready : Prepared
    reaches : mapping
        What each cutter reaches.
    stage : callable
        Opens a stage of work by its name; what it gives is told how much of how much is done.
    """
    asked = ready.options.answers
    stick_outs, radius_maps, mends = {}, [], {}
    if "stick-out" in asked or "stick-out-map" in asked:
        step = STEP if "stick-out-map" in asked else None
        for cutter in ready.cutters:
            with stage("stick-out") as tell:
                stick_outs[cutter.id] = least_stick_out(ready, cutter, reaches[cutter], step=step, progress=tell)
    if "radius" in asked:
        with stage("radius") as tell:
            for shape in ("flat", "ball"):
                ratio = ready.options.length_over_radius
                radius_maps.append(largest_radius(ready, shape, ratio=ratio, progress=tell))
    if "mend" in asked:
        for cutter in ready.cutters:
            reach = reaches[cutter]
            if reach.lost.any() or ready.conditions.around.doubtful:
                with stage("mend") as tell:
                    mends[cutter.id] = mend(ready, cutter, reach, progress=tell)
    return Answers(stick_outs, tuple(radius_maps), mends)
