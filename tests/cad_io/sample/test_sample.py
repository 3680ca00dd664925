"""Samples: closed forms, the kernel's own curvature, counts, seams, poles, trims, joints, areas."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from OCP.BRep import BRep_Builder, BRep_Tool
from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeFace, BRepBuilderAPI_MakePolygon, BRepBuilderAPI_Transform
from OCP.BRepFilletAPI import BRepFilletAPI_MakeFillet
from OCP.BRepLProp import BRepLProp_SLProps
from OCP.BRepTopAdaptor import BRepTopAdaptor_FClass2d
from OCP.Geom import Geom_BezierSurface
from OCP.gp import gp_Dir, gp_Pnt, gp_Pnt2d, gp_Trsf
from OCP.TColgp import TColgp_Array2OfPnt
from OCP.TopAbs import TopAbs_EDGE, TopAbs_OUT
from OCP.TopExp import TopExp_Explorer
from OCP.TopLoc import TopLoc_Location
from OCP.TopoDS import TopoDS

from cad_io import read_part
from cad_io.errors import SampleError
from cad_io.face.curvature import curvature
from cad_io.kernel import second_derivatives
from cad_io.part.bodies import orient
from cad_io.sample.on_grids import locate, sample
from tests.support.cad_parts import (
    as_nurbs,
    ball,
    box,
    compound,
    cone,
    cut,
    drilled,
    holed_patch,
    mirror,
    moved,
    patch,
    pocketed,
    real,
    ring,
    rod,
)


def sampled(shape, faces=None, **how):
    part = read_part(shape)
    numbers = [f.number for f in part.faces] if faces is None else faces
    return part, sample(part, orient(part), faces=numbers, **how)


def of_shape(part, samples, shape):
    """Rows of samples on faces of one shape."""
    return np.isin(samples.face, [f.number for f in part.faces if f.shape == shape])


def assert_sound(part, samples):
    """What holds of every sampling."""
    good = samples.unjudged < 0
    n, e, k = samples.normal[good], samples.direction_max[good], samples.curvature[good]
    assert np.linalg.norm(n, axis=1) == pytest.approx(1)
    assert np.linalg.norm(e, axis=1) == pytest.approx(1)
    assert np.abs((n * e).sum(axis=1)).max(initial=0) < 1e-9
    assert (k[:, 0] >= k[:, 1]).all()
    assert np.isnan(samples.normal[~good]).all()
    assert (samples.area >= 0).all()
    for number in np.unique(samples.face).tolist():
        assert samples.area[samples.face == number].sum() == pytest.approx(part.faces[number - 1].area, rel=1e-9)
    assert samples.neighbours.min(initial=0) >= 0
    assert samples.neighbours.max(initial=0) < len(samples)
    assert (samples.neighbours[:, 0] != samples.neighbours[:, 1]).all()
    for grid in samples.grids:
        i, j = np.nonzero(grid.index >= 0)
        rows = grid.index[i, j]
        assert (samples.face[rows] == grid.face).all()
        assert (samples.uv[rows] == np.stack([grid.u[i], grid.v[j]], axis=1)).all()
        assert (np.diff(grid.u) > 0).all()
        assert (np.diff(grid.v) > 0).all()


# --- closed forms ----------------------------------------------------------------------------------------------------

HOW = [{"grid": 12}, {"spacing": 1.5}]


@pytest.mark.parametrize("how", [pytest.param(HOW[0], marks=pytest.mark.slow("samples each shape once more"), id="grid"),
                                 pytest.param(HOW[1], id="spacing")])  # fmt: skip
@pytest.mark.parametrize("place", [None, moved(), mirror()], ids=["here", "moved", "mirrored"])
@pytest.mark.parametrize("convert", [lambda s: s, as_nurbs], ids=["as made", "as B-splines"])
@pytest.mark.parametrize(
    ("shape", "kind", "expected"),
    [
        (ball(10), "sphere", (-0.1, -0.1)),
        (pocketed(5), "sphere", (0.2, 0.2)),
        (rod(5), "cylinder", (0.0, -0.2)),
        (drilled(3), "cylinder", (1 / 3, 0.0)),
        (box(), "plane", (0.0, 0.0)),
    ],
    ids=["ball", "pocket", "rod", "hole", "plane"],
)
def test_constant_curvature(shape, kind, expected, convert, place, how):
    shape = convert(shape)
    if place is not None:
        shape = shape.Moved(TopLoc_Location(place))
    part, samples = sampled(shape, **how)
    assert_sound(part, samples)
    rows = of_shape(part, samples, kind) & (samples.unjudged < 0)
    assert rows.any()
    # Beside the pole of a sphere written as a B-spline the tangents shrink to nothing and rounding grows.
    assert np.abs(samples.curvature[rows] - expected).max() < 1e-6
    assert np.median(np.abs(samples.curvature[rows] - expected)) < 1e-12


def test_normals_point_out_of_the_material():
    part, samples = sampled(ball(10), spacing=2.0)
    assert samples.normal == pytest.approx(samples.point / 10, abs=1e-12)
    part, samples = sampled(pocketed(5), spacing=1.0)
    rows = of_shape(part, samples, "sphere")
    assert samples.normal[rows] == pytest.approx(((10, 10, 10) - samples.point[rows]) / 5, abs=1e-12)


def test_torus_and_cone():
    part, samples = sampled(ring(20, 5), grid=24)
    rho = np.hypot(samples.point[:, 0], samples.point[:, 1])
    other = -(rho - 20) / 5 / rho
    expected = np.sort(np.stack([other, np.full(len(rho), -0.2)], axis=1), axis=1)[:, ::-1]
    assert samples.curvature == pytest.approx(expected, abs=1e-12)
    # The larger is the one along the big circle, wherever it is.
    along = np.stack([-samples.point[:, 1], samples.point[:, 0], 0 * rho], axis=1) / rho[:, None]
    assert np.abs((samples.direction_max * along).sum(axis=1)) == pytest.approx(1)
    part, samples = sampled(cone(8, 4, 10), grid=9)
    rows = of_shape(part, samples, "cone")
    rho = np.hypot(samples.point[rows, 0], samples.point[rows, 1])
    cosine = 10 / np.hypot(10, 4)
    assert samples.curvature[rows] == pytest.approx(np.stack([0 * rho, -cosine / rho], axis=1), abs=1e-12)


def test_curvature_at_umbilics_takes_the_kernels_u_tangent():
    part, samples = sampled(box(), grid=5)
    for row in range(len(samples)):
        d = second_derivatives(part.adaptor(int(samples.face[row])), samples.uv[[row], 0], samples.uv[[row], 1])[0]
        assert samples.direction_max[row] == pytest.approx(d[1] / np.linalg.norm(d[1]))


# --- the kernel as reference -----------------------------------------------------------------------------------------


def reference(part, samples, orientation):
    """Normals, curvatures, directions from the kernel's local properties, turned to this program's signs."""
    normal, kappa, direction = [], [], []
    for row in range(len(samples)):
        number = int(samples.face[row])
        properties = BRepLProp_SLProps(part.adaptor(number), *samples.uv[row].tolist(), 2, 1e-9)
        sign = orientation.sign[number - 1]
        most, least, n = gp_Dir(), gp_Dir(), properties.Normal()
        properties.CurvatureDirections(most, least)
        pair = (properties.MaxCurvature(), properties.MinCurvature())
        if sign < 0:
            pair, most = (-pair[1], -pair[0]), least
        normal.append(sign * np.array(n.Coord()))
        kappa.append(pair)
        direction.append(most.Coord())
    return np.array(normal), np.array(kappa), np.array(direction)


@pytest.mark.slow("another side of the same law", only=("forward",))
@pytest.mark.parametrize("turned", [False, True], ids=["forward", "reversed"])
@settings(max_examples=8, deadline=None)
@given(seed=st.integers(0, 10_000))
def test_agrees_with_the_kernels_local_properties(turned, seed):
    face = patch(seed)
    part = read_part(face.Reversed() if turned else face)
    orientation = orient(part)
    samples = sample(part, orientation, grid=11, faces=[1])
    assert_sound(part, samples)
    normal, kappa, direction = reference(part, samples, orientation)
    largest = np.abs(kappa).max()
    assert np.abs(samples.normal - normal).max() < 1e-12
    assert np.abs(samples.curvature - kappa).max() < 1e-9 * largest
    clear = kappa[:, 0] - kappa[:, 1] > 1e-3 * largest
    assert np.abs((samples.direction_max * direction).sum(axis=1))[clear] == pytest.approx(1, abs=1e-9)


@settings(max_examples=10, deadline=None)
@given(angle=st.floats(-3, 3), x=st.floats(-1, 1), y=st.floats(-1, 1), shift=st.floats(-500, 500), mirrored=st.booleans())
def test_rigid_motion_moves_samples_and_keeps_curvature(angle, x, y, shift, mirrored):
    place = moved(angle, (x, y, 1), (shift, 2 * shift, -shift))
    if mirrored:
        place = place.Multiplied(mirror())
    shape = cut(drilled(), ball(6, (0, 0, 10)))
    _here_part, here = sampled(shape, grid=6)
    _there_part, there = sampled(shape.Moved(TopLoc_Location(place)), grid=6)
    rotation = np.array([[place.Value(i, j) for j in (1, 2, 3)] for i in (1, 2, 3)])
    offset = np.array([place.Value(i, 4) for i in (1, 2, 3)])
    assert there.point == pytest.approx(here.point @ rotation.T + offset, abs=1e-9)
    assert there.normal == pytest.approx(here.normal @ rotation.T, abs=1e-9)
    assert there.curvature == pytest.approx(here.curvature, abs=1e-9)
    assert there.area == pytest.approx(here.area, rel=1e-5)
    assert (there.neighbours == here.neighbours).all()


@settings(max_examples=30, deadline=None)
@given(d=st.lists(st.floats(-1, 1), min_size=12, max_size=12), scale=st.floats(1e-3, 1e3))
def test_curvature_scales_and_turns_with_the_side(d, scale):
    rows = np.array([[(0, 0, 0), (1, 0.2, 0), (0.1, 1, 0.3), d[0:3], d[3:6], d[6:9]]], float)
    one, other = curvature(rows), curvature(rows, -1.0)
    assert other.curvature[:, ::-1] == pytest.approx(-one.curvature, abs=1e-12)
    assert other.normal == pytest.approx(-one.normal)
    assert curvature(scale * rows).curvature == pytest.approx(one.curvature / scale, rel=1e-9, abs=1e-12)


# --- grids -----------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("n", [2, 9, 51])
def test_an_untrimmed_patch_gives_n_by_n(n):
    part, samples = sampled(patch(), grid=n)
    assert len(samples) == n * n
    (grid,) = samples.grids
    assert grid.index.shape == (n, n)
    assert (grid.index >= 0).all()
    adaptor = part.adaptor(1)
    assert grid.u == pytest.approx(np.linspace(adaptor.FirstUParameter(), adaptor.LastUParameter(), n))
    assert grid.v == pytest.approx(np.linspace(adaptor.FirstVParameter(), adaptor.LastVParameter(), n))
    assert len(samples.neighbours) == 2 * n * (n - 1)
    assert not (grid.closed_u)
    assert not (grid.closed_v)


def test_an_untrimmed_patch_gives_n_by_n_after_files(tmp_path):
    from tests.support.cad_parts import write_step

    _part, samples = sampled(write_step(patch(), tmp_path / "a.step"), grid=33)
    assert len(samples) == 33 * 33


def test_a_seam_is_sampled_once():
    _part, samples = sampled(ring(), grid=13)
    (grid,) = samples.grids
    assert grid.index.shape == (12, 12)
    assert grid.closed_u
    assert grid.closed_v
    assert len(np.unique(samples.point.round(9), axis=0)) == 144
    assert len(samples.neighbours) == 2 * 144
    distance = np.linalg.norm(samples.point[samples.neighbours[:, 0]] - samples.point[samples.neighbours[:, 1]], axis=1)
    assert distance.max() == pytest.approx(samples.max_gap)
    assert samples.max_gap < 2 * np.pi * 25 / 12


def test_poles_are_kept_off():
    _part, samples = sampled(ball(10), grid=9)
    (grid,) = samples.grids
    assert grid.closed_u
    assert not grid.closed_v
    assert grid.v[0] == pytest.approx(-np.pi / 2 + 1e-4 * np.pi)
    assert grid.v[-1] == pytest.approx(np.pi / 2 - 1e-4 * np.pi)
    assert (samples.unjudged < 0).all()
    _part, samples = sampled(cone(8, 0, 10), grid=9)
    assert (samples.unjudged < 0).all()
    assert (samples.point[:, 2] < 10).all()


def test_a_collapsed_border_is_kept_off():
    poles = TColgp_Array2OfPnt(1, 3, 1, 3)
    for i in range(3):
        for j in range(3):
            poles.SetValue(i + 1, j + 1, gp_Pnt(float(i * j), float(j * 3), float(i * i * j) / 4))
    face = BRepBuilderAPI_MakeFace(Geom_BezierSurface(poles), 1e-6).Face()
    part, samples = sampled(face, grid=7)
    assert part.faces[0].surface == "bezier"
    assert len(samples) == 49
    assert samples.uv[:, 1].min() == pytest.approx(1e-4)
    assert np.isfinite(samples.curvature).all()


def test_unbounded_surfaces_use_the_box_of_the_trim():
    _part, samples = sampled(box(10, 20, 30), grid=4)
    assert len(samples) == 6 * 16
    _part, samples = sampled(rod(5, 20), grid=9, faces=[1])
    assert samples.grids[0].index.shape == (8, 9)
    assert samples.point[:, 2].min() == pytest.approx(0)
    assert samples.point[:, 2].max() == pytest.approx(20)


SHAPES = {"patch": patch, "holed": holed_patch, "ring": ring, "ball": ball, "pocket": pocketed}


@pytest.mark.parametrize("spacing", [1.3, 9.0])
@pytest.mark.parametrize("make", SHAPES.values(), ids=SHAPES.keys())
def test_spacing_is_kept(make, spacing):
    part, samples = sampled(make(), spacing=spacing)
    assert_sound(part, samples)
    assert 0 < samples.max_gap <= spacing * (1 + 1e-9)
    assert not samples.empty


def test_spacing_may_differ_by_face():
    part = read_part(box(10, 10, 10))
    samples = sample(part, orient(part), spacing={1: 5.0, 2: 1.0}, faces=[1, 2])
    assert np.bincount(samples.face).tolist() == [0, 9, 121]


def test_options_without_meaning():
    part = read_part(box())
    for how in ({}, {"grid": 5, "spacing": 1.0}, {"grid": 1}, {"spacing": 0.0}, {"spacing": {1: -1.0}}):
        with pytest.raises(SampleError):
            sample(part, orient(part), faces=[1], **how)


# --- trims -----------------------------------------------------------------------------------------------------------


def test_inside_agrees_with_the_kernel():
    part = read_part(holed_patch())
    trim = part.trim(1)
    assert trim.closed
    assert not trim.rectangular
    u = np.linspace(trim.box[0], trim.box[1], 41)
    v = np.linspace(trim.box[2], trim.box[3], 43)
    inside = trim.inside_grid(u, v)
    kernel = BRepTopAdaptor_FClass2d(part.face(1), 1e-7)
    expected = np.array([[kernel.Perform(gp_Pnt2d(a, b)) != TopAbs_OUT for b in v.tolist()] for a in u.tolist()])
    assert (inside == expected).all()
    some = np.random.default_rng(0).integers(0, 41, (60, 2))
    assert (trim.inside(u[some[:, 0]], v[some[:, 1]]) == inside[some[:, 0], some[:, 1]]).all()


TRIMMED = [holed_patch(), drilled(), pocketed(), cut(ball(), box(20, 20, 20)), cut(ring(), box(50, 50, 50))]


@pytest.mark.parametrize("shape", TRIMMED, ids=["holed", "drilled", "pocket", "ball", "ring"])
def test_nothing_outside_the_trim_is_sampled(shape):
    part, samples = sampled(shape, grid=17)
    assert_sound(part, samples)
    for number in np.unique(samples.face).tolist():
        kernel = BRepTopAdaptor_FClass2d(part.face(number), 1e-6)
        rows = samples.face == number
        assert all(kernel.Perform(gp_Pnt2d(u, v)) != TopAbs_OUT for u, v in samples.uv[rows].tolist())


def test_points_on_the_trim_count_as_inside():
    # A plane whose trim is the triangle (0,0) (8,0) (0,8): of the 9 x 9 nodes of its box, 45 lie in it or on it.
    polygon = BRepBuilderAPI_MakePolygon()
    for x, y in ((0, 0), (8, 0), (0, 8)):
        polygon.Add(gp_Pnt(float(x), float(y), 0.0))
    polygon.Close()
    part, samples = sampled(BRepBuilderAPI_MakeFace(polygon.Wire(), True).Face(), grid=9)
    assert len(samples) == 45
    assert part.faces[0].area == pytest.approx(32)


def test_a_thin_face_gets_samples_of_a_finer_grid_or_of_its_triangles():
    polygon = BRepBuilderAPI_MakePolygon()
    for x, y in ((0.1, 0), (100, 33.371), (100, 33.372), (0.1, 1e-3)):
        polygon.Add(gp_Pnt(float(x), float(y), 0.0))
    polygon.Close()
    sliver = BRepBuilderAPI_MakeFace(polygon.Wire(), True).Face()
    # In a plane that is turned against the sliver, so that the box of the trim is wide.
    part, samples = sampled(compound(sliver, box()), spacing=5.0)
    assert (samples.face == 1).any()
    assert not samples.empty
    assert_sound(part, samples)


def test_faces_that_cannot_be_judged_are_listed():
    from OCP.TopoDS import TopoDS_Face

    bare = TopoDS_Face()
    BRep_Builder().MakeFace(bare)
    _part, samples = sampled(compound(box(), bare), grid=3)
    assert [number for number, _ in samples.empty] == [7]
    assert len(samples) == 54
    _part, samples = sampled(compound(box(), bare), grid=3, faces=[7])
    assert len(samples) == 0
    assert samples.max_gap == 0


# --- joints and areas ------------------------------------------------------------------------------------------------


def test_neighbours_across_smooth_joints_only():
    cube = box(20, 20, 20)
    fillet = BRepFilletAPI_MakeFillet(cube)
    fillet.Add(4.0, TopoDS.Edge_s(TopExp_Explorer(cube, TopAbs_EDGE).Current()))
    part, samples = sampled(fillet.Shape(), spacing=1.0)
    across = samples.neighbours[samples.face[samples.neighbours[:, 0]] != samples.face[samples.neighbours[:, 1]]]
    kinds = {frozenset((part.faces[a - 1].shape, part.faces[b - 1].shape)) for a, b in samples.face[across]}
    assert kinds == {frozenset(("plane", "cylinder"))}
    # Two joints of 20 mm, a sample at least each mm on both sides.
    assert len(across) >= 40
    gap = np.linalg.norm(samples.point[across[:, 0]] - samples.point[across[:, 1]], axis=1)
    assert gap.max() <= 1.5
    assert (samples.normal[across[:, 0]] * samples.normal[across[:, 1]]).sum(axis=1).min() > 0.9


REAL = ("asitus_wavy-cube.stp", "axom_revolved_sphere.step", "axom_sliced_cylinder.step", "bladex_upper.iges",
        "asitus_control_arm.step", "occt_linkrods.step", "tigl_nacelle.stp")  # fmt: skip


@pytest.mark.slow("another file of the same law", but=("tigl",))
@pytest.mark.parametrize("path", real(*REAL), ids=lambda p: p.name)
def test_real_files_are_sampled_whole(path):
    part = read_part(path)
    spacing = float(np.linalg.norm(part.size)) / 40
    samples = sample(part, orient(part), spacing=spacing, faces=[f.number for f in part.faces])
    assert_sound(part, samples)
    assert not samples.empty
    assert (samples.unjudged < 0).mean() > 0.99
    assert set(samples.face) == {f.number for f in part.faces}


def test_areas_of_samples_are_near_their_share():
    part, samples = sampled(holed_patch(), grid=101)
    inner = np.zeros(len(samples), bool)
    (grid,) = samples.grids
    whole = (grid.index[1:-1, 1:-1] >= 0) & (grid.index[2:, 1:-1] >= 0) & (grid.index[:-2, 1:-1] >= 0)
    whole &= (grid.index[1:-1, 2:] >= 0) & (grid.index[1:-1, :-2] >= 0)
    inner[grid.index[1:-1, 1:-1][whole]] = True
    d = second_derivatives(part.adaptor(1), *samples.uv[inner].T)
    cell = np.linalg.norm(np.cross(d[:, 1], d[:, 2]), axis=1) * np.diff(grid.u)[0] * np.diff(grid.v)[0]
    assert samples.area[inner] == pytest.approx(cell, rel=0.02)


# --- single points ---------------------------------------------------------------------------------------------------


def test_locate_finds_the_sample_at_a_point():
    part, samples = sampled(holed_patch(), grid=15)
    orientation = orient(part)
    for row in range(0, len(samples), 9):
        found = locate(part, orientation, samples.point[row])
        assert len(found) == 1
        assert found.point[0] == pytest.approx(samples.point[row], abs=1e-7)
        assert found.normal[0] == pytest.approx(samples.normal[row], abs=1e-7)
        assert found.curvature[0] == pytest.approx(samples.curvature[row], abs=1e-7)
    above = samples.point[20] + 5e-4 * samples.normal[20]
    assert locate(part, orientation, above).point[0] == pytest.approx(samples.point[20], abs=1e-6)


@pytest.mark.slow("reads or samples a large real file", but=("0", "1", "5"))
@pytest.mark.parametrize("shape", [ball(), ring(), rod(), cone(8, 4), pocketed(), as_nurbs(ball())], ids=range(6))
def test_locate_on_turned_surfaces(shape):
    shape = shape.Moved(TopLoc_Location(moved()))
    part, samples = sampled(shape, grid=7)
    for row in range(0, len(samples), 5):
        found = locate(part, orient(part), samples.point[row].tolist())
        assert found.point[0] == pytest.approx(samples.point[row], abs=1e-7)


def test_locate_refuses_points_off_the_part():
    part = read_part(drilled())
    orientation = orient(part)
    with pytest.raises(SampleError, match="nearest is 2 mm away"):
        locate(part, orientation, (10, 3, 12))
    with pytest.raises(SampleError, match="no face within"):
        locate(part, orientation, (10, 10, 10))  # over the hole
    assert locate(part, orientation, (10, 3, 12), within=2.1).point[0] == pytest.approx((10, 3, 10))
    with pytest.raises(SampleError, match="three finite"):
        locate(part, orientation, (1, np.nan, 2))
    with pytest.raises(SampleError, match="no normal"):
        locate(read_part(cone(8, 0, 10)), orient(read_part(cone(8, 0, 10))), (0, 0, 10))


def test_locate_takes_the_lowest_face_on_an_edge():
    part = read_part(box())
    assert locate(part, orient(part), (0, 0, 5)).face[0] == 1


def test_scaling_scales_curvature():
    big = gp_Trsf()
    big.SetScale(gp_Pnt(0, 0, 0), 3.0)
    part, samples = sampled(patch(), grid=9)
    _, larger = sampled(BRepBuilderAPI_Transform(patch(), big, True).Shape(), grid=9)
    assert larger.curvature == pytest.approx(samples.curvature / 3, abs=1e-12)
    assert BRep_Tool.Surface_s(part.face(1)) is not None
