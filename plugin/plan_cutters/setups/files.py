"""Setup files: where a part stands in a machine, as TOML that people write."""

import os
from pathlib import Path
from typing import Annotated, Any

from pydantic import BeforeValidator, Field, ValidationError
from pydantic_core import PydanticCustomError

from cad_io.units import UNITS
from plan_cutters.domain.checks import shown
from plan_cutters.domain.fixture import Fixture
from plan_cutters.domain.placement import Placement
from plan_cutters.domain.posture import along
from plan_cutters.errors import OptionError
from plan_cutters.files.content import Content
from plan_cutters.machines.chain import scaled
from plan_cutters.machines.toml import Table, Vector, explained


def _direction(value: Any) -> Any:
    """A word such as `+z` as three numbers; anything else as it is."""
    if not isinstance(value, str):
        return value
    direction = along(value)
    if direction is None:
        raise PydanticCustomError("direction", "give a direction as +z, -y or [0, 0, 1]")
    return list(direction)


_Direction = Annotated[Vector, BeforeValidator(_direction)]


class SetupTable(Table):
    """A setup; `axis` is another name of `z`, `origin` is in `unit`, the other words are those of the command line."""

    unit: str
    axis: _Direction | None = None
    z: _Direction | None = None
    x: _Direction | None = None
    origin: Vector | None = None
    clamped: str | list[str] = Field(default=[])
    fixtures: list[str] = Field(default=[])


def read_setup(path: str | os.PathLike[str]) -> Placement:
    """The placement that a setup file describes.

    Raises OptionError: the file is none, or contradicts itself.

    `path`: TOML: `unit` of its lengths, one of `cad_io.units.UNITS`; `axis` or `z`, and `x`: directions of the part along the
        machine's Z and X, three numbers or a word as `+z`; `origin`; `clamped`, in the words of `--faces`; `fixtures`, in those
        of `--fixture`: files are looked for in the setup file's folder.

    Examples
    --------
    >>> read_setup("none.toml")
    Traceback (most recent call last):
    plan_cutters.errors.OptionError: none.toml: cannot be read: No such file or directory
    """
    read = Content.of(path, "setup file", OptionError)
    try:
        if read.head.startswith("<"):
            raise OptionError('is a web page or XML, no setup file: give TOML, as unit = "mm" and axis = [0, 0, 1]')
        return _placement(SetupTable.model_validate(read.toml()), read)
    except ValidationError as error:
        raise OptionError(explained(error), file=read.name) from None
    except OptionError as error:
        if error.file == read.name:
            raise
        raise type(error)(error.cause, file=read.name) from None


def _placement(table: SetupTable, read: Content) -> Placement:
    if table.unit not in UNITS:
        raise OptionError(f"no length unit is called {shown(table.unit)}; give one of {', '.join(UNITS)}")
    if table.axis is not None and table.z is not None:
        raise OptionError("axis and z are two names of one direction: leave out one of them")
    z = table.z if table.axis is None else table.axis
    if z is None:
        raise OptionError("its axis is missing, as axis = [0, 0, 1]: the direction of the part along the machine's spindle")
    origin = None if table.origin is None else _three([scaled(each, UNITS[table.unit]) for each in table.origin])
    clamped = (table.clamped,) if isinstance(table.clamped, str) else tuple(table.clamped)
    fixtures = tuple(_fixture(text, table.unit, read.path.parent) for text in table.fixtures)
    return Placement(_three(z), None if table.x is None else _three(table.x), origin, clamped, fixtures, read.name)


def _three(numbers: list[float]) -> tuple[float, float, float]:
    return numbers[0], numbers[1], numbers[2]


def _fixture(text: str, unit: str, folder: Path) -> Fixture:
    fixture = Fixture.parse(text)
    if unit != "mm" and ((fixture.sizes and fixture.unit is None) or any(fixture.placement[:3])):
        # Lengths of words are mm unless they say otherwise, placements always: beside other lengths of the file that misleads.
        raise OptionError(
            f"{fixture}: in a file of other units than mm, a word must say its unit, as table:-5:mm, and a placement, "
            "which is in mm, is left out"
        )
    if fixture.kind or Path(fixture.source).is_absolute():
        return fixture
    return Fixture(str(folder / fixture.source), fixture.placement, fixture.unit, fixture.name)
