"""Triangulations after flips: what they cover, and that no corner lies in the circle of another triangle."""

import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial import Delaunay

from cad_io.tessellate.planar import delaunay, triangulated


def areas(point, corner):
    a, b, c = np.moveaxis(point[corner], 1, 0)
    return 0.5 * ((b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0])


def outer_edges(corner):
    edges = np.sort(np.stack([corner, np.roll(corner, -1, axis=1)], axis=2).reshape(-1, 2), axis=1)
    each, count = np.unique(edges, axis=0, return_counts=True)
    assert count.max() <= 2
    return each[count == 1]


def circles(point, corner):
    """Centres and radii of the circles through the corners."""
    a, b, c = (point[corner[:, k]] for k in range(3))
    ab, ac = b - a, c - a
    twice = 2.0 * (ab[:, 0] * ac[:, 1] - ab[:, 1] * ac[:, 0])
    ll, mm = (ab**2).sum(1), (ac**2).sum(1)
    off = np.stack([ac[:, 1] * ll - ab[:, 1] * mm, ab[:, 0] * mm - ac[:, 0] * ll], axis=1) / twice[:, None]
    return a + off, np.linalg.norm(off, axis=1)


def fan(point):
    """Triangles of a convex polygon, all with its first corner."""
    k = np.arange(1, len(point) - 1)
    return np.stack([np.zeros_like(k), k, k + 1], axis=1).astype(np.int32)


@given(seed=st.integers(0, 10**6), count=st.integers(4, 60))
@settings(max_examples=60, deadline=None)
def test_a_fan_becomes_the_triangulation_of_delaunay(seed, count):
    rng = np.random.default_rng(seed)
    turn = np.sort(rng.uniform(0.0, 2.0 * np.pi, count))
    # On an ellipse with noise that leaves it convex: no four of them on a circle.
    point = np.stack([5.0 * np.cos(turn), np.sin(turn)], axis=1)
    start = fan(point)
    found = delaunay(point, start)
    assert areas(point, found).sum() == pytest.approx(areas(point, start).sum())
    assert (areas(point, found) > 0.0).all()
    np.testing.assert_array_equal(outer_edges(found), outer_edges(start))
    centre, radius = circles(point, found)
    inside = np.linalg.norm(point[None] - centre[:, None], axis=2) < radius[:, None] * (1.0 - 1e-6)
    assert not inside.any()
    wanted = {tuple(sorted(each)) for each in Delaunay(point).simplices.tolist()}
    tight = np.diff(turn).min(initial=1.0) > 1e-3
    assert not tight or {tuple(sorted(each)) for each in found.tolist()} == wanted


def test_what_is_delaunay_stays_as_it_is():
    point = np.random.default_rng(2).uniform(size=(200, 2))
    corner = Delaunay(point).simplices.astype(np.int32)
    corner[areas(point, corner) < 0.0] = corner[areas(point, corner) < 0.0][:, ::-1]
    np.testing.assert_array_equal(delaunay(point, corner), corner)
    square = np.array([(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)])
    for both in ([(0, 1, 2), (0, 2, 3)], [(0, 1, 3), (1, 2, 3)]):
        np.testing.assert_array_equal(delaunay(square, np.array(both, np.int32)), both)
    assert delaunay(square, np.zeros((0, 3), np.int32)).shape == (0, 3)


def test_a_long_strip_has_no_ear_as_long_as_itself():
    """The spring of a file whose border runs beside 700 lines of a grid: its ears were 34 of 52 long."""
    along = np.linspace(0.0, 100.0, 1500)
    wave = 0.05 * np.sin(3.0 * along)
    ring = np.concatenate([np.stack([along, wave], axis=1), np.stack([along[::-1], 1.0 + wave[::-1]], axis=1)])
    chords = np.stack([np.arange(len(ring)), np.roll(np.arange(len(ring)), -1)], axis=1).astype(np.int32)
    found = triangulated(ring, chords, (np.array([0.0, 100.0]), np.array([0.0, 1.0])), np.ones(2))
    assert found is not None
    point, corner = found
    assert np.ptp(point[corner], axis=1)[:, 0].max() < 2.0
    assert areas(point, corner).sum() == pytest.approx(shapely.Polygon(ring).area)
