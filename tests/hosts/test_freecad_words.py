"""What the workbench and the macro of operations say of a plan, without FreeCAD: they show its text, and make none up."""

import json
import sys
from types import ModuleType, SimpleNamespace

import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from plan_cutters.plan_file.reasons import REASONS
from plan_cutters.plan_file.words.text import story_of, text_of, with_text
from tests.support.places import ROOT
from tests.support.plan_files import SAMPLES, cutter, face, made, verdicts
from tests.support.workbench import HOST, imported


@pytest.fixture(scope="module")
def results():
    """The module that reads a plan."""
    with imported("freecad.plan_cutters.results") as module:
        yield module


@pytest.fixture(scope="module")
def macro():
    """The functions of the macro of operations."""
    with pytest.MonkeyPatch.context() as patch:
        for name in HOST:
            patch.setitem(sys.modules, name, ModuleType(name))
        text = (ROOT / "freecad" / "PlanOperations.FCMacro").read_text(encoding="utf-8")
        found = {"__name__": "macro"}
        exec(compile(text, "PlanOperations.FCMacro", "exec"), found)
        yield SimpleNamespace(**{name: each for name, each in found.items() if callable(each)})


def planned(shown="B"):
    """A plan in which A leaves fewer samples, and B less area."""
    few = cutter("A", {"F1": verdicts(5, reason="rear_gouge")})
    many = cutter("B", {"F1": verdicts(400)})
    small = many.area_share.model_copy(
        update={"accessible": 0.9996, "inaccessible": 0.0004, "lost_by": {"collision": 0.0001, "buried": 0.0003}}
    )
    large = few.area_share.model_copy(update={"accessible": 0.5, "inaccessible": 0.5, "lost_by": {"rear_gouge": 0.5}})
    many, few = (each.model_copy(update={"area_share": share}) for each, share in ((many, small), (few, large)))
    words = {code: each.name for code, each in REASONS.items()}
    return with_text(made([face(1)], [few, many], shown=shown, reason_words=words))


def written(plan):
    """A plan as FreeCAD reads it."""
    return json.loads(plan.model_dump_json())


def result(results, plan):
    return results.Result(plan, SimpleNamespace(document="D", body="B"), {})


def older():
    """A plan as a document has it that was saved with an older program."""
    plan = written(planned())
    del plan["shown"], plan["reason_words"], plan["text"]
    return plan


#: Samples of two faces that a cutter leaves: inaccessible, then undecided.
LEFT = st.tuples(st.integers(0, SAMPLES // 2), st.integers(0, SAMPLES // 2))


@given(st.lists(st.tuples(LEFT, LEFT), min_size=1, max_size=3), st.sampled_from(sorted(REASONS)), st.booleans())
@example([((0, 0), (0, 0))], "holder", False)
@example([((0, 0), (0, 0))], "holder", True)
@example([((0, 1), (0, 0)), ((1, 0), (1000 // 2, 1000 // 2))], "neck", False)
def test_headline_lines_and_cutters_are_those_of_the_plan(results, many, reason, unjudged):
    faces = [face(1), face(2)]
    if unjudged:
        faces.append(face(3).model_copy(update={"samples": 0, "unjudged": "it is too thin"}))
    entries = [
        cutter(f"R{6 - n}L80", {f"F{k}": verdicts(*each, reason=reason) for k, each in enumerate(left, 1)}, radius=6.0 - n)
        for n, left in enumerate(many)
    ]  # fmt: skip
    plan = with_text(made(faces, entries))
    text, story = plan.text, story_of(plan)
    found = result(results, written(plan))
    assert found.headline() == text.headline
    assert found.summary() == [text.headline, *text.lines]
    for each in entries:
        said = found.cutter_text(each.id)
        assert said.sentence == text.cutters[each.id] == story.cutter(each.id).sentence
        assert said.shares == story.cutter(each.id).shares
        # Good is only what is feasible beyond doubt, of all that was to be judged.
        assert (said.tone == "good") == (each.feasible is True and not unjudged)
        assert (said.tone == "bad") == (each.feasible is False)
        assert said.verdict


def test_a_cutter_is_not_feasible_without_more_words_where_not_all_was_seen(results):
    unseen = cutter("A", {"F1": verdicts()}).model_copy(update={"seen": False})
    plan = made([face(1)], [unseen, cutter("B", {"F1": verdicts()})], effective={"sampled_by": "default"})
    found = result(results, written(with_text(plan)))
    assert found.cutter_text("A")[:2] == ("unsure", "Feasible where judged")
    assert found.cutter_text("B")[:2] == ("good", "Feasible")


def test_a_share_is_all_or_nothing_only_where_it_is(results):
    found = result(results, written(planned()))
    few, many = (found.cutter_text(each).shares for each in "AB")
    assert (few["accessible"], few["inaccessible"], few["undecided"]) == ("50 %", "50 %", "0 %")
    assert (many["accessible"], many["inaccessible"]) == (">99.9 %", "<0.1 %")


def test_an_older_plan_says_to_plan_again(results):
    found = result(results, older())
    line = "An older program made this plan, without text (no cutter is selected; the colours show B): plan again."
    assert found.shown()["id"] == "B"
    assert found.headline() == line
    assert found.summary() == [line]
    assert found.cutter_text("A") == ("bad", "", "", {})
    assert found.reason("rear_gouge") == "rear gouge"
    plan = older()
    plan["selected"] = "A"
    assert "(take A; the colours show A)" in result(results, plan).headline()


def test_the_cutter_shown_is_that_of_the_plan(results):
    assert result(results, written(planned())).shown()["id"] == "B"


def test_reasons_have_the_words_of_the_plan(results):
    found = result(results, written(planned()))
    assert [found.reason(code) for code in REASONS] == [each.name for each in REASONS.values()]


def test_a_spot_and_a_sample_have_the_words_of_the_plan(results):
    plan = written(planned())
    plan["cutters"][1]["witnesses"] = [
        {"face": "F1", "reason": "buried", "obstacle_face": None, "best_posture": None, "depth_mm": None,
         "verdict": "undecided", "point": [0, 0, 0]}
    ]  # fmt: skip
    plan["legend_words"] = {"interference_free": "interference-free"}
    found = result(results, plan)
    (spot,) = found.spots()
    assert spot.text == "F1 inside material (undecided)"
    sample = SimpleNamespace(face="F1", away_mm=0.25, verdict="interference_free", reason="", angles=({"A": 10.0}, {"A": -10.0}))
    assert found.sentence(sample) == "F1, 0.25 mm from the click: interference-free; A 10°, or A -10°"
    sample.verdict, sample.reason, sample.angles = "inaccessible", "collision", ()
    assert found.sentence(sample) == "F1, 0.25 mm from the click: inaccessible for flute collision"


def test_the_macro_of_operations_says_what_the_plan_says_and_what_it_does_not_show(macro):
    operations = [
        {"id": "op1", "mode": "fixed", "frame": {}, "faces": [{"face": "F1"}, {"face": "F2"}]},
        {"id": "op2", "mode": "simultaneous", "frame": None, "faces": [{"face": "F3"}]},
    ]
    plan, names = {"name": "fewest", "operations": operations}, [(1, "op1"), None, (3, "op2")]
    text = text_of(planned())
    own = [
        "not shown apart, the models name them for what is around: F2 of op1; NotShown of each group has all",
        "op2 has no work plane",
        "the fewest plan of part.step: 1 work planes, 2 operations",
    ]
    assert [*macro.summary(written(planned()), plan, names)] == [text.headline, *text.lines, *own]
    old = "an older program made this plan, without text: plan again"
    assert [*macro.summary(older(), plan, names)] == [old, *own]
