"""Joining loose faces: the first tolerance that closes, what stays open, and samples linked across what was joined."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from OCP.BRep import BRep_Builder, BRep_Tool
from OCP.BRepAdaptor import BRepAdaptor_Curve2d
from OCP.BRepBuilderAPI import (
    BRepBuilderAPI_MakeFace,
    BRepBuilderAPI_MakePolygon,
    BRepBuilderAPI_Sewing,
    BRepBuilderAPI_Transform,
)
from OCP.BRepFilletAPI import BRepFilletAPI_MakeFillet
from OCP.Geom import Geom_SphericalSurface
from OCP.gp import gp_Ax3, gp_Dir, gp_Pln, gp_Pnt, gp_Trsf
from OCP.TopAbs import TopAbs_EDGE, TopAbs_VERTEX
from OCP.TopLoc import TopLoc_Location
from OCP.TopoDS import TopoDS, TopoDS_Face

from cad_io import read_part
from cad_io.kernel import explore, faces
from cad_io.part.bodies import orient
from cad_io.part.coincide import Curves
from cad_io.part.sew import MOST, RUNGS, edge_uses, join, sew
from cad_io.sample import sample
from tests.support.cad_parts import as_nurbs, box, compound, drilled, loose, moved, patch, pocketed, real, rod

DIAGONAL = 10 * np.sqrt(3)


def rounded():
    solid = box()
    fillet = BRepFilletAPI_MakeFillet(solid)
    for edge in explore(solid, TopAbs_EDGE):
        fillet.Add(2.0, TopoDS.Edge_s(edge))
    return fillet.Shape()


@pytest.mark.parametrize(("gap", "rung"), [(0.0, 0), (1e-4, 1), (1e-3, 2), (0.01, 3)])
def test_the_first_tolerance_that_closes_is_kept(gap, rung):
    part = read_part(loose(box(), gap))
    sewn = part.sewn
    assert sewn.tolerance == sewn.tried == pytest.approx(RUNGS[rung] * np.linalg.norm(part.size))
    assert (sewn.open_edges, sewn.open_length) == (0, 0.0)
    assert orient(part).confident


def test_what_does_not_close_stays_open_and_is_measured():
    apart = read_part(loose(box(), 0.5))
    assert apart.sewn.tried == pytest.approx(RUNGS[-1] * np.linalg.norm(apart.size))
    assert apart.sewn.open_edges > 0
    assert not orient(apart).confident
    lidless = read_part(compound(*faces(loose(box()))[:5])).sewn
    assert (lidless.tolerance, lidless.open_edges) == (pytest.approx(RUNGS[0] * DIAGONAL), 4)
    assert lidless.open_length == pytest.approx(40)
    alone = read_part(patch()).sewn
    assert (alone.tolerance, alone.tried, alone.open_edges) == (None, None, 4)


def test_no_tolerance_is_above_the_most():
    big = loose(box(1000, 1000, 1000), 0.5)
    assert read_part(big).sewn.tried == MOST


def test_solids_and_closed_shells_need_no_joining():
    part = read_part(compound(drilled(), box(at=(50, 0, 0))))
    assert part.sewn == type(part.sewn)({}, None, None, 0, 0.0)
    mixed = read_part(compound(drilled(), loose(box(at=(50, 0, 0)))))
    assert set(mixed.sewn.faces) == set(range(8, 14))
    assert mixed.sewn.open_edges == 0


def test_the_part_is_not_changed_by_joining():
    part = read_part(loose(box(), 0.01))

    def edges():
        return [(edge.TShape(), BRep_Tool.Tolerance_s(TopoDS.Edge_s(edge))) for edge in explore(part.shape, TopAbs_EDGE)]

    before = edges()
    assert sew(part.shape, faces(part.shape), math.hypot(*part.size)).open_edges == 0
    assert edges() == before
    assert not part.closed


def test_faces_that_cannot_be_judged_do_not_stop_joining():
    builder = BRep_Builder()
    bare, edgeless = TopoDS_Face(), TopoDS_Face()
    builder.MakeFace(bare)
    builder.MakeFace(edgeless, Geom_SphericalSurface(gp_Ax3(), 3.0), TopLoc_Location(), 1e-6)
    part = read_part(compound(loose(box()), bare, edgeless))
    assert part.sewn.open_edges == 0
    assert set(np.abs(orient(part).sign)) == {1.0}


def links(shape):
    """Pairs of faces with samples linked across their common edge."""
    part = read_part(shape)
    samples = sample(part, orient(part), spacing=1.0, faces=range(1, len(part.faces) + 1))
    pairs = np.sort(samples.face[samples.neighbours], axis=1)
    return {tuple(pair) for pair in pairs[pairs[:, 0] != pairs[:, 1]].tolist()}


def test_samples_are_linked_across_joined_faces_as_in_a_solid():
    assert len(links(rounded())) == 48  # 24 between sides and edges, 24 between edges and corners
    assert links(loose(rounded())) == links(rounded())
    assert links(loose(drilled())) == set()


@pytest.mark.parametrize(
    ("path", "share", "edges"),
    [
        *((path, 1e-4, 0) for path in real("asitus_ANC101-ill.stp")),
        *((path, None, 4) for path in real("bladex_upper.iges", "tigl_nacelle.stp")),
        *((path, None, 0) for path in real("tigl_D150_wing.igs", "asitus_wavy-cube.stp")),
    ],
    ids=lambda x: getattr(x, "name", ""),
)
def test_real_files_on_the_ladder(path, share, edges):
    part = read_part(path)
    assert part.sewn.open_edges == edges
    expected = share and pytest.approx(share * np.linalg.norm(part.size))
    assert part.sewn.tolerance == expected


# --- laws, closed forms and the kernel's own sewing ------------------------------------------------------------------


def joined(shapes, diagonal):
    return join(dict(enumerate(shapes)), diagonal)


def neighbours(shapes):
    """For each edge: which faces use it, which way against the first, and how long it is; in an order of its own."""
    found = []
    for edge, users in edge_uses(shapes):
        users = sorted(users)
        found.append((tuple((i, way * users[0][1]) for i, way in users), round(length(edge), 3)))
    return sorted(found)


def length(edge):
    return float(Curves([edge], 1e-6).length(np.zeros(2, int), np.array(BRep_Tool.Range_s(edge))) @ [-1, 1])


def by_kernel(shapes, tolerance):
    """The same faces, joined by the kernel."""
    sewing = BRepBuilderAPI_Sewing(tolerance, True, True, True, True)
    for face in shapes:
        sewing.Add(face)
    sewing.Perform()
    return [TopoDS.Face_s(sewing.ModifiedSubShape(face) if sewing.IsModifiedSubShape(face) else face) for face in shapes]


def stacked():
    """A box whose front is two faces: the sides' edges run along two of theirs each."""
    whole = faces(loose(box()))
    front = [i for i, face in enumerate(whole) if neighbours([face]) and at_x(face, 0.0)]
    plane = gp_Pln(gp_Pnt(0, 0, 0), gp_Dir(1, 0, 0))
    flat = [BRepBuilderAPI_MakeFace(plane, *corners).Face() for corners in frame(plane)]
    return [face for i, face in enumerate(whole) if i not in front] + flat


def frame(plane):
    """Two rectangles (u0, u1, v0, v1) in a plane x = 0 that are 0 to 10 in y and z, parted at y = 4."""
    x, y = plane.Position().XDirection(), plane.Position().YDirection()
    corner = {"y": (0.0, 4.0, 10.0), "z": (0.0, 10.0)}
    made = []
    for low, high in ((0, 1), (1, 2)):
        points = np.array([[0, corner["y"][k], z] for k in (low, high) for z in corner["z"]])
        u, v = points @ np.array(x.Coord()), points @ np.array(y.Coord())
        made.append((u.min(), u.max(), v.min(), v.max()))
    return made


def at_x(face, x):
    return all(abs(BRep_Tool.Pnt_s(TopoDS.Vertex_s(vertex)).X() - x) < 1e-9 for vertex in explore(face, TopAbs_VERTEX))


MADE = {
    "box": lambda: faces(loose(box())),
    "drilled": lambda: faces(loose(drilled())),
    "pocketed": lambda: faces(loose(pocketed())),
    "rounded": lambda: faces(loose(rounded())),
    "nurbs": lambda: faces(loose(as_nurbs(drilled()))),
    "rod": lambda: faces(loose(rod())),
    "stacked": stacked,
    "no lid": lambda: faces(loose(rounded()))[1:],
}


@pytest.mark.parametrize("name", MADE)
def test_who_is_whose_neighbour_is_what_the_kernel_finds(name):
    shapes = MADE[name]()
    assert neighbours(joined(shapes, DIAGONAL).faces.values()) == neighbours(by_kernel(shapes, 1e-5))


@pytest.mark.parametrize("name", MADE)
def test_neighbours_do_not_depend_on_place_size_or_order(name):
    shapes = MADE[name]()
    known = neighbours(joined(shapes, DIAGONAL).faces.values())
    away = [TopoDS.Face_s(BRepBuilderAPI_Transform(face, moved(), True).Shape()) for face in shapes]
    assert neighbours(joined(away, DIAGONAL).faces.values()) == known
    big = gp_Trsf()
    big.SetScale(gp_Pnt(1, 2, 3), 8.0)
    large = [TopoDS.Face_s(BRepBuilderAPI_Transform(face, big, True).Shape()) for face in shapes]
    assert [users for users, _ in neighbours(joined(large, 8 * DIAGONAL).faces.values())] == [users for users, _ in known]
    order = np.random.default_rng(1).permutation(len(shapes))
    found = neighbours(joined([shapes[i] for i in order], DIAGONAL).faces.values())
    assert sorted(tuple(sorted(order[i] for i, _ in users)) for users, _ in found) == sorted(
        tuple(sorted(i for i, _ in users)) for users, _ in known
    )


@settings(max_examples=10, deadline=None)
@given(gap=st.floats(0.0, 0.02), more=st.floats(1.0, 30.0))
def test_a_larger_part_s_tolerances_join_no_less_and_none_joins_more_than_it_says(gap, more):
    shapes = faces(loose(box(), gap))
    less, found = joined(shapes, DIAGONAL), joined(shapes, more * DIAGONAL)
    assert found.open_length <= less.open_length + 1e-6
    for each, size in ((less, DIAGONAL), (found, more * DIAGONAL)):
        # Whatever is apart by more than the last tolerance stays so.
        if gap > 1.001 * RUNGS[-1] * size:
            assert each.open_edges
        elif gap < 0.999 * RUNGS[-1] * size:
            assert not each.open_edges


@pytest.mark.parametrize("rung", RUNGS)
def test_a_gap_just_below_a_rung_is_joined_there_and_one_just_above_is_not(rung):
    assert joined(faces(loose(box(), 0.99 * rung * DIAGONAL)), DIAGONAL).tolerance == pytest.approx(rung * DIAGONAL)
    above = joined(faces(loose(box(), 1.01 * rung * DIAGONAL)), DIAGONAL)
    assert above.open_edges or above.tolerance > 1.01 * rung * DIAGONAL


def test_a_box_with_a_parted_front_is_closed_and_cut_where_the_parts_meet():
    found = joined(stacked(), DIAGONAL)
    assert not found.open_edges
    assert sorted(round(size, 6) for _, size in neighbours(found.faces.values())) == sorted([4.0, 6.0] * 2 + [10.0] * 11)


def test_a_hole_of_many_short_edges_is_no_point():
    count, radius = 400, 2.0
    angle = np.linspace(0, 2 * np.pi, count, endpoint=False)
    border = BRepBuilderAPI_MakePolygon()
    for a in angle.tolist():
        border.Add(gp_Pnt(radius * math.cos(a), radius * math.sin(a), 0.0))
    border.Close()
    maker = BRepBuilderAPI_MakeFace(gp_Pln(), -50, 50, -50, 50)
    maker.Add(TopoDS.Wire_s(border.Wire().Reversed()))
    # Each is 0.03 mm long, below the last rung.
    assert joined([maker.Face(), *faces(loose(box(at=(0, 0, 90))))], 150.0).open_edges == count + 4


def test_points_of_a_common_edge_are_the_same_on_both_faces():
    part = read_part(compound(*MADE["nurbs"]()))
    numbers, shapes = list(part.sewn.faces), list(part.sewn.faces.values())
    for edge, users in edge_uses(shapes):
        low, high = BRep_Tool.Range_s(edge)
        points = []
        for i, _ in users:
            line = BRepAdaptor_Curve2d(edge, shapes[i])
            uv = np.array([line.Value(t).Coord() for t in np.linspace(low, high, 33).tolist()])
            points.append(part.surface(numbers[i]).first(uv[:, 0], uv[:, 1])[:, 0])
        assert np.ptp(points, axis=0).max() < 1e-4
