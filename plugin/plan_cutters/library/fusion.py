"""Libraries of Autodesk: Fusion JSON and CSV, and the older XML of HSMWorks."""

import csv
import io
import re
from collections.abc import Mapping
from dataclasses import replace
from typing import Any

from plan_cutters.domain.checks import shown
from plan_cutters.domain.holder import Holder, Segment
from plan_cutters.errors import CutterError, LibraryError
from plan_cutters.files.content import Element, lines_of
from plan_cutters.library.cutting import take_feed
from plan_cutters.library.milling import kind_of_drill
from plan_cutters.library.raw_tool import (
    MOST_TOOLS,
    Content,
    Entry,
    FaultError,
    LibraryContent,
    Listed,
    mm,
    name_of,
    number_in,
    number_of,
    sections,
    too_many,
    unit_of,
    whole_of,
)

#: Our name of each dimension, and theirs: the name in brackets of its column, the key of `geometry`, the attribute of `body`.
_FIELDS = (
    ("DC", "tool_diameter", "DC", "diameter"),
    ("RE", "tool_cornerRadius", "RE", "corner-radius"),
    ("LCF", "tool_fluteLength", "LCF", "flute-length"),
    ("LPR", "tool_bodyLength", "LB", "body-length"),
    ("OAL", "tool_overallLength", "OAL", "overall-length"),
    ("DMM", "tool_shaftDiameter", "SFDM", "shaft-diameter"),
    ("LN", "tool_shoulderLength", "shoulder-length", "shoulder-length"),
    ("DN", "tool_shoulderDiameter", "shoulder-diameter", "shoulder-diameter"),
    ("TA", "tool_taperAngle", "TA", "taper-angle"),
    ("TIP", "tool_tipDiameter", "tip-diameter", "tip-diameter"),
    ("LF", "tool_assemblyGaugeLength", "assemblyGaugeLength", "assembly-gauge-length"),
    ("LH", "tool_holderGaugeLength", "", ""),
    ("DCX", "tool_maximumCuttingDiameter", "DCX", ""),
)
#: The same of tools for holes alone.
_OF_DRILLS = (("SIG", "tool_tipAngle", "SIG", "tip-angle"), ("TP", "tool_threadPitch", "TP", "thread-pitch"))
_NAME = re.compile(r"\((\w+)\)\s*$")
_SECTION = re.compile(r"H\s*(\S+)\s+U\s*(\S+)\s+L\s*(\S+)")


#: What some programs write before the header, for spreadsheets.
_SEPARATOR = re.compile(r"\"?sep=(.)\"?[ \t]*\r?\n", re.IGNORECASE)


def _table_of(content: Content) -> str:
    text = content.text.lstrip("\ufeff \r\n")
    match = _SEPARATOR.match(text)
    return text[match.end() :] if match else text


def is_csv(content: Content) -> bool:
    """A first line with columns `(tool_type)` and `(tool_diameter)`."""
    first = _table_of(content).partition("\n")[0]
    return "(tool_type)" in first and "(tool_" in first.replace("(tool_type)", "")


def read_csv(content: Content) -> LibraryContent:
    """Read it; commas, semicolons or tabs part the columns."""
    text = _table_of(content)
    first = text.partition("\n")[0]
    rows = csv.reader(io.StringIO(text), delimiter=max(",;\t", key=first.count))
    library = LibraryContent()
    try:
        header = [(_NAME.search(cell) or [None, cell.strip()])[1] for cell in next(rows)]
        # Fusion ends its header with the version of the format, in no column.
        while header and (not header[-1] or header[-1].startswith("CSV_TOOLS_VERSION")):
            header.pop()
        for needed in ("tool_type", "tool_diameter", "tool_unit"):
            if needed not in header:
                raise LibraryError(f"has no column ({needed}); export it anew, with all columns", file=content.name)
        twice = sorted({name for name in header if name and header.count(name) > 1})
        if twice:
            raise LibraryError(f"has the column ({shown(twice[0])[1:-1]}) twice; keep one of them", file=content.name)
        for i, row in enumerate(rows, 1):
            if i > MOST_TOOLS:
                raise too_many(content.name)
            if not any(cell.strip() for cell in row):
                continue
            place = f"row {i} (line {rows.line_num})"
            if len(row) < len(header) or any(cell.strip() for cell in row[len(header) :]):
                why = f"it has {len(row)} columns, the header {len(header)}"
                library.tools.append(Entry(place, unused=why, broken=True))
                continue
            library.tools.append(_csv_tool(dict(zip(header, row, strict=False)), place))
    except csv.Error as error:
        raise LibraryError(f"line {rows.line_num}: {error}; export it anew", file=content.name) from None
    return library


def _take_all(tool: Listed, form: int, values: Mapping[Any, Any], number: Any = number_of) -> None:
    """Take all dimensions by the words of a form: 0 CSV, 1 JSON, 2 XML."""
    for key, *words in (*_FIELDS, *(_OF_DRILLS if kind_of_drill(tool) is not None else ())):
        if words[form]:
            tool.take(key, values.get(words[form]), words[form], number)


def _csv_tool(row: dict[str | None, str], place: str) -> Listed:
    name = name_of(row.get("tool_description")) or name_of(row.get("tool_productId"))
    tool = Listed(place, name=name, kind=name_of(row.get("tool_type")), tapered=name_of(row.get("tool_taperedType")))
    try:
        tool.unit, tool.scale = unit_of(row.get("tool_unit"), "tool_unit")
        tool.number = whole_of(row.get("tool_number"), "tool_number")
    except FaultError as fault:
        tool.faults.append(str(fault))

    def number(value: str, field: str) -> float:
        result, comma = number_in(value, field)
        if comma:
            tool.notes.append("decimal commas")
        return result

    _take_all(tool, 0, {column: cell.strip() for column, cell in row.items()}, number)
    try:
        tool.shaft = _csv_sections(row.get("shaft_segments", ""), tool, "shaft_segments")
        stages = _csv_sections(row.get("holder_segments", ""), tool, "holder_segments")
        if stages:
            tool.holder = Holder(tuple(stages), name_of(row.get("holder_description")))
    except (FaultError, CutterError) as fault:
        tool.faults.append(str(fault))
    feed = row.get("tool_feedCutting", "").strip()
    take_feed(tool, [(row.get("preset_name", ""), feed)], "tool_feedCutting", _number)
    return tool


def _csv_sections(text: str, tool: Listed, where: str) -> list[Segment]:
    """`H4 U3.175 L1; ...`: heights, upper and lower diameters, from the tip's side up."""
    rows = []
    words = [word for word in text.split(";") if word.strip()]
    if len(words) > MOST_SECTIONS:
        raise FaultError(f"{where} has {len(words)} sections, more than {MOST_SECTIONS}")
    for i, word in enumerate(words, 1):
        match = _SECTION.fullmatch(word.strip())
        if not match:
            raise FaultError(f"{where} {i} is {shown(word.strip())}, not of the form H4 U3 L1")
        height, upper, lower = (mm(number_in(each, f"{where} {i}")[0], tool.scale, f"{where} {i}") for each in match.groups())
        rows.append((height, lower, upper))
    return sections(rows, where)


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
    _take_all(tool, 1, tool.tried(lambda: _table(item, "geometry"), {}))
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
    if kind_of_drill(tool) is not None:
        take_feed(tool, _presets(item, "v_f_plunge"), "v_f_plunge")
    if tool.feed is None:
        take_feed(tool, _presets(item, "v_f"), "v_f")
    return tool


def _presets(item: dict[str, Any], word: str) -> list[tuple[Any, Any]]:
    """Its presets. They say nothing of its shape: where they cannot be read, there are none."""
    start = item.get("start-values")
    entries = start.get("presets") if isinstance(start, dict) else None
    if not isinstance(entries, list):
        return []
    return [(each.get("name"), each.get(word)) for each in entries if isinstance(each, dict)]


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


_ROOT = re.compile(r"<\s*(?:\w+:)?tool-library\b")


def is_hsmlib(content: Content) -> bool:
    """XML with the root `tool-library`."""
    return content.head.startswith("<") and _ROOT.search(content.text, 0, 1 << 16) is not None


def read_hsmlib(content: Content) -> LibraryContent:
    """Read it."""
    root = content.xml()
    if root.tag != "tool-library":
        raise LibraryError(f"is XML with the root {root.tag[:40]}, not tool-library", file=content.name)
    library, count = LibraryContent(), 0
    for element in root.below(("tool", "holder")):
        if element.tag == "tool":
            count += 1
            if count > MOST_TOOLS:
                raise too_many(content.name)
            library.tools.append(_hsm_tool(element, f"tool {count} (line {element.line})"))
        elif element.tag == "holder":
            try:
                scale = unit_of(element.given.get("unit"), "holder unit")[1]
                library.holders.append(_hsm_holder(element, scale))
            except (FaultError, CutterError) as fault:
                name = name_of(element.given.get("description"))
                library.faulty.append(Entry(f"line {element.line}", None, name, "holder", unused=str(fault), broken=True))
    if any(element.first("expressions") is not None for element in root.below(("tool", "holder"))):
        library.notes.append(EXPRESSIONS)
    return library


def _hsm_tool(element: Element, place: str) -> Listed:
    description = element.first("description")
    tool = Listed(place, name=name_of(description.text if description else ""), kind=name_of(element.given.get("type")))

    tool.unit, tool.scale = tool.tried(lambda: unit_of(element.given.get("unit"), "unit"), ("", 1.0))
    nc, body, holder, shaft = (element.first(tag) for tag in ("nc", "body", "holder", "shaft"))
    if nc is not None:
        tool.number = tool.tried(lambda: whole_of(nc.given.get("number"), "nc number"), None)
    tool.tapered = name_of(body.given.get("tapered-type")) if body else ""
    _take_all(tool, 2, body.given if body else {}, _number)
    if shaft is not None:
        tool.shaft = tool.tried(lambda: _hsm_sections(shaft, tool.scale, "shaft section"), [])
    if holder is not None and holder.first("section") is not None:
        scale = tool.tried(lambda: unit_of(holder.given["unit"], "holder unit")[1], 1.0) if "unit" in holder.given else tool.scale
        tool.holder = tool.tried(lambda: _hsm_holder(holder, scale), None)
        tool.take("LH", holder.given.get("gauge-length"), "holder gauge-length", _number)
        if "LH" in tool.values:
            tool.values["LH"] = round(tool.values["LH"] / tool.scale * scale, 9)
    take_feed(tool, _hsm_presets(element), "cutting feed", _number)
    return tool


def _hsm_presets(element: Element) -> list[tuple[Any, Any]]:
    """Its presets; without one, what its `motion` states."""
    presets = [
        (preset.given.get("name", ""), parameter.given.get("value"))
        for preset in element.below(("preset",))
        for parameter in preset.children
        if parameter.given.get("key") == "tool_feedCutting"
    ]
    motion = element.first("motion")
    if presets or motion is None or motion.given.get("feed-mode", "per-minute") != "per-minute":
        return presets
    return [("", motion.given.get("cutting-feedrate"))]


def _number(value: str, field: str) -> float:
    return number_in(value, field)[0]


def _hsm_holder(element: Element, scale: float) -> Holder:
    stages = _hsm_sections(element, scale, "holder section")
    if not stages:
        raise FaultError("holder has no section: no outline")
    return Holder(tuple(stages), name_of(element.given.get("description")))


def _hsm_sections(element: Element, scale: float, where: str) -> list[Segment]:
    """Each section is a height over the one before and the diameter there; one without a height is a step."""
    children = [child for child in element.children if child.tag == "section"]
    if len(children) > MOST_SECTIONS:
        raise FaultError(f"{where}s are {len(children)}, more than {MOST_SECTIONS}")
    rows, lower = [], None
    for i, each in enumerate(children, 1):
        values = []
        for key in ("length", "diameter"):
            if key not in each.given:
                raise FaultError(f"{where} {i} {key} is missing (line {each.line})")
            field = f"{where} {i} {key}"
            values.append(mm(_number(each.given[key], field), scale, field))
        height, upper = values
        if lower is None and height:
            raise FaultError(f"{where} 1 has a length and no diameter at its lower end: put a section of length 0 before it")
        rows.append((height, upper if lower is None else lower, upper))
        lower = upper
    return sections(rows, where)
