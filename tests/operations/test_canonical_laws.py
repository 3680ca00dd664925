"""Laws of canonical orientations (`docs/operations_proof.md`, lemmas E1 and E2): a cutter serves a sample from a cone of axes."""

import math
from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from plan_cutters import Machine, PostureRange
from plan_cutters.domain.operations import columns_of
from plan_cutters.operations.canonical import _choice, _merged, _shortened, canonical
from plan_cutters.operations.orientations import DIGITS, Orientations
from plan_cutters.scene.conditions import Conditions
from tests.support.sheets import AROUND

ACCURACY = math.radians(0.05)
WHERE = Orientations.of(Conditions(Machine.parse("unlimited"), np.array([0.0, 0.0, 1.0]), PostureRange(), AROUND, 0.01, 1))


def columns_at(angle, cutter):
    shown, axis = WHERE.set_to(np.asarray(angle, float))
    assert len(shown) == len(cutter)
    some = columns_of(axis, shown)
    return type(some)(np.asarray(cutter, np.int32), some.setup, some.axis, some.angle)


def task_of(centre, radius):
    """Samples that cutters serve from axes within a radius (n, cutters), rad, of a centre (n, cutters, 3): far ones cost more."""
    n, cutters = radius.shape
    normal = np.tile([0.0, 0.0, 1.0], (n, 1))
    samples = SimpleNamespace(normal=normal, face=np.ones(n, int), area=np.ones(n), unjudged=np.full(n, -1))
    options = SimpleNamespace(index_step=None, accuracy=ACCURACY)

    def cost(columns):
        away = 2.0 * np.arcsin(0.5 * np.linalg.norm(centre[:, columns.cutter] - columns.axis, axis=2))
        most = radius[:, columns.cutter]
        return np.where(away <= most, 1.0 + 0.01 * away / np.maximum(most, 1e-9), np.inf)

    return SimpleNamespace(
        ready=SimpleNamespace(samples=samples, options=options), rows=np.arange(n), orientations=(WHERE,),
        cutters=[None] * cutters, paths=SimpleNamespace(feed=None), cost=cost,
        table=lambda rows, columns: np.isfinite(cost(columns))[rows],
    )  # fmt: skip


@pytest.fixture(autouse=True, scope="module")
def made_up():
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("plan_cutters.operations.canonical.costs_with", lambda task, columns: (None, task.cost(columns)))
        patch.setattr("plan_cutters.operations.canonical.clearance_of", lambda task, operation: 0.0)
        yield


def made(seed, bundles=2, most=6):
    """Columns in a few bundles narrower than the accuracy of the axes, and samples that are served from axes next to these."""
    rng = np.random.default_rng(seed)
    middle = rng.uniform((-170.0, 5.0), (170.0, 90.0), (int(rng.integers(1, bundles + 1)), 2))
    cutter = rng.integers(0, 2, int(rng.integers(2, most + 1)))
    columns = columns_at(middle[rng.integers(len(middle), size=len(cutter))] + rng.uniform(-0.02, 0.02, (len(cutter), 2)), cutter)
    n = 12
    near = columns.axis[rng.integers(len(columns), size=(n, 2))]
    centre = near + math.radians(0.02) * rng.uniform(-1.0, 1.0, (n, 2, 3))
    centre /= np.linalg.norm(centre, axis=2)[:, :, None]
    return task_of(centre, np.radians(rng.choice([0.0, 0.01, 0.03, 0.3, 30.0], (n, 2)))), columns


@given(st.integers(0, 2**31))
@settings(max_examples=60, deadline=None)
def test_what_a_choice_serves_it_serves_afterwards_as_it_is_written(seed):
    task, columns = made(seed)
    after = canonical(task, columns)
    before, now = task.cost(columns).min(axis=1), task.cost(after).min(axis=1)
    assert (np.isfinite(now) >= np.isfinite(before)).all()
    # As many at most, each with the axis of its angles, which a control shows.
    assert len(after) <= len(columns)
    assert np.array_equal(after.angle, np.round(after.angle, DIGITS))
    assert np.array_equal(after.axis, WHERE.kinematics.axis(np.radians(after.angle)))
    assert now[np.isfinite(now)].sum() <= 1.02 * before[np.isfinite(before)].sum() + 1e-9


@given(st.integers(0, 2**31))
@settings(max_examples=300, deadline=None)
def test_orientations_become_one_only_where_all_stays_served(seed):
    task, columns = made(seed, bundles=1, most=8)
    choice = _choice(task, columns, task.cost(columns))
    assert (_merged(choice, 1.02 * choice.cutting).served >= choice.served).all()


def test_what_goes_serves_nothing_when_others_are_exchanged():
    """Two cutters reach a sample, each at an orientation of its own next to a third one: one of the two stays as it is."""
    columns = columns_at([(20.0, 30.0), (20.02, 30.0), (20.0, 30.02)], [0, 0, 1])
    centre = np.repeat(columns.axis[:1, None], 12, axis=0).repeat(2, axis=1)
    radius = np.full((12, 2), math.radians(0.001))
    centre[:2, 0], centre[:2, 1] = columns.axis[1], columns.axis[2]
    centre[2:4, 1] = columns.axis[2]
    radius[2:4, 0] = math.radians(1.0)
    task = task_of(centre, radius)
    choice = _choice(task, columns, task.cost(columns))
    merged = _merged(choice, 1.02 * choice.cutting)
    assert (np.isfinite(task.cost(merged.columns)).any(axis=1) >= choice.served).all()


@given(st.integers(0, 2**31))
@settings(max_examples=60, deadline=None)
def test_an_axis_is_written_shorter_within_the_accuracy_of_the_axes(seed):
    task, columns = made(seed)
    choice = _choice(task, columns, task.cost(columns))
    for k in range(len(columns)):
        after = _shortened(choice, k, 1.02 * choice.cutting).columns
        assert np.linalg.norm(after.axis - columns.axis, axis=1).max() <= ACCURACY
        assert np.array_equal(np.delete(after.axis, k, axis=0), np.delete(columns.axis, k, axis=0))


@given(st.integers(0, 2**31))
@settings(max_examples=60, deadline=None)
def test_digits_of_a_control_turn_an_axis_by_no_more_than_half_of_the_last_one_of_each_rotary_axis(seed):
    angle = np.random.default_rng(seed).uniform((-170.0, -170.0), (170.0, 170.0), (50, 2))
    _, axis = WHERE.set_to(angle)
    off = np.linalg.norm(axis - WHERE.kinematics.axis(np.radians(angle)), axis=1)
    assert off.max() <= math.radians(10.0**-DIGITS) * (1.0 + 1e-6)
