"""Boxes around faces."""

from collections.abc import Container

import numpy as np
from OCP.Bnd import Bnd_Box
from OCP.BRepBndLib import BRepBndLib
from OCP.TopoDS import TopoDS_Face

from cad_io.arrays import Floats
from cad_io.kernel import may_refuse


def box_of(faces: list[TopoDS_Face], excluded: Container[int]) -> tuple[Floats, Floats]:
    """Tight corners of the box around faces.

    The kernel's quick box is padded and its tight one is slow, so the tight one is asked only of faces whose padded
    box still sticks out of what is covered, the farthest first; of faces set aside it is not asked at all.
    """
    loose = np.array([face_box(face, tight=False) for face in faces])
    usable = np.isfinite(loose).all(axis=(1, 2))
    low, high = np.full(3, np.inf), np.full(3, -np.inf)
    if not usable.any():
        return low, high
    stick = np.concatenate(
        [loose[:, 0] - np.nanmin(loose[usable, 0], axis=0), np.nanmax(loose[usable, 1], axis=0) - loose[:, 1]], axis=1
    )
    for i in np.argsort(np.where(usable, stick.min(axis=1), np.inf), kind="stable")[: usable.sum()]:
        if (loose[i, 0] < low).any() or (loose[i, 1] > high).any():
            tight = loose[i] if i + 1 in excluded else face_box(faces[i], tight=True)
            tight = tight if np.isfinite(tight).all() else loose[i]
            low, high = np.minimum(low, tight[0]), np.maximum(high, tight[1])
    return low, high


def face_box(face: TopoDS_Face, *, tight: bool) -> Floats:
    """Corners (2, 3) of the box around a face, nan where it has none; not `tight`: quick, and somewhat wider."""
    box = Bnd_Box()
    with may_refuse():
        if tight:
            BRepBndLib.AddOptimal_s(face, box, False, False)
        else:
            BRepBndLib.Add_s(face, box, False)
        if not (box.IsVoid() or box.IsOpen()):
            box.SetGap(0.0)
            return np.array([box.CornerMin().Coord(), box.CornerMax().Coord()])
    return np.full((2, 3), np.nan)
