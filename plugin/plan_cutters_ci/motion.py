"""A part that was mirrored, moved or turned as a whole: its faces are the old ones, at other places.

Turns by right angles and mirrors at planes across an axis are looked for, each with a shift: they carry the middle of a face's
box onto that of its image. Other turns are not looked for.
"""

import math
from collections import defaultdict
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import permutations, product

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from plan_cutters.plan_file.frozen import Vector, vector
from plan_cutters.plan_file.model import FaceEntry
from plan_cutters.plan_file.numbers import angle, direction, mm, place, unit
from plan_cutters_ci.carriers import opposed

#: Places and logarithms of areas agree within this, as of faces that did not move.
_SAME = 1e-5
#: Fewer faces than this do not tell a motion from a chance; so many of all must agree.
_LEAST, _MOST_OF_ALL = 6, 0.6
#: Faces from which a motion is looked for, and images of each that are tried.
_ANCHORS, _IMAGES = 3, 24
#: Faces that are looked at first, and the share of them that must agree before all are looked at.
_SOME, _ENOUGH = 40, 0.45
_AXES = "xyz"


@dataclass(frozen=True, eq=False)
class PlanMotion:
    """Point x of the old part becomes `linear @ x + shift`.

    Attributes
    ----------
    linear : (3, 3) float
        A turn by right angles, or a mirror.
    shift : (3,) float
        mm.
    carried : int
        How many faces of the old part it carries onto faces of the new one.
    """

    linear: NDArray[np.float64]
    shift: NDArray[np.float64]
    carried: int = 0

    def face(self, face: FaceEntry) -> FaceEntry:
        """A face of the old part where it comes to lie."""
        carrier = face.carrier
        if carrier is not None:
            point, way = np.asarray(self._point(carrier.point_mm)), carrier.direction
            if way is not None:
                way = vector(self.linear @ way)
            along = np.zeros(3) if way is None else (point @ way) * np.asarray(way)
            if face.shape == "plane":
                point = along
            elif face.shape == "cylinder":
                point = point - along
            carrier = carrier.model_copy(update={"point_mm": vector(point), "direction": way})
        centre = None if face.centre_mm is None else self._point(face.centre_mm)
        return face.model_copy(update={"centre_mm": centre, "carrier": carrier})

    def _point(self, point: Vector) -> Vector:
        return vector(self.linear @ point + self.shift)

    @property
    def text(self) -> str:
        """Say what was done to the part.

        >>> PlanMotion(np.eye(3), np.array([0.0, 2.5, 0.0])).text
        'moved by (0, 2.5, 0) mm'
        >>> PlanMotion(np.diag([-1.0, 1.0, 1.0]), np.array([10.0, 0.0, 0.0])).text
        'mirrored at the plane x = 5 mm'
        >>> PlanMotion(np.diag([-1.0, -1.0, 1.0]), np.array([4.0, 0.0, 3.0])).text
        'turned by 180° about a line along z, and moved by (0, 0, 3) mm'
        """
        trace = float(np.trace(self.linear))
        if np.linalg.det(self.linear) < 0.0:
            axis = int(np.argmin(np.diag(self.linear)))
            rest = np.where(np.arange(3) == axis, 0.0, self.shift)
            return f"mirrored at the plane {_AXES[axis]} = {mm(0.5 * self.shift[axis], 4)}{self._and(rest)}"
        if trace > 2.5:
            return _moved_by(self.shift)
        turn = round(math.degrees(math.acos(max(-1.0, min(1.0, 0.5 * (trace - 1.0))))))
        skew = self.linear - self.linear.T
        axis_of = np.array([skew[2, 1], skew[0, 2], skew[1, 0]])
        if turn == 180:
            values, vectors = np.linalg.eigh(self.linear)
            axis_of = vectors[:, int(values.argmax())]
        axis_of = axis_of / np.abs(axis_of).max()
        along = (self.shift @ axis_of) * axis_of / (axis_of @ axis_of)
        one = np.count_nonzero(np.abs(axis_of) > 0.5) == 1
        sign = "" if turn == 180 or not one or axis_of.sum() > 0.0 else "-"
        line = f"{sign}{_AXES[int(np.abs(axis_of).argmax())]}" if one else f"({direction(axis_of)})"
        return f"turned by {angle(turn)} about a line along {line}{self._and(along)}"

    def _and(self, shift: NDArray[np.float64]) -> str:
        return f", and {_moved_by(shift)}" if np.abs(shift).max() > 1e-6 * (1.0 + np.abs(self.shift).max()) else ""


def motions_of(old: Sequence[FaceEntry], new: Sequence[FaceEntry], size: float) -> list[PlanMotion]:
    """The motions that carry most faces of an old part onto those of the new one; none where none carries enough of them.

    Several carry as many where the part is its own image: a shift comes first, then turns, then mirrors. Of faces that are no
    simple shape, middles and areas alone are compared, so that one of several may be the wrong one.
    """
    mine, theirs = ([f for f in faces if f.centre_mm is not None and 0.0 < f.area_mm2 < math.inf] for faces in (old, new))
    least = max(_LEAST, _MOST_OF_ALL * max(len(old), len(new)))
    if min(len(mine), len(theirs)) < least or not any(f.carrier for f in mine) or not any(f.carrier for f in theirs):
        return []
    forms = {shape: k for k, shape in enumerate(sorted({f.shape for f in (*mine, *theirs)}))}
    here, there = (_rows(faces, forms) for faces in (mine, theirs))
    tree = cKDTree(there / [size, size, size, 1.0, 1.0])
    starts = list(_starts(here, there))
    best = list[PlanMotion]()
    some = np.unique(np.linspace(0, len(mine) - 1, _SOME).astype(int))
    for linear in _linears():
        tried = set[tuple[float, ...]]()
        for i, images in starts:
            for shift in there[images, :3] - linear @ here[i, :3]:
                key = tuple(np.round(shift / (10.0 * _SAME * size)).tolist())
                if key in tried or (np.array_equal(linear, np.eye(3)) and np.linalg.norm(shift) <= _SAME * size):
                    continue
                tried.add(key)
                if _agreeing(tree, here[some], linear, shift, size)[0].mean() < _ENOUGH:
                    continue
                near, rows = _agreeing(tree, here, linear, shift, size)
                motion = PlanMotion(linear, np.where(np.abs(shift) <= _SAME * size, 0.0, shift))
                pairs = {(i, int(rows[i])) for i in np.flatnonzero(near) if not opposed(motion.face(mine[i]), theirs[rows[i]])}
                carried = min(len(pairs), len({j for _, j in pairs}))
                if carried >= max(least, best[0].carried if best else 0):
                    best = [each for each in best if each.carried == carried]
                    best.append(PlanMotion(motion.linear, motion.shift, carried))
    return best


def _agreeing(
    tree: cKDTree, here: NDArray[np.float64], linear: NDArray[np.float64], shift: NDArray[np.float64], size: float
) -> tuple[NDArray[np.bool_], NDArray[np.int64]]:
    """Which faces are carried onto one of their form and area, and onto which."""
    moved = np.column_stack([(here[:, :3] @ linear.T + shift) / size, here[:, 3:]])
    off, rows = tree.query(moved, distance_upper_bound=_SAME)
    return np.isfinite(off), rows


def _rows(faces: Sequence[FaceEntry], forms: dict[str, int]) -> NDArray[np.float64]:
    """Rows (n, 5): places, mm, logarithms of areas, and numbers of forms."""
    return np.array([[*(f.centre_mm or ()), math.log(f.area_mm2), forms[f.shape]] for f in faces])


def _starts(here: NDArray[np.float64], there: NDArray[np.float64]) -> Iterator[tuple[int, NDArray[np.int64]]]:
    """Faces with the fewest possible images, and these; the largest first."""
    every = []
    for i, (*_, area, form) in enumerate(here):
        images = np.flatnonzero((np.abs(there[:, 3] - area) <= _SAME) & (there[:, 4] == form))
        if 0 < len(images) <= _IMAGES:
            every.append((len(images), -area, i, images))
    by_count = defaultdict(list)
    for each in every:
        by_count[each[0]].append(each)
    chosen = [each for count in sorted(by_count) for each in sorted(by_count[count], key=lambda e: e[1:3])]
    yield from ((i, images) for _, _, i, images in chosen[:_ANCHORS])


def _linears() -> Iterator[NDArray[np.float64]]:
    """No turn, then the 23 turns by right angles, then the three mirrors."""
    turns = []
    for order in permutations(range(3)):
        for signs in product((1.0, -1.0), repeat=3):
            linear = np.zeros((3, 3))
            linear[range(3), order] = signs
            if np.linalg.det(linear) > 0.0:
                turns.append(linear)
    yield from sorted(turns, key=lambda each: -np.trace(each))
    yield from (np.diag(row) for row in ([-1.0, 1.0, 1.0], [1.0, -1.0, 1.0], [1.0, 1.0, -1.0]))


def _moved_by(shift: NDArray[np.float64]) -> str:
    return f"moved by ({place(shift.tolist())}) {unit()}"
