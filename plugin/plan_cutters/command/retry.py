"""A face at which the CAD kernel came to no end, or crashed, is set aside, and the rest is planned without it.

A part that takes longer than it may is left, and the next one is planned.
"""

import math
from collections.abc import Callable, Sequence
from pathlib import Path

from plan_cutters.command import terminal
from plan_cutters.command.progress import Display
from plan_cutters_base.workers.assignment import TIMED_OUT
from plan_cutters_base.workers.errors import OutOfTime, Stuck, Unfinished
from plan_cutters_base.workers.supervise import supervise

#: Faces that are set aside for a part: with more of them, the file is rather to be exported again.
MOST = 5


def supervised(
    words: Sequence[str], *, parts: Sequence[str], read_timeout: float, memory: int, timeout: float = math.inf, since: float,
    display: Display | None = None, shows: Callable[[Path, bool], None] = lambda out, summarised: None,
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
                                       since=began, done=done, excluded=faces))  # fmt: skip
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
    from plan_cutters.command.partial_plan import not_in_time, verdicts_text
    from plan_cutters.report import file_name
    from plan_cutters.report.folder import ended

    missing = ", ".join(map(file_name, ended(out, why)))
    if text := verdicts_text(out):
        return f"{why}: {advice}; {text}{not_in_time(missing)}"
    return f"{why}: the plan is in {out}{f', without {missing}' if missing else ''}; {advice}"
