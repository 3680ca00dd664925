"""What is kept of the program's answers notices a change, and no more than a change."""

import numpy as np
import pytest

from tests.support.kept import differences, plain


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
