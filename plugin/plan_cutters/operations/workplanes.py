"""The tilted planes of operations, and how long the rotary axes take from one to the next."""

import math
from collections.abc import Sequence
from itertools import product

import numpy as np
from numpy.typing import NDArray

from cad_io.arrays import Floats
from plan_cutters.domain.operations import Operation, Workplane
from plan_cutters.domain.placement import frame_of
from plan_cutters.operations.candidates import Orientations
from plan_cutters.scene.preparation import Prepared

#: Positions of which the best order is looked for among all orders; of more, the nearest one comes next.
MOST = 12


def workplanes(
    operations: Sequence[Operation], ready: Prepared, orientations: Sequence[Orientations]
) -> tuple[Workplane | None, ...]:
    """The plane of each operation with a fixed axis, None for others.

    Operations of one cutter in one setup follow each other, in the order in which the rotary axes need least time; the first one
    starts with these at zero.
    """
    options = ready.options
    placements = (options.placement, *(options.other_placements or (None,) * len(options.other_setups)))
    planes: list[Workplane | None] = [None] * len(operations)
    groups: dict[tuple[int, str], list[int]] = {}
    for i, each in enumerate(operations):
        if each.axis is not None:
            groups.setdefault((each.setup, each.cutter.id), []).append(i)
    for (s, _), mine in groups.items():
        where = orientations[s]
        conditions, moved = where.conditions, where.kinematics
        rates = [axis.rate for axis in conditions.machine.rotary]
        timed = len(rates) == 2 and all(rate is not None and rate > 0.0 for rate in rates)
        index = np.full(len(mine), options.index_time)
        if timed:
            known = [
                [each for each in (operations[i].angle, operations[i].other_angle) if each is not None] for i in mine
            ]
            index = index_times([np.radians(each) for each in known], moved.limit, np.array(rates, float))
        origin = (
            np.zeros(3) if (place := placements[s]) is None or place.origin is None else np.array(place.origin, float)
        )
        across = frame_of(conditions.setup, conditions.x)[0]
        for i, seconds in zip(mine, index.tolist(), strict=True):
            axis, angle = operations[i].axis, operations[i].angle
            assert axis is not None, "a group holds fixed axes"
            assert angle is not None, "a fixed axis has angles"
            x = frame_of(axis, moved.carried(across, np.radians(angle)[None])[0])[0]
            planes[i] = Workplane(origin, x, axis, seconds, timed)
    return tuple(planes)


def index_times(positions: Sequence[Floats | Sequence[Floats]], limit: Floats, rate: Floats) -> Floats:
    """Times (k,), s, in which rotary axes come to each of some positions, in the order that takes least in all.

    The slowest axis counts. An axis without a limit on one side takes the shorter way round; of one with limits, all turns within
    them count, up to one from zero. Up to `MOST` positions all orders are compared; of more, the nearest one comes next.

    Parameters
    ----------
    positions : sequence of (s, 2) float
        The solutions of each position, rad.
    limit : (2, 2) float
        Least and largest angle of each axis, rad; infinite: none.
    rate : (2,) float
        rad/s.
    """
    endless: NDArray[np.bool_] = np.asarray(~np.isfinite(limit).all(axis=1))
    turned = [_turns(np.atleast_2d(each), limit, endless) for each in positions]
    owner = np.repeat(np.arange(len(turned)), [len(each) for each in turned])
    start = np.where(endless, 0.0, np.clip(0.0, *np.where(endless[:, None], 0.0, limit).T))
    places = np.concatenate([start[None], *turned])
    step = np.abs(places[:, None] - places)
    step = np.where(endless, np.minimum(step % (2.0 * math.pi), -step % (2.0 * math.pi)), step)
    seconds = (step / rate).max(axis=2)
    order = _best_order(seconds, owner) if len(turned) <= MOST else _nearest(seconds, owner)
    found, before = np.zeros(len(turned)), 0
    for place in order:
        found[owner[place]], before = seconds[before, place + 1], place + 1
    return found


def _turns(solutions: Floats, limit: Floats, endless: NDArray[np.bool_]) -> Floats:
    """Solutions (s, 2) with all turns of theirs (t, 2) within limits, up to one turn from zero."""
    whole, found = 2.0 * math.pi, list[tuple[float, ...]]()
    for each in solutions.tolist():
        ways = []
        for k, angle in enumerate(each):
            shifted = [angle] if endless[k] else [angle + whole * turn for turn in (-2, -1, 0, 1, 2)]
            low, high = limit[k]
            near = [a for a in shifted if low - 1e-9 <= a <= high + 1e-9 and (a == angle or abs(a) <= whole + 1e-9)]
            ways.append(near or [angle])
        found += product(*ways)
    return np.array(found)


def _best_order(seconds: Floats, owner: NDArray[np.int64]) -> list[int]:
    """The order of least time by dynamic programming: places, one an owner."""
    k = int(owner.max(initial=-1)) + 1
    n, bit = len(owner), 1 << owner
    cost, came = np.full((1 << k, n), np.inf), np.full((1 << k, n), -1, np.int32)
    cost[bit, np.arange(n)] = seconds[0, 1:]
    between = seconds[1:, 1:]
    for done in range(1, 1 << k):
        inside = np.flatnonzero((bit & done) > 0)
        if done & (done - 1) == 0:
            continue
        for each in range(k):
            if not done >> each & 1:
                continue
            here, before = inside[owner[inside] == each], inside[owner[inside] != each]
            ways = cost[done ^ (1 << each)][before, None] + between[np.ix_(before, here)]
            cost[done, here], came[done, here] = ways.min(axis=0), before[ways.argmin(axis=0)]
    order, done = list[int](), (1 << k) - 1
    place = int(cost[done].argmin())
    while place >= 0:
        order.append(place)
        place, done = int(came[done, place]), done ^ int(bit[place])
    return order[::-1]


def _nearest(seconds: Floats, owner: NDArray[np.int64]) -> list[int]:
    order, left, before = list[int](), set(owner.tolist()), 0
    while left:
        ways = np.where(np.isin(owner, list(left)), seconds[before, 1:], np.inf)
        place = int(ways.argmin())
        order.append(place)
        left.discard(int(owner[place]))
        before = place + 1
    return order
