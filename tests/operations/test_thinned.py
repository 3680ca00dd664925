"""The fastest operations are chosen at some of the samples, and made of all."""

import numpy as np
import pytest

from plan_cutters import plan
from plan_cutters.operations import planning
from plan_cutters.operations import task as thinned
from plan_cutters.scene.conditions import Context
from tests.support.places import SAMPLES
from tests.support.serving import serves
from tests.support.shapes import trough

OPTIONS = {"cutters": ["R2L60rc1", "R3L60rc1.5"], "operations": "fastest", "feed": 1000.0, "area_budget": 0}


@pytest.fixture
def few(monkeypatch):
    """Tasks whose choice was made at some samples."""
    tasks, real = [], thinned.thinned

    def made(task):
        tasks.append((task, real(task, 60)))
        return tasks[-1][1]

    monkeypatch.setattr(planning, "thinned", made)
    return tasks


def test_some_samples_stand_for_the_area_of_all(few):
    plan(trough(10.0, 10.0), grid=25, **OPTIONS)
    ((task, some),) = few
    assert 30 <= len(some.rows) < len(task.rows) / 2
    assert np.isin(some.rows, task.rows).all()
    area, whole = some.ready.samples.area, task.ready.samples.area[task.rows].sum()
    assert area[some.rows].sum() == pytest.approx(whole)
    assert not area[np.setdiff1d(np.arange(len(area)), some.rows)].any()
    assert thinned.thinned(task, len(task.rows)) is task


def test_what_is_chosen_at_some_samples_serves_all_and_takes_hardly_longer(few, monkeypatch):
    """No sample that is reached is dropped; each stands free with its operation; the time is that of a choice at all."""
    result = plan(trough(10.0, 10.0), grid=17, **OPTIONS)
    ((task, _),) = few
    (made, *_) = result.answers.operations.plans
    assert (made.label[task.rows] >= 0).all()
    for each in made.operations:
        if each.axis is not None:
            context = Context.of(each.cutter, task.ready.setups[each.setup])
            wall = made.strategy[each.rows] == 2
            assert serves(each.rows[~wall], each.axis, task.ready.samples, context).all()
    few.clear()
    monkeypatch.setattr(planning, "thinned", lambda task: task)
    whole = plan(trough(10.0, 10.0), grid=17, **OPTIONS).answers.operations.plans[0]
    assert made.total <= 1.05 * whole.total


def test_what_only_one_cutter_reaches_is_told_of_all_samples(few):
    """A ball of 3 mm does not reach all of a trough that a ball of 2 mm does."""
    result = plan(trough(2.5, 10.0), grid=25, **{**OPTIONS, "cutters": ["R2L60rc2", "R3L60rc3"]})
    worth, verdicts = result.plan.operations.cutters, result.reaches
    reached = {each: verdicts[each].reached for each in verdicts}
    assert len(worth) == 2
    for each in worth:
        (other,) = (reached[one] for one in reached if one != each.id)
        assert each.only_mm2 == pytest.approx(result.samples.area[reached[each.id] & ~other].sum())
    assert (reached["R2L60rc2"] & ~reached["R3L60rc3"]).sum() > 60


def test_the_fastest_alone_says_nothing_of_the_fewest():
    found = plan(SAMPLES / "v_groove.step", grid=5, **{**OPTIONS, "cutters": "R3L80rc3"}).plan.operations
    assert found.fewest is None
    assert found.fastest.bound_seconds <= found.fastest.seconds
