"""The plan of operations as it is found: operations of one cutter, setup and fixed axis each, what each sample goes with, and
what proves that there are no fewer.
"""

from dataclasses import dataclass, field
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from cad_io.arrays import Floats, Ints, Record
from plan_cutters.domain.checks import shown
from plan_cutters.domain.columns import Columns
from plan_cutters.domain.cutter import Cutter
from plan_cutters.errors import OptionError

#: Plans that may be asked for.
WHICH = ("fewest", "fastest", "both")
Mode = Literal["fixed", "simultaneous"]


def operations_of(given: Any) -> str | None:
    """One of WHICH, or None for no plan of operations.

    Raises
    ------
    OptionError
        Another word.
    """
    if given is None or given in WHICH:
        return given if given is None else str(given)
    raise OptionError(f"operations: {shown(given)} is none of {', '.join(WHICH)}")


@dataclass(frozen=True, slots=True)
class Step:
    """So many fixed orientations serve this share of the judged area, and no choice of as many serves more than `at_most`."""

    orientations: int
    share: float
    at_most: float | None


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Fewest(Record):
    """The fewest orientations found, with what proves how few there can be.

    Attributes
    ----------
    columns : Columns
        All candidates.
    chosen : (k,) int64
        Of the candidates.
    rows : (r,) int64
        Samples in the table.
    weight : (r,) int64
        Their weights, in millionths: no candidate serves samples of more than 1,000,000 together.
    at_least : int
        No choice among the candidates has fewer.
    bound, relaxed : float
        What the weights prove, and the least sum of parts of candidates.
    spacing : float
        Between candidates where the weights lie, rad.
    alone : (s,) int64
        Samples that no candidate serves.
    """

    columns: Columns
    chosen: NDArray[np.int64]
    rows: NDArray[np.int64]
    weight: NDArray[np.int64]
    at_least: int
    bound: float
    relaxed: float
    spacing: float
    alone: NDArray[np.int64]

    @property
    def proof(self) -> Literal["weights", "branch and bound", "not closed"]:
        """What proves that there are no fewer: the weights alone, a solver, or nothing yet."""
        if np.ceil(self.bound - 1e-9) >= len(self.chosen):
            return "weights"
        return "branch and bound" if self.at_least >= len(self.chosen) else "not closed"


@dataclass(frozen=True, slots=True)
class Fastest:
    """How good the fastest choice is, by some samples that stand for the area of all.

    Attributes
    ----------
    seconds, bound : float
        Of the choice, with the times of its orientations, cutters and setups; no choice among the candidates takes less.
    at_best : float
        Cutting alone, each sample with its own best axis among the candidates: simultaneous motion at its best.
    samples, candidates : int
        How many they were.
    """

    seconds: float
    bound: float
    at_best: float
    samples: int
    candidates: int


@dataclass(frozen=True, slots=True, eq=False)
class Operation:
    """One operation of a plan.

    Attributes
    ----------
    name : str
        `op1`, `op2`, ... by share, the largest first.
    mode : str
        `fixed`: one tool axis for all its contacts; `simultaneous`: each contact has its own.
    cutter : Cutter
    setup : int
        0 for the first.
    axis : (3,) float, optional
        Unit, part coordinates; None where it is simultaneous.
    angle, other_angle : (2,) float, optional
        Positions of the rotary axes, deg, and those of the other solution, where there is one.
    rows : (r,) int64
        Samples that go with it.
    only : (n,) int64
        Samples that no other operation of the plan serves.
    proved : float, optional
        Share of its area that is proved between the samples, with its axis or that of another operation of the plan.
    approaches : int, optional
        Connected pieces of the area proved with its axis, the largest, until they hold 99 % of it: inside one, any path is safe.
    """

    name: str
    mode: Mode
    cutter: Cutter
    setup: int
    axis: Floats | None
    angle: Floats | None
    other_angle: Floats | None
    rows: NDArray[np.int64]
    only: NDArray[np.int64]
    proved: float | None = None
    approaches: int | None = None


@dataclass(frozen=True, slots=True, eq=False)
class OperationPlan:
    """A plan: its operations, and the one that each sample goes with.

    Attributes
    ----------
    name : str
        `fewest`, `fastest` or `largest first`.
    operations : tuple of Operation
    label : (n,) int32
        Index into the operations, -1 for none.
    serves : (n, k) bool
        Which operations serve each sample.
    strip : (n,) float
        Width of the strip that a path cuts there, mm; nan where it is not known.
    seconds : (n,) float
        Cutting time, s; nan without a feed.
    """

    name: str
    operations: tuple[Operation, ...]
    label: Ints
    serves: NDArray[np.bool_]
    strip: Floats
    seconds: Floats


@dataclass(frozen=True, slots=True, eq=False)
class Operations:
    """What was asked for of operations, and what was found.

    Attributes
    ----------
    which : str
        One of WHICH.
    cutters : tuple of Cutter
        Those whose operations were compared; columns count in them.
    plans : tuple of OperationPlan
    fewest : Fewest
    curve : tuple of Step
    names : tuple of str
        Of the two rotary axes, or `azimuth` and `tilt`.
    probes : int
        How many times a tool was put down.
    fastest : Fastest, optional
        Where the fastest were asked for.
    """

    which: str
    cutters: tuple[Cutter, ...]
    plans: tuple[OperationPlan, ...]
    fewest: Fewest
    curve: tuple[Step, ...]
    names: tuple[str, str]
    probes: int
    fastest: Fastest | None = None
    notes: tuple[str, ...] = field(default_factory=tuple)

    def plan(self, name: str) -> OperationPlan | None:
        """The plan of a name."""
        return next((each for each in self.plans if each.name == name), None)
