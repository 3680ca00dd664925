"""Values are tried on the samples that are not reached now; what serves there is judged on all samples.

A trial asks only whether samples have a posture, in any company; what is told of a change rests on `judge`: Lemma W1 of
`docs/what_if_proof.md`.
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from plan_cutters.domain.change import Change, Thing
from plan_cutters.domain.cutter import Cutter
from plan_cutters.domain.over_setups import over_setups
from plan_cutters.domain.verdicts import ACCESSIBLE, CONVEX, FIXTURE, INACCESSIBLE, INSIDE, TOLERANCE, UNDECIDED, Verdicts, blank
from plan_cutters.kernels.rows import Contacts
from plan_cutters.plan_file.words.change_text import reasons, samples
from plan_cutters.scene.conditions import Context, contacts_of
from plan_cutters.scene.flats_and_flanks import search
from plan_cutters.scene.preparation import Prepared
from plan_cutters.stages.judge import judge

Rows = NDArray[np.int64]

#: Samples asked at a time, at first; then four times as many.
_FIRST, _MORE = 16, 4
#: Samples that are asked out of their sequence, at most: in it neighbours help each other.
_AT_RANDOM = 1024
#: Samples that stopped a value are remembered, the last so many.
_REMEMBERED = 32
#: Samples by which values are compared that all leave some.
_COMPARED = 32
#: Samples that are looked at to count what a value leaves that does not serve, at most.
_LOOKED_AT = 1024
#: How often a value that serves all samples tried, but not all, is taken further.
_ROUNDS = 8


@dataclass(frozen=True, slots=True, eq=False)
class Case:
    """A part that is ready, in all its setups, and a cutter, one thing of either changed."""

    ready: Prepared
    cutter: Cutter

    @property
    def setups(self) -> Iterator[Prepared]:
        """The part in each of its setups, the first one first."""
        return (self.ready.alone(k) for k in range(len(self.ready.setups)))

    def look(self, rows: Rows, *, brief: bool = False) -> Verdicts:
        """Judge some of the judged samples again, for this part and cutter, in one setup after the other.

        The verdicts are those of `judge`, except that a search from another start may differ by its angular resolution; and, if
        it is `brief`, that what takes long is left undecided.
        """
        each, open_rows = list[Verdicts](), np.arange(len(rows))
        for one in self.setups:
            part = _look(one, self.cutter, rows[open_rows], brief=brief)
            whole = blank(len(rows))
            whole.take(open_rows, part, at=slice(None))
            each.append(whole.freeze())
            open_rows = open_rows[~part.reached]
        return over_setups(each)[0]

    def misses(self, rows: Rows, *, brief: bool = False) -> Rows:
        """Those of some samples that it does not reach, or, if the search is `brief`, may not reach."""
        return rows[~self.look(rows, brief=brief).reached]

    def judged(self, rows: Rows | None = None) -> Rows:
        """Samples of the finished surface that it does not reach, as a plan finds them: of all, or of some, ascending."""
        wanted = np.flatnonzero(self.ready.finished) if rows is None else rows[self.ready.finished[rows]]
        for one in self.setups:
            if len(wanted):
                wanted = wanted[~judge(one, self.cutter, wanted).reached]
        return wanted


def _look(ready: Prepared, cutter: Cutter, rows: Rows, *, brief: bool) -> Verdicts:
    """Judge some samples again in one setup."""
    from plan_cutters.kernels.search.search import dummy_clear

    conditions, verdicts = ready.conditions, blank(len(rows))
    context = Context.of(cutter, conditions)
    if not context.judges:
        verdicts.verdict[:], verdicts.reason[:] = UNDECIDED, TOLERANCE
        return verdicts.freeze()
    contacts = Contacts(*(np.ascontiguousarray(column[rows]) for column in contacts_of(ready.samples)))
    free = np.zeros(len(rows), bool)
    if len(context.dummy):
        upright = np.flatnonzero((ready.surface_class[rows] == CONVEX) & conditions.upright(contacts.normal))
        dummy_clear(upright, contacts, context.dummy, context.outer, conditions.obstacles.solids, free)
    verdicts.verdict[free] = ACCESSIBLE
    # Of the finished surface these lie within a fixture, or are held.
    within, held = ready.shut[rows] >= 0, ready.clamped[rows]
    search(contacts, ready.samples.face[rows], np.flatnonzero(~free & ~within), context, verdicts, brief=brief)
    verdicts.verdict[within], verdicts.reason[within] = INACCESSIBLE, np.where(held[within], FIXTURE, INSIDE)
    return verdicts.freeze()


#: A value's case, by its number of steps from the present one; None where there can be no such cutter or setup.
Steps = Callable[[int], Case | None]


@dataclass(slots=True)
class Trials:
    """The samples of one part and cutter to try values on.

    Attributes
    ----------
    not_reached, kept : (n,) int64
        Samples of the finished surface that the cutter does not reach now, and those that it reaches, ascending.
    hard : list of int
        Samples that stopped a value, the last one first.
    blocked : int
        Samples of those not reached that are inaccessible.
    found : dict
        Changes that are known already, by their thing: one may spare another.
    """

    not_reached: Rows
    kept: Rows
    hard: list[int] = field(default_factory=list)
    blocked: int = 0
    found: dict[Thing, Change] = field(default_factory=dict)

    @classmethod
    def of(cls, verdicts: Verdicts, finished: NDArray[np.bool_]) -> "Trials":
        """The samples of a reach that are of the finished surface (n,)."""
        not_reached, reached_rows = (np.flatnonzero(verdicts.not_reached & finished), np.flatnonzero(verdicts.reached & finished))
        return cls(not_reached, reached_rows, blocked=int((verdicts.verdict[not_reached] == INACCESSIBLE).sum()))

    @property
    def count(self) -> int:
        """Samples that are judged."""
        return len(self.not_reached) + len(self.kept)

    def remember(self, row: int) -> None:
        """A sample that stopped a value is the first that the next one is tried on."""
        if row in self.hard:
            self.hard.remove(row)
        self.hard.insert(0, row)
        del self.hard[_REMEMBERED:]

    def stopped(self, case: Case, *, everywhere: bool) -> bool:
        """Whether a sample was found that a case does not reach, of those not reached now or of all."""
        for batch in self._batches(everywhere):
            missed = case.misses(batch)
            if len(missed):
                self.remember(int(missed[0]))
                return True
        return False

    def _batches(self, everywhere: bool) -> Iterator[Rows]:
        hard = np.array(self.hard, np.int64)
        yield from np.split(hard, [1]) if len(hard) else ()
        yield from batches(self.not_reached)
        if everywhere:
            yield from batches(self.kept)

    def closest(self, cases: list[Case]) -> Case:
        """Of cases that all leave some, the one that leaves fewest of a few samples spread over those not reached now; one that
        leaves them undecided comes before one that is blocked at any of them.
        """
        few = self.not_reached[:: 1 + len(self.not_reached) // _COMPARED]

        def leaves(case: Case) -> tuple[bool, int]:
            verdicts = case.look(few)
            return bool((verdicts.verdict == INACCESSIBLE).any()), int((~verdicts.reached).sum())

        return min(cases, key=leaves)


def batches(rows: Rows) -> Iterator[Rows]:
    """All of some rows: a few at random, more of them, then those left in sequence."""
    mixed = np.random.default_rng(0).permutation(rows)[:_AT_RANDOM]
    first, size = 0, _FIRST
    while first < len(mixed):
        yield mixed[first : first + size]
        first, size = first + size, size * _MORE
    pure = np.setdiff1d(rows, mixed, assume_unique=True)
    if len(pure):
        yield pure


@dataclass(frozen=True, slots=True)
class StillMissed:
    """Count the samples that are not reached now and stay so with a new value, and give the reasons.

    count, blocked : int
        Samples that are inaccessible or undecided, and those that are inaccessible.
    looked : int
        Samples looked at: some of those not reached now, spread evenly, if one of these is inaccessible, else all.
    words : str
        How many samples each reason has, the reason with the most of them first; or undecided, if all are.
    """

    count: int
    blocked: int
    looked: int
    words: str

    @classmethod
    def by(cls, case: Case, rows: Rows) -> "StillMissed":
        """Count the samples among some that a case does not reach."""
        few = rows[:: 1 + (len(rows) - 1) // _LOOKED_AT]
        verdicts = case.look(few)
        if len(few) < len(rows) and not (verdicts.verdict == INACCESSIBLE).any():
            few, verdicts = rows, case.look(rows)
        bad = ~verdicts.reached
        count, blocked = int(bad.sum()), int((verdicts.verdict == INACCESSIBLE).sum())
        of = None if len(few) == len(rows) else len(few)
        words = reasons(verdicts.reason[bad], of) if blocked else f"{samples(count, of)} undecided"
        return cls(count, blocked, len(few), words)


@dataclass(frozen=True, slots=True)
class Step:
    """A value that serves all samples, and what is known of the one before.

    steps : int
        From the present value.
    case : Case
    beyond : int, optional
        Steps of the value before it, if that can exist: it was tried and does not serve.
    """

    steps: int
    case: Case
    beyond: int | None


def least(steps: Steps, most: int, trials: Trials) -> Step | None:
    """The least number of steps that serves all samples, if each step allows all that those before it allow.

    At `most` every sample that is not reached now must have been reached. Each sample that a value does not serve takes it on, by
    halving, to the least that serves this one; the others are asked from there.
    """
    at = _onward(steps, 0, most, batches(trials.not_reached), trials)
    for _ in range(_ROUNDS):
        if at is None or at > most:
            return None
        at = max(at, 1)
        case = _case(steps, at)
        missed = case.judged()
        if not len(missed):
            return _back(steps, Step(at, case, at - 1), trials)
        # Missed all the same: the grain of the search, or what more of the thing puts in the way.
        onward = _onward(steps, at, most, iter([missed]), trials)
        at = None if onward is None else max(onward, at + 1)
    return None


def _onward(steps: Steps, at: int, most: int, rows: Iterator[Rows], trials: Trials) -> int | None:
    """The least number of steps from `at` on that serves some samples; None if `most` does not."""
    for batch in rows:
        while len(batch := _case(steps, at).misses(batch)):
            row, batch = batch[:1], batch[1:]
            low, high = at, most
            if len(_case(steps, most).misses(row)):
                return None
            while high - low > 1:
                middle = (low + high) // 2
                low, high = (middle, high) if len(_case(steps, middle).misses(row)) else (low, middle)
            at = high
            trials.remember(int(row[0]))
    return at


def _case(steps: Steps, at: int) -> Case:
    case = steps(at)
    if case is None:
        raise ValueError(f"there is no value at step {at}")
    return case


def _back(steps: Steps, step: Step, trials: Trials) -> Step:
    """Take a value back as long as a plan with the one before finds a posture everywhere."""
    while step.steps > 1:
        case = _case(steps, step.steps - 1)
        hard = np.array(sorted(trials.hard[:1]), np.int64)
        if len(case.judged(hard)) or len(case.judged()):
            break
        step = Step(step.steps - 1, case, step.steps - 2)
    return step


def first(steps: Steps, most: int, trials: Trials) -> Step | None:
    """The least number of steps that serves all samples, each of them tried, one after the other."""
    before: int | None = 0
    for at in range(1, most + 1):
        case = steps(at)
        if case is None:
            continue
        if not trials.stopped(case, everywhere=True):
            missed = case.judged()
            if not len(missed):
                return Step(at, case, before)
            trials.remember(int(missed[0]))
        before = at
    return None
