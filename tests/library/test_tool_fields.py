"""Where a field is missing or can mean two things, the judged tool is no thinner than any of them, or there is none (docs/tool_fields.md)."""

import math
import sys
import types

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from plan_cutters import Cutter, LibraryError
from plan_cutters.domain.shapes import flute_length
from plan_cutters.library import read_library
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


@pytest.mark.parametrize("field", ["FlatRadius", "TorusRadius"])
@pytest.mark.parametrize("flat", ["0.5 mm", "2.5 mm"])
def test_a_corner_radius_decides_if_the_other_agrees_in_one_reading(tmp_path, field, flat):
    assert bit(tmp_path, CornerRadius="0.5 mm", **{field: flat}).cutter.corner_radius == 0.5
    with pytest.raises(LibraryError, match=f"CornerRadius 0.5 and {field} 1 do not agree"):
        bit(tmp_path, CornerRadius="0.5 mm", **{field: "1 mm"})


def record(cutter):
    """What a plan has of a cutter, as far as a bit needs it."""
    stages = [{"part": part, "radius_mm": stage.radius} for part, _, stage in cutter.stages]
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
    shape, sizes = macro(monkeypatch)["bit_shape"](record(cutter))
    path = write_bit(tmp_path / "bit.fctb", shape, **{name: f"{value:.9g} mm" for name, value in sizes.items()})
    assert entry(path, assume_stickout=40.0).cutter.id == cutter.id


@pytest.mark.parametrize("suffix", WRITERS)
def test_a_shoulder_without_a_diameter_is_as_wide_as_the_flutes_below_it(tmp_path, suffix):
    tool = fusion("tapered mill", DC=2, RE=0, TA=10, LCF=10, LB=30, SFDM=6, **PLAIN | {"shoulder_length": 20})
    found = entry(WRITERS[suffix](tmp_path / f"a.{suffix}", [tool | {"holder": {}}]))
    (low, stage), *_ = [(low, stage) for part, low, stage in found.cutter.stages if part == "neck"]
    assert (low, stage.length) == (10, 10)
    assert stage.radius == pytest.approx(1 + 10 * math.tan(math.radians(10)), abs=1e-6)
    assert "as wide as its flutes where they end, 5.52654" in "; ".join(found.notes)
