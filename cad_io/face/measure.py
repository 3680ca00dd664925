"""Area of a face, and what tells its inside from its outside: integrals over the trimmed surface, by line integrals.

The kernel's own figures cannot be relied on (areas up to 9 % off on surfaces of extrusion), so the densities are
tabulated at Chebyshev nodes, integrated along u in closed form, and summed around the border (Green). Where the surface
has kinks or jumps of curvature along knots, every cell between these has its own table. One pass gives the area, the
vector area and the flux of the position, from which follow the mean normal and the volume.
"""

from functools import cache
from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np
from numpy.polynomial import chebyshev
from OCP.BRepGProp import BRepGProp
from OCP.GeomAbs import GeomAbs_C2
from OCP.GProp import GProp_GProps

from cad_io.arrays import Floats, cross
from cad_io.face.trim import Trim
from cad_io.kernel import interval_ends, kind_of
from cad_io.surface import Surface

#: Nodes along one direction of a cell, tried in turn until what the last two orders add to the densities is below
#: ACCURACY. Only quadrics and tori are so tame that the fewest nodes can be trusted.
_NODES = (4, 8, 14, 24, 48)
ACCURACY = 3e-6
_TAME = ("Plane", "Cylinder", "Cone", "Sphere", "Torus")
_MOST_CELLS = 8  # a direction; with more breaks than that, each is too small to matter
_MOST_TABLE = 5000  # nodes of all cells together
_LEAST_TABLE = 200  # nodes that each cell may have nevertheless
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


def measure(surface: Surface, trim: Trim, origin: Floats) -> Measure:
    """Integrals over the face; NaN where the surface cannot be evaluated."""
    u0, u1, v0, v1 = trim.box
    if not (u1 > u0 and v1 > v0):
        return Measure(0.0, np.zeros(3), 0.0)
    breaks_u = _breaks(surface.adaptor.NbUIntervals(GeomAbs_C2), surface.adaptor.UIntervals, u0, u1)
    breaks_v = _breaks(surface.adaptor.NbVIntervals(GeomAbs_C2), surface.adaptor.VIntervals, v0, v1)
    u, v, step = _border_nodes(_split(_split(trim.segments, 0, breaks_u[1:-1]), 1, breaks_v[1:-1]), breaks_u, breaks_v)
    cells = [(a, b, c, d) for a, b in pairwise(breaks_u.tolist()) for c, d in pairwise(breaks_v.tolist())]
    most = max(_MOST_TABLE // len(cells), _LEAST_TABLE)
    total = sum((_integrals(_resolved(surface, cell, origin, most), cell, u, v, step) for cell in cells), np.zeros(5))
    # A border that runs the wrong way round makes all of it negative.
    total = total if total[0] >= 0 else -total
    if not trim.closed:
        properties = GProp_GProps()
        BRepGProp.SurfaceProperties_s(trim.face, properties)
        total = total * (properties.Mass() / total[0]) if total[0] > 0 else total
    return Measure(float(total[0]), total[1:4], float(total[4]))


def _breaks(count: int, intervals: Any, low: float, high: float) -> Floats:
    """Ends of the box and, between them, parameters at which second derivatives jump, unless there are many."""
    breaks = np.zeros(0)
    if 1 < count <= 10 * _MOST_CELLS:
        breaks = interval_ends(count, intervals, GeomAbs_C2)
        slack = 1e-9 * (high - low)
        breaks = breaks[(breaks > low + slack) & (breaks < high - slack)]
    return np.concatenate([[low], breaks if len(breaks) < _MOST_CELLS else [], [high]])


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


def _resolved(surface: Surface, cell: tuple[float, float, float, float], origin: Floats, most: int) -> Floats:
    """The table of a cell with as many nodes each way as the densities |N| and N need, at most so many in all."""
    turn = [0, 0] if kind_of(surface.adaptor) in _TAME else [1, 1]
    while True:
        table = _table(surface, cell, origin, _NODES[turn[0]], _NODES[turn[1]])
        size = np.abs(table[..., :4])
        enough = ACCURACY * size.max()
        rough = [axis for axis in (0, 1) if size.take([-2, -1], axis).max() > enough and turn[axis] + 1 < len(_NODES)]
        for axis in rough:
            turn[axis] += 1
        if not rough or _NODES[turn[0]] * _NODES[turn[1]] > most:
            return table


@cache
def _nodes(n: int) -> tuple[Floats, Floats]:
    """Chebyshev nodes, and the matrix (n, n) that takes values there to coefficients."""
    nodes = chebyshev.chebpts1(n)
    transform = 2.0 / n * np.cos(np.outer(np.arange(n), np.arccos(nodes)))
    transform[0] *= 0.5
    return nodes, transform


def _table(surface: Surface, cell: tuple[float, float, float, float], origin: Floats, n: int, m: int) -> Floats:
    """Chebyshev coefficients (n, m, 5) over a cell of |N|, N and (S - origin) . N."""
    u0, u1, v0, v1 = cell
    (x, along_u), (y, along_v) = _nodes(n), _nodes(m)
    u, v = np.meshgrid(u0 + 0.5 * (x + 1) * (u1 - u0), v0 + 0.5 * (y + 1) * (v1 - v0), indexing="ij")
    d = surface.first(u.ravel(), v.ravel())
    normal = cross(d[:, 1], d[:, 2])
    flux = ((d[:, 0] - origin) * normal).sum(axis=1)
    density = np.column_stack([np.linalg.norm(normal, axis=1), normal, flux])
    return along_v @ (along_u @ density.reshape(n, -1)).reshape(n, m, 5)


def _integrals(table: Floats, cell: tuple[float, float, float, float], u: Floats, v: Floats, step: Floats) -> Floats:
    """Line integral around the border, dv, of the u-antiderivative of a density that is zero outside the cell."""
    u0, u1, v0, v1 = cell
    here = (v >= v0) & (v <= v1) & (u > u0)
    x = np.minimum(2 * (u[here] - u0) / (u1 - u0) - 1, 1.0)
    y = 2 * (v[here] - v0) / (v1 - v0) - 1
    antiderivative = 0.5 * (u1 - u0) * chebyshev.chebint(table, lbnd=-1.0, axis=0)
    n, m, fields = antiderivative.shape
    # Sum over the border nodes first: what is left is as small as the table.
    # Not by `@`: waking its threads costs more than they save.
    moments = np.einsum("ki,kj->ij", chebyshev.chebvander(x, n - 1) * step[here, None], chebyshev.chebvander(y, m - 1))
    return moments.ravel() @ antiderivative.reshape(n * m, fields)
