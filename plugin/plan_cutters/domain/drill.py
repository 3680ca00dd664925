"""Tools for holes: drills, centre drills, reamers, taps, countersinks and counterbores; names of drills in inches."""

import math
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import Literal, get_args

import numpy as np

from cad_io.arrays import Floats
from plan_cutters.domain.cutter import Cutter
from plan_cutters.domain.shapes import flute_length
from plan_cutters.domain.thread import Thread
from plan_cutters.errors import CutterError

Kind = Literal["drill", "centre drill", "reamer", "tap", "countersink", "counterbore"]
KINDS: tuple[Kind, ...] = get_args(Kind)
#: A tool makes a diameter that differs by no more than this, mm, or this share of it, whichever is more; and a cone at the bottom
#: whose angle differs by no more than this, rad, or a countersink by this.
_WIDE, _SHARE, _ANGLE, _SINK = 0.05, 0.01, math.radians(3.0), math.radians(1.0)
#: A reamer takes at least this off a diameter, mm, and at most that with this share of it.
_ALLOWANCE, _MORE = 0.1, 0.03


@dataclass(frozen=True, slots=True)
class Drill:
    """A tool for holes: what it is, its body, and its point."""

    kind: Kind
    body: Cutter  #: A flat end mill of its diameter, flutes, shank, stick-out and holder, with the name that its file has for it.
    point: float | None = None  #: rad; the whole angle of its point, where the file states one.
    pitch: float | None = None  #: mm; of a tap, where its file or its name states it.
    left: bool = False  #: A tap of a left-hand thread.

    @property
    def id(self) -> str:
        """`drill R1.65L60F36P118`: the same dimensions, the same id."""
        point = "" if self.point is None else f"P{math.degrees(self.point):.6g}"
        pitch = "" if self.pitch is None else f"T{self.pitch:.6g}"
        return f"{self.kind} {self.body.id}{point}{pitch}{'LH' if self.left else ''}"

    @property
    def diameter(self) -> float:
        """mm."""
        return 2.0 * self.body.radius

    @property
    def point_length(self) -> float:
        """Height of its point, mm, or more: one that is not stated is taken for 90 deg, and a counterbore and a tap have none."""
        if self.kind in ("counterbore", "tap"):
            return 0.0
        return self.body.radius / math.tan(0.5 * (0.5 * math.pi if self.point is None else self.point))

    @property
    def reach(self) -> float:
        """Length of its flutes without its point, mm."""
        return flute_length(self.body) - self.point_length

    def wide_as(self, diameter: float) -> bool:
        """Whether what it cuts has a diameter, mm."""
        return abs(self.diameter - diameter) <= max(_WIDE, _SHARE * diameter)

    def comes_before(self, reamer: "Drill") -> bool:
        """Whether it leaves what a reamer takes off."""
        return _ALLOWANCE - 1e-9 <= reamer.diameter - self.diameter <= _ALLOWANCE + _MORE * reamer.diameter

    def points_at(self, cone: float | None) -> bool:
        """Whether its point leaves a cone at the bottom; its whole angle in rad."""
        return cone is not None and self.point is not None and abs(self.point - cone) <= _ANGLE

    def taps(self, thread: Thread) -> bool:
        """Whether it is a tap that cuts a thread."""
        return self.kind == "tap" and thread.equals(self.diameter, self.pitch, left=self.left)

    def sinks(self, diameter: float, angle: float) -> bool:
        """Whether it is a countersink that leaves one of a largest diameter, mm, and a whole angle, rad."""
        wide = self.diameter >= diameter - max(_WIDE, _SHARE * diameter)
        return self.kind == "countersink" and wide and self.point is not None and abs(self.point - angle) <= _SINK

    def in_hole(self, diameter: float) -> Cutter | None:
        """The body above its point, with flutes as wide as a hole, mm; None where there is no such tool."""
        body, off = self.body, self.point_length
        try:
            flutes = None if body.flutes is None else body.flutes - off
            return replace(body, radius=0.5 * diameter, length=body.length - off, flutes=flutes)
        except CutterError:
            return None

    def as_cone(self, angle: float) -> Cutter | None:
        """The body of a tool that cuts with a cone of a whole angle, rad; None where its flutes are shorter than that."""
        radius, high, top = self.body.radius, self.body.radius / math.tan(0.5 * angle), flute_length(self.body)
        if high > top + 1e-9:
            return None
        outline = [(0.0, 0.0), (radius, high), *([(radius, top)] if top > high + 1e-9 else [])]
        try:
            return replace(self.body, shape="form", outline=tuple(outline), flutes=None)
        except CutterError:
            return None


@dataclass(frozen=True, slots=True, eq=False)
class Drilled:
    """A tool goes down along the axis of a hole in a setup."""

    drill: Drill
    setup: int  #: Counted from 0.
    axis: Floats  #: (3,) float: unit tool axis.
    mouth: Floats  #: (3,) float: where it enters, mm: the middle of the mouth of the hole, of its countersink or counterbore.
    depth: float  #: How deep its full width goes under that, mm; a cone's tip.
    diameter: float  #: mm; that it leaves.
    main: bool = False  #: It makes the narrowest cylinder of the hole, or the last of it.

    @property
    def tip(self) -> Floats:
        """Where its tip stands at the deepest, (3,), mm."""
        cone = self.drill.kind in CONES
        return np.asarray(self.mouth - (self.depth + (0.0 if cone else self.drill.point_length)) * self.axis)


#: Tools that cut with their point.
CONES: tuple[Kind, ...] = ("centre drill", "countersink")


#: Why tools of its size do not make something; empty: there is none of its size.
Why = Literal["", "axis", "short", "in_the_way", "bottom"]


@dataclass(frozen=True, slots=True)
class Missing:
    """No tool makes this of a hole: its narrowest cylinder, a countersink or counterbore, its thread; or its tolerance."""

    thing: Literal["hole", "countersink", "counterbore", "thread", "reamer"]
    diameter: float  #: mm
    depth: float | None = None  #: mm; not of a countersink.
    angle: float | None = None  #: rad; of a countersink.
    why: Why = ""
    name: str = ""  #: Of a thread, as `M4`; of a hole that is to be reamed its class.


@dataclass(frozen=True, slots=True, eq=False)
class Bored:
    """All that tools make of a hole, in their order; and what none of them makes."""

    uses: tuple[Drilled, ...]
    missing: tuple[Missing, ...]

    @property
    def by(self) -> Drill | None:
        """The tool that makes its narrowest cylinder; None: none does."""
        return next((use.drill for use in self.uses if use.main), None)


#: The way of a drill at its feed, in depths of the hole: it begins over the mouth.
_WAY = 1.3


def time_of_hole(depth: float, feed: float, kind: Kind = "drill") -> float:
    """Time of a hole of a depth, mm, at a feed, mm/min, in s; pecks are not counted. A tap goes out as slowly as in.

    >>> time_of_hole(10.0, 260.0), time_of_hole(10.0, 260.0, "tap")
    (3.0, 6.0)
    """
    return _WAY * depth / feed * 60.0 * (2.0 if kind == "tap" else 1.0)


#: Diameters, 1/10,000 inch, of drills (ASME B94.11M): of numbers 1 to 60, and of letters A to Z.
_NUMBERS = (
    2280, 2210, 2130, 2090, 2055, 2040, 2010, 1990, 1960, 1935, 1910, 1890, 1850, 1820, 1800, 1770, 1730, 1695, 1660, 1610, 1590,
    1570, 1540, 1520, 1495, 1470, 1440, 1405, 1360, 1285, 1200, 1160, 1130, 1110, 1100, 1065, 1040, 1015, 995, 980, 960, 935, 890,
    860, 820, 810, 785, 760, 730, 700, 670, 635, 595, 550, 520, 465, 430, 420, 410, 400,
)  # fmt: skip
_LETTERS = (
    2340, 2380, 2420, 2460, 2500, 2570, 2610, 2660, 2720, 2770, 2810, 2900, 2950, 3020, 3160, 3230, 3320, 3390, 3480, 3580, 3680,
    3770, 3860, 3970, 4040, 4130,
)  # fmt: skip
_NAMES = {**{each: f"#{k}" for k, each in enumerate(_NUMBERS, 1)}, **{each: chr(65 + k) for k, each in enumerate(_LETTERS)}}
#: A diameter is that of a name within this, inch.
_SAME = 0.0004


def inch_name(diameter: float) -> str:
    """Name a drill of a diameter, inch: by a whole number of 1/64, a number or a letter; empty where it has no name.

    >>> inch_name(0.125), inch_name(0.201), inch_name(0.257), inch_name(0.25), inch_name(0.1299)
    ('1/8', '#7', 'F', '1/4', '')
    """
    fraction, near = Fraction(round(64.0 * diameter), 64), min(_NAMES, key=lambda each: abs(1e-4 * each - diameter))
    off, other = abs(float(fraction) - diameter) if fraction else 1.0, abs(1e-4 * near - diameter)
    if off <= min(_SAME, other):
        whole, rest = divmod(fraction, 1)
        return f"{whole}-{rest}" if whole and rest else str(fraction)
    return _NAMES[near] if other <= _SAME else ""
