"""What a cell is worth, when the last rounds gained too little, and how obstacles about one contact are shared out."""

from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from cad_io.arrays import Triangles
from plan_cutters.judging.between import _areas
from plan_cutters.judging.face_cells import _JUDGED, FaceCells, _poor, best
from plan_cutters.judging.posture_maps import _rear, moved
from plan_cutters.kernels.codes import NEVER
from plan_cutters.setups import solids


def test_a_cell_is_worth_its_area_for_each_contact_that_cutting_it_takes():
    """Halved once it takes 4 contacts, twice 4 and 16 more, and so on; one that cannot be served is worth nothing."""
    status = np.array([1, 2, 3, NEVER, 0], np.uint8)
    contacts = SimpleNamespace(area=np.array([8.0, 40.0, 84.0, 9.0, 8.0]))
    cells = SimpleNamespace(pools=[(contacts, status)])
    assert FaceCells.worth(cells, 0) == pytest.approx([8.0 / 4, 40.0 / 20, 84.0 / 84, 0.0, 8.0 / 4])
    assert len(FaceCells.worth(cells, 1)) == 0
    cells.worth = lambda level: FaceCells.worth(cells, level)
    assert FaceCells.worthy(cells, 1.5) == 3
    assert FaceCells.worthy(cells, 0.0) == 4


@given(st.lists(st.integers(0, 5), max_size=12), st.integers(-2, 14))
def test_the_best_are_the_first_of_those_of_the_largest_worth(worth, most):
    chosen = best(np.array(worth, float), most)
    assert chosen.sum() == min(len(worth), max(0, most))
    left = [each for each, mine in zip(worth, chosen, strict=True) if not mine]
    taken = [each for each, mine in zip(worth, chosen, strict=True) if mine]
    assert not left or not taken or min(taken) >= max(left)
    for k, each in enumerate(worth):
        if chosen[k]:
            assert all(chosen[j] for j in range(k) if worth[j] == each)


def test_rounds_are_poor_where_enough_of_the_last_gained_less_than_asked():
    many = _JUDGED
    assert not _poor([], 1.0)
    assert not _poor([(many - 1, 0.0)], 1.0)
    assert _poor([(many, 0.0)], 1.0)
    assert _poor([(many, 0.9 * many)], 1.0)
    assert not _poor([(many, 1.1 * many)], 1.0)
    # What was gained long ago does not count, and of the last rounds all that are needed do.
    assert _poor([(many, 9.0 * many), (many, 0.5 * many)], 1.0)
    assert not _poor([(many, 9.0 * many), (many // 2, 0.0)], 1.0)


def test_the_area_to_prove_is_that_of_all_targets_whose_area_is_known():
    faces = [SimpleNamespace(area=area) for area in (5.0, np.nan, 0.0, 7.0, 11.0)]
    samples = SimpleNamespace(face=np.array([1, 1, 2, 3]), empty=((4, "no samples"),))
    assert _areas(samples, SimpleNamespace(faces=faces)) == (12.0, (2, 3))


@settings(max_examples=15, deadline=None)
@given(st.integers(0, 2**32 - 1))
def test_obstacles_are_shared_out_by_the_ball_about_the_contact_and_its_tangent_plane(seed):
    """Nothing is lost or doubled, and what is clearly on one side of the border is there."""
    rng = np.random.default_rng(seed)
    low = rng.uniform(-9.0, 0.0, 3)
    vertex = solids.box(low, low + rng.uniform(2.0, 12.0, 3))
    triangles = Triangles(vertex, np.arange(1, 13, dtype=np.int32), 0.01, ())
    n = rng.normal(size=3)
    n /= np.linalg.norm(n)
    p, radius = rng.uniform(-3.0, 3.0, 3), 2.0
    near, far = _rear(triangles, p, n, radius)

    def areas(part):
        if part is None:
            return np.zeros(13)
        made = part.triangles
        size = 0.5 * np.linalg.norm(
            np.cross(made.vertex[:, 1] - made.vertex[:, 0], made.vertex[:, 2] - made.vertex[:, 0]), axis=1
        )
        return np.bincount(made.face, size, 13)

    whole = SimpleNamespace(triangles=triangles)
    assert areas(near) + areas(far) == pytest.approx(areas(whole))
    for part, mine in ((near, True), (far, False)):
        if part is not None:
            middle = part.triangles.vertex.mean(axis=1) - p
            away, height = np.linalg.norm(middle, axis=1), middle @ n
            inside = np.minimum(2.0 * radius - away, height)
            # Triangles that lie across the border are small.
            assert (inside > -0.2 if mine else inside < 0.2).all()
            assert part.triangles.chord_error == 0.01


def test_how_far_two_maps_differ_is_their_largest_move_unless_an_interval_came_or_went():
    def map_of(*free):
        return SimpleNamespace(free=[np.array(each, float).reshape(-1, 2) for each in free])

    one = map_of([(0.1, 0.5)], [(0.2, 0.3), (0.6, 0.9)])
    assert moved(one, one) == 0.0
    assert moved(one, map_of([(0.1, 0.45)], [(0.23, 0.3), (0.6, 0.9)])) == pytest.approx(0.05)
    assert moved(one, map_of([(0.1, 0.5)], [(0.6, 0.9)])) == np.inf
    # Slivers come and go.
    assert moved(one, map_of([(0.1, 0.5), (0.7, 0.7 + 1e-9)], [(0.2, 0.3), (0.6, 0.9)])) == 0.0
