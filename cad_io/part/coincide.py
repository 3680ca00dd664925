"""Which edges, or which parts of them, lie on each other within a tolerance?

Curves of edges are cubic pieces, all in common arrays: evaluated, measured and projected on many at a time. Each piece carries on
the ends and derivatives of the kernel's curve, and pieces are halved until they follow it. The number of steps is fixed: a curve
that does not let itself be followed is not drawn.

Edges of one face alone are cut where others end on them. Two pieces belong together where both ends do and no point of one is
farther from the other than the tolerance, looked at in both directions; what is joined is within it of all that it is joined
with. A distance is never told too small, so that what is not understood stays apart. No step here asks the kernel anything:
the work is bounded by the number of pieces and of ends that lie next to each other.
"""

from collections import defaultdict
from collections.abc import Iterator, Sequence
from itertools import chain, pairwise
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from OCP.BRepAdaptor import BRepAdaptor_Curve
from OCP.GeomAbs import GeomAbs_C2, GeomAbs_Line
from OCP.TopoDS import TopoDS_Edge
from scipy.spatial import cKDTree

from cad_io.arrays import Floats
from cad_io.graphs import connected
from cad_io.kernel import along, interval_ends, may_refuse

Indices = NDArray[np.intp]

#: Halvings of the first pieces; pieces of one curve; intervals of smoothness of one curve. What needs more is not drawn.
_HALVINGS, MOST_PIECES, _MOST_INTERVALS = 12, 4096, 2000
#: First pieces of a curve, at least.
_FIRST = 4
#: Chords of a piece that lengths are measured along.
_CHORDS = 2
#: Steps of a projection; it ends where a step comes not nearer than this share of the distance before.
_STEPS, _NEARER = 8, 1 - 1e-9
#: Halves follow sixteen times as well as the whole; half of that is taken for sure.
_HALVES = 8.0
#: Parameters beyond this are infinite to the kernel.
_INFINITE = 1e50


class Curves:
    """Curves of edges, by place in a list, in pieces that may be so far, mm, from the kernel's curves.

    drawn (n,): the others have no curve, or none that could be followed: ask nothing about them. low, high (n,): ranges of the
    parameters.
    """

    def __init__(self, edges: Sequence[TopoDS_Edge], chord: float) -> None:
        drawings = [_followed(edge, chord) for edge in edges]
        self.drawn = np.array([each is not None for each in drawings], bool)
        blank = _Drawing(np.array([0.0, 1.0]), np.zeros((2, 3)), np.zeros((2, 3)))
        each = [drawing or blank for drawing in drawings] or [blank]
        #: Places of each curve's breaks in the common arrays.
        self._first = np.concatenate([[0], np.cumsum([len(d.t) for d in each])])
        self._t, self._p, self._d = (np.concatenate([d[k] for d in each]) for k in range(3))
        self.low, self.high = self._t[self._first[:-1]], self._t[self._first[1:] - 1]
        # The table of lengths: parameters of the chords' ends and the length up to each.
        counts = np.diff(self._first) - 1
        owner = np.repeat(np.arange(len(counts)), counts)
        start = np.delete(np.arange(len(self._t)), self._first[1:] - 1)
        share = np.arange(_CHORDS) / _CHORDS
        t = self._t[start][:, None] + share * (self._t[start + 1] - self._t[start])[:, None]
        ends = np.cumsum(counts * _CHORDS)
        self._table_t = np.insert(t.ravel(), ends, self.high)
        self.table_owner = np.insert(np.repeat(owner, _CHORDS), ends, np.arange(len(counts)))
        self.table_first = np.concatenate([[0], np.cumsum(counts * _CHORDS + 1)])
        self.table_point = self.at(self.table_owner, self._table_t)[0]
        step = np.linalg.norm(np.diff(self.table_point, axis=0), axis=1)
        step[self.table_first[1:-1] - 1] = 0.0
        self._table_length = np.concatenate([[0.0], np.cumsum(step)])

    def at(self, which: Indices, t: Floats) -> tuple[Floats, Floats]:
        """Points and derivatives (m, 3) of curves (m,) at parameters (m,)."""
        i = self._piece(self._t, self._first, which, t)
        h = self._t[i + 1] - self._t[i]
        s = ((t - self._t[i]) / h)[:, None]
        p, q, u, v = self._p[i], self._p[i + 1], h[:, None] * self._d[i], h[:, None] * self._d[i + 1]
        a, b = 3 * (q - p) - 2 * u - v, 2 * (p - q) + u + v
        return p + s * (u + s * (a + s * b)), (u + s * (2 * a + s * 3 * b)) / h[:, None]

    def length(self, which: Indices, t: Floats) -> Floats:
        """Lengths (m,) from the common start of all tables: of use are differences on one curve, mm."""
        i = self._piece(self._table_t, self.table_first, which, t)
        share = np.clip((t - self._table_t[i]) / (self._table_t[i + 1] - self._table_t[i]), 0.0, 1.0)
        return np.asarray(self._table_length[i] + share * (self._table_length[i + 1] - self._table_length[i]))

    def at_length(self, which: Indices, length: Floats) -> Floats:
        """Parameters (m,) of curves at lengths as `length` gives them."""
        low, high = self.table_first[which], self.table_first[which + 1] - 2
        i = np.clip(np.searchsorted(self._table_length, length, side="right") - 1, low, high)
        step = self._table_length[i + 1] - self._table_length[i]
        with np.errstate(all="ignore"):
            share = np.where(step > 0, (length - self._table_length[i]) / step, 0.0)
        return self.chord_parameter(i, np.clip(share, 0.0, 1.0))

    def near(self, which: Indices, t: Floats, low: Floats, high: Floats, point: Floats) -> tuple[Floats, Floats]:
        """Parameters (m,) between `low` and `high` next to points (m, 3), from a guess on, and the distances there.

        A distance is never less than the true one.
        """
        best, least = t.copy(), np.full(len(t), np.inf)
        going = np.arange(len(t))
        for _ in range(_STEPS):
            p, d = self.at(which[going], t)
            away = point[going] - p
            distance = np.linalg.norm(away, axis=1)
            nearer = distance < _NEARER * least[going]
            going, t, away, d = going[nearer], t[nearer], away[nearer], d[nearer]
            if not len(going):
                break
            best[going], least[going] = t, distance[nearer]
            with np.errstate(all="ignore"):
                step = (away * d).sum(axis=1) / (d * d).sum(axis=1)
            t = np.clip(t + np.where(np.isfinite(step), step, 0.0), low[going], high[going])
        return best, least

    def chord_parameter(self, chord: Indices, share: Floats) -> Floats:
        """Parameters (m,) at shares of chords of the table."""
        return np.asarray(self._table_t[chord] + share * (self._table_t[chord + 1] - self._table_t[chord]))

    def breaks(self, which: int, low: float, high: float) -> Floats:
        """Parameters of a curve at which its pieces end, and the two given."""
        own = self._t[self._first[which] : self._first[which + 1]]
        least = 1e-6 * (high - low)
        return np.concatenate([[low], own[(own > low + least) & (own < high - least)], [high]])

    def is_cut(self, piece: "Piece") -> bool:
        """Whether a piece is but a part of its edge."""
        edge, low, high = piece
        return bool(self.drawn[edge] and (low > self.low[edge] or high < self.high[edge]))

    def count(self, which: Indices) -> Indices:
        """Numbers (m,) of pieces of curves."""
        return np.asarray(np.diff(self._first)[which] - 1)

    def _piece(self, table: Floats, first: Indices, which: Indices, t: Floats) -> Indices:
        """Places (m,) in a table of the last entry of each curve that is not behind its parameter."""
        low, high = first[which], first[which + 1] - 2
        while (low < high).any():
            middle = (low + high + 1) // 2
            behind = table[middle] > t
            low, high = np.where(behind, low, middle), np.where(behind, middle - 1, high)
        return np.asarray(low)


class _Drawing(NamedTuple):
    """Parameters (k,), points and derivatives (k, 3) at the ends of pieces."""

    t: Floats
    p: Floats
    d: Floats


def _first_ends(curve: BRepAdaptor_Curve) -> Floats | None:
    """Ends (k,) of the pieces of a curve to begin with: of its smooth parts, at least; None where it has no end, or too many."""
    low, high = curve.FirstParameter(), curve.LastParameter()
    if not (low < high and max(-low, high) < _INFINITE):
        return None
    if curve.GetType() == GeomAbs_Line:
        return np.array([low, high])
    count = curve.NbIntervals(GeomAbs_C2)
    if not 0 < count <= _MOST_INTERVALS:
        return None
    ends = np.unique(np.clip(interval_ends(count, curve.Intervals, GeomAbs_C2), low, high))
    each = max(_FIRST // max(len(ends) - 1, 1), 1)
    return np.append((ends[:-1, None] + np.arange(each) / each * np.diff(ends)[:, None]).ravel(), ends[-1])


def _places(curve: BRepAdaptor_Curve, t: Floats) -> tuple[Floats, Floats] | None:
    """Points and derivatives (k, 3); None where the kernel has none."""
    with may_refuse():
        derivatives = along(curve, t, 3)
        if np.isfinite(derivatives).all():
            return derivatives[:, 0], derivatives[:, 1]
    return None


def _followed(edge: TopoDS_Edge, chord: float) -> _Drawing | None:
    """The curve of an edge in pieces; None where it cannot be followed."""
    t: Floats | None = None
    with may_refuse():
        curve = BRepAdaptor_Curve(edge)
        t = _first_ends(curve)
    if t is None or len(t) < 2 or (points := _places(curve, t)) is None:
        return None
    p, d = points
    doubtful = np.ones(len(t) - 1, bool)
    for _ in range(_HALVINGS):
        i = np.flatnonzero(doubtful)
        h, halves = t[i + 1] - t[i], 0.5 * (t[i] + t[i + 1])
        if (points := _places(curve, halves)) is None:
            return None
        (middle, along), across = points, h[:, None]
        guess = 0.5 * (p[i] + p[i + 1]) + across * (d[i] - d[i + 1]) / 8
        slope = 1.5 * (p[i + 1] - p[i]) - across * (d[i] + d[i + 1]) / 4
        off = np.maximum(np.linalg.norm(guess - middle, axis=1), np.linalg.norm(slope - across * along, axis=1) / 8)
        # Both halves are kept in any case.
        t, p, d = (np.insert(rows, i + 1, more, axis=0) for rows, more in ((t, halves), (p, middle), (d, along)))
        where, bad = i + np.arange(len(i)), off > _HALVES * chord
        doubtful = np.zeros(len(t) - 1, bool)
        doubtful[where], doubtful[where + 1] = bad, bad
        if not bad.any():
            return _Drawing(t, p, d)
        if len(t) > MOST_PIECES:
            return None
    return None


#: Ends next to each other: more of them are no edges of faces, and the ladder ends.
MOST_NEIGHBOURS = 2_000_000
#: Points of a piece that are compared: at least, for each piece of its curve, at most.
_LEAST, _EACH, _MOST = 17, 2, 1025
#: A face joined with itself (a tube that is slit) reaches so many tolerances away from the joint.
_AWAY = 8.0


class TooMany(Exception):
    """More ends lie next to each other than can be looked at."""


class Piece(NamedTuple):
    """A part of an edge, from `low` to `high` by its curve's parameter."""

    edge: int
    low: float
    high: float


class Group(NamedTuple):
    """Pieces that lie on each other; `way`: +1 for those that run as the first does, else -1."""

    pieces: tuple[Piece, ...]
    way: tuple[int, ...]


def coinciding(curves: Curves, faces: list[tuple[int, ...]], groups: list[Group], tolerance: float) -> list[Group]:
    """Groups after joining what lies within a tolerance, mm.

    faces: by edge, the faces that use it. An edge that one face uses twice is a seam, and stays as it is. groups: as they are;
    the pieces of an edge follow each other from its start to its end. Raises TooMany.
    """
    still: list[Group] = []
    moving: list[Group] = []
    for group in groups:
        edges = [piece.edge for piece in group.pieces]
        fixed = any(not curves.drawn[e] or len(set(faces[e])) < len(faces[e]) for e in edges)
        (still if fixed else moving).append(group)
    # What fits as a whole is not cut. At each joint, one side at least is what one face has alone.
    moving = _joined(curves, faces, moving, tolerance)
    table, alone = _Table.of(moving), _alone(faces, moving)
    parts = []
    for group, cuts in zip(moving, _cuts(curves, table, alone, tolerance), strict=True):
        if cuts:
            ((edge, low, high),) = group.pieces
            parts += [Group((Piece(edge, a, b),), (1,)) for a, b in pairwise([low, *cuts, high])]
        else:
            parts.append(group)
    if len(parts) > len(moving):
        moving = _joined(curves, faces, parts, tolerance)
    return [*still, *_whole(moving)]


def _alone(faces: list[tuple[int, ...]], groups: Sequence[Group]) -> NDArray[np.bool_]:
    """Which groups (n,) are what one face has alone."""
    return np.array([len(g.pieces) == 1 and len(faces[g.pieces[0].edge]) == 1 for g in groups], bool)


class _Table(NamedTuple):
    """Pieces as arrays (m,): edge, ends by parameter, and number of the group."""

    edge: Indices
    low: Floats
    high: Floats
    group: Indices

    @classmethod
    def of(cls, groups: list[Group]) -> "_Table":
        rows = [(*piece, number) for number, group in enumerate(groups) for piece in group.pieces]
        edge, low, high, group = zip(*rows, strict=True) if rows else ((), (), (), ())
        return cls(np.array(edge, np.intp), np.array(low, float), np.array(high, float), np.array(group, np.intp))

    def ends(self, curves: Curves) -> Floats:
        """Points (2 m, 3) of starts and ends in turn."""
        at = np.stack([self.low, self.high], axis=1).ravel()
        return curves.at(np.repeat(self.edge, 2), at)[0]

    def lengths(self, curves: Curves) -> Floats:
        return curves.length(self.edge, self.high) - curves.length(self.edge, self.low)


def _cuts(curves: Curves, table: _Table, alone: NDArray[np.bool_], tolerance: float) -> list[list[float]]:
    """By group: the parameters at which ends of other pieces lie on it, ascending; none for groups that are not `alone`."""
    cuts: list[list[float]] = [[] for _ in alone]
    if not alone.any():
        return cuts
    mine = np.flatnonzero(alone[table.group])
    table = _Table(table.edge[mine], table.low[mine], table.high[mine], table.group[mine])
    tree = cKDTree(table.ends(curves))
    chord, piece = _chords(curves, table)
    a, b = curves.table_point[chord], curves.table_point[chord + 1]
    middle = curves.at(table.edge[piece], curves.chord_parameter(chord, np.full(len(chord), 0.5)))[0]
    # A chord and its arc lie within this ball.
    radius = 0.5 * np.linalg.norm(b - a, axis=1) + 2 * np.linalg.norm(middle - 0.5 * (a + b), axis=1) + tolerance
    many = tree.query_ball_point(middle, radius, return_length=True)
    if int(many.sum()) > 10 * MOST_NEIGHBOURS:
        raise TooMany
    some = many > 0
    many, chord, piece, radius, a, b = many[some], chord[some], piece[some], radius[some], a[some], b[some]
    balls = tree.query_ball_point(middle[some], radius, return_sorted=False)
    node = np.fromiter(chain.from_iterable(balls), np.intp, int(many.sum()))
    chord, piece, bulge = (np.repeat(x, many) for x in (chord, piece, radius - 0.5 * np.linalg.norm(b - a, axis=1)))
    other = node // 2 != piece
    node, chord, piece, bulge = node[other], chord[other], piece[other], bulge[other]
    a, b, point = curves.table_point[chord], curves.table_point[chord + 1], tree.data[node]
    with np.errstate(all="ignore"):
        share = np.nan_to_num(((point - a) * (b - a)).sum(axis=1) / ((b - a) ** 2).sum(axis=1)).clip(0.0, 1.0)
    close = np.linalg.norm(a + share[:, None] * (b - a) - point, axis=1) <= bulge
    node, chord, piece, point, share = node[close], chord[close], piece[close], point[close], share[close]
    edge, low, high = table.edge[piece], table.low[piece], table.high[piece]
    t, distance = curves.near(edge, curves.chord_parameter(chord, share).clip(low, high), low, high, point)
    place = curves.length(edge, t)
    inner = (place - curves.length(edge, low) > tolerance) & (curves.length(edge, high) - place > tolerance)
    keep = (distance <= tolerance) & inner
    order = np.flatnonzero(keep)[np.lexsort((place[keep], piece[keep]))]
    for run in _runs(piece[order], place[order], tolerance):
        best = order[run][np.argmin(distance[order[run]])]
        cuts[int(table.group[piece[best]])].append(float(t[best]))
    return cuts


def _chords(curves: Curves, table: _Table) -> tuple[Indices, Indices]:
    """Chords of the curves' table within pieces, and the piece of each."""
    chords, pieces = [], []
    for k in range(len(table.edge)):
        first, last = curves.table_first[table.edge[k]], curves.table_first[table.edge[k] + 1] - 1
        t = curves.chord_parameter(np.arange(first, last), np.zeros(last - first))
        start = max(int(np.searchsorted(t, table.low[k], side="right")) - 1, 0)
        end = int(np.searchsorted(t, table.high[k]))
        chords.append(np.arange(first + start, first + end))
        pieces.append(np.full(end - start, k))
    return np.concatenate(chords), np.concatenate(pieces)


def _runs(piece: Indices, place: Floats, tolerance: float) -> list[slice]:
    """Stretches of one piece in which each place is within the tolerance of the one before."""
    if not len(piece):
        return []
    new = np.flatnonzero((np.diff(piece) != 0) | (np.diff(place) > tolerance)) + 1
    ends = [0, *new.tolist(), len(piece)]
    return [slice(a, b) for a, b in pairwise(ends)]


def _joined(curves: Curves, faces: list[tuple[int, ...]], groups: list[Group], tolerance: float) -> list[Group]:
    """Groups that lie on each other become one, the nearest first."""
    table = _Table.of(groups)
    alone = _alone(faces, groups)
    i, j, way = _candidates(curves, table, alone, tolerance)
    distance = _distances(curves, table, i, j, way)
    near = np.flatnonzero(distance <= tolerance)
    # No two sides of one narrow face.
    own = [set(faces[a]) & set(faces[b]) for a, b in zip(table.edge[i[near]].tolist(), table.edge[j[near]].tolist(), strict=True)]
    edges_of = defaultdict[int, list[int]](list)
    for edge, users in enumerate(faces) if any(own) else ():
        for face in users:
            edges_of[face].append(edge)
    own_edges = [[edge for face in faces[e] for edge in edges_of[face]] for e in table.edge[i[near]].tolist()]
    rows = zip(own, i[near].tolist(), own_edges, strict=True)
    near = near[np.array([not it or _is_wide(curves, edges, table, row, tolerance) for it, row, edges in rows], bool)]
    order = near[np.argsort(distance[near], kind="stable")]
    allowed: dict[tuple[int, int], set[int]] = {}
    for k in order.tolist():
        allowed.setdefault((int(i[k]), int(j[k])), set()).add(int(way[k]))
    owner = list(range(len(groups)))
    members: list[list[int]] = [[] for _ in groups]
    for m, g in enumerate(table.group.tolist()):
        members[g].append(m)
    ways = [list(group.way) for group in groups]
    for k in order.tolist():
        p, q, same = int(i[k]), int(j[k]), int(way[k])
        g, h = owner[table.group[p]], owner[table.group[q]]
        if g == h:
            continue
        turn = same * ways[g][members[g].index(p)] * ways[h][members[h].index(q)]
        if all(
            w * turn * v in allowed.get((min(a, b), max(a, b)), ())
            for a, w in zip(members[g], ways[g], strict=True)
            for b, v in zip(members[h], ways[h], strict=True)
        ):
            members[g] += members[h]
            ways[g] += [turn * v for v in ways[h]]
            for m in members[h]:
                owner[table.group[m]] = g
            members[h], ways[h] = [], []
    pieces = [piece for group in groups for piece in group.pieces]
    return [Group(tuple(pieces[m] for m in mine), tuple(way)) for mine, way in zip(members, ways, strict=True) if mine]


def _candidates(curves: Curves, table: _Table, alone: NDArray[np.bool_], tolerance: float) -> tuple[Indices, Indices, Indices]:
    """Pairs of pieces with both ends next to each other, and whether they run the same way: +1 or -1.

    A piece as short as the tolerance lies next to anything there, and is joined with nothing.
    """
    long = np.flatnonzero(table.lengths(curves) > tolerance)
    tree = cKDTree(table.ends(curves).reshape(-1, 2, 3)[long].reshape(-1, 3)) if len(long) else None
    if tree is None or tree.count_neighbors(tree, tolerance) > 2 * MOST_NEIGHBOURS:
        if tree is None:
            return (np.zeros(0, np.intp),) * 3
        raise TooMany
    pairs = tree.query_pairs(tolerance, output_type="ndarray")
    i, j = np.sort(long[pairs // 2], axis=1).T
    swapped = pairs[:, 0] % 2 != pairs[:, 1] % 2
    use = (i != j) & (table.group[i] != table.group[j]) & (alone[table.group[i]] | alone[table.group[j]])
    key = (i[use] * len(table.edge) + j[use]) * 2 + swapped[use]
    keys, times = np.unique(key, return_counts=True)
    keys = keys[times == 2]
    pair = keys // 2
    return pair // len(table.edge), pair % len(table.edge), np.where(keys % 2, -1, 1)


def _distances(curves: Curves, table: _Table, i: Indices, j: Indices, way: Indices) -> Floats:
    """Largest distances (k,) from one piece to the other, of both directions."""
    worst = np.zeros(len(i))
    for a, b in ((i, j), (j, i)):
        counts = np.clip(_EACH * curves.count(table.edge[a]) + 1, _LEAST, _MOST)
        k = np.repeat(np.arange(len(a)), counts)
        share = (np.arange(len(k)) - np.repeat(np.cumsum(counts) - counts, counts)) / np.repeat(counts - 1, counts)
        here, there = table.edge[a][k], table.edge[b][k]
        start, end = curves.length(table.edge[a], table.low[a]), curves.length(table.edge[a], table.high[a])
        point = curves.at(here, curves.at_length(here, start[k] + share * (end - start)[k]))[0]
        low, high = table.low[b], table.high[b]
        start, end = curves.length(table.edge[b], low), curves.length(table.edge[b], high)
        share = np.where(way[k] > 0, share, 1 - share)
        guess = curves.at_length(there, start[k] + share * (end - start)[k]).clip(low[k], high[k])
        distance = curves.near(there, guess, low[k], high[k], point)[1]
        np.maximum.at(worst, k, np.where(np.isfinite(distance), distance, np.inf))
    return worst


def _is_wide(curves: Curves, edges: list[int], table: _Table, piece: int, tolerance: float) -> bool:
    """Whether a face with these edges reaches well away from one of its pieces: a tube that is slit does, and may be joined with
    itself, a strip as narrow as the tolerance does not."""
    mine = np.array(edges, np.intp)[curves.drawn[edges]]
    t = curves.low[mine][:, None] + np.linspace(0.0, 1.0, 9) * (curves.high - curves.low)[mine][:, None]
    points = curves.at(np.repeat(mine, 9), t.ravel())[0]
    inner = np.linspace(table.low[piece], table.high[piece], 65)
    line = curves.at(np.full(65, table.edge[piece]), inner)[0]
    gap = float(np.linalg.norm(np.diff(line, axis=0), axis=1).max())
    return bool(cKDTree(line).query(points)[0].max() > gap + _AWAY * tolerance)


def points(curves: Curves, faces: list[tuple[int, ...]], groups: Sequence[Group], tolerance: float) -> list[Group]:
    """Groups that are no more than a point within a tolerance, but for faces that have no other edges.

    What one face has alone is a point together with all such pieces that go on at its ends: of a hole made of short pieces, each
    would be one.
    """
    short = [g for g, alone in zip(groups, _alone(faces, groups), strict=True) if alone and curves.drawn[g.pieces[0].edge]]
    table = _Table.of(short)
    small = np.flatnonzero(table.lengths(curves) <= tolerance)
    if not len(small):
        return []
    ends = table.ends(curves).reshape(-1, 2, 3)[small]
    tree = cKDTree(ends.reshape(-1, 3))
    if tree.count_neighbors(tree, tolerance) > 2 * MOST_NEIGHBOURS:
        raise TooMany
    label = connected(len(small), tree.query_pairs(tolerance, output_type="ndarray") // 2)
    result = []
    for which in range(int(label.max()) + 1):
        mine = label == which
        if np.linalg.norm(np.ptp(ends[mine].reshape(-1, 3), axis=0)) <= tolerance:
            result += [short[k] for k in small[mine].tolist()]
    few = {group.pieces[0].edge for group in result}
    single = {face for edge, users in enumerate(faces) if edge not in few for face in users}
    return [group for group in result if faces[group.pieces[0].edge][0] in single]


def _whole(groups: list[Group]) -> Iterator[Group]:
    """The same without cuts between pieces that nothing was joined with."""
    alone: dict[int, list[Piece]] = {}
    for group in groups:
        if len(group.pieces) == 1:
            alone.setdefault(group.pieces[0].edge, []).append(group.pieces[0])
        else:
            yield group
    for pieces in alone.values():
        pieces.sort()
        run = pieces[0]
        for piece in pieces[1:]:
            if piece.low == run.high:
                run = Piece(run.edge, run.low, piece.high)
            else:
                yield Group((run,), (1,))
                run = piece
        yield Group((run,), (1,))
