"""How cutters are written on a command line, and what their ids are."""

import math
import re
from typing import Any

from plan_cutters.domain.checks import shown
from plan_cutters.domain.dimensions import Dimensions
from plan_cutters.domain.holder import NUMBER, Stage, text_of
from plan_cutters.errors import CutterError

_CUTTER = re.compile(
    rf"R(?P<radius>{NUMBER})L(?P<length>{NUMBER})(?:rc(?P<corner>{NUMBER}))?(?:T(?P<taper>{NUMBER}))?"
    rf"(?:F(?P<flutes>{NUMBER}))?(?P<necks>(?:N{NUMBER}(?::{NUMBER})?x{NUMBER})*)(?:S(?P<shank>{NUMBER}))?",
    re.IGNORECASE,
)
_NECK = re.compile(rf"N(?P<radius>{NUMBER})(?::(?P<upper>{NUMBER}))?x(?P<length>{NUMBER})", re.IGNORECASE)


def dimensions(spec: str) -> dict[str, Any]:
    """The dimensions of a cutter from a text such as `R6L80rc1F20N5.5x40S6`.

    Radius and length; then, each where there is one: `rc` corner radius, `T` half angle of a taper in degrees, `F` length of
    the flutes, `N` radius of a neck `x` its length (`N5:6x4` a cone; more of them from there up), `S` radius of the shank.
    All in mm.

    Raises
    ------
    CutterError
    """
    if not isinstance(spec, str):
        raise CutterError(f"{shown(spec)} is no cutter: give a Cutter or a text such as 'R6L80'")
    match = _CUTTER.fullmatch(spec.strip())
    if not match:
        raise CutterError(f"cutter {spec!r} is not of the form R6L80 (radius 6 mm, length 80 mm)")
    words = match.groupdict()
    necks = [
        Stage(float(each["radius"]), float(each["length"]), float(each["upper"] or each["radius"]))
        for each in _NECK.finditer(words.pop("necks"))
    ]
    numbers = {name: float(text) for name, text in words.items() if text is not None}
    return {
        "radius": numbers["radius"],
        "length": numbers["length"],
        "corner_radius": numbers.get("corner", 0.0),
        "taper": math.radians(numbers.get("taper", 0.0)),
        "flutes": numbers.get("flutes"),
        "neck": necks,
        "shank_radius": numbers.get("shank"),
    }


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
