"""The closed forms next to their singular cases, against direct containment: never optimistic, exact to rounding.

`ROUNDING` times the largest length in play is what "inside" and "outside" may be wrong by, as a depth in mm.
"""

import math
from functools import cache

import numpy as np
import pytest
from hypothesis import assume, example, given, settings
from hypothesis import strategies as st

from cad_io import read_part
from cad_io.tessellate import tessellate
from plan_cutters import Cutter, Machine, plan
from plan_cutters.domain.assembly import assembly
from plan_cutters.domain.posture import PostureRange
from plan_cutters.domain.verdicts import INACCESSIBLE
from plan_cutters.kernels.maps.free_tilts import axis_intervals, local_gouge_range
from plan_cutters.kernels.rows import Frame
from plan_cutters.kernels.search import search
from plan_cutters.kernels.tool import apart, hit
from plan_cutters.kernels.tool.arcs import point_arc
from plan_cutters.scene.conditions import ranges_of
from plan_cutters.scene.obstacles import Obstacles
from tests.support import shapes, waves
from tests.support.reference import (
    deepest_in_cylinder,
    depth_in_cutter,
    depth_while_tilting,
    distance_to_triangle,
    posture,
    random_frame,
)

ROUNDING = 1e-13
RIGHT = math.pi / 2
SCRATCH = hit.scratch()

#: Distances from a singular case: on it, an ulp off, and ever further.
OFF = st.sampled_from([0.0, 1e-16, 1e-14, 1e-10, 1e-8, 1e-5, 1e-2]).flatmap(lambda x: st.sampled_from([x, -x]))


ANYWHERE = st.floats(-30, 30)


def near(*places, anywhere=ANYWHERE):
    """On or next to one of the places, or anywhere."""
    return st.one_of(st.builds(lambda x, d: x + d * max(1.0, abs(x)), st.sampled_from(places), OFF), anywhere)


cutters = st.tuples(
    st.sampled_from([0.5, 3.0, 8.0]) | st.floats(0.5, 10),
    st.sampled_from([0.6, 3.0, 6.0, 90.0]) | st.floats(0.5, 90),
    st.sampled_from([0.0, 1e-12, 0.01, 0.2]),
)


@st.composite
def points_by_the_arc(draw):
    """A cutter, and a point whose distances and polar angle are where the closed form changes its case."""
    radius, length, s = draw(cutters)
    shrunk = radius - s
    y = draw(near(0.0, shrunk, -shrunk, radius, anywhere=st.floats(-shrunk, shrunk)))
    r = math.sqrt(max(0.0, shrunk * shrunk - y * y))
    places = (0.0, s, length - s, radius - r, radius + r, math.hypot(radius + r, length))
    d = abs(draw(near(*places, anywhere=st.floats(0, 2 * radius + length))))
    lowest = math.asin(min(1.0, s / max(d, s, 1e-300)))
    angle = draw(near(0.0, RIGHT, -RIGHT, math.pi, lowest, anywhere=st.floats(0, math.pi)))
    return radius, length, s, (-d * math.cos(angle), y, d * math.sin(angle))


@given(points_by_the_arc(), near(0.0, RIGHT, RIGHT / 2))
@settings(max_examples=400, deadline=None)
def test_an_arc_is_where_the_point_is_inside(case, tilt):
    radius, length, s, (x, y, z) = case
    assume(s < length / 2)
    tilt = min(RIGHT, max(0.0, tilt))
    cosine, sine = math.cos(tilt), math.sin(tilt)
    first, last = point_arc(cosine * z + sine * x, cosine * x - sine * z + radius, y, tilt, radius, radius - s, s, length - s)
    ends = [e + d for e in (first, last) for d in (-1e-3, -1e-6, -1e-9, -1e-12, 0.0, 1e-12, 1e-9, 1e-6, 1e-3)]
    tilts = np.clip(np.concatenate([np.linspace(0, RIGHT, 181), ends, [0.5 * (first + last)]]), 0, RIGHT)
    deeper = depth_while_tilting((x, y, z), tilts, radius, length) - s
    allowed = ROUNDING * (radius + length + math.hypot(x, y, z))
    inside = (first < tilts) & (tilts < last)
    assert (deeper[inside] > -allowed).all(), "an arc reaches out of the body"
    assert (deeper[~inside] < allowed).all(), "a tilt beyond the arc is not free"


@given(points_by_the_arc())
@settings(max_examples=300, deadline=None)
def test_the_ends_of_an_arc_are_where_bisection_finds_them(case):
    """Where depth changes quickly, the ends agree in tilt as well; far from such places they need not."""
    radius, length, s, point = case
    assume(s < length / 2)
    first, last = point_arc(point[2], point[0] + radius, point[1], 0.0, radius, radius - s, s, length - s)

    def deeper(tilt):
        return depth_while_tilting(point, [tilt], radius, length)[0] - s

    for end, inwards in ((first, 1), (last, -1)):
        if first + 2e-3 < last and 1e-3 < end < RIGHT - 1e-3:
            free, blocked = end - inwards * 1e-3, end + inwards * 1e-3
            if deeper(free) < -1e-4 and deeper(blocked) > 1e-4:
                for _ in range(50):
                    middle = 0.5 * (free + blocked)
                    free, blocked = (free, middle) if deeper(middle) > 0 else (middle, blocked)
                assert end == pytest.approx(free, abs=1e-10)


def test_no_arc_is_empty_whatever_the_tilt():
    """Callers widen an arc about the tilt they probed: what is no arc must not pull a bound away from it."""
    for tilt in (0.0, 0.9, 1.0, RIGHT):
        for height, px, py in ((0.0, 6.0, 0.0), (5.0, 0.0, 6.0), (5.0, 20.0, 7.0)):
            first, last = point_arc(height, px, py, tilt, 6.0, 6.0, 0.0, 80.0)
            assert min(first, tilt) == tilt == max(last, tilt)
    # A body that its own shrinking has used up forbids nothing.
    assert point_arc(1.0, 0.0, 0.0, 0.3, 0.5, -0.5, 1.0, 20.0) == point_arc(5.0, 0.0, 6.0, 0.3, 6.0, 6.0, 0.0, 80.0)
    assert point_arc(1.0, 0.0, 0.0, 0.3, 0.5, 0.4, 2.0, 1.0) == point_arc(5.0, 0.0, 6.0, 0.3, 6.0, 6.0, 0.0, 80.0)


curvatures = st.sampled_from([0.0, 1e-12, 0.05, 0.125, 0.25]).flatmap(lambda k: st.sampled_from([k, -k]))


@given(kappa=st.tuples(curvatures | st.floats(-0.5, 0.5), curvatures | st.floats(-0.5, 0.5)),
       rotation=near(0.0, RIGHT, math.pi), radius=st.sampled_from([2.0, 4.0, 8.0]))  # fmt: skip
@settings(max_examples=400, deadline=None)
def test_local_gouging_is_where_the_neighbourhood_is_inside(kappa, rotation, radius):
    """The paraboloid about the contact, so near that only curvature counts, lies in the cutter below the bound alone."""
    high, low = max(kappa), min(kappa)
    bound, _ = local_gouge_range(high, low, rotation, radius, 0.0)
    contact, normal, first = np.zeros(3), np.array([0.0, 0, 1]), np.array([1.0, 0, 0])
    turns = np.linspace(0, 2 * math.pi, 721)

    def deepest(tilt):
        # Depth over the square of the distance, about the contact and where a gouge begins: beside it, a hair back.
        axis, tilt_direction = posture(normal, first, tilt, rotation)
        h, aside = 1e-4 * radius, np.cross(normal, tilt_direction)[:2]
        back = np.linspace(-1, 1, 801) * h * h * (1 / radius + abs(high / 2) / math.tan(max(tilt, 0.01)))
        side = [np.outer(back, tilt_direction[:2]) + turn * h * aside for turn in (-1, 1)]
        ring = h * np.stack([np.cos(turns), np.sin(turns)], -1)
        x, y = np.concatenate([ring, *side]).T
        points = np.stack([x, y, 0.5 * (high * x * x + low * y * y)], -1)
        return depth_in_cutter(points, contact, normal, axis, tilt_direction, radius, 50.0).max() * radius / (h * h)

    across = radius * (high * math.sin(rotation) ** 2 + low * math.cos(rotation) ** 2)
    if math.isnan(bound):
        assert across > 1 - 1e-12
        return
    assert math.sin(bound) >= across - 2e-9
    above, below = bound + 0.02, bound - 0.02
    if above < 1.5:
        assert deepest(above) < 1e-3
    # Near the upright the sine, which decides, hardly changes with the tilt.
    if 0.01 < below < 1.4:
        assert deepest(below) > 1e-3


@given(st.floats(-0.5, 0.5), st.floats(0, 2 * math.pi))
def test_an_umbilic_gouges_alike_at_every_rotation(kappa, rotation):
    here, there = (local_gouge_range(kappa, kappa, turn, 2.0, 0.0)[0] for turn in (rotation, 0.0))
    assert math.isnan(here) == math.isnan(there) or abs(2.0 * kappa - 1.0) < 1e-14
    assert math.isnan(here) or math.isnan(there) or math.sin(here) == pytest.approx(math.sin(there), abs=1e-14)
    assert math.isnan(local_gouge_range(math.nan, 0.0, rotation, 2.0, 0.0)[0]), "an unknown curvature is never free"


@given(n=near(0.0, RIGHT, math.pi), f=near(0.0, RIGHT, math.pi), m=near(0.0, RIGHT, math.pi),
       limit=st.sampled_from([0.0, 1e-9, 1e-4, 0.5, RIGHT, 2.0, math.pi - 1e-9]) | st.floats(0, 3.14))  # fmt: skip
@example(n=0.0, f=0.0, m=0.0, limit=0.0)
@settings(max_examples=300, deadline=None)
def test_axis_arcs_by_the_angle_itself(n, f, m, limit):
    """Setup axis along the normal, along the lean, across both, opposite; a cone that just touches the great circle."""
    normal, first = np.array([math.cos(n), math.sin(n), 0.0]), np.array([-math.sin(n), math.cos(n), 0.0])
    setup = np.array([math.cos(m), math.sin(m), 0.0])
    _, tilt_direction = posture(normal, first, 0.0, f)
    bound = math.cos(limit)
    intervals = axis_intervals(normal, tilt_direction, ranges_of(Machine(tilt_limit=limit), setup, PostureRange(), None))
    ends = intervals.ravel()[:, None] + np.array([-1e-6, -1e-9, 0.0, 1e-9, 1e-6])
    tilts = np.clip(np.concatenate([np.linspace(0, RIGHT, 181), ends.ravel()]), 0, RIGHT)
    cosine = np.cos(tilts) * (normal @ setup) + np.sin(tilts) * (tilt_direction @ setup)
    within = np.zeros(len(tilts), bool)
    for first_tilt, last_tilt in intervals:
        within |= (tilts >= first_tilt) & (tilts <= last_tilt)
    assert (cosine[within] >= bound - 1e-12).all()
    assert (cosine[~within] < bound + 1e-12).all()
    assert (intervals[:, 0] <= intervals[:, 1]).all()
    assert (intervals[1:, 0] > intervals[:-1, 1]).all()


def test_a_machine_of_three_axes_reaches_a_floor_up_to_its_wall():
    """At the limit 0 the one axis left is the setup axis: next to a wall some rotations still take it."""
    floor = shapes.plane((0, 20), (0, 20))
    wall = shapes.plane((0, 20), (0, 10), (0, 0, 0), (0, 1, 0), (-1, 0, 0))
    cutter = Cutter.flat(radius=3, length=30)
    result = plan(shapes.shell(floor, wall), cutters=[cutter], faces="1", grid=9, area_budget=0, machine=Machine.parse("tilt:0"))
    reach, y = result.reaches[cutter.id], result.samples.point[:, 1]
    assert not (reach.verdict[y > 0.1] == INACCESSIBLE).any()
    assert reach.axis[reach.reached][:, 2] == pytest.approx(1, abs=1e-12)


@st.composite
def triangles_by_the_body(draw):
    """A cylinder in its own frame (contact at x = radius, height 0) and a triangle that all but touches it."""
    radius, length, s = draw(cutters)
    height = near(s, length - s, 0.0, length / 2, -1.0, length + 1.0, 1e4, -1e4)
    out = near(0.0, radius - s, radius, (radius - s) / 2, 2 * radius, 1e4)
    turn = near(0.0, RIGHT, math.pi, -RIGHT)
    corners = [(radius, 0.0, 0.0)] if draw(st.booleans()) else []
    while len(corners) < 3:
        kind = draw(st.sampled_from(["free", "same", "above", "line"])) if corners else "free"
        r, a, z = draw(out), draw(turn), draw(height)
        if kind == "free":
            corner = (r * math.cos(a), r * math.sin(a), z)
        elif kind == "same":
            corner = corners[-1]
        elif kind == "above":  # an edge along the axis
            corner = (*corners[-1][:2], z)
        else:  # without area
            corner = tuple(2 * b - a for a, b in zip(corners[0], corners[-1], strict=True))
        corners.append(corner)
    order = draw(st.permutations(range(3)))
    return radius, length, s, np.array([corners[i] for i in order])


def stood(rng, tilt, radius, length, s):
    """A body in a frame at random, its pieces, and the frame: contact and the rows x_T, y_T, axis."""
    normal, direction = random_frame(rng)
    contact = rng.normal(0, 5, 3)
    axis, tilt_direction = posture(normal, direction, tilt, 0.3)
    body, left = np.empty(apart.BODY), np.cross(normal, tilt_direction)
    hit.stand(body, Frame(contact, normal, tilt_direction, left), math.cos(tilt), math.sin(tilt), radius, 0.0)
    return (
        body,
        waves.flat(radius, length, s).piece[0],
        contact,
        np.stack([math.cos(tilt) * tilt_direction - math.sin(tilt) * normal, left, axis]),
    )


#: Its plane holds the axis, and it is 1e4 times as long as wide: within the heights of the tool it is 100 mm away.
NEEDLE = (0.5, 3.0, 0.01, np.array([[0.0, 0, 0], [1e4 * math.cos(2), 1e4 * math.sin(2), 1], [0, 0, -1]]))


@pytest.mark.slow("draws many cases")
@given(triangles_by_the_body(), st.sampled_from([0.0, RIGHT, 0.4]), st.integers(0, 5))
@example(NEEDLE, 0.0, 0)
@settings(max_examples=400, deadline=None)
def test_a_triangle_hits_where_its_deepest_point_is_inside(case, tilt, seed):
    radius, length, s, local = case
    assume(s < length / 2)
    body, piece, contact, frame = stood(np.random.default_rng(seed), tilt, radius, length, s)
    triangle = contact + (local - [radius, 0, 0]) @ frame
    which, height, px, py = hit.triangle_hit(triangle[None].copy(), 0, body, piece, 1, 0.0, SCRATCH)
    allowed = ROUNDING * (radius + length + np.abs(local).max() + np.abs(contact).max())
    if which == 0:
        assert min(height - s, length - s - height, radius - s - math.hypot(px, py)) > -allowed
        assert distance_to_triangle(np.array([px, py, height]), local) < 10 * allowed
    else:
        assert deepest_in_cylinder(local, radius - s, s, length - s) < allowed


@pytest.mark.parametrize("deeper", [1e-11, 1e-9, 1e-6, -1e-11, -1e-9, -1e-6])
def test_a_triangle_at_a_bound_hits_from_the_first_hair(deeper):
    """Flat on the bottom, on the top, and upright along the wall."""
    radius, length, s = 3.0, 9.0, 0.01
    body, piece, _, frame = stood(np.random.default_rng(0), 0.4, radius, length, s)
    body[apart.P : apart.P + 3] = 0.0
    disk = np.array([[0.0, 1, 0], [1, -1, 0], [-1, -1, 0]])
    wall = np.array([[0.0, -1, 2], [0, 1, 2], [0, 0, 5]])
    up, out = np.array([0, 0, 1]), np.array([1, 0, 0])
    for local in (disk + (s + deeper) * up, disk + (length - s - deeper) * up, wall + (deeper + s - radius) * out):
        triangle = np.ascontiguousarray(((local - radius * out) @ frame)[None])
        assert (hit.triangle_hit(triangle, 0, body, piece, 1, 0.0, SCRATCH)[0] == 0) == (deeper > 0)


@pytest.mark.slow("draws many cases")
@given(triangles_by_the_body(), st.floats(1e-6, 0.3), st.integers(0, 3))
@settings(max_examples=300, deadline=None)
def test_a_miss_with_a_rate_is_a_miss_at_every_tilt_of_the_turn(case, rate, seed):
    radius, length, s, local = case
    assume(s < length / 2)
    body, piece, contact, frame = stood(np.random.default_rng(seed), 0.7, radius, length, s)
    triangle = np.ascontiguousarray((contact + (local - [radius, 0, 0]) @ frame)[None])
    if hit.tree_hit(waves.tree_of(triangle), body, piece, rate, -1, hit.scratch())[0] >= 0:
        return
    allowed = ROUNDING * (radius + length + np.abs(local).max())
    for turn in (-rate, -rate / 2, 0.0, rate / 3, rate):
        # Turning the tool about the contact along y_T is turning the triangle the other way.
        across, up = local[:, 0] - radius, local[:, 2]
        turned = local.copy()
        turned[:, 0] = radius + math.cos(turn) * across - math.sin(turn) * up
        turned[:, 2] = math.sin(turn) * across + math.cos(turn) * up
        assert deepest_in_cylinder(turned, radius - s, s, length - s) < allowed


@pytest.mark.parametrize("seed", range(4))
def test_the_tree_misses_no_needle_and_no_point(seed):
    """Nodes of triangles without area, along one line or in one point, have boxes without a normal of their own."""
    rng = np.random.default_rng(seed)
    kind, n = seed % 4, 60
    corner = rng.uniform(-12, 12, (n, 1, 3)) + np.zeros((n, 3, 3))
    if kind == 1:
        corner = corner + rng.uniform(-5, 5, (n, 3, 1)) * np.array([0, 0, 1.0])
    if kind == 2:
        corner = np.array([2.0, 3, 0]) + rng.uniform(-9, 9, (n, 3, 1)) * np.array([1e-9, 0, 1.0])
    if kind == 3:
        corner = corner * [1e-7, 1e-7, 1] + 1e-8 * rng.standard_normal((n, 3, 3))
    built, scratch, hits = waves.tree_of(corner), hit.scratch(), 0
    for _ in range(300):
        body, piece, _, _ = stood(rng, rng.uniform(0, RIGHT), 3.0, 9.0, 0.01)
        alone = [i for i in range(n) if hit.triangle_hit(built.vertex, i, body, piece, 1, 0.0, SCRATCH)[0] == 0]
        found = hit.tree_hit(built, body, piece, 0.0, -1, scratch)[0]
        assert found in alone if alone else found == -1
        hits += bool(alone)
    assert 5 < hits < 300


def test_contact_on_a_sharp_edge():
    """On a convex edge the cutter touches both faces and enters neither; on a concave one the wall is in the way."""
    piece = waves.flat(6.0, 30.0, 1e-9).piece[0]
    for angle, free in ((-RIGHT, True), (-0.1, True), (0.1, False), (RIGHT, False)):
        far = np.array([50 * math.cos(angle), 0, 50 * math.sin(angle)])
        edge = np.array([[0.0, -40, 0], [0, 40, 0]])
        faces = np.array([[*edge, [-50.0, 0, 0]], [*edge, far]])
        for rotation in (0.0, 0.5, RIGHT, 3.0, math.pi):
            for tilt in (0.0, 0.3, RIGHT):
                axis, tilt_direction = posture(np.array([0.0, 0, 1]), np.array([1.0, 0, 0]), tilt, rotation)
                body = np.empty(apart.BODY)
                left = np.cross([0.0, 0, 1], tilt_direction)
                hit.stand(body, Frame(np.zeros(3), np.array([0.0, 0, 1]), tilt_direction, left), math.cos(tilt), math.sin(tilt),
                          6.0, 0.0)  # fmt: skip
                hits = [hit.triangle_hit(faces, i, body, piece, 1, 0.0, SCRATCH)[0] == 0 for i in range(2)]
                assert not hits[0], "the face under the cutter"
                frame = np.stack([math.cos(tilt) * tilt_direction - [0, 0, math.sin(tilt)], left, axis])
                depth = deepest_in_cylinder(faces[1] @ frame.T + [6.0, 0, 0], 6.0, 0.0, 30.0)
                assert hits[1] == (depth > 1e-9) or abs(depth - 1e-9) < 1e-12
                if free:
                    assert not hits[1]


def depths(mesh, tolerance):
    """Depths in the triangles from which a posture is not safe, and surely blocked."""
    return tolerance - mesh.triangles.chord_error, tolerance + mesh.triangles.chord_error


@cache
def surface(seed, error=0.01):
    net = shapes.Patch.random(np.random.default_rng(seed), size=40.0, height=9.0, n=7)
    return Obstacles(tessellate(read_part(shapes.shell(net.face())), error))


def found_postures(obstacles, radius, length, depth, n=150, seed=0):
    """Random contacts and postures, and whether each is free."""
    rng = np.random.default_rng(seed)
    point = obstacles.triangles.vertex.reshape(-1, 3)[rng.integers(0, 3 * len(obstacles.triangles.vertex), n)]
    normal, axis, tilt_direction = np.empty((n, 3)), np.empty((n, 3)), np.empty((n, 3))
    for i in range(n):
        tip = np.array([*rng.normal(0, 0.3, 2), 1.0])
        normal[i] = tip / np.linalg.norm(tip)
        first = np.cross(normal[i], rng.standard_normal(3))
        axis[i], tilt_direction[i] = posture(normal[i], first / np.linalg.norm(first), rng.uniform(0, RIGHT), rng.uniform(0, 6.3))
    postures = (point + 0.05 * normal, normal, axis, tilt_direction)
    return postures, probed(obstacles, postures, radius, length, depth)


def probed(obstacles, postures, radius, length, depth):
    """Which postures no triangle reaches into deeper than `depth`."""
    n = len(postures[0])
    triangle = np.full(n, -2, np.int32)
    search.probe(np.arange(n), *postures, waves.flat(radius, length, depth), obstacles.tree, triangle, triangle.copy())
    return triangle == -1


@given(seed=st.integers(0, 3), radius=st.floats(1, 6), share=st.floats(0.05, 1), shorter=st.floats(0.2, 1))
@settings(max_examples=25, deadline=None)
def test_a_posture_of_a_cutter_serves_every_cutter_inside_it(seed, radius, share, shorter):
    """Same contact, axis and lean, smaller radius, no longer: at the same depth the one body lies in the other."""
    obstacles = surface(seed)
    postures, free = found_postures(obstacles, radius, 40.0, 0.01, seed=seed)
    inside = probed(obstacles, postures, radius * share, 40.0 * shorter, 0.01 + 1e-12)
    assert not (free & ~inside).any()


def test_where_a_posture_does_not_serve_another_cutter():
    """A longer cutter, and a smaller one under the same holder, which stands nearer to the contact: neither may inherit."""
    obstacles = surface(1)
    postures, free = found_postures(obstacles, 3.0, 12.0, 0.01, n=2000)
    assert (free & ~probed(obstacles, postures, 2.9, 60.0, 0.01)).sum() >= 3, "longer"
    hits, one = [], np.full((1, 3, 3), [2.5, 0.0, 40.0])
    for radius in (6.0, 4.0):
        body, up, across, left = np.empty(apart.BODY), np.eye(3)[2], np.eye(3)[0], np.eye(3)[1]
        hit.stand(body, Frame(np.zeros(3), up, across, left), 1.0, 0.0, radius, 0.0)
        held = assembly(Cutter.flat(radius=radius, length=30.0, holder="R8L30"), 0.0, 0.0).piece[0]
        hits.append(hit.triangle_hit(one, 0, body, held, 3, 0.0, SCRATCH)[0])
    assert hits == [-1, 1], "holder"


@pytest.mark.slow("another seed of the same law", but=("0",))
@pytest.mark.parametrize("seed", range(3))
def test_a_finer_tessellation_never_turns_safe_into_blocked(seed):
    """The same tolerance, meshes from coarse to fine: what one calls safe no other calls blocked."""
    tolerance, meshes = 0.1, [surface(seed, error) for error in (0.08, 0.03, 0.004)]
    errors = [mesh.triangles.chord_error for mesh in meshes]
    assert errors[2] < errors[1] < errors[0] < tolerance
    postures, _ = found_postures(meshes[0], 4.0, 30.0, 0.01, n=3000)
    verdicts = []
    for mesh in meshes:
        safe, blocked = (probed(mesh, postures, 4.0, 30.0, depth) for depth in depths(mesh, tolerance))
        assert not (safe & ~blocked).any()
        verdicts.append((safe, ~blocked))
    undecided = [int((~safe & ~blocked).sum()) for safe, blocked in verdicts]
    assert undecided[0] > undecided[1] > undecided[2]
    for safe, _ in verdicts:
        for _, blocked in verdicts:
            assert not (safe & blocked).any()


def test_results_are_the_same_bit_for_bit_whatever_the_thread_count(tmp_path):
    patch = shapes.Patch.random(np.random.default_rng(4), size=40.0, height=9.0, n=7)
    part, arrays = shapes.shell(patch.face()), []
    for jobs in (1, 3):
        # More samples than one chunk, so that the threads do share them out.
        plan(part, cutters=[Cutter.flat(radius=3, length=30)], grid=33, jobs=jobs, area_budget=0).write(
            tmp_path / str(jobs), ["npz"]
        )
        arrays.append(dict(np.load(tmp_path / str(jobs) / "samples.npz")))
    assert len(arrays[0]["verdict_R3L30"]) > 2 * 512
    assert len(set(arrays[0]["verdict_R3L30"].tolist())) > 1
    for other in arrays[1:]:
        assert other.keys() == arrays[0].keys()
        for name in other:
            assert other[name].tobytes() == arrays[0][name].tobytes(), name
