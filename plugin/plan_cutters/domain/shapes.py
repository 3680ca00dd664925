"""Derive the shape from a cutter's dimensions: flutes, the segments above, the contacts; and check that it can exist."""

import math
from collections.abc import Iterable
from itertools import pairwise
from typing import Literal, NamedTuple

from plan_cutters.domain.dimensions import Dimensions, notation
from plan_cutters.domain.holder import Segment
from plan_cutters.errors import CutterError, HolderFitError

#: Parts of an assembly that do not cut, from the flutes up.
Part = Literal["neck", "shank", "holder"]
#: Radii and heights this close to each other, mm, are the same.
SAME = 1e-9
#: Pieces that an assembly may have: the search keeps a mask of those still in reach, a bit for each.
MOST_PIECES = 62
_RIGHT = math.pi / 2
#: A flank steeper than this is none, rad.
_STEEPEST = math.radians(80)


class Mode(NamedTuple):
    """A part of the cutting edge that touches the surface with one centre of curvature."""

    offset: float  #: How far that centre lies from the axis towards the contact, mm.
    height: float  #: How far it lies over the tip, mm.
    radius: float  #: Of curvature there, mm; 0 for a sharp edge.
    #: `low`, `high`: tilts at which it touches, rad.
    low: float
    high: float


class Flank(NamedTuple):
    """A straight side of the cutting edge: it touches at one tilt, anywhere along its length."""

    mode: int  #: In which its lower end touches, as `modes` counts them.
    tilt: float  #: rad.
    length: float  #: mm; 0 where nothing above is narrower, so that no other place along it serves where its lower end does not.


def flute_length(cutter: Dimensions) -> float:
    """Height over the tip up to which a cutter cuts, mm."""
    if cutter.shape == "lollipop":
        # Where its ball meets its neck.
        return cutter.radius + math.sqrt(max(0.0, cutter.radius**2 - (cutter.shank_radius or 0.0) ** 2))
    if cutter.shape == "form":
        return cutter.outline[-1][1]
    if cutter.flutes is not None:
        return cutter.flutes
    return cutter.length - cutter.neck_length


def top_radius(cutter: Dimensions) -> float:
    """Radius of the flutes where they end, mm."""
    top = flute_length(cutter)
    if cutter.shape == "lollipop":
        return cutter.shank_radius or 0.0
    if cutter.shape == "form":
        return cutter.outline[-1][0]
    if cutter.shape == "barrel":
        return flank(cutter, top)
    # How much farther from the axis a tapered flank is at the height of the corner's centre than a straight one.
    offset = cutter.corner_radius * (1.0 / math.cos(cutter.taper) - 1.0)
    return cutter.radius + offset + (top - cutter.corner_radius) * math.tan(cutter.taper)


def rim_radius(cutter: Dimensions) -> float:
    """Radius of the flutes where they end, mm, but for a form whose upper face leads back to its neck: that of the face's rim."""
    if cutter.shape == "form":
        top = cutter.outline[-1][1]
        return max(r for r, h in cutter.outline if h == top)
    return top_radius(cutter)


def rim_length(cutter: Dimensions) -> float:
    """How far down from their end the flutes are at least as wide as there, mm; 0 where that is not seen at once."""
    top, rim = flute_length(cutter), rim_radius(cutter)
    if cutter.shape == "form":
        length = 0.0
        for r, h in reversed(cutter.outline):
            if h < top and r < rim:
                break
            length = top - h
        return length
    if cutter.shape == "end" and cutter.taper <= 0.0:
        return top - cutter.corner_radius
    return top - lens_height(cutter) if cutter.shape == "lens" else 0.0


def top_flank_angle(cutter: Dimensions) -> float:
    """How far the side of the flutes leans from the axis where they end, rad; positive where they widen."""
    if cutter.shape == "barrel":
        return math.asin((cutter.arc_height - flute_length(cutter)) / cutter.arc_radius)
    if cutter.shape == "form":
        sides = reversed([(a, b) for a, b in pairwise(cutter.outline) if b[1] > a[1]])
        (r, w), (s, v) = next(sides)
        return math.atan2(s - r, v - w)
    return cutter.taper


def flank(cutter: Dimensions, height: float) -> float:
    """Radius of a barrel's flank at a height over the tip, mm."""
    away = cutter.arc_radius**2 - (height - cutter.arc_height) ** 2
    return cutter.radius - cutter.arc_radius + math.sqrt(max(0.0, away))


def tip_angle(cutter: Dimensions) -> float:
    """Angle of the normal, from the axis, where a barrel's or a lens's two arcs meet."""
    if cutter.shape == "barrel":
        return math.asin(min(1.0, (cutter.arc_radius - cutter.radius) / (cutter.arc_radius - cutter.corner_radius)))
    return math.asin(min(1.0, (cutter.radius - cutter.corner_radius) / (cutter.arc_radius - cutter.corner_radius)))


def lens_height(cutter: Dimensions) -> float:
    """Height over the tip of the centre of a lens's corner."""
    inner, outer = cutter.radius - cutter.corner_radius, cutter.arc_radius - cutter.corner_radius
    return cutter.arc_radius - math.sqrt(max(0.0, outer**2 - inner**2))


def stages(cutter: Dimensions) -> tuple[tuple[Part, float, Segment], ...]:
    """List the segments above the flutes, upwards: the part, the height over the tip at which it begins, mm, and the segment."""
    parts: list[tuple[Part, float, Segment]] = []
    top = flute_length(cutter)
    for stage in cutter.necks:
        parts.append(("neck", top, stage))
        top += stage.length
    if cutter.length - top > SAME:
        radius = cutter.shank_radius
        if radius is None:
            radius = cutter.necks[-1].upper_radius if cutter.necks else top_radius(cutter)
        part: Part = "neck" if cutter.shape == "lollipop" else "shank"
        parts.append((part, top, Segment(radius, cutter.length - top)))
    top = cutter.length
    for stage in cutter.holder.stages if cutter.holder else ():
        parts.append(("holder", top, stage))
        top += stage.length
    return tuple(parts)


def pieces_at_most(cutter: Dimensions) -> int:
    """Pieces that a cutter can come to: of a section its side with two round edges, or with what joins it to the next one."""
    sides = max(0, len(cutter.outline) - 1) * (3 if cutter.allowance else 1)
    return sum(4 if stage.slope else 3 for _, _, stage in stages(cutter)) + max(4, sides) + 2


def modes(cutter: Dimensions) -> tuple[Mode, ...]:
    """Where a cutter touches, by ranges of tilt that join or leave gaps; beyond them it touches nowhere."""
    r, corner = cutter.radius, cutter.corner_radius
    if cutter.shape == "lollipop":
        return (Mode(0.0, r, r, 0.0, math.pi - math.asin((cutter.shank_radius or 0.0) / r)),)
    if cutter.shape == "lens":
        joint = tip_angle(cutter)
        arc = Mode(0.0, cutter.arc_radius, cutter.arc_radius, 0.0, joint)
        return arc, Mode(r - corner, lens_height(cutter), corner, joint, _RIGHT)
    if cutter.shape == "barrel":
        wide, centre, top = cutter.arc_radius, cutter.arc_height, flute_length(cutter)
        last = math.acos(max(-1.0, min(1.0, (centre - top) / wide)))
        first = tip_angle(cutter) if corner else math.acos(max(-1.0, min(1.0, centre / wide)))
        arc = Mode(r - wide, centre, wide, first, last)
        return (Mode(0.0, corner, corner, 0.0, first), arc) if corner else (arc,)
    if cutter.shape == "form":
        return _corners(cutter.outline)
    return (Mode(r - corner, corner, corner, 0.0, _RIGHT - cutter.taper),)


def largest_tilt(cutters: Iterable[Dimensions]) -> float:
    """How far tilts are searched unless it is said, rad: to a right angle, or as far as any of some cutters touches."""
    return max([_RIGHT, *(mode.high for cutter in cutters for mode in modes(cutter))])


def flanks(cutter: Dimensions) -> tuple[Flank, ...]:
    """The straight sides with which a cutter can touch.

    >>> from plan_cutters.domain.cutter import Cutter
    >>> [round(each.length, 3) for each in flanks(Cutter.parse("D12L60F26N8x30S12"))], flanks(Cutter.parse("D12L60rc6"))[0].length
    ([26.0], 0.0)
    """
    each = modes(cutter)
    if cutter.shape == "form":
        corners = [(mode.offset, mode.height) for mode in each]
        edges = set(pairwise(cutter.outline))
        return tuple(
            Flank(i, mode.high, math.dist(a, b))
            for i, (mode, a, b) in enumerate(zip(each, corners, [*corners[1:], (math.nan, math.nan)], strict=True))
            if (a, b) in edges and mode.high < math.pi
        )
    if cutter.shape not in ("end", "lens"):
        return ()
    begins = lens_height(cutter) if cutter.shape == "lens" else cutter.corner_radius * (1.0 - math.sin(cutter.taper))
    length = (flute_length(cutter) - begins) / math.cos(cutter.taper)
    narrower = any(min(stage.radius, stage.upper_radius) < top_radius(cutter) - SAME for _, _, stage in stages(cutter))
    return (Flank(len(each) - 1, each[-1].high, length if narrower else 0.0),) if length > SAME else ()


def depth_along_normal(cutter: Dimensions) -> float:
    """How far a cutter holds the line along the normal of its contact, mm, whatever the tilt from 0 to 90 deg; 0 if that is not
    known.

    A corner is a ring of balls about the contact's own one; of a flat end the line leads into it, past its bottom and its wall
    (lemma F3 of `docs/proofs.md`).
    """
    if cutter.shape != "end" or cutter.taper or cutter.allowance:
        return 0.0
    thick = cutter.corner_radius or cutter.radius
    return thick if flute_length(cutter) >= 2.0 * thick else 0.0


def _corners(outline: tuple[tuple[float, float], ...]) -> tuple[Mode, ...]:
    """The corners at which an outline can touch a plane: those of its convex hull."""
    hull: list[tuple[float, float]] = []
    for r, h in outline:
        while len(hull) > 1 and _turn(hull[-2], hull[-1], (r, h)) <= 0.0:
            hull.pop()
        hull.append((r, h))
    corners = []
    for i, (r, h) in enumerate(hull):
        low = 0.0
        if i > 0:
            low = math.atan2(h - hull[i - 1][1], r - hull[i - 1][0])
        last = i + 1 == len(hull)
        high = max(low, _RIGHT) if last else math.atan2(hull[i + 1][1] - h, hull[i + 1][0] - r)
        if high >= 0.0 and high > low:
            corners.append(Mode(r, h, 0.0, max(0.0, low), high))
    return tuple(corners)


def _turn(a: tuple[float, float], b: tuple[float, float], c: tuple[float, float]) -> float:
    """Positive where a path over three points (radius, height) turns to the left."""
    return (b[0] - a[0]) * (c[1] - b[1]) - (b[1] - a[1]) * (c[0] - b[0])


def check(cutter: Dimensions, name: str) -> None:
    """Raise CutterError if there can be no such cutter."""
    name = f"cutter {name}"
    _check_shape(cutter, name)
    top = flute_length(cutter)
    if cutter.flutes is not None and cutter.shape in ("lollipop", "form"):
        raise CutterError(f"{name}: the flutes of a {cutter.shape} end where its outline does; leave their length out")
    if top > cutter.length + SAME:
        raise CutterError(f"{name}: it is {cutter.length:g} mm long, shorter than its flutes of {top:g} mm")
    if top <= 0.0:
        raise CutterError(f"{name}: the neck of {cutter.neck_length:g} mm leaves no flutes")
    if cutter.necks and top + cutter.neck_length > cutter.length + SAME:
        raise CutterError(
            f"{name}: flutes and neck take {top + cutter.neck_length:g} mm, more than the length of {cutter.length:g} mm"
        )
    # Of a lollipop it is the neck under the ball, whatever stands above.
    shank = cutter.shank_radius is not None and not (cutter.shape == "lollipop" and cutter.necks)
    if shank and cutter.length - top - cutter.neck_length <= SAME:
        raise CutterError(f"{name}: its flutes and neck reach up to its length, which leaves no length for a shank")
    if pieces_at_most(cutter) > MOST_PIECES:
        raise CutterError(
            f"{name}: it has {len(stages(cutter))} sections above its flutes and {len(cutter.outline)} points of an outline, "
            f"too many to judge: give fewer that enclose it"
        )
    above = stages(cutter)
    last = next((stage.upper_radius for part, _, stage in reversed(above) if part != "holder"), top_radius(cutter))
    if cutter.holder is not None and cutter.holder.stages[0].radius < last - SAME:
        raise HolderFitError(
            f"{name}: the holder's nose of radius {cutter.holder.stages[0].radius:g} is narrower than what it holds, "
            f"of radius {last:g}"
        )
    if cutter.holder is not None and cutter.holder.bore is not None and 2.0 * last > cutter.holder.bore + SAME:
        raise HolderFitError(
            f"{name}: its shank of {2.0 * last:g} mm does not fit {cutter.holder.name or 'its holder'}, which takes up to "
            f"{cutter.holder.bore:g} mm: another holder, or say its flutes and shank "
            f"(F30S{notation(cutter.name).across(0.5 * cutter.holder.bore)})"
        )


def _check_shape(cutter: Dimensions, name: str) -> None:
    r, corner = cutter.radius, cutter.corner_radius
    if not 0 <= corner <= r:
        raise CutterError(f"corner radius {corner:g} must lie between 0 and the radius {r:g}")
    if cutter.taper and cutter.shape != "end":
        raise CutterError(f"{name}: only end mills are tapered")
    if abs(cutter.taper) > _STEEPEST:
        raise CutterError(f"{name}: a taper of {math.degrees(cutter.taper):.4g} deg lies beyond 80 deg (the half angle)")
    if cutter.shape not in ("barrel", "lens") and (cutter.arc_radius or cutter.arc_height):
        raise CutterError(f"{name}: only barrels and lenses have an arc of their own")
    if cutter.shape != "form" and cutter.outline:
        raise CutterError(f"{name}: an outline belongs to the shape form")
    _CHECKS[cutter.shape](cutter, name)


def _check_end(cutter: Dimensions, name: str) -> None:
    top, corner = flute_length(cutter), cutter.corner_radius
    if top <= corner * (1.0 - math.sin(cutter.taper)) - SAME:
        raise CutterError(f"{name}: its flutes of {top:g} mm end within its corner of radius {corner:g}")
    if not top_radius(cutter) > 0.0:
        raise CutterError(f"{name}: its flanks meet below the end of its flutes")


def _check_lollipop(cutter: Dimensions, name: str) -> None:
    if not 0.0 < (cutter.shank_radius or 0.0) < cutter.radius:
        raise CutterError(
            f"{name}: a lollipop's neck must be thinner than its ball of radius {cutter.radius:g}, and there must be one"
        )


def _check_barrel(cutter: Dimensions, name: str) -> None:
    r, corner, top = cutter.radius, cutter.corner_radius, flute_length(cutter)
    if not cutter.arc_radius >= r or not cutter.arc_height >= 0.0 or not math.isfinite(cutter.arc_radius):
        raise CutterError(f"{name}: a barrel's flank needs a radius of at least its own {r:g}, and a height over its tip")
    if corner and not corner < r:
        raise CutterError(f"{name}: the tip of a barrel must be smaller than its radius {r:g}")
    if corner:
        inner, outer = cutter.arc_radius - r, cutter.arc_radius - corner
        if abs(math.hypot(inner, cutter.arc_height - corner) - outer) > 1e-6 * cutter.arc_radius:
            raise CutterError(f"{name}: its flank is not tangent to the ball at its tip; Cutter.barrel finds the height")
    low = 0.0 if not corner else corner * (1.0 - math.cos(tip_angle(cutter)))
    if not low < top or not flank(cutter, top) > 0.0 or not flank(cutter, low) > 0.0:
        raise CutterError(f"{name}: its flank must begin below the end of the flutes and be wider than its axis all along")
    if abs(top - cutter.arc_height) >= cutter.arc_radius or cutter.arc_height - low >= cutter.arc_radius:
        raise CutterError(f"{name}: its flank of radius {cutter.arc_radius:g} does not reach so far along its axis")


def _check_lens(cutter: Dimensions, name: str) -> None:
    top = flute_length(cutter)
    if not (math.isfinite(cutter.arc_radius) and cutter.arc_radius >= cutter.radius > cutter.corner_radius):
        raise CutterError(f"{name}: a lens needs a bottom of at least its radius {cutter.radius:g}, and a smaller corner")
    if not top >= lens_height(cutter) - SAME:
        raise CutterError(f"{name}: its flutes of {top:g} mm end within its bottom")


def _check_outline(cutter: Dimensions, name: str) -> None:
    points = cutter.outline
    if len(points) < 2 or points[0] != (0.0, 0.0):
        raise CutterError(f"{name}: an outline begins on the axis at the tip, 0 0, and has at least one more point")
    if any(b[1] < a[1] for a, b in pairwise(points)):
        raise CutterError(f"{name}: the heights of an outline must not fall: it would overlap itself or be hollow")
    for (a, h), (b, low), (c, high) in zip(points, points[1:], points[2:], strict=False):
        if h == low == high and (b - a) * (c - b) < 0.0:
            raise CutterError(f"{name}: its outline goes back over itself at the height {h:g} mm: a disk without thickness")
    if points[-1][1] == points[-2][1] and points[-1][0] > points[-2][0]:
        raise CutterError(f"{name}: its outline ends in a face outwards, a disk without thickness: leave out its last point")
    if any(r <= 0.0 for r, _ in points[1:]) or not points[-1][1] > 0.0:
        raise CutterError(f"{name}: an outline's radii must be positive above its tip, and it must have a height")
    if abs(max(r for r, _ in points) - cutter.radius) > SAME:
        raise CutterError(f"{name}: the radius must be the largest of its outline")
    if cutter.corner_radius:
        raise CutterError(f"{name}: the corners of an outline are its points")


_CHECKS = {"end": _check_end, "lollipop": _check_lollipop, "barrel": _check_barrel, "lens": _check_lens, "form": _check_outline}
