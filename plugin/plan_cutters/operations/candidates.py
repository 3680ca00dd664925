"""Candidates: the tool axes that a fixed orientation may have, in the coordinates of the machine's rotary axes.

Angles are rounded to the digits of a control before anything is probed, so what is proved is the orientation that is set.
"""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from cad_io.arrays import Floats, SurfaceSamples
from plan_cutters.domain.kinematics import Kinematics
from plan_cutters.domain.own_process import CONTROL_DIGITS as DIGITS
from plan_cutters.scene.conditions import Conditions

#: A direction is along a rotary axis where their cosine is less below 1 than this: 0.008 deg.
_ALONG = 1e-8
#: Sums of angles that differ by less are the same position, deg.
_SAME_DEG = 0.01
#: Distance of grid angles unless one is requested, rad.
STEP = math.radians(5.0)
#: Tool axes nearer than this are one, rad.
_SAME = math.radians(10.0**-DIGITS)
#: Faces whose directions are looked at, at most, the largest first, and how far normals of a plane may differ.
_FACES, _EVEN = 200, 1e-9


@dataclass(frozen=True, slots=True)
class Orientations:
    """The orientations that a machine can be set to in one setup.

    Attributes
    ----------
    conditions : Conditions
    kinematics : Kinematics
        The machine's; one that turns about the setup axis and across it where the machine names none.
    names : tuple of str
        Of its two axes.
    """

    conditions: Conditions
    kinematics: Kinematics
    names: tuple[str, str]

    @classmethod
    def of(cls, conditions: Conditions) -> "Orientations":
        """Find those of a machine; options see to it that it has two rotary axes, or none that is named."""
        machine, kinematics = conditions.machine, conditions.kinematics
        if kinematics is None:
            frame = conditions.frame
            free = np.full((2, 2), math.inf) * (-1.0, 1.0)
            return cls(conditions, Kinematics(frame[[2, 1]], free, frame[2]), ("azimuth", "tilt"))
        first, second = machine.rotary
        return cls(conditions, kinematics, (first.name, second.name))

    def set_to(self, angle: Floats) -> tuple[Floats, Floats]:
        """Angles (n, 2), deg, as a control shows them, and their axes (n, 3): those alone that the machine can hold."""
        shown = np.round(angle, DIGITS) + 0.0
        axis = self.kinematics.axis(np.radians(shown))
        held = self.conditions.allows(axis)
        low, high = np.degrees(self.kinematics.limit).T
        held &= ((shown >= low - 1e-9) & (shown <= high + 1e-9)).all(axis=1)
        return shown[held], axis[held]

    def along(self, direction: Floats) -> float:
        """+1 or -1 where the axis next to the part turns it about a direction, or the other way; else 0."""
        cosine = float(self.kinematics.direction[0] @ direction)
        return math.copysign(1.0, cosine) if abs(cosine) > 1.0 - _ALONG else 0.0

    def turned(self, angle: Floats, direction: Floats, turn: float) -> tuple[Floats, Floats, NDArray[np.bool_]]:
        """Angles (n, 2), deg, with the part turned about a direction, rad, by the axis next to it: the axes, and which can be."""
        along = self.along(direction)
        first = angle[:, 0] + math.degrees(turn) * along
        shown = np.round(np.column_stack([first - 360.0 * np.round(first / 360.0), angle[:, 1]]), DIGITS) + 0.0
        held = self.kinematics.axis(np.radians(shown))
        low, high = np.degrees(self.kinematics.limit).T
        can = self.conditions.allows(held) & ((shown >= low - 1e-9) & (shown <= high + 1e-9)).all(axis=1)
        return np.asarray(shown, float), held, np.asarray(can & (along != 0.0))

    def near(self, axis: Floats) -> tuple[Floats, Floats]:
        """The angles that come nearest to axes (n, 3), and the axes that they hold: those alone that the machine can hold."""
        angle, taken, _ = self.kinematics.positions(axis)
        held = np.flatnonzero(taken >= 0)
        return self.set_to(np.degrees(angle[held, taken[held]]))

    def other(self, axis: Floats, angle: Floats) -> Floats | None:
        """The other angles (2,), deg, that hold an axis (3,); None where there are none."""
        return self.others(axis[None], angle[None])[0]

    def others(self, axis: Floats, angle: Floats) -> list[Floats | None]:
        """The other angles (2,), deg, that hold each of some axes (n, 3) beside its angles (n, 2); None where there are none."""
        both = np.degrees(self.kinematics.positions(axis)[0])
        away = np.abs((both - angle[:, None] + 180.0) % 360.0 - 180.0).sum(axis=2)
        other = both[np.arange(len(both)), np.nan_to_num(away, nan=-1.0).argmax(axis=1)]
        there = np.isfinite(other).all(axis=1) & (np.nan_to_num(away, nan=-1.0).max(axis=1) > _SAME_DEG)
        return [shown if is_there else None for shown, is_there in zip(np.round(other, DIGITS) + 0.0, there, strict=True)]

    def grid(self, step: float) -> tuple[Floats, Floats]:
        """Angles (n, 2) that are whole multiples of a step, deg, and their axes.

        Nearer to the first axis fewer multiples of its angle are taken, so that the axes are about equally far apart.
        """
        start = self.kinematics.swing[0]
        turns = _multiples(self.kinematics.limit[1], step)
        axes = []
        for second in turns:
            arm = self.kinematics.axis(np.array([[0.0, math.radians(second)]]))[0]
            sine = float(np.linalg.norm(np.cross(arm, self.kinematics.direction[0])))
            every = max(1, int(1.0 / max(sine, 1e-9))) if sine > 1e-9 else 10**9
            first = _multiples(self.kinematics.limit[0], step)
            numbers = np.round(first / step).astype(np.int64)
            axes.append(np.column_stack([first[numbers % every == 0], np.full((numbers % every == 0).sum(), second)]))
        angle = np.concatenate(axes)
        # Of the two solutions of an axis the one with the smaller second angle comes first, and stays.
        angle = angle[np.lexsort((np.abs(angle[:, 0]), np.abs(angle[:, 1] - math.degrees(start))))]
        return self.set_to(angle)


def _multiples(limit: Floats, step: float) -> Floats:
    """Whole multiples of a step, deg, within limits (2,), rad: one turn at most."""
    low, high = max(float(np.degrees(limit[0])), -180.0), min(float(np.degrees(limit[1])), 180.0)
    whole = high - low >= 360.0 - 1e-9
    numbers = np.arange(math.ceil(low / step - 1e-9), math.floor(high / step + 1e-9) + 1)
    return np.asarray((numbers[1:] if whole and len(numbers) * step > 360.0 else numbers) * step, float)


def directions(samples: SurfaceSamples, setup: Floats) -> Floats:
    """Directions (n, 3) that a tool axis may well have: the part's axes, normals of planes, axes of revolved and ruled faces."""
    return np.concatenate([setup[None], np.eye(3), -np.eye(3), *face_directions(samples)])


def face_directions(samples: SurfaceSamples) -> tuple[Floats, Floats]:
    """Normals (n, 3) of plane faces, and directions (m, 3) of walls: axes of revolved and ruled faces. The largest face first."""
    floors, walls = list[Floats](), list[Floats]()
    judged = samples.unjudged < 0
    area = np.bincount(samples.face[judged], np.nan_to_num(samples.area[judged]))
    for number in np.argsort(-area, kind="stable")[:_FACES]:
        normal = samples.normal[judged & (samples.face == number)]
        if len(normal) and np.ptp(normal, axis=0).max() <= _EVEN:
            floors.append(normal[0])
        elif len(normal) > 3:
            spread, axes = np.linalg.svd(normal - normal.mean(axis=0), full_matrices=False)[1:]
            if spread[2] <= _EVEN * math.sqrt(len(normal)):
                walls += [axes[2], -axes[2]]
    return np.array(floors).reshape(-1, 3), np.array(walls).reshape(-1, 3)


def apart(axis: Floats, least: float = _SAME, old: Floats | None = None) -> NDArray[np.int64]:
    """Which (k,) of axes (n, 3) are at least an angle, rad, from all earlier ones, and from old ones (m, 3)."""
    chord = 2.0 * math.sin(0.5 * least)
    selected = np.ones(len(axis), bool)
    if old is not None and len(old):
        selected &= cKDTree(old).query(axis, distance_upper_bound=chord)[0] > chord
    tree = cKDTree(axis)
    for i in range(len(axis)):
        if selected[i]:
            near = np.array(tree.query_ball_point(axis[i], chord))
            selected[near[near > i]] = False
    return np.flatnonzero(selected)


def neighbours(axis: Floats, spacing: float) -> Floats:
    """Six axes (6 n, 3) at an angle, rad, about each of some axes (n, 3)."""
    other = np.where(np.abs(axis[:, 2:]) < 0.9, (0.0, 0.0, 1.0), (1.0, 0.0, 0.0))
    u = np.cross(axis, other)
    u /= np.linalg.norm(u, axis=1)[:, None]
    v = np.cross(axis, u)
    turn = np.arange(6) * (math.pi / 3.0)
    out = math.cos(spacing) * axis[:, None] + math.sin(spacing) * (
        np.cos(turn)[:, None] * u[:, None] + np.sin(turn)[:, None] * v[:, None]
    )
    return np.asarray(out.reshape(-1, 3))


def candidates(where: Orientations, samples: SurfaceSamples, step: float | None, spacing: float = STEP) -> tuple[Floats, Floats]:
    """The first candidates of one setup.

    Parameters
    ----------
    where : Orientations
    samples : SurfaceSamples
    step : float, optional
        Angles are whole multiples of it, rad, where the machine's rotary axes lock at these alone. None: a grid, and the
        directions of the part.
    spacing : float
        Of that grid, rad.

    Returns
    -------
    angle : (m, 2) float
        deg.
    axis : (m, 3) float
    """
    angle, axis = where.grid(math.degrees(spacing if step is None else step))
    if step is None:
        own_angle, own_axis = where.near(directions(samples, where.conditions.setup))
        angle, axis = np.concatenate([own_angle, angle]), np.concatenate([own_axis, axis])
    high = where.conditions.postures.tilt[1]
    normal = samples.normal[samples.unjudged < 0]
    facing = _faces_any(axis, normal, math.cos(min(high, math.pi)))
    selected = np.flatnonzero(facing)
    selected = selected[apart(axis[selected])]
    return angle[selected], axis[selected]


def _faces_any(axis: Floats, normal: Floats, least: float) -> NDArray[np.bool_]:
    """Which axes (m,) face at least one normal."""
    if not len(normal):
        return np.zeros(len(axis), bool)
    nearest = cKDTree(normal).query(axis)[0]
    return np.asarray(1.0 - 0.5 * nearest**2 >= least - 1e-9)
