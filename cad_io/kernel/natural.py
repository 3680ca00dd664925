"""Natural bounds: a face without edges is all of its surface, where that has an end."""

from OCP.BRep import BRep_Builder, BRep_Tool
from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeFace
from OCP.TopAbs import TopAbs_FORWARD
from OCP.TopLoc import TopLoc_Location
from OCP.TopoDS import TopoDS, TopoDS_Face, TopoDS_Shape

from cad_io.kernel.calls import edges_of, faces, may_refuse
from cad_io.kernel.components import children

#: Parameters of the kernel's endless surfaces are 2e100.
_ENDLESS = 1e50
#: Precision of vertices that are made, mm.
_PRECISION = 1e-7
#: Why a face that is endless cannot be judged.
ENDLESS = "has no edges and no end: bound it"


def endless(face: TopoDS_Face) -> bool:
    """Whether a face has no edges, on a surface without end."""
    if edges_of(face):
        return False
    surface = BRep_Tool.Surface_s(face)
    return surface is not None and any(abs(each) > _ENDLESS for each in surface.Bounds())


def bound_naturally(shape: TopoDS_Shape) -> None:
    """Give each face that has no edges, and whose surface has an end, the border of that surface.

    The shape itself gets them, so that its faces stay the ones that a host knows: it is what it was, said in full.
    """
    for face in faces(shape):
        with may_refuse():
            if not edges_of(face) and not endless(face):
                _bound(face)


def _bound(face: TopoDS_Face) -> None:
    bare, place = TopoDS.Face_s(face.Located(TopLoc_Location()).Oriented(TopAbs_FORWARD)), TopLoc_Location()
    surface = BRep_Tool.Surface_s(bare, place)
    # Those that hold triangles alone have none.
    if surface is None or edges_of(bare):
        return
    whole = BRepBuilderAPI_MakeFace(surface, _PRECISION)
    if not whole.IsDone():
        return
    free = bare.Free()
    bare.Free(True)
    for wire in children(whole.Face()):
        BRep_Builder().Add(bare, wire.Moved(place))
    bare.Free(free)
