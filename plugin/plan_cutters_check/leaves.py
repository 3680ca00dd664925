"""Every number and word under `operations` in plan.json: compared with what the checker reckons, or listed as unchecked."""

import math
import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from typing import Any

#: Objects whose keys are names that a plan makes: they stand as * in the paths below.
_NAMED = ("split", "takes_mm2", "feed_mm_min", "reason_counts", "angles_deg", "other_angles_deg", "by_reason", "lost_by",
          "undecided_by_reason", "axis_limit_with", "repeat_deg", "cutters", "verdicts", "shares")  # fmt: skip
#: What is not checked, and why; a path that is here may be checked where more is known.
UNCHECKED = {
    "plans[].ratio_at_most": "it rests on a bound of the fastest plan",
    "plans[].proved_share": "the area between samples is proved by the plan alone",
    "plans[].approaches_proved": "the area between samples is proved by the plan alone",
    "plans[].split.*.rung": "the models are not read",
    "plans[].split.*.why": "the models are not read",
    "plans[].split.*.joined": "the models are not read",
    "plans[].split.*.dropped": "the models are not read",
    "plans[].operations[].strip_mm[]": "widths of passes are taken from operations.npz",
    "plans[].operations[].strip_mm": "widths of passes are taken from operations.npz",
    "plans[].operations[].proved_share": "the area between samples is proved by the plan alone",
    "plans[].operations[].approaches_proved": "the area between samples is proved by the plan alone",
    "plans[].operations[].turning": "the area between samples is proved by the plan alone",
    "plans[].operations[].turning.pieces_mm2[]": "the area between samples is proved by the plan alone",
    "plans[].operations[].turning.steepest_deg_mm": "the area between samples is proved by the plan alone",
    "plans[].operations[].turning.angles_deg": "the area between samples is proved by the plan alone",
    "plans[].operations[].turning.angles_deg.*[]": "the area between samples is proved by the plan alone",
    "plans[].operations[].turning.held_share": "the area between samples is proved by the plan alone",
    "plans[].operations[].turning.both_share": "the area between samples is proved by the plan alone",
    "plans[].operations[].turning.singular_mm2": "the area between samples is proved by the plan alone",
    "plans[].operations[].clearance_mm": "the surroundings are not known, or the time was over",
    "plans[].operations[].index_s": "the best order of the rotary axes is not looked for",
    "plans[].operations[].colour": "the models are not read",
    "plans[].operations[].orbit": "numbers of orbits are names: which operations share one is compared with the process",
    "fewest.at_least": "it is not proved by weights alone",
    "fewest.lp": "the best weights are not looked for",
    "fewest.spacing_deg": "how near candidates are where the weights lie is not looked at",
    "fewest.alone": "the time was over",
    "fastest.bound_seconds": "the bound of the fastest plan is not found again",
    "fastest.at_best_seconds": "the bound of the fastest plan is not found again",
    "fastest.gap": "the bound of the fastest plan is not found again",
    "fastest.samples": "the bound of the fastest plan is not found again",
    "fastest.candidates": "the bound of the fastest plan is not found again",
    "cutters[].saves_seconds": "the plans without a cutter are not there",
    "cutters[].change_seconds": "the plans without a cutter are not there",
    "assumed.feed_mm_min.*": "it is what times rest on",
    "assumed.feed_mm_min": "it is what times rest on",
    "probes": "it is how much was looked at",
    "notes[]": "they are sentences",
}
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


@dataclass(slots=True)
class Compared:
    """Leaves of plan.json that agree, that differ (a line each), that are unchecked, and that nobody knows, by their paths."""

    agree: list[str] = field(default_factory=list)
    differ: list[str] = field(default_factory=list)
    unchecked: list[str] = field(default_factory=list)
    unknown: list[str] = field(default_factory=list)
    listed: Mapping[str, str] = field(default_factory=lambda: UNCHECKED)

    def why(self, path: str) -> str | None:
        """Why a leaf is not checked; None where that is not listed."""
        plain = pattern(path)
        if plain in self.listed:
            return self.listed[plain]
        under = (f"{plain[:k]}**" for k in range(len(plain), 0, -1))
        return next((self.listed[each] for each in under if each in self.listed), None)


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


def compared(expected: Any, actual: Any, listed: Mapping[str, str] = UNCHECKED) -> Compared:
    """Compare what is expected, as far as it is known, with what is there; `listed`: what may be unchecked, and why."""
    comparison = Compared(listed=listed)
    _compare(expected, actual, "", comparison)
    return comparison


def _compare(expected: Any, actual: Any, path: str, comparison: Compared) -> None:
    if isinstance(expected, dict) and isinstance(actual, dict):
        for name in [*expected, *(each for each in actual if each not in expected)]:
            below = f"{path}.{name}" if path else name
            if name not in actual:
                comparison.differ.append(f"{below} is not there")
            elif name in expected:
                _compare(expected[name], actual[name], below, comparison)
            else:
                _unchecked(actual[name], below, comparison)
    elif isinstance(expected, list) and isinstance(actual, list):
        if len(expected) != len(actual):
            comparison.differ.append(f"{path} has {len(actual)} entries, not {len(expected)}")
        elif not actual:
            comparison.agree.append(path)
        for k, (one, other) in enumerate(zip(expected, actual, strict=False)):
            _compare(one, other, f"{path}[{k}]", comparison)
    elif not _same(expected, actual):
        comparison.differ.append(f"{path} is {_short(actual)}, not {_short(expected)}")
    elif isinstance(expected, Loose):
        _unchecked(actual, path, comparison)
    else:
        comparison.agree.append(path)


def _unchecked(value: Any, path: str, comparison: Compared) -> None:
    for leaf, each in leaves(value, path):
        plain = pattern(leaf)
        empty = isinstance(each, dict | list) and any(known.startswith((f"{plain}[", f"{plain}.")) for known in comparison.listed)
        (comparison.unchecked if empty or comparison.why(leaf) else comparison.unknown).append(leaf)


def _same(expected: Any, actual: Any) -> bool:
    if isinstance(expected, Between):
        return expected.holds(actual)
    if _number(expected) and _number(actual):
        return math.isclose(expected, actual, rel_tol=_SHARE, abs_tol=_NEAR)
    return type(expected) is type(actual) and expected == actual


def _number(value: Any) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool)


def _short(value: Any) -> str:
    text = f"{value:.9g}" if _number(value) else str(value)
    return text if len(text) <= 60 else f"{text[:57]}..."
