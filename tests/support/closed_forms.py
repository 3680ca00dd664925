"""Free tilts at one point in degrees, and the planes that closed forms are about."""

import numpy as np
import pytest

from plan_cutters import posture_map
from tests.support import shapes

CLOSE = 0.05  # deg


def free(part, cutter, rotations, point=(0, 0, 0), **options):
    found = posture_map(part, point=point, cutter=cutter, rotations=np.radians(rotations), tolerance=0.0, **options)
    return found, [np.degrees(i) for i in found.free]


def assert_intervals(found, *expected):
    found = found[(found[:, 1] - found[:, 0]) > 0.02]
    assert len(found) == len(expected), found
    assert found == pytest.approx(np.array(expected, float).reshape(-1, 2), abs=CLOSE)


WIDE = (-200, 200)


def floor(low=-200.0, high=200.0, z=0.0):
    return shapes.plane((low, high), WIDE, (0, 0, z))


def wall(x, low, high, way):
    """A wall in the plane x, its free side towards +x or -x (`way`), between two heights."""
    return shapes.plane((low, high), WIDE, (x, 0, 0), (way, 0, 0), (0, 0, 1))
