"""Which cutter a plan takes: kind before radius on free-form faces, flat ends on a plate, engraving bits if nothing else does."""

import pytest

from plan_cutters import Cutter, plan
from plan_cutters.command.codes import FEASIBLE, NONE_FEASIBLE, code_of
from plan_cutters.domain.preference import group_of
from tests.support.cad_parts import ball, box, patch

HOW = {"faces": "all", "grid": 7, "area_budget": 0}
BALL, FLAT = Cutter.parse("D6L60rc3"), Cutter.parse("D10L60")
BIT = Cutter.form([(0, 0), (0.15, 0), (6, 40)], length=60, name="engraving bit")
#: A holder wider than the part.
STUBBY = Cutter.parse("D6L4rc3F4HR60L30")
PARTS = {"sheet": lambda: patch(height=2.0), "sphere": ball, "plate": lambda: box(20, 20, 10)}


def taken(shape, cutters, **more):
    return plan(shape, cutters=cutters, **{**HOW, **more}).plan


@pytest.fixture(scope="module")
def plans():
    return {name: taken(make(), [BIT, FLAT, BALL]) for name, make in PARTS.items()}


@pytest.mark.parametrize(("name", "first"), [("sheet", BALL), ("sphere", BALL), ("plate", FLAT)])
def test_the_kind_that_the_faces_ask_for_wins(plans, name, first):
    found = plans[name]
    assert {c.id: c.feasible for c in found.cutters} == dict.fromkeys((BIT.id, FLAT.id, BALL.id), True)
    assert found.selected == first.id
    assert found.cutters[-1].id == BIT.id
    assert found.shown == first.id
    assert [c.group for c in found.cutters] == [group_of(each) for each in ((BALL, FLAT) if first is BALL else (FLAT, BALL))] + [
        "last"
    ]
    (run,) = found.least_set.runs
    assert run.cutter == first.id
    assert code_of(found) == FEASIBLE


def test_it_says_why(plans):
    assert "on free-form faces ball ends come before flat ends." in joined(plans["sphere"])
    assert "on planes, cylinders and cones flat ends come before ball ends." in joined(plans["plate"])


@pytest.mark.parametrize("name", PARTS)
def test_the_order_in_which_tools_are_given_decides_nothing(plans, name):
    turned = taken(PARTS[name](), [BALL, FLAT, BIT])
    before = plans[name]
    assert turned.selected == before.selected
    assert turned.selection == before.selection
    assert turned.process == before.process
    assert turned.text == before.text


def test_a_flat_end_wins_on_free_form_faces_where_no_round_one_finishes():
    """A ball whose thick holder meets the part in its valleys."""
    found = taken(patch(), [STUBBY, Cutter.parse("D4L60"), BIT], tilt_deg=(0, 30))
    assert [c.feasible for c in found.cutters] == [False, True, True]
    assert found.selected == "R2L60"
    assert [step.cutter for step in found.process.steps] == [STUBBY.id, "R2L60"]
    assert found.process.finished
    assert "Flat end D4 x 60 does alone, but its kind comes after that of step 1." in joined(found)


def test_an_engraving_bit_wins_only_where_nothing_else_finishes_as_much():
    """The others have holders that meet the part: the bit alone finishes it, and does only what they leave."""
    others = [STUBBY, Cutter.parse("D4L4HR60L30")]
    found = taken(patch(), [*others, BIT], tilt_deg=(0, 30))
    assert [c.feasible for c in found.cutters] == [False, False, True]
    assert found.selected == BIT.id
    assert [step.cutter for step in found.process.steps] == [STUBBY.id, BIT.id]
    assert found.process.finished
    assert found.text.headline.startswith("2 steps in 1 setup finish all ")
    assert "Engraving bit D12 does alone, but its kind comes after that of step 1." in joined(found)
    alone = taken(patch(), [BIT, Cutter.form([(0, 0), (0.15, 0), (5, 40)], length=60)], tilt_deg=(0, 30))
    assert alone.selected == BIT.id
    assert alone.text.headline.startswith("Take engraving bit D12: it finishes all ")
    without = taken(patch(), others, tilt_deg=(0, 30))
    assert without.selected is None
    assert code_of(without) == NONE_FEASIBLE


def joined(found):
    return " ".join(each.strip() for each in found.text.lines)
