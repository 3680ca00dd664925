"""The planner's own process as people write it, TOML: `[[step]]` by `[[step]]`, in their order; programs write JSON."""

import os
import re
from collections.abc import Mapping
from pathlib import Path
from typing import Annotated, Any, Literal

from pydantic import BeforeValidator, Field, ValidationError
from pydantic_core import PydanticCustomError

from plan_cutters.domain.checks import shown
from plan_cutters.domain.own_process import LEFT, Forbidden, OwnProcess, OwnStep, unit_axis
from plan_cutters.errors import OptionError
from plan_cutters.files.content import Content
from plan_cutters.machines.toml import Number, Table, Vector, explained

#: Bytes and steps that no process written by hand has.
_MOST, _STEPS = 1 << 20, 500
#: Rotary axes turn over a full turn many times at most; words of a cutter are short.
_Angle = Annotated[Number, Field(ge=-36000.0, le=36000.0)]
_Cutter = Annotated[str, Field(min_length=1, max_length=300, description="id, the word by which it is given, or its name")]
_Faces = Annotated[list[str], Field(min_length=1, description="as F12")]


def _named(value: Any) -> Any:
    """The word `left`, or names of faces; what is neither is told so, once for both."""
    if value != LEFT and not (isinstance(value, list) and value and all(isinstance(each, str) for each in value)):
        raise PydanticCustomError("faces", 'write faces = ["F3", "F12"], or "left" for all that is left')
    return value


class StepTable(Table):
    """A step: one cutter in one setup, at one fixed orientation or simultaneous, on some faces."""

    setup: Annotated[int, Field(ge=1, le=1000, strict=True, description="from 1")] = 1
    mode: Literal["fixed", "simultaneous", "any"] | None = Field(
        default=None, description="fixed where there are angles or an axis; any: as simultaneous"
    )
    angles: Annotated[dict[str, _Angle], Field(max_length=8)] | None = Field(
        default=None, description="of each rotary axis by name, deg; null where it is simultaneous, or there is none"
    )
    axis: Vector | None = Field(default=None, description="in place of angles: towards the spindle, part coordinates")
    cutter: _Cutter
    faces: Annotated[Literal["left"] | _Faces, BeforeValidator(_named)] = Field(
        default="left", description="left: all that no step before it finishes"
    )
    take: Literal["first", "share"] = Field(
        default="first",
        description="first: all of its faces that no such step before it takes; share: of what those leave, divided by time with "
        "the other steps that share it",
    )


class ForbidTable(Table):
    """A cutter that is not to be planned on some faces."""

    cutter: _Cutter
    faces: _Faces


class ProcessTable(Table):
    """Steps that are judged as they stand, in their order, and what is done with what they leave."""

    format: Literal["plan-cutters-process"] = "plan-cutters-process"
    version: Literal[1] = 1
    rest: Literal["plan", "leave"] = Field(default="plan", description="plan: more steps are planned behind these; or leave it")
    step: list[StepTable] = Field(default=[], max_length=_STEPS)
    forbid: list[ForbidTable] = Field(default=[], max_length=_STEPS, description="cutters that are not planned on some faces")


def process_of(value: Any) -> OwnProcess:
    """The planner's process: as it is, from a mapping of the names that the file has, or read from a file.

    Raises OptionError: it cannot be read, or says what has no meaning; with the place.

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
    read = Content.of(value, "process file", OptionError)
    if len(read.data) > _MOST:
        raise OptionError("is too large for a process that a person wrote", file=read.name)
    if read.path.suffix.lower() == ".json" or read.head.startswith("{"):
        if read.json is None:
            raise read.broken_json()
        return _made(read.json, str(read.path))
    if read.head.startswith("<"):
        raise OptionError("is a web page or XML, no process file: give the process.toml of a plan", file=read.name)
    return _made(read.toml(), str(read.path))


def _made(document: Any, file: str) -> OwnProcess:
    name = Path(file).name if file else "process"
    try:
        table = ProcessTable.model_validate(document)
    except ValidationError as error:
        raise OptionError(explained(error), file=name) from None
    steps = tuple(_step(number, each, name) for number, each in enumerate(table.step, 1))
    if not steps and (table.rest == "leave" or not table.forbid):
        why = 'rest = "leave": there is nothing to judge' if table.rest == "leave" else "forbids nothing: add a [[step]]"
        raise OptionError(f"has no step, and {why}", file=name)
    forbidden = tuple(
        Forbidden(each.cutter, _numbers(each.faces, name, f"forbid {number}")) for number, each in enumerate(table.forbid, 1)
    )
    return OwnProcess(steps, forbidden, table.rest, file)


def _step(number: int, table: StepTable, file: str) -> OwnStep:
    where, turned = f"step {number}", (table.angles is not None) + (table.axis is not None)
    if table.mode in ("simultaneous", "any"):
        if turned:
            raise OptionError(f"{where}: angles and axis are of a fixed orientation: leave them out, or the mode", file=file)
    elif turned > 1 or (turned == 0 and table.mode is None):
        need = "give angles or an axis, not both" if turned else "angles are missing, as angles = { C = 0.0, A = 0.0 }"
        raise OptionError(f'{where}: {need}, or mode = "simultaneous"; on three axes mode = "fixed"', file=file)
    # A machine without rotary axes has no angles.
    fixed = turned > 0 or table.mode == "fixed"
    angles = table.angles if turned or not fixed else {}
    return OwnStep(
        number=number, setup=table.setup - 1, mode="fixed" if fixed else "simultaneous", cutter=table.cutter,
        angles=None if angles is None else tuple(angles.items()),
        axis=None if table.axis is None else unit_axis(table.axis, f"{file}: {where}"),
        faces=None if table.faces == LEFT else _numbers(table.faces, file, where), take=table.take,
    )  # fmt: skip


def _numbers(faces: "list[str] | str", file: str, where: str) -> tuple[int, ...]:
    numbers = []
    for word in faces:
        if not re.fullmatch(r"F[1-9][0-9]{0,8}", word):
            raise OptionError(
                f'{where}: faces: {shown(word)} is no face: write F12, or faces = "left" for all that is left', file=file
            )
        numbers.append(int(word[1:]))
    return tuple(dict.fromkeys(numbers))
