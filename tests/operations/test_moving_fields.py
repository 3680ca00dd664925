"""Fields of moving axes: drawn smooth only where the tool stays free, and how the rotary axes turn over connected pieces."""

import math
from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from plan_cutters.domain.kinematics import Kinematics
from plan_cutters.operations.moving_axes import _smoothed
from plan_cutters.operations.proof import _held, _pieces, _span, counted_pieces, proved_share

SEEDS = st.integers(0, 2**32 - 1)
WHOLE = 2.0 * math.pi


def chain(count):
    return np.column_stack([np.arange(count - 1), np.arange(1, count)])


def free_everywhere(**how):
    """A stand-in for the certified test: free where `free` says so of rows and axes, and with the same room everywhere."""
    free = how.get("free", lambda rows, axis: np.ones(len(rows), bool))
    ones = lambda rows, axis: np.ones(len(rows))  # noqa: E731
    return SimpleNamespace(free=free, margin=how.get("margin", ones), pace=how.get("pace", ones))


def tilted(degrees):
    turn = np.radians(degrees)
    return np.column_stack([np.sin(turn), np.zeros(len(turn)), np.cos(turn)])


def bends(axis):
    return np.degrees(np.arccos(np.clip((axis[:-1] * axis[1:]).sum(axis=1), -1.0, 1.0)))


def test_axes_are_drawn_to_those_around_them_and_stay_unit():
    axis = tilted([0.0, 0.0, 30.0, 0.0, 0.0, 0.0])
    made = _smoothed(free_everywhere(), np.arange(6), chain(6), axis.copy(), np.zeros(len(axis)))
    assert np.linalg.norm(made, axis=1) == pytest.approx(1.0)
    assert bends(made).max() < 0.5 * bends(axis).max()
    # What is not in the operation, or has no neighbour, stays.
    some = _smoothed(free_everywhere(), np.array([0, 1, 2]), chain(3), axis.copy(), np.zeros(len(axis)))
    assert np.array_equal(some[3:], axis[3:])
    alone = _smoothed(free_everywhere(), np.array([5]), np.zeros((0, 2), np.int64), axis.copy(), np.zeros(len(axis)))
    assert np.array_equal(alone, axis)


@given(SEEDS)
@settings(max_examples=20, deadline=None)
def test_no_axis_moves_to_where_the_tool_is_not_free_or_has_less_room_than_it_had(seed):
    """Free below 25 deg alone, and with room that falls with the tilt: what is asked of each axis that was taken."""
    rng = np.random.default_rng(seed)
    count = 12
    axis = tilted(rng.uniform(0.0, 25.0, count))
    seen = []

    def free(rows, wanted):
        assert np.linalg.norm(wanted, axis=1) == pytest.approx(1.0)
        good = (wanted[:, 2] >= math.cos(math.radians(25.0))) & (rows % 4 != 3)
        seen.append((rows[good], wanted[good]))
        return good

    made = _smoothed(free_everywhere(free=free), np.arange(count), chain(count), axis.copy(), np.zeros(len(axis)))
    assert (made[:, 2] >= math.cos(math.radians(25.0)) - 1e-12).all()
    assert np.array_equal(made[3::4], axis[3::4])
    for row in range(count):
        tried = [wanted[rows == row][0] for rows, wanted in seen if (rows == row).any()]
        assert any(np.array_equal(made[row], each) for each in [axis[row], *tried])
    narrow = free_everywhere(margin=lambda rows, wanted: -np.arccos(wanted[:, 2]))
    kept = _smoothed(narrow, np.arange(count), chain(count), axis.copy(), np.zeros(len(axis)))
    assert (kept[:, 2] >= axis[:, 2] - 1e-9).all()


def test_pieces_are_counted_until_they_hold_nearly_all():
    assert counted_pieces(np.zeros(0)) == 0
    assert counted_pieces(np.array([5.0])) == 1
    assert counted_pieces(np.array([98.0, 1.5, 0.5])) == 2
    assert counted_pieces(np.array([99.5, 0.5])) == 1
    assert counted_pieces(np.ones(10)) == 10


@given(st.floats(0.0, 200.0), st.floats(0.0, 100.0))
def test_a_proved_share_is_never_more_than_what_is_proved(proved, whole):
    share = proved_share(proved, whole)
    assert 0.0 <= share <= 1.0
    assert whole == 0.0 or share <= proved / whole + 2e-9
    assert whole <= 0.0 or share >= min(1.0, proved / whole) - 1e-6 - 1e-12
    assert proved_share(50.0, 50.0) == 1.0
    assert proved_share(50.0 * (1.0 - 1e-6), 50.0) < 1.0
    assert proved_share(3.0, 0.0) == 0.0


def test_a_sample_belongs_to_the_piece_that_has_most_about_it():
    sample, piece = np.array([0, 0, 0, 2, -1, 3]), np.array([1, 0, 1, 0, 1, 2])
    area = np.array([1.0, 1.5, 1.0, 0.1, 9.0, 1.0])
    assert _pieces(sample, piece, area, 5).tolist() == [1, -1, 0, 2, -1]
    assert _pieces(np.full(2, -1), np.zeros(2, np.int64), np.ones(2), 3).tolist() == [-1, -1, -1]


FREE = np.array([[-math.inf, math.inf], [-math.inf, math.inf]])


@given(SEEDS, st.integers(2, 12))
@settings(max_examples=60, deadline=None)
def test_angles_over_a_tree_are_unrolled_along_it(seed, count):
    """A walk of small steps in any numbering, told only up to whole turns: its own extent comes back."""
    rng = np.random.default_rng(seed)
    parent = np.array([int(rng.integers(0, k)) for k in range(1, count)])
    walk = np.zeros((count, 2))
    for k in range(1, count):
        walk[k] = walk[parent[k - 1]] + rng.uniform(-3.0, 3.0, 2)
    edge = np.column_stack([parent, np.arange(1, count)])
    name = rng.permutation(count)
    told = np.empty_like(walk)
    told[name] = walk + WHOLE * rng.integers(-2, 3, (count, 2))
    low, high = _span(told, name[edge], FREE)
    assert high - low == pytest.approx(np.ptp(walk, axis=0))
    # It lies about zero, as near as whole turns let it.
    assert (np.abs(low + high) <= WHOLE + 1e-9).all()
    # In the same place modulo turns.
    off = (low - walk.min(axis=0)) / WHOLE
    assert off == pytest.approx(np.round(off), abs=1e-6)


@pytest.mark.parametrize("turns", [1, -1, 2])
def test_about_a_loop_that_makes_a_whole_turn_an_axis_must_turn_back(turns):
    count = 12
    around = np.column_stack([turns * WHOLE * np.arange(count) / count, np.zeros(count)])
    told = (around + math.pi) % WHOLE - math.pi
    edge = np.concatenate([chain(count), [[count - 1, 0]]])
    assert _span(told, edge, FREE) is None
    low, high = _span(told, chain(count), FREE)
    assert high - low == pytest.approx([abs(turns) * WHOLE * (count - 1) / count, 0.0])
    assert _span(np.where(np.arange(count)[:, None] == 3, np.nan, told), chain(count), FREE) is None


@given(SEEDS, st.floats(0.2, 6.0), st.floats(-9.0, 9.0))
@settings(max_examples=60, deadline=None)
def test_a_span_lies_within_the_limits_wherever_whole_turns_can_bring_it(seed, wide, low):
    rng = np.random.default_rng(seed)
    # No step is half a turn.
    walk = np.column_stack([np.linspace(0.0, wide, 6), np.zeros(6)])
    told = walk + np.array([WHOLE * float(rng.integers(-2, 3)), 0.0])
    limit = np.array([[low, low + 7.0], [-1.0, 1.0]])
    made = _span(told, chain(6), limit)
    fits = [k for k in range(-5, 6) if low - 1e-5 <= WHOLE * k and WHOLE * k + wide <= low + 7.0 + 1e-5]
    sure = [k for k in range(-5, 6) if low + 1e-3 <= WHOLE * k and WHOLE * k + wide <= low + 7.0 - 1e-3]
    assert made is not None or not sure
    if made is not None:
        assert fits
        assert made[0][0] >= low - 1e-5
        assert made[1][0] <= low + 7.0 + 1e-5
        assert made[1] - made[0] == pytest.approx([wide, 0.0])
        # Of several places the one that is nearest to zero.
        assert abs(made[0][0] + made[1][0]) <= min(abs(2.0 * WHOLE * k + wide) for k in (sure or fits)) + 2e-3


def test_what_is_held_from_end_to_end_is_told_with_the_angles_of_the_solution_that_turns_least():
    """A tool that tilts by B on a head over a table that turns by C: a cone about the table, in two pieces."""
    machine = Kinematics(np.array([[0.0, 0.0, 1.0], [0.0, 1.0, 0.0]]), np.array([[-math.inf, math.inf], [-2.0, 2.0]]),
                         np.array([0.0, 0.0, 1.0]))  # fmt: skip
    angle = np.array([[0.1 * k, 0.5] for k in range(5)] + [[2.0 + 0.1 * k, 0.5] for k in range(3)])
    axis = machine.axis(angle)
    piece = np.array([0] * 5 + [1] * 3, np.int32)
    edge = np.concatenate([chain(5), 5 + chain(3)])
    low, high, one, both = _held(machine, axis, piece, edge, np.array([3.0, 1.0]))
    assert (one, both) == (1.0, 1.0)
    assert (high - low)[1] <= np.degrees(1.0) + 1e-6
    assert machine.axis(np.radians(np.stack([low, high]))).shape == (2, 3)
    # With a limit that lets one of the solutions alone be, half of them hold it.
    narrow = Kinematics(machine.direction, np.array([[-math.inf, math.inf], [0.0, 2.0]]), machine.tool)
    low, high, one, both = _held(narrow, axis, piece, edge, np.array([3.0, 1.0]))
    assert (one, both) == (1.0, 0.0)
    assert (low[1], high[1]) == (pytest.approx(np.degrees(0.5)), pytest.approx(np.degrees(0.5)))
    assert low[0] == pytest.approx(0.0, abs=1e-6)
    assert high[0] == pytest.approx(np.degrees(2.2))
    # One piece that no solution holds counts for nothing.
    stopped = Kinematics(machine.direction, np.array([[-0.1, 0.5], [0.0, 2.0]]), machine.tool)
    low, high, one, both = _held(stopped, axis, piece, edge, np.array([3.0, 1.0]))
    assert (one, both) == (0.75, 0.0)
    none = Kinematics(machine.direction, np.array([[-0.1, 0.5], [1.0, 2.0]]), machine.tool)
    assert _held(none, axis, piece, edge, np.array([3.0, 1.0])) == (None, None, 0.0, 0.0)
