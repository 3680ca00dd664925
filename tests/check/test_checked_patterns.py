"""The checker expands patterns, and refuses those that are forged."""

import json
from functools import cache

import numpy as np
import pytest

from cad_io import Part, read_part
from cad_io.part.bodies import orient
from cad_io.part.patterns import patterns
from plan_cutters.document.features import pattern_entries
from plan_cutters_check.patterns import Patterns
from plan_cutters_check.question import Question
from plan_cutters_check.reckoned import evenly
from tests.support.patterns import impeller, plate

PARTS = {"impeller": lambda: impeller(6), "plate": lambda: plate(3, 1)}


@cache
def part(name: str) -> Part:
    return read_part(PARTS[name]())


@cache
def _entries(name: str) -> str:
    found = patterns(part(name))
    counts = np.zeros((sum(len(each.motions) for each in found if each.whole), 3), np.int64)
    return json.dumps([json.loads(each.model_dump_json()) for each in pattern_entries(found, counts)])


def entries(name: str) -> list[dict]:
    return json.loads(_entries(name))


def wrong(name: str, stated: list[dict], plans=(), process=None, effective=None) -> list[str]:
    """What the checker says is wrong."""
    document = {
        "patterns": stated, "effective": effective or {}, "operations": {"plans": list(plans)}, "process": process,
    }  # fmt: skip
    of = part(name)
    question = Question(of, None, {}, (), frozenset(), orient(of).sign, 0.01, document, {}, {})
    return [each.words for each in Patterns(question).findings() if each.holds is False]


@pytest.mark.slow("another part of the same law", only=("plate",))
@pytest.mark.parametrize("name", PARTS)
def test_what_is_found_holds(name):
    stated = entries(name)
    assert stated
    assert wrong(name, stated) == []
    if name == "plate":
        assert {each["kind"] for each in stated} == {"rotation", "mirror", "shift"}


def another(face: str) -> str:
    return "F1" if face != "F1" else "F2"


FORGED = {
    "order": lambda each: each.update(order=each["order"] + 1),
    "copy": lambda each: each["faces"][-1].__setitem__(0, another(each["faces"][-1][0])),
    "exchanged": lambda each: each["faces"].__setitem__(slice(0, 2), each["faces"][1::-1]),
    "unknown": lambda each: each["faces"][0].__setitem__(0, "F9999"),
    "ring": lambda each: each.update(faces=[copy_[1:] for copy_ in each["faces"]]),
    "place": lambda each: each.update(place_mm=[x + 0.01 for x in each["place_mm"]]),
    "round": lambda each: each.update(direction=[-x for x in each["direction"]]),
    "long": lambda each: each.update(direction=[2 * x for x in each["direction"]]),
    "axis": lambda each: each.update(place_mm=None),
}


@pytest.mark.slow("checks whole plans", but=("order",))
@pytest.mark.parametrize("forgery", FORGED)
def test_a_forged_rotation_is_refused(forgery):
    stated = entries("impeller")
    FORGED[forgery](stated[0])
    assert wrong("impeller", stated)


@pytest.mark.slow("checks whole plans")
@pytest.mark.parametrize("kind", ["mirror", "shift"])
def test_a_forged_mirror_or_shift_is_refused(kind):
    stated = entries("plate")
    mine = [each for each in stated if each["kind"] == kind]
    for each in mine:
        if kind == "shift":
            each["shifts_mm"][0] = [x + 0.01 for x in each["shifts_mm"][0]]
        else:
            each["place_mm"] = [x + 0.01 for x in each["place_mm"]]
    assert len(wrong("plate", stated)) == len(mine) > 0


def test_some_faces_are_no_pattern_of_the_whole_part():
    stated = entries("plate")
    shift = next(each for each in stated if each["kind"] == "shift")
    shift["whole"] = True
    assert wrong("plate", [shift])


def test_patterns_of_a_plan_without_them_are_refused():
    assert wrong("impeller", entries("impeller"), effective={"patterns": False})


def test_a_part_that_is_nearly_a_pattern_is_none():
    off = read_part(impeller(6, off=0.02))
    document = {"patterns": entries("impeller"), "effective": {}, "operations": {"plans": []}}
    question = Question(off, None, {}, (), frozenset(), orient(off).sign, 0.01, document, {}, {})
    assert [each for each in Patterns(question).findings() if each.holds is False]


def _operation(k: int, **changes) -> dict:
    angles = {"A": 60.0, "C": -100.0 + 60.0 * k}
    known = {"id": f"op{k}", "orbit": 0, "cutter": "a", "setup": 0, "mode": "fixed", "angles_deg": angles}
    return {**known, "area_mm2": 10.0 + k, "seconds": 5.0, **changes}


def repeated(*operations: dict) -> list[str]:
    return wrong("impeller", [], [{"name": "fastest", "operations": list(operations)}])


def test_images_of_each_other_have_one_cutter_setup_and_mode():
    three = [_operation(k) for k in range(3)]
    assert repeated(*three) == []
    for forged in ({"cutter": "b"}, {"setup": 1}, {"mode": "simultaneous"}):
        assert repeated(*three[:2], _operation(2, **forged)), forged


def test_a_step_that_is_repeated_turns_evenly():
    three = [_operation(k)["angles_deg"] for k in range(3)]
    assert evenly({"C": 60.0}, three) == {"C": 60.0}
    for by in ({"C": 45.0}, {"C": -60.0}, {"C": 30.0}, {"A": 60.0}, {"B": 60.0}, {"A": 0.0, "C": 60.0}, {}):
        assert evenly(by, three) != by or by == {"C": 30.0}, by
    for angles in ({"A": 60.0, "C": 21.0}, {"A": 61.0, "C": 20.0}, {"A": 60.0, "C": -100.0}):
        assert evenly({"C": 60.0}, [*three[:2], angles]) != {"C": 60.0}, angles
