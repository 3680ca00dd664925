"""Stored answers are answers to the same question: for each option they equal a fresh plan, or they are refused by its name."""

import json
import math
from dataclasses import fields, replace
from pathlib import Path

import click
import numpy as np
import pytest

from plan_cutters import Cutter, Options, PostureMaps, plan, posture_map
from plan_cutters.command import stored_maps
from plan_cutters.command.cli import command
from plan_cutters.command.codes import guarded, invoked
from plan_cutters.domain.placement import Placement
from plan_cutters.domain.verdicts import INACCESSIBLE, UNDECIDED, WORDS
from plan_cutters.errors import OptionError
from plan_cutters.library.read import read_library
from plan_cutters.scene import question
from tests.support.places import SAMPLES
from tests.support.schemas import valid

PART = str(SAMPLES / "pocket_top.step")
CUTTER = "R4L40"
BASE = {"cutters": CUTTER, "grid": 7, "area_budget": 0, "fixtures": "box:5,5,5@0,0,60"}
#: By option: values that a plan could be requested; None: it is refused by name, else it is answered.
CASES = {
    "cutters": [("R3L40", "cutter R4L40, which was not requested"), ("R4L40", None), (["R1L9", "R4L40"], None)],
    "libraries": [("library", "cutter R4L40, which was not requested")],
    "holder": [("R15L30", "another holder")],
    "allowance": [(0.2, "allowance 0, not 0.2"), (0.0, None)],
    "holder_clearance": [(0.5, "holder clearance 0, not 0.5")],
    "machine": [("tilt:25", None), ("trunnion-ac", None), ("nutating-bc", None), ("3-axis", "3-axis")],
    "setup": [((1, 0.3, 0.2), None), ((0, 0, -1), None), ("auto", "setup auto")],
    "propose": [(True, "setup auto")],
    "other_setups": [([(1, 0, 0)], "a second --setup")],
    "other_placements": [([None], "--other-placements")],
    "faces": [("F2", "faces sculptured,blends, not F2"), ("sculptured,blends", None), ("F1", None)],
    "ignore": [("F1", "ignore none, not F1"), ((), None)],
    "grid": [(9, "grid 7, not 9"), (7, None)],
    "spacing": [(4.0, "spacing by default, not 4")],
    "tilt": [((0.2, 0.8), None), ((0.0, 0.5), None), ((0.0, 2.0), "tilts 0:90 deg")],
    "rotation": [((0.0, math.pi / 3), None), ((0.1, 1.0), "no rotation of")],
    "rotation_step": [(math.radians(30), None), (math.radians(7), "no rotation of")],
    "tolerance": [(0.02, "tolerance 0.01, not 0.02"), (0.01, None)],
    "jobs": [(1, None)],
    "flip": [(True, "flip False, not True"), (False, None)],
    "area_budget": [(10, None)],
    "posture_maps": [(True, "--posture-maps")],
    "map_budget": [(10, "--map-budget")],
    "answers": [("mend", "--answers")],
    "length_over_radius": [(5.0, None)],
    "operations": [("fewest", "--operations")],
    "feed": [(2000.0, None)],
    "scallop": [(0.02, None)],
    "stepover": [(0.5, None)],
    "index_step": [(0.1, None)],
    "axis_accuracy": [(0.001, None)],
    "index_time": [(1.0, None)],
    "change_time": [(1.0, None)],
    "setup_time": [(1.0, None)],
    "overlap": [(1.0, None)],
    "most_operations": [(3, None)],
    "sharp_edges": [("left", None)],
    "max_orientations": [(3, None)],
    "patterns": [(False, None)],
    "process": [({"step": [{"cutter": "R1L20F6N0.95x9S3HR10.5L60", "mode": "simultaneous"}]}, "--process")],
    "units": [("in", None)],
    "unit": [("in", "unit as stated, not in")],
    "fixtures": [("box:200,200,200@-50,-50,-50", "other fixtures"), ("box:5,5,5@0,0,60", None), ((), "other fixtures")],
    "placement": [
        (Placement((0, 0, 1), (0.3, 1, 0)), None),
        (Placement((0, 0, 1), clamped=("F1",)), "clamped faces none, not F1"),
    ],
}


@pytest.fixture(scope="module")
def found():
    return plan(PART, posture_maps=True, **BASE)


@pytest.fixture(scope="module")
def file(found, tmp_path_factory):
    out = tmp_path_factory.mktemp("stored")
    found.write(out, ["json", "npz"])
    return out / "postures.npz"


@pytest.fixture(scope="module")
def library(tmp_path_factory):
    path = tmp_path_factory.mktemp("tools") / "shop.toml"
    path.write_text('unit = "mm"\n[[tool]]\ntype = "flat"\nDC = 2\nLCF = 8\nLPR = 12\nDMM = 2\nholder = "none"\n')
    return path


def test_every_option_is_answered_compared_or_of_no_matter_and_the_others_are_refused():
    kinds = question.ANSWERED, question.COMPARED, question.IRRELEVANT
    known = [word for kind in kinds for word in kind]
    assert len(known) == len(set(known))
    beyond = {each.name for each in fields(Options)} - set(known)
    assert all(refused for word in beyond for _, refused in CASES[word])
    assert set(CASES) == {each.name for each in fields(Options)}


@pytest.mark.parametrize(("word", "value", "refused"), [(w, v, r) for w, cases in CASES.items() for v, r in cases])
def test_it_equals_a_fresh_plan_or_is_refused_by_name(found, file, library, word, value, refused):
    maps = PostureMaps.load(file)
    if word == "libraries":
        value = read_library(library)
    asked = {word: value}
    if word == "other_placements":
        asked["other_setups"] = [(0, 0, 1)]
    if word == "placement":
        asked["setup"] = value.z
    if refused:
        with pytest.raises(OptionError, match=r"plan again|leave it out|plan the part|a second") as caught:
            maps.asked(PART, **asked)
        assert refused in str(caught.value)
        return
    stored = maps.asked(PART, **asked)
    fresh = plan(found.part, **(BASE | asked)).reaches[CUTTER]
    reached = stored.reached
    assert not (reached & ~fresh.reached).any()
    assert not ((stored.verdict == INACCESSIBLE) & fresh.reached).any()
    assert not ((stored.verdict == INACCESSIBLE) & (fresh.verdict == UNDECIDED)).any()
    assert (stored.verdict == fresh.verdict)[stored.verdict != UNDECIDED].all()
    assert (stored.verdict != UNDECIDED).mean() > 0.5


def test_what_the_flat_of_the_tip_alone_reaches_is_left_to_a_plan(tmp_path):
    """The edge of a tool as wide as most of a bore touches little of its floor, and only with the tool upright."""
    import cadquery as cq

    cq.exporters.export(cq.Workplane().box(30, 30, 12).faces(">Z").workplane().hole(10, 8), str(tmp_path / "bore.step"))
    asked = {"cutters": ["D8L40F20S8"], "faces": "all", "spacing": 4.5}
    found = plan(tmp_path / "bore.step", posture_maps=True, **asked)
    (key,) = found.reaches
    under = found.reaches[key].reached & (np.linalg.norm(found.reaches[key].tilt_direction, axis=1) < 1.0 - 1e-6)
    assert under.any()
    found.write(tmp_path, ["json", "npz"])
    maps = PostureMaps.load(tmp_path / "postures.npz")
    for machine in ("unlimited", "tilt:20"):
        fresh, stored = plan(found.part, machine=machine, **asked).reaches[key], maps.asked(found.part, machine=machine)
        assert not ((stored.verdict == INACCESSIBLE) & (fresh.reached | (fresh.verdict == UNDECIDED))).any()
        assert not (stored.reached & ~fresh.reached).any()
        assert (stored.verdict[under] == UNDECIDED).all()
    # The map of such a point alone says where it lies under the flat.
    for k in np.flatnonzero(under)[:3].tolist():
        point = posture_map(found.part, point=found.samples.point[k], cutter="D8L40F20S8", rotations_deg=range(0, 360, 10))
        assert 0.0 < np.linalg.norm(point.under_flat) <= 4.0
        assert not np.isfinite(
            posture_map(found.part, point=found.samples.point[k], cutter="D8L40rc4", rotations_deg=[0]).under_flat
        ).any()


def told(*words):
    """What the command says and its exit code, in this process."""
    return guarded(lambda: (invoked(command, "plan-cutters", [str(word) for word in words]), ""), False)


@pytest.mark.parametrize(
    ("words", "name"),
    [
        (["--fixture", "box:200,200,200@-50,-50,-50"], "other fixtures"),
        (["--faces", "F2"], "faces"),
        (["--ignore", "F1"], "ignore"),
        (["--flip"], "flip"),
        (["--unit", "in"], "unit"),
        (["--tolerance", "0.02"], "tolerance 0.01, not 0.02"),
        (["--allowance", "0.2"], "allowance"),
        (["--holder-clearance", "0.2"], "holder clearance"),
        (["--holder", "R15L30"], "another holder"),
        (["--cutter", "R4L40", "--allowance", "0.2"], "allowance"),
        (["--cutter", "R1L9"], "which was not requested"),
        (["--grid", "9"], "grid"),
        (["--spacing", "3"], "spacing"),
        (["--tilt", "0:120"], "tilts 0:90"),
        (["--rotation-step", "7"], "no rotation of 6.9"),
        (["--setup", "0,0,1", "--setup", "1,0,0"], "a second --setup"),
        (["--answers", "mend"], "--answers"),
        (["--posture-maps"], "--posture-maps"),
        (["--formats", "json"], "--formats"),
        (["-o", "out"], "-o"),
        (["--machine", "3-axis"], "3-axis"),
    ],
)
def test_the_command_refuses_by_name(file, words, name, capsys):
    code, line = told(PART, "--postures", file, *words)
    assert (code, "\n" in line) == (2, False)
    assert name in line
    assert "postures.npz" in line or name.startswith("-")


def test_the_command_answers_what_it_can(file, found, capsys):
    for words in ([], ["--tolerance", "0.01"], ["--faces", "sculptured,blends"], ["--cutter", CUTTER], ["--grid", "7"],
                  ["--fixture", "box:5,5,5@0,0,60"], ["--rotation-step", "20"], ["--jobs", "1"]):  # fmt: skip
        code, line = told(PART, "--postures", file, "--json", "-", *words)
        answer = valid("stored", json.loads(capsys.readouterr().out.partition("\n}\n")[0] + "}"))
        assert line == ""
        assert code == (1 if answer["samples"]["inaccessible"] else 4 if answer["samples"]["undecided"] else 0)
        assert sum(answer["samples"].values()) == len(found.samples)


def test_the_subcommand_answers_as_the_option_does(file, tmp_path, capsys):
    """With and without the part; it knows no options about files, and says no defaults that it does not have."""

    def subcommand(*words):
        line = guarded(lambda: (invoked(stored_maps.command, "plan-cutters stored", [str(word) for word in words]), ""), False)
        return *line, "".join(capsys.readouterr())

    for words in ([], ["--machine", "tilt:25"], ["--setup", "1,0.3,0.2", "--jobs", "1"], ["--faces", "F2"], ["--tilt", "0:120"]):
        code, line = told(PART, "--postures", file, *words)
        said = "".join(capsys.readouterr())
        assert subcommand(file, PART, *words) == (code, line, said)
        assert (said == "") == (code == 2)
        alone = said.replace("pocket_top.step:", "postures.npz:", 1)
        alone = [str(each).split() for each in (code, line, alone)]
        assert [str(each).split() for each in subcommand(file, *words)] == alone
    other = tmp_path / "other.step"
    other.write_bytes(Path(PART).read_bytes() + b" ")
    assert subcommand(file, other)[:2] == (
        2,
        "plan-cutters: postures.npz: these maps are of another part than other.step: plan again",
    )
    assert subcommand(tmp_path / "none.npz")[0] == 2
    assert subcommand(file, tmp_path / "none.step")[0] == 3
    assert "No such option" in subcommand(file, "-o", "out")[1]
    assert subcommand("--help")[0] == 0
    assert not any("default" in (each.help or "") for each in stored_maps.command.params if isinstance(each, click.Option))


def kept(file, folder, maps, **more):
    """The file of these maps with other verdicts."""
    from tests.support.array_files import written

    return written(folder / "postures.npz", replace(maps, **more))


def test_exit_codes_are_those_of_a_plan(file, tmp_path, capsys):
    maps = PostureMaps.load(file)
    n = len(maps.verdict)

    def code(verdict, **more):
        value = np.full(n, 2, np.uint8)
        value[0] = verdict
        if verdict == 255:
            more["offset"], more["free"] = np.zeros_like(maps.offset), maps.free[:0]
        return told(PART, "--postures", kept(file, tmp_path, maps, verdict=value, **more), "--quiet")[0]

    by_word = {word: code for code, word in WORDS.items()}
    assert code(by_word["interference_free"]) == 0
    assert code(by_word["inaccessible"]) == 1
    assert code(by_word["unjudged"]) == 4
    nothing = {"offset": np.zeros_like(maps.offset), "free": maps.free[:0], "undecided": np.zeros_like(maps.undecided)}
    assert code(by_word["undecided"], **nothing) == 4
    # What lies inside another body is no surface of the finished part.
    inside = np.arange(n) == 0
    assert code(by_word["inaccessible"], inside=inside) == 0
    assert code(by_word["interference_free"], about={**maps.about, "missing": ["F3: no triangles"]}) == 4
    assert code(by_word["interference_free"], about={**maps.about, "unjudged_faces": ["F3"]}) == 4


@pytest.mark.parametrize("which", ["face", "file"])
def test_missing_obstacles_leave_stored_answers_in_doubt(tmp_path, capsys, which):
    """A face that was not meshed, far from all that the cutter sweeps, or one that reading lost: nobody knows where it is."""
    from cad_io import Part
    from cad_io.arrays import LostFace
    from tests.support.array_files import written
    from tests.support.bodies import lidded
    from tests.support.cad_parts import box

    part = Part(lidded(gap=500.0)) if which == "face" else Part(box(40, 40, 10), lost=(LostFace("#7", "lid", "is gone"),))
    result = plan(part, cutters="R4L40", faces="6", grid=3, area_budget=0, rotation_step=1.0, posture_maps=True)
    assert result.plan.missing
    file = written(tmp_path / "postures.npz", result.maps)
    capsys.readouterr()
    words = ["--machine", "tilt:60", str(file)]
    code, _ = guarded(lambda: (invoked(stored_maps.command, "plan-cutters stored", words), ""), False)
    said = " ".join(capsys.readouterr().out.split())
    assert code == 4
    assert "9 interference free" in said
    assert "Obstacles are missing or guessed, so nothing is beyond doubt: " in said
    assert ("F7: " if which == "face" else "is gone") in said


def test_the_side_of_open_faces_is_part_of_the_question(tmp_path):
    from cad_io import Part
    from tests.support import shapes

    sheet = Part(shapes.shell(shapes.dome(20.0)))
    maps = plan(sheet, cutters="R4L40", grid=5, area_budget=0, posture_maps=True, rotation_step=1.0).maps
    assert maps.about["sides_follow_setup"]
    maps.asked(machine="tilt:50")
    for refused in (lambda: maps.asked(setup=(0, 0, -1)), lambda: maps.within(setup=(0, 0, -1))):
        with pytest.raises(OptionError, match="sides follow from the setup"):
            refused()


def test_a_unit_that_was_given_when_the_part_was_read_is_known():
    from cad_io import read_part

    part = read_part(PART, unit="cm")
    maps = plan(part, cutters="R4L40", grid=3, area_budget=0, posture_maps=True, rotation_step=1.0).maps
    assert maps.about["unit"] == "cm"
    with pytest.raises(OptionError, match="unit cm, not mm"):
        maps.asked(unit="mm")


def test_the_bytes_of_a_fixture_are_compared_not_its_name(tmp_path):
    import trimesh

    file = tmp_path / "vise.stl"
    trimesh.creation.box((4, 4, 4)).apply_translation((0, 0, 80)).export(file)
    maps = plan(PART, cutters="R4L40", grid=3, area_budget=0, posture_maps=True, rotation_step=1.0, fixtures=str(file)).maps
    maps.asked(PART, fixtures=str(file))
    other = tmp_path / "other.stl"
    other.write_bytes(file.read_bytes())
    maps.asked(PART, fixtures=str(other))
    trimesh.creation.box((4, 4, 5)).apply_translation((0, 0, 80)).export(file)
    with pytest.raises(OptionError, match="other fixtures"):
        maps.asked(PART, fixtures=str(file))
    maps.asked(PART)


def test_maps_made_by_hand_say_nothing_of_their_question():
    from tests.support.array_files import maps

    with pytest.raises(OptionError, match="do not say"):
        maps(about={}).asked(machine="tilt:30")
    with pytest.raises(OptionError, match="another part"):
        maps().asked(PART)
    assert Cutter.parse("R1L9").id == maps().cutter


def test_maps_of_another_program_are_refused():
    """Its verdicts may differ: nobody has to remember to say so."""
    for method in (3, "0" * 64, None):
        with pytest.raises(OptionError, match="another version"):
            question.refuse_others({"method": method, "part": "x"}, Options(cutters=CUTTER), (), CUTTER)
