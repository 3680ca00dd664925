"""Orientations that are repeated about an axis: one of them, and its images, stand for one step.

The axis is that of a pattern of the whole part, or of a part that nearly is one: then each image is tested on its own samples all
the same, for nothing follows from a symmetry that is not exact. So a plan of repeated steps is made of ordinary operations
(`docs/operations_proof.md`, lemma P3).
"""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from cad_io.arrays import Floats, SurfaceSamples
from cad_io.part.equal_faces import Motion
from cad_io.part.patterns import Pattern
from plan_cutters.domain.operations import Columns
from plan_cutters.operations.orientations import Orientations

#: Orders of a symmetry that are looked for, the share of the area that must agree, how well normals must, rad, and how many
#: samples near to a place are looked at.
_ORDERS, _AGREES, _NORMAL, _NEAR = range(3, 61), 0.98, math.radians(10.0), 8
#: A sample lies on a surface of revolution where its normal is off its meridian by less, and a face where so much of it does.
_OFF, _MOST = 0.02, 0.95
#: Least share of the area beside such faces: a part without more is a part of revolution, and needs no pattern.
_OTHERS = 0.02
#: Samples that are compared, at most, every so-manieth first; a turn must carry them so many gaps away.
_COMPARED, _EVERY, _GAPS = 20_000, 32, 2.0
#: Axes that differ by less are one.
_ONE = 1e-6


@dataclass(frozen=True, slots=True, eq=False)
class Symmetry:
    """Turns about an axis under which orientations are repeated.

    `place`, `direction` (3,) float: the axis. `order`: how many turns make a whole one. `exact`: whether the part is a pattern;
    else its samples nearly are. `orientations`: of each setup.
    """

    place: Floats
    direction: Floats
    order: int
    exact: bool
    orientations: tuple[Orientations, ...]

    def images(self, columns: Columns) -> Columns:
        """Each column, followed by its `order` - 1 images; where the machine cannot turn to one, the column stands for it."""
        n, m = self.order, len(columns)
        axis, angle = np.repeat(columns.axis, n, axis=0), np.repeat(columns.angle, n, axis=0)
        for k in range(1, n):
            for s in np.unique(columns.setup).tolist():
                mine = np.flatnonzero(columns.setup == s)
                # One rotary axis alone is turned, or it is not repeated: other angles each time would be other steps.
                angles, axes, held = self.orientations[s].turned(columns.angle[mine], self.direction, 2.0 * math.pi * k / n)
                # Along the axis all images are one.
                held &= np.linalg.norm(axes - columns.axis[mine], axis=1) > _ONE
                at = mine[held] * n + k
                axis[at], angle[at] = axes[held], angles[held]
        which = np.repeat(np.arange(m), n)
        return Columns(columns.cutter[which], columns.setup[which], axis, angle)

    def sector(self, vector: Floats) -> NDArray[np.int64]:
        """Numbers of the vectors (m, 3) that lie in the first sector about the axis: the images of these are all."""
        # Rounding of an axis does not choose where the sectors begin.
        x = np.cross(self.direction, np.eye(3)[int(np.round(np.abs(self.direction), 6).argmin())])
        x /= np.linalg.norm(x)
        along, across = vector @ x, vector @ np.cross(self.direction, x)
        azimuth = np.remainder(np.arctan2(across, along), 2.0 * math.pi)
        return np.flatnonzero((azimuth < 2.0 * math.pi / self.order) | (np.hypot(along, across) < 1e-9))


def symmetry_of(
    samples: SurfaceSamples, patterns: Sequence[Pattern], orientations: tuple[Orientations, ...], machinable: NDArray[np.bool_]
) -> Symmetry | None:
    """The rotation under which orientations may be repeated, of the highest order; None where there is none.

    In some setup its axis is that of the rotary axis next to the part.
    """
    for each in patterns:
        axis = each.motions[0].axis if each.kind == "rotation" and each.whole and each.order in _ORDERS else None
        if axis is not None and _turns(orientations, axis[1]):
            return Symmetry(*axis, each.order, True, orientations)
    rows = np.flatnonzero(machinable & (samples.unjudged < 0))
    for place, direction in _axes(samples, rows):
        order = _near_order(samples, rows, place, direction) if _turns(orientations, direction) else 1
        if order > 1:
            return Symmetry(place, direction, order, False, orientations)
    return None


def _turns(orientations: Sequence[Orientations], direction: Floats) -> bool:
    """Whether the part is turned about a direction by the rotary axis next to it in some setup."""
    return any(each.along(direction) for each in orientations)


def _axes(samples: SurfaceSamples, rows: NDArray[np.int64]) -> Iterator[tuple[Floats, Floats]]:
    """Axes about which faces are turned: the normal of each of their samples meets it. The one with most area."""
    faces = samples.face[rows]
    area = np.nan_to_num(samples.area[rows])
    size = np.bincount(faces, area)
    lines = list[tuple[float, Floats, Floats]]()
    for number in np.argsort(-size, kind="stable")[:40].tolist():
        mine = rows[faces == number]
        if len(mine) < 12:
            continue
        line = _axis_of_normals(samples.point[mine], samples.normal[mine])
        if line is not None:
            lines.append((float(size[number]), *line))
    gathered = list[tuple[float, Floats, Floats]]()
    for own, place, direction in lines:
        total = own
        for other, place_, direction_ in lines:
            away = place_ - place
            off = np.linalg.norm(away - (away @ direction) * direction)
            if other is not own and abs(direction @ direction_) > 1.0 - 1e-6 and off < 1e-3 * math.sqrt(max(own, other)):
                total += other
        gathered.append((total, place, direction))
    for _, place, direction in sorted(gathered, key=lambda each: -each[0])[:1]:
        yield place, direction


def _axis_of_normals(point: Floats, normal: Floats) -> tuple[Floats, Floats] | None:
    """The line that the normals of a surface of revolution meet; None of a plane, a sphere, or any other surface."""
    middle = point.mean(axis=0)
    scale = float(np.linalg.norm(point - middle, axis=1).max()) or 1.0
    # A line with direction d and moment m meets a normal n at p where d . (p x n) + m . n = 0.
    table = np.concatenate([np.cross((point - middle) / scale, normal), normal], axis=1)
    values, vectors = np.linalg.svd(table, full_matrices=False)[1:]
    small = values < 1e-3 * math.sqrt(len(point))
    if len(values) < 6 or not 1 <= small.sum() <= 2:
        return None
    # All normals of a cylinder are square to its axis as well: what leans least on that alone is taken.
    null = vectors[small]
    line = np.linalg.svd(null[:, :3])[0][:, 0] @ null
    length = float(np.linalg.norm(line[:3]))
    if length < 1e-3:
        return None
    line = line / (length * (1.0 if line[:3][np.abs(line[:3]).argmax()] > 0.0 else -1.0))
    direction, moment = line[:3], line[3:]
    if len(null) == 2:
        moment = moment - (moment @ direction) * direction
    elif abs(direction @ moment) > 1e-3:
        return None
    return middle + scale * np.cross(direction, moment), direction


def _near_order(samples: SurfaceSamples, rows: NDArray[np.int64], place: Floats, direction: Floats) -> int:
    """The highest order of a turn about an axis that carries samples near to others with like normals; 1 for none."""
    point, normal, face = samples.point[rows], samples.normal[rows], samples.face[rows]
    area = np.nan_to_num(samples.area[rows])
    across_axis = np.cross(direction, point - place)
    radius = np.linalg.norm(across_axis, axis=1)
    off = np.abs((across_axis * normal).sum(axis=1)) > _OFF * np.maximum(radius, 1e-9)
    revolved = np.bincount(face, area * ~off) >= _MOST * np.bincount(face, area)
    others = np.flatnonzero(~revolved[face])
    if area[others].sum() < _OTHERS * area.sum():
        return 1
    others = others[:: max(1, len(others) // _COMPARED)]
    tree, least = cKDTree(point), math.cos(_NORMAL)

    def agree(turn: Motion, some: NDArray[np.int64], share: float) -> bool:
        """Whether a turn carries so much of the area of some samples near to others with like normals."""
        distance, near = tree.query(turn.points(point[some]), k=min(_NEAR, len(rows)), distance_upper_bound=samples.max_gap)
        is_near = np.isfinite(distance)
        moved = turn.directions(normal[some])
        alike = (moved[:, None] * normal[np.where(is_near, near, 0)]).sum(axis=2) >= least
        agrees = (is_near & alike).any(axis=1)
        return bool(area[some][agrees].sum() >= share * area[some].sum())

    for order in reversed(_ORDERS):
        turn = Motion.turn(place, direction, 2.0 * math.pi / order)
        far = 2.0 * math.pi / order * float(np.average(radius[others], weights=area[others] + 1e-300))
        if far < _GAPS * samples.max_gap:
            continue
        # Few of them tell of most turns that they are none.
        if agree(turn, others[::_EVERY], 0.5 * _AGREES) and agree(turn, others, _AGREES):
            return order
    return 1
