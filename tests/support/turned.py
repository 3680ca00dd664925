"""Bodies on whose surfaces of revolution the curve crosses the axis: as they are made, and as they come back from STEP."""

from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeEdge, BRepBuilderAPI_MakeFace, BRepBuilderAPI_MakeWire
from OCP.BRepPrimAPI import BRepPrimAPI_MakeRevol
from OCP.GC import GC_MakeArcOfCircle
from OCP.gp import gp_Ax1, gp_Dir, gp_Pnt
from OCP.STEPControl import STEPControl_Reader

from tests.support.cad_parts import write_step


def revolved_arc(bulge, half=4.0, at=(0.0, 0.0, 0.0)):
    """An arc from end to end of an axis, `bulge` off it in its middle, turned round: a lemon up to `half`, an apple beyond."""
    x, y, z = at
    low, high = gp_Pnt(x, y, z - half), gp_Pnt(x, y, z + half)
    arc = GC_MakeArcOfCircle(low, gp_Pnt(x + bulge, y, z), high).Value()
    wire = BRepBuilderAPI_MakeWire(BRepBuilderAPI_MakeEdge(arc).Edge(), BRepBuilderAPI_MakeEdge(high, low).Edge()).Wire()
    return BRepPrimAPI_MakeRevol(BRepBuilderAPI_MakeFace(wire).Face(), gp_Ax1(low, gp_Dir(0, 0, 1))).Shape()


def elbow():
    """Two tubes of radius 5 and a quarter of a ball between them, as a round corner of a sweep has it."""
    import cadquery as cq

    path = cq.Workplane("XZ").polyline([(0, 0), (0, 30), (30, 30)])
    return cq.Workplane("XY").circle(5).sweep(path, transition="round").val().wrapped


def from_step(shape, folder):
    """A shape as it comes back from STEP."""
    file = folder / "turned.step"
    write_step(shape, file)
    reader = STEPControl_Reader()
    reader.ReadFile(str(file))
    reader.TransferRoots()
    return reader.OneShape()
