"""How many samples to map: work is counted, not timed, so that two runs choose the same ones."""

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from plan_cutters.scene.threads import in_chunks

#: Blocks of the tree and triangles that are looked at for all maps, about: some minutes on two cores.
WORK = 400_000_000
#: Samples by which the work is estimated, and how many of them at a time.
PROBED, _AT_A_TIME = 256, 16

Rows = NDArray[np.int64]


def chosen(judged: Rows, most: int | None, looked: Callable[[Rows], int], jobs: int) -> Rows:
    """The samples to map.

    Parameters
    ----------
    judged : (n,) int64
        Samples that could be mapped, ascending.
    most : int, optional
        At most so many. None: as many as take about `WORK`.
    looked : callable
        Maps some samples and tells at how much it looked: the same for the same samples.
    jobs : int
        Threads.
    """
    if most is None:
        if len(judged) <= PROBED:
            return judged
        tried = spread(judged, PROBED)
        most = int(WORK * len(tried) / max(1, in_chunks(looked, tried, jobs, chunk=_AT_A_TIME)))
    return spread(judged, most)


def spread(rows: Rows, most: int) -> Rows:
    """At most so many of ascending rows, evenly spread."""
    if len(rows) <= most:
        return rows
    return rows[np.unique(np.linspace(0, len(rows) - 1, max(1, most)).astype(np.int64))]
