"""A plan of repeated steps is recommended unless it takes a quarter more time, or leaves more to simultaneous motion."""

import math
from types import SimpleNamespace

import numpy as np
import pytest

from plan_cutters.operations.by_pattern import _better, as_quick, known

AREA = np.array([40.0, 30.0, 20.0, 10.0])
TASK = SimpleNamespace(ready=SimpleNamespace(samples=SimpleNamespace(area=AREA)), rows=np.arange(4))


def plan_of(seconds, *, moving=0, untimed=0, other=0.0, name="plan"):
    """A plan of four samples that take so long together, the last of which move simultaneously, the first ones without a time."""
    each = np.full(4, seconds / (4 - untimed) if untimed < 4 else 0.0)
    each[:untimed] = math.nan
    label = np.zeros(4, np.int32)
    label[4 - moving :] = 1
    operations = [SimpleNamespace(mode="fixed", rows=np.flatnonzero(label == 0))]
    if moving:
        operations.append(SimpleNamespace(mode="simultaneous", rows=np.flatnonzero(label == 1)))
    total = math.nan if untimed else seconds + other
    return SimpleNamespace(
        label=label, seconds=each, other=other, total=total, operations=operations, orientations=3, name=name, moves=moving > 0
    )


def offer_of(*plans, reckoned=None):
    """Choices of repeated steps with these plans, reckoned to take as long as they do."""
    seconds = reckoned or [known(each) if each is not None else 0.0 for each in plans]
    return SimpleNamespace(
        recommended=list(zip(range(len(plans)), seconds, strict=True)), plan=lambda k: plans[k], may_take=lambda *given: True
    )


def test_times_that_are_not_known_are_left_out_of_what_is_known():
    assert known(plan_of(100.0, other=7.0)) == pytest.approx(107.0)
    assert known(plan_of(100.0, untimed=1, other=7.0)) == pytest.approx(107.0)
    nothing = plan_of(100.0)
    nothing.label[:] = -1
    assert known(nothing) == 0.0


PLAIN = plan_of(100.0, name="plain"), ("words",)


@pytest.mark.parametrize(
    ("repeated", "taken"),
    [
        (plan_of(90.0), True),
        (plan_of(124.9), True),
        (plan_of(125.1), False),
        (plan_of(90.0, moving=1), False),
        (plan_of(90.0, untimed=1), False),
        (None, False),
    ],
)
def test_one_of_repeated_steps_is_taken_unless_it_takes_a_quarter_more_time(repeated, taken):
    """A tenth of the area more in motion, or more of which no time is known, is too much."""
    plan, words = as_quick(TASK, offer_of(repeated), PLAIN, [])
    assert (plan is repeated) == taken
    if not taken:
        assert (plan, words) == PLAIN
    elif known(repeated) <= 100.0:
        assert words == ()
    else:
        assert words == ("Without repeated steps 3 orientations would take 100 s.",)


def test_simultaneous_motion_of_what_it_replaces_is_named():
    _, words = as_quick(TASK, offer_of(plan_of(101.0)), (plan_of(100.0, moving=1), ()), [])
    assert words == ("Without repeated steps 3 orientations and simultaneous motion would take 100 s.",)


def test_the_first_choice_that_does_is_taken_and_none_that_a_printed_plan_beats():
    late, soon = plan_of(130.0), plan_of(99.0)
    assert as_quick(TASK, offer_of(late, soon), PLAIN, [])[0] is soon
    assert as_quick(TASK, offer_of(soon, plan_of(80.0)), PLAIN, [])[0] is soon
    assert as_quick(TASK, offer_of(soon), PLAIN, [plan_of(98.0)])[0] is PLAIN[0]
    assert as_quick(TASK, offer_of(soon), PLAIN, [plan_of(99.0)])[0] is soon
    # What is reckoned to take much longer is not even planned.
    assert as_quick(TASK, offer_of(soon, reckoned=[140.0]), PLAIN, [])[0] is PLAIN[0]
    assert as_quick(TASK, None, PLAIN, []) is PLAIN


def test_where_the_time_of_the_other_is_not_known_nothing_is_said_of_it():
    other = plan_of(100.0, untimed=1), ()
    repeated = plan_of(101.0, untimed=1)
    assert as_quick(TASK, offer_of(repeated), other, []) == (repeated, ())


def test_a_twentieth_of_the_area_more_in_motion_is_hardly_more():
    """Then the time counts, of which the repeated plan may take a quarter more; above that the motion alone does."""
    area = np.array([75.0, 5.0, 10.0, 10.0])
    task = SimpleNamespace(ready=SimpleNamespace(samples=SimpleNamespace(area=area)), rows=np.arange(4))

    def moving(seconds, rows):
        plan = plan_of(seconds)
        plan.operations.append(SimpleNamespace(mode="simultaneous", rows=np.array(rows, np.int64)))
        return plan

    repeated = plan_of(125.0)
    assert _better(task, moving(99.0, [1]), repeated)
    assert not _better(task, moving(101.0, [1]), repeated)
    assert not _better(task, moving(100.0, [1]), repeated)
    assert not _better(task, moving(9.0, [2]), repeated)
    assert not _better(task, plan_of(999.0), moving(1.0, [1]))
    assert _better(task, plan_of(999.0), moving(1.0, [2]))


def test_what_takes_longer_by_far_at_some_samples_is_not_planned_at_all():
    plans = [plan_of(80.0), plan_of(90.0)]
    made, offer = [], offer_of(*plans)
    offer.plan = lambda k: made.append(k) or plans[k]
    offer.may_take = lambda k, most, share: k > 0
    assert as_quick(TASK, offer, PLAIN, [])[0] is plans[1]
    assert made == [1]
