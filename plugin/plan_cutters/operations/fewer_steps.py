"""Fewer steps: a face of free form goes into one where that takes little more time, and minor steps are joined to others.

Labels give each sample to the step that cuts it in the least time. A machinist sets fewer steps: a border on a face of free form
is a mark there, and nobody sets up a step of a few seconds whose samples another step serves as well. Each sample goes only with
a step that serves it. What no other step serves, and what takes less than a second, is no step at all where the plan leaves
something anyway: it is left, by name.
"""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from cad_io.arrays import Floats, Ints

Rows = NDArray[np.int64]
#: A step of less than this share of the area, or of less than so many seconds, is joined to others where that costs nothing.
MINOR_SHARE, MINOR_SECONDS = 0.01, 5.0
#: A step of less area, mm2, or of less time, s, and less than a share of the area, is none where something is left anyway.
LEAST_AREA, LEAST_SECONDS, LEAST_SHARE = 0.1, 1.0, 0.001
#: A step that serves so much of a face of free form takes it, where that costs no more than this share of the face's time.
WHOLE_FACE, _MORE = 0.95, 0.1
#: Seconds that count as nothing.
_NOTHING = 1e-9


@dataclass(frozen=True, slots=True, eq=False)
class Steps:
    """Steps that samples may go with.

    Attributes
    ----------
    cost : (n, k) float
        Of each sample with each step, s, or mm without a feed; infinite where the step does not serve the sample, or may not.
    group : (k,) int
        Steps of one number are images of each other: to a machinist one step.
    free : (k,) bool
        Whether a step was planned: a person's own keeps its samples, and takes no others.
    moving : (k,) bool
        Whether it is simultaneous motion, which takes no step of a large area that a fixed orientation cuts.
    area : (n,) float
        Of the samples, mm2.
    timed : bool
        Whether costs are seconds.
    spent : callable
        What some steps, by their numbers, take besides cutting: orientations, changes of cutters and setups.
    """

    cost: Floats
    group: NDArray[np.int64]
    free: NDArray[np.bool_]
    moving: NDArray[np.bool_]
    area: Floats
    timed: bool
    spent: Callable[[tuple[int, ...]], float]

    def cutting(self, number: Ints, rows: Rows | None = None) -> float:
        """Sum up what samples, or some (m,), cost with the steps (n,) that they go with; what is not known is not counted."""
        rows = np.flatnonzero(number >= 0) if rows is None else rows
        cost = self.cost[rows, number[rows]]
        return float(cost[np.isfinite(cost)].sum())

    def total(self, number: Ints) -> float:
        """The same with what the steps that are used take besides."""
        return self.cutting(number) + self.spent(tuple(np.unique(number[number >= 0]).tolist()))

    def minor(self, number: Ints) -> Iterator[Rows]:
        """The samples of each group of planned steps of little area or time, the smallest first."""
        mine = np.flatnonzero(number >= 0)
        groups = self.group[number[mine]]
        parts = [mine[groups == each] for each in np.unique(groups[self.free[number[mine]]]).tolist()]
        least = MINOR_SHARE * self.area[mine].sum()
        for rows in sorted(parts, key=lambda rows: (float(self.area[rows].sum()), len(rows))):
            if self.area[rows].sum() < least or (self.timed and self.cutting(number, rows) < MINOR_SECONDS):
                yield rows

    def negligible(self, number: Ints, rows: Rows, more: float) -> bool:
        """Whether some samples (m,) are no step by themselves, with so much area, mm2, that is none already."""
        area, whole = float(self.area[rows].sum()) + more, float(self.area[number >= 0].sum())
        short = self.timed and self.cutting(number, rows) < LEAST_SECONDS and area < LEAST_SHARE * whole
        return area < LEAST_AREA or short


def in_one_step(steps: Steps, number: Ints, face: Ints, free_form: Sequence[int]) -> Ints:
    """Let faces of free form go into one step each, where one serves nearly all of what is cut of it at little more time.

    Parameters
    ----------
    steps : Steps
    number : (n,) int32
        The step that each sample goes with, -1 for none.
    face : (n,) int
        The face of each sample.
    free_form : sequence of int
        Numbers of the faces of free form.

    Returns
    -------
    (n,) int32
        As `number`.
    """
    for each in free_form:
        rows = np.flatnonzero((face == each) & (number >= 0))
        rows = rows[steps.free[number[rows]]]
        if len(np.unique(steps.group[number[rows]])) < 2:
            continue
        serves, area = np.isfinite(steps.cost[rows]), steps.area[rows]
        tried = [number]
        for k in np.flatnonzero((area @ serves >= WHOLE_FACE * area.sum()) & steps.free).tolist():
            tried.append(number.copy())
            tried[-1][rows[serves[:, k]]] = k
        total = [steps.total(each) for each in tried]
        best = 1 + int(np.argmin(total[1:])) if len(tried) > 1 else 0
        if total[best] <= total[0] + _MORE * steps.cutting(number, rows):
            number = tried[best]
    return number


def without_minor_steps(steps: Steps, number: Ints, *, incomplete: bool) -> Ints:
    """Join minor steps to others that serve their samples, where the plan takes no more time then.

    Parameters
    ----------
    steps : Steps
    number : (n,) int32
        The step that each sample goes with, -1 for none.
    incomplete : bool
        Whether the plan leaves something anyway: then what is hardly anything, and no other step serves, is left as well.

    Returns
    -------
    (n,) int32
        As `number`; -1 as well where a sample is left.
    """
    before, again = number, True
    while again:
        more, again = float(steps.area[(before >= 0) & (number < 0)].sum()), False
        for rows in steps.minor(number):
            then = _joined(steps, number, rows, more if incomplete else None)
            if then is not None:
                number, again = then, True
                break
    return number


def _joined(steps: Steps, number: Ints, rows: Rows, more: float | None) -> Ints | None:
    """Labels (n,) without the step of some samples (m,); None where it has to stay.

    `more` is how much, mm2, is none already of what may be left; None: nothing may be.
    """
    used = np.unique(number[number >= 0])
    others = used[steps.free[used] & ~np.isin(steps.group[used], steps.group[number[rows]])]
    if not steps.moving[number[rows]].any() and steps.area[rows].sum() >= MINOR_SHARE * steps.area[number >= 0].sum():
        others = others[~steps.moving[others]]
    if not len(others):
        return None
    cost = steps.cost[np.ix_(rows, others)]
    served = np.isfinite(cost).any(axis=1)
    rest, mine, cost = rows[~served], rows[served], cost[served]
    if len(rest) and (more is None or not steps.negligible(number, rest, more)):
        return None
    most = steps.total(number) - steps.cutting(number, rest) + _NOTHING
    # One step that serves all of them is better than several.
    single = int(cost.sum(axis=0).argmin())
    for which in (np.full(len(mine), single), cost.argmin(axis=1)):
        then = number.copy()
        then[rest], then[mine] = -1, others[which]
        if np.isfinite(cost[np.arange(len(mine)), which]).all() and steps.total(then) <= most:
            return then
    return None
