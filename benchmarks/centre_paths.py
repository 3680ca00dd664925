"""Paths of a tool's centre, pass by pass, as a CAM program lays them: floors, walls, and curved faces under a ball.

A control feeds the centre of the tool: so lengths are those of its path. This module shares no formula and no import with the
product. Outlines are offset by shapely, passes are lines, rings and circles, and a pattern of passes on a floor counts only if
the tool, swept along it, covers the floor and does not touch what rises beside it.

Conventions, where shops differ:

- A pass over an open strip runs from edge to edge of what it cuts. How the tool comes in and goes out belongs to the link.
- A floor and the wall above it are two operations: the passes of the floor cover all of it, and the wall has passes of its own.
- A wall is a contour: at a sharp outer corner the centre goes round it on an arc of the tool's radius, and `Path.corners` is the
  length of these arcs, in which nothing is cut. At an inner corner that is narrower than the tool the path has a sharp corner.
- Of the patterns that cover a floor the quickest counts, with its links.
- Moves in the air are in no length. Passes that are not the first of their piece cost a link, and each piece costs an entry.
"""

import math
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from itertools import pairwise, product

import numpy as np
import shapely
from numpy.typing import NDArray
from shapely.affinity import rotate
from shapely.geometry import LineString, Point, Polygon, box
from shapely.geometry.base import BaseGeometry

Floats = NDArray[np.float64]
#: Farthest distance of passes of a flat end, in diameters of its flat part.
STEPOVER = 0.75
#: Seconds of a link or an entry, and mm/s at which a pattern of passes is compared with others.
LINK, FEED = 1.0, 1000.0 / 60.0
#: Chords of a quarter circle; widths that count as nothing, mm; and how much what is offset may be off by its chords, mm.
CHORDS, NOTHING, CHORD_ERROR = 24, 1e-6, 0.01
#: A corner of an outline is sharp where it turns by more, rad: chords of a curve turn by less.
SHARP = math.radians(10.0)


@dataclass(frozen=True)
class Path:
    """A path of the tool's centre while it cuts.

    Attributes
    ----------
    length : float
        mm.
    passes, pieces : int
        Passes, and the connected pieces that they cut.
    corners : float
        Of the length, that of arcs about sharp corners, mm.
    """

    length: float = 0.0
    passes: int = 0
    pieces: int = 0
    corners: float = 0.0

    def __add__(self, other: "Path") -> "Path":
        return Path(
            self.length + other.length, self.passes + other.passes, self.pieces + other.pieces, self.corners + other.corners
        )

    def times(self, count: int) -> "Path":
        """So many equal pieces."""
        return Path(count * self.length, count * self.passes, count * self.pieces, count * self.corners)

    @property
    def links(self) -> int:
        """Links between passes of a piece."""
        return self.passes - self.pieces

    @property
    def seconds(self) -> float:
        """Of cutting."""
        return self.length / FEED

    @property
    def link_seconds(self) -> float:
        """Of links and entries."""
        return LINK * self.passes


def circle(radius: float, x: float = 0.0, y: float = 0.0) -> Polygon:
    """A disc as a polygon, its chords off by no more than the error, mm."""
    return Point(x, y).buffer(radius, quad_segs=max(CHORDS, math.ceil(math.sqrt(radius / CHORD_ERROR))))


def rectangle(x: float, y: float, radius: float = 0.0) -> Polygon:
    """A rectangle about the origin, with round corners if there is a radius, mm."""
    inner = box(radius - 0.5 * x, radius - 0.5 * y, 0.5 * x - radius, 0.5 * y - radius)
    return grown(inner, radius) if radius else inner


def grown(shape: BaseGeometry, by: float) -> BaseGeometry:
    """The shape with all that is no farther from it than so much, mm; of a negative number, what is so deep in it."""
    return shape.buffer(by, quad_segs=CHORDS).simplify(0.1 * CHORD_ERROR)


def walls_round(pocket: Polygon) -> BaseGeometry:
    """The material round a pocket."""
    return pocket.buffer(100.0, join_style="mitre").difference(pocket)


# Floors.


def floor(face: BaseGeometry, diameter: float, walls: BaseGeometry | None = None, corner: float = 0.0) -> Path:
    """The quickest passes of a flat end over a floor.

    Parameters
    ----------
    face : Polygon
        The floor, mm, seen along the tool.
    diameter, corner : float
        Of the tool: its diameter and the radius of its corner, mm.
    walls : Polygon, optional
        What rises above the floor, seen likewise. The edges of the floor elsewhere are open: the tool may go beyond.
    """
    passes = min(floor_patterns(face, diameter, walls, corner), key=_seconds)
    return Path(sum(each.length for each in passes), len(passes), 1)


def floor_patterns(
    face: BaseGeometry, diameter: float, walls: BaseGeometry | None = None, corner: float = 0.0
) -> Iterator[list[LineString]]:
    """Patterns of passes of a flat end that cover all of a floor that it can: along x, along y, and in rings; as for `floor`."""
    flat = 0.5 * diameter - corner
    blocked, forbidden = (grown(walls or Polygon(), 0.5 * diameter - less) for less in (NOTHING, CHORD_ERROR))
    # What no place of the tool covers is no fault of a pattern.
    covered = face.intersection(grown(grown(face, flat).difference(blocked), flat))
    border = _lines(grown(walls, 0.5 * diameter).boundary.intersection(face)) if walls else []
    # The passes after a first one along the walls have the rest of the floor, the step-over away from it.
    rest = face.difference(shapely.union_all([grown(each, (2.0 * STEPOVER - 1.0) * flat) for each in border]))
    patterns: list[Iterable[list[LineString]]] = [_rings(face, flat, 0.5 * diameter), _round(face)]
    for turned, beyond in product((0.0, 90.0), (None, 0.0, 0.5 * flat)):
        patterns.append(_zigzags(face, flat, blocked, turned, beyond))
        if border:
            patterns.append(border + lines for lines in _zigzags(rest, flat, blocked, turned, beyond))
    for each in patterns:
        good = (lines for lines in each if _good(lines, covered, flat, forbidden))
        if (first := next(iter(good), None)) is not None:
            yield first


def _seconds(passes: list[LineString]) -> float:
    """Of a pattern, with its links."""
    return sum(each.length for each in passes) / FEED + LINK * len(passes)


def _good(passes: list[LineString], face: BaseGeometry, flat: float, forbidden: BaseGeometry) -> bool:
    """Whether a pattern covers a face, and stays out of what is forbidden for the tool's centre."""
    swept = shapely.union_all([grown(each, flat) for each in passes])
    uncovered = face.difference(swept).buffer(-CHORD_ERROR)
    return bool(uncovered.is_empty) and not any(each.crosses(forbidden) or each.within(forbidden) for each in passes)


def _zigzags(
    face: BaseGeometry, flat: float, blocked: BaseGeometry, turned: float, beyond: float | None
) -> Iterator[list[LineString]]:
    """Parallel passes over a face, evenly apart: from the fewest that the step-over allows, to a few more.

    Passes end where their line is so far beyond the face, mm, or, if None, where the strip of the face that each cuts ends.
    """
    face, blocked = (rotate(each, -turned, origin=(0, 0)) for each in (face, blocked))
    if face.is_empty:
        yield []
        return
    left, low, right, high = face.bounds
    between = high - low - 2.0 * flat
    if between <= NOTHING:
        # One pass over what is narrower than the tool: in its middle, or off a wall on one of its sides.
        tries = [[0.5 * (low + high)], [low + flat], [high - flat]]
    else:
        fewest = math.ceil(between / (2.0 * STEPOVER * flat) - NOTHING) + 1
        tries = [np.linspace(low + flat, high - flat, count).tolist() for count in range(fewest, fewest + 4)]
    for places in tries:
        ends = [low, *(0.5 * (a + b) for a, b in pairwise(places)), high]
        passes = []
        for y, (begin, end) in zip(places, pairwise(ends), strict=True):
            if beyond is None:
                strips = [each.bounds for each in shapely.get_parts(face.intersection(box(left, begin, right, end))) if each.area]
                lines = shapely.MultiLineString([[(strip[0], y), (strip[2], y)] for strip in strips])
            else:
                lines = LineString([(left - beyond, y), (right + beyond, y)]).intersection(grown(face, beyond))
            passes += _lines(lines.difference(blocked))
        yield [rotate(line, turned, origin=(0, 0)) for line in passes]


def _rings(face: BaseGeometry, flat: float, radius: float) -> Iterator[list[LineString]]:
    """Rings from the border of a face inwards, the tool within it."""
    first = grown(face, -radius)
    if first.is_empty:
        return
    depth = max(shapely.maximum_inscribed_circle(each).length for each in shapely.get_parts(first))
    fewest = max(0, math.ceil((depth - flat) / (2.0 * STEPOVER * flat) - NOTHING)) + 1
    for count in range(fewest, fewest + 4):
        apart = max(0.0, depth - flat) / max(1, count - 1)
        yield [line for k in range(count) for line in _lines(grown(first, -k * apart).boundary)]


def _round(face: BaseGeometry) -> Iterator[list[LineString]]:
    """One ring, in the middle of a face that is no wider than the tool."""
    if isinstance(face, Polygon) and face.interiors:
        depth = shapely.maximum_inscribed_circle(face).length
        yield _lines(grown(Polygon(face.exterior), -depth).boundary)


def _lines(shape: BaseGeometry) -> list[LineString]:
    """The lines that a shape has, each as long as it is connected."""
    parts = [each for each in shapely.get_parts(shape) if each.geom_type in ("LineString", "LinearRing") and each.length > 0.0]
    if len(parts) < 2:
        return parts
    return list(shapely.get_parts(shapely.line_merge(shapely.MultiLineString(parts))))


# Walls.


def levels(height: float, flutes: float) -> int:
    """Passes, one above the other, that cut a wall of a height by the straight side of flutes, mm."""
    count = 1
    while count * flutes < height - NOTHING:
        count += 1
    return count


def wall(outline: Polygon | LineString, diameter: float, height: float, flutes: float, *, inside: bool = False) -> Path:
    """The contour of a flat end along a wall by the side of its flutes.

    Parameters
    ----------
    outline : Polygon or LineString
        The wall, mm, seen along the tool: that of a boss, or of a pocket if `inside`; of an open wall, a straight line.
    diameter, flutes : float
        Of the tool, mm: its diameter, and the length of its flutes above the corner.
    height : float
        Of the wall, mm.
    """
    count = levels(height, flutes)
    if isinstance(outline, LineString):
        return Path(count * outline.length, count, 1)
    rings = _lines(grown(outline, -0.5 * diameter if inside else 0.5 * diameter).boundary)
    length, corners = sum(each.length for each in rings), 0.0 if inside else 0.5 * diameter * sharp_turns(outline)
    return Path(count * length, count * len(rings), len(rings), count * corners)


def sharp_turns(outline: Polygon) -> float:
    """Angles by which an outline turns at its sharp outer corners together, rad."""
    points = np.asarray(shapely.orient_polygons(outline).exterior.coords)[:-1]
    along = np.roll(points, -1, axis=0) - points
    heading = np.arctan2(along[:, 1], along[:, 0])
    turn = (heading - np.roll(heading, 1) + math.pi) % math.tau - math.pi
    return float(turn[turn > SHARP].sum())


# Curved faces under a ball.


@dataclass(frozen=True)
class Profile:
    """A section of a face, in mm: points (n, 2) close together, and unit normals (n, 2) on the tool's side."""

    point: Floats
    normal: Floats

    @classmethod
    def line(cls, begin: tuple[float, float], end: tuple[float, float]) -> "Profile":
        """A straight line, with the tool on its left side."""
        point = np.linspace(begin, end, 2001)
        x, y = (point[-1] - point[0]) / math.dist(begin, end)
        return cls(point, np.broadcast_to([-y, x], point.shape))

    @classmethod
    def arc(cls, centre: tuple[float, float], radius: float, begin: float, end: float, *, hollow: bool = False) -> "Profile":
        """An arc between two angles, deg, with the tool outside of it, or within it if it is hollow."""
        angle = np.radians(np.linspace(begin, end, 2001))
        out = np.column_stack([np.cos(angle), np.sin(angle)])
        return cls(np.asarray(centre) + radius * out, -out if hollow else out)


def ball_centres(profile: Profile, radius: float, scallop: float) -> Floats:
    """Centres (k, 2) of a ball on a section, evenly apart: the fewest that leave no cusp higher than the scallop, mm."""
    count = 1
    while _highest(profile, _centres(profile, radius, count), radius) > scallop:
        count *= 2
    fewest, most = count // 2 + 1, count
    while fewest < most:
        middle = (fewest + most) // 2
        if _highest(profile, _centres(profile, radius, middle), radius) > scallop:
            fewest = middle + 1
        else:
            most = middle
    return _centres(profile, radius, most)


def _centres(profile: Profile, radius: float, count: int) -> Floats:
    """Centres (count, 2) of a ball on a section, evenly apart, half as far from its ends."""
    line = profile.point + radius * profile.normal
    # By the length of the section itself: in a hollow of the ball's own radius the centre stays where it is.
    far = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(profile.point, axis=0), axis=1))])
    at = (np.arange(count) + 0.5) / count * far[-1]
    return np.column_stack([np.interp(at, far, line[:, axis]) for axis in (0, 1)])


def _highest(profile: Profile, centre: Floats, radius: float) -> float:
    """Height of the highest cusp that a ball at centres (k, 2) leaves on a section, or of what it leaves at the ends, mm."""
    ends = [math.dist(profile.point[end], centre[end]) - radius for end in (0, -1)]
    apart = np.diff(centre, axis=0)
    half = 0.5 * np.linalg.norm(apart, axis=1)
    if (half >= radius).any():
        return math.inf
    # Neighbours meet in a cusp, on the side of the section.
    middle = 0.5 * (centre[1:] + centre[:-1])
    off = np.sqrt(radius**2 - half**2)[:, None] * np.column_stack([-apart[:, 1], apart[:, 0]]) / (2.0 * half[:, None])
    curve = LineString(profile.point)
    cusps = np.minimum(*(shapely.distance(curve, shapely.points(middle + sign * off)) for sign in (1.0, -1.0)))
    return float(max(*ends, *cusps))


def ball_along(profile: Profile, length: float, radius: float, scallop: float) -> Path:
    """Straight passes of a ball along a face that has the same section all along a length, mm."""
    count = len(ball_centres(profile, radius, scallop))
    return Path(count * length, count, 1)


def ball_about(profile: Profile, radius: float, scallop: float) -> Path:
    """Circles of a ball on a face of revolution: the section's first number is the distance from its axis, mm."""
    centre = ball_centres(profile, radius, scallop)
    return Path(float(math.tau * np.abs(centre[:, 0]).sum()), len(centre), 1)
