"""Sentences on the bound over all axes."""

from types import SimpleNamespace

import pytest

from plan_cutters.plan_file.words.motion import whatever_the_axes


@pytest.mark.parametrize(
    ("found", "least", "words"), [(5, 5, "No other axes"), (5, 3, "no fewer than 3"), (5, 2, ""), (1, 1, ""), (2, 1, "")]
)
def test_the_bound_over_all_axes_is_told_where_it_says_something(found, least, words):
    few = SimpleNamespace(found=found, at_least_any=least)
    text = "".join(whatever_the_axes(few))
    assert words in text
    assert bool(text) == bool(words)
