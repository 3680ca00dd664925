"""Tool axes between samples: a field that turns steadily from each node of a face's grid to the next, and how much room axes
leave.

Room tells what to try first, never what is safe: what is tried goes through the proof.
"""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from cad_io.arrays import FaceGrid, Floats, cross
from plan_cutters.kernels.codes import OFFSET_OF, RISE
from plan_cutters.scene.conditions import Conditions, Context

#: Axes of neighbouring nodes that are farther apart, rad, have none between them that is worth looking at.
_APART = math.radians(60.0)
#: What rounding may turn an axis by, rad.
_ROUNDING = 1e-9


@dataclass(frozen=True, slots=True, eq=False)
class AxisField:
    """Tool axes at the nodes of a face's grid, and between them: the sum of the four around, weighted as in a bilinear map.

    Beyond the grid the field stays as at its rim.

    `u`, `v` (nu,), (nv,) float: grid lines; those of a closed direction have the first one again, a period later. `axis` (nu, nv,
    3) float: unit, part coordinates; nan where a node has none, and then in all that is next to it.
    """

    u: Floats
    v: Floats
    axis: Floats

    @classmethod
    def of(cls, grid: FaceGrid, axis: Floats) -> "AxisField":
        """Lay axes (nu, nv, 3) over a face's grid."""
        u, v = grid.u, grid.v
        if grid.closed_u:
            u, axis = np.append(u, u[0] + grid.span[1] - grid.span[0]), np.concatenate([axis, axis[:1]])
        if grid.closed_v:
            v, axis = np.append(v, v[0] + grid.span[3] - grid.span[2]), np.concatenate([axis, axis[:, :1]], axis=1)
        return cls(u, v, axis)

    def at(self, uv: Floats) -> Floats:
        """Unit axes (n, 3) at parameters (n, 2); nan where there is none."""
        (i, s), (j, t) = _place(self.u, uv[:, 0]), _place(self.v, uv[:, 1])
        corners = [(i, j, (1.0 - s) * (1.0 - t)), (i + 1, j, s * (1.0 - t)), (i, j + 1, (1.0 - s) * t), (i + 1, j + 1, s * t)]
        axes = [self.axis[np.minimum(a, len(self.u) - 1), np.minimum(b, len(self.v) - 1)] for a, b, _ in corners]
        total = np.zeros((len(uv), 3))
        apart = np.zeros(len(uv))
        for k, (_, _, weight) in enumerate(corners):
            # A node without weight has no say, known or not.
            total += np.where(weight[:, None] > 0.0, weight[:, None] * axes[k], 0.0)
            for m in range(k):
                both = (weight > 0.0) & (corners[m][2] > 0.0)
                apart = np.where(both, np.maximum(apart, angle_between(axes[k], axes[m])), apart)
        length = np.linalg.norm(total, axis=1)
        total[~((apart <= _APART) & (length > 0.0))] = np.nan
        return np.asarray(total / np.linalg.norm(total, axis=1)[:, None])

    def within(self, middle: Floats, span: Floats) -> tuple[Floats, Floats]:
        """The axis (n, 3) in the middle of rectangles (n, 2) of parameters, and how far from it any other one in it is, rad.

        nan where the field has no axis somewhere in a rectangle. Between its ends and the grid lines in it the axes lie between
        those at the corners, so that the farthest of these is the farthest of all.
        """
        low, high = middle - 0.5 * span, middle + 0.5 * span
        marks = [_marks(lines, low[:, k], high[:, k]) for k, lines in enumerate((self.u, self.v))]
        centre, swing = self.at(middle), np.zeros(len(middle))
        for a in marks[0]:
            for b in marks[1]:
                there = self.at(np.column_stack([a, b]))
                swing = np.maximum(swing, angle_between(centre, there))
        return centre, swing + _ROUNDING


def _place(lines: Floats, value: Floats) -> tuple[NDArray[np.intp], Floats]:
    """The number of the grid line before each value, and how far the value is on the way to the next one, 0 to 1."""
    if len(lines) < 2:
        return np.zeros(len(value), np.intp), np.zeros(len(value))
    i = np.clip(np.searchsorted(lines, value, side="right") - 1, 0, len(lines) - 2)
    return i, np.clip((value - lines[i]) / (lines[i + 1] - lines[i]), 0.0, 1.0)


def _marks(lines: Floats, low: Floats, high: Floats) -> list[Floats]:
    """The ends of intervals, and grid lines in them: nan in an interval that has several."""
    first, last = np.searchsorted(lines, low, side="right"), np.searchsorted(lines, high, side="left")
    inner = np.where(last > first, lines[np.minimum(first, len(lines) - 1)], low)
    return [low, np.where(last - first > 1, np.nan, inner), high]


def angle_between(a: Floats, b: Floats) -> Floats:
    """Angles (n,), rad, between unit vectors (n, 3), exact where they are small."""
    return np.asarray(2.0 * np.arctan2(np.linalg.norm(a - b, axis=-1), np.linalg.norm(a + b, axis=-1)))


def held_within(axis: Floats, swing: Floats, conditions: Conditions) -> NDArray[np.bool_]:
    """Where a machine holds every tool axis within an angle (n,), rad, of some axes (n, 3); nan: it does not."""
    known = np.flatnonzero(np.isfinite(axis).all(axis=1) & np.isfinite(swing))
    axis, swing, held = axis[known], swing[known], np.zeros(len(axis), bool)
    good = conditions.allows(axis)
    if conditions.kinematics is not None:
        good &= conditions.kinematics.allows_about(axis, swing)
    if conditions.ranges.limit_cos > -1.0:
        away = angle_between(axis, np.broadcast_to(conditions.setup, axis.shape))
        good &= away + swing <= math.acos(min(1.0, conditions.ranges.limit_cos))
    held[known] = good
    return held


#: Tilts, rad, and rotations that are compared.
_TILTS, _ROTATIONS = np.radians([20.0, 30.0, 40.0, 50.0, 60.0, 70.0]), 12
#: What room to the gouging bound is worth beside nearness to the posture that is known, both from 0 to about 1.
_WORTH = 3.0


def margin(axis: Floats, normal: Floats, tensor: Floats, context: Context) -> NDArray[np.float64]:
    """Room (n,) to the local gouging bound across the lean, in sines of the tilt of a flat end; -inf where it does not touch.

    `axis`, `normal` (n, 3) float: unit. `tensor` (n, 3, 3) float: second fundamental form in part coordinates, 1/mm, concave
    positive.
    """
    mode = context.outer_tool.mode[0]
    cosine = (axis * normal).sum(axis=1)
    across = cross(normal, axis)
    sine = np.linalg.norm(across, axis=1)
    t = across / np.maximum(sine, 1e-12)[:, None]
    bend = np.einsum("ni,nij,nj->n", t, tensor.reshape(-1, 3, 3), t)
    # Upright, a ball has the curvature of its tip.
    ratio = np.maximum(sine, 1e-12)
    remainder = ratio / (mode[OFFSET_OF] + mode[RISE] * ratio) - bend
    return np.asarray(np.where(cosine > -1e-9, context.cutter.radius * remainder, -np.inf))


def roomiest(normal: Floats, direction: Floats, tensor: Floats, axis: Floats, context: Context) -> tuple[Floats, Floats]:
    """Of some postures the one with most room that is not far from a known one; that one where there is none.

    `normal`, `direction` (n, 3) float: unit normals and larger principal directions. `tensor` (n, 3, 3) float. `axis` (n, 3)
    float: of the postures that are known. Returns `axis, tilt_direction` (n, 3) float.
    """
    (low, high), other = context.conditions.postures.tilt, np.cross(normal, direction)
    best, side, most = axis.copy(), direction.copy(), np.full(len(axis), -np.inf)
    for tilt in (each for each in _TILTS if low <= each <= high):
        for turn in np.arange(_ROTATIONS) * (2.0 * np.pi / _ROTATIONS):
            tilt_direction = np.cos(turn) * direction + np.sin(turn) * other
            tried = np.cos(tilt) * normal + np.sin(tilt) * tilt_direction
            worth = (tried * axis).sum(axis=1) + _WORTH * margin(tried, normal, tensor, context)
            better = np.flatnonzero(worth > most)
            better = better[context.conditions.allows(tried[better])]
            best[better], side[better], most[better] = tried[better], tilt_direction[better], worth[better]
    return best, side
