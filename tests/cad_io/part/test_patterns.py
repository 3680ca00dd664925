"""Patterns are found where faces are equal, wherever the part lies, and nowhere else."""

import cadquery as cq
import numpy as np
import pytest

from cad_io import read_part
from cad_io.part.equal_faces import Motion
from cad_io.part.patterns import Pattern, patterns
from tests.support.patterns import impeller, plate


def found(part: cq.Workplane) -> tuple[Pattern, ...]:
    return patterns(read_part(part))


def whole(part: cq.Workplane) -> list[tuple[str, int]]:
    return sorted((each.kind, each.order) for each in found(part) if each.whole)


def test_blades_are_one_pattern_of_the_whole_part():
    (pattern,) = found(impeller(6))
    assert (pattern.kind, pattern.order, pattern.whole) == ("rotation", 6, True)
    place, direction = pattern.motions[0].axis
    assert abs(direction[2]) == pytest.approx(1.0, abs=1e-9)
    assert np.hypot(*place[:2]) < 1e-6
    # Each ring has one face of each blade, and each motion is a map of all faces onto all.
    assert {len(ring) for ring in pattern.faces} == {6}
    for image in pattern.images:
        assert sorted(image) == sorted(image.values())


def test_fillets_at_the_foot_belong_to_it():
    assert whole(impeller(6, fillet=1.5)) == [("rotation", 6)]


@pytest.mark.parametrize("off", [0.02, 0.001])
def test_a_blade_that_is_off_breaks_the_pattern(off):
    assert not [each for each in whole(impeller(6, off=off)) if each[0] == "rotation"]


def test_a_part_of_other_order_has_that_order():
    assert whole(impeller(5)) == [("rotation", 5)]


@pytest.mark.slow("works on many faces")
def test_pockets_are_shifted_copies_and_the_plate_its_own_mirror_image():
    every = found(plate(4, 3))
    assert sorted((each.kind, each.order) for each in every if each.whole) == [("mirror", 2), ("mirror", 2), ("rotation", 2)]
    pockets = next(each for each in every if each.kind == "shift")
    # A floor, four walls and four fillets.
    assert (pockets.order, len(pockets.faces)) == (12, 9)
    assert not pockets.whole


def test_a_deeper_pocket_is_not_one_of_them():
    every = found(plate(4, 3, deeper=0.01))
    assert not [each for each in every if each.whole and each.kind == "rotation"]
    walls = max((each for each in every if each.kind == "shift"), key=lambda each: len(each.faces))
    assert (walls.order, len(walls.faces)) == (11, 8)


@pytest.mark.slow("another motion of the same law", but=("0",))
@pytest.mark.parametrize("seed", range(3))
def test_a_rigid_motion_and_a_scale_change_nothing(seed):
    rng = np.random.default_rng(seed)
    axis, angle, scale = rng.normal(size=3), float(rng.uniform(10, 170)), float(rng.uniform(0.2, 5.0))
    part = impeller(5, fillet=1.0)
    moved = part.val().rotate(cq.Vector(0, 0, 0), cq.Vector(*axis), angle).translate(cq.Vector(*rng.uniform(-50, 50, 3)))
    assert whole(cq.Workplane(obj=moved)) == whole(part)
    assert whole(cq.Workplane(obj=part.val().scale(scale))) == whole(part)


def test_a_mirrored_part_has_the_same_patterns():
    part = impeller(5)
    assert whole(part.mirror("YZ")) == whole(part)


def test_a_boss_is_no_hole():
    block = cq.Workplane("XY").box(60, 20, 20)
    holes = block.faces(">Z").workplane().pushPoints([(-20, 0), (0, 0), (20, 0)]).hole(6, 5)
    assert [each.order for each in found(holes) if each.kind == "shift"] == [3]
    two = block.faces(">Z").workplane().pushPoints([(-20, 0), (0, 0)]).hole(6, 5)
    mixed = two.union(cq.Workplane("XY").workplane(offset=10).center(20, 0).circle(3).extrude(5))
    # Two floors and a top are three equal disks; the cylinders are equal but for their sides.
    assert [(each.order, len(each.faces)) for each in found(mixed) if each.kind == "shift"] == [(3, 1)]


def test_a_part_of_revolution_and_a_plain_box_end():
    assert not [each for each in found(cq.Workplane("XY").circle(10).extrude(30)) if each.kind == "rotation" and each.order > 2]
    assert ("rotation", 4) in whole(cq.Workplane("XY").box(10, 10, 30))


def test_motions_are_what_they_say():
    rng = np.random.default_rng(1)
    place, direction, points = rng.normal(size=3), np.array([0.6, 0.0, 0.8]), rng.normal(size=(7, 3))
    turn, mirror = Motion.turn(place, direction, 0.7), Motion.mirror(place, direction)
    for motion in (turn, mirror, Motion.translation(place)):
        moved = motion.points(points)
        assert np.allclose(motion.back(moved), points)
        assert np.allclose(np.linalg.norm(moved[1:] - moved[:-1], axis=1), np.linalg.norm(points[1:] - points[:-1], axis=1))
    at, along = turn.axis
    assert np.allclose(along, direction)
    assert np.allclose(np.cross(at - place, direction), 0.0)
    assert np.allclose(mirror.points(mirror.points(points)), points)
    assert mirror.axis is None
    half = Motion.turn(place, direction, np.pi)
    assert abs(half.axis[1] @ direction) == pytest.approx(1.0)
