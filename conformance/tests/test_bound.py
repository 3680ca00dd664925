"""The postures of the suite against branch and bound over the exact surface of the files: neither knows what the other does."""

import numpy as np
import pytest

from conformance.exact.slow import read
from conformance.made.confirm import Around, confirmed, contradictions
from conformance.made.parts import PARTS
from conformance.suite import DATA
from conformance.suite import read as suite
from conformance.tests.daily import DAILY

#: Asked in every run; one in its B-spline form, for cells of a net of poles.
_EVERY_RUN = {*sorted(DAILY)[::3], "cone_boss_bspline"}


def of(name):
    table = suite("made").postures
    return table[np.flatnonzero(table.part == name)]


def around(name):
    return Around(PARTS[name], read(DATA / f"made/{name}.step"))


@pytest.mark.parametrize("name", [pytest.param(n, marks=() if n in _EVERY_RUN else pytest.mark.slow) for n in PARTS])
def test_bounds_exclude_no_margin(name):
    assert list(contradictions(around(name), of(name))) == []


def test_bounds_take_the_place_of_a_wrong_margin():
    """Safe where there is a depth, too deep, and not deep enough."""
    name = "three_sides"
    table, there = of(name), around(name)
    rows = np.flatnonzero((table.verdict == "blocked") & (table.low > -0.3))[:3]
    true = table.low[rows]
    for wrong in (1.0, -0.05, 0.01):
        table.low[rows] = table.high[rows] = np.where(wrong > 0.5, wrong, true + wrong)
        table.verdict[rows] = np.where(table.low[rows] > 0.5, "safe", "blocked")
        mended, found = confirmed(there, table)
        assert found == len(rows)
        assert (mended.verdict[rows] == "blocked").all()
        assert ((mended.low[rows] <= true + 1e-6) & (true <= mended.high[rows] + 1e-6)).all()
        assert (mended.proof[rows] == "bound").all()
