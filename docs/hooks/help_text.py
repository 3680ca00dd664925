"""`<!-- help: plan-cutters -->` in a page becomes what that command prints with `--help`, so that the page cannot grow old."""

import re
from importlib import import_module
from typing import Any

from click import Command
from click.testing import CliRunner

from plan_cutters.command.entry import MODULES


def on_page_markdown(markdown: str, **_: Any) -> str:
    return re.sub(r"<!-- help: (\S+) -->", lambda found: f"```text\n{_help(found[1])}```", markdown)


def _help(name: str) -> str:
    command: Command = import_module(f"plan_cutters.command.{MODULES[name]}").command
    result = CliRunner(env={"COLUMNS": "100", "NO_COLOR": "1", "TERM": "dumb"}).invoke(
        command, ["--help"], prog_name=name
    )
    if result.exit_code:
        raise RuntimeError(f"{name} --help: {result.output or result.exception}")
    return result.output
