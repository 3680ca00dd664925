"""The largest radius that reaches each sample, for one shape of end mill."""

from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from cad_io.arrays import Floats, Ints, Record
from plan_cutters.domain.verdicts import Bytes

Shape = Literal["flat", "ball"]

#: Percentiles that are told.
PERCENTILES = (0, 5, 25, 50, 75, 95)


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class RadiusMap(Record):
    """Of a row of radii, each larger than the one before by a step, the largest that reaches each sample.

    Attributes
    ----------
    shape : str
        `flat` or `ball`: a bare end mill, which cuts over all of its length.
    ratio : float
        Its length over its radius.
    step : float
        By which share each radius is larger than the one before.
    least, most : float
        Radii looked at, from and to, mm.
    radius : (n,) float
        mm. 0 where not even the least one reaches a sample; `most` where that one does: the largest is no less. nan where
        the sample is not judged.
    beyond : (n,) uint8
        The verdict on the next radius, INACCESSIBLE or UNDECIDED; UNJUDGED where none was looked at.
    reason : (n,) uint8
        Why that one does not reach the sample, an index into REASONS; else NO_REASON.
    axis, tilt_direction : (n, 3) float
        Unit tool axis and tilt direction of a posture at `radius`; nan where there is none.
    tilt : (n,) float
        rad, nan where there is none.
    rotation : (n,) int32
        Index into the posture range's rotations, -1 where there is none.
    """

    shape: Shape
    ratio: float
    step: float
    least: float
    most: float
    radius: Floats
    beyond: Bytes
    reason: Bytes
    axis: Floats
    tilt_direction: Floats
    tilt: Floats
    rotation: Ints

    @property
    def lean(self) -> Floats:
        """The former name of `tilt_direction`."""
        return self.tilt_direction

    @property
    def judged(self) -> NDArray[np.bool_]:
        """Samples (n,) of which something is known."""
        return ~np.isnan(self.radius)

    @property
    def no_less(self) -> NDArray[np.bool_]:
        """Samples (n,) that even the largest radius looked at reaches: theirs is no less."""
        return np.asarray(self.radius == self.most)

    @property
    def less(self) -> NDArray[np.bool_]:
        """Samples (n,) that not even the least radius looked at reaches."""
        return np.asarray(self.radius == 0.0)

    @property
    def bottleneck(self) -> int | None:
        """The first of the samples with the smallest radius; None if none is judged."""
        return int(np.nanargmin(self.radius)) if self.judged.any() else None

    def percentiles(self, area: Floats | None = None) -> dict[int, float]:
        """Radii, mm, by percentile q: at least q % of the judged samples have that one or a smaller one as their largest.

        Parameters
        ----------
        area : (n,) float, optional
            What each sample counts, mm2 for instance; all count the same by default.

        Returns
        -------
        dict of int to float
            For each of PERCENTILES; empty if no sample that counts is judged.
        """
        weight = np.ones(len(self.radius)) if area is None else area
        counts = self.judged & (weight > 0.0)
        if not counts.any():
            return {}
        radius, weight = self.radius[counts], weight[counts]
        order = np.argsort(radius, kind="stable")
        share = np.cumsum(weight[order])
        # What rounding adds up must not move a percentile past a sample.
        at = np.searchsorted(share, share[-1] * (np.array(PERCENTILES) / 100.0 - 1e-12))
        return {q: float(radius[order[i]]) for q, i in zip(PERCENTILES, at, strict=True)}
