"""The kernel's mesher, to draw faces: on some it never ends, so it works in a copy of the process, face by face."""

import time
from collections.abc import Iterator, Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray
from OCP.BRep import BRep_Tool
from OCP.BRepMesh import BRepMesh_IncrementalMesh
from OCP.BRepTools import BRepTools
from OCP.TopLoc import TopLoc_Location

from cad_io.arrays import Floats
from cad_io.kernel.calls import is_kernel_error
from cad_io.kernel.each import Ended, each

#: Processor time, s: for one face, and for all of them; and so many faces may not end.
FACE, FACES, HANGS = 1.0, 10.0, 5


class Meshed(NamedTuple):
    """Nodes of a face, uv (n, 2) and points (n, 3) mm, and triangles (m, 3), counter-clockwise in the parameter plane."""

    uv: Floats
    point: Floats
    triangle: NDArray[np.int64]


def meshed(faces: Sequence[Any], deflection: float, angle: float) -> Iterator[Meshed | None]:
    """Triangles of each face, in their order; None where the mesher fails, or does not end.

    Two faces that share an edge have the same nodes there but for a few edges (45 of 48,000 on a real part), for it is cut by its
    own curve.

    Parameters
    ----------
    faces : sequence of TopoDS_Face
        They are left without a mesh.
    deflection, angle : float
        What is asked of the mesher: mm, rad.
    """
    left = FACES
    for done in each(lambda face: _meshed(face, deflection, angle), faces, seconds=FACE, hangs=HANGS):
        if left <= 0.0:
            yield None
        elif isinstance(done, Ended):
            left -= FACE
            yield None
        else:
            found, spent = done
            left -= spent
            yield found


def _meshed(face: Any, deflection: float, angle: float) -> tuple[Meshed | None, float]:
    """A face's triangles, and the processor time that they took, s."""
    start = time.process_time()
    # Finer triangles that it carries would be kept.
    BRepTools.Clean_s(face)
    found = None
    try:
        BRepMesh_IncrementalMesh(face, deflection, False, angle, False)
        found = _taken(face)
    except Exception as thrown:
        if not is_kernel_error(thrown):
            raise
    finally:
        BRepTools.Clean_s(face)
    return found, time.process_time() - start


def _taken(face: Any) -> Meshed | None:
    location = TopLoc_Location()
    mesh = BRep_Tool.Triangulation_s(face, location)
    if mesh is None or not mesh.NbTriangles() or not mesh.HasUVNodes():
        return None
    place, count = location.Transformation(), range(1, mesh.NbNodes() + 1)
    return Meshed(
        np.array([mesh.UVNode(i).Coord() for i in count]),
        # Its own nodes, not the surface's points: along an edge these differ from face to face, and show cracks.
        np.array([mesh.Node(i).Transformed(place).Coord() for i in count]),
        np.array([mesh.Triangle(i).Get() for i in range(1, mesh.NbTriangles() + 1)]) - 1,
    )
