"""Postures: the range of tilts and rotations to search."""

import math
from dataclasses import dataclass

import numpy as np

from cad_io.arrays import Floats
from plan_cutters.errors import OptionError

_RIGHT, _FULL = math.pi / 2, 2 * math.pi
_ROUNDING = 1e-9


@dataclass(frozen=True, slots=True)
class PostureRange:
    """Tilts from `tilt[0]` to `tilt[1]` at rotations from `rotation[0]` to `rotation[1]`, `step` apart. Radians.

    A full turn does not repeat its first rotation; a part of a turn has both its ends, evenly shared at most `step` apart.
    """

    tilt: tuple[float, float] = (0.0, _RIGHT)
    rotation: tuple[float, float] = (0.0, _FULL)
    step: float = math.radians(10)

    def __post_init__(self) -> None:
        low, high = self.tilt
        if not (-_ROUNDING <= low <= high <= _RIGHT + _ROUNDING):
            raise OptionError(
                f"tilt range {math.degrees(low):g}:{math.degrees(high):g} must run upwards within 0:90 (degrees)"
            )
        first, last = self.rotation
        if not (math.isfinite(first) and first <= last <= first + _FULL + _ROUNDING):
            raise OptionError(
                f"rotation range {math.degrees(first):g}:{math.degrees(last):g} must run upwards and span at most 360 deg"
            )
        if not math.radians(0.1) - _ROUNDING <= self.step <= _FULL:
            raise OptionError(f"rotation step {math.degrees(self.step):g} must lie between 0.1 and 360 deg")

    @property
    def rotations(self) -> Floats:
        """(k,) rotations, rad."""
        first, last = self.rotation
        spans = math.ceil((last - first) / self.step - _ROUNDING)
        whole = last - first > _FULL - _ROUNDING
        return np.linspace(first, last, max(spans, 1) if whole else spans + 1, endpoint=not whole)

    @property
    def upright(self) -> bool:
        """Whether tilt 0 belongs to it: only then can a sample be interference-free."""
        return self.tilt[0] <= _ROUNDING


def lean(normal: Floats, direction_max: Floats, rotation: Floats | float) -> Floats:
    """Unit lean directions (..., 3) at rotations (...,), rad, about normals (..., 3)."""
    turn = np.asarray(rotation)[..., None]
    return np.asarray(np.cos(turn) * direction_max + np.sin(turn) * np.cross(normal, direction_max))


def unit(vector: tuple[float, float, float], what: str) -> Floats:
    """The direction of a vector; OptionError if it has none."""
    v = np.asarray(vector, float)
    length = float(np.linalg.norm(v)) if v.shape == (3,) and np.isfinite(v).all() else 0.0
    if length == 0.0:
        raise OptionError(f"{what} must be three numbers x,y,z that are not all zero")
    return np.asarray(v / length)
