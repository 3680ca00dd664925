"""Tool axes for simultaneous motion: one at each sample, free there, and turning as little as may be from each to the next.

Each begins with the posture that was found, and is drawn to the mean of those around it, as far as the certified test allows.
What comes out is a proposal: how much of the surface between the samples it serves is proved by `stages.between`.
"""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from cad_io.arrays import FaceGrid, Floats, SurfaceSamples
from plan_cutters.domain.verdicts import Verdicts
from plan_cutters.judging.axis_field import AxisField, angle_between
from plan_cutters.judging.margin import margin
from plan_cutters.judging.nodes import tensors
from plan_cutters.scene.conditions import Context
from plan_cutters.scene.threads import in_chunks

Rows = NDArray[np.int64]
#: How often axes are drawn to their neighbours', at most, and which shares of the way are tried in turn.
_ROUNDS, _SHARES = 40, (1.0, 0.5, 0.2)
#: Smaller turns are not tried, rad.
_LEAST = math.radians(0.5)
#: Room to the local gouging bound that an axis must have to be drawn, unless it had less before.
_MARGIN = 0.1
#: Nodes beside the samples take the mean of those around them, so many rings of them.
_RINGS = 2


@dataclass(frozen=True, slots=True, eq=False)
class _Test:
    """The certified test of axes at samples."""

    samples: SurfaceSamples
    context: Context
    tensor: Floats

    def margin(self, rows: Rows, axis: Floats) -> Floats:
        """Room (m,) to the local gouging bound of axes (m, 3)."""
        return margin(axis, self.samples.normal[rows], self.tensor[rows], self.context)

    def free(self, rows: Rows, axis: Floats) -> NDArray[np.bool_]:
        """Where the tool stands free at samples (m,) with axes (m, 3), leaning."""
        from plan_cutters.kernels.search.search import probe

        conditions, samples = self.context.conditions, self.samples
        normal, (low, high) = samples.normal[rows], conditions.postures.tilt
        tilt = angle_between(axis, normal)
        good = (tilt >= low) & (tilt <= high) & (self.margin(rows, axis) > 0.0)
        good[good] = conditions.allows(axis[good])
        across = axis - (axis * normal).sum(axis=1)[:, None] * normal
        length = np.linalg.norm(across, axis=1)[:, None]
        side = np.where(length > 1e-9, across / np.maximum(length, 1e-12), samples.direction_max[rows])
        met, which, some = np.full(len(rows), -2, np.int32), np.zeros(len(rows), np.int32), np.flatnonzero(good)
        point = samples.point[rows]

        def probed(piece: Rows) -> None:
            probe(piece, point, normal, axis, side, self.context.outer, conditions.obstacles.tree, met, which)

        in_chunks(probed, some, conditions.jobs)
        return np.asarray(good & (met == -1))


def moving_axes(samples: SurfaceSamples, rows: Rows, verdicts: Verdicts, context: Context) -> Floats:
    """Choose an axis for each sample of an operation.

    Parameters
    ----------
    samples : SurfaceSamples
    rows : (r,) int64
        Of the operation, each reached.
    verdicts : Verdicts
        With a posture of each.
    context : Context
        Of its cutter in its setup.

    Returns
    -------
    (n, 3) float
        Unit; nan where no axis is known.
    """
    n = len(samples)
    test = _Test(samples, context, tensors(samples.normal, samples.direction_max, samples.curvature).reshape(n, 3, 3))
    mine = np.zeros(n, bool)
    mine[rows] = True
    edge = samples.neighbours.astype(np.int64)
    edge = edge[mine[edge].all(axis=1)]
    axis = np.where(mine[:, None], verdicts.axis, np.nan)
    return _smoothed(test, rows, edge, axis)


def _smoothed(test: _Test, rows: Rows, edge: Rows, axis: Floats) -> Floats:
    """Draw axes to the mean of those around them, where the tool stands free then."""
    n = len(axis)
    both = np.concatenate([edge, edge[:, ::-1]])
    degree = np.bincount(both[:, 0], minlength=n)
    active = rows[(degree[rows] > 0) & np.isfinite(axis[rows, 0])]
    for _ in range(_ROUNDS):
        total = np.column_stack([np.bincount(both[:, 0], axis[both[:, 1], k], n) for k in range(3)])
        mean = total[active]
        length = np.linalg.norm(mean, axis=1)[:, None]
        mean = np.where(length > 1e-6, mean / np.maximum(length, 1e-6), axis[active])
        open_ = np.flatnonzero(angle_between(mean, axis[active]) > _LEAST)
        moved = False
        for share in _SHARES:
            if not len(open_):
                break
            some = active[open_]
            wanted = (1.0 - share) * axis[some] + share * mean[open_]
            wanted /= np.linalg.norm(wanted, axis=1)[:, None]
            good = test.free(some, wanted)
            good &= test.margin(some, wanted) >= np.minimum(_MARGIN, test.margin(some, axis[some]))
            axis[some[good]], moved = wanted[good], moved or bool(good.any())
            open_ = open_[~good]
        if not moved:
            break
    return axis


def fields(samples: SurfaceSamples, axis: Floats) -> dict[int, AxisField]:
    """Lay axes (n, 3) over the grids of faces; nodes beside those that have one take the mean of these."""
    made = {}
    for grid in samples.grids:
        there = grid.index >= 0
        nodes = np.full((*grid.index.shape, 3), np.nan)
        nodes[there] = axis[grid.index[there]]
        if np.isfinite(nodes[..., 0]).any():
            made[grid.face] = AxisField.of(grid, _filled(nodes, grid))
    return made


def _filled(nodes: Floats, grid: FaceGrid) -> Floats:
    """The same with means of neighbours in rings about what is known."""
    for _ in range(_RINGS):
        known = np.isfinite(nodes[..., 0])
        total, count = np.zeros_like(nodes), np.zeros(known.shape)
        zeroed = np.where(known[..., None], nodes, 0.0)
        for du in (-1, 0, 1):
            for dv in (-1, 0, 1):
                if du or dv:
                    total += _shifted(zeroed, (du, dv), grid)
                    count += _shifted(known.astype(float), (du, dv), grid)
        length = np.linalg.norm(total, axis=-1)
        new = ~known & (count > 0) & (length > 1e-6)
        nodes = np.where(new[..., None], total / np.maximum(length, 1e-6)[..., None], nodes)
    return nodes


def _shifted(values: Floats, step: tuple[int, int], grid: FaceGrid) -> Floats:
    """The values of the next nodes in a direction; 0 where there are none."""
    for k, (by, closed) in enumerate(zip(step, (grid.closed_u, grid.closed_v), strict=True)):
        if by == 0:
            continue
        values = np.roll(values, -by, axis=k)
        if not closed:
            end = [slice(None)] * values.ndim
            end[k] = slice(-1, None) if by > 0 else slice(0, 1)
            values[tuple(end)] = 0.0
    return np.asarray(values)
