"""Labels: the operation that each sample goes with, so that the cutting and the overlap at the borders take little time.

A border between two operations is cut twice, over the width of the overlap: what that costs is weighed against what each sample
costs with each operation. The sum is made small by alpha expansion: for one operation after the other, a least cut says which
samples change to it (Boykov, Veksler, Zabih 2001). An operation that does not serve a sample costs too much to be ever taken.
"""

from collections import Counter
from heapq import heapify, heappop, heappush
from itertools import cycle, islice

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_array
from scipy.sparse.csgraph import breadth_first_order, connected_components, maximum_flow

from cad_io.arrays import Floats, Ints

#: The largest whole number of a capacity of a cut; sums of some of them must not pass 2^31.
_MOST = 2**28
#: Rounds over all operations.
_ROUNDS = 5


def labelled(cost: Floats, edge: Ints, border: Floats) -> Ints:
    """Choose an operation for each sample.

    Parameters
    ----------
    cost : (n, k) float
        Of cutting each sample with each operation; infinite where the operation does not serve it.
    edge : (e, 2) int
        Pairs of neighbouring samples.
    border : (e,) float
        What it costs if the two have different operations, in the same unit.

    Returns
    -------
    (n,) int32
        Index of the operation, -1 where none serves the sample: never one that does not serve it.
    """
    served = np.isfinite(cost).any(axis=1)
    label = np.full(len(cost), -1, np.int32)
    rows = np.flatnonzero(served)
    if not len(rows):
        return label
    at = np.full(len(cost), -1, np.int64)
    at[rows] = np.arange(len(rows))
    inner = (at[edge] >= 0).all(axis=1)
    pair, weight, price = at[edge[inner]], border[inner], cost[rows]
    cheapest = price.argmin(axis=1)
    # Costs as whole numbers: the largest that a cut can need stays below _MOST.
    largest = float(price[np.isfinite(price)].max()) + float(np.bincount(pair.ravel(), np.repeat(weight, 2)).max(initial=0.0))
    scale = 0.25 * _MOST / max(largest, 1e-300)
    units, sides = (
        np.where(np.isfinite(price), np.rint(price * scale), _MOST).astype(np.int64),
        np.rint(weight * scale).astype(np.int64),
    )
    least, since = _energy(units, pair, sides, cheapest), 0
    # An operation is tried again only where another has changed something since.
    for operation in islice(cycle(range(price.shape[1])), _ROUNDS * price.shape[1]):
        tried = _expanded(units, pair, sides, cheapest, operation)
        energy = _energy(units, pair, sides, tried)
        since += 1
        if energy < least:
            cheapest, least, since = tried, energy, 1
        if since == price.shape[1]:
            break
    label[rows] = cheapest
    assert np.isfinite(cost[rows, cheapest]).all(), "an operation that does not serve a sample was chosen"
    return label


def _energy(units: NDArray[np.int64], pair: NDArray[np.int64], sides: NDArray[np.int64], label: NDArray[np.int64]) -> int:
    parted = label[pair[:, 0]] != label[pair[:, 1]]
    return int(units[np.arange(len(label)), label].sum() + sides[parted].sum())


def _expanded(
    units: NDArray[np.int64], pair: NDArray[np.int64], sides: NDArray[np.int64], label: NDArray[np.int64], operation: int
) -> NDArray[np.int64]:
    """The best labels of which each is kept or becomes one operation."""
    # Only what may change is in the cut: beside what stays, a pair is a cost of the one sample alone.
    may = (label != operation) & (units[:, operation] < _MOST)
    open_, at = np.flatnonzero(may), np.cumsum(may) - 1
    if not len(open_):
        return label
    i, j = pair.T
    change = units[open_, operation] - units[open_, label[open_]]
    apart = np.where(label[i] != label[j], sides, 0)
    for mine, other in ((i, j), (j, i)):
        alone = may[mine] & ~may[other]
        then = np.where(label[other[alone]] != operation, sides[alone], 0)
        np.add.at(change, at[mine[alone]], then - apart[alone])
    both = may[i] & may[j]
    # With x = 1 where a sample changes, such a pair costs apart + x_i (side - apart) - x_j side + (1 - x_i) x_j (2 side - apart).
    i, j, side, apart = at[i[both]], at[j[both]], sides[both], apart[both]
    np.add.at(change, i, side - apart)
    np.add.at(change, j, -side)
    change = np.clip(change, -_MOST, _MOST)
    source = len(open_)
    sink = source + 1
    up, down = np.flatnonzero(change > 0), np.flatnonzero(change < 0)
    tail = np.concatenate([np.full(len(up), source), down, i])
    head = np.concatenate([up, np.full(len(down), sink), j])
    size = np.concatenate([change[up], -change[down], np.minimum(2 * side - apart, _MOST)]).astype(np.int32)
    graph = coo_array((size, (tail, head)), shape=(sink + 1, sink + 1)).tocsr()
    flow = maximum_flow(graph, source, sink).flow
    residual = (graph - flow).tocsr()
    residual.data[residual.data < 0] = 0
    residual.eliminate_zeros()
    result = label.copy()
    changed = np.ones(sink + 1, bool)
    changed[breadth_first_order(residual, source, return_predecessors=False)] = False
    result[open_[changed[:source]]] = operation
    return result


def pieces(label: Ints, edge: Ints) -> Ints:
    """Connected samples of one operation (n,), numbered from 0; -1 where there is none."""
    same = (label[edge[:, 0]] == label[edge[:, 1]]) & (label[edge[:, 0]] >= 0)
    a, b = edge[same].T
    graph = coo_array((np.ones(len(a), np.int8), (a, b)), shape=(len(label), len(label)))
    components = connected_components(graph, directed=False)[1]
    number = np.full(len(label), -1, np.int32)
    mine = label >= 0
    number[mine] = np.unique(components[mine], return_inverse=True)[1]
    return number


def regions_of(label: Ints, edge: Ints, area: Floats) -> Ints:
    """Number (n,) the connected samples of one operation from 0, by operation, the largest first; -1 where there is none."""
    number = pieces(label, edge)
    mine = number >= 0
    size = np.bincount(number[mine], area[mine])
    first = np.unique(number[mine], return_index=True)[1]
    order = np.lexsort((first, -size, label[mine][first]))
    place = np.append(np.argsort(order), -1).astype(np.int32)
    return np.asarray(place[number])


def joined(label: Ints, serves: NDArray[np.bool_], edge: Ints, area: Floats, least: float) -> Ints:
    """Let pieces smaller than an area go over to a neighbouring operation that serves all of them, where there is one.

    The smallest goes first. Pieces that no neighbour serves stay: they are listed as they are.
    """
    label, number = label.copy(), pieces(label, edge)
    mine = number >= 0
    size = np.bincount(number[mine], area[mine]).tolist()
    ends = np.cumsum(np.bincount(number[mine]))[:-1]
    rows_of = [each.tolist() for each in np.split(np.flatnonzero(mine)[np.argsort(number[mine], kind="stable")], ends)]
    both = np.concatenate([edge, edge[:, ::-1]])
    adjacency = coo_array((np.ones(len(both), np.int8), both.T), shape=(len(label), len(label))).tocsr()
    neighbours = [each.tolist() for each in np.split(adjacency.indices, adjacency.indptr[1:-1])]
    waiting = [(each, piece) for piece, each in enumerate(size) if each < least]
    heapify(waiting)
    while waiting:
        known, piece = heappop(waiting)
        # What another piece has joined has another size, or none.
        if known != size[piece]:
            continue
        # Most pieces are a sample or two, for which arrays would take ten times as long.
        rows = rows_of[piece]
        others = [(label.item(k), number.item(k)) for row in rows for k in neighbours[row]]
        others = [(its, other) for its, other in others if its >= 0 and other != piece]
        touching = Counter(its for its, _ in others)
        to = next((each for each in sorted(touching, key=lambda own: (-touching[own], own)) if serves[rows, each].all()), -1)
        if to < 0:
            continue
        into = sorted({other for its, other in others if its == to})
        whole = max(into, key=lambda each: len(rows_of[each]))
        for each in [piece, *into]:
            if each != whole:
                number[rows_of[each]] = whole
                rows_of[whole] += rows_of[each]
                size[whole], size[each] = size[whole] + size[each], -1.0
        label[rows] = to
        # Those beside it may have somewhere to go now.
        for each in {whole, *(other for _, other in others)}:
            if 0.0 <= size[each] < least:
                heappush(waiting, (size[each], each))
    return label
