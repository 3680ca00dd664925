"""Is a point within the material of a solid? By the kernel's own exact surfaces."""

from collections.abc import Iterable

import numpy as np
from numpy.typing import NDArray
from OCP.BRepClass3d import BRepClass3d_SolidClassifier
from OCP.gp import gp_Pnt
from OCP.Precision import Precision
from OCP.TopAbs import TopAbs_IN
from OCP.TopoDS import TopoDS_Shape

from cad_io.arrays import Floats
from cad_io.kernel.calls import translated


def within(solids: Iterable[TopoDS_Shape], points: Floats) -> NDArray[np.bool_]:
    """Which points (n, 3) lie in one of some solids, mm, off its surface by more than the kernel's tolerance.

    Raises
    ------
    CadIoError
        The kernel cannot tell.
    """
    inside = np.zeros(len(points), bool)
    for solid in solids:
        with translated("asking whether points lie in a solid"):
            classifier = BRepClass3d_SolidClassifier(solid)
            for k, (x, y, z) in enumerate(points.tolist()):
                if not inside[k]:
                    classifier.Perform(gp_Pnt(x, y, z), Precision.Confusion_s())
                    inside[k] = classifier.State() == TopAbs_IN
    return inside
