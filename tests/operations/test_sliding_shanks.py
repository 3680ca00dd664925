"""A shank as wide as the flutes slides along a wall that is deeper than these: the plan says so, and what a relieved one has."""

import pytest

from plan_cutters import plan
from plan_cutters.plan_file.words.process import process_story
from tests.support.plates import block

WORDS = {"faces": "all", "grid": 4, "area_budget": 0, "machine": "3-axis", "feed": 800, "operations": "fastest"}


def made(*cutters, **words):
    return plan(block(60, 40, 30).findSolid(), **{**WORDS, **words, "cutters": cutters}).plan


@pytest.fixture(scope="module")
def found():
    return made("D6L45F25S6")


def test_the_walls_are_named_and_what_a_relieved_shank_has_is_what_it_has(found):
    (step,) = found.process.steps
    walls = {face.id for face in found.faces if abs(face.centre_mm[2] + 15.0) < 1e-6}
    assert step.clearance_mm <= 0.01
    assert {*step.slide.faces} == walls
    relieved = made("D6L45F25N5.7x15S6").process.steps[0]
    assert relieved.slide is None
    assert relieved.clearance_mm == pytest.approx(step.slide.relieved_mm, abs=0.01)
    assert relieved.clearance_mm == pytest.approx(0.15, abs=0.01)


def test_the_summary_says_it_in_words(found):
    text = " ".join(line.strip() for line in found.text.lines)
    assert "the shank is as wide as the flutes and slides along" in text
    assert "a relieved shank (neck) clears it" in text
    assert "--holder-clearance" not in text


@pytest.mark.parametrize("cutter", ["D6L45F35S6", "D6L45F25N5.7x15S6", "D6L45F25N5x15S8"])
def test_no_shank_slides_that_is_above_the_wall_or_narrower(cutter):
    done = made(cutter)
    assert all(step.slide is None for step in done.process.steps)
    assert "slides along" not in " ".join(done.text.lines)


def test_where_the_holder_comes_as_near_a_relieved_shank_is_no_help():
    """A bar ends 0.004 mm under the holder where the tool stands at the foot of the wall at x = 30."""
    beside = made("D6L45F25S6", holder="D30L30", fixtures=["box:4,40,10@40,-20,4.996"])
    (step,) = beside.process.steps
    assert step.clearance_mm <= 0.005
    assert step.slide is None
    assert "relieved" not in " ".join(beside.text.lines)


def test_a_step_that_comes_as_near_to_something_else_is_named_first(found):
    process = found.process
    other = process.steps[0].model_copy(update={"slide": None})
    both = found.model_copy(update={"process": process.model_copy(update={"steps": [*process.steps, other]})})
    assert "in step 2" in process_story(both, {}).clearance
    assert "slides" not in process_story(both, {}).clearance
