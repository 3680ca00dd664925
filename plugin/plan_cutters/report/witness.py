"""The sample that a witness of a plan is about."""

import numpy as np

from cad_io import SurfaceSamples
from plan_cutters.plan_file.model import WitnessEntry


def row_of(samples: SurfaceSamples, witness: WitnessEntry) -> int:
    """Find the row of a witness's sample.

    The plan says it. Older plans do not: there it is the sample of the witness's own face that lies at its point.

    Raises
    ------
    ValueError
        The samples have none such: the witness is of another plan.
    """
    face, point = int(witness.face[1:]), np.array(witness.point)
    if witness.sample is not None:
        mine = np.arange(witness.sample, min(witness.sample + 1, len(samples)))
    else:
        mine = np.arange(len(samples))
    mine = mine[samples.face[mine] == face]
    away = np.linalg.norm(samples.point[mine] - point, axis=1)
    # A point without coordinates is at no distance.
    if not (away <= 1e-6 * max(1.0, float(np.abs(point).max()))).any():
        raise ValueError(f"no sample of {witness.face} lies at the point of this witness: it is of another plan")
    return int(mine[int(np.nanargmin(away))])
