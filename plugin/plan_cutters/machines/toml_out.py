"""Machines in our own format: what is written is read as the same machine, bit for bit."""

import json
import math
from typing import Any

from plan_cutters.domain.axis import Axis
from plan_cutters.domain.machine import Machine
from plan_cutters.machines.toml_in import FORMAT


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
    }
    if machine.tilt_limit is not None:
        entry["tilt_limit"] = _angle(machine.tilt_limit)
    if machine.notes:
        entry["notes"] = list(machine.notes)
    entry["part_chain"] = [_axis(each) for each in machine.axes[::-1] if each.carries == "part"]
    entry["tool_chain"] = [_axis(each) for each in machine.axes if each.carries == "tool"]
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
    lines = [f"{key} = {_toml(value)}" for key, value in entry.items() if key not in dict(chains)]
    lines += [f"{name} = []" for name, chain in chains if not chain]
    for name, chain in chains:
        for i, each in enumerate(chain):
            lines += ["", *([] if i else ["# From the bed outward."]), f"[[{name}]]"]
            lines += [f"{key} = {_toml(value)}" for key, value in each.items()]
    return "\n".join([*lines, ""])


def _axis(axis: Axis) -> dict[str, Any]:
    entry: dict[str, Any] = {"axis": axis.name, "type": axis.kind, "direction": list(axis.direction)}
    size = _angle if axis.kind == "rotary" else float
    if any(axis.point):
        entry["point"] = list(axis.point)
    if axis.limits is not None:
        entry["limits"] = [None if math.isinf(end) else size(end) for end in axis.limits]
    if axis.rate is not None:
        entry["rate"] = size(axis.rate)
    if axis.accuracy is not None:
        entry["accuracy"] = size(axis.accuracy)
    return entry


def _angle(angle: float) -> float | str:
    """Degrees, where they turn into the same radians."""
    degrees = math.degrees(angle)
    for each in (round(degrees, 9), degrees, math.nextafter(degrees, 0.0), math.nextafter(degrees, 2.0 * degrees)):
        if math.radians(each) == angle:
            return each
    return f"{angle!r} rad"


def _toml(value: Any) -> str:
    if isinstance(value, str):
        clean = value.encode("utf-8", "replace").decode("utf-8")
        return json.dumps(clean, ensure_ascii=False).replace("\x7f", "\\u007f")
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, dict):
        return f"{{ {', '.join(f'{key} = {_toml(each)}' for key, each in value.items())} }}"
    if isinstance(value, list):
        # TOML has no null; only limits lack an end.
        ends = ["-inf", "inf"]
        return f"[{', '.join(ends[i] if each is None else _toml(each) for i, each in enumerate(value))}]"
    return repr(value)
