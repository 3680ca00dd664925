"""One task for all plans of operations of a part: samples, cutters, setups, and the tests and prices of columns."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from plan_cutters.domain.cutter import Cutter
from plan_cutters.domain.operations import Columns
from plan_cutters.domain.verdicts import Verdicts
from plan_cutters.operations.candidates import Orientations
from plan_cutters.operations.indexing import Indexing
from plan_cutters.operations.moving_axes import MovingAxes
from plan_cutters.operations.passes import Paths
from plan_cutters.operations.probes import Probes
from plan_cutters.operations.seams import Seams
from plan_cutters.operations.symmetry import Symmetry
from plan_cutters.operations.timing import Problems
from plan_cutters.operations.walls import Walls
from plan_cutters.scene.preparation import Prepared

Rows = NDArray[np.int64]


@dataclass(frozen=True, slots=True, eq=False)
class Task:
    """The same for all plans of a part.

    Attributes
    ----------
    ready : Prepared
    cutters : tuple of Cutter
        Those that are compared; columns count in them.
    orientations : tuple of Orientations
        Of each setup.
    everywhere : tuple of mapping
        Of each setup, the verdicts by cutter.
    rows : (r,) int64
        Samples that are reached by one of the cutters in one of the setups.
    probes : Probes
    paths : Paths
    indexing : Indexing
    problems : Problems
    walls : Walls
    moving : MovingAxes
    seams : Seams
    symmetry : Symmetry, optional
        Under which each column stands for itself and its images; None: for itself alone.
    copies : int
        How many equal copies the samples stand for: their areas and times count so often.
    moved : (n,) bool, optional
        Samples that go with simultaneous motion whatever else serves them; None: none.
    """

    ready: Prepared
    cutters: tuple[Cutter, ...]
    orientations: tuple[Orientations, ...]
    everywhere: tuple[Mapping[Cutter, Verdicts], ...]
    rows: Rows
    probes: Probes
    paths: Paths
    indexing: Indexing
    problems: Problems
    walls: Walls
    moving: MovingAxes
    seams: Seams
    symmetry: Symmetry | None = None
    copies: int = 1
    moved: NDArray[np.bool_] | None = None

    def images(self, columns: Columns) -> Columns:
        """The columns that some stand for: each and its images, as many of each."""
        return columns if self.symmetry is None else self.symmetry.images(columns)

    def together(self, columns: Columns) -> float:
        """Seconds that the rotary axes take to come to all that columns stand for, to each once."""
        every = self.images(columns)
        return self.indexing.together(every.of(every.first))

    def table(self, rows: Rows, columns: Columns) -> NDArray[np.bool_]:
        """Where what each column stands for serves: (rows, columns)."""
        served = self.probes.table(rows, self.images(columns))
        return np.asarray(served.reshape(len(rows), len(columns), self.times).any(axis=2))

    @property
    def times(self) -> int:
        """How many columns each one stands for."""
        return 1 if self.symmetry is None else self.symmetry.order
