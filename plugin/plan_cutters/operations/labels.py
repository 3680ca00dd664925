"""Labels: the operation that each sample goes with, so that little is cut twice at the borders."""

import numpy as np

from cad_io.arrays import Floats, Ints, SurfaceSamples


def labelled(length: Floats, samples: SurfaceSamples) -> Ints:
    """Give each sample the operation that cuts it with the shortest path.

    Parameters
    ----------
    length : (n, k) float
        Cut length of each sample with each operation, mm; infinite where the operation does not serve it.
    samples : SurfaceSamples

    Returns
    -------
    (n,) int32
        Index of the operation, -1 where none serves the sample.
    """
    best = length.argmin(axis=1) if length.shape[1] else np.zeros(len(samples), np.int64)
    served = np.isfinite(length).any(axis=1)
    return np.where(served, best, -1).astype(np.int32)
