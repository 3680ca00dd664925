"""Serve these questions to agents, by the Model Context Protocol."""

import os
import sys
from dataclasses import dataclass
from importlib.util import find_spec

import click

from plan_cutters.command.codes import ENDED
from plan_cutters.command.option_groups import Command, heading, options
from plan_cutters.command.request import takes
from plan_cutters.command.validation import Folder
from plan_cutters_agents.access import Limits
from plan_cutters_base.workers.child import INTERRUPTED

_SELF = "plan-cutters mcp"

_access, _limits = heading("Access"), heading("Limits of a call")


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class McpRequest(Limits):
    """Tools of agents: `plan-cutters mcp`."""

    roots: tuple[str, ...]
    client_roots: bool
    debug: bool


@click.command(
    cls=Command,
    examples=(
        (f"{_SELF} --root parts", "What a client starts; parts and libraries in this folder can be named:"),
        (f"{_SELF} --root parts --root tools --most-cutters 20 --timeout 300", "Two folders, and a lower limit for a call:"),
    ),
    codes=(
        ("0", "the client closed the connection"),
        ("2", "the command line is wrong, or the extra `mcp` is not installed"),
        ENDED,
    ),
)
@_access(
    "--root", "roots", type=Folder("DIR"), multiple=True,
    help="Folder in which calls may read and write; all else is refused. Repeatable.  [default: those that the client offers]",
)  # fmt: skip
@_access("--client-roots", is_flag=True, help="With --root: folders that the client offers are roots as well.")
@_limits(
    "--most-mb", type=click.FloatRange(0, min_open=True), default=200.0, metavar="MB", help="Size of a file.  [default: 200]"
)
@_limits("--most-samples", type=click.IntRange(1), default=200_000, metavar="N", help="Samples of a plan.  [default: 200000]")
@_limits(
    "--most-cutters", type=click.IntRange(1), default=50, metavar="N", help="Cutters, with those of a library.  [default: 50]"
)
@_limits(
    "--most-characters", type=click.IntRange(2000), default=40_000, metavar="N",
    help="Length of an answer: lists are cut, and the answer says how much is left out.  [default: 40000]",
)  # fmt: skip
@_limits("--timeout", type=click.FloatRange(0, min_open=True), default=900.0, metavar="S", help="Seconds.  [default: 900]")
@_limits(
    "--memory", type=click.FloatRange(2), metavar="GB", help="Memory of each process that plans.  [default: 3/4 of the machine's]"
)
@_limits("--calls", type=click.IntRange(1, 64), default=2, metavar="N", help="Calls that work at the same time.  [default: 2]")
@options("debug")
@takes(McpRequest)
def command(request: McpRequest) -> int:
    """Serve plan-cutters to agents over standard input and output, by the Model Context Protocol.

    The tools are plan_part, posture_map, explain_sample, compare_cutters, compare_plans, list_tools_and_machines and render. Each
    call works in a process of its own.
    """
    from plan_cutters.errors import OptionError, extra_hint

    if find_spec("mcp") is None:
        raise OptionError(f"the extra is not installed: {extra_hint('mcp')}")
    if sys.stdin is None or sys.stdout is None:
        raise OptionError("standard input or output is closed: a client talks over them")
    from plan_cutters_agents.server import serve, service_of

    if request.debug:
        import logging

        logging.basicConfig(level=logging.DEBUG)
    serve(service_of(request.roots, request, client_roots=request.client_roots), lambda: os._exit(INTERRUPTED))
    # A thread may still wait for standard input.
    sys.stdout.flush()
    os._exit(0)
