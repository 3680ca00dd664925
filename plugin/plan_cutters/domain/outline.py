"""The outline of a tool assembly: lines and arcs in a plane through its axis, from the tip up to the end of its holder.

Revolved about the axis it is the tool, exactly: nothing is added to it or taken from it, no allowance and no clearance. Points
are (radius, height over the tip), mm. Seen with the radius to the right and the height up, the tool lies to the left of the
outline as one walks along it.
"""

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Literal

import numpy as np

from cad_io.arrays import Floats
from plan_cutters.domain.cutter import Cutter
from plan_cutters.domain.shapes import SAME, Part, flank, flute_length, lens_height, stages, tip_angle, top_radius
from plan_cutters.errors import OptionError

Point = tuple[float, float]
#: Parts of an assembly, from the tip up.
AnyPart = Literal["flutes"] | Part
#: No chord spans more of an arc than this, rad: an arc stays one however rough its polyline may be.
_WIDEST = math.pi / 8


@dataclass(frozen=True, slots=True)
class Segment:
    """A straight line or an arc of an outline."""

    part: AnyPart  #: `flutes`, `neck`, `shank` or `holder`. The face of a step belongs to the wider part.
    start: Point
    end: Point
    centre: Point | None = None  #: (float, float): of an arc. None: a straight line.
    radius: float = 0.0  #: Of an arc, mm; 0 for a line.
    #: Angle of an arc about its centre from start to end, rad: positive where it bulges out of the tool. 0 for a line.
    turn: float = 0.0

    @property
    def length(self) -> float:
        """Along the segment, mm."""
        return abs(self.turn) * self.radius if self.centre else math.dist(self.start, self.end)

    def at(self, share: float) -> Point:
        """The point at a share of the segment, 0 at its start and 1 at its end."""
        if self.centre is None:
            (q, w), (r, h) = self.start, self.end
            return q + share * (r - q), w + share * (h - w)
        q, w = self.centre
        angle = math.atan2(self.start[1] - w, self.start[0] - q) + share * self.turn
        return q + self.radius * math.cos(angle), w + self.radius * math.sin(angle)

    def direction(self, share: float) -> Point:
        """The unit tangent there; the tool lies to its left."""
        if self.centre is None:
            (q, w), (r, h) = self.start, self.end
            return (r - q) / self.length, (h - w) / self.length
        r, h = self.at(share)
        along = math.copysign(1.0 / self.radius, self.turn)
        return -along * (h - self.centre[1]), along * (r - self.centre[0])

    @property
    def widest(self) -> float:
        """Largest distance from the axis, mm."""
        ends = max(self.start[0], self.end[0])
        if self.centre is None or self.turn <= 0.0:
            return ends
        q, w = self.centre
        return q + self.radius if self.start[1] < w < self.end[1] else ends


@dataclass(frozen=True, slots=True)
class Outline:
    """Segments end to end, from the axis at the tip to the axis at the end of the assembly: with the axis they close.

    >>> [segment.end for segment in outline(Cutter.parse("R6L80")).segments]
    [(6.0, 0.0), (6.0, 80.0), (0.0, 80.0)]
    """

    segments: tuple[Segment, ...]

    @property
    def parts(self) -> tuple[AnyPart, ...]:
        """The parts that are there, from the tip up."""
        return tuple(dict.fromkeys(segment.part for segment in self.segments))

    def of(self, part: AnyPart) -> tuple[Segment, ...]:
        """The segments of one part, which follow each other; none where there is no such part."""
        return tuple(segment for segment in self.segments if segment.part == part)

    @property
    def widest(self) -> float:
        """Largest radius of the assembly, mm."""
        return max(segment.widest for segment in self.segments)

    @property
    def height(self) -> float:
        """From the tip to the end, mm."""
        return self.segments[-1].end[1]


def outline(cutter: Cutter) -> Outline:
    """The outline of a cutter with all that stands above its flutes."""
    segments: list[Segment] = []
    at: Point = (0.0, 0.0)
    for part, end, centre, radius in _walk(cutter):
        # What is shorter than rounding is no side; the next one begins where the last one ended.
        if math.dist(at, end) <= SAME:
            continue
        turn = 0.0
        if centre is not None:
            first, last = (math.atan2(h - centre[1], q - centre[0]) for q, h in (at, end))
            turn = math.remainder(last - first, 2.0 * math.pi)
        segments.append(Segment(part, at, end, centre, radius, turn))
        at = end
    return Outline(tuple(segments))


_Side = tuple[AnyPart, Point, Point | None, float]


def _walk(cutter: Cutter) -> Iterator[_Side]:
    """Sides, each by its part and where it ends; arcs with their centre and radius."""
    for end, centre, radius in _flutes(cutter):
        yield "flutes", end, centre, radius
    below: AnyPart = "flutes"
    wide, height = top_radius(cutter), flute_length(cutter)
    for part, height, stage in stages(cutter):
        yield part if stage.radius > wide else below, (stage.radius, height), None, 0.0
        below, wide, height = part, stage.upper_radius, height + stage.length
        yield part, (wide, height), None, 0.0
    yield below, (0.0, height), None, 0.0


def _flutes(cutter: Cutter) -> Iterator[tuple[Point, Point | None, float]]:
    r, corner, top = cutter.radius, cutter.corner_radius, flute_length(cutter)
    end = (top_radius(cutter), top)
    if cutter.shape == "form":
        for point in cutter.outline[1:]:
            yield point, None, 0.0
    elif cutter.shape == "lollipop":
        yield end, (0.0, r), r
    elif cutter.shape == "barrel":
        yield _tip(corner, tip_angle(cutter)) if corner else (flank(cutter, 0.0), 0.0), *_round((0.0, corner), corner)
        yield end, (r - cutter.arc_radius, cutter.arc_height), cutter.arc_radius
    elif cutter.shape == "lens":
        bottom, high = cutter.arc_radius, lens_height(cutter)
        yield _tip(bottom, tip_angle(cutter)), (0.0, bottom), bottom
        yield (r, high), *_round((r - corner, high), corner)
        yield end, None, 0.0
    else:
        centre, flank_angle = (r - corner, corner), cutter.taper
        yield (r - corner, 0.0), None, 0.0
        foot = centre[0] + corner * math.cos(flank_angle), corner - corner * math.sin(flank_angle)
        yield foot, *_round(centre, corner)
        yield end, None, 0.0


def _tip(radius: float, angle: float) -> Point:
    """The point of a ball or bottom at the tip whose normal leans from the axis by an angle, rad."""
    return radius * math.sin(angle), 2.0 * radius * math.sin(0.5 * angle) ** 2


def _round(centre: Point, radius: float) -> tuple[Point | None, float]:
    """An arc, or the line that is left of it where it has no radius."""
    return (centre, radius) if radius else (None, 0.0)


def points(outline: Outline, chord: float = 0.01) -> Floats:
    """An outline as a polyline (n, 2) of (radius, height), mm, from the tip to the axis at the end.

    `chord`: how far the polyline may be from the outline, mm. Its points lie on the outline, so where that bulges out the
    polyline lies within the tool. Raises OptionError: the chord is not positive.

    >>> points(outline(Cutter.parse("R1L3"))).tolist()
    [[0.0, 0.0], [1.0, 0.0], [1.0, 3.0], [0.0, 3.0]]
    """
    if not chord > 0.0:
        raise OptionError(f"the chord of a polyline must be a positive number of mm, not {chord:g}")
    points = [(0.0, 0.0)]
    for segment in outline.segments:
        count = 1
        if segment.centre is not None:
            # A chord over an angle t lies within 2 r sin(t/4)^2 of its arc.
            step = 4.0 * math.asin(min(1.0, math.sqrt(chord / (2.0 * segment.radius))))
            count = math.ceil(abs(segment.turn) / min(step, _WIDEST) - SAME)
        points += [segment.at(k / count) for k in range(1, count)]
        points.append(segment.end)
    return np.array(points)
