"""Combine the verdicts of one cutter over several setups, one after the other."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from cad_io.arrays import Floats, Ints
from plan_cutters.domain.kinematics import Kinematics
from plan_cutters.domain.verdicts import AXIS_LIMIT, FIXTURE, INACCESSIBLE, UNDECIDED, Verdicts, blank


def over_setups(each: Sequence[Verdicts]) -> tuple[Verdicts, Ints]:
    """Combine the verdicts of all setups, and name the setup that reaches each sample.

    Parameters
    ----------
    each : sequence of Verdicts
        In each setup, of the same n samples.

    Returns
    -------
    Verdicts
        Verdict and posture of the first setup that reaches a sample. Where none does: undecided if it is so in any; the reason
        is that of the first one in which not the axis limit alone leaves nothing, or the fixture if that is so in any.
    (n,) int32
        The setup that reaches each sample, -1 for none.
    """
    n = len(each[0].verdict)
    combined, which = blank(n), np.full(n, -1, np.int32)
    for k, verdicts in enumerate(each):
        rows = verdicts.reached & (which < 0)
        which[rows] = k
        combined.take(rows, verdicts)
    for verdicts in each:
        rows = (which < 0) & verdicts.not_reached
        first = rows & ~combined.not_reached
        combined.verdict[first], combined.reason[first] = verdicts.verdict[first], verdicts.reason[first]
        unsure = rows & (verdicts.verdict == UNDECIDED) & (combined.verdict == INACCESSIBLE)
        combined.verdict[unsure], combined.reason[unsure] = UNDECIDED, verdicts.reason[unsure]
        more = rows & ~first & (combined.reason == AXIS_LIMIT) & (verdicts.verdict == combined.verdict)
        combined.reason[more] = verdicts.reason[more]
        combined.reason[rows & (verdicts.reason == FIXTURE)] = FIXTURE
    return combined.freeze(), which


def positions(
    machines: Sequence[Kinematics | None], axis: Floats, which: Ints
) -> tuple[Floats, NDArray[np.int8], NDArray[np.bool_]]:
    """Positions of rotary axes that hold tool axes, each in the setup that serves its sample.

    Parameters
    ----------
    machines : sequence of Kinematics
        In each setup.
    axis : (n, 3) float
        Unit tool axes; nan where there is none.
    which : (n,) int32
        The setup of each, -1 for none.

    Returns
    -------
    angles, taken, singular
        As `Kinematics.positions` gives them.
    """
    first = machines[0]
    assert first is not None, "a machine without rotary axes has no positions"
    angles, taken, singular = first.positions(axis)
    for k, each in enumerate(machines[1:], 1):
        rows = np.flatnonzero(which == k)
        if len(rows) and each is not None:
            angles[rows], taken[rows], singular[rows] = each.positions(axis[rows])
    return angles, taken, singular
