"""Does a contact lie within material? Under a body that stands on the surface, or on the wall of a void, no posture helps.

At every tilt from 0 to 90 deg the point at a small distance `d` from the contact along the normal lies in the cutter, at its
edge: `P + d n = P - d sin(tilt) x_T + d cos(tilt) a`. If a ball of radius r about it is all material, the cutter holds points
of that ball which are deeper in it than r / sqrt(2). So one test a contact settles all its postures
(Lemma F3 of `docs/proofs.md`).
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from cad_io.arrays import Floats, Ints, Orientation, Record, SurfaceSamples
from cad_io.part.bodies import Body
from plan_cutters.domain.placement import frame_of
from plan_cutters.kernels.codes import AWAY, BALL
from plan_cutters.scene.obstacles import Obstacles
from plan_cutters.scene.work import in_chunks

#: A way out misses triangles that are farther from it, mm.
_NEAR = 1e-9


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Cover(Record):
    """A contact inside material lies under this face."""

    face: int  #: Number of the face at which the way out along the normal leaves the body.
    point: Floats  #: (3,) float: where that is, mm.


def inside_material(
    samples: SurfaceSamples, orientation: Orientation, bodies: Sequence[Body], certain: Obstacles, tolerance: float,
    jobs: int = 1, known: Ints | None = None,
) -> Ints:  # fmt: skip
    """In which body contacts lie so deep that every posture is blocked.

    Returns (n,) int32: index into `bodies`, -1 where there is none. Where a contact lies in the void of a body and in no material
    besides, that void (`voids`).

    `orientation`: side of each face. `tolerance`: gouge tolerance that is kept, mm. `jobs`: threads. `known` (n,) int32: the same
    of another setup: the part has the same bodies there, the first of all, and fixtures alone are looked at again.
    """
    _, deep = certain.depths(tolerance)
    point = samples.point + AWAY * deep * samples.normal
    open_rows = (samples.unjudged < 0) & np.isfinite(point).all(axis=1)
    result, hollow = np.full(len(samples), -1, np.int32), voids(bodies, orientation)
    # Every void lies in one more body than there is material.
    layers, void = np.zeros(len(samples), np.int32), np.full(len(samples), -1, np.int32)
    loose = dict(certain.triangles.loose).keys()
    of_part = sum(min(body.faces) > 0 for body in bodies)
    # What lies in a void is known of all bodies together.
    again = of_part if known is not None and not hollow.any() else 0
    if known is not None and again:
        result = np.where(known < again, known, -1).astype(np.int32)
    for index, body in list(enumerate(bodies))[again:]:
        sure = body.closed and loose.isdisjoint(body.faces)
        vertex = certain.triangles.vertex[certain.rows_of(body.faces)] if sure else np.zeros((0, 3, 3))
        if not len(vertex):
            continue
        low, high = vertex.min(axis=(0, 1)), vertex.max(axis=(0, 1))
        rows = np.flatnonzero(open_rows & ((point >= low) & (point <= high)).all(axis=1))
        # A contact on the outer side of a skin is not within that.
        outer = [n for n, side in zip(body.faces, body.sign, strict=True) if n > 0 and orientation.sign[n - 1] == side]
        rows = rows[~np.isin(samples.face[rows], outer)]
        if not hollow.any():
            rows = rows[result[rows] < 0]
        if len(rows):
            inside = balls_inside(point[rows], BALL * deep, certain.skin_of(body), jobs)
            if hollow[index]:
                # In a corner of a void a ball is not all within it, but what lies on its wall looks into it.
                inside |= np.isin(samples.face[rows], body.faces)
                void[rows[inside]] = index
            layers[rows[inside]] += -1 if hollow[index] else 1
            if not hollow[index]:
                result[rows[inside & (result[rows] < 0)]] = index
    empty = (result >= 0) & (layers <= 0) & (void >= 0)
    result[empty] = void[empty]
    return result


def balls_inside(points: Floats, radius: float, obstacles: Obstacles, jobs: int) -> NDArray[np.bool_]:
    """Whether balls about points (n, 3), `radius` in mm, lie wholly inside what the obstacles enclose: (n,)."""
    from plan_cutters.kernels.material import far_inside

    inside, solids = np.zeros(len(points), bool), obstacles.solids

    def work(rows: NDArray[np.int64]) -> None:
        mine = np.zeros(len(rows), bool)
        far_inside(np.ascontiguousarray(points[rows]), radius, solids, mine)
        inside[rows] = mine

    in_chunks(work, np.arange(len(points)), jobs)
    return inside


def voids(bodies: Sequence[Body], orientation: Orientation) -> NDArray[np.bool_]:
    """Which bodies (m,) are voids: the material is on the outer side of all their faces."""
    return np.array(
        [all(n > 0 and orientation.sign[n - 1] == -side for n, side in zip(b.faces, b.sign, strict=True)) for b in bodies], bool
    )


def inside_bodies(within: Ints, bodies: Sequence[Body], orientation: Orientation) -> NDArray[np.bool_]:
    """Find the samples (n,) that lie inside another body of the part: they are no surface of the finished part.

    The wall of a void is one, though no cutter gets there.

    `within` (n,) int32: as `inside_material` gives it. `bodies`: of the part, without fixtures.
    """
    mine = (within >= 0) & (within < len(bodies))
    if mine.any():
        mine[mine] = ~voids(bodies, orientation)[within[mine]]
    mine.setflags(write=False)
    return mine


def cover(point: Floats, normal: Floats, certain: Obstacles, body: Body | None = None) -> Cover | None:
    """Where the way out of a body along a normal (3,) leads from a contact (3,); None if it meets no skin.

    Without a body, that of all that encloses something.
    """
    # In the order of the tree, which decides between faces that a ray leaves through their common edge.
    rows = np.arange(len(certain.faces)) if body is None else np.flatnonzero(np.isin(certain.faces, body.faces))
    vertex = certain.triangles.vertex[certain.order[rows]] - point
    seen = vertex @ frame_of(normal)[:2].T
    on_way = ((seen.min(axis=1) <= _NEAR) & (seen.max(axis=1) >= -_NEAR)).all(axis=1)
    rows, (a, b, c) = rows[on_way], np.moveaxis(vertex[on_way], 1, 0)
    weight = certain.weight[certain.order[rows]]
    if body is not None and min(body.faces) > 0:
        # A fixture is one body whatever it consists of, and its triangles know what they count.
        sign = dict(zip(body.faces, body.sign, strict=True))
        weight = np.array([sign[n] for n in certain.faces[rows].tolist()], np.int8)
    # Signed volumes tell on which side of each edge the ray passes; the corners' sense does not matter.
    sides = np.stack([np.cross(q, r) @ normal for q, r in ((a, b), (b, c), (c, a))])
    area = np.cross(b - a, c - a)
    with np.errstate(all="ignore"):
        along = (area * a).sum(axis=1) / (area @ normal)
    leaving = ((sides >= 0).all(axis=0) | (sides <= 0).all(axis=0)) & (np.sign(area @ normal) * weight > 0)
    leaving &= np.isfinite(along) & (along > 0)
    if not leaving.any():
        return None
    first = int(np.where(leaving, along, np.inf).argmin())
    return Cover(int(certain.faces[rows[first]]), point + along[first] * normal)
