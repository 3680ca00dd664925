"""Find the covers of the part's surface: bodies that overlap others or stand on them, and open shells that lie on a body."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from cad_io.arrays import Record
from cad_io.kernel.shapes import component_of, faces_of
from cad_io.part import Part
from cad_io.part.bodies import Body
from plan_cutters.domain.figures import consecutive
from plan_cutters.scene.inside_material import balls_inside
from plan_cutters.scene.obstacles import weights
from plan_cutters.scene.preparation import Prepared

How = Literal["overlaps", "stands_on", "touches_or_overlaps"]

#: A contact is surely within a body from so many depths on beyond which a posture is blocked, and on its skin up to so many.
_DEEP, _ON = 1.5, 1.5
#: Contacts that are asked first.
_FEW = 300


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Covering(Record):
    """A body, and what of the samples lies inside it."""

    index: int  #: Into the part's bodies.
    rows: NDArray[np.int64]  #: (m,) int64: samples, those of sheets that lie on bodies not among them.
    #: `overlaps`: volumes intersect, for some of these contacts lie deep in the body. `stands_on`: all of them lie on its skin.
    #: Otherwise neither is sure.
    how: How
    faces: tuple[int, ...]  #: Of the body, ascending.
    largest: bool  #: No other body is larger.
    name: str  #: Of its component; empty where it has none of its own.
    selection: str  #: Words for faces that choose this body and no other one.


def coverings(ready: Prepared) -> tuple[Covering, ...]:
    """The bodies of a part that samples lie inside of, those with the largest area first."""
    inside, surroundings, samples = ready.inside_bodies, ready.conditions.surroundings, ready.samples
    rows = np.flatnonzero(inside & ~np.isin(samples.face, surroundings.on_bodies))
    result = []
    sizes = list[float]()
    for body in surroundings.bodies:
        triangles, own_rows = surroundings.certain.triangles, surroundings.certain.rows_of(body.faces)
        sign, (a, b, c) = weights(triangles.take(own_rows), [body]), np.moveaxis(triangles.vertex[own_rows], 1, 0)
        # The volume that its triangles enclose.
        sizes.append(abs(float((sign * (np.cross(a, b) * c).sum(axis=1)).sum())) / 6.0)
    for index in np.unique(ready.inside[rows]).tolist():
        mine = rows[ready.inside[rows] == index]
        own = sorted(number for number in surroundings.bodies[index].faces if number > 0)
        others = {n for i, body in enumerate(surroundings.bodies) if i != index for n in body.faces}
        how, largest = _how(ready, surroundings.bodies[index], mine), sizes[index] >= max(sizes)
        result.append(Covering(index, mine, how, tuple(own), largest, *_named(ready.scene.part, own, others)))
    return tuple(sorted(result, key=lambda each: (-float(samples.area[each.rows].sum()), each.index)))


def sheets(ready: Prepared) -> NDArray[np.int64]:
    """Samples inside bodies that are those of construction sheets lying on one."""
    return np.flatnonzero(ready.inside_bodies & np.isin(ready.samples.face, ready.conditions.surroundings.on_bodies))


def _how(ready: Prepared, body: Body, rows: NDArray[np.int64]) -> How:
    """Whether a body lies over contacts or only against them."""
    from plan_cutters.kernels.material import near_shell

    certain = ready.conditions.surroundings.certain
    _, deep = certain.depths(ready.conditions.tolerance)
    point, shell = np.ascontiguousarray(ready.samples.point[rows]), certain.skin_of(body)
    on = np.zeros(len(rows), bool)
    # Where a body overlaps, a few of them tell.
    few = np.arange(len(point)) % (1 + len(point) // _FEW) == 0
    for some in (point[few], point[~few]):
        if balls_inside(some, _DEEP * deep, shell, ready.options.jobs).any():
            return "overlaps"
    near_shell(point, _ON * deep, shell.solids, on)
    return "stands_on" if on.all() else "touches_or_overlaps"


def _named(part: Part, own: Sequence[int], others: set[int]) -> tuple[str, str]:
    """The name of a body's component, and the words for faces that choose this body and no other one."""
    components = component_of(part.tree)
    paths = {components.get(number, "") for number in own}
    path = next(iter(paths)).split("/") if len(paths) == 1 else []
    # The shortest end of its path that means no other one.
    for name in ("/".join(path[i:]) for i in reversed(range(len(path)))):
        if name and faces_of(part.tree, name) == set(own) and not others & set(own):
            return name, f"component:{name}"
    # What two bodies have in common closes the other one.
    return "", numbers([n for n in own if n not in others] or own)


def numbers(faces: Sequence[int]) -> str:
    """Face numbers as the command takes them.

    >>> numbers([7, 8, 9, 12])
    'F7-9,F12'
    """
    return ",".join(f"F{run[0]}" if len(run) == 1 else f"F{run[0]}-{run[-1]}" for run in consecutive(faces))
