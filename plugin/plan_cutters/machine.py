"""Machines: which tool axes can be taken. So far a cone about the setup axis."""

import math
from dataclasses import dataclass

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
        if self.tilt_limit is not None and not 0 <= self.tilt_limit <= math.pi:
            raise MachineError("a tilt limit lies between 0 and 180 deg")

    @classmethod
    def parse(cls, text: str) -> "Machine":
        """Read `unlimited` or `tilt:DEG`.

        Raises
        ------
        MachineError
            Anything else.
        """
        if text == "unlimited":
            return cls()
        kind, _, value = text.partition(":")
        if kind == "tilt":
            try:
                return cls(text, math.radians(float(value)))
            except ValueError:
                raise MachineError(f"machine {text!r}: the limit is a number of degrees, as in tilt:30") from None
        raise MachineError(
            f"machine {text!r} is not known: give unlimited or tilt:DEG; named machines and machine files are not built yet"
        )

    @property
    def limit_cos(self) -> float:
        """Cosine of the limit; -2 for none."""
        return -2.0 if self.tilt_limit is None else math.cos(self.tilt_limit)
