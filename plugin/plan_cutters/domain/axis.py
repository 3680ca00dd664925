"""One axis of a machine: rotary or linear, what it carries, its direction and its limits."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Literal

from cad_io.arrays import Floats
from plan_cutters.domain.checks import items, number, shown
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
            self,
            name: str,
            kind: Kind,
            carries: Carried,
            direction: Sequence[float] | Floats,
            limits: Sequence[float] | Floats | None = None,
            point: Sequence[float] | Floats = ...,
            rate: float | None = None,
            accuracy: float | None = None,
            acceleration: float | None = None,
        ) -> None: ...

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
