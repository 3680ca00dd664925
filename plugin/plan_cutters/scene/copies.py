"""Copies: samples that motions of the whole part carry onto other samples, and which of these leave what is judged as it is."""

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from cad_io.arrays import Floats, Ints, Record
from cad_io.part.equal_faces import Motion

Rows = NDArray[np.int64]


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Copies(Record):
    """Samples that are images of others under motions of the whole part.

    Attributes
    ----------
    master : (n,) int64
        The sample whose image each one is; itself where it is none.
    motion : (n,) int32
        Which motion carries the master onto it, -1 for none.
    motions : tuple of Motion
    unchanged : tuple of tuple of bool
        Of each setup, whether each motion leaves all that verdicts depend on as it is: limits of axes, fixtures, what is ignored.
    frames : (n,) bool
        Copies whose postures that are searched are the images of those searched at the master.
    verified : (n,) bool
        Those of `frames` that are judged by themselves as well: a tenth of them, on each face that a motion carries onto another.
    group : (n,) int64
        The same for copies of one motion on one face, -1 for none.
    setup : int
        Counted from 0, in which the part is looked at.
    """

    master: Rows
    motion: Ints
    motions: tuple[Motion, ...]
    unchanged: tuple[tuple[bool, ...], ...]
    frames: NDArray[np.bool_]
    verified: NDArray[np.bool_]
    group: Rows
    setup: int = 0

    def there(self, setup: int) -> "Copies":
        """The same in another setup."""
        return replace(self, setup=setup)

    @property
    def copy(self) -> NDArray[np.bool_]:
        """Samples (n,) that are images of others."""
        return np.asarray(self.motion >= 0)

    @property
    def follow(self) -> NDArray[np.bool_]:
        """Copies (n,) of which it may follow that they are not reached, where their master is not."""
        follows = np.append(np.array(self.unchanged[self.setup], bool), False)
        return np.asarray(self.frames & self.copy & follows[self.motion])

    def moved(self, rows: Rows, vector: Floats) -> Floats:
        """Vectors (m, 3) at the masters of copies, as the motions carry them."""
        result = np.full((len(rows), 3), np.nan)
        for k, motion in enumerate(self.motions):
            mine = self.motion[rows] == k
            result[mine] = motion.directions(vector[mine])
        return result
