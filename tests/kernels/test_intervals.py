"""Intervals of the kernels and of the rest of the program: the same in both, and as their points say."""

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from plan_cutters.domain.posture import common, complement, join, without
from plan_cutters.kernels.tool import arcs as compiled

#: Ends on a coarse grid meet often, as an ulp apart they do not.
ENDS = st.integers(0, 12).map(float)
PAIRS = st.lists(st.tuples(ENDS, ENDS).map(sorted), max_size=8).map(lambda found: np.array(found, float).reshape(-1, 2))
#: Points between all ends: none of them is one.
POINTS = np.arange(-1, 14) + 0.5


def holds(intervals):
    """Which of the points lie in intervals."""
    return ((intervals[:, :1] < POINTS) & (intervals[:, 1:] > POINTS)).any(axis=0)


def wide(intervals):
    return intervals[intervals[:, 1] > intervals[:, 0]]


def rows(intervals, room=40):
    out = np.zeros((room, 2))
    out[: len(intervals)] = intervals
    return out


@settings(max_examples=40, deadline=None)
@given(PAIRS)
def test_joined_intervals(pairs):
    found, work, count = join(pairs), np.zeros((40, 2)), 0
    for first, last in pairs:
        count = compiled.insert.py_func(work, count, first, last)
    assert (np.diff(work[:count, 0]) >= 0).all()
    count = compiled.join.py_func(work, count)
    assert work[:count].tolist() == found.tolist()
    assert (found[1:, 0] > found[:-1, 1]).all()
    assert (holds(found) == holds(pairs)).all()


@settings(max_examples=40, deadline=None)
@given(PAIRS, PAIRS)
def test_what_is_taken_out(pairs, others):
    pairs, others = wide(join(pairs)), wide(join(others))
    work, count = rows(pairs), len(pairs)
    for first, last in others:
        count = compiled.remove.py_func(work, count, first, last, 0.0)
    found = without(pairs, others)
    # Where nothing is too narrow the kernel leaves single numbers, too.
    assert wide(work[:count]).tolist() == found.tolist()
    assert (holds(found) == holds(pairs) & ~holds(others)).all()


@settings(max_examples=40, deadline=None)
@given(PAIRS, PAIRS)
def test_common_parts(pairs, others):
    assert (holds(common(pairs, others)) == holds(pairs) & holds(others)).all()


@settings(max_examples=40, deadline=None)
@given(PAIRS, ENDS, ENDS)
def test_the_rest_of_a_range(pairs, a, b):
    low, high = min(a, b), max(a, b)
    assert (holds(complement(join(pairs), low, high)) == (low < POINTS) & (high > POINTS) & ~holds(pairs)).all()


def test_where_there_is_no_room_the_narrower_part_goes():
    work = np.array([[0.0, 1.0], [2.0, 9.0]])
    assert compiled.remove.py_func(work, 2, 4.0, 5.0, 0.0) == 2
    assert work.tolist() == [[0.0, 1.0], [5.0, 9.0]]
