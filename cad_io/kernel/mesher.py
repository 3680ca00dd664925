"""The kernel's mesher, to draw a shape: on some faces it never ends, so it works in a copy of the process, which is ended."""

import io
import time
from typing import Any

from OCP.BinTools import BinTools
from OCP.BRep import BRep_Builder, BRep_Tool
from OCP.BRepMesh import BRepMesh_IncrementalMesh
from OCP.BRepTools import BRepTools
from OCP.TopLoc import TopLoc_Location
from OCP.TopoDS import TopoDS_Shape

from cad_io.kernel.calls import faces
from cad_io.kernel.limited import ChildDied, TimeLimit, limited

#: Processor time, s: for a whole shape, then for one face of a shape that did not end, and for all of these.
WHOLE, FACE, FACES = 20.0, 2.0, 20.0


def give_triangles(shape: Any, deflection: float, angle: float) -> None:
    """Give the faces of a shape triangles; those that the mesher fails on, or does not end on, have none.

    Parameters
    ----------
    shape : TopoDS_Shape
    deflection, angle : float
        What is asked of the mesher: mm, rad.
    """
    BRepTools.Clean_s(shape)
    if _meshed(shape, deflection, angle, WHOLE) is not None:
        return
    left = FACES
    for face in faces(shape):
        if left <= 0.0:
            return
        spent = _meshed(face, deflection, angle, min(left, FACE))
        left -= FACE if spent is None else spent


def _meshed(shape: Any, deflection: float, angle: float, seconds: float) -> float | None:
    """Give a shape's faces triangles, and tell the processor time it took; None, and nothing done, where it does not end."""

    def call() -> bytes:
        start, stream = time.process_time(), io.BytesIO()
        BRepMesh_IncrementalMesh(shape, deflection, False, angle, False)
        BinTools.Write_s(shape, stream)
        return f"{time.process_time() - start:.3f} ".encode() + stream.getvalue()

    try:
        spent, _, written = limited(call, seconds, processor=True).partition(b" ")
    except (TimeLimit, ChildDied):
        return None
    found = TopoDS_Shape()
    BinTools.Read_s(found, io.BytesIO(written))
    for face, meshed in zip(faces(shape), faces(found), strict=True):
        triangles = BRep_Tool.Triangulation_s(meshed, TopLoc_Location())
        if triangles is not None:
            BRep_Builder().UpdateFace(face, triangles)
    return float(spent)
