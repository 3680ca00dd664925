"""Build the sample parts. `python samples/make_samples.py` writes them beside this file and prints their figures.

v_groove.step           the seed's first example: two planes at 120 deg joined by a cylinder of radius 5, an open shell
peaks_and_valleys.step  the seed's second example, as near as its published figures say (`peaks.py`)
pocket_top.step         a closed solid: a block whose top is one sculptured B-spline face
blade.step              a closed solid: a twisted, tapering blade lofted between B-spline sections
control_arm.step        from CAD practice; see the licence note in `samples/README.md`
"""

import math
from pathlib import Path

import numpy as np
import peaks
from OCP.APIHeaderSection import APIHeaderSection_MakeHeader
from OCP.BRep import BRep_Builder, BRep_Tool
from OCP.BRepBuilderAPI import (
    BRepBuilderAPI_MakeEdge,
    BRepBuilderAPI_MakeFace,
    BRepBuilderAPI_MakeSolid,
    BRepBuilderAPI_MakeWire,
    BRepBuilderAPI_Sewing,
)
from OCP.BRepLib import BRepLib
from OCP.BRepOffsetAPI import BRepOffsetAPI_ThruSections
from OCP.BRepPrimAPI import BRepPrimAPI_MakePrism
from OCP.GC import GC_MakeArcOfCircle
from OCP.Geom import Geom_BSplineSurface
from OCP.GeomAPI import GeomAPI_PointsToBSpline
from OCP.gp import gp_Pnt, gp_Vec
from OCP.IFSelect import IFSelect_RetDone
from OCP.Interface import Interface_Static
from OCP.STEPControl import STEPControl_AsIs, STEPControl_Controller, STEPControl_Writer
from OCP.TColgp import TColgp_Array1OfPnt, TColgp_Array2OfPnt
from OCP.TCollection import TCollection_HAsciiString
from OCP.TColStd import TColStd_Array1OfInteger, TColStd_Array1OfReal
from OCP.TopAbs import TopAbs_SHELL
from OCP.TopExp import TopExp_Explorer
from OCP.TopoDS import TopoDS, TopoDS_Shape, TopoDS_Shell
from scipy.interpolate import make_interp_spline

HERE = Path(__file__).parent

#: The parameters that `peaks.py` found.
PEAKS = peaks.Shape(
    dx=13.658, dy=34.89, wx=14.337, wy=55.749, peak_sx=18.055, peak_sy=28.25, peak_q=4.774,
    valley_sx=22.351, valley_sy=42.886, valley_q=2.451, depth=0.959,
)  # fmt: skip


def save(shape: TopoDS_Shape, name: str) -> None:
    """Write STEP with a fixed header, so that the same shape gives the same file."""
    STEPControl_Controller.Init_s()
    Interface_Static.SetCVal_s("write.step.schema", "AP214IS")
    Interface_Static.SetCVal_s("write.step.product.name", name)
    writer = STEPControl_Writer()
    writer.Transfer(shape, STEPControl_AsIs)
    header = APIHeaderSection_MakeHeader(writer.Model())
    header.SetName(TCollection_HAsciiString(name))
    header.SetTimeStamp(TCollection_HAsciiString("2026-01-01T00:00:00"))
    header.SetAuthorValue(1, TCollection_HAsciiString("plan-cutters"))
    header.SetOrganizationValue(1, TCollection_HAsciiString("plan-cutters"))
    if writer.Write(str(HERE / f"{name}.step")) != IFSelect_RetDone:
        raise OSError(f"could not write {name}.step")
    print(f"{name}.step written")


def bspline(points: np.ndarray, degree: int = 3) -> Geom_BSplineSurface:
    """Interpolate (nu, nv, 3) points with a uniform tensor-product B-spline, parameters 0 to 1."""
    nu, nv, _ = points.shape
    along_u = make_interp_spline(np.linspace(0, 1, nu), points, k=degree, axis=0)
    along_v = make_interp_spline(np.linspace(0, 1, nv), along_u.c, k=degree, axis=1)
    poles = np.moveaxis(along_v.c, 0, 1)
    array = TColgp_Array2OfPnt(1, nu, 1, nv)
    for i in range(nu):
        for j in range(nv):
            array.SetValue(i + 1, j + 1, gp_Pnt(*map(float, poles[i, j])))
    knots = []
    for t in (along_u.t, along_v.t):
        values, counts = np.unique(t, return_counts=True)
        k, m = TColStd_Array1OfReal(1, len(values)), TColStd_Array1OfInteger(1, len(values))
        for i, (value, count) in enumerate(zip(values, counts, strict=True)):
            k.SetValue(i + 1, float(value))
            m.SetValue(i + 1, int(count))
        knots.append((k, m))
    (ku, mu), (kv, mv) = knots
    return Geom_BSplineSurface(array, ku, kv, mu, mv, degree, degree)


def face_of(surface: Geom_BSplineSurface) -> TopoDS_Shape:
    return BRepBuilderAPI_MakeFace(surface, 1e-6).Face()


def v_groove() -> None:
    """Bottom line along Y through the origin at mid-length, +Z out of the material."""
    half, radius, flank, length = math.radians(30), 5.0, 25.0, 240.0
    x, z = radius * math.sin(half), radius * (1 - math.cos(half))
    dx, dz = flank * math.cos(half), flank * math.sin(half)
    y = -length / 2

    def point(a: float, b: float) -> gp_Pnt:
        return gp_Pnt(a, y, b)

    arc = GC_MakeArcOfCircle(point(-x, z), point(0, 0), point(x, z)).Value()
    profile = (
        BRepBuilderAPI_MakeEdge(point(-x - dx, z + dz), point(-x, z)).Edge(),
        BRepBuilderAPI_MakeEdge(arc).Edge(),
        BRepBuilderAPI_MakeEdge(point(x, z), point(x + dx, z + dz)).Edge(),
    )
    wire = BRepBuilderAPI_MakeWire(*profile).Wire()
    shell = BRepPrimAPI_MakePrism(wire, gp_Vec(0, length, 0)).Shape()
    # The prism of this wire has its normals down: turn the shell over.
    save(shell.Reversed(), "v_groove")


def peaks_and_valleys() -> None:
    points, _ = peaks.grid(PEAKS, 81)
    shell, builder = TopoDS_Shell(), BRep_Builder()
    builder.MakeShell(shell)
    builder.Add(shell, face_of(bspline(points)))
    save(shell, "peaks_and_valleys")
    figures = peaks.figures(PEAKS, n=201, mesh=401)
    print("  ", {key: round(float(value), 2) for key, value in figures.items() if key != "cost"})


def solid_of(faces: list[TopoDS_Shape]) -> TopoDS_Shape:
    """Sew faces into one solid, right way out."""
    sewing = BRepBuilderAPI_Sewing(1e-4)
    for face in faces:
        sewing.Add(face)
    sewing.Perform()
    shell = TopoDS.Shell_s(TopExp_Explorer(sewing.SewedShape(), TopAbs_SHELL).Current())
    if not BRep_Tool.IsClosed_s(shell):
        raise ValueError("the faces do not close")
    solid = BRepBuilderAPI_MakeSolid(shell).Solid()
    BRepLib.OrientClosedSolid_s(solid)
    return solid


def pocket_top() -> None:
    """A block 60 x 40 whose top waves between 14 and 26 mm: gentle in x, tighter in y."""
    n = 25
    x, y = np.meshgrid(np.linspace(0, 60, n), np.linspace(0, 40, n), indexing="ij")
    z = 20 + 4 * np.sin(2 * np.pi * x / 60) + 2.0 * np.cos(2 * np.pi * y / 40) * (x / 60)
    top = bspline(np.stack([x, y, z], -1))
    faces = [face_of(top)]
    for side in (top.UIso(0.0), top.UIso(1.0), top.VIso(0.0), top.VIso(1.0)):
        edge = BRepBuilderAPI_MakeEdge(side).Edge()
        start, end = side.Value(0.0), side.Value(1.0)
        down = [gp_Pnt(p.X(), p.Y(), 0.0) for p in (start, end)]
        wire = BRepBuilderAPI_MakeWire(
            edge,
            BRepBuilderAPI_MakeEdge(end, down[1]).Edge(),
            BRepBuilderAPI_MakeEdge(down[1], down[0]).Edge(),
            BRepBuilderAPI_MakeEdge(down[0], start).Edge(),
        ).Wire()
        faces.append(BRepBuilderAPI_MakeFace(wire, True).Face())
    corners = [gp_Pnt(a, b, 0.0) for a, b in ((0, 0), (60, 0), (60, 40), (0, 40))]
    bottom = BRepBuilderAPI_MakeWire()
    for a, b in zip(corners, corners[1:] + corners[:1], strict=True):
        bottom.Add(BRepBuilderAPI_MakeEdge(a, b).Edge())
    faces.append(BRepBuilderAPI_MakeFace(bottom.Wire(), True).Face())
    save(solid_of(faces), "pocket_top")


def blade() -> None:
    """Seven sections from root (z = 0, chord 60) to tip (z = 120, chord 40), twisted by 35 deg."""
    loft = BRepOffsetAPI_ThruSections(True, False, 1e-6)
    loft.CheckCompatibility(False)
    t = np.linspace(0, 2 * np.pi, 41)
    for part in np.linspace(0, 1, 7):
        chord, thick = 60 - 20 * part, (60 - 20 * part) * (0.14 - 0.05 * part)
        # A closed, smooth section: an ellipse whose chord is bent into a camber line.
        x = 0.5 * chord * np.cos(t)
        z = 0.5 * thick * np.sin(t) + 0.10 * chord * (1 - (2 * x / chord) ** 2)
        turn = math.radians(35) * part
        array = TColgp_Array1OfPnt(1, len(t))
        for i in range(len(t)):
            a, b = x[i % (len(t) - 1)], z[i % (len(t) - 1)]
            array.SetValue(i + 1, gp_Pnt(float(a * math.cos(turn) - b * math.sin(turn)),
                                         float(a * math.sin(turn) + b * math.cos(turn)), 120.0 * float(part)))  # fmt: skip
        curve = GeomAPI_PointsToBSpline(array, 3, 8).Curve()
        loft.AddWire(BRepBuilderAPI_MakeWire(BRepBuilderAPI_MakeEdge(curve).Edge()).Wire())
    loft.Build()
    solid = TopoDS.Solid_s(loft.Shape())
    BRepLib.OrientClosedSolid_s(solid)
    save(solid, "blade")


if __name__ == "__main__":
    v_groove()
    peaks_and_valleys()
    pocket_top()
    blade()
