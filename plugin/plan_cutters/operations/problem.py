"""Samples and candidates of operations, with what each costs: a facility location."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from cad_io.arrays import Floats, Ints

Which = NDArray[np.int64]


@dataclass(frozen=True, slots=True)
class Costs:
    """Each operation, and each cutter and setup after the first, costs this whatever it cuts, in the samples' unit.

    Where candidates turn, the cost of an operation only leads the choice.
    """

    operation: float
    cutter: float
    setup: float


@dataclass(frozen=True, slots=True, eq=False)
class Turning:
    """Operations of a choice cost what the rotary axes take from one to the next.

    Attributes
    ----------
    together : callable
        What the operations (k,) of a choice cost together.
    reach : (m,) float
        Whatever else is chosen, those of the same cutter and setup cost at least this together with a candidate.
    """

    together: Callable[[Which], float]
    reach: Floats


class Problem:
    """Samples and candidates, with what each costs.

    Parameters
    ----------
    cost : (n, m) float
        Of each sample with each candidate; infinite where the candidate does not serve it. Each row has a finite one.
    cutter, setup : (m,) int
    costs : Costs
    turning : Turning, optional
        None: each operation costs the same.
    """

    def __init__(self, cost: Floats, cutter: Ints, setup: Ints, costs: Costs, turning: Turning | None = None) -> None:
        self.cost, self.cutter, self.setup, self.costs, self.turning = cost, cutter, setup, costs, turning
        finite = cost[np.isfinite(cost)]
        #: Costs more than any choice.
        self.dear = float(cost.min(axis=1, initial=np.inf).sum() + finite.max(initial=0.0) * len(cost)) + 10.0 * sum(
            (costs.operation, costs.cutter, costs.setup)
        )

    def total(self, chosen: Which) -> float:
        """Sum up the costs of a choice; infinite where it leaves a sample."""
        if not len(chosen):
            return 0.0 if not len(self.cost) else np.inf
        return self.priced(chosen, self.cost[:, chosen].min(axis=1, initial=np.inf))

    def priced(self, chosen: Which, samples: Floats) -> float:
        """As `total`, for a choice with which the samples (n,) are known to cost so much."""
        if not len(chosen):
            return self.total(chosen)
        return float(samples.sum()) + self.costs.operation * len(chosen) + self._changes(chosen)

    def turned(self, chosen: Which) -> float:
        """As `total`, but with what the rotary axes take in truth."""
        if self.turning is None or not len(chosen):
            return self.total(chosen)
        return self.cutting(chosen) + self.turning.together(chosen) + self._changes(chosen)

    def _changes(self, chosen: Which) -> float:
        cutters, setups = len(np.unique(self.cutter[chosen])), len(np.unique(self.setup[chosen]))
        return self.costs.cutter * (cutters - 1) + self.costs.setup * (setups - 1)

    def cutting(self, chosen: Which) -> float:
        """Sum up the costs of the samples, each with the best of a choice."""
        return float(self.cost[:, chosen].min(axis=1, initial=np.inf).sum())

    def gains(self, now: Floats, rows: Which | None = None) -> Floats:
        """Sum up what each candidate (m,) saves on samples that cost so much now (n,), on some rows or all."""
        cost = self.cost if rows is None else self.cost[rows]
        saved = np.subtract((now if rows is None else now[rows])[:, None], cost)
        return np.asarray(np.maximum(0.0, saved, out=saved).sum(axis=0))

    def regained(self, gains: Floats, before: Floats, now: Floats) -> Floats:
        """Find gains for costs of now from those of before: only samples whose costs differ are looked at."""
        rows = np.flatnonzero(before != now)
        return gains + self.gains(now, rows) - self.gains(before, rows)

    def added(self, chosen: Which, gains: Floats) -> tuple[int, float]:
        """The candidate that saves most beside a choice, with its own costs, and how much."""
        gain = gains - self.costs.operation
        if len(chosen):
            gain -= self.costs.cutter * ~np.isin(self.cutter, self.cutter[chosen])
            gain -= self.costs.setup * ~np.isin(self.setup, self.setup[chosen])
        best = int(gain.argmax())
        return best, float(gain[best])

    def of(self, which: Which, rows: NDArray[np.bool_] | None = None) -> "Problem":
        """Some of the candidates, each of which costs the same, with the samples or some (n,) of them."""
        cost = self.cost[:, which] if rows is None else self.cost[np.ix_(rows, which)]
        return Problem(cost, self.cutter[which], self.setup[which], self.costs)
