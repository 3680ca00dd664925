"""Bounds of what lies between points: how surfaces bend over cells, and how far triangles may be from them."""

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from OCP.BRep import BRep_Tool
from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeFace
from OCP.Geom import Geom_BSplineSurface, Geom_OffsetSurface
from OCP.Geom2d import Geom2d_BSplineCurve
from OCP.Geom2dAdaptor import Geom2dAdaptor_Curve
from OCP.gp import gp_Pnt2d
from OCP.TColgp import TColgp_Array1OfPnt2d, TColgp_Array2OfPnt
from OCP.TColStd import TColStd_Array1OfInteger, TColStd_Array1OfReal

from cad_io import read_part
from cad_io.kernel import faces, is_kernel_error
from cad_io.surface import Surface
from cad_io.tessellate import tessellate
from cad_io.tessellate.bounds import FINE, Ground, bend, most_inside, table_of, twist_share, window
from cad_io.tessellate.curves import packed, point, strays, workspace
from tests.support.cad_parts import as_nurbs, ball, compound, cone, drilled, extruded_arc, patch, real, revolved_wave, ring, rod
from tests.support.distances import farthest_from
from tests.support.splines import array, bspline

#: Points of a triangle, in shares of its corners.
DENSE = np.array([(a, b, 24 - a - b) for a in range(25) for b in range(25 - a)]) / 24


def bent_by(form, u, v, at_u, at_v):
    """Over random cells: derivatives at random points, and the bends of their cells."""
    bends = form.bends(u, v)
    i = np.clip(np.searchsorted(u, at_u) - 1, 0, len(u) - 2)
    j = np.clip(np.searchsorted(v, at_v) - 1, 0, len(v) - 2)
    d = form.evaluate(at_u, at_v, 6)
    return d, bends.middle[i, j], bends.spread[i, j], bends.first[i, j]


def lines(form, axis, ends, count):
    """Lines at all knots and some more."""
    knots, period = form.knots[axis], form.period[axis]
    if period and len(knots):
        knots = np.unique(np.concatenate([knots + k * period for k in range(-3, 4)]))
    inner = [k for k in knots if ends[0] < k < ends[1]]
    plain = [t for t in np.linspace(*ends, count)[1:-1] if not inner or np.abs(np.array(inner) - t).min() > 1e-6]
    return np.unique([*ends, *inner, *plain])


def assert_bends(form, box, rng, cells=7):
    u, v = lines(form, 0, box[:2], cells), lines(form, 1, box[2:], cells)
    d, middle, spread, first = bent_by(form, u, v, rng.uniform(*box[:2], 400), rng.uniform(*box[2:], 400))
    scale = np.abs(d[:, 3:]).max() + np.abs(d[:, 1:3]).max() + 1e-12
    off = np.linalg.norm(d[:, 3:] - middle, axis=2)
    assert (off <= spread + 1e-9 * scale).all()
    assert (np.linalg.norm(d[:, 1:3], axis=2) <= first + 1e-9 * scale).all()
    return off, spread


@pytest.mark.parametrize("make", [rod, cone, ball, ring, drilled, patch, extruded_arc, revolved_wave,
                                  lambda: as_nurbs(ring()), lambda: as_nurbs(ball()), lambda: as_nurbs(cone())])  # fmt: skip
def test_no_surface_bends_more_than_said(make):
    rng = np.random.default_rng(7)
    tried = 0
    for face in faces(make()):
        surface = Surface(face)
        ends = [surface.adaptor.FirstUParameter(), surface.adaptor.LastUParameter(),
                surface.adaptor.FirstVParameter(), surface.adaptor.LastVParameter()]  # fmt: skip
        assert surface.form is not None
        assert_bends(surface.form, np.clip(ends, -50, 50), rng)
        tried += 1
    assert tried


@given(
    seed=st.integers(0, 10**6), degrees=st.tuples(st.integers(1, 7), st.integers(1, 7)),
    spans=st.tuples(st.integers(1, 5), st.integers(1, 5)), rational=st.booleans(),
    periodic=st.tuples(st.booleans(), st.booleans()),
)  # fmt: skip
@settings(max_examples=60, deadline=None)
def test_no_spline_bends_more_than_said(seed, degrees, spans, rational, periodic):
    rng = np.random.default_rng(seed)
    try:
        face, (knots_u, knots_v) = bspline(rng, degrees, spans, rational, periodic)
    except Exception as error:
        assume(not is_kernel_error(error))
        raise
    form = Surface(face).form
    assume(form is not None)
    wide = [0.4 * (k[-1] - k[0]) if round_ else 0.0 for k, round_ in zip((knots_u, knots_v), periodic, strict=True)]
    box = (knots_u[0] - wide[0], knots_u[-1] + wide[0], knots_v[0] - wide[1], knots_v[-1] + wide[1])
    assert_bends(form, box, rng)


def test_bounds_close_in_as_cells_shrink():
    """By half with the cells: they would be of no use if they stayed wide. Quotients among them."""
    for shape in (as_nurbs(ball()), as_nurbs(ring()), patch(), revolved_wave()):
        form = Surface(faces(shape)[0]).form
        adaptor = Surface(faces(shape)[0]).adaptor
        box = (adaptor.FirstUParameter(), adaptor.LastUParameter(), adaptor.FirstVParameter(), adaptor.LastVParameter())
        rng = np.random.default_rng(3)
        wide = [np.median(assert_bends(form, box, rng, cells)[1].max(axis=1)) for cells in (40, 80)]
        assert 0 < wide[1] < 0.6 * wide[0]


def farthest_found(surface, corners):
    """Largest distance of dense points of a triangle from the surface's, at the same parameters."""
    uv = DENSE @ corners
    point = surface.values(corners[:, 0].copy(), corners[:, 1].copy())
    return np.linalg.norm(surface.values(uv[:, 0].copy(), uv[:, 1].copy()) - DENSE @ point, axis=1).max()


def bound_of(table, corners):
    """The bound of one triangle, jumps left out: none may lie on it."""
    (u0, v0), (u1, v1) = corners.min(axis=0), corners.max(axis=0)
    row = table.node[window(table, u0, u1, v0, v1)]
    steps = np.roll(corners, -1, axis=0) - corners
    return most_inside(*(bend(row, twist_share(u1 - u0, v1 - v0), *step) for step in steps))


@given(seed=st.integers(0, 10**6), degrees=st.tuples(st.integers(2, 5), st.integers(2, 5)), rational=st.booleans())
@settings(max_examples=40, deadline=None)
def test_no_triangle_is_farther_than_its_bound(seed, degrees, rational):
    rng = np.random.default_rng(seed)
    face, (knots_u, knots_v) = bspline(rng, degrees, (3, 2), rational)
    surface = Surface(face)
    box = (knots_u[0], knots_u[-1], knots_v[0], knots_v[-1])
    table, proved = table_of(Ground.of(surface, box))
    assert proved
    tried = 0
    for size in (1.0, 0.3, 0.1, 0.03):
        for _ in range(12):
            middle = rng.uniform((box[0], box[2]), (box[1], box[3]))
            reach = size * np.array([box[1] - box[0], box[3] - box[2]])
            corners = np.clip(middle + rng.uniform(-0.5, 0.5, (3, 2)) * reach, (box[0], box[2]), (box[1], box[3]))
            (u0, v0), (u1, v1) = corners.min(axis=0), corners.max(axis=0)
            if any(a < line < b for kinks, a, b in ((table.kink_u, u0, u1), (table.kink_v, v0, v1)) for line in kinks[:, 0]):
                continue
            tried += 1
            assert farthest_found(surface, corners) <= bound_of(table, corners) * (1 + 1e-9) + 1e-12
    assume(tried)


@given(seed=st.integers(0, 10**6), degrees=st.tuples(st.integers(1, 6), st.integers(1, 6)), rational=st.booleans())
@settings(max_examples=30, deadline=None)
def test_no_two_points_are_farther_apart_than_lines_between_them_are_long(seed, degrees, rational):
    """Kinks are no gaps: lines run through them."""
    rng = np.random.default_rng(seed)
    face, (knots_u, knots_v) = bspline(rng, degrees, (3, 2), rational)
    surface = Surface(face)
    low, high = np.array([knots_u[0], knots_v[0]]), np.array([knots_u[-1], knots_v[-1]])
    for chord in (np.inf, 1e-3):
        table, proved = table_of(Ground.of(surface, (low[0], high[0], low[1], high[1]), chord))
        assert proved
        for size in (1.0, 0.2, 0.02):
            ends = np.sort(rng.uniform(low, high - (high - low) * (1.0 - size), (2, 2)), axis=0)
            row = table.node[window(table, ends[0, 0], ends[1, 0], ends[0, 1], ends[1, 1])]
            at = rng.uniform(ends[0], ends[1], (60, 2))
            point = surface.values(at[:, 0].copy(), at[:, 1].copy())
            apart = np.linalg.norm(point[:, None] - point[None], axis=2).max()
            assert apart <= (row[14] + row[15]) * (1 + 1e-9) + 1e-12
            # Nor is a first derivative there longer than the window says, or a second one farther from its middle.
            derivative = surface.form.evaluate(at[:, 0].copy(), at[:, 1].copy(), 6)
            assert (np.linalg.norm(derivative[:, 1:3], axis=2) <= row[12:14] * (1 + 1e-9) + 1e-9).all()
            off = np.linalg.norm(derivative[:, 3:] - row[:9].reshape(3, 3), axis=2)
            assert (off <= row[9:12] * (1 + 1e-9) + 1e-9 * np.abs(derivative).max()).all()


@pytest.mark.parametrize("ends", [(2.0, 20.0), (20.0, 2.0)])
@pytest.mark.parametrize("axis", [0, 1])
def test_lines_over_many_cells_are_as_long_as_the_longest_of_them(axis, ends):
    """Of a flat trapezoid, whose lines one way are as long as the ends at its ends: over any range of parameters."""
    pole = np.zeros((2, 2, 3))
    pole[1, :, 0] = 10.0
    pole[0, 1, 1], pole[1, 1, 1] = ends
    knots, times = array(TColStd_Array1OfReal, [0.0, 50.0]), array(TColStd_Array1OfInteger, [2, 2])
    surface = Geom_BSplineSurface(
        array(TColgp_Array2OfPnt, pole if axis else pole.swapaxes(0, 1), 3), knots, knots, times, times, 1, 1
    )
    table, _ = table_of(Ground.of(Surface(BRepBuilderAPI_MakeFace(surface, 1e-6).Face()), (0.0, 50.0, 0.0, 50.0)), FINE)
    assert len(table.u) == len(table.v) > 60
    long = table.node[window(table, 0.0, 50.0, 0.0, 50.0)][14:]
    true = np.array([20.0, np.hypot(10.0, 18.0)] if axis == 0 else [np.hypot(10.0, 18.0), 20.0])
    assert (long >= true * (1 - 1e-12)).all()
    assert long == pytest.approx(true, rel=0.01)


def test_bounds_of_small_triangles_are_near_what_is_measured():
    """Within a factor of two: else triangles would be laid where none is needed."""
    for shape in (ring(), as_nurbs(ring()), patch(), revolved_wave(), as_nurbs(ball())):
        surface = Surface(faces(shape)[0])
        adaptor = surface.adaptor
        box = (adaptor.FirstUParameter(), adaptor.LastUParameter(), adaptor.FirstVParameter(), adaptor.LastVParameter())
        table, _ = table_of(Ground.of(surface, box), FINE)
        rng = np.random.default_rng(5)
        low, wide = np.array(box[::2]), np.array(box[1::2]) - box[::2]
        ratio = []
        for _ in range(60):
            corners = low + wide * (rng.uniform(0.1, 0.9, 2) + np.array([(0, 0), (0.01, 0), (0, 0.01)]))
            ratio.append(bound_of(table, corners) / max(farthest_found(surface, corners), 1e-15))
        assert 1.0 <= np.median(ratio) < 1.5


@pytest.mark.parametrize("degrees", [(1, 1), (2, 1), (3, 2)])
def test_kinks_are_bounded_too(degrees):
    """Surfaces with first derivatives that jump: all triangles as near as said, and not too many."""
    rng = np.random.default_rng(11)
    face, _ = bspline(rng, degrees, (4, 3), False)
    part = read_part(face)
    surface = part.surface(1)
    form = surface.form
    assert any((jumps > 1e-3).any() for jumps in form.jumps)
    found = tessellate(part, 0.01)
    assert not found.missing
    assert not found.measured
    assert found.chord_error <= 0.01
    # Dense points of the surface against the triangles.
    u = rng.uniform(form.knots[0][0], form.knots[0][-1], 400)
    v = rng.uniform(form.knots[1][0], form.knots[1][-1], 400)
    assert farthest_from(surface.values(u, v), found.vertex, 0.01 + 1e-9) <= 0.01 + 1e-9
    if degrees == (1, 1):
        assert len(found) < 5000


def spline_2d(rng, degree, spans, rational):
    knots = np.cumsum(rng.uniform(0.2, 2.0, spans + 1))
    times = [degree + 1, *rng.integers(1, degree + 1, spans - 1).tolist(), degree + 1]
    count = sum(times) - degree - 1
    pole = TColgp_Array1OfPnt2d(1, count)
    for i in range(count):
        pole.SetValue(i + 1, gp_Pnt2d(float(i), float(rng.normal())))
    more = [array(TColStd_Array1OfReal, rng.uniform(0.3, 3.0, count).tolist())] if rational else []
    curve = Geom2d_BSplineCurve(
        pole, *more, array(TColStd_Array1OfReal, knots.tolist()), array(TColStd_Array1OfInteger, times), degree
    )
    return Geom2dAdaptor_Curve(curve), knots


@given(seed=st.integers(0, 10**6), degree=st.integers(1, 6), spans=st.integers(1, 5), rational=st.booleans())
@settings(max_examples=60, deadline=None)
def test_no_border_strays_farther_than_said(seed, degree, spans, rational):
    rng = np.random.default_rng(seed)
    curve, knots = spline_2d(rng, degree, spans, rational)
    curves, exact = packed([curve], [(knots[0], knots[-1])])
    assert exact
    spare, share = workspace(), np.linspace(0, 1, 60)
    for _ in range(8):
        a, b = rng.uniform(knots[0], knots[-1], 2)
        ends = np.array([curve.Value(a).Coord(), curve.Value(b).Coord()])
        assert np.array([point(curves, 0, a, spare), point(curves, 0, b, spare)]) == pytest.approx(ends, abs=1e-9)
        true = np.array([curve.Value(a + s * (b - a)).Coord() for s in share])
        off = np.abs(true - ends[0] - share[:, None] * (ends[1] - ends[0])).max(axis=0)
        assert (off <= np.array(strays(curves, 0, a, b)) * (1 + 1e-9) + 1e-9).all()


@pytest.mark.parametrize(("degree", "middle"), [(1, 0.5), (1, 0.3), (2, None)])
def test_how_far_a_border_with_one_kink_or_one_bend_strays_is_exact(degree, middle):
    """From the chord over all of it: as a corner of a triangle, or a parabola. A kink is known by its size alone."""
    pole = array(TColgp_Array1OfPnt2d, [gp_Pnt2d(0.0, 0.0), gp_Pnt2d(5.0, 2.0), gp_Pnt2d(8.0, -1.0)])
    knots, times = ([0.0, middle, 1.0], [2, 1, 2]) if degree == 1 else ([0.0, 1.0], [3, 3])
    curve = Geom2d_BSplineCurve(pole, array(TColStd_Array1OfReal, knots), array(TColStd_Array1OfInteger, times), degree)
    curves, exact = packed([Geom2dAdaptor_Curve(curve)], [(0.0, 1.0)])
    assert exact
    t = np.linspace(0.0, 1.0, 1001)
    off = np.abs(np.array([curve.Value(each).Coord() for each in t]) - t[:, None] * (8.0, -1.0))
    if degree == 1:
        off = np.hypot(*off.T)[:, None].repeat(2, axis=1)
    assert np.array(strays(curves, 0, 0.0, 1.0)) == pytest.approx(off.max(axis=0), rel=1e-9)
    assert strays(curves, 0, 1.0, 0.0) == strays(curves, 0, 0.0, 1.0)


def test_a_narrow_ridge_is_seen():
    """A ridge 4 mm wide on a patch 1 m long, between all points that a coarse start would look at."""
    part = read_part(ridged(1000.0, 4.0, 0.27))
    found = tessellate(part, 0.02)
    heights = found.vertex[..., 2]
    assert found.chord_error <= 0.02
    assert heights.max() > 0.25


def ridged(length, width, height):
    """A flat bicubic patch with a ridge across it at 0.37 of its length."""
    at = 0.37 * length
    inner = [at - width / 2, at - width / 4, at, at + width / 4, at + width / 2]
    knots = np.array([0.0, *inner, length])
    greville = np.convolve(np.repeat(knots, [4, 1, 1, 1, 1, 1, 4])[1:-1], np.ones(3) / 3, mode="valid")
    pole = np.zeros((len(greville), 4, 3))
    pole[..., 0], pole[..., 1] = greville[:, None], np.linspace(0, 50, 4)
    pole[np.abs(greville - at) < 1e-9, :, 2] = 1.5 * height
    surface = Geom_BSplineSurface(
        array(TColgp_Array2OfPnt, pole, 3), array(TColStd_Array1OfReal, knots.tolist()),
        array(TColStd_Array1OfReal, [0.0, 1.0]), array(TColStd_Array1OfInteger, [4, 1, 1, 1, 1, 1, 4]),
        array(TColStd_Array1OfInteger, [4, 4]), 3, 3,
    )  # fmt: skip
    return BRepBuilderAPI_MakeFace(surface, 1e-6).Face()


def test_what_only_the_kernel_evaluates_is_measured_and_said():
    base = faces(patch())[0]
    face = BRepBuilderAPI_MakeFace(Geom_OffsetSurface(BRep_Tool.Surface_s(base), 1.5), 1e-6).Face()
    part = read_part(compound(face, rod(at=(0, 0, 100))))
    assert part.surface(1).form is None
    found = tessellate(part, 0.02)
    assert found.measured == (1,)
    assert found.chord_error <= 0.02
    rows = found.vertex[found.face == 1]
    assert len(rows) > 100


@pytest.mark.parametrize(("apart", "proved"), [(1e-3, True), (1e-11, False)])
def test_what_hides_between_knots_that_are_nearly_one_is_measured(apart, proved):
    """Within so little the first derivative may turn round: no bound of the pieces beside it tells."""
    knots = np.array([0.0, 4.0, 4.0 + apart, 10.0])
    pole = np.zeros((6, 2, 3))
    pole[..., 0], pole[..., 1] = np.array([0, 1.5, 4, 4, 7, 10.0])[:, None], np.array([0.0, 20.0])
    pole[2:4, :, 2] = 3.0
    surface = Geom_BSplineSurface(
        array(TColgp_Array2OfPnt, pole, 3), array(TColStd_Array1OfReal, knots.tolist()),
        array(TColStd_Array1OfReal, [0.0, 1.0]), array(TColStd_Array1OfInteger, [4, 1, 1, 4]),
        array(TColStd_Array1OfInteger, [2, 2]), 3, 1,
    )  # fmt: skip
    part = read_part(BRepBuilderAPI_MakeFace(surface, 1e-6).Face())
    found = tessellate(part, 0.01)
    assert (found.measured == ()) == proved
    assert found.chord_error <= 0.01
    u, v = np.random.default_rng(2).uniform(0, 1, (2, 300))
    u[:100] = 0.4 + 0.01 * (u[:100] - 0.5)
    assert farthest_from(part.surface(1).values(10 * u, v), found.vertex, 0.01 + 1e-9) <= 0.01 + 1e-9


@pytest.mark.slow("another file of the same law", only=("asitus",))
@pytest.mark.parametrize("path", real("occt_linkrods.step", "asitus_ANC101-ill.stp"), ids=lambda p: p.name)
def test_real_files_are_proved(path):
    part = read_part(path)
    found = tessellate(part, 1e-4 * float(np.linalg.norm(part.size)))
    assert found.measured == ()


def test_where_the_budget_binds_the_error_grows():
    part = read_part(ring())
    few, many = (tessellate(part, 1e-3, budget=budget) for budget in (20_000, 10**6))
    assert len(few) <= 20_000 < len(many)
    assert many.chord_error <= 1e-3 < few.chord_error
    # Twice as near takes about twice as many.
    assert few.chord_error / many.chord_error == pytest.approx(len(many) / len(few), rel=0.25)
