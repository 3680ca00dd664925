"""Postures: the range of tilts and rotations to search, intervals as arrays (k, 2), and directions as callers give them."""

import math
import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Protocol

import numpy as np

from cad_io.arrays import Floats
from plan_cutters.domain.checks import Angle, degrees_too, number, numbers, pair, radians, shown
from plan_cutters.errors import OptionError

_RIGHT, _FULL = math.pi / 2, 2 * math.pi
_ROUNDING = 1e-9
#: A range as callers give it.
Range = Sequence[float] | Floats
#: What tilts, rotations and their steps may be in degrees.
TILTS, ROTATIONS, STEP = Angle(0.0, 180.0, "range"), Angle(-360.0, 360.0, "range"), Angle(0.1, 360.0)


@degrees_too({"tilt": TILTS, "rotation": ROTATIONS, "step": STEP})
@dataclass(frozen=True, slots=True)
class PostureRange:
    """Tilts from `tilt[0]` to `tilt[1]` at rotations from `rotation[0]` to `rotation[1]`, `step` apart. Radians; degrees as
    `tilt_deg`, `rotation_deg` and `step_deg`.

    Beyond a right angle a tool touches with the upper half of a ball, if it has one.
    A full turn does not repeat its first rotation; a part of a turn has both its ends, evenly shared at most `step` apart.

    >>> len(PostureRange().rotations), len(PostureRange(rotation=(0.0, 0.0)).rotations)
    (36, 1)
    """

    tilt: tuple[float, float] = (0.0, _RIGHT)
    rotation: tuple[float, float] = (0.0, _FULL)
    step: float = math.radians(10)

    if TYPE_CHECKING:

        def __init__(
            self, tilt: Range = ..., rotation: Range = ..., step: float = ..., *, tilt_deg: Range | None = None,
            rotation_deg: Range | None = None, step_deg: float | None = None,
        ) -> None: ...  # fmt: skip

    def __post_init__(self) -> None:
        tilt, rotation = pair(self.tilt, "tilt range"), pair(self.rotation, "rotation range")
        step = number(self.step, "rotation step")
        tilt = (radians(tilt[0], "tilt", math.pi), radians(tilt[1], "tilt", math.pi))
        rotation = (radians(rotation[0], "rotation", _FULL), radians(rotation[1], "rotation", _FULL))
        step = radians(step, "rotation step", _FULL)
        _check(tilt, rotation, step, _RIGHT, "rad")
        for word, checked in (("tilt", tilt), ("rotation", rotation), ("step", step)):
            object.__setattr__(self, word, checked)

    @classmethod
    def degrees(cls, tilt: tuple[float, float], rotation: tuple[float, float], step: float) -> "PostureRange":
        """The same in degrees; rotations may also count from another turn, as 350:380 does.

        Raises OptionError: a range has no meaning.
        """
        _check(tilt, rotation, step, 90.0, "deg")
        turns = 0.0 if max(map(abs, rotation)) <= 360 else 360.0 * round(sum(rotation) / 720)
        low, high, first, last = (math.radians(x) for x in (*tilt, *(x - turns for x in rotation)))
        return cls((low, high), (first, last), math.radians(step))

    @property
    def rotations(self) -> Floats:
        """(k,) rotations, rad."""
        first, last = self.rotation
        spans = math.ceil((last - first) / self.step - _ROUNDING)
        return np.linspace(first, last, max(spans, 1) if self.full_turn else spans + 1, endpoint=not self.full_turn)

    @property
    def full_turn(self) -> bool:
        """Whether its rotations are a whole turn."""
        return self.rotation[1] - self.rotation[0] > _FULL - _ROUNDING

    @property
    def upright(self) -> bool:
        """Whether tilt 0 belongs to it: only then can a sample be interference-free."""
        return self.tilt[0] <= _ROUNDING


def tilt_direction(normal: Floats, direction_max: Floats, rotation: Floats | float) -> Floats:
    """Unit tilt directions (..., 3) at rotations (...,), rad, about normals (..., 3)."""
    turn = np.asarray(rotation)[..., None]
    return np.asarray(np.cos(turn) * direction_max + np.sin(turn) * np.cross(normal, direction_max))


def _check(tilt: tuple[float, float], rotation: tuple[float, float], step: float, right: float, unit: str) -> None:
    """Whether ranges have a meaning, where a right angle is `right` of a unit."""
    (low, high), (first, last) = tilt, rotation
    rounding, full = _ROUNDING * right, 4 * right
    if not -rounding <= low <= high <= 2 * right + rounding:
        raise OptionError(f"tilt range {low:g}:{high:g} must run upwards within 0:{2 * right:.4g} ({unit})")
    if not (math.isfinite(first) and first <= last <= first + full + rounding):
        raise OptionError(f"rotation range {first:g}:{last:g} must run upwards and span at most {full:.4g} {unit}")
    least = right / 900
    if not least - rounding <= step <= full + rounding:
        raise OptionError(f"rotation step {step:g} must lie between {least:.2g} and {full:.4g} {unit}")


def along(text: str) -> tuple[float, float, float] | None:
    """The direction that a word such as `+z`, `Z` or `-y` names; None for any other text.

    >>> along("-Y"), along("up")
    ((0.0, -1.0, 0.0), None)
    """
    match = re.fullmatch(r"([+-]?)([xyz])", text.strip(), re.IGNORECASE)
    if match is None:
        return None
    x, y, z = ((-1.0 if match[1] == "-" else 1.0) if match[2].lower() == each else 0.0 for each in "xyz")
    return x, y, z


def unit(vector: Any, what: str) -> Floats:
    """The direction (3,) of a vector, of a word as `along` has it, or of a host's axis; OptionError if it has none."""
    if isinstance(vector, str):
        named = along(vector)
        if named is None:
            raise OptionError(f"{what} {shown(vector)} is no direction: give +x, -x, +y, -y, +z, -z, or three numbers")
        vector = named
    v = np.array(numbers(vector_of(vector), what, 3))
    largest = float(np.abs(v).max())
    if not 0.0 < largest < math.inf:
        raise OptionError(f"{what} must be three numbers x,y,z that are finite and not all zero")
    # First to the size of 1: squares of very large or small numbers are lost.
    v = v / largest
    return np.asarray(v / np.linalg.norm(v))


Direction = tuple[float, float, float]


def direction_of(vector: Floats) -> Direction:
    """A direction (3,) as numbers, without negative zeros."""
    x, y, z = (vector + 0.0).tolist()
    return x, y, z


class HostAxis(Protocol):
    """An axis as build123d has it, whose direction has X, Y and Z."""

    @property
    def direction(self) -> Any: ...


class BuildPlane(Protocol):
    """A plane as build123d has it, with directions that have X, Y and Z."""

    @property
    def z_dir(self) -> Any: ...
    @property
    def x_dir(self) -> Any: ...


class CadPlane(Protocol):
    """A plane as CadQuery has it, with directions that have x, y and z."""

    @property
    def zDir(self) -> Any: ...
    @property
    def xDir(self) -> Any: ...


HostPlane = BuildPlane | CadPlane
#: A direction as callers give it: a word as `+z`, a host's axis, or three numbers, which a host's vector has, too.
Heading = str | HostAxis | Iterable[float]


def plane_of(plane: Any) -> tuple[Direction, Direction] | None:
    """The normal and the X of a host's plane; None where it is none."""
    for normal, across in (("z_dir", "x_dir"), ("zDir", "xDir")):
        z, x = _coordinates(getattr(plane, normal, None)), _coordinates(getattr(plane, across, None))
        if z is not None and x is not None:
            return z, x
    return None


def vector_of(vector: Any) -> Any:
    """The three numbers of a host's axis; anything else as it is.

    An `Axis` of a machine is none of these: its direction is in the machine's frame.

    >>> vector_of((0, 0, 1)), vector_of(None)
    ((0, 0, 1), None)
    """
    coordinates = _coordinates(getattr(vector, "direction", None))
    return vector if coordinates is None else coordinates


def _coordinates(vector: Any) -> Direction | None:
    """Those of a host's vector; whether they are finite numbers is looked at where they are used."""
    for words in ("XYZ", "xyz"):
        coordinates: list[Any] = [getattr(vector, word, None) for word in words]
        if not any(each is None or callable(each) for each in coordinates):
            x, y, z = coordinates
            return x, y, z
    return None


def _rows(intervals: list[tuple[float, float]]) -> Floats:
    return np.array(intervals, float).reshape(-1, 2)


def join(intervals: Floats) -> Floats:
    """Join intervals, in any order, where they overlap or touch; ascending.

    >>> join(np.array([[2.0, 3.0], [0.0, 1.0], [1.0, 1.5]])).tolist()
    [[0.0, 1.5], [2.0, 3.0]]
    """
    joined: list[tuple[float, float]] = []
    for first, last in intervals[np.argsort(intervals[:, 0], kind="stable")].tolist():
        if joined and first <= joined[-1][1]:
            joined[-1] = (joined[-1][0], max(joined[-1][1], last))
        else:
            joined.append((first, last))
    return _rows(joined)


def common(a: Floats, b: Floats) -> Floats:
    """The common parts of each two intervals, of which single numbers count.

    >>> common(np.array([[0.0, 2.0], [3.0, 4.0]]), np.array([[1.0, 3.0]])).tolist()
    [[1.0, 2.0], [3.0, 3.0]]
    """
    pairs = [(max(x, u), min(y, v)) for x, y in a.tolist() for u, v in b.tolist()]
    return _rows([(low, high) for low, high in pairs if low <= high])


def without(intervals: Floats, others: Floats) -> Floats:
    """The parts of sorted intervals that none of the others, sorted, covers; single numbers do not count.

    >>> without(np.array([[0.0, 4.0]]), np.array([[1.0, 2.0], [3.0, 9.0]])).tolist()
    [[0.0, 1.0], [2.0, 3.0]]
    >>> without(np.zeros((0, 2)), np.array([[1.0, 2.0]])).tolist()
    []
    """
    remaining = []
    for low, high in intervals.tolist():
        for first, last in others.tolist():
            if last <= low or first >= high:
                continue
            if first > low:
                remaining.append((low, first))
            low = max(low, last)
        if high > low:
            remaining.append((low, high))
    return _rows(remaining)


def complement(intervals: Floats, low: float, high: float) -> Floats:
    """The parts of [low, high] that no interval, sorted, covers."""
    return without(np.array([[low, high]]), intervals)
