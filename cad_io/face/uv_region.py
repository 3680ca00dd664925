"""A face as a region of its surface's parameter plane: outline, area, which points lie in it.

All of it is read off the curves that bound the face in (u, v), as even-odd regions, so seams (which occur twice) and
degenerated edges need no special care and the order of the edges does not matter.
"""

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray
from OCP.BRep import BRep_Tool
from OCP.BRepAdaptor import BRepAdaptor_Curve2d
from OCP.GeomAbs import GeomAbs_BezierCurve, GeomAbs_BSplineCurve, GeomAbs_CN, GeomAbs_Line
from OCP.TopTools import TopTools_IndexedMapOfShape

from cad_io.arrays import Floats
from cad_io.face.trim import even_odd, joins
from cad_io.kernel import along, bounding, interval_ends

_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(6)  # exact for polynomial curves up to degree 6
_CHORDS = 4  # of an interval, in an outline
_OFF = 1e-7  # of the grid, that rows are moved by
_FEW = 50  # places of a curve that are asked of the kernel one by one
_ARCS = 8  # intervals that a curve without knots (conic) is cut into


def outline(face: Any) -> Floats:
    """Segments (n, 2, 2) between (u, v) points of the face's boundary, in no order; empty for an unbounded face.

    Curves do not meet exactly at their vertex: what is between their ends are segments, too, or rows would slip through.
    """
    pieces = []
    for curve, ends, sign in boundary(face):
        t = ends
        if len(ends) > 2 or curve.GetType() != GeomAbs_Line:
            t = np.append((ends[:-1, None] + np.diff(ends)[:, None] * np.arange(_CHORDS) / _CHORDS).ravel(), ends[-1])
        uv = np.array([curve.Value(x).Coord() for x in t.tolist()])
        pieces.append(uv if sign > 0 else uv[::-1])
    if not pieces:
        return np.empty((0, 2, 2))
    extent = np.ptp(np.concatenate(pieces), axis=0)
    between, _ = joins(pieces, 1 / np.maximum(extent, 1e-300))
    return np.concatenate([*(np.stack([uv[:-1], uv[1:]], axis=1) for uv in pieces), between])


def uv_areas(faces: Sequence[Any]) -> list[float]:
    """Areas of faces of one surface in (u, v), exact for polynomial boundaries: the integrals of u dv around them.

    What bounds two of them is integrated once.
    """
    known = TopTools_IndexedMapOfShape()
    integrals: dict[tuple[int, Any], float] = {}
    areas = []
    for face in faces:
        total = 0.0
        forward, edges = bounding(face)
        for edge, way in edges:
            # A seam has two curves, by its orientation.
            mark = known.Add(edge), way if BRep_Tool.IsClosed_s(edge, forward) else None
            if mark not in integrals:
                integrals[mark] = _integral(BRepAdaptor_Curve2d(edge, forward))
            total += way * integrals[mark]
        areas.append(total)
    return areas


def _integral(curve: Any) -> float:
    """The integral of u dv along a curve."""
    kind, ends = curve.GetType(), _ends(curve)
    if kind == GeomAbs_Line:
        (u, v), (to_u, to_v) = (curve.Value(float(t)).Coord() for t in (ends[0], ends[-1]))
        return 0.5 * float((u + to_u) * (to_v - v))
    smooth = kind in (GeomAbs_BSplineCurve, GeomAbs_BezierCurve) and curve.NbIntervals(GeomAbs_CN) == 1
    if smooth and not curve.IsRational() and curve.Degree() <= len(_NODES):
        ends = ends[[0, -1]]
    half = 0.5 * np.diff(ends)
    t = ((0.5 * (ends[1:] + ends[:-1]))[:, None] + half[:, None] * _NODES).ravel()
    place, slope = _followed(curve, t)
    return float(((half[:, None] * _WEIGHTS).ravel() * place[:, 0] * slope[:, 1]).sum())


def _followed(curve: Any, t: Floats) -> tuple[Floats, Floats]:
    if curve.GetType() == GeomAbs_BSplineCurve and len(t) > _FEW:
        spline = curve.BSpline()
        if not (spline.IsRational() or spline.IsPeriodic()):
            poles = np.array([spline.Pole(i).Coord() for i in range(1, spline.NbPoles() + 1)])
            flat = spline.KnotSequence()
            knots = np.array([flat.Value(i) for i in range(flat.Lower(), flat.Upper() + 1)])
            from scipy.interpolate import BSpline  # half a second to load

            known = BSpline(knots, poles, spline.Degree())
            return known(t), known.derivative()(t)
    points = along(curve, t)
    return points[:, 0], points[:, 1]


def nodes_inside(segments: Floats, u: Floats, v: Floats) -> NDArray[np.bool_]:
    """Which nodes of the grid u (nu,) x v (nv,), both increasing, lie in an outline: (nu, nv), by even-odd rows."""
    # Borders like to run along grid lines, where rounding decides what a row crosses: rows are taken a little off.
    v = v + _OFF * (v[-1] - v[0])
    return even_odd(segments, u, v)


def interior_point(segments: Floats) -> tuple[float, float]:
    """A point well inside an outline: the middle of the longest of several chords along u."""
    low, high = segments[..., 1].min(), segments[..., 1].max()
    best, middle = -1.0, (float(segments[0, :, 0].mean()), float(segments[0, :, 1].mean()))
    for share in (0.5, 0.31, 0.69, 0.17, 0.83, 0.07, 0.93):
        v = low + share * (high - low)
        p, q = segments[:, 0], segments[:, 1]
        hit = (p[:, 1] <= v) != (q[:, 1] <= v)
        p, q = p[hit], q[hit]
        u = np.sort(p[:, 0] + (v - p[:, 1]) / (q[:, 1] - p[:, 1]) * (q[:, 0] - p[:, 0]))
        for a, b in zip(u[:-1:2].tolist(), u[1::2].tolist(), strict=True):
            if b - a > best:
                best, middle = b - a, (0.5 * (a + b), float(v))
    return middle


def boundary(face: Any) -> list[tuple[Any, Floats, float]]:
    """Boundary curves in (u, v), the ends (k + 1,) of their smooth intervals, +1 or -1 for their direction."""
    forward, edges = bounding(face)
    return [(curve := BRepAdaptor_Curve2d(edge, forward), _ends(curve), float(way)) for edge, way in edges]


def _ends(curve: Any) -> Floats:
    """Ends (k + 1,) of the smooth intervals of a curve; one interval that is not straight is cut into arcs."""
    count = curve.NbIntervals(GeomAbs_CN)
    t = interval_ends(count, curve.Intervals, GeomAbs_CN)
    return np.linspace(t[0], t[1], _ARCS + 1) if count == 1 and curve.GetType() != GeomAbs_Line else t
