"""Splitting: pieces tile their faces, solids stay closed, nodes end up in pieces of their label, failures are said."""

import os
import time

import numpy as np
import pytest
from OCP.BRepBuilderAPI import BRepBuilderAPI_Transform
from OCP.BRepCheck import BRepCheck_Analyzer
from OCP.BRepGProp import BRepGProp
from OCP.BRepPrimAPI import (
    BRepPrimAPI_MakeBox,
    BRepPrimAPI_MakeCone,
    BRepPrimAPI_MakeCylinder,
    BRepPrimAPI_MakeSphere,
    BRepPrimAPI_MakeTorus,
)  # fmt: skip
from OCP.BRepTopAdaptor import BRepTopAdaptor_FClass2d
from OCP.gp import gp_Ax1, gp_Dir, gp_Pnt, gp_Pnt2d, gp_Trsf, gp_Vec
from OCP.GProp import GProp_GProps
from OCP.IGESControl import IGESControl_Writer
from OCP.TopAbs import TopAbs_IN
from OCP.TopLoc import TopLoc_Location
from scipy.ndimage import maximum_filter, minimum_filter

from cad_io import read_part
from cad_io.kernel import faces
from cad_io.kernel.shapes import compound
from cad_io.part import Part
from cad_io.split import cut_faces
from cad_io.split.border import CannotSplit
from cad_io.split.cut_faces import TOO_LONG
from cad_io.split.pieces import MIXED, UNKNOWN, split
from plan_cutters_base.forks import ChildDied, TimeLimit, limited
from tests.support.split_parts import block, face_count, labels, largest_bspline, patch, waves


def area(face):
    """By the kernel's adaptive integration: good to 2e-5 here; wrong on surfaces of extrusion, which are not used."""
    found = GProp_GProps()
    BRepGProp.SurfaceProperties_s(face, found, 1e-7)
    return found.Mass()


def misplaced(split, field, closed=(False, False)):
    """Share of the known nodes, one cell off any boundary, that lie in a piece of another label."""
    modes = ["wrap" if c else "nearest" for c in closed]
    calm = maximum_filter(field.label, 3, mode=modes) == minimum_filter(field.label, 3, mode=modes)
    calm &= field.label >= 0
    pieces = [(BRepTopAdaptor_FClass2d(p.shape, 1e-7), p.label) for p in split.pieces if p.face == field.face]
    wrong = total = 0
    for i, j in np.argwhere(calm)[::7]:
        node = gp_Pnt2d(field.u[i], field.v[j])
        hit = [label for classifier, label in pieces if classifier.Perform(node) == TopAbs_IN]
        total += bool(hit)
        wrong += bool(hit) and hit != [field.label[i, j]]
    return wrong / total


def check(part, fields, closed=(False, False)):
    """Split and check what always holds."""
    found = split(part, fields)
    assert found.whole == {}
    assert {p.face for p in found.pieces} == {f.number for f in part.faces}
    assert len(found.pieces) == face_count(found.shape)
    assert BRepCheck_Analyzer(found.shape).IsValid()
    after = Part(found.shape)
    assert (after.solids, after.closed) == (part.solids, part.closed)
    for f in fields:
        mine = [p for p in found.pieces if p.face == f.face]
        assert {p.label for p in mine} == set(np.unique(f.label[f.label >= 0]))
        assert all(abs(sum(p.shares.values()) - 1) < 1e-12 for p in mine if p.shares)
        total = sum(area(p.shape) for p in mine)
        assert total == pytest.approx(area(part.face(f.face)), rel=5e-5)
        assert misplaced(found, f, closed) <= 0.02
    return found


SEAMED = {
    "cylinder": (BRepPrimAPI_MakeCylinder(10, 40).Solid(), (True, False)),
    "sphere": (BRepPrimAPI_MakeSphere(10).Solid(), (True, False)),
    "cone": (BRepPrimAPI_MakeCone(10, 0, 20).Solid(), (True, False)),
    "torus": (BRepPrimAPI_MakeTorus(20, 5).Solid(), (True, True)),
}


@pytest.mark.slow("another seed of the same law", but=("torus-0", "sphere-0", "cone-1"))
@pytest.mark.parametrize("seed", [0, 1])
@pytest.mark.parametrize("name", SEAMED)
def test_boundaries_cross_seams_and_meet_at_poles(name, seed):
    shape, closed = SEAMED[name]
    part = Part(shape)
    check(part, [labels(part, 1, waves(seed), closed=closed)], closed)


@pytest.mark.slow("another surface of the same law", but=("torus",))
@pytest.mark.parametrize("name", SEAMED)
def test_island_on_the_seam_and_a_band_around(name):
    shape, closed = SEAMED[name]
    part = Part(shape)
    on_seam = labels(part, 1, lambda x, y: np.minimum(x, 1 - x) ** 2 + (y - 0.5) ** 2 < 0.04, closed=closed)
    check(part, [on_seam], closed)
    check(part, [labels(part, 1, lambda x, y: (y > 0.3) & (y < 0.62), closed=closed)], closed)


def test_a_seam_sampled_twice_is_the_same_as_once():
    part = Part(SEAMED["cylinder"][0])
    once = split(part, [labels(part, 1, waves(2), n=48, closed=(True, False))])
    twice = split(part, [labels(part, 1, waves(2), n=49)])
    assert sorted(p.label for p in once.pieces) == sorted(p.label for p in twice.pieces)


@pytest.mark.slow("another seed of the same law", but=("3",))
@pytest.mark.parametrize("seed", [3, 4])
def test_open_and_closed_boundaries_on_a_patch(seed):
    part = Part(patch())
    check(part, [labels(part, 1, waves(seed), n=101)])


def test_nested_labels_with_a_gap():
    part = Part(patch())
    field = labels(part, 1, lambda x, y: np.select([np.hypot(x - 0.5, y - 0.5) < r for r in (0.15, 0.35)], [3, 1], 0))
    found = check(part, [field])
    assert sorted(p.label for p in found.pieces) == [0, 1, 3]


def test_strips_between_distant_labels_take_a_label_next_to_them():
    part = Part(patch())
    field = labels(part, 1, lambda x, y: np.where(x < 0.5, 0, 2) + (x < 0.5) * (y > 0.7))
    found = split(part, [field])
    assert found.whole == {}
    assert {p.label for p in found.pieces} == {0, 1, 2}
    assert misplaced(found, field) == 0


def test_trims_and_neighbours_of_a_solid():
    part = Part(block())
    top = largest_bspline(part)
    side = next(f.number for f in part.faces if f.surface == "cylinder")
    fields = [labels(part, top, waves(5), n=81), labels(part, side, waves(6), closed=(True, False))]
    found = split(part, fields)
    assert found.whole == {}
    assert Part(found.shape).closed
    assert {p.label for p in found.pieces if p.face not in (top, side)} == {UNKNOWN}
    for f in fields:
        total = sum(area(p.shape) for p in found.pieces if p.face == f.face)
        assert total == pytest.approx(area(part.face(f.face)), rel=5e-5)
        assert misplaced(found, f) <= 0.02


def test_unknown_nodes_do_not_matter():
    part = Part(patch())
    field = labels(part, 1, lambda x, y: x + 0.2 * y > 0.6)
    field.label[20:30, 10:50] = -1
    found = check(part, [field])
    assert sorted(p.label for p in found.pieces) == [0, 1]


def test_located_solids_in_a_compound():
    turn = gp_Trsf()
    turn.SetRotation(gp_Ax1(gp_Pnt(0, 0, 0), gp_Dir(1, 1, 0)), 0.7)
    turn.SetTranslationPart(gp_Vec(200, 0, 0))
    shape = block(1)
    part = Part(compound([shape, shape.Located(TopLoc_Location(turn)), SEAMED["sphere"][0]]))
    tops = [f.number for f in part.faces if f.surface == "bspline" and f.area > 9000]
    assert len(tops) >= 2
    found = check(part, [labels(part, n, lambda x, y: x > 0.45 + 0.2 * y) for n in tops[:2]])
    # The sphere was not touched.
    assert found.pieces[-1].shape.IsSame(part.face(len(part.faces)))


def test_loose_faces():
    part = Part(compound([*faces(BRepPrimAPI_MakeBox(30, 20, 10).Solid())[:2], patch()]))
    fields = [labels(part, f.number, waves(f.number)) for f in part.faces]
    check(part, fields)


def test_two_edges_in_place_of_a_seam(tmp_path):
    writer = IGESControl_Writer()
    writer.AddShape(BRepPrimAPI_MakeCylinder(10, 40).Solid())
    writer.Write(str(tmp_path / "c.igs"))
    part = read_part(tmp_path / "c.igs")
    wall = max(part.faces, key=lambda f: f.area).number
    found = split(part, [labels(part, wall, waves(0), closed=(True, False))])
    assert found.whole == {}
    assert len([p for p in found.pieces if p.face == wall]) > 5


@pytest.mark.slow("works on many faces")
def test_rigid_motion_moves_the_pieces():
    turn = gp_Trsf()
    turn.SetRotation(gp_Ax1(gp_Pnt(1, 2, 3), gp_Dir(1, 2, 1)), 1.1)
    here, there = Part(patch()), Part(BRepBuilderAPI_Transform(patch(), turn, True).Shape())
    a, b = (split(p, [labels(p, 1, waves(4))]) for p in (here, there))
    areas = [sorted(Part(p.shape).faces[0].area for p in s.pieces) for s in (a, b)]
    assert areas[0] == pytest.approx(areas[1], rel=1e-6)


def test_one_label_splits_nothing():
    part = Part(block(0))
    found = split(part, [labels(part, 1, lambda x, y: 0 * x + 2)])
    assert found.shape.IsSame(part.shape)
    assert [p.label for p in found.pieces] == [2] + [UNKNOWN] * (len(part.faces) - 1)


def test_specks_are_counted():
    part = Part(patch())
    field = labels(part, 1, lambda x, y: x > 0.5)
    field.label[10, 10] = 1
    found = split(part, [field])
    assert found.dropped == {1: 1}
    assert len(found.pieces) == 2


def test_the_time_limit_leaves_faces_whole():
    part = Part(patch())
    found = split(part, [labels(part, 1, lambda x, y: x > 0.5)], seconds=0)
    assert found.whole == {1: "splitting it takes too long"}
    (piece,) = found.pieces
    assert piece.label == MIXED
    assert sum(piece.shares.values()) == pytest.approx(1)
    assert found.shape.IsSame(part.shape)


def centre(face):
    found = GProp_GProps()
    BRepGProp.SurfaceProperties_s(face, found)
    return found.CentreOfMass().Coord()


def spoilt(monkeypatch, part, number, how):
    """Have the pieces of one face made by `how(make)`, where `make()` makes them."""
    real, place = cut_faces.pieces, centre(part.face(number))

    def pieces(net, face, surface, found, regions):
        def make():
            return real(net, face, surface, found, regions)

        return how(make) if centre(face) == pytest.approx(place) else make()

    monkeypatch.setattr(cut_faces, "pieces", pieces)


def three_sides():
    """A block with three of its sides to split."""
    part = Part(block(1))
    chosen = [f.number for f in part.faces if f.surface == "bspline"][:3]
    return part, chosen, [labels(part, n, lambda x, y: x > 0.45) for n in chosen]


def refuse(make):
    raise CannotSplit("forced")


def test_only_the_face_that_fails_is_left_whole(monkeypatch):
    part, chosen, fields = three_sides()
    bad = chosen[1]
    spoilt(monkeypatch, part, bad, refuse)
    found = split(part, fields)
    assert found.whole == {bad: "forced"}
    assert [p.label for p in found.pieces if p.face == bad] == [MIXED]
    for n in set(chosen) - {bad}:
        assert sorted(p.label for p in found.pieces if p.face == n) == [0, 1]
    assert Part(found.shape).closed
    assert BRepCheck_Analyzer(found.shape).IsValid()


def spin(make):
    while True:
        pass


@pytest.mark.parametrize(
    ("how", "why"), [(spin, TOO_LONG), (lambda make: os.abort(), "splitting it fails: the kernel crashed (status 6)")]
)
def test_a_face_that_never_splits_ends_within_its_bound_and_costs_itself_alone(how, why, monkeypatch):
    part, chosen, fields = three_sides()
    bad = chosen[1]
    spoilt(monkeypatch, part, bad, how)
    began = os.times()
    found = split(part, fields, seconds=0.5)
    spent = os.times()
    assert spent.children_user + spent.children_system - began.children_user - began.children_system < 4
    assert found.whole == {bad: why}
    for n in set(chosen) - {bad}:
        assert sorted(p.label for p in found.pieces if p.face == n) == [0, 1]
    assert Part(found.shape).closed


@pytest.mark.slow("works on many faces")
def test_where_all_faces_hang_a_few_are_tried(monkeypatch):
    part = Part(BRepPrimAPI_MakeBox(30, 20, 10).Solid())
    monkeypatch.setattr(cut_faces, "pieces", lambda *_: spin(None))
    monkeypatch.setattr(cut_faces, "_HANGS", 2)
    found = split(part, [labels(part, f.number, lambda x, y: x > 0.5) for f in part.faces], seconds=0.5)
    assert sorted(found.whole) == [1, 2, 3, 4, 5, 6]
    assert list(found.whole.values()).count(TOO_LONG) == 2
    assert found.shape.IsSame(part.shape)


def test_an_invalid_neighbour_is_the_fault_of_the_face_that_cuts_its_edge(monkeypatch):
    part = Part(BRepPrimAPI_MakeBox(30, 20, 10).Solid())
    real, others = cut_faces.valid, {f.number: f.area for f in part.faces}
    first = labels(part, 1, lambda x, y: x > 0.5)

    def valid(shape):
        # Only the neighbours of F1 are looked at; with five edges they are those that F1 cuts.
        cut = len(list(cut_faces.edges_of(shape))) == 5
        return not cut and real(shape)

    monkeypatch.setattr(cut_faces, "valid", valid)
    monkeypatch.setattr(cut_faces, "wrong_whole", lambda before, after: "forced")
    found = split(part, [first])
    assert list(found.whole) == [1]
    assert "next to it is not valid" in found.whole[1]
    assert len(others) == face_count(found.shape)


def test_a_face_is_split_alike_whatever_else_is_split():
    part, chosen, fields = three_sides()
    alone = [split(part, [field]) for field in fields]
    together = split(part, fields)
    for n, one in zip(chosen, alone, strict=True):
        here, there = (sorted(round(area(p.shape), 5) for p in s.pieces if p.face == n) for s in (one, together))
        assert here == pytest.approx(there, rel=1e-5)


def test_a_failed_cut_is_tried_with_other_curves(monkeypatch):
    part, tried = Part(patch()), []

    def twice(make):
        tried.append(1)
        if len(tried) < len(cut_faces.FITS):
            raise CannotSplit("forced")
        return make()

    spoilt(monkeypatch, part, 1, twice)
    found = split(part, [labels(part, 1, lambda x, y: x > 0.5)])
    assert found.whole == {}
    assert sorted(p.label for p in found.pieces) == [0, 1]


def test_pieces_that_do_not_follow_the_labels_are_refused(monkeypatch):
    part = Part(patch())
    monkeypatch.setattr(cut_faces, "curves", lambda *_: [])
    found = split(part, [labels(part, 1, lambda x, y: x > 0.5)])
    assert "piece of another label" in found.whole[1]


def test_fields_that_make_no_sense():
    part = Part(patch())
    field = labels(part, 1, lambda x, y: x > 0.5)
    with pytest.raises(ValueError, match="two label fields"):
        split(part, [field, field])
    with pytest.raises(ValueError, match="on a grid of"):
        split(part, [type(field)(1, field.u[1:], field.v, field.label)])


def test_limits_hangs_crashes_and_errors():
    assert limited(lambda: b"x" * 300000, 10) == b"x" * 300000
    began = time.monotonic()
    with pytest.raises(TimeLimit):
        limited(lambda: time.sleep(60) or b"", 0.2)
    assert time.monotonic() - began < 5
    with pytest.raises(ChildDied, match="crashed"):
        limited(lambda: os._exit(11), 5)
    with pytest.raises(ChildDied, match="ZeroDivisionError"):
        limited(lambda: bytes([1 // 0]), 5)
