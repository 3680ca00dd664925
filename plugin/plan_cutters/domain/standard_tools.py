"""End mills as they are sold: diameters, flutes, overall lengths, and the stick-outs that are usual.

The lengths are those at which long solid carbide end mills are usually listed, rounded: flutes, shanks, and the overall length of
the longest usual design. They follow no one catalogue, and a tool that somebody has may differ: what stands here is for advice on
what to buy.
"""

from collections.abc import Callable
from dataclasses import replace
from functools import cache
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from cad_io.arrays import Floats
from plan_cutters.domain.cutter import Cutter
from plan_cutters.domain.dimensions import notation
from plan_cutters.domain.holder import Holder, Segment
from plan_cutters.domain.shapes import SAME
from plan_cutters.errors import CutterError

#: Stick-outs over the diameter: as advised, and the most that is usual at all.
USUAL, MOST = 5.0, 10.0
#: Of the shank this many diameters are in the holder, at least.
_CLAMPED = 2.0
#: A relieved neck is thinner than the flutes by this share; it grows to the shank within a cone of this slope.
_RELIEF, _SLOPE = 0.95, 0.25
#: Of the radius, the largest corner of a bull nose.
_ROUNDEST = 0.5


class StandardTool(NamedTuple):
    """An end mill of a catalogue, mm: cutting diameter, length of the flutes, overall length, diameter of the shank."""

    diameter: float
    flutes: float
    overall: float
    shank: float


METRIC = (
    StandardTool(0.5, 1.5, 50.0, 3.0),
    StandardTool(1.0, 3.0, 60.0, 4.0),
    StandardTool(1.5, 4.0, 60.0, 4.0),
    StandardTool(2.0, 6.0, 80.0, 6.0),
    StandardTool(3.0, 8.0, 80.0, 6.0),
    StandardTool(4.0, 11.0, 80.0, 6.0),
    StandardTool(5.0, 13.0, 100.0, 6.0),
    StandardTool(6.0, 13.0, 100.0, 6.0),
    StandardTool(8.0, 19.0, 100.0, 8.0),
    StandardTool(10.0, 22.0, 120.0, 10.0),
    StandardTool(12.0, 26.0, 150.0, 12.0),
    StandardTool(16.0, 32.0, 160.0, 16.0),
    StandardTool(20.0, 38.0, 200.0, 20.0),
    StandardTool(25.0, 45.0, 200.0, 25.0),
)
_IN = 25.4
INCH = tuple(
    StandardTool(diameter * _IN, flutes * _IN, overall * _IN, shank * _IN)
    for diameter, flutes, overall, shank in (
        (1 / 32, 3 / 32, 2.5, 1 / 8),
        (1 / 16, 3 / 16, 2.5, 1 / 8),
        (3 / 32, 9 / 32, 2.5, 1 / 8),
        (1 / 8, 1 / 2, 3.0, 1 / 8),
        (3 / 16, 5 / 8, 3.0, 3 / 16),
        (1 / 4, 3 / 4, 4.0, 1 / 4),
        (5 / 16, 13 / 16, 4.0, 5 / 16),
        (3 / 8, 7 / 8, 4.0, 3 / 8),
        (1 / 2, 1.0, 6.0, 1 / 2),
        (5 / 8, 1.25, 6.0, 5 / 8),
        (3 / 4, 1.5, 6.0, 3 / 4),
        (1.0, 1.5, 7.0, 1.0),
    )
)
#: Usual corner radii of bull noses, mm.
CORNERS = (0.1, 0.2, 0.3, 0.4, 0.5, 0.8, 1.0, 1.2, 1.5, 1.6, 2.0, 2.5, 3.0, 4.0, 5.0, 6.0, 8.0, 10.0, 12.0, 16.0)
INCH_CORNERS = tuple(each * _IN for each in (0.005, 0.01, 1 / 64, 1 / 32, 3 / 64, 1 / 16, 3 / 32, 1 / 8, 3 / 16, 1 / 4))


def slenderness(cutter: Cutter) -> float:
    """Stick-out over the cutting diameter.

    >>> slenderness(Cutter.parse("D12L60"))
    5.0
    """
    return cutter.length / (2.0 * cutter.radius)


def corners(cutter: Cutter) -> tuple[float, ...]:
    """Usual corner radii in the unit in which a cutter was given, mm."""
    return INCH_CORNERS if notation(cutter.name).inches else CORNERS


def is_standard(cutter: Cutter) -> bool:
    """Whether its diameter is one of the tables.

    >>> is_standard(Cutter.parse("D12L60")), is_standard(Cutter.parse("D0.5inL2in")), is_standard(Cutter.parse("D7L60"))
    (True, True, False)
    """
    return any(abs(2.0 * cutter.radius - each.diameter) <= SAME for each in (*METRIC, *INCH))


def smaller(cutter: Cutter, ratio: float) -> tuple[Cutter, ...]:
    """Sold end mills of the same kind that are thinner, the largest first, in the same holder.

    A ball stays a ball, a flat end a flat end, and a bull nose keeps its corner radius or has the next usual one below. None for
    a tapered cutter, and for kinds that are no end mills. Between the flutes and a thicker shank there is a relieved neck, as far
    as the stick-out leaves a length for it; the cone to the shank counts as shank.

    `cutter`: in inches where its name is. `ratio`: stick-out over the diameter, at most; less where the tool is not so long.

    >>> [each.id for each in smaller(Cutter.parse("R3L40rc3"), 10.0)][:2]
    ['R2.5L50rc2.5F13N2.375x35S3', 'R2L40rc2F11N1.9x25S3']
    >>> [each.id for each in smaller(Cutter.parse("R6L60rc3F26S6"), 5.0)][:2]
    ['R5L50rc2.5F22S5', 'R4L40rc2F19S4']
    """
    if cutter.shape != "end" or cutter.taper:
        return ()
    table = INCH if notation(cutter.name).inches else METRIC
    made = (_made(cutter, each, ratio) for each in reversed(table) if each.diameter < 2.0 * cutter.radius - SAME)
    return tuple(each for each in made if each is not None)


def _made(cutter: Cutter, tool: StandardTool, ratio: float) -> Cutter | None:
    """A tool of the table in place of a cutter; None where it has no usual corner, or does not fit the holder."""
    radius, shank = 0.5 * tool.diameter, 0.5 * tool.shank
    corner = 0.0 if not cutter.corner_radius else radius
    if 0.0 < cutter.corner_radius < cutter.radius:
        usual = [each for each in corners(cutter) if each <= min(cutter.corner_radius, _ROUNDEST * radius) + SAME]
        if not usual:
            return None
        corner = usual[-1]
    length = min(ratio * tool.diameter, tool.overall - _CLAMPED * tool.shank)
    flutes = min(tool.flutes, length)
    neck = length - flutes - (shank - radius) / _SLOPE if shank > radius else 0.0
    try:
        return Cutter(
            radius, length, corner, cutter.name, flutes=flutes, neck=Segment(_RELIEF * radius, neck) if neck > SAME else None,
            shank_radius=shank if length - flutes > SAME else None, holder=cutter.holder, allowance=cutter.allowance,
            clearance=cutter.clearance,
        )  # fmt: skip
    except CutterError:
        return None


#: What the kernel's curvature is off by, as a share.
_ROUNDING = 1e-6


class Fit(NamedTuple):
    """A cutter of a usual size reaches this share of an area, 0 to 1."""

    cutter: Cutter
    share: float


#: Which usual sizes in place of a cutter reach some samples (m,), by the areas of all samples (n,); None where that is not known.
Fitting = Callable[[Cutter, NDArray[np.int64], Floats], tuple[Fit, ...] | None]


def largest_fitting(radius: float, allowance: float = 0.0) -> float | None:
    """Largest usual diameter of a cutter that fits into an inside radius and leaves an allowance, mm; None where none does.

    >>> largest_fitting(1.916), largest_fitting(3.0), largest_fitting(0.2)
    (3.0, 6.0, None)
    """
    sizes = (tool.diameter for tool in METRIC)
    return max((size for size in sizes if 0.5 * size + allowance <= radius * (1.0 + _ROUNDING)), default=None)


def least_radius(cutter: Cutter) -> float | None:
    """Least radius of the fillet that a cutter leaves beside an edge, mm, its allowance included; None for shapes without one.

    It is the corner radius, or of a flat end the radius, with which it goes along an edge.

    >>> least_radius(Cutter.parse("R6L80")), least_radius(Cutter.parse("R6L80rc1")), least_radius(Cutter.parse("R6L80rc6"))
    (6.0, 1.0, 6.0)
    """
    if cutter.shape == "lollipop":
        return cutter.radius + (cutter.allowance or 0.0)
    if cutter.shape != "end":
        return None
    return (cutter.corner_radius or cutter.radius) + (cutter.allowance or 0.0)


#: The built-in drawer: metric end mills of usual sizes in plain holders, for a first look. They are nobody's tools.
#: Radius, stick-out, flutes, corner radius of the bull nose (0: none), nose radius of the holder; mm.
_SIZES = (
    (1, 20, 6, 0, 10.5),
    (1.5, 25, 9, 0, 10.5),
    (2, 30, 12, 0.5, 10.5),
    (2.5, 35, 15, 0.5, 10.5),
    (3, 40, 15, 0.5, 10.5),
    (4, 50, 20, 1, 10.5),
    (5, 60, 25, 1, 12),
    (6, 80, 30, 1, 12),
    (8, 90, 40, 2, 13.5),
    (10, 100, 50, 2, 16.5),
    (12, 120, 60, 2, 22),
)


def relieved(cutter: Cutter) -> Cutter | None:
    """The same cutter with a neck ground behind its flutes; None where its shank is not as wide, or too short for one."""
    shank = cutter.radius if cutter.shank_radius is None else cutter.shank_radius
    neck = cutter.length - (cutter.flutes or cutter.length) - _STUB
    if cutter.necks or abs(shank - cutter.radius) > SAME or neck <= SAME:
        return None
    return replace(cutter, neck=Segment(_RELIEF * cutter.radius, neck))


#: Smaller cutters stand on a shank of this radius, which begins so far below the holder, mm.
_SHANK, _STUB = 3.0, 5.0
#: Length of the holders, mm.
_HOLDER = 60.0


@cache
def builtin() -> tuple[Cutter, ...]:
    """Flat ends, bull noses and ball ends from 2 to 24 mm across, each with flutes, neck or shank, and a plain round holder."""
    cutters = []
    for radius, length, flutes, corner, nose in _SIZES:
        for name, rounding in (("flat end", 0.0), ("bull nose", corner), ("ball end", radius)):
            if name == "bull nose" and not rounding:
                continue
            neck, shank = None, float(radius)
            if radius < _SHANK:
                neck, shank = Segment(0.95 * radius, length - flutes - _STUB), _SHANK
            what = f"{name} D{2 * radius:g}" + (f" rc{rounding:g}" if name == "bull nose" else "")
            cutters.append(
                Cutter(radius, length, rounding, f"{what} x {length:g}, built-in", flutes=flutes, neck=neck, shank_radius=shank,
                       holder=Holder((Segment(nose, _HOLDER),), "plain, built-in"))
            )  # fmt: skip
    return tuple(cutters)
