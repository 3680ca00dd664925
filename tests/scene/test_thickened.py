"""All places within a distance of triangles are enclosed, and what encloses them grows with the distance."""

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from plan_cutters.scene.triangles import thickened


def is_closed(skin):
    """Whether each edge is run along as often one way as the other: cells that touch along an edge have four sides there."""
    _, corner = np.unique(skin.reshape(-1, 3), axis=0, return_inverse=True)
    a, b = corner.reshape(-1, 3).ravel(), np.roll(corner.reshape(-1, 3), -1, axis=1).ravel()
    _, edge = np.unique(np.sort(np.stack([a, b], axis=1), axis=1), axis=0, return_inverse=True)
    return len(skin) > 0 and not np.bincount(edge.ravel(), weights=np.where(a < b, 1, -1)).any()


def winding(skin, points):
    """How often a skin runs around points, by the angles of its triangles: it shares nothing with the program."""
    total = np.zeros(len(points))
    for first in range(0, len(points), 50):
        a, b, c = (skin[None, :, k] - points[first : first + 50, None] for k in range(3))
        x, y, z = (np.linalg.norm(each, axis=2) for each in (a, b, c))
        up = np.einsum("ijk,ijk->ij", a, np.cross(b, c))
        down = x * y * z + (a * b).sum(axis=2) * z + (b * c).sum(axis=2) * x + (c * a).sum(axis=2) * y
        total[first : first + 50] = 2.0 * np.arctan2(up, down).sum(axis=1)
    return total / (4.0 * np.pi)


def near(rng, vertex, error, count=60):
    """Points within a distance of triangles, some of them nearly at it."""
    share = rng.dirichlet(np.ones(3), count)
    foot = np.einsum("nc,ncx->nx", share, vertex[rng.integers(0, len(vertex), count)])
    way = rng.normal(size=(count, 3))
    way /= np.linalg.norm(way, axis=1)[:, None]
    return foot + way * (error * rng.choice([0.0, 0.5, 0.999], count))[:, None]


@given(
    seed=st.integers(0, 10**6), count=st.integers(1, 6), error=st.floats(1e-4, 3.0), scale=st.floats(1e-2, 1e3),
    away=st.sampled_from([0.0, 1e5]),
)  # fmt: skip
@settings(max_examples=25, deadline=None)
def test_it_is_closed_and_encloses_all_that_is_near(seed, count, error, scale, away):
    rng = np.random.default_rng(seed)
    vertex = away + scale * rng.uniform(-1.0, 1.0, (1, 1, 3)) + scale * rng.uniform(-0.3, 0.3, (count, 3, 3))
    # Needles and points are triangles, too.
    vertex[0, 1] = vertex[0, int(rng.integers(0, 3))]
    skin = thickened(vertex, error)
    assert is_closed(skin)
    assert winding(skin, near(rng, vertex, error)).min() > 0.99
    # Nothing is farther from the triangles than the corner of a cube of that size.
    middle = vertex.reshape(-1, 3).mean(axis=0)
    far, reach = (np.linalg.norm(each.reshape(-1, 3) - middle, axis=1).max() for each in (skin, vertex))
    assert far <= reach * (1 + 1e-9) + 1.8 * error + np.ptp(vertex[0], axis=0).max()


@given(seed=st.integers(0, 10**6), error=st.floats(1e-3, 1.0), more=st.floats(1.0, 50.0))
@settings(max_examples=25, deadline=None)
def test_what_encloses_for_an_error_encloses_for_each_smaller_one(seed, error, more):
    rng = np.random.default_rng(seed)
    vertex = rng.uniform(-2.0, 2.0, (3, 3, 3))
    small, large = thickened(vertex, error), thickened(vertex, more * error)
    middle = small.mean(axis=1)
    # A hair inwards: skins may run along each other.
    inward = -np.cross(small[:, 1] - small[:, 0], small[:, 2] - small[:, 0])
    inward /= np.linalg.norm(inward, axis=1)[:, None]
    some = rng.choice(len(middle), min(60, len(middle)), replace=False)
    assert winding(large, (middle + 1e-6 * inward)[some]).min() > 0.99


def test_nothing_is_enclosed_where_there_is_nothing():
    assert thickened(np.zeros((0, 3, 3)), 1.0).shape == (0, 3, 3)
    # A point without an error is enclosed, too: a face may be as small as that.
    assert is_closed(thickened(np.full((1, 3, 3), 7.0), 0.0))
