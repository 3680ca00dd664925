"""Cutters: the words and numbers of a flat-end cutter, and how one is written on a command line."""

import math
import re
from dataclasses import dataclass
from typing import Any

from plan_cutters.domain.checks import items, number, shown
from plan_cutters.errors import CutterError

_SPEC = re.compile(r"R(?P<radius>-?[0-9.]+)L(?P<length>-?[0-9.]+)(?:rc(?P<corner>-?[0-9.]+))?", re.IGNORECASE)


def _number(value: float) -> str:
    return f"{value:.10g}"


@dataclass(frozen=True, slots=True)
class Cutter:
    """A cutter as the search sees it: a solid cylinder, bottom centre to spindle.

    Attributes
    ----------
    radius, length : float
        mm; the length is that of the cylinder that is checked, tip to spindle side.
    corner_radius : float
        mm; 0 for a flat end. Other corners are not judged yet.
    name : str
        For people; the id is made from the dimensions.
    """

    radius: float
    length: float
    corner_radius: float = 0.0
    name: str = ""

    def __post_init__(self) -> None:
        for word in ("radius", "length", "corner_radius"):
            value = number(getattr(self, word), f"cutter {word.replace('_', ' ')}", error=CutterError)
            object.__setattr__(self, word, value)
        if not isinstance(self.name, str):
            raise CutterError(f"a cutter's name must be a text, not {shown(self.name)}")
        for word, value in (("radius", self.radius), ("length", self.length)):
            if not (math.isfinite(value) and value > 0):
                raise CutterError(f"cutter {word} must be a positive number of mm, not {value:g}")
        if not 0 <= self.corner_radius <= self.radius:
            raise CutterError(f"corner radius {self.corner_radius:g} must lie between 0 and the radius {self.radius:g}")
        if self.corner_radius:
            raise CutterError(
                f"cutter {self.id}: bull and ball noses are not judged yet; give a flat end such as R6L80 instead"
            )

    @classmethod
    def flat(cls, *, radius: float, length: float, name: str = "") -> "Cutter":
        """A flat-end cutter, lengths in mm."""
        return cls(radius=radius, length=length, name=name)

    @classmethod
    def parse(cls, spec: str) -> "Cutter":
        """Read `R6L80`: radius and length in mm; `R6L80rc1` adds a corner radius.

        Raises
        ------
        CutterError
            The text is not of that form, or no such cutter can exist.

        Examples
        --------
        >>> Cutter.parse("r6l80").id
        'R6L80'
        >>> Cutter.parse("")
        Traceback (most recent call last):
        plan_cutters.errors.CutterError: cutter '' is not of the form R6L80 (radius 6 mm, length 80 mm)
        """
        if not isinstance(spec, str):
            raise CutterError(f"{shown(spec)} is no cutter: give a Cutter or a text such as 'R6L80'")
        match = _SPEC.fullmatch(spec.strip())
        try:
            if match:
                return cls(float(match["radius"]), float(match["length"]), float(match["corner"] or 0))
        except ValueError:
            pass
        raise CutterError(f"cutter {spec!r} is not of the form R6L80 (radius 6 mm, length 80 mm)")

    @classmethod
    def of(cls, given: Any) -> "Cutter":
        """A cutter, or what `parse` makes of a text."""
        return given if isinstance(given, cls) else cls.parse(given)

    @classmethod
    def each_of(cls, given: Any) -> tuple["Cutter", ...]:
        """One cutter or text, or a list of such; None is an empty list."""
        if given is None:
            return ()
        if isinstance(given, str | cls):
            return (cls.of(given),)
        return tuple(cls.of(each) for each in items(given, "cutters", "cutters", error=CutterError))

    def inside(self, other: "Cutter") -> bool:
        """True if, touching the same contact with the same axis, this cutter lies within the other.

        Corners alike, a radius no larger, a length no larger: the bottom disks touch inside one another at the contact.
        With another corner radius, a longer cutter or a holder that is not so (`docs/nested_cutters.md`).
        """
        return self.corner_radius == other.corner_radius and self.radius <= other.radius and self.length <= other.length

    def large_enough(self, tolerance: float) -> bool:
        """Whether verdicts to a tolerance, mm, say anything about this cutter: it is at least four of it thick and long."""
        return tolerance < min(self.radius, self.length) / 4

    @property
    def id(self) -> str:
        """`R6L80`: the same dimensions, the same id."""
        corner = f"rc{_number(self.corner_radius)}" if self.corner_radius else ""
        return f"R{_number(self.radius)}L{_number(self.length)}{corner}"


def builtin() -> tuple[Cutter, ...]:
    """Metric flat ends R 1 to 12, each with the length below the holder that long end mills of its size have."""
    usual = {1: 20, 1.5: 25, 2: 30, 2.5: 35, 3: 40, 4: 50, 5: 60, 6: 80, 8: 90, 10: 100, 12: 120}
    return tuple(Cutter.flat(radius=r, length=l, name=f"flat end D{2 * r:g} x {l}") for r, l in usual.items())
