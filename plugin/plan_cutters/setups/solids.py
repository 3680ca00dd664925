"""Boxes, cylinders, and the bodies of vises and chucks as triangles."""

import math
from collections.abc import Iterator

import numpy as np

from cad_io.arrays import Floats
from plan_cutters.domain.clamping import Chuck, Clamping, Disc

#: Sides of a disc, at most.
_SIDES = 720


def sides_of(radius: float, chord: float) -> int:
    """Sides of a prism in a cylinder: its chords are no farther from the arc than asked, mm, unless that takes too many."""
    sides = math.ceil(math.pi / math.acos(max(0.0, 1.0 - min(1.0, chord / radius))))
    return min(max(sides, 8), _SIDES)


def triangles_of(clamping: Clamping, chord: float, *, shown: bool = False, above: float = -math.inf) -> tuple[Floats, float]:
    """Triangles of a vise or chuck in its own frame, each body closed by itself.

    Returns `vertex` (n, 3, 3) float: mm, counter-clockwise from outside; `error`: how far they are from what they stand for, mm.

    `clamping`: in its place: how far its jaws stand apart is known. `chord`: chord error to ask for, mm. `shown`: of the table,
    what is drawn alone. `above`: bodies that end below this height, mm, are left out, unless all do.
    """
    every = clamping.solids(chord, shown=shown)
    solids = [each for each in every if each.high > above] or every
    off, made = [clamping.off(chord)] if isinstance(clamping, Chuck) else [0.0], list[Floats]()
    for each in solids:
        if isinstance(each, Disc):
            sides = sides_of(each.radius, chord)
            off.append(each.radius * (1.0 - math.cos(math.pi / sides)))
            made.append(cylinder(each.radius, each.high - each.low, sides) + np.array([0.0, 0.0, each.low]))
        else:
            made.append(strip(np.array(each.inner), np.array(each.outer), each.low, each.high))
    return np.concatenate(made), max(off)


def insides(clamping: Clamping, deep: float) -> Iterator[tuple[Floats, Floats, float]]:
    """Yield what surely lies deeper in a vise or chuck than a length, mm, in its own frame.

    That is the corners (3,) of boxes, and for each the radius of a cylinder about z, infinite for a box. The jaws of a chuck are
    not yielded: what lies in no box or cylinder may lie in the vise or chuck all the same.
    """
    for solid in clamping.solids(deep):
        if isinstance(solid, Disc):
            radius = solid.radius - deep
            low, high = np.full(2, -radius), np.full(2, radius)
        elif len(solid.inner) == 2:
            corners = np.array([*solid.inner, *solid.outer])
            radius, low, high = np.inf, corners.min(axis=0) + deep, corners.max(axis=0) - deep
        else:
            continue
        yield np.append(low, solid.low + deep), np.append(high, solid.high - deep), radius


def strip(inner: Floats, outer: Floats, low: float, high: float) -> Floats:
    """Triangles (n, 3, 3) of a prism between two polylines (m, 2), counter-clockwise from outside.

    The outline runs along `inner` and back along `outer`, counter-clockwise seen from above.
    """

    def at(points: Floats, height: float) -> Floats:
        return np.column_stack([points, np.full(len(points), height)])

    a, b, d, c = inner[:-1], inner[1:], outer[:-1], outer[1:]
    top, bottom = [at(each, high) for each in (a, b, c, d)], [at(each, low) for each in (d, c, b, a)]
    outline = np.concatenate([inner, outer[::-1]])
    foot, after = at(outline, low), np.roll(at(outline, low), -1, axis=0)
    up = np.array([0.0, 0.0, high - low])
    sides = [foot, after, after + up, foot + up]
    quads = [np.stack(each, axis=1) for each in (top, bottom, sides)]
    return np.concatenate([quad[:, corners] for quad in quads for corners in ([0, 1, 2], [0, 2, 3])])


def box(low: Floats, high: Floats) -> Floats:
    """Triangles (12, 3, 3) of a box, counter-clockwise from outside."""
    corner = np.array([[x, y, z] for z in (0, 1) for y in (0, 1) for x in (0, 1)])
    sides = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]
    split = [(a, b, c) for a, b, c, _ in sides] + [(a, c, d) for a, _, c, d in sides]
    return np.asarray((low + corner * (high - low))[np.array(split)])


def cylinder(radius: float, height: float, sides: int) -> Floats:
    """Triangles (4 sides, 3, 3) of a prism in a cylinder that stands on the origin, counter-clockwise from outside."""
    turn = 2.0 * np.pi * np.arange(sides) / sides
    x, y = radius * np.cos(turn), radius * np.sin(turn)
    a = np.stack([x, y, np.zeros(sides)], axis=1)
    b, up = np.roll(a, -1, axis=0), np.array([0.0, 0.0, height])
    middle = np.zeros((sides, 3))
    parts = [(a, b, b + up), (a, b + up, a + up), (b, a, middle), (a + up, b + up, middle + up)]
    return np.concatenate([np.stack(part, axis=1) for part in parts])
