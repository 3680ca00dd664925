"""Tool axes with which a flank lies along a face: at the angle asked for, held by the machine, and as near as can be."""

from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from cad_io.arrays import Triangles
from plan_cutters import Machine, PostureRange
from plan_cutters.domain.kinematics import Kinematics
from plan_cutters.kernels.rows import Contacts
from plan_cutters.scene.conditions import Conditions
from plan_cutters.scene.fixed_axis import tilt_direction_of
from plan_cutters.scene.flats_and_flanks import _at_angle, _axes, _nearest, _special, _turned
from plan_cutters.scene.obstacles import Obstacles
from plan_cutters.scene.surroundings import Surroundings
from plan_cutters.setups import solids

SEEDS = st.integers(0, 2**32 - 1)
AROUND = Surroundings.sheet(Obstacles(Triangles(solids.box(np.zeros(3), np.ones(3)), np.ones(12, np.int32), 0.0, ())))


def units(rng, count=None):
    way = rng.normal(size=(count or 1, 3))
    way /= np.linalg.norm(way, axis=1)[:, None]
    return way if count else way[0]


def conditions(machine="unlimited", setup=(0.0, 0.0, 1.0), **how):
    postures = PostureRange(**how) if how else PostureRange()
    return Conditions(Machine.parse(machine), np.array(setup), postures, AROUND, 0.01, 1)


def circle(kinematics, count=5000):
    """All axes of a machine with one axis that turns its tool, by Rodrigues' formula."""
    [d], tool = kinematics.direction, kinematics.tool
    turn = np.linspace(0.0, 2.0 * np.pi, count)[:, None]
    return np.cos(turn) * tool + np.sin(turn) * np.cross(d, tool) + (1.0 - np.cos(turn)) * (d @ tool) * d


@settings(max_examples=25, deadline=None)
@given(SEEDS, st.floats(-0.99, 0.99))
def test_axes_at_an_angle_are_all_those_that_the_machine_holds_at_it(seed, cosine):
    rng = np.random.default_rng(seed)
    kinematics = Kinematics(units(rng, 1), np.array([[-np.inf, np.inf]]), units(rng))
    assume(abs(kinematics.direction[0] @ kinematics.tool) < 0.999)
    normal = units(rng, 20)
    made = np.stack(list(_at_angle(normal, cosine, kinematics)))
    known = np.isfinite(made).all(axis=2)
    n = np.broadcast_to(normal, made.shape)
    assert np.linalg.norm(made[known], axis=1) == pytest.approx(1.0)
    assert (made[known] * n[known]).sum(axis=1) == pytest.approx(cosine, abs=1e-7)
    assert made[known] @ kinematics.direction[0] == pytest.approx(kinematics.tool @ kinematics.direction[0], abs=1e-7)
    share = normal @ circle(kinematics).T - cosine
    crossed = (np.diff(np.sign(share), axis=1) != 0).sum(axis=1)
    assert (known[0] == known[1]).all()
    near = np.minimum(np.abs(share.max(axis=1)), np.abs(share.min(axis=1))) < 1e-2
    assert ((crossed == 2) == known[0])[~near].all()
    both = known[0] & ~near
    assert (np.linalg.norm(made[0] - made[1], axis=1)[both] > 1e-3).all()


def test_a_machine_that_turns_no_tool_has_its_axis_at_that_angle_or_none():
    tool = np.array([0.0, 0.6, 0.8])
    still = Kinematics(np.zeros((0, 3)), np.zeros((0, 2)), tool)
    normal = np.array([[0.0, 0.8, -0.6], [1.0, 0.0, 0.0], [0.0, 0.6, 0.8], [0.0, 0.8, -0.599]])
    [made] = _at_angle(normal, 0.0, still)
    assert np.isfinite(made).all(axis=1).tolist() == [True, True, False, False]
    assert made[:2] == pytest.approx(np.array([tool, tool]))


@settings(max_examples=50, deadline=None)
@given(SEEDS, st.sampled_from(["3-axis", "4-axis-a", "trunnion-bc", "trunnion-ac", "unlimited", "nutating-bc"]))
def test_the_nearest_axis_that_a_machine_may_hold(seed, machine):
    rng = np.random.default_rng(seed)
    there = conditions(machine, tuple(units(rng)))
    axis = units(rng, 10)
    made = _nearest(axis, there)
    kinematics = None if there.kinematics is None else there.kinematics.turning()[0]
    if kinematics is None or len(kinematics.direction) != 1:
        wanted = there.setup if kinematics is None else kinematics.tool
        assert made == pytest.approx(np.broadcast_to(wanted, made.shape))
        return
    every = circle(kinematics)
    assert made == pytest.approx(every[(axis @ every.T).argmax(axis=1)], abs=2e-3)
    # Along the axis of rotation all are as near.
    [level] = _nearest(kinematics.direction, there)
    assert level == pytest.approx(kinematics.tool)


@pytest.mark.parametrize("machine", ["3-axis", "4-axis-a", "trunnion-bc", "trunnion-ac", "unlimited", "tilt:30"])
def test_axes_along_which_faces_may_be_a_little_off_are_held_and_each_is_there_once(machine):
    there = conditions(machine)
    special = _special(there)
    assert there.allows(special).all()
    assert special[0] == pytest.approx([0.0, 0.0, 1.0])
    apart = np.abs(special[:, None] - special[None]).max(axis=2) + np.eye(len(special))
    assert (apart > 1e-9).all()
    every = [each for each in there.ranges.rotary.aim if there.allows(each[None])[0]]
    assert all(np.abs(special - each).max(axis=1).min() < 1e-9 for each in every)


@settings(max_examples=30, deadline=None)
@given(SEEDS, st.floats(-3.0, 3.0), st.floats(0.1, 6.2))
def test_a_flank_leans_as_the_rotations_let_it(seed, first, more):
    rng = np.random.default_rng(seed)
    more = min(more, 2.0 * np.pi - 1e-3 - max(0.0, first))
    normal = units(rng, 30)
    direction = np.cross(normal, units(rng, 30))
    direction /= np.linalg.norm(direction, axis=1)[:, None]
    axis = units(rng, 30)
    axis[3], axis[4], axis[5] = np.nan, normal[4], -normal[5]
    contacts = SimpleNamespace(normal=normal, direction_max=direction)
    rows = np.arange(30)
    lean = np.arctan2((axis * np.cross(normal, direction)).sum(axis=1), (axis * direction).sum(axis=1))
    within = (lean - first) % (2.0 * np.pi) <= more
    # Not where there is no axis, nor along the normal.
    within[3:6] = False
    some, made = _turned(rows, axis, contacts, conditions(rotation=(first, first + more)))
    assert some.tolist() == np.flatnonzero(within).tolist()
    assert np.array_equal(made, axis[some])
    some, _ = _turned(rows, axis, contacts, conditions())
    assert some.tolist() == [row for row in range(30) if row not in (3, 4, 5)]
    some, _ = _turned(rows, axis, contacts, conditions("tilt:70"))
    assert some.tolist() == [row for row in range(30) if row not in (3, 4, 5) and axis[row, 2] >= np.cos(np.radians(70))]


@given(SEEDS)
def test_a_tilt_direction_is_what_of_the_axis_lies_across_the_normal(seed):
    rng = np.random.default_rng(seed)
    normal, axis = units(rng, 8), units(rng)
    normal[2], normal[5] = axis, -axis
    samples = SimpleNamespace(normal=normal, direction_max=units(rng, 8))
    rows = np.array([5, 2, 0, 7])
    made = tilt_direction_of(rows, axis, samples)
    assert made[:2] == pytest.approx(samples.direction_max[rows[:2]])
    n = normal[rows[2:]]
    assert (made[2:] * n).sum(axis=1) == pytest.approx(0.0, abs=1e-12)
    assert np.linalg.norm(made[2:], axis=1) == pytest.approx(1.0)
    cosine = n @ axis
    assert cosine[:, None] * n + np.sqrt(1.0 - cosine**2)[:, None] * made[2:] == pytest.approx(np.broadcast_to(axis, (2, 3)))


@settings(max_examples=20, deadline=None)
@given(SEEDS, st.sampled_from(["3-axis", "4-axis-a", "trunnion-ac", "unlimited", "tilt:30"]), st.floats(1.2, 1.6))
def test_along_a_flank_every_axis_is_tried_that_the_machine_holds_at_its_tilt(seed, machine, tilt):
    """One rotary axis has two of them, wherever they lie between the rotations of a search; each is held, at that tilt."""
    rng, there = np.random.default_rng(seed), conditions(machine)
    normal = np.concatenate([units(rng, 12), np.array([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.6, 0.8]])])
    direction = np.cross(normal, units(rng, 15))
    direction /= np.linalg.norm(direction, axis=1)[:, None]
    contacts = Contacts(np.zeros((15, 3)), normal, direction, np.zeros((15, 2)))
    flank = SimpleNamespace(tilt=tilt, length=20.0)
    made = list(_axes(contacts, np.ones(15, np.int32), np.arange(15), flank, there))
    tried = np.concatenate([np.column_stack([rows, axis]) for rows, axis, _ in made])
    assert there.allows(tried[:, 1:]).all()
    exact = np.abs((tried[:, 1:] * normal[tried[:, 0].astype(int)]).sum(axis=1) - np.cos(tilt)) < 1e-6
    kinematics = None if there.kinematics is None else there.kinematics.turning()[0]
    if kinematics is None or len(kinematics.direction) > 1:
        # At all rotations that are searched.
        for row in range(15):
            turn, across = there.postures.rotations[:, None], np.cross(normal[row], direction[row])
            lean = np.cos(turn) * direction[row] + np.sin(turn) * across
            axes = np.cos(tilt) * normal[row] + np.sin(tilt) * lean
            assert there.allows(axes).sum() <= (exact & (tried[:, 0] == row)).sum()
        return
    for axes in _at_angle(normal, np.cos(tilt), kinematics):
        held = np.isfinite(axes).all(axis=1)
        held[held] = there.allows(axes[held])
        for row in np.flatnonzero(held).tolist():
            own = tried[tried[:, 0] == row, 1:]
            assert np.abs(own - axes[row]).max(axis=1).min(initial=9.0) < 1e-9
    # Without a length the flank lies along nothing that it does not hold at once.
    bare = list(_axes(contacts, np.ones(15, np.int32), np.arange(15), SimpleNamespace(tilt=tilt, length=0.0), there))
    assert sum(len(rows) for rows, _, _ in bare) <= sum(len(rows) for rows, _, _ in made)
