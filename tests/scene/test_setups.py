"""Each setup with its own fixtures and clamped faces: what holds the part in one is not there in another."""

import json

import numpy as np
import pytest

from plan_cutters import plan
from plan_cutters.domain.fixture import Fixture
from plan_cutters.domain.placement import Placement
from plan_cutters.domain.verdicts import FIXTURE, INACCESSIBLE, REASONS
from plan_cutters.errors import FixtureError, OptionError
from tests.support.cad_parts import box
from tests.support.forked import run
from tests.support.two_setups import DOWN, HOW, LOWER, UP, UPPER, faces_at, name_of, two


@pytest.mark.slow("another machine of the same law", only=("unlimited",))
@pytest.mark.parametrize("machine", ["unlimited", "trunnion-ac"])
def test_each_setup_is_what_a_plan_of_it_alone_finds(machine):
    """Independent truth: the part planned by itself in the second setup, its clamped face as a target left out."""
    part = box()
    both = two(part, machine=machine)
    (name,) = both.reaches
    for k, (axis, jaws, shut) in enumerate([(UP, LOWER, (0, 0, -1)), (DOWN, UPPER, (0, 0, 1))]):
        alone = plan(part, setup=Placement(axis, fixtures=(*jaws, Fixture.parse("table"))), machine=machine, **HOW)
        assert np.array_equal(alone.samples.point, both.samples.point)
        mine = both.over_setups.each[k][1][name]
        held = both.samples.face == faces_at(both)[shut]
        assert np.array_equal(mine.reached[~held], alone.reaches[name].reached[~held])
        assert (mine.verdict[held] == INACCESSIBLE).all()
        # Nothing is served by a setup that holds it, or does not reach it.
        serves = both.served_in[name] == k
        assert not (serves & ~mine.reached).any()
        assert not serves[held].any()
    assert both.reaches[name].reached[both.samples.face == faces_at(both)[0, 0, 1]].all()
    assert both.reaches[name].reached[both.samples.face == faces_at(both)[0, 0, -1]].all()


def test_a_face_that_is_held_in_one_setup_alone_is_a_target_and_lost_there_to_what_holds_it():
    part = box()
    both = two(part)
    (name,) = both.reaches
    bottom = both.samples.face == faces_at(both)[0, 0, -1]
    assert (both.over_setups.each[0][1][name].reason[bottom] == FIXTURE).all()
    assert (both.served_in[name][bottom] == 1).all()
    assert len(both.plan.effective.target_faces) == 6
    assert both.plan.note_codes.count("faces_clamped_there") == 2
    assert "faces_clamped" not in both.plan.note_codes
    assert [c.area for c in both.plan.cutters] == [None]


def test_what_is_held_in_all_setups_stays_a_target_and_is_left_by_name():
    """The area to machine is the same whatever holds the part."""
    part = box()
    bottom, top = name_of(part, (0, 0, -1)), name_of(part, (0, 0, 1))
    found = plan(part, setup=Placement(UP, clamped=(bottom, top)), other_setups=[Placement(DOWN, clamped=(bottom,))], **HOW)
    free = plan(part, **HOW)
    assert found.plan.effective.target_faces == free.plan.effective.target_faces
    assert found.plan.process.asked_mm2 == free.plan.process.asked_mm2
    assert np.array_equal(found.samples.point, free.samples.point)
    assert f"1 face is clamped and left for another setup: {bottom}." in found.plan.notes
    (name,) = found.reaches
    mine = found.samples.face == int(bottom[1:])
    assert not found.reaches[name].reached[mine].any()
    assert (found.reaches[name].reason[mine] == FIXTURE).all()
    assert found.plan.selected is None
    (left,) = [each for each in found.plan.process.left if each.cause == "fixture"]
    assert left.faces == [bottom]
    assert left.area_mm2 == pytest.approx(100.0)


def test_only_where_all_targets_are_held_nothing_can_be_planned():
    with pytest.raises(OptionError, match="leaves no target face"):
        plan(box(), setup=Placement(UP, clamped=("F1",)), **{**HOW, "faces": "F1"})
    with pytest.raises(OptionError, match="leaves no target face"):
        plan(box(), setup=Placement(UP, clamped=("F1-6",)), other_setups=[Placement(DOWN, clamped=("F1-6",))], **HOW)
    assert plan(box(), setup=Placement(UP, clamped=("F1-6",)), other_setups=[DOWN], **HOW).reaches


def test_held_without_a_fixture_is_lost_to_what_holds_it_and_has_a_plain_witness():
    """The face is held in one setup, and the other setup's machine does not get there: without the limit it would."""
    part = box()
    top = name_of(part, (0, 0, 1))
    how = {**HOW, "tilt": (0.0, 0.5)}
    found = plan(part, setup=Placement(UP, clamped=(top,)), other_setups=[DOWN], machine="tilt:20", **how)
    (name,) = found.reaches
    mine = found.samples.face == int(top[1:])
    assert (found.over_setups.each[0][1][name].reason[mine] == FIXTURE).all()
    assert not found.reaches[name].reached[mine].any()
    assert set(found.reaches[name].reason[mine].tolist()) == {REASONS.index("axis_limit")}
    alone = plan(part, setup=Placement(UP, clamped=(top,)), other_setups=[DOWN], **how)
    assert alone.reaches[name].reached[mine].all()
    assert (alone.served_in[name][mine] == 1).all()
    witness = [w for w in found.plan.cutters[0].witnesses if w.face == top]
    assert witness
    assert all(w.depth_mm is None and w.obstacle_face is None for w in witness)


def test_fixtures_are_listed_with_the_setups_that_they_stand_in():
    part = box()
    post = Fixture.parse("box:1,1,1@50,0,0")
    found = two(part, fixtures=[post])
    listed = {(each.name, each.placement[:3]): each.setups for each in found.plan.fixtures}
    assert listed["fixture:box", (50.0, 0.0, 0.0)] == [0, 1]
    assert sum("fixture:table" in note and "in the setup 0,0,-1" in note for note in found.plan.notes) == 1
    tables = [each.setups for each in found.plan.fixtures if each.name == "fixture:table"]
    assert tables == [[0], [1]]
    first = [each.name for each in found.conditions.surroundings.fixtures]
    assert [each.name for each in found.plan.fixtures][: len(first)] == first
    assert [each.setups[0] for each in found.plan.fixtures] == sorted(each.setups[0] for each in found.plan.fixtures)


def test_a_setup_without_fixtures_beside_one_with_some_is_told():
    found = plan(box(), setup=Placement(UP, fixtures=LOWER), other_setups=[DOWN], **HOW)
    assert found.plan.note_codes.count("setup_without_fixtures") == 1
    (name,) = found.reaches
    assert found.over_setups.each[1][1][name].reached.all()
    assert not found.over_setups.each[0][1][name].reached.all()


def test_clearances_are_among_the_obstacles_of_the_setup_that_serves():
    part = box()
    both = two(part, machine="tilt:10")
    (name,) = both.reaches
    near = both.clearances
    for k, (axis, jaws) in enumerate([(UP, LOWER), (DOWN, UPPER)]):
        mine = both.served_in[name] == k
        assert mine.any()
        alone = plan(part, setup=Placement(axis, fixtures=(*jaws, Fixture.parse("table"))), machine="tilt:10", **HOW)
        same = mine & np.all(both.reaches[name].axis == alone.reaches[name].axis, axis=1)
        assert same.any()
        assert np.array_equal(near.distance[same], alone.clearances.distance[same], equal_nan=True)


@pytest.mark.slow("plans each proposed clamping")
def test_operations_of_a_setup_leave_what_it_holds_and_what_its_fixtures_cover():
    found = two(box(), machine="trunnion-ac", operations="fewest")
    made, at = found.answers.operations.plans[0], faces_at(found)
    machinable = found.ready.machinable
    (name,) = found.reaches
    assert {each.setup for each in made.operations} == {0, 1}
    for each in made.operations:
        assert machinable[each.setup][each.rows].all()
        assert at[0, 0, -1 if each.setup == 0 else 1] not in found.samples.face[each.rows]
    taken = np.concatenate([each.rows for each in made.operations])
    assert np.array_equal(np.sort(taken), np.flatnonzero(found.reaches[name].reached))


def test_a_fixture_of_another_setup_that_stands_in_the_part_is_named():
    inside = Placement(DOWN, fixtures=(Fixture.parse("box:4,4,4@3,3,3"),))
    with pytest.raises(FixtureError, match="box"):
        plan(box(), setup=UP, other_setups=[inside], **HOW)


def test_the_command_takes_two_setup_files(tmp_path):
    (tmp_path / "a.toml").write_text('unit = "mm"\naxis = "+z"\nclamped = "F1"\nfixtures = ["table:-50"]\n')
    (tmp_path / "b.toml").write_text('unit = "mm"\naxis = "-z"\nfixtures = ["table:-60"]\n')
    from tests.support.places import SAMPLES

    done = run(SAMPLES / "v_groove.step", "--cutter", "R2L30rc2", "--setup", "a.toml", "--setup", "b.toml", "--faces", "all",
               "--grid", "5", "--json", "-", "--area-budget", "0", cwd=tmp_path)  # fmt: skip
    assert done.returncode in (0, 1), done.stderr
    found = json.loads(done.stdout)
    assert [each["setups"] for each in found["fixtures"]] == [[0], [1]]
    assert "F1" in found["effective"]["target_faces"]
    assert [each["clamped"] for each in (found["effective"]["placement"], *found["effective"]["other_placements"])] == [
        ["F1"],
        [],
    ]
