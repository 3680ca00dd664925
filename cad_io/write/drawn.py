"""Faces as triangles to look at: from the kernel's mesh of a copy, with exact normals and surface parameters."""

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray
from OCP.Bnd import Bnd_Box
from OCP.BRep import BRep_Tool
from OCP.BRepBndLib import BRepBndLib
from OCP.BRepBuilderAPI import BRepBuilderAPI_Copy
from OCP.TopAbs import TopAbs_REVERSED
from OCP.TopLoc import TopLoc_Location
from OCP.TopoDS import TopoDS

from cad_io.arrays import FaceLabels, Floats
from cad_io.errors import WriteError
from cad_io.kernel import translated
from cad_io.kernel.mesher import give_triangles
from cad_io.part import Part
from cad_io.surface import Surface
from cad_io.write.label_mesh import label_mesh

#: Largest angle between neighbouring facets, rad.
ANGLE = 0.35
#: Default chord error as a share of the part's diagonal.
FINE = 5e-4
_METRE = 1e-3
#: By how much the chord error grows where there are too many triangles, and how often; the angle grows beyond the default chord.
_COARSER, _WIDER, _ROUNDS = 2.0, 1.3, 12


class Mesh(NamedTuple):
    """Points (n, 3) mm and unit normals (n, 3) in part coordinates; triangles (m, 3) counter-clockwise from outside; surface
    parameters (n, 2) of the points."""

    point: Floats
    normal: Floats
    triangle: NDArray[np.uint32]
    uv: Floats


class Drawn(NamedTuple):
    """Meshes by face number; periods of their surfaces' parameters u and v, 0 where there is none; the chord error that was asked
    for, mm; and the faces of which the kernel made no mesh."""

    meshes: dict[int, Mesh]
    periods: dict[int, tuple[float, float]]
    deflection: float
    missing: tuple[int, ...]


def drawn(part: Part, sides: Sequence[float] | Floats, *, most: int, deflection: float | None = None) -> Drawn:
    """Mesh all faces of a part to be looked at; the part itself stays without a mesh.

    Parameters
    ----------
    part : Part
    sides : (faces,) float
        As `Orientation.sign`: normals point out of the material.
    most : int
        Triangles to have at most: where there are more, the chord error grows, as far as that helps.
    deflection : float, optional
        The chord error to begin with, mm; default FINE times the part's diagonal.

    Raises
    ------
    WriteError
        The kernel fails, or makes no triangle at all.
    """
    with translated("meshing", error=WriteError, file=part.file):
        copy = BRepBuilderAPI_Copy(part.shape, False, False)
        usual = FINE * diagonal(part.shape)
        shape, deflection, angle = copy.Shape(), usual if deflection is None else deflection, ANGLE
        faces = [TopoDS.Face_s(copy.ModifiedShape(part.face(f.number))) for f in part.faces]
        for tried in range(_ROUNDS):
            give_triangles(shape, deflection, angle)
            if sum(map(_count, faces)) <= most or tried == _ROUNDS - 1:
                break
            deflection *= _COARSER
            angle = min(1.5, angle * (_WIDER if deflection > usual else 1.0))
        meshes, periods = {}, {}
        for info, face in zip(part.faces, faces, strict=True):
            found = face_mesh(part.face(info.number), face, None, outward=sides[info.number - 1] > 0)
            if found:
                meshes[info.number] = found[0]
                surface = BRep_Tool.Surface_s(face)
                periods[info.number] = (
                    surface.UPeriod() if surface.IsUPeriodic() else 0.0, surface.VPeriod() if surface.IsVPeriodic() else 0.0
                )  # fmt: skip
    if not meshes:
        raise WriteError("the CAD kernel made no triangle of the part", file=part.file)
    return Drawn(meshes, periods, deflection, tuple(f.number for f in part.faces if f.number not in meshes))


def _count(face: Any) -> int:
    mesh = BRep_Tool.Triangulation_s(face, TopLoc_Location())
    return 0 if mesh is None else int(mesh.NbTriangles())


def diagonal(shape: Any) -> float:
    """Of the box around a shape, mm."""
    box = Bnd_Box()
    BRepBndLib.Add_s(shape, box, False)
    return float(np.sqrt(box.SquareExtent()))


def face_mesh(
    face: Any, meshed: Any, labels: FaceLabels | None, *, outward: bool | None = None
) -> dict[int, Mesh] | None:
    """Mesh of a face by label, all of it by the label 0 where there are none; None if the kernel made none.

    Parameters
    ----------
    face, meshed : TopoDS_Face
        The face, and its copy that the kernel has meshed.
    labels : FaceLabels, optional
    outward : bool, optional
        `dS/du x dS/dv` points out of the material. Default: as the face is turned.
    """
    location = TopLoc_Location()
    triangulation = BRep_Tool.Triangulation_s(meshed, location)
    if triangulation is None or not triangulation.HasUVNodes():
        return None
    uv = np.array([triangulation.UVNode(i + 1).Coord() for i in range(triangulation.NbNodes())])
    triangle = np.array([triangulation.Triangle(i + 1).Get() for i in range(triangulation.NbTriangles())]) - 1
    # The mesh's own nodes, not the surface's points: along an edge both faces have the same ones, and no cracks.
    place = location.Transformation()
    nodes = (triangulation.Node(i + 1).Transformed(place).Coord() for i in range(triangulation.NbNodes()))
    point, label = np.array(list(nodes)), np.zeros(len(triangle), np.int32)
    if labels is not None:
        uv, point, triangle, label = label_mesh(face, uv, point, triangle, labels)
    s = Surface(face).first(uv[:, 0], uv[:, 1])
    normal = np.cross(s[:, 1], s[:, 2])
    turned = face.Orientation() == TopAbs_REVERSED
    # The kernel's triangles run counter-clockwise in the parameter plane, whichever way the face is turned.
    if turned if outward is None else not outward:
        triangle, normal = triangle[:, ::-1], -normal
    # Corners that are one point in 32 bits make a triangle without a normal or an inside.
    corner = (point * _METRE).astype(np.float32)[triangle]
    facet = np.cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0]).astype(float)
    kept = (facet**2).sum(1) > 0
    triangle, facet, label = triangle[kept], facet[kept], label[kept]
    tangents = s[:, 1:]
    length = np.linalg.norm(normal, axis=1)
    # At a pole the tangents give no normal: there the facets around it do.
    pole = ~(length > 1e-6 * np.linalg.norm(tangents, axis=2).prod(axis=1))
    around = np.zeros_like(point)
    np.add.at(around, triangle, facet[:, None] / np.linalg.norm(facet, axis=1)[:, None, None])
    normal = np.where(pole[:, None], around, normal / np.where(pole, 1.0, length)[:, None])
    meshes = {}
    for value in np.unique(label).tolist():
        used, mine = np.unique(triangle[label == value], return_inverse=True)
        unit = normal[used] / np.linalg.norm(normal[used], axis=1)[:, None]
        meshes[value] = Mesh(point[used], unit, mine.reshape(-1, 3).astype(np.uint32), uv[used])
    return meshes
