"""How deep the part reaches into a tool at one posture: looked for among the triangles, measured on the surface itself."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial

import numpy as np

from cad_io import Part
from cad_io.arrays import Floats, Record
from cad_io.errors import SampleError
from cad_io.sample import foot_on
from plan_cutters.domain.assembly import assembly
from plan_cutters.domain.cutter import Cutter
from plan_cutters.domain.verdicts import Verdicts
from plan_cutters.scene.conditions import tool_of
from plan_cutters.scene.obstacles import Obstacles

#: Points along each side of the grids in which the deepest one is looked for, rounds, and how much finer each is than the last.
_SIDE, _ROUNDS, _FINER = 21, 10, 0.2
#: The same on a surface.
_SIDE_ON, _ROUNDS_ON, _FINER_ON = 9, 9, 0.35
#: A triangle that is deeper by less than this share is not looked for.
_EXACT = 1e-3


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Deepest(Record):
    """The deepest point of what stands around a tool.

    Attributes
    ----------
    face : int
        Its face; negative for a fixture, as in `Surroundings.called`.
    triangle : int
        Of the obstacles.
    point : (3,) float
        On the surface, where it could be found there, else on the triangle.
    depth : float
        mm; negative outside the tool.
    """

    face: int
    triangle: int
    point: Floats
    depth: float


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

    Parameters
    ----------
    part : Part, optional
        Whose faces the obstacles are; without it the depth is that of triangles.
    obstacles : Obstacles
    cutter : Cutter
    contact, normal : (3,) float
    posture : Verdicts
        Of length one.
    guess : float
        A depth, mm, that something surely has, or nearly.
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
