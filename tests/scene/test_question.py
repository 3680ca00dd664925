"""What stored verdicts answer: the same question and less freedom; any other one is refused by the name of what differs."""

import json
import math
from types import SimpleNamespace

import numpy as np
import pytest

from cad_io import read_part
from plan_cutters import Options
from plan_cutters.domain.fixture import Fixture
from plan_cutters.domain.placement import Placement
from plan_cutters.errors import OptionError
from plan_cutters.pipeline import prepare
from plan_cutters.scene import question as stored
from plan_cutters.scene.question import checksum, question, refuse_others, require_side, setup_of, turns_of, words_of
from tests.support import shapes
from tests.support.cad_parts import box, write_step

CUTTER = "R4L40"
BASE = {
    "cutters": CUTTER, "grid": 3, "area_budget": 0, "faces": "F1-4", "ignore": "F6", "fixtures": ["box:5,5,5@0,0,60"],
    "holder": "R15L30", "allowance": 0.1, "tilt": (0.0, 1.0), "rotation": (0.0, 2.0), "rotation_step": 0.5,
}  # fmt: skip


@pytest.fixture(scope="module")
def about():
    """As it comes back from a file."""
    ready = prepare(box(30, 20, 10), Options.of(BASE))
    return json.loads(json.dumps(question(ready, ready.cutters[0])))


def refused(about, cutter=None, **asked):
    """Why a plan with these options is none that the maps answer; empty where it is."""
    options = Options.of({**{k: v for k, v in BASE.items() if k == "cutters" and not asked.keys() & {"cutters"}}, **asked})
    try:
        refuse_others(about, options, set(asked), cutter or about["id"])
    except OptionError as error:
        return str(error)
    return ""


@pytest.fixture(scope="module")
def maps(about):
    """With the id of its cutter, which the maps themselves know."""
    [judged] = Options.of(BASE).judged
    return about | {"id": judged.id}


def test_a_question_says_what_verdicts_depend_on(about):
    assert (about["faces"], about["targets"]) == ("F1-4", [1, 2, 3, 4])
    assert (about["ignore"], about["ignored"]) == (["F6"], [6])
    assert (about["setup"], about["x"], about["clamped"]) == ([0.0, 0.0, 1.0], None, [])
    assert (about["tilt"], about["rotation"], about["rotation_step"]) == ([0.0, 1.0], [0.0, 2.0], 0.5)
    assert (about["tolerance"], about["allowance"], about["grid"], about["spacing"]) == (0.01, 0.1, 3, None)
    assert about["fixtures"] == [
        {"kind": "box", "sizes": [5.0, 5.0, 5.0], "placement": [0.0, 0.0, 60.0, 0.0, 0.0, 0.0], "chord_error": 0.0}
    ]
    assert (about["missing"], about["unjudged_faces"], about["sides_follow_setup"]) == ([], [], False)
    placed = Placement((0.0, 0.0, 1.0), (0.0, 1.0, 0.0), clamped=("F5",))
    there = prepare(box(30, 20, 10), Options.of({"cutters": CUTTER, "grid": 3, "area_budget": 0, "setup": placed}))
    other = question(there, there.cutters[0])
    assert (other["x"], other["clamped"]) == ([0.0, 1.0, 0.0], ["F5"])
    assert other["holder"] is None


@pytest.mark.parametrize(
    ("asked", "words"),
    [
        ({}, ""),
        ({"faces": "F1-4", "ignore": "F6"}, ""),
        ({"faces": "f1,2, F3-4"}, ""),
        ({"faces": "4,3,2,1"}, ""),
        ({"faces": "F1-3"}, "these maps are of faces F1-4, not F1-3: plan again"),
        ({"faces": "F1-5"}, "these maps are of faces F1-4, not F1-5: plan again"),
        ({"faces": "all"}, "these maps are of faces F1-4, not all: plan again"),
        ({"faces": 3}, "these maps are of faces F1-4, not 3: plan again"),
        ({"ignore": ("F6",)}, ""),
        ({"ignore": 6}, ""),
        ({"ignore": ["F6", "F5"]}, "these maps are of ignore F6, not F6, F5: plan again"),
        ({"ignore": ()}, "these maps are of ignore F6, not none: plan again"),
        ({"holder": "R15L30"}, ""),
        ({"holder": "R16L30"}, "these maps are of another holder: plan again"),
        ({"allowance": 0.1}, ""),
        ({"allowance": 0.2}, "these maps are of allowance 0.1, not 0.2: plan again"),
        ({"holder_clearance": 0.5}, "these maps are of holder clearance 0, not 0.5: plan again"),
        ({"grid": 4}, "these maps are of grid 3, not 4: plan again"),
        ({"spacing": 2.0}, "these maps are of spacing by default, not 2: plan again"),
        ({"tolerance": 0.01}, ""),
        ({"tolerance": 0.02}, "these maps are of tolerance 0.01, not 0.02: plan again"),
        ({"flip": True}, "these maps are of flip False, not True: plan again"),
        ({"unit": "in"}, "these maps are of unit as stated, not in: plan again"),
        ({"fixtures": "box:5,5,5@0,0,60"}, ""),
        ({"fixtures": "box:5,5,6@0,0,60"}, "these maps are of other fixtures (1, 1 requested): plan again"),
        ({"fixtures": "box:5,5,5@0,0,61"}, "these maps are of other fixtures (1, 1 requested): plan again"),
        ({"fixtures": ()}, "these maps are of other fixtures (1, 0 requested): plan again"),
        ({"cutters": CUTTER}, ""),
        ({"cutters": ["R1L9", CUTTER]}, ""),
        ({"cutters": CUTTER, "allowance": 0.1, "holder": "R15L30"}, ""),
        ({"setup": "auto"}, "posture maps do not answer the setup auto: leave it out, or plan the part with it"),
        ({"other_setups": [(1, 0, 0)]}, "posture maps do not answer a second --setup: leave it out, or plan the part with it"),
        ({"map_budget": 5}, "posture maps do not answer --map-budget: leave it out, or plan the part with it"),
        ({"setup": (1, 0, 0), "machine": "3-axis", "jobs": 1, "feed": 100.0}, ""),
    ],
)
def test_another_question_is_refused_in_one_line_by_what_differs(maps, asked, words):
    assert refused(maps, **asked) == words


def test_a_cutter_that_was_not_requested_is_refused_by_its_name_with_those_that_were(maps):
    said = refused(maps, cutters=["R1L9", "R2L9", "R3L9", "R5L9"])
    assert said.startswith(f"these maps are of cutter {maps['id']}, which was not requested (R1L9")
    assert said.endswith("): plan again")
    assert said.count("L9") == 3
    # With another allowance it is another cutter, whatever else is said.
    assert "allowance 0.1, not 0" in refused(maps, cutters=CUTTER, allowance=0.0)


def test_maps_that_say_nothing_answer_nothing(maps):
    for nothing in ({}, maps | {"method": "other"}, {k: v for k, v in maps.items() if k != "clamped"} | {"clamped": 3}):
        wrong = refused(nothing, "id", placement=Placement((0, 0, 1), clamped=("F5",)), setup=(0, 0, 1))
        assert wrong in (
            "these maps do not say what they were made for: write them again with --posture-maps",
            "these maps were made by another version, whose verdicts may differ: plan again",
        )
    for word, asked in (("grid", {"grid": 3}), ("faces", {"faces": "F1"}), ("holder", {"holder": None}),
                        ("fixtures", {"fixtures": ()}), ("allowance", {"cutters": CUTTER})):  # fmt: skip
        assert "do not say what they were made for" in refused({k: v for k, v in maps.items() if k != word}, **asked)


def test_what_a_setup_file_holds_is_that_of_the_maps_or_refused(maps):
    clamped = maps | {"clamped": ["F5", "F6"]}
    same = Placement((0, 0, 1), clamped=("F6", " F5"))
    assert refused(clamped, placement=same, setup=same.z) == ""
    assert refused(clamped, placement=Placement((0, 0, 1)), setup=(0, 0, 1)) == ""
    other = Placement((0, 0, 1), clamped=("F5",))
    assert refused(clamped, placement=other, setup=other.z) == "these maps are of clamped faces F5, F6, not F5: plan again"
    assert refused(maps, placement=other, setup=other.z) == "these maps are of clamped faces none, not F5: plan again"
    held = Placement((0, 0, 1), fixtures=(Fixture.parse("table"),))
    assert "other fixtures" in refused(maps, placement=held, setup=held.z)


def test_a_vise_that_was_placed_for_a_setup_answers_that_one_alone(maps):
    vise = {"kind": "vise", "sizes": [], "placed_for_setup": True, "placement": [0.0] * 6, "chord_error": 0.0}
    placed = maps | {"fixtures": [vise], "setup": [0.0, 0.0, 1.0]}
    assert refused(placed, setup=(0, 0, 1)) == ""
    assert (
        refused(placed, setup=(1, 0, 0)) == "these maps are of a vise that was placed for the setup 0,0,1, not 1,0,0: plan again"
    )
    assert refused(placed, fixtures="vise") == ""
    assert refused(maps | {"setup": [0.0, 0.0, 1.0]}, setup=(1, 0, 0)) == ""


def test_rotations_are_those_of_the_maps_or_refused(maps):
    """A plan with the same step looks at some of them; where none was asked for, at all."""
    known = np.array([0.0, 0.5, 1.0, 1.5, 2.0])

    def turns(stated, **asked):
        return turns_of(maps, known, Options.of({"cutters": CUTTER, **asked}), stated).tolist()

    assert turns(()) == [0, 1, 2, 3, 4]
    assert turns({"jobs"}) == [0, 1, 2, 3, 4]
    assert turns({"rotation"}, rotation=(0.5, 1.5)) == [1, 2, 3]
    assert turns({"rotation"}, rotation=(0.5 - 2 * math.pi, 1.5 - 2 * math.pi)) == [1, 2, 3]
    assert turns({"rotation_step"}, rotation_step=1.0) == [0, 2, 4]
    assert turns({"rotation", "rotation_step"}, rotation=(1.0, 2.0), rotation_step=1.0) == [2, 4]
    with pytest.raises(OptionError) as error:
        turns({"rotation", "rotation_step"}, rotation=(0.25, 1.25), rotation_step=0.5)
    assert str(error.value) == (
        f"these maps have no rotation of {math.degrees(0.25):.6g} deg, which was requested with --rotation and --rotation-step: "
        "plan again"
    )
    with pytest.raises(OptionError, match="do not say what they were made for"):
        turns_of({}, known, Options.of({"cutters": CUTTER, "rotation_step": 0.5}), {"rotation_step"})


def test_open_faces_keep_the_side_that_their_setup_gave_them():
    sheet = prepare(shapes.plane((0, 5), (0, 5)), Options.of({"cutters": "R1L9", "grid": 3, "area_budget": 0}))
    about = question(sheet, sheet.cutters[0])
    assert about["sides_follow_setup"]
    require_side(about, (0.0, 0.0, 1.0))
    with pytest.raises(OptionError, match="whose sides follow from the setup 0,0,1: give that as the setup, or plan again"):
        require_side(about, (0.0, 0.0, -1.0))
    require_side(about | {"sides_follow_setup": False}, (0.0, 0.0, -1.0))
    require_side({}, (1.0, 0.0, 0.0))


def test_stored_words_and_directions_are_taken_as_they_are_or_refused():
    assert words_of({"missing": ["a", "b"]}, "missing") == ("a", "b")
    assert words_of({}, "missing") == ()
    assert setup_of({}).z == (0.0, 0.0, 1.0)
    placed = setup_of({"setup": [0.0, 0.0, -1.0], "x": [0.0, 1.0, 0.0]})
    assert (placed.z, placed.x) == ((0.0, 0.0, -1.0), (0.0, 1.0, 0.0))
    for wrong in ({"missing": "a"}, {"missing": [1]}, {"missing": None}):
        with pytest.raises(OptionError, match="do not say"):
            words_of(wrong, "missing")
    for wrong in ({"setup": 3}, {"setup": [0, 0]}, {"setup": "up"}):
        with pytest.raises(OptionError):
            setup_of(wrong)


def test_a_file_is_known_by_its_bytes_and_an_object_by_nothing(tmp_path):
    for k, size in enumerate((10.0, 11.0)):
        write_step(box(size), tmp_path / f"{k}.step")
    (tmp_path / "copy.step").write_bytes((tmp_path / "0.step").read_bytes())
    one, other, copy = (checksum(str(tmp_path / name)) for name in ("0.step", "1.step", "copy.step"))
    assert one == copy != other
    assert checksum(read_part(tmp_path / "0.step")) == one
    with pytest.raises(OptionError, match="cannot be read: No such file"):
        checksum(str(tmp_path / "none.step"))
    # A fixture of a file is its bytes, wherever that lies; a body of a CAD host is the same as nothing else.
    about = {"fixtures": [stored._requested_fixture(Fixture(str(tmp_path / "0.step")))]}
    asks = lambda each: SimpleNamespace(fixtures=[each])  # noqa: E731
    assert stored._fixtures(about, asks(Fixture(str(tmp_path / "copy.step")))) == ""
    assert stored._fixtures(about, asks(Fixture(str(tmp_path / "1.step")))) != ""
    assert stored._fixtures(about, asks(Fixture(str(tmp_path / "0.step"), unit="in"))) != ""
    body = Fixture(box())
    assert stored._fixtures({"fixtures": [stored._requested_fixture(body)]}, asks(body)) != ""


def test_the_tool_of_a_question_is_the_cutter_that_was_judged(about):
    tool = about["tool"]
    assert (tool["radius"], tool["length"]) == (4.0, 40.0)
