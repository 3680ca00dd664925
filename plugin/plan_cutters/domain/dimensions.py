"""A tool assembly in numbers, each by itself a possible one; how cutters are written in a word, and what their ids are."""

import math
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Literal, TypedDict

from plan_cutters.domain.checks import items, name, number, shown
from plan_cutters.domain.figures import LENGTH, Notation, across, length, text_of
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
    """A tool assembly as the search sees it: a solid of revolution, from the tip to the end of its holder."""

    #: Of the cutting part, mm: of a tapered one at the tip, as if its corner were that of a straight one; a barrel's largest.
    radius: float
    length: float  #: mm from the tip to the holder's nose, or to the end of all that is checked where there is no holder.
    corner_radius: float = 0.0  #: mm; 0 for a flat end, the radius for a ball; of a barrel the radius of its tip, 0 for none.
    name: str = ""  #: For people; the id is made from the dimensions.
    #: Half angle, rad (of a `Cutter` also `taper_deg`, degrees): positive where the radius grows from the tip up, negative for a
    #: dovetail.
    taper: float = 0.0
    #: Height over the tip up to which it cuts, mm. None: up to the first stage above, or all of its length.
    flutes: float | None = None
    #: What stands right above the flutes: one section, or several from there up.
    neck: Segment | tuple[Segment, ...] | None = None
    shank_radius: float | None = None  #: From there up to `length`, mm. None: the part that cuts, or the neck, goes on.
    holder: Holder | None = None
    shape: Shape = "end"
    #: Of a barrel's flank or a lens's bottom: its radius, and the height of a barrel's widest place over the tip, mm.
    arc_radius: float = 0.0
    arc_height: float = 0.0
    #: Of a form: points (radius, height) from the axis at the tip to the end of the flutes, mm.
    outline: tuple[tuple[float, float], ...] = ()
    #: Stock left on the surface, and clearance required of neck, shank and holder, mm. None: as asked for the whole plan.
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


_ANGLE = r"-?(?:[0-9]+\.?[0-9]*|\.[0-9]+)"
_CUTTER = re.compile(
    rf"(?P<by>[RD])(?P<radius>{LENGTH})L(?P<length>{LENGTH})(?:rc(?P<corner>{LENGTH}))?(?:T(?P<taper>{_ANGLE}))?"
    rf"(?:F(?P<flutes>{LENGTH}))?(?P<necks>(?:N{LENGTH}(?::{LENGTH})?x{LENGTH})*)(?:S(?P<shank>{LENGTH}))?",
    re.IGNORECASE,
)
#: The notation of ids.
_ID = Notation("R")
_NECK = re.compile(rf"N(?P<radius>{LENGTH})(?::(?P<upper>{LENGTH}))?x(?P<length>{LENGTH})", re.IGNORECASE)


def is_spec(text: str) -> bool:
    """Whether a text is of the form that `dimensions` reads, with or without a holder.

    >>> is_spec("D12L80"), is_spec("D12L80Her16"), is_spec("D12L80 Hard"), is_spec("Finisher")
    (True, True, False, False)
    """
    head, holder = parted(text.strip())
    if _CUTTER.fullmatch(head) is None:
        return False
    try:
        return holder is None or bool(Holder.parse(holder))
    except CutterError:
        return False


def parted(text: str) -> tuple[str, str | None]:
    """The word of a cutter, and that of the holder behind its H; None where there is none."""
    at = text.upper().find("H")
    return (text, None) if at < 0 else (text[:at], text[at + 1 :])


def notation(name: str) -> Notation:
    """How a cutter was given, by its name: by radius where that is empty or such a word, in inches where they stand in it.

    Tools of libraries have names of their own; shops call them by diameter.

    >>> notation("D0.5inL3in"), notation("r6L80"), notation("Finisher").by
    (Notation(by='D', inches=True), Notation(by='R', inches=False), 'D')
    """
    if not name or is_spec(name):
        return Notation("D" if name.strip().upper().startswith("D") else "R", "in" in parted(name)[0].lower())
    return Notation("D")


def typed(id: str, name: str) -> str:
    """A cutter in the word by which it was given; its id where it has another name or none.

    >>> typed("R6L80", "D12L80"), typed("R6L80", ""), typed("R6L80", "Finisher")
    ('D12L80', 'R6L80', 'R6L80')
    """
    return name if is_spec(name) else id


def renamed(text: str, names: Mapping[str, str]) -> str:
    """A text with ids of cutters in other words.

    >>> renamed("R6L80 and R6L80rc1, not R6L80+R2", {"R6L80": "D12", "R6L80rc1": "bull"})
    'D12 and bull, not R6L80+R2'
    """
    # The longest first: an id may begin as another one does. Nor is it the beginning of another cutter's.
    ids = "|".join(re.escape(name) for name in sorted(names, key=len, reverse=True))
    return re.sub(rf"(?<!\w)(?:{ids})(?!\w|[.:]\d|\+R)", lambda match: names[match[0]], text) if ids else text


def spelled(cutter: Dimensions) -> str:
    """The word of a cutter in the notation of its name: that of another one made of it, too."""
    return written(cutter, notation(cutter.name))


def dimensions(spec: str) -> dict[str, Any]:
    """The dimensions of a cutter from a text such as `R6L80rc1F20N5.5x40S6`, or `D12L80rc1F20N11x40S12`, which is the same.

    Radius and length; then, each where there is one: `rc` corner radius, `T` half angle of a taper in degrees, `F` length of
    the flutes, `N` radius of a neck `x` its length (`N5:6x4` a cone; more of them from there up), `S` radius of the shank.
    A text that begins with `D` has diameters for `D`, `N` and `S`. Lengths are in mm; `in` behind a number makes that one inches.

    Raises CutterError.
    """
    if not isinstance(spec, str):
        raise CutterError(f"{shown(spec)} is no cutter: give a Cutter or a text such as 'R6L80'")
    match = _CUTTER.fullmatch(spec.strip())
    if not match:
        raise CutterError(_wrong(spec))
    words, by = match.groupdict(), match["by"]
    necks = [
        Segment(across(by, each["radius"]), length(each["length"]), across(by, each["upper"] or each["radius"]))
        for each in _NECK.finditer(words["necks"])
    ]
    return {
        "radius": across(by, words["radius"]),
        "length": length(words["length"]),
        "corner_radius": length(words["corner"] or "0"),
        "taper": math.radians(float(words["taper"] or 0.0)),
        "flutes": None if words["flutes"] is None else length(words["flutes"]),
        "neck": necks,
        "shank_radius": None if words["shank"] is None else across(by, words["shank"]),
    }


def _wrong(spec: str) -> str:
    begun = _CUTTER.match(spec.strip())
    if begun is None:
        return (
            f"cutter {spec!r} is not of the form R6L80 (radius 6 mm, length 80 mm) or D12L80 (diameter 12 mm, length "
            "80 mm); D0.5inL3in is in inches"
        )
    return (
        f"cutter {spec!r}: {spec.strip()[begun.end() :]!r} is none of what may follow {begun[0]}: in this order, rc1 corner "
        "radius, T5 taper, F20 flutes, N5.5x40 neck, S6 shank"
    )


def written(cutter: Dimensions, how: Notation = _ID) -> str:
    """A cutter's dimensions in the words of `dimensions`, where these have words for it: its id unless `how` says otherwise."""
    words = [f"{how.by}{how.across(cutter.radius)}L{how.length(cutter.length)}"]
    if cutter.corner_radius:
        words.append(f"rc{how.length(cutter.corner_radius)}")
    if cutter.taper:
        words.append(f"T{text_of(math.degrees(cutter.taper))}")
    if cutter.shape in ("barrel", "lens"):
        words.append(f"{cutter.shape}{text_of(cutter.arc_radius)}")
        if cutter.shape == "barrel" and not cutter.corner_radius:
            words.append(f"at{text_of(cutter.arc_height)}")
    elif cutter.shape != "end":
        words.append(cutter.shape)
    words += [f"_{text_of(r)}x{text_of(h)}" for r, h in cutter.outline]
    if cutter.flutes is not None:
        words.append(f"F{how.length(cutter.flutes)}")
    for neck in cutter.necks:
        upper = "" if neck.upper_radius == neck.radius else f":{how.across(neck.upper_radius)}"
        words.append(f"N{how.across(neck.radius)}{upper}x{how.length(neck.length)}")
    if cutter.shank_radius is not None:
        words.append(f"S{how.across(cutter.shank_radius)}")
    if cutter.holder is not None:
        words.append(f"H{cutter.holder.written(how)}")
    if cutter.allowance is not None:
        words.append(f"a{text_of(cutter.allowance)}")
    if cutter.clearance is not None:
        words.append(f"c{text_of(cutter.clearance)}")
    return "".join(words)
