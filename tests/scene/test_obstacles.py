"""What stands in the way as triangles: halved without loss, covered by the nearest skin, and with nothing left out in silence."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from cad_io import Part
from cad_io.arrays import LostFace, Triangles
from cad_io.part.bodies import Body
from plan_cutters.errors import UnjudgeableError
from plan_cutters.scene.inside_material import cover
from plan_cutters.scene.obstacles import Obstacles, weights
from plan_cutters.scene.surroundings import surroundings
from plan_cutters.scene.triangles import divided, halved
from plan_cutters.setups import solids
from tests.support import shapes
from tests.support.cad_parts import box, compound

SEEDS = st.integers(0, 2**32 - 1)
NONE = np.zeros((0, 3, 3))


def areas(vertex):
    """Areas of triangles as vectors: they add up for the parts of a flat one alone."""
    return 0.5 * np.cross(vertex[:, 1] - vertex[:, 0], vertex[:, 2] - vertex[:, 0])


def sides(vertex):
    return np.linalg.norm(vertex - np.roll(vertex, -1, axis=1), axis=2)


@given(SEEDS)
def test_halves_of_a_triangle_are_it_cut_at_the_middle_of_its_longest_side(seed):
    vertex = np.random.default_rng(seed).uniform(-5.0, 5.0, (4, 3, 3))
    made = halved(vertex, np.linalg.norm(vertex - np.roll(vertex, -1, axis=1), axis=2))
    one, other = made[:4], made[4:]
    assert areas(one) == pytest.approx(0.5 * areas(vertex))
    assert areas(other) == pytest.approx(0.5 * areas(vertex))
    for whole, parts in zip(vertex, np.stack([one, other], axis=1), strict=True):
        k = int(sides(whole[None])[0].argmax())
        middle = 0.5 * (whole[k] + whole[(k + 1) % 3])
        assert all(any(np.allclose(corner, known) for known in [*whole, middle]) for part in parts for corner in part)
        assert all(np.linalg.norm(part - middle, axis=1).min() < 1e-12 for part in parts)


@given(SEEDS, st.floats(0.3, 4.0))
def test_divided_triangles_are_short_and_miss_nothing_in_the_box(seed, longest):
    """Points of the triangles in the box lie in what is left, too; in all of space nothing is gone."""
    rng = np.random.default_rng(seed)
    vertex = rng.uniform(-5.0, 5.0, (3, 3, 3))
    everything = divided(vertex, np.full(3, -9.0), np.full(3, 9.0), longest)
    assert sides(everything).max() <= longest
    assert np.linalg.norm(areas(everything), axis=1).sum() == pytest.approx(np.linalg.norm(areas(vertex), axis=1).sum())
    low = rng.uniform(-4.0, 0.0, 3)
    some = divided(vertex, low, low + 4.0, longest)
    assert sides(some).max(initial=0.0) <= longest
    assert ((some.max(axis=1) >= low) & (some.min(axis=1) <= low + 4.0)).all()
    kept = {each.tobytes() for each in some}
    for each in everything:
        if ((each >= low) & (each <= low + 4.0)).all(axis=1).any():
            assert each.tobytes() in kept


def test_of_many_triangles_none_is_divided_and_of_none_none_comes():
    vertex = np.random.default_rng(1).uniform(-5.0, 5.0, (9, 3, 3))
    assert len(divided(vertex, np.full(3, -9.0), np.full(3, 9.0), 0.1, most=8)) == 9
    assert 9 < len(divided(vertex, np.full(3, -9.0), np.full(3, 9.0), 0.1, most=20)) < 60
    assert divided(vertex, np.full(3, 6.0), np.full(3, 9.0), 0.1).shape == (0, 3, 3)
    assert divided(NONE, np.zeros(3), np.ones(3), 1.0).shape == (0, 3, 3)


def test_nothing_can_be_judged_among_no_triangles_or_some_without_a_place():
    with pytest.raises(UnjudgeableError, match="nothing that could be in the way"):
        Obstacles(Triangles(NONE, np.zeros(0, np.int32), 0.0, ()))
    vertex = solids.box(np.zeros(3), np.ones(3))
    for bad in (np.nan, np.inf):
        torn = vertex.copy()
        torn[5, 1, 2] = bad
        with pytest.raises(UnjudgeableError, match="corners that are no points"):
            Obstacles(Triangles(torn, np.ones(12, np.int32), 0.0, ()))
        with pytest.raises(UnjudgeableError, match="corners that are no points"):
            Obstacles(Triangles(vertex, np.ones(12, np.int32), bad, ()))


def boxes(*corners):
    """Boxes as one set of obstacles, each of which encloses what is in it; the faces of the first are 1 to 6, and so on."""
    vertex = np.concatenate([solids.box(np.array(low, float), np.array(high, float)) for low, high in corners])
    normal = areas(vertex)
    side = np.abs(normal).argmax(axis=1)
    face = 1 + 2 * side + (normal[np.arange(len(side)), side] > 0) + 6 * np.repeat(np.arange(len(corners)), 12)
    bodies = [Body(tuple(range(1 + 6 * k, 7 + 6 * k)), (1,) * 6, True, NONE) for k in range(len(corners))]
    triangles = Triangles(vertex, face.astype(np.int32), 0.0, ())
    return Obstacles(triangles, weights(triangles, bodies)), bodies


@settings(max_examples=60, deadline=None)
@given(SEEDS)
def test_the_way_out_of_a_body_leads_through_its_nearest_skin_that_faces_that_way(seed):
    """From points anywhere in a box that another one overlaps, along any direction: by the slabs of the box."""
    rng = np.random.default_rng(seed)
    low, high = np.array([-3.0, -2.0, -1.0]), np.array([4.0, 2.0, 3.0])
    obstacles, bodies = boxes((low, high), (low + 2.5, high + 2.5), (low + 40.0, high + 40.0))
    for _ in range(4):
        point, way = rng.uniform(low, high), rng.normal(size=3)
        way /= np.linalg.norm(way)
        out = [np.where(way > 0, corner[1] - point, corner[0] - point) / way for corner in ((low, high), (low + 2.5, high + 2.5))]
        side = int(out[0].argmin())
        found = cover(point, way, obstacles, bodies[0])
        assert found.point == pytest.approx(point + out[0].min() * way, abs=1e-9)
        assert found.face == 1 + 2 * side + (way[side] > 0)
        # Of all bodies the first skin that is left counts, if the way comes through the other one at all.
        into = np.where(way > 0, low + 2.5 - point, high + 2.5 - point) / way
        through = max(0.0, into.max()) <= out[1].min()
        ends = [out[0].min(), out[1].min()] if through else [out[0].min()]
        assert cover(point, way, obstacles).point == pytest.approx(point + min(ends) * way, abs=1e-9)
        far = [np.where(way > 0, one, other) + 40.0 - point for one, other in ((low, high), (high, low))]
        meets = max(0.0, (far[0] / way).max()) <= (far[1] / way).min()
        assert (cover(point, way, obstacles, bodies[2]) is None) == (not meets)
        # A skin that runs the other way round is left from the other side.
        turned = Body(bodies[0].faces, (-1,) * 6, True, NONE)
        assert cover(point, way, obstacles, turned) is None


def test_the_box_of_what_may_enclose_something_holds_all_triangles_and_all_that_is_nearly_closed():
    around, _ = boxes(((0, 0, 0), (4, 5, 6)))
    low, high = around._end
    assert (low < 0.0).all()
    assert (high > [4, 5, 6]).all()
    assert np.abs([low, high - [4, 5, 6]]).max() < 1e-6
    wide = Obstacles(around.triangles, around.weight, np.array([[[-1, 2, 2], [3, 9, 3]], [[1, -7, 1], [2, 2, 8]]], float), 0.25)
    low, high = wide._end
    assert low == pytest.approx([-1.0, -7.0, -0.25])
    assert high == pytest.approx([4.25, 9.0, 8.0])


def test_the_triangles_of_a_body_count_for_it_alone():
    around, bodies = boxes(((0, 0, 0), (4, 5, 6)), ((9, 9, 9), (10, 10, 10)))
    one = around.skin_of(bodies[0])
    assert len(one.triangles) == 12
    assert set(one.triangles.face.tolist()) == set(bodies[0].faces)
    assert (one.weight == 1).all()
    turned = around.skin_of(Body(bodies[0].faces, (-1,) * 6, True, NONE))
    assert (turned.weight == -1).all()
    single, [body] = boxes(((0, 0, 0), (4, 5, 6)))
    assert single.skin_of(body) is single


def test_what_could_not_be_read_is_a_doubt_unless_its_face_is_there():
    lost = LostFace("#7", "lid", "is gone"), LostFace("#8", "rim", "has lost an edge", 3)
    around = surroundings(Part(box(), lost=lost), 0.01)
    assert around.lost == lost[:1]
    assert around.doubts == ("F3: is not as it was written in the file: has lost an edge", "#7 lid: is gone")
    assert around.doubtful
    whole = surroundings(Part(box()), 0.01)
    assert (whole.doubts, whole.doubtful, whole.lost) == ((), False, ())
    assert whole.possible is whole.certain


def test_a_part_of_which_nothing_is_left_has_no_surroundings():
    part = Part(compound(box(), shapes.plane((0, 5), (0, 5), origin=(20, 0, 0))))
    assert set(surroundings(part, 0.01, ignored=range(1, 7)).certain.triangles.face.tolist()) == {7}
    with pytest.raises(UnjudgeableError, match="all faces are left out"):
        surroundings(part, 0.01, ignored=range(1, 8))
