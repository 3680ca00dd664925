"""How far a cutter keeps from the part and the fixtures at the postures found, and how deep the part reaches into it at one
posture.

A clearance is that between all of the tool above its working height (`domain.clearance`) and the true surface of everything
around it. A tool grown by a clearance and the chord error meets no triangle: then no point of the true surface is nearer than the
clearance. So what is told is proved, and never more than the true distance. A depth is looked for among the triangles, and
measured on the surface itself.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import partial

import numpy as np
from numpy.typing import NDArray

from cad_io import Part
from cad_io.arrays import Floats, Ints, Record, SurfaceSamples
from cad_io.errors import SampleError
from cad_io.sample import foot_on
from plan_cutters.domain.assembly import Assembly, assembly, grown, rungs
from plan_cutters.domain.cutter import Cutter
from plan_cutters.domain.standard_tools import relieved
from plan_cutters.domain.verdicts import UNJUDGED, Verdicts
from plan_cutters.kernels.codes import PART, SHANK
from plan_cutters.scene.conditions import Conditions, laid_tool_of, probed, tool_of
from plan_cutters.scene.obstacles import Obstacles

#: A face that leans so far against a tool axis at most is a wall: sine of 1 deg.
_WALL = 0.0175
#: Added to the chord error, mm, for rounding.
_ROUNDING = 1e-9


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Clearances(Record):
    """Of n samples at the postures found; where there is no posture nan and -1."""

    #: (n,) float: no more than the true clearance, mm, and within 2 % or 0.005 mm of it, unless the flutes' edges are nearest. At
    #: `domain.clearance.MOST` it is that or more.
    distance: Floats
    part: NDArray[np.int8]  #: (n,) int8: of the tool what is nearest: FLUTES, NECK, SHANK or HOLDER; -1 where nothing is near.
    #: (n,) int32: the face in the way if that part were a little larger, negative for a fixture (`Surroundings.called`); 0 for
    #: none.
    face: Ints


def clearances_over(
    samples: SurfaceSamples, cutter: Cutter, verdicts: Verdicts, setups: Sequence[Conditions], served_in: Ints | None
) -> Clearances:
    """The same over several setups: each posture among the obstacles of the setup that serves its sample, (n,) int32.

    A fixture that stands in another setup than the first has no number: its `face` is 0.
    """
    if served_in is None or all(each.surroundings is setups[0].surroundings for each in setups):
        return clearances(samples, cutter, verdicts, setups[0])
    n = len(samples)
    result = Clearances(np.full(n, np.nan), np.full(n, -1, np.int8), np.zeros(n, np.int32))
    for k, conditions in enumerate(setups):
        mine = served_in == k
        verdict = np.where(mine, verdicts.verdict, UNJUDGED).astype(np.uint8)
        there = clearances(samples, cutter, replace(verdicts, verdict=verdict), conditions)
        for name in ("distance", "part", "face"):
            value = getattr(there, name)
            getattr(result, name)[mine] = (np.maximum(value, 0) if name == "face" and k else value)[mine]
    return result


def clearances(samples: SurfaceSamples, cutter: Cutter, verdicts: Verdicts, conditions: Conditions) -> Clearances:
    """Clearance at every posture found.

    `verdicts`: what was found for it. All is unknown where an obstacle is missing or only guessed, for nothing
    could be proved, and of a bare cutter that is no longer than it is wide.
    """
    n, obstacles, steps = len(samples), conditions.obstacles, rungs(cutter)
    result = Clearances(np.full(n, np.nan), np.full(n, -1, np.int8), np.zeros(n, np.int32))
    rows = np.flatnonzero(verdicts.reached)
    if _unknown(cutter, conditions) or not len(rows):
        return result
    free, not_reached = np.full(n, -1), np.full(n, len(steps))
    nearest, part = np.full(n, -1, np.int32), np.full(n, -1, np.int8)
    while len(open_rows := rows[not_reached[rows] - free[rows] > 1]):
        middle = (free[open_rows] + not_reached[open_rows]) // 2
        for rung in np.unique(middle).tolist():
            mine = open_rows[middle == rung]
            made, triangle, which = _put_down(samples, verdicts, mine, cutter, float(steps[rung]), conditions)
            clear = triangle[mine] == -1
            free[mine[clear]], not_reached[mine[~clear]] = rung, rung
            met = mine[triangle[mine] >= 0]
            nearest[met], part[met] = triangle[met], made.piece[0, which[met], PART]
    # Even the tool itself may be met, within the tolerance: a barrel touches with its flank.
    result.distance[rows] = np.where(free[rows] >= 0, steps[np.maximum(free[rows], 0)], 0.0)
    result.part[rows] = part[rows]
    met = rows[nearest[rows] >= 0]
    result.face[met] = obstacles.faces[nearest[met]]
    return result


def least_clearance(samples: SurfaceSamples, cutter: Cutter, verdicts: Verdicts, conditions: Conditions) -> float:
    """Least clearance over the postures found, as `clearances` has it, with fewer probes; nan where there is none.

    What keeps clear of something once is not looked at again while another posture does not.
    """
    steps, reached = rungs(cutter), np.flatnonzero(verdicts.reached)
    if _unknown(cutter, conditions) or not len(reached):
        return float("nan")
    free, not_free = -1, len(steps)
    while not_free - free > 1:
        middle = (free + not_free) // 2
        _, triangle, _ = _put_down(samples, verdicts, reached, cutter, float(steps[middle]), conditions)
        met = reached[triangle[reached] != -1]
        if len(met):
            reached, not_free = met, middle
        else:
            free = middle
    return float(steps[free]) if free >= 0 else 0.0


def slid_along(
    samples: SurfaceSamples, cutter: Cutter, verdicts: Verdicts, conditions: Conditions, clearance: float
) -> tuple[list[int], float]:
    """Walls along which a shank slides that is as wide as the flutes that cut there, and the clearance with a relieved one, mm.

    `clearance`: the least one of the postures. No walls where that is more than the tolerance, something else than the shank is
    as near, or a relieved shank would not do.
    """
    neck = relieved(cutter) if clearance <= conditions.tolerance else None
    wider = 0.0 if neck is None else least_clearance(samples, neck, verdicts, conditions)
    # Half of what is ground off is more than what rounding takes.
    if neck is None or not wider > max(conditions.tolerance, 0.5 * (cutter.radius - neck.necks[0].radius)):
        return [], 0.0
    steps, rows = rungs(cutter), np.flatnonzero(verdicts.reached)
    made, triangle, which = _put_down(samples, verdicts, rows, cutter, float(steps[steps > clearance][0]), conditions)
    met = rows[triangle[rows] >= 0]
    near = conditions.obstacles.faces[triangle[met]]
    if not len(met) or near.min() <= 0 or (made.piece[0, which[met], PART] != SHANK).any():
        return [], 0.0
    # At a wall that is cut the edge of another face may be met first.
    wall = np.abs((samples.normal[met] * verdicts.axis[met]).sum(axis=1)) <= _WALL
    return np.unique(np.where(wall, samples.face[met], near)).tolist(), wider


def _unknown(cutter: Cutter, conditions: Conditions) -> bool:
    """Whether nothing can be said: an obstacle is only guessed, or nothing of the tool is above its working height."""
    return conditions.surroundings.doubtful or not grown(cutter, 0.0).piece.shape[1]


def _put_down(
    samples: SurfaceSamples, verdicts: Verdicts, rows: NDArray[np.int64], cutter: Cutter, distance: float, conditions: Conditions
) -> tuple[Assembly, Ints, Ints]:
    """The cutter grown by a distance, and what (n,) it meets at some samples, -1 for none, with which of its pieces."""
    made = grown(cutter, distance + conditions.obstacles.triangles.chord_error + _ROUNDING)
    # Arrays that may not be written are another type to the compiler: `probe` would be compiled once more for them.
    axis, tilt_direction = verdicts.axis.copy(), verdicts.tilt_direction.copy()
    contact = verdicts.contact(samples.point)
    return made, *probed(rows, contact, samples.normal, axis, tilt_direction, laid_tool_of(made), conditions)


#: Points along each side of the grids in which the deepest one is looked for, rounds, and how much finer each is than the last.
_SIDE, _ROUNDS, _FINER = 21, 10, 0.2
#: The same on a surface.
_SIDE_ON, _ROUNDS_ON, _FINER_ON = 9, 9, 0.35
#: A triangle that is deeper by less than this share is not looked for.
_EXACT = 1e-3


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Deepest(Record):
    """The deepest point of what stands around a tool."""

    face: int  #: Its face; negative for a fixture, as in `Surroundings.called`.
    triangle: int  #: Of the obstacles.
    point: Floats  #: (3,) float: on the surface, where it could be found there, else on the triangle.
    depth: float  #: mm; negative outside the tool.


def deepest_of(cutter: Cutter) -> float:
    """The largest depth that anything can have in a cutter and leave some of it, mm."""
    stages = [min(stage.radius, stage.upper_radius, 0.5 * stage.length) for _, _, stage in cutter.stages]
    return min(cutter.radius, 0.5 * cutter.length) * (1 - 1e-9) if not stages else max(cutter.radius, *stages) * (1 - 1e-9)


def deepest_on(triangle: Floats, depth: Callable[[Floats], Floats]) -> Floats:
    """The point of a triangle (3, 3) that is deepest in something: the best of a grid, and of ever finer ones about that."""
    corner, sides = triangle[0], triangle[1:] - triangle[0]
    line = np.linspace(-1, 1, _SIDE)
    grid = np.stack(np.meshgrid(line, line), axis=-1).reshape(-1, 2)
    best, width = np.zeros(2), 1.0
    for _ in range(_ROUNDS):
        share = np.vstack([best, best + width * grid])
        share = share[(share >= 0.0).all(axis=1) & (share.sum(axis=1) <= 1.0)]
        best, width = share[int(depth(corner + share @ sides).argmax())], _FINER * width
    return np.asarray(corner + best @ sides)


def deepest(
    part: Part | None, obstacles: Obstacles, cutter: Cutter, contact: Floats, normal: Floats, posture: Verdicts, guess: float
) -> Deepest | None:
    """Find the deepest point of the obstacles in a cutter at a contact; None if nothing is in it.

    `part`: whose faces the obstacles are; without it the depth is that of triangles. `contact`, `normal` (3,) float. `posture`:
    of length one. `guess`: a depth, mm, that something surely has, or nearly.
    """
    from plan_cutters.kernels.search.search import probe

    most = deepest_of(cutter)

    def beyond(points: Floats, depth: float) -> Floats:
        made = assembly(cutter, depth, depth)
        return made.depth(points, contact, normal, posture.tilt_direction[0], float(posture.tilt[0]))

    def depth_of(point: Floats, depth: float) -> float:
        # What lies d deep in what is left of a tool beyond a depth lies deeper than that by d, or more where pieces meet.
        for _ in range(_ROUNDS):
            step = float(beyond(point[None], depth)[0])
            depth = min(depth + step, most)
            if abs(step) < 1e-7:
                break
        return depth

    def met(depth: float) -> int:
        hit, there = (np.full(1, -1, np.int32), (contact[None], normal[None], posture.axis.copy(), posture.tilt_direction.copy()))
        tool = tool_of(assembly(cutter, depth, depth))
        probe(np.zeros(1, np.int64), *there, tool, obstacles.tree, hit, hit.copy())
        return int(hit[0])

    error = obstacles.triangles.chord_error
    depth, triangle, point = guess, met(guess), contact
    while triangle < 0 and depth > 0.1 * guess:
        depth *= 0.5
        triangle = met(depth)
    if triangle < 0:
        return None
    deepest_triangle = triangle
    while deepest_triangle >= 0:
        triangle, reached = deepest_triangle, depth
        point = deepest_on(obstacles.tree.corners(triangle), partial(beyond, depth=reached))
        depth = max(depth_of(point, reached), reached)
        deepest_triangle = met(depth * (1.0 + _EXACT) + 1e-9) if depth < most else -1
        depth = depth * (1.0 + _EXACT) + 1e-9 if deepest_triangle >= 0 else depth
    face = obstacles.face(triangle)
    if part is not None and 0 < face <= len(part.faces):
        corner = obstacles.tree.corners(triangle)
        side = float(np.linalg.norm(corner - np.roll(corner, 1, axis=0), axis=1).max())
        shallow = max(depth - 2.0 * error, 0.5 * depth)
        foot = _foot(part, face, point, side, 4.0 * error + 1e-6, partial(beyond, depth=shallow))
        point = point if foot is None else foot
    return Deepest(face, triangle, point, depth_of(point, depth))


def _foot(part: Part, face: int, point: Floats, size: float, within: float, depth: Callable[[Floats], Floats]) -> Floats | None:
    """The point of a face itself that is deepest in something, near a point of one of its triangles; None if it is not found."""
    try:
        foot, trim = foot_on(part, face, point, within), part.trim(face)
    except SampleError:
        return None
    if foot is None or trim is None:
        return None
    surface, best, line = part.surface(face), np.array(foot), np.linspace(-1, 1, _SIDE_ON)
    place = surface.values(*best[:, None])[0]
    width = size / trim.scale
    for _ in range(_ROUNDS_ON):
        u, v = best[0] + width[0] * line, best[1] + width[1] * line
        inside = trim.inside_grid(u, v, border=False)  # the kernel is slow, and a chord error does not matter here
        at = np.stack(np.meshgrid(u, v, indexing="ij"), axis=-1)[inside]
        if len(at):
            points = surface.values(at[:, 0].copy(), at[:, 1].copy())
            points = np.vstack([place, points[np.isfinite(points).all(axis=1)]])
            which = int(depth(points).argmax())
            if which:
                best, place = at[np.isfinite(points[1:]).all(axis=1)][which - 1], points[which]
        width = _FINER_ON * width
    return np.asarray(place)
