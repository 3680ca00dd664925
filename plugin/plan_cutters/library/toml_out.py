"""Cutters in our own format: what is written is read as the same cutters, bit for bit."""

import json
import math
from collections.abc import Iterable

from plan_cutters.domain.cutter import Cutter
from plan_cutters.domain.holder import Holder, Segment
from plan_cutters.library.raw_tool import name_of
from plan_cutters.library.records import Library


def toml_text(text: str) -> str:
    """A TOML string."""
    clean = text.encode("utf-8", "replace").decode("utf-8")
    return json.dumps(clean, ensure_ascii=False).replace("\x7f", "\\u007f")


def _rows(stages: Iterable[Segment]) -> str:
    rows = []
    for stage in stages:
        upper = [] if stage.upper_radius == stage.radius else [stage.upper_radius]
        rows.append(f"[{', '.join(repr(float(v)) for v in (stage.radius, stage.length, *upper))}]")
    return f"[{', '.join(rows)}]"


def _angle(taper: float) -> str:
    """Degrees, where they turn into the same radians."""
    degrees = math.degrees(taper)
    for each in (round(degrees, 9), degrees, math.nextafter(degrees, 0.0), math.nextafter(degrees, 2.0 * degrees)):
        if math.radians(each) == taper:
            return repr(each)
    return f'"{taper!r} rad"'


def _kind(cutter: Cutter) -> str:
    if cutter.shape != "end":
        return cutter.shape
    if cutter.taper:
        return "taper" if cutter.taper > 0.0 else "dovetail"
    return "flat" if not cutter.corner_radius else "ball" if cutter.corner_radius == cutter.radius else "bull"


def _holder(holder: Holder | None) -> str:
    if holder is None:
        return '"none"'
    name = f"name = {toml_text(holder.name)}, " if holder.name else ""
    return f"{{ {name}stages = {_rows(holder.stages)} }}"


def _written(cutter: Cutter, name: str, number: int | None, feed: float | None = None) -> list[str]:
    lines = ["", "[[tool]]"]
    if number is not None:
        lines.append(f"number = {number}")
    if name:
        lines.append(f"name = {toml_text(name)}")
    lines.append(f'type = "{_kind(cutter)}"')
    if cutter.shape != "form":
        lines.append(f"DC = {2.0 * cutter.radius!r}")
    if cutter.corner_radius and cutter.shape != "lollipop":
        lines.append(f"RE = {cutter.corner_radius!r}")
    if cutter.taper:
        lines.append(f"TA = {_angle(abs(cutter.taper) if cutter.taper < 0.0 else cutter.taper)}")
    if cutter.shape in ("barrel", "lens"):
        lines.append(f"PRFRAD = {cutter.arc_radius!r}")
        lines.append(f"profile_height = {cutter.arc_height!r}")
    if cutter.outline:
        lines.append(f"outline = [{', '.join(f'[{float(h)!r}, {float(r)!r}]' for r, h in cutter.outline)}]")
    if cutter.shape not in ("lollipop", "form"):
        lines.append('LCF = "rest"' if cutter.flutes is None else f"LCF = {cutter.flutes!r}")
    lines.append(f"LPR = {cutter.length!r}")
    if cutter.necks:
        lines.append(f"neck = {_rows(cutter.necks)}")
    if cutter.shape == "lollipop":
        lines.append(f"DN = {2.0 * (cutter.shank_radius or 0.0)!r}")
    else:
        lines.append('DMM = "same"' if cutter.shank_radius is None else f"DMM = {2.0 * cutter.shank_radius!r}")
    lines.append(f"holder = {_holder(cutter.holder)}")
    for word in ("allowance", "clearance"):
        if getattr(cutter, word) is not None:
            lines.append(f"{word} = {getattr(cutter, word)!r}")
    if feed is not None:
        lines.append(f"feed = {float(feed)!r}")
    return lines


def to_toml(cutters: Library | Iterable[Cutter]) -> str:
    """Cutters, or all of a library, in our own format; what was not used stands in comments.

    >>> print(to_toml([Cutter.parse("R6L80")]))
    unit = "mm"
    <BLANKLINE>
    [[tool]]
    type = "flat"
    DC = 12.0
    LCF = "rest"
    LPR = 80.0
    DMM = "same"
    holder = "none"
    <BLANKLINE>
    """
    lines = ['unit = "mm"']
    if not isinstance(cutters, Library):
        for cutter in cutters:
            lines += _written(cutter, cutter.name, None)
        return "\n".join([*lines, ""])
    lines.insert(0, f"# From {name_of(cutters.file)} ({cutters.format})")
    for holder in cutters.holders:
        name = "" if holder.name == "none" else holder.name
        lines += ["", "[[holder]]", f"name = {toml_text(name)}", f"stages = {_rows(holder.stages)}"]
    for entry in cutters.entries:
        if entry.cutter is None:
            lines += ["", f"# Not used: {name_of(entry.label)}: {name_of(entry.unused)}"]
            continue
        lines += _written(entry.cutter, entry.name, entry.number, entry.feed)
        lines[-1:] = [lines[-1], *(f"# {name_of(note)}" for note in entry.notes)]
    return "\n".join([*lines, ""])
