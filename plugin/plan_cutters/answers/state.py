"""Describe the plan after a step: its cutters, setups and conditions, and the samples that it would not reach."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from plan_cutters.answers.trial import Case
from plan_cutters.domain.cutter import Cutter
from plan_cutters.domain.verdicts import Verdicts
from plan_cutters.machines.requested_setups import without
from plan_cutters.scene.preparation import Prepared
from plan_cutters.scene.surroundings import Surroundings

Rows = NDArray[np.int64]
Axis = tuple[float, float, float]


@dataclass(frozen=True, slots=True, eq=False)
class State:
    """Cutters that share a part: what counts is what none of them reaches in any of its setups.

    Attributes
    ----------
    ready : Prepared
    cutters : tuple of Cutter
        The one that is mended, or what became of it, first.
    setups : tuple of (axis, x)
        As `Conditions` has them; x may be None.
    tables : dict
        Obstacles of setups that are not planned yet, made once, by axis and tolerance.
    """

    ready: Prepared
    cutters: tuple[Cutter, ...]
    setups: tuple[tuple[Axis, Axis | None], ...]
    tables: dict[tuple[Axis, float], Surroundings] = field(default_factory=dict)

    @property
    def axes(self) -> tuple[Axis, ...]:
        """The setup axes."""
        return tuple(axis for axis, _ in self.setups)

    def cases(self) -> Iterator[tuple[Any, Case]]:
        """Each cutter in each setup, and a key by which it is known."""
        conditions = self.ready.conditions
        for axis, x in self.setups:
            placed = replace(conditions, setup=np.array(axis), x=None if x is None else np.array(x))
            if axis != self.ready.scene.setup and axis not in self.ready.options.other_setups:
                at = axis, self.ready.scene.asked
                if at not in self.tables:
                    self.tables[at] = on_table(self.ready, axis)
                placed = replace(placed, surroundings=self.tables[at])
            there = replace(self.ready, conditions=placed)
            for cutter in self.cutters:
                yield key(there, cutter, axis, x), Case(there, cutter)


def on_table(ready: Prepared, axis: Axis) -> Surroundings:
    """The obstacles of a setup that is not planned yet: a table that the first setup brings itself lies across this axis, too."""
    place = ready.options.placement
    own = () if place is None else tuple(each for each in place.fixtures if each.follows_setup)
    if not own:
        return ready.conditions.surroundings
    return ready.scene.surround_in(axis, without(ready.scene.fixtures, own), own)


def key(ready: Prepared, cutter: Cutter, axis: Axis, x: Axis | None) -> Any:
    """Make the key of a case: the verdicts on the samples of a part depend on these values."""
    conditions = ready.conditions
    return cutter, axis, x, conditions.machine, conditions.postures, conditions.tolerance


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
        for (axis, x), each in zip(ready.axes, (None, *(verdicts for _, verdicts in other_setups)), strict=False):
            for cutter, verdicts in reaches.items():
                mine = verdicts if each is None else each[cutter.id]
                name = key(ready, cutter, axis, x)
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
                missed[case.judged(new)] = True
                looked[new] = True
                self.tell()
            rows = rows[missed[rows]]
        return rows

    def glance(self, state: State, rows: Rows) -> Rows:
        """The same, found by a quick search of these alone where they were not judged."""
        for name, case in state.cases():
            if not len(rows):
                break
            looked = self.looked.get(name)
            known = np.zeros(len(rows), bool) if looked is None else looked[rows]
            not_reached = np.zeros(len(rows), bool)
            not_reached[known] = self.missed[name][rows[known]] if known.any() else False
            new = np.flatnonzero(~known)
            not_reached[new] = np.isin(rows[new], case.misses(rows[new])) if len(new) else False
            rows = rows[not_reached]
        return rows
