"""Fusion tool libraries as CSV: a row for each preset of a tool, columns named `Label (tool_x)`."""

import csv
import io
import re

from plan_cutters.domain.checks import shown
from plan_cutters.domain.holder import Holder, Segment
from plan_cutters.errors import CutterError, LibraryError
from plan_cutters.library.files import MOST_TOOLS, Content, too_many
from plan_cutters.library.fusion_json import MOST_SECTIONS
from plan_cutters.library.presets import Preset, take_feed
from plan_cutters.library.raw_tool import FaultError, LibraryContent, Listed, mm, name_of, number_in, sections, unit_of, whole_of
from plan_cutters.library.records import Entry

#: Our name of each dimension, and the name in brackets of its column.
_COLUMNS = (
    ("DC", "tool_diameter"),
    ("RE", "tool_cornerRadius"),
    ("LCF", "tool_fluteLength"),
    ("LPR", "tool_bodyLength"),
    ("OAL", "tool_overallLength"),
    ("DMM", "tool_shaftDiameter"),
    ("LN", "tool_shoulderLength"),
    ("DN", "tool_shoulderDiameter"),
    ("TA", "tool_taperAngle"),
    ("TIP", "tool_tipDiameter"),
    ("LF", "tool_assemblyGaugeLength"),
    ("LH", "tool_holderGaugeLength"),
    ("DCX", "tool_maximumCuttingDiameter"),
)
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
            library.tools.append(_tool(dict(zip(header, row, strict=False)), place))
    except csv.Error as error:
        raise LibraryError(f"line {rows.line_num}: {error}; export it anew", file=content.name) from None
    return library


def _tool(row: dict[str | None, str], place: str) -> Listed:
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

    for key, column in _COLUMNS:
        tool.take(key, row.get(column, "").strip(), column, number)
    try:
        tool.shaft = _sections(row.get("shaft_segments", ""), tool, "shaft_segments")
        stages = _sections(row.get("holder_segments", ""), tool, "holder_segments")
        if stages:
            tool.holder = Holder(tuple(stages), name_of(row.get("holder_description")))
    except (FaultError, CutterError) as fault:
        tool.faults.append(str(fault))
    take_feed(
        tool,
        [Preset(row.get("preset_name", ""), row.get("tool_feedCutting", "").strip())],
        "tool_feedCutting",
        lambda text, field: number_in(text, field)[0],
    )
    return tool


def _sections(text: str, tool: Listed, where: str) -> list[Segment]:
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
