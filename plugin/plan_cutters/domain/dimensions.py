"""A tool assembly in numbers: what a cutter is made of, each number by itself a possible one."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Literal, TypedDict

from plan_cutters.domain.checks import items, name, number, shown
from plan_cutters.domain.holder import Holder, Segment, positive
from plan_cutters.errors import CutterError

#: Kinds of cutting part: an end mill, straight or tapered; a ball on a neck; a flank of a large arc; a bottom of one; points.
Shape = Literal["end", "lollipop", "barrel", "lens", "form"]
_SHAPES = ("end", "lollipop", "barrel", "lens", "form")


class AboveTip(TypedDict, total=False):
    """Attributes of a cutter beside the radii of its tip, as a caller may give them: `Dimensions` says what each means."""

    taper: float
    taper_deg: float | None
    flutes: float | None
    neck: Segment | Sequence[Segment] | None
    shank_radius: float | None
    holder: Holder | str | None
    allowance: float | None
    clearance: float | None


class Attributes(AboveTip, total=False):
    """The same with the name of a cutter."""

    name: str


@dataclass(frozen=True, slots=True)
class Dimensions:
    """A tool assembly as the search sees it: a solid of revolution, from the tip to the end of its holder.

    Attributes
    ----------
    radius : float
        Of the cutting part, mm: of a tapered one at the tip, as if its corner were that of a straight one; of a barrel the
        largest.
    length : float
        mm from the tip to the holder's nose, or to the end of all that is checked where there is no holder.
    corner_radius : float
        mm; 0 for a flat end, the radius for a ball; of a barrel the radius of its tip, 0 for none.
    name : str
        For people; the id is made from the dimensions.
    taper : float
        Half angle, rad (of a `Cutter` also `taper_deg`, degrees): positive where the radius grows from the tip up, negative
        for a dovetail.
    flutes : float, optional
        Height over the tip up to which it cuts, mm. None: up to the first stage above, or all of its length.
    neck : Segment or tuple of Segment, optional
        What stands right above the flutes: one section, or several from there up.
    shank_radius : float, optional
        From there up to `length`, mm. None: the part that cuts, or the neck, goes on.
    holder : Holder, optional
    shape : str
        `end`, `lollipop`, `barrel`, `lens` or `form`.
    arc_radius, arc_height : float
        Of a barrel's flank or a lens's bottom: its radius, and the height of a barrel's widest place over the tip, mm.
    outline : tuple of (float, float)
        Of a form: points (radius, height) from the axis at the tip to the end of the flutes, mm.
    allowance, clearance : float, optional
        Stock left on the surface, and clearance required of neck, shank and holder, mm. None: as asked for the whole plan.
    """

    radius: float
    length: float
    corner_radius: float = 0.0
    name: str = ""
    taper: float = 0.0
    flutes: float | None = None
    neck: Segment | tuple[Segment, ...] | None = None
    shank_radius: float | None = None
    holder: Holder | None = None
    shape: Shape = "end"
    arc_radius: float = 0.0
    arc_height: float = 0.0
    outline: tuple[tuple[float, float], ...] = ()
    allowance: float | None = None
    clearance: float | None = None

    def __post_init__(self) -> None:
        for word in ("corner_radius", "taper", "arc_radius", "arc_height"):
            value = number(getattr(self, word), f"cutter {word.replace('_', ' ')}", error=CutterError)
            object.__setattr__(self, word, value)
        for word in ("radius", "length"):
            object.__setattr__(self, word, positive(getattr(self, word), f"cutter {word}"))
        object.__setattr__(self, "name", name(self.name, "a cutter's name", error=CutterError))
        if not isinstance(self.shape, str) or self.shape not in _SHAPES:
            raise CutterError(f"a cutter's shape must be one of {', '.join(_SHAPES)}, not {shown(self.shape)}")
        for word in ("flutes", "shank_radius"):
            if getattr(self, word) is not None:
                object.__setattr__(self, word, positive(getattr(self, word), f"cutter {word.replace('_', ' ')}"))
        for word in ("allowance", "clearance"):
            if getattr(self, word) is not None:
                object.__setattr__(self, word, positive(getattr(self, word), f"cutter {word}", zero=True))
        if isinstance(self.holder, str):
            object.__setattr__(self, "holder", Holder.parse(self.holder))
        if not isinstance(self.holder, Holder | None):
            raise CutterError(f"a cutter's holder must be a Holder, not {shown(self.holder)}")
        object.__setattr__(self, "neck", _neck(self.neck))
        object.__setattr__(self, "outline", points_of(self.outline))

    @property
    def necks(self) -> tuple[Segment, ...]:
        """The sections of the neck, from the flutes up; none where there is no neck."""
        if self.neck is None:
            return ()
        return (self.neck,) if isinstance(self.neck, Segment) else self.neck

    @property
    def neck_length(self) -> float:
        """Of all sections of the neck, mm."""
        return math.fsum(stage.length for stage in self.necks)


def _neck(value: Any) -> Segment | tuple[Segment, ...] | None:
    """One section as itself, several as a tuple: so that one neck has one form."""
    if value is None or isinstance(value, Segment):
        return value
    segments = items(value, "a cutter's neck", "stages", error=CutterError)
    for each in segments:
        if not isinstance(each, Segment):
            raise CutterError(f"a cutter's neck must be a Segment or several, not {shown(each)}")
    return tuple(segments) if len(segments) > 1 else segments[0] if segments else None


def points_of(outline: Any) -> tuple[tuple[float, float], ...]:
    points = []
    for point in items(outline, "an outline", "points (radius, height)", error=CutterError):
        pair = items(point, "a point of an outline", "a radius and a height", error=CutterError)
        if len(pair) != 2:
            raise CutterError("a point of an outline is a radius and a height, two numbers")
        r, h = (number(value, "a radius or height of an outline", error=CutterError) for value in pair)
        if not (math.isfinite(r) and math.isfinite(h)):
            raise CutterError("radii and heights of an outline must be finite")
        points.append((r, h))
    return tuple(points)
