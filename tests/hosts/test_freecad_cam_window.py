"""Panels in FreeCAD's window beside CAM: bits are ticked, what they lack is marked, a job fills them, others close them."""

import shutil

import pytest

from tests.support.freecad_host import IN_WINDOW, run
from tests.support.places import ROOT

pytestmark = pytest.mark.slow("needs FreeCAD", together="FreeCAD")

WINDOW = shutil.which("freecad") and shutil.which("xvfb-run")

SESSION = (
    IN_WINDOW
    + """
import json, os, sys, time, traceback
import FreeCAD as App, Part
import FreeCADGui as Gui
V = App.Vector

def arrow_width(field):
    option, style = QtGui.QStyleOptionSpinBox(), QtGui.QStyle
    field.initStyleOption(option)
    return field.style().subControlRect(style.CC_SpinBox, option, style.SC_SpinBoxUp, field).width()

def picture(buttons, name):
    from freecad.plan_cutters import panel
    icon = buttons.style().standardIcon(getattr(QtGui.QStyle, name))
    image = lambda each: each.pixmap(16, 16).toImage()
    return image(buttons.button(panel._PLAN).icon()) == image(icon)

def session():
    from freecad.plan_cutters import findings, model, objects, panel, runner, windows
    try:
        import Path.Main.Job as jobs, Path.Tool.Bit as bits, Path.Tool.Controller as controllers
    except ImportError:  # before 0.21
        import PathScripts.PathJob as jobs, PathScripts.PathToolBit as bits, PathScripts.PathToolController as controllers
    Gui.activateWorkbench("PlanCutters")
    document = App.newDocument("Work")
    block = document.addObject("Part::Feature", "Block")
    block.Shape = Part.makeBox(40, 40, 20).cut(Part.makeBox(20, 40, 10, V(10, 0, 10)))
    document.recompute()
    Gui.getMainWindow().resize(1366, 768)
    Gui.Selection.clearSelection()
    Gui.Selection.addSelection("Work", "Block")
    # Without bits in the document the built-in set is judged.
    one = panel.open_panel()
    found["built in"] = [list(one.job().tools.bits), one.tools.missing(), one.tools.summary()]
    one.reject()
    Gui.Control.closeDialog()
    job = jobs.Create("Job", [block])
    bit = bits.Factory.Create("Mill", "endmill.fcstd")
    bit.Label, bit.Diameter, bit.CuttingEdgeHeight, bit.ShankDiameter = "Mill10", "10 mm", "22 mm", "10 mm"
    bits.Factory.Create("Drill", "drill.fcstd").Label = "Drill5"
    held = controllers.Create("TC_Mill10", tool=bit, toolNumber=7)
    held.HorizFeed = "900 mm/min"
    job.Proxy.addToolController(held)
    document.recompute()
    Gui.Selection.clearSelection()
    Gui.Selection.addSelection("Work", "Block")
    two = panel.open_panel()
    labels = lambda names: [document.getObject(name).Label for name in names]
    found["ticked"] = labels(two.tools.tools().bits)
    plan = two._buttons.button(panel._PLAN)
    marked = lambda: [bool(each.property("missing")) for each in (two.tools._stick_out, two.tools._holder)]
    found["asked"] = [two.status.text(), plan.isEnabled(), marked()]
    # FreeCAD's panel leaves 244 of a small screen, and takes 26 for itself.
    pump()
    found["wide"] = max(each.minimumSizeHint().width() for each in two.form)
    arrows = lambda: arrow_width(two.tools._stick_out)
    found["arrows"] = [arrows()]
    shot("asked.png")
    two.start()
    found["not started"] = [two._run is None, "--" in two.status.text()]
    windows.choose(two.tools._holder, "none")
    found["half"] = [two.status.text(), plan.isEnabled(), marked()]
    two.tools._stick_out.setValue(20)
    found["short"] = [two.status.text(), plan.isEnabled(), marked()]
    two.tools._stick_out.setValue(40)
    found["whole"] = [two.status.text(), plan.isEnabled(), marked()]
    pump()
    found["arrows"].append(arrows())
    # Lengths in the user's units.
    field, rows = two.tools._stick_out, []
    line = field.findChild(QtGui.QLineEdit)
    for schema in (3, 0):
        App.Units.setSchema(schema)
        for text in ("2", "50 mm", "0.5 in", "wide"):
            line.setText(text)
            field.interpretText()
            rows.append([field.value(), field.text()])
        field.setValue(12.3456)
        field.interpretText()
        rows.append([field.value(), field.text()])
    field.setValue(0)
    found["lengths"] = [*rows, [field.value(), field.text()]]
    two.tools._typed.setText("R4L15")
    two.tools._add_typed()
    found["both"] = [two.status.text(), plan.isEnabled()]
    two.reject()
    Gui.Control.closeDialog()
    # A job.
    Gui.Selection.clearSelection()
    Gui.Selection.addSelection("Work", "Job")
    two = panel.open_panel()
    asked = two.part.body, labels(two.tools._entries("bit")), two.tools.tools().cam_job
    found["job"] = [*asked, two.machine._stock_line.isHidden(), two.machine._stock_words.text(), two.machine.allowance()]
    found["rows"] = [two.tools._list.item(k).text() for k in range(two.tools._list.count())]
    two.machine._as_allowance.click()
    found["allowance"] = two.machine.allowance()
    shot("job.png")
    # Another command closes the panel, while nothing runs, and while it plans.
    windows.choose(two.tools._holder, "none")
    two.tools._stick_out.setValue(40)
    two.start()
    run = two._run
    found["runs"] = run.state
    found["sign"] = [two._buttons.button(panel._PLAN).text(), picture(two._buttons, "SP_DialogCancelButton")]
    Gui.Control.closeDialog()
    pump()
    Gui.Selection.clearSelection()
    Gui.Selection.addSelection("Work", "Block", "Face1")
    pump(lambda: run.state != "running", 60)
    pump()
    found["closed while it planned"] = [run.state, two._run is None, os.path.exists(run.folder), len(objects.plans(document))]
    # The panel of a result.
    got = []
    run = runner.Run(model.Job("Work", "Clone", tools=model.Tools(specs=("D12L60F26",)),
                     options=("--faces", "all", "--grid", "4", "--area-budget", "0")), lambda *_: None, got.append, got.append)
    pump(lambda: bool(got), 90)
    faults = []
    hook, sys.excepthook = sys.excepthook, lambda kind, fault, where: faults.append(repr(fault))
    block.ViewObject.Visibility = True
    three = findings.open_panel(objects.show(document, got[0]))
    pump()
    # What the model is a copy of would cover the colours.
    found["covered"] = [block.ViewObject.Visibility]
    found["label"] = three.group.Label
    found["steps"] = [[each.area, each.alone] for each in three.steps.steps], three.steps.told.text()
    Gui.Control.closeDialog()
    pump()
    before = findings.LAST is three
    for number in range(3):
        block.Placement = App.Placement(V(0, 0, number), App.Rotation())
        document.recompute()
        pump()
    verdict = next((each for each in document.Objects if getattr(each, "Verdict", "")), block)
    three.addSelection("Work", verdict.Name, "Face1", (2, 2, 20))
    three._map_failed("x")
    found["closed"] = [before, findings.LAST is None, faults, three._gone()]
    sys.excepthook = hook
    objects.clear(document)
    found["covered"].append(block.ViewObject.Visibility)

QtCore.QTimer.singleShot(1000, work)
"""
)


@pytest.fixture(scope="module")
def window(tmp_path_factory):
    """What a session in FreeCAD's window tells."""
    if not WINDOW:
        pytest.skip("FreeCAD or a virtual display is not installed (freecad, xvfb-run)")
    folder = tmp_path_factory.mktemp("window")
    addon = folder / "user" / ".local" / "share" / "FreeCAD" / "Mod" / "PlanCutters"
    shutil.copytree(ROOT / "freecad", addon, ignore=shutil.ignore_patterns("__pycache__"))
    (folder / "tmp").mkdir()
    display = ["xvfb-run", "-a", "-s", "-screen 0 1366x768x24"]
    found = run([*display, "freecad"], SESSION, folder, HOME=str(folder / "user"), TMPDIR=str(folder / "tmp"),
                QTWEBENGINE_DISABLE_SANDBOX="1", LIBGL_ALWAYS_SOFTWARE="1")  # fmt: skip
    assert "closed" in found, (folder / "found.json").read_text()
    return found


def test_bits_of_the_document_are_what_is_judged(window):
    assert window["built in"] == [[], "", "the default tool set"]
    # A drill is offered, and not ticked.
    assert window["ticked"] == ["Mill10"]


def test_what_the_bits_lack_is_marked_before_anything_starts(window):
    both = "Fill in “Stick-out” and “Holder”, which Mill10 do not state."
    assert window["asked"] == [both, False, [True, True]]
    assert window["not started"] == [True, False]
    assert window["half"] == ["Fill in “Stick-out”, which Mill10 do not state.", False, [True, False]]
    words, ready, marked = window["short"]
    assert words.startswith("“Stick-out” is shorter than the flutes of Mill10, 22")
    assert (ready, marked) == (False, [True, False])
    # Arrows of a marked field would be blank lines.
    assert window["arrows"][0] == 0 < window["arrows"][1]
    assert window["whole"][1:] == [True, [False, False]]
    assert window["both"] == ["Short words are judged without tool bits and libraries: untick one or the other.", False]


def test_the_panel_is_no_wider_than_a_small_screen_leaves_it(window):
    assert window["wide"] <= 244 - 26


def test_the_button_that_cancels_has_no_tick(window):
    assert window["sign"] == ["Cancel", True]


def test_a_length_is_typed_and_shown_in_the_users_units(window):
    """What is no length leaves the value, and so does the rounding of what is shown."""
    inches, metric = [50.8, 50.0, 12.7, 12.7, 12.3456], [2.0, 50.0, 12.7, 12.7, 12.3456]
    values, texts = zip(*window["lengths"], strict=True)
    assert values == pytest.approx([*inches, *metric, 0.0])
    assert [*texts[:5]] == ["2.00 in", "1.97 in", "0.50 in", "0.50 in", "0.49 in"]
    assert [*texts[5:]] == ["2.00 mm", "50.00 mm", "12.70 mm", "12.70 mm", "12.35 mm", "as the tools say"]


def test_a_job_fills_the_panel(window):
    body, bits, job, hidden, words, allowance = window["job"]
    # Not the tool that FreeCAD put there, which nobody used.
    assert (body, bits, job) == ("Clone", ["Mill10"], "Job")
    assert window["rows"][:2] == ["Endmill (tool bit)", "T7 Mill10, 900 mm/min (Job)"]
    # The stock is offered, and counts only when the user says so.
    assert (hidden, allowance, window["allowance"]) == (False, 0.0, 1.0)
    assert words.startswith("Stock of Job: 1")


def test_the_body_that_the_model_of_a_job_copies_does_not_cover_the_colours(window):
    assert window["covered"] == [False, True]
    assert window["label"].startswith("Model-Block: ")


def test_a_step_that_nobody_edited_is_not_called_changed(window):
    (step,), told = window["steps"]
    assert step[0] > 0.0
    assert step[1] is None
    assert told == ""


def test_a_panel_that_another_command_closes_follows_nothing(window):
    last, left, faults, gone = window["closed"]
    assert last
    assert left
    assert faults == []
    assert gone
    assert window["runs"] == "running"
    assert window["closed while it planned"] == ["cancelled", True, False, 0]
