"""Motion: how far a tool can go over the surface without being lifted off, estimated from posture maps.

A free interval of tilts at one rotation of one sample is a node. Two nodes are joined where a posture of one is one of the other:
at neighbouring rotations of a sample, and at neighbouring samples. What is joined is one component: it may be that the tool can
go from each of its postures to any other in contact. It is an estimate, for nothing is known between rotations and between
samples (`docs/motion.md`).
"""

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from cad_io.arrays import Floats, Ints
from plan_cutters.domain.posture import tilt_direction
from plan_cutters.operations.cover import fewest
from plan_cutters.operations.forced_steps import RESOLUTION, forced_steps
from plan_cutters.operations.free_tilts import cells_of, full_turn, holding, postures_of
from plan_cutters.plan_file.operations import MotionEntry
from plan_cutters.scene.preparation import Prepared
from plan_cutters.stages.posture_maps import PostureMaps

Rows = NDArray[np.int64]
#: Postures of a sample that are looked for at its neighbours at once.
_AT_ONCE = 400_000
#: Largest components against which the others are compared, and the largest table of samples and components.
_COMPARED, _TABLE = 32, 50_000_000


def motion(maps: PostureMaps, ready: Prepared) -> MotionEntry | str:
    """Estimate how the postures of one cutter in the first setup hang together.

    Parameters
    ----------
    maps : PostureMaps
        Of any machine: what this one does not hold is left out here.
    ready : Prepared

    Returns
    -------
    MotionEntry or str
        In words why nothing can be said, where the maps leave samples out.
    """
    if maps.unmapped:
        return (
            f"Nothing is said about motion: the postures of {maps.unmapped} samples were not mapped. Give --map-budget, or "
            "sample more coarsely (--spacing)."
        )
    mine, samples = maps.held(ready.conditions), ready.samples
    area = np.where(ready.finished, np.nan_to_num(samples.area), 0.0)
    # Neighbours on other surfaces than that of the finished part lead nowhere.
    edge = samples.neighbours[ready.finished[samples.neighbours].all(axis=1)].astype(np.int64)
    loose, strict = components(mine, edge)
    sample = cells_of(mine) // len(mine.rotations)
    finished = ready.finished[sample]
    touched = np.unique(np.column_stack([loose[finished], sample[finished]]), axis=0)
    reached = np.zeros(len(samples), bool)
    reached[touched[:, 1]] = True
    size = np.asarray(np.bincount(touched[:, 0], area[touched[:, 1]], int(loose.max(initial=-1)) + 1), float)
    largest = int(size.argmax()) if len(size) else -1
    needed, at_least = _needed(touched, size)
    whole = float(area.sum())
    ways = ready.conditions.kinematics
    turning = ways is not None and len(ways.turning()[1]) == 2
    return MotionEntry(
        cutter=maps.cutter,
        components=len(np.unique(touched[:, 0])),
        components_strict=len(np.unique(strict[finished])),
        largest_share=min(1.0, float(size[largest]) / whole) if largest >= 0 and whole > 0.0 else 0.0,
        needed=needed,
        needed_at_least=at_least,
        outside=int(reached.sum() - (touched[:, 0] == largest).sum()),
        without=int((ready.finished & ~reached).sum()),
        forced_steps=forced_steps(mine, samples, ways, reached) if ways is not None and turning else [],
        resolution_deg=RESOLUTION,
    )


def components(maps: PostureMaps, edge: Rows) -> tuple[Ints, Ints]:
    """The component (m,) of each free interval, by loose and by strict joins.

    A posture that is looked for at a neighbour lies between two of its rotations. It is joined loosely if one of them has its
    tilt free, strictly if both have.

    Parameters
    ----------
    maps : PostureMaps
    edge : (e, 2) int64
        Neighbouring samples.
    """
    own = np.concatenate([np.zeros((0, 2), np.int64), *_turned(maps)])
    loose, strict = [own], [own]
    for node, neighbour in _moved(maps, edge):
        there = neighbour >= 0
        loose += [np.column_stack([node[there[:, k]], neighbour[there[:, k], k]]) for k in range(2)]
        both = there.all(axis=1)
        strict += [np.column_stack([node[both], neighbour[both, k]]) for k in range(2)]
    return _labels(loose, len(maps.free)), _labels(strict, len(maps.free))


def _labels(pairs: list[Rows], count: int) -> Ints:
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import connected_components

    joined = np.concatenate(pairs)
    graph = coo_array((np.ones(len(joined), np.int8), (joined[:, 0], joined[:, 1])), shape=(count, count)).tocsr()
    return np.asarray(connected_components(graph, directed=False)[1], np.int32)


def _turned(maps: PostureMaps) -> Iterator[Rows]:
    """Pairs of intervals of one sample at neighbouring rotations that overlap."""
    k, start = len(maps.rotations), maps.offset[:-1]
    count = np.diff(maps.offset)
    cell = np.arange(len(count))
    neighbours = cell - cell % k + (cell + 1) % k
    if not full_turn(maps):
        cell, neighbours = cell[cell % k < k - 1], neighbours[cell % k < k - 1]
    most = int(count.max(initial=0))
    for i in range(most):
        for j in range(most):
            both = (count[cell] > i) & (count[neighbours] > j)
            one, other = start[cell[both]] + i, start[neighbours[both]] + j
            low = np.maximum(maps.free[one, 0], maps.free[other, 0])
            meet = low <= np.minimum(maps.free[one, 1], maps.free[other, 1])
            yield np.column_stack([one[meet], other[meet]])


def _moved(maps: PostureMaps, edge: Rows) -> Iterator[tuple[Rows, Rows]]:
    """Intervals (p,) and those (p, 2) of a neighbour that hold one of their postures, at the rotations beside it; -1: none."""
    k = len(maps.rotations)
    first, last = maps.offset[:-1:k], maps.offset[k::k]
    ways = np.concatenate([edge, edge[:, ::-1]])
    count = (last - first)[ways[:, 0]]
    pieces = np.searchsorted(np.cumsum(count), np.arange(_AT_ONCE, int(count.sum()) + _AT_ONCE, _AT_ONCE))
    cell = cells_of(maps)
    begin = 0
    for end in [*(pieces + 1).tolist(), len(ways)]:
        piece, begin = ways[begin:end], max(begin, end)
        number = (last - first)[piece[:, 0]]
        node = np.repeat(first[piece[:, 0]], number) + _ranks(number)
        to = np.repeat(piece[:, 1], number)
        tilt_directions = tilt_direction(
            maps.normal[cell[node] // k], maps.direction_max[cell[node] // k], maps.rotations[cell[node] % k]
        )
        for part in (0.1, 0.5, 0.9):
            tilt = (1.0 - part) * maps.free[node, 0] + part * maps.free[node, 1]
            axis = np.cos(tilt)[:, None] * maps.normal[cell[node] // k] + np.sin(tilt)[:, None] * tilt_directions
            # As axes: the directions from which rotations count differ from sample to sample.
            yield node, holding(maps, to, *postures_of(maps, to, axis))


def _ranks(number: Rows) -> Rows:
    """0, 1, 2 ... for each of some counts."""
    return np.arange(int(number.sum())) - np.repeat(np.cumsum(number) - number, number)


def _needed(touched: Rows, size: Floats) -> tuple[int, int]:
    """The least number of components that touch everything, and how few there can be; of pairs (p, 2) component, sample."""
    if not len(touched):
        return 0, 0
    of: dict[int, set[int]] = {}
    for component, sample in touched.tolist():
        of.setdefault(component, set()).add(sample)
    order = sorted(of, key=lambda each: -size[each])
    # A component that touches nothing but what another one touches is not needed.
    needed = list[int]()
    for each in order:
        if not any(of[each] <= of[other] for other in needed[:_COMPARED]):
            needed.append(each)
    place = {component: k for k, component in enumerate(needed)}
    rows: dict[int, list[int]] = {}
    for component in needed:
        for sample in of[component]:
            rows.setdefault(sample, []).append(place[component])
    patterns = sorted({tuple(each) for each in rows.values()})
    if len(patterns) * len(needed) > _TABLE:
        alone = len({each for each in patterns if len(each) == 1})
        return len(needed), max(1, alone)
    table = np.zeros((len(patterns), len(needed)), bool)
    for i, pattern in enumerate(patterns):
        table[i, list(pattern)] = True
    cover = fewest(table)
    return len(cover.chosen), cover.at_least
