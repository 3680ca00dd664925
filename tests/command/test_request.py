"""What a command line requests: every value that click makes has its field and its type in a frozen record."""

from dataclasses import FrozenInstanceError
from typing import get_type_hints

import pytest
from pydantic import ConfigDict, TypeAdapter

from plan_cutters.command import entry, request
from plan_cutters.command.show import ShowRequest
from plan_cutters_agents.command import McpRequest
from plan_cutters_batch.command import BatchRequest
from plan_cutters_ci.changed import ChangedRequest
from plan_cutters_ci.diff import DiffRequest

#: Of each command its record, the words without which it is refused, and words that give every option a value of its own kind.
COMMANDS = {
    "plan": (request.PlanRequest, ["p.step"], ["--cutter", "R6L80", "--cutters", "a.toml", "--holder", "er32",
             "--assume-stickout", "30", "--skip-bad", "--setup", "+z", "--setup", "auto", "--fixture", "table", "--ignore", "F3",
             "--unit", "mm", "--spacing", "1", "--grid", "5", "--area-budget", "9", "--effort", "quick", "--map-budget", "9",
             "-o", "out", "--formats", "json", "--json", "-", "--operations", "both", "--feed", "900", "--index-step", "15",
             "--axis-accuracy", "0.1",
             "--index-time", "3", "--most-operations", "2", "--max-orientations", "5", "--no-patterns",
             "--check-operations", "plan.json",
             "--jobs", "2", "--timeout", "9", "--memory", "3", "--junit", "j.xml"]),
    "map": (request.MapRequest, ["p.step", "--at", "0,0,0", "--cutter", "R6L80"],
            ["--cutters", "a.toml", "--holder", "er32", "--setup", "-y", "--fixture", "table", "--ignore", "F3", "--unit", "mm",
             "-o", "a.png", "-o", "a.svg", "--json", "-"]),
    "diff": (DiffRequest, ["a", "b"], ["--slack", "1", "--despite", "unit", "-o", "out", "--json", "--junit", "j.xml"]),
    "changed": (ChangedRequest, [], ["--junit", "j.xml", "--annotations", "none", "--base", "main", "--staged",
                 "--cache", "c", "--", "--grid", "5"]),
    "tools": (request.ToolsRequest, [], ["a.toml", "--cutter", "D12L80", "--holder", "er32", "--assume-stickout", "30",
              "--to-toml", "b.toml", "--draw", "out", "--json"]),
    "machines": (request.MachinesRequest, [], ["trunnion-ac", "--angles", "0,0,1", "--axis", "A=3", "--to-toml", "m.toml"]),
    "batch": (BatchRequest, ["parts", "--out", "plans"], ["--cutter", "R6L80", "--setup", "+x", "--workers", "2",
              "--timeout-part", "9", "--limit-memory", "4", "--cluster", "tcp://h:1", "--force", "--dry-run", "--jobs", "1",
              "--junit", "j.xml"]),
    "show": (ShowRequest, ["out"], ["--part", "p.step", "--formats", "html", "-v", "--quiet", "--debug"]),
    "mcp": (McpRequest, [], ["--root", "parts", "--client-roots", "--most-mb", "3", "--memory", "4", "--timeout", "9"]),
}  # fmt: skip


@pytest.mark.parametrize("every", [False, True], ids=["least words", "many words"])
@pytest.mark.parametrize("name", sorted({*entry.commands()} - {"check"}))  # `check` hands its words on
def test_a_record_has_what_its_command_parses(name, every):
    record, least, more = COMMANDS[name]
    command = entry.module_of(f"plan-cutters {name}").command
    values = command.make_context(name, [*least, *more] if every else list(least)).params
    made = record(**values)
    for field, kind in get_type_hints(record).items():
        TypeAdapter(kind, config=ConfigDict(strict=True)).validate_python(getattr(made, field))
    with pytest.raises(FrozenInstanceError):
        made.debug = True


def test_a_value_without_a_field_is_refused():
    with pytest.raises(TypeError):
        DiffRequest(**dict.fromkeys(get_type_hints(DiffRequest)), more=1)
