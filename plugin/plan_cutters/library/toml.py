"""Our own tool libraries: TOML that people write, read and written."""

import math
import re
from collections.abc import Iterable, Sequence
from itertools import pairwise
from typing import Annotated, Any, Literal

from pydantic import BaseModel, ConfigDict, Field, ValidationError

from plan_cutters.domain.checks import shown, stated_degrees, stated_radians
from plan_cutters.domain.cutter import Cutter
from plan_cutters.domain.drill import KINDS, Drill, Kind
from plan_cutters.domain.holder import Holder, Segment
from plan_cutters.errors import CutterError, LibraryError
from plan_cutters.files.content import toml_text
from plan_cutters.library import raw_tool
from plan_cutters.library.cutting import take_feed
from plan_cutters.library.milling import cause_of
from plan_cutters.library.raw_tool import MOST_TOOLS, Content, Entry, FaultError, Library, LibraryContent, Listed

_LOOKS = re.compile(r"^[ \t]*(\[\[?[ \t]*(tool|holder)s?[ \t]*\]\]?[ \t]*(#.*)?\r?$|unit[ \t]*=)", re.MULTILINE | re.IGNORECASE)
_TABLE = re.compile(r"^[ \t]*\[\[[ \t]*tool[ \t]*\]\]", re.MULTILINE)
_ENDS = ("flat", "bull", "ball", "taper", "dovetail", "end")

_MOST = 8 << 20
#: What pydantic puts into the place of an error for a kind that it tried.
_KINDS = ("HolderTable", "str", "float")

Number = Annotated[float, Field(allow_inf_nan=False, strict=True)]
Section = Annotated[list[Number], Field(min_length=2, max_length=3)]
Point = Annotated[list[Number], Field(min_length=2, max_length=2)]


class HolderTable(BaseModel):
    """A holder: points (z, r) of its outline, z counted from its nose up, or stages (radius, length[, upper radius])."""

    model_config = ConfigDict(extra="forbid")
    name: str = ""
    unit: str | None = None
    points: list[Point] | None = None
    stages: list[Section] | None = None


class ToolTable(BaseModel):
    """A tool: ISO 13399 names where there are such."""

    model_config = ConfigDict(extra="forbid")
    number: Annotated[int, Field(strict=True)] | None = None
    name: str = ""
    type: Literal["flat", "bull", "ball", "taper", "dovetail", "end", "lollipop", "barrel", "lens", "form", Kind]
    unit: str | None = None
    DC: Number | None = None
    RE: Number = 0.0
    LCF: Number | Literal["rest"] | None = None
    LPR: Number | None = None
    OAL: Number | None = None
    DMM: Number | Literal["same"] | None = None
    DN: Number | None = None
    LN: Number | None = None
    SIG: Number | None = None
    TP: Number | None = None
    HAND: Literal["R", "L"] | None = None
    TA: Number | Annotated[str, Field(min_length=1)] | None = None
    PRFRAD: Number = 0.0
    profile_height: Number = 0.0
    neck: list[Section] = []
    outline: list[Point] = []
    holder: str | list[Point] | HolderTable | None = None
    feed: Annotated[float, Field(strict=True)] | None = None
    allowance: Number | None = None
    clearance: Number | None = None


def is_toml(content: Content) -> bool:
    """Tables `[[tool]]` or `[[holder]]`, or a unit; what is called so may have none of them yet."""
    if content.head[:1] in ("{", "<") or content.members is not None:
        return False
    return _LOOKS.search(content.text) is not None or content.path.suffix.lower() == ".toml"


def read_toml(content: Content) -> LibraryContent:
    """Read it."""
    if len(content.data) > _MOST:
        # TOML is read by Python itself, some MB in a second.
        raise LibraryError(f"is larger than {_MOST >> 20} MB: no tool library is; split it", file=content.name)
    if len(_TABLE.findall(content.text)) > MOST_TOOLS:
        raise raw_tool.too_many(content.name)
    try:
        document = content.toml()
    except LibraryError as error:
        unquoted = "Expected newline" in error.cause or "Invalid value" in error.cause
        hint = '; numbers have a decimal point and no unit (12.5), words have quotes ("mm")' if unquoted else ""
        raise LibraryError(f"{error.cause}{hint}", file=content.name) from None
    for key in document:
        if key not in ("unit", "tool", "holder"):
            raise LibraryError(f"{shown(key)} is unknown; a library has unit, [[tool]] and [[holder]]", file=content.name)
    tools, holders = (document.get(key, []) for key in ("tool", "holder"))
    for key, tables in (("tool", tools), ("holder", holders)):
        if not isinstance(tables, list):
            raise LibraryError(f"{key} is one table: write [[{key}]], with two brackets", file=content.name)
    if len(tools) > MOST_TOOLS or len(holders) > MOST_TOOLS:
        raise raw_tool.too_many(content.name)
    library = LibraryContent()
    # None: the name means more than one.
    named: dict[str, Holder | None] = {}
    for i, table in enumerate(holders, 1):
        try:
            model = HolderTable.model_validate(table)
            holder = _outlined(model, raw_tool.unit_of(model.unit or document.get("unit"), "unit")[1])
        except (ValidationError, FaultError, CutterError) as error:
            library.faulty.append(Entry(f"holder {i}", kind="holder", unused=_why(error), broken=True))
            continue
        library.holders.append(holder)
        if holder.name:
            named[holder.name] = holder if named.get(holder.name, holder) == holder else None
    lines = [content.text.count("\n", 0, match.start()) + 1 for match in _TABLE.finditer(content.text)]
    for i, table in enumerate(tools):
        line = f" (line {lines[i]})" if len(lines) == len(tools) else ""
        library.tools.append(_listed(table, f"tool {i + 1}{line}", document.get("unit"), named))
    return library


#: What a key here is called by Fusion, by ISO 13399, or in full.
_IN_OTHER_PROGRAMS = {
    "DC": ("diameter",), "RE": ("corner_radius",), "LCF": ("APMX", "flute_length"), "LPR": ("LB", "stickout", "stick_out"),
    "DMM": ("SFDM", "DCONMS", "shank_diameter"), "OAL": ("overall_length",), "SIG": ("point_angle",), "type": ("shape", "kind"),
}  # fmt: skip


def _why(error: Exception) -> str:
    if not isinstance(error, ValidationError):
        return cause_of(error) if isinstance(error, CutterError) else str(error)
    # Of kinds that were tried in turn, the one that was understood the farthest.
    first = max(error.errors(include_url=False, include_context=False), key=lambda each: len(each["loc"]))
    words = [str(word + 1) if isinstance(word, int) else word for word in first["loc"]]
    words = [word for word in words if (word.isidentifier() and word not in _KINDS) or word.isdigit()]
    field = " ".join(words) or "it"
    if first["type"] == "extra_forbidden":
        unknown, keys = first["loc"][-1], (*ToolTable.model_fields, *HolderTable.model_fields)
        meant = next((f"; {key} is written so" for key in keys if key.lower() == str(unknown).lower()), "")
        meant = meant or next((f"; {key} says that" for key, words in _IN_OTHER_PROGRAMS.items() if unknown in words), "")
        return f"{shown(unknown)} is unknown here{meant}"
    if not first["loc"]:
        return f"it is {shown(first['input'])}, not a table"
    if first["type"] == "missing":
        return f"{first['loc'][-1]} is missing"
    return f"{field} is {shown(first['input'])}: {first['msg'][:1].lower()}{first['msg'][1:]}"


def _listed(table: Any, place: str, unit: Any, named: dict[str, Holder | None]) -> Listed:
    """A table as a listed tool; what it needs depends on its type."""
    tool = Listed(place, stated={})
    if isinstance(table, dict):
        tool.name = raw_tool.name_of(table.get("name"))
        if isinstance(table.get("number"), int):
            tool.number = tool.tried(lambda: raw_tool.whole_of(table["number"], "number"), None)
    try:
        model = ToolTable.model_validate(table)
    except ValidationError as error:
        tool.faults.append(_why(error))
        return tool
    tool.kind = model.type
    tool.unit, tool.scale = tool.tried(lambda: raw_tool.unit_of(model.unit or unit, "unit"), ("", 1.0))
    for key in ("DC", "RE", "LPR", "OAL", "DN"):
        tool.take(key, getattr(model, key) if key in model.model_fields_set else None, key)
    tool.take("DMM", None if model.DMM == "same" else model.DMM, "DMM")
    tool.take("TA", model.TA, "TA", _degrees)
    tool.take("SIG", model.SIG, "SIG")
    tool.take("TP", model.TP, "TP")
    tool.reverse = model.HAND == "L"
    if model.SIG is not None and model.type not in KINDS:
        tool.faults.append(f"SIG: a {model.type} has no point as a drill has; leave it out")
    if model.type != "tap" and (word := "TP" if model.TP is not None else "HAND" if model.HAND is not None else ""):
        tool.faults.append(f"{word}: a {model.type} cuts no thread; leave it out")
    tool.holder = tool.tried(lambda: _holder(model.holder, tool.scale, named), None)

    def length(value: Any, field: str) -> float:
        return tool.tried(lambda: raw_tool.mm(value or 0.0, tool.scale, field, exact=True), 0.0)

    flutes = 0.0 if model.LCF == "rest" else length(model.LCF, "LCF")
    outline = tuple((length(r, "outline"), length(z, "outline")) for z, r in model.outline)
    limits = {word: length(value, word) for word in ("allowance", "clearance") if (value := getattr(model, word)) is not None}
    tool.straight = model.DMM == "same" or (model.LCF == "rest" and model.type != "form")
    tool.stated = {"shape": "end" if model.type in (*_ENDS, *KINDS) else model.type, "taper": _taper(model, tool),
                   "flutes": flutes or None, "arc_radius": length(model.PRFRAD, "PRFRAD"), "outline": outline,
                   "arc_height": length(model.profile_height, "profile_height"), **limits}  # fmt: skip
    needs = _needs(model, tool, flutes, outline)
    _neck(model, tool, length(model.LN, "LN"), needs)
    tool.needs = tuple(key for key, needed in needs.items() if needed)
    take_feed(tool, [("", model.feed)], "feed", lambda value, _: float(value))
    return tool


def _needs(model: ToolTable, tool: Listed, flutes: float, outline: Sequence[tuple[float, float]]) -> dict[str, bool]:
    """Which dimensions a tool of a type needs, and what of them contradicts its outline."""
    needs = {"DC": True, "LCF": model.LCF != "rest" and not flutes, "TA": model.type == "taper"}
    if model.type in ("lollipop", "form"):
        needs["LCF"] = False
        if model.LCF is not None:
            tool.faults.append(f"LCF: the flutes of a {model.type} end where its outline does; leave it out")
    if model.type == "form":
        widest = 2.0 * max((r for r, _ in outline), default=0.0)
        if widest and abs(tool.values.get("DC", widest) - widest) > 1e-3:
            tool.faults.append(f"{tool.cite('DC')} is not the largest diameter of its outline")
        needs["DC"], needs["outline"], tool.values["DC"] = False, not widest, widest
    return needs


def _taper(model: ToolTable, tool: Listed) -> float:
    """Half angle, rad, to the last digit; negative for a dovetail."""
    if "TA" not in tool.values:
        return 0.0
    angle = stated_radians(model.TA) if isinstance(model.TA, str) else math.radians(tool.values["TA"])
    return -angle if model.type == "dovetail" else angle


def _neck(model: ToolTable, tool: Listed, reach: float, needs: dict[str, bool]) -> None:
    lollipop = model.type == "lollipop"
    if lollipop:
        # Its neck goes on up to the nose, unless a shank of DMM begins where LN ends.
        tool.straight = tool.straight or bool(model.neck) or not reach
    needs["DN"] = bool(reach and not model.neck and not lollipop)
    needs["LN"] = "DN" in tool.values and not (lollipop or reach or model.neck)
    if model.neck:
        twice = "LN" if model.LN is not None else "DN" if model.DN is not None and not lollipop else ""
        if twice:
            tool.faults.append(f"neck and {twice}: give one of them")
        tool.shaft = tool.tried(lambda: _stages(model.neck, tool.scale, "neck"), [])
    elif reach and "DN" in tool.values and not (lollipop and tool.straight):
        tool.shaft = [Segment(0.5 * tool.values["DN"], reach)]


def _degrees(value: Any, field: str) -> float:
    if not isinstance(value, str):
        return raw_tool.number_of(value, field)
    degrees = math.degrees(stated_radians(value))
    if math.isnan(degrees):
        raise FaultError(f"{field} is {shown(value)}: a half angle in degrees, or as 0.0873 rad")
    return degrees


def _holder(value: Any, scale: float, named: dict[str, Holder | None]) -> Holder | Literal["none"] | None:
    if value is None:
        return None
    if isinstance(value, list):
        return _outlined(HolderTable(points=value), scale)
    if isinstance(value, HolderTable):
        return _outlined(value, raw_tool.unit_of(value.unit, "unit")[1] if value.unit else scale)
    if value == "none":
        if "none" in named:
            raise FaultError("holder 'none' means that there is none, but a [[holder]] has that name: rename it")
        return "none"
    if value in named:
        meant = named[value]
        if meant is None:
            raise FaultError(f"holder {shown(value)}: several different [[holder]] have this name")
        return meant
    try:
        return Holder.parse(value)
    except CutterError:
        raise FaultError(f"holder {shown(value)} is neither none, nor of the form R15L30 (mm), nor one of [[holder]]") from None


def _outlined(model: HolderTable, scale: float) -> Holder:
    if (model.points is None) == (model.stages is None):
        raise FaultError("holder needs points [[z, r], ...] or stages [[radius, length], ...], and not both")
    if model.stages is not None:
        return Holder(tuple(_stages(model.stages, scale, "holder stages")), model.name)
    stages = []
    points = [[raw_tool.mm(value, scale, "holder points", exact=True) for value in point] for point in model.points or ()]
    if not points or points[0][0] != 0.0:
        raise FaultError("holder points must begin at its nose, z 0")
    for (z0, r0), (z1, r1) in pairwise(points):
        if z1 < z0:
            raise FaultError(f"holder points fall from z {z0:g} to {z1:g}: they must rise from the nose up")
        if z1 > z0:
            stages.append(Segment(r0, round(z1 - z0, 9), r1))
    return Holder(tuple(stages), model.name)


def _stages(rows: list[Section], scale: float, field: str) -> list[Segment]:
    return [Segment(*(raw_tool.mm(value, scale, field, exact=True) for value in row)) for row in rows]


def _rows(stages: Iterable[Segment]) -> list[list[float]]:
    return [[s.radius, s.length, *([] if s.upper_radius == s.radius else [s.upper_radius])] for s in stages]


def _kind(cutter: Cutter) -> str:
    if cutter.shape != "end":
        return cutter.shape
    if cutter.taper:
        return "taper" if cutter.taper > 0.0 else "dovetail"
    return "flat" if not cutter.corner_radius else "ball" if cutter.corner_radius == cutter.radius else "bull"


def _written(cutter: Cutter, name: str, number: int | None, feed: float | None = None, drill: Drill | None = None) -> list[str]:
    lollipop, arc = cutter.shape == "lollipop", cutter.shape in ("barrel", "lens")
    called = {"name": cutter.holder.name} if cutter.holder and cutter.holder.name else {}
    entry: dict[str, Any] = {
        "number": number,
        "name": name or None,
        "type": _kind(cutter) if drill is None else drill.kind,
        "DC": None if cutter.shape == "form" else 2.0 * cutter.radius,
        "SIG": None if drill is None or drill.point is None else stated_degrees(drill.point),
        "TP": None if drill is None else drill.pitch,
        "HAND": "L" if drill is not None and drill.left else None,
        "RE": None if lollipop else cutter.corner_radius or None,
        "TA": stated_degrees(abs(cutter.taper)) if cutter.taper else None,
        "PRFRAD": cutter.arc_radius if arc else None,
        "profile_height": cutter.arc_height if arc else None,
        "outline": [[height, radius] for radius, height in cutter.outline] or None,
        "LCF": None if cutter.shape in ("lollipop", "form") else cutter.flutes or "rest",
        "LPR": cutter.length,
        "neck": _rows(cutter.necks) or None,
        "DN" if lollipop else "DMM": "same" if cutter.shank_radius is None else 2.0 * cutter.shank_radius,
        "holder": "none" if cutter.holder is None else {**called, "stages": _rows(cutter.holder.stages)},
        "allowance": cutter.allowance,
        "clearance": cutter.clearance,
        "feed": None if feed is None else float(feed),
    }
    return ["", "[[tool]]", *(f"{word} = {toml_text(value)}" for word, value in entry.items() if value is not None)]


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
    lines.insert(0, f"# From {raw_tool.name_of(cutters.file)} ({cutters.format})")
    for holder in cutters.holders:
        name = "" if holder.name == "none" else holder.name
        lines += ["", "[[holder]]", f"name = {toml_text(name)}", f"stages = {toml_text(_rows(holder.stages))}"]
    for entry in cutters.entries:
        made = entry.cutter if entry.drill is None else entry.drill.body
        if made is None:
            lines += ["", f"# Not used: {raw_tool.name_of(entry.label)}: {raw_tool.name_of(entry.unused)}"]
            continue
        lines += _written(made, entry.name, entry.number, entry.feed, entry.drill)
        lines[-1:] = [lines[-1], *(f"# {raw_tool.name_of(note)}" for note in entry.notes)]
    return "\n".join([*lines, ""])
