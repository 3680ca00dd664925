"""Say how often a step is done over a pattern, and by how much the rotary axes turn from one time to the next."""

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from cad_io.part.motion import Motion
from plan_cutters.plan_file.operations import OperationEntry
from plan_cutters.scene.preparation import Prepared

#: Angles that are written to three digits are equal within this, deg.
_WRITTEN = 0.0021
#: Share of the area of a step that must have an image in it, and how well normals agree.
_AGREES, _NORMAL = 0.98, math.cos(math.radians(10.0))
#: Directions are one within this.
_SAME = 1e-6


def repeats(ready: Prepared, same: Sequence[OperationEntry], mine: NDArray[np.bool_]) -> tuple[int, dict[str, float] | None]:
    """How often a step is done, and by how much one rotary axis turns from one time to the next; None where several turn.

    Parameters
    ----------
    ready : Prepared
    same : sequence of OperationEntry
        The operations of the step: images of each other, from the first angle up.
    mine : (n,) bool
        Samples of the step.
    """
    if same[0].mode == "simultaneous":
        return _moving(ready, same[0].setup, mine)
    if len(same) == 1:
        return 1, None
    angles = [each.angles_deg or {} for each in same]
    for name in angles[0]:
        others = [key for key in angles[0] if key != name]
        turned = np.sort([each[name] % 360.0 for each in angles])
        steps = np.diff(turned)
        if all(abs(each[key] - angles[0][key]) <= _WRITTEN for each in angles for key in others):
            step, number = float(steps.min()), len(same)
            # One that is left out leaves a gap: then no angle leads from each to the next.
            parts = max(1, round(360.0 / step)) if step > _WRITTEN else 1
            even = np.ptp(steps) <= _WRITTEN * number and abs(step - 360.0 / parts) <= _WRITTEN
            return number, {name: round(360.0 / parts, 3)} if even and parts >= number else None
    return len(same), None


def _moving(ready: Prepared, setup: int, mine: NDArray[np.bool_]) -> tuple[int, dict[str, float] | None]:
    """The same of simultaneous motion: a rotation of the whole part repeats it, where limits and fixtures are kept as well."""
    conditions = ready.setups[setup]
    kinematics = conditions.kinematics
    if ready.copies is None or kinematics is None or len(kinematics.direction) != 2 or not mine.any():
        return 1, None
    keeps = dict(zip(map(id, ready.copies.motions), ready.copies.unchanged[setup], strict=True))
    for each in ready.patterns:
        axis = each.motions[0].axis if each.whole and each.kind == "rotation" else None
        if axis is None or not all(keeps.get(id(motion), False) for motion in each.motions):
            continue
        if abs(abs(axis[1] @ kinematics.direction[0]) - 1.0) > _SAME or not _has_images(ready, each.motions[0], mine):
            continue
        return each.order, {conditions.machine.rotary[0].name: round(360.0 / each.order, 3)}
    return 1, None


def _has_images(ready: Prepared, motion: Motion, mine: NDArray[np.bool_]) -> bool:
    """Whether nearly all of the area of some samples (n,) is carried onto others of them."""
    samples, rows = ready.samples, np.flatnonzero(mine)
    point, normal, area = samples.point[rows], samples.normal[rows], np.nan_to_num(samples.area[rows])
    near = cKDTree(point).query(motion.points(point), k=min(8, len(rows)), distance_upper_bound=samples.max_gap)
    distance, which = (each.reshape(len(rows), -1) for each in near)
    is_near = np.isfinite(distance)
    alike = (motion.directions(normal)[:, None] * normal[np.where(is_near, which, 0)]).sum(axis=2) >= _NORMAL
    return bool(area[(is_near & alike).any(axis=1)].sum() >= _AGREES * area.sum())
