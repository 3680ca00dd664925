"""One tool axis, kept for many contacts: at which of them does the tool stand free with it?"""

import numpy as np

from plan_cutters.kernels.codes import OFFSET_OF, RISE
from plan_cutters.kernels.jit import entry
from plan_cutters.kernels.linear.vectors import cross, dot
from plan_cutters.kernels.material import MAYBE_INSIDE
from plan_cutters.kernels.rows import Frame
from plan_cutters.kernels.search.place import inside, mode_at
from plan_cutters.kernels.tool.hit import BODY, scratch, stand, tree_hit

#: Sines of a tilt below which the axis is the normal, and leans nowhere.
_UPRIGHT = 1e-12


@entry
def served(rows, axis, contacts, low, high, tool, solids, free):
    """Test one axis at contacts, as a search tests the postures that it finds.

    Parameters
    ----------
    rows : (m,) int64
    axis : (3,) float64
        Unit, from the tip to the spindle.
    contacts : Contacts
    low, high : float
        Tilts that there are, rad.
    tool : Tool
        Smaller by what does not matter.
    solids : Solids
        All that may be in the way.
    free : (n,) bool, written
        Whether the tool touches there at that tilt, no triangle reaches into it, and it lies in no body.
    """
    body, f, t = np.empty(BODY), np.empty(3), np.empty(3)
    workspace = scratch()
    hint = -1
    for row in rows:
        free[row] = False
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
            continue
        offset, rise = tool.mode[mode, OFFSET_OF], tool.mode[mode, RISE]
        stand(body, Frame(contacts.point[row], n, f, t), cosine, sine, offset, rise)
        triangle, _, _, _, _ = tree_hit(solids.tree, body, tool.piece[mode], 0.0, hint, workspace)
        if triangle >= 0:
            hint = triangle
            continue
        free[row] = inside(body, tool, mode, solids, workspace.stack) < MAYBE_INSIDE
