"""The seed's steps: convex, concave or saddle, by the kernel's curvature; interference-free or interference-prone, by the dummy
cutter; and a posture, or why there is none, at every prone sample.
"""

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from cad_io.arrays import Ints, SurfaceSamples
from cad_io.graphs import connected
from plan_cutters.domain.verdicts import (
    AXIS_LIMIT,
    CONCAVE,
    CONVEX,
    DRILLED,
    FIXTURE,
    INACCESSIBLE,
    INSIDE,
    LOCAL_GOUGE,
    SADDLE,
    TOLERANCE,
    UNDECIDED,
    UNJUDGED,
    Verdicts,
    blank,
)
from plan_cutters.scene.conditions import Context, contacts_of, free_in_posture, under_fixtures
from plan_cutters.scene.flats_and_flanks import search
from plan_cutters.scene.work import Progress, Work, in_chunks, part_of

#: Curvature times part diagonal below which a curvature is zero: planes and cylinders come out convex, not as noise.
FLAT = 1e-6


def classify(samples: SurfaceSamples, diagonal: float) -> NDArray[np.uint8]:
    """Class of each sample.

    `diagonal`: of the part's box, mm. Returns (n,) uint8: CONVEX where both curvatures are zero or negative, CONCAVE where both
    are zero or positive (not both zero), SADDLE where they differ in sign, UNJUDGED where the kernel gave none.
    """
    kappa = np.where(np.abs(samples.curvature) * diagonal < FLAT, 0.0, samples.curvature)
    most, least = kappa[:, 0], kappa[:, 1]
    result = np.full(len(samples), SADDLE, np.uint8)
    result[least >= 0] = CONCAVE
    result[most <= 0] = CONVEX
    result[samples.unjudged >= 0] = UNJUDGED
    return result


def regions(samples: SurfaceSamples, surface_class: NDArray[np.uint8]) -> Ints:
    """Number the connected regions of equal class, across smooth face joints: (n,) int32, region of each sample, from 0."""
    a, b = samples.neighbours.T
    same = surface_class[a] == surface_class[b]
    return connected(len(samples), samples.neighbours[same])


def decompose(
    samples: SurfaceSamples, convex: NDArray[np.bool_], context: Context,
    *, inside: Ints | None = None, rows: NDArray[np.int64] | None = None, work: Work | None = None,
) -> NDArray[np.bool_]:  # fmt: skip
    """Test convex samples with the dummy cutter: which need no posture search?

    `convex` (n,) bool. `inside` (n,) int32: the body that each sample lies within, -1 for none (default): none of those within is
    free. `rows` (m,) int64: the samples to test, all by default. Returns (n,) bool: convex samples at which the dummy cutter, the
    axis limit and the posture range leave tilt 0 in every rotation.
    """
    from plan_cutters.kernels.search.search import dummy_clear

    conditions, interference_free = context.conditions, np.zeros(len(samples), bool)
    allowed = convex & conditions.upright(samples.normal)
    if inside is not None:
        allowed &= inside < 0
    selected = np.flatnonzero(allowed) if rows is None else rows[allowed[rows]]
    if not len(context.dummy):
        return interference_free
    arrays = contacts_of(samples), context.dummy, context.outer, conditions.obstacles.solids, interference_free
    # In fixed pieces, so that the work counted does not depend on how samples are divided, either.
    in_chunks(lambda piece: dummy_clear(piece, *arrays), selected, conditions.jobs, fixed=True, counted=work)
    return interference_free


def march_differs(samples: SurfaceSamples, convex: NDArray[np.bool_], region: Ints, interference_free: NDArray[np.bool_]) -> int:
    """Convex samples that the seed's march over boundaries would have put on the other side; `region` as in `regions`.

    It goes from each region's boundary inwards, past every point that is not free. What it reaches through points that are not
    free is prone; a pocket of such points inside is never looked at.
    """
    a, b = samples.neighbours.T
    n = len(samples)
    inside = region[a] == region[b]
    # The boundary: next to another region, or at the rim of the sampled surface (fewer than four neighbours).
    degree = np.bincount(a, minlength=n) + np.bincount(b, minlength=n)
    rim = degree < 4
    rim[a[~inside]] = rim[b[~inside]] = True
    blocked = convex & ~interference_free
    both = inside & blocked[a] & blocked[b]
    island, reached = connected(n, samples.neighbours[both]), np.zeros(n, bool)
    reached[island[blocked & rim]] = True
    marched = ~(blocked & reached[island])
    return int((marched[convex] != interference_free[convex]).sum())


#: A face that triangles follow only within so many tolerances is not searched: all of it is undecided.
_HOPELESS = 10.0


def access(
    samples: SurfaceSamples, interference_free: NDArray[np.bool_], context: Context, *, inside: Ints | None = None,
    known: Verdicts | None = None, rows: NDArray[np.int64] | None = None, drilled: NDArray[np.bool_] | None = None,
    progress: Progress | None = None, work: Work | None = None,
) -> Verdicts:  # fmt: skip
    """Search a posture for every judged sample that is not interference-free.

    `interference_free` (n,) bool: as `decompose` gives them. `inside` (n,) int32: the body that each sample lies within, -1 for
    none (default): none of those within is accessible. `known`: what follows from other cutters (`nesting.handed`): those samples
    are not searched again. `rows` (m,) int64: the samples to search, all by default; the others stay unjudged. Whole pieces of
    them (`with_company`), or else other postures may be found for the same sample. `drilled` (n,) bool: samples that are for
    drills, and are not searched.
    """
    from plan_cutters.kernels.search.search import first_reason

    n, conditions = len(samples), context.conditions
    verdicts = blank(n)
    judged = samples.unjudged < 0
    if rows is not None:
        judged &= np.isin(np.arange(n), rows)
    if drilled is not None:
        verdicts.verdict[judged & drilled] = DRILLED
        judged &= ~drilled
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
        # Where the axis limit, or curvature at the contact, leaves this cutter nothing, the reason is its own.
        few, tool, certain = follows & (known.verdict == INACCESSIBLE), context.inner, conditions.surroundings.certain.solids
        in_chunks(
            lambda piece: first_reason(piece, contacts, conditions.ranges, tool, certain, verdicts.reason),
            np.flatnonzero(few), conditions.jobs,
        )  # fmt: skip
        wanted &= ~follows
    alone, faces = conditions.surroundings.alone, samples.face
    if alone is None:
        search(contacts, faces, np.flatnonzero(wanted), context, verdicts, progress, fixed=True, work=work)
        return verdicts.freeze()
    # What the part itself keeps off is not searched again among what holds it.
    within_fixtures = np.zeros(n, bool) if inside is None else judged & (inside >= len(conditions.surroundings.bodies))
    handed = judged & (verdicts.reason == FIXTURE)
    tells = (None, None) if progress is None else (part_of(progress, 0, 2), part_of(progress, 1, 2))
    bare, result = Context.of(context.cutter, replace(conditions, surroundings=alone)), blank(n)
    search(contacts, faces, np.flatnonzero(wanted | within_fixtures | handed), bare, result, tells[0], fixed=True, work=work)
    blocked = wanted & (result.verdict == INACCESSIBLE)
    verdicts.verdict[blocked], verdicts.reason[blocked] = INACCESSIBLE, result.reason[blocked]
    # Where the tool stands beside them as without them, no other posture is sought; not where it has slid along a flank.
    good = np.flatnonzero(wanted & result.reached & ~result.shift.any(axis=1))
    good = good[free_in_posture(contacts, good, result.axis, result.tilt_direction, context, work)[good]]
    verdicts.take(good, result)
    open_ = np.setdiff1d(np.flatnonzero(wanted & ~blocked), good, assume_unique=True)
    under = under_fixtures(contacts, open_, context)
    verdicts.verdict[open_[under]], verdicts.reason[open_[under]] = INACCESSIBLE, INSIDE
    open_ = open_[~under]
    search(contacts, faces, open_, context, verdicts, tells[1], fixed=True, work=work)
    # Of samples not reached, those that fixtures keep off are told from those that would not be reached without them, either.
    rows = np.flatnonzero(((wanted & ~blocked) | within_fixtures) & verdicts.not_reached | handed)
    rows = rows[~np.isin(verdicts.reason[rows], (AXIS_LIMIT, LOCAL_GOUGE))]
    verdicts.reason[rows] = np.where(result.reached[rows], FIXTURE, result.reason[rows])
    return verdicts.freeze()
