"""Faces as triangles to look at, with exact normals and surface parameters."""

from collections.abc import Collection, Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray
from OCP.Bnd import Bnd_Box
from OCP.BRep import BRep_Tool
from OCP.BRepBndLib import BRepBndLib
from OCP.TopAbs import TopAbs_REVERSED

from cad_io.arrays import FaceLabels, Floats, Ints
from cad_io.errors import WriteError
from cad_io.kernel import translated
from cad_io.kernel.mesher import Meshed
from cad_io.part import Part
from cad_io.surface import Surface
from cad_io.tessellate.start import expected, starts
from cad_io.write.label_mesh import label_mesh
from cad_io.write.net import Net, cut

#: Largest angle between neighbouring facets, rad.
ANGLE = 0.35
#: Default chord error as a share of the part's diagonal.
FINE = 5e-4
_METRE = 1e-3
#: How much coarser the triangles are that drawing begins with.
_COARSER = 2.0
#: The least chord error that it begins with, as a share of the part's diagonal: what is finer is cut.
_FINEST = 1e-4


class Mesh(NamedTuple):
    """Points (n, 3) mm and unit normals (n, 3) in part coordinates; triangles (m, 3) counter-clockwise from outside; surface
    parameters (n, 2) of the points."""

    point: Floats
    normal: Floats
    triangle: NDArray[np.uint32]
    uv: Floats


class RenderMesh(NamedTuple):
    """Meshes by face number; periods of their surfaces' parameters u and v, 0 where there is none; the chord error that was asked
    for, mm; and the faces of which the kernel made no mesh."""

    meshes: dict[int, Mesh]
    periods: dict[int, tuple[float, float]]
    deflection: float
    missing: tuple[int, ...]


def render_mesh(
    part: Part, sides: Sequence[float] | Floats, *, most: int, deflection: float | None = None, without: Collection[int] = ()
) -> RenderMesh:
    """Mesh all faces of a part to be looked at; the part itself stays without a mesh.

    Coarse triangles are cut where they lie farthest from the surface, until they are near enough or there are as many as are
    wanted: the time goes with what is drawn.

    Parameters
    ----------
    part : Part
    sides : (faces,) float
        As `Orientation.sign`: normals point out of the material.
    most : int
        Triangles to have at most, but for those to begin with: where there would be more, the chord error grows.
    deflection : float, optional
        The chord error to begin with, mm; default FINE times the part's diagonal.
    without : collection of int
        Numbers of faces that are not shown.

    Raises
    ------
    WriteError
        The kernel fails, or makes no triangle at all.
    """
    with translated("meshing", error=WriteError, file=part.file):
        wanted = FINE * diagonal(part.shape) if deflection is None else deflection
        numbers = [f.number for f in part.faces if f.number not in without]
        begun, _ = starts(part, numbers, _begun(part, numbers, wanted, most), again=True)
        nets = {number: Net.of(part.surface(number), start) for number, start in begun.items()}
        off = cut(list(nets.values()), wanted, ANGLE, most)
        meshes, periods = {}, {}
        for number, net in nets.items():
            whole = np.zeros(len(net.corner), np.int32)
            mesh = _finished(net.surface, net.uv, net.point, net.corner, whole, turned=not sides[number - 1] > 0)
            if mesh:
                meshes[number] = mesh[0]
                surface = BRep_Tool.Surface_s(part.face(number))
                periods[number] = (
                    surface.UPeriod() if surface.IsUPeriodic() else 0.0,
                    surface.VPeriod() if surface.IsVPeriodic() else 0.0,
                )
    if not meshes:
        raise WriteError("the CAD kernel made no triangle of the part", file=part.file)
    return RenderMesh(meshes, periods, max(wanted, off), tuple(n for n in numbers if n not in meshes))


def _begun(part: Part, numbers: Sequence[int], wanted: float, most: int) -> float:
    """The chord error to begin with, mm: one that leaves triangles to be laid where they are wanted most."""
    size = diagonal(part.shape)
    chord = max(_COARSER * wanted, _FINEST * size)
    while chord < size and expected(part, numbers, chord) > 0.5 * most:
        chord *= 4.0
    return chord


def diagonal(shape: Any) -> float:
    """Of the box around a shape, mm."""
    box = Bnd_Box()
    BRepBndLib.Add_s(shape, box, False)
    return float(np.sqrt(box.SquareExtent()))


def face_mesh(face: Any, surface: Surface, meshed: Meshed | None, labels: FaceLabels | None) -> dict[int, Mesh] | None:
    """Mesh of a face by label, all of it by the label 0 where there are none; None if the kernel made none.

    Parameters
    ----------
    face : TopoDS_Face
    surface : Surface
        That it lies on.
    meshed : Meshed, optional
        Its triangles, of the kernel.
    labels : FaceLabels, optional
    """
    if meshed is None:
        return None
    uv, point, triangle = meshed
    label = np.zeros(len(triangle), np.int32)
    if labels is not None:
        uv, point, triangle, label = label_mesh(face, uv, point, triangle, labels)
    return _finished(surface, uv, point, triangle, label, turned=face.Orientation() == TopAbs_REVERSED)


def _finished(
    surface: Surface, uv: Floats, point: Floats, triangle: NDArray[np.int64], label: Ints, *, turned: bool
) -> dict[int, Mesh]:
    """Meshes by label, with exact normals; `turned`: `dS/du x dS/dv` points into the material."""
    s = surface.first(uv[:, 0], uv[:, 1])
    normal = np.cross(s[:, 1], s[:, 2])
    if turned:
        triangle, normal = triangle[:, ::-1], -normal
    # Corners that are one point in 32 bits make a triangle without a normal or an inside.
    corner = (point * _METRE).astype(np.float32)[triangle]
    facet = np.cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0]).astype(float)
    valid = (facet**2).sum(1) > 0
    triangle, facet, label = triangle[valid], facet[valid], label[valid]
    tangents = s[:, 1:]
    length = np.linalg.norm(normal, axis=1)
    # At a pole the tangents give no normal: there the facets around it do.
    pole = ~(length > 1e-6 * np.linalg.norm(tangents, axis=2).prod(axis=1))
    normals = np.zeros_like(point)
    np.add.at(normals, triangle, facet[:, None] / np.linalg.norm(facet, axis=1)[:, None, None])
    normal = np.where(pole[:, None], normals, normal / np.where(pole, 1.0, length)[:, None])
    meshes = {}
    for value in np.unique(label).tolist():
        used, mine = np.unique(triangle[label == value], return_inverse=True)
        unit = normal[used] / np.linalg.norm(normal[used], axis=1)[:, None]
        meshes[value] = Mesh(point[used], unit, mine.reshape(-1, 3).astype(np.uint32), uv[used])
    return meshes
