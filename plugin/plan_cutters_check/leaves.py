"""Every number and word of plan.json, in one walk: compared with what follows from the files, or named as not checked."""

import math
import re
from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Any

#: Objects whose keys are names that a plan makes: they stand as * in the paths below.
_NAMED = ("split", "takes_mm2", "feed_mm_min", "reason_counts", "angles_deg", "other_angles_deg", "by_reason", "lost_by",
          "undecided_by_reason", "axis_limit_with", "repeat_deg", "cutters", "verdicts", "shares")  # fmt: skip
#: Numbers that differ by less are one, as a share and in their own unit.
_SHARE, _NEAR = 1e-9, 1e-9


@dataclass(frozen=True, slots=True)
class Between:
    """A number that may be anywhere from `low` to `high`."""

    low: float
    high: float
    near: float = 1e-9

    def holds(self, value: Any) -> bool:
        """Whether a value is such a number."""
        return _number(value) and self.low - self.near <= value <= self.high + self.near

    def __str__(self) -> str:
        return f"from {self.low:.6g} to {self.high:.6g}"


class Loose(Between):
    """A range in which an unchecked number must lie: that it lies there does not check it."""


class Exactly(dict[str, Any]):
    """An object whose names a plan makes: it has these, and no others."""


@dataclass(slots=True)
class Compared:
    """Leaves of plan.json that agree, that differ (a line each), and that are unchecked, by their paths."""

    agree: list[str] = field(default_factory=list)
    differ: list[str] = field(default_factory=list)
    unchecked: list[str] = field(default_factory=list)


def pattern(path: str) -> str:
    """A path without numbers of lists, and with * for names that a plan makes.

    >>> pattern("plans[0].operations[12].angles_deg.C"), pattern("fewest.weights[3][0]")
    ('plans[].operations[].angles_deg.*', 'fewest.weights[][]')
    """
    plain = re.sub(r"\[\d+\]", "[]", path)
    return re.sub(rf"(^|\.)({'|'.join(_NAMED)})\.[^.\[]+", r"\1\2.*", plain)


def leaves(value: Any, path: str = "") -> Iterator[tuple[str, Any]]:
    """The leaves of a tree by their paths; what is empty is one, too."""
    if isinstance(value, dict) and value:
        for name, each in value.items():
            yield from leaves(each, f"{path}.{name}" if path else name)
    elif isinstance(value, list) and value:
        for k, each in enumerate(value):
            yield from leaves(each, f"{path}[{k}]")
    else:
        yield path, value


def compared(expected: Any, actual: Any) -> Compared:
    """Compare what is expected, as far as it is known, with what is there."""
    comparison = Compared()
    _compare(expected, actual, "", comparison)
    return comparison


def _compare(expected: Any, actual: Any, path: str, comparison: Compared) -> None:
    if isinstance(expected, dict) and isinstance(actual, dict):
        for name in [*expected, *(each for each in actual if each not in expected)]:
            below = f"{path}.{name}" if path else name
            if name not in actual:
                comparison.differ.append(f"{below} is not there")
            elif name not in expected and isinstance(expected, Exactly):
                comparison.differ.append(f"{below} is an entry that no plan has")
            elif name in expected:
                _compare(expected[name], actual[name], below, comparison)
            else:
                comparison.unchecked += (leaf for leaf, _ in leaves(actual[name], below))
    elif isinstance(expected, list) and isinstance(actual, list):
        if len(expected) != len(actual):
            comparison.differ.append(f"{path} has {len(actual)} entries, not {len(expected)}")
        elif not actual:
            comparison.agree.append(path)
        for k, (one, other) in enumerate(zip(expected, actual, strict=False)):
            _compare(one, other, f"{path}[{k}]", comparison)
    elif not same(expected, actual):
        comparison.differ.append(f"{path} is {short(actual)}, not {short(expected)}")
    elif isinstance(expected, Loose):
        comparison.unchecked.append(path)
    else:
        comparison.agree.append(path)


def same(expected: Any, actual: Any) -> bool:
    """Whether a value is what is expected, numbers but for rounding."""
    if isinstance(expected, Between):
        return expected.holds(actual)
    if _number(expected) and _number(actual):
        return math.isclose(expected, actual, rel_tol=_SHARE, abs_tol=_NEAR)
    return type(expected) is type(actual) and expected == actual


def _number(value: Any) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool)


def short(value: Any) -> str:
    """A value in words, not too many."""
    text = f"{value:.9g}" if _number(value) else ", ".join(map(str, value)) if isinstance(value, list) else str(value)
    return text if len(text) <= 60 else f"{text[:57]}..."
