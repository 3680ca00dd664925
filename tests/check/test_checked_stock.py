"""A bar of stock is known to the checker as far as it surely reaches: tools that pass its corner of a box are safe."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from plan_cutters import plan
from plan_cutters.domain.stock import Stock, StockBody
from plan_cutters_check.check import check
from plan_cutters_check.fixtures import foot_of
from tests.support.cad_parts import rod, write_step
from tests.support.written_plan import Written

WORDS = {
    "cutters": ["R3L40HR20L30"],
    "faces": "all",
    "grid": 9,
    "machine": "trunnion-ac",
    "fixtures": "chuck",
    "stock": "cylinder:1,5",
}


@settings(max_examples=60, deadline=None)
@given(st.integers(3, 40), st.integers(0, 10**6), st.floats(0.0, 5.0), st.floats(0.5, 9.0))
def test_the_known_bar_lies_within_the_true_one(count, seed, beside, below):
    points = np.random.default_rng(seed).normal(0.0, 10.0, (count, 3))
    numbers = foot_of((beside, below), points.min(axis=0), points.max(axis=0))
    true = StockBody.about(Stock("cylinder", (beside, below)), points)
    assert (len(numbers) == 6) == true.lying
    if true.lying:
        low, high = true.foot
        assert (np.array(numbers[:3]) >= low - 1e-9).all()
        assert (np.array(numbers[3:]) <= high + 1e-9).all()
        return
    x, y, radius, foot, top = numbers
    middle = 0.5 * (true.low + true.high)[:2]
    assert np.linalg.norm(middle - [x, y]) + radius <= true.radius + 1e-9
    assert (foot, top) == pytest.approx((true.low[2], true.part_low))


LYING = {**WORDS, "setup": "+x", "fixtures": "vise"}
TURNED = {**WORDS, "setup": "+x", "machine": "4-axis-a"}


@pytest.mark.parametrize("words", [WORDS, LYING, {**LYING, "stock": "part"}, TURNED, {**TURNED, "stock": "part"}])
def test_a_plan_in_a_bar_holds(tmp_path, words):
    """Stood in a chuck; lying across a vise in bored jaws, which grip the bar, or the part itself; and in a chuck on a fourth
    axis."""
    part = str(write_step(rod(20.0, 15.0) if words is WORDS else rod(8.0, 60.0), tmp_path / "rod.step"))
    plan(part, operations="fastest", feed=2000, area_budget=0, **words).write(tmp_path, ["json", "npz"])
    answer = check(Written(tmp_path, part, words).asked(), seconds=1e6)
    assert answer.holds, "\n".join(answer.lines)
