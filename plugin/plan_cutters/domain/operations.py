"""The plan of operations as it is found: operations of one cutter, setup and fixed axis each, what each sample goes with, and
what proves that there are no fewer.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from cad_io.arrays import Floats, Ints, Record
from plan_cutters.domain.checks import shown
from plan_cutters.domain.columns import Columns
from plan_cutters.domain.cutter import Cutter
from plan_cutters.domain.own_process import Mode
from plan_cutters.domain.own_results import OwnResult
from plan_cutters.domain.turning import Turning
from plan_cutters.errors import OptionError

#: Plans that may be requested.
WHICH = ("fewest", "fastest", "both")
Strategy = Literal["point", "floor", "wall", "mixed"]
#: How a sample is cut, in the numbers of `OperationPlan.strategy`.
STRATEGIES: tuple[Strategy, ...] = ("point", "floor", "wall")
#: A strategy by which so much of an operation's area is cut is that of the operation, as a share.
_NEARLY_ALL = 0.95
#: Another orientation takes this, s, where no time was given and the machine does not say how fast its rotary axes turn.
INDEX_TIME = 5.0
IndexFrom = Literal["rates", "given", "assumed"]


def operations_of(value: Any) -> str | None:
    """One of WHICH, or None for no plan of operations; `all` is `both`, as other options have an `all`.

    Raises
    ------
    OptionError
        Another word.
    """
    if value is None or value in WHICH:
        return value if value is None else str(value)
    if value == "all":
        return "both"
    raise OptionError(f"operations: {shown(value)} is none of {', '.join(WHICH)}")


def strategy_of(number: NDArray[np.uint8], area: Floats) -> Strategy:
    """The strategy of an operation whose samples (n,) are cut by some, numbers in STRATEGIES, and stand for some areas.

    >>> strategy_of(np.array([2, 2, 0], np.uint8), np.array([60.0, 39.0, 1.0]))
    'wall'
    >>> strategy_of(np.array([2, 1], np.uint8), np.ones(2)), strategy_of(np.zeros(0, np.uint8), np.zeros(0))
    ('mixed', 'point')
    """
    size = np.bincount(number, area, len(STRATEGIES))
    if not len(number):
        return "point"
    return STRATEGIES[int(size.argmax())] if size.max() >= _NEARLY_ALL * size.sum() else "mixed"


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
    samples : int
        How many are reached.
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
    samples: int

    @property
    def proof(self) -> Literal["weights", "branch and bound", "not closed"]:
        """Name the proof that there are no fewer: the weights alone, a solver, or none yet."""
        if np.ceil(self.bound - 1e-9) >= len(self.chosen):
            return "weights"
        return "branch and bound" if self.at_least >= len(self.chosen) else "not closed"


@dataclass(frozen=True, slots=True)
class Fastest:
    """How good the fastest plan is, against a bound by some samples that stand for the area of all.

    Attributes
    ----------
    seconds : float
        Of the plan, with the times of its orientations, cutters and setups; nan where a width is not known.
    bound : float
        No choice among the candidates takes less, counted in the same way, by these samples.
    at_best : float
        Cutting alone, each sample with its own best axis among the candidates: simultaneous motion at its best.
    area : float
        That the samples stand for, mm2.
    samples, candidates : int
        How many they were.
    """

    seconds: float
    bound: float
    at_best: float
    area: float
    samples: int
    candidates: int

    @property
    def gap(self) -> float:
        """How far the plan is above the best of the candidates at most, as a share of the bound.

        Simultaneous motion, which is no candidate, may bring a plan below the bound: then it is 0.
        """
        return max(0.0, self.seconds / self.bound - 1.0) if self.bound > 0.0 else 0.0


@dataclass(frozen=True, slots=True, eq=False)
class Worth:
    """A cutter is worth this beside the others that were compared.

    Attributes
    ----------
    cutter : Cutter
    only : (n,) int64
        Samples that none of the others reaches.
    saves : float, optional
        Seconds by which the fastest plan found with it is below the fastest one without it, before its own change; None where
        no plan without it was found.
    change : float
        Seconds that its change costs: 0 where it is the only one then.
    """

    cutter: Cutter
    only: NDArray[np.int64]
    saves: float | None
    change: float


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
        Share of its area that is proved between the samples, with its axis or that of another operation of the plan; of a
        simultaneous one, with the field of axes in `turning`.
    approaches : int, optional
        Connected pieces of the area proved with its axis, or its field, the largest, until they hold 99 % of it: inside one, any
        path is safe.
    turning : Turning, optional
        Of a simultaneous one.
    clearance : float, optional
        Least clearance at its samples, mm, of what does not cut; None where nothing is proved.
    strategy : str
        `floor`: the flat part of the tip lies on the face; `wall`: the flutes lie along it; `point`: the tool touches in a point;
        `mixed`: several of them.
    step : int
        Its number in the planner's own process; 0: it was planned.
    orbit : int
        Of a plan of repeated orientations, the same number for all images of one; -1: it is not repeated.
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
    clearance: float | None = None
    strategy: Strategy = "point"
    turning: Turning | None = None
    step: int = 0
    orbit: int = -1


@dataclass(frozen=True, slots=True, eq=False)
class Workplane:
    """The tilted plane of an operation with a fixed axis, as a control turns it to.

    Attributes
    ----------
    origin, x, z : (3,) float
        Part coordinates: the zero of the setup, or of the part where that is not known; the machine's X turned with the tool
        axis; the tool axis.
    index : float
        Time that it takes to come there, s.
    """

    origin: Floats
    x: Floats
    z: Floats
    index: float


@dataclass(frozen=True, slots=True, eq=False)
class OperationPlan:
    """A plan: its operations, and the one that each sample goes with.

    Attributes
    ----------
    name : str
        `fewest` or `fastest`; `process`: the planner's own steps, and those planned behind them.
    operations : tuple of Operation
    label : (n,) int32
        Index into the operations, -1 for none.
    serves : (n, k) bool
        Which operations serve each sample.
    strip : (n,) float
        Width of the strip that a path cuts there, mm; nan where it is not known.
    seconds : (n,) float
        Cutting time, s; nan without a feed.
    region : (n,) int32
        Number of the connected samples of one operation that each belongs to, -1 for none: from 0 by operation, the largest
        first.
    planes : tuple of Workplane or None
        Of each operation; None where it is simultaneous.
    lean : (n, 3) float
        Unit direction in which the tool leans, across its contact's normal; where it stands upright, the side of its bottom that
        touches. nan where there is no operation.
    strategy : (n,) uint8
        How each sample is cut, an index into STRATEGIES; 0 where there is no operation.
    contact : (n, 3) float
        Where the tool touches while it cuts a sample of a wall, mm: at the lower end of its strip, where its flutes begin to be
        straight. nan where it touches at the sample itself.
    cutting, other : float
        Seconds of all cutting, nan where one of them is not known; and of all orientations, of changes of cutters and of setups.
    """

    name: str
    operations: tuple[Operation, ...]
    label: Ints
    serves: NDArray[np.bool_]
    strip: Floats
    seconds: Floats
    region: Ints
    planes: tuple[Workplane | None, ...]
    lean: Floats
    strategy: NDArray[np.uint8]
    contact: Floats
    cutting: float
    other: float

    @property
    def total(self) -> float:
        """Seconds of all that is counted; nan where they are not known."""
        return self.cutting + self.other

    @property
    def orientations(self) -> int:
        """How many fixed orientations there are, those that are repeated once."""
        fixed = [each.orbit for each in self.operations if each.mode == "fixed"]
        return len({orbit for orbit in fixed if orbit >= 0}) + sum(orbit < 0 for orbit in fixed)

    def like(self, other: "OperationPlan") -> bool:
        """Whether each sample goes with the same cutter, setup and axis in another plan."""
        mine, others = (
            [(each.cutter, each.setup, None if each.axis is None else tuple(each.axis.tolist())) for each in plan.operations]
            for plan in (self, other)
        )
        return mine == others and np.array_equal(self.label, other.label)


@dataclass(frozen=True, slots=True, eq=False)
class Operations:
    """The plans of operations that were requested, with what proves and bounds them.

    Attributes
    ----------
    which : str
        One of WHICH.
    cutters : tuple of Cutter
        Those whose operations were compared; columns count in them.
    plans : tuple of OperationPlan
    fewest : Fewest, optional
        None beside a process of the planner's own.
    names : tuple of str
        Of the two rotary axes, or `azimuth` and `tilt`.
    probes : int
        How many times a tool was put down.
    feed : mapping, optional
        mm/min; None: times are not known.
    fastest : Fastest, optional
        Where the fastest were requested.
    worth : tuple of Worth
        Of each cutter, the largest first, where the fastest were requested and several were compared.
    index_from : str
        What the times between orientations follow from: the rates of the rotary axes, what was given, or what is assumed.
    own : tuple of OwnResult
        What the planner's own steps do, in their order; empty where all steps were planned.
    """

    which: str
    cutters: tuple[Cutter, ...]
    plans: tuple[OperationPlan, ...]
    fewest: Fewest | None
    names: tuple[str, str]
    probes: int
    feed: Mapping[Cutter, float] | None
    fastest: Fastest | None = None
    worth: tuple[Worth, ...] = ()
    notes: tuple[str, ...] = field(default_factory=tuple)
    index_from: IndexFrom = "assumed"
    own: tuple[OwnResult, ...] = ()

    def plan(self, name: str) -> OperationPlan | None:
        """The plan of a name."""
        return next((each for each in self.plans if each.name == name), None)
