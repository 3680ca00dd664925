"""Equal faces are told once, in numbers as all others are written."""

from plan_cutters import plan
from plan_cutters.plan_file.part_info import PatternEntry
from plan_cutters.plan_file.words.headline import patterns
from tests.support.cad_parts import box


def test_two_mirrors_of_the_same_faces_are_one_sentence():
    found = plan(box(20, 20, 20), cutters=["D6L60"], faces="F6", grid=4, area_budget=0).plan
    mirror = {"kind": "mirror", "order": 2, "whole": False, "place_mm": (0, 0, 0), "faces": [["F1"], ["F2"]]}
    each = [PatternEntry(**mirror, direction=direction, moved=9, verified=2666) for direction in ((1, 0, 0), (0, 1, 0))]
    assert [*patterns(found.model_copy(update={"patterns": each}))] == [
        "F1,2 are equal in a mirror: judged once, verified at 2,666 samples."
    ]
