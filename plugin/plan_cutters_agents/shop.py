"""List what there is to plan with: the tools of a library or the built-in set, and machines."""

import json
from typing import Any

from plan_cutters_agents.answers import MachineRow, ToolRow


def tools_in(output: bytes) -> tuple[list[ToolRow], list[str]]:
    """The tools in the output of the command `tools`, and a line for each that cannot be judged."""
    rows, unused = [], []
    for library in json.loads(output)["libraries"]:
        rows += [_tool(each) for each in library["cutters"]]
        unused += [f"{each['place']}: {each['unused']}" for each in library["entries"] if each["unused"]]
    return rows, unused


def built_in_tools() -> list[ToolRow]:
    """The tools that are judged where none are named."""
    from plan_cutters.domain.standard_tools import builtin
    from plan_cutters.plan_file.words.names import kind

    return [
        ToolRow(
            id=each.id, name=each.name, kind=kind(each), diameter_mm=2.0 * each.radius, corner_radius_mm=each.corner_radius,
            stickout_mm=each.length,
        )
        for each in builtin()
    ]  # fmt: skip


def machines_in(output: bytes) -> list[MachineRow]:
    """The machines in the output of the command `machines`."""
    return [
        MachineRow(
            name=each["given"],
            axes=[axis["axis"] for chain in ("tool_chain", "part_chain") for axis in each["machine"].get(chain, [])],
            reaches=each["share_of_directions"],
        )
        for each in json.loads(output)["machines"]
    ]


def _tool(cutter: dict[str, Any]) -> ToolRow:
    return ToolRow(
        id=cutter["id"], name=next(iter(cutter["names"]), ""), number=next(iter(cutter["numbers"]), None), kind=cutter["shape"],
        diameter_mm=2.0 * cutter["radius"], corner_radius_mm=cutter["corner_radius"], stickout_mm=cutter["length"],
        holder=(cutter["holder"] or {}).get("name", ""),
    )  # fmt: skip
