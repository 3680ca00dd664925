"""Answers and the plan of operations follow the verdicts: here they are, with the samples of each operation."""

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from cad_io.arrays import Floats, Ints
from plan_cutters.domain.answers import RadiusMap
from plan_cutters.domain.cutter import Cutter
from plan_cutters.domain.operations import Columns
from plan_cutters.domain.own_process import Mode, OwnResult
from plan_cutters.domain.stick_out import StickOut
from plan_cutters.plan_file.answers import LeastSetEntry, MendEntry, StepEntry
from plan_cutters.plan_file.operations import OperationsEntry


@dataclass(frozen=True, slots=True, eq=False)
class Operation:
    """One operation of a plan, with its samples."""

    name: str  #: `op1`, `op2`, ... by share, the largest first.
    mode: Mode  #: `fixed`: one tool axis for all its contacts; `simultaneous`: each contact has its own.
    cutter: Cutter
    setup: int  #: 0 for the first.
    axis: Floats | None  #: (3,) float: unit, part coordinates; None where it is simultaneous.
    angle: Floats | None  #: (k,) float: positions of the rotary axes, deg, and those of the other solution, where there is one.
    other_angle: Floats | None
    rows: NDArray[np.int64]  #: (r,) int64: samples that go with it.
    step: int = 0  #: Its number in the planner's own process; 0: it was planned.
    orbit: int = -1  #: Of a plan of repeated orientations, the same number for all images of one; -1: it is not repeated.
    #: ((n, 3) float, (n,) int32): of a simultaneous one: the unit tool axis of the proposed field at each sample, nan where
    #: there is none; and the connected proved piece about it, the largest first, -1: nothing is proved there.
    moving: tuple[Floats, Ints] | None = None
    #: Of its entry in the plan file, by their names, as far as they are known by now.
    fields: Mapping[str, Any] = field(default_factory=dict)

    def with_fields(self, moving: tuple[Floats, Ints] | None = None, **fields: Any) -> "Operation":
        """The operation with more fields of its entry."""
        return replace(self, moving=moving or self.moving, fields={**self.fields, **fields})


@dataclass(frozen=True, slots=True, eq=False)
class OperationPlan:
    """A plan in arrays: its operations, and the one that each sample goes with."""

    name: str  #: `fewest` or `fastest`; `process`: the planner's own steps, and those planned behind them.
    operations: tuple[Operation, ...]
    label: Ints  #: (n,) int32: index into the operations, -1 for none.
    serves: NDArray[np.bool_]  #: (n, k) bool: which operations serve each sample.
    strip: Floats  #: (n,) float: width of the strip that a path cuts there, mm; nan where it is not known.
    length: Floats  #: (n,) float: path of the tool's centre, mm.
    seconds: Floats  #: (n,) float: cutting time, s: that of the path at the feed; nan without a feed.
    #: (n,) int32: number of the connected samples of one operation that each belongs to, -1 for none: from 0 by operation, the
    #: largest first.
    region: Ints
    #: (n, 3) float: unit direction in which the tool leans, across its contact's normal; where it stands upright, the side of
    #: its bottom that touches. nan where there is no operation.
    lean: Floats
    strategy: NDArray[np.uint8]  #: (n,) uint8: how each sample is cut, an index into STRATEGIES; 0 where there is no operation.
    #: (n, 3) float: where the tool touches while it cuts a sample of a wall, mm: at the lower end of its strip, where its flutes
    #: begin to be straight. nan where it touches at the sample itself.
    contact: Floats
    link: Floats  #: (n,) float: seconds of links between passes, as the share of each sample; nan without a feed.
    #: Seconds of all cutting, nan where one of them is not known; of all links, to the pieces of operations too; and of all
    #: orientations, of changes of cutters and of setups.
    cutting: float
    links: float
    other: float
    short: NDArray[np.int64]  #: (m,) int64: samples that are left because a step for them would be hardly any.
    marks: float = 0.0  #: Seconds that borders on free-form faces count where plans are compared (`--border-cost`).

    @property
    def total(self) -> float:
        """Seconds of all that is counted; nan where they are not known."""
        return self.cutting + self.links + self.other

    @property
    def price(self) -> float:
        """Seconds by which plans are compared: the total, and what borders on free-form faces count; infinite if not known."""
        return self.total + self.marks if math.isfinite(self.total) else math.inf

    @property
    def alone(self) -> NDArray[np.bool_]:
        """Samples (n,) that no other operation serves than the one that they go with."""
        return (self.label >= 0) & (self.serves.sum(axis=1) == 1)

    @property
    def orientations(self) -> int:
        """How many fixed orientations there are, those that are repeated once."""
        fixed = [each.orbit for each in self.operations if each.mode == "fixed"]
        return len({orbit for orbit in fixed if orbit >= 0}) + sum(orbit < 0 for orbit in fixed)

    @property
    def moves(self) -> bool:
        """Whether some of it is simultaneous motion."""
        return any(each.mode == "simultaneous" for each in self.operations)

    def like(self, other: "OperationPlan") -> bool:
        """Whether each sample goes with the same cutter, setup and axis in another plan."""
        mine, others = (
            [(each.cutter, each.setup, None if each.axis is None else tuple(each.axis.tolist())) for each in plan.operations]
            for plan in (self, other)
        )
        return mine == others and np.array_equal(self.label, other.label)


@dataclass(frozen=True, slots=True, eq=False)
class Operations:
    """The plan of operations as the plan file has it, with the arrays behind it."""

    entry: OperationsEntry
    cutters: tuple[Cutter, ...]  #: Those whose operations were compared; columns count in them.
    plans: tuple[OperationPlan, ...]  #: In the order of `entry.plans`.
    candidates: Columns  #: That the proof of the fewest is about; none beside a process of the planner's own.
    chosen: NDArray[np.int64]  #: (k,) int64: of the candidates.
    own: tuple[OwnResult, ...] = ()  #: What the planner's own steps do, in their order; empty where all steps were planned.


@dataclass(frozen=True, slots=True, eq=False)
class Step:
    """A step is a thing to do next: as the plan file has it, and what stands behind it."""

    entry: StepEntry
    cutters: tuple[Cutter, ...]  #: That do it together, the one that is mended, or what becomes of it, first.
    freed: NDArray[np.int64]  #: (m,) int64: the samples that it frees.


@dataclass(frozen=True, slots=True, eq=False)
class Advice:
    """Advice names what to do next with a cutter, as the plan file has it; its steps."""

    entry: MendEntry
    steps: tuple[Step, ...] = ()  #: In the order of those of `entry`.


class Run(NamedTuple):
    """A cutter in a setup, the first of which is 0."""

    cutter: Cutter
    number: int


@dataclass(frozen=True, slots=True)
class LeastSet:
    """The fewest runs; of sets of as many that in fewer setups, then that of the more wanted cutters."""

    entry: LeastSetEntry  #: As the plan file has them.
    runs: tuple[Run, ...]  #: In the order of those of `entry`; none where nothing is reached.


@dataclass(frozen=True, slots=True, eq=False)
class Answers:
    """The answers that are computed after the plan, where the user asked for them."""

    stick_outs: Mapping[str, StickOut] = field(default_factory=dict)  #: Cutter id -> StickOut.
    radius_maps: tuple[RadiusMap, ...] = ()  #: For flat ends, and for ball ends.
    #: Cutter id -> Advice, of those that do not finish the part, or of the nearest of them.
    mends: Mapping[str, Advice] = field(default_factory=dict)
    not_mended: tuple[str, ...] = ()  #: Ids of the others of them, where that was asked.
    #: The fewest of the given cutters and setups that reach all that any of them reaches; None where there is but one of each.
    least_set: LeastSet | None = None
    operations: Operations | None = None  #: The plan of operations.
