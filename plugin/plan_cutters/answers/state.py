"""The plan after a step: its cutters, setups and conditions, the samples that it would not reach, and some of them on which
values of a step are compared before any is judged.

Samples are asked again quickly, or as a plan judges them. A quick look asks only whether samples have a posture, in any company;
what is told of a step rests on `judge`: Lemma R1 of `docs/proofs.md`.
"""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from plan_cutters.answers.areas import Finished
from plan_cutters.answers.candidates import planes_below
from plan_cutters.domain.cutter import Cutter
from plan_cutters.domain.fixture import TABLE
from plan_cutters.domain.verdicts import (
    ACCESSIBLE,
    CONVEX,
    FIXTURE,
    INACCESSIBLE,
    INSIDE,
    TOLERANCE,
    UNDECIDED,
    Verdicts,
    blank,
    over_setups,
)
from plan_cutters.kernels.rows import Contacts
from plan_cutters.plan_file.answers import MoveEntry
from plan_cutters.scene.conditions import Context, contacts_of, over_plane
from plan_cutters.scene.flats_and_flanks import search
from plan_cutters.scene.inside_material import inside_material
from plan_cutters.scene.preparation import Axis, Prepared
from plan_cutters.setups.clamping import NothingToGripError
from plan_cutters.setups.requested import without

Rows = NDArray[np.int64]


@dataclass(frozen=True, slots=True, eq=False)
class Case:
    """A part that is ready, in all its setups, and a cutter, one thing of either changed."""

    ready: Prepared
    cutter: Cutter
    above: float | None = None  #: Nothing of the tool may be lower along the setup axis, mm: a table that is only a plane.

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
            part = _look(one, self.cutter, rows[open_rows], brief=brief, above=self.above)
            whole = blank(len(rows))
            whole.take(open_rows, part, at=slice(None))
            each.append(whole.freeze())
            open_rows = open_rows[~part.reached]
        return over_setups(each)[0]

    def misses(self, rows: Rows, *, brief: bool = False) -> Rows:
        """Those of some samples that it does not reach, or, if the search is `brief`, may not reach."""
        return rows[~self.look(rows, brief=brief).reached]


def _look(ready: Prepared, cutter: Cutter, rows: Rows, *, brief: bool, above: float | None) -> Verdicts:
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
    if above is not None:
        below = verdicts.reached & ~over_plane(context, contacts, verdicts, above)
        verdicts.verdict[below], verdicts.reason[below] = INACCESSIBLE, FIXTURE
    verdicts.verdict[within], verdicts.reason[within] = INACCESSIBLE, np.where(held[within], FIXTURE, INSIDE)
    return verdicts.freeze()


#: What each cutter reaches in each setup, the first one first.
Everywhere = Sequence[Mapping[Cutter, Verdicts]]
#: What looks down at the table so squarely lies on it.
_SQUARE = 1e-6
#: Setups that are not planned yet of which what stands around the part is kept, at most.
_TABLES = 3


class SetupOf(NamedTuple):
    """A setup of a state; `number` is its place among those of the plan, from 0, None of one that is not planned yet."""

    axis: Axis
    number: int | None = None


@dataclass(frozen=True, slots=True, eq=False)
class State:
    """Cutters that share a part: what counts is what none of them reaches in any of its setups."""

    ready: Prepared
    cutters: tuple[Cutter, ...]  #: The one that is mended, or what became of it, first.
    setups: tuple[SetupOf, ...]
    #: What setups that are not planned yet see, by axis and tolerance, those that were looked at last.
    tables: dict[tuple[Axis, float], Prepared] = field(default_factory=dict)

    @classmethod
    def of(cls, ready: Prepared, cutter: Cutter) -> "State":
        """One cutter in the setups of a plan."""
        return cls(ready, (cutter,), tuple(SetupOf(axis, k) for k, (axis, _) in enumerate(ready.axes)))

    @property
    def axes(self) -> tuple[Axis, ...]:
        """The setup axes."""
        return tuple(each.axis for each in self.setups)

    def cases(self, *, brief: bool = False) -> Iterator[tuple[Any, Case]]:
        """Each cutter in each setup, and a key by which it is known; for a `brief` look a table may be a plane."""
        for setup in self.setups:
            plane = on_plane(self.ready, setup.axis) if brief and setup.number is None else None
            there, above = plane or (self._in(setup), None)
            for cutter in self.cutters:
                yield key(there, cutter, setup), Case(there, cutter, above)

    def _in(self, setup: SetupOf) -> Prepared:
        ready = self.ready
        if setup.number is not None:
            return ready.alone(setup.number)
        at = setup.axis, ready.scene.asked
        table, conditions = self.tables.pop(at, None) or on_table(ready, setup.axis), ready.conditions
        # Those that were used last stay: a part has as many triangles around it each time.
        self.tables[at] = table
        for old in list(self.tables)[:-_TABLES]:
            del self.tables[old]
        placed = replace(conditions, setup=table.conditions.setup, x=None, surroundings=table.conditions.surroundings)
        return replace(ready, conditions=placed, inside=table.inside, held=table.held, others=())


def on_table(ready: Prepared, axis: Axis) -> Prepared:
    """A part in a setup that is not planned yet, and in no other: it is held as in the first one.

    A table that the first setup brings itself lies across this axis, and holds the faces that stand on it here, no others; a vise
    or chuck grips the part anew.
    """
    place, conditions = ready.options.placement, replace(ready.conditions, setup=np.array(axis), x=None)
    own = () if place is None else tuple(each for each in place.fixtures if each.follows_setup)
    if not own:
        return replace(ready, conditions=conditions, others=())
    scene = ready.scene
    try:
        surroundings = scene.surround_in(axis, without(scene.fixtures, own), own)
    except NothingToGripError:
        # A vise or chuck has nothing to grip there: nothing can be machined.
        return replace(ready, conditions=conditions, held=np.ones(len(ready.samples), bool), others=())
    inside = inside_material(
        ready.samples, scene.orientation, surroundings.enclosing, surroundings.certain, conditions.tolerance, conditions.jobs,
        ready.inside,
    )  # fmt: skip
    held = np.isin(ready.samples.face, planes_below(ready, np.array([axis]))[0])
    return replace(ready, conditions=replace(conditions, surroundings=surroundings), inside=inside, held=held, others=())


def on_plane(ready: Prepared, axis: Axis) -> tuple[Prepared, float] | None:
    """A part over a table that is a plane, and its height along an axis, mm: none of the obstacles is made anew.

    None where something else holds it, or it stands on no table.
    """
    place, conditions, bodies = ready.options.placement, ready.conditions, ready.conditions.surroundings.bodies
    alone = conditions.surroundings.alone
    if place is None or alone is None or [each.fixture.kind for each in conditions.surroundings.fixtures] != [TABLE]:
        return None
    (table,) = conditions.surroundings.fixtures
    if not table.fixture.follows_setup and not (table.requested and table.requested.follows_setup):
        return None
    samples, above = ready.samples, float((alone.certain.triangles.vertex @ np.array(axis)).min())
    placed = replace(conditions, setup=np.array(axis), x=None, surroundings=alone)
    held = (samples.normal @ axis < -1.0 + _SQUARE) & (samples.point @ axis <= above + conditions.tolerance)
    inside = np.where(ready.inside < len(bodies), ready.inside, -1).astype(np.int32)
    return replace(ready, conditions=placed, inside=inside, held=held, others=()), above


def key(ready: Prepared, cutter: Cutter, setup: SetupOf) -> Any:
    """Make the key of a case: the verdicts on the samples of a part depend on these values."""
    conditions = ready.conditions
    return cutter, setup, conditions.machine, conditions.postures, conditions.tolerance


@dataclass(slots=True)
class Judgements:
    """Keep all that was judged so far, so that nothing is judged twice."""

    looked: dict[Any, NDArray[np.bool_]] = field(default_factory=dict)  #: By key: samples (n,) that were judged.
    missed: dict[Any, NDArray[np.bool_]] = field(default_factory=dict)  #: Those of them that are not reached.
    tell: Callable[[], None] = lambda: None  #: Called whenever a case was judged.

    @classmethod
    def of(cls, ready: Prepared, everywhere: Everywhere) -> "Judgements":
        """Those of a plan."""
        judgements, wanted = cls(), ready.finished
        for k, ((axis, _), there) in enumerate(zip(ready.axes, everywhere, strict=False)):
            for cutter, verdicts in there.items():
                name = key(ready, cutter, SetupOf(axis, k))
                judgements.looked[name], judgements.missed[name] = wanted.copy(), verdicts.not_reached & wanted
        return judgements

    def left(self, state: State, rows: Rows) -> Rows:
        """Those of some samples of the finished surface that a state leaves, judged as a plan judges."""
        for name, case in state.cases():
            if not len(rows):
                break
            looked = self.looked.setdefault(name, np.zeros(len(state.ready.samples), bool))
            missed = self.missed.setdefault(name, np.zeros(len(looked), bool))
            new = rows[~looked[rows]]
            if len(new):
                missed[case.misses(new)] = True
                looked[new] = True
                self.tell()
            rows = rows[missed[rows]]
        return rows

    def glance(self, state: State, rows: Rows) -> Rows:
        """The same, found by a quick search of these alone where they were not judged."""
        for name, case in state.cases(brief=True):
            if not len(rows):
                break
            looked = self.looked.get(name)
            known = np.zeros(len(rows), bool) if looked is None else looked[rows]
            not_reached = np.zeros(len(rows), bool)
            not_reached[known] = self.missed[name][rows[known]] if known.any() else False
            new = np.flatnonzero(~known)
            not_reached[new] = np.isin(rows[new], case.misses(rows[new], brief=True)) if len(new) else False
            rows = rows[not_reached]
        return rows


#: Samples on which values are compared, at most.
_FEW = 96
#: Shares of what the most would gain, with which less is content.
NEARLY, HALF = 0.95, 0.5


Value = float | tuple[float, ...] | str | None


def move_of(thing: str, now: Value, tried: Value, why: str) -> MoveEntry:
    """One change: of what (`domain.answers.MEANS`), from which value to which (mm, deg, a direction, an id), and in words."""
    return MoveEntry(thing=thing, now=now, asked=tried, why=why)


@dataclass(frozen=True, slots=True, eq=False)
class Candidate:
    """A step that may be worth judging."""

    moves: tuple[MoveEntry, ...]
    state: State  #: After it.
    estimate: float  #: Share of the finished area that it may leave.
    nested: bool  #: Whether it surely reaches all that is reached now.


@dataclass(frozen=True, slots=True, eq=False)
class Scan:
    """The samples that are not reached now, and a few of them that are looked at first."""

    state: State
    left: Rows  #: Samples (m,) that it leaves.
    few: Rows  #: Some of them.
    finished: Finished
    known: Judgements
    given: tuple[Cutter, ...]  #: All that the plan judged.

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

    def found(self, move: MoveEntry, state: State, missed: Rows, *, nested: bool) -> Candidate:
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
