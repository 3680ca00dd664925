"""Contacts that lie under a flat of the tool or along its flank, where the corner of its outline need not touch.

A search puts the tool down with a corner of its outline at the contact. A flat that lies on a face, and a flank that lies along
one, cut all that they lie on. The face may be off their direction: by the accuracy of the rotary axes, or by as much as all of
what lies on the flat, or along the flank, stays within the tolerance. Wherever the tool is put down so, all of it is tested
with the axis as it is given.
"""

import math
from collections.abc import Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray

from cad_io.arrays import Floats, Ints, cross
from plan_cutters.domain.kinematics import Kinematics
from plan_cutters.domain.shapes import Flank
from plan_cutters.domain.verdicts import ACCESSIBLE, AXIS_LIMIT, INACCESSIBLE, INSIDE, NO_REASON, UNDECIDED, VerdictBuffer
from plan_cutters.kernels.codes import BEYOND, PARALLEL
from plan_cutters.kernels.rows import Contacts, Tool
from plan_cutters.scene.conditions import Conditions, Context, rotations_of, search_postures, tilt_directions
from plan_cutters.scene.work import Progress, Work, in_chunks

Rows = NDArray[np.int64]
#: Tilts and rotations this close to an end of a range are on it, rad.
_WHOLE = 1e-9
#: Places of the axis that are nearer than this to what is certainly in the way are none, mm: no machine holds them.
_NO_PLACE = 1e-3
#: Curvatures of a plane at most, 1/mm.
_PLANE = 1e-9
#: Chord errors by which a flank is kept off a surface where it is not free on it: then a shank as wide, which may touch nothing,
#: is as free of the surface as of its triangles. It is half of the tolerance at most.
_AWAY = 2.0
#: Axes of a few contacts, at all rotations, are looked up in the machine together: so many at once.
_TOGETHER = 20_000


def search(
    contacts: Contacts, face: Ints, rows: Rows, context: Context, verdicts: VerdictBuffer, progress: Progress | None = None,
    *, fixed: bool = False, work: Work | None = None, brief: bool = False,
) -> None:  # fmt: skip
    """Search a posture for contacts as `search_postures` does, and then with a flat or a flank of the tool on them.

    `face` (n,) int32: numbers of the faces that they lie on. `rows`, `context`, `verdicts`, `progress`, `fixed`, `work`, `brief`:
    as for `search_postures`.
    """
    search_postures(contacts, rows, context, verdicts, progress, fixed=fixed, work=work, brief=brief)
    on_the_flat(contacts, rows[verdicts.not_reached[rows]], context, verdicts)
    on_the_flank(contacts, face, rows[verdicts.not_reached[rows]], context, verdicts)


def on_the_flat(contacts: Contacts, rows: Rows, context: Context, verdicts: VerdictBuffer) -> None:
    """Let contacts without a posture (m,) be cut by a flat of the tool, below or above its flutes, that lies on them.

    Its edge need not touch there: what the flat lies on is cut as well. Where that is not found, a contact is inaccessible only
    if it is proved that there is no place for the axis.

    `rows` (m,) int64: those for which `search_postures` has found no posture. `verdicts`: read and written.
    """
    conditions = context.conditions
    if not conditions.postures.full_turn:
        # Rotations that are limited say which side of the flat touches.
        return
    rows = rows[verdicts.reason[rows] != INSIDE]
    low, high = conditions.postures.tilt
    for tilt in (0.0, math.pi):
        if context.outer_tool.touching_at(tilt)[0] > 0.0 and low - _WHOLE <= tilt <= high + _WHOLE and len(rows):
            _on_flat(contacts, rows, tilt, context, verdicts)
            rows = rows[verdicts.not_reached[rows]]


def _on_flat(contacts: Contacts, rows: Rows, at: float, context: Context, verdicts: VerdictBuffer) -> None:
    """The same of the flat below, at tilt 0, or above, at pi."""
    from plan_cutters.kernels.material import MAYBE_INSIDE, SURELY_INSIDE
    from plan_cutters.kernels.search.flats_and_flanks import FORBIDDEN, PLACED, upright

    conditions, n = context.conditions, len(contacts.normal)
    along, (flat, rise) = math.cos(at), context.outer_tool.touching_at(at)
    axis = np.full((n, 3), np.nan)
    axis[rows] = along * contacts.normal[rows]
    off = np.flatnonzero(~conditions.allows(axis[rows]))
    axis[rows[off]] = _nearest(axis[rows[off]], conditions)
    # By how much the flat may lean and stay within the tolerance.
    most = max(conditions.accuracy, min(BEYOND, math.asin(min(1.0, conditions.tolerance / (2.0 * flat)))))
    near = _between(axis[rows], along * contacts.normal[rows]) <= most
    rows = rows[near & conditions.allows(axis[rows])]
    possible, certain = conditions.obstacles.solids, conditions.surroundings.certain.solids
    way, state = np.full((n, 3), np.nan), np.full(n, FORBIDDEN, np.int8)

    def tried(tool: Tool, solids: Any, within: float, apart: float, some: Rows) -> None:
        in_chunks(lambda piece: upright(piece, contacts, axis, tool, solids, within, apart, state, way), some, conditions.jobs)

    tried(context.outer, possible, MAYBE_INSIDE, 0.0, rows)
    free = rows[state[rows] == PLACED]
    normal, a = contacts.normal[free], axis[free]
    square = (along > 0.0) & (a == normal).all(axis=1)
    f = np.where(square[:, None], way[free], tilt_directions(a, normal, contacts.direction_max[free]))
    _take(free, a, f, contacts, context, verdicts)
    verdicts.tilt[free[square]] = 0.0
    # Elsewhere the tilt direction is that of the axis: it is put down at the contact from which it stands in the place.
    tilt, other = verdicts.tilt[free, None], ~square[:, None]
    across = np.cos(tilt) * f - np.sin(tilt) * normal
    shift = rise * (along * a - normal) + flat * (across - way[free])
    verdicts.shift[free] = np.where(other, shift, 0.0)
    rest = rows[(state[rows] != PLACED) & (verdicts.verdict[rows] == INACCESSIBLE)]
    tried(context.inner, certain, SURELY_INSIDE, _NO_PLACE, rest)
    verdicts.verdict[rest[state[rest] != FORBIDDEN]] = UNDECIDED


def on_the_flank(contacts: Contacts, face: Ints, rows: Rows, context: Context, verdicts: VerdictBuffer) -> None:
    """Let contacts without a posture (m,) be cut by a straight flank that lies along them, anywhere on its length.

    Of a contact that only the axis limit seemed to lose, the reason becomes that of the flank.

    `face` (n,) int32: numbers of the faces that they lie on. `rows` (m,) int64: those for which neither `search_postures` nor
    `on_the_flat` has found a posture. `verdicts`: read and written.
    """
    conditions = context.conditions
    rows = rows[verdicts.reason[rows] != INSIDE]
    low, high = conditions.postures.tilt
    hints = np.full((2, len(contacts.normal)), -1)
    for flank in context.outer_tool.flanks:
        if not low - _WHOLE <= flank.tilt <= high + _WHOLE:
            continue
        for at, axis, whole in _axes(contacts, face, rows, flank, conditions):
            mine = verdicts.not_reached[at]
            if mine.any():
                _on_flank(contacts, at[mine], axis[mine], flank, whole, context, verdicts, hints)
        rows = rows[verdicts.not_reached[rows]]


def _on_flank(
    contacts: Contacts, rows: Rows, axis: Floats, flank: Flank, whole: bool, context: Context, verdicts: VerdictBuffer,
    hints: Rows,
) -> None:  # fmt: skip
    """The same with one axis (m, 3) at each; where the `whole` wall is within the tolerance, it may be kept off by that.

    `hints` (2, n): triangles that were in the way at the axis before, or -1: of what surely is, and of what may be.
    """
    from plan_cutters.kernels.material import MAYBE_INSIDE, SURELY_INSIDE
    from plan_cutters.kernels.search.flats_and_flanks import FREE, NONE, along_flank

    conditions = context.conditions
    reason = np.full(len(rows), NO_REASON, np.uint8)
    shift = np.zeros((len(rows), 3))
    away = np.array([0.0, _AWAY * conditions.obstacles.triangles.chord_error, conditions.tolerance])[: 3 if whole else 2]

    def tried(tool: Tool, solids: Any, within: float, some: Rows, hint: NDArray[np.int64]) -> NDArray[np.int8]:
        state = np.full(len(rows), NONE, np.int8)

        def piece(which: Rows) -> int:
            at, result, moved, why = rows[which], np.zeros(len(which), np.int8), np.zeros((len(which), 3)), reason[which]
            known = hint[at]
            looked = along_flank(
                at, axis[which], contacts, (flank.mode, flank.length), away, tool, solids, within, result, moved, why, known
            )
            state[which], shift[which], reason[which], hint[at] = result, moved, why, known
            return int(looked)

        in_chunks(piece, some, conditions.jobs)
        return state

    def surely(some: Rows) -> NDArray[np.int8]:
        return tried(context.inner, conditions.surroundings.certain.solids, SURELY_INSIDE, some, hints[0])

    # What is surely in the way of the smaller tool leaves nothing to look for. Why the larger one does not stand is looked at
    # where only the axis limit seemed to lose the contact.
    inaccessible, unknown = verdicts.verdict[rows] == INACCESSIBLE, verdicts.reason[rows] == AXIS_LIMIT
    proved = inaccessible & ~unknown
    sure = surely(np.flatnonzero(proved))
    open_ = np.flatnonzero(~(proved & (sure == NONE)))
    hints[1, rows[unknown]] = -1
    state = tried(context.outer, conditions.obstacles.solids, MAYBE_INSIDE, open_, hints[1])
    free = state == FREE
    at = rows[free]
    f = tilt_directions(axis[free], contacts.normal[at], contacts.direction_max[at])
    _take(at, axis[free], f, contacts, context, verdicts)
    # It was put down in the mode of the flank's lower end: off its tilt, postures are in that of the other end.
    tool, normal, tilt = context.outer_tool, contacts.normal[at], verdicts.tilt[at, None]
    offset, rise, _, _, height = (tool.mode[flank.mode] - tool.mode[tool.at(verdicts.tilt[at])]).T[:, :, None]
    across = np.cos(tilt) * f - np.sin(tilt) * normal
    verdicts.shift[at] = shift[free] + rise * normal - offset * across - height * axis[free]
    blocked = np.flatnonzero(unknown & ~free)
    verdicts.reason[rows[blocked]] = reason[blocked]
    rest = blocked[inaccessible[blocked]]
    sure[rest] = surely(rest)[rest]
    verdicts.verdict[rows[inaccessible & ~free & (sure != NONE)]] = UNDECIDED


def _take(rows: Rows, axis: Floats, f: Floats, contacts: Contacts, context: Context, verdicts: VerdictBuffer) -> None:
    normal = contacts.normal[rows]
    verdicts.verdict[rows], verdicts.reason[rows] = ACCESSIBLE, NO_REASON
    verdicts.axis[rows], verdicts.tilt_direction[rows], verdicts.tilt[rows] = axis, f, _between(axis, normal)
    turn, steps = rotations_of(normal, contacts.direction_max[rows], f), len(context.conditions.ranges.rotation_cos)
    verdicts.rotation[rows] = np.rint(turn * (steps / (2.0 * np.pi))).astype(np.int32) % steps


def _axes(
    contacts: Contacts, face: Ints, rows: Rows, flank: Flank, conditions: Conditions
) -> Iterator[tuple[Rows, Floats, bool]]:
    """Axes that the machine holds with a flank along samples, in turn: some rows, an axis (3,) for each, and whether all of what
    lies along the flank there is within the tolerance of it.
    """
    normal = contacts.normal
    plane = (np.abs(contacts.curvature[rows]) <= _PLANE).all(axis=1)
    for k, axis in enumerate(_special(conditions)):
        off = _between(np.broadcast_to(axis, (len(rows), 3)), normal[rows]) - flank.tilt
        may = np.abs(off) <= BEYOND
        if k:
            # Up to the flank's own tilt its lower end was tried there; free-form faces hold some of these axes exactly.
            may &= (off > _WHOLE) & (plane | (off <= conditions.accuracy))
        at, off = rows[may], np.abs(off[may])
        whole = _wholly_along(contacts, face[at], at, axis, off, flank, conditions)
        for some, within in ((at[whole], True), (at[~whole & (off <= conditions.accuracy)], False)):
            yield (*_turned(some, np.broadcast_to(axis, (len(some), 3)), contacts, conditions), within)
    if flank.length <= 0.0:
        return
    # Along a flank the tool slides: at every axis that holds it exactly, not only at those where its corner touched in vain.
    cosine, sine = math.cos(flank.tilt), math.sin(flank.tilt)
    kinematics = None if conditions.kinematics is None else conditions.kinematics.turning()[0]
    if kinematics is not None and len(kinematics.direction) < 2:
        for axes in _at_angle(normal[rows], cosine, kinematics):
            yield (*_turned(rows, axes, contacts, conditions), True)
        return
    turns, n, e1 = conditions.postures.rotations.tolist(), normal[rows], contacts.direction_max[rows]
    e2, together = cross(n, e1), max(1, _TOGETHER // max(1, len(rows)))
    for some in (turns[k : k + together] for k in range(0, len(turns), together)):
        axes = np.stack([cosine * n + sine * (math.cos(turn) * e1 + math.sin(turn) * e2) for turn in some])
        held = conditions.allows(axes.reshape(-1, 3)).reshape(axes.shape[:2])
        yield from ((rows[its], each[its], True) for each, its in zip(axes, held, strict=True))


def _wholly_along(
    contacts: Contacts, face: Ints, rows: Rows, axis: Floats, off: Floats, flank: Flank, conditions: Conditions
) -> NDArray[np.bool_]:
    """At which samples (m,) the face that is off the tilt of a flank by so much, rad, leaves it by no more than the tolerance,
    from where it begins along the flank to where it ends.

    Of a face that is higher than flutes under a narrower neck, as much lies along them as they are long.
    """
    from plan_cutters.kernels.linear.sections import OneFace, extents

    whole = off <= _WHOLE
    open_ = np.flatnonzero(~whole)
    obstacles = conditions.obstacles
    for number in np.unique(face[open_]).tolist():
        mine, own = open_[face[open_] == number], OneFace(obstacles.tree, obstacles.faces, number)
        n = contacts.normal[rows[mine]]
        ruling = axis - (n @ axis)[:, None] * n
        ruling /= np.linalg.norm(ruling, axis=1)[:, None]
        low, high = np.empty((2, len(mine)))
        band = obstacles.triangles.chord_error + conditions.tolerance
        extents(contacts.point[rows[mine]], ruling, n, own, band, low, high)
        long = np.minimum(high - low, flank.length or np.inf)
        whole[mine] = long * np.sin(off[mine]) <= conditions.tolerance
    return whole


def _special(conditions: Conditions) -> Floats:
    """Tool axes (k, 3) along whose flanks surfaces may lie that are not quite at their tilt: that with all rotary axes at zero
    first, and, where fewer than two turn the tool, those that samples lean towards.
    """
    zero = conditions.setup if conditions.kinematics is None else conditions.kinematics.turning()[0].tool
    axes = np.concatenate([zero[None], conditions.ranges.rotary.aim])
    axes = axes[conditions.allows(axes)]
    return axes[[i for i, axis in enumerate(axes) if not (np.abs(axes[:i] - axis).max(axis=1, initial=0.0) < PARALLEL).any()]]


def _nearest(axis: Floats, conditions: Conditions) -> Floats:
    """Of the tool axes that the machine holds, or may hold, those nearest to some axes (m, 3)."""
    kinematics = conditions.kinematics
    if kinematics is None:
        return np.broadcast_to(conditions.setup, axis.shape)
    kinematics, _ = kinematics.turning()
    if len(kinematics.direction) != 1:
        return np.broadcast_to(kinematics.tool, axis.shape)
    direction = kinematics.direction[0]
    along = float(kinematics.tool @ direction)
    across = axis - (axis @ direction)[:, None] * direction
    length = np.linalg.norm(across, axis=1)[:, None]
    unit = across / np.maximum(length, PARALLEL)
    return np.where(length > PARALLEL, along * direction + math.sqrt(max(0.0, 1.0 - along**2)) * unit, kinematics.tool)


def _at_angle(normal: Floats, cosine: float, kinematics: Kinematics) -> Iterator[Floats]:
    """Axes (m, 3) of a machine with one axis that turns the tool, or none, at an angle to normals (m, 3), by its cosine."""
    if not len(kinematics.direction):
        at = np.abs(normal @ kinematics.tool - cosine) <= PARALLEL
        yield np.where(at[:, None], kinematics.tool, np.nan)
        return
    d = kinematics.direction[0]
    along = float(kinematics.tool @ d)
    u = kinematics.tool - along * d
    v = cross(d, u)
    middle, size = np.arctan2(normal @ v, normal @ u), np.hypot(normal @ u, normal @ v)
    with np.errstate(divide="ignore", invalid="ignore"):
        half = np.arccos((cosine - along * (normal @ d)) / size)
    for side in (-1.0, 1.0):
        turn = (middle + side * half)[:, None]
        yield along * d + np.cos(turn) * u + np.sin(turn) * v


def _turned(rows: Rows, axis: Floats, contacts: Contacts, conditions: Conditions) -> tuple[Rows, Floats]:
    """Those of some samples at which an axis (m, 3) is held, across the normal, and leans as the rotations requested let it."""
    known = np.isfinite(axis).all(axis=1)
    rows, axis = rows[known], axis[known]
    held = conditions.allows(axis) & (np.abs((axis * contacts.normal[rows]).sum(axis=1)) < math.cos(PARALLEL))
    if not conditions.postures.full_turn:
        first, last = conditions.postures.rotation
        f = tilt_directions(axis, contacts.normal[rows], contacts.direction_max[rows])
        turn = rotations_of(contacts.normal[rows], contacts.direction_max[rows], f)
        held &= np.remainder(turn - first + _WHOLE, 2.0 * np.pi) <= last - first + 2.0 * _WHOLE
    return rows[held], axis[held]


def _between(axis: Floats, normal: Floats) -> Floats:
    """Angles (m,) of unit vectors (m, 3), rad."""
    return np.asarray(np.arctan2(np.linalg.norm(cross(axis, normal), axis=1), (axis * normal).sum(axis=1)))
