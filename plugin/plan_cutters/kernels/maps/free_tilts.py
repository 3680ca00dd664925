"""All free tilts at one point and rotation, with certified ends; `free_map` finds those of many samples.

A range of tilts is free if the body, widened by half the range times the distance from the contact, is missed at the middle
(`docs/at_a_sample.md`, lemma S5). Where it is hit at the middle without widening, the point in the way forbids an arc; where only
the widened body is, the range is halved. Ranges narrower than `narrowest` stay undecided.
"""

import numpy as np

from cad_io.arrays import Floats
from plan_cutters.kernels.codes import OFFSET_OF
from plan_cutters.kernels.jit import entry
from plan_cutters.kernels.limits import held_tilts
from plan_cutters.kernels.linear.vectors import cross
from plan_cutters.kernels.rows import Frame, Ranges
from plan_cutters.kernels.search.place import arc_of, put
from plan_cutters.kernels.tool.apart import BODY
from plan_cutters.kernels.tool.arcs import ARCS, local_gouge
from plan_cutters.kernels.tool.hit import scratch, tree_hit

OPEN, FORBIDDEN, UNSURE = 0, 1, 2


@entry
def free_tilts(p, n, f, low, high, tool, mode, narrowest, tree, most):
    """Split a range of tilts into free, forbidden and undecided parts.

    `p`, `n`, `f` (3,) float64: contact, normal, tilt direction.
    `low`, `high` (float): rad.
    `tool`: without what does not matter.
    `mode` (int): in which it touches.
    `narrowest` (float): rad.
    `most` (int): most parts that can be told apart.
    Returns `parts` (k, 3) float64: first, last, kind (OPEN, FORBIDDEN, UNSURE); together the range asked for, in no order.
    """
    t, body, walk, piece = np.empty(3), np.empty(BODY), scratch(), tool.piece[mode]
    parts, pending, arcs = np.empty((most + 4, 3)), np.empty((most + 4, 2)), np.empty((ARCS, 2))
    cross(n, f, t)
    frame = Frame(p, n, f, t)
    pending[0, 0], pending[0, 1] = low, high
    top, done, hint = 1, 0, -1
    while top > 0:
        top -= 1
        first, last = pending[top, 0], pending[top, 1]
        tilt, half = 0.5 * (first + last), 0.5 * (last - first)
        put(body, frame, tilt, tool, mode)
        # A hair more than half, so that a free range holds at its very ends.
        triangle, which, height, px, py = tree_hit(tree, body, piece, half + 1e-12, hint, walk)
        kind, cut_first, cut_last = OPEN, first, last
        if triangle >= 0:
            hint = triangle
            kind, cut_first, cut_last = UNSURE, tilt, tilt
            triangle, which, height, px, py = tree_hit(tree, body, piece, 0.0, hint, walk)
            if triangle >= 0:
                hint = triangle
                arc_first, arc_last = arc_of(which, height, px, py, tilt, tool.mode[mode, OFFSET_OF], piece, 0.0, arcs)
                kind = FORBIDDEN
                cut_first, cut_last = max(first, min(arc_first, tilt)), min(last, max(arc_last, tilt))
            if last - first <= narrowest or top + done + 3 > most:
                kind, cut_first, cut_last = UNSURE, first, last
        # What is cut out is settled; the rest, at most half on either side or narrower, is not.
        parts[done, 0], parts[done, 1], parts[done, 2] = cut_first, cut_last, kind
        if cut_last > cut_first:
            done += 1
        if cut_last < last:
            pending[top, 0], pending[top, 1] = cut_last, last
            top += 1
        if cut_first > first:
            pending[top, 0], pending[top, 1] = first, cut_first
            top += 1
    return parts[:done]


def local_gouge_range(kappa_max: float, kappa_min: float, rotation: float, offset: float, radius: float) -> tuple[float, float]:
    """Least and largest tilt without local gouging, rad; nan if there is none. Arguments as of `arcs.local_gouge`."""
    least, most = local_gouge(kappa_max, kappa_min, np.cos(rotation), np.sin(rotation), offset, radius)
    return float(least), float(most)


def axis_intervals(normal: Floats, tilt_direction: Floats, ranges: Ranges) -> Floats:
    """Tilts (k, 2) within those asked for that a machine's limits leave at a normal and a tilt direction (3,)."""
    out = np.empty((64, 2))
    return out[: held_tilts(normal, tilt_direction, ranges, ranges.tilt_low, ranges.tilt_high, out)].copy()
