"""Lengths as people write them in the words for cutters and holders: `12`, `12mm`, `0.5in`, `1/2in`."""

import functools
import math
import re
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from fractions import Fraction
from typing import Any, Literal, NamedTuple, TypeVar

#: A length in a text; what is written behind the number is its unit, mm where there is none.
LENGTH = r"-?(?:[0-9]+/[0-9]+|[0-9]+\.?[0-9]*|\.[0-9]+)(?:in|mm)?"
_UNITS = {"in": Fraction("25.4"), "mm": Fraction(1)}
#: mm in an inch.
INCH = 25.4
#: The unit of lengths in the words that are being made; None: mm, and tools as they were given.
_reported: ContextVar[Literal["mm", "in"] | None] = ContextVar("reported", default=None)
_F = TypeVar("_F", bound=Callable[..., Any])


@contextmanager
def reported_in(unit: Literal["mm", "in"] | None) -> Iterator[None]:
    """Within this, words have lengths in a unit; numbers that are no words stay mm."""
    token = _reported.set(unit)
    try:
        yield
    finally:
        _reported.reset(token)


def reporting(unit_of: Callable[[Any], Literal["mm", "in"] | None]) -> Callable[[_F], _F]:
    """Make a function whose words have lengths in the unit that its first argument names; it must be no generator."""

    def wrap(function: _F) -> _F:
        @functools.wraps(function)
        def inner(first: Any, *args: Any, **more: Any) -> Any:
            with reported_in(unit_of(first)):
                return function(first, *args, **more)

        return inner  # type: ignore[return-value]

    return wrap


def in_inches(stated: bool = False) -> bool:
    """Whether words have lengths in inches; `stated`: of a tool, where no unit was chosen, whether it was given in them.

    >>> in_inches(), in_inches(True)
    (False, True)
    """
    unit = _reported.get()
    return stated if unit is None else unit == "in"


def length(text: str, share: Fraction = Fraction(1)) -> float:
    """A text of the form `LENGTH` in mm, times a share, rounded once: an inch is 25.4 mm and nothing else.

    What no number can hold is infinite, so that who asks refuses it.

    >>> length("0.1in"), length("12"), length("1/2in", Fraction(1, 2))
    (2.54, 12.0, 6.35)
    """
    match = re.fullmatch(r"(.*?)(in|mm)?", text.strip(), re.IGNORECASE)
    number, unit = (match[1], (match[2] or "mm").lower()) if match else (text, "mm")
    try:
        return float(Fraction(number.rstrip(".")) * _UNITS[unit] * share)
    except (ValueError, ZeroDivisionError, OverflowError):
        return math.inf


def across(by: str, text: str) -> float:
    """The radius of what is given `by` its radius, R, or its diameter, D; mm.

    >>> across("D", "12"), across("r", "6")
    (6.0, 6.0)
    """
    return length(text, Fraction(1, 2) if by in "dD" else Fraction(1))


def text_of(value: float) -> str:
    """A number as ids have it."""
    return f"{value:.10g}"


class Notation(NamedTuple):
    """How people give a round tool: by radius or diameter, in mm or, where a number is short in them, inches.

    >>> Notation("D", True).across(6.35), Notation("D", True).length(80.0), Notation("R").across(6.35)
    ('0.5in', '80', '6.35')
    >>> Notation("D", True).mm(12.345)
    '0.486024 in'
    """

    by: Literal["R", "D"]
    inches: bool = False

    def length(self, value: float) -> str:
        """A length, mm, in a word: `length` reads the same of it."""
        short = f"{value / 25.4:.5g}in"
        return short if self.inches and text_of(length(short)) == text_of(value) else text_of(value)

    def across(self, radius: float) -> str:
        """A radius, mm, in a word: `across` reads the same of it."""
        return self.length(radius if self.by == "R" else 2.0 * radius)

    def mm(self, value: float) -> str:
        """A length, mm, in a sentence."""
        if not in_inches(self.inches):
            return f"{value:g} mm"
        # What was given in mm is no round number of inches.
        return f"{value / INCH:.6g} in" if self.inches else f"{value / INCH:.4g} in"
