"""A plan that is not whole: say what is missing of it; a face that the CAD kernel fell at is set aside, and the rest planned."""

import math
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from plan_cutters.command import terminal
from plan_cutters.command.codes import UNREADABLE
from plan_cutters.command.progress import Display
from plan_cutters_base.workers.child import INTERRUPTED, TIMED_OUT
from plan_cutters_base.workers.supervise import OutOfTime, Stuck, Unfinished, supervise

if TYPE_CHECKING:
    from plan_cutters.command.request import PlanRequest


def without_models(stopped: Unfinished, request: "PlanRequest") -> int:
    """The plan was safe when the process that made it was ended: say what is missing; its exit code stands."""
    line = remaining_text(stopped.out, str(stopped))
    show_plan(stopped.out, request, summarised=stopped.summarised)
    terminal.error(f"plan-cutters: {line}")
    if (remaining := request.parts[stopped.parts :]) and stopped.code != INTERRUPTED:
        terminal.error(f"plan-cutters: not planned: {', '.join(remaining)}")
        return max(stopped.code, UNREADABLE)
    return stopped.code


def show_plan(out: Path, request: "PlanRequest", *, summarised: bool) -> None:
    """Show the plan of a run that was ended: its summary, unless that was shown already, its files, and itself where that is
    requested.
    """
    from plan_cutters.report.folder import PLAN

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
    from plan_cutters.report.folder import PLAN

    missing = _ended(out, why)
    if text := verdicts_text(out, missing):
        return f"{why}; {text}"
    if missing:
        return f"{missing} in {out}: not written: {why}"
    return f"{why}; {'its plan' if (out / PLAN).is_file() else 'what stands'} is in {out}"


def _ended(out: Path, why: str) -> str:
    """Files that the plan in a folder is without, now that its run has ended for a reason."""
    from plan_cutters.report.folder import ended, file_name

    return ", ".join(map(file_name, ended(out, why)))


def verdicts_text(out: Path, missing: str = "") -> str:
    """Where a plan that has the verdicts alone stands, what it is without, and files that there was no time for.

    It is empty where there is another plan or none.
    """
    from plan_cutters.plan_file.words.names import typed
    from plan_cutters.report.folder import PLAN
    from plan_cutters.report.to_json import unfinished

    if not (text := typed(unfinished(out / PLAN))):
        return ""
    late = f" There was no time to write {missing}: plan-cutters show {out} does." if missing else ""
    return f"the plan of the verdicts is in {out / PLAN}. {text}{late}"


#: Faces that are set aside for a part: with more of them, the file is rather to be exported again.
MOST = 5


def supervised(
    words: Sequence[str], *, parts: Sequence[str], read_timeout: float, memory: int, timeout: float = math.inf, since: float,
    display: Display | None = None, shows: Callable[[Path, bool], None] = lambda out, summarised: None,
    leave: Callable[[int, Path], None] | None = None,
) -> int:  # fmt: skip
    """`supervise`, again and again without the face at which it ended, or without the part that took too long.

    `since`: when the first of the parts began; `shows`: called with the output of a plan whose part is left, and whether its
    summary was shown; all else as there.
    """
    done, code = 0, 0
    began: float | None = since
    faces: dict[int, str] = {}
    while True:
        try:
            return max(code, supervise(words, read_timeout=read_timeout, memory=memory, display=display, timeout=timeout,
                                       since=began, done=done, excluded=faces, leave=leave))  # fmt: skip
        except Unfinished as stopped:
            stopped.parts += done
            stopped.code = max(code, stopped.code)
            raise
        except Stuck as stopped:
            if stopped.before:
                done, faces = done + stopped.before, {}
            code, began = max(code, stopped.code), stopped.since
            if stopped.face in faces or len(faces) >= MOST:
                raise
            faces[stopped.face] = stopped.why
            terminal.error(f"plan-cutters: {stopped.part}: F{stopped.face}: {stopped.why}; planned without this face")
        except OutOfTime as stopped:
            done, code = done + stopped.before, max(code, stopped.code)
            if done == len(parts):  # all of them are, and only the end was slow
                return code
            line = _failure_text(stopped.out, timeout)
            if stopped.out is not None:
                shows(stopped.out, stopped.summarised)
            terminal.error(f"plan-cutters: {parts[done]}: {line}")
            if display is not None:
                display.failed(f"{parts[done]}: {line}", parts[done])
            done, faces, began = done + 1, {}, None
            code = max(code, TIMED_OUT)
            if done == len(parts):
                return code


def _failure_text(out: Path | None, timeout: float) -> str:
    """Say why a part is left, and what is missing where its plan is in the output already."""
    why = f"not done within {timeout:g} s"
    advice = "sample more coarsely (--spacing), or give more time (--timeout)"
    if out is None:
        return f"{why}: {advice}"
    missing = _ended(out, why)
    if text := verdicts_text(out, missing):
        return f"{why}: {advice}; {text}"
    return f"{why}: the plan is in {out}{f', without {missing}' if missing else ''}; {advice}"
