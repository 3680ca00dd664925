"""Is the cutter accessible? The seed's second phase: a posture, or why there is none, at every prone sample."""

import numpy as np
from numpy.typing import NDArray

from cad_io.arrays import Floats, SurfaceSamples
from plan_cutters.cutter import Cutter
from plan_cutters.machine import Machine
from plan_cutters.obstacles import Obstacles
from plan_cutters.posture import PostureRange
from plan_cutters.reach import ACCESSIBLE, FREE, INACCESSIBLE, REASONS, UNDECIDED, UNJUDGED, Reach, Witness, blank
from plan_cutters.threads import Progress, in_chunks


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
    known: Reach | None = None,
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
    known : Reach, optional
        What follows from other cutters (`nesting.handed`): those samples are not searched again.
    progress : callable, optional
        Told how many pieces of the work are done, of how many.
    """
    n = len(samples)
    reach = blank(n)
    judged = samples.unjudged < 0
    reach.verdict[free] = FREE
    reach.axis[free] = samples.normal[free]
    reach.lean[free] = samples.direction_max[free]
    reach.tilt[free] = 0.0
    reach.rotation[free] = 0
    geometry = (samples.point, samples.normal, samples.direction_max, samples.curvature)
    wanted = judged & ~free
    if known is not None:
        follows = wanted & (known.verdict != UNJUDGED)
        for name in Reach.__slots__:
            getattr(reach, name)[follows] = getattr(known, name)[follows]
        _first_reasons(geometry, np.flatnonzero(follows & (known.verdict == INACCESSIBLE)), cutter, machine, setup,
                       postures, jobs, reach)  # fmt: skip
        wanted &= ~follows
    _search(geometry, np.flatnonzero(wanted), cutter, machine, setup, postures, obstacles,
            obstacles.depths(tolerance), jobs, reach, progress)  # fmt: skip
    return reach


def _first_reasons(
    geometry: tuple[Floats, Floats, Floats, Floats], rows: NDArray[np.int64], cutter: Cutter, machine: Machine,
    setup: Floats, postures: PostureRange, jobs: int, reach: Reach,
) -> None:  # fmt: skip
    """Where the axis limit or local gouging alone leaves this cutter nothing, that is the reason."""
    from plan_cutters.kernels.search import first_reason

    cosine, sine = np.cos(postures.rotations), np.sin(postures.rotations)
    low, high = max(0.0, postures.tilt[0]), min(np.pi / 2, postures.tilt[1])

    def work(piece: NDArray[np.int64]) -> None:
        first_reason(piece, *geometry[1:], cosine, sine, low, high, setup, machine.limit_cos, cutter.radius,
                     reach.reason)  # fmt: skip

    in_chunks(work, rows, jobs)


def _search(
    geometry: tuple[Floats, Floats, Floats, Floats], rows: NDArray[np.int64], cutter: Cutter, machine: Machine,
    setup: Floats, postures: PostureRange, obstacles: Obstacles, depths: tuple[float, float], jobs: int,
    reach: Reach, progress: Progress | None = None,
) -> None:  # fmt: skip
    from plan_cutters.kernels.search import search

    rotations = postures.rotations
    cosine, sine = np.cos(rotations), np.sin(rotations)
    low, high = max(0.0, postures.tilt[0]), min(np.pi / 2, postures.tilt[1])

    def work(piece: NDArray[np.int64]) -> None:
        search(
            piece, *geometry,
            cosine, sine, low, high, setup, machine.limit_cos,
            cutter.radius, cutter.length, *depths, *obstacles.tree,
            reach.verdict, reach.axis, reach.lean, reach.tilt, reach.rotation, reach.reason,
        )  # fmt: skip

    in_chunks(work, rows, jobs, progress)


#: Witnesses kept for each face and reason, and samples tried to find them, in all.
_KEPT, _TRIED, _TRIED_IN_ALL = 2, 6, 60
#: Depths are found to this share of themselves.
_PRECISION = 0.02


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
    jobs: int,
) -> tuple[Witness, ...]:
    """Samples that are not reached, the deepest tried of each face and reason first."""
    lost = np.flatnonzero((reach.verdict == INACCESSIBLE) | (reach.verdict == UNDECIDED))
    groups: dict[tuple[int, int], list[int]] = {}
    for row in lost:
        groups.setdefault((int(samples.face[row]), int(reach.reason[row])), []).append(int(row))
    tries = max(1, min(_TRIED, _TRIED_IN_ALL // max(1, len(groups))))
    picked = [
        [group[i] for i in np.unique(np.linspace(0, len(group) - 1, tries).astype(int))] for group in groups.values()
    ]
    looked: dict[int, Witness] = {}

    def work(rows: NDArray[np.int64]) -> None:
        for row in rows.tolist():
            looked[row] = _witness(samples, row, reach, cutter, machine, setup, postures, obstacles, tolerance)

    in_chunks(work, np.array([row for group in picked for row in group], np.int64), jobs, chunk=1)
    found: list[Witness] = []
    for group in picked:
        ranked = sorted((looked[row] for row in group), key=lambda w: (-(w.depth or 0.0), w.sample))
        found += ranked[:_KEPT]
    return tuple(found)


def _witness(
    samples: SurfaceSamples, row: int, reach: Reach, cutter: Cutter, machine: Machine, setup: Floats,
    postures: PostureRange, obstacles: Obstacles, tolerance: float,
) -> Witness:  # fmt: skip
    """Find the posture with the least depth by halving the depth that is let pass.

    Local gouging holds as it does in the search, except where it alone leaves no posture: there it is what is measured.
    """
    from plan_cutters.kernels.search import probe

    reason = REASONS[reach.reason[row]]
    one, first = slice(row, row + 1), np.zeros(1, np.int64)
    curvature = np.zeros((1, 2)) if reason == "local_gouge" else samples.curvature[one]
    geometry = (samples.point[one], samples.normal[one], samples.direction_max[one], curvature)
    deepest = min(cutter.radius, cutter.length / 2) * (1 - 1e-9)
    low, high = obstacles.depths(tolerance)[0], deepest
    best: Reach | None = None
    while best is None or high - low > _PRECISION * high:
        depth = np.sqrt(low * high) if best else deepest
        trial = blank(1)
        _search(geometry, first, cutter, machine, setup, postures, obstacles, (depth, depth), 1, trial)
        if trial.verdict[0] == ACCESSIBLE:
            best, high = trial, depth
        elif best is None:
            return Witness(row, reason, None, None, None, None, None, None)
        else:
            low = depth
    triangle = np.full(1, -1, np.int32)
    probe(first, *geometry[:2], best.axis, best.lean, cutter.radius, cutter.length, np.array([low]),
          *obstacles.tree, triangle)  # fmt: skip
    hit = int(triangle[0])
    return Witness(
        sample=row,
        reason=reason,
        obstacle_face=obstacles.face(hit) if hit >= 0 else None,
        obstacle_point=None
        if hit < 0
        else _deepest(obstacles.tree[0][hit], samples.point[row], samples.normal[row], best, cutter),
        tilt=float(best.tilt[0]),
        rotation=float(postures.rotations[best.rotation[0]]),
        axis=best.axis[0],
        depth=high,
    )


def _deepest(triangle: Floats, contact: Floats, normal: Floats, posture: Reach, cutter: Cutter) -> Floats:
    """The point of a triangle that is deepest in the cutter, of 66."""
    axis, x_t = posture.axis[0], np.cos(posture.tilt[0]) * posture.lean[0] - np.sin(posture.tilt[0]) * normal
    share = np.array([(i, j, 10 - i - j) for i in range(11) for j in range(11 - i)]) / 10
    points = share @ triangle
    offset = points - (contact - cutter.radius * x_t)
    height = offset @ axis
    radial = np.linalg.norm(offset - height[:, None] * axis, axis=1)
    depth = np.minimum(np.minimum(height, cutter.length - height), cutter.radius - radial)
    return np.asarray(points[int(depth.argmax())])
