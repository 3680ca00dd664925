"""Linear travel: where a machine's linear axes stand at postures that were found, and how far that is beyond their limits.

The control point is the holder's nose: how far it is from the tip is all that is known of how long a tool is held. With every
axis at zero it lies at the machine's zero. From the part over the bed to the tool each axis moves what comes after it: at
positions q it is at base + J q, base and the columns of J given by the rotary axes alone, so q follows from where the nose must
be.
"""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from cad_io.arrays import Floats, Record
from plan_cutters.domain.cutter import Cutter
from plan_cutters.domain.kinematics import turned
from plan_cutters.domain.machine import Machine
from plan_cutters.domain.placement import Placement, frame_of
from plan_cutters.domain.shapes import modes
from plan_cutters.domain.verdicts import Verdicts
from plan_cutters.kernels.codes import BEYOND

#: Positions this close to a limit are on it, mm: a tool axis is held up to an angle of `kinematics.PARALLEL`.
ON_LIMIT = 1e-4
#: Linear axes whose directions span less than this, as the volume of unit vectors, do not move a tool to every point.
_FLAT = 1e-6


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Travel(Record):
    """Linear positions of a machine, sample by sample."""

    #: (n, 3) float: of its linear axes in their order, mm; nan where no posture is known or the axes cannot be found.
    position: Floats
    taken: NDArray[np.int8]  #: (n,) int8: which solution of its rotary axes that is; -1 for none.
    beyond: Floats  #: (n, 3) float: how far each axis is beyond its limits, mm; 0 within, nan as `position`.

    @property
    def outside(self) -> NDArray[np.bool_]:
        """Samples (n,) at which an axis is beyond its limits."""
        return np.asarray((self.beyond > 0.0).any(axis=1))


def unjudged(machine: Machine, placement: Placement | None) -> str | None:
    """Why nothing is said of linear travel; None where it is judged, empty where there is none to judge."""
    limited = any(axis.limits is not None for axis in machine.linear)
    placed = placement is not None and placement.origin is not None
    if not limited:
        return f"machine {machine.name} states no limits of linear axes" if placed else ""
    if not placed:
        return "where the part stands is not known; --setup takes a file that says it (origin)"
    if len(machine.linear) != 3:
        return f"machine {machine.name} has {len(machine.linear)} linear axes; travel is judged of three"
    if not machine.turns:
        return f"which rotary axes of machine {machine.name} hold the tool is not known"
    return None


def tips(cutter: Cutter, point: Floats, normal: Floats, verdicts: Verdicts) -> Floats:
    """Tips (n, 3) of a cutter at the postures with which it touches points (n, 3) of surfaces with unit normals (n, 3)."""
    result, point = np.full(point.shape, np.nan), verdicts.contact(point)
    # A flank may lie along a surface that is not quite at its tilt.
    for mode, off in ((mode, off) for off in (1e-9, BEYOND) for mode in modes(cutter)):
        at = np.isnan(result[:, 0]) & (verdicts.tilt >= mode.low - off) & (verdicts.tilt <= mode.high + off)
        n, f, a, tilt = normal[at], verdicts.tilt_direction[at], verdicts.axis[at], verdicts.tilt[at, None]
        centre = point[at] + (mode.radius + (cutter.allowance or 0.0)) * n
        # Across the axis, towards the contact.
        across = np.cos(tilt) * f - np.sin(tilt) * n
        result[at] = centre - mode.offset * across - mode.height * a
    return result


def travel(machine: Machine, placement: Placement, tip: Floats, axis: Floats, length: float) -> Travel:
    """Where the linear axes stand at postures.

    `machine`: with three linear axes, whose rotary axes, if any, are known. `placement`: with an origin. `tip`, `axis` (n, 3)
    float: in part coordinates; unit axes; nan where there is no posture. `length`: from the tip to the control point, along the
    axis, mm. Returns of the two solutions of the rotary axes the one that `Kinematics.positions` takes, unless it is outside and
    the other one is held and inside.
    """
    x = None if placement.x is None else np.array(placement.x)
    frame = frame_of(np.array(placement.z), x)
    kinematics = machine.kinematics(frame)
    if kinematics is None or placement.origin is None:
        raise ValueError("travel needs a machine whose rotary axes are known, and an origin")
    nose = (tip + length * axis - np.array(placement.origin)) @ frame.T
    angles, taken, _ = kinematics.positions(axis)
    each = [_positions(machine, angles[:, i], nose) for i in range(2)]
    over = [_beyond(machine, position) for position in each]
    first = np.maximum(taken, 0)
    rows = np.arange(len(tip))
    outside = np.stack([(one > 0.0).any(axis=1) for one in over], axis=1)
    # Without a posture or beyond a rotary limit the position is nan: such a solution is never taken instead.
    known = np.stack([np.isfinite(one).all(axis=1) for one in each], axis=1)
    other = 1 - first
    change = (taken >= 0) & outside[rows, first] & known[rows, other] & ~outside[rows, other]
    chosen = np.where(change, other, first)
    position, beyond = (np.stack(both, axis=1)[rows, chosen] for both in (each, over))
    position[taken < 0], beyond[taken < 0] = np.nan, np.nan
    return Travel(position, np.where(taken < 0, -1, chosen).astype(np.int8), beyond)


def _positions(machine: Machine, angle: Floats, nose: Floats) -> Floats:
    """Positions (n, 3) of the linear axes with the control point at `nose` (n, 3) and the rotary axes at angles (n, k), rad."""
    turn, base, ways, k = np.tile(np.eye(3), (len(nose), 1, 1)), np.zeros((len(nose), 3)), [], 0
    for axis in machine.axes:
        direction, point = np.array(axis.direction), np.array(axis.point)
        if axis.kind == "linear":
            ways.append(turn @ direction)
            continue
        # Rows are the turned unit vectors.
        rows = turned(direction, np.repeat(angle[:, k, None], 3, axis=1), np.broadcast_to(np.eye(3), turn.shape))
        base = base + np.einsum("nij,nj->ni", turn, point - point @ rows)
        turn, k = turn @ np.swapaxes(rows, 1, 2), k + 1
    across = np.stack(ways, axis=2)
    solvable = np.isfinite(across).all(axis=(1, 2))
    solvable[solvable] = np.abs(np.linalg.det(across[solvable])) > _FLAT
    positions = np.full(nose.shape, np.nan)
    positions[solvable] = np.linalg.solve(across[solvable], (nose - base)[solvable, :, None])[:, :, 0]
    return positions


def _beyond(machine: Machine, position: Floats) -> Floats:
    limits = np.array([axis.limits or (-math.inf, math.inf) for axis in machine.linear])
    over = np.maximum(limits[:, 0] - position, position - limits[:, 1])
    return np.where(np.isnan(position), np.nan, np.where(over > ON_LIMIT, over, 0.0))
