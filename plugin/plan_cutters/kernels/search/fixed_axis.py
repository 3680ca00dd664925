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


@kernel
def _stands(row, axis, contacts, low, high, tool, solids, body, f, t, workspace, hint):
    """Return whether the tool stands free at a contact with an axis, and the triangle that was in its way last."""
    n, e1 = contacts.normal[row], contacts.direction_max[row]
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
        return False, hint
    offset, rise = tool.mode[mode, OFFSET_OF], tool.mode[mode, RISE]
    stand(body, Frame(contacts.point[row], n, f, t), cosine, sine, offset, rise)
    triangle, _, _, _, _ = tree_hit(solids.tree, body, tool.piece[mode], 0.0, hint, workspace)
    if triangle >= 0:
        return False, triangle
    return inside(body, tool, mode, solids, workspace.stack) < MAYBE_INSIDE, hint


@entry
def served(rows, axis, contacts, low, high, tool, solids, free):
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
    free : (m,) bool, written
        Whether the tool touches there at that tilt, no triangle reaches into it, and it lies in no body.

    Returns
    -------
    int
        How many times the tool was put down: where the surface faces the axis.
    """
    body, f, t = np.empty(BODY), np.empty(3), np.empty(3)
    workspace = scratch()
    least, count, hint = np.cos(min(high, np.pi)) - 1e-9, 0, -1
    for i in range(len(rows)):
        free[i] = False
        if dot(axis, contacts.normal[rows[i]]) >= least:
            count += 1
            free[i], hint = _stands(rows[i], axis, contacts, low, high, tool, solids, body, f, t, workspace, hint)
    return count
