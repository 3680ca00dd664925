"""Bound the pieces of a tool that tilts, and their extent along a direction over an interval of tilts.

Lemmas are those of `docs/posture_map_proof.md`.
"""

from typing import Any, NamedTuple

import numpy as np

from plan_cutters.kernels.codes import ARC, BOTTOM, CONE, CYLINDER, HIGH, KIND, LOW, RADIUS, ROUND, SLOPE, TOP, WIDE
from plan_cutters.kernels.jit import kernel, maker
from plan_cutters.kernels.rows import Cylinder

#: A bound of a piece: two rims, each a radius and a height, and by how much what lies between them is grown all round; the slope
#: of its side; whether there is such a bound.
Q0, F0, Q1, F1, GROWN, SIDE, THERE, BOUNDS = 0, 1, 2, 3, 4, 5, 6, 7
#: What is known of a piece (lemma M4): nothing nearer to the line of turning or farther from it is ever in it, nothing so far
#: beside it along that line, nothing as low over the centre's tangent plane; its radius at height 0, were it to go on, and its
#: slope if it widens.
NEAR, FAR, LATERAL, FLOOR, AXIS, WIDENS, KNOWN = 0, 1, 2, 3, 4, 5, 6
#: A plane must part by more than this, mm: rounding is far less.
HAIR = 1e-9
#: Parts that the tilts of a mode are cut into to know how low a piece can come.
_PARTS = 16


class Turning(NamedTuple):
    """A tool that tilts about the centre of one mode, for posture maps.

    offset : distance of the centre from the axis, mm; piece (k, COLUMNS); bound (2 k, BOUNDS), two for each piece, of which one
    may be missing; known (k, KNOWN); eight : the mask of the pieces for which the eight sides of `lanes` do.
    """

    offset: float
    piece: Any
    bound: Any
    known: Any
    eight: int


@kernel
def _span(p, q, ca, sa, cb, sb):
    """Return the least and the most of p cos T + q sin T over an interval shorter than 180 deg."""
    u, v, du, dv = p * ca + q * sa, p * cb + q * sb, q * ca - p * sa, q * cb - p * sb
    size = np.sqrt(p * p + q * q)
    least = -size if (du < 0.0) & (dv > 0.0) else min(u, v)
    return least, size if (du > 0.0) & (dv < 0.0) else max(u, v)


@kernel
def most(p, q, ca, sa, cb, sb):
    """Return the most of p cos T + q sin T over an interval shorter than 180 deg."""
    within = (q * ca - p * sa > 0.0) & (q * cb - p * sb < 0.0)
    return np.sqrt(p * p + q * q) if within else max(p * ca + q * sa, p * cb + q * sb)


@kernel
def edge_of(bound, j):
    """A bound as numbers: what lanes have in common must not be read again in each."""
    loose = 1.0 if bound[j, Q0] < 0.0 else 0.0
    return bound[j, Q0], bound[j, F0], bound[j, Q1], bound[j, F1], bound[j, GROWN], bound[j, SIDE], loose


@kernel
def rim_line(edge, gx, gy, gz, ca, sa, cb, sb):
    """Return a line (slope, value at 0) that bounds how far a rim of radius 1 goes along a direction of the part over an
    interval.

    It goes hypot(x, g_y), x what the direction has along x_T: convex in x, so below its chord. Where the radius is negative the
    bound is from below: a tangent.
    """
    loose = edge[6]
    low, high = _span(gx, -gz, ca, sa, cb, sb)
    rl, rh, middle = np.sqrt(low * low + gy * gy), np.sqrt(high * high + gy * gy), 0.5 * (low + high)
    slope = (rh - rl) / max(high - low, 1e-12)
    base = max(rl - slope * low, rh - slope * high)
    share = 1.0 / max(np.sqrt(middle * middle + gy * gy), 1e-200)
    return slope + loose * (middle * share - slope), base + loose * (gy * gy * share - base)


@kernel
def swept(edge, offset, line, gx, gz, ca, sa, cb, sb):
    """Return how far a bound goes at most, at any tilt of an interval, along a unit direction of the part, from the centre.

    Lemma M6; `line` as `rim_line` gives it. In one function with it, the two would be too long for the compiler to put into
    loops, which then run one lane at a time.
    """
    q0, f0, q1, f1, grown, _, _ = edge
    slope, base = line
    first, second = q0 * slope - offset, q1 * slope - offset
    first = q0 * base + most(first * gx + f0 * gz, f0 * gx - first * gz, ca, sa, cb, sb)
    second = q1 * base + most(second * gx + f1 * gz, f1 * gx - second * gz, ca, sa, cb, sb)
    return max(first, second) + grown


@kernel
def _put_bound(bound, j, q0, f0, q1, f1, grown, slope):
    bound[j, Q0], bound[j, F0], bound[j, Q1], bound[j, F1] = q0, f0, q1, f1
    bound[j, GROWN], bound[j, SIDE], bound[j, THERE] = grown, slope, 1.0


@kernel
def _bounds_of(piece, k, bound):
    """Write the bounds of piece k."""
    radius, slope, wide = piece[k, RADIUS], piece[k, SLOPE], piece[k, WIDE]
    if piece[k, KIND] != ARC:
        slope = slope if piece[k, KIND] != CYLINDER else 0.0
        _put_bound(bound, 2 * k, max(0.0, radius), piece[k, LOW], max(0.0, wide), piece[k, HIGH], 0.0, slope)
        return
    _put_bound(bound, 2 * k, radius, slope, radius, slope, piece[k, ROUND], 0.0)
    if radius < 0.0 or piece[k, BOTTOM] > slope - piece[k, ROUND] or piece[k, TOP] < slope + piece[k, ROUND]:
        _put_bound(bound, 2 * k + 1, wide, piece[k, BOTTOM], wide, piece[k, TOP], 0.0, 0.0)


@kernel
def flutes(turning, k):
    """Piece k as the eight sides take it."""
    piece = turning.piece
    return Cylinder(turning.offset, piece[k, RADIUS], piece[k, LOW], piece[k, HIGH], piece)


@maker
def turning_of(piece, offset, low, high):
    """Compute the bounds of a tool's pieces in one mode, which posture maps need.

    Parameters
    ----------
    piece : (k, COLUMNS) float64
    offset : float
        mm.
    low, high : float
        Tilts that may be requested, rad.

    Returns
    -------
    bound, known, eight
        As in `Turning`.
    """
    count, eight = len(piece), 0
    bound, known = np.zeros((2 * count, BOUNDS)), np.zeros((count, KNOWN))
    for k in range(count):
        _bounds_of(piece, k, bound)
        radius, floor = piece[k, RADIUS], piece[k, LOW]
        bottom, top = piece[k, BOTTOM], piece[k, TOP]
        known[k, NEAR] = max(0.0, max(bottom, -top))
        known[k, LATERAL] = max(piece[k, WIDE], radius)
        known[k, AXIS], known[k, WIDENS] = known[k, LATERAL], 0.0
        if piece[k, KIND] == CONE and piece[k, SLOPE] > 0.0:
            known[k, AXIS], known[k, WIDENS] = radius - piece[k, SLOPE] * floor, piece[k, SLOPE]
        known[k, FAR] = np.hypot(max(abs(bottom), abs(top)), abs(offset) + known[k, LATERAL])
        # The eight sides want a cutter that touches with its rim, and tilts up to 90 deg.
        if piece[k, KIND] == CYLINDER and 0.0 <= floor <= offset - radius + 1e-12 and high <= 0.5 * np.pi + 1e-9:
            eight |= 1 << k
            known[k, FLOOR] = floor
            continue
        deepest = -np.inf
        for part in range(_PARTS):
            a, b = low + (high - low) * part / _PARTS, low + (high - low) * (part + 1) / _PARTS
            reach = np.inf
            for j in range(2 * k, 2 * k + 2):
                if bound[j, THERE] > 0.0:
                    edge, ca, sa, cb, sb = edge_of(bound, j), np.cos(a), np.sin(a), np.cos(b), np.sin(b)
                    line = rim_line(edge, 0.0, 0.0, -1.0, ca, sa, cb, sb)
                    reach = min(reach, swept(edge, offset, line, 0.0, -1.0, ca, sa, cb, sb))
            deepest = max(deepest, reach)
        known[k, FLOOR] = -deepest - HAIR
    return bound, known, eight
