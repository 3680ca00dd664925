"""Show whether a written plan of operations holds on its part.

`plan-cutters check PLAN.JSON PART` is `plan-cutters PART --check-operations PLAN.JSON`: nothing is written.
"""

import hashlib
import json
import sys
import time
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, NoReturn

import click

from plan_cutters.command import terminal
from plan_cutters.command.codes import ENDED, run
from plan_cutters.command.option_groups import Command, options
from plan_cutters.command.progress import Display, Teller
from plan_cutters_base.workers.child import is_child

if TYPE_CHECKING:
    from plan_cutters.options import Options

_SELF = "plan-cutters check"
#: Files that must stand with plan.json, and what they hold.
_FILES = {"operations.npz": "operations of a plan", "samples.npz": "samples of a plan"}


@click.command(
    cls=Command,
    context_settings={"ignore_unknown_options": True},
    examples=((f"{_SELF} part-plan/plan.json part.step --cutters shop.tools", "With the options of the plan:"),),
    codes=(
        ("0", "all that was checked holds"),
        ("1", "something does not hold, or not by the tolerance of this command"),
        ("2", "the command line is wrong, or the file is no plan of this part with these options"),
        ("3", "the part cannot be read"),
        ENDED,
    ),
)
@click.argument("file", metavar="PLAN.JSON")
@click.argument("words", metavar="PART [OPTIONS]", nargs=-1, required=True, type=click.UNPROCESSED)
@options("debug")
def command(file: str, words: tuple[str, ...], debug: bool) -> None:
    """Show whether the operations of a plan.json hold on its part, by a program that shares nothing with the search.

    The options are those of the plan: cutters, machine, setups, fixtures and tolerance. The files of the plan stand beside it.
    """


def main(args: Sequence[str] | None = None, name: str = _SELF) -> NoReturn:
    """Run the main command on the part, with the plan to check."""
    words = list(sys.argv[1:] if args is None else args)
    if len(words) < 2 or words[0].startswith("-"):
        run(command, name, words)
    from plan_cutters.command.cli import main as plan

    plan([*words[1:], "--check-operations", words[0]], name)


def checked(part: str, file: str, options: "Options", *, quiet: bool, read_timeout: float) -> int:
    """Check the operations of a plan.json; 0: all that was checked holds, 1: not all, or not by the tolerance that is wanted.

    Raises OptionError: the file is no plan with operations, or one of another part or of other options.
    """
    from cad_io import read_part
    from plan_cutters.errors import OptionError
    from plan_cutters_check.asking import question_of
    from plan_cutters_check.check import check

    document, arrays, checksums = _read(file)
    display = None if is_child() else Display(quiet, 0, time.monotonic(), itself=True)
    progress = Teller(display)
    progress("check", 0, 1)
    try:
        read = read_part(part, unit=options.unit, timeout=read_timeout)
        question = replace(question_of(read, options, document, arrays), checksums=checksums)
        answer = check(question, tell=progress.detail)
    except OptionError as error:
        raise OptionError(error.cause, file=file) from None
    except (KeyError, TypeError, ValueError, IndexError, OverflowError, AttributeError) as error:
        raise OptionError(f"the plan of operations cannot be understood ({type(error).__name__}: {error})", file=file) from None
    finally:
        if display is not None:
            display.clear()
    if not quiet:
        terminal.show(*answer.lines)
    return 0 if answer.holds and not answer.beyond else 1


def _read(file: str) -> tuple[dict[str, Any], dict[str, dict[str, Any]], dict[str, tuple[str, str]]]:
    """plan.json, the arrays beside it, and of each of these files the SHA-256 that is stated and that it has."""
    from plan_cutters.errors import OptionError
    from plan_cutters.files.arrays import Archive
    from plan_cutters_check.question import require_operations

    try:
        document = json.loads(Path(file).read_text(encoding="utf-8"))
    except OSError as error:
        raise OptionError(f"cannot be read ({error.strerror or error})", file=file) from None
    except (ValueError, RecursionError) as error:
        raise OptionError(f"is no JSON ({error}): give the plan.json of a plan of operations", file=file) from None
    if not isinstance(document, dict) or document.get("format") != "plan-cutters-plan":
        raise OptionError("is no plan.json of plan-cutters", file=file)
    require_operations(document, file)
    stated = {each["name"]: each["sha256"] for each in document.get("files", {}).values() if isinstance(each, dict)}
    arrays, checksums = {}, {}
    for name, noun in _FILES.items():
        path = Path(file).parent / name
        if not path.exists():
            raise OptionError(f"{name} must be in its folder: copy all files of the plan", file=file)
        with Archive(path, noun, OptionError) as archive:
            arrays[name] = {each: archive.read(each) for each in archive.headers}
        if name in stated:
            checksums[name] = stated[name], hashlib.sha256(path.read_bytes()).hexdigest()
    return document, arrays, checksums
