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

from cad_io.arrays import Floats, Record, SurfaceSamples, cross
from plan_cutters.domain.cutter import Cutter
from plan_cutters.domain.shapes import flute_length, modes
from plan_cutters.scene.obstacles import Obstacles

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

    `samples`: n of them. `obstacles`: with the triangles of the part.

    Notes
    -----
    What was measured belongs to this object alone, and is read and written by one thread.
    """

    def __init__(self, samples: SurfaceSamples, obstacles: Obstacles) -> None:
        self._samples, self._obstacles = samples, obstacles
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

    def longest(self, rows: Rows) -> Floats:
        """The unit directions (m, 3) in which passes through samples go on farthest, among those that are measured."""
        self._measure(rows)
        first, second = self._frame(rows)
        turn = np.nan_to_num(self._length[1, rows]).argmax(axis=1)[:, None] * (math.pi / DIRECTIONS)
        return np.asarray(np.cos(turn) * first + np.sin(turn) * second)

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

        from plan_cutters.kernels.linear.sections import sections

        samples, triangles, face = self._samples, self._obstacles.triangles, self._samples.face
        for number in np.unique(face[rows[~self._measured[rows]]]).tolist():
            every = np.flatnonzero(face == number)
            self._measured[every] = True
            known = every[np.isfinite(samples.direction_max[every]).all(axis=1) & np.isfinite(samples.normal[every]).all(axis=1)]
            own = self._obstacles.rows_of([number])
            if not len(known) or not len(own):
                continue
            smooth = self._pairs[(self._pairs == number).any(axis=1)]
            all_of = np.concatenate([own, self._obstacles.rows_of(smooth[smooth != number].tolist())])
            vertex, unit = triangles.vertex[all_of], self._unit[all_of]
            most = min(_OF_A_FACE, max(_AT_LEAST, _TOGETHER // len(vertex)))
            some = known[:: 1 + len(known) // most]
            first, second = self._frame(some)
            point, normal = np.ascontiguousarray(samples.point[some]), np.ascontiguousarray(samples.normal[some])
            near = 2.0 * triangles.chord_error + 1e-6
            nearest = cKDTree(point).query(samples.point[known])[1]
            for k in range(DIRECTIONS):
                turn = k * math.pi / DIRECTIONS
                along = np.ascontiguousarray(math.cos(turn) * first + math.sin(turn) * second)
                lengths = np.empty((3, len(some)))
                sections(point, along, normal, vertex, unit, len(own), _GOES_ON, near, near, *lengths)
                self._length[:, known, k] = lengths[:, nearest]
            # A sample has its area there: what the triangles about a border say is no less than that allows.
            longest = np.nan_to_num(self._length[0, known]).max(axis=1)
            with np.errstate(divide="ignore", invalid="ignore"):
                least = np.nan_to_num(samples.area[known] / longest, posinf=0.0)
            self._length[:, known] = np.maximum(self._length[:, known], least[:, None])


#: Widths beyond this part of the radius are those of a section; curvatures of a plane at most, 1/mm.
_WIDE, PLANE = 0.25, 1e-9
#: Halvings by which a section is found.
_HALVINGS = 40
#: Tilts are within a mode up to this, rad; sines below it are that of an axis along the normal.
_HAIR = 1e-9
#: A gap is round within this share, and the centre runs no more than so many times as far as the contact.
_ROUND, _MOST = 1e-6, 50.0


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Strips(Record):
    """Widest strips at contacts.

    `width` (n,) float: mm, at most the step-over that is allowed; nan where the tool does not touch at that tilt.
    `feed` (n, 3) float: unit feed direction of the widest strip, in the tangent plane.
    `free_width` (n,) float: largest eigenvalue of `D^-1`, mm, the radius of a ball that leaves the same gap; infinite where
        curvatures match. The smaller it is, the farther is the tool from gouging.
    `narrow` (n,) float: width of the strip that is fed at right angles to that, mm.
    `any_feed` (n,) bool: whether the strip is as wide in all feed directions.
    """

    width: Floats
    feed: Floats
    free_width: Floats
    narrow: Floats
    any_feed: NDArray[np.bool_]


def strips_at(
    cutter: Cutter, normal: Floats, direction: Floats, curvature: Floats, axis: Floats, scallop: float, stepover: float
) -> Strips:
    """Find the widest strips at points with these normals (n, 3), curvatures (n, 2) and directions (n, 3) of the larger one.

    `axis` (n, 3) float: unit tool axis at each; nan where there is none. `scallop`: height of the cusps between passes, mm.
    `stepover`: widest distance of passes, in diameters.
    """
    cosine = np.clip((normal * axis).sum(axis=1), -1.0, 1.0)
    across = axis - cosine[:, None] * normal
    sine = np.linalg.norm(across, axis=1)
    tilt = np.arctan2(sine, cosine)
    f = np.where((sine > _HAIR)[:, None], across / np.maximum(sine, 1e-300)[:, None], direction)
    t = cross(normal, f)
    offset, radius = _touching(cutter, tilt)
    inverse = np.zeros((len(axis), 2, 2))
    with np.errstate(divide="ignore", invalid="ignore"):
        wide = radius + np.where(offset == 0.0, 0.0, offset / sine)
        inverse[:, 0, 0], inverse[:, 1, 1] = radius, wide
        inverse[np.isinf(wide), 1, 1] = 1e12
        # The second fundamental form in the frame of f and n x f, concave positive.
        c, s = (f * direction).sum(axis=1), (cross(normal, direction) * f).sum(axis=1)
        high, low = curvature.T
        form = np.empty((len(f), 2, 2))
        form[:, 0, 0], form[:, 1, 1] = high * c**2 + low * s**2, high * s**2 + low * c**2
        form[:, 0, 1] = form[:, 1, 0] = (low - high) * s * c
        relative = np.eye(2) - inverse @ form
        gap, det = _product(relative, inverse)
    largest, e = _largest(np.where(np.isfinite(gap), gap, 0.0))
    trace = relative[:, 0, 0] + relative[:, 1, 1]
    # Where D is not positive the curvatures match within the tolerance: the strip is as wide as is allowed.
    matched = (det <= 0.0) | (largest <= 0.0) | (trace <= 0.0)
    free_width = np.where(matched, np.inf, largest)
    most = stepover * 2.0 * cutter.radius
    other = np.where(matched, largest, np.maximum(0.0, gap[:, 0, 0] + gap[:, 1, 1] - largest))

    def width_of(free: Floats, curvature: Floats) -> Floats:
        with np.errstate(invalid="ignore"):
            width = 2.0 * np.sqrt(2.0 * scallop * np.maximum(0.0, free))
            bent = ((width > _WIDE * cutter.radius) | (offset == 0.0)) & np.isfinite(width)
            width[bent] = _section(width[bent], curvature[bent], offset[bent], radius[bent], sine[bent], scallop)
            return np.minimum(most, width)

    width, narrow = width_of(free_width, curvature), width_of(other, curvature[:, ::-1])
    feed = e[:, :1] * t - e[:, 1:] * f
    known = np.isfinite(radius) & np.isfinite(axis).all(axis=1)
    with np.errstate(invalid="ignore"):
        round_gap = np.hypot(gap[:, 0, 1], 0.5 * (gap[:, 0, 0] - gap[:, 1, 1])) <= _ROUND * np.abs(largest)
    return Strips(
        np.where(known, width, np.nan),
        feed,
        np.where(known, free_width, np.nan),
        np.where(known, narrow, np.nan),
        known & round_gap,
    )


def centre_path(
    cutter: Cutter, normal: Floats, direction: Floats, curvature: Floats, axis: Floats, feed: Floats,
    mode: tuple[Floats, Floats] | None = None, *, turning: bool = False,
) -> Floats:  # fmt: skip
    """How far the centre of a tool runs for each mm that its contact runs, (n,); 0 where it stands still.

    A contact p with the normal n is cut by a circle of the corner: its centre is p + r n, and the axis is o farther along h, the
    unit part of n across the axis. So the centre runs by t + r dn + o dh where the contact runs by t. At a fixed axis h turns
    with n; where the tool turns with the surface, both turn by n x dn, and with them the way from the centre of the tip to the
    contact. `docs/operations_proof.md`, lemma O11.

    `normal`, `direction`, `axis`, `feed` (n, 3) float: unit normals, directions of the larger curvature, tool axes, and feed
    directions in the surface. `curvature` (n, 2) float: of the surface, the larger first, concave positive, 1/mm. `mode` ((n,)
    float, (n,) float): o and r, mm; None: those of the part of the tip that touches. `turning`: whether the tool turns with the
    surface: simultaneous motion.
    """
    cosine = (normal * axis).sum(axis=1)[:, None]
    across = normal - cosine * axis
    sine = np.linalg.norm(across, axis=1)
    h = across / np.maximum(sine, 1e-300)[:, None]
    o, r = _touching(cutter, np.arctan2(sine, cosine[:, 0])) if mode is None else mode
    o, r = o[:, None], r[:, None]
    second = cross(normal, direction)
    dn = -(curvature[:, :1] * (feed * direction).sum(axis=1)[:, None] * direction
           + curvature[:, 1:] * (feed * second).sum(axis=1)[:, None] * second)  # fmt: skip
    upright = (sine <= _HAIR)[:, None]
    if turning:
        ball = o == 0.0
        arm = r * normal + np.where(upright, 0.0, o * h) - np.where(ball, 0.0, r * axis)
        path = feed + cross(cross(normal, dn), arm)
    else:
        flat = dn - (dn * axis).sum(axis=1)[:, None] * axis
        dh = (flat - (flat * h).sum(axis=1)[:, None] * h) / np.maximum(sine, _HAIR)[:, None]
        # Under the flat of a tip any of its points may touch.
        path = feed + np.where(upright & (o != 0.0), 0.0, r * dn + o * np.where(upright, 0.0, dh))
    return np.asarray(np.minimum(np.linalg.norm(path, axis=1), _MOST))


def _touching(cutter: Cutter, tilt: Floats) -> tuple[Floats, Floats]:
    """Of the part that touches at each tilt (n,): how far its centre of curvature is off the axis, and its radius, mm."""
    offset, radius = np.full((2, len(tilt)), np.nan)
    for mode in reversed(modes(cutter)):
        mine = (tilt >= mode.low - _HAIR) & (tilt <= mode.high + _HAIR)
        offset[mine], radius[mine] = mode.offset, mode.radius
    return offset, radius


def _section(width: Floats, curvature: Floats, offset: Floats, radius: Floats, sine: Floats, scallop: float) -> Floats:
    """Widths (n,) of passes that are wide for the tool, by its section across the feed.

    `width` (n,) float: by the second order, mm. `curvature` (n, 2) float: of the surface, the larger first. `offset`, `radius`
    (n,) float: of the part that touches, mm. `sine` (n,) float: of the tilt.
    """
    # The ellipse of the largest half width: w^2 = w2^2 - (w2 / 2)^4 / a^2, until its sides are reached.
    half = np.maximum(np.abs(radius + offset), radius)
    section = np.where(
        width >= math.sqrt(8.0) * half, 2.0 * half, width * np.sqrt(np.maximum(0.0, 1.0 - (0.25 * width / half) ** 2))
    )
    ball = offset == 0.0
    section[ball] = _circles(radius[ball], curvature[ball, 0], scallop)
    bull = (offset > 0.0) & (radius > 0.0) & (np.abs(curvature).max(axis=1, initial=0.0) <= PLANE)
    section[bull] = _parallel(offset[bull], sine[bull], radius[bull], scallop)
    return np.asarray(section)


def _circles(radius: Floats, curvature: Floats, scallop: float) -> Floats:
    """Width of the part of a circle or line that a ball leaves within the scallop height, along the surface."""
    with np.errstate(divide="ignore", invalid="ignore"):
        c = -1.0 / curvature
        # By the sine of a quarter of the arc: the cosine of half of it loses its digits where the circle is nearly flat.
        square = scallop * (2.0 * radius - scallop) / (4.0 * (c + radius) * (c + scallop))
        bent = 4.0 * np.abs(c) * np.arcsin(np.sqrt(np.clip(square, 0.0, 1.0)))
    flat = 2.0 * np.sqrt(np.maximum(0.0, 2.0 * radius * scallop - scallop**2))
    flat = np.where(scallop >= radius, 2.0 * radius, flat)
    return np.where(np.abs(curvature) * radius < 1e-4, flat, bent)


def _parallel(offset: Floats, sine: Floats, radius: Floats, scallop: float) -> Floats:
    """Width of a bull nose on a plane, fed along its tilt: by the line parallel to its circle's ellipse at the corner radius."""
    low, high = np.zeros(len(offset)), np.full(len(offset), 0.5 * math.pi)
    for _ in range(_HALVINGS):
        turn = 0.5 * (low + high)
        below = _height(turn, offset, sine, radius)[1] < scallop
        low, high = np.where(below, turn, low), np.where(below, high, turn)
    return np.asarray(2.0 * _height(low, offset, sine, radius)[0])


def _height(turn: Floats, offset: Floats, sine: Floats, radius: Floats) -> tuple[Floats, Floats]:
    """How far aside, and how high over the plane, the line parallel to the ellipse is at an angle of it."""
    tall = offset * sine
    along, up = tall * np.sin(turn), offset * np.cos(turn)
    size = np.maximum(np.hypot(along, up), 1e-300)
    return offset * np.sin(turn) + radius * along / size, radius + tall * (1.0 - np.cos(turn)) - radius * up / size


def _largest(form: Floats) -> tuple[Floats, Floats]:
    """The larger eigenvalues (n,) of symmetric matrices (n, 2, 2), and their unit eigenvectors (n, 2)."""
    middle, half, side = 0.5 * (form[:, 0, 0] + form[:, 1, 1]), 0.5 * (form[:, 0, 0] - form[:, 1, 1]), form[:, 0, 1]
    turn = 0.5 * np.arctan2(side, half)
    return middle + np.hypot(half, side), np.column_stack([np.cos(turn), np.sin(turn)])


def _product(relative: Floats, inverse: Floats) -> tuple[Floats, Floats]:
    """`relative^-1 inverse` (n, 2, 2), made symmetric, and the determinants of `relative`, which may be singular."""
    det = relative[:, 0, 0] * relative[:, 1, 1] - relative[:, 0, 1] * relative[:, 1, 0]
    turned = np.empty_like(relative)
    turned[:, 0, 0], turned[:, 1, 1] = relative[:, 1, 1], relative[:, 0, 0]
    turned[:, 0, 1], turned[:, 1, 0] = -relative[:, 0, 1], -relative[:, 1, 0]
    product = (turned @ inverse) / det[:, None, None]
    return np.asarray(0.5 * (product + product.transpose(0, 2, 1))), det


#: Lengths that count as nothing, mm.
NOTHING = 1e-6


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
        link = paths.link_of(cutter)
        with np.errstate(divide="ignore", invalid="ignore"):
            return np.asarray(
                1.0 / (self.path * self.slower + (0.0 if link == 0.0 else link * paths.speeds([cutter])[0]) * self.links)
            )


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
    normal, direction, curvature = samples.normal[rows], samples.direction_max[rows], samples.curvature[rows]
    widest = strips_at(cutter, normal, direction, curvature, axis, paths.scallop, paths.stepover)
    floor = on_floor(cutter, normal, curvature, axis, paths.accuracy, paths.scallop)
    feed, either = widest.feed.copy(), floor | widest.any_feed
    feed[either] = paths.extents.longest(rows[either])
    flat = flat_of(cutter)

    def fed(feed: Floats, apart: Floats) -> Cut:
        each = (paths.extents.along(rows, way) for way in (cross(normal, feed), feed))
        breadth, length = (np.where(floor, alone, beyond) for alone, beyond, _ in each)
        with np.errstate(invalid="ignore", divide="ignore"):
            # On a floor the outer passes cut all of the flat.
            count = np.ceil((breadth - np.where(floor, flat, apart)) / apart - NOTHING) + 1.0
            share = breadth / np.maximum(1.0, count)
            strip = np.where(np.isfinite(share) & (apart > 0.0), share, apart)
            run = np.where(floor, 1.0, centre_path(cutter, normal, direction, curvature, axis, feed, turning=turning))
            links = np.where(np.isfinite(length), 1.0 / (strip * length), 0.0)
            slower = np.ones(len(rows))
            if turns is not None:
                needed = np.abs(np.einsum("mki,mi->mk", turns, feed)).max(axis=1, initial=0.0) * paths.speeds([cutter])[0]
                slower = np.maximum(1.0, needed / np.maximum(run, NOTHING))
            return Cut(strip, run / strip, np.where(np.isnan(strip), np.nan, links), floor, slower)

    wide, narrow = (
        fed(feed, np.where(floor, paths.stepover * flat, widest.width)),
        fed(cross(normal, feed), np.where(either | ~(widest.narrow > 0.0), np.nan, widest.narrow)),
    )
    # The centre may run less far in narrower strips: along a round edge and not across it.
    better = narrow.pace(paths, cutter) > wide.pace(paths, cutter)
    return Cut(*(np.where(better, mine, others) for mine, others in zip(narrow, wide, strict=True)))


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
