"""What is left and the next step have their lines where there is no space for all steps."""

import re

import pytest

from plan_cutters import plan
from plan_cutters.plan_file.operations import HelpEntry, StockEntry
from plan_cutters.plan_file.words.notes import doubts
from plan_cutters.plan_file.words.process import with_process_words
from plan_cutters.plan_file.words.text import process_lines, story_of, with_text
from tests.support.cad_parts import box


@pytest.fixture(scope="module")
def planned():
    words = {"cutters": "D10L40F25S10", "faces": "all", "grid": 5, "area_budget": 0, "machine": "trunnion-ac"}
    return plan(box(40, 30, 20), operations="fastest", feed=1500, fixtures="vise", setup="+z", **words).plan


def test_steps_give_way_to_what_is_left_and_the_next_step(planned):
    process = planned.process
    steps = [process.steps[0].model_copy(update={"share": 0.01 * (k + 1)}) for k in range(9)]
    long = with_text(planned.model_copy(update={"process": process.model_copy(update={"steps": steps})}))
    assert process.left
    assert long.process.next
    for most in (30, 22, 16, 13):
        lines = process_lines(long, story_of(long), most=most)
        assert len(lines) <= most
        rows = sum(re.match(r" +\d+  ", line) is not None for line in lines)
        assert any(line.startswith("Left, ") for line in lines)
        assert any(line.startswith("Next: ") for line in lines)
        assert rows == 9 if most == 30 else rows < 9 or most > 13
        assert rows == 9 or any("smaller steps for " in line for line in lines)


@pytest.mark.parametrize("sharp", [0.002, 0.008])
def test_the_next_step_is_about_what_is_left_most_and_a_little_is_named_too(planned, sharp):
    """Of what is left a part is at sharp edges: their advice comes first but where more is left that a step helps."""
    process = planned.process
    entry = process.left[0]
    more, causes = {"helped": [HelpEntry(step=0, share=1.0)]}, {"holder": 0.005, "sharp_edge": sharp}
    left = [entry.model_copy(update={"cause": cause, "share": share} | more) for cause, share in causes.items()]
    left.sort(key=lambda each: -each.share)
    process = process.model_copy(update={"left": left, "finished_share": 0.995 - sharp})
    found = with_text(with_process_words(planned.model_copy(update={"process": process})))
    assert (found.process.next[0].argv == ["--sharp-edges", "left"]) == (sharp > 0.005)
    assert ["--sharp-edges", "left"] in [each.argv for each in found.process.next]
    assert any(line.startswith("Left, 0.") for line in process_lines(found, story_of(found), most=14))


@pytest.mark.parametrize(("up", "cut"), [((0.0, 0.0, -1.0), False), ((1.0, 0.0, 0.0), True)])
def test_the_foot_of_the_stock_is_cut_off_before_a_setup_that_does_not_turn_the_part_over(planned, up, cut):
    process, (first, *_) = planned.process, planned.process.setups
    stock = StockEntry(word="box:1,1,5", size_mm=(42.0, 32.0, 26.0), volume_mm3=3e4, remove_mm3=1e4, seconds=None)
    setups = [first, first.model_copy(update={"number": 2, "up": up})]
    made = planned.model_copy(update={"process": process.model_copy(update={"stock": stock, "setups": setups})})
    assert any("Cut off what is left of the stock" in each for each in doubts(made)) == cut
