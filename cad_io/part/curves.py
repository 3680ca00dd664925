"""Curves of edges as cubic pieces, all in common arrays: evaluated, measured and projected on many at a time.

Each piece carries on the ends and derivatives of the kernel's curve, and pieces are halved until they follow it. The number of
steps is fixed: a curve that does not let itself be followed is not drawn.
"""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from OCP.BRepAdaptor import BRepAdaptor_Curve
from OCP.GeomAbs import GeomAbs_C2, GeomAbs_Line
from OCP.TopoDS import TopoDS_Edge

from cad_io.arrays import Floats
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
    """Curves of edges, by place in a list.

    Parameters
    ----------
    edges : sequence of TopoDS_Edge
    chord : float
        How far pieces may be from the kernel's curves, mm.

    Attributes
    ----------
    drawn : (n,) bool
        The others have no curve, or none that could be followed: ask nothing about them.
    low, high : (n,) float
        Ranges of the parameters.
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
        self._measure()

    def _measure(self) -> None:
        """Set the table of lengths: parameters of the chords' ends and the length up to each."""
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
        i, share = self._chord(which, t)
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

    def count(self, which: Indices) -> Indices:
        """Numbers (m,) of pieces of curves."""
        return np.asarray(np.diff(self._first)[which] - 1)

    def _chord(self, which: Indices, t: Floats) -> tuple[Indices, Floats]:
        i = self._piece(self._table_t, self.table_first, which, t)
        step = self._table_t[i + 1] - self._table_t[i]
        return i, np.clip((t - self._table_t[i]) / step, 0.0, 1.0)

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


class _Kernel(NamedTuple):
    """The kernel's curve of an edge, and where its smooth parts end."""

    curve: BRepAdaptor_Curve
    ends: Floats

    @classmethod
    def of(cls, edge: TopoDS_Edge) -> "_Kernel | None":
        ends = np.zeros(0)
        with may_refuse():
            curve = BRepAdaptor_Curve(edge)
            low, high = curve.FirstParameter(), curve.LastParameter()
            if not (low < high and max(-low, high) < _INFINITE):
                return None
            if curve.GetType() == GeomAbs_Line:
                return cls(curve, np.array([low, high]))
            count = curve.NbIntervals(GeomAbs_C2)
            if not 0 < count <= _MOST_INTERVALS:
                return None
            ends = np.unique(np.clip(interval_ends(count, curve.Intervals, GeomAbs_C2), low, high))
        if len(ends) < 2:
            return None
        each = max(_FIRST // (len(ends) - 1), 1)
        share = np.arange(each) / each
        t = (ends[:-1, None] + share * np.diff(ends)[:, None]).ravel()
        return cls(curve, np.append(t, ends[-1]))

    def at(self, t: Floats) -> tuple[Floats, Floats] | None:
        """Points and derivatives (k, 3); None where the kernel has none."""
        with may_refuse():
            derivatives = along(self.curve, t, 3)
            if np.isfinite(derivatives).all():
                return derivatives[:, 0], derivatives[:, 1]
        return None


def _followed(edge: TopoDS_Edge, chord: float) -> _Drawing | None:
    """The curve of an edge in pieces; None where it cannot be followed."""
    kernel = _Kernel.of(edge)
    if kernel is None:
        return None
    t, points = kernel.ends, kernel.at(kernel.ends)
    if points is None:
        return None
    p, d = points
    doubtful = np.ones(len(t) - 1, bool)
    for _ in range(_HALVINGS):
        i = np.flatnonzero(doubtful)
        h = t[i + 1] - t[i]
        points = kernel.at(0.5 * (t[i] + t[i + 1]))
        if points is None:
            return None
        (middle, along), across = points, h[:, None]
        guess = 0.5 * (p[i] + p[i + 1]) + across * (d[i] - d[i + 1]) / 8
        slope = 1.5 * (p[i + 1] - p[i]) - across * (d[i] + d[i + 1]) / 4
        off = np.maximum(np.linalg.norm(guess - middle, axis=1), np.linalg.norm(slope - across * along, axis=1) / 8)
        # Both halves are kept in any case.
        at = i + 1
        t, p, d = _with(t, at, 0.5 * (t[i] + t[i + 1])), _with(p, at, middle), _with(d, at, along)
        where, bad = i + np.arange(len(i)), off > _HALVES * chord
        doubtful = np.zeros(len(t) - 1, bool)
        doubtful[where], doubtful[where + 1] = bad, bad
        if not bad.any():
            return _Drawing(t, p, d)
        if len(t) > MOST_PIECES:
            return None
    return None


def _with(rows: Floats, at: Indices, more: Floats) -> Floats:
    """Rows with more of them, each before the row that it names."""
    result = np.empty((len(rows) + len(more), *rows.shape[1:]))
    fresh = at + np.arange(len(at))
    old = np.ones(len(result), bool)
    old[fresh] = False
    result[fresh], result[old] = more, rows
    return result
