"""Where cutters may have a posture in a direction: by a bound that is cheap and sees no obstacle but the table, and by a brief
search.
"""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from cad_io.arrays import Floats, SurfaceSamples
from plan_cutters.answers.candidates import Candidates
from plan_cutters.domain.cutter import Cutter
from plan_cutters.domain.fixture import TABLE
from plan_cutters.domain.preference import group_of
from plan_cutters.domain.verdicts import blank
from plan_cutters.judging.limits import within_limits
from plan_cutters.scene.conditions import Conditions, Context, contacts_of, over_plane
from plan_cutters.scene.flats_and_flanks import search
from plan_cutters.scene.preparation import Axis, Prepared

Rows = NDArray[np.int64]

#: Heights over the table are told apart in so many steps.
_HEIGHTS = 12


def holdable(
    samples: SurfaceSamples, cutters: Sequence[Cutter], conditions: Conditions, axis: Floats, table: float | None = None,
    rows: Rows | None = None,
) -> NDArray[np.bool_]:  # fmt: skip
    """Judged samples (n,) at which the machine holds some tool axis at which a cutter touches, were `axis` the setup axis.

    `conditions`: machine and posture range. `axis` (3,) float: unit direction of the part along the spindle. `table`: height
    along `axis` below which nothing of a tool may be, mm: axes are left out at which the upper end of every cutter would be
    there. None: no table. `rows` (m,) int64: the samples to look at, all by default.
    """
    setup: Axis = (float(axis[0]), float(axis[1]), float(axis[2]))
    if table is None:
        return within_limits(samples, cutters, conditions, setup, rows)
    height = np.maximum(0.0, samples.point @ axis - table)
    steps = np.linspace(0.0, float(np.nanmax(height, initial=0.0)), _HEIGHTS + 1)[1:]
    level, held = np.minimum(np.searchsorted(steps, height), _HEIGHTS - 1), np.zeros(len(samples), bool)
    rows, machine = np.arange(len(samples)) if rows is None else rows, conditions.machine
    for k, high in enumerate(steps):
        mine = rows[level[rows] == k]
        if not len(mine):
            continue
        # The end of the axis lies the length from the tip, and the tip a diameter from the contact at most.
        tilt = max(min(1.0, (float(high) + 2.0 * cutter.radius) / cutter.length) for cutter in cutters)
        cap = float(np.arccos(-tilt))
        limit = cap if machine.tilt_limit is None else min(cap, machine.tilt_limit)
        over = replace(conditions, machine=replace(machine, tilt_limit=limit), setup=np.array(setup), x=None)
        held |= within_limits(samples, cutters, over, rows=mine)
    return held


def bound_of(ready: Prepared, candidates: Candidates, rows: Rows, k: int, word: str) -> NDArray[np.bool_]:
    """Rows (r,) where the machine holds an axis at all in a direction, in what holds the part; not on what it stands on."""
    # A vise or chuck stands on a riser: beside it a tool may be lower than the part.
    table = float(candidates.lowest[k]) if word == TABLE else None
    conditions = replace(ready.conditions, setup=np.array([0.0, 0.0, 1.0]), x=None)
    held = holdable(ready.samples, ready.cutters, conditions, candidates.axis[k], table, rows)
    return np.asarray(held[rows] & ~np.isin(ready.samples.face[rows], candidates.stands_on[k]))


def usual_of(cutters: Sequence[Cutter]) -> list[Cutter]:
    """The cutters that finish surfaces: without engraving, chamfer and form cutters, unless there are no others."""
    return [each for each in cutters if group_of(each) != "last"] or list(cutters)


def reached_by(
    ready: Prepared, rows: Rows, conditions: Conditions, *, usual: bool, above: float | None = None
) -> NDArray[np.bool_]:
    """The samples (n,) of some rows at which any of the cutters, or of the usual ones, has a posture under some conditions, and
    nothing of it is below a height along the setup axis, mm."""
    reached, open_rows = np.zeros(len(ready.samples), bool), rows
    # The smallest reaches most.
    for cutter in sorted(usual_of(ready.cutters) if usual else ready.cutters, key=lambda each: each.radius):
        if len(open_rows) and conditions.judges(cutter):
            verdicts = blank(len(reached))
            context = Context.of(cutter, conditions)
            search(contacts_of(ready.samples), ready.samples.face, open_rows, context, verdicts, fixed=True, brief=True)
            good = verdicts.reached
            if above is not None:
                good &= over_plane(context, contacts_of(ready.samples), verdicts, above)
            reached |= good
            open_rows = open_rows[~good[open_rows]]
    return reached
