"""Bodies on, in and under one another, and plans of them with a small cutter."""

import numpy as np

from plan_cutters import Cutter, plan
from tests.support.cad_parts import box, compound, triangulated

SMALL = Cutter.flat(radius=2, length=30)


def judged(shape, *, cutter=SMALL, faces="all", grid=5, **more):
    return plan(shape, cutters=[cutter], faces=faces, grid=grid, area_budget=0, jobs=2, **more)


def reached(result):
    return result.reaches[result.cutters[0].id].reached


def stacked():
    """A block, and another one standing on the middle of its top."""
    return compound(box(40, 40, 20), box(20, 20, 60, at=(10, 10, 20)))


def within(result, low, high):
    """Rows whose cutter, tolerance taken off, has a point of its axis or of its wall within a box."""
    cutter = Cutter.parse(result.cutters[0].id)
    reach, samples = result.reaches[cutter.id], result.samples
    turn = np.linspace(0, 2 * np.pi, 12, endpoint=False)
    found = []
    for i in np.flatnonzero(reach.reached):
        normal, axis, tilt_direction = samples.normal[i], reach.axis[i], reach.tilt_direction[i]
        x_t = (axis @ normal) * tilt_direction - (axis @ tilt_direction) * normal
        middle = samples.point[i] - cutter.radius * x_t
        heights = np.linspace(0.02, cutter.length - 0.02, 9)[:, None, None]
        ring = np.cos(turn)[:, None] * x_t + np.sin(turn)[:, None] * np.cross(axis, x_t)
        points = np.concatenate([middle + heights * axis + r * ring for r in (0.0, 0.5 * cutter.radius, cutter.radius - 0.02)])
        if (np.minimum(points - low, np.array(high) - points).min(axis=2) > 0.02).any():
            found.append(int(i))
    return found


def lidded(gap=3.0):
    """A plate under a larger lid of triangles."""
    return compound(box(40, 40, 10), triangulated(box(80, 80, 2, at=(-20, -20, 10 + gap))))
