"""Turns under which a part nearly looks the same, and the axis that its surfaces of revolution have: on made-up samples."""

import math
from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from plan_cutters.operations.symmetry import Symmetry, _axis_of_normals, _near_order

SEEDS = st.integers(0, 2**31)


def units(rng, count):
    way = rng.normal(size=(count, 3))
    return way / np.linalg.norm(way, axis=1)[:, None]


@settings(max_examples=40, deadline=None)
@given(SEEDS, st.integers(2, 60))
def test_of_all_images_of_a_direction_one_lies_in_the_first_sector(seed, order):
    rng = np.random.default_rng(seed)
    direction = units(rng, 1)[0]
    symmetry = Symmetry(np.zeros(3), direction, order, True, ())
    vector = units(rng, 30)
    turns = [Rotation.from_rotvec(2.0 * math.pi * k / order * direction).apply(vector) for k in range(order)]
    count = np.zeros(30, int)
    for each in turns:
        count[symmetry.sector(each)] += 1
    assert (count == 1).all()
    # What lies on the axis is its own image.
    assert symmetry.sector(np.array([direction, -3.0 * direction, np.zeros(3)])).tolist() == [0, 1, 2]


def revolved(seed, kind):
    """Points of a surface of revolution about Z and their normals."""
    rng = np.random.default_rng(seed)
    turn, along = rng.uniform(0.0, 5.0, 60), rng.uniform(-1.0, 1.0, 60)
    radius, slope = {
        "cylinder": (np.full(60, 2.0), np.zeros(60)),
        "cone": (2.0 + 0.5 * along, np.full(60, 0.5)),
        "waist": (2.0 + along**2, 2.0 * along),
    }[kind]
    out = np.column_stack([np.cos(turn), np.sin(turn), np.zeros(60)])
    normal = out - slope[:, None] * np.array([0.0, 0.0, 1.0])
    return radius[:, None] * out + along[:, None] * np.array([0.0, 0.0, 1.0]), normal / np.linalg.norm(normal, axis=1)[:, None]


@settings(max_examples=30, deadline=None)
@given(SEEDS, st.sampled_from(["cylinder", "cone", "waist"]), st.floats(0.05, 50.0))
def test_the_normals_of_a_surface_of_revolution_meet_its_axis_wherever_it_stands(seed, kind, size):
    rng = np.random.default_rng(seed)
    point, normal = revolved(seed, kind)
    turn, shift = Rotation.random(random_state=seed % 2**31), rng.uniform(-20.0, 20.0, 3)
    place, direction = _axis_of_normals(turn.apply(size * point) + shift, turn.apply(normal))
    wanted = turn.apply([0.0, 0.0, 1.0])
    assert abs(direction @ wanted) == pytest.approx(1.0, abs=1e-6)
    off = place - shift
    assert np.linalg.norm(off - (off @ wanted) * wanted) <= 1e-5 * size
    # One sense of each line: that of its largest part.
    assert direction[np.abs(direction).argmax()] > 0.0


def test_planes_spheres_and_screws_have_no_axis():
    rng = np.random.default_rng(2)
    flat = np.column_stack([rng.uniform(-1.0, 1.0, (60, 2)), np.zeros(60)])
    assert _axis_of_normals(flat, np.tile([0.0, 0.0, 1.0], (60, 1))) is None
    ball = units(rng, 60)
    assert _axis_of_normals(ball, ball) is None
    turn, away = rng.uniform(0.0, 6.0, 60), rng.uniform(1.0, 3.0, 60)
    point = np.column_stack([away * np.cos(turn), away * np.sin(turn), 0.5 * turn])
    normal = np.cross(np.column_stack([np.cos(turn), np.sin(turn), np.zeros(60)]),
                      np.column_stack([-away * np.sin(turn), away * np.cos(turn), np.full(60, 0.5)]))  # fmt: skip
    assert _axis_of_normals(point, normal / np.linalg.norm(normal, axis=1)[:, None]) is None
    assert _axis_of_normals(flat[:4], np.tile([0.0, 0.0, 1.0], (4, 1))) is None


def fins(order, broken=0, each=200):
    """Samples on flat fins through the axis, all of one area, of which some on the first fin have another normal."""
    rng = np.random.default_rng(4)
    x, z = rng.uniform(2.0, 6.0, each), rng.uniform(0.0, 4.0, each)
    point, normal = [], []
    for k in range(order):
        turn = Rotation.from_rotvec([0.0, 0.0, 2.0 * math.pi * k / order])
        own = np.tile([0.0, 1.0, 0.0], (each, 1))
        if k == 0:
            own[:broken] = 0.0, -1.0, 0.0
        point.append(turn.apply(np.column_stack([x, np.zeros(each), z])))
        normal.append(turn.apply(own))
    face = np.repeat(np.arange(1, order + 1), each)
    return SimpleNamespace(
        point=np.concatenate(point), normal=np.concatenate(normal), face=face, area=np.ones(order * each), max_gap=1e-3
    )


@pytest.mark.parametrize("order", [3, 6, 7])
def test_a_part_that_agrees_in_all_but_a_fiftieth_of_its_area_is_nearly_a_pattern(order):
    """Each sample with another normal costs two: its image, and that which it is the image of."""
    z = np.array([0.0, 0.0, 1.0])
    rows = np.arange(order * 200)
    for share, found in ((0.0, order), (0.0155, order), (0.0245, 1)):
        samples = fins(order, round(0.5 * share * order * 200))
        assert _near_order(samples, rows, np.zeros(3), z) == found
    assert _near_order(fins(order), rows, np.array([0.5, 0.0, 0.0]), z) == 1
    assert _near_order(fins(order), rows, np.zeros(3), np.array([0.0, 0.6, 0.8])) == 1


def test_what_is_revolved_alone_is_no_pattern():
    point, normal = revolved(3, "waist")
    samples = SimpleNamespace(point=point, normal=normal, face=np.ones(60, int), area=np.ones(60), max_gap=1e-3)
    assert _near_order(samples, np.arange(60), np.zeros(3), np.array([0.0, 0.0, 1.0])) == 1
