"""Which cutter wins, and by what rule."""

from collections.abc import Sequence

from plan_cutters.domain.cutter import Cutter

RULE = "largest radius, then smaller corner radius, then shorter length, then library order, among the feasible"


def ranked(cutters: Sequence[Cutter]) -> list[Cutter]:
    """Cutters from the most to the least wanted."""
    return sorted(cutters, key=lambda c: (-c.radius, c.corner_radius, c.length))
