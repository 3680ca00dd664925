"""What cutters are worth: a plane with a groove, whose answer is known, the shop's habit, and a real plan."""

import math
from types import SimpleNamespace

import numpy as np
import pytest

from plan_cutters import Cutter, plan
from plan_cutters.operations.choices import largest_first, with_and_without, worths
from plan_cutters.operations.fastest import Costs, Problem, cheap
from tests.support.located import located
from tests.support.shapes import trough

LARGE, SMALL = Cutter.parse("R8L80rc8"), Cutter.parse("R3L80rc3")
FEED = 2000.0 / 60.0


def best(problem):
    """A choice of little cost, with its bound."""
    return located(problem, cheap(problem))


def pass_width(cutter):
    return 2.0 * math.sqrt(2.0 * cutter.radius * 0.01 - 0.01**2)


def grooved(plane, groove, change):
    """Rows: a plane, and a groove that only the small cutter reaches; columns: the large cutter and the small one."""
    seconds = [[area / (pass_width(cutter) * FEED) for cutter in (LARGE, SMALL)] for area in (plane, groove)]
    seconds[1][0] = math.inf
    kind = np.array([0, 1], np.int32)
    return Problem(np.array(seconds), kind, np.zeros(2, np.int32), Costs(0.0, change, 300.0))


def task_of(reached, change):
    verdicts = {cutter: SimpleNamespace(reached=np.array(mine)) for cutter, mine in zip((LARGE, SMALL), reached, strict=True)}
    ready = SimpleNamespace(options=SimpleNamespace(change_time=change), chosen=SimpleNamespace(free_form=0.0))
    return SimpleNamespace(cutters=(LARGE, SMALL), everywhere=(verdicts,), rows=np.arange(2), ready=ready)


@pytest.mark.parametrize("change", [5.0, 20.0, 60.0])
@pytest.mark.parametrize("side", [0.9, 1.1])
def test_the_large_cutter_takes_the_plane_if_that_saves_more_than_its_change(change, side):
    area = side * change * FEED / (1.0 / pass_width(SMALL) - 1.0 / pass_width(LARGE))
    problem = grooved(area, 50.0, change)
    found = best(problem)
    assert (0 in found.chosen) == (side > 1.0)
    assert 1 in found.chosen
    assert found.bound <= found.cost * (1.0 + 1e-12)
    choices = [found.chosen, *with_and_without(problem, found.chosen)]
    plans = [plan_of(problem, each) for each in choices]
    large, small = worths(task_of([[True, False], [True, True]], change), plans)
    assert large.cutter is LARGE
    assert (large.saves, large.change) == (pytest.approx(side * change), change)
    assert len(large.only) == 0
    assert small.saves is None
    assert small.only.tolist() == [1]


def plan_of(problem, chosen, more=0.0):
    operations = [SimpleNamespace(cutter=(LARGE, SMALL)[problem.cutter[each]], setup=0, step=0) for each in chosen.tolist()]
    return SimpleNamespace(operations=operations, total=problem.total(chosen) + more)


def test_what_a_cutter_saves_is_about_the_plans_and_unknown_times_are_no_plans():
    problem, both, small = grooved(1e5, 50.0, 20.0), np.array([0, 1]), np.array([1])
    task = task_of([[True, False], [True, True]], 20.0)
    plans = [plan_of(problem, both, 7.0), plan_of(problem, small)]
    saves = problem.total(small) - problem.total(both) - 7.0 + 20.0
    assert worths(task, plans)[0].saves == pytest.approx(saves)
    assert worths(task, [plan_of(problem, both, math.nan), plan_of(problem, small)])[0].saves == 0.0
    assert worths(task, [plan_of(problem, both, math.nan)]) == ()


def test_where_nothing_is_reached_there_is_nothing_to_compare():
    empty = Problem(np.zeros((0, 3)), np.array([0, 0, 1]), np.zeros(3, np.int32), Costs(5.0, 20.0, 0.0))
    assert list(with_and_without(empty, np.zeros(0, np.int64))) == []


def test_the_first_cutter_and_the_first_setup_cost_nothing():
    problem = grooved(1000.0, 50.0, 20.0)
    assert problem.total(np.array([1])) == pytest.approx(1050.0 / (pass_width(SMALL) * FEED))
    assert problem.total(np.array([0, 1])) == pytest.approx(problem.cutting(np.array([0, 1])) + 20.0)


def crumbed(plane, crumb, groove, operation):
    """Rows: a plane, a crumb, a groove; columns: the large cutter on plane, on crumb, the small one on all three."""
    feeds = [pass_width(cutter) * FEED for cutter in (LARGE, LARGE, SMALL)]
    seconds = np.array([[area / each for each in feeds] for area in (plane, crumb, groove)])
    seconds[[0, 1, 2, 2], [1, 0, 0, 1]] = math.inf
    return Problem(seconds, np.array([0, 0, 1], np.int32), np.zeros(3, np.int32), Costs(operation, 20.0, 0.0))


@pytest.mark.parametrize("side", [0.9, 1.1])
def test_by_the_habit_the_large_cutter_turns_to_what_it_cuts_for_longer_than_it_turns(side):
    operation = 5.0
    crumb = side * operation * FEED * pass_width(LARGE)
    assert largest_first(crumbed(1e5, crumb, 50.0, operation), (0, 1)).tolist() == ([0, 1, 2] if side > 1.0 else [0, 2])
    assert largest_first(crumbed(1e5, crumb, 50.0, 0.0), (0, 1)).tolist() == [0, 1, 2]


def test_by_the_habit_the_large_cutter_turns_to_what_it_alone_reaches():
    problem = crumbed(1e5, 1e-3, 50.0, 5.0)
    problem.cost[1, 2] = math.inf
    assert largest_first(problem, (0, 1)).tolist() == [0, 1, 2]


@pytest.mark.parametrize("seed", range(20))
def test_the_habit_serves_all(seed):
    rng = np.random.default_rng(seed)
    cost = np.where(rng.random((12, 9)) < 0.4, 10.0 * rng.random((12, 9)), np.inf)
    cost = cost[np.isfinite(cost).any(axis=1)]
    problem = Problem(cost, rng.integers(0, 3, 9), np.zeros(9, np.int32), Costs(2.0, 20.0, 0.0))
    found = largest_first(problem, (2, 0, 1))
    assert np.isfinite(cost[:, found]).any(axis=1).all()
    assert len(found) == len(set(found.tolist()))


def test_plans_of_two_cutters_agree_with_themselves():
    result = plan(trough(10.0, 10.0), cutters=["R2L60rc2", "R6L60rc6"], faces="all", grid=7, operations="both", feed=1000.0,
                  area_budget=0, index_time=3.0, change_time=7.0, machine="tilt:80")  # fmt: skip
    found = result.plan.operations
    assert [each.name for each in found.plans] == ["fewest", "fastest"]
    for each in found.plans:
        assert each.cutting_seconds == pytest.approx(sum(one.seconds for one in each.operations))
        cutters = {one.cutter for one in each.operations}
        assert each.other_seconds == pytest.approx(3.0 * len(each.operations) + 7.0 * (len(cutters) - 1))
        assert each.link_seconds == pytest.approx(sum(one.link_seconds for one in each.operations))
        assert each.seconds == pytest.approx(each.cutting_seconds + each.link_seconds + each.other_seconds)
        assert each.changes == len(cutters) - 1
        assert each.pieces == sum(len(one.regions) for one in each.operations)
        assert each.ratio_at_most >= 1.0
        assert each.rest.samples == 0
    assert [use.id for use in found.cutters] == ["R6L60rc6", "R2L60rc2"]
    for use in found.cutters:
        for each in found.plans:
            mine = sum(one.area_mm2 for one in each.operations if one.cutter == use.id)
            assert use.takes_mm2[each.name] == pytest.approx(mine)
    assert found.fastest.bound_seconds <= found.fastest.seconds * (1.0 + 1e-9)
    assert found.fastest.gap == pytest.approx(found.fastest.seconds / found.fastest.bound_seconds - 1.0)


def test_a_ball_in_a_plane_trough_takes_the_seconds_of_its_width():
    """Along a cylinder the section is a circle in a circle; across, where the centre runs less far, a circle on a line."""
    c, radius, feed = -10.0, 6.0, 1000.0
    cosine = ((c + radius) ** 2 + (c + 0.01) ** 2 - radius**2) / (2 * (c + radius) * (c + 0.01))
    along, across = 2.0 * abs(c) * math.acos(cosine), 2.0 * math.sqrt(2.0 * radius * 0.01 - 0.01**2)
    each = max(along, across / (1.0 - radius / abs(c)))
    # With axes up to 80 deg off the setup axis the flutes cannot be laid along the trough.
    options = {"operations": "fewest", "feed": feed, "area_budget": 0, "machine": "tilt:80"}
    result = plan(trough(10.0, 10.0), cutters="R6L60rc6", faces="all", grid=7, **options)
    entry = result.plan.operations.plans[0]
    area = sum(one.area_mm2 for one in entry.operations)
    assert entry.cutting_seconds == pytest.approx(area / (each * feed / 60.0), rel=0.04)


def test_a_smaller_cutter_takes_nothing_that_a_larger_one_has_taken():
    """Two orientations of the large cutter serve half each; the small one serves all, and is needed for one sample alone."""
    cost = np.array([[10.0, math.inf, 11.0], [10.0, math.inf, 11.0], [math.inf, 10.0, 11.0], [math.inf, 10.0, 11.0]])
    kind = np.array([0, 0, 1], np.int32)
    problem = Problem(cost, kind, np.zeros(3, np.int32), Costs(1.0, 5.0, 0.0))
    assert largest_first(problem, [0, 1]).tolist() == [0, 1]
    rest = Problem(np.concatenate([cost, [[math.inf, math.inf, 3.0]]]), kind, np.zeros(3, np.int32), Costs(1.0, 5.0, 0.0))
    assert largest_first(rest, [0, 1]).tolist() == [0, 1, 2]
    # The other way round the first takes all.
    assert largest_first(rest, [1, 0]).tolist() == [2]


def test_by_the_habit_all_is_served_that_anything_serves():
    rng = np.random.default_rng(5)
    for _ in range(60):
        n, m = int(rng.integers(1, 9)), int(rng.integers(1, 7))
        cost = np.where(rng.random((n, m)) < 0.6, 10.0 * rng.random((n, m)), math.inf)
        cost = cost[np.isfinite(cost).any(axis=1)]
        kind = rng.integers(0, 3, m).astype(np.int32)
        problem = Problem(cost, kind, np.zeros(m, np.int32), Costs(float(5.0 * rng.random()), 1.0, 0.0))
        chosen = largest_first(problem, [2, 0, 1])
        assert np.isfinite(cost[:, chosen]).any(axis=1).all()
        assert (np.diff(chosen) > 0).all()
        # Each serves something that no cutter before it has taken.
        rank = {2: 0, 0: 1, 1: 2}
        for each in chosen.tolist():
            before = [k for k in chosen.tolist() if rank[int(kind[k])] < rank[int(kind[each])]]
            assert (np.isfinite(cost[:, each]) & ~np.isfinite(cost[:, before]).any(axis=1)).any()
