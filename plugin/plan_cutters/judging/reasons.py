"""Why a sample is not reached, by what would free it: the first of these without which there is a posture is the reason.

The axis limit (another setup or machine); the holder, the shank, the neck (a longer stick-out, a slimmer holder); the fixtures.
Where none of them alone frees it, it is what forbids most tilts to the flutes, whatever limits, holders and fixtures there are:
only another cutter helps there. No verdict is changed.

A sharp inside edge is a reason of its own: beside one, a round cutter leaves a fillet whatever its posture. A sample of a face A
is lost to its edge with a face B where all of this holds:

- it is not reached, for rear gouge, collision or axis limit (local gouge is the curvature of A itself; with more room for shank
  and holder this cutter itself would do);
- the ball of the cutter's least radius that touches A there reaches into B as that runs on from the edge, its curvature across
  the edge included: between planes that is nearer to the edge than r / tan(angle / 2);
- farther from the edge the cutter does its work: it reaches a sample near the place where the ball touches both faces. In a
  slot that is too narrow for the cutter it does not;
- the cutter does not enter the edge: it reaches less than half of the samples that near. A flat end does, between wall and floor.

Where such an edge stands on a third face, as that of two walls on a floor, a flat end leaves the corner of the third face, too:
what lies beyond the disk of its radius that touches both walls. A sample there is lost to the edge if the cutter reaches the
third face beside that disk. A sample counts as it is: no spacing is added to the width.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from cad_io.arrays import Floats, Ints, SurfaceSamples
from cad_io.part.edges import InsideEdge
from plan_cutters.domain.cutter import Cutter
from plan_cutters.domain.preference import inside
from plan_cutters.domain.shapes import flute_length
from plan_cutters.domain.standard_tools import least_radius
from plan_cutters.domain.verdicts import (
    AXIS_LIMIT,
    COLLISION,
    FIXTURE,
    INACCESSIBLE,
    INSIDE,
    LOCAL_GOUGE,
    NO_REASON,
    REAR_GOUGE,
    REASONS,
    SHARP_EDGE,
    TOLERANCE,
    UNJUDGED,
    Verdicts,
    blank,
)
from plan_cutters.scene.conditions import Conditions, Context, contacts_of
from plan_cutters.scene.flats_and_flanks import search
from plan_cutters.scene.work import Progress

_PARTS = tuple(REASONS.index(word) for word in ("neck", "shank", "holder"))
#: Reasons behind which a sharp inside edge may be: nobody buys a machine to lean a tool into one.
_AT_EDGES = (REAR_GOUGE, COLLISION, AXIS_LIMIT)


@dataclass(frozen=True, slots=True, eq=False)
class Explained:
    """The reach of a cutter with the reasons that can be acted on.

    `verdicts`: verdicts and postures as they were. `besides` (n,) uint8: where the reason is the axis limit: what else is in the
    way within it, index into REASONS; else NO_REASON.
    """

    verdicts: Verdicts
    besides: NDArray[np.uint8]

    @classmethod
    def of_search(cls, verdicts: Verdicts) -> "Explained":
        """With the reasons that the search of postures found: what forbids most tilts."""
        return cls(verdicts, np.full(len(verdicts.verdict), NO_REASON, np.uint8))


@dataclass(slots=True)
class Reasons:
    """Finds reasons, cutter after cutter; what was found for one spares another some of the search.

    `conditions`: of each setup. `asked` (n,) bool: samples that have a reason to be looked for. `machinable` (sequence of (n,)
    bool): of each setup, the samples that are neither clamped nor inside material there.
    """

    samples: SurfaceSamples
    conditions: Sequence[Conditions]
    asked: NDArray[np.bool_]
    machinable: Sequence[NDArray[np.bool_]]
    _known: dict[str, dict[Cutter, Verdicts]] = field(default_factory=dict)

    def of(self, cutter: Cutter, verdicts: Verdicts, progress: Progress | None = None) -> Explained:
        """Find the reasons of what a cutter loses; `verdicts`: over all setups, with the reasons that its search found."""
        tell = progress or (lambda done, total: None)
        first, n = self.conditions[0], len(verdicts.verdict)
        before, reason, besides = verdicts.reason, verdicts.reason.copy(), np.full(n, NO_REASON, np.uint8)
        rows = np.flatnonzero(verdicts.not_reached & self.asked & ~np.isin(before, (INSIDE, TOLERANCE)))
        limited, less, alone = first.machine.limited, list(_less(cutter)), first.surroundings.alone
        held = any(each.surroundings.alone is not None for each in self.conditions) or not self._alike
        if not len(rows) or not (limited or less or held):
            return Explained(verdicts, besides)
        # Flutes by themselves, without limits and fixtures: what they do not reach nothing else frees, and is done with.
        bare = replace(first.without_machine(), surroundings=alone or first.surroundings)
        searched = self._search("flutes", less[-1][1] if less else cutter, rows, bare)
        shut = rows[~searched.reached[rows] & np.isin(before[rows], (AXIS_LIMIT, FIXTURE, *_PARTS))]
        reason[shut] = searched.reason[shut]
        rows = rows[searched.reached[rows]]
        tell(1, 3)
        if limited:
            if less or held:
                searched = self._search("unlimited", cutter, rows, first.without_machine())
            free = searched.reached[rows] if self._alike else self._anywhere(cutter, rows, limited=False)
            reason[rows[free]] = AXIS_LIMIT
            # Where the limit leaves nothing by itself, and so does something without it, both take part.
            other = np.where(free, before[rows], searched.reason[rows])
            besides[rows] = np.where((free & (other != AXIS_LIMIT)) | (before[rows] == AXIS_LIMIT) & ~free, other, NO_REASON)
            rows = rows[~free]
        tell(2, 3)
        if less:
            # Where limits and local gouge alone leave nothing, flutes by themselves find nothing.
            rows = rows[~np.isin(before[rows], (AXIS_LIMIT, LOCAL_GOUGE))]
            if limited or held:
                rows = rows[self._anywhere(less[-1][1], rows)]
            # Which of holder, shank and neck has to be away for there to be a posture, from the top down.
            for part, without in less[:-1]:
                served = self._anywhere(without, rows)
                reason[rows[served]] = part
                rows = rows[~served]
            reason[rows] = less[-1][0]
        tell(3, 3)
        return Explained(replace(verdicts, reason=reason), besides)

    @property
    def _alike(self) -> bool:
        """Whether all setups have the same obstacles, and leave the same samples."""
        first, mine = self.conditions[0].surroundings, self.machinable[0]
        return all(each.surroundings is first for each in self.conditions) and not any(
            (mine != each).any() for each in self.machinable
        )

    def _anywhere(self, cutter: Cutter, rows: NDArray[np.int64], *, limited: bool = True) -> NDArray[np.bool_]:
        """Whether a cutter has a posture in some setup that leaves the sample free; or would have, without axis limits."""
        served = np.zeros(len(rows), bool)
        for k, conditions in enumerate(self.conditions):
            open_ = self.machinable[k][rows] & ~served
            under, there = (f"setup {k}", conditions) if limited else (f"unlimited {k}", conditions.without_machine())
            served |= open_ & self._search(under, cutter, rows[open_], there).reached[rows]
        return served

    def _search(self, under: str, cutter: Cutter, rows: NDArray[np.int64], conditions: Conditions) -> Verdicts:
        """Search for postures of some samples, but where what was found for other cutters `under` the same tells."""
        verdicts, known = blank(len(self.asked)), self._known.setdefault(under, {})
        for other, earlier in known.items():
            # As `nesting.handed`, but of the samples that were looked at.
            if cutter == other:
                mine = rows[earlier.verdict[rows] != UNJUDGED]
            elif inside(cutter, other):
                mine = rows[earlier.reached[rows] & (verdicts.verdict[rows] == UNJUDGED)]
            elif inside(other, cutter):
                mine = rows[(earlier.verdict[rows] == INACCESSIBLE) & (verdicts.verdict[rows] == UNJUDGED)]
            else:
                continue
            verdicts.take(mine, earlier)
        open_rows = rows[verdicts.verdict[rows] == UNJUDGED]
        if len(open_rows):
            context = Context.of(cutter, conditions)
            search(contacts_of(self.samples), self.samples.face, open_rows, context, verdicts, fixed=True, brief=True)
        known[cutter] = verdicts.freeze()
        return known[cutter]


def _less(cutter: Cutter) -> Iterator[tuple[int, Cutter]]:
    """A cutter without its holder, without its shank as well, and without its neck, too: what there is of them."""
    parts = {part for part, _, _ in cutter.stages}
    if cutter.holder is not None:
        cutter = replace(cutter, holder=None)
        yield REASONS.index("holder"), cutter
    if cutter.shape == "lollipop":
        return  # the neck is what its ball hangs on
    top = flute_length(cutter)
    if "shank" in parts:
        flutes = top if cutter.necks and cutter.shape != "form" else None
        cutter = replace(cutter, length=top + cutter.neck_length, shank_radius=None, flutes=flutes)
        yield REASONS.index("shank"), cutter
    if cutter.necks:
        yield REASONS.index("neck"), replace(cutter, length=top, neck=None, flutes=None)


#: A reached sample is near the end of a strip within so many gaps of its face; its normal turns less than this cosine says.
_NEAR, _FACING = 2.0, 0.7
#: Strips are looked for up to so many times the width between planes: faces may bend.
_WIDER = 1.5
#: Share of the samples of a strip from which on a cutter enters the edge.
_ENTERS = 0.5
#: Samples in a corner are looked for so many times as far as they lie at most.
_BEYOND = 1.5
#: Cosine from which on a face is square to an edge that stands on it, and how far a sample may be off its level, in radii.
_SQUARE, _LEVEL = 0.9995, 0.02


def may_be_at_edge(verdicts: Verdicts, cutter: Cutter) -> bool:
    """Whether a sharp inside edge may lose a sample: where this is False for all cutters, no edge need be looked for."""
    return least_radius(cutter) is not None and bool(_losses(verdicts).any())


def strips(samples: SurfaceSamples, verdicts: Verdicts, cutter: Cutter, edges: Sequence[InsideEdge]) -> Ints:
    """Find the sharp inside edge that loses each sample: (n,) int32, place in `edges`, -1 where it is none of them."""
    result = np.full(len(samples), -1, np.int32)
    radius, losses, reached = least_radius(cutter), _losses(verdicts), np.flatnonzero(verdicts.reached)
    if radius is None or not losses.any() or not len(reached):
        return result
    tree, gaps = cKDTree(samples.point[reached]), dict(samples.face_gaps)
    rows_of = samples.by_face()
    for place, edge in enumerate(edges):
        if not any(number in rows_of and losses[rows_of[number]].any() for number in edge.faces):
            continue
        # At this distance from the edge a ball between two planes at its angle touches them.
        wide = np.where(edge.sharp, radius / np.tan(0.5 * edge.angle), np.nan)
        for side, number in enumerate(edge.faces):
            rows = rows_of.get(number)
            if rows is None or not losses[rows].any():
                continue
            whole = rows
            rows, at = _within(samples, whole, edge, side, radius, wide)
            if not len(rows) or verdicts.reached[rows].mean() > _ENTERS:
                continue
            open_rows = losses[rows] & (result[rows] < 0)
            mine, rows, at = rows, rows[open_rows], at[open_rows]
            close, beyond = _NEAR * gaps.get(number, 0.0), np.setdiff1d(whole, mine)
            served = _served(samples, reached, tree, edge, side, wide, close, beyond[verdicts.not_reached[beyond]])
            result[rows[served[at]]] = place
    if cutter.shape == "end" and not cutter.taper and not cutter.corner_radius:
        near = {number: _NEAR * gaps.get(number, 0.0) for number in rows_of}
        remaining = np.flatnonzero(losses & (result < 0))
        nearby = cKDTree(samples.point[remaining])
        for place, edge in enumerate(edges):
            for end in (0, -1):
                # Between both faces the disk that touches them is no farther from the corner than this.
                far = _BEYOND * radius / float(np.sin(0.5 * edge.angle[end]))
                if not np.isfinite(far):
                    continue
                rows = remaining[nearby.query_ball_point(edge.point[end], far, return_sorted=True)]
                result[_corner(samples, rows[result[rows] < 0], edge, end, radius, reached, tree, near)] = place
    return result


def with_sharp_edges(verdicts: Verdicts, at_edge: Ints) -> Verdicts:
    """The verdicts with the reason SHARP_EDGE where a sharp inside edge loses the sample; `at_edge` (n,) as `strips` gives it."""
    if (at_edge < 0).all():
        return verdicts
    return replace(verdicts, reason=np.where(at_edge >= 0, SHARP_EDGE, verdicts.reason).astype(np.uint8))


def exempt(reaches: Mapping[Cutter, Verdicts], inside: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Find the samples (n,) that no cutter reaches, and which a sharp inside edge loses for the finest of them.

    What is undecided of any cutter is not among them: it may be reached.

    `reaches`: of each cutter the verdicts over all setups, with the reason SHARP_EDGE where it applies. `inside` (n,) bool:
    samples inside other bodies of the part: they are none of these.
    """
    finest = min(reaches, key=lambda cutter: (least_radius(cutter) or np.inf, cutter.radius))
    blocked = np.logical_and.reduce([verdicts.verdict == INACCESSIBLE for verdicts in reaches.values()])
    return np.asarray(blocked & ~inside & (reaches[finest].reason == SHARP_EDGE))


def _losses(verdicts: Verdicts) -> NDArray[np.bool_]:
    """Samples (n,) that are not reached, for one of the reasons behind which a sharp inside edge may be."""
    return np.asarray(verdicts.not_reached & np.isin(verdicts.reason, _AT_EDGES))


def _within(
    samples: SurfaceSamples, rows: NDArray[np.int64], edge: InsideEdge, side: int, radius: float, wide: Floats
) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Rows of a face's samples at which the ball reaches into the other face, and the point of the edge next to each."""
    line = cKDTree(edge.point)
    step = np.linalg.norm(np.diff(edge.point, axis=0), axis=1).max(initial=0.0)
    away, at = line.query(samples.point[rows], distance_upper_bound=_WIDER * float(np.nanmax(wide)) + step)
    near = np.isfinite(away)
    rows, at = rows[near], at[near]
    other = 1 - side
    # Along the edge the foot is as near as its points are: what lies along it does not count.
    v = samples.point[rows] + radius * samples.normal[rows] - edge.point[at]
    normal, inward = edge.normal[other, at], edge.inward[other, at]
    along = (v * inward).sum(axis=1)
    height = (v * normal).sum(axis=1) - 0.5 * edge.curvature[other, at] * along**2
    out = (samples.point[rows] - edge.point[at]) * edge.inward[side, at]
    mine = edge.sharp[at] & (height < radius) & (along > 0.0) & (out.sum(axis=1) <= _WIDER * wide[at])
    return rows[mine], at[mine]


def _corner(
    samples: SurfaceSamples, rows: NDArray[np.int64], edge: InsideEdge, end: int, radius: float,
    reached: NDArray[np.int64], tree: cKDTree, near: Mapping[int, float],
) -> NDArray[np.int64]:  # fmt: skip
    """Of lost samples those of a third face in the corner at an end (0 or -1) of an edge, which a disk between its faces leaves.

    They lie nearer to the corner along both faces than where the disk touches these, and farther from its centre than its radius.
    """
    wide = radius / float(np.tan(0.5 * edge.angle[end]))
    if not len(rows) or len(edge.point) < 2 or not edge.sharp[end] or not np.isfinite(wide):
        return rows[:0]
    corner, along = edge.point[end], edge.point[end] - edge.point[1 if end == 0 else -2]
    along = along / max(1e-300, float(np.linalg.norm(along)))
    normal, inward = edge.normal[:, end], edge.inward[:, end]
    centre = radius * normal.sum(axis=0) / (1.0 + float(normal[0] @ normal[1]))
    # The third face is square to the edge and faces along it: the cutter stands on it with its axis along the edge.
    away = samples.point[rows] - corner
    high = away @ along
    flat = away - np.outer(high, along)
    mine = (
        ~np.isin(samples.face[rows], edge.faces) & (samples.normal[rows] @ -along > _SQUARE) & (np.abs(high) <= _LEVEL * radius)
    )
    mine &= (np.linalg.norm(flat - centre, axis=1) > radius) & (flat @ inward.T < wide).all(axis=1)
    mine &= (flat @ normal.T > -_LEVEL * radius).all(axis=1)
    for number in np.unique(samples.face[rows[mine]]).tolist():
        # Where a fillet of its radius stood the cutter would work beside it.
        nearby = reached[tree.query_ball_point(corner + centre, radius + near[number])]
        if not (samples.face[nearby] == number).any():
            mine &= samples.face[rows] != number
    return rows[mine]


def _served(
    samples: SurfaceSamples, reached: NDArray[np.int64], tree: cKDTree, edge: InsideEdge, side: int, wide: Floats, near: float,
    blocked: NDArray[np.int64],
) -> NDArray[np.bool_]:  # fmt: skip
    """Points (k,) of an edge beside which, or no farther along it than a strip is wide, the cutter reaches the surface where the
    ball touches both faces, and nearer than any sample of the face that it does not reach beyond the strip (`blocked`).
    """
    served, sharp = np.zeros(len(wide), bool), np.flatnonzero(edge.sharp)
    rise = 0.5 * edge.curvature[side, sharp] * wide[sharp] ** 2
    place = edge.point[sharp] + wide[sharp, None] * edge.inward[side, sharp] + rise[:, None] * edge.normal[side, sharp]
    far = np.minimum(near, cKDTree(samples.point[blocked]).query(place)[0]) if len(blocked) else np.full(len(place), near)
    for k, at, rows in zip(sharp.tolist(), place, tree.query_ball_point(place, far), strict=True):
        mine, normal = reached[rows], edge.normal[side, k]
        # Another wall that faces the same way, above an undercut, is not what the ball touches.
        on = (samples.face[mine] == edge.faces[side]) | (np.abs((samples.point[mine] - at) @ normal) <= _LEVEL * wide[k])
        served[k] = bool((on & (samples.normal[mine] @ normal > _FACING)).any())
    if not served.any():
        return served
    # Where edges meet, strips cross: there the place lies in the strip of another edge.
    away = cKDTree(edge.point[served]).query(edge.point)[0]
    return np.asarray(edge.sharp & (away <= wide + near))
