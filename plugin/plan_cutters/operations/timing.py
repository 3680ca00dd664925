"""The time, or the length of path, that each sample takes with each candidate."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from cad_io.arrays import Floats, SurfaceSamples
from plan_cutters.domain.columns import Columns
from plan_cutters.domain.cutter import Cutter
from plan_cutters.operations.indexing import Indexing
from plan_cutters.operations.problem import Costs, Problem, Turning
from plan_cutters.operations.strips import strips_at
from plan_cutters.operations.walls import Walls, flat_of, on_floor

Rows = NDArray[np.int64]
#: How much farther apart samples of two faces count than those of one, in lengths of the part.
_OTHER_FACE = 10.0
#: Widths that are found at once.
_AT_ONCE = 100_000


@dataclass(frozen=True, slots=True)
class Paths:
    """How passes are laid.

    Attributes
    ----------
    scallop : float
        Height of the cusps between passes, mm.
    stepover : float
        Widest distance of passes, in diameters.
    feed : mapping, optional
        Cutter -> mm/min; None: times are not known, and lengths stand for them.
    accuracy : float
        Of the rotary axes, rad: within it of its normal an axis stands upright on a floor.
    """

    scallop: float
    stepover: float
    feed: Mapping[Cutter, float] | None
    accuracy: float


def widths(
    columns: Columns,
    rows: Rows,
    samples: SurfaceSamples,
    cutters: Sequence[Cutter],
    paths: Paths,
    where: NDArray[np.bool_] | None = None,
) -> Floats:
    """Width of a pass by the tip (rows, columns), mm, whether a column serves there or not; nan where the tool does not touch.

    With `where` (rows, columns) it is nan elsewhere, too.
    """
    result = np.full((len(rows), len(columns)), np.nan)
    wanted = np.ones(result.shape, bool) if where is None else where
    for c, cutter in enumerate(cutters):
        row, column = np.nonzero(wanted & (columns.cutter == c))
        for part in np.array_split(np.arange(len(row)), max(1, math.ceil(len(row) / _AT_ONCE))):
            i, k = row[part], column[part]
            at = rows[i]
            result[i, k] = tip_widths(cutter, samples, at, columns.axis[k], paths)[0]
    return result


def tip_widths(
    cutter: Cutter, samples: SurfaceSamples, rows: Rows, axis: Floats, paths: Paths
) -> tuple[Floats, NDArray[np.bool_]]:
    """Width of a pass by the tip at samples (m,) with axes (m, 3), mm, and where the flat part of the tip lies on a floor.

    On a floor passes are the step-over apart, as a share of the flat part: what its corner cuts beside that is not counted.
    """
    normal, curvature = samples.normal[rows], samples.curvature[rows]
    width = strips_at(cutter, normal, samples.direction_max[rows], curvature, axis, paths.scallop, paths.stepover).width
    floor = on_floor(cutter, normal, curvature, axis, paths.accuracy, paths.scallop)
    return np.where(floor, paths.stepover * flat_of(cutter), width), floor


def speed_of(paths: Paths, cutters: Sequence[Cutter], which: NDArray[np.integer]) -> Floats:
    """Feeds (m,) of cutters, by their numbers, mm/s; 1 where there is no feed."""
    if paths.feed is None:
        return np.ones(len(which))
    return np.array([paths.feed[cutter] / 60.0 for cutter in cutters])[which]


def costs_of(
    columns: Columns, width: Floats, serves: NDArray[np.bool_], area: Floats, cutters: Sequence[Cutter], paths: Paths
) -> Floats:
    """Seconds, or mm of path without a feed, of each sample with each column; infinite where the column does not serve it."""
    speed = speed_of(paths, cutters, columns.cutter)
    with np.errstate(divide="ignore", invalid="ignore"):
        costs = area[:, None] / (width * speed)
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


class Problems:
    """Say what samples cost with candidates, as both become more: widths that were found once are kept.

    Parameters
    ----------
    samples : SurfaceSamples
    cutters : sequence of Cutter
    paths : Paths
    indexing : Indexing
    walls : Walls
    """

    def __init__(
        self, samples: SurfaceSamples, cutters: Sequence[Cutter], paths: Paths, indexing: Indexing, walls: Walls
    ) -> None:
        self._samples, self._cutters, self._paths, self._indexing = samples, cutters, paths, indexing
        self._walls = walls
        self._rows: Rows = np.zeros(0, np.int64)
        self._active: Rows = np.zeros(0, np.int64)
        self._width: Floats = np.zeros((0, 0))
        self._known: NDArray[np.bool_] = np.zeros((0, 0), bool)

    def of(self, columns: Columns, active: Rows, table: NDArray[np.bool_], rows: Rows, area: Floats, costs: Costs) -> Problem:
        """Say what some samples, weighted by area, cost with columns.

        Parameters
        ----------
        columns : Columns
        active : (m,) int64
            Their numbers, ascending: what had one keeps it.
        table : (r, m) bool
            Where they serve.
        rows : (r,) int64
            Those of the time before come first.
        area : (r,) float
            That each of `rows` stands for, mm2.
        costs : Costs
        """
        width, known = np.full(table.shape, np.nan), np.zeros(table.shape, bool)
        if np.array_equal(rows[: len(self._rows)], self._rows) and np.isin(self._active, active).all():
            there = np.searchsorted(active, self._active)
            width[: len(self._rows), there], known[: len(self._rows), there] = self._width, self._known
        new = table & ~known
        result = widths(columns, rows, self._samples, self._cutters, self._paths, new)
        result = np.fmax(result, self._walls.strips(columns, rows, new))
        width[new] = result[new]
        self._rows, self._active, self._width, self._known = rows, active, width, known | new
        cost = costs_of(columns, width, table, area, self._cutters, self._paths)
        # What is served and nowhere timed is served by whatever serves it, in no time that is known.
        untimed = ~np.isfinite(cost).any(axis=1)
        cost[untimed] = np.where(table[untimed], 0.0, np.inf)
        turning = None
        if self._indexing.rate is not None:
            turning = Turning(lambda chosen: self._indexing.together(columns.of(chosen)), self._indexing.from_zero(columns))
        return Problem(cost, columns.cutter, columns.setup, costs, turning)
