"""Where a chuck may grip a part: on an upright outside cylinder near its bottom (`docs/operations_proof.md`, lemma K3)."""

import math
from collections.abc import Iterator

import numpy as np

from cad_io.arrays import Floats, rows_by_face
from plan_cutters.domain.clamping import Chuck, Requested, chuck_about, largest_gripped
from plan_cutters.domain.figures import mm
from plan_cutters.setups.gripped import on_ledges
from plan_cutters.setups.workpiece import (
    PARALLEL,
    TOGETHER,
    Place,
    Refused,
    Wall,
    Workpiece,
    area_of,
    clipped,
    merged,
    stands,
    wall_of,
)

#: Jaws of a chuck are turned by so many degrees to find their best place; what they touch is told apart by one degree.
_TURN, _BINS = 5, 360
#: Arcs of fewer degrees do not tell their cylinder.
_ARC = 20


def chuck_places(part: Workpiece, requested: Requested) -> tuple[list[Place], list[Refused]]:
    """Where a chuck may grip, and why it may not where a cylinder is no such place."""
    places, refused = list[Place](), list[Refused]()
    short = f"no outside cylinder along it reaches all round in the lowest {mm(requested.grip)} of the part"
    for wall, centre, radius in _upright_cylinders(part):
        result, why = list[Place](), short
        if 2.0 * radius > largest_gripped():
            why = f"the cylinder is {mm(2.0 * radius)} wide, and chucks grip up to {mm(largest_gripped())}"
        for above, reach in stands(wall.low, requested.grip) if 2.0 * radius <= largest_gripped() else ():
            chuck = chuck_about(2.0 * radius, reach)
            if requested.sizes is not None:
                chuck = Chuck(int(requested.sizes[0]), requested.sizes[1], reach, 2.0 * radius)
            if reach < chuck.height and above <= chuck.height - reach:
                result += _about(part, chuck, wall, centre, above)
        places += result
        if not result:
            refused.append(Refused((wall.low > 0.5 * requested.grip, -area_of(wall.vertex)), why))
    return places, refused if places or refused else [Refused((True, 0.0), short)]


def _upright_cylinders(part: Workpiece) -> list[tuple[Wall, Floats, float]]:
    """Upright outside cylinders, the faces of one together: each with its centre (3,) and the largest radius, mm."""
    cylinders: list[tuple[Wall, Floats, float]] = []
    for number, rows in rows_by_face(part.face).items():
        if number in part.planes:
            continue
        vertex, normal = part.vertex[rows], part.normal[rows]
        if (np.abs(normal[:, 2]) > PARALLEL * np.linalg.norm(normal, axis=1)).any():
            continue
        circle = _circle(vertex, normal)
        if circle is None:
            continue
        wall = wall_of([number], vertex, part.face[rows], np.zeros(3))
        centre, radius = circle
        same = next((k for k, each in enumerate(cylinders) if _one_cylinder(each, circle)), None)
        if same is None:
            cylinders.append((wall, centre, radius))
        else:
            first, centre, known = cylinders[same]
            cylinders[same] = merged(first, wall), centre, max(radius, known)
    return sorted(cylinders, key=lambda each: (-each[2], each[0].faces))


def _one_cylinder(known: tuple[Wall, Floats, float], circle: tuple[Floats, float]) -> bool:
    return abs(known[2] - circle[1]) <= TOGETHER and float(np.linalg.norm(known[1] - circle[0])) <= TOGETHER


def _circle(vertex: Floats, normal: Floats) -> tuple[Floats, float] | None:
    """Centre (3,) and radius of an upright outside cylinder on which triangles have their corners; None where there is none."""
    points = vertex.reshape(-1, 3)[:, :2]
    middle = points.mean(axis=0)
    own = points - middle
    solved, _, rank, _ = np.linalg.lstsq(np.column_stack([2.0 * own, np.ones(len(own))]), (own * own).sum(axis=1), rcond=None)
    if rank < 3:
        return None
    away = own - solved[:2]
    distance = np.linalg.norm(away, axis=1)
    radius = float(distance.max())
    if radius - distance.min() > TOGETHER or ((vertex.mean(axis=1)[:, :2] - middle - solved[:2]) * normal[:, :2]).sum() <= 0.0:
        return None
    turns = np.unique(np.floor(np.degrees(np.arctan2(away[:, 1], away[:, 0]))))
    gaps = np.diff(np.append(turns, turns[0] + 360.0))
    if 360.0 - float(gaps.max()) < _ARC:
        return None
    return np.array([*(middle + solved[:2]), 0.0]), radius


def _about(part: Workpiece, chuck: Chuck, wall: Wall, centre: Floats, above: float) -> Iterator[Place]:
    """Places of a chuck on a cylinder: its jaws turned to all sides where each of them touches."""
    vertex, face = clipped(wall.vertex, wall.face, np.array([0.0, 0.0, 1.0]), above, above + chuck.grip)
    if not len(vertex) or chuck.diameter is None:
        return
    touched = _degrees_of(vertex, centre)
    hidden = _degrees_of(vertex[np.isin(face, list(part.targets))], centre)
    grips = tuple(int(n) for n in np.unique(face))
    first = wall.vertex[0, 0] - centre
    start, half = math.degrees(math.atan2(first[1], first[0])), math.degrees(chuck.half_angle)
    degree = math.radians(1.0) * 0.5 * chuck.diameter * chuck.grip
    for turn in range(0, math.ceil(360 / chuck.jaws), _TURN):
        at = start + turn + 360.0 / chuck.jaws * np.arange(chuck.jaws)
        bins = [np.floor(np.arange(each - half, each + half, 1.0) % _BINS).astype(int) % _BINS for each in at]
        if min(touched[each].mean() for each in bins) < 0.5:
            continue
        mine = np.concatenate(bins)
        x = np.array([math.cos(math.radians(at[0])), math.sin(math.radians(at[0])), 0.0])
        shown = sum(2.0 * half / len(each) * float(hidden[each].sum()) for each in bins) * degree
        place = Place(
            chuck, x, centre + np.array([0.0, 0.0, above]), grips, float(touched[mine].sum()) * degree, shown, above,
            area_of(wall.vertex), float(np.linalg.norm((centre - part.middle)[:2])),
            float(np.linalg.norm((part.outline - centre)[:, :2], axis=1).max()),
        )  # fmt: skip
        if above > 0.0 or on_ledges(chuck, place.own(part.vertex[part.lowest_rows]), part.face[part.lowest_rows], part.flat):
            yield place


def _degrees_of(vertex: Floats, centre: Floats) -> Floats:
    """Which degrees (360,) about an upright axis triangles (n, 3, 3) take: 1 or 0."""
    taken = np.zeros(_BINS)
    away = vertex - centre
    angle = np.degrees(np.arctan2(away[..., 1], away[..., 0]))
    angle = angle[:, :1] + (angle - angle[:, :1] + 180.0) % 360.0 - 180.0
    for low, high in zip(angle.min(axis=1), angle.max(axis=1), strict=True):
        taken[np.arange(math.floor(low + 0.5), max(math.floor(high + 0.5), math.floor(low + 0.5) + 1)) % _BINS] = 1.0
    return taken
