"""Steps that drill are part of the process: which tools make what of a hole, in which setup and time; and they are checked."""

import copy
import json
import math
from dataclasses import replace

import cadquery as cq
import numpy as np
import pytest

from cad_io import read_part
from plan_cutters import plan
from plan_cutters.options import Options
from plan_cutters.plan_file.words.holes import missing_words
from plan_cutters_check.asking import question_of
from plan_cutters_check.bench import Bench
from plan_cutters_check.check import check, on_paper
from plan_cutters_check.drilling import findings
from plan_cutters_check.fixtures import resting
from plan_cutters_check.surface import Clock
from tests.support.drills import drill, library_of
from tests.support.plates import block, drilled

WORDS = {"cutters": ["D6L40F25S6"], "faces": "all", "grid": 3, "area_budget": 0, "machine": "trunnion-ac", "feed": 800,
         "operations": "fastest"}  # fmt: skip


def plate():
    """A countersink, a counterbore, a bore with a drill's point, one with a flat bottom, and one that is reamed."""
    made = block(60, 40, 16).pushPoints([(-22, 10)]).cskHole(4.5, 9.0, 90).pushPoints([(22, 10)]).cboreHole(6.6, 11, 6.5)
    made = made.cut(drilled(5.0, 9.0, 118.0, (-22.0, -10.0)))
    return made.pushPoints([(0, -10)]).hole(8.0, 12).pushPoints([(22, -10)]).hole(10.0).val()


TOOLS = (drill(4.5), drill(6.6), drill(5.0), drill(8.0), drill(9.8), drill(10.0, kind="reamer", point=None),
         drill(12.4, flutes=12.0, kind="countersink", point=90.0), drill(11.0, kind="counterbore", point=None))  # fmt: skip


def made_with(*tools, shape=None, **words):
    return plan(plate() if shape is None else shape, **{**WORDS, **words, "libraries": [library_of(*tools)]}).plan


@pytest.fixture(scope="module")
def planned():
    return made_with(*TOOLS)


def of_kind(document, kind):
    return [step for step in document.process.drilling if step.kind == kind]


def test_each_tool_makes_what_is_its_own(planned):
    assert all(hole.drilled and not hole.missing for hole in planned.holes)
    assert [(step.kind, step.diameter_mm) for step in planned.process.drilling] == [
        ("drill", 4.5), ("drill", 5.0), ("drill", 6.6), ("drill", 8.0), ("drill", 9.8), ("reamer", 10.0), ("counterbore", 11.0),
        ("countersink", 9.0),
    ]  # fmt: skip
    (sink,) = of_kind(planned, "countersink")
    assert sink.holes[0].tip_mm == pytest.approx((-22.0, 10.0, -4.5))
    (bore,) = of_kind(planned, "counterbore")
    assert bore.holes[0].tip_mm == pytest.approx((22.0, 10.0, -6.5))
    (flat,) = [step for step in of_kind(planned, "drill") if step.diameter_mm == 8.0]
    # Its point ends on the floor, which a mill finishes.
    assert flat.holes[0].tip_mm == pytest.approx((0.0, -10.0, -12.0))
    reamed = next(hole for hole in planned.holes if hole.diameter_mm == 10.0)
    assert reamed.tool.startswith("reamer")


@pytest.mark.parametrize(("leans", "steep"), [(0.0, False), (5.0, False), (20.0, True)])
def test_a_drill_that_begins_on_a_slope_is_a_doubt(leans, steep):
    """A bore square to the bottom of a block whose top leans; and one across a rod, whose mouth is as high on both sides."""
    top = cq.Workplane("XZ").rect(100, 30).extrude(60, both=True).rotate((0, 0, 0), (0, 1, 0), leans).translate((0, 0, 27))
    part = cq.Workplane().box(60, 40, 20).translate((0, 0, 10)).cut(top).cut(cq.Workplane().circle(2.5).extrude(40)).val()
    made = made_with(drill(5.0), shape=part, machine="3-axis", setup="+z")
    (step,) = made.process.drilling
    assert [each.slope_deg for each in step.holes] == ([pytest.approx(leans, abs=0.3)] if steep else [None])
    assert any("begins on a slope of 20" in each for each in made.process.doubts) == steep
    rod = cq.Workplane("YZ").circle(8).extrude(60).cut(cq.Workplane().center(30, 0).circle(2.5).extrude(20, both=True)).val()
    assert [each.slope_deg for step in made_with(drill(5.0), shape=rod, machine="3-axis", setup="+z").process.drilling
            for each in step.holes] == [None]  # fmt: skip


def test_their_seconds_are_in_those_of_the_process(planned):
    process, assumed = planned.process, planned.operations.assumed
    assert process.seconds == pytest.approx(math.fsum([process.cutting_seconds, process.link_seconds, process.index_seconds,
                                                       process.change_seconds, process.setup_seconds]))  # fmt: skip
    mills = next(each for each in planned.operations.plans if each.name == process.plan)
    assert process.cutting_seconds - mills.cutting_seconds == pytest.approx(sum(step.seconds for step in process.drilling))
    assert process.link_seconds - mills.link_seconds == pytest.approx(5 + 1 + 1 + 1)
    # One cutter and eight tools for holes, each once to its orientation.
    assert process.change_seconds == pytest.approx(8 * assumed.change_s)
    assert sum(step.index_seconds for step in process.drilling) == pytest.approx(8 * assumed.index_s)


def test_they_stand_in_the_table_under_their_setup(planned):
    lines = planned.text.lines
    first = next(k for k, line in enumerate(lines) if line.startswith("Setup 1"))
    rows = [k for k, line in enumerate(lines) if "drill D" in line and " hole" in line]
    assert rows
    assert min(rows) > first
    number = len(planned.process.steps)
    assert any(line.split()[0] == str(number + 1) and "drill D4.5 x" in line for line in lines)
    assert not any(face in step.faces for hole in planned.holes for face in hole.faces for step in planned.process.steps)


def test_a_flat_bottom_is_asked_of_mills(planned):
    """With a mill that is too wide the bottom is left, by name, and no drill is called to make the hole."""
    hole = next(hole for hole in planned.holes if hole.diameter_mm == 8.0)
    assert hole.bottom == "flat"
    assert len(hole.faces) == 1
    wide = made_with(*TOOLS, cutters=["D10L40F25S10"])
    same = next(hole for hole in wide.holes if hole.diameter_mm == 8.0)
    assert (same.drilled, same.tool) == (False, None)
    assert [missing_words(each) for each in same.missing] == ["D8 x 12 (no mill reaches its bottom)"]
    floor = next(face.id for face in wide.faces if face.shape == "plane" and face.centre_mm[2] == pytest.approx(-12.0))
    assert any(floor in each.faces for each in wide.process.left)
    assert wide.process.finished_share < 1.0


def test_a_hole_over_a_floor_that_is_less_deep_than_a_point_is_milled():
    shape = block(40, 40, 16).pushPoints([(-8, 0)]).hole(8.0, 2.3).pushPoints([(8, 0)]).hole(8.0, 2.6).val()
    assert [hole.depth_mm for hole in made_with(drill(8.0), shape=shape).holes] == pytest.approx([2.6])


@pytest.mark.parametrize(("without", "kind", "missing"), [
    (6, "countersink", "countersink D9 x 90 deg"), (4, "reamer", "D10 x 16"), (5, "reamer", "D10 x 16"),
])  # fmt: skip
def test_what_no_tool_makes_is_named(without, kind, missing):
    made = made_with(*(tool for k, tool in enumerate(TOOLS) if k != without))
    assert not of_kind(made, kind)
    assert [missing_words(each) for hole in made.holes for each in hole.missing] == [missing]
    assert f"no tool makes {missing}." in " ".join(" ".join(made.text.lines).split())
    assert made.text.headline.endswith(f"; 1 of {len(made.holes)} holes lacks a tool or a setup.")
    assert "a tool or a setup" not in made_with(*TOOLS).text.headline


def test_a_counterbore_without_its_tool_is_milled():
    made = made_with(*TOOLS[:7])
    walls = {face.id for face in made.faces if face.shape == "cylinder" and face.carrier.radius_mm == 5.5}
    assert any(walls.intersection(step.faces) for step in made.process.steps)
    # Of mills that are all wider it is not asked, and named.
    wide = made_with(*TOOLS[:7], cutters=["D12L40F25S12"])
    assert not any(walls.intersection(step.faces) for step in wide.process.steps)
    assert ["counterbore D11"] in [[missing_words(each) for each in hole.missing] for hole in wide.holes]


def test_a_drill_of_its_size_comes_before_a_reamer():
    made = made_with(*TOOLS, drill(10.0))
    assert not of_kind(made, "reamer")


def test_a_tap_is_not_guessed():
    made = made_with(*TOOLS, drill(5.0, kind="tap", point=None))
    assert not of_kind(made, "tap")


def test_a_centre_drill_of_the_library_comes_before_each_drill(planned):
    assert not of_kind(planned, "centre drill")
    made = made_with(*TOOLS, drill(6.0, flutes=20.0, kind="centre drill", point=90.0))
    steps = of_kind(made, "centre drill")
    assert sum(len(step.holes) for step in steps) == len(made.holes)
    for step in steps:
        for each in step.holes:
            # Its cone is no wider than the hole.
            assert 2.0 * step.depth_mm <= made.holes[each.hole].diameter_mm + 1e-6
    assert made.process.drilling[0].kind == "centre drill"


def test_a_chamfer_at_the_far_end_is_sunk_from_there():
    tool = cq.Workplane("XZ").polyline([(0, -17), (4, -17), (2, -15), (2, 1), (0, 1)]).close()
    shape = block(30, 30, 16).cut(tool.revolve(360, (0, 0, 0), (0, 1, 0))).val()
    tools = drill(4.0), drill(12.4, flutes=12.0, kind="countersink", point=90.0)
    made = made_with(*tools, shape=shape, setup="+z", machine="tilt:5")
    assert any(each.thing == "countersink" for hole in made.holes for each in hole.missing)
    both = made_with(*tools, shape=shape, setup="+z", other_setups=["-z"], machine="tilt:5")
    assert {step.setup for step in of_kind(both, "countersink")} == {1}
    assert all(step.axis == pytest.approx((0.0, 0.0, -1.0)) for step in of_kind(both, "countersink"))


def test_an_axis_that_no_setup_has_is_named():
    shape = block(40, 40, 20).cut(drilled(5.0, 12.0).rotate((0, 0, 0), (0, 1, 0), 90).translate((20, 0, -10))).val()
    made = made_with(drill(5.0), shape=shape, machine="tilt:5", setup="+z")
    assert [missing_words(each) for each in made.holes[0].missing] == ["D5 x 12 (no setup has its axis)"]


def test_a_drill_without_a_feed_has_no_time():
    library = library_of(*TOOLS, feed=None)
    made = plan(plate(), **{**WORDS, "libraries": [library], "feed": None, "operations": None}).plan
    assert {step.seconds for step in made.process.drilling} == {None}
    assert made.process.seconds is None


def _question(folder, shape, words):
    cq.exporters.export(cq.Workplane(shape), str(folder / "plate.step"))
    plan(folder / "plate.step", **words).write(folder, ["json", "npz"])
    document = json.loads((folder / "plan.json").read_text())
    arrays = {name: dict(np.load(folder / name)) for name in ("samples.npz", "operations.npz")}
    return question_of(read_part(folder / "plate.step"), Options(**words), document, arrays)


def test_a_tool_that_comes_back_in_the_next_setup_is_changed_to_again(tmp_path):
    """A pocket and bores from above, a pocket and a bore from below: mills and a drill come back."""
    shape = block(60, 40, 16).cut(cq.Workplane("XY").box(20, 20, 8).translate((-12, 0, 0)))
    shape = shape.cut(cq.Workplane("XY").box(20, 20, 8).translate((12, 0, -16)))
    for x, y, turn in ((-26.0, 16.0, 0.0), (-26.0, -16.0, 0.0), (26.0, 16.0, 180.0)):
        shape = shape.cut(drilled(5.0, 7.0, 118.0, (x, y)).rotate((0, 0, -8), (1, 0, -8), turn))
    words = {"cutters": ["D12L40F25S12", "D6L40F25S6"], "machine": "3-axis", "other_setups": ((0, 0, -1),)}
    question = _question(tmp_path, shape.val(), {**WORDS, **words, "libraries": [library_of(drill(5.0))]})
    process, assumed = question.document["process"], question.document["operations"]["assumed"]
    # Step for step as the table has them: the tool in the spindle, setup by setup, mills before drills.
    rows = [(step["setup"], step["cutter"]) for step in process["steps"]]
    rows += [(step["setup"], step["tool"]) for step in process["drilling"]]
    spindle = [tool for number in (0, 1) for setup, tool in rows if setup == number]
    changes = sum(spindle[k] != spindle[k - 1] for k in range(1, len(spindle)))
    assert changes > len(set(spindle)) - 1
    assert process["change_seconds"] == pytest.approx(changes * assumed["change_s"])
    names = ("cutting", "link", "index", "change", "setup")
    assert process["seconds"] == pytest.approx(sum(process[f"{name}_seconds"] for name in names))
    assert not on_paper(question).entries.differ


@pytest.fixture(scope="module")
def written(tmp_path_factory):
    question = _question(tmp_path_factory.mktemp("drilled"), plate(), {**WORDS, "libraries": [library_of(*TOOLS)]})
    return question, Bench(resting(question), lambda doing: None)


def test_the_checker_puts_the_tools_down(written):
    question, _ = written
    answer = check(question, seconds=1e6)
    assert [each.words for each in answer.findings if each.holds is False] == []
    assert [each.holds for each in answer.findings if "were put down in holes" in each.words] == [True]


def _wrong(written, forge):
    """The words of the checker on drilling, of a plan that is changed."""
    question, bench = written
    document = copy.deepcopy(question.document)
    forge(document)
    (found,) = findings(replace(question, document=document), bench, Clock(math.inf))
    return "" if found.holds else found.words


def _moved(step, by):
    """A step whose tools go deeper by so much, its depth and seconds written to fit."""
    axis = np.array(step["axis"])
    for each in step["holes"]:
        each["tip_mm"] = (np.array(each["tip_mm"]) - by * axis).tolist()
    step["seconds"] *= (step["depth_mm"] + by) / step["depth_mm"]
    step["depth_mm"] += by


def _step(document, kind, diameter):
    return next(step for step in document["process"]["drilling"] if (step["kind"], step["diameter_mm"]) == (kind, diameter))


@pytest.mark.parametrize(("kind", "diameter", "by", "words"), [
    ("drill", 5.0, 0.5, "does not stand free"), ("drill", 5.0, -0.5, "is not as deep"),
    ("drill", 8.0, 0.5, "cuts into its bottom"), ("drill", 4.5, -4.0, "is not as deep"),
    ("drill", 4.5, 22.0, "flutes that are too short"),
    ("counterbore", 11.0, 0.3, "does not stand free"), ("counterbore", 11.0, -0.3, "does not reach the bottom"),
    ("countersink", 9.0, 0.3, "does not stand free"), ("countersink", 9.0, -0.3, "does not reach the bottom"),
])  # fmt: skip
def test_a_forged_depth_is_refused(written, kind, diameter, by, words):
    assert words in _wrong(written, lambda document: _moved(_step(document, kind, diameter), by))


def test_a_holder_in_the_way_is_seen(written):
    """The same tool, held 30 mm shorter than it is, would stand with its holder in the part."""
    question, bench = written

    def shorter(drill):
        return replace(drill, sizes=replace(drill.sizes, sections=tuple(replace(s, low=6.0) for s in drill.sizes.sections)))

    drills = {name: shorter(each) for name, each in question.drills.items()}
    (found,) = findings(replace(question, drills=drills), bench, Clock(math.inf))
    assert "does not stand free" in found.words


def _aside(step, document):
    for each in step["holes"]:
        for name in ("mouth_mm", "tip_mm"):
            each[name][0] += 1.0


def _another_tool(step, document):
    step["tool"] = _step(document, "drill", 6.6)["tool"]


def _leaning(step, document):
    step["axis"] = [0.0, 0.0, -1.0]


def _quick(step, document):
    step["seconds"] *= 0.5


def _gone(step, document):
    document["process"]["drilling"].remove(step)


@pytest.mark.parametrize("forge", [_aside, _another_tool, _leaning, _quick, _gone])
def test_a_forged_step_is_refused(written, forge):
    question, _ = written
    document = copy.deepcopy(question.document)
    assert not on_paper(question).entries.differ
    forge(_step(document, "drill", 5.0), document)
    assert any(each.startswith(("process", "holes")) for each in on_paper(replace(question, document=document)).entries.differ)
