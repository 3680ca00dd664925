"""Rotary axes of a machine: where they turn the tool, and which angles hold a given tool axis.

An axis is counted from the part to the tool, and its positive sense is that of the tool relative to the part (ISO 841): what the
tool's direction t becomes is R(d1, angle1) R(d2, angle2) t, d1 next to the part. So all machines of two rotary axes are one:
which of them carry the part and which the tool does not matter to the direction. A limit of either axis is a circle on the sphere
of directions: about d1 at the end of the second axis, about R(d1, angle1) d2 at an end of the first. Between these circles
nothing changes (`kernels.limits`).
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from cad_io.arrays import Floats, Ints, Record, cross
from plan_cutters.kernels.codes import ON_LIMIT, PARALLEL

#: Tool axes this near to the direction of the axis next to the part, rad, are held only with fast turns of it: singular.
SINGULAR = math.radians(2.0)
#: Angles of a single rotary axis that are searched are so far apart, rad.
STEP = math.radians(2.0)


def turned(direction: Floats, angle: Floats | float, vector: Floats) -> Floats:
    """Vectors (..., 3) turned about a unit direction (3,) by angles (...,), rad."""
    cosine, sine = np.cos(angle)[..., None], np.sin(angle)[..., None]
    along = (vector @ direction)[..., None] * direction
    return np.asarray(along + cosine * (vector - along) + sine * cross(direction, vector))


def angle_about(direction: Floats, start: Floats, end: Floats) -> Floats:
    """Angles (...,), rad, by which vectors (..., 3) turn about a unit direction (3,) into others."""
    across = cross(start, end) @ direction
    return np.asarray(np.arctan2(across, (start * end).sum(axis=-1) - (start @ direction) * (end @ direction)))


def within(angle: Floats, low: float, high: float) -> Floats:
    """The turn of each angle (...,) that lies between two limits, nan where none does; the one nearest to 0, where several do."""
    turn = 2.0 * math.pi
    near = angle - turn * np.round(angle / turn)
    least, most = np.ceil((low - ON_LIMIT - near) / turn), np.floor((high + ON_LIMIT - near) / turn)
    turns = np.minimum(np.maximum(0.0, least), most)
    return np.asarray(np.where(least <= most, near + turn * turns, np.nan))


@dataclass(frozen=True, eq=False, repr=False)
class Kinematics(Record):
    """The rotary axes of a machine under one setup, all directions in one frame."""

    direction: Floats  #: (k, 3) float: unit directions of the axes at zero angles, k at most 2, the one next to the part first.
    limit: Floats  #: (k, 2) float: least and largest angle of each, rad; infinite: none.
    tool: Floats  #: (3,) float: unit direction from the tip to the spindle at zero angles.

    def seen_from(self, turn: Floats) -> "Kinematics":
        """The same in another frame, whose coordinates a rotation (3, 3) makes of these."""
        return Kinematics(self.direction @ turn.T, self.limit, self.tool @ turn.T)

    def turning(self) -> tuple["Kinematics", list[int]]:
        """The same machine with the axes alone that turn its tool, and their numbers here.

        An axis whose limits leave one angle stands still, and so does one that lies along the tool, with nothing between.
        """
        return self._turning

    @cached_property
    def _turning(self) -> tuple["Kinematics", list[int]]:
        turning_axes: list[int] = []
        direction, tool = np.array(self.direction), self.tool
        for k in range(len(direction) - 1, -1, -1):
            low, high = self.limit[k]
            if high - low <= PARALLEL:
                still = np.array(0.5 * (low + high))
                tool = turned(direction[k], still, tool)
                for other in turning_axes:
                    direction[other] = turned(direction[k], still, direction[other])
            elif turning_axes or np.linalg.norm(cross(direction[k], tool)) > PARALLEL:
                turning_axes.insert(0, k)
        if len(turning_axes) == len(direction):
            return self, turning_axes
        return Kinematics(direction[turning_axes], self.limit[turning_axes], tool), turning_axes

    def axis(self, angle: Floats) -> Floats:
        """Tool axes (n, 3) at angles (n, k), rad."""
        return self.carried(self.tool, angle)

    def carried(self, vector: Floats, angle: Floats) -> Floats:
        """Directions (n, 3) of what points along a vector (3,) at zero angles and turns with the tool, at angles (n, k), rad."""
        vectors = np.broadcast_to(vector, (len(angle), 3))
        for k in range(len(self.direction) - 1, -1, -1):
            vectors = turned(self.direction[k], angle[:, k], vectors)
        return np.asarray(vectors)

    def angles(self, axis: Floats) -> Floats:
        """Angles (n, 2, k), rad, of the two solutions that hold tool axes (n, 3); nan where one does not, whatever the limits.

        Within the limits, where another turn brings them there. A machine of fewer than two rotary axes has one solution at
        most, the second is nan.
        """
        angles = np.full((len(axis), 2, len(self.direction)), np.nan)
        if len(self.direction) == 0:
            return angles
        if len(self.direction) == 1:
            held = np.abs(axis @ self.direction[0] - self.tool @ self.direction[0]) <= self._reach()
            angles[held, 0, 0] = angle_about(self.direction[0], self.tool, axis[held])
            return angles
        first, second = self.direction
        start, most, base = self.swing
        share = (axis @ first - base) / most
        held = np.abs(share) <= 1.0 + self._reach()
        swing = np.arccos(np.clip(share[held], -1.0, 1.0))
        for i, sign in enumerate((1.0, -1.0)):
            angles[held, i, 1] = start + sign * swing
            angles[held, i, 0] = angle_about(first, turned(second, angles[held, i, 1], self.tool), axis[held])
        return angles

    def positions(self, axis: Floats) -> tuple[Floats, NDArray[np.int8], NDArray[np.bool_]]:
        """Find the angles that hold tool axes (n, 3).

        They are: both solutions (n, 2, k), rad, nan where beyond a limit; the one to take (n,), that with the smaller angles, -1
        for none; and where (n,) the axis next to the part is near to the tool axis, so that the position is singular.
        """
        machine, turning = self.turning()
        if machine is not self:
            mine, taken, singular = machine.positions(axis)
            # Held by one solution; axes that stand still are where their limits have them, next to 0.
            positions = np.full((len(axis), 2, len(self.direction)), np.nan)
            positions[taken >= 0, 0] = np.clip(0.0, *self.limit.T)
            positions[:, :, turning] = mine
            return positions, taken, singular
        positions = self.angles(axis)
        for k, (low, high) in enumerate(self.limit):
            positions[:, :, k] = within(positions[:, :, k], low, high)
        if len(self.direction) == 0:
            held = np.linalg.norm(cross(axis, self.tool), axis=1) <= self._reach()
            taken = np.where(held & (axis @ self.tool > 0.0), 0, -1)
            return positions, taken.astype(np.int8), np.zeros(len(axis), bool)
        sine = np.linalg.norm(cross(axis, self.direction[0]), axis=1)
        if len(self.direction) == 2:
            # On the singular axis itself any angle of the first one serves, so one within its limits does.
            low, high = self.limit[0]
            still = min(max(0.0, low), high)
            on = (sine <= PARALLEL)[:, None] & np.isfinite(positions[:, :, 1])
            positions[:, :, 0] = np.where(on & ~np.isfinite(positions[:, :, 0]), still, positions[:, :, 0])
        unknown = np.isnan(positions).any(axis=2)
        positions[unknown] = np.nan
        size = np.where(unknown, np.inf, np.abs(np.where(np.isnan(positions), 0.0, positions)).sum(axis=2))
        taken = np.where(np.all(unknown, axis=1), -1, size.argmin(axis=1))
        singular = (sine <= math.sin(SINGULAR)) if len(self.direction) == 2 else np.zeros(len(axis), bool)
        return positions, taken.astype(np.int8), singular

    def allows(self, axis: Floats) -> NDArray[np.bool_]:
        """Which tool axes (n, 3) the machine can hold."""
        return np.asarray(self.positions(axis)[1] >= 0)

    def allows_about(self, axis: Floats, swing: Floats) -> NDArray[np.bool_]:
        """Where the machine can hold every tool axis within an angle (n,), rad, of axes (n, 3), all by one of its solutions.

        Of a machine that turns a tool in one plane: every one in that plane. False as well where that is not known.
        """
        machine, _ = self.turning()
        if len(machine.direction) < 2:
            return machine._allows_in_plane(axis, swing)
        (first, second), (start, most, base) = machine.direction, machine.swing
        away = _between(axis, first)
        shares = [(np.cos(np.clip(away + sign * swing, 0.0, math.pi)) - base) / most for sign in (-1.0, 1.0)]
        known = (np.abs(shares) <= 1.0).all(axis=0)
        ends = np.arccos(np.clip(shares, -1.0, 1.0))
        middle, half = 0.5 * (ends[0] + ends[1]), 0.5 * (ends[1] - ends[0])
        low, high = machine.limit[1]
        one = np.zeros(len(axis), bool)
        # The solution whose second angle has room in the whole cap is the one that holds its middle: of the other one, the first
        # angle may be beyond its limits all over the cap.
        held = np.asarray(np.isfinite(machine.positions(axis)[0]).all(axis=2))
        for i, sign in enumerate((1.0, -1.0)):
            placed = within(start + sign * middle, float(low), float(high))
            one |= held[:, i] & (placed - half >= low - ON_LIMIT) & (placed + half <= high + ON_LIMIT)
        low, high = machine.limit[0]
        if high - low < 2.0 * math.pi:
            for end in (low, high):
                across = turned(first, np.array(end), second)
                one &= np.abs(_between(axis, across) - math.acos(min(1.0, max(-1.0, float(second @ machine.tool))))) > swing
        return np.asarray(known & one)

    def _allows_in_plane(self, axis: Floats, swing: Floats) -> NDArray[np.bool_]:
        """`allows_about` of a machine with one axis, or none, that turns the tool."""
        held = self.allows(axis)
        if not len(self.direction) or abs(float(self.tool @ self.direction[0])) > PARALLEL:
            return np.asarray(held & (swing <= 0.0))
        low, high = self.limit[0]
        placed = within(self.angles(axis)[:, 0, 0], float(low), float(high))
        return np.asarray(held & (placed - swing >= low - ON_LIMIT) & (placed + swing <= high + ON_LIMIT))

    def circles(self) -> Floats:
        """Circles (m, 4) on the sphere of directions, a unit direction and a cosine each: across them what is allowed changes."""
        if len(self.direction) == 0:
            return np.array([[*self.tool, math.cos(PARALLEL)]])
        if len(self.direction) == 1:
            first, (low, high) = self.direction[0], self.limit[0]
            along = float(self.tool @ first)
            rows = [[*first, along - PARALLEL], [*first, along + PARALLEL]]
            for end in (low, high):
                if high - low < 2.0 * math.pi:
                    across = cross(first, turned(first, np.array(end), self.tool))
                    rows.append([*(across / np.linalg.norm(across)), 0.0])
            return np.array(rows)
        first, second = self.direction
        _, most, base = self.swing
        rows = [[*first, base + most], [*first, base - most]]
        for k, (low, high) in enumerate(self.limit):
            if high - low >= 2.0 * math.pi:
                continue
            for end in (low, high):
                if k == 1:
                    rows.append([*first, float(turned(second, np.array(end), self.tool) @ first)])
                else:
                    rows.append([*turned(first, np.array(end), second), float(second @ self.tool)])
        return np.array(rows)

    def aims(self) -> Floats:
        """The tool axes (a, 3) that there are where fewer than two axes turn the tool, `STEP` apart; else none."""
        if len(self.direction) == 2:
            return np.zeros((0, 3))
        if len(self.direction) == 0:
            return self.tool[None]
        low, high = (float(np.clip(end, -math.pi, math.pi)) for end in self.limit[0])
        whole = high - low > 2.0 * math.pi - STEP
        count = max(1, math.ceil((high - low) / STEP))
        return self.axis(np.linspace(low, high, count + (not whole), endpoint=not whole)[:, None])

    @cached_property
    def swing(self) -> tuple[float, float, float]:
        """How the second axis moves the tool towards the first and away: the angle at which it is nearest, the amplitude, the
        middle, of the cosine between the two.
        """
        first, second = self.direction
        along = float(self.tool @ second)
        remainder = self.tool - along * second
        a, b = float(first @ remainder), float(first @ cross(second, remainder))
        return math.atan2(b, a), math.hypot(a, b), float(first @ second) * along

    def _reach(self) -> float:
        # What rounding may take an axis out of reach by.
        return 1e-12 if len(self.direction) == 2 else PARALLEL


def _between(axis: Floats, direction: Floats) -> Floats:
    """Angles (n,), rad, of unit axes (n, 3) to a unit direction (3,)."""
    return np.asarray(np.arctan2(np.linalg.norm(cross(axis, direction), axis=1), axis @ direction))


def positions(
    machines: Sequence[Kinematics | None], axis: Floats, which: Ints
) -> tuple[Floats, NDArray[np.int8], NDArray[np.bool_]]:
    """Positions of rotary axes that hold tool axes, each in the setup that serves its sample.

    `machines`: in each setup. `axis` (n, 3) float: unit tool axes; nan where there is none. `which` (n,) int32: the setup of
    each, -1 for none. Returns as `Kinematics.positions` gives them.
    """
    first = machines[0]
    assert first is not None, "a machine without rotary axes has no positions"
    angles, taken, singular = first.positions(axis)
    for k, each in enumerate(machines[1:], 1):
        rows = np.flatnonzero(which == k)
        if len(rows) and each is not None:
            angles[rows], taken[rows], singular[rows] = each.positions(axis[rows])
    return angles, taken, singular
