"""The checker looks whether operations that are images of each other are so, and turn evenly."""

import numpy as np
import pytest

from plan_cutters_check.paper import motion
from plan_cutters_check.reckoned import Planned, evenly


def operation(k: int, **changes) -> dict:
    angles = {"A": 60.0, "C": -100.0 + 60.0 * k}
    known = {"id": f"op{k}", "orbit": 0, "cutter": "a", "setup": 0, "mode": "fixed", "angles_deg": angles, "turning": None}
    return {**known, "area_mm2": 10.0 + k, "seconds": 5.0, **changes}


def repeated(*operations: dict) -> list[str]:
    arrays = {"operation": np.zeros(1, int), "moving_axis": np.full((1, 3), np.nan), "moving_piece": np.full(1, -1)}
    plan = Planned(0, {"name": "fastest", "operations": list(operations)}, arrays)
    return [each.words for each in motion(plan) if each.holds is False]


@pytest.mark.parametrize("changes", [{"cutter": "b"}, {"setup": 1}, {"mode": "simultaneous"}])
def test_images_of_each_other_have_one_cutter_setup_and_mode(changes):
    three = [operation(k) for k in range(3)]
    assert repeated(*three) == []
    assert repeated(*three[:2], operation(2, **changes))


def test_a_step_that_is_repeated_turns_evenly():
    three = [operation(k)["angles_deg"] for k in range(3)]
    assert evenly({"C": 60.0}, three)
    for by in ({"C": 45.0}, {"C": -60.0}, {"A": 60.0}, {"B": 60.0}, {"A": 0.0, "C": 60.0}, {}):
        assert not evenly(by, three), by
    for angles in ({"A": 60.0, "C": 21.0}, {"A": 61.0, "C": 20.0}, {"A": 60.0, "C": -100.0}):
        assert not evenly({"C": 60.0}, [*three[:2], angles]), angles
