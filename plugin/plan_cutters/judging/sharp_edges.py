"""Which samples are lost to a sharp inside edge? Beside one, a round cutter leaves a fillet whatever its posture.

No verdict is changed: a reason gets another name. A sample of a face A is lost to its edge with a face B where all of this holds:

- it is not reached, for rear gouge or collision (local gouge is the curvature of A itself);
- the ball of the cutter's least radius that touches A there reaches into B as that runs on from the edge, its curvature across
  the edge included: between planes that is nearer to the edge than r / tan(angle / 2);
- farther from the edge the cutter does its work: it reaches a sample near the place where the ball touches both faces. In a
  slot that is too narrow for the cutter it does not;
- the cutter does not enter the edge: it reaches less than half of the samples that near. A flat end does, between wall and floor.

Where such an edge stands on a third face, as that of two walls on a floor, a flat end leaves the corner of the third face, too:
what lies beyond the disk of its radius that touches both walls. A sample there is lost to the edge if the cutter reaches the
third face beside that disk.

A sample counts as it is: no spacing is added to the width.
"""

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from cad_io.arrays import Floats, Ints, SurfaceSamples
from cad_io.part.edges import InsideEdge
from plan_cutters.domain.cutter import Cutter
from plan_cutters.domain.standard_tools import least_radius
from plan_cutters.domain.verdicts import COLLISION, INACCESSIBLE, REAR_GOUGE, SHARP_EDGE, Verdicts

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
    """Find the sharp inside edge that loses each sample.

    Parameters
    ----------
    samples : SurfaceSamples
    verdicts : Verdicts
    cutter : Cutter
    edges : sequence of InsideEdge

    Returns
    -------
    (n,) int32
        Place in `edges`, -1 where it is none of them.
    """
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
            rows, at = _within(samples, rows, edge, side, radius, wide)
            if not len(rows) or verdicts.reached[rows].mean() > _ENTERS:
                continue
            open_rows = losses[rows] & (result[rows] < 0)
            rows, at = rows[open_rows], at[open_rows]
            served = _served(samples, reached, tree, edge, side, wide, _NEAR * gaps.get(number, 0.0))
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

    Parameters
    ----------
    reaches : dict
        Of each cutter the verdicts over all setups, with the reason SHARP_EDGE where it applies.
    inside : (n,) bool
        Samples inside other bodies of the part: they are none of these.
    """
    finest = min(reaches, key=lambda cutter: (least_radius(cutter) or np.inf, cutter.radius))
    blocked = np.logical_and.reduce([verdicts.verdict == INACCESSIBLE for verdicts in reaches.values()])
    return np.asarray(blocked & ~inside & (reaches[finest].reason == SHARP_EDGE))


def _losses(verdicts: Verdicts) -> NDArray[np.bool_]:
    """Samples (n,) that are not reached, for one of the reasons behind which a sharp inside edge may be."""
    return np.asarray(verdicts.not_reached & np.isin(verdicts.reason, (REAR_GOUGE, COLLISION)))


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
    samples: SurfaceSamples, reached: NDArray[np.int64], tree: cKDTree, edge: InsideEdge, side: int, wide: Floats, near: float
) -> NDArray[np.bool_]:
    """Points (k,) of an edge beside which, or no farther along it than a strip is wide, the cutter reaches the surface where the
    ball touches both faces.
    """
    served, sharp = np.zeros(len(wide), bool), np.flatnonzero(edge.sharp)
    rise = 0.5 * edge.curvature[side, sharp] * wide[sharp] ** 2
    place = edge.point[sharp] + wide[sharp, None] * edge.inward[side, sharp] + rise[:, None] * edge.normal[side, sharp]
    for k, rows in zip(sharp.tolist(), tree.query_ball_point(place, near), strict=True):
        served[k] = bool(rows) and bool((samples.normal[reached[rows]] @ edge.normal[side, k] > _FACING).any())
    if not served.any():
        return served
    # Where edges meet, strips cross: there the place lies in the strip of another edge.
    away = cKDTree(edge.point[served]).query(edge.point)[0]
    return np.asarray(edge.sharp & (away <= wide + near))
