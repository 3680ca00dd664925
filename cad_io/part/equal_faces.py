"""Is a face, moved (rotated, mirrored or shifted), another face? Compare their borders both ways, the surfaces between these, and
the sides that they enclose.

No step asks the kernel to project a point: distances to a border are looked for along its own parameter curves, so the work is
bounded by the number of segments. What is not understood is not equal.
"""

import math
from dataclasses import dataclass
from functools import cached_property
from itertools import product
from typing import Any

import numpy as np
from OCP.TopAbs import TopAbs_REVERSED
from scipy.spatial import cKDTree

from cad_io.arrays import Floats, Record
from cad_io.face.carrier import CLOSED, closed_form
from cad_io.face.trim import Trim
from cad_io.kernel import domain
from cad_io.part.part import Part
from cad_io.surface import Surface


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Motion(Record):
    """A motion that keeps all distances: x becomes `linear @ x + shift`.

    Examples
    --------
    >>> turn = Motion.turn(np.zeros(3), np.array([0.0, 0.0, 1.0]), np.pi / 2)
    >>> turn.points(np.array([[1.0, 0.0, 5.0]])).round(9).tolist()
    [[0.0, 1.0, 5.0]]
    """

    #: (3, 3); Orthogonal; of a mirror the determinant is -1.
    linear: Floats
    #: (3,); mm.
    shift: Floats

    @classmethod
    def turn(cls, place: Floats, direction: Floats, angle: float) -> "Motion":
        """A rotation about a unit direction through a place, by an angle, rad."""
        x, y, z = direction
        cross = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
        linear = np.eye(3) + math.sin(angle) * cross + (1.0 - math.cos(angle)) * cross @ cross
        return cls(linear, place - linear @ place)

    @classmethod
    def mirror(cls, place: Floats, normal: Floats) -> "Motion":
        """A mirror with a unit normal at a place."""
        linear = np.eye(3) - 2.0 * np.outer(normal, normal)
        return cls(linear, 2.0 * (place @ normal) * normal)

    @classmethod
    def translation(cls, shift: Floats) -> "Motion":
        """A shift."""
        return cls(np.eye(3), np.asarray(shift, float))

    def points(self, point: Floats) -> Floats:
        """Points (n, 3) moved."""
        return np.asarray(point @ self.linear.T + self.shift)

    def directions(self, vector: Floats) -> Floats:
        """Vectors (n, 3) turned or mirrored."""
        return np.asarray(vector @ self.linear.T)

    def back(self, point: Floats) -> Floats:
        """Points (n, 3) that are moved to these."""
        return np.asarray((point - self.shift) @ self.linear)

    @property
    def axis(self) -> tuple[Floats, Floats] | None:
        """A place and the unit direction about which a rotation turns; None for others, and for no motion at all."""
        if np.linalg.det(self.linear) < 0.0:
            return None
        turn = self.linear - self.linear.T
        if np.abs(self.linear - np.eye(3)).max() < 1e-9:
            return None
        direction = np.array([turn[2, 1], turn[0, 2], turn[1, 0]])
        if np.linalg.norm(direction) < 1e-6:
            # Half a turn: what is not mirrored is the axis.
            values, vectors = np.linalg.eigh(0.5 * (self.linear + self.linear.T))
            direction = vectors[:, int(values.argmax())]
        direction = direction / np.linalg.norm(direction)
        place = np.linalg.lstsq(np.eye(3) - self.linear, self.shift - (self.shift @ direction) * direction, rcond=1e-9)[0]
        return place, direction


#: Points of a segment that is the border itself, and of one that is a chord of it.
_ALONG, _CHORD = 32, 4
#: Most points of a border: faces with more are not compared.
_MOST = 60_000
#: Points of a border nearer than this share of the part's size, on different segments, are those of a seam.
_SEAM = 1e-8
#: Segments of the other border that a point is compared with, and steps along them.
_NEAR, _STEPS = 3, 6
#: Points along each direction where the polynomial pieces of a surface are not known, and most of them along one direction.
_UNKNOWN, _LINES = 33, 400
#: Areas and vector areas are measured to this, as a share of the area.
_MEASURED = 1e-4


@dataclass(frozen=True, eq=False)
class FaceShape:
    """A face with its border, as it is compared."""

    number: int
    #: Kind of the stored surface, as `FaceInfo.surface`.
    kind: str
    #: mm2.
    area: float
    #: (3,); Integral of `dS/du x dS/dv`, mm2.
    vector: Floats
    #: +1 where the shape's own outer side is that of `dS/du x dS/dv`, else -1.
    side: float
    surface: Surface
    trim: Trim
    #: (k, 3); Points of the border, without seams, mm.
    point: Floats
    #: (k,); The length that each stands for, mm.
    weight: Floats
    #: (k,); Of the trim, on which each lies.
    segment: Any
    #: (k,); How far along its segment, 0 to 1.
    share: Floats

    @cached_property
    def centre(self) -> Floats:
        """Middle (3,) of the border by length; of a face without one, of its surface's lines."""
        total = self.weight.sum()
        if total > 0.0:
            return np.asarray(self.weight @ self.point / total)
        u0, u1, v0, v1 = self.trim.box
        u, v = (each.ravel() for each in np.meshgrid(np.linspace(u0, u1, 9)[:-1], np.linspace(v0, v1, 9)))
        return np.asarray(self.surface.values(u, v).mean(axis=0))

    @cached_property
    def length(self) -> float:
        """Length of the border, mm."""
        return float(self.weight.sum())

    @cached_property
    def tensor(self) -> Floats:
        """Second moment (3, 3) of the border about its middle, mm2."""
        away = self.point - self.centre
        return np.asarray((away * self.weight[:, None]).T @ away / max(self.weight.sum(), 1e-300))

    @cached_property
    def tree(self) -> Any:
        return cKDTree(self.point)

    @cached_property
    def normal(self) -> Floats:
        """Unit `dS/du x dS/dv` (k, 3) at the points of the border; nan where there is none."""
        d = self.surface.first(*self.trim.at(self.segment, self.share).T)
        normal = np.cross(d[:, 1], d[:, 2])
        with np.errstate(invalid="ignore", divide="ignore"):
            return np.asarray(normal / np.linalg.norm(normal, axis=1)[:, None])

    def off_border(self, point: Floats, enough: float) -> Floats:
        """Distances (k,), mm, of points (k, 3) from the border, not told too small; those within `enough` need be no closer."""
        best = self.tree.query(point)[0]
        # Of equal faces nearly every point has another one at its place, and needs no further ones.
        open_ = np.flatnonzero(best > enough)
        near = self.tree.query(point[open_], k=[*range(1, min(_NEAR, len(self.point)) + 1)])[1]
        for k in range(near.shape[1]):
            still = best[open_] > enough
            if not still.any():
                break
            rows = open_[still]
            best[rows] = np.minimum(best[rows], self._along(point[rows], near[still, k]))
        return np.asarray(best)

    def _along(self, point: Floats, near: Any) -> Floats:
        """Distances (k,) of points from the segments on which points of the border lie, by steps along these."""
        segment, share = self.segment[near], self.share[near].copy()
        along = self.trim.segments[segment, 1] - self.trim.segments[segment, 0]
        best = np.full(len(point), np.inf)
        for _ in range(_STEPS):
            d = self.surface.first(*self.trim.at(segment, share).T)
            away = point - d[:, 0]
            best = np.fmin(best, np.linalg.norm(away, axis=1))
            speed = d[:, 1] * along[:, :1] + d[:, 2] * along[:, 1:]
            share = np.clip(share + (away * speed).sum(axis=1) / np.maximum((speed**2).sum(axis=1), 1e-300), 0.0, 1.0)
        return best


def face_shape(part: Part, number: int, size: float) -> FaceShape | None:
    """A face of a part of a size, mm, as it is compared; None where its border has no finite points, or too many."""
    trim, measured = part.trim(number), part.measure(number)
    if trim is None or measured is None:
        return None
    surface, side = part.surface(number), -1.0 if part.face(number).Orientation() == TopAbs_REVERSED else 1.0
    segment, share = trim.along(_ALONG, _CHORD, 0.5)
    if len(segment) > _MOST:
        return None
    d = surface.first(*trim.at(segment, share).T)
    along = trim.segments[segment, 1] - trim.segments[segment, 0]
    pieces = np.where(trim.exact, _ALONG, _CHORD)[segment]
    weight = np.linalg.norm(d[:, 1] * along[:, :1] + d[:, 2] * along[:, 1:], axis=1) / pieces
    if not (np.isfinite(d[:, 0]).all() and np.isfinite(weight).all() and np.isfinite(measured.area)):
        return None
    # Where an edge is a single point, and where the face goes on behind a seam, there is no border.
    stays = weight > 1e-12 * size
    rows = np.flatnonzero(stays)
    if len(rows):
        pairs = rows[cKDTree(d[rows, 0]).query_pairs(_SEAM * size, output_type="ndarray")]
        stays[pairs[segment[pairs[:, 0]] != segment[pairs[:, 1]]]] = False
    border = d[stays, 0], weight[stays], segment[stays], share[stays]
    kind = part.faces[number - 1].surface
    return FaceShape(number, kind, measured.area, measured.vector, side, surface, trim, *border)


def equal(one: FaceShape, other: FaceShape, motion: Motion, tolerance: float) -> bool:
    """Whether one face, moved, is another one within a tolerance, mm.

    The borders agree both ways, closer than what their polygons may be off by; the area and the vector area do; and so do the
    surfaces, in closed form, or where they are aligned by their parameters, at so many points that polynomial pieces which agree
    there are the same.
    """
    if one.kind != other.kind or abs(one.area - other.area) > _MEASURED * other.area:
        return False
    if (len(one.point) == 0) != (len(other.point) == 0):
        return False
    off = tolerance + one.trim.deflection + other.trim.deflection
    if len(one.point):
        if (other.off_border(motion.points(one.point), off) > off).any():
            return False
        if (one.off_border(motion.back(other.point), off) > off).any():
            return False
        if not _same_side(one, other, motion):
            return False
    return _same_surface(one, other, motion, tolerance)


def _same_side(one: FaceShape, other: FaceShape, motion: Motion) -> bool:
    """Whether the vector areas agree, and what lies outside: of two parts of a surface with one border only one has this."""
    rows = np.flatnonzero(np.isfinite(one.normal).all(axis=1))[:: max(1, len(one.point) // 16)]
    near = other.tree.query(motion.points(one.point[rows]))[1]
    inner = (motion.directions(one.normal[rows]) * other.normal[near]).sum(axis=1)
    if not len(rows) or not np.isfinite(inner).any():
        return False
    way = 1.0 if np.nanmean(inner) > 0.0 else -1.0
    if way != one.side * other.side:
        return False
    return bool(np.linalg.norm(way * motion.directions(one.vector[None])[0] - other.vector) <= _MEASURED * other.area)


def _same_surface(one: FaceShape, other: FaceShape, motion: Motion, tolerance: float) -> bool:
    if one.kind == "plane":
        # Its border lies in it.
        return len(one.point) >= 3
    if one.kind in CLOSED:
        return _same_elementary(one, other, motion, tolerance)
    if one.number == other.number and _onto_itself(one, motion, tolerance):
        return True
    ways = product((False, True), (False, True), (False, True))
    return any(_agrees(one, other, motion, way, tolerance) for way in ways)


def _same_elementary(one: FaceShape, other: FaceShape, motion: Motion, tolerance: float) -> bool:
    """Quadrics and tori, by their axes and radii."""
    (place, direction, radii), (place_, direction_, radii_) = (elementary(each) for each in (one, other))
    away = motion.points(place[None])[0] - place_
    reach = float(np.linalg.norm(other.point - place_, axis=1).max(initial=0.0)) if one.kind != "sphere" else 0.0
    turned = motion.directions(direction[None])[0]
    if any(abs(a - b) > tolerance for a, b in zip(radii, radii_, strict=True)):
        return False
    if one.kind == "sphere":
        return bool(np.linalg.norm(away) <= tolerance)
    if one.kind == "cone":
        # The apex has a side.
        return bool(np.linalg.norm(away) <= tolerance and np.linalg.norm(turned - direction_) * reach <= tolerance)
    if one.kind == "cylinder":
        away = away - (away @ direction_) * direction_
    return bool(np.linalg.norm(away) <= tolerance and np.linalg.norm(np.cross(turned, direction_)) * reach <= tolerance)


def elementary(face: FaceShape) -> tuple[Floats, Floats, tuple[float, ...]]:
    """A point of the axis, the unit axis and what else says it all of a cylinder, cone, sphere or torus.

    Of a cone the point is the apex, the axis goes from there to the face, and the tangent of the half angle stands for a radius.
    """
    place, direction, radii = closed_form(face.kind, face.surface.adaptor)
    if face.kind != "cone":
        return place, direction, radii
    if (face.centre - place) @ direction < 0.0:
        direction = -direction
    reach = float(np.linalg.norm(face.point - place, axis=1).max(initial=0.0))
    return place, direction, (reach * abs(np.tan(radii[0])),)


def axis_of(face: FaceShape) -> tuple[Floats, Floats] | None:
    """A point (3,) and the unit direction (3,) of the axis about which a face is turned; None where it has none."""
    if face.kind in ("cylinder", "cone", "torus"):
        return elementary(face)[:2]
    if face.kind == "revolution":
        axis = face.surface.adaptor.AxeOfRevolution()
        return np.array(axis.Location().Coord()), np.array(axis.Direction().Coord())
    return None


def _grid(face: FaceShape) -> tuple[Floats, Floats]:
    """Lines along u and v of the whole surface: so many in each polynomial piece that these are known by their points."""
    form = face.surface.form
    ends, lines = np.array(domain(face.surface.adaptor)).reshape(2, 2), list[Floats]()
    box = np.array(face.trim.box).reshape(2, 2)
    for k in range(2):
        low, high = np.where(np.abs(ends[k]) < 1e50, ends[k], box[k])
        knots, degree = (np.zeros(0), 0) if form is None else (np.asarray(form.knots[k]), form.degree[k])
        if not degree:
            lines.append(np.linspace(low, high, _UNKNOWN))
            continue
        inner = knots[(knots > low) & (knots < high)]
        breaks = np.unique(np.concatenate([[low], inner, [high]]))
        each = 2 * degree + 1
        part = (np.arange(each) + 0.5) / each
        lines.append((breaks[:-1, None] + part * np.diff(breaks)[:, None]).ravel())
    return lines[0], lines[1]


def _agrees(one: FaceShape, other: FaceShape, motion: Motion, way: tuple[bool, bool, bool], tolerance: float) -> bool:
    """Whether the surfaces agree with their parameters exchanged, or turned round, if so said."""
    swapped, back_u, back_v = way
    u, v = _grid(one)
    if max(len(u), len(v)) > _LINES:
        return False
    mine, others = (np.array(domain(each.surface.adaptor)).reshape(2, 2) for each in (one, other))
    if (np.abs(np.concatenate([mine, others])) > 1e50).any():
        mine, others = (np.array(each.trim.box).reshape(2, 2) for each in (one, other))
    share = [(u - mine[0, 0]) / np.ptp(mine[0]), (v - mine[1, 0]) / np.ptp(mine[1])]
    share = [1.0 - each if back else each for each, back in zip(share, (back_u, back_v), strict=True)]
    if swapped:
        others = others[::-1]
    there = [others[k, 0] + share[k] * np.ptp(others[k]) for k in range(2)]
    few = [np.linspace(0, len(each) - 1, min(4, len(each))).astype(int) for each in (u, v)]
    for rows in (few, [np.arange(len(u)), np.arange(len(v))]):
        a, b = (each.ravel() for each in np.meshgrid(u[rows[0]], v[rows[1]], indexing="ij"))
        c, d = (each.ravel() for each in np.meshgrid(there[0][rows[0]], there[1][rows[1]], indexing="ij"))
        moved = motion.points(one.surface.values(a, b))
        off = np.linalg.norm(moved - other.surface.values(*((d, c) if swapped else (c, d))), axis=1)
        if not (off <= tolerance).all():
            return False
    return True


def _onto_itself(face: FaceShape, motion: Motion, tolerance: float) -> bool:
    """Whether a motion leaves a face in its surface of revolution."""
    own = axis_of(face)
    if own is not None:
        # What leaves each point of the axis where it is leaves each circle about it where it is.
        place, direction = own
        reach = float(np.linalg.norm(face.point - place, axis=1).max(initial=0.0))
        still = np.linalg.norm(motion.points(place[None])[0] - place) <= tolerance
        return bool(still and np.linalg.norm(motion.directions(direction[None])[0] - direction) * reach <= tolerance)
    axis = motion.axis
    return axis is not None and _turns_onto_itself(face, *axis, tolerance)


def _turns_onto_itself(face: FaceShape, place: Floats, direction: Floats, tolerance: float) -> bool:
    """Whether no turn about an axis moves a face out of its surface: its normals meet the axis."""
    u, v = _grid(face)
    if max(len(u), len(v)) > _LINES:
        return False
    d = face.surface.first(*(each.ravel() for each in np.meshgrid(u, v, indexing="ij")))
    normal = np.cross(d[:, 1], d[:, 2])
    across = np.cross(direction, d[:, 0] - place)
    with np.errstate(invalid="ignore", divide="ignore"):
        # Turned by one radian a point leaves the surface by no more than this.
        off = np.abs((across * normal).sum(axis=1)) / np.linalg.norm(normal, axis=1)
    return bool((np.nan_to_num(off, nan=0.0) <= 0.1 * tolerance).all() and np.isfinite(off).any())
