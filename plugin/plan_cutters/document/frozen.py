"""What all entries of the plan are made of."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray
from pydantic import BaseModel, ConfigDict

Vector = tuple[float, float, float]


class Frozen(BaseModel):
    """An entry of the plan: its fields and no others."""

    model_config = ConfigDict(frozen=True, extra="forbid")


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
