"""Holes by rule: all of made plates are found, and none too many; they move, turn and grow with the part."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from OCP.BRepBuilderAPI import BRepBuilderAPI_NurbsConvert, BRepBuilderAPI_Transform
from OCP.gp import gp_Ax1, gp_Dir, gp_Pnt, gp_Trsf, gp_Vec

from cad_io import Part, read_part
from cad_io.part.bodies import orient
from cad_io.part.holes import holes
from cad_io.tessellate import tessellate
from tests.support.places import real_file
from tests.support.plates import NONE, PLATES

CHORD = 0.01


def found(shape, chord=CHORD, ignored=()):
    part = Part(shape)
    return holes(part, orient(part), tessellate(part, chord), ignored)


def row(hole, scale=1.0):
    """All of a hole but where it is."""
    sink = hole.countersink and (hole.countersink[0] / scale, math.degrees(hole.countersink[1]))
    bore = hole.counterbore and tuple(each / scale for each in hole.counterbore)
    return hole.diameter / scale, hole.depth / scale, hole.through, hole.bottom, sink, bore


def assert_same(one, other, tolerance=1e-3):
    """Two lists of such rows have the same ones, in some order."""

    def flat(rows):
        return sorted([d, h, through, bottom, *(s or (0.0, 0.0)), *(b or (0.0, 0.0))] for d, h, through, bottom, s, b in rows)

    assert len(one) == len(other)
    for mine, theirs in zip(flat(one), flat(other), strict=True):
        assert mine[2:4] == theirs[2:4]
        assert mine[:2] + mine[4:] == pytest.approx(theirs[:2] + theirs[4:], abs=tolerance)


@pytest.mark.parametrize("name", PLATES)
def test_every_hole_of_a_plate_is_found(name):
    made, known = PLATES[name]()
    assert_same([row(hole) for hole in found(made.val().wrapped)], known)


@pytest.mark.parametrize("name", NONE)
def test_what_is_no_hole_is_taken_for_none(name):
    assert found(NONE[name]().val().wrapped) == ()


def test_points_of_drills_have_their_angles():
    made, _ = PLATES["points"]()
    assert [math.degrees(hole.cone) for hole in found(made.val().wrapped)] == pytest.approx([118.0, 120.0, 130.0, 135.0, 140.0])


def test_a_hole_knows_its_faces_its_axis_and_its_mouth():
    made, _ = PLATES["both"]()
    part = Part(made.val().wrapped)
    (hole,) = found(made.val().wrapped)
    assert hole.axis == pytest.approx([0.0, 0.0, 1.0])
    assert hole.place == pytest.approx([0.0, 0.0, 0.0], abs=1e-9)
    shapes = [part.faces[number - 1].shape for number in hole.faces]
    assert sorted(shapes) == ["cone", "cylinder", "cylinder", "plane"]
    wide = {(shape, round(each, 6)) for shape, each in zip(shapes, hole.within, strict=True)}
    assert wide == {("cylinder", 4.0), ("cylinder", 8.0), ("plane", 8.0), ("cone", 10.0)}


def test_a_hole_that_comes_out_in_another_one_has_its_mouth_outside():
    made, _ = PLATES["manifold"]()
    for hole in found(made.val().wrapped):
        mouth, half = np.add(hole.place, (0.0, 0.0, 20.0)), (40.0, 20.0, 20.0)
        assert np.abs(mouth / half).max() == pytest.approx(1.0)
        assert mouth / half @ hole.axis == pytest.approx(1.0)


@pytest.mark.parametrize("name", ["both", "crossing", "corner", "points"])
def test_surfaces_of_another_form_change_nothing(name):
    """Other systems write cylinders as splines."""
    made, known = PLATES[name]()
    shape = BRepBuilderAPI_NurbsConvert(made.val().wrapped).Shape()
    assert Part(shape).faces[0].surface == "bspline"
    assert_same([row(hole) for hole in found(shape)], known, 0.01)


@settings(max_examples=6, deadline=None)
@given(
    name=st.sampled_from(["two_sides", "step_point", "crossing", "slanted", "round"]),
    axis=st.tuples(*[st.floats(-1.0, 1.0)] * 3).filter(lambda each: np.linalg.norm(each) > 0.1),
    turn=st.floats(0.0, 6.3), shift=st.tuples(*[st.floats(-300.0, 300.0)] * 3), scale=st.sampled_from([0.1, 1.0, 30.0]),
)  # fmt: skip
def test_holes_move_turn_and_grow_with_the_part(name, axis, turn, shift, scale):
    made, known = PLATES[name]()
    moved, larger = gp_Trsf(), gp_Trsf()
    moved.SetRotation(gp_Ax1(gp_Pnt(), gp_Dir(*axis)), turn)
    moved.SetTranslationPart(gp_Vec(*shift))
    larger.SetScaleFactor(scale)
    shape = BRepBuilderAPI_Transform(made.val().wrapped, larger * moved, True).Shape()
    again = found(shape, CHORD * scale)
    assert_same([row(hole, scale) for hole in again], known)
    before = found(made.val().wrapped)
    rotation = np.array([[moved.Value(i, j) for j in (1, 2, 3)] for i in (1, 2, 3)])
    for one, other in zip(sorted(before, key=row_key), sorted(again, key=row_key), strict=True):
        turned = rotation @ one.axis
        # A hole that is the same from both sides has two mouths.
        assert abs(turned @ other.axis) == pytest.approx(1.0)
        if turned @ other.axis > 0.0:
            assert other.place == pytest.approx(scale * (rotation @ one.place + shift), abs=2e-3 * scale)


def row_key(hole):
    return round(hole.diameter / max(hole.depth, 1e-9), 4), hole.faces


def test_a_body_in_a_hole_leaves_none_unless_it_is_ignored():
    import cadquery as cq

    plate = cq.Workplane("XY").box(40, 40, 10).faces(">Z").hole(8)
    bolt = cq.Workplane("XY").circle(3).extrude(20).translate((0, 0, -10))
    shape = cq.Compound.makeCompound([plate.val(), bolt.val()]).wrapped
    part = Part(shape)
    own = [face.number for face in part.faces][-3:]
    orientation, triangles = orient(part), tessellate(part, CHORD)
    assert holes(part, orientation, triangles) == ()
    rest = triangles.without(own)
    assert [hole.diameter for hole in holes(part, orientation, rest, own)] == pytest.approx([8.0])


#: Holes counted by hand: by diameter, mm.
COUNTED = {
    "brlcad_NIST_MBE_PMI_6.stp": {6.35: 2, 7.1374: 4, 10.541: 4, 14.2875: 2},
    "trimesh_featuretype.STEP": {6.7564: 8, 9.8917: 1},
    "asitus_ANC101-ill.stp": {9.525: 9, 12.7: 5, 25.4: 1, 50.8: 1},
    # Another bore of D9 is a seat with edges of a cavity in its floor.
    "asitus_control_arm.step": {6.0: 7, 21.0: 1, 30.0: 1, 44.0: 2},
    "hard/gmsh_Block.stp": {2.0: 4, 2.4: 8, 3.2: 4, 9.0: 1},
}  # fmt: skip


@pytest.mark.parametrize("name", COUNTED)
def test_holes_of_parts_that_people_made_are_those_that_were_counted(name):
    part = read_part(real_file(f"cad/{name}"))
    numbers = {}
    for hole in holes(part, orient(part), tessellate(part, 2e-4 * max(part.size))):
        numbers[round(hole.diameter, 4)] = numbers.get(round(hole.diameter, 4), 0) + 1
    assert numbers == COUNTED[name]
