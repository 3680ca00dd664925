"""Where a part stands: setup files, clamped faces, the machine's X, and linear travel."""

import json
import math
from dataclasses import replace

import numpy as np
import pytest

from plan_cutters import Cutter, Machine, Options, plan
from plan_cutters.domain.machine import Axis, builtin_machines
from plan_cutters.domain.placement import Placement, frame_of
from plan_cutters.domain.shapes import modes
from plan_cutters.domain.travel import tips, travel, unjudged
from plan_cutters.domain.verdicts import blank
from plan_cutters.errors import OptionError
from plan_cutters.setups.files import read_setup
from tests.support.commands import assert_one_line
from tests.support.forked import run
from tests.support.machine_files import tool_in_part
from tests.support.places import SAMPLES
from tests.support.tool_reference import KINDS, Reference, random_cutter

X, Y, Z = (1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)
CUTTER = Cutter.flat(radius=2, length=40)
PLACED = Placement(z=(1, -2, 0.5), x=(0.3, 1, 1), origin=(10, -20, 30))


def linear(*limits, carries="tool"):
    """Three linear axes with one pair of limits each."""
    given = [None if each is None else each for each in limits]
    return tuple(Axis(name, "linear", carries, way, end) for name, way, end in zip("XYZ", (X, Y, Z), given, strict=True))


def turning(*rotary, limits=((-500, 500),) * 3):
    """A machine of rotary axes and three linear ones that carry the tool."""
    carried = [axis for axis in rotary if axis.carries == "part"]
    return Machine("mill", axes=(*carried, *linear(*limits), *(axis for axis in rotary if axis.carries == "tool")))


TRUNNION = turning(
    Axis("C", "rotary", "part", Z, point=(12, -7, 40)), Axis("A", "rotary", "part", X, (-2.0, 2.0), point=(3, 25, -60))
)
HEADS = turning(Axis("C", "rotary", "tool", Z, point=(1, 2, 3)), Axis("B", "rotary", "tool", (0, 1, 1), point=(-4, 6, 150)))
TABLE_AND_HEAD = Machine(
    "skew",
    axes=(
        Axis("Y", "linear", "part", Y, (-50, 50)),
        Axis("C", "rotary", "part", Z, point=(100, 0, 7)),
        Axis("X", "linear", "part", (1, 0.2, 0), (-50, 50)),
        Axis("Z", "linear", "tool", Z, (-50, 50)),
        Axis("B", "rotary", "tool", Y, point=(0, 0, 200)),
    ),
)


def test_three_axes_closed_form():
    """The position is the tip less the origin, and the tool above it."""
    machine = Machine("mill", axes=linear((-10, 10), None, (0, 60)), fixed=True)
    tip = np.array([[1.0, 2.0, 3.0], [40.0, 0.0, 0.0], [5.0, 5.0, 35.0]])
    found = travel(machine, Placement(origin=(5, 6, 7)), tip, np.tile(Z, (3, 1)), 40.0)
    assert np.allclose(found.position, tip - (5, 6, 7) + (0, 0, 40), atol=1e-12)
    assert np.allclose(found.beyond, [[0, 0, 0], [25, 0, 0], [0, 0, 8]], atol=1e-12)
    assert found.outside.tolist() == [False, True, True]
    assert found.taken.tolist() == [0, 0, 0]


def test_an_axis_that_is_not_held_has_no_position():
    machine = Machine("mill", axes=linear((-10, 10), None, (0, 60)), fixed=True)
    axis = np.array([X, (math.nan,) * 3])
    found = travel(machine, Placement(origin=(0, 0, 0)), np.zeros((2, 3)), axis, 40.0)
    assert np.isnan(found.position).all()
    assert not found.outside.any()
    assert found.taken.tolist() == [-1, -1]


@pytest.mark.parametrize("machine", [TRUNNION, HEADS, TABLE_AND_HEAD], ids=lambda each: each.name)
def test_positions_against_homogeneous_matrices(machine):
    """At the angles and positions found, the chain of rigid motions brings nose and axis to where they must be."""
    random = np.random.default_rng(4)
    axis = random.normal(size=(300, 3))
    axis /= np.linalg.norm(axis, axis=1)[:, None]
    tip, length = random.uniform(-80, 80, (300, 3)), 62.5
    found = travel(machine, PLACED, tip, axis, length)
    frame = frame_of(np.array(PLACED.z), np.array(PLACED.x))
    angles = machine.kinematics(frame).positions(axis)[0]
    rows = np.flatnonzero(found.taken >= 0)
    assert len(rows) > 50
    for row in rows:
        at = {a.name: v for a, v in zip(machine.rotary, angles[row, found.taken[row]], strict=True)}
        at |= {a.name: v for a, v in zip(machine.linear, found.position[row], strict=True)}
        held = tool_in_part(machine, at)
        nose = frame @ (tip[row] + length * axis[row] - PLACED.origin)
        assert np.abs(held[:3, 3] - nose).max() < 1e-8
        assert np.abs(held[:3, 2] - frame @ axis[row]).max() < 1e-6


@pytest.mark.parametrize("seed", range(40))
def test_positions_of_random_chains(seed):
    """Up to two rotary axes anywhere among three skew linear ones, no direction along any other, in a skew setup."""
    random = np.random.default_rng(seed)
    kinds = random.permutation(["linear"] * 3 + ["rotary"] * int(random.integers(0, 3)))
    split, names, axes = random.integers(0, len(kinds) + 1), {"linear": list("XYZ"), "rotary": list("AB")}, []
    for k, kind in enumerate(kinds):
        carries, point = "part" if k < split else "tool", tuple(random.uniform(-200, 200, 3))
        limits = (-100, 100) if kind == "linear" else None
        axes.append(Axis(names[kind].pop(0), str(kind), carries, tuple(random.normal(size=3)), limits, point))
    tool = tuple(random.normal(size=3))
    machine = Machine("skew", axes=tuple(axes), fixed="rotary" not in kinds, tool_axis=tool)
    placement = Placement(tuple(random.normal(size=3)), tuple(random.normal(size=3)), tuple(random.uniform(-50, 50, 3)))
    frame = frame_of(np.array(placement.z), np.array(placement.x))
    kinematics = machine.kinematics(frame)
    axis = kinematics.axis(random.uniform(-3, 3, (20, len(machine.rotary))))
    tip = random.uniform(-80, 80, (20, 3))
    found = travel(machine, placement, tip, axis, 33.0)
    angles = kinematics.positions(axis)[0]
    assert (found.taken >= 0).all()
    for row in range(20):
        at = {a.name: v for a, v in zip(machine.rotary, angles[row, found.taken[row]], strict=True)}
        at |= {a.name: v for a, v in zip(machine.linear, found.position[row], strict=True)}
        held = tool_in_part(machine, at)
        assert np.abs(held[:3, 3] - frame @ (tip[row] + 33.0 * axis[row] - placement.origin)).max() < 1e-8
        assert np.abs(held[:3, :3] @ machine.tool_axis - frame @ axis[row]).max() < 1e-7


def test_of_two_solutions_the_one_within_the_travel_is_taken():
    """A table that swings to either side brings the part to +Y or -Y: where one is beyond the travel, the other is taken."""
    axis = np.array([[math.sin(0.5), 0.0, math.cos(0.5)]])
    wide = travel(TRUNNION, Placement(origin=(0, 0, 0)), np.zeros((1, 3)), axis, 50.0)
    narrow = []
    for low, high in ((-500, 500), (-500, wide.position[0, 1] - 1), (wide.position[0, 1] + 1, 500)):
        machine = turning(*TRUNNION.rotary, limits=((-500, 500), (low, high), (-500, 500)))
        narrow.append(travel(machine, Placement(origin=(0, 0, 0)), np.zeros((1, 3)), axis, 50.0))
    assert narrow[0].taken[0] == wide.taken[0]
    changed = [each for each in narrow[1:] if each.taken[0] != wide.taken[0]]
    assert len(changed) == 1
    assert not changed[0].outside.any()
    kept = next(each for each in narrow[1:] if each.taken[0] == wide.taken[0])
    assert kept.outside.all()
    assert math.isclose(kept.beyond[0, 1], 1.0, abs_tol=1e-9)


def test_linear_axes_in_one_plane_are_not_known():
    """A tool axis that swings the Z slide down into the plane of X and Y leaves nothing to move it up."""
    axes = (
        Axis("X", "linear", "tool", X, (-9, 9)),
        Axis("Y", "linear", "tool", Y, (-9, 9)),
        Axis("A", "rotary", "tool", X),
        Axis("Z", "linear", "tool", Z, (-9, 9)),
    )
    axis = np.array([Z, (0, -1, 0)], float)
    found = travel(Machine("slide", axes=axes), Placement(origin=(0, 0, 0)), np.zeros((2, 3)), axis, 1.0)
    assert np.isfinite(found.position[0]).all()
    assert np.isnan(found.position[1]).all()
    assert found.outside.tolist() == [False, False]


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("seed", range(3))
def test_the_tip_is_where_the_outline_touches(kind, seed):
    """Against a twin that finds the lowest point of a leaning outline."""
    random = np.random.default_rng(seed)
    cutter = random_cutter(random, kind)
    twin, touching = Reference(cutter), [mode for mode in modes(cutter) if mode.high > mode.low + 1e-3]
    reach = blank(30)
    for k in range(30):
        mode = touching[k % len(touching)]
        reach.tilt[k] = random.uniform(mode.low + 1e-4, mode.high - 1e-4)
    normal = random.normal(size=(30, 3))
    normal /= np.linalg.norm(normal, axis=1)[:, None]
    tilt_direction = np.cross(normal, random.normal(size=(30, 3)))
    reach.tilt_direction[:] = tilt_direction / np.linalg.norm(tilt_direction, axis=1)[:, None]
    reach.axis[:] = np.cos(reach.tilt)[:, None] * normal + np.sin(reach.tilt)[:, None] * reach.tilt_direction
    point = random.uniform(-9, 9, (30, 3))
    tip = tips(cutter, point, normal, reach)
    for k in range(30):
        expected, rows = twin.frame(point[k], normal[k], reach.tilt_direction[k], reach.tilt[k])
        assert np.abs(rows[2] - reach.axis[k]).max() < 1e-12
        assert np.abs(tip[k] - expected).max() < 1e-6


def test_a_plan_says_which_samples_are_beyond_the_travel(tmp_path):
    """A groove 240 mm long along Y on a machine that moves 100 mm: verdicts stay, the samples are named."""
    cutter = Cutter.ball(radius=3, length=40)
    machine = Machine("mill", axes=linear((-500, 500), (-50, 50), (-500, 500)), fixed=True)
    words = {"cutters": cutter, "faces": "all", "grid": 9, "area_budget": 0}
    known = plan("samples/v_groove.step", machine=machine, setup=Placement(origin=(1, 2, 3)), **words)
    without = plan("samples/v_groove.step", machine=machine, **words)
    reach, other = known.reaches[cutter.id], without.reaches[cutter.id]
    assert (reach.verdict == other.verdict).all()
    known.write(tmp_path, ["json", "npz"])
    with np.load(tmp_path / "samples.npz") as arrays:
        found = arrays[f"travel_{cutter.id}"]
    samples, rows = known.samples, np.flatnonzero(reach.reached)
    assert len(rows)
    expected = samples.point[rows] + 3 * samples.normal[rows] + 37 * reach.axis[rows] - (1, 2, 3)
    assert np.abs(found[rows] - expected).max() < 1e-9
    assert np.abs(reach.axis[rows] - Z).max() < 2e-6
    assert np.isnan(found[~reach.reached]).all()
    entry = json.loads((tmp_path / "plan.json").read_text())["cutters"][0]["travel"]
    over = np.abs(expected[:, 1]) - 50
    assert entry["outside"] == entry["axes"][1]["outside"] == int((over > 1e-4).sum()) > 0
    assert entry["judged"] == len(rows)
    assert [each["axis"] for each in entry["worst"]] == ["Y"]
    assert math.isclose(entry["worst"][0]["beyond_mm"], over.max(), abs_tol=1e-9)
    assert entry["axes"][1]["limits_mm"] == [-50, 50]
    assert without.cutters[0].travel is None
    assert any(note.startswith("Linear travel is not judged: where the part stands") for note in without.plan.notes)
    assert not any("Linear travel is not judged" in note for note in known.plan.notes)


def test_why_travel_is_not_judged():
    placed, mill = Placement(origin=(0, 0, 0)), linear((0, 9), None, None)
    assert unjudged(Machine(), None) == ""
    assert unjudged(Machine("m", axes=mill, fixed=True), placed) is None
    assert "states no limits" in unjudged(builtin_machines()["3+2"], placed)
    assert "not known" in unjudged(Machine("m", axes=mill, fixed=True), Placement())
    assert "2 linear axes" in unjudged(Machine("m", axes=mill[:2], fixed=True), placed)
    assert "rotary axes" in unjudged(Machine("m", axes=mill), placed)


@pytest.mark.slow("plans twice for each", only=("x0", "x2"))
@pytest.mark.parametrize("x", [(0, 1, 0), (1, 1, 0.5), (-1, 0, 0)])
def test_turning_the_part_is_turning_the_machine(x):
    """The part's `x` along the machine's X is the same as a machine whose axes are turned about the spindle."""
    frame = frame_of(np.array(Z), np.array(Placement(x=x).x))
    limits = (math.radians(20), math.radians(50))
    along = tuple(frame.T @ (1, 0, 0))
    axes = [
        (Axis("A", "rotary", "part", way, limits), Axis("B", "rotary", "tool", tuple(frame.T @ (0, 1, 0)) if own else Y, limits))
        for way, own in ((X, False), (along, True))
    ]
    words = {"cutters": CUTTER, "grid": 13, "area_budget": 0}
    placed = plan("samples/peaks_and_valleys.step", machine=Machine("m", axes=axes[0]), setup=Placement(x=x), **words)
    turned = plan("samples/peaks_and_valleys.step", machine=Machine("m", axes=axes[1]), **words)
    plain = plan("samples/peaks_and_valleys.step", machine=Machine("m", axes=axes[0]), **words)
    verdicts = [each.reaches[CUTTER.id].verdict for each in (placed, turned, plain)]
    assert (verdicts[0] == verdicts[1]).all()
    assert (verdicts[0] != verdicts[2]).any()
    rows = placed.reaches[CUTTER.id].reached
    assert placed.kinematics.allows(placed.reaches[CUTTER.id].axis[rows]).all()


def test_other_setups_have_an_x_of_their_own():
    machine = Machine("m", axes=(Axis("A", "rotary", "part", X, (-0.2, 0.6)), Axis("B", "rotary", "part", Y, (-0.2, 0.6))))
    words = {"cutters": CUTTER, "machine": machine, "grid": 9, "area_budget": 0}
    turned = Placement(z=(0, 1, 1), x=(-1, 0, 0))
    both = plan("samples/blade.step", setup=Z, other_setups=[turned], **words)
    alone = plan("samples/blade.step", setup=turned, **words)
    ((_, found),) = both.over_setups.each[1:]
    assert (found[CUTTER.id].reached == alone.reaches[CUTTER.id].reached).all()
    assert both.plan.effective.other_placements[0].x == (-1.0, 0.0, 0.0)


def write(folder, text, name="vise.toml"):
    path = folder / name
    path.write_text(text, encoding="utf-8")
    return path


def test_a_setup_file(tmp_path):
    text = 'unit = "in"\nz = [0, 0, 3]\nx = [0, 2, 1]\norigin = [1, -2, 0.5]\nclamped = "F2,F3"\n'
    text += 'fixtures = ["table:-5:mm", "jaw.stl"]\n'
    found = read_setup(write(tmp_path, text))
    assert (found.z, found.x, found.file) == (Z, Y, "vise.toml")
    assert np.allclose(found.origin, (25.4, -50.8, 12.7), atol=1e-12)
    assert found.clamped == ("F2,F3",)
    assert [each.source for each in found.fixtures] == ["table:-5", str(tmp_path / "jaw.stl")]
    assert read_setup(write(tmp_path, 'unit = "mm"\naxis = [0, 1, 0]\n')) == Placement(z=Y, file="vise.toml")


@pytest.mark.parametrize(
    ("text", "cause"),
    [
        ("axis = [0, 0, 1]", "unit is missing, as unit"),
        ('unit = "furlong"\naxis = [0, 0, 1]', "no length unit is called 'furlong'"),
        ('unit = "mm"', "axis is missing"),
        ('unit = "mm"\naxis = [0, 0, 0]', "not all zero"),
        ('unit = "mm"\naxis = [0, 0, 1]\nz = [0, 0, 1]', "two names"),
        ('unit = "mm"\nz = [0, 0, 1]\nx = [0, 0, -3]', "x is parallel"),
        ('unit = "mm"\nz = [0, 0, 1]\nx = [0, 1]', "x is"),
        ('unit = "mm"\naxis = [0, 0, 1]\nspindle = 3', "spindle"),
        ('unit = "mm"\naxis = [0, nan, 1]', "axis"),
        ('unit = "mm"\naxis = [0, "1", 1]', "axis"),
        ('unit = "mm"\naxis = [0, 0, 1]\norigin = [inf, 0, 0]', "origin"),
        ('unit = "km"\naxis = [0, 0, 1]\norigin = [1e9, 0, 0]', "origin"),
        ('unit = "mm"\naxis = [0, 0, 1]\nclamped = [3]', "clamped"),
        ('unit = "mm"\naxis = [0, 0, 1]\nclamped = ""', "clamped"),
        ('unit = "mm"\naxis = [0, 0, 1]\nfixtures = ["box:1,2"]', "box takes x,y,z"),
        ('unit = "in"\naxis = [0, 0, 1]\nfixtures = ["table:-5"]', "must say its unit"),
        ("<!DOCTYPE html><html><body>404</body></html>", "web page"),
        ('{"unit": "mm"}', "is no TOML"),
        ("", "unit is missing"),
        ("[[[[", "is no TOML"),
    ],
)
def test_bad_setup_files_are_one_line(tmp_path, text, cause):
    with pytest.raises(OptionError) as caught:
        read_setup(write(tmp_path, text))
    message = str(caught.value)
    assert cause in message
    assert message.startswith("vise.toml: ")
    assert "\n" not in message
    assert message.count("vise.toml") == 1


@pytest.mark.parametrize(
    ("text", "cause"),
    [
        ("<html></html>", "vise.toml: is a web page"),
        ('unit = "mm"\naxis = [0, 0, 1]\nclamped = "F99"', "vise.toml: clamped F99: there is no face F99"),
    ],
)
def test_the_command_says_what_is_wrong_with_a_setup_file(tmp_path, text, cause):
    write(tmp_path, text)
    done = run(SAMPLES / "v_groove.step", "--cutter", "R2L30", "--setup", "vise.toml", "--quiet", cwd=tmp_path)
    assert_one_line(done, 2, cause)
    assert sorted(path.name for path in tmp_path.iterdir()) == ["vise.toml"]


def test_clamped_faces_stay_targets_and_fixtures_are_in_the_way(tmp_path):
    write(tmp_path, 'unit = "mm"\naxis = [0, 0, 1]\norigin = [0, 0, 5]\nclamped = ["F1", "F3"]\nfixtures = ["table:-50"]\n')
    done = run(SAMPLES / "v_groove.step", "--cutter", "R2L30rc2", "--setup", "vise.toml", "--faces", "all", "--grid", "5",
               "--json", "-", "--area-budget", "0", cwd=tmp_path)  # fmt: skip
    assert done.returncode in (0, 1), done.stderr
    found = json.loads(done.stdout)
    assert found["effective"]["target_faces"] == ["F1", "F2", "F3"]
    assert found["effective"]["fixtures"] == ["table:-50"]
    assert found["effective"]["placement"] == {"file": "vise.toml", "x": None, "origin_mm": [0, 0, 5], "clamped": ["F1", "F3"]}
    assert "2 faces are clamped and left for another setup: F1, F3." in found["notes"]
    assert [each["name"] for each in found["fixtures"]] == ["fixture:table"]


def test_clamped_faces_that_leave_none():
    with pytest.raises(OptionError, match="clamped F1 leaves no target face"):
        plan("samples/v_groove.step", faces="F1", setup=Placement(clamped=("F1",)), cutters=CUTTER)


def test_options_keep_a_placement(tmp_path):
    path = write(tmp_path, 'unit = "mm"\naxis = [0, 0, 2]\nx = [0, 1, 0]\nfixtures = ["table:-50"]\n')
    found = Options(setup=path, fixtures="box:1,2,3")
    assert (found.setup, found.placement.x) == (Z, Y)
    assert [each.text for each in found.fixtures] == ["box:1,2,3", "table:-50"]
    again = replace(found, grid=5)
    assert (again.setup, again.placement, again.fixtures) == (found.setup, found.placement, found.fixtures)
    with pytest.raises(OptionError, match="disagree"):
        replace(found, setup=X)
    # What it names stands in its own setup alone; what is given beside it, in all.
    other = Options(setup=X, other_setups=[path], fixtures="box:1,2,3")
    assert [each.text for each in other.fixtures] == [each.text for each in other.shared_fixtures] == ["box:1,2,3"]
    assert [each.text for each in other.other_placements[0].fixtures] == ["table:-50"]
    assert replace(other, grid=5).other_placements == other.other_placements
    assert [each.text for each in found.shared_fixtures] == [each.text for each in again.shared_fixtures] == ["box:1,2,3"]
    both = Options(setup=path, fixtures="table:-50")
    assert both.shared_fixtures == both.fixtures
    assert Options(setup=X, other_setups=[path], fixtures="table:-50").other_placements[0].x == Y


def test_placements_that_have_no_meaning():
    for words in ({"z": (0, 0, 0)}, {"z": (math.nan, 0, 1)}, {"x": (0, 0, 1)}, {"x": "up"}, {"origin": (math.inf, 0, 0)},
                  {"origin": (0, 0)}, {"clamped": (3,)}, {"file": 3}):  # fmt: skip
        with pytest.raises(OptionError):
            Placement(**words)
    with pytest.raises(OptionError):
        Options(placement="vise.toml")
    with pytest.raises(OptionError):
        Options(other_setups=[X, Y], other_placements=[None])
