"""The answers that may be requested after the plan."""

from typing import Any

from plan_cutters.domain.answer_kinds import ANSWERS
from plan_cutters.domain.checks import items, shown
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
