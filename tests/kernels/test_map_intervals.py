"""What posture maps call clear of an interval of tilts: no point of a box or triangle that passes is ever in the cutter.

The reference is containment of points, tilt by tilt, in the frame of the tool; it shares no code with the kernels.
"""

import numpy as np
import pytest

from plan_cutters.kernels.linear import tree as lanes
from plan_cutters.kernels.maps import passes
from plan_cutters.kernels.maps import passes as intervals
from tests.support import waves

TILTS = 181


def interval_of(first, last):
    ends = [first, last, np.cos(first), np.sin(first), np.cos(last), np.sin(last), 0.0, 0.0]
    return np.array([ends] * 16)


def deepest(points, first, last, radius, shrunk, low, high):
    """How far inside the body the points (k, 3), along f, t and n, come at most, mm; negative if never."""
    tilt = np.linspace(first, last, TILTS)[:, None]
    c, s = np.cos(tilt), np.sin(tilt)
    x, y, z = points.T
    height, across = c * z + s * x, c * x - s * z + radius
    inside = np.minimum(shrunk - np.hypot(across, y), np.minimum(height - low, high - height))
    return inside.max()


def cases(seed, count):
    """Cutters, intervals, and a size and a place at which something may or may not be in the way."""
    rng = np.random.default_rng(seed)
    for _ in range(count):
        radius = 10 ** rng.uniform(-0.5, 1)
        low = radius * 10 ** rng.uniform(-4, -1.5)
        high = radius * rng.choice([0.5, 2, 10]) - low
        first, last = np.sort(rng.uniform(0, np.pi / 2, 2))
        first, last = rng.choice([0.0, first]), rng.choice([np.pi / 2, last, first + 0.02])
        first, last = min(first, last), max(first, last)
        place = radius * 10 ** rng.uniform(-2, 0.7) * rng.standard_normal(3)
        if rng.random() < 0.5:
            # Beside the contact, where the rim has curved away by about as much as the surface rises.
            place[0], place[1] = 0.02 * place[0], np.clip(place[1], -radius, radius)
            place[2] = place[1] ** 2 / radius * rng.uniform(-0.1, 0.6) + low
        yield rng, radius, low, high, first, last, place, radius * 10 ** rng.uniform(-2.5, 0.3)


@pytest.mark.parametrize("count", [1500, pytest.param(4000, marks=pytest.mark.slow("draws many cases"))])
def test_boxes_that_pass_never_enter(count):
    passed, margin = 0, np.empty(lanes.LANES)
    corners = np.stack(np.meshgrid(*[np.linspace(-1, 1, 5)] * 3), -1).reshape(-1, 3)
    for rng, radius, low, high, first, last, place, size in cases(1, count):
        view = np.zeros((1, 16, lanes.LANES))
        sides = np.linalg.qr(rng.standard_normal((3, 3)))[0] * size * 10 ** rng.uniform(-2, 0, 3)
        turn = rng.uniform(0, 2 * np.pi)
        cosine, sine = np.cos(turn), np.sin(turn)
        # In the sample's frame: the rotation takes it back.
        back = np.array([[cosine, -sine, 0], [sine, cosine, 0], [0, 0, 1]])
        centre, axes = back @ place, back @ sides
        view[0, :3] = centre[:, None]
        for k in range(3):
            view[0, 3 + k], view[0, 6 + k], view[0, 9 + k] = axes[0, k], axes[1, k], axes[2, k]
        view[0, 12] = place[2] + np.abs(sides[2]).sum()
        passes._boxes_pass(view, 0, cosine, sine, interval_of(first, last), 1, waves.cylinder(radius, high + low, low), margin)
        assert (margin == margin[0]).all()
        if margin[0] >= 0:
            passed += 1
            points = place + corners @ sides.T
            assert deepest(points, first, last, radius, radius - low, low, high) <= 1e-9 * radius
    assert count / 8 < passed < 7 * count / 8


@pytest.mark.parametrize("count", [2500, pytest.param(8000, marks=pytest.mark.slow("draws many cases"))])
def test_triangles_that_pass_never_enter(count):
    passed, closely, margin = 0, 0, np.empty(lanes.LANES)
    first_part, second_part = np.empty((8, 3)), np.empty((8, 3))
    weights = np.array([(i, j, 12 - i - j) for i in range(13) for j in range(13 - i)]) / 12
    for rng, radius, low, high, first, last, place, size in cases(2, count):
        triangle = place + size * rng.standard_normal((3, 3)) * 10 ** rng.uniform(-1.5, 0, 3)
        seen = np.repeat(triangle.reshape(9, 1), lanes.LANES, 1)
        passes._triangles_pass(seen, 1.0, 0.0, interval_of(first, last), 1, waves.cylinder(radius, high + low, low), margin)
        assert (margin == margin[0]).all()
        ends = np.cos(first), np.sin(first), np.cos(last), np.sin(last)
        close = passes._passes(triangle, *ends, waves.cylinder(radius, high + low, low), first_part, second_part)
        passed, closely = passed + (margin[0] >= 0), closely + close
        if margin[0] >= 0 or close:
            assert deepest(weights @ triangle, first, last, radius, radius - low, low, high) <= 1e-9 * radius
    assert count / 8 < passed < 7 * count / 8
    assert closely > count / 8


def test_points_that_cut_are_in_the_cutter_and_others_are_not():
    cutting = 0
    for _, radius, low, high, first, last, place, _ in cases(3, 4000):
        x, y, z = place
        cuts = intervals._cuts(x, y, z, interval_of(first, last), 1, waves.cylinder(radius, high + low, low))
        depth = deepest(place[None], first, last, radius, radius - low, low, high)
        cutting += cuts
        # Between the tilts looked at, a point may come a little deeper.
        if not cuts:
            assert depth <= 1e-9 * radius
        else:
            reach = np.hypot(np.linalg.norm(place), radius)
            assert depth >= -reach * (last - first) / TILTS
    assert 200 < cutting < 3800


def test_a_box_is_out_of_reach_only_where_all_of_it_is():
    rng, cube = np.random.default_rng(6), np.stack(np.meshgrid(*[np.linspace(-1, 1, 7)] * 3), -1).reshape(-1, 3)
    view, blocks, near, far = np.zeros((1, 16, lanes.LANES)), np.zeros((1, 16, lanes.LANES)), 0, 0
    for _ in range(60):
        contact, frame, reach = rng.normal(0, 5, 3), np.linalg.qr(rng.standard_normal((3, 3)))[0], 10.0 ** rng.uniform(0, 1)
        centre = contact + reach * rng.normal(0, 1, (lanes.LANES, 3))
        halves = reach * 10.0 ** rng.uniform(-1.5, 0, (lanes.LANES, 3))
        sides = np.linalg.qr(rng.standard_normal((lanes.LANES, 3, 3)))[0] * halves[:, :, None]
        blocks[0, :3], blocks[0, 3:12] = centre.T, sides.reshape(-1, 9).T
        lanes._see(view, 0, blocks, 0, contact, *frame, reach)
        for lane in range(lanes.LANES):
            points = (centre[lane] + cube @ sides[lane] - contact) @ frame.T
            assert view[0, :3, lane] == pytest.approx(frame @ (centre[lane] - contact))
            if view[0, 12, lane] == -np.inf:
                assert np.linalg.norm(points, axis=1).min() > reach
                far += 1
            else:
                assert view[0, 12, lane] == pytest.approx(points[:, 2].max())
                # From a ball around the box.
                assert np.linalg.norm(centre[lane] - contact) - np.linalg.norm(halves[lane]) <= reach
                near += 1
    assert min(near, far) > 50


def test_blocks_hold_every_triangle():
    for size in (2, 3, 12, 31):
        vertex = waves.triangles(size)
        vertex, blocks, offset, bottom = lanes.wide_tree(waves.tree_of(vertex))
        n = len(vertex)
        assert offset[-1] == len(blocks)
        for j in range(1 << bottom):
            inside = vertex[(n * j) >> bottom : (n * (j + 1)) >> bottom].reshape(-1, 3)
            assert len(inside) <= 3 * lanes.LANES
            # The box at the bottom and all those around it, up to the first block.
            at = j
            for level in range(len(offset) - 2, -1, -1):
                block = blocks[offset[level] + (at >> 3 if level else 0), :, at & 7]
                sides = block[3:12].reshape(3, 3)
                half = np.linalg.norm(sides, axis=1)
                along = (inside - block[:3]) @ (sides / np.where(half > 0, half, 1)[:, None]).T
                assert (np.abs(along) <= half + 1e-9).all()
                at >>= 3


@pytest.mark.parametrize("seed", range(3))
def test_more_in_the_way_never_frees_a_tilt(seed):
    """Maps of all triangles lie within those of half of them, up to what is undecided."""
    contacts, vertex = waves.samples(6), waves.triangles(31)
    rng = np.random.default_rng(seed)
    turn = 2 * np.pi * np.arange(12) / 12

    def free(kept):
        rows, tool = np.arange(len(contacts.point)), waves.flat(6.0, 40.0, 0.04)
        part, count, unsure = waves.mapped(rows, contacts, waves.ranges(turn), tool, waves.tree_of(kept))
        real = np.arange(8) < count[..., None]
        return np.where(real, part[..., 1] - part[..., 0], 0).sum(-1), unsure

    few, unsure = free(vertex[rng.random(len(vertex)) < 0.5])
    many, _ = free(vertex)
    assert (many <= few + unsure + 1e-9).all()
    assert (many < few - 0.01).any()
