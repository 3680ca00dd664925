"""All free tilts at one point and rotation, with certified ends; `free_map` finds those of many samples.

A range of tilts is free if the body, widened by half the range times the distance from the contact, is missed at the
middle. Where the middle itself is blocked, the point in the way forbids an arc; where only the widened body is, the
range is halved. Ranges narrower than `narrowest` stay undecided.
"""

import numpy as np

from plan_cutters.kernels.arcs import point_arc
from plan_cutters.kernels.hit import BODY, cross, scratch, stand, tree_hit
from plan_cutters.kernels.jit import entry
from plan_cutters.kernels.rows import Frame

OPEN, FORBIDDEN, UNSURE = 0, 1, 2


@entry
def free_tilts(p, n, f, low, high, radius, length, depth_allowed, narrowest, tree, room):  # type: ignore[no-untyped-def]
    """Split a range of tilts into free, forbidden and undecided parts.

    Parameters
    ----------
    p, n, f : (3,) float64
        Contact, normal, lean direction.
    low, high : float
        rad.
    radius, length, depth_allowed : float
        Cutter, and the depth up to which a triangle does not matter, mm.
    narrowest : float
        rad.
    tree : Tree
    room : int
        Most parts that can be told apart.

    Returns
    -------
    parts : (k, 3) float64
        first, last, kind (OPEN, FORBIDDEN, UNSURE); together the range asked for, in no order.
    """
    t = np.empty(3)
    cross(n, f, t)
    frame, body = Frame(p, n, f, t), np.empty(BODY)
    walk = scratch()
    parts = np.empty((room + 4, 3))
    pending = np.empty((room + 4, 2))
    pending[0, 0], pending[0, 1] = low, high
    top, done, hint = 1, 0, -1
    shrunk, bottom, ceiling = radius - depth_allowed, depth_allowed, length - depth_allowed
    while top > 0:
        top -= 1
        first, last = pending[top, 0], pending[top, 1]
        tilt, half = 0.5 * (first + last), 0.5 * (last - first)
        stand(body, frame, np.cos(tilt), np.sin(tilt), radius, shrunk, bottom, ceiling)
        # A hair more than half, so that a free range holds at its very ends.
        triangle, height, px, py = tree_hit(tree, body, half + 1e-12, hint, walk)
        kind, cut_first, cut_last = OPEN, first, last
        if triangle >= 0:
            hint = triangle
            kind, cut_first, cut_last = UNSURE, tilt, tilt
            triangle, height, px, py = tree_hit(tree, body, 0.0, hint, walk)
            if triangle >= 0:
                hint = triangle
                arc_first, arc_last = point_arc(height, px, py, tilt, radius, shrunk, bottom, ceiling)
                kind = FORBIDDEN
                cut_first, cut_last = max(first, min(arc_first, tilt)), min(last, max(arc_last, tilt))
            if last - first <= narrowest or top + done + 3 > room:
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
