"""The answers that may be requested after the plan: their words, and the records of what each says."""

from dataclasses import dataclass
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from cad_io.arrays import Floats, Ints, Record
from plan_cutters.domain.answer_kinds import ANSWERS
from plan_cutters.domain.checks import items, shown
from plan_cutters.domain.verdicts import Bytes
from plan_cutters.errors import OptionError


def answers_of(value: Any) -> tuple[str, ...]:
    """Words of ANSWERS, each once and in that order; `all` for all of them; a text may hold several, joined by commas.

    Raises OptionError: another word.

    >>> answers_of("mend,stick-out")
    ('stick-out', 'mend')
    >>> answers_of("radii")
    Traceback (most recent call last):
    plan_cutters.errors.OptionError: answers: 'radii' is none of stick-out, radius, mend and all
    """
    if isinstance(value, str):
        words: list[Any] = value.split(",") if value.strip() else []
    else:
        words = items(value, "answers", "words", error=OptionError) if value is not None else []
    result = {word.strip().lower() if isinstance(word, str) else word for word in words}
    for word in sorted(result - {*ANSWERS, "all"}, key=str):
        raise OptionError(f"answers: {shown(word)} is none of {', '.join(ANSWERS)} and all")
    return tuple(word for word in ANSWERS if word in result or "all" in result)


def weights(area: Floats) -> Floats:
    """Take areas as weights: an area that is not known weighs nothing, and where none is known each weighs as much.

    >>> weights(np.array([2.0, np.nan])).tolist(), weights(np.zeros(2)).tolist()
    ([2.0, 0.0], [1.0, 1.0])
    """
    known = np.where(np.isfinite(area), area, 0.0).clip(min=0.0)
    return known if known.sum() > 0.0 else np.ones(len(area))


#: What a step may change, from what asks a planner for least to what asks for most: time to compute, how far the tool is tilted,
#: how it is held, another tool, how the part is clamped, another machine, an area that is left to other means. What asks for
#: least comes first among steps that leave as much.
MEANS = (
    "tolerance", "tilt_range", "stick_out", "cutter", "corner_radius", "radius", "holder", "setup", "second_setup",
    "tilt_limit", "area"
)  # fmt: skip


#: Rows that are compared with each other, at most.
_COMPARED = 3000


def essential_rows(table: NDArray[np.bool_]) -> NDArray[np.int64]:
    """Rows (k,), ascending, such that whatever covers these covers all rows of a table (n, m).

    A row that holds all columns of another one is covered with it; of equal rows the first stands for all.

    >>> essential_rows(np.array([[1, 0], [1, 1], [1, 0]], bool)).tolist()
    [0]
    """
    packed = np.packbits(table, axis=1)
    first = np.unique(packed, axis=0, return_index=True)[1]
    if len(first) <= _COMPARED:
        some = table[first].astype(np.float32)
        size = some.sum(axis=1)
        both = some @ some.T
        holds = both >= size[None, :] - 0.5
        np.fill_diagonal(holds, False)
        first = first[~holds.any(axis=1)]
    return np.sort(first)


Shape = Literal["flat", "ball"]

#: Percentiles that are told.
PERCENTILES = (0, 5, 25, 50, 75, 95)


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class RadiusMap(Record):
    """Of a row of radii, each larger than the one before by a step, the largest that reaches each sample."""

    shape: Shape  #: `flat` or `ball`: a bare end mill, which cuts over all of its length.
    ratio: float  #: Its length over its radius.
    step: float  #: By which share each radius is larger than the one before.
    #: `least`, `most`: radii looked at, from and to, mm.
    least: float
    most: float
    #: (n,) float: mm. 0 where not even the least one reaches a sample; `most` where that one does: the largest is no less. nan
    #: where the sample is not judged.
    radius: Floats
    beyond: Bytes  #: (n,) uint8: the verdict on the next radius, INACCESSIBLE or UNDECIDED; UNJUDGED where none was looked at.
    reason: Bytes  #: (n,) uint8: why that one does not reach the sample, an index into REASONS; else NO_REASON.
    #: `axis`, `tilt_direction` (n, 3) float: unit tool axis and tilt direction of a posture at `radius`; nan where there is none.
    axis: Floats
    tilt_direction: Floats
    tilt: Floats  #: (n,) float: rad, nan where there is none.
    rotation: Ints  #: (n,) int32: index into the posture range's rotations, -1 where there is none.

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

        `area` (n,) float: what each sample counts, mm2 for instance; all count the same by default. Returns for each of
        PERCENTILES; empty if no sample that counts is judged.
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
