"""What would make a cutter finish: closed forms, what a plan says with the change and a step before it, and no help."""

import functools
import math
from dataclasses import fields, replace

import numpy as np
import pytest

from cad_io import read_part
from plan_cutters import Cutter, Options, Scene, plan
from plan_cutters.answers.mend import mend
from plan_cutters.answers.trial import Case, Trials, batches
from plan_cutters.answers.what_if import none, search
from plan_cutters.answers.what_if_cutter import GRAIN
from plan_cutters.answers.what_if_place import setup
from plan_cutters.domain.change import THINGS
from plan_cutters.domain.machine import Machine
from plan_cutters.domain.standard_tools import CORNERS, METRIC, MOST, USUAL, slenderness, smaller
from plan_cutters.pipeline import prepare
from plan_cutters.scene import flats_and_flanks
from plan_cutters.stages.judge import judge
from tests.support import shapes
from tests.support.bodies import lidded, stacked
from tests.support.cad_parts import box, compound, cut
from tests.support.places import SAMPLES

LONG = (-60, 60)
UPRIGHT = {"tilt": (0.0, 0.0)}


def asked(part, cutter, **options):
    """The mend of a cutter, its changes by thing, and what it was planned with."""
    options = {"cutters": (Cutter.of(cutter),), "grid": 5, "area_budget": 0} | options
    ready = prepare(part, Options(**options))
    (cutter,) = ready.cutters
    found = mend(ready, cutter, judge(ready, cutter))
    assert sorted(each.thing for each in found.changes) == sorted(THINGS) or not found.changes
    return found, {each.thing: each for each in found.changes}, (part, options)


def feasible(planned, **other):
    """What a plan says with another option."""
    part, options = planned
    return plan(part, **(options | other)).cutters[0].feasible


def before(change, planned):
    """The options with the value a step before the one asked for."""
    cutter, value = planned[1]["cutters"][0], change.beyond
    if value == change.now:
        return {}
    return {
        "stick_out": lambda: {"cutters": (replace(change.cutter, length=value),)},
        "radius": lambda: {"cutters": (sold(cutter, value, change.cutter),)},
        "corner_radius": lambda: {"cutters": (replace(cutter, corner_radius=value),)},
        "tilt_limit": lambda: {"machine": Machine.parse(f"tilt:{value:.6g}")},
        "tilt_range": lambda: {"tilt": tuple(np.radians(value))},
        "setup": lambda: {"setup": value},
        "tolerance": lambda: {"tolerance": value},
    }[change.thing]()


def sold(cutter, radius, like):
    """The cutter of the table of a radius, held as far out as another one in diameters."""
    return next(each for each in smaller(cutter, USUAL if slenderness(like) < 5.1 else MOST) if each.radius == radius)


def holds(change, planned):
    """With the change a plan says yes, without it or with a step less no."""
    assert change.helps is True
    assert change.left == 0
    assert feasible(planned, **change.options) is True
    if change.beyond is not None:
        assert feasible(planned, **before(change, planned)) is not True


def strip(low, high):
    return shapes.plane((low, high), LONG, (0, 0, 0))


def wall(x, height, way):
    """A wall in the plane x, from the height of the floor up, its free side towards +x or -x."""
    return shapes.plane((0, height), LONG, (x, 0, 0), (way, 0, 0), (0, 0, 1))


def inclined(degrees):
    """A square, its normal leaning from z to x by an angle."""
    sine, cosine = math.sin(math.radians(degrees)), math.cos(math.radians(degrees))
    z, x = (sine, 0, cosine), (cosine, 0, -sine)
    return shapes.shell(shapes.plane((-10, 10), (-10, 10), (0, 0, 0), z, x))


@functools.cache
def slit():
    """A block with a slit in its top, so narrow that nothing that can be judged goes in: the numbers of its tops, and of the
    bottom of the slit.
    """
    part = read_part(cut(box(16, 40, 10), box(0.02, 60, 5, at=(7.99, -10, 5))))
    samples = plan(part, cutters="R3L40", faces="all", grid=2, area_budget=0).samples
    up = samples.normal[:, 2] > 0.5
    (bottom,) = {int(n) for n in samples.face[up & (samples.point[:, 2] < 7)]}
    return part, sorted({int(n) for n in samples.face[up]} - {bottom}), bottom


# --- closed forms ---------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("holder", "length"),
    # A cylinder has to clear the wall; a cone is as wide as its distance, 8 + 3, at 12 over its nose.
    [("R15L200", 40.0), ("R5:15L20+R15L200", 28.0)],
)
def test_the_holder_is_lifted_over_the_wall_beside_the_contact(holder, length):
    part = shapes.shell(strip(0, 10), wall(-8, 40, 1))
    cutter = Cutter.flat(radius=3, length=25, flutes=10.0, shank_radius=3.0, holder=holder)
    _, by, planned = asked(part, cutter, faces="F1", **UPRIGHT)
    change = by["stick_out"]
    assert change.asked == pytest.approx(length, abs=1.5 * GRAIN)
    assert change.beyond == pytest.approx(change.asked - GRAIN)
    assert (change.now, change.cutter.flutes, change.cutter.length) == (25.0, 10.0, change.asked)
    assert change.verified == 25
    holds(change, planned)


def test_a_cutter_that_cuts_all_along_does_not_cut_higher_when_it_stands_out_further():
    part = shapes.shell(strip(0, 10), wall(-8, 40, 1))
    _, by, planned = asked(part, Cutter.flat(radius=3, length=25, holder="R15L200"), faces="F1", **UPRIGHT)
    change = by["stick_out"]
    assert change.asked == pytest.approx(40.0, abs=1.5 * GRAIN)
    assert change.cutter.flutes == 25.0
    holds(change, planned)


@pytest.mark.slow("another kind of the same law", only=("flat",))
@pytest.mark.parametrize("stays", [Cutter.ball, None], ids=["ball", "flat"])
def test_the_largest_end_between_two_walls(stays):
    """Where it stands nearest to one wall, 4.5 mm, a ball goes no wider; a flat end may stand aside by a rotation."""
    part = shapes.shell(strip(4.5, 5.5), wall(0, 60, 1), wall(10, 60, -1))
    cutter = Cutter.ball(radius=6, length=60) if stays else Cutter.flat(radius=6, length=60)
    _, by, planned = asked(part, cutter, faces="F1", **UPRIGHT)
    change = by["radius"]
    turns = np.sin(np.radians(np.arange(0, 360, 10)))
    most = 4.5 if stays else np.minimum(4.5 / (1 + turns + 1e-12), 5.5 / (1 - turns + 1e-12)).max()
    # Of diameters 10 and 8, or of 10 and 12.
    usual = [0.5 * each.diameter for each in METRIC]
    assert change.asked == max(r for r in usual if r <= most + 0.01)
    assert change.beyond == min([r for r in usual if change.asked < r < 6.0], default=6.0)
    assert change.cutter.corner_radius == (change.asked if stays else 0.0)
    assert change.cutter.length == 5.0 * 2.0 * change.asked
    holds(change, planned)


def test_the_least_limit_is_the_angle_of_the_face():
    _, by, planned = asked(inclined(40.05), "R3L40", machine="tilt:30", **UPRIGHT)
    change = by["tilt_limit"]
    assert (change.now, change.asked, change.beyond) == (30.0, 40.1, 40.0)
    holds(change, planned)


def test_the_setup_axis_turns_by_what_the_limit_lacks():
    _, by, planned = asked(inclined(40.05), "R3L40", machine="tilt:30", **UPRIGHT)
    change = by["setup"]
    # 10.05 deg are lacking, on the way straight to the normal; a step is a degree.
    angle = math.degrees(math.acos(np.dot(change.asked, (0, 0, 1))))
    assert angle == pytest.approx(11.0, abs=1e-3)
    assert np.cross(change.asked, (math.sin(math.radians(40.05)), 0, math.cos(math.radians(40.05)))) == pytest.approx(
        [0, math.sin(math.radians(29.05)), 0], abs=1e-5
    )
    assert math.degrees(math.acos(np.dot(change.beyond, (0, 0, 1)))) == pytest.approx(10.0, abs=1e-3)
    holds(change, planned)


def test_the_range_of_tilts_is_widened_by_what_the_limit_lacks():
    _, by, planned = asked(inclined(40.05), "R3L40", machine="tilt:30", **UPRIGHT)
    change = by["tilt_range"]
    assert change.asked == (0.0, 10.1)
    assert change.beyond == (0.0, 10.0)
    holds(change, planned)


def test_the_lower_end_of_the_tilts_is_lowered_where_that_asks_less():
    """Held within 20 deg of the normal, tilts from 20.5 on are 0.5 deg too large."""
    part = inclined(0.0)
    _, by, planned = asked(part, "R3L40", machine="tilt:20", tilt=(math.radians(20.5), math.radians(90)))
    change = by["tilt_range"]
    assert change.asked == (20.0, 90.0) or change.asked == (19.9, 90.0)
    holds(change, planned)


def test_the_corner_that_the_surface_asks_for():
    """A bottom of radius 5 curves more than a bull nose's flat; of balls the one of the same radius alone lies in it."""
    part = shapes.shell(shapes.trough(5.0, 40.0, span=2.0))
    _, by, planned = asked(part, Cutter.flat(radius=4, length=60), tilt=(0.0, math.radians(1)))
    change = by["corner_radius"]
    assert change.cutter.radius == 4.0
    holds(change, planned)
    # Each radius of the list between now and then was tried, and fails in a plan as well.
    nearer = [c for c in (*trial_corners(), 4.0) if c < change.asked]
    assert max(nearer) == change.beyond
    for corner in nearer:
        assert feasible(planned, cutters=(replace(change.cutter, corner_radius=corner),)) is False


def trial_corners():
    return [0.0, *CORNERS]


def test_only_leaving_out_the_bottom_of_a_slit_helps():
    part, tops, bottom = slit()
    cutter = Cutter.flat(radius=3, length=40, holder="R10L40")
    found, by, planned = asked(part, cutter, faces=[*tops, bottom], machine="tilt:60")
    assert [each.thing for each in found.changes if each.helps] == ["faces"]
    assert found.least is by["faces"]
    assert by["faces"].asked == (f"F{bottom}",)
    assert by["faces"].verified == 50
    assert by["faces"].why.startswith(f"F{bottom} left out of what is to be finished: 0.8 mm², ")
    holds(by["faces"], planned)
    assert all(each.why.startswith("does not help: ") for each in found.changes if not each.helps)
    assert all(each.asked is None for each in found.changes if not each.helps)


def test_where_nothing_helps_that_is_said():
    part, _, bottom = slit()
    found, by, _ = asked(part, Cutter.flat(radius=3, length=40), faces=[bottom])
    assert found.least is None
    assert found.why == "no change of one thing is known to help"
    assert by["faces"].why == "does not help: every target face has samples that are lost"
    assert by["tilt_limit"].why == "does not help: the machine has no limit"
    # At its ends the cutter comes from the side.
    assert {each.left for each in found.changes} == {15}


# --- what is not decided, and what lies within a body ---------------------------------------------------------------------


def test_nothing_is_asked_about_what_lies_inside_another_body():
    """It is no surface of the finished part: the rest is mended as if it were not there."""
    found, by, _ = asked(stacked(), "R2L30", faces="6,7,11", grid=9)
    assert (found.lost, found.buried) == (90, 90)
    assert not by
    assert found.why == "90 samples are within another body, which is no surface of the finished part; nothing else is lost"
    found, by, planned = asked(stacked(), "R2L30", faces="6,7,11", grid=9, machine="tilt:60", setup=(1, 0, 0))
    assert 0 < found.buried < found.lost
    assert by["tilt_limit"].helps
    again = plan(planned[0], **(planned[1] | by["tilt_limit"].options))
    assert not (again.reaches[again.shown].lost & again.ready.finished).any()


def test_missing_obstacles_leave_it_open():
    found, by, _ = asked(lidded(), "R2L30", faces="6", grid=4)
    assert found.lost == 16
    assert not any(each.helps for each in found.changes)
    # A smaller cutter does not fit beneath the lid for sure, nor is it proved to be stopped.
    assert by["radius"].helps is None
    # One face that is reached, one that is not: leaving it out leaves the same doubt.
    found, by, _ = asked(lidded(), Cutter.flat(radius=2, length=30), faces="1,6", grid=4, machine="tilt:90")
    assert by["faces"].helps is None
    assert "missing" in by["faces"].why
    found, _, _ = asked(lidded(gap=500.0), "R2L30", faces="6", grid=4)
    assert (found.lost, found.changes) == (0, ())
    assert "missing" in found.why


def beside_a_post(away):
    """A strip, and beside it the part of a round post of radius 40 that faces it, `away` from a holder of radius 15 there."""
    from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeFace
    from OCP.gp import gp_Cylinder

    frame = shapes.axes((-40 - 15 - away, 0, 20), (0, 0, 1), (1, 0, 0))
    return shapes.shell(
        shapes.plane((0, 0.1), (-0.05, 0.05)), BRepBuilderAPI_MakeFace(gp_Cylinder(frame, 40.0), -1.5, 1.5, 0.0, 60.0).Face()
    )


def test_a_finer_tolerance_decides_what_the_triangles_leave_open():
    cutter = Cutter.ball(radius=3, length=25, holder="R15L20")
    options = {"faces": "F1", "tolerance": 0.5, "grid": 2} | UPRIGHT
    error = Scene.of(beside_a_post(5.0), tolerance=0.5).surround().certain.triangles.chord_error
    finer = Scene.of(beside_a_post(5.0), tolerance=0.25).surround().certain.triangles.chord_error
    assert finer < 0.7 * error
    found, by, planned = asked(beside_a_post(0.5 * (error + finer)), cutter, **options)
    change = by["tolerance"]
    assert found.lost > 0
    assert (change.asked, change.beyond) == (0.25, 0.5)
    holds(change, planned)
    # What touches for certain is not mended so.
    _, by, _ = asked(beside_a_post(-1.0), cutter, **options)
    assert by["tolerance"].helps is False
    assert "blocked for certain" in by["tolerance"].why


def test_a_setup_axis_that_leaves_samples_undecided_alone_is_undecided():
    """From the side the limit of the axis blocks; from above only the triangles of the post are in doubt."""
    options = {"faces": "F1", "tolerance": 0.5, "grid": 2, "area_budget": 0} | UPRIGHT
    around = Scene.of(beside_a_post(5.0), tolerance=0.5).surround()
    part = beside_a_post(0.5 * around.certain.triangles.chord_error)
    cutter = Cutter.ball(radius=3, length=25, holder="R15L20")
    ready = prepare(part, Options(cutters=(cutter,), setup=(1, 0, 0), machine="tilt:3", **options))
    (cutter,) = ready.cutters
    trials = Trials.of(judge(ready, cutter), ready.finished)
    assert trials.blocked
    # As if another rotation or tilt served without the limit.
    trials.found["tilt_limit"] = none("tilt_limit", 3.0, 0, "")
    found = search("setup", setup(Case(ready, cutter), trials), trials)
    assert (found.helps, found.asked) == (None, (0.0, 0.0, 1.0))
    assert found.why.startswith("is not decided: the best of ")
    assert found.why.endswith(f" {found.left} of {found.looked} samples undecided")
    above = plan(part, cutters=(cutter,), setup=found.asked, machine="tilt:3", **options).cutters[0]
    assert (above.feasible, above.undecided) == (None, found.left)


def test_a_cutter_that_finishes_has_nothing_to_mend():
    found, _, _ = asked(inclined(10.0), "R3L40")
    assert (found.lost, found.buried, found.changes, found.why, found.least) == (0, 0, (), "", None)


# --- laws -----------------------------------------------------------------------------------------------------------------


@pytest.fixture(scope="module", params=[1, 2, 3])
def wavy(request):
    """A random surface, worked with a cutter in a thick holder on a machine with a limit."""
    rng = np.random.default_rng(request.param)
    part = shapes.shell(shapes.Patch.random(rng, height=6.0).face())
    cutter = Cutter.flat(radius=2.5, length=9, flutes=6.0, shank_radius=2.5, holder="R14L60")
    return asked(part, cutter, grid=25, machine="tilt:35", tolerance=0.05, rotation_step=0.35)


@pytest.mark.slow("plans again for each answer", but=("1",))
def test_each_change_holds_in_a_plan_and_a_step_before_it_does_not(wavy):
    found, _, planned = wavy
    assert feasible(planned) is False
    for change in found.changes:
        if change.helps:
            assert change.verified == 625
            assert len(change.options) in (1, 2)
            holds(change, planned)
        else:
            assert not change.options


def test_changes_are_in_the_order_of_how_little_they_ask(wavy):
    found, _, _ = wavy
    ranks = [({True: 0, None: 1, False: 2}[each.helps], THINGS.index(each.thing)) for each in found.changes]
    assert ranks == sorted(ranks)


def test_one_thing_is_changed(wavy):
    """Another cutter differs in the one dimension, or in what follows it."""
    found, _, (_, options) = wavy
    follow = {
        "stick_out": {"length"},
        "radius": {"radius", "shank_radius", "length", "flutes", "neck"},
        "corner_radius": {"corner_radius"},
    }
    for change in found.changes:
        if change.cutter is not None:
            was = options["cutters"][0]
            differ = {each.name for each in fields(was) if getattr(was, each.name) != getattr(change.cutter, each.name)}
            assert differ <= follow[change.thing]


def test_the_largest_radius_is_that_of_trying_them_all():
    """The slow way: each cutter that is sold judged on all samples, from the top down."""
    part = shapes.shell(shapes.Patch.random(np.random.default_rng(1), height=6.0).face())
    cutter = Cutter.flat(radius=8, length=60)
    _, by, (_, options) = asked(part, cutter, grid=25, tolerance=0.05, rotation_step=0.35, machine="tilt:35")
    ready = prepare(part, Options(**options))
    serves = [each for each in smaller(cutter, USUAL) if not len(Case(ready, each).judged())]
    assert by["radius"].cutter == serves[0]
    assert by["radius"].asked == serves[0].radius


def test_batches_are_all_rows_once():
    rows = np.sort(np.random.default_rng(0).choice(10_000, 3_000, replace=False)).astype(np.int64)
    for some in (rows, rows[:17], rows[:0]):
        assert np.array_equal(np.sort(np.concatenate([np.zeros(0, np.int64), *batches(some)])), some)


@pytest.mark.slow("plans again for each answer", only=("peaks",))
@pytest.mark.parametrize(
    ("name", "cutter", "machine"),
    [
        ("peaks_and_valleys.step", Cutter.flat(radius=4, length=15, flutes=10.0, holder="R20L60"), "unlimited"),
        ("peaks_and_valleys.step", Cutter.bull(radius=6, corner_radius=1, length=60), "tilt:10"),
        ("pocket_top.step", Cutter.flat(radius=6, length=60), "tilt:10"),
    ],
)
def test_each_change_holds_on_the_samples(name, cutter, machine):
    found, _, planned = asked(read_part(SAMPLES / name), cutter, grid=31, machine=machine)
    helping = [each for each in found.changes if each.helps]
    assert helping
    for change in helping:
        holds(change, planned)


# --- the way it goes ------------------------------------------------------------------------------------------------------


def test_it_asks_for_no_more_searches_than_a_few_plans(monkeypatch):
    count, real = [], flats_and_flanks.search_postures
    monkeypatch.setattr(
        flats_and_flanks,
        "search_postures",
        lambda c, rows, *more, **words: count.append(len(rows)) or real(c, rows, *more, **words),
    )
    part = shapes.shell(shapes.Patch.random(np.random.default_rng(2), height=10.0).face())
    cutter = Cutter.flat(radius=2.5, length=9, flutes=6.0, shank_radius=2.5, holder="R14L60")
    found, _, _ = asked(part, cutter, grid=61, machine="tilt:35", tolerance=0.05, rotation_step=0.35)
    assert found.lost > 50
    assert sum(count) < 5 * 61**2


def test_it_tells_how_far_it_is_and_can_be_interrupted():
    part, tops, bottom = slit()
    ready = prepare(part, Options(cutters=("R3L40",), faces=[*tops, bottom], grid=5, area_budget=0))
    reach, told = judge(ready, ready.cutters[0]), []
    mend(ready, ready.cutters[0], reach, progress=lambda done, total: told.append((done, total)))
    assert told == [(done, len(THINGS)) for done in range(len(THINGS) + 1)]

    def stop(done, total):
        if done == 3:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        mend(ready, ready.cutters[0], reach, progress=stop)


def test_open_faces_keep_their_side_when_the_setup_turns():
    """Seen from the other side an open face would be worked on there: the change says so, or is not made."""
    part = compound(
        shapes.plane((-10, 10), (-10, 10), (0, 0, 0), (math.sin(1.7), 0, math.cos(1.7)), (0, 1, 0)), box(1, 1, 1, at=(90, 90, 0))
    )
    ready = prepare(part, Options(cutters=("R3L40",), grid=5, area_budget=0, machine="tilt:3", tilt=(0.0, 0.0), faces="F1"))
    cutter = ready.cutters[0]
    change = next(each for each in mend(ready, cutter, judge(ready, cutter)).changes if each.thing == "setup")
    assert change.helps
    again = plan(part, cutters=("R3L40",), grid=5, area_budget=0, machine="tilt:3", tilt=(0.0, 0.0), faces="F1", **change.options)
    assert again.cutters[0].feasible
    assert np.allclose(again.samples.normal, ready.samples.normal)


def test_what_stays_undecided_is_not_told_to_be_of_no_help():
    """Under a limit that is not all there is to it, the answer of another axis is that of no limit: in words, too."""
    _, by, _ = asked(lidded(), "R3L40", machine="tilt:30", faces="all", grid=4)
    assert by["tilt_limit"].helps is None
    assert by["setup"].helps is None
    for change in by.values():
        assert change.why.startswith("does not help") == (change.helps is False)
        if change.helps is None and change.asked is None:
            assert change.why.startswith("is not decided")
