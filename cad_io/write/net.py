"""Triangles of a face to be looked at: cut where they lie farthest from the surface, until they are near enough or enough.

Both triangles at an edge are cut where it is, so that no cracks open within a face. What is drawn proves nothing: distances are
looked at in the middles of edges and of triangles.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from cad_io.arrays import Floats
from cad_io.surface import Surface
from cad_io.tessellate.mesh import BorderCurve, UVMesh

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
