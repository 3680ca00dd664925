"""What the workbench takes from FreeCAD's CAM: tool bits that state a holder or not, and jobs with controllers and stock."""

import json
import shutil
import sys
from types import ModuleType, SimpleNamespace

import numpy as np
import pytest

from plan_cutters.library import read_library
from tests.support.freecad_host import CONSOLE, run
from tests.support.places import ROOT
from tests.support.workbench import imported

OUTLINE = [[0, 0], [10, 0], [12, 5], [12, 30], [0, 30]]


@pytest.fixture
def cam():
    with imported("freecad.plan_cutters.cam") as module:
        yield module


def bit(cam, label, **more):
    return cam.Bit(label, label, True, **{"flutes": 15.0, **more})


def test_what_bits_do_not_state_is_asked_in_words_of_the_panel(cam):
    both = [bit(cam, "Mill10"), bit(cam, "Ball6", stick_out=30.0, held=True)]
    asked = cam.missing(both, "", None)
    assert set(asked) == {cam.STICK_OUT, cam.HOLDER, cam.BOTH}
    assert all("Mill10" in line and "Ball6" not in line and "--" not in line for line in asked.values())
    assert "“Stick-out”" in asked[cam.STICK_OUT]
    assert cam.line_of(asked) == "fill in “Stick-out” and “Holder”, which Mill10 do not state"
    assert set(cam.missing(both, "er32", None)) == {cam.STICK_OUT}
    assert set(cam.missing(both, "", 20.0)) == {cam.HOLDER}
    assert cam.missing(both, "none", 20.0) == cam.missing(both[1:], "", None) == cam.missing([], "", None) == {}


def test_a_stick_out_shorter_than_the_flutes_is_asked_again(cam, monkeypatch):
    monkeypatch.setattr(cam, "length", lambda mm: f"{mm:g} mm")
    (line,) = cam.missing([bit(cam, "Mill10")], "none", 14.0).values()
    assert "shorter than the flutes of Mill10, 15 mm" in line
    assert cam.missing([bit(cam, "Mill10")], "none", 15.0) == {}


@pytest.mark.parametrize(
    ("covered", "chosen"), [((), 1), ((1,), 2), ((1, 2), 1)], ids=["nothing covers", "the next one", "all are covered"]
)
def test_the_eye_stands_where_neither_part_nor_tool_covers_the_spot(covered, chosen):
    """Directions 0 and 3 end in the part; where the tool covers the others, one sees through the tool."""
    eyes = [np.array([1.0, number, 0.0]) for number in range(4)]
    walls = SimpleNamespace(foraminate=lambda point, eye: {0: (9.0, 9.0, 0.0)} if eye[1] in (0.0, 3.0) else {})
    with imported("freecad.plan_cutters.camera") as camera:
        camera.App.Vector = lambda *numbers: np.array(numbers)
        found = camera.clear_of(walls, np.zeros(3), eyes, 0.1, lambda eye: eye[1] in covered)
    assert found is eyes[chosen]


@pytest.mark.parametrize(
    ("parameter", "states"),
    [({}, (False, False)), ({"Stickout": "0 mm"}, (False, False)), ({"Stickout": "1.25 in", "ToolHolder": "er32"}, (True, True))],
)
def test_a_bit_in_a_file_states_what_its_file_says(cam, tmp_path, parameter, states):
    path = tmp_path / "a.fctb"
    path.write_text(json.dumps({"name": "Mill", "shape": "endmill.fcstd", "parameter": parameter}))
    found = cam.bit_of_file(str(path))
    assert (found.label, found.stick_out is not None, found.held) == ("Mill", *states)
    for text in ("{", "[]", "7", '{"parameter": 1}'):
        path.write_text(text)
        assert cam.bit_of_file(str(path)) is None
    assert cam.bit_of_file(str(tmp_path / "shop.tools")) is None


class Holder:
    """A holder as FreeCAD's newest release has it."""

    @staticmethod
    def to_dict():
        return {"version": 1, "name": "ER32 nut", "units": "mm", "profile": OUTLINE}


def test_a_bit_of_the_newest_release_brings_its_holder_and_stick_out(tmp_path):
    """What the program is given reads as a cutter of that length in that holder, without the fields of the panel."""
    thing = SimpleNamespace(
        Name="Bit", Label="Mill10", ShapeType="Endmill", Diameter=1, ToolHolder="ER32", Stickout=SimpleNamespace(Value=40.0),
        Proxy=SimpleNamespace(get_holder=Holder),
    )  # fmt: skip
    sizes = {"Diameter": "10.0 mm", "CuttingEdgeHeight": "30.0 mm", "ShankDiameter": "10.0 mm", "Length": "70.0 mm",
             "Stickout": "40.0 mm"}  # fmt: skip
    with imported("freecad.plan_cutters.files") as files, pytest.MonkeyPatch.context() as patch:
        patch.setattr(files.model, "thing_of", lambda *_: thing)
        patch.setattr(files.host, "lengths", lambda _: dict(sizes))
        job = files.model.Job("D", "B", tools=files.model.Tools(bits=("Bit",)))
        path = files._bits(job, str(tmp_path))
        assert files.cam.missing([files.cam._bit(thing)], "", None) == {}
        # A holder that is named and not there is never left out.
        for lost in (lambda: None, lambda: 1 / 0):
            thing.Proxy = SimpleNamespace(get_holder=lost)
            with pytest.raises(files.model.Refused, match="the holder of Mill10 cannot be read: ER32"):
                files._bits(job, str(tmp_path / "lost"))
    # Not where the modules of the program would be forgotten.
    (cutter,) = read_library(path)
    assert (cutter.radius, cutter.length, cutter.name, cutter.holder.id) == (5.0, 40.0, "Mill10", "R10:12L5+R12L25")


def test_faults_of_the_program_have_the_words_of_the_panel():
    line = (
        "plan-cutters: a.fctl: FreeCAD library: its only tool cannot be used: length below the holder is missing (the stick-out, "
        "from the tip to the holder's nose): add it, or give --assume-stickout MM; its holder is missing: add it, or give "
        "--holder SPEC, as R15L30 (or none)"
    )
    with imported("freecad.plan_cutters.runner") as runner:
        process = SimpleNamespace(lines=[line], popen=SimpleNamespace(returncode=2))
        told = runner.Process.fault(process)
    assert "--" not in told
    assert "fill in “Stick-out”" in told
    assert "choose one in “Holder”" in told


def test_planes_are_made_by_freecad_where_it_has_a_function_for_them(monkeypatch):
    """A job of the newest release files a plane that it made; a second operation on that plane takes the same one."""
    text = (ROOT / "freecad" / "PlanOperations.FCMacro").read_text(encoding="utf-8")
    for name in ("FreeCAD", "Part", "Path", "Path.Main"):
        monkeypatch.setitem(sys.modules, name, ModuleType(name))
    made = {"__name__": "macro"}
    exec(compile(text, "PlanOperations.FCMacro", "exec"), made)
    ours, job = SimpleNamespace(Label="op1 plane", Placement="here"), SimpleNamespace(Workplanes=SimpleNamespace(Group=[]))
    job.Workplanes.addObject = job.Workplanes.Group.append
    assert made["filed"](job, ours) is ours
    assert job.Workplanes.Group == [ours]
    job.Workplanes.Group.clear()

    def create(job, base=None, sub=None, label=None, placement=None):
        assert base is sub is None
        plane = SimpleNamespace(Label=label, Placement=placement)
        job.Workplanes.addObject(plane)
        return plane

    newer = ModuleType("Path.Main.Workplane")
    newer.createWorkplane = create
    monkeypatch.setitem(sys.modules, "Path.Main.Workplane", newer)
    theirs = made["filed"](job, ours)
    assert (theirs is not ours, theirs.Label, theirs.Placement) == (True, "op1 plane", "here")
    assert made["filed"](job, ours) is theirs
    assert job.Workplanes.Group == [theirs]


INSIDE = """
import json, os, types
import FreeCAD as App, Part
from freecad.plan_cutters import cam, files, model, objects, operations, runner
import PathScripts.PathJob as jobs, PathScripts.PathToolBit as bits, PathScripts.PathToolController as controllers
found, told = {}, []
document = App.newDocument("Work")
document.UndoMode = 1
block = document.addObject("Part::Feature", "Block")
block.Shape = Part.makeBox(40, 40, 20).cut(Part.makeBox(20, 40, 10, App.Vector(10, 0, 10)))
document.recompute()
job = jobs.Create("Job", [block])
bit = bits.Factory.Create("Mill", "endmill.fcstd")
bit.Label, bit.Diameter, bit.CuttingEdgeHeight, bit.Length, bit.ShankDiameter = "Mill10", "10 mm", "22 mm", "70 mm", "10 mm"
drill = bits.Factory.Create("Drill", "drill.fcstd")
first = job.Tools.Group[0]
first.Tool.Label = "Left alone"
held = controllers.Create("TC_Mill10", tool=bit, toolNumber=7)
held.Label = "TC: Mill10"
held.HorizFeed, held.VertFeed, held.SpindleSpeed = "900 mm/min", "300 mm/min", 8000
job.Proxy.addToolController(held)
document.recompute()
found["bits"] = [[each.label, each.mill, each.stick_out, each.held, each.flutes] for each in cam.bits(document)]
found["controllers"] = {name: [each.number, each.feed] for name, each in cam.controllers(job).items()}
selected = [types.SimpleNamespace(Object=job, SubElementNames=())]
found["taken"] = list(model.picked(selected))
found["is it"] = [cam.job_of(selected) is job, cam.job_of([types.SimpleNamespace(Object=block)]), cam.job_of(selected * 2)]
found["stock"] = [cam.stock_over(job)]
job.Stock.ExtXneg = 0.25
document.recompute()
found["stock"].append(cam.stock_over(job))
job.Stock.ExtZpos = 0
document.recompute()
found["stock"].append(cam.stock_over(job))

asked = model.Job(
    *found["taken"], tools=model.Tools(bits=(bit.Name,), holder="none", stick_out=40.0, cam_job=job.Name), machine="trunnion-ac",
    options=("--faces", "all", "--grid", "4", "--area-budget", "0", "--operations", "fewest"),
)
got = []
runner.Run(asked, lambda *_: None, got.append, told.append).wait(150)
found["told"] = told
plan = got[0].plan
(cutter,) = plan["cutters"]
found["cutter"] = [cutter["name"], [each["number"] for each in cutter["sources"]], plan["effective"]["units"]]
found["seconds"] = [each["seconds"] for each in plan["operations"]["plans"][0]["operations"]]
group = objects.show(document, got[0])
before = {each.Name for each in document.Objects if hasattr(each, "ShapeName")}
made = operations.make_job(group)
found["new bits"] = sorted({each.Name for each in document.Objects if hasattr(each, "ShapeName")} - before)
found["job"] = [[each.Label, each.Tool.Name == bit.Name, each.ToolNumber, each.HorizFeed.Value * 60, each.VertFeed.Value * 60,
                 each.SpindleSpeed] for each in made.Tools.Group]
found["kept"] = [each.Tool.Label for each in job.Tools.Group]
# A bit that was changed after the plan is another tool.
bit.Diameter = "9 mm"
document.recompute()
found["changed"] = list(operations.own_bits(document, objects.result_of(group)))
"""


@pytest.mark.slow("needs FreeCAD", together="FreeCAD")
@pytest.mark.skipif(not CONSOLE, reason="FreeCAD is not installed")
def test_a_job_is_planned_with_its_tools_and_gets_the_users_own_bits(tmp_path):
    shutil.copytree(ROOT / "freecad", tmp_path / "user" / "Mod" / "Cutters", ignore=shutil.ignore_patterns("__pycache__"))
    found = run([CONSOLE], INSIDE, tmp_path, FREECAD_USER_DATA=str(tmp_path / "user"))
    assert found["told"] == []
    assert {label: (mill, stick_out, held) for label, mill, stick_out, held, _ in found["bits"]} == {
        "Left alone": (True, None, False), "Mill10": (True, None, False), "Drill": (False, None, False)
    }  # fmt: skip
    assert [flutes for label, *_, flutes in found["bits"] if label == "Mill10"] == [22.0]
    # FreeCAD put another one there, which nobody used.
    assert [*found["controllers"].values()] == [[7, pytest.approx(900.0)]]
    # The job's own copy of the block: that is where its stock and work planes are.
    assert found["taken"] == ["Work", "Clone", []]
    assert found["is it"] == [True, None, None]
    # FreeCAD's stock stands 1 mm over the model at first.
    assert found["stock"] == [1.0, 0.25, 0.0]
    assert found["cutter"] == ["Mill10", [7], "mm"]
    assert found["seconds"]
    assert all(seconds > 0 for seconds in found["seconds"])
    assert found["new bits"] == []
    assert found["job"] == [["TC: Mill10 (2)", True, 7, pytest.approx(900.0), pytest.approx(300.0), 8000.0]]
    assert found["kept"] == ["Left alone", "Mill10"]
    assert found["changed"] == []
