"""Faces that come back from STEP as other ones are named with both areas; all others come back as they are."""

import math

import pytest

from cad_io import read_part
from cad_io.write.step import changed_by_step
from tests.support.cad_parts import ball, box, compound, cone, drilled, ring
from tests.support.turned import elbow, revolved_arc


def test_an_elbow_comes_back_three_times_as_large():
    part = read_part(elbow())
    (number,) = [face.number for face in part.faces if face.surface == "revolution"]
    assert part.faces[number - 1].area == pytest.approx(25 * math.pi, rel=1e-6)
    assert changed_by_step(part) == {number: pytest.approx(75 * math.pi, rel=1e-6)}


@pytest.mark.parametrize("bulge", [2.0, 8.0])
def test_a_lemon_and_an_apple_come_back_as_both(bulge):
    part = read_part(compound(box(10, 10, 10, (20, 0, 0)), revolved_arc(bulge)))
    changed = changed_by_step(part)
    assert list(changed) == [7]
    # The lemon is within the apple: together they are the circle, turned all round.
    assert changed[7] == pytest.approx(740.7, rel=1e-3)
    assert changed_by_step(part) is changed


@pytest.mark.parametrize("shape", [ball, cone, ring, drilled])
def test_quadrics_and_tori_come_back_as_they_are(shape):
    assert changed_by_step(read_part(shape())) == {}
