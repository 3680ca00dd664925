"""Exit codes, and what ends in which."""

import traceback
from typing import TYPE_CHECKING, Any

import click

from plan_cutters.command.supervise import INTERRUPTED, Supervised

if TYPE_CHECKING:
    from plan_cutters.document.model import Plan

FEASIBLE, NONE_FEASIBLE, USAGE, UNREADABLE, NOT_ALL_JUDGED = 0, 1, 2, 3, 4


def code_of(plan: "Plan") -> int:
    """The exit code that a plan asks for."""
    if plan.selected is None and plan.selected_over_setups is None:
        # What is missing from the obstacles leaves open whether a cutter that nothing else stops is stopped by it.
        doubtful = plan.missing and any(c.feasible is None for c in plan.cutters)
        return NOT_ALL_JUDGED if doubtful else NONE_FEASIBLE
    unjudged = plan.samples.unjudged or any(f.target and f.unjudged for f in plan.faces)
    return NOT_ALL_JUDGED if unjudged else FEASIBLE


def guarded(work: Any, debug: bool) -> tuple[int, str]:
    """Run; errors that have a cause become an exit code and a line."""
    from cad_io.errors import CadIoError, WriteError
    from plan_cutters.errors import PlanError, UnjudgeableError

    try:
        code, line = work()
        return int(code), str(line)
    except (Exception, KeyboardInterrupt) as error:
        if debug:
            traceback.print_exc()
        match error:
            case KeyboardInterrupt():
                return INTERRUPTED, "plan-cutters: interrupted; no file is half-written"
            case Supervised():
                return UNREADABLE, f"plan-cutters: {error}"
            case MemoryError():
                return UNREADABLE, "plan-cutters: out of memory; sample more coarsely (--spacing), or give --memory"
            case UnjudgeableError():
                return UNREADABLE, f"plan-cutters: {error}"
            case WriteError() | PlanError():
                return USAGE, f"plan-cutters: {error}"
            case CadIoError():
                return UNREADABLE, f"plan-cutters: {error}"
            case click.ClickException():
                return USAGE, f"plan-cutters: {error.format_message()}"
            case _:
                return (
                    UNREADABLE,
                    f"plan-cutters: internal error ({type(error).__name__}: {error}); --debug shows where",
                )
