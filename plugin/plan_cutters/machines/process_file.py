"""The planner's own process as people write it, TOML: `[[step]]` by `[[step]]`, in their order."""

import os
import re
import tomllib
from collections.abc import Mapping
from pathlib import Path
from typing import Annotated, Any, Literal

from pydantic import BaseModel, ConfigDict, Field, ValidationError

from plan_cutters.domain.checks import shown
from plan_cutters.domain.own_process import LEFT, Forbidden, OwnProcess, OwnStep, unit_axis
from plan_cutters.errors import OptionError
from plan_cutters.machines.toml_in import Number, Vector, explained

#: Bytes that no process written by hand has.
_MOST = 1 << 20
_Faces = Annotated[list[str], Field(min_length=1)]


class _Table(BaseModel):
    model_config = ConfigDict(extra="forbid")


class StepTable(_Table):
    """A step; `any` means simultaneous: it is what a plan without operations says of its steps."""

    setup: Annotated[int, Field(ge=1, strict=True)] = 1
    mode: Literal["fixed", "simultaneous", "any"] | None = None
    angles: dict[str, Number] | None = None
    axis: Vector | None = None
    cutter: Annotated[str, Field(min_length=1)]
    faces: Literal["left"] | _Faces = "left"


class ForbidTable(_Table):
    """A cutter that is not to be planned on some faces."""

    cutter: Annotated[str, Field(min_length=1)]
    faces: _Faces


class ProcessTable(_Table):
    """A whole file."""

    format: Literal["plan-cutters-process"] = "plan-cutters-process"
    version: Literal[1] = 1
    rest: Literal["plan", "leave"] = "plan"
    step: list[StepTable] = []
    forbid: list[ForbidTable] = []


def process_of(value: Any) -> OwnProcess:
    """The planner's process: as it is, from a mapping of the names that the file has, or read from a file.

    Raises
    ------
    OptionError
        It cannot be read, or says what has no meaning; with the place.

    Examples
    --------
    >>> process = process_of({"step": [{"cutter": "D12L60", "angles": {"C": 0.0, "A": 0.0}, "faces": ["F3"]}], "rest": "leave"})
    >>> process.steps[0].faces, process.rest
    ((3,), 'leave')
    """
    if isinstance(value, OwnProcess):
        return value
    if isinstance(value, Mapping):
        return _made(dict(value), "")
    if not isinstance(value, str | os.PathLike):
        raise OptionError(f"process: give a file or the steps, not {shown(value)}")
    path = Path(value)
    try:
        if path.stat().st_size > _MOST:
            raise OptionError("is too large for a process that a person wrote", file=str(path))
        return _made(tomllib.loads(path.read_text(encoding="utf-8")), str(path))
    except OSError as error:
        raise OptionError(f"cannot be read ({error.strerror}): give the process.toml beside a plan", file=str(path)) from None
    except (tomllib.TOMLDecodeError, UnicodeDecodeError, RecursionError) as error:
        raise OptionError(f"is no TOML: {error}", file=str(path)) from None


def _made(content: dict[str, Any], file: str) -> OwnProcess:
    try:
        table = ProcessTable.model_validate(content)
    except ValidationError as error:
        raise OptionError(explained(error), file=file or "process") from None
    steps = tuple(_step(number, each, file or "process") for number, each in enumerate(table.step, 1))
    if not steps and table.rest == "leave":
        raise OptionError('has no step, and rest = "leave": there is nothing to judge', file=file or "process")
    forbidden = tuple(Forbidden(each.cutter, _numbers(each.faces, file or "process", "forbid")) for each in table.forbid)
    return OwnProcess(steps, forbidden, table.rest, file)


def _step(number: int, table: StepTable, file: str) -> OwnStep:
    where, turned = f"step {number}", (table.angles is not None) + (table.axis is not None)
    if table.mode in ("simultaneous", "any"):
        if turned:
            raise OptionError(f"{where}: angles and axis are of a fixed orientation: leave them out, or the mode", file=file)
    elif turned != 1:
        need = "give angles or an axis, not both" if turned else "angles are missing, as angles = { C = 0.0, A = 0.0 }"
        raise OptionError(f'{where}: {need}, or mode = "simultaneous"', file=file)
    return OwnStep(
        number=number, setup=table.setup - 1, mode="fixed" if turned else "simultaneous", cutter=table.cutter,
        angles=None if table.angles is None else tuple(table.angles.items()),
        axis=None if table.axis is None else unit_axis(table.axis, f"{file}: {where}"),
        faces=None if table.faces == LEFT else _numbers(table.faces, file, where),
    )  # fmt: skip


def _numbers(faces: "list[str] | str", file: str, where: str) -> tuple[int, ...]:
    """Face numbers of words such as F12."""
    numbers = []
    for word in faces:
        if not re.fullmatch(r"F[1-9][0-9]{0,8}", word):
            raise OptionError(
                f'{where}: faces: {shown(word)} is no face: write F12, or faces = "left" for all that is left', file=file
            )
        numbers.append(int(word[1:]))
    return tuple(dict.fromkeys(numbers))
