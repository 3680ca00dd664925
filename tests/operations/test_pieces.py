"""Small pieces, what few orientations take with simultaneous motion for the rest, and what is joined to what is beside it."""

import math
from types import SimpleNamespace

import numpy as np
import pytest

from plan_cutters import plan
from plan_cutters.domain.operations import columns_of
from plan_cutters.operations import planning, plans
from plan_cutters.operations.fastest import Costs
from plan_cutters.operations.motion import _Times
from plan_cutters.operations.plans import small_pieces
from tests.support.cad_parts import box


def pieces_of(*areas):
    """A plan in which each sample is a piece of its own."""
    return SimpleNamespace(name="fewest", region=np.arange(len(areas))), SimpleNamespace(area=np.array(areas))


@pytest.mark.parametrize("overlap", [0.5, 1.0, 3.0])
def test_pieces_of_less_than_four_squares_of_the_overlap_are_told(overlap):
    least = 4.0 * overlap**2
    assert small_pieces(*pieces_of(least, 2.0 * least), overlap) == ()
    [one] = small_pieces(*pieces_of(0.99 * least, 2.0 * least), overlap)
    assert one.startswith("The fewest plan has one piece of less than")
    assert one.endswith("no neighbouring operation serves it.")
    [two] = small_pieces(*pieces_of(0.99 * least, 0.5 * least, 2.0 * least), overlap)
    assert "has 2 pieces of less than" in two
    assert two.endswith("no neighbouring operation serves all of one of them.")
    # What belongs to no piece, and what has no area, is none.
    plan, samples = pieces_of(0.1 * least, 2.0 * least)
    plan.region[0] = -1
    plan.region[1] = 0
    assert small_pieces(plan, samples, overlap) == ()
    plan, samples = pieces_of(2.0 * least, math.nan)
    plan.region[1] = 0
    assert small_pieces(plan, samples, overlap) == ()


STEPS = {"step": [{"cutter": "D12L60F26", "angles": {"C": 0.0, "A": 0.0}}]}
HOW = {
    "cutters": ["D12L60F26", "D6L40rc3F16"],
    "faces": "all",
    "grid": 3,
    "area_budget": 0,
    "feed": 1000.0,
    "machine": "trunnion-ac",
}


@pytest.mark.parametrize("overlap", [1.0, 3.0])
def test_what_is_joined_to_its_neighbours_is_as_small_as_what_is_told(monkeypatch, overlap):
    limits, real = [], plans.joined
    monkeypatch.setattr(plans, "joined", lambda *given: limits.append(given[-1]) or real(*given))
    plan(box(40, 30, 20), **HOW, process={**STEPS, "rest": "leave"}, overlap=overlap)
    assert limits
    assert limits == pytest.approx([4.0 * overlap**2] * len(limits))


def test_no_step_is_planned_with_a_cutter_without_a_feed(monkeypatch):
    """Of two cutters the larger has none: a person's step with the other, and what is left, are planned with that alone."""
    monkeypatch.setattr(planning, "without_feed", lambda ready: ready.cutters[:1])
    steps = {"step": [{"cutter": "D6L40rc3F16", "angles": {"C": 0.0, "A": 0.0}, "faces": ["F6"]}], "rest": "plan"}
    found = plan(box(40, 30, 20), **HOW, operations="fastest", process=steps)
    used = {each.cutter for one in found.answers.operations.plans for each in one.operations}
    assert used == set(found.ready.cutters[1:])


def times_of(cost, moving, *, change=7.0, setup=11.0):
    """Samples of four that columns of two cutters serve, the rest with motion of cutter 1 in setups 0 and 1."""
    task = SimpleNamespace(
        costs=lambda: Costs(0.0, change, setup), indexing=SimpleNamespace(constant=5.0), together=lambda some: 3.0 * len(some)
    )
    columns = columns_of(np.zeros((1, 3)), np.zeros((1, 2)), 0, 0).and_(columns_of(np.zeros((1, 3)), np.ones((1, 2)), 1, 0))
    return _Times(task, columns, np.array(cost), np.array(moving), np.array([1, 1, 1, 1]), np.array([0, 0, 1, 1]))


def test_a_choice_takes_its_cutting_its_turns_and_each_cutter_and_setup_after_the_first():
    inf = math.inf
    times = times_of([[1.0, inf], [1.0, 9.0], [inf, 2.0], [inf, 2.0]], [20.0, 20.0, 30.0, 30.0])
    # Both columns: all samples, two turns, two cutters.
    assert times.total([0, 1]) == (1.0 + 1.0 + 2.0 + 2.0 + 2 * 3.0 + 7.0, 6.0)
    # The first: two samples move with the other cutter in the other setup.
    assert times.total([0]) == (2.0 + 60.0 + 3.0 + 5.0 + 7.0 + 11.0, 62.0)
    # The second: one sample moves with its own cutter and setup.
    assert times.total([1]) == (20.0 + 9.0 + 4.0 + 3.0 + 5.0, 33.0)
    # None: motion alone, in two setups.
    assert times.total([]) == (100.0 + 2 * 5.0 + 11.0, 100.0)
