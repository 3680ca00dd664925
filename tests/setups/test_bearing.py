"""Whether a part stands by itself: closed forms, and laws of motion and size."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from plan_cutters.setups import solids
from plan_cutters.setups.workpiece import Bearing, PartMesh, Workpiece, enclosed

UP = (0.0, 0.0, 1.0)
SIZE = st.floats(1.0, 100.0)


def boxes(*each):
    """A workpiece of boxes, each by two corners; six faces each."""
    vertex = np.concatenate([solids.box(*np.array(corners, float)) for corners in each])
    face = np.tile(np.arange(1, 7, dtype=np.int32), 2)
    faces = np.concatenate([face + 6 * k for k in range(len(each))]).astype(np.int32)
    count = 6 * len(each)
    return Workpiece.of(PartMesh.of(vertex, faces, np.ones(count)), range(1, count + 1), (), UP)


@settings(max_examples=60, deadline=None)
@given(SIZE, SIZE, SIZE)
def test_a_box_stands_unless_it_is_more_than_three_times_as_high_as_wide(x, y, z):
    bearing = boxes(((0, 0, 0), (x, y, z))).bearing(0.0)
    assert math.isclose(bearing.area, x * y, rel_tol=1e-9)
    assert math.isclose(bearing.footprint, x * y, rel_tol=1e-9)
    assert math.isclose(bearing.width, min(x, y), rel_tol=1e-9)
    assert math.isclose(bearing.inside, 0.5 * min(x, y), rel_tol=1e-9)
    # Long ones have the middle nearer to an edge than a twentieth of the side of their footprint.
    middle = 0.5 * min(x, y) >= 0.05 * math.sqrt(x * y)
    assert bearing.firm == (z <= 3.0 * min(x, y) and middle)


@settings(max_examples=60, deadline=None)
@given(SIZE, SIZE, SIZE, st.floats(0.0, 6.2), st.floats(-50.0, 50.0))
def test_the_centre_of_mass_moves_with_the_body(x, y, z, turn, shift):
    vertex = solids.box(np.zeros(3), np.array([x, y, z]))
    c, s = math.cos(turn), math.sin(turn)
    rotation = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]]) @ np.array([[1.0, 0, 0], [0, c, -s], [0, s, c]])
    moved = vertex @ rotation.T + shift
    normal = np.cross(moved[:, 1] - moved[:, 0], moved[:, 2] - moved[:, 0])
    middle = rotation @ (0.5 * np.array([x, y, z])) + shift
    assert np.allclose(enclosed(moved, normal)[1], middle, atol=1e-7 * (1 + abs(shift)))


@pytest.mark.parametrize("turned", [1.0, -1.0])
def test_triangles_that_run_the_other_way_round_have_the_same_centre(turned):
    vertex = solids.cylinder(7.0, 10.0, 60)
    normal = np.cross(vertex[:, 1] - vertex[:, 0], vertex[:, 2] - vertex[:, 0])
    flipped = vertex if turned > 0 else vertex[:, ::-1]
    assert np.allclose(enclosed(flipped, normal)[1], [0.0, 0.0, 5.0], atol=1e-9)


def test_what_is_open_has_the_middle_of_its_surface():
    square = np.array([[[0.0, 0, 0], [4, 0, 0], [4, 2, 0]], [[0, 0, 0], [4, 2, 0], [0, 2, 0]]])
    assert np.allclose(enclosed(square, np.tile([0.0, 0.0, 1.0], (2, 1)))[1], [2.0, 1.0, 0.0])


def test_a_beam_stands_on_a_foot_in_its_middle_and_not_at_its_end():
    """Seen from above the beam is 100 x 20, and the foot 30 x 20: more than a tenth, and wide enough."""
    beam = ((0, 0, 10), (100, 20, 20))
    assert boxes(beam, ((35, 0, 0), (65, 20, 10))).bearing(0.0).firm
    assert not boxes(beam, ((0, 0, 0), (30, 20, 10))).bearing(0.0).firm


def test_points_of_feet_carry_nothing_and_feet_far_apart_do():
    """The hull of the feet carries a table; a foot of 1 mm2 does not."""
    top = ((0, 0, 10), (60, 60, 14))
    legs = [((x, y, 0), (x + 4, y + 4, 10)) for x in (0, 56) for y in (0, 56)]
    assert boxes(top, *legs).bearing(0.0).firm
    assert not boxes(top, ((29.5, 29.5, 0), (30.5, 30.5, 10))).bearing(0.0).firm


def test_nothing_below_is_no_bearing():
    bearing = Bearing.of(np.array([[0.0, 0], [1, 0], [0, 1]]), np.zeros((0, 2)), np.zeros(2), 1.0)
    assert (bearing.firm, bearing.area, bearing.inside) == (False, 0.0, -math.inf)
    assert Bearing.of(np.zeros((3, 2)), np.zeros((3, 2)), np.zeros(2), 1.0).slender == math.inf
