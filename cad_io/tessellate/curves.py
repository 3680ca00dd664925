"""Border curves in a face's parameter plane, evaluated and bounded in compiled code.

Lines, circles, ellipses, B-splines and Bezier curves are exact, and how far they stray from a chord is proved; all others are
replaced by cubics through many of their points, and what stands on them is measured.
"""

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
from OCP.BRepAdaptor import BRepAdaptor_Curve2d
from OCP.GeomAbs import GeomAbs_Line

from cad_io.arrays import Floats
from cad_io.kernel import along, kind_of, may_refuse
from cad_io.surface.bspline import DEGREE, Net, basis, net_bends, span, wrapped
from cad_io.surface.bspline import evaluate as evaluate_net
from cad_io.surface.surface import curve_lines, curve_net
from cad_io.tessellate.bounds import evenly
from plan_cutters_base.jit import entry, kernel, maker

#: Cells along a bent curve, at least; points of a curve that is replaced.
_CELLS, _POINTS = 16, 257
_TRIED = np.array([0.13, 0.37, 0.5, 0.61, 0.89])
_AGREE = 1e-9
#: Knots of a curve across, and along a line.
_UNIT, _KNOTS = np.array([0.0, 1.0]), np.array([0.0, 0.0, 1.0, 1.0])
#: Columns of `Curves.number`: what it is, degree, first knot, first pole, first line, number of lines.
_NET, _CONIC = 0, 1


class Curves(NamedTuple):
    """Curves of a face, packed.

    number (m, 6) int: is it a conic, degree, where its knots, poles and lines begin, how many lines. real (m, 7): period;
    centre and two half axes of a conic. knot, pole (p, 4), line: of all. bend (l, 3): between a line and the next the
    largest second derivative along u and v, and how far the first derivative may jump at the line.
    """

    number: Any
    real: Any
    knot: Any
    pole: Any
    line: Any
    bend: Any


class Workspace(NamedTuple):
    """Room to evaluate in."""

    left: Any
    right: Any
    table: Any
    basis: Any
    found: Any


def packed(curves: Sequence[BRepAdaptor_Curve2d], ranges: Sequence[tuple[float, float]]) -> tuple[Curves, bool]:
    """Curves over ranges of their parameters, and whether all are exact."""
    number, real = np.zeros((len(curves), 6), np.int64), np.zeros((len(curves), 7))
    knot, pole, line, bend = [np.zeros(0)], [np.zeros((0, 4))], [np.zeros(0)], [np.zeros((0, 3))]
    knots, poles, lines, exact = 0, 0, 0, True
    for i, (curve, ends) in enumerate(zip(curves, ranges, strict=True)):
        known = _exact(curve, ends)
        if known is None:
            exact, near = False, _through_points(curve, ends)
            known = None, near, *_bends(near, ends)
        conic, net, mine, bends = known
        number[i] = (conic is not None, 0 if net is None else net.degree_v, knots, poles, lines, len(mine))
        if conic is not None:
            real[i, 1:] = conic
        if net is not None:
            real[i, 0] = net.period_v
            knot.append(net.knot_v)
            pole.append(net.pole[0])
            knots, poles = knots + len(net.knot_v), poles + len(net.pole[0])
        line.append(mine)
        bend.append(bends)
        lines += len(mine)
    # Where a curve's knots end tells the next's beginning.
    number = np.concatenate([number, [[0, 0, knots, poles, lines, 0]]])
    return Curves(number, real, *(np.ascontiguousarray(np.concatenate(each)) for each in (knot, pole, line, bend))), exact


def _exact(curve: BRepAdaptor_Curve2d, ends: tuple[float, float]) -> tuple[Floats | None, Net | None, Floats, Floats] | None:
    """A curve's axes where it is a conic, else its net, lines over its range and how it bends; None where it is neither."""
    if (straight := _straight(curve, ends)) is not None:
        return None, straight, np.array(ends), np.zeros((2, 3))
    c = _conic(curve)
    if c is not None and _agrees(curve, ends, lambda t: c[:2] + np.cos(t)[:, None] * c[2:4] + np.sin(t)[:, None] * c[4:6]):
        return c, None, np.array(ends), np.array([[*np.hypot(c[2:4], c[4:6]), 0.0]] * 2)
    net = None
    with may_refuse():
        net = curve_net(curve)
    if net is not None and _agrees(curve, ends, lambda t: _on_net(net, t)):
        lines, bends = _bends(net, ends)
        return (None, net, lines, bends) if np.isfinite(bends).all() else None
    return None


def _straight(curve: BRepAdaptor_Curve2d, ends: tuple[float, float]) -> Net | None:
    """The net of a line; most borders are lines, and need no more than its ends."""
    if curve.GetType() != GeomAbs_Line:
        return None
    a, b = np.array(curve.Value(0.0).Coord()), np.array(curve.Value(1.0).Coord())
    if not _agrees(curve, ends, lambda t: (1.0 - t)[:, None] * a + t[:, None] * b):
        return None
    pole = np.zeros((1, 2, 4))
    pole[0, 0, :2], pole[0, 1, :2], pole[0, :, 3] = a, b, 1.0
    return Net(_UNIT, _KNOTS, 0, 1, 0.0, 0.0, pole, False)


def _conic(curve: BRepAdaptor_Curve2d) -> Floats | None:
    """Centre and half axes (6,) of a circle or an ellipse."""
    kind = kind_of(curve)
    if kind not in ("Circle", "Ellipse"):
        return None
    conic: Any = getattr(curve, kind)()
    radii = (conic.Radius(), conic.Radius()) if kind == "Circle" else (conic.MajorRadius(), conic.MinorRadius())
    axes = conic.XAxis().Direction(), conic.YAxis().Direction()
    return np.array([*conic.Location().Coord(), *(r * c for r, d in zip(radii, axes, strict=True) for c in d.Coord())])


def _on_net(net: Net, t: Floats) -> Floats:
    out = np.empty((len(t), 1, 3))
    evaluate_net(np.full(len(t), 0.5), np.ascontiguousarray(t), net, out)
    return out[:, 0, :2]


def _agrees(curve: BRepAdaptor_Curve2d, ends: tuple[float, float], ours: Any) -> bool:
    t = ends[0] + _TRIED * (ends[1] - ends[0])
    there = np.array([curve.Value(float(each)).Coord() for each in t])
    return bool((np.abs(ours(t) - there) <= _AGREE * np.abs(there).max(initial=1e-300)).all())


def _through_points(curve: BRepAdaptor_Curve2d, ends: tuple[float, float]) -> Net:
    """Cubics with a curve's points and derivatives."""
    t = np.linspace(*ends, _POINTS)
    point, speed = np.moveaxis(along(curve, t), 1, 0)
    step = (t[1] - t[0]) / 3.0
    pole = np.zeros((1, 2 * _POINTS, 4))
    pole[0, 0::2, :2], pole[0, 1::2, :2] = point - step * speed, point + step * speed
    pole[0, 0, :2], pole[0, -1, :2] = point[0], point[-1]
    pole[..., 3] = 1.0
    knot = np.concatenate([t[:1], t[:1], np.repeat(t, 2), t[-1:], t[-1:]])
    return Net(_UNIT, knot, 0, 3, 0.0, 0.0, pole, False)


def _bends(net: Net, ends: tuple[float, float]) -> tuple[Floats, Floats]:
    """Lines over a range and, between each and the next, `Curves.bend`."""
    knots, jumps = curve_lines(net, ends)
    if net.degree_v == 1 and not net.rational:
        return knots, np.column_stack([np.zeros((len(knots), 2)), jumps])
    line = evenly(knots, np.maximum(1, np.ceil(_CELLS * np.diff(knots) / (ends[1] - ends[0]))).astype(int))
    bends = net_bends(net, _UNIT, line)
    bend = np.zeros((len(line), 3))
    bend[:-1, :2] = np.abs(bends.middle[0, :, 1, :2]) + bends.spread[0, :, 1:2]
    bend[np.searchsorted(line, knots), 2] = jumps
    return line, bend


@maker
def workspace():
    """Room for the kernels."""
    wide = DEGREE + 1
    return Workspace(np.empty(wide), np.empty(wide), np.empty((wide, wide)), np.empty((3, wide)), np.empty(4))


@kernel
def point(curves, i, t, workspace):
    """Parameters (u, v) of the surface on a curve."""
    number, real = curves.number[i], curves.real[i]
    if number[0] == _CONIC:
        c, s = np.cos(t), np.sin(t)
        return real[1] + c * real[3] + s * real[5], real[2] + c * real[4] + s * real[6]
    knot, degree = curves.knot[number[2] : curves.number[i + 1, 2]], number[1]
    t = wrapped(t, knot[degree], real[0])
    low = span(knot, degree, t)
    basis(knot, degree, low, t, 0, workspace.left, workspace.right, workspace.table, workspace.basis)
    first = number[3] + low - degree
    u, v, w = 0.0, 0.0, 0.0
    for k in range(degree + 1):
        share = workspace.basis[0, k]
        u += share * curves.pole[first + k, 0]
        v += share * curves.pole[first + k, 1]
        w += share * curves.pole[first + k, 3]
    return u / w, v / w


@kernel
def strays(curves, i, a, b):
    """How far a curve may be along u and along v, between two parameters, from the chord traversed evenly."""
    first, count = curves.number[i, 4], curves.number[i, 5]
    low, high = min(a, b), max(a, b)
    line = curves.line[first : first + count]
    start, stop = 0, count - 1
    while stop - start > 1:
        middle = (start + stop) // 2
        if low >= line[middle]:
            start = middle
        else:
            stop = middle
    wide = high - low
    u, v, sum_u, sum_v, jumps = 0.0, 0.0, 0.0, 0.0, 0.0
    k = start
    while k < count - 1 and (k == start or line[k] < high):
        row = curves.bend[first + k]
        u, v = max(u, row[0]), max(v, row[1])
        # A second derivative b over a piece at s takes the curve no farther than b ds (high - s) (s - low) / (high - low).
        a, b = low if k == start else line[k], high if k == count - 2 else min(high, line[k + 1])
        s = min(max(0.5 * (low + high), a), b)
        at = (b - a) * (high - s) * (s - low) / wide if wide > 0.0 else 0.0
        sum_u, sum_v = sum_u + row[0] * at, sum_v + row[1] * at
        if low < line[k]:
            jumps += row[2] * (high - line[k]) * (line[k] - low) / wide
        k += 1
    wide *= 0.125 * wide
    return min(u * wide, sum_u) + jumps, min(v * wide, sum_v) + jumps


@entry
def farthest(curves, curve, ends, most):
    """Write how far each curve (m, 2) may be along u and along v from its chords: of curve (k,), -1 for none, `ends` (k, 2)."""
    most[:] = 0.0
    for k in range(len(curve)):
        i = curve[k]
        if i >= 0:
            u, v = strays(curves, i, ends[k, 0], ends[k, 1])
            most[i, 0], most[i, 1] = max(most[i, 0], u), max(most[i, 1], v)


def reach(curves: Curves, uv: Floats, curve: Any, ends: Floats) -> tuple[Floats, Floats]:
    """Corners (2,) of a rectangle that holds the nodes (n, 2) of a mesh and all of its border.

    A curve strays only so far from its chords, and never leaves the hull of its poles.
    """
    low, high = uv.min(axis=0), uv.max(axis=0)
    most = np.zeros((len(curves.number) - 1, 2))
    farthest(curves, curve.ravel(), ends.reshape(-1, 2), most)
    from_, to = low.copy(), high.copy()
    for i, beyond in enumerate(most):
        pole = curves.pole[curves.number[i, 3] : curves.number[i + 1, 3]]
        below, above = low - beyond, high + beyond
        if len(pole) and pole[:, 3].min() > 0:
            point = pole[:, :2] / pole[:, 3:]
            below, above = np.maximum(below, point.min(axis=0)), np.minimum(above, point.max(axis=0))
        from_, to = np.minimum(from_, below), np.maximum(to, above)
    return from_, to
