"""A plan is of the part that was meant: nothing counts twice, and a surface that is none is doubted before the process."""

import json
import math

import pytest
from OCP.BRepBuilderAPI import BRepBuilderAPI_Copy
from OCP.TopAbs import TopAbs_FACE

from cad_io.kernel import explore
from plan_cutters import plan
from plan_cutters.errors import UnjudgeableError
from plan_cutters.plan_file.words.names import as_fields
from plan_cutters.plan_file.words.text import text_of
from plan_cutters.report.models import shown_pieces, split_result
from plan_cutters.report.page.write import page
from tests.support.cad_parts import ball, box, compound, cut, drilled, rod
from tests.support.places import real_file
from tests.support.turned import elbow, from_step, revolved_arc

FEW = {"cutters": "D6L60", "faces": "all", "grid": 5, "area_budget": 0}
FAR = (20, 0, 0)


def copied(shape):
    return BRepBuilderAPI_Copy(shape).Shape()


def planned(shape, **options):
    return plan(shape, **FEW | options).plan


@pytest.fixture(scope="module")
def once_and_twice():
    more = {"machine": "trunnion-ac", "operations": "fewest", "feed": 1000, "cutters": ["D6L60"], "grid": 3}
    return tuple(plan(shape, **FEW | more) for shape in (drilled(), compound(drilled(), copied(drilled()))))


def test_what_is_there_twice_counts_once(once_and_twice):
    one, two = (each.plan for each in once_and_twice)
    assert (two.part.solids, len(two.faces)) == (2, 14)
    assert two.scope == one.scope
    for name in ("asked_mm2", "finished_mm2", "seconds"):
        assert getattr(two.process, name) == pytest.approx(getattr(one.process, name), rel=1e-9)
    assert [(step.faces, step.area_mm2) for step in two.process.steps] == [
        (step.faces, pytest.approx(step.area_mm2)) for step in one.process.steps
    ]
    assert [(each.kind, each.order, each.faces) for each in two.patterns] == [
        (each.kind, each.order, each.faces) for each in one.patterns
    ]
    assert two.samples == one.samples


def test_it_is_named_before_the_process_and_at_each_face(once_and_twice):
    one, two = (each.plan for each in once_and_twice)
    (line,) = [each for each in two.process.doubts if each not in one.process.doubts]
    assert line == (
        "Body 2 (F8-14) is body 1 (F1-7) again, in the same place, and is left out; to leave out the other one: `--ignore F1-7`."
    )
    assert line[:60] in " ".join(text_of(two).lines)
    assert as_fields(line) in page(once_and_twice[1]).decode()
    for face in two.faces[7:]:
        assert (face.target, face.ignored, face.samples) == (False, True, 0)
        assert face.unjudged == f"is F{int(face.id[1:]) - 7} again"


def test_ignore_says_which_one_stays_and_faces_of_either_are_meant():
    twice = compound(drilled(), copied(drilled()))
    other = planned(twice, ignore="F1-7")
    assert other.effective.target_faces == [f"F{n}" for n in range(8, 15)]
    assert "repeated_body" not in other.note_codes
    assert other.part.orientation.confident
    assert planned(twice, faces="F9").effective.target_faces == ["F2"]
    assert planned(twice, faces="F9", ignore="F1-7").effective.target_faces == ["F9"]


def test_a_loose_face_twice_counts_once():
    face = next(explore(box(), TopAbs_FACE))
    one, two = planned(face), planned(compound(face, copied(face)))
    assert two.scope == one.scope
    assert two.process.doubts[0] == "F2 is F1 again, in the same place, and left out; to leave out the other one: `--ignore F1`."


def test_bodies_that_overlap_are_judged_both():
    both = planned(compound(box(), box(10, 10, 20)))
    assert both.scope.judged == 12
    assert both.process.doubts == []


def test_a_shape_is_compared_with_its_step():
    (line,) = planned(elbow()).process.doubts
    assert line.startswith("Written as STEP and read again, F3 comes back with 236 mm² for 78.5 mm²")
    assert planned(elbow(), ignore="F3").process.doubts == []


def test_a_face_that_crosses_itself_is_doubted_and_not_judged(tmp_path):
    whole = compound(box(10, 10, 10, FAR), revolved_arc(2.0))
    (line,) = [each for each in planned(whole).process.doubts if "comes back" in each]
    assert "comes back with 741 mm² for 76.5 mm²" in line
    back = from_step(whole, tmp_path)
    document = planned(back)
    (line, *_) = document.process.doubts
    assert line.startswith("F7 crosses itself (its curve of revolution crosses its axis), with 745 mm²")
    assert line.endswith("`--ignore F7`.")
    assert (document.faces[6].samples, document.faces[6].area_mm2) == (0, 0.0)
    # Where it is, nothing is known: nothing is safe beyond doubt.
    assert document.cutters[0].feasible is not True
    assert [each.face for each in document.missing] == ["F7"]
    assert planned(back, ignore="F7").process.doubts == []


def test_alone_it_is_refused_in_one_line(tmp_path):
    with pytest.raises(
        UnjudgeableError, match=r"F1 crosses itself \(its curve of revolution crosses its axis\).*Python or as BREP"
    ):
        planned(from_step(revolved_arc(2.0), tmp_path))


def test_the_rest_of_an_elbow_is_doubted(tmp_path):
    (line,) = [each for each in planned(from_step(elbow(), tmp_path)).process.doubts if "F3" in each]
    assert line.startswith("F3 folds back onto F1, with 236 mm²")


def test_a_closed_void_is_called_so():
    result = plan(cut(box(40, 40, 40), ball(8, (20, 20, 20))), **FEW)
    document = result.plan
    (shut,) = document.part.void_faces
    (left,) = [each for each in document.process.left if each.cause == "buried"]
    assert (left.faces, left.needs) == ([shut], "closed void: no cutter gets in")
    assert "--ignore" not in " ".join(text_of(document).lines)
    html = page(result).decode()
    assert "closed void: no cutter gets in" in html
    assert "if that body is not there" not in html[: html.index("<script")]
    assert document.process.next == []


def test_a_void_with_a_mouth_and_a_body_on_the_part_are_none():
    mouth = cut(cut(box(40, 40, 40), ball(8, (20, 20, 20))), rod(4, 40, (20, 20, 20)))
    assert planned(mouth).part.void_faces == []
    stands = planned(compound(box(40, 40, 10), box(20, 20, 10, (10, 10, 10))))
    assert stands.part.void_faces == []


def numbers(value, where=""):
    """Every number in a plan with its path."""
    if isinstance(value, dict):
        for key, each in value.items():
            yield from numbers(each, f"{where}.{key}")
    elif isinstance(value, list):
        for each in value:
            yield from numbers(each, where)
    elif isinstance(value, float | int) and not isinstance(value, bool):
        yield where, value


@pytest.mark.slow("plans parts whole")
def test_no_area_or_share_of_a_broken_screw_is_negative_and_samples_are_bounded_by_area():
    document = planned(real_file("trials/ocp198_screw.step"), grid=None, spacing=0.7, faces="all")
    assert document.samples.count < 2000
    assert sum(face.area_mm2 for face in document.faces) < 500
    for where, number in numbers(json.loads(document.model_dump_json())):
        assert math.isfinite(number), where
        if where.endswith(("_mm2", "share")) or "share." in where:
            assert number >= 0.0, where


def test_models_show_one_of_two_faces_in_a_place_and_step_keeps_both(once_and_twice):
    result = once_and_twice[1]
    split = split_result(result)
    assert {piece.face for piece in split.pieces} == set(range(1, 15))
    assert {piece.face for piece in shown_pieces(result, split).pieces} == set(range(1, 8))
    assert shown_pieces(once_and_twice[0], split) is split
