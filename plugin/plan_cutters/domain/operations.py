"""The plan of operations: the words that ask for one, and how an operation cuts."""

from collections.abc import Hashable, Iterable
from dataclasses import dataclass
from itertools import pairwise
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from cad_io.arrays import Floats, Ints, Record
from plan_cutters.domain.checks import shown
from plan_cutters.errors import OptionError

#: Plans that may be requested.
WHICH = ("fewest", "fastest", "both")
Strategy = Literal["point", "floor", "wall", "mixed"]
#: How a sample is cut, in the numbers of `OperationPlan.strategy`.
STRATEGIES: tuple[Strategy, ...] = ("point", "floor", "wall")
#: A strategy by which so much of an operation's area is cut is that of the operation, as a share.
_NEARLY_ALL = 0.95
#: Another orientation takes this, s, where no time was given and the machine does not say how fast its rotary axes turn.
INDEX_TIME = 5.0
IndexFrom = Literal["rates", "given", "assumed"]


def operations_of(value: Any) -> str | None:
    """One of WHICH, or None for no plan of operations; `all` is `both`, as other options have an `all`.

    Raises OptionError: another word.
    """
    if value is None or value in WHICH:
        return value if value is None else str(value)
    if value == "all":
        return "both"
    raise OptionError(f"operations: {shown(value)} is none of {', '.join(WHICH)}")


def strategy_of(number: NDArray[np.uint8], area: Floats) -> Strategy:
    """The strategy of an operation whose samples (n,) are cut by some, numbers in STRATEGIES, and stand for some areas.

    >>> strategy_of(np.array([2, 2, 0], np.uint8), np.array([60.0, 39.0, 1.0]))
    'wall'
    >>> strategy_of(np.array([2, 1], np.uint8), np.ones(2)), strategy_of(np.zeros(0, np.uint8), np.zeros(0))
    ('mixed', 'point')
    """
    size = np.bincount(number, area, len(STRATEGIES))
    if not len(number):
        return "point"
    return STRATEGIES[int(size.argmax())] if size.max() >= _NEARLY_ALL * size.sum() else "mixed"


def tool_changes(uses: Iterable[tuple[int, Hashable]]) -> int:
    """Count how often another tool than the one in the spindle is put in, the first one being there.

    `uses`: the setup and the tool of each step; within a setup in their order. A setup begins with the tool that is there.

    >>> tool_changes([(0, "D12"), (0, "D12"), (0, "D6")]), tool_changes([(1, "D12"), (0, "D12"), (0, "D6")])
    (1, 2)
    >>> tool_changes([(0, "D12"), (0, "D6"), (1, "D6")]), tool_changes([])
    (1, 0)
    """
    tools = [tool for _, tool in sorted(uses, key=lambda use: use[0])]
    return sum(before != after for before, after in pairwise(tools))


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Columns(Record):
    """Operations that may be chosen, each with one cutter, setup and tool axis."""

    #: `cutter`, `setup` (m,) int32: index into the cutters and setups that were requested.
    cutter: Ints
    setup: Ints
    axis: Floats  #: (m, 3) float: unit tool axis in part coordinates: the one that the rounded `angle` gives.
    #: (m, k) float: positions of the k rotary axes, deg, as a control shows them; where the machine names none the azimuth and
    #: the tilt about the setup axis.
    angle: Floats

    def __len__(self) -> int:
        return len(self.axis)

    @property
    def key(self) -> NDArray[np.str_]:
        """A text for each, the same for the same ones."""
        rows = zip(self.cutter.tolist(), self.setup.tolist(), self.angle.tolist(), strict=True)
        return np.array([" ".join([f"{c} {s}", *(f"{angle:.3f}" for angle in angles)]) for c, s, angles in rows], np.str_)

    @property
    def first(self) -> NDArray[np.int64]:
        """Where (k,) each of them that differs from all before it stands."""
        return np.sort(np.unique(self.key, return_index=True)[1])

    def of(self, which: NDArray[np.int64]) -> "Columns":
        """Take some of them."""
        return Columns(self.cutter[which], self.setup[which], self.axis[which], self.angle[which])

    def and_(self, more: "Columns") -> "Columns":
        """Append more of them."""
        both = (np.concatenate([getattr(self, name), getattr(more, name)]) for name in Columns.__slots__)
        return Columns(*both)


def columns_of(axis: Floats, angle: Floats, cutter: int = 0, setup: int = 0) -> Columns:
    """Make columns of one cutter in one setup."""
    n = len(axis)
    return Columns(np.full(n, cutter, np.int32), np.full(n, setup, np.int32), axis, angle)
