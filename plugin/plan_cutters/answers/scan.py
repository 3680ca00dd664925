"""Some of the samples that are not reached, on which values of a step are compared before any is judged."""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from plan_cutters.answers.areas import Finished
from plan_cutters.answers.state import Judgements, State
from plan_cutters.domain.answers import Move
from plan_cutters.domain.cutter import Cutter

Rows = NDArray[np.int64]

#: Samples on which values are compared, at most.
_FEW = 96
#: Shares of what the most would gain, with which less is content.
NEARLY, HALF = 0.95, 0.5


@dataclass(frozen=True, slots=True, eq=False)
class Candidate:
    """A step that may be worth judging.

    Attributes
    ----------
    moves : tuple of Move
    state : State
        After it.
    estimate : float
        Share of the finished area that it may leave.
    nested : bool
        Whether it surely reaches all that is reached now.
    """

    moves: tuple[Move, ...]
    state: State
    estimate: float
    nested: bool


@dataclass(frozen=True, slots=True, eq=False)
class Scan:
    """The samples that are not reached now, and a few of them that are looked at first.

    state : State
    left : (m,) int64
        Samples that it leaves.
    few : int64
        Some of them.
    finished : Finished
    known : Judgements
    given : tuple of Cutter
        All that the plan judged.
    """

    state: State
    left: Rows
    few: Rows
    finished: Finished
    known: Judgements
    given: tuple[Cutter, ...]

    @classmethod
    def of(cls, state: State, open_rows: Rows, finished: Finished, known: Judgements, cutters: tuple[Cutter, ...]) -> "Scan":
        """With every so-manieth of the samples that are left."""
        return cls(state, open_rows, spread(open_rows), finished, known, cutters)

    @property
    def sculptured(self) -> bool:
        """Whether some of the few lie on free-form faces."""
        ready = self.state.ready
        return any(ready.scene.part.faces[n - 1].shape == "sculptured" for n in np.unique(ready.samples.face[self.few]).tolist())

    def estimate(self, missed: Rows) -> float:
        """The share of the area that is left, if of the few these are."""
        whole = float(self.finished.area[self.few].sum())
        part = float(self.finished.area[missed].sum()) / whole if whole > 0.0 else len(missed) / max(1, len(self.few))
        # Equal areas are equal, whichever samples stand for them.
        return round(part * self.finished.of_rows(self.left), 12)

    def found(self, move: Move, state: State, missed: Rows, *, nested: bool) -> Candidate:
        """A candidate by what it misses of the few."""
        return Candidate((move,), state, self.estimate(missed), nested)

    def least(
        self, make: Callable[[int], State | None], most: int, shares: Sequence[float] = (NEARLY,)
    ) -> Iterator[tuple[int, State, Rows]]:
        """Of values 0 to `most`, each of which reaches what those before it reach, the least that gains shares of what the most
        gains: its number, its state, and what it misses of the few."""
        while most >= 0 and (end := make(most)) is None:
            most -= 1
        if most < 0 or end is None:
            return
        missed = self.known.glance(end, self.few)
        gained = np.setdiff1d(self.few, missed, assume_unique=True)
        if not len(gained):
            return
        seen = set()
        for share in shares:
            low, high, still = -1, most, gained[:0]
            while high - low > 1:
                middle = (low + high) // 2
                state = make(middle)
                not_reached = gained if state is None else self.known.glance(state, gained)
                if len(not_reached) <= (1.0 - share) * len(gained):
                    high, still = middle, not_reached
                else:
                    low = middle
            made = make(high)
            if high not in seen and made is not None:
                seen.add(high)
                yield high, made, np.union1d(missed, still)


def spread(rows: Rows, most: int = _FEW) -> Rows:
    """Every so-manieth of some samples."""
    return rows[:: 1 + (len(rows) - 1) // most] if len(rows) else rows


def under(state: State, **changes: Any) -> State:
    """A state with other values of its conditions, in every setup."""
    return replace(state, ready=state.ready.under(**changes))
