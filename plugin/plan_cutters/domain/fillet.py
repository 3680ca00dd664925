"""Which fillet does a cutter leave beside a sharp inside edge?"""

from plan_cutters.domain.cutter import Cutter


def least_radius(cutter: Cutter) -> float | None:
    """Least radius of the fillet that a cutter leaves beside an edge, mm, its allowance included; None for shapes without one.

    It is the corner radius, or of a flat end the radius, with which it goes along an edge.

    >>> least_radius(Cutter.parse("R6L80")), least_radius(Cutter.parse("R6L80rc1")), least_radius(Cutter.parse("R6L80rc6"))
    (6.0, 1.0, 6.0)
    """
    if cutter.shape == "lollipop":
        return cutter.radius + (cutter.allowance or 0.0)
    if cutter.shape != "end":
        return None
    return (cutter.corner_radius or cutter.radius) + (cutter.allowance or 0.0)
