"""Columns: what an operation with a fixed orientation may be, a cutter in a setup with one tool axis."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from cad_io.arrays import Floats, Ints, Record


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Columns(Record):
    """Operations that may be chosen, each with one cutter, setup and tool axis.

    Attributes
    ----------
    cutter, setup : (m,) int32
        Index into the cutters and setups that were requested.
    axis : (m, 3) float
        Unit tool axis in part coordinates: the one that the rounded `angle` gives.
    angle : (m, 2) float
        Positions of the rotary axes, deg, as a control shows them; without rotary axes the azimuth and the tilt about the setup
        axis.
    """

    cutter: Ints
    setup: Ints
    axis: Floats
    angle: Floats

    def __len__(self) -> int:
        return len(self.axis)

    @property
    def key(self) -> NDArray[np.str_]:
        """A text for each, the same for the same ones."""
        rows = zip(self.cutter.tolist(), self.setup.tolist(), self.angle.tolist(), strict=True)
        return np.array([f"{c} {s} {a:.3f} {b:.3f}" for c, s, (a, b) in rows], np.str_)

    @property
    def first(self) -> NDArray[np.int64]:
        """Where (k,) each of them that differs from all before it stands."""
        return np.sort(np.unique(self.key, return_index=True)[1])

    def of(self, which: NDArray[np.int64]) -> "Columns":
        """Take some of them."""
        return Columns(self.cutter[which], self.setup[which], self.axis[which], self.angle[which])

    def and_(self, more: "Columns") -> "Columns":
        """Append more of them."""
        both = (np.concatenate([getattr(self, name), getattr(more, name)]) for name in Columns.__slots__)
        return Columns(*both)


def columns_of(axis: Floats, angle: Floats, cutter: int = 0, setup: int = 0) -> Columns:
    """Make columns of one cutter in one setup."""
    n = len(axis)
    return Columns(np.full(n, cutter, np.int32), np.full(n, setup, np.int32), axis, angle)
