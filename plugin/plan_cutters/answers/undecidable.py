"""Why no change of a cutter is sought: all that it leaves is undecided, and the cause lies in the model of the part."""

import numpy as np

from plan_cutters.domain.cutter import Cutter
from plan_cutters.domain.figures import mm
from plan_cutters.domain.verdicts import UNDECIDED, Verdicts
from plan_cutters.scene.preparation import Prepared

#: A tolerance that is larger than asked by more than rounding was raised.
_RAISED = 1.001


def undecidable(ready: Prepared, cutter: Cutter, verdicts: Verdicts) -> str:
    """Say why no change is sought; empty where a sample is inaccessible for sure, or a finer tolerance might decide.

    Parameters
    ----------
    ready : Prepared
    cutter : Cutter
    verdicts : Verdicts
        Of all samples.
    """
    not_reached = verdicts.not_reached & ready.finished
    if not not_reached.any() or (verdicts.verdict[not_reached] != UNDECIDED).any():
        return ""
    conditions, number = ready.conditions, int(np.count_nonzero(not_reached))
    raised = conditions.tolerance > _RAISED * ready.scene.asked
    if raised and not conditions.judges(cutter):
        cause = f"the tolerance that can be kept, {mm(conditions.tolerance)}, is too coarse for the cutter"
    elif set(faces := np.unique(ready.samples.face[not_reached]).tolist()) <= set(conditions.surroundings.loose):
        cause = f"they lie on {', '.join(f'F{face}' for face in faces)}, which triangles follow too loosely"
    else:
        return ""
    what = "the only sample that it leaves is" if number == 1 else f"all {number:,} samples that it leaves are"
    return f"it was not asked, because {what} undecided: {cause}; rebuild the model there in CAD"
