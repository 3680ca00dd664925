"""Columns left out one at a time: the times are those of the others, reckoned anew."""

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from plan_cutters.operations.motion import _Times


class Cutting(_Times):
    """The time of cutting alone: what no column serves takes 9."""

    def _with(self, some, own):
        return float(len(some)), float(np.where(np.isfinite(own), own, 9.0).sum())


@settings(max_examples=30, deadline=None)
@given(st.integers(0, 2**32 - 1))
def test_of_many_those_without_which_cutting_takes_least_are_left_out_in_turn(seed):
    rng = np.random.default_rng(seed)
    cost = np.where(rng.random((60, 30)) < 0.6, np.inf, rng.random((60, 30)))
    times, stay = Cutting(None, None, cost, np.full(60, 9.0), None, None), rng.permutation(30).tolist()
    tried = {next(each for each in stay if each not in others): total for others, total in times.without_one(stay)}
    every = {gone: times.total([each for each in stay if each != gone])[1] for gone in stay}
    assert len(tried) == 12
    assert all(np.isclose(total[1], every[gone]) for gone, total in tried.items())
    assert max(total[1] for total in tried.values()) <= min(every[gone] for gone in stay if gone not in tried) + 1e-9


@settings(max_examples=60, deadline=None)
@given(st.integers(0, 2**32 - 1))
def test_what_columns_take_without_one_of_them(seed):
    rng = np.random.default_rng(seed)
    rows, many = int(rng.integers(1, 30)), int(rng.integers(1, 7))
    # Ties, and samples that one column or none serves.
    cost = np.where(rng.random((rows, many)) < 0.4, np.inf, rng.integers(1, 5, (rows, many)).astype(float))
    times, stay = (
        Cutting(None, None, cost, np.full(rows, 9.0), None, None),
        rng.permutation(many)[: rng.integers(1, many + 1)].tolist(),
    )
    for gone, (others, total) in zip(stay, times.without_one(stay), strict=True):
        assert others == [each for each in stay if each != gone]
        assert total == times.total(others)
