"""Words of a control: the plane of G68.2 has the tool axis for its Z, and G53.1 takes the angles of the step."""

import math
import re

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from plan_cutters.domain.control_words import control_words, euler_angles, solution_of
from plan_cutters.domain.kinematics import turned
from plan_cutters.domain.machine import Machine, builtin_machines
from plan_cutters.domain.placement import frame_of

TURNING = sorted(name for name, machine in builtin_machines().items() if machine.rotary)
DEGREES = st.one_of(st.sampled_from([0.0, 90.0, -90.0, 180.0, 45.0, 1e-7]), st.floats(-180.0, 180.0))
NUMBERS = st.one_of(st.sampled_from([0.0, 1.0, -1.0]), st.floats(-1.0, 1.0))


def plane_of(words):
    """X, Y, Z (3, 3), as rows, of the plane that words turn to: Z, then X as it lies then, then Z as it lies then."""
    i, j, k = (math.radians(float(x)) for x in re.fullmatch(r"G68\.2 P0 Q313 X0 Y0 Z0 I(\S+) J(\S+) K(\S+)", words).groups())
    axes = np.eye(3)
    for place, angle in ((2, i), (0, j), (2, k)):
        axes = turned(axes[place], np.full(3, angle), axes)
    return axes


def orientation(machine, setup, degrees):
    """The frame of a setup, the plane of angles, deg, and the other angles with its axis within limits, or None."""
    frame = frame_of(setup)
    kinematics = machine.kinematics(frame)
    angle = np.radians([degrees])
    z = kinematics.axis(angle)[0]
    x = kinematics.carried(frame[0], angle)[0]
    x = frame_of(z, x)[0]
    both = np.degrees(kinematics.positions(z[None])[0][0])
    apart = [each for each in both if np.isfinite(each).all() and np.abs((each - degrees + 180) % 360 - 180).sum() > 0.01]
    return frame, np.array([x, np.cross(z, x), z]), (apart[0] if apart else None)


@given(st.sampled_from(TURNING), st.tuples(NUMBERS, NUMBERS, NUMBERS), DEGREES, DEGREES)
def test_the_plane_has_the_axis_of_the_angles_and_the_turn_takes_them(name, up, first, second):
    """Of any machine in any setup, at singular angles, too; the words of the rotary axes are the angles."""
    setup = np.array(up)
    assume(np.linalg.norm(setup) > 0.1)
    machine = Machine.parse(name)
    degrees = np.round([first, second][: len(machine.rotary)], 3)
    low, high = np.degrees(machine.kinematics(np.eye(3)).limit).T
    assume(((degrees >= low) & (degrees <= high)).all())
    frame, plane, other = orientation(machine, setup / np.linalg.norm(setup), degrees)
    names = [axis.name for axis in machine.rotary]
    angles = dict(zip(names, degrees.tolist(), strict=True))
    words = control_words(frame, plane, angles, None if other is None else dict(zip(names, other.tolist(), strict=True)))
    assert np.abs(plane_of(words.g68_2) @ frame - plane).max() < 3e-8
    assert {word[0]: float(word[1:]) for word in words.rotary.removeprefix("G54 G0 ").split()} == angles
    if other is not None and np.abs(other[1:] - degrees[1:]).max() <= 0.01:
        assert words.g53_1 == "G53.1 P0"
    elif other is not None:
        # As LinuxCNC takes it: the way from zero that is nearest either way, or in one direction alone.
        way = {0: lambda a: min(a % 360, -a % 360), 1: lambda a: a % 360, 2: lambda a: 360 - a % 360}[int(words.g53_1[-1])]
        assert way(degrees[0]) < way(round(other[0], 3)) + 1e-9


@pytest.mark.parametrize(("z", "expected"), [((0, 0, 1), (30.0, 0.0, 0.0)), ((0, 0, -1), (30.0, 180.0, 0.0))])
def test_a_plane_across_the_spindle_is_turned_by_the_first_angle_alone(z, expected):
    x = np.array([math.cos(math.radians(30.0)), 0.5, 0.0])
    assert euler_angles(np.array([x, np.cross(z, x), z])) == pytest.approx(expected)


def test_without_a_rotary_axis_there_is_the_work_offset_alone():
    words = control_words(np.eye(3), np.eye(3), {}, None)
    assert (words.g68_2, words.g53_1, words.rotary) == (None, None, "G54")


def test_a_machine_that_names_no_axes_has_the_plane_and_the_shortest_way():
    words = control_words(np.eye(3), np.eye(3), None, None)
    assert (words.g68_2, words.g53_1, words.rotary) == ("G68.2 P0 Q313 X0 Y0 Z0 I0 J0 K0", "G53.1 P0", None)


def test_axes_with_names_of_their_own_have_no_words():
    words = control_words(np.eye(3), np.eye(3), {"table": 3.0}, None)
    assert words.rotary is None
    assert words.g68_2 is not None


@pytest.mark.parametrize(
    ("mine", "other", "way"),
    [((10.0, 30.0), (-170.0, -30.0), 0), ((90.0, 30.0), (-90.0, -30.0), 1), ((-90.0, 30.0), (90.0, -30.0), 2),
     ((-170.0, 5.0), (10.0, -5.0), 2), ((180.0, 5.0), (0.0, -5.0), 2), ((100.0, 5.0), None, 0), ((90.0, 0.0), (0.0, 0.0), 0)],
)  # fmt: skip
def test_the_choice_of_a_solution(mine, other, way):
    assert solution_of(mine, other) == way


def test_a_turn_about_x_alone_is_written_as_one():
    """As a machinist of four axes reads it, to both sides."""
    for degrees in (30.0, -30.0, 90.0, -150.0):
        machine = Machine.parse("4-axis-a")
        frame, plane, _ = orientation(machine, np.array([0.0, 0.0, 1.0]), np.array([degrees]))
        words = control_words(frame, plane, {"A": degrees}, None)
        assert words.g68_2 == f"G68.2 P0 Q313 X0 Y0 Z0 I0 J{degrees:g} K0"
        assert words.rotary == f"G54 G0 A{degrees:g}"
