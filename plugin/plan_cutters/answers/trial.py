"""Samples are asked again, of another cutter or another part: quickly, or as a plan judges them.

A quick look asks only whether samples have a posture, in any company; what is told of a step rests on `judge`: Lemma M1 of
`docs/mending_proof.md`.
"""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from plan_cutters.domain.cutter import Cutter
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
from plan_cutters.judging.judge import judge
from plan_cutters.kernels.rows import Contacts
from plan_cutters.scene.conditions import Context, contacts_of, over_plane
from plan_cutters.scene.flats_and_flanks import search
from plan_cutters.scene.preparation import Prepared

Rows = NDArray[np.int64]


@dataclass(frozen=True, slots=True, eq=False)
class Case:
    """A part that is ready, in all its setups, and a cutter, one thing of either changed."""

    ready: Prepared
    cutter: Cutter
    #: Nothing of the tool may be lower along the setup axis, mm: a table that is only a plane.
    above: float | None = None

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

    def judged(self, rows: Rows | None = None) -> Rows:
        """Samples of the finished surface that it does not reach, as a plan finds them: of all, or of some, ascending."""
        wanted = np.flatnonzero(self.ready.finished) if rows is None else rows[self.ready.finished[rows]]
        for one in self.setups:
            if len(wanted):
                wanted = wanted[~judge(one, self.cutter, wanted).reached]
        return wanted


def _look(ready: Prepared, cutter: Cutter, rows: Rows, *, brief: bool, above: float | None) -> Verdicts:
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
    if above is not None:
        below = verdicts.reached & ~over_plane(context, contacts, verdicts, above)
        verdicts.verdict[below], verdicts.reason[below] = INACCESSIBLE, FIXTURE
    verdicts.verdict[within], verdicts.reason[within] = INACCESSIBLE, np.where(held[within], FIXTURE, INSIDE)
    return verdicts.freeze()
