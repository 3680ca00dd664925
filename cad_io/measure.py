"""Area of a face, and what tells its inside from its outside: integrals over the trimmed surface, by line integrals.

The kernel's own figures cannot be relied on (areas up to 9 % off on surfaces of extrusion), so the densities are
tabulated at Chebyshev nodes, integrated along u in closed form, and summed around the border (Green). Where the surface
has kinks or jumps of curvature along knots, every cell between these has its own table. One pass gives the area, the
vector area and the flux of the position, from which follow the mean normal and the volume.
"""

from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np
from numpy.polynomial import chebyshev
from OCP.BRepAdaptor import BRepAdaptor_Surface
from OCP.BRepGProp import BRepGProp
from OCP.GeomAbs import GeomAbs_C2
from OCP.GProp import GProp_GProps

from cad_io.arrays import Floats
from cad_io.kernel import first_derivatives, interval_ends
from cad_io.trim import Trim

#: Nodes per direction and cell, tried in turn until the area agrees with the one before to ACCURACY.
_NODES = (6, 10, 16, 28, 48)
ACCURACY = 1e-6
_MOST_CELLS = 8  # a direction; with more breaks than that, each is too small to matter
_MOST_TABLE = 5000  # nodes in all, once the first two tables are made
_GAUSS, _WEIGHTS = np.polynomial.legendre.leggauss(3)
_PIECE = 0.05  # of a cell: longest piece of border that is given three Gauss nodes


class Measure(NamedTuple):
    """Integrals over one face, with N = dS/du x dS/dv.

    area : mm2. vector : (3,) integral of N, mm2. flux : integral of (S - origin) . N, mm3 (three times a closed
    shell's volume, if summed with the right signs).
    """

    area: float
    vector: Floats
    flux: float


def measure(adaptor: BRepAdaptor_Surface, trim: Trim, origin: Floats) -> Measure:
    """Integrals over the face; NaN where the surface cannot be evaluated."""
    u0, u1, v0, v1 = trim.box
    if not (u1 > u0 and v1 > v0):
        return Measure(0.0, np.zeros(3), 0.0)
    breaks_u = _breaks(adaptor.NbUIntervals(GeomAbs_C2), adaptor.UIntervals, u0, u1)
    breaks_v = _breaks(adaptor.NbVIntervals(GeomAbs_C2), adaptor.VIntervals, v0, v1)
    u, v, step = _border_nodes(_split(_split(trim.segments, 0, breaks_u[1:-1]), 1, breaks_v[1:-1]), breaks_u, breaks_v)
    cells = [(a, b, c, d) for a, b in pairwise(breaks_u.tolist()) for c, d in pairwise(breaks_v.tolist())]
    before, total = np.inf, np.zeros(5)
    for turn, n in enumerate(_NODES):
        if turn > 1 and len(cells) * n * n > _MOST_TABLE:
            break
        total = sum((_around(_table(adaptor, cell, origin, n), cell, u, v, step) for cell in cells), np.zeros(5))
        if not np.isfinite(total).all() or abs(total[0] - before) <= ACCURACY * abs(total[0]):
            break
        before = float(total[0])
    # A border that runs the wrong way round makes all of it negative.
    total = total if total[0] >= 0 else -total
    if not trim.closed:
        properties = GProp_GProps()
        BRepGProp.SurfaceProperties_s(trim.face, properties)
        total = total * (properties.Mass() / total[0]) if total[0] > 0 else total
    return Measure(float(total[0]), total[1:4], float(total[4]))


def _breaks(count: int, intervals: Any, low: float, high: float) -> Floats:
    """Ends of the box and, between them, parameters at which second derivatives jump, unless there are many."""
    found = np.zeros(0)
    if 1 < count <= 10 * _MOST_CELLS:
        found = interval_ends(count, intervals, GeomAbs_C2)
        slack = 1e-9 * (high - low)
        found = found[(found > low + slack) & (found < high - slack)]
    return np.concatenate([[low], found if len(found) < _MOST_CELLS else [], [high]])


def _split(segments: Floats, axis: int, breaks: Floats) -> Floats:
    """Segments cut where they cross breaks along an axis."""
    for at in breaks.tolist():
        a, b = segments[:, 0, axis], segments[:, 1, axis]
        crosses = (a - at) * (b - at) < 0
        share = ((at - a[crosses]) / (b[crosses] - a[crosses]))[:, None]
        middle = segments[crosses, 0] + share * (segments[crosses, 1] - segments[crosses, 0])
        middle[:, axis] = at
        halves = [np.stack([segments[crosses, 0], middle], axis=1), np.stack([middle, segments[crosses, 1]], axis=1)]
        segments = np.concatenate([segments[~crosses], *halves])
    return segments


def _border_nodes(segments: Floats, breaks_u: Floats, breaks_v: Floats) -> tuple[Floats, Floats, Floats]:
    """Gauss nodes u, v on the border, and the share of dv that each stands for."""
    along = segments[:, 1] - segments[:, 0]
    cell = np.array([np.diff(breaks_u).min(), np.diff(breaks_v).min()])
    pieces = np.clip(np.ceil((np.abs(along) / cell).max(axis=1) / _PIECE), 1, 200).astype(int)
    which = np.repeat(np.arange(len(pieces)), pieces)
    nth = np.arange(len(which)) - np.repeat(np.cumsum(pieces) - pieces, pieces)
    share = (nth[:, None] + 0.5 * (_GAUSS + 1)) / pieces[which, None]
    nodes = segments[which, 0, None] + share[..., None] * along[which, None]
    step = (along[which, 1] / pieces[which])[:, None] * (0.5 * _WEIGHTS)
    return nodes[..., 0].ravel(), nodes[..., 1].ravel(), step.ravel()


def _table(adaptor: BRepAdaptor_Surface, cell: tuple[float, float, float, float], origin: Floats, n: int) -> Floats:
    """Chebyshev coefficients (n, n, 5) over a cell of |N|, N and (S - origin) . N."""
    u0, u1, v0, v1 = cell
    nodes = chebyshev.chebpts1(n)
    u, v = np.meshgrid(u0 + 0.5 * (nodes + 1) * (u1 - u0), v0 + 0.5 * (nodes + 1) * (v1 - v0), indexing="ij")
    d = first_derivatives(adaptor, u.ravel(), v.ravel())
    normal = np.cross(d[:, 1], d[:, 2])
    flux = ((d[:, 0] - origin) * normal).sum(axis=1)
    density = np.column_stack([np.linalg.norm(normal, axis=1), normal, flux])
    transform = chebyshev.chebvander(nodes, n - 1).T * (2.0 / n)
    transform[0] *= 0.5
    along = (transform @ density.reshape(n, -1)).reshape(n, n, 5)
    return transform @ along


def _around(
    table: Floats, cell: tuple[float, float, float, float], u: Floats, v: Floats, step: Floats
) -> Floats:  # fmt: skip
    """Line integral around the border, dv, of the u-antiderivative of a density that is zero outside the cell."""
    u0, u1, v0, v1 = cell
    here = (v >= v0) & (v <= v1) & (u > u0)
    x = np.minimum(2 * (u[here] - u0) / (u1 - u0) - 1, 1.0)
    y = 2 * (v[here] - v0) / (v1 - v0) - 1
    antiderivative = 0.5 * (u1 - u0) * chebyshev.chebint(table, lbnd=-1.0, axis=0)
    n, m, fields = antiderivative.shape
    # Sum over the border nodes first: what is left is as small as the table.
    moments = (chebyshev.chebvander(x, n - 1) * step[here, None]).T @ chebyshev.chebvander(y, m - 1)
    return moments.ravel() @ antiderivative.reshape(n * m, fields)
