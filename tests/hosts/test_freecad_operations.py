"""The FreeCAD macro that opens a plan of operations: planes, faces and the job, saved and opened again; and its errors."""

import json
import math
import shutil

import numpy as np
import pytest

from plan_cutters import plan
from plan_cutters.plan_file.words.operations import stepped
from tests.support.freecad_host import CONSOLE, HEAD, run
from tests.support.places import SAMPLES

pytestmark = pytest.mark.slow("needs FreeCAD", together="FreeCAD")

INSIDE = (
    HEAD
    + """
def empty():
    document = App.newDocument("Empty")
    document.UndoMode = 1
    return document

def area(shape):
    points, corners = shape.tessellate(0.01)
    return sum((points[b] - points[a]).cross(points[c] - points[a]).Length / 2 for a, b, c in corners)

def told(document, points):
    groups = {}
    for group in document.Objects:
        if not hasattr(group, "Mode"):
            continue
        (plane,) = [each for each in group.Group if each.Name.endswith("_plane")]
        faces = [each for each in group.Group if each is not plane]
        groups[group.Name] = dict(
            label=group.Label, cutter=group.Cutter, angles=list(group.Angles), colour=list(group.Colour[:3]),
            plane=plane.TypeId, matrix=list(plane.Placement.Matrix.A),
            faces={each.Label: dict(
                area=area(each.Shape), border=sum(edge.Length for edge in each.Shape.Edges),
                far=[each.Shape.distToShape(Part.Vertex(*point))[0] for point in points[group.Name].get(each.Label, [])],
            ) for each in faces},
        )
    job = document.getObject("Job")
    return dict(
        groups=groups, rest=[each.Label for each in document.Rest.Group], whole=len(document.Part.Shape.Faces),
        feeds=[each.HorizFeed.Value * 60 for each in job.Tools.Group],
        tools=[[each.Label, each.ToolNumber, each.Tool.Diameter.Value, each.Tool.Length.Value,
                [face.BoundBox.XMax for face in each.Tool.Shape.Faces if abs(face.BoundBox.ZMax) < 1e-6]]
               for each in job.Tools.Group],
        operations=[[each.Label, each.Active, each.ToolController.Label, each.Workplane.Name,
                     [area(each.Base[0][0].Shape.getElement(name)) for name in each.Base[0][1]]]
                    for each in job.Operations.Group],
        broken=[each.Name for each in document.Objects if "Invalid" in each.State],
    )

points = json.load(open(os.path.join(FOLDER, "points.json")))

# As it is here: an operation of this FreeCAD knows no work plane.
first = macro["run"](FOLDER, document=empty())
found["said"], said[:] = list(said), []
found["undo"] = first.UndoCount
found["shown"] = told(first, points["fewest"])
first.saveAs(os.path.join(os.getcwd(), "first.FCStd"))
first.undo()
found["undone"] = [each.Name for each in first.Objects]
App.closeDocument(first.Name)
again = App.openDocument(os.path.join(os.getcwd(), "first.FCStd"))
found["again"] = told(again, points["fewest"])
App.closeDocument(again.Name)

# As it is in a newer one: operations know a plane, in each of the three ways.
original = macro["cam"]

class Pockets:
    @staticmethod
    def Create(name, parentJob):
        made = original("pocket").Create(name, parentJob=parentJob)
        made.addProperty("App::PropertyLink", "Workplane")
        return made

macro["cam"] = lambda word: Pockets if word == "pocket" else original(word)
newer = macro["run"](os.path.join(FOLDER, "operations_fastest.step"), document=empty())
found["newer"] = told(newer, points["fastest"])
macro["cam"] = original
plane = newer.getObject("op2_plane")
ways = []
for kind in ("App::PropertyVector", "App::PropertyPlacement", "App::PropertyLink", "App::PropertyString", None):
    thing = newer.addObject("App::FeaturePython", "Way")
    if kind:
        thing.addProperty(kind, "Workplane")
    holder = newer.addObject("App::FeaturePython", "Holder")
    holder.addProperty("App::PropertyLink", "Workplanes")
    holder.Workplanes = newer.addObject("App::DocumentObjectGroup", "Planes")
    taken = macro["set_work_plane"](thing, plane, holder)
    value = getattr(thing, "Workplane", None)
    axis = value if isinstance(value, App.Vector) else getattr(getattr(value, "Placement", value), "Rotation", None)
    axis = axis.multVec(App.Vector(0, 0, 1)) if isinstance(axis, App.Rotation) else axis
    ways.append([taken, list(axis) if axis else None, [each.Name for each in holder.Workplanes.Group]])
found["ways"] = ways
App.closeDocument(newer.Name)

# Without a CAM workbench all but the job is there.
kept, macro["CAM"]["job"] = macro["CAM"]["job"], ("missing",)
said[:] = []
bare = macro["run"](FOLDER)
found["bare"] = [bare.getObject("Job") is None, bare.getObject("op1_plane") is not None, list(said)]
App.closeDocument(bare.Name)
macro["CAM"]["job"] = kept

# What goes wrong is one line, and nothing is left.
def line_of(*given, **more):
    before = sorted(App.listDocuments())
    try:
        macro["run"](*given, **more)
    except macro["NotOpened"] as error:
        return [str(error), sorted(App.listDocuments()) == before]

def changed(name, **more):
    folder = os.path.join(os.getcwd(), name)
    shutil.copytree(FOLDER, folder)
    path = os.path.join(folder, "plan.json")
    entry = json.load(open(path))
    entry.update(more)
    json.dump(entry, open(path, "w"))
    return folder

def reframed(name, **more):
    plans = json.load(open(os.path.join(FOLDER, "plan.json")))["operations"]
    plans["plans"][0]["operations"][-1].update(more)
    return changed(name, operations=plans)

full = App.newDocument("Full")
full.addObject("App::DocumentObjectGroup", "Mine")
other = changed("other")
with open(os.path.join(other, "operations.step"), "a") as file:
    file.write(" ")
gone = changed("gone")
os.remove(os.path.join(gone, "operations.step"))
torn = changed("torn")
open(os.path.join(torn, "plan.json"), "w").write("{")
found["errors"] = dict(
    nowhere=line_of(os.getcwd()), without=line_of(changed("without", operations=None)), other=line_of(other),
    gone=line_of(gone), torn=line_of(torn), unknown=line_of(FOLDER, "best"),
    full=line_of(FOLDER, document=full), alien=line_of(os.path.join(FOLDER, "annotated.step")),
    inside_out=line_of(reframed("inside_out", frame=dict(origin=[0, 0, 0], x=[1, 0, 0], z=[0, 0, -1]), axis=[0, 0, 1])),
    nan=line_of(reframed("nan", frame=dict(origin=[float("nan"), 0, 0], x=[1, 0, 0], z=[0, 0, 1]), axis=[0, 0, 1])),
    old=line_of(reframed("old", frame={})), fewer=line_of(reframed("fewer", id="op9")),
    models=line_of(changed("models", files={})), json=line_of(os.path.join(FOLDER, "points.json")),
)
found["mine"] = [each.Name for each in full.Objects]

# An error in between leaves no document, or an empty one.
def raises(*_):
    raise RuntimeError("in between")

macro["body"] = raises
here, before = empty(), None
for document in (here, None):
    before = sorted(App.listDocuments())
    try:
        macro["run"](FOLDER, document=document)
    except RuntimeError:
        found.setdefault("between", []).append([sorted(App.listDocuments()) == before, [each.Name for each in here.Objects]])
"""
)


def worded(document, entry, name):
    """How pieces of an operation are called: `step3`, or by its id in a plan that is not the process."""
    return stepped(document, entry, name).replace(" ", "")


def on_faces(samples, operation, word):
    """Some samples of an operation, by the name of its face in the model."""
    faces = samples.face[operation.rows]
    return {f"F{face}_{word}": samples.point[operation.rows[faces == face]][::9].tolist() for face in np.unique(faces).tolist()}


@pytest.fixture(scope="module")
def written(tmp_path_factory):
    if CONSOLE is None:
        pytest.skip("FreeCAD is not installed (freecadcmd)")
    folder = tmp_path_factory.mktemp("operations")
    result = plan(
        SAMPLES / "pocket_top.step", cutters=["R6L80rc2"], faces="F1,F6", grid=11, machine="trunnion-ac",
        index_step=math.radians(15.0), operations="both", feed=2000.0, area_budget=0,
    )  # fmt: skip
    document = result.write(folder, ("json", "step"))
    names = {}
    for entry, found in zip(document.operations.plans, result.answers.operations.plans, strict=True):
        names[entry.name] = {
            each.name: on_faces(result.samples, each, worded(document, entry, each.name)) for each in found.operations
        }
    (folder / "points.json").write_text(json.dumps(names))
    return document, folder


@pytest.fixture(scope="module")
def inside(written, tmp_path_factory):
    return run([CONSOLE], INSIDE, tmp_path_factory.mktemp("freecad"), PLAN_FOLDER=str(written[1]))


def plans(written, inside):
    few, fast = written[0].operations.plans[:2]
    return [(few, inside["shown"]), (few, inside["again"]), (fast, inside["newer"])]


def angle(a, b):
    """Between two directions, deg, exact near 0."""
    return math.degrees(math.atan2(np.linalg.norm(np.cross(a, b)), np.dot(a, b)))


def test_planes_have_the_tool_axis_and_the_angles_of_the_plan(written, inside):
    """C turns about Z and carries A, which turns about X."""
    for entry, shown in plans(written, inside):
        assert set(shown["groups"]) == {each.id for each in entry.operations}
        for each in entry.operations:
            group = shown["groups"][each.id]
            frame = np.reshape(group["matrix"], (4, 4))
            c, a = (math.radians(each.angles_deg[word]) for word in "CA")
            axis = [math.sin(c) * math.sin(a), -math.cos(c) * math.sin(a), math.cos(a)]
            assert angle(frame[:3, 2], each.axis) < 1e-6
            assert angle(frame[:3, 2], axis) < 1e-6
            assert angle(frame[:3, 0], [math.cos(c), math.sin(c), 0.0]) < 1e-6
            assert np.linalg.det(frame[:3, :3]) == pytest.approx(1.0)
            assert frame[:3, 3] == pytest.approx(each.frame.origin)
            told = {words.split()[0]: float(words.split()[1]) for words in group["angles"]}
            assert told == pytest.approx(each.angles_deg, abs=1e-3)
            assert group["label"] == " ".join([stepped(written[0], entry, each.id), each.cutter, *group["angles"]])


def test_faces_are_those_of_their_operations(written, inside):
    """Samples of an operation on a face lie on the object of that name, but for half a cell; its area is theirs."""
    faces = {face.id: face for face in written[0].faces}
    for entry, shown in plans(written, inside):
        sums = dict.fromkeys((each for each in faces if faces[each].target), 0.0)
        for each in entry.operations:
            group, word = shown["groups"][each.id], worded(written[0], entry, each.id)
            assert set(group["faces"]) == {f"{face.face}_{word}" for face in each.faces}
            assert group["colour"] == pytest.approx([int(each.colour[i : i + 2], 16) / 255 for i in (1, 3, 5)])
            for face in each.faces:
                found, half = group["faces"][f"{face.face}_{word}"], faces[face.face].gap_mm / 2
                assert found["far"]
                assert max(found["far"]) < half
                assert np.mean(np.array(found["far"]) < 0.01) > 0.8
                assert abs(found["area"] - face.area_mm2) < half * found["border"]
                sums[face.face] += found["area"]
        assert sums == pytest.approx({face: faces[face].area_mm2 for face in sums}, rel=2e-3)
        assert shown["rest"] == ["check"]
        assert shown["broken"] == []


def test_the_job_has_the_cutters_and_no_path_along_z(written, inside):
    for shown in (inside["shown"], inside["again"]):
        assert shown["operations"] == []
        ((label, number, diameter, length, flat),) = shown["tools"]
        assert (label, number, diameter, length) == ("TC R6L80rc2", 1, 12.0, 80.0)
        assert shown["feeds"] == [pytest.approx(2000.0)]
        # The bottom is flat up to where the corner begins.
        assert flat == pytest.approx([4.0])
    assert [line for line in inside["said"] if "no work plane" in line] == inside["said"][:1]
    assert inside["bare"][:2] == [True, True]
    assert inside["bare"][2][0].startswith("there is no job")


def test_operations_have_their_planes_and_faces_where_they_know_planes(written, inside):
    fast = written[0].operations.plans[1]
    made = inside["newer"]["operations"]
    assert len(made) == len(fast.operations) > 2
    for each, (label, active, controller, plane, areas) in zip(fast.operations, made, strict=True):
        assert label == f"{stepped(written[0], fast, each.id)} {each.cutter}"
        assert (active, controller, plane) == (False, f"TC {each.cutter}", f"{each.id}_plane")
        assert sum(areas) == pytest.approx(sum(f["area"] for f in inside["newer"]["groups"][each.id]["faces"].values()))


def test_a_work_plane_may_be_an_axis_a_placement_or_a_link(written, inside):
    axis = written[0].operations.plans[1].operations[1].axis
    vector, placement, link, text, none = inside["ways"]
    assert all(way[0] and angle(way[1], axis) < 1e-6 for way in (vector, placement, link))
    assert [way[2] for way in (vector, placement, link)] == [[], [], ["op2_plane"]]
    assert [text[0], none[0]] == [False, False]


def test_it_is_one_step_to_undo(inside):
    assert inside["undo"] == 1
    assert inside["undone"] == []


def test_errors_are_one_line_and_leave_nothing(inside):
    words = {
        "nowhere": "there is no plan.json",
        "without": "has no operations: plan again",
        "other": "belongs to another plan",
        "gone": "is missing: plan.json names it",
        "torn": "cannot be read as JSON",
        "unknown": "there is no plan 'best': there are fewest, fastest",
        "full": "holds 1 objects",
        "alien": "is no model of operations",
        "inside_out": "no frame about its tool axis",
        "nan": "no frame about its tool axis",
        "old": "both have to be of one release",
        "fewer": "has faces that the plan does not know",
        "models": "has no model of its operations",
        "json": "is not a plan of plan-cutters",
    }
    assert set(words) == set(inside["errors"])
    for name, (line, clean) in inside["errors"].items():
        assert words[name] in line
        assert "\n" not in line
        assert clean
    assert inside["mine"] == ["Mine"]
    assert inside["between"] == [[True, []], [True, []]]


WITH_WINDOW = (
    HEAD
    + """
import traceback
from PySide import QtCore

def work():
    try:
        import ImportGui
        document = macro["run"](FOLDER)
        shown = {each.Label: list(each.ViewObject.ShapeColor[:3]) for each in document.Objects if each.Label[:1] == "F"}
        undo = document.UndoCount
        document.undo()
        other = App.newDocument("Other")
        path = os.path.join(FOLDER, "operations.step")
        ImportGui.insert(path, other.Name)
        names = macro["pieces"](path)[2]
        (thing,) = [each for each in other.Objects if each.TypeId == "Part::Feature"]
        found.update(
            shown=shown, undo=undo, left=[each.Name for each in document.Objects], names=names,
            colours=[list(each[:3]) for each in thing.ViewObject.DiffuseColor],
        )
        json.dump(found, open("found.json", "w"))
    except BaseException:
        traceback.print_exc()
    sys.stdout.flush()
    os._exit(0)

QtCore.QTimer.singleShot(1000, work)
"""
)


@pytest.mark.slow("needs the window of FreeCAD", together="FreeCAD")
def test_the_window_shows_the_colours_and_the_importer_agrees_on_the_names(written, tmp_path):
    """Names are told by the order of faces; FreeCAD's own importer tells colours by other means."""
    if not (shutil.which("freecad") and shutil.which("xvfb-run")):
        pytest.skip("FreeCAD or a virtual display is not installed (freecad, xvfb-run)")
    done = run(["xvfb-run", "-a", "-s", "-screen 0 1200x900x24", "freecad"], WITH_WINDOW, tmp_path,
               PLAN_FOLDER=str(written[1]), QTWEBENGINE_DISABLE_SANDBOX="1", LIBGL_ALWAYS_SOFTWARE="1")  # fmt: skip
    entry = written[0].operations.plans[0]
    colours = {each.id: [int(each.colour[i : i + 2], 16) / 255 for i in (1, 3, 5)] for each in entry.operations}
    assert all(done["shown"][name] == pytest.approx(colours[name.split("_")[1]], abs=0.003) for name in done["shown"])
    assert set(done["shown"]) == {f"{face.face}_{each.id}" for each in entry.operations for face in each.faces}
    for (_, word), colour in zip(done["names"], done["colours"], strict=True):
        assert (colour == pytest.approx(colours[word], abs=0.003)) if word in colours else word == "check"
    assert (done["undo"], done["left"]) == (1, [])
