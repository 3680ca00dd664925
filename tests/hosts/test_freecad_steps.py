"""Steps of a plan as the workbench edits them, without FreeCAD, and judged again with it."""

import json
import shutil
from types import SimpleNamespace

import pytest

from plan_cutters import plan
from plan_cutters.machines.process_file import process_of
from tests.support.cad_parts import box
from tests.support.freecad_host import CONSOLE, IN_WINDOW, run
from tests.support.places import ROOT
from tests.support.workbench import imported

FLAT, BALL = "D12L60F26", "D6L40rc3F16"
OPTIONS = {"faces": "all", "area_budget": 0, "feed": 1000.0, "machine": "trunnion-ac", "grid": 5, "cutters": [FLAT, BALL]}
OWN = {
    "rest": "leave",
    "step": [
        {"cutter": FLAT, "angles": {"C": 0.0, "A": 130.5}, "faces": ["F3"]},
        {"cutter": BALL, "mode": "simultaneous", "faces": ["F1", "F2"], "take": "share"},
        {"cutter": FLAT, "angles": {"C": 0.0, "A": 0.0}, "faces": ["F1"]},
    ],
    "forbid": [{"cutter": BALL, "faces": ["F5"]}],
}


@pytest.fixture(scope="module")
def own():
    """The module that edits steps."""
    with imported("freecad.plan_cutters.own_process") as module:
        yield module


@pytest.fixture(scope="module")
def document():
    """A plan with a process of the planner's own, as FreeCAD reads it."""
    return json.loads(plan(box(40.0, 30.0, 20.0), **OPTIONS, process=OWN).plan.model_dump_json())


def test_the_steps_of_a_plan_come_back_as_they_were_written(own, document):
    """Shown, and handed over again unchanged, the program reads the same steps."""
    steps = own.steps_of(document)
    again = process_of(json.loads(own.process_of(steps, document, rest=False)))
    asked = process_of(document["effective"]["process"])
    assert (again.rest, again.forbidden) == (asked.rest, asked.forbidden)
    for mine, theirs in zip(again.steps, asked.steps, strict=True):
        kept = ("setup", "mode", "angles", "take")
        assert [getattr(mine, each) for each in kept] == [getattr(theirs, each) for each in kept]
        assert {*mine.faces} <= {*theirs.faces}
    ids = {each["name"]: each["id"] for each in document["cutters"]}
    assert [each.cutter for each in steps] == [FLAT, BALL, FLAT]
    assert [ids[each.cutter] for each in steps] == [each.cutter for each in asked.steps]
    assert [each.turned for each in steps] == ["C 0 A 130.5", "simultaneous", "C 0 A 0"]
    assert steps[0].fault.startswith("Step 1: the machine cannot hold this orientation: ")
    assert "would take" in steps[0].fault
    assert steps[2].faces == "F1"
    assert process_of(json.loads(own.process_of(steps, document, rest=True))).rest == "plan"


def test_rows_are_moved_left_out_and_changed(own, document):
    steps = own.steps_of(document)
    first, second, third = steps
    assert own.moved(steps, 0, 1) == [second, first, third]
    assert own.moved(steps, 0, -1) == own.moved(steps, 2, 1) == own.moved(steps, -1, 1) == steps
    assert own.without(steps, 1) == [first, third]
    other = own.edited(first, "turned", "C 0 A 0")
    assert (other.turned, other.area, other.alone, other.fault) == ("C 0 A 0", None, None, "")
    assert own.edited(first, "cutter", first.cutter) is first


@pytest.mark.parametrize(
    ("text", "turned"),
    [
        ("C 0 A 90", {"angles": {"C": 0.0, "A": 90.0}}),
        ("  A=-7.5, C 1e2 ", {"angles": {"A": -7.5, "C": 100.0}}),
        ("C0A.5", {"angles": {"C": 0.0, "A": 0.5}}),
        ("axis 0 0.5, -1", {"axis": [0.0, 0.5, -1.0]}),
        ("Simultaneous", {"mode": "simultaneous"}),
    ],
)  # fmt: skip
def test_an_orientation_is_read_from_its_text(own, text, turned):
    assert own.turned_of(text, "step 1", ("C", "A")) == turned


@pytest.mark.parametrize("text", ["", "up", "C 0 A nan", "C 0,5 A 90", "C 0 C 1", "B 0", "axis 0 1", "C 0 A 90 x", "axis a b c"])
def test_what_is_no_orientation_is_one_line_with_its_step(own, text):
    with pytest.raises(Exception, match=r"^step 4: “.*” is no orientation: write C 0 A 0, or simultaneous$"):
        own.turned_of(text, "step 4", ("C", "A"))


@pytest.mark.parametrize(
    ("change", "said"),
    [({"faces": "top"}, "step 2: faces"), ({"faces": ""}, "step 2: faces"), ({"faces": "left F1"}, "step 2: faces"),
     ({"cutter": " "}, "step 2: the cutter is missing")],
)  # fmt: skip
def test_a_wrong_row_is_one_line_with_its_step(own, document, change, said):
    steps = own.steps_of(document)
    (name, text), *_ = change.items()
    steps[1] = own.edited(steps[1], name, text)
    with pytest.raises(Exception, match=f"^{said}"):
        own.process_of(steps, document, rest=True)
    with pytest.raises(Exception, match="no step"):
        own.process_of([], document, rest=True)


def test_a_plan_of_an_older_program_has_no_steps(own):
    assert own.steps_of({}) == own.steps_of({"process": None}) == []


def test_a_job_hands_its_steps_over_as_a_file(tmp_path):
    """The words of the command name a file that has the steps; a map at one point has none."""
    with imported("freecad.plan_cutters.files") as files, pytest.MonkeyPatch.context() as patch:
        shape = SimpleNamespace(Faces=[0, 0])
        patch.setattr(files.model, "thing_of", lambda *_: SimpleNamespace(Label="Block"))
        patch.setattr(files.model, "shape_of", lambda _: shape)
        patch.setattr(files.model, "fingerprint", lambda _: "")
        patch.setattr(files, "exported", lambda *_: "block.brep")
        patch.setattr(files, "command", lambda: ["plan-cutters"])
        job = files.model.Job("D", "B", process=json.dumps(OWN))
        words, _ = files.words(job, str(tmp_path))
        assert json.loads((tmp_path / "process.json").read_text()) == OWN
        assert words[words.index("--process") + 1] == str(tmp_path / "process.json")
        assert files.model.job_of({**vars(files.model.Job("D", "B")), "tools": vars(files.model.Tools())}).process == ""
        result = SimpleNamespace(job=job, plan={})
        assert files.of_one_point(result).process == ""


INSIDE = """
import dataclasses, json
import FreeCAD as App, Part
from freecad.plan_cutters import model, objects, own_process, runner
document = App.newDocument("Work")
block = document.addObject("Part::Feature", "Block")
block.Shape = Part.makeBox(40, 30, 20)
document.recompute()
found, told = {}, []
job = model.Job("Work", "Block", tools=model.Tools(specs=("D12L60F26", "D6L40rc3F16")), machine="trunnion-ac",
                options=("--faces", "all", "--grid", "5", "--area-budget", "0", "--feed", "1000", "--operations", "fastest"))

def planned(job):
    got = []
    run = runner.Run(job, lambda *_: None, got.append, told.append)
    run.wait(150)
    return got[0] if got else None

first = planned(job)
steps = own_process.steps_of(first.plan)
found["first"] = [len(steps), first.plan["process"]["finished_share"]]
process = own_process.process_of(own_process.without(steps, 0), first.plan, rest=False)
less = planned(dataclasses.replace(job, process=process))
again = less.plan["process"]
found["less"] = [[each["own"]["number"] for each in again["steps"]], again["finished_share"]]
group = objects.show(document, less)
kept = objects.result_of(group)
found["kept"] = json.loads(kept.job.process) == json.loads(process)
wrong = [own_process.edited(steps[0], "cutter", "R9L9")]
planned(dataclasses.replace(job, process=own_process.process_of(wrong, first.plan, rest=True)))
found["told"] = told
"""


@pytest.mark.slow("needs FreeCAD", together="FreeCAD")
@pytest.mark.skipif(not CONSOLE, reason="FreeCAD is not installed")
def test_steps_are_judged_again_in_freecad(tmp_path):
    shutil.copytree(ROOT / "freecad", tmp_path / "user" / "Mod" / "Cutters", ignore=shutil.ignore_patterns("__pycache__"))
    found = run([CONSOLE], INSIDE, tmp_path, FREECAD_USER_DATA=str(tmp_path / "user"))
    assert found["first"] == [pytest.approx(found["first"][0]), 1.0]
    assert found["less"][0] == [*range(1, found["first"][0])]
    assert found["less"][1] < 1.0
    assert found["kept"] is True
    (line,) = found["told"]
    assert "process.json: step 1: cutter 'R9L9'" in line


SESSION = (
    IN_WINDOW
    + """
import json, os, sys, time, traceback
import FreeCAD as App, Part
import FreeCADGui as Gui

def session():
    from freecad.plan_cutters import findings, model, objects, runner
    document = App.newDocument("Work")
    block = document.addObject("Part::Feature", "Block")
    block.Shape = Part.makeBox(40, 30, 20)
    document.recompute()
    Gui.getMainWindow().resize(1366, 768)
    got = []
    job = model.Job("Work", "Block", tools=model.Tools(specs=("D12L60F26",)), machine="trunnion-ac",
                    options=("--faces", "all", "--grid", "4", "--area-budget", "0", "--feed", "1000", "--operations", "fastest"))
    run = runner.Run(job, lambda *_: None, got.append, got.append)
    pump(lambda: bool(got), 90)
    panel = findings.open_panel(objects.show(document, got[0]))
    box = panel.steps
    rows = lambda: [[box.list.topLevelItem(k).text(c) for c in range(5)] for k in range(box.list.topLevelItemCount())]
    first = found["rows"] = rows()
    pump()
    box.form.grab().save("steps.png")
    head = lambda panel: panel.steps.form.findChild(QtGui.QLabel, "steps_head").text()
    before = head(panel)
    # Moved, changed by typing, left out.
    box.list.setCurrentItem(box.list.topLevelItem(0))
    box._down.click()
    found["moved"] = [rows(), box.place]
    box._up.click()
    box.list.topLevelItem(0).setText(2, "C 5 A five")
    pump()
    box.again.click()
    found["wrong"] = [box.told.text(), box._run is None]
    box.list.topLevelItem(0).setText(2, first[0][2])
    pump()
    found["unknown"] = [rows()[0][0], box.told.text()]
    while len(box.steps) > 1:
        box._out.click()
        box.list.setCurrentItem(box.list.topLevelItem(len(box.steps) - 1))
    box.rest.setChecked(False)
    # Ended before it answers, then judged.
    box.again.click()
    found["running"] = [box.again.text(), box._up.isEnabled()]
    box.again.click()
    found["ended"] = [box.again.text(), box.told.text()]
    box.again.click()
    pump(lambda: findings.LAST is not panel or box._run is None, 90)
    pump()
    again = findings.LAST
    found["again"] = [again is not panel, len(again.steps.steps), again.steps.rest.isChecked(), len(objects.plans(document))]
    found["headline"] = again._headline.text(), before, head(again)
    block.Shape = Part.makeBox(40, 30, 21)
    document.recompute()
    pump()
    again.steps.again.click()
    found["stale"] = [again.steps.told.text(), again.steps._run is None]

QtCore.QTimer.singleShot(1000, work)
"""
)


@pytest.mark.slow("needs FreeCAD", together="FreeCAD")
@pytest.mark.skipif(not (shutil.which("freecad") and shutil.which("xvfb-run")), reason="FreeCAD or a virtual display is missing")
def test_the_list_of_steps_is_edited_in_the_window(tmp_path):
    addon = tmp_path / "user" / ".local" / "share" / "FreeCAD" / "Mod" / "PlanCutters"
    shutil.copytree(ROOT / "freecad", addon, ignore=shutil.ignore_patterns("__pycache__"))
    display = ["xvfb-run", "-a", "-s", "-screen 0 1366x768x24"]
    found = run([*display, "freecad"], SESSION, tmp_path, HOME=str(tmp_path / "user"), QTWEBENGINE_DISABLE_SANDBOX="1",
                LIBGL_ALWAYS_SOFTWARE="1")  # fmt: skip
    rows = found["rows"]
    assert len(rows) > 1
    # The area comes first: a panel is narrow.
    assert all(row[0] and row[2] and row[4].startswith("F") for row in rows)
    assert found["moved"] == [[rows[1], rows[0], *rows[2:]], 1]
    assert "step 1: “C 5 A five” is no orientation" in found["wrong"][0]
    assert found["wrong"][1]
    assert found["unknown"] == ["", "Changed: judge again."]
    assert found["running"] == ["Cancel", False]
    assert found["ended"][0] == "Judge again"
    assert found["ended"][1].startswith("cancelled")
    assert found["again"] == [True, 1, False, 1]
    whole, before, after = found["headline"]
    assert (before, after) == ("", whole)
    assert whole
    assert "plan again" in found["stale"][0]
    assert found["stale"][1]
