"""Convex, concave or saddle? The seed's first step, on the kernel's curvature."""

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from cad_io.arrays import Ints, SurfaceSamples
from plan_cutters.domain.verdicts import CONCAVE, CONVEX, SADDLE, UNJUDGED

#: Curvature times part diagonal below which a curvature is zero: planes and cylinders come out convex, not as noise.
FLAT = 1e-6


def classify(samples: SurfaceSamples, diagonal: float) -> NDArray[np.uint8]:
    """Class of each sample.

    Parameters
    ----------
    samples : SurfaceSamples
    diagonal : float
        Of the part's box, mm.

    Returns
    -------
    (n,) uint8
        CONVEX where both curvatures are zero or negative, CONCAVE where both are zero or positive (not both zero),
        SADDLE where they differ in sign, UNJUDGED where the kernel gave none.
    """
    kappa = np.where(np.abs(samples.curvature) * diagonal < FLAT, 0.0, samples.curvature)
    most, least = kappa[:, 0], kappa[:, 1]
    result = np.full(len(samples), SADDLE, np.uint8)
    result[least >= 0] = CONCAVE
    result[most <= 0] = CONVEX
    result[samples.unjudged >= 0] = UNJUDGED
    return result


def regions(samples: SurfaceSamples, surface_class: NDArray[np.uint8]) -> Ints:
    """Number the connected regions of equal class, across smooth face joints.

    Returns
    -------
    (n,) int32
        Region of each sample, from 0.
    """
    a, b = samples.neighbours.T
    same = surface_class[a] == surface_class[b]
    n = len(samples)
    graph = coo_array((np.ones(int(same.sum()), np.int8), (a[same], b[same])), shape=(n, n))
    return np.asarray(connected_components(graph, directed=False)[1], np.int32)
