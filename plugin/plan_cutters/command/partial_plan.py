"""Tell the user that models could not be finished. This module loads almost nothing: an interrupted command must end at once."""

from typing import TYPE_CHECKING

from plan_cutters.command import terminal
from plan_cutters.command.codes import UNREADABLE
from plan_cutters.workers.assignment import INTERRUPTED
from plan_cutters.workers.errors import Unfinished

if TYPE_CHECKING:
    from plan_cutters.command.request import PlanRequest


def without_models(stopped: Unfinished, request: "PlanRequest") -> int:
    """The plan was safe when the process that made it was ended: say what is missing; its exit code stands."""
    from plan_cutters.report import PLAN, file_name
    from plan_cutters.report.folder import ended

    path = stopped.out / PLAN
    missing = ", ".join(map(file_name, ended(stopped.out, str(stopped)))) or "a model"
    terminal.error(f"plan-cutters: {missing} in {stopped.out}: not written: {stopped}")
    if request.json_out == "-" and path.is_file():
        terminal.hand_out(path.read_text(encoding="utf-8"))
    remaining = request.parts[stopped.parts :]
    if remaining and stopped.code != INTERRUPTED:
        terminal.error(f"plan-cutters: not planned: {', '.join(remaining)}")
        return max(stopped.code, UNREADABLE)
    return stopped.code
