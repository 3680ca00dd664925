"""The kernel's mesher: triangles of faces to be drawn, or in the parameter plane to begin with.

Of what others begin with only the parameter plane is taken from it: that it covers the trim. How near its triangles come to the
surface is a wish (0.107 mm was found where 0.01 was asked), so points are evaluated, and refined, by who asks. It works in a copy
of the process, face by face: on some faces it never ends.
"""

import time
from collections.abc import Callable, Iterator, Sequence
from functools import partial
from itertools import pairwise
from typing import Any, NamedTuple, TypeVar

import numpy as np
from numpy.typing import NDArray
from OCP.BRep import BRep_Tool
from OCP.BRepAdaptor import BRepAdaptor_Curve2d
from OCP.BRepMesh import BRepMesh_IncrementalMesh
from OCP.BRepTools import BRepTools
from OCP.TopLoc import TopLoc_Location
from OCP.TopoDS import TopoDS

from cad_io.arrays import Floats, Ints
from cad_io.kernel import bounding, may_refuse
from cad_io.part import Part
from cad_io.surface import Surface
from cad_io.tessellate.planar import upright
from plan_cutters_base.forks import ChildDied, Ended, each, limited

Taken = TypeVar("Taken")

#: Processor time, s: for one face, and for all of them; and so many faces may not end.
FACE, FACES, HANGS = 2.0, 15.0, 5


class Meshed(NamedTuple):
    """Nodes of a face, uv (n, 2) and points (n, 3) mm, and triangles (m, 3), counter-clockwise in the parameter plane."""

    uv: Floats
    point: Floats
    triangle: NDArray[np.int64]


def meshed(faces: Sequence[Any], deflection: float, angle: float) -> Iterator[Meshed | None]:
    """Triangles of each face, in their order; None where the mesher, asked for a deflection (mm) and an angle (rad), fails or
    does not end.

    Two faces that share an edge have the same nodes there but for a few edges (45 of 48,000 on a real part), for it is cut by its
    own curve. The faces are left without a mesh.
    """

    def taken(mesh: Any, location: TopLoc_Location) -> Meshed:
        uv, triangle = uv_triangles(mesh)
        # Its own nodes, not the surface's points: along an edge these differ from face to face, and show cracks.
        return Meshed(uv, nodes_of(mesh, location), triangle)

    def work(face: Any) -> tuple[Meshed | None, float]:
        start = time.process_time()
        with may_refuse():
            return under_mesh(face, deflection, angle, taken)
        return None, time.process_time() - start

    remaining = FACES
    for done in each(work, faces, seconds=FACE, hangs=HANGS):
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
    """Mesh a face here, without a limit: what `take` makes of its mesh and its place, and the processor time that both took, s.

    The face is left without a mesh. Where the mesher, asked for a deflection (mm) and an angle (rad), makes no triangle, None is
    the answer.
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


def nodes_of(mesh: Any, location: TopLoc_Location) -> Floats:
    """Nodes (n, 3) of a mesh in its place, mm."""
    place = location.Transformation()
    return np.array([mesh.Node(i).Transformed(place).Coord() for i in range(1, mesh.NbNodes() + 1)])


def uv_triangles(mesh: Any) -> tuple[Floats, NDArray[np.int64]]:
    """Nodes (n, 2) of a mesh in the parameter plane, and its triangles (m, 3), rows of them."""
    return (
        np.array([mesh.UVNode(i).Coord() for i in range(1, mesh.NbNodes() + 1)]),
        np.array([mesh.Triangle(i).Get() for i in range(1, mesh.NbTriangles() + 1)]) - 1,
    )


#: How far a border curve may pass a mesh's nodes, mm.
_ON = 1e-7
_SAME = 1e-13  # of a parameter: what differs by less need not be measured


class BorderCurve(NamedTuple):
    """One edge use in a mesh: nodes (k,) along it, their parameters (k,), and the parameter curve."""

    nodes: Ints
    parameter: Floats
    curve: BRepAdaptor_Curve2d


class UVMesh(NamedTuple):
    """Triangles of one face: uv (n, 2), corner (t, 3) rows of uv, counter-clockwise; border curves."""

    uv: Floats
    corner: Ints
    border: tuple[BorderCurve, ...]


def kernel_start(part: Part, number: int, deflection: float, angle: float, seconds: float) -> tuple[UVMesh | None, float]:
    """Mesh a face by the kernel's mesher, which may never end: its triangles, None where it fails, and the seconds it took.

    Of a deflection (mm) and an angle (rad) it is asked for; `seconds`: of processor time that it may take, else TimeLimit.
    """

    face = part.face(number)
    try:
        taken, spent = limited(lambda: under_mesh(face, deflection, angle, partial(_taken, face)), seconds, processor=True)
    except ChildDied:
        return None, 0.0
    if taken is None:
        return None, spent
    uv, corner, runs = taken
    forward, edges = bounding(face)
    border, on_curve = [], []
    for (edge, _), (nodes, parameter) in zip(edges, runs, strict=True):
        # A seam has two curves, and the mesher does not always give each its own polygon: take the one that fits.
        uses = (edge, TopoDS.Edge_s(edge.Reversed())) if BRep_Tool.IsClosed_s(edge, forward) else (edge,)
        curves = [BRepAdaptor_Curve2d(use, forward) for use in uses]
        there = [np.array([curve.Value(t).Coord() for t in parameter.tolist()]) for curve in curves]
        best = int(np.argmin([np.abs(on - uv[nodes]).max() for on in there]))
        border.append(BorderCurve(nodes, parameter, curves[best]))
        on_curve.append(there[best])
    return bordered(UVMesh(uv, upright(uv, corner), tuple(border)), on_curve, part.surface(number)), spent


_Taken = tuple[Floats, Ints, list[tuple[Ints, Floats]]]


def _taken(face: Any, mesh: Any, place: TopLoc_Location) -> _Taken | None:
    """Nodes and triangles of the mesher, and of each edge's use the nodes and their parameters."""
    runs = []
    for edge, _ in bounding(face)[1]:
        polygon = BRep_Tool.PolygonOnTriangulation_s(edge, mesh, place)
        if polygon is None or not polygon.HasParameters():
            return None  # how far its triangles stay from this edge could not be told
        count = range(1, polygon.NbNodes() + 1)
        runs.append(
            (np.array([polygon.Node(i) for i in count], dtype=np.int32) - 1, np.array([polygon.Parameter(i) for i in count]))
        )
    uv, corner = uv_triangles(mesh)
    return uv, corner.astype(np.int32), runs


def bordered(mesh: UVMesh, on_curve: Sequence[Floats], surface: Surface) -> UVMesh:
    """The mesh, and triangles from its outline to the border curves where these pass its nodes.

    The mesher has one node for all edges that end in a vertex, however far apart their curves end (0.01 mm was found
    where 1e-7 was said). Each curve gets nodes of its own there, and the gap between them and the mesh is filled.
    """
    uv, corner, border = [mesh.uv], [mesh.corner], []
    count = len(mesh.uv)
    ends: dict[int, list[int]] = {}
    # All borders at once: a call for each takes longer than its points.
    every = [mesh.uv[border.nodes] for border in mesh.border]
    here, there = np.concatenate([*every, mesh.uv[:0]]), np.concatenate([*on_curve, mesh.uv[:0]])
    different = np.flatnonzero((np.abs(there - here) > _SAME * np.maximum(1.0, np.abs(here))).any(axis=1))
    if not len(different):
        return mesh
    point = surface.values(*np.concatenate([there[different], here[different]]).T)
    off = point[: len(different)] - point[len(different) :]
    different = different[np.linalg.norm(off, axis=1) > _ON]
    if not len(different):
        return mesh
    firsts = np.cumsum([0, *map(len, every)])
    for (nodes, parameter, curve), first, last in zip(mesh.border, firsts[:-1], firsts[1:], strict=True):
        passed = different[(different >= first) & (different < last)] - first
        if not len(passed):
            border.append(BorderCurve(nodes, parameter, curve))
            continue
        own = nodes.copy()
        own[passed] = count + np.arange(len(passed))
        count += len(passed)
        uv.append(there[first + passed])
        corner.append(_filled(nodes, own))
        border.append(BorderCurve(own, parameter, curve))
        for node, new in zip(nodes[passed].tolist(), own[passed].tolist(), strict=True):
            ends.setdefault(node, []).append(new)
    for node, news in ends.items():
        corner.append(np.array([(node, a, b) for a, b in pairwise(news)], np.int32).reshape(-1, 3))
    points = np.concatenate(uv)
    return UVMesh(points, upright(points, np.concatenate(corner)), tuple(border))


def _filled(nodes: Ints, own: Ints) -> Ints:
    """Triangles between a polygon of the mesh and a border curve's own nodes, which differ in some."""
    (a, b), (c, d) = (nodes[:-1], nodes[1:]), (own[:-1], own[1:])
    made = np.concatenate([np.stack([a, c, d], axis=1)[c != a], np.stack([a, d, b], axis=1)[d != b]])
    return made.astype(np.int32)
