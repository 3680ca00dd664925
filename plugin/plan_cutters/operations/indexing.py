"""How long the rotary axes take to come to the orientations of operations."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import product

import numpy as np
from numpy.typing import NDArray

from cad_io.arrays import Floats
from plan_cutters.domain.operations import INDEX_TIME, Columns, IndexFrom
from plan_cutters.operations.candidates import DIGITS, Orientations
from plan_cutters.operations.problem import Turning

#: Positions of which the best order is looked for among all orders; of more, the nearest one comes next.
MOST = 12


@dataclass(frozen=True, slots=True)
class Indexing:
    """Another orientation takes the time that was given, else that of the rotary axes by their rates, else 5 s.

    Attributes
    ----------
    orientations : tuple of Orientations
        Of each setup.
    given : float, optional
        Seconds.
    """

    orientations: tuple[Orientations, ...]
    given: float | None

    @property
    def rate(self) -> Floats | None:
        """Rates (2,) of the rotary axes, rad/s, where they count; None: each orientation takes `constant`."""
        rates = [axis.rate for axis in self.orientations[0].conditions.machine.rotary]
        known = len(rates) == 2 and all(each is not None and 0.0 < each < math.inf for each in rates)
        return np.array(rates, float) if known and self.given is None else None

    @property
    def constant(self) -> float:
        """Seconds of an orientation where rates do not count."""
        return INDEX_TIME if self.given is None else self.given

    @property
    def source(self) -> IndexFrom:
        """Name what the seconds follow from."""
        return "given" if self.given is not None else "assumed" if self.rate is None else "rates"

    def times(self, setup: int, positions: Sequence[Sequence[Floats]]) -> Floats:
        """Times (k,), s, of positions of one cutter in a setup, each with its solutions (2,), deg; it begins with all at zero."""
        rate = self.rate
        if rate is None or not len(positions):
            return np.full(len(positions), self.constant)
        limit = self.orientations[setup].kinematics.limit
        return index_times([np.radians(each) for each in positions], limit, rate)

    def together(self, columns: Columns) -> float:
        """Time, s, of all columns: each cutter in each setup begins with the rotary axes at zero."""
        seconds = 0.0
        for c, s in {*zip(columns.cutter.tolist(), columns.setup.tolist(), strict=True)}:
            mine = columns.of(np.flatnonzero((columns.cutter == c) & (columns.setup == s)))
            others = self.orientations[s].others(mine.axis, mine.angle)
            both = [[angle] if other is None else [angle, other] for angle, other in zip(mine.angle, others, strict=True)]
            seconds += float(self.times(s, both).sum())
        return seconds

    def turning(self, columns: Columns) -> Turning | None:
        """Say what choices of columns take by the rates of the rotary axes; None where each orientation takes the same."""
        if self.rate is None:
            return None
        return Turning(lambda chosen: self.together(columns.of(chosen)), self.from_zero(columns))

    def from_zero(self, columns: Columns) -> Floats:
        """Time (m,), s, that the axes take at least from zero to each column, in any order of any choice; 0 without rates.

        Whole turns count for nothing, and neither do the digits that a control leaves out.
        """
        rate, seconds = self.rate, np.zeros(len(columns))
        if rate is None:
            return seconds
        for s in np.unique(columns.setup).tolist():
            mine, moved = np.flatnonzero(columns.setup == s), self.orientations[s].kinematics
            angle, _, singular = moved.positions(columns.axis[mine])
            turn = np.abs((angle - _start(moved.limit) + math.pi) % (2.0 * math.pi) - math.pi)
            turn = np.maximum(0.0, turn - math.radians(10.0**-DIGITS))
            # What is near to the first axis may be held with any angle of it.
            turn[singular, :, 0] = 0.0
            seconds[mine] = np.nan_to_num((turn / rate).max(axis=2), nan=math.inf).min(axis=1)
        return np.where(np.isfinite(seconds), seconds, 0.0)


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
    places = np.concatenate([_start(limit)[None], *turned])
    step = np.abs(places[:, None] - places)
    step = np.where(endless, np.minimum(step % (2.0 * math.pi), -step % (2.0 * math.pi)), step)
    seconds = (step / rate).max(axis=2)
    order = _best_order(seconds, owner) if len(turned) <= MOST else _nearest(seconds, owner)
    times, before = np.zeros(len(turned)), 0
    for place in order:
        times[owner[place]], before = seconds[before, place + 1], place + 1
    return times


def _start(limit: Floats) -> Floats:
    """Angles (2,) at which the axes begin: zero, or what is next to it within their limits."""
    return np.asarray(np.clip(0.0, *np.where(np.isfinite(limit).all(axis=1, keepdims=True), limit, 0.0).T))


def _turns(solutions: Floats, limit: Floats, endless: NDArray[np.bool_]) -> Floats:
    """Solutions (s, 2) with all turns of theirs (t, 2) within limits, up to one turn from zero."""
    whole, turns = 2.0 * math.pi, list[tuple[float, ...]]()
    for each in solutions.tolist():
        ways = []
        for k, angle in enumerate(each):
            shifted = [angle] if endless[k] else [angle + whole * turn for turn in (-2, -1, 0, 1, 2)]
            low, high = limit[k]
            near = [a for a in shifted if low - 1e-9 <= a <= high + 1e-9 and (a == angle or abs(a) <= whole + 1e-9)]
            ways.append(near or [angle])
        turns += product(*ways)
    return np.array(turns)


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
    order, unvisited, before = list[int](), set(owner.tolist()), 0
    while unvisited:
        ways = np.where(np.isin(owner, list(unvisited)), seconds[before, 1:], np.inf)
        place = int(ways.argmin())
        order.append(place)
        unvisited.discard(int(owner[place]))
        before = place + 1
    return order
