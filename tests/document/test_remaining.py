"""What is left says what would help there, by area: sizes that were judged, points that no end fits, steps that were found."""

import math

import numpy as np
import pytest

from cad_io import Part
from plan_cutters import plan
from plan_cutters.answers.state import Case
from plan_cutters.domain.cutter import Cutter
from plan_cutters.domain.verdicts import REASONS
from plan_cutters.plan_file.operations import HelpEntry, PointsEntry
from plan_cutters.plan_file.words.answers import first_tries
from plan_cutters.plan_file.words.process import process_story, with_process_words
from plan_cutters.plan_file.words.text import text_of
from tests.support.cad_parts import ball, box, cone, cut, rod
from tests.support.profiles import extruded
from tests.support.serving import not_reached

HOW = {"area_budget": 0, "jobs": 2, "faces": "all", "setup": (0, 0, 1), "machine": "tilt:90", "drill_below": 0}
GOUGES = ("local_gouge", "rear_gouge", "collision")


def holes():
    """A plate with a hole D6 and one D3 through it."""
    return Part(cut(cut(box(40, 20, 8), rod(3.0, 10, (10, 10, -1))), rod(1.5, 10, (25, 10, -1))))


def drilled(radius):
    """A block with a hole that ends in a point of 118 deg, at the origin."""
    tip = radius / math.tan(math.radians(59.0))
    return Part(cut(cut(box(20, 20, 3 + tip + 2, (-10, -10, -3)), cone(0.0, radius, tip)), rod(radius, 9, (0, 0, tip))))


def gouged(result):
    return [each for each in result.plan.process.left if each.cause in GOUGES]


@pytest.fixture(scope="module")
def plate():
    return plan(holes(), cutters=["D10L30"], spacing=1.2, **HOW)


def test_a_size_reaches_the_share_that_is_said(plate):
    """It is as long, in the same holder, and judged on the samples that are left for that cause."""
    (verdicts,), area, said = plate.reaches.values(), plate.samples.area, []
    for each in gouged(plate):
        rows = np.flatnonzero(plate.ready.finished & verdicts.not_reached & (verdicts.reason == REASONS.index(each.cause)))
        assert area[rows].sum() == pytest.approx(each.area_mm2, rel=1e-3)
        for fit in each.fits:
            missed = not_reached(Case(plate.ready, Cutter.parse(fit.cutter)), rows)
            share = 1.0 - area[missed].sum() / area[rows].sum()
            assert share == pytest.approx(fit.share, abs=0.03)
            said.append(fit.size)
        assert [fit.share for fit in each.fits] == sorted(fit.share for fit in each.fits)
    # By area: the hole D6 is two thirds of what is lost.
    assert said[:2] == ["D6", "D3"]
    assert "flat end D6 fits" in " ".join(" ".join(plate.plan.text.lines).split())


def in_pockets(scale=1.0, *dimples):
    """What a ball leaves for local gouge in two round pockets, and in what else is cut out of their block."""
    shape = box(30 * scale, 20 * scale, 10 * scale)
    for radius, x in ((3.0, 8.0), (2.0, 16.0)):
        shape = cut(shape, ball(radius * scale, (x * scale, 10 * scale, 10 * scale)))
    for dimple in dimples:
        shape = cut(shape, dimple)
    result = plan(Part(shape), cutters=[Cutter.ball(radius=6 * scale, length=40 * scale)], spacing=scale, **HOW)
    (entry,) = [each for each in result.plan.process.left if each.cause == "local_gouge"]
    return entry, [each.radius_mm for each in result.plan.inside_radii if each.face in entry.faces]


def test_sizes_grow_with_the_part():
    (small, radii), (large, twice) = in_pockets(), in_pockets(2.0)
    assert [fit.diameter_mm for fit in small.fits] == [6.0, 4.0]
    assert [fit.diameter_mm for fit in large.fits] == [12.0, 8.0]
    assert [fit.share for fit in small.fits] == pytest.approx([fit.share for fit in large.fits], abs=0.03)
    assert (radii, twice) == (pytest.approx([2.0, 3.0]), pytest.approx([4.0, 6.0]))


def test_what_a_finer_cutter_leaves_for_another_cause_is_no_sharp_edge():
    """A V-groove in the side of a block: from above no cutter sees it, and a fillet at its bottom would not help."""
    corners = [(-20, 0), (20, 0), (20, 6), (11, 9), (11, 13), (20, 16), (20, 22), (-20, 22)]
    flanks = "F3,F5"
    result = plan(Part(extruded(corners)), cutters=["R8L60", "R3L60"], spacing=5, **HOW | {"machine": "3-axis", "faces": flanks})
    assert (result.reaches["R8L60"].reason == REASONS.index("sharp_edge")).any()
    assert "sharp_edge" not in {each.cause for each in result.plan.process.left}


def test_a_tiny_face_changes_no_word_on_the_others():
    """A dimple of less than 1 mm2 in which no usual size fits."""
    (without, radii), (entry, others) = in_pockets(), in_pockets(1.0, ball(0.2, (24, 10, 10)))
    assert len(entry.faces) == len(without.faces) + 1
    assert (entry.needs, others) == (without.needs, pytest.approx(radii))


@pytest.mark.parametrize(("radius", "cutter"), [(4.0, "D6L30"), (1.0, "D6L30"), (1.0, "D2L30rc1")])
def test_the_point_of_a_drill_is_no_radius(radius, cutter):
    result = plan(drilled(radius), cutters=[cutter], spacing=0.5 * radius, **HOW)
    (number,) = [info.number for info in result.part.faces if info.shape == "cone"]
    entries = [each for each in gouged(result) if each.points is not None]
    assert [each.points.faces for each in entries] == [[f"F{number}"]] * len(entries)
    assert entries
    text = f"{result.plan.text.lines} {result.summary()} {[each.needs for each in result.plan.process.left]}"
    assert "radius of" not in text
    assert " 0 mm" not in text
    if any(each.points.share >= 0.5 for each in entries):
        assert "no end fits a cone's point" in text
    assert all(each.radius_mm > 0.1 and each.face != f"F{number}" for each in result.plan.inside_radii)


def test_an_outside_cone_has_no_such_point():
    result = plan(Part(cone(8.0, 0.0, 10.0)), cutters=["D6L30"], spacing=2.0, **HOW)
    assert all(each.points is None for each in result.plan.process.left)


@pytest.fixture(scope="module")
def mended():
    return plan(holes(), cutters=["D10L30", "D4L30"], spacing=2.0, answers="mend", **HOW)


def test_next_and_left_tell_of_the_same_step(mended):
    """What a step leaves beside the process is what a plan finds that has its cutter, too."""
    process = mended.plan.process
    step = process.next[0]
    assert step.argv[0] == "--cutter"
    (left,) = [each for each in process.left if each.helped and each.helped[0].share > 0.5]
    assert "finishes" in left.needs
    assert step.words.split(" held")[0] in left.needs
    found = plan(holes(), cutters=["D10L30", "D4L30", step.argv[1]], spacing=2.0, **HOW).plan.process
    assert 1.0 - found.finished_share == pytest.approx(step.left_share, abs=0.002)
    assert 1.0 - process.finished_share - step.left_share >= 0.001


@pytest.mark.parametrize("gain", [0.003, 0.008])
def test_a_further_setup_is_advised_where_it_is_worth_its_clamping(mended, gain):
    """As proposals leave out what serves less than 0.5 % of the area alone."""
    found = mended.plan
    shown = next(each for each in found.cutters if each.id == found.shown)
    step, lost = shown.mend.steps[0], 1.0 - found.process.finished_share - gain
    step = step.model_copy(update={"changes": [step.changes[0].model_copy(update={"thing": "second_setup"})], "lost_after": lost})
    mend = shown.mend.model_copy(update={"steps": [step]})
    cutters = [shown.model_copy(update={"mend": mend}) if each.id == shown.id else each for each in found.cutters]
    left = [each.model_copy(update={"helped": []}) for each in found.process.left]
    process = found.process.model_copy(update={"left": left})
    again = with_process_words(found.model_copy(update={"cutters": cutters, "process": process}))
    assert (step.why in [each.words for each in again.process.next]) == (gain > 0.005)


def test_what_an_answer_refuted_is_not_proposed(mended):
    shown = next(each for each in mended.plan.cutters if each.mend is not None)
    mend = shown.mend
    left = [step for step in mend.steps if step.changes[0].thing == "area"]
    none = mend.model_copy(update={"steps": left})
    assert first_tries("shank", None) == "a thinner shank, or a longer stick-out"
    assert first_tries("shank", none) == "a thinner shank"
    assert first_tries("holder", none) == first_tries("local_gouge", none) == ""
    # What was not looked for is not refuted.
    assert first_tries("shank", mend.model_copy(update={"steps": []})) == first_tries("shank", None)


def test_a_step_that_is_not_sure_is_not_told_as_such(mended):
    shown = next(each for each in mended.plan.cutters if each.id == mended.plan.shown)
    unsure = shown.model_copy(update={"mend": shown.mend.model_copy(update={"unsure": True})})
    cutters = [unsure if each.id == shown.id else each for each in mended.plan.cutters]
    needs = [each.needs for each in with_process_words(mended.plan.model_copy(update={"cutters": cutters})).process.left]
    assert any("may finish" in each for each in needs)
    assert not any("finishes" in each for each in needs)


def test_what_is_hardly_left_comes_after_the_next_step(plate):
    process = plate.plan.process
    (large, *_) = process.left
    small = [large.model_copy(update={"share": 0.001, "area_mm2": 1.0, "cause": each}) for each in ("shank", "holder", "neck")]
    lines = text_of(
        with_process_words(plate.plan.model_copy(update={"process": process.model_copy(update={"left": [large, *small]})}))
    ).lines
    starts = [line.split(",")[0].split(":")[0] for line in lines if line.startswith(("Left", "Next"))]
    assert starts[:2] == ["Left", "Next"]
    assert len([each for each in starts if each == "Left"]) > 1


def test_points_and_no_size_in_words(plate):
    process = plate.plan.process

    def told(**update):
        entry = gouged(plate)[0].model_copy(update=update)
        made = plate.plan.model_copy(update={"process": process.model_copy(update={"left": [entry]})})
        return with_process_words(made).process.left[0].needs

    fits, point = gouged(plate)[0].fits, PointsEntry(faces=["F7", "F8", "F9"], share=0.9)
    nothing = [fits[0].model_copy(update={"share": 0.004})]
    assert told(fits=nothing) == "no usual size fits: an undercut cutter or another direction may"
    assert told(fits=nothing, points=point) == "no end fits a cone's point (F7, F8 and 1 more): left for a drill or by hand"
    assert told(fits=[]) == "no usual size fits: an undercut cutter or another direction may"
    assert told(fits=None) == "a smaller radius or corner radius"
    assert told(fits=fits[:1], points=point.model_copy(update={"share": 0.01})).startswith("flat end D6 fits 6")
    # A file may say a step that its answer does not have.
    assert told(helped=[HelpEntry(step=99, share=1.0)]) == told()
    assert process_story(plate.plan, {each.id: each.id for each in plate.plan.cutters}).much == len(process.left)
