"""Places of a tool that stands upright on its flat, against all places of a grid, each tried as a posture."""

import numpy as np
import pytest

from cad_io.arrays import Triangles
from plan_cutters import Cutter
from plan_cutters.domain.assembly import assembly
from plan_cutters.kernels.codes import OFFSET_OF
from plan_cutters.kernels.rows import Contacts
from plan_cutters.kernels.search.flats_and_flanks import FORBIDDEN, PLACED, upright
from plan_cutters.kernels.search.search import probe
from plan_cutters.scene.conditions import tool_of
from plan_cutters.scene.obstacles import Obstacles

CUTTERS = {
    "flat": Cutter.flat(radius=5.0, length=40.0),
    "bull nose": Cutter.bull(radius=5.0, corner_radius=1.5, length=40.0),
    "tapered": Cutter.flat(radius=4.0, length=30.0, taper=np.radians(8.0)),
}


def scenes(count, seed):
    """Triangles (k, 3, 3) that stand about a contact at 0 like walls, lie over it, or hang anywhere."""
    rng = np.random.default_rng(seed)
    for _ in range(count):
        k = int(rng.integers(2, 9))
        middle = np.column_stack([rng.uniform(-11, 11, (k, 2)), rng.uniform(0.5, 25, k)])
        corner = middle[:, None] + rng.uniform(-6, 6, (k, 3, 3))
        walls = rng.random(k) < 0.5
        corner[walls, 1, :2] = corner[walls, 0, :2]
        corner[:, :, 2] = np.maximum(corner[:, :, 2], 0.1)
        yield corner


def grid(most):
    """Leans of places, the rim included."""
    share = np.linspace(-1.0, 1.0, 81)
    across = np.stack(np.meshgrid(share, share), axis=-1).reshape(-1, 2)
    turn = np.linspace(0.0, 2.0 * np.pi, 360, endpoint=False)
    every = np.concatenate([across[np.linalg.norm(across, axis=1) < 1.0], np.column_stack([np.cos(turn), np.sin(turn)])])
    every = every[np.linalg.norm(every, axis=1) > 1e-3]
    assert most > 0.0
    return np.column_stack([every, np.zeros(len(every))])


def free_at(lean, tool, solids):
    """Which leans (n, 3) of an upright tool at 0 meet nothing."""
    n = len(lean)
    up = np.repeat([[0.0, 0.0, 1.0]], n, axis=0)
    triangle, which = np.empty(n, np.int32), np.empty(n, np.int32)
    probe(np.arange(n), np.zeros((n, 3)), up, up.copy(), lean, tool, solids.tree, triangle, which)
    return triangle == -1


@pytest.mark.parametrize("name", CUTTERS)
def test_a_place_is_found_just_where_there_is_one(name):
    tool = tool_of(assembly(CUTTERS[name], 0.0, 0.0))
    leans = grid(float(tool.mode[0, OFFSET_OF]))
    contact = Contacts(np.zeros((1, 3)), np.array([[0.0, 0.0, 1.0]]), np.array([[1.0, 0.0, 0.0]]), np.zeros((1, 2)))
    results = {PLACED: 0, FORBIDDEN: 0}
    for corner in scenes(150, 7):
        solids = Obstacles(Triangles(corner, np.ones(len(corner), np.int32), 0.0, ())).solids
        found, lean = np.empty(1, np.int8), np.full((1, 3), np.nan)
        upright(np.zeros(1, np.int64), contact, contact.normal, tool, solids, 0.5, 0.0, found, lean)
        if found[0] == PLACED:
            assert np.linalg.norm(lean) <= 1.0 + 1e-9
            assert free_at(lean, tool, solids).all()
        else:
            assert found[0] == FORBIDDEN
            assert not free_at(leans, tool, solids).any()
        results[int(found[0])] += 1
    assert min(results.values()) > 15


def test_a_tip_without_a_flat_has_no_place_to_look_for():
    tool = tool_of(assembly(Cutter.ball(radius=5.0, length=40.0), 0.0, 0.0))
    contact = Contacts(np.zeros((1, 3)), np.array([[0.0, 0.0, 1.0]]), np.array([[1.0, 0.0, 0.0]]), np.zeros((1, 2)))
    far = np.array([[[99.0, 0, 0], [99.0, 1, 0], [99.0, 0, 1]]])
    found = np.empty(1, np.int8)
    solids = Obstacles(Triangles(far, np.ones(1, np.int32), 0.0, ())).solids
    upright(np.zeros(1, np.int64), contact, contact.normal, tool, solids, 0.5, 0.0, found, np.full((1, 3), np.nan))
    assert found[0] == FORBIDDEN


def test_what_is_no_number_is_in_the_way():
    """A triangle over all places, with a corner that is no point: nothing is found."""
    tool = tool_of(assembly(CUTTERS["flat"], 0.0, 0.0))
    contact = Contacts(np.zeros((1, 3)), np.array([[0.0, 0.0, 1.0]]), np.array([[1.0, 0.0, 0.0]]), np.zeros((1, 2)))
    corner = np.array([[[-99.0, -99, 5], [99.0, -99, 5], [0.0, 99, 5]], [[99.0, 0, 5], [99.0, 1, 5], [99.0, 0, 6]]])
    solids = Obstacles(Triangles(corner, np.ones(2, np.int32), 0.0, ())).solids
    broken = solids.tree.vertex.copy()
    broken[0, 1] = np.nan
    found = np.empty(1, np.int8)
    solids = solids._replace(tree=solids.tree._replace(vertex=broken))
    upright(np.zeros(1, np.int64), contact, contact.normal, tool, solids, 0.5, 0.0, found, np.full((1, 3), np.nan))
    assert found[0] != PLACED
