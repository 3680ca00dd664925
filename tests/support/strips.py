"""The widest strips at many contacts, by the kernel for one."""

from types import SimpleNamespace

import numpy as np

from plan_cutters.domain.shapes import modes
from plan_cutters.kernels.linear.strips import Contact, Laid, strip_at, touch_at, workspace


def strips_at(cutter, normal, direction, curvature, axis, scallop, stepover):
    """Width and free width (n,), mm, and unit feed (n, 3) with axes (n, 3); widths are nan where the tool does not touch."""
    mode, work = np.array([(each.offset, each.radius, each.low, each.high) for each in modes(cutter)]), workspace()
    laid = Laid(scallop, stepover * 2.0 * cutter.radius, cutter.radius, 0.0, 0.0, 0.0, 1.0, False)
    width, free_width, feed = np.full(len(axis), np.nan), np.full(len(axis), np.nan), np.empty((len(axis), 3))
    for i in range(len(axis)):
        across = np.cross(normal[i], direction[i])
        at = Contact(normal[i], direction[i], across, float(curvature[i, 0]), float(curvature[i, 1]), axis[i])
        touch = touch_at(at, mode, work)
        feed[i] = np.cross(normal[i], work.f)
        if np.isfinite(touch.radius):
            width[i], _, free_width[i], _ = strip_at(at, touch, laid, work)
            feed[i] = work.feed
    return SimpleNamespace(width=width, free_width=free_width, feed=feed)
