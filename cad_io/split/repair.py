"""Curves of an edge in parameter planes that do not follow it, drawn anew.

Some files (and the kernel, where a file has none) give an edge a curve in a face's parameter plane that leaves the edge here
and there, or runs along it at another speed. The kernel does not see that while its few places of looking are not there.
Once the edge is cut they are, and the piece is not valid. So each place of the edge is sought on the surface.
"""

from typing import Any

import numpy as np
from OCP.BRep import BRep_Builder, BRep_Tool
from OCP.TopExp import TopExp
from OCP.TopLoc import TopLoc_Location

from cad_io.arrays import Floats
from cad_io.kernel import domain
from cad_io.kernel.splines import cubic
from cad_io.split.border import parameter_curve
from cad_io.split.check import valid
from cad_io.split.contour import Spline
from cad_io.split.net import LOOSER, Net, along, distance
from cad_io.split.surface_edge import DEVIATION
from cad_io.surface import Surface

_POINTS, _MOST_POINTS = 257, 5000
_STEPS = 20
#: What the curve may leave its nearest places by, mm: some times what a drawn curve may.
_OFF = 10 * DEVIATION


def repair(net: Net, key: int) -> None:
    """Draw the parameter curves of an edge anew where they do not follow it. The edge is changed in place; seams are left.

    Parameters
    ----------
    net : Net
        Of a copy of the part.
    key : int
        Number of the edge.
    """
    users = net.users(key)
    edge = net.edge(key)
    for face, used in users:
        if edge.point or sum(face.IsSame(other) for other, _ in users) > 1:
            continue
        old, first, last = parameter_curve(used, face)
        if old is None or (first, last) != (edge.first, edge.last):
            continue
        surface, places = net.surface(face), np.linspace(first, last, 4 * _POINTS)
        allowed = BRep_Tool.Tolerance_s(edge.edge)
        if distance(along(edge.curve, places), old, surface, places).max() <= allowed + _OFF:
            continue
        spline = _followed(edge.curve, old, surface, first, last)
        if spline is None:
            continue
        new, sound = cubic(spline.knots, spline.poles), valid(face)
        off = float(distance(along(edge.curve, places), new, surface, places).max())
        if off > allowed + LOOSER:
            continue  # the edge itself is off the surface
        _put(edge.edge, face, new, off)
        if sound and not valid(face):
            _put(edge.edge, face, old, 0.0)


def _put(edge: Any, face: Any, curve: Any, off: float) -> None:
    """Give an edge a curve on a face, from which it is so far off, mm."""
    builder, location = BRep_Builder(), TopLoc_Location()
    basis = BRep_Tool.Surface_s(face, location)
    tolerance = 1.05 * off + 1e-7
    builder.UpdateEdge(edge, curve, basis, location, tolerance)
    for vertex in (TopExp.FirstVertex_s(edge), TopExp.LastVertex_s(edge)):
        builder.UpdateVertex(vertex, tolerance)


def _followed(curve: Any, old: Any, surface: Surface, first: float, last: float) -> Spline | None:
    """Cubic in the parameter plane that follows a curve in space, with the ends of the old one; None if there is none."""
    from scipy.interpolate import make_interp_spline  # half a second to load

    t = np.linspace(first, last, _POINTS)
    while len(t) < _MOST_POINTS:
        uv = _nearest(curve, old, surface, t)
        if not np.isfinite(uv).all():
            return None
        uv[0], uv[-1] = old.Value(first).Coord(), old.Value(last).Coord()
        spline = make_interp_spline(t, uv, k=3)
        middle = 0.5 * (t[1:] + t[:-1])
        here, best = (surface.values(*at.T) for at in (spline(middle), _nearest(curve, old, surface, middle)))
        off = np.linalg.norm(here - best, axis=1) > _OFF
        if not off.any():
            return Spline(spline.t, spline.c, False)
        t = np.union1d(t, middle[off])
    return None


def _nearest(curve: Any, old: Any, surface: Surface, t: Floats) -> Floats:
    """Parameters (n, 2) of the places of a surface nearest to those of a curve, by Gauss and Newton from an old curve."""
    space = np.array([curve.Value(x).Coord() for x in t.tolist()])
    uv = np.array([old.Value(x).Coord() for x in t.tolist()])
    adaptor, (low_u, high_u, low_v, high_v) = surface.adaptor, domain(surface.adaptor)
    ranges = ((adaptor.IsUPeriodic(), low_u, high_u), (adaptor.IsVPeriodic(), low_v, high_v))
    for _ in range(_STEPS):
        nearest = surface.first(*uv.T)
        gap, slopes = space - nearest[:, 0], nearest[:, 1:]
        matrix = slopes @ slopes.transpose(0, 2, 1)
        size = matrix[:, 0, 0] * matrix[:, 1, 1] - matrix[:, 0, 1] ** 2
        pull = (slopes @ gap[:, :, None])[:, :, 0]
        with np.errstate(divide="ignore", invalid="ignore"):
            step = np.stack([matrix[:, 1, 1] * pull[:, 0] - matrix[:, 0, 1] * pull[:, 1],
                             matrix[:, 0, 0] * pull[:, 1] - matrix[:, 0, 1] * pull[:, 0]], axis=1) / size[:, None]  # fmt: skip
        uv = uv + step
        for axis, (periodic, low, high) in enumerate(ranges):
            if not periodic:
                uv[:, axis] = np.clip(uv[:, axis], low, high)
    return uv
