"""Contacts that lie in a body next to its skin: one look at what is over them proves that no posture is left."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from OCP.BRepBuilderAPI import BRepBuilderAPI_Transform

from plan_cutters import Cutter
from plan_cutters.domain.shapes import depth_along_normal
from plan_cutters.domain.verdicts import INACCESSIBLE, INSIDE, UNDECIDED
from plan_cutters.judging.judge import judge
from plan_cutters.options import Options
from plan_cutters.pipeline import prepare
from plan_cutters.scene.conditions import Context
from plan_cutters.scene.work import Work
from tests.support.cad_parts import box, compound, moved, rod
from tests.support.tool_reference import Reference

TILTS = np.linspace(0.0, np.pi / 2, 181)


@pytest.mark.slow("judges many samples")
@given(
    st.floats(0.5, 12.0), st.sampled_from([0.0, 0.1, 0.5, 1.0]), st.floats(2.0, 9.0), st.floats(0.03, 1.0), st.floats(0.01, 0.25)
)
def test_every_tilt_holds_a_part_of_a_ball_on_the_normal(radius, corner, slender, share, deep):
    cutter = Cutter.bull(radius=radius, corner_radius=corner * radius, length=slender * radius) if corner else Cutter.flat(
        radius=radius, length=slender * radius)  # fmt: skip
    distance = share * depth_along_normal(cutter)
    assert distance > 0.0
    deep *= distance
    outline, turn = Reference(cutter).flutes, np.linspace(0.0, 2 * np.pi, 9)
    for tilt in TILTS:
        q, w = outline.support(tilt)
        # The plane of axis and normal: outwards from the axis, and up along it.
        outward, up = q - distance * np.sin(tilt), w + distance * np.cos(tilt)
        ball = 1.5 * deep * np.stack([np.cos(turn), np.sin(turn)])
        # Beyond the axis a point is on its other side.
        assert outline.depth(np.abs(outward + ball[0]), up + ball[1]).max() >= deep - 1e-9


@pytest.mark.parametrize(("cutter", "known"), [("R3L40", 3), ("R3L40rc1", 1), ("R2L30rc2", 2), ("R3L5", 0), ("R3L40T4", 0)])
def test_only_what_is_known_to_hold_the_normal_counts(cutter, known):
    assert depth_along_normal(Cutter.parse(cutter)) == known


def test_an_allowance_is_not_counted_on():
    assert depth_along_normal(replace(Cutter.parse("R3L40"), allowance=0.5)) == 0.0


@pytest.fixture(scope="module")
def crossed():
    """A block with a leaning pin in it: just below the top, the lower side of the pin looks into the block."""
    return compound(box(60, 60, 50), BRepBuilderAPI_Transform(rod(6, 40), moved(0.4, (1, 0.3, 0), (31, 29, 30)), True).Shape())


@pytest.mark.slow("searches long", only=("R2L9F7S1",))
@pytest.mark.parametrize(("cutter", "met"), [("R3L12", True), ("R2L9F7S1", True), ("R3L12rc1", False), ("R2L9rc2", False)])
def test_verdicts_are_those_of_a_search_of_all_postures(crossed, cutter, met, monkeypatch):
    ready = prepare(crossed, Options.of({"cutters": cutter, "faces": "F7", "grid": 120}))
    quick, slow = Work(), Work()
    proved = judge(ready, ready.cutters[0], work=quick)
    monkeypatch.setattr(Context, "_proved_at", lambda self: np.zeros(0))
    searched = judge(ready, ready.cutters[0], work=slow)
    # What a search leaves undecided, material may decide: nothing else changes.
    more = proved.verdict != searched.verdict
    assert (searched.verdict[more] == UNDECIDED).all()
    assert (proved.verdict[more] == INACCESSIBLE).all()
    told = proved.reason != searched.reason
    assert (proved.reason[told] == INSIDE).all()
    # A round corner on a side that leans so little comes through the top: it never lies within the block.
    assert told.any() == (quick.looked < slow.looked) == met
