"""The least-time choice of operations: what each sample costs with each candidate, the choice, and what it is compared with."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from cad_io.arrays import Floats, SurfaceSamples
from plan_cutters.domain.columns import Columns
from plan_cutters.domain.cutter import Cutter
from plan_cutters.operations.fastest import Costs, Location, Problem, fastest
from plan_cutters.operations.strips import strips

Rows = NDArray[np.int64]
#: How much farther apart samples of two faces count than those of one, in lengths of the part.
_OTHER_FACE = 10.0


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


def widths(columns: Columns, rows: Rows, samples: SurfaceSamples, cutters: Sequence[Cutter], paths: Paths) -> Floats:
    """Width of a pass (rows, columns), mm, whether a column serves there or not; nan where the tool does not touch."""
    some = samples_at(samples, rows)
    found = np.empty((len(rows), len(columns)))
    for k in range(len(columns)):
        axis = np.broadcast_to(columns.axis[k], (len(rows), 3))
        found[:, k] = strips(cutters[columns.cutter[k]], some, axis, paths.scallop, paths.stepover).width
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


def samples_at(samples: SurfaceSamples, rows: Rows) -> SurfaceSamples:
    """Some of the samples, without their grids and neighbours."""
    names = ("point", "normal", "direction_max", "curvature", "uv", "face", "area", "unjudged")
    own = {name: getattr(samples, name)[rows] for name in names}
    return replace(samples, **own, neighbours=np.zeros((0, 2), np.int32), grids=())


def shared_area(samples: SurfaceSamples, all_rows: Rows, rows: Rows) -> Floats:
    """The area (r,) that some samples stand for when each of all gives its own to the nearest of them, on its face if it can."""
    size = float(np.linalg.norm(np.ptp(samples.point[all_rows], axis=0))) or 1.0
    place = np.column_stack([samples.point, samples.face * (_OTHER_FACE * size)])
    nearest = cKDTree(place[rows]).query(place[all_rows])[1]
    return np.bincount(nearest, np.nan_to_num(samples.area[all_rows]), len(rows)).astype(float)


def least_time(
    columns: Columns, table: NDArray[np.bool_], rows: Rows, area: Floats, samples: SurfaceSamples, cutters: Sequence[Cutter],
    paths: Paths, costs: Costs, start: Rows,
) -> tuple[Location, float]:  # fmt: skip
    """Choose the columns of least time for some samples, weighted by area.

    Parameters
    ----------
    columns : Columns
    table : (r, m) bool
        Where they serve.
    rows : (r,) int64
    area : (r,) float
        That each of `rows` stands for, mm2.
    samples, cutters, paths, costs
    start : (k,) int64
        A choice that serves all of them.

    Returns
    -------
    Location
    float
        Seconds at best where each sample has its own axis among the candidates: what simultaneous motion takes at least on them.
    """
    cost = costs_of(columns, widths(columns, rows, samples, cutters, paths), table, area, cutters, paths)
    problem = Problem(cost, columns.cutter, columns.setup, costs)
    return fastest(problem, start), float(cost.min(axis=1).sum())
