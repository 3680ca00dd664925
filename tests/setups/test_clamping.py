"""Vises and chucks in their places: closed forms, rigid motion, what they hide, and where they find nothing to grip."""

import math

import cadquery as cq
import numpy as np
import pytest
from OCP.BRepAlgoAPI import BRepAlgoAPI_Cut, BRepAlgoAPI_Fuse
from OCP.BRepBuilderAPI import BRepBuilderAPI_Transform

from cad_io import read_part
from plan_cutters import Scene, plan, posture_map
from plan_cutters.domain.verdicts import ANOTHER_SETUP
from plan_cutters.errors import FixtureError, OptionError
from plan_cutters.plan_file.words.text import text_of
from tests.support.cad_parts import ball, box, compound, moved, real, rod
from tests.support.vises import hold_of

UP, DOWN = (0.0, 0.0, 1.0), (0.0, 0.0, -1.0)
HOW = {"faces": "all", "area_budget": 0, "machine": "tilt:110", "cutters": "D4L60", "spacing": 1.5}


def turned(shape, motion):
    return BRepBuilderAPI_Transform(shape, motion, True).Shape()


def direction(motion, axis):
    rotation = np.array([[motion.Value(i, j) for j in (1, 2, 3)] for i in (1, 2, 3)])
    return rotation @ axis


def test_a_block_is_gripped_by_its_largest_opposite_faces_in_the_smallest_vise():
    hold = hold_of(box(60, 40, 30), "vise")
    assert hold.fixture.text == "vise:46x25x65:3:40@30,20,0,0,0,-90"
    assert len(hold.grips) == 2
    assert len(hold.rests_on) == 1
    # The jaws are narrower than the faces: their width times the grip, on both.
    assert hold.hidden == pytest.approx(2 * 46 * 3)


@pytest.mark.parametrize(("length", "grip"), [(60.0, 3.0), (30.0, 3.0), (60.0, 5.0)])
def test_what_jaws_cover_is_their_width_times_the_grip_on_two_faces(length, grip):
    hold = hold_of(box(length, 20, 30), f"vise:46x25x65:{grip:g}")
    assert hold.hidden == pytest.approx(2 * min(46.0, length) * grip)


def test_of_what_is_no_target_jaws_hide_nothing_and_targets_are_spared():
    part = read_part(box(60, 40, 30))
    wide = hold_of(part, "vise")
    narrow = hold_of(part, "vise", targets=wide.grips)
    assert set(narrow.grips).isdisjoint(wide.grips)
    assert narrow.hidden == 0.0
    assert hold_of(part, "vise", targets=narrow.grips).grips == wide.grips


def test_a_bar_in_a_chuck():
    hold = hold_of(rod(25, 80, at=(3, 4, 5)), "chuck")
    chuck = hold.fixture.clamping
    assert hold.fixture.placement[:3] == pytest.approx((3, 4, 5))
    assert chuck.diameter == pytest.approx(50.0, abs=1e-6)
    assert (chuck.jaws, chuck.height) == (3, 20.0)
    # Three jaws, each an arc of its width: radius times angle times grip.
    assert hold.hidden == pytest.approx(3 * 25 * 2 * math.asin(0.16 * 80 / 50) * 3, rel=0.05)
    assert hold_of(rod(25, 80), "chuck:4x30:5").fixture.clamping.numbers == pytest.approx((4, 30, 5, 50), abs=1e-6)


def test_in_the_plan_just_what_the_jaws_cover_is_left_for_another_setup():
    """The jaws are wider than the part: 40 x 3 on two faces, what it rests on, and beside the jaws strips as wide as a tool."""
    found = plan(box(40, 30, 20), fixtures="vise", **HOW)
    (entry,) = found.plan.fixtures
    assert entry.hidden_mm2 == pytest.approx(2 * 40 * 3)
    (name,) = found.reaches
    verdicts, samples = found.reaches[name], found.samples
    held = np.isin(samples.face, [int(each[1:]) for each in entry.grips])
    low = samples.point[:, 2] < 3.0 - 1e-6
    assert (verdicts.not_reached[held & low]).all()
    assert not (verdicts.not_reached[held & (samples.point[:, 2] > 3.0 + 1e-6)]).any()
    assert (verdicts.reason[verdicts.not_reached] == ANOTHER_SETUP).all()
    (left,) = found.plan.process.left
    assert left.cause == "another_setup"
    assert set(left.faces) == {"F1", "F2", "F3", "F4", "F5"}
    assert sum(samples.area[held & verdicts.not_reached]) == pytest.approx(entry.hidden_mm2, rel=0.25)
    assert left.area_mm2 < 40 * 30 + entry.hidden_mm2 + 2 * 3 * 30
    assert found.plan.selected is None
    assert "grips F" in " ".join(found.plan.notes)


@pytest.mark.slow("plans a part in a chuck twice", only=("chuck",))
@pytest.mark.parametrize("word", ["vise", "chuck"])
def test_a_part_turned_with_its_setup_is_gripped_and_judged_alike(word):
    shape = box(40, 30, 20) if word == "vise" else rod(12, 30)
    motion = moved()
    there = tuple(direction(motion, UP).tolist())
    how = {**HOW, "grid": 13, "spacing": None}
    here, away = plan(shape, fixtures=word, **how), plan(turned(shape, motion), fixtures=word, setup=there, **how)
    one, other = here.plan.fixtures[0], away.plan.fixtures[0]
    assert one.grips == other.grips
    assert one.hidden_mm2 == pytest.approx(other.hidden_mm2, rel=1e-6)
    assert one.clamping.partition("@")[0].split(":")[1] == other.clamping.partition("@")[0].split(":")[1]
    (name,) = here.reaches
    same = here.reaches[name].reached == away.reaches[name].reached
    # Samples right at the edge of a jaw may go either way by rounding.
    assert same.mean() > 0.995


def test_numbers_of_a_plan_are_the_same_clamping_again(tmp_path):
    found = plan(box(40, 30, 20), fixtures="vise", **HOW)
    (entry,) = found.plan.fixtures
    again = plan(box(40, 30, 20), fixtures=entry.clamping, **HOW)
    assert again.plan.fixtures[0].clamping == entry.clamping
    assert again.plan.fixtures[0].placement == entry.placement
    one, other = (each.conditions.surroundings.fixtures[0].obstacles.triangles.vertex for each in (found, again))
    assert np.array_equal(one, other)


def test_what_hangs_below_the_gripped_faces_hangs_between_the_jaws():
    """A boss under a plate: the plate is gripped from its own lower edge up, the boss is in the vise."""
    shape = BRepAlgoAPI_Fuse(box(60, 40, 20), box(20, 10, 8, at=(20, 15, -8))).Shape()
    hold = hold_of(shape, "vise")
    assert hold.fixture.placement[2] == pytest.approx(0.0)
    assert " apart, from 8 mm above its lowest point; the jaws reach 3 mm above where it rests" in hold.words
    with pytest.raises(FixtureError, match="nothing to grip"):
        hold_of(BRepAlgoAPI_Fuse(box(60, 40, 20), box(20, 10, 300, at=(20, 15, -300))).Shape(), "vise")


@pytest.mark.slow("another radius of the same law", but=("4.0",))
@pytest.mark.parametrize("radius", [1.0, 2.0, 4.0])
def test_above_a_fillet_jaws_reach_as_far_as_without_it(radius):
    """The part stands on what the fillet leaves of its lower face: the jaws are higher, and the ledges longer."""
    block = cq.Workplane().box(60, 40, 30, centered=(True, True, False)).faces("<Z").edges().fillet(radius)
    bar = cq.Workplane().circle(20).extrude(60).faces("<Z").edges().chamfer(radius)
    for body, word in ((block, "vise"), (bar, "chuck")):
        hold = hold_of(body.val().wrapped, word)
        assert hold.fixture.placement[2] == pytest.approx(0.0, abs=1e-9)
        assert hold.fixture.clamping.grip == pytest.approx(3.0 if radius < 1.5 else radius + 3.0, abs=0.02)
        assert len(hold.rests_on) == 1
        again = Scene.of(body.val().wrapped, fixtures=hold.fixture.text)
        assert again.surround().fixtures[0].fixture.clamping == hold.fixture.clamping


def test_the_longer_faces_of_a_block_are_gripped_where_jaws_are_narrower_than_both():
    assert hold_of(box(80, 50, 40), "vise").fixture.clamping.gap == pytest.approx(50.0)
    assert hold_of(box(50, 80, 40), "vise").fixture.clamping.gap == pytest.approx(50.0)


def pocketed(x, y, z):
    """A plate with a pocket, between whose walls and the plate's own is material."""
    return BRepAlgoAPI_Cut(box(x, y, z), box(60, 50, z, at=(x / 2, y / 2, z - 10))).Shape()


def legged(leg=2.0, at=(0.0, 0.0, 0.0)):
    """A block 50 x 30 x 20 on two legs of its length at its ends."""
    x, y, z = at
    feet = [box(leg, 30, 10, at=(x + left, y, z)) for left in (0.0, 50.0 - leg)]
    return BRepAlgoAPI_Fuse(BRepAlgoAPI_Fuse(box(50, 30, 20, at=(x, y, z + 10)), feet[0]).Shape(), feet[1]).Shape()


@pytest.mark.parametrize("leg", [2.0, 8.0, 12.0])
@pytest.mark.parametrize("at", [(0.0, 0.0, 0.0), (-300.0, 41.0, 7.0)])
def test_of_places_that_hide_as_much_the_one_about_the_parts_middle_is_taken(leg, at):
    """Both legs, and the block between their outer faces, touch and hide as much."""
    hold = hold_of(legged(leg, at), "vise")
    assert hold.fixture.clamping.gap == pytest.approx(50.0)
    assert hold.fixture.placement[0] == pytest.approx(at[0] + 25.0)
    assert len(hold.rests_on) == 2


def test_a_thin_leg_is_gripped_only_where_nothing_else_can_be():
    """Faces to machine are hidden rather than 50 mm held by 2 mm; a vise that opens no farther has no choice."""
    part = read_part(legged())
    outer = hold_of(part, "vise").grips
    assert hold_of(part, "vise", targets=outer[:1]).grips == outer
    alone = hold_of(part, "vise:46x25x20:3")
    assert alone.fixture.clamping.gap == pytest.approx(2.0)
    # The other leg is 46 mm from any ledge.
    assert len(alone.rests_on) == 1


def test_a_chuck_grips_the_hub_rather_than_a_foot():
    """Three feet and a hub of one diameter under a disk touch and hide as much."""
    disk = rod(60, 10, at=(0, 0, 15))
    for k in range(3):
        foot = rod(8, 15, at=(45 * math.cos(2 * k), 45 * math.sin(2 * k), 0))
        disk = BRepAlgoAPI_Fuse(disk, foot).Shape()
    hold = hold_of(BRepAlgoAPI_Fuse(disk, rod(8, 15)).Shape(), "chuck:3x15:3")
    assert hold.fixture.placement[:2] == pytest.approx((0.0, 0.0), abs=1e-6)
    assert len(hold.rests_on) == 1


def test_what_hangs_between_the_jaws_is_not_rested_on():
    """Three feet: the one in the middle, as low as the others, is over the gap between the jaws."""
    block = box(60, 100, 20, at=(0, 0, 8))
    for left in (0, 25, 50):
        block = BRepAlgoAPI_Fuse(block, box(10, 100, 8, at=(left, 0, 0))).Shape()
    part = read_part(block)
    hold = hold_of(part, "vise:46x25x65:3")
    assert hold.fixture.clamping.gap == pytest.approx(60.0)
    assert sorted(part.centre(number)[0] for number in hold.rests_on) == pytest.approx([5.0, 55.0])


def unheld(part, word="vise", setup=UP):
    scene = Scene.of(part, fixtures=word, setup=setup)
    (placed,) = scene.surround().fixtures
    again = Scene.of(part, fixtures=placed.fixture.text, setup=setup).surround().fixtures[0]
    assert again.unheld == placed.unheld, "by its numbers it holds what it held"
    return placed


JAWS = "The jaws of the vise do not hold the body of F7."


def test_a_body_that_no_jaw_grips_is_told():
    """A block and a loose one beside it, of which the larger is gripped: nothing of the other is said to rest in the vise."""
    result = plan(compound(box(50, 30, 20), box(10, 10, 10, at=(60, 10, 0))), fixtures="vise", **HOW)
    (entry,) = result.plan.fixtures
    assert entry.unheld == ["F7"]
    assert entry.grips == ["F3", "F4"]
    assert "the part rests on F5;" in entry.notes[0]
    apart = "The file has 2 bodies that do not touch: F1-6, F7-12. Each is clamped and machined by itself: plan one at a time, "
    assert result.plan.process.doubts == [apart + "the first with `--ignore F7-12`.", JAWS]
    assert "do not hold the body of F7" in " ".join(text_of(result.plan).lines[:6])


def test_stock_holds_all_bodies_in_it():
    part = compound(box(50, 30, 20), box(10, 10, 10, at=(60, 10, 0)))
    _, vise = Scene.of(part, fixtures=("stock:box", "vise")).surround().fixtures
    assert (vise.fixture.clamping.grip > 0.0, vise.unheld) == (True, ())


def test_no_body_is_held_across_a_gap():
    part = compound(box(20, 30, 20), box(20, 24, 20, at=(40, 3, 0)))
    vise = "vise:46x25x65:3:{}@{},15,0"
    assert unheld(part, vise.format(60, 30)).unheld == (1, 7)
    assert unheld(part, vise.format(20, 10)).unheld == (7,)


@pytest.mark.parametrize(
    ("shape", "faces"),
    [
        (lambda: box(40, 30, 20), 0),
        # Both halves have both jaws on them, or lie one against the other between the jaws.
        (lambda: compound(box(20, 30, 20), box(20, 30, 20, at=(22, 0, 0))), 0),
        (lambda: compound(box(20, 30, 20), box(20, 24, 20, at=(20, 3, 0))), 0),
        # A void is no body, and what lies in it cannot be gripped.
        (lambda: BRepAlgoAPI_Cut(box(40, 30, 20), ball(4, at=(20, 15, 10))).Shape(), 0),
        (lambda: compound(BRepAlgoAPI_Cut(box(40, 30, 20), ball(4, at=(20, 15, 10))).Shape(), ball(2, at=(20, 15, 10))), 1),
        (lambda: compound(box(40, 30, 20), box(4, 4, 4, at=(20, 15, 20))), 1),
    ],
)
def test_bodies_that_are_held_have_both_jaws_on_them_or_lie_between_them(shape, faces):
    placed = unheld(shape(), "vise:46x25x65:3")
    assert len(placed.unheld) == faces


@pytest.mark.slow("draws a disc 600 mm wide", only=("<lambda>-chuck-the cylinder is 600 mm wide0",))
@pytest.mark.parametrize(
    ("shape", "word", "why"),
    [
        (lambda: ball(), "vise", "no two opposite plane faces stand along it"),
        (lambda: rod(), "vise", "no two opposite plane faces stand along it"),
        (lambda: box(60, 40, 30), "vise:10x10x20", " are 40 mm apart, and the vise opens to 20 mm"),
        (lambda: box(600, 400, 300), "vise", " are 400 mm apart, and the vise opens to 355 mm"),
        (lambda: pocketed(600, 400, 30), "vise", " are 400 mm apart, and the vise opens to 355 mm"),
        (lambda: compound(rod(300, 6), rod(10, 20, at=(0, 0, 6))), "chuck", "the cylinder is 600 mm wide"),
        (lambda: box(4, 4, 200), "vise", "the part stands 200 mm high, and jaws touch no more than 4 mm"),
        (lambda: box(60, 40, 30), "chuck", "no outside cylinder along it reaches all round"),
        (lambda: rod(300, 50), "chuck", "the cylinder is 600 mm wide"),
    ],
)
def test_where_nothing_can_be_gripped_one_line_says_why_and_what_to_try(shape, word, why):
    with pytest.raises(FixtureError) as error:
        hold_of(shape(), word)
    assert why in str(error.value)
    assert "\n" not in str(error.value)
    assert "try another setup" in str(error.value)


def test_pockets_and_bores_are_not_gripped():
    """Faces that look at each other, and an inside cylinder, are no outside."""
    frame = BRepAlgoAPI_Cut(rod(40, 20), box(30, 30, 40, at=(-15, -15, -10))).Shape()
    with pytest.raises(FixtureError, match="nothing to grip"):
        hold_of(frame, "vise")
    bored = BRepAlgoAPI_Cut(box(60, 60, 20), rod(20, 40, at=(30, 30, -10))).Shape()
    with pytest.raises(FixtureError, match="nothing to grip"):
        hold_of(bored, "chuck")


def test_jaws_never_stand_in_the_part():
    """Where a flange is in the way of the jaws, another pair is gripped."""
    flanged = BRepAlgoAPI_Fuse(box(60, 40, 30), box(10, 60, 10, at=(25, -10, 0))).Shape()
    hold = hold_of(flanged, "vise:46x25x65")
    scene = Scene.of(flanged, fixtures=hold.fixture)
    assert scene.surround().fixtures[0].fixture == hold.fixture


def test_each_setup_has_a_vise_of_its_own():
    found = plan(box(40, 30, 20), fixtures="vise", other_setups=[DOWN], **HOW)
    assert [each.setups for each in found.plan.fixtures] == [[0], [1]]
    assert "setup_without_fixtures" not in found.plan.note_codes
    (name,) = found.reaches
    assert found.reaches[name].reached.all()
    assert found.plan.process.finished_share == pytest.approx(1.0)


def test_a_scene_and_a_posture_map_take_them_too():
    part = box(40, 30, 20)
    scene = Scene.of(part, fixtures="vise")
    assert scene.surround().fixtures[0].hold is not None
    # On a side face, just above a jaw and under it.
    free = [
        posture_map(scene, point=(20, 30, z), cutter="D4L60", rotations=np.linspace(0, 6, 13), tilt=(0, 1.5)).free
        for z in (1.5, 12.0)
    ]
    assert not any(len(each) for each in free[0])
    assert any(len(each) for each in free[1])


@pytest.mark.parametrize("words", [["vise", "vise"], ["vise", "chuck"], ["vise", "vise:46x25x65:3:40@30,20,0,0,0,-90"]])
def test_one_vise_or_chuck_is_placed_on_a_part(words):
    with pytest.raises(OptionError, match="one vise or chuck is placed on a part") as error:
        plan(box(), fixtures=words, **HOW)
    assert "\n" not in str(error.value)


@pytest.mark.slow("plans each proposed clamping")
@pytest.mark.parametrize("file", real("hard/ampath_propeller.stp"), ids=lambda path: path.stem)
def test_a_propeller_has_no_faces_for_a_vise(file):
    with pytest.raises(FixtureError, match="nothing to grip"):
        hold_of(read_part(file), "vise")
