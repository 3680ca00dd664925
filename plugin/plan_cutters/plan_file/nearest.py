"""Which cutter comes nearest where none finishes: the one that leaves the least area, as all shares beside it are of area."""

import math
from collections.abc import Iterable, Mapping
from typing import Protocol, TypeVar

#: The reason of what is left for another setup.
ANOTHER_SETUP = "another_setup"
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
    @property
    def by_reason(self) -> Mapping[str, int]: ...


C = TypeVar("C", bound=Judged)


def leaves(cutter: Judged) -> tuple[float, int]:
    """Sort cutters by this: the share of the area that is left, then the number of samples, which may stand for no area.

    What stands on the table of a proposed setup does not count: that table is not there yet, and chooses no cutter.
    """
    by_reason: Mapping[str, float] = getattr(cutter.area_share, "lost_by", {})
    share = cutter.area_share.not_reached - by_reason.get(ANOTHER_SETUP, 0.0)
    samples = cutter.not_reached - cutter.by_reason.get(ANOTHER_SETUP, 0)
    return round(share, _DIGITS) + 0.0 if math.isfinite(share) else math.inf, samples


def nearest(cutters: Iterable[C]) -> C:
    """Of some cutters the one that leaves least; of equals the first, which is the most wanted."""
    return min(cutters, key=leaves)
