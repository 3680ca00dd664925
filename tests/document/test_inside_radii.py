"""Inside radii that are too small for a cutter are stated next to the cutter's."""

import pytest

from cad_io import Part
from plan_cutters import plan
from tests.support.cad_parts import ball, box, cut, rod

HOW = {"area_budget": 0, "jobs": 2, "spacing": 1.0}


def in_a_round_pocket(cutter, radius=5.0):
    """Of a box whose top has a spherical pocket: F7."""
    part = Part(cut(box(30, 30, 20), ball(radius, (15, 15, 20))))
    (face,) = [info.number for info in part.faces if info.shape == "sphere"]
    return plan(part, cutters=[cutter], faces=f"F{face}", **HOW), f"F{face}"


def test_a_ball_larger_than_its_pocket():
    result, face = in_a_round_pocket("D12L40rc6")
    (entry,) = result.plan.inside_radii
    assert entry.face == face
    assert entry.radius_mm == pytest.approx(5.0)
    assert (entry.cutter_radius_mm, entry.fits_mm) == (6.0, 10.0)
    assert entry.area_mm2 == pytest.approx(2 * 3.14159 * 25, rel=0.1)
    line = f"The smallest inside radius of {face} is 5 mm, and ball end D12 x 40 has R6: the largest usual size that fits is D10."
    assert line in result.summary()


def test_what_fits_is_not_named():
    result, _ = in_a_round_pocket("D8L40rc4")
    assert result.plan.inside_radii == []
    assert "inside radius" not in result.summary()


def test_an_outside_face_has_none():
    """A boss on a plate: what is gouged is the plate's corner with it, and nothing bends inwards."""
    part = Part(cut(box(40, 40, 20), cut(box(40, 40, 12, (0, 0, 8)), rod(8, 12, (20, 20, 8)))))
    result = plan(part, cutters=["D12L40rc6"], faces="all", **HOW)
    assert result.plan.inside_radii == []


def test_nothing_usual_is_that_small():
    result, _ = in_a_round_pocket("D2L20rc1", radius=0.24)
    assert [each.fits_mm for each in result.plan.inside_radii] == [None]
    assert "no usual size is that small" in result.summary()
