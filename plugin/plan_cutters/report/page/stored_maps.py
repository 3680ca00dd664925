"""Posture maps as the page has them: rounded so that nothing is shown free that is not."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

#: Ends are stored in these steps, degrees, and sums of what is undecided in these.
END, UNDECIDED = 0.1, 0.5
#: Ends as near to a step as this, in steps, are on it: 90 degrees come back as 90.
_ROUNDING = 1e-6


@dataclass(frozen=True, slots=True)
class StoredMaps:
    """Maps of c samples at k rotations."""

    #: (c,); samples, ascending.
    row: NDArray[np.uint32]
    #: (c, k); free intervals.
    count: NDArray[np.uint8]
    #: (sum of count, 2); from (rounded up) and to (rounded down), in tenths of degrees; sample by sample, rotation by rotation.
    end: NDArray[np.uint16]
    #: (c, k); tilts left undecided, in half degrees, rounded up; 255 is that or more.
    undecided: NDArray[np.uint8]


def stored(maps: Any, rows: NDArray[np.int64], of: NDArray[np.int64]) -> StoredMaps:
    """Some of the maps.

    Parameters
    ----------
    maps : PostureMaps
    rows : (n,) int
        Samples that the maps are of.
    of : (c,) int
        Which of them to store, as indices into `rows`, so that their rows ascend.
    """
    k = len(maps.rotations)
    first = (of[:, None] * k + np.arange(k)).reshape(-1)
    begin, end = maps.offset[first], maps.offset[first + 1]
    count = end - begin
    owner = np.repeat(np.arange(len(first)), count)
    at = np.arange(len(owner)) - np.repeat(np.cumsum(count) - count, count) + np.repeat(begin, count)
    tilt = np.degrees(maps.free[at]) / END
    low = np.ceil(tilt[:, 0] - _ROUNDING).astype(np.int64)
    high = np.floor(tilt[:, 1] + _ROUNDING).astype(np.int64)
    valid = low <= high
    # What is too narrow for a step is not shown free; it counts as undecided.
    unsure = np.degrees(maps.undecided[of].astype(float)).reshape(-1)
    np.add.at(unsure, owner[~valid], END * (tilt[~valid, 1] - tilt[~valid, 0]))
    halves = np.minimum(255, np.ceil(unsure / UNDECIDED - _ROUNDING))
    return StoredMaps(
        rows[of].astype(np.uint32),
        np.bincount(owner[valid], minlength=len(first)).reshape(-1, k).astype(np.uint8),
        np.stack([low[valid], high[valid]], axis=1).astype(np.uint16),
        halves.reshape(-1, k).astype(np.uint8),
    )
