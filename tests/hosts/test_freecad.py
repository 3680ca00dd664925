"""The FreeCAD macro, in FreeCAD's own Python: numbers, places, verdicts and errors; once with its window."""

import re
import shutil
import xml.etree.ElementTree as ET

import pytest

from plan_cutters.plan_file.palette import PALETTE
from tests.support.freecad_host import CONSOLE, run
from tests.support.places import ROOT

MACRO = ROOT / "freecad" / "PlanCutters.FCMacro"
WINDOW = shutil.which("freecad") and shutil.which("xvfb-run")

HEAD = f"""
import json, os, sys, traceback
import FreeCAD as App, Part
macro = {{"__name__": "macro"}}
exec(compile(open({str(MACRO)!r}, encoding="utf-8").read(), "PlanCutters.FCMacro", "exec"), macro)
document = App.newDocument("test")
found = {{}}

def blade(inside=None):
    thing = document.addObject("Part::Feature", "Blade")
    shape = Part.Shape()
    shape.read({str(ROOT / "samples" / "blade.step")!r})
    thing.Shape = shape
    thing.Placement = App.Placement(App.Vector(10, 0, 0), App.Rotation(App.Vector(0, 0, 1), 30))
    if inside:
        inside.addObject(thing)
    return thing

def line_of(work, *given):
    try:
        work(*given)
    except macro["NotPlanned"] as error:
        return str(error)
"""

INSIDE = """
holder = document.addObject("App::Part", "Cell")
holder.Placement = App.Placement(App.Vector(0, 0, 100), App.Rotation(App.Vector(1, 0, 0), 90))
thing = blade(holder)
document.recompute()
shape = macro["shape_of"](thing)
# What the macro itself asks for counts, whatever the user says.
group = macro["run"](thing, [1], "--cutter R4L50 --cutter R30L20 --grid 15 --area-budget 0 -o other --formats html --faces F2")
plan = json.load(open(os.path.join(group.Folder, "plan.json"), encoding="utf-8"))
box = shape.BoundBox

def area(face):
    # Of its triangles: this kernel integrates over curved borders too coarsely.
    points, corners = face.tessellate(0.02)
    return sum((points[b] - points[a]).cross(points[c] - points[a]).Length / 2 for a, b, c in corners)

found.update(
    faces=list(group.Faces), summary=list(group.Summary), label=group.Label, members=[each.Label for each in group.Group],
    areas=[[area(face), entry["area_mm2"]] for face, entry in zip(shape.Faces, plan["faces"])],
    targets=[entry["id"] for entry in plan["faces"] if entry["target"]], selected=plan["selected"],
    size=[box.XLength, box.YLength, box.ZLength], planned=plan["part"]["size_mm"], lowest=box.ZMin,
    shown=list(group.Group[0].Shape.BoundBox.Center), centre=list(box.Center), verdicts=macro["verdicts"](plan),
)

found["errors"] = [
    line_of(macro["run"], thing, [], "--cutter nonsense"),
    line_of(macro["run"], thing, [], '--cutter "R4L50'),
    line_of(macro["run"], thing, [99], ""),
    line_of(macro["run"], document.addObject("Part::Feature", "Empty"), [], ""),
    line_of(macro["run"], thing, [], "--help"),
]
os.environ["PLAN_CUTTERS"] = os.path.join(os.getcwd(), "missing")
found["errors"].append(line_of(macro["run"], thing, [], ""))
os.environ["PLAN_CUTTERS"] = 'plan-cutters "'
found["errors"].append(line_of(macro["run"], thing, [], ""))
os.environ["PLAN_CUTTERS"], os.environ["PATH"] = "", ""
found["errors"].append(line_of(macro["run"], thing, [], ""))
"""


def freecad(words, script, folder, **more):
    """Run a script behind HEAD in FreeCAD; what it found."""
    return run(words, HEAD + script, folder, **more)


@pytest.fixture(scope="module")
def inside(tmp_path_factory):
    if CONSOLE is None:
        pytest.skip("FreeCAD is not installed (freecadcmd)")
    return freecad([CONSOLE], INSIDE, tmp_path_factory.mktemp("freecad"))


def test_faces_keep_their_numbers(inside):
    assert len(inside["areas"]) == 3
    for theirs, ours in inside["areas"]:
        assert ours == pytest.approx(theirs, rel=5e-3)
    assert inside["targets"] == ["F1"]


def test_a_body_is_planned_where_it_stands(inside):
    """Turned by its own placement and by the container's: the size along each axis is that in the document."""
    assert inside["planned"] == pytest.approx(inside["size"], rel=0.02)
    assert inside["shown"] == pytest.approx(inside["centre"])
    assert inside["size"] != pytest.approx(sorted(inside["size"], reverse=True))


def test_verdicts_come_back(inside):
    assert inside["faces"] == [f"Face{n} {word}" for n, word in enumerate(inside["verdicts"], 1)]
    assert inside["verdicts"][0] in PALETTE
    assert inside["verdicts"][1:] == ["check", "check"]
    assert inside["label"] == f"{inside['selected']} verdicts"
    assert inside["members"] == ["Blade worst verdicts"]
    first, *rows = inside["summary"]
    assert first.startswith(f"take {inside['selected']}")
    assert [row.split(":")[0].split()[-1] for row in rows[:2]] == ["R30L20", "R4L50"]


def test_errors_are_one_line(inside):
    wrong, quote, face, empty, no_plan, missing, path, nowhere = inside["errors"]
    assert wrong.startswith("cutter 'nonsense' is not of the form")
    assert quote.startswith("the options cannot be read")
    assert "there is no face F99" in face
    assert "holds no faces" in empty
    assert "wrote no plan" in no_plan
    assert path.startswith("the command's path cannot be read")
    assert "cannot be started" in missing
    assert "was not found: install it" in nowhere
    assert all("\n" not in each for each in inside["errors"])


def test_the_addon_says_what_it_is():
    tree = ET.parse(ROOT / "package.xml")
    space = {"p": "https://wiki.freecad.org/Package_Metadata"}
    macros = tree.findall("p:content/p:macro", space)
    files = [ROOT / each.find("p:subdirectory", space).text / each.find("p:file", space).text for each in macros]
    assert sorted(files) == sorted(MACRO.parent.glob("*.FCMacro"))
    for icon in (*tree.findall("p:icon", space), *tree.findall("p:content/p:workbench/p:icon", space)):
        assert (ROOT / icon.text).read_text().startswith("<svg")
    readme = next(url.text for url in tree.findall("p:url", space) if url.get("type") == "readme")
    assert (ROOT / "freecad" / readme.rpartition("/freecad/")[2]).is_file()
    version = re.search(r'^version = "(.*)"', (ROOT / "pyproject.toml").read_text(), re.MULTILINE)[1]
    assert tree.find("p:version", space).text == version
    assert f'__version__ = "{version}"' in (MACRO.parent / "plan_cutters" / "__init__.py").read_text()
    assert all(f'__Version__ = "{version}"' in file.read_text() for file in files)


WITH_WINDOW = """
import FreeCADGui as Gui
from PySide import QtCore, QtGui

def work():
    try:
        thing = document.addObject("Part::Feature", "Block")
        shape = Part.makeBox(40, 40, 20).cut(Part.makeBox(6, 30, 10, App.Vector(17, 5, 10)))
        thing.Shape = shape
        document.recompute()
        floor = next(n for n, face in enumerate(shape.Faces, 1) if abs(face.Area - 180) < 1e-6)
        top = next(n for n, face in enumerate(shape.Faces, 1) if abs(face.Area - 1420) < 1e-6)
        for number in (floor, top):
            Gui.Selection.addSelection(document.Name, thing.Name, "Face%d" % number)
        picked, faces = macro["selected"]()
        window, told = macro["watching"]()
        group = macro["run"](picked, faces, "--cutter R4L15 --spacing 2 --area-budget 0 --holder R8L30", told)
        window.close()
        shown = group.Group[0]
        colours = sorted({tuple(round(255 * c) for c in colour[:3]) for colour in shown.ViewObject.DiffuseColor})
        Gui.Selection.clearSelection()
        view = Gui.ActiveDocument.ActiveView
        view.setCameraType("Orthographic")
        view.viewTop()
        Gui.SendMsgToActiveView("ViewFit")
        QtGui.QApplication.processEvents()
        view.saveImage("top.png", 600, 600, "White")
        found.update(faces=faces, colours=colours, hidden=not thing.ViewObject.Visibility)
        json.dump(found, open("found.json", "w"))
    except BaseException:
        traceback.print_exc()
    sys.stdout.flush()
    os._exit(0)

QtCore.QTimer.singleShot(1000, work)
"""


@pytest.mark.slow
def test_the_window_shows_the_verdicts(tmp_path):
    if not WINDOW:
        pytest.skip("FreeCAD or a virtual display is not installed (freecad, xvfb-run)")
    done = freecad(["xvfb-run", "-a", "-s", "-screen 0 1200x900x24", "freecad"], WITH_WINDOW, tmp_path,
                   QTWEBENGINE_DISABLE_SANDBOX="1", LIBGL_ALWAYS_SOFTWARE="1")  # fmt: skip
    assert len(done["faces"]) == 2
    assert done["hidden"]
    assert len(done["colours"]) == 3
    words = ("inaccessible", "interference_free", "check")
    assert done["colours"] == sorted(list(bytes.fromhex(PALETTE[word][1:])) for word in words)
    assert (tmp_path / "top.png").stat().st_size > 3000
