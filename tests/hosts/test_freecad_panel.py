"""The workbench in FreeCAD's window, installed by copying: picking, planning, cancelling, flying to a spot, settings."""

import math
import shutil

import numpy as np
import pytest

from tests.support.freecad_host import IN_WINDOW, run
from tests.support.places import ROOT

pytestmark = pytest.mark.slow("needs FreeCAD", together="FreeCAD")

WINDOW = shutil.which("freecad") and shutil.which("xvfb-run")

SESSION = (
    IN_WINDOW
    + """
import glob, json, os, sys, tempfile, time, traceback
import FreeCAD as App, Part
import FreeCADGui as Gui
V = App.Vector

def number_of(shape, area):
    return next(n for n, face in enumerate(shape.Faces, 1) if abs(face.Area - area) < 1e-6)

def session():
    found["benches"] = [name for name in Gui.listWorkbenches() if name == "PlanCutters"]
    Gui.activateWorkbench("PlanCutters")
    found["commands"] = sorted(name for name in Gui.listCommands() if name.startswith("PlanCutters_"))
    from freecad.plan_cutters import findings, objects, panel, remembered, windows
    found["where"] = os.path.relpath(panel.__file__, os.environ["HOME"])
    document = App.newDocument("Work")
    block = document.addObject("Part::Feature", "Block")
    block.Shape = Part.makeBox(40, 40, 20).cut(Part.makeBox(6, 30, 10, V(17, 5, 10)))
    clamp = document.addObject("Part::Feature", "Clamp")
    clamp.Shape = Part.makeBox(8, 8, 10, V(32, 16, 20))
    document.recompute()
    Gui.getMainWindow().resize(1366, 768)
    shape = block.Shape
    floor, top, side = number_of(shape, 180), number_of(shape, 1420), number_of(shape, 800)
    found["faces"] = sorted([floor, top])

    # Nothing selected, then faces, then clicks that go to one row and another.
    Gui.Selection.clearSelection()
    first = panel.open_panel()
    found["nothing"] = [first.status.text(), first._buttons.button(panel._PLAN).isEnabled()]
    first.reject()
    Gui.Control.closeDialog()
    for number in (floor, top):
        Gui.Selection.addSelection("Work", "Block", "Face%d" % number)
    one = panel.open_panel()
    found["taken"] = [one.part.body, list(one.part.faces), one.part.kind()]
    one.part.pick.setChecked(True)
    Gui.Selection.addSelection("Work", "Block", "Face%d" % side)
    found["three"] = list(one.part.faces)
    Gui.Selection.removeSelection("Work", "Block", "Face%d" % side)
    windows.choose(one.machine._setup, "picked")
    found["no axis"] = one.status.text()
    found["handed over"] = [one.part.pick.isChecked(), one.machine.pick_axis.isChecked(), list(one.part.faces)]
    Gui.Selection.clearSelection()
    Gui.Selection.addSelection("Work", "Block", "Face%d" % top)
    found["axis"] = one.machine.setup()
    one.machine.pick_fixtures.setChecked(True)
    Gui.Selection.addSelection("Work", "Block")
    found["own fixture"] = one.status.text()
    Gui.Selection.clearSelection()
    Gui.Selection.addSelection("Work", "Clamp")
    one.tools._typed.setText("R4L15, R2L12")
    one.tools._add_typed()
    one.tools._holder.setEditText("R8L30")
    windows.choose(one.machine._machine, "trunnion-ac")
    one.machine._more.setText("--spacing 4 '")
    found["quote"] = one.status.text()
    one.machine._more.setText("--spacing 4 --area-budget 0")
    job = one.job()
    found["job"] = [list(job.faces), list(job.tools.specs), job.tools.holder, job.machine, job.setup, list(job.fixtures)]
    shot("panel.png")

    # Cancelled, and a program that is not there.
    before = sorted(each.Name for each in document.Objects)
    # Machine code stays, where the folder of the sources cannot hold it.
    temporary = {*glob.glob(os.path.join(tempfile.gettempdir(), "plan-cutters-*")),
                 os.path.join(tempfile.gettempdir(), f"plan-cutters-{os.getuid()}")}
    left = lambda: len(set(glob.glob(os.path.join(tempfile.gettempdir(), "plan-cutters-*"))) - temporary)
    one.clicked(panel._PLAN)
    pump(lambda: not one.bar.isHidden() and one.status.text() == "Starting", 20)
    found["running"] = [one._buttons.button(panel._PLAN).text(), one.part.form.isEnabled(), left()]
    one.clicked(panel._PLAN)
    found["cancelled"] = [one.status.text(), sorted(each.Name for each in document.Objects) == before, left(), one.bar.isHidden()]
    command, os.environ["PLAN_CUTTERS"] = os.environ["PLAN_CUTTERS"], ""
    path, os.environ["PATH"] = os.environ["PATH"], ""
    one.start()
    pump(lambda: one._run is None, 10)
    found["missing"] = [one.status.text(), left()]
    os.environ["PLAN_CUTTERS"], os.environ["PATH"] = command, path

    # Planned.
    one.start()
    pump(lambda: findings.LAST is not None or one._run is None, 120)
    pump()
    two = findings.LAST
    found["result"] = [two._chip.text(), two._headline.text(), two._sentence.text()]
    found["text"], found["cutter"] = two.result.plan["text"], two.group.Cutter
    found["only ours"] = [left(), objects.stale(two.group)]
    found["legend"] = [label.text() for label in two.form[1].findChildren(QtGui.QLabel) if label.text()]
    found["spots"] = [two._list.topLevelItem(place).text(0) for place in range(two._list.topLevelItemCount())]
    shot("result.png")
    view = Gui.ActiveDocument.ActiveView
    view.setCameraType("Orthographic")
    two._list.setCurrentItem(two._list.topLevelItem(0))
    spot = two._spots[0]
    camera = view.getCamera()
    found["spot"] = dict(text=two._told.text(), point=spot.point, axis=spot.axis, camera=camera,
                         tool=[each.Label for each in two.group.Group if each.Name == "Plan_tool"], says=spot.text)
    shot("spot.png")
    two._tool.setChecked(False)
    found["hidden"] = [each.Label for each in two.group.Group if each.Name == "Plan_tool"]
    verdict = next(each for each in two.group.Group if getattr(each, "Verdict", ""))
    Gui.Selection.addSelection("Work", verdict.Name, "Face1", 2, 2, 20)
    found["click"] = two._told.text()
    other = next(each for each in two.result.cutters() if each != two.group.Cutter)
    windows.choose(two._cutters, other)
    found["other"] = [two.group.Cutter == other, len(objects.plans(document))]
    document.undo()
    pump()
    found["undone"] = [each.Cutter != other for each in objects.plans(document)] + [two._cutters.currentText()]
    document.redo()
    pump()
    found["redone"] = windows.chosen(two._cutters) == other
    block.Shape = Part.makeBox(40, 40, 20)
    document.recompute()
    pump()
    found["stale"] = two._stale.text()
    two._remove()
    pump()
    found["removed"] = [len(objects.plans(document)), block.ViewObject.Visibility, bool(Gui.Control.activeDialog())]
    kept = remembered.load()
    found["remembered"] = [list(kept.typed), kept.holder, kept.machine, kept.setup, kept.more, kept.show_tool]

QtCore.QTimer.singleShot(1000, work)
"""
)


@pytest.fixture(scope="module")
def window(tmp_path_factory):
    """What a session in FreeCAD's window found, and the folder with its pictures."""
    if not WINDOW:
        pytest.skip("FreeCAD or a virtual display is not installed (freecad, xvfb-run)")
    folder = tmp_path_factory.mktemp("window")
    user = folder / "user"
    addon = user / ".local" / "share" / "FreeCAD" / "Mod" / "PlanCutters"
    shutil.copytree(ROOT / "freecad", addon, ignore=shutil.ignore_patterns("__pycache__"))
    # Others on this machine may plan at the same time.
    (folder / "tmp").mkdir()
    display = ["xvfb-run", "-a", "-s", "-screen 0 1366x768x24"]
    found = run([*display, "freecad"], SESSION, folder, HOME=str(user), TMPDIR=str(folder / "tmp"),
                QTWEBENGINE_DISABLE_SANDBOX="1", LIBGL_ALWAYS_SOFTWARE="1")  # fmt: skip
    assert "remembered" in found, (folder / "found.json").read_text()
    return found, folder


def test_the_addon_is_installed_by_copying(window):
    found, _ = window
    assert found["benches"] == ["PlanCutters"]
    assert len(found["commands"]) == 6
    assert found["where"].endswith("Mod/PlanCutters/plan_cutters/panel.py")


def test_rows_take_what_is_picked(window):
    found, folder = window
    assert found["nothing"][0].startswith("Select the body")
    assert not found["nothing"][1]
    assert found["taken"] == ["Block", found["faces"], "picked"]
    assert len(found["three"]) == 3
    assert found["no axis"].startswith("No spindle direction is picked")
    assert found["handed over"] == [False, True, found["faces"]]
    assert np.allclose([float(word) for word in found["axis"].split(",")], [0, 0, 1])
    assert "picked as a fixture" in found["own fixture"]
    assert found["quote"].startswith("“More” cannot be read")
    faces, specs, holder, machine, _, fixtures = found["job"]
    assert (faces, specs, holder, machine) == (found["faces"], ["R4L15", "R2L12"], "R8L30", "trunnion-ac")
    assert fixtures == ["Clamp"]
    assert (folder / "panel.png").stat().st_size > 10_000


def test_a_cancelled_plan_leaves_nothing(window):
    found, _ = window
    assert found["running"] == ["Cancel", False, 1]
    words, same, left, hidden = found["cancelled"]
    assert "ancelled" in words
    assert (same, left, hidden) == (True, 0, True)


def test_a_missing_program_says_how_to_install_it(window):
    words, left = window[0]["missing"]
    assert "install" in words
    assert left == 0


def test_the_result_is_shown(window):
    found, _ = window
    (chip, headline, sentence), text = found["result"], found["text"]
    assert chip == "✘ Not feasible"  # the corners of the slot are sharp
    assert headline == text["headline"]
    assert sentence == text["cutters"][found["cutter"]]
    assert found["only ours"] == [0, ""]
    assert any(words.startswith("inaccessible: ") and not words.endswith(": 0 %") for words in found["legend"])


def test_the_view_flies_to_a_spot(window):
    found, _ = window
    spot = found["spot"]
    values = {line.split()[0]: [float(word) for word in line.split()[1:]] for line in spot["camera"].splitlines()
              if line.split()[:1] in (["position"], ["orientation"], ["height"])}  # fmt: skip
    x, y, z, angle = values["orientation"]
    turn, back = np.array([x, y, z]), np.array([0.0, 0.0, 1.0])
    # Rodrigues: where the camera's +Z, from what it shows to the eye, points.
    eye = back * math.cos(angle) + np.cross(turn, back) * math.sin(angle) + turn * turn[2] * (1 - math.cos(angle))
    off = np.array(spot["point"]) - values["position"]
    across = np.linalg.norm(off - eye * (off @ eye))
    assert off @ eye < 0  # before the eye
    assert across < values["height"][0] / 2  # inside the picture
    assert eye[2] > 0.5  # from above: the slot's floor cannot be seen from below
    assert spot["text"] == spot["says"]
    assert len(spot["tool"]) == 1
    assert found["hidden"] == []
    assert found["click"].startswith("F")


def test_another_cutter_undo_and_a_changed_body(window):
    found, _ = window
    assert found["other"] == [True, 1]
    assert found["undone"][0] is True
    assert "R2L12" in found["undone"][1]
    assert found["redone"]
    assert found["stale"].startswith("Block was changed")
    assert found["removed"] == [0, True, False]


def test_choices_are_remembered(window):
    typed, holder, machine, setup, more, show_tool = window[0]["remembered"]
    assert (typed, holder, machine) == (["R4L15", "R2L12"], "R8L30", "trunnion-ac")
    assert setup == "+z"  # a picked axis belongs to its document
    assert more == "--spacing 4 --area-budget 0"
    assert show_tool is False
