"""What of fixed operations is proved between samples."""

import pytest
from OCP.BRepPrimAPI import BRepPrimAPI_MakeBox

from plan_cutters import plan

ASKED = {
    "cutters": ["R3L40"],
    "spacing": 5.0,
    "faces": "all",
    "machine": "trunnion-ac",
    "operations": "fewest",
    "tilt": (0.0, 1.2),
}


@pytest.fixture(scope="module")
def box():
    return BRepPrimAPI_MakeBox(30, 20, 10).Solid()


def test_planes_are_proved_with_a_piece_for_each_face(box):
    (found,) = plan(box, **ASKED).plan.operations.plans
    fixed = [each for each in found.operations if each.mode == "fixed"]
    assert fixed
    assert all(each.proved_share == 1.0 for each in fixed)
    assert found.proved_share == 1.0
    assert sum(len(each.faces) for each in fixed) <= found.approaches_proved


def test_nothing_is_said_where_no_area_was_asked_for(box):
    (found,) = plan(box, area_budget=0, **ASKED).plan.operations.plans
    assert found.proved_share is None
    assert found.approaches_proved is None
    assert all(each.proved_share is None for each in found.operations)
