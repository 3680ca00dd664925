"""The same cutter held shorter or longer: what may be asked, how its holder looks from below, and what was found."""

import math
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from cad_io.arrays import Floats, Record
from plan_cutters.domain.assembly import Assembly
from plan_cutters.domain.cutter import Cutter
from plan_cutters.domain.shapes import SAME, flute_length
from plan_cutters.errors import CutterError
from plan_cutters.kernels.codes import ARC, HIGH, HOLDER, KIND, LOW, OVER_TIP, PART, RADIUS, ROUND, SLOPE

#: Into how many cones a round edge of a grown holder is cut; they lie outside of it by 0.5 % of its radius.
_CHORDS = 8
#: Between a stick-out that can be and one that cannot, mm.
_EXACT = 1e-6


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class StickOut(Record):
    """The least stick-out with which a cutter reaches what it reaches; lengths in mm."""

    least: float  #: nan where there is none to find: `why` says so.
    #: `floor`, `longest`: between which it was looked for: the shortest that leaves flutes and neck out of the holder, and what
    #: the cutter was judged with.
    floor: float
    longest: float
    why: str  #: What limits it: `obstacle`, `floor`, or why nothing was looked for: `no holder`, `reaches nothing`.
    #: The stick-out just below, with which the limiting sample was searched again; nan where nothing limits.
    beyond: float = math.nan
    verdict: int = 255  #: What was found there: INACCESSIBLE or UNDECIDED.
    sample: int = -1  #: The one that limits it, -1 for none; at `least`, its posture what is in the way of a shorter one.
    #: `tilt`, `rotation`: rad.
    tilt: float = math.nan
    rotation: float = math.nan
    #: `axis`, `tilt_direction` (3,) float:
    axis: Floats | None = None
    tilt_direction: Floats | None = None
    obstacle_face: int | None = None
    obstacle_point: Floats | None = None  #: (3,) float.
    served: int = 0  #: Samples that were searched with it, and are reached.
    setup: int = 0  #: The setup of the sample that limits it, from 0.


def held(cutter: Cutter, stick_out: float) -> Cutter:
    """The same cutter in its holder with another stick-out, mm: flutes and neck stay, the shank makes up the length.

    Where no length of flutes was given, all that stands out may cut, as before.

    Raises CutterError: it cannot be held so.
    """
    shank = cutter.shank_radius
    if cutter.shape != "lollipop" and stick_out - _fixed(cutter) <= SAME:
        shank = None
    return replace(cutter, length=stick_out, shank_radius=shank)


def _fixed(cutter: Cutter) -> float:
    """Height over the tip up to which nothing can be in a holder, mm: flutes, where their length is known, and neck."""
    if cutter.flutes is None and cutter.shape not in ("lollipop", "form"):
        return cutter.neck_length
    return flute_length(cutter) + cutter.neck_length


def floor_of(cutter: Cutter, tolerance: float) -> float:
    """The shortest stick-out with which a cutter can be held, and judged to a tolerance, mm."""

    def possible(stick_out: float) -> bool:
        try:
            return held(cutter, stick_out).large_enough(tolerance)
        except CutterError:
            return False

    low, high = _fixed(cutter), cutter.length
    if possible(low):
        return low
    while high - low > _EXACT:
        middle = 0.5 * (low + high)
        low, high = (low, middle) if possible(middle) else (middle, high)
    return high


def outline(made: Assembly, stick_out: float) -> Floats:
    """How far above its nose a holder first becomes wider than each distance from the axis, as the kernel takes it.

    `made`: of a cutter with that stick-out, `cover`. Returns (k, 4) float: rows (v0, v1, q0, q1), from the axis out: the height
    over the nose (below it: negative) is v0 up to q0 and rises to v1 at q1. Nowhere above the holder's own.
    """
    rows = made.piece[0][made.piece[0, :, PART] == HOLDER]
    height = made.mode[0, OVER_TIP] - stick_out
    corners = np.vstack([_lower_side(row, height) for row in rows])
    radii = np.unique(corners[:, [0, 2]])
    segments, inner = [], 0.0
    for outer in radii[radii > 0.0].tolist():
        outside = corners[corners[:, 2] >= outer]
        rise = (outside[:, 3] - outside[:, 1]) / np.maximum(outside[:, 2] - outside[:, 0], SAME)
        # The least of several lines lies above the chord of its ends.
        first, last = (float((outside[:, 1] + rise * np.maximum(0.0, q - outside[:, 0])).min()) for q in (inner, outer))
        segments.append((first, max(first, last), inner, outer))
        inner = outer
    return np.array(segments)


def _lower_side(row: NDArray[np.float64], height: float) -> list[tuple[float, float, float, float]]:
    """The side of a piece that looks to the tip, as lines (q0, v0, q1, v1) that rise outwards; nearer to the axis it is level."""
    low, high = float(row[LOW]) + height, float(row[HIGH]) + height
    if row[KIND] == ARC:
        radius, ring_radius, centre = float(row[RADIUS]), float(row[ROUND]), float(row[SLOPE]) + height
        # Tangents at equal angles, from the lowest point out to the widest.
        turn = 0.5 * math.pi / _CHORDS
        out = ring_radius / math.cos(0.5 * turn)
        angles = [0.0, *(turn * (i + 0.5) for i in range(_CHORDS)), 0.5 * math.pi]
        radii = [ring_radius, *[out] * _CHORDS, ring_radius]
        points = [(radius + r * math.sin(a), centre - r * math.cos(a)) for a, r in zip(angles, radii, strict=True)]
        points[0] = (points[0][0], centre - ring_radius)
        points[-1] = (radius + ring_radius, points[-1][1])
        return [(q0, v0, q1, v1) for (q0, v0), (q1, v1) in pairwise(points)]
    radius, slope = float(row[RADIUS]), float(row[SLOPE])
    if slope <= 0.0:
        return [(radius, low, radius, low)]
    return [(radius, low, radius, low), (radius, low, radius + slope * (high - low), high)]
