"""How a step says by how much it is turned from one time to the next."""

from types import SimpleNamespace

import numpy as np
import pytest

from plan_cutters.document.process import repeats


def said(*angles):
    same = [SimpleNamespace(mode="fixed", setup=0, angles_deg={"A": a, "C": c}) for c, a in angles]
    return repeats(None, same, np.zeros(0, bool))


@pytest.mark.parametrize(
    ("turned", "by"),
    [
        ((0.0, 120.0, -120.0), {"C": 120.0}),
        ((10.0, 61.429, 112.857, 164.286, -144.286, -92.857, -41.429), {"C": 51.429}),
        # Half of them: the machine cannot hold the others.
        ((0.0, 60.0, 120.0), {"C": 60.0}),
        # One is left out between them.
        ((0.0, 40.0, 120.0), None),
        ((0.0, 80.0, 160.0, 240.0), None),
        ((0.0, 0.0, 120.0), None),
    ],
)
def test_one_axis_is_turned(turned, by):
    assert said(*((c, 30.0) for c in turned)) == (len(turned), by)


def test_several_axes_say_nothing():
    assert said((0.0, 30.0), (120.0, 31.0), (240.0, 30.0)) == (3, None)
    assert said((0.0, 30.0)) == (1, None)
