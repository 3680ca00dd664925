"""The table of steps adds up to the time in front, and says each angle of a step that is repeated unevenly."""

import re

import pytest

from plan_cutters import plan
from plan_cutters.plan_file.words.operations import each_time
from plan_cutters.plan_file.words.process import process_story
from plan_cutters.plan_file.words.text import with_text
from tests.support.cad_parts import box

WORDS = {"cutters": ("D10L40F25S10", "D6L30F20S6"), "faces": "all", "grid": 5, "area_budget": 0, "machine": "trunnion-ac"}


@pytest.fixture(scope="module")
def planned():
    return plan(box(40, 30, 20), operations="fastest", feed=1500, fixtures="vise", **WORDS).plan


def seconds(text):
    number, unit = re.fullmatch(r"(less than 1|[\d.]+) (s|min|h)", text).groups()
    return float(number.removeprefix("less than ")) * {"s": 1.0, "min": 60.0, "h": 3600.0}[unit]


def test_steps_and_what_is_between_them_take_the_time_in_front(planned):
    process, story = planned.process, process_story(planned, {})
    rows = sum(seconds(row.took) for row in story.rows)
    between = sum(seconds(each) for each in re.findall(r"(?:changes|turns) ([\d.]+ (?:s|min))", story.besides))
    assert between == pytest.approx(process.change_seconds + process.index_seconds, abs=1.0)
    assert between > 0.0
    assert rows + between == pytest.approx(process.seconds - process.setup_seconds, abs=0.5 * len(story.rows) + 1.0)
    assert f"  {story.besides}" in planned.text.lines


def test_a_time_that_is_not_known_is_said_to_be_so(planned):
    """At a few samples of a step no width of a pass is known: the headline has no minutes, and nobody said why."""
    process = planned.process
    steps = [process.steps[0].model_copy(update={"seconds": None}), *process.steps[1:]]
    made = planned.model_copy(update={"process": process.model_copy(update={"steps": steps, "seconds": None})})
    assert "  The time is not known: the width of a pass is not at some samples of step 1." in with_text(made).text.lines


def test_each_angle_of_a_step_is_told_where_no_increment_leads_there(planned):
    """Three images with C at 0, 47 and 190: the row had the angles of the first one alone."""
    entry = planned.operations.plans[0]
    first = next(each for each in entry.operations if each.mode == "fixed")
    images = [first.model_copy(update={"id": f"op9{k}", "orbit": 7, "angles_deg": {"C": c, "A": 45.0}})
              for k, c in enumerate((190.0, 0.0, 47.0))]  # fmt: skip
    operations = planned.operations.model_copy(update={"plans": [entry.model_copy(update={"operations": images})]})
    step = planned.process.steps[0].model_copy(
        update={"operation": "op91", "repeat": 3, "repeat_deg": None, "angles_deg": {"C": 0.0, "A": 45.0}}
    )
    process = planned.process.model_copy(update={"steps": [step], "drilling": []})
    made = planned.model_copy(update={"operations": operations, "process": process})
    assert each_time(made, step, 40) == "C 0, 47, 190 · A 45"
    assert each_time(made, step, 18) == "C 0, 47 +1 · A 45"
    assert each_time(made, step.model_copy(update={"repeat_deg": {"C": 90.0}}), 40) == ""
    assert any("3 x, C 0, 47, 190 · A 45  " in line for line in with_text(made).text.lines)
