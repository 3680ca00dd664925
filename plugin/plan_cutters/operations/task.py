"""One task for all plans of operations of a part: samples, cutters, setups, what samples cost with candidates, and the same for
fewer samples, by which choices are compared.
"""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from cad_io.arrays import Floats, SurfaceSamples
from plan_cutters.domain.cutter import Cutter
from plan_cutters.domain.operations import Columns, columns_of
from plan_cutters.domain.preference import by_radius
from plan_cutters.domain.verdicts import Verdicts
from plan_cutters.operations.fastest import Costs, Problem
from plan_cutters.operations.labels import Seams
from plan_cutters.operations.moving_axes import MovingAxes
from plan_cutters.operations.orientations import Indexing, Orientations
from plan_cutters.operations.passes import Paths, cut_by_tip
from plan_cutters.operations.probes import Probes
from plan_cutters.operations.symmetry import Symmetry
from plan_cutters.operations.walls import Walls
from plan_cutters.scene.preparation import Prepared

Rows = NDArray[np.int64]
#: How much farther apart samples of two faces count than those of one, in lengths of the part.
_OTHER_FACE = 10.0
#: Paces that are found at once.
_AT_ONCE = 100_000


def paces(
    columns: Columns, rows: Rows, samples: SurfaceSamples, cutters: Sequence[Cutter], paths: Paths, where: NDArray[np.bool_]
) -> Floats:
    """Find what a mm of path by the tip cuts (rows, columns), mm2; nan where it does not touch, or `where` is not set."""
    result = np.full(where.shape, np.nan)
    for c, cutter in enumerate(cutters):
        row, column = np.nonzero(where & (columns.cutter == c))
        for part in np.array_split(np.arange(len(row)), max(1, math.ceil(len(row) / _AT_ONCE))):
            i, k = row[part], column[part]
            at = rows[i]
            result[i, k] = cut_by_tip(cutter, samples, at, columns.axis[k], paths).pace(paths, cutter)
    return result


def costs_of(
    columns: Columns, pace: Floats, serves: NDArray[np.bool_], area: Floats, cutters: Sequence[Cutter], paths: Paths
) -> Floats:
    """Seconds with links, or mm of path without a feed, of samples with columns; infinite where one does not serve a sample."""
    speed = paths.speeds(cutters)[columns.cutter]
    with np.errstate(divide="ignore", invalid="ignore"):
        costs = area[:, None] / (pace * speed)
    return np.where(serves & np.isfinite(costs), costs, np.inf)


def shared_area(samples: SurfaceSamples, all_rows: Rows, rows: Rows) -> Floats:
    """The area (r,) that some samples stand for when each of all gives its own to the nearest of them, on its face if it can."""
    if not len(rows):
        return np.zeros(0)
    return np.bincount(nearest(samples, all_rows, rows), np.nan_to_num(samples.area[all_rows]), len(rows)).astype(float)


def nearest(samples: SurfaceSamples, all_rows: Rows, rows: Rows) -> NDArray[np.intp]:
    """Which of some samples (r,) is the nearest to each of all (m,), on its face if it can."""
    size = float(np.linalg.norm(np.ptp(samples.point[all_rows], axis=0))) or 1.0
    place = np.column_stack([samples.point, samples.face * (_OTHER_FACE * size)])
    return np.asarray(cKDTree(place[rows]).query(place[all_rows])[1])


@dataclass(slots=True, eq=False)
class KnownPaces:
    """Areas cut by a mm of path (r, m) of samples with candidates, as far as they were found, by their numbers."""

    rows: Rows = field(default_factory=lambda: np.zeros(0, np.int64))
    active: Rows = field(default_factory=lambda: np.zeros(0, np.int64))
    pace: Floats = field(default_factory=lambda: np.zeros((0, 0)))
    known: NDArray[np.bool_] = field(default_factory=lambda: np.zeros((0, 0), bool))


@dataclass(frozen=True, slots=True, eq=False)
class Task:
    """The same for all plans of a part.

    `cutters`: those that are compared; columns count in them.
    `orientations`: of each setup.
    `everywhere`: of each setup, the verdicts by cutter.
    `rows` (r,) int64: samples that are reached by one of the cutters in one of the setups.
    `flowing` (f,) int64: numbers of the faces that the machine cuts while its axes turn, ascending.
    `symmetry`: under which each column stands for itself and its images; None: for itself alone.
    `copies`: how many equal copies the samples stand for: their areas and times count so often.
    `moved` (n,) bool: samples that go with simultaneous motion whatever else serves them; None: none.
    """

    ready: Prepared
    cutters: tuple[Cutter, ...]
    orientations: tuple[Orientations, ...]
    everywhere: tuple[Mapping[Cutter, Verdicts], ...]
    rows: Rows
    probes: Probes
    paths: Paths
    indexing: Indexing
    walls: Walls
    moving: MovingAxes
    seams: Seams
    flowing: Rows
    symmetry: Symmetry | None = None
    copies: int = 1
    moved: NDArray[np.bool_] | None = None
    known: KnownPaces = field(default_factory=KnownPaces)

    def probed_by(self, probes: Probes, walls: Walls, **changes: Any) -> "Task":
        """The same with other probes and walls: of paces nothing is known."""
        return replace(self, probes=probes, walls=walls, known=KnownPaces(), **changes)

    def problem(
        self, columns: Columns, active: Rows, table: NDArray[np.bool_], rows: Rows, area: Floats, costs: Costs
    ) -> Problem:
        """Say what some samples, weighted by area, cost with columns, as both become more: paces found once are kept.

        `active` (m,) int64: their numbers, ascending: what had one keeps it. `table` (r, m) bool: where they serve. `rows` (r,)
        int64: those of the time before come first. `area` (r,) float: that each of `rows` stands for, mm2.
        """
        pace, known, before = np.full(table.shape, np.nan), np.zeros(table.shape, bool), self.known
        if np.array_equal(rows[: len(before.rows)], before.rows) and np.isin(before.active, active).all():
            there = np.searchsorted(active, before.active)
            pace[: len(before.rows), there], known[: len(before.rows), there] = before.pace, before.known
        new = table & ~known
        pace[new] = self.paces(columns, rows, new)[new]
        before.rows, before.active, before.pace, before.known = rows, active, pace, known | new
        cost = costs_of(columns, pace, table, area, self.cutters, self.paths)
        # What is served and nowhere timed is served by whatever serves it, in no time that is known.
        untimed = ~np.isfinite(cost).any(axis=1)
        cost[untimed] = np.where(table[untimed], 0.0, np.inf)
        return Problem(cost, columns.cutter, columns.setup, costs, self.indexing.turning(columns))

    def paces(self, columns: Columns, rows: Rows, where: NDArray[np.bool_]) -> Floats:
        """Areas (r, k), mm2, that a mm of path cuts by the tip or along a wall, of columns at samples; nan outside `where`."""
        by_tip = paces(columns, rows, self.ready.samples, self.cutters, self.paths, where)
        return np.fmax(by_tip, self.walls.paces(columns, rows, where))

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
    def no_columns(self) -> Columns:
        """None of the columns that there may be."""
        return columns_of(np.zeros((0, 3)), np.zeros((0, len(self.orientations[0].names))))

    @property
    def moves(self) -> bool:
        """Whether an axis can turn the tool while it cuts."""
        return self.orientations[0].turning > 0 and not self.ready.conditions.machine.indexed

    def costs(self, operation: float = 0.0) -> Costs:
        """Give what operations, changes of cutters and setups cost."""
        options, in_turn = self.ready.options, by_radius(self.cutters)
        return Costs(operation, options.change_time, options.setup_time, tuple(in_turn.index(each) for each in self.cutters))

    @property
    def may_move(self) -> bool:
        """Whether simultaneous motion may take the place of orientations: axes do not lock, no number of these was requested."""
        options = self.ready.options
        return self.moves and options.index_step is None and options.most_operations is None

    @property
    def times(self) -> int:
        """How many columns each one stands for."""
        return 1 if self.symmetry is None else self.symmetry.order


#: Samples at which choices are compared, at most about.
SOME = 2500


def thinned(task: Task, most: int = SOME) -> Task:
    """The same task for some of its samples, evenly taken, each with the area of those that it stands for.

    `most`: about how many samples; where the task has no more, it is the task itself. Its plans reckon what the plans of
    all samples take; where it is served, others need not be.
    """
    every = len(task.rows) // most
    return task if every < 2 else at_some(task, task.rows[::every])


def at_some(task: Task, rows: NDArray[np.int64]) -> Task:
    """The same task for some of its samples (r,), each with the area of those that it stands for."""
    ready = task.ready
    area = np.zeros(len(ready.samples))
    area[rows] = shared_area(ready.samples, task.rows, rows)
    samples, stands_for = replace(ready.samples, area=area), np.full(len(area), -1, np.int64)
    stands_for[task.rows] = rows[nearest(ready.samples, task.rows, rows)] if len(rows) else -1
    probes = Probes(samples, task.cutters, ready.setups, task.probes.outside, task.probes.barred, task.everywhere)
    return task.probed_by(
        probes, task.walls.of_probes(probes), ready=replace(ready, samples=samples), rows=rows, seams=task.seams.among(stands_for)
    )
