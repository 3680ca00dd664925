"""The question of a plan, as `samples.npz` has it: models of a folder can be made later, without the command that made it."""

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from plan_cutters.options import Options
from plan_cutters.report.protocol import Judged
from plan_cutters_base.values import packed, unpacked


@dataclass(frozen=True, slots=True, eq=False)
class Question:
    """All that a plan was made with besides its part: the part is prepared again with it."""

    options: Options
    excluded: Mapping[int, str]  #: Faces that the CAD kernel could not work on, by number: why.


def question_of(result: Judged) -> NDArray[np.uint8]:
    """The question of a result, in bytes; none where it holds objects of a script, which no file has."""
    ready = result.ready
    faces = ",".join(f"F{number}" for number in ready.chosen.targets)
    options = replace(
        ready.options, cutters=ready.cutters, libraries=(), holder=None, jobs=1, faces=faces, ignore=ready.chosen.ignore,
        answers=(), operations=None, process=None, posture_maps=False,
    )  # fmt: skip
    try:
        data = b"".join(packed(Question(options, dict(result.part.aside))))
    except TypeError:
        data = b""
    return np.frombuffer(data, np.uint8)


def read_question(data: NDArray[np.uint8]) -> Question | None:
    """The question that `question_of` wrote; None where there is none that this version reads."""
    try:
        read = unpacked(bytearray(data.tobytes()))
    except (ValueError, TypeError, LookupError, AttributeError, ImportError):
        return None
    return read if isinstance(read, Question) else None
