"""Steps that drill in other files and answers: the same numbers as in the process; and sizes in inches."""

import csv
import json

import numpy as np
import pytest

from cad_io import read_part
from plan_cutters import plan
from plan_cutters.domain.drill import inch_name
from plan_cutters.options import Options
from plan_cutters.plan_file import load_plan
from plan_cutters.plan_file.words.holes import group_words, missing_tools
from plan_cutters_agents.plan_answers import planned as answered
from plan_cutters_check.asking import question_of
from plan_cutters_check.check import on_paper
from tests.support.drills import drill, library_of, tap
from tests.support.plates import block, drilled
from tests.support.stated import stated

WORDS = {"cutters": ["D6L40F25S6"], "faces": "all", "grid": 3, "area_budget": 0, "feed": 800, "operations": "fewest"}
TOOLS = drill(3.3), drill(5.0), tap(4.0, 0.7)
HAS = {1.65: {"value": 3.3, "notes": ["M4x0.7 - 6H"]}}


def plate():
    """A hole M4 through, and one with a drill's point from the side."""
    side = drilled(5.0, 9.0).rotate((0, 0, 0), (0, 1, 0), 90).translate((30, 0, -7))
    return block(60, 40, 14).pushPoints([(-12, 6)]).hole(3.3).cut(side).val()


def made(folder, machine, **words):
    file = stated(folder / "plate.step", plate(), HAS)
    given = {**WORDS, **words, "machine": machine, "libraries": [library_of(*TOOLS)]}
    result = plan(file, **given)
    result.write(folder, ["json", "npz"])
    return file, given, result.plan


@pytest.mark.parametrize("machine", ["trunnion-ac", "head-head-ca", "head-table-bc", "4-axis-a", "3-axis", "unlimited"])
def test_files_and_answers_have_the_numbers_of_the_process(tmp_path, machine):
    file, given, document = made(tmp_path, machine)
    steps = list(enumerate(document.process.drilling, len(document.process.steps) + 1))
    assert {step.kind for _, step in steps} == {"drill", "tap"}
    with (tmp_path / "operations.csv").open(encoding="utf-8", newline="") as rows:
        listed = [row for row in csv.DictReader(rows) if row["plan"] == "drilling"]
    answer = answered(document, 0, {}).drilling
    for (number, step), row, told in zip(steps, listed, answer, strict=True):
        assert (row["operation"], row["strategy"], row["cutter"]) == (f"step {number}", step.kind, step.tool)
        assert (told["number"], told["kind"], told["setup"], told["angles"]) == (
            number,
            step.kind,
            step.setup + 1,
            step.angles_deg,
        )
        for name in ("diameter_mm", "depth_mm", "pitch_mm", "seconds", "link_seconds"):
            want = getattr(step, name)
            assert told[name] == want
            assert row[name] == "" if want is None else float(row[name]) == pytest.approx(want, abs=6e-4)
        assert {name: float(row[f"{name}_deg"]) for name in step.angles_deg or {}} == pytest.approx(step.angles_deg or {})
        mouths = [[float(x) for x in each.split()] for each in row["mouths_mm"].split(";")]
        assert np.array(mouths) == pytest.approx(np.array([each.mouth_mm for each in step.holes]), abs=6e-4)
        assert [row[name] or None for name in ("g68_2", "g53_1", "rotary_words")] == [step.g68_2, step.g53_1, step.rotary_words]
        if step.frame is not None:
            assert np.array(step.frame.z) == pytest.approx(np.array(step.axis))
            assert abs(np.dot(step.frame.x, step.frame.z)) < 1e-9
    # A mill with the same angles in the same setup is set by the same words.
    mills = {(s.setup, tuple((s.angles_deg or {}).items())): s for s in document.process.steps if s.mode == "fixed"}
    for _, step in steps:
        mill = mills.get((step.setup, tuple((step.angles_deg or {}).items())))
        if mill is not None and step.frame is not None:
            assert (mill.g68_2, mill.rotary_words) == (step.g68_2, step.rotary_words)
    arrays = {name: dict(np.load(tmp_path / name)) for name in ("samples.npz", "operations.npz")}
    question = question_of(read_part(file), Options(**given), json.loads((tmp_path / "plan.json").read_text()), arrays)
    assert not on_paper(question).entries.differ
    assert load_plan(tmp_path / "plan.json").process.drilling == document.process.drilling


def test_the_checker_refuses_other_words_of_a_control(tmp_path):
    file, given, _ = made(tmp_path, "trunnion-ac")
    arrays = {name: dict(np.load(tmp_path / name)) for name in ("samples.npz", "operations.npz")}
    document = json.loads((tmp_path / "plan.json").read_text())
    step = next(each for each in document["process"]["drilling"] if each["axis"][2] < 0.5)
    for name, wrong in (("g68_2", "G68.2 P0 Q313 X0 Y0 Z0 I0 J0 K0"), ("g53_1", "G53.1 P9"), ("rotary_words", "G54 G0 A0 C0")):
        kept, step[name] = step[name], wrong
        question = question_of(read_part(file), Options(**given), document, arrays)
        assert any("drilling" in str(each) for each in on_paper(question).entries.differ)
        step[name] = kept


def test_an_inch_part_has_sizes_and_names_of_inch_drills(tmp_path):
    inch = 25.4
    shape = block(3 * inch, 2 * inch, 0.5 * inch)
    for k, diameter in enumerate((0.125, 0.201, 0.257, 0.3)):
        shape = shape.pushPoints([(inch * (0.7 * k - 1.05), 0)]).hole(diameter * inch)
    file = stated(tmp_path / "a.step", shape.val(), {0.5 * 0.201 * inch: {"value": 0.201, "notes": ["1/4-20 UNC-2B"]}}, inch=True)
    tools = drill(0.125 * inch, flutes=1.0 * inch), drill(0.257 * inch, flutes=0.5 * inch)
    words = {**WORDS, "machine": "trunnion-ac", "libraries": [library_of(*tools)], "units": "in"}
    document = plan(file, **words).plan
    assert missing_tools(document) == [
        "D0.201 (#7) x 0.5", "tap 1/4-20 UNC", "D0.257 (F) x 0.5 (flutes are too short)", "D0.3 x 0.5",
    ]  # fmt: skip
    text = " ".join(" ".join(document.text.lines).split())
    assert "drill D0.125 (1/8) x 0.5" in text
    assert "tap 1/4-20 UNC" in text
    assert "mm" not in [word for line in document.text.lines if "hole" in line for word in line.split()]
    by = {round(hole.diameter_mm / inch, 3): hole for hole in document.holes}
    assert (by[0.201].thread.name, by[0.201].thread.pitch_mm) == ("1/4-20 UNC", 1.27)
    assert group_words([by[0.125]]) == "D3.175, 12.7 deep, through"


@pytest.mark.parametrize(("inch", "name"), [
    (0.125, "1/8"), (0.1405, "#28"), (0.140625, "9/64"), (0.201, "#7"), (0.257, "F"), (0.5, "1/2"), (1.125, "1-1/8"), (1.0, "1"),
    (0.413, "Z"), (0.04, "#60"), (0.3, ""), (0.001, ""),
])  # fmt: skip
def test_drills_in_inches_have_names(inch, name):
    assert inch_name(inch) == name
