"""Parts of convex blocks: their solids, their materials and contacts on their faces."""

from collections.abc import Callable
from typing import Any

import numpy as np

from conformance.forms import Hull, Prism, section
from conformance.tool import Floats

#: Half the length (mm) of a bar along y. No tool here is longer than 60 and contacts lie near the middle, so that the ends of a
#: bar are farther than any other face: its materials go on without end.
HALF = 110.0

Point2 = tuple[float, float]
Point3 = tuple[float, float, float]
Outline = tuple[Point2, ...]
Contacts = Callable[[np.random.Generator, int], tuple[Floats, Floats]]


def rectangle(x0: float, x1: float, z0: float, z1: float) -> Outline:
    """Return a rectangle of the x z plane."""
    return ((x0, z0), (x1, z0), (x1, z1), (x0, z1))


def bars(**outlines: Outline) -> tuple[tuple[Prism, ...], Callable[[], Any]]:
    """Return the materials of bars along y, with these convex outlines in the x z plane, and what builds them as one solid."""
    materials = tuple(section(name.replace("_", " "), *points) for name, points in outlines.items())
    return materials, lambda: fused(*(extruded(points, HALF) for points in outlines.values()))


def prism(name: str, points: Outline, half: float) -> Hull:
    """Return the material of a bar that ends at y = -half and half."""
    return Hull(name, tuple((x, y, z) for x, z in points for y in (-half, half)))


def extruded(points: Outline, half: float) -> Any:
    """Return the solid of a bar."""
    import cadquery as cq

    return cq.Workplane("XZ").polyline(points).close().extrude(half, both=True)


def cuboid(low: Point3, high: Point3) -> Any:
    """Return the solid of an axis-parallel box."""
    import cadquery as cq

    size = [b - a for a, b in zip(low, high, strict=True)]
    return cq.Workplane("XY").box(*size, centered=False).translate(low)


def fused(first: Any, *others: Any) -> Any:
    """Return one solid. Faces in one plane stay apart, so that each belongs to one of the materials."""
    for other in others:
        first = first.union(other, clean=False)
    return first


def together(*solids: Any) -> Any:
    """Return several solids in one part, as they are."""
    import cadquery as cq

    return cq.Workplane(obj=cq.Compound.makeCompound([s.val() for s in solids]))


def on_lines(*lines: tuple[Point2, Point2], wide: float = 3.0) -> Contacts:
    """Return what draws contacts on faces of bars: the lines of their outlines, the material to the right of each way, |y| up
    to `wide`."""
    start, end = (np.array([line[i] for line in lines], float) for i in (0, 1))

    def contacts(rng: np.random.Generator, n: int) -> tuple[Floats, Floats]:
        pick, t = rng.integers(len(lines), size=n), rng.uniform(0.03, 0.97, n)[:, None]
        way = (end - start)[pick]
        points, way = start[pick] + t * way, way / np.linalg.norm(way, axis=1)[:, None]
        y, zero = rng.uniform(-wide, wide, n), np.zeros(n)
        return np.column_stack([points[:, 0], y, points[:, 1]]), np.column_stack([-way[:, 1], zero, way[:, 0]])

    return contacts


def on_rectangles(*faces: tuple[Point3, Point3, Point3]) -> Contacts:
    """Return what draws contacts on axis-parallel rectangles, each of two corners and the normal."""
    low, high, out = (np.array([face[i] for face in faces], float) for i in range(3))

    def contacts(rng: np.random.Generator, n: int) -> tuple[Floats, Floats]:
        pick = rng.integers(len(faces), size=n)
        return low[pick] + rng.uniform(0.03, 0.97, (n, 3)) * (high - low)[pick], out[pick]

    return contacts
