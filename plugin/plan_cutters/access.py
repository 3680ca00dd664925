"""Is the cutter accessible? The seed's second phase: a posture, or why there is none, at every prone sample."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from cad_io.arrays import Floats, Ints, SurfaceSamples
from plan_cutters.cutter import Cutter
from plan_cutters.machine import Machine
from plan_cutters.obstacles import Obstacles
from plan_cutters.posture import PostureRange
from plan_cutters.threads import Progress, in_chunks

INACCESSIBLE, ACCESSIBLE, FREE, UNDECIDED, UNJUDGED = 0, 1, 2, 3, 255

#: Why no posture is left, in the order in which the attributes are applied; `Reach.reason` is an index into it.
REASONS = ("axis_limit", "local_gouge", "rear_gouge", "shank")
NO_REASON = 255

Bytes = NDArray[np.uint8]


@dataclass(frozen=True, slots=True)
class Reach:
    """What one cutter reaches, sample by sample.

    Attributes
    ----------
    verdict : (n,) uint8
        INACCESSIBLE, ACCESSIBLE, FREE (interference-free), UNDECIDED or UNJUDGED.
    axis, lean : (n, 3) float
        Unit tool axis and lean direction of the posture found; nan where there is none.
    tilt : (n,) float
        rad, nan where there is none.
    rotation : (n,) int32
        Index into the posture range's rotations, -1 where there is none.
    reason : (n,) uint8
        Index into REASONS where inaccessible or undecided, else NO_REASON.
    """

    verdict: Bytes
    axis: Floats
    lean: Floats
    tilt: Floats
    rotation: Ints
    reason: Bytes

    @property
    def reached(self) -> NDArray[np.bool_]:
        return (self.verdict == FREE) | (self.verdict == ACCESSIBLE)


@dataclass(frozen=True, slots=True)
class Witness:
    """A sample that is not reached, and the posture that comes nearest to reaching it.

    Attributes
    ----------
    sample : int
    reason : str
        One of REASONS.
    obstacle_face : int, optional
        Face that is in the way at that posture.
    tilt, rotation : float, optional
        rad; None where the axis limit leaves no posture at all.
    axis : (3,) float, optional
    depth : float, optional
        How deep the part reaches into the cutter there, mm, to the resolution of the search.
    """

    sample: int
    reason: str
    obstacle_face: int | None
    tilt: float | None
    rotation: float | None
    axis: Floats | None
    depth: float | None


def access(
    samples: SurfaceSamples,
    free: NDArray[np.bool_],
    cutter: Cutter,
    *,
    machine: Machine,
    setup: Floats,
    postures: PostureRange,
    obstacles: Obstacles,
    tolerance: float,
    jobs: int,
    progress: Progress | None = None,
) -> Reach:
    """Search a posture for every judged sample that is not interference-free.

    Parameters
    ----------
    samples : SurfaceSamples
    free : (n,) bool
        Interference-free samples, as `decompose` gives them.
    cutter, machine, postures, obstacles
    setup : (3,) float
        Unit setup axis.
    tolerance : float
        mm.
    jobs : int
        Threads.
    progress : callable, optional
        Told how many pieces of the work are done, of how many.
    """
    n = len(samples)
    reach = Reach(
        verdict=np.full(n, UNJUDGED, np.uint8),
        axis=np.full((n, 3), np.nan),
        lean=np.full((n, 3), np.nan),
        tilt=np.full(n, np.nan),
        rotation=np.full(n, -1, np.int32),
        reason=np.full(n, NO_REASON, np.uint8),
    )
    judged = samples.unjudged < 0
    reach.verdict[free] = FREE
    reach.axis[free] = samples.normal[free]
    reach.lean[free] = samples.direction_max[free]
    reach.tilt[free] = 0.0
    reach.rotation[free] = 0
    _search(samples, np.flatnonzero(judged & ~free), cutter, machine, setup, postures, obstacles,
            obstacles.depths(tolerance), samples.curvature, jobs, reach, progress)  # fmt: skip
    return reach


def _search(
    samples: SurfaceSamples, rows: NDArray[np.int64], cutter: Cutter, machine: Machine, setup: Floats,
    postures: PostureRange, obstacles: Obstacles, depths: tuple[float, float], curvature: Floats, jobs: int,
    reach: Reach, progress: Progress | None = None,
) -> None:  # fmt: skip
    from plan_cutters.kernels.search import search

    rotations = postures.rotations
    cosine, sine = np.cos(rotations), np.sin(rotations)
    low, high = max(0.0, postures.tilt[0]), min(np.pi / 2, postures.tilt[1])

    def work(piece: NDArray[np.int64]) -> None:
        search(
            piece, samples.point, samples.normal, samples.direction_max, curvature,
            cosine, sine, low, high, setup, machine.limit_cos,
            cutter.radius, cutter.length, *depths, *obstacles.tree,
            reach.verdict, reach.axis, reach.lean, reach.tilt, reach.rotation, reach.reason,
        )  # fmt: skip

    in_chunks(work, rows, jobs, progress)


#: Witnesses kept for each face and reason, and samples tried to find them, in all.
_KEPT, _TRIED, _TRIED_IN_ALL = 2, 8, 240


def witnesses(
    samples: SurfaceSamples,
    reach: Reach,
    cutter: Cutter,
    *,
    machine: Machine,
    setup: Floats,
    postures: PostureRange,
    obstacles: Obstacles,
    tolerance: float,
) -> tuple[Witness, ...]:
    """Samples that are not reached, the deepest tried of each face and reason first."""
    lost = np.flatnonzero((reach.verdict == INACCESSIBLE) | (reach.verdict == UNDECIDED))
    groups: dict[tuple[int, int], list[int]] = {}
    for row in lost:
        groups.setdefault((int(samples.face[row]), int(reach.reason[row])), []).append(int(row))
    tries = max(1, min(_TRIED, _TRIED_IN_ALL // max(1, len(groups))))
    found: list[Witness] = []
    for group in groups.values():
        picked = [group[i] for i in np.unique(np.linspace(0, len(group) - 1, tries).astype(int))]
        looked = [
            _witness(samples, row, reach, cutter, machine, setup, postures, obstacles, tolerance) for row in picked
        ]
        looked.sort(key=lambda w: (-(w.depth or 0.0), w.sample))
        found += looked[:_KEPT]
    return tuple(found)


def _witness(
    samples: SurfaceSamples, row: int, reach: Reach, cutter: Cutter, machine: Machine, setup: Floats,
    postures: PostureRange, obstacles: Obstacles, tolerance: float,
) -> Witness:  # fmt: skip
    """Find the posture with the least depth by halving the depth that is let pass; local gouging is measured too."""
    from plan_cutters.kernels.search import probe

    reason = REASONS[reach.reason[row]]
    rows, n = np.array([row]), len(samples)
    flat = np.zeros_like(samples.curvature)
    deepest = min(cutter.radius, cutter.length / 2)
    low, high = obstacles.depths(tolerance)[0], deepest
    best: Reach | None = None
    while high - low > 1e-3 * (high + tolerance):
        depth = 0.5 * (low + high) if best else deepest * (1 - 1e-9)
        trial = Reach(np.zeros(n, np.uint8), np.zeros((n, 3)), np.zeros((n, 3)), np.zeros(n),
                      np.zeros(n, np.int32), np.zeros(n, np.uint8))  # fmt: skip
        _search(samples, rows, cutter, machine, setup, postures, obstacles, (depth, depth), flat, 1, trial)
        if trial.verdict[row] == ACCESSIBLE:
            best, high = trial, depth
        elif best is None:
            return Witness(row, reason, None, None, None, None, None)
        else:
            low = depth
    assert best is not None
    triangle = np.full(n, -1, np.int32)
    probe(rows, samples.point, best.axis, best.lean, cutter.radius, cutter.length, np.full(n, low),
          *obstacles.tree, triangle)  # fmt: skip
    return Witness(
        sample=row,
        reason=reason,
        obstacle_face=obstacles.face(triangle[row]) if triangle[row] >= 0 else None,
        tilt=float(best.tilt[row]),
        rotation=float(postures.rotations[best.rotation[row]]),
        axis=best.axis[row].copy(),
        depth=high,
    )
