"""A length unit given instead of the file's: the numbers stay, their unit changes; placements and names with them."""

import json
import re

import pytest
from OCP.BinTools import BinTools
from OCP.BRepTools import BRepTools
from OCP.IGESControl import IGESControl_Writer
from OCP.STEPControl import STEPControl_AsIs, STEPControl_Writer
from OCP.TopLoc import TopLoc_Location

from cad_io import ReadError, read_part
from cad_io.kernel import faces
from cad_io.units import UNITS
from plan_cutters import Cutter, plan
from plan_cutters.errors import OptionError
from tests.support.cad_parts import box, compound, drilled, loose, moved, real
from tests.support.commands import in_lines
from tests.support.forked import run


def pair():
    """Two instances of one solid, turned and moved."""
    return compound(drilled(), drilled().Moved(TopLoc_Location(moved(by=(50, 10, -20)))))


@pytest.fixture(params=["step mm", "step cm", "iges mm", "iges in", "brep", "binary brep", "shape"])
def source(request, tmp_path):
    """The pair as a file or shape, and what its unit is in mm."""
    kind, _, unit = request.param.partition(" ")
    path = tmp_path / "part"
    if kind == "step":
        writer = STEPControl_Writer()
        writer.Transfer(pair(), STEPControl_AsIs)
        writer.Write(str(path))
        prefix = {"mm": ".MILLI.", "cm": ".CENTI."}[unit]
        text, count = re.subn(r"SI_UNIT\(\.MILLI\.,\.METRE\.\)", f"SI_UNIT({prefix},.METRE.)", path.read_text())
        assert count
        path.write_text(text)
    elif kind == "iges":
        writer = IGESControl_Writer(unit.upper(), 0)
        writer.AddShape(pair())
        writer.ComputeModel()
        writer.Write(str(path))
    elif request.param == "brep":
        BRepTools.Write_s(pair(), str(path))
    elif request.param == "binary brep":
        BinTools.Write_s(pair(), str(path))
    else:
        path = pair()
    return path, UNITS.get(unit, 1.0)


@pytest.mark.slow("another unit of the same law", but=("step mm", "iges in-mm", "iges in-in"))
@pytest.mark.parametrize("unit", ["mm", "in", "m", "um"])
def test_lengths_are_as_if_written_in_the_unit(source, unit):
    path, written = source
    own, given = read_part(path), read_part(path, unit=unit)
    scale = UNITS[unit] / written
    assert given.size == pytest.approx([scale * length for length in own.size], rel=1e-6)
    assert len(given.faces) == len(own.faces) == 14
    # Face by face, so that numbers stay and both instances are in their places.
    for mine, other in zip(given.faces, own.faces, strict=True):
        assert (mine.shape, mine.area) == (other.shape, pytest.approx(scale**2 * other.area, rel=1e-5))
        flux = scale**3 * own.measure(mine.number).flux
        assert given.measure(mine.number).flux == pytest.approx(flux, rel=1e-4, abs=1e-4 * scale**3)
    assert given.solids == own.solids


def test_giving_a_unit_changes_no_later_reading(source):
    path, _ = source
    before = read_part(path).size
    read_part(path, unit="ft")
    assert read_part(path).size == pytest.approx(before)


def test_units_that_do_not_exist_are_refused():
    with pytest.raises(ReadError, match=r"'parsec'.*um, mm, cm"):
        read_part(box(), unit="parsec")


def test_an_odd_size_names_what_would_right_it():
    assert "--unit" in read_part(box(0.1, 0.1, 0.1)).warnings[0]
    assert read_part(box(0.1, 0.1, 0.1), unit="m").warnings == ()


@pytest.mark.parametrize("path", real("occt_bearing.iges"), ids=lambda p: p.name)
def test_a_real_file_with_a_wrong_unit(path):
    part = read_part(path, unit="m")
    assert part.size == pytest.approx((100.977, 121.977, 31.3517), rel=1e-4)
    assert part.warnings == ()


@pytest.mark.parametrize("path", real("trimesh_featuretype.STEP", "axom_boxed_sphere.step"), ids=lambda p: p.name)
def test_real_units_are_told(path):
    assert read_part(path, unit={".STEP": "in", ".step": "cm"}[path.suffix]).size == pytest.approx(read_part(path).size)


def test_the_command_takes_a_unit_and_says_the_side_in_its_summary(tmp_path):
    lidless = compound(*faces(loose(box(0.3, 0.3, 0.3)))[1:])
    BRepTools.Write_s(lidless, str(tmp_path / "part.brep"))
    words = ("part.brep", "--faces", "all", "--cutter", "R1L20", "--grid", "4", "--formats", "json", "--unit", "in")
    done = run(*words, "-v", cwd=tmp_path)
    said = in_lines(done.stdout)
    side = said[said.index("Side of the material:") :]
    assert "towards the given direction" in side
    assert "a weak guess" in side
    assert "Faces were joined at" in side
    assert "Open edges: 4, 30.48 mm long" in side
    assert "--flip" in said
    plan = json.loads((tmp_path / "part-plan" / "plan.json").read_text())
    assert plan["effective"]["unit"] == "in"
    assert plan["part"]["size_mm"] == pytest.approx([7.62] * 3)
    assert not plan["part"]["orientation"]["confident"]
    assert plan["part"]["sewing"]["open_edges"] == 4
    assert plan["part"]["sewing"]["open_length_mm"] == pytest.approx(30.48)
    assert run("part.brep", "--unit", "parsec", cwd=tmp_path).returncode == 2


def test_a_part_that_was_read_has_its_unit():
    with pytest.raises(OptionError, match="read_part"):
        plan(read_part(box()), unit="in")
    with pytest.raises(OptionError, match="parsec"):
        plan(box(), unit="parsec")
    result = plan(box(0.3, 0.3, 0.3), unit="in", faces="all", grid=4, cutters=[Cutter.flat(radius=1, length=20)])
    assert result.plan.part.sewing is None
    assert result.plan.part.size_mm == pytest.approx((7.62,) * 3)
