"""What is requested: faces chosen and left out, kinds of arguments, angles that cannot be radians."""

import json
import math
from dataclasses import fields, replace

import jsonschema
import numpy as np
import pytest
from OCP.STEPControl import STEPControl_AsIs, STEPControl_Writer

from cad_io import CadIoError, read_part
from plan_cutters import Cutter, Machine, Options, PlanError, PostureRange, plan, posture_map
from plan_cutters.command import cli, validation
from plan_cutters.command.request import PlanRequest
from plan_cutters.command.validation import OF_OPERATIONS
from plan_cutters.domain.machine import builtin_machines
from plan_cutters.errors import CutterError, MachineError, OptionError
from plan_cutters.options import ANGLES
from tests.support.cad_parts import compound
from tests.support.commands import assert_one_line, in_lines
from tests.support.forked import run
from tests.support.places import ROOT
from tests.support.shapes import plane


def covered():
    """A floor, F1, and 1 mm above it a sheet of construction geometry, F2, that hides it from every cutter."""
    return compound(plane((-10, 10), (-10, 10)), plane((-20, 20), (-20, 20), origin=(0, 0, 1)))


SMALL = {"cutters": "R3L40", "spacing": 4.0, "tolerance": 0.05, "area_budget": 0}


def test_what_is_ignored_is_neither_target_nor_obstacle():
    alone = plan(plane((-10, 10), (-10, 10)), **SMALL)
    assert alone.selected == "R3L40"
    hidden = plan(covered(), faces="F1", **SMALL)
    assert hidden.cutters[0].inaccessible == hidden.plan.samples.count == alone.plan.samples.count
    for ignore in ("F2", ["2"], 2, "!1"):
        bare = plan(covered(), ignore=ignore, **SMALL)
        assert (bare.reaches["R3L40"].verdict == alone.reaches["R3L40"].verdict).all()
        assert bare.plan.effective.obstacle_triangles == alone.plan.effective.obstacle_triangles
        assert [(f.id, f.target, f.ignored) for f in bare.plan.faces] == [("F1", True, False), ("F2", False, True)]
        assert any("F2" in note and "ignored" in note for note in bare.plan.notes)
    with pytest.raises(OptionError, match="is ignored"):
        plan(covered(), faces="F2", ignore="F2", **SMALL)
    with pytest.raises(OptionError, match="leaves none"):
        plan(covered(), ignore=("F1", "F2"), **SMALL)
    with pytest.raises(OptionError, match="--ignore F3"):
        plan(covered(), ignore="F3", **SMALL)


def test_a_posture_map_ignores_too():
    ask = {"point": (0, 0, 0), "cutter": "R3L40", "rotations": [0.0], "tolerance": 0.05}
    (free,) = posture_map(covered(), ignore="F2", **ask).free
    (alone,) = posture_map(plane((-10, 10), (-10, 10)), **ask).free
    assert free == pytest.approx(alone)
    assert len(free)
    assert not len(posture_map(covered(), **ask).free[0])
    with pytest.raises(CadIoError, match="no face within"):
        posture_map(covered(), ignore="F1", **ask)


@pytest.mark.slow("runs whole commands")
def test_ignoring_on_the_command_line(tmp_path):
    writer = STEPControl_Writer()
    writer.Transfer(covered(), STEPControl_AsIs)
    writer.Write(str(tmp_path / "covered.step"))
    words = ("covered.step", "--cutter", "R3L40", "--spacing", "4", "--tolerance", "0.05", "--area-budget", "0")
    done = run(*words, "--ignore", "F2", "-v", cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    assert "1 to machine, 1 ignored" in in_lines(done.stdout)
    assert "No face that can be judged is sculptured" in in_lines(done.stdout)
    document = json.loads((tmp_path / "covered-plan" / "plan.json").read_text())
    jsonschema.Draft202012Validator(json.loads((ROOT / "plugin/plan_cutters/plan.schema.json").read_text())).validate(document)
    assert document["effective"]["ignore"] == ["F2"]
    assert document["effective"]["target_faces"] == ["F1"]
    assert "ignored" in document["legend"]
    names = {f.name for f in read_part(tmp_path / "covered-plan" / "annotated.step").faces}
    assert names == {"F1_interference_free", "F2_ignored"}
    assert_one_line(run(*words, "--ignore", "component:jig", cwd=tmp_path), 2, "--ignore component:jig")
    assert_one_line(run(*words, "--faces", "F1", "--ignore", "!2", cwd=tmp_path), 2, "F1 is ignored")


def test_a_plan_without_sculptured_faces_says_so():
    floor = plane((-10, 10), (-10, 10))
    assert any("is sculptured: all are targets (1)" in note for note in plan(floor, **SMALL).plan.notes)
    assert not any("sculptured" in note for note in plan(floor, faces="all", **SMALL).plan.notes)


def test_texts_stand_for_cutters_and_machines():
    cutter, machine = Cutter.flat(radius=6, length=80), Machine.parse("tilt:60")
    for cutters in ("R6L80", cutter, ["R6L80"], (cutter,), np.array(["R6L80"])):
        assert Options(cutters=cutters, machine="tilt:60") == Options(cutters=(cutter,), machine=machine)
    assert Options(cutters=None, machine=None) == Options()


@pytest.mark.parametrize(
    ("ask", "angle"),
    [
        ({"rotation_step": 10}, "10"),
        ({"tilt": (0, 90)}, "90"),
        ({"tilt": np.array([-30.0, 0.0])}, "-30"),
        ({"rotation": (0, 360)}, "360"),
        ({"rotation": (-20, -10)}, "-20"),
        ({"machine": 60}, "60"),
    ],
)
def test_angles_that_cannot_be_radians(ask, angle):
    with pytest.raises(OptionError) as error:
        Machine(tilt_limit=ask["machine"]) if "machine" in ask else plan(covered(), **ask)
    assert f"radians; math.radians({angle})?" in str(error.value)


@pytest.mark.parametrize("rotations", [[20], 20, (0.0, -7), np.array([0.1, 90.0])])
def test_rotations_of_a_map_that_cannot_be_radians(rotations):
    with pytest.raises(OptionError, match=r"radians; math\.radians\("):
        posture_map(covered(), point=(0, 0, 0), cutter="R3L40", rotations=rotations)


def test_a_right_angle_and_a_turn_are_radians():
    in_single = np.float32(2 * math.pi)  # a little more than a turn
    assert PostureRange(rotation=(0.0, 2 * math.pi), step=in_single)
    assert PostureRange(tilt=(0, math.pi / 2), rotation=(-math.pi, math.pi))


@pytest.mark.parametrize("degrees", [(0, 360), (350, 380), (180, 540), (-400, -390), (720, 720)])
def test_degrees_give_the_same_rotations(degrees):
    found = PostureRange.degrees((0, 90), degrees, 10).rotations
    first, last = degrees
    wanted = np.arange(first, last + (0 if last - first == 360 else 1), 10)
    assert np.exp(1j * found) == pytest.approx(np.exp(1j * np.radians(wanted)))


#: No parameter takes one of these, unless `FINE` says so.
STRANGE = {
    "None": None, "three": 3, "minus one": -1, "a half": 2.5, "huge": 10**400, "nan": math.nan, "inf": math.inf, "True": True,
    "no text": "", "text": "6 mm", "bytes": b"x", "no dict": {}, "dict": {"a": 1}, "no list": [], "number in list": [-1.5],
    "texts": ["a", "b"], "nones": [None, None], "trues": [True, True, True], "nans": [math.nan, math.nan, math.nan],
    "table": np.zeros((2, 3)), "no dimension": np.array(1.0), "array of texts": np.array(["a", "b", "c"]), "object": object(),
    "set": {1}, "complex": 2j, "function": len, "lists": [[1, 2], [3, 4]],
}  # fmt: skip
FINE = {
    "plan": {
        "cutters": "None, no list, no dict", "machine": "None", "faces": "None", "ignore": "None, no list", "grid": "None, three",
        "spacing": "None, three, a half", "rotation_step": "three, a half", "jobs": "None, three", "flip": "True",
        "area_budget": "None, three", "posture_maps": "True", "map_budget": "None, three",
        "unit": "None", "progress": "None, function", "tilt": "None",
    },
    "posture_map": {
        "rotations": "three, a half, minus one, no list, number in list", "machine": "None", "flip": "True",
        "ignore": "None, no list", "tolerance": "None", "tilt": "None",
    },
    "read_part": {
        "unit": "None", "guarded": "True", "timeout": "three, minus one, a half, huge, inf",
    },
    "Cutter": {
        "radius": "three, a half", "length": "three, a half", "corner_radius": "three, a half", "name": "no text, text",
        "taper": "a half", "flutes": "None, three, a half", "shank_radius": "None", "neck": "None, no list", "holder": "None",
        "shape": "", "arc_radius": "", "outline": "no list", "allowance": "None, three, a half",
        "clearance": "None, three, a half",
    },
    "Machine": {"name": "no text, text", "tilt_limit": "None, three, a half"},
    "PostureRange": {"tilt": "", "rotation": "", "step": "three, a half"},
    "Options": {
        "cutters": "None, no list, no dict", "machine": "None", "setup": "",
        "grid": "None, three", "spacing": "None, three, a half",
        "tilt": "None", "rotation": "", "rotation_step": "three, a half", "tolerance": "", "jobs": "None, three", "flip": "True",
        "area_budget": "None, three", "posture_maps": "True", "map_budget": "None, three",
        "allowance": "three, a half", "holder_clearance": "three, a half",
        "holder": "None",
        "unit": "None",
    },
}  # fmt: skip
PARAMETERS = [
    *(("plan", word) for word in [*FINE["plan"], "part", "setup", "rotation", "tolerance"]),
    *(("posture_map", word) for word in [*FINE["posture_map"], "part", "point", "cutter", "setup"]),
    *(("read_part", word) for word in [*FINE["read_part"], "source"]),
    *((call, word) for call in ("Cutter", "Machine", "PostureRange", "Options") for word in FINE[call]),
]


@pytest.fixture(scope="module")
def floor():
    return read_part(covered())


@pytest.mark.parametrize(("call", "word"), PARAMETERS)
def test_values_of_the_wrong_kind_are_refused(floor, call, word):
    function, given = {
        "plan": (plan, {"part": floor}),
        "posture_map": (posture_map, {"part": floor, "point": (0, 0, 0), "cutter": "R3L40", "rotations": [0.0]}),
        "read_part": (read_part, {"source": covered()}),
        "Cutter": (Cutter, {"radius": 6, "length": 80}),
        "Machine": (Machine, {}),
        "PostureRange": (PostureRange, {}),
        "Options": (Options, {}),
    }[call]
    fine = FINE[call].get(word, "").split(", ")
    assert set(fine) <= {*STRANGE, ""}
    for name in sorted(STRANGE.keys() - set(fine)):
        with pytest.raises((PlanError, CadIoError)) as error:
            taken(function(**{**given, word: STRANGE[name]}), f"{call}({word}={name})")
        assert "\n" not in str(error.value), name
        assert len(str(error.value)) < 300, name


def taken(_, what):
    pytest.fail(f"{what} is taken")


def test_the_error_tells_whose_it_is():
    for call, kind in (
        (lambda: Cutter(radius="6", length=80), CutterError),
        (lambda: Cutter(radius=6, length=80, name=3), CutterError),
        (lambda: Cutter.parse(6), CutterError),
        (lambda: Options(cutters=6), CutterError),
        (lambda: Machine.parse(None), MachineError),
        (lambda: Machine(tilt_limit="60"), MachineError),
        (lambda: Options(machine=60), MachineError),
    ):
        with pytest.raises(kind):
            call()


def test_a_setup_axis_of_any_length():
    for size in (1e-300, 1e300):
        axis = (3 * size, 0.0, 4 * size)
        found = plan(plane((-10, 10), (-10, 10)), setup=axis, **SMALL).plan.effective.setup
        assert found == pytest.approx((0.6, 0.0, 0.8))


@pytest.mark.parametrize("word", sorted(OF_OPERATIONS))
def test_what_counts_in_operations_alone_is_not_ignored(word):
    """Without a plan of operations an option of it is refused, unless it has its default, which is that of `Options`."""
    default = next(each.default for each in fields(Options) if each.name == word)
    request = PlanRequest(**cli.command.make_context("plan-cutters", ["part.step"]).params)
    with pytest.raises(OptionError, match=f"--{word.replace('_', '-')} is about a plan of operations"):
        validation.refuse_unplanned_operations(replace(request, **{word: 7}))
    if word in ANGLES and default is not None:  # the command takes degrees
        default = pytest.approx(math.degrees(default))
    assert getattr(request, word) == default
    validation.refuse_unplanned_operations(request)
    validation.refuse_unplanned_operations(replace(request, **{word: 7}, operations="both"))


@pytest.mark.parametrize("machine", ["unlimited", "tilt:30", *builtin_machines()])
def test_operations_are_planned_on_every_machine(machine):
    assert Options(machine=machine, operations="fewest").operations == "fewest"


def test_an_index_step_is_told_in_degrees():
    with pytest.raises(OptionError, match=r"index step 120 must lie between 0\.5 and 90 deg"):
        Options(operations="fewest", index_step=math.radians(120.0))
    assert Options(operations="fewest", index_step=math.radians(0.5)).index_step == pytest.approx(math.radians(0.5))
    assert Options(operations="fewest", index_step=math.radians(90.0)).index_step == pytest.approx(math.pi / 2)
