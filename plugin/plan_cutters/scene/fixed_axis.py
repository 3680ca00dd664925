"""Tool axes that stay as they are: where each serves, and the postures with it.

A machine that holds its rotary axes while it cuts (3+2) needs just that. Each axis is tested at each sample as a plan tests the
postures that it finds: what is served is proved to the same tolerance (`docs/operations_proof.md`, lemmas O10 and W3).
"""

from collections.abc import Iterator, Mapping
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from cad_io.arrays import Floats, Ints, SurfaceSamples
from plan_cutters.domain.control_words import ControlWords, control_words
from plan_cutters.domain.cutter import Cutter
from plan_cutters.domain.kinematics import Kinematics
from plan_cutters.domain.placement import Placement, frame_of
from plan_cutters.domain.verdicts import ACCESSIBLE, Verdicts, blank
from plan_cutters.scene.conditions import Conditions, Context, contacts_of, rotations_of
from plan_cutters.scene.work import Progress, in_chunks

#: Axes this close are one, rad; ends of ranges this close to a posture's are on it.
_SAME, _END = 1e-6, 1e-9
#: Tilts at which the bottom of a tool may as well lie across its axis, through the contact, rad: no control holds smaller ones.
FLAT = 1e-4
#: A chamfer lies along a flank that is off by this sine: 0.1 deg.
_ALONG = 2e-3
#: Rows of one axis that are tested together, and tests that a thread makes in one go.
_BLOCK, _AT_ONCE = 1024, 2048


def leaning(rows: NDArray[np.int64], axis: Floats, samples: SurfaceSamples, context: Context) -> NDArray[np.bool_]:
    """At which of some samples (m,) a cutter stands free with one axis (3,) that the machine holds, touching the sample itself.

    Not with the sample elsewhere under the flat of its tip, nor with its flank at a distance.
    """
    from plan_cutters.kernels.search.fixed_axis import LEANING

    way, _, _ = _tested(rows, np.asarray(axis)[None], samples, context, only_leaning=True, held=np.zeros(1, np.int64))
    return np.asarray(way[0] == LEANING)


def along_flank(normal: Floats, axis: Floats, cutter: Cutter) -> NDArray[np.bool_]:
    """At which unit normals (n, 3) a surface lies along the flank of a tapered cutter that is held with an axis (3,)."""
    return np.asarray(np.abs(normal @ axis - np.sin(cutter.taper)) <= _ALONG)


def served_by(
    rows: NDArray[np.int64], axes: Floats, samples: SurfaceSamples, context: Context, progress: Progress | None = None
) -> tuple[NDArray[np.bool_], int]:
    """At which of some samples (m,) a cutter stands free with each of some axes (k, 3).

    Returns `free` (k, m) bool; `made`: how many times the tool was put down.
    """
    way, made, _ = _tested(rows, axes, samples, context, progress)
    return way >= 0, made


def _tested(
    rows: NDArray[np.int64], axes: Floats, samples: SurfaceSamples, context: Context, progress: Progress | None = None, *,
    directions: bool = False, only_leaning: bool = False, held: NDArray[np.int64] | None = None,
) -> tuple[NDArray[np.int8], int, Floats]:  # fmt: skip
    """How a cutter stands at samples with axes (k, m), in the numbers of the kernel; how many times it was put down; and, if
    asked for, its tilt directions (k, m, 3). With `only_leaning` no other way is tried. `held`: the axes that the machine holds.
    """
    from plan_cutters.kernels.search.fixed_axis import served

    conditions, (low, high) = context.conditions, context.conditions.postures.tilt
    way = np.full((len(axes), len(rows)), -1, np.int8)
    tilt_direction = np.full((len(axes), len(rows) if directions else 0, 3), np.nan)
    held = np.flatnonzero(conditions.allows(axes)) if held is None else held
    if not len(held) or not len(rows):
        return way, 0, tilt_direction
    tool, solids, contacts = context.outer, conditions.obstacles.solids, contacts_of(samples)
    full_turn = conditions.postures.full_turn
    every = full_turn and not only_leaning
    about = max(FLAT, conditions.accuracy), conditions.tolerance if every else -1.0, every

    def tested(piece: NDArray[np.int64]) -> int:
        which, block = np.divmod(piece, blocks)
        boxes = 0
        for k, part in zip(held[which].tolist(), block.tolist(), strict=True):
            ends = slice(part * _BLOCK, (part + 1) * _BLOCK)
            count, looked = served(
                rows[ends], axes[k], contacts, low - _END, high + _END, about, tool, solids, way[k, ends], tilt_direction[k, ends]
            )
            made.append(count)
            boxes += int(looked)
        return boxes

    blocks = -(-len(rows) // _BLOCK)
    most = max(1, _AT_ONCE // min(_BLOCK, len(rows)))
    made: list[int] = []
    in_chunks(tested, np.arange(len(held) * blocks), conditions.jobs, progress, chunk=most)
    if not full_turn:
        for k in held.tolist():
            touched = np.flatnonzero(way[k] >= 0)
            turned = _turned(rows[touched], axes[k], samples, conditions)
            way[k, touched[~turned]] = -1
    return way, sum(made), tilt_direction


def _turned(rows: NDArray[np.int64], axis: Floats, samples: SurfaceSamples, conditions: Conditions) -> NDArray[np.bool_]:
    """At which samples (m,) an axis leans as the rotations that were requested let it."""
    first, last = conditions.postures.rotation
    turn = rotations_of(samples.normal[rows], samples.direction_max[rows], tilt_direction_of(rows, axis, samples))
    beyond = np.remainder(turn - first + _END, 2.0 * np.pi)
    return np.asarray((beyond <= last - first + 2.0 * _END) | (samples.normal[rows] @ axis > 1.0 - _SAME**2))


def tilt_direction_of(rows: NDArray[np.int64], axis: Floats, samples: SurfaceSamples) -> Floats:
    """Return the unit tilt directions (m, 3) of one axis at samples; `direction_max` where it is the normal."""
    normal = samples.normal[rows]
    tilt_direction = axis - (normal @ axis)[:, None] * normal
    length = np.linalg.norm(tilt_direction, axis=1)[:, None]
    return np.asarray(np.where(length > 1e-12, tilt_direction / np.maximum(length, 1e-300), samples.direction_max[rows]))


#: How near the axis of a posture is to one that is tried in its place, rad; and the least tilt, rad, of what slides.
_NEAR, _LEAST = 1e-5, 0.5


def slid(
    rows: NDArray[np.int64], axes: Floats, samples: SurfaceSamples, context: Context, searched: Verdicts
) -> Iterator[tuple[int, NDArray[np.int64], Floats]]:
    """Where a cutter stands free with a contact beside the sample, which lies on its flank or under its upper face all the same.

    A posture that a search has with nearly that axis (`searched`) says which contact is tried. What is under the flat of a tip
    serves without.
    Of each of some axes (k, 3) at which there are any: its number, which of the samples (m,), and from these to their contacts.
    """
    from plan_cutters.kernels.search.fixed_axis import LEANING

    tool = context.outer_tool
    some = np.flatnonzero(searched.reached[rows] & (searched.tilt[rows] > _LEAST))
    flanks = [each for each in tool.flanks if each.length > 0.0]
    some = some[searched.shift[rows[some]].any(axis=1) | (len(flanks) > 0)]
    if not len(some):
        return
    near = cKDTree(searched.axis[rows[some]]).query_ball_point(axes, _NEAR)
    for k in (k for k, each in enumerate(near) if each):
        which = some[np.array(near[k])]
        at = rows[which]
        normal, shift = samples.normal[at], searched.shift[at].copy()
        cosine = normal @ axes[k]
        ruling = axes[k] - cosine[:, None] * normal
        sine = np.linalg.norm(ruling, axis=1)
        tilt = np.arctan2(sine, cosine)
        for each in flanks:
            # It touched with the upper end of its flank: with this axis the lower end touches as well.
            upper = (np.abs(tilt - each.tilt) <= _NEAR) & (tool.at(searched.tilt[at]) > each.mode) & (tool.at(tilt) <= each.mode)
            shift[upper] -= each.length * ruling[upper] / sine[upper, None]
        moved = np.flatnonzero(shift.any(axis=1))
        there = replace(
            samples, point=samples.point[at[moved]] + shift[moved], normal=normal[moved],
            direction_max=samples.direction_max[at[moved]], curvature=samples.curvature[at[moved]],
        )  # fmt: skip
        free = moved[_tested(np.arange(len(moved)), axes[[k]], there, context, only_leaning=True)[0][0] == LEANING]
        if len(free):
            yield k, which[free], shift[free]


def held_at(axes: Floats, number: Ints, samples: SurfaceSamples, context: Context, searched: Verdicts | None = None) -> Verdicts:
    """Return the postures of samples that go with one of some axes each, as a search would write them.

    Where the tool stands free by none of these ways, it may have `slid` to another contact than the sample, as `searched` has it.

    Where the axis is the normal within the accuracy of the axes, and the cutter stands with the contact under the flat of its
    tip, the tilt is 0 and the tilt direction goes from the axis to the contact; 1 at the rim of the flat, shorter within. Where
    its flank stands along a wall, and keeps the tolerance from it, the tilt is a right angle and the tilt direction the axis,
    twice as long as others: all about `at_fixed_axis` samples.
    """
    from plan_cutters.kernels.search.fixed_axis import ALONG, LEANING, UPRIGHT

    verdicts = blank(len(number))
    for k, axis in enumerate(axes):
        rows = np.flatnonzero(number == k)
        every, _, directions = _tested(rows, axis[None], samples, context, directions=True)
        way, cosine = every[0], samples.normal[rows] @ axis
        across = np.linalg.norm(np.cross(samples.normal[rows], axis), axis=1)
        stands = (way > LEANING)[:, None]
        verdicts.axis[rows] = axis
        verdicts.tilt_direction[rows] = np.where(stands, directions[0], tilt_direction_of(rows, axis, samples))
        verdicts.tilt[rows] = np.select([way == UPRIGHT, way == ALONG], [0.0, 0.5 * np.pi], np.arctan2(across, cosine))
        verdicts.verdict[rows] = ACCESSIBLE
        blocked = rows[way < 0]
        for _, which, shift in slid(blocked, axis[None], samples, context, searched) if searched is not None else ():
            verdicts.shift[blocked[which]] = shift
    return verdicts.freeze()


def along(held: Verdicts) -> NDArray[np.bool_]:
    """Samples (n,) at which the flank stands along a wall, at a distance of the tolerance, as `held_at` writes them."""
    return np.asarray(np.linalg.norm(held.tilt_direction, axis=1) > 1.5)


def at_fixed_axis(samples: SurfaceSamples, held: Verdicts, tolerance: float) -> SurfaceSamples:
    """Samples as the tool takes them: with the axis for their normal where it stands upright; with the normal across the axis,
    and moved towards the tool by the tolerance, mm, where its flank stands along a wall.
    """
    upright = (held.tilt == 0.0)[:, None] & np.isfinite(held.axis)
    walls = along(held)[:, None]
    across = samples.normal - (samples.normal * held.axis).sum(axis=1)[:, None] * held.axis
    with np.errstate(invalid="ignore", divide="ignore"):
        across /= np.linalg.norm(across, axis=1)[:, None]
    return replace(
        samples,
        point=np.where(walls, samples.point + tolerance * across, samples.point),
        normal=np.where(upright, held.axis, np.where(walls, across, samples.normal)),
    )


def tilted_plane(
    conditions: Conditions, place: Placement | None, moved: Kinematics, axis: Floats, angle: Floats,
    own: Mapping[str, float] | None, other: Mapping[str, float] | None,
) -> tuple[Floats, Floats, ControlWords]:  # fmt: skip
    """The plane that a control turns to for a tool axis (3,): its origin (3,), mm, its x (3,), and its words.

    `moved`: the machine with what turns at `angle` (k,), rad. `own`, `other`: the angles by name, deg, and those of the other
    solution, if there is one.
    """
    origin = np.zeros(3) if place is None or place.origin is None else np.array(place.origin, float)
    x = frame_of(axis, moved.carried(conditions.frame[0], angle[None])[0])[0]
    words = control_words(conditions.frame, np.array([x, np.cross(axis, x), axis]), own, other)
    return origin, x, words
