"""The share of the area that one, two, three ... fixed orientations serve, and the most that so many can.

What columns serve together grows by less and less (it is submodular), so what k columns add to any set of columns is at most
the sum of the k largest gains: the least of such sums over the prefixes of a greedy choice bounds the best k columns. It
is a bound where the table has all samples; else columns are chosen by some samples, and their shares measured at all.
"""

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from cad_io.arrays import Floats
from plan_cutters.domain.columns import Columns
from plan_cutters.domain.operations import Fewest, Step
from plan_cutters.operations.probes import Probes
from plan_cutters.scene.threads import Progress, part_of

Known = tuple[Columns, NDArray[np.int64], NDArray[np.bool_], Floats]
#: Tests that a table of all samples may take.
_TESTS = 300_000


def curve(
    probes: Probes,
    fewest: Fewest,
    rows: NDArray[np.int64],
    area: Floats,
    whole: float,
    some: Callable[[Progress], Known],
    *,
    progress: Progress | None = None,
) -> tuple[Step, ...]:
    """Steps of the greedy choice by area, as many as the cover has columns.

    Parameters
    ----------
    probes : Probes
    fewest : Fewest
    rows : (r,) int64
        Samples that are reached.
    area : (n,) float
        Of all samples, mm2.
    whole : float
        Area that shares are of, mm2.
    some : callable
        Told how to tell its progress, gives columns, among them the cover's, their numbers, where each serves some samples
        (s, columns), and the area (s,) that each of these stands for: columns are chosen by these where the table of all samples
        is large.
    progress : callable, optional
        Called with how much is done, of how much.
    """
    tell = progress or (lambda done, total: None)
    parts = [part_of(tell, k, 5) for k in range(5)]
    most = len(fewest.chosen)
    if not most or not len(rows):
        return ()
    size = np.nan_to_num(area[rows])
    if len(rows) * len(fewest.columns) <= _TESTS:
        columns, table, weight = fewest.columns, probes.table(rows, fewest.columns, parts[0]).T.astype(np.float32), size
        order = _order(table, weight, most, parts[1])
        bound = _bound(table, weight, order, parts[2]) / max(whole, 1e-300)
    else:
        columns, _, known, weight = some(parts[0])
        table = known.T.astype(np.float32)
        order, bound = _order(table, weight, most, parts[1]), None
    chosen = np.flatnonzero(np.isin(columns.key, fewest.columns.of(fewest.chosen).key))
    own = chosen[_order(table[chosen], weight, most, parts[3])]
    orders = enumerate((np.array(order, np.int64), own))
    ways = [probes.kept(rows, columns.of(each), part_of(parts[4], k, 2)) for k, each in orders]
    steps = []
    for k in range(most):
        share = min(1.0, max(float(size[way[:, : k + 1].any(axis=1)].sum()) for way in ways) / max(whole, 1e-300))
        steps.append(Step(k + 1, share, None if bound is None else min(1.0, max(share, float(bound[k])))))
    return tuple(steps)


def _order(table: NDArray[np.float32], size: Floats, most: int, tell: Progress) -> list[int]:
    """Columns in the order of how much each serves of what those before it leave."""
    open_size, order = size.astype(np.float32), list[int]()
    for k in range(most):
        tell(k, most)
        gain = table @ open_size
        gain[order] = -1.0
        order.append(int(gain.argmax()))
        open_size = open_size * (1.0 - table[order[-1]])
    return order


def _bound(table: NDArray[np.float32], size: Floats, order: list[int], tell: Progress) -> Floats:
    """The most area (k,) that one, two, three ... columns serve."""
    most, open_size, have = np.full(len(order), np.inf), size.astype(np.float32), 0.0
    for k, column in enumerate([*order, -1]):
        tell(k, len(order) + 1)
        gain = np.sort(table @ open_size)[::-1][: len(order)]
        cumulated = have + np.cumsum(gain, dtype=float)
        most[: len(cumulated)] = np.minimum(most[: len(cumulated)], cumulated)
        most[len(cumulated) :] = np.minimum(most[len(cumulated) :], cumulated[-1])
        if column >= 0:
            have += float((open_size * table[column]).sum())
            open_size = open_size * (1.0 - table[column])
    # Sums of single precision are rounded up.
    return np.asarray(most * (1.0 + 1e-5))
