"""Stick-outs and radii over several setups: each is found in one setup after the other, among what stands there."""

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from cad_io.arrays import Ints
from plan_cutters.answers.largest_radius import largest_radius
from plan_cutters.answers.stick_out import least_stick_out
from plan_cutters.domain.answers import RadiusMap, Shape
from plan_cutters.domain.cutter import Cutter
from plan_cutters.domain.stick_out import StickOut
from plan_cutters.domain.verdicts import INACCESSIBLE, UNDECIDED, UNJUDGED, Verdicts
from plan_cutters.scene.preparation import Prepared
from plan_cutters.scene.threads import Progress, part_of


def stick_out_in_each(
    ready: Prepared, cutter: Cutter, verdicts: Sequence[Verdicts], which: Ints, *, progress: Progress | None = None
) -> StickOut:
    """The least stick-out with which each setup still reaches all samples that it serves.

    Parameters
    ----------
    ready : Prepared
    cutter : Cutter
    verdicts : sequence of Verdicts
        In each setup.
    which : (n,) int32
        The setup that serves each sample, -1 for none.
    progress
        As for `least_stick_out`.

    Returns
    -------
    StickOut
        Of the setup that needs most. With another division of the samples among the setups, less might do.
    """
    if len(verdicts) == 1:
        return least_stick_out(ready, cutter, verdicts[0], progress=progress)
    tell = progress or (lambda done, total: None)
    results = list[StickOut]()
    for k, there in enumerate(verdicts):
        mine = replace(there, verdict=np.where(there.reached & (which != k), UNJUDGED, there.verdict).astype(np.uint8))
        part = part_of(tell, k, len(verdicts))
        results.append(replace(least_stick_out(ready.alone(k), cutter, mine, progress=part), setup=k))
    # A setup that serves nothing asks for nothing.
    most = max(results, key=lambda each: -np.inf if np.isnan(each.least) else each.least)
    return replace(most, served=sum(each.served for each in results))


def radius_in_any(ready: Prepared, shape: Shape, *, ratio: float, progress: Progress | None = None) -> RadiusMap:
    """Find the largest radius that reaches each sample in one setup or another, as `largest_radius` does in one."""
    number, tell = len(ready.setups), progress or (lambda done, total: None)
    best, *others = [largest_radius(ready.alone(k), shape, ratio=ratio, progress=part_of(tell, k, number)) for k in range(number)]
    for other in others:
        larger = other.radius > best.radius
        taken: dict[str, Any] = {
            name: np.where(larger if column.ndim == 1 else larger[:, None], getattr(other, name), column)
            for name in ("radius", "beyond", "reason", "axis", "tilt_direction", "tilt", "rotation")
            if isinstance(column := getattr(best, name), np.ndarray)
        }
        # What is undecided in either setup may serve there.
        unsure = (taken["beyond"] == INACCESSIBLE) & ((best.beyond == UNDECIDED) | (other.beyond == UNDECIDED))
        source = np.where(best.beyond == UNDECIDED, best.reason, other.reason)
        taken["beyond"] = np.where(unsure, UNDECIDED, taken["beyond"]).astype(np.uint8)
        taken["reason"] = np.where(unsure, source, taken["reason"]).astype(np.uint8)
        best = replace(best, **taken)
    return best
