"""Posture maps with something wrong in them are refused, by array and row; and sound ones are not."""

import math
from dataclasses import replace

import numpy as np
import pytest

from plan_cutters.domain.verdicts import ACCESSIBLE, NO_REASON, UNJUDGED
from plan_cutters.errors import OptionError
from plan_cutters.stages.posture_maps import PostureMaps

#: Three samples, the second of which was not judged, and four rotations: one free interval each, two at the last of the last.
WORDS = {
    "rotations": 0.5 * math.pi * np.arange(4.0),
    "offset": np.array([0, 1, 2, 3, 4, 4, 4, 4, 4, 5, 6, 7, 9]),
    "free": np.array([[0.1, 0.5]] * 8 + [[0.7, 0.9]]),
    "undecided": np.zeros((3, 4), np.float32),
    "normal": np.tile([0.0, 0.0, 1.0], (3, 1)),
    "direction_max": np.tile([1.0, 0.0, 0.0], (3, 1)),
    "verdict": np.array([ACCESSIBLE, UNJUDGED, ACCESSIBLE], np.uint8),
    "reason": np.full(3, NO_REASON, np.uint8),
    "tilt": (0.0, 1.0),
    "tolerance": 0.01,
    "cutter": "T",
    "part": "",
}


def changed(word, at, value):
    array = WORDS[word].copy()
    array[at] = value
    return {word: array}


def flags(at):
    inside = np.zeros(3, np.uint8)
    inside[at] = 2
    return {"inside": inside.view(bool)}


def test_sound_maps_are_maps():
    maps = PostureMaps(**WORDS)
    assert maps.inside.tolist() == [False, False, False]
    assert maps.finished.tolist() == [True, False, True]
    inside = np.array([True, False, False])
    assert replace(maps, inside=inside).finished.tolist() == [False, False, True]
    # Nobody changes them afterwards.
    for word in ("free", "offset", "normal", "inside"):
        assert not getattr(maps, word).flags.writeable
    assert WORDS["free"].flags.writeable
    # What was not judged may have no normal; ends of tilts may be on the ends of the range; intervals may touch.
    PostureMaps(**WORDS | changed("normal", 1, np.nan) | changed("direction_max", 1, 0.0))
    PostureMaps(**WORDS | changed("free", 0, (0.0, 1.0)) | changed("reason", 0, 0))
    PostureMaps(**WORDS | changed("free", 8, (0.5, 0.5)))
    PostureMaps(**WORDS | {"tilt": (0.0, math.pi), "tolerance": 0})


BAD = {
    "rotations": [
        (0, math.nan, "rotations, row 0: nan is no angle"), (3, 7.0, "rotations, row 3: 7 is no angle"),
        (0, -7.0, "rotations, row 0: -7 is no angle"), (2, 1.5, "rotations, row 2: they must ascend"),
        (1, 0.0, "rotations, row 1: they must ascend"),
    ],
    "offset": [
        (0, 1, "offset, row 0: it must run from 0 to 9"), (12, 8, "offset, row 12: it must run from 0 to 9"),
        (2, 0, "offset, row 2: no place of an interval"), (3, 10, "offset, row 3: no place of an interval"),
        (11, 10, "offset, row 11: no place of an interval"), (1, -1, "offset, row 1: no place of an interval"),
        (4, 3, "offset, row 5: sample 1 was not judged and has free tilts"),
    ],
    "free": [
        (0, (-0.1, 0.5), "free, row 0: no interval"), (3, (0.1, 1.1), "free, row 3: no interval"),
        (5, (0.5, 0.1), "free, row 5: no interval"), (6, (math.nan, 0.5), "free, row 6: no interval"),
        (8, (0.1, math.nan), "free, row 8: no interval"), (8, (0.4, 0.9), "free, row 8: it does not follow"),
    ],
    "undecided": [
        ((0, 1), -0.1, "undecided, row 0: no width"), ((2, 3), 7.0, "undecided, row 2: no width"),
        ((1, 0), np.nan, "undecided, row 1: no width"),
    ],
    "normal": [
        (0, (0.0, 0.0, 1.1), "normal, row 0: it is no unit vector"), (2, (0.0, 0.0, 0.9), "normal, row 2: it is no unit vector"),
        (0, math.nan, "normal, row 0: it is no unit vector"), (2, 0.0, "normal, row 2: it is no unit vector"),
        (0, 1e200, "normal, row 0: it is no unit vector"),
    ],
    "direction_max": [
        (2, (0.0, 0.0, 1.0), "direction_max, row 2: it is not across the normal"),
        (0, (0.8, 0.0, 0.6), "direction_max, row 0: it is not across the normal"),
        (0, (1.1, 0.0, 0.0), "direction_max, row 0: it is no unit vector"),
    ],
    "verdict": [(0, 77, "verdict, row 0: 77 is no valid code"), (2, 200, "verdict, row 2: 200 is no valid code")],
    "reason": [(1, 200, "reason, row 1: 200 is no valid code"), (2, 254, "reason, row 2: 254 is no valid code")],
}  # fmt: skip


@pytest.mark.parametrize(("word", "at", "value", "why"), [(word, *each) for word, cases in BAD.items() for each in cases])
def test_a_value_that_cannot_be_is_named_with_its_row(word, at, value, why):
    with pytest.raises(OptionError) as error:
        PostureMaps(**WORDS | changed(word, at, value))
    assert str(error.value).startswith(f"these are no posture maps: {why}")


@pytest.mark.parametrize("row", [0, 1, 2])
def test_a_flag_that_is_neither_true_nor_false_is_named(row):
    with pytest.raises(OptionError, match=f"inside, row {row}: it is neither true nor false"):
        PostureMaps(**WORDS | flags(row))


@pytest.mark.parametrize(
    ("words", "why"),
    [
        ({"cutter": 3}, "cutter and part must be texts"),
        ({"part": None}, "cutter and part must be texts"),
        ({"about": [1]}, "about must be a mapping"),
        ({"tilt": [0.0, 1.0]}, "tilt must be two numbers, rad"),
        ({"tilt": (0.0,)}, "tilt must be two numbers, rad"),
        ({"tilt": (0.0, True)}, "tilt must be two numbers, rad"),
        ({"tilt": (0.0, "1")}, "tilt must be two numbers, rad"),
        ({"tilt": (0.0, math.inf)}, "tilt must be two numbers, rad"),
        ({"tilt": (1.0, 0.0)}, "tilts 1 to 0 rad must run upwards within 0 and pi"),
        ({"tilt": (-0.1, 1.0)}, "must run upwards within 0 and pi"),
        ({"tilt": (0.0, 3.2)}, "must run upwards within 0 and pi"),
        ({"tolerance": -0.01}, "tolerance must be a number of mm"),
        ({"tolerance": math.inf}, "tolerance must be a number of mm"),
        ({"tolerance": math.nan}, "tolerance must be a number of mm"),
        ({"tolerance": True}, "tolerance must be a number of mm"),
        ({"tolerance": "0.01"}, "tolerance must be a number of mm"),
        ({"free": WORDS["free"].tolist()}, "free must be an array"),
        ({"inside": None}, "inside must be an array"),
        ({"normal": np.asfortranarray(WORDS["normal"])}, "normal must be contiguous"),
        ({"normal": WORDS["normal"][:2]}, "array normal is <f8 (2, 3), not <f8 (3, 3)"),
        ({"undecided": WORDS["undecided"].astype(float)}, "array undecided is <f8 (3, 4), not <f4 (3, 4)"),
        ({"offset": WORDS["offset"][:-1]}, "array offset is <i8 (12,), not <i8 (13,)"),
        ({"free": WORDS["free"][:, :1].copy()}, "array free is <f8 (9, 1), not <f8 (9, 2)"),
        ({"inside": np.zeros(2, bool)}, "array inside is |b1 (2,), not |b1 (3,)"),
        ({"rotations": np.zeros(0)}, "3 samples, 0 rotations and 9 free intervals cannot be"),
    ],
)
def test_what_is_of_another_kind_or_shape_is_named(words, why):
    with pytest.raises(OptionError) as error:
        PostureMaps(**WORDS | words)
    assert str(error.value).startswith("these are no posture maps: ")
    assert why in str(error.value)
