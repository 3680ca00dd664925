"""Groups of what is connected by pairs. No kernel here."""

from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components


def connected(count: int, pairs: NDArray[Any]) -> NDArray[np.int32]:
    """Numbers (count,) of the groups that pairs (m, 2) connect."""
    graph = coo_array((np.ones(len(pairs), np.int8), (pairs[:, 0], pairs[:, 1])), shape=(count, count))
    return np.asarray(connected_components(graph, directed=False)[1])
