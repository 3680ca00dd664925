"""Where a tool may stand upright, so that a contact lies under the flat of its tip.

Places are pairs (u, v) across the axis, from the contact. A point of the surface that is too deep in the tool at one place is so
at all places that are as near to it: each forbids a disk. Of the places that are left one is on the rim of the flat or where the
borders of two disks cross.
"""

import math
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from cad_io.arrays import Floats
from plan_cutters_check.tool import Solid

#: Places on the rim and within it that are looked at first; by how much disks are widened, mm; rounding, mm.
_RIM, _RING, _APART, _ROUNDING = 36, 12, 1e-5, 1e-9
_HALVINGS = 50


def first_places(most: float) -> Floats:
    """Places (n, 2) within a radius, mm, to begin with."""
    rim, ring = (np.arange(n) * (2.0 * math.pi / n) for n in (_RIM, _RING))
    circles = [-r * np.column_stack([np.cos(turn), np.sin(turn)]) for r, turn in ((most, rim), (0.5 * most, ring))]
    return np.concatenate([*circles, np.zeros((1, 2))])


@dataclass(slots=True)
class Places:
    """Places of one contact.

    Attributes
    ----------
    most : float
        Radius of the flat, mm.
    disk : (k, 3) float
        What is forbidden: centres and radii, mm.
    open_ : (n, 2) float
        Places that may be free, and `margin`, how far each is from all disks.
    """

    most: float
    disk: Floats = field(default_factory=lambda: np.zeros((0, 3)))
    open_: Floats = field(default_factory=lambda: np.zeros((0, 2)))
    margin: Floats = field(default_factory=lambda: np.zeros(0))

    def __post_init__(self) -> None:
        self.open_ = first_places(self.most)
        self.margin = np.full(len(self.open_), np.inf)

    @property
    def best(self) -> Floats | None:
        """The place farthest from all disks; None if all are forbidden."""
        return self.open_[int(self.margin.argmax())] if len(self.open_) else None

    def forbid(self, centre: Floats, radius: float) -> None:
        """Forbid the places that are nearer to a point (2,) than a radius; the one that was tried last is among them."""
        tried = int(self.margin.argmax())
        left = np.arange(len(self.open_)) != tried
        new = np.array([[*centre, radius + _APART]])
        crossing = np.concatenate([_crossings(new[0], each) for each in [*self.disk, np.array([0.0, 0.0, self.most])]])
        self.disk = np.concatenate([self.disk, new])
        crossing = crossing[np.linalg.norm(crossing, axis=1) <= self.most + _ROUNDING]
        every = np.concatenate([self.open_[left], crossing])
        margin = np.concatenate([self.margin[left], np.full(len(crossing), np.inf)])
        if len(every):
            margin = np.minimum(margin, _away(every, new))
            crossed = np.arange(len(every)) >= left.sum()
            margin[crossed] = _away(every[crossed], self.disk)
        self.open_, self.margin = every[margin >= -_ROUNDING], margin[margin >= -_ROUNDING]


def _away(place: Floats, disk: Floats) -> Floats:
    """How far places (n, 2) are from the nearest of some disks (k, 3)."""
    apart = np.linalg.norm(place[:, None] - disk[:, :2], axis=2) - disk[:, 2]
    return np.asarray(apart.min(axis=1, initial=np.inf))


def _crossings(one: Floats, other: Floats) -> Floats:
    """Where two circles (3,) cross: (0 or 2, 2)."""
    way = other[:2] - one[:2]
    d = math.hypot(*way)
    if d == 0.0 or d > one[2] + other[2] or d < abs(one[2] - other[2]):
        return np.zeros((0, 2))
    along = (d * d + one[2] ** 2 - other[2] ** 2) / (2.0 * d)
    across = math.sqrt(max(0.0, one[2] ** 2 - along * along))
    way = way / d
    middle, side = one[:2] + along * way, across * np.array([-way[1], way[0]])
    return np.array([middle - side, middle + side])


def reach_at(solid: Solid, height: float, deep: float, within: float) -> float:
    """Up to which distance from the axis a point at a height is deeper in a solid than `deep`: `within` is so, or is taken."""
    low, high = within, within + 2.0 * float(np.abs(solid.border).max())
    for _ in range(_HALVINGS):
        middle = 0.5 * (low + high)
        if solid.depth(np.array([middle]), np.array([height]))[0][0] > deep:
            low = middle
        else:
            high = middle
    return low


def across(axis: Floats, first: Floats) -> NDArray[np.float64]:
    """Unit directions (2, 3) across an axis, the first nearest to a direction."""
    u = first - (first @ axis) * axis
    u = u / max(float(np.linalg.norm(u)), 1e-300)
    return np.array([u, np.cross(axis, u)])
