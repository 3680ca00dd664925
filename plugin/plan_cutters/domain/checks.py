"""Is an argument the kind of thing that it must be? What is not ends in an error that says what was given.

`True` is not taken for 1, nor `"6"` for 6, nor a table for a list: each is rather a mistake than a wish. Angles may be given in
degrees, by names that end in `_deg`.
"""

import inspect
import math
import re
import reprlib
from collections.abc import Callable, Iterable, Mapping, Set
from difflib import get_close_matches
from functools import wraps
from numbers import Integral, Real
from typing import Any, Literal, NamedTuple, TypeVar

import numpy as np

from plan_cutters.errors import OptionError

_RADIANS = re.compile(r"\s*(\S+)\s*rad\s*")
#: Added to limits of angles, for what is left when degrees were turned into single-precision radians.
_ROUNDING = 1e-6


def did_you_mean(word: str, words: Iterable[str]) -> str:
    """Such as `; did you mean trunnion-ac?`, of the word that is most like another one; empty where none is.

    >>> did_you_mean("trunion-ac", ["trunnion-ac", "3-axis"]), did_you_mean("x", ["3-axis"])
    ('; did you mean trunnion-ac?', '')
    """
    near = get_close_matches(word.lower(), list(words), 1)
    return f"; did you mean {near[0]}?" if near else ""


def number(value: Any, what: str, *, error: Callable[[str], Exception] = OptionError) -> float:
    """A real number, infinite ones too; `error` for anything else and for NaN."""
    if not isinstance(value, Real) or isinstance(value, bool):
        raise error(f"{what} must be a number, not {shown(value)}")
    try:
        result = float(value)
    except OverflowError:
        result = math.inf
    if math.isnan(result):
        raise error(f"{what} must be a number, not nan")
    return result


def finite(value: Any, what: str, *, error: Callable[[str], Exception] = OptionError) -> float:
    """A finite real number, as files of tools and machines state it."""
    result = number(value, what, error=error)
    if math.isinf(result):
        raise error(f"{what} must be a finite number, not {shown(value)}")
    return result


def whole(value: Any, what: str) -> int:
    """A whole number that a computer counts with."""
    if not isinstance(value, Integral) or isinstance(value, bool) or abs(int(value)) >= 1 << 63:
        raise OptionError(f"{what} must be a whole number, not {shown(value)}")
    return int(value)


def not_empty(value: Any, what: str, otherwise: str) -> None:
    """Refuse a list with nothing in it: who has chosen some and is left with none has made a mistake."""
    if isinstance(value, list | tuple | set | frozenset) and not value:
        raise OptionError(f"{what}: the list is empty; {otherwise}")


def flag(value: Any, what: str) -> bool:
    """True or False (numpy's too)."""
    if not isinstance(value, bool | np.bool_):
        raise OptionError(f"{what} must be True or False, not {shown(value)}")
    return bool(value)


def name(value: Any, what: str, *, error: type[OptionError] = OptionError) -> str:
    r"""A text that files can hold: half a pair of surrogates, which no encoding has, becomes a question mark.

    >>> name("rim\ud800", "a name")
    'rim?'
    """
    if not isinstance(value, str):
        raise error(f"{what} must be a text, not {shown(value)}")
    return value.encode("utf-8", "replace").decode()


def items(value: Any, what: str, of: str, *, error: type[OptionError] = OptionError) -> list[Any]:
    """The items of a list, a tuple, an array or anything else that gives its items in order."""
    try:
        if not isinstance(value, Iterable) or isinstance(value, str | bytes | Mapping | Set):
            raise TypeError
        return list(value)
    except TypeError:
        raise error(f"{what} must be a list of {of}, not {shown(value)}") from None


def numbers(value: Any, what: str, count: int | None = None, *, error: type[OptionError] = OptionError) -> tuple[float, ...]:
    """Real numbers, `count` of them if that is given."""
    of = "numbers" if count is None else f"{count} numbers"
    values = tuple(number(each, what, error=error) for each in items(value, what, of, error=error))
    if count is not None and len(values) != count:
        raise error(f"{what} must be a list of {of}, not of {len(values)}")
    return values


def pair(value: Any, what: str) -> tuple[float, float]:
    """Two real numbers, as a range has them."""
    low, high = numbers(value, what, 2)
    return low, high


def choice(value: Any, what: str) -> None:
    """Refuse a value that can be neither words nor faces; only the part can tell which objects are its faces."""
    if isinstance(value, bool | float | complex | bytes | Mapping | Set):
        raise OptionError(f"{what} must be words or faces of the part, not {shown(value)}")


def radians(angle: float, what: str, most: float, *, error: type[OptionError] = OptionError) -> float:
    """An angle from -`most` to `most`: what is larger was meant in degrees."""
    if abs(angle) > most + _ROUNDING:
        raise error(f"{what} {angle:g} lies beyond {most:.4g}: angles are radians; math.radians({angle:g})?")
    return min(max(angle, -most), most)


def shown(value: Any) -> str:
    """A value in an error, on one line: itself where that is short, else its type."""
    if isinstance(value, Real) and not isinstance(value, int):
        return f"{float(value):g}"
    if isinstance(value, int) and abs(value) >= 1 << 10_000:
        # Python refuses to write out more than some thousands of digits.
        return "a number of thousands of digits"
    if value is None or isinstance(value, str | int):
        return " ".join(reprlib.repr(str(value) if isinstance(value, str) else value).split())
    return f"a value of type {type(value).__name__}"


def stated_degrees(angle: float) -> float | str:
    """An angle, rad, in degrees, where they turn into the same radians; else the text that `stated_radians` reads."""
    degrees = math.degrees(angle)
    for each in (round(degrees, 9), degrees, math.nextafter(degrees, 0.0), math.nextafter(degrees, 2.0 * degrees)):
        if math.radians(each) == angle:
            return each
    return f"{angle!r} rad"


def stated_radians(text: str) -> float:
    """An angle that is written as `0.5 rad`; nan for any other text, and for one that is not finite."""
    match = _RADIANS.fullmatch(text)
    try:
        radians = float(match[1]) if match else math.nan
    except ValueError:
        return math.nan
    return radians if math.isfinite(radians) else math.nan


_Class = TypeVar("_Class", bound=type)


class Angle(NamedTuple):
    """An angle, or each of several, lies between these degrees; a range is two that run upwards."""

    least: float
    most: float
    kind: Literal["one", "range", "several"] = "one"


def in_radians(
    values: Mapping[str, Any], angles: Mapping[str, Angle], *, error: type[OptionError] = OptionError
) -> dict[str, Any]:
    """Give the same words, with `tilt_deg` turned into `tilt`: a number, a list of numbers, or a range.

    `values`: words and their values. Degrees that are None were not given, nor were radians beside degrees. `angles`: the words
    for angles, without `_deg`, and what each may be in degrees. Raises OptionError: an angle is given in both units, is no number
    or lies beyond its bounds; `error` in its place.

    >>> angles = {"tilt": Angle(0, 180, "range")}
    >>> in_radians({"tilt_deg": (0, 180), "grid": 5}, angles)
    {'grid': 5, 'tilt': (0.0, 3.141592653589793)}
    >>> in_radians({"tilt": None, "tilt_deg": None}, angles)
    {'tilt': None}
    >>> in_radians({"tilt": (0, 1), "tilt_deg": (0, 60)}, angles)
    Traceback (most recent call last):
    plan_cutters.errors.OptionError: tilt and tilt_deg are one angle, in radians and in degrees: give one of them
    """
    result = {word: value for word, value in values.items() if word in angles or word.removesuffix("_deg") not in angles}
    for word, angle in angles.items():
        value = values.get(f"{word}_deg")
        if value is None:
            continue
        if values.get(word) is not None:
            raise error(f"{word} and {word}_deg are one angle, in radians and in degrees: give one of them")
        result[word] = _radians(value, f"{word}_deg", angle, error)
    return result


def _radians(value: Any, what: str, angle: Angle, error: type[OptionError]) -> float | tuple[float, ...]:
    single = angle.kind == "one" or (angle.kind == "several" and isinstance(value, Real))
    count = 2 if angle.kind == "range" else None
    each = (number(value, what, error=error),) if single else numbers(value, what, count, error=error)
    for one in each:
        if not angle.least <= one <= angle.most:
            raise error(f"{what} {one:g} must lie between {angle.least:g} and {angle.most:g} degrees")
    if angle.kind == "range" and each[0] > each[1]:
        raise error(f"{what} {each[0]:g}:{each[1]:g} must run upwards")
    radians = tuple(map(math.radians, each))
    return radians[0] if single else radians


def degrees_too(angles: Mapping[str, Angle], *, error: type[OptionError] = OptionError) -> Callable[[_Class], _Class]:
    """Let a class be made with some of its attributes in degrees, too, and show that in its signature."""

    def widened(made: _Class) -> _Class:
        kind: Any = made
        plain, shown = kind.__init__, inspect.signature(made)
        more = [inspect.Parameter(f"{word}_deg", inspect.Parameter.KEYWORD_ONLY, default=None) for word in angles]

        @wraps(plain)
        def __init__(self: Any, *values: Any, **words: Any) -> None:
            plain(self, *values, **in_radians(words, angles, error=error))

        kind.__init__, kind.__signature__ = __init__, shown.replace(parameters=[*shown.parameters.values(), *more])
        return made

    return widened


_Function = TypeVar("_Function", bound=Callable[..., Any])


def spelled_out(words: type, made: type) -> Callable[[_Function], _Function]:
    """Show a function with each of its `**words` in their place.

    `words` is their type, a TypedDict; `made` is the class that takes them and has their order and defaults: what it does not
    take itself is None where it is not given.
    """

    def shown(function: _Function) -> _Function:
        plain = inspect.signature(function)
        types = {name: getattr(kind, "__forward_arg__", kind) for name, kind in words.__annotations__.items()}
        own = {name: each for name, each in plain.parameters.items() if each.kind is not each.VAR_KEYWORD}
        known = inspect.signature(made).parameters
        for name in [*(each for each in known if each in types), *(each for each in types if each not in known)]:
            default = known[name].default if name in known else None
            word = inspect.Parameter(name, inspect.Parameter.KEYWORD_ONLY, default=default, annotation=types[name])
            own.setdefault(name, word)
        vars(function)["__signature__"] = plain.replace(parameters=list(own.values()))
        return function

    return shown
