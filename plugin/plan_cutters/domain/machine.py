"""Machines: which tool axes can be taken. So far a cone about the setup axis."""

import math
from dataclasses import dataclass
from typing import Any

from plan_cutters.domain.checks import number, radians, shown
from plan_cutters.errors import MachineError


@dataclass(frozen=True, slots=True)
class Machine:
    """Axis limits of a machine.

    Attributes
    ----------
    name : str
    tilt_limit : float, optional
        Largest angle between tool axis and setup axis, rad; None for no limit.
    """

    name: str = "unlimited"
    tilt_limit: float | None = None

    def __post_init__(self) -> None:
        if not isinstance(self.name, str):
            raise MachineError(f"a machine's name must be a text, not {shown(self.name)}")
        if self.tilt_limit is None:
            return
        limit = number(self.tilt_limit, "tilt limit", error=MachineError)
        limit = radians(limit, "tilt limit", math.pi, error=MachineError)
        if limit < 0:
            raise MachineError(f"tilt limit {limit:g} must not be negative")
        object.__setattr__(self, "tilt_limit", limit)

    @classmethod
    def parse(cls, text: str) -> "Machine":
        """Read `unlimited` or `tilt:DEG`.

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
        raise MachineError(
            f"machine {text!r} is not known: give unlimited or tilt:DEG; named machines and machine files are not built yet"
        )

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
