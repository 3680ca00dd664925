"""What the workbench and the macro say of a plan, without FreeCAD: they read words and choices of the plan, and make none up."""

import importlib
import json
import sys
from types import ModuleType, SimpleNamespace

import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from plan_cutters.plan_file.numbers import percent
from plan_cutters.plan_file.reasons import REASONS
from tests.support.places import ROOT
from tests.support.plan_files import cutter, face, made, verdicts

#: What the modules of the workbench that are read here import of FreeCAD.
HOST = ("FreeCAD", "Part", "Import", "FreeCADGui", "MeshPart", "Mesh")


@pytest.fixture(scope="module")
def results():
    """The module that reads a plan, under modules of FreeCAD that have nothing."""
    with pytest.MonkeyPatch.context() as patch:
        for name in HOST:
            patch.setitem(sys.modules, name, ModuleType(name))
        before = {*sys.modules}
        yield importlib.import_module("freecad.plan_cutters.results")
        for name in {*sys.modules} - before:
            del sys.modules[name]


@pytest.fixture(scope="module")
def macro():
    """The functions of the macro that a plan is told with."""
    with pytest.MonkeyPatch.context() as patch:
        for name in HOST:
            patch.setitem(sys.modules, name, ModuleType(name))
        text = (ROOT / "freecad" / "PlanCutters.FCMacro").read_text(encoding="utf-8")
        found = {"__name__": "macro"}
        exec(compile(text, "PlanCutters.FCMacro", "exec"), found)
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
    document = made([face(1)], [few, many], shown=shown, reason_words=words)
    return json.loads(document.model_dump_json())


def result(results, plan):
    return results.Result(plan, SimpleNamespace(document="D", body="B"), {})


def test_the_cutter_shown_is_that_of_the_plan(results, macro):
    assert result(results, planned()).shown()["id"] == "B"
    assert macro.shown(planned())["id"] == "B"
    # A document that was saved with an older program does not say it.
    older = planned()
    del older["shown"], older["reason_words"]
    assert result(results, older).shown()["id"] == "B"
    assert result(results, older).reason("rear_gouge") == "rear gouge"


def test_reasons_have_the_words_of_the_plan(results, macro):
    found = result(results, planned())
    assert [found.reason(code) for code in REASONS] == [each.name for each in REASONS.values()]
    head, few, many, *_ = found.summary()
    assert head.endswith("the colours show B")
    assert few.endswith("reaches 995 of 1000 samples; lost: rear gouge 50 % of the area")
    assert many.endswith("; lost: inside material <0.1 %, flute collision <0.1 % of the area")
    said = [*macro.summary(planned())]
    assert said[2].endswith("; lost to inside material, flute collision")


def test_a_spot_and_a_sample_have_the_words_of_the_plan(results):
    plan = planned()
    plan["cutters"][1]["witnesses"] = [
        {"face": "F1", "reason": "buried", "obstacle_face": None, "best_posture": None, "depth_mm": None,
         "verdict": "undecided", "point": [0, 0, 0]}
    ]  # fmt: skip
    plan["legend_words"] = {"interference_free": "interference-free"}
    found = result(results, plan)
    (spot,) = found.spots()
    assert spot.text == "F1 inside material (undecided)"
    sample = SimpleNamespace(
        face="F1", away_mm=0.25, verdict="interference_free", reason="", angles=({"A": 10.0}, {"A": -10.0})
    )
    assert found.sentence(sample) == "F1, 0.25 mm from the click: interference-free; A 10°, or A -10°"
    sample.verdict, sample.reason, sample.angles = "inaccessible", "collision", ()
    assert found.sentence(sample) == "F1, 0.25 mm from the click: inaccessible for flute collision"


@given(st.floats(0, 1))
@example(0.9996)
@example(0.99949)
@example(0.0004)
def test_a_share_is_written_as_the_program_writes_it(results, share):
    assert results.percent(share) == percent(share)
