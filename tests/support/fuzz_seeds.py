"""Small CAD files of every kind that the readers tell apart, made with the kernel: what `fuzz_read.py` damages."""

from pathlib import Path

from OCP.BRep import BRep_Tool
from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeFace
from OCP.BRepPrimAPI import BRepPrimAPI_MakePrism
from OCP.Geom import Geom_OffsetSurface
from OCP.gp import gp_Vec
from OCP.IGESControl import IGESControl_Writer
from OCP.Interface import Interface_Static
from OCP.Quantity import Quantity_Color, Quantity_TOC_sRGB
from OCP.STEPCAFControl import STEPCAFControl_Controller, STEPCAFControl_Writer
from OCP.STEPControl import STEPControl_AsIs, STEPControl_Writer
from OCP.TCollection import TCollection_ExtendedString
from OCP.TDataStd import TDataStd_Name
from OCP.TDocStd import TDocStd_Document
from OCP.TopAbs import TopAbs_FACE
from OCP.TopLoc import TopLoc_Location
from OCP.XCAFDoc import XCAFDoc_ColorSurf, XCAFDoc_DocumentTool

from cad_io.kernel import explore, faces
from tests.support.cad_parts import as_nurbs, ball, compound, cone, cut, drilled, moved, patch, pocketed, ring, rod


def write_seeds(folder: Path) -> None:
    """STEP and IGES files, a few to a few tens of kilobytes each."""
    bump = patch(count=4, width=20, height=4)
    offset = Geom_OffsetSurface(BRep_Tool.Surface_s(patch(2, count=4, width=20, height=2)), 1.0)
    shapes = {
        "bump": bump,
        "bumpy_block": BRepPrimAPI_MakePrism(bump, gp_Vec(0, 0, -15)).Shape(),
        "holed": cut(bump, rod(3, 100, (0, 0, -50))),
        "drilled": drilled(),
        "pocket": pocketed(),
        "nurbs_pocket": as_nurbs(pocketed()),
        "ball": ball(),
        "ring": as_nurbs(ring(12, 4)),
        "offset": BRepBuilderAPI_MakeFace(offset, 1e-6).Face(),
        "cone": cone(8, 4),
        "open": compound(*list(explore(pocketed(), TopAbs_FACE))[3:]),
        "two": compound(cone(8, 4), cone(8, 4).Moved(TopLoc_Location(moved()))),
    }
    for name, shape in shapes.items():
        for unit in ("MM", "INCH") if name in ("bump", "pocket") else ("MM",):
            Interface_Static.SetCVal_s("write.step.unit", unit)
            step = STEPControl_Writer()
            step.Transfer(shape, STEPControl_AsIs)
            step.Write(str(folder / f"{name}_{unit}.step".lower()))
        for mode in (0, 1):
            iges = IGESControl_Writer("IN" if name == "pocket" else "MM", mode)
            iges.AddShape(shape)
            iges.ComputeModel()
            iges.Write(str(folder / f"{name}_{'brep' if mode else 'faces'}.igs"))
    Interface_Static.SetCVal_s("write.step.unit", "MM")
    _assembly(folder / "assembly.step")


def _assembly(file: Path) -> None:
    """Two placed instances of one product, with names and colours of faces."""
    STEPCAFControl_Controller.Init_s()
    Interface_Static.SetIVal_s("write.stepcaf.subshapes.name", 1)
    document = TDocStd_Document(TCollection_ExtendedString("XmlXCAF"))
    tool = XCAFDoc_DocumentTool.ShapeTool_s(document.Main())
    product = pocketed()
    label = tool.AddShape(product, False)
    for i, face in enumerate(faces(product)[:3]):
        sub = tool.AddSubShape(label, face)
        TDataStd_Name.Set_s(sub, TCollection_ExtendedString(f"side {i}"))
        colour = Quantity_Color(0.3 * i, 0.5, 0.9, Quantity_TOC_sRGB)
        XCAFDoc_DocumentTool.ColorTool_s(document.Main()).SetColor(sub, colour, XCAFDoc_ColorSurf)
    both = compound(product, product.Moved(TopLoc_Location(moved())))
    tool.AddShape(both, True)
    writer = STEPCAFControl_Writer()
    writer.Transfer(document, STEPControl_AsIs)
    writer.Write(str(file))
