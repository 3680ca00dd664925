"""Where a vise may grip a part, on two opposite upright planes near its bottom, and a chuck, on an upright outside cylinder there
(`docs/operations_proof.md`, lemma K3).
"""

import math
from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np

from cad_io.arrays import SIMPLE_KINDS, FaceInfo, Floats, rows_by_face
from plan_cutters.domain.clamping import CHUCK, GRIP, VISES, Chuck, Requested, Vise, chuck_about, largest_gripped, vises_for
from plan_cutters.domain.figures import listed, mm
from plan_cutters.setups.workpiece import (
    PARALLEL,
    TALL,
    TOGETHER,
    Place,
    Refused,
    Wall,
    Workpiece,
    area_of,
    clipped,
    merged,
    on_ledges,
    stands,
    wall_of,
)

#: Jaws of a chuck are turned by so many degrees to find their best place; what they touch is told apart by one degree.
_TURN, _BINS = 5, 360
#: Arcs of fewer degrees do not tell their cylinder; one that lies in jaws is as far above the part's lowest point at most, as a
#: share of what they grip.
_ARC, _LOWEST = 20, 0.1
#: Of a cylinder that is gripped deep, so much at most; a bar that lies is gripped so deep, mm, and by this share of its diameter
#: at least, if it is there.
_DEEP, LIES, _THIRD = 2.0 / 3.0, 20.0, 1.0 / 3.0
#: A bar that lies stands so many times as far out of a chuck as it is wide there, at most, if a tailstock supports it.
_OUT_OF_A_CHUCK = 30.0
#: What a chuck holds reaches so many times as far from its middle as what is gripped is wide, at most.
_REACHES = 2.5
_X, _Y, _Z = np.eye(3)
#: Jaws are higher than they grip by more than numbers are rounded, mm.
_HAIR = 1e-6


def chuck_places(part: Workpiece, requested: Requested, *, lying: bool = False) -> tuple[list[Place], list[Refused]]:
    """Where a chuck may grip, and why it may not where a cylinder is no such place; a part that is `lying` stands out of it
    freely."""
    places, refused = list[Place](), list[Refused]()
    short = f"no outside cylinder along it reaches all round in the lowest {mm(requested.grip)} of the part"
    for wall, centre, radius in _cylinders(part, np.eye(3)):
        result, why = list[Place](), short
        grips = [requested.grip]
        if requested.sizes is None and requested.grip == GRIP and part.targets.isdisjoint(wall.faces):
            # A pin that nobody machines is gripped deep, and some of it stays free below the part.
            grips.append(max(GRIP, min(2.0 * radius, _DEEP * (wall.high - wall.low))))
        elif requested.sizes is None and requested.grip == GRIP and lying:
            grips += [each for each in [_lies(radius, wall.high - wall.low)] if each > GRIP]
        if 2.0 * radius > largest_gripped():
            why, grips = f"the cylinder is {mm(2.0 * radius)} wide, and chucks grip up to {mm(largest_gripped())}", []
        for grip, (above, reach) in [(deep, each) for deep in grips for each in stands(wall.low, deep)]:
            chuck = chuck_about(2.0 * radius, reach)
            if requested.sizes is not None:
                chuck = Chuck(int(requested.sizes[0]), requested.sizes[1], reach, 2.0 * radius)
            # Jaws do not stand far over what they grip.
            there = min(wall.high, above + reach) - max(wall.low, above)
            if reach < chuck.height and above <= chuck.height - reach and there >= 0.5 * grip:
                result += _about(part, chuck, wall, centre, above, _OUT_OF_A_CHUCK if lying else TALL)
        places += result
        if not result:
            refused.append(Refused((wall.low > 0.5 * requested.grip, -area_of(wall.vertex)), why))
    return places, refused if places or refused else [Refused((True, 0.0), short)]


def _lies(radius: float, long: float) -> float:
    """How deep a cylinder of a bar that lies is gripped, mm; 0 where not even the least of it is there."""
    deep, least = min(LIES, 2.0 * radius, _DEEP * long), 2.0 * radius * _THIRD
    return deep if deep >= least else least if least < long else 0.0


def _cylinders(part: Workpiece, frame: Floats) -> list[tuple[Wall, Floats, float]]:
    """Outside cylinders of a part along the z of a frame (3, 3), its axes as rows, the faces of one together: each with its
    centre (3,) and the largest radius, mm.
    """
    cylinders: list[tuple[Wall, Floats, float]] = []
    for number, rows in rows_by_face(part.face).items():
        direction = part.rods.get(number)
        if direction is None or np.linalg.norm(np.cross(direction, frame[2])) > PARALLEL:
            continue
        vertex, normal = part.vertex[rows] @ frame.T, part.normal[rows] @ frame.T
        circle = _circle(vertex, normal)
        if circle is None:
            continue
        wall = wall_of([number], vertex, part.face[rows], np.zeros(3))
        centre, radius = circle
        same = next(
            (k for k, (_, at, known) in enumerate(cylinders)
             if abs(known - radius) <= TOGETHER and float(np.linalg.norm(at - centre)) <= TOGETHER), None
        )  # fmt: skip
        if same is None:
            cylinders.append((wall, centre, radius))
        else:
            first, centre, known = cylinders[same]
            cylinders[same] = merged(first, wall), centre, max(radius, known)
    return sorted(cylinders, key=lambda each: (-each[2], each[0].faces))


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


def _about(part: Workpiece, chuck: Chuck, wall: Wall, centre: Floats, above: float, most: float) -> Iterator[Place]:
    """Places of a chuck on a cylinder: its jaws turned to all sides where each of them touches; of what stands out of it no more
    than `most` times its width is held."""
    vertex, face = clipped(wall.vertex, wall.face, np.array([0.0, 0.0, 1.0]), above, above + chuck.grip)
    if not len(vertex) or chuck.diameter is None:
        return
    touched = _degrees_of(vertex, centre)
    hidden = _degrees_of(vertex[np.isin(face, list(part.targets))], centre)
    grips = tuple(int(n) for n in np.unique(face))
    first = wall.vertex[0, 0] - centre
    start, half = math.degrees(math.atan2(first[1], first[0])), math.degrees(chuck.half_angle)
    degree = math.radians(1.0) * 0.5 * chuck.diameter * chuck.grip
    tall, free = part.tall - above, part.tall - above - chuck.grip
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
            _too_tall(tall, chuck.diameter) if free > most * chuck.diameter else "",
        )  # fmt: skip
        if not place.soft and place.farthest > _REACHES * chuck.diameter:
            place = replace(place, soft=f"it reaches {mm(place.farthest)} from the middle of {mm(chuck.diameter)}")
        if above > 0.0 or on_ledges(chuck, place.own(part.vertex[part.lowest_rows]), part.face[part.lowest_rows], part.flat):
            yield place


def _too_tall(tall: float, wide: float) -> str:
    return f"it stands {mm(tall)} high on {mm(wide)}"


def _degrees_of(vertex: Floats, centre: Floats) -> Floats:
    """Which degrees (360,) about an upright axis triangles (n, 3, 3) take: 1 or 0."""
    taken = np.zeros(_BINS)
    away = vertex - centre
    angle = np.degrees(np.arctan2(away[..., 1], away[..., 0]))
    angle = angle[:, :1] + (angle - angle[:, :1] + 180.0) % 360.0 - 180.0
    for low, high in zip(angle.min(axis=1), angle.max(axis=1), strict=True):
        taken[np.arange(math.floor(low + 0.5), max(math.floor(high + 0.5), math.floor(low + 0.5) + 1)) % _BINS] = 1.0
    return taken


def ungripped(requested: Requested, faces: Sequence[FaceInfo], sign: Floats, axis: Floats, reach: float) -> str:
    """Why no faces of a part can be gripped along a setup axis (3,), by their shapes alone; empty where some may be.

    `sign` (faces,): side of each face that is out of the material. `reach`: how far the part is from the origin at most, mm.
    """
    # Planes that count as parallel may still come together so far from where they are known.
    upright, round_, lying, slack = list[tuple[Floats, float, float]](), False, False, 4.0 * PARALLEL * reach
    for face in faces:
        known = face.carrier
        if known is None and face.shape == "plane":
            return ""
        if known is None or known.direction is None:
            round_ |= face.shape not in SIMPLE_KINDS
            continue
        direction, side = np.array(known.direction), known.side * float(sign[face.number - 1])
        along = abs(float(direction @ axis))
        if face.shape == "plane" and along <= 2.0 * PARALLEL:
            upright.append((direction, float(direction @ known.point), side))
        round_ |= face.shape == "cylinder" and along >= 1.0 - PARALLEL and side >= 0.0
        lying |= face.shape == "cylinder" and along <= 2.0 * PARALLEL and side >= 0.0
    if requested.kind == CHUCK:
        return "" if round_ else "no outside cylinder along it"
    if lying:
        return ""
    widest, opposite = max(each[2] for each in VISES) if requested.sizes is None else requested.sizes[2], False
    for i, (one, first, side) in enumerate(upright):
        for other, second, its in upright[:i]:
            turn = float(one @ other)
            if abs(turn) < 1.0 - 2.0 * PARALLEL**2:
                continue
            way = math.copysign(1.0, turn)
            apart = first - way * second
            # The outer side of each looks away from the other.
            if side * apart >= -slack and its * way * apart <= slack:
                if abs(apart) - slack <= widest:
                    return ""
                opposite = True
    if opposite:
        return f"its opposite plane faces are farther apart than the {mm(widest)} to which the vise opens"
    return "no two opposite plane faces stand along it"


#: Walls that are looked at, at most, the largest of them.
_WALLS = 300
#: Of what jaws may touch at a place, this share has to be there, and of the part's length along them this share of a jaw's width.
_TOUCHED, _ALONG = 0.2, 0.5
#: A part stands at most so many times as high over the jaws as what they touch of it is long.
_TALL = 6.0
#: Plain jaws touch so much of the part's length along them, mm or as a share; less of its mean section between them is a lug.
_LONG, _LONG_SHARE, _LUG = 15.0, 1.0 / 3.0, 0.25


def vise_places(part: Workpiece, requested: Requested) -> tuple[list[Place], list[Refused]]:
    """Where a vise may grip, and why it may not where two opposite plane faces are no such place.

    Soft jaws that are bored to it hold a cylinder that lies across the setup axis on what they rest on.
    """
    walls = _upright_planes(part, max(each[1] for each in VISES) if requested.sizes is None else requested.sizes[1])
    places, refused = list[Place](), list[Refused]()
    for i, one in enumerate(walls):
        for other in walls[i + 1 :]:
            if one.normal @ other.normal > -math.sqrt(1.0 - PARALLEL * PARALLEL):
                continue
            x = one.normal - other.normal
            x = x / np.linalg.norm(x)
            if float((one.vertex @ x).max() - (other.vertex @ x).min()) > 0.0:
                low = max(one.low, other.low)
                each = [_at(part, requested, (one, other), x, above, reach) for above, reach in stands(low, requested.grip)]
                places += [place for result, _ in each for place in result]
                if not any(result for result, _ in each):
                    size, why = min(area_of(one.vertex), area_of(other.vertex)), next((why for _, why in each if why), "")
                    refused.append(Refused((low > 0.5 * requested.grip, -size), why))
    places += _lying(part, requested)
    if not places and not refused:
        refused = [Refused((True, 0.0), "no two opposite plane faces stand along it near the bottom")]
    return places, refused


def _lying(part: Workpiece, requested: Requested) -> Iterator[Place]:
    """Places of a vise across the outside cylinders that lie lowest, up to half of what it grips above their middle."""
    grip = requested.grip
    for direction in _lying_directions(part):
        x = np.array([direction[1], -direction[0], 0.0])
        own, length = np.stack([_Z, x, direction]), float(np.ptp(part.outline @ direction))
        for wall, centre, radius in _cylinders(part, own):
            radius = round(radius, 4)
            reach = radius + 0.5 * grip
            vise, _ = _vise(replace(requested, grip=reach), 2.0 * radius, length, 0.0)
            if vise is None or abs(centre[0] - radius) > _LOWEST * grip:
                continue
            halves = [clipped(wall.vertex, wall.face, way * _Y, way * centre[1], np.inf) for way in (1.0, -1.0)]
            strips = [clipped(*half, _X, reach - grip, reach)[0][..., 2] for half in halves]
            if not all(map(len, strips)):
                continue
            start, end = max(float(each.min()) for each in strips), min(float(each.max()) for each in strips)
            half = 0.5 * vise.width
            touched = min(vise.width, end - start)
            for at in [0.5 * (start + end), *([start + half, end - half] if end - start > vise.width else [])]:
                vertex, face = clipped(wall.vertex, wall.face, _Z, at - half, at + half)
                vertex, face = clipped(vertex, face, _X, -np.inf, reach)
                soft, origin = "", centre[1] * x + at * direction
                if touched < min(_LONG, _LONG_SHARE * length):
                    soft = f"they touch {mm(max(0.0, touched))} of its length"
                elif not abs(part.enclosed[1] @ direction - at) < half:
                    soft = "the middle of the part is not between them"
                elif part.tall > TALL * min(2.0 * radius, touched):
                    soft = _too_tall(part.tall, min(2.0 * radius, touched))
                if touched > part.flat:
                    yield Place(
                        replace(vise, bored=True), x, origin, tuple(int(n) for n in np.unique(face)), touched * grip,
                        area_of(vertex[np.isin(face, list(part.targets))]), 0.0, area_of(wall.vertex),
                        float(np.linalg.norm((origin - part.middle)[:2])), float(np.abs((part.outline - origin) @ x).max()),
                        soft,
                    )  # fmt: skip


def _lying_directions(part: Workpiece) -> list[Floats]:
    """Directions across the setup axis along which cylinders lie."""
    directions = list[Floats]()
    for _, axis in sorted(part.rods.items()):
        if abs(axis[2]) > PARALLEL:
            continue
        flat = np.round([axis[0], axis[1], 0.0], 6)
        flat = flat / np.linalg.norm(flat)
        if not any(abs(flat @ each) >= 1.0 - PARALLEL**2 for each in directions):
            directions.append(flat)
    return directions


def _upright_planes(part: Workpiece, reach: float) -> list[Wall]:
    """Upright planar faces that begin lower than a height, those of one plane together, the largest first."""
    walls: list[Wall] = []
    for number, rows in rows_by_face(part.face).items():
        if number not in part.planes:
            continue
        vertex, normal = part.vertex[rows], part.normal[rows].sum(axis=0)
        size = float(np.linalg.norm(normal))
        if size > 0.0 and abs(normal[2]) <= PARALLEL * size and vertex[..., 2].min() < reach:
            flat = np.array([normal[0], normal[1], 0.0])
            walls.append(wall_of([number], vertex, part.face[rows], flat / np.linalg.norm(flat)))
    walls.sort(key=lambda each: (-area_of(each.vertex), each.faces))
    joined: list[Wall] = []
    for wall in walls[:_WALLS]:
        same = next((k for k, each in enumerate(joined) if _one_plane(each, wall)), None)
        if same is None:
            joined.append(wall)
        else:
            joined[same] = merged(joined[same], wall)
    return joined


def _one_plane(one: Wall, other: Wall) -> bool:
    if one.normal @ other.normal < math.sqrt(1.0 - PARALLEL * PARALLEL):
        return False
    return abs(float((one.vertex @ one.normal).max() - (other.vertex @ one.normal).max())) <= TOGETHER


def _at(
    part: Workpiece, requested: Requested, walls: tuple[Wall, Wall], x: Floats, above: float, reach: float
) -> tuple[list[Place], str]:
    """Places of a vise on two walls, in the middle of what its jaws can touch, and at both ends of that; or why there is none.

    The part rests at a height over its lowest point, and the jaws reach so far above that.
    """
    one, other = walls
    grip, y = requested.grip, np.array([-x[1], x[0], 0.0])
    names = " and ".join(listed([f"F{n}" for n in wall.faces], 2) for wall in walls)
    apart = f"no two opposite plane faces lie side by side in the {mm(grip)} that the jaws grip"
    strips = [clipped(each.vertex, each.face, np.array([0.0, 0.0, 1.0]), above, above + reach) for each in walls]
    if not all(len(vertex) for vertex, _ in strips):
        return [], apart
    along = [(float((vertex @ y).min()), float((vertex @ y).max())) for vertex, _ in strips]
    start, end = max(low for low, _ in along), min(high for _, high in along)
    right, left = float((strips[0][0] @ x).max()), float((strips[1][0] @ x).min())
    if not end - start > part.flat:
        return [], apart
    vise, widest = _vise(replace(requested, grip=reach), right - left, float(np.ptp(part.outline @ y)), above)
    if vise is None:
        wide = f"{names} are {mm(right - left)} apart, and the vise opens to {mm(widest)}"
        return [], wide if right - left > widest else f"{names} begin too high above its lowest point for the jaws"
    half, size = 0.5 * vise.width, min(area_of(each.vertex) for each in walls)
    tall, bearing = part.tall, part.bearing(0.0, above)
    centre = part.enclosed[1]
    # A fillet or chamfer at the bottom edge is between the jaws, and they touch what begins above it.
    gripped = above + reach - max(above, one.low, other.low)
    lug = (right - left) * (end - start) < _LUG * part.section
    places, why = list[Place](), apart
    middles = [0.5 * (start + end), *([start + half, end - half] if end - start > vise.width else [])]
    for middle in middles:
        touched = [clipped(vertex, face, y, middle - half, middle + half) for vertex, face in strips]
        least = min(area_of(vertex) for vertex, _ in touched)
        if least < _TOUCHED * gripped * min(vise.width, end - start):
            continue
        long = least / gripped
        if tall - above - reach > _TALL * long:
            why = f"the part stands {mm(tall)} high, and jaws touch no more than {mm(long)} of its length"
            continue
        hidden = sum(area_of(vertex[np.isin(face, list(part.targets))]) for vertex, face in touched)
        grips = tuple(sorted({int(n) for _, face in touched for n in face}))
        origin = 0.5 * (left + right) * x + middle * y + np.array([0.0, 0.0, above])
        soft = ""
        if lug:
            soft = "what they grip is a lug"
        elif not (left < centre @ x < right and abs(centre @ y - middle) < half):
            soft = "the middle of the part is not between them"
        elif long < min(_LONG, _LONG_SHARE * float(np.ptp(part.outline @ y))):
            soft = f"they touch {mm(long)} of its length"
        elif not bearing.broad:
            soft = "hardly any plane of the part rests in them"
        elif tall - above > TALL * min(right - left, long):
            soft = _too_tall(tall - above, min(right - left, long))
        place = Place(
            vise, x, origin, grips, least, hidden, above, size, float(np.linalg.norm((origin - part.middle)[:2])),
            float(np.abs((part.outline - origin) @ x).max()), soft,
        )  # fmt: skip
        if above > 0.0 or on_ledges(vise, place.own(part.vertex[part.lowest_rows]), part.face[part.lowest_rows], part.flat):
            places.append(place)
        else:
            why = f"nothing of the part lies on the ledges of jaws at {names}"
    return places, why


def _vise(requested: Requested, gap: float, length: float, above: float) -> tuple[Vise | None, float]:
    """The vise that was requested, or the smallest that takes a part so long along its jaws, None where there is none; and how
    far it opens, or the widest of those that are sold, mm."""
    grip, vises = requested.grip, vises_for(gap) if requested.sizes is None else (Vise(*requested.sizes),)
    widest = max(each[2] for each in VISES) if requested.sizes is None else requested.sizes[2]
    vises = tuple(replace(each, grip=grip, gap=gap) for each in vises if each.height > grip + _HAIR and each.opening >= gap)
    # What is below the faces that are gripped hangs between the jaws.
    vises = tuple(each for each in vises if above <= each.height - each.grip)
    wide = [each for each in vises if each.width >= _ALONG * length]
    return next(iter(wide), max(vises, key=lambda each: each.width, default=None)), widest
