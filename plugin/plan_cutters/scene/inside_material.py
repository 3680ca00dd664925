"""Does a contact lie within material? Under a body that stands on the surface, or on the wall of a void, no posture helps.

At every tilt from 0 to 90 deg the point at a small distance `d` from the contact along the normal lies in the cutter, at its
edge: `P + d n = P - d sin(tilt) x_T + d cos(tilt) a`. If a ball of radius r about it is all material, the cutter holds points
of that ball which are deeper in it than r / sqrt(2). So one test a contact settles all its postures
(Lemma F3 of `docs/proofs.md`).
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from cad_io.arrays import Floats, Ints, Orientation, Record, SurfaceSamples
from cad_io.part.bodies import Body
from plan_cutters.kernels.codes import AWAY, BALL
from plan_cutters.scene.obstacles import Obstacles
from plan_cutters.scene.work import in_chunks


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
    boxed = SortedPoints.of(point, np.flatnonzero(open_rows))
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
        rows = boxed.within(vertex.min(axis=(0, 1)), vertex.max(axis=(0, 1)))
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


class SortedPoints(NamedTuple):
    """Points along the axis on which they spread most, so that each of many boxes looks at few of them."""

    point: Floats
    axis: int
    row: NDArray[np.int64]
    at: Floats

    @classmethod
    def of(cls, point: Floats, rows: NDArray[np.int64]) -> "SortedPoints":
        """Some rows (k,) of finite points (n, 3)."""
        axis = int(np.ptp(point[rows], axis=0).argmax()) if len(rows) else 0
        row = rows[np.argsort(point[rows, axis], kind="stable")]
        return cls(point, axis, row, point[row, axis])

    def within(self, low: Floats, high: Floats) -> NDArray[np.int64]:
        """Rows, ascending, of the points in a box with its border."""
        first, last = self.at.searchsorted(low[self.axis], "left"), self.at.searchsorted(high[self.axis], "right")
        rows = self.row[first:last]
        return np.sort(rows[((self.point[rows] >= low) & (self.point[rows] <= high)).all(axis=1)])


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
    rows = _met(point, normal, certain)
    face = certain.faces[rows]
    weight = certain.weight[certain.order[rows]]
    if body is not None:
        mine = np.isin(face, body.faces)
        rows, face, weight = rows[mine], face[mine], weight[mine]
        if min(body.faces) > 0:
            # A fixture is one body whatever it consists of, and its triangles know what they count.
            sign = dict(zip(body.faces, body.sign, strict=True))
            weight = np.array([sign[n] for n in face.tolist()], np.int8)
    vertex = certain.triangles.vertex[certain.order[rows]]
    a, b, c = vertex[:, 0] - point, vertex[:, 1] - point, vertex[:, 2] - point
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
    return Cover(int(face[first]), point + along[first] * normal)


def _met(point: Floats, normal: Floats, certain: Obstacles) -> NDArray[np.int64]:
    """Triangles, in tree order, in whose leaves' boxes a ray comes."""
    tree, met = certain.tree, [np.zeros(0, np.int64)]
    for first, count, boxes, depth in (
        (0, len(tree.vertex), tree.box, tree.depth),
        (len(tree.vertex), len(tree.more_vertex), tree.more_box, tree.more_depth),
    ):
        if count:
            leaf = _leaves_met(point, normal, boxes, depth)
            met += [first + np.arange((count * i) >> depth, (count * (i + 1)) >> depth) for i in leaf.tolist()]
    return np.concatenate(met)


def _leaves_met(point: Floats, normal: Floats, boxes: Floats, depth: int) -> NDArray[np.int64]:
    """Leaves of a tree, ascending, in whose boxes a ray comes."""
    node = np.zeros(1, np.int64)
    for level in range(depth + 1):
        box = boxes[node]
        axes, half = box[:, 3:12].reshape(-1, 3, 3), box[:, 12:15]
        start, step = np.einsum("nki,ni->nk", axes, point - box[:, :3]), axes @ normal
        with np.errstate(all="ignore"):
            ends = np.stack([(-half - start) / step, (half - start) / step])
        # Along a side of the box, the ray is between its ends all the way, or never.
        adjacent = step == 0.0
        low = np.where(adjacent, -np.inf, ends.min(axis=0)).max(axis=1)
        high = np.where(adjacent, np.inf, ends.max(axis=0)).min(axis=1)
        hit = ~(adjacent & (np.abs(start) > half)).any(axis=1) & (high >= np.maximum(low, 0.0) - 1e-9)
        node = node[hit]
        if level < depth:
            node = np.concatenate([2 * node + 1, 2 * node + 2])
    return np.sort(node) - ((1 << depth) - 1)
