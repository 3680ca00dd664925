"""A face's surface as a function of its parameters, and bounds of its second derivatives, without calling the kernel.

Planes, quadrics and tori in closed form, B-spline and Bezier surfaces by compiled code; extruded curves are B-spline
surfaces of degree one along their direction, curves turned about an axis are turned after the curve was evaluated.
"""

from collections.abc import Callable
from functools import cached_property
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from OCP.BRepAdaptor import BRepAdaptor_Surface
from OCP.TColgp import TColgp_Array2OfPnt
from OCP.TColStd import TColStd_Array2OfReal
from OCP.TopoDS import TopoDS_Face

from cad_io.arrays import Floats
from cad_io.kernel import domain, first_derivatives, kind_of, may_refuse, periods, second_derivatives, values
from cad_io.surface import elementary
from cad_io.surface.elementary import Bends

if TYPE_CHECKING:
    from cad_io.surface.bspline import Net

#: Takes u, v (n,) and how many of S, Su, Sv, Suu, Svv, Suv are wanted: 1, 3 or 6; gives (n, count, 3).
Evaluator = Callable[[Floats, Floats, int], Floats]

_NONE = np.zeros(0)
#: The jump where a surface may have a gap: farther than any part is large.
_TORN = 1e30


class Form(NamedTuple):
    """A surface that is evaluated here.

    evaluate: values and derivatives. bends: bounds over the cells between lines along u and v, among which all inner `knots`
    must be. knots: lines along u and along v where polynomial pieces end, and jumps: by how much the first derivative across
    each may jump there; both within one period, which is 0 where there is none. degree: of the pieces, 0 where they are none.
    """

    evaluate: Evaluator
    bends: Callable[[Floats, Floats], Bends]
    knots: tuple[Floats, Floats] = (_NONE, _NONE)
    jumps: tuple[Floats, Floats] = (_NONE, _NONE)
    period: tuple[float, float] = (0.0, 0.0)
    degree: tuple[int, int] = (0, 0)


def form_of(adaptor: BRepAdaptor_Surface) -> Form | None:
    """The form of a surface; None for what only the kernel can evaluate."""
    kind = kind_of(adaptor)
    if kind == "Plane":
        frame = elementary.frame_of(adaptor.Plane().Position())
        return Form(lambda u, v, count: elementary.plane(frame, u, v, count), elementary.plane_bends)
    if kind in _PROFILES:
        shape: Any = getattr(adaptor, kind)()
        frame, profile = elementary.frame_of(shape.Position()), _PROFILES[kind](shape)
        return Form(lambda *at: elementary.revolved(frame, profile, *at), lambda u, v: elementary.bends(frame, profile, u, v))
    if kind == "BSplineSurface":
        return _of_net(_bspline(adaptor.BSpline()))
    if kind == "BezierSurface":
        knots = [np.repeat([0.0, 1.0], degree + 1) for degree in (adaptor.UDegree(), adaptor.VDegree())]
        return _of_net(_surface_net(adaptor.Bezier(), knots, (0.0, 0.0)))
    curve = curve_net(adaptor.BasisCurve()) if kind in ("SurfaceOfExtrusion", "SurfaceOfRevolution") else None
    if curve is None:
        return None
    if kind == "SurfaceOfRevolution":
        return _turned(curve, adaptor.AxeOfRevolution())
    return _of_net(_extruded(curve, np.array(adaptor.Direction().Coord())))


#: Profiles of the kernel's shapes about an axis, by their kinds.
_PROFILES: dict[str, Callable[[Any], elementary.Profile]] = {
    "Cylinder": lambda shape: elementary.cylinder(shape.Radius()),
    "Cone": lambda shape: elementary.cone(shape.RefRadius(), shape.SemiAngle()),
    "Sphere": lambda shape: elementary.torus(0.0, shape.Radius()),
    "Torus": lambda shape: elementary.torus(shape.MajorRadius(), shape.MinorRadius()),
}


def _bspline(surface: Any) -> "Net":
    # Poles of a periodic surface are counted round: asked for as one that is not, it has the usual ones.
    turns = periods(surface)
    if surface.IsUPeriodic():
        surface.SetUNotPeriodic()
    if surface.IsVPeriodic():
        surface.SetVNotPeriodic()
    knots = [
        _repeated(surface.UKnot, surface.UMultiplicity, surface.NbUKnots()),
        _repeated(surface.VKnot, surface.VMultiplicity, surface.NbVKnots()),
    ]
    return _surface_net(surface, knots, turns)


def _repeated(knot: Callable[[int], float], multiplicity: Callable[[int], int], count: int) -> Floats:
    numbers = range(1, count + 1)
    return np.repeat([knot(i) for i in numbers], [multiplicity(i) for i in numbers]).astype(float)


def _surface_net(surface: Any, knots: list[Floats], turns: tuple[float, float]) -> "Net":
    # Here, since the compiler takes its time to load and many a part has no such surface.
    from cad_io.surface.bspline import Net

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
    return Net(knots[0], knots[1], surface.UDegree(), surface.VDegree(), *turns, pole, rational)


def curve_net(adaptor: Any) -> "Net | None":
    """A curve (in space, or in a parameter plane) as a net of one row, its parameter along v; None if it is no polynomial."""
    from cad_io.surface.bspline import Net

    kind, period = kind_of(adaptor), 0.0
    if kind == "Line":
        knot, poles, weights = np.array([0.0, 0.0, 1.0, 1.0]), [adaptor.Value(0.0), adaptor.Value(1.0)], None
    elif kind == "BezierCurve":
        curve = adaptor.Bezier()
        knot = np.repeat([0.0, 1.0], curve.Degree() + 1)
        poles, weights = _poles(curve)
    elif kind == "BSplineCurve":
        curve = adaptor.BSpline()
        if curve.IsPeriodic():
            period = curve.LastParameter() - curve.FirstParameter()
            curve.SetNotPeriodic()
        knot = _repeated(curve.Knot, curve.Multiplicity, curve.NbKnots())
        poles, weights = _poles(curve)
    else:
        return None
    pole = np.zeros((1, len(poles), 4))
    points = np.array([p.Coord() for p in poles])
    pole[0, :, : points.shape[1]] = points
    pole[0, :, 3] = 1.0
    if weights is not None:
        pole[0, :, 3] = weights
        pole[0, :, :3] *= pole[0, :, 3:]
    degree = len(knot) - len(poles) - 1
    return Net(np.array([0.0, 1.0]), knot, 0, degree, 0.0, period, pole, weights is not None)


def _poles(curve: Any) -> tuple[list[Any], list[float] | None]:
    numbers = range(1, curve.NbPoles() + 1)
    return [curve.Pole(i) for i in numbers], [curve.Weight(i) for i in numbers] if curve.IsRational() else None


def _of_net(net: "Net") -> Form:
    from cad_io.surface.bspline import evaluate as compiled
    from cad_io.surface.bspline import net_bends

    def evaluate(u: Floats, v: Floats, count: int) -> Floats:
        out = np.empty((len(u), count, 3))
        compiled(u, v, net, out)
        return out

    knots_u, jumps_u = _lines(net.knot_u, net.degree_u, net.pole, net.period_u > 0)
    knots_v, jumps_v = _lines(net.knot_v, net.degree_v, np.swapaxes(net.pole, 0, 1), net.period_v > 0)
    turns, degrees = (net.period_u, net.period_v), (net.degree_u, net.degree_v)
    return Form(evaluate, lambda u, v: net_bends(net, u, v), (knots_u, knots_v), (jumps_u, jumps_v), turns, degrees)


def _lines(knot: Floats, degree: int, pole: Floats, closed: bool) -> tuple[Floats, Floats]:
    """Knots within the range, ends included, and how far the first derivative may jump there, from poles (a, b, 4) along them."""
    value, first, count = np.unique(knot[degree : len(knot) - degree], return_index=True, return_counts=True)
    jump = np.zeros(len(value))
    for k in range(1, len(value) - 1):
        if count[k] > degree > 0:
            jump[k] = _TORN
        elif count[k] == degree:
            row = degree + int(first[k]) - 1
            before, after = (degree / (knot[at + degree] - knot[at]) for at in (row, row + 1))
            jump[k] = _jump(pole[row - 1 : row + 2], before, after)
    if closed:
        ends = degree / (value[-1] - value[-2]), degree / (value[1] - value[0])
        jump[0] = jump[-1] = _jump(np.stack([pole[-2], pole[0], pole[1]]), *ends)
    return value, jump


def _jump(pole: Floats, before: float, after: float) -> float:
    """Bound of the jump of the first derivative at a knot on which the second of three rows (3, b, 4) of poles lies, from the
    factors that make derivatives of differences."""
    at = pole[1]
    jump = after * (pole[2] - at) - before * (at - pole[0])
    weight, point = at[:, 3], at[:, :3] / at[:, 3:]
    # Of a quotient jumps what the poles' jump is more than the weights' jump asks for; were all weights to jump in one
    # ratio, that would be all.
    own = np.linalg.norm(jump[:, :3] - jump[:, 3:] * point, axis=1)
    rest = jump[:, 3] - weight * (jump[:, 3] / weight).mean()
    size = float(np.linalg.norm(np.ptp(point, axis=0)))
    bound = float((own.max() + np.abs(rest).max() * size) / weight.min())
    return bound if weight.min() > 0 and np.isfinite(bound) else _TORN


def lines_within(knots: Floats, jumps: Floats, period: float, ends: tuple[float, float]) -> tuple[Floats, Floats]:
    """Knots within an open range, those of further periods among them, and the jumps at each."""
    if period > 0.0 and len(knots):
        times = np.arange(np.floor((ends[0] - knots[0]) / period) - 1, np.ceil((ends[1] - knots[0]) / period) + 1)
        # The end of a period is the beginning of the next.
        jumps, knots = np.tile(jumps[:-1], len(times)), (knots[:-1] + times[:, None] * period).ravel()
    within = (knots > ends[0]) & (knots < ends[1])
    return knots[within], jumps[within]


def curve_lines(curve: "Net", ends: tuple[float, float]) -> tuple[Floats, Floats]:
    """Knots of a curve over a range, ends included, and how far the first derivative may jump at each."""
    knots, jumps = _lines(curve.knot_v, curve.degree_v, np.swapaxes(curve.pole, 0, 1), curve.period_v > 0)
    knots, jumps = lines_within(knots, jumps, curve.period_v, ends)
    return np.array([ends[0], *knots, ends[1]]), np.array([0.0, *jumps, 0.0])


def _extruded(curve: "Net", direction: Floats) -> "Net":
    along = np.append(direction, 0.0)
    pole = np.stack([curve.pole[0], curve.pole[0] + curve.pole[0, :, 3:] * along], axis=1)
    ends = np.array([0.0, 0.0, 1.0, 1.0])
    return curve._replace(knot_u=curve.knot_v, knot_v=ends, degree_u=curve.degree_v, degree_v=1,
                          period_u=curve.period_v, period_v=0.0, pole=np.ascontiguousarray(pole))  # fmt: skip


def _turned(curve: "Net", axis: Any) -> Form:
    """A curve along v turned by the angle u about an axis."""
    line = _of_net(curve)
    origin, along = np.array(axis.Location().Coord()), np.array(axis.Direction().Coord())

    def turn(vector: Floats, cosine: Floats, sine: Floats) -> Floats:
        height = (vector @ along)[:, None] * along
        return cosine * (vector - height) + sine * np.cross(along, vector) + height

    def evaluate(u: Floats, v: Floats, count: int) -> Floats:
        own = line.evaluate(np.full(len(v), 0.5), v, count)
        cosine, sine = np.cos(u)[:, None], np.sin(u)[:, None]
        out = np.empty_like(own)
        from_axis = own[:, 0] - origin
        out[:, 0] = origin + turn(from_axis, cosine, sine)
        if count > 1:
            out[:, 1] = np.cross(along, out[:, 0] - origin)
            out[:, 2] = turn(own[:, 2], cosine, sine)
        if count > 3:
            out[:, 3] = np.cross(along, out[:, 1])
            out[:, 4] = turn(own[:, 4], cosine, sine)
            out[:, 5] = np.cross(along, out[:, 2])
        return out

    def bends(u: Floats, v: Floats) -> Bends:
        of_line = line.bends(np.array([0.0, 1.0]), v)
        middle = evaluate(np.full(len(v) - 1, 0.5), 0.5 * (v[1:] + v[:-1]), 1)[:, 0] - origin
        reach = np.linalg.norm(np.cross(along, middle), axis=1) + 0.5 * np.diff(v) * of_line.first[0, :, 1]
        speed, bend = of_line.first[0, :, 1], np.linalg.norm(of_line.middle[0, :, 1], axis=1) + of_line.spread[0, :, 1]
        limits = elementary.Limits(reach, speed, bend, 2.0 * of_line.spread[0, :, 1], speed)
        return elementary.turned_bends(evaluate, limits, u, v)

    return Form(evaluate, bends, (_NONE, line.knots[1]), (_NONE, line.jumps[1]), (0.0, line.period[1]), (0, line.degree[1]))


#: Where our evaluators are tried, in shares of the ranges; how far they may be off, in shares of what is found; parameters
#: beyond which an endless range is not looked at.
_TRIED = np.array([[0.13, 0.37, 0.61, 0.89, 0.5], [0.71, 0.23, 0.47, 0.93, 0.05]])
_AGREE, _FAR = 1e-8, 1e3


class Surface:
    """Evaluator of a face's whole surface, not restricted to it, in part coordinates; `adaptor` is the kernel's own."""

    def __init__(self, face: TopoDS_Face) -> None:
        self.adaptor = BRepAdaptor_Surface(face, False)

    @cached_property
    def form(self) -> Form | None:
        """Return the data that evaluate the surface without the kernel; None where only the kernel evaluates it."""
        return _trusted(self.adaptor)

    @cached_property
    def _evaluate(self) -> Evaluator:
        return self.form.evaluate if self.form else _by_kernel(self.adaptor)

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
        return self._evaluate(np.ascontiguousarray(u, float), np.ascontiguousarray(v, float), count)


def _trusted(adaptor: BRepAdaptor_Surface) -> Form | None:
    """Our form where it agrees with the kernel's values at some points: triangles stand on it."""
    ours = None
    with may_refuse():
        ends = domain(adaptor)
        ours = form_of(adaptor)
    if ours is None:
        return None
    u0, u1, v0, v1 = np.clip(ends, -_FAR, _FAR)
    u, v = u0 + _TRIED[0] * (u1 - u0), v0 + _TRIED[1] * (v1 - v0)
    with np.errstate(all="ignore"):
        here, there = ours.evaluate(u, v, 3), _by_kernel(adaptor)(u, v, 3)
        scale = np.abs(there).max(axis=(0, 2), keepdims=True)
        agree = bool((np.abs(here - there) <= _AGREE * scale).all())
    return ours if agree else None


def _by_kernel(adaptor: BRepAdaptor_Surface) -> Evaluator:
    def evaluate(u: Floats, v: Floats, count: int) -> Floats:
        if count == 1:
            return values(adaptor, u, v)[:, None]
        return first_derivatives(adaptor, u, v) if count == 3 else second_derivatives(adaptor, u, v)

    return evaluate
