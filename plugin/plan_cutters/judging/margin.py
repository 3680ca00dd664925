"""Postures by how much room they leave: to the local gouging bound, and to where the cutter is known to stand free.

It tells what to try first, never what is safe: what is tried goes through the proof.
"""

import numpy as np
from numpy.typing import NDArray

from cad_io.arrays import Floats
from plan_cutters.kernels.codes import OFFSET_OF, RISE
from plan_cutters.scene.conditions import Context

#: Tilts, rad, and rotations that are compared.
_TILTS, _ROTATIONS = np.radians([20.0, 30.0, 40.0, 50.0, 60.0, 70.0]), 12
#: What room to the gouging bound is worth beside nearness to the posture that is known, both from 0 to about 1.
_WORTH = 3.0


def margin(axis: Floats, normal: Floats, tensor: Floats, context: Context) -> NDArray[np.float64]:
    """Room (n,) to the local gouging bound across the lean, in sines of the tilt of a flat end; -inf where it does not touch.

    Parameters
    ----------
    axis, normal : (n, 3) float
        Unit.
    tensor : (n, 3, 3) float
        Second fundamental form in part coordinates, 1/mm, concave positive.
    context : Context
    """
    mode = context.outer_tool.mode[0]
    cosine = (axis * normal).sum(axis=1)
    across = np.cross(normal, axis)
    sine = np.linalg.norm(across, axis=1)
    t = across / np.maximum(sine, 1e-12)[:, None]
    bend = np.einsum("ni,nij,nj->n", t, tensor.reshape(-1, 3, 3), t)
    # Upright, a ball has the curvature of its tip.
    ratio = np.maximum(sine, 1e-12)
    remainder = ratio / (mode[OFFSET_OF] + mode[RISE] * ratio) - bend
    return np.asarray(np.where(cosine > -1e-9, context.cutter.radius * remainder, -np.inf))


def roomiest(normal: Floats, direction: Floats, tensor: Floats, axis: Floats, context: Context) -> tuple[Floats, Floats]:
    """Of some postures the one with most room that is not far from a known one; that one where there is none.

    Parameters
    ----------
    normal, direction : (n, 3) float
        Unit normals and larger principal directions.
    tensor : (n, 3, 3) float
    axis : (n, 3) float
        Of the postures that are known.
    context : Context

    Returns
    -------
    axis, tilt_direction : (n, 3) float
    """
    (low, high), other = context.conditions.postures.tilt, np.cross(normal, direction)
    best, side, most = axis.copy(), direction.copy(), np.full(len(axis), -np.inf)
    for tilt in (each for each in _TILTS if low <= each <= high):
        for turn in np.arange(_ROTATIONS) * (2.0 * np.pi / _ROTATIONS):
            tilt_direction = np.cos(turn) * direction + np.sin(turn) * other
            tried = np.cos(tilt) * normal + np.sin(tilt) * tilt_direction
            worth = (tried * axis).sum(axis=1) + _WORTH * margin(tried, normal, tensor, context)
            better = np.flatnonzero(worth > most)
            better = better[context.conditions.allows(tried[better])]
            best[better], side[better], most[better] = tried[better], tilt_direction[better], worth[better]
    return best, side
