"""STEP files whose solids belong to no product: read all the same, with a warning, and with a doubt where no unit is stated."""

import re

import pytest
from OCP.STEPControl import STEPControl_AsIs, STEPControl_Writer

from cad_io import ReadError, read_part
from tests.support.cad_parts import box, compound, drilled
from tests.support.places import real_file

_PRODUCT = re.compile(r"#\d+ ?= ?(?:APPLICATION_\w+|SHAPE_DEFINITION_REPRESENTATION|PRODUCT\w*|PRODUCT_DEFINITION\w*)\([^;]*;\s*")
_REPRESENTATION = re.compile(r"#\d+ ?= ?\w*SHAPE_REPRESENTATION\([^;]*;\s*")
_CONTEXT = re.compile(r"#\d+ ?= ?\([^;]*GLOBAL_UNIT_ASSIGNED_CONTEXT[^;]*;\s*")
_ASSEMBLY = re.compile(
    r"#\d+ ?= ?(?:(?:NEXT_ASSEMBLY|CONTEXT_DEPENDENT|ITEM_DEFINED)\w*\(|\([^;]*REPRESENTATION_RELATIONSHIP\()[^;]*;\s*"
)


def stripped(shape, path, *kinds, unit=".MILLI."):
    """A STEP without some kinds of entities."""
    writer = STEPControl_Writer()
    writer.Transfer(shape, STEPControl_AsIs)
    writer.Write(str(path))
    text = path.read_text().replace(".MILLI.,.METRE.", f"{unit},.METRE.")
    for kind in kinds:
        text, count = kind.subn("", text)
        assert count
    path.write_text(text)
    return path


def test_a_solid_in_a_representation_keeps_its_unit(tmp_path):
    path = stripped(drilled(), tmp_path / "part.step", _PRODUCT, unit=".CENTI.")
    part, whole = read_part(path), read_part(drilled())
    assert part.size == pytest.approx([10.0 * length for length in whole.size])
    assert (part.solids, len(part.faces)) == (1, len(whole.faces))
    assert part.lost == ()
    assert part.unit_doubt == ""
    assert any("no product leads to #" in text for text in part.warnings)


@pytest.mark.parametrize(("unit", "factor"), [(".MILLI.", 1.0), (".CENTI.", 10.0)])
def test_a_solid_in_none_has_the_only_unit_of_the_file_and_a_doubt(tmp_path, unit, factor):
    path = stripped(drilled(), tmp_path / "part.step", _PRODUCT, _REPRESENTATION, _CONTEXT, unit=unit)
    part = read_part(path)
    assert part.size == pytest.approx([factor * length for length in read_part(drilled()).size])
    assert part.lost == ()
    assert "its unit is in doubt (no unit is stated for #" in part.unit_doubt
    assert read_part(path, unit="in").size == pytest.approx([25.4 * length for length in read_part(drilled()).size])
    assert read_part(path, unit="in").unit_doubt == ""


def test_all_solids_are_read_and_the_places_of_an_assembly_are_missed(tmp_path):
    whole = compound(drilled(), box(3, 3, 3, at=(90, 0, 0)))
    part = read_part(stripped(whole, tmp_path / "part.step", _PRODUCT))
    assert part.solids == 2
    assert all("has not been placed" in each.why for each in part.lost)
    assert part.lost
    bare = read_part(stripped(whole, tmp_path / "bare.step", _PRODUCT, _REPRESENTATION, _CONTEXT, _ASSEMBLY))
    assert bare.solids == 2
    assert bare.lost == ()


def test_a_file_without_a_solid_is_refused_as_before(tmp_path):
    path = stripped(drilled(), tmp_path / "part.step", _PRODUCT, _REPRESENTATION, re.compile(r"#\d+ ?= ?MANIFOLD[^;]*;\s*"))
    with pytest.raises(ReadError, match="holds no shape that can be read"):
        read_part(path)


def test_a_step_that_states_no_unit_is_a_doubt(tmp_path):
    path = stripped(drilled(), tmp_path / "part.step")
    text, count = re.subn(r"GLOBAL_UNIT_ASSIGNED_CONTEXT\s*\(\([^)]*\)\)", "", path.read_text())
    assert count
    path.write_text(text)
    part = read_part(path)
    assert part.size == pytest.approx(read_part(drilled()).size)
    assert "no unit is stated" in part.unit_doubt


def test_a_real_file_with_a_solid_and_no_product():
    part = read_part(real_file("trials/obl2055_noproduct.step"))
    assert part.size == pytest.approx((40.0, 40.0, 20.0), rel=1e-6)
    assert part.solids == 1
    assert "#15" in part.unit_doubt
