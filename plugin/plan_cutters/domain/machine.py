"""Machines: which tool axes can be taken, by a plain limit about the setup axis or by rotary axes with their limits."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
from numpy.typing import NDArray

from cad_io.arrays import Floats, cross
from plan_cutters.domain.checks import Angle, degrees_too, did_you_mean, items, number, radians, shown
from plan_cutters.domain.kinematics import PARALLEL, Kinematics
from plan_cutters.errors import MachineError

Kind = Literal["rotary", "linear"]
Carried = Literal["part", "tool"]
#: Largest accuracy of a rotary axis that is one, rad: 1 deg.
_MOST_ACCURACY = math.radians(1.0)


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
    accuracy : float, optional
        Of a rotary axis, rad: how far it may stand from where it is told to.
    acceleration : float, optional
        Largest one, mm/s2 or rad/s2.
    """

    name: str
    kind: Kind
    carries: Carried
    direction: tuple[float, float, float]
    limits: tuple[float, float] | None = None
    point: tuple[float, float, float] = (0.0, 0.0, 0.0)
    rate: float | None = None
    accuracy: float | None = None
    acceleration: float | None = None

    if TYPE_CHECKING:

        def __init__(
            self, name: str, kind: Kind, carries: Carried, direction: Sequence[float] | Floats,
            limits: Sequence[float] | Floats | None = None, point: Sequence[float] | Floats = ..., rate: float | None = None,
            accuracy: float | None = None, acceleration: float | None = None,
        ) -> None: ...  # fmt: skip

    @classmethod
    def rotary(
        cls,
        name: str,
        carries: Carried,
        direction: Sequence[float] | Floats,
        *,
        limits_deg: Sequence[float] | Floats | None = None,
        point: Sequence[float] | Floats = (0.0, 0.0, 0.0),
        rate_deg: float | None = None,
    ) -> "Axis":
        """A rotary axis by its limits in degrees and its largest speed in degrees a second.

        >>> Axis.rotary("A", "part", (1, 0, 0), limits_deg=(-90, 90)).limits
        (-1.5707963267948966, 1.5707963267948966)
        """
        limits = rate = None
        if limits_deg is not None:
            low, high = numbers_of(limits_deg, f"axis {name}: its limits in degrees", 2)
            limits = math.radians(low), math.radians(high)
        if rate_deg is not None:
            rate = math.radians(number(rate_deg, f"axis {name}: its rate in degrees a second", error=MachineError))
        return cls(name, "rotary", carries, direction, limits, point, rate)

    def __post_init__(self) -> None:
        if not isinstance(self.name, str) or not self.name.strip():
            raise MachineError(f"a machine's axis needs a name, not {shown(self.name)}")
        what = f"axis {self.name}"
        if self.kind not in ("rotary", "linear"):
            raise MachineError(f"{what}: its kind is rotary or linear, not {shown(self.kind)}")
        if self.carries not in ("part", "tool"):
            raise MachineError(f"{what}: it carries the part or the tool, not {shown(self.carries)}")
        object.__setattr__(self, "direction", direction_of(self.direction, f"{what}: its direction"))
        point = numbers_of(self.point, f"{what}: its point", 3)
        if not all(map(math.isfinite, point)):
            raise MachineError(f"{what}: its point must be finite")
        object.__setattr__(self, "point", point)
        if self.limits is not None:
            low, high = numbers_of(self.limits, f"{what}: its limits", 2)
            if not low <= high:
                raise MachineError(f"{what}: its limits {low:g} to {high:g} must run upwards")
            none = math.isinf(low) and math.isinf(high)
            object.__setattr__(self, "limits", None if none else (low, high))
        for name in ("rate", "acceleration"):
            if getattr(self, name) is not None:
                value = number(getattr(self, name), f"{what}: its {name}", error=MachineError)
                if not 0.0 < value < math.inf:
                    raise MachineError(f"{what}: its {name} must be positive")
                object.__setattr__(self, name, value)
        if self.accuracy is not None:
            accuracy = number(self.accuracy, f"{what}: its accuracy", error=MachineError)
            if self.kind != "rotary" or not 0.0 <= accuracy <= _MOST_ACCURACY:
                raise MachineError(f"{what}: its accuracy is an angle of a rotary axis, from 0 to 1 deg")
            object.__setattr__(self, "accuracy", accuracy)


def numbers_of(value: Any, what: str, count: int) -> tuple[float, ...]:
    values = tuple(number(each, what, error=MachineError) for each in items(value, what, "numbers", error=MachineError))
    if len(values) != count or any(math.isnan(each) for each in values):
        raise MachineError(f"{what} must be {count} numbers")
    return values


def direction_of(value: Any, what: str) -> tuple[float, float, float]:
    x, y, z = numbers_of(value, what, 3)
    size = math.hypot(x, y, z)
    if not 0.0 < size < math.inf:
        raise MachineError(f"{what} must be three finite numbers that are not all zero")
    # One that has length 1 up to rounding stays as it is: what is written to a file is read as the same.
    if abs(size - 1.0) <= 1e-15:
        return x, y, z
    return x / size, y / size, z / size


#: What rounding may take from a cosine.
_ROUNDING = 1e-12


@degrees_too({"tilt_limit": Angle(0.0, 180.0)}, error=MachineError)
@dataclass(frozen=True, slots=True)
class Machine:
    """A machine as far as the tool axis goes.

    Attributes
    ----------
    name : str
    tilt_limit : float, optional
        Largest angle between tool axis and setup axis, rad, or as `tilt_limit_deg`; None for no limit.
    axes : tuple of Axis
        From the part over the bed to the tool: those that carry the part first, the one next to the part as the first of all.
        None: any tool axis within `tilt_limit`.
    tool_axis : (float, float, float)
        Unit direction from the tip to the spindle at zero angles, in the machine's frame.
    notes : tuple of str
        How it was understood where that is not plain.
    fixed : bool
        Whether an empty list of axes means that nothing turns the tool: a machine of three axes.
    indexed : bool
        Whether its rotary axes stand still while it cuts, as on a 3+2 machine: no simultaneous motion is planned.
    """

    name: str = "unlimited"
    tilt_limit: float | None = None
    axes: tuple[Axis, ...] = ()
    tool_axis: tuple[float, float, float] = (0.0, 0.0, 1.0)
    notes: tuple[str, ...] = ()
    fixed: bool = False
    indexed: bool = False

    if TYPE_CHECKING:

        def __init__(
            self, name: str = "unlimited", tilt_limit: float | None = None, axes: Sequence[Axis] = (),
            tool_axis: Sequence[float] | Floats = ..., notes: Sequence[str] = (), fixed: bool = False,
            indexed: bool = False, *, tilt_limit_deg: float | None = None,
        ) -> None: ...  # fmt: skip

    def __post_init__(self) -> None:
        if not isinstance(self.name, str):
            raise MachineError(f"a machine's name must be a text, not {shown(self.name)}")
        object.__setattr__(self, "axes", tuple(items(self.axes, "a machine's axes", "axes", error=MachineError)))
        object.__setattr__(self, "notes", tuple(items(self.notes, "a machine's notes", "texts", error=MachineError)))
        object.__setattr__(self, "tool_axis", direction_of(self.tool_axis, "a machine's tool axis"))
        for word in ("fixed", "indexed"):
            if not isinstance(value := getattr(self, word), bool):
                raise MachineError(f"a machine is {word} or not, not {shown(value)}")
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
            raise MachineError(
                f"machine {self.name}: {len(turning)} rotary axes ({', '.join(a.name for a in turning)}); "
                "machines of up to two are judged"
            )
        tool = np.array(self.tool_axis)
        if len(turning) == 2:
            first, second = (np.array(axis.direction) for axis in turning)
            if np.linalg.norm(cross(first, second)) <= PARALLEL:
                raise MachineError(f"machine {self.name}: its rotary axes {turning[0].name} and {turning[1].name} are parallel")
        if turning and np.linalg.norm(cross(np.array(turning[-1].direction), tool)) <= PARALLEL:
            last = turning[-1].name
            raise MachineError(f"machine {self.name}: its axis {last} lies along the tool, which it only turns about itself")

    @property
    def rotary(self) -> tuple[Axis, ...]:
        """Its rotary axes, the one next to the part first."""
        return tuple(axis for axis in self.axes if axis.kind == "rotary")

    @property
    def chuck_axis(self) -> tuple[float, float, float] | None:
        """The machine's direction along which a chuck stands on the rotary axis next to the part, which lies across the spindle.

        None: it stands along the spindle, on a table or on an axis that turns about it, or nothing turns the part.

        >>> Machine.parse("4-axis-a").chuck_axis, Machine.parse("trunnion-ac").chuck_axis
        ((1.0, 0.0, 0.0), None)
        """
        turning = [each.direction for each in self.rotary if each.carries == "part"]
        if not turning or any(abs(each[2]) > PARALLEL for each in turning):
            return None
        return turning[0]

    @property
    def rates_deg(self) -> dict[str, float]:
        """The largest speed of each rotary axis that has one, deg/s, by its name."""
        return {axis.name: math.degrees(axis.rate) for axis in self.rotary if axis.rate is not None}

    @property
    def acceleration(self) -> float:
        """The least acceleration of its linear axes, mm/s2; infinite where none is known."""
        return min((axis.acceleration for axis in self.linear if axis.acceleration is not None), default=math.inf)

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

    @property
    def turning(self) -> int:
        """How many of its rotary axes turn the tool: one whose limits leave one angle does not."""
        kinematics = self.kinematics(np.eye(3))
        return 0 if kinematics is None else len(kinematics.turning()[1])

    def kinematics(self, setup: Floats) -> Kinematics | None:
        """Its rotary axes in the part's frame; None where any tool axis is possible.

        `setup` (3, 3) float: the machine's X, Y and Z in part coordinates, as rows, at zero angles.
        """
        if not self.turns:
            return None
        limits = [axis.limits or (-math.inf, math.inf) for axis in self.rotary]
        kinematics = Kinematics(
            np.array([axis.direction for axis in self.rotary], float).reshape(-1, 3),
            np.array(limits, float).reshape(-1, 2),
            np.array(self.tool_axis),
        )
        return kinematics.seen_from(np.asarray(setup).T)

    def allows(self, axis: Floats, setup: Floats) -> NDArray[np.bool_]:
        """Which tool axes (n, 3) of the part it can hold, by its plain limit and its rotary axes; `setup` as for `kinematics`."""
        return self.holds(axis, setup, self.kinematics(setup))

    def holds(self, axis: Floats, setup: Floats, kinematics: Kinematics | None) -> NDArray[np.bool_]:
        """As `allows`, with the rotary axes in the part's frame."""
        held = axis @ setup[2] >= self.limit_cos - _ROUNDING
        return np.asarray(held if kinematics is None else held & kinematics.allows(axis))

    @classmethod
    def parse(cls, text: str) -> "Machine":
        """Read `unlimited`, `tilt:DEG` or the name of a built-in machine.

        Raises MachineError: anything else.

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
        known = builtin_machines()
        if text in known:
            return known[text]
        meant = did_you_mean(text, ["unlimited", *known])
        give = f"{meant} Give" if meant else ": give"
        raise MachineError(f"machine {text!r} is not known{give} unlimited, tilt:DEG, {', '.join(known)}, or a machine file")

    @classmethod
    def of(cls, given: Any) -> "Machine":
        """A machine, or what `parse` makes of a text; None has no limit."""
        if given is None:
            return cls()
        return given if isinstance(given, cls) else cls.parse(given)

    @property
    def limit_cos(self) -> float:
        """Cosine of the limit; -2 for none."""
        return -2.0 if self.tilt_limit is None else math.cos(self.tilt_limit)


#: Usual directions.
X, Y, Z = (1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)


def builtin_machines() -> dict[str, Machine]:
    """By their names; angles of the tool relative to the part, degrees, in the names' order of axes."""
    table: dict[str, tuple[Axis, ...]] = {
        "3-axis": (),
        "4-axis-a": (Axis.rotary("A", "part", X),),
        "3+2": (Axis.rotary("C", "part", Z), Axis.rotary("A", "part", X, limits_deg=(-110.0, 110.0))),
        "trunnion-ac": (Axis.rotary("C", "part", Z), Axis.rotary("A", "part", X, limits_deg=(-30.0, 120.0))),
        "trunnion-bc": (Axis.rotary("C", "part", Z), Axis.rotary("B", "part", Y, limits_deg=(-110.0, 110.0))),
        "head-table-bc": (Axis.rotary("C", "part", Z), Axis.rotary("B", "tool", Y, limits_deg=(-100.0, 100.0))),
        "head-head-ca": (
            Axis.rotary("C", "tool", Z, limits_deg=(-360.0, 360.0)),
            Axis.rotary("A", "tool", X, limits_deg=(-110.0, 110.0)),
        ),
        "nutating-bc": (Axis.rotary("C", "part", Z), Axis.rotary("B", "tool", (0.0, 1.0, 1.0), limits_deg=(-180.0, 180.0))),
    }
    return {name: Machine(name, axes=axes, fixed=not axes, indexed=name == "3+2") for name, axes in table.items()}
