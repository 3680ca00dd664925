"""Every free tilt at one point, and what each attribute forbids alone; and those of every sample at every rotation, with
certified ends.

The map of a point is the seed's Fig. 7, with a list of intervals at each rotation in place of one pair of numbers. How many
samples are mapped follows from counted work, so that two runs choose the same ones.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from cad_io import Triangles
from cad_io.arrays import Floats, Record, SurfaceSamples
from plan_cutters.domain.assembly import Assembly
from plan_cutters.domain.checks import Angle, in_radians
from plan_cutters.domain.posture import common, complement, join, tilt_direction, without
from plan_cutters.domain.verdicts import ACCESSIBLE, UNDECIDED, Verdicts, blank
from plan_cutters.errors import OptionError
from plan_cutters.kernels.codes import FLUTES, HOLDER, NECK, SHANK, TILT_FROM, TILT_TO
from plan_cutters.scene.conditions import Context, contacts_of, require_finite, tool_of
from plan_cutters.scene.flats_and_flanks import on_the_flank, on_the_flat
from plan_cutters.scene.obstacles import Obstacles
from plan_cutters.scene.triangles import halved
from plan_cutters.scene.work import Progress, evenly, in_chunks

#: Ends that move by no more, rad, have settled.
SETTLED = np.radians(0.01)
#: Parts that one rotation may fall into before the rest is called undecided.
_MOST_INTERVALS = 20_000
#: Pieces of obstacles cut at the border between rear gouging and collision are no larger than this share of R.
_BORDER = 0.02


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class PostureMap(Record):
    """Free tilts of a cutter at a point.

    Attributes
    ----------
    rotations : (k,) float
        rad, from `direction_max`.
    free : tuple of (m, 2) float
        At each rotation, the sorted free tilt intervals, rad.
    undecided : tuple of (m, 2) float
        Tilts that are neither called free nor known to be forbidden: the uncertainty of the ends.
    local_gouge : (k,) float
        Least tilt at which curvature keeps surface and cutter apart at the contact, rad; nan if none. With a tolerance, tilts
        below it may be free all the same: what gouges there may not be too deep.
    local_gouge_most : (k,) float
        Largest tilt that it allows: pi but for barrels.
    rear_gouge, collision, neck, shank, holder, axis_limit : tuple of (m, 2) float
        Each attribute alone: forbidden intervals. Obstacles in the flutes within 2R of the contact and above its tangent plane
        are rear gouging, all others in the flutes collision.
    no_contact : tuple of (m, 2) float
        Tilts at which the cutter touches nowhere.
    point, normal, direction_max : (3,) float
        The frame: contact, unit normal out of the material, direction from which rotations count.
    curvature : (2,) float
        kappa_max, kappa_min, 1/mm, concave positive.
    buried : tuple of (m, 2) float
        Tilts at which the cutter touches nothing and lies within a body.
    under_flat : (3,) float
        Where the edge of a flat tip can touch at tilt 0 at none of the rotations, but the tool stands free upright with the point
        under its flat: from its axis to the point, mm. Else nan.
    flank_axis : (3,) float
        Where no tilt is free, and the point under no flat: a unit tool axis with which the tool stands free, its flank along the
        surface, elsewhere than with its lower end or not quite at its tilt. Else nan.
    tolerance : float
        The gouge tolerance kept, mm; 0 for the nominal answer.
    certified : bool
        Whether free tilts are safe for the true surface to the tolerance; the nominal answer is not, nor is any where
        `missing` names a face.
    missing : tuple of str
        Faces that stand in the way only as a guess or not at all, with the reason; what only they forbid is undecided.
    chord_error : float
        Of the obstacles, mm.
    settled : bool
        For the nominal answer: whether a last refinement moved no end by more than 0.01 deg.
    """

    rotations: Floats
    free: tuple[Floats, ...]
    undecided: tuple[Floats, ...]
    local_gouge: Floats
    local_gouge_most: Floats
    rear_gouge: tuple[Floats, ...]
    collision: tuple[Floats, ...]
    neck: tuple[Floats, ...]
    shank: tuple[Floats, ...]
    holder: tuple[Floats, ...]
    no_contact: tuple[Floats, ...]
    axis_limit: tuple[Floats, ...]
    buried: tuple[Floats, ...]
    under_flat: Floats
    flank_axis: Floats
    point: Floats
    normal: Floats
    direction_max: Floats
    curvature: Floats
    tolerance: float
    certified: bool
    missing: tuple[str, ...]
    chord_error: float
    settled: bool

    @property
    def lies_flat(self) -> bool:
        """Whether the tool stands free upright with the point under its flat."""
        return bool(np.isfinite(self.under_flat).all())

    @property
    def lies_along(self) -> bool:
        """Whether the tool stands free with its flank along the surface, though no tilt is free."""
        return bool(np.isfinite(self.flank_axis).all())

    def axis(self, i: int, tilt: float | None = None, *, tilt_deg: float | None = None) -> Floats:
        """Unit tool axis at `rotations[i]` and a tilt, rad or degrees, in part coordinates."""
        tilt = in_radians({"tilt": tilt, "tilt_deg": tilt_deg}, {"tilt": Angle(-180.0, 180.0)})["tilt"]
        if tilt is None:
            raise OptionError("give a tilt, in radians, or tilt_deg, in degrees")
        f = tilt_direction(self.normal, self.direction_max, float(self.rotations[i]))
        return np.cos(tilt) * self.normal + np.sin(tilt) * f


def posture_map_of(contact: SurfaceSamples, rotations: Floats, context: Context, narrowest: float) -> PostureMap:
    """The map of one contact.

    `contact`: one sample. `rotations` (k,) float: rad. `context`: tilts are looked at in its posture range. Its tolerance 0
    stands for the nominal answer. `narrowest`: width below which a range of tilts stays undecided, rad.
    """
    from plan_cutters.kernels.maps.free_tilts import FORBIDDEN, OPEN, UNSURE, axis_intervals

    cutter, conditions, (low, high) = context.cutter, context.conditions, context.conditions.postures.tilt
    p, n, e1 = contact.point[0], contact.normal[0], contact.direction_max[0]
    ranges, surroundings, tolerance = conditions.ranges, conditions.surroundings, conditions.tolerance
    whole, outer_tool, inner_tool = conditions.obstacles, context.outer_tool, context.inner_tool
    near, far = _rear(whole.triangles, p, n, cutter.radius)
    alone = {
        "rear_gouge": (near, outer_tool.only(FLUTES)),
        "collision": (far, outer_tool.only(FLUTES)),
        "neck": (whole, outer_tool.only(NECK)),
        "shank": (whole, outer_tool.only(SHANK)),
        "holder": (whole, outer_tool.only(HOLDER)),
    }
    free, undecided, axis, inside_bodies, no_contact = [], [], [], [], []
    apart: dict[str, list[Floats]] = {word: [] for word in alone}
    gouge = np.empty((len(rotations), 2))
    touching = join(common(outer_tool.mode[:, [TILT_FROM, TILT_TO]], np.array([[low, high]])))
    for i, rotation in enumerate(rotations):
        f = tilt_direction(n, e1, float(rotation))
        bounds = _gouge_bounds(contact.curvature[0], float(rotation), outer_tool)
        gouge[i] = (bounds[:, 0].min(), bounds[:, 1].max()) if len(bounds) else (np.nan, np.nan)
        allowed = axis_intervals(n, f, ranges)
        axis.append(complement(allowed, low, high))
        no_contact.append(complement(touching, low, high))
        for word, (obstacles, tool) in alone.items():
            parts = [np.zeros((0, 3))]
            parts += [_parts(obstacles, tool, p, n, f, first, last, narrowest) for first, last in touching.tolist()]
            apart[word].append(without(complement(_merged(np.concatenate(parts), OPEN), low, high), no_contact[-1]))
        pieces, sure = [np.zeros((0, 3))], [np.zeros((0, 3))]
        # With a tolerance the triangles decide what curvature forbids, too.
        for first, last in common(allowed, touching if tolerance > 0 else bounds).tolist():
            pieces.append(_parts(whole, outer_tool, p, n, f, first, last, narrowest))
            if surroundings.certain is not whole:
                sure.append(_parts(surroundings.certain, inner_tool, p, n, f, first, last, narrowest))
        intervals = np.concatenate(pieces)
        open_tilts, unsure = _merged(intervals, OPEN), _merged(intervals, UNSURE)
        if surroundings.certain is not whole:
            # What is not free for all that may be there, but is not surely blocked either.
            blocked = _merged(np.concatenate(sure), FORBIDDEN)
            rest = intervals[intervals[:, 2] != OPEN].copy()
            unsure = without(_merged(np.column_stack([rest[:, :2], np.full(len(rest), UNSURE)]), UNSURE), blocked)
        within, sunk = np.zeros((2, len(open_tilts)), bool)
        if len(open_tilts):
            every = np.ones((len(open_tilts), 1))
            frame = (outer_tool, every * p, every * n, every * f, open_tilts.mean(axis=1))
            within = whole.holds(*frame)
            sunk = within & surroundings.certain.holds(*frame, certain=True)
        free.append(open_tilts[~within])
        inside_bodies.append(open_tilts[sunk])
        # Within what is only perhaps a body.
        perhaps = open_tilts[within & ~sunk]
        undecided.append(unsure if not len(perhaps) else join(np.concatenate([unsure, perhaps])))
    under_flat, flank_axis = _lying(contact, free, context)
    return PostureMap(
        rotations=rotations, free=tuple(free), undecided=tuple(undecided), local_gouge=gouge[:, 0],
        local_gouge_most=gouge[:, 1], axis_limit=tuple(axis), no_contact=tuple(no_contact), buried=tuple(inside_bodies), point=p,
        normal=n, under_flat=under_flat, flank_axis=flank_axis,
        **{word: tuple(each) for word, each in apart.items()},
        direction_max=e1, curvature=contact.curvature[0], tolerance=tolerance,
        certified=tolerance > 0 and not surroundings.doubtful, missing=surroundings.doubts,
        chord_error=whole.triangles.chord_error, settled=tolerance > 0,
    )  # fmt: skip


def _lying(contact: SurfaceSamples, free: Sequence[Floats], context: Context) -> tuple[Floats, Floats]:
    """What a search finds beside free tilts: from the axis of the tool to a contact that lies under a flat, mm, and the axis of a
    tool whose flank lies along it; nan where there is none, or where it is not looked for.
    """
    none, nowhere, row = np.full(3, np.nan), not any(len(tilts) for tilts in free), np.zeros(1, np.int64)
    upright = nowhere or not any(len(tilts) and tilts[0, 0] <= 0.0 for tilts in free)
    if not (context.judges and upright):
        return none, none
    verdicts = blank(1)
    verdicts.verdict[0] = UNDECIDED
    on_the_flat(contacts_of(contact), row, context, verdicts)
    if verdicts.verdict[0] == ACCESSIBLE:
        return context.outer_tool.from_axis(contact.point, contact.normal, verdicts)[0], none
    if nowhere:
        on_the_flank(contacts_of(contact), contact.face, row, context, verdicts)
    return none, verdicts.axis[0]


def _gouge_bounds(curvature: Floats, rotation: float, tool: Assembly) -> Floats:
    """Tilts (k, 2) at which a tool touches and local gouging allows it."""
    from plan_cutters.kernels.maps.free_tilts import local_gouge_range

    bounds = []
    for offset, radius, low, high, _ in tool.mode.tolist():
        least, most = local_gouge_range(float(curvature[0]), float(curvature[1]), rotation, offset, radius)
        bounds += [(max(least, low), min(most, high))] if max(least, low) <= min(most, high) else []
    return join(np.array(bounds).reshape(-1, 2))


def _parts(
    obstacles: Obstacles | None, tool: Assembly, p: Floats, n: Floats, f: Floats, first: float, last: float, narrowest: float
) -> Floats:
    """Free, forbidden and undecided parts (k, 3) of a range of tilts, as `free_tilts` gives them."""
    from plan_cutters.kernels.maps.free_tilts import OPEN, free_tilts

    if obstacles is None or not tool.piece.shape[1]:
        return np.array([[first, last, OPEN]])
    parts = [np.zeros((0, 3))]
    for mode, (_, _, low, high, _) in enumerate(tool.mode.tolist()):
        low, high = max(first, low), min(last, high)
        if low <= high:
            parts.append(free_tilts(p, n, f, low, high, tool_of(tool), mode, narrowest, obstacles.tree, _MOST_INTERVALS))
    return np.concatenate(parts)


def _merged(parts: Floats, kind: int) -> Floats:
    """Intervals of one kind, those that touch joined, ascending."""
    return join(parts[parts[:, 2] == kind][:, :2])


def moved(a: PostureMap, b: PostureMap) -> float:
    """Largest movement of an end between two maps; inf where intervals came or went (slivers aside)."""
    worst = 0.0
    for x, y in zip(a.free, b.free, strict=True):
        x, y = (i[(i[:, 1] - i[:, 0]) > SETTLED] for i in (x, y))
        if len(x) != len(y):
            return np.inf
        worst = max(worst, float(np.abs(x - y).max(initial=0.0)))
    return worst


# Of three numbers a row, column by column: the library's reductions take several times as long over so short an axis.


def _least(rows: Floats) -> Floats:
    return np.minimum(np.minimum(rows[:, 0], rows[:, 1]), rows[:, 2])


def _most(rows: Floats) -> Floats:
    return np.maximum(np.maximum(rows[:, 0], rows[:, 1]), rows[:, 2])


def _length(vectors: Floats) -> Floats:
    x, y, z = np.moveaxis(vectors, -1, 0)
    return np.asarray(np.sqrt(x * x + y * y + z * z))


def _rear(triangles: Triangles, p: Floats, n: Floats, radius: float) -> tuple[Obstacles | None, Obstacles | None]:
    """Share obstacles out: within 2R of the contact and above its tangent plane, and all others; None if there are none.

    Triangles across the border are halved until they are small; then their centre decides.
    """
    within, smallest = 2 * radius, _BORDER * radius
    vertex, face = triangles.vertex, triangles.face
    near: list[tuple[Floats, Any]] = []
    far: list[tuple[Floats, Any]] = []
    while len(vertex):
        offset = vertex - p
        distance, height = _length(offset), offset @ n
        sides = _length(vertex - np.roll(vertex, -1, axis=1))
        side = _most(sides)
        # The nearest point of a triangle is no nearer than its nearest corner less its longest side.
        outside = (_least(distance) - side > within) | (_most(height) <= 0)
        inside = (_most(distance) <= within) & (_least(height) > 0)
        small = side <= smallest
        centre = offset[small].mean(axis=1)
        inside[small] = (_length(centre) <= within) & (centre @ n > 0)
        outside |= small & ~inside
        near.append((vertex[inside], face[inside]))
        far.append((vertex[outside], face[outside]))
        rest = ~inside & ~outside
        vertex, face = halved(vertex[rest], sides[rest]), np.tile(face[rest], 2)

    def gather(parts: list[tuple[Floats, Any]]) -> Obstacles | None:
        mine = Triangles(np.concatenate([x for x, _ in parts]), np.concatenate([x for _, x in parts]), triangles.chord_error, ())
        return Obstacles(mine) if len(mine) else None

    return gather(near), gather(far)


#: Blocks of the tree and triangles that are looked at for all maps, about: some minutes on two cores.
WORK = 400_000_000
#: Samples by which the work is estimated, and how many of them at a time.
PROBED, _AT_A_TIME = 256, 16

Rows = NDArray[np.int64]


def chosen(judged: Rows, most: int | None, looked: Callable[[Rows], int], jobs: int) -> Rows:
    """The samples to map.

    `judged` (n,) int64: samples that could be mapped, ascending. `most`: at most so many. None: as many as take about `WORK`.
    `looked`: maps some samples and tells at how much it looked: the same for the same samples. `jobs`: threads.
    """
    if most is None:
        if len(judged) <= PROBED:
            return judged
        tried = evenly(judged, PROBED)
        most = int(WORK * len(tried) / max(1, in_chunks(looked, tried, jobs, chunk=_AT_A_TIME)))
    return evenly(judged, most)


#: Ends are certified to this, rad; where that cannot be, the band left is counted as undecided.
NARROWEST = np.radians(0.1)
#: Free intervals that one rotation may have; more count as undecided.
_MOST_FREE = 8


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class PostureMaps(Record):
    """Free tilts of n samples at k rotations.

    Attributes
    ----------
    rotations : (k,) float
        rad, from each sample's `direction_max`.
    offset : (n * k + 1,) int64
        Sample i has at rotation j the intervals `free[offset[i * k + j]:offset[i * k + j + 1]]`.
    free : (m, 2) float
        Tilts from, to, rad, ascending; every tilt within is safe for the true surface to the tolerance.
    undecided : (n, k) float32
        Tilts that are neither free nor known to be forbidden, rad in all.
    normal, direction_max : (n, 3) float
        The samples' frames, from which tilts and rotations count.
    verdict, reason : (n,) uint8
        What was found of each sample without limits of a machine, as in `Verdicts`.
    tilt : (float, float)
        Tilts that were looked at, rad.
    tolerance : float
        Gouge tolerance that is kept, mm.
    cutter : str
        Its id.
    part : str
        SHA-256 of the part's file; empty where it was no file.
    inside : (n,) bool
        Samples that lie inside another body of the part: no surface of the finished part. Empty: none.
    missing : tuple of str
        Obstacles that are missing or only guessed: while there are some, what is free is so but for them.
    unmapped : int
        Judged samples that were left out: they are undecided at every tilt.

    They hold for any machine, and for any setup that turns no side of an open face: the part's free postures depend on neither.
    """

    rotations: Floats
    offset: NDArray[np.int64]
    free: Floats
    undecided: NDArray[np.float32]
    normal: Floats
    direction_max: Floats
    verdict: NDArray[np.uint8]
    reason: NDArray[np.uint8]
    tilt: tuple[float, float]
    tolerance: float
    cutter: str
    part: str
    inside: NDArray[np.bool_] = field(default_factory=lambda: np.zeros(0, bool))
    missing: tuple[str, ...] = ()
    unmapped: int = 0


def posture_maps(
    samples: SurfaceSamples, context: Context, verdicts: Verdicts, *, part: str = "",
    inside: NDArray[np.bool_] | None = None, shut: NDArray[np.bool_] | None = None, missing: tuple[str, ...] = (),
    most: int | None = None, progress: Progress | None = None,
) -> PostureMaps:  # fmt: skip
    """Find the free tilts of judged samples, whatever the machine; the others have none.

    Of samples that are more than the work is worth, as many as that allows, evenly spread: of the others, every tilt is undecided
    and `unmapped` says how many there are. The same samples get the same maps whatever the machine's speed.

    `context`: the machine is not looked at.
    `verdicts`: what the cutter reaches without a machine.
    `part`: SHA-256 of the part's file.
    `inside` (n,) bool: samples that lie inside another body of the part.
    `shut` (n,) bool: samples that no cutter gets to, for they are held or lie within a fixture: no tilt is free there, nor in
        doubt.
    `missing`: obstacles that are missing or only guessed.
    `most`: samples to map, at most. None: as many as take `WORK`.
    """
    from plan_cutters.kernels.maps.free_map import free_map

    conditions, outer_tool, tool = context.conditions.without_machine(), context.outer_tool, context.outer
    rotations, ranges = conditions.postures.rotations, conditions.ranges
    possible, certain = conditions.obstacles, conditions.surroundings.certain
    contacts = contacts_of(samples)
    n, k = len(samples), len(rotations)
    count = np.zeros((n, k), np.int32)
    undecided = np.zeros((n, k), np.float32)
    free: dict[int, Floats] = {}

    def mapped(rows: NDArray[np.int64], obstacles: Obstacles) -> tuple[Floats, NDArray[np.int32], Floats, int]:
        part = np.empty((len(rows), k, _MOST_FREE, 2))
        mine, unsure = np.empty((len(rows), k), np.int32), np.empty((len(rows), k))
        tree, wide = obstacles.tree, obstacles.wide_tree
        looked = free_map(rows, contacts, ranges, tool, NARROWEST, tree, wide, _MOST_FREE, part, mine, unsure)
        if obstacles.solids.cell.size:
            _leave_bodies(samples, rows, outer_tool, rotations, obstacles, part, mine, certain=obstacles is not possible)
        return part, mine, unsure, looked

    def work(rows: NDArray[np.int64]) -> int:
        # Room for the most intervals only while a piece is worked on: memory grows with what is found.
        part, mine, unsure, looked = mapped(rows, possible)
        if certain is not possible:
            # What is only perhaps in the way forbids nothing for sure.
            perhaps, few, more, again = mapped(rows, certain)
            looked += again
            unsure = np.maximum(unsure, _width(perhaps, few) + more - _width(part, mine))
        count[rows], undecided[rows] = mine, unsure
        free[int(rows[0])] = part[np.arange(_MOST_FREE) < mine[..., None]]
        return int(looked)

    judged = np.flatnonzero(samples.unjudged < 0 if shut is None else (samples.unjudged < 0) & ~shut)
    require_finite(contacts, judged)
    rows = chosen(judged, most, lambda piece: mapped(piece, possible)[3], conditions.jobs)
    in_chunks(work, rows, conditions.jobs, progress)
    remaining = np.setdiff1d(judged, rows)
    undecided[remaining] = conditions.postures.tilt[1] - conditions.postures.tilt[0]
    pieces = [free[first] for first in sorted(free)]
    offset = np.concatenate([[0], np.cumsum(count.ravel(), dtype=np.int64)])
    return PostureMaps(rotations, offset, np.concatenate([np.zeros((0, 2)), *pieces]), undecided, samples.normal,
                       samples.direction_max, verdicts.verdict, verdicts.reason, conditions.postures.tilt, conditions.tolerance,
                       context.cutter.id, part, np.zeros(n, bool) if inside is None else inside, missing,
                       len(remaining))  # fmt: skip


def _width(part: Floats, count: NDArray[np.int32]) -> Floats:
    """Width (m, k) of intervals (m, k, room, 2), of each cell so many, rad."""
    # What lies beyond the count was never written.
    there = np.arange(_MOST_FREE) < count[..., None]
    return np.asarray(np.subtract(part[..., 1], part[..., 0], out=np.zeros(there.shape), where=there).sum(axis=-1))


def _leave_bodies(
    samples: SurfaceSamples, rows: NDArray[np.int64], outer_tool: Assembly, rotations: Floats, obstacles: Obstacles, part: Floats,
    count: NDArray[np.int32], *, certain: bool,
) -> None:  # fmt: skip
    """Take out intervals (m, k, room, 2) in which the cutter lies within a body, or may; or only where it surely does.

    Between the ends of an interval the cutter touches no skin, so it lies within a body all along or nowhere.
    """
    at = np.argwhere(np.arange(_MOST_FREE) < count[..., None])
    row, turn = rows[at[:, 0]], rotations[at[:, 1]]
    tilt = part[at[:, 0], at[:, 1], at[:, 2]].mean(axis=1)
    normal = samples.normal[row]
    tilt_directions = tilt_direction(normal, samples.direction_max[row], turn)
    inside = obstacles.holds(outer_tool, samples.point[row], normal, tilt_directions, tilt, certain=certain)
    for i, j in np.unique(at[inside, :2], axis=0).tolist():
        mine = (at[:, 0] == i) & (at[:, 1] == j)
        outside = part[i, j, : count[i, j]][~inside[mine]]
        part[i, j, : len(outside)], count[i, j] = outside, len(outside)
