"""STEP assemblies whose parts lie in files of their own, as the CAD kernel writes them."""

from pathlib import Path

from OCP.BRepPrimAPI import BRepPrimAPI_MakeBox, BRepPrimAPI_MakeSphere
from OCP.gp import gp_Pnt, gp_Trsf, gp_Vec
from OCP.IFSelect import IFSelect_RetDone
from OCP.Interface import Interface_Static
from OCP.STEPCAFControl import STEPCAFControl_Writer
from OCP.STEPControl import STEPControl_AsIs
from OCP.TCollection import TCollection_ExtendedString
from OCP.TDataStd import TDataStd_Name
from OCP.TDocStd import TDocStd_Document
from OCP.TopLoc import TopLoc_Location
from OCP.XCAFDoc import XCAFDoc_DocumentTool

#: Names of the files of both parts: a box of 10 mm, and beside it a sphere of radius 4 mm.
BOX, BALL = "of_box.stp", "of_ball.stp"


def write_assembly(folder: Path, unit: str = "MM") -> Path:
    """Write the assembly `whole.stp` into a folder, and beside it the files of its parts."""
    folder.mkdir(parents=True, exist_ok=True)
    document = TDocStd_Document(TCollection_ExtendedString("XmlXCAF"))
    shapes = XCAFDoc_DocumentTool.ShapeTool_s(document.Main())
    whole = shapes.NewShape()
    solids = {"box": BRepPrimAPI_MakeBox(10.0, 10.0, 10.0).Shape(), "ball": BRepPrimAPI_MakeSphere(gp_Pnt(), 4.0).Shape()}
    for place, (name, solid) in zip((0.0, 25.0), solids.items(), strict=True):
        label = shapes.AddShape(solid, False)
        TDataStd_Name.Set_s(label, TCollection_ExtendedString(name))
        move = gp_Trsf()
        move.SetTranslation(gp_Vec(place, 5.0, 5.0))
        shapes.AddComponent(whole, label, TopLoc_Location(move))
    TDataStd_Name.Set_s(whole, TCollection_ExtendedString("whole"))
    shapes.UpdateAssemblies()
    before = Interface_Static.CVal_s("write.step.unit")
    Interface_Static.SetCVal_s("write.step.unit", unit)
    try:
        writer = STEPCAFControl_Writer()
        writer.Transfer(document, STEPControl_AsIs, "of_")
        assert writer.Write(str(folder / "whole.stp")) == IFSelect_RetDone
    finally:
        Interface_Static.SetCVal_s("write.step.unit", before)
    return folder / "whole.stp"
