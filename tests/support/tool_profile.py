"""The outline of a tool from its words alone, and how deep points of a surface lie in it."""

import math
from functools import cache

import numpy as np

from plan_cutters.domain.shapes import flute_length
from tests.support.contacts import wandering


@cache
def profile(cutter, n=4000):
    """Radius of the whole tool over heights (n,), from its words alone."""
    r, corner, top = cutter.radius, cutter.corner_radius, cutter.length
    stages = [] if cutter.holder is None else cutter.holder.stages
    w = np.linspace(0.0, top + sum(stage.length for stage in stages), n)
    tilt_direction, offset = cutter.taper, r - corner
    tangent = corner * (1.0 - math.sin(tilt_direction))
    flank = offset + corner * math.cos(tilt_direction) + (w - tangent) * math.tan(tilt_direction)
    nose = offset + np.sqrt(np.maximum(0.0, corner**2 - (corner - w) ** 2))
    q = np.where(w < tangent, nose, flank)
    if cutter.shape == "lollipop":
        q = np.where(w < r, np.sqrt(np.maximum(0.0, r * r - (w - r) ** 2)),
                     np.maximum(cutter.shank_radius, np.sqrt(np.maximum(0.0, r * r - (w - r) ** 2))))  # fmt: skip
    if cutter.shape == "barrel":
        flank = r - cutter.arc_radius + np.sqrt(np.maximum(0.0, cutter.arc_radius**2 - (w - cutter.arc_height) ** 2))
        tip = np.sqrt(np.maximum(0.0, corner**2 - (w - corner) ** 2))
        joint = (cutter.arc_radius - r) / (cutter.arc_radius - corner)
        q = np.where(w < corner * (1.0 - math.sqrt(1.0 - joint**2)), tip, flank)
        q = np.where(w > cutter.flutes, flank[np.argmin(abs(w - cutter.flutes))], q)
    if cutter.shape == "lens":
        centre = cutter.arc_radius - math.sqrt((cutter.arc_radius - corner) ** 2 - offset**2)
        bottom = np.sqrt(np.maximum(0.0, cutter.arc_radius**2 - (cutter.arc_radius - w) ** 2))
        joint = cutter.arc_radius * (1.0 - math.cos(math.asin(offset / (cutter.arc_radius - corner))))
        side = offset + np.sqrt(np.maximum(0.0, corner**2 - (np.minimum(w, centre) - centre) ** 2))
        q = np.where(w < joint, bottom, side)
    low = top
    for stage in stages:
        share = (w - low) / stage.length
        q = np.where((w >= low) & (share <= 1.0), stage.radius + share * (stage.upper_radius - stage.radius), q)
        low += stage.length
    return w, q


def touching(cutter, normal, axis, x_t):
    """From the contact to the tip on the axis: the point of the flutes farthest towards the surface touches it."""
    w, q = profile(cutter, 40_000)
    q = np.where(w <= flute_length(cutter), q, -np.inf)
    best = int(np.argmax(q * (x_t @ -normal) + w * (axis @ -normal)))
    return -max(q[best], 0.0) * x_t - w[best] * axis


def deepest(found, geometry, whole, cutter, cloud, count, rng):
    """Largest of the depths of the surface in the tool over random contacts in served cells, mm, to the profile's grain."""
    return deepest_of(cutter, wandering(found, geometry, whole, cloud, count, rng))


def deepest_of(cutter, contacts):
    """Largest of the depths, mm, of points in the tool; of contacts with normal, axis, x_T and the points of a surface."""
    worst, (w, q) = -math.inf, profile(cutter)
    # To the outline and its mirror image; a jump of the radius is a side, too.
    steps = np.linspace(0.0, 1.0, 20)
    near_w = np.concatenate([w, [w[-1]], np.repeat(w[-1], 20)])
    near_q = np.concatenate([q, [0.0], steps * q[-1]])
    for contact, normal, axis, x_t, surface in contacts:
        points = surface - contact - touching(cutter, normal, axis, x_t)
        height = points @ axis
        within = (height > 0.0) & (height < w[-1])
        points, height = points[within], height[within]
        radial = np.linalg.norm(points - height[:, None] * axis, axis=1)
        for point in np.flatnonzero(radial < np.interp(height, w, q)):
            apart = np.hypot(near_w - height[point], near_q - radial[point]).min()
            worst = max(worst, float(min(apart, max(height[point], 0.0) + 1e9 * (q[0] == 0.0))))
    return worst
