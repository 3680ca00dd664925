"""Boxes, cylinders, vises and chucks as triangles: closed, as large as their closed forms, and off by no more than is said."""

import math

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from plan_cutters.domain.clamping import Block, Chuck, Disc, Vise
from plan_cutters.setups.solids import box, cylinder, sides_of, strip, triangles_of
from tests.support.vises import stands_in

lengths = st.floats(0.1, 500.0)
chords = st.floats(1e-4, 1.0)
VISES = st.builds(
    lambda width, opening, gap: Vise(width, 25.0, opening, 3.0, gap * opening), lengths, lengths, st.floats(0.05, 1.0)
)
CHUCKS = st.builds(lambda jaws, wide: Chuck(jaws, 20.0, 3.0, wide), st.integers(2, 6), st.floats(5.0, 400.0))


def volume(vertex):
    """What closed triangles enclose, counted positive where they run counter-clockwise from outside."""
    a, b, c = np.moveaxis(vertex - vertex.mean(axis=(0, 1)), 1, 0)
    return float((np.cross(a, b) * c).sum()) / 6.0


def is_closed(vertex):
    """Whether each edge is run along as often one way as the other."""
    _, corner = np.unique(np.round(vertex.reshape(-1, 3), 9), axis=0, return_inverse=True)
    a, b = corner.reshape(-1, 3).ravel(), np.roll(corner.reshape(-1, 3), -1, axis=1).ravel()
    _, edge = np.unique(np.sort(np.stack([a, b], axis=1), axis=1), axis=0, return_inverse=True)
    return not np.bincount(edge.ravel(), weights=np.sign(b - a)).any()


@given(st.tuples(lengths, lengths, lengths), st.tuples(lengths, lengths, lengths))
def test_a_box_has_its_volume_and_its_corners(low, size):
    vertex = box(np.array(low), np.array(low) + size)
    assert is_closed(vertex)
    assert volume(vertex) == pytest.approx(math.prod(size), rel=1e-9)
    assert vertex.min(axis=(0, 1)) == pytest.approx(low)
    assert vertex.max(axis=(0, 1)) == pytest.approx(np.add(low, size))


@given(lengths, lengths, chords)
def test_the_sides_of_a_disc_are_no_farther_from_it_than_asked_and_no_fewer_would_do(radius, height, chord):
    sides = sides_of(radius, chord)
    assert 8 <= sides <= 720
    sag = [radius * (1.0 - math.cos(math.pi / n)) for n in (sides, sides - 1)]
    assert sag[0] <= chord * (1 + 1e-9) or sides == 720
    assert sag[1] > chord * (1 - 1e-9) or sides == 8
    vertex = cylinder(radius, height, sides)
    assert is_closed(vertex)
    assert volume(vertex) == pytest.approx(0.5 * sides * radius**2 * math.sin(2 * math.pi / sides) * height, rel=1e-9)
    assert np.linalg.norm(vertex[..., :2], axis=2).max() == pytest.approx(radius)
    assert (vertex[..., 2].min(), vertex[..., 2].max()) == pytest.approx((0.0, height))


@given(st.lists(st.floats(1.0, 9.0), min_size=2, max_size=6), st.floats(0.5, 5.0), st.floats(-5.0, 5.0), lengths)
def test_a_strip_has_the_area_of_its_outline_times_its_height(steps, wide, low, height):
    """Along x with any course: its outline by the shoelace formula."""
    x, y = np.cumsum(steps), np.sin(np.arange(len(steps)))
    inner, outer = np.column_stack([x, y]), np.column_stack([x, y + wide])
    vertex = strip(inner, outer, low, low + height)
    a = np.concatenate([inner, outer[::-1]])
    b = np.roll(a, -1, axis=0)
    area = 0.5 * float((a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]).sum())
    assert is_closed(vertex)
    assert volume(vertex) == pytest.approx(area * height, rel=1e-6)
    assert (vertex[..., 2].min(), vertex[..., 2].max()) == pytest.approx((low, low + height))


def exact(solid):
    """Volume of a body of a vise or chuck, mm3: of a disc that of the cylinder."""
    if isinstance(solid, Disc):
        return math.pi * solid.radius**2 * (solid.high - solid.low)
    a = np.array([*solid.inner, *solid.outer[::-1]])
    b = np.roll(a, -1, axis=0)
    return 0.5 * float((a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]).sum()) * (solid.high - solid.low)


@settings(max_examples=40, deadline=None)
@given(VISES | CHUCKS, chords)
def test_triangles_of_a_vise_or_chuck_enclose_its_bodies_within_the_error_that_they_say(clamping, chord):
    assume(clamping.height > clamping.grip)
    vertex, error = triangles_of(clamping, chord)
    solids = clamping.solids(chord)
    assert is_closed(vertex)
    assert volume(vertex) == pytest.approx(sum(map(exact, solids)), rel=4.0 * error / min(_least(each) for each in solids) + 1e-9)
    if isinstance(clamping, Vise):
        assert error == 0.0
        return
    # Of each disc the middle of a chord is what is farthest off; of a jaw's bore its corners are.
    sag = [each.radius * (1.0 - math.cos(math.pi / sides_of(each.radius, chord))) for each in solids if isinstance(each, Disc)]
    bore = [np.linalg.norm(each.inner, axis=1).max() for each in solids if isinstance(each, Block) and each.high == clamping.grip]
    assert error == pytest.approx(max(*sag, max(bore) - 0.5 * clamping.diameter), abs=1e-9)
    # Only where that would take too many sides is it farther off than asked.
    assert error <= chord * (1 + 1e-9) or max(sides_of(each.radius, chord) for each in solids if isinstance(each, Disc)) == 720


def _least(solid):
    return solid.radius if isinstance(solid, Disc) else 1.0


@settings(max_examples=40, deadline=None)
@given(VISES | CHUCKS, st.floats(-150.0, 10.0))
def test_bodies_below_a_height_are_left_out_and_all_of_the_others_stay(clamping, above):
    whole, error = triangles_of(clamping, 0.1)
    some, off = triangles_of(clamping, 0.1, above=above)
    assert off <= error
    rows = {each.tobytes() for each in whole}
    assert all(each.tobytes() in rows for each in some)
    tall = whole[..., 2].max(axis=1)
    left = [each for each in clamping.solids(0.1) if each.high > above] or clamping.solids(0.1)
    # Nothing that reaches above it is missing.
    assert (some[..., 2].max(axis=1) > above).any() == (tall > above).any()
    assert volume(some) == pytest.approx(sum(map(exact, left)), rel=0.02)


def inside(solid, points, deep):
    """Whether points lie deeper than a length in a box or disc of a vise or chuck, by their distance from its border."""
    x, y, z = points.T
    ends = np.minimum(z - solid.low, solid.high - z)
    if isinstance(solid, Disc):
        return np.minimum(ends, solid.radius - np.hypot(x, y)) > deep
    if len(solid.inner) > 2:
        return np.zeros(len(points), bool)
    corners = np.array([*solid.inner, *solid.outer])
    (left, front), (right, back) = corners.min(axis=0), corners.max(axis=0)
    return np.min([ends, x - left, right - x, y - front, back - y], axis=0) > deep


@settings(max_examples=60, deadline=None)
@given(VISES | CHUCKS, st.floats(0.01, 5.0), st.integers(0, 2**32 - 1))
def test_a_point_is_seen_in_a_vise_or_chuck_where_it_lies_deeper_than_asked(clamping, deep, seed):
    """One point at a time, about each of its bodies: just inside of every side, and just beyond."""
    rng = np.random.default_rng(seed)
    solids = clamping.solids(deep)
    points = []
    for each in solids:
        reach = each.radius if isinstance(each, Disc) else np.abs([*each.inner, *each.outer]).max(axis=0)
        low, high = np.array([*(np.zeros(2) - reach), each.low]), np.array([*(np.zeros(2) + reach), each.high])
        some = rng.uniform(low, high, (6, 3))
        axis = np.arange(6) % 3
        side = rng.choice([-1.0, 1.0], 6)
        some[np.arange(6), axis] = np.where(side > 0, high[axis], low[axis]) - side * deep * rng.choice([0.99, 1.01], 6)
        points.append(some)
    points = np.concatenate(points)
    truth = np.any([inside(each, points, deep) for each in solids], axis=0)
    # Jaws of a chuck are not looked at: no is no answer there.
    assert [stands_in(clamping, each[None], deep) for each in points] == truth.tolist()
    turned = (*rng.uniform(-90.0, 90.0, 3), *rng.uniform(-180.0, 180.0, 3))
    assert stands_in(clamping, points, deep, turned) == truth.any()
    assert truth.all() or not stands_in(clamping, points[~truth], deep, turned)
