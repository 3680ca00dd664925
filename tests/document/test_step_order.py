"""Steps in the order of a shop: setup by setup the largest cutter first, and with a cutter floors, walls, free-form, motion."""

from itertools import groupby

import cadquery as cq
import pytest

from plan_cutters import plan

pytestmark = pytest.mark.slow("plans a block with slots")
#: How steps of one cutter cut, in their order.
IN_TURN = ["floor", "mixed", "wall", "point", "simultaneous"]
HOW = {
    "cutters": ["D10L60F26", "D6L60rc3F26", "D3L40F20"], "faces": "all", "machine": "trunnion-ac", "feed": 1000.0, "grid": 4,
    "area_budget": 0, "fixtures": "table", "operations": "fastest", "index_time": 1.0, "change_time": 1.0,
}  # fmt: skip


def slotted():
    """A block with slots that the smallest cutter alone enters, which have most of the area, and a dimple."""
    block = cq.Workplane().box(44, 30, 20).faces(">Z").workplane()
    block = block.pushPoints([(-18 + 5 * k, 0) for k in range(4)]).rect(3.2, 40).cutBlind(-12)
    return block.cut(cq.Workplane().sphere(7).translate((14, 0, 14))).val()


@pytest.fixture(scope="module")
def process():
    return plan(slotted(), **HOW).plan.process


def test_cutters_come_from_large_to_small_and_each_once_a_setup(process):
    used = [(step.setup, step.cutter) for step in process.steps]
    runs = [each for each, _ in groupby(used)]
    assert len(runs) == len(set(used)) >= 2
    for _, mine in groupby(runs, key=lambda each: each[0]):
        radii = [float(cutter[1:].split("L")[0]) for _, cutter in mine]
        assert radii == sorted(radii, reverse=True)


def test_a_cutter_cuts_floors_then_walls_then_what_is_free_form(process):
    for _, mine in groupby(process.steps, key=lambda step: (step.setup, step.cutter)):
        kinds = [step.strategy if step.mode == "fixed" else step.mode for step in mine]
        assert kinds == sorted(kinds, key=IN_TURN.index)
