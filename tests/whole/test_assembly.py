"""An assembly in, an assembly out: products, instances, places, names, layers and the colours of check faces."""

import pytest
from OCP.gp import gp_Ax1, gp_Dir, gp_Pnt, gp_Trsf, gp_Vec
from OCP.IFSelect import IFSelect_RetDone
from OCP.Quantity import Quantity_Color, Quantity_TOC_sRGB
from OCP.STEPCAFControl import STEPCAFControl_Writer
from OCP.TCollection import TCollection_ExtendedString
from OCP.TDataStd import TDataStd_Name
from OCP.TDocStd import TDocStd_Document
from OCP.TopLoc import TopLoc_Location
from OCP.XCAFDoc import XCAFDoc_ColorSurf, XCAFDoc_DocumentTool

from cad_io import read_part
from cad_io.kernel import faces
from cad_io.kernel.shapes import compound
from plan_cutters import Cutter, plan
from plan_cutters.plan_file.reasons import rgb
from tests.support.places import SAMPLES

FACES = 6  # of the mould
BLUE = (0.1, 0.2, 0.9)


def placed(x, y, z, angle=0.0):
    turn, move = gp_Trsf(), gp_Trsf()
    turn.SetRotation(gp_Ax1(gp_Pnt(), gp_Dir(0, 0, 1)), angle)
    move.SetTranslation(gp_Vec(x, y, z))
    return TopLoc_Location(move * turn)


@pytest.fixture(scope="module")
def file(tmp_path_factory):
    """`stand` holds `left` and `right`, two instances of `mould`, whose last face is blue, and all of it on a layer."""
    document = TDocStd_Document(TCollection_ExtendedString("BinXCAF"))
    shapes = XCAFDoc_DocumentTool.ShapeTool_s(document.Main())
    colours = XCAFDoc_DocumentTool.ColorTool_s(document.Main())
    layers = XCAFDoc_DocumentTool.LayerTool_s(document.Main())

    def named(label, name):
        TDataStd_Name.Set_s(label, TCollection_ExtendedString(name))
        return label

    solid = read_part(SAMPLES / "pocket_top.step").shape
    mould = named(shapes.AddShape(compound([solid]), False), "mould")
    sub = shapes.AddSubShape(mould, faces(solid)[-1])
    colours.SetColor(sub, Quantity_Color(*BLUE, Quantity_TOC_sRGB), XCAFDoc_ColorSurf)
    named(sub, "bottom")
    layers.SetLayer(sub, TCollection_ExtendedString("base"))
    pair = named(shapes.NewShape(), "pair")
    named(shapes.AddComponent(pair, mould, placed(0, 0, 0)), "left")
    named(shapes.AddComponent(pair, mould, placed(300, 20, 5, 0.5)), "right")
    stand = named(shapes.NewShape(), "stand")
    named(shapes.AddComponent(stand, pair, placed(10, 20, 30)), "twins")
    shapes.UpdateAssemblies()
    writer = STEPCAFControl_Writer()
    writer.SetColorMode(True)
    writer.SetNameMode(True)
    writer.SetLayerMode(True)
    from OCP.Interface import Interface_Static

    Interface_Static.SetIVal_s("write.stepcaf.subshapes.name", 1)
    writer.Transfer(document)
    path = tmp_path_factory.mktemp("assembly") / "stand.step"
    assert writer.Write(str(path)) == IFSelect_RetDone
    return path


def outline(part):
    """Path, corner of the box and turn of each leaf."""
    found = {}
    for root in part.tree:
        for leaf, path, place in root.leaves():
            move = place.Transformation()
            found[path] = (len(leaf.faces), [round(x, 6) for x in move.TranslationPart().Coord()],
                           round(move.GetRotation().GetRotationAngle(), 6))  # fmt: skip
    return found


def test_products_instances_names_layers_and_colours_are_read(file):
    part = read_part(file)
    assert outline(part) == {"stand/twins/left": (FACES, [10, 20, 30], 0), "stand/twins/right": (FACES, [310, 40, 35], 0.5)}
    bottoms = [f for f in part.faces if f.name == "bottom"]
    assert len(bottoms) == 2
    assert all(f.colour == pytest.approx(BLUE, abs=2e-3) for f in bottoms)
    assert part.layers == {f.number: ("base",) for f in bottoms}


@pytest.mark.slow("plans and writes for each schema", only=("ap214",))
@pytest.mark.parametrize("schema", ["ap242", "ap214"])
def test_annotated_step_keeps_them(file, tmp_path, schema):
    result = plan(file, cutters=[Cutter.flat(radius=8, length=90)], spacing=4.0, tolerance=0.1)
    document = result.write(tmp_path, step_schema=schema)
    assert {f.component for f in document.faces} == {"stand/twins/left", "stand/twins/right"}
    assert {entry.rung for entry in document.split.values()} == {"contour"}
    again = read_part(tmp_path / "annotated.step")
    assert [root.name for root in again.tree] == ["stand"]
    before, after = outline(result.part), outline(again)
    assert {path: entry[1:] for path, entry in after.items()} == {path: entry[1:] for path, entry in before.items()}
    assert again.solids == 2
    assert again.closed
    assert again.size == pytest.approx(result.part.size, abs=1e-3)
    area = dict.fromkeys((f.id for f in document.faces), 0.0)
    for face in again.faces:
        name, _, own = face.name.partition(" ")
        number, _, verdict = name.partition("_")
        area[number] += face.area
        assert own == result.part.faces[int(number[1:]) - 1].name
        assert face.colour == pytest.approx(BLUE if own == "bottom" else rgb(verdict), abs=2e-3)
        assert again.layers.get(face.number, ()) == (("base",) if own == "bottom" else ())
    assert area == pytest.approx({f.id: f.area_mm2 for f in document.faces}, rel=1e-5)
