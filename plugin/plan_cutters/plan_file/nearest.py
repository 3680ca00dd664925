"""Which cutter comes nearest where none finishes: the one that leaves the least area, as all shares beside it are of area."""

import math
from collections.abc import Iterable
from typing import Protocol, TypeVar

#: Shares that differ by less are equal.
_DIGITS = 9


class _Share(Protocol):
    @property
    def not_reached(self) -> float: ...


class Judged(Protocol):
    """A cutter's entry in a plan: the share of the area that it leaves, 0 to 1, and the number of samples."""

    @property
    def area_share(self) -> _Share: ...

    @property
    def not_reached(self) -> int: ...


C = TypeVar("C", bound=Judged)


def leaves(cutter: Judged) -> tuple[float, int]:
    """Sort cutters by this: the share of the area that is left, then the number of samples, which may stand for no area."""
    share = cutter.area_share.not_reached
    return round(share, _DIGITS) if math.isfinite(share) else math.inf, cutter.not_reached


def nearest(cutters: Iterable[C]) -> C:
    """Of some cutters the one that leaves least; of equals the first, which is the most wanted."""
    return min(cutters, key=leaves)
