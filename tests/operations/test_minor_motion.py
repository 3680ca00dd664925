"""Minor simultaneous motion: fixed orientations that are each worth a turn take its place, and a step of it takes no others."""

import cadquery as cq
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from plan_cutters import plan
from plan_cutters.operations import planning
from plan_cutters.operations.choices import instead_of_motion
from plan_cutters.operations.labels import MINOR_SHARE, Steps, without_minor_steps
from plan_cutters.operations.planning import _first, _stored
from plan_cutters.operations.plans import MINOR_AREA, plan_with

WORDS = {
    "cutters": ["D10L60F26", "D6L60rc3F20"], "operations": "fastest", "feed": 1000.0, "area_budget": 0, "grid": 9, "setup": "+z",
    "machine": "trunnion-ac",
}  # fmt: skip


@pytest.fixture(scope="module", params=[0.15, 3.0], ids=["small", "large"])
def task(request):
    """The task of a block whose lower edges have chamfers of a size, which no tool along z reaches."""
    shape = cq.Workplane().box(60, 40, 20, centered=(True, True, False)).faces("<Z").edges().chamfer(request.param).val()
    (bottom,) = [k for k, face in enumerate(cq.Shape.Faces(shape), 1) if face.BoundingBox().zmax < 1e-6]
    tasks, real = [], planning._task
    with pytest.MonkeyPatch.context() as patched:
        patched.setattr(planning, "_task", lambda *words: tasks.append(real(*words)) or tasks[-1])
        plan(shape, **WORDS, faces=f"!{bottom}")
    return tasks[0]


def test_orientations_take_the_place_of_minor_motion_alone(task):
    area = np.nan_to_num(task.ready.samples.area)
    every = _first(task, 0.6)
    upright = every.of(np.flatnonzero((every.axis[:, 2] > 1.0 - 1e-9) & (every.cutter == 0))[:1])
    made = instead_of_motion(task, upright, lambda rows: _first(task, 0.3).and_(_stored(task, rows)))
    before, after = (plan_with(task, "fastest", columns) for columns in (upright, made))
    moved = [sum(area[each.rows].sum() for each in one.operations if each.axis is None) for one in (before, after)]
    whole = area[task.rows].sum()
    assert set(made.cutter.tolist()) == {0}, "with the cutters of the plan alone"
    if moved[0] < MINOR_SHARE * whole:
        assert len(made) > 1
        assert moved[1] < 0.5 * moved[0]
    else:
        assert moved[0] > 0.05 * whole, "the large chamfers"
        assert made.key.tolist() == upright.key.tolist()
    # Each adds what is worth an orientation, in its turn.
    served = np.logical_and.accumulate(~task.probes.table(task.rows, made), axis=1)
    gain = -np.diff(area[task.rows] @ served)
    assert (gain[:-1] >= 0.5 * MINOR_AREA * whole).all()
    assert moved[1] == 0.0 or (gain[-1:] >= 0.5 * MINOR_AREA * whole).all(), "or it has all that is left"


def test_nothing_is_added_where_all_is_served_or_a_number_was_requested(task):
    every = _first(task, 0.3).and_(_stored(task, task.rows[::7]))
    assert instead_of_motion(task, every, lambda rows: every) is every


@given(st.integers(0, 2**32 - 1))
def test_no_fixed_step_goes_to_motion_that_is_minor_itself(seed):
    """Of three steps the last is motion, which would be quickest everywhere."""
    rng = np.random.default_rng(seed)
    n = 60
    number = rng.choice(3, n, p=[0.8, 0.12, 0.08]).astype(np.int32)
    area = rng.uniform(0.5, 1.5, n) * np.where(number == 0, 100.0, 1.0)
    cost = rng.uniform(1.0, 2.0, (n, 3))
    cost[:, 2] = 0.1
    cost[number != 0, 0] = np.inf
    steps = Steps(cost, np.arange(3), np.ones(3, bool), np.array([False, False, True]), area, True, lambda used: 5.0 * len(used))
    after = without_minor_steps(steps, number, incomplete=False)
    size = np.bincount(number, area, 3)
    if size[2] < MINOR_SHARE * size.sum():
        assert (after[number == 1] == 1).all()
    assert (after >= 0).all()
