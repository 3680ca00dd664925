"""HSMWorks tool libraries, `.hsmlib`: XML, mostly in UTF-16, of the same tools as Fusion has."""

import re

from plan_cutters.domain.holder import Holder, Segment
from plan_cutters.errors import CutterError, LibraryError
from plan_cutters.files.xml_tree import Element
from plan_cutters.library.files import MOST_TOOLS, Content, too_many
from plan_cutters.library.fusion_json import EXPRESSIONS, MOST_SECTIONS
from plan_cutters.library.presets import Preset, take_feed
from plan_cutters.library.raw_tool import FaultError, LibraryContent, Listed, mm, name_of, number_in, sections, unit_of, whole_of
from plan_cutters.library.records import Entry

#: Our name of each dimension, and the attribute of `body`.
_BODY = (
    ("DC", "diameter"),
    ("RE", "corner-radius"),
    ("LCF", "flute-length"),
    ("LPR", "body-length"),
    ("OAL", "overall-length"),
    ("DMM", "shaft-diameter"),
    ("LN", "shoulder-length"),
    ("DN", "shoulder-diameter"),
    ("TA", "taper-angle"),
    ("TIP", "tip-diameter"),
    ("LF", "assembly-gauge-length"),
)
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
            library.tools.append(_tool(element, f"tool {count} (line {element.line})"))
        elif element.tag == "holder":
            try:
                scale = unit_of(element.given.get("unit"), "holder unit")[1]
                library.holders.append(_holder(element, scale))
            except (FaultError, CutterError) as fault:
                name = name_of(element.given.get("description"))
                library.faulty.append(Entry(f"line {element.line}", None, name, "holder", unused=str(fault), broken=True))
    if any(element.first("expressions") is not None for element in root.below(("tool", "holder"))):
        library.notes.append(EXPRESSIONS)
    return library


def _tool(element: Element, place: str) -> Listed:
    description = element.first("description")
    tool = Listed(place, name=name_of(description.text if description else ""), kind=name_of(element.given.get("type")))

    tool.unit, tool.scale = tool.tried(lambda: unit_of(element.given.get("unit"), "unit"), ("", 1.0))
    nc, body, holder, shaft = (element.first(tag) for tag in ("nc", "body", "holder", "shaft"))
    if nc is not None:
        tool.number = tool.tried(lambda: whole_of(nc.given.get("number"), "nc number"), None)
    tool.tapered = name_of(body.given.get("tapered-type")) if body else ""
    for key, word in _BODY:
        tool.take(key, body.given.get(word) if body else None, word, _number)
    if shaft is not None:
        tool.shaft = tool.tried(lambda: _sections(shaft, tool.scale, "shaft section"), [])
    if holder is not None and holder.first("section") is not None:
        scale = tool.tried(lambda: unit_of(holder.given["unit"], "holder unit")[1], 1.0) if "unit" in holder.given else tool.scale
        tool.holder = tool.tried(lambda: _holder(holder, scale), None)
        tool.take("LH", holder.given.get("gauge-length"), "holder gauge-length", _number)
        if "LH" in tool.values:
            tool.values["LH"] = round(tool.values["LH"] / tool.scale * scale, 9)
    take_feed(tool, _presets(element), "cutting feed", _number)
    return tool


def _presets(element: Element) -> list[Preset]:
    """Its presets; without one, what its `motion` states."""
    presets = [
        Preset(preset.given.get("name", ""), parameter.given.get("value"))
        for preset in element.below(("preset",))
        for parameter in preset.children
        if parameter.given.get("key") == "tool_feedCutting"
    ]
    motion = element.first("motion")
    if presets or motion is None or motion.given.get("feed-mode", "per-minute") != "per-minute":
        return presets
    return [Preset("", motion.given.get("cutting-feedrate"))]


def _number(value: str, field: str) -> float:
    return number_in(value, field)[0]


def _holder(element: Element, scale: float) -> Holder:
    stages = _sections(element, scale, "holder section")
    if not stages:
        raise FaultError("holder has no section: no outline")
    return Holder(tuple(stages), name_of(element.given.get("description")))


def _sections(element: Element, scale: float, where: str) -> list[Segment]:
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
