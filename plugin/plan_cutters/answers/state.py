"""Describe the plan after a step: its cutters, setups and conditions, and the samples that it would not reach."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from plan_cutters.answers.candidates import planes_below
from plan_cutters.answers.trial import Case
from plan_cutters.domain.cutter import Cutter
from plan_cutters.domain.fixture import TABLE
from plan_cutters.domain.verdicts import Verdicts
from plan_cutters.scene.inside_material import inside_material
from plan_cutters.scene.preparation import Prepared
from plan_cutters.setups.holds import NothingToGripError
from plan_cutters.setups.requested import without

Rows = NDArray[np.int64]
Axis = tuple[float, float, float]
#: What looks down at the table so squarely lies on it.
_SQUARE = 1e-6
#: Setups that are not planned yet of which what stands around the part is kept, at most.
_TABLES = 3


class SetupOf(NamedTuple):
    """A setup of a state.

    axis : (float, float, float)
    number : int or None
        Its place among those of the plan, from 0; None of one that is not planned yet.
    """

    axis: Axis
    number: int | None = None


@dataclass(frozen=True, slots=True, eq=False)
class State:
    """Cutters that share a part: what counts is what none of them reaches in any of its setups.

    Attributes
    ----------
    ready : Prepared
    cutters : tuple of Cutter
        The one that is mended, or what became of it, first.
    setups : tuple of SetupOf
    tables : dict
        What setups that are not planned yet see, by axis and tolerance, those that were looked at last.
    """

    ready: Prepared
    cutters: tuple[Cutter, ...]
    setups: tuple[SetupOf, ...]
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
        """The part in one setup alone."""
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
    """Keep all that was judged so far, so that nothing is judged twice.

    Attributes
    ----------
    looked, missed : mapping
        By key: samples (n,) that were judged, and those of them that are not reached.
    tell : callable
        Called whenever a case was judged.
    """

    looked: dict[Any, NDArray[np.bool_]] = field(default_factory=dict)
    missed: dict[Any, NDArray[np.bool_]] = field(default_factory=dict)
    tell: Callable[[], None] = lambda: None

    @classmethod
    def of(
        cls, ready: Prepared, reaches: Mapping[Cutter, Verdicts], other_setups: Sequence[tuple[Axis, Mapping[str, Verdicts]]] = ()
    ) -> "Judgements":
        """Those of a plan."""
        judgements, wanted = cls(), ready.finished
        for k, ((axis, _), each) in enumerate(zip(ready.axes, (None, *(there for _, there in other_setups)), strict=False)):
            for cutter, verdicts in reaches.items():
                mine = verdicts if each is None else each[cutter.id]
                name = key(ready, cutter, SetupOf(axis, k))
                judgements.looked[name], judgements.missed[name] = wanted.copy(), mine.not_reached & wanted
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
