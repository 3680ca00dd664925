"""Branch and bound against closed forms: what proves real parts has to agree where the answer is known."""

import numpy as np
import pytest

from conformance.exact.bound import least, numbers, tree
from conformance.exact.cells import cells
from conformance.exact.slow import read
from conformance.suite import read as suite

#: Parts whose materials are all on their skin, with planes, cylinders, cones, spheres, tori and B-splines among them.
PARTS = ("plate_and_wall", "slot", "cone_pit", "sphere_pocket", "plate_and_wall_bspline", "cone_pit_bspline")


@pytest.mark.parametrize("name", PARTS)
def test_bounds_hold_the_closed_form(name: str) -> None:
    made = suite("made")
    part = made.parts[name]
    shape = tree(cells(read(part.path)))
    none = np.zeros(int(shape.cells.face.max()) + 1, bool)
    rows = np.flatnonzero((made.postures.part == name) & ~(made.postures.limit_deg < 0) & (made.postures.reason != "fixture"))[::4]
    blocked = 0
    for i in rows:
        row = made.postures[i : i + 1]
        low, high, _ = least(shape, numbers(part.tools[str(row.tool[0])]), row.tip[0], row.axis[0], none, enough=0.5)
        if row.verdict[0] == "safe":
            assert low >= -4e-3, (i, low, high)
        elif row.high[0] > -0.5:
            blocked += 1
            assert low - 1e-6 <= row.low[0] <= high + 1e-6, (i, low, high, row.low[0])
        else:
            assert high < -0.2, (i, low, high)
    assert blocked > 3
