"""Places along a flank, against many places that are each tried as a posture."""

import numpy as np
import pytest

from cad_io.arrays import Triangles
from plan_cutters import Cutter
from plan_cutters.domain.assembly import assembly
from plan_cutters.domain.holder import Segment
from plan_cutters.kernels.rows import Contacts
from plan_cutters.kernels.search.flats_and_flanks import FREE, NONE, UNKNOWN, along_flank
from plan_cutters.kernels.search.search import probe
from plan_cutters.scene.conditions import tool_of
from plan_cutters.scene.obstacles import Obstacles

UP = np.array([[0.0, 0.0, 1.0]])
CUTTERS = {
    "necked": Cutter.parse("D12L60F20N7x25S12"),
    "slot": Cutter(
        8.0, 50.0, 0.0, shape="form", outline=((0, 0), (8, 0), (8, 6), (3, 6)), neck=Segment(3.0, 30.0), shank_radius=4.0
    ),
    "dovetail": Cutter.flat(
        radius=7.0, length=40.0, flutes=9.0, taper=np.radians(-20.0), neck=Segment(3.0, 15.0), shank_radius=3.5
    ),
}


def scenes(count, seed):
    """Triangles (k, 3, 3) beside a wall in the plane x = 0, out of it."""
    rng = np.random.default_rng(seed)
    for _ in range(count):
        k = int(rng.integers(1, 6))
        middle = np.column_stack([rng.uniform(1, 12, k), rng.uniform(-8, 8, k), rng.uniform(-14, 40, k)])
        corner = middle[:, None] + rng.uniform(-3, 3, (k, 3, 3))
        corner[:, :, 0] = np.maximum(corner[:, :, 0], 0.3)
        yield corner


def upright(cutter):
    """The contact of a tool along Z whose flank lies along a surface, and that flank."""
    (flank,) = assembly(cutter, 0.0, 0.0).flanks
    normal = np.array([[np.sin(flank.tilt), 0.0, np.cos(flank.tilt)]])
    return Contacts(np.zeros((1, 3)), normal, np.array([[0.0, 1.0, 0.0]]), np.zeros((1, 2))), flank


def solved(corner, cutter, away=(0.0,), hint=-1):
    contact, flank = upright(cutter)
    tool = tool_of(assembly(cutter, 0.0, 0.0))
    solids = Obstacles(Triangles(corner, np.ones(len(corner), np.int32), 0.0, ())).solids
    state, shift, reason = np.zeros(1, np.int8), np.zeros((1, 3)), np.zeros(1, np.uint8)
    along_flank(
        np.zeros(1, np.int64), UP, contact, (flank.mode, flank.length), np.array(away), tool, solids, 0.5, state, shift, reason,
        np.array([hint]),
    )  # fmt: skip
    return int(state[0]), shift[0], contact, flank, tool, solids


def free_at(slide, contact, flank, tool, solids):
    """At which slides (n,) the tool meets nothing."""
    n = len(slide)
    axis, normal = np.repeat([[0.0, 0.0, 1.0]], n, axis=0), np.repeat(contact.normal, n, axis=0)
    f = (axis - np.cos(flank.tilt) * normal) / np.sin(flank.tilt)
    triangle, which = np.empty(n, np.int32), np.empty(n, np.int32)
    probe(np.arange(n), -slide[:, None] * f, normal, axis, f, tool, solids.tree, triangle, which)
    return triangle == -1


@pytest.mark.parametrize("name", CUTTERS)
def test_a_place_is_found_just_where_there_is_one(name):
    cutter, counts = CUTTERS[name], {FREE: 0, NONE: 0}
    for corner in scenes(200, 11):
        state, shift, contact, flank, tool, solids = solved(corner, cutter)
        slide = np.linspace(0.0, flank.length, 2000)
        if state == FREE:
            there = np.linalg.norm(shift)
            assert there <= flank.length + 1e-9
            assert free_at(np.array([there]), contact, flank, tool, solids).all()
        else:
            assert state == NONE
            open_ = free_at(slide, contact, flank, tool, solids)
            # Places that are narrower than a thousandth of a millimetre are none.
            assert not (open_[:-1] & open_[1:]).any()
        counts[state] += 1
    assert min(counts.values()) > 15


@pytest.mark.parametrize("name", CUTTERS)
def test_a_hint_changes_no_answer(name):
    for k, corner in enumerate(scenes(60, 13)):
        state, shift, *_ = solved(corner, CUTTERS[name], (0.0, 0.05))
        for hint in range(0, len(corner), 1 + k % 3):
            hinted = solved(corner, CUTTERS[name], (0.0, 0.05), hint)
            assert hinted[0] == state
            assert (hinted[1] == shift).all()


def test_what_keeps_off_the_surface_may_serve():
    """What stands out of the wall by 0.05 is passed at 0.1, not at 0."""
    corner = np.array([[[0.05, -40.0, -99.0], [0.05, 40.0, -99.0], [0.05, 0.0, 99.0]]])
    assert solved(corner, CUTTERS["necked"])[0] == NONE
    state, shift, contact, *_ = solved(corner, CUTTERS["necked"], (0.0, 0.1))
    assert state == FREE
    assert shift @ contact.normal[0] == pytest.approx(0.1)


def test_what_is_no_number_is_in_the_way():
    corner = np.array([[[5.0, 0, 5], [6.0, 0, 5], [5.0, 1, 6]], [[5.0, 0, 9], [6.0, 0, 9], [5.0, 1, 9]]])
    contact, flank = upright(CUTTERS["slot"])
    solids = Obstacles(Triangles(corner, np.ones(2, np.int32), 0.0, ())).solids
    broken = solids.tree.vertex.copy()
    broken[0, 1] = np.nan
    state = np.zeros(1, np.int8)
    tool, solids = tool_of(assembly(CUTTERS["slot"], 0.0, 0.0)), solids._replace(tree=solids.tree._replace(vertex=broken))
    along_flank(np.zeros(1, np.int64), UP, contact, (flank.mode, flank.length), np.zeros(1), tool, solids, 0.5, state,
                np.zeros((1, 3)), np.zeros(1, np.uint8), np.full(1, -1))  # fmt: skip
    assert state[0] in (NONE, UNKNOWN)
