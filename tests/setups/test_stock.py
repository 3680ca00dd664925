"""Stock: its words, what of it is below the part, and that jaws on it hide nothing of the part."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from plan_cutters import Options, Scene, plan
from plan_cutters.domain.fixture import Fixture
from plan_cutters.domain.placement import frame_of
from plan_cutters.domain.stock import Stock, StockBody
from plan_cutters.domain.verdicts import FIXTURE
from plan_cutters.errors import OptionError, PlanError
from plan_cutters.plan_file.part_info import ProposedSetup
from plan_cutters.report.process_file import setup_toml
from plan_cutters.setups.files import read_setup
from tests.support.cad_parts import box, compound, rod, write_step
from tests.support.vises import block

HOW = {"cutters": "R3L60HR15L30", "faces": "all", "grid": 5, "area_budget": 0, "machine": "trunnion-ac"}


@pytest.mark.parametrize(
    ("text", "margins"), [("box", (1.0, 1.0, 5.0)), ("BOX:2,3,8", (2.0, 3.0, 8.0)), ("cylinder:0,9", (0.0, 9.0)), ("part", ())]
)
def test_a_word_says_the_same_again(text, margins):
    stock = Stock.of(text)
    assert stock.margins == margins
    assert Stock.of(stock.text) == stock
    assert stock.solid == (text != "part")


@pytest.mark.parametrize(
    "text", ["", "cube", "box:1,1", "box:1,1,0", "box:1,nan,5", "box:1,-1,5", "cylinder:1", "box:1,1,inf", 7]
)
def test_what_is_no_stock_is_refused_in_one_line(text):
    with pytest.raises(OptionError, match="stock") as error:
        Options(stock=text)
    assert "\n" not in str(error.value)


@settings(max_examples=40, deadline=None)
@given(st.tuples(*[st.floats(-1.0, 1.0)] * 3).filter(lambda v: np.linalg.norm(v) > 0.2), st.floats(0.0, 5.0), st.floats(0.5, 9.0))
def test_stock_encloses_the_part_and_ends_below_it(up, beside, below):
    """In any setup: each corner of the part is in it, and its foot is so far below the lowest one."""
    frame = frame_of(np.array(up) / np.linalg.norm(up))
    corners = block((0, 0, 0), (30, 20, 10)).reshape(-1, 3) @ frame.T
    for word in (f"box:{beside},{beside},{below}", f"cylinder:{beside},{below}"):
        body = StockBody.about(Stock.of(word), corners)
        assert (corners >= body.low - 1e-9).all()
        assert (corners <= body.high + 1e-9).all()
        assert body.part_low - body.low[2] >= (beside if body.lying else below) - 1e-9
        assert (corners[:, :2] >= body.foot[0][:2] - 1e-9)[corners[:, 2] < body.part_low + 1e-9].all()
        if body.lying:
            away = np.linalg.norm((corners - 0.5 * (body.low + body.high))[:, [1 - body.along, 2]], axis=1)
            assert (away <= body.radius + 1e-9).all()
        elif body.radius is not None:
            away = np.linalg.norm(corners[:, :2] - 0.5 * (body.low + body.high)[:2], axis=1)
            assert (away <= body.radius + 1e-9).all()
        assert body.volume >= 30 * 20 * 10 - 1e-6


@pytest.mark.parametrize("along", [0, 1, 2])
def test_a_bar_lies_along_a_part_that_is_long(along):
    """160 mm on 30 mm: across the setup axis the bar is no puck of D165."""
    size = np.full(3, 30.0)
    size[along] = 160.0
    body = StockBody.about(Stock.of("cylinder"), block((0, 0, 0), tuple(size)).reshape(-1, 3))
    assert (body.along, body.lying) == (along, along < 2)
    assert body.radius == pytest.approx(15.0 * math.sqrt(2.0) + 1.0)
    assert body.volume == pytest.approx(math.pi * body.radius**2 * (162.0 if along < 2 else 186.0))
    if along < 2:
        low, high = body.foot
        # A chord of the circle, where the part ends.
        assert (high - low)[1 - along] == pytest.approx(2.0 * math.sqrt(body.radius**2 - 15.0**2))
        assert (high - low)[2] == pytest.approx(body.radius - 15.0)


def test_a_bar_that_lies_is_gripped_across_in_soft_jaws():
    process = plan(rod(15, 160), setup="+x", fixtures="vise", stock="cylinder", **HOW).plan.process
    (setup,) = process.setups
    assert (setup.grips, setup.soft, setup.apart_mm) == ([], "", pytest.approx(32.0, abs=0.01))
    assert setup.text == (
        "Setup 1: +X up, a bar 32 mm wide and 162 mm long, lying, across a vise, 32 mm wide, in soft jaws bored to it, "
        "17.5 mm high."
    )


def test_a_vise_on_stock_stands_below_the_part():
    scene = Scene.of(box(40, 30, 20))
    scene.surround()
    around = scene.surround_held((0.0, 0.0, 1.0), "vise", Stock.of("box:2,3,6"))
    blank, vise = around.fixtures
    assert np.allclose(blank.obstacles.triangles.vertex.min(axis=(0, 1)), (-2, -3, -6))
    assert np.allclose(blank.obstacles.triangles.vertex.max(axis=(0, 1)), (42, 33, 0))
    assert vise.obstacles.triangles.vertex[..., 2].max() == pytest.approx(-3.0)
    assert vise.fixture.clamping.gap == pytest.approx(36.0)
    assert (vise.hold.grips, vise.hold.hidden) == ((), 0.0)


def test_with_stock_only_what_looks_down_is_left():
    """In a vise on the part its walls are hidden to the height of the jaws; on stock below it none of them is."""
    result = plan(box(40, 30, 20), setup="+z", fixtures="vise", stock="box", **HOW)
    down = result.samples.normal[:, 2] < -0.5
    (verdicts,) = result.reaches.values()
    assert (verdicts.reached == ~down).all()
    assert (verdicts.reason[down] == FIXTURE).all()
    on_part = plan(box(40, 30, 20), setup="+z", fixtures="vise", **HOW)
    assert (next(iter(on_part.reaches.values())).not_reached & ~down).any()


def test_all_bodies_are_in_stock_that_is_gripped():
    """Two blocks that do not touch: jaws on one of them leave the other, jaws on their stock hold both."""
    part = compound(box(20, 30, 20), box(10, 10, 20, at=(30, 10, 0)))
    for stock, some in (("box", False), ("part", True)):
        (vise,) = [each for each in plan(part, setup="+z", fixtures="vise", stock=stock, **HOW).plan.fixtures if each.clamping]
        assert bool(vise.unheld) == some


def test_how_it_stands_comes_first():
    setup, stock = (lambda p: (p.setups[0], p.stock))(plan(box(40, 30, 20), fixtures="vise", stock="box", **HOW).plan.process)
    assert (setup.number, setup.up, setup.stands_on, setup.held, setup.grips) == (1, (0.0, 0.0, 1.0), "stock", "vise", [])
    assert setup.text.startswith("Setup 1: +Z up, stock of 42 x 32 x 26 mm in a vise, 32 mm apart")
    assert stock.remove_mm3 == pytest.approx(42 * 32 * 26 - 40 * 30 * 20, rel=1e-6)
    assert stock.seconds is None


def test_minutes_of_roughing_are_the_volume_over_the_rate():
    stock = plan(box(40, 30, 20), fixtures="vise", stock="box", removal_rate=12.0, **HOW).plan.process.stock
    assert stock.seconds == pytest.approx(60.0 * stock.remove_mm3 / 12_000.0)


def test_a_bar_is_gripped_by_a_chuck():
    process = plan(rod(10, 40), fixtures="chuck", stock="cylinder:1,8", **HOW).plan.process
    setup = process.setups[0]
    assert (setup.held, setup.stands_on, setup.apart_mm) == ("chuck", "stock", pytest.approx(22.0, abs=0.05))
    assert "a bar 22 mm wide and " in setup.text


def test_stock_of_a_file_is_its_box_and_must_enclose_the_part(tmp_path):
    large, small = tmp_path / "large.step", tmp_path / "small.step"
    write_step(box(50, 40, 32, at=(-5, -5, -12)), large)
    write_step(box(50, 40, 20, at=(-5, -5, 0)), small)
    process = plan(box(40, 30, 20), fixtures="vise", stock=str(large), **HOW).plan.process
    assert process.stock.size_mm == pytest.approx((50.0, 40.0, 32.0))
    assert process.setups[0].apart_mm == pytest.approx(40.0)
    with pytest.raises(PlanError, match="reach below it"):
        plan(box(40, 30, 20), fixtures="vise", stock=str(small), **HOW)


def test_jaws_that_grip_deeper_than_the_stock_reaches_are_refused():
    with pytest.raises(PlanError, match="the stock reaches 2 mm below the part"):
        plan(box(40, 30, 20), fixtures="vise", stock="box:1,1,2", **HOW)


def test_a_setup_file_has_the_stock_and_the_vise_on_it(tmp_path):
    fixtures = ["stock:box:1,1,5", "vise:46x25x65:3:32@20,15,-5,0,0,-90"]
    setup = ProposedSetup(axis=(0.0, 0.0, 1.0), stands_on=[], clamping="vise", fixtures=fixtures, promised=1.0)
    file = tmp_path / "setup-1.toml"
    file.write_text(setup_toml(setup), encoding="utf-8")
    assert "the vise grips the stock" in file.read_text(encoding="utf-8")
    assert [each.text for each in read_setup(file).fixtures] == fixtures
    process = plan(box(40, 30, 20), setup=str(file), **HOW).plan.process
    assert (process.setups[0].stands_on, process.stock.word) == ("stock", "box:1,1,5")


def test_the_word_of_a_fixture_is_read_again():
    for text in ("stock:box:1,2,5", "stock:cylinder:1,5", "stock:blank.step"):
        assert Fixture.parse(text).text == text
    assert Options(fixtures="stock:box:1,2,5").stock == "box:1,2,5"


def test_a_vise_that_a_setup_file_has_in_its_place_is_not_placed_once_more(tmp_path):
    """As advice on proposed setups is typed: the command that was asked, with the files of the setups behind it."""
    file = tmp_path / "setup-1.toml"
    file.write_text('unit = "mm"\naxis = [0, 0, 1]\nfixtures = ["vise:46x25x65:3:30@20,15,0,0,0,-90"]\n', encoding="utf-8")
    alone, typed = (Options(setup=str(file), fixtures=words) for words in ((), ("vise",)))
    assert typed.fixtures == alone.fixtures
    # Another setup, of which nobody says where the vise is, has one that is placed.
    both = Options(setup=str(file), other_setups=((0, 0, -1),), fixtures="vise")
    assert [each.to_place for each in both.placement.fixtures] == [False]
    assert [each.to_place for each in both.other_placements[0].fixtures] == [True]
    # A chuck beside the vise stays one too many.
    with pytest.raises(PlanError, match="one vise or chuck is placed on a part"):
        plan(box(40, 30, 20), setup=str(file), fixtures="chuck", **HOW)
