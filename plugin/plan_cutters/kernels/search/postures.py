"""Postures that are known from elsewhere: at which contacts does the tool stand free in its own one?

They are tested as a search tests what it finds: among all obstacles, and within no body.
"""

import numpy as np

from plan_cutters.kernels.codes import OFFSET_OF, RISE
from plan_cutters.kernels.jit import entry
from plan_cutters.kernels.linear.vectors import cross, dot
from plan_cutters.kernels.material import MAYBE_INSIDE
from plan_cutters.kernels.rows import Frame
from plan_cutters.kernels.search.place import inside, mode_at, straightened
from plan_cutters.kernels.tool.apart import BODY
from plan_cutters.kernels.tool.hit import scratch, stand, tree_hit


@entry
def free(rows, point, normal, axis, tilt_direction, tool, solids, stands):
    """Test given postures.

    Parameters
    ----------
    rows : (m,) int64
        Contacts to test, neighbours in sequence: a triangle in the way at one of them is tried first at the next.
    point, normal, axis, tilt_direction : (n, 3) float64
        Contact, unit normal, unit tool axis, tilt direction: a unit vector, or shorter with the contact under the flat.
    tool : Tool
        Smaller by what does not matter.
    solids : Solids
        All that may be in the way.
    stands : (n,) bool, written
        False also at a tilt at which the tool does not touch.

    Returns
    -------
    int
        How many boxes were looked at.
    """
    body, f, t = np.empty(BODY), np.empty(3), np.empty(3)
    workspace = scratch()
    hint = -1
    for row in rows:
        stands[row] = False
        n, share = normal[row], straightened(tilt_direction[row], f)
        cross(n, f, t)
        cosine, sine = dot(axis[row], n), dot(axis[row], f)
        mode = mode_at(tool, np.arctan2(sine, cosine))
        if mode < 0:
            continue
        stand(body, Frame(point[row], n, f, t), cosine, sine, share * tool.mode[mode, OFFSET_OF], tool.mode[mode, RISE])
        triangle, _, _, _, _ = tree_hit(solids.tree, body, tool.piece[mode], 0.0, hint, workspace)
        if triangle >= 0:
            hint = triangle
            continue
        stands[row] = not inside(body, tool, mode, solids, MAYBE_INSIDE, workspace)
    return workspace.looked[0]
