"""Find the covers of the part's surface: bodies that overlap others or stand on them, and open shells that lie on a body."""

from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from cad_io.arrays import Record
from cad_io.part.bodies import Body
from plan_cutters.scene.inside_material import balls_inside
from plan_cutters.scene.preparation import Prepared

How = Literal["overlaps", "stands_on", "touches_or_overlaps"]

#: A contact is surely within a body from so many depths on beyond which a posture is blocked, and on its skin up to so many.
_DEEP, _ON = 1.5, 1.5
#: Contacts that are asked first.
_FEW = 300


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Covering(Record):
    """A body, and what of the samples lies inside it.

    Attributes
    ----------
    index : int
        Into the part's bodies.
    rows : (m,) int64
        Samples, those of sheets that lie on bodies not among them.
    how : str
        `overlaps`: volumes intersect, for some of these contacts lie deep in the body. `stands_on`: all of them lie on its skin.
        Otherwise neither is sure.
    """

    index: int
    rows: NDArray[np.int64]
    how: How


def coverings(ready: Prepared) -> tuple[Covering, ...]:
    """The bodies of a part that samples lie inside of, those with the largest area first."""
    inside, around, samples = ready.inside_bodies, ready.conditions.around, ready.samples
    rows = np.flatnonzero(inside & ~np.isin(samples.face, around.on_bodies))
    found = []
    for index in np.unique(ready.inside[rows]).tolist():
        mine = rows[ready.inside[rows] == index]
        found.append(Covering(index, mine, _how(ready, around.bodies[index], mine)))
    return tuple(sorted(found, key=lambda each: (-float(samples.area[each.rows].sum()), each.index)))


def sheets(ready: Prepared) -> NDArray[np.int64]:
    """Samples inside bodies that are those of construction sheets lying on one."""
    return np.flatnonzero(ready.inside_bodies & np.isin(ready.samples.face, ready.conditions.around.on_bodies))


def _how(ready: Prepared, body: Body, rows: NDArray[np.int64]) -> How:
    """Whether a body lies over contacts or only against them."""
    from plan_cutters.kernels.material import near_skin

    certain = ready.conditions.around.certain
    _, deep = certain.depths(ready.conditions.tolerance)
    point, skin = np.ascontiguousarray(ready.samples.point[rows]), certain.skin_of(body)
    on = np.zeros(len(rows), bool)
    # Where a body overlaps, a few of them tell.
    few = np.arange(len(point)) % (1 + len(point) // _FEW) == 0
    for some in (point[few], point[~few]):
        if balls_inside(some, _DEEP * deep, skin, ready.options.jobs).any():
            return "overlaps"
    near_skin(point, _ON * deep, skin.solids, on)
    return "stands_on" if on.all() else "touches_or_overlaps"
