"""Stages: round sections of which necks, shanks and holders are made, and how a holder is written on a command line."""

import math
import re
from dataclasses import dataclass
from typing import Any

from plan_cutters.domain.checks import items, name, number, shown
from plan_cutters.domain.lengths import LENGTH, Notation, across, length
from plan_cutters.domain.standard_holders import chuck
from plan_cutters.errors import CutterError

_STAGE = re.compile(rf"(?P<by>[RD])(?P<lower>{LENGTH})(?::(?P<upper>{LENGTH}))?L(?P<length>{LENGTH})", re.IGNORECASE)


def positive(value: Any, what: str, *, zero: bool = False) -> float:
    """A finite number of mm above 0, or no less than that."""
    result = number(value, what, error=CutterError)
    if not math.isfinite(result) or result < 0.0 or (result == 0.0 and not zero):
        raise CutterError(f"{what} must be {'0 or ' if zero else ''}a positive number of mm, not {result:g}")
    return result


@dataclass(frozen=True, slots=True)
class Segment:
    """A round section of a holder, shank or neck: a cylinder or a cone.

    Attributes
    ----------
    radius, upper_radius : float
        At its lower (tip) and its upper (spindle) end, mm; the upper one is the lower one unless it is given.
    length : float
        mm.
    """

    radius: float
    length: float
    upper_radius: float = math.nan

    def __post_init__(self) -> None:
        object.__setattr__(self, "radius", positive(self.radius, "a stage's radius"))
        object.__setattr__(self, "length", positive(self.length, "a stage's length"))
        upper = self.radius if self.upper_radius != self.upper_radius else self.upper_radius
        object.__setattr__(self, "upper_radius", positive(upper, "a stage's upper radius"))

    @property
    def slope(self) -> float:
        """Growth of the radius with height."""
        return (self.upper_radius - self.radius) / self.length

    @property
    def id(self) -> str:
        """`R15L30`, or `R15:20L30` for a cone."""
        return self.written(Notation("R"))

    def written(self, how: Notation) -> str:
        """The same in another notation: `D30L30`, or `D30:40L30`."""
        upper = "" if self.upper_radius == self.radius else f":{how.across(self.upper_radius)}"
        return f"{how.by}{how.across(self.radius)}{upper}L{how.length(self.length)}"


#: Its former name.
Stage = Segment


@dataclass(frozen=True, slots=True)
class Holder:
    """A tool holder: stages from its nose up. It sits where the cutter's length ends.

    Attributes
    ----------
    stages : tuple of Segment
    name : str
        For people; the id is made from the stages.
    bore : float, optional
        Diameter of the largest shank that it holds, mm. None: not known.

    Examples
    --------
    >>> Holder((Segment(15, 30),)).id
    'R15L30'
    """

    stages: tuple[Segment, ...]
    name: str = ""
    bore: float | None = None

    def __post_init__(self) -> None:
        stages = tuple(items(self.stages, "a holder's stages", "stages", error=CutterError))
        if not stages or not all(isinstance(stage, Segment) for stage in stages):
            raise CutterError("a holder needs at least one stage: a radius and a length, as R15L30")
        object.__setattr__(self, "stages", stages)
        object.__setattr__(self, "name", name(self.name, "a holder's name", error=CutterError))
        if self.bore is not None:
            object.__setattr__(self, "bore", positive(self.bore, "a holder's bore"))

    @property
    def id(self) -> str:
        """Its stages, from the nose up."""
        return self.written(Notation("R"))

    def written(self, how: Notation) -> str:
        """Its stages, from the nose up, in a notation."""
        return "+".join(stage.written(how) for stage in self.stages)

    def called(self, how: Notation) -> str:
        """Its name, or else its stages in a notation.

        >>> Holder.parse("er16").called(Notation("D")), Holder.parse("R15L30").called(Notation("D"))
        ('ER16', 'D30L30')
        """
        return self.name or self.written(how)

    @classmethod
    def parse(cls, spec: str) -> "Holder":
        """Read a word such as `er32` or `hsk63a-er32x100`, or stages from the nose up joined by `+`.

        `R12:15L20+R15L30` is a cone and a cylinder by their radii; `D24:30L20+D30L30` is the same by diameters. Lengths are in mm
        unless `in` stands behind them.

        Raises
        ------
        CutterError

        Examples
        --------
        >>> Holder.parse("D1inL2in").id, Holder.parse("er16").name
        ('R12.7L50.8', 'ER16')
        """
        if not isinstance(spec, str):
            raise CutterError(f"{shown(spec)} is no holder: give a Holder or a text such as 'R15L30'")
        made = chuck(spec.strip())
        if made is not None:
            return cls(tuple(Segment(radius, long) for radius, long in made.stages), made.name, made.bore)
        segments = []
        for word in spec.strip().split("+"):
            match = _STAGE.fullmatch(word.strip())
            if not match:
                raise CutterError(
                    f"holder {shown(spec)} is not of the form R15L30 (radius 15 mm, length 30 mm) or D30L30, stages joined by +, "
                    "nor a word as er32 or hsk63a-er32"
                )
            upper = across(match["by"], match["upper"]) if match["upper"] else math.nan
            segments.append(Segment(across(match["by"], match["lower"]), length(match["length"]), upper))
        return cls(tuple(segments))

    @classmethod
    def of(cls, given: Any) -> "Holder":
        """A holder, or what `parse` makes of a text."""
        return given if isinstance(given, cls) else cls.parse(given)
