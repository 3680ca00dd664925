"""Lengths as people write them in the words for cutters and holders: `12`, `12mm`, `0.5in`, `1/2in`."""

import math
import re
from fractions import Fraction

#: A length in a text; what is written behind the number is its unit, mm where there is none.
LENGTH = r"-?(?:[0-9]+/[0-9]+|[0-9]+\.?[0-9]*|\.[0-9]+)(?:in|mm)?"
_UNITS = {"in": Fraction("25.4"), "mm": Fraction(1)}


def length(text: str, share: Fraction = Fraction(1)) -> float:
    """A text of the form `LENGTH` in mm, times a share, rounded once: an inch is 25.4 mm and nothing else.

    What no number can hold is infinite, so that who asks refuses it.

    >>> length("0.1in"), length("12"), length("1/2in", Fraction(1, 2))
    (2.54, 12.0, 6.35)
    """
    found = re.fullmatch(r"(.*?)(in|mm)?", text.strip(), re.IGNORECASE)
    number, unit = (found[1], (found[2] or "mm").lower()) if found else (text, "mm")
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
