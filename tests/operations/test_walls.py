"""Floors under the flat of the tip and walls along the flutes: strips, times and what is claimed, by closed forms."""

import math
from dataclasses import replace

import cadquery as cq
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from cad_io.arrays import Triangles
from plan_cutters import plan
from plan_cutters.domain.cutter import Cutter
from plan_cutters.domain.operations import STRATEGIES
from plan_cutters.kernels.linear import sections as rulings
from plan_cutters.kernels.linear.sections import OneFace, extents
from plan_cutters.operations.passes import Extents, Paths, flank_of, flat_of
from plan_cutters.operations.probes import Probes
from plan_cutters.operations.walls import Walls
from plan_cutters.options import Options
from plan_cutters.pipeline import prepare
from plan_cutters.scene.obstacles import Obstacles
from plan_cutters.scene.surroundings import Surroundings
from tests.support import waves
from tests.support.cad_parts import box, rod
from tests.support.places import real_file

FEED = 1000.0
#: A block on a table, with tools that reach all of its sides from above.
OPTIONS = {"faces": "all", "area_budget": 0, "feed": FEED, "machine": "trunnion-ac", "grid": 9, "fixtures": "table"}
WALL = STRATEGIES.index("wall")


def planned(shape, cutter, **more):
    return plan(shape, cutters=cutter, **{**OPTIONS, "operations": "fastest", **more})


@pytest.mark.slow("another cutter of the same law", but=("D12L60F26",))
@pytest.mark.parametrize(("cutter", "height"), [("D12L60F26", 20.0), ("D12L60F60", 50.0)])
def test_a_block_takes_the_seconds_of_its_top_and_of_passes_along_its_sides(cutter, height):
    """The top in passes 0.75 of the flat of the tip apart, each side in passes as high as the flutes: one orientation, A 0."""
    made = Cutter.parse(cutter)
    found = planned(box(60.0, 40.0, height), cutter).plan.operations.plans[0]
    assert [list(each.angles_deg.values()) for each in found.operations] == [[0.0, 0.0]]
    flat = flat_of(made)
    top = min(length * (1.0 + math.ceil((width - flat) / (0.75 * flat))) for length, width in ((60.0, 40.0), (40.0, 60.0)))
    sides = 2.0 * (60.0 + 40.0)
    assert found.cutting_seconds == pytest.approx((top + sides) * 60.0 / FEED, rel=0.01)


def overhung():
    """A pocket whose walls stand over it by 0.02 deg: a shank as wide as the flutes meets them above a strip."""
    return cq.Workplane().box(90, 60, 20).cut(cq.Workplane().workplane(offset=10).rect(60, 24).extrude(-14, taper=-0.02)).val()


@pytest.mark.slow("plans each proposed clamping", only=("overhung",))
@pytest.mark.parametrize(("shape", "cutter"), [(lambda: box(30.0, 30.0, 40.0), "D10L60rc1F15"), (overhung, "D12L45F10S12")])
def test_each_sample_of_a_wall_lies_along_the_flutes_at_its_contact(shape, cutter):
    cutter = Cutter.parse(cutter)
    result = planned(shape(), cutter, fixtures=())
    found, samples = result.answers.operations.plans[0], result.samples
    mine = np.flatnonzero(found.strategy == WALL)
    assert len(mine)
    begins, length = flank_of(cutter)
    for row in mine.tolist():
        axis = found.operations[found.label[row]].axis
        above = float((samples.point[row] - found.contact[row]) @ axis)
        assert -1e-6 <= above <= found.strip[row] + 1e-6
        assert found.strip[row] <= length + 1e-9
        across = samples.point[row] - found.contact[row] - above * axis
        assert np.linalg.norm(across) <= 0.01
    assert np.isnan(found.contact[found.strategy != WALL]).all()
    assert begins == cutter.corner_radius


def test_a_wall_that_leans_more_than_the_axes_are_accurate_is_cut_in_points():
    leaning = rod(10.0, 10.0)
    tilted = planned(leaning, "D12L60F26", machine="tilt:0", setup=(math.sin(0.01), 0.0, math.cos(0.01)), fixtures=())
    straight = planned(leaning, "D12L60F26", machine="tilt:0", setup=(0.0, 0.0, 1.0), fixtures=())
    assert (straight.answers.operations.plans[0].strategy == WALL).any()
    side = np.abs(tilted.samples.normal[:, 1]) > 0.9
    assert side.any()
    walls = tilted.answers.operations.plans[0].strategy == WALL
    # Where the side of the cylinder leans with the axis it is off it by 0.57 deg; across that it is not.
    assert not walls[np.abs(tilted.samples.normal[:, 0]) > 0.9].any()


def test_a_tool_whose_flutes_end_with_its_corner_has_no_flank():
    assert flank_of(Cutter.ball(radius=5, length=40, flutes=5.0)) is None


def test_no_tip_but_a_flat_one_lies_on_a_floor():
    assert flat_of(Cutter.ball(radius=5, length=40)) == 0.0
    assert flat_of(Cutter.lens(radius=6, bottom_radius=60, corner_radius=1, length=40)) == 0.0


def alone(vertex):
    """Triangles (n, 3, 3) as those of face 1, with no others."""
    return OneFace(waves.tree_of(np.asarray(vertex)), np.ones(len(vertex), np.int32), 1)


def among_all(point, ruling, normal, own, band):
    """The slow twin of `extents` for one line: every triangle of the face is looked at."""
    side, ends, limit = np.cross(ruling, normal), np.empty((2, 2)), np.array([-np.inf, np.inf])
    first, last = np.inf, -np.inf
    for triangle in own.tree.vertex[own.faces == own.number]:
        if rulings._piece(triangle, point, ruling, normal, side, ends) and rulings._clipped(ends, band, limit):
            first, last = min(first, ends[0, 0]), max(last, ends[1, 0])
    return (min(0.0, max(first, limit[0])), max(0.0, min(last, limit[1]))) if first <= last else (np.nan, np.nan)


def test_a_face_ends_along_a_line_where_its_triangles_do_and_where_it_leaves_the_line():
    flat = np.array([[[0.0, 0, 0], [10, 0, 0], [0, 10, 0]]])
    low, high = np.empty((2, 1))
    start = np.array([[2.0, 3.0, 0.0]])
    extents(start, np.array([[1.0, 0, 0]]), np.array([[0.0, 0, 1]]), alone(flat), 0.01, low, high)
    assert (low[0], high[0]) == pytest.approx((-2.0, 5.0))
    # From x = 4 on it rises by a tenth: it leaves the band after 0.1 mm.
    bent = np.array([[[0.0, 0, 0], [4, 0, 0], [4, 10, 0]], [[0, 0, 0], [4, 10, 0], [0, 10, 0]],
                     [[4, 0, 0], [9, 0, 0.5], [9, 10, 0.5]], [[4, 0, 0], [9, 10, 0.5], [4, 10, 0]]])  # fmt: skip
    extents(start, np.array([[1.0, 0, 0]]), np.array([[0.0, 0, 1]]), alone(bent), 0.01, low, high)
    assert (low[0], high[0]) == pytest.approx((-2.0, 2.1))
    extents(start, np.array([[1.0, 0, 0]]), np.array([[0.0, 0, 1]]), alone(flat)._replace(number=2), 0.01, low, high)
    assert np.isnan(low[0])
    assert np.isnan(high[0])


@given(st.integers(0, 2**31), st.floats(-500.0, 500.0))
@settings(max_examples=60, deadline=None)
def test_a_face_goes_as_far_wherever_it_stands_and_whatever_lies_beside_the_line(seed, far):
    """Triangles that lie on one side of the plane through the line are not looked at: that changes nothing."""
    rng = np.random.default_rng(seed)
    x = np.sort(rng.uniform(-5.0, 5.0, 9))
    heights = rng.normal(0.0, 0.01, 9)
    sheet = [[[x[k], side, heights[k]], [x[k + 1], side, heights[k + 1]], [x[k + 1], 0.0, heights[k + 1]]]
             for k in range(8) for side in (-3.0, 3.0)]  # fmt: skip
    beside = rng.uniform([-9.0, 1e-6, -1.0], [9.0, 4.0, 1.0], (20, 3, 3))
    turn = Rotation.random(random_state=seed).as_matrix()
    low, high = np.empty((2, 3, 1))
    for k, (some, moved) in enumerate([(sheet, False), ([*sheet, *beside], False), ([*sheet, *beside], True)]):
        frame, place = (turn, far * np.ones(3)) if moved else (np.eye(3), np.zeros(3))
        start = np.array([[0.0, 0.0, 0.0]]) @ frame.T + place
        own = alone(np.array(some) @ frame.T + place)
        extents(start, frame[:, [0]].T.copy(), frame[:, [2]].T.copy(), own, 0.05, low[k], high[k])
    assert low[:, 0] == pytest.approx(low[0, 0], abs=1e-6, nan_ok=True)
    assert high[:, 0] == pytest.approx(high[0, 0], abs=1e-6, nan_ok=True)


@given(st.integers(0, 2**31), st.sampled_from([0.0, 1e-6, 0.01, 0.3]), st.booleans())
@settings(max_examples=40, deadline=None)
def test_a_face_ends_where_it_does_among_all_of_its_triangles(seed, band, exact):
    """Bit for bit: waves and steps, another face through them, lines through corners, and along sides, of triangles."""
    rng = np.random.default_rng(seed)
    x, y = np.meshgrid(np.arange(9.0), np.arange(9.0), indexing="ij")
    height = np.where(exact, np.rint(rng.normal(0.0, 0.4, x.shape)) * 0.25, rng.normal(0.0, 0.02, x.shape))
    grid = np.stack([x, y, height], axis=-1)
    a, b, c, d = grid[:-1, :-1], grid[1:, :-1], grid[1:, 1:], grid[:-1, 1:]
    vertex = np.concatenate([np.stack(each, axis=2).reshape(-1, 3, 3) for each in ((a, b, c), (a, c, d))])
    # A corner lies in the plane of a line, or next to it.
    start = grid[rng.integers(9, size=20), rng.integers(9, size=20)] + rng.choice([0.0, 0.0, 1e-9, 0.3], (20, 3))
    turn = 2.0 * np.pi * (rng.integers(4, size=20) / 4.0 if exact else rng.random(20))
    ruling, up = np.stack([np.cos(turn), np.sin(turn), np.zeros(20)], axis=1), np.tile([0.0, 0.0, 1.0], (20, 1))
    if not exact:
        frame = Rotation.random(random_state=seed).as_matrix()
        vertex, start, ruling, up = (each @ frame.T for each in (vertex, start + 300.0, ruling, up))
        vertex = vertex + 300.0 * frame.sum(axis=1)
    built = Obstacles(Triangles(np.ascontiguousarray(vertex), rng.integers(1, 3, len(vertex)).astype(np.int32), 0.0, ()))
    own = OneFace(built.tree, built.faces, 1)
    low, high = np.empty((2, 20))
    extents(*map(np.ascontiguousarray, (start, ruling, up)), own, band, low, high)
    assert np.isfinite(low).any() or band < 0.3
    np.testing.assert_array_equal(
        np.array([low, high]).T, [among_all(*line, own, band) for line in zip(start, ruling, up, strict=True)]
    )


def test_strategies_stand_in_the_operations_and_in_the_process():
    result = planned(box(60.0, 40.0, 20.0), "D12L60F26").plan
    assert [each.strategy for each in result.operations.plans[0].operations] == ["mixed"]
    assert [each.strategy for each in result.process.steps] == ["mixed"]
    top = planned(box(60.0, 40.0, 20.0), "D12L60F26", faces="F6").plan
    assert [each.strategy for each in top.process.steps] == ["floor"]


@pytest.mark.slow("plans each proposed clamping")
def test_above_the_most_orientations_simultaneous_motion_is_recommended():
    found = planned(rod(10.0, 10.0), "D6L60rc3F3", fixtures=(), max_orientations=1).plan.operations
    (fastest,) = (each for each in found.plans if each.name == "fastest")
    assert fastest.orientations <= 1
    assert any(each.mode == "simultaneous" for each in fastest.operations)
    assert any("simultaneous motion is recommended" in note for note in found.notes)


@pytest.mark.parametrize(("height", "there"), [(0.000002, False), (0.009, False), (0.02, True)])
def test_a_wall_is_higher_than_the_scallop(height, there):
    """The side of a block, of which triangles leave a low band about one sample."""
    options = Options.of({"faces": "all", "machine": "trunnion-ac", "cutters": "D10L60F15", "grid": 5})
    ready = prepare(box(30.0, 30.0, 40.0), options)
    samples = ready.samples
    row = int(np.flatnonzero(samples.normal[:, 0] > 0.99)[12])
    x, y, z = samples.point[row]
    low, high = z - 0.5 * height, z + 0.5 * height
    band = np.array([[[x, y - 5, low], [x, y + 5, low], [x, y + 5, high]], [[x, y - 5, low], [x, y + 5, high], [x, y - 5, high]]])
    obstacles = Obstacles(Triangles(band, np.full(2, samples.face[row]), 0.0, ()))
    alone = replace(ready.conditions, surroundings=Surroundings.sheet(obstacles))
    probes = Probes(samples, ready.cutters, [alone], ready.machinable)
    paths = Paths(options.scallop, options.stepover, None, options.accuracy, Extents(samples, obstacles))
    walls = Walls(probes, paths)
    (strip,) = walls.passes(0, 0, np.array([0.0, 0.0, 1.0]), np.array([row])).strip
    assert np.isfinite(strip) == there
    assert not there or strip == pytest.approx(height)


@pytest.mark.slow("searches long")
def test_no_wall_of_a_real_case_is_lower_than_the_scallop():
    """Where a rounded corner of a phone's case ends, the flutes meet it over 0.000002 mm: a pass of that height takes hours."""
    options = Options.of(
        {"faces": "F47,F86", "machine": "trunnion-ac", "setup": (0, 0, -1), "cutters": "D6L40F16S6", "spacing": 6}
    )
    ready = prepare(real_file("cad/hard/jack_phone.igs"), options)
    extents = Extents(ready.samples, ready.conditions.obstacles)
    paths = Paths(options.scallop, options.stepover, None, options.accuracy, extents)
    walls = Walls(Probes(ready.samples, ready.cutters, ready.setups, ready.machinable), paths)
    strip = walls.passes(0, 0, np.array([0.0, 0.0, -1.0]), np.arange(len(ready.samples))).strip
    assert np.isfinite(strip).any()
    assert np.nanmin(strip) > options.scallop
