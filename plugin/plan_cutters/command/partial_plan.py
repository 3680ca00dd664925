"""Tell the user what is missing of a plan. This module loads almost nothing: an interrupted command must end at once."""

from pathlib import Path
from typing import TYPE_CHECKING

from plan_cutters.command import terminal
from plan_cutters.command.codes import UNREADABLE
from plan_cutters_base.workers.assignment import INTERRUPTED
from plan_cutters_base.workers.errors import Unfinished

if TYPE_CHECKING:
    from plan_cutters.command.request import PlanRequest


def without_models(stopped: Unfinished, request: "PlanRequest") -> int:
    """The plan was safe when the process that made it was ended: say what is missing; its exit code stands."""
    line = remaining_text(stopped.out, str(stopped))
    show_plan(stopped.out, request, summarised=stopped.summarised)
    terminal.error(f"plan-cutters: {line}")
    remaining = request.parts[stopped.parts :]
    if remaining and stopped.code != INTERRUPTED:
        terminal.error(f"plan-cutters: not planned: {', '.join(remaining)}")
        return max(stopped.code, UNREADABLE)
    return stopped.code


def show_plan(out: Path, request: "PlanRequest", *, summarised: bool) -> None:
    """Show the plan of a run that was ended: its summary, unless that was shown already, its files, and itself where that is
    requested.
    """
    from plan_cutters.report import PLAN

    path = out / PLAN
    if not path.is_file():
        return
    if not request.quiet:
        from plan_cutters.command.summary import summary, written
        from plan_cutters.plan_file.load import load_plan
        from plan_cutters.report.folder import DEFAULT_FORMATS, read_formats

        plan, tells = load_plan(path), terminal.say if request.json_out == "-" else terminal.show
        if not summarised:
            summary(plan, verbose=request.verbose, tells=tells)
        formats = DEFAULT_FORMATS if request.formats is None else read_formats(request.formats)
        tells(*written(plan, out, formats, verbose=request.verbose))
    if request.json_out == "-":
        terminal.hand_out(path.read_text(encoding="utf-8"))


def remaining_text(out: Path, why: str) -> str:
    """Say what is missing of a plan in a folder, whose run ended for a reason; the plan says so, too."""
    from plan_cutters.report import PLAN, file_name
    from plan_cutters.report.folder import ended

    missing = ", ".join(map(file_name, ended(out, why)))
    if text := verdicts_text(out):
        return f"{why}; {text}{not_in_time(missing)}"
    if missing:
        return f"{missing} in {out}: not written: {why}"
    return f"{why}; {'its plan' if (out / PLAN).is_file() else 'what stands'} is in {out}"


def not_in_time(missing: str) -> str:
    """A sentence about files that there was no time for; empty where there are none."""
    return f" There was no time to write {missing}: the same command without those options does." if missing else ""


def verdicts_text(out: Path) -> str:
    """Where a plan that has the verdicts alone stands, and what it is without; empty where there is another one or none."""
    from plan_cutters.report import PLAN
    from plan_cutters.report.to_json import unfinished

    text = unfinished(out / PLAN)
    return f"the plan of the verdicts is in {out / PLAN}. {text}" if text else ""
