"""Machine files: read as the chain that they describe, or refused in one line."""

import contextlib
import json
import math

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from plan_cutters.command.entry import begin
from plan_cutters.domain.machine import Axis, Machine, builtin_machines
from plan_cutters.errors import MachineError
from plan_cutters.machines import machine_of, plain, read_machine, to_toml
from plan_cutters.machines.explain import share, solutions, tool_axis
from plan_cutters.options import Options
from tests.support.machine_files import (  # fmt: skip
    HEAD,
    TABLE,
    fcm,
    fcm_axis,
    ini,
    mch,
    mch_axis,
    moved,
    own,
    rotary,
    shifted,
    tool_in_part,
    write,
)
from tests.support.places import DATA, ROOT

REAL = DATA / "machines"
X, Y, Z = [1, 0, 0], [0, 1, 0], [0, 0, 1]
ANGLES = [(0.0, 0.0), (0.3, -0.4), (-1.1, 0.7), (2.0, 1.2), (0.5, 3.0)]


def limits(machine):
    """Limits by name, deg or mm."""
    return {
        axis.name: axis.limits and tuple(round(math.degrees(v) if axis.kind == "rotary" else v, 6) for v in axis.limits)
        for axis in machine.axes
    }


def held_by(machine, angles):
    """The tool axis that the code under test has at angles of the rotary axes, part first."""
    return machine.kinematics(np.eye(3)).axis(np.array([angles]))[0]


# Real files


@pytest.mark.parametrize(
    ("path", "added", "order", "expected"),
    [
        (REAL / "linuxcnc_xyzac-trt.ini", "", "CA", {"A": (-100, 50), "C": (-36000, 36000), "Y": (-100, 100)}),
        (REAL / "linuxcnc_xyzbc-trt.ini", "", "CB", {"B": (-100, 50), "C": (-36000, 36000), "X": (-200, 200)}),
        (REAL / "linuxcnc_5axis.ini", "", "CB", {"B": (-120, 120), "C": (-36000, 36000), "Z": (-500, 100)}),
        (REAL / "pocketnc_v2revR.linuxcnc.ini", "B,A", "BA", {"A": (-26, 136), "B": (-10000, 10000), "Z": (-87.6554, 2.5654)}),
        (REAL / "pocketnc_v1revH.linuxcnc.ini", "B,A", "BA", {"A": (-5, 95), "X": (-44.45, 64.77)}),
        (REAL / "carvera_4axis.fusion.mch", "", "A", {"A": None, "Y": None}),
        (REAL / "carvera_4axis.fusion.kinematics_only.json", "", "A", {"A": None, "Z": None}),
    ],
)  # fmt: skip
def test_real_machines_are_understood(path, added, order, expected):
    machine = read_machine(path, added)
    assert "".join(axis.name for axis in machine.rotary) == order
    assert expected.items() <= limits(machine).items()
    unlimited = [axis.name for axis in machine.axes if axis.limits is None]
    said = [note for note in machine.notes if note.startswith("no limits in the file for")]
    assert said == ([f"no limits in the file for {', '.join(unlimited)}: taken as unlimited"] if unlimited else [])


@pytest.mark.parametrize(
    ("path", "why"),
    [
        (REAL / "linuxcnc_xyzab-tdr.ini", "kinematics 'xyzab_tdr_kins' are none of those that are read"),
        (REAL / "linuxcnc_max5_base.inc", "names no kinematics"),
        (REAL / "linuxcnc_max5kins.ini", "max5_base.inc, which line 1 includes: cannot be read"),
        (REAL / "pocketnc_v2revR.linuxcnc.ini", "FILE#B,A"),
        (REAL / "freecad_Dah_Lih_MCV_510.fcm.excerpt.json", "axis A runs along the tool"),
    ],
)
def test_real_files_that_leave_it_open_are_refused_with_the_reason(path, why):
    with pytest.raises(MachineError, match=why):
        read_machine(path)


@pytest.mark.parametrize("path", [REAL / "linuxcnc_max5kins.ini"])
def test_a_real_configuration_is_read_with_what_it_includes(path, tmp_path):
    write(tmp_path, "max5_base.inc", (REAL / "linuxcnc_max5_base.inc").read_text())
    machine = read_machine(write(tmp_path, "max5.ini", path.read_text()))
    assert [(axis.name, axis.carries) for axis in machine.rotary] == [("C", "part"), ("B", "tool")]
    assert limits(machine)["B"] == (-90, 90)
    assert limits(machine)["C"] == (-3600, 3600)


# LinuxCNC against the formulas of its kinematics


def turn(axis, angle):
    return moved((0, 0, 0), axis, angle)[:3, :3]


def trt_ac(j, a, c, p):
    """Place of the tool's tip in the part: xyzac-trt-kins, forward."""
    y, z = j[1] - p["dy"] - p["y"], j[2] - p["dz"] - p["z"]
    u, v = j[0] - p["x"], math.cos(a) * y + math.sin(a) * z + p["dy"]
    w = -math.sin(a) * y + math.cos(a) * z + p["dz"] + p["z"]
    return [math.cos(c) * u + math.sin(c) * v + p["x"], -math.sin(c) * u + math.cos(c) * v + p["y"], w]


def trt_bc(j, b, c, p):
    """The same: xyzbc-trt-kins."""
    x, z = j[0] - p["dx"] - p["x"], j[2] - p["dz"] - p["z"]
    u, v = math.cos(b) * x - math.sin(b) * z + p["dx"], j[1] - p["y"]
    w = math.sin(b) * x + math.cos(b) * z + p["dz"] + p["z"]
    return [math.cos(c) * u + math.sin(c) * v + p["x"], -math.sin(c) * u + math.cos(c) * v + p["y"], w]


PINS = {"x": 3.0, "y": -4.0, "z": 5.0}


@pytest.mark.parametrize("conventional", [0, 1])
@pytest.mark.parametrize(("name", "tilt", "forward"), [("xyzac-trt-kins", "A", trt_ac), ("xyzbc-trt-kins", "B", trt_bc)])
def test_trunnions_of_linuxcnc_move_as_their_formulas_say(name, tilt, forward, conventional, tmp_path):
    side, pins = ("y", {**PINS, "dy": 20.0, "dz": 10.0}) if tilt == "A" else ("x", {**PINS, "dx": -20.0, "dz": 10.0})
    lines = [
        "[HAL]", *(f"HALCMD = setp {name}.{each}-rot-point {PINS[each]}" for each in "xyz"),
        f"HALCMD = net :off {name}.{side}-offset gui.off", f"HALCMD = sets :off {pins['d' + side]}",
        f"HALCMD = setp {name}.z-offset 10", f"HALCMD = setp {name}.conventional_directions {conventional}",
    ]  # fmt: skip
    machine = read_machine(write(tmp_path, "mill.ini", ini(name, f"XYZ{tilt}C", *lines)))
    sign = 1.0 if not conventional else -1.0
    joints = (7.0, -11.0, 13.0)
    for t, c in ANGLES:
        at = {"X": joints[0], "Y": joints[1], "Z": joints[2], tilt: t, "C": c}
        pose = tool_in_part(machine, at)
        # The formulas count against ISO 841, unless told.
        assert pose[:3, 3] == pytest.approx(forward(joints, sign * t, sign * c, pins), abs=1e-9)
        up = np.subtract(forward(np.add(joints, Z), sign * t, sign * c, pins), forward(joints, sign * t, sign * c, pins))
        assert pose[:3, 2] == pytest.approx(up, abs=1e-9)
        assert held_by(machine, (c, t)) == pytest.approx(up, abs=1e-12)


def test_a_trunnion_that_counts_as_iso_841_has_the_places_that_its_users_computed(tmp_path):
    # Expected joints for places in the part, from LinuxCNC's issue 2435: a table turns clockwise for positive angles.
    lines = ("[HAL]", "HALCMD = setp xyzbc-trt-kins.conventional-directions TRUE")
    machine = read_machine(write(tmp_path, "mill.ini", ini("xyzbc-trt-kins", "XYZBC", *lines)))
    for angles, joints in (((90, 0), (-2, 0, 1)), ((0, 90), (0, -1, 2)), ((0, 0), (1, 0, 2))):
        at = dict(zip("XYZ", joints, strict=True)) | {"B": math.radians(angles[0]), "C": math.radians(angles[1])}
        assert tool_in_part(machine, at)[:3, 3] == pytest.approx((1, 0, 2), abs=1e-12)


def test_the_bridge_mill_of_linuxcnc_moves_as_its_formulas_say(tmp_path):
    machine = read_machine(write(tmp_path, "mill.ini", ini("5axiskins", "XYZBCW")))
    assert any("W" in note for note in machine.notes)
    for b, c in ANGLES:
        # Tip relative to the pivot, 250 over it: a vector at 180 deg - b from Z, in the direction c.
        reach = 250.0 * np.array(
            [math.sin(math.pi - b) * math.cos(c), math.sin(math.pi - b) * math.sin(c), math.cos(math.pi - b)]
        )
        pose = tool_in_part(machine, {"X": 1.0, "Y": 2.0, "Z": 3.0, "B": b, "C": c})
        assert pose[:3, 3] == pytest.approx(np.array([1, 2, 3 + 250.0]) + reach, abs=1e-9)
        assert held_by(machine, (c, b)) == pytest.approx(-reach / 250.0, abs=1e-12)


@pytest.mark.parametrize("conventional", [0, 1])
def test_the_tilting_head_of_maxkins_moves_as_its_formulas_say(conventional, tmp_path):
    write(
        tmp_path,
        "mill.hal",
        f"setp maxkins.pivot-length [MAX]LENGTH # of the head\nsetp maxkins.conventional-directions {conventional}",
    )
    text = ini("maxkins", "XYZBC", "[MAX]", "LENGTH = 40", "[HAL]", "HALFILE = mill.hal", "HALFILE = LIB:basic_sim.tcl")
    machine = read_machine(write(tmp_path, "mill.ini", text))
    sign = 1.0 if conventional else -1.0
    for b, c in ANGLES:
        x, y, z = 5.0 - sign * 40.0 * math.sin(b), 6.0, 7.0 - 40.0 * math.cos(b) + 40.0
        place = [math.cos(c) * x - math.sin(c) * y, math.sin(c) * x + math.cos(c) * y, z]
        pose = tool_in_part(machine, {"X": 5.0, "Y": 6.0, "Z": 7.0, "B": b, "C": c})
        assert pose[:3, 3] == pytest.approx(place, abs=1e-9)
        assert held_by(machine, (c, b)) == pytest.approx(turn(Z, c) @ [sign * math.sin(b), 0.0, math.cos(b)], abs=1e-12)


def test_kinematics_that_say_nothing_turn_by_their_names_once_their_order_is_said(tmp_path):
    path = write(tmp_path, "mill.ini", ini("trivkins", "XYZAB", units="inch", limits=(-10, 100)))
    machine = read_machine(path, "B,A")
    assert limits(machine) == {"B": (-10, 100), "A": (-10, 100), "X": (-254, 2540), "Y": (-254, 2540), "Z": (-254, 2540)}
    for b, a in ANGLES:
        assert held_by(machine, (b, a)) == pytest.approx(turn(Y, b) @ turn(X, a) @ Z, abs=1e-12)
        assert held_by(read_machine(path, "A/B"), (a, b)) == pytest.approx(turn(X, a) @ turn(Y, b) @ Z, abs=1e-12)
        assert held_by(read_machine(path, "B,A,table"), (b, a)) == pytest.approx(turn(Y, -b) @ turn(X, -a) @ Z, abs=1e-12)


def test_joints_narrow_what_an_axis_may_and_the_note_says_so(tmp_path):
    lines = ("[JOINT_3]", "TYPE = ANGULAR", "MIN_LIMIT = -30 # deg", "MAX_LIMIT = 70", "MAX_VELOCITY = 20")
    machine = read_machine(write(tmp_path, "mill.ini", ini("trivkins coordinates=XYZA", "XYZA", *lines, limits=(-50, 50))))
    assert limits(machine)["A"] == (-30, 50)
    assert machine.rotary[0].rate == math.radians(20)
    assert any(note.startswith("A: the limits of the axis and of its joints differ") for note in machine.notes)


# FreeCAD against what its solver asks of the angles


def test_a_freecad_trunnion_brings_the_tool_axis_up_as_its_solver_does(tmp_path):
    axes = {"C": fcm_axis("table_rotary", Z, -360, 360), "A": fcm_axis("table_rotary", X, -30, 120, parent="C"),
            "X": fcm_axis("table_linear", X, 0, 510)}  # fmt: skip
    machine = read_machine(write(tmp_path, "mill.fcm", fcm(**axes)))
    assert limits(machine) == {"C": (-360, 360), "A": (-30, 120), "X": (0, 510)}
    assert machine.axes[0].point == (1.0, 2.0, 3.0)
    assert machine.rotary[1].rate == pytest.approx(math.radians(10))
    for c, a in ANGLES:
        # The part is turned by C, then by A: the tool axis is what this takes to Z.
        assert turn(X, a) @ turn(Z, c) @ held_by(machine, (c, a)) == pytest.approx(Z, abs=1e-12)


@pytest.mark.parametrize("parents", [("B", None), (None, "C")])
def test_a_freecad_head_is_turned_about_z_by_the_axis_farther_from_the_tool(parents, tmp_path):
    axes = {"C": fcm_axis("head_rotary", Z, parent=parents[0]), "B": fcm_axis("head_rotary", Y, parent=parents[1])}
    machine = read_machine(write(tmp_path, "mill.fcm", fcm("imperial", **axes)))
    assert machine.axes[0].point == pytest.approx((25.4, 50.8, 76.2))
    for c, b in ANGLES:
        assert held_by(machine, (c, b)) == pytest.approx(turn(Z, c) @ turn(Y, b) @ Z, abs=1e-12)


def test_a_freecad_table_and_head_share_the_turns(tmp_path):
    joint = [[0, 0, 0], Z]
    axes = {
        "B": fcm_axis("head_rotary", Y),
        "C": fcm_axis("table_rotary", Z, joint=joint, type="angular"),
        "L": {"type": "laser"},
    }
    machine = read_machine(write(tmp_path, "mill.fcm", fcm(**axes)))
    assert any(note.startswith("L is of type 'laser'") for note in machine.notes)
    for c, b in ANGLES:
        assert turn(Z, c) @ held_by(machine, (c, b)) == pytest.approx(turn(Y, b) @ Z, abs=1e-12)


def test_a_freecad_pair_about_x_and_y_needs_an_order(tmp_path):
    path = write(tmp_path, "mill.fcm", fcm(A=fcm_axis("table_rotary", X), B=fcm_axis("table_rotary", Y, parent="A")))
    with pytest.raises(MachineError, match=r"contradict each other about their order.*FILE#A,B"):
        read_machine(path)
    assert [axis.name for axis in machine_of(f"{path}#B,A").rotary] == ["B", "A"]


# Fusion against rigid motions of its tree


@pytest.mark.parametrize("added", ["table", "tool-relative"])
def test_a_fusion_tree_moves_as_its_parts_do(added, tmp_path):
    table = mch_axis("Y", [0, -1, 0], mch_axis("A", X, mch_axis("C", Z, TABLE), min=-30, max=120), kind="linear", range=[-3, 4])
    head = mch_axis("X", X, mch_axis("Z", Z, HEAD, kind="linear", range={"min": -1, "max": 2}), kind="linear")
    machine = read_machine(write(tmp_path, "mill.mch", mch(table, head, units={"length": "in", "angle": "degrees"})), added)
    assert limits(machine) == {"C": None, "A": (-30, 120), "Y": (-76.2, 101.6), "X": None, "Z": (-25.4, 50.8)}
    sense = 1.0 if added == "table" else -1.0
    point = 25.4 * np.array([1, 2, 3])
    for c, a in ANGLES:
        part = shifted([0, -1, 0], 5.0) @ moved(point, X, sense * a) @ moved(point, Z, sense * c)
        tool = shifted(X, 7.0) @ shifted(Z, 9.0)
        pose = tool_in_part(machine, {"X": 7.0, "Y": 5.0, "Z": 9.0, "A": a, "C": c})
        assert pose == pytest.approx(np.linalg.inv(part) @ tool, abs=1e-9)
        assert held_by(machine, (c, a)) == pytest.approx(pose[:3, 2], abs=1e-12)


def test_a_fusion_head_needs_no_word_about_its_sense(tmp_path):
    head = mch_axis("C", Z, mch_axis("B", Y, HEAD, min=-20, max=100))
    machine = read_machine(write(tmp_path, "mill.mch", mch(TABLE, head)))
    for c, b in ANGLES:
        assert held_by(machine, (c, b)) == pytest.approx(turn(Z, c) @ turn(Y, b) @ Z, abs=1e-12)


def test_a_fusion_table_with_uneven_limits_is_asked_about(tmp_path):
    uneven = mch(mch_axis("A", X, TABLE, min=-30, max=120), HEAD)
    with pytest.raises(MachineError, match="FILE#table, or FILE#tool-relative"):
        read_machine(write(tmp_path, "mill.mch", uneven))
    even = mch(mch_axis("A", X, TABLE, min=-30, max=30), HEAD)
    path = write(tmp_path, "even.mch", even)
    sphere = np.random.default_rng(1).normal(size=(500, 3))
    sphere[:, 0] = 0.0
    sphere /= np.linalg.norm(sphere, axis=1)[:, None]
    both = [read_machine(path, word).kinematics(np.eye(3)).allows(sphere) for word in ("", "table", "tool-relative")]
    assert both[0].any()
    assert not both[0].all()
    assert (both[0] == both[1]).all()
    assert (both[0] == both[2]).all()


# Our own format

NUMBERS = st.floats(-1e6, 1e6)
VECTORS = st.tuples(NUMBERS, NUMBERS, NUMBERS).filter(lambda v: math.hypot(*v) > 1e-3)
TEXTS = st.text(st.characters(codec="utf-8"), max_size=20)


@st.composite
def axes(draw):
    names = draw(st.lists(TEXTS.filter(str.strip), unique=True, max_size=5))
    turning, found = 0, []
    for name in names:
        kind = draw(st.sampled_from(["rotary", "linear"] if turning < 2 else ["linear"]))
        turning += kind == "rotary"
        ends = draw(st.none() | st.tuples(st.floats(-1e4, 0.0) | st.just(-math.inf), st.floats(0.0, 1e4) | st.just(math.inf)))
        rate = draw(st.none() | st.floats(1e-3, 1e5))
        point = draw(st.tuples(NUMBERS, NUMBERS, NUMBERS)) if kind == "rotary" else (0.0, 0.0, 0.0)
        accuracy = draw(st.none() | st.floats(0.0, 0.017)) if kind == "rotary" else None
        found.append(Axis(name, kind, draw(st.sampled_from(["part", "tool"])), draw(VECTORS), ends, point, rate, accuracy))
    return tuple(sorted(found, key=lambda axis: axis.carries))


@st.composite
def machines(draw):
    listed, tilt = draw(axes()), draw(st.none() | st.floats(0.0, math.pi))
    tool = draw(VECTORS)
    with contextlib.suppress(MachineError):
        return Machine(draw(TEXTS), tilt, listed, tool, tuple(draw(st.lists(TEXTS, max_size=2))), draw(st.booleans()))
    # Parallel axes, or one along the tool, are no machine.
    return Machine(draw(TEXTS), tilt, tuple(axis for axis in listed if axis.kind == "linear"), tool)


@settings(max_examples=150, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(machine=machines())
def test_what_is_written_is_read_as_the_same_machine(machine, tmp_path):
    assert read_machine(write(tmp_path, "mill.toml", to_toml(machine))) == machine
    assert read_machine(write(tmp_path, "mill.json", plain(machine))) == machine


@pytest.mark.parametrize("name", builtin_machines())
def test_built_in_machines_survive_their_file(name, tmp_path):
    assert read_machine(write(tmp_path, "mill.toml", to_toml(machine_of(name)))) == machine_of(name)


def test_chains_run_from_the_bed_outward_and_units_count(tmp_path):
    linear = {"axis": "Z", "type": "linear", "direction": Z, "limits": [-1, None], "rate": 2}
    given = own([rotary("A", X, [-10, 20], point=[1, 0, 0]), rotary("C", Z)], [linear], units={"length": "inch", "angle": "deg"})
    machine = read_machine(write(tmp_path, "mill.json", given))
    assert [axis.name for axis in machine.axes] == ["C", "A", "Z"]
    assert machine.axes[1].point == (25.4, 0.0, 0.0)
    assert limits(machine) == {"C": None, "A": (-10, 20), "Z": (-25.4, math.inf)}
    assert machine.axes[2].rate == 50.8
    turned = own([rotary("A", X, [-1.0, "0.25 rad"])], units={"length": "mm", "angle": "rad"}, max_tool={"length": 90})
    machine = read_machine(write(tmp_path, "turned.json", turned))
    assert machine.axes[0].limits == (-1.0, 0.25)
    assert machine.notes == ("its largest tool, length 90 mm, is not judged",)


def test_a_table_counted_by_itself_is_the_tool_counted_backwards(tmp_path):
    chains = ([rotary("A", X, [-30, 120]), rotary("C", Z, [-90, 10])], [])
    table = read_machine(write(tmp_path, "table.json", own(*chains, sign="table")))
    tool = read_machine(write(tmp_path, "tool.json", own(*chains)))
    for c, a in ANGLES:
        assert held_by(table, (c, a)) == pytest.approx(held_by(tool, (-c, -a)), abs=1e-15)
        part = turn(X, a) @ turn(Z, c)
        assert part @ held_by(table, (c, a)) == pytest.approx(Z, abs=1e-12)


def test_the_worst_rotary_axis_of_the_machine_gives_the_accuracy_unless_one_is_requested(tmp_path):
    file = write(tmp_path, "worn.json", own([rotary("A", X, accuracy=0.02), rotary("C", Z, accuracy=0.1)]))
    assert Options(machine=file).accuracy == math.radians(0.1)
    assert Options(machine=file, axis_accuracy_deg=0.01).accuracy == math.radians(0.01)
    assert Options(machine="trunnion-ac").accuracy == math.radians(0.05)


def test_the_sample_of_the_documentation_is_read(tmp_path):
    page = (ROOT / "docs" / "machines.md").read_text()
    sample = page.partition("```toml\n")[2].partition("```")[0]
    machine = read_machine(write(tmp_path, "mill.toml", sample))
    assert limits(machine) == {"C": None, "A": (-30, 120), "Z": (-300, 0)}
    assert machine.rotary[1].rate == math.radians(25)


# Bad input

AC = [rotary("A", X), rotary("C", Z)]
NESTED = "[" * 3000 + "]" * 3000
BAD = [
    ("empty.toml", "", "is empty"),
    ("page.mch", "<!DOCTYPE html><html><body>log in</body></html>", "web page"),
    ("page.xml", "<html><p>MTConnectDevices</p></html>", "web page"),
    ("arm.urdf", '<?xml version="1.0"?><robot name="arm"><link name="a"/></robot>', "robot .URDF."),
    ("binary.mch", bytes(range(256)) * 40, "binary file"),
    ("shop.json", {"data": [{"type": "flat end mill"}]}, "Fusion tool library"),
    ("list.json", [1, 2], "is JSON, but no machine"),
    ("broken.mch", '{"kinematics": {', "looks like JSON"),
    ("deep.json", '{"part_chain": ' + NESTED + "}", "nested too deeply|looks like JSON|is a value of type list"),
    ("other.xml", "<a><b/></a>", "is XML, but no machine file that is known; write the machine as TOML"),
    ("words.txt", "hello", "no machine file that is known"),
    ("mill.hal", "setp a.b 1\n", "LinuxCNC HAL file"),
    ("bomb.xml", '<!DOCTYPE a [<!ENTITY b "c">]><MTConnectDevices>&b;</MTConnectDevices>', "is MTConnect data, which"),
    ("probe.xml", "<MTConnectDevices><Devices>", "write the machine as TOML .docs/machines.md., ten lines do"),
    # Our own format
    ("units.json", {k: v for k, v in own(AC).items() if k != "units"}, "units is missing, as units"),
    ("length.json", own(AC, units={"angle": "deg"}), "units: length is missing"),
    ("foot.json", own(AC, units={"length": "ft", "angle": "deg"}), "length is 'ft'"),
    ("sign.json", {k: v for k, v in own(AC).items() if k != "sign"}, "sign is missing"),
    ("more.json", own(AC, speed=3), "'speed' is unknown"),
    ("axis.json", own([rotary("A", X, colour="red")]), "part_chain 1: 'colour' is unknown"),
    ("nan.toml", to_toml(machine_of("trunnion-ac")).replace("120.0", "nan"), "largest limit must be a number, not nan"),
    ("nan.json", json.dumps(own(AC)).replace("[1, 0, 0]", "[NaN, 0, 0]"), "direction: 1 is nan"),
    ("down.json", own([rotary("A", X, [20, -10])]), "axis A: its limits .* must run upwards"),
    ("inf.toml", to_toml(machine_of("trunnion-ac")).replace("-30.0", "inf"), "must run upwards"),
    ("parallel.json", own([rotary("A", X), rotary("B", [2, 0, 0])]), "A.* are parallel"),
    ("along.json", own([rotary("A", X)], [rotary("C", Z)]), "C lies along the tool"),
    ("three.json", own([*AC, rotary("B", Y)]), "3 rotary axes"),
    ("twice.json", own([rotary("A", X), rotary("A", Y)]), "two of its axes have one name"),
    ("zero.json", own([rotary("A", [0, 0, 0])]), "not all zero"),
    ("text.json", own([rotary("A", X, ["20 deg", 30])]), "least limit is '20 deg'"),
    ("accuracy.json", own([rotary("A", X, accuracy=1.5)]), "accuracy is an angle of a rotary axis, from 0 to 1 deg"),
    ("minus.json", own([rotary("A", X, accuracy=-0.1)]), "accuracy is an angle"),
    ("rate.json", own([rotary("A", X, rate=-1)]), "rate must be positive"),
    ("version.json", own(AC, version=2), "version is 2"),
    ("half.toml", 'format = "plan-cutters-machine"\nname = ', "is no TOML"),
    # FreeCAD
    ("circle.fcm", fcm(A=fcm_axis("table_rotary", X, parent="C"), C=fcm_axis("table_rotary", Z, parent="A")), "is a circle"),
    ("lost.fcm", fcm(A=fcm_axis("table_rotary", X, parent="Q")), "its chain is broken"),
    ("down.fcm", fcm(A=fcm_axis("table_rotary", X, 10, -10)), "must run upwards"),
    ("role.fcm", fcm(A={**fcm_axis("table_rotary", X), "role": "arm"}), "its role 'arm'"),
    ("unit.fcm", fcm("ells", A=fcm_axis("table_rotary", X)), "units 'ells' is not known"),
    ("none.fcm", {"machine": {"axes": {"X": fcm_axis("table_linear", X)}}}, "units is missing"),
    ("nan.fcm", json.dumps(fcm(A=fcm_axis("table_rotary", X, math.nan))), "must be a number, not nan"),
    ("joint.fcm", fcm(A=fcm_axis("table_rotary", X, joint={"origin": X})), "joint has no axis"),
    ("lathe.fcm", fcm(A=fcm_axis("table_rotary", X), B=fcm_axis("table_rotary", Y), C=fcm_axis("table_rotary", Z)), "3 rotary"),
    ("said.fcm#C,A", fcm(C=fcm_axis("table_rotary", Z), A=fcm_axis("table_rotary", X)), "leave out #C,A"),
    # Fusion
    ("unit.mch", mch(TABLE, HEAD, units={"length": "mm"}), "unit of angles is missing"),
    ("headless.mch", mch(TABLE), "no part of type head"),
    ("heads.mch", mch(TABLE, HEAD, {**HEAD, "id": "second"}), "2 parts of type head"),
    ("limit.mch", mch(mch_axis("A", X, TABLE, travel_limit=[0, 3]), HEAD), "'travel_limit' is not understood"),
    ("down.mch", mch(mch_axis("A", X, TABLE, min=3, max=-3), HEAD), "must run upwards"),
    ("both.mch", mch(mch_axis("A", X, TABLE, HEAD)), "carries both"),
    ("axisless.mch", mch({"id": "A", "name": "A", "type": "rotary", "parts": [TABLE]}, HEAD), "no axis_of_rotation"),
    ("back.mch#table",
     mch(mch_axis("A", X, TABLE, min=-5, max=9), HEAD, controller={"parts": {"A": {"reversed": True}}}), "reversed"),
    # LinuxCNC
    ("kins.ini", ini("pumakins", "XYZABC"), "kinematics 'pumakins' are none"),
    ("unit.ini", ini("trivkins", "XYZ", units=""), "LINEAR_UNITS is missing"),
    ("down.ini", ini("trivkins", "XYZA", limits=(5, -5)), "must run upwards"),
    ("nan.ini", ini("trivkins", "XYZA", limits=("nan", 5)), "MIN_LIMIT is 'nan', which is no number"),
    ("word.ini", ini("trivkins", "XYZA", limits=("1 2", 5)), "which is no number"),
    ("three.ini#A,B,C", ini("trivkins", "XYZABC"), "3 rotary axes"),
    ("third.ini", ini("xyzac-trt-kins", "XYZABC"), "a third rotary axis, B"),
    ("lack.ini", ini("xyzac-trt-kins", "XYZA"), "lacks C"),
    ("fed.ini", ini("maxkins", "XYZBC", "[HAL]", "HALCMD = net s maxkins.conventional-directions p.q", limits=(-9, 8)),
     "something else feeds it"),
    ("hal.ini", ini("maxkins", "XYZBC", "[HAL]", "HALFILE = lost.hal", limits=(-9, 8)), "lost.hal is not at hand"),
    ("twice.ini", ini("trivkins", "XYZ", "[AXIS_X]", "MIN_LIMIT = 3"), "given as '-500' and as '3'"),
    ("self.ini", "#INCLUDE self.ini\n" + ini("trivkins", "XYZ"), "it includes itself"),
    ("joint.ini", ini("trivkins", "XYZA", "[JOINT_3]", "TYPE = LINEAR"), "JOINT_3. is 'LINEAR', but joint 3 is A"),
    ("lost.ini", ini("trivkins", "XYZC", "[JOINT_3]", "MIN_LIMIT = -9"), "which axis .JOINT_3. is of is not known"),
    ("old.ini", ini("5axiskins", "XYZBC", "[AXIS_3]", "MIN_LIMIT = -9"), "which axis .AXIS_3. is of is not known"),
    ("apart.ini", ini("trivkins", "XYZA", "[JOINT_3]", "MIN_LIMIT = 600"), "contradict each other"),
    ("order.ini#A,C", ini("trivkins", "XYZAB"), "its rotary axes are A, B"),
    ("known.ini#C,A", ini("xyzac-trt-kins", "XYZAC"), "leave out #C,A"),
    ("nothing.ini#", ini("trivkins", "XYZA"), "says nothing of a machine"),
]  # fmt: skip


@pytest.mark.parametrize(("name", "content", "why"), BAD, ids=[row[0] for row in BAD])
def test_bad_machine_files_are_one_line(name, content, why, tmp_path, capsys):
    file, mark, added = name.partition("#")
    path = write(tmp_path, file, content)
    with pytest.raises(MachineError, match=why) as caught:
        machine_of(f"{path}{mark}{added}")
    assert "\n" not in str(caught.value)
    assert str(caught.value).startswith(file if mark != "#" or added else "'#") or "#" in str(caught.value)
    with pytest.raises(SystemExit) as ended:
        begin("plan-cutters machines", [f"{path}{mark}{added}"])
    assert ended.value.code == 2
    told = capsys.readouterr()
    assert told.err.count("\n") == 1
    assert told.err.startswith("plan-cutters machines: ")


def test_what_is_no_file_is_one_line(tmp_path):
    for path, why in ((tmp_path, "is a folder"), (tmp_path / "none.ini", "No such file"), ("/dev/null", "no regular file")):
        with pytest.raises(MachineError, match=why):
            machine_of(str(path))
    with pytest.raises(MachineError, match="'mill' is not known"):
        machine_of("mill")
    with pytest.raises(MachineError, match="is no machine"):
        machine_of(3)
    with (tmp_path / "huge.mch").open("wb") as file:
        file.truncate((32 << 20) + 1)
    with pytest.raises(MachineError, match="larger than 32 MB: no machine file is"):
        read_machine(tmp_path / "huge.mch")


SEEDS = [
    json.dumps(own(AC)), json.dumps(fcm(A=fcm_axis("table_rotary", X))), json.dumps(mch(mch_axis("A", X, TABLE), HEAD)),
    ini("xyzac-trt-kins", "XYZAC", "[JOINT_3]", "TYPE = ANGULAR"), to_toml(machine_of("trunnion-ac")),
]  # fmt: skip


@settings(max_examples=300, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(seed=st.sampled_from(SEEDS), data=st.data())
def test_spoilt_files_are_machines_or_one_line(seed, data, tmp_path):
    raw = bytearray(seed.encode())
    for _ in range(data.draw(st.integers(1, 4))):
        at = data.draw(st.integers(0, len(raw)))
        raw[at : at + data.draw(st.integers(0, 12))] = data.draw(
            st.binary(max_size=3) | st.sampled_from([b"null", b"[]", b"{}", b"1e999", b"-1", b'"a"', b"nan", b"true"])
        )
    path = write(tmp_path, "spoilt", bytes(raw))
    with contextlib.suppress(MachineError):
        assert isinstance(read_machine(path), Machine)
        return
    with pytest.raises(MachineError) as caught:
        read_machine(path)
    told = str(caught.value)
    assert told.startswith("spoilt: ")
    assert "\n" not in told


# Words and numbers about a machine


def test_names_and_limits_are_machines_too():
    assert machine_of("trunnion-bc") == builtin_machines()["trunnion-bc"]
    assert machine_of("tilt:30").tilt_limit == pytest.approx(math.radians(30))
    assert machine_of(None) == machine_of("unlimited") == Machine()
    assert machine_of(Machine("mine")).name == "mine"


@pytest.mark.parametrize(
    ("name", "share_held"),
    [
        ("unlimited", 1.0), ("tilt:60", 0.25), ("tilt:0", 0.0), ("3-axis", 0.0),
        ("trunnion-ac", (1 - math.cos(math.radians(120))) / 2), ("trunnion-bc", (1 - math.cos(math.radians(110))) / 2),
        ("head-table-bc", (1 - math.cos(math.radians(100))) / 2), ("nutating-bc", 0.5),
    ],
)  # fmt: skip
def test_shares_of_directions_are_those_of_caps(name, share_held):
    assert share(machine_of(name)).held == pytest.approx(share_held, abs=2e-4)


def test_the_singular_cone_has_its_share():
    # Two caps of 2 deg of the sphere; a trunnion of 120 deg reaches one of them.
    assert share(machine_of("trunnion-ac")).singular == pytest.approx((1 - math.cos(math.radians(2))) / 2, abs=1e-4)


@pytest.mark.parametrize("name", ["trunnion-ac", "head-table-bc", "nutating-bc", "head-head-ca"])
def test_solutions_hold_the_axis_that_was_asked_for(name):
    machine = machine_of(name)
    asked = np.array([0.3, -0.4, 0.8])
    found = solutions(machine, asked)
    assert found[0].taken
    for each in found:
        axis, beyond = tool_axis(machine, each.angles)
        assert axis == pytest.approx(asked / np.linalg.norm(asked), abs=1e-12)
        assert not beyond
        assert tool_in_part(machine, each.angles)[:3, 2] == pytest.approx(axis, abs=1e-12)


def run(*words):
    with pytest.raises(SystemExit) as ended:
        begin("plan-cutters machines", [str(word) for word in words])
    return ended.value.code


def test_the_command_lists_and_explains(capsys, tmp_path):
    assert run() == 0
    told = capsys.readouterr().out
    assert all(name in told for name in builtin_machines())
    path = write(tmp_path, "mill.ini", ini("trivkins", "XYZAB"))
    assert run(f"{path}#B,A", "--axis", "A=30,B=600", "--angles", "0,-1,1") == 0
    told = capsys.readouterr().out
    assert "LinuxCNC configuration" in told
    assert "beyond the limits: B" in told
    assert "A 45° (taken" in told
    assert "note: its angles are taken" in told
    assert run("trunnion-ac", "--angles", "0,0,-1") == 0
    assert "No position within the limits" in capsys.readouterr().out


def test_the_command_writes_what_it_reads(capsys, tmp_path):
    out = tmp_path / "out.toml"
    assert run("nutating-bc", "--json", "--to-toml", out, "--angles", "0,1,0") == 0
    told = json.loads(capsys.readouterr().out)["machines"][0]
    assert read_machine(out) == machine_of("nutating-bc")
    assert read_machine(write(tmp_path, "out.json", told["machine"])) == machine_of("nutating-bc")
    assert told["singular_cone_deg"] == pytest.approx(2.0)
    assert [abs(each["deg"]["B"]) for each in told["angles"]["solutions"]] == pytest.approx([180.0, 180.0], abs=1e-5)


@pytest.mark.parametrize(
    ("words", "why"),
    [
        (("--axis", "A=1"), "which machine"), (("3-axis", "4-axis-a", "--to-toml", "x"), "writes one machine"),
        (("trunnion-ac", "--axis", "A"), "angles are given in degrees"), (("trunnion-ac", "--axis", "Q=1"), "no rotary axis 'Q'"),
        (("trunnion-ac", "--angles", "0,0"), "three numbers"), (("trunnion-ac", "--angles", "0,0,0"), "not all zero"),
        (("tilt:30", "--angles", "0,0,1"), "no rotary axes"), (("--no-such",), "No such option"),
    ],
)  # fmt: skip
def test_what_the_command_cannot_do_is_one_line(words, why, capsys):
    assert run(*words) == 2
    told = capsys.readouterr().err
    assert why in told
    assert told.count("\n") == 1


def test_a_file_that_cannot_be_written_is_one_line(capsys, tmp_path):
    assert run("3-axis", "--to-toml", tmp_path / "none" / "x.toml") == 2
    assert "cannot be written" in capsys.readouterr().err
