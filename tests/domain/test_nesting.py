"""Cutters inside one another hand postures down and what is not reached up; and where that would be wrong."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from OCP.BRep import BRep_Builder
from OCP.BRepPrimAPI import BRepPrimAPI_MakeBox
from OCP.gp import gp_Pnt
from OCP.TopoDS import TopoDS_Compound

from plan_cutters import Cutter, plan
from plan_cutters.domain.preference import handed, inside, order
from plan_cutters.domain.verdicts import ACCESSIBLE, INACCESSIBLE, INTERFERENCE_FREE
from tests.support.places import SAMPLES
from tests.support.reference import depth_in_cutter, posture, random_frame


@given(st.integers(0, 10**6), st.floats(0.1, 1), st.floats(0.1, 1))
def test_a_smaller_cutter_at_the_same_contact_lies_within_the_larger(seed, thinner, shorter):
    rng = np.random.default_rng(seed)
    normal, direction = random_frame(rng)
    axis, tilt_direction = posture(normal, direction, rng.uniform(0, np.pi / 2), rng.uniform(0, 2 * np.pi))
    contact = rng.uniform(-5, 5, 3)
    points = contact + rng.uniform(-12, 12, (500, 3))
    large = depth_in_cutter(points, contact, normal, axis, tilt_direction, 6.0, 12.0)
    small = depth_in_cutter(points, contact, normal, axis, tilt_direction, 6.0 * thinner, 12.0 * shorter)
    within = small > 0
    assert (small[within] <= large[within] + 1e-9).all()


def test_inside_is_radius_length_and_corner():
    small = Cutter.flat(radius=4, length=50)
    assert inside(small, Cutter.flat(radius=6, length=80))
    assert inside(small, small)
    assert not inside(small, Cutter.flat(radius=6, length=49))
    assert not inside(Cutter.flat(radius=6, length=40), small)
    # The corner of a ball lies outside every flat end, the flat's edge outside every ball.
    ball = Cutter.ball(radius=4, length=50)
    assert not inside(ball, Cutter.flat(radius=6, length=80))
    assert not inside(small, ball)


@pytest.fixture(scope="module")
def alone_and_together():
    cutters = [Cutter.flat(radius=r, length=n) for r, n in ((14, 120), (9, 90), (5, 60))]
    how = {"spacing": 4.0, "area_budget": 0, "tolerance": 0.02}
    part = SAMPLES / "peaks_and_valleys.step"
    return [plan(part, cutters=[c], **how).reaches[c.id] for c in cutters], plan(part, cutters=cutters, **how), cutters


def test_verdicts_are_those_of_each_cutter_alone(alone_and_together):
    alone, together, cutters = alone_and_together
    differ = 0
    for cutter, mine in zip(cutters, alone, strict=True):
        ours = together.reaches[cutter.id]
        assert ((ours.verdict == INTERFERENCE_FREE) == (mine.verdict == INTERFERENCE_FREE)).all()
        assert ours.reached[mine.reached].all(), "handing down took a sample away"
        differ += int((ours.verdict != mine.verdict).sum())
    assert differ <= 0.001 * sum(len(r.verdict) for r in alone)
    assert any((r.verdict == INACCESSIBLE).any() for r in alone)


def test_what_is_handed_was_found_by_the_other_cutter(alone_and_together):
    alone, _, cutters = alone_and_together
    n = len(alone[0].verdict)
    known = handed(cutters[1], {cutters[0]: alone[0], cutters[2]: alone[2]}, n)
    down = known.verdict == ACCESSIBLE
    assert (down == alone[0].reached).all()
    assert (known.axis[down] == alone[0].axis[down]).all()
    assert ((known.verdict == INACCESSIBLE) == (alone[2].verdict == INACCESSIBLE) & ~down).all()
    assert order(cutters) == [cutters[2], cutters[0], cutters[1]]


def test_a_longer_cutter_takes_no_postures():
    """A bridge 30 mm above a plate: a thick cutter 25 mm long passes under it, a thin one of 60 mm does not."""
    part = TopoDS_Compound()
    builder = BRep_Builder()
    builder.MakeCompound(part)
    builder.Add(part, BRepPrimAPI_MakeBox(gp_Pnt(0, 0, 0), 20, 20, 5).Solid())
    builder.Add(part, BRepPrimAPI_MakeBox(gp_Pnt(-60, -60, 35), 140, 140, 5).Solid())
    low, tall = Cutter.flat(radius=5, length=25), Cutter.flat(radius=2, length=60)
    result = plan(part, cutters=[low, tall], faces="6", spacing=5.0, tilt=(0.0, 0.3), area_budget=0)
    (face,) = [f for f in result.plan.faces if f.target]
    assert result.samples.normal[0] @ [0, 0, 1] == pytest.approx(1), f"{face.id} is not the top of the plate"
    short, long = result.reaches[low.id], result.reaches[tall.id]
    assert short.reached.all()
    assert not long.reached.any()
