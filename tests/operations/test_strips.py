"""Widths of passes: closed forms, a tool that is moved by brute force, and what must not change them."""

import math

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from cad_io.arrays import SurfaceSamples
from plan_cutters import Cutter
from tests.support.moved_tool import width_left
from tests.support.strips import strips_at

NORMAL, X, Y = np.eye(3)[[2, 0, 1]]


def strips(cutter, samples, *rest):
    """The widest strips of a cutter at samples."""
    return strips_at(cutter, samples.normal, samples.direction_max, samples.curvature, *rest)


def samples_of(high=0.0, low=0.0, largest=X, normal=NORMAL, n=1):
    """Samples of one place, with its curvatures, the larger first and concave positive."""
    one = np.ones(n)
    return SurfaceSamples(
        point=np.zeros((n, 3)), normal=np.tile(normal, (n, 1)), curvature=np.tile((high, low), (n, 1)).astype(float),
        direction_max=np.tile(largest, (n, 1)), uv=np.zeros((n, 2)), face=np.zeros(n, np.int32), area=one,
        unjudged=np.full(n, -1, np.int32), neighbours=np.zeros((0, 2), np.int32), reasons=(), grids=(), max_gap=1.0, empty=(),
    )  # fmt: skip


def width(cutter, tilt=0.0, *, high=0.0, low=0.0, largest=X, scallop=0.01, stepover=1.0):
    axis = np.array([[math.sin(tilt), 0.0, math.cos(tilt)]])
    return float(strips(cutter, samples_of(high, low, largest), axis, scallop, stepover).width[0])


@pytest.mark.parametrize("scallop", [0.01, 0.3, 2.0])
def test_a_ball_on_a_plane(scallop):
    exact = min(2.0 * math.sqrt(2 * 6 * scallop - scallop**2), 12.0)
    for tilt in (0.0, 0.4, 1.2):
        assert width(Cutter.parse("R6L80rc6"), tilt, scallop=scallop) == pytest.approx(exact, rel=0.01)


def test_a_plane_of_100_mm_takes_a_ball_433_seconds():
    each = width(Cutter.parse("R6L80rc6"))
    assert each == pytest.approx(0.69253, rel=1e-4)
    assert 100.0 * 100.0 / (each * 2000.0 / 60.0) == pytest.approx(433.2, abs=0.1)


@pytest.mark.parametrize("tilt", [0.5, 1.0, 2.0, 5.0, 15.0, 60.0])
@pytest.mark.parametrize("scallop", [0.01, 0.05])
def test_a_tilted_flat_end_on_a_plane(tilt, scallop):
    sine = math.sin(math.radians(tilt))
    exact = 12.0 if scallop >= 6 * sine else 2.0 * math.sqrt(2 * 6 * scallop / sine - (scallop / sine) ** 2)
    assert width(Cutter.parse("R6L80"), math.radians(tilt), scallop=scallop) == pytest.approx(exact, rel=0.01)


def test_a_flat_end_at_15_degrees():
    assert width(Cutter.parse("R6L80"), math.radians(15.0)) == pytest.approx(1.35963, rel=0.01)


@pytest.mark.parametrize("tilt", [1.0, 3.0, 10.0, 40.0])
@pytest.mark.parametrize("scallop", [0.01, 0.1])
def test_a_bull_nose_fed_along_its_tilt(tilt, scallop):
    """Each point of the section's ellipse carries a ball: the lowest of these circles over a place is the tool there."""
    rho, corner, sine = 4.0, 2.0, math.sin(math.radians(tilt))
    turn = np.linspace(-math.pi / 2, math.pi / 2, 40001)
    centre, up = rho * np.sin(turn), rho * sine * (1.0 - np.cos(turn)) + corner

    def height(y):
        inside = np.abs(y - centre) <= corner
        return (up[inside] - np.sqrt(corner**2 - (y - centre[inside]) ** 2)).min() if inside.any() else np.inf

    low, high = 0.0, rho + corner
    for _ in range(40):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if height(middle) < scallop else (low, middle)
    found = width(Cutter.parse("R6L80rc2"), math.radians(tilt), scallop=scallop)
    assert found == pytest.approx(min(12.0, 2.0 * low), rel=0.01)


def circles(c, radius, scallop):
    cosine = ((c + radius) ** 2 + (c + scallop) ** 2 - radius**2) / (2 * (c + radius) * (c + scallop))
    return abs(c) * 2.0 * math.acos(cosine)


@pytest.mark.parametrize("c", [20.0, 5.0, -30.0, -9.0])
@pytest.mark.parametrize("scallop", [0.01, 0.05, 0.3])
def test_a_ball_on_a_sphere_and_in_one(c, scallop):
    exact = min(12.0, circles(c, 6.0, scallop))
    assert width(Cutter.parse("R6L80rc6"), 0.3, high=-1 / c, low=-1 / c, scallop=scallop) == pytest.approx(exact, rel=0.01)


@pytest.mark.parametrize("c", [-30.0, -9.0])
@pytest.mark.parametrize("scallop", [0.01, 0.05, 0.3])
def test_in_a_cylinder_a_ball_is_fed_along_it(c, scallop):
    exact = min(12.0, circles(c, 6.0, scallop))
    assert width(Cutter.parse("R6L80rc6"), 0.3, high=-1 / c, scallop=scallop) == pytest.approx(exact, rel=0.01)


def test_on_a_cylinder_a_ball_is_fed_around_it_as_on_a_plane():
    assert width(Cutter.parse("R6L80rc6"), 0.3, low=-1 / 20.0) == pytest.approx(2 * math.sqrt(2 * 6 * 0.01 - 1e-4), rel=0.01)


def test_a_whole_sphere_takes_its_area_over_width_and_feed():
    c, feed = 20.0, 2000.0
    each = width(Cutter.parse("R6L80rc6"), 0.3, high=-1 / c, low=-1 / c)
    area = 4.0 * math.pi * c**2
    assert area / (each * feed / 60.0) == pytest.approx(area / (circles(c, 6.0, 0.01) * feed / 60.0), rel=0.01)


def test_the_flank_of_a_barrel_has_the_width_of_its_arc():
    """Across the flank lies an arc of 80 mm: the pass is as wide as that of a ball of this radius."""
    barrel = Cutter.barrel(radius=5.0, flank_radius=80.0, length=60.0, height=8.0, flutes=16.0, shank_radius=4.0)
    found = width(barrel, math.radians(90.0), stepover=10.0)
    assert found == pytest.approx(2.0 * math.sqrt(2 * 80 * 0.01), rel=0.01)


CASES = [  # corner, tilt, feed from the tilt direction, curvatures along it, across it, and mixed
    (0.0, 15, (0.0, 0.0, 0.0)), (0.0, 15, (0.02, -0.03, 0.0)), (0.0, 15, (-0.03, 0.02, 0.0)), (0.0, 15, (0.02, 0.02, 0.015)),
    (0.0, 30, (0.03, -0.05, 0.02)), (2.0, 20, (0.02, -0.03, 0.0)), (2.0, 20, (0.05, -0.05, 0.0)), (2.0, 20, (-0.1, 0.03, 0.04)),
    (6.0, 20, (0.1, -0.1, 0.05)), (6.0, 0, (0.0, 0.0, 0.0)), (6.0, 20, (0.1, -0.1, 0.0)), (2.0, 35, (-0.05, -0.02, 0.01)),
]  # fmt: skip


@pytest.mark.slow("another case of the same law", but=("1", "5", "6", "8", "9", "11"))
@pytest.mark.parametrize("case", range(len(CASES)))
def test_a_tool_moved_along_the_feed_leaves_as_much(case):
    corner, tilt, (along, across, mixed) = CASES[case]
    tilt = math.radians(tilt)
    form = np.array([[along, mixed], [mixed, across]])
    (low, high), vectors = np.linalg.eigh(form)
    samples = samples_of(high, low, np.array([*vectors[:, 1], 0.0]))
    axis = np.array([[math.sin(tilt), 0.0, math.cos(tilt)]])
    cutter = Cutter.parse(f"R6L80rc{corner:g}" if corner else "R6L80")
    found = strips(cutter, samples, axis, 0.01, 1.0)
    left = width_left(6.0, corner, tilt, form, found.feed[0, :2], 0.01)
    assert found.width[0] == pytest.approx(left, rel=0.01)


@given(st.integers(0, 2**31))
@example(266457)  # a ball on a line that is hardly bent
@settings(max_examples=60, deadline=None)
def test_turning_and_scaling_everything_turns_and_scales_the_strips(seed):
    rng = np.random.default_rng(seed)
    turn = np.linalg.qr(rng.normal(size=(3, 3)))[0]
    turn *= np.sign(np.linalg.det(turn))
    high, low = np.sort(rng.normal(0.0, 0.03, 2))[::-1]
    axis = rng.normal(size=3) * 0.4 + NORMAL
    axis /= np.linalg.norm(axis)
    size, corner = float(rng.uniform(0.2, 5.0)), float(rng.choice([0.0, 1.0, 6.0]))
    first = strips(Cutter(6.0, 80.0, corner), samples_of(high, low), axis[None], 0.02, 0.75)
    turned = samples_of(high / size, low / size, turn @ X, turn @ NORMAL)
    second = strips(Cutter(6.0 * size, 80.0 * size, corner * size), turned, (turn @ axis)[None], 0.02 * size, 0.75)
    np.testing.assert_allclose(second.width, size * first.width, rtol=1e-6)
    np.testing.assert_allclose(second.free_width, size * first.free_width, rtol=1e-6)
    cross = np.cross(turn @ first.feed[0], second.feed[0])
    eigen_apart = corner != 6.0 or high - low > 1e-3
    assert not eigen_apart or np.linalg.norm(cross) < 1e-3


def test_no_strip_is_wider_than_the_step_over_and_none_is_where_the_tool_cannot_touch():
    assert width(Cutter.parse("R6L80"), 0.001, stepover=0.75) == 9.0
    wall = strips(Cutter.parse("R6L80"), samples_of(), np.array([[0.0, 0.0, -1.0]]), 0.01, 0.75)
    assert math.isnan(wall.width[0])
    assert math.isnan(strips(Cutter.parse("R6L80"), samples_of(), np.full((1, 3), math.nan), 0.01, 0.75).width[0])
