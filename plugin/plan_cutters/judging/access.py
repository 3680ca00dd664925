"""Is the cutter accessible? The seed's second phase: a posture, or why there is none, at every prone sample."""

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from cad_io.arrays import Ints, SurfaceSamples
from plan_cutters.domain.verdicts import (
    AXIS_LIMIT,
    FIXTURE,
    INACCESSIBLE,
    INSIDE,
    LOCAL_GOUGE,
    TOLERANCE,
    UNDECIDED,
    UNJUDGED,
    VerdictBuffer,
    Verdicts,
    blank,
)
from plan_cutters.kernels.rows import Contacts
from plan_cutters.scene.conditions import Context, contacts_of
from plan_cutters.scene.flats_and_flanks import search
from plan_cutters.scene.threads import Progress, in_chunks
from plan_cutters.scene.work import Work

#: A face that triangles follow only within so many tolerances is not searched: all of it is undecided.
_HOPELESS = 10.0


def access(
    samples: SurfaceSamples,
    interference_free: NDArray[np.bool_],
    context: Context,
    *,
    inside: Ints | None = None,
    known: Verdicts | None = None,
    rows: NDArray[np.int64] | None = None,
    progress: Progress | None = None,
    work: Work | None = None,
) -> Verdicts:
    """Search a posture for every judged sample that is not interference-free.

    Parameters
    ----------
    samples : SurfaceSamples
    interference_free : (n,) bool
        As `decompose` gives them.
    context : Context
    inside : (n,) int32, optional
        The body that each sample lies within, -1 for none (default): none of those within is accessible.
    known : Verdicts, optional
        What follows from other cutters (`nesting.handed`): those samples are not searched again.
    rows : (m,) int64, optional
        The samples to search, all by default; the others stay unjudged. Whole pieces of them (`with_company`), or else
        other postures may be found for the same sample.
    progress : callable, optional
        Called with the number of pieces of work that are done, and the number of all.
    work : Work, optional
        Where what is looked at is counted.
    """
    n, conditions = len(samples), context.conditions
    verdicts = blank(n)
    judged = samples.unjudged < 0
    if rows is not None:
        judged &= np.isin(np.arange(n), rows)
    if not context.judges:
        verdicts.verdict[judged], verdicts.reason[judged] = UNDECIDED, TOLERANCE
        return verdicts.freeze()
    within = np.zeros(n, bool) if inside is None else judged & (inside >= 0)
    verdicts.verdict[within], verdicts.reason[within] = INACCESSIBLE, INSIDE
    # On a face that may be anywhere within so many tolerances each posture is in doubt, and a search tries them all.
    loose = [number for number, error in conditions.surroundings.loose.items() if error > _HOPELESS * conditions.tolerance]
    if loose:
        doubtful = judged & ~within & np.isin(samples.face, loose)
        verdicts.verdict[doubtful], verdicts.reason[doubtful] = UNDECIDED, TOLERANCE
        judged &= ~doubtful
    upright = judged & interference_free
    verdicts.stand_upright(upright, samples.normal, samples.direction_max)
    contacts = contacts_of(samples)
    wanted = judged & ~upright & ~within
    if known is not None:
        follows = wanted & (known.verdict != UNJUDGED)
        verdicts.take(follows, known)
        _first_reasons(contacts, np.flatnonzero(follows & (known.verdict == INACCESSIBLE)), context, verdicts.reason)
        wanted &= ~follows
    search(contacts, samples.face, np.flatnonzero(wanted), context, verdicts, progress, fixed=True, work=work)
    if conditions.surroundings.alone is not None:
        searched = wanted | (inside >= len(conditions.surroundings.bodies) if inside is not None else False)
        handed = judged & (verdicts.reason == FIXTURE)
        bare = context.under(replace(conditions, surroundings=conditions.surroundings.alone))
        _for_fixtures(samples, np.flatnonzero((searched & verdicts.not_reached) | handed), bare, verdicts)
    return verdicts.freeze()


def _for_fixtures(samples: SurfaceSamples, rows: NDArray[np.int64], bare: Context, verdicts: VerdictBuffer) -> None:
    """Of samples not reached, tell those that fixtures keep off from those that would not be reached without them, either."""
    rows = rows[~np.isin(verdicts.reason[rows], (AXIS_LIMIT, LOCAL_GOUGE))]
    if not len(rows):
        return
    result = blank(len(verdicts.verdict))
    search(contacts_of(samples), samples.face, rows, bare, result, fixed=True)
    verdicts.reason[rows] = np.where(result.reached[rows], FIXTURE, result.reason[rows])


def _first_reasons(contacts: Contacts, rows: NDArray[np.int64], context: Context, reason: NDArray[np.uint8]) -> None:
    """Where the axis limit, or curvature at the contact, leaves this cutter nothing, the reason is its own."""
    from plan_cutters.kernels.search.search import first_reason

    conditions, tool = context.conditions, context.inner
    ranges, certain = conditions.ranges, conditions.surroundings.certain.solids
    in_chunks(lambda piece: first_reason(piece, contacts, ranges, tool, certain, reason), rows, conditions.jobs)
