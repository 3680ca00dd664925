"""Stages: round sections of which necks, shanks and holders are made, and how a holder is written on a command line.

Collet chucks are known by word: `er32`, `hsk63a-er32`, `bt40-er16x100`. Around a body of revolution stages are made of which none
is smaller than what it encloses.
"""

import math
import re
from bisect import bisect_right
from dataclasses import dataclass
from difflib import get_close_matches
from itertools import groupby, pairwise
from operator import itemgetter
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from cad_io.arrays import Floats
from plan_cutters.domain.checks import items, name, number, shown
from plan_cutters.domain.figures import LENGTH, Notation, across, length
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
    """A round section of a holder, shank or neck: a cylinder or a cone."""

    radius: float  #: At its lower (tip) end, mm.
    length: float  #: mm.
    upper_radius: float = math.nan  #: At its upper (spindle) end, mm; the lower one unless it is given.

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

        Raises CutterError.

        >>> Holder.parse("D1inL2in").id, Holder.parse("er16").name
        ('R12.7L50.8', 'ER16')
        """
        if not isinstance(spec, str):
            raise CutterError(f"{shown(spec)} is no holder: give a Holder or a text such as 'R15L30'")
        if (made := chuck(spec.strip())) is not None:
            return made
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


# Collet chucks are outer bounds of what standards and makers make (`docs/tools.md` has their sources). Where makers differ, what
# is wider is taken, and what is wide begins as near to the tip as it does anywhere: a real chuck lies within the one that is
# drawn. Nothing is drawn beyond the gauge line: the spindle is not part of a holder.


class Nose(NamedTuple):
    """A clamping nut for ER collets, mm: the widest one's diameter, the shortest one's length, the largest shank."""

    diameter: float
    length: float
    bore: float


class Taper(NamedTuple):
    """The dimensions of a holder below its gauge line, mm: the flange, the body behind it, and the usual gauge length."""

    name: str
    flange: float  #: Diameter.
    depth: float  #: How far the flange reaches down from the gauge line or the contact face.
    body: float  #: Diameter that the body between flange and nut may have.
    gauge: float  #: From the gauge line to the nose, of the shortest of the usual chucks: the flange stands no higher.


#: ISO 15488 (DIN 6499): collets and their nuts, plain and slotted, whichever is wider.
NOSES = {
    "er11": Nose(19.1, 11.0, 7.0),
    "er16": Nose(32.0, 17.0, 10.0),
    "er20": Nose(35.0, 18.5, 13.0),
    "er25": Nose(42.1, 19.5, 16.0),
    "er32": Nose(50.1, 22.0, 20.0),
    "er40": Nose(63.1, 25.0, 26.0),
}
#: ISO 12164-1 (DIN 69893): flange d1, its height f1, and the room d10 that is kept for the gripper behind it.
#: ISO 7388-1 (DIN 69871, ASME B5.50): flange, down to its front face, and the body's largest diameter before 35 mm.
#: ISO 7388-2 (JIS B 6339, MAS 403): the same; it leaves the body open, so it is as wide as the flange.
TAPERS = {
    "hsk32a": Taper("HSK32A", 32.0, 20.0, 26.0, 50.0),
    "hsk40a": Taper("HSK40A", 40.0, 20.0, 34.0, 60.0),
    "hsk50a": Taper("HSK50A", 50.0, 26.0, 42.0, 70.0),
    "hsk63a": Taper("HSK63A", 63.0, 26.0, 53.0, 70.0),
    "hsk100a": Taper("HSK100A", 100.0, 29.0, 85.0, 80.0),
    "hsk32e": Taper("HSK32E", 32.0, 20.0, 26.0, 50.0),
    "hsk40e": Taper("HSK40E", 40.0, 20.0, 34.0, 60.0),
    "hsk50e": Taper("HSK50E", 50.0, 26.0, 42.0, 70.0),
    "sk30": Taper("SK30", 50.0, 19.1, 45.0, 50.0),
    "sk40": Taper("SK40", 63.55, 19.1, 50.0, 60.0),
    "sk50": Taper("SK50", 97.5, 19.1, 80.0, 70.0),
    "cat40": Taper("CAT40", 63.6, 19.1, 50.0, 59.0),
    "cat50": Taper("CAT50", 98.6, 19.1, 80.0, 70.0),
    "bt30": Taper("BT30", 46.0, 22.0, 46.0, 50.0),
    "bt40": Taper("BT40", 63.0, 27.0, 63.0, 60.0),
    "bt50": Taper("BT50", 100.0, 38.0, 100.0, 70.0),
}
#: How far a nose alone is drawn unless it is said, mm; and the longest holder.
_ALONE, _LONGEST = 60.0, 500.0
#: Other spellings: HSK-A63 and A63 for hsk63a, DIN 69871's SK and ISO's own short names.
_SPELLED = ((r"(?:hsk)?([ae])(32|40|50|63|100)", r"hsk\2\1"), (r"ct(40|50)", r"cat\1"), (r"(?:iso|dv)(30|40|50)", r"sk\1"))
_WORD = re.compile(rf"(?:(?P<taper>[a-z0-9]+?))?(?P<nose>er[0-9]+)(?:x(?P<length>{LENGTH}))?")


def words() -> list[str]:
    """Every word of the tables, noses alone first."""
    return [*NOSES, *(f"{taper}-{nose}" for taper in TAPERS for nose in NOSES)]


def chuck(text: str) -> Holder | None:
    """The holder that a word names; None for a text that looks like no such word.

    Raises CutterError: it looks like one and is none, or is too short for its own flange and nut.

    >>> chuck("ER16").id, chuck("ER16").bore, chuck("HSK-A63/ER32x100").name
    ('R16L60', 10.0, 'HSK63A-ER32x100')
    """
    plain = re.sub(r"[-_/\s]+", "", text.lower())
    if not re.match(r"er[0-9]|hsk|bt[0-9]|sk[0-9]|cat|ct[0-9]|iso[0-9]|dv[0-9]|[ae][0-9]{2,3}er", plain):
        return None
    match = _WORD.fullmatch(plain)
    nose = NOSES.get(match["nose"]) if match else None
    taper = _taper(match["taper"]) if match and match["taper"] else None
    if match is None or nose is None or (match["taper"] and taper is None):
        raise CutterError(f"no holder is called {text!r}; {_near(plain)}")
    short = match["nose"].upper()
    high = _ALONE if taper is None else taper.gauge
    if match["length"]:
        high = length(match["length"])
    least = nose.length if taper is None else nose.length + taper.depth
    if not least <= high <= _LONGEST:
        what = "its nut takes" if taper is None else "its nut and its flange take"
        raise CutterError(
            f"holder {text!r}: {what} {least:g} mm; give a length from that to {_LONGEST:g} mm, as "
            f"{match['taper'] or ''}{'-' if taper else ''}{match['nose']}x100"
        )
    if taper is None:
        name = short if not match["length"] else f"{short}x{high:g}"
        return Holder((Segment(nose.diameter / 2, high),), name, nose.bore)
    sections = (nose.diameter, nose.length), (max(nose.diameter, taper.body), high - least), (taper.flange, taper.depth)
    # Those of one diameter that follow each other are one.
    runs = groupby(((diameter / 2, long) for diameter, long in sections if long > 0.0), itemgetter(0))
    stages = tuple(Segment(radius, sum(long for _, long in run)) for radius, run in runs)
    return Holder(stages, f"{taper.name}-{short}x{high:g}", nose.bore)


def _taper(plain: str) -> Taper | None:
    for pattern, word in _SPELLED:
        plain = re.sub(rf"^{pattern}$", word, plain)
    return TAPERS.get(plain)


def _near(plain: str) -> str:
    known = words()
    by = {word.replace("-", ""): word for word in known}
    near = [by[each] for each in get_close_matches(plain.partition("x")[0], by, 3, 0.5)]
    if near:
        return f"{' or '.join(near)}? plan-cutters tools --list-holders lists all"
    return f"known are {', '.join(NOSES)}, alone or on {', '.join(TAPERS)}, as hsk63a-er32"


#: Heights and radii this close to each other, mm, are the same.
_SAME = 1e-9
#: Slices into which what is no line of its own is cut.
_SLICES = 400
#: A stage is nowhere thinner, mm.
_THINNEST = 1e-3
#: Times by which stages may get coarser until there are few enough, each time twice.
_ROUNDS = 24

#: Height from, height to, radius there and there: enclosing lines, end to end.
Line = tuple[float, float, float, float]


def enclosing_segments(
    line: Floats, exact: NDArray[np.bool_], foot: float, *, tolerance: float, most: int
) -> tuple[tuple[Segment, ...], float]:
    """Stages that enclose lines of a half-plane.

    `line` (n, 4) float: radius and height of both ends, the lower one first, mm. `exact` (n,) bool: lines that become stages as
    they are where they are the outermost ones. `foot`: height from which on stages are wanted, mm. `tolerance`: how much farther
    from the axis than the others stages may be, mm; twice as much, and so on, until there are no more than `most`. Returns the
    stages, from the lowest up, and the tolerance that was kept. Raises CutterError: the lines span no height, or leave a gap.
    """
    low, high = foot, float(line[:, 3].max())
    if high - low <= _SAME:
        raise CutterError("a holder's outline spans no height along its axis: is it modelled about another axis?")
    top = _envelope(line, exact, low, high)
    keep, allowed = True, tolerance
    lines = _joined_lines(top, allowed, keep=keep)
    for _ in range(_ROUNDS):
        if len(lines) <= most:
            break
        # Too many cylinders and cones of their own: they are joined, too.
        keep = keep and len(_joined_lines([each for each in top if each[1]], 0.0, keep=True)) < most - 1
        allowed *= 2.0
        lines = _joined_lines(top, allowed, keep=keep)
    stages = [Segment(max(r, _THINNEST), to - z, max(s, _THINNEST)) for z, to, r, s in lines if to - z > _SAME]
    return tuple(stages), allowed


def _envelope(line: Floats, exact: NDArray[np.bool_], low: float, high: float) -> list[tuple[Line, bool]]:
    """The outermost of all lines, end to end from the lowest up, and whether it is one of the exact ones."""
    long = line[:, 3] - line[:, 1] > _SAME
    own, others = line[exact & long], line[~exact]
    cuts = [own[:, 1], own[:, 3], _crossings(own), np.array([low, high])]
    if 0 < len(others) <= _SLICES:
        cuts += [others[:, 1], others[:, 3]]
    elif len(others):
        cuts.append(np.linspace(others[:, 1].min(), others[:, 3].max(), _SLICES))
    heights = np.unique(np.concatenate(cuts).clip(low, high))
    heights = heights[np.append(True, np.diff(heights) > _SAME)]
    pieces: list[tuple[Line, bool]] = []
    for z, to in pairwise(heights.tolist()):
        mine = own[(own[:, 1] <= z + _SAME) & (own[:, 3] >= to - _SAME)]
        near = others[(others[:, 1] < to) & (others[:, 3] > z)]
        across = (near[:, 1] <= z + _SAME) & (near[:, 3] >= to - _SAME)
        # What ends within the slice counts all over it with the largest radius that it has there.
        part = near[~across]
        level = max(float(_at(part, np.clip(end, part[:, 1], part[:, 3])).max(initial=-1.0)) for end in (z, to))
        ends = [
            _at(lines, height).max(initial=least) for lines, least in ((mine, -1.0), (near[across], level)) for height in (z, to)
        ]
        first, last = max(ends[0], ends[2]), max(ends[1], ends[3])
        if first < 0.0:
            raise CutterError(f"a holder's outline has a gap between the heights {z:.3g} and {to:.3g} mm: give one body")
        pieces.append(((z, to, float(first), float(last)), ends[0] >= ends[2] and ends[1] >= ends[3]))
    all_round = np.array([(first, z, last, to) for (z, to, first, last), _ in pieces])
    for height, radius in line[exact & ~long][:, [1, 2]].tolist():
        adjacent = all_round[(all_round[:, 1] <= height + _SAME) & (all_round[:, 3] >= height - _SAME)]
        if height >= low and _at(adjacent, np.array(height)).max(initial=0.0) < radius - 1e-6:
            raise CutterError(f"a holder's outline ends in a disk without thickness at the height {height:.3g} mm: close it")
    return pieces


def _at(lines: Floats, height: Floats) -> Floats:
    """Radii of lines at heights; of a line that is level, the larger one."""
    rise = lines[:, 3] - lines[:, 1]
    share = np.divide(height - lines[:, 1], rise, out=np.zeros(len(lines)), where=rise > _SAME)
    radius = lines[:, 0] + share * (lines[:, 2] - lines[:, 0])
    return np.where(rise > _SAME, radius, np.maximum(lines[:, 0], lines[:, 2]))


def _crossings(lines: Floats) -> Floats:
    if len(lines) < 2:
        return np.zeros(0)
    slope = (lines[:, 2] - lines[:, 0]) / (lines[:, 3] - lines[:, 1])
    foot = lines[:, 0] - slope * lines[:, 1]
    i, j = np.triu_indices(len(lines), 1)
    apart = slope[i] - slope[j]
    i, j, apart = i[np.abs(apart) > _SAME], j[np.abs(apart) > _SAME], apart[np.abs(apart) > _SAME]
    height = (foot[j] - foot[i]) / apart
    inside = (height > np.maximum(lines[i, 1], lines[j, 1])) & (height < np.minimum(lines[i, 3], lines[j, 3]))
    return np.asarray(height[inside])


def _joined_lines(top: list[tuple[Line, bool]], tolerance: float, *, keep: bool) -> list[Line]:
    """Lines joined as long as one around them is nowhere farther out than the tolerance; `keep` exact ones as they are."""
    merged: list[Line] = []
    at = 0
    while at < len(top):
        own = top[at][1] and keep
        allowed = _SAME if own else tolerance
        run = next((i for i in range(at, len(top)) if (top[i][1] and keep) != own), len(top)) - at
        lines = [line for line, _ in top[at : at + run]]
        # The line around more is nowhere nearer.
        few = 1 + bisect_right(range(2, run + 1), allowed, key=lambda count: _enclosing(lines[:count])[1])
        merged.append(_enclosing(lines[:few])[0])
        at += few
    return merged


def _enclosing(lines: list[Line]) -> tuple[Line, float]:
    """The line from the first height to the last, nowhere nearer to the axis than those given, that is farther out by least."""
    z = np.array([height for low, high, _, _ in lines for height in (low, high)])
    y = np.array([radius for _, _, first, last in lines for radius in (first, last)])
    if len(lines) == 1:
        return lines[0], 0.0
    # The narrowest strip around points has a side of their hull on one of its borders.
    slopes = [0.0, *_hull_slopes(z, y), *(-slope for slope in _hull_slopes(z, -y))]
    best: tuple[float, float, float] | None = None
    for slope in slopes:
        foot = float((y - slope * z).max())
        off = float((slope * z + foot - y).max())
        if best is None or off < best[0] - _SAME:
            best = off, slope, foot
    assert best is not None
    off, slope, foot = best
    return (float(z[0]), float(z[-1]), slope * float(z[0]) + foot, slope * float(z[-1]) + foot), off


def _hull_slopes(z: Floats, y: Floats) -> list[float]:
    """Slopes of the upper side of the hull of points, which are in the order of z."""
    hull: list[tuple[float, float]] = []
    for point in sorted(zip(z.tolist(), y.tolist(), strict=True)):
        if hull and point[0] - hull[-1][0] <= _SAME:
            point = (hull[-1][0], max(point[1], hull.pop()[1]))
        while len(hull) > 1 and (hull[-1][1] - hull[-2][1]) * (point[0] - hull[-2][0]) <= (point[1] - hull[-2][1]) * (
            hull[-1][0] - hull[-2][0]
        ):
            hull.pop()
        hull.append(point)
    return [(b[1] - a[1]) / (b[0] - a[0]) for a, b in pairwise(hull)]
