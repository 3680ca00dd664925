"""Which samples that are not reached are looked at: the largest group of each face first, then places far from each other."""

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from plan_cutters.domain.verdicts import INSIDE, TOLERANCE
from plan_cutters.judging.witness import _TRIED_IN_ALL, _Group, _measured, far_apart

SEEDS = st.integers(0, 2**32 - 1)


def group(face, area, reason=0, body=-1):
    return _Group(face, reason, body, np.zeros(1, np.int64), area)


@given(st.lists(st.tuples(st.integers(1, 4), st.floats(0.0, 9.0)), max_size=20))
def test_the_largest_group_of_each_face_comes_before_the_second_of_any(faces):
    groups = [group(face, area) for face, area in faces]
    order = _measured(groups)
    assert sorted(order) == list(range(len(groups)))
    turns = []
    for k, i in enumerate(order):
        turns.append(sum(groups[j].face == groups[i].face for j in order[:k]))
    assert turns == sorted(turns)
    for face in {each.face for each in groups}:
        areas = [groups[i].area for i in order if groups[i].face == face]
        assert areas == sorted(areas, reverse=True)
    for turn in set(turns):
        areas = [groups[i].area for i, mine in zip(order, turns, strict=True) if mine == turn]
        assert areas == sorted(areas, reverse=True)


def test_what_has_no_depth_is_not_measured_and_of_many_only_some_are():
    groups = [group(1, 5.0), group(1, 9.0, INSIDE), group(2, 9.0, TOLERANCE), group(3, 9.0, body=2), group(4, 1.0)]
    assert _measured(groups) == [0, 4]
    many = [group(k, float(k)) for k in range(1, _TRIED_IN_ALL + 6)]
    assert _measured(many) == list(range(len(many) - 1, 4, -1))


@given(SEEDS, st.integers(1, 12), st.integers(1, 12))
@settings(max_examples=40, deadline=None)
def test_of_some_samples_each_is_as_far_as_can_be_from_those_before_it(seed, count, most):
    rng = np.random.default_rng(seed)
    point = rng.uniform(-1.0, 1.0, (30, 3))
    rows = rng.choice(30, count, replace=False)
    chosen = far_apart(point, rows, most)
    assert len(chosen) == len(set(chosen)) == min(count, most)
    assert set(chosen) <= set(rows.tolist())
    middle = point[rows].mean(axis=0)
    assert np.linalg.norm(point[chosen[0]] - middle) <= np.linalg.norm(point[rows] - middle, axis=1).min() + 1e-12
    for k in range(1, len(chosen)):
        away = np.linalg.norm(point[rows][:, None] - point[chosen[:k]], axis=2).min(axis=1)
        own = np.linalg.norm(point[chosen[k]] - point[chosen[:k]], axis=1).min()
        assert own >= away[~np.isin(rows, chosen[:k])].max() - 1e-12
