"""The tool in the checker's own terms: convex bodies of revolution, how deep a point lies in each, and where the tool touches.

Each body is all that is below some lines and inside some arcs of its half section. How deep a point lies in it, negative
outside, is a concave function of the point: so a tangent plane of it bounds it everywhere, which the search for deep points
over cells of a surface rests on (`bounds`).
"""

import math
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from cad_io.arrays import Floats
from plan_cutters_check.question import ToolSizes

Point = tuple[float, float]
_DOWN, _OUT = -math.pi / 2, 0.0
#: Angles within this of the end of an arc are on it, rad.
_HAIR = 1e-9
#: Surfaces that are farther off the tilts at which a tool touches are not along its flank, rad.
_OFF = 0.1
#: Tilts up to which any side of the bottom may touch, rad; sines below which an axis is the normal; directions that are one.
FLAT, _UPRIGHT, _SAME = 1e-4, 1e-12, 1e-6


@dataclass(frozen=True, slots=True)
class Arc:
    """An arc of a half section: centre (q, h), radius, and from where to where its normals point, rad from the radius upwards."""

    q: float
    h: float
    radius: float
    first: float
    last: float


@dataclass(frozen=True, slots=True)
class Solid:
    """A convex body about the tool axis, a `part` of the tool: `flutes`, `neck`, `shank` or `holder`; height of its top in mm.

    `lines` (k, 3): unit normal (q, h) and offset of each, within n (q, h) <= offset; `border` (s, 4): straight pieces of its
    outline, from (q, h) to (q, h).
    """

    part: str
    lines: Floats
    arcs: tuple[Arc, ...]
    border: Floats
    high: float

    def depth(self, q: Floats, h: Floats) -> tuple[Floats, Floats, Floats]:
        """How deep points (n,) lie in it, mm, negative outside, and a gradient of that in q and in h."""
        n_q, n_h, offset = self.lines.T
        each = offset - np.multiply.outer(q, n_q) - np.multiply.outer(h, n_h)
        line = each.argmin(axis=1)
        deep, g_q, g_h = each[np.arange(len(q)), line], -n_q[line], -n_h[line]
        for arc in self.arcs:
            c, s, away = _nearest(arc, q, h)
            own = arc.radius - ((q - arc.q) * c + (h - arc.h) * s)
            less = (own < deep) & (away > 0.0)
            deep, g_q, g_h = np.where(less, own, deep), np.where(less, -c, g_q), np.where(less, -s, g_h)
        out = np.flatnonzero(deep < 0.0)
        if len(out):
            deep[out], g_q[out], g_h[out] = self._outside(q[out], h[out])
        return deep, g_q, g_h

    def _outside(self, q: Floats, h: Floats) -> tuple[Floats, Floats, Floats]:
        """The same outside of it: less the distance from the nearest point of its outline."""
        near = []
        for a, b, c, d in self.border.tolist():
            length = (c - a) ** 2 + (d - b) ** 2
            share = np.clip(((q - a) * (c - a) + (h - b) * (d - b)) / max(length, 1e-300), 0.0, 1.0)
            near.append((a + share * (c - a), b + share * (d - b)))
        for arc in self.arcs:
            c_, s_, _ = _nearest(arc, q, h)
            near.append((np.maximum(0.0, arc.q + arc.radius * c_), arc.h + arc.radius * s_))
        to_q, to_h = np.moveaxis(np.array(near), 1, 0)
        away = np.hypot(q - to_q, h - to_h)
        best = away.argmin(axis=0), np.arange(len(q))
        size = np.maximum(away[best], 1e-300)
        return -away[best], (to_q[best] - q) / size, (to_h[best] - h) / size


def _nearest(arc: Arc, q: Floats, h: Floats) -> tuple[Floats, Floats, Floats]:
    """Cosine and sine of the direction of an arc's normals nearest to that of points (n,), and their distance from its centre."""
    p, w = q - arc.q, h - arc.h
    turn = np.arctan2(w, p)
    middle = 0.5 * (arc.first + arc.last)
    turn = middle + np.remainder(turn - middle + math.pi, 2.0 * math.pi) - math.pi
    turn = np.clip(turn, arc.first, arc.last)
    return np.cos(turn), np.sin(turn), np.hypot(p, w)


@dataclass(frozen=True, slots=True)
class Tool:
    """A cutter with all that is above it: `solids`, the flutes first; lengths in mm.

    `contacts`: the arcs, and corners as arcs of radius 0, with which it touches, from the tip up; `high`: of all of it;
    `straight`: whether above its last contact its side is straight.
    """

    solids: tuple[Solid, ...]
    contacts: tuple[Arc, ...]
    allowance: float
    clearance: float
    high: float
    straight: bool

    @property
    def flat(self) -> float:
        """Radius of the flat of its tip, mm; 0 where there is none."""
        for arc in self.contacts:
            if arc.first - _HAIR <= _DOWN <= arc.last + _HAIR:
                return arc.q if abs(arc.h - arc.radius) <= _HAIR else 0.0
        return 0.0

    def tips(
        self, contact: Floats, normal: Floats, axis: Floats, tilt_direction: Floats, accuracy: float = FLAT, keep: float = 0.0
    ) -> Floats:
        """Where its tip is, (n, 3), with its contact at points (n, 3); nan where it does not touch at that tilt.

        `tilt_direction` (n, 3) says which side of the bottom touches where the axis is the normal within an accuracy, rad; it is
        shorter than 1 where the contact is under the flat of the tip. Twice the axis says that the flank stands along a wall that
        holds the axis within the accuracy, and keeps a distance from it, mm.
        """
        accuracy = max(accuracy, FLAT)
        cosine = np.clip((normal * axis).sum(axis=1), -1.0, 1.0)
        from_normal = axis - cosine[:, None] * normal
        sine = np.linalg.norm(from_normal, axis=1)
        tilt = np.arctan2(sine, cosine)
        # From the axis to the contact: across the axis, away from the normal.
        outward = -normal + cosine[:, None] * axis
        sideways = tilt_direction - (tilt_direction * axis).sum(axis=1)[:, None] * axis
        size = np.linalg.norm(sideways, axis=1)
        with np.errstate(invalid="ignore", divide="ignore"):
            turned = np.linalg.norm(tilt_direction - from_normal / sine[:, None], axis=1) > _SAME
            upright = (tilt <= accuracy) & ((sine < _UPRIGHT) | turned)
            along = self.stands_along(normal, axis, tilt_direction, accuracy)
            outward = outward / np.linalg.norm(outward, axis=1)[:, None]
            # A direction that is one within rounding touches with the rim.
            rim = np.abs(size - 1.0) <= _SAME
            outward = np.where(upright[:, None], sideways / np.where(rim, size, 1.0)[:, None], outward)
            # Under a ceiling the axis points from the contact the other way round.
            below = (cosine < 0.0) & (sine < _UPRIGHT)
            outward = np.where(below[:, None], -sideways / size[:, None], outward)
        wrong = (upright & ((size > 1.0 + _SAME) | ((size < 1.0 - _SAME) & (self.flat == 0.0)))) | ~np.isfinite(size)
        contact = np.where(along[:, None], contact - keep * outward, contact)
        normal = np.where(upright[:, None], axis, np.where(along[:, None], -outward, normal))
        tilt = np.select([upright, along], [0.0, 0.5 * math.pi], tilt)
        tips, open_rows = np.full(contact.shape, np.nan), ~wrong
        # A flank may lie along a surface that is not quite at its tilt.
        for arc, off in ((arc, off) for off in ((_HAIR, _OFF) if self.straight else (_HAIR,)) for arc in self.contacts):
            mine = open_rows & (tilt + _DOWN >= arc.first - off) & (tilt + _DOWN <= arc.last + off)
            centre = contact[mine] + (arc.radius + self.allowance) * normal[mine]
            tips[mine] = centre - arc.q * outward[mine] - arc.h * axis[mine]
            open_rows &= ~mine
        return tips

    def stands_along(self, normal: Floats, axis: Floats, tilt_direction: Floats, accuracy: float) -> NDArray[np.bool_]:
        """Where a tilt direction says that the flank stands along a wall, and the wall holds the axis within an accuracy."""
        twice = np.linalg.norm(tilt_direction - 2.0 * axis, axis=1) <= _SAME
        return np.asarray(twice & (np.abs((normal * axis).sum(axis=1)) <= math.sin(accuracy) + _SAME))


def _line(a: Point, b: Point) -> tuple[float, float, float]:
    """The line through two points of an outline that is walked upwards: the body is to its left."""
    n_q, n_h = b[1] - a[1], a[0] - b[0]
    size = math.hypot(n_q, n_h)
    return n_q / size, n_h / size, (n_q * a[0] + n_h * a[1]) / size


def _solid(part: str, points: list[Point], arcs: tuple[Arc, ...] = (), bent: frozenset[int] = frozenset()) -> Solid:
    """A body from the points of its outline, from the axis below up to where it goes back to it; `bent`: sides that are arcs."""
    points = [*points, (0.0, points[-1][1])]
    sides = [(a, b) for k, (a, b) in enumerate(pairwise(points)) if k not in bent and math.dist(a, b) > 1e-12]
    lines, ends = np.array([_line(a, b) for a, b in sides]), np.array([(*a, *b) for a, b in sides])
    return Solid(part, lines, tuple(arc for arc in arcs if arc.radius > 0.0), ends, max(h for _, h in points))


def tool_of(sizes: ToolSizes) -> Tool:
    """Build the solids of a cutter from its dimensions."""
    if sizes.shape == "form":
        solids = [_solid("flutes", [(0.0, a[1]), a, b]) for a, b in pairwise(sizes.outline) if b[1] > a[1]]
        contacts = _hull(sizes.outline)
    else:
        points, contacts, bent = _outline(sizes)
        solids = [_solid("flutes", points, contacts, frozenset(bent))]
    for each in sizes.sections:
        ends = [(0.0, each.low), (each.radius, each.low), (each.upper_radius, each.low + each.length)]
        solids.append(_solid(each.part, ends))
    high, straight = max(each.high for each in solids), sizes.shape in ("end", "lens")
    return Tool(tuple(solids), contacts, sizes.allowance, sizes.clearance, high, straight)


def _outline(sizes: ToolSizes) -> tuple[list[Point], tuple[Arc, ...], set[int]]:
    """Points of the flutes' outline from the axis up, the arcs with which they touch, and which sides of it are arcs."""
    r, corner, top, wide = sizes.radius, sizes.corner_radius, sizes.flutes, sizes.arc_radius
    if sizes.shape == "lollipop":
        edge = math.sqrt(max(0.0, r * r - (top - r) ** 2))
        return [(0.0, 0.0), (edge, top)], (Arc(0.0, r, r, _DOWN, math.atan2(top - r, edge)),), {0}
    if sizes.shape == "lens":
        inner, outer = r - corner, wide - corner
        joint = math.asin(min(1.0, inner / outer))
        high = wide - math.sqrt(max(0.0, outer**2 - inner**2))
        foot = (wide * math.sin(joint), wide * (1.0 - math.cos(joint)))
        arcs = Arc(0.0, wide, wide, _DOWN, _DOWN + joint), Arc(inner, high, corner, _DOWN + joint, _OUT)
        return [(0.0, 0.0), foot, (r, high), (r, top)], arcs, {0, 1}
    if sizes.shape == "barrel":
        last = math.asin(max(-1.0, min(1.0, (top - sizes.arc_height) / wide)))
        end = (r - wide + wide * math.cos(last), top)
        if corner:
            joint = math.asin(min(1.0, (wide - r) / (wide - corner)))
            foot = (corner * math.sin(joint), corner * (1.0 - math.cos(joint)))
            tip = Arc(0.0, corner, corner, _DOWN, _DOWN + joint)
            return [(0.0, 0.0), foot, end], (tip, Arc(r - wide, sizes.arc_height, wide, _DOWN + joint, last)), {0, 1}
        first = math.asin(max(-1.0, -sizes.arc_height / wide))
        foot = (r - wide + wide * math.cos(first), 0.0)
        return [(0.0, 0.0), foot, end], (Arc(r - wide, sizes.arc_height, wide, first, last),), {1}
    arc = Arc(r - corner, corner, corner, _DOWN, -sizes.taper)
    foot = (arc.q + corner * math.cos(sizes.taper), corner * (1.0 - math.sin(sizes.taper)))
    end = (foot[0] + (top - foot[1]) * math.tan(sizes.taper), top)
    return [(0.0, 0.0), (r - corner, 0.0), foot, end], (arc,), {1}


def _hull(outline: tuple[Point, ...]) -> tuple[Arc, ...]:
    """The corners of an outline's convex hull, with which it can touch a plane."""
    hull: list[Point] = []
    for point in outline:
        while len(hull) > 1:
            (a, b), (c, d) = hull[-2:]
            if (c - a) * (point[1] - d) - (d - b) * (point[0] - c) > 0.0:
                break
            hull.pop()
        hull.append(point)
    turns = [math.atan2(b[1] - a[1], b[0] - a[0]) + _DOWN for a, b in pairwise(hull)]
    ends = [_DOWN, *turns, max(turns[-1], _OUT)]
    return tuple(
        Arc(q, h, 0.0, max(_DOWN, first), last)
        for (q, h), first, last in zip(hull, ends, ends[1:], strict=False)
        if last > max(first, _DOWN)
    )


def bounds(solid: Solid, tip: Floats, axis: Floats, point: Floats, offset: Floats) -> tuple[Floats, Floats]:
    """How deep points (n, 3) lie in a body whose tool stands at tips and axes (n, 3), and a bound of that over their cells.

    `offset` (n, k, 3) are the corners of each cell as seen from its point: over the cell's flat hull the depth is at most that of
    the tangent plane of the depth at the point.
    """
    away = point - tip
    h = (away * axis).sum(axis=1)
    radial = away - h[:, None] * axis
    q = np.linalg.norm(radial, axis=1)
    deep, g_q, g_h = solid.depth(q, h)
    with np.errstate(invalid="ignore", divide="ignore"):
        unit = np.where((q > 1e-12)[:, None], radial / q[:, None], 0.0)
    gradient = g_q[:, None] * unit + g_h[:, None] * axis
    return deep, deep + np.einsum("nkj,nj->nk", offset, gradient).max(axis=1)
