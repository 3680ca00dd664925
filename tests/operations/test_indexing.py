"""How long the rotary axes take to the orientations of operations: against all orders and all turns, one by one."""

import math
from dataclasses import replace
from itertools import permutations, product

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from cad_io.arrays import Triangles
from plan_cutters import Machine, PostureRange
from plan_cutters.domain.operations import INDEX_TIME, columns_of
from plan_cutters.operations.orientations import MOST, Indexing, Orientations, index_times
from plan_cutters.scene.conditions import Conditions
from plan_cutters.scene.obstacles import Obstacles
from plan_cutters.scene.surroundings import Surroundings
from plan_cutters.setups import solids

WHOLE = 2.0 * math.pi
RATE = np.array([1.5, 0.7])
ENDLESS = np.array([[-math.inf, math.inf], [-2.0, 2.0]])
LIMITS = {
    "first goes round": ENDLESS,
    "both have limits": np.array([[-1.5 * WHOLE, 1.2 * WHOLE], [-2.0, 2.0]]),
    "second goes round": np.array([[-3.0, 3.0], [-math.inf, math.inf]]),
    "zero is out": np.array([[0.5, 5.0], [-2.0, -0.3]]),
}


def ways(solutions, limit):
    """All places of a position that count: each solution, and its turns within the limits up to one from zero."""
    made = []
    for solution in solutions:
        each_axis = []
        for angle, (low, high) in zip(solution, limit, strict=True):
            if math.isinf(low):
                each_axis.append([angle])
                continue
            turns = [angle + WHOLE * k for k in range(-5, 6)]
            within = [a for a in turns if low - 1e-9 <= a <= high + 1e-9 and (a == angle or abs(a) <= WHOLE + 1e-9)]
            each_axis.append(within or [angle])
        made += product(*each_axis)
    return made


def step(one, other, limit):
    """Seconds from one place to another: the slower axis, the shorter way round where it has no end."""
    times = []
    for k, (low, _) in enumerate(limit):
        away = abs(other[k] - one[k])
        times.append((min(away % WHOLE, -away % WHOLE) if math.isinf(low) else away) / RATE[k])
    return max(times)


def start(limit):
    return tuple(0.0 if math.isinf(low) else min(max(0.0, low), high) for low, high in limit)


def least(positions, limit):
    """The least time of any order, with any way of each position."""
    every = [ways(each, limit) for each in positions]
    best = math.inf
    for order in permutations(range(len(positions))):
        cost = {start(limit): 0.0}
        for k in order:
            cost = {way: min(was + step(here, way, limit) for here, was in cost.items()) for way in every[k]}
        best = min(best, min(cost.values()))
    return best


@settings(max_examples=40, deadline=None)
@given(st.integers(0, 2**32 - 1), st.integers(1, 4), st.sampled_from(sorted(LIMITS)))
def test_the_best_order_takes_as_long_as_the_best_of_all_orders(seed, count, name):
    rng, limit = np.random.default_rng(seed), LIMITS[name]
    low, high = np.where(np.isfinite(limit), limit, [-3.0, 3.0]).T
    positions = [rng.uniform(low, high, (int(rng.integers(1, 3)), 2)) for _ in range(count)]
    times = index_times(positions, limit, RATE)
    assert times.shape == (count,)
    assert (times >= 0.0).all()
    assert times.sum() == pytest.approx(least(positions, limit))


@pytest.mark.parametrize(
    ("angle", "way"), [(540.0, 180.0), (-540.0, 180.0), (359.0, 1.0), (-181.0, 179.0), (40.0, 40.0), (720.0, 0.0)]
)
def test_an_axis_with_limits_goes_to_the_turn_that_is_nearest_to_zero(angle, way):
    limit = np.radians([[-900.0, 900.0], [-90.0, 90.0]])
    [seconds] = index_times([np.radians([[angle, 0.0]])], limit, RATE)
    assert seconds == pytest.approx(math.radians(way) / RATE[0], abs=1e-9)
    # Within narrower limits it stays as it is.
    [seconds] = index_times([np.radians([[angle, 0.0]])], np.radians([[angle - 0.5, angle + 0.5], [-90.0, 90.0]]), RATE)
    assert seconds == pytest.approx(0.0 if abs(angle) < 0.5 else math.radians(0.5) / RATE[0])


def test_of_many_positions_the_nearest_comes_next():
    """On a line the nearest next is the order along it; without an end the other side is as near."""
    angles = np.radians(np.arange(1, MOST + 4) * 7.0)
    mixed = np.random.default_rng(2).permutation(angles)
    times = index_times([[[a, 0.0]] for a in mixed], np.array([[-3.0, 3.0], [-1.0, 1.0]]), RATE)
    assert times == pytest.approx(np.full(len(angles), math.radians(7.0) / RATE[0]))
    around = np.radians(np.arange(1, MOST + 4) * 20.0)
    times = index_times([[[a, 0.0]] for a in around], ENDLESS, RATE)
    assert times[0] == times[-1] or times.sum() < math.radians(360.0) / RATE[0]


AROUND = Surroundings.sheet(Obstacles(Triangles(solids.box(np.zeros(3), np.ones(3)), np.ones(12, np.int32), 0.0, ())))
#: Both rotary axes of the machine, with its names, turn so many deg a second.
TURNING = (40.0, 15.0)


def orientations(rates=TURNING):
    machine = Machine.parse("trunnion-ac")
    turning = [None if rate is None else math.radians(rate) for rate in rates or (None, None)]
    axes = tuple(replace(each, rate=rate) for each, rate in zip(machine.axes, turning, strict=True))
    return Orientations.of(Conditions(replace(machine, axes=axes), np.array([0.0, 0.0, 1.0]), PostureRange(), AROUND, 0.01, 1))


def test_a_time_that_was_given_counts_then_rates_then_a_usual_time():
    given, rated, neither = (
        Indexing((orientations(),), 7.0),
        Indexing((orientations(),), None),
        Indexing((orientations(None),), None),
    )
    assert [each.source for each in (given, rated, neither)] == ["given", "rates", "assumed"]
    assert [each.rate is None for each in (given, rated, neither)] == [True, False, True]
    place = [[np.array([30.0, 0.0])], [np.array([0.0, 45.0])]]
    assert given.times(0, place).tolist() == [7.0, 7.0]
    assert neither.times(0, place).tolist() == [INDEX_TIME, INDEX_TIME]
    assert rated.times(0, []).tolist() == given.times(0, []).tolist() == []
    # Only where both axes are known to turn.
    for k in (0, 1):
        known = [*TURNING]
        known[k] = None
        assert Indexing((orientations(known),), None).rate is None


def test_of_two_axes_that_turn_at_once_the_slower_one_counts():
    rated = Indexing((orientations(),), None)
    rate = np.degrees(rated.rate)
    for angle in ([30.0, 0.0], [0.0, 45.0], [30.0, 45.0], [170.0, 5.0], [-170.0, 5.0]):
        [seconds] = rated.times(0, [[np.array(angle)]])
        assert seconds == pytest.approx(max(np.abs(angle) / rate))


@settings(max_examples=20, deadline=None)
@given(st.integers(0, 2**32 - 1))
def test_from_zero_no_choice_takes_less_than_the_turn_to_each_of_it(seed):
    where = orientations()
    rng, rated = np.random.default_rng(seed), Indexing((where,), None)
    axis = rng.normal(size=(6, 3)) * (1.0, 1.0, 0.3) + (0.0, 0.0, 1.0)
    angle, held = where.near(axis / np.linalg.norm(axis, axis=1)[:, None])
    columns = columns_of(held, angle)
    least = rated.from_zero(columns)
    for k in range(len(columns)):
        alone = rated.together(columns.of(np.array([k])))
        assert alone >= least[k] - 1e-9
        # Near the axis next to the part any angle of that may hold it.
        near = np.linalg.norm(np.cross(columns.axis[k], where.kinematics.direction[0])) < math.sin(math.radians(3.0))
        assert near or alone == pytest.approx(least[k], abs=1e-3)
        assert rated.together(columns.of(np.arange(k + 1))) >= least[: k + 1].max() - 1e-9
    # Another cutter begins at zero again, so together they take what each takes.
    twice = columns.and_(columns_of(held, angle, cutter=1))
    assert rated.together(twice) == pytest.approx(2.0 * rated.together(columns))
    assert not Indexing((where,), 5.0).from_zero(columns).any()
