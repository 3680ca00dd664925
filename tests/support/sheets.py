"""Surroundings of a few triangles, for laws that need no part."""

import numpy as np

from cad_io.arrays import Triangles
from plan_cutters.scene.obstacles import Obstacles
from plan_cutters.scene.surroundings import Surroundings
from plan_cutters.setups import solids


def around(vertex, face=1, chord_error=0.0):
    """Triangles (n, 3, 3) of one face that are surely in the way and enclose nothing."""
    return Surroundings.sheet(
        Obstacles(
            Triangles(np.asarray(vertex, float), np.broadcast_to(np.asarray(face, np.int32), len(vertex)).copy(), chord_error, ())
        )
    )


#: The skin of a cube.
AROUND = around(solids.box(np.zeros(3), np.ones(3)))
