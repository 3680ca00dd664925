"""Tool axes for simultaneous motion: one at each sample, free there, of a wide strip, and turning as little as may be.

Of axes that lean a little or more to all sides, each sample takes one whose pass is about the widest of those that stand free;
it is drawn to the mean of those around it, as far as the certified test allows and its pass stays wide.
What comes out is a proposal: how much of the surface between the samples it serves is proved by `judging.between`.
"""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from cad_io.arrays import FaceGrid, Floats, SurfaceSamples, cross
from plan_cutters.domain.cutter import Cutter
from plan_cutters.domain.kinematics import SINGULAR, Kinematics, angle_about
from plan_cutters.domain.verdicts import ACCESSIBLE, UNJUDGED, Verdicts
from plan_cutters.judging.axes import AxisField, angle_between, margin
from plan_cutters.judging.cells import tensors
from plan_cutters.operations.passes import Paths, cut_by_tip
from plan_cutters.scene.conditions import Conditions, Context, probed, tilt_directions

Rows = NDArray[np.int64]
#: How often axes are drawn to their neighbours', at most, and which shares of the way are tried in turn.
_ROUNDS, _SHARES = 40, (1.0, 0.5, 0.2)
#: Smaller turns are not tried, rad.
_LEAST = math.radians(0.5)
#: Room to the local gouging bound that an axis must have to be drawn, unless it had less before.
_MARGIN = 0.05
#: Tilts of the axes that are tried, rad, each in so many directions about the normal.
_TILTS, _DIRECTIONS = np.radians([1.5, 3.0, 5.0, 8.0, 12.0, 18.0, 26.0, 36.0, 50.0, 65.0, 80.0]), 8
#: Passes whose widths differ by this factor are about as wide; smoothing narrows none by more.
_AS_WIDE = 0.9
#: Axes that are compared at once.
_AT_ONCE = 100_000
#: Nodes beside the samples take the mean of those around them, so many rings of them.
_RINGS = 2


@dataclass(frozen=True, slots=True, eq=False)
class _Test:
    """The certified test of axes at samples, and what passes take with them."""

    samples: SurfaceSamples
    context: Context
    tensor: Floats
    paths: Paths

    def pace(self, rows: Rows, axis: Floats) -> Floats:
        """Give what a mm of path cuts (m,) at samples with axes (m, 3), mm2; nan where the tool does not touch."""
        return cut_by_tip(self.context.cutter, self.samples, rows, axis, self.paths, turning=True).pace(
            self.paths, self.context.cutter
        )

    def margin(self, rows: Rows, axis: Floats) -> Floats:
        """Room (m,) to the local gouging bound of axes (m, 3)."""
        return margin(axis, self.samples.normal[rows], self.tensor[rows], self.context)

    def free(self, rows: Rows, axis: Floats) -> NDArray[np.bool_]:
        """Where the tool stands free at samples (m,) with axes (m, 3), leaning."""
        conditions, samples = self.context.conditions, self.samples
        normal, (low, high) = samples.normal[rows], conditions.postures.tilt
        tilt = angle_between(axis, normal)
        good = (tilt >= low) & (tilt <= high) & (self.margin(rows, axis) > 0.0)
        good[good] = conditions.allows(axis[good])
        side = tilt_directions(axis, normal, samples.direction_max[rows])
        met, _ = probed(np.flatnonzero(good), samples.point[rows], normal, axis, side, self.context.outer, conditions)
        return np.asarray(good & (met == -1))


class MovingAxes:
    """Axes for simultaneous motion of each cutter in each setup, found once for all plans of a part.

    `everywhere`: of each setup the verdicts by cutter.
    """

    def __init__(
        self, samples: SurfaceSamples, cutters: Sequence[Cutter], setups: Sequence[Conditions],
        everywhere: Sequence[Mapping[Cutter, Verdicts]], paths: Paths,
    ) -> None:  # fmt: skip
        self._samples, self._cutters, self._setups = samples, cutters, setups
        self._everywhere, self._paths = everywhere, paths
        self._known: dict[tuple[int, int], tuple[Floats, Floats]] = {}
        self._tensor = tensors(samples.normal, samples.direction_max, samples.curvature).reshape(len(samples), 3, 3)
        self._along = _along(samples)

    def widest(self, cutter: int, setup: int, rows: Rows) -> tuple[Floats, Floats]:
        """Axes (m, 3) of wide passes at samples (m,) that a cutter reaches in a setup, and what a mm of these cuts (m,), mm2.

        Each is the posture that was found, or was tested free, and no pass is narrower than with that by more than a tenth.
        """
        if (cutter, setup) not in self._known:
            n = len(self._samples)
            self._known[cutter, setup] = np.full((n, 3), np.nan), np.full(n, np.nan)
        axis, pace = self._known[cutter, setup]
        new = rows[np.isnan(axis[rows, 0])]
        test, known = self._test(cutter, setup), self._everywhere[setup][self._cutters[cutter]].axis
        some = max(1, _AT_ONCE // (len(_TILTS) * _DIRECTIONS))
        up = np.where((self._along @ self._setups[setup].setup)[:, None] < 0.0, -self._along, self._along)
        for part in (new[k : k + some] for k in range(0, len(new), some)):
            axis[part] = _widest(test, part, known[part], up[self._samples.face[part]])
            pace[part] = test.pace(part, axis[part])
        return axis[rows], pace[rows]

    def smooth(self, cutter: int, setup: int, rows: Rows) -> Floats:
        """The same, drawn to the mean of those around them as far as the tool stays free and the passes wide.

        Returns (n, 3) float: unit; nan at other samples.
        """
        axis, pace = np.full((len(self._samples), 3), np.nan), np.full(len(self._samples), np.nan)
        axis[rows], pace[rows] = self.widest(cutter, setup, rows)
        test = self._test(cutter, setup)
        if test.context.conditions.postures.full_turn:
            mine = np.isfinite(axis[:, 0])
            edge = self._samples.neighbours.astype(np.int64)
            axis = _smoothed(test, rows, edge[mine[edge].all(axis=1)], axis, _AS_WIDE * pace)
        return axis

    def held(self, cutter: int, setup: int, rows: Rows, axis: Floats) -> Verdicts:
        """The postures at samples (m,) with axes (n, 3) that are those found, or were tested with the contact at the sample."""
        verdicts, samples = self._everywhere[setup][self._cutters[cutter]], self._samples
        new = rows[(axis[rows] != verdicts.axis[rows]).any(axis=1)]
        verdict = np.full(len(samples), UNJUDGED, np.uint8)
        verdict[rows] = verdicts.verdict[rows]
        posture = {name: getattr(verdicts, name).copy() for name in ("axis", "tilt_direction", "tilt", "rotation", "shift")}
        posture["axis"][new], posture["rotation"][new], posture["shift"][new] = axis[new], -1, 0.0
        posture["tilt_direction"][new] = tilt_directions(axis[new], samples.normal[new], samples.direction_max[new])
        posture["tilt"][new] = angle_between(axis[new], samples.normal[new])
        verdict[new] = ACCESSIBLE
        return replace(verdicts, verdict=verdict, **posture)

    def _test(self, cutter: int, setup: int) -> _Test:
        own = self._cutters[cutter]
        return _Test(self._samples, Context.of(own, self._setups[setup]), self._tensor, self._paths)


def _along(samples: SurfaceSamples) -> Floats:
    """Of each face (largest number + 1) the direction (3,) that lies most along it: the one least in its normals."""
    result = np.zeros((int(samples.face.max(initial=0)) + 1, 3))
    for face in np.unique(samples.face).tolist():
        mine = samples.face == face
        normal, area = samples.normal[mine], np.nan_to_num(samples.area[mine])
        result[face] = np.linalg.eigh((normal * area[:, None]).T @ normal)[1][:, 0]
    return result


def _widest(test: _Test, rows: Rows, known: Floats, along: Floats) -> Floats:
    """Of axes about the normals of samples (m,), and known ones there (m, 3), free ones (m, 3) of about the widest passes.

    Of axes whose passes are about as wide, the known one comes first, and then those that lean most `along` (m, 3) the face.
    """
    low, high = test.context.conditions.postures.tilt
    tilt = np.unique(np.clip(_TILTS, max(low, _TILTS[0]), high))
    if not test.context.conditions.postures.full_turn or not len(rows):
        return known
    kinematics = test.context.conditions.kinematics
    machine = None if kinematics is None else kinematics.turning()[0]
    normal = test.samples.normal[rows]
    if machine is not None and len(machine.direction) == 1:
        # One axis leaves one way to lean: about it, from where the tool is nearest to the normal.
        both = np.concatenate([np.zeros(1), tilt, -tilt])
        turn = angle_about(machine.direction[0], machine.tool, normal)[:, None] + both
        axis, away = machine.axis(turn.reshape(-1, 1)).reshape(len(rows), -1, 3), np.zeros(len(both))
    else:
        turn = np.arange(_DIRECTIONS) * (2.0 * math.pi / _DIRECTIONS)
        first = tilt_directions(along, normal, test.samples.direction_max[rows])
        other = np.cross(normal, first)
        side = np.cos(turn)[:, None] * first[:, None] + np.sin(turn)[:, None] * other[:, None]
        axis = np.cos(tilt)[:, None, None] * normal[:, None, None] + np.sin(tilt)[:, None, None] * side[:, None]
        axis, away = axis.reshape(len(rows), -1, 3), np.tile(1.0 - np.cos(turn), len(tilt))
    axis = np.concatenate([known[:, None], axis], axis=1)
    every, flat = np.repeat(rows, axis.shape[1]), axis.reshape(-1, 3)
    pace, remainder = (each(every, flat).reshape(axis.shape[:2]) for each in (test.pace, test.margin))
    # What is known is free, whatever the room: the flat of a tip on a plane has none.
    remainder[:, 0] = np.inf
    good = np.isfinite(pace) & (remainder > 0.0)
    with np.errstate(divide="ignore", invalid="ignore"):
        step = np.floor(np.log(pace / np.where(good, pace, 0.0).max(axis=1)[:, None]) / math.log(_AS_WIDE) + 1e-9)
    rank = np.where(good, 4.0 * step + np.append(-1.0, away) + np.where(remainder < _MARGIN, 1e6, 0.0), np.inf)
    # The known posture is free: what comes behind it is not looked at.
    order = np.argsort(rank, axis=1, kind="stable")
    chosen, open_ = known.copy(), np.arange(len(rows))
    for place in range(axis.shape[1]):
        k = order[open_, place]
        open_, k = open_[k > 0], k[k > 0]
        open_, k = open_[np.isfinite(rank[open_, k])], k[np.isfinite(rank[open_, k])]
        if not len(open_):
            break
        free = test.free(rows[open_], axis[open_, k])
        chosen[open_[free]] = axis[open_[free], k[free]]
        open_ = open_[~free]
    return chosen


def _smoothed(test: _Test, rows: Rows, edge: Rows, axis: Floats, least: Floats) -> Floats:
    """Draw axes to the mean of those around them, where the tool stands free then and passes are as wide as `least` (n,)."""
    n = len(axis)
    both = np.concatenate([edge, edge[:, ::-1]])
    degree = np.bincount(both[:, 0], minlength=n)
    active = rows[(degree[rows] > 0) & np.isfinite(axis[rows, 0])]
    fresh = np.ones(n, bool)
    for _ in range(_ROUNDS):
        # Where nothing has turned since, what was tried fails again.
        stirred = fresh.copy()
        stirred[both[fresh[both[:, 1]], 0]] = True
        total = np.column_stack([np.bincount(both[:, 0], axis[both[:, 1], k], n) for k in range(3)])
        mean = total[active]
        length = np.linalg.norm(mean, axis=1)[:, None]
        mean = np.where(length > 1e-6, mean / np.maximum(length, 1e-6), axis[active])
        open_ = np.flatnonzero((angle_between(mean, axis[active]) > _LEAST) & stirred[active])
        fresh = np.zeros(n, bool)
        for share in _SHARES:
            if not len(open_):
                break
            some = active[open_]
            wanted = (1.0 - share) * axis[some] + share * mean[open_]
            wanted /= np.linalg.norm(wanted, axis=1)[:, None]
            good = test.free(some, wanted)
            good &= test.margin(some, wanted) >= np.minimum(_MARGIN, test.margin(some, axis[some]))
            good &= ~(test.pace(some, wanted) < least[some])
            axis[some[good]], fresh[some[good]] = wanted[good], True
            open_ = open_[~good]
        if not fresh.any():
            break
    return axis


def turning_times(samples: SurfaceSamples, rows: Rows, axis: Floats, kinematics: Kinematics, rate: Floats) -> Floats:
    """Find the seconds that each of k rotary axes needs at least for a mm of the contact's path at samples (m,).

    The angles of neighbouring samples say how fast each turns over the surface. Next to the singular direction the first one may
    stand at any angle: there it counts for nothing.

    `axis` (n, 3) float: unit tool axes at samples. `rate` (k,) float: rad/s. Returns (m, k, 3) float: gradients in the surface;
    times a unit direction in it, s/mm.
    """
    m, place = len(rows), np.full(len(samples), -1, np.int64)
    place[rows] = np.arange(m)
    edge = place[samples.neighbours.astype(np.int64)]
    edge = edge[(edge >= 0).all(axis=1)]
    one, other = np.concatenate([edge, edge[:, ::-1]]).T
    angle = kinematics.angles(axis[rows])[:, 0]
    step = angle[other] - angle[one]
    step -= 2.0 * math.pi * np.round(step / (2.0 * math.pi))
    first = samples.direction_max[rows]
    frame = np.stack([first, cross(samples.normal[rows], first)], axis=1)
    away = np.einsum("eij,ej->ei", frame[one], samples.point[rows[other]] - samples.point[rows[one]])
    known = np.isfinite(step).all(axis=1) & np.isfinite(away).all(axis=1)
    one, away, step = one[known], away[known], step[known]

    def summed(values: Floats) -> Floats:
        return np.stack([np.bincount(one, each, m) for each in values.reshape(len(one), -1).T], axis=1)

    square = summed(away[:, :, None] * away[:, None]).reshape(m, 2, 2)
    mixed = summed(away[:, :, None] * step[:, None]).reshape(m, 2, -1)
    gradient = np.linalg.pinv(square, rcond=1e-6, hermitian=True) @ mixed / rate
    near = np.linalg.norm(cross(axis[rows], kinematics.direction[:1]), axis=1) <= math.sin(SINGULAR)
    gradient[near, :, :-1] = 0.0
    return np.einsum("mik,mij->mkj", gradient, np.nan_to_num(frame))


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
