"""Angles by names in `_deg` are the same angles, and cutters by diameter the same cutters; what is given twice is one error."""

import dataclasses
import inspect
import math
import pickle

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from plan_cutters import Axis, Cutter, Machine, Options, PostureMap, PostureRange, posture_map
from plan_cutters.domain.checks import Angle, in_radians
from plan_cutters.errors import CutterError, MachineError, OptionError
from plan_cutters.options import ANGLES
from tests.support.places import SAMPLES

GROOVE = SAMPLES / "v_groove.step"


def angles(least, most):
    return st.floats(least, most).map(float)


def ranges(least, most):
    return st.tuples(angles(least, most), angles(least, most)).map(sorted).map(tuple)


@settings(max_examples=30)
@given(ranges(0, 180), ranges(-180, 180), angles(0.2, 90), angles(1, 90))
def test_degrees_are_the_same_options_as_radians(tilt, rotation, step, index):
    of_degrees = Options(tilt_deg=tilt, rotation_deg=rotation, rotation_step_deg=step, index_step_deg=index)
    of_radians = Options(tilt=tuple(map(math.radians, tilt)), rotation=tuple(map(math.radians, rotation)),
                         rotation_step=math.radians(step), index_step=math.radians(index))  # fmt: skip
    assert of_degrees == of_radians
    assert PostureRange(tilt_deg=tilt, rotation_deg=rotation, step_deg=step) == of_radians.postures
    assert Options.of({"tilt_deg": list(tilt), "rotation_deg": np.array(rotation)}).tilt == of_radians.tilt


@given(angles(0.01, 20), angles(1, 50), angles(0.5, 30))
def test_a_cutter_by_diameter_and_degrees_is_the_same_cutter(radius, length, taper):
    long = length + 2 * radius
    words = {"length": long, "flutes": long / 2}
    for kind, more in ((Cutter.flat, {}), (Cutter.ball, {}), (Cutter.bull, {"corner_radius": radius / 2})):
        assert kind(diameter=2 * radius, **words, **more) == kind(radius=radius, **words, **more)
        assert kind(diameter=2 * radius, taper_deg=taper, **words, **more) == kind(
            radius=radius, taper=math.radians(taper), **words, **more
        )
    assert Cutter(radius, long, taper_deg=taper) == Cutter(radius, long, taper=math.radians(taper))


def test_the_other_kinds_go_by_diameter_too():
    assert Cutter.lollipop(diameter=8, neck_diameter=4, length=50) == Cutter.lollipop(radius=4, neck_radius=2, length=50)
    barrel, lens = (
        {"flank_radius": 60, "height": 8, "length": 50, "flutes": 15, "shank_radius": 4},
        {"bottom_radius": 40, "corner_radius": 1, "length": 80},
    )
    assert Cutter.barrel(diameter=10, **barrel) == Cutter.barrel(radius=5, **barrel)
    assert Cutter.lens(diameter=12, **lens) == Cutter.lens(radius=6, **lens)


def test_a_cutter_is_still_a_record():
    cutter = Cutter.flat(diameter=12, length=80, taper_deg=3, name="mine")
    assert pickle.loads(pickle.dumps(cutter)) == cutter
    assert dataclasses.replace(cutter, length=70) == Cutter.flat(radius=6, length=70, taper_deg=3, name="mine")
    assert Machine("mine", tilt_limit_deg=60) == Machine("mine", math.radians(60))


@pytest.mark.parametrize("word", ANGLES)
def test_both_units_at_once_are_one_error(word):
    kept = getattr(Options(), word) or 0.01
    degrees = np.degrees(kept).tolist()
    # The default of the other one, too: it was given.
    with pytest.raises(OptionError, match=f"{word} and {word}_deg are one angle, in radians and in degrees: give one of them"):
        Options(**{word: kept, f"{word}_deg": degrees})
    assert getattr(Options(**{word: kept, f"{word}_deg": None}), word) == kept
    # What was not given in degrees has its default.
    assert Options(**{f"{word}_deg": None}) == Options()


@pytest.mark.parametrize(("make", "error"), [
    (lambda: Cutter.flat(radius=6, diameter=12, length=80), "radius and diameter of a cutter are one dimension"),
    (lambda: Cutter.flat(length=80), "a cutter needs its radius or its diameter"),
    (lambda: Cutter.lollipop(radius=4, length=50), "a cutter needs its neck radius or its neck diameter"),
    (lambda: Cutter.ball(diameter=-12, length=80), "cutter diameter must be a positive number of mm, not -12"),
    (lambda: Cutter.ball(diameter=math.nan, length=80), "cutter diameter must be a number, not nan"),
    (lambda: Cutter.ball(diameter="12", length=80), "cutter diameter must be a number, not '12'"),
    (lambda: Cutter.flat(radius=6, length=80, taper=0.1, taper_deg=5), "taper and taper_deg are one angle"),
    (lambda: Cutter(6, 80, taper_deg=91), "taper_deg 91 must lie between -90 and 90 degrees"),
    (lambda: Machine(tilt_limit_deg=-1), "tilt_limit_deg -1 must lie between 0 and 180 degrees"),
    (lambda: Machine(tilt_limit=1.0, tilt_limit_deg=30), "tilt_limit and tilt_limit_deg are one angle"),
    (lambda: Options(tilt_deg=(60, 20)), "tilt_deg 60:20 must run upwards"),
    (lambda: Options(tilt_deg=(0, 190)), "tilt_deg 190 must lie between 0 and 180 degrees"),
    (lambda: Options(tilt_deg=60), "tilt_deg must be a list of 2 numbers, not 60"),
    (lambda: Options(tilt_deg=(0, 30, 60)), "tilt_deg must be a list of 2 numbers, not of 3"),
    (lambda: Options(tilt_deg=()), "tilt_deg must be a list of 2 numbers, not of 0"),
    (lambda: Options(rotation_deg=(0, math.nan)), "rotation_deg must be a number, not nan"),
    (lambda: Options(rotation_deg=(0, math.inf)), "rotation_deg inf must lie between -360 and 360 degrees"),
    (lambda: Options(rotation_step_deg=(5, 6)), "rotation_step_deg must be a number, not a value of type tuple"),
    (lambda: Options(index_step_deg=0.1), "index_step_deg 0.1 must lie between 0.5 and 90 degrees"),
    (lambda: Options.of({"tilt_degrees": (0, 60)}), r"no option is called tilt_degrees; did you mean tilt_deg\?"),
])  # fmt: skip
def test_what_has_no_meaning_is_told_in_the_unit_that_it_was_given_in(make, error):
    with pytest.raises((CutterError, MachineError, OptionError), match=error) as found:
        make()
    assert " rad" not in str(found.value).replace(" radi", "")
    assert "\n" not in str(found.value)


def test_rotary_axes_of_machines():
    turning = {"limits_deg": [-30, 120], "rate_deg": 90}
    assert Axis.rotary("A", "part", (1, 0, 0), **turning) == Axis(
        "A", "rotary", "part", (1, 0, 0), (math.radians(-30), math.radians(120)), rate=math.pi / 2
    )
    assert Axis.rotary("C", "tool", (0, 0, 1), limits_deg=(-math.inf, math.inf)).limits is None
    for words, error in (({"limits_deg": (120, -30)}, "must run upwards"), ({"limits_deg": 30}, "its limits in degrees must be"),
                         ({"limits_deg": (0, math.nan)}, "nan"), ({"rate_deg": 0}, "its rate must be positive"),
                         ({"rate_deg": math.nan}, "its rate in degrees a second must be a number, not nan")):  # fmt: skip
        with pytest.raises(MachineError, match=error):
            Axis.rotary("A", "part", (1, 0, 0), **words)


def test_people_see_the_words():
    assert {"taper_deg", "radius", "diameter", "holder", "flutes"} <= set(inspect.signature(Cutter.flat).parameters)
    assert "taper_deg" in inspect.signature(Cutter).parameters
    assert inspect.signature(Options).parameters["tilt_deg"].default is None


def test_several_angles_are_a_list_or_one():
    several = {"rotations": Angle(-360, 360, "several")}
    assert in_radians({"rotations_deg": 90}, several) == {"rotations": math.pi / 2}
    assert in_radians({"rotations_deg": np.array([0, 180])}, several) == {"rotations": (0.0, math.pi)}


def test_one_point_in_degrees():
    words = {"point": (0, 0, 0), "cutter": "R8L90"}
    of_degrees = posture_map(GROOVE, **words, rotations_deg=[0, 90], tilt_deg=(10, 60))
    assert of_degrees == posture_map(GROOVE, **words, rotations=np.radians([0, 90]), tilt=np.radians([10, 60]))
    assert isinstance(of_degrees, PostureMap)
    assert (of_degrees.axis(0, tilt_deg=30) == of_degrees.axis(0, math.radians(30))).all()
    for wrong, error in (
        (lambda: of_degrees.axis(0, 0.5, tilt_deg=30), "tilt and tilt_deg are one angle"),
        (lambda: of_degrees.axis(0), "give a tilt, in radians, or tilt_deg, in degrees"),
        (lambda: posture_map(GROOVE, **words), "give rotations, in radians, or rotations_deg, in degrees"),
        (lambda: posture_map(GROOVE, **words, rotations=0.0, rotations_deg=0), "rotations and rotations_deg are one angle"),
        (lambda: posture_map(GROOVE, **words, rotations_deg=[400]), "rotations_deg 400 must lie between -360 and 360 degrees"),
        (lambda: posture_map(GROOVE, **words, rotations=0.0, tilt=(0, 1), tilt_deg=(0, 60)), "tilt and tilt_deg are one angle"),
    ):
        with pytest.raises(OptionError, match=error):
            wrong()
