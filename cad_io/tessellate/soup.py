"""Triangles in faces' parameter planes that can be measured against the surface, and split. For `tessellate` alone."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from OCP.BRepAdaptor import BRepAdaptor_Curve2d
from OCP.GeomAbs import GeomAbs_CN

from cad_io.arrays import Floats
from cad_io.kernel import interval_ends
from cad_io.part import Part
from cad_io.tessellate.mesh import UVMesh

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
#: Where edges are measured: at the middle alone, an S-shaped course would pass for a straight one.
_ALONG = (0.5, 0.25, 0.75)
#: Where the inside of a triangle is measured.
_INNER = np.array([[2, 2, 2], [4, 1, 1], [1, 4, 1], [1, 1, 4]]) / 6
#: An edge may pass so many knots; a triangle that has more than one within it is looked at at more points.
_MOST_PIECES = 4
#: Age from which triangles that are still too far are also split at their longest edge.
_STUBBORN = 6
#: Triangles measured at once: what is needed for it on the way is several times what they take themselves.
_AT_ONCE = 1 << 17
_MOST_KNOTS = 64  # that are told apart along a surface: some files have them in dense clusters
_INNER_MANY = np.array([(a, b, 16 - a - b) for a in range(1, 16, 3) for b in range(1, 16 - a, 3)]) / 16


class Rows(NamedTuple):
    """Triangles.

    corner (t, 3): nodes. face (t,): face numbers. curve (t, 3): which border curve the edge from corner k to the next is
    a chord of (-1: none), and span (t, 3, 2) its parameters there. age (t,): how often the parent was split.
    """

    corner: Indices
    face: Indices
    curve: Indices
    span: Floats
    age: Indices

    def at(self, chosen: Indices | Bools) -> "Rows":
        """Some of the triangles."""
        return Rows(
            self.corner[chosen], self.face[chosen], self.curve[chosen], self.span[chosen], self.age[chosen]
        )  # fmt: skip

    @staticmethod
    def joined(parts: Sequence["Rows"]) -> "Rows":
        """All triangles of several."""
        return Rows(
            np.concatenate([np.zeros((0, 3), np.int64), *(part.corner for part in parts)]),
            np.concatenate([np.zeros(0, np.int64), *(part.face for part in parts)]),
            np.concatenate([np.zeros((0, 3), np.int64), *(part.curve for part in parts)]),
            np.concatenate([np.zeros((0, 3, 2)), *(part.span for part in parts)]),
            np.concatenate([np.zeros(0, np.int64), *(part.age for part in parts)]),
        )


class Soup:
    """The nodes of triangles, and what can be done with triangles between them.

    Attributes
    ----------
    uv (n, 2), point (n, 3)
        Nodes: parameters, surface points in mm.
    """

    def __init__(self, part: Part) -> None:
        self.part = part
        self.uv, self.point = np.zeros((0, 2)), np.zeros((0, 3))
        self.curves: list[BRepAdaptor_Curve2d] = []
        self.knots: dict[int, tuple[Floats, Floats]] = {}

    def add(self, number: int, mesh: UVMesh) -> Rows:
        """Take in the triangles of a face."""
        count, start = len(mesh.corner), len(self.uv)
        face = np.full(count, number, np.int64)
        curve, span = self._border(mesh)
        self._grow(mesh.uv, np.full(len(mesh.uv), number, np.int64))
        return Rows(mesh.corner.astype(np.int64) + start, face, curve, span, np.zeros(count, np.int64))

    def _grow(self, uv: Floats, face: Indices) -> None:
        self.point = np.concatenate([self.point, self._surface(uv, face)])
        self.uv = np.concatenate([self.uv, uv])

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
            point[rows] = self.part.surface(int(face[rows[0]])).values(uv[rows, 0], uv[rows, 1])
        return point

    def _on_edges(self, rows: Rows, row: Indices, edge: Indices, share: float) -> tuple[Floats, Floats]:
        """Points along edges: surface parameters (k, 2), and the border curve's own (k,) where there is one."""
        a, b = rows.corner[row, edge], rows.corner[row, (edge + 1) % 3]
        uv = (1 - share) * self.uv[a] + share * self.uv[b]
        t = rows.span[row, edge] @ (1 - share, share)
        for k in np.flatnonzero(rows.curve[row, edge] >= 0).tolist():
            uv[k] = self.curves[rows.curve[row[k], edge[k]]].Value(float(t[k])).Coord()
        return uv, t

    def _unique_edges(self, rows: Rows, row: Indices, edge: Indices) -> tuple[Indices, Indices]:
        """One representative of each edge among (row, edge), and for each of these which it is."""
        a, b = rows.corner[row, edge], rows.corner[row, (edge + 1) % 3]
        key = np.minimum(a, b) * len(self.uv) + np.maximum(a, b)
        _, first, which = np.unique(key, return_index=True, return_inverse=True)
        return first, which

    def measured(self, rows: Rows, enough: float, *, wholly: bool = False) -> tuple[Floats, Bools]:
        """Measured distance (t,) of triangles from the surface, mm, and which edges (t, 3) are to be split.

        The distance is that between a point of the surface and the point of the triangle with the same parameters: an
        upper bound both of the surface point's distance from the triangle and of the triangle point's from the surface.
        A triangle that is not within `enough` is measured no further than needed to tell, unless `wholly`.
        """
        blocks = [np.arange(i, min(i + _AT_ONCE, len(rows.face))) for i in range(0, max(1, len(rows.face)), _AT_ONCE)]
        found = [self._measured(rows.at(block), enough, wholly) for block in blocks]
        return np.concatenate([off for off, _ in found]), np.concatenate([marked for _, marked in found])

    def _measured(self, rows: Rows, enough: float, wholly: bool) -> tuple[Floats, Bools]:
        edge_off = self._edge_off(rows, np.inf if wholly else enough)
        off, marked = edge_off.max(axis=1, initial=0.0), (edge_off > enough) | self._wide_edges(rows)
        # Edges near enough: look inside. What is too far there is split at all its edges.
        near = np.flatnonzero((off <= enough) | wholly)
        off[near] = np.maximum(off[near], self._inner_off(rows.at(near)))
        marked[near[off[near] > enough]] = True
        # Needles can be split for ever at their short edges: take the long one along.
        far = np.flatnonzero(marked.any(axis=1) & (rows.age >= _STUBBORN))
        marked[far, self._longest(rows.corner[far])] = True
        return off, marked

    def _edge_off(self, rows: Rows, enough: float) -> Floats:
        """Largest measured distance (t, 3) of each edge from its true course, mm."""
        row, edge = (grid.ravel() for grid in np.indices(rows.corner.shape))
        first, which = self._unique_edges(rows, row, edge)
        row, edge = row[first], edge[first]
        start, end = self.point[rows.corner[row, edge]], self.point[rows.corner[row, (edge + 1) % 3]]
        worst = np.zeros(len(row))
        for share in _ALONG:
            left = np.flatnonzero(worst <= enough)
            uv, _ = self._on_edges(rows, row[left], edge[left], share)
            there = self._surface(uv, rows.face[row[left]])
            off = np.linalg.norm(there - (1 - share) * start[left] - share * end[left], axis=1)
            worst[left] = np.maximum(worst[left], off)
        return worst[which].reshape(rows.corner.shape)

    def _wide_edges(self, rows: Rows) -> Bools:
        """Edges (t, 3) that pass more polynomial pieces of the surface than can be looked at one by one."""
        ends = np.stack([rows.corner, np.roll(rows.corner, -1, axis=1)], axis=2)
        return self._crossed(self.uv[ends], rows.face) > _MOST_PIECES

    def _inner_off(self, rows: Rows) -> Floats:
        """Largest measured distance (t,) of inner surface points of triangles from them, mm."""
        worst = np.zeros(len(rows.face))
        many = self._crossed(self.uv[rows.corner][:, None], rows.face)[:, 0] > 1
        for chosen, weights in ((np.flatnonzero(~many), _INNER), (np.flatnonzero(many), _INNER_MANY)):
            for weight in weights if len(chosen) else ():
                worst[chosen] = np.maximum(worst[chosen], self._off_at(rows.corner[chosen], rows.face[chosen], weight))
        return worst

    def _off_at(self, corner: Indices, face: Indices, weight: Floats) -> Floats:
        there = self._surface(np.einsum("c,kcx->kx", weight, self.uv[corner]), face)
        return np.linalg.norm(there - np.einsum("c,kcx->kx", weight, self.point[corner]), axis=1)

    def _crossed(self, uv: Floats, face: Indices) -> Indices:
        """Most knots (t, k), along u or v, that groups (t, k, n, 2) of points of faces (t,) have between them."""
        crossed = np.zeros(uv.shape[:2], np.int64)
        for number in np.flatnonzero(np.bincount(face)).tolist():
            each = self._knots(number)
            if not any(map(len, each)):
                continue
            mine = np.flatnonzero(face == number)
            low, high = uv[mine].min(axis=2), uv[mine].max(axis=2)
            for axis, knots in enumerate(each):
                between = np.searchsorted(knots, high[..., axis]) - np.searchsorted(knots, low[..., axis])
                crossed[mine] = np.maximum(crossed[mine], between)
        return crossed

    def _knots(self, number: int) -> tuple[Floats, Floats]:
        """Inner knots of a face's surface along u and v: between two of them it is about one polynomial piece."""
        if number not in self.knots:
            adaptor = self.part.adaptor(number)
            self.knots[number] = (
                _thinned(interval_ends(adaptor.NbUIntervals(GeomAbs_CN), adaptor.UIntervals, GeomAbs_CN)),
                _thinned(interval_ends(adaptor.NbVIntervals(GeomAbs_CN), adaptor.VIntervals, GeomAbs_CN)),
            )
        return self.knots[number]

    def _longest(self, corner: Indices) -> Indices:
        lengths = [self._length(corner[:, k], corner[:, (k + 1) % 3]) for k in range(3)]
        return np.argmax(np.stack(lengths, axis=1), axis=1)

    def _length(self, a: Indices, b: Indices) -> Floats:
        return np.linalg.norm(self.point[a] - self.point[b], axis=1)

    def split(self, rows: Rows, marked: Bools) -> Rows:
        """Children of triangles, each of which must have some edge marked (t, 3): it is split at their middles."""
        row, edge = np.nonzero(marked)
        first, which = self._unique_edges(rows, row, edge)
        uv, t = self._on_edges(rows, row[first], edge[first], 0.5)
        middle, halfway = np.full(marked.shape, -1, np.int64), np.zeros(marked.shape)
        middle[row, edge] = len(self.uv) + which
        halfway[row, edge] = t[which]
        self._grow(uv, rows.face[row[first]])
        count = marked.sum(axis=1)
        # Turn each triangle so that its marked edges come first: the one, or the two after the unmarked.
        turn = np.where(count == 1, marked.argmax(axis=1), np.where(count == 2, ((~marked).argmax(axis=1) + 1) % 3, 0))
        order = (turn[:, None] + np.arange(3)) % 3
        every = np.arange(len(marked))[:, None]
        node = np.concatenate([rows.corner[every, order], middle[every, order]], axis=1)
        edges = _Edges(rows.curve[every, order], rows.span[every, order], halfway[every, order])
        shorter = self._length(node[:, 0], node[:, 4]) <= self._length(node[:, 3], node[:, 2])
        made = []
        groups = (count == 1, (count == 2) & shorter, (count == 2) & ~shorter, count == 3)
        for children, group in zip(_CHILDREN, groups, strict=True):
            for child in children:
                curves, spans = zip(*(edges.between(child[k], child[(k + 1) % 3]) for k in range(3)), strict=True)
                made.append(Rows(node[group][:, child], rows.face[group], np.stack(curves, axis=1)[group],
                                 np.stack(spans, axis=1)[group], rows.age[group] + 1))  # fmt: skip
        return Rows.joined(made)


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


def _thinned(ends: Floats) -> Floats:
    """Inner ones of increasing ends, without those that follow another too soon to matter."""
    step = (ends[-1] - ends[0]) / _MOST_KNOTS
    _, first = np.unique(np.floor((ends - ends[0]) / step), return_index=True)
    return ends[first][1:-1]
