"""Passes: the width of a strip, how far faces go on along it, the path of the tool's centre, and the links between passes.

At a contact the gap between the tool and the surface is, to second order, a quadratic form `D = S_tool - S_surface` in the
tangent plane. Its inverse gives the width of a pass in the feed direction d, with e at right angles to d, as
`2 sqrt(2 h e D^-1 e)`: the pass is widest where e is the eigenvector of the largest eigenvalue of `D^-1`
(`docs/operations_proof.md`, lemma O6). Where that is wider than a quarter of the tool's radius the second order is not enough,
and the section across the feed is taken: a circle on a circle for a ball, an ellipse for a flat end, a line parallel to an
ellipse for a bull nose on a plane. For a bull nose on a curved surface, and for a flat end there, the ellipse with the same
second order stands for the section.
"""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from cad_io.arrays import Floats, SurfaceSamples, cross
from plan_cutters.domain.cutter import Cutter
from plan_cutters.domain.shapes import flute_length, modes
from plan_cutters.kernels.linear.strips import NOTHING, PLANE, Laid, cuts
from plan_cutters.kernels.rows import Contacts
from plan_cutters.scene.obstacles import Obstacles
from plan_cutters.scene.work import in_chunks

Rows = NDArray[np.int64]
#: Directions in which a face is measured at a sample, over half a turn from that of the larger curvature.
DIRECTIONS = 12
#: Samples of a face at which it is measured, at most about, and of one of many triangles, by how many these are together; others
#: take what the nearest one has.
_OF_A_FACE, _AT_LEAST, _TOGETHER = 100, 16, 60_000
#: A pass goes on over a smooth border while the surface leans from where it is measured by no more than this: cosine of 30 deg.
_GOES_ON = math.cos(math.radians(30.0))


class Extents:
    """Lengths of faces through samples, measured when they are requested first.

    `samples`: n of them. `obstacles`: with the triangles of the part. `jobs`: threads.

    Notes
    -----
    What was measured belongs to this object alone, and is read and written by one thread.
    """

    def __init__(self, samples: SurfaceSamples, obstacles: Obstacles, jobs: int = 1) -> None:
        self._samples, self._obstacles, self._jobs = samples, obstacles, jobs
        self._length = np.full((3, len(samples), DIRECTIONS), np.nan)
        self._measured = np.zeros(len(samples), bool)
        pair = samples.face[samples.neighbours]
        self._pairs = np.unique(pair[pair[:, 0] != pair[:, 1]], axis=0)

    def along(self, rows: Rows, direction: Floats) -> tuple[Floats, Floats, Floats]:
        """Lengths (m,), mm, of the faces of samples along directions (m, 3) in them: what goes on from each, that with what it
        goes on onto smoothly, and all of the face.

        Of the directions that are measured the nearest is taken: an extent may be longer by 1 %. nan: it is not known.
        """
        self._measure(rows)
        first, second = self._frame(rows)
        turn = np.arctan2((direction * second).sum(axis=1), (direction * first).sum(axis=1))
        which = np.rint(np.nan_to_num(turn) * (DIRECTIONS / math.pi)).astype(np.int64) % DIRECTIONS
        connected, beyond, whole = self._length[:, rows, which]
        return connected, beyond, whole

    def measured(self, rows: Rows) -> Floats:
        """The lengths (3, n, directions) of the faces, known at some samples at least."""
        self._measure(rows)
        return self._length

    def _frame(self, rows: Rows) -> tuple[Floats, Floats]:
        first = self._samples.direction_max[rows]
        return first, cross(self._samples.normal[rows], first)

    @cached_property
    def _unit(self) -> Floats:
        """Unit normals (t, 3) of the triangles, either way."""
        vertex = self._obstacles.triangles.vertex
        wide = cross(vertex[:, 1] - vertex[:, 0], vertex[:, 2] - vertex[:, 0])
        return np.asarray(wide / np.maximum(1e-300, np.linalg.norm(wide, axis=1, keepdims=True)))

    def _measure(self, rows: Rows) -> None:
        from scipy.spatial import cKDTree

        samples, face = self._samples, self._samples.face
        for number in np.unique(face[rows[~self._measured[rows]]]).tolist():
            every = np.flatnonzero(face == number)
            self._measured[every] = True
            known = every[np.isfinite(samples.direction_max[every]).all(axis=1) & np.isfinite(samples.normal[every]).all(axis=1)]
            own = self._obstacles.rows_of([number])
            if not len(known) or not len(own):
                continue
            smooth = self._pairs[(self._pairs == number).any(axis=1)]
            all_of = np.concatenate([own, self._obstacles.rows_of(smooth[smooth != number].tolist())])
            some = known[:: 1 + len(known) // min(_OF_A_FACE, max(_AT_LEAST, _TOGETHER // len(all_of)))]
            nearest = cKDTree(samples.point[some]).query(samples.point[known])[1]
            self._length[:, known] = np.moveaxis(self._sections(some, all_of, len(own))[:, :, nearest], 1, 2)
            # A sample has its area there: what the triangles about a border say is no less than that allows.
            longest = np.nan_to_num(self._length[0, known]).max(axis=1)
            with np.errstate(divide="ignore", invalid="ignore"):
                least = np.nan_to_num(samples.area[known] / longest, posinf=0.0)
            self._length[:, known] = np.maximum(self._length[:, known], least[:, None])

    def _sections(self, rows: Rows, all_of: Rows, own: int) -> Floats:
        """Lengths (3, directions, m) of a face through some of its samples (m,), of the triangles of the face, the first `own` of
        some, and of those onto which it goes on smoothly.
        """
        from plan_cutters.kernels.linear.sections import sections

        triangles, (first, second), m = self._obstacles.triangles, self._frame(rows), len(rows)
        vertex, unit, near = triangles.vertex[all_of], self._unit[all_of], 2.0 * triangles.chord_error + 1e-6
        turn = np.arange(DIRECTIONS)[:, None, None] * (math.pi / DIRECTIONS)
        along = (np.cos(turn) * first + np.sin(turn) * second).reshape(-1, 3)
        point, normal = (np.tile(each[rows], (DIRECTIONS, 1)) for each in (self._samples.point, self._samples.normal))
        lengths = np.empty((3, DIRECTIONS * m))

        def measured(piece: Rows) -> None:
            its = slice(int(piece[0]), int(piece[-1]) + 1)
            sections(point[its], along[its], normal[its], vertex, unit, own, _GOES_ON, near, near, *lengths[:, its])

        in_chunks(measured, np.arange(DIRECTIONS * m), self._jobs, chunk=max(1, m))
        return lengths.reshape(3, DIRECTIONS, m)


@dataclass(frozen=True, slots=True)
class Paths:
    """How passes are laid.

    `scallop`: height of the cusps between passes, mm.
    `stepover`: widest distance of passes, in diameters.
    `feed`: cutter -> mm/min; None: times are not known, and lengths stand for them.
    `accuracy`: of the rotary axes, rad: within it of its normal an axis stands upright on a floor.
    `extents`: how far faces go on from samples.
    `link`: seconds from the end of a pass to the next one.
    `acceleration`: of the slowest linear axis, mm/s2; infinite where it is not known.
    """

    scallop: float
    stepover: float
    feed: Mapping[Cutter, float] | None
    accuracy: float
    extents: Extents
    link: float = 0.0
    acceleration: float = math.inf

    def speeds(self, cutters: Sequence[Cutter]) -> Floats:
        """Feeds of cutters, mm/s; 1 where there is no feed."""
        return np.array([1.0 if self.feed is None else self.feed[cutter] / 60.0 for cutter in cutters])

    def link_of(self, cutter: Cutter) -> float:
        """Seconds that a pass takes beside its length over the feed: the link, and to come to the feed; 0 without a feed."""
        return 0.0 if self.feed is None else self.link + self.feed[cutter] / 60.0 / self.acceleration

    def as_path(self, cutter: Cutter) -> float:
        """Path, mm, that is run in the time of a link."""
        return self.link_of(cutter) * float(self.speeds([cutter])[0])


class Cut(NamedTuple):
    """Cutting at samples (m,) takes this; nan where the tool does not touch.

    `strip` (m,) float: width that a pass cuts, mm. `path` (m,) float: length of the centre's path for each mm2, 1/mm. `links`
    (m,) float: passes for each mm2, 1/mm2: each has a link. `floor` (m,) bool: whether the flat part of the tip lies on a floor.
    `slower` (m,) float: the feed divided by this, at least 1, is as fast as the rotary axes follow.
    """

    strip: Floats
    path: Floats
    links: Floats
    floor: NDArray[np.bool_]
    slower: Floats

    def pace(self, paths: Paths, cutter: Cutter) -> Floats:
        """Give what a mm of path cuts, mm2/mm, with links counted as the path that is run meanwhile."""
        with np.errstate(divide="ignore", invalid="ignore"):
            return np.asarray(1.0 / (self.path * self.slower + paths.as_path(cutter) * self.links))


def cut_by_tip(
    cutter: Cutter, samples: SurfaceSamples, rows: Rows, axis: Floats, paths: Paths, *, turning: bool = False,
    turns: Floats | None = None,
) -> Cut:  # fmt: skip
    """Find what passes by the tip take at samples (m,) with axes (m, 3), fixed or turning with the surface.

    `turns` (m, k, 3) float: the least seconds that rotary axes need for a mm of the contact's path, as gradients; None: they are
    as fast as they must be.

    A face, with what it goes on onto smoothly, is cut in as many passes as there must be, at least one: they are as wide as their
    share of it. On a floor, which ends where its plane does, passes are the step-over apart, as a share of the flat part: what
    its corner cuts beside that is not counted.
    """
    floor = on_floor(cutter, samples.normal[rows], samples.curvature[rows], axis, paths.accuracy, paths.scallop)
    mode, flat = np.array([(each.offset, each.radius, each.low, each.high) for each in modes(cutter)]), flat_of(cutter)
    laid = Laid(
        paths.scallop, paths.stepover * 2.0 * cutter.radius, cutter.radius, flat, paths.stepover * flat, paths.as_path(cutter),
        float(paths.speeds([cutter])[0]), turning,
    )  # fmt: skip
    strip, path, links, slower = np.empty((4, len(rows)))
    turns = np.empty((len(rows), 0, 3)) if turns is None else np.ascontiguousarray(turns)
    contacts = Contacts(samples.normal, samples.normal, samples.direction_max, samples.curvature)
    length = paths.extents.measured(rows)
    cuts(rows, np.ascontiguousarray(axis), contacts, mode, laid, length, floor, turns, strip, path, links, slower)
    return Cut(strip, path, links, floor, slower)


def flank_of(cutter: Cutter) -> tuple[float, float] | None:
    """Height over the tip at which the straight side of the flutes begins, and its length, mm; None where there is none.

    >>> flank_of(Cutter.parse("D12L60rc1F26"))
    (1.0, 25.0)
    >>> flank_of(Cutter.lollipop(radius=4, neck_radius=2, length=40)) is None
    True
    """
    if cutter.shape != "end":
        return None
    begins = cutter.corner_radius * (1.0 - math.sin(cutter.taper))
    length = (flute_length(cutter) - begins) / math.cos(cutter.taper)
    return (begins, length) if length > NOTHING else None


def flat_of(cutter: Cutter) -> float:
    """Diameter of the flat part of the tip, mm; 0 where there is none.

    >>> flat_of(Cutter.parse("D12L60rc1")), flat_of(Cutter.parse("D12L60rc6"))
    (10.0, 0.0)
    """
    return 2.0 * max(0.0, cutter.radius - cutter.corner_radius) if cutter.shape == "end" else 0.0


def on_floor(
    cutter: Cutter, normal: Floats, curvature: Floats, axis: Floats, accuracy: float, scallop: float
) -> NDArray[np.bool_]:
    """At which points (n,) the flat part of the tip lies on the face.

    That is where the face is plane and the axis (n, 3) within the accuracy, rad, of its normal (n, 3), and across the flat part
    the face leaves the tip by no more than the scallop height, mm.
    """
    flat = flat_of(cutter)
    if flat <= 0.0:
        return np.zeros(len(normal), bool)
    sine = np.linalg.norm(np.cross(normal, axis), axis=1)
    plane = (np.abs(curvature) <= PLANE).all(axis=1)
    near = (sine <= math.sin(accuracy) + 1e-12) & ((normal * axis).sum(axis=1) > 0.0)
    return np.asarray(plane & near & (flat * sine <= scallop))
