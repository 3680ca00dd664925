"""Fixtures in words: what is understood, what is refused, and where a placement puts them."""

import math
import pickle

import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from plan_cutters import Fixture, FixtureError, OptionError, Options

ANGLE = st.floats(-360, 360)


@pytest.mark.parametrize(
    ("text", "source", "placement", "unit", "name"),
    [
        ("vise.step", "vise.step", (0, 0, 0, 0, 0, 0), None, "vise"),
        ("a/vise.stl@1,-2,3.5", "a/vise.stl", (1, -2, 3.5, 0, 0, 0), None, "vise"),
        ("vise.stl@1,2,3,0,0,90:in", "vise.stl", (1, 2, 3, 0, 0, 90), "in", "vise"),
        ("vise.stl:cm", "vise.stl", (0, 0, 0, 0, 0, 0), "cm", "vise"),
        ("C:\\jaws\\left.stl", "C:\\jaws\\left.stl", (0, 0, 0, 0, 0, 0), None, "left"),
        ("C:\\left.stl@0,0,1e1:mm", "C:\\left.stl", (0, 0, 10, 0, 0, 0), "mm", "left"),
        ("me@home/vise.stl", "me@home/vise.stl", (0, 0, 0, 0, 0, 0), None, "vise"),
        ("vise@home.stl", "vise@home.stl", (0, 0, 0, 0, 0, 0), None, "vise@home"),
        ("vise@home.stl@1,2,3", "vise@home.stl", (1, 2, 3, 0, 0, 0), None, "vise@home"),
        ("a:b.stl", "a:b.stl", (0, 0, 0, 0, 0, 0), None, "b"),
        ("box:4,5,6@1,2,3", "box:4,5,6", (1, 2, 3, 0, 0, 0), None, "box"),
        ("Cylinder:4,5:cm", "Cylinder:4,5", (0, 0, 0, 0, 0, 0), "cm", "cylinder"),
        ("table:-12.5", "table:-12.5", (0, 0, 0, 0, 0, 0), None, "table"),
    ],
)
def test_texts(text, source, placement, unit, name):
    found = Fixture.parse(text)
    assert (found.source, found.placement, found.unit, found.name) == (source, placement, unit, name)
    assert Fixture.parse(found.text) == found
    assert pickle.loads(pickle.dumps(found)) == found


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("", "is no fixture"),
        ("@1,2,3", "nothing before the @"),
        ("x.stl@", "not of the form x,y,z"),
        ("x.stl@1,2", "not 2 numbers"),
        ("x.stl@1,2,3,4", "not 4 numbers"),
        ("x.stl@1,2,q", "'1,2,q' is not of the form"),
        ("x.stl@1,2,nan", "must be finite"),
        ("x.stl@1,2,inf", "must be finite"),
        ("x.stl@1,2,1e9", "up to 1e\\+06"),
        ("x.stl:inch", "no length unit is called 'inch'; give one of um, mm"),
        ("x.stl:", "no length unit is called ''"),
        ("box:0,1,2", "must be positive numbers, not 0"),
        ("box:1,-1,2", "must be positive numbers, not -1"),
        ("box:1,2", "box takes x,y,z, not 2 numbers"),
        ("box:", "not of the form x,y,z"),
        ("box:1,nan,2", "must be finite"),
        ("box:1,2,3:parsec", "no length unit is called 'parsec'"),
        ("box:1e6,1,1:m", "is its unit right"),
        ("cylinder:0,5", "must be positive"),
        ("cylinder:1,2,3", "cylinder takes r,h, not 3 numbers"),
        ("table:", "not of the form h"),
        ("table:1,2", "table takes h, not 2 numbers"),
        ("table:low", "'low' is not of the form h"),
    ],
)
def test_texts_that_are_no_fixture(text, words):
    with pytest.raises(FixtureError, match=words) as error:
        Fixture.parse(text)
    assert "\n" not in str(error.value)


@pytest.mark.parametrize("given", [3, None, True, "", 1.5])
def test_what_is_no_fixture(given):
    with pytest.raises(OptionError):
        Fixture(given)
    with pytest.raises(OptionError):
        Fixture.parse(given)


@pytest.mark.parametrize(
    "more", [{"placement": (1, 2)}, {"placement": "1,2,3"}, {"placement": (math.nan, 0, 0)}, {"unit": "inch"}, {"name": 3},
             {"chord_error": -1.0}, {"chord_error": math.inf}]
)  # fmt: skip
def test_values_that_mean_nothing(more):
    with pytest.raises(OptionError):
        Fixture("vise.stl", **more)


@given(ANGLE, ANGLE, ANGLE)
@example(4e-11, -8e-11, 90.0 + 6e-11)
def test_turns_are_about_the_fixed_axes_x_then_y_then_z_and_the_shift_comes_last(x, y, z):
    fixture = Fixture("vise.stl", (7.0, -8.0, 9.0, x, y, z))
    expected = Rotation.from_euler("xyz", [x, y, z], degrees=True)
    assert fixture.rotation == pytest.approx(expected.as_matrix(), abs=1e-12)
    points = np.array([[1.0, 2.0, 3.0], [-4.0, 0.0, 5.0]])
    assert fixture.placed(points) == pytest.approx(expected.apply(points) + np.array([7, -8, 9]), abs=1e-12)


def test_quarter_turns_are_exact():
    assert Fixture.parse("x.stl@0,0,0,90,0,0").placed(np.array([[0.0, 0.0, 5.0]])).tolist() == [[0.0, -5.0, 0.0]]
    assert Fixture.parse("x.stl@0,0,0,90,0,90").placed(np.array([[0.0, 0.0, 5.0]])).tolist() == [[5.0, 0.0, 0.0]]


def test_sizes_have_the_unit_and_places_are_mm():
    fixture = Fixture.parse("box:1,2,3@1,1,1:in")
    assert fixture.sizes == (25.4, 50.8, pytest.approx(76.2))
    assert fixture.shift.tolist() == [1, 1, 1]


def test_options_take_one_or_many_and_tell_them_apart():
    one = Options(fixtures="table:-5").fixtures
    assert [each.text for each in one] == ["table:-5"]
    many = Options(fixtures=["jaw.stl", "jaw.stl@0,60,0", Fixture("other/jaw.stl"), Fixture("x.stl", name="clamp")]).fixtures
    assert [each.name for each in many] == ["jaw", "jaw 2", "jaw 3", "clamp"]
    assert Options(fixtures=None).fixtures == ()
    with pytest.raises(FixtureError):
        Options(fixtures=[3])
