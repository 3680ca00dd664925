"""Laws of repeated orientations (`docs/operations_proof.md`, lemmas P3 and P4), on made-up samples of one copy."""

import math
from dataclasses import replace
from itertools import combinations
from types import SimpleNamespace

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from plan_cutters import Machine, PostureRange
from plan_cutters.domain.operations import Columns
from plan_cutters.operations.by_pattern import _apart
from plan_cutters.operations.fastest import Costs, Problem, cheap
from plan_cutters.operations.orientations import DIGITS, Indexing, Orientations
from plan_cutters.operations.symmetry import Symmetry
from plan_cutters.scene.conditions import Conditions
from tests.support.located import located
from tests.support.sheets import AROUND

Z = np.array([0.0, 0.0, 1.0])


def orientations(rates=(None, None)):
    """Those of a trunnion; `rates` in rad/s, of C and of A."""
    machine = Machine.parse("trunnion-ac")
    turning = [replace(each, rate=rate) for each, rate in zip(machine.rotary, rates, strict=True)]
    axes = [next((one for one in turning if one.name == each.name), each) for each in machine.axes]
    return Orientations.of(Conditions(replace(machine, axes=tuple(axes)), Z, PostureRange(), AROUND, 0.01, 1))


def columns_at(where, angle):
    shown, axis = where.set_to(np.asarray(angle, float))
    some = np.zeros(len(shown), np.int32)
    return Columns(some, some, axis, shown)


@given(st.integers(0, 2**31), st.integers(2, 60))
@settings(max_examples=25, deadline=None)
def test_an_image_is_the_axis_turned_as_well_as_a_control_shows_it(seed, order):
    where, rng = orientations(), np.random.default_rng(seed)
    base = columns_at(where, rng.uniform((-180.0, -30.0), (180.0, 110.0), (5, 2)))
    images = Symmetry(np.zeros(3), Z, order, True, (where,)).images(base)
    assert np.array_equal(images.axis, where.kinematics.axis(np.radians(images.angle)))
    for k in range(order):
        turned = Rotation.from_rotvec(2.0 * math.pi * k / order * Z).apply(base.axis)
        assert np.linalg.norm(images.axis[k::order] - turned, axis=1).max() <= math.radians(0.5 * 10.0**-DIGITS) * (1.0 + 1e-6)
        assert np.array_equal(images.angle[k::order, 1], base.angle[:, 1])


@given(st.integers(0, 2**31), st.sampled_from([None, (0.2, 3.0), (3.0, 0.2), (1.0, 1.0)]))
@settings(max_examples=25, deadline=None)
def test_no_choice_of_images_takes_less_than_the_bound_of_one_copy(seed, rates):
    """With rates a choice takes what the axes take between its own orientations, not between those of the first column."""
    rng, order, n = np.random.default_rng(seed), 3, 3
    where = orientations((None, None) if rates is None else rates)
    base = columns_at(where, rng.uniform((-180.0, -20.0), (180.0, 110.0), (2, 2)))
    images = Symmetry(np.zeros(3), Z, order, True, (where,)).images(base)
    task = SimpleNamespace(times=order, indexing=Indexing((where,), None))
    cost = np.where(rng.random((n, len(images))) < 0.6, 5.0 * rng.random((n, len(images))), np.inf)
    cost = cost[np.isfinite(cost).any(axis=1)]
    step = task.indexing.constant if rates is None else task.indexing.together(images.of(np.arange(order))) / order
    apart = _apart(task, images, Problem(cost, base.cutter, base.setup, Costs(order * step, 0.0, 0.0)), cost)
    if not len(cost):
        return
    every = [np.array(some) for k in range(1, len(images) + 1) for some in combinations(range(len(images)), k)]
    least = min(apart.cutting(some) + task.indexing.together(images.of(some)) for some in every)
    if rates is None:
        least = min(apart.cutting(some) + task.indexing.constant * len(some) for some in every)
    found = located(apart, cheap(apart))
    assert found.bound <= least * (1.0 + 1e-9)
