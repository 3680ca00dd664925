"""STEP of split parts: names and colours per piece in two readers, one of them without the CAD kernel; same bytes."""

import re
from pathlib import Path

import numpy as np
import pytest
from OCP.BRepAlgoAPI import BRepAlgoAPI_Cut
from OCP.BRepBuilderAPI import BRepBuilderAPI_Transform
from OCP.BRepCheck import BRepCheck_Analyzer
from OCP.BRepPrimAPI import BRepPrimAPI_MakeBox, BRepPrimAPI_MakeCylinder
from OCP.gp import gp_Ax2, gp_Dir, gp_Pnt, gp_Trsf, gp_Vec
from OCP.IFSelect import IFSelect_RetDone
from OCP.Interface import Interface_Static
from OCP.Quantity import Quantity_Color, Quantity_TOC_sRGB
from OCP.ShapeCustom import ShapeCustom
from OCP.STEPCAFControl import STEPCAFControl_Reader, STEPCAFControl_Writer
from OCP.TCollection import TCollection_ExtendedString
from OCP.TDataStd import TDataStd_Name
from OCP.TDF import TDF_Label, TDF_LabelSequence
from OCP.TDocStd import TDocStd_Document
from OCP.TopAbs import TopAbs_SHELL
from OCP.TopLoc import TopLoc_Location
from OCP.XCAFDoc import XCAFDoc_ColorSurf, XCAFDoc_DocumentTool, XCAFDoc_ShapeTool

from cad_io import read_part
from cad_io.arrays import Style
from cad_io.errors import WriteError
from cad_io.kernel import explore, faces
from cad_io.kernel.shapes import Node, compound
from cad_io.part import Part
from cad_io.split.pieces import Split, split
from cad_io.write import write_step
from tests.support.cad_parts import ball, triangulated
from tests.support.split_parts import GREEN, GREY, RED, block, labels, largest_bspline, patch

COLOURS = {0: RED, 1: GREEN, -1: GREY}


def style(piece):
    return Style(f"F{piece.face}_{'_'.join(['grey', 'red', 'green'][piece.label + 1 :][:1])}", COLOURS[piece.label])


class Nameless(STEPCAFControl_Writer):
    """A writer of the kernel that forgets the names of faces."""

    def Write(self, name):
        done, path = super().Write(name), Path(name)
        path.write_bytes(re.sub(rb"(= ADVANCED_FACE)\('[^']*'", rb"\1(''", path.read_bytes()))
        return done


@pytest.fixture(scope="module")
def halves() -> Split:
    part = Part(block(1))
    return split(part, [labels(part, largest_bspline(part), lambda x, y: x > 0.4 + 0.3 * y)])


def parse(path: Path) -> dict[int, str]:
    """Entities of a Part-21 file, number -> text, read as text alone."""
    text = path.read_text("ascii")
    data = text[text.index("DATA;") + 5 : text.rindex("ENDSEC;")]
    found = re.finditer(r"#(\d+)\s*=\s*((?:'(?:[^']|'')*'|[^';])*);", data)
    return {int(m[1]): re.sub(r"\s+", " ", m[2].strip()) for m in found}


def references(text: str) -> list[int]:
    return [int(n) for n in re.findall(r"#(\d+)", text)]


def colour(entities: dict[int, str], number: int) -> tuple[float, ...] | None:
    text = entities[number]
    if text.startswith("COLOUR_RGB"):
        return tuple(float(x) for x in text.split("',")[1].rstrip(") ").split(","))
    return next(filter(None, (colour(entities, n) for n in references(text))), None)


def styled_faces(path: Path) -> list[tuple[str, tuple[float, ...]]]:
    """(name, colour) of every face, sorted."""
    entities = parse(path)
    styles = {}
    for text in entities.values():
        if text.startswith(("STYLED_ITEM", "OVER_RIDING_STYLED_ITEM")):
            names = re.search(r"\((#[^)]*)\)", text.split("(", 1)[1])[1]
            target = references(text)[len(references(names))]
            styles[target] = colour(entities, references(names)[0])
    found = {n: t for n, t in entities.items() if t.startswith("ADVANCED_FACE")}
    return sorted((re.search(r"'([^']*)'", text)[1], styles[n]) for n, text in found.items())


def expected(found: Split) -> list[tuple[str, tuple[float, ...]]]:
    return sorted(tuple(style(p)[:2]) for p in found.pieces)


def same(a, b) -> bool:
    return [n for n, _ in a] == [n for n, _ in b] and np.allclose([c for _, c in a], [c for _, c in b], atol=1e-5)


def read_back(path: Path):
    """(shape, sorted (name, colour) of faces) by the kernel's reader."""
    before = Interface_Static.IVal_s("read.stepcaf.subshapes.name")
    document = TDocStd_Document(TCollection_ExtendedString("BinXCAF"))
    reader = STEPCAFControl_Reader()
    Interface_Static.SetIVal_s("read.stepcaf.subshapes.name", 1)
    try:
        assert reader.ReadFile(str(path)) == IFSelect_RetDone
        assert reader.Transfer(document)
    finally:
        Interface_Static.SetIVal_s("read.stepcaf.subshapes.name", before)
    shapes = XCAFDoc_DocumentTool.ShapeTool_s(document.Main())
    roots = TDF_LabelSequence()
    shapes.GetFreeShapes(roots)
    assert roots.Length() == 1
    shape = shapes.GetShape_s(roots.Value(1))
    products = []
    components_of = TDF_LabelSequence()
    shapes.GetComponents_s(roots.Value(1), components_of)
    for component in components_of:
        product = TDF_Label()
        shapes.GetReferredShape_s(component, product)
        products.append(product)
    out = []
    for product, face in [(p, f) for p in products or [roots.Value(1)] for f in faces(shapes.GetShape_s(p))]:
        label, name = shapes.FindShape(face, False), TDataStd_Name()
        children = TDF_LabelSequence()
        if label.IsNull():
            shapes.GetSubShapes_s(product, children)
            label = next(c for c in children if shapes.GetShape_s(c).IsSame(face))
        assert label.IsAttribute(TDataStd_Name.GetID_s())
        label.FindAttribute(TDataStd_Name.GetID_s(), name)
        rgb = Quantity_Color()
        assert XCAFDoc_DocumentTool.ColorTool_s(document.Main()).GetColor_s(label, XCAFDoc_ColorSurf, rgb)
        out.append((name.Get().ToExtString(), rgb.Values(Quantity_TOC_sRGB)))
    return shape, sorted(out)


@pytest.mark.parametrize("schema", ["AP242DIS", "AP214IS"])
def test_names_and_colours_in_two_readers(halves, tmp_path, schema):
    path = tmp_path / "part.step"
    write_step(halves, path, style, product="part", schema=schema)
    assert same(styled_faces(path), expected(halves))
    shape, found = read_back(path)
    assert same(found, expected(halves))
    assert BRepCheck_Analyzer(shape).IsValid()
    assert Part(shape).closed
    assert Part(shape).solids == 1


def test_same_bytes_and_nothing_else_left(halves, tmp_path):
    for name in ("a", "b"):
        (tmp_path / name).mkdir()
        write_step(halves, tmp_path / name / "part.step", style, product="part")
    a, b = (tmp_path / name / "part.step" for name in ("a", "b"))
    assert a.read_bytes() == b.read_bytes()
    assert [p.name for p in a.parent.iterdir()] == ["part.step"]
    assert b"tmp" not in a.read_bytes()[:600]


def test_settings_of_the_host_are_put_back(halves, tmp_path):
    names = "write.step.schema", "write.stepcaf.subshapes.name"
    before = Interface_Static.CVal_s(names[0]), Interface_Static.IVal_s(names[1])
    write_step(halves, tmp_path / "part.step", style, product="part")
    assert (Interface_Static.CVal_s(names[0]), Interface_Static.IVal_s(names[1])) == before


@pytest.mark.parametrize("names", [True, False])
def test_settings_are_put_back_after_reading(names, halves, tmp_path):
    from cad_io.read.step import Loaded

    write_step(halves, tmp_path / "part.step", style, product="part")
    setting, naming = "read.stepcaf.subshapes.name", XCAFDoc_ShapeTool.AutoNaming_s()
    before = Interface_Static.IVal_s(setting)
    Interface_Static.SetIVal_s(setting, int(not names))
    try:
        found = Loaded(str(tmp_path / "part.step"), (tmp_path / "part.step").read_bytes(), names=names).transfer()
        assert Interface_Static.IVal_s(setting) == int(not names)
    finally:
        Interface_Static.SetIVal_s(setting, before)
    assert XCAFDoc_ShapeTool.AutoNaming_s() == naming
    assert bool(found.names) == names


@pytest.mark.slow("reads or samples a large real file")
def test_whether_the_kernel_names_shapes_by_itself_changes_nothing(tmp_path):
    """cadquery's exports turn it off for the whole process, and leave it off."""
    part = Part(compound([block(1), block(1), block(1)]))
    numbers = tuple(range(1, len(part.faces) + 1))
    one = len(numbers) // 3
    children = tuple(Node("", "", TopLoc_Location(), faces=some) for some in (numbers[:one], numbers[one:]))
    tree = [Node("", "", TopLoc_Location(), children=children)]
    before, found = XCAFDoc_ShapeTool.AutoNaming_s(), []
    try:
        for naming in (True, False):
            XCAFDoc_ShapeTool.SetAutoNaming_s(naming)
            write_step(split(part, []), tmp_path / "part.step", style, product="part", tree=tree)
            text = (tmp_path / "part.step").read_bytes()
            nameless = re.sub(rb"(PRODUCT|NEXT_ASSEMBLY_USAGE_OCCURRENCE)\('[^']*','[^']*'", rb"\1('',''", text)
            assert nameless != text
            (tmp_path / "nameless.step").write_bytes(nameless)
            read = [read_part(tmp_path / name) for name in ("part.step", "nameless.step")]
            found.append((text, [([f.name for f in p.faces], [name_of(n) for n in p.tree]) for p in read]))
    finally:
        XCAFDoc_ShapeTool.SetAutoNaming_s(before)
    assert found[0] == found[1]


def name_of(node: Node) -> tuple:
    return node.name, node.instance, tuple(name_of(child) for child in node.children)


def test_pieces_of_one_loose_face_are_one_shell(tmp_path):
    part = Part(patch())
    found = split(part, [labels(part, 1, lambda x, y: x > 0.5)])
    write_step(found, tmp_path / "part.step", style, product="part")
    shells = [t for t in parse(tmp_path / "part.step").values() if t.startswith("OPEN_SHELL")]
    assert [len(references(t)) for t in shells] == [2]
    assert same(styled_faces(tmp_path / "part.step"), expected(found))


def test_of_several_shells_without_a_solid_every_piece_is_a_shell_with_its_colour(tmp_path):
    """FreeCAD forgets the colours of faces in them, but not those of shells."""
    shape = BRepPrimAPI_MakeBox(30, 20, 10).Solid()
    part = Part(compound([next(explore(shape, TopAbs_SHELL)), patch()]))
    found = split(part, [labels(part, 7, lambda x, y: x > 0.5)])
    write_step(found, tmp_path / "part.step", style, product="part")
    entities = parse(tmp_path / "part.step")
    assert same(styled_faces(tmp_path / "part.step"), expected(found))
    coloured = []
    for text in entities.values():
        if text.startswith("STYLED_ITEM"):
            look, item = re.search(r"\((#[^)]*)\)", text.split("(", 1)[1])[1], references(text)[-1]
            model = entities[item]
            assert model.startswith("SHELL_BASED_SURFACE_MODEL")
            (shell,) = references(model)
            (face,) = references(entities[shell])
            name = re.search(r"'([^']*)'", entities[face])[1]
            coloured.append((name, colour(entities, references(look)[0])))
    assert same(sorted(coloured), expected(found))
    assert same(read_back(tmp_path / "part.step")[1], expected(found))


def test_of_several_solids_each_is_a_product(tmp_path):
    solid = BRepPrimAPI_MakeCylinder(5, 10).Solid()
    part = Part(compound([BRepPrimAPI_MakeBox(30, 20, 10).Solid(), patch(), solid]))
    found = split(part, [labels(part, 7, lambda x, y: x > 0.5)])
    write_step(found, tmp_path / "part.step", style, product="part")
    assert same(read_back(tmp_path / "part.step")[1], expected(found))
    again = read_part(tmp_path / "part.step")
    (root,) = again.tree
    assert (root.name, [child.name for child in root.children]) == ("part", ["part 1", "part 2", "part 3"])
    assert [len(child.faces) for child in root.children] == [6, 3, 2]


def test_instances_that_were_not_split_have_colours_of_their_own(tmp_path):
    """They share their faces, and the kernel would write both colours for the faces of the first."""
    move = gp_Trsf()
    move.SetTranslation(gp_Vec(100, 0, 0))
    place = TopLoc_Location(move)
    solid = BRepPrimAPI_MakeCylinder(5, 10).Solid()
    part = Part(compound([solid, solid.Located(place)]))
    tree = [
        Node("pair", "", TopLoc_Location(), children=(
            Node("rod", "left", TopLoc_Location(), faces=(1, 2, 3)), Node("rod", "right", place, faces=(4, 5, 6))
        ))
    ]  # fmt: skip
    found = split(part, [])

    def by_instance(piece):
        return Style(f"F{piece.face}", RED if piece.face < 4 else GREEN)

    layers = {n: ("left" if n < 4 else "right",) for n in range(1, 7)}
    write_step(found, tmp_path / "part.step", by_instance, product="part", tree=tree, layers=layers)
    again = read_part(tmp_path / "part.step")
    assert [leaf for _, leaf, _ in again.tree[0].leaves()] == ["pair/left", "pair/right"]
    for face in again.faces:
        number = int(face.name[1:])
        assert face.colour == pytest.approx(RED if number < 4 else GREEN, abs=1e-5)
        assert again.layers[face.number] == ("left" if number < 4 else "right",)
    assert sorted(f.name for f in again.faces) == [f"F{n}" for n in range(1, 7)]


def test_a_located_solid_and_a_single_face(tmp_path):
    move = gp_Trsf()
    move.SetTranslation(gp_Vec(100, 0, 0))
    solid = BRepPrimAPI_MakeCylinder(5, 10).Solid()
    for shape in (solid.Located(TopLoc_Location(move)), patch(), compound([solid, solid.Located(TopLoc_Location(move))])):
        part = Part(shape)
        found = split(part, [])
        write_step(found, tmp_path / "part.step", style, product="part")
        assert same(styled_faces(tmp_path / "part.step"), expected(found))
        assert same(read_back(tmp_path / "part.step")[1], expected(found))


@pytest.mark.parametrize("kind", ["mirrored", "two", "pocket"])
def test_left_handed_surfaces_keep_names_and_colours(tmp_path, kind):
    """STEP has none: the kernel writes others in their place, and their neighbours, too. FreeCAD makes such bodies."""
    solid = BRepAlgoAPI_Cut(BRepPrimAPI_MakeBox(30, 30, 10).Solid(), BRepPrimAPI_MakeCylinder(12, 6).Solid()).Shape()
    mirror, move = gp_Trsf(), gp_Trsf()
    mirror.SetMirror(gp_Ax2(gp_Pnt(), gp_Dir(1, 0, 0)))
    move.SetTranslation(gp_Vec(100, 0, 0))
    left = BRepBuilderAPI_Transform(solid, mirror, True).Shape()
    assert not ShapeCustom.DirectFaces_s(left).IsSame(left)
    pocket = BRepAlgoAPI_Cut(BRepPrimAPI_MakeBox(gp_Pnt(-50, -50, -5), gp_Pnt(50, 50, 5)).Solid(), left).Shape()
    parts = {"mirrored": left, "two": compound([left, left.Located(TopLoc_Location(move))]), "pocket": pocket}
    found = split(Part(parts[kind]), [])
    write_step(found, tmp_path / "part.step", style, product="part")
    assert same(styled_faces(tmp_path / "part.step"), expected(found))
    shape, back = read_back(tmp_path / "part.step")
    assert same(back, expected(found))
    assert BRepCheck_Analyzer(shape).IsValid()


@pytest.mark.parametrize("mirrored", [False, True])
def test_a_body_of_triangles_beside_one_with_surfaces(tmp_path, mirrored):
    """The kernel crashes where it looks for left-handed surfaces in a face that has no surface at all."""
    solid, mirror = BRepPrimAPI_MakeCylinder(12, 6).Solid(), gp_Trsf()
    mirror.SetMirror(gp_Ax2(gp_Pnt(), gp_Dir(1, 0, 0)))
    beside = BRepBuilderAPI_Transform(solid, mirror, True).Shape() if mirrored else solid
    assert ShapeCustom.DirectFaces_s(beside).IsSame(beside) != mirrored
    found = split(Part(compound([beside, triangulated(ball(at=(50, 0, 0)))])), [])
    write_step(found, tmp_path / "part.step", style, product="part")
    text = (tmp_path / "part.step").read_text()
    assert sorted(re.findall(r"ADVANCED_FACE\s*\('([^']*)'", text)) == ["F1_grey", "F2_grey", "F3_grey"]
    back = read_part(tmp_path / "part.step").faces
    assert [face.unjudged is None for face in back] == [True, True, True, False]


def test_a_name_that_the_kernel_loses_is_a_fault(halves, tmp_path, monkeypatch):
    monkeypatch.setattr("cad_io.write.step.STEPCAFControl_Writer", Nameless)
    with pytest.raises(WriteError, match="names of faces the CAD kernel wrote 0"):
        write_step(halves, tmp_path / "part.step", style, product="part")


def test_names_become_ascii(tmp_path):
    found = split(Part(patch()), [])
    write_step(found, tmp_path / "p.step", lambda p: Style("Fläche_1 刀", RED), product="Stück")
    assert styled_faces(tmp_path / "p.step")[0][0] == "Flache_1 ?"
    assert "PRODUCT('Stuck'" in (tmp_path / "p.step").read_text("ascii")


def test_what_cannot_be_written(halves, tmp_path):
    with pytest.raises(WriteError, match="cannot be written"):
        write_step(halves, tmp_path / "missing" / "part.step", style, product="part")
    (tmp_path / "part.step").mkdir()
    with pytest.raises(WriteError, match="cannot be written"):
        write_step(halves, tmp_path / "part.step", style, product="part")
    with pytest.raises(WriteError, match="no STEP schema"):
        write_step(halves, tmp_path / "x.step", style, product="part", schema="AP1")
    assert [p.name for p in tmp_path.iterdir()] == ["part.step"]


def test_a_style_that_fails_leaves_the_old_file(halves, tmp_path):
    path = tmp_path / "part.step"
    path.write_text("old")
    with pytest.raises(ZeroDivisionError):
        write_step(halves, path, lambda p: 1 // 0, product="part")
    assert path.read_text() == "old"
