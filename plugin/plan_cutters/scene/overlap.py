"""Does a fixture stand in the part? They may touch; what is deeper than triangles and tolerance can be off is a mistake.

How deep it may stand in the part all the same is `docs/operations_proof.md`, lemma K2.
"""

from dataclasses import dataclass
from functools import partial

import numpy as np

from cad_io.arrays import Floats, Record
from plan_cutters.domain.clamping import Clamping
from plan_cutters.domain.fixture import Fixture
from plan_cutters.errors import FixtureError
from plan_cutters.scene.fixtures import body_near
from plan_cutters.scene.obstacles import Obstacles
from plan_cutters.scene.surroundings import Surroundings
from plan_cutters.scene.triangles import divided
from plan_cutters.setups.solids import insides

#: Points are looked at this share apart of the box that a fixture and the part have in common; and at most about so many.
_APART, _MOST = 1 / 64, 200_000
#: The depth is found to this share of itself, at first of about so many points.
_PRECISION, _FEW = 0.002, 400


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Overlap(Record):
    """Where a fixture and the part are deepest in each other, of the points looked at.

    Attributes
    ----------
    depth : float
        mm: a ball of this radius about `point` is all in the one, and `point` is of the other's surface.
    point : (3,) float
    """

    depth: float
    point: Floats


def refuse_overlaps(surroundings: Surroundings, tolerance: float) -> None:
    """Refuse fixtures that stand in the part.

    Raises
    ------
    FixtureError
        It names the fixture, the depth and the place.
    """
    part = (surroundings.alone or surroundings).certain
    for each in surroundings.fixtures:
        clamping, near = each.fixture.clamping, each.obstacles
        if clamping is not None:
            near = body_near(clamping, each.fixture, near.triangles.chord_error, part)
        result = overlap(part, near, tolerance)
        if result is not None:
            x, y, z = (f"{value + 0.0:.4g}" for value in np.round(result.point, 6))
            raise FixtureError(
                f"{each.name} and the part stand {result.depth:.3g} mm deep in each other at {x},{y},{z} mm: check "
                "its placement and its unit"
            )


def overlap(part: Obstacles, fixture: Obstacles, tolerance: float) -> Overlap | None:
    """How deep a fixture stands in a part, or the part in it; None where they touch at most.

    Only what is closed has an inside: two surfaces that enclose nothing are not compared.

    Parameters
    ----------
    part : Obstacles
        The part alone, with what it surely encloses.
    fixture : Obstacles
        In its place.
    tolerance : float
        Depth that is no fault, mm, beside the chord errors of both.
    """
    deep, pairs = _compared(part, fixture, tolerance)
    overlaps = [_deepest(points, other, deep) for points, other in pairs]
    return max((each for each in overlaps if each is not None), key=lambda each: each.depth, default=None)


def overlaps(part: Obstacles, fixture: Obstacles, tolerance: float) -> bool:
    """Whether there is an overlap: of many points a few are looked at first, and its depth is not found."""
    deep, pairs = _compared(part, fixture, tolerance)
    each = [(points[:: 1 + len(points) // _FEW], points, other) for points, other in pairs]
    return any(len(_within(few, deep, other)) for few, _, other in each) or any(
        len(_within(points, deep, other)) for _, points, other in each
    )


def entered(part: Obstacles, fixture: Fixture, clamping: Clamping, deep: float) -> bool:
    """Whether some point of a part's faces surely lies deeper in a vise or chuck in its place than a length, mm.

    Corners and middles of triangles are looked at: no does not mean that nothing lies in it.
    """
    from plan_cutters.kernels.linear.within import Space, any_within

    spaces = (Space(fixture.shift, fixture.rotation, *each) for each in insides(clamping, deep))
    return any(any_within(part.tree, part.faces, each) for each in spaces)


def _compared(part: Obstacles, fixture: Obstacles, tolerance: float) -> tuple[float, list[tuple[Floats, Obstacles]]]:
    """Depth that is no fault, mm, and points of each of two with the other in which they are searched; none where these are
    apart."""
    deep = tolerance + part.triangles.chord_error + fixture.triangles.chord_error
    ends = [o.corners for o in (part, fixture)]
    low, high = np.max([a for a, _ in ends], axis=0), np.min([b for _, b in ends], axis=0)
    if (high - low < 0).any():
        return deep, []
    apart = max(_APART * float(np.linalg.norm(high - low)), deep)
    return deep, [(_points(one, low, high, apart), other) for one, other in ((fixture, part), (part, fixture))]


def _points(obstacles: Obstacles, low: Floats, high: Floats, apart: float) -> Floats:
    """Points (n, 3) of triangles within a box, no farther apart than asked, if they are not too many."""
    small = divided(obstacles.triangles.vertex[obstacles.rows_in(low, high)], low, high, apart, _MOST)
    points = np.concatenate([*np.moveaxis(small, 1, 0), small.mean(axis=1)])
    return points[((points >= low) & (points <= high)).all(axis=1)]


def _deepest(points: Floats, solid: Obstacles, least: float) -> Overlap | None:
    """The point (of n, 3) that is deepest in what obstacles enclose; None if none is deeper than a least depth, mm."""
    within = partial(_within, solid=solid)
    remaining, low, point = within(points, least), least, None
    while len(remaining):
        # Of some, the deepest; then only what is deeper.
        few = remaining[:: 1 + len(remaining) // _FEW]
        while len(deeper := within(few, 2.0 * low)):
            few, low = deeper, 2.0 * low
        high = 2.0 * low
        while high - low > _PRECISION * low:
            middle = 0.5 * (low + high)
            deeper = within(few, middle)
            few, low, high = (deeper, middle, high) if len(deeper) else (few, low, middle)
        point = few[0]
        remaining, low = within(remaining, high), high
    return None if point is None else Overlap(low, point)


def _within(points: Floats, clear: float, solid: Obstacles) -> Floats:
    """Those of some points (n, 3) that are deeper in what obstacles enclose than a length, mm."""
    from plan_cutters.kernels.material import far_inside

    points = np.ascontiguousarray(points)
    inside = np.zeros(len(points), bool)
    if len(points) and solid.weight.any():
        far_inside(points, clear, solid.solids, inside)
    return np.ascontiguousarray(points[inside])
