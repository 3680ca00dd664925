"""A chamfer mill is advised where end mills go along chamfers up and down, and what is said of it comes true."""

import cadquery as cq
import numpy as np
import pytest

from plan_cutters import Cutter, plan
from plan_cutters.answers.chamfers import _MILLS, _fitting
from plan_cutters.domain.holder import Holder

HOW = {"faces": "all", "machine": "3-axis", "operations": "fastest", "feed": 600, "spacing": 1.5}
MILL = "D1L30T45F6S12"


def block(chamfer=2.0):
    whole = cq.Workplane().box(60, 40, 20)
    return whole.faces(">Z").edges().chamfer(chamfer) if chamfer else whole


@pytest.fixture(scope="module")
def without():
    return plan(block(), cutters="D16L60F32S16", **HOW).plan.process


def test_the_mill_that_saves_most_is_named_with_its_faces(without):
    said = without.chamfers
    assert (said.angle_deg, len(said.faces), said.argv) == (90.0, 4, ["--cutter", MILL])
    assert 60.0 < said.saves < said.seconds < without.seconds
    assert any("a chamfer mill of 90°" in each.words for each in without.next)


def test_what_it_saves_comes_true(without):
    """A chamfer is one pass then; the mill does nothing else, on five axes neither."""
    process = plan(block(), cutters=["D16L60F32S16", MILL], **HOW).plan.process
    assert process.seconds == pytest.approx(without.seconds - without.chamfers.saves, abs=15.0)
    assert process.chamfers is None
    for machine in ("3-axis", "trunnion-ac"):
        steps = plan(block(), cutters=["D16L60F32S16", MILL], **{**HOW, "machine": machine}).plan.process.steps
        mine = [face for step in steps if Cutter.parse(step.cutter).taper for face in step.faces]
        assert set(mine) <= set(without.chamfers.faces)


@pytest.mark.parametrize("chamfer", [0.0, 12.0])
def test_nothing_is_said_of_no_chamfers_and_of_wide_slopes(chamfer):
    assert plan(block(chamfer), cutters="D16L60F32S16", **HOW).plan.process.chamfers is None


def test_nothing_is_said_where_it_saves_little():
    small = cq.Workplane().box(10, 8, 10).faces(">Z").edges().chamfer(0.5)
    assert plan(small, cutters="D16L60F32S16", **HOW).plan.process.chamfers is None


def test_a_mill_is_taken_that_fits_the_holder():
    assert [_fitting(words, None).radius for words in _MILLS.values()] == [0.5] * 3
    small = Holder.parse("er11")
    for words in _MILLS.values():
        mill = _fitting(words, small)
        assert mill is None or (mill.holder == small and np.isfinite(mill.length))
