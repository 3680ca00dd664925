"""What jaws touch at each place where they may grip, by closed forms, and how a vise or chuck stands in a setup."""

import math
from itertools import pairwise

import cadquery as cq
import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from OCP.BRepAlgoAPI import BRepAlgoAPI_Cut, BRepAlgoAPI_Fuse

from plan_cutters import Scene
from plan_cutters.domain.clamping import requested
from plan_cutters.domain.fixture import Fixture
from plan_cutters.domain.stock import Stock, StockBody
from plan_cutters.errors import FixtureError
from plan_cutters.setups import solids
from plan_cutters.setups.clamping import held_stock
from plan_cutters.setups.places import _degrees_of, vise_places
from plan_cutters.setups.workpiece import PartMesh, Workpiece, clipped, faces_in_jaws
from tests.support.cad_parts import box, rod
from tests.support.vises import hold_of

UP = (0.0, 0.0, 1.0)


def workpiece(*boxes, setup=UP, targets=()):
    """Boxes, each by two corners, with six faces each: x low and high, y low and high, z low and high."""
    vertex = np.concatenate([solids.box(*np.array(each, float)) for each in boxes])
    normal = np.cross(vertex[:, 1] - vertex[:, 0], vertex[:, 2] - vertex[:, 0])
    side = np.abs(normal).argmax(axis=1)
    high = normal[np.arange(len(side)), side] > 0
    face = (1 + 2 * side + high + 6 * np.repeat(np.arange(len(boxes)), 12)).astype(np.int32)
    count = 6 * len(boxes)
    return Workpiece.of(PartMesh.of(vertex, face, np.ones(count)), range(1, count + 1), targets, setup)


def shared(one, other):
    """Length that two intervals have in common."""
    return max(0.0, min(one[1], other[1]) - max(one[0], other[0]))


@settings(max_examples=40, deadline=None)
@given(st.floats(3.0, 90.0), st.floats(-60.0, 60.0), st.floats(3.0, 90.0), st.sampled_from([1.0, 3.0, 6.0]), st.booleans())
def test_jaws_touch_of_two_walls_what_both_have_side_by_side(long, begins, wide, grip, one_side):
    """A wall from 0 to `long` and one behind it, 40 mm away, that lies aside of it: by intervals along the jaws."""
    other = (begins, begins + wide)
    part = workpiece([(0, 0, 0), (20, long, 30)], [(20, other[0], 0), (40, other[1], 30)], targets=(1,) if one_side else ())
    both = (max(0.0, begins), min(long, other[1]))
    found, refused = vise_places(part, requested("vise", f"46x25x65:{grip}", 1.0, "vise"))
    places = [each for each in found if set(each.grips) == {1, 8}]
    assume(abs(both[1] - both[0]) > 1e-2)
    if both[1] < both[0]:
        assert not places
        assert any("no two opposite plane faces lie side by side" in each.why for each in refused)
        return
    every = [0.5 * sum(both), *([both[0] + 23.0, both[1] - 23.0] if both[1] - both[0] > 46.0 else [])]
    # The part stands no more than six times as high over the jaws as they touch of it.
    lengths = [min(shared((at - 23.0, at + 23.0), each) for each in ((0.0, long), other)) for at in every]
    assume(min(abs(30.0 - grip - 6.0 * each) for each in lengths) > 1e-6)
    middles = [at for at, each in zip(every, lengths, strict=True) if 30.0 - grip <= 6.0 * each]
    assert sorted(each.origin[1] for each in places) == pytest.approx(sorted(middles))
    for place in places:
        jaw = place.origin[1] - 23.0, place.origin[1] + 23.0
        touched = [grip * shared(jaw, (0.0, long)), grip * shared(jaw, other)]
        assert place.touched == pytest.approx(min(touched))
        assert place.hidden == pytest.approx(touched[0] if one_side else sum(touched))
        assert place.size == pytest.approx(30.0 * min(long, wide))
        assert (abs(place.x[0]), place.origin[0], place.origin[2], place.apart) == pytest.approx((1.0, 20.0, 0.0, 40.0))
        # How far off the middle of all of the surface, and how far the part reaches across the jaws.
        assert place.off == pytest.approx(float(np.linalg.norm((place.origin - part.middle)[:2])))
        assert place.farthest == pytest.approx(20.0)


def test_the_middle_of_a_part_is_that_of_its_surface():
    part = workpiece([(0, 0, 0), (20, 60, 30)], [(100, 0, 0), (102, 4, 6)])
    areas = [2 * (20 * 60 + 20 * 30 + 60 * 30), 2 * (2 * 4 + 2 * 6 + 4 * 6)]
    centres = np.array([[10, 30, 0], [101, 2, 0]])
    assert part.middle == pytest.approx(areas @ centres / sum(areas))
    assert part.area == pytest.approx(sum(areas))
    assert workpiece([(0, 0, 0), (20, 60, 30)], targets=(1, 6)).area == pytest.approx(60 * 30 + 20 * 60)


@pytest.mark.parametrize("grip", [2.0, 3.0])
def test_a_part_is_gripped_up_to_six_times_as_high_as_its_jaws_touch_of_it(grip):
    tall = grip + 6.0 * 10.0
    for high, held in ((tall - 0.01, True), (tall + 0.01, False)):
        places, refused = vise_places(workpiece([(0, 0, 0), (10, 10, high)]), requested("vise", f"46x25x65:{grip}", 1.0, "vise"))
        assert bool(places) == held
        assert held or "jaws touch no more than 10 mm of its length" in refused[0].why


@pytest.mark.parametrize("chamfer", [0.5, 1.4, 2.0, 4.0, 8.0])
def test_above_a_chamfer_at_the_bottom_edge_jaws_touch_what_they_touch_without_it(chamfer):
    """A block is gripped above its chamfers, and stands on what is left of its bottom: as firmly as one without."""
    block = cq.Workplane().box(60, 60, 60)
    plain, part = hold_of(block.val().wrapped, "vise"), hold_of(block.edges().chamfer(chamfer).val().wrapped, "vise")
    assert (plain.soft, part.soft) == ("", "")
    assert len(part.grips) == 2
    assert len(part.rests_on) == 1
    # Of what the jaws reach over, a small chamfer takes something; above a large one they touch as much.
    touched = 3.0 - chamfer if chamfer <= 1.5 else 3.0
    assert part.fixture.clamping.grip == pytest.approx(3.0 if chamfer <= 1.5 else 3.0 + chamfer)
    assert part.hidden == pytest.approx(2 * min(46.0, 60.0 - 2.0 * chamfer) * touched)


def test_a_grip_that_is_stated_is_taken_for_a_thin_part_too():
    assert hold_of(box(60.0, 40.0, 3.0), "vise:46x25x65:2.9").fixture.clamping.grip == 2.9


@pytest.mark.parametrize("rim", [1.5, 3.0, 4.0, 9.0])
def test_jaws_at_a_rim_do_not_reach_as_high_as_the_part(rim):
    """A disk on a hub: where nothing of its rim would stand above the jaws, it is not gripped."""
    part = BRepAlgoAPI_Fuse(rod(20.0, 2.0), rod(31.0, rim, (0, 0, 2.0))).Shape()
    if rim < 4.0:
        with pytest.raises(FixtureError, match="nothing to grip"):
            hold_of(part, "chuck")
        return
    hold = hold_of(part, "chuck")
    assert hold.fixture.shift[2] + hold.fixture.clamping.grip <= 2.0 + rim - 1.0 + 1e-3


@pytest.mark.parametrize("high", [0.8, 2.0, 3.0, 3.5, 4.0, 12.0])
@pytest.mark.parametrize("word", ["vise", "chuck"])
def test_a_thin_part_stands_above_the_jaws(word, high):
    part = rod(20.0, high) if word == "chuck" else box(60.0, 40.0, high)
    above = high - hold_of(part, word).fixture.clamping.grip
    assert above == pytest.approx(max(high - 3.0, min(1.0, 0.5 * high)))


def test_a_small_part_is_gripped_as_a_large_one():
    places, _ = vise_places(workpiece([(0, 0, 0), (0.5, 0.5, 0.8)]), requested("vise", "46x25x65:0.2", 1.0, "vise"))
    assert [each.touched for each in places] == pytest.approx([0.1, 0.1])


@settings(max_examples=40, deadline=None)
@given(st.floats(-10.0, 30.0), st.floats(0.5, 20.0), st.integers(0, 2**32 - 1))
def test_what_is_clipped_has_the_area_between_two_heights(low, more, seed):
    """Of a box that stands askew the area between two planes, by its slices: it is linear in small steps, and adds up."""
    rng = np.random.default_rng(seed)
    vertex = solids.box(np.zeros(3), rng.uniform(5.0, 20.0, 3))
    direction = rng.normal(size=3)
    direction /= np.linalg.norm(direction)
    face = np.arange(len(vertex))
    ends = [low, low + 0.3 * more, low + more]
    pieces = [clipped(vertex, face, direction, one, other) for one, other in pairwise(ends)]
    whole = clipped(vertex, face, direction, low, low + more)

    def areas(part):
        cut, which = part
        size = 0.5 * np.linalg.norm(np.cross(cut[:, 1] - cut[:, 0], cut[:, 2] - cut[:, 0]), axis=1)
        return np.bincount(which, weights=size, minlength=len(face))

    assert sum(map(areas, pieces)) == pytest.approx(areas(whole), abs=1e-9)
    for (cut, _), one, other in zip([*pieces, whole], [*ends[:2], low], [*ends[1:], low + more], strict=True):
        height = cut @ direction
        assert height.min(initial=one) >= one - 1e-9
        assert height.max(initial=other) <= other + 1e-9
    everything = clipped(vertex, face, direction, -1e3, 1e3)
    assert areas(everything) == pytest.approx(areas((vertex, face)))


@pytest.mark.parametrize(
    "setup", [(1, 0, 0), (-1, 0, 0), (0, 1, 0), (0, -1, 0), (0, 0, 1), (0, 0, -1), (0.6, 0, 0.8), (0.48, 0.6, 0.64)]
)
def test_a_vise_stands_along_the_setup_axis_with_a_jaw_on_each_face(setup):
    """Whatever the setup: its z is that axis, and the faces that it grips lie at its jaws."""
    turn = cq.Plane((0, 0, 0), normal=tuple(setup))
    part = cq.Workplane(turn).box(50, 30, 20).val().wrapped
    scene = Scene.of(part)
    scene.surround()
    hold = scene.hold(Fixture.parse("vise"), tuple(map(float, setup)))
    rotation = hold.fixture.rotation
    assert rotation.T @ rotation == pytest.approx(np.eye(3), abs=1e-9)
    assert np.linalg.det(rotation) == pytest.approx(1.0)
    assert rotation[:, 2] == pytest.approx(np.array(setup, float), abs=1e-9)
    own = [(np.array(scene.part.centre(n)) - hold.fixture.shift) @ rotation for n in hold.grips]
    assert sorted(each[0] for each in own) == pytest.approx([-15.0, 15.0])
    assert [each[2] for each in own] == pytest.approx([10.0, 10.0])
    assert scene.part.centre(hold.rests_on[0]) == pytest.approx(np.array(hold.fixture.shift), abs=1e-6)


@pytest.mark.slow("grips many parts", but=("100.0-6",))
@pytest.mark.parametrize("jaws", [2, 3, 4, 6])
@pytest.mark.parametrize("gap", [0.0, 40.0, 100.0])
def test_jaws_of_a_chuck_touch_the_cylinder_over_half_of_their_width_each(jaws, gap):
    """A bar of which a sector is gone near its foot: by the angles that are there."""
    radius, reach = 20.0, 3.0
    bar = rod(radius, 40)
    if gap:
        half = math.radians(gap / 2)
        corner = 60.0
        points = [(0, 0), (corner * math.cos(half), -corner * math.sin(half)), (corner * math.cos(half), corner * math.sin(half))]
        wedge = cq.Workplane("XY").polyline(points).close().extrude(10).val().wrapped
        bar = BRepAlgoAPI_Cut(bar, BRepAlgoAPI_Cut(wedge, rod(10, 10)).Shape()).Shape()
    if gap > 360.0 / jaws:
        with pytest.raises(FixtureError, match="no outside cylinder along it reaches all round"):
            hold_of(bar, f"chuck:{jaws}x20:{reach}")
        return
    hold = hold_of(bar, f"chuck:{jaws}x20:{reach}")
    chuck = hold.fixture.clamping
    turn = math.degrees(math.atan2(hold.fixture.rotation[1, 0], hold.fixture.rotation[0, 0]))
    half = math.degrees(chuck.half_angle)
    there = []
    for k in range(jaws):
        at = np.linspace(-half, half, 2001) + turn + 360.0 / jaws * k
        there.append(float((np.abs((at + 180.0) % 360.0 - 180.0) >= gap / 2).mean()))
    assert min(there) > 0.45
    assert hold.hidden == pytest.approx(sum(there) * math.radians(2 * half) * radius * reach, rel=0.04)


@settings(max_examples=3, deadline=None)
@given(st.floats(5.0, 20.0), st.floats(2.5, 6.0), st.floats(0.0, 360.0))
def test_a_shaft_that_lies_is_held_across_its_diameter_in_soft_jaws(radius, slender, turn):
    """Not end to end: up to half of what jaws grip above its middle, and none of it is in them."""
    shaft = cq.Workplane("YZ").circle(radius).extrude(2.0 * radius * slender).rotate((0, 0, 0), (0, 0, 1), turn).val().wrapped
    hold = hold_of(shaft, "vise")
    vise = hold.fixture.clamping
    assert (vise.gap, vise.grip) == pytest.approx((2.0 * radius, radius + 1.5), abs=0.01)
    assert (hold.soft, hold.rests_on, len(hold.grips)) == ("", (), 1)
    assert "in soft jaws bored to it" in hold.words
    long = min(vise.width, 2.0 * radius * slender)
    assert hold.hidden == pytest.approx(long * radius * (math.pi + 2.0 * math.asin(1.5 / radius)), rel=0.02)


@pytest.mark.parametrize(
    ("thick", "turned", "web", "soft"),
    [(1.5, True, 0, True), (1.5, False, 0, False), (9.0, True, 0, False), (7.5, True, 0, True), (7.5, True, 2, False),
     (1.5, True, 1, False)],
)  # fmt: skip
def test_jaws_do_not_press_on_walls_that_they_would_bend(thick, turned, web, soft):
    """A U of 60 x 80 x 40 mm on the ends of its walls: those of 1.5 mm bend, but for a web between them; those of a quarter of
    their height do not, and thinner ones do not where walls across close the U."""
    part = cq.Workplane().box(60, 80, 40).faces(">Z").workplane().rect(60 - 2 * thick, 80).cutBlind(-36)
    part = part.union(cq.Workplane().box(60, 30, 40)) if web == 1 else part
    for side in (-1, 1) if web == 2 else ():
        part = part.union(cq.Workplane().box(60, thick, 40).translate((0, side * (40 - thick / 2), 0)))
    hold = hold_of(part.val().wrapped, "vise", (0.0, 0.0, -1.0 if turned else 1.0))
    assert hold.fixture.clamping.gap == pytest.approx(60.0)
    assert (f"would bend walls {thick:g} mm thick" in hold.soft) == soft


@pytest.mark.parametrize(("thick", "bottom", "soft"), [(1.5, 5.0, True), (1.5, 47.0, False), (6.0, 5.0, False)])
def test_a_chuck_does_not_press_on_a_thin_ring(thick, bottom, soft):
    """A cup of 60 mm on its rim: a wall of 1.5 mm gives, but near its bottom."""
    cup = cq.Workplane().circle(30).extrude(50).faces("<Z").workplane().circle(30 - thick).cutBlind(bottom - 50)
    hold = hold_of(cup.val().wrapped, "chuck")
    assert ("would bend walls" in hold.soft) == soft
    assert len(hold.grips) == 1


@pytest.mark.parametrize(("wide", "soft"), [(18.0, True), (40.0, False)])
def test_no_plate_hangs_on_a_boss(wide, soft):
    """A plate of 90 x 60 mm on a boss that is a fifth as wide."""
    part = cq.Workplane().box(90, 60, 10).faces("<Z").workplane().circle(wide / 2).extrude(12)
    hold = hold_of(part.val().wrapped, "chuck")
    assert (f"from the middle of {wide:g} mm" in hold.soft) == soft


def test_what_a_vise_would_bend_is_not_gripped_beside_its_middle():
    """A box of 3 mm walls with a boss in each corner, which ends below the rim on which it stands."""
    part = cq.Workplane().box(120, 80, 40).faces("<Z").workplane().rect(114, 74).cutBlind(-36)
    bosses = cq.Workplane().rect(98, 58, forConstruction=True).vertices().rect(16, 16).extrude(37.9).translate((0, 0, -17.9))
    for shape in (part, part.union(bosses)):
        assert "would bend walls 3 mm thick" in hold_of(shape.val().wrapped, "vise").soft


@pytest.mark.parametrize(("tall", "grips"), [(15.0, 3.0), (79.0, 8.0), (399.0, 20.0)])
def test_jaws_grip_tall_stock_deeper(tall, grips):
    """A tenth of the stock over the part's foot, and 2 mm below the part stay free."""
    stock = next(iter(Stock.of("usual").choices(tall, round_=False)))
    assert stock.below == grips + 2.0
    body = StockBody.about(stock, np.array([[0.0, 0.0, 0.0], [300.0, 100.0, tall]]))
    assert held_stock(Fixture("vise"), body, UP, 8).fixture.clamping.grip == pytest.approx(grips)


@pytest.mark.parametrize(("low", "grips"), [(3.0, False), (2.995, False), (2.9, True)])
def test_a_face_that_begins_at_the_upper_edge_of_a_jaw_is_not_gripped(low, grips):
    vise = requested("vise", "46x25x65:3:40", 1.0, "vise").clamping
    vertex = solids.box(np.array([-20.0, -10.0, low]), np.array([20.0, 10.0, 30.0]))
    assert bool(faces_in_jaws(vise, vertex, np.ones(len(vertex), np.int32), 0.0)) == grips


def test_a_shaft_that_lies_on_its_collar_needs_a_nest():
    """What is lowest would be gripped alone, with the shaft beside the jaws."""
    shaft = BRepAlgoAPI_Fuse(rod(10, 80), rod(14, 10)).Shape()
    scene = Scene.of(shaft)
    scene.surround()
    assert scene.hold(Fixture("vise"), (1.0, 0.0, 0.0)).soft


@pytest.mark.parametrize(("targets", "grip", "soft"), [((1,), 20.0, False), ((), 3.0, True)])
def test_a_pin_that_nobody_machines_is_gripped_deep(targets, grip, soft):
    """A blade of 50 mm on a pin of 30 mm: a third of the pin stays free below it. Where the pin is machined, little is hidden."""
    part = BRepAlgoAPI_Fuse(rod(10, 30), box(6, 6, 50, at=(-3, -3, 30))).Shape()
    faces = Scene.of(part).part.faces
    pin = {face.number for face in faces if face.shape == "cylinder"}
    hold = hold_of(part, "chuck", targets=[f.number for f in faces if f.number not in pin] if targets else ())
    assert (hold.fixture.clamping.grip, bool(hold.soft)) == (pytest.approx(grip), soft)
    assert {*hold.grips} == pin


def test_a_shoulder_rests_in_a_chuck_and_what_is_below_hangs_in_it():
    """A boss below the bar stands on nothing: the jaws reach no higher for it."""
    part = BRepAlgoAPI_Fuse(rod(25, 40), box(6, 6, 4, at=(-3, -3, -4))).Shape()
    hold = hold_of(part, "chuck")
    assert hold.fixture.placement[2] == pytest.approx(0.0)
    assert hold.fixture.clamping.grip == 3.0
    assert ", from 4 mm above its lowest point;" in hold.words
    # Below the jaws of a chuck is no room for more than they are high.
    with pytest.raises(FixtureError, match="no outside cylinder along it reaches all round"):
        hold_of(BRepAlgoAPI_Fuse(rod(25, 40), box(6, 6, 60, at=(-3, -3, -60))).Shape(), "chuck")


@pytest.mark.parametrize("setup", [(1.0, 0.0, 0.0), (0.6, 0.0, 0.8)])
def test_a_bar_that_lies_or_leans_is_not_gripped_by_a_chuck(setup):
    with pytest.raises(FixtureError, match="nothing to grip"):
        hold_of(rod(20, 60), "chuck", setup)


def test_the_faces_of_one_cylinder_are_gripped_together():
    """A bar in two halves with a slit between them."""
    bar = cq.Workplane("XY").circle(20).extrude(40).faces(">Z").workplane().rect(60, 1).cutBlind(-40).val().wrapped
    hold = hold_of(bar, "chuck")
    assert len(hold.grips) == 2
    assert hold.fixture.placement[:2] == pytest.approx((0.0, 0.0), abs=1e-6)


@settings(max_examples=60, deadline=None)
@given(st.floats(-400.0, 400.0), st.floats(3.0, 170.0), st.permutations(range(3)), st.floats(0.5, 60.0))
def test_triangles_on_a_cylinder_take_the_degrees_from_their_first_to_their_last(first, wide, order, radius):
    """Whichever corner comes first, and where the angle begins anew."""
    turn = np.radians([first, first + 0.4 * wide, first + wide])
    centre = np.array([3.0, -4.0, 0.0])
    vertex = centre + np.column_stack([radius * np.cos(turn), radius * np.sin(turn), [0.0, 1.0, 0.0]])[list(order)]
    taken = _degrees_of(vertex[None], centre)
    within = (np.arange(360) + 0.5 - first) % 360.0
    # A degree whose middle is in it is taken, but for rounding.
    sure = (np.abs(within - wide) > 1e-6) & (within > 1e-6) & (within < 360.0 - 1e-6)
    assert ((taken > 0.5) == (within < wide))[sure].all()
