"""Answers about setups that hold the part differently: each setup among what stands there, all of them together as one answer."""

import numpy as np
import pytest

from plan_cutters import plan
from plan_cutters.answers.state import Case, State, on_table
from plan_cutters.domain.fixture import Fixture
from plan_cutters.domain.placement import Placement
from plan_cutters.domain.stick_out import held
from plan_cutters.domain.verdicts import FIXTURE, INACCESSIBLE, over_setups
from plan_cutters.judging.judge import judge
from tests.support.cad_parts import box
from tests.support.serving import not_reached
from tests.support.two_setups import DOWN, HOW, LOWER, UP, faces_at, name_of, two

pytestmark = pytest.mark.slow("plans again for each answer")

TABLE = (Fixture.parse("table"),)


def on_tables(**words):
    """A cube on a table, and turned over, each time with the face on the table held: its sides ask for 21.2 deg."""
    part = box()
    first, other = (
        Placement(axis, clamped=(name_of(part, (0, 0, side)),), fixtures=TABLE) for axis, side in ((UP, -1), (DOWN, 1))
    )
    return plan(part, setup=first, other_setups=[other], **{**HOW, "tilt_deg": (0.0, 68.8), **words})


@pytest.fixture(scope="module")
def limited():
    return on_tables(machine="tilt:20", answers="mend")


def rows_of(ready):
    return np.flatnonzero(ready.finished)


def test_a_case_looks_at_every_setup_as_a_plan_judges_it(limited):
    ready = limited.ready
    (cutter,) = ready.cutters
    rows, case = rows_of(ready), Case(ready, cutter)
    each = [judge(ready.alone(k), cutter, rows) for k in range(2)]
    over = over_setups(each)[0]
    found = case.look(rows)
    assert np.array_equal(found.verdict == INACCESSIBLE, over.verdict == INACCESSIBLE)
    assert np.array_equal(not_reached(case), rows[~over.reached])
    assert 0 < len(not_reached(case)) < len(rows)
    first = Case(ready.alone(0), cutter).look(rows)
    clamped = ready.clamped[rows]
    assert clamped.any()
    assert (first.reason[clamped] == FIXTURE).all()


def test_next_steps_start_from_what_both_setups_leave(limited):
    (entry,) = limited.cutters
    first = [step for step in entry.mend.steps if step.changes[0].thing == "area"]
    assert first[0].left == entry.lost_in_all
    for step in entry.mend.steps:
        assert step.lost_before == pytest.approx(first[0].lost_before)


def test_two_setups_along_one_axis_are_two():
    """The same axis, held at other faces: what the first one shuts the second one serves, and nothing is left to mend."""
    part = box()
    top = name_of(part, (0, 0, 1))
    found = plan(part, setup=Placement(UP, clamped=(top,)), other_setups=[Placement(UP)], answers="mend", **HOW)
    (name,) = found.reaches
    assert not found.over_setups.each[0][1][name].reached[found.samples.face == int(top[1:])].any()
    assert found.cutters[0].feasible
    assert found.cutters[0].mend is None


def test_a_setup_that_is_not_planned_yet_holds_what_stands_on_its_own_table():
    part = box()
    bottom, top = name_of(part, (0, 0, -1)), name_of(part, (0, 0, 1))
    found = plan(part, setup=Placement(UP, clamped=(bottom,), fixtures=TABLE), other_setups=[Placement((1.0, 0.0, 0.0))], **HOW)
    over = on_table(found.ready, DOWN)
    assert np.array_equal(over.clamped, found.samples.face == int(top[1:]))
    by_hand = plan(part, setup=Placement(DOWN, clamped=(top,), fixtures=TABLE), **HOW)
    (cutter,) = found.ready.cutters
    reached = ~np.isin(np.arange(len(over.samples)), not_reached(Case(over, cutter)))
    assert np.array_equal(by_hand.samples.point, over.samples.point)
    assert np.array_equal(reached, by_hand.reaches[cutter.id].reached)
    assert State.of(found.ready, cutter).axes == (UP, (1.0, 0.0, 0.0))


def test_the_largest_radius_is_the_larger_one_of_the_setups():
    part = box()
    both = two(part, machine="tilt:70", answers="radius")
    first = Placement(UP, clamped=(name_of(part, (0, 0, -1)),), fixtures=(*LOWER, *TABLE))
    other = both.ready.options.other_placements[0]
    alone = [plan(part, setup=place, machine="tilt:70", answers="radius", **HOW) for place in (first, other)]
    for shape, radii in enumerate(both.answers.radius_maps):
        each = [one.answers.radius_maps[shape].radius for one in alone]
        assert np.array_equal(radii.radius, np.fmax(*each), equal_nan=True)
        assert any((mine < radii.radius).any() for mine in each)


def test_the_least_stick_out_serves_what_each_setup_serves():
    both = two(box(), cutters="R1L60F5S3HR8L30", machine="tilt:70", answers="stick-out")
    assert "stick_out_each_setup" in both.plan.note_codes
    (cutter,) = both.ready.cutters
    found = both.answers.stick_outs[cutter.id]
    assert found.floor < found.least < cutter.length
    short = held(cutter, found.least)
    for k in range(2):
        served = np.flatnonzero(both.served_in[cutter.id] == k)
        assert len(served)
        assert judge(both.ready.alone(k), short, served).reached.all()
    limiting, k = found.sample, found.setup
    assert both.served_in[cutter.id][limiting] == k
    assert not judge(both.ready.alone(k), held(cutter, found.beyond), np.array([limiting])).reached[0]


def test_posture_maps_are_of_the_first_setup_and_leave_out_what_it_holds():
    part = box()
    both = two(part, posture_maps=True)
    assert "maps_first_setup" in both.plan.note_codes
    shut = both.samples.face == faces_at(both)[0, 0, -1]
    maps = both.maps
    count = np.diff(maps.offset).reshape(len(maps.normal), -1).sum(axis=1)
    assert not count[shut].any()
    assert not maps.undecided[shut].any()
    assert (maps.verdict[shut] == INACCESSIBLE).all()
    alone = plan(part, setup=Placement(UP, fixtures=(*LOWER, *TABLE)), posture_maps=True, **HOW)
    assert np.array_equal(count[~shut], np.diff(alone.maps.offset).reshape(len(maps.normal), -1).sum(axis=1)[~shut])


@pytest.mark.parametrize("machine", ["trunnion-ac"])
def test_everything_together_is_one_plan(machine):
    """A proposal of setups, all answers, operations of both kinds and posture maps; and the same with fixtures of one's own."""
    words = {"answers": "all", "operations": "both", "feed": 800.0, "posture_maps": True, "machine": machine}
    proposed = plan(box(), **{**HOW, "cutters": ["R2L60rc2F10S2.5HR8L30"], "grid": 3}, setup="auto", **words)
    own = two(box(), **{"cutters": ["R2L60rc2F10S2.5HR8L30"], "grid": 3}, **words)
    for found in (proposed, own):
        assert len(found.plan.setups) >= 2
        assert found.plan.operations is not None
        assert found.maps is not None
        assert len(found.plan.largest_radius) == 2
        assert found.cutters[0].least_stick_out is not None
        assert "maps_first_setup" in found.plan.note_codes
