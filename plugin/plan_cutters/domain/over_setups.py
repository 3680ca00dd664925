"""What one cutter reaches over several setups, one after the other."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from cad_io.arrays import Floats, Ints
from plan_cutters.domain.kinematics import Kinematics
from plan_cutters.domain.verdicts import AXIS_LIMIT, FIXTURE, INACCESSIBLE, UNDECIDED, Reach, blank


def over_setups(each: Sequence[Reach]) -> tuple[Reach, Ints]:
    """What is reached in one setup or another, and in which.

    Parameters
    ----------
    each : sequence of Reach
        In each setup, of the same n samples.

    Returns
    -------
    Reach
        Verdict and posture of the first setup that reaches a sample. Where none does: undecided if it is so in any; the reason
        is that of the first one in which not the axis limit alone leaves nothing, or the fixture if that is so in any.
    (n,) int32
        The setup that reaches each sample, -1 for none.
    """
    n = len(each[0].verdict)
    found, which = blank(n), np.full(n, -1, np.int32)
    for k, reach in enumerate(each):
        rows = reach.reached & (which < 0)
        which[rows] = k
        for name in Reach.__slots__:
            getattr(found, name)[rows] = getattr(reach, name)[rows]
    for reach in each:
        rows = (which < 0) & reach.lost
        first = rows & ~found.lost
        found.verdict[first], found.reason[first] = reach.verdict[first], reach.reason[first]
        unsure = rows & (reach.verdict == UNDECIDED) & (found.verdict == INACCESSIBLE)
        found.verdict[unsure], found.reason[unsure] = UNDECIDED, reach.reason[unsure]
        more = rows & ~first & (found.reason == AXIS_LIMIT) & (reach.verdict == found.verdict)
        found.reason[more] = reach.reason[more]
        found.reason[rows & (reach.reason == FIXTURE)] = FIXTURE
    return found, which


def positions(
    machines: Sequence[Kinematics | None], axis: Floats, which: Ints
) -> tuple[Floats, NDArray[np.int8], NDArray[np.bool_]]:  # fmt: skip
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
