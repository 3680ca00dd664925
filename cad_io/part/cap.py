"""Caps over the openings of a skin that is meant to enclose something: with them, what lies within can be told.

How a cap runs between its borders is a guess. What follows from it alone is never called sure.
"""

from collections.abc import Sequence
from functools import partial

import numpy as np
from OCP.BRepAdaptor import BRepAdaptor_Curve
from OCP.GCPnts import GCPnts_TangentialDeflection
from OCP.TopoDS import TopoDS_Edge, TopoDS_Face
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components
from scipy.spatial import cKDTree

from cad_io.arrays import Floats
from cad_io.kernel import may_refuse
from cad_io.part.sew import edge_uses
from plan_cutters_base.forks import Ended, each

#: Deflections of a cap's border, rad, and mm as a share of the part's diagonal.
_ANGLE, _CHORD = 0.2, 1e-4
#: Ends of open edges so near, as a share of the part's diagonal, are one.
_SAME = 1e-5
#: Processor seconds that one edge may take: it takes less than a millisecond.
SECONDS = 5.0


def flux_of(cap: Floats, origin: Floats) -> float:
    """Integral of (S - origin) . N over triangles (t, 3, 3), mm3: three times the volume over the origin."""
    normal = np.cross(cap[:, 1] - cap[:, 0], cap[:, 2] - cap[:, 0])
    return 0.5 * float(((cap[:, 0] - origin) * normal).sum())


def cap_of(shapes: Sequence[TopoDS_Face], sign: Floats, diagonal: float) -> Floats:
    """Triangles (t, 3, 3) that close the openings of faces: each a cone over its border, from the border's middle.

    Parameters
    ----------
    shapes : sequence of TopoDS_Face
    sign : (k,) float
        +1 for a face that is seen from outside with `dS/du x dS/dv` towards the eye, else -1.
    diagonal : float
        Of the part, mm.
    """
    nets = [(edge, sum(way * int(sign[i]) for i, way in users)) for edge, users in edge_uses(shapes)]
    border = [(edge, net) for edge, net in nets if net]
    lines, ways = [], []
    polylines = each(partial(polyline, chord=_CHORD * diagonal), [edge for edge, _ in border], seconds=SECONDS)
    for line, (_, net) in zip(polylines, border, strict=True):
        # An edge that cannot be drawn to an end is left out, as one without a curve is.
        if not isinstance(line, Ended) and len(line) > 1:
            lines.append(line if net > 0 else line[::-1])
            ways.append(abs(net))
    if not lines:
        return np.zeros((0, 3, 3))
    return coned(lines, ways, _SAME * diagonal)


def coned(lines: Sequence[Floats], ways: Sequence[int], near: float) -> Floats:
    """Triangles (t, 3, 3) that close openings.

    Parameters
    ----------
    lines : sequence of (k, 3) float
        Pieces of the openings' borders, each run along as the skin does that they border.
    ways : sequence of int
        How often.
    near : float
        Ends of pieces so near belong to one opening, mm.
    """
    ends = np.concatenate([line[[0, -1]] for line in lines])
    pairs = cKDTree(ends).query_pairs(near, output_type="ndarray")
    own = np.arange(0, len(ends), 2)
    rows, columns = np.concatenate([pairs[:, 0], own]), np.concatenate([pairs[:, 1], own + 1])
    graph = coo_array((np.ones(len(rows), np.int8), (rows, columns)), shape=(len(ends), len(ends)))
    opening = connected_components(graph, directed=False)[1][::2]
    made = []
    for which in range(int(opening.max()) + 1):
        mine = np.flatnonzero(opening == which).tolist()
        apex = np.concatenate([lines[i] for i in mine]).mean(axis=0)
        for i in mine:
            top = np.broadcast_to(apex, (len(lines[i]) - 1, 3))
            made += [np.stack([top, lines[i][1:], lines[i][:-1]], axis=1)] * ways[i]
    return np.concatenate(made)


def polyline(edge: TopoDS_Edge, chord: float) -> Floats:
    """Points (k, 3) along an edge, chords at most so far from it, mm, the way its curve runs; none where it has none."""
    with may_refuse():
        points = GCPnts_TangentialDeflection(BRepAdaptor_Curve(edge), _ANGLE, chord)
        line = np.array([points.Value(i + 1).Coord() for i in range(points.NbPoints())]).reshape(-1, 3)
        if np.isfinite(line).all():
            return line
    return np.zeros((0, 3))
