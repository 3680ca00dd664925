"""A face's surface as a function of its parameters."""

from collections.abc import Callable
from typing import Any

import numpy as np
from OCP.BRepAdaptor import BRepAdaptor_Surface
from OCP.GeomAbs import (
    GeomAbs_BezierSurface,
    GeomAbs_BSplineSurface,
    GeomAbs_Cone,
    GeomAbs_Cylinder,
    GeomAbs_Plane,
    GeomAbs_Sphere,
    GeomAbs_Torus,
)
from OCP.TColgp import TColgp_Array2OfPnt
from OCP.TColStd import TColStd_Array2OfReal
from OCP.TopoDS import TopoDS_Face

from cad_io.arrays import Floats
from cad_io.kernel import first_derivatives, is_kernel_error, second_derivatives, values
from cad_io.surface import elementary

#: Takes u, v (n,) and how many of S, Su, Sv, Suu, Svv, Suv are wanted: 1, 3 or 6; gives (n, count, 3).
Evaluator = Callable[[Floats, Floats, int], Floats]

#: Where our evaluators are tried, in shares of the ranges; how far they may be off, in shares of what is found; parameters
#: beyond which an endless range is not looked at.
_TRIED = np.array([[0.13, 0.37, 0.61, 0.89, 0.5], [0.71, 0.23, 0.47, 0.93, 0.05]])
_AGREE, _FAR = 1e-8, 1e3


class Surface:
    """Evaluator of a face's whole surface (not restricted to the face), in part coordinates.

    Planes, quadrics and tori are evaluated in closed form, B-spline and Bezier surfaces by compiled code, all others by the
    kernel.

    Attributes
    ----------
    adaptor : BRepAdaptor_Surface
        The kernel's own evaluator, the reference.
    """

    __slots__ = ("_evaluate", "adaptor")

    def __init__(self, face: TopoDS_Face) -> None:
        self.adaptor = BRepAdaptor_Surface(face, False)
        self._evaluate: Evaluator | None = None

    def values(self, u: Floats, v: Floats) -> Floats:
        """Points (n, 3), mm, at parameters (n,); nan where there is none."""
        return self._evaluated(u, v, 1)[:, 0]

    def first(self, u: Floats, v: Floats) -> Floats:
        """S, Su, Sv as (n, 3, 3)."""
        return self._evaluated(u, v, 3)

    def second(self, u: Floats, v: Floats) -> Floats:
        """S, Su, Sv, Suu, Svv, Suv as (n, 6, 3)."""
        return self._evaluated(u, v, 6)

    def _evaluated(self, u: Floats, v: Floats, count: int) -> Floats:
        if self._evaluate is None:
            self._evaluate = _trusted(self.adaptor)
        return self._evaluate(np.ascontiguousarray(u, float), np.ascontiguousarray(v, float), count)


def _trusted(adaptor: BRepAdaptor_Surface) -> Evaluator:
    """Our evaluator where it agrees with the kernel's at some points, else the kernel's: triangles stand on it."""
    kernel = _by_kernel(adaptor)
    try:
        ours = evaluator(adaptor)
        ends = (
            adaptor.FirstUParameter(),
            adaptor.LastUParameter(),
            adaptor.FirstVParameter(),
            adaptor.LastVParameter(),
        )
    except Exception as thrown:
        if not is_kernel_error(thrown):
            raise
        return kernel
    u0, u1, v0, v1 = np.clip(ends, -_FAR, _FAR)
    u, v = u0 + _TRIED[0] * (u1 - u0), v0 + _TRIED[1] * (v1 - v0)
    with np.errstate(all="ignore"):
        here, there = ours(u, v, 3), kernel(u, v, 3)
        scale = np.abs(there).max(axis=(0, 2), keepdims=True)
        agree = bool((np.abs(here - there) <= _AGREE * scale).all())
    return ours if agree else kernel


def evaluator(adaptor: BRepAdaptor_Surface) -> Evaluator:
    """Evaluator of a surface: closed form, compiled, or the kernel's."""
    kind = adaptor.GetType()
    if kind == GeomAbs_Plane:
        frame = elementary.frame_of(adaptor.Plane().Position())
        return lambda u, v, count: elementary.plane(frame, u, v, count)
    if kind == GeomAbs_Cylinder:
        found: Any = adaptor.Cylinder()
        return _revolved(found, elementary.cylinder(found.Radius()))
    if kind == GeomAbs_Cone:
        found = adaptor.Cone()
        return _revolved(found, elementary.cone(found.RefRadius(), found.SemiAngle()))
    if kind == GeomAbs_Sphere:
        found = adaptor.Sphere()
        return _revolved(found, elementary.torus(0.0, found.Radius()))
    if kind == GeomAbs_Torus:
        found = adaptor.Torus()
        return _revolved(found, elementary.torus(found.MajorRadius(), found.MinorRadius()))
    if kind == GeomAbs_BSplineSurface:
        return _bspline(adaptor.BSpline())
    if kind == GeomAbs_BezierSurface:
        return _bezier(adaptor.Bezier())
    return _by_kernel(adaptor)


def _by_kernel(adaptor: BRepAdaptor_Surface) -> Evaluator:
    def evaluate(u: Floats, v: Floats, count: int) -> Floats:
        if count == 1:
            return values(adaptor, u, v)[:, None]
        return first_derivatives(adaptor, u, v) if count == 3 else second_derivatives(adaptor, u, v)

    return evaluate


def _revolved(surface: Any, profile: elementary.Profile) -> Evaluator:
    frame = elementary.frame_of(surface.Position())
    return lambda u, v, count: elementary.revolved(frame, profile, u, v, count)


def _bspline(surface: Any) -> Evaluator:
    # Poles of a periodic surface are counted round: asked for as one that is not, it has the usual ones.
    periods = [surface.UPeriod() if surface.IsUPeriodic() else 0.0, surface.VPeriod() if surface.IsVPeriodic() else 0.0]
    if surface.IsUPeriodic():
        surface.SetUNotPeriodic()
    if surface.IsVPeriodic():
        surface.SetVNotPeriodic()
    knots = []
    for knot, multiplicity, count in (
        (surface.UKnot, surface.UMultiplicity, surface.NbUKnots()), (surface.VKnot, surface.VMultiplicity, surface.NbVKnots())
    ):  # fmt: skip
        times = [multiplicity(i) for i in range(1, count + 1)]
        knots.append(np.repeat([knot(i) for i in range(1, count + 1)], times).astype(float))
    return _compiled(surface, knots, periods)


def _bezier(surface: Any) -> Evaluator:
    knots = [np.repeat([0.0, 1.0], degree + 1) for degree in (surface.UDegree(), surface.VDegree())]
    return _compiled(surface, knots, [0.0, 0.0])


def _compiled(surface: Any, knots: list[Floats], periods: list[float]) -> Evaluator:
    # Here, since the compiler takes its time to load and many a part has no such surface.
    from cad_io.surface.bspline import Net
    from cad_io.surface.bspline import evaluate as compiled

    rows, columns = surface.NbUPoles(), surface.NbVPoles()
    points = TColgp_Array2OfPnt(1, rows, 1, columns)
    surface.Poles(points)
    pole = np.ones((rows, columns, 4))
    pole[..., :3] = [[points.Value(i, j).Coord() for j in range(1, columns + 1)] for i in range(1, rows + 1)]
    rational = bool(surface.IsURational() or surface.IsVRational())
    if rational:
        weights = TColStd_Array2OfReal(1, rows, 1, columns)
        surface.Weights(weights)
        pole[..., 3] = [[weights.Value(i, j) for j in range(1, columns + 1)] for i in range(1, rows + 1)]
        pole[..., :3] *= pole[..., 3:]
    net = Net(knots[0], knots[1], surface.UDegree(), surface.VDegree(), periods[0], periods[1], pole, rational)

    def evaluate(u: Floats, v: Floats, count: int) -> Floats:
        out = np.empty((len(u), count, 3))
        compiled(u, v, net, out)
        return out

    return evaluate
