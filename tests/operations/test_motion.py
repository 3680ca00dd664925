"""Components of postures and forced steps: closed forms on made-up maps, and grooves and rods of which the answer is known."""

import math
from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from cad_io.arrays import FaceGrid
from plan_cutters import plan
from plan_cutters.domain.kinematics import Kinematics
from plan_cutters.domain.posture import tilt_direction
from plan_cutters.domain.verdicts import ACCESSIBLE
from plan_cutters.operations.forced_steps import RESOLUTION, Positions, forced_steps
from plan_cutters.operations.free_tilts import cells_of, holding, postures_of
from plan_cutters.operations.motion import components, motion
from plan_cutters.plan_file.operations import ForcedStepEntry, MotionEntry
from plan_cutters.plan_file.words.motion import motion as sentences
from plan_cutters.plan_file.words.motion import whatever_the_axes
from plan_cutters.scene.conditions import Context
from plan_cutters.stages.posture_maps import PostureMaps, posture_maps
from tests.support.places import SAMPLES
from tests.support.shapes import ridge

OPTIONS = {"area_budget": 0, "posture_maps": True, "operations": "fewest"}


def maps_of(normal, direction_max, free, k=36):
    """Maps with the intervals `free(sample, rotation in deg)`, deg."""
    n, rotations = len(normal), np.arange(k) * (2.0 * math.pi / k)
    cells = [free(i, round(math.degrees(turn))) for i in range(n) for turn in rotations]
    offset = np.concatenate([[0], np.cumsum([len(each) for each in cells])]).astype(np.int64)
    flat = np.radians(np.array([pair for each in cells for pair in each], float).reshape(-1, 2))
    verdict = np.full(n, ACCESSIBLE, np.uint8)
    return PostureMaps(rotations, offset, flat, np.zeros((n, k), np.float32), np.asarray(normal, float),
                       np.asarray(direction_max, float), verdict, np.full(n, 255, np.uint8), (0.0, math.pi / 2), 0.01, "T",
                       "")  # fmt: skip


def count(maps, edge):
    return [len(np.unique(each)) for each in components(maps, np.asarray(edge, np.int64).reshape(-1, 2))]


def level(n):
    return np.tile((0.0, 0.0, 1.0), (n, 1)), np.tile((1.0, 0.0, 0.0), (n, 1))


def test_windows_that_overlap_from_rotation_to_rotation_are_one_and_others_are_not():
    whole = maps_of(*level(1), lambda i, turn: [(10.0, 30.0)])
    halves = maps_of(*level(1), lambda i, turn: [(10.0, 30.0)] if turn < 90 or 180 <= turn < 270 else [])
    apart = maps_of(*level(1), lambda i, turn: [(10.0, 20.0), (30.0, 40.0)])
    step = maps_of(*level(1), lambda i, turn: [(10.0, 20.0)] if turn < 180 else [(21.0, 40.0)])
    assert [count(each, [])[0] for each in (whole, halves, apart, step)] == [1, 2, 2, 2]


@given(st.floats(0.0, 2.0 * math.pi), st.integers(0, 2**31))
@settings(max_examples=30, deadline=None)
def test_frames_that_are_turned_about_their_normals_change_nothing(angle, seed):
    """The direction from which rotations count jumps at umbilics: joins compare axes. Rotations of maps are 10 deg apart."""
    turn = math.radians(10.0) * round(math.degrees(angle) / 10.0)
    window = np.random.default_rng(seed).integers(0, 36, 2)
    normal, first = level(2)
    turned = first.copy()
    turned[1] = (math.cos(turn), math.sin(turn), 0.0)

    def free(shift):
        inside = lambda i, at: (at // 10 + (shift if i else 0)) % 36 in set(window.tolist())  # noqa: E731
        return lambda i, at: [(20.0, 40.0)] if inside(i, at) else []

    straight = components(maps_of(normal, first, free(0)), np.array([[0, 1]]))
    other = components(maps_of(normal, turned, free(round(math.degrees(turn) / 10.0))), np.array([[0, 1]]))
    for one, two in zip(straight, other, strict=True):
        assert len(np.unique(one)) == len(np.unique(two))


@given(st.integers(0, 2**31))
@settings(max_examples=40, deadline=None)
def test_what_holds_a_tilt_is_found_as_by_looking_at_every_interval(seed):
    rng = np.random.default_rng(seed)
    ends = np.sort(rng.uniform(0.0, 90.0, (3 * 36, 4)), axis=1).reshape(-1, 2, 2)
    kept = rng.integers(0, 3, 3 * 36)
    maps = maps_of(*level(3), lambda i, turn: ends[i * 36 + turn // 10][: kept[i * 36 + turn // 10]].tolist())
    row, tilt, rotation = rng.integers(0, 3, 50), rng.uniform(0.0, 1.6, 50), rng.uniform(0.0, 2.0 * math.pi, 50)
    lean = tilt_direction(maps.normal[row], maps.direction_max[row], rotation)
    axis = np.cos(tilt)[:, None] * maps.normal[row] + np.sin(tilt)[:, None] * lean
    found, cell = holding(maps, row, *postures_of(maps, row, axis)), cells_of(maps)
    for i in range(50):
        for side in (0, 1):
            j = (math.floor(math.degrees(rotation[i]) / 10.0) + side) % 36
            mine = [m for m in range(len(cell)) if cell[m] == row[i] * 36 + j]
            holds = [m for m in mine if maps.free[m, 0] <= tilt[i] <= maps.free[m, 1]]
            assert found[i, side] == (holds[0] if holds else -1)


def test_strict_joins_never_join_more_than_loose_ones():
    rng = np.random.default_rng(3)
    normal = rng.normal(size=(30, 3)) * 0.1 + (0.0, 0.0, 1.0)
    normal /= np.linalg.norm(normal, axis=1)[:, None]
    first = np.cross((0.0, 1.0, 0.0), normal)
    first /= np.linalg.norm(first, axis=1)[:, None]
    low = rng.uniform(5.0, 40.0, (30, 36))
    maps = maps_of(normal, first, lambda i, turn: [(low[i, turn // 10], low[i, turn // 10] + 8.0)])
    loose, strict = components(maps, np.column_stack([np.arange(29), np.arange(1, 30)]))
    assert len(np.unique(np.column_stack([loose, strict]), axis=0)) == len(np.unique(strict)) > len(np.unique(loose))


def test_a_groove_alone_has_two_ways_to_lean():
    """On the bottom line no posture is free at rotations between 52.24 and 127.76 deg: it leans to the one side or the other."""
    result = plan(SAMPLES / "v_groove.step", cutters="R8L90", faces="F2", grid=11, tolerance=0.002, **OPTIONS)
    maps, samples = result.maps, result.samples
    edge = samples.neighbours.astype(np.int64)
    loose, _ = components(maps, edge)
    sample = cells_of(maps) // len(maps.rotations)
    away = np.abs(samples.point[:, 1]) < 100.0
    inner, _ = components(maps, edge[away[edge].all(axis=1)])
    middle = sample == int(np.linalg.norm(samples.point, axis=1).argmin())
    # Beyond its open ends the tool may turn about: they are left out.
    assert len(np.unique(inner[middle])) == 2
    found = result.plan.operations.motion
    assert found.components == len(np.unique(loose))
    assert (found.needed, found.outside, found.without) == (1, 0, 0)
    assert found.largest_share == pytest.approx(1.0)


@pytest.mark.slow("maps the postures of all of a groove")
def test_with_its_planes_the_groove_is_one():
    result = plan(SAMPLES / "v_groove.step", cutters="R8L90", grid=7, tolerance=0.002, **OPTIONS)
    found = result.plan.operations.motion
    assert (found.needed, found.outside) == (1, 0)
    assert found.components_strict >= found.components


def test_postures_over_a_convex_solid_are_one():
    found = plan(ridge(10.0, 10.0), cutters="R1L60rc1", grid=9, **OPTIONS).plan.operations.motion
    assert (found.components, found.components_strict, found.needed, found.outside) == (1, 1, 1, 0)


def test_without_maps_there_is_no_motion_and_with_some_samples_left_out_it_is_said():
    bare = plan(ridge(10.0, 10.0), cutters="R1L60rc1", grid=5, operations="fewest", area_budget=0)
    assert bare.plan.operations.motion is None
    assert "motion" not in bare.plan.run.seconds
    few = plan(ridge(10.0, 10.0), cutters="R1L60rc1", grid=5, map_budget=8, **OPTIONS)
    assert few.plan.operations.motion is None
    assert any("were not mapped" in note for note in few.plan.operations.notes)


def test_an_empty_map_has_no_components():
    result = plan(ridge(10.0, 10.0), cutters="R1L60rc1", grid=5, **OPTIONS)
    maps = posture_maps(result.samples, Context.of(result.judged(), result.conditions), result.reaches[result.shown])
    none = maps_of(maps.normal, maps.direction_max, lambda i, turn: [])
    found = motion(none, result.ready)
    assert (found.components, found.needed, found.largest_share) == (0, 0, 0.0)
    assert found.without == len(maps.normal)


# Forced steps

TRUNNION = np.array([[-math.inf, math.inf], [math.radians(-30.0), math.radians(120.0)]])


def machine(limit=TRUNNION):
    return Kinematics(np.array([[0.0, 0.0, 1.0], [1.0, 0.0, 0.0]]), limit, np.array([0.0, 0.0, 1.0]))


def rod(n, lean):
    """Maps of samples around a rod along Z, each with one axis, so many deg from Z outwards; and their grid line."""
    turn = np.arange(n) * (2.0 * math.pi / n)
    normal = np.column_stack([np.cos(turn), np.sin(turn), np.zeros(n)])
    up = np.tile((0.0, 0.0, 1.0), (n, 1))
    maps = maps_of(normal, up, lambda i, at: [(90.0 - lean, 90.0 - lean)] if at == 0 else [])
    grid = FaceGrid(1, np.arange(n, dtype=float), np.zeros(1), np.arange(n, dtype=np.int32)[:, None], True, False,
                    (0.0, 1.0, 0.0, 1.0))  # fmt: skip
    return maps, SimpleNamespace(grids=(grid,), face=np.ones(n, np.int32))


@pytest.mark.parametrize("n", [12, 20, 24])
def test_around_a_rod_the_table_turns_by_its_share_of_a_turn(n):
    maps, samples = rod(n, 60.0)
    (found,) = forced_steps(maps, samples, machine(), np.ones(n, bool))
    assert found.along == "u"
    assert found.deg == pytest.approx(360.0 / n, abs=RESOLUTION)
    assert found.turning_deg == found.deg


def test_where_the_table_has_one_turn_alone_it_must_flip_over_or_turn_back():
    """A table that ends after a turn: the way around a rod begins in its middle, so one step goes all the way back or flips."""
    n = 24
    maps, samples = rod(n, 60.0)
    limit = np.array([[-math.pi, math.pi], [math.radians(-30.0), math.radians(120.0)]])
    (free,) = forced_steps(maps, samples, machine(), np.ones(n, bool))
    (held,) = forced_steps(maps, samples, machine(limit), np.ones(n, bool))
    wide = np.array([[-2.0 * math.pi, 2.0 * math.pi], limit[1]])
    (turns,) = forced_steps(maps, samples, machine(wide), np.ones(n, bool))
    flip = np.array([limit[0], [math.radians(-120.0), math.radians(120.0)]])
    (both,) = forced_steps(maps, samples, machine(flip), np.ones(n, bool))
    assert held.deg > 300.0
    assert turns.deg == free.deg
    # The other solution is half a turn of the table and twice the lean away.
    assert free.deg < both.deg <= 180.0 + RESOLUTION


def test_near_the_direction_of_the_table_its_turns_are_told_apart():
    """Axes that lean by 1 deg only: the table turns by 15 deg from sample to sample, but the tool hardly does."""
    maps, samples = rod(24, 1.0)
    (found,) = forced_steps(maps, samples, machine(), np.ones(24, bool))
    assert found.deg <= RESOLUTION
    assert found.turning_deg == pytest.approx(15.0, abs=RESOLUTION)


def test_a_window_that_all_samples_share_forces_nothing():
    maps, samples = rod(24, 60.0)
    shared = maps_of(maps.normal, maps.direction_max, lambda i, at: [(5.0, 90.0)])
    (found,) = forced_steps(shared, samples, machine(), np.ones(24, bool))
    assert found.turning_deg == 0.0


def test_a_line_ends_where_a_sample_has_no_posture():
    n = 24
    maps, samples = rod(n, 60.0)
    reached = np.arange(n) % 2 == 0
    assert forced_steps(maps, samples, machine(), reached) == []


@given(st.integers(0, 2**31))
@settings(max_examples=25, deadline=None)
def test_the_forced_step_is_that_of_the_best_path_by_brute_force(seed):
    """A line of few positions each: all paths are tried."""
    rng = np.random.default_rng(seed)
    grid = Positions.of(machine(np.array([[-math.pi, math.pi], TRUNNION[1]])))
    shape, spots, bits = grid.axis.shape[:2], [], []
    for _ in range(4):
        mine = np.column_stack([rng.integers(0, shape[0], 3), rng.integers(0, shape[1], 3)])
        mark = np.zeros(shape, np.uint8)
        mark[mine[:, 0], mine[:, 1]] = 1
        spots.append(mine)
        bits.append(mark)
    least = {tuple(each): 0 for each in spots[0].tolist()}
    for mine in spots[1:]:
        least = {
            tuple(each): min(max(cost, abs(each[0] - a), abs(each[1] - b)) for (a, b), cost in least.items())
            for each in mine.tolist()
        }
    answer = min(least.values())
    assert not grid.forces(bits, answer, cone=True)
    assert answer == 0 or grid.forces(bits, answer - 1, cone=True)


@given(st.integers(0, 2**31), st.sampled_from([(-720.0, 0.0), (0.0, 720.0), (-360.0, 360.0), (-200.0, 100.0), (-2000.0, 2000.0)]))
@settings(max_examples=25, deadline=None)
def test_each_position_of_the_grid_is_marked_by_its_own_axis_in_whatever_turn_it_lies(seed, limit):
    """And all that is marked has that axis, as near as the grid is fine."""
    grid = Positions.of(machine(np.array([np.radians(limit), TRUNNION[1]])))
    rng = np.random.default_rng(seed)
    for _ in range(4):
        i, j = int(rng.integers(0, grid.axis.shape[0])), int(rng.integers(0, grid.axis.shape[1]))
        bits = np.zeros(grid.axis.shape[:2], np.uint8)
        grid._mark(bits, grid.axis[i, j][None])
        off = np.degrees(np.arccos(np.clip(grid.axis[bits > 0] @ grid.axis[i, j], -1.0, 1.0)))
        assert off.max() <= 1.5 * RESOLUTION
        if not grid.cone[j]:
            assert bits[i, j]
            # Each whole turn within the limits is another position.
            turns = grid.first[(np.abs((grid.first - grid.first[i] + 180.0) % 360.0 - 180.0) < 0.5 * RESOLUTION)]
            assert bits[:, j].sum() >= len(turns)


# Sentences


def entry(**more):
    known = {"cutter": "R6L80", "components": 3, "components_strict": 3, "largest_share": 0.5, "needed": 2, "needed_at_least": 2,
             "outside": 7, "without": 0, "forced_steps": [], "resolution_deg": RESOLUTION}  # fmt: skip
    return MotionEntry(**known | more)


def step(**more):
    known = {"along": "u", "deg": 3.0, "turning_deg": 3.0, "face": "F1", "looked_at": 4, "lines": 4}
    return ForcedStepEntry(**known | more)


@pytest.mark.parametrize(
    ("found", "words"),
    [
        (entry(), ["estimate", "3 parts", "50 %", "7 samples", "2 of them together touch"]),
        (entry(components=1, needed=1, outside=0), ["estimate", "hang together"]),
        (entry(components=0, components_strict=0), ["nothing can be estimated"]),
        (entry(components_strict=9), ["By strict joins there are 9 parts"]),
        (entry(needed_at_least=1), ["2 of them, at least 1, together"]),
        (entry(forced_steps=[step(deg=90.0, turning_deg=90.0, lines=9)]), ["4 of 9 grid lines along u", "90 deg", "F1"]),
        (entry(forced_steps=[step(turning_deg=60.0)]), ["the first rotary axis turns by 60 deg"]),
    ],
)
def test_sentences_say_what_was_found_and_that_it_is_an_estimate(found, words):
    text = "\n".join(sentences(found))
    assert all(word in text for word in words), text
    assert "must turn" not in text or any(each.deg >= 15.0 for each in found.forced_steps)


@pytest.mark.parametrize(
    ("found", "least", "words"), [(5, 5, "No other axes"), (5, 3, "no fewer than 3"), (5, 2, ""), (1, 1, ""), (2, 1, "")]
)
def test_the_bound_over_all_axes_is_told_where_it_says_something(found, least, words):
    few = SimpleNamespace(found=found, at_least_any=least)
    text = "".join(whatever_the_axes(few))
    assert words in text
    assert bool(text) == bool(words)
