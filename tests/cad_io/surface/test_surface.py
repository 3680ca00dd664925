"""Compiled surfaces against the CAD kernel, face by face, and against laws that no kernel is needed for."""

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeFace, BRepBuilderAPI_Transform
from OCP.Geom import Geom_BezierSurface
from OCP.gp import gp_Ax1, gp_Ax2, gp_Dir, gp_Pnt, gp_Trsf, gp_Vec
from OCP.TColgp import TColgp_Array2OfPnt
from OCP.TColStd import TColStd_Array2OfReal

from cad_io import read_part
from cad_io.face.curvature import PARALLEL, UMBILIC, curvature
from cad_io.kernel import faces, first_derivatives, is_kernel_error, second_derivatives, values
from cad_io.surface import Surface, elementary
from cad_io.surface import surface as compiled
from tests.support import reference
from tests.support.cad_parts import as_nurbs, ball, compound, cone, drilled, patch, real, ring, rod
from tests.support.splines import array, bspline


def assert_as_the_kernel(surface, u, v, tolerance=1e-9):
    """Points to a share of the surface's size, derivatives of their own largest, over these parameters."""
    expected = second_derivatives(surface.adaptor, u, v)
    found = surface.second(u, v)
    size = np.abs(expected[:, 0]).max() + 1e-3
    speed = max(np.abs(expected[:, 1:3]).max(), size)
    assert np.isfinite(found).all()
    assert found[:, 0] == pytest.approx(expected[:, 0], abs=tolerance * size)
    for k in range(1, 6):
        scale = np.abs(expected[:, k]).max() + 1e-3 * speed
        assert found[:, k] == pytest.approx(expected[:, k], abs=10 * tolerance * scale), k
    assert surface.values(u, v) == pytest.approx(values(surface.adaptor, u, v), abs=tolerance * size)
    assert surface.first(u, v) == pytest.approx(first_derivatives(surface.adaptor, u, v), abs=10 * tolerance * speed)


def assert_faces(part, rng, count=40):
    kinds = set()
    for info in part.faces:
        trim = part.trim(info.number)
        if trim is None:
            continue
        u0, u1, v0, v1 = trim.box
        u, v = rng.uniform(u0, u1, count), rng.uniform(v0, v1, count)
        assert_as_the_kernel(part.surface(info.number), u, v)
        kinds.add(info.surface)
    return kinds


def moved(shape, mirrored=False):
    move, mirror = gp_Trsf(), gp_Trsf()
    move.SetRotation(gp_Ax1(gp_Pnt(3, 1, 2), gp_Dir(1, 2, 3)), 0.7)
    move.SetTranslationPart(gp_Vec(5, -3, 11))
    if mirrored:
        mirror.SetMirror(gp_Ax2(gp_Pnt(1, 2, 3), gp_Dir(0, 1, 1)))
        move = mirror.Multiplied(move)
    return BRepBuilderAPI_Transform(shape, move, True).Shape()


@pytest.mark.parametrize("mirrored", [False, True])
def test_quadrics_tori_and_their_nurbs(mirrored):
    shapes = (drilled(), ball(), cone(), ring(), rod(), as_nurbs(ring()), as_nurbs(ball()), patch())
    part = read_part(moved(compound(*shapes), mirrored))
    kinds = assert_faces(part, np.random.default_rng(1))
    assert kinds >= {"plane", "cylinder", "cone", "sphere", "torus", "bspline"}


@pytest.mark.slow("reads or samples a large real file", but=("trimesh",))
@pytest.mark.parametrize(
    "path",
    real("asitus_ANC101-ill.stp", "occt_linkrods.step", "bladex_upper.iges", "tigl_D150_wing.igs", "occt_bearing.iges",
         "trimesh_featuretype.STEP", "brlcad_NIST_MBE_PMI_6.stp"),
    ids=lambda p: p.name,
)  # fmt: skip
def test_faces_of_real_files(path):
    assert assert_faces(read_part(path), np.random.default_rng(2), 25)


@pytest.mark.slow("works on many faces")
@given(
    seed=st.integers(0, 10**6), degrees=st.tuples(st.integers(1, 7), st.integers(1, 7)),
    spans=st.tuples(st.integers(2, 6), st.integers(2, 6)), rational=st.booleans(),
    periodic=st.tuples(st.booleans(), st.booleans()),
)  # fmt: skip
@settings(max_examples=60, deadline=None)
def test_splines_of_any_degree_and_continuity(seed, degrees, spans, rational, periodic):
    rng = np.random.default_rng(seed)
    try:
        face, (knots_u, knots_v) = bspline(rng, degrees, spans, rational, periodic)
    except Exception as error:
        assume(not is_kernel_error(error))  # the kernel cannot make a face of this one
        raise
    u, v = rng.uniform(knots_u[0], knots_u[-1], 80), rng.uniform(knots_v[0], knots_v[-1], 80)
    if periodic[0]:
        u[::3] += (knots_u[-1] - knots_u[0]) * rng.integers(-2, 3, len(u[::3]))
    surface = Surface(face)
    # Near knots the kernel may take the other side.
    away = np.ones(80, bool)
    for knots, t in ((knots_u, u), (knots_v, v)):
        length = knots[-1] - knots[0]
        away &= np.abs(knots[:, None] - ((t - knots[0]) % length + knots[0])).min(axis=0) > 1e-6
    assert away.sum() > 40
    assert_as_the_kernel(surface, u[away], v[away], 1e-8)
    # At knots: points are the same from both sides, and so are derivatives at the very ends.
    corners = np.meshgrid(knots_u, knots_v)
    at = [c.ravel() for c in corners]
    assert surface.values(*at) == pytest.approx(values(surface.adaptor, *at), abs=1e-7 * np.abs(at).max() * 100)


@given(seed=st.integers(0, 10**6), degrees=st.tuples(st.integers(1, 25), st.integers(1, 9)), rational=st.booleans())
@settings(max_examples=25, deadline=None)
def test_bezier_surfaces(seed, degrees, rational):
    rng = np.random.default_rng(seed)
    poles = [degree + 1 for degree in degrees]
    grid = np.stack(np.meshgrid(*map(np.arange, poles), indexing="ij"), -1)
    points = np.concatenate([grid * 3.0, rng.normal(0, 1, (*poles, 1))], -1)
    weights = rng.uniform(0.5, 2.0, poles) if rational else np.ones(poles)
    more = [array(TColStd_Array2OfReal, weights, 2)] if rational else []
    face = BRepBuilderAPI_MakeFace(Geom_BezierSurface(array(TColgp_Array2OfPnt, points, 3), *more), 1e-6).Face()
    surface, (u, v) = Surface(face), rng.uniform(0, 1, (2, 30))
    if max(degrees) <= 10:  # beyond, the kernel's powers lose digits
        assert_as_the_kernel(surface, u, v, 1e-8)
    # The same by cutting between poles, which loses none. The kernel may have lost so many that ours is not trusted.
    ours = compiled.form_of(surface.adaptor).evaluate(u, v, 1)[:, 0]
    net = np.concatenate([points * weights[..., None], weights[..., None]], -1)
    for a, b, found in zip(u, v, ours, strict=True):
        rows = net
        for share in (a, b):
            while len(rows) > 1:
                rows = (1 - share) * rows[:-1] + share * rows[1:]
            rows = rows[0]
        assert found == pytest.approx(rows[:3] / rows[3], abs=1e-10)


def test_derivatives_are_those_of_the_values():
    """No kernel: central differences."""
    rng = np.random.default_rng(5)
    for shape in (ring(), as_nurbs(ring()), cone(), patch()):
        surface = Surface(faces(shape)[0])
        u, v, h = rng.uniform(0.2, 0.8, 20), rng.uniform(0.2, 0.8, 20), 1e-5
        d = surface.second(u, v)
        for k, (a, b) in ((1, (h, 0)), (2, (0, h))):
            slope = (surface.values(u + a, v + b) - surface.values(u - a, v - b)) / (2 * h)
            assert slope == pytest.approx(d[:, k], rel=1e-6, abs=1e-4)
        bend = (surface.first(u + h, v) - surface.first(u - h, v)) / (2 * h)
        assert bend[:, 1] == pytest.approx(d[:, 3], rel=1e-5, abs=1e-3)
        assert bend[:, 2] == pytest.approx(d[:, 5], rel=1e-5, abs=1e-3)


def test_an_evaluator_that_disagrees_with_the_kernel_is_not_used(monkeypatch):
    face = faces(rod())[0]
    u, v = np.linspace(0, 6, 9), np.linspace(0, 1, 9)
    expected = Surface(face).second(u, v)
    real, tried = elementary.cylinder, []
    monkeypatch.setattr(elementary, "cylinder", lambda radius: tried.append(1) or real(radius * (1 + 1e-6)))
    assert Surface(face).second(u, v) == pytest.approx(expected, abs=1e-9)
    assert tried == [1]


def test_what_is_no_parameter_is_no_point():
    for shape in (ball(), as_nurbs(ball()), patch()):
        surface = Surface(faces(shape)[0])
        bad = np.array([np.nan, np.inf, 0.5])
        with np.errstate(invalid="ignore"):
            found = surface.second(bad, np.array([0.5, 0.5, np.nan]))
        assert np.isnan(found[:, 0]).any(axis=1).all()
        assert surface.second(np.zeros(0), np.zeros(0)).shape == (0, 6, 3)


@given(seed=st.integers(0, 10**6), sign=st.sampled_from([1.0, -1.0]), size=st.sampled_from([np.inf, 50.0]))
@settings(max_examples=40, deadline=None)
def test_curvature_is_that_of_the_formulas(seed, sign, size):
    rng = np.random.default_rng(seed)
    d = rng.normal(0, 1, (200, 6, 3)) * 10.0 ** rng.integers(-3, 4, (200, 6, 1))
    d[:5, 2] = 2 * d[:5, 1]  # parallel tangents
    d[5:10, 3:] = 0.0  # flat
    d[10:15, 1:] = [[1, 0, 0], [0, 1, 0], [0, 0, 0.2], [0, 0, 0.2], [0, 0, 0]]  # umbilics
    for row, k in zip(range(15, 33), np.ndindex(6, 3), strict=True):
        d[row][k] = (np.nan, np.inf, -np.inf)[row % 3]
    normal, kappa, direction, bad = reference.curvature(d, sign, size, PARALLEL, UMBILIC)
    found = curvature(d, sign, size)
    assert (found.bad == bad).all()
    assert bad.sum() > 20
    assert (~bad).sum() > 150
    scale = np.abs(kappa[~bad]).max(axis=1, keepdims=True) + 1e-12
    assert found.normal[~bad] == pytest.approx(normal[~bad], abs=1e-12)
    assert found.curvature[~bad] / scale == pytest.approx(kappa[~bad] / scale, abs=1e-9)
    clear = ~bad & (kappa[:, 0] - kappa[:, 1] > 1e-5 * np.abs(kappa).max(axis=1))
    across = np.linalg.norm(np.cross(found.direction_max[clear], direction[clear]), axis=1)
    assert across.max() < 1e-6
    assert found.direction_max[5:15] == pytest.approx(direction[5:15])
    for column in (found.normal, found.curvature, found.direction_max):
        assert np.isnan(column[bad]).all()
