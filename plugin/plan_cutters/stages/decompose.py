"""Interference-free or interference-prone? The seed's second step, by the dummy cutter."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from cad_io.arrays import Ints, SurfaceSamples
from plan_cutters.domain.cutter import Cutter
from plan_cutters.scene.conditions import Conditions, contacts_of
from plan_cutters.scene.threads import in_chunks


@dataclass(frozen=True, slots=True)
class Decomposition:
    """Which samples need no posture search.

    Attributes
    ----------
    free : (n,) bool
        Convex samples at which the dummy cutter, the axis limit and the posture range leave tilt 0 in every rotation.
    march_differs : int
        Convex samples that the seed's boundary march would have put on the other side.
    """

    free: NDArray[np.bool_]
    march_differs: int


def decompose(
    samples: SurfaceSamples,
    convex: NDArray[np.bool_],
    region: NDArray[np.int32],
    cutter: Cutter,
    conditions: Conditions,
    *,
    buried: Ints | None = None,
) -> Decomposition:
    """Test each convex sample with the dummy cutter, and compare with the seed's march over boundaries.

    Parameters
    ----------
    samples : SurfaceSamples
    convex : (n,) bool
    region : (n,) int32
        As `classify.regions` gives it.
    cutter, conditions
    buried : (n,) int32, optional
        The body that each sample lies within, -1 for none (default): none of those within is free.
    """
    from plan_cutters.kernels.search import dummy_free

    free = np.zeros(len(samples), bool)
    allowed = convex & conditions.upright(samples.normal)
    if buried is not None:
        allowed &= buried < 0
    safe, _ = conditions.depths
    solids, contacts = conditions.obstacles.solids, contacts_of(samples)

    def work(rows: NDArray[np.int64]) -> None:
        dummy_free(rows, contacts, cutter.radius, cutter.length, safe, solids, free)

    in_chunks(work, np.flatnonzero(allowed), conditions.jobs)
    marched = _march(samples, convex, region, free)
    return Decomposition(free, int((marched[convex] != free[convex]).sum()))


def _march(
    samples: SurfaceSamples, convex: NDArray[np.bool_], region: NDArray[np.int32], free: NDArray[np.bool_]
) -> NDArray[np.bool_]:
    """The seed's march: from each region's boundary inwards, past every point that is not free.

    What it reaches through points that are not free is prone; a pocket of such points inside is never looked at.
    """
    a, b = samples.neighbours.T
    n = len(samples)
    inside = region[a] == region[b]
    # The boundary: next to another region, or at the rim of the sampled surface (fewer than four neighbours).
    degree = np.bincount(a, minlength=n) + np.bincount(b, minlength=n)
    rim = degree < 4
    rim[a[~inside]] = rim[b[~inside]] = True
    blocked = convex & ~free
    both = inside & blocked[a] & blocked[b]
    graph = coo_array((np.ones(int(both.sum()), np.int8), (a[both], b[both])), shape=(n, n))
    count, island = connected_components(graph, directed=False)
    reached = np.zeros(count, bool)
    reached[island[blocked & rim]] = True
    return np.asarray(convex & ~(blocked & reached[island]))
