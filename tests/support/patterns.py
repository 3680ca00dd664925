"""Parts made of equal faces, and such that nearly are."""

import math

import cadquery as cq


def impeller(blades: int = 6, *, off: float = 0.0, fillet: float = 0.0) -> cq.Workplane:
    """Curved blades on a disk; the last one begins `off` mm farther out, and all have a fillet at their foot."""
    part = cq.Workplane("XY").circle(40).extrude(6).union(cq.Workplane("XY").circle(9).extrude(14))
    for k in range(blades):
        start = 14.0 + (off if k == blades - 1 else 0.0)
        blade = cq.Workplane("XY").workplane(offset=4).moveTo(start, -1.2).threePointArc((25, -4.2), (36, -1.2))
        blade = blade.lineTo(36, 1.2).threePointArc((25, -1.4), (start, 1.2)).close().extrude(18)
        part = part.union(blade.rotate((0, 0, 0), (0, 0, 1), 360.0 / blades * k))
    if not fillet:
        return part
    return part.newObject([edge for edge in part.edges().vals() if _at_foot(edge)]).fillet(fillet)


def _at_foot(edge: cq.Edge) -> bool:
    box, middle = edge.BoundingBox(), edge.Center()
    return abs(box.zmin - 6) < 1e-6 and abs(box.zmax - 6) < 1e-6 and 12 < math.hypot(middle.x, middle.y) < 38.5


def plate(columns: int = 6, rows: int = 4, *, deeper: float = 0.0, corner: float = 4.0) -> cq.Workplane:
    """A plate with equal pockets; the last one is `deeper` by so many mm."""
    places = [(20.0 * (i - (columns - 1) / 2), 20.0 * (j - (rows - 1) / 2)) for i in range(columns) for j in range(rows)]
    part = cq.Workplane("XY").box(20.0 * columns + 10.0, 20.0 * rows + 10.0, 20.0)
    for k, (x, y) in enumerate(places):
        depth = 8.0 + (deeper if k == len(places) - 1 else 0.0)
        pocket = cq.Workplane("XY").workplane(offset=10.0 - depth).center(x, y).rect(14, 14).extrude(depth + 1.0)
        part = part.cut(pocket.edges("|Z").fillet(corner))
    return part
