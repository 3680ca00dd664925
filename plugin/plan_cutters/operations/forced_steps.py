"""Forced steps: by how much the rotary axes must turn at least from one sample of a grid line to the next.

Whatever path the postures take along a line, one of its steps is about so large. Positions of the two rotary axes are looked at
on a grid of angles, which has both solutions, the limits and whole turns in it. The step is found by bisection: with a step d,
the positions that can be reached at the next sample are the free ones within d of those before.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import maximum_filter1d

from cad_io.arrays import Floats, SurfaceSamples
from plan_cutters.domain.kinematics import SINGULAR, Kinematics
from plan_cutters.domain.posture import tilt_direction
from plan_cutters.operations.free_tilts import holding, postures_of
from plan_cutters.plan_file.operations import ForcedStepEntry
from plan_cutters.stages.posture_maps import PostureMaps

Line = NDArray[np.int64]
Bits = NDArray[np.uint8]
#: Forced steps of rotary axes are known to this, deg.
RESOLUTION = 3.0
#: Directions of grid lines.
DIRECTIONS: tuple[Literal["u", "v"], ...] = ("u", "v")
#: Samples of lines that are looked at in each direction, about.
_SAMPLES = 400
#: Limits that are farther apart than this, deg, are none.
_TURNS = 720.0


@dataclass(frozen=True, slots=True, eq=False)
class Positions:
    """A grid of positions of two rotary axes.

    Attributes
    ----------
    kinematics : Kinematics
    first, second : (a,), (b,) float
        Angles, deg.
    round_ : (bool, bool)
        Whether the last angle of each is next to its first one.
    axis : (a, b, 3) float
        Tool axes.
    cone : (b,) bool
        Angles of the second axis at which the tool axis is within 2 deg of the first rotary axis.
    """

    kinematics: Kinematics
    first: Floats
    second: Floats
    round_: tuple[bool, bool]
    axis: Floats
    cone: NDArray[np.bool_]

    @classmethod
    def of(cls, kinematics: Kinematics) -> "Positions":
        """Lay the grid within the limits of a machine."""
        limit = np.degrees(kinematics.limit)
        free = tuple(bool(high - low > _TURNS) for low, high in limit)
        first, second = (
            np.arange(-180.0, 180.0, RESOLUTION) if free[k] else np.arange(limit[k, 0], limit[k, 1] + 1e-9, RESOLUTION)
            for k in range(2)
        )
        both = np.stack(np.meshgrid(first, second, indexing="ij"), axis=-1)
        axis = kinematics.axis(np.radians(both.reshape(-1, 2))).reshape(*both.shape[:2], 3)
        sine = np.linalg.norm(np.cross(axis[0], kinematics.direction[0]), axis=1)
        return cls(kinematics, first, second, (free[0], free[1]), axis, sine <= math.sin(SINGULAR))

    def free_at(self, maps: PostureMaps, row: int) -> Bits:
        """Mark (a, b) the positions that are free at a sample: those whose tilt is free at both rotations beside them, and those
        next to postures of the maps themselves.
        """
        k = len(maps.rotations)
        flat = self.axis.reshape(-1, 3)
        free = np.zeros(len(flat), np.uint8)
        begin, end = int(maps.offset[row * k]), int(maps.offset[row * k + k])
        if begin == end:
            return np.zeros(self.axis.shape[:2], np.uint8)
        most = math.cos(min(math.pi, float(maps.free[begin:end, 1].max()) + 1e-6))
        facing = np.flatnonzero(flat @ maps.normal[row] >= most)
        rows = np.full(len(facing), row)
        free[facing] = (holding(maps, rows, *postures_of(maps, rows, flat[facing])) >= 0).all(axis=1)
        free_axes = free.reshape(self.axis.shape[:2])
        node = np.arange(begin, end)
        turned = maps.rotations[_turns_of(maps, row)]
        direction = tilt_direction(maps.normal[row], maps.direction_max[row], turned)
        for part in (0.1, 0.5, 0.9):
            tilt = (1.0 - part) * maps.free[node, 0] + part * maps.free[node, 1]
            self._mark(free_axes, np.cos(tilt)[:, None] * maps.normal[row] + np.sin(tilt)[:, None] * direction)
        return free_axes

    def _mark(self, bits: Bits, axis: Floats) -> None:
        """Mark the positions next to both solutions of tool axes (p, 3), in every turn within the limits."""
        angle = np.degrees(self.kinematics.angles(axis)).reshape(-1, 2)
        angle = angle[np.isfinite(angle).all(axis=1)]
        low, high = np.degrees(self.kinematics.limit).T
        for turn in np.stack(np.meshgrid((-2, -1, 0, 1, 2), (-1, 0, 1)), axis=-1).reshape(-1, 2):
            mine = angle + 360.0 * turn
            number = []
            inside = np.ones(len(mine), bool)
            for k, grid in enumerate((self.first, self.second)):
                at = np.rint((mine[:, k] - grid[0]) / RESOLUTION).astype(np.int64)
                if self.round_[k]:
                    at %= len(grid)
                else:
                    inside &= (mine[:, k] >= low[k] - 1e-6) & (mine[:, k] <= high[k] + 1e-6)
                    at = np.clip(at, 0, len(grid) - 1)
                number.append(at)
            bits[number[0][inside], number[1][inside]] = 1

    def forces(self, bits: Sequence[Bits], step: int, *, cone: bool) -> bool:
        """Whether a line of samples cannot be followed with steps, of so many angles of the grid at most.

        Unless `cone`, turning the first axis counts for nothing where the tool axis is within 2 deg of it.
        """
        reached = bits[0]
        for each in bits[1:]:
            if not cone and self.cone.any():
                reached = reached.copy()
                reached[:, self.cone] |= reached[:, self.cone].any(axis=0, keepdims=True)
            for k, grid in enumerate((self.first, self.second)):
                wide = 2 * step + 1
                if wide >= 2 * len(grid):
                    reached = np.broadcast_to(reached.max(axis=k, keepdims=True), reached.shape)
                else:
                    reached = maximum_filter1d(reached, wide, axis=k, mode="wrap" if self.round_[k] else "constant")
            reached = reached & each
            if not reached.any():
                return True
        return False


def _turns_of(maps: PostureMaps, row: int) -> Line:
    """The rotations (m,) of the free intervals of one sample."""
    k = len(maps.rotations)
    return np.repeat(np.arange(k), np.diff(maps.offset[row * k : row * k + k + 1]))


def forced_steps(
    maps: PostureMaps, samples: SurfaceSamples, kinematics: Kinematics, reached: NDArray[np.bool_]
) -> list[ForcedStepEntry]:
    """Find the largest step that a line of samples forces, along u and along v.

    Parameters
    ----------
    maps : PostureMaps
        Of what the machine holds.
    samples : SurfaceSamples
    kinematics : Kinematics
        Of two rotary axes.
    reached : (n,) bool
        Samples with a posture. Where a line has none, it ends, and another one begins behind.
    """
    grid, known = Positions.of(kinematics), dict[int, Bits]()
    steps = []
    for along in DIRECTIONS:
        lines = _lines(samples, reached, along)
        whole = sum(map(len, lines))
        some = lines[:: max(1, -(-whole // _SAMPLES))]
        if not some:
            continue
        for row in np.unique(np.concatenate(some)).tolist():
            if row not in known:
                known[row] = grid.free_at(maps, row)
        bits = [[known[row] for row in line.tolist()] for line in some]
        least, line = _largest(grid, bits, cone=False)
        turning, _ = _largest(grid, bits, cone=True)
        steps.append(ForcedStepEntry(along=along, deg=least * RESOLUTION, turning_deg=turning * RESOLUTION,
                                     face=f"F{samples.face[some[line][0]]}", looked_at=len(some), lines=len(lines)))  # fmt: skip
    return steps


def _lines(samples: SurfaceSamples, reached: NDArray[np.bool_], along: Literal["u", "v"]) -> list[Line]:
    """Runs of at least two samples along lines of the grids."""
    lines = []
    for grid in samples.grids:
        for line in grid.index.T if along == "u" else grid.index:
            there = (line >= 0) & reached[np.maximum(line, 0)]
            runs = np.split(line.astype(np.int64), np.flatnonzero(there[1:] != there[:-1]) + 1)
            lines += [run for run in runs if len(run) > 1 and run[0] >= 0 and reached[run[0]]]
    return lines


def _largest(grid: Positions, lines: Sequence[Sequence[Bits]], *, cone: bool) -> tuple[int, int]:
    """The largest step that one of some lines forces, in angles of the grid, and that line's number."""
    low, high = 0, max(len(grid.first), len(grid.second))
    open_lines, worst = list(range(len(lines))), 0
    while low < high:
        middle = (low + high) // 2
        forced = [k for k in open_lines if grid.forces(lines[k], middle, cone=cone)]
        if forced:
            low, open_lines, worst = middle + 1, forced, forced[0]
        else:
            high = middle
    return low, worst
