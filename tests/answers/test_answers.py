"""Answers and tool libraries as a plan has them: fields, arrays, words that are refused, and where each cutter is listed."""

import json

import jsonschema
import numpy as np
import pytest

from plan_cutters import Cutter, Options, plan
from plan_cutters.domain.answers import ANSWERS, answers_of
from plan_cutters.domain.figures import down, up
from plan_cutters.errors import LibraryError, OptionError
from plan_cutters.library import read_library
from plan_cutters.report.to_json import schema
from tests.support.tool_files import fusion, write_json

PART = "samples/peaks_and_valleys.step"
HELD = [
    Cutter.flat(radius=12, length=60, flutes=12, holder="R20L40"),
    Cutter.ball(radius=3, length=60, flutes=12, holder="R20L40"),
]


@pytest.fixture(scope="module")
def answered():
    return plan(PART, cutters=HELD, grid=9, area_budget=0, answers="all", length_over_radius=8)


@pytest.mark.slow("plans again for each answer")
def test_the_plan_has_all_that_was_asked(answered, tmp_path):
    document, n = answered.plan, len(answered.samples)
    assert document.effective.answers == ["stick-out", "radius", "mend"]
    small, large = document.cutters
    assert (large.feasible, small.feasible) == (False, True)
    for entry in document.cutters:
        found = entry.least_stick_out
        assert found.limited_by in ("obstacle", "floor")
        assert found.floor_mm <= found.least_mm <= found.longest_mm == entry.length
        assert found.served == entry.interference_free + entry.accessible
    assert small.mend is None
    assert large.mend.lost == large.inaccessible + large.undecided
    assert [each.shape for each in document.largest_radius] == ["flat", "ball"]
    for each in document.largest_radius:
        assert each.length_over_radius == 8
        assert 0 < each.bottleneck_mm == each.percentiles_mm["0"] <= each.percentiles_mm["95"] <= each.most_mm
    answered.write(tmp_path / "out", ["json", "npz"])
    read = json.loads((tmp_path / "out" / "plan.json").read_text())
    jsonschema.validate(read, schema())
    with np.load(tmp_path / "out" / "samples.npz") as arrays:
        for name in ("radius_flat", "radius_ball"):
            assert arrays[name].shape == (n,)


def test_the_largest_radius_does_not_ask_the_cutters(answered):
    other = plan(PART, cutters="R1L9", grid=9, area_budget=0, answers=["radius"], length_over_radius=8)
    assert other.plan.largest_radius == answered.plan.largest_radius
    assert other.plan.cutters[0].least_stick_out is None
    assert other.answers.mends == {}


def test_nothing_is_answered_unless_asked():
    found = plan("samples/v_groove.step", cutters="R2L30", grid=5, area_budget=0)
    assert (found.answers.stick_outs, found.answers.radius_maps, found.answers.mends) == ({}, (), {})
    assert found.plan.largest_radius == []


@pytest.mark.parametrize("given", ["radii", ["mend", "mend?"], 3, [None], ["radius", 2]])
def test_other_words_are_refused(given):
    with pytest.raises(OptionError, match="answers"):
        Options(answers=given)


@pytest.mark.parametrize("ratio", [0, 0.5, 2000, float("nan"), "ten"])
def test_lengths_that_no_cutter_has(ratio):
    with pytest.raises(OptionError, match="length over radius"):
        Options(length_over_radius=ratio)


def test_words_of_answers():
    assert answers_of(None) == answers_of("") == ()
    assert answers_of(" Mend , stick-out ") == ("stick-out", "mend")
    assert answers_of(("all",)) == ("stick-out", "radius", "mend")
    assert answers_of("all") == ANSWERS


def test_what_is_said_is_never_rounded_the_wrong_way():
    assert [down(r) for r in (1.94996, 4.9458, 119.91, 0.0123456, 2.0)] == ["1.94 mm", "4.94 mm", "119 mm", "0.0123 mm", "2 mm"]
    assert [up(h) for h in (7.8926, 7.89, 12.0, 0.001)] == ["7.90 mm", "7.89 mm", "12.00 mm", "0.01 mm"]


def test_where_a_cutter_is_listed(tmp_path):
    """The same geometry is judged once, with all its numbers; what is asked for the whole plan does not lose them."""
    path = write_json(tmp_path / "shop.json", [fusion(number=4), fusion(number=9), fusion("probe", number=5)])
    library = read_library(path)
    for options in ({}, {"allowance": 0.2, "holder_clearance": 1.0}):
        document = plan("samples/v_groove.step", cutters=library, grid=3, area_budget=0, **options).plan
        (entry,) = document.cutters
        assert [source.number for source in entry.sources] == [4, 9]
        assert {source.file for source in entry.sources} == {"shop.json"}
        (listed,) = document.libraries
        assert (listed.tools, listed.cutters) == (3, 1)
        assert [tool.number for tool in listed.unused] == [5]
        assert "probe" in listed.unused[0].why
        assert document.effective.cutter_source == "shop.json"
        assert document.selected == entry.id


def test_libraries_and_cutters_together(tmp_path):
    library = read_library(write_json(tmp_path / "shop.json", [fusion()]))
    options = Options(cutters="R2L30", libraries=library, holder="R15L30")
    assert len(options.judged) == 2
    # The holder is for those that were given without one: a library's were read with theirs, or with one that was assumed.
    assert [cutter.holder.id for cutter in options.judged] == ["R15L30", library[0].holder.id]
    with pytest.raises(LibraryError, match="no tool library"):
        Options(libraries=["shop.json"])
