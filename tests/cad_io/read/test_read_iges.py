"""IGES: names, colours and levels of faces, faces as the kernel's own reader gives them, and at its pace."""

import time

import pytest
from OCP.IGESCAFControl import IGESCAFControl_Writer
from OCP.IGESControl import IGESControl_Reader
from OCP.Interface import Interface_Static
from OCP.Quantity import Quantity_Color, Quantity_TOC_sRGB
from OCP.TCollection import TCollection_ExtendedString
from OCP.TDataStd import TDataStd_Name
from OCP.TDocStd import TDocStd_Document
from OCP.XCAFDoc import XCAFDoc_ColorSurf, XCAFDoc_DocumentTool, XCAFDoc_ShapeTool

from cad_io import read_part
from cad_io.errors import ReadError
from cad_io.kernel import faces
from tests.support.cad_parts import CAD, box, compound, drilled, real

COLOURS = ((0.1, 0.5, 0.9), (1.0, 0.0, 0.0), (0.0, 0.0, 1.0))  # the last two are numbers of the standard


@pytest.fixture(params=[True, False], ids=["named", "unnamed"])
def naming(request):
    """Whether the kernel names shapes by itself, in all documents of the process: cadquery's exports turn that off for good."""
    before = XCAFDoc_ShapeTool.AutoNaming_s()
    XCAFDoc_ShapeTool.SetAutoNaming_s(request.param)
    yield
    XCAFDoc_ShapeTool.SetAutoNaming_s(before)


@pytest.fixture(params=[0, 1], ids=["surfaces", "solid"])
def painted(request, naming, tmp_path):
    """A file with three faces coloured, named and on levels of their own, and the shape."""
    shape = compound(drilled())
    document = TDocStd_Document(TCollection_ExtendedString("XmlXCAF"))
    shapes, colours, layers = (
        getattr(XCAFDoc_DocumentTool, f"{tool}Tool_s")(document.Main()) for tool in ("Shape", "Color", "Layer")
    )
    root = shapes.AddShape(shape, False)
    # The kernel's writer leaves out all names below a shape that has none.
    TDataStd_Name.Set_s(root, TCollection_ExtendedString("part"))
    for i, (face, colour) in enumerate(zip(faces(shape), COLOURS, strict=False)):
        label = shapes.AddSubShape(root, face)
        colours.SetColor(label, Quantity_Color(*colour, Quantity_TOC_sRGB), XCAFDoc_ColorSurf)
        TDataStd_Name.Set_s(label, TCollection_ExtendedString(f"side number {i}"))
        layers.SetLayer(label, TCollection_ExtendedString(str(10 + i)))
    writer = IGESCAFControl_Writer()
    before = Interface_Static.IVal_s("write.iges.brep.mode")
    try:
        Interface_Static.SetIVal_s("write.iges.brep.mode", request.param)
        writer.Transfer(document)
        writer.ComputeModel()
        writer.Write(str(tmp_path / "painted.igs"))
    finally:
        Interface_Static.SetIVal_s("write.iges.brep.mode", before)
    return tmp_path / "painted.igs", shape


def test_names_colours_and_levels_come_along(painted):
    path, _ = painted
    part = read_part(path)
    assert [face.name for face in part.faces] == ["side number 0", "side number 1", "side number 2", *[""] * 4]
    for face, colour in zip(part.faces, COLOURS, strict=False):
        assert face.colour == pytest.approx(colour, abs=1e-4)
    assert [face.colour for face in part.faces[3:]] == [None] * 4
    assert part.layers == {1: ("10",), 2: ("11",), 3: ("12",)}
    assert part.warnings == ()


def test_labels_without_long_names_are_names(painted, tmp_path):
    path, _ = painted
    lines = path.read_text().splitlines()
    for i, line in enumerate(lines):
        if line[72] == "D" and line.startswith("     406"):  # properties: long names become something else
            lines[i] = line.replace("      15 ", "      99 ", 1)
    (tmp_path / "labels.igs").write_text("\n".join(lines) + "\n")
    assert [face.name for face in read_part(tmp_path / "labels.igs").faces] == ["side num"] * 3 + [""] * 4


def test_a_name_that_is_not_ascii_is_no_error(painted, tmp_path):
    path, _ = painted
    (tmp_path / "odd.igs").write_bytes(path.read_bytes().replace(b"side number 1", b"side numb\xe9r 1"))
    part = read_part(tmp_path / "odd.igs")
    assert part.faces[0].name == "side number 0"
    assert len(part.faces) == 7


@pytest.mark.parametrize("path", real("tigl_D150_wing.igs"), ids=lambda p: p.name)
def test_real_names(path):
    text = path.read_text()
    part = read_part(path)
    assert all(face.name and face.name in text for face in part.faces)
    assert {face.name for face in part.faces} >= {"Top", "Bottom"}


@pytest.mark.slow("another file of the same law", only=("occt_bearing",))
@pytest.mark.parametrize("path", sorted(CAD.glob("*.ig*s")) or real("*.igs"), ids=lambda p: p.name)
def test_faces_are_numbered_as_the_kernels_reader_gives_them(path):
    reader = IGESControl_Reader()
    reader.ReadFile(str(path))
    reader.TransferRoots()
    shape = reader.OneShape()
    if shape.IsNull():
        with pytest.raises(ReadError):
            read_part(path)
        return
    part, plain = read_part(path), read_part(shape)
    assert [f.area for f in part.faces] == [f.area for f in plain.faces]
    assert [f.surface for f in part.faces] == [f.surface for f in plain.faces]


@pytest.mark.slow("times the kernel, five runs each")
def test_reading_takes_little_longer_than_the_kernel_alone(tmp_path):
    from OCP.IGESControl import IGESControl_Writer

    writer = IGESControl_Writer("MM", 0)
    writer.AddShape(compound(*(box(at=(20 * i, 0, 0)) for i in range(300))))
    writer.ComputeModel()
    writer.Write(str(tmp_path / "many.igs"))

    def kernel():
        reader = IGESControl_Reader()
        reader.ReadFile(str(tmp_path / "many.igs"))
        reader.TransferRoots()
        reader.OneShape()

    def seconds(call):
        began = time.perf_counter()
        call()
        return time.perf_counter() - began

    both = [(seconds(kernel), seconds(lambda: read_part(tmp_path / "many.igs"))) for _ in range(5)]
    alone, ours = (min(column) for column in zip(*both, strict=True))
    assert ours < 1.2 * alone
