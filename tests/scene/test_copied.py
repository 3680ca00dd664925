"""Motions of a part that leave a setup as it is: only where machine, fixtures and what is left out look the same afterwards."""

import math
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from cad_io.arrays import Triangles
from cad_io.part.equal_faces import Motion
from plan_cutters import Fixture, Machine, Options, PostureRange
from plan_cutters.pipeline import prepare
from plan_cutters.scene.conditions import Conditions
from plan_cutters.scene.copied import _keeps_fixtures, _keeps_limits, _same_frames, keeps
from plan_cutters.scene.fixtures import joined
from plan_cutters.scene.obstacles import Obstacles
from plan_cutters.scene.surroundings import Surroundings
from plan_cutters.setups import solids
from tests.support.cad_parts import box

AROUND = Surroundings.sheet(Obstacles(Triangles(solids.box(np.zeros(3), np.ones(3)), np.ones(12, np.int32), 0.0, ())))
X, Z, ORIGIN = np.array([1.0, 0.0, 0.0]), np.array([0.0, 0.0, 1.0]), np.zeros(3)
STILL = Motion(np.eye(3), ORIGIN)
TURN, HALF, OVER = (Motion.turn(ORIGIN, axis, angle) for axis, angle in ((Z, 2.0), (Z, math.pi), (X, math.pi)))
SIDE, TOP = Motion.mirror(ORIGIN, X), Motion.mirror(ORIGIN, Z)
MOTIONS = {"still": STILL, "turn": TURN, "half": HALF, "over": OVER, "side": SIDE, "top": TOP}
#: Machines with fewer than two axes that turn the tool are not asked: rotations are numbered by these.
MACHINES = ["unlimited", "tilt:50", "trunnion-ac", "trunnion-bc", "nutating-bc", "head-table-bc", "head-head-ca"]


def conditions(machine="unlimited", setup=Z, around=AROUND):
    return Conditions(Machine.parse(machine), np.asarray(setup, float), PostureRange(), around, 0.01, 1)


@pytest.mark.parametrize("machine", MACHINES)
@pytest.mark.parametrize("name", MOTIONS)
def test_where_limits_are_kept_the_machine_holds_the_image_of_each_axis_that_it_holds(machine, name):
    there, motion = conditions(machine), MOTIONS[name]
    axis = np.random.default_rng(7).normal(size=(4000, 3))
    axis /= np.linalg.norm(axis, axis=1)[:, None]
    if _keeps_limits(there, motion):
        assert (there.allows(axis) == there.allows(motion.directions(axis))).all()


@pytest.mark.parametrize(
    ("machine", "kept"),
    [
        ("unlimited", {"still", "turn", "half", "over", "side", "top"}),
        # About the setup axis, and across it.
        ("tilt:50", {"still", "turn", "half", "side"}),
        # C goes all round.
        ("trunnion-ac", {"still", "turn", "half", "side"}),
        ("trunnion-bc", {"still", "turn", "half", "side"}),
        ("head-table-bc", {"still", "turn", "half", "side"}),
        ("head-head-ca", {"still", "turn", "half", "side"}),
    ],
)
def test_motions_about_the_axis_next_to_the_part_are_seen_to_keep_limits(machine, kept):
    assert {name for name, motion in MOTIONS.items() if _keeps_limits(conditions(machine), motion)} == kept


def test_only_a_table_across_the_setup_axis_is_carried_onto_itself():
    def kept(words, motion, setup=Z):
        around = joined(AROUND, Fixture.each_of(words), 0.01, {}, tuple(setup)) if words else AROUND
        return _keeps_fixtures(conditions(setup=setup, around=around), motion, 1.0)

    for motion in MOTIONS.values():
        assert kept([], motion)
        assert not kept(["box:1,1,1@5,0,0"], motion)
        assert not kept(["table:-1", "box:1,1,1@5,0,0"], motion)
        assert not kept(["table:-1@0,0,0,0,0,10"], motion), "by angles it lies across its own axis"
    assert [name for name, motion in MOTIONS.items() if kept(["table:-1"], motion)] == ["still", "turn", "half", "side"]
    assert [name for name, motion in MOTIONS.items() if kept(["table:-1"], motion, X)] == ["still", "over", "top"]
    assert kept(["table:-1"], Motion.translation(np.array([5.0, 2.0, 0.0])))
    for along in (0.1, -0.1):
        assert not kept(["table:-1"], Motion.translation(np.array([5.0, 2.0, along])))
        assert kept([], Motion.translation(np.array([5.0, 2.0, along])))


@settings(max_examples=30, deadline=None)
@given(st.integers(0, 2**32 - 1), st.integers(3, 24), st.integers(0, 30))
def test_rotations_agree_where_the_motion_carries_one_onto_another(seed, steps, which):
    """A sample and its image, whose own directions are turned about the normal by a step or by a part of one."""
    rng = np.random.default_rng(seed)
    normal = rng.normal(size=3)
    normal /= np.linalg.norm(normal)
    direction = np.cross(normal, rng.normal(size=3))
    direction /= np.linalg.norm(direction)
    motion = Motion.turn(rng.normal(size=3), Z, float(rng.uniform(0, 6)))
    image, carried = motion.directions(np.stack([normal, direction]))
    postures = PostureRange(step=2.0 * math.pi / steps)
    count = len(postures.rotations)
    turns = np.array([2.0 * math.pi * which / count, 2.0 * math.pi * (which + 0.3) / count])
    across = np.cross(image, carried)
    own = np.cos(turns)[:, None] * carried + np.sin(turns)[:, None] * across
    samples = SimpleNamespace(
        normal=np.stack([normal, image, image]), direction_max=np.stack([direction, *own]), point=np.zeros((3, 3))
    )
    master, number = np.zeros(3, np.int64), np.array([-1, 0, 0], np.int32)
    assert _same_frames(samples, master, number, (motion,), postures).tolist() == [False, True, False]
    # Rotations that do not go all round are those of no other sample.
    some = PostureRange(rotation=(0.0, 6.0), step=2.0 * math.pi / steps)
    assert not _same_frames(samples, master, number, (motion,), some).any()


def test_a_part_that_is_not_known_well_or_of_which_others_are_left_out_looks_different_afterwards():
    ready = prepare(box(), Options.of({"cutters": "R2L40", "faces": "all", "grid": 2, "area_budget": 0, "ignore": "F1"}))
    conditions = ready.conditions
    images = SimpleNamespace(motions=(HALF, SIDE), images=({1: 2, 2: 1}, {1: 1, 2: 2}))
    assert keeps(ready, conditions, SIDE, (images,))
    assert not keeps(ready, conditions, HALF, (images,)), "it carries what is left out onto what is not"
    assert not keeps(ready, conditions, TURN, (images,)), "nobody knows where it carries that"
    whole = prepare(box(), Options.of({"cutters": "R2L40", "faces": "all", "grid": 2, "area_budget": 0}))
    assert all(keeps(whole, whole.conditions, motion, ()) for motion in MOTIONS.values())
    around = whole.conditions.surroundings
    for doubt in ({"missing": ((1, "is torn", "box"),)}, {"lost": ("a face",)}):
        there = replace(whole.conditions, surroundings=replace(around, **doubt))
        assert not keeps(whole, there, STILL, ())
    triangles = replace(around.certain.triangles, loose=((1, 0.1),))
    there = replace(whole.conditions, surroundings=replace(around, certain=replace(around.certain, triangles=triangles)))
    assert not keeps(whole, there, STILL, ())
