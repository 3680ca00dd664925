"""A cutter as kernels take it: coaxial convex pieces, each made smaller or larger all round.

A piece is a row: what is within its two heights and nearer to the axis than its outline. `COVER` pieces hold every point
that is deep enough in the tool (or near enough to a stage), `CERTAIN` pieces hold no other point; `docs/tools.md` has the
proofs. Heights are over the tip.
"""

import math
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from cad_io.arrays import Floats, Record
from plan_cutters.domain.cutter import Cutter
from plan_cutters.domain.holder import Stage
from plan_cutters.domain.shapes import (
    Mode,
    flank,
    flute_length,
    lens_height,
    modes,
    stages,
    tip_angle,
    top_radius,
)

#: Kinds of a piece: below `radius + slope (w - low)` for the first two; the third has a cross section of an arc: what is
#: nearer than `round` to the disk of radius `radius` (negative: to all of the circle on its far side) at the height `centre`.
CYLINDER, CONE, ARC = 0.0, 1.0, 2.0
#: Columns of a piece: its kind, its heights, and for an arc, in place of slope: the height of its centre. Then what is made of
#: these: 1 / sqrt(1 + slope^2); its lowest and highest point; its radius at the upper height (arcs: the largest); its part.
KIND, LOW, HIGH, RADIUS, SLOPE, ROUND, SCALE, BOTTOM, TOP, WIDE, PART, COLUMNS = 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11
#: Parts of an assembly.
FLUTES, NECK, SHANK, HOLDER = 0, 1, 2, 3
_PARTS = {"neck": NECK, "shank": SHANK, "holder": HOLDER}

#: By which pieces overlap where they meet, mm: what lies in the plane between two of them is in one.
_HAIR = 1e-9

Kind = Literal["cover", "certain"]


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Assembly(Record):
    """Pieces of a cutter and how it touches.

    Attributes
    ----------
    piece : (m, k, COLUMNS) float
        For each mode the same pieces, their heights counted from the mode's centre of curvature.
    mode : (m, 5) float
        Of each: its offset from the axis, its radius of curvature (with the allowance), the tilts from and to at which it
        touches, rad, and its height over the tip.
    reach : float
        Distance from the contact, mm, within which an obstacle counts as rear gouging: the flutes' diameter.
    inner, end : float
        Heights over the tip, mm, of two points of the axis: one as deep in the cutter as any, and the highest.
    slack : float
        By how much a point may be farther from the tool, or less deep in it, than asked for and still count, mm.
    """

    piece: Floats
    mode: Floats
    reach: float
    inner: float
    end: float
    slack: float

    def only(self, part: int) -> "Assembly":
        """The pieces of one part alone."""
        mine = self.piece[0, :, PART] == part
        return replace(self, piece=np.ascontiguousarray(self.piece[:, mine]))

    def at(self, tilt: Floats) -> NDArray[np.int64]:
        """The mode (n,) in which it touches at each tilt, rad; the last one where it touches in none."""
        found = np.full(len(tilt), len(self.mode) - 1)
        for i in range(len(self.mode) - 1, -1, -1):
            found[(tilt >= self.mode[i, 2] - _HAIR) & (tilt <= self.mode[i, 3] + _HAIR)] = i
        return found

    def on_axis(self, contact: Floats, normal: Floats, lean: Floats, tilt: Floats) -> Floats:
        """The point (n, 3) of the axis as deep in the tool as any, at contacts, normals and leans (n, 3) and tilts (n,), rad."""
        offset, rise, _, _, height = self.mode[self.at(tilt)].T[:, :, None]
        cosine, sine = np.cos(tilt)[:, None], np.sin(tilt)[:, None]
        along = (self.inner - height) * (cosine * normal + sine * lean)
        return np.asarray(contact + rise * normal + along - offset * (cosine * lean - sine * normal))

    def depth(self, points: Floats, contact: Floats, normal: Floats, lean: Floats, tilt: float) -> Floats:
        """How deep at least points (n, 3) lie in a piece of the tool at a contact, lean (3,) and tilt; negative outside."""
        offset, rise, *_ = self.mode[(mode := int(self.at(np.array([tilt]))[0]))]
        axis, x_t = np.cos(tilt) * normal + np.sin(tilt) * lean, np.cos(tilt) * lean - np.sin(tilt) * normal
        from_centre = points - (contact + rise * normal - offset * x_t)
        height = (from_centre @ axis)[:, None]
        q = np.linalg.norm(from_centre - height * axis, axis=1)[:, None]
        row = self.piece[mode].T[:, None]
        side = (row[RADIUS] + row[SLOPE] * (height - row[LOW]) - q) * row[SCALE]
        arc = row[ROUND] - np.hypot(np.maximum(0.0, q - row[RADIUS]), height - row[SLOPE])
        deep = np.minimum(np.where(row[KIND] == ARC, arc, side), np.minimum(height - row[LOW], row[HIGH] - height))
        return np.asarray(deep.max(axis=1))

    @property
    def flutes(self) -> int:
        """The mask of the pieces that cut."""
        return sum(1 << k for k, part in enumerate(self.piece[0, :, PART]) if part == FLUTES)

    def noses(self, taper: float, shape: str) -> tuple[NDArray[np.int64], Floats]:
        """Of each mode the pieces, a mask, that lie in what its nose sweeps when it goes on along the axis, and the angle by
        which it
        widens, rad: what curvature alone holds against the surface near the contact (`docs/between_samples.md`).
        """
        masks = np.zeros(len(self.mode), np.int64)
        for i, (offset, *_) in enumerate(self.mode.tolist()):
            for k, row in enumerate(self.piece[i]):
                own = row[KIND] == ARC and row[SLOPE] == 0.0 and row[RADIUS] == offset
                # Under a lens's corner there is its bottom, under the corners of a form other ones.
                straight = shape == "end" or (shape == "lens" and row[KIND] == CYLINDER)
                wide = shape == "lens" and offset == 0.0
                if row[PART] == FLUTES and shape != "form" and (own or straight or wide):
                    masks[i] |= 1 << k
        return masks, np.full(len(self.mode), max(0.0, taper))

    @property
    def dummy(self) -> Floats:
        """Pieces (k, COLUMNS) that hold all pieces at tilt 0 in every rotation, about the line along the normal; none if the tool
        touches nowhere at tilt 0.

        Their heights count from the centre of the mode that does, the first one.
        """
        offset, _, low, _, _ = self.mode[0]
        if low > 0.0:
            return np.zeros((0, COLUMNS))
        wide = self.piece[0].copy()
        wide[:, [RADIUS, WIDE]] += offset
        return wide


@dataclass(frozen=True, slots=True)
class _Band:
    """A stage between two heights, and by how much its sides are moved in (out: negative)."""

    part: int
    low: float
    stage: Stage
    inset: float

    @property
    def high(self) -> float:
        return self.low + self.stage.length


def assembly(cutter: Cutter, flutes: float, rest: float, *, kind: Kind = "cover") -> Assembly:
    """Pieces of a cutter.

    Parameters
    ----------
    cutter : Cutter
        Its own allowance and clearance are counted in.
    flutes : float
        Depth in the flutes up to which a point does not count, mm; negative: it counts within that distance of them.
    rest : float
        The same for neck, shank and holder.
    kind : str
        `cover`: no point that counts is outside the pieces. `certain`: every point of the pieces counts.
    """
    flutes, rest = flutes - (cutter.allowance or 0.0), rest - (cutter.clearance or 0.0)
    bands = [_Band(_PARTS[part], low, stage, rest) for part, low, stage in stages(cutter)]
    top = flute_length(cutter)
    rows, slack = [], 0.0
    if kind == "certain" or not bands:
        rows += _flutes(cutter, flutes, top - flutes, kind)
        for band in bands:
            rows += _alone(band)
    else:
        first = bands[0]
        end, start = _seam(top_radius(cutter), flutes, first.stage.radius, first.inset, top)
        if cutter.shape == "lollipop":
            start = min(start, cutter.radius)
        rows += _flutes(cutter, flutes, end, kind)
        for i, band in enumerate(bands):
            if i + 1 < len(bands):
                above = bands[i + 1]
                end, after = _seam(band.stage.upper_radius, band.inset, above.stage.radius, above.inset, band.high)
            else:
                end, after = band.high - band.inset, math.inf
            rows += _among(band, start, end, exact=(cutter.clearance or 0.0) > 0.0)
            start = after
    slack = _slack(cutter, flutes, bands, kind)
    table = np.array([row for row in rows if _solid(row)], float).reshape(-1, COLUMNS)
    found = modes(cutter)
    touching = np.array([_mode(mode, cutter.allowance or 0.0) for mode in found])
    placed = np.repeat(table[None], len(found), axis=0)
    for i, mode in enumerate(found):
        placed[i][:, [LOW, HIGH, BOTTOM, TOP]] -= mode.height
        arcs = placed[i][:, KIND] == ARC
        placed[i][arcs, SLOPE] -= mode.height
    inner, highest = _inner(cutter, bands)
    return Assembly(
        placed, touching, 2.0 * cutter.radius, inner, min(highest, float(table[:, TOP].max(initial=0.0))), slack
    )


def _mode(mode: Mode, allowance: float) -> tuple[float, float, float, float, float]:
    return mode.offset, mode.radius + allowance, mode.low, mode.high, mode.height


def _inner(cutter: Cutter, bands: list[_Band]) -> tuple[float, float]:
    """Heights of a point of the axis as deep in the cutter as any and as near to the spindle as can be, and of its end."""
    if not bands:
        return max(0.5 * cutter.length, cutter.length - cutter.radius), cutter.length
    deepest = max(bands, key=lambda band: min(band.stage.radius, band.stage.upper_radius, 0.5 * band.stage.length))
    return deepest.low + 0.5 * deepest.stage.length, bands[-1].high


def _row(kind: float, low: float, high: float, radius: float, slope: float, around: float, part: int) -> list[float]:
    if kind == ARC:
        bottom, top = max(low, slope - around), min(high, slope + around)
        return [kind, low, high, radius, slope, around, 1.0, bottom, top, radius + around, part]
    wide = radius + slope * (high - low)
    return [kind, low, high, radius, slope, around, 1.0 / math.hypot(1.0, slope), low, high, wide, part]


def _band(low: float, high: float, radius: float, slope: float, part: int) -> list[float]:
    """A cylinder or cone, whose radius is given at the lower height."""
    return _row(CYLINDER if slope == 0.0 else CONE, low, high, radius, slope, 0.0, part)


def _solid(row: list[float]) -> bool:
    """Whether a piece holds anything; cones that end in a point are cut there by their own test."""
    if row[KIND] == ARC:
        return row[ROUND] > 0.0 and row[TOP] > row[BOTTOM] and row[WIDE] > 0.0
    return row[HIGH] > row[LOW] and max(row[RADIUS], row[WIDE]) > 0.0


def _seam(lower: float, lower_inset: float, upper: float, upper_inset: float, at: float) -> tuple[float, float]:
    """Heights at which the band below a seam ends, and the one above begins: the narrower runs on into the wider."""
    below, above = lower - lower_inset, upper - upper_inset
    if above > below:
        start = at + upper_inset
        return max(at, start) + _HAIR, start
    if below > above:
        end = at - lower_inset
        return end, min(at, end) - _HAIR
    return at + _HAIR, at


def _among(band: _Band, start: float, end: float, *, exact: bool) -> list[list[float]]:
    """A band among others, between two heights; grown with round edges or with square ones, which hold more."""
    stage, inset = band.stage, band.inset
    side = stage.radius - inset * math.hypot(1.0, stage.slope)
    rows = []
    if exact and inset < 0.0:
        # Round edges where a seam is a step; the side goes from tangent circle to tangent circle, or runs on.
        shift = inset * math.sin(math.atan(stage.slope))
        if abs(start - band.low) > _HAIR:
            rows.append(_row(ARC, -math.inf, math.inf, stage.radius, band.low, -inset, band.part))
            start = band.low + shift if start >= band.low + inset else start
        if abs(end - band.high) > 2.0 * _HAIR:
            rows.append(_row(ARC, -math.inf, math.inf, stage.upper_radius, band.high, -inset, band.part))
            end = band.high + shift if end <= band.high - inset else end
    rows.append(_band(start, end, side + stage.slope * (start - band.low), stage.slope, band.part))
    return rows


def _alone(band: _Band) -> list[list[float]]:
    """A band by itself, exactly."""
    stage, inset = band.stage, band.inset
    side = stage.radius - inset * math.hypot(1.0, stage.slope)
    if inset >= 0.0:
        low, high = band.low + inset, band.high - inset
        return [_band(low, high, side + stage.slope * inset, stage.slope, band.part)]
    shift = inset * math.sin(math.atan(stage.slope))
    low, high = band.low + shift, band.high + shift
    return [
        _band(low, high, side + stage.slope * shift, stage.slope, band.part),
        _row(ARC, -math.inf, math.inf, stage.radius, band.low, -inset, band.part),
        _row(ARC, -math.inf, math.inf, stage.upper_radius, band.high, -inset, band.part),
    ]


def _flutes(cutter: Cutter, inset: float, top: float, kind: Kind) -> list[list[float]]:
    """Pieces of what cuts, up to a height."""
    return {"end": _end, "lollipop": _lollipop, "barrel": _barrel, "lens": _lens, "form": _form}[cutter.shape](
        cutter, inset, top, kind
    )


def _unless_higher(row: list[float], top: float) -> list[float]:
    """An arc, cut off where it would stand out above the end of the flutes."""
    return row if row[TOP] <= top else _row(ARC, row[LOW], top, row[RADIUS], row[SLOPE], row[ROUND], int(row[PART]))


def _end(cutter: Cutter, inset: float, top: float, kind: Kind) -> list[list[float]]:
    offset, corner, lean = cutter.radius - cutter.corner_radius, cutter.corner_radius, cutter.taper
    left = corner - inset
    # The flank's distance from the axis at the height of the corner's centre.
    side, slope = offset + left / math.cos(lean), math.tan(lean) if lean else 0.0
    rows = []
    if left > 0.0:
        rows.append(_unless_higher(_row(ARC, -math.inf, math.inf, offset, corner, left, FLUTES), top))
        low = corner - left * math.sin(lean)
    else:
        low = inset
    radius = cutter.radius - inset if lean == 0.0 else side + slope * (low - corner)
    rows.append(_band(low, top, radius, slope, FLUTES))
    return rows


def _lollipop(cutter: Cutter, inset: float, top: float, kind: Kind) -> list[list[float]]:
    return [_row(ARC, -math.inf, math.inf, 0.0, cutter.radius, cutter.radius - inset, FLUTES)]


def _barrel(cutter: Cutter, inset: float, top: float, kind: Kind) -> list[list[float]]:
    wide, tip = cutter.arc_radius - inset, cutter.corner_radius
    offset, centre = cutter.radius - cutter.arc_radius, cutter.arc_height
    if not tip:
        low = inset
        if inset < 0.0:
            # Grown, its sharp lower edge is round.
            edge = flank(cutter, 0.0)
            rows = [_row(ARC, -math.inf, math.inf, edge, 0.0, -inset, FLUTES)]
            return [*rows, _row(ARC, 0.0, top, offset, centre, wide, FLUTES)]
        return [_row(ARC, low, top, offset, centre, wide, FLUTES)]
    joint, left = tip_angle(cutter), tip - inset
    if left > 0.0:
        low = tip - left * math.cos(joint)
        ball = _unless_higher(_row(ARC, -math.inf, math.inf, 0.0, tip, left, FLUTES), top)
        return [ball, _row(ARC, low, top, offset, centre, wide, FLUTES)]
    return [_row(ARC, inset, top, offset, centre, wide, FLUTES)]


def _lens(cutter: Cutter, inset: float, top: float, kind: Kind) -> list[list[float]]:
    bottom, corner = cutter.arc_radius, cutter.corner_radius
    offset, centre, left = cutter.radius - corner, lens_height(cutter), corner - inset
    side = cutter.radius - inset
    if left > 0.0:
        joint = bottom - (bottom - inset) * math.cos(tip_angle(cutter))
        rows = [_unless_higher(_row(ARC, -math.inf, math.inf, offset, centre, left, FLUTES), top)]
    else:
        # The eroded bottom goes on until it meets the eroded side.
        joint = bottom - math.sqrt(max(0.0, (bottom - inset) ** 2 - side**2))
        rows, centre = [], joint
    return [
        _row(ARC, -math.inf, joint, 0.0, bottom, bottom - inset, FLUTES),
        *rows,
        _band(centre, top, side, 0.0, FLUTES),
    ]


def _form(cutter: Cutter, inset: float, top: float, kind: Kind) -> list[list[float]]:
    """Bands between the heights of an outline; sides next to a re-entrant corner are moved in less (`docs/tools.md`)."""
    points, rows = cutter.outline, []
    for i in range(len(points) - 1):
        (r0, w0), (r1, w1) = points[i], points[i + 1]
        if w1 <= w0:
            continue
        stage = Stage(max(r0, 1e-12), w1 - w0, max(r1, 1e-12))
        if kind == "certain":
            rows += _alone(_Band(FLUTES, w0, stage, inset))
            continue
        share = _share(points, i) if inset > 0.0 else 1.0
        mine = inset * share
        low_step, high_step = _step(points, i, -1), _step(points, i + 1, 1)
        low = w0 + mine if low_step > 0.0 else w0 - abs(mine) if low_step < 0.0 else w0 - _HAIR
        last = w1 == points[-1][1]
        high = top if last else w1 - mine if high_step > 0.0 else w1 + abs(mine) if high_step < 0.0 else w1 + _HAIR
        side = stage.radius - mine * math.hypot(1.0, stage.slope)
        rows.append(_band(low, high, side + stage.slope * (low - w0), stage.slope, FLUTES))
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


def _share(points: tuple[tuple[float, float], ...], i: int) -> float:
    """By which share of the depth the side from point i to the next is moved in: less next to a re-entrant corner."""
    least = 1.0
    for k in (i, i + 1):
        if 0 < k < len(points) - 1:
            (a, b), (c, d), (e, f) = points[k - 1], points[k], points[k + 1]
            first, second = math.atan2(d - b, c - a), math.atan2(f - d, e - c)
            turn = math.remainder(second - first, 2.0 * math.pi)
            if turn < 0.0:
                least = min(least, math.cos(0.5 * turn))
    # A step on the other side of a horizontal piece meets this side, too.
    return least


def _slack(cutter: Cutter, inset: float, bands: list[_Band], kind: Kind) -> float:
    """How far at most a point is from what counts though a cover piece holds it, mm."""
    if kind == "certain":
        return 0.0
    most = 0.0
    for band in bands:
        if band.inset < 0.0 and not (cutter.clearance or 0.0) > 0.0:
            half = 0.25 * math.pi + 0.5 * abs(math.atan(band.stage.slope))
            most = max(most, -band.inset * (1.0 / math.cos(half) - 1.0))
    if cutter.shape == "form":
        for i in range(len(cutter.outline) - 1):
            most = max(most, abs(inset) * (1.0 - _share(cutter.outline, i)), abs(inset) * _sharpest(cutter.outline, i))
    if inset < 0.0:
        # Grown flutes have square upper edges.
        most = max(most, -inset * (math.sqrt(2.0) - 1.0))
    return most


def _sharpest(points: tuple[tuple[float, float], ...], k: int) -> float:
    """By how much more than the depth the corner at point k of a convex seam lies within both sides."""
    if not 0 < k < len(points) - 1:
        return 0.0
    (a, b), (c, d), (e, f) = points[k - 1], points[k], points[k + 1]
    turn = math.remainder(math.atan2(f - d, e - c) - math.atan2(d - b, c - a), 2.0 * math.pi)
    return 0.0 if turn <= 0.0 else 1.0 / max(0.05, math.cos(0.5 * turn)) - 1.0
