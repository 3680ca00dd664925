"""Every free tilt of every sample at every rotation, with certified ends."""

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from cad_io.arrays import Floats, Record, SurfaceSamples
from plan_cutters.domain.assembly import Assembly
from plan_cutters.domain.posture import tilt_direction
from plan_cutters.domain.verdicts import Verdicts
from plan_cutters.judging.map_budget import chosen
from plan_cutters.scene.conditions import Context, contacts_of, require_finite
from plan_cutters.scene.obstacles import Obstacles
from plan_cutters.scene.threads import Progress, in_chunks

#: Ends are certified to this, rad; where that cannot be, the band left is counted as undecided.
NARROWEST = np.radians(0.1)
#: Free intervals that one rotation may have; more count as undecided.
_MOST_INTERVALS = 8


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class PostureMaps(Record):
    """Free tilts of n samples at k rotations.

    Attributes
    ----------
    rotations : (k,) float
        rad, from each sample's `direction_max`.
    offset : (n * k + 1,) int64
        Sample i has at rotation j the intervals `free[offset[i * k + j]:offset[i * k + j + 1]]`.
    free : (m, 2) float
        Tilts from, to, rad, ascending; every tilt within is safe for the true surface to the tolerance.
    undecided : (n, k) float32
        Tilts that are neither free nor known to be forbidden, rad in all.
    normal, direction_max : (n, 3) float
        The samples' frames, from which tilts and rotations count.
    verdict, reason : (n,) uint8
        What was found of each sample without limits of a machine, as in `Verdicts`.
    tilt : (float, float)
        Tilts that were looked at, rad.
    tolerance : float
        Gouge tolerance that is kept, mm.
    cutter : str
        Its id.
    part : str
        SHA-256 of the part's file; empty where it was no file.
    inside : (n,) bool
        Samples that lie inside another body of the part: no surface of the finished part. Empty: none.
    missing : tuple of str
        Obstacles that are missing or only guessed: while there are some, what is free is so but for them.
    unmapped : int
        Judged samples that were left out: they are undecided at every tilt.

    They hold for any machine, and for any setup that turns no side of an open face: the part's free postures depend on neither.
    """

    rotations: Floats
    offset: NDArray[np.int64]
    free: Floats
    undecided: NDArray[np.float32]
    normal: Floats
    direction_max: Floats
    verdict: NDArray[np.uint8]
    reason: NDArray[np.uint8]
    tilt: tuple[float, float]
    tolerance: float
    cutter: str
    part: str
    inside: NDArray[np.bool_] = field(default_factory=lambda: np.zeros(0, bool))
    missing: tuple[str, ...] = ()
    unmapped: int = 0


def posture_maps(
    samples: SurfaceSamples, context: Context, verdicts: Verdicts, *, part: str = "",
    inside: NDArray[np.bool_] | None = None, shut: NDArray[np.bool_] | None = None, missing: tuple[str, ...] = (),
    most: int | None = None, progress: Progress | None = None,
) -> PostureMaps:  # fmt: skip
    """Find the free tilts of judged samples, whatever the machine; the others have none.

    Of samples that are more than the work is worth, as many as that allows, evenly spread: of the others, every tilt is undecided
    and `unmapped` says how many there are. The same samples get the same maps whatever the machine's speed.

    Parameters
    ----------
    samples : SurfaceSamples
    context : Context
        The machine is not looked at.
    verdicts : Verdicts
        What the cutter reaches without a machine.
    part : str
        SHA-256 of the part's file.
    inside : (n,) bool, optional
        Samples that lie inside another body of the part.
    shut : (n,) bool, optional
        Samples that no cutter gets to, for they are held or lie within a fixture: no tilt is free there, nor in doubt.
    missing : tuple of str
        Obstacles that are missing or only guessed.
    most : int, optional
        Samples to map, at most. None: as many as take `map_budget.WORK`.
    progress : callable, optional
        Called with the number of pieces of work that are done, and the number of all.
    """
    from plan_cutters.kernels.maps.free_map import free_map

    conditions, outer_tool, tool = context.conditions.without_machine(), context.outer_tool, context.outer
    rotations, ranges = conditions.postures.rotations, conditions.ranges
    possible, certain = conditions.obstacles, conditions.surroundings.certain
    contacts = contacts_of(samples)
    n, k = len(samples), len(rotations)
    count = np.zeros((n, k), np.int32)
    undecided = np.zeros((n, k), np.float32)
    free: dict[int, Floats] = {}

    def mapped(rows: NDArray[np.int64], obstacles: Obstacles) -> tuple[Floats, NDArray[np.int32], Floats, int]:
        part = np.empty((len(rows), k, _MOST_INTERVALS, 2))
        mine, unsure = np.empty((len(rows), k), np.int32), np.empty((len(rows), k))
        tree, wide = obstacles.tree, obstacles.wide_tree
        looked = free_map(rows, contacts, ranges, tool, NARROWEST, tree, wide, _MOST_INTERVALS, part, mine, unsure)
        if obstacles.solids.cell.size:
            _leave_bodies(samples, rows, outer_tool, rotations, obstacles, part, mine, certain=obstacles is not possible)
        return part, mine, unsure, looked

    def work(rows: NDArray[np.int64]) -> int:
        # Room for the most intervals only while a piece is worked on: memory grows with what is found.
        part, mine, unsure, looked = mapped(rows, possible)
        if certain is not possible:
            # What is only perhaps in the way forbids nothing for sure.
            perhaps, few, more, again = mapped(rows, certain)
            looked += again
            unsure = np.maximum(unsure, _width(perhaps, few) + more - _width(part, mine))
        count[rows], undecided[rows] = mine, unsure
        free[int(rows[0])] = part[np.arange(_MOST_INTERVALS) < mine[..., None]]
        return int(looked)

    judged = np.flatnonzero(samples.unjudged < 0 if shut is None else (samples.unjudged < 0) & ~shut)
    require_finite(contacts, judged)
    rows = chosen(judged, most, lambda piece: mapped(piece, possible)[3], conditions.jobs)
    in_chunks(work, rows, conditions.jobs, progress)
    remaining = np.setdiff1d(judged, rows)
    undecided[remaining] = conditions.postures.tilt[1] - conditions.postures.tilt[0]
    pieces = [free[first] for first in sorted(free)]
    offset = np.concatenate([[0], np.cumsum(count.ravel(), dtype=np.int64)])
    return PostureMaps(rotations, offset, np.concatenate([np.zeros((0, 2)), *pieces]), undecided, samples.normal,
                       samples.direction_max, verdicts.verdict, verdicts.reason, conditions.postures.tilt, conditions.tolerance,
                       context.cutter.id, part, np.zeros(n, bool) if inside is None else inside, missing,
                       len(remaining))  # fmt: skip


def _width(part: Floats, count: NDArray[np.int32]) -> Floats:
    """Width (m, k) of intervals (m, k, room, 2), of each cell so many, rad."""
    # What lies beyond the count was never written.
    there = np.arange(_MOST_INTERVALS) < count[..., None]
    return np.asarray(np.subtract(part[..., 1], part[..., 0], out=np.zeros(there.shape), where=there).sum(axis=-1))


def _leave_bodies(
    samples: SurfaceSamples, rows: NDArray[np.int64], outer_tool: Assembly, rotations: Floats, obstacles: Obstacles, part: Floats,
    count: NDArray[np.int32], *, certain: bool,
) -> None:  # fmt: skip
    """Take out intervals (m, k, room, 2) in which the cutter lies within a body, or may; or only where it surely does.

    Between the ends of an interval the cutter touches no skin, so it lies within a body all along or nowhere.
    """
    at = np.argwhere(np.arange(_MOST_INTERVALS) < count[..., None])
    row, turn = rows[at[:, 0]], rotations[at[:, 1]]
    tilt = part[at[:, 0], at[:, 1], at[:, 2]].mean(axis=1)
    normal = samples.normal[row]
    tilt_directions = tilt_direction(normal, samples.direction_max[row], turn)
    inside = obstacles.holds(outer_tool, samples.point[row], normal, tilt_directions, tilt, certain=certain)
    for i, j in np.unique(at[inside, :2], axis=0).tolist():
        mine = (at[:, 0] == i) & (at[:, 1] == j)
        outside = part[i, j, : count[i, j]][~inside[mine]]
        part[i, j, : len(outside)], count[i, j] = outside, len(outside)
