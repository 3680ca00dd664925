"""Directions in objects of CAD hosts, an axis or a plane: no host is imported, and objects are told by what they have."""

from collections.abc import Iterable
from typing import Any, Protocol

Direction = tuple[float, float, float]


class HostAxis(Protocol):
    """An axis as build123d has it."""

    @property
    def direction(self) -> "BuildVector": ...


class BuildVector(Protocol):
    """A vector as build123d has it."""

    @property
    def X(self) -> float: ...
    @property
    def Y(self) -> float: ...
    @property
    def Z(self) -> float: ...


class CadVector(Protocol):
    """A vector as CadQuery has it."""

    @property
    def x(self) -> float: ...
    @property
    def y(self) -> float: ...
    @property
    def z(self) -> float: ...


class BuildPlane(Protocol):
    """A plane as build123d has it."""

    @property
    def z_dir(self) -> BuildVector: ...
    @property
    def x_dir(self) -> BuildVector: ...


class CadPlane(Protocol):
    """A plane as CadQuery has it."""

    @property
    def zDir(self) -> CadVector: ...
    @property
    def xDir(self) -> CadVector: ...


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
