"""The plan of operations: the words that ask for one, and how an operation cuts."""

from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from cad_io.arrays import Floats
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

    Raises
    ------
    OptionError
        Another word.
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
