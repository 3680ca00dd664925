"""Pieces of a cutter, row by row: stages alone and among others, and every shape of cutting part, smaller or larger all round.

Heights are over the tip; `docs/tools.md` has the proofs.
"""

import math
from dataclasses import dataclass
from itertools import pairwise
from typing import Literal

from plan_cutters.domain.dimensions import Dimensions
from plan_cutters.domain.holder import Segment
from plan_cutters.domain.shapes import flank, lens_height, tip_angle
from plan_cutters.kernels.codes import (
    ARC,
    BOTTOM,
    CONE,
    CYLINDER,
    FLUTES,
    HIGH,
    HOLDER,
    KIND,
    LOW,
    NECK,
    PART,
    RADIUS,
    ROUND,
    SHANK,
    SLOPE,
    TOP,
    WIDE,
)

#: Parts other than the flutes, by name.
PARTS = {"neck": NECK, "shank": SHANK, "holder": HOLDER}

#: By which pieces overlap where they meet, mm: what lies in the plane between two of them is in one.
HAIR = 1e-9

Kind = Literal["outer", "inner"]


@dataclass(frozen=True, slots=True)
class Band:
    """A stage between two heights, and by how much its sides are moved in (out: negative)."""

    part: int
    low: float
    stage: Segment
    inset: float

    @property
    def high(self) -> float:
        return self.low + self.stage.length

    @property
    def flank_angle(self) -> float:
        """Of its side from the axis, rad."""
        return math.atan(self.stage.slope)


def row_of(kind: float, low: float, high: float, radius: float, slope: float, ring_radius: float, part: int) -> list[float]:
    if kind == ARC:
        bottom, top = max(low, slope - ring_radius), min(high, slope + ring_radius)
        return [kind, low, high, radius, slope, ring_radius, 1.0, bottom, top, radius + ring_radius, part]
    wide = radius + slope * (high - low)
    return [kind, low, high, radius, slope, ring_radius, 1.0 / math.hypot(1.0, slope), low, high, wide, part]


def band_row(low: float, high: float, radius: float, slope: float, part: int) -> list[float]:
    """A cylinder or cone, whose radius is given at the lower height."""
    return row_of(CYLINDER if slope == 0.0 else CONE, low, high, radius, slope, 0.0, part)


def solid(row: list[float]) -> bool:
    """Whether a piece holds anything; cones that end in a point are cut there by their own test."""
    if row[KIND] == ARC:
        return row[ROUND] > 0.0 and row[TOP] > row[BOTTOM] and row[WIDE] > 0.0
    return row[HIGH] > row[LOW] and max(row[RADIUS], row[WIDE]) > 0.0


def seam(
    lower: float,
    lower_inset: float,
    upper: float,
    upper_inset: float,
    at: float,
    straight: tuple[float, float] = (math.inf, math.inf),
) -> tuple[float, float]:  # fmt: skip
    """Heights at which the band below a seam ends, and the one above begins: the narrower runs on into the wider.

    A face that the other band covers is not moved in, though that one's side be moved in further. What is grown more than the
    other runs on by all of that, unless the other is as wide for as long, in mm below and above the seam (`straight`): a flange
    may be thinner.
    """
    below, above = lower - lower_inset, upper - upper_inset
    end, start = at + HAIR, at
    if above > below and not (upper <= lower and upper_inset > 0.0):
        start = at + upper_inset
        end = max(at, start) + HAIR
    elif below > above and not (lower <= upper and lower_inset > 0.0):
        end = at - lower_inset
        start = min(at, end) - HAIR
    if upper_inset < min(0.0, lower_inset) and straight[0] < -upper_inset:
        start = min(start, at + upper_inset)
    if lower_inset < min(0.0, upper_inset) and straight[1] < -lower_inset:
        end = max(end, at - lower_inset)
    return end, start


def between(
    lower: float, lower_flank_angle: float, upper: float, upper_flank_angle: float, at: float, inset: float, part: int
) -> list[list[float]]:
    """Give the piece deeper than `inset` over a re-entrant corner: with both sides moved in, it may be in neither of them.

    Its nearest point is the corner, of the narrower of two radii, where sides meet that lean (rad) from the axis. Of the
    directions from there inwards each lies within half the corner's turn of one side's own.
    """
    if inset <= 0.0:
        return []
    radius = min(lower, upper)
    low = at - inset if lower > upper else at + inset * min(0.0, math.sin(lower_flank_angle)) - HAIR
    high = at + inset if upper > lower else at + inset * max(0.0, math.sin(upper_flank_angle)) + HAIR
    if lower == upper:
        # A kink: sides that are nearly along the axis.
        side = radius - inset * math.cos(max(abs(lower_flank_angle), abs(upper_flank_angle)))
        return [band_row(low, high, side, 0.0, part)] if upper_flank_angle > lower_flank_angle else []
    flank_angle, other = (lower_flank_angle, upper_flank_angle) if upper > lower else (upper_flank_angle, lower_flank_angle)
    # The wider side may be nearer than the corner: what is deep enough is as far from it.
    wide = max(lower, upper) + inset * (abs(math.tan(other)) - 1.0 / math.cos(other))
    least = inset * math.cos(0.25 * math.pi + 0.5 * abs(flank_angle))
    slope = math.tan(flank_angle)
    step = (at + least, at + inset + HAIR) if upper > lower else (at - inset - HAIR, at - least)
    return [
        band_row(low, high, radius + slope * (low - at) - least / math.cos(flank_angle), slope, part),
        band_row(*step, min(radius, wide), 0.0, part),
    ]


def kink(radius: float, flank_angle: float, at: float, inset: float, part: int) -> list[list[float]]:
    """Give the piece deeper than `inset` below a re-entrant corner, of a radius at a height, under a side that leans in (rad).

    Seen from what is deep enough there, the side's foot lies beyond its end: it is nearest to the corner. The side, moved in,
    leaves it out, and what stands above may be grown by less than it lies below.
    """
    if inset <= 0.0 or flank_angle >= 0.0:
        return []
    return [band_row(at + inset * math.sin(flank_angle) - HAIR, at + HAIR, radius - inset * math.cos(flank_angle), 0.0, part)]


def opening(cutter: Dimensions, inset: float, at: float) -> list[list[float]]:
    """Make the piece of a lollipop's ball below its neck, which begins at a height: it is deeper than the ball's side says."""
    if inset <= 0.0:
        return []
    share, rise = 1.0 - inset / cutter.radius, at - cutter.radius
    neck = cutter.shank_radius or 0.0
    return [band_row(at - rise * (1.0 - share), at + HAIR, share * neck, neck / rise, FLUTES)]


def among(band: Band, start: float, end: float, *, exact: bool) -> list[list[float]]:
    """A band among others, between two heights; grown with round edges or with square ones, which hold more."""
    stage, inset = band.stage, band.inset
    side = stage.radius - inset * math.hypot(1.0, stage.slope)
    rows, shift = [], min(0.0, inset) * math.sin(band.flank_angle)
    if inset <= 0.0 and start < band.low + inset - HAIR and stage.slope:
        # What runs down into a wider band does so as wide as it begins: its own slope could leave out what is deep under its rim.
        rows.append(band_row(start, band.low + HAIR, stage.radius, 0.0, band.part))
        start = band.low + inset
    low_step, high_step = abs(start - band.low) > 2.0 * HAIR, abs(end - band.high) > 2.0 * HAIR
    # Grown, a side that leans reaches past its ends along its normal.
    if inset < 0.0 and not (exact and low_step):
        start = min(start, band.low + min(0.0, shift))
    if inset < 0.0 and not (exact and high_step):
        end = max(end, band.high + max(0.0, shift))
    if exact and inset < 0.0:
        # Round edges where a seam is a step; the side goes from tangent circle to tangent circle, or runs on.
        if low_step:
            rows.append(row_of(ARC, -math.inf, math.inf, stage.radius, band.low, -inset, band.part))
            start = band.low + shift if start >= band.low + inset - HAIR else start
        if high_step:
            rows.append(row_of(ARC, -math.inf, math.inf, stage.upper_radius, band.high, -inset, band.part))
            end = band.high + shift if end <= band.high - inset + HAIR else end
    rows.append(band_row(start, end, side + stage.slope * (start - band.low), stage.slope, band.part))
    return rows


def alone(band: Band) -> list[list[float]]:
    """A band by itself, exactly."""
    stage, inset = band.stage, band.inset
    side = stage.radius - inset * math.hypot(1.0, stage.slope)
    if inset >= 0.0:
        low, high = band.low + inset, band.high - inset
        return [band_row(low, high, side + stage.slope * inset, stage.slope, band.part)]
    shift = inset * math.sin(math.atan(stage.slope))
    low, high = band.low + shift, band.high + shift
    return [
        band_row(low, high, side + stage.slope * shift, stage.slope, band.part),
        row_of(ARC, -math.inf, math.inf, stage.radius, band.low, -inset, band.part),
        row_of(ARC, -math.inf, math.inf, stage.upper_radius, band.high, -inset, band.part),
    ]


def flute_rows(cutter: Dimensions, inset: float, top: float, kind: Kind) -> list[list[float]]:
    """Pieces of what cuts, up to a height."""
    return {"end": _end, "lollipop": _lollipop, "barrel": _barrel, "lens": _lens, "form": _form}[cutter.shape](
        cutter, inset, top, kind
    )


def _unless_higher(row: list[float], top: float) -> list[float]:
    """An arc, cut off where it would stand out above the end of the flutes."""
    return row if row[TOP] <= top else row_of(ARC, row[LOW], top, row[RADIUS], row[SLOPE], row[ROUND], int(row[PART]))


def _end(cutter: Dimensions, inset: float, top: float, kind: Kind) -> list[list[float]]:
    offset, corner, flank_angle = cutter.radius - cutter.corner_radius, cutter.corner_radius, cutter.taper
    start = corner - inset
    # The flank's distance from the axis at the height of the corner's centre.
    side, slope = offset + start / math.cos(flank_angle), math.tan(flank_angle) if flank_angle else 0.0
    rows = []
    if start > 0.0:
        rows.append(_unless_higher(row_of(ARC, -math.inf, math.inf, offset, corner, start, FLUTES), top))
        low = corner - start * math.sin(flank_angle)
    else:
        low = inset
    radius = cutter.radius - inset if flank_angle == 0.0 else side + slope * (low - corner)
    rows.append(band_row(low, top, radius, slope, FLUTES))
    return rows


def _lollipop(cutter: Dimensions, inset: float, top: float, kind: Kind) -> list[list[float]]:
    row = row_of(ARC, -math.inf, math.inf, 0.0, cutter.radius, cutter.radius - inset, FLUTES)
    # Grown, the ball that its neck cuts off does not go on in the round.
    return [_unless_higher(row, top) if kind == "inner" and inset < 0.0 else row]


def _barrel(cutter: Dimensions, inset: float, top: float, kind: Kind) -> list[list[float]]:
    wide, tip = cutter.arc_radius - inset, cutter.corner_radius
    offset, centre, low = cutter.radius - cutter.arc_radius, cutter.arc_height, inset
    rows = []
    if tip - inset > 0.0 and tip:
        low = tip - (tip - inset) * math.cos(tip_angle(cutter))
        rows.append(_unless_higher(row_of(ARC, -math.inf, math.inf, 0.0, tip, tip - inset, FLUTES), top))
    elif not tip and inset < 0.0:
        # Grown, its sharp lower edge is round, and the flank begins where its normal there ends.
        rows.append(row_of(ARC, -math.inf, math.inf, flank(cutter, 0.0), 0.0, -inset, FLUTES))
        low = inset * centre / cutter.arc_radius - HAIR
    return [*rows, row_of(ARC, low, top, offset, centre, wide, FLUTES)]


def _lens(cutter: Dimensions, inset: float, top: float, kind: Kind) -> list[list[float]]:
    bottom, corner = cutter.arc_radius, cutter.corner_radius
    offset, centre, start = cutter.radius - corner, lens_height(cutter), corner - inset
    side = cutter.radius - inset
    if start > 0.0:
        joint = bottom - (bottom - inset) * math.cos(tip_angle(cutter))
        rows = [_unless_higher(row_of(ARC, -math.inf, math.inf, offset, centre, start, FLUTES), top)]
    else:
        # The eroded bottom goes on until it meets the eroded side.
        joint = bottom - math.sqrt(max(0.0, (bottom - inset) ** 2 - side**2))
        rows, centre = [], joint
    return [row_of(ARC, -math.inf, joint, 0.0, bottom, bottom - inset, FLUTES), *rows, band_row(centre, top, side, 0.0, FLUTES)]


def _form(cutter: Dimensions, inset: float, top: float, kind: Kind) -> list[list[float]]:
    """Bands between the heights of an outline; sides next to a re-entrant corner are moved in less (`docs/tools.md`)."""
    points, rows = cutter.outline, []
    for i in range(len(points) - 1):
        (r0, w0), (r1, w1) = points[i], points[i + 1]
        if w1 <= w0:
            continue
        stage = Segment(max(r0, 1e-12), w1 - w0, max(r1, 1e-12))
        if kind == "inner":
            rows += alone(Band(FLUTES, w0, stage, inset))
            continue
        mine = inset * (share(points, i, inset) if inset > 0.0 else 1.0)
        low_step, high_step = _step(points, i, -1), _step(points, i + 1, 1)
        # Grown, a side that leans reaches past its ends along its normal.
        rise = max(0.0, -mine) * math.sin(math.atan(stage.slope))
        below, beyond = max(rise, -_crossing(points, i, inset)), max(-rise, _crossing(points, i + 1, inset))
        # A tip that ends in a point is round when it is grown.
        low = w0 + mine if low_step > 0.0 or (i == 0 and mine < 0.0) else w0 - HAIR - (abs(inset) if low_step < 0.0 else below)
        high = w1 - mine if high_step > 0.0 else w1 + HAIR + (abs(inset) if high_step < 0.0 else beyond)
        if w1 == points[-1][1]:
            high = top
        side = stage.radius - mine * math.hypot(1.0, stage.slope)
        rows.append(band_row(low, high, side + stage.slope * (low - w0), stage.slope, FLUTES))
    return rows


def _step(points: tuple[tuple[float, float], ...], i: int, way: int) -> float:
    """By how much a band is wider than what lies beyond one of its ends, point i, seen downwards (-1) or upwards (1)."""
    r, w = points[i]
    j = i + way
    other = None
    while 0 <= j < len(points) and points[j][1] == w:
        other = points[j][0]
        j += way
    if j < 0 or j >= len(points):
        # The tip, or the end of the flutes: open, but for the kernel's own end.
        return r if way < 0 else 0.0
    return 0.0 if other is None else r - other


def _turn(points: tuple[tuple[float, float], ...], k: int) -> float:
    """By which angle an outline turns at point k, rad: negative at a re-entrant corner."""
    if not 0 < k < len(points) - 1:
        return 0.0
    (a, b), (c, d), (e, f) = points[k - 1], points[k], points[k + 1]
    return math.remainder(math.atan2(f - d, e - c) - math.atan2(d - b, c - a), 2.0 * math.pi)


def share(points: tuple[tuple[float, float], ...], i: int, inset: float) -> float:
    """By which share of the depth the side from point i to the next is moved in: less next to a re-entrant corner.

    Not at all where it leans towards a further one, no higher or lower than the depth: the foot of what lies deep may then be
    beyond that corner, and how far the side's line is says nothing.
    """
    (r0, low), (r1, high) = points[i], points[i + 1]
    for k in range(1, len(points)):
        over, under = points[k][1] - high, low - points[k][1]
        away = under if r1 > r0 else over if r1 < r0 else math.inf
        if 0.0 < away <= inset and (_turn(points, k) < 0.0 or k == len(points) - 1):
            return 0.0
    first, last = i, i + 1
    # A corner on the other side of a step meets this side, too.
    while first > 0 and points[first - 1][1] == points[first][1]:
        first -= 1
    while last + 1 < len(points) and points[last + 1][1] == points[last][1]:
        last += 1
    return min(math.cos(0.5 * min(0.0, _turn(points, k))) for k in range(first, last + 1))


def _crossing(points: tuple[tuple[float, float], ...], k: int, inset: float) -> float:
    """At which height over a re-entrant corner, point k, the sides that meet there cross when moved in, mm; 0 at other corners.

    Below it the lower one is the wider, above it the upper one: so far each runs on.
    """
    if inset <= 0.0 or _turn(points, k) >= 0.0:
        return 0.0
    (a, b), (c, d), (e, f) = points[k - 1], points[k], points[k + 1]
    if d <= b or f <= d:
        return 0.0
    below, above = (c - a) / (d - b), (e - c) / (f - d)
    back = [share(points, i, inset) * math.hypot(1.0, slope) for i, slope in ((k - 1, below), (k, above))]
    return inset * (back[1] - back[0]) / (above - below)


def sharpest(points: tuple[tuple[float, float], ...], k: int, inset: float) -> float:
    """By how much pieces of sides that meet at point k and are moved out by `-inset` hold too much there, mm."""
    turn = _turn(points, k) if k else math.atan2(points[1][1] - points[0][1], points[1][0] - points[0][0])
    return -inset * (1.0 / max(0.05, math.cos(0.5 * turn)) - 1.0) if turn > 0.0 else 0.0


def least_depth(points: tuple[tuple[float, float], ...], i: int, inset: float) -> float:
    """How deep at least what the side from point i to the next holds lies below all sides, moved in for a depth `inset`, mm.

    Its piece ends at the height of a corner, where it is deep by its own normal, not by that of the side beyond.
    """
    (r0, w0), (r1, w1) = points[i], points[i + 1]
    least = mine = inset * share(points, i, inset)
    inward = mine * math.hypot(1.0, (r1 - r0) / (w1 - w0))
    for (a, low), (b, high) in pairwise([*points, (0.0, points[-1][1])]):
        if low >= w1 + inset or high <= w0 - inset:
            continue
        if high > low:
            least = min(least, inward / math.hypot(1.0, (b - a) / (high - low)))
        elif high < w0 or low > w1:
            # A face across the axis, beyond a side that is shorter than the depth.
            least = min(least, max(w0 - high, low - w1))
    return least
