"""Tool libraries: the same tools from each format, what is missing, what contradicts itself, and what is listed with it."""

import json
import math
import re
import shutil

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from plan_cutters import Cutter, CutterError, LibraryError, Options
from plan_cutters.domain.shapes import MOST_PIECES, pieces_at_most
from plan_cutters.library import holder_of, read_library
from plan_cutters.library.read import listing
from tests.support.tool_files import (
    GEOMETRY,
    HOLDER,
    ID,
    SHAFT,
    fusion,
    in_inches,
    real,
    section,
    write_bit,
    write_csv,
    write_hsmlib,
    write_json,
    write_tools,
)

WRITERS = {"json": write_json, "tools": write_tools, "csv": write_csv, "hsmlib": write_hsmlib}


@pytest.mark.parametrize("suffix", WRITERS)
def test_each_format_says_the_same(tmp_path, suffix):
    library = read_library(WRITERS[suffix](tmp_path / f"a.{suffix}", [fusion(number=7)]))
    assert [cutter.id for cutter in library] == [ID]
    assert (library.numbers(library[0]), library.names(ID)) == ((7,), ("a tool",))
    assert library.entries[0].unit == "mm"


@pytest.mark.parametrize("suffix", WRITERS)
def test_inches_are_honoured_and_said(tmp_path, suffix):
    # A holder has the unit of its tool where the format has no other.
    tool = in_inches(fusion(DC=6.35, LCF=12.7, LB=38.1, OAL=63.5, SFDM=9.525, shoulder_length=None, shoulder_diameter=None,
                            shaft=None))  # fmt: skip
    library = read_library(WRITERS[suffix](tmp_path / f"a.{suffix}", [tool]))
    # CSV has six digits of an inch.
    rounded = [re.sub(r"[0-9.]+", lambda number: f"{round(float(number[0]), 4):g}", cutter.id) for cutter in library]
    assert rounded == ["R3.175L38.1F12.7S4.7625HR12:15L20+R20L10"]
    assert library.entries[0].unit == "inch"


def test_a_holder_has_its_own_unit(tmp_path):
    tool = in_inches(fusion()) | {"holder": HOLDER}
    tool["geometry"]["assemblyGaugeLength"] = 70 / 25.4
    assert [cutter.id for cutter in read_library(write_json(tmp_path / "a.json", [tool]))] == [ID]


def test_the_18_ball_ends_are_identical_in_three_formats():
    names = [f"makera_ball_endmills.{suffix}" for suffix in ("tools", "fusion.csv", "hsmlib")]
    first, *others = [read_library(real(name)) for name in names]
    assert len(first) == 18
    for other in others:
        assert list(other) == list(first)
        for ours, theirs in zip(other, first, strict=True):
            assert ours.id == theirs.id
            assert ours.corner_radius == ours.radius == theirs.radius
            assert (ours.flutes, ours.length, ours.holder) == (theirs.flutes, theirs.length, theirs.holder)
    # The CSV has a row for each material.
    assert sum(len(others[0].entries_of(cutter)) for cutter in others[0]) == len(others[0].entries) == 75
    assert first[0].holder.name == "Carvera ToolHolder"
    assert (first[0].length, first[0].flutes, first[0].necks[0].length, first[0].shank_radius) == (19, 3, 4, 1.5875)


def test_what_stands_between_flutes_and_holder_is_exact(tmp_path):
    tool = fusion(LB=30, shoulder_length=None, shoulder_diameter=None, shaft={"segments": [
        section(3, 6, 4), section(0, 4, 5),
        section(5, 5), section(20, 7, 11)]})  # fmt: skip
    (cutter,) = read_library(write_json(tmp_path / "a.json", [tool]))
    assert [(part, low, stage.radius, stage.length, stage.upper_radius) for part, low, stage in cutter.stages[:3]] == [
        ("neck", 12, 3, 3, 2), ("neck", 15, 2.5, 5, 2.5), ("neck", 20, 3.5, 10, 4.5)]  # fmt: skip


def test_a_collar_wider_than_the_holder_is_a_contradiction(tmp_path):
    tool = fusion(shaft={"segments": [section(40, 30)]}, OAL=80)
    with pytest.raises(LibraryError, match="narrower than what it holds"):
        read_library(write_json(tmp_path / "a.json", [tool]))


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ({"LB": None}, "LB is missing"),
        ({"LB": 0}, "LB is missing"),
        ({"LCF": 0}, "LCF is missing"),
        ({"DC": None}, "DC is missing"),
        ({"SFDM": 0}, "SFDM is missing"),
        ({"holder": None}, "holder is missing"),
        ({"holder": {"segments": []}}, "holder is missing"),
        ({"kind": "boring head"}, '"boring head": not a mill'),
        ({"kind": "probe"}, "not a mill"),
        ({"kind": "circle segment barrel"}, "write it as TOML"),
        ({"kind": "wobble mill"}, '"wobble mill" is unknown'),
        ({"kind": ""}, "its type is missing"),
        ({"kind": "chamfer mill"}, "TA is missing"),
        ({"kind": "lollipop mill", "shoulder_diameter": None, "LCF": 5, "shoulder_length": 6}, "shoulder-diameter is missing"),
    ],
)
def test_what_lacks_something_is_listed_with_the_field(tmp_path, change, said):
    """It is no error beside a good tool, and alone it is one that says the same."""
    path = write_json(tmp_path / "a.json", [fusion(number=2, name="good"), fusion(**change)])
    library = read_library(path)
    (entry,) = library.unused
    assert said in entry.unused
    assert not entry.broken
    assert len(library) == 1
    with pytest.raises(LibraryError, match="only tool cannot be used") as error:
        read_library(write_json(path, [fusion(**change)]))
    assert said in str(error.value)
    assert "Fusion JSON" in str(error.value)


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ({"DC": "6"}, "DC must be a number, not 6"),
        ({"DC": True}, "DC must be a number, not True"),
        ({"DC": math.nan}, "DC must be a number, not nan"),
        ({"LB": math.inf}, "LB must be a finite number, not inf"),
        ({"LB": -40}, "LB is -40"),
        ({"LB": 1e9}, "no tool is longer"),
        ({"LB": 10**400}, "LB must be a finite number"),
        ({"LCF": [12]}, "LCF must be a number"),
        ({"TA": 95}, "TA is 95"),
        ({"RE": 4}, "RE 4 is more than half of DC 6"),
        ({"LCF": 50}, "LCF 50 is more than LB 40"),
        ({"LB": 70}, "LB 70 is more than OAL 60"),
        ({"shoulder_length": 8}, "LCF 12 is more than shoulder-length 8"),
        ({"shoulder_length": 45}, "shoulder-length 45 is more than LB 40"),
        ({"assemblyGaugeLength": 80}, "assemblyGaugeLength 80 is not holder.gaugeLength 30 and LB 40"),
        ({"shaft": {"segments": [section(60, 6, 8)]}}, "more than OAL 60"),
        ({"shaft": {"segments": [{"height": 6, "upper-diameter": 8}]}}, "lower-diameter is missing"),
        ({"shaft": {"segments": "none"}}, "no list of segments"),
        ({"holder": HOLDER | {"segments": [section(5, 0, 9)]}}, "diameter of 0"),
        ({"holder": HOLDER | {"segments": [section(-5, 9)]}}, "cannot be negative"),
        ({"holder": HOLDER | {"segments": [section(5, 6, 9)]}}, "narrower"),
        ({"holder": "chuck"}, "holder is 'chuck'"),
        ({"unit": "furlongs"}, "unit is 'furlongs'"),
        ({"unit": None}, "unit is missing"),
        ({"number": "seven"}, "no tool number"),
        ({"number": 1.5}, "no tool number"),
        ({"kind": "ball end mill", "LCF": 2, "shoulder_length": None}, "end within its corner"),
        ({"kind": "lollipop mill", "shoulder_diameter": 7}, "thinner"),
        ({"kind": "lollipop mill", "LCF": 2, "shoulder_length": None}, "below the middle"),
        ({"kind": "lollipop mill", "LCF": 5, "RE": 2}, "RE 2 is not half of DC 6"),
        ({"kind": "dovetail mill", "TA": 30, "RE": 0}, "meet below"),
        ({"kind": "tapered mill", "TA": 10, "RE": 5}, "does not fit"),
        ({"kind": "chamfer mill", "TA": 45, "tip_diameter": 9}, "tip-diameter 9 is more than DC 6"),
    ],
)
def test_a_broken_tool_among_good_ones_is_named(tmp_path, change, said):
    path = write_json(tmp_path / "a.json", [fusion(name="good"), fusion(**{"name": "the bad one", "number": 3} | change)])
    with pytest.raises(LibraryError) as error:
        read_library(path)
    text = str(error.value)
    assert said.replace("'", "") in text.replace("'", "")
    # The third line of the tool has its name.
    line = [each.strip() for each in path.read_text().splitlines()].index('"description": "the bad one",') - 2
    assert f'a.json: Fusion JSON, tool 2 (line {line}) "the bad one"' in text
    assert "--skip-bad uses the other 1" in text
    assert "\n" not in text
    library = read_library(path, skip_bad=True)
    assert [cutter.id for cutter in library] == [ID]
    assert [entry.broken for entry in library.entries] == [False, True]


def test_equality_is_legal(tmp_path):
    """Flute length, shoulder, stick-out and overall length all the same; and the rounding of six digits."""
    tool = fusion(LCF=40, LB=40, OAL=40, shoulder_length=40, shaft=None, SFDM=None)
    rounded = fusion(LCF=40.0004, LB=40, OAL=40, shoulder_length=40, shaft=None)
    library = read_library(write_json(tmp_path / "a.json", [tool, rounded]))
    assert [cutter.id for cutter in library] == ["R3L40F40HR12:15L20+R20L10", "R3L40.0004F40.0004HR12:15L20+R20L10"]


@pytest.mark.parametrize(
    ("kind", "change", "cutter", "note"),
    [
        ("flat end mill", {"RE": 0.5}, "R3L40rc0.5F12", "read as a bull nose"),
        ("bull nose end mill", {"RE": 0}, "R3L40F12", "read as a flat end"),
        ("bull nose end mill", {"RE": 3}, "R3L40rc3F12", "read as a ball end"),
        ("ball end mill", {}, "R3L40rc3F12", "no RE: half of DC"),
        ("flat end mill", {"TA": 3}, "R3L40T3F12", "read as tapered"),
        ("tapered mill", {"RE": 1, "TA": 0}, "R3L40rc1F12", "TA 0: read as straight"),
        ("slot mill", {"RE": 0}, "R3L40F12", ""),
        ("face mill", {"RE": 0, "TA": 0}, "R3L40F12", ""),
    ],
)
def test_geometry_wins_over_the_name_and_says_so(tmp_path, kind, change, cutter, note):
    library = read_library(write_json(tmp_path / "a.json", [fusion(kind, **change)]))
    assert library[0].id.startswith(f"{cutter}N2.8x4N")
    assert note in "; ".join(library.entries[0].notes)


def test_leaning_flanks_are_measured_at_the_tip(tmp_path):
    """A program's own sample tools: diameter 12 at the tip, 10 deg over 24 mm is 20.46 wide; a dovetail of 30 deg over 10."""
    plain = {"shaft": None, "shoulder_length": None, "shoulder_diameter": None}
    tools = [
        fusion("tapered mill", DC=12, RE=2.5, TA=10, LCF=24, LB=72, OAL=144, SFDM=20.46, **plain),
        fusion("dovetail mill", DC=20, RE=0, TA=30, LCF=10, LB=40, OAL=80, SFDM=8.45, **plain),
    ]
    taper, dovetail = read_library(write_json(tmp_path / "a.json", tools))
    from plan_cutters.domain.shapes import top_radius

    assert top_radius(taper) == pytest.approx(20.463 / 2, abs=1e-3)
    assert top_radius(dovetail) == pytest.approx(8.453 / 2, abs=1e-3)
    assert taper.corner_radius == 2.5


def test_a_cone_goes_on_as_a_cylinder_or_ends_with_the_flutes(tmp_path):
    plain = {"shaft": None, "shoulder_length": None, "shoulder_diameter": None, "TA": 45, "tip_diameter": 1}
    library = read_library(write_json(tmp_path / "a.json", [fusion("chamfer mill", **plain),
                                                           fusion("chamfer mill", LCF=2, **plain)]))  # fmt: skip
    assert library[0].outline == ((0, 0), (0.5, 0), (3, 2.5), (3, 12))
    assert library[1].outline == ((0, 0), (0.5, 0), (2.5, 2))
    assert "is not reached" in library.entries[1].notes[0]


def test_a_lollipop_cut_off_above_its_middle_is_never_thinner_than_it_is(tmp_path):
    tool = fusion("lollipop mill", DC=12, RE=6, LCF=10.8, shoulder_diameter=6, shoulder_length=20, SFDM=10, shaft=None)
    (cutter,) = read_library(write_json(tmp_path / "a.json", [tool]))
    assert cutter.shank_radius == pytest.approx(math.sqrt(36 - 4.8**2))
    (neck, low, stage), (shank, high, wide), *_ = cutter.stages
    assert (neck, low, stage.radius) == ("neck", pytest.approx(10.8), 3)
    assert (shank, high, wide.radius) == ("neck", pytest.approx(20), 5)


def test_assumptions_fill_what_is_missing_and_nothing_else(tmp_path):
    path = write_json(tmp_path / "a.json", [fusion(LB=None, holder=None), fusion(number=2)])
    library = read_library(path, assume_stickout=35, holder="R15L30")
    assert [cutter.id for cutter in library] == ["R3L35F12N2.8x4N2.8:4x4S4HR15L30", ID]
    assert any("assumed stick-out of 35 mm" in note for note in library.entries[0].notes)
    assert any("the given one is taken" in note for note in library.entries[0].notes)
    assert library.entries[1].notes == ()
    bare = read_library(path, assume_stickout=35, holder="none")
    assert bare[0].holder is None
    for stickout, why in ((70, "longer than the tool, OAL 60"), (10, "shorter than its flutes, LCF 12")):
        (entry,) = read_library(path, assume_stickout=stickout, holder="R15L30").unused
        assert why in entry.unused
        assert not entry.broken
    (entry,) = read_library(path, assume_stickout=35, holder="R2L30").unused
    assert "narrower" in entry.unused
    assert not entry.broken


def test_ids_tell_stick_outs_and_holders_apart(tmp_path):
    wide = HOLDER | {"segments": [section(20, 30)]}
    tools = [fusion(), fusion(LB=45), fusion(holder=wide)]
    library = read_library(write_json(tmp_path / "a.json", tools))
    assert len(library) == 3
    assert len(Options(cutters=library).judged) == 3


def test_a_holder_of_many_sections_is_enclosed_by_fewer_and_says_so(tmp_path):
    ribs = [section(1, d) for i in range(40) for d in [30 + 2 * (i % 2) + 0.01 * i]]
    tool = fusion(holder={"unit": "millimeters", "segments": ribs})
    library = read_library(write_json(tmp_path / "a.json", [tool]))
    (cutter,) = library
    assert pieces_at_most(cutter) <= MOST_PIECES
    assert "40 sections are taken as" in library.entries[0].notes[0]
    at, low = [], 0.0
    for stage in cutter.holder.stages:
        at.append((low, low + stage.length, stage))
        low += stage.length
    assert low == pytest.approx(40)
    for i, rib in enumerate(ribs):
        for height in (i + 1e-6, i + 0.5, i + 1 - 1e-6):
            (stage, start) = next((stage, lo) for lo, hi, stage in at if lo <= height < hi + 1e-9)
            assert stage.radius + stage.slope * (height - start) >= rib["lower-diameter"] / 2 - 1e-8


def test_a_shaft_of_many_sections_is_enclosed_by_fewer_and_says_so(tmp_path):
    """Rings on a taper: no point of them is outside what is judged."""
    rings = [section(0.7, 5 + 0.2 * i, 5 + 0.2 * i + i % 3) for i in range(30)]
    tool = fusion(shoulder_length=None, shoulder_diameter=None, shaft={"segments": rings}, SFDM=6,
                  holder={"unit": "millimeters", "segments": [section(20, 30)]})  # fmt: skip
    library = read_library(write_json(tmp_path / "a.json", [tool]))
    (cutter,) = library
    assert "sections of its shaft are taken as 6" in library.entries[0].notes[0]
    above = [(low, stage) for part, low, stage in cutter.stages if part != "holder"]
    assert len(above) <= 6
    low = 12.0
    for ring in rings:
        for share in (1e-6, 0.3, 0.7, 1 - 1e-6):
            height = low + share * ring["height"]
            radius = 0.5 * (ring["lower-diameter"] + share * (ring["upper-diameter"] - ring["lower-diameter"]))
            begin, stage = next((b, s) for b, s in reversed(above) if b <= height)
            assert stage.radius + stage.slope * (height - begin) >= radius - 1e-8
        low += ring["height"]


def test_straight_sections_are_one(tmp_path):
    split = HOLDER | {"segments": [section(8, 24, 26.4),
                                   section(12, 26.4, 30), HOLDER["segments"][1]]}  # fmt: skip
    library = read_library(write_json(tmp_path / "a.json", [fusion(), fusion(number=2, holder=split)]))
    assert [cutter.id for cutter in library] == [ID]
    assert library.numbers(ID) == (1, 2)


NUMBERS = st.floats(0.5, 12).map(lambda v: round(v, 4))


@given(NUMBERS, NUMBERS, NUMBERS, NUMBERS, st.sampled_from(["flat end mill", "ball end mill", "bull nose end mill"]))
@settings(max_examples=60, deadline=None)
def test_inches_and_millimetres_are_the_same_cutters(tmp_path_factory, diameter, neck, more, nose, kind):
    path = tmp_path_factory.mktemp("scaled") / "a.json"
    corner = round((0.5 if kind == "ball end mill" else 0.3) * diameter, 4)
    tool = fusion(kind, DC=diameter, RE=corner, LCF=diameter + 1, shoulder_length=diameter + neck + 1,
                  LB=diameter + neck + more + 5, OAL=60, SFDM=diameter, shoulder_diameter=diameter, shaft=None,
                  holder={"unit": "millimeters", "segments": [
                      section(more, diameter + nose, diameter + 2 * nose)]})  # fmt: skip
    (metric,), (inch,) = read_library(write_json(path, [tool])), read_library(write_json(path, [in_inches(tool)]))
    assert metric.id == inch.id
    assert metric == inch


@given(st.permutations(range(4)), st.lists(st.integers(0, 3), max_size=5))
@settings(max_examples=40, deadline=None)
def test_order_and_repetition_change_nothing_but_numbers(tmp_path_factory, order, again):
    path = tmp_path_factory.mktemp("permuted") / "a.json"
    tools = [fusion(number=i, LB=30 + 2 * i, name=f"tool {i}") for i in range(4)]
    plain = read_library(write_json(path, tools))
    picked = [*order, *again]
    listed = [tools[i] | {"post-process": {"number": 100 + at}} for at, i in enumerate(picked)]
    mixed = read_library(write_json(path, listed))
    assert {cutter.id for cutter in mixed} == {cutter.id for cutter in plain}
    assert [cutter.id for cutter in mixed] == [plain[i].id for i in order]
    for at, i in enumerate(picked):
        assert 100 + at in mixed.numbers(plain[i])
    assert sum(len(mixed.numbers(cutter)) for cutter in mixed) == len(picked)


def test_decimal_commas_in_csv(tmp_path):
    path = write_csv(tmp_path / "a.csv", [fusion()], delimiter=";", comma=True)
    library = read_library(path)
    assert [cutter.id for cutter in library] == [ID]
    assert "decimal commas" in library.entries[0].notes


def test_a_row_of_another_length_is_broken(tmp_path):
    path = write_csv(tmp_path / "a.csv", [fusion(), fusion()])
    path.write_text(path.read_text(encoding="utf-8-sig") + "flat end mill,short\n\n", encoding="utf-8")
    with pytest.raises(LibraryError, match=r"row 3 \(line 4\): it has 2 columns"):
        read_library(path)
    assert len(read_library(path, skip_bad=True)) == 1


def freecad(path, **more):
    return read_library(path, assume_stickout=40, holder="R15L30", **more)


@pytest.mark.parametrize(
    ("parameters", "cutter", "note"),
    [
        ({}, "R3L40F12S3", ""),
        ({"Diameter": "6,0 mm", "CuttingEdgeHeight": "12,0 mm"}, "R3L40F12S3", "decimal commas"),
        ({"Diameter": "6000 µm", "CuttingEdgeHeight": "1.2e4 um"}, "R3L40F12S3", "Diameter in µm"),
        ({"ShankDiameter": "6.0"}, "R3L40F12S3", "ShankDiameter without a unit: mm"),
        ({"ShankDiameter": 6}, "R3L40F12S3", "ShankDiameter without a unit: mm"),
        ({"Diameter": '0.25"', "ShankDiameter": "0.25 in"}, "R3.175L40F12S3.175", "Diameter in"),
        ({"CornerRadius": "1 mm"}, "R3L40rc1F12S3", "read as a bull nose"),
        ({"CuttingEdgeHeight": None, "CuttingEdgeLength": "12 mm"}, "R3L40F12S3", ""),
        ({"ShankDiameter": "3 mm"}, "R3L40F12S1.5", "ShankDiameter 3 is thinner than Diameter 6"),
    ],
)
def test_a_freecad_bit_says_its_units(tmp_path, parameters, cutter, note):
    library = freecad(write_bit(tmp_path / "bit.fctb", **parameters))
    assert [each.id for each in library] == [f"{cutter}HR15L30"]
    assert note in "; ".join(library.entries[0].notes)


@pytest.mark.parametrize(
    ("parameters", "said"),
    [
        ({"Diameter": "6 parsec"}, "no unit of length"),
        ({"Diameter": "1,234.5 mm"}, "two ways"),
        ({"Diameter": "six"}, "not a length"),
        ({"Diameter": "nan mm"}, "Diameter must be a number, not nan"),
        ({"Diameter": "-6 mm"}, "negative"),
        ({"Diameter": "0.25", "Units": "Imperial"}, "mm or in?"),
        ({"CuttingEdgeLength": "11 mm"}, "they mean the same"),
    ],
)
def test_a_broken_freecad_bit_says_its_field(tmp_path, parameters, said):
    with pytest.raises(LibraryError, match="FreeCAD bit") as error:
        freecad(write_bit(tmp_path / "bit.fctb", **parameters))
    assert said in str(error.value)


def test_a_freecad_library_finds_its_bits_and_nothing_else(tmp_path):
    for place, name in (("Bit", "one"), ("Library", "two")):
        write_bit(tmp_path / place / f"{name}.fctb", Diameter="4 mm" if name == "two" else "6 mm")
    write_bit(tmp_path / "elsewhere" / "three.fctb")
    tools = [{"nr": 1, "path": "one.fctb"}, {"nr": 2, "path": "..\\Bit\\two.fctb"}, {"nr": 3, "path": "../elsewhere/three.fctb"},
             {"nr": 4, "path": "/etc/passwd"}, {"nr": 5}]  # fmt: skip
    path = tmp_path / "Library" / "shop.fctl"
    path.write_text(json.dumps({"label": "shop", "tools": tools}))
    with pytest.raises(LibraryError, match="its bit is neither in the folder of"):
        freecad(path)
    library = freecad(path, skip_bad=True)
    assert [(entry.number, entry.broken) for entry in library.entries[:2]] == [(1, False), (2, False)]
    assert [entry.broken for entry in library.entries[2:]] == [True, True, True]
    assert "is no .fctb file" in library.entries[3].unused


def test_the_makera_library_of_freecad_finds_a_real_bit(tmp_path):
    shutil.copy(real("makera_ball_endmills.fctl"), tmp_path / "a.fctl")
    shutil.copy(real("makera_metal_1x3_aluminum.fctb"), tmp_path / "Makera_Makera_Metal_-_1_3mm_Aluminum.fctb")
    library = read_library(tmp_path / "a.fctl", assume_stickout=19, holder="R3.75L6.5", skip_bad=True)
    assert [cutter.id for cutter in library] == ["R0.5L19rc0.5F3S1.5875HR3.75L6.5"]
    assert sum(entry.broken for entry in library.entries) == 74


def test_holders_are_found_by_file_and_name(tmp_path):
    profile = [[0, 0], [10, 0], [12, 5], [12, 30], [0, 30]]
    path = tmp_path / "chuck.fcholder"
    path.write_text(json.dumps({"version": 1, "name": "chuck", "units": "mm", "profile": profile}))
    assert holder_of(str(path)).id == "R10:12L5+R12L25"
    with pytest.raises(LibraryError, match="lists 1 holder and no tools; give it with --holder"):
        read_library(path)
    two = write_json(tmp_path / "two.json", [HOLDER, HOLDER | {"description": "other", "segments": HOLDER["segments"][:1]}])
    with pytest.raises(LibraryError, match=r'choose one as two\.json#NAME: "chuck", "other"'):
        holder_of(str(two))
    assert holder_of(f"{two}#other").id == "R12:15L20"
    assert holder_of("R12L20").id == "R12L20"
    for bad, why in (([[5, 3], [5, 9]], "begin at its nose"), ([[5, 0], [5, 9], [6, 4]], "must rise")):
        path.write_text(json.dumps({"name": "chuck", "units": "mm", "profile": bad}))
        with pytest.raises(LibraryError, match=why):
            holder_of(str(path))


@pytest.mark.parametrize("place", ["Bit", "ToolHolder"])
def test_a_bit_says_its_stick_out_and_its_holder(tmp_path, place):
    """As the newest FreeCAD writes it; what is assumed for tools without is for others then."""
    profile = [[0, 0], [10, 0], [12, 5], [12, 30], [0, 30]]
    path = tmp_path / "Bit" / "a.fctb"
    write_bit(path, Stickout="1.25 in", ToolHolder="chuck")
    holder = tmp_path / place / "chuck.fcholder"
    holder.parent.mkdir(exist_ok=True)
    holder.write_text(json.dumps({"version": 1, "name": "chuck", "units": "mm", "profile": profile}))
    for (mine,) in (read_library(path), freecad(path)):
        assert (mine.length, mine.holder.id) == (31.75, "R10:12L5+R12L25")
    holder.unlink()
    (entry,) = freecad(write_bit(tmp_path / "b.fctb", Stickout="0 mm", ToolHolder="")).entries
    assert (entry.cutter.length, entry.cutter.holder.id) == (40.0, "R15L30")
    # Another holder than the bit's own is never taken for it.
    for word, why in (("chuck", "put its file chuck.fcholder"), ("../Bit/chuck", "no name of a holder"), (7, "no name")):
        with pytest.raises(LibraryError, match=why):
            freecad(write_bit(tmp_path / "Bit" / "b.fctb", ToolHolder=word))
    holder.write_text(json.dumps({"profile": profile, "units": "ell"}))
    with pytest.raises(LibraryError, match=r"units is .ell.:"):
        freecad(path)


def test_a_library_is_a_list_of_cutters(tmp_path):
    library = read_library(write_json(tmp_path / "a.json", [fusion(), fusion(LB=50)]))
    assert isinstance(library[0], Cutter)
    assert library[0:1] == (library[0],)
    assert Options(cutters=library).judged == tuple(library)
    assert library.file == "a.json"
    assert (GEOMETRY["LB"], SHAFT["segments"][0]["height"]) == (40, 4)


@pytest.mark.parametrize(("ball", "half", "DC"), [(1 / 16, 5.5, 0.0568), (1 / 8, 3.5, 0.1176)])
def test_tapered_balls_of_a_maker_are_balls(tmp_path, ball, half, DC):
    # A maker lists these by the ball's diameter and the whole angle, and their Fusion files by DC, rounded to 1e-4 inch.
    tool = fusion("tapered mill", unit="inches", holder=None, shaft=None, DC=DC, RE=ball / 2, TA=half, LCF=1, LB=1.5, OAL=3,
                  SFDM=0.5, shoulder_length=None, shoulder_diameter=None)  # fmt: skip
    (cutter,) = read_library(write_json(tmp_path / "a.json", [tool]), holder="none")
    assert cutter.corner_radius == cutter.radius == pytest.approx(12.7 * ball, abs=1e-3)
    assert math.degrees(cutter.taper) == pytest.approx(half)


def test_a_tapered_mill_that_is_no_ball_says_so(tmp_path):
    tool = fusion("tapered mill", DC=2, RE=1, TA=5, shoulder_length=None, shoulder_diameter=None, shaft=None)
    (entry,) = listing(write_json(tmp_path / "a.json", [tool])).entries
    assert "keeps a flat 0.1673 wide" in entry.unused
    # With the diameter that the line gives it is a ball.
    tool["geometry"]["DC"] = float(entry.unused.partition("deg is ")[2].partition(";")[0])
    (ball,) = read_library(write_json(tmp_path / "b.json", [tool]))
    assert ball.radius == ball.corner_radius == pytest.approx(1.0, abs=1e-4)


def test_two_diameters_at_a_tip_are_not_chosen_from(tmp_path):
    tool = fusion("tapered mill", DC=6, RE=0, tip_diameter=2, TA=5, shoulder_length=None, shoulder_diameter=None, shaft=None)
    (entry,) = listing(write_json(tmp_path / "a.json", [tool])).entries
    assert entry.cutter is None
    assert not entry.broken
    assert "DC 6 and tip-diameter 2" in entry.unused


def test_flutes_wider_than_the_shank_are_noted(tmp_path):
    tool = fusion("tapered mill", DC=2, RE=0, TA=30, shoulder_length=None, shoulder_diameter=None, shaft=None, holder=None)
    (entry,) = listing(write_json(tmp_path / "a.json", [tool]), holder="none").entries
    wide = 2 + 2 * 12 * math.tan(math.radians(30))
    assert f"SFDM 8 is thinner than its flutes where they end, {wide:.6g}" in entry.notes


def test_a_kind_that_only_sounds_like_a_tap_is_unknown(tmp_path):
    tools = [fusion("tapered ball end mill"), fusion("tap right hand", shaft=None)]
    tapered, tap = listing(write_json(tmp_path / "a.json", tools)).entries
    assert "is unknown" in tapered.unused
    assert tap.drill.kind == "tap"


def _hsmlib(tmp_path, **more):
    return write_hsmlib(tmp_path / "a.hsmlib", [fusion()], **more)


def test_hsmworks_text_in_another_encoding_than_it_declares(tmp_path):
    path = _hsmlib(tmp_path)
    text = path.read_bytes().decode("utf-16" if path.read_bytes()[:2] in (b"\xff\xfe", b"\xfe\xff") else "utf-8")
    body = text.partition("?>")[2] if text.startswith("<?xml") else text
    for declared, encoding in (("UTF-16", "utf-8"), ("UTF-8", "utf-16"), ("UTF-16", "utf-16-be"), ("UTF-8", "utf-8-sig")):
        path.write_bytes(f'<?xml version="1.0" encoding="{declared}"?>{body}'.encode(encoding))
        assert [cutter.id for cutter in read_library(path)] == [ID]


def test_hsmworks_tools_in_groups_are_listed(tmp_path):
    path = _hsmlib(tmp_path)
    raw = path.read_bytes()
    text = raw.decode("utf-16" if raw[:2] in (b"\xff\xfe", b"\xfe\xff") else "utf-8")
    text = text.partition("?>")[2] if text.startswith("<?xml") else text
    text = text.replace("<tool ", "<group><tool ", 1).replace("</tool>", "</tool></group>", 1)
    path.write_text(text, encoding="utf-8")
    assert [cutter.id for cutter in read_library(path)] == [ID]


def test_hsmworks_holder_in_its_own_unit(tmp_path):
    body = ('body-length="2" diameter="0.5" flute-length="1" shaft-diameter="0.5" overall-length="4" '
            'assembly-gauge-length="3"')  # fmt: skip
    sections = '<section length="0" diameter="30"/><section length="25.4" diameter="30"/>'
    holder = f'<holder unit="millimeters" gauge-length="25.4">{sections}</holder>'
    path = tmp_path / "a.hsmlib"
    path.write_text(f'<tool-library><tool type="flat end mill" unit="inches"><body {body}/>{holder}</tool></tool-library>')
    assert [cutter.id for cutter in read_library(path)] == ["R6.35L50.8F25.4S6.35HR15L25.4"]


def test_a_csv_that_says_its_separator(tmp_path):
    path = write_csv(tmp_path / "a.csv", [fusion()], delimiter=";", comma=True)
    path.write_text("sep=;\r\n" + path.read_text(encoding="utf-8"), encoding="utf-8")
    assert [cutter.id for cutter in read_library(path)] == [ID]


def test_names_of_files_that_no_system_takes(tmp_path):
    (tmp_path / "a.fctl").write_text(json.dumps({"tools": [{"nr": 1, "path": "x" * 5000 + ".fctb"}]}))
    (entry,) = listing(tmp_path / "a.fctl", skip_bad=True).entries
    assert entry.broken
    assert "put it there" in entry.unused
    with pytest.raises(CutterError, match="not of the form"):
        holder_of("R15L30" * 1000)
    with pytest.raises(LibraryError, match="is no file"):
        holder_of(str(tmp_path / "none.fcholder"))


def test_what_a_bit_has_beyond_its_shape_is_noted(tmp_path):
    bit = {"version": 2, "name": "b", "shape": "endmill.fcstd", "parameter": {
        "Diameter": "6 mm", "CuttingEdgeHeight": "20 mm", "Length": "60 mm", "ShankDiameter": "6 mm", "NeckLength": "9 mm",
        "NeckDiameter": "0 mm"}}  # fmt: skip
    path = tmp_path / "a.fctb"
    path.write_text(json.dumps(bit))
    (entry,) = listing(path, assume_stickout=40.0, holder="none").entries
    assert "NeckLength 9 mm is not used" in entry.notes
    assert not any("NeckDiameter" in note for note in entry.notes)
    for wrong in ('1/4"', "6 M"):
        bit["parameter"]["Diameter"] = wrong
        path.write_text(json.dumps(bit))
        with pytest.raises(LibraryError, match="Diameter is"):
            read_library(path, assume_stickout=40.0, holder="none")


def test_a_slitting_saw_of_freecad_is_as_thick_as_its_blade(tmp_path):
    sizes = {
        "BladeThickness": "3 mm",
        "CapDiameter": "8 mm",
        "Diameter": "60 mm",
        "ShankDiameter": "16 mm",
        "CuttingEdgeHeight": None,
    }
    (entry,) = listing(
        write_bit(tmp_path / "a.fctb", "SlittingSaw", CapHeight="0 mm", **sizes), assume_stickout=40, holder="none"
    ).entries
    assert entry.cutter.id == "R30L40F3S8"
    # What stands out below the blade would be taken for what cuts.
    (entry,) = listing(
        write_bit(tmp_path / "b.fctb", "SlittingSaw", CapHeight="3 mm", **sizes), assume_stickout=40, holder="none"
    ).entries
    assert entry.cutter is None
    assert "CapHeight" in entry.unused
