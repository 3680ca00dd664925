"""Area of a face, and what tells its inside from its outside: integrals over the trimmed surface, by line integrals.

The kernel's own figures cannot be relied on (areas up to 9 % off on surfaces of extrusion), so the densities are
tabulated at Chebyshev nodes of the trim's box, integrated along u in closed form, and summed around the border
(Green). One table gives the area, the vector area and the flux of the position, from which follow the mean normal and
the volume.
"""

from typing import NamedTuple

import numpy as np
from numpy.polynomial import chebyshev
from OCP.BRepAdaptor import BRepAdaptor_Surface
from OCP.BRepGProp import BRepGProp
from OCP.GProp import GProp_GProps

from cad_io.arrays import Floats
from cad_io.kernel import first_derivatives
from cad_io.trim import Trim

#: Nodes per direction, tried in turn until the area agrees with the one before to ACCURACY.
_NODES = (8, 16, 32, 48)
ACCURACY = 1e-5
_GAUSS, _WEIGHTS = np.polynomial.legendre.leggauss(3)
_PIECE = 0.05  # of the box: longest piece of border that is given three Gauss nodes


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
    unit = 2 * (trim.segments - (u0, v0)) / (u1 - u0, v1 - v0) - 1
    x, y, step = _border_nodes(unit)
    step *= 0.25 * (u1 - u0) * (v1 - v0)
    before = np.inf
    for n in _NODES:
        total = _around(_table(adaptor, trim, origin, n), x, y, step)
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


def _border_nodes(segments: Floats) -> tuple[Floats, Floats, Floats]:
    """Gauss nodes x, y on the border in the unit square [-1, 1]^2, and the share of dy that each stands for."""
    along = segments[:, 1] - segments[:, 0]
    pieces = np.maximum(np.ceil(np.abs(along).max(axis=1) / (2 * _PIECE)), 1).astype(int)
    which = np.repeat(np.arange(len(pieces)), pieces)
    nth = np.arange(len(which)) - np.repeat(np.cumsum(pieces) - pieces, pieces)
    share = (nth[:, None] + 0.5 * (_GAUSS + 1)) / pieces[which, None]
    nodes = segments[which, 0, None] + share[..., None] * along[which, None]
    step = (along[which, 1] / pieces[which])[:, None] * (0.5 * _WEIGHTS)
    return nodes[..., 0].ravel(), nodes[..., 1].ravel(), step.ravel()


def _table(adaptor: BRepAdaptor_Surface, trim: Trim, origin: Floats, n: int) -> Floats:
    """Chebyshev coefficients (n, n, 5) over the box of |N|, N and (S - origin) . N."""
    u0, u1, v0, v1 = trim.box
    nodes = chebyshev.chebpts1(n)
    u, v = np.meshgrid(u0 + 0.5 * (nodes + 1) * (u1 - u0), v0 + 0.5 * (nodes + 1) * (v1 - v0), indexing="ij")
    d = first_derivatives(adaptor, u.ravel(), v.ravel())
    normal = np.cross(d[:, 1], d[:, 2])
    flux = ((d[:, 0] - origin) * normal).sum(axis=1)
    density = np.column_stack([np.linalg.norm(normal, axis=1), normal, flux]).reshape(n, n, 5)
    transform = chebyshev.chebvander(nodes, n - 1).T * (2.0 / n)
    transform[0] *= 0.5
    along = (transform @ density.reshape(n, -1)).reshape(n, n, 5)
    return transform @ along


def _around(table: Floats, x: Floats, y: Floats, step: Floats) -> Floats:
    """Line integral of the u-antiderivative of the table, dv, around the border."""
    antiderivative = chebyshev.chebint(table, lbnd=-1.0, axis=0)
    n, m, fields = antiderivative.shape
    # Sum over the border nodes first: what is left is as small as the table.
    moments = (chebyshev.chebvander(x, n - 1) * step[:, None]).T @ chebyshev.chebvander(y, m - 1)
    return moments.ravel() @ antiderivative.reshape(n * m, fields)
