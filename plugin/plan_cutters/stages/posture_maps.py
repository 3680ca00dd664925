"""Every free tilt of every sample at every rotation, with certified ends."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from cad_io.arrays import Floats, Record, SurfaceSamples
from plan_cutters.domain.assembly import Assembly
from plan_cutters.domain.cutter import Cutter
from plan_cutters.domain.posture import lean
from plan_cutters.scene.conditions import Conditions, contacts_of, require_finite, tool_of
from plan_cutters.scene.threads import Progress, in_chunks

#: Ends are certified to this, rad; where that cannot be, the band left is counted as undecided.
NARROWEST = np.radians(0.1)
#: Free intervals that one rotation may have; more count as undecided.
_ROOM = 8


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
    """

    rotations: Floats
    offset: NDArray[np.int64]
    free: Floats
    undecided: NDArray[np.float32]


def posture_maps(
    samples: SurfaceSamples, cutter: Cutter, conditions: Conditions, *, progress: Progress | None = None
) -> PostureMaps:
    """Find the free tilts of all judged samples; the others have none.

    Parameters
    ----------
    samples : SurfaceSamples
    cutter, conditions
    progress : callable, optional
        Told how many pieces of the work are done, of how many.
    """
    from plan_cutters.kernels.free_map import free_map

    rotations, ranges, obstacles = conditions.postures.rotations, conditions.ranges, conditions.obstacles
    tree, wide, light = obstacles.tree, obstacles.wide_tree, conditions.light(cutter)
    tool = tool_of(light)
    contacts = contacts_of(samples)
    n, k = len(samples), len(rotations)
    count = np.zeros((n, k), np.int32)
    undecided = np.zeros((n, k), np.float32)
    free: dict[int, Floats] = {}

    def work(rows: NDArray[np.int64]) -> None:
        # Room for the most intervals only while a piece is worked on: memory grows with what is found.
        part = np.empty((len(rows), k, _ROOM, 2))
        mine, unsure = np.empty((len(rows), k), np.int32), np.empty((len(rows), k))
        free_map(rows, contacts, ranges, tool, NARROWEST, tree, wide, _ROOM, part, mine, unsure)
        count[rows], undecided[rows] = mine, unsure
        if conditions.obstacles.solids.cell.size:
            _leave_bodies(samples, rows, light, conditions, part, mine)
            count[rows] = mine
        free[int(rows[0])] = part[np.arange(_ROOM) < mine[..., None]]

    judged = np.flatnonzero(samples.unjudged < 0)
    require_finite(contacts, judged)
    in_chunks(work, judged, conditions.jobs, progress)
    pieces = [free[first] for first in sorted(free)]
    offset = np.concatenate([[0], np.cumsum(count.ravel(), dtype=np.int64)])
    return PostureMaps(rotations, offset, np.concatenate([np.zeros((0, 2)), *pieces]), undecided)


def _leave_bodies(
    samples: SurfaceSamples, rows: NDArray[np.int64], light: Assembly, conditions: Conditions, part: Floats,
    count: NDArray[np.int32],
) -> None:  # fmt: skip
    """Take out intervals (m, k, room, 2) in which the cutter lies within a body.

    Between the ends of an interval the cutter touches no skin, so it lies within a body all along or nowhere.
    """
    rotations = conditions.postures.rotations
    at = np.argwhere(np.arange(_ROOM) < count[..., None])
    row, turn = rows[at[:, 0]], rotations[at[:, 1]]
    tilt = part[at[:, 0], at[:, 1], at[:, 2]].mean(axis=1)
    inside = conditions.obstacles.holds(
        light,
        samples.point[row],
        samples.normal[row],
        lean(samples.normal[row], samples.direction_max[row], turn),
        tilt,
    )
    for i, j in np.unique(at[inside, :2], axis=0).tolist():
        mine = (at[:, 0] == i) & (at[:, 1] == j)
        kept = part[i, j, : count[i, j]][~inside[mine]]
        part[i, j, : len(kept)], count[i, j] = kept, len(kept)
