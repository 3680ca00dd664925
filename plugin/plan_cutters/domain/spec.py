"""How cutters are written on a command line, and what their ids are."""

import math
import re
from collections.abc import Mapping
from typing import Any

from plan_cutters.domain.checks import shown
from plan_cutters.domain.dimensions import Dimensions
from plan_cutters.domain.holder import Holder, Segment
from plan_cutters.domain.lengths import LENGTH, Notation, across, length, text_of
from plan_cutters.errors import CutterError

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

    Raises
    ------
    CutterError
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
    """Say why a text is no valid cutter, and how it should be written."""
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
