"""The workbench for FreeCAD, in FreeCAD's own Python: from picked faces to coloured objects, saved, undone, and out of date."""

import ast
import io
import json
import math
import shutil
import sys
import zipfile
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from plan_cutters import Cutter
from plan_cutters.domain.outline import outline, points
from plan_cutters.domain.shapes import flute_length, modes
from plan_cutters.domain.travel import tips
from plan_cutters.domain.verdicts import blank
from plan_cutters.library import read_library
from tests.support.freecad_host import CONSOLE, run
from tests.support.places import ROOT

pytestmark = pytest.mark.slow("needs FreeCAD", together="FreeCAD")

#: What both sessions begin with; a block with a slot stands turned in a container, beside a fixture.
HEAD = """
import json, os, sys, time, types
import FreeCAD as App, Part
from freecad.plan_cutters import files, host, model, objects, operations, results, runner, tool
found = {"loaded": sorted(name for name in ("plan_cutters", "cad_io", "numba", "OCP") if name in sys.modules)}
V = App.Vector

def block(document):
    cell = document.addObject("App::Part", "Cell")
    cell.Placement = App.Placement(V(5, 0, 30), App.Rotation(V(0, 0, 1), 30))
    thing = document.addObject("Part::Feature", "Block")
    thing.Label = "Block (best)"
    thing.Shape = Part.makeBox(40, 40, 20).cut(Part.makeBox(6, 30, 10, V(17, 5, 10)))
    thing.Placement = App.Placement(V(-20, -20, 0), App.Rotation())
    cell.addObject(thing)
    vise = document.addObject("Part::Feature", "Vise")
    vise.Shape = Part.makeBox(10, 10, 30, V(60, 0, 20))
    document.recompute()
    return thing, vise

def number_of(thing, area):
    return next(n for n, face in enumerate(thing.Shape.Faces, 1) if abs(face.Area - area) < 1e-6)

def entry(thing, *names):
    return types.SimpleNamespace(Object=thing, SubElementNames=names)

def line_of(work, *given):
    try:
        work(*given)
    except model.Refused as error:
        return str(error)

def ended(job, then=None):
    told = []
    run = runner.Run(job, lambda *news: None, lambda result: told.append(result), lambda line: told.append(line))
    if then is not None:
        then(run)
    state = run.wait(120)
    assert len(told) == 1, told
    return state, told[0], run

def left():
    # Machine code stays, where the folder of the sources cannot hold it.
    kept = f"plan-cutters-{os.getuid()}"
    return sorted(name for name in os.listdir(os.environ["TMPDIR"]) if name.startswith("plan-cutters-") and name != kept)
"""

PLANNED = (
    HEAD
    + """
document = App.newDocument("work")
document.UndoMode = 1
thing, vise = block(document)
floor, top = number_of(thing, 180), number_of(thing, 1420)
import PathScripts.PathToolBit as bits
bit = bits.Factory.Create("Mill", "endmill.fcstd")
bit.Label, bit.Diameter, bit.CuttingEdgeHeight, bit.Length, bit.ShankDiameter = "Mill 4", "4 mm", "15 mm", "40 mm", "4 mm"
document.recompute()
names = model.picked([entry(thing, "Face%d" % floor, "Face%d" % top)])
job = model.Job(
    *names, tools=model.Tools(bits=tuple(name for name, _ in model.bits(document)), holder="R8L30", stick_out=16.0),
    machine="trunnion-ac", setup=model.axis(thing, "Face%d" % top), fixtures=("Vise",), allowance=0.25,
    options=("--spacing", "4", "--area-budget", "0", "--rotation-step", "30", "--operations", "fewest"),
)
state, result, _ = ended(job)
assert state == "done", result
found["plan"], found["job"], found["floor"], found["top"] = result.plan, list(names), floor, top
found["same_job"] = model.job_of(json.loads(json.dumps(dict(job.__dict__, tools=job.tools.__dict__)))) == job
found["held"] = left()
before = [each.Name for each in document.Objects]
steps = document.UndoCount
group = objects.show(document, result)
found["steps"], found["left"] = document.UndoCount - steps, left()

def told(group):
    body = model.shape_of(objects.body_of(group))
    verdicts = []
    for each in group.Group:
        if getattr(each, "PlanRole", "") != "verdict":
            continue
        for face, name in zip(each.Shape.Faces, each.Faces):
            far = max(body.Faces[int(name[1:]) - 1].distToShape(corner)[0] for corner in face.Vertexes)
            verdicts.append([each.Verdict, name, face.Area, far, list(each.Colour[:3])])
    frames = [each for each in group.OutListRecursive if "_plane" in each.Name]
    axes = [[list(each.Placement.Rotation.multVec(V(0, 0, 1))), each.Label] for each in frames]
    shown = objects.result_of(group)
    return dict(verdicts=verdicts, axes=axes, label=group.Label, headline=group.Headline, summary=list(group.Summary),
                stale=objects.stale(group), review=open(shown.review(), encoding="utf-8").read(15),
                missing=list(group.NotShown))

found["areas"] = [face.Area for face in thing.Shape.Faces]
found["shown"] = told(group)

# The tool, against the body itself by the kernel's boolean operations.
body = model.shape_of(thing)
spots = [spot for spot in objects.result_of(group).spots() if spot.tip]
tools = []
for spot in (spots[0], objects.nearest(group, body.Faces[top - 1].Vertexes[0].Point)):
    shape = objects.put_tool(group, spot).Shape
    contact = Part.Vertex(*spot.point)
    tools.append(dict(
        verdict=getattr(spot, "verdict", "lost"), far=shape.distToShape(contact)[0],
        contact=body.distToShape(contact)[0], common=shape.common(body).Volume, axis=list(spot.axis),
        angles=[dict(each) for each in getattr(spot, "angles", ())], parts=[solid.Volume for solid in shape.Solids],
        tools=sum(each.Name == "Plan_tool" for each in group.Group),
    ))
found["tools"], found["depths"] = tools, [spot.depth_mm for spot in spots]
objects.hide_tool(group)
found["hidden"] = [each.Name for each in group.Group if each.Name == "Plan_tool"]

# Saved, opened again, shown again for the same cutter, and a posture map there.
path = os.path.join(os.getcwd(), "work.FCStd")
document.saveAs(path)
App.closeDocument("work")
document = App.openDocument(path)
document.UndoMode = 1
(group,) = objects.plans(document)
found["again"] = told(group)
drawn = []
drawing = runner.Map(group, objects.result_of(group).spots()[0].point, "", lambda *news: None, drawn.append, drawn.append)
assert drawing.wait(120) == "done", drawn
with open(drawn[0]["picture"], "rb") as file:
    found["map"] = [file.read(4).hex(), *(drawn[0]["json"][word] for word in ("cutter", "tolerance_mm", "machine"))]
runner.removed(drawing.folder)
fresh = objects.show(document, objects.result_of(group))
found["fresh"], found["plans"] = told(fresh), len(objects.plans(document))
document.undo()
(group,) = objects.plans(document)
found["undone"] = told(group)

# Another place, another fixture: out of date, and again up to date by an undo.
def edited(words, change):
    document.openTransaction(words)
    change()
    document.recompute()
    document.commitTransaction()
    (group,) = objects.plans(document)
    now = [group.OutOfDate, len(group.Group), group.Label]
    document.undo()
    (group,) = objects.plans(document)
    return now, [group.OutOfDate, len(group.Group), objects.stale(group)]

def moved(name):
    def change():
        place = document.getObject(name).Placement
        document.getObject(name).Placement = App.Placement(place.Base + V(0, 0, 1), place.Rotation)
    return change

found["edits"] = [edited(name, moved(name)) for name in ("Block", "Cell", "Vise")]
found["nothing"] = edited("nothing", lambda: document.Block.touch())
steps = document.UndoCount
count = objects.clear(document)
found["cleared"] = [count, document.UndoCount - steps, sorted(each.Name for each in document.Objects) == sorted(before)]
found["left_at_last"] = left()
"""
)


def planned(script, folder, whole, **more):
    """Run a session of FreeCAD in which the add-on is installed, with a folder of its own for temporary files.

    `whole`: as the Addon Manager has it, with package.xml at the root; else the folder of the add-on alone was copied.
    """
    if CONSOLE is None:
        pytest.skip("FreeCAD is not installed (freecadcmd)")
    mod = folder / "user" / "Mod" / "Cutters"
    shutil.copytree(ROOT / "freecad", mod / "freecad" if whole else mod, ignore=shutil.ignore_patterns("__pycache__"))
    if whole:
        shutil.copy(ROOT / "package.xml", mod)
    (folder / "temp").mkdir()
    return run([CONSOLE], script, folder, TMPDIR=str(folder / "temp"), FREECAD_USER_DATA=str(folder / "user"), **more)


@pytest.fixture(scope="module")
def work(tmp_path_factory):
    return planned(PLANNED, tmp_path_factory.mktemp("freecad"), whole=True)


def test_what_was_picked_is_what_was_planned(work):
    asked, plan = work["plan"]["effective"], work["plan"]
    assert work["job"] == ["work", "Block", sorted([work["floor"], work["top"]])]
    assert work["same_job"]
    assert asked["target_faces"] == [f"F{n}" for n in sorted([work["floor"], work["top"]])]
    assert (asked["setup"], asked["machine"], asked["allowance_mm"]) == ([0.0, 0.0, 1.0], "trunnion-ac", 0.25)
    assert len(asked["fixtures"]) == 1
    (cutter,) = plan["cutters"]
    assert (cutter["radius"], cutter["length"], cutter["flutes_mm"], cutter["name"]) == (2.0, 16.0, 15.0, "Mill 4")
    assert plan["part"]["file"] == "Block_best.brep"
    assert work["loaded"] == []


def test_verdicts_lie_on_the_faces_that_they_name(work):
    """Corners of each piece lie on its face where the body stands in its container, and pieces add up to the whole body."""
    areas = dict.fromkeys((f"F{n}" for n in range(1, len(work["areas"]) + 1)), 0.0)
    for verdict, name, area, far, colour in work["shown"]["verdicts"]:
        assert far < 1e-6
        areas[name] += area
        assert (verdict == "check") == (int(name[1:]) not in work["job"][2])
        assert colour == pytest.approx([v / 255 for v in bytes.fromhex(work["plan"]["legend"][verdict][1:])], abs=0.003)
    assert list(areas.values()) == pytest.approx(work["areas"], rel=1e-3)
    seen = {(name, verdict) for verdict, name, *_ in work["shown"]["verdicts"] if verdict != "check"}
    unseen = {(name, word) for name, *words, _, _ in map(str.split, work["shown"]["missing"]) for word in ["_".join(words)]}
    (cutter,) = work["plan"]["cutters"]
    words = ("inaccessible", "undecided", "unjudged", "accessible", "interference_free")
    judged = {(face, word) for face, counts in cutter["faces"].items() for word in words if counts[word]}
    assert judged == seen | unseen
    assert not seen & unseen
    assert {"inaccessible", "accessible"} <= {word for _, word in judged}
    text = work["plan"]["text"]
    assert work["shown"]["headline"] == text["headline"]
    assert work["shown"]["summary"] == [text["headline"], *text["lines"]]


def test_the_tool_stands_where_the_plan_says(work):
    """It keeps the allowance from its contact; it cuts into the body where the plan says so, and not where that is reached."""
    lost, reached = work["tools"]
    assert work["depths"] == sorted(work["depths"], reverse=True)
    assert work["depths"][0] > 0.1
    for each in work["tools"]:
        assert each["contact"] < 1e-6
        assert each["far"] == pytest.approx(0.25, abs=1e-6)
        assert each["tools"] == 1
        flutes, shank, holder = each["parts"]
        assert flutes == pytest.approx(math.pi * 2**2 * 15, rel=1e-6)
        assert shank == pytest.approx(math.pi * 2**2 * 1, rel=1e-6)
        assert holder == pytest.approx(math.pi * 8**2 * 30, rel=1e-6)
    assert lost["common"] > 0.1
    assert reached["verdict"] in ("accessible", "interference_free")
    assert reached["common"] < 1e-6
    assert {frozenset(each) for each in reached["angles"]} == {frozenset("CA")}
    assert all(abs(math.cos(math.radians(each["A"])) - reached["axis"][2]) < 1e-6 for each in reached["angles"])
    assert work["hidden"] == []


def test_operations_are_coordinate_systems_along_the_tool_axis(work):
    entries = work["plan"]["operations"]["plans"][0]["operations"]
    called = {each["operation"]: f"step {k} plane" for k, each in enumerate(work["plan"]["process"]["steps"], 1)}
    assert len(entries) >= 1
    for entry, (axis, label) in zip(entries, work["shown"]["axes"], strict=True):
        assert np.allclose(axis, entry["axis"], atol=1e-9)
        assert label == called[entry["id"]]


def test_it_is_one_step_saved_with_the_document(work):
    assert work["steps"] == 1
    assert len(work["held"]) == 1
    assert work["left"] == work["left_at_last"] == []
    assert work["shown"]["review"].lower().startswith("<!doctype html")
    for key in ("again", "fresh", "undone"):
        for mine, ours in zip(work[key]["verdicts"], work["shown"]["verdicts"], strict=True):
            assert mine[:2] == ours[:2]
            assert mine[2] == pytest.approx(ours[2])
        assert work[key]["axes"] == work["shown"]["axes"]
        assert work[key]["stale"] == ""
        assert work[key]["review"] == work["shown"]["review"]
    assert work["plans"] == 1
    assert work["cleared"] == [1, 1, True]


def test_a_map_is_drawn_for_a_spot(work):
    picture, cutter, tolerance, machine = work["map"]
    assert bytes.fromhex(picture) == b"\x89PNG"
    assert (cutter, machine) == (work["plan"]["cutters"][0]["id"], "trunnion-ac")
    assert tolerance == work["plan"]["effective"]["tolerance_mm"]


def test_colours_are_dropped_when_a_body_changes(work):
    """An edit of the body, of what it stands in or of a fixture; the undo of the edit brings them back."""
    for name, (then, back) in zip(("Block (best)", "Block (best)", "Vise"), work["edits"], strict=True):
        assert then[0] == f"{name} was changed after the plan: plan again"
        assert then[1] == 0
        assert then[2].endswith("(out of date)")
        assert back[0] == back[2] == ""
        assert back[1] > 0
    (then, _) = work["nothing"]
    assert then[0] == ""


#: Programs that stand for ours: they answer in an instant, and wrongly.
BAD = (
    HEAD
    + """
document = App.newDocument("work")
document.UndoMode = 1
thing, vise = block(document)
job = model.Job("work", "Block")
TEMP = os.environ["TMPDIR"]

def program(text):
    path = os.path.join(os.getcwd(), "program.py")
    with open(path, "w") as file:
        file.write("import json, os, subprocess, sys, time\\nout = sys.argv[sys.argv.index('--out') + 1]\\n" + text)
    os.environ["PLAN_CUTTERS"] = os.environ["PLAIN_PYTHON"] + " " + path

def failed(text, then=None):
    program(text)
    state, line, run = ended(job, then)
    return [state, line, left(), os.path.exists(run.folder)]

write = "os.mkdir(out); file = open(out + '/plan.json', 'w'); "
found["programs"] = dict(
    wrong=failed(
        "sys.stderr.write('    1.0 s  starting\\\\nplan-cutters: the part\\\\n  holds nothing\\\\n    9.0 s  ending\\\\n')\\n"
        "sys.exit(3)"
    ),
    silent=failed("sys.exit(7)"), killed=failed("os.kill(os.getpid(), 9)"), none=failed("pass"),
    torn=failed(write + "file.write('{')"), other=failed(write + "json.dump([1], file)"),
    newer=failed(write + "json.dump(dict(format='plan-cutters-plan', format_version=2), file)"),
)

# A cancelled plan takes what it started with it.
def cancel(run):
    while not os.path.exists(os.path.join(run.folder, "pids")):
        run.poll()
        time.sleep(0.02)
    found["pids"] = json.load(open(os.path.join(run.folder, "pids")))
    run.cancel()
    run.cancel()

found["cancelled"] = failed(
    "child = subprocess.Popen([sys.executable, '-c', 'import time; time.sleep(100)'])\\n"
    "json.dump([os.getpid(), child.pid], open('half', 'w'))\\nos.rename('half', 'pids')\\ntime.sleep(100)", cancel,
)
found["objects"] = [each.Name for each in document.Objects]

# Progress, as the program writes it.
seen = []
program("sys.stderr.write('   12.5 s  judging R6L80 (2 of 5), 34 %\\\\n'); sys.stderr.flush(); time.sleep(0.5)")
runner.Run(job, lambda *news: seen.append(news), seen.append, lambda line: seen.append("ended")).wait(60)
found["progress"] = seen

# What is asked wrongly ends in a line, and nothing runs.
program("raise SystemExit('was run')")
def asked(**more):
    state, line, run = ended(model.Job(**dict(dict(document="work", body="Block"), **more)))
    return [state, line]
document.addObject("Part::Feature", "Empty")
mesh = document.addObject("Mesh::Feature", "Scan")
found["asked"] = dict(
    closed=asked(document="gone"), gone=asked(body="Gone"), empty=asked(body="Empty"), face=asked(faces=(99,)),
    itself=asked(fixtures=("Block",)), fixture=asked(fixtures=("Empty",)), allowance=asked(allowance=-1.0),
    nan=asked(allowance=float("nan")), bit=asked(tools=model.Tools(bits=("Vise",))),
)
os.environ["PLAN_CUTTERS"] = os.path.join(os.getcwd(), "missing")
found["asked"]["missing"] = asked()
path, home = os.environ["PATH"], os.environ["HOME"]
os.environ["PLAN_CUTTERS"], os.environ["PATH"], os.environ["HOME"] = "", "", os.getcwd()
found["asked"]["nowhere"] = asked()
os.environ["PATH"], os.environ["HOME"] = path, home
os.environ["PLAN_CUTTERS"] = 'plan-cutters "'
found["asked"]["quote"] = asked()

# Selections.
other = App.newDocument("other")
far, _ = block(other)
link = document.addObject("App::Link", "Twin")
link.LinkedObject = thing
link.Placement = App.Placement(V(0, 100, 0), App.Rotation())
cell_link = document.addObject("App::Link", "Cells")
cell_link.LinkedObject = document.Cell
body = document.addObject("PartDesign::Body", "Body")
first = body.newObject("PartDesign::AdditiveBox", "First")
last = body.newObject("PartDesign::AdditiveBox", "Last")
last.Length = 30
document.recompute()
pick = model.picked
found["picked"] = dict(
    nothing=line_of(pick, []), two=line_of(pick, [entry(thing), entry(vise)]),
    documents=line_of(pick, [entry(thing), entry(far)]),
    edge=line_of(pick, [entry(thing, "Edge1")]), mixed=line_of(pick, [entry(thing, "Face1", "Edge1")]),
    container=line_of(pick, [entry(document.Cell)]), cells=line_of(pick, [entry(cell_link)]), mesh=line_of(pick, [entry(mesh)]),
    empty=line_of(pick, [entry(document.Empty)]), step=line_of(pick, [entry(first, "Face1")]),
    through=line_of(pick, [entry(cell_link, "Block.Face1")]),
)
found["taken"] = [
    pick([entry(link, "Face3", "Face1")]), pick([entry(last, "Face2")]), pick([entry(body)]),
    pick([entry(document.Cell, "Block.Face2")]),
]
found["link"] = list(model.shape_of(link).BoundBox.Center)

# Axes.
top = number_of(thing, 1420)
document.Cell.Placement = App.Placement(V(), App.Rotation(V(1, 0, 0), 90))
cylinder = document.addObject("Part::Cylinder", "Pin")
frame = document.addObject("PartDesign::CoordinateSystem", "Frame")
frame.Placement = App.Placement(V(), App.Rotation(V(0, 1, 0), 90))
ball = document.addObject("Part::Sphere", "Ball")
document.recompute()
found["axes"] = [
    model.axis(thing, "Face%d" % top), model.axis(thing, "Face%d" % top, True), model.axis(cylinder, "Face1"), model.axis(frame),
    line_of(model.axis, ball, "Vertex1"),
]
found["fixed"] = [model.axis(thing, "Edge%d" % n) for n in range(1, len(thing.Shape.Edges) + 1)]

# A result that is late: its body changed, or its document is another one.
late = results.Result({}, model.Job("work", "Block"), {"Block": model.fingerprint(model.shape_of(thing))})
found["late"] = [line_of(objects.show, other, late)]
document.Cell.Placement = App.Placement()
document.recompute()
found["late"].append(line_of(objects.show, document, late))
document.removeObject("Block")
found["late"].append(line_of(objects.show, document, late))
found["none"] = [objects.clear(document), objects.plans(document), left()]

# Arrays from anybody.
from freecad.plan_cutters import arrays
found["arrays"] = {}
for name in sorted(os.listdir("arrays")):
    try:
        found["arrays"][name] = {word: each.tolist() for word, each in arrays.read(os.path.join("arrays", name)).items()}
    except (OSError, ValueError) as error:
        found["arrays"][name] = type(error).__name__

# Cutters of a plan: as shapes, at postures, and as libraries.
asked = types.SimpleNamespace(plan=dict(effective=dict(allowance_mm=0.5, holder_clearance_mm=0.25)))
found["cutters"] = []
for case in json.load(open(os.environ["CASES"])):
    cutter = case["cutter"]
    row = dict(tips=[tool.tip(cutter, *posture) for posture in case["postures"]])
    found["cutters"].append(row)
    try:
        shape, parts = tool.assembly(cutter)
    except ValueError as error:
        row["why"] = str(error)
        continue
    whole = shape.Solids[0].multiFuse(shape.Solids[1:]) if len(shape.Solids) > 1 else shape
    row.update(volume=whole.Volume, low=whole.BoundBox.ZMin, high=whole.BoundBox.ZMax, parts=parts)
    os.makedirs(cutter["id"])
    row["library"] = line_of(files.library, asked, cutter, cutter["id"])
"""
)

SPECS = ("R6L80", "R6L80rc2", "R6L80rc6", "R3L60rc1T5F20S8HR10L5+R20L30", "R5L40F10N4x12S6HR15:25L30", "D8L30rc1F6N3x5N3.5:4x4S5")
CUTTERS = (
    *(Cutter.parse(spec) for spec in SPECS),
    replace(Cutter.parse("R4L30F9S3HR20L10"), taper=-0.2),
    replace(Cutter.parse("R6L50rc1HR20L10"), allowance=0.3, clearance=1.0),
    Cutter.lollipop(radius=5, neck_radius=3, length=30),
    Cutter.barrel(radius=5, flank_radius=80, height=10, flutes=20.0, length=40),
)


def postures(cutter, count=12):
    """Contacts at which a cutter may touch: points, normals, axes and tilt directions; the first one is not tilted."""
    random = np.random.default_rng(7)
    normal, side = random.normal(size=(2, count, 3))
    normal /= np.linalg.norm(normal, axis=1)[:, None]
    lean = np.cross(normal, side)
    lean /= np.linalg.norm(lean, axis=1)[:, None]
    tilt = random.uniform(0.0, min(each.high for each in modes(cutter)), count) * (np.arange(count) > 0)
    axis = np.cos(tilt)[:, None] * normal + np.sin(tilt)[:, None] * lean
    return random.uniform(-50, 50, (count, 3)), normal, axis, lean, tilt


def entry(cutter):
    """The dimensions of a cutter, as a plan has them."""
    stages = [
        {"part": part, "low_mm": low, "length_mm": each.length, "radius_mm": each.radius, "upper_radius_mm": each.upper_radius}
        for part, low, each in cutter.stages
    ]
    return {
        "id": cutter.id, "shape": cutter.shape, "radius": cutter.radius, "corner_radius": cutter.corner_radius, "stages": stages,
        "taper_deg": math.degrees(cutter.taper), "length": cutter.length, "flutes_mm": flute_length(cutter),
        "allowance_mm": cutter.allowance or 0.0, "clearance_mm": cutter.clearance or 0.0,
    }  # fmt: skip


@pytest.fixture(scope="module")
def session(tmp_path_factory):
    folder = tmp_path_factory.mktemp("freecad")
    cases = [
        {
            "cutter": entry(cutter),
            "postures": [[row.tolist() for row in rows] for rows in zip(*postures(cutter)[:4], strict=True)],
        }
        for cutter in CUTTERS
    ]
    (folder / "cases.json").write_text(json.dumps(cases))
    (folder / "arrays").mkdir()
    np.savez(folder / "arrays" / "good.npz", a=np.arange(6.0).reshape(2, 3), b=np.array([True, False]))
    np.savez(folder / "arrays" / "pickled.npz", a=np.array([{}], dtype=object))
    whole = (folder / "arrays" / "good.npz").read_bytes()
    (folder / "arrays" / "cut.npz").write_bytes(whole[: len(whole) // 2])
    (folder / "arrays" / "empty.npz").write_bytes(b"")
    for name, shape in (("short", (2, 4)), ("long", (2, 2)), ("huge", (2**40,)), ("negative", (-1, 3))):
        header = io.BytesIO()
        np.lib.format.write_array_header_1_0(header, {"descr": "<f8", "fortran_order": False, "shape": shape})
        with zipfile.ZipFile(folder / "arrays" / f"{name}.npz", "w") as file:
            file.writestr("a.npy", header.getvalue() + np.arange(6.0).tobytes())
    more = {"PLAIN_PYTHON": sys.executable, "CASES": str(folder / "cases.json")}
    return planned(BAD, folder, whole=False, **more), folder


@pytest.fixture(scope="module")
def bad(session):
    return session[0]


def test_a_program_that_gives_no_plan_is_a_line(bad):
    says = {
        "wrong": "the part holds nothing",
        "silent": "the program ended with code 7 and wrote nothing",
        "killed": "the program ended with code -9 and wrote nothing",
        "none": "the program wrote no plan: give options of plan-cutters alone, no files of parts",
        "torn": "the program wrote no plan: give options of plan-cutters alone, no files of parts",
        "other": "the program wrote no plan of plan-cutters",
        "newer": "the plan has the format 2, this workbench reads 1: update the add-on",
    }
    assert {word: row[1] for word, row in bad["programs"].items()} == says
    assert all(row[0] == "failed" and row[2:] == [[], False] for row in bad["programs"].values())


def test_a_cancelled_plan_leaves_nothing(bad):
    assert bad["cancelled"] == ["cancelled", "cancelled; nothing was changed", [], False]
    assert bad["objects"] == [name for name in bad["objects"] if not name.startswith("Plan")]
    assert len(bad["pids"]) == 2
    for pid in bad["pids"]:
        # A process that nobody waited for is dead all the same.
        path = Path(f"/proc/{pid}/stat")
        assert not path.exists() or path.read_text().rpartition(")")[2].split()[0] == "Z"


def test_progress_is_told_once(bad):
    assert bad["progress"] == [["judging R6L80 (2 of 5)", 0.34], "ended"]


def test_what_is_asked_wrongly_is_a_line(bad):
    says = bad["asked"]
    assert all(row[0] == "failed" and "\n" not in row[1] for row in says.values())
    words = {
        "closed": "the document gone was closed",
        "gone": "Gone is no longer in the document work",
        "empty": "Empty holds no faces: select a body",
        "face": "Block (best) has no Face99: it has 11 faces",
        "itself": "Block (best) is the body itself: it cannot be a fixture, too",
        "fixture": "Empty holds no faces: select a body",
        "allowance": "the allowance must be 0 mm or more, not -1",
        "nan": "the allowance must be 0 mm or more, not nan",
        "bit": "Vise is no tool bit",
    }
    assert {name: says[name][1] for name in words} == words
    assert says["missing"][1].endswith("cannot be started: No such file or directory")
    assert says["nowhere"][1].startswith("the program plan-cutters was not found: install it")
    assert says["quote"][1].startswith("the program's path cannot be read")


def test_selections_that_are_no_body_are_a_line(bad):
    starts = {
        "nothing": "select one body",
        "two": "select one body",
        "documents": "the selection lies in 2 documents",
        "edge": "select faces or the whole body",
        "mixed": "select faces or the whole body",
        "container": "Cell is a container",
        "cells": "Cells is a container",
        "mesh": "Scan is a mesh",
        "empty": "Empty holds no faces",
        "step": "First is not the last step of Body",
        "through": "select the link Cells itself",
    }
    assert all(bad["picked"][word].startswith(start) for word, start in starts.items()), bad["picked"]
    assert bad["picked"].keys() == starts.keys()
    assert bad["taken"] == [["work", "Twin", [1, 3]], ["work", "Body", [2]], ["work", "Body", []], ["work", "Block", [2]]]


def test_a_link_is_planned_where_it_stands(bad):
    """A link has a placement in the place of its object's, and stands beside the container."""
    assert bad["link"] == pytest.approx([20.0, 120.0, 10.0])


def test_axes_of_what_was_picked(bad):
    """The container was turned by 90 degrees about X: up is -Y."""
    up, down, pin, frame, ball = bad["axes"]
    assert [float(word) for word in up.split(",")] == pytest.approx([0, -1, 0])
    assert [float(word) for word in down.split(",")] == pytest.approx([0, 1, 0])
    assert [float(word) for word in pin.split(",")] == pytest.approx([0, 0, 1])
    assert [float(word) for word in frame.split(",")] == pytest.approx([1, 0, 0])
    assert ball.startswith("Ball Vertex1 has no axis")
    for text in bad["fixed"]:
        assert sorted(float(word) for word in text.split(",")) == pytest.approx([0, 0, 1])


def test_a_late_result_is_refused(bad):
    other, changed, gone = bad["late"]
    assert other == "the plan is about the document work, not other"
    assert changed == "Block (best) was changed while it was planned: plan again"
    assert gone.startswith("Block is no longer in the document work")
    assert bad["none"] == [0, [], []]


def test_tips_are_those_of_the_program(bad):
    """At random contacts; a shape that the plan does not hold has none."""
    for cutter, row in zip(CUTTERS, bad["cutters"], strict=True):
        point, normal, axis, lean, tilt = postures(cutter)
        if cutter.shape == "barrel":
            assert row["tips"] == [None] * len(point)
            continue
        one = blank(len(point))
        one.axis[:], one.tilt_direction[:], one.tilt[:] = axis, lean, tilt
        assert np.allclose(row["tips"], tips(cutter, point, normal, one.freeze()), atol=1e-9), cutter.id


def test_assemblies_have_the_volume_of_their_outline(bad):
    for cutter, row in zip(CUTTERS, bad["cutters"], strict=True):
        if cutter.shape == "barrel":
            assert row["why"] == "a barrel cutter is not drawn here: the review page shows it"
            continue
        (r0, h0), (r1, h1) = (ends.T for ends in pairs(points(outline(cutter), 1e-6)))
        volume = math.pi / 3.0 * float(((h1 - h0) * (r0 * r0 + r0 * r1 + r1 * r1)).sum())
        assert row["volume"] == pytest.approx(volume, rel=1e-5), cutter.id
        assert (row["low"], row["high"]) == pytest.approx((0.0, outline(cutter).height), abs=1e-6)


def pairs(polyline):
    return polyline[:-1], polyline[1:]


def test_a_library_of_one_cutter_is_that_cutter(bad, session):
    """Its own allowance and clearance where these are not those of the whole plan."""
    for cutter, row in zip(CUTTERS, bad["cutters"], strict=True):
        if cutter.shape != "end":
            assert row.get("library", "") is not None
            continue
        path = session[1] / cutter.id / "tool.toml"
        (mine,) = read_library(path)
        holder = replace(cutter.holder, name="") if cutter.holder else None
        theirs = replace(
            cutter, name=cutter.id, allowance=cutter.allowance or 0.0, clearance=cutter.clearance or 0.0, holder=holder
        )
        assert shown(mine) == shown(theirs)


def shown(cutter):
    """Everything that a verdict depends on, to rounding of degrees."""
    found = entry(cutter)
    del found["id"]
    numbers = [
        found.pop(word)
        for word in ("radius", "corner_radius", "taper_deg", "length", "flutes_mm", "allowance_mm", "clearance_mm")
    ]
    rows = [tuple(each.values()) for each in found.pop("stages")]
    return [round(each, 9) for each in numbers], rows, found


def test_arrays_are_numbers_or_refused(bad):
    found = bad["arrays"]
    assert found.pop("good.npz") == {"a": [[0, 1, 2], [3, 4, 5]], "b": [True, False]}
    assert found == dict.fromkeys(
        (f"{name}.npz" for name in ("cut", "empty", "huge", "long", "negative", "pickled", "short")), "ValueError"
    )


def test_the_workbench_imports_nothing_of_the_program():
    """FreeCAD's own Python runs it: what it imports is FreeCAD's, the standard library's, or its own."""
    folder = ROOT / "freecad" / "plan_cutters"
    allowed = {*sys.stdlib_module_names, "FreeCAD", "FreeCADGui", "Mesh", "Part", "freecad", "numpy", "PySide", "pivy"}
    for path in folder.glob("*.py"):
        nodes = list(ast.walk(ast.parse(path.read_text())))
        plain = [alias.name for node in nodes if isinstance(node, ast.Import) for alias in node.names]
        plain += [node.module for node in nodes if isinstance(node, ast.ImportFrom) and not node.level]
        assert {name.partition(".")[0] for name in plain} <= allowed, path
    sizes = {path.name: len(path.read_text().splitlines()) for path in folder.glob("*.py")}
    assert sizes
    assert all(lines <= 400 for lines in sizes.values()), sizes
