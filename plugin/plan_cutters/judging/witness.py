"""Witnesses: samples that are not reached, for people to look at, and the posture that comes nearest to reaching each.

What is not reached on a face for one reason is a group, as is what of it lies within one body. Each has a witness, with how many
samples it stands for. Depths are searched for in the groups of the largest area, at samples far apart: so much for each cutter,
however many samples are not reached. Nothing is searched for what lies within material: no posture helps there.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from cad_io.arrays import Floats, Ints, SurfaceSamples
from cad_io.part import Part
from plan_cutters.domain.assembly import assembly
from plan_cutters.domain.cutter import Cutter
from plan_cutters.domain.verdicts import INSIDE, REASONS, TOLERANCE, Verdicts, Witness, blank
from plan_cutters.kernels.rows import Contacts
from plan_cutters.scene.conditions import Conditions, Context, rotations_of, tool_of, verdict_arrays_of
from plan_cutters.scene.distances import deepest, deepest_of
from plan_cutters.scene.inside_material import cover
from plan_cutters.scene.work import METER, in_chunks

#: Witnesses kept for each group, samples tried in each to find them, and in all.
_MOST, _TRIED, _TRIED_IN_ALL = 2, 6, 60
#: Depths are found to this share of themselves.
_PRECISION = 0.02
#: Depths are looked for down to this share of the tolerance.
_SHALLOWEST = 0.1
#: How far apart tilts are among which the one of least depth is looked for at first, and at last, rad.
_COARSE, _FINE = 0.05, 1.7e-4


@dataclass(frozen=True, slots=True)
class _Group:
    """Samples `rows` that are not reached on a face for one reason, an index into REASONS, and within one body, -1 for none."""

    face: int
    reason: int
    body: int
    rows: NDArray[np.int64]
    area: float

    @property
    def searched(self) -> bool:
        """Whether there may be a depth to search for."""
        return self.body < 0 and self.reason not in (INSIDE, TOLERANCE)


def witnesses(
    samples: SurfaceSamples, verdicts: Verdicts, context: Context, *, inside: Ints | None = None, part: Part | None = None
) -> tuple[Witness, ...]:
    """Samples that are not reached, for each face and reason; `inside` as in `access`.

    The deepest one that was tried comes first, then the one farthest from it. Depths are measured on the surface of `part`;
    without it, on the triangles. Where there are too many groups to try a sample in each, those of less area have a witness
    without a depth; the largest of each face comes before the second of any.
    """
    groups = list(_groups(samples, verdicts, inside))
    tried = _measured(groups)
    most = max(1, min(_TRIED, _TRIED_IN_ALL // max(1, len(tried))))
    picked = {i: far_apart(samples.point, groups[i].rows, most) for i in tried}
    looked: dict[int, Witness] = {}
    conditions = context.conditions
    alone = Context.of(context.cutter, replace(conditions, jobs=1))

    def work(rows: NDArray[np.int64]) -> None:
        for row in rows.tolist():
            looked[row] = _witness(samples, row, verdicts, alone, part)

    in_chunks(work, np.array([row for rows in picked.values() for row in rows], np.int64), conditions.jobs, chunk=1)
    result: list[Witness] = []
    for i, group in enumerate(groups):
        if i in picked:
            picked_rows = _selected([looked[row] for row in picked[i]], samples.point)
        else:
            row = far_apart(samples.point, group.rows, 1)[0]
            plain = Witness(row, REASONS[group.reason], untried=group.searched)
            within = group.body >= 0 or group.reason == INSIDE
            picked_rows = [_covered(samples, plain, group.body, conditions) if within else plain]
        result += [replace(each, samples=len(group.rows)) for each in picked_rows]
    return tuple(result)


def _groups(samples: SurfaceSamples, verdicts: Verdicts, inside: Ints | None) -> Iterator[_Group]:
    """Group the samples that are not reached by face, reason and body, in the order in which samples come."""
    not_reached = np.flatnonzero(verdicts.not_reached)
    body = np.full(len(not_reached), -1) if inside is None else inside[not_reached]
    key = np.stack([samples.face[not_reached], verdicts.reason[not_reached], body], axis=1)
    each, first, which = np.unique(key, axis=0, return_index=True, return_inverse=True)
    order = np.argsort(which.reshape(-1), kind="stable")
    pieces = np.split(not_reached[order], np.cumsum(np.bincount(which.reshape(-1), minlength=len(each)))[:-1])
    for i in np.argsort(first).tolist():
        face, reason, within = map(int, each[i])
        yield _Group(face, reason, within, pieces[i], float(np.nansum(samples.area[pieces[i]])))


def _measured(groups: Sequence[_Group]) -> list[int]:
    """Which groups a depth is searched for in: the largest of each face before the second ones, as many as may be tried."""
    order = sorted((i for i, group in enumerate(groups) if group.searched), key=lambda i: (-groups[i].area, i))
    place: dict[int, int] = {}
    turn = {}
    for i in order:
        turn[i] = place[groups[i].face] = place.get(groups[i].face, -1) + 1
    return sorted(order, key=lambda i: (turn[i], -groups[i].area, i))[:_TRIED_IN_ALL]


def far_apart(point: Floats, rows: NDArray[np.int64], most: int) -> list[int]:
    """At most so many of some rows: the one nearest to their middle, then each as far as can be from those before it."""
    at = np.nan_to_num(point[rows])
    chosen = [int(np.linalg.norm(at - at.mean(axis=0), axis=1).argmin())]
    away = np.full(len(rows), np.inf)
    while len(chosen) < min(most, len(rows)):
        away = np.minimum(away, np.linalg.norm(at - at[chosen[-1]], axis=1))
        away[chosen] = -1.0
        chosen.append(int(away.argmax()))
    return [int(rows[k]) for k in chosen]


def _selected(looked: Sequence[Witness], point: Floats) -> list[Witness]:
    """The deepest, then those with a depth, first with another obstacle, and of these the farthest from it."""
    ranked = sorted(looked, key=lambda w: (-(w.depth or 0.0), w.sample))
    first = ranked[0]
    others = sorted(ranked[1:], key=lambda w: (
        w.depth is None, w.obstacle_face == first.obstacle_face,
        -float(np.linalg.norm(point[w.sample] - point[first.sample])), w.sample))  # fmt: skip
    return [ranked[0], *others[: _MOST - 1]]


def _witness(samples: SurfaceSamples, row: int, verdicts: Verdicts, context: Context, part: Part | None) -> Witness:
    """Find the posture of least depth by halving the depth that is let pass, and measure it on the surface."""
    reason, cutter, conditions = REASONS[verdicts.reason[row]], context.cutter, context.conditions
    least_depth = _least_depth(samples, row, cutter, replace(conditions, surroundings=conditions.surroundings.skins))
    if least_depth is None:
        return Witness(row, reason)
    obstacles, at, outer_tool = conditions.obstacles, slice(row, row + 1), context.outer_tool
    best = least_depth[0]
    if obstacles.holds(outer_tool, samples.point[at], samples.normal[at], best.tilt_direction, best.tilt)[0]:
        # Its axis lies within material: one that does not says more, if there is any.
        least_depth = _least_depth(samples, row, cutter, conditions) or least_depth
    best, low, high = least_depth
    there = cutter, samples.point[row], samples.normal[row], best, low
    met = deepest(part, obstacles, *there)
    if reason == "fixture":
        # The part may be as much in the way there: what is named is what would free the sample.
        own = [(each.number, deepest(None, each.obstacles, *there)) for each in conditions.surroundings.fixtures]
        met = max((replace(it, face=n) for n, it in own if it is not None), key=lambda it: it.depth, default=met)
    return Witness(
        sample=row,
        reason=reason,
        obstacle_face=None if met is None else met.face,
        obstacle_point=None if met is None else met.point,
        tilt=float(best.tilt[0]),
        rotation=float(rotations_of(samples.normal[at], samples.direction_max[at], best.tilt_direction)[0]),
        axis=best.axis[0],
        depth=high if met is None else met.depth,
    )


def _least_depth(
    samples: SurfaceSamples, row: int, cutter: Cutter, conditions: Conditions
) -> tuple[Verdicts, float, float] | None:
    """The posture of least depth, and depths, mm, between which that lies; None if none is left at any depth.

    What takes long is taken for none: deep in other bodies there is none, and only a search through all tilts would prove it.
    """
    from plan_cutters.kernels.search.search import posture

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
            arrays = verdict_arrays_of(best)
            free, looked = posture(contact, ranges, tool, narrowest, start, turns, solids, arrays, brief=True)
            METER.add(looked)
            if free:
                start, high = (int(best.rotation[0]), float(best.tilt[0])), depth
            elif not np.isnan(high):
                low = depth
            else:
                break
    return None if np.isnan(high) else (best.freeze(), low, high)


def _covered(samples: SurfaceSamples, plain: Witness, body: int, conditions: Conditions) -> Witness:
    """Add the obstacle to the witness of a sample inside material: the point where the way out along the normal leaves it."""
    surroundings = conditions.surroundings
    if body >= len(surroundings.enclosing):
        return plain  # on a clamped face
    within = surroundings.enclosing[body] if body >= 0 else None
    way_out = cover(samples.point[plain.sample], samples.normal[plain.sample], surroundings.certain, within)
    return plain if way_out is None else replace(plain, obstacle_face=way_out.face, obstacle_point=way_out.point)
