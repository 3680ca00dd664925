"""Our own machine files, TOML or JSON, read and written."""

import json
import math
import re
from typing import Annotated, Any, Literal

from pydantic import BaseModel, ConfigDict, Field, ValidationError

from plan_cutters.domain.checks import shown, stated_degrees, stated_radians
from plan_cutters.domain.machine import Axis, Carried, Machine
from plan_cutters.errors import MachineError
from plan_cutters.files.content import toml_text
from plan_cutters.machines.chain import ANGLES, LENGTHS, Added, Content, opposite, scaled

FORMAT = "plan-cutters-machine"
_LOOKS = re.compile(r"^\s*(format\s*=\s*[\"']plan-cutters-machine|\[\[\s*(part_chain|tool_chain)\s*\]\])", re.MULTILINE)

Number = Annotated[float, Field(allow_inf_nan=False, strict=True)]
#: A text gives radians, as "0.1 rad": for angles that no number of degrees turns into.
Size = Annotated[float, Field(strict=True)] | str
Vector = Annotated[list[Number], Field(min_length=3, max_length=3)]


class Table(BaseModel):
    """A table of a file: what it does not know is refused."""

    model_config = ConfigDict(extra="forbid")


class Units(Table):
    """Units of all lengths and angles."""

    length: Literal["mm", "cm", "m", "inch"]
    angle: Literal["deg", "rad"]


class AxisTable(Table):
    """An axis; `limits` missing or null: none, one of them null or inf: none on that side.

    `rate` is a speed a second, `acceleration` what that may change by in a second; `accuracy` an angle, of a rotary axis alone.
    """

    axis: Annotated[str, Field(min_length=1)]
    type: Literal["rotary", "linear"]
    direction: Vector
    point: Vector | None = None
    limits: Annotated[list[Size | None], Field(min_length=2, max_length=2)] | None = None
    rate: Size | None = None
    accuracy: Size | None = None
    acceleration: Size | None = None


class MaxTool(Table):
    """The largest tool that fits."""

    length: Number | None = None
    diameter: Number | None = None


class Mount(Table):
    """Where the part stands."""

    origin: Vector | None = None
    z: Vector | None = None


class MachineTable(Table):
    """A machine: each chain runs from the bed outward."""

    format: Literal["plan-cutters-machine"]
    version: Literal[1]
    name: str
    units: Units
    sign: Literal["tool-relative", "table"]
    tool_axis: Vector = [0.0, 0.0, 1.0]
    part_chain: list[AxisTable]
    tool_chain: list[AxisTable]
    tilt_limit: Size | None = None
    fixed: bool | None = None
    indexed: bool = False
    notes: list[str] = []
    max_tool: MaxTool | None = None
    part_mount: Mount | None = None


def is_toml(content: Content) -> bool:
    """TOML that names the format, or has a chain."""
    return content.head[:1] not in ("{", "<") and _LOOKS.search(content.text) is not None


def is_named(content: Content) -> bool:
    """A text whose file is called TOML, whatever it holds."""
    return content.path.suffix.lower() == ".toml" and "\0" not in content.text


def is_json(content: Content) -> bool:
    """JSON that names the format, or has a chain."""
    data = content.json
    return isinstance(data, dict) and (data.get("format") == FORMAT or "part_chain" in data or "tool_chain" in data)


def read_toml(content: Content, added: Added) -> Machine:
    """Read it."""
    return _machine(content.toml(), content, added)


def read_json(content: Content, added: Added) -> Machine:
    """Read it."""
    return _machine(content.json, content, added)


def _machine(entry: Any, content: Content, added: Added) -> Machine:
    added.refuse(content.name, order=True, sign=True)
    try:
        table = MachineTable.model_validate(entry)
    except ValidationError as error:
        raise MachineError(explained(error), file=content.name) from None
    length, angle = LENGTHS[table.units.length], ANGLES[table.units.angle]
    sides: list[tuple[Carried, list[AxisTable]]] = [("part", table.part_chain[::-1]), ("tool", table.tool_chain)]
    axes = [_axis(each, side, table.sign, length, angle) for side, chain in sides for each in chain]
    notes = list(table.notes)
    largest = {} if table.max_tool is None else table.max_tool.model_dump(exclude_none=True)
    if largest:
        words = " and ".join(f"{name} {value:g} {table.units.length}" for name, value in largest.items())
        notes.append(f"its largest tool, {words}, is not judged")
    if table.part_mount is not None and (
        any(table.part_mount.origin or ()) or (table.part_mount.z or [0, 0, 1]) != [0.0, 0.0, 1.0]
    ):
        notes.append("its part_mount is not used: a setup says where the part stands")
    tilt = None if table.tilt_limit is None else _size(table.tilt_limit, angle, "tilt_limit")
    fixed = table.fixed if table.fixed is not None else not any(each.kind == "rotary" for each in axes)
    tool = (table.tool_axis[0], table.tool_axis[1], table.tool_axis[2])
    return Machine(table.name, tilt, tuple(axes), tool, tuple(notes), fixed, table.indexed)


def _axis(table: AxisTable, carries: Carried, sign: str, length: float, angle: float) -> Axis:
    turns = table.type == "rotary"
    size = angle if turns else length
    what = f"axis {table.axis}"
    x, y, z = table.direction
    limits = None
    if table.limits is not None:
        low, high = table.limits
        limits = (
            -math.inf if low is None else _size(low, size, f"{what}: its least limit", turns),
            math.inf if high is None else _size(high, size, f"{what}: its largest limit", turns),
        )
        if limits[0] == math.inf or limits[1] == -math.inf:
            raise MachineError(f"{what}: its limits must run upwards, from -inf to inf")
    px, py, pz = (scaled(value, length) for value in table.point or (0.0, 0.0, 0.0))
    rate, accuracy, change = (
        None if (value := getattr(table, word)) is None else _size(value, size, f"{what}: its {word}", turns)
        for word in ("rate", "accuracy", "acceleration")
    )
    turned = opposite((x, y, z)) if sign == "table" and carries == "part" else (x, y, z)
    return Axis(table.axis, table.type, carries, turned, limits, (px, py, pz), rate, accuracy, change)


def _size(value: float | str, size: float, what: str, turns: bool = True) -> float:
    if isinstance(value, str):
        radians = stated_radians(value)
        if math.isnan(radians) or not turns:
            raise MachineError(f"{what} is {shown(value)}: it must be a number{', or an angle as 0.5 rad' if turns else ''}")
        return radians
    if math.isnan(value):
        raise MachineError(f"{what} must be a number, not nan")
    return scaled(value, size)


def explained(error: ValidationError) -> str:
    """One line of what is wrong."""
    first = max(error.errors(include_url=False, include_context=False), key=lambda each: len(each["loc"]))
    words = [str(word + 1) if isinstance(word, int) else word for word in first["loc"]]
    words = [word for word in words if word.isdigit() or (word.isidentifier() and word not in ("float", "str"))]
    place, last = " ".join(words[:-1]), words[-1] if words else "it"
    place = f"{place}: " if place else ""
    if first["type"] == "extra_forbidden":
        return f"{place}{shown(last)} is unknown here"
    if first["type"] == "missing":
        hint = {
            "unit": ', as unit = "mm"',
            "units": ', as units = { length = "mm", angle = "deg" }',
            "sign": ', "tool-relative" (ISO 841) or "table"',
            "length": ', as length = "mm"',
            "angle": ', as angle = "deg"',
            "format": f", {json.dumps(FORMAT)}",
            "version": ", 1",
            "part_chain": ", [] if no axis carries the part",
            "tool_chain": ", [] if no axis carries the tool",
        }.get(last, "")
        return f"{place}{last} is missing{hint}"
    message = first["msg"][:1].lower() + first["msg"][1:]
    return f"{place}{last} is {shown(first['input'])}: {message}"


def plain(machine: Machine) -> dict[str, Any]:
    """A machine as JSON has it; angles in degrees, lengths in mm, signs as in ISO 841.

    >>> plain(Machine("mill", fixed=True))["part_chain"]
    []
    """
    entry: dict[str, Any] = {
        "format": FORMAT,
        "version": 1,
        "name": machine.name,
        "units": {"length": "mm", "angle": "deg"},
        "sign": "tool-relative",
        "tool_axis": list(machine.tool_axis),
        "fixed": machine.fixed,
        **({"indexed": True} if machine.indexed else {}),
    }
    if machine.tilt_limit is not None:
        entry["tilt_limit"] = stated_degrees(machine.tilt_limit)
    if machine.notes:
        entry["notes"] = list(machine.notes)
    entry["part_chain"] = [_axis_table(each) for each in machine.axes[::-1] if each.carries == "part"]
    entry["tool_chain"] = [_axis_table(each) for each in machine.axes if each.carries == "tool"]
    return entry


def to_toml(machine: Machine) -> str:
    """A machine as TOML.

    >>> print(to_toml(Machine("mill", fixed=True)))
    format = "plan-cutters-machine"
    version = 1
    name = "mill"
    units = { length = "mm", angle = "deg" }
    sign = "tool-relative"
    tool_axis = [0.0, 0.0, 1.0]
    fixed = true
    part_chain = []
    tool_chain = []
    <BLANKLINE>
    """
    entry = plain(machine)
    chains = [(name, entry[name]) for name in ("part_chain", "tool_chain")]
    lines = [f"{key} = {toml_text(value)}" for key, value in entry.items() if key not in dict(chains)]
    lines += [f"{name} = []" for name, chain in chains if not chain]
    for name, chain in chains:
        for i, each in enumerate(chain):
            lines += ["", *([] if i else ["# From the bed outward."]), f"[[{name}]]"]
            lines += [f"{key} = {toml_text(value)}" for key, value in each.items()]
    return "\n".join([*lines, ""])


def _axis_table(axis: Axis) -> dict[str, Any]:
    entry: dict[str, Any] = {"axis": axis.name, "type": axis.kind, "direction": list(axis.direction)}
    size = stated_degrees if axis.kind == "rotary" else float
    if any(axis.point):
        entry["point"] = list(axis.point)
    if axis.limits is not None:
        entry["limits"] = [None if math.isinf(end) else size(end) for end in axis.limits]
    stated = {word: getattr(axis, word) for word in ("rate", "accuracy", "acceleration")}
    return entry | {word: size(value) for word, value in stated.items() if value is not None}
