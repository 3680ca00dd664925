"""Is the cutter accessible? The seed's second phase: a posture, or why there is none, at every prone sample."""

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from cad_io.arrays import Ints, SurfaceSamples
from plan_cutters.domain.cutter import Cutter
from plan_cutters.domain.verdicts import (
    AXIS_LIMIT,
    BURIED,
    FIXTURE,
    INACCESSIBLE,
    INTERFERENCE_FREE,
    LOCAL_GOUGE,
    TOLERANCE,
    UNDECIDED,
    UNJUDGED,
    Reach,
    blank,
)
from plan_cutters.kernels.rows import Contacts
from plan_cutters.scene.conditions import Conditions, contacts_of, search_postures, tool_of
from plan_cutters.scene.threads import Progress, in_chunks
from plan_cutters.scene.work import Work


def access(
    samples: SurfaceSamples,
    interference_free: NDArray[np.bool_],
    cutter: Cutter,
    conditions: Conditions,
    *,
    buried: Ints | None = None,
    known: Reach | None = None,
    rows: NDArray[np.int64] | None = None,
    progress: Progress | None = None,
    work: Work | None = None,
) -> Reach:
    """Search a posture for every judged sample that is not interference-free.

    Parameters
    ----------
    samples : SurfaceSamples
    interference_free : (n,) bool
        As `decompose` gives them.
    cutter, conditions
    buried : (n,) int32, optional
        The body that each sample lies within, -1 for none (default): none of those within is accessible.
    known : Reach, optional
        What follows from other cutters (`nesting.handed`): those samples are not searched again.
    rows : (m,) int64, optional
        The samples to search, all by default; the others stay unjudged. Whole pieces of them (`with_company`), or else
        other postures may be found for the same sample.
    progress : callable, optional
        Told how many pieces of the work are done, of how many.
    work : Work, optional
        Where what is looked at is counted.
    """
    n = len(samples)
    reach = blank(n)
    judged = samples.unjudged < 0
    if rows is not None:
        judged &= np.isin(np.arange(n), rows)
    if not conditions.judges(cutter):
        reach.verdict[judged], reach.reason[judged] = UNDECIDED, TOLERANCE
        return reach
    within = np.zeros(n, bool) if buried is None else judged & (buried >= 0)
    reach.verdict[within], reach.reason[within] = INACCESSIBLE, BURIED
    upright = judged & interference_free
    reach.verdict[upright] = INTERFERENCE_FREE
    reach.axis[upright] = samples.normal[upright]
    reach.lean[upright] = samples.direction_max[upright]
    reach.tilt[upright] = 0.0
    reach.rotation[upright] = 0
    contacts = contacts_of(samples)
    wanted = judged & ~upright & ~within
    if known is not None:
        follows = wanted & (known.verdict != UNJUDGED)
        for name in Reach.__slots__:
            getattr(reach, name)[follows] = getattr(known, name)[follows]
        _first_reasons(
            contacts, np.flatnonzero(follows & (known.verdict == INACCESSIBLE)), cutter, conditions, reach.reason
        )
        wanted &= ~follows
    light, heavy = conditions.light(cutter), conditions.heavy(cutter)
    search_postures(contacts, np.flatnonzero(wanted), light, heavy, conditions, reach, progress, fixed=True, work=work)
    if conditions.around.alone is not None:
        searched = wanted | (buried >= len(conditions.around.bodies) if buried is not None else False)
        handed = judged & (reach.reason == FIXTURE)
        _for_fixtures(contacts, np.flatnonzero((searched & reach.lost) | handed), cutter, conditions, reach)
    return reach


def _for_fixtures(
    contacts: Contacts, rows: NDArray[np.int64], cutter: Cutter, conditions: Conditions, reach: Reach
) -> None:
    """Of lost samples, tell those that are lost to fixtures from those that would be lost without them, too."""
    rows = rows[~np.isin(reach.reason[rows], (AXIS_LIMIT, LOCAL_GOUGE))]
    if conditions.around.alone is None or not len(rows):
        return
    bare, found = replace(conditions, around=conditions.around.alone), blank(len(reach.verdict))
    search_postures(contacts, rows, bare.light(cutter), bare.heavy(cutter), bare, found, fixed=True)
    reach.reason[rows] = np.where(found.reached[rows], FIXTURE, found.reason[rows])


def _first_reasons(
    contacts: Contacts, rows: NDArray[np.int64], cutter: Cutter, conditions: Conditions, reason: NDArray[np.uint8]
) -> None:
    """Where the axis limit, or curvature at the contact, leaves this cutter nothing, the reason is its own."""
    from plan_cutters.kernels.search.search import first_reason

    ranges, tool, surely = conditions.ranges, tool_of(conditions.heavy(cutter)), conditions.around.surely.solids
    in_chunks(lambda piece: first_reason(piece, contacts, ranges, tool, surely, reason), rows, conditions.jobs)
