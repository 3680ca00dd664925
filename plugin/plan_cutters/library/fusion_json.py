"""Fusion tool libraries: `.json`, and `.tools`, which is a zip archive of the same JSON. Geometry counts, expressions do not."""

from dataclasses import replace
from typing import Any

from plan_cutters.domain.checks import shown
from plan_cutters.domain.holder import Holder
from plan_cutters.errors import CutterError, LibraryError
from plan_cutters.library.files import MOST_TOOLS, Content, lines_of, too_many
from plan_cutters.library.presets import Preset, take_feed
from plan_cutters.library.raw_tool import FaultError, LibraryContent, Listed, mm, name_of, number_of, sections, unit_of, whole_of
from plan_cutters.library.records import Entry

#: Our name of each dimension, and the key of `geometry`.
GEOMETRY = (
    ("DC", "DC"),
    ("RE", "RE"),
    ("LCF", "LCF"),
    ("LPR", "LB"),
    ("OAL", "OAL"),
    ("DMM", "SFDM"),
    ("LN", "shoulder-length"),
    ("DN", "shoulder-diameter"),
    ("TA", "TA"),
    ("TIP", "tip-diameter"),
    ("LF", "assemblyGaugeLength"),
    ("DCX", "DCX"),
)
#: Sections that a holder or shaft may have.
MOST_SECTIONS = 200
#: Note of files with expressions.
EXPRESSIONS = "expressions are not evaluated: the numbers that the program made of them count"
_MEMBER = "tools.json"


def is_json(content: Content) -> bool:
    """An object with a list `data`."""
    return isinstance(content.json, dict) and isinstance(content.json.get("data"), list)


def is_zip(content: Content) -> bool:
    """An archive with `tools.json`."""
    return content.members is not None and _MEMBER in content.members


def read_zip(content: Content) -> LibraryContent:
    """Read `.tools`."""
    inner = replace(content, data=content.unpacked(_MEMBER))
    if not is_json(inner):
        if inner.json is None:
            raise LibraryError(f"its {_MEMBER}: {inner.broken_json().cause}", file=content.name)
        raise LibraryError(f"its {_MEMBER} has no list of tools; export it anew", file=content.name)
    return read_json(inner)


def read_json(content: Content) -> LibraryContent:
    """Read `.json`."""
    if len(content.json["data"]) > MOST_TOOLS:
        raise too_many(content.name)
    library, lines = LibraryContent(), lines_of(content.text, "data")
    for i, item in enumerate(content.json["data"]):
        line = f" (line {lines[i]})" if len(lines) == len(content.json["data"]) and max(lines) > 1 else ""
        place = f"tool {i + 1}{line}"
        if not isinstance(item, dict):
            library.tools.append(Entry(place, unused=f"{shown(item)} is no tool", broken=True))
        elif item.get("type") == "holder":
            name = name_of(item.get("description"))
            try:
                library.holders.append(_holder(item, unit_of(item.get("unit"), "unit")[1], "segments"))
            except (FaultError, CutterError) as fault:
                library.faulty.append(Entry(place, None, name, "holder", unused=str(fault), broken=True))
        else:
            library.tools.append(_tool(item, place))
    if any(isinstance(item, dict) and item.get("expressions") for item in content.json["data"]):
        library.notes.append(EXPRESSIONS)
    return library


def _tool(item: dict[str, Any], place: str) -> Listed:
    name = name_of(item.get("description")) or name_of(item.get("product-id"))
    tool = Listed(place, name=name, kind=name_of(item.get("type")), tapered=name_of(item.get("tapered-type")))

    tool.unit, tool.scale = tool.tried(lambda: unit_of(item.get("unit"), "unit"), ("", 1.0))
    post = tool.tried(lambda: _table(item, "post-process"), {})
    tool.number = tool.tried(lambda: whole_of(post.get("number"), "post-process.number"), None)
    geometry = tool.tried(lambda: _table(item, "geometry"), {})
    for key, word in GEOMETRY:
        tool.take(key, geometry.get(word), word)
    shaft = tool.tried(lambda: _table(item, "shaft"), {})
    if shaft.get("segments"):
        tool.shaft = tool.tried(lambda: _sections(shaft, tool.scale, "shaft.segments"), [])
    holder = tool.tried(lambda: _table(item, "holder"), {})
    if holder.get("segments"):
        # A holder has its own unit.
        scale = tool.tried(lambda: unit_of(holder.get("unit", item.get("unit")), "holder.unit")[1], tool.scale)
        tool.holder = tool.tried(lambda: _holder(holder, scale, "holder.segments"), None)
        tool.take("LH", holder.get("gaugeLength"), "holder.gaugeLength")
        if "LH" in tool.values:
            tool.values["LH"] = round(tool.values["LH"] / tool.scale * scale, 9)
    take_feed(tool, _presets(item), "v_f")
    return tool


def _presets(item: dict[str, Any]) -> list[Preset]:
    """Its presets. They say nothing of its shape: where they cannot be read, there are none."""
    start = item.get("start-values")
    entries = start.get("presets") if isinstance(start, dict) else None
    if not isinstance(entries, list):
        return []
    return [Preset(name_of(each.get("name")), each.get("v_f")) for each in entries if isinstance(each, dict)]


def _table(item: dict[str, Any], key: str) -> dict[str, Any]:
    result = item.get(key)
    if result is None:
        return {}
    if not isinstance(result, dict):
        raise FaultError(f"{key} is {shown(result)}, not an object")
    return result


def _sections(item: dict[str, Any], scale: float, where: str) -> Any:
    entries = item.get("segments")
    if not isinstance(entries, list) or not all(isinstance(each, dict) for each in entries):
        raise FaultError(f"{where} is no list of segments")
    if len(entries) > MOST_SECTIONS:
        raise FaultError(f"{where} has {len(entries)} sections, more than {MOST_SECTIONS}")
    rows = []
    for i, each in enumerate(entries, 1):
        values = []
        for key in ("height", "lower-diameter", "upper-diameter"):
            field = f"{where} {i} {key}"
            if key not in each:
                raise FaultError(f"{field} is missing")
            values.append(mm(number_of(each[key], field), scale, field))
        rows.append((values[0], values[1], values[2]))
    return sections(rows, where)


def _holder(item: dict[str, Any], scale: float, where: str) -> Holder:
    stages = _sections(item, scale, where)
    if not stages:
        raise FaultError(f"{where} is missing: the holder has no outline")
    return Holder(tuple(stages), name_of(item.get("description")) or name_of(item.get("product-id")))
