"""`plan-cutters machines`: the machines that are built in, and what is understood of a machine file."""

import json
import math
from collections.abc import Mapping, Sequence
from importlib import import_module
from typing import TYPE_CHECKING, Any

import click

from plan_cutters.command.codes import ENDED, USAGE, faults
from plan_cutters.command.option_groups import Command, heading, options
from plan_cutters.command.request import MachinesRequest, takes
from plan_cutters.command.terminal import error, hand_out, paper
from plan_cutters.command.validation import File, Words, machine_names, three
from plan_cutters.domain.figures import exact_angle
from plan_cutters.errors import OptionError, PlanError
from plan_cutters_base.terminal_text import clean
from plan_cutters_base.whole import whole

if TYPE_CHECKING:
    from rich.console import Console

    from plan_cutters.domain.machine import Machine

_SELF = "plan-cutters machines"


_questions, _output = heading("Questions"), heading("Output")


@click.command(
    cls=Command,
    examples=(
        (_SELF, "The machines that are built in:"),
        (f"{_SELF} trunnion-ac --angles 0.3,0,1", "The angles that hold a tool axis:"),
        (f"{_SELF} shop.fcm --to-toml shop.toml", "A machine file as it is understood, and the same as TOML:"),
    ),
    codes=(("0", "each machine is understood"), ("2", "one is not, or the command line is wrong"), ENDED),
)
@click.argument("machines", nargs=-1, metavar="[NAME|FILE]...", type=Words("NAME|FILE", machine_names, files=True))
@_questions("--angles", metavar="X,Y,Z", help="Angles that hold this tool axis, from the tip to the spindle: both solutions.")
@_questions("--axis", type=Words("A=DEG,C=DEG", listed=True), help="The tool axis at these angles; those not named are 0.")
@_output("--json", "as_json", is_flag=True, help="All that was understood, as JSON on standard output.")
@_output("--to-toml", type=File("FILE"), help="Write the machine in our own format.")
@options("debug")
@takes(MachinesRequest)
def command(request: MachinesRequest) -> int:
    """Show how each machine is understood: a built-in one by its name, or a file.

    It reads our own TOML and JSON, FreeCAD .fcm, LinuxCNC .ini and Fusion .mch. Where a file does not say how rotary axes stand
    on each other, add it: FILE#C,A (from the part to the tool), FILE#C/B (C carries the part, B the tool).
    Without an argument, the machines that are built in are listed.
    """
    from plan_cutters.domain.machine import builtin_machines
    from plan_cutters.machines.read import source_of

    machines = request.machines
    if not machines and (request.to_toml or request.angles or request.axis):
        raise OptionError("which machine? give a name or a file")
    if request.to_toml is not None and len(machines) != 1:
        raise OptionError("--to-toml writes one machine: give one")
    axis = None
    if request.angles is not None:
        axis = three(request.angles, f"--angles {request.angles!r}: a tool axis is three numbers, as 0,0,1")
        if not (all(map(math.isfinite, axis)) and math.hypot(*axis) >= 1e-9):
            raise OptionError(f"--angles {request.angles!r}: a tool axis is three finite numbers that are not all zero")
    turned = None if request.axis is None else _angles(request.axis)
    entries: list[dict[str, Any]] = []
    read: list[Machine] = []

    def one(name: str) -> None:
        machine, form = source_of(name)
        entries.append(_facts(name, form, machine, axis, turned))
        read.append(machine)

    lines = faults(machines or tuple(builtin_machines()), one, request.debug)
    if read and not lines and request.to_toml is not None:
        with whole(request.to_toml, PlanError) as temporary:
            temporary.write_text(import_module("plan_cutters.machines").to_toml(read[0]), encoding="utf-8")
    if request.as_json:
        document = {"format": "plan-cutters-machines", "format_version": 1, "machines": entries}
        hand_out(json.dumps(document, indent=2, ensure_ascii=False) + "\n")
    else:
        with paper(200) as console:
            if not machines:
                _list(read, console)
            for facts, machine in zip(entries, read, strict=True) if machines else ():
                _explain(facts, machine, console)
    for line in lines:
        error(line)
    return USAGE if lines else 0


def _angles(text: str) -> dict[str, float]:
    angles: dict[str, float] = {}
    for word in text.split(","):
        name, _, value = word.partition("=")
        try:
            degrees = float(value)
        except ValueError:
            degrees = math.nan
        if not name.strip() or not math.isfinite(degrees) or name.strip() in angles:
            raise OptionError(f"--axis {text!r}: angles are given in degrees, each axis once, as A=30,C=10")
        angles[name.strip()] = math.radians(degrees)
    return angles


def _facts(
    name: str, form: str, machine: "Machine", axis: tuple[float, float, float] | None, turned: dict[str, float] | None
) -> dict[str, Any]:
    """Gather the facts of one machine, in the form that JSON has."""
    import numpy as np

    from plan_cutters.machines.explain import share, singular, solutions, tool_axis
    from plan_cutters.machines.toml import plain

    held, near = share(machine)
    cone = singular(machine)

    def degrees(angles: Mapping[str, float]) -> dict[str, float]:
        return {key: math.degrees(angle) for key, angle in angles.items()}

    facts: dict[str, Any] = {
        "given": name, "format": form or "built in", "machine": plain(machine), "share_of_directions": held,
        "singular_cone_deg": None if cone is None else math.degrees(cone), "singular_share": near,
    }  # fmt: skip
    if axis is not None:
        each = [{"deg": degrees(each.angles), "taken": each.taken} for each in solutions(machine, np.array(axis))]
        facts["angles"] = {"tool_axis": list(axis), "solutions": each}
    if turned is not None:
        held_axis, beyond = tool_axis(machine, turned)
        facts["axis"] = {"deg": degrees(turned), "tool_axis": [float(value) for value in held_axis], "beyond_limits": beyond}
    return facts


def _list(machines: "Sequence[Machine]", console: "Console") -> None:
    from rich.table import Table

    from plan_cutters.machines.explain import limits_text, share, share_text

    table = Table("Name", "Rotary axes from the part to the tool", "Share of directions")
    table.columns[-1].justify = "right"
    for machine in machines:
        axes = [f"{axis.name} ({axis.carries}, {limits_text(axis)})" for axis in machine.rotary]
        table.add_row(machine.name, ", ".join(axes) or "none", share_text(machine, share(machine).held))
    console.print(table)
    console.print(
        "Others: unlimited, tilt:DEG (within DEG of the setup axis), or a machine file. Names explain one.", soft_wrap=True
    )


def _explain(facts: dict[str, Any], machine: "Machine", console: "Console") -> None:
    from rich.table import Table

    from plan_cutters.machines.explain import limits_text, summary, vector_text

    def say(text: str) -> None:
        console.print(clean(text), soft_wrap=True)

    title = facts["given"] if machine.name == facts["given"] else f"{facts['given']}: {machine.name}"
    say(f"{title} ({facts['format']})")
    for line in summary(machine):
        say(f"  {line}")
    if machine.axes:
        table = Table("From the part", "Carries", "Moves", "Limits", "Through (mm)", "Speed")
        for axis in machine.axes:
            rotary, rate = axis.kind == "rotary", ""
            if axis.rate is not None:
                rate = f"{math.degrees(axis.rate) if rotary else axis.rate:.6g} {'deg' if rotary else 'mm'}/s"
            moves, through = f"{'about' if rotary else 'along'} {vector_text(axis.direction)}", vector_text(axis.point)
            table.add_row(clean(axis.name), axis.carries, moves, limits_text(axis), through if rotary else "", rate)
        console.print(table)
        say("  Directions are those of the tool relative to the part (ISO 841), at zero positions.")
    if machine.turns:
        say(f"  At zero positions the tool axis is {vector_text(machine.tool_axis)}, from the tip to the spindle.")
    for note in machine.notes:
        say(f"  note: {note}")

    def at(angles: dict[str, float]) -> str:
        return ", ".join(f"{name} {exact_angle(angle)}" for name, angle in angles.items())

    if "angles" in facts:
        held = facts["angles"]["solutions"]
        wanted = f"({', '.join(f'{value:g}' for value in facts['angles']['tool_axis'])})"
        if not held:
            say(f"  No position within the limits holds the tool axis {wanted}.")
        for each in held:
            taken = " (taken: the smaller turns)" if each["taken"] and len(held) > 1 else ""
            where = f" at {at(each['deg'])}" if each["deg"] else ""
            say(f"  The tool axis {wanted} is held{where}{taken}.")
    if "axis" in facts:
        turned = facts["axis"]
        beyond = f"; beyond the limits: {', '.join(turned['beyond_limits'])}" if turned["beyond_limits"] else ""
        direction = ", ".join(f"{value:.9g}" for value in turned["tool_axis"])
        say(f"  At {at(turned['deg'])} the tool axis is ({direction}){beyond}.")
