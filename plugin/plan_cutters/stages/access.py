"""Is the cutter accessible? The seed's second phase: a posture, or why there is none, at every prone sample."""

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from cad_io.arrays import Ints, SurfaceSamples
from cad_io.part import Part
from plan_cutters.domain.assembly import assembly
from plan_cutters.domain.cutter import Cutter
from plan_cutters.domain.verdicts import (
    AXIS_LIMIT,
    BURIED,
    FIXTURE,
    INACCESSIBLE,
    INTERFERENCE_FREE,
    LOCAL_GOUGE,
    REASONS,
    TOLERANCE,
    UNDECIDED,
    UNJUDGED,
    Reach,
    Witness,
    blank,
)
from plan_cutters.kernels.rows import Contacts
from plan_cutters.scene.buried import cover
from plan_cutters.scene.conditions import Conditions, contacts_of, found_of, rotations_of, search_postures, tool_of
from plan_cutters.scene.deepest import deepest, deepest_of
from plan_cutters.scene.obstacles import Obstacles
from plan_cutters.scene.threads import Progress, in_chunks


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
    search_postures(contacts, np.flatnonzero(wanted), light, heavy, conditions, reach, progress, fixed=True)
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
    from plan_cutters.kernels.search import first_reason

    ranges, tool, surely = conditions.ranges, tool_of(conditions.heavy(cutter)), conditions.around.surely.solids
    in_chunks(lambda piece: first_reason(piece, contacts, ranges, tool, surely, reason), rows, conditions.jobs)


#: Witnesses kept for each face and reason, and samples tried to find them, in all.
_KEPT, _TRIED, _TRIED_IN_ALL = 2, 6, 60
#: Depths are found to this share of themselves.
_PRECISION = 0.02
#: Depths are looked for down to this share of the tolerance.
_SHALLOWEST = 0.1
#: How far apart tilts are among which the one of least depth is looked for at first, and at last, rad.
_COARSE, _FINE = 0.05, 1.7e-4


def witnesses(
    samples: SurfaceSamples, reach: Reach, cutter: Cutter, conditions: Conditions, *, buried: Ints | None = None,
    part: Part | None = None,
) -> tuple[Witness, ...]:  # fmt: skip
    """Samples that are not reached, the deepest tried of each face and reason first; `buried` as in `access`.

    Depths are measured on the surface of `part`; without it, on the triangles.
    """
    lost = np.flatnonzero((reach.verdict == INACCESSIBLE) | (reach.verdict == UNDECIDED))
    groups: dict[tuple[int, int], list[int]] = {}
    for row in lost:
        groups.setdefault((int(samples.face[row]), int(reach.reason[row])), []).append(int(row))
    tries = max(1, min(_TRIED, _TRIED_IN_ALL // max(1, len(groups))))
    picked = [
        [group[i] for i in np.unique(np.linspace(0, len(group) - 1, tries).astype(int))] for group in groups.values()
    ]
    looked: dict[int, Witness] = {}
    alone = replace(conditions, jobs=1)

    def work(rows: NDArray[np.int64]) -> None:
        for row in rows.tolist():
            body = -1 if buried is None else int(buried[row])
            if body < 0:
                looked[row] = _witness(samples, row, reach, cutter, alone, part)
            else:
                around = conditions.around
                skin = around.surely.skin_of(around.enclosing[body])
                looked[row] = _covered(samples, row, REASONS[reach.reason[row]], skin)

    in_chunks(work, np.array([row for group in picked for row in group], np.int64), conditions.jobs, chunk=1)
    found: list[Witness] = []
    for group in picked:
        ranked = sorted((looked[row] for row in group), key=lambda w: (-(w.depth or 0.0), w.sample))
        found += ranked[:_KEPT]
    return tuple(found)


def _witness(
    samples: SurfaceSamples, row: int, reach: Reach, cutter: Cutter, conditions: Conditions, part: Part | None
) -> Witness:
    """Find the posture of least depth by halving the depth that is let pass, and measure it on the surface."""
    reason = REASONS[reach.reason[row]]
    nothing = Witness(row, reason, None, None, None, None, None, None)
    if reason == "tolerance":
        return nothing
    if reason == "buried":
        return _covered(samples, row, reason, conditions.around.surely)
    found = _least_depth(samples, row, cutter, replace(conditions, around=conditions.around.skins))
    if found is None:
        return nothing
    obstacles, at, light = conditions.obstacles, slice(row, row + 1), conditions.light(cutter)
    best = found[0]
    if obstacles.holds(light, samples.point[at], samples.normal[at], best.lean, best.tilt)[0]:
        # Its axis lies within material: one that does not says more, if there is any.
        found = _least_depth(samples, row, cutter, conditions) or found
    best, low, high = found
    there = cutter, samples.point[row], samples.normal[row], best, low
    met = deepest(part, obstacles, *there)
    if reason == "fixture":
        # The part may be as much in the way there: what is named is what would free the sample.
        own = [(each.number, deepest(None, each.obstacles, *there)) for each in conditions.around.fixtures]
        met = max((replace(it, face=n) for n, it in own if it is not None), key=lambda it: it.depth, default=met)
    return Witness(
        sample=row,
        reason=reason,
        obstacle_face=None if met is None else met.face,
        obstacle_point=None if met is None else met.point,
        tilt=float(best.tilt[0]),
        rotation=float(rotations_of(samples.normal[at], samples.direction_max[at], best.lean)[0]),
        axis=best.axis[0],
        depth=high if met is None else met.depth,
    )


def _least_depth(
    samples: SurfaceSamples, row: int, cutter: Cutter, conditions: Conditions
) -> tuple[Reach, float, float] | None:
    """The posture of least depth, and depths, mm, between which that lies; None if no posture is left at any."""
    from plan_cutters.kernels.search import posture

    one = slice(row, row + 1)
    # Depth alone counts: curvature has no say.
    contact = Contacts(samples.point[one], samples.normal[one], samples.direction_max[one], np.zeros((1, 2)))
    ranges, solids, rotations = conditions.ranges, conditions.obstacles.solids, len(conditions.ranges.rotation_cos)
    least, most, best = _SHALLOWEST * conditions.tolerance, deepest_of(cutter), blank(1)
    low, high, start = least, np.nan, (0, -1.0)
    # At first among tilts that are `_COARSE` apart at all rotations, then among all tilts at the rotation found.
    for narrowest, near in ((_COARSE, 5.0 * _PRECISION), (_FINE, _PRECISION)):
        low, depth, turns = least, most, rotations if np.isnan(high) else 1
        # Where nothing was found, a cutter that is all but a line is stopped again and again: not every tilt is tried.
        narrowest = narrowest if turns == 1 else max(narrowest, 0.1 * _COARSE)
        while not high - low <= near * high:
            if not np.isnan(high):
                depth = float(np.sqrt(low * high))
            tool = tool_of(assembly(cutter, depth, depth))
            if posture(contact, ranges, tool, narrowest, start, turns, solids, found_of(best)):
                start, high = (int(best.rotation[0]), float(best.tilt[0])), depth
            elif not np.isnan(high):
                low = depth
            else:
                break
    return None if np.isnan(high) else (best, low, high)


def _covered(samples: SurfaceSamples, row: int, reason: str, skin: Obstacles) -> Witness:
    """What a sample lies within is the witness: where the way out along the normal leaves it."""
    way_out = cover(samples.point[row], samples.normal[row], skin)
    face, point = (None, None) if way_out is None else (way_out.face, way_out.point)
    return Witness(row, reason, face, point, None, None, None, None)
