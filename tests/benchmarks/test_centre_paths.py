"""Paths of the tool's centre by which hand plans are made: against closed forms, and what they cover."""

import ast
import math
import sys
from itertools import pairwise

import pytest
import shapely
from shapely.geometry import LineString, box

from tests.support.places import ROOT

sys.path.append(str(ROOT / "benchmarks"))
from centre_paths import (
    CHORD_ERROR,
    Path,
    Profile,
    ball_about,
    ball_along,
    ball_centres,
    circle,
    floor,
    floor_patterns,
    levels,
    rectangle,
    sharp_turns,
    wall,
    walls_round,
)

POCKET, ISLAND = rectangle(90, 60, 8), rectangle(24, 16, 4)
LEDGE, ABOVE = box(0, 0, 100, 2), box(0, -40, 100, 0)


def test_hand_plans_share_nothing_with_the_product():
    for name in ("centre_paths", "hand_plans"):
        tree = ast.parse((ROOT / "benchmarks" / f"{name}.py").read_text())
        imports = [node for node in ast.walk(tree) if isinstance(node, ast.Import | ast.ImportFrom)]
        named = {(getattr(node, "module", None) or node.names[0].name).split(".")[0] for node in imports}
        assert not {each for each in named if each.startswith(("plan_cutters", "cad_io", "tests"))}


@pytest.mark.parametrize("radius", [2.0, 20.0])
def test_the_centre_runs_round_a_pin_on_a_larger_circle_and_in_a_bore_on_a_smaller_one(radius):
    assert wall(circle(radius), 12, 10, 26).length == pytest.approx(math.tau * (radius + 6), rel=1e-3)
    bore = wall(circle(radius + 6), 12, 10, 26, inside=True)
    assert bore.length == pytest.approx(math.tau * radius, rel=1e-2)
    assert bore.corners == 0.0


def test_a_pocket_is_shorter_for_the_centre_by_a_circle_of_the_tool_and_a_block_longer():
    girth = 2 * (60 + 40) - (8 - math.tau) * 7
    assert wall(rectangle(60, 40, 7), 12, 10, 26, inside=True).length == pytest.approx(girth - math.tau * 6, rel=1e-3)
    for radius in (0.0, 3.0):
        boss = wall(rectangle(60, 40, radius), 12, 10, 26)
        assert boss.length == pytest.approx(200 - (8 - math.tau) * radius + math.tau * 6, rel=1e-3)
        assert boss.corners == pytest.approx(0.0 if radius else math.tau * 6)


def test_sharp_turns_are_those_outwards():
    corner = box(0, 0, 40, 40).difference(box(20, 20, 50, 50))
    assert sharp_turns(corner) == sharp_turns(corner.reverse()) == pytest.approx(2.5 * math.pi)
    assert sharp_turns(circle(20)) == 0.0


@pytest.mark.parametrize(("height", "count"), [(1, 1), (26, 1), (26.1, 2), (52, 2), (60, 3)])
def test_a_wall_has_as_many_levels_as_flutes_go_into_its_height(height, count):
    assert levels(height, 26) == count
    assert wall(LineString([(0, 0), (100, 0)]), 12, height, 26) == Path(100 * count, count, 1)


@pytest.mark.parametrize(
    ("face", "walls", "length", "passes"),
    [
        (rectangle(120, 80), None, 9 * 120, 9),  # 8 steps of 8.5 mm and the tool itself
        (rectangle(100, 1), None, 100, 1),
        (rectangle(100, 12), None, 100, 1),
        (rectangle(100, 12.5), None, 200, 2),
        (rectangle(100, 21), None, 200, 2),
        (rectangle(100, 21.5), None, 300, 3),
        (LEDGE, ABOVE, 100, 1),
        (box(0, 0, 100, 16), ABOVE.union(box(0, 16, 100, 40)), 200, 2),
        (circle(17.5).difference(circle(13.5)), None, math.tau * 15.5, 1),
    ],
)
def test_passes_of_floors(face, walls, length, passes):
    path = floor(face, 12, walls)
    assert path.passes == passes
    assert path.length == pytest.approx(length, rel=2e-3)


def test_a_pocket_is_cut_in_rings():
    """The first runs along the walls, and no point is farther than the tool's radius from one of them."""
    hollow = rectangle(60, 40, 7)
    first = 2 * (48 + 28) - (8 - math.tau) * 1
    assert floor(hollow, 12, walls_round(hollow)).length == pytest.approx(first + 2 * (32 + 12), rel=1e-3)


@pytest.mark.parametrize(
    ("face", "walls", "corner"),
    [
        (rectangle(120, 80).difference(rectangle(60, 40, 7)), None, 2.0),
        (POCKET.difference(ISLAND), walls_round(POCKET).union(ISLAND), 0.0),
        (POCKET.difference(ISLAND), walls_round(POCKET).union(ISLAND), 2.0),
        (rectangle(60, 40).difference(circle(2)), circle(2), 2.0),
        (LEDGE, ABOVE, 0.0),
    ],
)
def test_each_pattern_covers_the_floor_and_keeps_off_its_walls(face, walls, corner):
    """Points of the floor are as near to a pass as the flat part is wide, but where no place of the tool comes so near."""
    patterns = list(floor_patterns(face, 12, walls, corner))
    assert patterns
    x0, y0, x1, y1 = face.bounds
    points = [shapely.Point(x0 + (x1 - x0) * i / 60, y0 + (y1 - y0) * k / 60) for i in range(61) for k in range(61)]
    free = face.buffer(12).difference((walls or shapely.Point()).buffer(6 + CHORD_ERROR, quad_segs=90))
    points = [each for each in points if face.contains(each) and free.distance(each) < 6 - corner - CHORD_ERROR]
    assert len(points) > 20
    for passes in patterns:
        line = shapely.MultiLineString(passes)
        assert shapely.distance(line, points).max() <= 6 - corner + 2 * CHORD_ERROR
        assert walls is None or line.distance(walls) >= 6 - 2 * CHORD_ERROR


def test_neighbouring_passes_are_no_farther_apart_than_the_step_over():
    for passes in floor_patterns(rectangle(70, 50), 12):
        places = sorted({round(line.centroid.x if line.bounds[0] == line.bounds[2] else line.centroid.y, 6) for line in passes})
        assert max(b - a for a, b in pairwise(places)) <= 9 + 1e-6


@pytest.mark.parametrize("scallop", [0.001, 0.01, 0.1])
@pytest.mark.parametrize("radius", [1.5, 5.0])
def test_a_ball_on_a_plane_leaves_cusps_between_half_chords(radius, scallop):
    """The half distance d of two passes and the scallop h: d^2 = r^2 - (r - h)^2."""
    width = 2 * math.sqrt(radius**2 - (radius - scallop) ** 2)
    path = ball_along(Profile.line((0, 0), (20, 0)), 100, radius, scallop)
    assert path.passes == math.ceil(20 / width)
    assert path.length == 100 * path.passes


def half_angle(sphere, ball, scallop):
    """Half the angle between passes on a sphere, from its middle: of a hollow one the radius counts negative."""
    near, far = sphere + ball, sphere + scallop
    return math.acos((near**2 + far**2 - ball**2) / (2 * near * far))


@pytest.mark.parametrize(("sphere", "hollow"), [(20, False), (3, False), (25, True), (7, True)])
def test_circles_of_a_ball_on_a_half_sphere(sphere, hollow):
    """The centre moves on a sphere of its own, and each end has half a pass: a sum of sines, for a quarter of a circle."""
    signed = -sphere if hollow else sphere
    half = half_angle(signed, 5, 0.01)
    profile = Profile.arc((0, 0), sphere, -90 if hollow else 0, 0 if hollow else 90, hollow=hollow)
    path = ball_about(profile, 5, 0.01)
    assert path.passes == math.ceil(math.pi / 2 / (2 * half))
    assert path.length == pytest.approx(math.tau * abs(signed + 5) / (2 * math.sin(math.pi / 4 / path.passes)), rel=1e-6)


def test_a_ball_in_a_fillet_of_its_own_radius_has_one_pass():
    profile = Profile.arc((0, 0), 5, 180, 270, hollow=True)
    assert ball_along(profile, 100, 5, 0.01) == Path(100, 1, 1)
    assert ball_centres(profile, 5, 0.01) == pytest.approx(0.0, abs=1e-9)


def test_a_ball_on_a_cone():
    """Circles as far apart as on a plane, and each as long as at the centre: out by the ball's radius along the normal."""
    path = ball_about(Profile.line((10, 20), (20, 0)), 5, 0.01)
    slant, out = math.hypot(10, 20), 5 * 2 / math.sqrt(5)
    assert path.passes == math.ceil(slant / (2 * math.sqrt(25 - 4.99**2)))
    assert path.length == pytest.approx(path.passes * math.tau * (15 + out), rel=1e-6)


def test_paths_add_up():
    assert Path(10, 3, 1, 2) + Path(5, 1, 1).times(2) == Path(20, 5, 3, 2)
    assert Path(10, 3, 1).links == 2
