"""Meshes as users of mesh libraries make them: of a part by the CAD kernel, of a tool by turning its outline."""

from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from conformance.programs import needs
from conformance.suite import Held
from conformance.tool import Floats, Piece, Tool

#: The size (mm) of the block that stands for a table.
_TABLE = 2000.0
#: Two triangles for each side of a box whose corners are in the order of `_corners`.
_SIDES = np.array([[0, 1, 3], [0, 3, 2], [4, 6, 7], [4, 7, 5], [0, 4, 5], [0, 5, 1], [2, 3, 7], [2, 7, 6], [0, 2, 6], [0, 6, 4], [1, 5, 7], [1, 7, 3]])


@dataclass(frozen=True, eq=False)
class Mesh:
    """Triangles: `vertices (n, 3)`, mm, and `faces (m, 3)`, counter-clockwise from outside."""

    vertices: Floats
    faces: NDArray[np.int64]

    @classmethod
    def joined(cls, meshes: list["Mesh"]) -> "Mesh":
        """Return several as one."""
        first = np.cumsum([0, *(len(m.vertices) for m in meshes)])
        return cls(np.vstack([m.vertices for m in meshes]), np.vstack([m.faces + k for m, k in zip(meshes, first, strict=False)]))


def part_mesh(path: Path, chord: float, angle: float) -> Mesh:
    """Return the part's faces as the CAD kernel meshes them: chord error `chord` (mm), `angle` (rad) between neighbours.

    Seams are joined by position.
    """
    needs("OCP", "cadquery-ocp")
    from OCP.BRep import BRep_Tool
    from OCP.BRepMesh import BRepMesh_IncrementalMesh
    from OCP.TopAbs import TopAbs_FACE, TopAbs_REVERSED
    from OCP.TopExp import TopExp_Explorer
    from OCP.TopLoc import TopLoc_Location
    from OCP.TopoDS import TopoDS

    from conformance.exact.slow import read

    shape = read(path)
    BRepMesh_IncrementalMesh(shape, chord, False, angle, False)
    meshes, walk = [], TopExp_Explorer(shape, TopAbs_FACE)
    while walk.More():
        face, place = TopoDS.Face_s(walk.Current()), TopLoc_Location()
        walk.Next()
        made = BRep_Tool.Triangulation_s(face, place)
        if made is None:
            continue
        move = place.Transformation()
        points = [made.Node(i + 1).Transformed(move) for i in range(made.NbNodes())]
        faces = np.array([made.Triangle(i + 1).Get() for i in range(made.NbTriangles())], np.int64).reshape(-1, 3) - 1
        if face.Orientation() == TopAbs_REVERSED:
            faces = faces[:, ::-1]
        meshes.append(Mesh(np.array([(p.X(), p.Y(), p.Z()) for p in points]).reshape(-1, 3), faces))
    whole = Mesh.joined(meshes)
    _, first, same = np.unique(np.round(whole.vertices, 7), axis=0, return_index=True, return_inverse=True)
    faces = same.reshape(-1)[whole.faces]
    distinct = (faces[:, 0] != faces[:, 1]) & (faces[:, 1] != faces[:, 2]) & (faces[:, 2] != faces[:, 0])
    return Mesh(whole.vertices[first], faces[distinct])


def fixture_meshes(setup: Held) -> list[Mesh]:
    """Return the boxes of a setup, and a block for its table."""
    meshes = [Mesh(_corners(np.array(low, float), np.array(high, float)), _SIDES) for low, high in setup.boxes]
    if setup.table is not None:
        up = np.array(setup.axis, float) / np.linalg.norm(setup.axis)
        side = np.cross(up, np.eye(3)[np.argmin(np.abs(up))])
        side /= np.linalg.norm(side)
        block = _corners(np.array([-_TABLE, -_TABLE, setup.table - 0.5 * _TABLE]), np.array([_TABLE, _TABLE, setup.table]))
        meshes.append(Mesh(block @ np.array([side, np.cross(up, side), up]), _SIDES))
    return meshes


def _corners(low: Floats, high: Floats) -> Floats:
    return np.array([(x, y, z) for x in (low[0], high[0]) for y in (low[1], high[1]) for z in (low[2], high[2])])


def outlines(tool: Tool, shrunk: float, chord: float) -> list[Floats]:
    """Return for each convex piece of a tool, shrunk by `shrunk` (mm), a line `(k, 2)` of height and radius.

    It goes from the axis below to the axis above, and lies within the piece: arcs are chords of a height of at most `chord`
    (mm).
    """
    lines = []
    for piece in tool.pieces:
        smaller, gone = piece.inset(shrunk)
        if not np.any(gone):
            lines.append(_outline(smaller, chord))
    return lines


def _outline(piece: Piece, chord: float) -> Floats:
    h0, r0, h1, r1, rho = (float(np.max(getattr(piece, name))) for name in ("h0", "r0", "h1", "r1", "rho"))
    if rho == 0:
        return _distinct(np.array([(h0, 0.0), (h0, r0), (h1, r1), (h1, 0.0)]))
    # The rounded disks and balls of this benchmark's tools: half circles about the edges of the core.
    steps = max(4, int(np.ceil(np.pi / 2 / np.arccos(max(0.0, 1 - chord / max(rho, chord))) / 2)))
    turn = np.linspace(-np.pi / 2, 0.0, steps + 1)
    low = np.column_stack([h0 + rho * np.sin(turn), r0 + rho * np.cos(turn)])
    high = np.column_stack([h1 - rho * np.sin(turn[::-1]), r1 + rho * np.cos(turn[::-1])])
    return _distinct(np.vstack([[(h0 - rho, 0.0)], low, high, [(h1 + rho, 0.0)]]))


def _distinct(line: Floats) -> Floats:
    step = np.linalg.norm(np.diff(line, axis=0), axis=1)
    return line[np.concatenate([[True], step > 1e-9])]


def segments(tool: Tool, chord: float) -> int:
    """Return how many sides a circle of the tool's largest radius has, with a chord error of `chord` (mm)."""
    radius = max(float(v[1]) for v in (*tool.cutter, *tool.holder))
    return int(np.clip(np.ceil(np.pi / np.arccos(max(0.5, 1 - chord / radius))), 16, 360))


def turned(line: Floats, sides: int) -> Mesh:
    """Return the closed surface that a line (k, 2) of height and radius makes when it is turned; circles are polygons within."""
    turn = 2 * np.pi * np.arange(sides) / sides
    circle = np.column_stack([np.cos(turn), np.sin(turn)])
    vertices, rings = [], []
    count = 0
    for h, r in line:
        n = 1 if r < 1e-9 else sides
        ring = np.zeros((1, 2)) if n == 1 else r * circle
        vertices.append(np.column_stack([ring, np.full(n, h)]))
        rings.append(count + np.arange(n))
        count += n
    faces = []
    for low, high in pairwise(rings):
        if len(low) > 1:
            faces.append(np.column_stack([low, np.roll(low, -1), np.broadcast_to(high, len(low)) if len(high) == 1 else high]))
        if len(high) > 1:
            base = np.broadcast_to(low, len(high)) if len(low) == 1 else np.roll(low, -1)
            faces.append(np.column_stack([base, np.roll(high, -1), high]))
    return Mesh(np.vstack(vertices), np.vstack(faces).astype(np.int64))


def frames(axis: Floats) -> Floats:
    """Return rotations (n, 3, 3) that take the z axis to each axis (n, 3): the columns are x, y, axis."""
    x = np.cross(axis, np.where(np.abs(axis[:, :1]) < 0.7, [[1.0, 0, 0]], [[0, 1.0, 0]]))
    x /= np.linalg.norm(x, axis=1)[:, None]
    return np.stack([x, np.cross(axis, x), axis], axis=2)
