"""All entries of the plan file derive from the class of this module."""

import re
from collections.abc import Sequence
from typing import Any, ClassVar, TypeVar

import numpy as np
from numpy.typing import NDArray
from pydantic import BaseModel, ConfigDict

Vector = tuple[float, float, float]


class Frozen(BaseModel):
    """An entry of the plan: its fields and no others."""

    model_config: ClassVar[ConfigDict] = ConfigDict(frozen=True, extra="forbid")


_Entry = TypeVar("_Entry", bound=Frozen)
#: Records are in mm, and say so in no name.
_UNIT = re.compile("_mm2?$")


def filled(kind: type[_Entry], record: object, /, **other: Any) -> _Entry:
    """Make an entry of a record: each field is the record's attribute of its name, also without a unit, or one of `other`.

    A field that neither has keeps its default.
    """
    names = {name: name if hasattr(record, name) else _UNIT.sub("", name) for name in kind.model_fields.keys() - other.keys()}
    return kind(**{name: getattr(record, its) for name, its in names.items() if hasattr(record, its)}, **other)


class Posture(Frozen):
    tilt: float
    rotation: float
    axis: Vector


def vector(v: Sequence[float] | NDArray[np.float64]) -> Vector:
    """A direction or point as three plain numbers."""
    return float(v[0]), float(v[1]), float(v[2])


def posture(tilt: float, rotation: float, axis: Sequence[float] | NDArray[np.float64]) -> Posture:
    """A posture from angles in rad."""
    return Posture(tilt=float(np.degrees(tilt)), rotation=float(np.degrees(rotation)), axis=vector(axis))
