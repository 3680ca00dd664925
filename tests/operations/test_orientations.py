"""Fewest fixed orientations of shapes whose answer is known, obstacle-free or nearly so."""

import math

import numpy as np
import pytest

from plan_cutters import plan
from tests.support.cad_parts import box
from tests.support.shapes import ridge

BALL = "R1L60rc1"


def fewest(shape, tilt, **options):
    found = plan(shape, cutters=BALL, faces="all", tilt=(0.0, math.radians(tilt)), operations="fewest", area_budget=0,
                 **{"grid": 5, **options}).plan.operations  # fmt: skip
    assert found.plans[0].rest.samples == 0
    return found.fewest


@pytest.mark.slow("another tilt of the same law", but=("50.0",))
@pytest.mark.parametrize(("tilt", "answer"), [(40.0, 6), (50.0, 3), (56.0, 2)])
def test_a_cube_needs_six_orientations_then_three_then_two(tilt, answer):
    """Up to 45 deg an axis serves one face, from there on two, and three from acos(1 / sqrt 3) = 54.74 deg on: its corners."""
    found = fewest(box(), tilt)
    assert (found.found, found.at_least) == (answer, answer)


@pytest.mark.slow("another tilt of the same law", but=("31.0",))
@pytest.mark.parametrize(("tilt", "answer"), [(25.0, 4), (31.0, 3), (46.0, 2)])
def test_half_a_cylinder_needs_its_angle_over_twice_the_tilt(tilt, answer):
    found = fewest(ridge(10.0, 10.0), tilt, grid=19)
    assert (found.found, found.at_least) == (answer, answer)


@pytest.mark.slow("searches long", but=("trunnion-ac",))
@pytest.mark.parametrize("machine", ["trunnion-ac", "head-table-bc", "nutating-bc"])
def test_every_orientation_is_one_that_the_machine_can_be_set_to(machine):
    result = plan(box(), cutters=BALL, faces="all", grid=4, operations="fewest", machine=machine, area_budget=0)
    found, ways = result.plan.operations, result.conditions.kinematics
    assert found.plans[0].orientations
    for each in found.plans[0].operations:
        if each.mode == "simultaneous":
            continue
        for angles in (each.angles_deg, each.other_angles_deg):
            if angles is not None:
                degrees = np.array([[angles[name] for name in found.rotary]])
                assert np.allclose(np.round(degrees, 3), degrees, atol=1e-9)
        axis = ways.axis(np.radians([[each.angles_deg[name] for name in found.rotary]]))[0]
        assert np.allclose(axis, each.axis, atol=1e-12)
        assert result.conditions.machine.allows(axis[None], np.eye(3))[0]
