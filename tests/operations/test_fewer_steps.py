"""Steps are joined to fewer where others serve their samples and the minutes allow it; what is left is hardly anything."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from plan_cutters.operations.labels import Steps, in_one_step, without_minor_steps

INF = math.inf


def steps_of(cost, area, *, group=None, free=None, moving=None, timed=True, turn=5.0):
    cost = np.array(cost, float)
    many = cost.shape[1]
    return Steps(
        cost, np.arange(many) if group is None else np.array(group), np.ones(many, bool) if free is None else np.array(free),
        np.zeros(many, bool) if moving is None else np.array(moving), np.array(area, float), timed, lambda used: turn * len(used),
    )  # fmt: skip


def numbers(*which):
    return np.array(which, np.int32)


@pytest.mark.parametrize(("dearer", "joined"), [(4.9, True), (5.1, False)])
def test_a_step_of_little_area_is_joined_where_that_costs_no_more_than_its_turn(dearer, joined):
    steps = steps_of([[100.0, INF], [9.0 + dearer, 9.0]], [1000.0, 9.0])
    then = without_minor_steps(steps, numbers(0, 1), incomplete=False)
    assert then.tolist() == ([0, 0] if joined else [0, 1])


@pytest.mark.parametrize(("area", "seconds", "joined"), [(9.9, 6.0, True), (10.2, 6.0, False), (400.0, 4.9, True)])
def test_steps_below_one_percent_or_five_seconds_are_minor(area, seconds, joined):
    steps = steps_of([[100.0, INF], [seconds, seconds]], [1000.0, area])
    assert without_minor_steps(steps, numbers(0, 1), incomplete=False).tolist() == ([0, 0] if joined else [0, 1])
    # Without a feed lengths stand for times: the area alone says what is minor.
    mm = steps_of(steps.cost, steps.area, timed=False)
    assert without_minor_steps(mm, numbers(0, 1), incomplete=False).tolist() == ([0, 0] if area < 10.0 else [0, 1])


@pytest.mark.parametrize(
    ("area", "seconds", "incomplete", "left"),
    [
        (0.09, 3.0, True, True),
        (0.09, 3.0, False, False),
        (0.9, 0.9, True, True),
        (0.9, 1.1, True, False),
        # A floor of 12 mm2 is cut in no time: it has to be cut.
        (12.0, 0.1, True, False),
    ],
)
def test_what_is_hardly_a_step_is_left_where_something_is_left_anyway(area, seconds, incomplete, left):
    steps = steps_of([[100.0, INF], [INF, seconds]], [1000.0, area])
    assert without_minor_steps(steps, numbers(0, 1), incomplete=incomplete).tolist() == ([0, -1] if left else [0, 1])


def test_many_steps_that_are_hardly_any_are_not_left_all():
    many = 20
    cost = np.full((1 + many, 1 + many), INF)
    np.fill_diagonal(cost, 0.5)
    cost[0, 0] = 1000.0
    steps = steps_of(cost, [1000.0, *[0.2] * many])
    then = without_minor_steps(steps, np.arange(1 + many, dtype=np.int32), incomplete=True)
    assert 0.0 < steps.area[then < 0].sum() < 0.001 * steps.area.sum()


def test_nothing_is_left_where_there_is_no_other_step():
    steps = steps_of([[0.5]], [0.05])
    assert without_minor_steps(steps, numbers(0), incomplete=True).tolist() == [0]


def test_images_are_one_step_and_a_persons_own_stays():
    # Three images of 0.6 % each are no minor step.
    cost = [[100.0, INF, INF, INF], *[[8.0, *(7.0 if j == i else INF for j in range(3))] for i in range(3)]]
    area = [1000.0, 6.0, 6.0, 6.0]
    alike = steps_of(cost, area, group=[0, 1, 1, 1])
    assert without_minor_steps(alike, numbers(0, 1, 2, 3), incomplete=False).tolist() == [0, 1, 2, 3]
    assert without_minor_steps(steps_of(cost, area), numbers(0, 1, 2, 3), incomplete=False).tolist() == [0, 0, 0, 0]
    own = steps_of(cost, area, free=[True, False, False, False])
    assert without_minor_steps(own, numbers(0, 1, 2, 3), incomplete=True).tolist() == [0, 1, 2, 3]
    taken = steps_of(cost, area, free=[False, True, True, True])
    assert without_minor_steps(taken, numbers(0, 1, 2, 3), incomplete=False).tolist() == [0, 1, 2, 3]


@pytest.mark.parametrize(("serves", "dearer", "whole"), [(0.96, 1.09, True), (0.94, 1.09, False), (0.96, 1.25, False)])
def test_a_face_of_free_form_goes_into_the_step_that_serves_nearly_all_of_it(serves, dearer, whole):
    """Of a hundred samples each half is cut best by a step of its own; the first serves most of the others, too."""
    n, cost = 100, np.full((100, 2), INF)
    cost[:50, 0], cost[50:, 1] = 1.0, 1.0
    cost[50 : int(serves * n), 0] = 2.0 * dearer - 1.0
    steps, number = steps_of(cost, np.ones(n), turn=0.0), np.repeat(np.int32([0, 1]), 50)
    then = in_one_step(steps, number, np.ones(n, np.int32), [1])
    assert (then == 0).sum() == (int(serves * n) if whole else 50)
    # Where it saves a turn it may take as much more.
    assert in_one_step(steps, number, np.ones(n, np.int32), []).tolist() == number.tolist()


@pytest.mark.parametrize(
    ("dearer", "motion", "rest", "goes_to"),
    [(1.05, 0.5, 0.0, [0]), (1.15, 0.95, 0.0, [0]), (1.2, 0.8, 0.0, [2]), (1.2, 0.8, 10_000.0, [0, 1])],
)  # fmt: skip
def test_a_face_goes_with_motion_only_where_no_orientation_serves_it_at_little_more(dearer, motion, rest, goes_to):
    """Two orientations have half of a face each, motion takes it in less time, the first orientation in more.

    A tenth more than before is little, and so is a quarter more than in motion. A face of less than 1 % does not go with motion.
    """
    cost = np.tile([dearer, 3.0, motion], (101, 1))
    cost[50:100, 1] = 1.0
    cost[:50, 0] = 1.0
    cost[50:100, 0] = 2.0 * dearer - 1.0
    cost[100, :] = 0.0, INF, INF
    face, area = np.append(np.ones(100, np.int32), np.int32(2)), np.append(np.ones(100), rest)
    steps = steps_of(cost, area, moving=[False, False, True], turn=0.0)
    then = in_one_step(steps, np.append(np.repeat(np.int32([0, 1]), 50), np.int32(0)), face, [1])
    assert sorted({*then[:100].tolist()}) == goes_to


def test_a_fixed_step_of_a_large_area_does_not_go_with_motion():
    """However short: nobody turns the axes while a table top is faced. A small one does."""
    short = steps_of([[2.0, 2.0], [INF, 2.0]], [900.0, 0.8], moving=[False, True])
    assert without_minor_steps(short, numbers(0, 1), incomplete=False).tolist() == [0, 1]
    little = steps_of([[2.0, 2.0], [INF, 90.0]], [8.0, 900.0], moving=[False, True])
    assert without_minor_steps(little, numbers(0, 1), incomplete=False).tolist() == [1, 1]


@settings(max_examples=150, deadline=None)
@given(st.integers(0, 2**32 - 1))
def test_samples_go_with_what_serves_them_and_the_minutes_do_not_rise(seed):
    rng = np.random.default_rng(seed)
    n, many = int(rng.integers(1, 40)), int(rng.integers(1, 7))
    cost = np.where(rng.random((n, many)) < 0.4, INF, 3.0 * rng.random((n, many)))
    cost[np.arange(n), rng.integers(0, many, n)] = 1.0
    group = rng.integers(0, many, many)
    area, face = 10.0 ** rng.uniform(-2, 3, n), rng.integers(1, 4, n).astype(np.int32)
    steps = Steps(cost, group, (rng.random(many) < 0.8)[group], np.zeros(many, bool), area, True, lambda used: 4.0 * len(used))
    number = cost.argmin(axis=1).astype(np.int32)
    whole = in_one_step(steps, number, face, [1, 2])
    assert np.isfinite(cost[np.arange(n), whole]).all()
    assert steps.total(whole) <= steps.total(number) + 0.1 * steps.cutting(number) + 1e-6
    assert (whole == number)[face == 3].all()
    incomplete = bool(rng.random() < 0.5)
    then = without_minor_steps(steps, whole, incomplete=incomplete)
    cut = then >= 0
    assert np.isfinite(cost[np.arange(n)[cut], then[cut]]).all()
    assert steps.total(then) <= steps.total(whole) + 1e-6
    assert incomplete or cut.all()
    assert area[~cut].sum() < max(0.1, 0.001 * area.sum())
    # Own steps keep what they have, and take nothing.
    own = ~steps.free[whole]
    assert (then == whole)[own].all()
    assert steps.free[then[(then != whole) & cut]].all()
    # Joining again changes nothing.
    if incomplete is False:
        assert np.array_equal(without_minor_steps(steps, then, incomplete=False), then)
