"""Reading parts: real files, kernel objects, every bad input one clear line, faces and their shapes."""

import csv
import hashlib
import re

import numpy as np
import pytest
from OCP.BinTools import BinTools
from OCP.BRep import BRep_Builder
from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeEdge, BRepBuilderAPI_MakeFace
from OCP.BRepPrimAPI import BRepPrimAPI_MakePrism, BRepPrimAPI_MakeRevol
from OCP.BRepTools import BRepTools
from OCP.Geom import Geom_BSplineCurve, Geom_CylindricalSurface
from OCP.gp import gp_Ax1, gp_Ax3, gp_Dir, gp_Pnt, gp_Vec
from OCP.IGESControl import IGESControl_Writer
from OCP.Interface import Interface_Static
from OCP.Quantity import Quantity_Color, Quantity_TOC_sRGB
from OCP.STEPCAFControl import STEPCAFControl_Controller, STEPCAFControl_Writer
from OCP.STEPControl import STEPControl_AsIs
from OCP.TColgp import TColgp_Array1OfPnt
from OCP.TCollection import TCollection_ExtendedString
from OCP.TColStd import TColStd_Array1OfInteger, TColStd_Array1OfReal
from OCP.TDataStd import TDataStd_Name
from OCP.TDocStd import TDocStd_Document
from OCP.TopLoc import TopLoc_Location
from OCP.TopoDS import TopoDS_Face, TopoDS_Shape
from OCP.XCAFDoc import XCAFDoc_ColorSurf, XCAFDoc_DocumentTool

from cad_io import Part, ReadError, read_part
from cad_io.errors import CadIoError
from cad_io.kernel import faces, translated
from cad_io.read.document import _name
from cad_io.read.sniff import sniff
from tests.support.cad_parts import (
    CAD,
    as_nurbs,
    ball,
    box,
    compound,
    cone,
    drilled,
    moved,
    patch,
    pocketed,
    real,
    ring,
    rod,
    write_step,
)


def shapes(part):
    return [face.shape for face in part.faces]


# --- real files ------------------------------------------------------------------------------------------------------


def manifest():
    if not (CAD / "MANIFEST.csv").exists():
        return real("MANIFEST.csv")
    with (CAD / "MANIFEST.csv").open() as stream:
        rows = [row for row in csv.DictReader(stream) if (CAD / row["file"]).exists() and row["faces"]]
    return [pytest.param(row, id=row["file"]) for row in rows if int(row["faces"]) < 150]


@pytest.mark.slow("another file of the same law", only=("asitus_ANC101", "occt_linkrods"))
@pytest.mark.parametrize("row", manifest())
def test_real_files_are_read_as_the_manifest_says(row):
    part = read_part(CAD / row["file"])
    assert len(part.faces) == int(row["faces"])
    assert part.solids == int(row["solids"])
    expected = sorted(float(x) for x in row["size_mm"].split("x"))
    assert sorted(part.size) == pytest.approx(expected, rel=2e-3, abs=2e-3)
    assert [f.number for f in part.faces] == list(range(1, len(part.faces) + 1))
    assert all(f.unjudged is None and f.area > 0 for f in part.faces)
    assert part.lost == ()
    assert part.sha256 == row["sha256"]


@pytest.mark.parametrize("path", real("tigl_D150_wing.igs", "occt_bearing.iges"), ids=lambda p: p.name)
def test_sizes_that_are_rather_a_wrong_unit_are_said(path):
    assert any("unit" in warning for warning in read_part(path).warnings)


@pytest.mark.parametrize("path", real("asitus_repatch-hpdc-colored.stp"), ids=lambda p: p.name)
def test_colours_of_faces_are_found(path):
    assert len({face.colour for face in read_part(path).faces} - {None}) == 9


# --- what is read ----------------------------------------------------------------------------------------------------


def test_faces_are_numbered_as_the_kernel_maps_them():
    shape = drilled()
    part = read_part(shape)
    assert all(part.face(n + 1).IsSame(face) for n, face in enumerate(faces(shape)))
    with pytest.raises(IndexError, match="from 1 to 7"):
        part.face(0)


def test_step_iges_and_brep_give_the_same_part(tmp_path):
    shape = drilled()
    step = read_part(write_step(shape, tmp_path / "a.step"))
    BRepTools.Write_s(shape, str(tmp_path / "a.brep"))
    brep = read_part(tmp_path / "a.brep")
    BinTools.Write_s(shape, str(tmp_path / "b.brep"))
    binary = read_part(str(tmp_path / "b.brep"))
    writer = IGESControl_Writer("MM", 0)
    writer.AddShape(shape)
    writer.ComputeModel()
    writer.Write(str(tmp_path / "a.igs"))
    iges = read_part(tmp_path / "a.igs")
    for part in (step, brep, binary, iges):
        assert sorted(shapes(part)) == ["cylinder"] + ["plane"] * 6
        assert sum(f.area for f in part.faces) == pytest.approx(800 + 800 - 18 * np.pi + 60 * np.pi, rel=1e-5)
        assert part.size == pytest.approx((20, 20, 10), abs=1e-5)
    assert (step.solids, brep.solids, binary.solids, iges.solids) == (1, 1, 1, 0)
    assert step.closed
    assert not iges.closed
    assert step.sha256 == hashlib.sha256((tmp_path / "a.step").read_bytes()).hexdigest()


def test_kind_is_told_from_content_not_from_the_name(tmp_path):
    assert len(read_part(write_step(box(), tmp_path / "part.igs")).faces) == 6


def test_objects_with_wrapped_shapes_are_read():
    class Wrapped:
        wrapped = box()

    class Workplane:
        def vals(self):
            return [Wrapped(), Wrapped()]

    assert len(read_part(Wrapped()).faces) == 6
    assert len(read_part(Workplane()).faces) == 6  # the same box twice is the same faces


def test_an_assembly_is_flattened_and_placed(tmp_path):
    one = box(10, 10, 10)
    two = one.Moved(TopLoc_Location(moved(0, by=(100, 0, 0))))
    part = read_part(write_step(compound(one, two), tmp_path / "a.step"))
    assert len(part.faces) == 12
    assert part.size == pytest.approx((110, 10, 10))
    assert part.solids == 2


def test_names_and_colours_of_faces_come_along(tmp_path):
    STEPCAFControl_Controller.Init_s()
    Interface_Static.SetIVal_s("write.stepcaf.subshapes.name", 1)
    shape = compound(box())
    document = TDocStd_Document(TCollection_ExtendedString("XmlXCAF"))
    shape_tool = XCAFDoc_DocumentTool.ShapeTool_s(document.Main())
    label = shape_tool.AddShape(shape, False)
    for i, face in enumerate(faces(shape)[:3]):
        sub = shape_tool.AddSubShape(label, face)
        colour = Quantity_Color(0.1 * i, 0.5, 0.9, Quantity_TOC_sRGB)
        XCAFDoc_DocumentTool.ColorTool_s(document.Main()).SetColor(sub, colour, XCAFDoc_ColorSurf)
        TDataStd_Name.Set_s(sub, TCollection_ExtendedString(f"side {i}"))
    writer = STEPCAFControl_Writer()
    writer.Transfer(document, STEPControl_AsIs)
    writer.Write(str(tmp_path / "a.step"))
    part = read_part(tmp_path / "a.step")
    assert [f.name for f in part.faces] == ["side 0", "side 1", "side 2", "", "", ""]
    for i, face in enumerate(part.faces[:3]):
        assert face.colour == pytest.approx((0.1 * i, 0.5, 0.9), abs=2e-3)
    assert part.faces[5].colour is None


# --- shapes and areas ------------------------------------------------------------------------------------------------


def spline_curve(points):
    poles = TColgp_Array1OfPnt(1, len(points))
    for i, p in enumerate(points):
        poles.SetValue(i + 1, gp_Pnt(*map(float, p)))
    from OCP.GeomAPI import GeomAPI_PointsToBSpline

    return GeomAPI_PointsToBSpline(poles).Curve()


@pytest.mark.parametrize("convert", [lambda s: s, as_nurbs], ids=["as made", "as B-splines"])
@pytest.mark.parametrize(
    ("shape", "expected"),
    [
        (ball(), {"sphere": 400 * np.pi}),
        (ring(), {"torus": 4 * np.pi**2 * 100}),
        (rod(), {"cylinder": 200 * np.pi, "plane": 50 * np.pi}),
        (cone(), {"cone": 8 * np.pi * np.hypot(8, 10), "plane": 64 * np.pi}),
        (cone(8, 4), {"cone": 12 * np.pi * np.hypot(4, 10), "plane": 80 * np.pi}),
        (pocketed(), {"sphere": 50 * np.pi, "plane": 1600 - 25 * np.pi}),
    ],
    ids=["ball", "ring", "rod", "cone", "cut cone", "pocket"],
)
def test_simple_shapes_are_recognised_with_their_area(shape, expected, convert):
    part = read_part(convert(shape))
    found = {}
    for face in part.faces:
        found[face.shape] = found.get(face.shape, 0.0) + face.area
    assert found == pytest.approx(expected, rel=1e-4)


def test_shapes_do_not_depend_on_placement():
    for shape in (ball(), ring(), cone(8, 4), rod()):
        here = read_part(as_nurbs(shape))
        there = read_part(as_nurbs(shape.Moved(TopLoc_Location(moved()))))
        assert shapes(here) == shapes(there)
        assert [f.area for f in here.faces] == pytest.approx([f.area for f in there.faces])


def test_simple_shapes_behind_extrusion_and_revolution_are_recognised():
    line = BRepBuilderAPI_MakeEdge(spline_curve([(0, 0, 0), (1, 0, 0), (2, 0, 0), (3, 0, 0), (5, 0, 0)])).Edge()
    flat = read_part(BRepPrimAPI_MakePrism(line, gp_Vec(0, 0, 7)).Shape())
    assert (flat.faces[0].shape, flat.faces[0].area) == ("plane", pytest.approx(35))
    axis = gp_Ax1(gp_Pnt(0, 4, 0), gp_Dir(1, 0, 0))
    round_ = read_part(BRepPrimAPI_MakeRevol(line, axis).Shape())
    assert (round_.faces[0].shape, round_.faces[0].area) == ("cylinder", pytest.approx(40 * np.pi))


@pytest.mark.parametrize("convert", [lambda s: s, as_nurbs], ids=["turned", "nurbs"])
@pytest.mark.parametrize("height", [0.0, 0.0005, 0.27])
def test_a_ridge_between_the_nodes_is_no_cylinder(height, convert):
    """1 m long, the ridge 4 mm wide: an axis through none of the nodes that are looked at first."""
    curve = ridge(1000.0, 4.0, height)
    axis = gp_Ax1(gp_Pnt(0, 0, -50), gp_Dir(1, 0, 0))
    part = read_part(convert(BRepPrimAPI_MakeRevol(BRepBuilderAPI_MakeEdge(curve).Edge(), axis, 1.0).Shape()))
    assert [f.shape for f in part.faces] == ["sculptured" if height > 0.1 else "cylinder"]


def ridge(length, width, height):
    """A straight cubic B-spline along x with a ridge at 0.37 of its length: nothing of it reaches farther."""
    at = 0.37 * length
    knots = np.array([0.0, *(at + width * np.array([-0.5, -0.25, 0.0, 0.25, 0.5])), length])
    greville = np.convolve(np.repeat(knots, [4, 1, 1, 1, 1, 1, 4])[1:-1], np.ones(3) / 3, mode="valid")
    pole = TColgp_Array1OfPnt(1, len(greville))
    for i, x in enumerate(greville.tolist(), 1):
        pole.SetValue(i, gp_Pnt(x, 0, 1.5 * height if abs(x - at) < 1e-9 else 0.0))
    values, times = TColStd_Array1OfReal(1, 7), TColStd_Array1OfInteger(1, 7)
    for i, (knot, count) in enumerate(zip(knots.tolist(), [4, 1, 1, 1, 1, 1, 4], strict=True), 1):
        values.SetValue(i, knot)
        times.SetValue(i, count)
    return Geom_BSplineCurve(pole, values, times, 3)


def test_area_of_an_extruded_spline():
    # The kernel's own figure is percents off on surfaces of extrusion.
    t = np.linspace(0, 2 * np.pi, 40)
    curve = spline_curve(np.column_stack([10 * t, 8 * np.sin(t), 0 * t]))
    assert isinstance(curve, Geom_BSplineCurve)
    fine = np.array([curve.Value(x).Coord() for x in np.linspace(curve.FirstParameter(), curve.LastParameter(), 20001)])
    length = np.linalg.norm(np.diff(fine, axis=0), axis=1).sum()
    part = read_part(BRepPrimAPI_MakePrism(BRepBuilderAPI_MakeEdge(curve).Edge(), gp_Vec(0, 0, 30)).Shape())
    assert part.faces[0].surface == "extrusion"
    assert part.faces[0].shape == "sculptured"
    assert part.faces[0].area == pytest.approx(30 * length, rel=1e-4)


def test_nearly_simple_is_sculptured():
    assert shapes(read_part(patch())) == ["sculptured"]
    assert shapes(read_part(patch(height=1e-5))) == ["plane"]
    assert shapes(read_part(patch(height=0.1))) == ["sculptured"]


def test_faces_that_cannot_be_judged_say_why():
    builder = BRep_Builder()
    bare, edgeless = TopoDS_Face(), TopoDS_Face()
    builder.MakeFace(bare)
    builder.MakeFace(edgeless, Geom_CylindricalSurface(gp_Ax3(), 3.0), TopLoc_Location(), 1e-6)
    part = read_part(compound(box(), bare, edgeless))
    assert [f.unjudged for f in part.faces[:6]] == [None] * 6
    assert all(f.unjudged for f in part.faces[6:])
    assert part.faces[7].unjudged == "has no edges and no end: bound it"


# --- bad input -------------------------------------------------------------------------------------------------------


def fails(source, match):
    with pytest.raises(ReadError, match=match) as caught:
        read_part(source)
    text = str(caught.value)
    assert "\n" not in text
    assert len(text) < 500
    return caught.value


@pytest.mark.parametrize(
    ("name", "content", "match"),
    [
        ("a.step", b"", "is empty"),
        ("a.step", b" \n\n", "is empty"),
        ("a.step", b"The part is in the mail.\n", "does not start as STEP does"),
        ("a.igs", b"ISO-10303-22;\n", "does not start as IGES does"),
        ("a.step", b"<!DOCTYPE html><html></html>", "web page"),
        ("a.stp", bytes(range(128, 256)) * 40, "does not start as STEP does"),
        ("a.dat", b"\x00" * 100, "not a CAD file"),
        ("a.step", b"\x1f\x8b\x08\x00aaaa", "compressed"),
        ("a.step", b"PK\x03\x04aaaa", "zip"),
        ("a.sldprt", b"\xd0\xcf\x11\xe0aaaa", "native CAD"),
        ("a.step", b"version https://git-lfs.github.com/spec/v1\noid sha256:00\n", "git lfs pull"),
        ("a.stl", b"solid thing\nfacet normal 0 0 1\n", "mesh"),
        ("a.step", b"\xef\xbb\xbfISO-10303-21;\nHEADER;\n", "byte-order mark"),
        ("a.step", b"ISO-10303-21;\nHEADER;\n", "cut off"),
        ("a.step", b"ISO-10303-21;\nHEADER;\nENDSEC;\nDATA;\n#1=((;\nENDSEC;\nEND-ISO-10303-21;\n", "not valid STEP"),
        ("a.brep", b"CASCADE Topology V1, (c) Matra-Datavision\nLocations 1\n", "BREP|kernel failed|no face"),
    ],
)  # fmt: skip
def test_what_is_not_a_part_is_said_in_one_line(tmp_path, name, content, match):
    (tmp_path / name).write_bytes(content)
    error = fails(tmp_path / name, match)
    assert error.file == str(tmp_path / name)


def test_missing_file_and_folder(tmp_path):
    fails(tmp_path / "no.step", "no such file")
    fails(tmp_path, "is a folder")


def test_objects_that_are_no_parts():
    class Empty:
        wrapped = None

    fails(3.5, "float is not a part")
    fails(Empty(), "holds no shape")
    fails(TopoDS_Shape(), "holds no shape")
    fails(BRepBuilderAPI_MakeEdge(gp_Pnt(0, 0, 0), gp_Pnt(1, 0, 0)).Edge(), "holds no surface")


@pytest.fixture
def step_text(tmp_path):
    return write_step(drilled(), tmp_path / "whole.step").read_text()


@pytest.mark.parametrize(
    ("change", "match"),
    [
        (lambda t: t[: len(t) * 6 // 10], "cut off"),
        (lambda t: re.sub(r"(CARTESIAN_POINT\('',\()[^,]*", r"\1NaN", t, count=3), "faulty STEP"),
        (lambda t: re.sub(r"#\d+ = ADVANCED_BREP_SHAPE_REP[^;]*;", "", t), "faulty STEP|no shape|no surface"),
    ],
    ids=["cut", "nan", "no shape"],
)
def test_faulty_step_is_refused_before_it_can_hang(tmp_path, step_text, change, match):
    (tmp_path / "bad.step").write_text(change(step_text))
    fails(tmp_path / "bad.step", match)


def test_faces_lost_on_the_way_are_told(tmp_path):
    text = write_step(as_nurbs(rod()), tmp_path / "whole.step").read_text()
    # More poles told by the knots than there are: the kernel drops the face without a word.
    broken, count = re.subn(r"(B_SPLINE_SURFACE_WITH_KNOTS\(\()\d+", r"\g<1>9", text)
    assert count >= 1
    (tmp_path / "bad.step").write_text(broken)
    part = read_part(tmp_path / "bad.step")
    assert len(part.faces) == 2
    assert [(each.entity, each.face) for each in part.lost] == [("#17", None)]


def test_iges_that_was_cut_off_is_refused(tmp_path):
    writer = IGESControl_Writer("MM", 0)
    writer.AddShape(as_nurbs(ball()))
    writer.ComputeModel()
    writer.Write(str(tmp_path / "whole.igs"))
    lines = (tmp_path / "whole.igs").read_text().splitlines(keepends=True)
    (tmp_path / "cut.igs").write_text("".join(lines[: len(lines) * 7 // 10]))
    fails(tmp_path / "cut.igs", "cut off")
    (tmp_path / "holes.igs").write_text("".join(lines[:20] + lines[30:]))
    fails(tmp_path / "holes.igs", "missing lines")


@pytest.mark.parametrize(
    "path",
    real(
        "derived/empty.step", "derived/html_as.step", "derived/trunc50_tigl_nacelle.stp", "pygeo_c172.igs",
        "derived/trunc60_occt_linkrods.step", "derived/trunc70_bladex_upper.iges",
    ),
    ids=lambda p: p.name,
)  # fmt: skip
def test_real_files_that_are_no_parts(path):
    fails(path, "empty|web page|cut off|could be read")


def test_reading_prints_nothing(tmp_path, step_text, capfd):
    (tmp_path / "a.step").write_text(step_text)
    read_part(tmp_path / "a.step")
    (tmp_path / "b.step").write_text(step_text.replace("VERTEX_POINT", "VERTEX_PAINT", 1))
    assert read_part(tmp_path / "b.step").lost
    (tmp_path / "c.step").write_text(re.sub(r"(VERTEX_POINT[^;]*;[^(]*\('',\()[^,]*", r"\1NaN", step_text, count=1))
    fails(tmp_path / "c.step", "faulty")
    captured = capfd.readouterr()
    assert captured.out == ""
    assert captured.err == ""


def test_kernel_errors_are_translated_with_their_place():
    place = {"file": "part.step", "face": "F3"}
    match = r"^part\.step: F3: .*while testing \(Standard_NoSuchObject"
    with pytest.raises(CadIoError, match=match) as caught, translated("testing", **place):
        Part(box()).adaptor(1).Cylinder()
    assert caught.value.face == "F3"
    with pytest.raises(KeyError), translated("testing"):
        raise KeyError("not the kernel's")


def test_sniffing_skips_comments_before_the_keyword():
    assert sniff(b"/* made by hand */\nISO-10303-21;\n", "a") == "step"


def test_trimmed_planes_without_size_are_not_parts():
    from OCP.gp import gp_Pln

    fails(BRepBuilderAPI_MakeFace(gp_Pln()).Face(), "has no edges and no end|no surface")


@pytest.mark.parametrize(("written", "told"), [("Blade", "Blade"), ("NONE", ""), ("=>[0:1:1:2]", ""), ("=>[a]", "=>[a]")])
def test_words_that_programs_write_for_no_name_are_none(written, told):
    document = TDocStd_Document(TCollection_ExtendedString("XmlXCAF"))
    TDataStd_Name.Set_s(document.Main(), TCollection_ExtendedString(written))
    assert _name(document.Main()) == told
