"""One tool axis, kept for many contacts: at which of them does the tool stand free with it?

It stands as it leans by its tilt; upright, with the contact anywhere under the flat of its tip; or with its flank along a wall.
Of the last two the surface may be off its direction by the accuracy of the rotary axes. Wherever the tool stands, all of it is
tested among all obstacles, with the axis as it is given: what is in the way by that much is found.
"""

import numpy as np

from plan_cutters.kernels.codes import OFFSET_OF, RISE
from plan_cutters.kernels.jit import entry, kernel
from plan_cutters.kernels.linear.vectors import cross, dot
from plan_cutters.kernels.material import MAYBE_INSIDE
from plan_cutters.kernels.rows import Frame
from plan_cutters.kernels.search.flats_and_flanks import PLACED, across, find_place, flat_workspace, place_to_direction
from plan_cutters.kernels.search.place import is_free, mode_at
from plan_cutters.kernels.tool.apart import BODY
from plan_cutters.kernels.tool.hit import scratch, stand

#: Sines of a tilt below which the axis is the normal, and leans nowhere.
_UPRIGHT = 1e-12
#: How a tool stands: not at all, leaning by its tilt, upright on its flat, or along a wall.
BLOCKED, LEANING, UPRIGHT, ALONG = -1, 0, 1, 2
_RIGHT = 0.5 * np.pi


@kernel
def _stands(row, axis, contacts, low, high, about, tool, solids, body, sides, workspace, flat, hint, direction):
    """Return how the tool stands free at a contact with an axis, as `served` writes it, and the triangle in its way last."""
    accuracy, away, whole_turn = about
    p, n, e1 = contacts.point[row], contacts.normal[row], contacts.direction_max[row]
    f, t, x, place = sides[0], sides[1], sides[2], sides[3]
    cosine = min(1.0, max(-1.0, dot(axis, n)))
    for k in range(3):
        f[k] = axis[k] - cosine * n[k]
    sine = np.sqrt(dot(f, f))
    tilt = np.arctan2(sine, cosine)
    for k in range(3):
        f[k] = f[k] / sine if sine > _UPRIGHT else e1[k]
        direction[k] = f[k]
    cross(n, f, t)
    mode = mode_at(tool, tilt)
    if mode >= 0 and low <= tilt <= high:
        stand(body, Frame(p, n, f, t), cosine, sine, tool.mode[mode, OFFSET_OF], tool.mode[mode, RISE])
        free, hint = is_free(body, mode, tool, solids, workspace, hint)
        if free:
            return LEANING, hint
    if tilt <= accuracy and low <= 0.0 and whole_turn:
        mode = mode_at(tool, 0.0)
        most = tool.mode[mode, OFFSET_OF] if mode >= 0 else 0.0
        if most > 0.0:
            across(e1, axis, x)
            result, hint = find_place(p, axis, x, tool, mode, tool.mode[mode, RISE], most, solids, MAYBE_INSIDE, 0.0, flat, place)
            if result == PLACED:
                place_to_direction(place, x, flat.y, most, direction)
                return UPRIGHT, hint
    if away >= 0.0 and abs(tilt - _RIGHT) <= accuracy and low <= _RIGHT <= high:
        mode = mode_at(tool, _RIGHT)
        if mode >= 0:
            across(n, axis, x)
            cross(x, axis, t)
            for k in range(3):
                f[k] = p[k] + away * x[k]
                direction[k] = 2.0 * axis[k]
            stand(body, Frame(f, x, axis, t), 0.0, 1.0, tool.mode[mode, OFFSET_OF], tool.mode[mode, RISE])
            free, hint = is_free(body, mode, tool, solids, workspace, hint)
            if free:
                return ALONG, hint
    return BLOCKED, hint


@entry
def served(rows, axis, contacts, low, high, about, tool, solids, way, tilt_direction):
    """Test one axis at contacts, as a search tests the postures that it finds.

    `rows` (m,) int64: neighbours in sequence: a triangle in the way at one of them is tried first at the next.
    `axis` (3,) float64: unit, from the tip to the spindle.
    `low`, `high` (float): tilts that there are, rad.
    `about` (float, float, bool): what counts as upright or as a wall: so far off, rad, none below 0. How far the tool keeps from
      a wall, mm; walls are left out below 0. Whether any side of the bottom may touch.
    `tool`: smaller by what does not matter.
    `solids`: all that may be in the way.
    `way` (m,) int8, written: BLOCKED: the tool does not touch there at that tilt, a triangle reaches into it, or it lies in a
      body. LEANING: it is free as it leans by its tilt, or towards `direction_max` if it has none. UPRIGHT: it is free with its
      bottom across the axis, the contact under the flat. ALONG: it is free with its flank along the wall, at its distance.
    `tilt_direction` (m or 0, 3) float64, written: where the tool leans: a unit direction; UPRIGHT the way from the axis to the
      contact, 1 at the rim of the flat; ALONG the axis, 2 long. Nothing is written if it has no rows.
    Returns how many times the tool was put down: where the surface faces the axis. And how many boxes were looked at.
    """
    body, sides, direction = np.empty(BODY), np.empty((4, 3)), np.empty(3)
    workspace, flat = scratch(), flat_workspace()
    least, count, hint = np.cos(min(high, np.pi)) - 1e-9 - max(0.0, about[0]), 0, -1
    for i in range(len(rows)):
        way[i] = BLOCKED
        if dot(axis, contacts.normal[rows[i]]) >= least:
            count += 1
            way[i], hint = _stands(
                rows[i], axis, contacts, low, high, about, tool, solids, body, sides, workspace, flat, hint, direction
            )
            if way[i] != BLOCKED and len(tilt_direction):
                for k in range(3):
                    tilt_direction[i, k] = direction[k]
    return count, workspace.looked[0]
