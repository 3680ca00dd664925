"""What is added to a part has a tree of its own: whatever is asked is answered as in one tree of all."""

import pickle

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from cad_io.arrays import Triangles
from plan_cutters import Cutter, Scene
from plan_cutters.domain.assembly import assembly
from plan_cutters.kernels.material import far_inside, near_shell, plainly_outside, windings
from plan_cutters.kernels.search.search import free, probe
from plan_cutters.kernels.search.stick_out import least_stick_outs
from plan_cutters.scene.conditions import tool_of
from plan_cutters.scene.obstacles import Obstacles
from plan_cutters.scene.triangles import AddedTriangles, divided
from plan_cutters.setups.solids import box
from tests.support import waves
from tests.support.cad_parts import box as block

SEEDS = st.integers(0, 2**32 - 1)


def among_blocks(seed):
    """Waves with blocks in and beside them, in one tree, and those waves with a tree of their own beside that of the blocks."""
    rng = np.random.default_rng(seed)
    part = waves.triangles(int(rng.integers(2, 14)))
    corners = [(low, low + rng.uniform(0.5, 12.0, 3)) for low in rng.uniform((-5, -5, -8), (40, 40, 10), (rng.integers(1, 4), 3))]
    added = np.concatenate([box(low, high) for low, high in corners])
    vertex, face = np.concatenate([part, added]), np.repeat(np.array([1, -1], np.int32), [len(part), len(added)])
    weight = (face < 0).astype(np.int8)
    one = Obstacles(Triangles(vertex, face, 0.01, ()), weight)
    own = Obstacles(Triangles(part, face[: len(part)], 0.01, ()))
    rest = {"chord_error": 0.01, "missing": (), "measured": (), "loose": (), "errors": ()}
    two = Obstacles(AddedTriangles(part, added, face, **rest), weight, first=len(part)).among(own)
    return rng, one, two, own


@settings(max_examples=25, deadline=None)
@given(SEEDS)
def test_bodies_enclose_as_much_in_a_second_tree(seed):
    rng, one, two, _ = among_blocks(seed)
    points = rng.uniform((-8, -8, -10), (55, 55, 25), (400, 3))
    said = []
    for each in (one, two):
        winding, near, inside = np.empty(400), np.empty(400, bool), np.empty(400, bool)
        windings(points, each.solids, winding)
        near_shell(points, 0.8, each.solids, near)
        far_inside(points, 0.3, each.solids, inside)
        said.append((winding, near, inside))
    np.testing.assert_allclose(said[0][0], said[1][0], atol=0.05)
    np.testing.assert_array_equal(said[0][1:], said[1][1:])
    np.testing.assert_array_equal(one.corners, two.corners)
    low = rng.uniform((-8, -8, -10), (40, 40, 5))
    high = low + rng.uniform(0.0, 20.0, 3)
    vertex = one.triangles.vertex
    expected = np.flatnonzero(((vertex.max(axis=1) >= low) & (vertex.min(axis=1) <= high)).all(axis=1))
    for each in (one, two):
        np.testing.assert_array_equal(each.rows_in(low, high), expected)
    up = rng.normal(size=3)
    assert (two.lowest(up) @ up).min() == pytest.approx((vertex @ up).min(), abs=1e-12)


@settings(max_examples=25, deadline=None)
@given(SEEDS)
def test_a_rough_sum_calls_no_point_outside_that_may_be_inside(seed):
    """Of bodies that lack some of their triangles, next to these, too."""
    rng, one, _, _ = among_blocks(seed)
    blocks = one.triangles.vertex[one.weight > 0]
    blocks = divided(blocks, blocks.min(axis=(0, 1)), blocks.max(axis=(0, 1)), rng.uniform(0.5, 4.0))
    blocks = blocks[rng.random(len(blocks)) < rng.choice([0.8, 0.95, 1.0])]
    solids = Obstacles(Triangles(blocks, np.ones(len(blocks), np.int32), 0.01, ()), np.ones(len(blocks), np.int8)).solids
    solids = solids._replace(cell=np.zeros_like(solids.cell))
    middle = blocks[rng.integers(len(blocks), size=300)].mean(axis=1)
    points = middle + rng.normal(size=(300, 3)) * 10.0 ** rng.uniform(-3.0, 1.0, (300, 1))
    winding, stack = np.empty(300), np.empty(64, np.int64)
    windings(points, solids, winding)
    outside = np.array([plainly_outside(*point, solids, stack) for point in points.tolist()])
    assert winding[outside].max(initial=0.0) < 0.2
    assert outside[winding < 0.02].all()


@settings(max_examples=15, deadline=None)
@given(SEEDS)
def test_the_same_stands_in_a_cutters_way_in_a_second_tree(seed):
    rng, one, two, _ = among_blocks(seed)
    made, contacts = assembly(Cutter.parse("D6L40rc3F20S6"), 0.02, 0.0), waves.samples(7)
    n, tool = 49, tool_of(made)
    tilt = rng.uniform(0, 1.2, n)
    axis = np.cos(tilt)[:, None] * contacts.normal + np.sin(tilt)[:, None] * contacts.direction_max
    postures = np.arange(n), contacts.point, contacts.normal
    outline, said = np.array([[6.0, 40.0, 10.0, 45.0]]), []
    for each in (one, two):
        stands, triangle, which = np.zeros(n, bool), np.zeros(n, np.int32), np.zeros(n, np.int32)
        free(*postures, axis, contacts.direction_max, tool, each.solids, stands)
        probe(*postures, axis, contacts.direction_max, tool, each.tree, triangle, which)
        stick_out, most = np.zeros(n), np.zeros(n, np.int32)
        least_stick_outs(*postures, contacts.direction_max, tilt, tool, outline, 20.0, each.tree, stick_out, most)
        said.append((stands, triangle >= 0, triangle == -2, stick_out))
        for found in (*triangle[triangle >= 0].tolist(), *most[most >= 0].tolist()):
            np.testing.assert_array_equal(each.tree.corners(found), each.triangles.vertex[each.order[found]])
    for here, there in zip(*said, strict=True):
        np.testing.assert_array_equal(here, there)


def test_a_part_has_one_tree_in_all_setups():
    scene = Scene.of(block(40.0, 30.0, 20.0))
    alone = scene.surround()
    first = alone.certain.tree
    held = [scene.surround_held(axis, "table") for axis in ((0.0, 0.0, 1.0), (1.0, 0.0, 0.0))]
    for each in held:
        assert each.possible.tree.vertex is first.vertex
        assert each.possible.tree.box is first.box
        assert np.shares_memory(each.possible.triangles.shared, alone.certain.triangles.vertex)
        assert len(each.possible.tree.more_vertex) == 12
    # Elsewhere it is made again, and the same.
    again = pickle.loads(pickle.dumps(held[0].possible))
    assert again.triangles == Triangles(*(getattr(held[0].possible.triangles, name) for name in Triangles.__slots__))
    for here, there in zip(again.tree, held[0].possible.tree, strict=True):
        np.testing.assert_array_equal(here, there)
