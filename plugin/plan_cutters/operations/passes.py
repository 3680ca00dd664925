"""Passes take this: the width of a strip, the path of the tool's centre, and the links between passes."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from cad_io.arrays import Floats, SurfaceSamples, cross
from plan_cutters.domain.cutter import Cutter
from plan_cutters.domain.shapes import flute_length
from plan_cutters.operations.extent import Extents
from plan_cutters.operations.strips import centre_path, strips_at

Rows = NDArray[np.int64]
#: Lengths that count as nothing, mm.
NOTHING = 1e-6
#: Curvatures of a plane at most, 1/mm.
PLANE = 1e-9


@dataclass(frozen=True, slots=True)
class Paths:
    """How passes are laid.

    Attributes
    ----------
    scallop : float
        Height of the cusps between passes, mm.
    stepover : float
        Widest distance of passes, in diameters.
    feed : mapping, optional
        Cutter -> mm/min; None: times are not known, and lengths stand for them.
    accuracy : float
        Of the rotary axes, rad: within it of its normal an axis stands upright on a floor.
    extents : Extents
        How far faces go on from samples.
    link : float
        Seconds from the end of a pass to the next one.
    acceleration : float
        Of the slowest linear axis, mm/s2; infinite where it is not known.
    """

    scallop: float
    stepover: float
    feed: Mapping[Cutter, float] | None
    accuracy: float
    extents: Extents
    link: float = 0.0
    acceleration: float = math.inf

    def speeds(self, cutters: Sequence[Cutter]) -> Floats:
        """Feeds of cutters, mm/s; 1 where there is no feed."""
        return np.array([1.0 if self.feed is None else self.feed[cutter] / 60.0 for cutter in cutters])

    def link_of(self, cutter: Cutter) -> float:
        """Seconds that a pass takes beside its length over the feed: the link, and to come to the feed; 0 without a feed."""
        return 0.0 if self.feed is None else self.link + self.feed[cutter] / 60.0 / self.acceleration


class Cut(NamedTuple):
    """Cutting at samples (m,) takes this; nan where the tool does not touch.

    Attributes
    ----------
    strip : (m,) float
        Width that a pass cuts, mm.
    path : (m,) float
        Length of the centre's path for each mm2, 1/mm.
    links : (m,) float
        Passes for each mm2, 1/mm2: each has a link.
    floor : (m,) bool
        Whether the flat part of the tip lies on a floor.
    """

    strip: Floats
    path: Floats
    links: Floats
    floor: NDArray[np.bool_]

    def pace(self, paths: Paths, cutter: Cutter) -> Floats:
        """Give what a mm of path cuts, mm2/mm, with links counted as the path that is run meanwhile."""
        link = paths.link_of(cutter)
        with np.errstate(divide="ignore", invalid="ignore"):
            return np.asarray(1.0 / (self.path + (0.0 if link == 0.0 else link * paths.speeds([cutter])[0]) * self.links))


def cut_by_tip(cutter: Cutter, samples: SurfaceSamples, rows: Rows, axis: Floats, paths: Paths, *, turning: bool = False) -> Cut:
    """Find what passes by the tip take at samples (m,) with axes (m, 3), fixed or turning with the surface.

    A face is cut in as many passes as there must be, at least one: they are as wide as their share of it. On a floor passes
    are the step-over apart, as a share of the flat part: what its corner cuts beside that is not counted.
    """
    normal, direction, curvature = samples.normal[rows], samples.direction_max[rows], samples.curvature[rows]
    widest = strips_at(cutter, normal, direction, curvature, axis, paths.scallop, paths.stepover)
    floor = on_floor(cutter, normal, curvature, axis, paths.accuracy, paths.scallop)
    feed, either = widest.feed.copy(), floor | widest.any_feed
    feed[either] = paths.extents.longest(rows[either])
    flat = flat_of(cutter)

    def fed(feed: Floats, apart: Floats) -> Cut:
        breadth, length = (paths.extents.along(rows, way)[0] for way in (cross(normal, feed), feed))
        with np.errstate(invalid="ignore", divide="ignore"):
            # On a floor the outer passes cut all of the flat.
            count = np.ceil((breadth - np.where(floor, flat, apart)) / apart - NOTHING) + 1.0
            share = breadth / np.maximum(1.0, count)
            strip = np.where(np.isfinite(share) & (apart > 0.0), share, apart)
            run = np.where(floor, 1.0, centre_path(cutter, normal, direction, curvature, axis, feed, turning=turning))
            links = np.where(np.isfinite(length), 1.0 / (strip * length), 0.0)
            return Cut(strip, run / strip, np.where(np.isnan(strip), np.nan, links), floor)

    wide, narrow = (
        fed(feed, np.where(floor, paths.stepover * flat, widest.width)),
        fed(cross(normal, feed), np.where(either | ~(widest.narrow > 0.0), np.nan, widest.narrow)),
    )
    # The centre may run less far in narrower strips: along a round edge and not across it.
    better = narrow.pace(paths, cutter) > wide.pace(paths, cutter)
    return Cut(*(np.where(better, mine, others) for mine, others in zip(narrow, wide, strict=True)))


def flank_of(cutter: Cutter) -> tuple[float, float] | None:
    """Height over the tip at which the straight side of the flutes begins, and its length, mm; None where there is none.

    >>> flank_of(Cutter.parse("D12L60rc1F26"))
    (1.0, 25.0)
    >>> flank_of(Cutter.lollipop(radius=4, neck_radius=2, length=40)) is None
    True
    """
    if cutter.shape != "end":
        return None
    begins = cutter.corner_radius * (1.0 - math.sin(cutter.taper))
    length = (flute_length(cutter) - begins) / math.cos(cutter.taper)
    return (begins, length) if length > NOTHING else None


def flat_of(cutter: Cutter) -> float:
    """Diameter of the flat part of the tip, mm; 0 where there is none.

    >>> flat_of(Cutter.parse("D12L60rc1")), flat_of(Cutter.parse("D12L60rc6"))
    (10.0, 0.0)
    """
    return 2.0 * max(0.0, cutter.radius - cutter.corner_radius) if cutter.shape == "end" else 0.0


def on_floor(
    cutter: Cutter, normal: Floats, curvature: Floats, axis: Floats, accuracy: float, scallop: float
) -> NDArray[np.bool_]:
    """At which points (n,) the flat part of the tip lies on the face.

    That is where the face is plane and the axis (n, 3) within the accuracy, rad, of its normal (n, 3), and across the flat part
    the face leaves the tip by no more than the scallop height, mm.
    """
    flat = flat_of(cutter)
    if flat <= 0.0:
        return np.zeros(len(normal), bool)
    sine = np.linalg.norm(np.cross(normal, axis), axis=1)
    plane = (np.abs(curvature) <= PLANE).all(axis=1)
    near = (sine <= math.sin(accuracy) + 1e-12) & ((normal * axis).sum(axis=1) > 0.0)
    return np.asarray(plane & near & (flat * sine <= scallop))
