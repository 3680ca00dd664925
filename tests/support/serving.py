"""Where a cutter stands free with one axis, and what a case leaves."""

import numpy as np

from plan_cutters.judging.judge import judge
from plan_cutters.scene.fixed_axis import served_by


def serves(rows, axis, samples, context):
    """At which of some samples (m,) a cutter stands free with one axis (3,)."""
    return served_by(rows, np.asarray(axis)[None], samples, context)[0][0]


def not_reached(case, rows=None):
    """Samples of the finished surface, or of some rows of it, that a case does not reach, as a plan finds them."""
    rows = np.flatnonzero(case.ready.finished) if rows is None else rows[case.ready.finished[rows]]
    for one in case.setups:
        if len(rows):
            rows = rows[~judge(one, case.cutter, rows).reached]
    return rows
