"""Make the entries of patterns: which faces are equal, and what followed from that."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from cad_io.arrays import Floats
from cad_io.part.patterns import Pattern
from plan_cutters.plan_file.frozen import vector
from plan_cutters.plan_file.patterns import PatternEntry


def pattern_entries(patterns: Sequence[Pattern], counts: NDArray[np.int64]) -> list[PatternEntry]:
    """The entries of all patterns of a part.

    Parameters
    ----------
    patterns : sequence of Pattern
    counts : (m, 3) int64
        Of each motion of the whole part, in their order: samples that were moved, that followed, and that were verified.
    """
    entries, motion = list[PatternEntry](), 0
    for each in patterns:
        own = np.zeros(3, np.int64)
        if each.whole:
            own = counts[motion : motion + len(each.motions)].sum(axis=0)
            motion += len(each.motions)
        place, direction = _frame(each)
        entries.append(
            PatternEntry(
                kind=each.kind, order=each.order, whole=each.whole, place_mm=None if place is None else vector(place),
                direction=None if direction is None else vector(direction),
                shifts_mm=[vector(m.shift) for m in each.motions] if each.kind == "shift" else [],
                faces=[[f"F{ring[k % len(ring)]}" for ring in each.faces] for k in range(each.order)] if each.faces else [],
                moved=int(own[0]), followed=int(own[1]), verified=int(own[2]),
            )
        )  # fmt: skip
    return entries


def _frame(pattern: Pattern) -> tuple[Floats | None, Floats | None]:
    """A point and the direction of the axis, or of the mirror's normal."""
    first = pattern.motions[0]
    if pattern.kind == "mirror":
        values, vectors = np.linalg.eigh(0.5 * (first.linear + first.linear.T))
        return 0.5 * first.shift, vectors[:, int(values.argmin())]
    axis = first.axis
    return (None, None) if axis is None or pattern.kind == "shift" else axis
