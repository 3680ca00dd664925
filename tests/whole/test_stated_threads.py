"""Holes with threads and tolerances that the part's file states: what taps and reamers do, what is missing, and the checker."""

import copy
import json
import math
from dataclasses import replace

import numpy as np
import pytest

from cad_io import read_part
from plan_cutters import plan
from plan_cutters.options import Options
from plan_cutters.plan_file.words.holes import missing_words
from plan_cutters_check.asking import question_of
from plan_cutters_check.check import check, on_paper
from tests.support.drills import drill, library_of, tap
from tests.support.plates import block, drilled, turned
from tests.support.stated import stated

WORDS = {"cutters": ["D6L40F25S6"], "faces": "all", "grid": 3, "area_budget": 0, "machine": "trunnion-ac", "feed": 800,
         "operations": "fastest"}  # fmt: skip
M4 = {"value": 3.3, "notes": ["M4x0.7 - 6H"]}


def plate():
    """D3.3 and D5 through, D10 through, and D6.8 with a drill's point."""
    made = block(80, 40, 12).pushPoints([(-24, 0)]).hole(3.3).pushPoints([(-8, 0)]).hole(5.0).pushPoints([(8, 0)]).hole(10.0)
    return made.cut(drilled(6.8, 9.0, 118.0, (24.0, 0.0))).val()


STATED = {
    1.65: M4,
    2.5: {"value": 5.0, "notes": ["M6"]},
    5.0: {"value": 10.0, "fit": ("H", "7")},
    3.4: {"value": 6.8, "notes": ["M8"]},
}
TOOLS = (drill(3.3), drill(5.0), drill(6.8), drill(10.0), tap(4.0, 0.7), tap(6.0, 1.0), tap(8.0, 1.25))


@pytest.fixture(scope="module")
def file(tmp_path_factory):
    return stated(tmp_path_factory.mktemp("threads") / "plate.step", plate(), STATED)


def made_with(source, *tools, **words):
    return plan(source, **{**WORDS, **words, "libraries": [library_of(*tools)]}).plan


def taps(document):
    return [step for step in document.process.drilling if step.kind == "tap"]


def missing(document):
    return [missing_words(each) for hole in document.holes for each in hole.missing]


@pytest.fixture(scope="module")
def planned(file):
    return made_with(file, *TOOLS)


def test_each_thread_is_tapped_behind_its_drill(planned):
    steps = {step.thread: step for step in taps(planned)}
    assert {name: (step.diameter_mm, step.pitch_mm) for name, step in steps.items()} == {
        "M4": (4.0, 0.7),
        "M6": (6.0, 1.0),
        "M8": (8.0, 1.25),
    }
    # Its lead goes through; in a blind hole it ends where its full width does.
    assert steps["M4"].depth_mm == pytest.approx(12.0 + 3 * 0.7)
    assert steps["M8"].depth_mm == pytest.approx(9.0)
    # In and out.
    assert steps["M8"].seconds == pytest.approx(2 * 1.3 * 9.0 / 300.0 * 60.0)
    assert {step.setup for step in steps.values()} == {0}
    order = [step.kind for step in planned.process.drilling]
    assert order.index("tap") > max(k for k, kind in enumerate(order) if kind == "drill")
    assert planned.process.seconds == pytest.approx(math.fsum([
        planned.process.cutting_seconds, planned.process.link_seconds, planned.process.index_seconds,
        planned.process.change_seconds, planned.process.setup_seconds,
    ]))  # fmt: skip
    assert any("tap M4 x 14.1" in line for line in planned.text.lines)


def test_the_plan_says_threads_and_tolerances_of_holes(planned):
    by = {hole.diameter_mm: hole for hole in planned.holes}
    assert (by[3.3].thread.name, by[3.3].thread.fit, by[3.3].thread.pitch_mm) == ("M4", "6H", 0.7)
    assert (by[10.0].tolerance.fit, by[10.0].thread) == ("H7", None)
    assert by[5.0].tolerance is None
    assert "D10 H7" in " ".join(made_with_few(planned))


def made_with_few(planned):
    from plan_cutters.plan_file.words.holes import group_words

    return [group_words([hole]) for hole in planned.holes]


@pytest.mark.parametrize(("tools", "words"), [
    (TOOLS[:4], ["tap M4", "tap M6", "tap M8"]), ((*TOOLS[:4], tap(4.0, 0.5)), ["tap M4", "tap M6", "tap M8"]),
    ((*TOOLS[:4], tap(4.0, 0.7, left=True)), ["tap M4", "tap M6", "tap M8"]), ((*TOOLS[:5],), ["tap M6", "tap M8"]),
    ((*TOOLS[:4], replace(tap(4.0, 0.7), pitch=None)), ["tap M4", "tap M6", "tap M8"]),
    # Its shank of 8 mm, 5 mm over the tip, cannot follow through 12 mm.
    ((*TOOLS[:4], tap(4.0, 0.7, flutes=5.0, shank=8.0), *TOOLS[5:]), ["tap M4 (something is in the way)"]),
])  # fmt: skip
def test_the_tap_that_is_missing_is_named(file, tools, words):
    made = made_with(file, *tools)
    assert sorted(each for each in missing(made) if each.startswith("tap")) == words
    # The drills go on.
    assert all(hole.drilled for hole in made.holes)


def test_a_hole_that_is_not_drilled_is_not_tapped(file):
    made = made_with(file, drill(5.0), tap(4.0, 0.7))
    assert not taps(made)
    assert {"D3.3 x 12", "tap M4"} <= {*missing(made)} | {"tap M4"}


def test_without_thread_data_nothing_is_guessed():
    made = made_with(plate(), *TOOLS)
    assert not taps(made)
    assert all(hole.thread is None and hole.tolerance is None for hole in made.holes)
    assert missing(made) == []


def test_a_hole_that_is_as_wide_as_its_thread_is_drilled_for_the_tap(tmp_path):
    """Some models have the thread's own diameter: a drill of that would leave nothing to tap."""
    shape = block(40, 40, 12).hole(4.0).val()
    file = stated(tmp_path / "a.step", shape, {2.0: {"value": 4.0, "notes": ["M4"]}})
    made = made_with(file, drill(3.3), drill(4.0), tap(4.0, 0.7))
    assert [(step.kind, step.diameter_mm) for step in made.process.drilling] == [("drill", 3.3), ("tap", 4.0)]
    assert made.holes[0].drilled
    wrong = made_with(file, drill(4.0), tap(4.0, 0.7))
    assert not wrong.process.drilling
    assert not wrong.holes[0].drilled


def test_a_hole_as_wide_as_the_nut_is_drilled_for_the_tap(tmp_path):
    file = stated(tmp_path / "a.step", block(40, 40, 12).hole(3.242).val(), {1.621: {"value": 3.242, "notes": ["M4"]}})
    made = made_with(file, drill(3.3), tap(4.0, 0.7))
    assert [(step.kind, step.diameter_mm) for step in made.process.drilling] == [("drill", 3.3), ("tap", 4.0)]


def test_a_thread_that_is_modelled_over_its_core_ends_there(tmp_path):
    tool = turned((0.0, -15.0), (1.65, -14.0), (1.65, -9.0), (2.0, -8.8), (2.0, 1.0))
    file = stated(tmp_path / "a.step", block(40, 40, 20).cut(tool).val(), {2.0: {"value": 4.0, "notes": ["M4"]}})
    made = made_with(file, drill(3.3, point=118.0), tap(4.0, 0.7))
    (hole,) = made.holes
    assert (hole.diameter_mm, hole.thread.name) == (3.3, "M4")
    assert not any(face in step.faces for face in hole.faces for step in made.process.steps)
    if hole.drilled:
        (step,) = taps(made)
        assert step.depth_mm == pytest.approx(8.8)


def test_what_a_drill_does_not_hold_is_reamed_or_named(file):
    by_drill = made_with(file, *TOOLS)
    assert missing(by_drill) == ["reamer D10 H7"]
    assert all(hole.drilled for hole in by_drill.holes)
    reamed = made_with(file, *TOOLS, drill(9.8), drill(10.0, kind="reamer", point=None))
    assert missing(reamed) == []
    assert [(step.kind, step.diameter_mm) for step in reamed.process.drilling if step.diameter_mm > 9.0] == [
        ("drill", 9.8), ("reamer", 10.0),
    ]  # fmt: skip


@pytest.fixture(scope="module")
def question(file, tmp_path_factory):
    folder, words = tmp_path_factory.mktemp("checked"), {**WORDS, "libraries": [library_of(*TOOLS)]}
    plan(file, **words).write(folder, ["json", "npz"])
    document = json.loads((folder / "plan.json").read_text())
    arrays = {name: dict(np.load(folder / name)) for name in ("samples.npz", "operations.npz")}
    return question_of(read_part(file), Options(**words), document, arrays)


def test_the_checker_agrees(question):
    answer = check(question, seconds=1e6)
    assert [each.words for each in answer.findings if each.holds is False] == []
    assert not answer.entries.differ


def _tap(document):
    return next(step for step in document["process"]["drilling"] if step["thread" if "thread" in step else "kind"] == "M4")


def _hole(document):
    return next(hole for hole in document["holes"] if hole.get("thread", {}).get("name") == "M4")


def _deeper(document):
    step = _tap(document)
    step["depth_mm"] += 3.0
    step["seconds"] *= step["depth_mm"] / (step["depth_mm"] - 3.0)
    for each in step["holes"]:
        each["tip_mm"][2] -= 3.0


def _another_tap(document):
    other = next(step for step in document["process"]["drilling"] if step.get("thread") == "M6")
    _tap(document)["tool"] = other["tool"]


def _another_thread(document):
    _hole(document)["thread"] |= {"name": "M4x0.5", "pitch_mm": 0.5}


def _of_its_own(document):
    hole = next(hole for hole in document["holes"] if "thread" not in hole)
    hole["thread"] = {"name": "M12", "diameter_mm": 12.0, "pitch_mm": 1.75, "fit": "", "left": False}


def _wider(document):
    hole = next(hole for hole in document["holes"] if "tolerance" in hole)
    hole["tolerance"]["fit"] = "H11"


def _quick(document):
    _tap(document)["seconds"] *= 0.5


@pytest.mark.parametrize("forge", [_deeper, _another_tap, _another_thread, _of_its_own, _wider, _quick])
def test_what_is_forged_is_refused(question, forge):
    document = copy.deepcopy(question.document)
    forge(document)
    forged = replace(question, document=document)
    assert on_paper(forged).entries.differ or any(each.holds is False for each in check(forged, seconds=1e6).findings)
