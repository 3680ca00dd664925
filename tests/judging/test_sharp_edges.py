"""Losses beside sharp inside edges by name, on parts whose strips are known in closed form."""

import math
from dataclasses import replace

import numpy as np
import pytest

from cad_io import Part
from cad_io.part.bodies import orient
from cad_io.part.edges import inside_edges
from plan_cutters import Cutter, plan
from plan_cutters.command.codes import code_of
from plan_cutters.document.features import sharp_edge_entries
from plan_cutters.domain.verdicts import LOCAL_GOUGE, SHARP_EDGE, UNDECIDED
from plan_cutters.errors import OptionError
from plan_cutters.judging.judge import judge
from plan_cutters.judging.reasons import exempt, strips
from plan_cutters.options import Options
from plan_cutters.pipeline import prepare
from tests.support.cad_parts import box, cut
from tests.support.profiles import grooved, slotted

HOW = {"area_budget": 0, "jobs": 2, "tolerance": 0.01}


def planned(shape, cutter, faces, spacing):
    return plan(Part(shape), cutters=[cutter], faces=faces, spacing=spacing, **HOW)


def named(result, cutter):
    return result.reaches[cutter].reason == SHARP_EDGE


@pytest.mark.parametrize("degrees", [60.0, 90.0, 120.0])
def test_a_groove_loses_what_its_opening_angle_says(degrees):
    """Within r / tan(phi / 2) of the bottom all is lost to the edge, and beyond nothing is."""
    result = planned(grooved(math.radians(degrees)), "R2L60rc2", "!1,2,3,6,7,8,9", 0.5)
    assert set(np.unique(result.samples.face)) == {4, 5}
    away = np.hypot(*result.samples.point[:, [0, 2]].T)
    wide = 2.0 / math.tan(0.5 * math.radians(degrees))
    slack = 0.02 / math.sin(math.radians(degrees))
    mine = named(result, "R2L60rc2")
    assert mine[away < wide - slack].all()
    assert not mine[away > wide + 1e-6].any()
    assert (result.reaches["R2L60rc2"].not_reached == mine).all()
    (entry,) = result.plan.sharp_edges
    assert set(entry.faces) == {"F4", "F5"}
    assert entry.angle_deg == pytest.approx(degrees)
    assert entry.width_mm == pytest.approx(wide)
    assert entry.length_mm == pytest.approx(40.0, rel=1e-4)
    # Samples stand for half a spacing each way.
    assert entry.area_mm2 == pytest.approx(2 * 40 * wide, abs=2 * 40 * 0.3)


def pocket(x=40.0, y=34.0):
    return cut(box(x + 20, y + 16, 20), box(x, y, 20, (10, 8, 8)))


def test_a_pocket_loses_a_strip_all_along_its_edges():
    """Of a floor 40 x 34 and walls 12 high, a ball R3 leaves what lies within 3 mm of an edge: 1,068 mm2."""
    result = planned(pocket(), "R3L40rc3", "7-11", 0.25)
    mine = named(result, "R3L40rc3")
    assert (mine == result.reaches["R3L40rc3"].not_reached).all()
    entries = result.plan.sharp_edges
    assert len(entries) == 8
    assert sum(each.area_mm2 for each in entries) == pytest.approx(1068.0, rel=0.06)
    line = next(line for line in result.summary().splitlines() if "sharp inside edges where" in line)
    assert "ball end D6 x 40 leaves a fillet of R3 there" in line
    share = result.plan.cutters[0].area_share.lost_by
    assert set(share) == {"sharp_edge"}
    assert result.plan.selected is None


def floor_of(result):
    """Distances (n, 2) of samples of a pocket's floor from its nearest two walls."""
    x, y = result.samples.point[:, 0] - 10.0, result.samples.point[:, 1] - 8.0
    return np.stack([np.minimum(x, 40.0 - x), np.minimum(y, 34.0 - y)], axis=1)


def test_a_flat_end_enters_the_floor_edge_and_leaves_four_corners():
    """Beside the walls nothing is lost; in each corner what lies beyond a circle of its radius: (1 - pi / 4) r2."""
    result = planned(pocket(), "R3L40", "11", 0.25)
    mine, away = named(result, "R3L40"), floor_of(result)
    beyond = (away < 3.0).all(axis=1) & (np.linalg.norm(away - 3.0, axis=1) > 3.0)
    lost = result.reaches["R3L40"].not_reached
    assert mine.any()
    assert not mine[~beyond | ~lost].any()
    # A rotation every 10 deg finds no posture at a few samples just within the circle: that is another cause.
    rest = lost & ~mine
    assert rest.sum() < 0.05 * mine.sum()
    assert (np.linalg.norm(away[rest] - 3.0, axis=1) > 2.8).all()
    # Within the tolerance of the circle it still reaches.
    assert mine[(away < 3.0).all(axis=1) & (np.linalg.norm(away - 3.0, axis=1) > 3.02)].all()
    entries = result.plan.sharp_edges
    assert [round(each.angle_deg) for each in entries] == [90] * 4
    assert sum(each.area_mm2 for each in entries) == pytest.approx(4 * (1.0 - math.pi / 4) * 9.0, rel=0.15)
    assert {face for each in entries for face in each.faces} == {"F7", "F8", "F9", "F10"}


def test_corners_of_a_floor_are_not_named_where_the_cutter_does_not_fit():
    """A flat end wider than the pocket loses all of the floor: no fillet between the walls would help."""
    result = planned(pocket(10.0, 10.0), "R6L40", "11", 0.5)
    assert result.reaches["R6L40"].not_reached.all()
    assert not named(result, "R6L40").any()


def test_what_stands_in_the_middle_of_a_floor_loses_no_corner():
    """A boss with outside corners, and a rib that ends in the air: what is lost beside these is no sharp inside edge."""
    shape = cut(box(60, 50, 20), cut(box(40, 34, 20, (10, 8, 8)), box(6, 6, 30, (27, 22, 0))))
    result = planned(shape, "R3L40", "all", 1.0)
    mine, point = named(result, "R3L40"), result.samples.point
    boss = np.max(np.abs(point[:, :2] - (30.0, 25.0)), axis=1) < 7.0
    floor = (np.abs(point[:, 2] - 8.0) < 1e-6) & (result.samples.normal[:, 2] > 0.9)
    assert floor[boss].any()
    assert not mine[boss].any()


def test_a_slot_that_is_too_narrow_is_no_sharp_edge():
    """A ball R6 in a slot 8 mm wide loses the whole floor: no fillet in the model would help."""
    result = planned(slotted(8.0, 8.0), "R6L60rc6", "all", 1.0)
    floor = (np.abs(result.samples.point[:, 2]) < 1e-6) & (result.samples.normal[:, 2] > 0.9)
    assert floor.any()
    assert not result.reaches["R6L60rc6"].reached[floor].any()
    assert not named(result, "R6L60rc6")[floor].any()


def test_a_dovetail_is_named_within_its_strips_alone():
    """phi = 60 deg: 1.73 r on the floor and on the undercut walls."""
    bottom = 40.0
    result = planned(slotted(bottom, bottom - 2 * 12 / math.tan(math.radians(60))), "R2L60rc2", "all", 0.75)
    mine, point = named(result, "R2L60rc2"), result.samples.point
    away = np.hypot(np.abs(point[:, 0]) - 0.5 * bottom, point[:, 2])
    wide = 2.0 / math.tan(math.radians(30))
    assert mine.any()
    assert (away[mine] < wide + 1e-6).all()
    floor = (np.abs(point[:, 2]) < 1e-6) & (away < wide - 0.03) & (np.abs(point[:, 0]) < 0.5 * bottom + 1e-6)
    assert mine[floor].all()


def test_walls_of_a_t_groove_are_not_lost_to_its_edges():
    """The wall of the slot above faces as they do, and is reached: it is not where a fillet of the radius would end."""
    shape = cut(cut(box(60, 40, 30), box(60, 10, 20, (0, 15, 10))), box(60, 18, 8, (0, 11, 10)))
    result = planned(shape, "R8L60", "all", 3.0)
    x, y, _ = result.samples.point.T
    # At the ends of the groove a cutter beside the block reaches the border of its walls.
    walls = (np.abs(np.abs(y - 20.0) - 9.0) < 1e-6) & (np.abs(result.samples.normal[:, 1]) > 0.9) & (np.abs(x - 30.0) < 12.0)
    assert walls.any()
    assert not result.reaches["R8L60"].reached[walls].any()
    assert not named(result, "R8L60")[walls].any()


def test_names_change_no_verdict():
    ready = prepare(Part(pocket()), Options(cutters=("R3L40rc3",), faces="7-11", spacing=1.0, **HOW))
    result = planned(pocket(), "R3L40rc3", "7-11", 1.0)
    assert (judge(ready, ready.cutters[0]).verdict == result.reaches["R3L40rc3"].verdict).all()


def test_what_the_surface_itself_gouges_is_no_sharp_edge():
    """The same losses, called local gouge, keep their reason; and a cutter that reaches nothing loses nothing to an edge."""
    shape = grooved(math.radians(90))
    part = Part(shape)
    result = plan(part, cutters=["R2L60rc2"], faces="4,5", spacing=1.0, **HOW)
    reach, edges = result.over_setups.each[0][1]["R2L60rc2"], inside_edges(part, orient(part))
    cutter = Cutter.parse("R2L60rc2")
    gouged = replace(reach, reason=np.where(reach.not_reached, LOCAL_GOUGE, reach.reason).astype(np.uint8))
    assert (strips(result.samples, gouged, cutter, edges) == -1).all()
    nothing = replace(reach, verdict=np.zeros_like(reach.verdict))
    assert (strips(result.samples, nothing, cutter, edges) == -1).all()


def test_no_strip_makes_no_entry():
    result = planned(grooved(math.radians(90)), "R2L60rc2", "4,5", 2.0)
    none = np.full(len(result.samples), -1, np.int32)
    assert sharp_edge_entries([], none, result.samples, Cutter.parse("R2L60rc2")) == []


def left(shape, cutters, faces, spacing, **more):
    return plan(Part(shape), cutters=cutters, faces=faces, spacing=spacing, sharp_edges="left", **HOW, **more)


def test_strips_may_be_left_and_are_told_apart():
    """Without the strips a ball R3 finishes the pocket: nothing else is lost."""
    usual, result = planned(pocket(), "R3L40rc3", "7-11", 0.5), left(pocket(), ["R3L40rc3"], "7-11", 0.5)
    process, entry = result.plan.process, result.plan.cutters[0]
    assert (entry.feasible, result.plan.selected, process.finished_share, process.left) == (True, entry.id, 1.0, [])
    assert usual.plan.process.finished_share < 1.0
    assert code_of(usual.plan) == 1
    assert code_of(result.plan) == 0
    # No verdict is another one, and the area is that of the strips.
    assert (result.reaches[entry.id].verdict == usual.reaches[entry.id].verdict).all()
    assert process.exempt.area_mm2 == pytest.approx(usual.plan.process.left[0].area_mm2)
    assert process.exempt.area_mm2 + process.asked_mm2 == pytest.approx(usual.plan.process.asked_mm2)
    assert process.exempt.faces == usual.plan.process.left[0].faces
    assert result.plan.samples.exempt == entry.exempt == result.exempt.sum() == named(result, entry.id).sum()
    assert sum(each.exempt for each in entry.faces.values()) == entry.exempt
    assert entry.area_share.not_reached == 0.0
    assert any("Not required (sharp_edges = left)" in line for line in result.plan.text.lines)
    assert "every sample but those at sharp inside edges" in result.summary()


def test_only_what_no_cutter_enters_is_left():
    """A ball R1 reaches more than a ball R3: the larger one is not excused from what the smaller one does."""
    result = left(pocket(), ["R3L40rc3", "R1L40rc1"], "7-11", 0.5)
    coarse, fine = (result.reaches[name] for name in ("R3L40rc3", "R1L40rc1"))
    assert (result.exempt == named(result, "R1L40rc1")).all()
    assert not (result.exempt & coarse.reached).any()
    assert (coarse.not_reached & fine.reached).any()
    by_id = {each.id: each for each in result.plan.cutters}
    assert by_id["R3L40rc3"].feasible is False
    assert by_id["R1L40rc1"].feasible is True
    assert result.plan.selected == "R1L40rc1"


def test_what_another_cause_loses_is_required():
    """The floor of a slot that is too narrow is no strip, whatever is left."""
    result = left(slotted(8.0, 8.0), ["R6L60rc6"], "all", 1.0)
    floor = (np.abs(result.samples.point[:, 2]) < 1e-6) & (result.samples.normal[:, 2] > 0.9)
    assert not result.exempt[floor].any()
    assert result.plan.cutters[0].feasible is False
    assert {each.cause for each in result.plan.process.left} >= {"rear_gouge"}


def test_an_undecided_sample_is_required():
    cutter = Cutter.parse("R2L60rc2")
    result = planned(grooved(math.radians(90)), "R2L60rc2", "4,5", 1.0)
    reach, inside = result.reaches["R2L60rc2"], np.zeros(len(result.samples), bool)
    lost = exempt({cutter: reach}, inside)
    assert lost.any()
    unsure = replace(reach, verdict=np.where(lost, UNDECIDED, reach.verdict).astype(np.uint8))
    assert not exempt({cutter: unsure}, inside).any()
    assert not exempt({cutter: reach}, ~inside).any()


@pytest.mark.slow("judges many samples")
def test_changes_and_operations_are_about_what_is_required():
    how = {"answers": "mend", "operations": "fewest", "machine": "trunnion-ac", "setup": (0.0, 0.0, 1.0)}
    result = left(pocket(), ["R3L40rc3"], "7-11", 2.0, **how)
    assert result.plan.cutters[0].mend is None
    assert result.exempt.any()
    assert not (result.answers.operations.plans[0].label[result.exempt] >= 0).any()
    assert result.plan.process.left == []


def test_other_words_for_sharp_edges_are_refused():
    with pytest.raises(OptionError, match="none of asked, left"):
        Options(sharp_edges="none")
