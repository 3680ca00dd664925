"""How cutters are written on a command line, and what their ids are."""

import math
import re
from typing import Any

from plan_cutters.domain.checks import shown
from plan_cutters.domain.dimensions import Dimensions
from plan_cutters.domain.holder import Segment, text_of
from plan_cutters.domain.lengths import LENGTH, across, length
from plan_cutters.errors import CutterError

_ANGLE = r"-?(?:[0-9]+\.?[0-9]*|\.[0-9]+)"
_CUTTER = re.compile(
    rf"(?P<by>[RD])(?P<radius>{LENGTH})L(?P<length>{LENGTH})(?:rc(?P<corner>{LENGTH}))?(?:T(?P<taper>{_ANGLE}))?"
    rf"(?:F(?P<flutes>{LENGTH}))?(?P<necks>(?:N{LENGTH}(?::{LENGTH})?x{LENGTH})*)(?:S(?P<shank>{LENGTH}))?",
    re.IGNORECASE,
)
_NECK = re.compile(rf"N(?P<radius>{LENGTH})(?::(?P<upper>{LENGTH}))?x(?P<length>{LENGTH})", re.IGNORECASE)


def is_spec(text: str) -> bool:
    """Whether a text is of the form that `dimensions` reads."""
    return _CUTTER.fullmatch(text.strip()) is not None


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
        return (f"cutter {spec!r} is not of the form R6L80 (radius 6 mm, length 80 mm) or D12L80 (diameter 12 mm, length "
                "80 mm); D0.5inL3in is in inches")  # fmt: skip
    return (f"cutter {spec!r}: {spec.strip()[begun.end():]!r} is none of what may follow {begun[0]}: in this order, rc1 corner "
            "radius, T5 taper, F20 flutes, N5.5x40 neck, S6 shank")  # fmt: skip


def written(cutter: Dimensions) -> str:
    """The id of a cutter: its dimensions, in the words of `dimensions` where these have words for it."""
    words = [f"R{text_of(cutter.radius)}L{text_of(cutter.length)}"]
    if cutter.corner_radius:
        words.append(f"rc{text_of(cutter.corner_radius)}")
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
        words.append(f"F{text_of(cutter.flutes)}")
    for neck in cutter.necks:
        upper = "" if neck.upper_radius == neck.radius else f":{text_of(neck.upper_radius)}"
        words.append(f"N{text_of(neck.radius)}{upper}x{text_of(neck.length)}")
    if cutter.shank_radius is not None:
        words.append(f"S{text_of(cutter.shank_radius)}")
    if cutter.holder is not None:
        words.append(f"H{cutter.holder.id}")
    if cutter.allowance is not None:
        words.append(f"a{text_of(cutter.allowance)}")
    if cutter.clearance is not None:
        words.append(f"c{text_of(cutter.clearance)}")
    return "".join(words)
