"""Orientations that a machine can be set to in a setup, those that are tried first, and how long the rotary axes take to come to
them.

Angles are rounded to the digits of a control before anything is probed, so what is proved is the orientation that is set.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import product

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from cad_io.arrays import Floats, SurfaceSamples
from plan_cutters.domain.kinematics import Kinematics, turned
from plan_cutters.domain.operations import INDEX_TIME, Columns, IndexFrom
from plan_cutters.domain.own_process import CONTROL_DIGITS as DIGITS
from plan_cutters.operations.fastest import Turning
from plan_cutters.scene.conditions import Conditions

#: A direction is along a rotary axis where their cosine is less below 1 than this: 0.008 deg.
_ALONG = 1e-8
#: Sums of angles that differ by less are the same position, and limits that do leave an axis one angle, deg.
_SAME_DEG, _STILL = 0.01, 1e-9
#: Distance of grid angles unless one is requested, rad.
STEP = math.radians(5.0)
#: Tool axes nearer than this are one, rad.
_SAME = math.radians(10.0**-DIGITS)
#: Faces whose directions are looked at, at most, the largest first, and how far normals of a plane may differ.
_FACES, _EVEN = 200, 1e-9


@dataclass(frozen=True, slots=True)
class Orientations:
    """The orientations that a machine can be set to in one setup.

    `kinematics`: the machine's; one that turns about the setup axis and across it where the machine names none. `names`: of its
    axes, two at most.
    """

    conditions: Conditions
    kinematics: Kinematics
    names: tuple[str, ...]

    @classmethod
    def of(cls, conditions: Conditions) -> "Orientations":
        """Find those of a machine."""
        machine, kinematics = conditions.machine, conditions.kinematics
        if kinematics is None:
            frame = conditions.frame
            free = np.full((2, 2), math.inf) * (-1.0, 1.0)
            return cls(conditions, Kinematics(frame[[2, 1]], free, frame[2]), ("azimuth", "tilt"))
        return cls(conditions, kinematics, tuple(axis.name for axis in machine.rotary))

    @property
    def turning(self) -> int:
        """How many of its axes turn the tool."""
        return len(self.kinematics.turning()[1])

    def set_to(self, angle: Floats) -> tuple[Floats, Floats]:
        """Angles (n, k), deg, as a control shows them, and their axes (n, 3): those alone that the machine can hold."""
        shown, axis, held = self._shown(angle)
        return shown[held], axis[held]

    def _shown(self, angle: Floats) -> tuple[Floats, Floats, NDArray[np.bool_]]:
        """The same for all angles, and which (n,) of them can be held; an axis that stands still has the angle of its limits."""
        low, high = np.degrees(self.kinematics.limit).T
        shown = np.where(high - low <= _STILL, low, np.round(angle, DIGITS)) + 0.0
        axis = self.kinematics.axis(np.radians(shown))
        held = self.conditions.allows(axis) & ((shown >= low - _STILL) & (shown <= high + _STILL)).all(axis=1)
        return shown, axis, np.asarray(held)

    def along(self, direction: Floats) -> float:
        """+1 or -1 where the axis next to the part turns it about a direction, or the other way; else 0."""
        if not self.names:
            return 0.0
        cosine = float(self.kinematics.direction[0] @ direction)
        return math.copysign(1.0, cosine) if abs(cosine) > 1.0 - _ALONG else 0.0

    def turned(self, angle: Floats, direction: Floats, turn: float) -> tuple[Floats, Floats, NDArray[np.bool_]]:
        """Angles (n, k), deg, with the part turned about a direction, rad, by the axis next to it: the axes, and which can be."""
        along, wanted = self.along(direction), np.array(angle)
        first = wanted[:, :1] + math.degrees(turn) * along
        wanted[:, :1] = first - 360.0 * np.round(first / 360.0)
        shown, axis, held = self._shown(wanted)
        still = np.abs(shown - wanted).max(axis=1, initial=0.0) > 10.0**-DIGITS
        return shown, axis, np.asarray(held & ~still & (along != 0.0))

    def near(self, axis: Floats) -> tuple[Floats, Floats]:
        """The angles that come nearest to axes (n, 3), and the axes that they hold: those alone that the machine can hold."""
        angle, taken, _ = self.kinematics.positions(axis)
        held = np.flatnonzero(taken >= 0)
        return self.set_to(np.degrees(angle[held, taken[held]]))

    def others(self, axis: Floats, angle: Floats) -> list[Floats | None]:
        """The other angles (k,), deg, that hold each of some axes (n, 3) beside its angles (n, k); None where there are none."""
        both = np.degrees(self.kinematics.positions(axis)[0])
        away = np.abs((both - angle[:, None] + 180.0) % 360.0 - 180.0).sum(axis=2)
        other = both[np.arange(len(both)), np.nan_to_num(away, nan=-1.0).argmax(axis=1)]
        there = np.isfinite(other).all(axis=1) & (np.nan_to_num(away, nan=-1.0).max(axis=1) > _SAME_DEG)
        return [shown if is_there else None for shown, is_there in zip(np.round(other, DIGITS) + 0.0, there, strict=True)]

    def about(self, axis: Floats, spacing: float) -> Floats:
        """Axes (m, 3) at an angle, rad, about each of some axes (n, 3): all about, or on the circle of a single rotary axis."""
        machine, turning = self.kinematics.turning()
        if len(turning) == 2:
            return neighbours(axis, spacing)
        ways = [turned(machine.direction[0], np.full(len(axis), side * spacing), axis) for side in (-1.0, 1.0) if turning]
        return np.concatenate([axis[:0], *ways])

    def grid(self, step: float) -> tuple[Floats, Floats]:
        """Angles (n, k) that are whole multiples of a step, deg, and their axes.

        Nearer to the first of two axes fewer multiples of its angle are taken, so that the axes are about equally far apart.
        """
        if len(self.names) < 2:
            only = [_multiples(limit, step) for limit in self.kinematics.limit]
            return self.set_to(np.column_stack(only) if only else np.zeros((1, 0)))
        start = self.kinematics.swing[0]
        turns = _multiples(self.kinematics.limit[1], step)
        axes = []
        for second in turns:
            arm = self.kinematics.axis(np.array([[0.0, math.radians(second)]]))[0]
            sine = float(np.linalg.norm(np.cross(arm, self.kinematics.direction[0])))
            every = max(1, int(1.0 / max(sine, 1e-9))) if sine > 1e-9 else 10**9
            first = _multiples(self.kinematics.limit[0], step)
            numbers = np.round(first / step).astype(np.int64)
            taken = first[numbers % every == 0] if len(first) > 1 else first
            axes.append(np.column_stack([taken, np.full(len(taken), second)]))
        angle = np.concatenate(axes)
        # Of the two solutions of an axis the one with the smaller second angle comes first, and stays.
        angle = angle[np.lexsort((np.abs(angle[:, 0]), np.abs(angle[:, 1] - math.degrees(start))))]
        return self.set_to(angle)


def _multiples(limit: Floats, step: float) -> Floats:
    """Whole multiples of a step, deg, within limits (2,), rad: one turn at most; of an axis that stands still its angle."""
    if np.degrees(limit[1] - limit[0]) <= _STILL:
        return np.degrees(limit[:1])
    low, high = max(float(np.degrees(limit[0])), -180.0), min(float(np.degrees(limit[1])), 180.0)
    whole = high - low >= 360.0 - 1e-9
    numbers = np.arange(math.ceil(low / step - 1e-9), math.floor(high / step + 1e-9) + 1)
    return np.asarray((numbers[1:] if whole and len(numbers) * step > 360.0 else numbers) * step, float)


def directions(samples: SurfaceSamples, setup: Floats) -> Floats:
    """Directions (n, 3) that a tool axis may well have: the part's axes, normals of planes, axes of revolved and ruled faces."""
    return np.concatenate([setup[None], np.eye(3), -np.eye(3), *face_directions(samples)])


def face_directions(samples: SurfaceSamples) -> tuple[Floats, Floats]:
    """Normals (n, 3) of plane faces, and directions (m, 3) of walls: axes of revolved and ruled faces. The largest face first."""
    floors, walls = list[Floats](), list[Floats]()
    judged = samples.unjudged < 0
    area = np.bincount(samples.face[judged], np.nan_to_num(samples.area[judged]))
    for number in np.argsort(-area, kind="stable")[:_FACES]:
        normal = samples.normal[judged & (samples.face == number)]
        if len(normal) and np.ptp(normal, axis=0).max() <= _EVEN:
            floors.append(normal[0])
        elif len(normal) > 3:
            spread, axes = np.linalg.svd(normal - normal.mean(axis=0), full_matrices=False)[1:]
            if spread[2] <= _EVEN * math.sqrt(len(normal)):
                walls += [axes[2], -axes[2]]
    return np.array(floors).reshape(-1, 3), np.array(walls).reshape(-1, 3)


def apart(axis: Floats, least: float = _SAME, old: Floats | None = None) -> NDArray[np.int64]:
    """Which (k,) of axes (n, 3) are at least an angle, rad, from all earlier ones, and from old ones (m, 3)."""
    chord = 2.0 * math.sin(0.5 * least)
    selected = np.ones(len(axis), bool)
    if old is not None and len(old):
        selected &= cKDTree(old).query(axis, distance_upper_bound=chord)[0] > chord
    tree = cKDTree(axis)
    for i in range(len(axis)):
        if selected[i]:
            near = np.array(tree.query_ball_point(axis[i], chord))
            selected[near[near > i]] = False
    return np.flatnonzero(selected)


def neighbours(axis: Floats, spacing: float) -> Floats:
    """Six axes (6 n, 3) at an angle, rad, about each of some axes (n, 3)."""
    other = np.where(np.abs(axis[:, 2:]) < 0.9, (0.0, 0.0, 1.0), (1.0, 0.0, 0.0))
    u = np.cross(axis, other)
    u /= np.linalg.norm(u, axis=1)[:, None]
    v = np.cross(axis, u)
    turn = np.arange(6) * (math.pi / 3.0)
    out = math.cos(spacing) * axis[:, None] + math.sin(spacing) * (
        np.cos(turn)[:, None] * u[:, None] + np.sin(turn)[:, None] * v[:, None]
    )
    return np.asarray(out.reshape(-1, 3))


def candidates(where: Orientations, samples: SurfaceSamples, step: float | None, spacing: float = STEP) -> tuple[Floats, Floats]:
    """The first candidates of one setup.

    `step`: angles are whole multiples of it, rad, where the machine's rotary axes lock at these alone. None: a grid, and the
    directions of the part. `spacing`: of that grid, rad. Returns `angle` (m, k) float: deg; `axis` (m, 3) float.
    """
    angle, axis = where.grid(math.degrees(spacing if step is None else step))
    if step is None:
        own_angle, own_axis = where.near(directions(samples, where.conditions.setup))
        angle, axis = np.concatenate([own_angle, angle]), np.concatenate([own_axis, axis])
    least, normal = math.cos(min(where.conditions.postures.tilt[1], math.pi)), samples.normal[samples.unjudged < 0]
    if not len(normal):
        return angle[:0], axis[:0]
    # Those that face at least one normal.
    selected = np.flatnonzero(1.0 - 0.5 * cKDTree(normal).query(axis)[0] ** 2 >= least - 1e-9)
    selected = selected[apart(axis[selected])]
    return angle[selected], axis[selected]


#: Positions of which the best order is looked for among all orders; of more, the nearest one comes next.
MOST = 12


@dataclass(frozen=True, slots=True)
class Indexing:
    """Another orientation takes the time that was given, else that of the rotary axes by their rates, else 5 s.

    `orientations`: of each setup. `given`: seconds.
    """

    orientations: tuple[Orientations, ...]
    given: float | None

    @property
    def rate(self) -> Floats | None:
        """Rates (k,) of the rotary axes, rad/s, where they count; None: each orientation takes `constant`.

        Without rotary axes there is nothing that takes time.
        """
        if not self.orientations[0].names:
            return np.zeros(0)
        return self.speeds if self.given is None else None

    @property
    def speeds(self) -> Floats | None:
        """Rates (k,) of the rotary axes, rad/s; None where the machine does not say all of them."""
        rates = [axis.rate for axis in self.orientations[0].conditions.machine.rotary]
        return np.array(rates, float) if rates and None not in rates else None

    @property
    def acceleration(self) -> Floats:
        """Accelerations (k,) of the rotary axes, rad/s2; infinite where the machine says none."""
        return np.array([axis.acceleration or math.inf for axis in self.orientations[0].conditions.machine.rotary])

    @property
    def constant(self) -> float:
        """Seconds of an orientation where rates do not count."""
        return INDEX_TIME if self.given is None else self.given

    @property
    def source(self) -> IndexFrom:
        """Name what the seconds follow from."""
        return "rates" if self.rate is not None else "assumed" if self.given is None else "given"

    def times(self, setup: int, positions: Sequence[Sequence[Floats]]) -> Floats:
        """Times (k,), s, of positions of one cutter in a setup, each with its solutions (2,), deg; it begins with all at zero."""
        rate = self.rate
        if rate is None or not len(positions):
            return np.full(len(positions), self.constant)
        limit = self.orientations[setup].kinematics.limit
        return index_times([np.radians(each) for each in positions], limit, rate, self.acceleration)

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
            turn[singular, :, :1] = 0.0
            seconds[mine] = np.nan_to_num((turn / rate).max(axis=2, initial=0.0), nan=math.inf).min(axis=1)
        return np.where(np.isfinite(seconds), seconds, 0.0)


def index_times(
    positions: Sequence[Floats | Sequence[Floats]], limit: Floats, rate: Floats, acceleration: Floats | float = math.inf
) -> Floats:
    """Times (k,), s, in which rotary axes come to each of some positions, in the order that takes least in all.

    The slowest axis counts. An axis without a limit on one side takes the shorter way round; of one with limits, all turns within
    them count, up to one from zero. Up to `MOST` positions all orders are compared; of more, the nearest one comes next.

    `positions` (sequence of (s, k) float): the solutions of each position, rad. `limit` (k, 2) float: least and largest angle of
    each axis, rad; infinite: none. `rate` (k,) float: rad/s. `acceleration` (k,) float: rad/s2; infinite: none.
    """
    endless: NDArray[np.bool_] = np.asarray(~np.isfinite(limit).all(axis=1))
    turned = [_turns(np.atleast_2d(each), limit, endless) for each in positions]
    owner = np.repeat(np.arange(len(turned)), [len(each) for each in turned])
    places = np.concatenate([_start(limit)[None], *turned])
    step = np.abs(places[:, None] - places)
    step = np.where(endless, np.minimum(step % (2.0 * math.pi), -step % (2.0 * math.pi)), step)
    # An axis that does not come to its rate is as long in getting faster as in getting slower.
    reached = step >= rate**2 / acceleration
    seconds = np.where(reached, step / rate + rate / acceleration, 2.0 * np.sqrt(step / acceleration))
    seconds = np.where(step > 0.0, seconds, 0.0).max(axis=2, initial=0.0)
    order = _best_order(seconds, owner) if len(turned) <= MOST else _nearest(seconds, owner)
    times, before = np.zeros(len(turned)), 0
    for place in order:
        times[owner[place]], before = seconds[before, place + 1], place + 1
    return times


def _start(limit: Floats) -> Floats:
    """Angles (k,) at which the axes begin: zero, or what is next to it within their limits."""
    return np.asarray(np.clip(0.0, *np.where(np.isfinite(limit).all(axis=1, keepdims=True), limit, 0.0).T))


def _turns(solutions: Floats, limit: Floats, endless: NDArray[np.bool_]) -> Floats:
    """Solutions (s, k) with all turns of theirs (t, k) within limits, up to one turn from zero."""
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
