"""Tool assemblies in words: what is accepted, what is refused, and what the plan and the command say of them."""

import json
import math

import pytest

from plan_cutters import Cutter, CutterError, Holder, OptionError, Options, Segment, plan
from plan_cutters.domain.preference import wanted
from plan_cutters.domain.shapes import flute_length, modes
from plan_cutters.domain.standard_tools import builtin
from tests.support.forked import run
from tests.support.places import SAMPLES


@pytest.mark.parametrize("spec", ["R6L80", "R6L80rc1", "R6L80rc6F20S6", "R2L40rc2T5", "R1L20F6N0.95x9S3", "R6L80T-3"])
def test_a_spec_is_the_id_of_its_cutter(spec):
    assert Cutter.parse(spec).id == spec
    assert Cutter.parse(spec.lower()) == Cutter.parse(spec)


def test_four_numbers_make_a_tool_and_its_holder():
    (cutter,) = Options(cutters="R1.5L20", holder="R15L30").judged
    assert (cutter.radius, cutter.length) == (1.5, 20)
    assert [(part, low, stage.radius, stage.length) for part, low, stage in cutter.stages] == [("holder", 20, 15, 30)]


def test_a_holder_has_stages_from_its_nose_up():
    holder = Holder.parse("R12:15L20+R15L30")
    assert holder == Holder((Segment(12, 20, 15), Segment(15, 30)))
    assert holder.id == "R12:15L20+R15L30"
    cutter = Cutter.ball(radius=5, length=40, flutes=15.0, shank_radius=5.0, holder=holder)
    assert [(part, low) for part, low, _ in cutter.stages] == [("shank", 15), ("holder", 40), ("holder", 60)]


def test_a_cutter_that_has_its_own_keeps_it():
    own = Cutter.flat(radius=6, length=80, holder="R20L40", clearance=2.0)
    kept, given = Options(cutters=[own, "R6L80"], holder="R15L30", holder_clearance=1.0, allowance=0.2).judged
    assert (kept.holder.id, kept.clearance, kept.allowance) == ("R20L40", 2.0, 0.2)
    assert (given.holder.id, given.clearance, given.allowance) == ("R15L30", 1.0, 0.2)


@pytest.mark.parametrize(
    ("make", "cause"),
    [
        (lambda: Cutter.parse("R6L20F30"), "shorter than its flutes"),
        (lambda: Cutter.parse("R6L20S6"), "no length for a shank"),
        (lambda: Cutter.parse("R6L80F20N5x70"), "more than the length"),
        (lambda: Cutter.parse("R6L20rc6F5"), "end within its corner"),
        (lambda: Cutter.parse("R6L80T85"), "beyond 80 deg"),
        (lambda: Cutter.parse("R2L80T-5"), "meet below"),
        (lambda: Cutter.flat(radius=6, length=80, holder="R5L30"), "narrower"),
        (lambda: Cutter.flat(radius=6, length=80, holder="R15"), "R15L30"),
        (lambda: Cutter.flat(radius=6, length=80, holder="R15L0"), "positive"),
        (lambda: Cutter.flat(radius=6, length=80, holder="R15L-3"), "positive"),
        (lambda: Holder(()), "at least one stage"),
        (lambda: Holder.parse(6), "no holder"),
        (lambda: Segment(math.nan, 5), "number"),
        (lambda: Cutter.lollipop(radius=3, neck_radius=3, length=40), "thinner"),
        (lambda: Cutter.barrel(radius=6, flank_radius=85, length=60), "height"),
        (lambda: Cutter.barrel(radius=6, flank_radius=4, length=60, height=9), "at least its own"),
        (lambda: Cutter.barrel(radius=6, flank_radius=85, length=60, tip_radius=7), "tip"),
        (lambda: Cutter.lens(radius=6, bottom_radius=5, corner_radius=1, length=60), "bottom"),
        (lambda: Cutter.form([(0, 0), (3, 5), (2, 4)], length=40), "overlap"),
        (lambda: Cutter.form([(1, 0), (3, 5)], length=40), "axis at the tip"),
        (lambda: Cutter.form([(0, 0), (3, math.inf)], length=40), "finite"),
        (lambda: Cutter.form([(0, 0), (-3, 5)], length=40), "positive"),
        (lambda: Cutter.form([(0, 0), 3], length=40), "radius and a height"),
        (lambda: Cutter.flat(radius=6, length=80, allowance=-1.0), "positive"),
    ],
)
def test_a_tool_that_cannot_be_is_one_clear_line(make, cause):
    with pytest.raises(CutterError, match=cause) as error:
        make()
    assert "\n" not in str(error.value)


@pytest.mark.parametrize(
    ("options", "cause"), [({"allowance": math.nan}, "number"), ({"holder_clearance": -1}, "0 or a positive")]
)
def test_an_option_that_cannot_be_is_one_clear_line(options, cause):
    with pytest.raises(OptionError, match=cause) as error:
        Options(**options)
    assert "\n" not in str(error.value)


def test_the_built_in_drawer_has_every_kind_and_ranks_from_the_largest_of_each():
    drawer = builtin()
    for free_form, first in ((1.0, True), (0.0, False)):
        ranked = wanted(drawer, free_form=free_form)
        for round_ in (True, False):
            mine = [c.radius for c in ranked if (c.corner_radius > 0.0 if free_form else c.corner_radius == c.radius) is round_]
            assert mine == sorted(mine, reverse=True)
        assert (ranked[0].corner_radius > 0.0) is first
    assert {(c.corner_radius == 0, c.corner_radius == c.radius) for c in drawer} == {(True, False), (False, True), (False, False)}
    assert all(c.holder and "built-in" in c.name for c in drawer)
    assert len({c.id for c in drawer}) == len(drawer)


def test_the_drawer_is_listed():
    done = run("--list-cutters")
    assert done.returncode == 0
    assert [line.split()[0] for line in done.stdout.splitlines()[1:]] == [c.id for c in builtin()]


def test_modes_are_where_a_tool_touches():
    ball = Cutter.lollipop(radius=6, neck_radius=3, length=60)
    assert flute_length(ball) == pytest.approx(6 + math.sqrt(27))
    assert modes(ball)[0].high == pytest.approx(math.radians(150))
    tip, flank = modes(Cutter.barrel(radius=6, flank_radius=85, tip_radius=2, length=70, flutes=22.0))
    assert tip.high == flank.low == pytest.approx(math.asin(79 / 83))
    assert modes(Cutter.parse("R2L40rc2T5"))[0].high == pytest.approx(math.radians(85))


def test_a_plan_says_what_was_judged(tmp_path):
    cutter = Cutter.bull(radius=6, corner_radius=1, length=60, flutes=20.0, shank_radius=6.0, holder="R10:12L20+R15L40")
    result = plan(SAMPLES / "v_groove.step", cutters=[cutter], grid=9, area_budget=0, holder_clearance=0.5)
    result.to_json(tmp_path / "plan.json")
    (entry,) = json.loads((tmp_path / "plan.json").read_text())["cutters"]
    assert [stage["part"] for stage in entry["stages"]] == ["shank", "holder", "holder"]
    assert (entry["flutes_mm"], entry["clearance_mm"], entry["allowance_mm"]) == (20, 0.5, 0)
    assert entry["touches_deg"] == [[0, 90]]
    assert set(entry["by_reason"]) >= {"neck", "shank", "holder"}
    assert not any("without a holder" in note for note in result.plan.notes)
    bare = plan(SAMPLES / "v_groove.step", cutters=["R6L80"], grid=5, area_budget=0)
    assert any("without a holder" in note for note in bare.plan.notes)
