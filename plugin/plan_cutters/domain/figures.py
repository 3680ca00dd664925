"""How numbers are written, each form once: lengths, angles, areas, places; what must not be less or more is rounded so.

Lengths in the words for cutters and holders are read here, too: `12`, `12mm`, `0.5in`, `1/2in`.
"""

import functools
import math
import re
from collections.abc import Callable, Iterable, Iterator, Sequence
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


#: Numbers of less than this are what rounding leaves of nothing.
ROUNDING = 1e-9
#: How shares are written that would be rounded to none, and to the whole.
HARDLY_ANY, ALL_BUT = "<0.1 %", ">99.9 %"
#: From so many seconds on a time is written in minutes, and in hours.
_MINUTES, _HOURS = 120.0, 7200.0


def figure(number: float) -> str:
    """Three digits of a number, without an exponent.

    >>> figure(12345.6), figure(0.0456), figure(7.769e6), figure(0.00001234), figure(-2.776e-17)
    ('12,300', '0.0456', '7,770,000', '0.0000123', '0')
    """
    if not math.isfinite(number) or abs(number) < ROUNDING:
        return "0" if math.isfinite(number) else f"{number:g}"
    return f"{float(f'{number:.3g}'):,.0f}" if abs(number) >= 100.0 else plainly(number, 3)


def plainly(number: float, digits: int) -> str:
    """So many digits of a number, as people write it: without an exponent, and without zeros that say nothing.

    >>> plainly(0.00001234, 3), plainly(100.0, 4), plainly(-2.776e-17, 4), plainly(1234567.8, 4)
    ('0.0000123', '100', '0', '1234568')
    """
    if not math.isfinite(number) or abs(number) < ROUNDING:
        return "0" if math.isfinite(number) else f"{number:g}"
    behind = max(0, digits - 1 - math.floor(math.log10(abs(float(f"{number:.{digits}g}")))))
    text = f"{number:.{behind}f}"
    return text.rstrip("0").rstrip(".") if "." in text else text


def percent(share: float, *, some: bool | None = None, whole: bool | None = None) -> str:
    """Write a share, 0 to 1, in percent: 100 only where it is the whole, and 0 only where there is nothing of it.

    `share`: of an area or a number; sums of areas may be off by rounding. `some`, `whole`: whether there is anything of it, and
    whether it is all, where samples were counted; default by the share itself.

    >>> percent(0.00001), percent(0.9996), percent(1.0, whole=False)
    ('<0.1 %', '>99.9 %', '>99.9 %')
    >>> percent(0.5), percent(0.0), percent(1.0), percent(0.0, some=True), percent(float("nan"))
    ('50 %', '0 %', '100 %', '<0.1 %', 'not known')
    """
    if share >= 1.0 if whole is None else whole:
        return "100 %"
    if not math.isfinite(share):
        return "not known"
    if share < ROUNDING and not (share > 0.0 if some is None else some):
        return "0 %"
    text = f"{100.0 * min(1.0, max(0.0, share)):.1f}"
    return {"0.0": HARDLY_ANY, "100.0": ALL_BUT}.get(text, f"{text.removesuffix('.0')} %")


def exact(share: float, *, some: bool, whole: bool) -> float:
    """Give a share that is 1 only where it is the whole, and 0 only where there is nothing of it, as samples were counted.

    Sums of areas are rounded, and samples may stand for no area.

    >>> exact(1.0, some=True, whole=False) < 1.0, exact(0.0, some=True, whole=False) > 0.0, exact(0.999, some=True, whole=True)
    (True, True, 1.0)
    """
    if whole or not some:
        return 1.0 if whole else 0.0
    return min(max(share, math.ulp(0.0)), math.nextafter(1.0, 0.0))


def bound(share: float) -> str:
    """Write a share that is not to be less, in percent: rounded up to a tenth; of a ratio it may be more than all.

    >>> bound(0.98301), bound(0.75), bound(1.246), bound(0.0)
    ('98.4 %', '75 %', '124.6 %', '0 %')
    """
    return f"{math.ceil(1000.0 * share - ROUNDING) / 10.0:g} %"


def some(share: float) -> str:
    """A share that is not all, in percent."""
    return percent(share, whole=False)


def mm(length: float | None, digits: int = 3) -> str:
    """A length that is given in mm, three digits of it, or so many, in the unit of the words.

    >>> mm(12345.6), mm(0.0456), mm(-2.776e-17), mm(12.3456, 4)
    ('12,300 mm', '0.0456 mm', '0 mm', '12.35 mm')
    >>> from plan_cutters.domain.figures import reported_in
    >>> with reported_in("in"):
    ...     mm(25.4), area(645.16), place((25.4, -12.7, 0.0)), up(6.0), down(6.0)
    ('1 in', '1 in²', '1, -0.5, 0', '0.237 in', '0.236 in')
    """
    if length is None:
        return ""
    return f"{figure(reported(length)) if digits == 3 else plainly(reported(length), digits)} {unit()}"


def size(lengths: Iterable[float], times: float = 1.0) -> str:
    """Extents that are given in mm, or so many times them: four digits of each, and all before the point.

    >>> size((40.0, 40.0, 20.0)), size((40.0, 40.0, 20.0), 25.4), size((12345.6, 0.05, 0.0))
    ('40 x 40 x 20 mm', '1,016 x 1,016 x 508 mm', '12,346 x 0.05 x 0 mm')
    """
    each = [float(plainly(reported(times * length), 4)) for length in lengths]
    return f"{' x '.join(f'{one:,.0f}' if abs(one) >= 1000.0 else plainly(one, 4) for one in each)} {unit()}"


def reported(length: float) -> float:
    """A length, mm, in the unit of the words."""
    return length / INCH if in_inches() else length


def unit() -> str:
    """The unit of lengths in the words: `mm`, or `in`."""
    return "in" if in_inches() else "mm"


def angle(degrees: float) -> str:
    """An angle to a tenth of a degree; a whole turn is none.

    >>> angle(359.97), angle(-0.01), angle(12.34)
    ('0°', '0°', '12.3°')
    """
    tenths = round(degrees, 1) + 0.0
    return f"{0.0 if abs(tenths) == 360.0 else tenths:g}°"


def exact_angle(degrees: float) -> str:
    """An angle to a millionth of a degree, as a machine's axis is set to it.

    >>> exact_angle(30.0), exact_angle(-12.3456789), exact_angle(-0.0)
    ('30°', '-12.345679°', '0°')
    """
    return f"{plainly(round(degrees, 6), 9)}°"


def part_done(share: float) -> str:
    """How much of a work is done, in whole percent: 100 only at its end.

    >>> part_done(0.0), part_done(0.999), part_done(1.0)
    ('0 %', '99 %', '100 %')
    """
    return f"{math.floor(100.0 * share)} %"


def area(mm2: float) -> str:
    """An area, three digits of it.

    >>> area(12345.6), area(0.0456), area(float("nan"))
    ('12,300 mm²', '0.0456 mm²', 'not known')
    """
    return f"{figure(reported(reported(mm2)))} {unit()}²" if math.isfinite(mm2) else "not known"


def place(point: Sequence[float] | None) -> str:
    """A point that is given in mm: four digits, and no more than four behind the point.

    >>> place((-2.776e-17, 12345.678, -0.70710678)), place(None)
    ('0, 12346, -0.7071', '')
    """
    return "" if point is None else direction([reported(x) for x in point])


def direction(axis: Sequence[float]) -> str:
    """A direction, as `place` writes a point."""
    return ", ".join(plainly(round(x, 4), 4) for x in axis)


def up(length: float | None) -> str:
    """A length that must not be less, rounded up."""
    if length is None:
        return ""
    digits = 3 if in_inches() else 2
    return f"{math.ceil(10.0**digits * reported(length) - 1e-9) / 10.0**digits:.{digits}f} {unit()}"


def down(length: float | None) -> str:
    """A length that must not be more, rounded down to three digits.

    >>> down(6.2399), down(0.0)
    ('6.23 mm', '0 mm')
    """
    if not length:
        return f"0 {unit()}"
    length = reported(length)
    digit = 10.0 ** (math.floor(math.log10(length)) - 2)
    return f"{math.floor(length / digit + 1e-9) * digit:.4g} {unit()}"


def duration(seconds: float | None) -> str:
    """A time: whole seconds up to two minutes, then minutes, then hours; empty where it is not known.

    >>> duration(0.04), duration(59.6), duration(738.0), duration(9000.0), duration(0.0), duration(None)
    ('less than 1 s', '60 s', '12.3 min', '2.5 h', '0 s', '')
    """
    if seconds is None or not math.isfinite(seconds) or seconds < 0.0:
        return ""
    if seconds < _MINUTES:
        return f"{seconds:.0f} s" if seconds >= 1.0 or seconds == 0.0 else "less than 1 s"
    return f"{seconds / 60.0:.1f} min" if seconds < _HOURS else f"{seconds / 3600.0:.1f} h"


def count(number: int, word: str) -> str:
    """So many things.

    >>> count(1, "face"), count(1200, "sample")
    ('1 face', '1,200 samples')
    """
    return f"{number:,} {word}{'' if number == 1 else 's'}"


def ranges(faces: Iterable[int]) -> str:
    """Numbers of faces as `--faces` takes them.

    >>> ranges([7, 1, 3, 4, 5, 9, 10]), ranges([])
    ('F1,3-5,7,9,10', '')
    """
    runs = consecutive(faces)
    texts = [f"{run[0]}-{run[-1]}" if len(run) > 2 else ",".join(map(str, run)) for run in runs]
    return f"F{','.join(texts)}" if texts else ""


def consecutive(numbers: Iterable[int]) -> list[list[int]]:
    """Numbers in ascending runs of which each is one more than the one before.

    >>> consecutive([4, 7, 3, 8])
    [[3, 4], [7, 8]]
    """
    runs: list[list[int]] = []
    for number in sorted(set(numbers)):
        if runs and number == runs[-1][-1] + 1:
            runs[-1].append(number)
        else:
            runs.append([number])
    return runs


def capital(text: str) -> str:
    """A text that begins a sentence; names of cutters may begin small."""
    return text[:1].upper() + text[1:]


def sentence(text: str) -> str:
    """A clause as a sentence of its own.

    >>> sentence("nothing helps")
    'Nothing helps.'
    """
    return f"{capital(text)}."


def listed(names: Sequence[str], most: int = 8) -> str:
    """Names in a line, the first ones where there are many.

    >>> listed(["F1", "F2", "F3"], 2), listed(["F1"])
    ('F1, F2 and 1 more', 'F1')
    """
    return ", ".join(names[:most]) + (f" and {len(names) - most} more" if len(names) > most else "")


def joined(texts: Sequence[str]) -> str:
    """Texts in a line, `and` before the last one.

    >>> joined(["F1", "F2", "F3"]), joined(["F1", "F2"]), joined(["F1"])
    ('F1, F2 and F3', 'F1 and F2', 'F1')
    """
    return " and ".join(filter(None, (", ".join(texts[:-1]), texts[-1])))
