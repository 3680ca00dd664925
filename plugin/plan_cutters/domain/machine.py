"""Machines: which tool axes can be taken, by a plain limit about the setup axis or by rotary axes with their limits."""

import math
from dataclasses import dataclass, replace
from typing import Any, Literal

import numpy as np

from cad_io.arrays import Floats
from plan_cutters.domain.checks import items, number, radians, shown
from plan_cutters.domain.kinematics import PARALLEL, Kinematics
from plan_cutters.errors import MachineError

Kind = Literal["rotary", "linear"]
Carried = Literal["part", "tool"]


@dataclass(frozen=True, slots=True)
class Axis:
    """One axis of a machine at zero positions, in the machine's frame (ISO 841: Z towards the spindle).

    Attributes
    ----------
    name : str
        `A`, `X` and so on.
    kind : str
        `rotary` or `linear`.
    carries : str
        What stands on it: the `part` or the `tool`.
    direction : (float, float, float)
        Unit direction; positive is the motion of the tool relative to the part, whatever moves.
    limits : (float, float), optional
        From, to: rad or mm. None: no limit.
    point : (float, float, float)
        A point of a rotary axis, mm.
    rate : float, optional
        Largest speed, rad/s or mm/s.
    """

    name: str
    kind: Kind
    carries: Carried
    direction: tuple[float, float, float]
    limits: tuple[float, float] | None = None
    point: tuple[float, float, float] = (0.0, 0.0, 0.0)
    rate: float | None = None

    def __post_init__(self) -> None:
        if not isinstance(self.name, str) or not self.name.strip():
            raise MachineError(f"a machine's axis needs a name, not {shown(self.name)}")
        what = f"axis {self.name}"
        if self.kind not in ("rotary", "linear"):
            raise MachineError(f"{what}: its kind is rotary or linear, not {shown(self.kind)}")
        if self.carries not in ("part", "tool"):
            raise MachineError(f"{what}: it carries the part or the tool, not {shown(self.carries)}")
        object.__setattr__(self, "direction", _direction(self.direction, f"{what}: its direction"))
        point = _numbers(self.point, f"{what}: its point", 3)
        if not all(map(math.isfinite, point)):
            raise MachineError(f"{what}: its point must be finite")
        object.__setattr__(self, "point", point)
        if self.limits is not None:
            low, high = _numbers(self.limits, f"{what}: its limits", 2)
            if not low <= high:
                raise MachineError(f"{what}: its limits {low:g} to {high:g} must run upwards")
            none = math.isinf(low) and math.isinf(high)
            object.__setattr__(self, "limits", None if none else (low, high))
        if self.rate is not None:
            rate = number(self.rate, f"{what}: its rate", error=MachineError)
            if not 0.0 < rate < math.inf:
                raise MachineError(f"{what}: its rate must be positive")
            object.__setattr__(self, "rate", rate)


@dataclass(frozen=True, slots=True)
class Machine:
    """A machine as far as the tool axis goes.

    Attributes
    ----------
    name : str
    tilt_limit : float, optional
        Largest angle between tool axis and setup axis, rad; None for no limit.
    axes : tuple of Axis
        From the part over the bed to the tool: those that carry the part first, the one next to the part as the first of all.
        None: any tool axis within `tilt_limit`.
    tool_axis : (float, float, float)
        Unit direction from the tip to the spindle at zero angles, in the machine's frame.
    notes : tuple of str
        How it was understood where that is not plain.
    fixed : bool
        Whether an empty list of axes means that nothing turns the tool: a machine of three axes.
    """

    name: str = "unlimited"
    tilt_limit: float | None = None
    axes: tuple[Axis, ...] = ()
    tool_axis: tuple[float, float, float] = (0.0, 0.0, 1.0)
    notes: tuple[str, ...] = ()
    fixed: bool = False

    def __post_init__(self) -> None:
        if not isinstance(self.name, str):
            raise MachineError(f"a machine's name must be a text, not {shown(self.name)}")
        object.__setattr__(self, "axes", tuple(items(self.axes, "a machine's axes", "axes", error=MachineError)))
        object.__setattr__(self, "notes", tuple(items(self.notes, "a machine's notes", "texts", error=MachineError)))
        object.__setattr__(self, "tool_axis", _direction(self.tool_axis, "a machine's tool axis"))
        if not isinstance(self.fixed, bool):
            raise MachineError(f"a machine is fixed or not, not {shown(self.fixed)}")
        self._check_axes()
        if self.tilt_limit is None:
            return
        limit = number(self.tilt_limit, "tilt limit", error=MachineError)
        limit = radians(limit, "tilt limit", math.pi, error=MachineError)
        if limit < 0:
            raise MachineError(f"tilt limit {limit:g} must not be negative")
        object.__setattr__(self, "tilt_limit", limit)

    def _check_axes(self) -> None:
        if not all(isinstance(axis, Axis) for axis in self.axes):
            raise MachineError(f"machine {self.name}: its axes must be a list of Axis")
        names = [axis.name for axis in self.axes]
        if len(set(names)) < len(names):
            raise MachineError(f"machine {self.name}: two of its axes have one name: {', '.join(names)}")
        carried = [axis.carries for axis in self.axes]
        if carried != sorted(carried):
            raise MachineError(f"machine {self.name}: axes that carry the part come before those that carry the tool")
        turning = self.rotary
        if len(turning) > 2:
            raise MachineError(f"machine {self.name}: {len(turning)} rotary axes ({', '.join(a.name for a in turning)}); "
                               "machines of up to two are judged")  # fmt: skip
        tool = np.array(self.tool_axis)
        if len(turning) == 2:
            first, second = (np.array(axis.direction) for axis in turning)
            if np.linalg.norm(np.cross(first, second)) <= PARALLEL:
                raise MachineError(
                    f"machine {self.name}: its rotary axes {turning[0].name} and {turning[1].name} are parallel"
                )
        if turning and np.linalg.norm(np.cross(np.array(turning[-1].direction), tool)) <= PARALLEL:
            last = turning[-1].name
            raise MachineError(
                f"machine {self.name}: its axis {last} lies along the tool, which it only turns about itself"
            )

    @property
    def rotary(self) -> tuple[Axis, ...]:
        """Its rotary axes, the one next to the part first."""
        return tuple(axis for axis in self.axes if axis.kind == "rotary")

    @property
    def linear(self) -> tuple[Axis, ...]:
        """Its linear axes, the one next to the part first."""
        return tuple(axis for axis in self.axes if axis.kind == "linear")

    @property
    def limited(self) -> bool:
        """Whether there is any tool axis that it cannot hold."""
        return self.tilt_limit is not None or self.turns

    @property
    def turns(self) -> bool:
        """Whether rotary axes, or that there are none, say which tool axes it holds."""
        return self.fixed or bool(self.rotary)

    def kinematics(self, setup: Floats) -> Kinematics | None:
        """Its rotary axes in the part's frame; None where any tool axis is possible.

        Parameters
        ----------
        setup : (3, 3) float
            The machine's X, Y and Z in part coordinates, as rows, at zero angles.
        """
        if not self.turns:
            return None
        limits = [axis.limits or (-math.inf, math.inf) for axis in self.rotary]
        found = Kinematics(
            np.array([axis.direction for axis in self.rotary], float).reshape(-1, 3),
            np.array(limits, float).reshape(-1, 2),
            np.array(self.tool_axis),
        )
        return found.seen_from(np.asarray(setup).T)

    @classmethod
    def parse(cls, text: str) -> "Machine":
        """Read `unlimited`, `tilt:DEG` or the name of a built-in machine.

        Raises
        ------
        MachineError
            Anything else.

        Examples
        --------
        >>> round(Machine.parse("tilt:60").limit_cos, 9), Machine.parse("unlimited").tilt_limit
        (0.5, None)
        """
        if not isinstance(text, str):
            raise MachineError(f"{shown(text)} is no machine: give a Machine or a text such as 'tilt:60'")
        if text == "unlimited":
            return cls()
        kind, _, value = text.partition(":")
        if kind == "tilt":
            try:
                degrees = float(value)
            except ValueError:
                raise MachineError(f"machine {text!r}: the limit is a number of degrees, as in tilt:30") from None
            if not 0 <= degrees <= 180:
                raise MachineError(f"machine {text!r}: the limit lies between 0 and 180 degrees")
            return cls(text, math.radians(degrees))
        from plan_cutters.domain.machines import builtin_machines

        known = builtin_machines()
        if text in known:
            return known[text]
        raise MachineError(
            f"machine {text!r} is not known: give unlimited, tilt:DEG, {', '.join(known)}, or a machine file"
        )

    @classmethod
    def of(cls, given: Any) -> "Machine":
        """A machine, or what `parse` makes of a text; None has no limit."""
        if given is None:
            return cls()
        return given if isinstance(given, cls) else cls.parse(given)

    def named(self, name: str) -> "Machine":
        """The same under another name."""
        return replace(self, name=name)

    @property
    def limit_cos(self) -> float:
        """Cosine of the limit; -2 for none."""
        return -2.0 if self.tilt_limit is None else math.cos(self.tilt_limit)


def _numbers(value: Any, what: str, count: int) -> tuple[float, ...]:
    found = tuple(number(each, what, error=MachineError) for each in items(value, what, "numbers", error=MachineError))
    if len(found) != count or any(math.isnan(each) for each in found):
        raise MachineError(f"{what} must be {count} numbers")
    return found


def _direction(value: Any, what: str) -> tuple[float, float, float]:
    x, y, z = _numbers(value, what, 3)
    size = math.hypot(x, y, z)
    if not 0.0 < size < math.inf:
        raise MachineError(f"{what} must be three finite numbers that are not all zero")
    return x / size, y / size, z / size
