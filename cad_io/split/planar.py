"""Segments and loops in a plane: where they cross, what lies inside, how they turn. Only arrays."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from cad_io.arrays import Floats

#: Pairs of blocks and segments that are looked at together; segments of a block.
_TOGETHER, _BLOCK = 400_000, 16


class Crossings(NamedTuple):
    """Pairs of segments that cross: numbers i and j, and the shares of their lengths at which they do."""

    i: NDArray[np.intp]
    j: NDArray[np.intp]
    at_i: Floats
    at_j: Floats


def crossings(p: Floats, q: Floats) -> Crossings:
    """Tell where segments p (n, 2, 2) cross segments q (m, 2, 2).

    Of each segment one end counts and the other does not, so that a chain is crossed once where two of its segments meet.
    """
    none = np.empty(0, np.intp)
    result = [Crossings(none, none, np.empty(0), np.empty(0))]
    low, high = np.minimum(p[:, 0], p[:, 1]), np.maximum(p[:, 0], p[:, 1])
    q_low, q_high = np.minimum(q[:, 0], q[:, 1]), np.maximum(q[:, 0], q[:, 1])
    near = np.flatnonzero(((q_low <= high.max(axis=0)) & (q_high >= low.min(axis=0))).all(axis=1)) if len(p) else none
    q_low, q_high = q_low[near], q_high[near]
    # Of a chain, segments that follow each other lie together: most are told apart by the box around a block of them.
    starts = np.arange(0, len(p), _BLOCK)
    rows = max(1, _TOGETHER // max(len(near), 1))
    for begin in range(0, len(starts) if len(near) else 0, rows):
        some = starts[begin : begin + rows]
        stop = min(int(some[-1]) + _BLOCK, len(p))
        spans = np.minimum.reduceat(low[:stop], some), np.maximum.reduceat(high[:stop], some)
        apart = (spans[0][:, :1] > q_high[:, 0]) | (spans[1][:, :1] < q_low[:, 0])
        apart |= (spans[0][:, 1:] > q_high[:, 1]) | (spans[1][:, 1:] < q_low[:, 1])
        block, k = np.nonzero(~apart)
        i = (some[block][:, None] + np.arange(_BLOCK)).ravel()
        k = np.repeat(k, _BLOCK)[i < stop]
        i = i[i < stop]
        touch = ((low[i] <= q_high[k]) & (high[i] >= q_low[k])).all(axis=1)
        i, k = i[touch], k[touch]
        order = np.lexsort((k, i))
        i, j = i[order], near[k[order]]
        a, b, c, d = p[i, 0], p[i, 1], q[j, 0], q[j, 1]
        of_c, of_d, of_a, of_b = _side(a, b, c), _side(a, b, d), _side(c, d, a), _side(c, d, b)
        hit = ((of_c >= 0) != (of_d >= 0)) & ((of_a >= 0) != (of_b >= 0))
        i, j, of_a, of_b, of_c, of_d = (x[hit] for x in (i, j, of_a, of_b, of_c, of_d))
        result.append(Crossings(i, j, of_a / (of_a - of_b), of_c / (of_c - of_d)))
    return Crossings(*(np.concatenate(each) for each in zip(*result, strict=True)))


def _side(a: Floats, b: Floats, p: Floats) -> Floats:
    """Positive where p lies left of the line from a to b."""
    return np.asarray((b[:, 0] - a[:, 0]) * (p[:, 1] - a[:, 1]) - (b[:, 1] - a[:, 1]) * (p[:, 0] - a[:, 0]))


def nearest(segments: Floats, point: Floats) -> tuple[int, float, float]:
    """The segment of (n, 2, 2) that is nearest to a point (2,): its number, the share of its length, the distance."""
    start, step = segments[:, 0], segments[:, 1] - segments[:, 0]
    share = np.clip(((point - start) * step).sum(axis=1) / np.maximum((step * step).sum(axis=1), 1e-300), 0, 1)
    away = np.linalg.norm(start + share[:, None] * step - point, axis=1)
    k = int(away.argmin())
    return k, float(share[k]), float(away[k])


def chain(path: Floats) -> Floats:
    """Segments (n - 1, 2, 2) of a path (n, 2)."""
    return np.stack([path[:-1], path[1:]], axis=1)


def enclosed(path: Floats) -> float:
    """Area that a closed path (n, 2) encloses, positive if it runs counter-clockwise."""
    x, y = (path - path[0]).T
    return 0.5 * float(np.dot(x, np.roll(y, -1)) - np.dot(np.roll(x, -1), y))


def extent(path: Floats) -> float:
    """How far a path (n, 2) leads away from its start at most."""
    return float(np.linalg.norm(path - path[0], axis=1).max())


def bearing(path: Floats, radius: float) -> float:
    """Direction, rad, in which a path (n, 2) first leaves a circle around its start; of its farthest point if it does not."""
    away = np.linalg.norm(path - path[0], axis=1)
    k = max(1, int(np.argmax(away >= radius)) if (away >= radius).any() else int(away.argmax()))
    share = (radius - away[k - 1]) / (away[k] - away[k - 1]) if away[k] > away[k - 1] else 1.0
    x, y = path[k - 1] + min(max(share, 0.0), 1.0) * (path[k] - path[k - 1]) - path[0]
    return float(np.arctan2(y, x))


def left_of(path: Floats, reach: float) -> Floats:
    """A point (2,) close to the left of the longest step of a closed path (n, 2), at most `reach` away."""
    step = np.roll(path, -1, axis=0) - path
    length = np.linalg.norm(step, axis=1)
    k = int(length.argmax())
    normal = np.array([-step[k, 1], step[k, 0]]) / max(length[k], 1e-300)
    return np.asarray(path[k] + 0.5 * step[k] + normal * min(1e-3 * float(length[k]), reach))
