"""Holes for drills: a verdict of their own, of no cutter's area; with drills, what makes each."""

import json
import re
from dataclasses import replace

import cadquery as cq
import numpy as np
import pytest

from plan_cutters import Placement, plan
from plan_cutters.answers.drilling import drilled
from plan_cutters.domain.verdicts import DRILLED, WORDS
from plan_cutters.errors import UnjudgeableError
from plan_cutters.options import Options
from plan_cutters.pipeline import prepare
from plan_cutters.plan_file.model import Plan
from plan_cutters.report.to_json import dumps
from plan_cutters_check.asking import question_of
from plan_cutters_check.check import check
from tests.support.drills import drill, library_of
from tests.support.plates import block
from tests.support.plates import drilled as bored

WORDS_OF_PLAN = {
    "cutters": ["D10L40F20S5", "D6L30rc0.5F15S3"],
    "faces": "all",
    "grid": 5,
    "area_budget": 0,
    "machine": "trunnion-ac",
}


def plate():
    """Four holes D3.3 through, one D8 with a drill's point, and one D12 with a counterbore D20 x 3."""
    made = block().rect(44, 26, forConstruction=True).vertices().hole(3.3).cut(bored(8.0, 7.0, 118.0, (-12.0, 0.0)))
    for radius, deep in ((6, 6), (10, 3)):
        made = made.cut(cq.Workplane("XY").circle(radius).extrude(deep).translate((12, 0, -deep)))
    return made.val()


@pytest.fixture(scope="module")
def judged():
    return plan(plate(), **WORDS_OF_PLAN)


def numbers(names):
    return [int(name[1:]) for name in names]


def test_samples_in_holes_have_a_verdict_of_their_own_with_every_cutter(judged):
    on = np.isin(judged.samples.face, [n for hole in judged.plan.holes for n in numbers(hole.faces)])
    assert on.any()
    assert not on.all()
    for verdicts in judged.reaches.values():
        assert ((verdicts.verdict == DRILLED) == on).all()
        assert not (verdicts.reached & on).any()
        assert not (verdicts.not_reached & on).any()
    assert judged.plan.samples.drilled == on.sum() == judged.plan.samples.count - judged.plan.samples.finished


def test_holes_cost_no_cutter_its_feasibility(judged):
    # It is too wide for all of them.
    assert judged.plan.cutters[0].id == judged.selected == "R5L40F20S2.5"
    milled = plan(plate(), **WORDS_OF_PLAN, drill_below=0)
    assert milled.selected is None
    assert milled.plan.holes == []
    assert "drilled" not in milled.plan.legend
    assert not any((verdicts.verdict == DRILLED).any() for verdicts in milled.reaches.values())


def test_the_plan_describes_each_hole_and_the_summary_tells_of_them(judged):
    rows = sorted((h.diameter_mm, h.depth_mm, h.through, h.bottom, h.cone_deg) for h in judged.plan.holes)
    assert rows == [(3.3, 16.0, True, "open", None)] * 4 + [(8.0, 7.0, False, "cone", 118.0), (12.0, 6.0, False, "flat", None)]
    groups = [hole.group for hole in judged.plan.holes]
    assert sorted(groups) == groups
    assert sorted(groups.count(g) for g in set(groups)) == [1, 1, 4]
    (wide,) = [hole for hole in judged.plan.holes if hole.diameter_mm == 12.0]
    assert (wide.counterbore.diameter_mm, wide.counterbore.depth_mm) == (20.0, 3.0)
    # The counterbore is milled.
    widths = {face.id: face.carrier.radius_mm for face in judged.plan.faces if face.shape == "cylinder"}
    assert 10.0 in widths.values()
    assert all(widths.get(name) != 10.0 for name in wide.faces)
    text = " ".join(" ".join(judged.plan.text.lines).split())
    share = 100.0 * sum(e.drilled_share * a for e, a in _faces(judged.plan)) / sum(a for _, a in _faces(judged.plan))
    told = re.search(r"6 holes, ([\d.]+) % of the area, are for drills: (.*?)\. ", text)
    assert float(told[1]) == pytest.approx(share, abs=0.06)
    assert told[2] == "4 x D3.3, 16 deep, through; D8, 7 deep; D12, 6 deep, counterbore D20"
    assert "inside radius" not in text
    assert not judged.plan.inside_radii


def _faces(document):
    areas = {face.id: face.area_mm2 for face in document.faces}
    return [(each, areas[name]) for name, each in document.cutters[0].faces.items()]


def test_shares_are_those_of_what_mills_are_asked(judged):
    for cutter in judged.plan.cutters:
        shares = cutter.area_share
        assert shares.interference_free + shares.accessible + shares.not_reached + shares.unjudged == pytest.approx(1.0)
        assert cutter.drilled == judged.plan.samples.drilled
    hole = judged.plan.holes[0].faces[0]
    assert judged.plan.cutters[0].faces[hole].drilled_share == 1.0
    assert judged.face(hole).shares == {}
    whole = judged.plan.process.asked_mm2
    assert whole == pytest.approx(sum(area * (1.0 - each.drilled_share) for each, area in _faces(judged.plan)))


def test_a_part_without_holes_has_the_same_plan_but_for_the_option():
    def written(**words):
        made = plan(block().slot2D(20, 6).cutThruAll().val(), **WORDS_OF_PLAN, **words)
        run = made.plan.run.model_copy(update={"time": "", "seconds": {}, "boxes": {}, "total": 0.0})
        text = dumps(made.plan.model_copy(update={"run": run}))
        return re.sub(r'"drill_below_mm": [\d.]+', "", text)

    assert '"holes": []' in written()
    assert "drilled" not in written()
    assert "drilling" not in written()
    assert written() == written(drill_below=0.0)


def test_old_plans_are_read():
    document = json.loads(
        dumps(plan(cq.Workplane("XY").box(30, 30, 16).val(), cutters="R3L40", faces="F1", grid=3, area_budget=0).plan)
    )
    del document["holes"], document["effective"]["drill_below_mm"]
    assert Plan.model_validate(document).holes == []


def test_operations_and_advice_leave_holes_alone():
    words = {**WORDS_OF_PLAN, "cutters": ["D10L40F20S5"], "operations": "fewest", "feed": 800, "answers": "mend,radius"}
    made = plan(plate(), **words)
    on = made.reaches[made.shown].verdict == DRILLED
    for each in made.answers.operations.plans:
        assert (each.label[on] == -1).all()
    faces = {name for hole in made.plan.holes for name in hole.faces}
    assert not faces.intersection(name for step in made.plan.process.steps for name in step.faces)
    assert not faces.intersection(name for left in made.plan.process.left for name in left.faces)
    for radii in made.plan.largest_radius:
        assert radii.bottleneck_face not in faces


def test_a_hole_that_is_asked_alone_is_refused_with_what_to_do():
    with pytest.raises(UnjudgeableError, match="--drill-below 0"):
        plan(plate(), **{**WORDS_OF_PLAN, "faces": "F7"})


def test_faces_that_own_steps_name_are_milled(judged):
    hole = next(hole for hole in judged.plan.holes if hole.diameter_mm == 8.0)
    step = {"setup": 1, "mode": "fixed", "angles": {"C": 0.0, "A": 0.0}, "cutter": "D6L30rc0.5F15S3", "faces": [hole.faces[0]]}
    ready = prepare(plate(), Options.of({**WORDS_OF_PLAN, "feed": 800, "process": {"rest": "leave", "step": [step]}}))
    assert [each.diameter for each in ready.holes if each.diameter > 7.0] == pytest.approx([12.0])


def test_the_models_and_the_page_have_a_colour_for_it(tmp_path, judged):
    judged.write(tmp_path, ["glb", "step", "json", "npz", "html", "csv"])
    assert judged.plan.legend["drilled"] == "#0072B2"
    assert b'"drilled"' in (tmp_path / "annotated.glb").read_bytes()
    assert b"drilled" in (tmp_path / "annotated.step").read_bytes()
    with np.load(tmp_path / "samples.npz") as arrays:
        assert all((arrays[name] == 4).any() for name in arrays if name.startswith("verdict_"))
    assert WORDS[4] == "drilled"
    assert ",drilled," in (tmp_path / "axes.csv").read_text()


def test_the_checker_knows_what_is_for_drills(tmp_path):
    words = {**WORDS_OF_PLAN, "cutters": ["D10L40F20S5"], "operations": "fewest", "feed": 800}
    cq.exporters.export(cq.Workplane(plate()), str(tmp_path / "plate.step"))
    plan(tmp_path / "plate.step", **words).write(tmp_path, ["json", "npz"])
    document = json.loads((tmp_path / "plan.json").read_text())
    arrays = {name: dict(np.load(tmp_path / name)) for name in ("samples.npz", "operations.npz")}
    from cad_io import read_part

    part = read_part(tmp_path / "plate.step")

    def failed():
        answer = check(question_of(part, Options(**words), document, arrays), seconds=1e6)
        return [each.words for each in answer.findings if each.holds is False] + [str(each) for each in answer.entries.differ]

    assert failed() == []
    name = next(each for each in arrays["samples.npz"] if each.startswith("verdict_"))
    verdict = arrays["samples.npz"][name]
    rows = np.flatnonzero(verdict == DRILLED)
    arrays["samples.npz"][name] = np.where(np.arange(len(verdict)) == rows[0], 0, verdict).astype(np.uint8)
    assert any("samples are otherwise" in words for words in failed())
    arrays["samples.npz"][name] = verdict
    document["holes"][0]["diameter_mm"] += 0.5
    assert failed()


def made_with(*drills, shape=None, **words):
    options = {**WORDS_OF_PLAN, **words, "libraries": [library_of(*drills)]}
    ready = prepare(plate() if shape is None else shape, Options.of(options))
    made = drilled(ready, np.ones(len(ready.samples), bool))
    by = [next((use for use in each.uses if use.main), None) for each in made]
    return {round(hole.diameter, 3): each for hole, each in zip(ready.holes, by, strict=True)}


def test_a_drill_of_its_size_makes_a_hole():
    made = made_with(drill(3.3), drill(8.0), drill(12.0))
    assert made[3.3].drill.diameter == pytest.approx(3.3)
    assert made[8.0].drill.diameter == pytest.approx(8.0)
    # Over a floor, which is a mill's, it ends with its point.
    assert made[12.0].tip == pytest.approx([12.0, 0.0, -6.0])
    assert made[3.3].axis == pytest.approx([0.0, 0.0, 1.0])
    assert made[3.3].setup == 0


@pytest.mark.parametrize("words", [
    {"diameter": 3.4}, {"diameter": 3.2}, {"flutes": 17.9}, {"kind": "reamer"}, {"kind": "tap"},
])  # fmt: skip
def test_another_one_does_not(words):
    """The wrong diameter, flutes too short for its point, or no drill."""
    assert made_with(drill(**{"diameter": 3.3, **words}))[3.3] is None
    assert made_with(drill(3.33, flutes=18.1))[3.3] is not None


@pytest.mark.parametrize(("point", "makes"), [(118.0, True), (120.0, True), (135.0, False), (None, False)])
def test_the_point_of_a_drill_fits_the_bottom(point, makes):
    assert (made_with(drill(8.0, point=point))[8.0] is not None) == makes


def test_a_holder_beside_a_wall_stops_a_drill():
    """A hole next to a wall of 30 mm: the holder is free beyond it, with the drill long enough."""
    wall = cq.Workplane("XY").box(60, 4, 30).translate((0, 10, 15))
    shape = block().circle(2.5).cutThruAll().union(wall).val()
    assert made_with(drill(5.0, flutes=30.0, length=35.0), shape=shape)[5.0] is None or (
        made_with(drill(5.0, flutes=30.0, length=35.0), shape=shape)[5.0].axis @ [0.0, 0.0, 1.0] < 0.0
    )
    from_above = made_with(drill(5.0, flutes=30.0, length=55.0), shape=shape, machine="tilt:5")[5.0]
    assert from_above is not None
    assert made_with(drill(5.0, flutes=30.0, length=35.0), shape=shape, machine="tilt:5")[5.0] is None


def test_over_a_table_the_point_goes_through_only_where_no_other_setup_is_free_of_one():
    """Then it goes down to the end of the hole alone, and the part is to be put on parallels."""
    free = made_with(drill(3.3), machine="tilt:5")[3.3]
    over = made_with(drill(3.3), machine="tilt:5", fixtures="table")[3.3]
    assert over.depth == 16.0
    assert free.depth > 16.0
    both = [Placement(z=(0, 0, 1), fixtures=("table",)), Placement(z=(0, 0, -1))]
    turned = made_with(drill(3.3), machine="tilt:5", setup=both[0], other_setups=both[1:])[3.3]
    assert (turned.setup, turned.depth) == (1, free.depth)
    words = {**WORDS_OF_PLAN, "libraries": [library_of(drill(3.3))]}
    doubts = [plan(plate(), **words, **more).plan.process.doubts for more in ({}, {"fixtures": "table"})]
    assert [any("on parallels in setup 1" in line for line in each) for each in doubts] == [False, True]


def test_a_machine_that_cannot_hold_the_axis_drills_nothing():
    made = made_with(drill(3.3), drill(8.0), machine="tilt:5", setup="+x")
    assert made[3.3] is None
    assert made[8.0] is None
    turned = made_with(drill(8.0), machine="tilt:5", setup="+x", other_setups=["+z"])
    assert turned[8.0].setup == 1


def test_steps_have_minutes_and_what_none_makes_is_named():
    words = {**WORDS_OF_PLAN, "libraries": [library_of(drill(3.3))]}
    made = plan(plate(), **words).plan
    (step,) = made.process.drilling
    deep = 16.0 + 1.65 / np.tan(np.radians(59.0))
    assert (len(step.holes), step.setup, step.angles_deg) == (4, 0, {"C": 0.0, "A": 0.0})
    assert step.seconds == pytest.approx(4 * 1.3 * deep / 300.0 * 60.0)
    assert step.link_seconds == 4.0
    assert [hole.drilled for hole in made.holes].count(True) == 4
    text = " ".join(" ".join(made.text.lines).split())
    assert "Drills of the set make 4 of them" in text
    assert "no tool makes D8 x 7, D12 x 6." in text
    assert replace(drill(3.3), point=None).id != drill(3.3).id
