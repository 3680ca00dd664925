"""The fastest plan that is printed, against every other one that is printed and against its bound."""

import numpy as np
import pytest

from plan_cutters import plan
from plan_cutters.operations import choices
from plan_cutters.plan_file.words.operations import operations
from tests.support.shapes import trough

#: Two of its plans are enough for each run.
pytestmark = pytest.mark.slow("searches long", only=("{'most_operations",))

#: With axes up to 80 deg off the setup axis the flutes cannot be laid along the trough, which would be the fastest by far.
OPTIONS = {"faces": "all", "area_budget": 0, "feed": 1000.0, "operations": "both", "machine": "tilt:80"}
#: Bull noses in a trough: one orientation serves all of it, and each strip is wider where the tool leans less.
BULLS = ["R2L60rc0.5", "R6L60rc1"]


def planned(**more):
    return plan(trough(10.0, 10.0), **{**OPTIONS, "grid": 7, "cutters": BULLS, "change_time": 7.0, **more}).plan


@pytest.fixture(scope="module", params=[{}, {"most_operations": 2}, {"operations": "fastest"}], ids=str)
def written(request):
    return planned(index_time=0.1, **request.param)


@pytest.mark.slow("searches long", only=("{'operations",))
def test_no_plan_beside_it_takes_less_than_the_fastest(written):
    seconds = {each.name: each.seconds for each in written.operations.plans}
    assert seconds["fastest"] == min(seconds.values())


def test_the_gap_is_that_of_the_plan_that_is_printed(written):
    found = written.operations
    (fastest,) = (each for each in found.plans if each.name == "fastest")
    assert found.fastest.seconds == fastest.seconds
    # All samples are compared, and no motion is simultaneous: the bound is one of this very plan.
    assert found.fewest is None if written.effective.operations == "fastest" else found.fastest.samples == found.fewest.samples
    assert {each.mode for each in fastest.operations} == {"fixed"}
    assert 0.0 < found.fastest.bound_seconds <= fastest.seconds
    assert found.fastest.gap == pytest.approx(fastest.seconds / found.fastest.bound_seconds - 1.0)


@pytest.fixture(scope="module")
def fewest():
    (found,) = planned(operations="fewest", index_time=0.1).operations.plans
    return found


def test_orientations_that_save_more_than_their_turn_are_no_crumbs(written, fewest):
    """One orientation serves all, so that another one adds no area."""
    assert fewest.orientations == 1
    found = written.operations
    (fastest,) = (each for each in found.plans if each.name == "fastest")
    most = 2 if written.effective.most_operations == 2 else len(fastest.operations)
    assert 1 < fastest.orientations <= most
    assert fastest.seconds < 0.9 * fewest.seconds


@pytest.mark.parametrize("feed", [30.0, 3000.0])
def test_the_fewest_say_what_one_more_orientation_saves_where_that_is_more_than_a_minute(feed):
    made = planned(operations="both", index_time=0.1, feed=feed, cutters=BULLS[1])
    few, fastest = made.operations.plans
    more = made.operations.fewest.one_more
    assert (few.seconds - fastest.seconds > 60.0) == (more is not None) == (feed < 100.0)
    lines = [line.text for line in operations(made) if "One more orientation" in line.text]
    assert len(lines) == (more is not None)
    if more is not None:
        assert max(60.0, 0.1 * few.seconds) < more.saves_seconds
        assert few.seconds - more.saves_seconds >= made.operations.fastest.bound_seconds * (1.0 - 1e-9)
        assert more.angles_deg not in [each.angles_deg for each in few.operations]


def test_a_cutter_of_the_fastest_plan_saves_its_change_and_no_other_does(written):
    found = written.operations
    used = {each.cutter for plan_ in found.plans if plan_.name == "fastest" for each in plan_.operations}
    assert used
    for use in found.cutters:
        assert (use.saves_seconds >= use.change_seconds) if use.id in used else (use.saves_seconds <= use.change_seconds)


def test_the_fastest_is_the_least_of_all_plans_found_whatever_the_search_for_it_finds(monkeypatch):
    monkeypatch.setattr(choices, "cheap", dearest)
    # With so many orientations allowed nothing is left to simultaneous motion.
    found = planned(index_time=3.0, cutters="R6L60rc1", most_operations=99).operations
    fewest, fastest = found.plans
    assert fastest.seconds == fewest.seconds
    assert [each.angles_deg for each in fastest.operations] == [each.angles_deg for each in fewest.operations]
    assert found.fastest.seconds == fewest.seconds


def dearest(problem, _start=None):
    """The worst candidate that serves all alone."""
    total = problem.cost.sum(axis=0)
    return np.array([np.where(np.isfinite(total), total, -np.inf).argmax()])


def test_where_nothing_is_reached_all_plans_are_empty_and_say_so_once():
    """A ball is larger than the trough: this ended with an internal error."""
    found = plan(trough(3.0, 10.0), grid=5, cutters=["R6L60rc6", "R8L60rc8"], **OPTIONS).plan
    assert [(each.name, each.seconds, each.operations) for each in found.operations.plans] == [
        ("fewest", 0.0, []), ("fastest", 0.0, [])]  # fmt: skip
    assert found.operations.fastest.gap == 0.0
    lines = [line.text for line in operations(found)]
    assert len(lines) == 2
    assert lines[1] == "There is nothing that a fixed orientation reaches."
