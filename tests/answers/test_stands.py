"""How a part is stood and held by a proposal: what nobody would do is not proposed, and what has to be is named."""

from functools import partial

import cadquery as cq
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from plan_cutters import Options, Scene, plan
from plan_cutters.answers import setup_ranking
from plan_cutters.answers.holding import Held, best_hold
from plan_cutters.answers.setup_ranking import ranked
from plan_cutters.domain.fixture import Fixture
from plan_cutters.domain.stock import Stock
from plan_cutters.pipeline import prepare
from plan_cutters.setups.clamping import NothingToGripError, refuse_ungripped
from plan_cutters_base import stage_cache
from tests.support.cad_parts import box, compound, real, rod, write_step

HOW = {"cutters": "R2L60HR15L30", "faces": "all", "grid": 5, "area_budget": 0, "machine": "trunnion-ac"}
WORDS = ("table", "vise", "chuck")


def proposed(shape, words=WORDS, stock=None, **options):
    """The ranking of a shape, and the directions that are chosen, held as they are."""
    ready = prepare(shape, Options(**{**HOW, **options}))
    ready = ready.__class__(**{**_fields(ready), "scene": ready.scene.for_targets(ready.chosen.targets)})
    ranking = ranked(ready, 3, words, stock)
    return ranking, ranking.chosen_and_held(3)


def _fields(record):
    return {name: getattr(record, name) for name in record.__dataclass_fields__ if record.__dataclass_fields__[name].init}


def bracket():
    """A plate and an upright of it, with a lug of 14 x 8 mm at the plate's end."""
    plate = cq.Workplane().box(80, 50, 10).union(cq.Workplane().box(10, 50, 60).translate((-35, 0, 25)))
    return plate.union(cq.Workplane().box(14, 8, 10).translate((47, 0, 0))).val().wrapped


def spiked():
    """A disk with eight thin pins on it: its plane and the tips of the pins are below in turn."""
    pins = cq.Workplane().polarArray(30, 0, 360, 8).circle(0.5).extrude(12)
    return cq.Workplane().circle(40).extrude(8).union(pins).val().wrapped


def chamfered():
    return cq.Workplane().box(80, 50, 30).edges(">X and >Z").chamfer(4).val().wrapped


def stepped():
    """Three steps of one height: whichever way its sides are up, all but two faces are along the tool."""
    return cq.Workplane("XZ").polyline([(0, 0), (90, 0), (90, 10), (60, 10), (60, 20), (30, 20), (30, 30), (0, 30)]).close() \
        .extrude(60).val().wrapped  # fmt: skip


@pytest.mark.parametrize("machine", ["3-axis", "4-axis-a"])
def test_a_part_that_stands_is_turned_over_before_it_is_stood_on_a_side(machine):
    ranking, chosen = proposed(stepped(), stock=Stock.of("usual"), machine=machine, cutters="D16L60F32S16", grid=9)
    assert sorted(ranking.candidates.axis[k].tolist() for k in chosen) == [[0.0, 0.0, -1.0], [0.0, 0.0, 1.0]]
    assert np.logical_or.reduce([ranking.served(k) for k in chosen]).all()


@pytest.mark.parametrize("shape", [bracket, spiked, chamfered])
def test_each_setup_stands_or_is_gripped_without_a_nest(shape):
    ranking, chosen = proposed(shape())
    assert chosen
    for k in chosen:
        assert not ranking.held[k].soft
        assert ranking.held[k].kind != "table" or ranking.candidates.bearing[k].firm


def test_a_part_stands_on_no_chamfer_for_a_little_more_area():
    ranking, chosen = proposed(chamfered())
    # Along the axes of the block alone: the chamfer's normal lies between two of them.
    assert all(np.abs(ranking.candidates.axis[k]).max() > 0.999 for k in chosen)


def test_no_lug_is_gripped_where_the_body_can_be():
    ready = prepare(bracket(), Options(**HOW))
    for axis in ((0.0, 0.0, 1.0), (0.0, 1.0, 0.0)):
        hold = ready.scene.hold(Fixture("vise"), axis)
        lug = {f"F{f.number}" for f in ready.scene.part.faces if abs(f.area - 140.0) < 1e-6}
        assert not lug & {f"F{n}" for n in hold.grips} or hold.soft


def test_what_is_gripped_by_a_lug_alone_says_that_it_needs_a_nest():
    """A ball on a block of 14 x 15 mm: the block is all that has planes."""
    part = cq.Workplane().sphere(30).union(cq.Workplane().box(14, 15, 20).translate((0, 0, -35))).val().wrapped
    hold = prepare(part, Options(**HOW)).scene.hold(Fixture("vise"), (0.0, 0.0, 1.0))
    assert hold.soft == "what they grip is a lug"
    assert "it needs soft jaws or a nest: what they grip is a lug" in hold.words


def test_a_firm_table_is_taken_before_soft_jaws():
    served = np.array([True, True])
    table, vise = (Held(Fixture.each_of(word)[0], served, soft=soft) for word, soft in (("table", ""), ("vise", "a lug")))
    weight = np.ones(2)
    assert best_hold([table, vise], {}, weight).kind == "table"
    assert "a vise needs soft jaws or a nest (a lug)" in best_hold([table, vise], {}, weight).why
    soft_table = Held(table.fixture, served, soft="it stands on nothing")
    assert best_hold([soft_table, vise], {}, weight).kind == "vise"


def test_the_first_setup_grips_the_stock_and_the_last_one_faces_the_bottom():
    block = cq.Workplane().box(60, 40, 20).val().wrapped
    ranking, chosen = proposed(block, stock=Stock.of("box"))
    first, last = (ranking.held[k] for k in chosen)
    assert (first.kind, first.grips, first.stock.text) == ("vise", (), "stock:box:1,1,5")
    assert last.stock is None
    assert len(last.grips) == 2
    assert np.allclose(ranking.candidates.axis[chosen[0]], -ranking.candidates.axis[chosen[1]])
    assert (ranking.served(chosen[0]) | ranking.served(chosen[1]))[ranking.free].all()


def clevis():
    body = cq.Workplane().box(40, 40, 70, centered=(True, True, False)).edges("|Y and >Z").fillet(19.9)
    return body.cut(cq.Workplane().box(60, 16, 40, centered=(True, True, False)).translate((0, 0, 30))).val().wrapped


@pytest.mark.parametrize("cutters", [["R8L60F35HR25L30"], ["R8L60F35HR25L30", "R5L45F25HR25L30", "R3L40rc3F18HR25L30"]])
def test_no_setup_is_proposed_of_which_others_do_all(cutters):
    """The first one too: what others hold is not there while the part is in its stock."""
    ranking, chosen = proposed(clevis(), ("table", "vise"), Stock.of("box"), cutters=cutters, machine="4-axis-a")
    table = np.stack([ranking.served(k) for k in chosen], axis=1)
    assert (ranking.share(table & (table.sum(axis=1) == 1)[:, None]) >= 0.005).all()
    assert [ranking.held[k].stock is not None for k in chosen] == [True, *[False] * (len(chosen) - 1)]


def angle():
    plates = cq.Workplane("XZ").polyline([(0, 0), (100, 0), (100, 14), (14, 14), (14, 90), (0, 90)]).close().extrude(80)
    rib = cq.Workplane("XZ", origin=(0, -34, 0)).polyline([(14, 14), (60, 14), (14, 60)]).close().extrude(12)
    return plates.union(rib).val().wrapped


def test_a_setup_holds_what_one_before_it_machines():
    cutters = ["R8L60F35HR25L30", "R3L40rc3F18HR25L30"]
    ranking, chosen = proposed(angle(), stock=Stock.of("box"), cutters=cutters, machine="3-axis")
    assert len(chosen) == 3
    face, served = ranking.ready.samples.face[ranking.rows], np.zeros(len(ranking.rows), bool)
    for number, k in enumerate(chosen):
        held = np.isin(face, ranking.held[k].faces) & (number > 0)
        assert ranking.area[held & ~served].sum() <= 0.05 * ranking.area[held].sum()
        served |= ranking.served(k)


def test_a_plan_says_what_is_below_where_nothing_holds_the_part():
    setup = plan(cq.Workplane().box(30, 20, 10).val().wrapped, **HOW).plan.process.setups[0]
    assert (setup.held, setup.clamping, setup.grips) == (None, None, [])
    assert len(setup.stands_on) == 1
    assert setup.text == f"Setup 1: +Z up, nothing holds it yet; {setup.stands_on[0]} is below."


def test_a_part_cut_aslant_stands_on_the_plane_of_the_cut():
    """Beside it triangles of the curved wall lie a little lower, by their chord error."""
    (file,) = real("axom_sliced_cylinder.step")
    up = (0.15794873, -0.25364426, -0.95431483)
    setup = plan(file, **HOW | {"faces": "F1", "fixtures": "table", "setup": up, "cutters": "R8L60"}).plan.process.setups[0]
    assert setup.stands_on == ["F2"]


def test_what_gripped_stock_first_grips_the_part_where_it_comes_later():
    """Proposals are tried one after the other: only the first setup of each has stock to grip."""
    ranking, (first, last) = proposed(cq.Workplane().box(60, 40, 20).val().wrapped, stock=Stock.of("box"))
    ranking.settle((last, first))
    assert (ranking.held[last].stock is not None, ranking.held[first].stock) == (True, None)
    assert len(ranking.held[first].grips) == 2
    ranking.settle((first, last))
    assert (ranking.held[first].stock is not None, ranking.held[last].stock) == (True, None)


def test_a_round_part_is_made_of_a_bar_in_a_chuck_and_another_of_a_box_in_a_vise():
    for shape, kind, word in ((rod(20.0, 30.0), "chuck", "cylinder:1,25"), (box(40.0, 30.0, 30.0), "vise", "box:1,1,5")):
        ranking, chosen = proposed(shape, stock=Stock.of("usual"))
        held = ranking.held[chosen[0]]
        assert (held.kind, held.stock.stock.text) == (kind, word)


def test_stock_that_a_person_names_is_not_exchanged():
    ranking, chosen = proposed(rod(20.0, 30.0), stock=Stock.of("box:2,2,8"))
    assert ranking.held[chosen[0]].stock.stock.text == "box:2,2,8"


def test_stock_that_a_person_names_is_gripped_wherever_jaws_can():
    """A bar that lies hides half of the part between bored jaws: nobody would propose it, and here somebody asks for it."""
    ranking, chosen = proposed(rod(15.0, 160.0), stock=Stock.of("cylinder"))
    first, *others = (ranking.held[k] for k in chosen)
    assert (first.kind, first.soft, first.stock.stock.text) == ("vise", "", "cylinder:1,25")
    assert others
    assert all(each.stock is None and not each.soft for each in others)
    assert abs(ranking.candidates.axis[chosen[0]][2]) < 0.5


def test_no_bar_is_stood_on_its_end():
    """160 mm on 30 mm: neither as stock, nor in a chuck, nor between the jaws of a vise on two flats."""
    flats = cq.Workplane("YZ").circle(15).extrude(160).cut(cq.Workplane().box(400, 40, 10).translate((0, 0, 17)))
    flats = flats.cut(cq.Workplane().box(400, 40, 10).translate((0, 0, -17))).val().wrapped
    ranking, chosen = proposed(flats, stock=Stock.of("usual"))
    assert abs(ranking.candidates.axis[chosen[0]][0]) < 0.5
    for word, what in (("chuck", rod(15.0, 160.0)), ("vise", box(30.0, 30.0, 160.0))):
        soft = prepare(what, Options(**HOW)).scene.hold(Fixture(word), (0.0, 0.0, 1.0)).soft
        assert soft == "it stands 160 mm high on 30 mm"


@settings(max_examples=60, deadline=None)
@given(
    st.floats(3.0, 200.0), st.floats(3.0, 200.0), st.floats(3.0, 40.0), st.sampled_from(["vise", "chuck"]), st.integers(0, 2),
    st.floats(-0.3, 0.3),
)  # fmt: skip
def test_what_is_refused_by_shapes_alone_is_refused_by_the_search_too(x, y, z, word, along, turn):
    """Blocks that may be turned about an axis: where no faces are made for jaws, the search among triangles finds none either."""
    part = cq.Workplane().box(x, y, z).rotate((0, 0, 0), (1, 0, 0), float(np.degrees(turn))).val().wrapped
    scene, axis = Scene.of(part), tuple(np.eye(3)[along].tolist())
    scene.surround()
    refuse = partial(refuse_ungripped, Fixture(word), scene.part.faces, scene.orientation.sign, axis, 500.0)
    if refuses(refuse):
        assert refuses(partial(scene.hold, Fixture(word), axis))


def refuses(job):
    try:
        job()
    except NothingToGripError:
        return True
    return False


def test_a_vise_without_opposite_planes_is_refused_before_anything_is_meshed(tmp_path, monkeypatch):
    monkeypatch.setattr(Scene, "surround", lambda *args, **more: pytest.fail("it was meshed"))
    for others in ((), ((0, 0, -1),)):
        with pytest.raises(NothingToGripError, match="no two opposite plane faces stand along it"):
            plan(rod(20.0, 30.0), other_setups=others, fixtures="vise", **HOW)
    with pytest.raises(NothingToGripError, match="no outside cylinder along it"):
        plan(box(20.0, 30.0, 10.0), fixtures="chuck", **HOW)
    with pytest.raises(NothingToGripError, match="farther apart than the 355 mm to which the vise opens"):
        plan(box(500.0, 400.0, 10.0), fixtures="vise", **HOW)


def test_bodies_that_lie_against_each_other_are_one_clamping():
    apart, near = (compound(box(20, 20, 10), box(20, 20, 10, at=(at, 0, 0))) for at in (30.0, 20.0))
    codes = [plan(part, **HOW).plan.note_codes for part in (apart, near)]
    assert ["bodies_apart" in each for each in codes] == [True, False]


def test_setups_are_not_compared_again_for_the_next_question(tmp_path, monkeypatch):
    """The same part, cutters and machine, and another feed: the proposal is read, and is the same."""
    file = write_step(box(40.0, 30.0, 30.0), tmp_path / "block.step")
    monkeypatch.setenv("PLAN_CUTTERS_CACHE", str(tmp_path / "kept"))
    monkeypatch.setattr(stage_cache, "_WORTH", 0.0)
    shares = []
    how = {**HOW, "setup": "auto", "grid": 9}
    first = plan(file, progress=lambda stage, *share: shares.append((stage, share)), **how)
    stage_cache.settle()
    # "Comparing setups" tells its share.
    assert len({share for stage, share in shares if stage == "proposal"}) > 3
    monkeypatch.setattr(setup_ranking, "ranked", lambda *_: pytest.fail("setups were compared again"))
    again = plan(file, feed=900.0, operations="fastest", **how)
    assert again.plan.setup_proposal == first.plan.setup_proposal
    monkeypatch.undo()
    monkeypatch.setenv("PLAN_CUTTERS_CACHE", str(tmp_path / "kept"))
    monkeypatch.setattr(setup_ranking, "ranked", lambda *_: (_ for _ in ()).throw(RuntimeError("compared")))
    with pytest.raises(RuntimeError, match="compared"):
        plan(file, **{**how, "machine": "trunnion-bc"})


@pytest.mark.parametrize(
    ("machine", "long", "cosines"),
    [("trunnion-ac", 30.0, {1.0}), ("3-axis", 30.0, {1.0}), ("4-axis-a", 30.0, {0.0}), ("4-axis-a", 90.0, {0.0})],
)
def test_no_chuck_stands_across_the_axis_that_turns_under_it(machine, long, cosines):
    """A round rod: on a fourth axis across the spindle it lies along that, a short one too, and stands in no chuck."""
    setups = plan(rod(20.0, long), setup="auto", **{**HOW, "machine": machine}).plan.setup_proposal.setups
    chucks = [each for each in setups if each.clamping == "chuck"]
    assert {round(float(np.dot(Fixture.parse(each.fixtures[-1]).rotation[:, 2], each.axis)), 9) for each in chucks} == cosines


def lying_shaft(turned):
    """A stepped shaft with a flat, along x, or along z."""
    part = cq.Workplane("YZ").circle(20).extrude(30).faces(">X").workplane().circle(12).extrude(40)
    part = part.cut(cq.Workplane().box(30, 40, 20).translate((60, 0, 17)))
    return (part.rotate((0, 0, 0), (0, 1, 0), -90) if turned else part).val().wrapped


@pytest.mark.parametrize("turned", [False, True])
def test_on_a_fourth_axis_a_bar_lies_along_it_in_a_chuck_and_is_turned_round_there(turned):
    how = {**HOW, "machine": "4-axis-a", "cutters": "D8L60F30S8"}
    setups = plan(lying_shaft(turned), setup="auto", **how).plan.setup_proposal.setups
    assert [each.clamping for each in setups] == ["chuck", "chuck"]
    chucks = [Fixture.parse(each.fixtures[-1]).rotation[:, 2] for each in setups]
    for each, up in zip(setups, chucks, strict=True):
        # The chuck stands along the machine's X, about which the fourth axis turns, across the spindle.
        assert np.allclose(each.x, up, atol=1e-9)
        assert abs(np.dot(each.axis, up)) < 1e-9
    assert np.allclose(chucks[0], -chucks[1], atol=1e-9)
    # The stock in the first setup, and what was turned there in the second.
    assert [Fixture.parse(each.fixtures[-1]).clamping.grip for each in setups] == [20.0, 20.0]


def test_a_journal_with_a_flat_is_gripped_and_a_tailstock_named_for_what_stands_far_out():
    """Triangles of the journal beside its flat lean from their cylinder by more than planes that are parallel."""
    shaft = cq.Workplane("YZ").circle(20).extrude(30).faces(">X").workplane().circle(14).extrude(50)
    shaft = shaft.faces(">X").workplane().circle(10).extrude(30).union(cq.Workplane("YZ").circle(12).extrude(-25))
    shaft = shaft.cut(cq.Workplane().box(30, 40, 20).translate((-20, 0, 18)))
    plain = cq.Workplane("YZ").circle(12).extrude(40).val().wrapped
    how = {**HOW, "machine": "4-axis-a", "cutters": "D8L60F30S8", "setup": "auto"}
    made = plan(shaft.val().wrapped, **how).plan
    assert [each.clamping for each in made.setup_proposal.setups] == ["chuck", "chuck"]
    assert [each.soft for each in made.process.setups] == ["", ""]
    # The stock of 42 mm and its margin beyond the part; then what is beside 17 mm of the journal of 24 mm.
    assert [each.out_mm for each in made.process.setups] == pytest.approx([136.0 + 5.0 - 1.0, 135.0 - 50.0 / 3.0], abs=0.7)
    (said,) = [each for each in made.process.doubts if "tailstock, once" in each]
    assert "on 42 mm in setup 1" in said
    assert "on 24 mm in setup 2" in said
    assert all(each.out_mm is None for each in plan(plain, **how).plan.process.setups)


@pytest.mark.parametrize(("long", "high", "chucks"), [(120.0, 30.0, True), (20.0, 30.0, False), (120.0, 90.0, False)])
def test_a_long_part_that_is_not_round_lies_in_a_chuck_as_a_bar(long, high, chucks):
    """A camshaft: nothing is round along it, and its stock is; what is as high as it is long is a plate."""
    lobe = cq.Workplane("YZ").rect(14, high).extrude(0.2 * long).translate((0.4 * long, 0, 0))
    cam = cq.Workplane("YZ").circle(8).extrude(long).union(lobe)
    first = plan(cam.val().wrapped, **{**HOW, "machine": "4-axis-a", "cutters": "D8L60F30S8", "setup": "auto"}).plan
    assert (first.setup_proposal.setups[0].clamping == "chuck") == chucks


@pytest.mark.parametrize(
    ("wide", "long", "deep"),
    [(20.0, 60.0, 20.0), (12.0, 60.0, 12.0), (40.0, 60.0, 20.0), (40.0, 24.0, 16.0), (40.0, 18.0, 40.0 / 3.0), (40.0, 13.0, 3.0)],
)
def test_a_bar_that_lies_is_gripped_as_deep_as_it_can_be(wide, long, deep):
    """The least of 20 mm, its diameter and two thirds of its length, but a third of the diameter where that is there."""
    bar = cq.Workplane("YZ").circle(0.5 * wide).extrude(long).val().wrapped
    how = {**HOW, "machine": "4-axis-a", "cutters": "D8L60F30S8", "setup": "+z"}
    for word, grip in (("chuck", deep), ("chuck:5", 5.0)):
        (chuck,) = prepare(bar, Options(**{**how, "fixtures": word})).conditions.surroundings.fixtures
        assert chuck.fixture.clamping.grip == pytest.approx(grip, abs=1e-6)
    # Where it stands, more of it is machined.
    stands = Options(**{**how, "machine": "3-axis", "setup": "+x", "fixtures": "chuck"})
    (chuck,) = prepare(bar, stands).conditions.surroundings.fixtures
    assert chuck.fixture.clamping.grip == 3.0


@pytest.mark.parametrize(("machine", "setup", "along"), [("4-axis-a", "+z", (1, 0, 0)), ("trunnion-ac", "+x", (1, 0, 0))])
def test_a_chuck_that_is_requested_stands_on_the_axis_next_to_the_part(machine, setup, along):
    how = {**HOW, "machine": machine, "cutters": "D8L60F30S8", "setup": setup, "fixtures": "chuck"}
    (chuck,) = prepare(lying_shaft(False), Options(**how)).conditions.surroundings.fixtures
    assert np.allclose(chuck.fixture.rotation[:, 2], along)


def test_what_no_chuck_grips_does_not_lie_in_one():
    """A dome: along its axis it is round, and no cylinder is there."""
    dome = cq.Workplane().sphere(20).intersect(cq.Workplane().box(60, 60, 60).translate((0, 0, 30))).val().wrapped
    setups = plan(dome, setup="auto", **{**HOW, "machine": "4-axis-a"}).plan.setup_proposal.setups
    assert all(each.clamping == "chuck" or each.x is None for each in setups)
    assert not setups[0].soft, "what a first setup leaves may need a nest"


def test_stock_does_not_stand_aslant_for_what_is_turned_over_as_well():
    """A thin dish, flat below: what stands on nothing is made first, of stock, and it stands firmly when it is turned over."""
    (file,) = real("brlcad_NIST_MBE_PMI_11.stp")
    made = plan(file, setup="auto", **{**HOW, "cutters": ["D16L60F32S16", "D8L40F20S8"]}).plan
    assert np.allclose([each.axis for each in made.setup_proposal.setups], [[0, 0, -1], [0, 0, 1]])
    assert [each.soft for each in made.process.setups] == ["", ""]
    assert made.process.stock.word.startswith("cylinder")
    assert made.process.finished_share > 0.99


def test_the_underside_of_what_nothing_grips_is_turned_over_into_a_nest():
    """A knob, narrower below, with a domed top: a twelfth of the area is what was cut from the bar."""
    knob = cq.Workplane("XZ").moveTo(0, 0).lineTo(10, 0).lineTo(13, 40).threePointArc((7, 43.8), (0, 45)).close()
    part = knob.revolve(360, (0, 0, 0), (0, 1, 0)).val().wrapped
    made = plan(part, setup="auto", **{**HOW, "cutters": "D8L60F30S8"}).plan
    first, second = made.setup_proposal.setups
    assert np.allclose([first.axis, second.axis], [[0, 0, 1], [0, 0, -1]])
    assert not first.soft
    assert "it stands on 0 mm" in second.soft
    assert made.process.finished_share > 0.99


def test_a_wide_disk_is_gripped_deep_on_its_hub():
    disk = cq.Workplane().circle(40).extrude(4).union(cq.Workplane().circle(12).extrude(18)).val().wrapped
    second = plan(disk, setup="auto", **{**HOW, "machine": "3-axis", "cutters": "D12L40"}).plan.process.setups[1]
    assert (second.held, second.apart_mm, second.grip_mm) == ("chuck", pytest.approx(24.0, abs=0.01), 12.0)


def test_a_further_setup_that_needs_a_nest_is_proposed_for_much_of_the_area():
    """A thin disk with a domed top: turned over it stands on nothing, and its underside has two fifths of the area."""
    disk = cq.Workplane("XZ").moveTo(0, 0).lineTo(30, 0).lineTo(30, 2).threePointArc((15, 4.2), (0, 5)).close()
    part = disk.revolve(360, (0, 0, 0), (0, 1, 0)).val().wrapped
    proposal = plan(part, setup="auto", **{**HOW, "machine": "3-axis", "cutters": "D12L40"}).plan.setup_proposal
    firm, soft = proposal.setups
    assert not firm.soft
    assert "it stands on 0 mm" in soft.soft
    assert np.allclose(np.add(firm.axis, soft.axis), 0.0)


def test_who_asks_for_a_chuck_has_a_bar_laid_in_it_about_a_part_that_is_not_round():
    """A shaft with a lobe: along it nothing is round, and stock is."""
    lobe = cq.Workplane("YZ").circle(12).extrude(90).union(cq.Workplane("YZ").workplane(offset=40).rect(20, 40).extrude(10))
    how = {**HOW, "machine": "4-axis-a", "cutters": "D8L60F30S8", "stock": "cylinder", "fixtures": "chuck", "setup": "auto"}
    first = plan(lobe.val().wrapped, **how).plan.setup_proposal.setups[0]
    assert first.x is not None
    assert abs(first.axis[0]) < 1e-9


def test_across_a_fourth_axis_a_chuck_has_nothing_to_grip():
    with pytest.raises(NothingToGripError, match="nothing to grip along 1,0,0, the rotary axis on which it stands"):
        prepare(rod(20.0, 60.0), Options(**{**HOW, "machine": "4-axis-a", "setup": "+z", "fixtures": "chuck"}))


@pytest.mark.parametrize(("missed", "flat"), [(0.01, True), (0.05, False)])
def test_what_needs_a_nest_anyway_is_stood_aslant_for_two_percent_alone(missed, flat):
    """Of two directions in which nothing holds the part firmly, one along an axis and one aslant that serves more."""
    part = cq.Workplane().sphere(10).val().wrapped
    ranking = ranked(prepare(part, Options(**{**HOW, "grid": 25})), 1, ("table",))
    along, aslant = (
        int(np.flatnonzero(np.isclose(np.abs(ranking.candidates.axis).max(axis=1), top))[0]) for top in (1.0, 0.5**0.5)
    )
    every, less = np.ones(len(ranking.rows), bool), np.cumsum(ranking.area) > missed * ranking.area.sum()
    table = Fixture.each_of("table")[0]
    ranking.held = {along: Held(table, less, soft="a ball"), aslant: Held(table, every, soft="a ball")}
    ranking.gripped = {along: False, aslant: False}
    assert ranking.choose(1) == ((along,) if flat else (aslant,))
