"""Answers and the plan of operations follow the verdicts: here they are, with the samples of each operation."""

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from cad_io.arrays import Floats, Ints
from plan_cutters.domain.answers import Advice, LeastSet, RadiusMap
from plan_cutters.domain.cutter import Cutter
from plan_cutters.domain.operations import Columns
from plan_cutters.domain.own_process import Mode, OwnResult
from plan_cutters.domain.stick_out import StickOut
from plan_cutters.plan_file.operations import OperationsEntry


@dataclass(frozen=True, slots=True, eq=False)
class Operation:
    """One operation of a plan, with its samples.

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
    step : int
        Its number in the planner's own process; 0: it was planned.
    orbit : int
        Of a plan of repeated orientations, the same number for all images of one; -1: it is not repeated.
    moving : ((n, 3) float, (n,) int32), optional
        Of a simultaneous one: the unit tool axis of the proposed field at each sample, nan where there is none; and the connected
        proved piece about it, the largest first, -1: nothing is proved there.
    fields : mapping
        Of its entry in the plan file, by their names, as far as they are known by now.
    """

    name: str
    mode: Mode
    cutter: Cutter
    setup: int
    axis: Floats | None
    angle: Floats | None
    other_angle: Floats | None
    rows: NDArray[np.int64]
    step: int = 0
    orbit: int = -1
    moving: tuple[Floats, Ints] | None = None
    fields: Mapping[str, Any] = field(default_factory=dict)

    def with_fields(self, moving: tuple[Floats, Ints] | None = None, **fields: Any) -> "Operation":
        """The operation with more fields of its entry."""
        return replace(self, moving=moving or self.moving, fields={**self.fields, **fields})


@dataclass(frozen=True, slots=True, eq=False)
class OperationPlan:
    """A plan in arrays: its operations, and the one that each sample goes with.

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
    length : (n,) float
        Path of the tool's centre, mm.
    seconds : (n,) float
        Cutting time, s: that of the path at the feed; nan without a feed.
    region : (n,) int32
        Number of the connected samples of one operation that each belongs to, -1 for none: from 0 by operation, the largest
        first.
    lean : (n, 3) float
        Unit direction in which the tool leans, across its contact's normal; where it stands upright, the side of its bottom that
        touches. nan where there is no operation.
    strategy : (n,) uint8
        How each sample is cut, an index into STRATEGIES; 0 where there is no operation.
    contact : (n, 3) float
        Where the tool touches while it cuts a sample of a wall, mm: at the lower end of its strip, where its flutes begin to be
        straight. nan where it touches at the sample itself.
    link : (n,) float
        Seconds of links between passes, as the share of each sample; nan without a feed.
    cutting, links, other : float
        Seconds of all cutting, nan where one of them is not known; of all links, to the pieces of operations too; and of all
        orientations, of changes of cutters and of setups.
    short : (m,) int64
        Samples that are left because a step for them would be hardly any.
    marks : float
        Seconds that borders on free-form faces count where plans are compared (`--border-cost`).
    """

    name: str
    operations: tuple[Operation, ...]
    label: Ints
    serves: NDArray[np.bool_]
    strip: Floats
    length: Floats
    seconds: Floats
    region: Ints
    lean: Floats
    strategy: NDArray[np.uint8]
    contact: Floats
    link: Floats
    cutting: float
    links: float
    other: float
    short: NDArray[np.int64]
    marks: float = 0.0

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
    """The plan of operations as the plan file has it, with the arrays behind it.

    Attributes
    ----------
    entry : OperationsEntry
    cutters : tuple of Cutter
        Those whose operations were compared; columns count in them.
    plans : tuple of OperationPlan
        In the order of `entry.plans`.
    candidates : Columns
        That the proof of the fewest is about; none beside a process of the planner's own.
    chosen : (k,) int64
        Of the candidates.
    own : tuple of OwnResult
        What the planner's own steps do, in their order; empty where all steps were planned.
    """

    entry: OperationsEntry
    cutters: tuple[Cutter, ...]
    plans: tuple[OperationPlan, ...]
    candidates: Columns
    chosen: NDArray[np.int64]
    own: tuple[OwnResult, ...] = ()


@dataclass(frozen=True, slots=True, eq=False)
class Answers:
    """The answers that are computed after the plan, where the user asked for them.

    Attributes
    ----------
    stick_outs : mapping
        Cutter id -> StickOut.
    radius_maps : tuple of RadiusMap
        For flat ends, and for ball ends.
    mends : mapping
        Cutter id -> Advice, of those that do not finish the part, or of the nearest of them.
    not_mended : tuple of str
        Ids of the others of them, where that was asked.
    least_set : LeastSet, optional
        The fewest of the given cutters and setups that reach all that any of them reaches; None where there is but one of each.
    operations : Operations, optional
        The plan of operations.
    """

    stick_outs: Mapping[str, StickOut] = field(default_factory=dict)
    radius_maps: tuple[RadiusMap, ...] = ()
    mends: Mapping[str, Advice] = field(default_factory=dict)
    not_mended: tuple[str, ...] = ()
    least_set: LeastSet | None = None
    operations: Operations | None = None
