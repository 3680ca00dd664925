"""Holes of a part by rule: cylinders that turn more than half a turn with air inside, and what lies about the same axis.

A hole is known by its narrowest cylinder. Faces next to it that are turned about its axis with air inside belong to it: its
bottom (a plane, a cone, a sphere, or a torus that rounds the corner), countersinks, and counterbores with their floors. Faces of
one cylinder count as one wall, whether they share edges, only touch, or are parted by another hole that crosses. Nothing stands
in a hole: lines along its axis meet no face between its ends, and whatever ends it is a bottom that is known, or a hole that it
crosses. So pockets with islands, slots, fillets, bosses, pipes with bends, and walls of closed cavities are none.
"""

from collections import Counter, defaultdict
from collections.abc import Callable, Collection, Iterable, Iterator, Sequence
from dataclasses import dataclass, field
from functools import cache, cached_property, partial
from typing import Any, Literal, NamedTuple

import numpy as np
from numpy.typing import NDArray

from cad_io.arrays import FaceInfo, Floats, Orientation, Record, SizeNote, Triangles
from cad_io.graphs import connected
from cad_io.kernel import may_refuse
from cad_io.part.lines import met, square_to

#: Lengths that differ by less are equal: of the part's size, and of a radius, whichever is more.
_SAME, _OF_RADIUS = 1e-5, 1e-3
#: Sines of angles between axes that are one direction.
_PARALLEL = 1e-4
#: A wall turns by more than half a turn, rad: its largest gap is less than this.
_GAP = np.pi - np.deg2rad(1.0)
#: Share of a full turn that the area of a wall comes to over its length, at least: slanted ends take some of it.
_TURNED = 0.3
#: Points along a piece of a border that is the border itself, and along a chord of one.
_ALONG, _CHORD = 32, 1
#: Lines that look along a hole: shares of its radius from the axis, on which triangles may meet, and turns about it, rad.
_LINES = ((0.07, 1.1), (0.6, 0.3), (0.6, 1.9), (0.6, 3.4), (0.6, 5.0))
#: Turn from a line to the next one of three, rad.
_TURN = 0.4
#: A line that leaves a hole looks so many radii further for a bottom that is not known.
_DEEP = 2.0
_Bottom = Literal["flat", "cone", "round", "open"]
_TURNED_KINDS = ("cylinder", "cone", "torus", "sphere")


@dataclass(frozen=True, slots=True)
class Step:
    """A countersink or a counterbore of a hole. Its heights are depths under the mouth of the hole, mm."""

    kind: Literal["countersink", "counterbore"]
    faces: tuple[int, ...]  #: Numbers of its faces, with its floor.
    diameter: float  #: mm; the largest.
    angle: float | None  #: rad; whole angle of a countersink, or of a floor that is a cone.
    floor: _Bottom  #: Of a counterbore, else `open`.
    outer: float  #: At its outer end.
    inner: float  #: At its inner one: deeper at the mouth, less deep at the far end of a hole through.

    @property
    def far(self) -> bool:
        """Whether a tool comes to it from the far end."""
        return self.outer > self.inner


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Hole(Record):
    """A hole, and what of it the tools come from its mouth for."""

    #: Numbers of its faces, ascending.
    faces: tuple[int, ...]
    #: Diameter, mm, within which each of them lies about the axis.
    within: tuple[float, ...]
    #: mm; of its narrowest cylinder.
    diameter: float
    #: mm; from the mouth, counterbore and countersink included, to the lower end of that cylinder.
    depth: float
    through: bool
    #: `flat`, `cone`, `round` (a sphere, or a rounded corner) or `open`.
    bottom: _Bottom
    #: rad; the whole angle of a bottom that is a cone, else None.
    cone: float | None
    #: Largest diameter, mm, and whole angle, rad.
    countersink: tuple[float, float] | None
    #: Diameter and depth, mm.
    counterbore: tuple[float, float] | None
    #: (3,); Unit direction of the axis, out of the mouth.
    axis: Floats
    #: (3,); Point of the axis at the mouth, mm.
    place: Floats
    #: Numbers of the faces of its bottom.
    floor: tuple[int, ...] = ()
    #: All that is wider, the widest first.
    steps: tuple[Step, ...] = ()
    #: Sizes that the file states of its faces; of those that are not of its narrowest cylinder the notes alone.
    sizes: tuple[SizeNote, ...] = ()


class _Line(NamedTuple):
    """An axis."""

    point: Floats
    direction: Floats

    def heights(self, points: Floats) -> Floats:
        return np.asarray((points - self.point) @ self.direction)

    def away(self, points: Floats) -> Floats:
        off = points - self.point
        return np.asarray(np.linalg.norm(off - (off @ self.direction)[:, None] * self.direction, axis=1))


class _Ring(NamedTuple):
    """A face about an axis lies between two heights, with its radii there; of a plane they are its inner and its outer one."""

    number: int
    kind: str
    low: float
    high: float
    at_low: float
    at_high: float

    @property
    def wide(self) -> float:
        return max(self.at_low, self.at_high)


class _Wall(NamedTuple):
    """A cylinder with air inside, of one face or several."""

    faces: tuple[int, ...]
    line: _Line
    radius: float


@dataclass(frozen=True, eq=False)
class _Finder:
    part: Any
    orientation: Orientation
    triangles: Triangles
    ignored: frozenset[int] = frozenset()
    _boxes: dict[bytes, tuple[Floats, Floats]] = field(default_factory=dict)

    @cached_property
    def size(self) -> float:
        return float(np.linalg.norm(self.part.size))

    @property
    def same(self) -> float:
        return _SAME * self.size

    def near(self, radius: float) -> float:
        """Lengths that differ by less are equal, mm."""
        return max(self.same, _OF_RADIUS * radius)

    @cached_property
    def border(self) -> Callable[[int], Any]:
        """`_border` of a face, looked for once."""
        return cache(partial(_border, self.part))

    def info(self, number: int) -> FaceInfo:
        info: FaceInfo = self.part.faces[number - 1]
        return info

    def hollow(self, number: int) -> bool:
        """Whether a face is turned about an axis or a centre, with air on that side."""
        info = self.info(number)
        if number in self.ignored or info.carrier is None or info.shape not in _TURNED_KINDS:
            return False
        return info.unjudged is None and info.carrier.side * float(self.orientation.sign[number - 1]) < 0.0

    def ring(self, number: int, line: _Line) -> _Ring | None:
        """A face as it lies about an axis with air inside; None where it does not."""
        info = self.info(number)
        carrier = info.carrier
        if carrier is None or number in self.ignored or not (info.shape == "plane" or self.hollow(number)):
            return None
        direction = None if carrier.direction is None else np.array(carrier.direction)
        if direction is not None and not _parallel(direction, line.direction):
            return None
        point = np.array(carrier.point)
        off = 0.0 if info.shape == "plane" else float(line.away(point[None])[0])
        border = self.border(number) if off <= _OF_RADIUS * self.size else None
        if border is None:
            return None
        heights, away = line.heights(border), line.away(border)
        low, high, level, near = heights.min(), heights.max(), line.heights(point[None])[0], self.near(float(away.max()))
        if info.shape == "plane":
            return _Ring(number, "plane", float(level), float(level), float(away.min()), float(away.max()))
        # What goes round a centre on both sides is a cavity, no bottom.
        if off > near or (info.shape == "sphere" and low < level - near and high > level + near):
            return None
        if carrier.half_angle is not None:
            slope = float(np.tan(carrier.half_angle))
            # A border that is one circle leaves the apex as the other end.
            if away.min() > away.max() - near:
                low, high = min(low, level), max(high, level)
            at_low, at_high = abs(low - level) * slope, abs(high - level) * slope
        elif info.shape == "sphere" and high - low <= near:
            u0, u1, v0, v1 = self.part.trim(number).box
            middle = self.part.surface(number).values(np.array([0.5 * (u0 + u1)]), np.array([0.5 * (v0 + v1)]))
            up = line.heights(middle)[0] > level
            pole = level + (1.0 if up else -1.0) * (carrier.radius or 0.0)
            low, high, at_low, at_high = min(low, pole), max(high, pole), away.max() * up, away.max() * (not up)
        else:
            at_low, at_high = (away[np.abs(heights - end) <= near].max() for end in (low, high))
        return _Ring(number, info.shape, float(low), float(high), float(at_low), float(at_high))

    def walls(self) -> list[_Wall]:
        """All walls: cylinders with air inside that turn more than half a turn."""
        numbers = [n for n in range(1, len(self.part.faces) + 1) if self.info(n).shape == "cylinder" and self.hollow(n)]
        numbers = [n for n in numbers if self.border(n) is not None]
        walls = list[_Wall]()
        for cluster in self._cylinders(numbers):
            carrier: Any = self.info(cluster[0]).carrier
            line = _Line(np.array(carrier.point), np.array(carrier.direction))
            for group in self._touching(cluster, line, carrier.radius):
                heights = line.heights(np.concatenate([self.border(n) for n in group]))
                full = 2.0 * np.pi * carrier.radius * float(np.ptp(heights))
                if sum(self.info(n).area for n in group) > _TURNED * full and self._largest_gap(group, line) < _GAP:
                    walls.append(_Wall(tuple(sorted(group)), line, carrier.radius))
        return walls

    def _largest_gap(self, group: Sequence[int], line: _Line) -> float:
        """Largest angle about an axis without a point of some faces, rad."""
        across, angles = square_to(line.direction), []
        for number in group:
            u0, u1, v0, v1 = self.part.trim(number).box
            share = np.linspace(0.0, 1.0, 2 * _ALONG + 1)
            grid = [each.ravel() for each in np.meshgrid(u0 + share * (u1 - u0), v0 + share[[0, _ALONG, -1]] * (v1 - v0))]
            other = [each.ravel() for each in np.meshgrid(u0 + share[[0, _ALONG, -1]] * (u1 - u0), v0 + share * (v1 - v0))]
            points = self.part.surface(number).values(*(np.concatenate(each) for each in zip(grid, other, strict=True)))
            points = points[np.isfinite(points).all(axis=1)] - line.point
            angles.append(np.arctan2(*(points @ across).T))
        angle = np.sort(np.concatenate(angles))
        return float(np.diff(angle, append=angle[0] + 2.0 * np.pi).max())

    def _cylinders(self, numbers: Sequence[int]) -> list[list[int]]:
        """Faces of one cylinder, together."""
        if not numbers:
            return []
        carriers: list[Any] = [self.info(n).carrier for n in numbers]
        point, direction = (np.array([getattr(each, name) for each in carriers]) for name in ("point", "direction"))
        radius = np.array([each.radius for each in carriers])
        pairs = list[tuple[int, int]]()
        for i in range(len(numbers) - 1):
            near = self.near(float(radius[i]))
            rows = i + 1 + np.flatnonzero(np.abs(radius[i + 1 :] - radius[i]) <= near)
            rows = rows[np.linalg.norm(np.cross(direction[rows], direction[i]), axis=1) <= _PARALLEL]
            off = point[rows] - point[i]
            off = np.linalg.norm(off - (off @ direction[i])[:, None] * direction[i], axis=1)
            pairs += [(i, j) for j in rows[off <= near].tolist()]
        return _grouped(numbers, pairs)

    def _touching(self, cluster: Sequence[int], line: _Line, radius: float) -> list[list[int]]:
        """Faces of one cylinder that meet along the axis, or are parted by a hole that crosses there."""
        near = self.near(radius)
        ends = [(float(h.min()), float(h.max())) for h in (line.heights(self.border(n)) for n in cluster)]
        across = [{m for m in self.part.neighbours[n - 1] if m not in cluster and self._crosses(m, line)} for n in cluster]
        pairs = [
            (i, j)
            for i in range(len(cluster)) for j in range(i + 1, len(cluster))
            if (ends[i][0] <= ends[j][1] + near and ends[j][0] <= ends[i][1] + near) or across[i] & across[j]
        ]  # fmt: skip
        return _grouped(cluster, pairs)

    def _crosses(self, number: int, line: _Line) -> bool:
        info = self.info(number)
        if info.shape != "cylinder" or info.carrier is None or not self.hollow(number):
            return False
        return not _parallel(np.array(info.carrier.direction), line.direction)

    def _opens_into(self, number: int, line: _Line, radius: float) -> float | None:
        """Height at which the axis of a hole passes that crosses this one and goes on to both sides; None of other faces."""
        if not self._crosses(number, line):
            return None
        carrier: Any = self.info(number).carrier
        other, cosine = _Line(np.array(carrier.point), np.array(carrier.direction)), float(line.direction @ carrier.direction)
        middle = (other.heights(line.point) - cosine * ((line.point - other.point) @ line.direction)) / (1.0 - cosine * cosine)
        heights, near = other.heights(self.border(number)) - middle, self.near(radius)
        through = heights.min() <= near - radius and heights.max() >= radius - near
        return float(line.heights(other.point + middle * other.direction)) if through else None

    def holes(self) -> list[Hole]:
        """All holes, those with the lowest face number first."""
        walls = self.walls()
        rings = [self._about(wall) for wall in walls]
        # Walls of one axis that share faces are steps of one hole.
        pairs = [
            (i, j) for i in range(len(walls)) for j in range(i + 1, len(walls)) if rings[i].keys() & {*walls[j].faces}
        ]  # fmt: skip
        result = list[Hole]()
        for steps in _grouped(range(len(walls)), pairs):
            # With heights on one axis.
            again = {number: self.ring(number, walls[steps[0]].line) for k in steps for number in rings[k]}
            own = {number: ring for number, ring in again.items() if ring is not None}
            hole = self._hole([walls[k] for k in steps], own)
            if hole is not None:
                result.append(hole)
        return sorted(result, key=lambda hole: hole.faces)

    def _about(self, wall: _Wall) -> dict[int, _Ring]:
        """Faces about the axis of a wall that are connected with it."""
        rings: dict[int, _Ring] = {}
        waiting = [*wall.faces]
        while waiting:
            number = waiting.pop()
            if number in rings:
                continue
            ring = self.ring(number, wall.line)
            if ring is None or (ring.kind == "plane" and not self._is_floor(ring, wall.line)):
                continue
            rings[number] = ring
            waiting += self.part.neighbours[number - 1]
        return rings

    def _is_floor(self, plane: _Ring, line: _Line) -> bool:
        """Whether a plane lies within a wall about the axis."""
        near = self.near(plane.wide)
        for number in self.part.neighbours[plane.number - 1]:
            ring = self.ring(number, line)
            if ring is not None and ring.kind != "plane" and plane.wide <= ring.wide + near:
                return True
        return False

    def _hole(self, walls: Sequence[_Wall], rings: dict[int, _Ring]) -> Hole | None:
        line, radius = walls[0].line, min(wall.radius for wall in walls)
        near = self.near(radius)
        core = [rings[n] for wall in walls if wall.radius <= radius + near for n in wall.faces if n in rings]
        if not core:
            return None
        low, high = min(ring.low for ring in core), max(ring.high for ring in core)
        numbers = {ring.number for ring in core}
        rest = [ring for ring in rings.values() if ring.number not in numbers]
        below, above = [ring for ring in rest if ring.high <= low + near], [ring for ring in rest if ring.low >= high - near]
        beyond = {up: _outward(each, radius, near, up) for up, each in ((False, below), (True, above))}
        # Whatever begins on the floor of a hole stands there, but for other holes.
        floors = [ring.number for each in beyond.values() for ring in each if ring.kind == "plane"]
        if any(n not in rings and not self.hollow(n) for floor in floors for n in self.part.neighbours[floor - 1]):
            return None
        if any(self._bends(n, radius, near) for ring in core for n in self.part.neighbours[ring.number - 1] if n not in rings):
            return None
        ends = {up: _bottom(each, radius, near, up) for up, each in beyond.items()}
        neighbours = {m for ring in core for m in self.part.neighbours[ring.number - 1]} - {*rings}
        crossed = {m: height for m in neighbours if (height := self._opens_into(m, line, radius)) is not None}
        closed = self._closed(line, radius, ends, core, {*rings}, neighbours - {*crossed})
        # A bottom that a cavity breaks through ends the hole all the same.
        if closed is None or all(up in closed for up in ends):
            return None
        wide = {up: max((ring.wide for ring in beyond[up] if ring.wide > radius + near), default=0.0) for up in ends}
        # Into another hole nothing comes from there.
        inside = {height > high for height in crossed.values() if not low + near < height < high - near}
        mouth = False in (closed or inside) if closed or len(inside) == 1 else wide[True] >= wide[False] - near
        # From here on heights are those over the mouth, and negative.
        way, far = 1.0 if mouth else -1.0, beyond[not mouth]
        top = max(way * end for ring in (*core, *beyond[mouth]) for end in (ring.low, ring.high))
        lowest = min(way * end - top for ring in (*core, *(() if closed else far)) for end in (ring.low, ring.high))
        steps = [
            step
            for up in (True, False)
            for step in _steps(beyond[up], radius, near, up=up, depth=lambda height: top - way * height)
        ]  # fmt: skip
        steps.sort(key=lambda step: -step.diameter)
        # Depths at the far end are those from there.
        ended = {False: 0.0, True: -lowest}
        bores = [(step.diameter, abs(step.inner - ended[step.far])) for step in steps if step.kind == "counterbore"]
        sinks = [(step.diameter, step.angle or 0.0) for step in steps if step.kind == "countersink"]
        bottom, angle = ends[not mouth] or ("open", None)
        every = sorted([*core, *beyond[True], *beyond[False]], key=lambda ring: ring.number)
        return Hole(
            faces=tuple(ring.number for ring in every), within=tuple(2.0 * ring.wide for ring in every), diameter=2.0 * radius,
            depth=-lowest, through=not closed, bottom=bottom, cone=angle, countersink=max(sinks, default=None),
            counterbore=max(bores, default=None), axis=way * line.direction, place=line.point + way * top * line.direction,
            floor=tuple(sorted(ring.number for ring in far if ring.wide <= radius + near)) if closed else (), steps=tuple(steps),
            sizes=tuple(self._stated(numbers, {ring.number for ring in every})),
        )  # fmt: skip

    def _stated(self, core: set[int], every: set[int]) -> Iterator[SizeNote]:
        """Sizes that the file states of a hole."""
        for each in self.part.sizes:
            if core.intersection(each.faces):
                yield each
            elif every.intersection(each.faces) and each.notes:
                yield SizeNote(each.faces, notes=each.notes)

    def _bends(self, number: int, radius: float, near: float) -> bool:
        """Whether a wall goes on in a face as wide as it, round a bend: it is that of a pipe."""
        info = self.info(number)
        tube = info.carrier.minor_radius if info.shape == "torus" and info.carrier is not None else None
        return tube is not None and abs(tube - radius) <= near and self.hollow(number)

    def _closed(
        self, line: _Line, radius: float, ends: dict[bool, Any], core: Sequence[_Ring], own: set[int], neighbours: set[int]
    ) -> set[bool] | None:
        """At which ends something closes a hole; None where something stands in it, or one of these neighbours closes it."""
        longest = max(core, key=lambda ring: ring.high - ring.low)
        start, near = 0.5 * (longest.low + longest.high), max(self.near(radius), 2.0 * self.triangles.chord_error)
        span = min(ring.low for ring in core), max(ring.high for ring in core)
        rows, across, closed = self._within(line, radius), square_to(line.direction), set[bool]()

        def ended(place: Floats) -> frozenset[bool] | None:
            """The ends that are closed, by one line; None as of all."""
            height, face, facing = self._met(rows, place, line.direction)
            shut = set[bool]()
            for up in (False, True):
                way = 1.0 if up else -1.0
                after = np.flatnonzero(way * (height - start) > 0.0)
                if not len(after):
                    continue
                first = after[(way * height[after]).argmin()]
                beyond = way * (height[first] - span[up])
                if way * facing[first] > 0.0 or beyond < -near:
                    return None
                if int(face[first]) in own and ends[up] is not None:
                    shut.add(up)
                elif beyond <= _DEEP * radius and int(face[first]) in neighbours:
                    return None
            return frozenset(shut)

        for share, turn in _LINES:
            # Between triangles of two faces there are cracks: most of three lines next to each other tell.
            turns = turn + _TURN * np.arange(3)
            places = radius * share * np.stack([np.cos(turns), np.sin(turns)], axis=1) @ across.T
            shut, most = Counter(map(ended, line.point + places)).most_common(1)[0]
            if shut is None or most == 1:
                return None
            closed |= shut
        return closed | {up for up, bottom in ends.items() if bottom is not None}

    def _within(self, line: _Line, radius: float) -> NDArray[np.int64]:
        """Rows (k,) of the triangles whose boxes, seen along an axis, meet the square about it."""
        low, high = self._flat(line.direction)
        place = line.point @ square_to(line.direction)
        return np.flatnonzero(((low <= place + radius) & (high >= place - radius)).all(axis=1))

    def _flat(self, direction: Floats) -> tuple[Floats, Floats]:
        """Corners of the boxes (t, 2) of all triangles, seen along a direction."""
        key = np.round(direction, 12).tobytes()
        if key not in self._boxes:
            flat = self.triangles.vertex @ square_to(direction)
            self._boxes.clear()
            self._boxes[key] = flat.min(axis=1), flat.max(axis=1)
        return self._boxes[key]

    def _met(self, rows: NDArray[np.int64], place: Floats, direction: Floats) -> tuple[Floats, Any, Floats]:
        """Heights (k,) over a place at which a line meets some triangles, their faces (k,), and their sides (k,)."""
        on, height, whole = met(self.triangles.vertex[rows], place, direction, self.same)
        face = self.triangles.face[rows[on]]
        return height, face, np.sign(whole) * self.orientation.sign[face - 1]


def _parallel(one: Floats, other: Floats) -> bool:
    """Whether two unit directions are one, or opposite."""
    return 1.0 - float(one @ other) ** 2 <= _PARALLEL**2


def holes(part: Any, orientation: Orientation, triangles: Triangles, ignored: Collection[int] = ()) -> tuple[Hole, ...]:
    """Find the holes of a part, with the side of each face that is out of the material.

    triangles: close to the part: whatever may stand in a hole. ignored: numbers of faces that are not there.
    """
    usable = (triangles.face >= 1) & (triangles.face <= len(part.faces))
    return tuple(_Finder(part, orientation, triangles.take(usable), frozenset(ignored)).holes())


def _border(part: Any, number: int) -> Any:
    """Points (k, 3) along the border of a face; None where it has none that are known."""
    trim = part.trim(number)
    if trim is None or not len(trim.segments):
        return None
    with may_refuse():
        points = part.surface(number).values(*trim.at(*trim.along(_ALONG, _CHORD, 0.0)).T)
        return points if np.isfinite(points).all() else None
    return None


def _grouped(items: Iterable[int], pairs: Sequence[tuple[int, int]]) -> list[list[int]]:
    """Items together that are connected by pairs of their places."""
    items = [*items]
    groups = defaultdict[int, list[int]](list)
    for item, group in zip(items, connected(len(items), np.array(pairs, np.int32).reshape(-1, 2)).tolist(), strict=True):
        groups[group].append(item)
    return [*groups.values()]


def _outward(rings: Sequence[_Ring], radius: float, near: float, up: bool) -> list[_Ring]:
    """Faces beyond an end that a tool gets to from outside, the outermost first: none that is wider than what is further out."""
    ordered = sorted(rings, key=lambda ring: (-ring.high, -ring.wide) if up else (ring.low, -ring.wide))
    result, least = list[_Ring](), np.inf
    for ring in ordered:
        if ring.wide <= least + near:
            result.append(ring)
            # A bottom, which is narrower than the hole, is no way in.
            least = min(least, ring.wide) if ring.wide > radius + near else least
    return result


def _bottom(rings: Sequence[_Ring], radius: float, near: float, up: bool) -> tuple[_Bottom, float | None] | None:
    """The bottom among faces beyond an end, with the angle of a cone; None where there is none."""
    inner = [ring for ring in rings if ring.wide <= radius + near]
    kinds = {ring.kind for ring in inner}
    if kinds & {"torus", "sphere"}:
        return "round", None
    for ring in inner:
        if ring.kind == "cone" and _narrows(ring, up, radius, near):
            return "cone", 2.0 * _half_angle(ring)
    return ("flat", None) if "plane" in kinds else None


def _narrows(ring: _Ring, up: bool, radius: float, near: float) -> bool:
    """Whether a cone beyond an end gets narrower from there: a drill's point."""
    return ring.wide <= radius + near and (ring.at_high < ring.at_low if up else ring.at_low < ring.at_high)


def _half_angle(ring: _Ring) -> float:
    return float(np.arctan2(abs(ring.at_high - ring.at_low), ring.high - ring.low))


def _steps(rings: Sequence[_Ring], radius: float, near: float, *, up: bool, depth: Callable[[float], float]) -> list[Step]:
    """Countersinks and counterbores beyond an end; `depth` under the mouth of what is at a height."""
    result = list[Step]()
    whole = [ring for ring in rings if ring.wide > radius + near]
    ends = {ring.number: (ring.high, ring.low) if up else (ring.low, ring.high) for ring in whole}

    def is_floor(ring: _Ring, bore: _Ring) -> bool:
        """Whether a face begins where a cylinder ends."""
        met = abs(ends[ring.number][0] - ends[bore.number][1]) <= near
        return ring.kind != "cylinder" and met and abs(ring.wide - bore.wide) <= near

    def is_one(ring: _Ring, other: _Ring) -> bool:
        apart = np.subtract((*ends[ring.number], ring.wide), (*ends[other.number], other.wide))
        return ring.kind == other.kind and bool(np.abs(apart).max() <= near)

    bores = [ring for ring in whole if ring.kind == "cylinder"]
    floors = {ring.number for ring in whole for bore in bores if is_floor(ring, bore)}
    seen = list[_Ring]()
    for ring in whole:
        if ring.kind not in ("cylinder", "cone") or ring.number in floors or ring in seen or _narrows(ring, up, radius, near):
            continue
        same = [r for r in whole if is_one(r, ring)]
        seen += same
        below = [r for r in whole if r.number in floors and ring.kind == "cylinder" and is_floor(r, ring)]
        kinds = {r.kind for r in below}
        cone = next((r for r in (ring, *below) if r.kind == "cone"), None)
        floor: _Bottom = "round" if kinds & {"torus", "sphere"} else "cone" if "cone" in kinds else "flat" if kinds else "open"
        outer, inner = (depth(height) for height in ends[ring.number])
        result.append(Step(
            "countersink" if ring.kind == "cone" else "counterbore", tuple(sorted({r.number for r in (*same, *below)})),
            2.0 * ring.wide, None if cone is None else 2.0 * _half_angle(cone), floor, outer, inner,
        ))  # fmt: skip
    return result
