"""Orientations that a machinist would write, in place of those that a search finds."""

import math
from dataclasses import replace

import numpy as np
import pytest

from plan_cutters import plan
from plan_cutters.domain.operations import columns_of
from plan_cutters.operations import planning
from plan_cutters.operations.canonical import canonical
from tests.support.cad_parts import box
from tests.support.serving import serves
from tests.support.shapes import ridge, trough

OPTIONS = {"faces": "all", "area_budget": 0, "feed": 1000.0, "machine": "trunnion-ac", "grid": 7}
EQUAL = 1.02 + 1e-9


def exchanges(shape, monkeypatch, cutters="R2L60rc1", **options):
    """The exchanges of a plan: its task, and the columns of each choice before and behind them."""
    seen = []

    def spied(task, columns, **_):
        seen.append((task, columns, canonical(task, columns)))
        return seen[-1][2]

    monkeypatch.setattr(planning, "canonical", spied)
    return plan(shape, **{**OPTIONS, "cutters": cutters, "operations": "both", **options}).plan, seen


def columns_at(task, *angles):
    angle, axis = task.orientations[0].set_to(np.array(angles, float))
    return columns_of(axis, angle)


def served(task, columns):
    """By the test of a single axis, sample by sample."""
    context = task.probes.contexts
    by = [serves(task.rows, columns.axis[k], task.ready.samples, context[columns.cutter[k]][columns.setup[k]])
          for k in range(len(columns))]  # fmt: skip
    return np.logical_or.reduce(by)


@pytest.mark.slow("searches long", only=("box", "trough"))
@pytest.mark.parametrize("shape", [box(), trough(10.0, 10.0), ridge(10.0, 10.0)], ids=["box", "trough", "ridge"])
def test_a_choice_serves_afterwards_what_it_served_before(shape, monkeypatch):
    _, seen = exchanges(shape, monkeypatch, cutters=["R2L60rc1", "R4L60rc4"])
    assert seen
    for task, before, after in seen:
        assert (served(task, after) >= served(task, before)).all()
        assert len(after) <= len(before)
        # Judged as written: the axis is that of the angles.
        angle, axis = task.orientations[0].set_to(after.angle)
        assert np.array_equal(angle, after.angle)
        assert np.array_equal(axis, after.axis)


@pytest.fixture(scope="module")
def task():
    """Of a ridge that one orientation serves, and others near to it do as well."""
    with pytest.MonkeyPatch.context() as patch:
        _, seen = exchanges(ridge(10.0, 10.0), patch, tilt_deg=(0.0, 100.0))
    return seen[0][0]


def test_angles_beside_the_setup_axis_become_it(task):
    after = canonical(task, columns_at(task, (12.345, 17.013)))
    assert len(after) == 1
    assert after.angle.tolist() == [[0.0, 0.0]]


def test_where_the_setup_axis_serves_less_nothing_is_lost(task):
    before = columns_at(task, (0.0, 61.237), (180.0, 61.237))
    after = canonical(task, before)
    assert (served(task, after) >= served(task, before)).all()
    assert np.array_equal(after.angle, np.round(after.angle, 1))


def test_what_is_nearer_than_the_accuracy_is_one(task, monkeypatch):
    """With no other orientation to be had in its place."""
    monkeypatch.setattr("plan_cutters.operations.canonical._preferred", lambda choice, *_: choice)
    monkeypatch.setattr("plan_cutters.operations.canonical._shortened", lambda choice, *_: choice)
    before = columns_at(task, (0.0, 5.111), (0.0, 5.151))
    assert len(canonical(task, before)) == 1
    finer = replace(task.ready, options=replace(task.ready.options, axis_accuracy=math.radians(0.03)))
    assert len(canonical(replace(task, ready=finer), before)) == 2


def test_axes_that_lock_keep_their_angles(monkeypatch):
    written, seen = exchanges(box(), monkeypatch, index_step_deg=7.5)
    assert all(after is before for _, before, after in seen)
    for each in written.operations.plans[0].operations:
        angles = np.array(list(each.angles_deg.values()))
        assert np.allclose(angles / 7.5, np.round(angles / 7.5))
