"""Where a field is missing or has two meanings, the judged tool encloses each, or there is none (docs/tool_fields.md)."""

import json
import math
import re
import sys
import types

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from plan_cutters import Cutter, LibraryError
from plan_cutters.domain.shapes import flute_length
from plan_cutters.library.read import listing
from tests.support.places import ROOT
from tests.support.tool_files import fusion, section, write_bit, write_csv, write_hsmlib, write_json

WRITERS = {"json": write_json, "csv": write_csv, "hsmlib": write_hsmlib}
#: What stands above the flutes is a shank alone.
PLAIN = {"shoulder_length": None, "shoulder_diameter": None, "shaft": None}


def entry(path, **more):
    """The only tool of a file."""
    (found,) = listing(path, holder="none", **more).entries
    return found


def bit(folder, shape="Bullnose", **parameters):
    """A FreeCAD bit, read with an assumed stick-out."""
    return entry(write_bit(folder / "bit.fctb", shape, **parameters), assume_stickout=40.0)


@pytest.mark.parametrize("field", ["FlatRadius", "TorusRadius"])
@pytest.mark.parametrize(("value", "other"), [("0.7 mm", "2.3"), ("0 mm", "3"), ("3 mm", "0"), ("2.3 mm", "0.7")])
def test_the_radius_of_a_flat_or_of_a_corner_is_not_chosen(tmp_path, field, value, other):
    found = bit(tmp_path, **{field: value})
    assert (found.cutter, found.broken) == (None, False)
    assert f"{field} {value[:-3]} is the radius of its corner, or of the flat at its tip" in found.unused
    assert f"then has {other}: add CornerRadius" in found.unused


@pytest.mark.parametrize("field", ["FlatRadius", "TorusRadius"])
def test_both_readings_of_a_quarter_of_the_diameter_are_one_tool(tmp_path, field):
    assert bit(tmp_path, **{field: "1.5 mm"}).cutter.id == "R3L40rc1.5F12S3"


def test_a_bull_nose_bit_states_its_corner(tmp_path):
    assert "CornerRadius is missing (the radius of its corner)" in bit(tmp_path).unused
    assert bit(tmp_path, CornerRadius="0 mm").cutter.corner_radius == 0


@pytest.mark.parametrize("field", ["FlatRadius", "TorusRadius"])
@pytest.mark.parametrize("flat", ["0.5 mm", "2.5 mm"])
def test_a_corner_radius_decides_if_the_other_agrees_in_one_reading(tmp_path, field, flat):
    assert bit(tmp_path, CornerRadius="0.5 mm", **{field: flat}).cutter.corner_radius == 0.5
    with pytest.raises(LibraryError, match=f"CornerRadius 0.5 and {field} 1 do not agree"):
        bit(tmp_path, CornerRadius="0.5 mm", **{field: "1 mm"})


def record(cutter):
    """What a plan has of a cutter, as far as a bit needs it."""
    stages = [
        {"part": part, "radius_mm": stage.radius, "upper_radius_mm": stage.upper_radius} for part, _, stage in cutter.stages
    ]
    kept = {"shape": cutter.shape, "radius": cutter.radius, "corner_radius": cutter.corner_radius, "length": cutter.length}
    return kept | {"taper_deg": math.degrees(cutter.taper), "flutes_mm": flute_length(cutter), "stages": stages}


def macro(monkeypatch):
    """The names of the macro that writes bits, without FreeCAD."""
    for name in ("FreeCAD", "Part"):
        monkeypatch.setitem(sys.modules, name, types.ModuleType(name))
    path = ROOT / "freecad" / "PlanOperations.FCMacro"
    found = {"__name__": "macro"}
    exec(compile(path.read_text(encoding="utf-8"), path.name, "exec"), found)
    return found


@pytest.mark.parametrize("spec", ["D6L40F12S6", "D6L40rc0.5F12S6", "D6L40rc1.5F12S4", "D6L40rc2.9F12S8", "D6L40rc3F12S6"])
def test_a_bit_of_the_macro_is_read_as_its_cutter(tmp_path, monkeypatch, spec):
    cutter = Cutter.parse(spec)
    assert written(tmp_path, monkeypatch, cutter).id == cutter.id


@pytest.mark.parametrize(("spec", "shank"), [("R3L40F12N4x8S3", 4), ("R3L40F12N2x8S3", 3), ("R3L40F12N2.8:4x8S3", 4)])
def test_a_bit_of_the_macro_is_nowhere_thinner_than_a_neck(tmp_path, monkeypatch, spec, shank):
    assert written(tmp_path, monkeypatch, Cutter.parse(spec)).shank_radius == shank


def written(tmp_path, monkeypatch, cutter):
    """What is read of the bit that the macro makes of a cutter."""
    shape, sizes = macro(monkeypatch)["bit_shape"](record(cutter))
    path = write_bit(tmp_path / "bit.fctb", shape, **{name: f"{value:.9g} mm" for name, value in sizes.items()})
    return entry(path, assume_stickout=40.0).cutter


@pytest.mark.parametrize("suffix", WRITERS)
def test_a_shoulder_without_a_diameter_is_as_wide_as_the_flutes_below_it(tmp_path, suffix):
    tool = fusion("tapered mill", DC=2, RE=0, TA=10, LCF=10, LB=30, SFDM=6, **PLAIN | {"shoulder_length": 20})
    found = entry(WRITERS[suffix](tmp_path / f"a.{suffix}", [tool | {"holder": {}}]))
    (low, stage), *_ = [(low, stage) for part, low, stage in found.cutter.stages if part == "neck"]
    assert (low, stage.length) == (10, 10)
    assert stage.radius == pytest.approx(1 + 10 * math.tan(math.radians(10)), abs=1e-6)
    assert "as wide as its flutes where they end, 5.52654" in "; ".join(found.notes)


@pytest.mark.parametrize("suffix", WRITERS)
@pytest.mark.parametrize(
    ("kind", "change", "said"),
    [
        ("bull nose end mill", {}, "is missing (the radius of its corner)"),
        ("slot mill", {}, "is missing (the radius of its corner)"),
        ("face mill", {"TA": 0}, "is missing (the radius of its corner)"),
        ("face mill", {"RE": 0}, "is missing (the angle of its edges from the axis)"),
        ("tapered mill", {"TA": 5}, "is missing (the radius of its corner)"),
        ("tapered mill", {"RE": 1}, "is missing (the angle of its flank from the axis)"),
        ("dovetail mill", {"TA": 5}, "is missing (the radius of its corner)"),
        ("chamfer mill", {"TA": 45}, "is missing (the diameter at its tip)"),
        ("chamfer mill", {"TA": 45, "tip_diameter": 1, "RE": 1}, "with a corner radius are not read"),
        ("ball end mill", {"TA": 5}, "is missing (the radius of its corner)"),
        ("ball end mill", {"RE": 1}, 'called "ball end mill", but'),
        ("ball end mill", {"RE": 0}, 'called "ball end mill", but'),
        ("flat end mill", {"tip_diameter": 2}, "a straight mill has one diameter"),
        ("bull nose end mill", {"RE": 1, "TA": 0, "tip_diameter": 2}, "a straight mill has one diameter"),
    ],
)
def test_a_tip_that_can_mean_two_things_is_not_chosen(tmp_path, suffix, kind, change, said):
    found = entry(WRITERS[suffix](tmp_path / f"a.{suffix}", [fusion(kind, **PLAIN | change)]))
    assert (found.cutter, found.broken) == (None, False)
    assert said in found.unused


@pytest.mark.parametrize("suffix", WRITERS)
@pytest.mark.parametrize(
    ("kind", "change", "said"),
    [
        ("bull nose end mill", {"RE": 0}, "R3L40F12S4"),
        ("flat end mill", {}, "R3L40F12S4"),
        ("ball end mill", {}, "R3L40rc3F12S4"),
        ("slot mill", {"RE": 0}, "R3L40F12S4"),
        ("face mill", {"RE": 1, "TA": 0}, "R3L40rc1F12S4"),
        ("tapered mill", {"RE": 0, "TA": 0}, "R3L40F12S4"),
        ("tapered mill", {"RE": 0, "TA": 5}, "R3L40T5F12S4"),
    ],
)
def test_a_zero_is_an_answer(tmp_path, suffix, kind, change, said):
    found = entry(WRITERS[suffix](tmp_path / f"a.{suffix}", [fusion(kind, holder={}, **PLAIN | change)]))
    assert found.cutter.id.partition("HR")[0] == said


@pytest.mark.parametrize("kind", ["flat end mill", "ball end mill", "chamfer mill", "lollipop mill", "dovetail mill"])
def test_a_largest_diameter_that_nothing_explains_is_not_ignored(tmp_path, kind):
    more = {"TA": 45, "tip_diameter": 1} if kind == "chamfer mill" else {"TA": 5, "RE": 0} if kind == "dovetail mill" else {}
    plain = PLAIN | ({"shoulder_diameter": 4, "shoulder_length": 20, "LCF": 5} if kind == "lollipop mill" else {}) | more
    path = tmp_path / "a.json"
    assert entry(write_json(path, [fusion(kind, DCX=6, **plain)])).cutter
    assert (
        "DCX 8 is wider than all that its other dimensions say" in entry(write_json(path, [fusion(kind, DCX=8, **plain)])).unused
    )


@pytest.mark.parametrize("suffix", WRITERS)
def test_a_neck_of_unknown_height_is_nowhere_thinner(tmp_path, suffix):
    plain = PLAIN | {"shoulder_diameter": 9}
    found = entry(WRITERS[suffix](tmp_path / f"a.{suffix}", [fusion(**plain)]))
    assert found.cutter.shank_radius == 4.5
    assert any("how high" in note for note in found.notes)
    thin = entry(WRITERS[suffix](tmp_path / f"b.{suffix}", [fusion(**plain | {"shoulder_diameter": 5})]))
    assert thin.cutter.shank_radius == 4
    shafted = fusion(**plain | {"shaft": {"segments": [section(4, 5, 8)]}})
    assert "where its shaft's sections begin" in entry(WRITERS[suffix](tmp_path / f"c.{suffix}", [shafted])).unused


def test_a_neck_of_a_bit_is_nowhere_thinner(tmp_path):
    assert bit(tmp_path, "Endmill", NeckDiameter="8 mm", NeckLength="9 mm").cutter.id == "R3L40F12S4"


@pytest.mark.parametrize("shape", ["Endmill", "Ballend"])
def test_an_angle_of_a_straight_bit_is_not_ignored(tmp_path, shape):
    assert "has no cone" in bit(tmp_path, shape, CuttingEdgeAngle="30 °").unused
    assert bit(tmp_path, shape, CuttingEdgeAngle="180 °").cutter


def test_the_angle_of_a_chamfer_bit_is_not_chosen(tmp_path):
    """FreeCAD's own bit of 45 degrees is drawn with neither half of it nor the whole."""
    cone = {"Diameter": "12.3323 mm", "TipDiameter": "5 mm", "CuttingEdgeHeight": "6.35 mm"}
    assert "is the whole angle of its cone or" in bit(tmp_path, "Chamfer", CuttingEdgeAngle="45 °", **cone).unused
    assert bit(tmp_path, "Chamfer", CuttingEdgeAngle="90 °", **cone).cutter
    assert bit(tmp_path, "Vbit", CuttingEdgeAngle="45 °", **cone).cutter


def test_a_flat_at_the_tip_of_a_cone_is_its_tip_diameter_alone(tmp_path):
    cone = {"Diameter": "6 mm", "TipDiameter": "1 mm", "CuttingEdgeAngle": "90 °"}
    assert bit(tmp_path, "Vbit", **cone).cutter
    assert "give TipDiameter alone" in bit(tmp_path, "Vbit", FlatRadius="0.5 mm", **cone).unused


@pytest.mark.parametrize("suffix", WRITERS)
@pytest.mark.parametrize("kind", ["flat end mill", "bull nose end mill", "ball end mill", "slot mill"])
def test_a_rounded_mill_with_a_half_angle_is_not_chosen(tmp_path, suffix, kind):
    """The axis of a tapered mill with the same corner stands farther from the contact, and the shank with it."""
    path = tmp_path / f"a.{suffix}"
    found = entry(WRITERS[suffix](path, [fusion(kind, RE=1, TA=10, holder=None, **PLAIN)]))
    assert (found.cutter, found.broken) == (None, False)
    assert "straight or tapered" in found.unused


@pytest.mark.parametrize("suffix", WRITERS)
@pytest.mark.parametrize(("tapered", "read"), [("tapered_ball", False), (None, False), ("tapered_bull_nose", True)])
def test_a_tapered_tip_that_may_be_a_ball_is_not_chosen(tmp_path, suffix, tapered, read):
    """By its half diameter it is a ball, by its diameter at the tip it keeps a flat."""
    tool = fusion("tapered mill", DC=2, RE=1, TA=5, tapered=tapered, holder=None, **PLAIN)
    found = entry(WRITERS[suffix](tmp_path / f"a.{suffix}", [tool]))
    assert (found.cutter is not None) == read
    if not read:
        assert not found.broken
        assert "is 1.8326" in found.unused


@pytest.mark.parametrize("suffix", WRITERS)
@pytest.mark.parametrize("tapered", ["tapered_ball", "tapered_bull_nose", None])
def test_a_tapered_ball_with_its_own_diameter_is_one(tmp_path, suffix, tapered):
    diameter = 2 * (1 - math.sin(math.radians(5))) / math.cos(math.radians(5))
    tool = fusion("tapered mill", DC=round(diameter, 5), RE=1, TA=5, tapered=tapered, holder=None, **PLAIN)
    found = entry(WRITERS[suffix](tmp_path / f"a.{suffix}", [tool])).cutter
    assert found.corner_radius == found.radius


@pytest.mark.parametrize("suffix", WRITERS)
@pytest.mark.parametrize(("RE", "tapered"), [(0.5, "tapered_ball"), (0, "tapered_ball"), (0.5, "tapered_nose")])
def test_a_tapered_type_that_the_corner_contradicts_is_not_ignored(tmp_path, suffix, RE, tapered):
    tool = fusion("tapered mill", DC=2, RE=RE, TA=5, tapered=tapered, holder=None, **PLAIN)
    found = entry(WRITERS[suffix](tmp_path / f"a.{suffix}", [tool]))
    assert found.cutter is None
    assert tapered in found.unused


@pytest.mark.parametrize("suffix", WRITERS)
@pytest.mark.parametrize("change", [{"TA": 10}, {"tip_diameter": 2}])
def test_a_lollipop_with_a_cone_or_a_flat_is_not_read_without(tmp_path, suffix, change):
    plain = PLAIN | {"shoulder_diameter": 4, "shoulder_length": 20, "LCF": 5}
    found = entry(WRITERS[suffix](tmp_path / f"a.{suffix}", [fusion("lollipop mill", holder=None, **plain | change)]))
    assert (found.cutter, found.broken) == (None, False)
    assert "lollipop" in found.unused


def test_the_largest_diameter_of_a_table_counts(tmp_path):
    path = write_csv(tmp_path / "a.csv", [fusion("face mill", RE=0, TA=0, DCX=9, holder=None, **PLAIN)])
    assert "tool_maximumCuttingDiameter 9" in entry(path).unused


@pytest.mark.parametrize(
    ("shape", "drawing", "read"),
    [
        ("Endmill", "endmill.fcstd", True),
        ("Endmill", "shapes/Endmill.FCStd", True),
        ("Bullnose", "torus.fcstd", True),
        ("VBit", "v-bit.fcstd", True),
        ("Endmill", "ballend.fcstd", False),
        ("Endmill", "taperedballnose.fcstd", False),
        ("Endmill", "of_the_shop.fcstd", False),
        ("VBit", "chamfer.fcstd", False),
    ],
)
def test_a_bit_is_drawn_as_it_is_called(tmp_path, shape, drawing, read):
    """FreeCAD takes the drawing first, and the type only where it has no such drawing."""
    more = {"CornerRadius": "1 mm"} if shape == "Bullnose" else {}
    cone = {"CuttingEdgeAngle": "45 °", "TipDiameter": "1 mm"} if shape == "VBit" else {}
    path = write_bit(tmp_path / "bit.fctb", shape, **more, **cone)
    path.write_text(json.dumps(json.loads(path.read_text(encoding="utf-8")) | {"shape": drawing}), encoding="utf-8")
    found = entry(path, assume_stickout=40.0)
    assert (found.cutter is not None) == read
    assert not found.broken
    if not read:
        assert f"shape-type {shape}" in found.unused.replace("'", "")


@pytest.mark.parametrize("field", ["Radius", "TaperAngle"])
@pytest.mark.parametrize("shape", ["Endmill", "Chamfer"])
def test_a_field_of_another_shape_is_not_ignored(tmp_path, field, shape):
    cone = {"CuttingEdgeAngle": "90 °", "TipDiameter": "1 mm"} if shape == "Chamfer" else {}
    assert bit(tmp_path, shape, **cone, **{field: "0"}).cutter
    found = bit(tmp_path, shape, **cone, **{field: "5"})
    assert (found.cutter, found.broken) == (None, False)
    assert field in found.unused


def test_a_first_section_has_a_lower_end(tmp_path):
    path = tmp_path / "a.hsmlib"
    body = '<body body-length="40" diameter="6" flute-length="12" shaft-diameter="6"/>'
    text = f'<tool-library><tool type="flat end mill" unit="millimeters">{body}<holder>%s</holder></tool></tool-library>'
    path.write_text(text % '<section length="20" diameter="30"/>')
    with pytest.raises(LibraryError, match="no diameter at its lower end"):
        entry(path)
    path.write_text(text % '<section length="0" diameter="24"/><section length="20" diameter="30"/>')
    assert entry(path).cutter.id == "R3L40F12S3HR12:15L20"


def test_a_bull_of_our_own_states_its_corner(tmp_path):
    path = tmp_path / "a.toml"
    text = 'unit = "mm"\n[[tool]]\ntype = "%s"\nDC = 6\nLCF = 12\nLPR = 40\nDMM = 6\nholder = "none"\n'
    path.write_text(text % "bull")
    assert "RE is missing (the radius of its corner)" in entry(path).unused
    path.write_text(text % "bull" + "RE = 1\n")
    assert entry(path).cutter.id == "R3L40rc1F12S3"
    path.write_text(text % "ball" + "RE = 1\n")
    assert "is not half of DC 6" in entry(path).unused


WIDTHS = st.floats(1, 12).map(lambda value: round(value, 3))


def reach(cutter, height):
    """The radius of what stands above the flutes at a height, mm."""
    return max(
        stage.radius + stage.slope * (height - low)
        for part, low, stage in cutter.stages
        if part != "holder" and low <= height <= low + stage.length
    )


@given(
    tip=WIDTHS, neck=st.none() | WIDTHS, height=st.none() | st.floats(12, 40).map(lambda value: round(value, 3)), shank=WIDTHS,
    half=st.sampled_from([0.0, 3.0, 10.0, 25.0]), share=st.floats(0.001, 0.999),
)  # fmt: skip
@settings(max_examples=200, deadline=None)
def test_what_is_judged_above_the_flutes_encloses_each_reading(tmp_path_factory, tip, neck, height, shank, half, share):
    """A shoulder without a diameter is as wide as the tip or as the flutes' end; one without a height has any."""
    path = tmp_path_factory.mktemp("fields") / "a.json"
    plain = {"DC": tip, "RE": 0, "TA": half, "LCF": 12, "LB": 40, "SFDM": shank, "shaft": None, "holder": None}
    top = 0.5 * tip + 12 * math.tan(math.radians(half))
    judged = entry(write_json(path, [fusion("tapered mill", **plain, shoulder_length=height, shoulder_diameter=neck)])).cutter
    assert judged is not None
    at = 12 + 28 * share
    for ends in [12.0, 20.0, 40.0] if height is None and neck else [height or 12.0]:
        for wide in [neck / 2] if neck else [0.5 * tip, top]:
            real = wide if at < ends else 0.5 * shank
            assert reach(judged, at) >= real - 1e-6


def test_each_answer_of_the_page_has_its_test():
    page = (ROOT / "docs" / "tool_fields.md").read_text(encoding="utf-8")
    tests = "".join(path.read_text(encoding="utf-8") for path in (ROOT / "tests" / "library").glob("*.py"))
    named = re.findall(r"\b(test_\w+)(?!\.py)\b", page)
    assert len(set(named)) > 20
    missing = {name for name in named if f"def {name}(" not in tests and not (ROOT / "tests" / "library" / f"{name}.py").exists()}
    assert not missing


@given(st.floats(0.5, 6.0), st.floats(1.0, 20.0), st.floats(10.0, 30.0), st.floats(0.0, 8.0))
def test_a_tapered_ball_nose_of_freecad_is_a_ball_under_a_cone(tmp_path_factory, diameter, whole, flutes, more):
    """Its flank is as wide at each height as a cone that touches the ball; the cone goes on up to the diameter at its top."""
    ball, half = 0.5 * diameter, math.radians(0.5 * whole)
    top = flutes + more
    wide = ball * math.cos(half) + (top - ball * (1 - math.sin(half))) * math.tan(half)
    fields = {"Diameter": f"{diameter!r} mm", "CuttingEdgeHeight": f"{flutes!r} mm", "TaperAngle": f"{whole!r} °",
              "TaperDiameter": f"{2 * wide!r} mm", "Length": "90 mm", "ShankDiameter": f"{2 * wide!r} mm"}  # fmt: skip
    folder = tmp_path_factory.mktemp("bit")
    made = bit(folder, "TaperedBallNose", **fields).cutter
    assert made.radius == made.corner_radius == pytest.approx(ball, abs=1e-6)
    assert made.taper == pytest.approx(half)
    assert made.stages[0][1] == pytest.approx(flutes)
    ends = wide - more * math.tan(half)
    cone = made.stages[0][2]
    if more > 0.01:
        assert (cone.radius, cone.upper_radius, cone.length) == pytest.approx((ends, wide, more), abs=1e-5)
    assert made.stages[-1][2].upper_radius == pytest.approx(wide, abs=1e-5)


@pytest.mark.parametrize(
    ("change", "why"),
    [
        ({"TaperAngle": None}, "TaperAngle is missing"),
        ({"TaperDiameter": "3 mm"}, "TaperDiameter 3 is reached 10.5 mm over its tip"),
        ({"CuttingEdgeAngle": "20 °"}, "CuttingEdgeAngle"),
    ],
)
def test_a_tapered_ball_nose_that_does_not_agree_is_not_read(tmp_path, change, why):
    fields = {"Diameter": "2 mm", "TaperAngle": "6 °", "TaperDiameter": "6 mm", "CuttingEdgeHeight": "25 mm", "Length": "60 mm",
              "ShankDiameter": "6 mm"}  # fmt: skip
    assert bit(tmp_path, "TaperedBallNose", **fields).cutter
    found = bit(tmp_path, "TaperedBallNose", **fields | change)
    assert (found.cutter, found.broken) == (None, False)
    assert why in found.unused
    with pytest.raises(LibraryError, match="TaperDiameter 1 is less than its ball"):
        bit(tmp_path, "TaperedBallNose", **fields | {"TaperDiameter": "1 mm"})


def test_flutes_as_long_as_the_bit_end_at_the_assumed_stick_out(tmp_path):
    fields = {"Diameter": "6 mm", "CuttingEdgeHeight": "50 mm", "Length": "50 mm", "ShankDiameter": "6 mm"}
    path = write_bit(tmp_path / "bit.fctb", "Endmill", **fields)
    found = entry(path, assume_stickout=30.0)
    stated = write_bit(tmp_path / "b.fctb", "Endmill", **fields | {"CuttingEdgeHeight": "30 mm"})
    assert found.cutter.id == entry(stated, assume_stickout=30.0).cutter.id
    assert any("its flutes end at the assumed stick-out, 30 mm" in note for note in found.notes)
    short = write_bit(tmp_path / "c.fctb", "Endmill", **fields | {"CuttingEdgeHeight": "45 mm"})
    assert "shorter than its flutes" in entry(short, assume_stickout=30.0).unused
