"""One tool axis, kept for many contacts: at which of them does the tool stand free with it?"""

import numpy as np

from plan_cutters.kernels.codes import OFFSET_OF, RISE
from plan_cutters.kernels.jit import entry, kernel
from plan_cutters.kernels.linear.vectors import cross, dot
from plan_cutters.kernels.material import MAYBE_INSIDE
from plan_cutters.kernels.rows import Frame
from plan_cutters.kernels.search.place import inside, mode_at
from plan_cutters.kernels.tool.hit import BODY, scratch, stand, tree_hit

#: Sines of a tilt below which the axis is the normal, and leans nowhere.
_UPRIGHT = 1e-12
#: Tilts at which the bottom of a tool may as well lie across its axis, through the contact, rad: no control holds smaller ones.
FLAT = 1e-4
#: Directions in which a tool that stands upright lies on its contact, besides that of its tilt.
DIRECTIONS = 36


@kernel
def _stands(row, axis, contacts, low, high, tool, solids, directions, body, sides, workspace, hint):
    """Return how the tool stands free at a contact with an axis, as `served` writes it, and the triangle in its way last."""
    n, e1 = contacts.normal[row], contacts.direction_max[row]
    f, t, x, y = sides[0], sides[1], sides[2], sides[3]
    cosine = min(1.0, max(-1.0, dot(axis, n)))
    for k in range(3):
        f[k] = axis[k] - cosine * n[k]
    sine = np.sqrt(dot(f, f))
    tilt = np.arctan2(sine, cosine)
    for k in range(3):
        f[k] = f[k] / sine if sine > _UPRIGHT else e1[k]
    cross(n, f, t)
    mode = mode_at(tool, tilt)
    if mode < 0 or tilt < low or tilt > high:
        return -1, hint
    offset, rise = tool.mode[mode, OFFSET_OF], tool.mode[mode, RISE]
    stand(body, Frame(contacts.point[row], n, f, t), cosine, sine, offset, rise)
    free, hint = _is_free(body, mode, tool, solids, workspace, hint)
    if free:
        return 0, hint
    if tilt > FLAT or offset == 0.0:
        return -1, hint
    # The bottom lies across the axis: about the contact the tool may be at any side.
    along = dot(axis, e1)
    for k in range(3):
        x[k] = e1[k] - along * axis[k]
    length = np.sqrt(dot(x, x))
    for k in range(3):
        x[k] /= length
    cross(axis, x, y)
    for number in range(directions):
        turn = 2.0 * np.pi * number / DIRECTIONS
        for k in range(3):
            f[k] = np.cos(turn) * x[k] + np.sin(turn) * y[k]
        cross(axis, f, t)
        stand(body, Frame(contacts.point[row], axis, f, t), 1.0, 0.0, offset, rise)
        free, hint = _is_free(body, mode, tool, solids, workspace, hint)
        if free:
            return number + 1, hint
    return -1, hint


@kernel
def _is_free(body, mode, tool, solids, workspace, hint):
    """Return whether a tool that was put down is free, and the triangle that was in its way last."""
    triangle, _, _, _, _ = tree_hit(solids.tree, body, tool.piece[mode], 0.0, hint, workspace)
    if triangle >= 0:
        return False, triangle
    return inside(body, tool, mode, solids, workspace.stack) < MAYBE_INSIDE, hint


@entry
def served(rows, axis, contacts, low, high, tool, solids, directions, tilt_direction):
    """Test one axis at contacts, as a search tests the postures that it finds.

    Parameters
    ----------
    rows : (m,) int64
        Neighbours in sequence: a triangle in the way at one of them is tried first at the next.
    axis : (3,) float64
        Unit, from the tip to the spindle.
    contacts : Contacts
    low, high : float
        Tilts that there are, rad.
    tool : Tool
        Smaller by what does not matter.
    solids : Solids
        All that may be in the way.
    directions : int
        Directions that are tried where the axis is the normal, of `LEANS`; 0: none but one.
    tilt_direction : (m,) int8, written
        -1: the tool does not touch there at that tilt, a triangle reaches into it, or it lies in a body. 0: it is free as it
        leans by its tilt, or towards `direction_max` if it has none. k > 0: it is free with its bottom across the axis, leaning
        to where k - 1 of `LEANS` parts of a turn about the axis bring `direction_max`.

    Returns
    -------
    int
        How many times the tool was put down: where the surface faces the axis.
    """
    body, sides = np.empty(BODY), np.empty((4, 3))
    workspace = scratch()
    least, count, hint = np.cos(min(high, np.pi)) - 1e-9, 0, -1
    for i in range(len(rows)):
        tilt_direction[i] = -1
        if dot(axis, contacts.normal[rows[i]]) >= least:
            count += 1
            tilt_direction[i], hint = _stands(
                rows[i], axis, contacts, low, high, tool, solids, directions, body, sides, workspace, hint
            )
    return count
