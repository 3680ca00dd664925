"""The answers that may be requested after the plan, and what was found."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from plan_cutters.domain.answer_kinds import ANSWERS
from plan_cutters.domain.change import Advice
from plan_cutters.domain.checks import items, shown
from plan_cutters.domain.least_set import LeastSet
from plan_cutters.domain.operations import Operations
from plan_cutters.domain.radius_map import RadiusMap
from plan_cutters.domain.stick_out import StickOut
from plan_cutters.errors import OptionError


def answers_of(value: Any) -> tuple[str, ...]:
    """Words of ANSWERS, each once and in that order; `all` for all of them; a text may hold several, joined by commas.

    Raises
    ------
    OptionError
        Another word.

    Examples
    --------
    >>> answers_of("mend,stick-out")
    ('stick-out', 'mend')
    >>> answers_of("radii")
    Traceback (most recent call last):
    plan_cutters.errors.OptionError: answers: 'radii' is none of stick-out, radius, mend and all
    """
    if isinstance(value, str):
        words: list[Any] = value.split(",") if value.strip() else []
    else:
        words = items(value, "answers", "words", error=OptionError) if value is not None else []
    result = {word.strip().lower() if isinstance(word, str) else word for word in words}
    for word in sorted(result - {*ANSWERS, "all"}, key=str):
        raise OptionError(f"answers: {shown(word)} is none of {', '.join(ANSWERS)} and all")
    return tuple(word for word in ANSWERS if word in result or "all" in result)


@dataclass(frozen=True, slots=True, eq=False)
class Answers:
    """The answers that are computed after the plan, where the user asked for them.

    Attributes
    ----------
    stick_outs : mapping
        Cutter id -> StickOut.
    radius_maps : tuple of RadiusMap
        For flat ends, and for ball ends.
    mends : mapping
        Cutter id -> Advice, of those that do not finish the part, or of the nearest of them.
    not_mended : tuple of str
        Ids of the others of them, where that was asked.
    least_set : LeastSet, optional
        The fewest of the given cutters and setups that reach all that any of them reaches; None where there is but one of each.
    operations : Operations, optional
        The plan of operations.
    """

    stick_outs: Mapping[str, StickOut] = field(default_factory=dict)
    radius_maps: tuple[RadiusMap, ...] = ()
    mends: Mapping[str, Advice] = field(default_factory=dict)
    not_mended: tuple[str, ...] = ()
    least_set: LeastSet | None = None
    operations: Operations | None = None
