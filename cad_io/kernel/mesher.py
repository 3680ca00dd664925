"""The kernel's mesher, to draw faces: on some it never ends, so it works in a copy of the process, face by face."""

import time
from collections.abc import Callable, Iterator, Sequence
from typing import Any, NamedTuple, TypeVar

import numpy as np
from numpy.typing import NDArray
from OCP.BRep import BRep_Tool
from OCP.BRepMesh import BRepMesh_IncrementalMesh
from OCP.BRepTools import BRepTools
from OCP.TopLoc import TopLoc_Location

from cad_io.arrays import Floats
from cad_io.kernel.calls import may_refuse
from plan_cutters_base.forks import Ended, each

Taken = TypeVar("Taken")

#: Processor time, s: for one face, and for all of them; and so many faces may not end.
FACE, FACES, HANGS = 2.0, 15.0, 5


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
    remaining = FACES
    for done in each(lambda face: _meshed(face, deflection, angle), faces, seconds=FACE, hangs=HANGS):
        if remaining <= 0.0:
            yield None
        elif isinstance(done, Ended):
            remaining -= FACE
            yield None
        else:
            meshes, spent = done
            remaining -= spent
            yield meshes


def under_mesh(
    face: Any, deflection: float, angle: float, take: Callable[[Any, TopLoc_Location], Taken]
) -> tuple[Taken | None, float]:
    """Mesh a face here, without a limit: what `take` makes of its mesh, and the processor time that both took, s.

    Parameters
    ----------
    face : TopoDS_Face
        It is left without a mesh.
    deflection, angle : float
        What is asked of the mesher: mm, rad.
    take : callable
        Of the mesh and its place. Not called where the mesher makes no triangle: then None is the answer.
    """
    start = time.process_time()
    # Finer triangles that it carries would be kept.
    BRepTools.Clean_s(face)
    try:
        BRepMesh_IncrementalMesh(face, deflection, False, angle, False)
        place = TopLoc_Location()
        mesh = BRep_Tool.Triangulation_s(face, place)
        empty = mesh is None or not mesh.NbTriangles() or not mesh.HasUVNodes()
        taken = None if empty else take(mesh, place)
    finally:
        BRepTools.Clean_s(face)
    return taken, time.process_time() - start


def uv_triangles(mesh: Any) -> tuple[Floats, NDArray[np.int64]]:
    """Nodes (n, 2) of a mesh in the parameter plane, and its triangles (m, 3), rows of them."""
    return (
        np.array([mesh.UVNode(i).Coord() for i in range(1, mesh.NbNodes() + 1)]),
        np.array([mesh.Triangle(i).Get() for i in range(1, mesh.NbTriangles() + 1)]) - 1,
    )


def _meshed(face: Any, deflection: float, angle: float) -> tuple[Meshed | None, float]:
    start = time.process_time()
    with may_refuse():
        return under_mesh(face, deflection, angle, _mesh)
    return None, time.process_time() - start


def _mesh(mesh: Any, location: TopLoc_Location) -> Meshed:
    place = location.Transformation()
    uv, triangle = uv_triangles(mesh)
    # Its own nodes, not the surface's points: along an edge these differ from face to face, and show cracks.
    points = np.array([mesh.Node(i).Transformed(place).Coord() for i in range(1, mesh.NbNodes() + 1)])
    return Meshed(uv, points, triangle)
