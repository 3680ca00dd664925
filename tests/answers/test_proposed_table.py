"""A table that `setup auto` proposed is not there yet: it chooses no cutter on what stands on it, and what it hides is told."""

import numpy as np
import pytest

from plan_cutters import Cutter, plan
from plan_cutters.answers.candidates import touching
from plan_cutters.answers.least_set import by_kind, least_set
from plan_cutters.command.codes import NONE_FEASIBLE, code_of
from plan_cutters.domain.fixture import Fixture
from plan_cutters.domain.placement import Placement
from plan_cutters.domain.verdicts import ANOTHER_SETUP, FIXTURE
from tests.support.cad_parts import ball, box

#: A ball whose wide holder meets the table, and an engraving bit that is long enough to stay clear of it.
BALL, BIT = Cutter.parse("R2L12rc2HR15L30"), Cutter.form([(0, 0), (0.15, 0), (2, 11)], length=80, name="engraving bit")
TABLE = (Fixture.parse("table"),)
HOW = {"faces": "all", "grid": 9, "area_budget": 0, "machine": "tilt:120"}


def on_table(stands_on, cutters=(BALL, BIT)):
    """A sphere on a table that was proposed, if it stands on faces of it; else on a table of the planner."""
    place = Placement((0.0, 0.0, 1.0), fixtures=TABLE, stands_on=stands_on)
    return plan(ball(), setup=place, cutters=list(cutters), **HOW)


@pytest.fixture(scope="module")
def proposed():
    return on_table(("F1",))


@pytest.fixture(scope="module")
def given():
    return on_table(())


@pytest.mark.slow("plans parts whole")
def test_verdicts_are_the_same_and_only_the_reason_differs(proposed, given):
    for cutter in (BALL, BIT):
        mine, theirs = (each.reaches[cutter.id] for each in (proposed, given))
        assert np.array_equal(mine.verdict, theirs.verdict)
        assert np.array_equal(np.where(mine.reason == ANOTHER_SETUP, FIXTURE, mine.reason), theirs.reason)
    assert (proposed.reaches[BALL.id].reason == ANOTHER_SETUP).any()
    assert not (given.reaches[BALL.id].reason == ANOTHER_SETUP).any()


def test_the_table_chooses_no_engraving_bit(proposed, given):
    """A table that is there counts: the bit that reaches more beside it comes nearer."""
    shares = {c.id: c.area_share.not_reached for c in proposed.plan.cutters}
    assert shares[BIT.id] < shares[BALL.id]
    assert proposed.plan.shown == BALL.id
    assert given.plan.shown == BIT.id
    assert {step.cutter for step in proposed.plan.process.steps} == {BALL.id}


def test_what_is_left_is_told_and_never_called_finished(proposed):
    document = proposed.plan
    left = {each.cause: each for each in document.process.left}
    assert left["another_setup"].faces == ["F1"]
    assert left["another_setup"].area_mm2 > 0.0
    assert document.process.finished_mm2 + sum(each.area_mm2 for each in left.values()) == pytest.approx(
        document.process.asked_mm2
    )
    assert not document.process.finished
    assert document.selected is None
    assert code_of(document) == NONE_FEASIBLE


def test_the_order_of_the_cutters_does_not_decide(proposed):
    turned = on_table(("F1",), (BIT, BALL))
    assert [c.id for c in turned.plan.cutters] == [c.id for c in proposed.plan.cutters]
    assert turned.plan.process == proposed.plan.process


@pytest.mark.slow("plans parts whole")
def test_a_cutter_of_the_same_kind_still_takes_what_it_reaches_of_it():
    long = Cutter.parse("R1L80rc1")
    found = on_table(("F1",), (BALL, long, BIT))
    assert {step.cutter for step in found.plan.process.steps} == {BALL.id, long.id}
    runs = least_set(found.ready, [{c: found.reaches[c.id] for c in found.ready.cutters}]).runs
    assert {run.cutter for run in runs} == {BALL, long}


def test_faces_that_touch_the_table():
    every = plan(box(), cutters="R2L40rc2", faces="all", grid=3, area_budget=0)
    (found,) = touching(every.ready, np.array([[0.0, 0.0, 1.0]]))
    bottom = every.samples.normal[:, 2] < -0.5
    assert set(every.samples.face[bottom].tolist()) < set(found)
    assert len(found) == 5, "the sides touch it with an edge"


def test_an_engraving_bit_joins_the_set_only_for_what_no_other_cutter_reaches():
    """Two rows: the bit alone reaches both, two others one each. Then a third row that only the bit reaches."""
    cutters = [BALL, Cutter.parse("R3L40"), BIT]
    columns = [(0, 0), (0, 1), (0, 2)]
    both = np.array([[1, 0, 1], [0, 1, 1]], bool)
    assert by_kind(both, columns, cutters, 0.0) == ([0, 1], True)
    assert by_kind(np.vstack([both, [0, 0, 1]]).astype(bool), columns, cutters, 0.0) == ([0, 1, 2], True)
    assert by_kind(both[:, 2:], [(0, 0)], [BIT], 0.0) == ([0], True)
    assert by_kind(np.zeros((2, 3), bool), columns, cutters, 0.0) == ([], True)


def test_on_free_form_parts_flat_ends_join_the_set_after_round_ones():
    """A ball reaches one of two rows, a flat end both: it has the rest; on other parts it is alone."""
    both, columns, cutters = np.array([[1, 1], [0, 1]], bool), [(0, 0), (0, 1)], [BALL, Cutter.parse("R3L40")]
    assert by_kind(both, columns, cutters, 1.0) == ([0, 1], True)
    assert by_kind(both, columns, cutters, 0.5) == ([1], True)
