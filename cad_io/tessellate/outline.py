"""Where triangles of a face may begin and end: its border curves in the parameter plane, sampled, with nodes they share."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
import shapely
from numpy.typing import NDArray
from OCP.BRepAdaptor import BRepAdaptor_Curve2d
from OCP.GeomAbs import GeomAbs_C2, GeomAbs_Line
from OCP.TopoDS import TopoDS_Face
from scipy.spatial import cKDTree

from cad_io.arrays import Floats, Ints
from cad_io.face.trim import continuing
from cad_io.kernel import bounding, interval_ends, points_on
from cad_io.tessellate.planar import places

#: Chords of a bent border curve, at least; how often one is halved, at most.
_CHORDS, _HALVINGS = 4, 14
#: A node so near to a chord is on it: a share of the border's extent.
_MET = 1e-12
#: Shares of a chord at which a curve is held against it.
_TRIED = (0.25, 0.5, 0.75)


class Use(NamedTuple):
    """One use of an edge: its curve in the parameter plane, the ends of its parameter, and whether it runs along the curve."""

    curve: BRepAdaptor_Curve2d
    first: float
    last: float
    forward: bool


class Sampled(NamedTuple):
    """A use with places along it: parameters (k,) and where the curve is there (k, 2), in the direction of the use."""

    use: Use
    parameter: Floats
    on_curve: Floats


class Outline(NamedTuple):
    """The border of a face as chords between nodes uv (n, 2); nodes of each use are rows of them (k,).

    Where a use ends beside the start of the one that continues it, both have that start for a node.
    """

    uv: Floats
    nodes: tuple[Ints, ...]
    uses: tuple[Sampled, ...]

    @property
    def chords(self) -> Ints:
        """Nodes (k, 2) of all chords, those without length left out."""
        pairs = np.concatenate([np.stack([each[:-1], each[1:]], axis=1) for each in self.nodes])
        return pairs[pairs[:, 0] != pairs[:, 1]]


class Steps(NamedTuple):
    """How long chords may be.

    bend (2,): of a step (du, dv) the surface bends by at most `(bend * step^2).sum()`, about; mm for a step of 1. chord: how far
    the surface may be from a straight step, mm. scale (2,): mm per unit of u and v. sag: how far a curve may be from it, mm.
    """

    bend: Floats
    chord: float
    scale: Floats
    sag: float

    def pieces(self, step: Floats) -> NDArray[np.int64]:
        """Into how many pieces to cut steps (n, 2)."""
        bent = (self.bend * step * step).sum(axis=-1)
        return np.maximum(1, np.ceil(np.sqrt(bent / (8.0 * self.chord)) - 1e-6)).astype(np.int64)


def uses_of(face: TopoDS_Face) -> list[Use]:
    """The uses of a face's edges, those inside of it left out."""
    forward, edges = bounding(face)
    curves = [(BRepAdaptor_Curve2d(edge, forward), way) for edge, way in edges]
    return [Use(curve, curve.FirstParameter(), curve.LastParameter(), way > 0) for curve, way in curves]


def outline_of(uses: Sequence[Use], steps: Steps, most: int) -> Outline | None:
    """The border as chords; None where there is none, it has no place, or takes more than so many nodes."""
    sampled: list[Sampled] = []
    total = 0
    for use in uses:
        sampled.append(_sampled(use, steps, most))
        total += len(sampled[-1].parameter)
        if total > most or not np.isfinite(sampled[-1].on_curve).all():
            return None
    return joined(sampled, steps.scale) if sampled else None


def joined(sampled: Sequence[Sampled], scale: Floats) -> Outline:
    """The outline of sampled uses: nodes at one place are one, and each use ends where the one that continues it starts."""
    start, end = (np.array([each.on_curve[k] for each in sampled]) for k in (0, -1))
    following = continuing(start, end, scale)
    at = np.concatenate(
        [np.concatenate([each.on_curve[:-1], start[next_][None]]) for each, next_ in zip(sampled, following, strict=True)]
    )
    first, row = places(at)
    ends = np.cumsum([len(each.parameter) for each in sampled])
    return Outline(at[first], tuple(np.split(row.astype(np.int32), ends[:-1])), tuple(sampled))


def cut_where_they_meet(outline: Outline) -> Outline:
    """The outline with nodes where its chords meet each other: for a border that crosses or touches itself, or runs along itself.

    A new node lies on the chord, at the parameter that is as far along; the curve may pass beside it.
    """
    ends = np.concatenate([np.stack([each[:-1], each[1:]], axis=1) for each in outline.nodes])
    lines = shapely.linestrings(outline.uv[ends])
    near = _MET * float(np.ptp(outline.uv, axis=0).max())
    met = shapely.get_coordinates(shapely.union_all(lines))
    known = cKDTree(outline.uv)
    met = np.unique(met[known.query(met)[0] > near], axis=0)
    nodes = np.concatenate([outline.uv, met])
    row, chord = shapely.STRtree(lines).query(shapely.points(nodes), predicate="dwithin", distance=near)
    apart = (row != ends[chord, 0]) & (row != ends[chord, 1])
    row, chord = row[apart], chord[apart]
    start, step = nodes[ends[chord, 0]], nodes[ends[chord, 1]] - nodes[ends[chord, 0]]
    share = ((nodes[row] - start) * step).sum(axis=1) / (step * step).sum(axis=1)
    within = (share > 0.0) & (share < 1.0)
    row, chord, share = row[within], chord[within], share[within]
    order = np.lexsort((share, chord))
    row, chord, share = row[order], chord[order], share[order]
    cuts, first = [], 0
    for mine, each in zip(outline.nodes, outline.uses, strict=True):
        here = (chord >= first) & (chord < first + len(mine) - 1)
        at = chord[here] - first
        t = each.parameter
        t = np.insert(t, at + 1, t[at] + share[here] * (t[at + 1] - t[at]))
        on_curve = points_on(each.use.curve, t)
        cuts.append((np.insert(mine, at + 1, row[here]), Sampled(each.use, t, on_curve)))
        first += len(mine) - 1
    return Outline(nodes, tuple(mine for mine, _ in cuts), tuple(each for _, each in cuts))


def _sampled(use: Use, steps: Steps, most: int) -> Sampled:
    t = _straight(use, steps, most) if use.curve.GetType() == GeomAbs_Line else _bent(use, steps, most)
    if not use.forward:
        t = t[::-1]
    return Sampled(use, t, points_on(use.curve, t))


def _straight(use: Use, steps: Steps, most: int) -> Floats:
    ends = np.array([use.curve.Value(t).Coord() for t in (use.first, use.last)])
    if not np.isfinite(ends).all():
        return np.array([use.first, use.last])
    return np.linspace(use.first, use.last, 1 + min(most, int(steps.pieces(ends[1] - ends[0]))))


def _bent(use: Use, steps: Steps, most: int) -> Floats:
    """Parameters at which a curve is cut so that its chords are near it, and short enough."""
    value = use.curve.Value
    spans = use.curve.NbIntervals(GeomAbs_C2)
    knots = interval_ends(spans, use.curve.Intervals, GeomAbs_C2)
    # Every so many spans together: what is between is seen when chords are tried.
    wanted = np.arange(_CHORDS + 1) / _CHORDS * spans
    t = np.interp(wanted, np.arange(spans + 1), knots)
    t[0], t[-1] = use.first, use.last
    (per_u, per_v), (bend_u, bend_v) = steps.scale.tolist(), steps.bend.tolist()
    limit, sag = 8.0 * steps.chord, steps.sag * steps.sag
    parameters = [float(t[0])]
    here, at = float(t[0]), value(float(t[0])).Coord()
    for last in t[1:].tolist():
        pending = [(last, value(last).Coord(), 0)]
        while pending:
            there, to, halvings = pending[-1]
            du, dv = to[0] - at[0], to[1] - at[1]
            far = halvings < _HALVINGS and len(parameters) <= most
            if far and bend_u * du * du + bend_v * dv * dv <= limit:
                far = False
                for share in _TRIED:
                    u, v = value(here + share * (there - here)).Coord()
                    u, v = (u - at[0]) * per_u, (v - at[1]) * per_v
                    along_u, along_v = du * per_u, dv * per_v
                    length = along_u * along_u + along_v * along_v
                    on = (u * along_u + v * along_v) / length if length > 0.0 else 0.0
                    on = min(1.0, max(0.0, on))
                    if (u - on * along_u) ** 2 + (v - on * along_v) ** 2 > sag:
                        far = True
                        break
            if far:
                middle = 0.5 * (here + there)
                pending[-1] = (there, to, halvings + 1)
                pending.append((middle, value(middle).Coord(), halvings + 1))
                continue
            parameters.append(there)
            here, at = there, to
            pending.pop()
    return np.array(parameters)
