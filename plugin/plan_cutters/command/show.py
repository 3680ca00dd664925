"""`plan-cutters show`: the page and the models of a folder that has a plan, and its summary."""

import signal
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, NoReturn

import click

from plan_cutters.command import terminal
from plan_cutters.command.codes import ENDED, UNREADABLE, ended, interrupt, invoked
from plan_cutters.command.option_groups import Command, heading, options
from plan_cutters.command.request import takes
from plan_cutters.command.validation import File, Folder
from plan_cutters.errors import PlanError
from plan_cutters_base.workers.child import began, can_supervise, is_child, report, report_work
from plan_cutters_base.workers.supervise import supervise

if TYPE_CHECKING:
    from plan_cutters.plan_file.model import Plan

_SELF = "plan-cutters show"
#: Where the work is for a child.
_CHILD = -1
_input = heading("Input")


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class ShowRequest:
    """Page and models of a folder: `plan-cutters show`."""

    folder: str
    part: str | None
    formats: str | None
    verbose: bool
    quiet: bool
    debug: bool


@click.command(
    cls=Command,
    examples=(
        (f"{_SELF} blade-plan", "After a run that was interrupted or ran out of time:"),
        (f"{_SELF} blade-plan --part parts/blade.step --formats html", "The page alone, with a part in another folder:"),
    ),
    codes=(
        ("0", "page and models are there"),
        ("2", "the folder has no plan, or the command line is wrong"),
        ("3", "some could not be made: each with a line, the summary is shown all the same"),
        ENDED,
    ),
)
@click.argument("folder", metavar="DIR", type=Folder("DIR"))
@_input("--part", type=File("FILE"), help="File of the part.  [default: by its name, here, in DIR or above it]")
@options("formats", "verbose", "quiet", "debug")
@takes(ShowRequest)
def command(request: ShowRequest) -> int:
    """Show the plan in a folder: print its summary, and make page and models that it lacks.

    They are made of plan.json and samples.npz there, and of the file of the part. Nothing is judged again.
    """
    from cad_io.errors import CadIoError
    from plan_cutters.domain.figures import listed
    from plan_cutters.plan_file.load import PLAN, load_plan
    from plan_cutters.report.folder import DEFAULT_FORMATS, file_name, missing_files, read_formats

    out = Path(request.folder)
    if out.name == PLAN and not out.is_dir():
        out = out.parent
    if not (out / PLAN).is_file():
        raise PlanError(f"has no {PLAN}: give the folder of a plan", file=str(out))
    plan = load_plan(out / PLAN)
    formats = read_formats(request.formats) if request.formats else (*DEFAULT_FORMATS, *plan.not_written)
    if (names := missing_files(plan, out, formats)) and not is_child() and can_supervise():
        return _CHILD
    try:
        plan = _made(plan, out, names, request) if names else plan
    except (PlanError, CadIoError) as error:
        why = ": ".join(filter(None, (error.file, error.cause)))
        there = {name: entry for name, entry in plan.files.items() if (out / entry.name).is_file()}
        plan = plan.model_copy(update={"files": there, "not_written": plan.not_written | dict.fromkeys(names, why)})
    if not request.quiet:
        from plan_cutters.command.summary import summary, written

        summary(plan, verbose=request.verbose, tells=terminal.show)
        terminal.show(*written(plan, out, formats, verbose=request.verbose))
    causes = {name: plan.not_written[name] for name in names if name in plan.not_written}
    for cause in dict.fromkeys(causes.values()):
        files = listed([file_name(name) for name in causes if causes[name] == cause])
        terminal.error(f"{_SELF}: not made: {files}: {cause}")
    return UNREADABLE if causes else 0


def _made(plan: "Plan", out: Path, names: Sequence[str], request: ShowRequest) -> "Plan":
    """The plan with the files that it lacked."""
    from plan_cutters.command.progress import Display, ModelsListener, Teller
    from plan_cutters.document.clock import Clock
    from plan_cutters.report.folder import Staging, write_missing
    from plan_cutters.restored import part_of, restored
    from plan_cutters_base.stage_cache import StageCache, settle

    tell = Teller(None if is_child() else Display(request.quiet, 1, began(), itself=True))

    part = part_of(plan, out, None if request.part is None else Path(request.part))
    clock = Clock.after(plan.run)
    clock.progress = tell
    with Staging(out, lambda folder: report("staging", str(folder))) as staging:
        result = restored(plan, out, part, clock, at=report_work, cache=StageCache.of_user())
        made = write_missing(result, out, names, staging, clock, ModelsListener(tell, request.debug))
    settle()
    return made


def main(words: Sequence[str], name: str = _SELF) -> NoReturn:
    """Run the command: what has to read the part is done in a child process, which can be ended while the CAD kernel is busy."""
    if is_child():
        signal.signal(signal.SIGINT, interrupt)
    ended(name, words, lambda: _watched(words, name))


def _watched(words: Sequence[str], name: str) -> int:
    code = invoked(command, name, words)
    if code != _CHILD:
        return code
    from plan_cutters.command.progress import Display

    display = Display("--quiet" in words, 1, began())
    try:
        return supervise(words, read_timeout=120.0, display=display, name=name)
    finally:
        display.clear()
        terminal.all_shown()
