"""Laws of vises that are placed (`docs/operations_proof.md`, lemmas K1 to K3), on blocks by intervals."""

import math
from itertools import product

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from cad_io.arrays import Triangles
from plan_cutters.domain.clamping import requested
from plan_cutters.domain.fixture import Fixture
from plan_cutters.scene.fixtures import body_near, entered, overlaps
from plan_cutters.scene.obstacles import Obstacles
from plan_cutters.setups import solids
from plan_cutters.setups.clamping import NothingToGripError, held
from plan_cutters.setups.places import vise_places
from plan_cutters.setups.workpiece import PARALLEL, PartMesh, Workpiece

TOLERANCE, UP = 0.01, np.array([0.0, 0.0, 1.0])


def faces_of(vertex):
    """Numbers of the faces of boxes, six each: x low and high, y low and high, z low and high."""
    normal = np.cross(vertex[:, 1] - vertex[:, 0], vertex[:, 2] - vertex[:, 0])
    side = np.abs(normal).argmax(axis=1)
    high = normal[np.arange(len(side)), side] > 0
    return (1 + 2 * side + high + 6 * (np.arange(len(vertex)) // 12)).astype(np.int32)


def placed(boxes, turn, word="vise:46x25x65"):
    """How a vise is placed on boxes, each by two corners, that are turned with their setup; None where it grips nothing."""
    vertex = np.concatenate([solids.box(*np.array(each, float)) for each in boxes])
    face, count = faces_of(vertex), 6 * len(boxes)
    vertex = vertex @ turn.T
    part = Obstacles(Triangles(vertex, face, 0.0, ()), np.ones(len(vertex), np.int8))
    piece = Workpiece.of(PartMesh.of(vertex, face, np.ones(count)), range(1, count + 1), (), tuple(turn @ UP))

    def plainly(fixture, clamping):
        return entered(part, fixture, clamping, TOLERANCE)

    def searched(fixture, clamping):
        return overlaps(part, body_near(clamping, fixture, 0.002, part), TOLERANCE)

    try:
        return held(Fixture.parse(word), piece, plainly, searched)
    except NothingToGripError:
        return None


def own(fixture, box, turn):
    """The corners (2, 3) of a box in the frame of a vise: along its axes."""
    corner = np.array([[box[i][k] for k, i in enumerate(which)] for which in product((0, 1), repeat=3)], float)
    local = (corner @ turn.T - fixture.shift) @ fixture.rotation
    return np.array([local.min(axis=0), local.max(axis=0)])


#: Sizes are whole, so that what overlaps does so by much more than any tolerance.
SPOT = st.tuples(*[st.integers(-8, 44), st.integers(-8, 36), st.integers(0, 22)])
MORE = st.lists(st.tuples(SPOT, st.tuples(st.integers(1, 16), st.integers(1, 16), st.integers(1, 12))), max_size=4)


@settings(max_examples=30, deadline=None)
@given(MORE, st.tuples(st.integers(10, 60), st.integers(10, 50), st.integers(6, 30)), st.integers(0, 2**31))
def test_a_vise_that_is_placed_stands_in_nothing_of_the_part_and_holds_it_by_its_text(more, size, seed):
    turn = Rotation.random(random_state=seed).as_matrix()
    boxes = [((0, 0, 0), size), *((low, tuple(np.add(low, wide))) for low, wide in more)]
    hold = placed(boxes, turn)
    if hold is None:
        assert more, "a block alone is gripped"
        return
    again = Fixture.parse(hold.fixture.text)
    assert again.clamping == hold.fixture.clamping
    assert np.array_equal(again.rotation, hold.fixture.rotation)
    assert np.array_equal(again.shift, hold.fixture.shift)
    for solid in hold.fixture.clamping.solids(0.002):
        x, y = np.array([*solid.inner, *solid.outer]).T
        low, high = np.array([x.min(), y.min(), solid.low]), np.array([x.max(), y.max(), solid.high])
        for box in boxes:
            first, last = own(hold.fixture, box, turn)
            assert (np.minimum(high, last) - np.maximum(low, first)).min() <= 2.0 * TOLERANCE
    # Each face that is gripped lies at a jaw, between its upper edge and what the part rests on.
    for number in hold.grips:
        first, last = own(hold.fixture, boxes[(number - 1) // 6], turn)
        if first[2] > hold.fixture.clamping.grip - 1e-6:
            continue  # it touches the upper edge of a jaw alone, within rounding
        assert 0.5 * hold.fixture.clamping.gap == pytest.approx(np.abs([first[0], last[0]]).max(), abs=1e-6)
        assert first[2] < hold.fixture.clamping.grip
        assert last[2] > 0.0


@settings(max_examples=80, deadline=None)
@given(*[st.floats(-1.2, 1.2)] * 4, st.floats(12.0, 150.0), st.sampled_from([2.0, 3.0, 6.0]))
def test_what_is_gripped_is_off_its_jaw_by_no_more_than_faces_may_be_off_each_other(one, other, lean, back, long, grip):
    """Two walls that stand and run off by up to a little more than 0.1 deg: no point of them is in a jaw, none far from it."""
    most = math.asin(PARALLEL)
    run, stand = np.tan(0.5 * most * np.array([one, other])), np.tan(most * np.array([lean, back]))
    vertex = solids.box(np.zeros(3), np.array([1.0, long, 30.0]))
    face = faces_of(vertex)
    ends = np.array([0.0, 40.0]) + vertex[..., 1:2] * run + vertex[..., 2:] * stand
    vertex[..., 0] = (1.0 - vertex[..., 0]) * ends[..., 0] + vertex[..., 0] * ends[..., 1]
    part = Workpiece.of(PartMesh.of(vertex, face, np.ones(6)), range(1, 7), (), tuple(UP))
    found, _ = vise_places(part, requested("vise", f"46x25x65:{grip}", 1.0, "vise"))
    places = [each for each in found if set(each.grips) == {1, 2}]
    if abs(one - other) > 2.0 + 1e-6 or max(abs(lean), abs(back)) > 1.0 + 1e-6:
        assert not places
    elif abs(one - other) < 2.0 - 1e-6 and max(abs(lean), abs(back)) < 1.0 - 1e-6 and long > 20.0:
        assert places
    off = long * math.tan(0.5 * most) + grip * math.tan(most) + 1e-6
    for place in places:
        # Corners of what the jaws reach: the walls are planes.
        for k, (wall, slope) in enumerate(zip(run, stand, strict=True)):
            for y, z in product((0.0, long), (0.0, grip)):
                at = np.array([40.0 * k + y * wall + z * slope, y, z])
                x = abs(place.own(at[None, None])[0, 0, 0])
                assert 0.5 * place.apart - off <= x <= 0.5 * place.apart + 1e-6
