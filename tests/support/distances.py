"""Distances of points from triangles by direct search. They share nothing with the program."""

import numpy as np
from scipy.spatial import cKDTree

from cad_io.kernel import values

ROUNDING = 1e-9


def farthest(part, triangles, count=1500):
    """Largest distance of random surface points, each from the triangles of its face."""
    promise = triangles.chord_error + ROUNDING
    rng = np.random.default_rng(0)
    worst = 0.0
    for face in part.faces:
        points = surface_points(part, face.number, max(25, count // len(part.faces)), rng)
        mine = triangles.vertex[triangles.face == face.number]
        worst = max(worst, farthest_from(points, mine, promise))
    return worst


def farthest_from(points, triangles, promise, candidates=24, large=100):
    """Largest distance of points from a soup. What is beyond the promise is measured against every triangle.

    Shares nothing with the program: see `closest`.
    """
    middle = triangles.mean(axis=1)
    radius = np.linalg.norm(triangles - middle[:, None], axis=2).max(axis=1)
    # Large triangles have far middles: they are compared with every point, the small ones by their middles.
    order = np.argsort(-radius)
    best = np.full(len(points), np.inf)
    for row in order[:large].tolist():
        near = np.flatnonzero(best > promise)
        best[near] = np.minimum(best[near], closest(points[near], np.broadcast_to(triangles[row], (len(near), 3, 3))))
    small = triangles[order[large:]]
    if len(small):
        _, index = cKDTree(middle[order[large:]]).query(points, k=min(candidates, len(small)))
        for column in index.reshape(len(points), -1).T:
            left = np.flatnonzero(best > promise)
            best[left] = np.minimum(best[left], closest(points[left], small[column[left]]))
    for row in np.flatnonzero(best > promise).tolist():
        best[row] = closest(np.broadcast_to(points[row], (len(triangles), 3)), triangles).min()
    return best.max(initial=0.0)


def closest(point, triangle):
    a, b, c = triangle[:, 0], triangle[:, 1], triangle[:, 2]
    best = np.full(len(point), np.inf)
    for p, q in ((a, b), (b, c), (c, a)):
        t = np.clip(((point - p) * (q - p)).sum(1) / np.maximum(((q - p) ** 2).sum(1), 1e-300), 0, 1)
        best = np.minimum(best, np.linalg.norm(point - p - t[:, None] * (q - p), axis=1))
    gram = np.stack([np.stack([((b - a) ** 2).sum(1), ((b - a) * (c - a)).sum(1)], 1),
                     np.stack([((b - a) * (c - a)).sum(1), ((c - a) ** 2).sum(1)], 1)], 1)  # fmt: skip
    right = np.stack([((point - a) * (b - a)).sum(1), ((point - a) * (c - a)).sum(1)], 1)
    flat = np.linalg.det(gram) <= 1e-12 * gram[:, 0, 0] * gram[:, 1, 1]
    gram[flat] = np.eye(2)
    st = np.linalg.solve(gram, right[..., None])[..., 0]
    over = ~flat & (st >= 0).all(1) & (st.sum(1) <= 1)
    foot = a + st[:, :1] * (b - a) + st[:, 1:] * (c - a)
    return np.where(over, np.minimum(best, np.linalg.norm(point - foot, axis=1)), best)


def surface_points(part, number, count, rng):
    """Random points of a face, inside its trim."""
    trim = part.trim(number)
    u = rng.uniform(trim.box[0], trim.box[1], 3 * count)
    v = rng.uniform(trim.box[2], trim.box[3], 3 * count)
    keep = np.flatnonzero(trim.inside(u, v))[:count]
    return values(part.adaptor(number), u[keep], v[keep])
