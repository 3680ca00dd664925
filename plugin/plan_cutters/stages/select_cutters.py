"""Which cutter wins, and by what rule."""

from collections.abc import Sequence

from plan_cutters.domain.cutter import Cutter


def ranked(cutters: Sequence[Cutter]) -> list[Cutter]:
    """Cutters from the most to the least wanted."""
    return sorted(cutters, key=lambda c: (-c.radius, c.corner_radius, c.length))
