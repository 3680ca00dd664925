"""The checksum of what a cutter is judged on, and what each setup of a part sees."""

from dataclasses import replace

import numpy as np
import pytest

from cad_io.part.equal_faces import Motion
from plan_cutters import Machine, Options
from plan_cutters.domain.fixture import Fixture
from plan_cutters.domain.placement import Placement
from plan_cutters.judging.judge import GroundDigests, made_of, same
from plan_cutters.pipeline import prepare
from plan_cutters.scene.preparation import Copies
from tests.support.cad_parts import box
from tests.support.two_setups import DOWN, LOWER, UP, UPPER

HOW = {"cutters": "R2L40rc2", "faces": "all", "grid": 4, "area_budget": 0, "jobs": 2}


@pytest.fixture(scope="module")
def ready():
    """A cube that stands on its face F5 in the first setup, and in jaws and on F6 in the other one."""
    first = Placement(UP, (0.0, 1.0, 0.0), clamped=("F5",), fixtures=LOWER)
    other = Placement(DOWN, clamped=("F6",), fixtures=(*UPPER, Fixture.parse("table")))
    return prepare(box(), Options.of({**HOW, "setup": first, "other_setups": [other]}))


def test_the_checksum_of_a_ground_is_of_all_that_verdicts_follow_from(ready):
    """Names and threads change nothing; tolerance, what is held, samples and machine do."""
    digests = GroundDigests()
    one = digests.of(ready)
    assert digests.of(ready) == one
    same = [
        replace(ready, conditions=replace(ready.conditions, jobs=7)),
        ready.under(machine=replace(ready.conditions.machine, name="mine")),
    ]
    others = [
        ready.under(tolerance=0.02),
        ready.under(machine=Machine.parse("tilt:60")),
        replace(ready, held=np.roll(ready.held, 1)),
        replace(ready, inside=np.roll(ready.inside, 1) + 1),
        replace(ready, samples=replace(ready.samples, normal=-ready.samples.normal)),
        ready.there(1),
    ]
    assert all(digests.of(each) == one for each in same)
    found = [digests.of(each) for each in others]
    assert len({one, *found}) == 1 + len(others)
    # What was asked before is known still, and so is what was asked long ago.
    assert [digests.of(each) for each in (ready, *others)] == [one, *found]


def test_grounds_of_the_same_objects_are_one(ready):
    made = made_of(ready)
    assert same(made, made_of(replace(ready, coarser=2.0)))
    for changed in (replace(ready, held=ready.held.copy()), replace(ready, samples=replace(ready.samples)), ready.there(1)):
        assert not same(made, made_of(changed))
    assert not same(made, made[:-1])


def test_each_setup_has_its_own_axis_conditions_and_clamped_faces(ready):
    assert ready.axes == ((UP, (0.0, 1.0, 0.0)), (DOWN, None))
    assert [tuple(each.setup) for each in ready.setups] == [UP, DOWN]
    assert ready.there(0) is ready
    there = ready.there(1)
    assert there.conditions is ready.setups[1]
    assert np.array_equal(ready.clamped, ready.samples.face == 5)
    assert np.array_equal(there.clamped, ready.samples.face == 6)
    assert (ready.alone(0).others, ready.alone(1).others) == ((), ())
    assert ready.alone(1).conditions is ready.setups[1]
    changed = ready.under(tolerance=0.5)
    assert [each.tolerance for each in changed.setups] == [0.5, 0.5]
    assert [each.tolerance for each in ready.setups] == [0.01, 0.01]
    assert not replace(ready, held=None).clamped.any()
    assert len(replace(ready, held=None).clamped) == len(ready.samples)


def test_copies_follow_the_motions_that_leave_a_setup_as_it_is():
    quarter = Motion(np.array([[0.0, -1, 0], [1, 0, 0], [0, 0, 1]]), np.zeros(3))
    mirror = Motion(np.diag([-1.0, 1, 1]), np.zeros(3))
    copies = Copies(
        np.array([0, 0, 0, 3, 3]), np.array([-1, 0, 1, -1, 1], np.int32), (quarter, mirror), ((True, False), (False, True)),
        np.array([True, True, True, True, False]), np.zeros(5, bool), np.zeros(5, np.int64),
    )  # fmt: skip
    assert copies.copy.tolist() == [False, True, True, False, True]
    assert copies.follow.tolist() == [False, True, False, False, False]
    assert replace(copies, setup=1).follow.tolist() == [False, False, True, False, False]
    vectors = np.arange(9.0).reshape(3, 3)
    made = copies.moved(np.array([1, 4, 0]), vectors)
    assert made[0].tolist() == [-1.0, 0.0, 2.0]
    assert made[1].tolist() == [-3.0, 4.0, 5.0]
    assert np.isnan(made[2]).all()
