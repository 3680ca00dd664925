"""A face at which the CAD kernel came to no end, or crashed, is set aside, and the rest is planned without it."""

import json
import os
from collections.abc import Sequence

from plan_cutters.command import terminal
from plan_cutters.command.progress import Display
from plan_cutters.command.supervise import supervise
from plan_cutters.command.worker_errors import Stuck, Unfinished

#: Environment variable by which the child knows which parts are done and which faces of the next one are set aside.
ASIDE = "PLAN_CUTTERS_ASIDE"
#: Faces that are set aside for a part: with more of them, the file is rather to be exported again.
MOST = 5


def set_aside() -> tuple[int, dict[int, str]]:
    """How many parts are done; of the next one, by face number, why nothing more is to be asked about a face."""
    found = json.loads(os.environ.get(ASIDE, "[0, {}]"))
    return found[0], {int(number): why for number, why in found[1].items()}


def supervised(words: Sequence[str], *, read_timeout: float, memory: int, display: Display | None = None) -> int:
    """`supervise`, again and again without the face at which it ended."""
    done, code = 0, 0
    faces: dict[int, str] = {}
    while True:
        more = {ASIDE: json.dumps([done, faces])} if done or faces else {}
        try:
            return max(code, supervise(words, read_timeout=read_timeout, memory=memory, display=display, more=more))
        except Unfinished as stopped:
            stopped.parts += done
            stopped.code = max(code, stopped.code)
            raise
        except Stuck as stopped:
            if stopped.before:
                done, faces = done + stopped.before, {}
            code = max(code, stopped.code)
            if stopped.face in faces or len(faces) >= MOST:
                raise
            faces[stopped.face] = stopped.why
            terminal.error(f"plan-cutters: {stopped.part}: F{stopped.face}: {stopped.why}; planned without this face")
