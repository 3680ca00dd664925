"""The same part in another setup: postures that its machine holds there, too, are not searched again."""

from dataclasses import replace

import numpy as np

from plan_cutters.domain.cutter import Cutter
from plan_cutters.domain.placement import frame_of
from plan_cutters.domain.verdicts import ACCESSIBLE, Verdicts, blank
from plan_cutters.scene.preparation import Prepared
from plan_cutters.scene.threads import Progress
from plan_cutters.stages.judge import judge


def in_setup(
    ready: Prepared,
    cutter: Cutter,
    setup: tuple[float, float, float],
    verdicts: Verdicts,
    *,
    x: tuple[float, float, float] | None = None,
    progress: Progress | None = None,
) -> Verdicts:
    """Find the verdicts of a cutter in another setup.

    Parameters
    ----------
    ready : Prepared
    cutter : Cutter
    setup : (float, float, float)
        Unit direction of the part along the machine's spindle at zero angles. The side of open faces stays as it is.
    verdicts : Verdicts
        Its verdicts in the setup of `ready`.
    x : (float, float, float), optional
        Unit direction of the part along the machine's X there, as `Placement` has it.
    """
    axis, across = np.array(setup), None if x is None else np.array(x)
    machine, known = ready.conditions.machine, blank(len(ready.samples))
    rows = np.flatnonzero(verdicts.reached)
    # Where fewer than two axes turn the tool, rotations are numbered by the axes that there are in a setup.
    few = machine.turns and len(machine.rotary) < 2
    rows = rows[:0] if few else rows[machine.allows(verdicts.axis[rows], frame_of(axis, across))]
    known.verdict[rows] = ACCESSIBLE
    known.take_posture(rows, verdicts)
    other = replace(ready, conditions=replace(ready.conditions, setup=axis, x=across))
    return judge(other, cutter, known=known.freeze(), progress=progress)
