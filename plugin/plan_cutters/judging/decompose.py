"""Interference-free or interference-prone? The seed's second step, by the dummy cutter."""

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from cad_io.arrays import Ints, SurfaceSamples
from plan_cutters.scene.conditions import Context, contacts_of
from plan_cutters.scene.threads import in_chunks
from plan_cutters.scene.work import Work


def decompose(
    samples: SurfaceSamples, convex: NDArray[np.bool_], context: Context,
    *, inside: Ints | None = None, rows: NDArray[np.int64] | None = None, work: Work | None = None,
) -> NDArray[np.bool_]:  # fmt: skip
    """Test convex samples with the dummy cutter: which need no posture search?

    Parameters
    ----------
    samples : SurfaceSamples
    convex : (n,) bool
    context : Context
    inside : (n,) int32, optional
        The body that each sample lies within, -1 for none (default): none of those within is free.
    rows : (m,) int64, optional
        The samples to test, all by default.
    work : Work, optional
        Where what is looked at is counted.

    Returns
    -------
    (n,) bool
        Convex samples at which the dummy cutter, the axis limit and the posture range leave tilt 0 in every rotation.
    """
    from plan_cutters.kernels.search.search import dummy_clear

    conditions, interference_free = context.conditions, np.zeros(len(samples), bool)
    allowed = convex & conditions.upright(samples.normal)
    if inside is not None:
        allowed &= inside < 0
    selected = np.flatnonzero(allowed) if rows is None else rows[allowed[rows]]
    if not len(context.dummy):
        return interference_free
    shape, solids, contacts = (context.dummy, context.outer), conditions.obstacles.solids, contacts_of(samples)

    def tested(piece: NDArray[np.int64]) -> int:
        return int(dummy_clear(piece, contacts, *shape, solids, interference_free))

    # In fixed pieces, so that the work counted does not depend on how samples are divided, either.
    looked = in_chunks(tested, selected, conditions.jobs, fixed=True)
    if work is not None:
        work.add(looked)
    return interference_free


def march_differs(samples: SurfaceSamples, convex: NDArray[np.bool_], region: Ints, interference_free: NDArray[np.bool_]) -> int:
    """Convex samples that the seed's march over boundaries would have put on the other side; `region` as in `regions`."""
    marched = _march(samples, convex, region, interference_free)
    return int((marched[convex] != interference_free[convex]).sum())


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
