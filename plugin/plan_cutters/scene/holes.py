"""Which holes of a part are for drills: the narrow ones, whose faces no mill has to reach."""

from collections.abc import Collection
from dataclasses import replace

import numpy as np

from cad_io.arrays import Floats
from cad_io.part.holes import Hole, holes
from plan_cutters.domain.drill import Drill
from plan_cutters.domain.placement import frame_of
from plan_cutters.domain.thread import thread_in, tolerance_in
from plan_cutters.library.raw_tool import Library
from plan_cutters.scene.preparation import Prepared
from plan_cutters.setups.workpiece import PartMesh


def with_holes(ready: Prepared) -> Prepared:
    """The same part with its holes for drills, and the samples in them, which no mill has to reach."""
    below, targets = ready.options.drill_below, {*ready.chosen.targets}
    if not below:
        return ready
    scene, surroundings = ready.scene, ready.conditions.surroundings
    near = (surroundings.alone or surroundings).certain
    key = scene.part.key, scene.orientation.sign, scene.ignored, near.triangles.vertex
    every = ready.cache.cached("holes", key, lambda: holes(scene.part, scene.orientation, near.triangles, scene.ignored))
    # What the planner's own steps name is milled by them.
    named = () if ready.options.process is None else ready.options.process.faces_named
    drills, least = made_of(ready.options.libraries), min((2.0 * each.radius for each in ready.cutters), default=np.inf)
    narrow = [
        for_drills(hole, below, drills, least)
        for hole in every
        if hole.diameter < below and (hole.bottom not in ("flat", "round") or hole.depth > _POINT * hole.diameter)
    ]
    mine = tuple(hole for hole in narrow if targets.intersection(hole.faces) and not {*named}.intersection(hole.faces))
    samples = ready.samples
    within = np.isin(samples.face, [n for hole in mine for n in hole.faces]) & (samples.unjudged < 0) & ~ready.inside_bodies
    return replace(ready, holes=mine, drilled=within) if mine else ready


def made_of(libraries: Collection[Library]) -> list[Drill]:
    """The tools for holes of all libraries, each once, in their order."""
    return [*{each.id: each for library in libraries for each in library.drills}.values()]


#: Height of the point of a drill of 118 deg, of its diameter: over a floor it makes no wall of a hole that is less deep.
_POINT = 0.5 / np.tan(np.deg2rad(59.0))


def for_drills(hole: Hole, below: float, drills: Collection[Drill] = (), least: float = np.inf) -> Hole:
    """A hole with those of its faces alone that no mill has to reach: those narrower than `below`, mm.

    A bottom that is no cone is milled. So is a counterbore with a floor that is no cone, if a mill is as narrow and none of the
    `drills` is a counterbore of its size; `least`: the diameter of the narrowest mill, mm.
    """
    milled, thread = {*(hole.floor if hole.bottom in ("flat", "round") else ())}, thread_in(hole.sizes, hole.diameter)
    for step in hole.steps:
        if thread is not None and thread.is_whole(step.diameter):
            continue
        fits = step.floor == "flat" and any(each.kind == "counterbore" and each.wide_as(step.diameter) for each in drills)
        if step.kind == "counterbore" and step.floor != "cone" and least <= step.diameter and not fits:
            milled |= {*step.faces}
    taken = [(n, wide) for n, wide in zip(hole.faces, hole.within, strict=True) if wide < below and n not in milled]
    return replace(hole, faces=tuple(n for n, _ in taken), within=tuple(wide for _, wide in taken))


def groups(each: Collection[Hole]) -> list[int]:
    """The group of each hole, from 1: those of one group are equal, and have one axis to the spindle."""
    firsts, result = list[Hole](), list[int]()
    for hole in each:
        number = next((k for k, other in enumerate(firsts) if alike(hole, other)), len(firsts))
        if number == len(firsts):
            firsts.append(hole)
        result.append(number + 1)
    return result


#: Lengths, mm, of holes that differ by less are equal; and angles, rad.
_LENGTH, _ANGLE = 0.01, np.deg2rad(0.1)


def alike(one: Hole, other: Hole) -> bool:
    """Whether two holes are equal but for their place."""
    sizes = [((each.diameter, each.depth), (each.cone,), each.countersink or (), each.counterbore or ()) for each in (one, other)]
    within = (_LENGTH, _LENGTH), (_ANGLE,), (_LENGTH, _ANGLE), (_LENGTH, _LENGTH)
    return (
        one.bottom == other.bottom
        and one.through == other.through
        and all(len(a) == len(b) and all(map(_near, a, b, most)) for a, b, most in zip(*sizes, within, strict=True))
        and bool(one.axis @ other.axis >= np.cos(_ANGLE))
        and all(of(one.sizes, one.diameter) == of(other.sizes, other.diameter) for of in (thread_in, tolerance_in))
    )


def _near(one: float | None, other: float | None, most: float) -> bool:
    return one is other if one is None or other is None else abs(one - other) <= most


#: Sides of a hole about its axis, of each of which the corner that is farthest out tells where the mouth lies.
_SIDES = 12


def slope_of(mesh: PartMesh, hole: Hole, axis: Floats) -> float:
    """How far what a tool enters a hole through leans from being square to its axis (3,), out of the hole, rad; 0 where the
    corners of the mouth do not tell.
    """
    vertex = mesh.vertex[np.isin(mesh.face, hole.faces)].reshape(-1, 3) - hole.place
    if not len(vertex):
        return 0.0
    x, y, height = frame_of(axis) @ vertex.T
    side = np.floor((np.arctan2(y, x) / (2.0 * np.pi) + 0.5) * _SIDES).astype(int) % _SIDES
    rim = [rows[height[rows].argmax()] for rows in (np.flatnonzero(side == k) for k in range(_SIDES)) if len(rows)]
    if len(rim) < _SIDES // 2:
        return 0.0
    slope = np.linalg.lstsq(np.column_stack([x[rim], y[rim], np.ones(len(rim))]), height[rim], rcond=None)[0]
    return float(np.arctan(np.hypot(slope[0], slope[1])))
