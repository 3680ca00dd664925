"""Tools for holes: drills, centre drills, reamers, taps, countersinks and counterbores."""

import math
from dataclasses import dataclass, replace
from typing import Literal, get_args

from cad_io.arrays import Floats
from plan_cutters.domain.cutter import Cutter
from plan_cutters.domain.shapes import flute_length
from plan_cutters.errors import CutterError

Kind = Literal["drill", "centre drill", "reamer", "tap", "countersink", "counterbore"]
KINDS: tuple[Kind, ...] = get_args(Kind)
#: A drill makes a hole whose diameter differs by no more than this, mm, or this share of it, whichever is more; and a cone whose
#: angle differs by no more than this, rad.
_WIDE, _SHARE, _ANGLE = 0.05, 0.01, math.radians(3.0)


@dataclass(frozen=True, slots=True)
class Drill:
    """A tool for holes: what it is, its body, and its point."""

    kind: Kind
    body: Cutter  #: A flat end mill of its diameter, flutes, shank, stick-out and holder, with the name that its file has for it.
    point: float | None = None  #: rad; the whole angle of its point, where the file states one.

    @property
    def id(self) -> str:
        """`drill R1.65L60F36P118`: the same dimensions, the same id."""
        point = "" if self.point is None else f"P{math.degrees(self.point):.6g}"
        return f"{self.kind} {self.body.id}{point}"

    @property
    def diameter(self) -> float:
        """mm."""
        return 2.0 * self.body.radius

    @property
    def point_length(self) -> float:
        """Height of its point, mm, or more: one that is not stated is taken for 90 deg."""
        return self.body.radius / math.tan(0.5 * (0.5 * math.pi if self.point is None else self.point))

    @property
    def reach(self) -> float:
        """Length of its flutes without its point, mm."""
        return flute_length(self.body) - self.point_length

    def depth_in(self, depth: float, *, through: bool) -> float:
        """How deep its full width goes into a hole of a depth, mm: through one its point goes on until all of it is."""
        return depth + (self.point_length if through else 0.0)

    def fits(self, diameter: float, bottom: str, cone: float | None) -> bool:
        """Whether a drill leaves a hole of a diameter, mm, with its bottom; `cone`, rad, as of a hole.

        A floor, or a rounded corner, it would cut into with its point.
        """
        if self.kind != "drill" or abs(self.diameter - diameter) > max(_WIDE, _SHARE * diameter):
            return False
        if bottom == "open":
            return True
        return bottom == "cone" and cone is not None and self.point is not None and abs(self.point - cone) <= _ANGLE

    def in_hole(self, diameter: float) -> Cutter | None:
        """The body above its point, with flutes as wide as a hole, mm; None where there is no such tool."""
        body, off = self.body, self.point_length
        try:
            flutes = None if body.flutes is None else body.flutes - off
            return replace(body, radius=0.5 * diameter, length=body.length - off, flutes=flutes)
        except CutterError:
            return None


@dataclass(frozen=True, slots=True, eq=False)
class Drilled:
    """A drill makes a hole in a setup."""

    drill: Drill
    setup: int  #: Counted from 0.
    axis: Floats  #: (3,) float: unit tool axis.


#: The way of a drill at its feed, in depths of the hole: it begins over the mouth.
_WAY = 1.3


def time_of_hole(depth: float, feed: float) -> float:
    """Time of a hole of a depth, mm, at a feed, mm/min, in s; pecks are not counted.

    >>> time_of_hole(10.0, 260.0)
    3.0
    """
    return _WAY * depth / feed * 60.0
