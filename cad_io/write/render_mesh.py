"""Faces as triangles to look at, with exact normals and surface parameters.

They are cut where they lie farthest from the surface, until they are near enough or enough. Both triangles at an edge are cut
where it is, so that no cracks open within a face. What is drawn proves nothing: distances are looked at in the middles of edges
and of triangles.
"""

from collections.abc import Collection, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray
from OCP.Bnd import Bnd_Box
from OCP.BRep import BRep_Tool
from OCP.BRepBndLib import BRepBndLib

from cad_io.arrays import Floats
from cad_io.errors import WriteError
from cad_io.kernel import periods, translated
from cad_io.part import Part
from cad_io.surface import Surface
from cad_io.tessellate.mesh import BorderCurve, UVMesh
from cad_io.tessellate.start import expected, starts

Indices = NDArray[np.int64]

#: Rounds of cutting; each brings triangles four times nearer.
_ROUNDS = 6
#: The border of a face is drawn as a line, in which corners are seen sooner than in a shaded surface: there edges may turn by
#: this share of the angle.
_BORDER = 0.4
#: Where edges turn too much, they are cut down to this share of the chord error.
_LEAST = 1 / 16
#: New triangles of a triangle with corners 0, 1, 2 and new nodes 3, 4, 5 in its edges from these, by which edges are cut.
_PARTS = {
    0: [(0, 1, 2)],
    1: [(0, 3, 2), (3, 1, 2)],
    2: [(0, 1, 4), (0, 4, 2)],
    4: [(0, 1, 5), (5, 1, 2)],
    3: [(3, 1, 4), (0, 3, 4), (0, 4, 2)],
    6: [(5, 4, 2), (0, 1, 4), (0, 4, 5)],
    5: [(0, 3, 5), (3, 1, 2), (3, 2, 5)],
    7: [(0, 3, 5), (3, 1, 4), (5, 4, 2), (3, 4, 5)],
}


@dataclass(slots=True)
class Net:
    """A face's triangles."""

    surface: Surface
    #: (n, 2); surface parameters of the nodes, and where they are, mm.
    uv: Floats
    point: Floats
    #: (t, 3); counter-clockwise in the parameter plane.
    corner: Indices
    #: Two nodes in order, that are neighbours on a border curve -> its number, and its parameters at them.
    border: dict[tuple[int, int], tuple[int, float, float]]
    curves: Sequence[BorderCurve]

    @staticmethod
    def of(surface: Surface, start: UVMesh) -> "Net":
        """The triangles that a mesh begins with."""
        border = {}
        for k, each in enumerate(start.border):
            nodes, at = each.nodes.tolist(), each.parameter.tolist()
            for a, b, s, t in zip(nodes[:-1], nodes[1:], at[:-1], at[1:], strict=True):
                border[min(a, b), max(a, b)] = (k, s, t) if a < b else (k, t, s)
        point = surface.values(start.uv[:, 0], start.uv[:, 1])
        return Net(surface, start.uv, point, start.corner.astype(np.int64), border, start.border)

    def looked_at(self, chord: float, angle: float) -> "Look":
        """How far the edges' middles lie from the surface."""
        there, count = np.roll(self.corner, -1, axis=1), len(self.uv)
        key, of = np.unique(np.minimum(self.corner, there) * count + np.maximum(self.corner, there), return_inverse=True)
        edge, of = np.stack([key // count, key % count], axis=1), of.reshape(-1, 3)
        uv = 0.5 * (self.uv[edge[:, 0]] + self.uv[edge[:, 1]])
        ends, most = np.array(list(self.border), np.int64).reshape(-1, 2), np.full(len(key), angle)
        at = np.minimum(np.searchsorted(key, ends[:, 0] * count + ends[:, 1]), len(key) - 1)
        for i, (k, s, t), (a, b) in zip(at.tolist(), self.border.values(), ends.tolist(), strict=True):
            if key[i] == a * count + b:
                uv[i] = self.curves[k].curve.Value(0.5 * (s + t)).Coord()
                most[i] = _BORDER * angle
        point, (first, last) = self.surface.values(uv[:, 0], uv[:, 1]), self.point[edge.T]
        off, length = np.linalg.norm(point - 0.5 * (first + last), axis=1), np.linalg.norm(last - first, axis=1)
        # What the middle of a triangle is off counts for its longest edge.
        inner = self.uv[self.corner].mean(axis=1)
        deep = np.linalg.norm(self.surface.values(inner[:, 0], inner[:, 1]) - self.point[self.corner].mean(axis=1), axis=1)
        longest = of[np.arange(len(of)), length[of].argmax(axis=1)]
        np.maximum.at(off, longest, deep)
        off = np.where(np.isfinite(off) & np.isfinite(point).all(axis=1), off, 0.0)
        # An arc with the sagitta s over the length l turns by about 8 s / l.
        turns = 8.0 * off > most * length
        least = np.where(most < angle, 0.0, _LEAST * chord)
        worth = np.where(off > chord, off, np.where(turns & (off > least), 0.5 * chord, 0.0))
        return Look(edge, of, uv, point, off, worth)

    def cut(self, look: "Look", chosen: NDArray[np.bool_]) -> None:
        """Cut chosen edges in their middles, and the triangles at them."""
        new = np.full(len(chosen), -1, np.int64)
        new[chosen] = len(self.uv) + np.arange(int(chosen.sum()))
        for i in np.flatnonzero(chosen).tolist() if self.border else ():
            a, b = look.edge[i].tolist()
            if (a, b) in self.border:
                k, s, t = self.border.pop((a, b))
                self.border[a, int(new[i])], self.border[b, int(new[i])] = (k, s, 0.5 * (s + t)), (k, t, 0.5 * (s + t))
        self.uv, self.point = np.vstack([self.uv, look.uv[chosen]]), np.vstack([self.point, look.point[chosen]])
        six = np.hstack([self.corner, new[look.of]])
        kind = (chosen[look.of] * np.array([1, 2, 4])).sum(axis=1)
        self.corner = np.concatenate([six[kind == k][:, np.array(_PARTS[k])].reshape(-1, 3) for k in _PARTS])


@dataclass(frozen=True, slots=True)
class Look:
    """Edges (m, 2) of a net, those of each triangle (t, 3), their middles, uv (m, 2) and point (m, 3) mm, how far these are from
    them, off (m,) mm, and what cutting each is worth, worth (m,), 0: nothing."""

    edge: Indices
    of: Indices
    uv: Floats
    point: Floats
    off: Floats
    worth: Floats


def cut(nets: Sequence[Net], chord: float, angle: float, most: int) -> float:
    """Cut triangles of faces that are farther from them than a chord error, mm, or whose edges turn by more than an angle, rad.

    The farthest are cut first; it ends where there are so many triangles. Returns the largest distance seen that is left, mm.
    """
    first = 0.0
    open_nets = list(nets)
    for _ in range(_ROUNDS):
        looks = [net.looked_at(chord, angle) for net in open_nets]
        # A face that is near enough is not looked at again.
        wanted = [bool((look.worth > 0.0).any()) for look in looks]
        open_nets = [net for net, more in zip(open_nets, wanted, strict=True) if more]
        looks = [look for look, more in zip(looks, wanted, strict=True) if more]
        # A cut edge makes two more triangles.
        quota = (most - sum(len(net.corner) for net in nets)) // 2
        worth = np.concatenate([np.zeros(0), *(look.worth for look in looks)])
        count = int((worth > 0.0).sum())
        first = float(worth.max(initial=0.0))
        if not count or quota <= 0:
            break
        chosen = worth > 0.0
        if count > quota:
            chosen[:] = False
            chosen[np.argsort(-worth, kind="stable")[:quota]] = True
        ends = np.cumsum([len(look.worth) for look in looks])[:-1]
        for net, look, mine in zip(open_nets, looks, np.split(chosen, ends), strict=True):
            net.cut(look, mine)
    return first


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
    wanted: the time goes with what is drawn. sides (faces,): as `Orientation.sign`: normals point out of the material. most:
    triangles to have at most, but for those to begin with: where there would be more, the chord error grows. deflection: the
    chord error to begin with, mm; default FINE times the part's diagonal. without: numbers of faces that are not shown.

    Raises WriteError where the kernel fails, or makes no triangle at all.
    """
    with translated("meshing", error=WriteError, file=part.file):
        wanted = FINE * diagonal(part.shape) if deflection is None else deflection
        numbers = [f.number for f in part.faces if f.number not in without]
        begun, _ = starts(part, numbers, _begun(part, numbers, wanted, most), again=True)
        nets = {number: Net.of(part.surface(number), start) for number, start in begun.items()}
        off = cut(list(nets.values()), wanted, ANGLE, most)
        meshes, turns = {}, {}
        for number, net in nets.items():
            mesh = with_normals(net.surface, net.uv, net.point, net.corner, turned=not sides[number - 1] > 0)
            if mesh:
                meshes[number] = mesh
                turns[number] = periods(BRep_Tool.Surface_s(part.face(number)))
    if not meshes:
        raise WriteError("the CAD kernel made no triangle of the part", file=part.file)
    return RenderMesh(meshes, turns, max(wanted, off), tuple(n for n in numbers if n not in meshes))


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


def with_normals(surface: Surface, uv: Floats, point: Floats, triangle: NDArray[np.int64], *, turned: bool) -> Mesh | None:
    """A mesh with exact normals, None without a triangle; `turned`: `dS/du x dS/dv` points into the material."""
    s = surface.first(uv[:, 0], uv[:, 1])
    normal = np.cross(s[:, 1], s[:, 2])
    if turned:
        triangle, normal = triangle[:, ::-1], -normal
    # Corners that are one point in 32 bits make a triangle without a normal or an inside.
    corner = (point * _METRE).astype(np.float32)[triangle]
    facet = np.cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0]).astype(float)
    valid = (facet**2).sum(1) > 0
    triangle, facet = triangle[valid], facet[valid]
    if not len(triangle):
        return None
    tangents = s[:, 1:]
    length = np.linalg.norm(normal, axis=1)
    # At a pole the tangents give no normal: there the facets around it do.
    pole = ~(length > 1e-6 * np.linalg.norm(tangents, axis=2).prod(axis=1))
    normals = np.zeros_like(point)
    np.add.at(normals, triangle, facet[:, None] / np.linalg.norm(facet, axis=1)[:, None, None])
    normal = np.where(pole[:, None], normals, normal / np.where(pole, 1.0, length)[:, None])
    used, mine = np.unique(triangle, return_inverse=True)
    unit = normal[used] / np.linalg.norm(normal[used], axis=1)[:, None]
    return Mesh(point[used], unit, mine.reshape(-1, 3).astype(np.uint32), uv[used])
