"""Where does a vise or chuck grip a part in a setup? What it may grip is compared by how little of the target faces it hides.

All is looked at in a frame of the setup: z along the setup axis, counted from the part's lowest point.
"""

import math
from collections.abc import Callable, Collection, Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np

from cad_io.arrays import Floats, Record, rows_by_face
from plan_cutters.domain.clamping import (
    VISE, VISES, Chuck, Clamping, Requested, Vise, chuck_about, largest_gripped, vises_for,
)  # fmt: skip
from plan_cutters.domain.fixture import Fixture
from plan_cutters.domain.placement import axis_words, frame_of
from plan_cutters.errors import FixtureError
from plan_cutters.plan_file.numbers import listed, mm
from plan_cutters.scene.holds import Hold

#: Faces that are off the setup axis, or off each other, by a smaller sine are parallel: 0.1 deg.
_PARALLEL = math.sin(math.radians(0.1))
#: Faces are in one plane, or on one cylinder, if they are no farther apart than this, mm.
_TOGETHER = 0.01
#: Of walls that may be gripped, and of places that may be taken, so many are looked at.
_WALLS, _TRIED = 300, 12
#: Shares of the target area that jaws hide are equal if they differ by less.
_EVEN = 0.01
#: Of what jaws may touch at a place, this share has to be there, and of the part's length along them this share of a jaw's width.
_TOUCHED, _ALONG = 0.2, 0.5
#: Jaws of a chuck are turned by so many degrees to find their best place; what they touch is told apart by one degree.
_TURN, _BINS = 5, 360
#: Arcs of fewer degrees do not tell their cylinder.
_ARC = 20


@dataclass(frozen=True, eq=False, repr=False)
class Workpiece(Record):
    """A part as it stands in a setup, as far as clamping it matters.

    Attributes
    ----------
    frame : (3, 3) float
        The setup's x, y and z in part coordinates, as rows.
    lowest : float
        Height of the part's lowest point along z, mm.
    vertex : (n, 3, 3) float
        Triangles in that frame, z from the lowest point, mm.
    normal : (n, 3) float
        Outward normals of them, as long as twice their area.
    face : (n,) int
        Face numbers of them.
    planes : set of int
        Planar faces.
    targets : set of int
        Faces to machine.
    flat : float
        Heights that differ by less are one, mm.
    """

    frame: Floats
    lowest: float
    vertex: Floats
    normal: Floats
    face: Floats
    planes: frozenset[int]
    targets: frozenset[int]
    flat: float

    @classmethod
    def of(
        cls, vertex: Floats, face: Floats, sign: Floats, planes: Collection[int], targets: Collection[int], setup: Sequence[float]
    ) -> "Workpiece":
        """A part's triangles (n, 3, 3) of faces (n,) in a setup; `sign` (faces,): side of each face that is out of the material.

        Without targets, all faces are.
        """
        frame = frame_of(np.asarray(setup, float))
        local = vertex @ frame.T
        lowest = float(local[..., 2].min())
        local = local - np.array([0.0, 0.0, lowest])
        normal = np.cross(local[:, 1] - local[:, 0], local[:, 2] - local[:, 0]) * sign[face - 1][:, None]
        flat = 1e-6 * float(np.linalg.norm(np.ptp(vertex, axis=(0, 1)))) + 1e-6
        wanted = frozenset(targets) or frozenset(np.unique(face).tolist())
        return cls(frame, lowest, local, normal, face, frozenset(planes), wanted, flat)

    @property
    def area(self) -> float:
        """Of the target faces, mm2."""
        mine = np.isin(self.face, list(self.targets))
        return 0.5 * float(np.linalg.norm(self.normal[mine], axis=1).sum())

    def rests_on(self, height: float) -> tuple[int, ...]:
        """Numbers of the planar faces that look down at a height."""
        low = (self.vertex[..., 2] <= height + self.flat).all(axis=1) & (self.vertex[..., 2] >= height - self.flat).all(axis=1)
        return tuple(int(n) for n in np.unique(self.face[low & (self.normal[:, 2] < 0.0)]) if int(n) in self.planes)


@dataclass(frozen=True, slots=True, eq=False)
class _Wall:
    """Faces of one upright plane or cylinder: their numbers and triangles, and heights between which they lie."""

    faces: tuple[int, ...]
    vertex: Floats
    face: Floats
    normal: Floats
    low: float
    high: float


@dataclass(frozen=True, slots=True, eq=False)
class _Place:
    """A vise or chuck at a place of a setup's frame, and what it grips there; `order`: what comes first is taken first."""

    clamping: Clamping
    x: Floats
    origin: Floats
    grips: tuple[int, ...]
    touched: float
    hidden: float
    above: float


def held(fixture: Fixture, part: Workpiece, overlaps: Callable[[Fixture], bool]) -> Hold:
    """Place a vise or chuck.

    Parameters
    ----------
    fixture : Fixture
        With `to_place`.
    part : Workpiece
    overlaps : callable
        Whether a fixture in its place stands in the part.

    Raises
    ------
    FixtureError
        There is nothing that it can grip, in a line that says why and what to try.
    """
    asked = fixture.grips
    if asked is None:
        raise FixtureError(f"{fixture} is for --setup auto, which takes the best of table, vise and chuck; name one of them")
    places, why = _vise_places(part, asked) if asked.kind == VISE else _chuck_places(part, asked)
    least, step = min((each.hidden for each in places), default=0.0), _EVEN * max(1e-300, part.area)
    places.sort(
        key=lambda each: (int((each.hidden - least) / step), each.above > 0.0, -round(each.touched, 6), each.grips, each.above)
    )
    for place in places[:_TRIED]:
        placed = _fixture(fixture, part, place)
        if not overlaps(placed):
            return _hold(asked, placed, part, place)
    if places:
        why = "something of the part is in the way of the jaws wherever they could grip"
    raise FixtureError(
        f"{fixture}: nothing to grip with the setup axis {axis_words(part.frame[2].tolist())}: {why}; try another setup, "
        f"--fixture {'chuck' if asked.kind == VISE else 'vise'} or table, or a file of your own fixture"
    )


def _fixture(fixture: Fixture, part: Workpiece, place: _Place) -> Fixture:
    """The vise or chuck in its place, exactly as its text says it."""
    x = place.x @ part.frame
    axes = np.stack([x, np.cross(part.frame[2], x), part.frame[2]], axis=1)
    origin = (place.origin + np.array([0.0, 0.0, part.lowest])) @ part.frame
    where = (*np.round(origin, 9).tolist(), *np.round(_angles(axes), 9).tolist())
    written = Fixture(place.clamping.word, tuple(each + 0.0 for each in where)).text
    return replace(Fixture.parse(written), name=fixture.name)


def _angles(axes: Floats) -> Floats:
    """Turns about the fixed x, y and z axis, deg, that bring x, y and z to the columns of a matrix (3, 3)."""
    tilt = math.asin(max(-1.0, min(1.0, -axes[2, 0])))
    if abs(axes[2, 0]) > 1.0 - 1e-12:
        angles = (0.0, tilt, math.atan2(-axes[0, 1], axes[1, 1]))
    else:
        angles = (math.atan2(axes[2, 1], axes[2, 2]), tilt, math.atan2(axes[1, 0], axes[0, 0]))
    return np.degrees(angles)


def _hold(asked: Requested, fixture: Fixture, part: Workpiece, place: _Place) -> Hold:
    clamping, names = place.clamping, [f"F{n}" for n in place.grips]
    size = "" if asked.sizes is not None else ", the smallest usual size that takes the part"
    across = f"{mm(clamping.gap or 0.0)} apart" if isinstance(clamping, Vise) else f"{mm(clamping.diameter or 0.0)} wide"
    above = f", from {mm(place.above)} above its lowest point," if place.above > 0.0 else ""
    left = (
        f"what the jaws cover of the faces to machine, {place.hidden:.4g} mm2, is left for another setup"
        if place.hidden > 0.0
        else "its jaws cover none of the faces to machine"
    )
    words = f"{clamping.called}{size}; it grips {listed(names)}, {across},{above} {mm(clamping.grip)} deep; {left}"
    return Hold(fixture, place.grips, part.rests_on(place.above), place.hidden, words)


# A vise.


def _vise_places(part: Workpiece, asked: Requested) -> tuple[list[_Place], str]:
    """Where a vise may grip, and why it may not if there is no such place."""
    walls = _upright_planes(part, max(each[1] for each in VISES) if asked.sizes is None else asked.sizes[1])
    places: list[_Place] = []
    apart: list[float] = []
    for i, one in enumerate(walls):
        for other in walls[i + 1 :]:
            if one.normal @ other.normal > -math.sqrt(1.0 - _PARALLEL * _PARALLEL):
                continue
            x = one.normal - other.normal
            x = x / np.linalg.norm(x)
            gap = float((one.vertex @ x).max() - (other.vertex @ x).min())
            if gap > 0.0:
                apart.append(gap)
                places += _between(part, asked, one, other, x)
    widest = max(each[2] for each in VISES) if asked.sizes is None else asked.sizes[2]
    if not apart:
        return places, "no two opposite plane faces stand along it near the bottom"
    if min(apart) > widest:
        return places, f"the nearest parallel faces are {mm(min(apart))} apart, and the vise opens to {mm(widest)}"
    return places, f"no two opposite plane faces lie side by side in the {mm(asked.grip)} that the jaws grip"


def _upright_planes(part: Workpiece, reach: float) -> list[_Wall]:
    """Upright planar faces that begin lower than a height, those of one plane together, the largest first."""
    walls: list[_Wall] = []
    for number, rows in rows_by_face(part.face.astype(np.int32)).items():
        if number not in part.planes:
            continue
        vertex, normal = part.vertex[rows], part.normal[rows].sum(axis=0)
        size = float(np.linalg.norm(normal))
        if size > 0.0 and abs(normal[2]) <= _PARALLEL * size and vertex[..., 2].min() < reach:
            flat = np.array([normal[0], normal[1], 0.0])
            walls.append(_wall([number], vertex, part.face[rows], flat / np.linalg.norm(flat)))
    walls.sort(key=lambda each: (-_area(each.vertex), each.faces))
    joined: list[_Wall] = []
    for wall in walls[:_WALLS]:
        same = next((k for k, each in enumerate(joined) if _one_plane(each, wall)), None)
        if same is None:
            joined.append(wall)
        else:
            joined[same] = _merged(joined[same], wall)
    return joined


def _one_plane(one: _Wall, other: _Wall) -> bool:
    if one.normal @ other.normal < math.sqrt(1.0 - _PARALLEL * _PARALLEL):
        return False
    return abs(float((one.vertex @ one.normal).max() - (other.vertex @ one.normal).max())) <= _TOGETHER


def _wall(faces: Sequence[int], vertex: Floats, face: Floats, normal: Floats) -> _Wall:
    return _Wall(tuple(faces), vertex, face, normal, float(vertex[..., 2].min()), float(vertex[..., 2].max()))


def _merged(one: _Wall, other: _Wall) -> _Wall:
    vertex, face = np.concatenate([one.vertex, other.vertex]), np.concatenate([one.face, other.face])
    return _wall(sorted({*one.faces, *other.faces}), vertex, face, one.normal)


def _between(part: Workpiece, asked: Requested, one: _Wall, other: _Wall, x: Floats) -> Iterator[_Place]:
    """Places of a vise on two walls: in the middle of what its jaws can touch, and at both ends of that."""
    grip, y = asked.grip, np.array([-x[1], x[0], 0.0])
    above = _above(max(one.low, other.low), grip)
    strips = [_clipped(each.vertex, each.face, np.array([0.0, 0.0, 1.0]), above, above + grip) for each in (one, other)]
    if not all(len(vertex) for vertex, _ in strips):
        return
    along = [(float((vertex @ y).min()), float((vertex @ y).max())) for vertex, _ in strips]
    start, end = max(low for low, _ in along), min(high for _, high in along)
    right, left = float((strips[0][0] @ x).max()), float((strips[1][0] @ x).min())
    vise = _vise(part, asked, right - left, float(np.ptp(part.vertex @ y)), above)
    if vise is None or not end - start > part.flat:
        return
    half = 0.5 * vise.width
    middles = [0.5 * (start + end), *([start + half, end - half] if end - start > vise.width else [])]
    for middle in middles:
        touched = [_clipped(vertex, face, y, middle - half, middle + half) for vertex, face in strips]
        least = min(_area(vertex) for vertex, _ in touched)
        if least < _TOUCHED * grip * min(vise.width, end - start):
            continue
        hidden = sum(_area(vertex[np.isin(face, list(part.targets))]) for vertex, face in touched)
        grips = tuple(sorted({int(n) for _, face in touched for n in face}))
        origin = 0.5 * (left + right) * x + middle * y + np.array([0.0, 0.0, above])
        yield _Place(vise, x, origin, grips, least, hidden, above)


def _above(low: float, grip: float) -> float:
    """How far above the part's lowest point it rests in the jaws, where what they grip begins at a height."""
    return 0.0 if low <= 0.5 * grip else low


def _vise(part: Workpiece, asked: Requested, gap: float, length: float, above: float) -> Vise | None:
    """The vise that was asked for, or the smallest that takes a part so long along its jaws; None where there is none."""
    vises = vises_for(gap) if asked.sizes is None else (Vise(*asked.sizes),)
    vises = tuple(replace(each, grip=asked.grip, gap=gap) for each in vises if each.height > asked.grip and each.opening >= gap)
    # What is below the faces that are gripped hangs between the jaws.
    vises = tuple(each for each in vises if above <= each.height - each.grip)
    wide = [each for each in vises if each.width >= _ALONG * length]
    return next(iter(wide), max(vises, key=lambda each: each.width, default=None))


# A chuck.


def _chuck_places(part: Workpiece, asked: Requested) -> tuple[list[_Place], str]:
    """Where a chuck may grip, and why it may not if there is no such place."""
    places, wide = list[_Place](), list[float]()
    for wall, centre, radius in _upright_cylinders(part):
        if 2.0 * radius > largest_gripped():
            wide.append(2.0 * radius)
            continue
        above = _above(wall.low, asked.grip)
        chuck = chuck_about(2.0 * radius, asked.grip)
        if asked.sizes is not None:
            chuck = Chuck(int(asked.sizes[0]), asked.sizes[1], asked.grip, 2.0 * radius)
        if above <= chuck.height - chuck.grip:
            places += _about(part, chuck, wall, centre, above)
    if wide and not places:
        return places, f"the cylinder is {mm(min(wide))} wide, and chucks grip up to {mm(largest_gripped())}"
    return places, f"no outside cylinder along it reaches all round in the lowest {mm(asked.grip)} of the part"


def _upright_cylinders(part: Workpiece) -> list[tuple[_Wall, Floats, float]]:
    """Upright outside cylinders, the faces of one together: each with its centre (3,) and the largest radius, mm."""
    found: list[tuple[_Wall, Floats, float]] = []
    for number, rows in rows_by_face(part.face.astype(np.int32)).items():
        if number in part.planes:
            continue
        vertex, normal = part.vertex[rows], part.normal[rows]
        if (np.abs(normal[:, 2]) > _PARALLEL * np.linalg.norm(normal, axis=1)).any():
            continue
        circle = _circle(vertex, normal)
        if circle is None:
            continue
        wall = _wall([number], vertex, part.face[rows], np.zeros(3))
        centre, radius = circle
        same = next((k for k, each in enumerate(found) if _one_cylinder(each, circle)), None)
        if same is None:
            found.append((wall, centre, radius))
        else:
            first, centre, known = found[same]
            found[same] = _merged(first, wall), centre, max(radius, known)
    return sorted(found, key=lambda each: (-each[2], each[0].faces))


def _one_cylinder(known: tuple[_Wall, Floats, float], circle: tuple[Floats, float]) -> bool:
    return abs(known[2] - circle[1]) <= _TOGETHER and float(np.linalg.norm(known[1] - circle[0])) <= _TOGETHER


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
    if radius - distance.min() > _TOGETHER or ((vertex.mean(axis=1)[:, :2] - middle - solved[:2]) * normal[:, :2]).sum() <= 0.0:
        return None
    turns = np.unique(np.floor(np.degrees(np.arctan2(away[:, 1], away[:, 0]))))
    gaps = np.diff(np.append(turns, turns[0] + 360.0))
    if 360.0 - float(gaps.max()) < _ARC:
        return None
    return np.array([*(middle + solved[:2]), 0.0]), radius


def _about(part: Workpiece, chuck: Chuck, wall: _Wall, centre: Floats, above: float) -> Iterator[_Place]:
    """Places of a chuck on a cylinder: its jaws turned to all sides where each of them touches."""
    vertex, face = _clipped(wall.vertex, wall.face, np.array([0.0, 0.0, 1.0]), above, above + chuck.grip)
    if not len(vertex) or chuck.diameter is None:
        return
    touched = _around(vertex, centre)
    hidden = _around(vertex[np.isin(face, list(part.targets))], centre)
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
        yield _Place(chuck, x, centre + np.array([0.0, 0.0, above]), wall.faces, float(touched[mine].sum()) * degree, shown, above)


def _around(vertex: Floats, centre: Floats) -> Floats:
    """Which degrees (360,) about an upright axis triangles (n, 3, 3) take: 1 or 0."""
    taken = np.zeros(_BINS)
    away = vertex - centre
    angle = np.degrees(np.arctan2(away[..., 1], away[..., 0]))
    angle = angle[:, :1] + (angle - angle[:, :1] + 180.0) % 360.0 - 180.0
    for low, high in zip(angle.min(axis=1), angle.max(axis=1), strict=True):
        taken[np.arange(math.floor(low + 0.5), max(math.floor(high + 0.5), math.floor(low + 0.5) + 1)) % _BINS] = 1.0
    return taken


# Triangles.


def _area(vertex: Floats) -> float:
    return 0.5 * float(np.linalg.norm(np.cross(vertex[:, 1] - vertex[:, 0], vertex[:, 2] - vertex[:, 0]), axis=1).sum())


def _clipped(vertex: Floats, face: Floats, direction: Floats, low: float, high: float) -> tuple[Floats, Floats]:
    """What of triangles (n, 3, 3) of faces (n,) lies between two heights along a direction, as triangles."""
    for way, limit in ((direction, low), (-direction, -high)):
        vertex, face = _beyond(vertex, face, way, limit)
    return vertex, face


def _beyond(vertex: Floats, face: Floats, direction: Floats, limit: float) -> tuple[Floats, Floats]:
    """What of triangles lies above a height along a direction."""
    height = vertex @ direction - limit
    count = (height > 0.0).sum(axis=1)
    parts, faces = [vertex[count == 3]], [face[count == 3]]
    for number in (1, 2):
        some, tall = vertex[count == number], height[count == number]
        # The corner that is alone on its side comes first.
        alone = np.argmax(tall > 0.0, axis=1) if number == 1 else np.argmax(tall <= 0.0, axis=1)
        a, b, c = (np.take_along_axis(some, ((alone + k) % 3)[:, None, None], axis=1)[:, 0] for k in range(3))
        p, q, r = (np.take_along_axis(tall, ((alone + k) % 3)[:, None], axis=1) for k in range(3))
        ab, ac = a + (b - a) * (p / (p - q)), a + (c - a) * (p / (p - r))
        pieces = [np.stack([a, ab, ac], axis=1)] if number == 1 else [np.stack([ab, b, c], axis=1), np.stack([ab, c, ac], axis=1)]
        parts += pieces
        faces += [face[count == number]] * len(pieces)
    return np.concatenate(parts), np.concatenate(faces)
