"""Triangles in faces' parameter planes that can be measured against the surface, and split. For `tessellate` alone."""

from collections.abc import Mapping
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from OCP.BRepAdaptor import BRepAdaptor_Curve2d

from cad_io.arrays import Floats
from cad_io.kernel import values
from cad_io.mesh import UVMesh
from cad_io.part import Part

Indices = NDArray[np.int64]
Bools = NDArray[np.bool_]

#: Children of a triangle with corners 0, 1, 2 and edge middles 3 (of 0-1), 4 (of 1-2), 5 (of 2-0), when its first edge
#: is split, its first two, or all. Two leave a quad, which is cut along its shorter diagonal, 0-4 or 3-2.
_CHILDREN = (
    ((0, 3, 2), (3, 1, 2)),
    ((3, 1, 4), (0, 3, 4), (0, 4, 2)),
    ((3, 1, 4), (0, 3, 2), (3, 4, 2)),
    ((0, 3, 5), (3, 1, 4), (5, 4, 2), (3, 4, 5)),
)
#: The distance between a point of the surface and the same point of a triangle is an upper bound of its distance from
#: the triangle. The lesser one counts only where the former is below this share of the triangle's size: around the poles
#: of a sphere a triangle may come near the wrong part of the surface.
_TAME = 0.3
#: Where edges are measured: at the middle alone, an S-shaped course would pass for a straight one.
_ALONG = (0.5, 0.25, 0.75)
#: Where the inside of a triangle is measured.
_INNER = np.array([[2, 2, 2], [4, 1, 1], [1, 4, 1], [1, 1, 4]]) / 6


class Soup:
    """A working set of triangles.

    Attributes
    ----------
    uv (n, 2), point (n, 3)
        Nodes: parameters, surface points in mm.
    corner (t, 3), face (t,)
        Triangles: nodes, face numbers.
    curve (t, 3), span (t, 3, 2)
        Edge k runs from corner k to the next: which border curve it is a chord of (-1: none), and its parameters there.
    """

    def __init__(self, part: Part, meshes: Mapping[int, UVMesh]) -> None:
        self.part = part
        self.curves: list[BRepAdaptor_Curve2d] = []
        uv, faces, corners, owners, curves, spans = [], [], [], [], [], []
        start = 0
        for number, mesh in meshes.items():
            curve, span = self._border(mesh)
            uv.append(mesh.uv)
            faces.append(np.full(len(mesh.uv), number))
            corners.append(mesh.corner.astype(np.int64) + start)
            owners.append(np.full(len(mesh.corner), number))
            curves.append(curve)
            spans.append(span)
            start += len(mesh.uv)
        self.uv = np.concatenate([np.zeros((0, 2)), *uv])
        self.corner = np.concatenate([np.zeros((0, 3), np.int64), *corners])
        self.face = np.concatenate([np.zeros(0, np.int64), *owners])
        self.curve = np.concatenate([np.zeros((0, 3), np.int64), *curves])
        self.span = np.concatenate([np.zeros((0, 3, 2)), *spans])
        self.point = self._surface(self.uv, np.concatenate([np.zeros(0, np.int64), *faces]))

    def __len__(self) -> int:
        return len(self.corner)

    def _border(self, mesh: UVMesh) -> tuple[Indices, Floats]:
        """`curve` and `span` of a mesh's triangles."""
        n = len(mesh.uv)
        curve, span = np.full(mesh.corner.shape, -1, np.int64), np.zeros((*mesh.corner.shape, 2))
        keys, index, first, last = [], [], [], []
        for border in mesh.border:
            a, b = border.nodes[:-1].astype(np.int64), border.nodes[1:].astype(np.int64)
            for tail, head, t0, t1 in ((a, b, border.parameter[:-1], border.parameter[1:]),
                                       (b, a, border.parameter[1:], border.parameter[:-1])):  # fmt: skip
                keys.append(tail * n + head)
                index.append(np.full(len(a), len(self.curves)))
                first.append(t0)
                last.append(t1)
            self.curves.append(border.curve)
        if keys:
            key = np.concatenate(keys)
            order = np.argsort(key)
            wanted = mesh.corner.astype(np.int64) * n + np.roll(mesh.corner, -1, axis=1)
            at = order[np.minimum(np.searchsorted(key, wanted, sorter=order), len(key) - 1)]
            hit = key[at] == wanted
            curve[hit] = np.concatenate(index)[at[hit]]
            span[hit] = np.stack([np.concatenate(first), np.concatenate(last)], axis=1)[at[hit]]
        return curve, span

    def _surface(self, uv: Floats, face: Indices) -> Floats:
        """Points (n, 3) of each face's surface."""
        point = np.empty((len(uv), 3))
        order = np.argsort(face, kind="stable")
        ends = np.flatnonzero(np.diff(face[order])) + 1
        for rows in np.split(order, ends) if len(order) else ():
            point[rows] = values(self.part.adaptor(int(face[rows[0]])), uv[rows, 0], uv[rows, 1])
        return point

    def _on_edges(self, row: Indices, edge: Indices, share: float) -> tuple[Floats, Floats]:
        """Points along edges: surface parameters (k, 2), and the border curve's own (k,) where there is one."""
        a, b = self.corner[row, edge], self.corner[row, (edge + 1) % 3]
        uv = (1 - share) * self.uv[a] + share * self.uv[b]
        t = self.span[row, edge] @ (1 - share, share)
        for k in np.flatnonzero(self.curve[row, edge] >= 0).tolist():
            uv[k] = self.curves[self.curve[row[k], edge[k]]].Value(float(t[k])).Coord()
        return uv, t

    def _unique_edges(self, row: Indices, edge: Indices) -> tuple[Indices, Indices]:
        """One representative of each edge among (row, edge), and for each of these which it is."""
        a, b = self.corner[row, edge], self.corner[row, (edge + 1) % 3]
        key = np.minimum(a, b) * len(self.uv) + np.maximum(a, b)
        _, first, which = np.unique(key, return_index=True, return_inverse=True)
        return first, which

    def edge_off(self, enough: float) -> Floats:
        """Largest measured distance (t, 3) of each edge's true course from the triangles, mm.

        A point of an inner edge counts to the nearer of the triangles on both sides; one of a border to its chord, so
        that neither surface is left out nor anything added. An edge that is farther than `enough` is not measured on.
        """
        row, edge = (grid.ravel() for grid in np.indices((len(self), 3)))
        _, which = self._unique_edges(row, edge)
        worst = np.zeros(len(self) * 3)
        for share in _ALONG:
            left = np.flatnonzero(worst[which] <= enough)
            found = self._edge_off_at(row[left], edge[left], share)
            np.maximum.at(worst, which[left], found)
        return worst[which].reshape(len(self), 3)

    def _edge_off_at(self, row: Indices, edge: Indices, share: float) -> Floats:
        """Distances (k,) at one point of each edge; rows that share an edge get the same."""
        first, which = self._unique_edges(row, edge)
        uv, _ = self._on_edges(row[first], edge[first], share)
        there = self._surface(uv, self.face[row[first]])
        start, end = self.point[self.corner[row, edge]], self.point[self.corner[row, (edge + 1) % 3]]
        slide = np.linalg.norm(there - (1 - share) * start[first] - share * end[first], axis=1)
        tame = slide <= _TAME * self._length(self.corner[row, edge][first], self.corner[row, (edge + 1) % 3][first])
        there, off, tame = there[which], slide[which], tame[which]
        inner = self.curve[row, edge] < 0
        near, border = tame & inner, tame & ~inner
        off[near] = distance_to_triangle(there[near], self.point[self.corner[row[near]]])
        off[border] = _distance_to_segment(there[border], start[border], end[border])
        nearer = np.full(len(first), np.inf)
        np.minimum.at(nearer, which, off)
        return nearer[which]

    def inner_off(self, row: Indices) -> Floats:
        """Largest measured distance (k,) of inner surface points of triangles from them, mm."""
        corner = self.corner[row]
        triangle = self.point[corner]
        size = np.linalg.norm(triangle - np.roll(triangle, 1, axis=1), axis=2).max(axis=1)
        worst = np.zeros(len(row))
        for weight in _INNER:
            there = self._surface(np.einsum("c,kcx->kx", weight, self.uv[corner]), self.face[row])
            off = np.linalg.norm(there - np.einsum("c,kcx->kx", weight, triangle), axis=1)
            near = off <= _TAME * size
            off[near] = distance_to_triangle(there[near], triangle[near])
            worst = np.maximum(worst, off)
        return worst

    def keep(self, chosen: Bools) -> None:
        """Leave only these triangles."""
        self.corner, self.face = self.corner[chosen], self.face[chosen]
        self.curve, self.span = self.curve[chosen], self.span[chosen]

    def split(self, marked: Bools) -> None:
        """Split every triangle, which must have some edge marked (t, 3), at the middles of its marked edges."""
        row, edge = np.nonzero(marked)
        first, which = self._unique_edges(row, edge)
        uv, t = self._on_edges(row[first], edge[first], 0.5)
        face = self.face[row[first]]
        middle = np.full(marked.shape, -1, np.int64)
        middle[row, edge] = len(self.uv) + which
        halfway = np.zeros(marked.shape)
        halfway[row, edge] = t[which]
        self.uv = np.concatenate([self.uv, uv])
        self.point = np.concatenate([self.point, self._surface(uv, face)])
        count = marked.sum(axis=1)
        # Turn each triangle so that its marked edges come first: the one, or the two after the unmarked.
        turn = np.where(count == 1, marked.argmax(axis=1), np.where(count == 2, ((~marked).argmax(axis=1) + 1) % 3, 0))
        order = (turn[:, None] + np.arange(3)) % 3
        rows = np.arange(len(marked))[:, None]
        node = np.concatenate([self.corner[rows, order], middle[rows, order]], axis=1)
        edges = _Edges(self.curve[rows, order], self.span[rows, order], halfway[rows, order])
        shorter = self._length(node[:, 0], node[:, 4]) <= self._length(node[:, 3], node[:, 2])
        groups = (count == 1, (count == 2) & shorter, (count == 2) & ~shorter, count == 3)
        made: list[tuple[Indices, Indices, Indices, Floats]] = []
        for children, group in zip(_CHILDREN, groups, strict=True):
            for child in children:
                curves, spans = zip(*(edges.between(child[k], child[(k + 1) % 3]) for k in range(3)), strict=True)
                made.append((node[group][:, child], self.face[group],
                             np.stack(curves, axis=1)[group], np.stack(spans, axis=1)[group]))  # fmt: skip
        self.corner, self.face, self.curve, self.span = (np.concatenate(column) for column in zip(*made, strict=True))

    def _length(self, a: Indices, b: Indices) -> Floats:
        return np.linalg.norm(self.point[a] - self.point[b], axis=1)


class _Edges(NamedTuple):
    """Edges of triangles to be split: their border curves (t, 3), spans (t, 3, 2) and the middles of these (t, 3)."""

    curve: Indices
    span: Floats
    halfway: Floats

    def between(self, start: int, end: int) -> tuple[Indices, Floats]:
        """Curve and span of a child's edge from one node (0 to 5, see _CHILDREN) to another."""
        if start < 3 and end == (start + 1) % 3:  # a whole edge
            return self.curve[:, start], self.span[:, start]
        if start < 3 and end == start + 3:  # the first half of one
            return self.curve[:, start], np.stack([self.span[:, start, 0], self.halfway[:, start]], axis=1)
        if start >= 3 and end == (start - 2) % 3:  # the second half
            return self.curve[:, start - 3], np.stack([self.halfway[:, start - 3], self.span[:, start - 3, 1]], axis=1)
        return np.full(len(self.curve), -1, np.int64), np.zeros((len(self.curve), 2))


def _distance_to_segment(point: Floats, start: Floats, end: Floats) -> Floats:
    along = end - start
    length = np.maximum((along**2).sum(axis=1), 1e-300)
    share = np.clip(((point - start) * along).sum(axis=1) / length, 0.0, 1.0)
    return np.linalg.norm(point - start - share[:, None] * along, axis=1)


def distance_to_triangle(point: Floats, triangle: Floats) -> Floats:
    """Distance (n,) of points (n, 3) from triangles (n, 3, 3), point by triangle."""
    a, b, c = triangle[:, 0], triangle[:, 1], triangle[:, 2]
    normal = np.cross(b - a, c - a)
    square = (normal**2).sum(axis=1)
    with np.errstate(all="ignore"):
        # Barycentric coordinates of the foot in the triangle's plane; a flat triangle has none and is its edges.
        at_b = (np.cross(point - a, c - a) * normal).sum(axis=1) / square
        at_c = (np.cross(b - a, point - a) * normal).sum(axis=1) / square
        height = np.abs(((point - a) * normal).sum(axis=1)) / np.sqrt(square)
    over = (at_b >= 0) & (at_c >= 0) & (at_b + at_c <= 1)
    beside = np.flatnonzero(~over)
    off = height
    p, a, b, c = point[beside], a[beside], b[beside], c[beside]
    off[beside] = np.minimum(
        np.minimum(_distance_to_segment(p, a, b), _distance_to_segment(p, b, c)), _distance_to_segment(p, c, a)
    )
    return off
