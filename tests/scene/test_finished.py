"""What lies inside another body is no surface of the finished part: it is told apart, and all else is about the rest."""

import shlex

import cadquery as cq
import numpy as np
import pytest
from OCP.BRepAlgoAPI import BRepAlgoAPI_Fuse

from cad_io import read_part
from plan_cutters import plan
from plan_cutters.command.codes import code_of
from plan_cutters.command.summary import summary
from plan_cutters.errors import UnjudgeableError
from plan_cutters.plan_file.reasons import LABELS
from plan_cutters.plan_file.words.headline import inside
from plan_cutters.report.models import split_result
from plan_cutters.report.page.write import page
from tests.support import shapes
from tests.support.cad_parts import box, compound, cut, rod

HOW = {"cutters": ["R2L60"], "faces": "all", "area_budget": 0, "jobs": 2}


def stacked():
    return compound(box(40, 40, 20), box(20, 20, 60, at=(10, 10, 20)))


def crossed():
    """A block and a blade that runs into it."""
    return box(40, 40, 20), box(6, 30, 30, at=(17, 5, 10))


def test_overlapping_bodies_are_judged_as_if_they_were_one():
    """Fused, the same surface is left: as much of it is reached, and what is told to lie inside is what is gone."""
    hub, blade = crossed()
    apart = plan(compound(hub, blade), spacing=0.75, **HOW)
    fused = plan(BRepAlgoAPI_Fuse(hub, blade).Shape(), spacing=0.75, **HOW)
    found, whole = apart.plan.inside_other_bodies, sum(face.area_mm2 for face in apart.plan.faces)
    left = sum(face.area_mm2 for face in fused.plan.faces)
    assert found.area_mm2 == pytest.approx(whole - left, rel=0.06)
    assert found.share == pytest.approx(found.area_mm2 / whole)
    assert sum(body.samples for body in found.bodies) == found.samples == apart.plan.samples.inside_bodies
    assert sum(body.area_mm2 for body in found.bodies) == pytest.approx(found.area_mm2)
    assert {body.how for body in found.bodies} == {"overlaps"}
    (one,), (other,) = apart.cutters, fused.cutters
    for word in ("interference_free", "accessible", "inaccessible"):
        assert getattr(one.area_share, word) == pytest.approx(getattr(other.area_share, word), abs=0.02)
    assert (one.feasible, code_of(apart.plan), apart.selected) == (other.feasible, code_of(fused.plan), fused.selected)
    # Counts stay those of all samples.
    assert one.by_reason["buried"] == one.inside_bodies == found.samples
    together = one.interference_free + one.accessible + one.inaccessible + one.undecided + one.unjudged
    assert together == apart.plan.samples.count
    assert sum(face.inside_bodies for face in one.faces.values()) == one.inside_bodies
    kept = apart.plan.samples
    assert (kept.finished, kept.judged) == (kept.count - one.inside_bodies, kept.count - one.inside_bodies)


def test_a_clamp_is_told_by_name_and_its_advice_works(tmp_path):
    """Nothing under it is judged until it is left out as advised: then all of it is."""
    model = cq.Assembly()
    model.add(cq.Workplane(obj=cq.Shape.cast(box(40, 40, 20))), name="plate")
    model.add(cq.Workplane(obj=cq.Shape.cast(box(20, 20, 60, at=(10, 10, 20)))), name="my clamp")
    model.export(str(tmp_path / "held.step"))
    result = plan(tmp_path / "held.step", grid=9, **HOW)
    bodies = result.plan.inside_other_bodies.bodies
    (clamp,) = [body for body in bodies if not body.largest]
    assert (clamp.name, clamp.option) == ("my clamp", "--ignore 'component:my clamp'")
    assert (clamp.how, clamp.samples, clamp.own_faces) == ("stands_on", 9, ["F7-12"])
    (line,) = [line for line in inside(result.plan) if clamp.option in line]
    assert "stands on F6" in line
    option, word = shlex.split(clamp.option)
    assert option == "--ignore"
    bare = plan(tmp_path / "held.step", grid=9, ignore=word, **HOW)
    assert bare.plan.inside_other_bodies.samples == 0
    assert "inside_bodies" not in bare.plan.legend
    top = bare.samples.face == 6
    assert top.sum() == 81
    assert bare.reaches["R2L60"].reached[top].all()


def test_numbers_leave_a_body_without_a_name_out():
    part = read_part(stacked())
    (clamp,) = [body for body in plan(part, grid=9, **HOW).plan.inside_other_bodies.bodies if not body.largest]
    assert clamp.option == "--ignore F7-12"
    assert not plan(part, grid=9, ignore=clamp.option.split()[1], **HOW).plan.inside_other_bodies.samples


def test_a_sheet_on_a_body_is_told_as_what_it_is():
    """It lies on the bottom, and faces up, into the body."""
    part = read_part(compound(box(40, 40, 20), shapes.plane((5, 30), (5, 30), origin=(0, 0, 0))))
    result = plan(part, grid=9, **HOW)
    found = result.plan.inside_other_bodies
    assert (found.sheets.faces, found.sheets.samples, found.bodies) == (["F7"], 81, [])
    assert found.sheets.area_mm2 == pytest.approx(625.0)
    assert any("construction sheet" in line for line in inside(result.plan))
    assert not plan(part, grid=9, ignore=found.sheets.option.split()[1], **HOW).plan.inside_other_bodies.samples


def test_a_part_inside_a_part_has_nothing_to_judge():
    part = compound(box(40, 40, 20), box(30, 30, 10, at=(5, 5, 5)))
    with pytest.raises(UnjudgeableError, match="inside another body") as error:
        plan(part, grid=5, **HOW | {"faces": "7-12"})
    assert "\n" not in str(error.value)
    result = plan(part, grid=5, **HOW)
    assert result.selected == "R2L60"
    assert result.plan.inside_other_bodies.bodies[0].how == "overlaps"
    assert result.cutters[0].faces["F7"].inside_share == 1.0


def test_the_wall_of_a_void_is_surface_that_no_cutter_reaches():
    """It is no other body that lies there, though a body within the void is surrounded as well."""
    hollow = cut(box(100, 100, 100), box(80, 80, 80, at=(10, 10, 10)))
    for shape, not_reached in ((hollow, 6 * 25), (compound(hollow, box(20, 20, 20, at=(40, 40, 40))), 12 * 25)):
        result = plan(shape, grid=5, **HOW)
        assert result.plan.inside_other_bodies.samples == 0
        assert (result.selected, result.cutters[0].not_reached) == (None, not_reached)
    # A block that fills a part of the void covers what it lies against.
    filled = plan(compound(hollow, box(80, 80, 40, at=(10, 10, 10))), grid=5, **HOW)
    assert 0 < filled.plan.inside_other_bodies.samples < filled.cutters[0].by_reason["buried"]
    assert filled.selected is None


def test_what_lies_in_a_fixture_is_not_reached():
    result = plan(box(40, 40, 20), grid=9, fixtures=["box:20,20,60@10,10,20"], **HOW)
    entry = result.cutters[0]
    assert entry.by_reason["fixture"] > 0
    assert (result.plan.inside_other_bodies.samples, result.selected) == (0, None)


def test_it_is_said_first_and_has_a_colour_of_its_own(capsys, tmp_path):
    result = plan(stacked(), grid=9, **HOW)
    summary(result.plan)
    said = " ".join("".join(capsys.readouterr()).split())
    assert said.startswith(
        "Take flat end D4 x 60: it finishes all 11,400 mm². Inside other bodies: 5.2 % of the target area (90 of 972 samples)"
    )
    assert said.index("--ignore F7-12") < said.index(" 1 flat end D4 x 60")
    html = page(result).decode()
    assert html.index("5.2 % of the target area") < html.index('<section id="viewer"')
    assert "inside_bodies" in result.plan.legend
    labels = {piece.face: LABELS[piece.label] for piece in split_result(result).pieces if piece.face == 11}
    assert labels == {11: "inside_bodies"}
    result.write(tmp_path, ["npz"])
    with np.load(tmp_path / "samples.npz") as arrays:
        assert (arrays["inside_bodies"] == result.inside_bodies).all()
        assert not arrays["verdict_R2L60"][arrays["inside_bodies"]].any()


def test_what_is_covered_is_not_in_the_area_between_the_samples():
    """All that no other body lies near is proved: without the contact area, of which nothing can be."""
    part, how = read_part(compound(box(40, 40, 20), rod(8, 30, (20, 20, 20)))), HOW | {"area_budget": 2000}
    result = plan(part, grid=21, **how | {"faces": "6"})
    assert result.selected == "R2L60"
    covered = np.pi * 8**2 / 1600
    assert result.cutters[0].area.share > 1.0 - covered
    assert result.cutters[0].area.feasible is False


def test_a_face_is_told_without_what_is_covered():
    result = plan(stacked(), grid=9, **HOW)
    top, bottom = result.face(6), result.face(11)
    assert (top.reached, top.reasons, top.verdicts.inside_bodies) == (1.0, {}, 9)
    assert (bottom.reached, bottom.samples, bottom.verdicts.inside_bodies) == (None, 81, 81)
