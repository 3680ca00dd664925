"""Areas of a surface that are lost: connected samples with their place."""

from dataclasses import dataclass

import numpy as np

from cad_io.arrays import Floats

#: Faces that are named of an area.
_FACES = 5


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

    @property
    def words(self) -> str:
        """It with its place.

        >>> Patch(57.2, 0.01, 9, ("F31",), (12.0, 3.0, -8.04), 4.13).words
        '57 mm2 of F31, about (12, 3, -8.04), 4.1 mm across'
        """
        more = len(self.faces) - _FACES
        on = ", ".join(self.faces[:_FACES]) + (f" and {more} more" if more > 0 else "")
        where = ", ".join(f"{round(x, 4) + 0.0:.3g}" for x in self.place)
        wide = f", {float(f'{self.across:.2g}'):g} mm across" if self.across else ""
        return f"{size(self.area)} of {on}, about ({where}){wide}"


def size(area: float) -> str:
    """An area in words.

    >>> size(12345.6), size(5.76)
    ('12,346 mm2', '5.8 mm2')
    """
    return f"{area:,.0f} mm2" if area >= 20.0 else f"{area:.2g} mm2"


def weights(area: Floats) -> Floats:
    """Take areas as weights: an area that is not known weighs nothing, and where none is known each weighs as much.

    >>> weights(np.array([2.0, np.nan])).tolist(), weights(np.zeros(2)).tolist()
    ([2.0, 0.0], [1.0, 1.0])
    """
    known = np.where(np.isfinite(area), area, 0.0).clip(min=0.0)
    return known if known.sum() > 0.0 else np.ones(len(area))
