"""A cutter as kernels take it: coaxial convex pieces, each made smaller or larger all round.

A piece is a row: what is within its two heights and nearer to the axis than its outline. `COVER` pieces hold every point
that is deep enough in the tool (or near enough to a stage), `CERTAIN` pieces hold no other point; `docs/tools.md` has the
proofs. Heights are over the tip.
"""

import math
from dataclasses import dataclass, replace
from functools import lru_cache
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from cad_io.arrays import Floats, Record
from plan_cutters.domain import pieces
from plan_cutters.domain.cutter import Cutter
from plan_cutters.domain.pieces import HAIR, PARTS, Band, Kind
from plan_cutters.domain.shapes import MOST_PIECES, Flank, flanks, flute_length, modes, rim_length, rim_radius, top_flank_angle
from plan_cutters.domain.verdicts import VerdictBuffer, Verdicts
from plan_cutters.errors import CutterError
from plan_cutters.kernels.codes import (
    ARC,
    BOTTOM,
    COLUMNS,
    CYLINDER,
    FLUTES,
    HIGH,
    KIND,
    LOW,
    OFFSET_OF,
    OVER_TIP,
    PART,
    RADIUS,
    RISE,
    ROUND,
    SCALE,
    SLOPE,
    TILT_FROM,
    TILT_TO,
    TOP,
    WIDE,
)


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Assembly(Record):
    """Pieces of a cutter and how it touches."""

    #: (m, k, COLUMNS) float: for each mode the same pieces, their heights counted from the mode's centre of curvature.
    piece: Floats
    #: (m, 5) float: of each: its offset from the axis, its radius of curvature (with the allowance), the tilts from and to at
    #: which it touches, rad, and its height over the tip.
    mode: Floats
    reach: float  #: Distance from the contact, mm, within which an obstacle counts as rear gouging: the flutes' diameter.
    #: `inner`, `end`: heights over the tip, mm, of two points of the axis: one as deep in the cutter as any, and the highest.
    inner: float
    end: float
    slack: float  #: By how much a point may be farther from the tool, or less deep in it, than asked for and still count, mm.
    flanks: tuple[Flank, ...] = ()  #: The straight sides with which it touches.

    @property
    def flat(self) -> float:
        """Radius of the flat of the tip, mm; 0 where the tip is round."""
        return self.touching_at(0.0)[0]

    def touching_at(self, tilt: float) -> tuple[float, float]:
        """How far from the axis it touches at a tilt, rad, and its radius of curvature there with the allowance, mm.

        At tilt 0 the first is the radius of the flat of its tip, at pi that of its upper face; both 0 where it touches at none.
        """
        modes = self.mode[(self.mode[:, TILT_FROM] <= tilt + HAIR) & (self.mode[:, TILT_TO] >= tilt - HAIR)]
        return (float(modes[0, OFFSET_OF]), float(modes[0, RISE])) if len(modes) else (0.0, 0.0)

    def only(self, part: int) -> "Assembly":
        """The pieces of one part alone."""
        mine = self.piece[0, :, PART] == part
        return replace(self, piece=np.ascontiguousarray(self.piece[:, mine]))

    def at(self, tilt: Floats) -> NDArray[np.int64]:
        """The mode (n,) in which it touches at each tilt, rad; the last one where it touches in none."""
        mode = np.full(len(tilt), len(self.mode) - 1)
        for i in range(len(self.mode) - 1, -1, -1):
            mode[(tilt >= self.mode[i, TILT_FROM] - HAIR) & (tilt <= self.mode[i, TILT_TO] + HAIR)] = i
        return mode

    def on_axis(self, contact: Floats, normal: Floats, tilt_direction: Floats, tilt: Floats) -> Floats:
        """The point (n, 3) of the axis as deep in the tool as any, at contacts, normals and leans (n, 3) and tilts (n,), rad."""
        offset, rise, _, _, height = self.mode[self.at(tilt)].T[:, :, None]
        cosine, sine = np.cos(tilt)[:, None], np.sin(tilt)[:, None]
        along = (self.inner - height) * (cosine * normal + sine * tilt_direction)
        return np.asarray(contact + rise * normal + along - offset * (cosine * tilt_direction - sine * normal))

    def lowest(self, point: Floats, normal: Floats, postures: Verdicts | VerdictBuffer, direction: Floats) -> Floats:
        """Heights (n,) along a unit direction below which nothing of it is, at the postures that touch points (n, 3) with unit
        normals (n, 3), mm; nan where there is none.

        Each piece is taken for the cylinder around it.
        """
        offset, rise, *_ = self.mode[(mode := self.at(postures.tilt))].T
        cosine, sine = np.cos(postures.tilt)[:, None], np.sin(postures.tilt)[:, None]
        across = cosine * postures.tilt_direction - sine * normal
        centre = postures.contact(point) + rise[:, None] * normal - offset[:, None] * across
        along, (low, high, wide) = postures.axis @ direction, np.moveaxis(self.piece[:, :, [BOTTOM, TOP, WIDE]], 2, 0)
        ends = np.minimum(low[mode] * along[:, None], high[mode] * along[:, None])
        sideways = wide[mode] * np.sqrt(np.maximum(0.0, 1.0 - along * along))[:, None]
        return np.asarray(centre @ direction + (ends - sideways).min(axis=1))

    def from_axis(self, point: Floats, normal: Floats, postures: Verdicts | VerdictBuffer) -> Floats:
        """Shortest ways (n, 3) from its axis to points (n, 3) with unit normals (n, 3), at the postures that touch them, mm."""
        on_axis = self.on_axis(postures.contact(point), normal, postures.tilt_direction, postures.tilt)
        way = point - on_axis
        return np.asarray(way - (way * postures.axis).sum(axis=1)[:, None] * postures.axis)

    def depth(self, points: Floats, contact: Floats, normal: Floats, tilt_direction: Floats, tilt: float) -> Floats:
        """Bound from below how deep points (n, 3) lie in the tool at a contact and posture; negative outside."""
        offset, rise, *_ = self.mode[(mode := int(self.at(np.array([tilt]))[0]))]
        axis, x_t = (np.cos(tilt) * normal + np.sin(tilt) * tilt_direction, np.cos(tilt) * tilt_direction - np.sin(tilt) * normal)
        from_centre = points - (contact + rise * normal - offset * x_t)
        height = (from_centre @ axis)[:, None]
        q = np.linalg.norm(from_centre - height * axis, axis=1)[:, None]
        row = self.piece[mode].T[:, None]
        side = (row[RADIUS] + row[SLOPE] * (height - row[BOTTOM]) - q) * row[SCALE]
        arc = row[ROUND] - np.hypot(np.maximum(0.0, q - row[RADIUS]), height - row[SLOPE])
        deep = np.minimum(np.where(row[KIND] == ARC, arc, side), np.minimum(height - row[LOW], row[HIGH] - height))
        return np.asarray(deep.max(axis=1))

    @property
    def flutes(self) -> int:
        """The mask of the pieces that cut."""
        return sum(1 << k for k, part in enumerate(self.piece[0, :, PART]) if part == FLUTES)

    def noses(self, taper: float, shape: str) -> tuple[NDArray[np.int64], Floats]:
        """Of each mode the pieces, a mask, that lie in what its nose sweeps when it goes on along the axis, and the angle by
        which it widens, rad: what curvature alone holds against the surface near the contact (`docs/between_samples.md`).
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


@lru_cache(maxsize=1024)
def assembly(cutter: Cutter, flutes: float, rest: float, *, kind: Kind = "outer") -> Assembly:
    """Pieces of a cutter.

    `cutter`: its own allowance and clearance are counted in. `flutes`: depth in the flutes up to which a point does not count,
    mm; negative: it counts within that distance of them. `rest`: the same for neck, shank and holder. `kind`: `outer`: no point
    that counts is outside the pieces. `inner`: every point of the pieces counts.
    """
    flutes, rest = flutes - (cutter.allowance or 0.0), rest - (cutter.clearance or 0.0)
    bands = [Band(PARTS[part], low, stage, rest) for part, low, stage in cutter.stages]
    top = flute_length(cutter)
    rows = []
    if kind == "inner" or not bands:
        # Grown ones end with square edges, which may hold too much, or below all edges.
        rows += pieces.flute_rows(cutter, flutes, top + flutes if kind == "inner" and flutes < 0.0 else top - flutes, kind)
        for band in bands:
            rows += pieces.alone(band)
    else:
        first = bands[0]
        straight = (rim_length(cutter), first.stage.length if first.stage.slope >= 0.0 else 0.0)
        end, start = pieces.seam(rim_radius(cutter), flutes, first.stage.radius, first.inset, top, straight)
        if cutter.shape == "lollipop":
            rows += pieces.opening(cutter, flutes, top)
        else:
            rows += pieces.between(rim_radius(cutter), top_flank_angle(cutter), first.stage.radius, first.flank_angle, top,
                            min(flutes, first.inset), FLUTES)  # fmt: skip
            if first.inset <= 0.0 and end >= top:
                rows += pieces.kink(min(rim_radius(cutter), first.stage.radius), top_flank_angle(cutter), top, flutes, FLUTES)
        if flutes < 0.0:
            end = max(end, top + flutes * min(0.0, math.sin(top_flank_angle(cutter))))
        rows += pieces.flute_rows(cutter, flutes, end, kind)
        for i, band in enumerate(bands):
            if i + 1 < len(bands):
                above = bands[i + 1]
                end, after = pieces.seam(band.stage.upper_radius, band.inset, above.stage.radius, above.inset, band.high)
                rows += pieces.between(
                    band.stage.upper_radius, band.flank_angle, above.stage.radius, above.flank_angle, band.high,
                    min(band.inset, above.inset), band.part,
                )  # fmt: skip
            else:
                end, after = band.high - band.inset, math.inf
            rows += pieces.among(band, start, end, exact=(cutter.clearance or 0.0) > 0.0)
            start = after
    table = np.array([row for row in rows if pieces.solid(row)], float).reshape(-1, COLUMNS)
    if len(table) > MOST_PIECES:
        raise CutterError(f"cutter {cutter.typed}: it has more sections than can be judged; give fewer that enclose it")
    grown_by = cutter.allowance or 0.0
    touching = np.array([(each.offset, each.radius + grown_by, each.low, each.high, each.height) for each in modes(cutter)])
    inner, highest = _inner(cutter, bands)
    return Assembly(
        _placed(table, touching[:, 4]), touching, 2.0 * cutter.radius, inner, min(highest, float(table[:, TOP].max(initial=0.0))),
        _slack(cutter, flutes, bands, kind), flanks(cutter),
    )  # fmt: skip


def placed(tool: Assembly, table: Floats) -> Assembly:
    """A tool that touches in the same way with other pieces, rows (k, COLUMNS) whose heights are over the tip."""
    return replace(tool, piece=_placed(table, tool.mode[:, OVER_TIP]))


def _placed(table: Floats, height: Floats) -> Floats:
    """Rows (k, COLUMNS) for each mode (m,), their heights counted from that of its centre: (m, k, COLUMNS)."""
    rows = np.repeat(table[None], len(height), axis=0)
    for i, centre in enumerate(height.tolist()):
        rows[i][:, [LOW, HIGH, BOTTOM, TOP]] -= centre
        arcs = rows[i][:, KIND] == ARC
        rows[i][arcs, SLOPE] -= centre
    return rows


def _inner(cutter: Cutter, bands: list[Band]) -> tuple[float, float]:
    """Heights of a point of the axis as deep in the cutter as any and as near to the spindle as can be, and of its end."""
    if not bands:
        return max(0.5 * cutter.length, cutter.length - cutter.radius), cutter.length
    deepest = max(bands, key=lambda band: min(band.stage.radius, band.stage.upper_radius, 0.5 * band.stage.length))
    return deepest.low + 0.5 * deepest.stage.length, bands[-1].high


def _run_down(inset: float, band: Band, top: float) -> float:
    """How far from what counts a point is that a narrower band holds where it runs down into flutes that lean by `top`, mm.

    At t below their end, and q - r beyond the radius r of the band, which is grown by g, it is t deep, or less next to their
    side, and hypot(q - r, t) from the band. The least of both is largest where `inset` - t = hypot(q - r, t) - g at the
    widest q (`docs/tools.md`).
    """
    if inset <= 0.0:
        return 0.0
    grown, slope = max(0.0, -band.inset), band.stage.slope
    wide = grown * (math.hypot(1.0, slope) + abs(slope))
    below = (inset**2 - grown**2 + wide**2) / (2.0 * (inset + grown))
    above = inset * (1.0 + math.sin(top)) - (inset + grown - wide) * math.cos(top)
    return min(math.hypot(wide, inset) - grown, max(below, above))


def _slack(cutter: Cutter, inset: float, bands: list[Band], kind: Kind) -> float:
    """How far at most a point is from what counts though a cover piece holds it, mm."""
    if kind == "inner":
        return 0.0
    most = 0.0
    for band in bands:
        if band.inset < 0.0 and (cutter.clearance or 0.0) > 0.0:
            # Where there is no step a side ends at its seam's height though its normal there does not lie along it.
            most = max(most, -band.inset * (1.0 / math.cos(band.flank_angle) - 1.0))
        elif band.inset < 0.0:
            half = 0.25 * math.pi + 0.5 * abs(band.flank_angle)
            most = max(most, -band.inset * (1.0 / math.cos(half) - 1.0))
    if cutter.shape == "form":
        for i, ((r0, w0), (r1, w1)) in enumerate(pairwise(cutter.outline)):
            if inset < 0.0:
                most = max(most, pieces.sharpest(cutter.outline, i, inset))
            if w1 > w0:
                # Grown sides end at the heights of their corners.
                grown = -inset * (math.hypot(1.0, (r1 - r0) / (w1 - w0)) - 1.0)
                most = max(most, inset - pieces.least_depth(cutter.outline, i, inset) if inset > 0.0 else grown)
    top = abs(top_flank_angle(cutter))
    if inset < 0.0:
        # Grown flutes have square upper edges.
        most = max(most, -inset * (1.0 / math.cos(0.25 * math.pi + 0.5 * top) - 1.0))
    elif bands:
        # Sides that lean end at their seam's height though their normals there do not lie along it.
        most = max(most, inset * (1.0 - math.cos(top)))
        if bands[0].stage.radius < rim_radius(cutter):
            most = max(most, _run_down(inset, bands[0], top))
        if cutter.shape == "lollipop":
            most = max(most, inset)
    for flank_angle, depth in (
        (top, min(inset, bands[0].inset) if bands else 0.0),
        *((abs(b.flank_angle), b.inset) for b in bands),
    ):
        if depth > 0.0:
            most = max(most, depth * (1.0 - math.cos(0.25 * math.pi + 0.5 * flank_angle) + math.tan(flank_angle)))
    return most


#: Neck, shank and holder count for a clearance: flutes lie along the walls that they cut. Of a bare cutter its flutes count, too.
#: Clearances are looked for up to this, mm, and told to this share of them, or to `FINEST`, whichever is more.
MOST, SHARE, FINEST = 100.0, 0.02, 0.005


def grown(cutter: Cutter, by: float) -> Assembly:
    """Build the cutter as far as it counts, with all points that are no farther from it than a distance, mm.

    Neck, shank and holder are grown exactly. The flutes' pieces hold a little more at their edges, never less.

    `cutter`: its own allowance and clearance are not counted in. `by`: not negative.
    """
    # Where a bare cutter works, up to its diameter, flutes do not count.
    rows, low = list[list[float]](), 2.0 * cutter.radius
    if not cutter.stages and flute_length(cutter) > low:
        rows = [_from(row, low - by) for row in pieces.flute_rows(cutter, -by, flute_length(cutter) + by, "outer")]
    for part, low, stage in cutter.stages:
        rows += pieces.alone(Band(PARTS[part], low, stage, -by))
    table = np.array([row for row in rows if pieces.solid(row)], float).reshape(-1, COLUMNS)
    return placed(assembly(cutter, 0.0, 0.0), table)


def rungs(cutter: Cutter) -> Floats:
    """The clearances (k,) that are looked at, mm, ascending from 0; the one asked for is among them."""
    steps = [0.0]
    while steps[-1] < MOST:
        steps.append(min(MOST, steps[-1] + max(FINEST, SHARE * steps[-1])))
    return np.unique(np.round([*steps, cutter.clearance or 0.0], 6))


def part_words() -> dict[int, str]:
    """Give the names of the parts of an assembly, by their numbers."""
    return {FLUTES: "flutes", **{number: word for word, number in PARTS.items()}}


def _from(row: list[float], low: float) -> list[float]:
    """Cut a piece off below a height, mm, and keep the rest."""
    if row[LOW] >= low:
        return row
    if row[KIND] == ARC:
        return pieces.row_of(ARC, low, row[HIGH], row[RADIUS], row[SLOPE], row[ROUND], int(row[PART]))
    return pieces.band_row(low, row[HIGH], row[RADIUS] + row[SLOPE] * (low - row[LOW]), row[SLOPE], int(row[PART]))
