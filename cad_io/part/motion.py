"""Motions: rotations, mirrors and shifts of points."""

import math
from dataclasses import dataclass

import numpy as np

from cad_io.arrays import Floats, Record


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Motion(Record):
    """A motion that keeps all distances: x becomes `linear @ x + shift`.

    Attributes
    ----------
    linear : (3, 3) float
        Orthogonal; of a mirror the determinant is -1.
    shift : (3,) float
        mm.

    Examples
    --------
    >>> turn = Motion.turn(np.zeros(3), np.array([0.0, 0.0, 1.0]), np.pi / 2)
    >>> turn.points(np.array([[1.0, 0.0, 5.0]])).round(9).tolist()
    [[0.0, 1.0, 5.0]]
    """

    linear: Floats
    shift: Floats

    @classmethod
    def turn(cls, place: Floats, direction: Floats, angle: float) -> "Motion":
        """A rotation about a unit direction through a place, by an angle, rad."""
        x, y, z = direction
        cross = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
        linear = np.eye(3) + math.sin(angle) * cross + (1.0 - math.cos(angle)) * cross @ cross
        return cls(linear, place - linear @ place)

    @classmethod
    def mirror(cls, place: Floats, normal: Floats) -> "Motion":
        """A mirror with a unit normal at a place."""
        linear = np.eye(3) - 2.0 * np.outer(normal, normal)
        return cls(linear, 2.0 * (place @ normal) * normal)

    @classmethod
    def translation(cls, shift: Floats) -> "Motion":
        """A shift."""
        return cls(np.eye(3), np.asarray(shift, float))

    def points(self, point: Floats) -> Floats:
        """Points (n, 3) moved."""
        return np.asarray(point @ self.linear.T + self.shift)

    def directions(self, vector: Floats) -> Floats:
        """Vectors (n, 3) turned or mirrored."""
        return np.asarray(vector @ self.linear.T)

    def back(self, point: Floats) -> Floats:
        """Points (n, 3) that are moved to these."""
        return np.asarray((point - self.shift) @ self.linear)

    @property
    def axis(self) -> tuple[Floats, Floats] | None:
        """A place and the unit direction about which a rotation turns; None for others, and for no motion at all."""
        if np.linalg.det(self.linear) < 0.0:
            return None
        turn = self.linear - self.linear.T
        if np.abs(self.linear - np.eye(3)).max() < 1e-9:
            return None
        direction = np.array([turn[2, 1], turn[0, 2], turn[1, 0]])
        if np.linalg.norm(direction) < 1e-6:
            # Half a turn: what is not mirrored is the axis.
            values, vectors = np.linalg.eigh(0.5 * (self.linear + self.linear.T))
            direction = vectors[:, int(values.argmax())]
        direction = direction / np.linalg.norm(direction)
        place = np.linalg.lstsq(np.eye(3) - self.linear, self.shift - (self.shift @ direction) * direction, rcond=1e-9)[0]
        return place, direction
