"""Cutters that are sold: tables that ascend, kinds that stay, stick-outs that are usual, words that can be typed."""

from itertools import pairwise

import pytest
from hypothesis import given
from hypothesis import strategies as st

from plan_cutters import Cutter
from plan_cutters.domain.dimensions import spelled
from plan_cutters.domain.shapes import stages
from plan_cutters.domain.standard_tools import CORNERS, INCH, INCH_CORNERS, METRIC, MOST, USUAL, slenderness, smaller

WORDS = ("D12L60rc6F26S12", "D12L60F26S12Her20", "D10L50rc1.5F22S10Her16", "R8L60rc2", "D1inL4inrc0.5in")
RATIOS = pytest.mark.parametrize("ratio", [USUAL, MOST])


@pytest.mark.parametrize("table", [METRIC, INCH])
def test_a_table_ascends_and_its_tools_can_be_held(table):
    for thin, thick in pairwise(table):
        assert thin.diameter < thick.diameter
        assert (thin.flutes, thin.overall, thin.shank) <= (thick.flutes, thick.overall, thick.shank)
    for tool in table:
        assert tool.diameter <= tool.shank
        assert tool.flutes < tool.overall - 2.0 * tool.shank


def test_the_tables_have_the_diameters_that_are_sold():
    assert [each.diameter for each in METRIC] == [0.5, 1, 1.5, 2, 3, 4, 5, 6, 8, 10, 12, 16, 20, 25]
    assert (INCH[0].diameter, INCH[-1].diameter) == (pytest.approx(25.4 / 32), pytest.approx(25.4))


@RATIOS
@pytest.mark.parametrize(
    "word", ["D12L60rc6F26S12", "D12L60F26S12Her20", "D10L50rc1.5F22S10Her16", "R8L60rc2", "D1inL4inrc0.5in"]
)
def test_the_same_kind_a_usual_size_and_a_usual_stick_out(word, ratio):
    cutter = Cutter.parse(word)
    found = smaller(cutter, ratio)
    assert found
    table = {each.diameter: each for each in (INCH if "in" in word else METRIC)}
    for made, thinner in zip(found, (*found[1:], None), strict=True):
        assert made.radius < cutter.radius
        assert thinner is None or thinner.radius < made.radius
        tool = table[2.0 * made.radius]
        assert made.length <= tool.overall - 2.0 * tool.shank
        assert slenderness(made) <= ratio * (1.0 + 1e-12)
        assert made.flutes == min(tool.flutes, made.length)
        assert made.holder == cutter.holder
        # A ball stays a ball, a flat end a flat end, a bull nose a bull nose of a usual corner, no rounder than it was.
        assert (made.corner_radius == made.radius) == (cutter.corner_radius == cutter.radius)
        assert (made.corner_radius == 0.0) == (cutter.corner_radius == 0.0)
        if 0.0 < made.corner_radius < made.radius:
            assert made.corner_radius in (*CORNERS, *INCH_CORNERS)
            assert made.corner_radius <= min(cutter.corner_radius, 0.5 * made.radius)
        # What can be typed is the tool itself.
        assert Cutter.parse(spelled(made)).id == made.id


@RATIOS
@given(st.sampled_from([each.diameter for each in METRIC[1:]]), st.booleans())
def test_nothing_stands_thicker_below_the_holder_than_the_shank_that_is_sold(ratio, diameter, ball):
    """A real tool lies within the one that is judged: its neck is relieved for no longer than the cone to the shank allows."""
    cutter = Cutter.ball(diameter=diameter, length=60) if ball else Cutter.flat(diameter=diameter, length=60)
    for made in smaller(cutter, ratio):
        tool = next(each for each in METRIC if each.diameter == 2.0 * made.radius)
        for part, low, stage in stages(made):
            thin = part == "neck"
            assert stage.radius == (0.95 * made.radius if thin else 0.5 * tool.shank)
            if thin:
                # From here a cone of a quarter reaches the shank below the holder.
                assert made.length - low - stage.length >= (0.5 * tool.shank - made.radius) / 0.25 - 1e-9


@pytest.mark.parametrize(
    "cutter",
    [
        Cutter.parse("R6L80T3"),
        Cutter.lollipop(radius=4, neck_radius=2, length=60),
        Cutter.barrel(radius=6, flank_radius=85, tip_radius=2, length=80, flutes=22.0),
        Cutter.parse("D0.5L10"),
    ],
    ids=lambda cutter: cutter.id,
)
def test_of_other_kinds_and_below_the_thinnest_none_is_known(cutter):
    assert smaller(cutter, MOST) == ()
