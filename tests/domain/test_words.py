"""Cutters, machines, posture ranges, face selections: what is accepted, what is refused."""

import math

import numpy as np
import pytest

from cad_io.arrays import FaceInfo
from plan_cutters import Cutter, CutterError, Machine, MachineError, OptionError
from plan_cutters.domain.posture import PostureRange
from plan_cutters.options import Options
from plan_cutters.scene.faces import select_faces


def test_a_spec_and_its_cutter_are_the_same():
    cutter = Cutter.parse("R6L80")
    assert cutter == Cutter.flat(radius=6, length=80)
    assert cutter.id == "R6L80"
    assert Cutter.parse("r0.5l12.25").id == "R0.5L12.25"


@pytest.mark.parametrize("spec", ["", "6x80", "R6", "R6L", "RxL80", "R1.2.3L4", "R6L80rc", "R0L80", "R6L-1", "R6L80rc7"])
def test_specs_that_are_no_cutter(spec):
    with pytest.raises(CutterError):
        Cutter.parse(spec)


def test_machines():
    assert Machine.parse("unlimited").limit_cos == -2
    assert Machine.parse("tilt:60").limit_cos == pytest.approx(0.5)
    for text in ("tilt:", "tilt:-5", "tilt:200", "tilt:nan", "dmu50"):
        with pytest.raises(MachineError):
            Machine.parse(text)


def test_rotations_share_the_range():
    assert len(PostureRange().rotations) == 36
    assert PostureRange(rotation=(0.0, math.pi), step=math.radians(10)).rotations[-1] == pytest.approx(math.pi)
    steps = np.diff(PostureRange(rotation=(0.0, 1.0), step=0.3).rotations)
    assert steps.max() <= 0.3
    assert steps == pytest.approx(steps[0])
    assert len(PostureRange(rotation=(0.5, 0.5)).rotations) == 1
    assert PostureRange().upright
    assert not PostureRange(tilt=(0.1, 1.0)).upright


@pytest.mark.parametrize(
    "options",
    [{"tilt": (1.0, 0.5)}, {"tilt": (-0.1, 1)}, {"tilt": (0, 4)}, {"rotation": (0, 7)}, {"rotation": (1, 0)}, {"step": 0.0}],
)
def test_ranges_that_mean_nothing(options):
    with pytest.raises(OptionError):
        PostureRange(**options)


def test_options_that_mean_nothing():
    for options in ({"grid": 5, "spacing": 1.0}, {"tolerance": 0.0}, {"tolerance": math.nan}, {"setup": (0, 0, 0)},
                    {"cutters": (Cutter.flat(radius=0.02, length=1),)}):  # fmt: skip
        with pytest.raises(OptionError):
            Options(**options)


def faces():
    kinds = ("plane", "sculptured", "cylinder", "sculptured")
    names = ("top", "blade 1", "", "blade 2")
    return tuple(
        FaceInfo(i + 1, name, "bspline", kind, 1.0, (1.0, 0.0, 0.0) if i == 3 else None)
        for i, (kind, name) in enumerate(zip(kinds, names, strict=True))
    )


@pytest.mark.parametrize(
    ("text", "numbers"),
    [("sculptured", (2, 4)), ("all", (1, 2, 3, 4)), ("1,3-4", (1, 3, 4)), ("name:^blade", (2, 4)), ("color:#FF0000", (4,))],
)
def test_face_selections(text, numbers):
    assert select_faces(faces(), text) == numbers


def test_all_faces_where_none_is_sculptured():
    assert select_faces(faces()[:1], "sculptured") == (1,)


@pytest.mark.parametrize("text", ["5", "0", "2-9", "name:[", "name:hub", "color:#00FF00", "color:red", "F5", ""])
def test_face_selections_that_select_nothing(text):
    with pytest.raises(OptionError):
        select_faces(faces(), text)
