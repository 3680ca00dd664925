"""Explain a machine in numbers and words: the share of all directions that it holds, its angles, its tool axes."""

import math
from typing import NamedTuple

import numpy as np

from cad_io.arrays import Floats
from plan_cutters.domain.checks import shown
from plan_cutters.domain.figures import angle, exact, percent
from plan_cutters.domain.kinematics import ON_LIMIT, SINGULAR
from plan_cutters.domain.machine import Axis, Machine
from plan_cutters.errors import MachineError

#: Directions on which shares are counted; a share is known to about 1 / sqrt(this) or better.
DIRECTIONS = 40_000
_IDENTITY = np.eye(3)


class Share(NamedTuple):
    """Shares of the sphere of directions, 0 to 1: held, and held near the singular direction."""

    held: float
    singular: float


def directions(count: int = DIRECTIONS) -> Floats:
    """Unit directions (count, 3), evenly on the sphere: equal heights, turned on by the golden angle."""
    height = 1.0 - (2.0 * np.arange(count) + 1.0) / count
    turn = np.arange(count) * math.pi * (3.0 - math.sqrt(5.0))
    radius = np.sqrt(1.0 - height * height)
    return np.column_stack([radius * np.cos(turn), radius * np.sin(turn), height])


def share(machine: Machine) -> Share:
    """How much of all directions a machine holds, in its own frame.

    A machine of fewer than two rotary axes holds a circle of directions or a single one: no share of the sphere.

    >>> share(Machine.parse("unlimited")), share(Machine.parse("3-axis"))
    (Share(held=1.0, singular=0.0), Share(held=0.0, singular=0.0))
    """
    axis = directions()
    held, near = np.ones(len(axis), bool), np.zeros(len(axis), bool)
    if machine.tilt_limit is not None:
        held &= axis @ np.array(machine.tool_axis) >= machine.limit_cos
    kinematics = machine.kinematics(_IDENTITY)
    if kinematics is not None:
        _, taken, near = kinematics.positions(axis)
        held &= taken >= 0
    # Directions beyond an angle may lie between those counted.
    whole = bool(held.all()) and (machine.tilt_limit is None or machine.tilt_limit >= math.pi)
    return Share(exact(float(held.mean()), some=bool(held.any()), whole=whole), float((held & near).mean()))


def singular(machine: Machine) -> float | None:
    """Half angle of the singular cone about the axis next to the part, rad; None where there is none."""
    return SINGULAR if machine.turning == 2 else None


class Solution(NamedTuple):
    """Angles, rad, by the names of the rotary axes; whether this is the one to take."""

    angles: dict[str, float]
    taken: bool


def solutions(machine: Machine, axis: Floats) -> list[Solution]:
    """Find the angles within the limits that hold a tool axis (3,) in the machine's frame; the solution to take comes first.

    Raises MachineError: the machine has no rotary axes that could be set.
    """
    kinematics = machine.kinematics(_IDENTITY)
    if kinematics is None:
        raise MachineError(f"machine {machine.name} has no rotary axes: there are no angles")
    positions, taken, _ = kinematics.positions((axis / np.linalg.norm(axis))[None])
    names = [each.name for each in machine.rotary]
    rows = [
        Solution(dict(zip(names, map(float, positions[0, i]), strict=True)), bool(i == taken[0]))
        for i in range(2)
        if (i == taken[0] or names) and np.isfinite(positions[0, i]).all() and taken[0] >= 0
    ]
    rows.sort(key=lambda each: not each.taken)
    return rows[:1] if len(rows) == 2 and rows[0].angles == rows[1].angles else rows


def tool_axis(machine: Machine, angles: dict[str, float]) -> tuple[Floats, list[str]]:
    """The tool axis (3,) at angles, rad, by the names of the rotary axes (others are 0); names of those beyond their limits."""
    names = {each.name.upper(): each for each in machine.rotary}
    for name in angles:
        if name.upper() not in names:
            known = ", ".join(each.name for each in machine.rotary) or "none"
            raise MachineError(f"machine {machine.name} has no rotary axis {shown(name)}: its rotary axes are {known}")
    by_name = {name.upper(): angle for name, angle in angles.items()}
    row = [by_name.get(axis.name.upper(), 0.0) for axis in machine.rotary]
    beyond = [
        axis.name
        for axis, at in zip(machine.rotary, row, strict=True)
        if axis.limits is not None and not axis.limits[0] - ON_LIMIT <= at <= axis.limits[1] + ON_LIMIT
    ]
    kinematics = machine.kinematics(_IDENTITY)
    if kinematics is None or not machine.rotary:
        return np.array(machine.tool_axis), beyond
    return np.asarray(kinematics.axis(np.array([row]))[0]), beyond


def share_text(machine: Machine, held: float) -> str:
    """The share of directions as people read it: a circle or a single one is none of the sphere."""
    if machine.turns and machine.turning < 2:
        return "a circle" if machine.turning else "one"
    return percent(held)


def limits_text(axis: Axis) -> str:
    """Limits as people read them."""
    if axis.limits is None:
        return "no limit"
    low, high = (f"{math.degrees(end) if axis.kind == 'rotary' else end:.6g}" for end in axis.limits)
    unit = "deg" if axis.kind == "rotary" else "mm"
    return f"{low} to {high} {unit}".replace("-inf to", "up to").replace("to inf", "and more")


def summary(machine: Machine) -> list[str]:
    """Describe in plain sentences which tool axes a machine can hold."""
    rotary, kinematics, lines = machine.rotary, machine.kinematics(_IDENTITY), list[str]()
    if not machine.limited:
        return ["It holds any tool axis: no limit is counted."]
    if machine.tilt_limit is not None:
        lines.append(f"The tool axis stays within {angle(math.degrees(machine.tilt_limit))} of the setup axis.")
    if not machine.turns:
        pass
    elif not rotary:
        lines.append("Nothing turns the tool: it holds the setup axis alone.")
    elif machine.turning == 0:
        lines.append("Nothing turns the tool, for the limits leave its axes no range: it holds one tool axis.")
    elif machine.turning == 1 and kinematics is not None:
        only = rotary[kinematics.turning()[1][0]].name
        lines.append(f"Only {only} turns the tool against the part: the tool axes lie on one circle.")
    else:
        first, second = rotary
        lines.append(
            f"{first.name} is next to the part, {second.name} next to the tool; both solutions of a tool axis are tried."
        )
    result = share(machine)
    if machine.turning == 2 or not machine.turns:
        lines.append(f"It holds {percent(result.held)} of all directions (counted on {DIRECTIONS} of them).")
    cone = singular(machine)
    if cone is not None:
        lines.append(
            f"Singular: within {angle(math.degrees(cone))} of {vector_text(rotary[0].direction)}, either way, {rotary[0].name} "
            f"turns fast; {percent(result.singular)} of all directions are held there."
        )
    return lines


def vector_text(direction: tuple[float, float, float]) -> str:
    """A direction or a point as people read it."""
    return f"({', '.join(f'{value + 0.0:.6g}' for value in direction)})"
