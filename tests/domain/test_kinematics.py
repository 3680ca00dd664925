"""Machines: the chain forward and back, limits as circles, allowed tilts against a dense scan, and machines that cannot be."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from plan_cutters.domain.kinematics import PARALLEL, Kinematics
from plan_cutters.domain.machine import Axis, Machine, builtin_machines
from plan_cutters.domain.placement import frame_of
from plan_cutters.errors import MachineError
from plan_cutters.kernels import limits
from plan_cutters.kernels.jit import entry
from plan_cutters.scene.conditions import rotary_of

FIVE = [name for name, machine in builtin_machines().items() if len(machine.rotary) == 2]
UP = np.array([0.0, 0.0, 1.0])


def of(name, setup=UP):
    return builtin_machines()[name].kinematics(frame_of(setup))


def chain(seed):
    """A random machine: axes at any angle, limits of any width."""
    rng = np.random.default_rng(seed)
    while True:
        first, second, tool = (v / np.linalg.norm(v) for v in rng.normal(size=(3, 3)))
        if min(np.linalg.norm(np.cross(first, second)), np.linalg.norm(np.cross(second, tool))) > 0.05:
            break
    low = rng.uniform(-math.pi, 0.5, 2)
    limit = np.stack([low, low + rng.uniform(0.05, 2 * math.pi, 2)], axis=1)
    limit[rng.random(2) < 0.2] = (-math.inf, math.inf)
    return Kinematics(np.array([first, second]), limit, tool)


def directions(rng, count):
    found = rng.normal(size=(count, 3))
    return found / np.linalg.norm(found, axis=1)[:, None]


def by_matrices(found, angle):
    """The tool axis by matrices of the exponential series' closed form, one by one."""
    vector = found.tool
    for k in (1, 0):
        x, y, z = found.direction[k]
        cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
        vector = (np.eye(3) + math.sin(angle[k]) * cross + (1 - math.cos(angle[k])) * cross @ cross) @ vector
    return vector


@pytest.mark.parametrize("name", [*FIVE, *range(10)])
def test_forward_of_inverse_is_the_axis(name):
    found = chain(name) if isinstance(name, int) else of(name)
    free = Kinematics(found.direction, np.full((2, 2), (-math.inf, math.inf)), found.tool)
    axis = directions(np.random.default_rng(1), 100_000)
    angle = free.angles(axis)
    held = np.isfinite(angle).all(axis=2)
    assert (held[:, 0] == held[:, 1]).all()
    assert held.any()
    for i in range(2):
        assert np.abs(free.axis(angle[held[:, i], i]) - axis[held[:, i]]).max() < 1e-12
    # What no angles hold is out of reach of the second axis.
    along = axis @ free.direction[0]
    _, most, base = free.swing
    assert (held[:, 0] == (np.abs(along - base) <= most)).all()


@pytest.mark.parametrize("name", [*FIVE, *range(10)])
def test_the_chain_is_that_of_matrices(name):
    found = chain(name) if isinstance(name, int) else of(name)
    angle = np.random.default_rng(2).uniform(-4, 4, (50, 2))
    assert np.abs(found.axis(angle) - [by_matrices(found, each) for each in angle]).max() < 1e-14


@pytest.mark.parametrize("name", [*FIVE, *range(10)])
def test_what_angles_within_the_limits_make_is_allowed(name):
    """And one of the two solutions is those angles, up to whole turns."""
    found = chain(name) if isinstance(name, int) else of(name)
    low, high = np.clip(found.limit, -7, 7).T
    angle = np.random.default_rng(3).uniform(low, high, (20_000, 2))
    axis = found.axis(angle)
    both, taken, _ = found.positions(axis)
    assert (taken >= 0).all()
    away = np.abs(np.remainder(both - angle[:, None] + math.pi, 2 * math.pi) - math.pi).max(axis=2)
    sine = np.linalg.norm(np.cross(axis, found.direction[0]), axis=1)
    assert (np.nanmin(away, axis=1) < 1e-6 / np.maximum(sine, 1e-9) + 1e-6).all()
    chosen = both[np.arange(len(taken)), taken]
    assert ((chosen >= found.limit[:, 0] - 2e-9) & (chosen <= found.limit[:, 1] + 2e-9)).all()
    assert np.abs(found.axis(chosen) - axis).max() < 1e-8


@entry
def tilts(n, f, rotary, low, high, intervals):
    intervals[0, 0], intervals[0, 1] = low, high
    return limits.hold(n, f, rotary, intervals, 1)


def allowed(found, n, f, low=0.0, high=math.pi):
    room = np.empty((128, 2))
    return room[: tilts(n, f, rotary_of(found), low, high, room)].copy()


@pytest.mark.parametrize("name", [*FIVE, *range(60)])
def test_allowed_tilts_against_a_dense_scan(name):
    found = chain(name) if isinstance(name, int) else of(name)
    rng = np.random.default_rng(4)
    tilt = np.linspace(0, math.pi, 4001)
    for n in directions(rng, 12):
        f = np.cross(n, directions(rng, 1)[0])
        f /= np.linalg.norm(f)
        intervals = allowed(found, n, f)
        assert (np.diff(intervals.ravel()) >= 0).all()
        held = found.allows(np.cos(tilt)[:, None] * n + np.sin(tilt)[:, None] * f)
        inside = ((tilt[:, None] >= intervals[:, 0]) & (tilt[:, None] <= intervals[:, 1])).any(axis=1)
        near = (np.abs(tilt[:, None] - intervals.ravel()) < 1e-8).any(axis=1) if len(intervals) else np.zeros(len(tilt), bool)
        assert (held == inside)[~near].all()
        # Just beyond each end, and just within it.
        for low, high in intervals:
            for at, step in ((low, -1e-6), (high, 1e-6)):
                if high - low > 1e-5 and 1e-5 < at < math.pi - 1e-5:
                    both = found.allows(np.array([np.cos(at + s) * n + np.sin(at + s) * f for s in (step, -step)]))
                    assert both.tolist() == [False, True]


@given(st.floats(-math.pi, math.pi), st.floats(0.0, 3.0), st.floats(0.0, 1.5))
@settings(max_examples=60, deadline=None)
def test_a_tilting_table_in_closed_form(turn, most, tilt_direction):
    """A trunnion of A -most to most and C without limits holds what is within `most` of the spindle: a cone."""
    limit = np.array([[-math.inf, math.inf], [-most, most]])
    found = Kinematics(np.array([[0, 0, 1.0], [1.0, 0, 0]]), limit, UP)
    n = np.array([math.sin(tilt_direction) * math.cos(turn), math.sin(tilt_direction) * math.sin(turn), math.cos(tilt_direction)])
    f = np.cross(np.cross(n, [0.3, -0.5, 0.8]), n)
    f /= np.linalg.norm(f)
    tilt = np.linspace(0, math.pi / 2, 500)
    axis = np.cos(tilt)[:, None] * n + np.sin(tilt)[:, None] * f
    angle = np.arccos(np.clip(axis[:, 2], -1, 1))
    sure = np.abs(angle - most) > 1e-6
    assert (found.allows(axis) == (angle <= most))[sure].all()
    intervals = allowed(found, n, f, 0.0, math.pi / 2)
    inside = ((tilt[:, None] >= intervals[:, 0]) & (tilt[:, None] <= intervals[:, 1])).any(axis=1)
    assert (inside == (angle <= most))[sure].all()


@pytest.mark.parametrize(
    ("first", "second", "like"),
    [
        ((0, 0), (0, 0), ()),
        ((-180, 180), (0, 0), ()),
        ((90, 90), (0, 0), ()),
        ((0, 0), (-90, 90), (Axis.rotary("B", "tool", (0, 1, 0), limits_deg=(-90, 90)),)),
        ((90, 90), (-90, 0), (Axis.rotary("B", "tool", (-1, 0, 0), limits_deg=(-90, 0)),)),
    ],
)
def test_an_axis_whose_limits_leave_one_angle_is_none(first, second, like):
    """The machine turns its tool as one without that axis does: kernels and positions know the same axes."""
    axes = (Axis.rotary("C", "part", (0, 0, 1), limits_deg=first), Axis.rotary("B", "tool", (0, 1, 0), limits_deg=second))
    machine, other = Machine("still", axes=axes), Machine("like", axes=like, fixed=True)
    assert machine.turning == len(like)
    frame = frame_of(np.array([0.3, -0.2, 0.9]) / math.sqrt(0.94), np.array([5.0, 7.0, -3.0]))
    mine, others = (each.kinematics(frame) for each in (machine, other))
    for one, two in zip(rotary_of(mine), rotary_of(others), strict=True):
        assert np.allclose(one, two, atol=1e-12)
    axis = np.concatenate([rotary_of(others).aim, directions(np.random.default_rng(3), 200)])
    assert (mine.allows(axis) == others.allows(axis)).all()
    angles, taken, _ = mine.positions(axis)
    held = np.flatnonzero(taken >= 0)
    assert len(held) == len(rotary_of(others).aim)
    angles = angles[held, taken[held]]
    assert (np.degrees(angles) >= np.array([first[0], second[0]]) - 1e-6).all()
    assert (np.degrees(angles) <= np.array([first[1], second[1]]) + 1e-6).all()
    assert np.allclose(mine.axis(angles), axis[held], atol=1e-6)


@pytest.mark.parametrize("seed", range(20))
def test_the_ends_of_the_limits_are_held(seed):
    """An axis that needs just the last angle of a limit is held, also where the limit leaves one angle; the angles turn there."""
    machine = chain(seed)
    rng = np.random.default_rng(seed)
    low = np.radians(rng.choice([-120.0, -90.0, 0.0, 30.0, 90.0], 2))
    limit = np.stack([low, low + np.radians(rng.choice([0.0, 0.0, 60.0, 180.0], 2))], axis=1)
    machine = Kinematics(machine.direction, limit, machine.tool)
    ends = np.array([[first, second] for first in limit[0] for second in limit[1]])
    axis = machine.axis(ends)
    angles, taken, _ = machine.positions(axis)
    assert (taken >= 0).all()
    held = angles[np.arange(len(axis)), taken]
    assert (held >= limit[:, 0] - 1e-8).all()
    assert (held <= limit[:, 1] + 1e-8).all()
    assert np.allclose(machine.axis(held), axis, atol=1e-7)


def test_both_solutions_at_known_angles():
    found = of("trunnion-ac")
    axis = found.axis(np.radians([[30.0, 20.0]]))[0]
    both, taken, singular = found.positions(axis[None])
    assert np.degrees(both[0]) == pytest.approx(np.array([[30, 20], [-150, -20]]), abs=1e-9)
    assert (taken[0], singular[0]) == (0, False)
    # Beyond A's -30 only one is left.
    axis = found.axis(np.radians([[30.0, 50.0]]))[0]
    both, taken, _ = found.positions(axis[None])
    assert np.isnan(both[0, 1]).all()
    assert np.degrees(both[0, 0]) == pytest.approx([30, 50], abs=1e-9)
    # Along the axis next to the part: singular, and held.
    both, taken, singular = found.positions(UP[None])
    assert (taken[0] >= 0, singular[0]) == (True, True)


def test_fewer_axes():
    three = of("3-axis")
    assert three.allows(np.array([UP, [0, 0.001, 1.0], -UP])).tolist() == [True, False, False]
    n = np.array([0.0, math.sin(0.4), math.cos(0.4)])
    (interval,) = allowed(three, n, np.array([0.0, -math.cos(0.4), math.sin(0.4)]))
    assert interval == pytest.approx([0.4, 0.4], abs=2e-6)
    assert len(allowed(three, n, np.array([1.0, 0.0, 0.0]))) == 0
    four = Kinematics(np.array([[1.0, 0, 0]]), np.array([[-0.5, 2.0]]), UP)
    assert four.allows(four.axis(np.array([[-0.5], [0.0], [1.9], [2.1]]))).tolist() == [True, True, True, False]
    assert not four.allows(np.array([[0.1, 0, math.sqrt(0.99)]])).any()
    intervals = allowed(four, UP, np.array([0.0, -1.0, 0.0]))
    assert intervals == pytest.approx(np.array([[0.0, 2.0]]), abs=3e-6)


@pytest.mark.parametrize("limit", [(-0.5, 2.0), (-math.inf, math.inf), (-math.pi, math.pi), (0.1, 0.11), (-3.0, 3.0)])
def test_axes_of_a_single_rotary_axis_are_searched_two_degrees_apart_from_end_to_end(limit):
    four = Kinematics(np.array([[1.0, 0, 0]]), np.array([limit]), UP)
    aims, (low, high) = four.aims(), np.clip(limit, -math.pi, math.pi)
    assert four.allows(aims).all()
    apart = np.arccos(np.clip((aims[1:] * aims[:-1]).sum(axis=1), -1, 1))
    assert apart.min() > 0.0
    assert apart.max() <= math.radians(2.0) + 1e-9
    # All around, the last one is as far from the first one as any two are; else both ends are there.
    around = math.acos(aims[0] @ aims[-1])
    if high - low < 2 * math.pi:
        assert apart.sum() == pytest.approx(high - low)
    else:
        assert around == pytest.approx(apart[0])
    assert of("trunnion-ac").aims().shape == (0, 3)
    assert of("3-axis").aims().tolist() == [UP.tolist()]
    assert of("3-axis").positions(np.array([UP, -UP, [1.0, 0, 0]]))[1].tolist() == [0, -1, -1]


@pytest.mark.parametrize("name", [*FIVE, *range(20)])
def test_what_the_second_axis_just_reaches_is_held(name):
    """Where it brings the tool nearest to the first axis, and farthest from it, rounding takes no axis out of reach."""
    found = chain(name) if isinstance(name, int) else of(name)
    free = Kinematics(found.direction, np.full((2, 2), (-math.inf, math.inf)), found.tool)
    first = np.random.default_rng(5).uniform(-4, 4, 200)
    for swing in (free.swing[0], free.swing[0] + math.pi):
        assert free.allows(free.axis(np.column_stack([first, np.full(200, swing)]))).all()


@pytest.mark.parametrize("limit", [(0.2, 1.0), (-1.0, -0.2), (-1.0, 1.0), (0.0, 0.5), (-math.inf, math.inf)])
def test_along_the_first_axis_any_angle_of_it_serves_and_one_within_its_limits_is_taken(limit):
    table = Kinematics(np.array([[0, 0, 1.0], [1.0, 0, 0]]), np.array([limit, (-0.5, 2.0)]), UP)
    angles, taken, singular = table.positions(np.array([UP, UP]))
    assert (taken >= 0).all()
    assert singular.all()
    held = angles[[0, 1], taken]
    assert ((held >= np.array([limit[0], -0.5]) - 1e-8) & (held <= np.array([limit[1], 2.0]) + 1e-8)).all()
    assert np.allclose(table.axis(held), UP, atol=1e-12)
    beyond = Kinematics(table.direction, np.array([limit, (0.1, 2.0)]), UP)
    assert not beyond.allows(UP[None]).any()


def points_of_caps(axis, swing, rng, count=60):
    """Random directions (n, count, 3) within angles (n,) of axes (n, 3), and on the rims."""
    aside = np.cross(axis[:, None], rng.standard_normal((len(axis), count, 3)))
    aside /= np.linalg.norm(aside, axis=-1, keepdims=True)
    angle = swing[:, None, None] * np.sqrt(np.minimum(1.0, rng.uniform(0, 1.5, (len(axis), count, 1))))
    return np.cos(angle) * axis[:, None] + np.sin(angle) * aside


@given(seed=st.integers(0, 10_000))
def test_one_solution_holds_every_axis_in_a_cap_that_a_machine_is_said_to_hold(seed):
    rng = np.random.default_rng(seed)
    setup = directions(rng, 1)[0]
    machine = chain(seed) if rng.random() < 0.5 else of(str(rng.choice(FIVE)), setup)
    axis, swing = directions(rng, 60), rng.uniform(0.0, 0.4, 60)
    held = machine.allows_about(axis, swing)
    points = points_of_caps(axis[held], swing[held], rng)
    angles, _, _ = machine.positions(points.reshape(-1, 3))
    assert np.isfinite(angles).all(axis=2).reshape(*points.shape[:2], 2).all(axis=1).any(axis=1).all()


@given(seed=st.integers(0, 10_000))
def test_a_cap_that_no_circle_crosses_is_held_where_its_middle_is(seed):
    """The circles are all that there is between axes that are allowed and others."""
    rng, machine = np.random.default_rng(seed), chain(seed)
    axis, swing = directions(rng, 60), rng.uniform(0.0, 0.4, 60)
    circles = machine.circles()
    away = np.arccos(np.clip(axis @ circles[:, :3].T, -1, 1)) - np.arccos(np.clip(circles[:, 3], -1, 1))
    pole = np.arccos(np.abs(np.clip(axis @ machine.direction[0], -1, 1)))
    alone = (np.abs(away).min(axis=1) > swing + 1e-6) & (pole > swing + 1e-6)
    assert (machine.allows_about(axis, swing) == machine.allows(axis))[alone].all()


def test_small_caps_inside_the_limits_of_a_trunnion_are_held():
    """A from -30 to 120 deg: all within 120 deg of Z, on either side of the circle at 30 deg."""
    tilt = np.radians([5.0, 29.9, 30.1, 60.0, 115.0, 119.0, 125.0])
    axis = np.column_stack([np.sin(tilt), np.zeros(7), np.cos(tilt)])
    assert of("trunnion-ac").allows_about(axis, np.radians(np.full(7, 2.0))).tolist() == [True] * 5 + [False] * 2


@given(
    seed=st.integers(0, 10_000), low=st.floats(-6.5, -0.1), high=st.floats(0.1, 6.5), swing=st.floats(0.0, 0.5),
    angle=st.floats(-7.0, 7.0),
)  # fmt: skip
def test_a_machine_of_one_axis_holds_what_is_said_in_the_plane_in_which_it_turns_the_tool(seed, low, high, swing, angle):
    direction, aside = directions(np.random.default_rng(seed), 2)
    tool = np.cross(direction, aside) / np.linalg.norm(np.cross(direction, aside))
    four = Kinematics(direction[None], np.array([[low, high]]), tool)
    (axis,) = four.axis(np.array([[angle]]))
    held = bool(four.allows_about(axis[None], np.array([swing]))[0])
    near = four.allows(four.axis(np.linspace(angle - swing, angle + swing, 41)[:, None]))
    # A whole turn may hold each by another turn; the motion goes on from one to the next.
    assert not held or near.all()
    assert held or not near.all() or high - low > 2.0 * math.pi - swing - 1e-6


def test_a_machine_that_turns_no_tool_or_turns_it_in_a_cone_holds_one_axis_alone():
    cone = Kinematics(np.array([[1.0, 0, 0]]), np.array([[-0.5, 2.0]]), np.array([0.6, 0.0, 0.8]))
    for machine, axis in ((of("3-axis"), UP), (cone, cone.axis(np.array([[1.0]]))[0])):
        assert machine.allows_about(np.array([axis, axis, -axis]), np.array([0.0, 1e-3, 0.0])).tolist() == [True, False, False]


@pytest.mark.parametrize(
    ("words", "message"),
    [
        ({"direction": (0, 0, 0)}, "not all zero"),
        ({"direction": (0, float("nan"), 1)}, "number"),
        ({"direction": (0, 1)}, "must be 3 numbers"),
        ({"limits": (1.0, -1.0)}, "must run upwards"),
        ({"limits": (float("nan"), 1.0)}, "number"),
        ({"kind": "linear?"}, "rotary or linear"),
        ({"carries": "head"}, "the part or the tool"),
        ({"name": ""}, "needs a name"),
        ({"rate": 0}, "must be positive"),
        ({"point": (0, 0, math.inf)}, "must be finite"),
    ],
)
def test_axes_that_cannot_be(words, message):
    with pytest.raises(MachineError, match=message):
        Axis(**{"name": "A", "kind": "rotary", "carries": "part", "direction": (1, 0, 0)} | words)


def axis(name, *direction, carries="part"):
    return Axis(name, "rotary", carries, direction)


@pytest.mark.parametrize(
    ("axes", "message"),
    [
        ([axis("A", 1, 0, 0), axis("B", -1, 0, 0)], "parallel"),
        ([axis("A", 1, 0, 0), axis("C", 0, 0, 1, carries="tool")], "lies along the tool"),
        ([axis("C", 0, 0, 1), axis("A", 1, 0, 0), axis("B", 0, 1, 0, carries="tool")], "3 rotary axes"),
        ([axis("A", 1, 0, 0, carries="tool"), axis("B", 0, 1, 0)], "come before"),
        ([axis("A", 1, 0, 0), axis("A", 0, 1, 0)], "one name"),
        ("AB", "axes"),
    ],
)
def test_machines_that_cannot_be(axes, message):
    with pytest.raises(MachineError, match=message):
        Machine("mine", axes=axes)


@pytest.mark.parametrize(("limit", "ends"), [((-0.5, 2.0), 2), ((-4.0, 4.0), 0), ((-math.inf, math.inf), 0)])
def test_what_a_single_rotary_axis_holds_ends_at_its_circles(limit, ends):
    """A band about the circle on which its tool turns, and half planes through its direction at either end."""
    first = np.array([0.6, 0.0, 0.8])
    four = Kinematics(first[None], np.array([limit]), UP)
    circles = four.circles()
    assert circles[:2, 3] == pytest.approx([0.8 - PARALLEL, 0.8 + PARALLEL], abs=1e-12)
    assert (circles[:2, :3] == first).all()
    assert len(circles) == 2 + ends
    for circle, end in zip(circles[2:], limit, strict=False):
        assert circle[3] == 0.0
        assert circle[:3] @ np.stack([first, four.axis(np.array([[end]]))[0]], axis=1) == pytest.approx([0.0, 0.0], abs=1e-12)
