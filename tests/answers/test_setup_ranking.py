"""Setups ranked by what a machine can hold there: closed forms without a table, and proposals that are planned."""

import json
import math
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from plan_cutters import Cutter, Options, plan
from plan_cutters.answers import setup_ranking
from plan_cutters.answers.candidates import Candidates, cube, distinct, fibonacci
from plan_cutters.answers.least_set import cover
from plan_cutters.answers.serving import holdable
from plan_cutters.answers.setup_ranking import ranked
from plan_cutters.document.clock import Clock
from plan_cutters.domain.assembly import assembly
from plan_cutters.domain.fixture import Fixture
from plan_cutters.domain.placement import Placement
from plan_cutters.domain.verdicts import blank
from plan_cutters.errors import OptionError
from plan_cutters.pipeline import prepare
from plan_cutters.plan_file.words.text import story_of
from plan_cutters.proposal import judged_proposed
from tests.support.cad_parts import ball, box
from tests.support.commands import assert_one_line
from tests.support.forked import run
from tests.support.places import SAMPLES

BALL = "R1L60rc1"
Z = np.array([0.0, 0.0, 1.0])


def ready(shape, tilt, machine, **options):
    limits = (0.0, math.radians(tilt))
    return prepare(shape, Options(cutters=BALL, faces="all", tilt=limits, machine=machine, area_budget=0,
                                  **{"grid": 5, **options}))  # fmt: skip


def held(one, axis):
    return holdable(one.samples, one.cutters, one.conditions, axis)


@pytest.mark.parametrize(("tilt", "setups"), [(40.0, 6), (50.0, 3), (56.0, 2)])
def test_a_cube_on_three_axes_needs_as_many_setups_as_fixed_axes(tilt, setups):
    """A setup is one axis there: up to 45 deg it serves a face, then an edge's two, from acos(1 / sqrt 3) on a corner's three."""
    one = ready(box(), tilt, "3-axis")
    axes = cube()
    chosen, proven = cover(np.stack([held(one, axis) for axis in axes], axis=1), range(len(axes)), range(len(axes)))
    assert (len(chosen), proven) == (setups, True)


@pytest.mark.parametrize(("tilt", "sixth"), [(59.0, False), (61.0, True), (89.0, True)])
def test_a_trunnion_serves_five_faces_of_a_cube_and_the_sixth_from_60_deg_on(tilt, sixth):
    """A from -30 to 120 deg and C all round hold axes up to 120 deg from +Z: 60 deg from the underside's normal."""
    one = ready(box(), tilt, "trunnion-ac")
    below = one.samples.normal @ Z < -0.5
    found = held(one, Z)
    assert found[~below].all()
    assert found[below].all() == found[below].any() == sixth


@pytest.mark.slow("another tilt of the same law", only=("40.0",))
@pytest.mark.parametrize(("tilt", "limit"), [(40.0, 49.0), (40.0, 51.0), (75.0, 14.0), (75.0, 16.0)])
def test_half_a_ball_is_served_along_its_pole_if_tilt_and_limit_make_a_right_angle(tilt, limit):
    one = ready(ball(20.0), tilt, f"tilt:{limit:g}", grid=41)
    upper = one.samples.normal @ Z >= -1e-9
    assert (one.samples.normal[upper] @ Z).min() < 0.02
    assert held(one, Z)[upper].all() == (tilt + limit >= 90.0)


def test_a_table_only_takes_away_and_more_so_near_it():
    one = ready(box(), 89.0, "unlimited")
    low = float(one.samples.point[:, 2].min())
    free, over = held(one, Z), holdable(one.samples, one.cutters, one.conditions, Z, low)
    assert free.all()
    # A tool of 60 mm that is 62 mm long at most above the table leans 90 deg and a little more: not to the underside's normal.
    height = one.samples.point[:, 2] - low
    least = np.arccos(-np.minimum(1.0, (height + 2.0) / 60.0))
    angle = np.arccos(np.clip(one.samples.normal @ Z, -1.0, 1.0))
    assert not (angle[over] - math.radians(89.0) > np.arccos(-np.minimum(1.0, (height[over].max() + 2.0) / 60.0))).any()
    assert over[angle <= least].all()


def test_the_table_of_a_ranking_is_the_fixture():
    scene, axis = ready(box(), 89.0, "unlimited").scene, (0.0, -0.6, 0.8)
    fixture, laid = scene.turned_to(axis).clamped("table").surround(), scene.surround_held(axis, "table")
    assert laid.possible.triangles.vertex.tolist() == fixture.possible.triangles.vertex.tolist()
    assert laid.possible.weight.tolist() == fixture.possible.weight.tolist()


def test_directions_are_unit_and_differ():
    every = distinct(np.concatenate([cube(), fibonacci(60), cube()]))
    assert np.allclose(np.linalg.norm(every, axis=1), 1.0)
    assert len(cube()) == 26
    assert tuple(every[0]) == (0.0, 0.0, 1.0)
    near = every @ every.T - 2.0 * np.eye(len(every))
    assert near.max() < math.cos(math.radians(0.1))


def test_what_a_cube_stands_on():
    one = ready(box(), 89.0, "unlimited")
    found = Candidates.of(one)
    normal = {n: one.samples.normal[one.samples.face == n][0] for n in np.unique(one.samples.face).tolist()}
    for axis, stands in zip(found.axis, found.stands_on, strict=True):
        assert set(stands) == {n for n, out in normal.items() if out @ axis < -1.0 + 1e-9}


HOW = {"cutters": "R2L60", "faces": "all", "grid": 3, "area_budget": 0}


def test_a_proposal_stands_on_faces_and_holds_what_it_promised():
    found = plan(box(), setup="auto", stock="part", machine="trunnion-ac", **HOW)
    said = found.plan.setup_proposal
    first, second = said.setups
    assert (said.held, said.tried) == (True, 1)
    assert len(first.stands_on) == len(second.stands_on) == 1
    assert first.stands_on != second.stands_on
    assert tuple(found.plan.effective.setup) == tuple(first.axis)
    assert found.plan.effective.placement.clamped == first.stands_on
    assert [each.name for each in found.plan.fixtures] == ["fixture:table", "fixture:vise"]
    assert "setup_proposed" in found.plan.note_codes
    told = story_of(found.plan).proposal[0]
    assert told.startswith(f"Proposed setups: 1 on {first.stands_on[0]}, with ")
    assert f" 2 in a vise that grips {second.grips[0]}, {second.grips[1]}, with " in told
    assert found.plan.process.left == []
    assert said.found == pytest.approx(1.0)
    # By hand in the same two setups, each on a table of its own, the same is reached.
    places = [Placement(z=each.axis, clamped=tuple(each.stands_on), fixtures=(Fixture.parse("table"),)) for each in said.setups]
    again = plan(box(), setup=places[0], other_setups=places[1:], machine="trunnion-ac", **HOW)
    (mine,), (by_hand,) = found.plan.cutters, again.plan.cutters
    assert (by_hand.accessible, by_hand.inaccessible) == (mine.accessible, mine.inaccessible)
    assert mine.feasible
    assert by_hand.feasible
    # In the first alone, the face that the part stands on is lost to the table that nobody else has.
    alone = plan(box(), setup=places[0], machine="trunnion-ac", **HOW).plan.cutters[0]
    assert not alone.feasible
    assert alone.by_reason["fixture"] > 0
    assert alone.by_reason["another_setup"] == 0


@pytest.mark.slow("plans parts whole")
def test_with_operations_the_fewest_setups_are_planned_together():
    found = plan(box(), setup="auto", machine="trunnion-ac", operations="fewest", stock="part", **HOW)
    said = found.plan.setup_proposal
    assert len(said.setups) == 2
    assert said.held
    told = story_of(found.plan).proposal[0]
    assert f" 1 on {said.setups[0].stands_on[0]}" in told
    assert f" 2 in a vise that grips {said.setups[1].grips[0]}" in told
    assert "100 % of the area" in told or said.found < 1.0
    assert said.found > 0.99
    held = [{int(name[1:]) for name in each.stands_on} for each in said.setups]
    assert held[0]
    assert not held[0] & held[1]
    made = found.answers.operations.plans[0]
    assert {each.setup for each in made.operations} == {0, 1}
    for each in made.operations:
        assert not set(found.samples.face[each.rows].tolist()) & held[each.setup]


@pytest.mark.slow("plans parts whole")
def test_a_promise_that_is_not_held_is_followed_by_the_next_one(monkeypatch):
    """A ranking that promises too much: its plan falls short, the next direction is tried, and the plan says which one it is."""

    def boastful(one, *how):
        made = ranked(one, *how)
        first = made.choose(1)[0]
        made.held[first] = replace(made.held[first], served=np.ones(len(made.rows), bool))
        made.settled.add(first)
        return made

    monkeypatch.setattr(setup_ranking, "ranked", boastful)
    how = {**HOW, "cutters": "R2L60rc2", "cache": False}
    said = plan(box(), setup="auto", machine="tilt:30", **how).plan.setup_proposal
    assert said.held
    assert said.tried == 2

    def all_boastful(one, *how):
        made = ranked(one, *how)
        made.held = {k: each and replace(each, served=np.ones(len(made.rows), bool)) for k, each in made.held.items()}
        made.settled |= set(made.held)
        return made

    monkeypatch.setattr(setup_ranking, "ranked", all_boastful)
    found = plan(box(), setup="auto", machine="tilt:30", **how).plan
    said = found.setup_proposal
    assert any("does not hold" in line for line in story_of(found).proposal)
    assert not said.held
    assert "holds only" in said.why
    assert said.found < said.promised


@pytest.mark.parametrize("word", ["R3L40", "R3L40rc3F20S3HR21L60", "R5L50rc1F22S4HR21L60", "R2L30rc2F8N1.5x8S2"])
def test_no_point_of_a_tool_lies_below_its_lowest(word):
    """Points that lie in the tool are above; along the normal a flat end at any tilt comes down to the contact, no lower."""
    rng, tool = np.random.default_rng(3), assembly(Cutter.parse(word), 0.0, 0.0)
    for tilt in rng.uniform(0.01, 1.5, 40):
        normal, lean, down = np.linalg.qr(rng.normal(size=(3, 3)))[0]
        postures = blank(1)
        postures.axis[0] = np.cos(tilt) * normal + np.sin(tilt) * lean
        postures.tilt_direction[0], postures.tilt[0] = lean, tilt
        point = rng.uniform(-50, 50, 3)
        for direction in (down, normal, lean, -normal):
            (low,) = tool.lowest(point[None], normal[None], postures, direction)
            around = (
                point
                + rng.uniform(-1, 1, (4000, 3)) * rng.choice([4.0, 30.0], (4000, 1))
                + np.outer(rng.uniform(0, 100, 4000), postures.axis[0])
            )
            within = around[tool.depth(around, point, normal, lean, float(tilt)) > 0.0]
            assert len(within)
            assert (within @ direction >= low - 1e-9).all()
            assert low > (within @ direction).min() - 25.0
        if word == "R3L40":
            assert tool.lowest(point[None], normal[None], postures, normal)[0] == pytest.approx(point @ normal)


def test_where_nothing_is_within_the_limits_it_is_one_line():
    flat = Options(cutters="R2L40", faces="all", grid=5, tilt=(1.7, 1.9), setup="auto", machine="3-axis")

    def never(*_, **__):
        raise AssertionError

    with pytest.raises(OptionError, match=r"in none of \d+ directions does machine 3-axis hold") as caught:
        judged_proposed(SimpleNamespace(prepare=prepare, looked=lambda *_: None, judge=never, clock=Clock()), box(), flat)
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize(
    ("words", "cause"),
    [
        ({"setup": "auto", "other_setups": ["+x"]}, "leave out the other setups"),
        ({"setup": "+x", "other_setups": ["auto"]}, "leave out the other setups"),
        ({"setup": "auto", "fixtures": "table:-5"}, "leave out other fixtures"),
        ({"setup": "auto", "placement": Placement()}, "leave out the other setups"),
    ],
)
def test_auto_stands_alone(words, cause):
    with pytest.raises(OptionError, match=cause):
        Options(**words)


@pytest.mark.parametrize(
    ("words", "cause"),
    [
        (("--setup", "+x", "--setup", "auto"), "leave out the other setups"),
        (("--setup", "auto", "--fixture", "table:-5"), "leave out other fixtures"),
        (("--setup", "auto", "--check-operations", "x"), "name the setup"),
    ],
)
def test_the_command_says_so_in_one_line(tmp_path, words, cause):
    assert_one_line(run(SAMPLES / "v_groove.step", "--cutter", "R2L30", *words, "--quiet", cwd=tmp_path), 2, cause)


def test_setups_named_behind_auto_take_its_place_and_it_is_said(tmp_path):
    """So an option of advice may be typed behind the command that was given."""
    part, words = SAMPLES / "v_groove.step", ("--cutter", "R2L30", "--grid", "5", "--formats", "json", "--area-budget", "0")
    told = run(part, *words, "--setup", "auto", "--setup", "0,0,1", "--setup", "+x", "-o", "named", cwd=tmp_path)
    run(part, *words, "--setup", "0,0,1", "--setup", "+x", "-o", "alone", cwd=tmp_path)
    assert told.stderr.count("--setup auto: 2 named behind it take its place; nothing is proposed") == 1
    named, alone = (json.loads((tmp_path / name / "plan.json").read_text()) for name in ("named", "alone"))
    assert {**named, "run": 0} == {**alone, "run": 0}
