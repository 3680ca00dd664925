"""Angles that are given in degrees, by names that end in `_deg`, beside the same names in radians."""

import inspect
import math
from collections.abc import Callable, Mapping
from functools import wraps
from numbers import Real
from typing import Any, Literal, NamedTuple, TypeVar

from plan_cutters.domain.checks import number, numbers
from plan_cutters.errors import OptionError

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

    Parameters
    ----------
    values : mapping
        Words and their values. Degrees that are None were not given, nor were radians beside degrees.
    angles : mapping
        The words for angles, without `_deg`, and what each may be in degrees.

    Raises
    ------
    OptionError
        An angle is given in both units, is no number or lies beyond its bounds; `error` in its place.

    Examples
    --------
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
