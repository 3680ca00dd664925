"""Tools given as outlines in the meridian plane, with exact distances: a slow twin that shares no code with the product.

A chain runs from the axis at the tip to the axis at the top; its elements are lines (q0, w0, q1, w1) and arcs (centre q and w,
radius, first and last angle from the q axis). Heights never fall along it, so a point is inside where it is nearer to the axis
than the chain at its height.
"""

import math
from itertools import pairwise

import numpy as np

from plan_cutters import Cutter


def flutes_of(c):
    """The chain of what cuts, without its top, and the height at which it ends."""
    r, rc = c.radius, c.corner_radius
    top = c.flutes if c.flutes is not None else c.length - sum(neck.length for neck in c.necks)
    if c.shape == "lollipop":
        last = math.acos(c.shank_radius / r)
        return [("arc", 0.0, r, r, -math.pi / 2, last)], r + r * math.sin(last)
    if c.shape == "barrel":
        big = c.arc_radius
        last = math.asin((top - c.arc_height) / big)
        if not rc:
            first = math.asin(-c.arc_height / big)
            return [("line", 0.0, 0.0, r - big + big * math.cos(first), 0.0),
                    ("arc", r - big, c.arc_height, big, first, last)], top  # fmt: skip
        joint = math.atan2(rc - c.arc_height, big - r)
        return [("arc", 0.0, rc, rc, -math.pi / 2, joint), ("arc", r - big, c.arc_height, big, joint, last)], top
    if c.shape == "lens":
        big = c.arc_radius
        rise = math.sqrt((big - rc) ** 2 - (r - rc) ** 2)
        joint = math.atan2(-rise, r - rc)
        return [("arc", 0.0, big, big, -math.pi / 2, joint), ("arc", r - rc, big - rise, rc, joint, 0.0),
                ("line", r, big - rise, r, top)], top  # fmt: skip
    if c.shape == "form":
        points = list(c.outline)
        return [("line", *a, *b) for a, b in pairwise(points)], points[-1][1]
    b = c.taper
    foot = r - rc + rc * math.cos(b), rc - rc * math.sin(b)
    end = foot[0] + (top - foot[1]) * math.tan(b)
    found = [("line", 0.0, 0.0, r - rc, 0.0)] if r > rc else []
    if rc:
        found.append(("arc", r - rc, rc, rc, -math.pi / 2, -b))
    return [*found, ("line", *foot, end, top)], top


def end_of(element):
    if element[0] == "line":
        return element[3], element[4]
    _, q, w, r, _, last = element
    return q + r * math.cos(last), w + r * math.sin(last)


def stages_of(c, top, radius):
    """Bands (low, high, lower and upper radius) above the flutes, which end at a height with a radius."""
    found = []
    for neck in c.necks:
        found.append((top, top + neck.length, neck.radius, neck.upper_radius))
        top, radius = top + neck.length, neck.upper_radius
    if c.length - top > 1e-9:
        wide = radius if c.shank_radius is None else c.shank_radius
        found.append((top, c.length, wide, wide))
    top = c.length
    for stage in c.holder.stages if c.holder else ():
        found.append((top, top + stage.length, stage.radius, stage.upper_radius))
        top += stage.length
    return found


class Outline:
    """A closed chain."""

    def __init__(self, elements, low, high):
        q, w = end_of(elements[-1])
        self.elements = [*elements, ("line", q, w, 0.0, high)]
        self.low, self.high = low, high

    def distance(self, q, w):
        """To the chain, mm."""
        best = np.full(np.shape(q), np.inf)
        for kind, *e in self.elements:
            if kind == "line":
                a, b, c, d = e
                square = (c - a) ** 2 + (d - b) ** 2
                share = np.clip(((q - a) * (c - a) + (w - b) * (d - b)) / square, 0, 1) if square else 0.0
                away = np.hypot(q - a - share * (c - a), w - b - share * (d - b))
            else:
                x, y, r, first, last = e
                # Angles from the middle of the arc: none of these lies behind the cut of atan2.
                middle, half = 0.5 * (first + last), 0.5 * (last - first)
                along, aside = math.cos(middle), math.sin(middle)
                u, v = (q - x) * along + (w - y) * aside, (w - y) * along - (q - x) * aside
                on = np.abs(np.arctan2(v, u)) <= half
                ends = [np.hypot(q - x - r * math.cos(t), w - y - r * math.sin(t)) for t in (first, last)]
                away = np.where(on, np.abs(np.hypot(u, v) - r), np.minimum(*ends))
            best = np.minimum(best, away)
        return best

    def radius(self, w):
        """The largest at each height; -inf beyond the ends."""
        best = np.full(np.shape(w), -np.inf)
        for kind, *e in self.elements:
            if kind == "line":
                a, b, c, d = e
                on = (w >= min(b, d)) & (w <= max(b, d))
                q = np.full(np.shape(w), max(a, c)) if d == b else a + (w - b) / (d - b) * (c - a)
            else:
                x, y, r, first, last = e
                on = (w >= y + r * math.sin(first)) & (w <= y + r * math.sin(last))
                q = x + np.sqrt(np.maximum(0.0, r * r - (w - y) ** 2))
            best = np.where(on, np.maximum(best, q), best)
        return best

    def depth(self, q, w):
        """How deep points lie in it, mm; minus the distance outside."""
        away = self.distance(q, w)
        return np.where(q < self.radius(w), away, -away)

    def support(self, tilt, towards=None):
        """The point that is lowest when the axis leans by a tilt: (q, w); of a side, the end that is so a little `towards`."""

        def rise(point, at):
            return point[1] * math.cos(at) - point[0] * math.sin(at)

        found = []
        for kind, *e in self.elements:
            if kind == "line":
                found += [(e[0], e[1]), (e[2], e[3])]
            else:
                a, b, r, first, last = e
                at = math.atan2(-math.cos(tilt), math.sin(tilt))
                found += [(a + r * math.cos(t), b + r * math.sin(t)) for t in (first, last)]
                if first <= at <= last:
                    found.append((a + r * math.cos(at), b + r * math.sin(at)))
        least = min(rise(p, tilt) for p in found)
        beside = tilt if towards is None else tilt + math.copysign(1e-4, towards - tilt)
        return min((p for p in found if rise(p, tilt) <= least + 1e-10), key=lambda p: rise(p, beside))


class Reference:
    """A cutter's outlines: `whole`, `flutes`, and `above`, None if nothing stands above the flutes."""

    def __init__(self, cutter: Cutter):
        self.allowance = cutter.allowance or 0.0
        chain, top = flutes_of(cutter)
        self.ball = cutter.radius if cutter.shape == "lollipop" else 0.0
        self.top, self.top_radius = top, end_of(chain[-1])[0]
        self.flutes = Outline(chain, 0.0, top)
        bands = stages_of(cutter, top, self.top_radius)
        upper, q = [], 0.0
        for low, high, first, last in bands:
            upper += [("line", q, low, first, low), ("line", first, low, last, high)]
            q = last
        self.end = bands[-1][1] if bands else top
        self.above = Outline(upper, top, self.end) if bands else None
        joined = list(upper)
        if joined:
            joined[0] = ("line", self.top_radius, top, bands[0][2], top)
        self.whole = Outline([*chain, *joined], 0.0, self.end)
        self.wide = max([cutter.radius, self.top_radius] + [max(b[2:]) for b in bands])

    def over(self, q, w, inset, rest):
        """By how much points count: deeper than `inset` in the flutes or nearer than minus that to them, and of what stands
        above by `rest`, mm.
        """
        found = (self.whole if inset >= 0 else self.flutes).depth(q, w) - inset
        if self.above is not None:
            if rest > inset >= 0:
                # The ball of a lollipop goes on within its neck.
                mine = np.hypot(q, w - self.ball) < self.ball if self.ball else w <= self.top
                found = np.where(mine, found, -np.inf)
            found = np.maximum(found, (self.whole if rest >= 0 else self.above).depth(q, w) - rest)
        return found

    def frame(self, contact, normal, tilt_direction, tilt, towards=None):
        """Tip, and rows x_T, y_T, axis of the tool that touches the contact at a tilt with its flutes, an allowance away."""
        axis = math.cos(tilt) * normal + math.sin(tilt) * tilt_direction
        x_t = math.cos(tilt) * tilt_direction - math.sin(tilt) * normal
        q, w = self.flutes.support(tilt, towards)
        contact = contact + self.allowance * normal
        return contact - q * x_t - w * axis, np.stack([x_t, np.cross(normal, tilt_direction), axis])


def in_row(row, q, w):
    """How deep points are in a row of pieces, measured by its own two bounds; negative outside."""
    kind, low, high, radius, slope, around = row[:6]
    side = around - np.hypot(np.maximum(0.0, q - radius), w - slope) if kind == 2 else radius + slope * (w - low) - q
    return np.minimum(side, np.minimum(w - low, high - w))


#: What stands above the flutes, if anything: on its own, thicker and thinner, cylinders and cones.
HOLDERS = (
    None,
    None,
    "R14L20",
    "R9:14L12+R20L10",
    "R10:8L6+R16L9+R12L8",
    "R12:25L10",
    "R9L5+R9:16L6+R16L9",
    "R15:9L6+R9L4+R9:14L3",
)


def random_cutter(rng, kind, *, bare=False, loose=True):
    """A cutter of a kind with dimensions at random; `bare` without stages, `loose` with allowance and clearance now and then."""
    r = float(rng.uniform(1.5, 6.5))
    more, bare = {}, bare or rng.random() < 0.15
    if not bare:
        holder = HOLDERS[rng.integers(len(HOLDERS))]
        more["holder"] = holder
        if kind != "lollipop" and rng.random() < 0.5:
            more["shank_radius"] = float(rng.uniform(0.5, 1.3) * r)
    if loose and rng.random() < 0.4:
        more["allowance"] = float(rng.choice([0.0, 0.02, 0.3]))
        more["clearance"] = float(rng.choice([0.0, 0.5, 1.5]))
    flutes = float(rng.uniform(1.2, 4) * r)
    length = flutes + float(rng.uniform(4, 20)) if not bare else flutes
    if not bare and kind not in ("lollipop", "form") and rng.random() < 0.4:
        from plan_cutters.domain.holder import Segment

        thin = float(rng.uniform(0.4, 1.1) * r)
        upper = thin if rng.random() < 0.5 else float(rng.uniform(0.4, 1.1) * r)
        reach = float(rng.uniform(1, 4))
        more["neck"] = Segment(thin, reach, upper)
        if rng.random() < 0.3:
            more["neck"] = Segment(thin, 0.4 * reach, upper), Segment(float(rng.uniform(0.4, 1.1) * r), 0.6 * reach)
    cut = {} if bare else {"flutes": flutes}
    b = float(np.radians(rng.uniform(2, 15)))
    neck = float(rng.uniform(0.2, 0.8)) * r
    flared = [(0, 0), (0.5 * r, 0), (r, 0.4 * r), (r, r), (0.8 * r, 1.5 * r)]
    made = {
        "flat": lambda: Cutter.flat(radius=r, length=length, **cut, **more),
        "bull": lambda: Cutter.bull(radius=r, corner_radius=float(rng.uniform(0.05, 0.95)) * r, length=length, **cut, **more),
        "ball": lambda: Cutter.ball(radius=r, length=length, **cut, **more),
        "taper ball": lambda: Cutter.ball(radius=r, length=length, taper=b, **cut, **more),
        "taper bull": lambda: Cutter.bull(radius=r, corner_radius=0.4 * r, length=length, taper=b, **cut, **more),
        "taper flat": lambda: Cutter.flat(radius=r, length=length, taper=b, **cut, **more),
        "dovetail": lambda: Cutter.flat(radius=r, length=length, taper=-b / 2, **cut, **more),
        "dovetail bull": lambda: Cutter.bull(radius=r, corner_radius=0.2 * r, length=length, taper=-b / 2, **cut, **more),
        "lollipop": lambda: Cutter.lollipop(radius=r, neck_radius=neck, length=2 * r + length, **more),
        "barrel": lambda: Cutter.barrel(radius=r, flank_radius=10 * r, length=length, height=0.6 * flutes, **cut, **more),
        "oval": lambda: Cutter.barrel(radius=r, flank_radius=9 * r, tip_radius=0.4 * r, length=length + 6 * r,
                                      flutes=4.5 * r, **more),
        "lens": lambda: Cutter.lens(radius=r, bottom_radius=4 * r, corner_radius=0.2 * r, length=length, **cut, **more),
        "form": lambda: Cutter.form(flared, length=2 * r + length, **more),
        "form re-entrant": lambda: Cutter.form(
            [(0, 0), (0.6 * r, 0), (0.6 * r, 0.5 * r), (r, 0.9 * r), (r, 1.2 * r), (0.5 * r, 1.2 * r), (0.7 * r, 2 * r)],
            length=2.5 * r + length, **more),
    }  # fmt: skip
    from plan_cutters import CutterError

    while True:
        try:
            return made[kind]()
        except CutterError:
            # A holder's nose must be as wide as what it holds.
            more.pop("holder", None)
            more.pop("shank_radius", None)


KINDS = (
    "flat", "bull", "ball", "taper ball", "taper bull", "taper flat", "dovetail", "dovetail bull", "lollipop", "barrel", "oval",
    "lens", "form", "form re-entrant",
)  # fmt: skip
