"""The same part in another setup: postures that its machine holds there, too, are not searched again."""

import numpy as np

from plan_cutters.domain.cutter import Cutter
from plan_cutters.domain.verdicts import ACCESSIBLE, Verdicts, blank
from plan_cutters.judging.judge import Judge, judge
from plan_cutters.scene.preparation import Prepared
from plan_cutters.scene.threads import Progress


def in_setup(
    ready: Prepared, cutter: Cutter, setup: int, verdicts: Verdicts, *, progress: Progress | None = None, judged: Judge = judge
) -> Verdicts:
    """Find the verdicts of a cutter in another setup.

    Parameters
    ----------
    ready : Prepared
    cutter : Cutter
    setup : int
        Its number, from 1. The side of open faces stays as it is.
    verdicts : Verdicts
        Its verdicts in the setup of `ready`.
    progress : callable, optional
        Called with the number of pieces of work that are done, and the number of all.
    judged : callable, optional
        Gives verdicts as `judge` does.
    """
    there = ready.there(setup)
    conditions, known = there.conditions, blank(len(ready.samples))
    machine = conditions.machine
    # Among other fixtures, nothing is known of a posture.
    rows = np.flatnonzero(verdicts.reached & (conditions.surroundings is ready.conditions.surroundings))
    # Where fewer than two axes turn the tool, rotations are numbered by the axes that there are in a setup.
    few = machine.turns and machine.turning < 2
    rows = rows[:0] if few else rows[conditions.allows(verdicts.axis[rows])]
    known.verdict[rows] = ACCESSIBLE
    known.take_posture(rows, verdicts)
    return judged(there, cutter, known=known.freeze(), progress=progress)
