"""Does a part stand by itself? What it stands on, seen along the setup axis, has to carry its centre of mass."""

import math
from dataclasses import dataclass

import numpy as np
from scipy.spatial import ConvexHull, QhullError

from cad_io.arrays import Floats

#: Of the footprint: the least share that the hull of what it stands on has, and how far inside that the centre of mass is, as a
#: share of the side of a square as large.
_LEAST, _MARGIN = 0.1, 0.05
#: A part stands at most so many times as high as what it stands on, or what is gripped of it, is wide.
TALL = 3.0
#: A part is round that fills so much of a circle about it.
_ROUND = 0.9


@dataclass(frozen=True, slots=True)
class Bearing:
    """How a part stands along a setup axis."""

    area: float  #: Of the convex hull of what it stands on, seen along the axis, mm2; 0 where it stands on nothing.
    footprint: float  #: Of the convex hull of the part, seen so, mm2.
    width: float  #: Of the first hull where it is narrowest, mm.
    inside: float  #: How far the centre of mass is inside the first hull, mm; negative outside.
    tall: float  #: How high the part is along the axis, mm.
    round: bool = False  #: Whether the part fills a circle about it, seen so.

    @classmethod
    def of(cls, outline: Floats, stood_on: Floats, centre: Floats, tall: float) -> "Bearing":
        """Of corners of the part (n, 2), of what it stands on (m, 2), and its centre of mass (2,), seen along the axis, mm.

        >>> square = np.array([[0.0, 0.0], [8.0, 0.0], [8.0, 8.0], [0.0, 8.0]])
        >>> Bearing.of(square, square, np.array([4.0, 4.0]), 30.0).firm
        False
        """
        whole, below = _hull(outline), _hull(stood_on)
        footprint = 0.0 if whole is None else float(whole.volume)
        middle = 0.5 * (outline.min(axis=0) + outline.max(axis=0))
        circle = math.pi * float(((outline - middle) ** 2).sum(axis=1).max())
        round_ = footprint >= _ROUND * circle
        if below is None:
            return cls(0.0, footprint, 0.0, -math.inf, tall, round_)
        normal, off = below.equations[:, :2], below.equations[:, 2]
        height = stood_on[below.vertices] @ normal.T + off
        narrowest, inside = float(-height.min(axis=0).max()), float(-(normal @ centre + off).max())
        return cls(float(below.volume), footprint, narrowest, inside, tall, round_)

    @property
    def broad(self) -> bool:
        """Whether it stands on enough of its footprint."""
        return self.area >= _LEAST * self.footprint > 0.0

    @property
    def firm(self) -> bool:
        """Whether it stands by itself: broad, not too high, and its centre of mass well over what it stands on."""
        return self.broad and self.inside >= _MARGIN * math.sqrt(self.footprint) and self.tall <= TALL * self.width

    @property
    def slender(self) -> float:
        """Its height as a multiple of the side of a square as large as its footprint."""
        return self.tall / math.sqrt(self.footprint) if self.footprint > 0.0 else math.inf


def enclosed(vertex: Floats, normal: Floats) -> tuple[float, Floats]:
    """Find what triangles (n, 3, 3) with outward normals (n, 3) enclose: volume, mm3, and centre of mass (3,), mm.

    Of a surface that is no closed skin the volume is 0, and the centre that of the surface. `normal`: of any length, for it tells
    the side alone.
    """
    turned = np.cross(vertex[:, 1] - vertex[:, 0], vertex[:, 2] - vertex[:, 0])
    outward = np.where((turned * normal).sum(axis=1) < 0.0, -1.0, 1.0)
    # From a point within its box: volumes of cones are small there, and of one sign for most.
    low, high = vertex.min(axis=(0, 1)), vertex.max(axis=(0, 1))
    middle = 0.5 * (low + high)
    own = vertex - middle
    volume = outward * (own[:, 0] * turned).sum(axis=1) / 6.0
    whole = float(volume.sum())
    if 0.0 < whole <= 1.001 * float(np.prod(high - low)):
        centre = middle + volume @ own.sum(axis=1) / (4.0 * whole)
        if ((centre >= low) & (centre <= high)).all():
            return whole, np.asarray(centre)
    size = np.linalg.norm(turned, axis=1)
    return 0.0, np.asarray(size @ vertex.mean(axis=1) / max(1e-300, float(size.sum())))


def _hull(points: Floats) -> ConvexHull | None:
    """The convex hull of points (n, 2); None where they have no area."""
    if len(points) < 3:
        return None
    try:
        return ConvexHull(points)
    except QhullError:
        return None
