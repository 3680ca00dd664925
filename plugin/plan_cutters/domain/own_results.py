"""Results of the steps of the planner's own process."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from cad_io.arrays import Floats
from plan_cutters.domain.cutter import Cutter
from plan_cutters.domain.own_process import Mode


@dataclass(frozen=True, slots=True, eq=False)
class Nearest:
    """The orientation next to one that a person wrote which serves more: its angles (2,), deg, its axis (3,), and the rows."""

    angle: Floats
    axis: Floats
    rows: NDArray[np.int64]


@dataclass(frozen=True, slots=True, eq=False)
class OwnResult:
    """A step of the planner's own process does this.

    Attributes
    ----------
    number : int
        In the file, from 1.
    setup : int
    mode : str
    cutter : Cutter
    axis : (3,) float, optional
        None where it is simultaneous.
    angle : (2,) float, optional
        As written, deg, or the nearest that the machine has for an axis; None where it is simultaneous.
    requested : (m,) int64
        Samples of its faces that no step before it finishes.
    rows : (r,) int64
        Those of them that it finishes.
    serves : (k,) int64
        All samples of its faces that it could finish, whoever takes them.
    wrong : str
        Why it does less than is asked of it, in words; empty where it does all.
    nearest : Nearest, optional
        An orientation that would do, where there is one.
    """

    number: int
    setup: int
    mode: Mode
    cutter: Cutter
    axis: Floats | None
    angle: Floats | None
    requested: NDArray[np.int64]
    rows: NDArray[np.int64]
    serves: NDArray[np.int64]
    wrong: str = ""
    nearest: Nearest | None = None
