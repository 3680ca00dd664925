"""How a surface bends over the cells of a grid in its parameter plane: bounds that hold everywhere in a cell, not samples."""

from typing import NamedTuple

import numpy as np

from cad_io.arrays import Floats


class Bends(NamedTuple):
    """Bounds over a grid of cells.

    middle (a, b, 3, 3): Suu, Svv, Suv, none of which differs from its middle by more than spread (a, b, 3) anywhere in the
    cell. first (a, b, 2): neither Su nor Sv is longer.
    """

    middle: Floats
    spread: Floats
    first: Floats

    @staticmethod
    def none(u: Floats, v: Floats) -> "Bends":
        """Room for the cells between lines."""
        shape = len(u) - 1, len(v) - 1
        return Bends(np.zeros((*shape, 3, 3)), np.zeros((*shape, 3)), np.zeros((*shape, 2)))
