"""What is kept of the program's answers notices a change, and no more than a change."""

import numpy as np
import pytest

from tests.support.kept import differences, plain
from tests.support.traced import Sums


@pytest.mark.parametrize(
    ("one", "other"),
    [
        (np.arange(99.0), np.arange(99.0)[::-1]),
        (np.arange(99), np.arange(99)[::-1]),
        (np.r_[np.arange(98.0), np.nan], np.arange(99.0)),
        ({"a": 1.0}, {"a": 1.00001}),
        ({"a": 1.0}, {"a": 1.0, "b": None}),
        ([1, 2], [1, 2, 3]),
        (float("nan"), float("inf")),
        (np.r_[np.arange(98.0), np.inf], np.r_[np.arange(98.0), -np.inf]),
        (True, 1),
        ("1", 1),
    ],
)
def test_a_change_is_seen(one, other):
    assert differences(plain(one), plain(other))
    assert not differences(plain(one), plain(one))


def test_what_a_processor_rounds_is_no_change():
    value = np.linspace(0.1, 7.0, 1000)
    assert not differences(plain({"a": value, "b": 1.0}), plain({"a": value * (1 + 1e-12), "b": 1.0 + 1e-12}))


def test_functions_that_return_the_same_in_another_order_are_told_apart():
    def sums_of(*values):
        sums = Sums()
        for each in values:
            sums.add(np.asarray(each))
        return sums.told()

    assert sums_of([1.0, 2.0], [3.0]) == sums_of([1.0, 2.0, 3.0])
    for other in ([2.0, 1.0, 3.0], [1.0, 2.0, np.nan], [1.0, 2.0], [1.0, 2.0, -3.0], [1.0, 2.0, 3.0, 0.0]):
        assert differences(plain(sums_of([1.0, 2.0, 3.0])), plain(sums_of(other)))
    assert sums_of([np.inf]) != sums_of([-np.inf]) != sums_of([np.nan])
