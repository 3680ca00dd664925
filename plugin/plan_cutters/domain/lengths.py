"""Lengths as people write them in the words for cutters and holders: `12`, `12mm`, `0.5in`, `1/2in`."""

import math
import re
from fractions import Fraction
from typing import Literal, NamedTuple

#: A length in a text; what is written behind the number is its unit, mm where there is none.
LENGTH = r"-?(?:[0-9]+/[0-9]+|[0-9]+\.?[0-9]*|\.[0-9]+)(?:in|mm)?"
_UNITS = {"in": Fraction("25.4"), "mm": Fraction(1)}


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
    >>> Notation("D").size(6.35), Notation("R", True).size(6.35), Notation("D", True).mm(12.345)
    ('a diameter of 12.7 mm', 'a radius of 0.25 in', '0.486024 in')
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
        return f"{value / 25.4:.6g} in" if self.inches else f"{value:g} mm"

    def size(self, radius: float) -> str:
        """How thick a tool of a radius, mm, is, in a sentence."""
        return f"a radius of {self.mm(radius)}" if self.by == "R" else f"a diameter of {self.mm(2.0 * radius)}"
