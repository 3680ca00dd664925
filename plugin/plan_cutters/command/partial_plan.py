"""Tell the user what is missing of a plan. This module loads almost nothing: an interrupted command must end at once."""

from pathlib import Path
from typing import TYPE_CHECKING

from plan_cutters.command import terminal
from plan_cutters.command.codes import UNREADABLE
from plan_cutters.workers.assignment import INTERRUPTED
from plan_cutters.workers.errors import Unfinished

if TYPE_CHECKING:
    from plan_cutters.command.request import PlanRequest


def without_models(stopped: Unfinished, request: "PlanRequest") -> int:
    """The plan was safe when the process that made it was ended: say what is missing; its exit code stands."""
    from plan_cutters.report import PLAN

    path = stopped.out / PLAN
    terminal.error(f"plan-cutters: {remaining_text(stopped.out, str(stopped))}")
    if request.json_out == "-" and path.is_file():
        terminal.hand_out(path.read_text(encoding="utf-8"))
    remaining = request.parts[stopped.parts :]
    if remaining and stopped.code != INTERRUPTED:
        terminal.error(f"plan-cutters: not planned: {', '.join(remaining)}")
        return max(stopped.code, UNREADABLE)
    return stopped.code


def remaining_text(out: Path, why: str) -> str:
    """Say what is missing of a plan in a folder, whose run ended for a reason; the plan says so, too."""
    from plan_cutters.report import file_name
    from plan_cutters.report.folder import ended

    missing = ended(out, why)
    if text := verdicts_text(out):
        return f"{why}; {text}"
    return f"{', '.join(map(file_name, missing)) or 'a model'} in {out}: not written: {why}"


def verdicts_text(out: Path) -> str:
    """Where a plan that has the verdicts alone stands, and what it is without; empty where there is another one or none."""
    from plan_cutters.report import PLAN
    from plan_cutters.report.to_json import unfinished

    text = unfinished(out / PLAN)
    return f"the plan of the verdicts is in {out / PLAN}. {text}" if text else ""
