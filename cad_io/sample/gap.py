"""How far is the border of a face from the face's samples?"""

import numpy as np
from scipy.spatial import cKDTree

from cad_io.arrays import Floats
from cad_io.part import Part

_STEPS, _FEW = 20_000, 200  # along the border, at most: among many samples, or about one
_STRAIGHT = 0.98  # cosine of the angle between segments of the border from which on they make a corner


def border_gap(part: Part, number: int, point: Floats, gap: float) -> float:
    """Largest distance, mm, of a face's border from its nearest sample.

    Parameters
    ----------
    part : Part
    number : int
        Of the face.
    point : (n, 3) float
        Its samples.
    gap : float
        Largest distance between these, mm: the border is looked at twice as densely, and at its corners.
    """
    trim, point = part.trim(number), point[np.isfinite(point).all(axis=1)]
    if trim is None or not len(point):
        return 0.0
    along = (trim.segments[:, 1] - trim.segments[:, 0]) * trim.scale
    length = np.linalg.norm(along, axis=1)
    end = np.cumsum(length)
    count = end[-1] / (0.5 * gap) if gap else _FEW
    at = np.linspace(0.0, end[-1], int(np.clip(np.ceil(count), 1, _STEPS)), endpoint=False)
    which = np.minimum(np.searchsorted(end, at, "right"), len(end) - 1)
    share = np.clip((at - end[which] + length[which]) / np.maximum(length[which], 1e-300), 0.0, 1.0)[:, None]
    # Corners are the farthest: starts of segments that go another way than the one before.
    before = np.roll(along, 1, axis=0)
    corner = (along * before).sum(axis=1) < _STRAIGHT * length * np.roll(length, 1)
    between = (1 - share) * trim.segments[which, 0] + share * trim.segments[which, 1]
    uv = np.concatenate([between, trim.segments[corner, 0]])
    there = part.surface(number).values(uv[:, 0], uv[:, 1])
    there = there[np.isfinite(there).all(axis=1)]
    return float(cKDTree(point).query(there)[0].max(initial=0.0)) if len(there) else 0.0
