"""Areas of a surface that are lost: connected samples with their place."""

from dataclasses import dataclass

import numpy as np

from cad_io.arrays import Floats


@dataclass(frozen=True, slots=True)
class Patch:
    """Connected samples of one kind.

    Attributes
    ----------
    area : float
        That they stand for, mm2.
    share : float
        Of the finished area, 0 to 1.
    samples : int
    faces : tuple of str
        Ids, the one with the most of it first.
    place : (float, float, float)
        The sample nearest to its middle, mm.
    across : float
        Its largest extent, mm, from sample to sample; 0 of a single one.
    """

    area: float
    share: float
    samples: int
    faces: tuple[str, ...]
    place: tuple[float, float, float]
    across: float


def weights(area: Floats) -> Floats:
    """Take areas as weights: an area that is not known weighs nothing, and where none is known each weighs as much.

    >>> weights(np.array([2.0, np.nan])).tolist(), weights(np.zeros(2)).tolist()
    ([2.0, 0.0], [1.0, 1.0])
    """
    known = np.where(np.isfinite(area), area, 0.0).clip(min=0.0)
    return known if known.sum() > 0.0 else np.ones(len(area))
