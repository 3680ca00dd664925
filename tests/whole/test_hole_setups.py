"""Setups for holes alone: proposed where drills of the libraries make holes from there alone, else named as what to do next."""

import math
from itertools import pairwise

import cadquery as cq
import numpy as np
import pytest

from plan_cutters import plan
from plan_cutters.plan_file.words.process import process_story
from plan_cutters.plan_file.words.text import MOST, text_of
from tests.support.drills import drill, library_of
from tests.support.plates import block, drilled

WORDS = {"cutters": ["D12L40F25S12", "D6L40F25S6"], "faces": "all", "grid": 3, "area_budget": 0, "machine": "3-axis"}
SIDES = {"+x": ((0, 1, 0), 90.0, (30, 0, -15)), "-x": ((0, 1, 0), -90.0, (-30, 0, -15)), "+y": ((1, 0, 0), -90.0, (0, 20, -15)),
         "-y": ((1, 0, 0), 90.0, (0, -20, -15))}  # fmt: skip


def plate(*sides):
    """A block with a pocket on top, and two holes from each of some sides."""
    shape = block(60, 40, 30).cut(cq.Workplane("XY").box(20, 16, 8).translate((-12, 0, 0)))
    for side in sides:
        about, turn, to = SIDES[side]
        for way in (-7.0, 7.0):
            bore = drilled(5.0, 8.0, 118.0).rotate((0, 0, 0), about, turn).translate(to)
            shape = shape.cut(bore.translate((0, way, 0) if side[1] == "x" else (way, 0, 0)))
    return shape.val()


def made(shape, *tools, **words):
    return plan(shape, **{**WORDS, **words, "libraries": [library_of(*tools)]}).plan


def test_a_setup_for_holes_alone_is_proposed():
    found = made(plate("+x"), drill(5.0), setup="auto")
    proposal = found.setup_proposal
    assert [each.holes for each in proposal.setups] == [0] * (len(proposal.setups) - 1) + [2]
    assert proposal.setups[-1].axis == (1.0, 0.0, 0.0)
    assert f"Setup {len(proposal.setups)} is for 2 holes." in proposal.why
    assert all(hole.drilled for hole in found.holes)
    assert {step.setup for step in found.process.drilling} == {len(proposal.setups) - 1}
    assert found.process.hole_setup is None
    # The mills' part of it is as without the drill.
    without = made(plate("+x"), drill(9.0), setup="auto").setup_proposal
    assert [each.axis for each in proposal.setups[:-1]] == [each.axis for each in without.setups]


@pytest.mark.parametrize("tool", [drill(5.0, flutes=6.0), drill(9.0), drill(5.0, point=90.0)])
def test_none_is_proposed_for_holes_that_no_drill_makes_there(tool):
    found = made(plate("+x"), tool, setup="auto")
    assert not any(each.holes for each in found.setup_proposal.setups)
    assert found.process.hole_setup is None
    assert not any("holes that drills" in each.words for each in found.process.next)


def test_none_is_needed_where_the_machine_tilts_to_the_holes():
    found = made(plate("+x"), drill(5.0), setup="auto", machine="trunnion-ac")
    assert not any(each.holes for each in found.setup_proposal.setups)
    assert all(hole.drilled for hole in found.holes)


def test_what_is_not_proposed_is_named_next():
    """Of four sides one has room among three setups; the next one is named, with the files of those that were proposed."""
    found = made(plate("+x", "-x", "+y", "-y"), drill(5.0), setup="auto")
    assert len(found.setup_proposal.setups) == 3
    assert sum(hole.drilled for hole in found.holes) == 2 * sum(each.holes > 0 for each in found.setup_proposal.setups)
    more = found.process.hole_setup
    assert more.holes == 2
    assert not any(np.dot(more.axis, each.axis) > 0.99 for each in found.setup_proposal.setups)
    assert any(line.startswith("Next: clamped with") and "2 holes" in line for line in found.text.lines)


def test_the_setup_for_holes_is_named_where_space_is_short():
    """Many areas that are left, and lines about them, do not push it out."""
    found = made(plate("+x"), drill(5.0), setup=(0, 0, 1))
    (left, *_), lines = found.process.left, [f"F{k} may be wrong." for k in range(8)]
    long = found.process.model_copy(update={"left": [left] * 4, "doubts": lines})
    text = text_of(found.model_copy(update={"process": long}))
    assert len(text.lines) <= MOST
    assert any("2 holes that drills" in f"{one} {two.strip()}" for one, two in pairwise(text.lines))


@pytest.mark.parametrize(("setup", "others"), [((0, 0, 1), ()), ((0, 0, 1), ((0, 0, -1),))])
def test_a_named_setup_makes_what_was_said(setup, others):
    found = made(plate("+x", "-y"), drill(5.0), setup=setup, other_setups=others)
    more = found.process.hole_setup
    assert more.holes == 2
    (following,) = [each for each in found.process.next if "holes that drills make there" in each.words]
    typed = [tuple(float(x) for x in word.split(",")) for word in following.argv[1::2]]
    assert {*following.argv[::2]} == {"--setup"}
    assert typed == [setup, *others, more.axis]
    again = made(plate("+x", "-y"), drill(5.0), setup=typed[0], other_setups=tuple(typed[1:]))
    assert sum(hole.drilled for hole in again.holes) == 2
    assert again.process.hole_setup.axis != more.axis


def test_a_hole_aslant_is_made_from_its_own_direction():
    lean = math.radians(15.0)
    bore = drilled(5.0, 8.0).rotate((0, 0, 0), (0, 1, 0), 15.0).translate((12, 0, 0))
    found = made(block(60, 40, 30).cut(bore).val(), drill(5.0, flutes=45.0), setup=(0, 0, 1))
    assert found.process.hole_setup.axis == pytest.approx((math.sin(lean), 0.0, math.cos(lean)), abs=1e-5)


def test_a_doubt_names_steps_of_mills_that_go_to_the_bottoms_of_holes_before_these_are_drilled():
    """A flat-bottomed bore that a drill opens and a mill finishes: the mill goes down behind the drill."""
    bored = block(60, 40, 30).cut(cq.Workplane("XY").workplane(offset=-12).circle(4.0).extrude(40))
    found = made(bored.val(), drill(8.0, flutes=40.0), cutters=["D6L40F25S6", "D12L40F25S12"], operations="fewest", setup="+z")
    (hole,) = found.holes
    assert hole.floor
    deep = [k for k, step in enumerate(found.process.steps, 1) if set(hole.floor) & set(step.faces)]
    assert deep
    drills = len(found.process.steps) + len(found.process.drilling)
    lines = [each for each in found.process.doubts if "behind" in each]
    assert lines == [f"Run step {k} behind step {drills}: it goes to the bottoms of holes that are drilled there." for k in deep]
    assert [row.number for row in process_story(found, {}).rows][-len(deep) :] == [str(k) for k in deep]
