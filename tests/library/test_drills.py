"""Tools for holes in libraries: each format says what they are, and their dimensions."""

import math

import pytest

from plan_cutters import LibraryError
from plan_cutters.domain.drill import KINDS
from plan_cutters.library import read_library, to_toml
from plan_cutters.library.read import listing
from tests.support.tool_files import fusion, in_inches, write_bit, write_csv, write_hsmlib, write_json, write_tools

PLAIN = {"shoulder_length": None, "shoulder_diameter": None, "shaft": None}
#: What Fusion calls each kind.
NAMES = {"drill": "drill", "centre drill": "center drill", "reamer": "reamer", "tap": "tap right hand",
         "countersink": "counter sink", "counterbore": "counter bore"}  # fmt: skip
WRITERS = {"json": write_json, "tools": write_tools, "csv": write_csv, "hsmlib": write_hsmlib}


@pytest.mark.parametrize("suffix", WRITERS)
def test_each_kind_is_known_in_each_format(tmp_path, suffix):
    tools = [fusion(NAMES[kind], number=n, DC=6, LCF=30, SFDM=6, **PLAIN) for n, kind in enumerate(KINDS, 1)]
    library = read_library(WRITERS[suffix](tmp_path / f"a.{suffix}", [*tools, fusion()]))
    assert [each.kind for each in library.drills] == list(KINDS)
    assert len(library) == 1
    assert not library.unused
    for each in library.drills:
        assert (each.diameter, each.body.flutes, each.body.length) == (6.0, 30.0, 40.0)
        assert each.body.holder is not None


def test_fusion_says_the_angle_of_a_point_and_the_feed_of_a_plunge(tmp_path):
    tool = fusion("drill", LCF=30, SFDM=6, SIG=118, **PLAIN)
    tool["start-values"] = {"presets": [{"name": "steel", "v_f": 900, "v_f_plunge": 240}]}
    (entry,) = read_library(write_json(tmp_path / "a.json", [tool])).entries
    assert math.degrees(entry.drill.point) == pytest.approx(118.0)
    assert entry.feed == 240.0


def test_a_bit_of_freecad_is_as_wide_up_to_its_holder(tmp_path):
    file = write_bit(
        tmp_path / "d.fctb", "Drill", Diameter="3.3 mm", TipAngle="118 °", CuttingEdgeHeight=None, ShankDiameter=None
    )
    (entry,) = listing(file, assume_stickout=40, holder="none").entries
    assert (entry.drill.kind, entry.drill.diameter, entry.drill.body.flutes) == ("drill", 3.3, 40.0)
    assert math.degrees(entry.drill.point) == pytest.approx(118.0)
    assert "length below the holder is missing" in listing(file, holder="none").entries[0].unused


def test_our_own_format_is_written_and_read_again(tmp_path):
    tools = [fusion(NAMES[kind], DC=6, LCF=30, SFDM=6, SIG=118 if kind == "drill" else None, **PLAIN) for kind in KINDS]
    library = read_library(write_json(tmp_path / "a.json", tools))
    (tmp_path / "a.toml").write_text(to_toml(library))
    again = read_library(tmp_path / "a.toml")
    assert [each.id for each in again.drills] == [each.id for each in library.drills]
    (tmp_path / "b.toml").write_text('unit = "mm"\n[[tool]]\ntype = "flat"\nDC = 6\nLCF = 9\nLPR = 30\nDMM = 6\nSIG = 118\n')
    with pytest.raises(LibraryError, match="SIG"):
        read_library(tmp_path / "b.toml")


@pytest.mark.parametrize("suffix", WRITERS)
def test_a_tap_has_its_pitch_and_its_hand_in_each_format(tmp_path, suffix):
    tools = [
        fusion("tap right hand", DC=4, LCF=12, SFDM=4, TP=0.7, **PLAIN),
        fusion("tap left hand", DC=6, LCF=20, SFDM=6, TP=1, **PLAIN),
    ]
    library = read_library(WRITERS[suffix](tmp_path / f"a.{suffix}", tools))
    assert [(each.diameter, each.pitch, each.left) for each in library.drills] == [(4.0, 0.7, False), (6.0, 1.0, True)]
    (tmp_path / "b.toml").write_text(to_toml(library))
    assert [each.id for each in read_library(tmp_path / "b.toml").drills] == [each.id for each in library.drills]


def test_a_tap_in_inches_has_its_pitch_in_mm(tmp_path):
    (tap,) = read_library(write_json(tmp_path / "a.json", [in_inches(fusion(
        "tap right hand", DC=6.35, LCF=20, SFDM=6.35, TP=1.27, **PLAIN))])).drills  # fmt: skip
    assert (tap.diameter, tap.pitch) == pytest.approx((6.35, 1.27))


def test_a_tap_of_freecad_has_its_pitch_and_its_hand(tmp_path):
    sizes = {"Diameter": "8 mm", "CuttingEdgeHeight": "20 mm", "ShankDiameter": "6 mm", "TipAngle": "90 °"}
    for name, more in {
        "r": {"Pitch": "1.25 mm"},
        "l": {"Pitch": "1.25 mm", "SpindleDirection": "Reverse"},
        "none": {"Pitch": "0 mm"},
    }.items():
        write_bit(tmp_path / f"{name}.fctb", "Tap", **sizes, **more)
    right, left, none = (
        listing(tmp_path / f"{name}.fctb", assume_stickout=40, holder="none").entries[0] for name in ("r", "l", "none")
    )
    assert [(each.drill.pitch, each.drill.left) for each in (right, left, none)] == [(1.25, False), (1.25, True), (None, False)]
    assert any("it taps no hole" in note for note in none.notes)


def test_a_tap_without_a_pitch_has_that_of_the_thread_in_its_name(tmp_path):
    def pitch(name):
        (entry,) = read_library(
            write_json(tmp_path / "a.json", [fusion("tap right hand", name=name, DC=4, LCF=12, SFDM=4, **PLAIN)])
        ).entries
        return entry.drill.pitch

    assert [pitch(name) for name in ("Tap M4 HSS", "M4x0.5", "#8-32 UNC", "M5", "spiral tap")] == [0.7, 0.5, None, None, None]


@pytest.mark.parametrize("line", ["TP = 1", 'HAND = "L"'])
def test_no_other_tool_has_a_pitch(tmp_path, line):
    (tmp_path / "b.toml").write_text(f'unit = "mm"\n[[tool]]\ntype = "drill"\nDC = 6\nLCF = 9\nLPR = 30\nDMM = 6\n{line}\n')
    with pytest.raises(LibraryError, match="cuts no thread"):
        read_library(tmp_path / "b.toml")


@pytest.mark.parametrize(("geometry", "why"), [
    ({"LB": None}, "drill: LB is missing"), ({"DC": None}, "DC is missing"), ({"LCF": 50}, "is more than"),
    ({"SIG": 200}, "the angle of a point"),
])  # fmt: skip
def test_a_drill_that_cannot_be_read_is_not_used_and_breaks_nothing(tmp_path, geometry, why):
    tool = fusion("drill", **{"LCF": 30, "SFDM": 6, **PLAIN, **geometry})
    library = read_library(write_json(tmp_path / "a.json", [tool, fusion()]))
    assert why in library.entries[0].unused
    assert not library.entries[0].broken
    assert not library.drills
