"""Steps in the order of a shop: setup by setup the largest cutter first, and with a cutter floors, walls, free-form, motion."""

from itertools import groupby, pairwise
from types import SimpleNamespace

import cadquery as cq
import pytest
from hypothesis import given
from hypothesis import strategies as st

from plan_cutters import plan
from plan_cutters.document.process import place_in_shop

SLOW = pytest.mark.slow("plans a block with slots")
#: How steps of one cutter cut, in their order.
IN_TURN = ["floor", "mixed", "wall", "point", "simultaneous"]
HOW = {
    "cutters": ["D10L60F26", "D6L60rc3F26", "D3L40F20"], "faces": "all", "machine": "trunnion-ac", "feed": 1000.0, "grid": 4,
    "area_budget": 0, "fixtures": "table", "operations": "fastest", "index_time": 1.0, "change_time": 1.0,
}  # fmt: skip


def slotted():
    """A block with slots that the smallest cutter alone enters, which have most of the area, and a dimple."""
    block = cq.Workplane().box(44, 30, 20).faces(">Z").workplane()
    block = block.pushPoints([(-18 + 5 * k, 0) for k in range(4)]).rect(3.2, 40).cutBlind(-14)
    return block.cut(cq.Workplane().sphere(7).translate((14, 0, 14))).val()


@pytest.fixture(scope="module")
def process():
    return plan(slotted(), **HOW).plan.process


@SLOW
def test_cutters_come_from_large_to_small_and_each_once_a_setup(process):
    used = [(step.setup, step.cutter) for step in process.steps]
    runs = [each for each, _ in groupby(used)]
    assert len(runs) == len(set(used)) >= 2
    for _, mine in groupby(runs, key=lambda each: each[0]):
        radii = [float(cutter[1:].split("L")[0]) for _, cutter in mine]
        assert radii == sorted(radii, reverse=True)
    # The smallest cutter has the most area: that is no order.
    area = {cutter: sum(step.area_mm2 for step in process.steps if step.cutter == cutter) for _, cutter in used}
    assert max(area, key=area.__getitem__) == runs[-1][1]


@SLOW
def test_a_cutter_cuts_floors_then_walls_then_what_is_free_form(process):
    for _, mine in groupby(process.steps, key=lambda step: (step.setup, step.cutter)):
        kinds = [step.strategy if step.mode == "fixed" else step.mode for step in mine]
        assert kinds == sorted(kinds, key=IN_TURN.index)


def kind(step):
    return step.strategy if step.mode == "fixed" else step.mode


@given(st.lists(st.builds(
    SimpleNamespace, setup=st.integers(0, 2), cutter=st.sampled_from(["D16", "D6", "D3"]), area_mm2=st.floats(1.0, 1e4),
    strategy=st.sampled_from(IN_TURN[:-1]), mode=st.sampled_from(["fixed", "simultaneous"]),
), min_size=2, max_size=12))  # fmt: skip
def test_of_any_steps_the_area_counts_last(steps):
    """A later step is in a later setup, or has a smaller cutter, or cuts otherwise, or less, each only where all before agree."""
    for step in steps:
        step.strategy = step.strategy if step.mode == "fixed" else "point"
    ordered = sorted(steps, key=lambda step: place_in_shop(step, {"D16": 0, "D6": 1, "D3": 2}))
    for one, other in pairwise(ordered):
        if one.setup != other.setup:
            assert one.setup < other.setup
        elif one.cutter != other.cutter:
            assert int(one.cutter[1:]) > int(other.cutter[1:])
        elif kind(one) != kind(other):
            assert IN_TURN.index(kind(one)) < IN_TURN.index(kind(other))
        else:
            assert one.area_mm2 >= other.area_mm2
