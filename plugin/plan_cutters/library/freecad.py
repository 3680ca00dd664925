"""FreeCAD tools: bits (`.fctb`), libraries that list them by file (`.fctl`), and holders (`.fcholder`).

A bit of FreeCAD's newest releases may say its stick-out (`Stickout`), and by name the holder that it is set in (`ToolHolder`),
whose file lies in a folder of holders beside that of the bits.

A length is a text with a unit, in the writer's language: `6,0 mm`, `20.83 µm`. Without a unit it is mm, which is what FreeCAD
itself counts in, unless the bit says that its units are imperial.
"""

import math
import re
from collections.abc import Callable, Sequence
from itertools import pairwise
from pathlib import Path, PurePosixPath, PureWindowsPath
from typing import Any

from plan_cutters.domain.checks import shown
from plan_cutters.domain.figures import mm
from plan_cutters.domain.holder import Holder, Segment
from plan_cutters.errors import CutterError, LibraryError
from plan_cutters.files.content import lines_of
from plan_cutters.library import raw_tool
from plan_cutters.library.cutting import slack, take_feed
from plan_cutters.library.fusion import MOST_SECTIONS
from plan_cutters.library.milling import kind_of_drill
from plan_cutters.library.raw_tool import MOST_TOOLS, Content, Entry, FaultError, LibraryContent, Listed
from plan_cutters_base.user_files import is_there

_MM = {"mm": 1.0, "µm": 1e-3, "μm": 1e-3, "um": 1e-3, "nm": 1e-6, "cm": 10.0, "dm": 100.0, "m": 1000.0, "in": 25.4,
       '"': 25.4, "″": 25.4, "inch": 25.4, "mil": 0.0254, "thou": 0.0254, "ft": 304.8, "'": 304.8}  # fmt: skip
_DEGREES = ("", "°", "deg", "degrees")
_QUANTITY = re.compile(r"\s*([-+]?[\d.,]+(?:[eE][-+]?\d+)?|[-+]?(?:nan|inf(?:inity)?))\s*([^\s/]*)\s*", re.IGNORECASE)
_FEED = re.compile(r"\s*([-+]?[\d.,]+(?:[eE][-+]?\d+)?|[-+]?(?:nan|inf))\s*(?:([^\s/\d]+)\s*/\s*(min|s))?\s*", re.IGNORECASE)
#: Our name of each dimension, and the names that shapes have had for it.
_PARAMETERS = (
    ("DC", ("Diameter",)),
    ("RE", ("CornerRadius",)),
    ("LCF", ("CuttingEdgeHeight", "CuttingEdgeLength")),
    ("OAL", ("Length",)),
    ("DMM", ("ShankDiameter", "ShaftDiameter")),
    ("TIP", ("TipDiameter", "FlatDiameter")),
    ("DN", ("NeckDiameter",)),
)
#: Fields that one release means as the radius of the flat at the tip, and another as that of the corner.
_FLATS = ("FlatRadius", "TorusRadius")
_ANGLE = "CuttingEdgeAngle"
_AS_TOML = "write it as TOML (docs/tool_libraries.md)"
#: Fields of other shapes: which tip they make of this one, nothing says.
_STRANGE = ("Radius", "TaperAngle")
#: Of a tapered ball nose, the diameter where its cone ends.
_TOP = "TaperDiameter"
#: Of a slitting saw: how thick its blade is, and how high the cap of its screw stands out below that.
_BLADE, _CAP = "BladeThickness", "CapHeight"
#: Its drawing does not say from where it counts.
_NECK = "NeckLength"
#: What shapes are among mills; the others stay what they are called.
_SORTS = {
    "endmill": "flat end mill",
    "ballend": "ball end mill",
    "bullnose": "bull nose end mill",
    "torus": "bull nose end mill",
    "vbit": "chamfer mill",
    "v-bit": "chamfer mill",
    "chamfer": "chamfer mill",
    "taperedballnose": "tapered mill",
    "slittingsaw": "slot mill",
}
#: Folders in which a library's bits are looked for.
_FOLDERS = (".", "Bit", "bit", "../Bit", "../bit", "../Bits", "../bits")
#: Folders in which the holder of a bit is looked for, from the bit's own folder.
_HOLDERS = (".", "ToolHolder", "../ToolHolder", "Holder", "../Holder")


def is_bit(content: Content) -> bool:
    """An object with `shape` and `parameter`."""
    data = content.json
    return isinstance(data, dict) and isinstance(data.get("parameter"), dict) and ("shape" in data or "shape-type" in data)


def is_library(content: Content) -> bool:
    """An object whose `tools` are objects with a `path`."""
    tools = content.json.get("tools") if isinstance(content.json, dict) else None
    if not isinstance(tools, list):
        return False
    paths = [isinstance(tool, dict) and "path" in tool for tool in tools]
    return any(paths) or (not paths and content.path.suffix.lower() == ".fctl")


def is_holder(content: Content) -> bool:
    """An object with a `profile`."""
    return isinstance(content.json, dict) and isinstance(content.json.get("profile"), list)


def read_bit(content: Content) -> LibraryContent:
    """A bit is a library of one."""
    return LibraryContent([_tool(content, "tool 1", None)])


def read_library(content: Content) -> LibraryContent:
    """Read it and the bits that it lists, beside it or in a folder `Bit`."""
    if len(content.json["tools"]) > MOST_TOOLS:
        raise raw_tool.too_many(content.name)
    library, lines = LibraryContent(), lines_of(content.text, "tools")
    for i, item in enumerate(content.json["tools"]):
        line = f" (line {lines[i]})" if len(lines) == len(content.json["tools"]) else ""
        place = f"tool {i + 1}{line}"
        try:
            if not isinstance(item, dict) or not isinstance(item.get("path"), str):
                raise FaultError("it has no path of a bit")
            number = raw_tool.whole_of(item.get("nr"), "nr")
            bit = _bit(content.path.parent, item["path"])
            library.tools.append(_tool(bit, place, number))
        except FaultError as fault:
            name = raw_tool.name_of(item.get("path")) if isinstance(item, dict) else ""
            library.tools.append(Entry(place, None, name, unused=str(fault), broken=True))
    return library


def _bit(folder: Path, path: str) -> Content:
    """A bit by the last part of its path: nothing outside the usual folders is opened."""
    name = PurePosixPath(PureWindowsPath(path).as_posix()).name
    if not name.lower().endswith(".fctb"):
        raise FaultError(f"path {shown(path)} is no .fctb file")
    file = _first(folder, _FOLDERS, name)
    if file is None:
        raise FaultError("path: its bit is neither in the folder of the library nor in Bit or ../Bit; put it there")
    try:
        bit = raw_tool.opened(file)
    except LibraryError as error:
        raise FaultError(f"{name} {error.cause}") from None
    if not is_bit(bit):
        raise FaultError(f"{name} is no FreeCAD bit")
    return bit


def _first(folder: Path, places: Sequence[str], name: str) -> Path | None:
    return next((file for place in places if is_there(file := folder / place / name)), None)


def read_holder(content: Content) -> LibraryContent:
    """Read an outline of (radius, height), counted from the holder's nose."""
    name = raw_tool.name_of(content.json.get("name")) or content.path.stem
    try:
        return LibraryContent(holders=[_holder(content.json, name)])
    except (FaultError, CutterError) as fault:
        return LibraryContent(faulty=[Entry("profile", None, name, "holder", unused=str(fault), broken=True)])


def _holder(entry: dict[str, Any], name: str) -> Holder:
    unit = entry.get("units")
    scale = _MM.get(unit) if isinstance(unit, str) else None
    if scale is None:
        raise FaultError(f'units is {shown(unit)}: "mm" is expected')
    points = []
    if len(entry["profile"]) > MOST_SECTIONS:
        raise FaultError(f"profile has {len(entry['profile'])} points, more than {MOST_SECTIONS}")
    for i, point in enumerate(entry["profile"], 1):
        if not isinstance(point, list) or len(point) != 2:
            raise FaultError(f"profile {i} is no pair of radius and height")
        points.append(tuple(raw_tool.mm(raw_tool.number_of(value, f"profile {i}"), scale, f"profile {i}") for value in point))
    # The faces at both ends are part of the outline, not of its sides.
    while points and points[0][0] == 0.0:
        points.pop(0)
    while points and points[-1][0] == 0.0:
        points.pop()
    if len(points) < 2 or points[0][1] != 0.0:
        raise FaultError("profile must begin at its nose, at height 0, and have a length")
    rows = []
    for (r0, z0), (r1, z1) in pairwise(points):
        if z1 < z0:
            raise FaultError(f"profile falls from height {z0:g} to {z1:g}: it must rise")
        rows.append((round(z1 - z0, 9), 2.0 * r0, 2.0 * r1))
    return Holder(tuple(raw_tool.sections(rows, "profile")), name)


def _set_in(tool: Listed, parameters: dict[str, Any], folder: Path) -> None:
    """Take the holder that a bit names, by the last part of its name: nothing outside the usual folders is opened."""
    word = parameters.get("ToolHolder")
    if word in (None, ""):
        return
    if not isinstance(word, str) or not word.isprintable() or PurePosixPath(PureWindowsPath(word).as_posix()).name != word:
        tool.faults.append(f"ToolHolder {shown(word)} is no name of a holder")
        return
    file = _first(folder, _HOLDERS, f"{word}.fcholder")
    if file is None:
        # What is assumed for tools without a holder is another one than this.
        where = "into the folder of the bit or ../ToolHolder"
        tool.doubts.append(f"ToolHolder {shown(word)}: put its file {word[:40]}.fcholder {where}")
        return
    try:
        content = raw_tool.opened(file)
        if not is_holder(content):
            raise FaultError("it is no FreeCAD holder")
        tool.holder = _holder(content.json, raw_tool.name_of(content.json.get("name")) or word)
    except (FaultError, CutterError, LibraryError) as fault:
        why = fault.cause if isinstance(fault, LibraryError) else fault
        tool.faults.append(f"ToolHolder {shown(word)}: {why}")


def _tool(content: Content, place: str, number: int | None) -> Listed:
    entry = content.json
    called, shape = (_stem(entry.get(word)) for word in ("shape-type", "shape"))
    kind = called or shape
    tool = Listed(place, number, raw_tool.name_of(entry.get("name")), kind, _SORTS.get(kind.lower(), ""), "mm")
    parameters = entry["parameter"]
    imperial = isinstance(parameters.get("Units"), str) and parameters["Units"].lower() == "imperial"

    def length(value: Any, field: str) -> float:
        return _length(value, field, imperial, tool)

    for key, words in _PARAMETERS:
        _dimension(tool, key, [word for word in words if parameters.get(word) not in (None, "")] or words[:1], parameters, length)
    if kind_of_drill(tool) is not None:
        tool.flutes_everywhere = True
        if "DC" in tool.values:
            tool.values.setdefault("DMM", tool.values["DC"])
        tool.take("SIG", parameters.get("TipAngle"), "TipAngle", _angle)
        tool.take("TP", parameters.get("Pitch"), "Pitch", length)
        tool.reverse = str(parameters.get("SpindleDirection")) == "Reverse"
    if tool.sort:
        if shape and _plain(shape) != _plain(kind):
            # FreeCAD takes the drawing, and the type only where it has no such drawing.
            tool.doubts.append(
                f"shape-type {shown(kind)}, but shape {shown(shape)}: another drawing can be another tool; "
                f"correct one, or {_AS_TOML}"
            )
        for word in _STRANGE[: 1 if tool.sort == "tapered mill" else None]:
            if re.search("[1-9]", str(parameters.get(word) or "")):
                tool.doubts.append(f"{word} {shown(parameters[word])}: a {kind} has none; leave it out, or {_AS_TOML}")
        for word in _FLATS:
            _corner(tool, parameters.get(word), word, length)
        neck = str(parameters.get(_NECK) or "")
        if re.search("[1-9]", neck):
            tool.notes.append(f"{_NECK} {neck[:40]} is not used")
        _cone(tool, parameters.get(_ANGLE))
        if tool.sort == "slot mill":
            tool.take("LCF", parameters.get(_BLADE), _BLADE, length)
            if "CornerRadius" not in parameters:
                # Its drawing has none.
                tool.take("RE", "0 mm", "CornerRadius", length)
            if re.search("[1-9]", str(parameters.get(_CAP) or "")):
                tool.doubts.append(
                    f"{_CAP} {shown(parameters[_CAP])}: what is below its blade does not cut, and no tool is known so"
                )
        if tool.sort == "tapered mill":
            _tapered_ball(tool, parameters, length)
    # FreeCAD writes 0 for a stick-out that nobody gave.
    if re.search("[1-9]", str(parameters.get("Stickout") or "")):
        tool.take("LPR", parameters["Stickout"], "Stickout", length)
    else:
        tool.words["LPR"] = "length below the holder"
    _set_in(tool, parameters, content.path.parent)
    attribute = entry.get("attribute")
    if isinstance(attribute, dict):
        take_feed(tool, [("", attribute.get("cutting_feedrate"))], "cutting_feedrate", _feed)
    return tool


def _dimension(
    tool: Listed, key: str, fields: Sequence[str], parameters: dict[str, Any], length: Callable[[Any, str], float]
) -> None:
    """Take a dimension from the first of its fields; the others must say the same."""
    first, *others = fields
    tool.take(key, parameters[first] if parameters.get(first) not in (None, "") else None, first, length)
    for other in others:
        try:
            same = abs(raw_tool.mm(length(parameters[other], other), 1.0, other) - tool.values.get(key, 0.0)) <= 1e-3
        except FaultError as fault:
            tool.faults.append(str(fault))
            continue
        if not same:
            both = f"{first} is {shown(parameters[first])}, {other} is {shown(parameters[other])}"
            tool.faults.append(f"{both}: they mean the same")


def _cone(tool: Listed, angle: Any) -> None:
    """Take the angle of a chamfer mill; others have no cone."""
    if tool.sort == "chamfer mill":
        tool.take("TA", angle, _ANGLE, _half_angle)
        if tool.kind.lower() == "chamfer" and 0.0 < tool.values.get("TA", 0.0) < 45.0:
            tool.doubts.append(
                f"{_ANGLE} {shown(angle)} is the whole angle of its cone or that of its flank from the axis: {_AS_TOML}"
            )
    elif angle not in (None, "") and tool.tried(lambda: _angle(angle, _ANGLE), 0.0) not in (0.0, 180.0):
        tool.doubts.append(f"{_ANGLE} {shown(angle)}: a {tool.kind} has no cone; leave it out, or {_AS_TOML}")


def _tapered_ball(tool: Listed, parameters: dict[str, Any], length: Callable[[Any, str], float]) -> None:
    """Take a ball under a cone, as FreeCAD labels its fields: the diameter of the ball, the whole angle of the cone, and the
    diameter at the cone's top, which may lie above the flutes.
    """
    tool.tapered = "tapered_ball"
    tool.take("TA", parameters.get(_STRANGE[1]), _STRANGE[1], _half_angle)
    if not tool.states("TA"):
        tool.doubts.append(f"{_STRANGE[1]} is missing (the whole angle of its cone): add it; 0 says that it has none")
    if "DC" not in tool.values:
        return
    ball, taper = 0.5 * tool.values["DC"], math.radians(tool.values.get("TA", 0.0))
    tool.notes.append(f"{tool.cite('DC')} is that of its ball, {_STRANGE[1]} the whole angle of its cone")
    # The diameter of a leaning flank is that at the tip, as if there were no ball.
    tool.values["RE"], tool.values["DC"] = ball, 2.0 * ball * (1.0 - math.sin(taper)) / math.cos(taper)
    tool.words["RE"] = "the radius of its ball"
    tool.take("TOP", parameters.get(_TOP), _TOP, length)
    wide, flutes = 0.5 * tool.values.pop("TOP", 0.0), tool.values.get("LCF", 0.0)
    if not wide or not taper or not flutes:
        return
    if wide < ball * math.cos(taper) - slack(wide):
        tool.faults.append(f"{_TOP} {2.0 * wide:.10g} is less than its ball is wide under the cone")
        return
    top = ball * (1.0 - math.sin(taper)) + (wide - ball * math.cos(taper)) / math.tan(taper)
    ends = wide - (top - flutes) * math.tan(taper)
    if ends > wide + slack(wide):
        tool.doubts.append(
            f"{_TOP} {2.0 * wide:.10g} is reached {mm(top)} over its tip, below the end of its flutes, {tool.cite('LCF')}: "
            f"what they are above is not known; {_AS_TOML}"
        )
    elif top > flutes + slack(top):
        tool.shaft.append(Segment(round(ends, 9), round(top - flutes, 9), round(wide, 9)))


def _stem(shape: Any) -> str:
    """The name of a shape, of its file without folder and suffix."""
    return re.sub(r"\.fcstd$", "", raw_tool.name_of(shape), flags=re.IGNORECASE).replace("\\", "/").rpartition("/")[2]


def _plain(shape: str) -> str:
    name = shape.lower().replace("-", "")
    return "bullnose" if name == "torus" else name


def _corner(tool: Listed, value: Any, field: str, length: Callable[[Any, str], float]) -> None:
    """Take the radius of a flat or of a corner as the corner radius, where both readings make the same tool.

    By FreeCAD's surface operation it is the flat's radius; by one of its shapes it is the corner's. Neither tool encloses
    the other at a contact.
    """
    if value in (None, "") or "DC" not in tool.values:
        return
    try:
        radius = raw_tool.mm(length(value, field), 1.0, field)
    except FaultError as fault:
        tool.faults.append(str(fault))
        return
    rest = round(0.5 * tool.values["DC"] - radius, 9)
    if tool.sort == "chamfer mill":
        if radius:
            tool.doubts.append(
                f"{field} {radius:.10g} is the radius of its corner or of the flat at its tip: give TipDiameter alone"
            )
    elif tool.states("RE"):
        corner = tool.values.get("RE", 0.0)
        if min(abs(corner - radius), abs(corner - rest)) > slack(corner):
            tool.faults.append(
                f"{tool.cite('RE')} and {field} {radius:.10g} do not agree, as the radius of the corner or of the flat at the tip"
            )
    elif abs(rest - radius) <= slack(radius):
        tool.values["RE"] = radius
        tool.words["RE"] = field
    else:
        other = f"whose corner then has {rest:.10g}" if rest >= 0.0 else "which is then wider than the tool"
        tool.doubts.append(
            f"{field} {radius:.10g} is the radius of its corner, or of the flat at its tip, {other}: "
            "add CornerRadius, which decides"
        )


def _feed(value: Any, field: str) -> float:
    """mm/min of a number or a text; without a unit it is mm/min, as the programs that write bits count."""
    match = _FEED.fullmatch(value) if isinstance(value, str) else None
    if match is None:
        return raw_tool.number_of(value, field)
    scale = _MM.get((match[2] or "mm").lower())
    if scale is None:
        raise FaultError(f"{field} is {shown(value)}, not a feed as 500 mm/min")
    return raw_tool.number_in(match[1], field)[0] * scale * (60.0 if match[3] == "s" else 1.0)


def _length(value: Any, field: str, imperial: bool, tool: Listed) -> float:
    if not isinstance(value, str):
        number, unit = raw_tool.number_of(value, field), ""
    else:
        match = _QUANTITY.fullmatch(value)
        if not match:
            raise FaultError(f"{field} is {shown(value)}, not a length as 6.35 mm or 0.25 in")
        number, comma = raw_tool.number_in(match[1], field)
        unit = match[2]
        if comma:
            tool.notes.append("decimal commas")
    if not unit:
        if imperial and number:
            raise FaultError(f"{field} is {shown(value)} without a unit, and Units is Imperial: mm or in?")
        if number:
            tool.notes.append(f"{field} without a unit: mm, as FreeCAD counts")
        return number
    # A capital M is a million, not a metre.
    scale = _MM.get(unit) or (_MM.get(unit.lower()) if len(unit) > 1 else None)
    if scale is None:
        raise FaultError(f"{field} is {shown(value)}: no unit of length is called {shown(unit)}")
    if scale not in (1.0,):
        tool.notes.append(f"{field} in {unit}")
    return number * scale


def _angle(value: Any, field: str) -> float:
    if not isinstance(value, str):
        return raw_tool.number_of(value, field)
    match = _QUANTITY.fullmatch(value)
    if not match or match[2].lower() not in _DEGREES:
        raise FaultError(f"{field} is {shown(value)}, not an angle in degrees")
    return raw_tool.number_in(match[1], field)[0]


def _half_angle(value: Any, field: str) -> float:
    """FreeCAD gives the whole angle of a point."""
    angle = _angle(value, field)
    if not 0.0 <= angle < 180.0:
        raise FaultError(f"{field} is {angle:g}: the angle of a point lies between 0 and 180 degrees")
    return 0.5 * angle
