"""Where to lay the grid lines of a face, in its parameter plane, and where they are too coarse for it.

How far is a face, up to its border, from the samples on its grid? Between four nodes of the face no point is farther from the
nearest of them than half the diagonal, 0.71 of the spacing. Only where the border cuts cells may points be farther, in a tip that
no node hits above all: there are the probes.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from OCP.GeomAbs import GeomAbs_CN
from scipy.spatial import cKDTree

from cad_io.arrays import Floats
from cad_io.face.trim import Trim
from cad_io.kernel import domain, periods
from cad_io.part import Part
from cad_io.surface import Surface
from cad_io.surface.surface import lines_within

#: How far lines stay from a border that is a single point, as a share of the range.
INWARD = 1e-4
_ENDLESS = 1e50  # the kernel's infinite parameters are 2e100
_SAME = 1e-7  # of a range
_MOST_NODES = 2_000_000
_LEAST_LINES = 3
_PROBES = (17, 97)  # least and most probes of speed a direction
#: Pieces are uneven where one is so small a share of the range; shares of a piece at which it is looked at; pieces at most.
_UNEVEN, _WITHIN, _PIECES = 1e-3, np.array([0.05, 0.25, 0.5, 0.75, 0.95]), 1000


class Lines(NamedTuple):
    """Increasing grid lines; closed: the last line's neighbour is the first. `span` is the whole range of each."""

    u: Floats
    v: Floats
    closed_u: bool
    closed_v: bool
    span: tuple[float, float, float, float]


class _Range(NamedTuple):
    low: float
    high: float
    closed: bool
    point_low: bool
    point_high: bool

    def lines(self, share: Floats) -> Floats:
        """Lines at shares (0 to 1) of the range; a seam once, and off borders that are single points."""
        lines = self.low + (self.high - self.low) * (share[:-1] if self.closed else share)
        if self.point_low:
            lines[0] += INWARD * (self.high - self.low)
        if self.point_high and not self.closed:
            lines[-1] -= INWARD * (self.high - self.low)
        return lines


def uniform(surface: Surface, trim: Trim, count: int) -> Lines:
    """`count` lines each way, uniform over the surface's own domain, ends included.

    A surface without end in some direction has no domain of its own; there the trim's box serves.
    """
    natural = domain(surface.adaptor)
    endless = max(abs(x) for x in natural) > _ENDLESS
    share = np.linspace(0.0, 1.0, count)
    return _laid(_ranges(surface, trim, trim.box if endless else natural), (share, share))


def _laid(ranges: tuple[_Range, _Range], shares: tuple[Floats, Floats]) -> Lines:
    u, v = ranges
    return Lines(u.lines(shares[0]), v.lines(shares[1]), u.closed, v.closed, (u.low, u.high, v.low, v.high))


def spaced(
    surface: Surface,
    trim: Trim,
    spacing: float,
    more: tuple[float, float] = (1.0, 1.0),
    finer: int = 1,
    most: float = _MOST_NODES,
) -> Lines:
    """Lines over the trim's box so that neighbours are at most `spacing` mm apart, `more` and `finer` times as many if asked.

    Lines are laid by the largest speed across them, so the gap holds everywhere as far as the probes saw, unless they would have
    more than `most` nodes.
    """
    ranges = _ranges(surface, trim, trim.box)
    probes = [_probes(surface, k, (each.low, each.high)) for k, each in enumerate(ranges)]
    u, v = np.meshgrid(*(r.low + at * (r.high - r.low) for r, at in zip(ranges, probes, strict=True)), indexing="ij")
    d = surface.first(u.ravel(), v.ravel()).reshape(*u.shape, 3, 3)
    speed = np.nan_to_num(np.linalg.norm(d[:, :, 1:], axis=3))
    most_speed = [speed[..., k].max(axis=1 - k) * (each.high - each.low) for k, each in enumerate(ranges)]
    lengths = [*map(_cumulative, most_speed, probes)]
    gaps = finer * np.array([max(np.ceil(more[k] * lengths[k][-1] / spacing), _LEAST_LINES - 1) for k in (0, 1)])
    gaps = np.where([each.closed for each in ranges], np.maximum(gaps, _LEAST_LINES), gaps)
    gaps = np.maximum(gaps / max(1.0, np.sqrt(gaps.prod() / min(most, _MOST_NODES))), 2).astype(int)
    along_u, along_v = (
        np.interp(np.linspace(0.0, length[-1], gap + 1), length, at)
        for length, gap, at in zip(lengths, gaps, probes, strict=True)
    )
    return _laid(ranges, (along_u, along_v))


def _probes(surface: Surface, along: int, ends: tuple[float, float]) -> Floats:
    """Shares of a range at which speed across lines is looked at: as many as there are pieces, and where pieces are uneven
    within each of them, for a narrow one may be run through a million times as fast as the rest."""
    adaptor = surface.adaptor
    spans = adaptor.NbVIntervals(GeomAbs_CN) if along else adaptor.NbUIntervals(GeomAbs_CN)
    even = np.linspace(0.0, 1.0, int(np.clip(2 * spans + 1, *_PROBES)))
    width = ends[1] - ends[0]
    if surface.form is None or not width > 0.0:
        return even
    knots, _ = lines_within(surface.form.knots[along], surface.form.jumps[along], surface.form.period[along], ends)
    pieces = np.unique(np.concatenate([[0.0], (knots - ends[0]) / width, [1.0]]))
    if np.diff(pieces).min() >= _UNEVEN or len(pieces) > _PIECES:
        return even
    within = pieces[:-1, None] + np.diff(pieces)[:, None] * _WITHIN
    return np.unique(np.concatenate([even, pieces, within.ravel()]))


def _cumulative(speed: Floats, share: Floats) -> Floats:
    # A floor keeps the inverse defined where the surface stands still (a collapsed border).
    speed = np.maximum(speed, 1e-6 * max(speed.max(), 1e-300))
    # The larger of both ends, so that a gap between probes is not underrated.
    return np.concatenate([[0.0], np.cumsum(np.maximum(speed[1:], speed[:-1]) * np.diff(share))])


def _ranges(surface: Surface, trim: Trim, bounds: tuple[float, float, float, float]) -> tuple[_Range, _Range]:
    adaptor = surface.adaptor
    u0, u1, v0, v1 = bounds
    turn_u, turn_v = periods(adaptor)
    u0, u1 = _shifted(u0, u1, *trim.box[:2], turn_u) if turn_u else (u0, u1)
    v0, v1 = _shifted(v0, v1, *trim.box[2:], turn_v) if turn_v else (v0, v1)
    first_u, last_u, first_v, last_v = domain(adaptor)
    closed_u = adaptor.IsUClosed() and _whole(u1 - u0, first_u, last_u)
    closed_v = adaptor.IsVClosed() and _whole(v1 - v0, first_v, last_v)
    # A closed border may lie anywhere on its loop, so a few points on it tell whether it is a single point.
    share = np.array([0.0, 0.13, 0.37, 0.61, 0.89])
    u, v = u0 + share * (u1 - u0), v0 + share * (v1 - v0)
    size = float(np.hypot(trim.scale[0] * (u1 - u0), trim.scale[1] * (v1 - v0)))

    def is_point(us: Floats, vs: Floats) -> bool:
        points = surface.values(us, vs)
        return bool(np.linalg.norm(points - points[0], axis=1).max() < 1e-7 * size)

    return (
        _Range(u0, u1, closed_u, is_point(np.full(5, u0), v), is_point(np.full(5, u1), v)),
        _Range(v0, v1, closed_v, is_point(u, np.full(5, v0)), is_point(u, np.full(5, v1))),
    )


def _shifted(low: float, high: float, trim_low: float, trim_high: float, period: float) -> tuple[float, float]:
    """The range moved so that it covers a trim that lies on another turn."""
    slack = _SAME * period
    if trim_low >= low - slack and trim_high <= high + slack:
        return low, high
    return trim_low, trim_low + (high - low)


def _whole(span: float, first: float, last: float) -> bool:
    # A border that runs on beyond a whole turn has ends that are no neighbours.
    return abs(span - (last - first)) <= _SAME * (last - first)


_STEPS, _FEW = 20_000, 200  # along the border, at most: among many samples, or about one
_A_GAP = 12  # probes of the border to a gap
_STRAIGHT = 0.98  # cosine of the angle between segments of the border from which on they make a corner


class Probes(NamedTuple):
    """Places of a face that the border keeps from nodes: parameters uv (k, 2), and their points (k, 3), mm."""

    uv: Floats
    point: Floats

    def distance(self, samples: Floats) -> Floats:
        """To the nearest of the samples (n, 3), mm: (k,)."""
        samples = samples[np.isfinite(samples).all(axis=1)]
        if not (len(samples) and len(self.point)):
            return np.zeros(len(self.point))
        return np.asarray(cKDTree(samples).query(self.point)[0])


def border_probes(part: Part, number: int, gap: float) -> Probes:
    """Points along the border of a face and at its corners, some to a gap, mm."""
    trim = part.trim(number)
    if trim is None:
        return Probes(np.zeros((0, 2)), np.zeros((0, 3)))
    along = (trim.segments[:, 1] - trim.segments[:, 0]) * trim.scale
    length = np.linalg.norm(along, axis=1)
    end = np.cumsum(length)
    count = _A_GAP * end[-1] / gap if gap else _FEW
    at = np.linspace(0.0, end[-1], int(np.clip(np.ceil(count), 1, _STEPS)), endpoint=False)
    which = np.minimum(np.searchsorted(end, at, "right"), len(end) - 1)
    share = np.clip((at - end[which] + length[which]) / np.maximum(length[which], 1e-300), 0.0, 1.0)[:, None]
    # Corners are the farthest: starts of segments that go another way than the one before.
    before = np.roll(along, 1, axis=0)
    corner = (along * before).sum(axis=1) < _STRAIGHT * length * np.roll(length, 1)
    between = (1 - share) * trim.segments[which, 0] + share * trim.segments[which, 1]
    return _probes_at(part, number, np.concatenate([between, trim.segments[corner, 0]]))


def inner_probes(part: Part, number: int, lines: Lines, finer: NDArray[np.bool_]) -> Probes:
    """Nodes of the halved grid inside the face, in cells of which not all corners are; `finer`: which nodes lie in the face."""
    whole = finer[:-2:2, :-2:2] & finer[2::2, :-2:2] & finer[:-2:2, 2::2] & finer[2::2, 2::2]
    neighbours = np.zeros(finer.shape, bool)
    for du in range(3):
        for dv in range(3):
            neighbours[du : du + 2 * whole.shape[0] - 1 : 2, dv : dv + 2 * whole.shape[1] - 1 : 2] |= ~whole
    neighbours[::2, ::2] = False
    i, j = np.nonzero(finer & neighbours)
    u, v = halved(lines)
    return _probes_at(part, number, np.stack([u[i], v[j]], axis=1))


def halved(lines: Lines) -> tuple[Floats, Floats]:
    """Grid lines and those half way between; of a closed range up to the seam's other end."""
    halves = []
    for line, closed, low, high in ((lines.u, lines.closed_u, *lines.span[:2]), (lines.v, lines.closed_v, *lines.span[2:])):
        whole = np.append(line, line[0] + high - low) if closed else line
        between = np.empty(2 * len(whole) - 1)
        between[::2], between[1::2] = whole, 0.5 * (whole[1:] + whole[:-1])
        halves.append(between)
    return halves[0], halves[1]


def denser(lines: Lines, finer: NDArray[np.bool_], uv: Floats, trim: Trim) -> Lines:
    """Lines with those halved that cut the cells of some places uv (k, 2).

    Along the direction in which the new line has nodes in the face, if one has: along both where none has, and along the
    wider one where both have.
    """
    u, v = halved(lines)
    i = np.clip(np.searchsorted(u[::2], uv[:, 0], "right") - 1, 0, len(u) // 2 - 1)
    j = np.clip(np.searchsorted(v[::2], uv[:, 1], "right") - 1, 0, len(v) // 2 - 1)
    on_u = finer[2 * i + 1, 2 * j] | finer[2 * i + 1, 2 * j + 2]
    on_v = finer[2 * i, 2 * j + 1] | finer[2 * i + 2, 2 * j + 1]
    wide = (u[2 * i + 2] - u[2 * i]) * trim.scale[0] >= (v[2 * j + 2] - v[2 * j]) * trim.scale[1]
    along_u, along_v = np.where(on_u & on_v, wide, ~on_v | on_u), np.where(on_u & on_v, ~wide, ~on_u | on_v)
    return lines._replace(
        u=np.union1d(lines.u, u[2 * np.unique(i[along_u]) + 1]), v=np.union1d(lines.v, v[2 * np.unique(j[along_v]) + 1])
    )


def _probes_at(part: Part, number: int, uv: Floats) -> Probes:
    point = part.surface(number).values(uv[:, 0], uv[:, 1])
    known = np.isfinite(point).all(axis=1)
    return Probes(uv[known], point[known])
