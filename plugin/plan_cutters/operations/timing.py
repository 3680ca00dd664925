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
from plan_cutters.operations.fastest import Costs, Problem, Turning
from plan_cutters.operations.indexing import Indexing
from plan_cutters.operations.strips import strips_at

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
    """

    scallop: float
    stepover: float
    feed: Mapping[Cutter, float] | None


def widths(
    columns: Columns, rows: Rows, samples: SurfaceSamples, cutters: Sequence[Cutter], paths: Paths,
    where: NDArray[np.bool_] | None = None,
) -> Floats:  # fmt: skip
    """Width of a pass (rows, columns), mm, whether a column serves there or not; nan where the tool does not touch.

    With `where` (rows, columns) it is nan elsewhere, too.
    """
    found = np.full((len(rows), len(columns)), np.nan)
    asked = np.ones(found.shape, bool) if where is None else where
    for c, cutter in enumerate(cutters):
        row, column = np.nonzero(asked & (columns.cutter == c))
        for part in np.array_split(np.arange(len(row)), max(1, math.ceil(len(row) / _AT_ONCE))):
            i, k = row[part], column[part]
            at = rows[i]
            found[i, k] = strips_at(
                cutter, samples.normal[at], samples.direction_max[at], samples.curvature[at], columns.axis[k], paths.scallop,
                paths.stepover,
            ).width  # fmt: skip
    return found


def costs_of(
    columns: Columns, width: Floats, serves: NDArray[np.bool_], area: Floats, cutters: Sequence[Cutter], paths: Paths
) -> Floats:
    """Seconds, or mm of path without a feed, of each sample with each column; infinite where the column does not serve it."""
    speed = np.ones(len(columns))
    if paths.feed is not None:
        speed = np.array([paths.feed[cutters[c]] / 60.0 for c in columns.cutter.tolist()])
    with np.errstate(divide="ignore", invalid="ignore"):
        found = area[:, None] / (width * speed)
    return np.where(serves & np.isfinite(found), found, np.inf)


def shared_area(samples: SurfaceSamples, all_rows: Rows, rows: Rows) -> Floats:
    """The area (r,) that some samples stand for when each of all gives its own to the nearest of them, on its face if it can."""
    size = float(np.linalg.norm(np.ptp(samples.point[all_rows], axis=0))) or 1.0
    place = np.column_stack([samples.point, samples.face * (_OTHER_FACE * size)])
    nearest = cKDTree(place[rows]).query(place[all_rows])[1]
    return np.bincount(nearest, np.nan_to_num(samples.area[all_rows]), len(rows)).astype(float)


def problem_of(
    columns: Columns, table: NDArray[np.bool_], rows: Rows, area: Floats, samples: SurfaceSamples, cutters: Sequence[Cutter],
    paths: Paths, costs: Costs, indexing: Indexing,
) -> Problem:  # fmt: skip
    """Say what some samples, weighted by area, cost with columns.

    Parameters
    ----------
    columns : Columns
    table : (r, m) bool
        Where they serve.
    rows : (r,) int64
    area : (r,) float
        That each of `rows` stands for, mm2.
    samples, cutters, paths, costs, indexing
    """
    width = widths(columns, rows, samples, cutters, paths, table)
    turning = None
    if indexing.rate is not None:
        turning = Turning(lambda chosen: indexing.together(columns.of(chosen)), indexing.from_zero(columns))
    return Problem(costs_of(columns, width, table, area, cutters, paths), columns.cutter, columns.setup, costs, turning)
