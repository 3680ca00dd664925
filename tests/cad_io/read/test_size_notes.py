"""Sizes, tolerances and notes of faces that a STEP file states."""

import pickle
import time

import pytest
from OCP.Interface import Interface_Static
from OCP.STEPCAFControl import STEPCAFControl_Controller, STEPCAFControl_Writer
from OCP.TCollection import TCollection_ExtendedString, TCollection_HAsciiString
from OCP.TDocStd import TDocStd_Document
from OCP.XCAFDimTolObjects import (
    XCAFDimTolObjects_DimensionFormVariance,
    XCAFDimTolObjects_DimensionGrade,
    XCAFDimTolObjects_DimensionObject,
    XCAFDimTolObjects_DimensionType,
)
from OCP.XCAFDoc import XCAFDoc_Dimension, XCAFDoc_DocumentTool

from cad_io import Part, read_part
from cad_io.read.size_notes import stated as notes_of
from tests.support.places import real_file
from tests.support.plates import block
from tests.support.stated import stated

SIZES = {
    1.65: {"value": 3.3, "notes": ["M4x0.7 - 6H", "4X"]}, 4.0: {"value": 8.0, "deviations": (-0.01, 0.02)},
    5.0: {"value": 10.0, "fit": ("H", "7")}, 3.0: {"value": 3.0, "kind": "radius", "deviations": (0.0, 0.01)},
    2.0: {"value": 4.0, "notes": ["theoretical"], "deviations": (0.0, 0.1)},
}  # fmt: skip


def plate():
    made = block(80, 40, 12)
    for k, diameter in enumerate((3.3, 8.0, 10.0, 6.0, 4.0)):
        made = made.pushPoints([(16.0 * k - 32.0, 0.0)]).hole(diameter)
    return made.val()


def by_radius(part):
    return {round(part.faces[each.faces[0] - 1].carrier.radius, 3): each for each in part.sizes}


def test_sizes_belong_to_their_faces(tmp_path):
    part = read_part(stated(tmp_path / "a.step", plate(), SIZES))
    assert not part.lost
    sizes = by_radius(part)
    rows = {r: (each.nominal, each.lower, each.upper, each.fit, each.notes) for r, each in sizes.items()}
    assert rows == {
        1.65: (3.3, None, None, "", ("M4x0.7 - 6H", "4X")), 4.0: (8.0, -0.01, 0.02, "", ()), 5.0: (10.0, None, None, "H7", ()),
        3.0: (6.0, 0.0, 0.02, "", ()), 2.0: (4.0, None, None, "", ()),
    }  # fmt: skip
    assert pickle.loads(pickle.dumps(part)).sizes == part.sizes


def test_sizes_have_the_unit_of_the_file(tmp_path):
    inch = {radius: {**size, "value": size["value"] / 25.4} for radius, size in SIZES.items()}
    inch[4.0]["deviations"] = (-0.001, 0.002)
    sizes = by_radius(read_part(stated(tmp_path / "a.step", plate(), inch, inch=True)))
    assert (sizes[4.0].nominal, sizes[4.0].lower, sizes[4.0].upper) == pytest.approx((8.0, -0.0254, 0.0508))
    # Of a file that is read in another unit nothing is known.
    assert read_part(tmp_path / "a.step", unit="mm").sizes == ()


def test_the_same_part_without_them_is_the_same(tmp_path):
    with_sizes = read_part(stated(tmp_path / "a.step", plate(), SIZES))
    without = read_part(stated(tmp_path / "b.step", plate(), {}))
    assert without.sizes == ()
    assert [(each.name, each.surface, each.area) for each in with_sizes.faces] == [
        (each.name, each.surface, each.area) for each in without.faces
    ]
    assert with_sizes.warnings == without.warnings


def test_what_the_kernel_writes_is_read(tmp_path):
    """An independent writer; it takes the sign off lower deviations, so both are equal here."""
    shape, document = plate().wrapped, TDocStd_Document(TCollection_ExtendedString("XmlXCAF"))
    shapes, sizes = (tool(document.Main()) for tool in (XCAFDoc_DocumentTool.ShapeTool_s, XCAFDoc_DocumentTool.DimTolTool_s))
    label, part = shapes.AddShape(shape, False), Part(shape)

    def add(radius, change):
        face = next(part.face(each.number) for each in part.faces if each.carrier.radius == pytest.approx(radius))
        dimension, object_ = sizes.AddDimension(), XCAFDimTolObjects_DimensionObject()
        sizes.SetDimension(shapes.AddSubShape(label, face), dimension)
        object_.SetType(XCAFDimTolObjects_DimensionType.XCAFDimTolObjects_DimensionType_Size_Diameter)
        object_.SetValue(2.0 * radius)
        change(object_)
        XCAFDoc_Dimension.Set_s(dimension).SetObject(object_)

    def thread(object_):
        object_.AddDescription(*map(TCollection_HAsciiString, ("M4x0.7 - 6H", "dimensional note")))

    def both(object_):
        object_.SetUpperTolValue(0.02)
        object_.SetLowerTolValue(-0.02)

    def fit(object_):
        form = XCAFDimTolObjects_DimensionFormVariance.XCAFDimTolObjects_DimensionFormVariance_H
        # Its writer counts grades from 01.
        object_.SetClassOfTolerance(True, form, XCAFDimTolObjects_DimensionGrade.XCAFDimTolObjects_DimensionGrade_IT7)

    for radius, change in ((1.65, thread), (4.0, both), (5.0, fit)):
        add(radius, change)
    STEPCAFControl_Controller.Init_s()
    before = Interface_Static.IVal_s("write.step.schema")
    Interface_Static.SetIVal_s("write.step.schema", 5)
    try:
        writer = STEPCAFControl_Writer()
        writer.SetDimTolMode(True)
        assert writer.Transfer(document)
        writer.Write(str(tmp_path / "a.step"))
    finally:
        Interface_Static.SetIVal_s("write.step.schema", before)
    found = by_radius(read_part(tmp_path / "a.step"))
    assert found[1.65].notes == ("M4x0.7 - 6H",)
    assert (found[4.0].lower, found[4.0].upper) == (-0.02, 0.02)
    assert found[5.0].fit.startswith("H")


@pytest.mark.parametrize("name", ["brlcad_NIST_MBE_PMI_6.stp", "brlcad_NIST_MBE_PMI_11.stp", "hard/brlcad_NIST_MBE_PMI_2.stp"])
def test_files_of_the_shape_alone_state_none_and_cost_nothing(name):
    """These are AP203: their dimensions stand on the drawing alone."""
    data = real_file(f"cad/{name}").read_bytes()
    start = time.process_time()
    assert notes_of(data) == []
    assert time.process_time() - start < 0.02


USAGE = "GEOMETRIC_ITEM_SPECIFIC_USAGE('','',#"


@pytest.mark.parametrize("change", [
    ("DIMENSIONAL_SIZE(", "DIMENSIONAL_SIZE('',"), ("'nominal value'", "'something'"),
    ("TOLERANCE_VALUE(#", "TOLERANCE_VALUE(#9"),
    ("POSITIVE_LENGTH_MEASURE(3.3)", "POSITIVE_LENGTH_MEASURE(-)"), (USAGE, f"{USAGE}9"),
])  # fmt: skip
def test_what_is_damaged_states_less_and_breaks_nothing(tmp_path, change):
    file = stated(tmp_path / "a.step", plate(), SIZES)
    whole = notes_of(file.read_bytes())
    assert len(whole) == len(SIZES)
    rest = notes_of(file.read_text().replace(*change).encode())
    for note, faces in rest:
        assert any(
            faces == other[1] and note.fit in ("", other[0].fit) and note.lower in (None, other[0].lower) for other in whole
        )
