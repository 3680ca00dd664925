"""Where a cutter stands free with one axis."""

import numpy as np

from plan_cutters.scene.fixed_axis import served_by


def serves(rows, axis, samples, context):
    """At which of some samples (m,) a cutter stands free with one axis (3,)."""
    return served_by(rows, np.asarray(axis)[None], samples, context)[0][0]
